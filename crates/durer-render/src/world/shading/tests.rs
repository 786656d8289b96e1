use super::*;
use durer_scene::math::random::Random;

#[test]
fn bent_normals_reflect_outwards_and_change_continuously() {
    let mut random = Random(11);
    let mut number = || random.below(2_000_001) as f32 * 1e-6 - 1.0;
    let (mut kept, mut bent_ones) = (0, 0);
    for _ in 0..100_000 {
        let mut unit = || Vec3::new(number(), number(), number()).normalize_or(Vec3::Z);
        let [n, n_geo, wo] = [unit(), unit(), unit()];
        let n_geo = if n_geo.dot(wo) < 0.0 { -n_geo } else { n_geo };
        let z = n_geo.dot(wo);
        // Skip grazing view directions and opposite normals, where precision is lost.
        if z < 1e-3 || n.dot(n_geo) < -0.99 {
            continue;
        }
        let made = bend_normal(n, n_geo, wo);
        let shown = |n: Vec3| (2.0 * n.dot(wo) * n - wo).dot(n_geo);
        let least = (0.9 * z).min(0.01);
        assert!((made.length() - 1.0).abs() < 1e-5 && made.dot(wo) > 0.0, "{n} {n_geo} {wo}: {made}");
        // The height is correct to single precision, even near the horizon.
        assert!(shown(made) > least - 5e-4, "{n} {n_geo} {wo}: {made} shows {}", shown(made));
        // The bent normal lies in the plane of both normals, between them.
        assert!(made.dot(n.cross(n_geo)).abs() < 1e-5 && made.dot(n_geo) > n.dot(n_geo) - 1e-5);
        if made == n {
            kept += 1;
        } else {
            bent_ones += 1;
            // The normal is not bent farther than necessary.
            assert!(shown(made) < least + 1e-3, "{n} {n_geo} {wo}: {made} shows {}", shown(made));
        }
        // Normals that are close to each other stay close when they are bent.
        let beside = (n + 1e-4 * Vec3::new(1.0, -1.0, 0.5)).normalize();
        assert!((bend_normal(beside, n_geo, wo) - made).length() < 0.05, "{n} {n_geo} {wo}");
    }
    assert!(kept > 10_000 && bent_ones > 10_000, "{kept} {bent_ones}");
}

#[test]
fn geometric_normal_is_never_bent() {
    for z in [1e-7, 1e-3, 0.5, 1.0_f32] {
        let wo = Vec3::new((1.0 - z * z).max(0.0).sqrt(), 0.0, z);
        assert_eq!(bend_normal(Vec3::Z, Vec3::Z, wo), Vec3::Z);
    }
}
