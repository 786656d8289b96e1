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
    /// The power is 0 for light samples.
    NoneForLights,
    /// The power is 2 for light samples.
    TwiceForLights,
    /// The power is 0 for point lights and directional lights.
    NoneForPoints,
}

/// Use of the factor 1/π of the diffuse lobe in a student's path tracer.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub enum DiffusePi {
    /// The factor is always there, which is correct.
    #[default]
    Correct,
    /// The factor is missing everywhere.
    Missing,
    /// Light samples lack the factor.
    MissingForLights,
    /// Scattered light lacks the factor.
    MissingForScattered,
}

/// Strategies by which a student's path tracer finds lights.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub enum Strategies {
    /// Light samples and scattered rays with MIS weights, which is correct.
    #[default]
    Weighted,
    /// Light samples and scattered rays without weights.
    Unweighted,
    /// Only light samples, which is correct on its own.
    LightSamples,
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
    /// BSDF sampling about the z axis of world space, where directions below the surface end the
    /// path.
    LocalFrameAbove,
    /// BSDF sampling about the y axis of world space.
    AboutY,
    /// BSDF sampling about the y axis of world space, where directions below the surface end the
    /// path.
    AboutYAbove,
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
    /// The factor is 1 / d instead of 1 / d².
    DistanceOnce,
    /// The cosine at the light is omitted.
    Cosine,
    /// The area of the light is omitted.
    Area,
    /// The division by the probability of choosing the light is omitted.
    Choice,
    /// The light is chosen uniformly, and the division by the probability is omitted.
    UniformChoice,
    /// The light of point lights and directional lights lacks the factor π.
    PointPi,
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
    /// The component along the normal has the wrong sign.
    RootSign,
    /// The indices of both sides are exchanged, also in Fresnel's equations.
    Exchanged,
    /// Reflection and refraction are chosen with probability 1/2, which is not divided out.
    HalfChosen,
    /// The Fresnel term is used both for the choice and as a weight.
    FresnelTwice,
    /// All light is refracted.
    NoReflection,
}

/// Mistakes in a student's environment light.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub enum EnvironmentBug {
    /// There is no mistake: directions and pdf are correct.
    #[default]
    Correct,
    /// The environment is upside down.
    UpsideDown,
    /// The environment is mirrored left to right.
    Mirrored,
    /// The environment is turned by 180 degrees about the vertical axis.
    HalfTurned,
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
    /// Factor 1/π of the diffuse lobe.
    pub diffuse_pi: DiffusePi,
    /// Method for sampling scattered directions.
    pub direction_sampling: DirectionSampling,
    /// Factor that is omitted from light samples.
    pub missing_factor: MissingFactor,
    /// Strategies by which lights are found.
    pub strategies: Strategies,
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
    /// Perfect mirrors do not colour the light.
    pub colorless_mirrors: bool,
    /// Surfaces that paths hit after a mirror or glass do not emit.
    pub no_emission_after_delta: bool,
    /// Textures are upside down.
    pub flipped_textures: bool,
    /// Method for computing a pixel from its samples.
    pub pixel_mean: PixelMean,
}
