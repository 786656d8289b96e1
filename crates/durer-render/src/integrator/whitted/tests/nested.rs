//! Tests of nested glass that derive the indices of refraction along a ray from Snell's law.

use super::*;
use crate::compile::testing;
use crate::integrator::{TraceNode, TraceRecorder};

const CAMERA: &str = "PerspectiveCamera { center 0 9 0 direction 0 -1 0 up 0 0 1 angle 40 }
    Materials {
      Material { specularColor 1 1 1 transparentColor 1 1 1 refractionIndex 1.5 }
      Material { specularColor 1 1 1 transparentColor 1 1 1 refractionIndex 1.33 }
      Material { specularColor 1 1 1 transparentColor 1 1 1 refractionIndex 1.31 }
      Material { transparentColor 1 1 1 indexOfRefraction 1 }
      Material { diffuseColor 1 1 1 } }\n";

/// Returns the indices of refraction along a ray, computed from the sines of the angles between the
/// ray and the y axis. In flat layers, the product of index and sine is constant.
fn indices(objects: &str, origin: [f32; 3], sine: f32) -> Vec<f32> {
    along(&testing::read(&format!("{CAMERA}Group {{ {objects} }}")), origin, sine)
}

fn along(world: &World, origin: [f32; 3], sine: f32) -> Vec<f32> {
    let settings = RenderSettings {
        bounces: 10,
        shadows: false,
        shade_back: true,
        transparent_shadows: false,
        reflection: false,
        refraction: true,
        min_weight: 0.0,
    };
    let ray = Ray::new(origin.into(), Vec3::new(sine, -(1.0 - sine * sine).sqrt(), 0.0));
    let mut account = TraceRecorder::default();
    Whitted { world, settings, cancel: None }.radiance(&ray, &mut account);
    let mut found = Vec::new();
    transmitted(&account.into_tree().unwrap().root, &mut found);
    // Round the indices to thousandths.
    found.iter().map(|dir| (1e3 * sine / dir.x).round() / 1e3).collect()
}

fn transmitted(node: &TraceNode, found: &mut Vec<Vec3>) {
    if let TermKind::Ray { from: RayKind::Transmitted, ray, .. } = &node.kind {
        found.push(ray.dir);
    }
    node.terms.iter().for_each(|term| transmitted(term, found));
}

fn slab(material: u32, low: f32, high: f32, half: f32) -> String {
    format!("MaterialIndex {material} Box {{ min -{half} {low} -{half} max {half} {high} {half} }} ")
}

#[test]
fn nested_layers_refract_by_their_own_indices_in_any_order() {
    let layers = [slab(0, -3.0, 3.0, 30.0), slab(1, -2.0, 2.0, 20.0), slab(2, -1.0, 1.0, 10.0)];
    for order in [[0, 1, 2], [2, 1, 0], [1, 2, 0], [0, 2, 1]] {
        let objects: String = order.map(|i| layers[i].as_str()).concat();
        for sine in [0.1, 0.5, 0.9] {
            assert_eq!(indices(&objects, [0.0, 6.0, 0.0], sine), [1.5, 1.33, 1.31, 1.33, 1.5, 1.0]);
        }
        // Shoot rays from inside the ice, the water and the glass. Each sine is that of the angle
        // in the medium where the ray starts.
        assert_eq!(
            indices(&objects, [0.0, 0.0, 0.0], 0.5).iter().map(|n| n * 1.31).map(short).collect::<Vec<_>>(),
            [1.33, 1.5, 1.0]
        );
        assert_eq!(
            indices(&objects, [0.0, -1.5, 0.0], 0.5).iter().map(|n| n * 1.33).map(short).collect::<Vec<_>>(),
            [1.5, 1.0]
        );
    }
}

fn short(index: f32) -> f32 {
    (index * 100.0).round() / 100.0
}

#[test]
fn ice_partly_out_of_water_displaces_it() {
    let (water, ice) = (slab(1, -2.0, 0.0, 20.0), slab(2, -1.0, 1.0, 10.0));
    for objects in [format!("{water}{ice}"), format!("{ice}{water}")] {
        // The water's surface inside the ice has no effect.
        assert_eq!(indices(&objects, [0.0, 6.0, 0.0], 0.5), [1.31, 1.33, 1.0]);
        // Beside the ice there is only water.
        assert_eq!(indices(&objects, [12.0, 6.0, 0.0], 0.5), [1.33, 1.0]);
    }
    // A sea of infinite depth also contains the ice. There is nothing below the sea, so the ray
    // stays inside.
    let sea = format!("{ice}MaterialIndex 1 Plane {{ normal 0 1 0 offset 0 }}");
    assert_eq!(indices(&sea, [0.0, 6.0, 0.0], 0.5), [1.31, 1.33]);
}

#[test]
fn bubble_is_air_and_pane_hides_nothing() {
    let bubble = format!("{}{}", slab(0, -2.0, 2.0, 20.0), slab(3, -1.0, 1.0, 10.0));
    assert_eq!(indices(&bubble, [0.0, 6.0, 0.0], 0.5), [1.5, 1.0, 1.5, 1.0]);
    // Opaque objects inside glass are visible.
    let stone = format!("{}MaterialIndex 4 Sphere {{ center 0 0 0 radius 1 }}", slab(0, -2.0, 2.0, 20.0));
    assert_eq!(indices(&stone, [-4.2, 8.0, 0.0], 0.5), [1.5]);
    // A pane without thickness has no inside. Glass behind the pane is unaffected.
    let pane = "MaterialIndex 2 Rectangle { corner -30 3 -30 edge0 0 0 60 edge1 60 0 0 } ";
    let behind = indices(&format!("{pane}{}", slab(0, -1.0, 1.0, 20.0)), [0.0, 6.0, 0.0], 0.5);
    assert_eq!(behind[..2], [1.31, 1.5]);
}

#[test]
fn inverted_mesh_is_the_wall_of_a_cavity() {
    let folder = tempfile::tempdir().unwrap();
    // Build a box from twelve triangles that face inwards.
    let corners: String = (0..8)
        .map(|i| format!("v {} {} {}\n", 10 * (2 * (i & 1) - 1), 2 * (i >> 1 & 1) - 1, 10 * (2 * (i >> 2) - 1)))
        .collect();
    let faces = "f 1 2 4 3\nf 5 7 8 6\nf 1 5 6 2\nf 3 4 8 7\nf 1 3 7 5\nf 2 6 8 4\n";
    std::fs::write(folder.path().join("cavity.obj"), corners + faces).unwrap();
    let text = format!("{CAMERA}Group {{ {} TriangleMesh {{ obj_file cavity.obj }} }}", slab(0, -2.0, 2.0, 20.0));
    let rules = durer_scene::dialect::Dialect::Durer.rules();
    let (world, findings) = testing::try_read(&text, rules, crate::compile::AccelKind::Bvh, folder.path());
    let world = world.unwrap_or_else(|| panic!("{findings:?}"));
    assert_eq!(along(&world, [0.0, 6.0, 0.0], 0.5), [1.5, 1.0, 1.5, 1.0]);
}
