//! Emission of photons from lights towards objects that reflect or refract.

use super::{AreaLight, InfiniteLight, LightEntry, of_light};
use crate::world::{Geometry, Material, Object, World};
use durer_scene::bsdf::{Frame, warp};
use durer_scene::light::Illuminate as _;
use durer_scene::math::{Aabb, Color, Ray64, Vec2, Vec3};
use durer_scene::shape::Primitive;
use durer_scene::texture::Environment;
use glam::DVec3;
use std::f32::consts::PI;

/// Bounding sphere of an object that casts caustics, to which photons are sent.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct PhotonTarget {
    /// Centre.
    pub center: Vec3,
    /// Radius.
    pub radius: f32,
    /// Index of the object.
    pub object: u32,
}

/// Photon emitter of a scene, with all light sources and the targets to which they send photons.
#[derive(Clone, Debug, Default)]
pub struct PhotonEmitter {
    targets: Vec<PhotonTarget>,
    sources: Vec<PhotonSource>,
    /// Cumulative power of the sources, used to choose one at random.
    sums: Vec<f32>,
    /// Length of the diagonal of the scene's bounds.
    reach: f32,
}

/// Light source that emits photons.
#[derive(Clone, Copy, Debug)]
enum PhotonSource {
    /// An emissive surface.
    Area(AreaLight),
    /// A light with a position, by its index.
    Point(u32),
    /// A light at infinity, by its index.
    Distant(u32),
    /// The environment.
    EnvironmentMap,
}

/// Photon as emitted, with its ray and its power divided by the sampling density.
#[derive(Clone, Copy, Debug)]
pub struct EmittedPhoton {
    /// The ray.
    pub ray: Ray64,
    /// Power per colour channel. For a light with a position, the power is relative to the light's
    /// intensity.
    pub power: Color,
    /// Index of the light that emitted the photon, if it has a position. The light's intensity is
    /// applied at the hit point.
    pub light: Option<u32>,
    /// Index of the material that emitted the photon, if any.
    pub material: Option<u32>,
}

impl PhotonEmitter {
    /// Prepares the emission of photons from all lights to all objects that reflect or refract
    /// light.
    pub fn new(world: &World) -> Self {
        let targets = targets(world);
        let all = world.objects().iter().filter_map(Object::bounds).reduce(Aabb::union);
        let reach = all.map_or(0.0, |all| all.size().length());
        let mut beams = PhotonEmitter { targets, reach, ..PhotonEmitter::default() };
        if beams.targets.is_empty() {
            return beams;
        }
        let area: f32 = beams.targets.iter().map(|target| PI * target.radius * target.radius).sum();
        let emitters = world.emitters();
        for source in emitters.in_scene_order() {
            match source {
                LightEntry::Area(area) => {
                    let sides = if area.two_sided { 2.0 } else { 1.0 };
                    beams.add(PhotonSource::Area(*area), PI * sides * area.form.area() * area.radiance.max_element());
                }
                LightEntry::Light(number) => {
                    beams.add(PhotonSource::Point(*number), 4.0 * PI * PI * strength(world, *number))
                }
            }
        }
        for &InfiniteLight { light, way, .. } in &emitters.outside_tree {
            let color = world.lights()[light as usize].color().max_element();
            match way != Vec3::ZERO {
                true => beams.add(PhotonSource::Distant(light), PI * color * area),
                // The light's attenuation may differ from the inverse square law, so use its
                // strength at a distance equal to the scene's size.
                false => beams.add(PhotonSource::Point(light), 4.0 * PI * PI * color * reach * reach),
            }
        }
        if let Some(sky) = world.environment() {
            beams.add(PhotonSource::EnvironmentMap, 4.0 * PI * sky.mean().max_element() * area);
        }
        beams
    }

    /// Adds a light source with the given power.
    fn add(&mut self, source: PhotonSource, power: f32) {
        if power > 0.0 && power.is_finite() {
            self.sources.push(source);
            self.sums.push(self.sums.last().unwrap_or(&0.0) + power);
        }
    }

    /// Returns true if photons are sent to an object.
    pub fn reaches(&self, object: u32) -> bool {
        !self.sources.is_empty() && self.targets.binary_search_by_key(&object, |target| target.object).is_ok()
    }

    /// Returns the radius of the smallest target, in world units.
    pub fn min_target_radius(&self) -> f32 {
        self.targets.iter().map(|target| target.radius).fold(f32::INFINITY, f32::min)
    }

    /// Emits a photon. The numbers in `choices` select the source and the target, and `place`
    /// selects the point on the source. All numbers are in [0, 1).
    pub fn emit(&self, world: &World, choices: Vec2, place: Vec2, direction: Vec2) -> Option<EmittedPhoton> {
        let all = *self.sums.last()?;
        let wanted = choices.x * all;
        let i = self.sums.partition_point(|&sum| sum <= wanted).min(self.sums.len() - 1);
        let before = if i > 0 { self.sums[i - 1] } else { 0.0 };
        let choice = (self.sums[i] - before) / all;
        let target = ((choices.y * self.targets.len() as f32) as usize).min(self.targets.len() - 1);
        match self.sources[i] {
            PhotonSource::Area(area) => {
                let (point, normal, density) = area.form.point(area.normal, place)?;
                let (dir, pdf) = self.sample_cone(point, target, direction)?;
                let cosine = normal.dot(dir);
                if cosine == 0.0 || cosine < 0.0 && !area.two_sided {
                    return None;
                }
                let power = area.radiance * (cosine.abs() / (density * pdf * choice));
                // Offset the ray origin from the emitter's surface.
                let side = if cosine < 0.0 { -normal } else { normal };
                let origin = point + f64::from(4.0 * area.error) * side.as_dvec3();
                Some(EmittedPhoton {
                    ray: Ray64::new(origin, dir, 0.0, f32::INFINITY),
                    power,
                    light: None,
                    material: Some(world.objects()[area.object as usize].material),
                })
            }
            PhotonSource::Point(light) => {
                let origin = world.illuminate(light as usize, DVec3::ZERO);
                let point = f64::from(origin.distance) * origin.to_light.as_dvec3();
                let (dir, pdf) = self.sample_cone(point, target, direction)?;
                let ray = Ray64::new(point, dir, 0.0, f32::INFINITY);
                Some(EmittedPhoton {
                    ray,
                    power: Color::splat(1.0 / (pdf * choice)),
                    light: Some(light),
                    material: None,
                })
            }
            PhotonSource::Distant(light) => {
                let sample = super::spread(world, light, of_light(world, light, DVec3::ZERO, 1.0), place);
                let (ray, density) = self.sample_parallel(-sample.wi, target, direction);
                Some(EmittedPhoton { ray, power: sample.radiance / (density * choice), light: None, material: None })
            }
            PhotonSource::EnvironmentMap => {
                let (wi, radiance, pdf) = from_all_around(world.environment()?, place)?;
                let (ray, density) = self.sample_parallel(-wi, target, direction);
                Some(EmittedPhoton { ray, power: radiance / (density * pdf * choice), light: None, material: None })
            }
        }
    }

    /// Samples a direction from a point towards a target. The result includes the density of the
    /// direction per steradian, averaged over all targets.
    fn sample_cone(&self, point: DVec3, target: usize, u: Vec2) -> Option<(Vec3, f32)> {
        let cone = |target: &PhotonTarget| {
            let to = (target.center.as_dvec3() - point).as_vec3();
            let (d2, r2) = (to.length_squared(), target.radius * target.radius);
            // From inside the sphere, all directions hit the sphere.
            let cosine = if d2 > r2 { (1.0 - r2 / d2).sqrt() } else { -1.0 };
            (to.normalize_or(Vec3::Z), cosine)
        };
        let (axis, cosine) = cone(&self.targets[target]);
        let dir = Frame::around(axis).to_world(warp::polar(1.0 - u.x * (1.0 - cosine), u.y)).normalize();
        // A direction can hit several targets.
        let density = |target: &PhotonTarget| {
            let (axis, cosine) = cone(target);
            if axis.dot(dir) >= cosine - 1e-6 { 1.0 / (2.0 * PI * (1.0 - cosine).max(1e-7)) } else { 0.0 }
        };
        let sum: f32 = self.targets.iter().map(density).sum();
        (sum > 0.0).then(|| (dir, sum / self.targets.len() as f32))
    }

    /// Samples a ray in a given direction that passes through a target. The ray starts in front of
    /// all objects. The result includes the density of the ray per unit area, averaged over all
    /// targets.
    fn sample_parallel(&self, dir: Vec3, target: usize, u: Vec2) -> (Ray64, f32) {
        let frame = Frame::around(dir);
        let disc = warp::disc(u);
        let PhotonTarget { center, radius, .. } = self.targets[target];
        let through = center + radius * (disc.x * frame.tangent + disc.y * frame.bitangent);
        let density = |target: &PhotonTarget| {
            let beside = (target.center - through).reject_from_normalized(dir).length_squared();
            let square = target.radius * target.radius;
            if beside <= square * (1.0 + 1e-5) { 1.0 / (PI * square) } else { 0.0 }
        };
        let sum: f32 = self.targets.iter().map(density).sum();
        // Start in front of all objects, because objects other than the target can cast shadows.
        let far = 2.0 * self.reach;
        let origin = through.as_dvec3() - f64::from(far) * dir.as_dvec3();
        (Ray64::new(origin, dir, 0.0, f32::INFINITY), sum / self.targets.len() as f32)
    }
}

/// Samples a direction towards the environment. The result includes the radiance from that
/// direction and its density per steradian. Half of the directions are uniformly distributed,
/// because light from dim parts of the environment that passes mirrors and glass is found only by
/// photons.
fn from_all_around(sky: &Environment, u: Vec2) -> Option<(Vec3, Color, f32)> {
    let (wi, light, pdf) = match u.x < 0.5 {
        true => sky.sample(Vec2::new(2.0 * u.x, u.y))?,
        false => {
            let wi = warp::sphere(Vec2::new(2.0 * u.x - 1.0, u.y));
            let (light, pdf) = sky.at_with_pdf(wi);
            (wi, light, pdf)
        }
    };
    Some((wi, light, 0.5 * (pdf + 0.25 / PI)))
}

/// Returns the intensity of a light with a position.
fn strength(world: &World, light: u32) -> f32 {
    world.lights()[light as usize].inverse_square().map_or(0.0, |(_, intensity)| intensity.max_element()).max(0.0)
}

impl World {
    /// True if photons can be of use: at least one bounded object reflects or refracts light into
    /// single directions.
    pub fn casts_caustics(&self) -> bool {
        !targets(self).is_empty()
    }
}

/// Returns the bounding spheres of all bounded objects that reflect or refract light into single
/// directions, ordered by object.
fn targets(world: &World) -> Vec<PhotonTarget> {
    let mut found = Vec::new();
    for (number, object) in world.objects().iter().enumerate() {
        if !casts_caustics(world, object) {
            continue;
        }
        let Some(bounds) = object.bounds() else { continue };
        let (center, half) = (bounds.center(), 0.5 * bounds.size());
        let radius = match &object.geometry {
            Geometry::Primitive(Primitive::Sphere(_)) => half.max_element(),
            // The sphere contains all corners of the bounding box.
            Geometry::Primitive(_) | Geometry::Mesh(_) | Geometry::Solid(_) => half.length(),
        };
        if radius > 0.0 && radius.is_finite() {
            found.push(PhotonTarget { center, radius: 1.001 * radius, object: number as u32 });
        }
    }
    found
}

/// Returns true if an object may reflect or refract light into single directions.
fn casts_caustics(world: &World, object: &Object) -> bool {
    // The parts of a solid have materials of their own.
    if matches!(object.geometry, Geometry::Solid(_)) {
        return true;
    }
    match &world.materials()[object.material as usize] {
        Material::Phong(phong) => match &phong.principled {
            Some(own) => own.has_delta_lobes(),
            None => phong.reflective != Color::ZERO || phong.transparent != Color::ZERO,
        },
        Material::Mix(..) => true,
    }
}
