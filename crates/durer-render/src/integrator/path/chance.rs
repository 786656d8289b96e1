//! Upper bound on the light that samples find only rarely, used for error estimates.

use super::{DirectSampling, Path};
use crate::world::emitters::emitter_of;
use crate::world::{Material, Phong};
use durer_scene::material::Pattern as _;
use durer_scene::math::Color;
use std::f32::consts::PI;

impl Path<'_> {
    /// Returns the largest contribution that light found only rarely by samples can make to one
    /// irradiance sample. `brightness` maps a colour to a number.
    ///
    /// Such light comes from emitters that light sampling does not choose, which are emitters with
    /// a texture or partial opacity, solids, and infinite shapes. If some material mirrors or
    /// refracts light and no photons are sent, it comes from all emissive surfaces. If only light
    /// sampling is used, it also comes from the dimmest part of the environment.
    pub fn max_rare_contribution(&self, brightness: impl Fn(Color) -> f32) -> f32 {
        let shows = |phong: &Phong| phong.reflective != Color::ZERO || phong.transparent != Color::ZERO;
        let mut phongs = self.world.materials().iter().filter_map(|material| match material {
            Material::Phong(phong) => Some(phong),
            Material::Mix(..) => None,
        });
        let mirrored = self.photons.is_none() && phongs.any(shows);
        let by_chance = self.world.objects().iter().filter(|object| {
            let is_chosen =
                self.world.emits_on_both_sides(object.material).is_some() && emitter_of(object, 0).is_some();
            mirrored || !is_chosen
        });
        let brightest = by_chance.map(|object| self.brightest(object.material, &brightness)).fold(0.0, f32::max);
        let sky = match self.options.direct {
            DirectSampling::Lights | DirectSampling::Center => {
                self.world.environment().map_or(0.0, |sky| brightness(sky.max_weight()))
            }
            DirectSampling::Both | DirectSampling::Bsdf => 0.0,
        };
        // Directions are sampled in proportion to their cosine, so the radiance of a hit is
        // multiplied by pi.
        sky.max(PI * brightest)
    }

    /// Returns the maximum brightness of the light that a material emits.
    fn brightest(&self, material: u32, brightness: &impl Fn(Color) -> f32) -> f32 {
        match &self.world.materials()[material as usize] {
            Material::Phong(phong) => phong.emission.as_ref().map_or(0.0, |emission| brightness(emission.radiance)),
            Material::Mix(solid, ..) => {
                solid.materials().map(|part| self.brightest(part, brightness)).into_iter().fold(0.0, f32::max)
            }
        }
    }
}
