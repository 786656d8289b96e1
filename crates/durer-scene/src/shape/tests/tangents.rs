//! Compares tangents with those of another implementation of Mikkelsen's algorithm.

use crate::math::random::Random;
use crate::math::{Vec2, Vec3};
use crate::shape::MeshData;
use bevy_mikktspace::{Geometry, TangentSpace, generate_tangents};

/// Adapter that passes a mesh to the other implementation and stores the tangents that it computes.
struct ReferenceMesh<'a>(&'a MeshData, Vec<[f32; 4]>);

impl Geometry for ReferenceMesh<'_> {
    fn num_faces(&self) -> usize {
        self.0.triangles.len()
    }
    fn num_vertices_of_face(&self, _: usize) -> usize {
        3
    }
    fn position(&self, face: usize, corner: usize) -> [f32; 3] {
        self.0.positions[self.0.triangles[face][corner] as usize].to_array()
    }
    fn normal(&self, face: usize, corner: usize) -> [f32; 3] {
        self.0.normals[self.0.triangle_normals[face][corner] as usize].to_array()
    }
    fn tex_coord(&self, face: usize, corner: usize) -> [f32; 2] {
        self.0.uvs[self.0.triangle_uvs[face][corner] as usize].to_array()
    }
    fn set_tangent(&mut self, tangent: Option<TangentSpace>, face: usize, corner: usize) {
        self.1[3 * face + corner] = tangent.map_or([0.0; 4], |tangent| tangent.tangent_encoded());
    }
}

/// Returns a bumpy sheet of squares, each of which is cut into two triangles. `uv` returns the
/// texture coordinates of a grid point.
fn sheet(size: usize, random: &mut Random, uv: impl Fn(usize, usize) -> Vec2) -> MeshData {
    let mut data = MeshData::default();
    for (y, x) in (0..=size).flat_map(|y| (0..=size).map(move |x| (y, x))) {
        let height = 0.3 * random.between(-1.0, 1.0);
        data.positions.push(Vec3::new(x as f32, y as f32, height));
        data.normals.push(Vec3::new(0.4 * random.between(-1.0, 1.0), 0.4 * random.between(-1.0, 1.0), 1.0).normalize());
        data.uvs.push(uv(x, y));
    }
    let at = |x: usize, y: usize| (y * (size + 1) + x) as u32;
    for (y, x) in (0..size).flat_map(|y| (0..size).map(move |x| (y, x))) {
        let (a, b, c, d) = (at(x, y), at(x + 1, y), at(x + 1, y + 1), at(x, y + 1));
        data.triangles.extend([[a, b, c], [a, c, d]]);
    }
    index(data)
}

fn index(mut data: MeshData) -> MeshData {
    (data.triangle_normals, data.triangle_uvs) = (data.triangles.clone(), data.triangles.clone());
    data
}

/// Compares the tangents at every corner, and returns the number of vertices that were added by
/// splitting.
fn agree(mut data: MeshData) -> usize {
    let mut other = ReferenceMesh(&data, vec![[0.0; 4]; 3 * data.triangles.len()]);
    generate_tangents(&mut other).unwrap();
    let theirs = other.1;
    let before = data.positions.clone();
    let places: Vec<Vec3> = data.triangles.iter().flatten().map(|&i| data.positions[i as usize]).collect();
    let originals = data.make_tangents();
    assert_eq!(data.tangents.len(), data.positions.len());
    for (copy, &original) in data.positions[before.len()..].iter().zip(&originals) {
        assert_eq!(*copy, before[original as usize]);
    }
    for (corner, (&vertex, theirs)) in data.triangles.iter().flatten().zip(theirs).enumerate() {
        assert_eq!(data.positions[vertex as usize], places[corner]);
        let ours = data.tangents[vertex as usize];
        let far = ours.iter().zip(theirs).map(|(a, b)| (a - b).abs()).fold(0.0, f32::max);
        assert!(far < 1e-4, "corner {corner}: {ours:?}, expected {theirs:?}");
    }
    originals.len()
}

#[test]
fn tangents_match_mikktspace() {
    let mut random = Random(41);
    let bent: Vec<Vec2> =
        (0..400).map(|_| 0.3 * Vec2::new(random.between(-1.0, 1.0), random.between(-1.0, 1.0))).collect();
    let even = |x: usize, y: usize| Vec2::new(x as f32, y as f32) + bent[(17 * y + x) % 400];
    assert_eq!(agree(sheet(12, &mut random, even)), 0);
    // If the texture coordinates are mirrored at a line, the vertices on that line have two
    // tangents.
    assert_eq!(agree(sheet(12, &mut random, |x, y| Vec2::new(x.abs_diff(6) as f32, y as f32))), 13);
    // The texture coordinates are rotated by a right angle from each square to the next, so that u
    // increases in all directions.
    let folded = |x: usize, y: usize| even(x, y) * Vec2::new([1.0, -1.0][x % 2], [1.0, 1.0, -1.0][y % 3]);
    agree(sheet(12, &mut random, folded));
}

#[test]
fn equal_vertices_share_a_tangent() {
    let mut random = Random(42);
    let together = sheet(5, &mut random, |x, y| Vec2::new(x as f32 + 0.2 * y as f32, y as f32));
    // Use the same sheet, but with separate corners for each triangle.
    let mut apart = MeshData::default();
    for &i in together.triangles.iter().flatten() {
        apart.positions.push(together.positions[i as usize]);
        apart.normals.push(together.normals[i as usize]);
        apart.uvs.push(together.uvs[i as usize]);
    }
    apart.triangles = (0..together.triangles.len() as u32).map(|t| [3 * t, 3 * t + 1, 3 * t + 2]).collect();
    let mut apart = index(apart);
    let corners = together.triangles.clone();
    let mut together = together;
    together.make_tangents();
    apart.make_tangents();
    for (i, &vertex) in corners.iter().flatten().enumerate() {
        assert_eq!(apart.tangents[i], together.tangents[vertex as usize]);
    }
}

#[test]
fn hostile_meshes_do_not_overflow_the_stack() {
    // Recursive implementations overflow the stack in this case, because all triangles share one
    // vertex.
    const COUNT: u32 = 200_000;
    let mut fan = MeshData::default();
    fan.positions.push(Vec3::ZERO);
    fan.positions.extend((0..=COUNT).map(|i| Vec3::new(1.0, i as f32 / COUNT as f32, 0.0)));
    fan.normals = vec![Vec3::Z; fan.positions.len()];
    fan.uvs = fan.positions.iter().map(|p| Vec2::new(p.x, p.y)).collect();
    fan.triangles = (1..=COUNT).map(|i| [0, i, i + 1]).collect();
    let mut fan = index(fan);
    assert!(fan.make_tangents().is_empty());
    assert!((Vec3::from_slice(&fan.tangents[0]) - Vec3::X).length() < 1e-3 && fan.tangents[0][3] == 1.0);
    // All vertices have one position but different texture coordinates.
    let mut heap = MeshData { positions: vec![Vec3::ONE; 3 * COUNT as usize], ..MeshData::default() };
    heap.normals = vec![Vec3::Y; heap.positions.len()];
    heap.uvs = (0..heap.positions.len()).map(|i| Vec2::new(i as f32, (i * i % 97) as f32)).collect();
    heap.triangles = (0..COUNT).map(|t| [3 * t, 3 * t + 1, 3 * t + 2]).collect();
    let mut heap = index(heap);
    heap.make_tangents();
    assert!(heap.tangents.iter().all(|tangent| *tangent == [0.0; 4]));
    // All tangents must be finite, even for arbitrary values.
    let mut random = Random(43);
    let values = [0.0, -0.0, 1.0, -1.0, f32::NAN, f32::INFINITY, 3e38, 1e-38, 0.5];
    for _ in 0..2_000 {
        let mut value = || values[(random.between(0.0, 9.0) as usize).min(8)];
        let count = 7;
        let mut data = MeshData::default();
        for _ in 0..count {
            data.positions.push(Vec3::new(value(), value(), value()));
            data.normals.push(Vec3::new(value(), value(), value()));
            data.uvs.push(Vec2::new(value(), value()));
        }
        let mut corner = || (random.between(0.0, 7.0) as u32).min(6);
        data.triangles = (0..8).map(|_| [corner(), corner(), corner()]).collect();
        let mut data = index(data);
        data.make_tangents();
        assert!(data.tangents.iter().flatten().all(|x| x.is_finite()), "{data:?}");
    }
}
