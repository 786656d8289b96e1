//! Light sources that path tracing chooses with fixed probabilities.

use crate::layout::{self, Emitter, Object};
use bytemuck::Zeroable as _;
use durer_render::world::World;
use durer_render::world::emitters::AreaLight;
use durer_scene::light::{EmitterShape, Illuminate as _};
use durer_scene::math::Aabb;
use std::f32::consts::PI;

/// Share of the choices that ignore the power of the emitters, so that no emitter is found rarely
/// because its power was estimated badly.
const UNIFORM_SHARE: f32 = 0.1;

/// Returns the emissive surfaces in scene order, followed by the lights. Sets the first emitter of
/// each object.
pub fn emitters(world: &World, objects: &mut [Object]) -> Vec<Emitter> {
    let mut emitters = Vec::new();
    let mut powers = Vec::new();
    let reach2 = squared_reach(world);
    for area in world.emitters().area_lights() {
        let first = &mut objects[area.object as usize].first_emitter;
        if area.part == 0 {
            *first = emitters.len() as u32;
        }
        let emitter = of_area(area);
        // Light arriving at the distance `reach`, as for the other lights.
        let is_hidden = emitter.kind == layout::HIDDEN_EMITTER;
        powers.push(if is_hidden { 0.0 } else { emitter.area * area.radiance.max_element() / reach2 });
        emitters.push(emitter);
    }
    for (number, light) in world.lights().iter().enumerate() {
        let arriving = match light.inverse_square() {
            Some((_, intensity)) => intensity.max_element() / reach2,
            None => light.color().max_element(),
        };
        powers.push(PI * arriving);
        emitters.push(Emitter { kind: layout::LIGHT_EMITTER, light: number as u32, ..Emitter::zeroed() });
    }
    set_probabilities(&mut emitters, &powers);
    emitters
}

/// Returns the square of half the diagonal of the scene, or 1 for a scene without extent.
fn squared_reach(world: &World) -> f32 {
    let bounds: Aabb = world.bounds();
    let reach2 = if bounds.is_empty() { 1.0 } else { 0.25 * bounds.size().length_squared() };
    if reach2 > 0.0 && reach2.is_finite() { reach2 } else { 1.0 }
}

/// Sets probabilities that are mostly proportional to the powers. An emitter with power 0 is never
/// chosen.
fn set_probabilities(emitters: &mut [Emitter], powers: &[f32]) {
    let usable = |power: f32| if power.is_finite() { f64::from(power.max(0.0)) } else { 0.0 };
    let total: f64 = powers.iter().map(|&power| usable(power)).sum();
    let count = powers.iter().filter(|&&power| usable(power) > 0.0).count();
    let mut sum = 0.0;
    for (emitter, &power) in emitters.iter_mut().zip(powers) {
        let power = usable(power);
        if power > 0.0 {
            let uniform = f64::from(UNIFORM_SHARE);
            let probability = (1.0 - uniform) * power / total + uniform / count as f64;
            sum += probability;
            emitter.probability = probability as f32;
        }
        emitter.cumulative = sum as f32;
    }
    // Rounding must not leave a gap below 1, into which a random number could fall.
    if let Some(last) = emitters.iter().rposition(|emitter| emitter.probability > 0.0) {
        emitters[last..].iter_mut().for_each(|emitter| emitter.cumulative = 2.0);
    }
}

fn of_area(area: &AreaLight) -> Emitter {
    let emitter = Emitter {
        area: area.form.area(),
        normal: area.normal.into(),
        two_sided: u32::from(area.two_sided),
        radiance: area.radiance.into(),
        error: area.error,
        ..Emitter::zeroed()
    };
    let near = |p: glam::DVec3| p.as_vec3().into();
    match area.form {
        EmitterShape::Triangle(p, [e, f]) => {
            Emitter { kind: layout::TRIANGLE_EMITTER, point: near(p), edge_0: e.into(), edge_1: f.into(), ..emitter }
        }
        EmitterShape::Parallelogram(p, [e, f]) => Emitter {
            kind: layout::PARALLELOGRAM_EMITTER,
            point: near(p),
            edge_0: e.into(),
            edge_1: f.into(),
            ..emitter
        },
        EmitterShape::Ellipse(p, [u, v], inner) => Emitter {
            kind: layout::ELLIPSE_EMITTER,
            point: near(p),
            edge_0: u.into(),
            edge_1: v.into(),
            radius: inner,
            ..emitter
        },
        EmitterShape::Sphere(p, radius) => Emitter { kind: layout::SPHERE_EMITTER, point: near(p), radius, ..emitter },
        EmitterShape::Closed(_) => Emitter { kind: layout::HIDDEN_EMITTER, ..emitter },
    }
}
