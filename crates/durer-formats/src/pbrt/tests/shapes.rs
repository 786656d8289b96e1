//! Tests that compare tessellated shapes with analytic results.

use super::*;
use crate::testing::read_with_low_limits;
use durer_scene::math::{Vec3, fp};
use durer_scene::shape::MeshData;
use std::f64::consts::PI;

/// Returns the only mesh of a pbrt-v3 scene.
fn mesh(text: &str) -> MeshData {
    let scene = clean(&format!("Film \"image\" Camera \"perspective\" WorldBegin {text}"));
    assert_eq!(scene.assets.meshes.len(), 1, "{text}");
    (**scene.assets.meshes.values().next().unwrap()).clone()
}

fn area(data: &MeshData) -> f64 {
    let corner = |i: u32| data.positions[i as usize].as_dvec3();
    let twice = |[a, b, c]: &[u32; 3]| (corner(*b) - corner(*a)).cross(corner(*c) - corner(*a)).length();
    0.5 * data.triangles.iter().map(twice).sum::<f64>()
}

/// Returns true if every triangle faces the same side as its normals.
fn faced(data: &MeshData) -> bool {
    data.triangles.iter().zip(&data.triangle_normals).all(|(triangle, normals)| {
        let [a, b, c] = triangle.map(|i| data.positions[i as usize].as_dvec3());
        let normal: Vec3 = normals.iter().map(|&i| data.normals[i as usize]).sum();
        (b - a).cross(c - a).dot(normal.as_dvec3()) > -1e-12
    })
}

#[test]
fn partial_quadrics_have_closed_form_areas() {
    let turn = |degrees: f64| degrees.to_radians();
    for (text, wanted) in [
        // A zone of a sphere has the area 2 pi r h, times the fraction of a full turn.
        ("\"sphere\" \"float radius\" 2 \"float zmin\" -0.5 \"float zmax\" 1.5", 2.0 * PI * 2.0 * 2.0),
        ("\"sphere\" \"float zmin\" 0.6 \"float phimax\" 90", turn(90.0) * 0.4),
        ("\"sphere\" \"float phimax\" 250", turn(250.0) * 2.0),
        (
            "\"cylinder\" \"float radius\" 0.5 \"float zmin\" 1 \"float zmax\" 4 \"float phimax\" 120",
            turn(120.0) * 0.5 * 3.0,
        ),
        ("\"disk\" \"float radius\" 2 \"float innerradius\" 1 \"float phimax\" 300", turn(300.0) / 2.0 * 3.0),
        ("\"cone\" \"float radius\" 3 \"float height\" 4", PI * 3.0 * 5.0),
        // The area of the paraboloid z = r^2 is pi / 6 ((1 + 4 z)^(3/2) - 1).
        ("\"paraboloid\" \"float radius\" 2 \"float zmax\" 4", PI / 6.0 * (17.0 * 17_f64.sqrt() - 1.0)),
        (
            "\"paraboloid\" \"float radius\" 2 \"float zmin\" 1 \"float zmax\" 4",
            PI / 6.0 * (17.0 * 17_f64.sqrt() - 5.0 * 5_f64.sqrt()),
        ),
        // A line that is perpendicular to the axis sweeps a ring. A line that is parallel to the
        // axis sweeps a cylinder.
        ("\"hyperboloid\" \"point p1\" [ 1 0 0 ] \"point p2\" [ 2 0 0 ]", 3.0 * PI),
        ("\"hyperboloid\" \"point p1\" [ 1 0 0 ] \"point p2\" [ 1 0 3 ]", 6.0 * PI),
    ] {
        let data = mesh(&format!("Shape {text}"));
        assert!((area(&data) / wanted - 1.0).abs() < 2e-3, "{text}: {} is not {wanted}", area(&data));
        assert!(faced(&data), "{text}");
    }
}

#[test]
fn quadrics_face_outwards_and_have_pbrt_uv() {
    for (text, outwards) in [
        ("\"sphere\" \"float zmax\" 0.5", 1.0),
        ("\"cylinder\" \"float phimax\" 200", 1.0),
        ("\"cone\"", 1.0),
        ("\"paraboloid\"", 1.0),
    ] {
        for (head, sign) in [("", 1.0), ("ReverseOrientation", -1.0), ("Scale 1 1 -1", -1.0)] {
            let data = mesh(&format!("{head} Shape {text}"));
            for (place, normal) in data.positions.iter().zip(&data.normals) {
                let across = Vec3::new(place.x, place.y, 0.0);
                assert!(sign * outwards * normal.dot(across) >= -1e-5, "{head} {text}: {place} {normal}");
            }
            assert!(faced(&data), "{head} {text}");
        }
    }
    // The coordinate u is the fraction of the turn. The coordinate v increases upwards, but on a
    // disc it increases towards the centre.
    let sphere = mesh("Shape \"sphere\" \"float zmin\" -0.5 \"float zmax\" 0.5 \"float phimax\" 180");
    for (place, uv) in sphere.positions.iter().zip(&sphere.uvs) {
        // The shape covers half a turn, and latitudes from -30 to 30 degrees.
        let (sin, cos) = fp::sin_cos_degrees(180.0 * f64::from(uv.x));
        let (up, across) = fp::sin_cos_degrees(60.0 * f64::from(uv.y) - 30.0);
        let wanted = glam::DVec3::new(across * cos, across * sin, up);
        assert!((place.as_dvec3() - wanted).length() < 1e-5, "{place} {uv}");
    }
    let disk = mesh("Shape \"disk\" \"float innerradius\" 0.5 \"float phimax\" 90 \"float height\" 2");
    for (place, uv) in disk.positions.iter().zip(&disk.uvs) {
        assert!((place.truncate().length() - (1.0 - 0.5 * uv.y)).abs() < 1e-5 && place.z == 2.0, "{place} {uv}");
    }
    assert!(disk.normals.iter().all(|normal| *normal == Vec3::Z));
}

const CUBE: &str = "\"integer indices\" [ 0 2 1 0 3 2 4 5 6 4 6 7 0 1 5 0 5 4 2 3 7 2 7 6 1 2 6 1 6 5 0 4 7 0 7 3 ]";

#[test]
fn loop_vertices_lie_on_the_limit_surface() {
    // In an octahedron, each vertex has four neighbours whose mean is the centre. The limit
    // position of a vertex is therefore the vertex scaled by 1 - 4 / (4 + 3 / (8 beta)), with beta
    // = 3 / 32.
    let text = "Shape \"loopsubdiv\" \"point P\" [ 1 0 0 -1 0 0 0 1 0 0 -1 0 0 0 1 0 0 -1 ]\n\
                \"integer indices\" [ 0 2 4 2 1 4 1 3 4 3 0 4 2 0 5 1 2 5 3 1 5 0 3 5 ]";
    for levels in 0..4 {
        let data = mesh(&format!("{text} \"integer levels\" {levels}"));
        assert_eq!(data.triangles.len(), 8 << (2 * levels));
        assert!((data.positions[4] - Vec3::new(0.0, 0.0, 0.5)).length() < 1e-6, "{levels}: {}", data.positions[4]);
        assert!((data.normals[4] - Vec3::Z).length() < 1e-6 && faced(&data), "{levels}");
    }
    // By default, there are three levels of subdivision, and the normals are those of the limit
    // surface.
    let data = mesh(text);
    assert_eq!(data.triangles.len(), 512);
    for triangle in &data.triangles {
        let [a, b, c] = triangle.map(|i| data.positions[i as usize]);
        let normal: Vec3 = triangle.iter().map(|&i| data.normals[i as usize]).sum();
        let cosine = (b - a).cross(c - a).normalize().dot(normal.normalize());
        assert!(cosine > 0.95, "{cosine} {triangle:?}");
    }
    // A flat mesh remains flat.
    let flat = mesh(
        "Shape \"loopsubdiv\" \"integer levels\" 2 \"point P\" [ 0 0 0 1 0 0 2 0 0 0 1 0 1 1 0 2 1 0 0 2 0 1 2 0 2 2 0 ]\n\
         \"integer indices\" [ 0 1 4 0 4 3 1 2 5 1 5 4 3 4 7 3 7 6 4 5 8 4 8 7 ]",
    );
    assert!(flat.positions.iter().all(|p| p.z == 0.0) && flat.normals.iter().all(|n| (*n - Vec3::Z).length() < 1e-6));
    // The middle of each side stays in place, but the corners of the border are rounded off.
    assert!(
        flat.positions[1] == Vec3::X && area(&flat) < 4.0 && area(&flat) > 3.6,
        "{} {}",
        flat.positions[1],
        area(&flat)
    );
    // Three triangles that share an edge have no one-ring, so their vertices stay in place.
    let fan = "Shape \"loopsubdiv\" \"integer levels\" 1 \"point P\" [ 0 0 0 0 0 1 1 0 0 0 1 0 -1 0 0 ] \"integer indices\" [ 0 1 2 0 1 3 0 1 4 ]";
    assert_eq!(mesh(fan).positions[0], Vec3::ZERO);
    let cube = mesh(&format!(
        "Shape \"loopsubdiv\" {CUBE} \"point P\" [ -1 -1 -1 1 -1 -1 1 1 -1 -1 1 -1 -1 -1 1 1 -1 1 1 1 1 -1 1 1 ]"
    ));
    assert!(faced(&cube) && cube.positions.iter().all(|p| p.length() < 1.3 && p.length() > 0.5));
}

#[test]
fn curves_have_given_width() {
    let line = "\"point P\" [ 0 0 0 1 0 0 2 0 0 3 0 0 ]";
    // The radius of a tube is the mean radius of the circumscribed and inscribed circles of its
    // polygon.
    let tube = mesh(&format!("Shape \"curve\" \"string type\" \"cylinder\" \"float width\" 0.5 {line}"));
    assert!((area(&tube) / (PI * 0.5 * 3.0) - 1.0).abs() < 0.01, "{}", area(&tube));
    for (place, normal) in tube.positions.iter().zip(&tube.normals) {
        let across = Vec3::new(0.0, place.y, place.z);
        assert!((across.length() - 0.25).abs() < 0.01 && across.normalize().dot(*normal) > 0.999);
    }
    let cone =
        mesh(&format!("Shape \"curve\" \"string type\" \"cylinder\" \"float width0\" 0.4 \"float width1\" 0 {line}"));
    assert!((area(&cone) / (PI * 0.2 * 3.0) - 1.0).abs() < 0.01, "{}", area(&cone));
    let ribbon = mesh(&format!(
        "Shape \"curve\" \"string type\" \"ribbon\" \"float width\" 0.5 \"normal N\" [ 0 0 1 0 0 1 ] {line}"
    ));
    assert!(
        (area(&ribbon) - 1.5).abs() < 1e-5 && ribbon.positions.iter().all(|p| p.z.abs() < 1e-6 && p.y.abs() < 0.2501)
    );
    assert!(ribbon.normals.iter().all(|n| (*n - Vec3::Z).length() < 1e-5));
    // If a ribbon makes a quarter turn, its middle is turned by half of that angle.
    let turned = mesh(&format!(
        "Shape \"curve\" \"string type\" \"ribbon\" \"float width\" 0.5 \"normal N\" [ 0 0 1 0 1 0 ] {line}"
    ));
    let middle = turned.positions.iter().zip(&turned.normals).find(|(p, _)| (p.x - 1.5).abs() < 1e-4).unwrap().1;
    assert!((*middle - Vec3::new(0.0, 1.0, 1.0).normalize()).length() < 1e-3, "{middle}");
    // A B-spline with equally spaced control points is a straight line from the second control
    // point to the second to last one.
    let spline = mesh(&format!(
        "Shape \"curve\" \"string type\" \"cylinder\" \"string basis\" \"bspline\" \"float width\" 0.1 {line}"
    ));
    let ends = spline.positions.iter().fold((9.0_f32, -9.0_f32), |(a, b), p| (a.min(p.x), b.max(p.x)));
    assert!((ends.0 - 1.0).abs() < 1e-5 && (ends.1 - 2.0).abs() < 1e-5, "{ends:?}");
    // One parabola is given as a curve of degree 2 and as a curve of degree 3.
    let text = |points: &str, degree: u32| {
        mesh(&format!(
            "Shape \"curve\" \"string type\" \"cylinder\" \"integer degree\" {degree} \"float width\" 0.1 \"point P\" [ {points} ]"
        ))
    };
    let (second, third) =
        (text("0 0 0 1 2 0 2 0 0", 2), text("0 0 0 0.66666667 1.3333333 0 1.3333333 1.3333333 0 2 0 0", 3));
    assert_eq!(second.positions.len(), third.positions.len());
    let far = second.positions.iter().zip(&third.positions).map(|(a, b)| (*a - *b).length()).fold(0.0, f32::max);
    assert!(far < 1e-4, "{far}");
}

#[test]
fn height_fields_and_nurbs_become_meshes() {
    let heights = mesh("Shape \"heightfield\" \"integer nu\" 3 \"integer nv\" 2 \"float Pz\" [ 0 1 2 3 4 5 ]");
    assert_eq!((heights.positions[1], heights.positions[5]), (Vec3::new(0.5, 0.0, 1.0), Vec3::new(1.0, 1.0, 5.0)));
    assert_eq!(heights.triangles.len(), 4);
    // An exact quarter of a cylinder has the weights 1, 1 / sqrt 2 and 1.
    let w = std::f32::consts::FRAC_1_SQRT_2;
    let cylinder = mesh(&format!(
        "Shape \"nurbs\" \"integer nu\" 3 \"integer nv\" 2 \"integer uorder\" 3 \"integer vorder\" 2\n\
         \"float uknots\" [ 0 0 0 1 1 1 ] \"float vknots\" [ 0 0 1 1 ]\n\
         \"float Pw\" [ 1 0 0 1  {w} {w} 0 {w}  0 1 0 1   1 0 2 1  {w} {w} {z} {w}  0 1 2 1 ]",
        z = 2.0 * w
    ));
    assert!((area(&cylinder) / PI - 1.0).abs() < 1e-3 && faced(&cylinder), "{}", area(&cylinder));
    for (place, normal) in cylinder.positions.iter().zip(&cylinder.normals) {
        let across = Vec3::new(place.x, place.y, 0.0);
        assert!((across.length() - 1.0).abs() < 1e-5 && (across - *normal).length() < 1e-4, "{place} {normal}");
    }
}

#[test]
fn tessellation_is_limited() {
    // A partial ball has at most 128 x 64 x 2 triangles. With the limit that tests use, some of the
    // 20 balls are left out.
    let text = "Shape \"sphere\" \"float phimax\" 359 ".repeat(20);
    let (scene, messages) =
        read_with_low_limits("a.pbrt", &format!("Film \"image\" Camera \"perspective\" WorldBegin {text}"));
    assert!(messages.len() == 1 && messages[0].contains("triangles are left out"), "{messages:?}");
    let triangles: usize = scene.unwrap().assets.meshes.values().map(|mesh| mesh.triangles.len()).sum();
    assert!(triangles <= 1 << 18 && triangles > 1 << 17, "{triangles}");
    let surface =
        "Shape \"loopsubdiv\" \"integer levels\" 16 \"point P\" [ 0 0 0 1 0 0 0 1 0 ] \"integer indices\" [ 0 1 2 ]";
    let (_, messages) =
        read_with_low_limits("a.pbrt", &format!("Film \"image\" Camera \"perspective\" WorldBegin {surface}"));
    assert!(messages.len() == 1 && messages[0].contains("the surface is subdivided only 7 times"), "{messages:?}");
}

#[test]
fn colours_of_vertices_are_ignored() {
    let ply = "ply\nformat ascii 1.0\nelement vertex 3\nproperty float x\nproperty float y\nproperty float z\n\
        property uchar red\nproperty uchar green\nproperty uchar blue\nelement face 1\n\
        property list uchar int vertex_indices\nend_header\n0 0 0 255 0 0\n1 0 0 255 0 0\n0 1 0 255 0 0\n3 0 1 2\n";
    let folder = tempfile::tempdir().unwrap();
    std::fs::write(folder.path().join("red.ply"), ply).unwrap();
    let text = "Camera \"perspective\" WorldBegin Shape \"plymesh\" \"string filename\" \"red.ply\"";
    let (scene, messages) = read_in(folder.path(), text);
    let scene = scene.unwrap_or_else(|| panic!("{messages:?}"));
    let data = scene.assets.meshes.values().next().unwrap();
    assert!(data.colors.is_empty() && data.positions.len() == 3);
}
