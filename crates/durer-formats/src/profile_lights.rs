//! Point lights with a directional distribution, which is stored as measured light profiles: one
//! each for red, green, and blue, or only one if the three are equal.

use durer_diag::Span;
use durer_scene::describe::FileName;
use durer_scene::light::photometric::ProfileKind;
use durer_scene::light::{PhotometricLight, PhotometricProfile};
use durer_scene::math::{Color, LUMINANCE, Vec3, fp};
use durer_scene::scene::{Scene, Spanned};
use glam::{DAffine3, DVec3};
use std::sync::Arc;

/// Axes of a light profile in the light's own space: the directions of vertical angle 0, horizontal
/// angle 0, and horizontal angle 90 degrees.
#[derive(Clone, Copy)]
pub(super) struct Axes {
    pub down: Vec3,
    pub front: Vec3,
    pub side: Vec3,
}

impl Axes {
    /// Returns axes whose vertical angles start at z and whose horizontal angles turn from x
    /// towards -y. Horizontal angles of profiles increase from front towards front × down. A
    /// transform that mirrors reverses this direction, so the side is flipped.
    pub fn about_z(transform: &DAffine3) -> Axes {
        let side = if transform.matrix3.determinant() < 0.0 { Vec3::Y } else { Vec3::NEG_Y };
        Axes { down: Vec3::Z, front: Vec3::X, side }
    }

    /// Returns axes whose vertical angles start at y and whose horizontal angles turn from x
    /// towards z. See [`Axes::about_z`].
    pub fn about_y(transform: &DAffine3) -> Axes {
        let side = if transform.matrix3.determinant() < 0.0 { Vec3::NEG_Z } else { Vec3::Z };
        Axes { down: Vec3::Y, front: Vec3::X, side }
    }

    /// Returns the unit direction for a vertical and a horizontal angle in degrees.
    fn direction(&self, vertical: f32, horizontal: f32) -> Vec3 {
        let turn = |degrees: f32| fp::sin_cos_degrees(f64::from(degrees));
        let ((sin, cos), (s, c)) = (turn(vertical), turn(horizontal));
        let across = self.front * c as f32 + self.side * s as f32;
        (across * sin as f32 + self.down * cos as f32).normalize_or(self.down)
    }
}

/// Returns the end points of `count` equal steps from 0 to `last`, including 0 and `last`.
pub(super) fn steps(last: f32, count: u32) -> Vec<f32> {
    (0..=count).map(|i| last * i as f32 / count as f32).collect()
}

/// Measured light profiles, each with a colour, that form one coloured point light together.
pub(super) struct ProfileLight(Vec<(Vec3, PhotometricProfile)>);

impl ProfileLight {
    /// Samples the intensity `light`, which is a function of the direction in the light's own
    /// space, at vertical and horizontal angles in degrees.
    pub fn new([vertical, horizontal]: [Vec<f32>; 2], axes: &Axes, light: impl Fn(Vec3) -> Color) -> ProfileLight {
        let mut values = Vec::with_capacity(vertical.len() * horizontal.len());
        for &across in &horizontal {
            values.extend(vertical.iter().map(|&down| light(axes.direction(down, across)).max(Color::ZERO)));
        }
        let emitter = |part: &dyn Fn(&Color) -> f32| PhotometricProfile {
            kind: ProfileKind::C,
            vertical: vertical.clone(),
            horizontal: horizontal.clone(),
            candela: values.iter().map(part).collect(),
        };
        let grey = values.iter().all(|value| value.x == value.y && value.y == value.z);
        ProfileLight(match grey {
            true => vec![(Vec3::ONE, emitter(&|value| value.x))],
            false => vec![
                (Vec3::X, emitter(&|value| value.x)),
                (Vec3::Y, emitter(&|value| value.y)),
                (Vec3::Z, emitter(&|value| value.z)),
            ],
        })
    }

    /// Returns the total luminous flux of all the profiles.
    pub fn flux(&self) -> f32 {
        let flux: f64 = self.0.iter().map(|(hue, light)| f64::from(hue.dot(LUMINANCE)) * light.flux()).sum();
        flux as f32
    }

    /// Adds the lights to the scene of a file; `color` is the intensity for a profile value of 1.
    pub fn add(self, scene: &mut Scene, file: &str, (transform, axes): (DAffine3, Axes), color: Color, at: Span) {
        let axis = |local: Vec3| transform.transform_vector3(local.as_dvec3()).normalize_or(DVec3::Y).as_vec3();
        for (hue, profile) in self.0 {
            let path = format!("{file}#lamp-{}.ies", scene.assets.profiles.len());
            scene.assets.profiles.insert(path.clone(), Arc::new(profile));
            let value = PhotometricLight {
                position: transform.translation.as_vec3(),
                file: FileName { path, span: at },
                direction: axis(axes.down),
                front: axis(axes.front),
                color: hue * color,
                ..PhotometricLight::default()
            };
            scene.lights.get_or_insert_default().push(Spanned { value: value.into(), span: at });
        }
    }
}
