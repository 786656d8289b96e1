//! Bound on the light of emitters that light sampling misses, for honest error estimates.

use super::{Direct, Path};
use crate::world::emitters::emitter_of;
use crate::world::{Material, Phong};
use durer_scene::material::Pattern as _;
use durer_scene::math::Color;
use std::f32::consts::PI;

impl Path<'_> {
    /// Maximum contribution of one irradiance sample from light that samples rarely find: emitters
    /// with a picture or partial opacity, solids, and infinite shapes; all emissive surfaces if
    /// something mirrors or refracts and no photons are sent; and the dimmest part of the
    /// environment with light sampling alone. `brightness` weights colours.
    pub fn most_by_chance(&self, brightness: impl Fn(Color) -> f32) -> f32 {
        let shows = |phong: &Phong| phong.reflective != Color::ZERO || phong.transparent != Color::ZERO;
        let mut phongs = self.world.materials().iter().filter_map(|material| match material {
            Material::Phong(phong) => Some(phong),
            Material::Solid(..) => None,
        });
        let mirrored = self.photons.is_none() && phongs.any(shows);
        let by_chance = self.world.objects().iter().filter(|object| {
            let is_chosen =
                self.world.emits_on_both_sides(object.material).is_some() && emitter_of(object, 0).is_some();
            mirrored || !is_chosen
        });
        let brightest = by_chance.map(|object| self.brightest(object.material, &brightness)).fold(0.0, f32::max);
        let sky = match self.transport.direct {
            Direct::Lights | Direct::Middle => {
                self.world.environment().map_or(0.0, |sky| brightness(sky.most_of_one()))
            }
            Direct::Both | Direct::Bsdf => 0.0,
        };
        // Directions are sampled by their cosine, so a hit counts pi times.
        sky.max(PI * brightest)
    }

    fn brightest(&self, material: u32, brightness: &impl Fn(Color) -> f32) -> f32 {
        match &self.world.materials()[material as usize] {
            Material::Phong(phong) => phong.emission.as_ref().map_or(0.0, |emission| brightness(emission.radiance)),
            Material::Solid(solid, ..) => {
                solid.materials().map(|part| self.brightest(part, brightness)).into_iter().fold(0.0, f32::max)
            }
        }
    }
}
