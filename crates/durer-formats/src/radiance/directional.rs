//! Converts surfaces that have a directional distribution to point lights.

use super::converted::{ConvertedModifier, MaterialKind};
use super::distribution::DirectionalDistribution;
use super::outline::EmitterShape;
use super::state::Reader;
use durer_diag::Span;
use durer_scene::describe::FileName;
use durer_scene::light::photometric::PhotometricLight;
use glam::DVec3;
use std::rc::Rc;

/// Number of point lights that replace each surface.
const POINTS: u32 = 16;

/// Maximum number of different light profiles.
const MAX_PROFILES: usize = 256;

impl Reader<'_> {
    /// Replaces a surface with point lights that are spread over it, because area lights in Dürer
    /// have no directional distribution.
    pub fn point_lights(&mut self, converted: &ConvertedModifier, outline: &EmitterShape, span: Span) {
        let MaterialKind::DirectionalEmitter { radiance, spread, at } = &converted.kind else { return };
        let [down, front] = spread.axes();
        let Some(file) = self.profile(spread, outline, span) else { return };
        let places = outline.points(POINTS);
        let what = "an emitter with a directional distribution becomes point lights and is not visible";
        self.report.unsupported_once(*at, what);
        let color = *radiance * (outline.area() / places.len() as f64) as f32;
        for place in places {
            let light = PhotometricLight {
                position: place.as_vec3(),
                file: file.clone(),
                direction: down.as_vec3(),
                front: front.as_vec3(),
                focal_length: spread.focal_length() as f32,
                color,
                ..PhotometricLight::default()
            };
            self.light(light.into(), span);
        }
    }

    /// Returns the name of the light profile for a surface and a distribution. Surfaces with equal
    /// orientations share a profile.
    fn profile(
        &mut self,
        spread: &Rc<DirectionalDistribution>,
        outline: &EmitterShape,
        span: Span,
    ) -> Option<FileName> {
        let facing = outline.orientation();
        let existing = self.profiles.iter().position(|(own, axis)| Rc::ptr_eq(own, spread) && *axis == facing);
        let number = existing.unwrap_or(self.profiles.len());
        let path = format!("lamp-{}.ies", number + 1);
        if existing.is_none() {
            if self.profiles.len() >= MAX_PROFILES {
                let message =
                    format!("emitters have more than {MAX_PROFILES} directional distributions: the rest are left out");
                self.report.warn_once("too-many-lamps", span, message);
                return None;
            }
            let profile = spread.profile(|dir: DVec3| facing.projected_area(dir));
            self.scene.assets.profiles.insert(path.clone(), profile.into());
            self.profiles.push((spread.clone(), facing));
        }
        Some(FileName { path, span })
    }
}
