//! Objects of a scene as a list of shapes, each with its transform to the world.

use super::Export;
use crate::ply::write_all_attributes;
use durer_scene::describe::DescribedKind;
use durer_scene::dialect::Dialect;
use durer_scene::math::{Vec2, Vec3};
use durer_scene::scene::{CsgOperation, MatrixOp, MatrixRules, Object, ObjectKind, extent};
use durer_scene::shape::{Disc, Mesh, MeshData, Plane, Primitive, Rectangle, Shape as _, Sphere};
use glam::{DAffine3, DMat3, DVec3};
use std::collections::{BTreeMap, BTreeSet};
use std::sync::Arc;

/// Size of the square that replaces an infinite plane, relative to the extent of everything else.
const PLANE_SCALE: f32 = 1000.0;

/// Number of triangles from which on a mesh that is used several times becomes a group of its own.
const MANY: usize = 64;

/// Shape of a scene without its transform.
#[derive(Clone)]
pub(crate) enum Geometry<'a> {
    Primitive(&'a Primitive),
    /// Mesh that an asset or a file contains.
    Mesh(&'a str),
}

/// Shape with its transform to the world and its material.
#[derive(Clone)]
pub(crate) struct Placed<'a> {
    pub geometry: Geometry<'a>,
    pub to_world: DAffine3,
    pub material: Option<u32>,
}

impl Placed<'_> {
    /// True if the transform turns the shape into its mirror image.
    pub fn is_mirrored(&self) -> bool {
        self.to_world.matrix3.determinant() < 0.0
    }

    /// Name that is the same for equal shapes, regardless of their transforms and materials.
    pub fn key(&self) -> String {
        match &self.geometry {
            Geometry::Primitive(primitive) => format!("{primitive:?}"),
            Geometry::Mesh(name) => name.to_string(),
        }
    }

    /// Short name of the shape, for a file.
    pub fn name(&self) -> String {
        match &self.geometry {
            Geometry::Primitive(primitive) => DescribedKind::keyword(*primitive, Dialect::Durer).to_lowercase(),
            Geometry::Mesh(name) => name.to_string(),
        }
    }

    /// Centre and radius in the world, if the shape is a sphere that the transform keeps round.
    pub fn sphere(&self) -> Option<(DVec3, f64)> {
        let Geometry::Primitive(Primitive::Sphere(Sphere { center, radius })) = self.geometry else { return None };
        let scale = uniform_scale(&self.to_world.matrix3)?;
        Some((self.to_world.transform_point3(center.as_dvec3()), scale * f64::from(*radius)))
    }

    /// Transform and radius of a sphere as [`Placed::sphere`] finds it, if the poles are on the z
    /// axis and u is 0 at +x, as in pbrt and Mitsuba.
    pub fn turned_sphere(&self) -> Option<(DAffine3, f64)> {
        let (translation, radius) = self.sphere().filter(|_| !self.is_mirrored())?;
        // In Dürer, the poles are on the y axis, and u is 1/2 at -z.
        let turned = DMat3::from_cols(DVec3::NEG_Y, DVec3::Z, DVec3::X).transpose();
        let scale = self.to_world.matrix3.x_axis.length();
        Some((DAffine3 { matrix3: self.to_world.matrix3 * turned * (1.0 / scale), translation }, radius))
    }

    /// Corner and two perpendicular edges in the world, whose cross product points to the front, if
    /// the shape is a rectangle.
    pub fn rectangle(&self) -> Option<(DVec3, [DVec3; 2])> {
        let Geometry::Primitive(Primitive::Rectangle(Rectangle { corner, edge0, edge1 })) = self.geometry else {
            return None;
        };
        let [a, b] = [edge0, edge1].map(|edge| self.to_world.transform_vector3(edge.as_dvec3()));
        let is_right = a.dot(b).abs() <= 1e-6 * a.length() * b.length();
        let edges = if self.is_mirrored() { [b, a] } else { [a, b] };
        is_right.then(|| (self.to_world.transform_point3(corner.as_dvec3()), edges))
    }

    /// Centre, normal and radius in the world, if the shape is a disc without a hole.
    pub fn disc(&self) -> Option<(DVec3, DVec3, f64)> {
        let Geometry::Primitive(Primitive::Disc(Disc { center, normal, radius, inner_radius })) = self.geometry else {
            return None;
        };
        let scale = uniform_scale(&self.to_world.matrix3)?;
        let normal = self.to_world.transform_vector3(normal.as_dvec3()).normalize_or(DVec3::Y);
        (*inner_radius == 0.0)
            .then(|| (self.to_world.transform_point3(center.as_dvec3()), normal, scale * f64::from(*radius)))
    }
}

/// Returns the factor of a transform that scales all lengths equally, or `None` for other
/// transforms.
fn uniform_scale(m: &DMat3) -> Option<f64> {
    let scale = m.x_axis.length();
    let product = m.transpose() * *m;
    let expected = DMat3::from_diagonal(DVec3::splat(scale * scale));
    product.abs_diff_eq(expected, 1e-6 * scale * scale).then_some(scale)
}

impl<'a> Export<'a> {
    /// Returns all shapes. `program` is the name of the other program, for messages.
    pub fn shapes(&mut self, program: &str) -> Vec<Placed<'a>> {
        let mut shapes = Vec::new();
        for object in self.scene.root.iter().flat_map(|root| &root.objects) {
            self.collect(object, DAffine3::IDENTITY, program, &mut shapes);
        }
        shapes
    }

    fn collect(&mut self, object: &'a Object, to_world: DAffine3, program: &str, shapes: &mut Vec<Placed<'a>>) {
        let geometry = match &object.node {
            ObjectKind::Group(group) => {
                return group.objects.iter().for_each(|object| self.collect(object, to_world, program, shapes));
            }
            ObjectKind::Transform(ops, inner) => {
                let map = to_world * MatrixOp::product(ops, MatrixRules::default());
                return self.collect(inner, map, program, shapes);
            }
            // The surfaces inside other parts of a union are kept, as in a group.
            ObjectKind::Solid(CsgOperation::Union, parts) => {
                return parts.iter().for_each(|part| self.collect(part, to_world, program, shapes));
            }
            ObjectKind::Mesh(mesh) => Geometry::Mesh(&mesh.obj_file.path),
            ObjectKind::Primitive(primitive) => Geometry::Primitive(primitive),
            ObjectKind::Voxels(..) | ObjectKind::HeightField(_) | ObjectKind::Solid(..) => {
                return self.warn_lost(format!("{program} has no solids, grids or height fields: they are left out"));
            }
        };
        shapes.push(Placed { geometry, to_world, material: object.material });
    }

    /// Returns the keys and materials of large meshes that occur several times, which are written
    /// once.
    pub fn repeated(&mut self, shapes: &[Placed], program: &str) -> BTreeSet<(String, Option<u32>)> {
        let mut uses: BTreeMap<_, (&Placed, u32)> = BTreeMap::new();
        for shape in shapes.iter().filter(|shape| matches!(shape.geometry, Geometry::Mesh(_)) && !shape.is_mirrored()) {
            uses.entry((shape.key(), shape.material)).or_insert((shape, 0)).1 += 1;
        }
        let is_large = |shape: &Placed, export: &mut Self| {
            export.triangles(shape, program).is_some_and(|data| data.triangles.len() >= MANY)
        };
        let uses = uses.into_iter().filter(|(_, (shape, count))| *count > 1 && is_large(shape, self));
        uses.map(|(key, _)| key).collect()
    }

    /// Returns the triangles of a shape in its own space, with all normals. Normals are left out if
    /// the triangles are flat. Only what most programs read is kept.
    pub fn triangles(&mut self, shape: &Placed, program: &str) -> Option<MeshData> {
        let mut shaded = self.whole_triangles(shape, program)?;
        shaded.second_uvs.clear();
        if !shaded.colors.is_empty() && shaded.colors.iter().any(|color| *color != [1.0; 4]) {
            self.warn_lost(format!("vertex colours are not written to {program}: they are left out"));
        }
        shaded.colors.clear();
        Some(shaded)
    }

    /// Returns the triangles of a shape as [`Export::triangles`] does, with the second texture
    /// coordinates and the colours of vertices.
    pub fn whole_triangles(&mut self, shape: &Placed, program: &str) -> Option<MeshData> {
        let data = match shape.geometry {
            Geometry::Mesh(name) => self.mesh_data(name)?,
            Geometry::Primitive(Primitive::Plane(plane)) => {
                self.warn_lost(format!("{program} has no infinite planes: a large square is written"));
                Arc::new(square(plane, self.radius(), &shape.to_world))
            }
            Geometry::Primitive(primitive) => match primitive.to_mesh() {
                Some(data) => Arc::new(data),
                None => {
                    let name = DescribedKind::keyword(primitive, Dialect::Durer);
                    self.warn_lost(format!("{program} has no shape like `{name}`: it is left out"));
                    return None;
                }
            },
        };
        if data.triangles.is_empty() {
            return None;
        }
        let mut shaded = (*data).clone();
        if let Geometry::Mesh(_) = shape.geometry {
            let mesh = Mesh::new(data, self.context.normals, true);
            let (normals, triangle_normals) = mesh.normals();
            (shaded.normals, shaded.triangle_normals) = (normals.to_vec(), triangle_normals.into_owned());
        }
        if let Geometry::Primitive(Primitive::Rectangle(_)) = shape.geometry {
            shaded.uvs = [Vec2::ZERO, Vec2::X, Vec2::ONE, Vec2::Y].to_vec();
            shaded.triangle_uvs = shaded.triangles.clone();
        }
        if shaded.triangle_normals.is_empty() {
            shaded.normals.clear();
        }
        shaded.flat = shaded.triangle_normals.is_empty();
        (shaded.tangents, shaded.vertices) = Default::default();
        Some(shaded)
    }

    /// Returns the triangles of a shape and their transform to the world. The transform is in the
    /// triangles if it would turn the shape into its mirror image. If `needs_uv` is true, warns
    /// about missing texture coordinates.
    pub fn mesh(&mut self, shape: &Placed, needs_uv: bool, program: &str) -> Option<(DAffine3, MeshData)> {
        let data = self.triangles(shape, program)?;
        if needs_uv && data.triangle_uvs.is_empty() {
            self.warn_lost("some shapes with pictures have no texture coordinates: the pictures are not mapped");
        }
        Some(match shape.is_mirrored() {
            true => (DAffine3::IDENTITY, transformed(data, &shape.to_world)),
            false => (shape.to_world, data),
        })
    }

    /// Returns the path of the PLY file with the triangles of a shape, as [`Export::mesh`] returns
    /// them.
    pub fn mesh_file(&mut self, shape: &Placed, data: impl FnOnce() -> MeshData) -> Option<String> {
        let key = if shape.is_mirrored() { format!("{} {}", shape.key(), shape.to_world) } else { shape.key() };
        self.file(format!("mesh {key}"), &shape.name(), "ply", |_| {
            Some(write_all_attributes(&MeshData { flat: false, ..data() }))
        })
    }

    /// Returns a distance from the origin that nothing bounded exceeds, and the camera neither.
    fn radius(&self) -> f32 {
        use durer_scene::camera::Projection as _;
        let mut most = self.scene.camera.as_ref().map_or(1.0, |camera| camera.pose().center.length().max(1.0));
        extent::points(self.scene, &mut |p| most = most.max(p.length() as f32));
        most
    }
}

/// Returns a square on a plane, large enough to look infinite, in the space of the plane. `radius`
/// is a length in the world.
fn square(plane: &Plane, radius: f32, to_world: &DAffine3) -> MeshData {
    let axes = to_world.matrix3;
    let shortest = axes.x_axis.length().min(axes.y_axis.length()).min(axes.z_axis.length());
    let scale = shortest.max(1e-12) as f32;
    let half = PLANE_SCALE * radius / scale;
    let (normal, offset) = (plane.normal.normalize_or(Vec3::Y), plane.offset / plane.normal.length());
    let (x, y) = normal.any_orthonormal_pair();
    let (x, y) = if x.cross(y).dot(normal) < 0.0 { (y, x) } else { (x, y) };
    let origin = to_world.inverse().transform_point3(DVec3::ZERO).as_vec3();
    let center = origin + (offset - origin.dot(normal)) * normal;
    let corners = [[-1.0, -1.0], [1.0, -1.0], [1.0, 1.0], [-1.0, 1.0]].map(Vec2::from_array);
    MeshData {
        positions: corners.map(|p| center + half * (p.x * x + p.y * y)).to_vec(),
        triangles: vec![[0, 1, 2], [0, 2, 3]],
        flat: true,
        ..MeshData::default()
    }
}

/// Returns a mesh with a transform applied, whose front sides stay front sides.
pub(crate) fn transformed(mut data: MeshData, map: &DAffine3) -> MeshData {
    let normals = map.matrix3.inverse().transpose();
    data.positions.iter_mut().for_each(|p| *p = map.transform_point3(p.as_dvec3()).as_vec3());
    data.normals.iter_mut().for_each(|n| *n = (normals * n.as_dvec3()).normalize_or_zero().as_vec3());
    if map.matrix3.determinant() < 0.0 {
        for list in [&mut data.triangles, &mut data.triangle_uvs, &mut data.triangle_normals] {
            list.iter_mut().for_each(|corners| corners.swap(1, 2));
        }
    }
    data
}
