//! Discomfort glare of luminaires as the Unified Glare Rating (UGR). Source: CIE 117:1995.

use crate::integrator::{Integrate as _, Path};
use crate::world::World;
use durer_scene::bsdf::{Frame, warp};
use durer_scene::math::{Color, Ray64, Vec3, fp};
use durer_scene::sampler::SampleId;
use rayon::prelude::*;
use std::collections::BTreeMap;
use std::f64::consts::{LN_10, PI};

/// Number of rays that look for luminaires. Each ray stands for 3e-6 sr, so that 100 rays hit a
/// luminaire of the least size for which the rating is defined, 3e-4 sr.
const RAYS: u32 = 1 << 21;

const GOLDEN_RATIO: f64 = 1.618_033_988_749_895;

/// Eye of an observer, and where it looks.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Observer {
    /// Position in world space.
    pub eye: Vec3,
    /// Unit vector along the line of sight.
    pub direction: Vec3,
    /// Unit vector upwards, which need not be perpendicular to the line of sight.
    pub up: Vec3,
}

impl Observer {
    /// Returns the ray from the eye in a direction.
    fn ray(&self, direction: Vec3) -> Ray64 {
        Ray64::new(self.eye.as_dvec3(), direction, 0.0, f32::INFINITY)
    }
}

/// Options of [`glare`].
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct GlareOptions {
    /// Samples for the background luminance.
    pub samples: u32,
    /// Seed of the random number generator.
    pub seed: u64,
    /// Luminous efficacy of each channel: the luminance is the dot product with the radiance.
    pub lumens: Color,
}

/// Emissive object as an observer sees it.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct GlareSource {
    /// Index of the object in the world.
    pub object: u32,
    /// Mean luminance of the visible part, in cd/m^2.
    pub luminance: f64,
    /// Solid angle of the visible part, in steradians.
    pub solid_angle: f64,
    /// Guth's position index: 1 on the line of sight, and growing with the distance from it. It is
    /// the mean over the visible part that gives the same rating as the index of each direction.
    pub position_index: f64,
}

/// Result of [`glare`].
#[derive(Clone, Debug, PartialEq)]
pub struct Glare {
    /// Unified Glare Rating, or `None` if it is undefined: without visible luminaires, or if the
    /// background is black.
    pub ugr: Option<f64>,
    /// Background luminance in cd/m^2: the illuminance at the eye without the luminaires, divided
    /// by pi.
    pub background: f64,
    /// Standard error of the background luminance, if the samples were independent.
    pub background_error: f64,
    /// Visible luminaires, in the order of the objects.
    pub sources: Vec<GlareSource>,
}

/// Rates the glare of all emissive objects in front of an observer. The result does not depend on
/// the number of threads. Lights without extent have no luminance and only light the background.
pub fn glare(path: &Path, observer: &Observer, options: &GlareOptions) -> Glare {
    let sources = sources(path.world, observer, options.lumens);
    let (background, background_error) = background(path, observer, options);
    let sum: f64 =
        sources.iter().map(|source| source.solid_angle * square(source.luminance / source.position_index)).sum();
    let ugr = (sum > 0.0 && background > 0.0).then(|| rating(0.25 / background * sum));
    Glare { ugr, background, background_error, sources }
}

/// Luminance of an emissive object along a ray, with the object's index and Guth's index.
struct Sighting {
    object: u32,
    luminance: f64,
    position_index: f64,
}

/// Finds the luminaires by rays on a Fibonacci spiral, each of which stands for the same solid
/// angle.
fn sources(world: &World, observer: &Observer, lumens: Color) -> Vec<GlareSource> {
    let frame = Frame::around(observer.direction);
    let look = |number: u32| {
        let cos = 1.0 - (f64::from(number) + 0.5) / f64::from(RAYS);
        let turn = (f64::from(number) / GOLDEN_RATIO).fract();
        let dir = frame.to_world(warp::polar(cos as f32, turn as f32));
        let at = world.intersect(observer.ray(dir), &mut ())?;
        let luminance = f64::from(world.emission(&at).dot(lumens));
        let position_index = position_index(observer, dir);
        (luminance > 0.0).then_some(Sighting { object: at.hit.object, luminance, position_index })
    };
    let sightings: Vec<Sighting> = (0..RAYS).into_par_iter().filter_map(look).collect();
    let mut seen: BTreeMap<u32, (f64, f64, f64)> = BTreeMap::new();
    for Sighting { object, luminance, position_index } in sightings {
        let (count, light, near) = seen.entry(object).or_default();
        *count += 1.0;
        *light += luminance;
        *near += 1.0 / square(position_index);
    }
    let angle = 2.0 * PI / f64::from(RAYS);
    let source = |(object, (count, light, near)): (u32, (f64, f64, f64))| GlareSource {
        object,
        luminance: light / count,
        solid_angle: count * angle,
        position_index: (count / near).sqrt(),
    };
    seen.into_iter().map(source).collect()
}

/// Returns the luminance of the background and its standard error. Luminaires count as black.
fn background(path: &Path, observer: &Observer, options: &GlareOptions) -> (f64, f64) {
    let frame = Frame::around(observer.direction);
    let sample = |number: u32| {
        let id = SampleId::new(options.seed, (0, 0), number);
        let dir = frame.to_world(warp::cosine_hemisphere(id.pair(0)));
        let ray = observer.ray(dir);
        let is_source = |at| path.world.emission(&at) != Color::ZERO;
        if path.world.intersect(ray, &mut ()).is_some_and(is_source) {
            return 0.0;
        }
        f64::from(path.radiance(&ray.rounded, id, &mut ()).dot(options.lumens))
    };
    // Sums in order do not depend on the threads.
    let values: Vec<f64> = (0..options.samples).into_par_iter().map(sample).collect();
    let n = values.len() as f64;
    let mean = values.iter().sum::<f64>() / n;
    let variance = values.iter().map(|value| square(value - mean)).sum::<f64>() / (n * (n - 1.0).max(1.0));
    (mean, variance.sqrt())
}

/// Returns Guth's position index of a direction. Above the line of sight, the formula is that of
/// Levin (*Position index in VCP calculations*, 1975); below it, that of Iwata and Tokura (1997).
fn position_index(observer: &Observer, dir: Vec3) -> f64 {
    let (sight, dir) = (observer.direction.as_dvec3(), dir.as_dvec3().normalize());
    let right = sight.cross(observer.up.as_dvec3()).try_normalize().unwrap_or_else(|| sight.any_orthonormal_vector());
    let up = right.cross(sight);
    let (ahead, across, above) = (dir.dot(sight), dir.dot(right), dir.dot(up));
    if above < 0.0 {
        let ratio = (square(across) + square(above)).sqrt() / ahead.max(1e-6);
        let slope = if ratio < 0.6 { 0.8 } else { 1.2 };
        // Levin's formula ends at 16, and so does this one.
        return (1.0 + slope * ratio).min(MAX_POSITION_INDEX);
    }
    // Angle of the plane through the source and the line of sight from the vertical, and angle
    // between both, in degrees.
    let alpha = fp::atan2_f64(across.abs(), above).to_degrees();
    let beta = fp::atan2_f64((square(across) + square(above)).sqrt(), ahead).to_degrees();
    let linear = 35.2 - 0.31889 * alpha - 1.22 * exp(-2.0 * alpha / 9.0);
    let quadratic = 21.0 + 0.26667 * alpha - 0.002963 * alpha * alpha;
    exp(1e-3 * linear * beta + 1e-5 * quadratic * beta * beta).min(MAX_POSITION_INDEX)
}

fn square(x: f64) -> f64 {
    x * x
}

fn exp(x: f64) -> f64 {
    f64::from(fp::exp(x as f32))
}

/// Returns the rating for the sum over the luminaires, which is relative to the background.
fn rating(sum: f64) -> f64 {
    8.0 * f64::from(fp::ln(sum as f32)) / LN_10
}

/// Largest value in the tables of the position index.
const MAX_POSITION_INDEX: f64 = 16.0;

#[cfg(test)]
mod tests {
    use super::*;
    use crate::compile::testing;
    use crate::integrator::{Integrator, IntegratorContext, IntegratorKind};
    use crate::render::Job;

    const AHEAD: Observer = Observer { eye: Vec3::ZERO, direction: Vec3::NEG_Z, up: Vec3::Y };
    const OPTIONS: GlareOptions = GlareOptions { samples: 1 << 14, seed: 0, lumens: Vec3::new(0.0, 1.0, 0.0) };

    fn rated(text: &str, observer: &Observer) -> Glare {
        let world = testing::read(text);
        let settings = Job::default().settings;
        let context = IntegratorContext { world: &world, settings, cone: None, seed: 0, cancel: None };
        let Integrator::Path(path) = IntegratorKind::PATH.create(context) else { panic!("no path") };
        glare(&path, observer, &OPTIONS)
    }

    /// A black ball of 2000 cd/m^2 in uniform surroundings of 50 cd/m^2.
    fn ball(center: [f32; 3], radius: f32) -> String {
        let [x, y, z] = center;
        format!(
            "PerspectiveCamera {{ center 0 0 0 direction 0 0 -1 up 0 1 0 angle 60 }}
             Background {{ color 50 50 50 }}
             Materials {{ PrincipledMaterial {{ baseColor 0 0 0 specularWeight 0 emissionLuminance 2000 }} }}
             Group {{ MaterialIndex 0 Sphere {{ center {x} {y} {z} radius {radius} }} }}"
        )
    }

    #[test]
    fn ball_in_uniform_surroundings_has_the_rating_of_the_formula() {
        for (center, radius) in [([0.0, 0.0, -4.0], 0.2_f64), ([1.0, 2.0, -4.0], 0.3), ([-3.0, 1.0, -2.0], 0.4)] {
            let place = Vec3::from(center).as_dvec3();
            let sin = radius / place.length();
            let solid_angle = 2.0 * PI * (1.0 - (1.0 - sin * sin).sqrt());
            let cos = -place.z / place.length();
            let background = 50.0 * (1.0 - sin * sin * cos);
            // Mean over the cone of directions to the ball.
            let (cone, least) = (Frame::around(place.as_vec3().normalize()), (1.0 - sin * sin).sqrt() as f32);
            let part = |i: u16| (f32::from(i) + 0.5) / 256.0;
            let direction = |i, j| cone.to_world(warp::polar(1.0 - (1.0 - least) * part(i), part(j)));
            let indices = (0..256).flat_map(|i| (0..256).map(move |j| (i, j)));
            let weights = indices.map(|(i, j)| 1.0 / square(position_index(&AHEAD, direction(i, j))));
            let weight = weights.sum::<f64>() / 65536.0;
            let expected = rating(0.25 / background * solid_angle * square(2000.0) * weight);
            let rated = rated(&ball(center, radius as f32), &AHEAD);
            let [source] = rated.sources[..] else { panic!("{rated:?}") };
            assert!((source.luminance - 2000.0).abs() < 0.01, "{source:?}");
            assert!((source.solid_angle / solid_angle - 1.0).abs() < 0.005, "{source:?} {solid_angle}");
            assert!(
                (rated.background - background).abs() < 5.0 * rated.background_error + 1e-3,
                "{rated:?} {background}"
            );
            assert!((rated.ugr.unwrap() - expected).abs() < 0.02, "{rated:?} {expected}");
        }
    }

    #[test]
    fn position_index_of_the_tables() {
        let index = |across: f32, above: f32| position_index(&AHEAD, Vec3::new(across, above, -1.0));
        // Values of the table in CIE 117 for T/R (across) and H/R (above).
        for (across, above, expected) in [
            (0.0, 0.0, 1.0),
            (0.0, 0.1, 1.26),
            (0.0, 0.5, 2.86),
            (0.0, 1.0, 7.0),
            (0.0, 1.5, 13.15),
            (0.5, 0.0, 1.43),
            (1.0, 0.0, 2.11),
            (1.5, 0.0, 2.85),
        ] {
            let found = index(across, above);
            assert!((found / expected - 1.0).abs() < 0.04, "{across} {above}: {found} {expected}");
        }
        assert!((index(-0.5, 0.0) - index(0.5, 0.0)).abs() < 1e-6);
        assert_eq!(index(0.0, 40.0), MAX_POSITION_INDEX);
        assert!((index(0.3, -0.4) - 1.4).abs() < 1e-6 && (index(0.6, -0.8) - 2.2).abs() < 1e-6);
    }

    #[test]
    fn hidden_luminaires_and_those_behind_do_not_glare() {
        let behind = Observer { direction: Vec3::Z, ..AHEAD };
        let text = ball([0.0, 0.0, -4.0], 0.2);
        let away = rated(&text, &behind);
        assert_eq!((away.ugr, away.sources.len()), (None, 0));
        assert!((away.background - 50.0).abs() < 1e-3);
        let hidden = text.replace("Materials {", "Materials { PhongMaterial { diffuseColor 0 0 0 }").replace(
            "MaterialIndex 0",
            "MaterialIndex 0 Disc { center 0 0 -2 normal 0 0 1 radius 0.5 } MaterialIndex 1",
        );
        assert_eq!(rated(&hidden, &AHEAD).sources, []);
    }
}
