//! Detection of mistakes that affect parts of a picture, where the location of the difference
//! indicates the cause.

use super::sample::{Sample, View};
use super::{Finding, MIN_EXPLAINED_PART, bytes, difference, flow};
use crate::compare::picture::Scale;
use durer_bvh::math::Vec3;

/// Function that detects one mistake in a part of the picture, given the reference, the picture,
/// and samples of both.
type Detector = fn(&View, &View, &[Sample]) -> Option<Finding>;
/// Function that converts a colour to the normal that it encodes.
type Decode = fn(Vec3) -> Vec3;

/// Minimum difference that counts as visible, which is slightly more than 1/255.
const VISIBLE: f32 = 1.5 / 255.0;
/// Minimum difference between neighbouring pixels that counts as an edge.
const EDGE: f32 = 0.08;
/// Minimum share of the difference at edges that mixtures of neighbouring colours must explain.
const MIXED: f64 = 0.95;
/// Maximum ratio between the squared differences of neighbouring pixels in an antialiased picture
/// and those in the other picture. If edges lie at random positions within pixels, the expected
/// ratio is two thirds.
const SMOOTHER: f64 = 0.85;

/// Maximum share of the difference in pixels whose neighbours differ alike. Other sample positions
/// change only narrow lines.
const MAX_INSIDE: f64 = 0.25;
/// If less than one in this number of pixels at edges differs, the cause is rounding.
const MIN_CHANGED_EDGES: usize = 40;
/// Minimum share of the difference in pixels whose colours also occur near them in the reference.
const MIN_FROM_REFERENCE: f64 = 0.5;

/// Detects that one of the pictures has a single colour.
pub fn blank(reference: &View, test: &View) -> Option<Finding> {
    let one_color = |picture: &View| picture.pixels.iter().all(|&pixel| pixel == picture.pixels[0]);
    let what = |color: Vec3| {
        let [r, g, b] = bytes(color);
        if color == Vec3::ZERO { "black everywhere".into() } else { format!("of one colour, ({r}, {g}, {b})") }
    };
    let words = match (one_color(reference), one_color(test)) {
        (false, true) => format!("the picture is {}, but the reference is not", what(test.pixels[0])),
        (true, false) => format!("the reference is {}, but the picture is not", what(reference.pixels[0])),
        _ => return None,
    };
    Some(Finding { kind: "blank", description: words, explained: 1.0 })
}

/// Finds the part of a picture that explains nearly all of the difference.
pub fn finding(reference: &View, test: &View, samples: &[Sample]) -> Option<Finding> {
    let all: [Detector; 7] = [clamped_normals, unnormalized_normals, saturated, speckles, edges, noise, shaded];
    all.iter().find_map(|part| part(reference, test, samples).filter(|finding| finding.explained >= MIN_EXPLAINED_PART))
}

/// Finds samples whose colours in the reference encode unit vectors, either as absolute values or
/// mapped from [-1, 1] to [0, 1]. Returns the decoding function and the samples.
fn unit_vectors(samples: &[Sample]) -> Option<(Decode, Vec<&Sample>)> {
    let decodings: [Decode; 2] = [|color| color, |color| 2.0 * color - 1.0];
    decodings.into_iter().find_map(|decode| {
        let unit: Vec<&Sample> =
            samples.iter().filter(|s| (decode(s.reference).length() - 1.0).abs() < 0.015).collect();
        // All other samples are treated as background. Pure red, green, or blue could be unit
        // vectors by chance, so other colours are required as well.
        let objects = samples.iter().filter(|s| s.reference != Vec3::ZERO).count();
        let mixed = unit.iter().filter(|s| s.reference.max_element() < 0.98).count();
        (3 * unit.len() > objects && 4 * mixed > unit.len() && !unit.is_empty()).then_some((decode, unit))
    })
}

/// Detects normals whose negative components were clamped instead of being made positive.
fn clamped_normals(_: &View, _: &View, samples: &[Sample]) -> Option<Finding> {
    let (_, unit) = unit_vectors(samples)?;
    let cut = |s: &Sample| Vec3::from(std::array::from_fn(|c| if s.test[c] == 0.0 { 0.0 } else { s.reference[c] }));
    let rest: f64 = samples.iter().map(|s| f64::from((s.test - cut(s)).length_squared())).sum();
    // A black pixel can have any cause, but a single missing component is evidence for this
    // mistake.
    let some = |s: &&&Sample| cut(s) != s.reference && s.test != Vec3::ZERO;
    let explained = 1.0 - rest / difference(samples);
    let words = "components of the normals that should be positive are 0, because negative values are clamped (take \
                 absolute values instead)";
    (unit.iter().filter(some).count() * 20 > unit.len()).then(|| Finding {
        kind: "normals-cut-off",
        description: words.into(),
        explained,
    })
}

/// Detects normals that have the right direction but not a length of 1.
fn unnormalized_normals(_: &View, _: &View, samples: &[Sample]) -> Option<Finding> {
    let (decode, unit) = unit_vectors(samples)?;
    let encode = |vector: Vec3| if decode(Vec3::ZERO) == Vec3::ZERO { vector } else { 0.5 * vector + 0.5 };
    let wrong = unit.iter().filter(|s| (decode(s.test).length() - 1.0).abs() > 0.03).count();
    let rest = |s: &&Sample| {
        let scaled = encode(decode(s.reference) * decode(s.test).length()).clamp(Vec3::ZERO, Vec3::ONE);
        f64::from((s.test - scaled).length_squared())
    };
    let unit_difference: f64 = unit.iter().map(|s| f64::from((s.test - s.reference).length_squared())).sum();
    let rest: f64 = unit.iter().map(rest).sum();
    let explained = (unit_difference - rest) / difference(samples);
    let words = "the normals have the right directions but not unit length, because they are not normalised";
    (20 * wrong > unit.len()).then(|| Finding { kind: "normals-not-normalised", description: words.into(), explained })
}

/// Detects differences that occur only where the reference is saturated.
fn saturated(reference: &View, _: &View, samples: &[Sample]) -> Option<Finding> {
    let (mut full, mut there, mut total) = (0, 0.0, 0.0);
    for sample in samples.iter().filter(|_| reference.scale == Scale::Display) {
        for channel in 0..3 {
            let difference = f64::from(sample.test[channel] - sample.reference[channel]);
            total += difference * difference;
            if sample.reference[channel] >= 0.998 {
                full += 1;
                there += difference * difference;
            }
        }
    }
    let words = "the pictures differ only where channels of the reference are saturated (255): values above 1 wrap \
                 around instead of being clamped";
    // A value that wraps around can end up anywhere, including at black.
    let wrapped = |s: &&Sample| (0..3).any(|c| s.reference[c] >= 0.998 && s.test[c] < 0.5);
    let some = samples.iter().filter(wrapped).count();
    (full > 0 && full < 2 * samples.len() && some * 12 > full).then(|| Finding {
        kind: "not-clamped",
        description: words.into(),
        explained: there / total,
    })
}

/// Returns true if a pixel and its neighbours differ strongly from each other.
fn at_edge(picture: &View, s: &Sample) -> bool {
    let around = (-1..=1).flat_map(|dy| (-1..=1).map(move |dx| (s.x + dx, s.y + dy)));
    let around = around.map(|(x, y)| picture.at(x, y));
    let (low, high) = around.fold((Vec3::INFINITY, Vec3::NEG_INFINITY), |(l, h), p| (l.min(p), h.max(p)));
    (high - low).max_element() > EDGE
}

/// Detects differences that occur only at edges and come from different sample positions or
/// different filtering.
fn edges(reference: &View, test: &View, samples: &[Sample]) -> Option<Finding> {
    edges_as("the pictures differ only at edges", reference, test, samples)
}

/// Detects what [`edges`] detects, beside another mistake.
pub fn remaining_edges(reference: &View, test: &View, samples: &[Sample]) -> Option<Finding> {
    edges_as("the edges differ as well", reference, test, samples)
}

/// Implements [`edges`]. `what` begins the description.
fn edges_as(what: &str, reference: &View, test: &View, samples: &[Sample]) -> Option<Finding> {
    let at_edges: Vec<Sample> = samples.iter().filter(|s| at_edge(reference, s) || at_edge(test, s)).copied().collect();
    let share = at_edges.len() as f64 / samples.len() as f64;
    let explained = difference(&at_edges) / difference(samples);
    // Smoothing divides one large step between neighbouring pixels into several small ones.
    let roughness = |picture: &View| -> f64 {
        let steps = |s: &Sample| {
            let here = picture.at(s.x, s.y);
            let (right, below) = (picture.at(s.x + 1, s.y) - here, picture.at(s.x, s.y + 1) - here);
            f64::from(right.length_squared() + below.length_squared())
        };
        at_edges.iter().map(steps).sum()
    };
    let (own, others) = (roughness(test), roughness(reference));
    // If edges are only sampled differently, brighter and darker pixels roughly balance. If an edge
    // has moved, they may not balance.
    let (sum, all) = at_edges.iter().fold((0.0, 0.0), |(sum, all), s| {
        let by = (s.test - s.reference).element_sum();
        (sum + by, all + by.abs())
    });
    let is_even = sum.abs() < 0.6 * all;
    // Other sample positions change many pixels at edges, but rounding changes only a few.
    let changed = at_edges.iter().filter(is_visible).count();
    if changed * MIN_CHANGED_EDGES < at_edges.len() {
        return None;
    }
    let cause = if others < SMOOTHER * own {
        // A single sample has a colour that is also near the edge in the reference, unlike noise.
        (is_even && from_reference(reference, &at_edges) > MIN_FROM_REFERENCE).then(|| {
            "the reference is antialiased there, but the picture is not (samples without effect, or no filter)".into()
        })
    } else if own < SMOOTHER * others {
        is_even.then(|| "the picture is antialiased there, but the reference is not (more samples, or a filter)".into())
    } else {
        let elsewhere =
            || is_even.then(|| "samples have other positions in the pixels, or are averaged differently".into());
        flow::cause(reference, &at_edges).or_else(elsewhere)
    }?;
    let words = format!("{what} ({:.1} % of the picture): {cause}", 100.0 * share);
    let is_mixed = mixed(reference, test, &at_edges) > MIXED;
    let is_narrow = inside(reference, test, &at_edges) < MAX_INSIDE;
    (share < 0.4 && is_mixed && is_narrow && has_equal_sides(reference, test, &at_edges)).then_some(Finding {
        kind: "edges",
        description: words,
        explained,
    })
}

/// Returns the share of the squared difference in pixels of the picture whose colours are in the
/// range of the surrounding pixels of the reference.
fn from_reference(reference: &View, at_edges: &[Sample]) -> f64 {
    let is_between = |s: &&Sample| {
        let around = (-2..=2).flat_map(|dy| (-2..=2).map(move |dx| reference.at(s.x + dx, s.y + dy)));
        let (low, high) = around.fold((Vec3::INFINITY, Vec3::NEG_INFINITY), |(l, h), p| (l.min(p), h.max(p)));
        s.test.cmpge(low - VISIBLE).all() && s.test.cmple(high + VISIBLE).all()
    };
    difference(&at_edges.iter().filter(is_between).copied().collect::<Vec<_>>()) / difference(at_edges).max(1e-12)
}

/// Returns the share of the squared difference in pixels whose colours lie between those of their
/// neighbours. Different sample positions cause such colours, but different shading does not.
fn mixed(reference: &View, test: &View, at_edges: &[Sample]) -> f64 {
    let between = |value: Vec3, picture: &View, s: &Sample| {
        let around = (-1..=1).flat_map(|dy| (-1..=1).map(move |dx| picture.at(s.x + dx, s.y + dy)));
        let (low, high) = around.fold((Vec3::INFINITY, Vec3::NEG_INFINITY), |(l, h), p| (l.min(p), h.max(p)));
        value.cmpge(low - VISIBLE).all() && value.cmple(high + VISIBLE).all()
    };
    let is_between = |s: &&Sample| between(s.test, reference, s) || between(s.reference, test, s);
    difference(&at_edges.iter().filter(is_between).copied().collect::<Vec<_>>()) / difference(at_edges).max(1e-12)
}

/// Returns the share of the squared difference in pixels that at most one neighbour differs from,
/// as in areas that are shaded differently.
fn inside(reference: &View, test: &View, at_edges: &[Sample]) -> f64 {
    let is_inside = |s: &&Sample| dissimilar_neighbours(reference, test, s) <= 1;
    difference(&at_edges.iter().filter(is_inside).copied().collect::<Vec<_>>()) / difference(at_edges).max(1e-12)
}

/// Returns true if the areas on both sides of the differing edges are equal in both pictures.
/// Objects that are so thin that all of their pixels lie at edges are ignored.
fn has_equal_sides(reference: &View, test: &View, at_edges: &[Sample]) -> bool {
    let differing: Vec<&Sample> = at_edges.iter().filter(is_visible).collect();
    let sides = |s: &&&Sample| {
        let around = (-3..=3).flat_map(|dy| (-3..=3).map(move |dx| Sample { x: s.x + dx, y: s.y + dy, ..***s }));
        let flat = around.filter(|place| !at_edge(reference, place) && !at_edge(test, place));
        let equal = flat.map(|place| (reference.at(place.x, place.y), test.at(place.x, place.y)));
        let equal = equal.filter(|(a, b)| (*a - *b).abs().max_element() <= VISIBLE).map(|(a, _)| a);
        let (low, high) = equal.fold((Vec3::INFINITY, Vec3::NEG_INFINITY), |(l, h), p| (l.min(p), h.max(p)));
        (high - low).max_element() > EDGE
    };
    differing.iter().filter(sides).count() * 8 > differing.len()
}

/// Returns how many of the eight neighbours of a pixel have a difference that is unlike the
/// difference of the pixel itself.
fn dissimilar_neighbours(reference: &View, test: &View, s: &Sample) -> usize {
    let own = s.test - s.reference;
    let around = (-1..=1).flat_map(|dy| (-1..=1).map(move |dx| (s.x + dx, s.y + dy)));
    around.filter(|&(x, y)| (test.at(x, y) - reference.at(x, y)).dot(own) < 0.5 * own.length_squared()).count()
}

fn is_visible(s: &&Sample) -> bool {
    (s.test - s.reference).abs().max_element() > VISIBLE
}

fn brighter(s: &Sample) -> bool {
    (s.test - s.reference).element_sum() > 0.0
}

/// Detects isolated pixels that are all darker or all brighter than in the reference.
fn speckles(reference: &View, test: &View, samples: &[Sample]) -> Option<Finding> {
    let visible: Vec<&Sample> = samples.iter().filter(is_visible).collect();
    // Ignore isolated pixels at edges, because they differ if an edge has moved.
    let alone =
        visible.iter().filter(|s| dissimilar_neighbours(reference, test, s) >= 7 && !at_edge(reference, s)).count();
    let share = visible.len() as f64 / samples.len() as f64;
    let (up, down): (Vec<Sample>, Vec<Sample>) = visible.iter().copied().copied().partition(brighter);
    let (kind, words, part) = if down.len() > up.len() {
        (
            "dark-speckles",
            "dark speckles: shadow acne, from rays that hit the surface on which they start (see the epsilon)",
            down,
        )
    } else {
        ("bright-speckles", "bright speckles: noise, or rays that miss objects they should hit", up)
    };
    let explained = difference(&part) / difference(samples);
    let words = format!("{:.1} % of the picture is {words}", 100.0 * share);
    (2 * alone > visible.len() && share < 0.5).then_some(Finding { kind, description: words, explained })
}

/// Detects differences that have no pattern.
fn noise(reference: &View, test: &View, samples: &[Sample]) -> Option<Finding> {
    let visible: Vec<&Sample> = samples.iter().filter(is_visible).collect();
    let alone: usize = visible.iter().map(|s| dissimilar_neighbours(reference, test, s)).sum();
    let explained = difference(&visible.iter().copied().copied().collect::<Vec<_>>()) / difference(samples);
    let words = "the pictures differ from pixel to pixel without a pattern: noise, from too few samples or other \
                 random numbers";
    // When the edges of a fine pattern move, the difference looks like noise, but real noise also
    // occurs away from edges.
    let smooth = visible.iter().filter(|s| !at_edge(reference, s)).count();
    (alone > 5 * visible.len() && 10 * visible.len() > samples.len() && 2 * smooth > visible.len()).then(|| Finding {
        kind: "noise",
        description: words.into(),
        explained,
    })
}

/// Fraction of the pixels below which other differences are not mentioned.
const MAX_EQUAL_SHARE: f64 = 0.001;

/// Detects parts of the picture that are darker or brighter while the rest is equal, or nearly so.
fn shaded(_: &View, _: &View, samples: &[Sample]) -> Option<Finding> {
    let total = difference(samples);
    // A pixel in which one channel is brighter and another darker has another colour.
    let all = |is: fn(f32) -> bool| {
        let uniform = move |s: &&Sample| (s.test - s.reference).to_array().into_iter().all(is);
        samples.iter().filter(is_visible).filter(uniform).copied().collect::<Vec<Sample>>()
    };
    let (bright, dark) = (all(|by| by > -VISIBLE), all(|by| by < VISIBLE));
    let up = difference(&bright) > difference(&dark);
    let part = if up { bright } else { dark };
    let explained = difference(&part) / total;
    if part.is_empty() || explained < MIN_EXPLAINED_PART {
        return None;
    }
    // Fit a single factor to the whole part.
    let (sum, squares) = part.iter().fold((0.0, 0.0), |(sum, squares), s| {
        (sum + f64::from(s.test.dot(s.reference)), squares + f64::from(s.reference.length_squared()))
    });
    let factor = if squares > 0.0 { (sum / squares) as f32 } else { 0.0 };
    let rest: f64 = part.iter().map(|s| f64::from((s.test - factor * s.reference).length_squared())).sum();
    let fits = squares > 0.0 && rest < (1.0 - MIN_EXPLAINED_PART) * total;
    let (kind, how) = match up {
        true => ("brighter-parts", "brighter"),
        false if fits && factor < 0.02 => ("black-parts", "black"),
        false => ("darker-parts", "darker"),
    };
    let by = if fits && kind != "black-parts" { format!(" by a mean factor of {factor:.3}") } else { String::new() };
    let share = part.len() as f64 / samples.len() as f64;
    // If nearly everything differs and no factor fits, the difference is not confined to a part of
    // the picture.
    if share > 0.75 && !fits {
        return None;
    }
    let others = samples.iter().filter(is_visible).count() - part.len();
    let rest = match others as f64 / samples.len() as f64 {
        share if share < MAX_EQUAL_SHARE => "the rest is equal".to_string(),
        share => format!("{:.1} % differs otherwise", 100.0 * share),
    };
    // Differences in shadows, lights, and highlights look like this, and so do missing rays, so the
    // description names no cause.
    let words = format!("{:.1} % of the picture is {how}{by}, and {rest}", 100.0 * share);
    Some(Finding { kind, description: words, explained })
}
