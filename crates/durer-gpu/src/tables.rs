//! Tables that the device reads, made from a [`World`].

mod materials;

use crate::bvh;
use crate::emitters;
use crate::layout::{self, AlbedoRow, Emitter, Light, Material, NONE, Node, Object, Triangle};
use bytemuck::Zeroable as _;
use durer_render::world::{self, Geometry, MeshTree, World};
use durer_scene::bsdf::Frame;
use durer_scene::light;
use durer_scene::light::Illuminate as _;
use durer_scene::math::{Aabb, Vec3, fp};
use durer_scene::shape::Primitive;
use glam::{DAffine3, DMat3, DVec3};
use std::collections::HashMap;
use std::sync::Arc;

/// Margin of the boxes around objects, relative to the largest coordinate of the scene. It covers
/// the rounding of rays that are mapped to object space.
const OBJECT_MARGIN: f32 = 4e-6;

/// Largest number of triangles in a leaf.
const LEAF_TRIANGLES: usize = 4;

/// Tables of a scene in the layout that shaders read.
#[derive(Clone, Debug, Default)]
pub struct Tables {
    /// Trees over the objects and over the triangles of each mesh.
    pub nodes: Vec<Node>,
    /// Triangles of all meshes, in the order of the leaves.
    pub triangles: Vec<Triangle>,
    /// Objects, with the same numbers as in the world.
    pub objects: Vec<Object>,
    /// Materials, with the same numbers as in the world.
    pub materials: Vec<Material>,
    /// Lights, with the same numbers as in the world.
    pub lights: Vec<Light>,
    /// Emissive surfaces, followed by the lights.
    pub emitters: Vec<Emitter>,
    /// Tables of albedos of the principled materials.
    pub albedos: Vec<AlbedoRow>,
    /// Root of the tree over the bounded objects, or [`NONE`].
    pub root: u32,
    /// First object without bounds, or [`NONE`].
    pub first_unbounded: u32,
}

impl Tables {
    /// Converts a world. Features that the device does not support are ignored; see
    /// [`refusals`](crate::capability::refusals).
    pub fn new(world: &World) -> Tables {
        let mut tables = Tables { root: NONE, first_unbounded: NONE, ..Tables::default() };
        let mut roots = HashMap::new();
        for number in 0..world.objects().len() as u32 {
            let object = tables.object(world, number, &mut roots);
            tables.objects.push(object);
        }
        tables.materials = world.materials().iter().map(|own| materials::material(own, &mut tables.albedos)).collect();
        tables.lights = world.lights().iter().map(light).collect();
        tables.emitters = emitters::emitters(world, &mut tables.objects);
        tables.add_object_tree(world);
        tables
    }

    /// Builds the tree over the bounded objects, and chains the others.
    fn add_object_tree(&mut self, world: &World) {
        let bounds: Vec<Option<Aabb>> = world.objects().iter().map(world::Object::bounds).collect();
        let reach = |b: &Aabb| b.min.abs().max(b.max.abs()).max_element();
        let largest = bounds.iter().flatten().map(reach).filter(|x| x.is_finite()).fold(0.0, f32::max);
        let margin = OBJECT_MARGIN * largest.max(world.camera_frame().eye.abs().max_element());
        let bounded: Vec<u32> = (0..).zip(&bounds).filter(|(_, b)| b.is_some()).map(|(number, _)| number).collect();
        let boxes: Vec<Aabb> = bounds.iter().flatten().map(|b| bvh::padded(*b, margin)).collect();
        let start = self.nodes.len();
        let (root, order) = bvh::build(&boxes, 0, 1, &mut self.nodes);
        for node in &mut self.nodes[start..] {
            if node.count > 0 {
                node.first = bounded[order[node.first as usize] as usize];
            }
        }
        self.root = root;
        for number in (0..bounds.len()).rev().filter(|&number| bounds[number].is_none()) {
            self.objects[number].next_unbounded = self.first_unbounded;
            self.first_unbounded = number as u32;
        }
    }

    /// Converts an object. Meshes that several objects share are added once.
    fn object(&mut self, world: &World, number: u32, roots: &mut HashMap<*const MeshTree, u32>) -> Object {
        let own = &world.objects()[number as usize];
        let place = own.to_world.as_ref().map(|to_world| to_world.forward());
        let size = own.half_area().map_or(-1.0, |area| area.min(layout::FAR));
        let object = Object {
            material: own.material,
            size,
            first_emitter: NONE,
            next_unbounded: NONE,
            root: NONE,
            ..with_transform(Object::zeroed(), place)
        };
        match &own.geometry {
            Geometry::Mesh(tree) => {
                let root = *roots.entry(Arc::as_ptr(tree)).or_insert_with(|| self.add_mesh(tree));
                Object { kind: layout::MESH, root, ..object }
            }
            Geometry::Primitive(Primitive::Triangle(triangle)) => {
                let [a, b, c] = triangle.corners().map(Vec3::into);
                let root = self.add_triangles(vec![Triangle { a, b, c, ..Triangle::zeroed() }]);
                Object { kind: layout::MESH, root, ..object }
            }
            Geometry::Primitive(shape) => with_shape(object, place.unwrap_or(DAffine3::IDENTITY), shape),
            // Solids are refused before the tables are made.
            Geometry::Solid(_) => object,
        }
    }

    /// Adds the triangles of a mesh and returns the root of their tree.
    fn add_mesh(&mut self, tree: &MeshTree) -> u32 {
        let mesh = &tree.mesh;
        let triangle = |part: u32| {
            let [a, b, c] = mesh.corners(part).map(Vec3::into);
            let corners = Triangle { a, b, c, part, ..Triangle::zeroed() };
            let Some(normals) = mesh.corner_normals(part) else { return corners };
            let [normal_a, normal_b, normal_c] = normals.map(|n| n.normalize_or_zero().into());
            Triangle { smooth_normals: 1, normal_a, normal_b, normal_c, ..corners }
        };
        self.add_triangles((0..mesh.len() as u32).map(triangle).collect())
    }

    fn add_triangles(&mut self, triangles: Vec<Triangle>) -> u32 {
        let around = |t: &Triangle| bvh::padded(Aabb::around([t.a, t.b, t.c].map(Vec3::from_array)), 0.0);
        let boxes: Vec<Aabb> = triangles.iter().map(around).collect();
        let base = self.triangles.len() as u32;
        let (root, order) = bvh::build(&boxes, base, LEAF_TRIANGLES, &mut self.nodes);
        self.triangles.extend(order.iter().map(|&item| triangles[item as usize]));
        root
    }
}

/// Returns the first three rows of an affine map in single precision.
pub(super) fn rows(map: DAffine3) -> [[f32; 4]; 3] {
    let m = map.matrix3;
    [0, 1, 2].map(|row| [m.x_axis[row], m.y_axis[row], m.z_axis[row], map.translation[row]].map(|x| x as f32))
}

/// Returns the object with a transform, or without one for `None`.
fn with_transform(object: Object, place: Option<DAffine3>) -> Object {
    let flags = if place.is_some() { layout::TRANSFORMED } else { 0 };
    let place = place.unwrap_or(DAffine3::IDENTITY);
    let [forward_x, forward_y, forward_z] = rows(place);
    let [inverse_x, inverse_y, inverse_z] = rows(place.inverse());
    Object { flags, forward_x, forward_y, forward_z, inverse_x, inverse_y, inverse_z, ..object }
}

fn row(v: Vec3, last: f32) -> [f32; 4] {
    [v.x, v.y, v.z, last]
}

/// Returns the object with its shape. Ellipsoids become spheres, and cylinders and cones become
/// frustums with base radius 1 along z, by a change of the transform.
fn with_shape(object: Object, place: DAffine3, shape: &Primitive) -> Object {
    match shape {
        Primitive::Sphere(sphere) => {
            Object { kind: layout::SPHERE, shape_0: row(sphere.center, sphere.radius), ..object }
        }
        Primitive::Plane(plane) => Object { kind: layout::PLANE, shape_0: row(plane.normal, plane.offset), ..object },
        Primitive::Cuboid(cuboid) => {
            Object { kind: layout::CUBOID, shape_0: row(cuboid.min, 0.0), shape_1: row(cuboid.max, 0.0), ..object }
        }
        Primitive::Disc(disc) => Object {
            kind: layout::DISC,
            shape_0: row(disc.center, disc.radius),
            shape_1: row(disc.unit_normal().as_vec3(), disc.inner_radius),
            ..object
        },
        Primitive::Rectangle(rectangle) => Object {
            kind: layout::RECTANGLE,
            shape_0: row(rectangle.corner, 0.0),
            shape_1: row(rectangle.edge0, 0.0),
            shape_2: row(rectangle.edge1, 0.0),
            ..object
        },
        Primitive::Ellipsoid(ellipsoid) => {
            let scale = DMat3::from_diagonal(ellipsoid.radii.as_dvec3());
            let unit = DAffine3 { matrix3: scale, translation: ellipsoid.center.as_dvec3() };
            let object = with_transform(object, Some(place * unit));
            Object { kind: layout::SPHERE, shape_0: row(Vec3::ZERO, 1.0), ..object }
        }
        Primitive::Cylinder(c) => with_frustum(object, place, [c.base, c.top], [c.radius; 2]),
        Primitive::Cone(c) => with_frustum(object, place, [c.base, c.top], [c.base_radius, c.top_radius]),
        // Triangles are meshes, and the others are refused before the tables are made.
        Primitive::Triangle(_) | Primitive::Torus(_) | Primitive::Quadric(_) => object,
    }
}

fn with_frustum(object: Object, place: DAffine3, ends: [Vec3; 2], radii: [f32; 2]) -> Object {
    // The larger disc is the base.
    let ([base, top], [large, small]) =
        if radii[0] >= radii[1] { (ends, radii) } else { ([ends[1], ends[0]], [radii[1], radii[0]]) };
    let axis = top.as_dvec3() - base.as_dvec3();
    let frame = Frame::around(axis.normalize_or(DVec3::Y).as_vec3());
    let across = [frame.tangent, frame.bitangent].map(|side| f64::from(large) * side.as_dvec3());
    let unit = DAffine3 { matrix3: DMat3::from_cols(across[0], across[1], axis), translation: base.as_dvec3() };
    let object = with_transform(object, Some(place * unit));
    Object { kind: layout::FRUSTUM, shape_0: [small / large, 0.0, 0.0, 0.0], ..object }
}

fn light(light: &light::Light) -> Light {
    let color = light.color().into();
    match light {
        light::Light::Point(point) => Light {
            kind: layout::POINT_LIGHT,
            position: point.position.into(),
            color,
            attenuation: point.attenuation.unwrap_or(Vec3::X).into(),
            ..Light::zeroed()
        },
        light::Light::Directional(directional) => {
            let degrees = f64::from(light.angular_radius().min(90.0));
            let (half, _) = fp::sin_cos_degrees(0.5 * degrees);
            Light {
                kind: layout::DIRECTIONAL_LIGHT,
                position: (-directional.direction).normalize_or(Vec3::Y).into(),
                color,
                chord2: (4.0 * half * half) as f32,
                cos_extent: fp::sin_cos_degrees(degrees).1 as f32,
                ..Light::zeroed()
            }
        }
        light::Light::Spot(spot) => {
            let cosine = |degrees: f32| fp::sin_cos_degrees(f64::from(degrees)).1 as f32;
            Light {
                kind: layout::SPOT_LIGHT,
                position: spot.position.into(),
                color,
                axis: spot.direction.normalize_or(Vec3::NEG_Y).into(),
                cos_outer: cosine(spot.angle),
                cos_inner: cosine(spot.inner_angle.min(spot.angle)),
                fade: match spot.fade {
                    light::Fade::Squared => 0,
                    light::Fade::Smooth => 1,
                    light::Fade::Fourth => 2,
                },
                ..Light::zeroed()
            }
        }
        // Photometric lights are refused before the tables are made.
        light::Light::Photometric(_) => {
            Light { kind: layout::POINT_LIGHT, attenuation: Vec3::X.into(), ..Light::zeroed() }
        }
    }
}

#[cfg(test)]
mod tests;
