//! Mistakes in checkerboards and noise.

use super::{Mistake, Values, row};
use crate::mistakes::bugs::{Cells, NoiseShare, Octaves, PatternSpace, Veins};

/// Common mistakes in checkerboards and noise.
pub(super) const MISTAKES: &[Mistake] = &[
    row(
        "pattern-exchanged",
        "flat",
        "the two materials of patterns are swapped",
        "even cells, or a high share: the first material",
        "even cells, or a high share: the second material",
        |v, _| v.bugs.colors.exchanged = true,
    ),
    row(
        "pattern-space",
        "transforms",
        "patterns are evaluated {in world space: their transform is ignored|with the inverse of their transform|in the \
         space of the object that is hit}",
        "p' = M p",
        "{p' = p|p' = M^-1 p|p' = M (the hit in object space)}",
        |v, how| {
            v.bugs.colors.space =
                [PatternSpace::World, PatternSpace::Inverse, PatternSpace::Object][(how as usize).min(2)];
        },
    )
    .with(Values::Only(&[0.0, 1.0, 2.0])),
    row(
        "checkerboard-truncated",
        "flat",
        "coordinates of checkerboards are {truncated instead of rounded down, so the cells around 0 are twice as \
         wide|rounded instead of rounded down}",
        "floor(x) + floor(y) + floor(z)",
        "{(int) x + (int) y + (int) z|round(x) + round(y) + round(z)}",
        |v, how| v.bugs.colors.cells = if how == 0.0 { Cells::Truncated } else { Cells::Rounded },
    )
    .with(Values::Only(&[0.0, 1.0])),
    row(
        "checkerboard-remainder",
        "flat",
        "cells of checkerboards with a negative sum all count as even",
        "sum % 2 != 0",
        "sum % 2 == 1, which is -1 for negative sums",
        |v, _| v.bugs.colors.cells = Cells::SignedRemainder,
    ),
    row(
        "checkerboard-axes",
        "flat",
        "checkerboards use only {y and z|x and z|x and y|x|y|z}",
        "floor(x) + floor(y) + floor(z)",
        "floor of {y and z|x and z|x and y|x|y|z} only",
        |v, which| {
            let axis = which as usize % 3;
            v.bugs.colors.cells = if which < 3.0 { Cells::Without(axis) } else { Cells::Only(axis) };
        },
    )
    .with(Values::Only(&[0.0, 1.0, 2.0, 3.0, 4.0, 5.0])),
    row(
        "checkerboard-size",
        "flat",
        "cells of checkerboards are {half|twice} as large as they should be",
        "floor(x)",
        "floor({2 * x|x / 2})",
        |v, twice| v.bugs.colors.cells = Cells::Scaled(twice > 0.0),
    )
    .with(Values::Only(&[0.0, 1.0])),
    row(
        "octaves",
        "flat",
        "noise has {one octave too many|one octave too few|only one octave}",
        "for (i = 0; i < octaves; i++) N += noise(2^i p) / 2^i",
        "{i <= octaves|i < octaves - 1|N = noise(p)}",
        |v, how| v.bugs.colors.octaves = [Octaves::More, Octaves::Fewer, Octaves::One][(how as usize).min(2)],
    )
    .with(Values::Only(&[0.0, 1.0, 2.0])),
    row(
        "octave-weights",
        "flat",
        "in the sum of noise octaves {the amplitude is not halved|the frequency is not doubled|the amplitude is \
         quartered instead of halved|the absolute value of the noise is added|the first octave has twice the frequency}",
        "N += noise(2^i p) / 2^i",
        "N += {noise(2^i p)|noise(p) / 2^i|noise(2^i p) / 4^i|abs(noise(2^i p)) / 2^i|noise(2^i p) / 2^i, i from 1}",
        |v, how| {
            v.bugs.colors.octaves = [
                Octaves::FullWeights,
                Octaves::SameFrequency,
                Octaves::QuarterWeights,
                Octaves::Absolute,
                Octaves::SecondFirst,
            ][(how as usize).min(4)];
        },
    )
    .with(Values::Only(&[0.0, 1.0, 2.0, 3.0, 4.0])),
    row(
        "noise-share",
        "flat",
        "the share of noise materials is {N|(N + 1) / 2|the absolute value of N}",
        "share = N + 0.5",
        "share = {N|(N + 1) / 2|abs(N)}",
        |v, how| {
            v.bugs.colors.share =
                [NoiseShare::Bare, NoiseShare::Halved, NoiseShare::Absolute][(how as usize).min(2)];
        },
    )
    .with(Values::Only(&[0.0, 1.0, 2.0])),
    row(
        "veins",
        "flat",
        "in veins {the cosine is used instead of the sine|the sine is not mapped to the range from 0 to 1|the absolute \
         value of the sine is used|the frequency multiplies the noise too|the frequency also multiplies the point of \
         the noise|the noise is missing|the frequency is ignored|the amplitude is ignored}",
        "(sin(frequency * x + amplitude * N(p)) + 1) / 2",
        "{(cos(frequency * x + amplitude * N(p)) + 1) / 2|sin(frequency * x + amplitude * N(p))|abs(sin(frequency * x \
         + amplitude * N(p)))|(sin(frequency * (x + amplitude * N(p))) + 1) / 2|(sin(frequency * x + amplitude * \
         N(frequency * p)) + 1) / 2|(sin(frequency * x) + 1) / 2|(sin(x + amplitude * N(p)) + 1) / 2|(sin(frequency * \
         x + N(p)) + 1) / 2}",
        |v, how| {
            v.bugs.colors.veins = [
                Veins::Cosine,
                Veins::Unmapped,
                Veins::Absolute,
                Veins::AllScaled,
                Veins::PointScaled,
                Veins::Undistorted,
                Veins::NoFrequency,
                Veins::NoAmplitude,
            ][(how as usize).min(7)];
        },
    )
    .with(Values::Only(&[0.0, 1.0, 2.0, 3.0, 4.0, 5.0, 6.0, 7.0])),
    row(
        "veins-axis",
        "flat",
        "veins run across another axis: {|y instead of x, and rings about z instead of y|z instead of x, and rings \
         about x instead of y}",
        "marble by x; rings of wood by sqrt(x^2 + z^2)",
        "another coordinate",
        |v, axis| v.bugs.colors.axis = axis as usize,
    )
    .with(Values::Only(&[1.0, 2.0])),
];
