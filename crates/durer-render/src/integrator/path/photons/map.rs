//! Photon map of one sample: a grid of photons, used to estimate radiance from the density of
//! nearby photons.

use crate::world::Shading;
use durer_scene::math::Vec3;
use durer_scene::medium::HenyeyGreenstein;
use durer_scene::shape::SurfacePoint;
use durer_scene::spectrum::{Lanes, Spectrum};
use glam::DVec3;
use std::f32::consts::PI;

/// Photon absorbed at a surface or in a medium, as stored in a [`PhotonMap`].
#[derive(Clone, Copy, Debug)]
pub(super) struct Photon {
    /// World-space position at which the photon was absorbed.
    position: Vec3,
    /// Unit direction towards the previous vertex.
    wi: Vec3,
    /// Power of the photon, by lane. If the photon was absorbed in a medium, its power is divided
    /// by the scattering coefficient.
    power: Spectrum,
    /// Number of delta bounces between the light and the point of absorption.
    bounces: u32,
    pub(super) absorber: Absorber,
}

/// Place where a photon was absorbed, which is a surface or the medium inside an object.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(super) enum Absorber {
    Surface,
    /// Medium inside the object with this index, or in the air if it is `None`.
    Medium(Option<u32>),
}

/// Photon map for one sample of every pixel, with the photons on surfaces and in media.
#[derive(Debug)]
pub struct PhotonMap {
    pub(super) lanes: Lanes,
    pub(super) on_surfaces: PhotonGrid,
    pub(super) in_media: PhotonGrid,
}

/// Radiance estimated by a [`PhotonMap`] from the photons near a point.
#[derive(Clone, Copy, Debug)]
pub struct DensityEstimate {
    /// Radiance that the point scatters towards the previous vertex of the path.
    pub radiance: Spectrum,
    /// Number of photons within the radius that contributed.
    pub photons: usize,
    /// Search radius in world units.
    pub radius: f32,
}

/// Photons sorted into the cells of a hashed grid, which is used to find the photons near a point.
#[derive(Debug)]
pub(super) struct PhotonGrid {
    /// Search radius in world units. Cells are two radii wide.
    radius: f32,
    corrected: bool,
    /// Number of the cell that contains each photon, in ascending order.
    cells: Vec<u64>,
    photons: Vec<Photon>,
}

/// Returns the number of a grid cell, which encodes 21 bits for each axis.
fn cell_of(place: glam::I64Vec3) -> u64 {
    let part = |x: i64| (x as u64) & 0x1f_ffff;
    part(place.x) | part(place.y) << 21 | part(place.z) << 42
}

impl Photon {
    /// Creates a photon, or returns `None` if its power is infinite or NaN.
    pub(super) fn new(position: Vec3, wi: Vec3, power: Spectrum, bounces: u32, rest: Absorber) -> Option<Self> {
        power.is_finite().then_some(Photon { position, wi, power, bounces, absorber: rest })
    }
}

impl PhotonGrid {
    /// Sorts photons into cells that are two search radii wide.
    pub(super) fn new(photons: &[Photon], radius: f32, corrected: bool) -> Self {
        // Photons in the same cell stay in the order of emission, so sums are reproducible.
        let cell = |photon: &Photon| cell_of(place(photon.position, radius, 0.0));
        let mut order: Vec<(u64, u32)> = (0..).zip(photons).map(|(i, photon)| (cell(photon), i)).collect();
        order.sort_unstable();
        let photons = order.iter().map(|&(_, i)| photons[i as usize]).collect();
        PhotonGrid { radius, corrected, cells: order.into_iter().map(|(cell, _)| cell).collect(), photons }
    }

    /// Sums `value` over all photons within the search radius of a point that had at most
    /// `max_bounces` bounces. `value` is called with the vector from the point to the photon and
    /// with the squared length of that vector.
    fn gather(&self, point: Vec3, max_bounces: u32, value: impl Fn(&Photon, Vec3, f32) -> Spectrum) -> DensityEstimate {
        let mut gathered = DensityEstimate { radiance: Spectrum::ZERO, photons: 0, radius: self.radius };
        // Cells are two radii wide, so the nearest 2 x 2 x 2 cells contain all photons within the
        // radius.
        let low = place(point, self.radius, -0.5);
        for corner in 0..8 {
            let cell = cell_of(low + glam::I64Vec3::new(corner & 1, corner >> 1 & 1, corner >> 2));
            let start = self.cells.partition_point(|&other| other < cell);
            for (photon, _) in self.photons[start..].iter().zip(&self.cells[start..]).take_while(|pair| *pair.1 == cell)
            {
                let offset = photon.position - point;
                let distance = offset.length_squared();
                if distance >= self.radius * self.radius || photon.bounces > max_bounces {
                    continue;
                }
                let value = value(photon, offset, distance);
                if value != Spectrum::ZERO {
                    gathered.photons += 1;
                    gathered.radiance += value;
                }
            }
        }
        gathered
    }

    /// Returns the weight of a photon, given its squared distance from the point and its squared
    /// height above the surface. The weight is 0 if the photon is so high that it lies on another
    /// surface.
    ///
    /// To second order, the bias of a kernel with radius r is c r^2, and that of a kernel with half
    /// the squared radius is c r^2 / 2. Twice the estimate of the smaller kernel minus that of the
    /// larger one therefore has no such bias (Richardson extrapolation).
    fn kernel(&self, distance: f32, beside: f32, kernel: fn(f32, f32) -> f32) -> f32 {
        let square = self.radius * self.radius;
        if beside > FLATNESS * square {
            return 0.0;
        }
        let (whole, half) = (kernel(square, distance), 0.5 * square);
        match self.corrected {
            false => whole,
            true if distance < half && beside <= FLATNESS * half => 2.0 * kernel(half, distance) - whole,
            true => -whole,
        }
    }
}

impl PhotonMap {
    /// Returns the meaning of the lanes in which the photons' power is stored.
    pub fn lanes(&self) -> &Lanes {
        &self.lanes
    }

    /// Estimates the radiance that a surface point scatters from nearby photons. Photons with more
    /// than `max_bounces` bounces are ignored.
    pub fn on_surface(&self, surface: &SurfacePoint, shading: &Shading, max_bounces: u32) -> DensityEstimate {
        let cells = &self.on_surfaces;
        cells.gather(surface.position, max_bounces, |photon, way, distance| {
            let beside = way.dot(surface.n_geo);
            let kernel = cells.kernel(distance, beside * beside, disc);
            let cosine = shading.frame.normal.dot(photon.wi).abs();
            if kernel == 0.0 || cosine <= 1e-4 {
                return Spectrum::ZERO;
            }
            let (value, _) = shading.eval(photon.wi);
            value * photon.power * (kernel / cosine)
        })
    }

    /// Estimates the radiance scattered along a unit direction at a point in the medium of an
    /// object (`None` means air). See [`PhotonMap::on_surface`].
    pub fn in_medium(
        &self,
        (point, dir): (Vec3, Vec3),
        object: Option<u32>,
        phase: &HenyeyGreenstein,
        max_bounces: u32,
    ) -> DensityEstimate {
        let cells = &self.in_media;
        cells.gather(point, max_bounces, |photon, _, distance| match photon.absorber == Absorber::Medium(object) {
            true => photon.power * (phase.value(dir, photon.wi) * cells.kernel(distance, 0.0, ball)),
            false => Spectrum::ZERO,
        })
    }
}

/// Maximum squared height of a photon above a surface, relative to the squared search radius.
/// Photons at a greater height lie on another surface.
const FLATNESS: f32 = 0.1;

/// Returns the Epanechnikov kernel in the plane, given the squares of radius and distance.
fn disc(square: f32, distance: f32) -> f32 {
    2.0 / (PI * square) * (1.0 - distance / square)
}

/// Returns the Epanechnikov kernel in space, given the squares of radius and distance.
fn ball(square: f32, distance: f32) -> f32 {
    15.0 / (8.0 * PI * square * square.sqrt()) * (1.0 - distance / square)
}

/// Returns the coordinates of the grid cell that contains a point, after the point was shifted by
/// `shift` cells along each axis.
fn place(point: Vec3, radius: f32, shift: f64) -> glam::I64Vec3 {
    (point.as_dvec3() / (2.0 * f64::from(radius)) + DVec3::splat(shift)).floor().as_i64vec3()
}
