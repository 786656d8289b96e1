//! Implements `durer photo camera`, which computes the camera of one photograph.

use super::args::CameraArgs;
use super::inputs::{bytes, from_photo_error};
use crate::failure::{Failure, invalid_input};
use crate::file_registry::FileRegistry;
use crate::output::save;
use crate::terminal::print_error_line;
use crate::terminal::print_line;
use durer_photo::format::{projective_camera, read_lines, read_points, read_project};
use durer_photo::photo;
use durer_photo::resect::{LensPriors, camera, from_vanishing_lines};
use durer_photo::{Lens, Pose};

/// Runs `durer photo camera`.
pub fn run(args: &CameraArgs) -> Result<(), Failure> {
    let mut registry = FileRegistry::default();
    let file = args.picture.to_string_lossy();
    let content = bytes(&args.picture, &mut registry)?;
    let destination = args.output.as_ref().map(|path| registry.register_output("--output", path)).transpose()?;
    let report = |line: String| {
        if args.quiet {
        } else {
            print_error_line(&line)
        }
    };
    let (lens, pose): (Lens, Pose) = if args.picture.extension().is_some_and(|end| end == "fspy") {
        let (lines, _) = read_project(&file, &content).map_err(from_photo_error)?;
        from_vanishing_lines(&lines, args.distance).map_err(from_photo_error)?
    } else if let Some(path) = &args.lines {
        let size = photo::size(&file, &content).map_err(from_photo_error)?;
        let lines =
            read_lines(&path.to_string_lossy(), &bytes(path, &mut registry)?, size).map_err(from_photo_error)?;
        from_vanishing_lines(&lines, args.distance).map_err(from_photo_error)?
    } else if let Some(path) = &args.points {
        let size = photo::size(&file, &content).map_err(from_photo_error)?;
        let pairs = read_points(&path.to_string_lossy(), &bytes(path, &mut registry)?).map_err(from_photo_error)?;
        let threshold = args.threshold.unwrap_or(0.005 * f64::from(size[0].max(size[1])));
        let priors = LensPriors { size, focal: args.focal, distortion: args.distortion, threshold };
        let estimate = camera(&pairs, &priors).map_err(from_photo_error)?;
        report(format!(
            "{} of {} points agree with the camera; rms {:.3} pixels",
            estimate.inliers.len(),
            pairs.len(),
            estimate.rms
        ));
        for i in (0..pairs.len()).filter(|i| !estimate.inliers.contains(i)) {
            report(format!("point {} does not agree with the camera: its position or its pixel is wrong", i + 1));
        }
        report(format!(
            "conditioning {:.2e} (ratio of the smallest to the largest singular value)",
            estimate.conditioning
        ));
        (estimate.lens, estimate.pose)
    } else {
        return Err(invalid_input("pass known points or lines of the photograph: --points FILE or --lines FILE"));
    };
    let (c, f) = (pose.center(), lens.focal);
    report(format!("taken at ({:.6}, {:.6}, {:.6}); focal length {f:.3} pixels", c.x, c.y, c.z));
    let text = projective_camera(&lens, &pose);
    match destination {
        Some(destination) => save(&[(&destination, text.into_bytes())], args.quiet),
        None => {
            print_line(text.trim_end());
            Ok(())
        }
    }
}
