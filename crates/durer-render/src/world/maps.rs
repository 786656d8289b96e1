//! Lookup of textures and vertex colours of principled materials.

use super::material::{MaterialTextures, Principled};
use super::{Geometry, SurfaceInteraction, World};
use durer_scene::material::Parameters;
use durer_scene::material::parameters::{TEXTURE_FIELDS, TextureEffect};
use durer_scene::material::principled::{BumpGradient, NormalGreen, Switch};
use durer_scene::math::{Color, Ray, Vec2, Vec3};
use durer_scene::shape::Shape;
use durer_scene::texture::{Channel, Mapping, Texture};
use std::borrow::Cow;

impl World {
    /// Returns the parameters of a principled material at a hit after textures and vertex colours
    /// were applied. If there are no texture coordinates, textures are ignored.
    pub fn parameters_at<'a>(&self, principled: &'a Principled, at: &SurfaceInteraction) -> Cow<'a, Parameters> {
        let [r, g, b, _] = at.surface.color;
        if principled.maps.parameters.is_empty() && [r, g, b] == [1.0; 3] {
            return Cow::Borrowed(&principled.parameters);
        }
        let mut here = principled.parameters;
        here.base_color *= Vec3::new(r, g, b);
        // If a texture changes several parameters, it is looked up only once.
        let mut last: Option<(u32, [f32; 4])> = None;
        for map in &principled.maps.parameters {
            let known = last.filter(|(number, _)| *number == map.texture).map(|(_, texel)| texel);
            let Some(texel) = known.or_else(|| self.texel(Some(map.texture), at)) else { continue };
            last = Some((map.texture, texel));
            let mapping = self.textures()[map.texture as usize].mapping().copied().unwrap_or_default();
            let channel = map.channel.or(mapping.channel).unwrap_or(Channel::Red);
            match TEXTURE_FIELDS[map.row].change {
                TextureEffect::Number(change) => change(&mut here, mapping.map_to_range(channel.of(texel))),
                TextureEffect::Color(change) => {
                    let [r, g, b, _] = texel;
                    change(&mut here, Vec3::new(r, g, b).map(|x| mapping.map_to_range(x)));
                }
            }
        }
        Cow::Owned(if principled.maps.parameters.is_empty() { here } else { here.clamped() })
    }

    /// Returns the value, from 0 to 1, of a numeric texture at a hit. The value is 1 if there are
    /// no texture coordinates.
    pub fn number_at(&self, map: u32, at: &SurfaceInteraction) -> f32 {
        let Some(texel) = self.texel(Some(map), at) else { return 1.0 };
        let mapping = self.textures()[map as usize].mapping().copied().unwrap_or_default();
        mapping.map_to_range(mapping.channel.unwrap_or(Channel::Red).of(texel)).clamp(0.0, 1.0)
    }

    /// Returns the factor by which textures and vertex colours multiply the emission.
    pub(super) fn emission_at(&self, principled: &Principled, at: &SurfaceInteraction) -> Color {
        let picture = principled.maps.emission.and_then(|map| {
            let mapping = self.textures()[map as usize].mapping().copied().unwrap_or_default();
            let [r, g, b, _] = self.texel(Some(map), at)?;
            Some(Vec3::new(r, g, b).map(|x| mapping.map_to_range(x).max(0.0)))
        });
        let picture = picture.unwrap_or(Color::ONE);
        let [r, g, b, _] = at.surface.color;
        if principled.definition.emission_vertex_colors == Switch::On { picture * Color::new(r, g, b) } else { picture }
    }

    /// Returns the opacity at a hit, which is the product of the parameter, the vertex colours and
    /// the textures, or 0 or 1 if there is a cutoff.
    pub(super) fn opacity_at(&self, principled: &Principled, at: &SurfaceInteraction) -> f32 {
        let alpha = self.texel(principled.maps.base_color, at).map_or(1.0, |texel| texel[3]);
        let share = principled.maps.opacity.and_then(|map| {
            let texture = &self.textures()[map as usize];
            let usual = if texture.has_alpha() { Channel::Alpha } else { Channel::Red };
            let mapping = texture.mapping().copied().unwrap_or_default();
            let texel = mapping.channel.unwrap_or(usual).of(self.texel(Some(map), at)?);
            Some(mapping.map_to_range(texel).clamp(0.0, 1.0))
        });
        let opacity = principled.definition.opacity * at.surface.color[3] * alpha * share.unwrap_or(1.0);
        principled.definition.opacity_cutoff.map_or(opacity, |least| f32::from(u8::from(opacity >= least)))
    }

    /// Returns true if a principled material can have an opacity below 1. Vertex colours, which can
    /// lower the opacity of any material, are not considered.
    pub(super) fn is_cutout(&self, principled: &Principled) -> bool {
        principled.definition.opacity < 1.0
            || principled.definition.opacity_cutoff.is_some()
            || self.has_holes(principled)
    }

    /// Returns true if a texture controls the opacity.
    pub(super) fn has_holes(&self, principled: &Principled) -> bool {
        principled.maps.opacity.is_some()
            || principled.maps.base_color.is_some_and(|map| self.textures()[map as usize].has_alpha())
    }

    /// Returns the colour of a texture at a hit, filtered over the sample's footprint.
    fn texel(&self, map: Option<u32>, at: &SurfaceInteraction) -> Option<[f32; 4]> {
        let texture = &self.textures()[map? as usize];
        let mapping = texture.mapping().copied().unwrap_or_default();
        Some(texture.texel(&mapping, self.coordinates(texture, at)?, self.footprint_texels(texture, &mapping, at)))
    }

    /// Returns the width of the sample's footprint in texels, measured across its narrow direction.
    /// At grazing angles the footprint is longer in the other direction, which is left to
    /// supersampling.
    fn footprint_texels(&self, texture: &Texture, mapping: &Mapping, at: &SurfaceInteraction) -> f32 {
        if at.width <= 0.0 || !texture.has_levels() {
            return 0.0;
        }
        let Some([u, v]) = self.derivatives(at, mapping.second) else { return 0.0 };
        texture.texels_in(mapping, at.width / u.cross(v).length().sqrt())
    }

    /// Returns the texture coordinates at a hit from the set that a texture uses, which is the
    /// first or the second.
    fn coordinates(&self, texture: &Texture, at: &SurfaceInteraction) -> Option<Vec2> {
        let SurfaceInteraction { hit, surface, .. } = at;
        match (texture.mapping().is_some_and(|mapping| mapping.second), &self.objects()[hit.object as usize].geometry) {
            (true, Geometry::Mesh(tree)) => tree.mesh.second_uv(hit.part, surface.barycentric),
            (true, _) => None,
            (false, _) => surface.uv.get(),
        }
    }

    /// Returns the shading normal after the bump map and then the normal map were applied, or
    /// `None` if there is neither.
    pub(super) fn mapped_normal(&self, maps: &MaterialTextures, at: &SurfaceInteraction) -> Option<Vec3> {
        let bumped = maps.bump.and_then(|map| self.bumped(map, maps, at));
        let normal = bumped.unwrap_or(at.surface.n_shade);
        maps.normal.and_then(|map| self.normal_mapped(map, maps.green, at, normal)).or(bumped)
    }

    /// Applies a normal map. In the map, x points along increasing u, and y along increasing v,
    /// which is upwards in the picture, or to the left of x, seen from outside.
    fn normal_mapped(&self, map: u32, green: NormalGreen, at: &SurfaceInteraction, normal: Vec3) -> Option<Vec3> {
        let texture = &self.textures()[map as usize];
        let mapping = texture.mapping().copied().unwrap_or_default();
        let object = &self.objects()[at.hit.object as usize];
        // Do not filter the map: averaged normals would make the surface look too smooth.
        let [r, g, b, _] = texture.texel(&mapping, self.coordinates(texture, at)?, 0.0);
        let grow = match &object.geometry {
            Geometry::Mesh(tree) => {
                // Tangents in the file are given relative to the normal in object space.
                let local_normal = object.to_world.as_ref().map_or(normal, |to_world| to_world.inverse_normal(normal));
                let grow = tree.mesh.tangents(at.hit.part, at.surface.barycentric, local_normal, mapping.second)?;
                grow.map(|v| object.to_world.as_ref().map_or(v, |to_world| to_world.vector(v)))
            }
            _ => self.derivatives(at, mapping.second)?,
        };
        let [u, v] = if green == NormalGreen::Cross { grow } else { mapping.directions(grow) };
        let tangent = u.reject_from_normalized(normal).try_normalize()?;
        // Compute the vector perpendicular to normal and tangent, on the side of increasing v.
        let across = normal.cross(tangent);
        let bitangent = if green == NormalGreen::V && across.dot(v) < 0.0 { -across } else { across };
        let signed = |x: f32| 2.0 * x - 1.0;
        let (x, y) = (mapping.strength * signed(r), mapping.strength * signed(g));
        (x * tangent + y * bitangent + signed(b) * normal).try_normalize()
    }

    /// Applies a bump map.
    ///
    /// Source: James Blinn, *Simulation of Wrinkled Surfaces*, SIGGRAPH 1978; here, the gradient of
    /// the height is taken along the surface.
    fn bumped(&self, map: u32, maps: &MaterialTextures, at: &SurfaceInteraction) -> Option<Vec3> {
        let texture = &self.textures()[map as usize];
        let mapping = texture.mapping().copied().unwrap_or_default();
        let uv = self.coordinates(texture, at)?;
        let slope = match maps.bump_gradient {
            BumpGradient::Smooth => texture.slope(&mapping, uv),
            BumpGradient::Exact => texture.exact_slope(&mapping, uv),
        };
        let slope = maps.bump_height * slope;
        let [u, v] = dual(self.derivatives(at, mapping.second)?)?;
        (at.surface.n_shade - slope.x * u - slope.y * v).try_normalize()
    }

    /// Returns the derivatives of the world-space position with respect to the texture coordinates,
    /// which come from the file for a mesh and from finite differences for other shapes.
    fn derivatives(&self, at: &SurfaceInteraction, second: bool) -> Option<[Vec3; 2]> {
        let SurfaceInteraction { hit, surface, .. } = at;
        let object = &self.objects()[hit.object as usize];
        let to_world = object.to_world.as_ref();
        let moved = |v: Vec3| to_world.map_or(v, |to_world| to_world.vector(v));
        let shape = match &object.geometry {
            Geometry::Mesh(tree) => return Some(tree.mesh.derivatives(hit.part, second)?.map(moved)),
            Geometry::Primitive(shape) => shape,
            Geometry::Solid(_) => return None,
        };
        let point = to_world.map_or(surface.position, |to_world| to_world.inverse_point(surface.position));
        let normal = to_world.map_or(surface.n_geo, |to_world| to_world.inverse_normal(surface.n_geo));
        let size = shape.bounds().map_or(1.0_f32.max(point.length()), |bounds| bounds.size().max_element());
        let step = 1e-3 * size;
        let here = surface.uv.get()?;
        // Find the texture coordinates of a nearby point by tracing a ray against the normal.
        let beside = |dir: Vec3| {
            let mut ray = Ray::new(point + step * (dir + normal), -normal);
            ray.t_max = 2.0 * step;
            let crossing = shape.intersect(&ray)?;
            let uv = shape.surface(ray.at(crossing.t).as_dvec3(), &crossing).uv.get()?;
            // On a closed shape, the coordinates wrap around from 1 to 0.
            let around = |x: f32| if x.abs() > 0.5 { x - x.round() } else { x };
            Some(Vec2::new(around(uv.x - here.x), around(uv.y - here.y)) / step)
        };
        let (a, b) = normal.any_orthonormal_pair();
        let along = |dir: Vec3| match (beside(dir), beside(-dir)) {
            (Some(after), Some(before)) => Some(0.5 * (after - before)),
            (after, before) => after.or(before.map(|before| -before)),
        };
        let (along_a, along_b) = (along(a)?, along(b)?);
        let [a, b] = dual([moved(a), moved(b)])?;
        dual([along_a.x * a + along_b.x * b, along_a.y * a + along_b.y * b])
    }

    /// Returns the world-space direction of increasing u at a hit, which follows the texture
    /// coordinates of a mesh, runs around the axis of a round shape, or follows the first edge of a
    /// rectangle. For all other shapes, a horizontal direction is returned.
    pub(super) fn tangent(&self, at: &SurfaceInteraction) -> Vec3 {
        let SurfaceInteraction { hit, surface, .. } = at;
        let object = &self.objects()[hit.object as usize];
        let to_world = object.to_world.as_ref();
        let normal = to_world.map_or(surface.n_geo, |to_world| to_world.inverse_normal(surface.n_geo));
        let point = to_world.map_or(surface.position, |to_world| to_world.inverse_point(surface.position));
        let local_tangent = match &object.geometry {
            Geometry::Mesh(tree) => tree.mesh.tangents(hit.part, surface.barycentric, normal, false).map(|[u, _]| u),
            Geometry::Primitive(shape) => shape.tangent(point),
            Geometry::Solid(_) => None,
        };
        let tangent = local_tangent.filter(|u| u.cross(normal).length_squared() > 1e-12 * u.length_squared());
        let tangent = tangent.unwrap_or_else(|| Vec3::Y.cross(normal));
        to_world.map_or(tangent, |to_world| to_world.vector(tangent))
    }
}

/// Returns the dual basis of two vectors, in the plane of the vectors. The dual basis converts
/// derivatives to gradients and back.
fn dual([u, v]: [Vec3; 2]) -> Option<[Vec3; 2]> {
    let normal = u.cross(v);
    let duals = [v.cross(normal), normal.cross(u)].map(|dual| dual / normal.length_squared());
    duals.iter().all(|dual| dual.is_finite()).then_some(duals)
}

#[cfg(test)]
mod tests;
