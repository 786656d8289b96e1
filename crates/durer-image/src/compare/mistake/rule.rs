//! Mistakes that are made everywhere in a picture by one rule.

use super::sample::{Sample, View};
use crate::compare::picture::{Scale, linear_to_srgb, srgb_to_linear};
use durer_bvh::math::{Vec3, fp};

/// Which of columns and rows run backwards, and whether they are exchanged first.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Turn {
    pub exchange: bool,
    pub columns_back: bool,
    pub rows_back: bool,
}

/// All of them but the one that changes nothing.
pub const TURNS: [Turn; 7] = [
    turn(false, true, false),
    turn(false, false, true),
    turn(false, true, true),
    turn(true, false, false),
    turn(true, true, false),
    turn(true, false, true),
    turn(true, true, true),
];

const fn turn(exchange: bool, columns_back: bool, rows_back: bool) -> Turn {
    Turn { exchange, columns_back, rows_back }
}

impl Turn {
    pub fn exchanges(self) -> bool {
        self.exchange
    }

    /// The pixel of the reference that comes to a place.
    fn source(self, picture: &View, x: isize, y: isize) -> (isize, isize) {
        let x = if self.columns_back { picture.width as isize - 1 - x } else { x };
        let y = if self.rows_back { picture.height as isize - 1 - y } else { y };
        if self.exchange { (y, x) } else { (x, y) }
    }
}

/// A rule that makes a mistake of a reference.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum Rule {
    Turned(Turn),
    /// Pixels to the right and down.
    Shifted(isize, isize),
    /// For each channel the one of the reference that it shows.
    Channels([usize; 3]),
    Grey,
    /// Channels of which black and white are exchanged.
    Inverted([bool; 3]),
    /// All channels, but black stays black.
    ThingsInverted,
    CurveOnceMore,
    CurveOnceLess,
    Power(f32),
    /// Of the stored values.
    Factor(f32),
    /// Of the light that the values stand for.
    LightFactor(f32),
    Factors(Vec3),
    Added(f32),
    AddedEach(Vec3),
    /// A factor, and what is added after it.
    Affine(f32, f32),
    Recolored(Vec3, Vec3),
    Blurred,
}

impl Rule {
    /// What this rule leaves of the difference at a pixel.
    pub fn rest(&self, reference: &View, sample: &Sample) -> Vec3 {
        sample.test - self.pixel(reference, sample.x, sample.y)
    }

    /// The reference with this mistake.
    pub fn made(&self, reference: &View) -> Vec<Vec3> {
        let width = reference.width as isize;
        (0..reference.pixels.len() as isize).map(|i| self.pixel(reference, i % width, i / width)).collect()
    }

    /// A pixel of the reference with this mistake.
    fn pixel(&self, reference: &View, x: isize, y: isize) -> Vec3 {
        let value = reference.at(x, y);
        let scale = reference.scale;
        let made = match *self {
            Rule::Turned(turn) => {
                let (x, y) = turn.source(reference, x, y);
                reference.at(x, y)
            }
            Rule::Shifted(dx, dy) => {
                let inside = (0..reference.width as isize).contains(&(x - dx))
                    && (0..reference.height as isize).contains(&(y - dy));
                // Nothing is known of what comes in over the edge.
                if inside { reference.at(x - dx, y - dy) } else { value }
            }
            Rule::Channels(order) => order.map(|channel| value[channel]).into(),
            Rule::Grey => Vec3::splat(value.dot(Vec3::new(0.299, 0.587, 0.114))),
            Rule::Inverted(which) => {
                Vec3::from(std::array::from_fn(|c| if which[c] { 1.0 - value[c] } else { value[c] }))
            }
            Rule::ThingsInverted => {
                if value == Vec3::ZERO {
                    value
                } else {
                    1.0 - value
                }
            }
            Rule::CurveOnceMore => value.max(Vec3::ZERO).map(linear_to_srgb),
            Rule::CurveOnceLess => value.max(Vec3::ZERO).map(srgb_to_linear),
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
        scale.clamp(made)
    }

    /// Whether pixels come to other places.
    pub fn moves(&self) -> bool {
        matches!(self, Rule::Turned(_) | Rule::Shifted(..))
    }

    /// Whether it has numbers that were fitted to the pictures.
    pub fn is_fitted(&self) -> bool {
        use Rule::{Added, AddedEach, Affine, Factor, Factors, LightFactor, Power};
        matches!(self, Affine(..) | Power(_) | Factor(_) | LightFactor(_) | Factors(_) | Added(_) | AddedEach(_))
    }

    /// Its keyword.
    pub fn kind(&self) -> &'static str {
        match self {
            Rule::Turned(turn) => match (turn.exchange, turn.columns_back, turn.rows_back) {
                (false, true, false) => "mirrored",
                (false, false, true) => "upside-down",
                (true, false, false) | (true, true, true) => "transposed",
                _ => "turned",
            },
            Rule::Shifted(..) => "shifted",
            Rule::Channels(_) => "channels",
            Rule::Grey => "grey",
            Rule::Inverted(_) | Rule::ThingsInverted => "inverted",
            Rule::CurveOnceMore => "gamma-once-more",
            Rule::CurveOnceLess => "gamma-once-less",
            Rule::Power(_) => "gamma",
            Rule::Factor(_) | Rule::LightFactor(_) | Rule::Factors(_) => "factor",
            Rule::Added(_) | Rule::AddedEach(_) => "added",
            Rule::Affine(..) => "range",
            Rule::Recolored(..) => "recoloured",
            Rule::Blurred => "blurred",
        }
    }
}

/// Whether two colours are equal but for rounding.
pub fn same_color(a: Vec3, b: Vec3) -> bool {
    (a - b).abs().max_element() <= 1e-4
}

/// Whether a channel's value is cut off at an end of the scale, so that what it was is not known.
pub fn cut_off(scale: Scale, value: f32) -> bool {
    value <= 0.0 || scale == Scale::Display && value >= 0.998
}
