//! Text descriptions of rules.

use super::bytes;
use super::rule::Rule;

/// Describes how a rule changes the picture.
pub fn of(rule: &Rule) -> String {
    match *rule {
        Rule::Reoriented(orientation) => match (orientation.transpose, orientation.flip_x, orientation.flip_y) {
            (false, true, false) => "the picture is mirrored left to right",
            (false, false, true) => "the picture is upside down, mirrored top to bottom",
            (false, ..) => "the picture is rotated by 180 degrees",
            (true, true, false) => "the picture is rotated by 90 degrees clockwise",
            (true, false, true) => "the picture is rotated by 90 degrees counter-clockwise",
            (true, false, false) => "columns and rows are swapped",
            (true, true, true) => "columns and rows are swapped, and both are reversed",
        }
        .into(),
        Rule::Shifted(dx, dy) => {
            let way = |d: isize, back: &str, on: &str| {
                let count = d.unsigned_abs();
                let plural = if count == 1 { "" } else { "s" };
                (d != 0).then(|| format!("{count} pixel{plural} {}", if d < 0 { back } else { on }))
            };
            let ways: Vec<String> =
                [way(dx, "to the left", "to the right"), way(dy, "up", "down")].into_iter().flatten().collect();
            format!("the picture is shifted by {}", ways.join(" and "))
        }
        Rule::Channels([2, 1, 0]) => "red and blue are swapped (BGR instead of RGB)".into(),
        Rule::Channels([0, 2, 1]) => "green and blue are swapped".into(),
        Rule::Channels([1, 0, 2]) => "red and green are swapped".into(),
        Rule::Channels(order) => {
            let [r, g, b] = order.map(|channel| ["red", "green", "blue"][channel]);
            format!("the red, green and blue channels are the reference's {r}, {g} and {b}")
        }
        Rule::Grey => "the picture is a greyscale version of the reference".into(),
        Rule::Inverted([true, true, true]) => {
            "the picture is inverted: black and white are swapped (a reversed depth range, or negated normals)".into()
        }
        Rule::Inverted(which) => {
            let names = ["red (x)", "green (y)", "blue (z)"];
            let names: Vec<&str> = (0..3).filter(|&c| which[c]).map(|c| names[c]).collect();
            format!("{} inverted: an axis points in the opposite direction", joined(&names))
        }
        Rule::InvertedExceptBlack => {
            "the picture is inverted where the reference is not black (a reversed depth range: near and far are \
             swapped)"
                .into()
        }
        Rule::GammaTwice => "the sRGB curve (gamma) is applied once too often, so the values are too bright".into(),
        Rule::GammaMissing => "the sRGB curve (gamma) is missing once, so the values are too dark".into(),
        Rule::Power(exponent) => {
            format!("each value is the reference's to the power of {exponent:.2}: a different gamma")
        }
        Rule::Factor(factor) => format!("the picture is {} by a factor of {factor:.3}", brightness(factor > 1.0)),
        Rule::LightFactor(factor) => {
            format!("the light is {} by a factor of {factor:.3} (before the sRGB curve)", brightness(factor > 1.0))
        }
        Rule::Factors(factors) => {
            let [r, g, b] = factors.to_array();
            format!("the red, green and blue channels are the reference's times {r:.3}, {g:.3} and {b:.3}")
        }
        Rule::Added(amount) => {
            let size = amount.abs();
            format!("the picture is {} by {size:.4} ({:.1}/255) everywhere", brightness(amount > 0.0), size * 255.0)
        }
        Rule::AddedEach(amounts) => {
            let [r, g, b] = amounts.to_array();
            format!("{r:+.4}, {g:+.4} and {b:+.4} are added to the red, green and blue channels")
        }
        Rule::Affine(factor, amount) if factor < 0.0 => format!(
            "each value is {factor:.3} times the reference's, plus {amount:.3}: black and white are swapped, and the \
             range differs"
        ),
        Rule::Affine(factor, amount) => {
            format!(
                "each value is {factor:.3} times the reference's, plus {amount:.3}: a different range is mapped to \
                 black and white"
            )
        }
        Rule::Recolored(from, to) => {
            let ([r, g, b], [r2, g2, b2]) = (bytes(from), bytes(to));
            format!(
                "the reference's colour ({r}, {g}, {b}), perhaps its background, is ({r2}, {g2}, {b2}) in the \
                 picture"
            )
        }
        Rule::Blurred => "the picture is blurred: each pixel is averaged with its neighbours".into(),
    }
}

fn brightness(more: bool) -> &'static str {
    if more { "brighter" } else { "darker" }
}

fn joined(names: &[&str]) -> String {
    match names {
        [one] => format!("{one} is"),
        [first @ .., last] => format!("{} and {last} are", first.join(", ")),
        [] => String::new(),
    }
}
