//! The page of `durer explain --html`.

use crate::failure::Failure;
use crate::page;
use durer::image::{Image, Layer, Transfer};
use durer::report::{lights, outlines};
use durer::world::World;
use serde_json::{Value, json};

/// Template of the page, without data.
const PAGE: &str = include_str!("page.html");
/// Returns a self-contained page with the picture, the tree of `sample`, and its rays in 3D.
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
