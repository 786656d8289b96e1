//! Small functions for drawings in SVG.

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
    use super::escape;

    #[test]
    fn texts_are_escaped() {
        assert_eq!(escape("<a&b>\u{1b}"), "&lt;a&amp;b&gt; ");
    }
}
