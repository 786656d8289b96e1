//! Drawing of `durer explain --svg`.

use super::percentage;
use crate::svg::{escape, opening};
use durer::image::Transfer;
use durer::render::explain::{TextLine, number};

/// Height of a row, indentation of a level, side of a swatch, and width of a letter, in pixels.
const ROW: usize = 26;
const INDENT: usize = 24;
const SWATCH: usize = 16;
const LETTER: usize = 8;
/// Margin around the drawing, in pixels.
const MARGIN: usize = 12;

/// Draws the terms of an explanation as a tree in SVG. Each row shows the colour of a term, its
/// contribution, and its share of the pixel; lines connect a term with the terms of which it
/// consists. Details are left out.
pub fn tree_svg(lines: &[TextLine], transfer: Transfer) -> String {
    let rows: Vec<(&TextLine, String)> = lines.iter().filter_map(|line| Some((line, label(line)?))).collect();
    let right = rows.iter().map(|(line, text)| INDENT * line.depth + 2 * SWATCH + LETTER * text.chars().count());
    let (width, height) = (2 * MARGIN + right.max().unwrap_or(0), 2 * MARGIN + ROW * rows.len());
    let mut drawn = opening(width as f64, height as f64, "monospace");
    for (i, (line, text)) in rows.iter().enumerate() {
        let (x, y) = (MARGIN + INDENT * line.depth, MARGIN + ROW * i);
        if let Some(parent) = rows[..i].iter().rposition(|(other, _)| other.depth < line.depth) {
            let (from_x, from_y) =
                (MARGIN + INDENT * rows[parent].0.depth + SWATCH / 2, MARGIN + ROW * parent + SWATCH);
            let middle = y + SWATCH / 2;
            drawn += &format!("<path d=\"M{from_x} {from_y}V{middle}H{x}\" fill=\"none\" stroke=\"#999\"/>\n");
        }
        let [r, g, b] = transfer.encode_pixel(line.color);
        let (text_x, text_y) = (x + SWATCH + LETTER, y + SWATCH - 3);
        drawn += &format!(
            "<rect x=\"{x}\" y=\"{y}\" width=\"{SWATCH}\" height=\"{SWATCH}\" fill=\"rgb({r},{g},{b})\" \
             stroke=\"#999\"/>\n<text x=\"{text_x}\" y=\"{text_y}\" xml:space=\"preserve\">{}</text>\n",
            escape(text)
        );
    }
    drawn + "</svg>\n"
}

/// Returns the text of a term's row, or `None` for a detail.
fn label(line: &TextLine) -> Option<String> {
    if line.depth == 0 {
        return Some(line.text.clone());
    }
    let numbers: Vec<String> = line.adds?.numbers().iter().map(|x| number(*x)).collect();
    Some(format!("({})  {}  {}", numbers.join(", "), percentage(line.share), line.text))
}

#[cfg(test)]
mod tests {
    use super::*;
    use durer::integrator::trace::TermValue;
    use durer::math::Color;

    #[test]
    fn terms_are_rows_and_details_are_left_out() {
        let line = |depth, adds: Option<f32>, text: &str| TextLine {
            depth,
            adds: adds.map(|x| TermValue::from(Color::splat(x))),
            color: Color::ONE,
            share: 0.5,
            text: text.into(),
        };
        let lines = [
            line(0, None, "pixel <1,2>"),
            line(1, Some(1.0), "camera ray"),
            line(2, None, "hits"),
            line(2, Some(0.5), "ambient"),
        ];
        let drawn = tree_svg(&lines, Transfer::default());
        assert_eq!((drawn.matches("<text").count(), drawn.matches("<path").count()), (3, 2));
        assert!(drawn.contains("pixel &lt;1,2&gt;") && drawn.contains("50 %") && !drawn.contains("hits"), "{drawn}");
    }
}
