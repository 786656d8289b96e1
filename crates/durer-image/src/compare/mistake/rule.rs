//! Rules, which are mistakes that affect every pixel of a picture.

use super::sample::{Sample, View};
use crate::compare::picture::{Scale, linear_to_srgb, srgb_to_linear};
use durer_bvh::math::{Vec3, fp};

/// Rotation or reflection of a picture that a common mistake causes, composed of an optional
/// transposition and optional mirroring of columns and rows.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Orientation {
    pub transpose: bool,
    pub flip_x: bool,
    pub flip_y: bool,
}

/// The seven rotations and reflections other than the identity.
pub const ORIENTATIONS: [Orientation; 7] = [
    orientation(false, true, false),
    orientation(false, false, true),
    orientation(false, true, true),
    orientation(true, false, false),
    orientation(true, true, false),
    orientation(true, false, true),
    orientation(true, true, true),
];

const fn orientation(transpose: bool, flip_x: bool, flip_y: bool) -> Orientation {
    Orientation { transpose, flip_x, flip_y }
}

impl Orientation {
    pub fn exchanges(self) -> bool {
        self.transpose
    }

    /// Returns the position in the reference of the pixel that moves to a given position.
    fn source(self, picture: &View, x: isize, y: isize) -> (isize, isize) {
        let x = if self.flip_x { picture.width as isize - 1 - x } else { x };
        let y = if self.flip_y { picture.height as isize - 1 - y } else { y };
        if self.transpose { (y, x) } else { (x, y) }
    }
}

/// A common mistake that affects every pixel, expressed as a rule that computes the wrong picture
/// from the reference.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum Rule {
    Reoriented(Orientation),
    /// Shift in pixels to the right and downwards.
    Shifted(isize, isize),
    /// Channel of the reference that each channel is taken from.
    Channels([usize; 3]),
    Grey,
    /// Flags for the channels in which black and white are exchanged.
    Inverted([bool; 3]),
    /// Inverts every channel except in black pixels.
    InvertedExceptBlack,
    GammaTwice,
    GammaMissing,
    Power(f32),
    /// Factor by which the stored values are multiplied.
    Factor(f32),
    /// Factor by which the linear light is multiplied.
    LightFactor(f32),
    Factors(Vec3),
    Added(f32),
    AddedEach(Vec3),
    /// Factor and offset of the values.
    Affine(f32, f32),
    Recolored(Vec3, Vec3),
    Blurred,
}

impl Rule {
    /// Returns the difference that remains at a pixel after this rule is applied.
    pub fn residual(&self, reference: &View, sample: &Sample) -> Vec3 {
        sample.test - self.pixel(reference, sample.x, sample.y)
    }

    /// Applies the rule to all pixels of the reference.
    pub fn apply(&self, reference: &View) -> Vec<Vec3> {
        let width = reference.width as isize;
        (0..reference.pixels.len() as isize).map(|i| self.pixel(reference, i % width, i / width)).collect()
    }

    /// Returns true if the rule determines the value of a pixel. After a shift, the pixels that
    /// come from outside the reference are not determined.
    pub fn determines(&self, picture: &View, x: isize, y: isize) -> bool {
        match *self {
            Rule::Shifted(dx, dy) => {
                (0..picture.width as isize).contains(&(x - dx)) && (0..picture.height as isize).contains(&(y - dy))
            }
            _ => true,
        }
    }

    /// Applies the rule to one pixel of the reference.
    fn pixel(&self, reference: &View, x: isize, y: isize) -> Vec3 {
        let value = reference.at(x, y);
        let scale = reference.scale;
        let value = match *self {
            Rule::Reoriented(orientation) => {
                let (x, y) = orientation.source(reference, x, y);
                reference.at(x, y)
            }
            // Pixels that come from outside the reference keep their values.
            Rule::Shifted(dx, dy) if self.determines(reference, x, y) => reference.at(x - dx, y - dy),
            Rule::Shifted(..) => value,
            Rule::Channels(order) => order.map(|channel| value[channel]).into(),
            Rule::Grey => Vec3::splat(value.dot(Vec3::new(0.299, 0.587, 0.114))),
            Rule::Inverted(which) => {
                Vec3::from(std::array::from_fn(|c| if which[c] { 1.0 - value[c] } else { value[c] }))
            }
            Rule::InvertedExceptBlack => {
                if value == Vec3::ZERO {
                    value
                } else {
                    1.0 - value
                }
            }
            Rule::GammaTwice => value.max(Vec3::ZERO).map(linear_to_srgb),
            Rule::GammaMissing => value.max(Vec3::ZERO).map(srgb_to_linear),
            Rule::Power(exponent) => value.max(Vec3::ZERO).map(|value| fp::pow(value, exponent)),
            Rule::Factor(factor) => value * factor,
            Rule::LightFactor(factor) => scale.encode(scale.decode(value) * factor),
            Rule::Factors(factors) => value * factors,
            Rule::Added(amount) => value + amount,
            Rule::AddedEach(amounts) => value + amounts,
            Rule::Affine(factor, amount) => value * factor + amount,
            Rule::Recolored(from, to) => {
                if same_color(value, from) {
                    to
                } else {
                    value
                }
            }
            Rule::Blurred => reference.blurred(x, y),
        };
        scale.clamp(value)
    }

    /// Returns true if the rule has parameters that were fitted to the pictures.
    pub fn is_fitted(&self) -> bool {
        use Rule::{Added, AddedEach, Affine, Factor, Factors, LightFactor, Power};
        matches!(self, Affine(..) | Power(_) | Factor(_) | LightFactor(_) | Factors(_) | Added(_) | AddedEach(_))
    }

    /// Keyword that identifies the rule.
    pub fn kind(&self) -> &'static str {
        match self {
            Rule::Reoriented(orientation) => match (orientation.transpose, orientation.flip_x, orientation.flip_y) {
                (false, true, false) => "mirrored",
                (false, false, true) => "upside-down",
                (true, false, false) | (true, true, true) => "transposed",
                _ => "turned",
            },
            Rule::Shifted(..) => "shifted",
            Rule::Channels(_) => "channels",
            Rule::Grey => "grey",
            Rule::Inverted(_) | Rule::InvertedExceptBlack => "inverted",
            Rule::GammaTwice => "gamma-once-more",
            Rule::GammaMissing => "gamma-once-less",
            Rule::Power(_) => "gamma",
            Rule::Factor(_) | Rule::LightFactor(_) | Rule::Factors(_) => "factor",
            Rule::Added(_) | Rule::AddedEach(_) => "added",
            Rule::Affine(..) => "range",
            Rule::Recolored(..) => "recoloured",
            Rule::Blurred => "blurred",
        }
    }
}

/// Returns true if two colours are equal apart from rounding.
pub fn same_color(a: Vec3, b: Vec3) -> bool {
    (a - b).abs().max_element() <= 1e-4
}

/// Returns true if a value is at either end of the scale, where it may have been clamped.
pub fn is_clamped(scale: Scale, value: f32) -> bool {
    value <= 0.0 || scale == Scale::Display && value >= 0.998
}
