//! Example of a mesh format: `.tri` has nine numbers per line, the vertices of a triangle.

use super::report::Report;
use super::{MeshFormat, without_quirks};
use durer_diag::Diagnostics;
use durer_scene::math::Vec3;
use durer_scene::scene::Axis;
use durer_scene::shape::mesh::MeshData;

/// Mesh format of `.tri` files.
pub(super) const FORMAT: MeshFormat =
    MeshFormat { name: "Corners", extensions: &["tri"], recognise, read, apply_quirks: without_quirks, write, up: Axis::Y };

fn numbers(bytes: &[u8]) -> Option<Vec<f32>> {
    std::str::from_utf8(bytes).ok()?.split_whitespace().map(|word| word.parse().ok()).collect()
}

fn recognise(bytes: &[u8]) -> bool {
    numbers(bytes).is_some_and(|numbers| !numbers.is_empty() && numbers.len().is_multiple_of(9))
}

fn read(bytes: &[u8], file: u32, diagnostics: &mut Diagnostics) -> Option<MeshData> {
    let mut report = Report::new(file, diagnostics);
    let corners: Vec<Vec3> = numbers(bytes).unwrap_or_default().chunks_exact(3).map(Vec3::from_slice).collect();
    if corners.is_empty() {
        report.error(0..bytes.len(), "expected nine numbers a line");
    }
    let triangles = (0..corners.len() as u32 / 3).map(|i| [3 * i, 3 * i + 1, 3 * i + 2]).collect();
    report.finish(diagnostics, MeshData { positions: corners, triangles, ..MeshData::default() })
}

fn write(mesh: &MeshData) -> Vec<u8> {
    let line = |triangle: &[u32; 3]| {
        let corners = triangle.map(|i| mesh.positions[i as usize]);
        corners.iter().map(|p| format!("{} {} {} ", p.x, p.y, p.z)).collect::<String>() + "\n"
    };
    mesh.triangles.iter().map(line).collect::<String>().into_bytes()
}
