//! The compiled scene: immutable, with indices instead of names, for queries from many threads.

mod batch;
mod contents;
mod course;
pub mod csg;
pub mod emitters;
mod interaction;
mod maps;
mod material;
mod merged;
mod object;
mod rules;
pub mod shading;
pub mod solid;

pub(crate) use batch::{MAX_BATCH, SmallWorld};
pub use contents::{Assets, Contents};
pub use course::{CourseHits, HitRules, Matrix, Vectors};
use durer_bvh::{Bvh, Grid, PrimitivePacks, TraversalCounter};
use durer_scene::light::{Illuminate as _, Light, LightLiSample};
use durer_scene::material::{Pattern, Solid};
use durer_scene::math::{Aabb, Color, Ray, Ray64, Vec2, Vec3};
use durer_scene::shape::{Shape as _, ShapeHit, Sphere};
use durer_scene::source::Digest;
use durer_scene::texture::Texture;
pub use emitters::LightSampler;
use glam::DVec3;
pub use interaction::SurfaceInteraction;
pub use material::{Emission, HighlightModel, Map, Maps, Material, MaterialMix, Phong, Principled, WeightedMaterial};
pub use object::{Geometry, MeshTree, Object};
pub use rules::{DisplayRules, Epsilon, ShadingRules};
pub use shading::Shading;
use std::sync::OnceLock;

/// A compiled scene, ready for ray tracing.
#[derive(Clone, Debug)]
pub struct World {
    contents: Contents,
    assets: Assets,
    /// Hash of its sources, and true if it was edited since.
    source: Digest,
    edited: bool,
    emitters: LightSampler,
    has_cutouts: bool,
    hides_backs: bool,
    has_interfaces: bool,
    /// True if light passes straight through some thin sheet.
    has_sheets: bool,
    /// Objects with an interior medium; a camera may start inside one.
    bodies: Vec<u32>,
    /// Extent of each object, computed on first use; empty if light enters no object.
    extents: Vec<OnceLock<Option<f32>>>,
    /// Simple shapes outside the tree, tested eight at a time.
    pub(crate) packs: PrimitivePacks,
    /// The whole world in a form for batches of rays, if it has few objects.
    pub(crate) small_world: Option<SmallWorld>,
    /// Other objects outside the structure: unbounded ones, or all objects if there are too few for
    /// a tree to pay off.
    pub(crate) loose: Vec<u32>,
    pub(crate) accel: Accel,
    /// Spheres of the tree in the order of its leaves, which saves a lookup. Other objects have
    /// radius 0; empty without spheres.
    pub(crate) spheres: Vec<Sphere>,
}

/// Acceleration structure over all bounded objects.
#[derive(Clone, Debug)]
pub enum Accel {
    /// A BVH over objects; meshes have their own trees.
    Bvh(Bvh),
    /// A grid over the parts of all objects.
    Grid {
        /// The cells.
        grid: Grid,
        /// Object and part of each element of the grid.
        parts: Vec<(u32, u32)>,
        /// Object and part number of the few parts that extend far beyond the grid. Every ray tests
        /// them.
        wide: Vec<(u32, u32)>,
    },
    /// Brute force.
    None,
    /// Tests every object, as an official program does.
    Course(CourseHits),
}

/// A hit of a ray.
///
/// Hits are ordered by `t`, then object, then part. All structures therefore return the same hit.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Hit {
    /// Distance along the ray, in units of its direction's length.
    pub t: f32,
    /// Surface coordinates on the part.
    pub uv: Vec2,
    /// Index of the object.
    pub object: u32,
    /// Index of the triangle in a mesh; in a solid, as defined in [`csg`]; otherwise 0.
    pub part: u32,
}

impl Hit {
    fn is_before(&self, other: &Option<Hit>) -> bool {
        other.is_none_or(|o| (self.t, self.object, self.part) < (o.t, o.object, o.part))
    }
}

impl World {
    /// Creates a world without an acceleration structure; `source` is the hash of its sources.
    pub(crate) fn new(contents: Contents, assets: Assets, source: Digest) -> Self {
        let mut world = World {
            contents,
            assets,
            source,
            edited: false,
            emitters: LightSampler::default(),
            has_cutouts: false,
            hides_backs: false,
            has_interfaces: false,
            has_sheets: false,
            bodies: Vec::new(),
            extents: Vec::new(),
            packs: PrimitivePacks::default(),
            small_world: None,
            loose: Vec::new(),
            accel: Accel::None,
            spheres: Vec::new(),
        };
        world.has_cutouts = world.finds_cutouts();
        world.hides_backs = world.finds_hidden_backs();
        world.has_interfaces = world.finds_interfaces();
        world.has_sheets = world.finds_sheets();
        world.bodies = world.finds_bodies();
        world.extents = world.forgotten_extents();
        world.emitters = LightSampler::new(&world);
        world
    }

    /// Returns the luminous efficacy by colour channel, if light is in watts.
    pub fn lumens(&self) -> Option<Vec3> {
        self.contents.display.lumens
    }

    /// Returns the emitters.
    pub fn emitters(&self) -> &LightSampler {
        &self.emitters
    }

    /// Returns true if some surface is partly transparent by opacity.
    pub fn has_cutouts(&self) -> bool {
        self.has_cutouts
    }

    /// Returns true if cameras see through the backs of some faces.
    pub fn hides_backs(&self) -> bool {
        self.hides_backs
    }

    /// Returns true if some object only bounds a medium, so that light enters it unrefracted.
    pub fn has_interfaces(&self) -> bool {
        self.has_interfaces
    }

    /// Returns true if light may pass straight through some thin sheet, such as a pane.
    pub fn has_sheets(&self) -> bool {
        self.has_sheets
    }

    /// Returns true if some texture has mipmaps, so that footprints of samples matter.
    pub fn has_mipmaps(&self) -> bool {
        self.textures().iter().any(Texture::has_levels)
    }

    /// Finds the first hit in the ray's interval.
    pub fn closest<T: TraversalCounter>(&self, ray: impl Into<Ray64>, counter: &mut T) -> Option<Hit> {
        self.closest_along(&mut ray.into(), counter)
    }

    /// Finds the first hit, shortening the ray meanwhile and restoring it at the end, which avoids
    /// a slow copy.
    #[inline]
    pub(crate) fn closest_along<T: TraversalCounter>(&self, ray: &mut Ray64, counter: &mut T) -> Option<Hit> {
        counter.ray();
        if !self.accepts(&ray.rounded) {
            return None;
        }
        let t_max = ray.rounded.t_max;
        let best = self.nearest(ray, counter);
        ray.rounded.t_max = t_max;
        best
    }

    /// Returns true if a ray is traced. The official programs also trace a ray with NaN, which hits
    /// spheres at distance 10000.
    #[inline]
    fn accepts(&self, ray: &Ray) -> bool {
        durer_bvh::internal::is_sound(ray) || matches!(self.accel, Accel::Course(_))
    }

    fn nearest<T: TraversalCounter>(&self, ray: &mut Ray64, counter: &mut T) -> Option<Hit> {
        let mut best: Option<Hit> = None;
        // Ties are broken by the order of hits, so a later hit may be at the current t.
        let offer = |best: &mut Option<Hit>, ray: &mut Ray64, object: u32, found: Option<(ShapeHit, u32)>| {
            if let Some((ShapeHit { t, uv }, part)) = found {
                let hit = Hit { t, uv, object, part };
                if hit.is_before(best) {
                    *best = Some(hit);
                    ray.rounded.t_max = t.next_up();
                }
            }
        };
        if let Some(met) = self.packs.closest(&ray.rounded, counter) {
            let crossing = self.objects()[met.number as usize].crossing_at(met.t, ray);
            offer(&mut best, ray, met.number, Some((crossing, 0)));
        }
        for &object in &self.loose {
            let found = self.objects()[object as usize].closest(object, ray, false, counter);
            offer(&mut best, ray, object, found);
        }
        match &self.accel {
            Accel::Bvh(bvh) if bvh.is_empty() => {}
            Accel::Bvh(bvh) => {
                let outer = ray.rounded;
                bvh.traverse(&outer, counter, |item, _, counter| {
                    let (object, found) = self.closest_of(bvh, item, ray, false, counter);
                    offer(&mut best, ray, object, found);
                    ray.rounded.t_max
                });
            }
            Accel::Grid { grid, parts, wide } => {
                let outer = ray.rounded;
                for &(object, part) in wide {
                    let found = self.objects()[object as usize].part((object, part), ray, counter);
                    offer(&mut best, ray, object, found);
                }
                grid.traverse(&outer, counter, |item, _, counter| {
                    let (object, part) = parts[item];
                    let found = self.objects()[object as usize].part((object, part), ray, counter);
                    offer(&mut best, ray, object, found);
                    ray.rounded.t_max
                });
            }
            Accel::Course(hits) => best = hits.closest(self.objects(), ray, counter),
            Accel::None => {
                for (i, object) in self.objects().iter().enumerate().filter(|(_, o)| o.bounds().is_some()) {
                    for part in 0..object.parts() {
                        let found = object.part((i as u32, part), ray, counter);
                        offer(&mut best, ray, i as u32, found);
                    }
                }
            }
        }
        best
    }

    /// Returns the index of an object of the tree, and its first hit in the ray's interval.
    #[inline(always)]
    fn closest_of<T: TraversalCounter>(
        &self,
        bvh: &Bvh,
        item: usize,
        ray: &Ray64,
        any: bool,
        counter: &mut T,
    ) -> (u32, Option<(ShapeHit, u32)>) {
        let number = bvh.primitive_indices()[item];
        if let Some(sphere) = self.spheres.get(item).filter(|sphere| sphere.radius > 0.0) {
            counter.work(0, 1);
            return (number, sphere.intersect(&ray.rounded).map(|crossing| (crossing, 0)));
        }
        (number, self.objects()[number as usize].closest(number, ray, any, counter))
    }

    /// Returns true if anything is hit in the ray's interval; ends at the first hit found.
    pub fn occluded<T: TraversalCounter>(&self, ray: impl Into<Ray64>, counter: &mut T) -> bool {
        self.occluded_along(&ray.into(), counter)
    }

    /// Tests occlusion without copying the ray. See [`World::occluded`].
    pub(crate) fn occluded_along<T: TraversalCounter>(&self, ray: &Ray64, counter: &mut T) -> bool {
        counter.ray();
        let outer = &ray.rounded;
        if !self.accepts(outer) {
            return false;
        }
        if self.packs.occluded(outer, counter)
            || self.loose.iter().any(|&i| self.objects()[i as usize].closest(i, ray, true, counter).is_some())
        {
            return true;
        }
        let mut found = false;
        match &self.accel {
            Accel::Bvh(bvh) if bvh.is_empty() => {}
            Accel::Bvh(bvh) => bvh.traverse(outer, counter, |item, t_max, counter| {
                found |= self.closest_of(bvh, item, ray, true, counter).1.is_some();
                if found { f32::NEG_INFINITY } else { t_max }
            }),
            Accel::Grid { grid, parts, wide } => {
                found = wide.iter().any(|&(object, part)| {
                    self.objects()[object as usize].part((object, part), ray, counter).is_some()
                });
                if !found {
                    grid.traverse(outer, counter, |item, t_max, counter| {
                        let (object, part) = parts[item];
                        found |= self.objects()[object as usize].part((object, part), ray, counter).is_some();
                        if found { f32::NEG_INFINITY } else { t_max }
                    });
                }
            }
            Accel::Course(hits) => found = hits.closest(self.objects(), ray, counter).is_some(),
            Accel::None => {
                found = self
                    .objects()
                    .iter()
                    .enumerate()
                    .filter(|(_, o)| o.bounds().is_some())
                    .any(|(i, o)| (0..o.parts()).any(|part| o.part((i as u32, part), ray, counter).is_some()));
            }
        }
        found
    }

    /// Iterates over the closed glass objects that contain a point, with their indices of
    /// refraction.
    pub fn glass_around(&self, point: Vec3) -> impl Iterator<Item = (u32, f32)> {
        self.around(point, 0..self.objects().len() as u32, |glass| glass.transparent != Color::ZERO)
    }

    /// Iterates over the closed objects that paths enter and that contain a point, with their
    /// indices of refraction; empty if no object absorbs or scatters.
    pub fn bodies_around(&self, point: Vec3) -> impl Iterator<Item = (u32, f32)> {
        self.around(point, self.bodies.iter().copied(), Phong::is_entered)
    }

    /// Returns the cached [`Object::extent`] of an object.
    pub(crate) fn extent(&self, object: u32) -> Option<f32> {
        let find = || self.objects()[object as usize].extent();
        self.extents.get(object as usize).map_or_else(find, |extent| *extent.get_or_init(find))
    }

    fn forgotten_extents(&self) -> Vec<OnceLock<Option<f32>>> {
        let enters = |material: &Material| matches!(material, Material::Phong(phong) if phong.is_entered());
        let wanted = if self.materials().iter().any(enters) { self.objects().len() } else { 0 };
        vec![OnceLock::new(); wanted]
    }

    fn around(
        &self,
        point: Vec3,
        among: impl Iterator<Item = u32>,
        wanted: fn(&Phong) -> bool,
    ) -> impl Iterator<Item = (u32, f32)> {
        among.filter_map(move |number| {
            let object = &self.objects()[number as usize];
            match &self.materials()[object.material as usize] {
                Material::Phong(phong) if wanted(phong) && object.contains(point) => Some((number, phong.ior)),
                _ => None,
            }
        })
    }

    /// Returns the index of the triangle at a hit in its mesh, else 0.
    pub fn triangle(&self, hit: &Hit) -> u32 {
        match &self.objects()[hit.object as usize].geometry {
            Geometry::Solid(solid) => solid.triangle(hit.part),
            _ => hit.part,
        }
    }

    /// Iterates over all hits in the ray's interval, sorted by distance; only the first of several
    /// at the same `t`.
    pub fn all_hits(&self, ray: impl Into<Ray64>) -> impl Iterator<Item = Hit> {
        let mut rest = ray.into();
        std::iter::from_fn(move || {
            let hit = self.closest(&rest, &mut ())?;
            rest.rounded.t_min = hit.t;
            Some(hit)
        })
    }

    /// Iterates over the nearest hit of each object in the ray's interval, in the order of the
    /// objects.
    pub fn hits_of_each(&self, ray: impl Into<Ray64>) -> impl Iterator<Item = Hit> {
        let ray = ray.into();
        (0..self.objects().len() as u32).filter_map(move |object| self.hit_of(object, &ray))
    }

    /// Returns the nearest hit of one object, ignoring all others.
    pub fn hit_of(&self, object: u32, ray: &Ray64) -> Option<Hit> {
        let sound = durer_bvh::internal::is_sound(&ray.rounded);
        let (crossing, part) =
            self.objects()[object as usize].closest(object, ray, false, &mut ()).filter(|_| sound)?;
        Some(Hit { t: crossing.t, uv: crossing.uv, object, part })
    }

    /// Returns the light of a light source that arrives at a point without occlusion.
    #[inline(always)]
    pub fn illuminate(&self, light: usize, point: DVec3) -> LightLiSample {
        let LightLiSample { to_light, distance, color } = match &self.lights()[light] {
            // Fast path: most lights are points; keeps the result in registers.
            Light::Point(emitter) => emitter.illuminate(point),
            emitter => emitter.illuminate(point),
        };
        let mut seen = LightLiSample { to_light, distance, color };
        if let Some(Some(profile)) = self.profiles().get(light) {
            seen.color = profile.at(self.lights()[light].in_profile(-seen.to_light)) * seen.color;
        }
        seen
    }

    /// Returns the colour of a ray that misses.
    pub fn sky(&self, direction: Vec3) -> Color {
        if let Some(environment) = self.environment() {
            return environment.at(direction);
        }
        self.cube_map().map_or(self.background(), |map| map.at(direction))
    }

    /// Returns the materials of a surface point with their shares.
    #[inline]
    pub fn parts(&self, at: &SurfaceInteraction) -> MaterialMix<'_> {
        let mut parts = MaterialMix::new();
        match &self.materials()[at.material as usize] {
            // Fast path: most materials are not mixed.
            Material::Phong(phong) => parts.push(WeightedMaterial { phong, share: 1.0 }),
            Material::Solid(..) => self.mix(at.material, at, 1.0, &mut parts),
        }
        parts
    }

    fn mix<'w>(&'w self, material: u32, at: &SurfaceInteraction, share: f32, parts: &mut MaterialMix<'w>) {
        match &self.materials()[material as usize] {
            Material::Phong(phong) => parts.push(WeightedMaterial { phong, share }),
            Material::Solid(solid, to_pattern, picture) => {
                let q = to_pattern.transform_point3(at.surface.position.as_dvec3()).as_vec3();
                let pictured = picture.map_or(1.0, |picture| self.number_at(picture, at));
                let weight = match solid {
                    Solid::TwoSided(_) => f32::from(u8::from(!at.inside())),
                    _ => solid.share(q, self.shading_rules().conic_rings) * pictured,
                };
                let [first, second] = solid.materials();
                for (index, weight) in [(first, weight), (second, 1.0 - weight)] {
                    if weight != 0.0 {
                        self.mix(index, at, share * weight, parts);
                    }
                }
            }
        }
    }

    /// Returns the bounds of all bounded objects.
    pub fn bounds(&self) -> Aabb {
        self.objects().iter().filter_map(Object::bounds).fold(Aabb::EMPTY, Aabb::union)
    }

    /// Returns the acceleration structure.
    pub fn accel(&self) -> &Accel {
        &self.accel
    }
}

#[cfg(test)]
mod leaving_tests;
#[cfg(test)]
mod packs_tests;
#[cfg(test)]
mod tests;
