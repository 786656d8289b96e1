//! Cameras: from a place in the picture to a ray, and from a point of the world back to the
//! picture. One file each; the list is [`Camera`].

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
pub use pose::{Aim, CameraBasis, CameraRules, Pose, UpRule};
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
            fn project(&self, frame: &CameraBasis, world: Vec3, lens: Vec2, found: &mut dyn FnMut(Vec2)) {
                match self { $(Camera::$variant(c) => c.project(frame, world, lens, found),)+ }
            }
            fn footprint(&self, frame: &CameraBasis, sample: &CameraSample, t: f32) -> f32 {
                match self { $(Camera::$variant(c) => c.footprint(frame, sample, t),)+ }
            }
        }
    };
}

described_list! {
    /// A camera.
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

/// Where in the picture and in the lens a ray is wanted.
///
/// (-1, -1) is the lower left corner of the square that the camera covers, (1, 1) the upper right.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct CameraSample {
    /// The point of the picture.
    pub point: Vec2,
    /// The centre of the pixel that the sample is for. A filter may reach beyond the pixel, and
    /// beyond the part of the picture (a face of a cube, a wall, an eye) that the pixel belongs
    /// to: what it finds there continues that part.
    pub pixel: Vec2,
    /// The point of the lens, in [0,1)^2; (0.5, 0.5) is its middle.
    pub lens: Vec2,
}

impl CameraSample {
    /// A point of the picture that is its own pixel's centre, through the middle of the lens.
    pub fn at(point: Vec2) -> Self {
        CameraSample { point, pixel: point, lens: Vec2::splat(0.5) }
    }
}

/// Several of them side by side.
#[derive(Clone, Copy, Debug)]
pub struct CameraSamples<const N: usize> {
    /// The points of the picture: x of all, then y.
    pub points: [[f32; N]; 2],
    /// The centres of their pixels.
    pub pixels: [Vec2; N],
    /// The points of the lens, as those of the picture.
    pub lenses: [[f32; N]; 2],
}

impl<const N: usize> CameraSamples<N> {
    /// One of them.
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

/// What every camera can do.
pub trait Projection {
    /// Where it stands.
    fn pose(&self) -> Pose;

    /// The natural width and height of its picture, in any unit; `None` where any shape will do,
    /// and the larger side spans the square. A natural picture lies in the middle of the
    /// square, which its larger side spans.
    fn proportions(&self) -> Option<Vec2> {
        None
    }

    /// Half the width of what is seen at distance 1; 1 where rays need no such number.
    fn half_width(&self) -> f64 {
        1.0
    }

    /// Whether rays through one point of the picture differ by the point of the lens.
    fn has_aperture(&self) -> bool {
        false
    }

    /// Checks its fields together. Each by itself has its rule in the statement.
    ///
    /// # Errors
    ///
    /// A sentence that says why there is no such camera.
    fn validate(&self) -> Result<(), String> {
        Ok(())
    }

    /// The ray of a sample; `None` where the camera sees nothing. The direction has length 1, so
    /// that `t` is a distance.
    fn ray(&self, frame: &CameraBasis, sample: &CameraSample) -> Option<Ray>;

    /// Gives the rays of several samples, one after the other, as [`Projection::ray`] has them: for
    /// `take` to put each where it belongs, since what is copied at once is waited for.
    fn rays<const N: usize>(
        &self,
        frame: &CameraBasis,
        samples: &CameraSamples<N>,
        mut take: impl FnMut(usize, Option<Ray>),
    ) {
        (0..N).for_each(|i| take(i, self.ray(frame, &samples.sample(i))));
    }

    /// Calls `found` with every point of the picture at which a point of the world is seen through
    /// a point of the lens: one, none, or several, as for a pair of eyes. What hides it is not
    /// asked. Where the picture may have any shape, points may lie beyond the square.
    fn project(&self, frame: &CameraBasis, world: Vec3, lens: Vec2, found: &mut dyn FnMut(Vec2));

    /// The area across the ray at distance `t` that a unit of the picture's area covers, the point
    /// of the lens held fast.
    ///
    /// This is the Jacobian |(dX/dx × dX/dy) · dir| of X = origin + t dir by the picture's point.
    /// Where all rays meet in one eye it is t² times the solid angle per area of the picture;
    /// where they are parallel it is constant. Undefined where there is no ray.
    fn footprint(&self, frame: &CameraBasis, sample: &CameraSample, t: f32) -> f32;
}

#[cfg(test)]
mod conformance;
#[cfg(test)]
mod tests;
