//! Tests of conventions of shapes and of their materials, compared with Mitsuba 3.9.1.

use super::conventions::{clean_in, mesh};
use super::{clean, objects};
use crate::mitsuba::serialized::tests::{file, stream};
use durer_scene::math::{Vec2, Vec3};
use durer_scene::scene::{Material, Scene};

#[test]
fn serialized_mesh_equals_ply_mesh() {
    // All files contain the same lists. In both formats, v = 0 is the upper edge of a picture, and
    // the flags for colours and for flat faces have no effect.
    let ply = b"ply\nformat ascii 1.0\nelement vertex 4\nproperty float x\nproperty float y\nproperty float z\n\
        property float nx\nproperty float ny\nproperty float nz\nproperty float u\nproperty float v\n\
        element face 2\nproperty list uchar int vertex_indices\nend_header\n\
        0 0 0 0 0 1 0 .125\n1 0 0 0 .6 .8 1 .125\n1 1 0 .6 0 .8 1 .875\n0 1 1 0 0 1 0 .875\n3 0 1 2\n3 0 2 3\n";
    let of = |kind: &str, name: &str, bytes: &[u8], more: &str| {
        let shape = format!("<shape type='{kind}'><string name='filename' value='{name}'/>{more}</shape>");
        mesh(&clean_in(&[(name, bytes)], &shape)).clone()
    };
    let second = "<integer name='shape_index' value='1'/>";
    for more in [
        "",
        "<boolean name='face_normals' value='true'/>",
        "<boolean name='flip_normals' value='true'/>",
        "<transform name='to_world'><scale x='-1'/></transform>",
    ] {
        let wanted = of("ply", "a.ply", ply, more);
        for (version, flags) in [(3, 0x1003), (4, 0x1003), (4, 0x2003), (4, 0x101b)] {
            let bytes = file(version, &[stream(version, 0x1000), stream(version, flags)]);
            assert_eq!(
                of("serialized", "a.serialized", &bytes, &format!("{second}{more}")),
                wanted,
                "{flags:x} {more}"
            );
        }
    }
    // A mesh without normals becomes smooth. The first mesh of the file has no texture coordinates.
    let bytes = file(4, &[stream(4, 0x1000), stream(4, 0x1003)]);
    let first = of("serialized", "a.serialized", &bytes, "");
    assert!(first.uvs.is_empty() && first.triangle_normals.len() == 2);
}

/// Returns the index of refraction of the material of each object.
fn indices(scene: &Scene) -> Vec<f32> {
    let index = |object: &&durer_scene::scene::Object| match &scene.materials[object.material.unwrap() as usize].value {
        Material::Principled(layers) => layers.specular_ior,
        _ => panic!(),
    };
    objects(scene).iter().map(index).collect()
}

#[test]
fn inverted_spheres_swap_their_indices() {
    const GLASS: f32 = 1.5046 / 1.000277;
    let glass = |kind: &str| format!("<bsdf type='{kind}' id='glass'/>");
    let sphere = |more: &str| format!("<shape type='sphere'>{more}<ref id='glass'/></shape>");
    let flip = "<boolean name='flip_normals' value='true'/>";
    let mirror = "<transform name='to_world'><scale value='-.5'/></transform>";
    let check = |text: String, wanted: &[f32]| {
        let found = indices(&clean(&text));
        assert!(found.len() == wanted.len(), "{text}");
        assert!(found.iter().zip(wanted).all(|(a, b)| (a - b).abs() < 1e-5), "{text}: {found:?} and not {wanted:?}");
    };
    // The inverted sphere is a bubble in glass that fills all space. A sphere that is inverted
    // twice is an ordinary sphere.
    for kind in ["dielectric", "roughdielectric"] {
        let ggx = if kind == "dielectric" { "" } else { "<string name='distribution' value='ggx'/>" };
        let glass = format!("<bsdf type='{kind}' id='glass'>{ggx}</bsdf>");
        check(glass.clone() + &sphere(flip), &[1.0 / GLASS]);
        check(glass.clone() + &sphere(mirror), &[1.0 / GLASS]);
        check(glass + &sphere(&(flip.to_string() + mirror)), &[GLASS]);
    }
    // A thin dielectric is the same on both sides.
    check(glass("thindielectric") + &sphere(flip), &[GLASS]);
    // Hollow glass ball of one material, with air inside.
    let radius = "<float name='radius' value='.9'/>";
    check(glass("dielectric") + &sphere("") + &sphere(&(flip.to_string() + radius)), &[GLASS, 1.0 / GLASS]);
}

#[test]
fn disk_uv_goes_outwards_and_around() {
    let picture = "<bsdf type='diffuse'><texture name='reflectance' type='checkerboard'/></bsdf>";
    let data = mesh(&clean(&format!("<shape type='disk'>{picture}</shape>"))).clone();
    // Positions and texture coordinates in Mitsuba 3.9.1. The coordinate v is flipped in Dürer.
    for (x, y, wanted) in [(0.5, 0.0, [0.5, 0.0]), (0.0, 0.5, [0.5, 0.25]), (0.3, -0.4, [0.5, 0.852416])] {
        let place = Vec2::new(x, y);
        let found = data.triangles.iter().zip(&data.triangle_uvs).find_map(|(corners, uvs)| {
            let [p, q, r] = corners.map(|i| data.positions[i as usize].truncate());
            let (along, across, to) = (q - p, r - p, place - p);
            let area = along.perp_dot(across);
            let (b, c) = (to.perp_dot(across) / area, along.perp_dot(to) / area);
            let uvs = uvs.map(|i| data.uvs[i as usize]);
            let inside = b >= -1e-6 && c >= -1e-6 && b + c <= 1.0;
            inside.then(|| uvs[0] + b * (uvs[1] - uvs[0]) + c * (uvs[2] - uvs[0]))
        });
        let found = found.unwrap();
        let near = (found.x - wanted[0]).abs() < 1e-3 && (1.0 - found.y - wanted[1]).abs() < 3e-3;
        assert!(near, "{place}: {found} and not {wanted:?}");
    }
    // The tangent points outwards, which is the direction of increasing u.
    let outwards = |(p, t): (&Vec3, &[f32; 4])| p.length() == 0.0 || p.dot(Vec3::new(t[0], t[1], t[2])) > 0.9;
    assert!(data.positions.iter().zip(&data.tangents).all(outwards));
    // A disk that has no picture becomes a `Disc`.
    assert!(clean("<shape type='disk'/>").assets.meshes.is_empty());
}

#[test]
fn linear_curve_joints_and_ends_are_round() {
    let bent = b"0 0 0 .5\n2 0 0 .5\n2 2 0 .25\n";
    let shape = "<shape type='linearcurve'><string name='filename' value='bent.txt'/></shape>";
    let data = mesh(&clean_in(&[("bent.txt", bent)], shape)).clone();
    // Signed distance to the union of all balls along the curve, whose radius changes linearly
    // along each segment.
    let ends = [(Vec3::ZERO, 0.5), (2.0 * Vec3::X, 0.5), (Vec3::new(2.0, 2.0, 0.0), 0.25)];
    let outside = |p: &Vec3| {
        let from = |pair: &[(Vec3, f32)]| {
            let (along, to) = (pair[1].0 - pair[0].0, *p - pair[0].0);
            let share = (to.dot(along) / along.length_squared()).clamp(0.0, 1.0);
            (to - share * along).length() - (pair[0].1 + share * (pair[1].1 - pair[0].1))
        };
        ends.windows(2).map(from).fold(f32::MAX, f32::min)
    };
    let most = data.positions.iter().map(outside).fold(f32::MIN, f32::max);
    assert!(most < 0.02, "{most}");
    // Points at the outer corner of the joint, at the left end and at the top end.
    for there in [
        Vec3::new(2.0 + 0.125f32.sqrt(), -(0.125f32.sqrt()), 0.0),
        Vec3::new(-0.5, 0.0, 0.0),
        Vec3::new(2.0, 2.25, 0.0),
    ] {
        let nearest = data.positions.iter().map(|p| p.distance(there)).fold(f32::MAX, f32::min);
        assert!(nearest < 0.12, "{there} {nearest}");
    }
    // The coordinate u increases along the curve, and the normals point outwards.
    let middle = data.positions.iter().zip(&data.uvs).filter(|(_, uv)| uv.x == 0.5);
    assert!(middle.clone().count() > 12 && middle.into_iter().all(|(p, _)| p.distance(2.0 * Vec3::X) < 0.53));
    for (corners, normals) in data.triangles.iter().zip(&data.triangle_normals) {
        let [a, b, c] = corners.map(|i| data.positions[i as usize]);
        let face = (b - a).cross(c - a);
        assert!(normals.iter().all(|n| face.dot(data.normals[*n as usize]) > -1e-6));
    }
}
