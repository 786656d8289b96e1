//! Camera rays, and the steps in which rays traverse acceleration structures for the objects.

use crate::protocol::{CameraRay, Structure, Traversal, TraversalStep, TraversalTest, TreeBox};
use durer::bvh::{Bvh, Grid};
use durer::math::{Aabb, Ray, Ray64, Vec3};
use durer::render::{center_ray, raster};
use durer::world::{Accel, Geometry, Object, World};

/// Maximum number of boxes that are sent.
const MAX_BOXES: usize = 3000;
/// Maximum number of camera rays in one answer. `MAX_OBJECTS` is the maximum number of objects for
/// which a structure is built to show a traversal.
const MAX_RAYS: u32 = 1 << 16;
const MAX_OBJECTS: usize = 20_000;

/// Returns the camera rays through the pixel centres of a raster, row by row.
pub(crate) fn rays(
    world: &World,
    [columns, rows]: [u32; 2],
    row: Option<u32>,
) -> Result<Vec<Option<CameraRay>>, String> {
    let wanted = row.map_or(0..rows, |row| row..row + 1);
    let is_sound = (1..=MAX_RAYS).contains(&columns) && (1..=MAX_RAYS).contains(&rows) && wanted.end <= rows;
    if !is_sound || u64::from(columns) * wanted.len() as u64 > MAX_RAYS.into() {
        return Err(format!("a raster must have from 1 to {MAX_RAYS} pixels, and the row must be inside the raster"));
    }
    let raster = raster(world, columns, rows);
    let one = |(x, y)| {
        let ray = center_ray(world, &raster, (x, y))?;
        let hit = world.closest(ray, &mut ());
        let (t, object) = (hit.map(|hit| hit.t), hit.map(|hit| hit.object));
        Some(CameraRay { origin: ray.origin.into(), direction: ray.dir.into(), t, object })
    };
    Ok(wanted.flat_map(|y| (0..columns).map(move |x| (x, y))).map(one).collect())
}

/// Recorder that tests objects against a ray during a traversal and keeps the closest hit.
struct TraversalRecorder<'a> {
    world: &'a World,
    ray: Ray64,
    closest: Option<TraversalTest>,
    /// True for a shadow ray, which ends at any hit.
    any: bool,
}

impl TraversalRecorder<'_> {
    /// Tests an object and records the hit if it is the closest hit so far.
    fn test(&mut self, object: u32) -> TraversalTest {
        let t = self.world.hit_of(object, &self.ray).map(|hit| hit.t);
        let test = TraversalTest { object, t };
        let is_closer = |closest: TraversalTest| (t, object) < (closest.t, closest.object);
        if t.is_some() && self.closest.is_none_or(is_closer) {
            self.closest = Some(test);
        }
        test
    }

    /// Returns the end of the interval of `t` in which a hit can still be the closest one.
    /// A shadow ray that hit something ends at once.
    fn end(&self) -> f32 {
        if self.is_over() {
            return f32::NEG_INFINITY;
        }
        self.closest.and_then(|closest| closest.t).map_or(self.ray.rounded.t_max, f32::next_up)
    }

    /// Returns the ray that is left for the structure after the unbounded objects.
    fn rest(&self) -> Ray {
        Ray { t_max: if self.is_over() { f32::NEG_INFINITY } else { self.ray.rounded.t_max }, ..self.ray.rounded }
    }

    /// True for a shadow ray that hit something.
    fn is_over(&self) -> bool {
        self.any && self.closest.is_some()
    }

    /// Tests objects one after another, until a shadow ray hits one of them.
    fn test_each(&mut self, objects: impl IntoIterator<Item = u32>) -> Vec<TraversalTest> {
        let mut tests = Vec::new();
        for object in objects {
            tests.push(self.test(object));
            if self.is_over() {
                break;
            }
        }
        tests
    }

    fn step(&self, bounds: Option<Aabb>, level: u32, tests: Vec<TraversalTest>) -> TraversalStep {
        let bounds = bounds.map(|bounds| [bounds.min.into(), bounds.max.into()]);
        TraversalStep { bounds, level, tests, closest: self.closest.and_then(|closest| closest.t) }
    }
}

/// Builds a structure for all bounded objects and records how a ray traverses it. Unbounded objects
/// such as planes are tested first.
pub(crate) fn traverse(world: &World, structure: Structure, ray: &Ray, any: bool) -> Result<Traversal, String> {
    let objects = world.objects();
    if objects.len() > MAX_OBJECTS {
        return Err(format!("the scene has more than {MAX_OBJECTS} objects"));
    }
    let mut walker = TraversalRecorder { world, ray: Ray64::from(*ray), closest: None, any };
    let (bounded, endless): (Vec<u32>, Vec<u32>) =
        (0..objects.len() as u32).partition(|&i| objects[i as usize].bounds().is_some());
    let boxes: Vec<Aabb> = bounded.iter().filter_map(|&i| objects[i as usize].bounds()).collect();
    let (mut steps, mut shown, mut visits) = (Vec::new(), Vec::new(), 0);
    if !endless.is_empty() {
        let tests = walker.test_each(endless);
        steps.push(walker.step(None, 0, tests));
    }
    match structure {
        Structure::Nothing => {
            for &object in &bounded {
                if walker.is_over() {
                    break;
                }
                let tests = vec![walker.test(object)];
                steps.push(walker.step(objects[object as usize].bounds(), 0, tests));
            }
        }
        Structure::Tree => {
            let tree = Bvh::build(&boxes);
            let mut tested = Vec::new();
            let visited = tree.visits(&walker.rest(), |item, _| {
                let object = bounded[tree.primitive_indices()[item] as usize];
                let test = (!walker.is_over()).then(|| walker.test(object));
                tested.push((test, walker.closest));
                walker.end()
            });
            visits = visited.iter().filter(|visit| visit.items.is_empty()).count();
            let (mut tested, mut closest) =
                (tested.into_iter(), steps.last().and_then(|step: &TraversalStep| step.closest));
            for visit in visited {
                let tests: Vec<_> = tested.by_ref().take(visit.items.len()).collect();
                closest = tests.last().map_or(closest, |(_, closest)| closest.and_then(|closest| closest.t));
                let tests = tests.into_iter().filter_map(|(test, _)| test).collect();
                steps.push(TraversalStep { closest, ..walker.step(Some(visit.bounds), visit.level, tests) });
            }
            shown.extend(tree.boxes().take(MAX_BOXES).map(|found| state(found.level, &found.bounds, |corner| corner)));
        }
        Structure::Grid => {
            let bounds = boxes.iter().fold(Aabb::EMPTY, |all, one| all.union(*one));
            let overlaps = |i: usize, cell: Aabb| objects[bounded[i] as usize].overlaps(&cell);
            let grid = Grid::build(bounds, Grid::suggested_resolution(bounds, boxes.len()), &boxes, overlaps)
                .filter(|_| !boxes.is_empty())
                .ok_or("no grid can be built over these objects")?;
            grid.traverse_cells(&walker.rest(), |grid, cell, _| {
                visits += 1;
                let tests = walker.test_each(grid.primitives(cell).iter().map(|&i| bounded[i as usize]));
                steps.push(walker.step(Some(grid.cell_bounds(cell)), 0, tests));
                walker.end()
            });
            let [nx, ny, nz] = grid.resolution();
            let cells = (0..nz).flat_map(|z| (0..ny).flat_map(move |y| (0..nx).map(move |x| [x, y, z])));
            let full = cells.filter(|&cell| grid.occupancy(cell) > 0).take(MAX_BOXES);
            shown.extend(full.map(|cell| state(1, &grid.cell_bounds(cell), |corner| corner)));
        }
    }
    let tests = steps.iter().map(|step| step.tests.len() as u32).sum();
    let (visits, count) = (visits as u32, objects.len() as u32);
    Ok(Traversal { steps, visits, tests, objects: count, hit: walker.closest, boxes: shown })
}

/// Returns the boxes of the BVH of the objects and, at deeper levels, of the BVHs of the triangles
/// of meshes. A world with few objects has no BVH, so this function builds one.
pub(crate) fn boxes(world: &World) -> Vec<TreeBox> {
    let bounds: Vec<Aabb> = world.objects().iter().filter_map(Object::bounds).collect();
    let built;
    let tree = match world.accel() {
        Accel::Bvh(tree) if !tree.is_empty() => tree,
        _ => {
            built = Bvh::build(&bounds);
            &built
        }
    };
    let mut all: Vec<TreeBox> =
        tree.boxes().take(MAX_BOXES).map(|found| state(found.level, &found.bounds, |corner| corner)).collect();
    let below = all.last().map_or(0, |last| last.level);
    let mut meshes: Vec<TreeBox> = Vec::new();
    for object in world.objects() {
        let Geometry::Mesh(mesh) = &object.geometry else { continue };
        let place = |corner| object.world_point(corner);
        // Skip the root box of a mesh, because it is the same as the box of its object.
        let found = mesh.bvh.boxes().filter(|found| found.level > 0).take(MAX_BOXES);
        meshes.extend(found.map(|found| state(below + found.level, &found.bounds, place)));
        if meshes.len() > 16 * MAX_BOXES {
            break;
        }
    }
    meshes.sort_by_key(|found| found.level);
    all.extend(meshes);
    all.truncate(MAX_BOXES);
    all
}

fn state(level: u32, bounds: &Aabb, place: impl Fn(Vec3) -> Vec3) -> TreeBox {
    let ends = [bounds.min, bounds.max];
    let corner = |i: usize| place(Vec3::new(ends[i & 1].x, ends[i >> 1 & 1].y, ends[i >> 2].z));
    TreeBox { level, corners: (0..8).flat_map(|i| corner(i).to_array()).collect() }
}
