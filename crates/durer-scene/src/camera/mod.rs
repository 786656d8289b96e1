//! Cameras, which map picture points to rays and world-space points back to the picture. Each
//! camera has its own file, and [`Camera`] lists all of them.

mod aperture;
mod central;
mod eyes;
mod handedness;
mod pose;
pub mod raster;
mod ray_cone;
mod sheet;
mod tangent;

pub mod cave;
pub mod cube_map;
pub mod cylindrical;
pub mod equirectangular;
pub mod fisheye;
pub mod multiple_center;
pub mod omnimax;
pub mod orthographic;
pub mod parabolic;
pub mod perspective;
pub mod pinhole;
pub mod projective;
pub mod push_broom;
pub mod stereo;
pub mod thin_lens;

use crate::describe::described_list;
use crate::math::{Ray, Vec2, Vec3};
pub use equirectangular::EquirectangularCamera;
pub use eyes::Eyes;
pub use handedness::Handedness;
pub use orthographic::OrthographicCamera;
pub use perspective::PerspectiveCamera;
pub use pose::{CameraBasis, CameraRules, Pose, RayArithmetic, UpRule};
pub use raster::Raster;
pub use ray_cone::RayCone;
pub use thin_lens::ThinLensCamera;

macro_rules! delegate {
    ($($variant:ident),+) => {
        #[deny(clippy::missing_trait_methods)]
        impl Projection for Camera {
            fn pose(&self) -> Pose {
                match self { $(Camera::$variant(c) => c.pose(),)+ }
            }
            fn proportions(&self) -> Option<Vec2> {
                match self { $(Camera::$variant(c) => c.proportions(),)+ }
            }
            fn half_width(&self) -> f64 {
                match self { $(Camera::$variant(c) => c.half_width(),)+ }
            }
            fn has_aperture(&self) -> bool {
                match self { $(Camera::$variant(c) => c.has_aperture(),)+ }
            }
            fn validate(&self) -> Result<(), String> {
                match self { $(Camera::$variant(c) => c.validate(),)+ }
            }
            fn ray(&self, frame: &CameraBasis, sample: &CameraSample) -> Option<Ray> {
                match self { $(Camera::$variant(c) => c.ray(frame, sample),)+ }
            }
            #[inline(always)]
            fn rays<const N: usize>(
                &self,
                frame: &CameraBasis,
                samples: &CameraSamples<N>,
                take: impl FnMut(usize, Option<Ray>),
            ) {
                match self { $(Camera::$variant(c) => c.rays(frame, samples, take),)+ }
            }
            fn project(&self, frame: &CameraBasis, world: Vec3, lens: Vec2, emit: &mut dyn FnMut(Vec2)) {
                match self { $(Camera::$variant(c) => c.project(frame, world, lens, emit),)+ }
            }
            fn footprint(&self, frame: &CameraBasis, sample: &CameraSample, t: f32) -> f32 {
                match self { $(Camera::$variant(c) => c.footprint(frame, sample, t),)+ }
            }
        }
    };
}

described_list! {
    /// A camera of any kind, which maps points of the picture to rays.
    Camera: Projection => delegate {
        Perspective(perspective::PerspectiveCamera),
        Orthographic(orthographic::OrthographicCamera),
        Pinhole(pinhole::PinholeCamera),
        ThinLens(thin_lens::ThinLensCamera),
        Stereo(stereo::StereoCamera),
        Fisheye(fisheye::FisheyeCamera),
        Omnimax(omnimax::OmnimaxCamera),
        Parabolic(parabolic::ParabolicCamera),
        Equirectangular(equirectangular::EquirectangularCamera),
        Cylindrical(cylindrical::CylindricalCamera),
        CubeMap(cube_map::CubeMapCamera),
        Cave(cave::CaveCamera),
        PushBroom(push_broom::PushBroomCamera),
        MultipleCenter(multiple_center::MultipleCenterCamera),
        Projective(projective::ProjectiveCamera),
    }
}

/// Input for a camera ray, which consists of a position in the picture and a position on the lens.
///
/// The square that the camera covers has its lower left corner at (-1, -1) and its upper right
/// corner at (1, 1).
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct CameraSample {
    /// Point in the picture.
    pub point: Vec2,
    /// Centre of the pixel that the sample contributes to. A filter can extend beyond the pixel,
    /// and beyond the part of the picture that contains the pixel (a cube face, a wall or an eye).
    /// Points outside that part continue its projection.
    pub pixel: Vec2,
    /// Point on the lens, in [0,1)^2, where (0.5, 0.5) is the centre.
    pub lens: Vec2,
}

impl CameraSample {
    /// Creates a sample at the centre of a pixel, through the centre of the lens.
    pub fn at(point: Vec2) -> Self {
        CameraSample { point, pixel: point, lens: Vec2::splat(0.5) }
    }
}

/// Packet of `N` camera samples in structure-of-arrays layout, for [`Projection::rays`].
#[derive(Clone, Copy, Debug)]
pub struct CameraSamples<const N: usize> {
    /// Points in the picture, with all x values first, followed by all y values.
    pub points: [[f32; N]; 2],
    /// Centres of the pixels.
    pub pixels: [Vec2; N],
    /// Points on the lens, with all x values first, followed by all y values.
    pub lenses: [[f32; N]; 2],
}

impl<const N: usize> CameraSamples<N> {
    /// Returns the sample with the index `i`.
    pub fn sample(&self, i: usize) -> CameraSample {
        let [point, lens] = [self.points, self.lenses].map(|[x, y]| Vec2::new(x[i], y[i]));
        CameraSample { point, pixel: self.pixels[i], lens }
    }
}

impl From<CameraSample> for CameraSamples<1> {
    fn from(CameraSample { point, pixel, lens }: CameraSample) -> Self {
        CameraSamples { points: [[point.x], [point.y]], pixels: [pixel], lenses: [[lens.x], [lens.y]] }
    }
}

/// Operations that every camera implements: rays, projection and footprints.
pub trait Projection {
    /// Position and orientation of the camera.
    fn pose(&self) -> Pose;

    /// Natural width and height of the picture, in any unit; `None` if the picture can have any
    /// aspect ratio. A natural picture is centred in the square, and its longer side is as long as
    /// a side of the square.
    fn proportions(&self) -> Option<Vec2> {
        None
    }

    /// Half the width of the view at distance 1, or 1 if the rays do not need this width.
    fn half_width(&self) -> f64 {
        1.0
    }

    /// True if the ray through a point in the picture depends on the point on the lens.
    fn has_aperture(&self) -> bool {
        false
    }

    /// Checks that the fields are valid in combination. The constraints in the description check
    /// each field separately.
    ///
    /// # Errors
    ///
    /// Returns a message that explains why the camera is invalid.
    fn validate(&self) -> Result<(), String> {
        Ok(())
    }

    /// Returns the ray of a sample, or `None` if the camera sees nothing there. The direction has
    /// unit length, so `t` is a distance.
    fn ray(&self, frame: &CameraBasis, sample: &CameraSample) -> Option<Ray>;

    /// Calls `take` with the index and the ray of each sample, in order. See [`Projection::ray`].
    /// The callback lets the caller store each ray in place, since copying entire packets stalls
    /// the processor.
    fn rays<const N: usize>(
        &self,
        frame: &CameraBasis,
        samples: &CameraSamples<N>,
        mut take: impl FnMut(usize, Option<Ray>),
    ) {
        (0..N).for_each(|i| take(i, self.ray(frame, &samples.sample(i))));
    }

    /// Calls `emit` with every point of the picture at which a point in world space is seen through
    /// a point on the lens. There may be no such point, one, or several, as for a pair of eyes.
    /// Occlusion is ignored. If the picture can have any aspect ratio, the points may lie outside
    /// the square.
    fn project(&self, frame: &CameraBasis, world: Vec3, lens: Vec2, emit: &mut dyn FnMut(Vec2));

    /// Returns the area across the ray at distance `t` per unit area of the picture, for a fixed
    /// point on the lens.
    ///
    /// The area is the Jacobian |(dX/dx × dX/dy) · dir| of X = origin + t dir with respect to the
    /// point in the picture. If all rays meet in one eye, the area is t² times the solid angle per
    /// unit area of the picture. If the rays are parallel, the area is constant. The result is
    /// undefined if the sample has no ray.
    fn footprint(&self, frame: &CameraBasis, sample: &CameraSample, t: f32) -> f32;
}

#[cfg(test)]
mod conformance;
#[cfg(test)]
mod tests;
