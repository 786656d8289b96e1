//! What the pictures on a surface and the colours of its vertices make of a material in layers.

use super::{Geometry, Hit, Principled, World};
use crate::bsdf::Layers;
use crate::math::{Color, Vec2, Vec3};
use crate::shape::{Primitive, Surface};
use crate::texture::Texture;

/// The pictures of a material in layers, by their numbers in [`World::textures`].
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct Maps {
    /// Multiplies the base colour; its alpha multiplies the opacity.
    pub base_color: Option<u32>,
    /// Green multiplies the roughness, blue the metalness.
    pub metallic_roughness: Option<u32>,
    /// Multiplies the colour of emission.
    pub emission: Option<u32>,
    /// Normals in tangent space.
    pub normal: Option<u32>,
}

impl World {
    /// What of a material in layers differs from point to point.
    ///
    /// `surface` is the [surface](World::surface) at that hit. Where it has no texture coordinates, pictures are left out.
    pub fn layers_at(&self, own: &Principled, hit: &Hit, surface: &Surface) -> Layers {
        let mut here = own.layers;
        let [r, g, b, _] = surface.color;
        here.base_color *= Vec3::new(r, g, b);
        if let Some([r, g, b, _]) = self.texel(own.maps.base_color, hit, surface) {
            here.base_color *= Vec3::new(r, g, b);
        }
        if let Some([_, roughness, metalness, _]) = self.texel(own.maps.metallic_roughness, hit, surface) {
            here.roughness *= roughness;
            here.metalness *= metalness;
        }
        here
    }

    /// What a picture makes of a surface's own light.
    pub(super) fn emission_at(&self, own: &Principled, hit: &Hit, surface: &Surface) -> Color {
        self.texel(own.maps.emission, hit, surface).map_or(Color::ONE, |[r, g, b, _]| Color::new(r, g, b))
    }

    /// The share of a surface that is there, by number, vertices and picture.
    pub(super) fn opacity_at(&self, own: &Principled, hit: &Hit, surface: &Surface) -> f32 {
        let alpha = self.texel(own.maps.base_color, hit, surface).map_or(1.0, |texel| texel[3]);
        own.written.opacity * surface.color[3] * alpha
    }

    /// Whether a material in layers may be there in part only. Vertices may say so of any.
    pub(super) fn is_cutout(&self, own: &Principled) -> bool {
        own.written.opacity < 1.0 || own.maps.base_color.is_some_and(|map| self.textures[map as usize].has_alpha())
    }

    fn texel(&self, map: Option<u32>, hit: &Hit, surface: &Surface) -> Option<[f32; 4]> {
        let texture = &self.textures[map? as usize];
        let mapping = texture.mapping().copied().unwrap_or_default();
        Some(texture.texel(&mapping, self.coordinates(texture, hit, surface)?))
    }

    /// The texture coordinates of a hit that count for a texture.
    fn coordinates(&self, texture: &Texture, hit: &Hit, surface: &Surface) -> Option<Vec2> {
        match (texture.mapping().is_some_and(|mapping| mapping.second), &self.objects[hit.object as usize].geometry) {
            (true, Geometry::Mesh(tree)) => tree.mesh.second_uv(hit.part, surface.barycentric),
            (true, _) => None,
            (false, _) => surface.uv.get(),
        }
    }

    /// The normal that a normal map says: x along the direction in which the picture's u grows, y along its v upwards.
    pub(super) fn mapped_normal(&self, map: Option<u32>, hit: &Hit, surface: &Surface) -> Option<Vec3> {
        let texture = &self.textures[map? as usize];
        let mapping = texture.mapping().copied().unwrap_or_default();
        let object = &self.objects[hit.object as usize];
        let Geometry::Mesh(tree) = &object.geometry else { return None };
        let [r, g, b, _] = texture.texel(&mapping, self.coordinates(texture, hit, surface)?);
        // The tangents of the file are given about the object's own normal.
        let normal = surface.n_shade;
        let own = object.to_world.as_ref().map_or(normal, |to_world| to_world.local_normal(normal));
        let grow = tree.mesh.tangents(hit.part, surface.barycentric, own, mapping.second)?;
        let grow = grow.map(|v| object.to_world.as_ref().map_or(v, |to_world| to_world.vector(v)));
        let [u, v] = mapping.directions(grow);
        let tangent = u.reject_from_normalized(normal).try_normalize()?;
        // Perpendicular, on the side to which v grows.
        let across = normal.cross(tangent);
        let bitangent = if across.dot(v) < 0.0 { -across } else { across };
        let signed = |x: f32| 2.0 * x - 1.0;
        let (x, y) = (mapping.strength * signed(r), mapping.strength * signed(g));
        (x * tangent + y * bitangent + signed(b) * normal).try_normalize()
    }

    /// The direction of the world in which u grows at a hit: that of the texture coordinates of a mesh, the way around the axis of
    /// what is round, the first edge of a rectangle; else the horizontal one.
    pub(super) fn tangent(&self, hit: &Hit, surface: &Surface) -> Vec3 {
        let object = &self.objects[hit.object as usize];
        let to_world = object.to_world.as_ref();
        let normal = to_world.map_or(surface.n_geo, |to_world| to_world.local_normal(surface.n_geo));
        let point = to_world.map_or(surface.position, |to_world| to_world.inverse_point(surface.position));
        let around = |axis: Vec3, center: Vec3| Some(axis.cross(point - center));
        let own = match &object.geometry {
            Geometry::Mesh(tree) => tree.mesh.tangents(hit.part, surface.barycentric, normal, false).map(|[u, _]| u),
            Geometry::Primitive(Primitive::Sphere(s)) => around(Vec3::Y, s.center),
            Geometry::Primitive(Primitive::Ellipsoid(s)) => around(Vec3::Y, s.center),
            Geometry::Primitive(Primitive::Cylinder(s)) => around(s.top - s.base, s.base),
            Geometry::Primitive(Primitive::Cone(s)) => around(s.top - s.base, s.base),
            Geometry::Primitive(Primitive::Torus(s)) => around(s.axis, s.center),
            Geometry::Primitive(Primitive::Disc(s)) => around(s.normal, s.center),
            Geometry::Primitive(Primitive::Rectangle(s)) => Some(s.edge0),
            _ => None,
        };
        let own = own.filter(|u| u.cross(normal).length_squared() > 1e-12 * u.length_squared());
        let own = own.unwrap_or_else(|| Vec3::Y.cross(normal));
        to_world.map_or(own, |to_world| to_world.vector(own))
    }
}
