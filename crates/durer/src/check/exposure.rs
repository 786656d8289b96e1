//! Pictures that are too bright, too dark, or of one colour; depths that are all black or all white.

use super::finding::{Finding, number, percent, vector};
use super::lights::{VISIBLE, color, place};
use super::scout::Scout;
use crate::diag::{Diagnostic, Severity};
use crate::math::Color;

/// Values beyond this are cut in eight bits; beyond the other, much of their shading is lost.
const BEYOND: f32 = 1.0 + VISIBLE;
const FAR_BEYOND: f32 = 1.25;
/// Where so large a share of what is seen is cut, or far beyond, it is more than highlights.
const MOST_CUT: f32 = 0.4;
const MOST_FAR: f32 = 0.2;

/// Values beyond 1 in a picture of eight bits.
pub(super) fn too_bright(scout: &Scout) -> Vec<Finding> {
    let lit: Vec<Color> = scout.seen().map(|(probe, _)| probe.color).filter(|color| color.is_finite()).collect();
    let far = lit.iter().filter(|color| color.max_element() > FAR_BEYOND).count();
    let cut = lit.iter().filter(|color| color.max_element() > BEYOND).count();
    let white = lit.iter().filter(|color| color.min_element() > BEYOND).count();
    let over = |count: usize, share: f32| count as f32 > share * lit.len() as f32;
    if !over(cut, MOST_CUT) && !over(far, MOST_FAR) {
        return Vec::new();
    }
    let brightest = lit.iter().copied().max_by(|a, b| a.max_element().total_cmp(&b.max_element())).unwrap_or_default();
    // Ambient light is left as it is, unless it alone is too much.
    let world = scout.world();
    let (most, ambient) = (brightest.max_element(), world.ambient.max_element().min(0.5));
    let factor = (1.0 - ambient) / (most - ambient).max(1e-6);
    let effect = format!(
        "{} of what is seen is cut at 1, and loses its shading; {} is white",
        percent(cut, lit.len()),
        percent(white, lit.len())
    );
    let mut diagnostic =
        Diagnostic::warning(format!("there is too much light: the brightest colour is {}", vector(brightest)))
            .effect(effect)
            .help(format!(
                "multiply the colours of the lights by {}, or write a picture that keeps them (.exr, .hdr)",
                number(factor)
            ));
    if let Some(cause) = super::colors::gives_too_much(scout) {
        let severity = if over(far, MOST_FAR) { Severity::Warning } else { Severity::Note };
        let diagnostic = Diagnostic { severity, effect: diagnostic.effect, ..cause };
        return vec![Finding::from(diagnostic).whole(cut * 2 > lit.len())];
    }
    for (i, light) in world.lights.iter().enumerate() {
        let Some(span) = place(scout, i) else { continue };
        let value = scout.value(span, &["color"]);
        diagnostic = diagnostic.fix_at(value, vector(color(light) * factor));
        diagnostic.span = diagnostic.span.or(value).or(Some(span));
    }
    if !over(far, MOST_FAR) {
        diagnostic.severity = Severity::Note;
    }
    vec![Finding::from(diagnostic).whole(cut * 2 > lit.len())]
}

/// A picture of one colour.
pub(super) fn one_color(scout: &Scout) -> Vec<Finding> {
    let shown = |color: Color| color.clamp(Color::ZERO, Color::ONE);
    let mut colors = scout.probes.iter().map(|probe| shown(probe.color));
    let Some(first) = colors.next().filter(|_| scout.probes.len() > 4) else { return Vec::new() };
    if !colors.all(|color| (color - first).abs().max_element() < VISIBLE) {
        return Vec::new();
    }
    let name = match (first.max_element() < VISIBLE, first.min_element() > 1.0 - VISIBLE) {
        (true, _) => "black".to_string(),
        (_, true) => "white".to_string(),
        _ => format!("of the one colour {}", vector(first)),
    };
    let empty = scout.seen().next().is_none();
    let diagnostic = Diagnostic::warning(format!("the whole picture is {name}"));
    let diagnostic = match empty {
        true => diagnostic.effect("every ray misses: it is the background"),
        false => diagnostic.effect("no shading is seen"),
    };
    vec![Finding::from(diagnostic.help("`durer explain SCENE --pixel X,Y` tells of what a pixel is made")).last()]
}

/// A picture that is nearly black where it is not background.
pub(super) fn too_dark(scout: &Scout) -> Vec<Finding> {
    let most = scout.seen().map(|(probe, _)| probe.color.max_element()).fold(0.0, f32::max);
    let lights = &scout.world().lights;
    if scout.seen().next().is_none() || most > 0.06 || lights.is_empty() {
        return Vec::new();
    }
    let diagnostic = Diagnostic::warning(format!("the brightest thing in the picture is {} only", number(most)))
        .effect("all that is seen is black, or nearly so")
        .help(format!("it takes about {} times as much light", number(0.8 / most.max(1e-4))));
    let diagnostic = match place(scout, 0) {
        Some(span) => scout.at_value(diagnostic, span, &["color"]),
        None => diagnostic,
    };
    vec![Finding::from(diagnostic).last()]
}

/// A range of depths beside all depths.
pub(super) fn depth_range(scout: &Scout) -> Vec<Finding> {
    let Some((min, max)) = scout.subject.job.depth_range else { return Vec::new() };
    let depths: Vec<f32> = scout.seen().map(|(_, seen)| seen.t).collect();
    let least = depths.iter().copied().fold(f32::INFINITY, f32::min);
    let most = depths.iter().copied().fold(f32::NEG_INFINITY, f32::max);
    let (low, high) = (min.min(max), min.max(max));
    if min > max {
        let turned = format!("{} {}", number(max), number(min));
        let message = format!("the range of depths goes backwards, from {} to {}", number(min), number(max));
        let help =
            format!("the nearer comes first: `--depth-range {turned}` (in the course's programs `-depth {turned}`)");
        let diagnostic = Diagnostic::warning(message).effect("near and far are exchanged in the picture of depths");
        return vec![Finding::from(diagnostic.help(help))];
    }
    let outside = depths.iter().filter(|t| **t <= low || **t >= high).count();
    // A range that is far too wide maps all depths to one grey.
    let flat = (most - least) < 0.02 * (high - low) && most > least;
    if depths.is_empty() || outside * 20 < depths.len() * 19 && !flat {
        return Vec::new();
    }
    let words = format!("depths in the picture go from {} to {}", number(least), number(most));
    let fitting = format!("{} {}", number(least), number(most));
    let diagnostic =
        Diagnostic::warning(format!("the range of depths, {} to {}, does not fit: {words}", number(min), number(max)))
            .effect(if flat {
                "the picture of depths is of nearly one grey"
            } else {
                "the picture of depths is all black or all white"
            })
            .help(format!("`--depth-range {fitting}` (in the course's programs `-depth {fitting}`) shows them"));
    vec![Finding::from(diagnostic).whole(true)]
}
