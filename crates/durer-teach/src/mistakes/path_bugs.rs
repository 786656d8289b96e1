//! The mistakes that a student's path tracer can make, given as options of its tracer.

/// Power of the cosine at a surface in a student's path tracer.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub enum CosinePower {
    /// The power is 1, which is correct.
    #[default]
    Correct,
    /// The power is 0, so there is no cosine.
    None,
    /// The power is 2.
    Twice,
}

/// Method by which a student's path tracer samples the scattered direction at a surface.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub enum DirectionSampling {
    /// BSDF sampling divided by the pdf, which is correct.
    #[default]
    Correct,
    /// BSDF sampling that is not divided by the pdf.
    Undivided,
    /// Uniform sampling over the hemisphere, but divided by the pdf of cosine sampling.
    Uniform,
    /// BSDF sampling, but divided by the pdf of uniform sampling over the hemisphere.
    UniformPdf,
    /// BSDF sampling in which the local coordinates are used as world-space coordinates.
    LocalFrame,
    /// BSDF sampling with the same random number for both dimensions.
    OneNumber,
}

/// The factor that a student's path tracer omits from a light sample.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub enum MissingFactor {
    /// No factor is omitted, which is correct.
    #[default]
    Nothing,
    /// The factor 1 / d² is omitted.
    Distance,
    /// The cosine at the light is omitted.
    Cosine,
    /// The area of the light is omitted.
    Area,
    /// The division by the probability of choosing the light is omitted.
    Choice,
    /// The division by the pdf of the sample is omitted.
    Density,
    /// The sample is divided by the pdf of BSDF sampling instead of its own pdf.
    OwnDensity,
}

/// Method by which a student's path tracer compensates for paths that end by Russian roulette.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub enum RouletteBug {
    /// Surviving paths are divided by the survival probability, which is correct.
    #[default]
    Correct,
    /// Surviving paths are not divided.
    Undivided,
    /// Each channel is divided by its own throughput, so the paths lose their colour.
    PerChannel,
}

/// Mistakes of a student's path tracer where light is refracted.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub enum RefractionBug {
    /// There is no mistake.
    #[default]
    Correct,
    /// The radiance is not scaled by the square of the relative index of refraction.
    Unscaled,
    /// The radiance is divided by the square of the index both when entering and when leaving.
    DividedTwice,
    /// The radiance is multiplied by the square of the index both when entering and when leaving.
    MultipliedTwice,
    /// The relative index of refraction is inverted.
    Inverted,
    /// The tangential part of the direction has the wrong sign.
    Flipped,
    /// The direction does not change.
    Straight,
}

/// Mistakes in a student's environment light.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub enum EnvironmentBug {
    /// There is no mistake: directions and pdf are correct.
    #[default]
    Correct,
    /// The environment is upside down.
    UpsideDown,
    /// The pdf lacks the sine of the polar angle.
    NoSine,
}

/// Method by which a student's path tracer computes a pixel from its samples.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub enum PixelMean {
    /// The pixel is the mean of the radiance, which is correct.
    #[default]
    Light,
    /// The pixel is the mean of the radiance clamped to [0, 1].
    Clamped,
    /// The pixel is the mean of the display values.
    Shown,
}

/// The mistakes of a student's path tracer (`BuggyPathTracer`). The default is a correct tracer.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct PathBugs {
    /// Power of the cosine at surfaces.
    pub cosine_power: CosinePower,
    /// The diffuse lobe lacks the factor 1/π. With `true`, this affects only light samples.
    pub no_pi: Option<bool>,
    /// Method for sampling scattered directions.
    pub direction_sampling: DirectionSampling,
    /// Factor that is omitted from light samples.
    pub missing_factor: MissingFactor,
    /// Light and BSDF samples are added without MIS weights.
    pub unweighted: bool,
    /// Russian roulette.
    pub roulette: RouletteBug,
    /// Refraction.
    pub refraction: RefractionBug,
    /// A path starts with the throughput at which the previous path of the pixel ended.
    pub kept_throughput: bool,
    /// One-sided emitters emit on both sides.
    pub two_sided: bool,
    /// Environment light.
    pub environment: EnvironmentBug,
    /// Method for computing a pixel from its samples.
    pub pixel_mean: PixelMean,
}
