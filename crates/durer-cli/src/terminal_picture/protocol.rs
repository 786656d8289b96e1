//! Kinds of terminals: how to recognise them, and how they expect pictures.

use super::{Graphics, blocks, sixel};
use base64::prelude::{BASE64_STANDARD, Engine};
use durer::image::{Display, ImageError, Layer, WriteOptions, format_for};

/// Size of a terminal. The sides of a cell are in pixels.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Size {
    pub columns: u32,
    pub rows: u32,
    pub cell: (u32, u32),
}

/// Size that is assumed if the terminal does not state it.
pub const USUAL: Size = Size { columns: 80, rows: 24, cell: (8, 16) };

/// A terminal: what it can draw, and how large it is.
#[derive(Clone, Copy, Debug)]
pub struct Terminal {
    /// Kind of graphics, which is not [`Graphics::Auto`].
    pub graphics: Graphics,
    /// True if the terminal shows 24-bit colours; otherwise it has 256 colours.
    pub true_color: bool,
    pub size: Size,
}

impl Terminal {
    /// Describes the terminal at standard error.
    pub fn new(graphics: Graphics) -> Self {
        let variable = |name: &str| std::env::var(name).unwrap_or_default();
        let graphics = match graphics {
            Graphics::Auto => by_environment(variable).unwrap_or_else(|| match answers_sixel() {
                true => Graphics::Sixel,
                false => Graphics::Blocks,
            }),
            graphics => graphics,
        };
        let true_color = matches!(variable("COLORTERM").as_str(), "truecolor" | "24bit");
        Terminal { graphics, true_color, size: size().unwrap_or(USUAL) }
    }

    /// Returns the columns and rows that a picture fills. It fits into the terminal, keeps its
    /// shape, and is not enlarged.
    pub fn cells(&self, width: u32, height: u32) -> (u32, u32) {
        let Size { columns, rows, cell } = self.size;
        let (cell_width, cell_height) = self.cell(cell);
        // One row is left for the status line, and one for the prompt.
        let (most_columns, most_rows) = (f64::from(columns.max(1)), f64::from(rows.saturating_sub(2).max(1)));
        let wide = f64::from(width) / f64::from(cell_width);
        let high = f64::from(height) / f64::from(cell_height);
        let scale = (most_columns / wide).min(most_rows / high).min(1.0);
        let count = |length: f64, most: f64| (length * scale).round().clamp(1.0, most) as u32;
        (count(wide, most_columns), count(high, most_rows))
    }

    /// Returns the number of pixels in some columns and rows.
    pub fn pixels(&self, columns: u32, rows: u32) -> (u32, u32) {
        let (width, height) = self.cell(self.size.cell);
        (columns * width, rows * height)
    }

    /// Returns the pixels per cell. A half block shows two pixels, one above the other.
    fn cell(&self, cell: (u32, u32)) -> (u32, u32) {
        if self.graphics == Graphics::Blocks { (1, 2) } else { (cell.0.max(1), cell.1.max(1)) }
    }

    /// Encodes a picture as text that draws it from the position of the cursor.
    ///
    /// # Errors
    /// Returns the errors of the PNG format.
    pub fn encode(&self, layer: &Layer, display: Display, columns: u32, rows: u32) -> Result<Vec<u8>, ImageError> {
        let colors = || layer.image.pixels.iter().map(|&pixel| display.encode_pixel(pixel)).collect::<Vec<_>>();
        let width = layer.image.width as usize;
        Ok(match self.graphics {
            Graphics::Kitty => kitty(&png(layer, display)?, columns, rows),
            Graphics::Iterm => iterm(&png(layer, display)?, columns, rows),
            Graphics::Sixel => sixel::encode(&colors(), width),
            Graphics::Blocks | Graphics::Auto => blocks::encode(&colors(), width, self.true_color),
        })
    }
}

/// Recognises terminals with graphics by their environment variables. Their documentation names
/// these variables.
pub fn by_environment(variable: impl Fn(&str) -> String) -> Option<Graphics> {
    let (term, program) = (variable("TERM"), variable("TERM_PROGRAM"));
    // Multiplexers do not pass graphics on. Newer versions of tmux answer that they have sixels.
    if term.starts_with("screen") || term.starts_with("tmux") || !variable("TMUX").is_empty() {
        return None;
    }
    if !variable("KITTY_WINDOW_ID").is_empty() || term.contains("kitty") || term.contains("ghostty") {
        return Some(Graphics::Kitty);
    }
    match (program.as_str(), variable("LC_TERMINAL").as_str()) {
        ("ghostty", _) => Some(Graphics::Kitty),
        ("iTerm.app" | "WezTerm" | "mintty" | "rio", _) | (_, "iTerm2") => Some(Graphics::Iterm),
        _ => None,
    }
}

/// Asks the terminal for its attributes. Attribute 4 of the answer (`DA1`) stands for sixels.
#[cfg(unix)]
fn answers_sixel() -> bool {
    use rustix::event::{PollFd, PollFlags, Timespec, poll};
    use rustix::termios::{OptionalActions, tcgetattr, tcsetattr};
    let open = || std::fs::File::options().read(true).write(true).open("/dev/tty");
    let ask = || -> Option<Vec<u8>> {
        let terminal = open().ok()?;
        let before = tcgetattr(&terminal).ok()?;
        let mut raw = before.clone();
        raw.make_raw();
        tcsetattr(&terminal, OptionalActions::Now, &raw).ok()?;
        let mut answer = Vec::new();
        let _ = rustix::io::write(&terminal, b"\x1b[c");
        // Terminals answer at once. Over a slow network, the answer comes too late, and half blocks
        // are drawn.
        let limit = Timespec { tv_sec: 0, tv_nsec: 300_000_000 };
        let mut byte = [0];
        while answer.len() < 64
            && poll(&mut [PollFd::new(&terminal, PollFlags::IN)], Some(&limit)).is_ok_and(|ready| ready > 0)
            && rustix::io::read(&terminal, &mut byte).is_ok_and(|read| read == 1)
        {
            answer.push(byte[0]);
            if byte == *b"c" {
                break;
            }
        }
        tcsetattr(&terminal, OptionalActions::Now, &before).ok()?;
        Some(answer)
    };
    ask().is_some_and(|answer| has_sixel(&answer))
}

#[cfg(not(unix))]
fn answers_sixel() -> bool {
    false
}

/// Returns true if an answer such as `ESC [ ? 62 ; 4 ; 22 c` contains the attribute 4.
pub fn has_sixel(answer: &[u8]) -> bool {
    let text = String::from_utf8_lossy(answer);
    let attributes = text.strip_prefix("\x1b[?").and_then(|rest| rest.strip_suffix('c'));
    attributes.is_some_and(|attributes| attributes.split(';').skip(1).any(|attribute| attribute == "4"))
}

/// Returns the size of the terminal at standard error.
#[cfg(unix)]
fn size() -> Option<Size> {
    let size = rustix::termios::tcgetwinsize(rustix::stdio::stderr()).ok()?;
    let (columns, rows) = (u32::from(size.ws_col), u32::from(size.ws_row));
    let side = |pixels: u16, cells: u32, usual| if pixels == 0 { usual } else { u32::from(pixels) / cells };
    (columns > 0 && rows > 0).then(|| Size {
        columns,
        rows,
        cell: (side(size.ws_xpixel, columns, USUAL.cell.0), side(size.ws_ypixel, rows, USUAL.cell.1)),
    })
}

#[cfg(not(unix))]
fn size() -> Option<Size> {
    None
}

fn png(layer: &Layer, display: Display) -> Result<Vec<u8>, ImageError> {
    let mut bytes = Vec::new();
    let options = WriteOptions { display, attributes: &[] };
    format_for("picture.png")?.write(std::slice::from_ref(layer), &options, &mut bytes)?;
    Ok(bytes)
}

/// Encodes a PNG file for kitty. Source: <https://sw.kovidgoyal.net/kitty/graphics-protocol/>.
pub fn kitty(png: &[u8], columns: u32, rows: u32) -> Vec<u8> {
    // A picture with the same number replaces the last one. Each run has a number of its own.
    let number = std::process::id() % (1 << 24) + 1;
    let data = BASE64_STANDARD.encode(png);
    let mut text = Vec::new();
    let mut chunks = data.as_bytes().chunks(4096).peekable();
    let mut keys = format!("a=T,f=100,i={number},p=1,c={columns},r={rows},C=1,q=2,");
    while let Some(chunk) = chunks.next() {
        let more = u8::from(chunks.peek().is_some());
        text.extend(format!("\x1b_G{keys}m={more};").bytes());
        text.extend(chunk);
        text.extend(b"\x1b\\");
        keys.clear();
    }
    text
}

/// Encodes a PNG file for iTerm2. Source: <https://iterm2.com/documentation-images.html>.
pub fn iterm(png: &[u8], columns: u32, rows: u32) -> Vec<u8> {
    let size = png.len();
    let keys = format!("inline=1;size={size};width={columns};height={rows};preserveAspectRatio=0");
    format!("\x1b]1337;File={keys}:{}\x07", BASE64_STANDARD.encode(png)).into_bytes()
}
