//! Defaults for models, which consist of a camera that shows the full model, lights, a ground and a
//! material.

use super::extent::points;
use super::{Background, Group, Material, Object, ObjectKind, Scene, Spanned};
use crate::camera::{Camera, OrthographicCamera, PerspectiveCamera, Projection};
use crate::light::{DirectionalLight, Illuminate as _, Light};
use crate::material::PrincipledMaterial;
use crate::math::{Vec3, fp};
use crate::shape::plane::Plane;
use durer_diag::Span;
use glam::{DMat3, DVec3};
use std::path::PathBuf;

/// Coordinate axis, such as the up axis of a model.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Axis {
    /// The x axis.
    X,
    /// The y axis.
    Y,
    /// The z axis.
    Z,
}

/// Preset view of a model, for models that have no camera or whose camera is to be replaced.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub enum PresetView {
    /// Perspective view from the front, slightly from the right and from above.
    #[default]
    ThreeQuarter,
    /// Parallel view from the front.
    Front,
    /// Parallel view from behind.
    Back,
    /// Parallel view from the left.
    Left,
    /// Parallel view from the right.
    Right,
    /// Parallel view from above.
    Top,
    /// Parallel view from below.
    Bottom,
    /// Parallel view from the upper right front corner, in which edges along all three axes have
    /// equal lengths.
    Iso,
    /// The view of `Iso` from the upper left front corner.
    IsoLeft,
    /// The view of `Iso` from the upper right back corner.
    IsoBack,
}

/// Preset lighting for models without lights.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub enum DefaultLighting {
    /// No light and no ground.
    None,
    /// A key light from the upper left, a weaker light from the right, and a bright ground.
    #[default]
    Soft,
    /// A low sun under a blue sky, and a bright ground.
    Sun,
}

/// Options for turning a model into a complete scene with a camera, lights, a ground and a
/// material.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct SceneDefaults {
    /// Up axis, or `None` for the usual axis of the format.
    pub up: Option<Axis>,
    /// Preset view, or `None` for the model's own camera. If the model has no camera, `None`
    /// selects a three-quarter view.
    pub view: Option<PresetView>,
    /// Preset lighting, or `None` for the model's own lights. If the model has no lights, `None`
    /// selects [`DefaultLighting::Soft`].
    pub lighting: Option<DefaultLighting>,
    /// Name of the camera to use, or `None` for the first camera.
    pub camera: Option<String>,
    /// Name of the glTF material variant to use (KHR_materials_variants), or `None` for the default
    /// materials.
    pub variant: Option<String>,
    /// Name or number of the animation, or `None` for the first.
    pub animation: Option<String>,
    /// Time of the animation in seconds, or `None` for no animation.
    pub animation_time: Option<f32>,
    /// File of Radiance views, the last of which becomes the camera.
    pub view_file: Option<PathBuf>,
    /// Environment map that lights the model instead of the default lights.
    pub environment: Option<PathBuf>,
    /// Rotation of the environment map about the up axis in degrees, or `None` for 0.
    pub environment_rotation: Option<f32>,
    /// True to move the model's own camera to a position from which the full model is visible.
    pub fit: bool,
    /// Angle in degrees by which the camera orbits the model, counter-clockwise as seen from above,
    /// or `None` for a single picture. The distance of the camera is chosen so that the full model
    /// is visible at all angles.
    pub orbit_degrees: Option<f32>,
    /// True to neither add nor replace anything, because the scene is being converted to another
    /// format.
    pub convert_only: bool,
    /// True to add a ground below the model in any case, for example with an environment map.
    pub ground: bool,
    /// True to add no ground below the model.
    pub no_ground: bool,
    /// True to use only the model's own light, even if it has none.
    pub own_light: bool,
    /// Ratio of width to height of the picture that the camera should fill, or `None` for 1.
    pub aspect: Option<f32>,
}

/// Right, up and front directions of a model, for a viewer in front of it.
pub struct ModelAxes {
    /// Direction to the viewer's right.
    pub right: DVec3,
    /// Direction upwards.
    pub up: DVec3,
    /// Direction from the model towards the viewer.
    pub front: DVec3,
}

impl ModelAxes {
    /// Creates the directions for a model with the given up axis.
    pub fn new(up: Axis) -> Self {
        let (right, up) = match up {
            Axis::X => (DVec3::NEG_Y, DVec3::X),
            Axis::Y => (DVec3::X, DVec3::Y),
            Axis::Z => (DVec3::X, DVec3::Z),
        };
        ModelAxes { right, up, front: right.cross(up) }
    }
}

/// Field of view across the larger side of the picture, in degrees.
const ANGLE: f32 = 30.0;
/// Number of angles of an orbiting camera from which the model must be visible.
const ORBIT_STEPS: u32 = 48;
/// Fraction of the width or height of the picture that a model fills.
const FILL: f64 = 0.86;

/// Maximum brightness of one indirect contribution under the studio lights, under which white is
/// about 1. Otherwise, mirrored lights would make single bright pixels with few samples.
const STUDIO_CLAMP: f32 = 4.0;
/// Colour of the ground.
const GROUND: Vec3 = Vec3::splat(0.5);
/// Radiance of the grey surroundings of a model with its own lights, as a fraction of the radiance
/// of a white surface that its lights illuminate.
const SURROUNDINGS: f32 = 0.3;

impl SceneDefaults {
    /// Adds no lights and no ground, and replaces requested lighting by none, for a program that
    /// reads only the meshes of a model.
    pub fn meshes_only(&mut self) {
        self.lighting = self.lighting.and(Some(DefaultLighting::None));
        self.own_light = true;
    }

    /// Adds the parts that the scene lacks. `up` is the usual up axis of the format of the scene.
    /// If `dark` is set, a scene without lights counts as complete if it has a camera or emitters.
    pub fn complete(&self, scene: &mut Scene, up: Axis, dark: bool) {
        let sides = ModelAxes::new(self.up.unwrap_or(up));
        let framed = scene.camera.is_none() || self.view.is_some() || self.orbit_degrees.is_some();
        let lit = scene.is_lit
            || (dark && (scene.camera.is_some() || scene.emits_light()))
            || scene.lights.as_ref().is_some_and(|lights| !lights.is_empty());
        let pose = scene.camera.as_ref().map(Projection::pose);
        let mut fitted = false;
        if framed {
            scene.camera = Some(self.camera(scene, &sides, self.view.unwrap_or_default()));
        } else if let Some(pose) = pose.filter(|pose| self.fit || !lit && self.may_fit(scene, pose.center)) {
            let [forward, up] = [pose.direction, pose.up].map(|v| v.as_dvec3().normalize_or(sides.up));
            scene.camera = Some(self.framing_camera(scene, &sides, (-forward, up), true));
            // A camera that looks up would see the ground from below.
            fitted = forward.dot(sides.up) < 0.1;
        }
        assign_default_material(scene);
        let surrounded = self.environment.is_some() && self.lighting.is_none();
        let missing = !lit && !surrounded && !self.own_light;
        let studio = self.lighting.or(missing.then(DefaultLighting::default));
        if let Some(studio) = studio {
            self.light(scene, &sides, studio, framed || fitted);
        }
        if self.ground {
            add_ground(scene, &sides, GROUND);
        }
        // The background of a scene that has its own light is black, unless the file sets it. The
        // lights of a model get surroundings as well, because what they miss would be black.
        let has_lights = scene.lights.as_ref().is_some_and(|lights| !lights.is_empty());
        let emits = scene.emits_light();
        let unset = scene.background == Background::default() && !scene.background_span.has_position();
        if unset && (emits || has_lights || self.own_light) {
            let adds_surroundings =
                !(dark || emits || scene.is_lit || surrounded || self.own_light || studio.is_some());
            let surroundings = if adds_surroundings { SURROUNDINGS * light_at_center(scene) } else { 0.0 };
            scene.background.color = Vec3::splat(surroundings);
            if surroundings > 0.0 {
                scene.background.ambient_light = Vec3::splat(0.5 * surroundings);
            }
        }
    }

    /// Creates a camera that shows the full scene, centred in the picture.
    fn camera(&self, scene: &Scene, sides: &ModelAxes, view: PresetView) -> Camera {
        let &ModelAxes { right, up, front } = sides;
        let (back, above) = match view {
            // The camera is 35 degrees to the right and 22 degrees above.
            PresetView::ThreeQuarter => (0.927 * (0.819 * front + 0.574 * right) + 0.375 * up, up),
            PresetView::Front => (front, up),
            PresetView::Back => (-front, up),
            PresetView::Left => (-right, up),
            PresetView::Right => (right, up),
            PresetView::Top => (up, -front),
            PresetView::Bottom => (-up, front),
            PresetView::Iso => (front + right + up, up),
            PresetView::IsoLeft => (front - right + up, up),
            PresetView::IsoBack => (right - front + up, up),
        };
        self.framing_camera(scene, sides, (back, above), view == PresetView::ThreeQuarter)
    }

    /// Returns true if the camera of a model without lights may be moved so that the full model is
    /// visible: if it was not selected by name, is not part of an animation, and is not inside.
    fn may_fit(&self, scene: &Scene, eye: Vec3) -> bool {
        let [least, most] = bounds(scene);
        let eye = eye.as_dvec3();
        let is_inside = eye.cmpge(least).all() && eye.cmple(most).all();
        self.camera.is_none() && self.view_file.is_none() && self.animation_time.is_none() && !is_inside
    }

    /// Creates a camera that shows the full scene from the given direction.
    fn framing_camera(
        &self,
        scene: &Scene,
        sides: &ModelAxes,
        (back, above): (DVec3, DVec3),
        perspective: bool,
    ) -> Camera {
        let forward = -back.normalize();
        let across = forward.cross(above).try_normalize().unwrap_or_else(|| forward.any_orthonormal_vector());
        let upwards = across.cross(forward);
        let aspect = f64::from(self.aspect.unwrap_or(1.0)).clamp(1e-3, 1e3);
        // Compute half the width and half the height of the picture, whose larger side runs from -1
        // to 1.
        let (wide, high) = (aspect.min(1.0), (1.0 / aspect).min(1.0));
        let mut extent = VisibleExtent::new(tan_half_angle() * FILL * wide, tan_half_angle() * FILL * high);
        let mut add = |p: DVec3| extent.add(p.dot(across), p.dot(upwards), p.dot(forward));
        let axis = self.orbit_degrees.map(|_| axis(scene, sides));
        match axis {
            None => points(scene, &mut add),
            // Add the points at all angles of the orbit.
            Some(axis) => points(scene, &mut |p| {
                (0..ORBIT_STEPS).for_each(|i| {
                    add(axis + rotation(sides.up, 360.0 * f64::from(i) / f64::from(ORBIT_STEPS)) * (p - axis))
                });
            }),
        }
        let turned = rotation(sides.up, f64::from(self.orbit_degrees.unwrap_or(0.0)));
        let (direction, up) = ((turned * forward).as_vec3(), (turned * above).as_vec3());
        let middle = axis.unwrap_or_default();
        let place =
            |[x, y, z]: [f64; 3]| (middle + turned * (x * across + y * upwards + z * forward - middle)).as_vec3();
        if perspective {
            return PerspectiveCamera { center: place(extent.perspective_eye()), direction, up, angle: ANGLE }.into();
        }
        let [half_x, half_y] = extent.half_sizes();
        let size = (2.0 * (half_x / wide).max(half_y / high) / FILL) as f32;
        let size = if size > 0.0 { size } else { 2.0 };
        let center = place(extent.orthographic_eye(f64::from(size)));
        OrthographicCamera { center, direction, up, size, ..Default::default() }.into()
    }

    /// Adds light, and also a ground if the camera is a default camera.
    fn light(&self, scene: &mut Scene, sides: &ModelAxes, studio: DefaultLighting, framed: bool) {
        if studio == DefaultLighting::None {
            scene.lights.get_or_insert_default();
            return;
        }
        let pose = scene.camera.as_ref().map(crate::camera::Projection::pose);
        let forward = pose.map_or(-sides.front, |pose| pose.direction.as_dvec3().normalize_or(-sides.front));
        // Use the horizontal part of the view direction, so that light comes from above even if the
        // camera looks down.
        let forward = forward.reject_from(sides.up).try_normalize().unwrap_or(-sides.front);
        let right = forward.cross(sides.up);
        let from = |x: f64, y: f64, z: f64| -(x * right + y * sides.up - z * forward).normalize().as_vec3();
        let light = |direction: Vec3, color: Vec3| Spanned {
            value: Light::from(DirectionalLight { direction, color, ..DirectionalLight::default() }),
            span: Span::default(),
        };
        let (lights, ambient, sky, ground) = match studio {
            DefaultLighting::Sun => (
                vec![light(from(-0.7, 0.75, 0.45), Vec3::new(0.95, 0.86, 0.7))],
                Vec3::new(0.2, 0.24, 0.3),
                Vec3::new(0.3, 0.5, 0.85),
                Vec3::new(0.55, 0.5, 0.42),
            ),
            // These values are chosen so that a white object is brighter than the background, both
            // for path tracing and for Whitted's method.
            _ => (
                vec![
                    light(from(-0.6, 1.0, 0.7), Vec3::splat(0.75)),
                    light(from(1.0, 0.5, 0.5), Vec3::new(0.095, 0.1, 0.11)),
                ],
                Vec3::splat(0.25),
                Vec3::splat(0.4),
                GROUND,
            ),
        };
        scene.lights = Some(lights);
        scene.render_defaults.clamp = Some(STUDIO_CLAMP);
        scene.background.color = sky;
        scene.background.ambient_light = ambient;
        if framed && !self.no_ground && !self.ground {
            add_ground(scene, sides, ground);
        }
    }
}

/// Adds a matte ground plane of the given colour, which touches the lowest point of the scene.
fn add_ground(scene: &mut Scene, sides: &ModelAxes, color: Vec3) {
    let mut lowest = f64::INFINITY;
    points(scene, &mut |p| lowest = lowest.min(p.dot(sides.up)));
    if !lowest.is_finite() {
        return;
    }
    let material = PrincipledMaterial {
        base_color: color,
        specular_weight: 0.0,
        specular_roughness: 1.0,
        ..PrincipledMaterial::default()
    };
    let plane = Plane { normal: sides.up.as_vec3(), offset: lowest as f32 };
    let material = Some(scene.add_material(Material::Principled(Box::new(material))));
    let node = ObjectKind::Primitive(plane.into());
    scene.root.get_or_insert_default().objects.push(Object { node, material, span: Span::default() });
}

impl Scene {
    /// Adds a material and returns its number.
    pub fn add_material(&mut self, material: Material) -> u32 {
        self.materials.push(Spanned { value: material, span: Span::default() });
        (self.materials.len() - 1) as u32
    }
}

/// Returns the radiance of a white surface in the centre of the scene that faces its brightest
/// light.
fn light_at_center(scene: &Scene) -> f32 {
    let [least, most] = bounds(scene);
    let middle = 0.5 * (least + most);
    if !middle.is_finite() {
        return 0.0;
    }
    let light = |light: &Spanned<Light>| {
        let light = light.value.with_unit_color();
        // The beam of the light may miss the centre.
        let color = match light.inverse_square() {
            Some((position, color)) => color / position.as_dvec3().distance_squared(middle) as f32,
            None => light.illuminate(middle).color,
        };
        color.max_element()
    };
    let lights = scene.lights.iter().flatten().map(light);
    lights.filter(|light| light.is_finite()).fold(0.0, f32::max)
}

/// Returns the least and the greatest coordinates of the scene, which are infinite without objects.
fn bounds(scene: &Scene) -> [DVec3; 2] {
    let mut bounds = [DVec3::INFINITY, DVec3::NEG_INFINITY];
    points(scene, &mut |p| bounds = [bounds[0].min(p), bounds[1].max(p)]);
    bounds
}

/// Returns a point on the axis around which the camera orbits. The axis passes through the centre
/// of the bounds.
fn axis(scene: &Scene, sides: &ModelAxes) -> DVec3 {
    let [least, most] = bounds(scene);
    let middle = 0.5 * (least + most);
    if middle.is_finite() { middle.reject_from(sides.up) } else { DVec3::ZERO }
}

/// Returns the rotation about an axis by an angle in degrees.
pub fn rotation(axis: DVec3, degrees: f64) -> DMat3 {
    let (sin, cos) = fp::sin_cos_degrees(degrees);
    let (x, y, z) = (axis.x, axis.y, axis.z);
    let cross = DMat3::from_cols(DVec3::new(0.0, z, -y), DVec3::new(-z, 0.0, x), DVec3::new(y, -x, 0.0));
    DMat3::IDENTITY + cross * sin + cross * cross * (1.0 - cos)
}

/// Returns the tangent of half the field of view.
fn tan_half_angle() -> f64 {
    crate::math::fp::tan_f64(f64::from(ANGLE).to_radians() / 2.0)
}

/// Assigns a neutral material to objects that have no material.
fn assign_default_material(scene: &mut Scene) {
    fn visit(object: &mut Object, material: u32, used: &mut bool) {
        match &mut object.node {
            ObjectKind::Group(group) => group.objects.iter_mut().for_each(|object| visit(object, material, used)),
            ObjectKind::Transform(_, inner) => visit(inner, material, used),
            ObjectKind::Solid(_, parts) => parts.iter_mut().for_each(|part| visit(part, material, used)),
            _ if object.material.is_none() => {
                object.material = Some(material);
                *used = true;
            }
            _ => {}
        }
    }
    let (number, mut used) = (scene.materials.len() as u32, false);
    if let Some(Group { objects }) = &mut scene.root {
        objects.iter_mut().for_each(|object| visit(object, number, &mut used));
    }
    if used {
        let neutral = PrincipledMaterial {
            base_color: Vec3::splat(0.7),
            specular_roughness: 0.4,
            ..PrincipledMaterial::default()
        };
        scene.add_material(Material::Principled(Box::new(neutral)));
    }
}

/// Extent of the points of a model along the camera axes. The closest camera that shows all points
/// is computed from this extent.
struct VisibleExtent {
    /// Half the width and half the height of the picture at distance 1.
    slopes: [f64; 2],
    /// Maximum of p - slope z and minimum of p + slope z, for both axes of the picture.
    reach: [[f64; 2]; 2],
    low: [f64; 3],
    high: [f64; 3],
}

impl VisibleExtent {
    fn new(across: f64, upwards: f64) -> Self {
        let none = [f64::NEG_INFINITY, f64::INFINITY];
        VisibleExtent {
            slopes: [across, upwards],
            reach: [none; 2],
            low: [f64::INFINITY; 3],
            high: [f64::NEG_INFINITY; 3],
        }
    }

    fn add(&mut self, x: f64, y: f64, z: f64) {
        for (i, p) in [x, y].into_iter().enumerate() {
            let [greatest, least] = &mut self.reach[i];
            *greatest = greatest.max(p - self.slopes[i] * z);
            *least = least.min(p + self.slopes[i] * z);
        }
        for (i, p) in [x, y, z].into_iter().enumerate() {
            (self.low[i], self.high[i]) = (self.low[i].min(p), self.high[i].max(p));
        }
    }

    fn is_empty(&self) -> bool {
        self.low[0] > self.high[0]
    }

    /// Returns the position of a perspective camera. Each side plane of the frustum touches a
    /// point, and the lines x = A + s z and x = B - s z meet in the eye.
    fn perspective_eye(&self) -> [f64; 3] {
        if self.is_empty() {
            return [0.0, 0.0, -4.0];
        }
        let [x, y] = self.reach.map(|[a, b]| 0.5 * (a + b));
        let far = |i: usize| (self.reach[i][1] - self.reach[i][0]) / (2.0 * self.slopes[i]);
        let z = far(0).min(far(1));
        // Even a single point needs some distance from the camera.
        let size = (0..3).map(|i| self.high[i] - self.low[i]).fold(0.0, f64::max);
        let near = self.low[2] - z;
        [x, y, if near > 1e-6 * size && size > 0.0 { z } else { self.low[2] - size.max(1.0) }]
    }

    fn half_sizes(&self) -> [f64; 2] {
        if self.is_empty() { [1.0; 2] } else { std::array::from_fn(|i| 0.5 * (self.high[i] - self.low[i])) }
    }

    /// Returns the position of a parallel camera that is at the given distance in front of all
    /// points.
    fn orthographic_eye(&self, distance: f64) -> [f64; 3] {
        if self.is_empty() {
            return [0.0; 3];
        }
        let middle = |i: usize| 0.5 * (self.low[i] + self.high[i]);
        [middle(0), middle(1), self.low[2] - distance]
    }
}

#[cfg(test)]
mod tests;
