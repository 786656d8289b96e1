//! Compilation of a scene description into a world. All later stages use only the world.

mod cache;
mod decoded;
mod files;
mod lights;
mod materials;
mod media;
mod pictures;
pub mod rules;
mod solids;
#[cfg(any(test, feature = "testing"))]
#[doc(hidden)]
pub mod testing;

use crate::world::{
    Accel, Assets, Contents, CourseAccel, Geometry, Matrix, Object, Phong, SmallWorld, VectorLibrary, World,
};
pub use cache::{AssetCache, CacheStatistics};
use durer_bvh::{Bvh, Grid, PrimitivePacks};
use durer_diag::{Diagnostic, Diagnostics, Files, Span};
use durer_scene::asset::AssetDecoder;
use durer_scene::camera::{CameraBasis, Projection};
use durer_scene::dialect::{Dialect, DialectRules, MeshNormals, Quirk};
use durer_scene::light::{DirectionalLight, Light};
use durer_scene::math::{Aabb, Affine, Color, Vec3, fp};
use durer_scene::scene::{self, Group, MatrixOp, ObjectKind, Scene};
use durer_scene::shape::mesh::enlarged;
use durer_scene::shape::{Mesh, Primitive, Shape, Triangle};
use durer_scene::source::AssetSource;
use durer_scene::texture::sky::{SUN_RADIUS, SkyModel, preetham};
use glam::{DAffine3, DVec3};
use std::collections::HashMap;
use std::sync::Arc;

/// Kind of acceleration structure for the objects of a world, chosen by the user.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub enum AccelKind {
    /// A bounding volume hierarchy.
    #[default]
    Bvh,
    /// A uniform grid with the given numbers of cells along x, y and z, or with automatic numbers.
    Grid(Option<[u32; 3]>),
    /// No acceleration structure, so every ray tests all objects.
    None,
}

/// Inputs of [`compile`] other than the scene, such as file access, limits and a cache.
pub struct Resources<'a> {
    /// Source of the files that the scene names.
    pub source: &'a dyn AssetSource,
    /// Decoder for meshes, photometric files, spectra and densities.
    pub decoder: &'a dyn AssetDecoder,
    /// Files whose text is kept so that diagnostics can quote it.
    pub files: &'a mut Files,
    /// True if a missing cube map is only a warning. The background colour is then used instead.
    pub sky_optional: bool,
    /// Memory limit for meshes and pictures, in bytes.
    pub memory: u64,
    /// Expected number of camera rays, or `u64::MAX` if unknown. Few rays get a faster BVH build.
    pub rays: u64,
    /// Cache of meshes and pictures from earlier compilations.
    pub cache: Option<&'a AssetCache>,
}

impl<'a> Resources<'a> {
    /// Creates resources with unlimited memory, an unknown number of rays and no cache.
    pub fn new(source: &'a dyn AssetSource, decoder: &'a dyn AssetDecoder, files: &'a mut Files) -> Self {
        Resources { source, decoder, files, sky_optional: false, memory: u64::MAX, rays: u64::MAX, cache: None }
    }
}

/// Compiles a scene into a world and collects errors and warnings. Returns `None` if there were
/// errors.
///
/// The values are first checked with [`Scene::validate`], regardless of where the scene comes from.
pub fn compile(
    scene: &Scene,
    rules: &DialectRules,
    accel: AccelKind,
    resources: Resources,
    diagnostics: &mut Diagnostics,
) -> Option<World> {
    let mut own = Diagnostics::default();
    let cache = resources.cache;
    if let Some(cache) = cache {
        cache.begin(rules);
    }
    let mut loader = files::Loader::new(resources, rules, &scene.assets);
    let Some(camera) = scene.camera.clone() else {
        diagnostics.push(Diagnostic::error("the scene has no camera").code("no-camera").help(
            match rules::is_nodes(rules) {
                true => "add a `Camera { ... }`",
                false => "add a `PerspectiveCamera { ... }`",
            },
        ));
        return None;
    };
    let invalid = scene.validate_as(rules.quirks);
    if invalid.has_errors() {
        diagnostics.extend(invalid);
        return None;
    }
    check_camera(scene, camera.pose(), &mut own);
    let materials = materials::compile(scene, rules, &mut loader, &mut own);
    let mut flattener = SceneFlattener {
        objects: Vec::new(),
        loader: &mut loader,
        rules,
        diagnostics: &mut own,
        material_count: materials.len() as u32,
        plain_needed: false,
        without_material: None,
        transforms: 0,
        matrices: Some(Vec::new()),
        open_edges: HashMap::new(),
    };
    match &scene.root {
        Some(root) => flattener.group(root, DAffine3::IDENTITY),
        // The reader of the model has already reported this error.
        None if diagnostics.iter().any(|known| known.code == "no-objects") => {}
        None => {
            let warning = Diagnostic::warning("the scene has no objects: it has no `Group`");
            flattener.diagnostics.push(warning.code("no-objects"));
        }
    }
    flattener.warn_without_material(scene);
    let SceneFlattener { objects, plain_needed, .. } = flattener;
    let mut compiled = materials;
    if plain_needed {
        compiled.push(crate::world::Material::Phong(Phong::default()));
    }
    let cube_map = scene.background.cube_map.as_ref().and_then(|name| loader.cube_map(name, &mut own));
    check_sun(scene, &mut own);
    check_sky(scene, &mut own);
    let environment = loader.environment(&scene.background, &mut own);
    let fog = scene.fog.as_ref().and_then(|fog| media::fog(&fog.value, &mut loader, &mut own));
    let (mut lights, ambient) = lights::lights(scene, rules, &mut own);
    lights.extend(sun(&scene.background));
    let mut measured = |light: &mut Light| {
        let curve = light.spectrum().and_then(|name| loader.illuminant(name, &mut own))?;
        light.recolor(|color| color * curve.color());
        Some(curve)
    };
    let illuminants = lights.iter_mut().map(&mut measured).collect();
    let profiles: Vec<_> = lights.iter().map(|light| loader.profile(light, &mut own)).collect();
    for (light, profile) in lights.iter_mut().zip(&profiles) {
        if let (Light::Photometric(emitter), Some(profile)) = (light, profile) {
            *emitter = emitter.with_flux(profile);
        }
    }
    // Serialization fails only for non-finite numbers, which a valid scene does not contain.
    let digest = loader.resources.source.record().digest(&serde_json::to_vec(&(scene, rules)).unwrap_or_default());
    let textures = loader.textures;
    let failed = own.has_errors();
    diagnostics.extend(own);
    if failed {
        return None;
    }
    if let Some(cache) = cache {
        cache.finish();
    }
    let contents = Contents {
        frame: CameraBasis::of(&camera, rules::camera_rules(rules)),
        camera,
        // An environment map replaces the background colour, even if the map is black.
        background: if environment.is_none() && (scene.background.environment.is_some() || scene.background.is_night())
        {
            Color::ZERO
        } else {
            scene.background.color
        },
        hides_emitters: scene.background.emitters == Some(scene::Emitters::Hidden),
        // With `path`, a scene without a background is lit only by the lights that it defines. (The
        // Whitted integrator never takes light from the background.) Model files get a grey
        // background instead.
        is_black_for_paths: scene.up.is_none()
            && environment.is_none()
            && scene.background == scene::Background::default()
            && !scene.background_span.has_position()
            && rules.name == Dialect::Durer.name(),
        ambient,
        lights,
        materials: compiled,
        objects,
        camera_rules: rules::camera_rules(rules),
        hits: rules::hit_rules(rules),
        shading: rules::shading_rules(rules),
        display: rules::display_rules(rules, scene.lumens_per_watt),
        rules: rules.clone(),
    };
    let assets = Assets { cube_map, environment, fog, profiles, illuminants, textures };
    let mut world = World::new(contents, assets, digest);
    if let Err(error) = rebuild(&mut world, accel) {
        diagnostics.push(*error);
        return None;
    }
    Some(world)
}

/// Builds the acceleration structure of a world. It must be called again after objects have moved.
pub fn rebuild(world: &mut World, kind: AccelKind) -> Result<(), Box<Diagnostic>> {
    let objects = world.objects();
    if let Some(rules) = world.hit_rules() {
        let accel = Accel::Course(CourseAccel::new(rules, objects));
        (world.packs, world.small_world, world.outside_accel) = (PrimitivePacks::default(), None, Vec::new());
        (world.accel, world.spheres) = (accel, Vec::new());
        return Ok(());
    }
    let mut boxes: Vec<Option<Aabb>> = objects.iter().map(Object::bounds).collect();
    let bounded = || objects.iter().zip(&boxes).filter(|(_, bounds)| bounds.is_some());
    let (simple, others): (Vec<u32>, Vec<u32>) =
        (0..objects.len() as u32).partition(|&i| objects[i as usize].packing_cost().is_some());
    let work: usize = objects.iter().filter_map(Object::packing_cost).sum();
    let packed = |numbers: &[u32]| {
        let mut packs = PrimitivePacks::default();
        numbers.iter().for_each(|&i| objects[i as usize].add_to(&mut packs, i));
        packs
    };
    let is_few = kind == AccelKind::Bvh && others.len() <= MAX_LINEAR_OBJECTS && work <= MAX_LINEAR_COST;
    let few = is_few.then(|| SmallWorld { simple: packed(&simple), others });
    let of_one_ray = || bounded().filter_map(|(object, _)| object.single_ray_packing_cost());
    if kind == AccelKind::Bvh
        && bounded().count() - of_one_ray().count() <= MAX_LINEAR_OBJECTS
        && of_one_ray().sum::<usize>() <= MAX_LINEAR_COST
    {
        boxes.fill(None);
    }
    let mut loose: Vec<u32> = (0_u32..).zip(&boxes).filter(|(_, b)| b.is_none()).map(|(i, _)| i).collect();
    let is_simple = |&i: &u32| objects[i as usize].single_ray_packing_cost().is_some();
    let mut packed_indices: Vec<u32> = loose.iter().copied().filter(is_simple).collect();
    match packed_indices.len() >= MIN_PACKED {
        true => loose.retain(|i| !is_simple(i)),
        false => packed_indices.clear(),
    }
    let packs = packed(&packed_indices);
    let accel = build_accel(world, kind, boxes)?;
    let spheres = match &accel {
        Accel::Bvh(bvh) if objects.iter().any(|object| object.sphere().radius > 0.0) => {
            bvh.primitive_indices().iter().map(|&i| objects[i as usize].sphere()).collect()
        }
        _ => Vec::new(),
    };
    (world.packs, world.small_world, world.outside_accel, world.accel, world.spheres) =
        (packs, few, loose, accel, spheres);
    Ok(())
}

/// Maximum number of other objects for which a linear search is faster than a tree.
const MAX_LINEAR_OBJECTS: usize = 2;
/// Maximum total cost of simple shapes for which a linear search is faster than a tree, in sphere
/// tests. Simple shapes are tested eight at a time, or one shape against eight rays.
const MAX_LINEAR_COST: usize = 16;

/// Minimum number of simple shapes for which tests in groups of eight are faster.
const MIN_PACKED: usize = 4;

/// Builds the structure for the objects with the given bounds. The bounds of an unbounded object
/// are `None`.
fn build_accel(world: &World, kind: AccelKind, bounds: Vec<Option<Aabb>>) -> Result<Accel, Box<Diagnostic>> {
    let cells = match kind {
        AccelKind::None => return Ok(Accel::None),
        AccelKind::Bvh => {
            // The BVH ignores empty boxes.
            let boxes: Vec<Aabb> = bounds.into_iter().map(|bounds| bounds.unwrap_or(Aabb::EMPTY)).collect();
            return Ok(Accel::Bvh(Bvh::build(&boxes)));
        }
        AccelKind::Grid(cells) => cells,
    };
    let mut parts: Vec<(u32, u32)> = Vec::new();
    let mut boxes = Vec::new();
    for (i, object) in world.objects().iter().enumerate() {
        for part in 0..object.parts() {
            if let Some(bounds) = object.part_bounds(part) {
                parts.push((i as u32, part));
                boxes.push(bounds);
            }
        }
    }
    let mut wide = Vec::new();
    if cells.is_none() {
        let outliers = outliers(&boxes);
        wide = outliers.iter().map(|&i| parts[i]).collect();
        // Remove from last to first so that the remaining indices stay valid.
        for &i in outliers.iter().rev() {
            parts.remove(i);
            boxes.remove(i);
        }
    }
    let bounds = boxes.iter().copied().fold(Aabb::EMPTY, Aabb::union);
    if bounds.is_empty() {
        return Ok(Accel::None);
    }
    let counts = cells.unwrap_or_else(|| Grid::suggested_resolution(bounds, boxes.len()));
    let overlaps = |i: usize, cell: Aabb| world.objects()[parts[i].0 as usize].overlaps(&cell);
    let grid = Grid::build(bounds, counts, &boxes, overlaps).ok_or_else(|| {
        let [x, y, z] = counts;
        let most = Grid::MAX_CELLS;
        let message = format!("cannot build a grid of {x} x {y} x {z} cells");
        let help = format!("use 1 to {most} cells; large objects must not overlap too many cells");
        Box::new(Diagnostic::error(message).help(help))
    })?;
    Ok(Accel::Grid { grid, parts, wide })
}

/// Returns the indices of boxes that extend far beyond the others, in ascending order. If a grid
/// included them, all other boxes would be in a single cell of the grid.
fn outliers(boxes: &[Aabb]) -> Vec<usize> {
    /// Maximum number of outliers. Every ray tests all of them, so the number must be small.
    const MOST: usize = 64;
    /// Maximum number of grid cells along one axis; see `Grid::suitable`.
    const RATIO: f64 = 256.0;
    if boxes.len() < 2 {
        return Vec::new();
    }
    let middle = [0, 1, 2].map(|axis| {
        let mut centers: Vec<f32> = boxes.iter().map(|b| b.center()[axis]).collect();
        let half = centers.len() / 2;
        f64::from(*centers.select_nth_unstable_by(half, f32::total_cmp).1)
    });
    let middle = DVec3::from_array(middle);
    let reach = |b: &Aabb| (b.min.as_dvec3() - middle).abs().max((b.max.as_dvec3() - middle).abs()).max_element();
    let mut far: Vec<(f64, usize)> = boxes.iter().enumerate().map(|(i, b)| (reach(b), i)).collect();
    far.sort_by(|a, b| a.0.total_cmp(&b.0).then(a.1.cmp(&b.1)));
    let first = far.len().saturating_sub(MOST + 1).max(far.len() / 2);
    let gap = (first..far.len() - 1).find(|&i| far[i].0 * RATIO < far[i + 1].0);
    let mut found: Vec<usize> = gap.map_or(&[][..], |i| &far[i + 1..]).iter().map(|&(_, i)| i).collect();
    found.sort_unstable();
    found
}

/// Warns if the sun is below the horizon.
fn check_sun(scene: &Scene, diagnostics: &mut Diagnostics) {
    let low = |direction: Vec3| -fp::asin(direction.normalize_or(Vec3::Y).y).to_degrees();
    if let Some(way) = scene.background.sun()
        && low(way) > 0.0
    {
        let message = format!("the sun is {:.1} degrees below the horizon", low(way));
        let warning = Diagnostic::warning(message).code("sun-below").at(scene.background_span);
        let help = "for dusk, move the sun to the horizon; for night, add lights";
        diagnostics.push(warning.effect("the sun and its sky emit no light").help(help));
    }
}

/// Warns about sky parameters that have no effect.
fn check_sky(scene: &Scene, diagnostics: &mut Diagnostics) {
    let sky = &scene.background;
    let (standard, sun) = (sky.cie_sky.is_some(), !matches!(sky.sun_direction(), Ok(None)));
    let (clear, picture) = (sun && !standard, sky.environment.is_some());
    let perez = clear && sky.sky_model == Some(SkyModel::Perez);
    let any = standard || sun || picture;
    for (word, given, has_use, wanted) in [
        ("zenithLuminance", sky.zenith_luminance.is_some(), standard, "`cieSky`"),
        ("skyModel", sky.sky_model.is_some(), clear, "clear sky (a sun without `cieSky`)"),
        ("turbidity", sky.turbidity.is_some(), clear && !perez, "clear sky (a sun without `cieSky`)"),
        ("directNormal", sky.direct_normal.is_some(), perez, "sky of Perez (a sun with `skyModel perez`)"),
        ("diffuseHorizontal", sky.diffuse_horizontal.is_some(), perez, "sky of Perez (a sun with `skyModel perez`)"),
        ("dewPoint", sky.dew_point.is_some(), perez, "sky of Perez (a sun with `skyModel perez`)"),
        ("groundReflectance", sky.ground_reflectance.is_some(), standard || sun, "sun or `cieSky`"),
        ("environmentRotation", sky.environment_rotation.is_some(), any, "`environment`, sun or `cieSky`"),
        ("environmentScale", sky.environment_scale.is_some(), any, "`environment`, sun or `cieSky`"),
    ] {
        if given && !has_use {
            let message = format!("`{word}` has no effect: the background has no {wanted}");
            diagnostics.push(Diagnostic::warning(message).at(scene.background_span));
        }
    }
    let (turbidity, (low, high)) = (sky.turbidity(), preetham::TURBIDITIES.into_inner());
    if clear && sky.sky_model.unwrap_or_default() == SkyModel::Preetham && !(low..=high).contains(&turbidity) {
        let used = turbidity.clamp(low, high);
        let message = format!("`turbidity` {turbidity} is outside the range of Preetham's sky: {used} is used");
        diagnostics.push(Diagnostic::warning(message).at(scene.background_span));
    }
}

/// Warns if the camera's `up` is parallel to its `direction`.
fn check_camera(scene: &Scene, pose: durer_scene::camera::Pose, diagnostics: &mut Diagnostics) {
    let parallel = pose.direction.as_dvec3().normalize_or_zero().cross(pose.up.as_dvec3().normalize_or_zero()).length();
    if parallel < 1e-6 {
        let message = "the camera's `up` is parallel to its `direction`, so the picture's rotation is arbitrary";
        let warning = Diagnostic::warning(message).code("up-parallel").at(scene.camera_span);
        diagnostics.push(warning.help("choose another `up`"));
    }
}

/// Returns a directional light for the sun of a clear sky.
fn sun(background: &scene::Background) -> Option<Light> {
    let (direction, illuminance) = background.sunlight()?;
    // The colour of a light is the radiance of a white matte surface that it illuminates, which is
    // illuminance divided by pi.
    let color = illuminance / std::f32::consts::PI;
    Some(DirectionalLight { direction, color, spread: Some(SUN_RADIUS), ..Default::default() }.into())
}

/// Visitor that flattens the nested groups and transforms of a scene into a list of objects.
struct SceneFlattener<'a, 'r> {
    objects: Vec<Object>,
    loader: &'a mut files::Loader<'r>,
    rules: &'a DialectRules,
    diagnostics: &'a mut Diagnostics,
    material_count: u32,
    /// True if some object needs the default material, which is added after all other materials.
    plain_needed: bool,
    /// First object without a material, and the number of such objects.
    without_material: Option<(Span, usize)>,
    /// Number of transforms that enclose the current object.
    transforms: u32,
    /// Matrices of the enclosing transforms, multiplied as in an official program, with the
    /// outermost first. `None` inside a CSG solid, because the official programs do not support
    /// solids.
    matrices: Option<Vec<Matrix>>,
    /// For each mesh file in a solid, an edge that belongs to an odd number of triangles, or `None`
    /// if the mesh is closed.
    open_edges: HashMap<String, Option<[Vec3; 2]>>,
}

impl SceneFlattener<'_, '_> {
    /// Reports a single warning for all objects without a material.
    fn warn_without_material(&mut self, scene: &Scene) {
        let Some((span, count)) = self.without_material else { return };
        let mut message = "this object has no material and is rendered in plain grey".to_string();
        match count {
            1 => {}
            2 => message += "; one other object has no material either",
            n => message += &format!("; {} other objects have no material either", n - 1),
        }
        let warning = Diagnostic::warning(message).code("no-material").at(span);
        let has_materials = !scene.materials.is_empty();
        self.diagnostics.push(warning.help(match (rules::is_nodes(self.rules), has_materials) {
            (true, _) => "write `Component<Material> { index 0 }` into the object's node",
            (false, true) => "write `MaterialIndex 0` before the object",
            (false, false) => "add a `Materials { ... }` block, and write `MaterialIndex 0` before the object",
        }));
    }

    /// Adds all objects of a group. `to_world` is the product of the enclosing transforms.
    fn group(&mut self, group: &Group, to_world: DAffine3) {
        for object in &group.objects {
            self.object(object, to_world);
        }
    }

    /// Adds an object with its contents. `to_world` is the product of the enclosing transforms.
    fn object(&mut self, object: &scene::Object, to_world: DAffine3) {
        match &object.node {
            ObjectKind::Group(group) => self.group(group, to_world),
            ObjectKind::Transform(ops, inner) => {
                self.transforms += 1;
                let vectors = rules::hit_rules(self.rules).map_or(VectorLibrary::Vecmath, |rules| rules.vectors);
                let own = Matrix::of(ops, rules::matrix_rules(self.rules), vectors);
                self.matrices.iter_mut().for_each(|matrices| matrices.push(own));
                self.object(inner, to_world * self.product(ops));
                self.matrices.iter_mut().for_each(|matrices| _ = matrices.pop());
                self.transforms -= 1;
            }
            ObjectKind::Solid(operation, parts) => {
                let around = self.matrices.take();
                self.solid(object.span, *operation, parts, to_world);
                self.matrices = around;
            }
            _ => {
                let shape = self.shape(object, to_world);
                self.objects.extend(shape);
            }
        }
    }

    fn product(&self, ops: &[MatrixOp]) -> DAffine3 {
        MatrixOp::product(ops, rules::matrix_rules(self.rules))
    }

    /// Places a shape or mesh in the world. Returns `None` if there was an error.
    fn shape(&mut self, object: &scene::Object, to_world: DAffine3) -> Option<Object> {
        let geometry = match &object.node {
            ObjectKind::Primitive(Primitive::Triangle(t)) if self.rules.has(Quirk::LooseTriangles) => {
                let [vertex0, vertex1, vertex2] = enlarged(t.corners());
                Geometry::Primitive(Triangle { vertex0, vertex1, vertex2 }.into())
            }
            ObjectKind::Primitive(shape) => Geometry::Primitive(shape.clone()),
            ObjectKind::Mesh(mesh) => Geometry::Mesh(self.loader.mesh(&mesh.obj_file, self.diagnostics)?),
            ObjectKind::HeightField(field) => Geometry::Mesh(self.loader.height_field(field, self.diagnostics)?),
            ObjectKind::Voxels(grid, balls) => {
                let mesh = Mesh::new(grid.mesh(balls), MeshNormals::Flat, false);
                Geometry::Mesh(Arc::new(self.loader.tree(mesh)))
            }
            ObjectKind::Group(_) | ObjectKind::Transform(..) | ObjectKind::Solid(..) => return None,
        };
        // Move distant shapes to the origin to keep full precision.
        let (geometry, center) = match geometry {
            Geometry::Primitive(shape)
                if !self.rules.is_bit_compatible() && shape.bounds().is_some_and(Aabb::is_far) =>
            {
                let (shape, center) = shape.centered().unwrap_or((shape, Vec3::ZERO));
                (Geometry::Primitive(shape), center)
            }
            Geometry::Mesh(tree) => {
                let center = tree.mesh.center();
                (Geometry::Mesh(tree), center)
            }
            other => (other, Vec3::ZERO),
        };
        let matrices = self.matrices_around(to_world);
        let to_world = to_world * DAffine3::from_translation(center.as_dvec3());
        let to_world = match to_world == DAffine3::IDENTITY {
            true => None,
            false => match Affine::new(to_world) {
                Some(affine) if affine.is_identity() => None,
                Some(affine) => Some(affine),
                None if self.rules.has(Quirk::AnyValues) && !matrices.is_empty() => {
                    let message = "the transforms that enclose this object are singular";
                    let warning = Diagnostic::warning(message).code("flat-transform").at(object.span);
                    self.diagnostics.push(warning.effect("rays are divided by zero, as in the official program"));
                    None
                }
                None => {
                    let message = "the transforms that enclose this object are singular, or their numbers overflow";
                    self.diagnostics.push(Diagnostic::error(message).code("flat-transform").at(object.span));
                    return None;
                }
            },
        };
        let material = match object.material {
            Some(index) if index < self.material_count => index,
            index => {
                if index.is_none() {
                    self.without_material.get_or_insert((object.span, 0)).1 += 1;
                }
                self.plain_needed = true;
                self.material_count
            }
        };
        let normal_length = match &object.node {
            ObjectKind::Primitive(Primitive::Plane(plane))
                if self.transforms == 0 && self.rules.has(Quirk::RawNormals) =>
            {
                plane.normal.length()
            }
            _ if to_world.is_none() && !matrices.iter().all(Matrix::is_regular) => f32::NAN,
            _ => 1.0,
        };
        Some(Object { geometry, to_world, matrices, center, material, normal_length, span: object.span })
    }

    /// Returns the matrices that enclose an object if the arithmetic of an official program is
    /// active. There is one matrix per transform or, with glm, a single product of all of them.
    fn matrices_around(&self, to_world: DAffine3) -> Vec<Matrix> {
        let Some(rules) = rules::hit_rules(self.rules) else { return Vec::new() };
        match (&self.matrices, rules.vectors) {
            (None, _) => vec![Matrix::from(to_world)],
            (Some(matrices), VectorLibrary::Vecmath) => matrices.clone(),
            (Some(matrices), VectorLibrary::Glm) => {
                vec![matrices.iter().fold(Matrix::IDENTITY, |outer, inner| outer.times(inner, rules.vectors))]
            }
        }
    }
}

#[cfg(test)]
mod tests;
