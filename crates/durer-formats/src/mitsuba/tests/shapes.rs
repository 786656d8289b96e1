//! Tests of conventions of shapes and of their materials, compared with Mitsuba 3.9.1.

use super::{clean, clean_in, folder, material, mesh, objects, read_in};
use crate::mitsuba::serialized::tests::{file, stream};
use durer_scene::material::{HairMaterial, PatternMaterial};
use durer_scene::math::{Vec2, Vec3};
use durer_scene::scene::{Material, MatrixOp, MatrixRules, ObjectKind, Scene};

#[test]
fn texture_v_is_flipped() {
    // In Mitsuba, v = 0 is the upper edge of a picture, but the lower left corner of a rectangle
    // has the coordinates (0, 0).
    let scene = clean("<shape type='rectangle'/>");
    let lower_left = mesh(&scene).positions.iter().position(|p| p.x < 0.0 && p.y < 0.0).unwrap();
    assert_eq!(mesh(&scene).uvs[lower_left], Vec2::new(0.0, 1.0));
    let scene = clean("<shape type='rectangle'><boolean name='flip_normals' value='true'/></shape>");
    let data = mesh(&scene);
    let [a, b, c] = data.triangles[0].map(|i| data.positions[i as usize]);
    assert!((b - a).cross(c - a).z < 0.0 && data.normals[0] == Vec3::NEG_Z);
}

/// Asserts that the normals and the faces of a mesh around the origin point inwards.
pub(super) fn assert_faces_inwards(scene: &Scene) {
    let data = mesh(scene);
    for (corners, normals) in data.triangles.iter().zip(&data.triangle_normals) {
        let [a, b, c] = corners.map(|i| data.positions[i as usize]);
        assert!((b - a).cross(c - a).dot(a + b + c) < 0.0, "{a} {b} {c}");
        assert!(normals.iter().zip([a, b, c]).all(|(&i, p)| data.normals[i as usize].dot(p) < -0.99));
    }
}

#[test]
fn opaque_spheres_that_are_inside_out_show_their_inside() {
    let flip = "<boolean name='flip_normals' value='true'/>"; // prose: keep
    let mirror = "<transform name='to_world'><scale x='-1'/></transform>";
    for more in [flip, mirror] {
        assert_faces_inwards(&clean(&format!("<shape type='sphere'><bsdf type='diffuse'/>{more}</shape>")));
    }
    // Both together are an ordinary sphere.
    let scene = clean(&format!("<shape type='sphere'><bsdf type='diffuse'/>{flip}{mirror}</shape>"));
    assert!(scene.assets.meshes.is_empty());
}

/// Mesh of two faces with a fold between them, in which only one vertex has a colour.
const FOLDED: &str = "ply\nformat ascii 1.0\nelement vertex 4\nproperty float x\nproperty float y\nproperty float z\n\
    property float u\nproperty float v\nproperty float r\nproperty float g\nproperty float b\n\
    element face 2\nproperty list uchar int vertex_indices\nend_header\n\
    0 0 0 0 0 .5 .2 .8\n1 0 0 1 0 1 1 1\n1 1 0 1 1 1 1 1\n0 1 1 0 1 1 1 1\n3 0 1 2\n3 0 2 3\n";

#[test]
fn mesh_files_are_smooth_and_uncoloured_by_default() {
    let of = |more: &str| {
        let inner = format!("<shape type='ply'><string name='filename' value='folded.ply'/>{more}</shape>");
        mesh(&clean_in(&[("folded.ply", FOLDED.as_bytes())], &inner)).clone()
    };
    let plain = of("");
    assert!(plain.colors.is_empty() && !plain.flat && plain.tangents.is_empty());
    // At the fold, the normal is the mean of the normals of both faces, weighted by their angles of
    // 45 and 60 degrees.
    let a = plain.triangles[0].iter().position(|&i| plain.positions[i as usize] == Vec3::ZERO).unwrap();
    let [face, other] = [Vec3::Z, Vec3::new(1.0, -1.0, 1.0) / 3f32.sqrt()];
    let angles = [45f32.to_radians(), 60f32.to_radians()];
    let wanted = (angles[0] * face + angles[1] * other).normalize();
    let found = plain.normals[plain.triangle_normals[0][a] as usize];
    assert!((found - wanted).length() < 1e-5, "{found} and not {wanted}");
    assert!(of("<boolean name='face_normals' value='true'/>").flat);
    let colored = of("<bsdf type='diffuse'><texture name='reflectance' type='mesh_attribute'>\
        <string name='name' value='vertex_color'/></texture></bsdf>");
    let dimmed = "<shape type='ply'><string name='filename' value='folded.ply'/><bsdf type='diffuse'>\
        <texture name='reflectance' type='mesh_attribute'><string name='name' value='vertex_color'/>\
        <float name='scale' value='.5'/></texture></bsdf></shape>";
    let scene = clean_in(&[("folded.ply", FOLDED.as_bytes())], dimmed);
    let Material::Principled(dimmed) = material(&scene) else { panic!() };
    assert_eq!(dimmed.base_color, Vec3::splat(0.5));
    // Vertex colours of PLY files are linear.
    let wanted = [0.5, 0.2, 0.8];
    let found = colored.colors[0];
    assert!((0..3).all(|k| (found[k] - wanted[k]).abs() < 4e-3) && found[3] == 1.0, "{found:?}");
}

#[test]
fn normal_map_tangents_follow_u() {
    let leaning = "<bsdf type='normalmap'><texture name='normalmap' type='bitmap'><boolean name='raw' value='true'/>\
        <string name='filename' value='n.ppm'/></texture><bsdf type='diffuse'/></bsdf>";
    let files: [(&str, &[u8]); 2] = [("n.ppm", b"P6\n1 1\n255\n\x80\x80\xff"), ("folded.ply", FOLDED.as_bytes())];
    for shape in [
        "<shape type='rectangle'>",
        "<shape type='ply'><string name='filename' value='folded.ply'/>",
        "<shape type='cylinder'>",
    ] {
        let scene = clean_in(&files, &format!("{shape}{leaning}</shape>"));
        let data = mesh(&scene);
        assert_eq!(data.tangents.len(), data.positions.len(), "{shape}");
        for (corners, uvs) in data.triangles.iter().zip(&data.triangle_uvs) {
            for k in 0..3 {
                // The tangent points in the direction of increasing u.
                let tangent = data.tangents[corners[k] as usize];
                let [x, y, z, side] = tangent;
                let along = (0..3).filter(|&l| l != k).map(|l| {
                    let way = data.positions[corners[l] as usize] - data.positions[corners[k] as usize];
                    (way.dot(Vec3::new(x, y, z)), data.uvs[uvs[l] as usize].x - data.uvs[uvs[k] as usize].x)
                });
                for (way, u) in along.filter(|(way, u)| way.abs() > 0.1 && u.abs() > 0.1) {
                    assert!(way * u > 0.0, "{shape}: {tangent:?}");
                }
                assert_eq!(side, 1.0);
            }
        }
    }
}

#[test]
fn cylinder_axes_match_mitsuba() {
    // Point at which u is 0 on cylinders of radius 1 in Mitsuba 3.9.1, as an offset from the axis.
    for (to, start) in [
        ([0.0, 0.0, 2.0], [1.0, 0.0, 0.0]),
        ([0.0, 1.0, 0.0], [1.0, 0.0, 0.0]),
        ([1.0, 0.0, 0.0], [0.0, 0.0, -1.0]),
        ([0.5, 1.0, -2.0], [0.97462, -0.05180, 0.21776]),
        ([-1.0, 0.2, 0.3], [0.30987, 0.13836, 0.94066]),
    ] {
        let [x, y, z] = to;
        let scene = clean(&format!(
            "<shape type='cylinder'><point name='p0' x='0' y='0' z='0'/><point name='p1' x='{x}' y='{y}' z='{z}'/></shape>"
        ));
        let (data, mut map) = (mesh(&scene), glam::DAffine3::IDENTITY);
        let mut object = &scene.root.as_ref().unwrap().objects[0];
        while let ObjectKind::Transform(ops, inner) = &object.node {
            (map, object) = (map * MatrixOp::product(ops, MatrixRules::default()), inner);
        }
        let number = data.uvs.iter().position(|uv| uv.x == 0.0).unwrap();
        let corner = data.triangle_uvs.iter().zip(&data.triangles).find_map(|(uvs, corners)| {
            uvs.iter().position(|&uv| uv == number as u32).map(|k| data.positions[corners[k] as usize])
        });
        let found = map.transform_vector3(corner.unwrap().with_z(0.0).as_dvec3()).as_vec3();
        assert!((found - Vec3::from_array(start)).length() < 2e-3, "{to:?}: {found} and not {start:?}");
    }
}

#[test]
fn curve_files_with_hair_become_tubes() {
    let folder = folder(&[
        ("hair.txt", b"0 0 0 0.1\n1 0 0 0.1\n2 0 0 0.1\n3 0 0 0.1\n\n0 1 0 0.2\n1 1 0 0.2\n2 1 0 0.2\n3 1 0 0.2\n"),
        ("short.txt", b"0 0 0 0.1\n1 0 0 0.1\n"),
        ("bad.txt", b"0 0 0 0.1\n1 0 0\n"),
        ("thin.txt", b"0 0 0 0.1\n1 0 0 -1\n"),
    ]);
    let text = |kind: &str, file: &str| {
        format!(
            "<scene version='3.0.0'><shape type='{kind}'><string name='filename' value='{file}'/>\
             <bsdf type='hair'><float name='eumelanin' value='0.5'/><float name='scale_tilt' value='3'/>\
             <float name='int_ior' value='1.6'/><float name='ext_ior' value='1'/></bsdf></shape></scene>"
        )
    };
    // Splines have flat ends, and linear curves end in hemispheres.
    for (kind, from, to, ball) in [("bsplinecurve", 1.0, 2.0, 0.0), ("linearcurve", 0.0, 3.0, 0.2)] {
        let (scene, messages) = read_in(folder.path(), "scene.xml", text(kind, "hair.txt"));
        assert_eq!(messages, [""; 0]);
        let scene = scene.unwrap();
        let Material::Hair(hair) = material(&scene) else { panic!("{kind}") };
        let wanted =
            HairMaterial { eumelanin: 0.5, pheomelanin: 0.2, scale_tilt: 3.0, ior: 1.6, ..HairMaterial::default() };
        assert_eq!(*hair, wanted);
        let data = scene.assets.meshes.values().next().unwrap();
        let ends = data.positions.iter().fold((9.0_f32, -9.0_f32), |(a, b), p| (a.min(p.x), b.max(p.x)));
        assert!((ends.0 - from + ball).abs() < 1e-5 && (ends.1 - to - ball).abs() < 1e-5, "{kind}: {ends:?}");
        // Each of the two tubes has the width that its radius gives, and u increases along them.
        let wide = |y: f32| data.positions.iter().map(|p| (p.y - y).abs()).filter(|d| *d < 0.4).fold(0.0, f32::max);
        assert!((wide(0.0) - 0.1).abs() < 0.004 && (wide(1.0) - 0.2).abs() < 0.008, "{} {}", wide(0.0), wide(1.0));
        let u = |p: &Vec3| ((p.x - from) / (to - from)).clamp(0.0, 1.0);
        assert!(data.positions.iter().zip(&data.uvs).all(|(p, uv)| (u(p) - uv.x).abs() < 1e-4));
    }
    for (file, kind, wanted) in [
        (
            "short.txt",
            "bsplinecurve",
            "short.txt:3:1 error the curve that ends here has 2 points, but needs at least 4 points",
        ),
        (
            "bad.txt",
            "linearcurve",
            "bad.txt:2:1 error a point of a curve must be three numbers and a radius of 0 or more",
        ),
        (
            "thin.txt",
            "linearcurve",
            "thin.txt:2:1 error a point of a curve must be three numbers and a radius of 0 or more",
        ),
        ("none.txt", "linearcurve", "error the curves cannot be read"),
    ] {
        let (scene, messages) = read_in(folder.path(), "scene.xml", text(kind, file));
        assert!(scene.is_none() && messages.iter().any(|message| message.contains(wanted)), "{messages:#?}");
    }
}

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
fn curves_keep_their_radius_and_are_seen_from_outside_only() {
    let files: &[(&str, &[u8])] = &[("line.txt", b"0 0 0 .1\n1 0 0 .1\n2 0 0 .1\n3 0 0 .1\n")];
    // Ends of the mesh, which a rotation leaves to the object.
    for (steps, from, to) in [
        ("<scale value='3'/>", 3.0, 6.0),
        ("<scale x='2' y='5' z='-1'/>", 2.0, 4.0),
        ("<rotate z='1' angle='30'/><translate y='2'/>", 1.0, 2.0),
    ] {
        let scene = clean_in(
            files,
            &format!(
                "<shape type='bsplinecurve'><string name='filename' value='line.txt'/>\
                 <transform name='to_world'>{steps}</transform><bsdf type='diffuse'/></shape>"
            ),
        );
        let ends =
            |k: usize| mesh(&scene).positions.iter().fold([9.0_f32, -9.0], |[a, b], p| [a.min(p[k]), b.max(p[k])]);
        for ([a, b], [from, to]) in [(ends(0), [from, to]), (ends(1), [-0.1, 0.1]), (ends(2), [-0.1, 0.1])] {
            assert!((a - from).abs() < 0.001 && (b - to).abs() < 0.001, "{steps}: {a} {b}");
        }
        // A ray from inside meets nothing.
        let numbers = scene.materials.iter().find_map(|material| match &material.value {
            Material::Solid(PatternMaterial::TwoSided(sides), _) => Some([sides.material1, sides.material2]),
            _ => None,
        });
        let opacity = numbers.unwrap().map(|number| match &scene.materials[number as usize].value {
            Material::Principled(layers) => layers.opacity,
            other => panic!("{other:?}"),
        });
        assert_eq!(opacity, [1.0, 0.0]);
    }
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

#[test]
fn flipped_spheres_keep_their_texture_coordinates() {
    let scene = clean(
        "<shape type='sphere'><boolean name='flip_normals' value='true'/><bsdf type='diffuse'/></shape>", // prose: keep
    );
    let data = mesh(&scene);
    for (corners, uvs) in data.triangles.iter().zip(&data.triangle_uvs) {
        for (&i, &uv) in corners.iter().zip(uvs) {
            let from_top = durer_scene::math::fp::atan2(
                data.positions[i as usize].truncate().length(),
                data.positions[i as usize].z,
            );
            // Mitsuba's v is 0 at +z, and Dürer's v is 1 there.
            let v = 1.0 - from_top / std::f32::consts::PI;
            assert!((data.uvs[uv as usize].y - v).abs() < 1e-5, "{}", data.positions[i as usize]);
        }
    }
}

/// Normals of a mesh without normals are computed in the world, where a scale that is not uniform
/// changes the angles that weight them.
#[test]
fn normals_of_scaled_meshes_are_computed_in_the_world() {
    for scale in [Vec3::ONE, Vec3::splat(3.0), Vec3::new(3.0, 1.0, 0.5), Vec3::new(-2.0, 1.0, 1.0)] {
        let inner = format!(
            "<shape type='ply'><string name='filename' value='folded.ply'/>\
             <transform name='to_world'><scale x='{}' y='{}' z='{}'/></transform></shape>",
            scale.x, scale.y, scale.z
        );
        let data = mesh(&clean_in(&[("folded.ply", FOLDED.as_bytes())], &inner)).clone();
        let corners = [Vec3::ZERO, Vec3::X, Vec3::new(1.0, 1.0, 0.0), Vec3::new(0.0, 1.0, 1.0)].map(|p| scale * p);
        let face =
            |a: usize, b: usize| (corners[a].cross(corners[b]).normalize(), corners[a].angle_between(corners[b]));
        let ((n, angle), (m, other)) = (face(1, 2), face(2, 3));
        let expected = (angle * n + other * m).normalize();
        let at = |k: usize| data.positions[data.triangles[0][k] as usize];
        let corner = (0..3).find(|&k| at(k) == Vec3::ZERO).unwrap();
        let found = (data.normals[data.triangle_normals[0][corner] as usize] / scale).normalize();
        assert!((found - expected).length() < 1e-5, "{scale}: {found} and not {expected}");
    }
}
