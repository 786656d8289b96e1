//! Media: what light goes through, and may be absorbed and scattered in.

mod fog;
pub mod grid;
pub mod phase;
#[cfg(test)]
mod tests;

use crate::math::{Aabb, Affine, Color, Ray64, Vec3, fp};
use crate::spectrum::{Lanes, Spectrum};
pub use fog::Fog;
use glam::DVec3;
pub use grid::DensityGrid;
pub use phase::HenyeyGreenstein;
use std::sync::Arc;

/// What fills a body, or the air.
#[derive(Clone, Debug, PartialEq)]
pub struct Medium {
    /// How much light loses by absorption and scattering, per unit of the world and by colour,
    /// where the density is 1.
    pub extinction: Color,
    /// The share of that which is scattered.
    pub albedo: Color,
    /// Into which directions.
    pub phase: HenyeyGreenstein,
    /// Where it is, and how dense; `None`: everywhere alike.
    pub place: Option<Place>,
}

/// Where a medium is.
#[derive(Clone, Debug, PartialEq)]
pub struct Place {
    /// In this box and nowhere else.
    pub bounds: Aabb,
    /// How the box lies in the world; `None`: as it is.
    pub placed: Option<Affine>,
    /// How dense it is there; `None`: the same everywhere.
    pub density: Option<Arc<DensityGrid>>,
}

impl Place {
    /// How dense it is at a point of the world.
    fn density(&self, grid: &DensityGrid, point: Vec3) -> f32 {
        let own = self.placed.as_ref().map_or(point, |placed| placed.inverse_point(point));
        grid.at(&self.bounds, own)
    }
}

/// What became of light on a straight way.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum Flight {
    /// It got through; this is left of it.
    Passed(Spectrum),
    /// It was scattered at this distance; this is left of it.
    Scattered(f32, Spectrum),
}

/// A straight way.
#[derive(Clone, Copy, Debug)]
pub struct Way {
    /// Where it begins.
    pub origin: DVec3,
    /// Unit vector.
    pub dir: Vec3,
    /// Its part: from how far to how far, which may be infinite.
    pub from: f32,
    /// The end of the part.
    pub to: f32,
}

impl Way {
    fn point(&self, distance: f32) -> Vec3 {
        (self.origin + f64::from(distance) * self.dir.as_dvec3()).as_vec3()
    }
}

/// Most steps through a grid: one that is far denser somewhere than elsewhere takes many.
const MAX_STEPS: u32 = 1 << 16;

impl Medium {
    /// Whether light is scattered, and not only absorbed.
    pub fn scatters(&self) -> bool {
        self.albedo.max_element() > 0.0
    }

    /// The part of a way that lies in it.
    fn clipped(&self, way: &Way) -> Option<(f32, f32)> {
        let Some(place) = &self.place else { return Some((way.from, way.to)) };
        let (origin, dir) = match &place.placed {
            Some(placed) => {
                let ray = placed.inverse_ray(Ray64::new(way.origin, way.dir, 0.0, f32::INFINITY));
                (ray.origin, ray.dir)
            }
            None => (way.origin.as_vec3(), way.dir),
        };
        let (enter, leave) = place.bounds.clip(origin, dir)?;
        let (from, to) = (way.from.max(enter), way.to.min(leave));
        (from < to).then_some((from, to))
    }

    fn grid(&self) -> Option<(&DensityGrid, &Place)> {
        let place = self.place.as_ref()?;
        Some((place.density.as_deref()?, place))
    }

    /// How much light is scattered at a point, per unit of the world.
    pub fn scattering(&self, point: DVec3, lanes: &Lanes) -> Spectrum {
        let density = self.grid().map_or(1.0, |(grid, place)| place.density(grid, point.as_vec3()));
        lanes.coefficient(self.extinction) * lanes.reflectance(self.albedo) * density
    }

    /// The share of light that gets through a way.
    ///
    /// Source of ratio tracking: Novák, Selle and Jarosz, *Residual Ratio Tracking*, 2014.
    pub fn transmittance(&self, way: &Way, lanes: &Lanes, numbers: &mut dyn FnMut() -> f32) -> Spectrum {
        let Some((from, to)) = self.clipped(way) else { return Spectrum::ONE };
        let extinction = lanes.coefficient(self.extinction);
        let Some((grid, place)) = self.grid() else { return absorbed(extinction, to - from) };
        let most = extinction.max_element() * grid.most();
        let (mut at, mut left) = (from, Spectrum::ONE);
        for _ in 0..MAX_STEPS {
            let Some(next) = collision(at, to, most, numbers) else { break };
            at = next;
            left *= Spectrum::ONE - extinction * (place.density(grid, way.point(at)) / most);
            // What hardly counts ends at random, and the rest makes up for it.
            if left.max_element() < 0.1 {
                if numbers() < 0.5 {
                    return Spectrum::ZERO;
                }
                left *= 2.0;
            }
        }
        left
    }

    /// Whether light with these weights gets through a way, or where it is scattered. What it is
    /// multiplied by has the probability of that worked in.
    pub fn flight(&self, way: &Way, weights: Spectrum, lanes: &Lanes, numbers: &mut dyn FnMut() -> f32) -> Flight {
        let Some((from, to)) = self.clipped(way) else { return Flight::Passed(Spectrum::ONE) };
        let extinction = lanes.coefficient(self.extinction);
        if !self.scatters() && self.grid().is_none() {
            return Flight::Passed(absorbed(extinction, to - from));
        }
        let albedo = lanes.reflectance(self.albedo);
        match self.grid() {
            Some((grid, place)) => {
                // Null collisions fill it up to its greatest density, and lanes are weighed as they
                // count by then.
                // Sources: Woodcock and others, 1965; Kutz and others, *Spectral and Decomposition
                // Tracking*, 2017.
                let most = extinction.max_element() * grid.most();
                let (mut at, mut left) = (from, Spectrum::ONE);
                for _ in 0..MAX_STEPS {
                    let Some(next) = collision(at, to, most, numbers) else { break };
                    at = next;
                    let here = extinction * (place.density(grid, way.point(at)) / most);
                    let real = (shares(weights * left) * here).element_sum();
                    if numbers() < real {
                        return Flight::Scattered(at, left * albedo * here / real);
                    }
                    left *= (Spectrum::ONE - here) / (1.0 - real);
                }
                Flight::Passed(left)
            }
            None => {
                // One lane chooses the distance; all are weighed by how likely any of them was to
                // choose it.
                let weights = shares(weights);
                let mut choice = numbers();
                let lane = (0..3).find(|&lane| {
                    choice -= weights[lane];
                    choice < 0.0
                });
                let chosen = extinction[lane.unwrap_or(3)];
                let distance = if chosen > 0.0 { -fp::ln(1.0 - numbers()) / chosen } else { f32::INFINITY };
                if distance < to - from {
                    let left = absorbed(extinction, distance);
                    let density = (weights * extinction * left).element_sum();
                    return Flight::Scattered(from + distance, albedo * extinction * left / density);
                }
                let left = absorbed(extinction, to - from);
                Flight::Passed(left / (weights * left).element_sum().max(f32::MIN_POSITIVE))
            }
        }
    }
}

/// Where light next meets something on its way, were the medium as dense as at its densest
/// everywhere.
fn collision(at: f32, to: f32, most: f32, numbers: &mut dyn FnMut() -> f32) -> Option<f32> {
    let next = at - fp::ln(1.0 - numbers()) / most;
    (next < to).then_some(next)
}

/// How much each lane counts, of 1 in all.
fn shares(weights: Spectrum) -> Spectrum {
    let weights = weights.max(Spectrum::ZERO);
    let sum = weights.element_sum();
    if sum > 0.0 { weights / sum } else { Spectrum::splat(0.25) }
}

/// What a distance leaves of light: Beer's law.
fn absorbed(extinction: Spectrum, distance: f32) -> Spectrum {
    (-extinction * distance.min(f32::MAX)).map(fp::exp)
}
