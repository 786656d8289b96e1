//! What the pictures on a surface and the colours of its vertices make of a material in layers.

use super::material::{Maps, Principled};
use super::{Geometry, Interaction, World};
use durer_scene::material::Parameters;
use durer_scene::material::parameters::{Change, TEXTURED};
use durer_scene::material::principled::Switch;
use durer_scene::math::{Color, Ray, Vec2, Vec3};
use durer_scene::shape::Shape;
use durer_scene::texture::{Channel, Mapping, Texture};
use std::borrow::Cow;

impl World {
    /// The parameters of a material in layers at a hit. Where the surface has no texture
    /// coordinates, pictures are left out.
    pub fn parameters_at<'a>(&self, own: &'a Principled, at: &Interaction) -> Cow<'a, Parameters> {
        let [r, g, b, _] = at.surface.color;
        if own.maps.parameters.is_empty() && [r, g, b] == [1.0; 3] {
            return Cow::Borrowed(&own.parameters);
        }
        let mut here = own.parameters;
        here.base_color *= Vec3::new(r, g, b);
        // Pictures that change several parameters are looked up once.
        let mut last: Option<(u32, [f32; 4])> = None;
        for map in &own.maps.parameters {
            let known = last.filter(|(number, _)| *number == map.texture).map(|(_, texel)| texel);
            let Some(texel) = known.or_else(|| self.texel(Some(map.texture), at)) else { continue };
            last = Some((map.texture, texel));
            let mapping = self.textures()[map.texture as usize].mapping().copied().unwrap_or_default();
            let channel = map.channel.or(mapping.channel).unwrap_or(Channel::Red);
            match TEXTURED[map.row].change {
                Change::Number(change) => change(&mut here, mapping.ranged(channel.of(texel))),
                Change::Color(change) => {
                    let [r, g, b, _] = texel;
                    change(&mut here, Vec3::new(r, g, b).map(|x| mapping.ranged(x)));
                }
            }
        }
        Cow::Owned(if own.maps.parameters.is_empty() { here } else { here.within_bounds() })
    }

    /// The number from 0 to 1 that a picture has at a hit; 1 where it has no coordinates.
    pub(super) fn number_at(&self, map: u32, at: &Interaction) -> f32 {
        let Some(texel) = self.texel(Some(map), at) else { return 1.0 };
        let mapping = self.textures()[map as usize].mapping().copied().unwrap_or_default();
        mapping.ranged(mapping.channel.unwrap_or(Channel::Red).of(texel)).clamp(0.0, 1.0)
    }

    /// What a picture makes of a surface's own light.
    pub(super) fn emission_at(&self, own: &Principled, at: &Interaction) -> Color {
        let picture = self.texel(own.maps.emission, at).map_or(Color::ONE, |[r, g, b, _]| Color::new(r, g, b));
        let [r, g, b, _] = at.surface.color;
        if own.written.emission_vertex_colors == Switch::On { picture * Color::new(r, g, b) } else { picture }
    }

    /// The share of a surface that is there, by number, vertices and picture.
    pub(super) fn opacity_at(&self, own: &Principled, at: &Interaction) -> f32 {
        let alpha = self.texel(own.maps.base_color, at).map_or(1.0, |texel| texel[3]);
        let share = own.maps.opacity.and_then(|map| {
            let texture = &self.textures()[map as usize];
            let usual = if texture.has_alpha() { Channel::Alpha } else { Channel::Red };
            let channel = texture.mapping().and_then(|mapping| mapping.channel).unwrap_or(usual);
            Some(channel.of(self.texel(Some(map), at)?))
        });
        let opacity = own.written.opacity * at.surface.color[3] * alpha * share.unwrap_or(1.0);
        own.written.opacity_cutoff.map_or(opacity, |least| f32::from(u8::from(opacity >= least)))
    }

    /// Whether a material in layers may be there in part only. Vertices may say so of any.
    pub(super) fn is_cutout(&self, own: &Principled) -> bool {
        own.written.opacity < 1.0 || own.written.opacity_cutoff.is_some() || self.has_holes(own)
    }

    /// Whether a picture says what of a material is there.
    pub(super) fn has_holes(&self, own: &Principled) -> bool {
        own.maps.opacity.is_some() || own.maps.base_color.is_some_and(|map| self.textures()[map as usize].has_alpha())
    }

    fn texel(&self, map: Option<u32>, at: &Interaction) -> Option<[f32; 4]> {
        let texture = &self.textures()[map? as usize];
        let mapping = texture.mapping().copied().unwrap_or_default();
        Some(texture.texel(&mapping, self.coordinates(texture, at)?, self.texels_seen(texture, &mapping, at)))
    }

    /// How many texels along a side a sample stands for, in the direction in which they are fewest.
    /// In the other there are more where a surface is seen from the side; there samples have to do.
    fn texels_seen(&self, texture: &Texture, mapping: &Mapping, at: &Interaction) -> f32 {
        if at.width <= 0.0 || !texture.has_levels() {
            return 0.0;
        }
        let Some([u, v]) = self.derivatives(at, mapping.second) else { return 0.0 };
        texture.texels_in(mapping, at.width / u.cross(v).length().sqrt())
    }

    /// The texture coordinates of a hit that count for a texture.
    fn coordinates(&self, texture: &Texture, at: &Interaction) -> Option<Vec2> {
        let Interaction { hit, surface, .. } = at;
        match (texture.mapping().is_some_and(|mapping| mapping.second), &self.objects()[hit.object as usize].geometry) {
            (true, Geometry::Mesh(tree)) => tree.mesh.second_uv(hit.part, surface.barycentric),
            (true, _) => None,
            (false, _) => surface.uv.get(),
        }
    }

    /// The normal that a bump map and then a normal map make of that for shading; `None` where
    /// there are none.
    pub(super) fn mapped_normal(&self, maps: &Maps, at: &Interaction) -> Option<Vec3> {
        let bumped = maps.bump.and_then(|map| self.bumped(map, maps.bump_height, at));
        let normal = bumped.unwrap_or(at.surface.n_shade);
        maps.normal.and_then(|map| self.leaning(map, at, normal)).or(bumped)
    }

    /// The normal that a picture of normals says: x along the direction in which the picture's u
    /// grows, y along its v upwards.
    fn leaning(&self, map: u32, at: &Interaction, normal: Vec3) -> Option<Vec3> {
        let texture = &self.textures()[map as usize];
        let mapping = texture.mapping().copied().unwrap_or_default();
        let object = &self.objects()[at.hit.object as usize];
        // A mean of normals would be that of a smoother surface.
        let [r, g, b, _] = texture.texel(&mapping, self.coordinates(texture, at)?, 0.0);
        let grow = match &object.geometry {
            Geometry::Mesh(tree) => {
                // The tangents of the file are given about the object's own normal.
                let own = object.to_world.as_ref().map_or(normal, |to_world| to_world.local_normal(normal));
                let grow = tree.mesh.tangents(at.hit.part, at.surface.barycentric, own, mapping.second)?;
                grow.map(|v| object.to_world.as_ref().map_or(v, |to_world| to_world.vector(v)))
            }
            _ => self.derivatives(at, mapping.second)?,
        };
        let [u, v] = mapping.directions(grow);
        let tangent = u.reject_from_normalized(normal).try_normalize()?;
        // Perpendicular, on the side to which v grows.
        let across = normal.cross(tangent);
        let bitangent = if across.dot(v) < 0.0 { -across } else { across };
        let signed = |x: f32| 2.0 * x - 1.0;
        let (x, y) = (mapping.strength * signed(r), mapping.strength * signed(g));
        (x * tangent + y * bitangent + signed(b) * normal).try_normalize()
    }

    /// The normal of the surface raised by a picture of heights.
    ///
    /// Source: James Blinn, *Simulation of Wrinkled Surfaces*, SIGGRAPH 1978, with the gradient of
    /// the height along the surface.
    fn bumped(&self, map: u32, height: f32, at: &Interaction) -> Option<Vec3> {
        let texture = &self.textures()[map as usize];
        let mapping = texture.mapping().copied().unwrap_or_default();
        let slope = height * texture.slope(&mapping, self.coordinates(texture, at)?);
        let [u, v] = dual(self.derivatives(at, mapping.second)?)?;
        (at.surface.n_shade - slope.x * u - slope.y * v).try_normalize()
    }

    /// How a point of the world moves as its texture coordinates grow by 1: those of the file on a
    /// mesh, else by what they are beside the point.
    fn derivatives(&self, at: &Interaction, second: bool) -> Option<[Vec3; 2]> {
        let Interaction { hit, surface, .. } = at;
        let object = &self.objects()[hit.object as usize];
        let to_world = object.to_world.as_ref();
        let moved = |v: Vec3| to_world.map_or(v, |to_world| to_world.vector(v));
        let shape = match &object.geometry {
            Geometry::Mesh(tree) => return Some(tree.mesh.derivatives(hit.part, second)?.map(moved)),
            Geometry::Primitive(shape) => shape,
            Geometry::Solid(_) => return None,
        };
        let point = to_world.map_or(surface.position, |to_world| to_world.inverse_point(surface.position));
        let normal = to_world.map_or(surface.n_geo, |to_world| to_world.local_normal(surface.n_geo));
        let size = shape.bounds().map_or(1.0_f32.max(point.length()), |bounds| bounds.size().max_element());
        let step = 1e-3 * size;
        let here = surface.uv.get()?;
        // What the shape says where a ray against the normal meets it beside the point.
        let beside = |way: Vec3| {
            let mut ray = Ray::new(point + step * (way + normal), -normal);
            ray.t_max = 2.0 * step;
            let crossing = shape.intersect(&ray)?;
            let uv = shape.surface(ray.at(crossing.t).as_dvec3(), &crossing).uv.get()?;
            // Around a closed shape 1 is 0 again.
            let around = |x: f32| if x.abs() > 0.5 { x - x.round() } else { x };
            Some(Vec2::new(around(uv.x - here.x), around(uv.y - here.y)) / step)
        };
        let (a, b) = normal.any_orthonormal_pair();
        let along = |way: Vec3| match (beside(way), beside(-way)) {
            (Some(after), Some(before)) => Some(0.5 * (after - before)),
            (after, before) => after.or(before.map(|before| -before)),
        };
        let (along_a, along_b) = (along(a)?, along(b)?);
        let [a, b] = dual([moved(a), moved(b)])?;
        dual([along_a.x * a + along_b.x * b, along_a.y * a + along_b.y * b])
    }

    /// The direction of the world in which u grows at a hit: that of the texture coordinates of a
    /// mesh, the way around the axis of what is round, the first edge of a rectangle; else the
    /// horizontal one.
    pub(super) fn tangent(&self, at: &Interaction) -> Vec3 {
        let Interaction { hit, surface, .. } = at;
        let object = &self.objects()[hit.object as usize];
        let to_world = object.to_world.as_ref();
        let normal = to_world.map_or(surface.n_geo, |to_world| to_world.local_normal(surface.n_geo));
        let point = to_world.map_or(surface.position, |to_world| to_world.inverse_point(surface.position));
        let own = match &object.geometry {
            Geometry::Mesh(tree) => tree.mesh.tangents(hit.part, surface.barycentric, normal, false).map(|[u, _]| u),
            Geometry::Primitive(shape) => shape.tangent(point),
            Geometry::Solid(_) => None,
        };
        let own = own.filter(|u| u.cross(normal).length_squared() > 1e-12 * u.length_squared());
        let own = own.unwrap_or_else(|| Vec3::Y.cross(normal));
        to_world.map_or(own, |to_world| to_world.vector(own))
    }
}

/// Two vectors in the same plane, each at right angles to one of two, whose product with the other
/// is 1: gradients from derivatives, and the other way round.
fn dual([u, v]: [Vec3; 2]) -> Option<[Vec3; 2]> {
    let normal = u.cross(v);
    let duals = [v.cross(normal), normal.cross(u)].map(|dual| dual / normal.length_squared());
    duals.iter().all(|dual| dual.is_finite()).then_some(duals)
}

#[cfg(test)]
mod tests;
