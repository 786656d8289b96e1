//! Explains the position of a camera or a point by writing out the projection equations with their
//! numbers.

use crate::adjust::{Options, covariance};
use crate::{Error, Reconstruction};
use std::fmt::Write;

/// Returns an explanation of a point that lists the ray and the residual in each photograph that
/// observes it.
pub fn point(reconstruction: &Reconstruction, number: usize) -> Result<String, Error> {
    let count = reconstruction.points.len();
    let point = reconstruction.points.get(number).ok_or_else(|| {
        Error::new(format!("point {number} does not exist: the file has {count} points, numbered from 0"))
    })?;
    let p = point.position;
    let angle = reconstruction.max_ray_angle(point).to_degrees();
    let mut text = format!("point {number} at ({:.6}, {:.6}, {:.6}), colour {:?}\n", p.x, p.y, p.z, point.color);
    match point.track.len() {
        0 => text.push_str("the file has no observations of this point\n"),
        count => {
            let _ =
                writeln!(text, "seen in {count} photographs; the widest angle between two rays is {angle:.2} degrees");
            if angle < 1.0 {
                text.push_str("the rays are nearly parallel, so the distance of the point is uncertain\n");
            }
        }
    }
    for observation in &point.track {
        let view = &reconstruction.views[observation.view];
        let (Some(pose), Some(residual)) = (&view.pose, reconstruction.residual(&p, observation)) else { continue };
        let (c, d) = (pose.center(), (p - pose.center()).normalize());
        let _ = writeln!(text, "\n{}", view.name);
        let _ = writeln!(
            text,
            "  ray        from ({:.6}, {:.6}, {:.6}) along ({:.6}, {:.6}, {:.6})",
            c.x, c.y, c.z, d.x, d.y, d.z
        );
        let _ = writeln!(text, "  distance   {:.6}; along the viewing direction {:.6}", (p - c).norm(), pose.depth(&p));
        let pixel = observation.pixel + residual;
        let _ = writeln!(text, "  projected  ({:.3}, {:.3})", pixel.x, pixel.y);
        let _ = writeln!(text, "  observed   ({:.3}, {:.3})", observation.pixel.x, observation.pixel.y);
        let _ = writeln!(text, "  residual   ({:.3}, {:.3}), {:.3} pixels", residual.x, residual.y, residual.norm());
    }
    Ok(text)
}

/// Returns the index of the photograph with this name or number.
pub fn find_view(reconstruction: &Reconstruction, name: &str) -> Result<usize, Error> {
    let number = reconstruction.views.iter().position(|view| view.name == name).or_else(|| name.parse().ok());
    number.filter(|number| *number < reconstruction.views.len()).ok_or_else(|| {
        let names: Vec<&str> = reconstruction.views.iter().take(8).map(|view| &*view.name).collect();
        Error::new(format!("no photograph `{name}`; known photographs: {}", names.join(", ")))
    })
}

/// Returns an explanation of a camera. It contains the projection equations of the first points,
/// their residuals, and how well the camera is determined.
pub fn camera(reconstruction: &Reconstruction, view: usize) -> Result<String, Error> {
    let name = &reconstruction.views[view].name;
    let pose = reconstruction.views[view].pose.ok_or_else(|| Error::new(format!("the pose of {name} is unknown")))?;
    let lens = reconstruction.lenses[reconstruction.views[view].lens];
    let (c, r, t) = (pose.center(), pose.rotation, pose.translation);
    let mut text = format!("{name}\n\nP = R X + t, from the world to the camera (x right, y down, z forward):\n\n");
    for i in 0..3 {
        let _ = writeln!(
            text,
            "  P.{}   | {:9.6} {:9.6} {:9.6} |       {:11.6}",
            ["x", "y", "z"][i],
            r[(i, 0)],
            r[(i, 1)],
            r[(i, 2)],
            t[i]
        );
    }
    let _ = writeln!(text, "\ntaken at -Rᵀ t = ({:.6}, {:.6}, {:.6})", c.x, c.y, c.z);
    let ([k1, k2], [cx, cy]) = (lens.distortion, lens.principal_point);
    let _ = writeln!(text, "\npixel = ({cx}, {cy}) + {:.3} r (P.x / P.z, {} P.y / P.z)", lens.focal, lens.aspect);
    let _ = writeln!(text, "r = 1 {k1:+.6} s {k2:+.6} s², where s = (P.x² + P.y²) / P.z²\n");
    let mut squares: Vec<(f64, usize)> = Vec::new();
    for (i, point) in reconstruction.points.iter().enumerate() {
        let observation = point.track.iter().find(|other| other.view == view);
        let Some((observation, residual)) =
            observation.and_then(|other| Some((other, reconstruction.residual(&point.position, other)?)))
        else {
            continue;
        };
        if squares.len() < 4 {
            let (x, p) = (point.position, pose.apply(&point.position));
            let s = (p.x * p.x + p.y * p.y) / (p.z * p.z);
            let at = observation.pixel + residual;
            let _ = writeln!(
                text,
                "point {i}, X = ({:.4}, {:.4}, {:.4}): P = ({:.4}, {:.4}, {:.4})",
                x.x, x.y, x.z, p.x, p.y, p.z
            );
            for (axis, middle, along, focal, at, observed) in [
                ("x", cx, p.x, lens.focal, at.x, observation.pixel.x),
                ("y", cy, p.y, lens.focal * lens.aspect, at.y, observation.pixel.y),
            ] {
                let r = lens.distortion_factor(s);
                let (z, off) = (p.z, at - observed);
                let _ = writeln!(
                    text,
                    "  {axis}: {middle:.1} + {focal:.3} * {r:.6} * {along:.4} / {z:.4} = {at:.3}, observed \
                     {observed:.3}, residual {off:+.3}"
                );
            }
        }
        squares.push((residual.norm_squared(), i));
    }
    if squares.is_empty() {
        text.push_str("the file has no observations in this photograph\n");
        return Ok(text);
    }
    let count = squares.len();
    let rms = (squares.iter().map(|s| s.0).sum::<f64>() / count.max(1) as f64).sqrt();
    let _ = writeln!(text, "\n{} equations of {count} points; rms {rms:.3} pixels", 2 * count);
    squares.sort_by(|a, b| b.0.total_cmp(&a.0).then(a.1.cmp(&b.1)));
    for (square, i) in squares.iter().take(3) {
        let _ = writeln!(text, "  worst: point {i}, {:.3} pixels", square.sqrt());
    }
    let points: Vec<_> = squares.iter().map(|(_, i)| reconstruction.points[*i].position).collect();
    let [first, second, third] = crate::geometry::camera::principal_deviations(&points);
    let _ = writeln!(text, "the points spread {first:.4}, {second:.4}, {third:.4} along their principal axes");
    if count < 6 {
        text.push_str("fewer than six points do not determine the camera (DLT has eleven unknowns)\n");
    } else if third <= 1e-3 * first {
        text.push_str("the points lie in a plane, so DLT has no unique solution\n");
    }
    match covariance(reconstruction, &Options::default()) {
        Err(error) => {
            let _ = writeln!(text, "the uncertainty of the camera cannot be computed: {error}");
        }
        Ok(covariance) => {
            if let (Some(deviation), Some(pose_covariance)) =
                (covariance.position_deviation(reconstruction, view), covariance.pose(view))
            {
                let turn = pose_covariance.fixed_view::<3, 3>(0, 0).trace().max(0.0).sqrt().to_degrees();
                let _ = writeln!(
                    text,
                    "standard deviations, for {:.3} pixels: position {deviation:.6}, direction {turn:.4} degrees (the first photograph is fixed)",
                    covariance.sigma
                );
            }
        }
    }
    Ok(text)
}
