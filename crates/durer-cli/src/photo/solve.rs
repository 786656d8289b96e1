//! Implements `durer photo solve`, which computes or adjusts cameras and points.

use super::args::SolveArgs;
use super::inputs::{bytes, from_photo_error, read, with_threads};
use super::results::{Results, report};
use crate::failure::Failure;
use crate::file_registry::FileRegistry;
use crate::progress;
use crate::terminal::{print_error_line, print_line};
use durer_photo::adjust::{self, Loss, adjust_with_progress, covariance};
use durer_photo::format::{ControlPoint, is_matches, read_control};
use durer_photo::geometry::align::align_to_control_points;
use durer_photo::matching::Matches;
use durer_photo::solve::{Options, solve};
use durer_photo::{Lens, Reconstruction};

/// Runs `durer photo solve`.
pub fn run(args: &SolveArgs) -> Result<(), Failure> {
    let mut registry = FileRegistry::default();
    let mut results = Results::new(&args.results, &mut registry)?;
    let is_file = !args.file.is_dir();
    let content = if is_file { bytes(&args.file, &mut registry)? } else { [].into() };
    let file = args.file.to_string_lossy();
    let (mut all, control) = match is_matches(&content) {
        true => {
            let matches = Matches::from_json(&file, &content).map_err(from_photo_error)?;
            let names: Vec<&str> = matches.pictures.iter().map(|picture| &*picture.name).collect();
            let control = control(args, &names, &mut registry)?;
            (incremental(args, &matches)?, control)
        }
        false => {
            let all = read_input(args, &mut registry)?;
            let names: Vec<&str> = all.views.iter().map(|view| &*view.name).collect();
            let control = control(args, &names, &mut registry)?;
            (adjusted(args, all)?, control)
        }
    };
    if let Some(control) = control {
        let (similarity, left) = align_to_control_points(&all, &control).map_err(from_photo_error)?;
        similarity.apply_to(&mut all);
        let worst = left.iter().fold(0.0_f64, |m, d| m.max(*d));
        if !args.run.quiet {
            let (count, scale) = (left.len(), similarity.scale);
            print_line(&format!("aligned with {count} control points, scale {scale:.6}; largest distance {worst:.4}"));
        }
    }
    if !args.run.quiet {
        report(&all);
        all.lenses.iter().enumerate().for_each(|(i, lens)| print_line(&lens_line(&all, i, lens)));
    }
    if args.covariance {
        print_standard_deviations(args, &all)?;
    }
    results.add(&all)?;
    results.save(args.run.quiet)
}

fn lens_line(all: &Reconstruction, number: usize, lens: &Lens) -> String {
    let views = all.views.iter().filter(|view| view.lens == number && view.pose.is_some()).count();
    let (f, [k1, k2]) = (lens.focal, lens.distortion);
    format!("lens {}: focal length {f:.3} pixels, k1 {k1:.6}, k2 {k2:.6}; {views} photographs", number + 1)
}

/// Reads the control points before the other work, so that errors in their file are reported at
/// once.
fn control(
    args: &SolveArgs,
    names: &[&str],
    registry: &mut FileRegistry,
) -> Result<Option<Vec<ControlPoint>>, Failure> {
    let Some(path) = &args.control else { return Ok(None) };
    read_control(&path.to_string_lossy(), &bytes(path, registry)?, names).map(Some).map_err(from_photo_error)
}

/// Computes cameras and points from matches, one photograph after another.
fn incremental(args: &SolveArgs, matches: &Matches) -> Result<Reconstruction, Failure> {
    let options = Options {
        fixed_focal: args.fixed_focal,
        no_distortion: args.no_distortion,
        own_lenses: args.own_lenses,
        threshold: args.threshold,
        seed: args.run.seed,
        ..Options::default()
    };
    let count = matches.pictures.len() as f64;
    let solved = progress::show_progress("solving", |share| {
        let watch = |known: usize| {
            if args.run.quiet {
            } else {
                share(known as f64 / count)
            }
        };
        with_threads(args.run.threads, || solve(matches, &options, &watch))
    });
    let solved = solved?.map_err(from_photo_error)?;
    if !args.run.quiet {
        solved.notes.iter().for_each(|note| print_error_line(&format!("note: {note}")));
    }
    Ok(solved.reconstruction)
}

/// Reads a file that already contains cameras.
fn read_input(args: &SolveArgs, registry: &mut FileRegistry) -> Result<Reconstruction, Failure> {
    let mut all = read(&args.file, args.pictures.as_deref(), registry)?;
    if args.own_lenses {
        all.lenses = all.views.iter().map(|view| all.lenses[view.lens]).collect();
        all.views.iter_mut().enumerate().for_each(|(i, view)| view.lens = i);
    }
    Ok(all)
}

/// Adjusts the cameras and points of a file.
fn adjusted(args: &SolveArgs, mut all: Reconstruction) -> Result<Reconstruction, Failure> {
    let before = all.reprojection_error();
    if before.observations == 0 {
        return Err(crate::invalid_input(format!(
            "`{}` has no observations: there is nothing to adjust",
            args.file.display()
        )));
    }
    let options = options(args);
    let report = progress::show_progress("adjusting", |share| {
        let watch = |step: usize, _: f64| {
            if args.run.quiet {
            } else {
                share(step as f64 / options.iterations as f64)
            }
        };
        with_threads(args.run.threads, || adjust_with_progress(&mut all, &options, &watch))
    })?;
    if !args.run.quiet {
        let (steps, end) = (report.costs.len() - 1, if report.converged { "converged" } else { "not converged" });
        print_line(&format!("before the adjustment: cost {:.6e}, rms {:.4} pixels", before.cost, before.rms));
        print_line(&format!("{end} after {steps} steps"));
    }
    Ok(all)
}

fn options(args: &SolveArgs) -> adjust::Options {
    let loss = match &*args.loss {
        "huber" => Loss::Huber(1.0),
        "cauchy" => Loss::Cauchy(1.0),
        _ => Loss::Squared,
    };
    adjust::Options { loss, focal: !args.fixed_focal, radial: !args.no_distortion, ..adjust::Options::default() }
}

/// Prints the standard deviations of the cameras.
fn print_standard_deviations(args: &SolveArgs, all: &Reconstruction) -> Result<(), Failure> {
    let covariance = covariance(all, &options(args)).map_err(from_photo_error)?;
    print_line(&format!(
        "standard deviations, for an error of {:.3} pixels in each coordinate; the first photograph is fixed:",
        covariance.sigma
    ));
    for (view, _) in &covariance.views {
        let (name, place) = (&all.views[*view].name, covariance.position_deviation(all, *view).unwrap_or(0.0));
        let turn = covariance.pose(*view).map_or(0.0, |c| c.fixed_view::<3, 3>(0, 0).trace().max(0.0).sqrt());
        print_line(&format!("{name}: position {place:.6}, direction {:.4} degrees", turn.to_degrees()));
    }
    Ok(())
}
