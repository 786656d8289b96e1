//! Render job: everything besides the scene that determines a picture.

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
use durer_scene::sampler::Sampler;
use serde::{Deserialize, Deserializer, Serialize, Serializer};
use std::sync::atomic::AtomicBool;

/// Sampling method of a picture: where samples lie in a pixel, and how they are combined.
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize)]
pub enum Sampling {
    /// One ray through each pixel's centre.
    Center,
    /// Sobol points, distributed in proportion to the filter. Each sample affects only its own
    /// pixel.
    Filtered {
        /// Samples per pixel.
        samples: u32,
        /// Reconstruction filter.
        filter: Filter,
    },
    /// Fall 2004: samples are stored and then weighted by their offset from a pixel's centre.
    Course2004 {
        /// How samples are distributed in a pixel.
        sampler: Sampler,
        /// Samples per pixel.
        samples: u32,
        /// Filter. If `None`, a pixel is the mean of its own samples.
        filter: Option<CourseFilter>,
    },
    /// Fall 2012: 3 x 3 jittered sub-pixels, blurred with five taps and averaged.
    Course2012 {
        /// True for sub-pixels.
        jitter: bool,
        /// True for the blur.
        blur: bool,
    },
}

impl Sampling {
    /// Returns the number of samples per pixel that a finished render adds to the film. It is 1 if
    /// samples affect several pixels, because the film then gets the finished pixel.
    pub fn samples(self) -> u32 {
        match self {
            Sampling::Filtered { samples, .. } => samples.max(1),
            Sampling::Course2004 { sampler, samples, filter: None } => sampler.round_up(samples),
            _ => 1,
        }
    }

    /// Returns the sampling method with another number of samples per pixel, if the number can
    /// vary.
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

/// Render job: everything besides the scene that determines the pictures. Plain data, independent
/// of the machine.
#[derive(Clone, Debug, Serialize, Deserialize)]
pub struct Job {
    /// Width of the full picture in pixels.
    pub width: u32,
    /// Height of the full picture in pixels.
    pub height: u32,
    /// Rectangle to render; `None` for the full picture.
    pub crop: Option<PixelRect>,
    /// Seed of the random numbers.
    pub seed: u64,
    /// Sampling method for the colour picture.
    pub sampling: Sampling,
    /// Noise threshold. A block gets no more samples once its estimated error is below it; see
    /// [`passes::error`]. `None` for no threshold.
    pub noise: Option<f32>,
    /// True for adaptive sampling. The number of samples is then an average, and pixels with more
    /// noise in the pilot get more samples.
    #[serde(default, skip_serializing_if = "std::ops::Not::not")]
    pub adaptive: bool,
    /// Integrator and its options.
    #[serde(default)]
    pub method: IntegratorKind,
    /// Settings shared by all integrators.
    pub settings: RenderSettings,
    /// True to render the colour picture.
    pub color: bool,
    /// AOVs to render.
    #[serde(serialize_with = "aov_names", deserialize_with = "named_aovs")]
    pub aovs: Vec<&'static Aov>,
    /// Depths shown as black and white. `None` for the minimum and maximum of the picture,
    /// excluding the horizon of a plane.
    pub depth_range: Option<(f32, f32)>,
    /// Range of false-colour pictures; `None` for 0 to a percentile of the picture.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub light_scale: Option<FalseColorScale>,
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
    /// Colour picture of 512 x 512 pixels, one ray per pixel, with shadows and up to eight bounces.
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
        }
    }
}

impl Job {
    /// Maximum number of samples per pixel.
    pub const MAX_SAMPLES: u32 = 1 << 20;
    /// Maximum radius of a filter in pixels.
    pub const MAX_FILTER_RADIUS: f32 = 64.0;

    /// Checks all values: the size is at least 1 x 1, samples are from 1 to [`Job::MAX_SAMPLES`],
    /// the filter's radius is above 0 and at most [`Job::MAX_FILTER_RADIUS`], and the depth is at
    /// most [`RenderSettings::MAX_BOUNCES`]. Also checks thresholds, scales and the integrator's
    /// options. [`PartialRender::new`](super::PartialRender::new) calls this first.
    ///
    /// # Errors
    ///
    /// [`RenderError::Job`] with the name of the value.
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
        // Unlike other filters, the course's filters can have radius 0.
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
        Ok(())
    }

    /// Returns the rectangle to render.
    pub fn window(&self) -> PixelRect {
        self.crop.unwrap_or(self.whole())
    }

    /// Returns the rectangle of the full picture.
    pub fn whole(&self) -> PixelRect {
        PixelRect { left: 0, top: 0, width: self.width, height: self.height }
    }

    /// Returns the names of the job's pictures, in order.
    pub fn picture_names(&self) -> impl Iterator<Item = &'static str> {
        self.color.then_some("color").into_iter().chain(self.aovs.iter().map(|aov| aov.name))
    }

    /// Creates the job's integrator for a world. Once `cancel` is set, no more rays are traced and
    /// results are meaningless.
    pub fn integrator<'w>(&self, world: &'w World, cancel: Option<&'w AtomicBool>) -> Integrator<'w> {
        let raster = raster(world, self.width, self.height);
        let area = raster.pixel_area() / self.sampling.samples() as f32;
        let cone = RayCone::new(world.camera(), world.camera_frame(), area);
        self.method.create(IntegratorContext { world, settings: self.settings, cone, seed: self.seed, cancel })
    }

    /// Returns true if colour samples are needed, for the colour picture or for an AOV.
    pub fn wants_samples(&self) -> bool {
        self.color || self.aovs.iter().any(|aov| matches!(aov.value, AovFunction::Sums(_)))
    }

    /// Returns the AOVs that need rays through the pixels' centres, with their functions.
    pub fn ray_aovs(
        &self,
    ) -> impl Iterator<Item = (&'static Aov, fn(&crate::film::aov::AovInput) -> durer_scene::math::Vec3)> {
        self.aovs.iter().filter_map(|aov| match aov.value {
            AovFunction::Ray(value) => Some((*aov, value)),
            AovFunction::Sums(_) => None,
        })
    }

    /// Returns the rectangle for these rays: the full picture if an AOV depends on all its pixels.
    pub fn ray_window(&self) -> PixelRect {
        if self.ray_aovs().any(|(aov, _)| aov.relative) { self.whole() } else { self.window() }
    }

    /// Returns true if the noise threshold stops a block after `samples` samples per pixel.
    pub(super) fn is_done(&self, film: &crate::film::Film, rect: PixelRect, samples: u32, gain: f32) -> bool {
        self.noise
            .is_some_and(|noise| samples >= passes::MIN_SAMPLES && passes::error(film, rect, gain) <= f64::from(noise))
    }
}
