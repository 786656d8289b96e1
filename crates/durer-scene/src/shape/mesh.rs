//! Triangle meshes: indexed triangles with optional normals and texture coordinates.

use super::height_field::Terrain;
pub use super::mesh_data::{MeshData, NO_INDEX, Triangles, enlarged, position_key};
use super::normals::{Normals, computed, of_terrain};
use super::triangle::triangle_surface;
use super::{ShapeHit, SurfacePoint};
use crate::describe::{Constraint, FileName, described};
use crate::dialect::{MeshNormals, set};
use crate::math::{Aabb, Vec2, Vec3};
use crate::source::Digest;
use durer_bvh::{BuildQuality, TriangleBvh};
use std::borrow::Cow;
use std::sync::Arc;

described! {
    /// A triangle mesh in a separate file.
    TriangleMesh ["TriangleMesh" in set::CLASSIC, "mesh" in set::F23] {
        /// Path of the mesh file: `.obj`, `.ply` or `.stl`.
        obj_file: FileName = FileName::default(), required, Constraint::Any, ["obj_file" in set::ALL];
    }
}

/// Triangle mesh that is ready for rendering. The mesh is made from mesh data or a height field,
/// and its normals have been computed.
#[derive(Clone, Debug, Default)]
pub struct Mesh {
    storage: TriangleStorage,
    /// Computed normals, which replace the normals in `storage`.
    computed_normals: Option<Normals>,
    center: Vec3,
}

/// Storage for the triangles of a mesh: either lists, or a terrain that computes the triangles on
/// demand.
#[derive(Clone, Debug)]
enum TriangleStorage {
    /// Lists of triangles, which are shared with the scene description unless they were changed.
    Lists(Arc<MeshData>),
    Terrain(Terrain),
}

impl Default for TriangleStorage {
    fn default() -> Self {
        TriangleStorage::Lists(Arc::default())
    }
}

impl Mesh {
    /// Creates a mesh from the data of a mesh file. `rule` computes the normals of all triangles,
    /// or only those of triangles without normals if `file_normals` is set.
    pub fn new(data: impl Into<Arc<MeshData>>, rule: MeshNormals, file_normals: bool) -> Self {
        let data = data.into();
        let computed_normals = computed(&data, rule, file_normals);
        Mesh { storage: TriangleStorage::Lists(data), computed_normals, center: Vec3::ZERO }
    }

    /// Creates a mesh from a height field, and computes its normals with `rule`.
    pub fn of_terrain(terrain: Terrain, rule: MeshNormals) -> Self {
        let computed_normals = of_terrain(&terrain, rule);
        Mesh { storage: TriangleStorage::Terrain(terrain), computed_normals, center: Vec3::ZERO }
    }

    /// Moves the mesh to the origin if it is [far](Aabb::is_far) from the origin. The mesh moves
    /// only along axes for which `f32` represents the result exactly.
    pub fn centered(mut self) -> Self {
        let bounds = match &self.storage {
            TriangleStorage::Lists(data) => Aabb::around(data.positions.iter().copied()),
            TriangleStorage::Terrain(terrain) => terrain.bounds(),
        };
        if bounds.is_far() {
            let middle = bounds.center();
            let stays = |axis: usize, x: f32| f64::from(x - middle[axis]) == f64::from(x) - f64::from(middle[axis]);
            let by = match &self.storage {
                TriangleStorage::Lists(data) => {
                    [0, 1, 2].map(|axis| data.positions.iter().all(|p| stays(axis, p[axis])))
                }
                TriangleStorage::Terrain(terrain) => terrain.all_along(stays),
            };
            self.center = Vec3::from_array([0, 1, 2].map(|axis| if by[axis] { middle[axis] } else { 0.0 }));
            if self.center != Vec3::ZERO {
                match &mut self.storage {
                    TriangleStorage::Lists(data) => {
                        Arc::make_mut(data).positions.iter_mut().for_each(|p| *p -= self.center)
                    }
                    TriangleStorage::Terrain(terrain) => *terrain = terrain.translated(self.center),
                }
            }
        }
        self
    }

    /// True if none of the triangles has vertex normals.
    pub fn is_flat(&self) -> bool {
        (0..self.len() as u32).all(|triangle| self.corner_normals(triangle).is_none())
    }

    /// Returns the vertex normals and three normal indices for each triangle. Both lists may be
    /// empty.
    pub fn normals(&self) -> (&[Vec3], Cow<'_, [[u32; 3]]>) {
        match (&self.computed_normals, &self.storage) {
            (Some(made), TriangleStorage::Lists(data)) => (&made.values, made.listed(&**data)),
            (Some(made), TriangleStorage::Terrain(terrain)) => (&made.values, made.listed(terrain)),
            (None, TriangleStorage::Lists(data)) => (&data.normals, Cow::Borrowed(&data.triangle_normals)),
            (None, TriangleStorage::Terrain(_)) => (&[], Cow::Borrowed(&[])),
        }
    }

    /// Returns the mesh with its normals replaced by normals that `rule` computes.
    pub fn with_normals(&self, rule: MeshNormals) -> Mesh {
        let mesh = match &self.storage {
            TriangleStorage::Lists(data) => Mesh::new(data.clone(), rule, false),
            TriangleStorage::Terrain(terrain) => Mesh::of_terrain(terrain.clone(), rule),
        };
        Mesh { center: self.center, ..mesh }
    }

    /// Returns the mesh with a second triangle added to each triangle, so that the two form a
    /// parallelogram. The normals are extrapolated.
    pub fn with_parallelograms(&self) -> Mesh {
        let mut data = self.to_data().into_owned();
        let (normals, triangle_normals) = self.normals();
        (data.normals, data.triangle_normals) = (normals.to_vec(), triangle_normals.into_owned());
        fn halves(triangles: &mut Vec<[u32; 3]>, values: &mut Vec<Vec3>) {
            for i in 0..triangles.len() {
                let [a, b, c] = triangles[i];
                let at = |i: u32| values.get(i as usize).copied().unwrap_or_default();
                let fourth = at(b) + at(c) - at(a);
                triangles.push([b, values.len() as u32, c]);
                values.push(fourth);
            }
        }
        halves(&mut data.triangles, &mut data.positions);
        halves(&mut data.triangle_normals, &mut data.normals);
        (data.triangle_uvs, data.vertices) = Default::default();
        (data.colors, data.second_uvs, data.tangents) = Default::default();
        Mesh { storage: TriangleStorage::Lists(data.into()), computed_normals: None, center: self.center }
    }

    /// Returns the mesh with each triangle scaled by the factor `times` about one of its corners.
    /// The normals are extrapolated.
    pub fn with_scaled_triangles(&self, corner: usize, times: f32) -> Mesh {
        let mut data = self.to_data().into_owned();
        let (normals, triangle_normals) = self.normals();
        (data.normals, data.triangle_normals) = (normals.to_vec(), triangle_normals.into_owned());
        fn apart(triangles: &mut [[u32; 3]], values: &mut Vec<Vec3>, corner: usize, times: f32) {
            let old = std::mem::take(values);
            for triangle in triangles {
                let all = triangle.map(|i| old.get(i as usize).copied().unwrap_or_default());
                *triangle = [0, 1, 2].map(|i| (values.len() + i) as u32);
                values.extend(all.map(|value| all[corner] + times * (value - all[corner])));
            }
        }
        apart(&mut data.triangles, &mut data.positions, corner, times);
        if !data.triangle_normals.is_empty() {
            apart(&mut data.triangle_normals, &mut data.normals, corner, times);
        }
        (data.triangle_uvs, data.vertices) = Default::default();
        (data.colors, data.second_uvs, data.tangents) = Default::default();
        Mesh { storage: TriangleStorage::Lists(data.into()), computed_normals: None, center: self.center }
    }

    /// Computes a hash of the whole mesh.
    pub fn digest(&self) -> Digest {
        let (normals, triangles) = self.normals();
        let (normals, triangles) = (normals.to_vec(), triangles.into_owned());
        let own = MeshData { normals, triangles, ..MeshData::default() };
        let of_form = match &self.storage {
            TriangleStorage::Lists(data) => data.digest(),
            TriangleStorage::Terrain(terrain) => terrain.digest(),
        };
        Digest::of(format!("{of_form} {} {:?}", own.digest(), self.center).as_bytes())
    }

    /// Returns the mesh as lists. The normals in these lists may differ from those that
    /// [`Mesh::normals`] returns.
    pub fn to_data(&self) -> Cow<'_, MeshData> {
        match &self.storage {
            TriangleStorage::Lists(data) => Cow::Borrowed(data),
            TriangleStorage::Terrain(terrain) => Cow::Owned(terrain.to_data()),
        }
    }

    /// Builds a BVH over the triangles.
    pub fn tree(&self, quality: BuildQuality) -> TriangleBvh {
        match &self.storage {
            TriangleStorage::Lists(data) => TriangleBvh::build(&data.positions, &data.triangles, quality),
            TriangleStorage::Terrain(terrain) => terrain.tree(quality),
        }
    }

    /// Returns the linear colour and opacity of each vertex. The list may be empty.
    pub fn colors(&self) -> &[[f32; 4]] {
        self.lists().map_or(&[], |data| &data.colors)
    }

    /// Returns the texture coordinates of a triangle if they are equal at all three corners.
    pub fn constant_uv(&self) -> Option<Vec2> {
        let uvs = &self.lists()?.uvs;
        let first = *uvs.first()?;
        uvs.iter().all(|uv| (*uv - first).abs().max_element() < 1e-6).then_some(first)
    }

    /// True if the mesh is a height field.
    pub fn is_terrain(&self) -> bool {
        matches!(self.storage, TriangleStorage::Terrain(_))
    }

    fn lists(&self) -> Option<&MeshData> {
        match &self.storage {
            TriangleStorage::Lists(data) => Some(data),
            TriangleStorage::Terrain(_) => None,
        }
    }

    /// Returns the point that [`Mesh::centered`] moved to the origin, or zero if the mesh was not
    /// moved.
    pub fn center(&self) -> Vec3 {
        self.center
    }

    /// Number of triangles.
    pub fn len(&self) -> usize {
        match &self.storage {
            TriangleStorage::Lists(data) => data.triangles.len(),
            TriangleStorage::Terrain(terrain) => terrain.len(),
        }
    }

    /// True if the mesh has no triangles.
    pub fn is_empty(&self) -> bool {
        self.len() == 0
    }

    /// Size of the mesh in memory, in bytes, without the acceleration structure.
    pub fn bytes(&self) -> usize {
        let made = self.computed_normals.as_ref();
        let own = match &self.storage {
            TriangleStorage::Lists(data) => data.bytes(),
            TriangleStorage::Terrain(terrain) => terrain.grid().memory_usage(),
        };
        own + made.map_or(0, Normals::bytes)
    }

    /// Returns the edges that are shared by an odd number of triangles. In a mesh without such
    /// edges, every line crosses the surface an even number of times. Corners at the same position
    /// count as one corner.
    pub fn open_edges(&self) -> Vec<[Vec3; 2]> {
        // A height field with walls and a floor is always closed.
        if self.lists().is_none() {
            return Vec::new();
        }
        let mut edges: Vec<([[u32; 3]; 2], [Vec3; 2])> = Vec::with_capacity(3 * self.len());
        for triangle in 0..self.len() as u32 {
            let [a, b, c] = self.corners(triangle);
            for [p, q] in [[a, b], [b, c], [c, a]] {
                let (k, l) = (position_key(p), position_key(q));
                if k != l {
                    edges.push(([k.min(l), k.max(l)], [p, q]));
                }
            }
        }
        edges.sort_unstable_by_key(|edge| edge.0);
        edges.chunk_by(|a, b| a.0 == b.0).filter(|same| same.len() % 2 == 1).map(|same| same[0].1).collect()
    }

    /// Returns the corners of a triangle.
    #[inline]
    pub fn corners(&self, triangle: u32) -> [Vec3; 3] {
        match &self.storage {
            TriangleStorage::Lists(data) => data.corners(triangle as usize),
            TriangleStorage::Terrain(terrain) => terrain.corners(triangle as usize),
        }
    }

    /// Returns the interpolated normal of a triangle at a crossing, without normalizing it, or
    /// `None` if the triangle is flat.
    pub fn interpolated_normal(&self, triangle: u32, uv: Vec2) -> Option<Vec3> {
        let [a, b, c] = self.corner_normals(triangle)?.map(Vec3::normalize_or_zero);
        Some((1.0 - uv.x - uv.y) * a + uv.x * b + uv.y * c)
    }

    /// True if some triangles may have vertex normals.
    pub fn has_normals(&self) -> bool {
        self.computed_normals.is_some() || self.lists().is_some_and(|data| !data.normals.is_empty())
    }

    /// Returns the normals at the corners of a triangle, if it has normals.
    #[inline]
    pub fn corner_normals(&self, triangle: u32) -> Option<[Vec3; 3]> {
        match (&self.computed_normals, &self.storage) {
            (Some(made), TriangleStorage::Lists(data)) => made.of_triangle(&**data, triangle as usize),
            (Some(made), TriangleStorage::Terrain(terrain)) => made.of_triangle(terrain, triangle as usize),
            (None, TriangleStorage::Lists(data)) => attribute(&data.triangle_normals, &data.normals, triangle),
            (None, TriangleStorage::Terrain(_)) => None,
        }
    }

    /// Returns the texture coordinates at the corners of a triangle, if it has any.
    #[inline]
    pub fn corner_uvs(&self, triangle: u32) -> Option<[Vec2; 3]> {
        match &self.storage {
            TriangleStorage::Lists(data) => attribute(&data.triangle_uvs, &data.uvs, triangle),
            TriangleStorage::Terrain(terrain) => {
                Some(terrain.triangle(triangle as usize).map(|vertex| terrain.uv(vertex)))
            }
        }
    }

    /// Returns the interpolated vertex colour and opacity at a point on a triangle.
    fn color(&self, triangle: u32, barycentric: Vec3) -> Option<[f32; 4]> {
        let data = self.lists()?;
        let [a, b, c] = attribute(&data.triangles, &data.colors, triangle)?;
        let Vec3 { x, y, z } = barycentric;
        Some(std::array::from_fn(|i| x * a[i] + y * b[i] + z * c[i]))
    }

    /// Returns the second set of texture coordinates, interpolated at a point on a triangle.
    pub fn second_uv(&self, triangle: u32, barycentric: Vec3) -> Option<Vec2> {
        let data = self.lists()?;
        let [a, b, c] = attribute(&data.triangles, &data.second_uvs, triangle)?;
        Some(barycentric.x * a + barycentric.y * b + barycentric.z * c)
    }

    /// Returns the directions of increasing u and v at a point on a triangle. The directions come
    /// from the tangents in the file, or from the texture coordinates of the triangle if the file
    /// has no tangents.
    pub fn tangents(&self, triangle: u32, barycentric: Vec3, normal: Vec3, second: bool) -> Option<[Vec3; 2]> {
        let tangents = self.lists().and_then(|data| attribute(&data.triangles, &data.tangents, triangle));
        if let Some(corners) = tangents.filter(|_| !second) {
            let [a, b, c] = corners.map(|[x, y, z, _]| Vec3::new(x, y, z));
            let tangent = barycentric.x * a + barycentric.y * b + barycentric.z * c;
            if tangent != Vec3::ZERO {
                return Some([tangent, corners[0][3] * normal.cross(tangent)]);
            }
        }
        self.derivatives(triangle, second)
    }

    /// Returns the partial derivatives of the position on a triangle with respect to u and v.
    pub fn derivatives(&self, triangle: u32, second: bool) -> Option<[Vec3; 2]> {
        let [a, b, c] = match second {
            true => self.lists().and_then(|data| attribute(&data.triangles, &data.second_uvs, triangle))?,
            false => self.corner_uvs(triangle)?,
        };
        let [p, q, r] = self.corners(triangle);
        let (along, across) = (b - a, c - a);
        let area = along.perp_dot(across);
        let u = ((q - p) * across.y - (r - p) * along.y) / area;
        let v = ((r - p) * along.x - (q - p) * across.x) / area;
        (u.is_finite() && v.is_finite() && u != Vec3::ZERO && v != Vec3::ZERO).then_some([u, v])
    }

    /// Computes the surface properties of a triangle at a crossing.
    #[inline]
    pub fn surface(&self, triangle: u32, crossing: &ShapeHit) -> SurfacePoint {
        // Load everything that may miss the cache before starting any computation that depends on
        // it.
        let (corners, normals) = (self.corners(triangle), self.corner_normals(triangle));
        let uvs = self.corner_uvs(triangle);
        let mut surface = triangle_surface(corners, normals, crossing.uv);
        let barycentric = surface.barycentric;
        surface.uv = uvs.map(|[a, b, c]| barycentric.x * a + barycentric.y * b + barycentric.z * c).into();
        surface.color = self.color(triangle, barycentric).unwrap_or([1.0; 4]);
        surface
    }
}

/// Returns the values of an attribute at the corners of a triangle, if all three corners have one.
fn attribute<T: Copy>(indices: &[[u32; 3]], values: &[T], triangle: u32) -> Option<[T; 3]> {
    let [a, b, c] = *indices.get(triangle as usize)?;
    Some([*values.get(a as usize)?, *values.get(b as usize)?, *values.get(c as usize)?])
}
