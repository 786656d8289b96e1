//! Diagrams of sample positions and filter weights.

use durer::film::course::{CourseFilter, diagram};
use durer::image::{Image, Layer};
use durer::math::Vec2;
use durer::render::{Control, Job, RenderError, Rendered, Sampling};
use durer::world::World;

/// Renders the requested diagrams and adds them to the pictures.
pub fn add(
    shows: &[String],
    zoom: u32,
    world: &World,
    job: &Job,
    control: &Control,
    rendered: &mut Rendered,
) -> Result<(), RenderError> {
    for show in shows {
        let picture = match show.as_str() {
            "samples" => samples_layer(world, job, control, zoom)?,
            "filter" => filter_layer(job, zoom)?,
            _ => continue,
        };
        rendered.layers.push(picture.clone());
        rendered.pictures.push(picture);
    }
    Ok(())
}

/// Renders a diagram of the sample positions.
pub fn samples_layer(world: &World, job: &Job, control: &Control, zoom: u32) -> Result<Layer, RenderError> {
    let stored = durer::render::sample_diagram(world, job, control)?;
    layer("samples", diagram::samples(&stored, zoom))
}

/// Renders a diagram of the filter weights.
pub fn filter_layer(job: &Job, zoom: u32) -> Result<Layer, RenderError> {
    let picture = match job.sampling {
        Sampling::Course2004 { filter, .. } => {
            diagram::filter(job.width, job.height, zoom, filter.unwrap_or(CourseFilter::Box { radius: 0.5 }))
        }
        Sampling::Filtered { filter, .. } => {
            let most = filter.weight(0.0, 0.0);
            let support = (filter.radius() - 0.5).ceil().max(0.0) as u32;
            let weight = |offset: Vec2| filter.weight(offset.x, offset.y) / most;
            diagram::weights(job.width, job.height, zoom, support, weight)
        }
        _ => diagram::filter(job.width, job.height, zoom, CourseFilter::Box { radius: 0.5 }),
    };
    layer("filter", picture)
}

/// Fails if a diagram would be too large.
pub fn check(job: &Job, zoom: u32) -> Result<(), RenderError> {
    let side = |pixels: u32| pixels.saturating_mul(zoom).saturating_add(1);
    let (width, height) = (side(job.width), side(job.height));
    if u64::from(width) * u64::from(height) > 1 << 24 {
        let message = "the diagram is too large; use a smaller --size or --zoom";
        return Err(RenderError::Diagram(message.into()));
    }
    Ok(())
}

fn layer(name: &str, picture: diagram::Diagram) -> Result<Layer, RenderError> {
    Ok(Layer::data(name, Image::from_pixels(picture.width, picture.height, picture.pixels)?))
}
