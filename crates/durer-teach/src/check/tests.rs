//! Tests parts of the checks that no scene covers separately.

use super::containment::containing_objects;
use super::mesh_files::topology::Topology;
use super::*;
use durer_diag::{Diagnostic, Span};
use durer_formats::course::place;
use durer_render::compile::{AccelKind, testing};
use durer_scene::math::random::Random;
use durer_scene::math::{Vec3, fp};
use durer_scene::shape::{Cone, Cuboid, Cylinder, Ellipsoid, Primitive, Shape, Sphere, Torus};

/// Builds a torus with `rows` by `rows` quads, each split into two triangles that face outwards.
fn torus(rows: u32) -> (Vec<Vec3>, Vec<[u32; 3]>) {
    let turn = |i: u32| fp::sin_cos_degrees(f64::from(i) * 360.0 / f64::from(rows));
    let corner = |i: u32, j: u32| {
        let ((sin, cos), (up, out)) = (turn(i), turn(j));
        Vec3::new((cos * (3.0 + out)) as f32, (sin * (3.0 + out)) as f32, up as f32)
    };
    let positions = (0..rows * rows).map(|k| corner(k / rows, k % rows)).collect();
    let at = |i: u32, j: u32| i % rows * rows + j % rows;
    let square = |k: u32| {
        let (i, j) = (k / rows, k % rows);
        let [a, b, c, d] = [at(i, j), at(i + 1, j), at(i + 1, j + 1), at(i, j + 1)];
        [[a, b, c], [a, c, d]]
    };
    (positions, (0..rows * rows).flat_map(square).collect())
}

#[test]
fn sound_mesh_is_closed_and_faces_outwards() {
    let (positions, triangles) = torus(24);
    let topology = Topology::of(&positions, &triangles);
    assert!(topology.is_closed() && topology.reversed.is_empty() && topology.degenerate.is_empty());
    // A torus with radii R and r encloses a volume of 2 pi^2 R r^2. Its polygons enclose slightly
    // less.
    let exact = 2.0 * std::f64::consts::PI * std::f64::consts::PI * 3.0;
    let volume = topology.volume / 6.0;
    assert!(volume < exact && volume > 0.95 * exact, "{volume} of {exact}");
    // It makes no difference if each triangle has its own vertices, because equal positions are
    // merged.
    let apart: Vec<Vec3> = triangles.iter().flatten().map(|&i| positions[i as usize]).collect();
    let own: Vec<[u32; 3]> = (0..triangles.len() as u32).map(|i| [3 * i, 3 * i + 1, 3 * i + 2]).collect();
    assert!(Topology::of(&apart, &own).is_closed());
    let inside_out: Vec<[u32; 3]> = triangles.iter().map(|&[a, b, c]| [a, c, b]).collect();
    let turned = Topology::of(&positions, &inside_out);
    assert!(turned.is_closed() && turned.reversed.is_empty() && turned.volume < 0.0);
}

#[test]
fn reversed_triangles_are_found() {
    let mut random = Random(1);
    let (positions, sound) = torus(16);
    for _ in 0..20 {
        let mut triangles = sound.clone();
        let count = 1 + random.below(sound.len() / 2 - 1);
        let mut turned: Vec<u32> = (0..count).map(|_| random.below(sound.len()) as u32).collect();
        turned.sort_unstable();
        turned.dedup();
        turned.iter().for_each(|&i| triangles[i as usize].swap(1, 2));
        assert_eq!(Topology::of(&positions, &triangles).reversed, turned);
    }
}

#[test]
fn open_and_shared_edges_are_counted() {
    let (positions, mut triangles) = torus(12);
    // Each removed triangle leaves three open edges if none of its neighbours was removed.
    for taken in 1..4 {
        triangles.remove(taken * 40);
        let topology = Topology::of(&positions, &triangles);
        assert_eq!((topology.open, topology.non_manifold), (3 * taken, 0));
    }
    let first = triangles[0];
    triangles.push(first);
    assert_eq!(Topology::of(&positions, &triangles).non_manifold, 3);
    triangles.push([5, 5, 9]);
    triangles.push([7, 8, 7]);
    let last = triangles.len() as u32 - 1;
    assert_eq!(Topology::of(&positions, &triangles).degenerate, [last - 1, last]);
}

#[test]
fn points_are_inside_the_objects_around_them() {
    let shapes: [Primitive; 6] = [
        Sphere { center: Vec3::new(0.2, 0.1, 0.0), radius: 0.8 }.into(),
        Cuboid { min: Vec3::splat(-0.7), max: Vec3::new(0.9, 0.5, 0.6) }.into(),
        Cylinder::default().into(),
        Cone::default().into(),
        Torus::default().into(),
        Ellipsoid::default().into(),
    ];
    let mut random = Random(2);
    let mut inside = 0;
    for shape in shapes {
        let affine = random.affine(2.0, 1.0);
        let world = testing::shapes(&[(shape.clone(), affine)], AccelKind::Bvh);
        for _ in 0..300 {
            let local = 1.5 * random.point();
            let point = affine.transform_point3(local.as_dvec3()).as_vec3();
            // Within rounding error, either answer is correct.
            let near = |far: f64| shape.inside(local.as_dvec3() * (1.0 + far));
            if near(1e-4) != near(-1e-4) {
                continue;
            }
            let truly = shape.inside(local.as_dvec3()) == Some(true);
            inside += usize::from(truly);
            assert_eq!(!containing_objects(&world, point).is_empty(), truly, "{shape:?} at {local}");
        }
    }
    assert!(inside > 100);
}

#[test]
fn values_are_found_in_their_blocks() {
    let text =
        b"# center 9\nSphere { center 1 2.5 -3 radius 4 }\nSphere { radius 5 center 0 0 0 radius 6 { radius 7 } }";
    let keyword = |nth: usize| {
        let found = text.windows(6).enumerate().filter(|(_, word)| word == b"Sphere").nth(nth).unwrap().0 as u32;
        Span { file: 0, start: found, end: found + 6 }
    };
    let value = |nth, field| {
        place::value(text, keyword(nth), field)
            .map(|s| std::str::from_utf8(&text[s.start as usize..s.end as usize]).unwrap())
    };
    assert_eq!(value(0, "center"), Some("1 2.5 -3"));
    assert_eq!(value(0, "radius"), Some("4"));
    // The last of several values counts. Values in inner blocks do not count.
    assert_eq!(value(1, "radius"), Some("6"));
    assert_eq!(value(1, "offset"), None);
    assert_eq!(place::block(text, keyword(0)).map(|s| (s.start, s.end)), Some((11, 46)));
    assert_eq!(place::section(text, 0, "Sphere").map(|s| s.start), Some(keyword(1).start));
}

#[test]
fn edits_are_applied_unless_they_overlap() {
    let text = b"numObjects 3 radius -1 center 0";
    let span = |start, end| Span { file: 0, start, end };
    let finding = |edits: &[(u32, u32, &str)]| {
        let start = Diagnostic::warning("it is odd");
        Finding::from(edits.iter().fold(start, |d, &(a, b, text)| d.fix(span(a, b), text)))
    };
    let findings = [
        finding(&[(20, 22, "1")]),
        finding(&[(11, 12, "2"), (30, 31, "5 5 5")]),
        // This edit overlaps the first edit or is beyond the end of the text.
        finding(&[(19, 21, "x")]),
        finding(&[(40, 41, "x")]),
        finding(&[]),
    ];
    let repaired = apply(text, 0, &findings);
    assert_eq!(String::from_utf8(repaired.bytes).unwrap(), "numObjects 2 radius 1 center 5 5 5");
    assert_eq!(repaired.fixed, [0, 1]);
    assert_eq!(apply(text, 1, &findings).bytes, text);
}

#[test]
fn causes_come_before_consequences() {
    let finding = |severity: fn(&'static str) -> Diagnostic, code, whole| {
        Finding::from(severity("odd").code(code)).affecting_whole_picture(whole)
    };
    let (error, warning, note) = (|m| Diagnostic::error(m), |m| Diagnostic::warning(m), |m| Diagnostic::note(m));
    let found = ordered(vec![
        finding(note, "unused-material", false),
        finding(warning, "too-bright", false),
        finding(warning, "not-finite", true),
        finding(warning, "light-behind", true),
        finding(warning, "light-behind", true),
        finding(warning, "camera-away", true),
        finding(error, "missing-file", false),
        finding(error, "syntax", false),
    ]);
    let codes: Vec<&str> = found.iter().map(|finding| finding.diagnostic.code).collect();
    let expected = [
        "missing-file",
        "syntax",
        "camera-away",
        "light-behind",
        "not-finite",
        "light-behind",
        "too-bright",
        "unused-material",
    ];
    assert_eq!(codes, expected);
    // If there are many findings of one kind, only a few are reported.
    let many = ordered((0..9).map(|_| finding(warning, "same-place", false)).collect());
    assert!(many.len() < 6, "{many:?}");
    assert!(many.last().unwrap().diagnostic.message.ends_with("more of this kind"));
}
