//! The page of `durer explain --html`.

use crate::failure::Failure;
use crate::open::CompiledInput;
use crate::page::{ExplainReport, Report, png, uri, with_data};
use durer::image::{Image, Layer, Transfer};
use durer::render::Job;
use durer::render::explain::SceneNames;
use durer::report::Explained;
use durer_session::{drawn_scene, explained_samples};
use std::path::Path;

/// Returns a self-contained page with the picture, the tree of `sample`, and its rays in 3D.
pub fn page(
    file: &Path,
    compiled: &CompiledInput,
    job: &Job,
    subject: &Explained,
    sample: usize,
    picture: &Image,
    transfer: Transfer,
) -> Result<String, Failure> {
    let names = SceneNames { files: &compiled.files, scene: &compiled.loaded.scene, world: &compiled.world };
    let (pixel, notes) = match subject {
        Explained::Pixel(pixel) => {
            (Some([pixel.x, pixel.y]), if job.method.is_stochastic() { pixel.firefly() } else { Vec::new() })
        }
        Explained::Ray(_) => (None, Vec::new()),
    };
    let encoded = pixel.map(|_| png(Layer::color("color", picture.clone()), transfer)).transpose()?;
    with_data(&Report::Explain(ExplainReport {
        file: file.to_string_lossy().into_owned(),
        pixel,
        transfer: transfer.name().into(),
        sample,
        samples: explained_samples(names, job, subject, sample, transfer),
        notes,
        picture: encoded.as_deref().map(uri),
        size: [picture.width, picture.height],
        scene: drawn_scene(names, compiled.loaded.dialect),
    }))
}
