//! The colour picture without its noise.

use super::part::Part;
use super::{Control, Job, RenderError, render};
use crate::film::aov::Aov;
use crate::image::denoise::{Guides, denoise};
use crate::image::{Image, Layer};
use crate::math::Vec3;
use crate::world::World;

/// The pictures that say what each pixel's surface is.
const GUIDES: [&str; 3] = ["albedo", "normals", "position"];

impl Part {
    /// The colour picture of what is there, without noise: see [`denoise`]. It is made beside the work, whose sums and hash it leaves
    /// alone.
    ///
    /// # Errors
    /// [`RenderError`], as for a picture of one ray a pixel.
    pub fn denoised(&self, world: &World, threads: Option<usize>) -> Result<Layer, RenderError> {
        let aovs = GUIDES.iter().filter_map(|name| Aov::from_name(name)).collect();
        let job = Job { color: false, aovs, noise: None, ..self.job.clone() };
        let seen = render(world, &job, &Control { threads, ..Control::default() })?;
        let guide = |name: &str| -> Vec<Vec3> {
            let layer = seen.layers.iter().find(|layer| layer.name == name);
            layer.map(|layer| layer.image.pixels.clone()).unwrap_or_default()
        };
        let [albedo, normal, position] = GUIDES.map(guide);
        let (colors, coverage, variance) = self.noisy();
        let window = self.job.window();
        let picture = Image::from_pixels(window.width, window.height, colors)?;
        let guides = Guides { albedo: &albedo, normal: &normal, position: &position, variance: &variance };
        let clean = denoise(&picture, &guides).unwrap_or(picture);
        Ok(Layer::color("denoised", clean).with_coverage(coverage))
    }
}
