//! Draws a picture in the terminal and refines it during the render, for `--terminal`.

mod blocks;
mod protocol;
mod sixel;

use crate::failure::{Failure, invalid_input};
use clap::ValueEnum;
use durer::image::{Display, Image, Layer, LayerKind, Transfer};
use durer::math::Vec3;
use protocol::Terminal;
use std::cell::Cell;
use std::io::{IsTerminal, Write};
use std::sync::Arc;

/// Choice of the way in which pictures are drawn in a terminal.
#[derive(Clone, Copy, Debug, PartialEq, Eq, ValueEnum)]
pub enum Graphics {
    /// The best way that the terminal supports
    Auto,
    /// Kitty's graphics protocol
    Kitty,
    /// Inline images of iTerm2
    Iterm,
    /// Sixels
    Sixel,
    /// Half blocks in 24-bit colours
    Blocks,
}

/// Place in the terminal where a picture is drawn again and again. A status line is below it.
pub struct TerminalPicture {
    terminal: Terminal,
    /// Height of the last drawing in rows of text. It is 0 before the first drawing.
    rows: Cell<u32>,
}

impl TerminalPicture {
    /// Finds out what the terminal at standard error supports.
    pub fn new(graphics: Graphics) -> Result<Self, Failure> {
        if graphics == Graphics::Auto && !std::io::stderr().is_terminal() {
            return Err(invalid_input(
                "--terminal: standard error is not a terminal; name the kind of graphics to write it anyway, for \
                 example --terminal=sixel",
            ));
        }
        Ok(TerminalPicture { terminal: Terminal::new(graphics), rows: Cell::new(0) })
    }

    /// Draws a picture over the last one, and a line of text below it. The next output to the
    /// terminal replaces this line.
    pub fn draw(&self, layer: &Layer, display: Display, status: &str) {
        let (columns, rows) = self.terminal.cells(layer.image.width, layer.image.height);
        let (width, height) = self.terminal.pixels(columns, rows);
        let small = shrink(layer, width, height);
        // Pictures of data are drawn without tone mapping.
        let display = if layer.kind == LayerKind::Color { display } else { Transfer::Linear.into() };
        let Ok(drawing) = self.terminal.encode(&small, display, columns, rows) else { return };
        let mut text = Vec::new();
        match self.rows.replace(rows) {
            // Make room first, because a drawing at the last line would scroll the screen.
            0 => text.extend(format!("{}\x1b[{rows}A", "\n".repeat(rows as usize)).bytes()),
            last => text.extend(format!("\r\x1b[{last}A").bytes()),
        }
        text.extend(b"\x1b7");
        text.extend(drawing);
        text.extend(format!("\x1b8\x1b[{rows}B\r\x1b[K{status}\r").bytes());
        let mut out = std::io::stderr().lock();
        // Errors are ignored because there is nowhere to report them.
        let _ = out.write_all(&text).and_then(|()| out.flush());
    }
}

/// Reduces a picture to at most `width` x `height` pixels. Each new pixel is the mean of the
/// pixels that it replaces. Pictures are never enlarged.
fn shrink(layer: &Layer, width: u32, height: u32) -> Layer {
    let image = &layer.image;
    let (width, height) = (width.clamp(1, image.width), height.clamp(1, image.height));
    let range = |i: u32, from: u32, to: u32| {
        let edge = |i: u32| (u64::from(i) * u64::from(from) / u64::from(to)) as usize;
        edge(i)..edge(i + 1).max(edge(i) + 1)
    };
    let cells = (0..height).flat_map(|y| (0..width).map(move |x| (x, y)));
    let places = |(x, y): (u32, u32)| {
        let columns = range(x, image.width, width);
        range(y, image.height, height)
            .flat_map(move |row| columns.clone().map(move |column| row * image.width as usize + column))
    };
    let mean = |cell| {
        let (sum, count) = places(cell).fold((Vec3::ZERO, 0), |(sum, n), i| (sum + image.pixels[i], n + 1));
        sum / count as f32
    };
    let pixels = cells.clone().map(mean).collect();
    let coverage = layer.coverage.as_ref().map(|coverage| {
        let mean = |cell| {
            let (sum, count) = places(cell).fold((0.0, 0), |(sum, n), i| (sum + coverage[i], n + 1));
            sum / count as f32
        };
        cells.map(mean).collect()
    });
    Layer { image: Arc::new(Image { width, height, pixels }), coverage, ..layer.clone() }
}

#[cfg(test)]
mod tests;
