//! The colour picture without its noise.

use super::part::PartialRender;
use super::{Control, Job, RenderError, render};
use crate::film::aov::Aov;
use crate::world::World;
use durer_image::denoise::{Guides, denoise};
use durer_image::{Image, Layer};
use durer_scene::math::Vec3;

/// The pictures that say what each pixel's surface is.
const GUIDES: [&str; 3] = ["albedo", "normals", "position"];

/// A colour picture with its noise, and what is known of each pixel: what denoisers need.
#[derive(Clone, Debug)]
pub struct Noisy {
    /// The picture, as rendered.
    pub picture: Image,
    /// How much of each pixel the camera sees.
    pub coverage: Vec<f32>,
    /// The surface's own colour.
    pub albedo: Vec<Vec3>,
    /// Its normal; zero where nothing is hit.
    pub normal: Vec<Vec3>,
    /// Its place.
    pub position: Vec<Vec3>,
    /// The variance of the mean luminance.
    pub variance: Vec<f32>,
}

impl PartialRender {
    /// The colour picture of what is there, with its guides by one ray a pixel. It is made beside
    /// the work, whose sums and hash it leaves alone.
    ///
    /// # Errors
    /// [`RenderError`], as for a picture of one ray a pixel.
    pub fn noisy(&self, world: &World, threads: Option<usize>) -> Result<Noisy, RenderError> {
        let aovs = GUIDES.iter().filter_map(|name| Aov::from_name(name)).collect();
        let job = Job { color: false, aovs, noise: None, adaptive: false, ..self.job.clone() };
        let seen = render(world, &job, &Control { threads, ..Control::default() })?;
        let guide = |name: &str| -> Vec<Vec3> {
            let layer = seen.layers.iter().find(|layer| layer.name == name);
            layer.map(|layer| layer.image.pixels.clone()).unwrap_or_default()
        };
        let [albedo, normal, position] = GUIDES.map(guide);
        let (colors, coverage, variance) = self.colors_and_variance();
        let window = self.job.window();
        let picture = Image::from_pixels(window.width, window.height, colors)?;
        Ok(Noisy { picture, coverage, albedo, normal, position, variance })
    }
}

impl Noisy {
    /// Without noise by our own denoiser: see [`denoise`]. It has the same bits on any number of
    /// threads.
    pub fn denoised(self) -> Layer {
        let Noisy { picture, albedo, normal, position, variance, .. } = &self;
        let clean = denoise(picture, &Guides { albedo, normal, position, variance });
        let clean = clean.unwrap_or_else(|| picture.clone());
        self.layer(clean)
    }

    /// A picture without noise as the layer that goes beside the noisy one.
    pub fn layer(self, clean: Image) -> Layer {
        Layer::color("denoised", clean).with_coverage(self.coverage)
    }
}
