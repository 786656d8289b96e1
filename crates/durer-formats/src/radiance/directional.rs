//! Converts surfaces with a directional distribution to point lights.

use super::converted::{ConvertedModifier, Kind};
use super::outline::Outline;
use super::spread::Spread;
use super::state::Reader;
use durer_diag::Span;
use durer_scene::describe::FileName;
use durer_scene::light::photometric::PhotometricLight;
use glam::DVec3;
use std::rc::Rc;

/// Number of point lights for each surface.
const POINTS: u32 = 16;

/// Maximum number of different light profiles.
const MOST_PROFILES: usize = 256;

impl Reader<'_> {
    /// Replaces a surface with point lights spread over it, since area lights in Dürer have no
    /// directional distribution.
    pub fn point_lights(&mut self, made: &ConvertedModifier, outline: &Outline, span: Span) {
        let Kind::Aimed { radiance, spread, at } = &made.kind else { return };
        let [down, front] = spread.axes();
        let Some(file) = self.profile(spread, outline, span) else { return };
        let places = outline.places(POINTS);
        let what = "an emitter with a directional distribution becomes point lights and is not visible";
        self.report.once(*at, what);
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

    /// Returns the name of the light profile for a distribution on a surface. Surfaces with the
    /// same orientation share a profile.
    fn profile(&mut self, spread: &Rc<Spread>, outline: &Outline, span: Span) -> Option<FileName> {
        let facing = outline.facing();
        let known = self.profiles.iter().position(|(own, axis)| Rc::ptr_eq(own, spread) && *axis == facing);
        let number = known.unwrap_or(self.profiles.len());
        let path = format!("lamp-{}.ies", number + 1);
        if known.is_none() {
            if self.profiles.len() >= MOST_PROFILES {
                let message =
                    format!("more than {MOST_PROFILES} directional distributions of emitters: the rest are left out");
                self.report.warn_once("too-many-lamps", span, message);
                return None;
            }
            let profile = spread.profile(|dir: DVec3| facing.shows(dir));
            self.scene.assets.profiles.insert(path.clone(), profile.into());
            self.profiles.push((spread.clone(), facing));
        }
        Some(FileName { path, span })
    }
}
