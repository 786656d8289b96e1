//! Denoising of the colour picture.

use super::part::PartialRender;
use super::{Control, Job, RenderError, render};
use crate::film::aov::Aov;
use crate::world::World;
use durer_image::denoise::{GuideImages, denoise};
use durer_image::{Image, Layer};
use durer_scene::math::Vec3;

/// AOVs that the denoiser uses as guides.
const GUIDES: [&str; 3] = ["albedo", "normals", "position"];

/// The noisy colour picture of a render with the albedo, normals, positions and variances that
/// guide a denoiser.
#[derive(Clone, Debug)]
pub struct NoisyPicture {
    /// The picture as it was rendered.
    pub picture: Image,
    /// Coverage of each pixel.
    pub coverage: Vec<f32>,
    /// Albedo of the surface in each pixel.
    pub albedo: Vec<Vec3>,
    /// Normal of the surface in each pixel, or zero where the ray hit nothing.
    pub normal: Vec<Vec3>,
    /// World-space position of the surface in each pixel.
    pub position: Vec<Vec3>,
    /// Estimated variance of each pixel's mean luminance.
    pub variance: Vec<f32>,
}

impl PartialRender {
    /// Returns the current colour picture with its guides, which are computed from one ray per
    /// pixel. The sums and the hash of this part do not change.
    ///
    /// # Errors
    /// Returns the same [`RenderError`] as for a picture with one ray per pixel.
    pub fn noisy(&self, world: &World, threads: Option<usize>) -> Result<NoisyPicture, RenderError> {
        let aovs = GUIDES.iter().filter_map(|name| Aov::from_name(name)).collect();
        let job = Job { color: false, aovs, noise: None, adaptive: false, ..self.job.clone() };
        let rendered = render(world, &job, &Control { threads, ..Control::default() })?;
        let guide = |name: &str| -> Vec<Vec3> {
            let layer = rendered.layers.iter().find(|layer| layer.name == name);
            layer.map(|layer| layer.image.pixels.clone()).unwrap_or_default()
        };
        let [albedo, normal, position] = GUIDES.map(guide);
        let (colors, coverage, variance) = self.colors_and_variance();
        let window = self.job.window();
        let picture = Image::from_pixels(window.width, window.height, colors)?;
        Ok(NoisyPicture { picture, coverage, albedo, normal, position, variance })
    }
}

impl NoisyPicture {
    /// Denoises the picture with Dürer's own denoiser. See [`denoise`]. The result is bit-identical
    /// for any number of threads.
    pub fn denoised(self) -> Layer {
        let NoisyPicture { picture, albedo, normal, position, variance, .. } = &self;
        let clean = denoise(picture, &GuideImages { albedo, normal, position, variance });
        let clean = clean.unwrap_or_else(|| picture.clone());
        self.layer(clean)
    }

    /// Returns a denoised picture as a layer.
    pub fn layer(self, clean: Image) -> Layer {
        Layer::color("denoised", clean).with_coverage(self.coverage)
    }
}
