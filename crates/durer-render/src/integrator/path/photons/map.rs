//! Photon map of one sample: a grid of photons, and density estimates from nearby photons.

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
    /// Point of absorption in world space.
    position: Vec3,
    /// Unit direction towards the previous vertex.
    wi: Vec3,
    /// Power by lane. In a medium, it is divided by the scattering coefficient.
    power: Spectrum,
    /// Number of delta bounces between the light and this point.
    bounces: u32,
    pub(super) absorber: Absorber,
}

/// Place where a photon was absorbed: a surface, or the medium inside an object.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(super) enum Absorber {
    Surface,
    /// Medium inside the object with this index; `None` for the air.
    Medium(Option<u32>),
}

/// Photon map for one sample of all pixels: the photons on surfaces and in media.
#[derive(Debug)]
pub struct PhotonMap {
    pub(super) lanes: Lanes,
    pub(super) on_surfaces: PhotonGrid,
    pub(super) in_media: PhotonGrid,
}

/// Radiance estimated from the photons near a point, by [`PhotonMap`].
#[derive(Clone, Copy, Debug)]
pub struct DensityEstimate {
    /// Radiance that the point scatters towards the previous vertex of the path.
    pub radiance: Spectrum,
    /// Number of photons within the radius that contributed.
    pub photons: usize,
    /// Search radius in world units.
    pub radius: f32,
}

/// Photons sorted into the cells of a hashed grid, for finding those near a point.
#[derive(Debug)]
pub(super) struct PhotonGrid {
    /// Search radius in world units. Cells are two radii wide.
    radius: f32,
    corrected: bool,
    /// Cell number of each photon, in ascending order.
    cells: Vec<u64>,
    photons: Vec<Photon>,
}

/// Returns the number of a grid cell, with 21 bits along each axis.
fn cell_of(place: glam::I64Vec3) -> u64 {
    let part = |x: i64| (x as u64) & 0x1f_ffff;
    part(place.x) | part(place.y) << 21 | part(place.z) << 42
}

impl Photon {
    /// Creates a photon; `None` if its power is infinite or NaN.
    pub(super) fn new(position: Vec3, wi: Vec3, power: Spectrum, bounces: u32, rest: Absorber) -> Option<Self> {
        power.is_finite().then_some(Photon { position, wi, power, bounces, absorber: rest })
    }
}

impl PhotonGrid {
    /// Sorts photons into cells that are two search radii wide.
    pub(super) fn new(photons: &[Photon], radius: f32, corrected: bool) -> Self {
        // Photons in a cell stay in the order of emission, so sums are reproducible.
        let cell = |photon: &Photon| cell_of(place(photon.position, radius, 0.0));
        let mut order: Vec<(u64, u32)> = (0..).zip(photons).map(|(i, photon)| (cell(photon), i)).collect();
        order.sort_unstable();
        let photons = order.iter().map(|&(_, i)| photons[i as usize]).collect();
        PhotonGrid { radius, corrected, cells: order.into_iter().map(|(cell, _)| cell).collect(), photons }
    }

    /// Sums `value` over the photons within the search radius of a point that have at most
    /// `max_bounces` bounces. `value` is called with the vector to the photon and its squared
    /// length.
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

    /// Returns the weight of a photon for its squared distance and its squared height above the
    /// surface. 0 if the photon is too high and so lies on another surface.
    ///
    /// The bias of a kernel with radius r is c r^2 to second order, and c r^2 / 2 with half the
    /// squared radius. Twice the latter estimate minus the former cancels it (Richardson
    /// extrapolation).
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
    /// Returns the meaning of the lanes of the photons' power.
    pub fn lanes(&self) -> &Lanes {
        &self.lanes
    }

    /// Estimates the radiance that a surface point scatters from nearby photons. Ignores photons
    /// with more than `max_bounces` bounces.
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
    /// object (`None` for air). See [`PhotonMap::on_surface`].
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

/// Maximum squared height of a photon above a surface, as a fraction of the squared search radius.
/// Higher photons lie on another surface.
const FLATNESS: f32 = 0.1;

/// Epanechnikov kernel in the plane, from the squares of radius and distance.
fn disc(square: f32, distance: f32) -> f32 {
    2.0 / (PI * square) * (1.0 - distance / square)
}

/// Epanechnikov kernel in space, from the squares of radius and distance.
fn ball(square: f32, distance: f32) -> f32 {
    15.0 / (8.0 * PI * square * square.sqrt()) * (1.0 - distance / square)
}

/// Returns the coordinates of a point's grid cell, after a shift in units of cells.
fn place(point: Vec3, radius: f32, shift: f64) -> glam::I64Vec3 {
    (point.as_dvec3() / (2.0 * f64::from(radius)) + DVec3::splat(shift)).floor().as_i64vec3()
}
