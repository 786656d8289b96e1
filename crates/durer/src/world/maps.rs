//! What the pictures on a surface and the colours of its vertices make of a material in layers.

use super::{Geometry, Hit, World};
use crate::material::PrincipledMaterial;
use crate::math::{Vec2, Vec3};
use crate::shape::Surface;
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
    /// The numbers of a material at a hit, and the normal to shade with: on the side of the surface's own, of length 1.
    ///
    /// `surface` is the [surface](World::surface) at that hit. Where it has no texture coordinates, pictures are left out.
    pub fn layers_at(
        &self,
        layers: &PrincipledMaterial,
        maps: &Maps,
        hit: &Hit,
        surface: &Surface,
    ) -> (PrincipledMaterial, Vec3) {
        let mut here = layers.clone();
        let [r, g, b, alpha] = surface.color;
        here.base_color *= Vec3::new(r, g, b);
        here.opacity *= alpha;
        if let Some([r, g, b, alpha]) = self.texel(maps.base_color, hit, surface) {
            here.base_color *= Vec3::new(r, g, b);
            here.opacity *= alpha;
        }
        if let Some([_, roughness, metalness, _]) = self.texel(maps.metallic_roughness, hit, surface) {
            here.specular_roughness *= roughness;
            here.base_metalness *= metalness;
        }
        if let Some([r, g, b, _]) = self.texel(maps.emission, hit, surface) {
            here.emission_color *= Vec3::new(r, g, b);
        }
        (here, self.mapped_normal(maps.normal, hit, surface).unwrap_or(surface.n_shade))
    }

    /// The share of a surface that is there: the same as the opacity of [`World::layers_at`], at less cost.
    pub fn opacity_at(&self, layers: &PrincipledMaterial, maps: &Maps, hit: &Hit, surface: &Surface) -> f32 {
        let alpha = self.texel(maps.base_color, hit, surface).map_or(1.0, |texel| texel[3]);
        layers.opacity * surface.color[3] * alpha
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
            (false, _) => surface.uv,
        }
    }

    /// The normal that a normal map says: x along the direction in which the picture's u grows, y along its v upwards.
    fn mapped_normal(&self, map: Option<u32>, hit: &Hit, surface: &Surface) -> Option<Vec3> {
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
}
