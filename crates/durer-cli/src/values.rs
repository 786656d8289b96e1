//! Parsers for option values.

/// Parses a minimum throughput, which is a number of at least 0.
pub fn weight(text: &str) -> Result<f32, String> {
    text.parse().ok().filter(|w: &f32| w.is_finite() && *w >= 0.0).ok_or_else(|| "expected a number, 0 or more".into())
}

/// Parses a pixel position, which consists of a column and a row.
pub fn pixel(text: &str) -> Result<(u32, u32), String> {
    let numbers = text.split_once(',').and_then(|(x, y)| Some((x.trim().parse().ok()?, y.trim().parse().ok()?)));
    numbers.ok_or_else(|| "expected a column and a row, counted from the upper left corner, for example 200,150".into())
}

/// Parses a tolerance, which is a number of at least 0 or a fraction such as 2/255.
pub fn tolerance(text: &str) -> Result<f32, String> {
    let value: Option<f32> = match text.split_once('/') {
        Some((n, of)) => n.trim().parse().ok().zip(of.trim().parse::<f32>().ok()).map(|(n, of): (f32, f32)| n / of),
        None => text.parse().ok(),
    };
    value
        .filter(|t| t.is_finite() && *t >= 0.0)
        .ok_or_else(|| "expected a number, 0 or more, or a fraction, for example 2/255".into())
}

/// Parses a percentage.
pub fn percent(text: &str) -> Result<f64, String> {
    text.trim_end_matches('%')
        .parse()
        .ok()
        .filter(|p| (0.0..=100.0).contains(p))
        .ok_or_else(|| "expected a number from 0 to 100".into())
}
