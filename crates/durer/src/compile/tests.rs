//! What is refused on the way to a world, and with what words.

use super::testing::try_read;
use super::*;
use crate::dialect::Dialect;
use std::path::Path;

const CAMERA: &str = "PerspectiveCamera { center 0 0 9 direction 0 0 -1 up 0 1 0 angle 40 }\n";

fn errors(text: &str, accel: AccelKind) -> Vec<String> {
    let (world, findings) = try_read(&format!("{CAMERA}{text}"), Dialect::Durer.rules(), accel, Path::new("."));
    assert_eq!(world.is_none(), findings.has_errors());
    let errors = findings.iter().filter(|d| d.severity == crate::diag::Severity::Error);
    errors.map(|d| d.message.clone()).collect()
}

#[test]
fn transforms_that_flatten_space_are_refused() {
    let ball = "Sphere { center 0 0 0 radius 1 }";
    let flat = "flatten space, or leave the range of numbers";
    for ops in [
        "Matrix { 1 2 3 0  2 4 6 0  0 0 1 0  0 0 0 1 }",
        "Matrix { 0 0 0 0  0 0 0 0  0 0 0 0  0 0 0 1 }",
        "UniformScale 1e30 UniformScale 1e30",
        "UniformScale 1e-30 UniformScale 1e-30",
    ] {
        let found = errors(&format!("Group {{ Transform {{ {ops} {ball} }} }}"), AccelKind::Bvh);
        assert!(found.len() == 1 && found[0].contains(flat), "{ops}: {found:?}");
    }
    assert_eq!(errors(&format!("Group {{ Transform {{ UniformScale 1e-20 {ball} }} }}"), AccelKind::Bvh), [""; 0]);
    assert_eq!(errors("Group { Transform { Scale 1 0 1 Sphere { center 0 0 0 radius 1 } } }", AccelKind::Bvh).len(), 1);
}

#[test]
fn materials_that_double_or_nest_too_deeply_are_refused() {
    let chain = |count: usize, solid: &dyn Fn(usize) -> String| {
        let solids: String = (0..count).map(solid).collect();
        errors(&format!("Materials {{ Material {{ }} {solids} }} Group {{ }}"), AccelKind::Bvh)
    };
    let doubled = |i: usize| format!("Noise {{ materialIndex {i} materialIndex {i} octaves 1 }} ");
    let nested = |i: usize| format!("Checkerboard {{ materialIndex {i} materialIndex 0 }} ");
    assert_eq!(chain(12, &doubled), [""; 0]);
    assert_eq!(chain(60, &doubled), ["this material is made of others 13 deep and 8192 in all"]);
    assert_eq!(chain(64, &nested), [""; 0]);
    assert_eq!(chain(100_000, &nested), ["this material is made of others 65 deep and 66 in all"]);
}

#[test]
fn a_grid_of_cells_needs_a_volume() {
    let grid = |max: &str| {
        errors(
            &format!(
                "Group {{ Grid {{ min 0 0 0 max {max} numCells 2 2 2 rasterizeSphere {{ center 0 0 0 radius 1 }} }} }}"
            ),
            AccelKind::Bvh,
        )
    };
    assert_eq!(grid("1 1 1"), [""; 0]);
    for max in ["1 0 1", "1 1 -1"] {
        assert_eq!(grid(max), ["each coordinate of this grid's `max` must be greater than that of its `min`"]);
    }
}

#[test]
fn grids_that_cannot_be_made_are_refused() {
    let balls = "Sphere { center 0 0 0 radius 1 } ".repeat(1000);
    assert_eq!(errors(&format!("Group {{ {balls} }}"), AccelKind::Grid(Some([0, 1, 1]))).len(), 1);
    assert_eq!(errors(&format!("Group {{ {balls} }}"), AccelKind::Grid(Some([256, 256, 256]))).len(), 1);
    assert_eq!(errors(&format!("Group {{ {balls} }}"), AccelKind::Grid(None)), [""; 0]);
    // Nothing bounded: no grid is needed.
    assert_eq!(errors("Group { Plane { normal 0 1 0 offset 0 } }", AccelKind::Grid(None)), [""; 0]);
}
