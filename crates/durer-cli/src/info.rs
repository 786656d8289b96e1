//! Implements `durer info`, which prints a summary of a scene or of a measured luminaire.

mod luminaire;
mod polar;
mod surface;

use crate::failure::{Failure, invalid_input};
use crate::file_registry::FileRegistry;
use crate::open::{load_options, open};
use crate::options::SceneArgs;
use crate::terminal::print_line;
use clap::Args;
use durer::LoadedScene;
use durer::bvh::TraversalStats;
use durer::camera::{Projection, Raster};
use durer::describe::DescribedKind;
use durer::light::Light;
use durer::render::{center_ray, raster};
use durer::texture::almanac;
use durer::world::{Accel, Geometry, MeshTree, World};
use std::collections::BTreeMap;
use std::path::PathBuf;
use std::sync::Arc;
use surface::MeshSurface;

/// Print a summary of a scene or of a measured luminaire
#[derive(Args)]
#[command(after_help = "Examples:
  durer info scene.txt
  durer info scene.txt --json
  durer info lamp.ies --polar lamp.svg

For a luminaire (.ies or .ldt), durer prints its flux, efficacy, peak, beam angles (half of the maximum intensity of a
vertical plane) and field angles (a tenth of it).")]
pub struct InfoArgs {
    /// Scene or model file, or photometric file (.ies, .ldt)
    pub scene: PathBuf,
    #[command(flatten)]
    pub reading: SceneArgs,
    /// Print JSON, with the scene as `durer convert` writes it
    #[arg(long)]
    pub json: bool,
    /// Draw the intensities of a luminaire in two planes as an SVG file
    #[arg(long, value_name = "FILE.svg")]
    pub polar: Option<PathBuf>,
}

/// Runs `durer info`.
pub fn run(args: &InfoArgs) -> Result<(), Failure> {
    if luminaire::is_photometric(&args.scene) {
        return luminaire::run(args);
    }
    if args.polar.is_some() {
        return Err(invalid_input("--polar needs a photometric file (.ies or .ldt)"));
    }
    let mut options = load_options(&args.reading);
    // The summary is that of the file, without the ground that `durer render` adds.
    options.scene_defaults.no_ground = true;
    let compiled = open(&args.scene, &options, args.json, &mut FileRegistry::default())?;
    let (loaded, world) = (&compiled.loaded, &compiled.world);
    let dialect = loaded.dialect;
    let count = WorldCounts::of(world);
    let rays = rays(world);
    let surface = MeshSurface::of(world, count.triangles);
    let bounds = world.bounds();
    let lights = own_lights(loaded, world);
    let sun = loaded.scene.background.sun().map(almanac::angles);
    let (cameras, animations) = (&loaded.scene.camera_names, &loaded.scene.animations);
    let per_ray = |count: u64| (rays.rays > 0).then(|| count as f64 / rays.rays as f64);
    if args.json {
        let scene: serde_json::Value = serde_json::from_str(&durer::format::json::write(&loaded.scene, dialect))?;
        let value = serde_json::json!({
            "dialect": dialect.name(),
            "objects": world.objects().len(),
            "triangles": count.triangles,
            "distinct_triangles": count.distinct_triangles,
            "materials": world.materials().len(),
            "lights": lights.len(),
            "cameras": cameras,
            "animations": animations.iter().map(|(name, seconds)| {
                serde_json::json!({ "name": name, "seconds": seconds })
            }).collect::<Vec<_>>(),
            "sun": sun.map(|[altitude, azimuth]| serde_json::json!({ "altitude": altitude, "azimuth": azimuth })),
            "bounds": (!bounds.is_empty()).then(|| [bounds.min.to_array(), bounds.max.to_array()]),
            "open_edges": surface.map(|surface| surface.open_edges),
            "area": surface.map(|surface| surface.area),
            "volume": surface.filter(|surface| surface.open_edges == 0).map(|surface| surface.volume),
            "bytes": count.bytes,
            "bytes_per_triangle": count.tree_bytes_each(),
            "tree_cost": count.tree_cost(),
            "object_tree_cost": count.object_cost,
            "nodes_per_ray": per_ray(rays.nodes),
            "tests_per_ray": per_ray(rays.primitive_tests),
            "scene": scene,
        });
        print_line(&serde_json::to_string_pretty(&value)?);
        return Ok(());
    }
    let pose = world.camera().pose();
    print_line(&format!("scene      {}", args.scene.display()));
    print_line(&format!("dialect    {} ({})", dialect.name(), dialect.rules().title));
    let camera = world.camera();
    let (name, rest) = (camera.keyword(dialect), fields(camera, &["center", "direction"]));
    print_line(&format!("camera     {name} at {}, looking along {}: {rest}", pose.center, pose.direction));
    let natural = || Raster::natural_size(camera.proportions(), loaded.rules.size);
    let (width, height) = loaded.scene.render_defaults.size.unwrap_or_else(natural);
    print_line(&format!("picture    {width}x{height} by default"));
    if cameras.len() > 1 {
        let name = |(i, name): (usize, &String)| if name.is_empty() { i.to_string() } else { format!("`{name}`") };
        let names: Vec<String> = cameras.iter().enumerate().map(name).collect();
        print_line(&format!("cameras    {}; choose one with `--camera NAME`", names.join(", ")));
    }
    if !animations.is_empty() {
        let summary = |(i, (name, seconds)): (usize, &(String, f32))| match name.is_empty() {
            true => format!("{i} ({seconds:.2} s)"),
            false => format!("`{name}` ({seconds:.2} s)"),
        };
        let all: Vec<String> = animations.iter().enumerate().map(summary).collect();
        print_line(&format!("animations {}; show a moment with `--animation NAME --at SECONDS`", all.join(", ")));
    }
    for light in lights {
        print_line(&format!("light      {}: {}", light.keyword(dialect), fields(light, &[])));
    }
    if lights.len() < world.lights().len() {
        print_line("light      none in the file, so that `durer render` adds the lights of `--studio soft`");
    }
    if let Some([altitude, azimuth]) = sun {
        print_line(&format!(
            "sun        {altitude:.2} degrees above the horizon, {azimuth:.2} degrees clockwise from north"
        ));
    }
    let shapes: Vec<String> = count.shapes.iter().map(|(name, n)| format!("{n} {name}")).collect();
    print_line(&format!(
        "objects    {}{}{}",
        world.objects().len(),
        if shapes.is_empty() { "" } else { ": " },
        shapes.join(", ")
    ));
    if count.triangles > 0 {
        print_line(&format!("triangles  {} in meshes, {} of them distinct", count.triangles, count.distinct_triangles));
    }
    if let Some(surface) = surface {
        print_line(&format!("surface    {}", surface.text()));
    }
    print_line(&format!("materials  {}", world.materials().len()));
    if !bounds.is_empty() {
        // The bounds of a rotated shape are those of its rotated box.
        let is_loose = world
            .objects()
            .iter()
            .any(|object| object.to_world.is_some() && !matches!(object.geometry, Geometry::Mesh(_)));
        let note = if is_loose { " or less, because of rotated shapes" } else { "" };
        print_line(&format!("bounds     {} to {}{note}", bounds.min, bounds.max));
        let size = bounds.max - bounds.min;
        if size.is_finite() {
            print_line(&format!("size       {} x {} x {}{note}", size.x, size.y, size.z));
        }
    }
    print_line(&format!(
        "memory     {:.1} MiB: geometry and trees {:.1}, pictures {:.1}",
        mib(count.bytes),
        mib(count.bytes - count.picture_bytes),
        mib(count.picture_bytes)
    ));
    let visits = [(count.object_cost, "objects"), (count.tree_cost(), "triangles")];
    let visits = visits.into_iter().filter_map(|(cost, of)| Some(format!("{:.1} nodes over {of}", cost?)));
    let visits = visits.collect::<Vec<_>>().join(", ");
    if !visits.is_empty() {
        print_line(&format!("trees      a random ray is expected to visit {visits}"));
    }
    if let Some(bytes) = count.tree_bytes_each() {
        print_line(&format!("           {bytes:.0} bytes per triangle"));
    }
    if let (Some(nodes), Some(tests)) = (per_ray(rays.nodes), per_ray(rays.primitive_tests)) {
        print_line(&format!("rays       {nodes:.1} nodes and {tests:.1} tests per ray, for {} camera rays", rays.rays));
    }
    Ok(())
}

/// Returns the lights of a world without those that a model gets because its file has none.
fn own_lights<'w>(loaded: &LoadedScene, world: &'w World) -> &'w [Light] {
    if loaded.scene.has_studio() { &[] } else { world.lights() }
}

/// Counts the traversal steps of camera rays in a low-resolution picture.
pub fn rays(world: &World) -> TraversalStats {
    const SIDE: u32 = 64;
    let (raster, mut counts) = (raster(world, SIDE, SIDE), TraversalStats::default());
    let pixels = (0..SIDE * SIDE).map(|i| (i % SIDE, i / SIDE));
    for ray in pixels.filter_map(|pixel| center_ray(world, &raster, pixel)) {
        world.closest(&ray, &mut counts);
    }
    counts
}

fn mib(bytes: usize) -> f64 {
    bytes as f64 / f64::from(1 << 20)
}

/// Formats the fields of an object, except the fields in `except`.
fn fields<T: DescribedKind>(item: &T, except: &[&str]) -> String {
    let wanted = item.fields().iter().enumerate().filter(|(_, field)| !except.contains(&field.name));
    let shown = wanted.filter_map(|(i, field)| Some(format!("{} {}", field.name, value(&item.get(i)?))));
    shown.collect::<Vec<_>>().join(", ")
}

fn value(value: &durer::describe::Value) -> String {
    use durer::describe::Value::*;
    match value {
        Float(x) => x.to_string(),
        Int(i) => i.to_string(),
        Vec3(v) => v.to_string(),
        Path(name) => name.path.clone(),
        Word(word) => word.clone(),
        Rows(rows) => format!("{rows:?}"),
    }
}

/// Numbers of objects and triangles in a world, for the summary of `durer info`.
#[derive(Default)]
struct WorldCounts {
    shapes: BTreeMap<&'static str, usize>,
    triangles: usize,
    distinct_triangles: usize,
    bytes: usize,
    picture_bytes: usize,
    tree_bytes: usize,
    /// Sum over all meshes of the BVH cost times the number of triangles.
    costs: f64,
    object_cost: Option<f64>,
}

impl WorldCounts {
    /// Adds a mesh to the totals. Memory that several objects share is counted only once.
    fn mesh(&mut self, tree: &Arc<MeshTree>, seen: &mut Vec<*const MeshTree>) {
        self.triangles += tree.mesh.len();
        if !seen.contains(&Arc::as_ptr(tree)) {
            seen.push(Arc::as_ptr(tree));
            self.distinct_triangles += tree.mesh.len();
            self.bytes += tree.bytes();
            self.tree_bytes += tree.bvh.memory_usage();
            self.costs += tree.bvh.sah_cost() * tree.mesh.len() as f64;
        }
    }

    /// Returns the expected cost of a random ray in the BVH of a mesh, averaged over all triangles.
    fn tree_cost(&self) -> Option<f64> {
        let cost = self.costs / self.distinct_triangles as f64;
        cost.is_finite().then_some(cost)
    }

    fn tree_bytes_each(&self) -> Option<f64> {
        (self.distinct_triangles > 0).then(|| self.tree_bytes as f64 / self.distinct_triangles as f64)
    }

    fn of(world: &World) -> Self {
        let mut count = WorldCounts::default();
        let mut seen = Vec::new();
        for object in world.objects() {
            let name = match &object.geometry {
                Geometry::Primitive(shape) => shape.keywords()[0].0,
                Geometry::Mesh(tree) => {
                    count.mesh(tree, &mut seen);
                    if tree.mesh.is_terrain() { "HeightField" } else { "TriangleMesh" }
                }
                Geometry::Solid(solid) => {
                    count.bytes += solid.bytes();
                    for part in solid.parts() {
                        if let Geometry::Mesh(tree) = &part.geometry {
                            count.mesh(tree, &mut seen);
                        }
                    }
                    "solid"
                }
            };
            *count.shapes.entry(name).or_default() += 1;
        }
        let faces = world.cube_map().into_iter().flat_map(|map| &map.faces);
        count.picture_bytes = world.textures().iter().chain(faces).map(|texture| texture.bytes()).sum();
        count.bytes += count.picture_bytes + size_of_val(world.objects());
        count.bytes += match world.accel() {
            Accel::Bvh(bvh) => {
                count.object_cost = Some(bvh.sah_cost()).filter(|cost| cost.is_finite());
                bvh.memory_usage()
            }
            Accel::Grid { grid, parts, wide } => grid.memory_usage() + size_of_val(&**parts) + size_of_val(&**wide),
            Accel::Course(hits) => hits.memory_usage(),
            Accel::None => 0,
        };
        count
    }
}
