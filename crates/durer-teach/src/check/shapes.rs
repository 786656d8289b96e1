//! Properties of objects, lights and textures that several checks use.

use durer_render::world::{Geometry, Object};
use durer_scene::light::{Light, PointLight, SpotLight};
use durer_scene::math::{Vec3, fp};
use durer_scene::shape::{Plane, Primitive, Shape as _};
use durer_scene::texture::Texture;

/// Returns the shape of an object if it is a single primitive.
pub(super) fn shape(object: &Object) -> Option<&Primitive> {
    match &object.geometry {
        Geometry::Primitive(shape) => Some(shape),
        Geometry::Mesh(_) | Geometry::Solid(_) => None,
    }
}

/// Returns the infinite plane of an object, in object space.
pub(super) fn plane(object: &Object) -> Option<&Plane> {
    shape(object)?.plane()
}

/// Returns the corners of an object that is a single triangle, in object space.
pub(super) fn triangle(object: &Object) -> Option<[Vec3; 3]> {
    let polygons = shape(object)?.polygons();
    let [polygon] = &polygons[..] else { return None };
    <[Vec3; 3]>::try_from(&polygon[..]).ok()
}

/// Returns true if an object is a ball whose `center` and `radius` give its position and size.
pub(super) fn is_ball(object: &Object) -> bool {
    matches!(shape(object), Some(Primitive::Sphere(_)))
}

/// Returns a light if it is a point light. Only point lights have attenuation in the scene file.
pub(super) fn point(light: &Light) -> Option<&PointLight> {
    if let Light::Point(point) = light { Some(point) } else { None }
}

/// Returns a light if it is a spotlight. Only spotlights have a cone in the scene file.
pub(super) fn spot(light: &Light) -> Option<&SpotLight> {
    if let Light::Spot(spot) = light { Some(spot) } else { None }
}

/// Returns direction `i` of `count` directions that are spread evenly over the sphere. Each is
/// turned by the golden angle from the one before.
pub(super) fn spread_direction(i: u32, count: u32) -> Vec3 {
    let (sin, cos) = fp::sin_cos_degrees(f64::from(i) * 137.508);
    let z = 1.0 - 2.0 * (f64::from(i) + 0.5) / f64::from(count);
    let r = (1.0 - z * z).sqrt();
    Vec3::new((r * cos) as f32, (r * sin) as f32, z as f32)
}

/// Returns true if all texels of a texture are black.
pub(super) fn is_black(texture: &Texture) -> bool {
    texture.all_texels(|texel| texel == [0.0; 3])
}
