//! Drawing of `durer explain --rays`.

use crate::svg::opening;
use durer::integrator::TraceNode;
use durer::integrator::trace::{RayKind, RayRecord, Shadow, TermKind};
use durer::math::{Aabb, Vec2, Vec3};
use durer::report::object_outlines;
use durer::world::World;
use std::fmt::Write;

/// Larger side of the drawing and its margin, in pixels.
const SIZE: f32 = 800.0;
const MARGIN: f32 = 30.0;
/// Width of the legend on the left, in pixels.
const LEGEND: f32 = 130.0;
/// Names and colours of the kinds of rays, in the order of the legend.
const KINDS: [(&str, &str); 6] = [
    ("camera", "#1c7ed6"),
    ("reflected", "#2f9e44"),
    ("transmitted", "#e8590c"),
    ("scattered", "#7048e8"),
    ("to a light", "#f08c00"),
    ("to a light, blocked", "#e03131"),
];

/// Part of a ray that is drawn.
struct Segment {
    /// Index in [`KINDS`].
    kind: usize,
    from: Vec3,
    /// End of the ray, or its direction if it ends nowhere.
    to: Result<Vec3, Vec3>,
}

/// Draws the rays of a tree and the outlines of the objects as SVG, seen from the right side of the
/// camera, or from above.
pub fn rays_svg(world: &World, root: &TraceNode, from_above: bool) -> String {
    let frame = world.camera_frame();
    // The ground is level, even if the camera looks down.
    let upright = [Vec3::Y, Vec3::Z].into_iter().find(|axis| frame.up.dot(*axis).abs() > 0.3).unwrap_or(frame.up);
    let ahead = frame.forward.reject_from(upright).normalize_or(frame.forward);
    let (across, upwards) = if from_above { (frame.right, ahead) } else { (ahead, upright) };
    let mut segments = Vec::new();
    add_rays(root, &mut segments);
    let flat = |p: Vec3| Vec2::new((p - frame.eye).dot(across), -(p - frame.eye).dot(upwards));
    let points = segments.iter().flat_map(|segment| [Some(segment.from), segment.to.ok()]).flatten();
    let known = Aabb::around(points.map(|p| flat(p).extend(0.0)).filter(|p| p.is_finite()));
    // A ray that ends nowhere is drawn a quarter as long as the others reach.
    let reach = if known.is_empty() { 1.0 } else { 0.25 * known.size().length().max(1e-3) };
    let end = |segment: &Segment| match segment.to {
        Ok(to) => to,
        Err(dir) => segment.from + reach * dir.normalize_or_zero(),
    };
    let around = known.union(Aabb::around(segments.iter().map(|segment| flat(end(segment)).extend(0.0))));
    let (low, size) = (around.min.truncate(), around.size().truncate());
    let scale = (SIZE - 2.0 * MARGIN) / size.max_element().max(1e-6);
    // A drawing of a single ray along an axis is not flat.
    let sides = (scale * size + 2.0 * MARGIN).max(Vec2::splat(0.4 * SIZE));
    let corner = 0.5 * (sides - scale * size) + Vec2::new(LEGEND, 0.0);
    let place = |p: Vec3| scale * (flat(p) - low) + corner;
    let mut svg = opening(f64::from(LEGEND + sides.x).round(), f64::from(sides.y).round(), "sans-serif");
    for outline in object_outlines(world).flatten() {
        let path: Vec<Vec2> = outline.into_iter().map(place).collect();
        path.windows(2).for_each(|pair| line(&mut svg, pair[0], pair[1], "stroke=\"#ced4da\""));
    }
    for segment in &segments {
        let (from, to) = (place(segment.from), place(end(segment)));
        let dashes = if segment.to.is_err() || segment.kind > 3 { " stroke-dasharray=\"6 4\"" } else { "" };
        line(&mut svg, from, to, &format!("stroke=\"{}\" stroke-width=\"1.8\"{dashes}", KINDS[segment.kind].1));
        dot(&mut svg, from);
    }
    let used = (0..KINDS.len()).filter(|kind| segments.iter().any(|segment| segment.kind == *kind));
    for (row, kind) in used.enumerate() {
        let ((name, color), y) = (KINDS[kind], 20 + 18 * row);
        let _ = writeln!(svg, "<text x=\"10\" y=\"{y}\" fill=\"{color}\">{name}</text>");
    }
    svg + "</svg>\n"
}

/// Adds the rays of a term and of the terms of which it consists.
fn add_rays(node: &TraceNode, all: &mut Vec<Segment>) {
    match &node.kind {
        TermKind::Ray { from, ray, hit, .. } => {
            let kind = match from {
                RayKind::Camera => 0,
                RayKind::Reflected => 1,
                RayKind::Transmitted => 2,
                RayKind::Scattered => 3,
            };
            let to = hit.as_ref().map(|hit| hit.position).ok_or(ray.dir);
            all.push(Segment { kind, from: ray.origin, to });
        }
        TermKind::Direct { shadow: Some(shadow), .. } | TermKind::Light { shadow: Some(shadow), .. } => {
            all.push(shadow_ray(shadow));
        }
        _ => {}
    }
    node.terms.iter().for_each(|term| add_rays(term, all));
}

fn shadow_ray(Shadow { ray, blocker, .. }: &Shadow) -> Segment {
    let RayRecord { origin, dir, t_max, .. } = *ray;
    let (kind, t) = blocker.map_or((4, t_max), |(_, t)| (5, t));
    Segment { kind, from: origin, to: if t.is_finite() { Ok(origin + t * dir) } else { Err(dir) } }
}

fn line(svg: &mut String, a: Vec2, b: Vec2, style: &str) {
    // Skip lines that are not finite or extremely far away. Writing to a string cannot fail.
    if a.abs().max_element().max(b.abs().max_element()) < 1e6 {
        let _ =
            writeln!(svg, "<line x1=\"{:.1}\" y1=\"{:.1}\" x2=\"{:.1}\" y2=\"{:.1}\" {style}/>", a.x, a.y, b.x, b.y);
    }
}

fn dot(svg: &mut String, at: Vec2) {
    let _ = writeln!(svg, "<circle cx=\"{:.1}\" cy=\"{:.1}\" r=\"3\" fill=\"#212529\"/>", at.x, at.y);
}
