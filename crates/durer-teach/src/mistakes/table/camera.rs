//! Mistakes in camera rays and sample positions.

use super::{Mistake, Values, row};
use crate::mistakes::bugs::{Aspect, RayCount};
use durer_scene::camera::{Camera, PerspectiveCamera, Projection, UpRule};
use durer_scene::dialect::Quirk;
use durer_scene::math::{Vec2, Vec3, fp};

/// Common mistakes in camera rays and sample positions.
pub(super) const MISTAKES: &[Mistake] = &[
    row(
        "pixel-corner",
        "rays",
        "rays pass through the corners of pixels instead of their centers",
        "x = (i + 0.5) / n, y = (j + 0.5) / m",
        "x = {i|(i + 1)|i|(i + 1)} / n, y = {j|j|(j + 1)|(j + 1)} / m",
        |v, corner| v.camera_bugs.sample_position = Vec2::new(corner as u32 as f32 % 2.0, (0.5 * corner).floor()),
    )
    .with(Values::Only(&[0.0, 1.0, 2.0, 3.0])),
    row(
        "one-ray",
        "supersampling",
        "there is one ray per pixel, but the reference uses many",
        "the mean of many samples",
        "one ray through the center of each pixel",
        |v, _| v.camera_bugs.rays = RayCount::One,
    ),
    row(
        "many-rays",
        "supersampling",
        "each pixel is the mean of many rays, but the reference uses one",
        "one ray through the center of each pixel",
        "the mean of many samples",
        |v, _| v.camera_bugs.rays = RayCount::Sixteen,
    ),
    row(
        "border-pixels",
        "rays",
        "the first and last pixels are centered on the picture's border instead of inside it, or the reverse",
        "as in the scene's dialect: (i + 0.5) / n, or i / (n - 1)",
        "the other",
        |v, _| v.toggle(Quirk::BorderPixels),
    ),
    row(
        "border-of-one-axis",
        "rays",
        "the first and last {columns|rows} are centered on the picture's border instead of inside it",
        "x = (i + 0.5) / n, y = (j + 0.5) / m",
        "{x = i / (n - 1)|y = j / (m - 1)}",
        |v, axis| {
            if !v.world.rules().has(Quirk::BorderPixels) {
                v.camera_bugs.border_axes[usize::from(axis > 0.0)] = true;
            }
        },
    )
    .with(Values::Only(&[0.0, 1.0])),
    row(
        "pixel-center-over-n-less-one",
        "rays",
        "pixel centres are divided by the size minus 1",
        "x = (i + 0.5) / n, y = (j + 0.5) / m",
        "x = (i + 0.5) / (n - 1), y = (j + 0.5) / (m - {1)|1), counted from the top}",
        |v, top| {
            if !v.world.rules().has(Quirk::BorderPixels) {
                v.camera_bugs.border_axes = [true; 2];
                v.camera_bugs.sample_position = Vec2::new(1.0, if top == 0.0 { 0.0 } else { 1.0 });
            }
        },
    )
    .with(Values::Only(&[0.0, 1.0])),
    row(
        "stretch",
        "rays",
        "a non-square picture is stretched instead of cropped, or the reverse",
        "as in the scene's dialect: both axes in units of the larger side, or each in its own",
        "the other",
        |v, _| v.toggle(Quirk::Stretch),
    ),
    row(
        "aspect-smaller-side",
        "rays",
        "in a non-square picture, the angle spans the smaller side instead of the larger one",
        "larger side from -1 to 1, the other less",
        "smaller side from -1 to 1, the other more",
        |v, _| v.camera_bugs.aspect = Aspect::Smaller,
    ),
    row(
        "aspect-other-axis",
        "rays",
        "the aspect ratio is applied to the wrong axis, or divides instead of multiplying",
        "y *= height / width",
        "{y *= width / height|x *= height / width}",
        |v, x| v.camera_bugs.aspect = if x == 0.0 { Aspect::Turned } else { Aspect::Exchanged },
    )
    .with(Values::Only(&[0.0, 1.0])),
    row(
        "angle-inverted",
        "rays",
        "the distance to the picture is the tangent of half the angle, not its reciprocal",
        "D = 1 / tan(angle / 2)",
        "D = tan(angle / 2)",
        |v, _| scale(v, |angle| 1.0 / (tan(0.5 * angle) * tan(0.5 * angle))),
    ),
    row(
        "angle-not-halved",
        "rays",
        "the field of view is not halved",
        "D = 1 / tan(angle / 2)",
        "D = 1 / tan(angle)",
        |v, _| scale(v, |angle| tan(angle) / tan(0.5 * angle)),
    ),
    row(
        "angle-halved-twice",
        "rays",
        "the field of view is halved twice",
        "D = 1 / tan(angle / 2)",
        "D = 1 / tan(angle / 4)",
        |v, _| scale(v, |angle| tan(0.25 * angle) / tan(0.5 * angle)),
    ),
    row(
        "angle-not-degrees",
        "rays",
        "the field of view is interpreted as radians",
        "D = 1 / tan(angle * pi / 180 / 2)",
        "D = 1 / tan(angle / 2)",
        |v, _| {
            scale(v, |angle| (tan(0.5 * angle.to_degrees()) / tan(0.5 * angle)).abs());
            // The tangent can be negative, and then the camera looks backwards.
            if v.angle().is_some_and(|angle| tan(0.5 * angle.to_degrees()) < 0.0) {
                v.world.edit().frame.forward *= -1.0;
            }
        },
    ),
    row(
        "angle-ignored",
        "rays",
        "the field of view is ignored: the distance to the picture is 1",
        "d = D w + x u + y v, D = 1 / tan(angle / 2)",
        "d = w + x u + y v",
        |v, _| scale(v, |angle| 1.0 / tan(0.5 * angle)),
    ),
    row(
        "size",
        "rays",
        "the orthographic picture is {} times as wide as it should be",
        "o = center + x size/2 u + y size/2 v",
        "size without the half, or halved twice",
        |v, factor| {
            if v.angle().is_none() {
                v.camera_bugs.scale *= factor;
            }
        },
    )
    .with(Values::Only(&[2.0, 0.5])),
    row(
        "up-not-orthogonal",
        "rays",
        "the camera's up is made perpendicular to its direction although it should not be, or the reverse",
        "as in the scene's dialect: v = cross(u, w), or `up` as written",
        "the other",
        |v, _| {
            let raw = v.world.camera_rules().up != UpRule::Perpendicular;
            v.world.edit().camera_rules.up = if raw { UpRule::Perpendicular } else { UpRule::Raw };
            v.update_camera_basis();
        },
    ),
    row(
        "up-skew",
        "rays",
        "the camera's up is normalised, but not made perpendicular to its direction",
        "v = cross(u, w)",
        "v = normalize(up)",
        |v, _| {
            v.world.edit().camera_rules.up = UpRule::Skew;
            v.update_camera_basis();
        },
    ),
    row(
        "right-not-unit",
        "rays",
        "the camera's right is not normalised{|, but its up is}",
        "u = normalize(cross(w, up))",
        "u = cross(w, up)",
        |v, how| {
            let raw = v.world.camera_frame().forward.cross(v.world.camera().pose().up);
            let perpendicular = (v.world.camera_frame().up.dot(v.world.camera_frame().forward)).abs() < 1e-5;
            v.world.edit().frame.right = raw;
            if perpendicular && how == 0.0 {
                v.world.edit().frame.up = raw.cross(v.world.camera_frame().forward);
            }
        },
    )
    .with(Values::Only(&[0.0, 1.0])),
    row(
        "direction-not-unit",
        "rays",
        "the camera's direction is not normalised{|, and its up is computed from it}",
        "d = D normalize(direction) + x u + y v",
        "d = D direction + x u + y v{|, v = cross(u, direction)}",
        |v, up| {
            let direction = v.world.camera().pose().direction;
            if v.angle().is_some() {
                v.world.edit().frame.forward = direction;
            }
            if up > 0.0 {
                v.world.edit().frame.up *= direction.length();
            }
        },
    )
    .with(Values::Only(&[0.0, 1.0])),
    row(
        "parallel-rays-from-center",
        "rays",
        "orthographic rays end at the plane of the camera: objects behind its centre are missing",
        "t_min = -infinity for an orthographic camera",
        "t_min = 0",
        |v, _| v.camera_bugs.from_center = true,
    ),
    row(
        "orthographic-as-perspective",
        "rays",
        "the orthographic camera is a perspective one{, whose picture at distance 1 has the orthographic size|, which takes \
         the size as an angle in degrees}",
        "o = center + x size/2 u + y size/2 v, d = w",
        "o = center, d = normalize({w + x size/2 u + y size/2 v|D w + x u + y v})",
        |v, angle| {
            if let Camera::Orthographic(camera) = v.world.camera() {
                let degrees = match angle == 0.0 {
                    true => 2.0 * fp::atan2(0.5 * camera.size, 1.0).to_degrees(),
                    false => camera.size.min(170.0),
                };
                let pose = v.world.camera().pose();
                let perspective = PerspectiveCamera {
                    center: pose.center,
                    direction: pose.direction,
                    up: pose.up,
                    angle: degrees,
                };
                v.world.edit().camera = Camera::Perspective(perspective);
            }
        },
    )
    .with(Values::Only(&[0.0, 1.0])),
    row("up-default", "rays", "the camera's up is always 0 1 0", "up as written", "up = (0, 1, 0)", |v, _| {
        let frame = *v.world.camera_frame();
        let right = frame.forward.cross(Vec3::Y).normalize_or(frame.right);
        let own = &mut v.world.edit().frame;
        (own.right, own.up) = (right, right.cross(frame.forward));
    }),
    row(
        "angle-without-tangent",
        "rays",
        "half the width of the picture is {half the angle|the sine of half the angle} instead of its tangent",
        "tan(angle / 2)",
        "{angle / 2, in radians|sin(angle / 2)}",
        |v, sine| {
            scale(v, |angle| {
                let half = if sine > 0.0 {
                    fp::sin_cos_degrees(f64::from(0.5 * angle)).0 as f32
                } else {
                    0.5 * angle.to_radians()
                };
                half / tan(0.5 * angle)
            })
        },
    )
    .with(Values::Only(&[0.0, 1.0])),
    row(
        "width",
        "rays",
        "the picture shows {} times as much to each side as it should",
        "x from -tan(angle / 2) to tan(angle / 2)",
        "another angle, or a wrong factor",
        |v, factor| v.camera_bugs.scale *= factor,
    )
    .with(Values::Numbers(&[0.8, 1.2, 1.5])),
];

fn tan(degrees: f32) -> f32 {
    fp::tan_f64(f64::from(degrees).to_radians()) as f32
}

/// Scales the picture of a perspective camera by a factor that depends on the camera's field of
/// view.
fn scale(v: &mut super::SceneVariant, factor: impl Fn(f32) -> f32) {
    if let Some(angle) = v.angle() {
        v.camera_bugs.scale *= factor(angle);
    }
}
