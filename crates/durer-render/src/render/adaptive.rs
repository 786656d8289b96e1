//! Second step of adaptive sampling, which decides the number of samples of each pixel after the
//! pilot samples.

use super::PixelRect;
use super::allocation::{distribute, neighbor_variances, weight};
use super::part::PartialRender;
use std::sync::Arc;

impl PartialRender {
    /// Decides the number of samples of each pixel once all pixels have their pilot samples.
    /// Returns true if the numbers have been decided.
    pub(super) fn allocate(&self) -> bool {
        let (samples, window) = (self.job.sampling.samples(), self.job.window());
        let blocks = self.state().samples.clone();
        if blocks.iter().all(|block| block.targets.is_some()) {
            return true;
        }
        let mut variances = vec![0.0; window.pixels() as usize];
        for (index, block) in blocks.iter().enumerate() {
            let Some(own) = &block.variances else { return false };
            let places = self.blocks.rect(index).pixel_positions();
            places.zip(own.iter()).for_each(|((x, y), &variance)| variances[window.index(x, y)] = variance);
        }
        let weights: Vec<f32> = neighbor_variances(&variances, window.width as usize).into_iter().map(weight).collect();
        let mut targets = vec![0; weights.len()];
        for color in 0..2 {
            let is_of_color = |&(x, y): &(u32, u32)| (x ^ y) & 1 == color;
            let pixels: Vec<usize> =
                window.pixel_positions().filter(is_of_color).map(|(x, y)| window.index(x, y)).collect();
            let own: Vec<f32> = pixels.iter().map(|&pixel| weights[pixel]).collect();
            pixels.iter().zip(distribute(&own, samples)).for_each(|(&pixel, target)| targets[pixel] = target);
        }
        let of_block = |rect: PixelRect| -> Arc<[u32]> {
            rect.pixel_positions().map(|(x, y)| targets[window.index(x, y)]).collect()
        };
        for (index, block) in self.state().samples.iter_mut().enumerate() {
            block.targets = Some(of_block(self.blocks.rect(index)));
        }
        true
    }

    /// Returns the number of samples that was decided for a pixel of the window, or `None` if the
    /// number is undecided.
    pub(super) fn sample_target(&self, x: u32, y: u32) -> Option<u32> {
        let (state, index) = (self.state(), self.blocks.index_at(x, y));
        let pixel = self.blocks.rect(index).pixel_positions().position(|place| place == (x, y))?;
        Some(state.samples.get(index)?.targets.as_ref()?[pixel])
    }
}
