//! Implements `durer photo match`, which finds features in photographs and matches them.

use super::args::MatchArgs;
use super::inputs::{bytes_below, from_photo_error, name, photographs, with_threads};
use crate::failure::Failure;
use crate::file_registry::FileRegistry;
use crate::output::save;
use crate::progress;
use crate::terminal::print_error_line;
use crate::terminal::print_line;
use durer::options::memory::Memory;
use durer_photo::matching::{GUESS, Matches, Options, describe, match_all};
use durer_photo::photo;
use std::path::Path;

/// Fraction of the progress bar for finding features. Matching takes the rest.
const FEATURES: f64 = 0.5;

/// Runs `durer photo match`.
pub fn run(args: &MatchArgs) -> Result<(), Failure> {
    let mut registry = FileRegistry::default();
    let paths = photographs(&args.folder)?;
    paths.iter().try_for_each(|path| registry.register_input(path))?;
    let destination = registry.register_output("--output", &args.output)?;
    let options = Options {
        features: args.features as usize,
        max_side: args.side,
        field_of_view: args.field,
        ignore_exif: args.ignore_exif,
        seed: args.run.seed,
        ..Options::default()
    };
    let matched = progress::show_progress("matching photographs", |report| {
        let report = |share: f64| {
            if args.run.quiet {
            } else {
                report(share)
            }
        };
        let mut described = Vec::new();
        let mut doubts = Vec::new();
        for (i, path) in paths.iter().enumerate() {
            // Process one photograph at a time because photographs are large and feature detection
            // uses all threads.
            let own = Path::new(path.file_name().unwrap_or_default());
            let content = bytes_below(&args.folder, own, &mut FileRegistry::default())?;
            let photo = photo::read(&name(path), &content, Memory::default().limit()).map_err(from_photo_error)?;
            doubts.extend(photo.exif.warning.as_ref().map(|doubt| format!("{}: {doubt}", photo.name)));
            described.push(with_threads(args.run.threads, || describe(&photo, &options))?);
            report(FEATURES * (i + 1) as f64 / paths.len() as f64);
        }
        let watch = |share: f64| report(FEATURES + (1.0 - FEATURES) * share);
        let matches =
            with_threads(args.run.threads, || match_all(described, &options, &watch))?.map_err(from_photo_error)?;
        Ok::<_, Failure>((matches, doubts))
    });
    let (matches, doubts) = matched?;
    if !args.run.quiet {
        doubts.iter().for_each(|doubt| print_error_line(&format!("warning: {doubt}")));
        table(&matches);
    }
    save(&[(&destination, matches.to_json().into_bytes())], args.run.quiet)
}

/// Prints a summary of the matches.
fn table(matches: &Matches) {
    for (i, picture) in matches.pictures.iter().enumerate() {
        let partners = matches.links.iter().filter(|link| link.pictures.contains(&i));
        let (count, most) = partners.fold((0, 0), |(count, most), link| (count + 1, most.max(link.matches)));
        let [width, height] = picture.size;
        let (name, features, focal, from) = (&picture.name, picture.features, picture.focal, &picture.focal_source);
        let from = if from.starts_with(GUESS) { from.clone() } else { format!("EXIF: {from}") };
        print_line(&format!(
            "{name}: {width}x{height}, {features} features, focal length {focal:.0} ({from}); matches {count} others, \
             with at most {most} points"
        ));
    }
    for link in matches.links.iter().filter(|link| link.median_shift < 0.5) {
        let [a, b] = link.pictures.map(|i| &matches.pictures[i].name);
        print_error_line(&format!("warning: {a} and {b} are the same picture, so they provide no depth information"));
    }
    let longest = matches.tracks.iter().map(|track| track.observations.len()).max().unwrap_or(0);
    print_line(&format!("{} tracks, the longest across {longest} photographs", matches.tracks.len()));
}
