//! `durer photo camera`: computes the camera of one photograph.

use super::args::CameraArgs;
use super::inputs::{bytes, wrong};
use crate::failure::{Failure, bad};
use crate::guard::Guard;
use crate::output::save;
use crate::terminal::complain;
use crate::terminal::say;
use durer_photo::format::{projective_camera, read_lines, read_points, read_project};
use durer_photo::photo;
use durer_photo::resect::{LensPriors, camera, from_vanishing_lines};
use durer_photo::{Lens, Pose};

/// Runs `durer photo camera`.
pub fn run(args: &CameraArgs) -> Result<(), Failure> {
    let mut guard = Guard::default();
    let file = args.picture.to_string_lossy();
    let content = bytes(&args.picture, &mut guard)?;
    let place = args.output.as_ref().map(|path| guard.writes("--output", path)).transpose()?;
    let report = |line: String| {
        if args.quiet {
        } else {
            complain(&line)
        }
    };
    let (lens, pose): (Lens, Pose) = if args.picture.extension().is_some_and(|end| end == "fspy") {
        let (lines, _) = read_project(&file, &content).map_err(wrong)?;
        from_vanishing_lines(&lines, args.distance).map_err(wrong)?
    } else if let Some(path) = &args.lines {
        let size = photo::size(&file, &content).map_err(wrong)?;
        let lines = read_lines(&path.to_string_lossy(), &bytes(path, &mut guard)?, size).map_err(wrong)?;
        from_vanishing_lines(&lines, args.distance).map_err(wrong)?
    } else if let Some(path) = &args.points {
        let size = photo::size(&file, &content).map_err(wrong)?;
        let pairs = read_points(&path.to_string_lossy(), &bytes(path, &mut guard)?).map_err(wrong)?;
        let threshold = args.threshold.unwrap_or(0.005 * f64::from(size[0].max(size[1])));
        let known = LensPriors { size, focal: args.focal, distortion: args.distortion, threshold };
        let found = camera(&pairs, &known).map_err(wrong)?;
        report(format!("{} of {} points agree; rms {:.3} pixels", found.inliers.len(), pairs.len(), found.rms));
        for i in (0..pairs.len()).filter(|i| !found.inliers.contains(i)) {
            report(format!("point {} does not agree: its position or its pixel is wrong", i + 1));
        }
        report(format!("conditioning {:.2e}: ratio of the worst to the best determined direction", found.conditioning));
        (found.lens, found.pose)
    } else {
        return Err(bad("pass known points or lines of the photograph: --points FILE or --lines FILE"));
    };
    let (c, f) = (pose.center(), lens.focal);
    report(format!("taken at ({:.6}, {:.6}, {:.6}); focal length {f:.3} pixels", c.x, c.y, c.z));
    let text = projective_camera(&lens, &pose);
    match place {
        Some(place) => save(&[(&place, text.into_bytes())], args.quiet),
        None => {
            say(text.trim_end());
            Ok(())
        }
    }
}
