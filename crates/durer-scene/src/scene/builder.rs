//! Builder for scenes that are created in code, which refers to materials and meshes by handles
//! instead of names.

use super::{Background, Group, Material, MatrixOp, Object, ObjectKind, Scene, Spanned};
use crate::camera::Camera;
use crate::describe::FileName;
use crate::light::Light;
use crate::material::{HairMaterial, PhongMaterial, PrincipledMaterial};
use crate::math::Vec3;
use crate::medium::Fog;
use crate::shape::{MeshData, Primitive, TriangleMesh};
use durer_diag::{Diagnostic, Diagnostics, Span};
use std::sync::Arc;

/// Handle of a material in a [`SceneBuilder`].
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash)]
pub struct MaterialId(u32);

/// Handle of a mesh in a [`SceneBuilder`]. The mesh is stored once, and it can be added to the
/// scene any number of times.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash)]
pub struct MeshId(u32);

/// Primitive or mesh that can be added to a [`SceneBuilder`].
#[derive(Clone, Debug)]
#[non_exhaustive]
pub enum Shape {
    /// A primitive, such as a sphere, a box or a disc.
    Primitive(Primitive),
    /// A mesh that is stored in the same builder.
    Mesh(MeshId),
}

impl From<MeshId> for Shape {
    fn from(mesh: MeshId) -> Self {
        Shape::Mesh(mesh)
    }
}

impl<T: Into<Primitive>> From<T> for Shape {
    fn from(shape: T) -> Self {
        Shape::Primitive(shape.into())
    }
}

impl From<PhongMaterial> for Material {
    fn from(material: PhongMaterial) -> Self {
        Material::Phong(Box::new(material), None)
    }
}

impl From<PrincipledMaterial> for Material {
    fn from(material: PrincipledMaterial) -> Self {
        Material::Principled(Box::new(material))
    }
}

impl From<HairMaterial> for Material {
    fn from(material: HairMaterial) -> Self {
        Material::Hair(material)
    }
}

/// Builder for a scene that is created in code. Lengths can be in any unit, but they must be in
/// metres if lights are given in candela or lumens. The y axis points upwards.
///
/// ```
/// use durer_scene::camera::PerspectiveCamera;
/// use durer_scene::material::PrincipledMaterial;
/// use durer_scene::math::Vec3;
/// use durer_scene::scene::Scene;
/// use durer_scene::shape::Sphere;
///
/// let mut scene = Scene::builder();
/// scene.camera(PerspectiveCamera::look_at(Vec3::new(0.0, 0.0, 5.0), Vec3::ZERO, 30.0));
/// let red = scene.material(PrincipledMaterial { base_color: Vec3::X, ..Default::default() });
/// let triangle = scene.mesh(&[Vec3::ZERO, Vec3::X, Vec3::Y], &[[0, 1, 2]]);
/// scene.add(triangle).material(red).scale(2.0).translate(Vec3::new(1.0, 0.0, 0.0));
/// scene.add(Sphere { radius: -1.0, ..Default::default() });
/// let refused = scene.build().unwrap_err();
/// let first = refused.iter().next().unwrap();
/// assert_eq!(first.message, "Sphere: radius -1 must be more than 0");
/// ```
#[derive(Clone, Debug, Default)]
pub struct SceneBuilder {
    scene: Scene,
    objects: Vec<ObjectBuilder>,
    meshes: u32,
}

/// Object in a [`SceneBuilder`], whose material and transforms can be set.
#[derive(Clone, Debug)]
pub struct ObjectBuilder {
    node: ObjectKind,
    material: Option<MaterialId>,
    ops: Vec<MatrixOp>,
}

impl ObjectBuilder {
    /// Sets the material. Objects without a material are plain grey.
    pub fn material(&mut self, material: MaterialId) -> &mut Self {
        self.material = Some(material);
        self
    }

    /// Appends a transform that is given by a matrix.
    pub fn transform(&mut self, op: MatrixOp) -> &mut Self {
        // The first factor of a product is applied last.
        self.ops.insert(0, op);
        self
    }

    /// Appends a translation.
    pub fn translate(&mut self, by: Vec3) -> &mut Self {
        self.transform(MatrixOp::Translate(by))
    }

    /// Appends a scaling about the origin.
    pub fn scale(&mut self, factor: f32) -> &mut Self {
        self.transform(MatrixOp::UniformScale(factor))
    }

    /// Appends a rotation about an axis through the origin, by an angle in degrees. The axis can
    /// have any length, and the rotation is counter-clockwise as seen from its tip.
    pub fn rotate(&mut self, axis: Vec3, degrees: f32) -> &mut Self {
        self.transform(MatrixOp::Rotate(axis, degrees))
    }
}

impl Scene {
    /// Returns an empty builder.
    pub fn builder() -> SceneBuilder {
        SceneBuilder::default()
    }
}

impl SceneBuilder {
    /// Sets the camera.
    pub fn camera(&mut self, camera: impl Into<Camera>) -> &mut Self {
        self.scene.camera = Some(camera.into());
        self
    }

    /// Sets the background and the ambient light.
    pub fn background(&mut self, background: Background) -> &mut Self {
        self.scene.background = background;
        self
    }

    /// Sets the fog.
    pub fn fog(&mut self, fog: Fog) -> &mut Self {
        self.scene.fog = Some(Spanned { value: fog, span: Span::default() });
        self
    }

    /// Adds a light that has no extent. Emissive surfaces are defined by their material instead.
    pub fn light(&mut self, light: impl Into<Light>) -> &mut Self {
        self.scene.lights.get_or_insert_default().push(Spanned { value: light.into(), span: Span::default() });
        self
    }

    /// Adds a material that any number of objects can use.
    pub fn material(&mut self, material: impl Into<Material>) -> MaterialId {
        self.scene.materials.push(Spanned { value: material.into(), span: Span::default() });
        MaterialId(self.scene.materials.len() as u32 - 1)
    }

    /// Stores a mesh that is given by positions and triangles. A triangle consists of three
    /// position indices, counter-clockwise as seen from outside. The mesh is not visible until it
    /// is added to the scene.
    pub fn mesh(&mut self, positions: &[impl Into<Vec3> + Copy], triangles: &[[u32; 3]]) -> MeshId {
        let positions = positions.iter().map(|&position| position.into()).collect();
        self.mesh_data(MeshData { positions, triangles: triangles.to_vec(), ..MeshData::default() })
    }

    /// Stores a mesh with all its attributes, which are normals, texture coordinates and colours.
    pub fn mesh_data(&mut self, data: impl Into<Arc<MeshData>>) -> MeshId {
        let mesh = MeshId(self.meshes);
        self.scene.assets.meshes.insert(mesh.name(), data.into());
        self.meshes += 1;
        mesh
    }

    /// Adds a primitive or a mesh to the scene. The material and transforms of the object can be
    /// set on the result.
    pub fn add(&mut self, shape: impl Into<Shape>) -> &mut ObjectBuilder {
        let node = match shape.into() {
            Shape::Primitive(primitive) => ObjectKind::Primitive(primitive),
            Shape::Mesh(mesh) => {
                ObjectKind::Mesh(TriangleMesh { obj_file: FileName { path: mesh.name(), span: Span::default() } })
            }
        };
        let at = self.objects.len();
        self.objects.push(ObjectBuilder { node, material: None, ops: Vec::new() });
        &mut self.objects[at]
    }

    /// Returns the scene if it has a camera and all values are valid.
    ///
    /// # Errors
    ///
    /// Returns all errors that were found; see [`Scene::validate`].
    pub fn build(&self) -> Result<Scene, Diagnostics> {
        let mut scene = self.scene.clone();
        let object = |placed: &ObjectBuilder| {
            let material = placed.material.map(|material| material.0);
            let object = Object { node: placed.node.clone(), material, span: Span::default() };
            match placed.ops.is_empty() {
                true => object,
                false => {
                    let node = ObjectKind::Transform(placed.ops.clone(), Box::new(object));
                    Object { node, material, span: Span::default() }
                }
            }
        };
        scene.root = Some(Group { objects: self.objects.iter().map(object).collect() });
        let mut found = scene.validate();
        if scene.camera.is_none() {
            found.push(Diagnostic::error("the scene has no camera").code("no-camera"));
        }
        // A handle from another builder may refer to a mesh that this builder does not have.
        let meshes = self.objects.iter().filter_map(|placed| match &placed.node {
            ObjectKind::Mesh(mesh) => Some(&mesh.obj_file.path),
            _ => None,
        });
        if meshes.into_iter().any(|name| !scene.assets.meshes.contains_key(name)) {
            found.push(Diagnostic::error("an object uses a mesh of another builder").code("bad-value"));
        }
        if found.has_errors() { Err(found) } else { Ok(scene) }
    }
}

impl MeshId {
    /// Returns the name of the asset for this mesh, which cannot be a file name in the text of a
    /// scene.
    fn name(self) -> String {
        format!("<mesh {}>", self.0)
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::camera::PerspectiveCamera;
    use crate::scene::MatrixRules;
    use crate::shape::Sphere;

    #[test]
    fn transforms_are_applied_in_the_order_of_calls() {
        let mut scene = Scene::builder();
        scene.camera(PerspectiveCamera::default());
        scene.add(Sphere::default()).scale(2.0).translate(Vec3::X).rotate(Vec3::Y, 90.0);
        let built = scene.build().unwrap();
        let Some(Object { node: ObjectKind::Transform(ops, _), .. }) = built.root.as_ref().map(|root| &root.objects[0])
        else {
            panic!("{built:?}");
        };
        // (1, 0, 0) is scaled by 2, moved to (3, 0, 0), and rotated to (0, 0, -3).
        let map = MatrixOp::product(ops, MatrixRules::default());
        assert!((map.transform_point3(glam::DVec3::X) - glam::DVec3::new(0.0, 0.0, -3.0)).length() < 1e-12);
    }

    #[test]
    fn handles_of_another_builder_are_rejected() {
        let mut other = Scene::builder();
        let mesh = other.mesh(&[Vec3::ZERO, Vec3::X, Vec3::Y], &[[0, 1, 2]]);
        let material = other.material(PhongMaterial::default());
        let mut scene = Scene::builder();
        scene.add(mesh).material(material);
        let found: Vec<_> = scene.build().unwrap_err().iter().map(|d| d.message.clone()).collect();
        let unknown = "an object has material 0, but the scene has no materials";
        assert_eq!(found, [unknown, "the scene has no camera", "an object uses a mesh of another builder"]);
    }
}
