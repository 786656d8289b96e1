//! A student's ray tracer, which is a second implementation of Whitted's algorithm that can make
//! mistakes.
//!
//! It is separate from [`Whitted`] so that the renderer contains no code for mistakes. A test
//! checks that both return bit-identical colours if there are no mistakes.

mod colors;
mod hits;
mod lights;

use super::bugs::{
    Ambient, BehindOrigin, Bugs, Fresnel, Glass, HighlightBugs, HitChoice, LightSum, Mirror, Normals, ShadowDirection,
    ShadowRayEnd, SphereNormal, TotalReflection,
};
use super::variant::{CourseShape, course_shape};
use durer_render::integrator::media::MediumStack;
use durer_render::integrator::media::MediumTransition;
use durer_render::integrator::spawn::{spawn_ray, to_light};
use durer_render::integrator::whitted::secondary::{SpecularBlend, fresnel_share};
use durer_render::integrator::{RenderSettings, Whitted, refract};
use durer_render::world::{Epsilon, Geometry, Object, SurfaceInteraction, WeightedMaterial, World};
use durer_scene::camera::Projection;
use durer_scene::light::LightLiSample;
use durer_scene::math::{Color, Ray, Ray64, Vec2, Vec3, fp, gamma, reflect};
use durer_scene::shape::{Primitive, SurfacePoint};
use smallvec::SmallVec;

/// Least distance by which rays start in front of a surface if rounding must not decide whether
/// they hit it.
const FRONT: f32 = 1e-3;

/// Whitted ray tracer that makes the mistakes in `bugs`, as a student's program might.
#[derive(Clone, Copy, Debug)]
pub struct BuggyTracer<'w> {
    world: &'w World,
    settings: RenderSettings,
    bugs: &'w Bugs,
    right: Whitted<'w>,
    shadow_world: Option<&'w World>,
}

/// State that [`BuggyTracer`] passes from a ray to its reflected and transmitted rays.
#[derive(Clone)]
struct RayState {
    bounces: u32,
    media: MediumStack,
    weight: f32,
    first: bool,
}

impl<'w> BuggyTracer<'w> {
    /// Creates a tracer that renders `world` with the mistakes in `bugs`.
    pub fn new(world: &'w World, settings: RenderSettings, bugs: &'w Bugs) -> Self {
        let right = Whitted { world, settings, cancel: None };
        BuggyTracer { world, settings, bugs, right, shadow_world: None }
    }

    /// Traces shadow rays in another world, if one is given.
    pub fn with_shadow_world(self, shadow_world: Option<&'w World>) -> Self {
        BuggyTracer { shadow_world, ..self }
    }

    /// Returns the radiance along a camera ray.
    pub fn radiance(&self, ray: &Ray) -> Color {
        let path = RayState { bounces: self.settings.bounces, media: MediumStack::default(), weight: 1.0, first: true };
        self.trace(&ray.into(), path)
    }

    fn trace(&self, ray: &Ray64, mut path: RayState) -> Color {
        let mut rest = *ray;
        // With some mistakes, a ray hits the same surface again and again, so the loop is limited.
        for _ in 0..64 {
            let behind = match self.bugs.behind {
                Some(BehindOrigin::All) => true,
                Some(BehindOrigin::Camera) => path.first,
                Some(BehindOrigin::Beyond) | None => false,
            };
            let from = if behind { f32::NEG_INFINITY } else { rest.rounded.t_min };
            let reaching = Ray64 { rounded: Ray { t_min: from, ..rest.rounded }, ..rest };
            let Some((hit, t)) = self.closest(&reaching) else { break };
            let mut at = self.world.interaction(self.own_ray(ray, hit.object), hit);
            if self.bugs.hit_choice == HitChoice::MovedDirection {
                (at.ray, at.surface.position, at.surface.rounding_error) = (*ray, ray.rounded.at(t), Vec3::ZERO);
            }
            match self.right.transition(&at, &path.media) {
                Some(MediumTransition { displaced: true, behind, .. }) => {
                    (path.media, rest.rounded.t_min) = (behind, hit.t)
                }
                transition => {
                    let color = self.shade(&self.met(at, t), transition, path);
                    let clamped = self.bugs.clamped_rays;
                    return if clamped { color.clamp(Color::ZERO, Color::ONE) } else { color };
                }
            }
        }
        match self.bugs.sky.filter(|(_, all)| path.first || *all) {
            Some((color, _)) => color,
            None if self.bugs.bounces.black_sky && !path.first => Color::ZERO,
            None if self.bugs.ambient_sky => self.sky(ray.dir()) + self.world.ambient(),
            None => self.sky(ray.dir()),
        }
    }

    /// Applies the mistakes in positions and normals to an interaction.
    fn met(&self, mut at: SurfaceInteraction, t: f32) -> SurfaceInteraction {
        let (bugs, object) = (self.bugs, &self.world.objects()[at.hit.object as usize]);
        let SurfaceInteraction { ray, hit, surface, .. } = &mut at;
        if t != hit.t {
            (surface.position, surface.rounding_error) = (ray.rounded.at(t), Vec3::ZERO);
        }
        if let (Geometry::Mesh(tree), true) = (&object.geometry, bugs.unnormalized_mesh_normals)
            && let Some(mixed) = tree.mesh.interpolated_normal(hit.part, hit.uv)
        {
            // Only the length of the interpolated normal is needed, and rotations and uniform
            // scales preserve it.
            surface.n_shade *= mixed.length();
        }
        if let (Geometry::Mesh(tree), true) = (&object.geometry, bugs.normal_permutation > 0) {
            let [_, u, v] = permuted(bugs.normal_permutation, hit.uv);
            if let Some(mixed) = tree.mesh.interpolated_normal(hit.part, Vec2::new(u, v)) {
                let world = object.to_world.as_ref().map_or(mixed, |to_world| to_world.unnormalized_normal(mixed));
                surface.n_shade = world.normalize_or(surface.n_shade);
            }
        }
        if bugs.flat {
            surface.n_shade = surface.n_geo;
        }
        if let (Some(area), true) = (triangle_area(object, hit.part), bugs.long_triangles) {
            surface.n_shade *= 2.0 * area;
        }
        if let (Some(to_world), true) = (&object.to_world, bugs.normals != Normals::Correct) {
            let local = to_world.inverse_normal(surface.n_shade);
            surface.n_shade = match bugs.normals {
                Normals::Correct => surface.n_shade,
                Normals::Local => local,
                Normals::Long => to_world.unnormalized_normal(local),
                Normals::ByInverse => to_world.inverse_ray(&Ray::new(Vec3::ZERO, local)).dir.normalize_or(local),
                Normals::Transposed => to_world.inverse_normal(local),
                Normals::LongMoved => to_world.vector(local),
                Normals::MovedPoint => object.world_point(local - object.center).normalize_or(surface.n_shade),
                Normals::MovedTwice => {
                    let long = to_world.unnormalized_normal(local);
                    object.world_point(long - object.center).normalize_or(surface.n_shade)
                }
            };
        }
        if let (Geometry::Mesh(tree), true) = (&object.geometry, bugs.colors.uv_permutation > 0)
            && let Some([a, b, c]) = tree.mesh.corner_uvs(hit.part)
        {
            let [u, v, w] = permuted(bugs.colors.uv_permutation, hit.uv);
            surface.uv = (u * a + v * b + w * c).into();
        }
        if let (Geometry::Primitive(Primitive::Sphere(sphere)), ball) = (&object.geometry, bugs.sphere_normals)
            && ball != SphereNormal::Correct
        {
            let to_world = object.to_world.as_ref();
            let local = to_world.map_or(surface.position, |to_world| to_world.inverse_point(surface.position));
            surface.n_shade = match (ball, to_world) {
                (SphereNormal::Position, Some(to_world)) => {
                    to_world.normal((local + object.center).normalize_or_zero())
                }
                (SphereNormal::Position, None) => (local + object.center).normalize_or_zero(),
                (_, Some(_)) => surface.n_shade,
                (SphereNormal::OverSquare, None) => surface.n_shade / sphere.radius,
                (_, None) => surface.n_shade * sphere.radius,
            };
        }
        let is_turned = match course_shape(&object.geometry) {
            Some(CourseShape::Mesh | CourseShape::Triangle) => bugs.triangles_turned,
            Some(CourseShape::Sphere) => bugs.spheres_turned,
            Some(CourseShape::Plane) => bugs.planes_turned,
            None => false,
        };
        if is_turned {
            (surface.n_shade, surface.n_geo) = (-surface.n_shade, -surface.n_geo);
        }
        at
    }

    /// Returns true if a ray hits the back of a surface.
    fn sees_back(&self, at: &SurfaceInteraction) -> bool {
        if self.bugs.one_normal { at.ray.dir().dot(at.surface.n_shade) > 0.0 } else { self.right.sees_back(at) }
    }

    fn shade(&self, at: &SurfaceInteraction, transition: Option<MediumTransition>, path: RayState) -> Color {
        let (world, bugs) = (self.world, self.bugs);
        let SurfaceInteraction { ray, surface, .. } = at;
        let from_behind = self.sees_back(at);
        let black = from_behind && !self.settings.shade_back && world.shading_rules().black_backs;
        let turned = from_behind && (self.settings.shade_back || bugs.faced);
        let n = if turned { -surface.n_shade } else { surface.n_shade };
        let n = if world.shading_rules().unit_light && !bugs.long_triangles { n.normalize_or(n) } else { n };
        if world.shading_rules().spoiled_normals && n.is_nan() {
            return Color::ZERO;
        }
        let parts = self.materials_at(at);
        let (mut color, mut blocked) = (Color::ZERO, false);
        let pose = world.camera().pose();
        let view = match bugs.highlights {
            HighlightBugs { along_axis: true, .. } => pose.direction.normalize_or(ray.dir()),
            HighlightBugs { from_eye: true, .. } => (surface.position - pose.center).normalize_or(ray.dir()),
            _ => ray.dir(),
        };
        if bugs.unlit {
            color = parts.iter().map(|part| part.share * self.diffuse_color(part.phong, at)).sum();
        } else if !black || bugs.faced {
            let diffuse: SmallVec<[Color; 2]> = parts.iter().map(|p| self.diffuse_color(p.phong, at)).collect();
            let rounds = match bugs.ambient {
                _ if bugs.bounces.no_ambient && !path.first => 0,
                Ambient::EachLight => world.lights().len(),
                _ => 1,
            };
            let mut ambient_seen = Color::ZERO;
            for (part, &diffuse) in parts.iter().zip(&diffuse) {
                let met = part.phong.ambient.unwrap_or(diffuse);
                let met = if bugs.ambient == Ambient::Bare { Color::ONE } else { met };
                for _ in 0..rounds {
                    let ambient = part.share * world.ambient();
                    color += ambient * met;
                    ambient_seen += ambient * met;
                }
            }
            let mut any = world.lights().is_empty();
            let mut greatest = Color::ZERO;
            for (number, light) in world.lights().iter().enumerate() {
                let li = self.illuminated(light, surface.point(), at.hit.t);
                let casts = bugs.shadows.only_light.is_none_or(|only| only == number);
                let visible = if casts { self.visible(surface, number, &li, path.first) } else { Color::ONE };
                let visible = if bugs.shadows.later_too && blocked { Color::ZERO } else { visible };
                blocked |= visible == Color::ZERO;
                let visible = visible.max(Color::splat(bugs.shadows.remaining_light));
                let visible = if bugs.shadows.inverted { Color::ONE - visible } else { visible };
                any |= visible != Color::ZERO;
                let replaced = bugs.sum == LightSum::LastUnoccluded && visible != Color::ZERO;
                if bugs.sum == LightSum::LastOnly || replaced {
                    color = ambient_seen;
                }
                let before = color;
                for (part, &diffuse) in parts.iter().zip(&diffuse) {
                    let highlight = part.phong.highlight.filter(|_| path.first || !bugs.highlights.first_only);
                    let direct = |diffuse| self.direct(highlight, diffuse, n, view, light, &li);
                    if bugs.shadows.diffuse_left && visible != Color::ONE {
                        color += part.share * (Color::ONE - visible) * (direct(diffuse) - direct(Color::ZERO));
                    }
                    if visible != Color::ZERO {
                        let light = part.share * visible * direct(diffuse);
                        let alone = bugs.sum == LightSum::ClampedLight;
                        color += if alone { light.clamp(Color::ZERO, Color::ONE) } else { light };
                    }
                    if bugs.shadows.highlights_left && visible != Color::ONE {
                        color += part.share * (Color::ONE - visible) * direct(Color::ZERO);
                    }
                }
                if matches!(bugs.sum, LightSum::Greatest | LightSum::GreatestOfAll) {
                    greatest = greatest.max(color - before);
                    color = before;
                }
                if bugs.sum == LightSum::ClampedEach {
                    color = color.clamp(Color::ZERO, Color::ONE);
                }
            }
            match bugs.sum {
                LightSum::Greatest => color += greatest,
                LightSum::GreatestOfAll => color = color.max(greatest),
                _ => {}
            }
            if bugs.shadows.ambient_too && !any || bugs.shadows.ambient_of_any && blocked {
                color -= ambient_seen;
            }
        }
        if bugs.sum == LightSum::ClampedLocal {
            color = color.clamp(Color::ZERO, Color::ONE);
        }
        match bugs.shadows.black {
            Some(true) if blocked => return Color::ZERO,
            Some(false) if blocked => color = Color::ZERO,
            _ => {}
        }
        if bugs.bounces.instead && path.bounces > 0 && SpecularBlend::of(&parts).reflective != Color::ZERO {
            color = Color::ZERO;
        }
        if bugs.bounces.mixed && path.bounces > 0 {
            color *= Color::ONE - SpecularBlend::of(&parts).reflective;
        }
        if bugs.bounces.glass_mixed.is_some() && path.bounces > 0 {
            color *= Color::ONE - SpecularBlend::of(&parts).transparent;
        }
        if path.bounces > 0 {
            let rounds = if bugs.bounces.each_light { world.lights().len() } else { 1 };
            let secondary = self.secondary(at, &parts, transition.unwrap_or_default(), path);
            if bugs.bounces.total == TotalReflection::Black && secondary.is_nan() {
                return Color::ZERO;
            }
            for _ in 0..rounds {
                color += secondary;
            }
        }
        color
    }

    /// Returns, for each channel, the fraction of a light that reaches a surface. It is 0 in full
    /// shadow.
    fn visible(&self, surface: &SurfacePoint, light: usize, li: &LightLiSample, first: bool) -> Color {
        let bugs = self.bugs.shadows;
        let unshadowed = self.bugs.bounces.unshadowed && !first;
        if !self.settings.shadows || unshadowed || li.color == Color::ZERO {
            return Color::ONE;
        }
        let blocked = bugs.blocked_lights[usize::from(!first)];
        if blocked.checked_shr(light as u32).is_some_and(|rest| rest & 1 == 1) {
            return Color::ZERO;
        }
        let rules = self.world.shading_rules();
        let way = rules.epsilon.and_then(|_| self.world.course_light_direction(light, surface.position));
        let li = match way {
            Some((to_light, distance)) => &LightLiSample { to_light, distance, color: li.color },
            None => li,
        };
        let reach = match (bugs.endless, rules.epsilon.is_some()) {
            (true, _) => f32::INFINITY,
            (false, true) => li.distance,
            (false, false) => li.distance * (1.0 - gamma(16)),
        };
        let reach = match bugs.ray_end {
            _ if li.distance.is_infinite() => reach,
            ShadowRayEnd::Correct => reach,
            ShadowRayEnd::One => 1.0,
            ShadowRayEnd::Squared => li.distance * li.distance,
        };
        let reach = if bugs.short && li.distance.is_infinite() { 1.0 } else { reach };
        let epsilon = bugs.epsilon.map(Epsilon::MinT).or(rules.epsilon);
        let way = match bugs.direction {
            ShadowDirection::Light => li.to_light,
            ShadowDirection::Away => -li.to_light,
            ShadowDirection::Normal => surface.n_shade,
        };
        let mut start = *surface;
        if self.bugs.one_normal {
            // The wrong normal says nothing about the side on which the ray starts.
            start.n_shade = start.n_geo;
        }
        let mut ray = to_light(&start, way, reach, epsilon);
        if bugs.from_eye {
            let eye = self.world.camera().pose().center;
            ray = Ray { t_min: 1e-4, t_max: reach, ..Ray::new(eye, way) }.into();
        }
        if let Some(world) = self.shadow_world {
            return if world.occluded(&ray, &mut ()) { Color::ZERO } else { Color::ONE };
        }
        if bugs.no_glass {
            return self.visible_through_glass(ray, epsilon);
        }
        if rules.shadow_fronts {
            let nearest = self.closest(&ray).map(|(hit, _)| self.world.interaction(ray, hit));
            let blocked = nearest.is_some_and(|blocker| blocker.surface.n_shade.dot(ray.dir()) <= 0.0);
            return if blocked { Color::ZERO } else { Color::ONE };
        }
        if !self.settings.transparent_shadows {
            return if self.occluded(&ray) { Color::ZERO } else { Color::ONE };
        }
        let mut share = Color::ONE;
        for _ in 0..64 {
            let Some((hit, _)) = self.closest(&ray) else { return share };
            let blocker = self.world.interaction(ray, hit);
            let parts = self.materials_at(&blocker);
            share *= parts.iter().map(|part| part.share * part.phong.transparent).sum::<Color>();
            if share == Color::ZERO {
                break;
            }
            ray = spawn_ray(&blocker.surface, li.to_light, ray.rounded.t_max - hit.t, epsilon);
        }
        Color::ZERO
    }

    /// Returns 1 if all objects along the ray are transparent, and 0 otherwise.
    fn visible_through_glass(&self, mut ray: Ray64, epsilon: Option<Epsilon>) -> Color {
        for _ in 0..64 {
            let Some((hit, _)) = self.closest(&ray) else { return Color::ONE };
            let blocker = self.world.interaction(ray, hit);
            let parts = self.materials_at(&blocker);
            if parts.iter().all(|part| part.phong.transparent == Color::ZERO) {
                return Color::ZERO;
            }
            ray = spawn_ray(&blocker.surface, ray.dir(), ray.rounded.t_max - hit.t, epsilon);
        }
        Color::ZERO
    }

    /// Returns the reflected and transmitted light.
    fn secondary(
        &self,
        at: &SurfaceInteraction,
        parts: &[WeightedMaterial],
        transition: MediumTransition,
        path: RayState,
    ) -> Color {
        let bugs = self.bugs.bounces;
        let SpecularBlend { mut reflective, mut transparent, ior, fresnel } = SpecularBlend::of(parts);
        if reflective == Color::ZERO && transparent == Color::ZERO {
            return Color::ZERO;
        }
        let opaque = Color::ONE - transparent;
        let SurfaceInteraction { ray, surface, .. } = at;
        let leaving = self.sees_back(at);
        let [n, n_geo] = [surface.n_shade, surface.n_geo].map(|n| if leaving { -n } else { n });
        let n = if ray.dir().dot(n) < 0.0 { n } else { n_geo };
        let MediumTransition { ior_front, ior_behind, behind, .. } = transition;
        let eta = match bugs.glass {
            Glass::Correct
            | Glass::Straight
            | Glass::StraightUnlessTotal
            | Glass::Outward
            | Glass::RootAdded
            | Glass::SignChanged
            | Glass::NoRoot
            | Glass::Unsquared => ior_front / ior_behind,
            Glass::Inverted | Glass::Exchanged => ior_behind / ior_front,
            Glass::IndicesNotSwapped => 1.0 / ior,
        };
        let mirrored = mirrored(ray.dir(), n, bugs.mirror);
        let rules = self.world.shading_rules();
        let mirrored = if rules.raw_normals && !rules.long_mirrors { mirrored.normalize_or(n_geo) } else { mirrored };
        let n = if rules.raw_normals && !rules.raw_refraction { n.normalize_or(n_geo) } else { n };
        let bent = match (transparent == Color::ZERO, bugs.glass) {
            (true, _) => None,
            (false, Glass::Straight) => Some(ray.dir()),
            (false, Glass::StraightUnlessTotal) => refract(ray.dir(), n, eta).map(|_| ray.dir()),
            (false, Glass::RootAdded) => refract(ray.dir(), n, eta).map(|t| t - 2.0 * t.dot(n) * n),
            (false, Glass::Outward) if leaving => refract(ray.dir(), n, eta).map(|t| t - 2.0 * t.dot(n) * n),
            (false, Glass::SignChanged | Glass::NoRoot | Glass::Unsquared) => {
                let c = -ray.dir().dot(n);
                let squared = if bugs.glass == Glass::Unsquared { eta } else { eta * eta };
                let k = 1.0 - squared * (1.0 - c * c);
                let root = if bugs.glass == Glass::NoRoot { k } else { k.max(0.0).sqrt() };
                let along = eta * c - root;
                let along = if bugs.glass == Glass::SignChanged { -along } else { along };
                (k >= 0.0).then_some(eta * ray.dir() + along * n)
            }
            (false, _) => refract(ray.dir(), n, eta),
        };
        let is_total = bent.is_none() && transparent != Color::ZERO;
        let transmitted = match bugs.total {
            TotalReflection::Clamped if is_total => Some(eta * (ray.dir() - ray.dir().dot(n) * n)),
            TotalReflection::Mirrored if is_total => Some(mirrored),
            TotalReflection::Straight if is_total => Some(ray.dir()),
            TotalReflection::Absolute if is_total => {
                let c = -ray.dir().dot(n);
                let root = (1.0 - eta * eta * (1.0 - c * c)).abs().sqrt();
                Some(eta * ray.dir() + (eta * c - root) * n)
            }
            TotalReflection::NotANumber | TotalReflection::Black if is_total => return Color::NAN,
            _ => bent,
        };
        let transmitted = match rules.raw_refraction {
            true => transmitted.map(|through| through.normalize_or(ray.dir())),
            false => transmitted,
        };
        let divided = fresnel && self.settings.reflection && self.settings.refraction;
        if divided && bugs.fresnel != Fresnel::None {
            let ratio = (ior_behind - ior_front) / (ior_behind + ior_front);
            let schlick = |t| match bugs.fresnel {
                Fresnel::Constant => ratio * ratio,
                Fresnel::Share(share) => share,
                Fresnel::Unsquared | Fresnel::Power(_) => {
                    let slow = if ior_behind < ior_front { t } else { ray.dir() };
                    let rest = 1.0 - slow.dot(n).abs();
                    let r0 = if bugs.fresnel == Fresnel::Unsquared { ratio.abs() } else { ratio * ratio };
                    let power = if let Fresnel::Power(power) = bugs.fresnel { power } else { 5.0 };
                    r0 + (1.0 - r0) * fp::pow(rest.max(0.0), power)
                }
                Fresnel::Incoming => {
                    let rest = 1.0 - ray.dir().dot(n).abs();
                    let r0 = ratio * ratio;
                    r0 + (1.0 - r0) * rest * rest * rest * rest * rest
                }
                _ => {
                    let indices =
                        if bugs.glass == Glass::Exchanged { (ior_behind, ior_front) } else { (ior_front, ior_behind) };
                    let before = if rules.exit_r0 { 1.0 } else { indices.0 };
                    fresnel_share(ray.dir(), n, t, indices, before)
                }
            };
            let lost = bugs.total == TotalReflection::Lost && is_total;
            let r = if lost { schlick(ray.dir()) } else { transmitted.map_or(1.0, schlick) };
            let r = if bugs.fresnel == Fresnel::Exchanged { 1.0 - r } else { r };
            reflective *= r;
            transparent *= 1.0 - r;
        }
        let mut color = Color::ZERO;
        if self.settings.reflection && !bugs.no_mirror {
            let full = bugs.mirror_in_full && reflective != Color::ZERO;
            let weight = if full { Color::ONE } else { reflective };
            let weight = match bugs.times_diffuse {
                true => weight * parts.iter().map(|p| p.share * self.diffuse_color(p.phong, at)).sum::<Color>(),
                false => weight,
            };
            let mut start = match bugs.from_eye {
                true => {
                    SurfacePoint { position: self.world.camera().pose().center, rounding_error: Vec3::ZERO, ..*surface }
                }
                false => *surface,
            };
            // A ray along a surface does not hit it, except by rounding.
            let height = if bugs.mirror == Mirror::Along { FRONT } else { bugs.mirror_height };
            if height != 0.0 {
                start.position += height * n;
            }
            color += self.bounce(&start, mirrored, weight, path.clone());
            if bugs.glass_mixed == Some(true) {
                color *= opaque;
            }
        }
        if let Some(transmitted) = transmitted.filter(|_| self.settings.refraction && !bugs.no_glass) {
            let weight = if bugs.glass_in_full { Color::ONE } else { transparent };
            let (mut start, mut media) = (*surface, behind);
            if bugs.glass_in_front {
                // The ray enters the same surface again, whatever the distance.
                let ignored = if let Some(Epsilon::MinT(t_min)) = rules.epsilon { t_min } else { 0.0 };
                start.position += FRONT.max(2.0 * ignored) * n;
                media = path.media.clone();
            }
            color += self.bounce(&start, transmitted, weight, RayState { media, ..path });
        }
        color
    }

    fn bounce(&self, surface: &SurfacePoint, dir: Vec3, weight: Color, path: RayState) -> Color {
        if weight.max_element() <= 0.0 {
            return Color::ZERO;
        }
        let total = self.right.weight_after(path.weight, weight);
        if total < self.settings.min_weight {
            return Color::ZERO;
        }
        let epsilon = self.bugs.bounces.epsilon.map(Epsilon::MinT).or(self.world.shading_rules().epsilon);
        let dir = if self.bugs.bounces.unit { dir.normalize_or(dir) } else { dir };
        let ray = spawn_ray(surface, dir, f32::INFINITY, epsilon);
        weight * self.trace(&ray, RayState { bounces: path.bounces - 1, weight: total, first: false, ..path })
    }
}

/// Returns the weights of a triangle's vertices in a wrong order. The order 0 is correct.
fn permuted(order: usize, uv: Vec2) -> [f32; 3] {
    const ORDERS: [[usize; 3]; 6] = [[0, 1, 2], [1, 2, 0], [2, 0, 1], [1, 0, 2], [0, 2, 1], [2, 1, 0]];
    let weights = [1.0 - uv.x - uv.y, uv.x, uv.y];
    ORDERS[order.min(5)].map(|i| weights[i])
}

/// Returns the direction of a reflected ray, computed either correctly or with a mistake.
fn mirrored(d: Vec3, n: Vec3, how: Mirror) -> Vec3 {
    match how {
        Mirror::Correct => reflect(d, n),
        Mirror::Negated => -reflect(d, n),
        Mirror::Along => d - d.dot(n) * n,
        Mirror::Plus => d + 2.0 * d.dot(n) * n,
        Mirror::Multiple(factor) => d - f32::from(factor) * d.dot(n) * n,
        Mirror::Normal => n,
    }
}

/// Returns the area of a flat triangle in an object without a transform.
fn triangle_area(object: &Object, part: u32) -> Option<f32> {
    let [a, b, c] = match &object.geometry {
        _ if object.to_world.is_some() => return None,
        Geometry::Mesh(tree) if tree.mesh.is_flat() => tree.mesh.corners(part),
        Geometry::Primitive(Primitive::Triangle(triangle)) => triangle.corners(),
        _ => return None,
    };
    Some(0.5 * (b - a).cross(c - a).length())
}
