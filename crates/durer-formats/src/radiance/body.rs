//! Merges all surfaces that have the same material into one mesh. Dürer keeps track of the objects
//! that contain the current point of a ray, so the surface of a glass body must be a single object.
//! In addition, many small objects need more memory and time than their triangles do.

use durer_diag::Span;
use durer_scene::math::{Vec3, fp};
use durer_scene::shape::MeshData;
use durer_scene::shape::mesh::NO_INDEX;
use glam::{DAffine3, DVec3};

/// Faces, each of which is given by its corners.
pub(super) type Facets = Vec<Vec<DVec3>>;

/// Number of sides of a tessellated round surface.
const SIDES: u32 = 128;

/// Mesh of all surfaces that share a material. The reader adds the surfaces to the mesh one by one.
pub(super) struct MaterialMesh {
    data: MeshData,
    pub at: Span,
}

impl MaterialMesh {
    pub fn new(at: Span) -> Self {
        MaterialMesh { data: MeshData { flat: true, ..MeshData::default() }, at }
    }

    /// Adds a flat face that has already been triangulated.
    pub fn add_face(&mut self, corners: &[Vec3], triangles: &[[usize; 3]]) {
        let first = self.data.positions.len() as u32;
        self.data.positions.extend(corners);
        for triangle in triangles {
            self.data.triangles.push(triangle.map(|i| first + i as u32));
            self.data.triangle_normals.push([NO_INDEX; 3]);
        }
    }

    /// Adds the lateral surface of a cone or cylinder between two points, with a radius at each
    /// point. There are no caps. The normals point outwards, or inwards if `inverted` is true.
    pub fn add_side(&mut self, [base, top]: [DVec3; 2], radii: [f64; 2], map: DAffine3, inverted: bool) {
        let along = top - base;
        let axis = along.normalize_or(DVec3::Z);
        let (x, y) = axis.any_orthonormal_pair();
        let (first, normals) = (self.data.positions.len() as u32, self.data.normals.len() as u32);
        let flipped = inverted != (map.matrix3.determinant() < 0.0);
        for i in 0..SIDES {
            let (sin, cos) = fp::sin_cos_degrees(360.0 * f64::from(i) / f64::from(SIDES));
            let outwards = cos * x + sin * y;
            let normal = along.length() * outwards + (radii[0] - radii[1]) * axis;
            let normal = map.transform_vector3(normal).normalize_or_zero();
            self.data.normals.push(if inverted { -normal } else { normal }.as_vec3());
            for (end, radius) in [base, top].into_iter().zip(radii) {
                self.data.positions.push(map.transform_point3(end + radius * outwards).as_vec3());
            }
        }
        for i in 0..SIDES {
            let j = (i + 1) % SIDES;
            let corner = |i: u32, end: u32| (first + 2 * i + end, normals + i);
            let mut triangle = |corners: [(u32, u32); 3]| {
                let [a, b, c] = if flipped { [corners[0], corners[2], corners[1]] } else { corners };
                self.data.triangles.push([a.0, b.0, c.0]);
                self.data.triangle_normals.push([a.1, b.1, c.1]);
            };
            if radii[0] > 0.0 {
                triangle([corner(i, 0), corner(j, 0), corner(j, 1)]);
            }
            if radii[1] > 0.0 {
                triangle([corner(i, 0), corner(j, 1), corner(i, 1)]);
            }
        }
    }

    /// Adds a flat ring in world space.
    pub fn add_ring(&mut self, center: DVec3, normal: DVec3, [inner, outer]: [f64; 2]) {
        let (x, y) = normal.any_orthonormal_pair();
        let first = self.data.positions.len() as u32;
        for i in 0..SIDES {
            let (sin, cos) = fp::sin_cos_degrees(360.0 * f64::from(i) / f64::from(SIDES));
            for radius in [inner, outer] {
                self.data.positions.push((center + radius * (cos * x + sin * y)).as_vec3());
            }
        }
        for i in 0..SIDES {
            let corner = |i: u32, end: u32| first + 2 * (i % SIDES) + end;
            self.data.triangles.push([corner(i, 0), corner(i, 1), corner(i + 1, 1)]);
            self.data.triangle_normals.push([NO_INDEX; 3]);
            if inner > 0.0 {
                self.data.triangles.push([corner(i, 0), corner(i + 1, 1), corner(i + 1, 0)]);
                self.data.triangle_normals.push([NO_INDEX; 3]);
            }
        }
    }

    /// Returns the bounding box, as its minimum and maximum corners.
    pub fn bounds(&self) -> [Vec3; 2] {
        let all = || self.data.positions.iter().copied();
        [all().fold(Vec3::INFINITY, Vec3::min), all().fold(Vec3::NEG_INFINITY, Vec3::max)]
    }

    /// Returns the mesh.
    pub fn finish(mut self) -> MeshData {
        if self.data.normals.is_empty() {
            self.data.triangle_normals.clear();
        }
        self.data
    }
}
