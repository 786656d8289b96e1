//! Participating media, which absorb and scatter light.

mod fog;
pub mod grid;
pub mod phase;
#[cfg(test)]
mod tests;

use crate::math::{Aabb, Affine, Color, Ray64, Vec3, fp};
use crate::spectrum::{Lanes, Spectrum, lane_sum};
pub use fog::Fog;
use glam::DVec3;
pub use grid::DensityGrid;
pub use phase::HenyeyGreenstein;
use std::sync::Arc;

/// Participating medium, such as fog or smoke, inside a body or around the camera.
#[derive(Clone, Debug, PartialEq)]
pub struct Medium {
    /// Extinction coefficient per unit of length at density 1, for each colour channel.
    pub extinction: Color,
    /// Scattering albedo.
    pub albedo: Color,
    /// Phase function.
    pub phase: HenyeyGreenstein,
    /// Region and density of the medium; `None` for an infinite homogeneous medium.
    pub region: Option<MediumRegion>,
}

/// Region that a bounded medium fills, with its density.
#[derive(Clone, Debug, PartialEq)]
pub struct MediumRegion {
    /// Bounds of the medium.
    pub bounds: Aabb,
    /// Transform from the space of the bounds to world space; `None` for the identity.
    pub to_world: Option<Affine>,
    /// Density grid; `None` for density 1 everywhere.
    pub density: Option<Arc<DensityGrid>>,
}

impl MediumRegion {
    /// Density of a grid at a point in world space.
    fn density(&self, grid: &DensityGrid, point: Vec3) -> f32 {
        let own = self.to_world.as_ref().map_or(point, |placed| placed.inverse_point(point));
        grid.at(&self.bounds, own)
    }
}

/// Result of sampling the distance that light travels in a medium before it is scattered.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum DistanceSample {
    /// The light passed through the segment, and is multiplied by this throughput factor.
    Passed(Spectrum),
    /// The light was scattered at this distance, and is multiplied by this throughput factor.
    Scattered(f32, Spectrum),
}

/// Straight ray segment along which a medium is sampled.
#[derive(Clone, Copy, Debug)]
pub struct Segment {
    /// Point from which distances are measured.
    pub origin: DVec3,
    /// Unit direction.
    pub dir: Vec3,
    /// Distance from the origin to the start of the segment.
    pub from: f32,
    /// Distance from the origin to the end of the segment, which can be infinite.
    pub to: f32,
}

impl Segment {
    fn point(&self, distance: f32) -> Vec3 {
        (self.origin + f64::from(distance) * self.dir.as_dvec3()).as_vec3()
    }
}

/// Maximum number of steps through a grid. Grids with strongly varying density need many steps.
const MAX_STEPS: u32 = 1 << 16;

impl Medium {
    /// True if the medium scatters light, instead of only absorbing it.
    pub fn scatters(&self) -> bool {
        self.albedo.max_element() > 0.0
    }

    /// Part of a segment inside the medium.
    fn clip(&self, segment: &Segment) -> Option<(f32, f32)> {
        let Some(place) = &self.region else { return Some((segment.from, segment.to)) };
        let (origin, dir) = match &place.to_world {
            Some(placed) => {
                let ray = placed.inverse_ray(Ray64::new(segment.origin, segment.dir, 0.0, f32::INFINITY));
                (ray.origin, ray.dir)
            }
            None => (segment.origin.as_vec3(), segment.dir),
        };
        let (enter, leave) = place.bounds.clip(origin, dir)?;
        let (from, to) = (segment.from.max(enter), segment.to.min(leave));
        (from < to).then_some((from, to))
    }

    fn grid(&self) -> Option<(&DensityGrid, &MediumRegion)> {
        let place = self.region.as_ref()?;
        Some((place.density.as_deref()?, place))
    }

    /// Scattering coefficient at a point, per unit of length.
    pub fn scattering(&self, point: DVec3, lanes: &Lanes) -> Spectrum {
        let density = self.grid().map_or(1.0, |(grid, place)| place.density(grid, point.as_vec3()));
        lanes.coefficient(self.extinction) * lanes.reflectance(self.albedo) * density
    }

    /// Transmittance along a segment.
    ///
    /// Ratio tracking is described by Novák, Selle and Jarosz, *Residual Ratio Tracking*, 2014.
    pub fn transmittance(&self, segment: &Segment, lanes: &Lanes, random: &mut dyn FnMut() -> f32) -> Spectrum {
        let Some((from, to)) = self.clip(segment) else { return Spectrum::ONE };
        let extinction = lanes.coefficient(self.extinction);
        let Some((grid, place)) = self.grid() else { return beer_transmittance(extinction, to - from) };
        let majorant = extinction.max_element() * grid.max_density();
        let (mut at, mut throughput) = (from, Spectrum::ONE);
        for _ in 0..MAX_STEPS {
            let Some(next) = collision(at, to, majorant, random) else { break };
            at = next;
            throughput *= Spectrum::ONE - extinction * (place.density(grid, segment.point(at)) / majorant);
            // Apply Russian roulette to small weights.
            if throughput.max_element() < 0.1 {
                if random() < 0.5 {
                    return Spectrum::ZERO;
                }
                throughput *= 2.0;
            }
        }
        throughput
    }

    /// Samples the distance at which light with these weights is scattered, unless it passes
    /// through the segment. The returned weight is already divided by the probability of the event.
    pub fn sample_distance(
        &self,
        segment: &Segment,
        weights: Spectrum,
        lanes: &Lanes,
        random: &mut dyn FnMut() -> f32,
    ) -> DistanceSample {
        let Some((from, to)) = self.clip(segment) else { return DistanceSample::Passed(Spectrum::ONE) };
        let extinction = lanes.coefficient(self.extinction);
        if !self.scatters() && self.grid().is_none() {
            return DistanceSample::Passed(beer_transmittance(extinction, to - from));
        }
        let albedo = lanes.reflectance(self.albedo);
        match self.grid() {
            Some((grid, place)) => {
                // Null collisions raise the density of the grid to its majorant everywhere. Lanes
                // are weighted by their current contribution. Sources: Woodcock and others, 1965;
                // Kutz and others, *Spectral and Decomposition Tracking*, 2017.
                let majorant = extinction.max_element() * grid.max_density();
                let (mut at, mut throughput) = (from, Spectrum::ONE);
                for _ in 0..MAX_STEPS {
                    let Some(next) = collision(at, to, majorant, random) else { break };
                    at = next;
                    let here = extinction * (place.density(grid, segment.point(at)) / majorant);
                    let real = lane_sum(normalized(weights * throughput) * here);
                    if random() < real {
                        return DistanceSample::Scattered(at, throughput * albedo * here / real);
                    }
                    throughput *= (Spectrum::ONE - here) / (1.0 - real);
                }
                DistanceSample::Passed(throughput)
            }
            None => {
                // The distance is sampled for one lane, and the weight combines the pdfs of all
                // lanes (one-sample MIS).
                let weights = normalized(weights);
                let mut choice = random();
                let lane = (0..3).find(|&lane| {
                    choice -= weights[lane];
                    choice < 0.0
                });
                let chosen = extinction[lane.unwrap_or(3)];
                let distance = if chosen > 0.0 { -fp::ln(1.0 - random()) / chosen } else { f32::INFINITY };
                if distance < to - from {
                    let throughput = beer_transmittance(extinction, distance);
                    let density = lane_sum(weights * extinction * throughput);
                    return DistanceSample::Scattered(from + distance, albedo * extinction * throughput / density);
                }
                let throughput = beer_transmittance(extinction, to - from);
                DistanceSample::Passed(throughput / lane_sum(weights * throughput).max(f32::MIN_POSITIVE))
            }
        }
    }
}

/// Distance of the next tentative collision in a medium with the constant extinction `majorant`, or
/// `None` if it is beyond `to`.
fn collision(at: f32, to: f32, majorant: f32, random: &mut dyn FnMut() -> f32) -> Option<f32> {
    let next = at - fp::ln(1.0 - random()) / majorant;
    (next < to).then_some(next)
}

/// Normalizes the weights of the lanes to a sum of 1.
fn normalized(weights: Spectrum) -> Spectrum {
    let weights = weights.max(Spectrum::ZERO);
    let sum = lane_sum(weights);
    if sum > 0.0 { weights / sum } else { Spectrum::splat(0.25) }
}

/// Transmittance over a distance, computed by Beer's law.
fn beer_transmittance(extinction: Spectrum, distance: f32) -> Spectrum {
    (-extinction * distance.min(f32::MAX)).map(fp::exp)
}
