//! Draws a plan view of the camera rays through the middle row of the picture.

use super::stage::LessonScene;
use durer_render::render::center_ray;
use durer_scene::math::{Aabb, Vec2, Vec3};
use std::fmt::Write;

/// Number of rays that are drawn.
const RAYS: u32 = 21;
/// Maximum number of boxes that are drawn. More boxes would cover each other.
const MAX_BOXES: usize = 200;
/// Width and height of the drawing.
const SIZE: f32 = 400.0;

/// Draws an SVG file with a box around each object and with rays that end at their hits.
pub(super) fn plan(stage: &LessonScene) -> String {
    let (world, (width, height)) = (&stage.world, stage.size());
    let frame = world.camera_frame();
    // Camera space is seen from above, with right to the right and forward pointing up.
    let flat = |p: Vec3| Vec2::new((p - frame.eye).dot(frame.right), -(p - frame.eye).dot(frame.forward));
    let count = RAYS.min(width);
    let mut rays = Vec::new();
    for i in 0..count {
        let x = ((2 * i + 1) * width / (2 * count)).min(width - 1);
        let Some(ray) = center_ray(world, &stage.raster(), (x, height / 2)) else { continue };
        let hit = world.closest(&ray, &mut ()).map(|hit| hit.t);
        rays.push((ray, hit));
    }
    // Limit rays to three times the median length so that an infinite ground does not dominate the
    // drawing.
    let mut hits: Vec<f32> = rays.iter().filter_map(|ray| ray.1).collect();
    hits.sort_by(f32::total_cmp);
    let nothing = || (world.bounds().center() - frame.eye).length().max(1.0);
    let reach = hits.get(hits.len() / 2).map_or_else(nothing, |middle| 3.0 * middle);
    rays.iter_mut().for_each(|ray| ray.1 = ray.1.filter(|t| *t <= reach));
    let ends = rays.iter().map(|(ray, hit)| (flat(ray.origin), flat(ray.at(hit.unwrap_or(reach))), hit.is_some()));
    let ends: Vec<(Vec2, Vec2, bool)> = ends.filter(|end| end.0.is_finite() && end.1.is_finite()).collect();

    // Scale the drawing so that all rays fit, with a margin.
    let points = ends.iter().flat_map(|end| [end.0, end.1]).chain([Vec2::ZERO]);
    let around = Aabb::around(points.map(|p| p.extend(0.0)));
    let (middle, side) = (around.center().truncate(), around.size().max_element().max(1e-6));
    let place = |p: Vec2| (p - middle) / side * (0.9 * SIZE) + 0.5 * SIZE;

    let mut svg = format!(
        "<svg xmlns=\"http://www.w3.org/2000/svg\" viewBox=\"0 0 {SIZE} {SIZE}\" width=\"{SIZE}\" height=\"{SIZE}\">\n\
         <rect width=\"{SIZE}\" height=\"{SIZE}\" fill=\"white\"/>\n"
    );
    for bounds in world.objects().iter().filter_map(|object| object.bounds()).take(MAX_BOXES) {
        let corners: Vec<Vec2> = bounds.corners().map(|corner| place(flat(corner))).into_iter().collect();
        for (i, a) in corners.iter().enumerate() {
            for b in (0..3).map(|axis| i | 1 << axis).filter(|&j| j != i).map(|j| corners[j]) {
                line(&mut svg, *a, b, "stroke=\"#888\" stroke-width=\"0.7\"");
            }
        }
    }
    for (from, to, hit) in ends {
        let (from, to) = (place(from), place(to));
        let dashes = if hit { "" } else { " stroke-dasharray=\"4 4\"" };
        line(&mut svg, from, to, &format!("stroke=\"#1c7ed6\"{dashes}"));
        if hit {
            dot(&mut svg, to, 2.5, "#e8590c");
        }
    }
    // Draw the axes in the lower left corner.
    let corner = Vec2::new(18.0, SIZE - 18.0);
    for (to, name, at) in [
        (corner + Vec2::new(46.0, 0.0), "right", corner + Vec2::new(50.0, 4.0)),
        (corner - Vec2::new(0.0, 46.0), "forward", corner - Vec2::new(6.0, 52.0)),
    ] {
        line(&mut svg, corner, to, "stroke=\"currentColor\" stroke-width=\"1.5\"");
        let _ = writeln!(
            svg,
            "<text x=\"{:.0}\" y=\"{:.0}\" font-size=\"13\" fill=\"currentColor\">{name}</text>",
            at.x, at.y
        );
    }
    dot(&mut svg, place(Vec2::ZERO), 4.0, "currentColor");
    svg + "</svg>\n"
}

fn line(svg: &mut String, a: Vec2, b: Vec2, style: &str) {
    // Skip lines that have zero length or are extremely far away. Writing to a string cannot fail.
    if a.distance(b) > 0.05 && a.abs().max_element().max(b.abs().max_element()) < 1e6 {
        let _ =
            writeln!(svg, "<line x1=\"{:.1}\" y1=\"{:.1}\" x2=\"{:.1}\" y2=\"{:.1}\" {style}/>", a.x, a.y, b.x, b.y);
    }
}

fn dot(svg: &mut String, at: Vec2, radius: f32, color: &str) {
    let _ = writeln!(svg, "<circle cx=\"{:.1}\" cy=\"{:.1}\" r=\"{radius}\" fill=\"{color}\"/>", at.x, at.y);
}
