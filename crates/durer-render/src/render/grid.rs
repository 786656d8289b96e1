//! Picture of a uniform grid whose occupied cells are drawn as boxes, as in the course's
//! assignment.

use super::{Control, Job, RenderError, center_ray, raster};
use crate::threads;
use crate::world::{Accel, Geometry, Object, World};
use durer_bvh::Grid;
use durer_image::{Image, checked_count};
use durer_scene::light::Illuminate;
use durer_scene::math::{Aabb, Color, Ray, Vec3};
use durer_scene::shape::Primitive;
use rayon::prelude::*;
use std::sync::atomic::Ordering::Relaxed;

/// Colours of cells by the number of objects in them. A cell with one object is white, and more
/// objects give colours from cold to hot. The course does not prescribe the colours.
const COLORS: [Vec3; 8] = [
    Vec3::ONE,
    Vec3::new(1.0, 0.0, 1.0),
    Vec3::new(0.0, 0.0, 1.0),
    Vec3::new(0.0, 1.0, 1.0),
    Vec3::new(0.0, 1.0, 0.0),
    Vec3::new(1.0, 1.0, 0.0),
    Vec3::new(1.0, 0.5, 0.0),
    Vec3::new(1.0, 0.0, 0.0),
];

/// Draws the occupied cells of a world's grid and shades them like objects. Without a grid, draws
/// only the background.
pub fn grid_picture(world: &World, job: &Job, control: &Control) -> Result<Image, RenderError> {
    let count = checked_count(job.width, job.height)?;
    let raster = raster(world, job.width, job.height);
    let grid = occupied(world);
    let color = |i: u32| {
        if control.cancel.load(Relaxed) {
            return Err(RenderError::Cancelled);
        }
        let Some(ray) = center_ray(world, &raster, (i % job.width, i / job.width)) else { return Ok(Vec3::ZERO) };
        Ok(match &grid {
            Some(grid) => cell_color(world, grid, &ray),
            None => world.background_radiance(ray.dir),
        })
    };
    let colors =
        threads::install(control.threads, || (0..count as u32).into_par_iter().map(color).collect::<Result<_, _>>())?;
    Ok(Image::from_pixels(job.width, job.height, colors)?)
}

/// Returns the grid of cells that exactly overlap objects. (The grid for tracing rays has a margin
/// for rounding errors.)
fn occupied(world: &World) -> Option<Grid> {
    let Accel::Grid { grid, parts, .. } = world.accel() else { return None };
    let object = |part: usize| &world.objects()[parts[part].0 as usize];
    // As in the course's programs, only the distance between the centres determines whether a
    // sphere occupies a cell. Such a cell can even be outside the bounds of the sphere.
    let half = 0.5 * grid.cell_bounds([0; 3]).size();
    let is_sphere = |object: &Object| {
        object.to_world.is_none() && matches!(object.geometry, Geometry::Primitive(Primitive::Sphere(_)))
    };
    // The grid contains only objects with bounds.
    let bounds = |i: usize| match object(i).part_bounds(parts[i].1).unwrap_or(Aabb::EMPTY) {
        own if is_sphere(object(i)) => Aabb { min: own.min - half.length(), max: own.max + half.length() },
        own => own,
    };
    let boxes: Vec<Aabb> = (0..parts.len()).map(bounds).collect();
    grid.for_drawing(&boxes, |i, cell| {
        let own = Aabb { min: cell.center() - half, max: cell.center() + half };
        object(i).overlaps(if is_sphere(object(i)) { &own } else { &cell })
    })
}

/// Returns the colour of the first occupied cell along a ray, or of the background if there is
/// none.
fn cell_color(world: &World, grid: &Grid, ray: &Ray) -> Color {
    let mut found = None;
    grid.traverse_cells(ray, |grid, cell, t_max| {
        let count = grid.occupancy(cell);
        if count == 0 {
            return t_max;
        }
        found = Some((cell, count));
        f32::NEG_INFINITY
    });
    let Some((cell, count)) = found else { return world.background_radiance(ray.dir) };
    let bounds = grid.cell_bounds(cell);
    let Some((enter, _)) = bounds.clip(ray.origin, ray.dir) else { return world.background_radiance(ray.dir) };
    let point = ray.at(enter);
    // The ray enters through the face whose plane is closest to the point, measured in cells.
    let from_center = (point - bounds.center()) / bounds.size();
    let axis = (0..3).fold(0, |best, i| if from_center[i].abs() > from_center[best].abs() { i } else { best });
    let normal = Vec3::AXES[axis] * from_center[axis].signum();
    let color = COLORS[(count - 1).min(COLORS.len() - 1)];
    let lit = world.lights().iter().map(|light| {
        let light_sample = light.illuminate(point.as_dvec3());
        normal.dot(light_sample.to_light).max(0.0) * light_sample.color
    });
    color * (world.ambient() + lit.sum::<Color>())
}
