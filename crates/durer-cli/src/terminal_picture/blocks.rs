//! Drawing with the character `▀`: its foreground is the upper pixel, and its background the lower.

/// Levels of a channel in the 6 x 6 x 6 colours of terminals with 256 colours.
const LEVELS: [u8; 6] = [0, 95, 135, 175, 215, 255];

/// Encodes rows of pixels, two per row of text.
pub fn encode(pixels: &[[u8; 3]], width: usize, true_color: bool) -> Vec<u8> {
    let mut text = String::new();
    let color = |ground: u8, pixel: [u8; 3]| match true_color {
        true => format!("\x1b[{ground};2;{};{};{}m", pixel[0], pixel[1], pixel[2]),
        false => format!("\x1b[{ground};5;{}m", index(pixel)),
    };
    let rows: Vec<&[[u8; 3]]> = pixels.chunks(width.max(1)).collect();
    for pair in rows.chunks(2) {
        let mut last = None;
        for (x, &upper) in pair[0].iter().enumerate() {
            let lower = pair.get(1).map(|row| row[x]);
            if last != Some((upper, lower)) {
                text += &color(38, upper);
                text += &lower.map_or("\x1b[49m".into(), |lower| color(48, lower));
                last = Some((upper, lower));
            }
            text.push('▀');
        }
        text += "\x1b[0m\r\n";
    }
    text.into_bytes()
}

/// Returns the number of the colour nearest to a pixel among the 6 x 6 x 6 colours and the 24
/// greys.
fn index([r, g, b]: [u8; 3]) -> u8 {
    let distance = |a: [u8; 3]| -> u32 { [r, g, b].iter().zip(a).map(|(&x, y)| u32::from(x.abs_diff(y)).pow(2)).sum() };
    let level = |x: u8| (0..6).min_by_key(|&i: &u8| LEVELS[usize::from(i)].abs_diff(x)).unwrap_or(0);
    let (i, j, k) = (level(r), level(g), level(b));
    let cube = (16 + 36 * i + 6 * j + k, [i, j, k].map(|i| LEVELS[usize::from(i)]));
    let mean = ((u16::from(r) + u16::from(g) + u16::from(b)) / 3) as u8;
    let grey = (mean.saturating_sub(3) / 10).min(23);
    let grey = (232 + grey, [8 + 10 * grey; 3]);
    if distance(grey.1) < distance(cube.1) { grey.0 } else { cube.0 }
}
