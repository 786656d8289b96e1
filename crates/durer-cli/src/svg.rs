//! Small functions for drawings in SVG.

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

/// Returns the beginning of a drawing with a white background. The sizes are in pixels, and `font`
/// is a family of fonts.
pub fn opening(width: f64, height: f64, font: &str) -> String {
    format!(
        "<svg xmlns=\"http://www.w3.org/2000/svg\" viewBox=\"0 0 {width} {height}\" width=\"{width}\" \
         height=\"{height}\" font-family=\"{font}\" font-size=\"13\">\n\
         <rect width=\"{width}\" height=\"{height}\" fill=\"white\"/>\n"
    )
}

/// Escapes text for SVG, and replaces control characters by spaces.
pub fn escape(text: &str) -> String {
    let visible = text.chars().map(|c| if c.is_control() { ' ' } else { c }).collect::<String>();
    visible.replace('&', "&amp;").replace('<', "&lt;").replace('>', "&gt;")
}

#[cfg(test)]
mod tests {
    use super::{escape, round_step};

    #[test]
    fn steps_are_round() {
        for (step, round) in [(250.0, 500.0), (0.3, 0.5), (1.0, 1.0), (2.1e6, 5e6), (0.0, 1.0), (f64::NAN, 1.0)] {
            assert!((round_step(step) / round - 1.0).abs() < 1e-6, "{step}: {}", round_step(step));
        }
        assert_eq!(escape("<a&b>\u{1b}"), "&lt;a&amp;b&gt; ");
    }
}
