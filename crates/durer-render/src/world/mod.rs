//! World: the compiled scene, which uses indices instead of names and can be queried from many
//! threads.

mod batch;
mod coincident;
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
mod seen;
pub mod shading;
pub mod solid;

pub(crate) use batch::{MAX_BATCH, SmallWorld};
pub(crate) use coincident::PassedSurfaces;
pub use contents::{Assets, Contents};
pub use course::{CourseAccel, HitRules, Matrix, VectorLibrary};
use durer_bvh::{Bvh, Grid, PrimitivePacks, TraversalCounter};
use durer_scene::light::{Illuminate as _, Light, LightLiSample};
use durer_scene::material::{Pattern, PatternMaterial};
use durer_scene::math::{Aabb, Color, Ray, Ray64, Vec2, Vec3};
use durer_scene::shape::{Shape as _, ShapeHit, Sphere};
use durer_scene::source::Digest;
use durer_scene::texture::Texture;
pub use emitters::LightSampler;
use glam::DVec3;
pub use interaction::SurfaceInteraction;
pub use material::{
    Emission, HighlightModel, Material, MaterialMix, MaterialTextures, ParameterTexture, Phong, Principled,
    WeightedMaterial,
};
pub use object::{Geometry, MeshTree, Object};
pub use rules::{DisplayRules, Epsilon, ShadingRules};
pub use shading::Shading;
use std::sync::OnceLock;

/// Scene after compilation, with its acceleration structure and light sampler. All rendering uses a
/// [`World`].
#[derive(Clone, Debug)]
pub struct World {
    contents: Contents,
    assets: Assets,
    /// Hash of the sources from which the world was compiled.
    source: Digest,
    /// True if the contents were edited since compilation.
    edited: bool,
    emitters: LightSampler,
    has_cutouts: bool,
    hides_backs: bool,
    has_unseen: bool,
    has_interfaces: bool,
    /// True if some thin sheet lets light pass straight through.
    has_sheets: bool,
    /// Indices of the objects with an interior medium in which a camera could be placed.
    bodies: Vec<u32>,
    /// [`Object::half_area`] of each object, computed at first use. The list is empty if light does
    /// not enter any object.
    half_areas: Vec<OnceLock<Option<f32>>>,
    /// Simple shapes outside the acceleration structure, tested eight at a time.
    pub(crate) packs: PrimitivePacks,
    /// Copy of all objects in a form for batches of rays, if there are few objects.
    pub(crate) small_world: Option<SmallWorld>,
    /// Indices of the other objects outside the acceleration structure, which are the unbounded
    /// objects, or all objects if there are too few for a tree to be faster.
    pub(crate) outside_accel: Vec<u32>,
    pub(crate) accel: Accel,
    /// Copies of the spheres in the BVH, in the order of its leaves, which save a lookup. Objects
    /// other than spheres have radius 0. The list is empty if there are no spheres.
    pub(crate) spheres: Vec<Sphere>,
}

/// Acceleration structure over the bounded objects of a world.
#[derive(Clone, Debug)]
pub enum Accel {
    /// A BVH over the objects. Each mesh has its own BVH.
    Bvh(Bvh),
    /// A uniform grid over the parts of all objects.
    Grid {
        /// Cells of the grid.
        grid: Grid,
        /// Object and part of each item in the grid.
        parts: Vec<(u32, u32)>,
        /// Object and part of the few items that extend far beyond the grid. Every ray tests these
        /// items.
        wide: Vec<(u32, u32)>,
    },
    /// No acceleration structure, so that every ray tests all objects.
    None,
    /// Structure that tests every object in the same way as an official program.
    Course(CourseAccel),
}

/// First intersection of a ray with a world, given by its distance, object and part.
///
/// Hits are ordered by `t`, then object, then part, so every acceleration structure returns the
/// same hit.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Hit {
    /// Distance along the ray, as a multiple of the direction's length.
    pub t: f32,
    /// Surface coordinates on the part.
    pub uv: Vec2,
    /// Index of the object.
    pub object: u32,
    /// Index of the triangle in a mesh; see [`csg`] for solids; 0 for other shapes.
    pub part: u32,
}

impl Hit {
    fn is_before(&self, other: &Option<Hit>) -> bool {
        other.is_none_or(|o| (self.t, self.object, self.part) < (o.t, o.object, o.part))
    }
}

impl World {
    /// Creates a world without an acceleration structure. `source` is the hash of the sources from
    /// which the world was compiled.
    pub(crate) fn new(contents: Contents, assets: Assets, source: Digest) -> Self {
        let mut world = World {
            contents,
            assets,
            source,
            edited: false,
            emitters: LightSampler::default(),
            has_cutouts: false,
            hides_backs: false,
            has_unseen: false,
            has_interfaces: false,
            has_sheets: false,
            bodies: Vec::new(),
            half_areas: Vec::new(),
            packs: PrimitivePacks::default(),
            small_world: None,
            outside_accel: Vec::new(),
            accel: Accel::None,
            spheres: Vec::new(),
        };
        world.has_cutouts = world.finds_cutouts();
        world.hides_backs = world.finds_hidden_backs();
        world.has_unseen = world.finds_unseen();
        world.has_interfaces = world.finds_interfaces();
        world.has_sheets = world.finds_sheets();
        world.bodies = world.finds_bodies();
        world.half_areas = world.empty_half_areas();
        world.emitters = LightSampler::new(&world);
        world
    }

    /// Returns the luminous efficacy of each colour channel, if light is measured in watts.
    pub fn lumens(&self) -> Option<Vec3> {
        self.contents.display.lumens
    }

    /// Returns the light sampler.
    pub fn emitters(&self) -> &LightSampler {
        &self.emitters
    }

    /// Returns true if some surface has an opacity below 1.
    pub fn has_cutouts(&self) -> bool {
        self.has_cutouts
    }

    /// Returns true if the backs of some surfaces are invisible to the camera.
    pub fn hides_backs(&self) -> bool {
        self.hides_backs
    }

    /// Returns true if the camera looks through some surfaces.
    pub fn has_unseen(&self) -> bool {
        self.has_unseen
    }

    /// Returns true if some surface is only the boundary of a medium, so that light passes through
    /// it unrefracted.
    pub fn has_interfaces(&self) -> bool {
        self.has_interfaces
    }

    /// Returns true if light can pass straight through some thin sheet, such as a window pane.
    pub fn has_sheets(&self) -> bool {
        self.has_sheets
    }

    /// Returns true if some texture has mipmaps, which need the footprints of samples.
    pub fn has_mipmaps(&self) -> bool {
        self.textures().iter().any(Texture::has_levels)
    }

    /// Returns the first hit in the ray's interval.
    pub fn closest<T: TraversalCounter>(&self, ray: impl Into<Ray64>, counter: &mut T) -> Option<Hit> {
        self.closest_along(&mut ray.into(), counter)
    }

    /// Returns the first hit in the ray's interval. The ray is shortened during the call and
    /// restored at the end, which avoids a slow copy.
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

    /// Returns true if a ray should be traced. The official programs also trace rays that contain
    /// NaN, which hit spheres at distance 10000.
    #[inline]
    fn accepts(&self, ray: &Ray) -> bool {
        durer_bvh::internal::is_valid(ray) || matches!(self.accel, Accel::Course(_))
    }

    fn nearest<T: TraversalCounter>(&self, ray: &mut Ray64, counter: &mut T) -> Option<Hit> {
        let mut best: Option<Hit> = None;
        // Ties are resolved by comparing hits, so another hit at the current `t` can still replace
        // the best one.
        let offer = |best: &mut Option<Hit>, ray: &mut Ray64, object: u32, found: Option<(ShapeHit, u32)>| {
            if let Some((ShapeHit { t, uv }, part)) = found {
                let hit = Hit { t, uv, object, part };
                if hit.is_before(best) {
                    *best = Some(hit);
                    ray.rounded.t_max = t.next_up();
                }
            }
        };
        if let Some(pack_hit) = self.packs.closest(&ray.rounded, counter) {
            let crossing = self.objects()[pack_hit.number as usize].crossing_at(pack_hit.t, ray);
            offer(&mut best, ray, pack_hit.number, Some((crossing, 0)));
        }
        for &object in &self.outside_accel {
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

    /// Returns the object of a BVH item and the first hit on it in the ray's interval.
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
            counter.count_work(0, 1);
            return (number, sphere.intersect(&ray.rounded).map(|crossing| (crossing, 0)));
        }
        (number, self.objects()[number as usize].closest(number, ray, any, counter))
    }

    /// Returns true if the ray hits anything in its interval. The search stops at the first hit
    /// found.
    pub fn occluded<T: TraversalCounter>(&self, ray: impl Into<Ray64>, counter: &mut T) -> bool {
        self.occluded_along(&ray.into(), counter)
    }

    /// Tests a ray for occlusion without copying it. See [`World::occluded`].
    pub(crate) fn occluded_along<T: TraversalCounter>(&self, ray: &Ray64, counter: &mut T) -> bool {
        counter.ray();
        let outer = &ray.rounded;
        if !self.accepts(outer) {
            return false;
        }
        if self.packs.occluded(outer, counter)
            || self.outside_accel.iter().any(|&i| self.objects()[i as usize].closest(i, ray, true, counter).is_some())
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

    /// Iterates over the closed objects that contain a point and that paths can enter, with their
    /// indices of refraction. The iterator is empty if no object absorbs or scatters light.
    pub fn bodies_around(&self, point: Vec3) -> impl Iterator<Item = (u32, f32)> {
        self.around(point, self.bodies.iter().copied(), Phong::is_entered)
    }

    /// Returns [`Object::half_area`] of an object from a cache.
    pub(crate) fn half_area(&self, object: u32) -> Option<f32> {
        let find = || self.objects()[object as usize].half_area();
        self.half_areas.get(object as usize).map_or_else(find, |area| *area.get_or_init(find))
    }

    /// Returns an empty cache for [`Object::half_area`].
    fn empty_half_areas(&self) -> Vec<OnceLock<Option<f32>>> {
        let enters = |material: &Material| matches!(material, Material::Phong(phong) if phong.is_entered());
        let wanted = if self.materials().iter().any(enters) { self.objects().len() } else { 0 };
        vec![OnceLock::new(); wanted]
    }

    /// Iterates over those of the given candidates that are closed, contain a point and have a
    /// material that is `wanted`.
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

    /// Returns the index of the hit triangle in its mesh, or 0 for other shapes.
    pub fn triangle(&self, hit: &Hit) -> u32 {
        match &self.objects()[hit.object as usize].geometry {
            Geometry::Solid(solid) => solid.triangle(hit.part),
            _ => hit.part,
        }
    }

    /// Iterates over all hits in the ray's interval, in order of distance. If several hits have the
    /// same `t`, only the first one is included.
    ///
    /// The official programs of some years also return hits at the start of the interval. Such a
    /// hit is not included twice, since the iteration would never end otherwise.
    pub fn all_hits(&self, ray: impl Into<Ray64>) -> impl Iterator<Item = Hit> {
        successive_hits(ray.into(), |rest| self.closest(rest, &mut ()))
    }

    /// Iterates over all hits on one object, as if there were no others. See [`World::all_hits`].
    pub fn all_hits_of(&self, object: u32, ray: impl Into<Ray64>) -> impl Iterator<Item = Hit> {
        successive_hits(ray.into(), move |rest| self.hit_of(object, rest))
    }

    /// Iterates over the objects that the ray hits in its interval, in scene order, with the first
    /// hit on each.
    pub fn hits_of_each(&self, ray: impl Into<Ray64>) -> impl Iterator<Item = Hit> {
        let ray = ray.into();
        (0..self.objects().len() as u32).filter_map(move |object| self.hit_of(object, &ray))
    }

    /// Returns the first hit on one object, as if there were no others.
    pub fn hit_of(&self, object: u32, ray: &Ray64) -> Option<Hit> {
        let sound = durer_bvh::internal::is_valid(&ray.rounded);
        let (crossing, part) =
            self.objects()[object as usize].closest(object, ray, false, &mut ()).filter(|_| sound)?;
        Some(Hit { t: crossing.t, uv: crossing.uv, object, part })
    }

    /// Returns the light that arrives at a point from one of the scene's lights, ignoring
    /// occlusion.
    #[inline(always)]
    pub fn illuminate(&self, light: usize, point: DVec3) -> LightLiSample {
        let LightLiSample { to_light, distance, color } = match &self.lights()[light] {
            // Fast path: most lights are point lights. This path keeps the result in registers.
            Light::Point(emitter) => emitter.illuminate(point),
            emitter => emitter.illuminate(point),
        };
        let mut light_sample = LightLiSample { to_light, distance, color };
        if let Some(Some(profile)) = self.profiles().get(light) {
            light_sample.color =
                profile.at(self.lights()[light].to_profile(-light_sample.to_light)) * light_sample.color;
        }
        light_sample
    }

    /// Returns the radiance of the background in a direction.
    pub fn background_radiance(&self, direction: Vec3) -> Color {
        if let Some(environment) = self.environment() {
            return environment.at(direction);
        }
        self.cube_map().map_or(self.background(), |map| map.at(direction))
    }

    /// Returns the materials at a surface point, with their shares.
    #[inline]
    pub fn materials_at(&self, at: &SurfaceInteraction) -> MaterialMix<'_> {
        let mut parts = MaterialMix::new();
        match &self.materials()[at.material as usize] {
            // Fast path: most materials are not mixtures.
            Material::Phong(phong) => parts.push(WeightedMaterial { phong, share: 1.0 }),
            Material::Mix(..) => self.mix(at.material, at, 1.0, &mut parts),
        }
        parts
    }

    /// Adds the materials of a mixture, which may be nested, with their shares.
    fn mix<'w>(&'w self, material: u32, at: &SurfaceInteraction, share: f32, parts: &mut MaterialMix<'w>) {
        match &self.materials()[material as usize] {
            Material::Phong(phong) => parts.push(WeightedMaterial { phong, share }),
            Material::Mix(solid, to_pattern, picture) => {
                let q = to_pattern.transform_point3(at.surface.position.as_dvec3()).as_vec3();
                let pictured = picture.map_or(1.0, |picture| self.number_at(picture, at));
                let weight = match solid {
                    PatternMaterial::TwoSided(_) => f32::from(u8::from(!at.inside())),
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

    /// Returns the world-space bounds of all bounded objects.
    pub fn bounds(&self) -> Aabb {
        self.objects().iter().filter_map(Object::bounds).fold(Aabb::EMPTY, Aabb::union)
    }

    /// Returns the acceleration structure.
    pub fn accel(&self) -> &Accel {
        &self.accel
    }
}

/// Iterates over the hits that `next` finds, each in the rest of the interval behind the previous
/// one.
fn successive_hits(mut rest: Ray64, next: impl Fn(&Ray64) -> Option<Hit>) -> impl Iterator<Item = Hit> {
    let mut last: Option<f32> = None;
    std::iter::from_fn(move || {
        let mut hit = next(&rest)?;
        if let Some(last) = last.filter(|last| hit.t <= *last) {
            rest.rounded.t_min = last.next_up();
            hit = next(&rest).filter(|hit| hit.t > last)?;
        }
        rest.rounded.t_min = hit.t;
        last = Some(hit.t);
        Some(hit)
    })
}

#[cfg(test)]
mod leaving_tests;
#[cfg(test)]
mod packs_tests;
#[cfg(test)]
mod tests;
