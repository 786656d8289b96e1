//! What a model lacks to be a scene: a camera that sees all of it, light, a ground, a material.

use super::extent::points;
use super::{Background, Group, Material, Node, Object, Scene, Spanned};
use crate::camera::{Camera, OrthographicCamera, PerspectiveCamera, Projection};
use crate::light::{DirectionalLight, Light};
use crate::material::PrincipledMaterial;
use crate::math::{Vec3, fp};
use crate::shape::plane::Plane;
use durer_diag::Span;
use glam::{DMat3, DVec3};
use std::path::PathBuf;

/// An axis of space.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Axis {
    /// The first.
    X,
    /// The second.
    Y,
    /// The third.
    Z,
}

/// Whence a model is seen that brings no camera.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub enum View {
    /// In perspective, from the front, a little from the right and from above.
    #[default]
    ThreeQuarter,
    /// From the front, without perspective.
    Front,
    /// From the right, without perspective.
    Side,
    /// From above, without perspective.
    Top,
    /// Without perspective, such that edges along all three axes look equally long.
    Iso,
}

/// The light of a model that brings none.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub enum Studio {
    /// None, and no ground.
    None,
    /// A key light from the upper left, a weaker one from the right, a light ground.
    #[default]
    Soft,
    /// A low sun under a blue sky, a light ground.
    Sun,
}

/// How a model becomes a scene.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct Staging {
    /// What is up; `None`: what is up in most models of the format.
    pub up: Option<Axis>,
    /// Whence it is seen; `None`: by its own camera, or else in a three-quarter view.
    pub view: Option<View>,
    /// The light; `None`: its own, or else a soft studio.
    pub studio: Option<Studio>,
    /// The name of the camera of the file that is wanted; `None`: the first.
    pub camera: Option<String>,
    /// The name of the look that is wanted of a glTF file with several (KHR_materials_variants);
    /// `None`: its own materials.
    pub variant: Option<String>,
    /// The moment of its animation, in seconds; `None`: as it stands without.
    pub at: Option<f32>,
    /// A file of Radiance's views, whose last is the camera.
    pub view_file: Option<PathBuf>,
    /// A picture of all directions that lights the model instead of a studio.
    pub environment: Option<PathBuf>,
    /// Whether its own camera is moved to where it sees all of the model.
    pub fit: bool,
    /// Degrees by which the camera goes around the model, counter-clockwise from above, as far away
    /// as all of it is seen from everywhere; `None`: no picture of many.
    pub turned: Option<f32>,
    /// Whether nothing is added, and nothing replaced: the scene is to be written in another
    /// format.
    pub bare: bool,
    /// Whether only its own light counts: where it has none it is dark.
    pub own_light: bool,
    /// The picture's width over its height, for a camera that sees just the whole; `None`: 1.
    pub aspect: Option<f32>,
}

/// Three axes of a model as people see it: what is to its right, up, and in front of it.
pub struct Sides {
    /// To the right of somebody who stands before it.
    pub right: DVec3,
    /// Upwards.
    pub up: DVec3,
    /// To where it looks.
    pub front: DVec3,
}

impl Sides {
    /// For an axis that is up.
    pub fn new(up: Axis) -> Self {
        let (right, up) = match up {
            Axis::X => (DVec3::NEG_Y, DVec3::X),
            Axis::Y => (DVec3::X, DVec3::Y),
            Axis::Z => (DVec3::X, DVec3::Z),
        };
        Sides { right, up, front: right.cross(up) }
    }
}

/// Field of view across the larger side of the picture, in degrees.
const ANGLE: f32 = 30.0;
/// Places of a turning model that are looked at.
const PLACES: u32 = 48;
/// Share of the picture's width or height that a model fills.
const FILLED: f64 = 0.86;

impl Staging {
    /// Adds what a scene lacks. `up` is the axis that is up in most models of its format; `dark`
    /// says that what has a camera and no lights is meant so, and that what shines needs no
    /// other light.
    pub fn complete(&self, scene: &mut Scene, up: Axis, dark: bool) {
        let sides = Sides::new(self.up.unwrap_or(up));
        let framed = scene.camera.is_none() || self.view.is_some() || self.turned.is_some();
        let lit = (dark && (scene.camera.is_some() || scene.shines()))
            || scene.lights.as_ref().is_some_and(|lights| !lights.is_empty());
        if framed {
            scene.camera = Some(self.camera(scene, &sides, self.view.unwrap_or_default()));
        } else if let (Some(pose), true) = (scene.camera.as_ref().map(Projection::pose), self.fit) {
            let [forward, up] = [pose.direction, pose.up].map(|v| v.as_dvec3().normalize_or(sides.up));
            scene.camera = Some(self.framed(scene, &sides, (-forward, up), true));
        }
        give_material(scene);
        let surrounded = self.environment.is_some() && self.studio.is_none();
        let missing = !lit && !surrounded && !self.own_light;
        let studio = self.studio.or(missing.then(Studio::default));
        if let Some(studio) = studio {
            self.light(scene, &sides, studio, framed);
        }
        // Around what has its own light it is dark, unless the file says otherwise.
        let shines = scene.shines() || scene.lights.as_ref().is_some_and(|lights| !lights.is_empty());
        if (shines || self.own_light) && scene.background == Background::default() {
            scene.background.color = Vec3::ZERO;
        }
    }

    /// A camera that sees all of a scene, in the middle of the picture.
    fn camera(&self, scene: &Scene, sides: &Sides, view: View) -> Camera {
        let &Sides { right, up, front } = sides;
        let (back, above) = match view {
            // 35 degrees to the right and 22 degrees up.
            View::ThreeQuarter => (0.927 * (0.819 * front + 0.574 * right) + 0.375 * up, up),
            View::Front => (front, up),
            View::Side => (right, up),
            View::Top => (up, -front),
            View::Iso => (front + right + up, up),
        };
        self.framed(scene, sides, (back, above), view == View::ThreeQuarter)
    }

    /// The same that looks from some side.
    fn framed(&self, scene: &Scene, sides: &Sides, (back, above): (DVec3, DVec3), perspective: bool) -> Camera {
        let forward = -back.normalize();
        let across = forward.cross(above).try_normalize().unwrap_or_else(|| forward.any_orthonormal_vector());
        let upwards = across.cross(forward);
        let aspect = f64::from(self.aspect.unwrap_or(1.0)).clamp(1e-3, 1e3);
        // Half the width and height of the picture, the larger side from -1 to 1.
        let (wide, high) = (aspect.min(1.0), (1.0 / aspect).min(1.0));
        let mut seen = Seen::new(half_angle() * FILLED * wide, half_angle() * FILLED * high);
        let mut add = |p: DVec3| seen.add(p.dot(across), p.dot(upwards), p.dot(forward));
        let axis = self.turned.map(|_| axis(scene, sides));
        match axis {
            None => points(scene, &mut add),
            // What it is in all its places.
            Some(axis) => points(scene, &mut |p| {
                (0..PLACES)
                    .for_each(|i| add(axis + turn(sides.up, 360.0 * f64::from(i) / f64::from(PLACES)) * (p - axis)));
            }),
        }
        let turned = turn(sides.up, f64::from(self.turned.unwrap_or(0.0)));
        let (direction, up) = ((turned * forward).as_vec3(), (turned * above).as_vec3());
        let middle = axis.unwrap_or_default();
        let place =
            |[x, y, z]: [f64; 3]| (middle + turned * (x * across + y * upwards + z * forward - middle)).as_vec3();
        if perspective {
            return PerspectiveCamera { center: place(seen.eye()), direction, up, angle: ANGLE }.into();
        }
        let [half_x, half_y] = seen.half_sizes();
        let size = (2.0 * (half_x / wide).max(half_y / high) / FILLED) as f32;
        let size = if size > 0.0 { size } else { 2.0 };
        let center = place(seen.before(f64::from(size)));
        OrthographicCamera { center, direction, up, size, ..Default::default() }.into()
    }

    /// Adds light, and with a camera of ours a ground.
    fn light(&self, scene: &mut Scene, sides: &Sides, studio: Studio, framed: bool) {
        if studio == Studio::None {
            scene.lights.get_or_insert_default();
            return;
        }
        let pose = scene.camera.as_ref().map(crate::camera::Projection::pose);
        let forward = pose.map_or(-sides.front, |pose| pose.direction.as_dvec3().normalize_or(-sides.front));
        // Level, so that light comes from above also where the camera looks down.
        let forward = forward.reject_from(sides.up).try_normalize().unwrap_or(-sides.front);
        let right = forward.cross(sides.up);
        let from = |x: f64, y: f64, z: f64| -(x * right + y * sides.up - z * forward).normalize().as_vec3();
        let light = |direction: Vec3, color: Vec3| Spanned {
            value: Light::from(DirectionalLight { direction, color, ..DirectionalLight::default() }),
            span: Span::default(),
        };
        let (lights, ambient, sky, ground) = match studio {
            Studio::Sun => (
                vec![light(from(-0.7, 0.75, 0.45), Vec3::new(0.95, 0.86, 0.7))],
                Vec3::new(0.2, 0.24, 0.3),
                Vec3::new(0.3, 0.5, 0.85),
                Vec3::new(0.55, 0.5, 0.42),
            ),
            // Such that a white thing is brighter than what is behind it, under paths as under
            // Whitted's light.
            _ => (
                vec![
                    light(from(-0.6, 1.0, 0.7), Vec3::splat(0.75)),
                    light(from(1.0, 0.5, 0.5), Vec3::new(0.095, 0.1, 0.11)),
                ],
                Vec3::splat(0.25),
                Vec3::splat(0.4),
                Vec3::splat(0.5),
            ),
        };
        scene.lights = Some(lights);
        scene.background.color = sky;
        scene.background.ambient_light = ambient;
        if framed {
            let mut lowest = f64::INFINITY;
            points(scene, &mut |p| lowest = lowest.min(p.dot(sides.up)));
            let material = PrincipledMaterial {
                base_color: ground,
                specular_weight: 0.0,
                specular_roughness: 1.0,
                ..PrincipledMaterial::default()
            };
            let plane = Plane { normal: sides.up.as_vec3(), offset: lowest as f32 };
            if lowest.is_finite() {
                let material = Some(scene.add_material(Material::Principled(Box::new(material))));
                let node = Node::Primitive(plane.into());
                let objects = &mut scene.root.get_or_insert_default().objects;
                objects.push(Object { node, material, span: Span::default() });
            }
        }
    }
}

impl Scene {
    /// Adds a material and gives its number.
    pub fn add_material(&mut self, material: Material) -> u32 {
        self.materials.push(Spanned { value: material, span: Span::default() });
        (self.materials.len() - 1) as u32
    }
}

/// A point of the axis about which a model turns: in the middle of its box.
fn axis(scene: &Scene, sides: &Sides) -> DVec3 {
    let (mut least, mut most) = (DVec3::INFINITY, DVec3::NEG_INFINITY);
    points(scene, &mut |p| (least, most) = (least.min(p), most.max(p)));
    let middle = 0.5 * (least + most);
    if middle.is_finite() { middle.reject_from(sides.up) } else { DVec3::ZERO }
}

/// A turn of some degrees about an axis.
fn turn(axis: DVec3, degrees: f64) -> DMat3 {
    let (sin, cos) = fp::sin_cos_degrees(degrees);
    let (x, y, z) = (axis.x, axis.y, axis.z);
    let cross = DMat3::from_cols(DVec3::new(0.0, z, -y), DVec3::new(-z, 0.0, x), DVec3::new(y, -x, 0.0));
    DMat3::IDENTITY + cross * sin + cross * cross * (1.0 - cos)
}

/// Half the field of view at distance 1.
fn half_angle() -> f64 {
    crate::math::fp::tan_f64(f64::from(ANGLE).to_radians() / 2.0)
}

/// Gives a neutral material to what has none.
fn give_material(scene: &mut Scene) {
    fn visit(object: &mut Object, material: u32, used: &mut bool) {
        match &mut object.node {
            Node::Group(group) => group.objects.iter_mut().for_each(|object| visit(object, material, used)),
            Node::Transform(_, inner) => visit(inner, material, used),
            Node::Solid(_, parts) => parts.iter_mut().for_each(|part| visit(part, material, used)),
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

/// What is seen, in the camera's axes: the least camera in front of it all.
struct Seen {
    /// Half the picture's width and height at distance 1.
    slopes: [f64; 2],
    /// For across and upwards: the greatest of p - slope z, and the least of p + slope z.
    reach: [[f64; 2]; 2],
    low: [f64; 3],
    high: [f64; 3],
}

impl Seen {
    fn new(across: f64, upwards: f64) -> Self {
        let none = [f64::NEG_INFINITY, f64::INFINITY];
        Seen { slopes: [across, upwards], reach: [none; 2], low: [f64::INFINITY; 3], high: [f64::NEG_INFINITY; 3] }
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

    /// The eye in perspective. Each side plane of the view touches a point: x = A + s z and x = B -
    /// s z meet in the eye.
    fn eye(&self) -> [f64; 3] {
        if self.is_empty() {
            return [0.0, 0.0, -4.0];
        }
        let [x, y] = self.reach.map(|[a, b]| 0.5 * (a + b));
        let far = |i: usize| (self.reach[i][1] - self.reach[i][0]) / (2.0 * self.slopes[i]);
        let z = far(0).min(far(1));
        // A single point has a picture too.
        let size = (0..3).map(|i| self.high[i] - self.low[i]).fold(0.0, f64::max);
        let near = self.low[2] - z;
        [x, y, if near > 1e-6 * size && size > 0.0 { z } else { self.low[2] - size.max(1.0) }]
    }

    fn half_sizes(&self) -> [f64; 2] {
        if self.is_empty() { [1.0; 2] } else { std::array::from_fn(|i| 0.5 * (self.high[i] - self.low[i])) }
    }

    /// The middle of the picture without perspective, at a distance before it all.
    fn before(&self, distance: f64) -> [f64; 3] {
        if self.is_empty() {
            return [0.0; 3];
        }
        let middle = |i: usize| 0.5 * (self.low[i] + self.high[i]);
        [middle(0), middle(1), self.low[2] - distance]
    }
}

#[cfg(test)]
mod tests;
