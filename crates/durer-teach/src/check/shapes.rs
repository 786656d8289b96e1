//! Properties of objects and lights that several checks ask for.

use durer_render::world::{Geometry, Object};
use durer_scene::light::{Light, PointLight, SpotLight};
use durer_scene::math::Vec3;
use durer_scene::shape::{Plane, Primitive, Shape as _};

/// The shape of an object of one part.
pub(super) fn shape(object: &Object) -> Option<&Primitive> {
    match &object.geometry {
        Geometry::Primitive(shape) => Some(shape),
        Geometry::Mesh(_) | Geometry::Solid(_) => None,
    }
}

/// The plane without end that an object is, in object space.
pub(super) fn plane(object: &Object) -> Option<&Plane> {
    shape(object)?.plane()
}

/// The corners of an object that is a single triangle, in object space.
pub(super) fn triangle(object: &Object) -> Option<[Vec3; 3]> {
    let polygons = shape(object)?.polygons();
    let [polygon] = &polygons[..] else { return None };
    <[Vec3; 3]>::try_from(&polygon[..]).ok()
}

/// Whether an object is a ball, whose place and size are judged by its center and radius.
pub(super) fn is_ball(object: &Object) -> bool {
    match shape(object) {
        Some(Primitive::Sphere(_)) => true,
        None
        | Some(
            Primitive::Plane(_)
            | Primitive::Triangle(_)
            | Primitive::Cuboid(_)
            | Primitive::Cylinder(_)
            | Primitive::Cone(_)
            | Primitive::Torus(_)
            | Primitive::Ellipsoid(_)
            | Primitive::Quadric(_)
            | Primitive::Disc(_)
            | Primitive::Rectangle(_),
        ) => false,
    }
}

/// The light whose fading with distance the scene file states.
pub(super) fn point(light: &Light) -> Option<&PointLight> {
    match light {
        Light::Point(point) => Some(point),
        Light::Directional(_) | Light::Spot(_) | Light::Photometric(_) => None,
    }
}

/// The light whose cone the scene file states.
pub(super) fn spot(light: &Light) -> Option<&SpotLight> {
    match light {
        Light::Spot(spot) => Some(spot),
        Light::Directional(_) | Light::Point(_) | Light::Photometric(_) => None,
    }
}
