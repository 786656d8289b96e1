//! Determines whether the light of the scene and of the sky can reach the visible surfaces,
//! directly or after reflections, and reports objects that keep out the light of the sky.

use super::area_lights::transmits_light;
use super::finding::{Finding, percent};
use super::scene_probe::{Reach, SceneProbe};
use super::shapes::spread_direction;
use super::verdict::most_common;
use durer_diag::Diagnostic;
use durer_scene::camera::Projection as _;
use durer_scene::math::{Color, Ray, Vec3};

/// Maximum number of visible points from which paths start, number of paths from each of them, and
/// number of reflections of a path.
const MAX_STARTS: usize = 150;
const PATHS: u32 = 4;
const REFLECTIONS: usize = 3;
/// Distance at which rays start, as a fraction of the distance between the camera and the visible
/// point.
const OFFSET: f32 = 1e-4;
/// Median brightness below which the visible surfaces are nearly black.
const DIM: f32 = 0.05;
/// Fraction of the reflected rays that leave the scene below which the sky hardly lights the
/// visible surfaces, and fraction that one object must stop to be the cause.
const MAX_FREE: f32 = 0.15;
const MIN_STOPPED: f32 = 0.7;
/// Minimum number of reflected rays needed for a conclusion.
const MIN_RAYS: usize = 40;

impl Reach {
    /// Returns the points of a scene, which are computed once.
    pub(super) fn of<'a>(scene_probe: &'a SceneProbe) -> &'a Reach {
        scene_probe.reach.get_or_init(|| Reach::new(scene_probe))
    }

    /// Follows paths from the visible points. Every opaque surface reflects them in random
    /// directions.
    fn new(scene_probe: &SceneProbe) -> Self {
        let mut reach = Reach::default();
        let mut number = 0;
        let step = scene_probe.hits().count().div_ceil(MAX_STARTS).max(1);
        for (probe, hit) in scene_probe.hits().step_by(step) {
            if let Some(fog) = scene_probe.world().fog() {
                let region = fog.region.as_ref().map(|place| place.bounds.clip(probe.ray.origin, probe.ray.dir));
                let (from, to) = region.unwrap_or(Some((0.0, hit.t))).unwrap_or_default();
                let (from, to) = (from.max(0.0), to.min(hit.t));
                let share = (reach.points.len() as f32 * 0.618).fract();
                reach.points.extend((from < to).then(|| (probe.ray.at(from + share * (to - from)), None)));
            }
            let offset = OFFSET * hit.t * probe.ray.dir.length();
            for _ in 0..PATHS {
                let (mut ray, mut from) = (probe.ray, None);
                for depth in 0..=REFLECTIONS {
                    let at = opaque_hit(scene_probe, &ray);
                    let object = at.map(|(object, ..)| object);
                    reach.first.extend(from.filter(|_| depth == 1).map(|from| (from, object)));
                    reach.escapes |= depth > 0 && at.is_none();
                    let Some((object, point, normal)) = at else { break };
                    if depth > 0 {
                        reach.ends.push((ray, object));
                    }
                    reach.points.push((point, Some(normal)));
                    number += 1;
                    let direction = normal + spread_direction(number % 997, 997);
                    from = Some(object);
                    ray = Ray { t_min: offset, ..Ray::new(point, direction.normalize_or(normal)) };
                }
            }
        }
        reach
    }

    /// Returns true if light reaches one of the points. `way` returns the direction from a point to
    /// the light and the distance of the light if the light shines there.
    pub(super) fn is_reached(&self, scene_probe: &SceneProbe, way: impl Fn(Vec3) -> Option<(Vec3, f32)>) -> bool {
        let eye = scene_probe.world().camera().pose().center;
        self.points.iter().any(|&(point, normal)| {
            let Some((to_light, distance)) = way(point) else { return false };
            let offset = OFFSET * (point - eye).length();
            let ray = Ray { t_min: offset, t_max: (1.0 - OFFSET) * distance, ..Ray::new(point, to_light) };
            normal.is_none_or(|normal| normal.dot(to_light) > 0.0) && opaque_hit(scene_probe, &ray).is_none()
        })
    }

    /// Returns true if a light of the scene reaches one of the points.
    pub(super) fn is_lit_by(&self, scene_probe: &SceneProbe, light: usize) -> bool {
        self.is_reached(scene_probe, |point| {
            let seen = scene_probe.world().illuminate(light, point.as_dvec3());
            (seen.color != Color::ZERO).then_some((seen.to_light, seen.distance))
        })
    }

    /// Returns the thinnest of the objects behind which the paths would leave the scene.
    fn thinnest_wall(&self, scene_probe: &SceneProbe) -> Option<u32> {
        let is_last =
            |(ray, object): &&(Ray, u32)| scene_probe.world().all_hits(ray).take(16).all(|hit| hit.object == *object);
        let walls = self.ends.iter().filter(is_last).map(|(_, object)| *object);
        let thickness = |object: u32| {
            let size = scene_probe.world().objects()[object as usize].bounds()?.size();
            Some((size.min_element(), size.max_element()))
        };
        let all = walls.filter_map(|object| Some((object, thickness(object)?)));
        all.min_by(|a, b| a.1.partial_cmp(&b.1).unwrap_or(std::cmp::Ordering::Equal)).map(|(object, _)| object)
    }
}

/// Returns the first opaque object on a ray, the point where the ray hits it, and the normal there
/// on the side of the ray.
fn opaque_hit(scene_probe: &SceneProbe, ray: &Ray) -> Option<(u32, Vec3, Vec3)> {
    let world = scene_probe.world();
    let opaque = world.all_hits(*ray).take(16).filter(|hit| !transmits_light(scene_probe, hit.object));
    let mut surfaces = opaque.map(|hit| (hit, world.interaction(*ray, hit)));
    let (hit, at) = surfaces.find(|(_, at)| !world.is_hidden(ray.dir, at))?;
    let normal = if at.inside() { -at.surface.n_geo } else { at.surface.n_geo };
    Some((hit.object, ray.at(hit.t), normal))
}

/// Returns true if the visible surfaces that emit no light are nearly black.
pub(super) fn is_dim(scene_probe: &SceneProbe) -> bool {
    let world = scene_probe.world();
    let lit = scene_probe
        .lit_probes()
        .filter(|(probe, _)| probe.hit.as_ref().is_some_and(|hit| !world.may_emit(hit.material)));
    let mut shown: Vec<f32> = lit.map(|(_, color)| color.max_element()).collect();
    shown.sort_by(f32::total_cmp);
    shown.get(shown.len() / 2).is_some_and(|brightness| *brightness < DIM)
}

/// Reports an object that keeps the light of the sky from nearly everything visible, if no other
/// light reaches it.
pub(super) fn sky_blocked(scene_probe: &SceneProbe) -> Option<Finding> {
    let world = scene_probe.world();
    let has_other_light = !super::area_lights::emissive_objects(scene_probe).is_empty()
        || !world.lights().is_empty() && !super::lights::none_contributes(scene_probe);
    if !scene_probe.is_physical() || !super::physical::has_sky(scene_probe) || has_other_light || !is_dim(scene_probe) {
        return None;
    }
    let what = match scene_probe.input.scene.background.sun() {
        Some(_) => "the sun and the sky",
        None if world.lights().is_empty() => "the background",
        None => "the lights and the background",
    };
    let place = super::colors::background_span(scene_probe);
    let reach = Reach::of(scene_probe);
    if !reach.escapes && reach.ends.len() > MIN_RAYS && scene_probe.is_dark() {
        let wall = reach.thinnest_wall(scene_probe)?;
        let name = scene_probe.object(wall);
        let diagnostic =
            Diagnostic::warning(format!("the objects around the camera are closed: no light of {what} enters"))
                .at(place.unwrap_or(scene_probe.object_span(wall)))
                .related(scene_probe.object_span(wall), "the thinnest of these objects")
                .effect("the picture is black")
                .help(format!("make an opening, for example by removing the {name}, or add a light inside"));
        return Some(Finding::from(diagnostic).affecting_whole_picture(true));
    }
    let stops: Vec<u32> = reach.first.iter().filter_map(|(from, to)| to.filter(|to| to != from)).collect();
    let roof = most_common(&stops)?;
    let rays = || reach.first.iter().filter(|(from, _)| *from != roof);
    let (all, free) = (rays().count(), rays().filter(|(_, to)| to.is_none()).count());
    let stopped = rays().filter(|(_, to)| *to == Some(roof)).count();
    let over = |part: usize, share: f32| part as f32 > share * all as f32;
    if all < MIN_RAYS || over(free, MAX_FREE) || !over(stopped, MIN_STOPPED) || scene_probe.is_glass(roof) {
        return None;
    }
    let name = scene_probe.object(roof);
    let diagnostic =
        Diagnostic::warning(format!("the {name} keeps the light of {what} from nearly everything visible"))
            .at(scene_probe.object_span(roof))
            .label(format!("blocks {} of the directions from the visible surfaces", percent(stopped, all)))
            .effect("most of the visible surface area is nearly black")
            .help("make the object smaller, move it away, or add a light on the side of the camera");
    let diagnostic = match place {
        Some(place) => diagnostic.related(place, "the light that the object blocks"),
        None => diagnostic,
    };
    Some(Finding::from(diagnostic).affecting_whole_picture(true))
}
