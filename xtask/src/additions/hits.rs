//! White where anything is hit, black elsewhere.

use super::account::Witness;
use crate::math::{Color, Ray, Ray64};
use crate::world::World;

/// The integrator over one world.
#[derive(Clone, Copy, Debug)]
pub struct Hits<'w> {
    /// What is seen.
    pub world: &'w World,
}

impl Hits<'_> {
    /// The colour of one ray.
    pub fn radiance<T: Witness>(&self, ray: &Ray, tally: &mut T) -> Color {
        if self.world.closest(&Ray64::from(ray), tally).is_some() { Color::ONE } else { Color::ZERO }
    }
}
