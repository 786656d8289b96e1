use super::*;
use durer_scene::math::random::Random;

fn lights(random: &mut Random, count: usize) -> Vec<LightBounds> {
    (0..count)
        .map(|i| {
            let p = 10.0 * random.point();
            LightBounds {
                bounds: Aabb { min: p, max: p + 0.1 },
                power: random.between(0.0, 2.0) * f32::from(i % 7 != 3),
                axis: random.direction(),
                cos_normals: if i % 3 == 0 { -1.0 } else { 1.0 },
                cos_emission: 0.0,
                two_sided: i % 5 == 0,
                emitter_power: 1.0,
            }
        })
        .collect()
}

fn all_ways() -> LightBounds {
    let bounds = Aabb { min: Vec3::ZERO, max: Vec3::ZERO };
    let (axis, cos_normals, cos_emission) = (Vec3::Z, -1.0, 0.0);
    LightBounds { bounds, power: 1.0, axis, cos_normals, cos_emission, two_sided: false, emitter_power: 1.0 }
}

#[test]
fn probabilities_match_sampling_and_sum_to_one() {
    let mut random = Random(5);
    for (count, alike) in [(1, false), (2, false), (3, false), (17, false), (400, false), (400, true)] {
        let mut all = lights(&mut random, count);
        if alike {
            // Move the lights close together, so that the group is far from most points.
            let of = |LightBounds { bounds, .. }: LightBounds| Aabb { min: 0.1 * bounds.min, max: 0.1 * bounds.max };
            all.iter_mut().for_each(|light| *light = LightBounds { bounds: of(*light), power: 1.0, ..all_ways() });
        }
        let (tree, order) = LightTree::new(&all);
        for i in 0..40 {
            let n = if i % 2 == 0 { random.direction() } else { Vec3::ZERO };
            let to = Receiver { point: (12.0 * random.point()).as_dvec3(), n, is_seen: false };
            let sum: f32 = (0..order.len() as u32).map(|i| tree.probability(&to, i)).sum();
            // If no child of a node contributes, nothing is chosen.
            let always = alike && n == Vec3::ZERO;
            assert!(sum < 1.0 + 1e-4 && (!always || sum > 1.0 - 1e-4), "{sum}");
            for _ in 0..50 {
                let Some((i, probability)) = tree.sample(&to, random.between(0.0, 1.0)) else { continue };
                let again = tree.probability(&to, i);
                assert!((again - probability).abs() <= 1e-5 * probability, "{again} {probability}");
                assert!(all[order[i as usize] as usize].power > 0.0);
            }
        }
    }
}

#[test]
fn lights_behind_a_surface_are_not_chosen() {
    let mut random = Random(7);
    let all: Vec<LightBounds> =
        lights(&mut random, 300).into_iter().map(|light| LightBounds { emitter_power: 0.0, ..light }).collect();
    let (tree, order) = LightTree::new(&all);
    let (mut behind, mut chosen) = (0, 0);
    for _ in 0..100 {
        let to = Receiver { point: (5.0 * random.point()).as_dvec3(), n: random.direction(), is_seen: true };
        for _ in 0..50 {
            let Some((i, _)) = tree.sample(&to, random.between(0.0, 1.0)) else { continue };
            let bounds = all[order[i as usize] as usize].bounds;
            let above = (bounds.center().as_dvec3() - to.point).dot(to.n.as_dvec3());
            behind += i32::from(above < -0.5 * f64::from(bounds.size().length()));
            chosen += 1;
        }
    }
    assert!(behind == 0 && chosen > 1000, "{behind} of {chosen}");
}

#[test]
fn every_light_that_reaches_a_point_can_be_chosen() {
    let mut random = Random(6);
    let all = lights(&mut random, 300);
    let (tree, order) = LightTree::new(&all);
    for _ in 0..50 {
        let p = 12.0 * random.point();
        let to = Receiver { point: p.as_dvec3(), n: Vec3::ZERO, is_seen: true };
        for (i, light) in all.iter().enumerate().filter(|(_, light)| light.power > 0.0) {
            let to_point = p - light.bounds.center();
            let emits = light.cos_normals < 0.0
                || light.axis.dot(to_point) > 0.2
                || (light.two_sided && light.axis.dot(to_point).abs() > 0.2);
            let place = order.iter().position(|&number| number as usize == i).unwrap();
            let probability = |n| tree.probability(&Receiver { n, ..to }, place as u32);
            assert!(!emits || probability(Vec3::ZERO) > 0.0, "{i} of {light:?} at {p}");
            let n = random.direction();
            let is_above = n.dot(to_point) < -light.bounds.size().length();
            assert!(!emits || !is_above || probability(n) > 0.0, "{i} of {light:?} at {p}, {n}");
        }
    }
}
