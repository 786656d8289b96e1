//! The surfaces that rays met, worked out side by side.

use super::{Geometry, Hit, Interaction, Material, Phong, TOGETHER, World};
use durer_bvh::internal::{PlainKernel, run_plain};
use durer_scene::math::{Color, Line, Ray64, Vec2, Vec3};
use durer_scene::shape::{Plane, Primitive, Shape as _, ShapeHit, Sphere, Surface, triangle};
use glam::DVec3;

/// Hits of each [`Kind`] begin at a multiple of this, so that whole vectors of them are worked out.
pub(crate) const LANES: usize = 16;

/// Room for up to [`TOGETHER`] hits.
pub(crate) const PLACES: usize = TOGETHER + KINDS * LANES;

/// Numbers side by side.
pub(crate) type Numbers = [f32; PLACES];

/// Vectors side by side: x of all, then y, then z.
#[derive(Clone, Copy)]
pub(crate) struct Vectors([Numbers; 3]);

impl Vectors {
    pub(crate) const ZERO: Vectors = Vectors([[0.0; PLACES]; 3]);

    #[inline(always)]
    pub(crate) fn get(&self, i: usize) -> Vec3 {
        let [x, y, z] = &self.0;
        Vec3::new(x[i], y[i], z[i])
    }

    #[inline(always)]
    pub(crate) fn set(&mut self, i: usize, v: Vec3) {
        let [x, y, z] = &mut self.0;
        (x[i], y[i], z[i]) = (v.x, v.y, v.z);
    }
}

/// How a surface is found out.
#[derive(Clone, Copy)]
pub(crate) enum Kind {
    Plane,
    Sphere,
    /// Of a mesh without normals.
    Flat,
    Triangle,
    /// Alone, as [`World::meet`] does it.
    Other,
}

const KINDS: usize = 5;

/// A hit whose surface is worked out together with those of others.
#[derive(Clone, Copy)]
pub(crate) struct Met {
    ray: u32,
    place: u32,
}

impl Met {
    /// The number of its ray.
    #[inline(always)]
    pub(crate) fn ray(self) -> usize {
        self.ray as usize
    }

    /// Where its numbers lie side by side with those of others.
    #[inline(always)]
    pub(crate) fn place(self) -> usize {
        self.place as usize
    }
}

/// Hits that are asked about together, and their surfaces as far as light asks.
pub(crate) struct Surfaces {
    /// How many rays' hits are of each kind, and which rays.
    counts: [usize; KINDS],
    rays: [[u32; TOGETHER]; KINDS],
    met: Vec<Met>,
    /// The first place of hits that were met alone.
    others: usize,
    /// All places are before this: a multiple of [`LANES`].
    end: usize,
    given: Given,
    position: Vectors,
    rest: Vectors,
    error: Vectors,
    pub(crate) n_geo: Vectors,
    pub(crate) n_shade: Vectors,
    shadow_offsets: [Vectors; 2],
    /// The directions of the rays.
    pub(crate) view: Vectors,
    /// Of hits that were met alone.
    diffuse: Vectors,
    solids: [Option<u32>; PLACES],
}

/// What surfaces are worked out of. Planes: normal and origin of the ray; offset and t. Spheres:
/// center in place of the normal, and radius. Triangles: corners, and normals there; the
/// coordinates of the hit.
struct Given {
    vectors: [Vectors; 6],
    numbers: [Numbers; 2],
}

impl Default for Surfaces {
    fn default() -> Self {
        Surfaces {
            counts: [0; KINDS],
            rays: [[0; TOGETHER]; KINDS],
            met: Vec::new(),
            others: 0,
            end: 0,
            given: Given { vectors: [Vectors::ZERO; 6], numbers: [[0.0; PLACES]; 2] },
            position: Vectors::ZERO,
            rest: Vectors::ZERO,
            error: Vectors::ZERO,
            n_geo: Vectors::ZERO,
            n_shade: Vectors::ZERO,
            shadow_offsets: [Vectors::ZERO; 2],
            view: Vectors::ZERO,
            diffuse: Vectors::ZERO,
            solids: [None; PLACES],
        }
    }
}

impl Surfaces {
    pub(crate) fn clear(&mut self) {
        self.counts = [0; KINDS];
        self.met.clear();
    }

    /// Adds the hit of a ray, by its number, to those that are asked about together.
    #[inline(always)]
    pub(crate) fn add(&mut self, ray: usize, kind: Kind) {
        let count = &mut self.counts[kind as usize];
        self.rays[kind as usize][*count] = ray as u32;
        *count += 1;
    }

    /// The hits, whose order is not that of the rays.
    pub(crate) fn met(&self) -> &[Met] {
        &self.met
    }

    /// The diffuse colour there of what is of a material.
    #[inline(always)]
    pub(crate) fn diffuse(&self, place: usize, phong: &Phong) -> Color {
        if place < self.others { phong.diffuse } else { self.diffuse.get(place) }
    }

    /// See [`Surface::solid`].
    #[inline(always)]
    pub(crate) fn solid(&self, place: usize) -> Option<u32> {
        if place < self.others { None } else { self.solids[place] }
    }

    /// All places are below this.
    #[inline(always)]
    pub(crate) fn end(&self) -> usize {
        self.end.min(PLACES)
    }

    /// A surface, without what is said of textures.
    #[inline(always)]
    pub(crate) fn get(&self, place: usize, solid: Option<u32>) -> Surface {
        Surface {
            position: self.position.get(place),
            rest: self.rest.get(place),
            error: self.error.get(place),
            n_geo: self.n_geo.get(place),
            n_shade: self.n_shade.get(place),
            shadow_offsets: [self.shadow_offsets[0].get(place), self.shadow_offsets[1].get(place)],
            solid,
            ..Surface::NOWHERE
        }
    }

    #[inline(always)]
    fn set(&mut self, place: usize, surface: &Surface) {
        self.position.set(place, surface.position);
        self.rest.set(place, surface.rest);
        self.error.set(place, surface.error);
        self.n_geo.set(place, surface.n_geo);
        self.n_shade.set(place, surface.n_shade);
        self.shadow_offsets[0].set(place, surface.shadow_offsets[0]);
        self.shadow_offsets[1].set(place, surface.shadow_offsets[1]);
    }
}

impl World {
    /// How the surface at a hit is found out, that is made of this.
    #[inline]
    pub(crate) fn kind_of(&self, hit: &Hit, phong: &Phong) -> Kind {
        let object = &self.objects()[hit.object as usize];
        let is_plain = object.to_world.is_none()
            && !self.shading_rules().points_on_ray
            && phong.texture.is_none()
            && phong.noise.is_none()
            && !phong.tinted;
        match &object.geometry {
            Geometry::Primitive(Primitive::Plane(_)) if is_plain => Kind::Plane,
            Geometry::Primitive(Primitive::Sphere(_)) if is_plain => Kind::Sphere,
            Geometry::Mesh(tree) if is_plain && !tree.mesh.has_normals() => Kind::Flat,
            Geometry::Mesh(_) if is_plain => Kind::Triangle,
            _ => Kind::Other,
        }
    }

    /// Works out the surfaces that [`World::meet`] finds at those hits of some rays.
    pub(crate) fn meet_together(&self, rays: &[Ray64], hits: &[Option<Hit>], surfaces: &mut Surfaces) {
        surfaces.end = 0;
        self.meet_kind((rays, hits), Kind::Plane, surfaces, |place, hit, object, ray, given| {
            let Geometry::Primitive(Primitive::Plane(plane)) = object else { return };
            given.set_ray(place, ray, hit.t, plane.normal, plane.offset);
        });
        let first_sphere = surfaces.end;
        self.meet_kind((rays, hits), Kind::Sphere, surfaces, |place, hit, object, ray, given| {
            let Geometry::Primitive(Primitive::Sphere(sphere)) = object else { return };
            given.set_ray(place, ray, hit.t, sphere.center, sphere.radius);
        });
        let first_flat = surfaces.end;
        self.meet_kind((rays, hits), Kind::Flat, surfaces, |place, hit, object, _, given| {
            let Geometry::Mesh(tree) = object else { return };
            given.set_triangle(place, tree.mesh.corners(hit.part), hit.uv);
        });
        let first_triangle = surfaces.end;
        self.meet_kind((rays, hits), Kind::Triangle, surfaces, |place, hit, object, _, given| {
            let Geometry::Mesh(tree) = object else { return };
            given.set_triangle(place, tree.mesh.corners(hit.part), hit.uv);
            // Of no length where there are none.
            let normals = tree.mesh.corner_normals(hit.part).unwrap_or([Vec3::ZERO; 3]);
            for (vectors, normal) in given.vectors[3..].iter_mut().zip(normals) {
                vectors.set(place, normal);
            }
        });
        surfaces.others = surfaces.end.min(PLACES);
        if surfaces.others > 0 {
            let firsts = [first_sphere, first_flat, first_triangle, surfaces.others];
            run_plain(SurfaceKernel { firsts, surfaces });
        }
        let mut at = Interaction::NOWHERE;
        for i in 0..surfaces.counts[Kind::Other as usize] {
            let (ray, place) = (surfaces.rays[Kind::Other as usize][i], surfaces.end + i);
            let Some(hit) = hits[ray as usize] else { continue };
            let along = &rays[ray as usize];
            self.meet(along, hit, &mut at);
            if let Material::Phong(phong) = &self.materials()[at.material as usize] {
                surfaces.diffuse.set(place, self.diffuse_color(phong, &at.surface));
            }
            surfaces.solids[place] = at.surface.solid;
            surfaces.set(place, &at.surface);
            surfaces.view.set(place, along.dir());
            surfaces.met.push(Met { ray, place: place as u32 });
        }
        surfaces.end = (surfaces.end + surfaces.counts[Kind::Other as usize]).next_multiple_of(LANES);
    }

    /// Gives hits of one kind their places, and gathers what their surfaces are worked out of.
    #[inline(always)]
    fn meet_kind(
        &self,
        (rays, hits): (&[Ray64], &[Option<Hit>]),
        kind: Kind,
        surfaces: &mut Surfaces,
        gather: impl Fn(usize, &Hit, &Geometry, &Ray64, &mut Given),
    ) {
        let Surfaces { rays: of_kind, counts, met, end, given, view, .. } = surfaces;
        let of_kind = &of_kind[kind as usize][..counts[kind as usize]];
        for (place, &ray) in (*end..PLACES).zip(of_kind) {
            let Some(hit) = &hits[ray as usize] else { continue };
            let along = &rays[ray as usize];
            gather(place, hit, &self.objects()[hit.object as usize].geometry, along, given);
            view.set(place, along.dir());
            met.push(Met { ray, place: place as u32 });
        }
        *end = (*end + of_kind.len()).next_multiple_of(LANES);
    }
}

impl Given {
    #[inline(always)]
    fn set_ray(&mut self, place: usize, ray: &Ray64, t: f32, vector: Vec3, size: f32) {
        self.vectors[0].set(place, vector);
        self.vectors[1].set(place, ray.rounded.origin);
        (self.numbers[0][place], self.numbers[1][place]) = (size, t);
    }

    #[inline(always)]
    fn set_triangle(&mut self, place: usize, corners: [Vec3; 3], uv: Vec2) {
        for (vectors, corner) in self.vectors.iter_mut().zip(corners) {
            vectors.set(place, corner);
        }
        (self.numbers[0][place], self.numbers[1][place]) = uv.into();
    }
}

/// Planes, then spheres, then flat triangles, then others. What lies between them was there before.
struct SurfaceKernel<'a> {
    surfaces: &'a mut Surfaces,
    /// The first of each kind after planes, and the end.
    firsts: [usize; 4],
}

impl PlainKernel for SurfaceKernel<'_> {
    type Output = ();

    #[inline(always)]
    fn run(self) {
        let SurfaceKernel { surfaces, firsts: [first_sphere, first_flat, first_triangle, end] } = self;
        let first_triangle = first_triangle.min(end);
        let first_flat = first_flat.min(first_triangle);
        let first_sphere = first_sphere.min(first_flat);
        // Closures given to generic functions of others would be called like any function.
        for i in 0..first_sphere {
            let (normal, offset) = (surfaces.given.vectors[0].get(i), surfaces.given.numbers[0][i]);
            let (point, crossing) = surfaces.crossing(i);
            surfaces.set_bent(i, Plane { normal, offset }.surface(point, &crossing));
        }
        for i in first_sphere..first_flat {
            let (center, radius) = (surfaces.given.vectors[0].get(i), surfaces.given.numbers[0][i]);
            let (point, crossing) = surfaces.crossing(i);
            surfaces.set_bent(i, Sphere { center, radius }.surface(point, &crossing));
        }
        for i in first_flat..first_triangle {
            let (corners, uv) = surfaces.triangle(i);
            surfaces.set(i, &triangle::triangle_surface(corners, None, uv));
        }
        for i in first_triangle..end {
            let ([.., a, b, c], (corners, uv)) = (&surfaces.given.vectors, surfaces.triangle(i));
            let normals = [a.get(i), b.get(i), c.get(i)];
            surfaces.set(i, &triangle::triangle_surface(corners, Some(normals), uv));
        }
    }
}

impl Surfaces {
    /// Where a plane or sphere is met.
    #[inline(always)]
    fn crossing(&self, i: usize) -> (DVec3, ShapeHit) {
        let (origin, t) = (self.given.vectors[1].get(i), self.given.numbers[1][i]);
        let line = Line { origin: origin.as_dvec3(), dir: self.view.get(i).as_dvec3() };
        (line.at(t.into()), ShapeHit { t, uv: Vec2::ZERO })
    }

    /// The corners of a triangle, and where in it it is met.
    #[inline(always)]
    fn triangle(&self, i: usize) -> ([Vec3; 3], Vec2) {
        let Given { vectors: [a, b, c, ..], numbers: [u, v] } = &self.given;
        ([a.get(i), b.get(i), c.get(i)], Vec2::new(u[i], v[i]))
    }

    /// Sets what may be bent.
    #[inline(always)]
    fn set_bent(&mut self, i: usize, mut surface: Surface) {
        surface.error += surface.bulge(surface.error);
        self.set(i, &surface);
    }
}
