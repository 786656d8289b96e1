//! A render job. It contains everything that determines a picture, except the scene.

use super::camera_rays::raster;
use super::crop::PixelRect;
use super::error::RenderError;
use super::passes;
use crate::film::Filter;
use crate::film::aov::{Aov, AovFunction};
use crate::film::course::CourseFilter;
use crate::film::false_color::FalseColorScale;
use crate::integrator::{Integrator, IntegratorContext, IntegratorKind, RenderSettings};
use crate::world::World;
use durer_scene::camera::RayCone;
use durer_scene::describe::DescribedKind;
use durer_scene::math::Color;
use durer_scene::sampler::Sampler;
use serde::{Deserialize, Deserializer, Serialize, Serializer};
use std::sync::atomic::AtomicBool;

/// Sampling method of a picture. It determines where samples lie in a pixel and how they are
/// combined.
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize)]
pub enum Sampling {
    /// One ray through the centre of each pixel.
    Center,
    /// Sobol points that are distributed in proportion to the filter. Each sample affects only its
    /// own pixel.
    Filtered {
        /// Number of samples per pixel.
        samples: u32,
        /// Reconstruction filter.
        filter: Filter,
    },
    /// Sampling of the Fall 2004 course. Samples are stored and then weighted by their offset from
    /// the centre of a pixel.
    Course2004 {
        /// Distribution of samples in a pixel.
        sampler: Sampler,
        /// Number of samples per pixel.
        samples: u32,
        /// Reconstruction filter. If it is `None`, a pixel is the mean of its own samples.
        filter: Option<CourseFilter>,
    },
    /// Sampling of the Fall 2012 course, with 3 x 3 jittered sub-pixels that are blurred with five
    /// taps and averaged.
    Course2012 {
        /// True if pixels are divided into sub-pixels.
        jitter: bool,
        /// True if the picture is blurred.
        blur: bool,
    },
}

impl Sampling {
    /// Returns the number of samples per pixel that a finished render adds to the film. If samples
    /// affect several pixels, this number is 1, because only the finished pixel is added to the
    /// film.
    pub fn samples(self) -> u32 {
        match self {
            Sampling::Filtered { samples, .. } => samples.max(1),
            Sampling::Course2004 { sampler, samples, filter: None } => sampler.round_up(samples),
            _ => 1,
        }
    }

    /// Returns the sampling method with a different number of samples per pixel, if the method has
    /// a variable number.
    pub fn with_samples(self, number: u32) -> Self {
        match self {
            Sampling::Filtered { filter, .. } => Sampling::Filtered { samples: number, filter },
            Sampling::Course2004 { sampler, filter, .. } => Sampling::Course2004 { sampler, samples: number, filter },
            other => other,
        }
    }

    /// Returns true if a pixel depends only on its own samples.
    pub fn is_local(self) -> bool {
        !matches!(self, Sampling::Course2004 { filter: Some(_), .. } | Sampling::Course2012 { .. })
    }
}

/// Description of a render: everything that determines the pictures except the scene, such as size,
/// sampling and integrator. It is plain data and does not depend on the machine.
#[derive(Clone, Debug, Serialize, Deserialize)]
pub struct Job {
    /// Width of the full picture in pixels.
    pub width: u32,
    /// Height of the full picture in pixels.
    pub height: u32,
    /// Rectangle to render, or `None` for the full picture.
    pub crop: Option<PixelRect>,
    /// Name of the graphics device that computes the colour samples; `None` for the CPU. Devices
    /// round differently, so the parts of a picture must come from the same device.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub device: Option<String>,
    /// Seed of the random numbers.
    pub seed: u64,
    /// Sampling method for the colour picture.
    pub sampling: Sampling,
    /// Noise threshold, or `None` for no threshold. A block gets no more samples once its estimated
    /// error is below the threshold. See [`passes::error`].
    pub noise: Option<f32>,
    /// True for adaptive sampling. The number of samples is then an average, and pixels with more
    /// noise in their pilot samples get more samples.
    #[serde(default, skip_serializing_if = "std::ops::Not::not")]
    pub adaptive: bool,
    /// Integrator and the options of the integrator.
    #[serde(default)]
    pub method: IntegratorKind,
    /// Settings that all integrators share.
    pub settings: RenderSettings,
    /// True if the colour picture is rendered.
    pub color: bool,
    /// AOVs to render.
    #[serde(serialize_with = "aov_names", deserialize_with = "named_aovs")]
    pub aovs: Vec<&'static Aov>,
    /// Depths that are shown as black and white. `None` means the minimum and maximum of the
    /// picture, excluding the horizon of a plane.
    pub depth_range: Option<(f32, f32)>,
    /// Range of false-colour pictures, or `None` for the range from 0 to a percentile of the
    /// picture.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub light_scale: Option<FalseColorScale>,
    /// Replacement for the background in the colour picture, or `None` for the light of the scene's
    /// background.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub backdrop: Option<Backdrop>,
}

/// Replacement for the background in the colour picture. Only camera rays see it: the light of the
/// background, its reflections and what is seen through glass remain.
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize)]
pub enum Backdrop {
    /// The picture is transparent where camera rays hit nothing.
    Transparent,
    /// A colour, as linear light from 0.
    Color(Color),
}

/// Serializes AOVs by their names.
fn aov_names<S: Serializer>(aovs: &[&'static Aov], serializer: S) -> Result<S::Ok, S::Error> {
    serializer.collect_seq(aovs.iter().map(|aov| aov.name))
}

/// Deserializes AOVs from their names.
fn named_aovs<'de, D: Deserializer<'de>>(deserializer: D) -> Result<Vec<&'static Aov>, D::Error> {
    let unknown = |name: &str| serde::de::Error::custom(format!("unknown picture `{name}`"));
    let names = Vec::<String>::deserialize(deserializer)?;
    names.iter().map(|name| Aov::from_name(name).ok_or_else(|| unknown(name))).collect()
}

impl Default for Job {
    /// Returns a job for a colour picture of 512 x 512 pixels with one ray per pixel, shadows and
    /// up to eight bounces.
    fn default() -> Self {
        let settings = RenderSettings {
            bounces: 8,
            shadows: true,
            shade_back: true,
            transparent_shadows: false,
            reflection: true,
            refraction: true,
            min_weight: 1.0 / 256.0,
        };
        Job {
            width: 512,
            height: 512,
            crop: None,
            device: None,
            seed: 0,
            sampling: Sampling::Center,
            noise: None,
            adaptive: false,
            method: IntegratorKind::default(),
            settings,
            color: true,
            aovs: Vec::new(),
            depth_range: None,
            light_scale: None,
            backdrop: None,
        }
    }
}

impl Job {
    /// Maximum number of samples per pixel.
    pub const MAX_SAMPLES: u32 = 1 << 20;
    /// Maximum radius of a filter, in pixels.
    pub const MAX_FILTER_RADIUS: f32 = 64.0;

    /// Checks all values. The size must be at least 1 x 1, and the number of samples must be from 1
    /// to [`Job::MAX_SAMPLES`]. The radius of the filter must be above 0 and at most
    /// [`Job::MAX_FILTER_RADIUS`], and the depth at most [`RenderSettings::MAX_BOUNCES`]. Also
    /// checks thresholds, scales and the options of the integrator.
    /// [`PartialRender::new`](super::PartialRender::new) calls this function first.
    ///
    /// # Errors
    ///
    /// Returns [`RenderError::Job`] with the name of the invalid value.
    pub fn validate(&self) -> Result<(), RenderError> {
        let refuse = |message: String| Err(RenderError::Job(message));
        if self.width == 0 || self.height == 0 {
            return refuse(format!("the size {} x {} must be at least 1 x 1", self.width, self.height));
        }
        let (samples, radius) = match self.sampling {
            Sampling::Filtered { samples, filter } => (samples, Some(filter.radius())),
            Sampling::Course2004 { samples, .. } => (samples, None),
            Sampling::Center | Sampling::Course2012 { .. } => (1, None),
        };
        if !(1..=Job::MAX_SAMPLES).contains(&samples) {
            return refuse(format!("samples {samples} must be from 1 to {}", Job::MAX_SAMPLES));
        }
        if let Some(radius) = radius.filter(|&radius| !(radius > 0.0 && radius <= Job::MAX_FILTER_RADIUS)) {
            let most = Job::MAX_FILTER_RADIUS;
            return refuse(format!("the filter's radius {radius} must be more than 0 and at most {most}"));
        }
        if let Sampling::Filtered { filter: Filter::Gaussian { sigma, .. }, .. } = self.sampling
            && !(sigma > 0.0 && sigma.is_finite())
        {
            return refuse(format!("the filter's sigma {sigma} must be more than 0"));
        }
        // Unlike other filters, the filters of the course can have a radius of 0.
        if let Sampling::Course2004 { filter: Some(filter), .. } = self.sampling {
            let (CourseFilter::Box { radius: size }
            | CourseFilter::Tent { radius: size }
            | CourseFilter::Gaussian { sigma: size }) = filter;
            if !(0.0..=Job::MAX_FILTER_RADIUS).contains(&size) {
                return refuse(format!("the filter's radius {size} must be from 0 to {}", Job::MAX_FILTER_RADIUS));
            }
        }
        let RenderSettings { bounces, min_weight, .. } = self.settings;
        if bounces > RenderSettings::MAX_BOUNCES {
            return refuse(format!("bounces {bounces} must be at most {}", RenderSettings::MAX_BOUNCES));
        }
        if !(min_weight >= 0.0 && min_weight.is_finite()) {
            return refuse(format!("the minimum throughput {min_weight} must not be less than 0"));
        }
        if let Some(noise) = self.noise.filter(|noise| !(*noise > 0.0 && noise.is_finite())) {
            return refuse(format!("the noise threshold {noise} must be more than 0"));
        }
        for (at, field) in self.method.fields().iter().enumerate() {
            let value = self.method.get(at);
            if let Some(Err(violation)) = value.map(|value| field.constraint.validate(&value)) {
                return refuse(format!("{} of {} {violation}", field.name, self.method.name()));
            }
        }
        if let Some((min, max)) =
            self.depth_range.filter(|(min, max)| !(min.is_finite() && max.is_finite() && min != max))
        {
            return refuse(format!("the depths {min} and {max} must be two different finite numbers"));
        }
        if let Some(FalseColorScale { low, high, logarithmic }) = self.light_scale {
            let least = if logarithmic { f32::MIN_POSITIVE } else { 0.0 };
            if !(low >= least && high > low && high.is_finite()) {
                return refuse(format!("false colours cannot range from {low} to {high}"));
            }
        }
        if let Some(color) = self.missed_color()
            && !(color.is_finite() && color.min_element() >= 0.0)
        {
            return refuse(format!("the background's colour {color} must not be less than 0"));
        }
        if self.missed_color().is_some() && !self.sampling.is_local() {
            return refuse("the filters of the course do not support a background colour".into());
        }
        Ok(())
    }

    /// Checks that the job can render a world.
    pub(super) fn check_world(&self, world: &World) -> Result<(), RenderError> {
        if self.backdrop.is_some() && world.fog().is_some() {
            let message = "the background cannot be replaced, because the scene has fog in front of it";
            return Err(RenderError::Job(message.into()));
        }
        Ok(())
    }

    /// Returns the rectangle that is rendered.
    pub fn window(&self) -> PixelRect {
        self.crop.unwrap_or(self.whole())
    }

    /// Returns the rectangle of the full picture.
    pub fn whole(&self) -> PixelRect {
        PixelRect { left: 0, top: 0, width: self.width, height: self.height }
    }

    /// Returns the colour of samples without a camera ray, or `None` if they are transparent.
    pub fn missed_color(&self) -> Option<Color> {
        match self.backdrop {
            Some(Backdrop::Color(color)) => Some(color),
            Some(Backdrop::Transparent) | None => None,
        }
    }

    /// Returns the names of the job's pictures, in order.
    pub fn picture_names(&self) -> impl Iterator<Item = &'static str> {
        self.color.then_some("color").into_iter().chain(self.aovs.iter().map(|aov| aov.name))
    }

    /// Creates the integrator of the job for a world. Once `cancel` is set, no more rays are traced
    /// and the results are meaningless.
    pub fn integrator<'w>(&self, world: &'w World, cancel: Option<&'w AtomicBool>) -> Integrator<'w> {
        let raster = raster(world, self.width, self.height);
        let area = raster.pixel_area() / self.sampling.samples() as f32;
        let cone = RayCone::new(world.camera(), world.camera_frame(), area);
        self.method.create(IntegratorContext { world, settings: self.settings, cone, seed: self.seed, cancel })
    }

    /// Returns true if the colour picture or an AOV needs colour samples.
    pub fn wants_samples(&self) -> bool {
        self.color || self.aovs.iter().any(|aov| matches!(aov.value, AovFunction::Sums(_)))
    }

    /// Returns the AOVs that need rays through the centres of pixels, with the functions that
    /// compute their values.
    pub fn ray_aovs(
        &self,
    ) -> impl Iterator<Item = (&'static Aov, fn(&crate::film::aov::AovInput) -> durer_scene::math::Vec3)> {
        self.aovs.iter().filter_map(|aov| match aov.value {
            AovFunction::Ray(value) => Some((*aov, value)),
            AovFunction::Sums(_) => None,
        })
    }

    /// Returns the rectangle in which centre rays are traced. This is the full picture if an AOV
    /// depends on all pixels.
    pub fn ray_window(&self) -> PixelRect {
        if self.ray_aovs().any(|(aov, _)| aov.relative) { self.whole() } else { self.window() }
    }

    /// Returns true if a block is below the noise threshold after `samples` samples per pixel, so
    /// that rendering it can stop.
    pub(super) fn is_done(&self, film: &crate::film::Film, rect: PixelRect, samples: u32, gain: f32) -> bool {
        self.noise
            .is_some_and(|noise| samples >= passes::MIN_SAMPLES && passes::error(film, rect, gain) <= f64::from(noise))
    }
}
