//! False-colour pictures of luminance and illuminance with a legend. Lighting engineers use such
//! pictures.

use durer_scene::math::{Color, Vec3, fp};
use serde::{Deserialize, Serialize};

/// Range of luminance or illuminance that a false-colour picture shows on a linear or logarithmic
/// scale.
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize)]
pub struct FalseColorScale {
    /// Value that the first colour (dark blue) represents.
    pub low: f32,
    /// Value that the last colour (red) represents. It must be greater than `low`.
    pub high: f32,
    /// True for a logarithmic scale, which requires `low` > 0.
    pub logarithmic: bool,
}

/// Largest number of divisions of a legend.
const LEGEND_ROWS: usize = 8;

impl FalseColorScale {
    /// Returns a linear scale from 0 to the 98th percentile of the positive values, rounded up to a
    /// number of the legend. If the maximum were used, a visible emitter would leave almost no
    /// colours for the rest of the picture.
    pub fn from_values(values: impl Iterator<Item = f32>) -> Self {
        let mut all: Vec<f32> = values.filter(|value| value.is_finite() && *value > 0.0).collect();
        all.sort_by(f32::total_cmp);
        let high = all.get(all.len() * 49 / 50).copied().unwrap_or(1.0);
        let step = round_step(f64::from(high) / LEGEND_ROWS as f64);
        let high = (step * (f64::from(high) / step - 1e-6).ceil()) as f32;
        FalseColorScale { low: 0.0, high, logarithmic: false }
    }

    /// Returns the position of a value on the scale, from 0 to 1.
    pub fn position(&self, value: f32) -> f32 {
        let share = match self.logarithmic {
            true if value <= 0.0 => 0.0,
            true => fp::ln(value / self.low) / fp::ln(self.high / self.low),
            false => (value - self.low) / (self.high - self.low),
        };
        share.clamp(0.0, 1.0)
    }

    /// Returns the value at a position from 0 to 1, the inverse of [`FalseColorScale::position`].
    fn value(&self, place: f32) -> f32 {
        match self.logarithmic {
            true => self.low * fp::exp(place * fp::ln(self.high / self.low)),
            false => self.low + place * (self.high - self.low),
        }
    }

    /// Returns the false colour of a value.
    pub fn color(&self, value: f32) -> Color {
        const STEPS: [Vec3; 6] = [
            Vec3::new(0.02, 0.0, 0.12),
            Vec3::new(0.05, 0.1, 0.9),
            Vec3::new(0.0, 0.65, 0.75),
            Vec3::new(0.1, 0.8, 0.1),
            Vec3::new(1.0, 0.85, 0.0),
            Vec3::new(0.9, 0.02, 0.02),
        ];
        let place = self.position(value) * (STEPS.len() - 1) as f32;
        let step = (place as usize).min(STEPS.len() - 2);
        STEPS[step].lerp(STEPS[step + 1], place - step as f32)
    }

    /// Returns the number of divisions of the legend. If the range has such divisions, their limits
    /// are round numbers.
    fn rows(&self) -> usize {
        let range = f64::from(self.high - self.low);
        let rows = range / round_step(range / LEGEND_ROWS as f64);
        let is_round = !self.logarithmic && (rows - rows.round()).abs() < 1e-3 && rows >= 1.0;
        if is_round { rows.round() as usize } else { LEGEND_ROWS }
    }

    /// Draws a legend with numbers and a unit along the right edge of a picture, if the picture is
    /// large enough.
    pub fn draw_legend(&self, pixels: &mut [Color], width: usize, unit: &str) {
        let rows = self.rows();
        let height = pixels.len() / width.max(1);
        let labels: Vec<String> = (0..=rows).map(|i| number(self.value(1.0 - i as f32 / rows as f32))).collect();
        let longest = labels.iter().map(String::len).chain([unit.len()]).max().unwrap_or(0);
        // A glyph is three points wide and five points high, plus one point of spacing.
        let zoom = (height / 120).clamp(1, 8);
        let (bar, line) = (6 * zoom, 7 * zoom);
        let wide = bar + (4 * longest + 3) * zoom;
        if width < 2 * wide || height < (rows + 3) * line {
            return;
        }
        let (left, top, bottom) = (width - wide, 2 * line, height - line);
        for y in 0..height {
            for x in left..width {
                let in_bar = x < left + bar && (top..bottom).contains(&y);
                let place = 1.0 - (y.saturating_sub(top)) as f32 / (bottom - top) as f32;
                pixels[y * width + x] = if in_bar { self.color(self.value(place)) } else { Color::ZERO };
            }
        }
        let mut write = |text: &str, middle: usize| {
            for (i, letter) in text.chars().enumerate() {
                let (dots, x) = (glyph(letter), left + bar + (2 + 4 * i) * zoom);
                for (row, column) in (0..5 * zoom).flat_map(|row| (0..3 * zoom).map(move |column| (row, column))) {
                    let y = (middle + row).saturating_sub(5 * zoom / 2);
                    if dots[row / zoom] >> (2 - column / zoom) & 1 == 1 && y < height {
                        pixels[y * width + x + column] = Color::ONE;
                    }
                }
            }
        };
        write(unit, line / 2 + zoom);
        for (i, label) in labels.iter().enumerate() {
            write(label, top + i * (bottom - top) / rows);
        }
    }
}

/// Returns the smallest of 1, 2 and 5 times a power of ten that is at least `step`; 1 if `step` is
/// not positive.
pub fn round_step(step: f64) -> f64 {
    if step.is_nan() || step <= 0.0 {
        return 1.0;
    }
    let mut power = 1e-12;
    loop {
        for digit in [1.0, 2.0, 5.0] {
            if digit * power >= step * (1.0 - 1e-9) {
                return digit * power;
            }
        }
        power *= 10.0;
    }
}

/// Formats a number of the legend with three significant digits and without trailing zeros.
fn number(value: f32) -> String {
    let rounded = format!("{value:.2e}").parse::<f64>().unwrap_or(0.0);
    let text = if rounded != 0.0 && !(1e-3..1e7).contains(&rounded.abs()) {
        format!("{rounded:e}")
    } else {
        rounded.to_string()
    };
    text.to_lowercase()
}

/// Returns the five rows of a 3x5 glyph from top to bottom. Unknown characters are blank.
fn glyph(letter: char) -> [u8; 5] {
    match letter {
        '0' => [7, 5, 5, 5, 7],
        '1' => [2, 6, 2, 2, 7],
        '2' => [7, 1, 7, 4, 7],
        '3' => [7, 1, 7, 1, 7],
        '4' => [5, 5, 7, 1, 1],
        '5' => [7, 4, 7, 1, 7],
        '6' => [7, 4, 7, 5, 7],
        '7' => [7, 1, 1, 2, 2],
        '8' => [7, 5, 7, 5, 7],
        '9' => [7, 5, 7, 1, 7],
        '.' => [0, 0, 0, 0, 2],
        '-' => [0, 0, 7, 0, 0],
        '/' => [1, 1, 2, 4, 4],
        'c' => [0, 7, 4, 4, 7],
        'd' => [1, 1, 7, 5, 7],
        'e' => [7, 5, 7, 4, 7],
        'l' => [2, 2, 2, 2, 3],
        'm' => [0, 7, 7, 5, 5],
        'u' => [0, 5, 5, 5, 7],
        'x' => [0, 5, 2, 2, 5],
        _ => [0; 5],
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn positions_and_values_are_inverse() {
        for scale in [
            FalseColorScale::from_values([250.0].into_iter()),
            FalseColorScale { low: 0.5, high: 5e4, logarithmic: true },
        ] {
            for i in 0..=10 {
                let place = i as f32 / 10.0;
                assert!((scale.position(scale.value(place)) - place).abs() < 1e-5);
            }
            // Values outside the range get the colours at the ends of the range.
            assert_eq!(scale.color(-1.0), scale.color(scale.low));
            assert_eq!(scale.color(f32::INFINITY), scale.color(scale.high));
        }
        // All decades have the same length.
        let scale = FalseColorScale { low: 1.0, high: 1e4, logarithmic: true };
        assert!((scale.position(10.0) - 0.25).abs() < 1e-6 && (scale.position(100.0) - 0.5).abs() < 1e-6);
        assert_eq!(FalseColorScale::from_values([f32::NAN, 0.0].into_iter()).high, 1.0);
        assert_eq!(FalseColorScale::from_values((1..=100).map(|i| i as f32)).high, 100.0);
    }

    #[test]
    fn steps_are_round() {
        for (step, round) in [(250.0, 500.0), (0.3, 0.5), (1.0, 1.0), (2.1e6, 5e6), (0.0, 1.0), (f64::NAN, 1.0)] {
            assert!((round_step(step) / round - 1.0).abs() < 1e-6, "{step}: {}", round_step(step));
        }
    }

    #[test]
    fn legends_have_round_numbers() {
        for (value, high, rows) in
            [(30.7, 35.0, 7), (250.0, 250.0, 5), (0.099, 0.1, 5), (1000.0, 1000.0, 5), (8.1, 10.0, 5)]
        {
            let scale = FalseColorScale::from_values([value].into_iter());
            assert!(
                (scale.high / high - 1.0).abs() < 1e-6 && scale.rows() == rows,
                "{value}: {scale:?} {}",
                scale.rows()
            );
        }
        assert_eq!(FalseColorScale { low: 0.0, high: 5000.0, logarithmic: false }.rows(), 5);
        assert_eq!(FalseColorScale { low: 1.0, high: 1e4, logarithmic: true }.rows(), 8);
    }

    #[test]
    fn labels_have_three_digits() {
        for (value, text) in
            [(0.0, "0"), (12.5, "12.5"), (1234.0, "1230"), (0.0125, "0.0125"), (2.5e9, "2.5e9"), (1.0 / 3.0, "0.333")]
        {
            assert_eq!(number(value), text);
        }
    }

    #[test]
    fn scale_stays_at_the_border_and_skips_small_pictures() {
        let (width, height) = (320, 200);
        let mut pixels = vec![Color::splat(0.25); width * height];
        FalseColorScale::from_values([1000.0].into_iter()).draw_legend(&mut pixels, width, "cd/m2");
        let touched = |x: usize| (0..height).any(|y| pixels[y * width + x] != Color::splat(0.25));
        assert!(touched(width - 1) && touched(width - 20) && !touched(width / 2));
        // The colours of the bar go from red at the top to dark blue at the bottom.
        let column: Vec<Color> = (0..height).map(|y| pixels[y * width + width - 29]).collect();
        let scale = FalseColorScale::from_values([1.0].into_iter());
        assert!(column.iter().any(|color| (*color - scale.color(1.0)).length() < 0.05), "{column:?}");
        assert!(column.iter().any(|color| (*color - scale.color(0.0)).length() < 0.05));
        let mut small = vec![Color::splat(0.25); 40 * 30];
        FalseColorScale::from_values([1000.0].into_iter()).draw_legend(&mut small, 40, "lux");
        assert!(small.iter().all(|color| *color == Color::splat(0.25)));
    }
}
