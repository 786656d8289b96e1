//! Implements `durer photo tour`, which writes an HTML page for moving through photographs in 3D.

use super::args::TourArgs;
use super::inputs::{bytes_below, from_photo_error, read};
use crate::failure::{Failure, invalid_input};
use crate::file_registry::FileRegistry;
use crate::output::save;
use crate::page::{Report, TourPhotograph, TourReport, with_data};
use crate::progress;
use base64::Engine;
use base64::engine::general_purpose::STANDARD;
use durer::options::memory::Memory;
use durer_photo::photo;
use durer_photo::tour::tour_views;
use std::path::Path;

/// Runs `durer photo tour`.
pub fn run(args: &TourArgs) -> Result<(), Failure> {
    let mut registry = FileRegistry::default();
    let all = read(&args.file, Some(&args.pictures), &mut registry)?;
    let destination = registry.register_output("--output", &args.output)?;
    let photographs = tour_views(&all);
    if photographs.is_empty() {
        return Err(invalid_input(format!("no photograph of `{}` has a camera position", args.file.display())));
    }
    let names: Vec<String> = photographs.iter().map(|photograph| photograph.name.clone()).collect();
    let pictures = progress::each(&names, photographs.iter().collect(), args.quiet, |photograph| {
        let path = args.pictures.join(&photograph.name);
        let content = bytes_below(&args.pictures, Path::new(&photograph.name), &mut registry)?;
        let photo =
            photo::read(&path.to_string_lossy(), &content, Memory::default().limit()).map_err(from_photo_error)?;
        if photo.size() != photograph.size {
            let ([w, h], [x, y]) = (photo.size(), photograph.size);
            return Err(invalid_input(format!(
                "`{}` is {w}x{h}, but its camera belongs to a photograph of {x}x{y}",
                path.display()
            )));
        }
        let jpeg = photo.to_jpeg(args.side).map_err(from_photo_error)?;
        Ok(format!("data:image/jpeg;base64,{}", STANDARD.encode(jpeg)))
    });
    let pictures = pictures.into_iter().collect::<Result<Vec<_>, Failure>>()?;
    // Six decimal places are more than a screen can resolve.
    let short = |value: f64| (value * 1e6).round() / 1e6;
    let photographs = photographs.into_iter().zip(pictures).map(|(view, picture)| TourPhotograph {
        name: view.name,
        picture,
        size: view.size,
        focal: view.focal,
        center: view.center,
        rotation: view.rotation,
        corners: view.corners,
        points: view.points,
    });
    let report = Report::Tour(TourReport {
        photographs: photographs.collect(),
        points: all.points.iter().map(|point| point.position.map(short).into()).collect(),
        colors: all.points.iter().map(|point| point.color).collect(),
    });
    save(&[(&destination, with_data(&report)?.into_bytes())], args.quiet)
}
