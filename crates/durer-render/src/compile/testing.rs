//! Helpers that compile worlds for tests. They are also used by other crates.

use super::*;
use crate::world::World;
use durer_formats::Decoder;
use durer_formats::course::{self, ReadOptions};
use durer_formats::folder::FolderSource;
use durer_scene::dialect::Dialect;
use durer_scene::shape::Primitive;
use glam::DAffine3;
use std::cell::RefCell;
use std::path::Path;

/// Compiles the text of a scene. Returns the world and the diagnostics.
pub fn try_read(text: &str, rules: &DialectRules, accel: AccelKind, folder: &Path) -> (Option<World>, Diagnostics) {
    let mut files = Files::default();
    let file = files.add("scene.txt", text.as_bytes().into());
    let mut diagnostics = Diagnostics::default();
    let options = ReadOptions { dialect: Dialect::Durer, strict: false, compat: 0 };
    let source = FolderSource::new(folder);
    let included = RefCell::new(std::mem::take(&mut files));
    let scene =
        course::read_with(text.as_bytes(), file, options, &course::open_below(&source, &included), &mut diagnostics);
    files = included.into_inner();
    let resources = Resources::new(&source, &Decoder, &mut files);
    let world = scene.and_then(|scene| compile(&scene, rules, accel, resources, &mut diagnostics));
    (world, diagnostics)
}

/// Compiles the text of a scene with the rules of Dürer's own dialect.
pub fn read(text: &str) -> World {
    let (world, diagnostics) = try_read(text, Dialect::Durer.rules(), AccelKind::Bvh, Path::new("."));
    world.unwrap_or_else(|| panic!("{diagnostics:?}"))
}

/// Returns a transform in the syntax of a scene file.
pub fn matrix_words(affine: &DAffine3) -> String {
    let rows = glam::DMat4::from(*affine).transpose().to_cols_array();
    let words: Vec<String> = rows.iter().map(|x| format!("{:?}", *x as f32)).collect();
    format!("Matrix {{ {} }}", words.join(" "))
}

/// Compiles a world with one object. File names are relative to `folder`.
pub fn object(object: scene::Object, accel: AccelKind, folder: &Path) -> World {
    let root = Group { objects: vec![object] };
    let camera = Some(durer_scene::camera::PerspectiveCamera::default().into());
    let scene = Scene { camera, root: Some(root), ..Scene::default() };
    let (mut files, source, mut diagnostics) = (Files::default(), FolderSource::new(folder), Diagnostics::default());
    let resources = Resources::new(&source, &Decoder, &mut files);
    let world = compile(&scene, Dialect::Durer.rules(), accel, resources, &mut diagnostics);
    world.unwrap_or_else(|| panic!("{diagnostics:?}"))
}

/// Compiles a world of shapes with one transform each.
pub fn shapes(shapes: &[(Primitive, DAffine3)], accel: AccelKind) -> World {
    let object = |node| scene::Object { node, material: None, span: Default::default() };
    let moved = |(shape, affine): &(Primitive, DAffine3)| {
        let shape = object(ObjectKind::Primitive(shape.clone()));
        let rows = glam::DMat4::from(*affine).transpose().to_cols_array().map(|x| x as f32);
        object(ObjectKind::Transform(vec![MatrixOp::Matrix(rows)], Box::new(shape)))
    };
    let root = Group { objects: shapes.iter().map(moved).collect() };
    let camera = Some(durer_scene::camera::PerspectiveCamera::default().into());
    let scene = Scene { camera, root: Some(root), ..Scene::default() };
    let (mut files, source, mut diagnostics) = (Files::default(), FolderSource::new("."), Diagnostics::default());
    let resources = Resources::new(&source, &Decoder, &mut files);
    let world = compile(&scene, Dialect::Durer.rules(), accel, resources, &mut diagnostics);
    world.unwrap_or_else(|| panic!("{diagnostics:?}"))
}
