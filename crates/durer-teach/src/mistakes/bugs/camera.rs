//! Mistakes in camera rays and in writing the picture.

use durer_scene::math::Vec2;

/// Side of a non-square picture to which a student's camera applies the field of view.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub enum Aspect {
    /// The field of view spans the side that the dialect's program uses.
    #[default]
    Correct,
    /// The field of view spans the smaller side.
    Smaller,
    /// The smaller side is scaled by the reciprocal of the correct factor.
    Turned,
    /// The larger side is scaled instead of the smaller one.
    Exchanged,
}

/// Mistakes in generating camera rays, in addition to the quirks of the scene's dialect.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct CameraBugs {
    /// Position of the sample in the pixel. The centre is (0.5, 0.5).
    pub sample_position: Vec2,
    /// Factor by which positions on the picture plane are multiplied.
    pub scale: f32,
    /// Axes, x or y, on which the first and last pixel centres lie on the picture's border.
    pub border_axes: [bool; 2],
    /// Side to which the field of view applies in non-square pictures.
    pub aspect: Aspect,
    /// Number of rays per pixel.
    pub rays: RayCount,
    /// Only hits in front of the camera's centre count, even with parallel rays.
    pub from_center: bool,
}

/// Number of camera rays per pixel in a student's tracer.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub enum RayCount {
    /// The number that is set in the job.
    #[default]
    Correct,
    /// One ray through the centre.
    One,
    /// A regular grid of 4 by 4 rays.
    Sixteen,
}

impl Default for CameraBugs {
    fn default() -> Self {
        CameraBugs {
            sample_position: Vec2::splat(0.5),
            scale: 1.0,
            border_axes: [false; 2],
            aspect: Aspect::Correct,
            rays: RayCount::Correct,
            from_center: false,
        }
    }
}

impl CameraBugs {
    /// Returns the factors for positions on the picture plane, one for each axis.
    pub fn factor(&self, width: u32, height: u32) -> Vec2 {
        let (w, h) = (width as f32, height as f32);
        let ratio = w.max(h) / w.min(h);
        let aspect = match self.aspect {
            Aspect::Correct => Vec2::ONE,
            Aspect::Smaller => Vec2::splat(ratio),
            Aspect::Turned if w > h => Vec2::new(1.0, ratio * ratio),
            Aspect::Turned => Vec2::new(ratio * ratio, 1.0),
            Aspect::Exchanged if w > h => Vec2::new(1.0 / ratio, ratio),
            Aspect::Exchanged => Vec2::new(ratio, 1.0 / ratio),
        };
        // A centre at 2 (i + 0.5) / n - 1 moves to 2 i / (n - 1) - 1.
        let border = |n: f32, here: bool| if here && n > 1.0 { n / (n - 1.0) } else { 1.0 };
        self.scale * aspect * Vec2::new(border(w, self.border_axes[0]), border(h, self.border_axes[1]))
    }
}

/// Mistake that a student's program can make when it converts radiance to eight-bit values.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub enum OutputBug {
    /// There is no mistake, so the transfer curve is correct.
    #[default]
    Correct,
    /// The value is multiplied by this number and taken modulo 256.
    Wrapped(u16),
    /// The value is divided by the brightest value in the picture.
    Scaled,
    /// The value is rounded instead of truncated, or the reverse.
    OtherRounding,
    /// The value is raised to the reciprocal of this power, where 0 stands for the sRGB curve.
    ExtraCurve(f32),
    /// The value c becomes c / (1 + c).
    Toned,
    /// The value is multiplied by this factor.
    Times(f32),
    /// The value c becomes 1 - c.
    Negative,
    /// The picture is grey: 0 selects the mean of the channels, 1 the luma of Rec. 601, 2 the
    /// luminance, 3 the maximum, 4 red, 5 green, and 6 blue.
    Grey(u32),
    /// The value is quantised to this many levels.
    Steps(u32),
    /// The value is raised to this power, where 0 stands for omitting the sRGB curve or applying
    /// its inverse.
    MissingCurve(f32),
}

/// The way in which a student's program rearranges the pixels and channels of a picture, for
/// example by mirroring it.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub struct PixelOrder {
    /// Columns and rows are exchanged if the picture is square.
    pub exchange: bool,
    /// The order of the columns is reversed.
    pub columns_back: bool,
    /// The order of the rows is reversed.
    pub rows_back: bool,
    /// Order of the channels, as an index into [`PixelOrder::ORDERS`]. The index 0 means unchanged,
    /// and 1 exchanges red and blue.
    pub channels: u8,
    /// Shift of the picture in pixels, to the right and downwards.
    pub moved: (i32, i32),
    /// Pixels without a source are black instead of repeating the border.
    pub black_border: bool,
    /// Pixels that leave the picture on one side enter it on the other.
    pub rolled: bool,
    /// All pixels in each block of 2 by 2 have the same value.
    pub halved: bool,
}

impl PixelOrder {
    /// Source channels of red, green and blue, for each order.
    pub const ORDERS: [[usize; 3]; 6] = [[0, 1, 2], [2, 1, 0], [0, 2, 1], [1, 0, 2], [1, 2, 0], [2, 0, 1]];

    /// Returns true if the pixel at a position has no source and is therefore black.
    pub fn is_empty(self, width: u32, height: u32, (x, y): (u32, u32)) -> bool {
        let out = |at: u32, by: i32, size: u32| !(0..i64::from(size)).contains(&(i64::from(at) - i64::from(by)));
        self.black_border && (out(x, self.moved.0, width) || out(y, self.moved.1, height))
    }

    /// Returns the source position of the pixel at a position.
    pub fn source(self, width: u32, height: u32, (x, y): (u32, u32)) -> (u32, u32) {
        let x = if self.columns_back { width - 1 - x } else { x };
        let y = if self.rows_back { height - 1 - y } else { y };
        let (x, y) = if self.exchange && width == height { (y, x) } else { (x, y) };
        let from = |at: u32, by: i32, size: u32| match self.rolled {
            true => (i64::from(at) - i64::from(by)).rem_euclid(i64::from(size)) as u32,
            false => at.saturating_add_signed(-by).min(size - 1),
        };
        let (x, y) = if self.halved { (x & !1, y & !1) } else { (x, y) };
        (from(x, self.moved.0, width), from(y, self.moved.1, height))
    }
}
