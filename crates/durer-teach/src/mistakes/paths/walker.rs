//! A simple path tracer with optional mistakes. The path tracer combines light and BSDF sampling
//! with the power heuristic. It uses the renderer's surfaces, BSDFs and emitters. For scenes
//! without fog, it has the same expected value as the renderer's path tracer.

use crate::mistakes::path_bugs::{
    CosinePower, DiffusePi, DirectionSampling, EnvironmentBug, MissingFactor, PathBugs, RefractionBug, RouletteBug,
    Strategies,
};
use crate::mistakes::variant::SceneVariant;
use durer_render::integrator::media::MediumStack;
use durer_render::integrator::spawn::{offset_bound, spawn_ray, to_point};
use durer_render::integrator::{RenderSettings, Whitted};
use durer_render::world::emitters::{LightId, LightSample, Receiver};
use durer_render::world::{Geometry, Shading, SurfaceInteraction, World};
use durer_scene::bsdf::fresnel;
use durer_scene::math::{Color, Ray, Ray64, Vec2, Vec3, fp};
use durer_scene::shape::{Primitive, Shape as _};
use durer_scene::spectrum::{ColorMode, Lanes, Spectrum};
use std::f32::consts::PI;

/// Random number generator (SplitMix64) for one sample of a pixel.
struct SplitMix(u64);

impl SplitMix {
    fn new(seed: u64, (x, y): (u32, u32), sample: u32) -> Self {
        let mut numbers = SplitMix(seed ^ (u64::from(x) << 40 | u64::from(y) << 20 | u64::from(sample)));
        numbers.next();
        numbers
    }

    /// Returns a uniform random number in [0, 1). Source: Steele, Lea and Flood, *Fast Splittable
    /// Pseudorandom Number Generators*, OOPSLA 2014.
    fn next(&mut self) -> f32 {
        self.0 = self.0.wrapping_add(0x9e37_79b9_7f4a_7c15);
        let mut x = self.0;
        x = (x ^ (x >> 30)).wrapping_mul(0xbf58_476d_1ce4_e5b9);
        x = (x ^ (x >> 27)).wrapping_mul(0x94d0_49bb_1331_11eb);
        ((x ^ (x >> 31)) >> 40) as f32 / (1_u64 << 24) as f32
    }

    fn pair(&mut self) -> Vec2 {
        Vec2::new(self.next(), self.next())
    }
}

/// Maximum survival probability of Russian roulette, and the depth at which roulette starts.
const MAX_SURVIVAL: f32 = 0.95;
const MIN_ROULETTE_DEPTH: u32 = 3;

/// Simple path tracer that makes the mistakes of a [`SceneVariant`], as a student's program might.
pub struct BuggyPathTracer<'w> {
    world: &'w World,
    settings: RenderSettings,
    bugs: PathBugs,
    /// Number of lights that a simple program chooses from.
    light_count: f32,
    right: Whitted<'w>,
    lanes: Lanes,
}

impl<'w> BuggyPathTracer<'w> {
    /// Creates a tracer for the world and the mistakes of a variant.
    pub fn new(variant: &'w SceneVariant) -> Self {
        let (world, settings) = (&variant.world, variant.settings);
        let right = Whitted { world, settings, cancel: None };
        let emissive = world.objects().iter().filter(|object| world.may_emit(object.material)).count();
        let light_count = (world.lights().len() + emissive + usize::from(world.environment().is_some())).max(1) as f32;
        let lanes = Lanes::new(ColorMode::Rgb, 0.5);
        BuggyPathTracer { world, settings, bugs: variant.paths, light_count, right, lanes }
    }

    /// Returns the radiance along a camera ray for one sample of a pixel. `throughput` belongs to
    /// the pixel and is overwritten by each sample.
    pub fn radiance(&self, ray: &Ray, seed: u64, pixel: (u32, u32), sample: u32, throughput: &mut Spectrum) -> Color {
        let mut numbers = SplitMix::new(seed, pixel, sample);
        if !self.bugs.kept_throughput {
            *throughput = Spectrum::ONE;
        }
        let color = self.lanes.color(self.walk(ray.into(), &mut numbers, throughput));
        if color.is_finite() { color } else { Color::ZERO }
    }

    fn walk(&self, mut ray: Ray64, numbers: &mut SplitMix, throughput: &mut Spectrum) -> Spectrum {
        let (world, lanes) = (self.world, &self.lanes);
        let mut media = MediumStack::around(world, ray.rounded.origin);
        let mut sum = Spectrum::ZERO;
        // The last vertex whose scattered direction has a finite pdf, together with that pdf.
        let mut last: Option<(Receiver, f32)> = None;
        let mut from_eye = true;
        let (mut depth, mut layers) = (0, 0);
        while layers < 1000 {
            layers += 1;
            let Some(hit) = world.closest(&ray, &mut ()) else {
                return sum + *throughput * self.background(ray.dir(), last, from_eye);
            };
            let mut at = world.interaction(ray, hit);
            if let (Some(uv), true) = (at.surface.uv.get(), self.bugs.flipped_textures) {
                at.surface.uv = Vec2::new(uv.x, 1.0 - uv.y).into();
            }
            let transition = self.right.transition(&at, &media);
            let nothing = transition
                .as_ref()
                .is_some_and(|p| p.displaced || p.ior_front == p.ior_behind && world.is_interface(&at));
            let opacity = world.opacity(&at);
            if nothing || opacity < 1.0 && numbers.next() >= opacity {
                media = transition.filter(|_| nothing).map_or(media, |transition| transition.behind);
                ray.rounded.t_min = hit.t;
                continue;
            }
            if depth == 0 || last.is_some() || !self.bugs.no_emission_after_delta {
                sum += *throughput * self.emission(&at, last);
            }
            if depth > self.settings.bounces {
                return sum;
            }
            let eta = transition.as_ref().map_or(1.0, |transition| transition.ior_behind / transition.ior_front);
            let own_eta = if self.bugs.refraction == RefractionBug::Exchanged { 1.0 / eta } else { eta };
            let shading = world.shading(&at, own_eta, lanes);
            if shading.bsdf.is_black() {
                return sum;
            }
            let n = if shading.bsdf.passes_light() { Vec3::ZERO } else { shading.frame.normal };
            let receiver = Receiver { point: at.surface.point(), n, is_seen: true };
            if shading.bsdf.has_non_delta() {
                sum += *throughput * self.direct(&at, &shading, &receiver, numbers);
            }
            let Some((wi, weight, pdf)) = self.scattered(&shading, numbers) else { return sum };
            let Some((wi, weight)) = self.with_refraction_bugs(&shading, wi, weight, eta) else { return sum };
            let is_mirror = pdf == 0.0 && !shading.bsdf.passes_light() && !shading.bsdf.has_non_delta();
            let weight = if is_mirror && self.bugs.colorless_mirrors { Spectrum::ONE } else { weight };
            *throughput *= weight;
            let survival = if depth < MIN_ROULETTE_DEPTH { 1.0 } else { throughput.max_element().min(MAX_SURVIVAL) };
            if numbers.next() >= survival {
                return sum;
            }
            match self.bugs.roulette {
                RouletteBug::Correct => *throughput /= survival,
                RouletteBug::Undivided => {}
                RouletteBug::PerChannel if survival < 1.0 => {
                    *throughput = throughput.map(|channel| if channel > 0.0 { 1.0 } else { 0.0 });
                }
                RouletteBug::PerChannel => {}
            }
            if pdf > 0.0 {
                (last, from_eye) = (Some((receiver, pdf)), false);
            } else {
                last = None;
            }
            if let Some(transition) = transition.filter(|_| wi.dot(shading.n_geo) < 0.0) {
                media = transition.behind;
            }
            ray = spawn_ray(&at.surface, wi, f32::INFINITY, None);
            depth += 1;
        }
        sum
    }

    /// Returns the MIS weight of a light that a scattered ray hits.
    fn weight(&self, pdf: f32, light: f32) -> f32 {
        match self.bugs.strategies {
            Strategies::Weighted => power(pdf, light),
            Strategies::Unweighted => 1.0,
            Strategies::LightSamples => 0.0,
        }
    }

    /// Returns the direction in which the environment is looked up.
    fn turned(&self, dir: Vec3) -> Vec3 {
        match self.bugs.environment {
            EnvironmentBug::UpsideDown => Vec3::new(dir.x, -dir.y, dir.z),
            EnvironmentBug::Mirrored => Vec3::new(-dir.x, dir.y, dir.z),
            EnvironmentBug::HalfTurned => Vec3::new(-dir.x, dir.y, -dir.z),
            EnvironmentBug::Correct | EnvironmentBug::NoSine => dir,
        }
    }

    fn background(&self, dir: Vec3, last: Option<(Receiver, f32)>, from_eye: bool) -> Spectrum {
        let emitters = self.world.emitters();
        let (_, pdf) = emitters.sky(self.world, dir);
        let (sky, _) = emitters.sky(self.world, self.turned(dir));
        let mut light = self.lanes.light(sky);
        if from_eye {
            light += emitters.suns(dir).map(|(_, color)| self.lanes.light(color)).sum::<Spectrum>();
        }
        let chance = |to: &Receiver| pdf * emitters.chance_of_sky(self.world, to);
        last.map_or(1.0, |(to, own)| self.weight(own, chance(&to))) * light
    }

    fn emission(&self, at: &SurfaceInteraction, last: Option<(Receiver, f32)>) -> Spectrum {
        let mut color = self.world.emission(at);
        let emitters = self.world.emitters();
        if color == Color::ZERO && self.bugs.two_sided && self.world.may_emit(at.material) {
            let mut turned = *at;
            turned.surface.n_geo = -turned.surface.n_geo;
            turned.surface.n_shade = -turned.surface.n_shade;
            color = self.world.emission(&turned);
        }
        if color == Color::ZERO {
            return Spectrum::ZERO;
        }
        let weight = last.map_or(1.0, |(to, own)| {
            let way = at.surface.point() - to.point;
            let wi = at.ray.dir().normalize_or_zero();
            let light = emitters.pdf_of_hit(self.world, &at.hit, &to, wi, way.length() as f32);
            self.weight(own, light)
        });
        weight * self.lanes.light(color)
    }

    /// Returns the contribution of one light sample, including the BSDF and the cosine.
    fn direct(&self, at: &SurfaceInteraction, shading: &Shading, to: &Receiver, numbers: &mut SplitMix) -> Spectrum {
        let emitters = self.world.emitters();
        let (choice, u) = (numbers.next(), numbers.pair());
        let Some(choice) = emitters.choose(self.world, to, choice) else { return Spectrum::ZERO };
        let Some(light) = emitters.sample(self.world, &choice, to, u) else { return Spectrum::ZERO };
        let (value, bsdf_pdf) = shading.eval(light.wi);
        let value = self.with_cosine_bugs(value, shading, light.wi, Some(light.pdf == 0.0));
        if value == Spectrum::ZERO || light.radiance == Color::ZERO {
            return Spectrum::ZERO;
        }
        let reach = light.shadow_reach(offset_bound(&at.surface));
        let ray = to_point(&at.surface, light.wi, reach);
        if self.settings.shadows && (ray.rounded.t_max <= ray.rounded.t_min || self.blocked(ray)) {
            return Spectrum::ZERO;
        }
        let pdf = if light.pdf > 0.0 { light.choice * light.pdf } else { light.choice };
        let is_alone = light.pdf == 0.0 || self.bugs.strategies != Strategies::Weighted;
        let weight = if is_alone { 1.0 } else { power(pdf, bsdf_pdf) };
        let radiance = match (choice.is_sky(), self.bugs.environment) {
            (false, _) | (true, EnvironmentBug::Correct) => light.radiance,
            (true, EnvironmentBug::NoSine) => light.radiance / (1.0 - light.wi.y * light.wi.y).max(1e-4).sqrt(),
            (true, _) => emitters.sky(self.world, self.turned(light.wi)).0,
        };
        value * (weight / pdf) * self.error_factor(&light, pdf, bsdf_pdf) * self.lanes.light(radiance)
    }

    fn blocked(&self, mut ray: Ray64) -> bool {
        for _ in 0..64 {
            let Some(hit) = self.world.closest(&ray, &mut ()) else { return false };
            let at = self.world.interaction(ray, hit);
            if self.world.opacity(&at) > 0.5 && !self.world.is_interface(&at) {
                return true;
            }
            ray.rounded.t_min = hit.t;
        }
        true
    }

    /// Returns the factor by which an omitted term changes a light sample.
    fn error_factor(&self, light: &LightSample, pdf: f32, bsdf_pdf: f32) -> f32 {
        let extended = light.pdf > 0.0 && light.reach.is_finite();
        match self.bugs.missing_factor {
            MissingFactor::Nothing => 1.0,
            MissingFactor::Distance if light.reach.is_finite() => light.reach * light.reach,
            MissingFactor::DistanceOnce if light.reach.is_finite() => light.reach,
            MissingFactor::Cosine if extended => 1.0 / light.cosine.max(1e-3),
            MissingFactor::Area if extended => match light.light {
                LightId::Surface(object, part) => self.area(object, part).map_or(1.0, |area| 1.0 / area),
                LightId::Light(_) | LightId::Environment => 1.0,
            },
            MissingFactor::Choice => light.choice,
            MissingFactor::UniformChoice => 1.0 / self.light_count,
            MissingFactor::PointPi if light.pdf == 0.0 => 1.0 / PI,
            MissingFactor::Density => pdf,
            MissingFactor::OwnDensity if extended => pdf / bsdf_pdf.max(1e-4),
            _ => 1.0,
        }
    }

    /// Returns the area of a flat emitter or a sphere.
    fn area(&self, object: u32, part: u32) -> Option<f32> {
        let object = &self.world.objects()[object as usize];
        let of = |corners: &[Vec3]| -> f32 {
            let p: Vec<Vec3> = corners.iter().map(|corner| object.world_point(*corner)).collect();
            p.windows(2).skip(1).map(|pair| 0.5 * (pair[0] - p[0]).cross(pair[1] - p[0]).length()).sum()
        };
        match &object.geometry {
            Geometry::Mesh(tree) => Some(of(&tree.mesh.corners(part))),
            Geometry::Primitive(Primitive::Sphere(_)) => {
                let radius = 0.5 * object.bounds()?.size().max_element();
                Some(4.0 * PI * radius * radius)
            }
            Geometry::Primitive(shape) => {
                let polygons = shape.polygons();
                (!polygons.is_empty()).then(|| polygons.iter().map(|polygon| of(polygon)).sum())
            }
            Geometry::Solid(_) => None,
        }
    }

    /// Applies the mistakes in the cosine and in 1/π to a product of BSDF and cosine. `light` is
    /// `None` for scattered light, and it is true for point lights and directional lights.
    fn with_cosine_bugs(&self, value: Spectrum, shading: &Shading, wi: Vec3, light: Option<bool>) -> Spectrum {
        let cosine = shading.frame.normal.dot(wi).abs().max(1e-3);
        let value = match self.bugs.cosine_power {
            CosinePower::None => value / cosine,
            CosinePower::Twice => value * cosine,
            CosinePower::NoneForLights if light.is_some() => value / cosine,
            CosinePower::TwiceForLights if light.is_some() => value * cosine,
            CosinePower::NoneForPoints if light == Some(true) => value / cosine,
            _ => value,
        };
        match self.bugs.diffuse_pi {
            DiffusePi::Missing => value * PI,
            DiffusePi::MissingForLights if light.is_some() => value * PI,
            DiffusePi::MissingForScattered if light.is_none() => value * PI,
            _ => value,
        }
    }

    /// Returns a scattered direction, its weight and its pdf. The pdf is 0 for a delta lobe.
    fn scattered(&self, shading: &Shading, numbers: &mut SplitMix) -> Option<(Vec3, Spectrum, f32)> {
        let (choice, mut u) = (numbers.next(), numbers.pair());
        if self.bugs.direction_sampling == DirectionSampling::OneNumber {
            u = Vec2::splat(u.x);
        }
        let sample = shading.bsdf.sample(shading.wo, choice, u)?;
        if sample.pdf == 0.0 {
            return Some((shading.frame.to_world(sample.wi), sample.weight, 0.0));
        }
        if self.bugs.direction_sampling == DirectionSampling::Uniform {
            let (sin, cos) = fp::sin_cos_degrees(f64::from(360.0 * u.x));
            let side = (1.0 - u.y * u.y).max(0.0).sqrt();
            let local = Vec3::new(side * cos as f32, side * sin as f32, u.y.max(1e-4));
            let wi = shading.frame.to_world(local);
            let pdf = local.z / PI;
            let value = self.with_cosine_bugs(shading.eval(wi).0, shading, wi, None);
            return Some((wi, value / pdf, pdf));
        }
        let wi = shading.frame.to_world(sample.wi);
        if (wi.dot(shading.n_geo) < 0.0) != (sample.wi.z < 0.0) && !shading.bsdf.is_fibre() {
            return None;
        }
        let weight = self.with_cosine_bugs(sample.weight, shading, wi, None);
        let about_y = Vec3::new(sample.wi.x, sample.wi.z, sample.wi.y);
        let above = |wi: Vec3| wi.dot(shading.frame.normal) > 0.0;
        Some(match self.bugs.direction_sampling {
            DirectionSampling::Undivided => (wi, weight * sample.pdf, sample.pdf),
            DirectionSampling::UniformPdf => (wi, weight * (sample.pdf * 2.0 * PI), sample.pdf),
            DirectionSampling::LocalFrame => (sample.wi, weight, sample.pdf),
            DirectionSampling::AboutY => (about_y, weight, sample.pdf),
            DirectionSampling::LocalFrameAbove if !above(sample.wi) => return None,
            DirectionSampling::LocalFrameAbove => (sample.wi, weight, sample.pdf),
            DirectionSampling::AboutYAbove if !above(about_y) => return None,
            DirectionSampling::AboutYAbove => (about_y, weight, sample.pdf),
            _ => (wi, weight, sample.pdf),
        })
    }

    /// Applies the mistakes in refraction to a scattered direction and its weight. `eta` is the
    /// index of refraction behind the surface, divided by the index in front. Returns `None` if
    /// the direction is impossible.
    fn with_refraction_bugs(
        &self,
        shading: &Shading,
        wi: Vec3,
        weight: Spectrum,
        eta: f32,
    ) -> Option<(Vec3, Spectrum)> {
        let (n, wo) = (shading.frame.normal, shading.frame.to_world(shading.wo));
        let fresnel = if shading.bsdf.passes_light() { fresnel::dielectric(wo.dot(n).abs(), eta) } else { 1.0 };
        if wi.dot(n) * wo.dot(n) >= 0.0 {
            return match self.bugs.refraction {
                RefractionBug::HalfChosen if fresnel < 1.0 => Some((wi, 0.5 * weight)),
                RefractionBug::FresnelTwice => Some((wi, fresnel * weight)),
                // Refract the light that should be reflected.
                RefractionBug::NoReflection if fresnel < 1.0 => {
                    let tangent = (wo.dot(n) * n - wo) / eta;
                    let cosine = (1.0 - tangent.length_squared()).max(0.0).sqrt();
                    Some((tangent - n * (cosine * wo.dot(n).signum()), weight / (eta * eta)))
                }
                _ => Some((wi, weight)),
            };
        }
        let glass = eta.max(1.0 / eta);
        let tangent = wi - wi.dot(n) * n;
        Some(match self.bugs.refraction {
            RefractionBug::Correct | RefractionBug::Exchanged | RefractionBug::NoReflection => (wi, weight),
            RefractionBug::HalfChosen => (wi, 0.5 * weight),
            RefractionBug::FresnelTwice => (wi, (1.0 - fresnel) * weight),
            RefractionBug::RootSign => (wi - 2.0 * wi.dot(n) * n, weight),
            RefractionBug::Unscaled => (wi, weight * (eta * eta)),
            RefractionBug::DividedTwice => (wi, weight * (eta * eta / (glass * glass))),
            RefractionBug::MultipliedTwice => (wi, weight * (eta * eta * glass * glass)),
            RefractionBug::Inverted => {
                let tangent = tangent * (eta * eta);
                let cosine = (1.0 - tangent.length_squared()).max(0.0).sqrt();
                if cosine == 0.0 {
                    return None;
                }
                (tangent - n * (cosine * wo.dot(n).signum()), weight)
            }
            RefractionBug::Flipped => (wi - 2.0 * tangent, weight),
            RefractionBug::Straight => (-wo, weight),
        })
    }
}

/// Returns the weight that the power heuristic gives to a sample with pdf `a`.
fn power(a: f32, b: f32) -> f32 {
    if b == 0.0 {
        return 1.0;
    }
    let ratio = b / a;
    1.0 / (1.0 + ratio * ratio)
}
