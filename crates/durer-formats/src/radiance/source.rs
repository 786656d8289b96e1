//! Converts sources, which emit light from infinitely far away.

use super::args::RadPrimitive;
use super::context::PrimitiveContext;
use super::converted::{DistantSource, MaterialKind};
use super::sky::Sky;
use super::state::Reader;
use crate::panorama;
use crate::pictures::picture_error;
use durer_diag::Span;
use durer_scene::light::{DirectionalLight, Light};
use durer_scene::math::{Vec3, fp};
use durer_scene::scene::Spanned;
use glam::DVec3;

/// Maximum angular diameter in degrees at which a source becomes a directional light, as the sun
/// does.
const MAX_SUN_ANGLE: f32 = 5.0;
/// Height in pixels of the environment map.
const ROWS: u32 = 256;

impl Reader<'_> {
    /// Converts a `source`, which emits light from infinitely far away.
    pub fn source(&mut self, primitive: &RadPrimitive, modifier: Option<usize>, place: &PrimitiveContext) {
        let at = primitive.at();
        if !primitive.has(&[4], self.report) {
            return;
        }
        let direction = place.map.transform_vector3(primitive.point(0)).normalize_or_zero();
        let degrees = primitive.numbers[3].abs() as f32;
        if direction == DVec3::ZERO || degrees == 0.0 || degrees > 360.0 {
            return self.report.error(
                at,
                "a source needs a direction other than 0 0 0, and an angle of more than 0 and at most 360 degrees",
            );
        }
        let Some(converted) = modifier.map(|modifier| self.convert(modifier)) else { return };
        let (radiance, sky) = match &converted.kind {
            MaterialKind::Emitter { radiance } => (*radiance, converted.patterns.sky.clone()),
            // Treat all light of the source as coming from one direction.
            MaterialKind::DirectionalEmitter { radiance, spread, .. } => {
                (*radiance * spread.at(-direction, 1.0) as f32, None)
            }
            _ => return self.report.unsupported_once(at, "a source without emission is left out"),
        };
        let cosine = fp::sin_cos_degrees(0.5 * f64::from(degrees)).1;
        if degrees <= MAX_SUN_ANGLE && sky.is_none() {
            // The colour is the radiance that is reflected by a white matte surface facing the
            // source.
            let color = radiance * (2.0 * (1.0 - cosine)) as f32;
            let spread = Some(0.5 * degrees);
            let light =
                DirectionalLight { direction: -direction.as_vec3(), color, spread, ..DirectionalLight::default() };
            self.light(light.into(), at);
            return;
        }
        self.distant.push(DistantSource { direction, cosine, radiance, sky, at });
    }

    /// Adds a light to the scene.
    pub fn light(&mut self, value: Light, span: Span) {
        self.scene.lights.get_or_insert_default().push(Spanned { value, span });
    }

    /// Combines all sources that have not become directional lights into an environment map.
    pub fn surround(&mut self) {
        (self.scene.background.color, self.scene.background.ambient_light) = (Vec3::ZERO, Vec3::ZERO);
        let Some(at) = self.distant.first().map(|distant| distant.at) else { return };
        let distant = std::mem::take(&mut self.distant);
        // A black environment map adds nothing to the black background.
        if distant.iter().all(|source| source.radiance == Vec3::ZERO || source.sky.as_ref().is_some_and(Sky::is_black))
        {
            return;
        }
        let light = |dir: DVec3| {
            let source = distant.iter().find(|distant| dir.dot(distant.direction) >= distant.cosine);
            source.map_or(Vec3::ZERO, |source| source.radiance * source.sky.as_ref().map_or(1.0, |sky| sky.at(dir)))
        };
        let (name, memory) = (self.input.name, self.input.memory);
        if let Err(error) = panorama::set_environment(&mut self.scene, (name, at), ROWS, memory, light) {
            self.report.push(picture_error(name, &error).at(at));
        }
    }
}
