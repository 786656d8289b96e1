//! Checks lenses and stereo cameras (focus, aperture, shift, eye separation), planes seen edge-on,
//! and sizes and positions that are too small or too far away for floating-point precision.

use super::finding::{Finding, number};
use super::probes::{Probe, ProbeHit};
use super::scene_probe::SceneProbe;
use super::shapes::plane;
use super::visibility::Visibility;
use durer_diag::Diagnostic;
use durer_render::world::Object;
use durer_scene::camera::{Camera, Projection, ThinLensCamera};
use durer_scene::math::{Aabb, Vec3, fp};

/// Diameter of blur discs above which the picture is blurred everywhere, as a fraction of the
/// picture's size.
const MAX_BLUR: f32 = 0.08;
/// Diameter of blur discs below which a point looks sharp, as a fraction of the picture's size.
const MAX_SHARP_BLUR: f32 = 0.02;
/// Aperture that no lens exceeds, as a fraction of the focus distance.
const MAX_APERTURE: f32 = 0.4;
/// Aperture that few lenses exceed, as a fraction of the distance to the objects.
const USUAL_MAX_APERTURE: f32 = 0.12;
/// Ratio of an object's distance to the focus distance above which the lens focuses nowhere near
/// the object.
const FAR_FROM_FOCUS: f32 = 2.0;
/// Ratio of the focus distance to an object's distance above which the focus is out of its reach.
const OUT_OF_REACH: f32 = 10.0;
/// Usual f-numbers. An aperture with one of these values was probably meant as an f-number.
const F_NUMBERS: [f32; 10] = [1.4, 1.8, 2.0, 2.8, 4.0, 5.6, 8.0, 11.0, 16.0, 22.0];
/// Eye separation above which the two images do not fuse, as a fraction of the distance.
const MAX_SEPARATION: f32 = 0.5;

/// Returns the diameter of the blur disc of each visible point on some objects, as a fraction of
/// the picture's larger side, followed by the depth of the point.
fn blurs(scene_probe: &SceneProbe, camera: &ThinLensCamera, counts: impl Fn(&Object) -> bool) -> Vec<(f32, f32)> {
    let forward = scene_probe.world().camera_frame().forward;
    let depth = |(probe, hit): (&Probe, &ProbeHit)| hit.t * probe.ray.dir.dot(forward);
    let (sine, cosine) = fp::sin_cos_degrees(f64::from(0.5 * camera.angle));
    let width = 2.0 * (sine / cosine) as f32;
    let blur = |z: f32| camera.aperture * (z - camera.focus_distance).abs() / (camera.focus_distance * z * width);
    let hits = scene_probe.hits().filter(|(_, hit)| counts(&scene_probe.world().objects()[hit.object as usize]));
    hits.map(depth).filter(|z| *z > 0.0).map(|z| (blur(z), z)).collect()
}

/// Reports a pinhole that is so large that everything visible is blurred.
fn large_hole(scene_probe: &SceneProbe) -> Vec<Finding> {
    let Camera::Pinhole(camera) = scene_probe.world().camera() else { return Vec::new() };
    let frame = scene_probe.world().camera_frame();
    let depths = scene_probe.hits().map(|(probe, hit)| hit.t * probe.ray.dir.dot(frame.forward)).filter(|z| *z > 0.0);
    // Similar triangles: a point at the distance z makes a disc of this diameter on the film.
    let width = 2.0 * camera.film_distance * frame.half_width as f32;
    let mut blurs: Vec<f32> = depths.map(|z| camera.hole * (z + camera.film_distance) / z / width).collect();
    blurs.sort_by(f32::total_cmp);
    let Some(&least) = blurs.first().filter(|least| **least > MAX_BLUR) else { return Vec::new() };
    let sharp = number(camera.hole * 0.005 / blurs[blurs.len() / 2]);
    let span = scene_probe.input.scene.camera_span;
    let diagnostic = Diagnostic::warning(format!("the `hole` of {} is too large", number(camera.hole)))
        .effect(format!("every point becomes a disc of at least {:.0} % of the picture's width", 100.0 * least))
        .help(format!("`hole` is the diameter in world units: write, for example, `hole {sharp}`"))
        .fix_at(scene_probe.field_span(span, &["hole"]), sharp);
    vec![Finding::from(scene_probe.at_value(diagnostic, span, &["hole"])).affecting_whole_picture(true)]
}

/// Reports a lens that blurs everything visible.
pub(super) fn out_of_focus(scene_probe: &SceneProbe) -> Vec<Finding> {
    let Camera::ThinLens(camera) = scene_probe.world().camera() else { return Vec::new() };
    let all = blurs(scene_probe, camera, |_| true);
    if !wide_aperture(scene_probe).is_empty() || all.is_empty() {
        return Vec::new();
    }
    let sharpest = |all: &[(f32, f32)]| all.iter().map(|(blur, _)| *blur).fold(f32::INFINITY, f32::min);
    let (least, subject, what, all) = match sharpest(&all) {
        least if least >= MAX_BLUR => (least, "nothing", "everything visible", all),
        // A plane extends to the horizon, so a part of it is in focus at almost any distance.
        _ => {
            let own = blurs(scene_probe, camera, |object| object.bounds().is_some());
            let is_far = |(_, z): &(f32, f32)| camera.focus_distance > OUT_OF_REACH * z;
            let least = sharpest(&own);
            if own.is_empty() || least < MAX_SHARP_BLUR || !own.iter().all(is_far) {
                return Vec::new();
            }
            (least, "no object", "each visible object except planes", own)
        }
    };
    let mut sorted: Vec<f32> = all.iter().map(|(_, depth)| *depth).collect();
    sorted.sort_by(f32::total_cmp);
    let (nearest, farthest) = (sorted[0], sorted[sorted.len() - 1]);
    let middle = number(sorted[sorted.len() / 2]);
    let away = match camera.focus_distance > farthest {
        true => format!("at most {} away", number(farthest)),
        false => format!("at least {} away", number(nearest)),
    };
    let focus = number(camera.focus_distance);
    let message = format!("{subject} is in focus: the lens focuses at a distance of {focus}, and {what} is {away}");
    let metres = camera.focus_distance / 1000.0;
    let help = match (0.8 * nearest..1.25 * farthest).contains(&metres) {
        true => format!(
            "`focusDistance` is in scene units; if this value is in millimetres and the scene in metres, write \
             `focusDistance {}`",
            number(metres)
        ),
        false => format!(
            "write `focusDistance {middle}`, the distance of most objects, or use a smaller `aperture`, which blurs less"
        ),
    };
    let diagnostic = Diagnostic::warning(message)
        .effect(format!("every such point becomes a disc of at least {:.0} % of the picture's width", 100.0 * least))
        .help(help);
    let span = scene_probe.input.scene.camera_span;
    vec![
        Finding::from(scene_probe.at_value(diagnostic, span, &["focusDistance", "aperture"]))
            .affecting_whole_picture(true),
    ]
}

/// Reports an aperture that is larger than that of any lens and blurs everything except one plane.
pub(super) fn wide_aperture(scene_probe: &SceneProbe) -> Vec<Finding> {
    let Camera::ThinLens(camera) = scene_probe.world().camera() else { return large_hole(scene_probe) };
    let all = blurs(scene_probe, camera, |_| true);
    let sharp = all.iter().filter(|(blur, _)| *blur < MAX_SHARP_BLUR).count();
    // If the aperture fits the distance of most objects, the focus distance is wrong instead.
    let mut depths: Vec<f32> = all.iter().map(|(_, depth)| *depth).collect();
    depths.sort_by(f32::total_cmp);
    let fits = depths.get(depths.len() / 2).is_some_and(|middle| camera.aperture < USUAL_MAX_APERTURE * middle);
    // If the lens focuses nowhere near the objects, a smaller aperture does not help either.
    let near_focus =
        |z: &f32| *z > camera.focus_distance / FAR_FROM_FOCUS && *z < camera.focus_distance * FAR_FROM_FOCUS;
    let off = !depths.iter().any(near_focus);
    let f_number = F_NUMBERS.contains(&camera.aperture) && camera.aperture > USUAL_MAX_APERTURE * camera.focus_distance;
    let wide = f_number || camera.aperture >= MAX_APERTURE * camera.focus_distance;
    if all.is_empty() || !wide || sharp * 10 > all.len() || fits || off {
        return Vec::new();
    }
    let mut sizes: Vec<f32> = all.iter().map(|(blur, _)| *blur).collect();
    sizes.sort_by(f32::total_cmp);
    let usual = number(0.02 * camera.focus_distance);
    let message = format!(
        "the `aperture` of {} is too large for a focus distance of {}",
        number(camera.aperture),
        number(camera.focus_distance)
    );
    let diagnostic = Diagnostic::warning(message)
        .effect(format!(
            "a point becomes a disc of {:.0} % of the picture's width: everything is blurred",
            100.0 * sizes[sizes.len() / 2]
        ))
        .help(format!(
            "write, for example, `aperture {usual}`: `aperture` is the diameter of the lens in world units, not an \
             f-number"
        ));
    let span = scene_probe.input.scene.camera_span;
    let diagnostic = diagnostic.fix_at(scene_probe.field_span(span, &["aperture"]), usual);
    vec![Finding::from(scene_probe.at_value(diagnostic, span, &["aperture"])).affecting_whole_picture(true)]
}

/// Reports a film shift that moves everything out of the picture.
pub(super) fn film_shift(scene_probe: &SceneProbe, middle: Vec3) -> Option<Diagnostic> {
    let Camera::ThinLens(camera) = scene_probe.world().camera() else { return None };
    let span = scene_probe.input.scene.camera_span;
    let fields = [("shiftRight", camera.shift_right), ("shiftUp", camera.shift_up)];
    let (word, shift) =
        fields.into_iter().max_by(|a, b| a.1.abs().total_cmp(&b.1.abs())).filter(|(_, s)| s.abs() > 0.5)?;
    let to = middle - camera.center;
    let forward = to.dot(scene_probe.world().camera_frame().forward);
    let (sine, cosine) = fp::sin_cos_degrees(f64::from(0.5 * camera.angle));
    let across = (to - forward * scene_probe.world().camera_frame().forward).length() / forward.max(1e-6);
    (forward > 0.0 && across < (sine / cosine) as f32).then(|| {
        let diagnostic = Diagnostic::warning(format!(
            "the film shift `{word} {}` moves everything out of the picture",
            number(shift)
        ))
        .effect("the objects in front of the lens are outside the picture")
        .help(
            "the shift is relative to half the picture's larger side, so 1 moves the center to the edge: try \
                   0 or 0.3",
        );
        let value = scene_probe.field_span(span, &[word]);
        scene_probe.at_value(diagnostic.fix_at(value, "0"), span, &[word])
    })
}

/// Reports a stereo camera whose eyes are too far apart.
pub(super) fn eyes_apart(scene_probe: &SceneProbe) -> Vec<Finding> {
    let world = scene_probe.world();
    let (separation, target) = match world.camera() {
        Camera::Stereo(camera) => (camera.separation, Some(camera.convergence)),
        Camera::Cave(camera) => (camera.separation, None),
        Camera::Cylindrical(camera) => (camera.separation, None),
        Camera::Equirectangular(camera) => (camera.separation, None),
        _ => return Vec::new(),
    };
    let span = scene_probe.input.scene.camera_span;
    if scene_probe.field_span(span, &["separation"]).is_none() {
        return Vec::new();
    }
    let eye = world.camera().pose().center;
    let mut depths: Vec<f32> = scene_probe.hits().map(|(probe, hit)| (probe.ray.at(hit.t) - eye).length()).collect();
    depths.sort_by(f32::total_cmp);
    let bounds = world.bounds();
    let away = if bounds.is_empty() { f32::INFINITY } else { (bounds.center() - eye).length() };
    let middle = depths.get(depths.len() / 2).copied().unwrap_or(away).min(away).min(target.unwrap_or(f32::INFINITY));
    if !middle.is_finite() || separation < MAX_SEPARATION * middle || middle <= 0.0 {
        return Vec::new();
    }
    let millimetres = (50.0..=80.0).contains(&separation);
    let usual = number(if millimetres { separation / 1000.0 } else { middle / 30.0 });
    let diagnostic = Diagnostic::warning(format!(
        "the eyes are {} apart and look at objects at a distance of {}",
        number(separation),
        number(middle)
    ))
    .effect("the two pictures differ too much to be fused")
    .help(format!(
        "`separation` is in scene units{}; one thirtieth of the distance is usual: try `separation {usual}`",
        if millimetres { ", and this value may be in millimetres" } else { "" }
    ));
    let diagnostic = diagnostic.fix_at(scene_probe.field_span(span, &["separation"]), usual);
    vec![Finding::from(scene_probe.at_value(diagnostic, span, &["separation"])).affecting_whole_picture(true)]
}

/// Effect of a plane that contains the camera.
const EDGE_ON: &str = "the plane is seen edge-on, so it is invisible";

/// Reports planes that are seen edge-on and are therefore invisible.
pub(super) fn edge_on(scene_probe: &SceneProbe) -> Vec<Finding> {
    let world = scene_probe.world();
    let (eye, forward) = (world.camera().pose().center, world.camera_frame().forward);
    let orthographic = matches!(world.camera(), Camera::Orthographic(_));
    if !orthographic && !super::visibility::has_eye(scene_probe) {
        return Vec::new();
    }
    let objects = world.bounds();
    let size = if objects.is_empty() { 1.0 } else { objects.size().max_element() };
    let mut findings = Vec::new();
    for (number, object) in world.objects().iter().enumerate().take(super::finding::MAX_FINDINGS) {
        let Some(plane) = plane(object) else { continue };
        let on =
            object.world_point(plane.normal * (plane.offset / plane.normal.length_squared().max(f32::MIN_POSITIVE)));
        let n = object.to_world.as_ref().map_or(plane.normal, |m| m.normal(plane.normal)).normalize_or(Vec3::Y);
        let off = (eye - on).dot(n);
        let edge = if orthographic { forward.dot(n).abs() < 1e-5 } else { off.abs() < 1e-5 * size };
        if !edge || scene_probe.visibilities()[number] == Visibility::Visible {
            continue;
        }
        let name = scene_probe.object(number as u32);
        let diagnostic = match orthographic {
            true => Diagnostic::note(format!("the camera looks along the {name}"))
                .help("tilt the camera's `direction` towards the plane, which looks like a line when seen edge-on"),
            false => {
                let diagnostic = Diagnostic::warning(format!("the camera is exactly in the {name}"));
                if let Some((place, offset)) = super::hidden::offset_below_objects(scene_probe, number as u32) {
                    let help = format!(
                        "write `offset {offset}`: the plane is at p · normal = offset, and with the opposite sign all \
                         objects stand on it"
                    );
                    let diagnostic = diagnostic.effect(EDGE_ON).help(help).fix(place, offset);
                    findings.push(Finding::from(diagnostic.at(place)).affecting_whole_picture(true));
                    continue;
                }
                // This is the normal on the side of the objects.
                let side = if (objects.center() - on).dot(n) < 0.0 { -n } else { n };
                let raised = super::finding::vector(eye + 0.2 * size * side);
                let value = scene_probe.field_span(scene_probe.input.scene.camera_span, &["center"]);
                // Below the plane, the picture would be upside down.
                let value = value.filter(|_| side.dot(world.camera_frame().up) >= 0.0);
                match value {
                    Some(value) => diagnostic
                        .help(format!("move the camera to one side of the plane: try `center {raised}`"))
                        .fix(value, raised),
                    None => diagnostic.help("move the camera to one side of the plane, or move the plane"),
                }
            }
        };
        let diagnostic = diagnostic.effect(EDGE_ON);
        let diagnostic = diagnostic.related(scene_probe.object_span(number as u32), "this plane");
        findings.push(Finding::from(scene_probe.at_value(
            diagnostic,
            scene_probe.input.scene.camera_span,
            &["center"],
        )));
    }
    findings
}

/// Reports a scene that is so far from the origin that single precision cannot resolve its shapes.
pub(super) fn far_origin(scene_probe: &SceneProbe) -> Vec<Finding> {
    let world = scene_probe.world();
    let sized = |b: Aabb| {
        (!b.is_empty() && b.size().is_finite()).then(|| (b.center().abs().max_element(), b.size().max_element()))
    };
    let all: Vec<(f32, f32)> = world.objects().iter().filter_map(|object| sized(object.bounds()?)).collect();
    let eye = world.camera().pose().center.abs().max_element();
    // The camera and most objects must be far from the origin. A single distant object is a
    // different problem.
    let lost = |far: f32, size: f32| far * f32::EPSILON > size / 500.0;
    let many = all.iter().filter(|(far, size)| lost(*far, *size)).count();
    if many * 2 <= all.len() || all.is_empty() {
        return Vec::new();
    }
    let mut sizes: Vec<f32> = all.iter().map(|(_, size)| *size).collect();
    sizes.sort_by(f32::total_cmp);
    let size = sizes[sizes.len() / 2];
    let far = all.iter().map(|(far, _)| *far).fold(eye, f32::max);
    if !lost(eye, size.max(1e-6)) {
        return Vec::new();
    }
    let diagnostic = Diagnostic::warning(format!(
        "the scene is {} from the origin, but its objects are only {} wide",
        number(far),
        number(size)
    ))
    .effect(format!(
        "numbers of that size have a resolution of {}: rounding destroys shapes and roughens surfaces",
        number(far * f32::EPSILON)
    ))
    .help("move the scene to the origin: subtract one vector from all coordinates, including the camera's");
    vec![
        Finding::from(scene_probe.at_value(diagnostic, scene_probe.input.scene.camera_span, &["center"]))
            .affecting_whole_picture(true),
    ]
}

/// Reports a scene that is smaller than the offset at which the dialect's program starts shadow
/// rays.
pub(super) fn below_epsilon(scene_probe: &SceneProbe) -> Vec<Finding> {
    let world = scene_probe.world();
    let Some(epsilon) = world.rules().epsilon else { return Vec::new() };
    let settings = &scene_probe.input.job.settings;
    let mut sizes: Vec<f32> = world
        .objects()
        .iter()
        .filter_map(|object| Some(object.bounds()?.size().max_element()))
        .filter(|size| *size > 0.0)
        .collect();
    sizes.sort_by(f32::total_cmp);
    let Some(&middle) = sizes.get(sizes.len() / 2) else { return Vec::new() };
    if middle > 10.0 * epsilon || !settings.shadows && settings.bounces == 0 {
        return Vec::new();
    }
    let factor = number([1e2, 1e3, 1e4, 1e5, 1e6].into_iter().find(|factor| factor * middle > 0.5).unwrap_or(1e7));
    let diagnostic = Diagnostic::warning(format!("the objects in this scene are only {} wide", number(middle)))
        .effect(format!(
            "this year's program starts shadow rays and reflected rays {} from the surface, so shadows and \
             reflections are lost",
            number(epsilon)
        ))
        .help(format!("scale the entire scene, including the camera and lights, by about {factor}"));
    vec![Finding::from(diagnostic.at(scene_probe.input.scene.camera_span)).affecting_whole_picture(true)]
}

/// Reports screens of a CAVE whose corners are in mirrored order.
pub(super) fn mirrored_wall(scene_probe: &SceneProbe) -> Vec<Finding> {
    let Camera::Cave(cave) = scene_probe.world().camera() else { return Vec::new() };
    let mirrored = |row: &&[f32; 9]| {
        let [a, b, c] = [0, 3, 6].map(|i| Vec3::from_slice(&row[i..i + 3]));
        (b - a).cross(c - a).dot(cave.center - a) < 0.0
    };
    let Some(wall) = cave.walls.iter().position(|row| mirrored(&row)) else { return Vec::new() };
    let message = format!("the corners of wall {} are in mirrored order, seen from the `center`", wall + 1);
    let diagnostic = Diagnostic::warning(message).effect("the picture on this wall is mirrored").help(
        "the corners are the lower left, the lower right and the upper left one, seen from inside: exchange left and \
         right",
    );
    vec![Finding::from(scene_probe.at_value(diagnostic, scene_probe.input.scene.camera_span, &["walls"]))]
}
