//! `durer info`.

use crate::Failure;
use crate::args::InfoArgs;
use crate::open::{load_options, open};
use crate::output::say;
use durer::camera::{Lens, Raster};
use durer::describe::DescribedList;
use durer::world::{Accel, Geometry, MeshTree, World};
use std::collections::BTreeMap;
use std::sync::Arc;

pub fn run(args: &InfoArgs) -> Result<(), Failure> {
    let opened = open(&args.scene, &load_options(&args.reading), args.json)?;
    let (loaded, world) = (&opened.loaded, &opened.world);
    let dialect = loaded.dialect;
    let count = Counted::of(world);
    if args.json {
        let value = serde_json::json!({
            "dialect": dialect.name(),
            "objects": world.objects.len(),
            "triangles": count.triangles,
            "distinct_triangles": count.distinct_triangles,
            "materials": world.materials.len(),
            "lights": world.lights.len(),
            "bytes": count.bytes,
            "scene": loaded.scene,
        });
        say(&serde_json::to_string_pretty(&value)?);
        return Ok(());
    }
    let bounds = world.bounds();
    let pose = world.camera.pose();
    say(&format!("scene      {}", args.scene.display()));
    say(&format!("dialect    {} ({})", dialect.name(), dialect.rules().title));
    let camera = &world.camera;
    let (name, rest) = (camera.keyword(dialect), fields(camera, &["center", "direction"]));
    say(&format!("camera     {name} at {}, looking along {}: {rest}", pose.center, pose.direction));
    let (width, height) = Raster::natural_size(camera.proportions(), loaded.rules.size);
    say(&format!("picture    {width}x{height} where no size is asked for"));
    for light in &world.lights {
        say(&format!("light      {}: {}", light.keyword(dialect), fields(light, &[])));
    }
    let shapes: Vec<String> = count.shapes.iter().map(|(name, n)| format!("{n} {name}")).collect();
    say(&format!(
        "objects    {}{}{}",
        world.objects.len(),
        if shapes.is_empty() { "" } else { ": " },
        shapes.join(", ")
    ));
    if count.triangles > 0 {
        say(&format!("triangles  {} in meshes, {} of them distinct", count.triangles, count.distinct_triangles));
    }
    say(&format!("materials  {}", world.materials.len()));
    if !bounds.is_empty() {
        say(&format!("bounds     {} to {}", bounds.min, bounds.max));
    }
    say(&format!(
        "memory     {:.1} MiB: geometry and trees {:.1}, pictures {:.1}",
        mib(count.bytes),
        mib(count.bytes - count.picture_bytes),
        mib(count.picture_bytes)
    ));
    Ok(())
}

fn mib(bytes: usize) -> f64 {
    bytes as f64 / f64::from(1 << 20)
}

/// The fields of a thing with their values, but for some.
fn fields<T: DescribedList>(thing: &T, except: &[&str]) -> String {
    let wanted = thing.fields().iter().enumerate().filter(|(_, field)| !except.contains(&field.name));
    let shown = wanted.filter_map(|(i, field)| Some(format!("{} {}", field.name, value(&thing.get(i)?))));
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

/// What a world holds.
#[derive(Default)]
struct Counted {
    shapes: BTreeMap<&'static str, usize>,
    triangles: usize,
    distinct_triangles: usize,
    bytes: usize,
    picture_bytes: usize,
}

impl Counted {
    /// Counts a mesh; one that several objects share counts once.
    fn mesh(&mut self, tree: &Arc<MeshTree>, seen: &mut Vec<*const MeshTree>) {
        self.triangles += tree.mesh.len();
        if !seen.contains(&Arc::as_ptr(tree)) {
            seen.push(Arc::as_ptr(tree));
            self.distinct_triangles += tree.mesh.len();
            self.bytes += tree.bytes();
        }
    }

    fn of(world: &World) -> Self {
        let mut count = Counted::default();
        let mut seen = Vec::new();
        for object in &world.objects {
            let name = match &object.geometry {
                Geometry::Primitive(shape) => shape.keywords()[0].0,
                Geometry::Mesh(tree) => {
                    count.mesh(tree, &mut seen);
                    "TriangleMesh"
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
        let faces = world.cube_map.iter().flat_map(|map| &map.faces);
        count.picture_bytes = world.textures.iter().chain(faces).map(|texture| texture.bytes()).sum();
        count.bytes += count.picture_bytes + size_of_val(&*world.objects);
        count.bytes += match world.accel() {
            Accel::Bvh(bvh) => bvh.bytes(),
            Accel::Grid { grid, parts } => grid.bytes() + size_of_val(&**parts),
            Accel::None => 0,
        };
        count
    }
}
