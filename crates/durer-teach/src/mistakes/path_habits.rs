//! Deviations of a path tracer from a correct one.

/// Factor of the cosine at a surface.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub enum Slant {
    /// cos.
    #[default]
    Right,
    /// Left out.
    None,
    /// cos².
    Twice,
}

/// Choice of scattered directions.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub enum Chosen {
    /// BSDF sampling, divided by the pdf.
    #[default]
    Right,
    /// BSDF sampling, not divided by the pdf.
    Undivided,
    /// Uniform over the hemisphere, divided by the pdf of cosine sampling.
    Uniform,
    /// BSDF sampling, with local coordinates used as world space.
    LocalFrame,
    /// BSDF sampling, with one random number for both dimensions.
    OneNumber,
}

/// Factor of a light sample that is left out.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub enum Lacks {
    /// None.
    #[default]
    Nothing,
    /// 1 / d².
    Distance,
    /// The cosine at the light.
    Cosine,
    /// The light's area.
    Area,
    /// The division by the probability of choosing the light.
    Choice,
    /// The division by the pdf.
    Density,
}

/// Directions of the environment.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub enum Sky {
    /// As written.
    #[default]
    Right,
    /// Upside down.
    UpsideDown,
    /// Its pdf lacks the sine of the polar angle.
    NoSine,
}

/// Value of a pixel from its samples.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub enum Mean {
    /// The mean of light.
    #[default]
    Light,
    /// The mean of clamped light.
    Clamped,
    /// The mean of display values.
    Shown,
}

/// Deviations of a path tracer. The default is a correct one.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct Paths {
    /// Cosine at surfaces.
    pub slant: Slant,
    /// The diffuse lobe lacks 1/π; with `true`, only for light samples.
    pub no_pi: Option<bool>,
    /// Scattered directions.
    pub chosen: Chosen,
    /// Light samples.
    pub lacks: Lacks,
    /// Both sampling strategies count in full.
    pub unweighted: bool,
    /// Paths that survive Russian roulette are not divided by the survival probability.
    pub roulette: bool,
    /// Emitters emit on both sides.
    pub two_sided: bool,
    /// Environment.
    pub sky: Sky,
    /// Value of a pixel.
    pub mean: Mean,
}
