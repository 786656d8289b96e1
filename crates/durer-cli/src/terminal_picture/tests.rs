use super::protocol::{Size, Terminal, USUAL, by_environment, has_sixel, iterm, kitty};
use super::{Graphics, blocks, shrink, sixel};
use base64::prelude::{BASE64_STANDARD, Engine};
use durer::image::{Image, Layer};
use durer::math::Vec3;

fn terminal(graphics: Graphics, size: Size) -> Terminal {
    Terminal { graphics, true_color: true, size }
}

#[test]
fn pictures_fit_into_the_terminal() {
    for (size, graphics, picture, expected) in [
        // 640 x 480 pixels are 80 x 30 cells of 8 x 16, but only 22 rows are free.
        (USUAL, Graphics::Sixel, (640, 480), (59, 22)),
        (USUAL, Graphics::Kitty, (64, 48), (8, 3)),
        (USUAL, Graphics::Blocks, (640, 480), (59, 22)),
        (USUAL, Graphics::Blocks, (4000, 10), (80, 1)),
        (Size { columns: 1, rows: 1, cell: (0, 0) }, Graphics::Sixel, (300, 200), (1, 1)),
        (Size { columns: 300, rows: 100, cell: (10, 20) }, Graphics::Iterm, (1280, 720), (128, 36)),
    ] {
        let (width, height) = picture;
        assert_eq!(terminal(graphics, size).cells(width, height), expected, "{size:?} {graphics:?} {picture:?}");
    }
}

#[test]
fn shrunken_pixels_are_means() {
    let image = Image::from_pixels(5, 3, (0..15).map(|i| Vec3::splat(i as f32)).collect()).unwrap();
    let layer = Layer::color("color", image).with_coverage((0..15).map(|i| (i % 2) as f32).collect());
    let small = shrink(&layer, 2, 2);
    // Columns 0 and 1, or 2 to 4, of row 0, or of rows 1 and 2.
    assert_eq!(small.image.pixels, [0.5, 3.0, 8.0, 10.5].map(Vec3::splat));
    assert_eq!(small.coverage, Some(vec![0.5, 1.0 / 3.0, 0.5, 0.5]));
    assert_eq!(shrink(&layer, 50, 30).image, layer.image);
}

#[test]
fn half_blocks_show_two_rows() {
    let [red, blue, white] = [[255, 0, 0], [0, 0, 255], [255; 3]];
    let text = |true_color| String::from_utf8(blocks::encode(&[red, red, blue, blue, white, red], 2, true_color));
    assert_eq!(
        text(true).unwrap(),
        "\x1b[38;2;255;0;0m\x1b[48;2;0;0;255m▀▀\x1b[0m\r\n\
         \x1b[38;2;255;255;255m\x1b[49m▀\x1b[38;2;255;0;0m\x1b[49m▀\x1b[0m\r\n"
    );
    assert_eq!(
        text(false).unwrap(),
        "\x1b[38;5;196m\x1b[48;5;21m▀▀\x1b[0m\r\n\x1b[38;5;231m\x1b[49m▀\x1b[38;5;196m\x1b[49m▀\x1b[0m\r\n"
    );
    let grey = String::from_utf8(blocks::encode(&[[128; 3]], 1, false)).unwrap();
    assert!(grey.starts_with("\x1b[38;5;244m"), "{grey:?}");
}

/// Draws sixels: returns the width and the pixels in percent. Pixels that nothing sets are `None`.
fn drawn(text: &[u8]) -> (usize, Vec<Option<[u32; 3]>>) {
    let text = std::str::from_utf8(text).unwrap();
    let text = text.strip_prefix("\x1bP0;1q\"1;1;").and_then(|text| text.strip_suffix("\x1b\\")).unwrap();
    let (size, mut rest) = text.split_at(text.find('#').unwrap());
    let (width, height) = size.split_once(';').unwrap();
    let (width, height): (usize, usize) = (width.parse().unwrap(), height.parse().unwrap());
    let (mut pixels, mut palette) = (vec![None; width * height], std::collections::BTreeMap::new());
    let (mut x, mut y, mut color) = (0, 0, 0);
    let number = |rest: &mut &str| -> u32 {
        let end = rest.find(|c: char| !c.is_ascii_digit()).unwrap_or(rest.len());
        let (digits, after) = rest.split_at(end);
        *rest = after;
        digits.parse().unwrap()
    };
    while let Some(c) = rest.chars().next() {
        rest = &rest[1..];
        let mut count = 1;
        let mut sixel = c;
        match c {
            '#' => {
                color = number(&mut rest);
                if rest.starts_with(";2;") {
                    rest = &rest[3..];
                    let values = [0, 1, 2].map(|_| {
                        let value = number(&mut rest);
                        rest = rest.strip_prefix(';').unwrap_or(rest);
                        value
                    });
                    palette.insert(color, values);
                }
                continue;
            }
            '$' => {
                x = 0;
                continue;
            }
            '-' => {
                (x, y) = (0, y + 6);
                continue;
            }
            '!' => {
                count = number(&mut rest) as usize;
                sixel = rest.chars().next().unwrap();
                rest = &rest[1..];
            }
            _ => {}
        }
        for _ in 0..count {
            for k in (0..6).filter(|k| (sixel as u32 - 63) >> k & 1 == 1) {
                let place = &mut pixels[(y + k) * width + x];
                assert_eq!(*place, None, "pixel {x},{} is drawn twice", y + k);
                *place = Some(palette[&color]);
            }
            x += 1;
        }
    }
    (width, pixels)
}

#[test]
fn sixels_draw_every_pixel_once_in_its_colour() {
    // Uniform areas of 4 x 4 pixels, so that the mean over the dithering is the colour.
    let mut random = durer::math::random::Random(1);
    for (columns, rows) in [(1, 1), (3, 2), (10, 7), (40, 3)] {
        let areas: Vec<[u8; 3]> = (0..columns * rows).map(|_| [0, 1, 2].map(|_| random.below(256) as u8)).collect();
        let (width, height) = (4 * columns, 4 * rows);
        let area = |x: usize, y: usize| areas[y / 4 * columns + x / 4];
        let pixels: Vec<_> = (0..width * height).map(|i| area(i % width, i / width)).collect();
        let (found_width, found) = drawn(&sixel::encode(&pixels, width));
        assert_eq!((found_width, found.len()), (width, width * height));
        for (i, color) in areas.iter().enumerate() {
            let mut sum = [0; 3];
            for (dx, dy) in (0..16).map(|k| (k % 4, k / 4)) {
                let values = found[(4 * (i / columns) + dy) * width + 4 * (i % columns) + dx].unwrap();
                (0..3).for_each(|k| sum[k] += values[k]);
            }
            for k in 0..3 {
                // One of sixteen thresholds is a sixteenth of a level, and levels are rounded to
                // percent.
                let (mean, wanted) = (f64::from(sum[k]) / 16.0, f64::from(color[k]) / 2.55);
                assert!((mean - wanted).abs() < 20.0 / 16.0 + 0.5, "{color:?}: {mean} and not {wanted}");
            }
        }
    }
}

/// The reader accepts only what `encode` writes, so the height need not be a multiple of six.
#[test]
fn sixels_end_at_the_last_row() {
    let (width, pixels) = drawn(&sixel::encode(&[[255; 3]; 21], 3));
    assert_eq!((width, pixels), (3, vec![Some([100; 3]); 21]));
}

#[test]
fn files_are_split_for_kitty_and_whole_for_iterm() {
    let file: Vec<u8> = (0..10_000_u32).map(|i| (i * i) as u8).collect();
    let text = String::from_utf8(kitty(&file, 20, 10)).unwrap();
    let chunks: Vec<(&str, &str)> = text
        .split_terminator("\x1b\\")
        .map(|chunk| chunk.strip_prefix("\x1b_G").unwrap().split_once(';').unwrap())
        .collect();
    assert!(chunks[0].0.starts_with("a=T,f=100,i=") && chunks[0].0.ends_with("c=20,r=10,C=1,q=2,m=1"));
    assert!(chunks[1..].iter().rev().map(|chunk| chunk.0).eq(["m=0", "m=1", "m=1"]));
    assert!(chunks.iter().all(|(_, data)| data.len() <= 4096));
    let data: String = chunks.iter().map(|chunk| chunk.1).collect();
    assert_eq!(BASE64_STANDARD.decode(data).unwrap(), file);
    let text = String::from_utf8(iterm(&file, 20, 10)).unwrap();
    let (keys, data) = text.strip_prefix("\x1b]1337;File=").unwrap().split_once(':').unwrap();
    assert_eq!(keys, "inline=1;size=10000;width=20;height=10;preserveAspectRatio=0");
    assert_eq!(BASE64_STANDARD.decode(data.strip_suffix('\x07').unwrap()).unwrap(), file);
}

#[test]
fn terminals_are_recognised() {
    let of = |variables: &[(&str, &str)]| {
        by_environment(|name| variables.iter().find(|v| v.0 == name).map(|v| v.1.to_string()).unwrap_or_default())
    };
    assert_eq!(of(&[("TERM", "xterm-kitty")]), Some(Graphics::Kitty));
    assert_eq!(of(&[("TERM", "xterm-256color"), ("KITTY_WINDOW_ID", "1")]), Some(Graphics::Kitty));
    assert_eq!(of(&[("TERM", "xterm-ghostty"), ("TERM_PROGRAM", "ghostty")]), Some(Graphics::Kitty));
    assert_eq!(of(&[("TERM", "xterm-256color"), ("TERM_PROGRAM", "iTerm.app")]), Some(Graphics::Iterm));
    assert_eq!(of(&[("TERM", "xterm-256color"), ("LC_TERMINAL", "iTerm2")]), Some(Graphics::Iterm));
    assert_eq!(of(&[("TERM", "xterm-256color"), ("TERM_PROGRAM", "WezTerm")]), Some(Graphics::Iterm));
    assert_eq!(of(&[("TERM", "tmux-256color"), ("KITTY_WINDOW_ID", "1")]), None);
    assert_eq!(of(&[("TERM", "xterm-256color"), ("TERM_PROGRAM", "Apple_Terminal")]), None);
    assert!(has_sixel(b"\x1b[?62;4;22c") && has_sixel(b"\x1b[?63;1;2;4c"));
    // The first number is the kind of terminal, not an attribute.
    assert!(!has_sixel(b"\x1b[?4;6c") && !has_sixel(b"\x1b[?62;22;44c") && !has_sixel(b"") && !has_sixel(b"4"));
}
