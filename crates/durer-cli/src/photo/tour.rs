//! `durer photo tour`: writes an HTML page for moving through photographs in 3D.

use super::args::TourArgs;
use super::inputs::{bytes_below, read, wrong};
use crate::failure::{Failure, bad};
use crate::guard::Guard;
use crate::output::save;
use crate::{page, progress};
use base64::Engine;
use base64::engine::general_purpose::STANDARD;
use durer_photo::photo;
use durer_photo::tour::tour_views;
use serde_json::json;
use std::path::Path;

/// Page template without data.
const PAGE: &str = include_str!("tour.html");

/// Runs `durer photo tour`.
pub fn run(args: &TourArgs) -> Result<(), Failure> {
    let mut guard = Guard::default();
    let all = read(&args.file, Some(&args.pictures), &mut guard)?;
    let place = guard.writes("--output", &args.output)?;
    let photographs = tour_views(&all);
    if photographs.is_empty() {
        return Err(bad(format!("no photograph of `{}` has a camera position", args.file.display())));
    }
    let names: Vec<String> = photographs.iter().map(|shown| shown.name.clone()).collect();
    let pictures = progress::each(&names, photographs.iter().collect(), args.quiet, |shown| {
        let path = args.pictures.join(&shown.name);
        let content = bytes_below(&args.pictures, Path::new(&shown.name), &mut guard)?;
        let photo = photo::read(&path.to_string_lossy(), &content).map_err(wrong)?;
        if photo.size() != shown.size {
            let ([w, h], [x, y]) = (photo.size(), shown.size);
            return Err(bad(format!(
                "`{}` is {w}x{h}, but its camera belongs to a photograph of {x}x{y}",
                path.display()
            )));
        }
        let jpeg = photo.to_jpeg(args.side).map_err(wrong)?;
        Ok(format!("data:image/jpeg;base64,{}", STANDARD.encode(jpeg)))
    });
    let pictures = pictures.into_iter().collect::<Result<Vec<_>, Failure>>()?;
    // Six decimals are more than a screen can resolve.
    let short = |value: f64| (value * 1e6).round() / 1e6;
    let points: Vec<_> = all.points.iter().map(|point| point.position.map(short).as_slice().to_vec()).collect();
    let colors: Vec<_> = all.points.iter().map(|point| point.color).collect();
    let data = json!({"photographs": photographs, "pictures": pictures, "points": points, "colors": colors});
    save(&[(&place, page::with_data(PAGE, &data).into_bytes())], args.quiet)
}
