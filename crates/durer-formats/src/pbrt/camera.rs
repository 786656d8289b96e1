//! Reads the film, camera, sampler and integrator.

use super::language::Language;
use super::params::Params;
use super::state::{DeferredDirective, Reader};
use crate::shared_report::NO_COUNTERPART;
use crate::shared_report::suggest;
use durer_image::MAX_PIXELS;
use durer_scene::camera::{
    Camera, EquirectangularCamera, Handedness, OrthographicCamera, PerspectiveCamera, ThinLensCamera,
};
use durer_scene::math::fp;
use glam::{DAffine3, DVec2, DVec3};

/// Default resolution of the film in pbrt-v4, then in pbrt-v3.
const SIZE: (u32, u32) = (1280, 720);
const OLD_SIZE: (u32, u32) = (640, 480);

/// Position and axes (right, up and forward) of a pbrt camera in world space. The length of each
/// axis is the length of one unit of camera space along that axis.
struct CameraFrame {
    center: DVec3,
    axes: [DVec3; 3],
}

impl CameraFrame {
    fn new(to_world: DAffine3) -> Self {
        let m = to_world.matrix3;
        CameraFrame { center: to_world.translation, axes: [m.x_axis, m.y_axis, m.z_axis] }
    }

    /// Returns `Handedness::Left` if the picture is mirrored, which means that `right` points to
    /// the left of a viewer who looks along `forward`.
    fn handedness(right: DVec3, up: DVec3, forward: DVec3) -> Handedness {
        if forward.cross(up).dot(right) < 0.0 { Handedness::Left } else { Handedness::Right }
    }
}

/// Part of a film in pixels: its first column, its first row, its number of columns and its number
/// of rows.
type CropWindow = (u32, u32, u32, u32);

/// Reads the crop window of a film.
///
/// Source: *Physically Based Rendering*, 4th edition, section 5.4.2. The window is given as
/// `pixelbounds` in pixels, or as `cropwindow` in fractions of the film, which are rounded up to
/// whole pixels. Both parameters list the first and last x, then the first and last y. The last x
/// and y are exclusive.
fn crop(params: &Params, (width, height): (u32, u32)) -> Option<CropWindow> {
    let sides = [width, width, height, height].map(f64::from);
    let mut part = [0.0, sides[0], 0.0, sides[2]];
    let mut size_parameter = None;
    for (name, is_share) in [("pixelbounds", false), ("cropwindow", true)] {
        let Some(all) = params.get(name).map(|param| param.numbers()) else { continue };
        let Ok(all) = <[f64; 4]>::try_from(all) else {
            params.report.error(
                params.span(name),
                format!("`{name}` needs four numbers: minimum x, maximum x, minimum y and maximum y"),
            );
            return None;
        };
        let pixel = |i: usize| if is_share { (all[i] * sides[i]).ceil() } else { all[i] };
        part = std::array::from_fn(|i| pixel(i).clamp(0.0, sides[i]));
        size_parameter = Some(name);
    }
    let [left, right, top, bottom] = part.map(|pixel| pixel as u32);
    if left >= right || top >= bottom {
        params.report.error(params.span(size_parameter?), "this part of the film contains no pixels");
        return None;
    }
    size_parameter.map(|_| (left, top, right - left, bottom - top))
}

/// Screen window of a pbrt camera: the visible rectangle of the plane in front of the camera, with
/// y pointing up.
struct Window {
    middle: DVec2,
    half: DVec2,
}

impl Reader<'_> {
    /// Creates the scene's camera from the camera and film directives.
    pub fn make_camera(&mut self) {
        let ((width, height), crop) = self.film_size();
        let Some(directive) = self.camera.take() else { return };
        self.scene.render_defaults.size = Some((width, height));
        self.scene.render_defaults.crop = crop;
        let params = self.params_of(&directive);
        if directive.transforms.moves() {
            self.report.unsupported_once(
                directive.at,
                "motion has no counterpart: everything stays where it is when the shutter opens",
            );
        }
        let placed = CameraFrame::new(directive.transforms.maps[0].inverse());
        let [a, b, c] = placed.axes.map(DVec3::normalize_or_zero);
        if a.dot(b).abs().max(a.dot(c).abs()).max(b.dot(c).abs()) > 1e-4 {
            self.report.unsupported(directive.at, "a sheared camera has no counterpart: perpendicular axes are used");
        }
        let camera = match directive.kind.as_str() {
            "perspective" => Some(self.perspective(&placed, &params, (width, height), None)),
            "orthographic" => self.orthographic(&placed, &params, (width, height)),
            "spherical" => Some(self.spherical(&placed, &params)),
            "environment" if self.language == Language::V3 => Some(self.spherical(&placed, &params)),
            "realistic" => {
                let what = "a realistic camera has no counterpart: a field of view of 38 degrees across the film's \
                            diagonal is used";
                self.report.unsupported(directive.at, what);
                params.mark_known(&["lensfile", "aperturediameter", "focusdistance", "aperture", "scale"]);
                let diagonal = DVec2::new(f64::from(width), f64::from(height));
                let half = fp::tan_f64(19f64.to_radians()) * diagonal.min_element() / diagonal.length();
                Some(self.perspective(&placed, &params, (width, height), Some(half)))
            }
            other => {
                let help = suggest(other, ["perspective", "orthographic", "spherical", "realistic"]);
                self.report.error_with_help(directive.at, format!("unknown camera `{other}`"), help);
                None
            }
        };
        params.mark_known(&["shutteropen", "shutterclose"]);
        params.warn_unused("this camera");
        self.scene.camera = camera;
        self.scene.camera_span = directive.at;
    }

    /// Returns the resolution of the film and its crop window.
    fn film_size(&self) -> ((u32, u32), Option<CropWindow>) {
        let third = self.language == Language::V3;
        let default = if third { OLD_SIZE } else { SIZE };
        let Some(film) = &self.film else { return (default, None) };
        let params = self.params_of(film);
        let kinds = if third { &["image"][..] } else { &["rgb", "gbuffer", "spectral"][..] };
        if !kinds.contains(&film.kind.as_str()) {
            let help = suggest(&film.kind, kinds.iter().copied());
            self.report.error_with_help(film.at, format!("unknown film `{}`", film.kind), help);
        }
        let side = |name: &'static str, default: u32| match params.integer(name) {
            Some(value) if (1..=1 << 20).contains(&value) => value as u32,
            Some(_) => {
                params.report.error(params.span(name), format!("`{name}` must be from 1 to {}", 1 << 20));
                default
            }
            None => default,
        };
        let (width, height) = (side("xresolution", default.0), side("yresolution", default.1));
        if u64::from(width) * u64::from(height) > MAX_PIXELS {
            params.report.error(film.at, format!("too many pixels: {width} x {height}"));
        }
        if let Some(sensor) = params.text("sensor").filter(|sensor| *sensor != "cie1931") {
            let what = format!("the sensor `{sensor}` has no counterpart: `cie1931` is used");
            params.report.unsupported(params.span("sensor"), what);
        }
        params.warn_unsupported(&["whitebalance"], "colours are not white-balanced");
        let crop = crop(&params, (width, height));
        let unseen = ["filename", "diagonal", "iso", "maxcomponentvalue", "savefp16", "coordinatesystem"];
        params.mark_known(&unseen);
        params.mark_known(&["nbuckets", "lambdamin", "lambdamax"]);
        if third {
            params.mark_known(&["scale", "maxsampleluminance"]);
        }
        params.warn_unused("this film");
        ((width, height), crop)
    }

    /// Returns the factor that converts radiance to pixel values. In pbrt-v4, the factor is the
    /// shutter time times ISO / 100. In pbrt-v3, it is the film's `scale`.
    ///
    /// Source: *Physically Based Rendering*, 4th edition, section 5.4.2, and 3rd edition, section
    /// 7.9.
    pub fn exposure(&self) -> f32 {
        if self.language == Language::V3 {
            let scale = self.film.as_ref().and_then(|film| self.params_of(film).float("scale"));
            return scale.unwrap_or(1.0).max(0.0);
        }
        let film = self.film.as_ref().and_then(|film| self.params_of(film).float("iso"));
        let open = self.camera.as_ref().map(|camera| {
            let params = self.params_of(camera);
            params.float("shutterclose").unwrap_or(1.0) - params.float("shutteropen").unwrap_or(0.0)
        });
        (open.unwrap_or(1.0) * film.unwrap_or(100.0) / 100.0).max(0.0)
    }

    /// Reads the screen window, in units of half the length of the picture's shorter side.
    fn window(&self, params: &Params, (width, height): (u32, u32)) -> Window {
        let aspect = params.positive("frameaspectratio").unwrap_or(width as f32 / height as f32);
        let aspect = f64::from(aspect);
        match params.floats("screenwindow") {
            Some(&[x0, x1, y0, y1]) if x1 > x0 && y1 > y0 => {
                Window { middle: 0.5 * DVec2::new(x0 + x1, y0 + y1), half: 0.5 * DVec2::new(x1 - x0, y1 - y0) }
            }
            size_parameter => {
                if size_parameter.is_some() {
                    params.report.error(
                        params.span("screenwindow"),
                        "`screenwindow` needs four numbers: minimum x, maximum x, minimum y and maximum y",
                    );
                }
                Window { middle: DVec2::ZERO, half: DVec2::new(aspect.max(1.0), (1.0 / aspect).max(1.0)) }
            }
        }
    }

    /// Returns half the length of the window's larger side, and the offset of its centre as a
    /// fraction of that length. Warns if the pixels are not square.
    fn half_larger_side(&self, window: &Window, (width, height): (u32, u32), params: &Params) -> (f64, DVec2) {
        let (x, y) = (window.half.x / f64::from(width), window.half.y / f64::from(height));
        if (x / y - 1.0).abs() > 2e-3 {
            params.report.unsupported(
                params.at,
                "pixels that are not square have no counterpart: the view across the larger side is used",
            );
        }
        let half = if width >= height { window.half.x } else { window.half.y };
        (half, window.middle / half)
    }

    /// Reads a perspective camera. If `half` is given, it is half the width of the picture's
    /// shorter side at distance 1, and it replaces the field of view.
    fn perspective(&self, placed: &CameraFrame, params: &Params, size: (u32, u32), half: Option<f64>) -> Camera {
        let [a, b, c] = placed.axes;
        let (default, mut window) = (half.map_or(90.0, |_| 90.0), self.window(params, size));
        let fov = params.float("fov").unwrap_or(default);
        let fov = params.float("halffov").map_or(fov, |half| 2.0 * half);
        if !(fov > 0.0 && fov < 180.0) {
            params.report.error(params.span("fov"), "a field of view must be more than 0 and less than 180 degrees");
        }
        let scale = half.unwrap_or_else(|| fp::tan_f64(f64::from(fov.clamp(1e-3, 179.9)).to_radians() / 2.0));
        // A non-uniform scale of camera space changes the width of the view.
        let across = scale * DVec2::new(a.length(), b.length()) / c.length();
        (window.half, window.middle) = (window.half * across, window.middle * across);
        let (half, shift) = self.half_larger_side(&window, size, params);
        let angle = ((2.0 * fp::atan_f64(half)).to_degrees() as f32).clamp(1e-4, 179.99);
        let lens = params.float("lensradius").unwrap_or(0.0).max(0.0);
        let focus = params.float("focaldistance").unwrap_or(1e6).max(f32::MIN_POSITIVE);
        let handedness = CameraFrame::handedness(a, b, c);
        let [center, direction, up] = [placed.center, c.normalize(), b.normalize()].map(|v| v.as_vec3());
        if lens == 0.0 && handedness == Handedness::Right && shift == DVec2::ZERO {
            return PerspectiveCamera { center, direction, up, angle }.into();
        }
        ThinLensCamera {
            center,
            direction,
            up,
            angle,
            aperture: 2.0 * lens * (0.5 * (a.length() + b.length())) as f32,
            focus_distance: if lens > 0.0 { focus * c.length() as f32 } else { 1.0 },
            shift_right: shift.x as f32,
            shift_up: shift.y as f32,
            handedness,
            ..ThinLensCamera::default()
        }
        .into()
    }

    fn orthographic(&self, placed: &CameraFrame, params: &Params, size: (u32, u32)) -> Option<Camera> {
        let [a, b, c] = placed.axes;
        let mut window = self.window(params, size);
        let middle = placed.center + window.middle.x * a + window.middle.y * b;
        window.half *= DVec2::new(a.length(), b.length());
        let (half, _) = self.half_larger_side(&window, size, params);
        params.warn_unsupported(&["lensradius"], "everything is in focus");
        params.mark_known(&["focaldistance"]);
        let camera = OrthographicCamera {
            center: middle.as_vec3(),
            direction: c.normalize().as_vec3(),
            up: b.normalize().as_vec3(),
            size: (2.0 * half) as f32,
            handedness: CameraFrame::handedness(a, b, c),
            near: Some(0.0),
            far: None,
        };
        Some(camera.into())
    }

    /// Reads a spherical camera. The centre of the picture shows the direction -x.
    fn spherical(&self, placed: &CameraFrame, params: &Params) -> Camera {
        let [a, b, c] = placed.axes;
        if self.language == Language::V3 {
            params.mark_known(&["frameaspectratio", "screenwindow", "lensradius", "focaldistance"]);
        } else if params.text("mapping").unwrap_or("equalarea") != "equirectangular" {
            params
                .report
                .unsupported(params.at, "the mapping `equalarea` has no counterpart: `equirectangular` is used");
        }
        EquirectangularCamera {
            center: placed.center.as_vec3(),
            direction: -a.normalize().as_vec3(),
            up: b.normalize().as_vec3(),
            handedness: CameraFrame::handedness(-c, b, -a),
            ..EquirectangularCamera::default()
        }
        .into()
    }

    /// Reads the integrator. `maxdepth` includes the first scattering event, but Dürer's `bounces`
    /// does not.
    pub fn integrator(&mut self, directive: &DeferredDirective) {
        const V3_NAMES: [&str; 9] =
            ["path", "volpath", "bdpt", "mlt", "sppm", "ambientocclusion", "ao", "directlighting", "whitted"];
        const V4_NAMES: [&str; 11] = [
            "path",
            "volpath",
            "simplepath",
            "simplevolpath",
            "bdpt",
            "mlt",
            "sppm",
            "lightpath",
            "randomwalk",
            "ambientocclusion",
            "function",
        ];
        let params = self.params_of(directive);
        let known = if self.language == Language::V3 { &V3_NAMES[..] } else { &V4_NAMES[..] };
        if !known.contains(&directive.kind.as_str()) {
            let help = suggest(&directive.kind, known.iter().copied());
            self.report.error_with_help(directive.at, format!("unknown integrator `{}`", directive.kind), help);
        } else if !directive.kind.ends_with("path") {
            let what = format!("the integrator `{}` has no counterpart: path tracing is used", directive.kind);
            self.report.push(durer_diag::Diagnostic::note(what).code(NO_COUNTERPART).at(directive.at));
        }
        match params.integer("maxdepth").unwrap_or(5) {
            depth @ 1..=1_000_000 => self.scene.render_defaults.bounces = Some(depth as u32 - 1),
            0 => {
                let at = params.get("maxdepth").map_or(params.at, |param| param.values_at);
                let defaults = &mut self.scene.render_defaults;
                (defaults.bounces, defaults.no_scattering) = (Some(0), Some((0, at)));
            }
            _ => self.report.error(params.span("maxdepth"), "`maxdepth` must be from 0 to 1000000"),
        }
        params.mark_known(&["regularize", "lightsampler", "sampledirect", "visualizestrategies", "visualizeweights"]);
        params.mark_known(&[
            "maxdistance",
            "cossample",
            "samplelights",
            "samplebsdf",
            "skipbad",
            "function",
            "filename",
        ]);
        params.mark_known(&["photonsperiteration", "iterations", "radius", "seed", "bootstrapsamples", "chains"]);
        params.mark_known(&["mutationsperpixel", "largestepprobability", "sigma"]);
        if self.language == Language::V3 {
            params.mark_known(&["pixelbounds", "rrthreshold", "lightsamplestrategy", "strategy", "nsamples"]);
            params.mark_known(&["numiterations", "imagewritefrequency", "lightsamplethreshold"]);
        }
        params.warn_unused("this integrator");
    }

    /// Reads the sampler, which sets the number of samples per pixel.
    pub fn sampler(&mut self, directive: &DeferredDirective) {
        const V4_NAMES: [&str; 8] =
            ["halton", "independent", "paddedsobol", "pmj02bn", "sobol", "stratified", "zsobol", "mlt"];
        const V3_NAMES: [&str; 7] =
            ["02sequence", "halton", "lowdiscrepancy", "maxmindist", "random", "sobol", "stratified"];
        let params = self.params_of(directive);
        let known = if self.language == Language::V3 { &V3_NAMES[..] } else { &V4_NAMES[..] };
        if !known.contains(&directive.kind.as_str()) {
            let help = suggest(&directive.kind, known.iter().copied());
            self.report.error_with_help(directive.at, format!("unknown sampler `{}`", directive.kind), help);
        }
        let samples = match (params.integer("xsamples"), params.integer("ysamples")) {
            (None, None) => params.integer("pixelsamples"),
            (x, y) => x.unwrap_or(4).checked_mul(y.unwrap_or(4)),
        };
        match samples {
            Some(samples @ 1..=1_048_576) => self.scene.render_defaults.samples = Some(samples as u32),
            None => {}
            Some(_) => self.report.error(directive.at, "samples per pixel must be from 1 to 1048576"),
        }
        params.mark_known(&["pixelsamples", "randomization", "seed", "jitter"]);
        if self.language == Language::V3 {
            params.mark_known(&["dimensions", "samplepixelcenter"]);
        }
        params.warn_unused("this sampler");
    }
}
