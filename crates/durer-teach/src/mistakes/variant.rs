//! A scene, its rules, and the mistakes with which it is rendered.

use super::bugs::{Bugs, CameraBugs, OutputBug, PixelOrder};
use super::path_bugs::PathBugs;
use durer_bvh::BuildQuality;
use durer_render::compile::rules::matrix_rules;
use durer_render::compile::{self, AccelKind};
use durer_render::integrator::RenderSettings;
use durer_render::render::raster;
use durer_render::world::{Geometry, HighlightModel, Material, MeshTree, Object, Phong, World};
use durer_scene::camera::{Camera, CameraBasis, CameraSample, Projection, Raster};
use durer_scene::dialect::{DialectRules, Highlight, Quirk};
use durer_scene::light::Light;
use durer_scene::material::PhongMaterial;
use durer_scene::math::{Color, Ray, Vec2};
use durer_scene::scene::{self, Group, MatrixOp, MatrixRules, ObjectKind, Scene};
use durer_scene::shape::{Primitive, Triangle};
use glam::DAffine3;
use std::sync::Arc;

/// A scene with the mistakes of a student's program. Rows of the table of mistakes change it before
/// it is rendered.
#[derive(Clone, Debug)]
pub struct SceneVariant<'s> {
    /// The parsed scene.
    pub scene: &'s Scene,
    /// The world, which consists of geometry, lights, materials, camera and rules.
    pub world: World,
    /// Options of Whitted's method.
    pub settings: RenderSettings,
    /// Mistakes of the Whitted tracer.
    pub bugs: Bugs,
    /// Mistakes in camera rays.
    pub camera_bugs: CameraBugs,
    /// Mistake in the output values.
    pub output: OutputBug,
    /// Mistakes in the order of pixels and channels.
    pub pixel_order: PixelOrder,
    /// Mistakes of the path tracer.
    pub paths: PathBugs,
    /// World in which shadow rays are traced, if it is another one.
    pub shadow_world: Option<Arc<World>>,
}

/// Returns true if at least one light in the scene file has three attenuation coefficients.
pub fn three_factors(scene: &Scene) -> bool {
    let factors = |light: &Light| matches!(light, Light::Point(p) if p.attenuation.is_some() && p.falloff.is_none());
    scene.lights.iter().flatten().any(|light| factors(&light.value))
}

/// Factor by which a triangle is extended if the test of one side is missing.
const EXTENSION: f32 = 100.0;

/// Kind of shape that the course's programs implement and that mistakes in intersection can affect.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum CourseShape {
    /// `Sphere`.
    Sphere,
    /// `Plane`.
    Plane,
    /// `Triangle`.
    Triangle,
    /// A triangle mesh.
    Mesh,
}

/// Returns the kind of shape to which a geometry belongs, or `None` if the course's programs do not
/// have it.
pub fn course_shape(geometry: &Geometry) -> Option<CourseShape> {
    match geometry {
        Geometry::Mesh(_) => Some(CourseShape::Mesh),
        Geometry::Solid(_) => None,
        Geometry::Primitive(shape) => match shape {
            Primitive::Sphere(_) => Some(CourseShape::Sphere),
            Primitive::Plane(_) => Some(CourseShape::Plane),
            Primitive::Triangle(_) => Some(CourseShape::Triangle),
            // The course has no other shapes.
            _ => None,
        },
    }
}

/// Function that multiplies a transform's matrices, either correctly or with a mistake.
pub type Product<'p> = &'p dyn Fn(&[MatrixOp], MatrixRules) -> DAffine3;

impl<'s> SceneVariant<'s> {
    /// Creates a variant without mistakes.
    pub fn new(scene: &'s Scene, world: World, settings: RenderSettings) -> Self {
        let (bugs, aim, output, turn, paths) = Default::default();
        let shadow_world = None;
        SceneVariant { scene, world, settings, bugs, camera_bugs: aim, output, pixel_order: turn, paths, shadow_world }
    }

    /// Returns the camera ray of a pixel. `place` is a position in pixels, measured from the upper
    /// left corner.
    pub fn ray(&self, raster: &Raster, (x, y): (u32, u32), place: Vec2, lens: Vec2) -> Option<Ray> {
        let point = |place: Vec2| {
            raster.point(place + self.camera_bugs.sample_position - 0.5)
                * self.camera_bugs.factor(raster.width, raster.height)
        };
        let pixel = point(Vec2::new(x as f32, y as f32) + 0.5);
        let sample = CameraSample { point: point(place), pixel, lens };
        let ray = self.world.camera().ray(self.world.camera_frame(), &sample)?;
        let t_min = if self.camera_bugs.from_center { ray.t_min.max(0.0) } else { ray.t_min };
        Some(Ray { t_min, ..ray })
    }

    /// Returns the raster of a picture with the given size.
    pub fn raster(&self, width: u32, height: u32) -> Raster {
        raster(&self.world, width, height)
    }

    /// Returns true if at least one light in the scene file has three attenuation coefficients.
    pub fn has_three_factors(&self) -> bool {
        three_factors(self.scene)
    }

    /// Switches a quirk of the dialect on or off.
    pub fn toggle(&mut self, compat: Quirk) {
        self.change_rules(|rules| rules.quirks ^= compat.bit());
    }

    /// Changes the dialect's rules. The camera basis, the lights, the materials and the objects do
    /// not change.
    pub fn change_rules(&mut self, change: impl FnOnce(&mut DialectRules)) {
        let mut rules = self.world.rules().clone();
        change(&mut rules);
        self.world.edit().set_rules(rules);
    }

    /// Recomputes the camera basis from the rules.
    pub fn update_camera_basis(&mut self) {
        self.world.edit().frame = CameraBasis::of(self.world.camera(), self.world.camera_rules());
    }

    /// Returns the field of view of a perspective camera, in degrees.
    pub fn angle(&self) -> Option<f32> {
        match self.world.camera() {
            Camera::Perspective(camera) => Some(camera.angle),
            _ => None,
        }
    }

    /// Changes all Phong materials.
    pub fn phongs(&mut self, change: impl Fn(&mut Phong)) {
        for material in &mut self.world.edit().materials {
            if let Material::Phong(phong) = material {
                change(phong);
            }
        }
    }

    /// Switches all highlights from Blinn's model to Phong's model, or the reverse.
    pub fn swap_highlight_model(&mut self) {
        let behind = self.world.rules().has(Quirk::HighlightBehind);
        self.phongs(|phong| {
            if let Some((_, _, model)) = &mut phong.highlight {
                *model = match model {
                    HighlightModel::Blinn => HighlightModel::Phong { behind },
                    HighlightModel::Phong { .. } => HighlightModel::Blinn,
                };
            }
        });
    }

    /// Adds highlights to materials with a specular colour if the dialect has no highlights.
    ///
    /// `form` is 0 for Phong's model, 1 for Phong's model on the lit side only, and 2 for Blinn's
    /// model.
    pub fn add_highlights(&mut self, form: f32) {
        if self.world.rules().highlight != Highlight::None {
            return;
        }
        let behind = self.world.rules().has(Quirk::HighlightBehind) && form == 0.0;
        let model = if form == 2.0 { HighlightModel::Blinn } else { HighlightModel::Phong { behind } };
        for (parsed, material) in self.scene.materials.iter().zip(&mut self.world.edit().materials) {
            if let (scene::Material::Phong(parsed, _), Material::Phong(phong)) = (&parsed.value, material) {
                let PhongMaterial { specular_color, shininess, .. } = **parsed;
                phong.highlight = Some((specular_color, shininess.unwrap_or(0.0), model));
            }
        }
    }

    /// Adds a black highlight to every material without a highlight.
    pub fn highlights_everywhere(&mut self) {
        let behind = self.world.rules().has(Quirk::HighlightBehind);
        let model = match self.world.rules().highlight {
            Highlight::None => return,
            Highlight::Phong => HighlightModel::Phong { behind },
            Highlight::Blinn | Highlight::ByKeyword => HighlightModel::Blinn,
        };
        for (parsed, material) in self.scene.materials.iter().zip(&mut self.world.edit().materials) {
            if let (scene::Material::Phong(parsed, _), Material::Phong(phong)) = (&parsed.value, material) {
                let exponent = parsed.exponent.or(parsed.shininess).unwrap_or(1.0);
                phong.highlight.get_or_insert((Color::ZERO, exponent, model));
            }
        }
    }

    /// Returns true if the scene file transforms any object.
    pub fn has_transforms(&self) -> bool {
        fn any(group: &Group) -> bool {
            group.objects.iter().any(|object| match &object.node {
                ObjectKind::Group(group) => any(group),
                ObjectKind::Transform(..) => true,
                _ => false,
            })
        }
        self.scene.root.as_ref().is_some_and(any)
    }

    /// Recomputes the transforms of all objects with `product`.
    pub fn set_transforms(&mut self, product: Product) {
        let rules = matrix_rules(self.world.rules());
        let mut transforms = Vec::new();
        if let Some(root) = &self.scene.root {
            object_transforms(root, DAffine3::IDENTITY, &|ops| product(ops, rules), &mut transforms);
        }
        // Compilation splits solids into pieces, so nothing is done if objects and transforms do
        // not correspond.
        if transforms.len() != self.world.objects().len() {
            return;
        }
        for (object, place) in self.world.edit().objects.iter_mut().zip(transforms) {
            if !matches!(object.geometry, Geometry::Solid(_)) {
                object.set_transform(place);
            }
        }
        self.rebuild();
    }

    /// Traces shadow rays in a copy of the world to which `change` is made.
    pub fn change_shadow_world(&mut self, change: impl FnOnce(&mut Self)) {
        let mut other = self.clone();
        change(&mut other);
        self.shadow_world = Some(Arc::new(other.world));
    }

    fn rebuild(&mut self) {
        // Unlike a grid, a BVH can always be built.
        let _ = compile::rebuild(&mut self.world, AccelKind::Bvh);
    }

    /// Extends every triangle to a parallelogram.
    pub fn parallelograms(&mut self) {
        let mut halves = Vec::new();
        for object in &mut self.world.edit().objects {
            match &mut object.geometry {
                Geometry::Primitive(shape) => {
                    if let Primitive::Triangle(triangle) = shape {
                        let [a, b, c] = triangle.corners();
                        let half = Triangle { vertex0: b, vertex1: b + c - a, vertex2: c };
                        let geometry = Geometry::Primitive(Primitive::Triangle(half));
                        halves.push(Object { geometry, ..object.clone() });
                    }
                }
                Geometry::Mesh(tree) => {
                    *tree = Arc::new(MeshTree::new(tree.mesh.with_parallelograms(), BuildQuality::Balanced))
                }
                Geometry::Solid(_) => {}
            }
        }
        self.world.edit().objects.extend(halves);
        self.rebuild();
    }

    /// Extends every triangle beyond the side opposite a corner, as if the test of that side were
    /// missing.
    pub fn extend_beyond_side(&mut self, corner: usize) {
        for object in &mut self.world.edit().objects {
            match &mut object.geometry {
                Geometry::Primitive(shape) => {
                    if let Primitive::Triangle(triangle) = shape {
                        let all = triangle.corners();
                        let [vertex0, vertex1, vertex2] = all.map(|p| all[corner] + EXTENSION * (p - all[corner]));
                        *triangle = Triangle { vertex0, vertex1, vertex2 };
                    }
                }
                Geometry::Mesh(tree) => {
                    *tree = Arc::new(MeshTree::new(
                        tree.mesh.with_scaled_triangles(corner, EXTENSION),
                        BuildQuality::Balanced,
                    ))
                }
                Geometry::Solid(_) => {}
            }
        }
        self.rebuild();
    }

    /// Uses the values of base colour textures without decoding them.
    pub fn undecoded_textures(&mut self) {
        let mut textures: Vec<u32> = Vec::new();
        for material in self.world.materials() {
            if let Material::Phong(phong) = material {
                textures.extend(phong.principled.as_ref().map_or(phong.texture, |own| own.maps.base_color));
            }
        }
        self.world.decode_textures(&textures, |code| f32::from(code) / 255.0);
    }

    /// Changes the geometry of every object.
    pub fn objects(&mut self, change: impl Fn(&mut Geometry)) {
        self.world.edit().objects.iter_mut().for_each(|object| change(&mut object.geometry));
        self.rebuild();
    }
}

/// Collects the matrices of all objects in the order of compilation.
fn object_transforms(
    group: &Group,
    to_world: DAffine3,
    product: &dyn Fn(&[MatrixOp]) -> DAffine3,
    transforms: &mut Vec<DAffine3>,
) {
    fn one(
        object: &scene::Object,
        to_world: DAffine3,
        product: &dyn Fn(&[MatrixOp]) -> DAffine3,
        transforms: &mut Vec<DAffine3>,
    ) {
        match &object.node {
            ObjectKind::Group(group) => object_transforms(group, to_world, product, transforms),
            ObjectKind::Transform(ops, inner) => one(inner, to_world * product(ops), product, transforms),
            _ => transforms.push(to_world),
        }
    }
    group.objects.iter().for_each(|object| one(object, to_world, product, transforms));
}
