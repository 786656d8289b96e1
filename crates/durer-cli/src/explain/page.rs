//! The explanation as a page of its own.

use crate::failure::Failure;
use crate::page;
use durer::image::{Image, Layer, Transfer};
use durer::report::{lights, outlines};
use durer::world::World;
use serde_json::{Value, json};

/// The page without its data.
const PAGE: &str = include_str!("page.html");
/// A page that needs nothing else: the picture, the tree of one sample to begin with, and the rays
/// in space.
pub fn page(
    explanation: Value,
    sample: usize,
    world: &World,
    picture: &Image,
    transfer: Transfer,
) -> Result<String, Failure> {
    let picture = page::png(Layer::color("color", picture.clone()), transfer)?;
    let data = json!({
        "explanation": explanation,
        "sample": sample,
        "picture": page::uri(&picture),
        "transfer": transfer.name(),
        "outlines": outlines(world),
        "lights": lights(world),
        "eye": world.camera_frame().eye,
    });
    Ok(page::with_data(PAGE, &data))
}
