//! Drawing with sixels, which are columns of six pixels in one colour.
//!
//! The colours are a fixed set of 6 x 7 x 6 with ordered dithering. Libraries that choose the
//! colours for each picture need twenty crates, and the colours would change from pass to pass.

/// Levels of red, green and blue.
const LEVELS: [u32; 3] = [6, 7, 6];

/// Thresholds of ordered dithering. Source: Bayer, *An optimum method for two-level rendition of
/// continuous-tone pictures*, ICC 1973.
const BAYER: [[u32; 4]; 4] = [[0, 8, 2, 10], [12, 4, 14, 6], [3, 11, 1, 9], [15, 7, 13, 5]];

/// Encodes rows of pixels. Source: VT330/VT340 Programmer Reference Manual, volume 2, chapter 14.
pub fn encode(pixels: &[[u8; 3]], width: usize) -> Vec<u8> {
    let width = width.max(1);
    let height = pixels.len() / width;
    let mut text = format!("\x1bP0;1q\"1;1;{width};{height}");
    let numbers: Vec<u32> = pixels.iter().enumerate().map(|(i, &pixel)| number(pixel, i % width, i / width)).collect();
    for number in 0..LEVELS.iter().product() {
        let [r, g, b] = percent(number);
        text += &format!("#{number};2;{r};{g};{b}");
    }
    for band in numbers.chunks(6 * width) {
        let mut used: Vec<u32> = band.to_vec();
        used.sort_unstable();
        used.dedup();
        for color in used {
            text += &format!("#{color}");
            // Bit k of a sixel is the pixel in row k of the band.
            let sixel = |x: usize| {
                let rows = band.chunks(width).enumerate();
                63 + rows.map(|(k, row)| u8::from(row[x] == color) << k).sum::<u8>()
            };
            let mut x = 0;
            while x < width {
                let first = sixel(x);
                let count = (x..width).take_while(|&x| sixel(x) == first).count();
                match count {
                    1..=3 => (0..count).for_each(|_| text.push(char::from(first))),
                    _ => text += &format!("!{count}{}", char::from(first)),
                }
                x += count;
            }
            text.push('$');
        }
        text.push('-');
    }
    text += "\x1b\\";
    text.into_bytes()
}

/// Returns the number of the colour of a pixel in column `x` and row `y`.
fn number(pixel: [u8; 3], x: usize, y: usize) -> u32 {
    let threshold = 2 * BAYER[y % 4][x % 4] + 1;
    pixel.iter().zip(LEVELS).fold(0, |number, (&value, levels)| {
        // Round down after adding a threshold from 1/32 to 31/32 of a level.
        let level = (u32::from(value) * (levels - 1) * 32 + 255 * threshold) / (255 * 32);
        number * levels + level.min(levels - 1)
    })
}

/// Returns the red, green and blue values of a colour in percent.
fn percent(number: u32) -> [u32; 3] {
    let [_, green, blue] = LEVELS;
    let levels = [number / (green * blue), number / blue % green, number % blue];
    [0, 1, 2].map(|i| (100 * levels[i] + (LEVELS[i] - 1) / 2) / (LEVELS[i] - 1))
}
