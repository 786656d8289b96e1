//! Visibility of each object: in the picture, hidden by another object, or outside the picture.

use super::probes::{CheckInput, ProbeGrid};
use super::shapes::triangle;
use durer_render::world::{Geometry, Object};
use durer_scene::camera::{Camera, CameraSample, Projection};
use durer_scene::material::principled::Backs;
use durer_scene::math::{Aabb, Ray, Vec2, Vec3};
use durer_scene::scene::Material;

/// Visibility of an object in the picture: seen, hidden by another object, or outside the picture.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(super) enum Visibility {
    /// Part of the object is in the picture.
    Visible,
    /// The object projects into the picture, but this other object hides it.
    Hidden(u32),
    /// The camera looks at the back of the object, which the material hides.
    TurnedAway,
    /// The object is outside the picture.
    Outside,
    /// The object is unbounded, empty or seen edge-on, and no probe hit it.
    Unknown,
}

/// Maximum number of objects that are tested individually.
const MAX_OBJECTS: usize = 200;
/// Number of triangles of a mesh that are tested at their centres.
const MAX_CORNERS: usize = 40;

/// Returns the visibility of each object. If no probe hit an object, this function traces rays to
/// points on it.
pub(super) fn visibilities(grid: &ProbeGrid) -> Vec<Visibility> {
    let objects = grid.world().objects();
    let mut visibilities = vec![Visibility::Unknown; objects.len()];
    grid.hits().for_each(|(_, hit)| visibilities[hit.object as usize] = Visibility::Visible);
    for (i, object) in objects.iter().enumerate().take(MAX_OBJECTS) {
        if visibilities[i] != Visibility::Visible {
            visibilities[i] = visibility_of(grid, i as u32, object);
        }
    }
    visibilities
}

fn visibility_of(grid: &ProbeGrid, number: u32, object: &Object) -> Visibility {
    let points = points(object);
    if points.is_empty() {
        return Visibility::Unknown;
    }
    let mut sight = Visibility::Outside;
    for (point, ray) in points.iter().flat_map(|&point| rays_to(grid, point).into_iter().map(move |ray| (point, ray))) {
        let seen = past_hidden_backs(&grid.input, ray);
        let to_point = (point - ray.origin).dot(ray.dir) / ray.dir.length_squared();
        match grid.world().closest(&seen, &mut ()) {
            Some(hit) if hit.object == number => return Visibility::Visible,
            _ if is_first(&grid.input, &ray, number) => return Visibility::TurnedAway,
            Some(hit) if hit.t < to_point * (1.0 - BEHIND) => sight = Visibility::Hidden(hit.object),
            // The object is seen edge-on, so the ray passes it and hits something behind it.
            Some(_) if sight == Visibility::Outside => sight = Visibility::Unknown,
            Some(_) | None => {}
        }
    }
    sight
}

/// Fraction of the distance to a point by which a hit must be nearer to hide the point.
const BEHIND: f32 = 1e-3;

/// Returns true if a ray hits an object first, on its visible or on its hidden side.
fn is_first(input: &CheckInput, ray: &Ray, number: u32) -> bool {
    looks_through(input) && input.world.closest(ray, &mut ()).is_some_and(|hit| hit.object == number)
}

/// Returns true if the camera looks through some surfaces or their backs. Only path tracing does.
fn looks_through(input: &CheckInput) -> bool {
    (input.world.hides_backs() || input.world.has_unseen()) && input.job.method.path_options().is_some()
}

/// Returns true if the material of an object hides its backs.
pub(super) fn hides_backs_of(grid: &ProbeGrid, object: u32) -> bool {
    let material = grid.world().objects()[object as usize].material as usize;
    let written = grid.input.scene.materials.get(material).map(|material| &material.value);
    looks_through(&grid.input) && matches!(written, Some(Material::Principled(layers)) if layers.backs == Backs::Hidden)
}

/// Returns a camera ray that starts behind the hidden backs, and surfaces with `seenByCamera off`,
/// in front of it.
pub(super) fn past_hidden_backs(input: &CheckInput, mut ray: Ray) -> Ray {
    if !looks_through(input) {
        return ray;
    }
    let world = input.world;
    // The loop limits the number of layers.
    for _ in 0..64 {
        let Some(hit) = world.closest(&ray, &mut ()) else { break };
        let at = world.interaction(ray, hit);
        if !world.is_hidden(ray.dir, &at) && !world.is_unseen(&at) {
            break;
        }
        ray.t_min = hit.t;
    }
    ray
}

/// Returns the camera rays to a point. The list is empty if the point projects outside the picture.
pub(super) fn rays_to(grid: &ProbeGrid, point: Vec3) -> Vec<Ray> {
    let (world, mut points) = (grid.world(), Vec::new());
    world.camera().project(world.camera_frame(), point, Vec2::splat(0.5), &mut |place| points.push(place));
    let corner = picture_corner(grid);
    let inside = points.into_iter().filter(|place| place.abs().cmple(corner).all());
    inside.filter_map(|place| world.camera().ray(world.camera_frame(), &CameraSample::at(place))).collect()
}

/// Returns the upper right corner of the picture in the camera's coordinates.
pub(super) fn picture_corner(grid: &ProbeGrid) -> Vec2 {
    grid.raster.point(Vec2::new(grid.raster.width as f32, 0.0)).abs()
}

/// Returns points to test for an object, in world space. These are the centre and corners of a
/// triangle, the centres of a mesh's triangles, or a grid through the bounds of any other object.
pub(super) fn points(object: &Object) -> Vec<Vec3> {
    let to_world = |p: Vec3| object.world_point(p);
    if let Some(corners) = triangle(object) {
        return triangle_points(corners).map(to_world).to_vec();
    }
    match &object.geometry {
        Geometry::Mesh(tree) => {
            let count = tree.mesh.len();
            let each = (0..count).step_by((count / MAX_CORNERS).max(1));
            each.map(|i| to_world(triangle_points(tree.mesh.corners(i as u32))[0])).collect()
        }
        Geometry::Primitive(_) | Geometry::Solid(_) => {
            let Some(bounds) = object.bounds().filter(|bounds| !bounds.is_empty()) else { return Vec::new() };
            let (center, half) = (bounds.center(), 0.5 * bounds.size());
            // Stay slightly inside the bounds because round objects do not reach the corners.
            let steps = [0.0, -0.95, 0.95, -0.5, 0.5];
            let grid = steps.iter().flat_map(|x| steps.iter().flat_map(move |y| steps.map(|z| Vec3::new(*x, *y, z))));
            grid.map(|at| center + at * half).collect()
        }
    }
}

/// Returns the centre of a triangle and points near its corners.
fn triangle_points([a, b, c]: [Vec3; 3]) -> [Vec3; 4] {
    let middle = (a + b + c) / 3.0;
    [middle, a.lerp(middle, 0.1), b.lerp(middle, 0.1), c.lerp(middle, 0.1)]
}

/// Returns true if a point is in the camera's view, ignoring occlusion.
pub(super) fn is_in_view(grid: &ProbeGrid, point: Vec3) -> bool {
    !rays_to(grid, point).is_empty()
}

/// Returns the larger side of a box's projection in pixels, or `None` if some corner does not
/// project to exactly one point.
pub(super) fn pixels(grid: &ProbeGrid, bounds: Aabb) -> Option<f32> {
    let (world, job) = (grid.world(), grid.input.job);
    let mut around: Option<(Vec2, Vec2)> = None;
    let mut unseen = 0;
    for point in bounds.corners() {
        let mut points = Vec::new();
        world.camera().project(world.camera_frame(), point, Vec2::splat(0.5), &mut |place| points.push(place));
        unseen += usize::from(points.len() != 1);
        for place in points {
            let (min, max) = around.unwrap_or((place, place));
            around = Some((min.min(place), max.max(place)));
        }
    }
    let (min, max) = around.filter(|_| unseen == 0)?;
    // The larger side of the picture spans 2 units.
    Some((max - min).max_element() / (2.0 * picture_corner(grid).max_element()) * job.width.max(job.height) as f32)
}

/// Returns true if all camera rays start at the camera's position. The rays of the other cameras
/// are lines, which also hit objects behind the camera.
pub(super) fn has_eye(grid: &ProbeGrid) -> bool {
    !matches!(grid.world().camera(), Camera::Orthographic(_) | Camera::PushBroom(_) | Camera::MultipleCenter(_))
}
