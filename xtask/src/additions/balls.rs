//! Example of a scene format: `.balls` has four numbers per line, centre and radius of a sphere.

use super::model::{ReadInput, SceneFormat};
use durer_diag::{Diagnostic, Diagnostics, Span};
use durer_scene::math::Vec3;
use durer_scene::scene::{Axis, Group, Object, ObjectKind, Scene};
use durer_scene::shape::Sphere;

/// Scene format of `.balls` files.
pub(super) const FORMAT: SceneFormat = SceneFormat {
    name: "Balls",
    extensions: &["balls"],
    recognise: |_| false,
    read,
    write: None,
    up: Axis::Y,
    is_complete_scene: false,
    light_hint: None,
};

fn read(input: &ReadInput, diagnostics: &mut Diagnostics) -> Option<Scene> {
    let text = String::from_utf8_lossy(input.bytes);
    let numbers: Option<Vec<f32>> = text.split_whitespace().map(|word| word.parse().ok()).collect();
    let Some(numbers) = numbers.filter(|numbers| numbers.len().is_multiple_of(4)) else {
        diagnostics.push(Diagnostic::error("expected four numbers a line").at(Span { file: input.file, ..Span::default() }));
        return None;
    };
    let ball = |ball: &[f32]| Object {
        node: ObjectKind::Primitive(Sphere { center: Vec3::from_slice(ball), radius: ball[3] }.into()),
        material: None,
        span: Span::default(),
    };
    Some(Scene { root: Some(Group { objects: numbers.chunks_exact(4).map(ball).collect() }), ..Scene::default() })
}
