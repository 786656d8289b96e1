//! Tests the messages that are reported for scenes that are built in code and have invalid values.

use super::*;
use crate::camera::PerspectiveCamera;
use crate::camera::cave::CaveCamera;
use crate::light::{PointLight, SpotLight};
use crate::material::checkerboard::Checkerboard;
use crate::material::{PhongMaterial, PrincipledMaterial};
use crate::math::Vec3;
use crate::scene::{PictureBytes, TextureImage};
use crate::shape::{Cuboid, HeightField, MeshData, Plane, Primitive, Sphere, VoxelGrid};
use crate::texture::Mapping;
use std::sync::Arc;

fn messages(scene: &Scene) -> Vec<String> {
    scene.validate().iter().map(|d| d.message.clone()).collect()
}

fn bare<T>(value: T) -> Spanned<T> {
    Spanned { value, span: Span::default() }
}

fn object(node: ObjectKind) -> Object {
    Object { node, material: None, span: Span::default() }
}

fn with_node(node: ObjectKind) -> Scene {
    Scene { root: Some(Group { objects: vec![object(node)] }), ..Scene::default() }
}

fn with_shape(shape: impl Into<Primitive>) -> Scene {
    with_node(ObjectKind::Primitive(shape.into()))
}

fn with_materials(materials: Vec<Material>) -> Scene {
    Scene { materials: materials.into_iter().map(bare).collect(), ..Scene::default() }
}

#[test]
fn invalid_value_is_reported_with_object_and_field() {
    let sphere = |radius| with_shape(Sphere { radius, ..Sphere::default() });
    assert_eq!(messages(&sphere(1.0)), [""; 0]);
    assert_eq!(messages(&sphere(-1.0)), ["Sphere: radius -1 must be more than 0"]);
    assert_eq!(messages(&sphere(f32::NAN)), ["Sphere: radius NaN must be finite"]);
    assert_eq!(messages(&sphere(f32::INFINITY)), ["Sphere: radius inf must be finite"]);
    let plane = Plane { normal: Vec3::ZERO, ..Plane::default() };
    assert_eq!(messages(&with_shape(plane)), ["Plane: normal 0 0 0 must not be 0 0 0"]);
    let layers = PrincipledMaterial {
        base_color: Vec3::splat(9.0),
        specular_roughness: -3.0,
        specular_ior: f32::NAN,
        ..PrincipledMaterial::default()
    };
    let found = messages(&with_materials(vec![layers.into()]));
    let expected = ["specular_roughness -3 must be from 0 to 1", "specular_ior NaN must be finite"];
    assert_eq!(found, expected.map(|text| format!("PrincipledMaterial: {text}")));
    let camera = PerspectiveCamera { angle: 180.0, ..PerspectiveCamera::default() };
    let found = messages(&Scene { camera: Some(camera.into()), ..Scene::default() });
    assert_eq!(found, ["PerspectiveCamera: angle 180 must be more than 0 and less than 180"]);
    let background = Background { color: Vec3::new(0.0, f32::NAN, 0.0), ..Background::default() };
    let fog = Some(bare(Fog { extinction: 0.0, ..Fog::default() }));
    let found = messages(&Scene { background, fog, ..Scene::default() });
    assert_eq!(found, ["Background: color 0 NaN 0 must be finite", "Fog: extinction 0 must be more than 0"]);
}

#[test]
fn fields_are_checked_in_combination_if_each_is_valid() {
    let upside_down = Cuboid { min: Vec3::ONE, max: Vec3::ZERO };
    assert_eq!(messages(&with_shape(upside_down)), ["`min` of a `Box` must be less than its `max` in x, y and z"]);
    let camera = |camera: CaveCamera| messages(&Scene { camera: Some(camera.into()), ..Scene::default() });
    assert_eq!(camera(CaveCamera::default()), [""; 0]);
    // Walls are checked only if all numbers are finite.
    let walls = vec![[f32::NAN; 9]];
    assert_eq!(camera(CaveCamera { walls, ..CaveCamera::default() }), ["CaveCamera: walls must be finite"]);
    let light = PointLight { candela: Some(1.0), lumens: Some(1.0), ..PointLight::default() };
    let spot = SpotLight { angle: 0.0, ..SpotLight::default() };
    let found = messages(&Scene { lights: Some(vec![bare(light.into()), bare(spot.into())]), ..Scene::default() });
    assert!(found.len() == 2 && found[0].contains("`candela` and `lumens`"), "{found:?}");
    assert_eq!(found[1], "SpotLight: angle 0 must be more than 0 and at most 180");
    let fog = |min, max| messages(&Scene { fog: Some(bare(Fog { min, max, ..Fog::default() })), ..Scene::default() });
    assert_eq!(fog(Some(Vec3::ZERO), Some(Vec3::ONE)), [""; 0]);
    assert_eq!(fog(Some(Vec3::ZERO), None), ["a box of fog needs both `min` and `max`"]);
    assert!(fog(Some(Vec3::ONE), Some(Vec3::ZERO))[0].contains("the fog's `max`"));
    let background = Background { cie_sky: Some(12), ..Background::default() };
    assert!(messages(&Scene { background, ..Scene::default() })[0].contains("this `cieSky`"));
    let flat = ObjectKind::HeightField(HeightField { max: Vec3::splat(-1.0), ..HeightField::default() });
    assert!(messages(&with_node(flat))[0].contains("`min` of a `HeightField`"));
    let grid = VoxelGrid { max: Vec3::splat(-1.0), ..VoxelGrid::default() };
    let ball = Sphere { radius: 0.0, ..Sphere::default() };
    let found = messages(&with_node(ObjectKind::Voxels(grid, vec![ball])));
    assert!(found.len() == 2 && found[0].contains("the grid's `max`"), "{found:?}");
}

#[test]
fn material_indices_must_exist_except_for_objects_of_files() {
    let scene = |span| {
        let mut scene = with_shape(Sphere::default());
        scene.materials.push(bare(PhongMaterial::default().into()));
        for object in scene.root.iter_mut().flat_map(|root| &mut root.objects) {
            (object.material, object.span) = (Some(7), span);
        }
        scene
    };
    assert_eq!(messages(&scene(Span::default())), ["an object has material 7, but the scene has only material 0"]);
    assert_eq!(messages(&scene(Span { file: 0, start: 3, end: 9 })), [""; 0]);
    let board = |material1, material2| Material::Solid(Checkerboard { material1, material2 }.into(), Vec::new());
    let plain = || Material::from(PhongMaterial::default());
    assert_eq!(messages(&with_materials(vec![plain(), board(0, 0)])), [""; 0]);
    assert_eq!(
        messages(&with_materials(vec![plain(), board(0, 1)])),
        ["a solid material can only use materials that precede it"]
    );
}

#[test]
fn transforms_must_be_finite_and_nesting_bounded() {
    let moved = |op, inner| ObjectKind::Transform(vec![op], Box::new(object(inner)));
    let nested = |levels: usize| {
        let innermost = ObjectKind::Primitive(Sphere::default().into());
        (1..levels).fold(innermost, |inner, _| moved(MatrixOp::UniformScale(1.0), inner))
    };
    assert_eq!(messages(&with_node(nested(MAX_NESTING))), [""; 0]);
    assert_eq!(messages(&with_node(nested(MAX_NESTING + 1))), ["objects are nested more than 640 levels deep"]);
    for op in [MatrixOp::XRotate(f32::NAN), MatrixOp::Translate(Vec3::INFINITY), MatrixOp::Rotate(Vec3::NAN, 0.0)] {
        let found = messages(&with_node(moved(op, ObjectKind::Group(Group::default()))));
        assert_eq!(found, ["the numbers of a transform must be finite"], "{op:?}");
    }
}

#[test]
fn lists_of_meshes_and_mappings_of_pictures_are_checked() {
    let triangle = || MeshData {
        positions: vec![Vec3::ZERO, Vec3::X, Vec3::Y],
        triangles: vec![[0, 1, 2]],
        ..MeshData::default()
    };
    let found = |data: MeshData| {
        let mut scene = Scene::default();
        scene.add_mesh("m", Arc::new(data), Span::default());
        messages(&scene)
    };
    assert_eq!(found(triangle()), [""; 0]);
    let wrong = "mesh `m`: `triangles` has an index of 3 or more, but the mesh has only 3 positions";
    assert_eq!(found(MeshData { triangles: vec![[0, 1, 3]], ..triangle() }), [wrong]);
    assert_eq!(found(MeshData { positions: vec![Vec3::NAN; 3], ..triangle() }), ["mesh `m`: positions must be finite"]);
    let uvs = MeshData { triangle_uvs: vec![[0, 1, 2]; 2], ..triangle() };
    assert_eq!(found(uvs), ["mesh `m`: `triangle_uvs` has 2 entries for 1 triangles"]);
    let normals = MeshData { triangle_normals: vec![[0, 0, 0]], ..triangle() };
    let wrong = "mesh `m`: `triangle_normals` has an index of 0 or more, but there are only 0 values";
    assert_eq!(found(normals), [wrong]);
    let colors = MeshData { colors: vec![[1.0; 4]], ..triangle() };
    assert_eq!(found(colors), ["mesh `m`: `colors` has 1 entries for 3 positions"]);
    let mapping = Mapping { strength: f32::NAN, ..Mapping::default() };
    let picture = TextureImage { bytes: PictureBytes::Memory("p.png".into(), Arc::new([])), mapping };
    let mut scene = Scene::default();
    scene.assets.pictures.insert("p".into(), picture);
    assert_eq!(messages(&scene), ["Texture: normal_scale NaN must be finite"]);
}
