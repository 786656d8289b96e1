//! Progressive rendering of a scene into a picture.

use crate::compiled::CompiledScene;
use crate::error::Error;
use crate::job::RenderJob;
use durer_image::{Image, Layer};
#[cfg(feature = "fs")]
use durer_image::{Transfer, WriteOptions, format_for, save};
use durer_render::render::{Control, Progress, ProgressiveRender, RenderError};
use durer_render::world::World;
use durer_scene::math::Color;
#[cfg(feature = "fs")]
use std::path::Path;
use std::sync::Arc;
use std::sync::atomic::Ordering::Relaxed;

/// Progressive renderer for a [`CompiledScene`] that adds samples pass by pass. See the example of
/// [this crate](crate). The renderer is also an iterator over [`Progress`].
#[derive(Debug)]
pub struct Renderer<'w> {
    world: &'w World,
    render: ProgressiveRender,
    control: Arc<Control>,
}

/// Handle with which any thread can cancel a [`Renderer`].
#[derive(Clone, Debug)]
pub struct Canceller(Arc<Control>);

impl Canceller {
    /// Cancels the render. The next pass then returns [`RenderError::Cancelled`].
    pub fn cancel(&self) {
        self.0.cancel.store(true, Relaxed);
    }
}

impl<'w> Renderer<'w> {
    /// Starts a render on all processors.
    ///
    /// # Errors
    ///
    /// Returns [`Error::Options`] or [`Error::Render`] if the options are invalid.
    pub fn new(scene: &'w CompiledScene, options: RenderJob) -> Result<Self, Error> {
        Renderer::with_control(scene, options, Control::default())
    }

    /// Starts a render with execution options such as threads and memory.
    ///
    /// # Errors
    ///
    /// Returns the same errors as [`Renderer::new`].
    pub fn with_control(scene: &'w CompiledScene, options: RenderJob, control: Control) -> Result<Self, Error> {
        let job = scene.job(&options)?;
        let (world, control) = (scene.world(), Arc::new(control));
        Ok(Renderer { world, render: ProgressiveRender::new(world, &job)?, control })
    }

    /// Renders the next pass over all pixels. Returns `None` if the picture is finished. At first,
    /// each pass doubles the number of samples, and short passes are combined.
    ///
    /// # Errors
    ///
    /// Returns [`Error::Render`], for example if the render was cancelled. The results of earlier
    /// passes are kept.
    pub fn next_pass(&mut self) -> Result<Option<Progress>, Error> {
        Ok(self.render.next_pass(self.world, &self.control)?)
    }

    /// Renders the remaining passes and returns the picture.
    ///
    /// # Errors
    ///
    /// Returns the same errors as [`Renderer::next_pass`].
    pub fn finish(mut self) -> Result<Picture, Error> {
        while self.next_pass()?.is_some() {}
        self.image()
    }

    /// Returns a handle that cancels this render from another thread.
    pub fn canceller(&self) -> Canceller {
        Canceller(Arc::clone(&self.control))
    }

    /// Returns the current picture. The picture is black until the first pass has finished.
    ///
    /// # Errors
    ///
    /// Returns [`Error::Render`] if the picture does not fit into memory.
    pub fn image(&self) -> Result<Picture, Error> {
        let mut rendered = self.render.part().pictures()?;
        match rendered.layers.is_empty() {
            true => Err(RenderError::Job("the job has no colour picture".into()).into()),
            false => Ok(Picture { layer: rendered.layers.swap_remove(0), attributes: rendered.attributes }),
        }
    }
}

impl Iterator for Renderer<'_> {
    type Item = Result<Progress, Error>;

    fn next(&mut self) -> Option<Self::Item> {
        self.next_pass().transpose()
    }
}

/// A rendered picture in linear light with sRGB primaries, which [`Renderer::image`] returns. By
/// default, white has the value 1.
#[derive(Clone, Debug)]
pub struct Picture {
    layer: Layer,
    #[cfg_attr(not(feature = "fs"), expect(dead_code))]
    attributes: Vec<(&'static str, String)>,
}

impl Picture {
    /// Returns the width in pixels.
    pub fn width(&self) -> u32 {
        self.layer.image.width
    }

    /// Returns the height in pixels.
    pub fn height(&self) -> u32 {
        self.layer.image.height
    }

    /// Returns the colours row by row from the top, and each row from left to right.
    pub fn pixels(&self) -> &[Color] {
        &self.layer.image.pixels
    }

    /// Returns the colour of a pixel, or `None` outside the picture. Coordinates start at 0 in the
    /// upper left corner.
    pub fn pixel(&self, x: u32, y: u32) -> Option<Color> {
        self.layer.image.get(x, y)
    }

    /// Returns the image without its metadata.
    pub fn image(&self) -> &Image {
        &self.layer.image
    }

    /// Saves the picture to a file atomically. The extension determines the format. Files with the
    /// extension `.exr`, `.hdr` or `.pfm` store linear light, and other formats store eight bits
    /// per channel with the sRGB curve.
    ///
    /// # Errors
    ///
    /// Returns [`Error::Image`] if the format is unknown or cannot store such pictures. Returns
    /// [`Error::Save`] if the file cannot be written.
    #[cfg(feature = "fs")]
    pub fn save(&self, path: impl AsRef<Path>) -> Result<(), Error> {
        let path = path.as_ref();
        let options = WriteOptions { display: Transfer::Srgb.into(), attributes: &self.attributes };
        let mut bytes = Vec::new();
        format_for(path)?.write(std::slice::from_ref(&self.layer), &options, &mut bytes)?;
        Ok(save(path, &bytes)?)
    }
}
