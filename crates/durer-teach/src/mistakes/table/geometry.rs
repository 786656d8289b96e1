//! Mistakes in intersections and normals.

use super::{Mistake, Values, row};
use crate::mistakes::bugs::{BehindOrigin, HitChoice, Normals, Roots, SphereNormal};
use crate::mistakes::variant::{CourseShape, course_shape};
use durer_render::world::Geometry;
use durer_scene::dialect::{MeshNormals, Quirk};
use durer_scene::shape::Primitive;
use std::sync::Arc;

/// Values of mistakes in normals. With 1, mirrors and glass use the wrong normal even where it
/// points away from the ray.
const ONE_NORMAL: Values = Values::Only(&[0.0, 1.0]);

/// Common mistakes in intersections and normals.
pub(super) const MISTAKES: &[Mistake] = &[
    row(
        "normals-local",
        "transforms",
        "normals of transformed objects are not transformed",
        "N = normalize(M^-T n)",
        "N = n",
        |v, only| (v.bugs.normals, v.bugs.one_normal) = (Normals::Local, only > 0.0),
    )
    .with(ONE_NORMAL),
    row(
        "normals-moved",
        "transforms",
        "normals of transformed objects are transformed by M instead of its inverse transpose",
        "N = normalize(M^-T n)",
        "N = normalize(M n)",
        |v, only| (v.world.edit().shading.moved_normals, v.bugs.one_normal) = (true, only > 0.0),
    )
    .with(ONE_NORMAL),
    row(
        "normals-inverse",
        "transforms",
        "normals of transformed objects are transformed by the inverse of M without the transpose",
        "N = normalize(M^-T n)",
        "N = normalize(M^-1 n)",
        |v, only| (v.bugs.normals, v.bugs.one_normal) = (Normals::ByInverse, only > 0.0),
    )
    .with(ONE_NORMAL),
    row(
        "normals-transposed",
        "transforms",
        "normals of transformed objects are transformed by the transpose of M without the inverse",
        "N = normalize(M^-T n)",
        "N = normalize(M^T n)",
        |v, only| (v.bugs.normals, v.bugs.one_normal) = (Normals::Transposed, only > 0.0),
    )
    .with(ONE_NORMAL),
    row(
        "normals-long",
        "transforms",
        "normals of transformed objects are {not normalised|transformed by M and not normalised}",
        "N = normalize(M^-T n)",
        "N = {M^-T n|M n}",
        |v, moved| v.bugs.normals = if moved == 0.0 { Normals::Long } else { Normals::LongMoved },
    )
    .with(Values::Only(&[0.0, 1.0])),
    row(
        "normals-mixed-long",
        "normals",
        "interpolated normals of a smooth mesh are not normalised",
        "N = normalize(a Na + b Nb + c Nc)",
        "N = a Na + b Nb + c Nc",
        |v, _| v.bugs.unnormalized_mesh_normals = true,
    ),
    row(
        "normals-flat",
        "normals",
        "smooth meshes are shaded flat, with one normal per triangle",
        "N = normalize(a Na + b Nb + c Nc)",
        "N = normalize(cross(b - a, c - a))",
        |v, _| v.bugs.flat = true,
    ),
    row(
        "normals-smooth",
        "normals",
        "flat meshes are shaded smoothly, with vertex normals averaged {by area|evenly}",
        "N = normalize(cross(b - a, c - a))",
        "N = normalize(a Na + b Nb + c Nc)",
        |v, weight| {
            let rule = if weight == 0.0 { MeshNormals::SmoothByArea } else { MeshNormals::SmoothByFace };
            v.objects(|geometry| {
                if let Geometry::Mesh(tree) = geometry
                    && tree.mesh.is_flat()
                {
                    *tree = Arc::new(tree.with_normals(rule));
                }
            });
        },
    )
    .with(Values::Only(&[0.0, 1.0])),
    row(
        "triangles-turned",
        "normals",
        "normals of triangles are flipped",
        "N = normalize(cross(b - a, c - a))",
        "N = normalize(cross(c - a, b - a))",
        |v, _| v.bugs.triangles_turned = true,
    ),
    row(
        "spheres-turned",
        "normals",
        "normals of spheres point inwards",
        "N = normalize(p - center)",
        "N = normalize(center - p)",
        |v, _| v.bugs.spheres_turned = true,
    ),
    row(
        "planes-turned",
        "normals",
        "normals of planes are flipped",
        "N = normalize(normal)",
        "N = -normalize(normal)",
        |v, _| v.bugs.planes_turned = true,
    ),
    row(
        "normals-exchanged",
        "normals",
        "the weights of smooth normals belong to the wrong vertices: {a b c|b c a|c a b|b a c|a c b|c b a} for a b c",
        "N = (1 - b - c) Na + b Nb + c Nc",
        "the weights or the normals in another order",
        |v, order| v.bugs.normal_permutation = order as usize,
    )
    .with(Values::Only(&[1.0, 2.0, 3.0, 4.0, 5.0])),
    row(
        "sphere-normals",
        "normals",
        "normals of spheres {are taken from the origin, not from the centre|are not normalised|are not normalised}",
        "N = normalize(p - center)",
        "N = {normalize(p)|p - center|p - center, with R and T normalised}",
        |v, how| {
            v.bugs.sphere_normals = if how == 0.0 { SphereNormal::Position } else { SphereNormal::Long };
            v.bugs.bounces.unit = how == 2.0;
        },
    )
    .with(Values::Only(&[0.0, 1.0, 2.0])),
    row(
        "sphere-roots",
        "distance",
        "the roots of spheres mix two forms of the formula: {4 a c with half of b|4 a c with half of b, and a in place of 2 a|2 a with half of b}",
        "D = b^2 - 4 a c with b = 2 d.(o - center), t = (-b - sqrt(D)) / 2a; or D = b^2 - a c with b = d.(o - center), t = (-b - sqrt(D)) / a",
        "b = d.(o - center), {D = b^2 - 4 a c, t = (-b - sqrt(D)) / 2a|D = b^2 - 4 a c, t = (-b - sqrt(D)) / a|D = b^2 - a c, t = (-b - sqrt(D)) / 2a}",
        |v, how| {
            v.bugs.hit_choice = HitChoice::Roots([Roots::FourHalf, Roots::FourWhole, Roots::TwiceA][(how as usize).min(2)]);
        },
    )
    .with(Values::Only(&[0.0, 1.0, 2.0])),
    row(
        "triangle-test",
        "distance",
        "triangles lack the test {a >= 0, which is b + c <= 1|b >= 0|c >= 0}: they extend beyond that side",
        "b >= 0 && c >= 0 && b + c <= 1",
        "{b >= 0 && c >= 0|c >= 0 && b + c <= 1|b >= 0 && b + c <= 1}",
        |v, corner| v.extend_beyond_side(corner as usize),
    )
    .with(Values::Only(&[0.0, 1.0, 2.0])),
    row(
        "backs-culled",
        "distance",
        "{surfaces|triangles} that are seen from behind are not hit",
        "hits count from either side",
        "if (dot(N, d) > 0) return false",
        |v, triangles| v.bugs.hit_choice = HitChoice::Fronts(triangles > 0.0),
    )
    .with(Values::Only(&[1.0, 0.0])),
    row(
        "mesh-first",
        "distance",
        "in a mesh, the {first|last} triangle that is hit is used instead of the nearest",
        "for each triangle if (t < best) best = t",
        "for each triangle {if (hit) return true|if (hit) best = t}",
        |v, last| v.bugs.hit_choice = if last == 0.0 { HitChoice::FirstOfMesh } else { HitChoice::LastOfMesh },
    )
    .with(Values::Only(&[0.0, 1.0])),
    row(
        "direction-moved",
        "transforms",
        "the ray's direction is transformed to object space like a point, including the translation",
        "d' = M^-1 (d, 0)",
        "d' = M^-1 (d, 1)",
        |v, _| v.bugs.hit_choice = HitChoice::MovedDirection,
    ),
    row(
        "parallelograms",
        "distance",
        "triangles are parallelograms: the test b + c <= 1 is missing",
        "b >= 0 && c >= 0 && b + c <= 1",
        "b >= 0 && c >= 0 && b <= 1 && c <= 1",
        |v, _| v.parallelograms(),
    ),
    row(
        "other-material",
        "flat",
        "objects have the {next|previous|next|previous} material{||, except for the last one|, except for the first one}",
        "materials[index], index from 0",
        "materials[index + 1], or - 1",
        |v, which| {
            let count = v.world.materials().len().max(1) as u32;
            for object in &mut v.world.edit().objects {
                object.material = match which as u32 {
                    0 => (object.material + 1) % count,
                    1 => (object.material + count - 1) % count,
                    2 => (object.material + 1).min(count - 1),
                    _ => object.material.saturating_sub(1),
                };
            }
        },
    )
    .with(Values::Only(&[0.0, 1.0, 2.0, 3.0])),
    row(
        "far-spheres",
        "distance",
        "the far side of spheres is visible: the greater root is used",
        "t = (-b - sqrt(D)) / 2a, unless that is less than t_min",
        "t = (-b + sqrt(D)) / 2a",
        |v, _| v.bugs.hit_choice = HitChoice::FarSpheres,
    ),
    row(
        "normals-faced",
        "diffuse",
        "back faces are shaded with a flipped normal, without `-shade_back`",
        "N as is (without -shade_back)",
        "if (dot(N, d) > 0) N = -N",
        |v, _| v.bugs.faced = !v.settings.shade_back,
    ),
    row(
        "backs-not-shaded",
        "diffuse",
        "back faces are not shaded with a flipped normal",
        "if (dot(N, d) > 0) N = -N",
        "N as is",
        |v, _| v.settings.shade_back = false,
    ),
    row(
        "black-backs",
        "diffuse",
        "back faces are black although they should not be, or the reverse",
        "as in the scene's dialect",
        "the reverse",
        |v, _| v.toggle(Quirk::BlackBacks),
    ),
    row(
        "local-direction-unit",
        "transforms",
        "the ray's direction is normalised in object space, so t differs from world space",
        "d' = M^-1 d, with t unchanged",
        "d' = normalize(M^-1 d)",
        |v, _| v.bugs.local_unit = true,
    ),
    row(
        "plane-negated",
        "distance",
        "the offset of planes has the wrong sign",
        "t = (offset - n.o) / n.d",
        "t = -(offset + n.o) / n.d",
        |v, _| {
            v.objects(|geometry| {
                if let Geometry::Primitive(Primitive::Plane(plane)) = geometry {
                    plane.offset = -plane.offset;
                }
            });
        },
    ),
    row(
        "plane-through-origin",
        "distance",
        "the offset of planes is ignored",
        "t = (offset - n.o) / n.d",
        "t = -n.o / n.d",
        |v, _| {
            v.objects(|geometry| {
                if let Geometry::Primitive(Primitive::Plane(plane)) = geometry {
                    plane.offset = 0.0;
                }
            });
        },
    ),
    row(
        "radius",
        "distance",
        "spheres have {} times the correct radius",
        "b^2 - 4 a c with c = |o - center|^2 - r^2",
        "a wrong factor inside",
        |v, factor| {
            v.objects(|geometry| {
                if let Geometry::Primitive(Primitive::Sphere(sphere)) = geometry {
                    sphere.radius *= factor;
                }
            });
        },
    )
    .with(Values::Numbers(&[0.5, 2.0])),
    row(
        "radius-not-squared",
        "distance",
        "the radius of spheres is not squared",
        "c = |o - center|^2 - r * r",
        "c = |o - center|^2 - r, N = {normalize(p - center)|(p - center) / r|(p - center) / r, with R and T normalised}",
        |v, how| {
            v.objects(|geometry| {
                if let Geometry::Primitive(Primitive::Sphere(sphere)) = geometry {
                    sphere.radius = sphere.radius.max(0.0).sqrt();
                }
            });
            if how > 0.0 {
                v.bugs.sphere_normals = SphereNormal::OverSquare;
                v.bugs.bounces.unit = how == 2.0;
            }
        },
    )
    .with(Values::Only(&[0.0, 1.0, 2.0])),
    row(
        "center-ignored",
        "distance",
        "the centre of spheres {is ignored|has the wrong sign}",
        "o - center",
        "o{| + center}",
        |v, sign| {
            v.objects(|geometry| {
                if let Geometry::Primitive(Primitive::Sphere(sphere)) = geometry {
                    sphere.center *= -sign;
                }
            });
        },
    )
    .with(Values::Only(&[0.0, 1.0])),
    row(
        "farthest-object",
        "distance",
        "the farthest object is visible instead of the nearest",
        "if (t < best) best = t",
        "if (t > best) best = t",
        |v, _| v.bugs.hit_choice = HitChoice::FarthestObject,
    ),
    row(
        "farthest-triangle",
        "distance",
        "the farthest object is visible, and of meshes the farthest triangle",
        "if (t < best) best = t",
        "if (t > best) best = t",
        |v, _| v.bugs.hit_choice = HitChoice::FarthestTriangle,
    ),
    row(
        "last-triangle",
        "distance",
        "the last object in the file hides all others, and the last triangle of a mesh hides its others",
        "if (t < best) best = t",
        "if (hit) best = t",
        |v, _| v.bugs.hit_choice = HitChoice::LastTriangle,
    ),
    row(
        "near-roots",
        "distance",
        "only the nearer root of spheres is tested: rays that start inside do not hit them",
        "t = the least root > t_min",
        "t = the lesser root, or nothing",
        |v, _| v.bugs.hit_choice = HitChoice::NearRoots,
    ),
    row(
        "last-hit",
        "distance",
        "the last hit along the ray is used instead of the first, such as the far root of spheres",
        "t = the least root > t_min",
        "t = the greatest root",
        |v, _| v.bugs.hit_choice = HitChoice::Last,
    ),
    row(
        "last-written",
        "distance",
        "the last object in the file hides all others: hits are not compared by t",
        "if (t < best) best = t",
        "best = t",
        |v, _| v.bugs.hit_choice = HitChoice::LastInFile,
    ),
    row(
        "first-written",
        "distance",
        "the first object in the file hides all others: a group stops at its first hit",
        "for each object hit |= object.intersect(...)",
        "for each object if (object.intersect(...)) return true",
        |v, _| v.bugs.hit_choice = HitChoice::FirstInFile,
    ),
    row(
        "hits-behind",
        "distance",
        "hits behind the ray's origin count: t_min is ignored{| for the camera's rays|}",
        "t > t_min && t < best",
        "{t < best|t < best|abs(t) > t_min && t < best}",
        |v, rays| {
            const ALL: [BehindOrigin; 3] = [BehindOrigin::All, BehindOrigin::Camera, BehindOrigin::Beyond];
            v.bugs.behind = Some(ALL[(rays as usize).min(2)]);
        },
    )
    .with(Values::Only(&[0.0, 1.0, 2.0])),
    row(
        "thing-missing",
        "distance",
        "all {spheres|planes|triangles|meshes} are missing",
        "every kind has a working intersect(...)",
        "one that always returns false",
        |v, kind| {
            v.world.edit().objects.retain(|object| match course_shape(&object.geometry) {
                Some(CourseShape::Sphere) => kind != 0.0,
                Some(CourseShape::Plane) => kind != 1.0,
                Some(CourseShape::Triangle) => kind != 2.0,
                Some(CourseShape::Mesh) => kind != 3.0,
                None => true,
            });
            v.objects(|_| {});
        },
    )
    .with(Values::Only(&[0.0, 1.0, 2.0, 3.0])),
    row(
        "one-material",
        "flat",
        "all objects have the {first|last} material",
        "materials[index]",
        "materials[0], or the one read last",
        |v, last| {
            let count = v.world.materials().len().max(1) as u32;
            let all = if last == 0.0 { 0 } else { count - 1 };
            v.world.edit().objects.iter_mut().for_each(|object| object.material = all);
        },
    )
    .with(Values::Only(&[0.0, 1.0])),
    row(
        "triangles-long",
        "normals",
        "normals of triangles are not normalised",
        "N = normalize(cross(b - a, c - a))",
        "N = cross(b - a, c - a)",
        |v, _| v.bugs.long_triangles = true,
    ),
    row(
        "normals-translated",
        "transforms",
        "normals of transformed objects are transformed like points, including the translation",
        "N = normalize(M^-T n)",
        "N = normalize(M {(n, 1))|(M^-T n, 1))}",
        |v, twice| v.bugs.normals = if twice == 0.0 { Normals::MovedPoint } else { Normals::MovedTwice },
    )
    .with(Values::Only(&[0.0, 1.0])),
    row(
        "sphere-unit-direction",
        "distance",
        "ray directions in object space are taken as unit vectors: a = 1 {in the quadratic equation|in the division} of spheres",
        "D = b^2 - a c, t = (-b - sqrt(D)) / a with a = d.d",
        "{D = b^2 - c|D = b^2 - a c}, t = -b - sqrt(D)",
        |v, division| {
            v.bugs.hit_choice = HitChoice::Roots(if division == 0.0 { Roots::Unit } else { Roots::UnitDivisor });
        },
    )
    .with(Values::Only(&[0.0, 1.0])),
];
