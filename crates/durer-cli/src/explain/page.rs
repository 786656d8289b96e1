//! The explanation as a page of its own.

use crate::Failure;
use crate::page;
use durer::image::{Image, Layer, Transfer};
use durer::world::World;
use serde_json::{Value, json};

/// The page without its data.
const PAGE: &str = include_str!("page.html");
/// At most so many boxes are drawn: more hide each other.
const MOST_BOXES: usize = 400;

/// A page that needs nothing else: the picture, the tree of one sample to begin with, and the rays in space.
pub fn page(explanation: Value, sample: usize, world: &World, picture: &Image) -> Result<String, Failure> {
    let picture = page::png(Layer::color("color", picture.clone()), Transfer::default())?;
    let boxes = world.objects.iter().filter_map(|object| object.bounds()).take(MOST_BOXES);
    let boxes: Vec<Value> = boxes.map(|b| json!({ "min": b.min, "max": b.max })).collect();
    let data = json!({
        "explanation": explanation,
        "sample": sample,
        "picture": page::uri(&picture),
        "boxes": boxes,
        "eye": world.frame.eye,
    });
    Ok(page::with_data(PAGE, &data))
}
