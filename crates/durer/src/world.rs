//! The compiled scene: immutable, with numbers instead of names, ready to be asked by many threads.

use crate::bvh::{Bvh, Grid, Tally};
use crate::camera::{Camera, Frame};
use crate::dialect::Rules;
use crate::light::Light;
use crate::material::{ColorNoise, Pattern, Solid};
use crate::math::{Aabb, Affine, Color, Ray, Vec2, Vec3};
use crate::shape::watertight::Sheared;
use crate::shape::{Crossing, Mesh, Primitive, Shape, Surface};
use crate::texture::{CubeMap, Texture};
use std::sync::Arc;

/// A scene ready to be traced.
#[derive(Debug)]
pub struct World {
    /// Whence it is seen.
    pub camera: Camera,
    /// The camera's axes.
    pub frame: Frame,
    /// Colour of rays that hit nothing.
    pub background: Color,
    /// Surroundings that replace that colour.
    pub cube_map: Option<CubeMap>,
    /// Light that is everywhere.
    pub ambient: Color,
    /// Lights.
    pub lights: Vec<Light>,
    /// Materials, by number.
    pub materials: Vec<Material>,
    /// Decoded pictures, by number.
    pub textures: Vec<Texture>,
    /// Everything that a ray can hit, by number.
    pub objects: Vec<Object>,
    /// What the words of the scene's dialect mean.
    pub rules: Rules,
    pub(crate) unbounded: Vec<u32>,
    pub(crate) accel: Accel,
}

/// One thing in the world.
#[derive(Debug)]
pub struct Object {
    /// What it is, in object space.
    pub geometry: Geometry,
    /// From object to world space; `None` where they are the same.
    pub to_world: Option<Affine>,
    /// Number of its material.
    pub material: u32,
    /// Where it is written.
    pub span: crate::diag::Span,
}

/// The form of an object.
#[derive(Clone, Debug)]
pub enum Geometry {
    /// A shape of one part.
    Primitive(Primitive),
    /// A mesh, shared by all objects that show it.
    Mesh(Arc<MeshTree>),
}

/// A mesh with its own tree.
#[derive(Debug)]
pub struct MeshTree {
    /// The mesh.
    pub mesh: Mesh,
    /// Its triangles' tree.
    pub bvh: Bvh,
    /// Corners of the triangles in the order of the tree.
    corners: Vec<[Vec3; 3]>,
    least_volume: f64,
}

/// A compiled material.
#[derive(Clone, Debug, PartialEq)]
pub enum Material {
    /// Numbers only.
    Phong(Phong),
    /// Two materials mixed; the matrix leads from world to pattern space.
    Solid(Solid, glam::DAffine3),
}

/// How a material's highlight is computed.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum HighlightModel {
    /// max(0, N·H)^exponent where N·L > 0.
    Blinn,
    /// max(0, R·L)^exponent; `behind`: also where N·L <= 0.
    Phong {
        /// Whether surfaces that face away have highlights too.
        behind: bool,
    },
}

/// A Phong material with the rules of its dialect worked in.
#[derive(Clone, Debug, PartialEq)]
pub struct Phong {
    /// Share of light scattered evenly, where neither texture nor noise is.
    pub diffuse: Color,
    /// Number of a texture that replaces it.
    pub texture: Option<u32>,
    /// Noise that replaces it.
    pub noise: Option<ColorNoise>,
    /// Whether the ambient light sees texture and noise too.
    pub ambient_textured: bool,
    /// Strength and sharpness of the highlight, if there is one.
    pub highlight: Option<(Color, f32, HighlightModel)>,
    /// Weight of the mirrored ray.
    pub reflective: Color,
    /// Weight of the transmitted ray.
    pub transparent: Color,
    /// Index of refraction inside.
    pub ior: f32,
    /// Whether Fresnel's law divides light between the two rays.
    pub fresnel: bool,
}

impl Default for Phong {
    fn default() -> Self {
        Phong {
            diffuse: Color::splat(0.8),
            texture: None,
            noise: None,
            ambient_textured: true,
            highlight: None,
            reflective: Color::ZERO,
            transparent: Color::ZERO,
            ior: 1.0,
            fresnel: false,
        }
    }
}

/// The structure over all bounded objects.
#[derive(Debug)]
pub enum Accel {
    /// A tree over objects; meshes have trees of their own.
    Bvh(Bvh),
    /// A grid over the parts of all objects.
    Grid {
        /// The cells.
        grid: Grid,
        /// Object and part of each thing in the grid.
        parts: Vec<(u32, u32)>,
    },
    /// Every object and part is tested.
    None,
}

/// Where a ray hits the world.
///
/// Hits are ordered: by `t`, then object, then part. All structures therefore name the same hit.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Hit {
    /// Position along the ray.
    pub t: f32,
    /// Coordinates on the part.
    pub uv: Vec2,
    /// Number of the object.
    pub object: u32,
    /// Number of the triangle in a mesh, else 0.
    pub part: u32,
}

impl Hit {
    fn is_before(&self, other: &Option<Hit>) -> bool {
        other.is_none_or(|o| (self.t, self.object, self.part) < (o.t, o.object, o.part))
    }
}

impl MeshTree {
    /// Builds the tree.
    pub fn new(mesh: Mesh) -> Self {
        let boxes: Vec<Aabb> = (0..mesh.len() as u32).map(|i| Aabb::around(mesh.corners(i))).collect();
        let bvh = Bvh::build(&boxes);
        let corners = bvh.order().iter().map(|&i| mesh.corners(i)).collect();
        MeshTree { mesh, bvh, corners, least_volume: 0.0 }
    }

    /// The same, blind to triangles seen from their sides: see [`Sheared::least_volume`].
    pub fn least_volume(self, least_volume: f64) -> Self {
        MeshTree { least_volume, ..self }
    }

    fn sheared(&self, ray: &Ray) -> Sheared {
        Sheared::new(ray).least_volume(self.least_volume)
    }

    /// Bytes in memory.
    pub fn bytes(&self) -> usize {
        self.mesh.bytes() + self.bvh.bytes() + size_of_val(&*self.corners)
    }

    /// The first hit before `best`, both of this object; `any` ends at the first found.
    #[inline]
    fn closest<T: Tally>(&self, ray: &Ray, any: bool, tally: &mut T) -> Option<(Crossing, u32)> {
        let sheared = self.sheared(ray);
        let mut best: Option<(Crossing, u32)> = None;
        self.bvh.walk(ray, tally, |item, t_max, tally| {
            tally.test();
            // A tie at the present t is kept apart by the number of the triangle.
            let Some(crossing) = sheared.intersect(self.corners[item], ray.t_min, ray.t_max) else { return t_max };
            let part = self.bvh.order()[item];
            if best.is_none_or(|(b, p)| (crossing.t, part) < (b.t, p)) {
                best = Some((crossing, part));
            }
            if any { f32::NEG_INFINITY } else { t_max.min(crossing.t) }
        });
        best
    }
}

impl Object {
    fn local_ray(&self, ray: &Ray) -> Ray {
        self.to_world.as_ref().map_or(*ray, |to_world| to_world.inverse_ray(ray))
    }

    /// The object's first hit in the ray's interval.
    fn closest<T: Tally>(&self, ray: &Ray, any: bool, tally: &mut T) -> Option<(Crossing, u32)> {
        let ray = self.local_ray(ray);
        match &self.geometry {
            Geometry::Primitive(shape) => {
                tally.test();
                shape.intersect(&ray).map(|crossing| (crossing, 0))
            }
            Geometry::Mesh(tree) => tree.closest(&ray, any, tally),
        }
    }

    /// The crossing with one part, tested directly.
    fn part<T: Tally>(&self, ray: &Ray, part: u32, tally: &mut T) -> Option<Crossing> {
        tally.test();
        let ray = self.local_ray(ray);
        match &self.geometry {
            Geometry::Primitive(shape) => shape.intersect(&ray),
            // Refused like by the tree: such a ray hits nothing.
            Geometry::Mesh(_) if !crate::bvh::is_sound(&ray) => None,
            Geometry::Mesh(tree) => tree.sheared(&ray).intersect(tree.mesh.corners(part), ray.t_min, ray.t_max),
        }
    }

    /// How many parts it has.
    pub fn parts(&self) -> u32 {
        match &self.geometry {
            Geometry::Primitive(_) => 1,
            Geometry::Mesh(tree) => tree.mesh.len() as u32,
        }
    }

    /// Bounds in world space; `None` for a shape without end.
    pub fn bounds(&self) -> Option<Aabb> {
        let local = match &self.geometry {
            Geometry::Primitive(shape) => shape.bounds()?,
            Geometry::Mesh(tree) => tree.bvh.bounds(),
        };
        Some(self.moved(local))
    }

    /// Bounds of one part in world space.
    pub fn part_bounds(&self, part: u32) -> Option<Aabb> {
        match &self.geometry {
            Geometry::Primitive(_) => self.bounds(),
            Geometry::Mesh(tree) => {
                let corners = tree.mesh.corners(part);
                let Some(to_world) = &self.to_world else { return Some(Aabb::around(corners)) };
                // Tighter than the box of the box, and padded for rounding by a box without size at each corner.
                let images = corners.map(|c| to_world.bounds(Aabb { min: c, max: c }));
                Some(images.into_iter().fold(Aabb::EMPTY, Aabb::union))
            }
        }
    }

    /// Whether some of it may lie in a box of world space that overlaps its bounds.
    pub fn overlaps(&self, cell: &Aabb) -> bool {
        match (&self.geometry, &self.to_world) {
            (Geometry::Primitive(shape), None) => shape.overlaps(cell),
            _ => true,
        }
    }

    fn moved(&self, bounds: Aabb) -> Aabb {
        match &self.to_world {
            Some(to_world) if !bounds.is_empty() => to_world.bounds(bounds),
            _ => bounds,
        }
    }
}

impl World {
    /// The first hit in the ray's interval.
    pub fn closest<T: Tally>(&self, ray: &Ray, tally: &mut T) -> Option<Hit> {
        tally.ray();
        if !crate::bvh::is_sound(ray) {
            return None;
        }
        let mut best: Option<Hit> = None;
        let mut ray = *ray;
        // A tie is decided by the order of hits, so a later ray may reach just to the present t.
        let offer = |best: &mut Option<Hit>, ray: &mut Ray, object: u32, found: Option<(Crossing, u32)>| {
            if let Some((Crossing { t, uv }, part)) = found {
                let hit = Hit { t, uv, object, part };
                if hit.is_before(best) {
                    *best = Some(hit);
                    ray.t_max = t.next_up();
                }
            }
        };
        for &object in &self.unbounded {
            let found = self.objects[object as usize].closest(&ray, false, tally);
            offer(&mut best, &mut ray, object, found);
        }
        match &self.accel {
            Accel::Bvh(bvh) => {
                let outer = ray;
                bvh.walk(&outer, tally, |item, _, tally| {
                    let object = bvh.order()[item];
                    let found = self.objects[object as usize].closest(&ray, false, tally);
                    offer(&mut best, &mut ray, object, found);
                    ray.t_max
                });
            }
            Accel::Grid { grid, parts } => {
                let outer = ray;
                grid.walk(&outer, tally, |item, _, tally| {
                    let (object, part) = parts[item];
                    let found = self.objects[object as usize].part(&ray, part, tally);
                    offer(&mut best, &mut ray, object, found.map(|crossing| (crossing, part)));
                    ray.t_max
                });
            }
            Accel::None => {
                for (i, object) in self.objects.iter().enumerate().filter(|(_, o)| o.bounds().is_some()) {
                    for part in 0..object.parts() {
                        let found = object.part(&ray, part, tally);
                        offer(&mut best, &mut ray, i as u32, found.map(|crossing| (crossing, part)));
                    }
                }
            }
        }
        best
    }

    /// Whether anything is hit in the ray's interval; the first thing found will do.
    pub fn occluded<T: Tally>(&self, ray: &Ray, tally: &mut T) -> bool {
        tally.ray();
        if !crate::bvh::is_sound(ray) {
            return false;
        }
        if self.unbounded.iter().any(|&i| self.objects[i as usize].closest(ray, true, tally).is_some()) {
            return true;
        }
        let mut found = false;
        match &self.accel {
            Accel::Bvh(bvh) => bvh.walk(ray, tally, |item, t_max, tally| {
                found |= self.objects[bvh.order()[item] as usize].closest(ray, true, tally).is_some();
                if found { f32::NEG_INFINITY } else { t_max }
            }),
            Accel::Grid { grid, parts } => grid.walk(ray, tally, |item, t_max, tally| {
                let (object, part) = parts[item];
                found |= self.objects[object as usize].part(ray, part, tally).is_some();
                if found { f32::NEG_INFINITY } else { t_max }
            }),
            Accel::None => {
                found = self
                    .objects
                    .iter()
                    .filter(|o| o.bounds().is_some())
                    .any(|o| (0..o.parts()).any(|part| o.part(ray, part, tally).is_some()));
            }
        }
        found
    }

    /// The surface at a hit, in world space.
    pub fn surface(&self, ray: &Ray, hit: &Hit) -> Surface {
        let object = &self.objects[hit.object as usize];
        let local = object.local_ray(ray);
        let crossing = Crossing { t: hit.t, uv: hit.uv };
        let surface = match &object.geometry {
            Geometry::Primitive(shape) => shape.surface(&local, &crossing),
            Geometry::Mesh(tree) => tree.mesh.surface(hit.part, &crossing),
        };
        // The old programs, which keep off a surface by an epsilon, take the point from the ray as it is.
        if self.rules.epsilon.is_some() {
            let [n_geo, n_shade] =
                [surface.n_geo, surface.n_shade].map(|n| object.to_world.as_ref().map_or(n, |m| m.normal(n)));
            return Surface { position: ray.at(hit.t), n_geo, n_shade, ..surface };
        }
        // Beside the rounding itself, a bent surface leaves the tangent plane by its square.
        let Some(to_world) = &object.to_world else {
            return Surface { error: surface.error + surface.bulge(surface.error), ..surface };
        };
        let error = to_world.point_error(surface.position, surface.error);
        Surface {
            position: to_world.point(surface.position),
            error: error + to_world.spread(surface.bulge(to_world.inverse_spread(error))),
            n_geo: to_world.normal(surface.n_geo),
            n_shade: to_world.normal(surface.n_shade),
            ..surface
        }
    }

    /// The colour that a ray sees that hits nothing.
    pub fn sky(&self, direction: Vec3) -> Color {
        self.cube_map.as_ref().map_or(self.background, |map| map.at(direction))
    }

    /// The materials that make up a surface point, each with its share.
    pub fn mix(&self, material: u32, point: Vec3, share: f32, visit: &mut impl FnMut(&Phong, f32)) {
        match &self.materials[material as usize] {
            Material::Phong(phong) => visit(phong, share),
            Material::Solid(solid, to_pattern) => {
                let q = to_pattern.transform_point3(point.as_dvec3()).as_vec3();
                let weight = solid.weight(q);
                let [first, second] = solid.materials();
                for (index, weight) in [(first, weight), (second, 1.0 - weight)] {
                    if weight != 0.0 {
                        self.mix(index, point, share * weight, visit);
                    }
                }
            }
        }
    }

    /// The box around all bounded objects.
    pub fn bounds(&self) -> Aabb {
        self.objects.iter().filter_map(Object::bounds).fold(Aabb::EMPTY, Aabb::union)
    }

    /// The structure over its objects.
    pub fn accel(&self) -> &Accel {
        &self.accel
    }
}

#[cfg(test)]
mod tests;
