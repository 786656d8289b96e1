//! The report of `durer compare`, which is one HTML file that needs no network access.

use super::args::CompareArgs;
use super::compared_pair::{ComparedPair, Outcome, PairPictures, name};
use super::text;
use crate::failure::Failure;
use crate::page;
use durer::image::compare::{Comparison, Picture, Scale, heat_map};
use durer::image::{Image, Layer, Transfer, decode_linear};
use serde_json::{Value, json};
use std::path::PathBuf;

/// Template of the page, without data.
const PAGE: &str = include_str!("page.html");

/// Encodes the pictures of a pair for the page.
pub fn pair_pictures(reference: &Picture, picture: &Picture, comparison: &Comparison) -> Result<PairPictures, String> {
    let png = |(layer, transfer): (Layer, Transfer)| -> Result<String, String> {
        let png = page::png(layer, transfer).map_err(|_| "the picture is too large for a page")?;
        Ok(page::uri(&png))
    };
    Ok(PairPictures {
        reference: png(screen(reference))?,
        picture: png(screen(picture))?,
        heat: png((heat(comparison), Transfer::Linear))?,
    })
}

/// Returns the heat map as a layer.
pub fn heat(comparison: &Comparison) -> Layer {
    let map = heat_map(comparison.width, comparison.height, &comparison.flip_map);
    let pixels = map.pixels.iter().map(|pixel| pixel.map(decode_linear).into()).collect();
    Layer::data("heat", Image { width: comparison.width, height: comparison.height, pixels })
}

/// Returns a picture as a layer, with the transfer curve used to display it.
fn screen(picture: &Picture) -> (Layer, Transfer) {
    match picture.scale {
        Scale::Display => (Layer::data("", picture.image.clone()), Transfer::Linear),
        Scale::Linear => (Layer::color("", picture.image.clone()), Transfer::Srgb),
    }
}

/// Returns the page as text.
pub fn page(all: &[ComparedPair], extra: &[PathBuf], args: &CompareArgs) -> Result<String, Failure> {
    let data = json!({
        "reference": args.reference.to_string_lossy(),
        "picture": args.picture.to_string_lossy(),
        "tolerance": args.tolerance,
        "allow": args.allow,
        "students": text::students(all),
        "extra": extra.iter().map(|path| path.to_string_lossy()).collect::<Vec<_>>(),
        "pairs": all.iter().map(pair).collect::<Vec<_>>(),
    });
    Ok(page::with_data(PAGE, &data))
}

fn pair(compared: &ComparedPair) -> Value {
    let mut value = text::pair(compared);
    value["title"] = name(&compared.pair).into();
    if let Outcome::Compared(comparison) = &compared.outcome {
        value["causes"] = compared.causes().into();
        value["places"] = comparison.regions.iter().map(text::region_text).collect::<Vec<_>>().into();
    }
    if let Some(PairPictures { reference, picture, heat }) = &compared.pictures {
        value["images"] = json!([reference, picture, heat]);
    }
    value
}
