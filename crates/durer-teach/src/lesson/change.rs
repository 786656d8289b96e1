//! The difference between two pictures of a lesson step.

use super::stage::{LessonScene, percent};
use durer_image::{Image, Layer, LayerKind, Transfer};
use durer_scene::math::Vec3;

/// Largest difference in a channel, in 255ths, that is attributed to rounding.
const ROUNDING: i32 = 1;
/// Minimum fraction of the pixels that must change for the change to count as visible.
const MIN_SHARE: f64 = 0.001;

/// Difference between the pictures before and after a lesson step, with the number of changed
/// pixels.
#[derive(Clone, Debug)]
pub struct Change {
    /// Difference picture. It is grey where nothing changes, lighter where the picture gets
    /// lighter, and darker where the picture gets darker. It shows half the difference of the
    /// eight-bit values.
    pub picture: Layer,
    /// Total number of pixels.
    pub pixels: usize,
    /// Number of pixels that change.
    pub changed: usize,
    /// Number of pixels that get lighter.
    pub lighter: usize,
    /// Pixel that changes most, and its change in one channel in 255ths.
    pub most: ((u32, u32), i32),
    light: bool,
}

impl Change {
    /// Compares two layers after applying the transfer curve, which affects only colour layers.
    pub(super) fn new(before: &Layer, after: &Layer, transfer: Transfer) -> Self {
        let light = after.kind == LayerKind::Color;
        let transfer = if light { transfer } else { Transfer::Linear };
        let eight = |layer: &Layer, i: usize| transfer.encode_pixel(layer.image.pixels[i]).map(i32::from);
        let (width, height) = (after.image.width, after.image.height);
        let (mut changed, mut lighter, mut most) = (0, 0, ((0, 0), 0));
        let mut pixels = Vec::with_capacity(after.image.pixels.len());
        for i in 0..after.image.pixels.len() {
            let (a, b) = (eight(before, i), eight(after, i));
            let difference: [i32; 3] = std::array::from_fn(|c| b[c] - a[c]);
            let largest = difference.iter().map(|d| d.abs()).max().unwrap_or(0);
            if largest > ROUNDING {
                changed += 1;
                lighter += usize::from(difference.iter().sum::<i32>() > 0);
            }
            if largest > most.1 {
                most = ((i as u32 % width, i as u32 / width), largest);
            }
            pixels.push(Vec3::from(difference.map(|d| (128 + d / 2) as f32)) / 255.0);
        }
        let picture = Layer::data("change", Image { width, height, pixels });
        Change { picture, pixels: after.image.pixels.len(), changed, lighter, most, light }
    }

    /// Returns true if the change is visible.
    pub(super) fn is_seen(&self) -> bool {
        self.changed as f64 >= MIN_SHARE * self.pixels as f64 && self.changed > 0
    }

    /// Describes the change in one sentence.
    pub(super) fn words(&self, stage: &LessonScene) -> String {
        let (share, ((x, y), by)) = (percent(self.changed, self.pixels), self.most);
        let [lighter, darker] = [self.lighter, self.changed - self.lighter].map(|n| percent(n, self.pixels));
        let ways = match (self.light, self.lighter, self.changed) {
            (false, ..) => String::new(),
            (_, 0, _) => ", all of them darker".into(),
            (_, a, b) if a == b => ", all of them lighter".into(),
            _ => format!(": {lighter} lighter, {darker} darker"),
        };
        let what = stage.object_at((x, y));
        format!("{share} of the pixels change{ways}. Pixel {x},{y} changes the most, by {by} of 255: {what}.")
    }
}
