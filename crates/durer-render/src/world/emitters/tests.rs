use super::*;
use crate::compile::testing::read;
use durer_scene::sampler::sample_2d;

#[test]
fn each_kind_of_light_is_chosen_with_its_stated_probability() {
    let world = read(
        "PerspectiveCamera { center 0 0 5 direction 0 0 -1 up 0 1 0 angle 40 }
        Background { sun 0.3 0.8 0.2 turbidity 3 }
        Lights { PointLight { position 2 3 1 color 9000 9000 9000 } }
        Materials { PrincipledMaterial { emissionLuminance 5000 emissionColor 1 1 1 } }
        Group { MaterialIndex 0 Sphere { center -1 1 0 radius 0.3 } }",
    );
    let (emitters, point) = (world.emitters(), DVec3::new(0.3, 0.1, 0.2));
    let is_apart = |light: LightId| emitters.outside_tree.iter().any(|apart| LightId::Light(apart.light) == light);
    // A point light without attenuation is not in the tree.
    assert_eq!((emitters.outside_tree.len(), emitters.sources.len()), (2, 1));
    for n in [Vec3::Y, -Vec3::Y, Vec3::ZERO] {
        let to = Receiver { point, n, is_seen: true };
        let weights = emitters.chances(&world, &to).unwrap();
        let apart: f32 = emitters.outside_tree.iter().map(|apart| weights.of(apart.estimated_irradiance(n))).sum();
        let expected = [apart, weights.of(weights.sky), weights.of(weights.tree)];
        assert!((expected.iter().sum::<f32>() - 1.0).abs() < 1e-5, "{expected:?}");
        assert!(expected.iter().all(|&chance| chance > 0.02), "{expected:?}");
        assert_eq!(expected[1], emitters.chance_of_sky(&world, &to));
        let (mut found, count) = ([0_u32; 3], 1 << 14);
        for i in 0..count {
            let [choice, u] = [0, 2].map(|dimension| sample_2d(1, 0, 0, i, dimension));
            let chosen = emitters.choose(&world, &to, choice.x);
            // The tree returns nothing if no emitter in it contributes.
            let Some(chosen) = chosen else {
                found[2] += 1;
                continue;
            };
            let Some(light) = emitters.sample(&world, &chosen, &to, u) else { continue };
            let kind = if is_apart(light.light) {
                0
            } else if light.light == LightId::Environment {
                1
            } else {
                2
            };
            assert!(kind != 1 || light.choice == expected[1]);
            found[kind] += 1;
        }
        // Sobol points are nearly uniform.
        for (found, expected) in found.iter().zip(expected) {
            assert!(
                (*found as f32 / count as f32 - expected).abs() < 2e-3,
                "{n}: {found} of {count}, expected {expected}"
            );
        }
    }
}
