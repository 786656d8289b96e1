//! Common imports for programs that render: `use durer::prelude::*`.

pub use crate::compiled::{CompileScene, CompiledScene};
pub use crate::error::{Error, SceneError};
pub use crate::job::RenderJob;
#[cfg(feature = "fs")]
pub use crate::open;
pub use crate::renderer::{Canceller, Picture, Renderer};
pub use durer_render::render::{Control, Progress};
pub use durer_scene::camera::{OrthographicCamera, PerspectiveCamera, ThinLensCamera};
pub use durer_scene::light::{DirectionalLight, PhotometricLight, PointLight, SpotLight};
pub use durer_scene::material::{HairMaterial, PhongMaterial, PrincipledMaterial};
pub use durer_scene::math::{Color, Ray, Vec2, Vec3};
pub use durer_scene::scene::{Background, MaterialId, MatrixOp, MeshId, Scene, SceneBuilder};
pub use durer_scene::shape::{
    Cone, Cuboid, Cylinder, Disc, Ellipsoid, MeshData, Plane, Quadric, Rectangle, Sphere, Torus, Triangle,
};

/// Creates a colour from linear components with sRGB primaries.
pub fn rgb(red: f32, green: f32, blue: f32) -> Color {
    Color::new(red, green, blue)
}

/// Creates a point or vector.
pub fn vec3(x: f32, y: f32, z: f32) -> Vec3 {
    Vec3::new(x, y, z)
}
