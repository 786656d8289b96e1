//! Mesh data as it is read from a file.

use crate::math::{Vec2, Vec3};
use crate::source::Digest;

/// Index that marks a missing attribute.
pub const NO_INDEX: u32 = u32::MAX;

/// Returns a key for a position. Corners at the same position have equal keys, and positive and
/// negative zero count as equal.
pub fn position_key(p: Vec3) -> [u32; 3] {
    (p + 0.0).to_array().map(f32::to_bits)
}

/// Triangle mesh that was read from a file or built in code. The mesh consists of lists of vertex
/// attributes and indices.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct MeshData {
    /// Positions of the vertices.
    pub positions: Vec<Vec3>,
    /// Texture coordinates; may be empty.
    pub uvs: Vec<Vec2>,
    /// Normals, not necessarily of unit length; may be empty.
    pub normals: Vec<Vec3>,
    /// Three position indices for each triangle, counter-clockwise as seen from outside.
    pub triangles: Vec<[u32; 3]>,
    /// Three texture coordinate indices for each triangle, or [`NO_INDEX`]. The list is empty if no
    /// triangle has texture coordinates.
    pub triangle_uvs: Vec<[u32; 3]>,
    /// Three normal indices for each triangle, or [`NO_INDEX`]. The list is empty if no triangle
    /// has normals.
    pub triangle_normals: Vec<[u32; 3]>,
    /// Three original vertices for each triangle, or an empty list unless
    /// [`MeshData::separate_and_enlarge`] was called.
    pub vertices: Vec<[u32; 3]>,
    /// Linear red, green, blue and opacity for each position. The list is empty if no vertex has a
    /// colour.
    pub colors: Vec<[f32; 4]>,
    /// Second set of texture coordinates, one for each position; may be empty.
    pub second_uvs: Vec<Vec2>,
    /// Tangents, one for each position; may be empty. The first three components of a tangent are
    /// the direction of increasing u. The fourth component is the sign of the bitangent relative to
    /// the cross product of normal and tangent.
    pub tangents: Vec<[f32; 4]>,
    /// True if triangles without normals stay flat, regardless of the rule for missing normals.
    pub flat: bool,
}

/// Interface to the indexed triangles of a mesh that does not depend on how they are stored.
pub trait Triangles: Sync {
    /// Number of triangles.
    fn len(&self) -> usize;

    /// True if the mesh has no triangles.
    fn is_empty(&self) -> bool {
        self.len() == 0
    }

    /// Number of vertices.
    fn vertices(&self) -> usize;

    /// Returns the vertices at the corners of a triangle, counter-clockwise as seen from outside.
    fn triangle(&self, number: usize) -> [u32; 3];

    /// Returns the position of a vertex.
    fn position(&self, vertex: u32) -> Vec3;

    /// Returns the positions of the corners of a triangle.
    #[inline]
    fn corners(&self, number: usize) -> [Vec3; 3] {
        // A closure passed to `map` would not be inlined here.
        let [a, b, c] = self.triangle(number);
        [self.position(a), self.position(b), self.position(c)]
    }

    /// Number of leading triangles of the mesh for which [`Triangles::ordered_around`] finds
    /// corners without lists.
    fn ordered_count(&self) -> usize {
        0
    }

    /// Calls `offer` for each corner of the leading triangles that is at the given vertex, in
    /// order. Corner k of triangle i has the number 3 i + k.
    fn ordered_around(&self, _vertex: u32, _offer: impl FnMut(u32)) {}
}

impl Triangles for MeshData {
    #[inline]
    fn len(&self) -> usize {
        self.triangles.len()
    }

    #[inline]
    fn vertices(&self) -> usize {
        self.positions.len()
    }

    #[inline]
    fn triangle(&self, number: usize) -> [u32; 3] {
        self.triangles[number]
    }

    #[inline]
    fn position(&self, vertex: u32) -> Vec3 {
        self.positions[vertex as usize]
    }
}

impl MeshData {
    /// Reorders the corners of each triangle so that it faces the same side as its normals. If
    /// `reversed` is set, the normals are negated first, and triangles without normals are flipped.
    /// Afterwards, the mesh is marked as flat.
    pub fn oriented(mut self, reversed: bool) -> MeshData {
        if reversed {
            self.normals.iter_mut().for_each(|n| *n = -*n);
        }
        for i in 0..self.triangles.len() {
            let [a, b, c] = self.triangles[i].map(|i| self.positions[i as usize].as_dvec3());
            let face = (b - a).cross(c - a);
            let normals = self.triangle_normals.get(i).filter(|normals| !normals.contains(&NO_INDEX));
            let turned = match normals {
                Some(normals) => {
                    normals.map(|n| self.normals[n as usize].as_dvec3()).iter().map(|n| face.dot(*n)).sum::<f64>() < 0.0
                }
                None => reversed,
            };
            if turned {
                let lists = [&mut self.triangles, &mut self.triangle_uvs, &mut self.triangle_normals];
                lists.into_iter().filter_map(|list| list.get_mut(i)).for_each(|corners| corners.swap(1, 2));
            }
        }
        self.flat = true;
        self
    }

    /// Checks that the lists are consistent with each other.
    ///
    /// # Errors
    ///
    /// Fails if an index is out of range, a position is not finite, or the per-triangle or
    /// per-position lists differ in length.
    pub fn validate(&self) -> Result<(), String> {
        let below = |triangles: &[[u32; 3]], count: usize| {
            triangles.iter().flatten().all(|&i| (i as usize) < count || i == NO_INDEX)
        };
        let (triangles, positions) = (self.triangles.len(), self.positions.len());
        if self.triangles.iter().flatten().any(|&i| i as usize >= positions) {
            return Err(format!(
                "`triangles` has an index of {positions} or more, but the mesh has only {positions} positions"
            ));
        }
        if !self.positions.iter().all(|p| p.is_finite()) {
            return Err("positions must be finite".into());
        }
        let by_triangle = [
            ("triangle_uvs", &self.triangle_uvs, self.uvs.len()),
            ("triangle_normals", &self.triangle_normals, self.normals.len()),
            ("vertices", &self.vertices, usize::MAX),
        ];
        for (name, list, count) in by_triangle {
            if !list.is_empty() && list.len() != triangles {
                return Err(format!("`{name}` has {} entries for {triangles} triangles", list.len()));
            }
            if !below(list, count) {
                return Err(format!("`{name}` has an index of {count} or more, but there are only {count} values"));
            }
        }
        let by_position =
            [("colors", self.colors.len()), ("second_uvs", self.second_uvs.len()), ("tangents", self.tangents.len())];
        match by_position.into_iter().find(|(_, count)| *count != 0 && *count < positions) {
            Some((name, count)) => Err(format!("`{name}` has {count} entries for {positions} positions")),
            None => Ok(()),
        }
    }

    /// Size of the mesh data in memory, in bytes.
    pub fn bytes(&self) -> usize {
        size_of_val(&*self.positions)
            + size_of_val(&*self.uvs)
            + size_of_val(&*self.normals)
            + size_of_val(&*self.triangles)
            + size_of_val(&*self.triangle_uvs)
            + size_of_val(&*self.triangle_normals)
            + size_of_val(&*self.vertices)
            + size_of_val(&*self.colors)
            + size_of_val(&*self.second_uvs)
            + size_of_val(&*self.tangents)
    }

    /// Computes a hash of the whole mesh.
    pub fn digest(&self) -> Digest {
        let mut hasher = Digest::hasher();
        let floats: [(usize, &mut dyn Iterator<Item = f32>); 6] = [
            (self.positions.len(), &mut self.positions.iter().flat_map(Vec3::to_array)),
            (self.uvs.len(), &mut self.uvs.iter().flat_map(Vec2::to_array)),
            (self.normals.len(), &mut self.normals.iter().flat_map(Vec3::to_array)),
            (self.second_uvs.len(), &mut self.second_uvs.iter().flat_map(Vec2::to_array)),
            (self.colors.len(), &mut self.colors.iter().flatten().copied()),
            (self.tangents.len(), &mut self.tangents.iter().flatten().copied()),
        ];
        for (count, values) in floats {
            hasher.add_u64(count as u64);
            values.for_each(|value| hasher.add_u32(value.to_bits()));
        }
        for list in [&self.triangles, &self.triangle_uvs, &self.triangle_normals, &self.vertices] {
            hasher.add_u64(list.len() as u64);
            list.iter().flatten().for_each(|&index| hasher.add_u32(index));
        }
        hasher.add_u64(self.flat.into());
        hasher.finish()
    }

    /// Assigns normals to corners by position index. Returns false if there are fewer normals than
    /// positions.
    pub fn use_normals_by_vertex(&mut self) -> bool {
        let enough = self.normals.len() >= self.positions.len();
        if enough {
            self.triangle_normals = self.triangles.clone();
        }
        enough
    }

    /// Separates all triangles from each other and enlarges each of them slightly; see
    /// [`enlarged`].
    pub fn separate_and_enlarge(&mut self) {
        let corners = |t: &[u32; 3]| enlarged(t.map(|i| self.positions[i as usize]));
        self.positions = self.triangles.iter().flat_map(corners).collect();
        fn apart<T: Copy>(values: &mut Vec<T>, triangles: &[[u32; 3]]) {
            if !values.is_empty() {
                *values = triangles.iter().flatten().map(|&i| values[i as usize]).collect();
            }
        }
        apart(&mut self.colors, &self.triangles);
        apart(&mut self.second_uvs, &self.triangles);
        apart(&mut self.tangents, &self.triangles);
        let apart = (0..self.triangles.len() as u32).map(|i| [3 * i, 3 * i + 1, 3 * i + 2]).collect();
        self.vertices = std::mem::replace(&mut self.triangles, apart);
    }
}

/// Returns the triangle that contains all points whose barycentric coordinates are at least
/// -0.00001. The result is the original triangle, enlarged about its centroid by the factor
/// 1.00003.
pub fn enlarged([a, b, c]: [Vec3; 3]) -> [Vec3; 3] {
    const SLACK: f64 = 1e-5;
    let corners = [a.as_dvec3(), b.as_dvec3(), c.as_dvec3()];
    let centroid = (corners[0] + corners[1] + corners[2]) / 3.0;
    corners.map(|p| (p + 3.0 * SLACK * (p - centroid)).as_vec3())
}
