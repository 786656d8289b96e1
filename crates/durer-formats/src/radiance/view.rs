//! Reads Radiance's views, such as `-vtv -vp 0 0 0 -vd 0 1 0 -vu 0 0 1 -vh 45 -vv 45`.

use super::words::{Word, Words};
use crate::shared_report::SharedReport;
use durer_diag::Span;
use durer_scene::camera::cylindrical::CylindricalCamera;
use durer_scene::camera::fisheye::{FisheyeCamera, FisheyeProjection};
use durer_scene::camera::{Camera, OrthographicCamera, PerspectiveCamera, ThinLensCamera};
use durer_scene::math::fp;
use durer_scene::scene::Scene;
use glam::DVec3;

/// Default length of the larger side of the picture in pixels.
pub(super) const DEFAULT_SIZE: u32 = 512;
/// Names of programs with which a view in a file can begin.
const PROGRAMS: [&str; 7] = ["VIEW=", "rpict", "rview", "rvu", "rpiece", "pinterp", "rad"];

/// Radiance view, which defines the type, position, direction and size of a camera.
#[derive(Clone, Debug)]
pub(super) struct View {
    pub kind: char,
    pub point: DVec3,
    pub direction: DVec3,
    pub up: DVec3,
    /// Horizontal and vertical size of the view, in degrees or as lengths for parallel views.
    pub size: [f64; 2],
    /// Shift of the picture as a fraction of its width and height.
    shift: [f64; 2],
    /// Distance from the view point to the near clipping plane.
    near: f64,
    at: Span,
}

impl Default for View {
    fn default() -> Self {
        View {
            kind: 'v',
            point: DVec3::ZERO,
            direction: DVec3::Y,
            up: DVec3::Z,
            size: [45.0; 2],
            shift: [0.0; 2],
            near: 0.0,
            at: Span::default(),
        }
    }
}

/// Returns the last view in a file. A view is on a line that begins with `VIEW=` or with the name
/// of a program. If the file is a picture, only its header is searched. The lines of a header can
/// also contain other options.
pub(super) fn last_view(bytes: &[u8], file: u32, report: &SharedReport) -> Option<View> {
    let (mut view, mut start) = (None, 0);
    let picture = bytes.starts_with(b"#?");
    for line in bytes.split_inclusive(|byte| *byte == b'\n') {
        if picture && line.trim_ascii().is_empty() {
            break;
        }
        let mut words = Words::new(bytes, file, start..start + line.len());
        start += line.len();
        let Some(mut first) = words.next() else { continue };
        let mut own: Vec<Word> = std::iter::from_fn(|| words.next()).collect();
        if let Some(rest) = first.text.strip_prefix("VIEW=").filter(|rest| !rest.is_empty()) {
            own.insert(0, Word { text: rest.into(), at: first.at });
            first.text.truncate(5);
        }
        let program = first.text.rsplit('/').next().unwrap_or_default();
        if PROGRAMS.contains(&program) {
            let mut new_view = View { at: first.at, ..view.unwrap_or_default() };
            new_view.options(&own, true, report);
            view = Some(new_view);
        }
    }
    if view.is_none() {
        let at = Span { file, start: 0, end: bytes.len().min(1) as u32 };
        report.error_with_help(at, "the file has no view", Some("add a line that begins with `VIEW=`".into()));
    }
    view
}

impl View {
    pub fn new(at: Span) -> View {
        View { at, ..View::default() }
    }

    /// Applies the options of a view. All other options are skipped together with their arguments.
    /// If `others` is true, unknown options that begin with `-v` are also skipped.
    pub fn options(&mut self, words: &[Word], others: bool, report: &SharedReport) {
        let mut rest = words;
        while let Some((option, more)) = rest.split_first() {
            rest = more;
            let Some(name) = option.text.strip_prefix("-v") else { continue };
            let mut numbers = |count: usize| -> Option<Vec<f64>> {
                if rest.len() < count {
                    report.error(option.at, format!("{} needs {count} numbers", option.quoted()));
                    return None;
                }
                let list = rest[..count].iter().map(|word| word.number(report)).collect();
                rest = &rest[count..];
                list
            };
            match name {
                "p" | "d" | "u" => {
                    let Some(v) = numbers(3).map(|v| DVec3::new(v[0], v[1], v[2])) else { return };
                    match name {
                        "p" => self.point = v,
                        "d" => self.direction = v,
                        _ => self.up = v,
                    }
                    if name != "p" && v.try_normalize().is_none() {
                        report.error(option.at, "a direction must not be 0 0 0");
                    }
                }
                "h" | "v" | "s" | "l" | "o" | "a" => {
                    let Some(value) = numbers(1).map(|v| v[0]) else { return };
                    match name {
                        "h" => self.size[0] = value,
                        "v" => self.size[1] = value,
                        "s" => self.shift[0] = value,
                        "l" => self.shift[1] = value,
                        "o" => self.near = value,
                        _ if value != 0.0 => {
                            report.unsupported_once(
                                option.at,
                                "the aft clipping plane has no counterpart: it is ignored",
                            );
                        }
                        _ => {}
                    }
                }
                "tv" | "tl" | "ta" | "th" | "ts" | "tc" => self.kind = name.chars().last().unwrap_or('v'),
                _ if others => {}
                _ => report.error(option.at, format!("unknown view option {}", option.quoted())),
            }
        }
    }

    /// Sets the camera of a scene and the size of its picture.
    pub fn apply(&self, scene: &mut Scene, larger: u32, report: &SharedReport) {
        if self.kind != 'l' && self.near != 0.0 {
            report
                .unsupported_once(self.at, "the fore clipping plane has a counterpart only in parallel views (`-vtl`)");
        }
        let half = |degrees: f64| 0.5 * degrees.to_radians();
        let [across, upwards] = self.size;
        let most = match self.kind {
            'v' => 179.9,
            'h' => 180.0,
            's' => 359.0,
            'l' => f64::INFINITY,
            _ => 360.0,
        };
        let above = if self.kind == 'c' { 179.9 } else { most };
        if !(across > 0.0 && across <= most && upwards > 0.0 && upwards <= above) {
            return report.error(
                self.at,
                "the sizes of a view (-vh, -vv) must be more than 0 and within the range of the type of view",
            );
        }
        if self.direction.cross(self.up).try_normalize().is_none() {
            return report.error(self.at, "the up vector (-vu) must not be parallel to the viewing direction (-vd)");
        }
        let tan = |degrees: f64| fp::tan_f64(half(degrees));
        let sides = match self.kind {
            'v' => [tan(across), tan(upwards)],
            'c' => [half(across), tan(upwards)],
            'l' => [across, upwards],
            _ => [1.0, 1.0],
        };
        let [center, direction, up] = [self.point, self.direction, self.up].map(|v: DVec3| v.as_vec3());
        let wide = sides[0] >= sides[1];
        let angle = (if wide { across } else { upwards }) as f32;
        let longest = sides[0].max(sides[1]);
        // The shift is measured in units of half the larger side.
        let [right, above] = [2.0 * self.shift[0] * sides[0] / longest, 2.0 * self.shift[1] * sides[1] / longest];
        let shifted = self.shift != [0.0; 2];
        let camera: Camera = match self.kind {
            'v' if shifted => ThinLensCamera {
                center,
                direction,
                up,
                angle,
                aperture: 0.0,
                focus_distance: 1.0,
                shift_right: right as f32,
                shift_up: above as f32,
                ..ThinLensCamera::default()
            }
            .into(),
            'v' => PerspectiveCamera { center, direction, up, angle }.into(),
            'l' => {
                let forward = self.direction.normalize();
                let aside = forward.cross(self.up).normalize();
                let moved =
                    self.point + self.shift[0] * across * aside + self.shift[1] * upwards * aside.cross(forward);
                OrthographicCamera {
                    center: moved.as_vec3(),
                    direction,
                    up,
                    size: across.max(upwards) as f32,
                    near: Some(self.near as f32),
                    ..OrthographicCamera::default()
                }
                .into()
            }
            'c' => CylindricalCamera {
                center,
                direction,
                up,
                angle: across as f32,
                vertical_angle: upwards as f32,
                ..CylindricalCamera::default()
            }
            .into(),
            kind => {
                if across != upwards {
                    report.unsupported_once(self.at, "a fisheye view shows the full disc, so its picture is square");
                }
                let projection = match kind {
                    'h' => FisheyeProjection::Orthographic,
                    's' => FisheyeProjection::Stereographic,
                    _ => FisheyeProjection::Equidistant,
                };
                FisheyeCamera { center, direction, up, angle: across.max(upwards) as f32, projection }.into()
            }
        };
        if shifted && !matches!(self.kind, 'v' | 'l') {
            report.unsupported_once(self.at, "views of this type cannot be shifted (-vs, -vl): the centre is used");
        }
        let side = |length: f64| ((f64::from(larger) * length / longest).round() as u32).max(1);
        scene.camera = Some(camera);
        scene.camera_span = self.at;
        scene.render_defaults.size = Some((side(sides[0]), side(sides[1])));
    }
}
