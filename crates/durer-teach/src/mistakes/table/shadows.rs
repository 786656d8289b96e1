//! Mistakes in shadow rays.

use super::{Mistake, Values, row};
use crate::mistakes::bugs::{ShadowDirection, ShadowRayEnd};
use crate::mistakes::variant::{CourseShape, course_shape};
use durer_scene::dialect::Quirk;
use glam::DAffine3;

/// Common mistakes in shadow rays.
pub(super) const MISTAKES: &[Mistake] = &[
    row("no-shadows", "shadows", "there are no shadows", "if (occluded(p, L, d)) continue", "(nothing)", |v, _| {
        v.settings.shadows = false
    }),
    row(
        "shadows-added",
        "shadows",
        "there are shadows, although this picture should have none",
        "(nothing, without -shadows)",
        "if (occluded(p, L, d)) continue",
        |v, _| v.settings.shadows = true,
    ),
    row(
        "shadows-endless",
        "shadows",
        "shadow rays do not end at the light: objects behind it block it too",
        "occluded if hit at eps < t < distance to the light",
        "occluded if hit at t > eps",
        |v, _| v.bugs.shadows.endless = true,
    ),
    row(
        "shadows-ambient",
        "shadows",
        "in shadow the ambient light is missing too",
        "color = ambient * kd; if (!occluded) color += ...",
        "if (!occluded) color += ambient * kd + ...",
        |v, _| v.bugs.shadows.ambient_too = true,
    ),
    row(
        "shadows-later",
        "shadows",
        "if one light is blocked, all lights after it are missing too",
        "if (occluded) continue",
        "if (occluded) break",
        |v, _| v.bugs.shadows.later_too = true,
    ),
    row(
        "shadows-black",
        "shadows",
        "if one light is blocked, all direct and ambient light is missing{, but not the light from mirrors and glass|, and the light from mirrors and glass}",
        "if (occluded) continue",
        "if (occluded) return black",
        |v, all| v.bugs.shadows.black = Some(all > 0.0),
    )
    .with(Values::Only(&[0.0, 1.0])),
    row(
        "shadows-weak",
        "shadows",
        "in its shadow, a light still contributes a fraction of {}",
        "if (occluded) continue",
        "if (occluded) I *= {}",
        |v, left| v.bugs.shadows.remaining_light = left,
    )
    .with(Values::Numbers(&[0.5, 0.2])),
    row(
        "shadows-transparent",
        "shadows",
        "glass objects cast coloured shadows instead of full ones, or the reverse",
        "as the options say",
        "the reverse",
        |v, _| v.settings.transparent_shadows = !v.settings.transparent_shadows,
    ),
    row(
        "shadows-ambient-any",
        "shadows",
        "if any light is blocked, the ambient light is missing too",
        "color = ambient * kd; if (!occluded) color += ...",
        "if (occluded) the ambient light is subtracted, or never added",
        |v, _| v.bugs.shadows.ambient_of_any = true,
    ),
    row(
        "shadows-of-one-light",
        "shadows",
        "only light {} (counted from 0) casts shadows",
        "for each light if (occluded) continue",
        "a shadow ray for light {} only",
        |v, light| {
            if v.world.lights().len() > 1 {
                v.bugs.shadows.only_light = Some(light as usize);
            }
        },
    )
    .with(Values::Lights),
    row(
        "shadows-away",
        "shadows",
        "shadow rays point away from the light",
        "Ray(p, L)",
        "Ray(p, -L)",
        |v, _| v.bugs.shadows.direction = ShadowDirection::Away,
    ),
    row(
        "shadows-along-normal",
        "shadows",
        "shadow rays follow the normal instead of pointing to the light",
        "Ray(p, L)",
        "Ray(p, N)",
        |v, _| v.bugs.shadows.direction = ShadowDirection::Normal,
    ),
    row(
        "shadows-not-of-glass",
        "shadows",
        "transparent objects cast no shadow",
        "occluded by any hit",
        "occluded by hits that are not transparent",
        |v, _| v.bugs.shadows.no_glass = true,
    ),
    row(
        "shadow-fronts",
        "shadows",
        "surfaces that face away from the light block it although they should not, or the reverse",
        "as in the scene's dialect: blocked by any hit, or only if dot(N, L) <= 0 at the nearest",
        "the other",
        |v, _| v.toggle(Quirk::ShadowFronts),
    ),
    row(
        "shadows-inverted",
        "shadows",
        "light is added where it is blocked instead of where it arrives",
        "if (!occluded) color += ...",
        "if (occluded) color += ...",
        |v, _| v.bugs.shadows.inverted = true,
    ),
    row(
        "shadows-short",
        "shadows",
        "shadow rays to directional lights end at distance 1",
        "directional: t_max = infinity",
        "t_max = length(L) = 1",
        |v, _| v.bugs.shadows.short = true,
    ),
    row(
        "shadows-reach",
        "shadows",
        "shadow rays to point lights end {at distance 1|behind the light, because L is not normalised but t ends at \
         the distance}",
        "occluded if hit at eps < t < distance to the light",
        "{t < 1 with L = normalize(position - p)|t < distance with L = position - p}",
        |v, squared| v.bugs.shadows.ray_end = if squared == 0.0 { ShadowRayEnd::One } else { ShadowRayEnd::Squared },
    )
    .with(Values::Only(&[0.0, 1.0])),
    row(
        "shadows-from-eye",
        "shadows",
        "shadow rays start at the eye, not at the surface",
        "Ray(p, L)",
        "Ray(eye, L)",
        |v, _| v.bugs.shadows.from_eye = true,
    ),
    row(
        "shadows-untransformed",
        "transforms",
        "shadow rays ignore transforms",
        "shadow rays to object space by M^-1",
        "shadow rays unchanged",
        |v, _| v.change_shadow_world(|v| v.set_transforms(&|_, _| DAffine3::IDENTITY)),
    ),
    row(
        "shadows-of-spheres",
        "shadows",
        "only {spheres|planes|triangles} cast shadows",
        "occluded by any object",
        "occluded by {spheres|planes|triangles} only",
        |v, kind| {
            v.change_shadow_world(|v| {
                v.world.edit().objects.retain(|object| match course_shape(&object.geometry) {
                    Some(CourseShape::Sphere) => kind == 0.0,
                    Some(CourseShape::Plane) => kind == 1.0,
                    Some(CourseShape::Triangle | CourseShape::Mesh) => kind == 2.0,
                    None => false,
                });
                v.objects(|_| {});
            });
        },
    )
    .with(Values::Only(&[0.0, 1.0, 2.0])),
    row(
        "shadows-of-one-object",
        "shadows",
        "only the {first|last} object in the file casts shadows",
        "for each object if (object.intersect(...)) return true",
        "for each object {return object.intersect(...)|occluded = object.intersect(...)}",
        |v, last| {
            v.change_shadow_world(|v| {
                let only = if last == 0.0 { 0 } else { v.world.objects().len().saturating_sub(1) };
                let mut number = 0..;
                v.world.edit().objects.retain(|_| number.next() == Some(only));
                v.objects(|_| {});
            });
        },
    )
    .with(Values::Only(&[0.0, 1.0])),
    row(
        "shadows-diffuse",
        "shadows",
        "diffuse light remains in shadow: only highlights are missing",
        "if (!occluded) color += diffuse + specular",
        "color += diffuse; if (!occluded) color += specular",
        |v, _| v.bugs.shadows.diffuse_left = true,
    ),
    row(
        "shadows-highlights",
        "shadows",
        "highlights remain in shadow",
        "if (!occluded) color += diffuse + specular",
        "color += specular; if (!occluded) color += diffuse",
        |v, _| v.bugs.shadows.highlights_left = true,
    ),
    row(
        "shadows-epsilon",
        "epsilon",
        "the epsilon of shadow rays is far too large: {}",
        "occluded if hit at t > 1e-4",
        "occluded if hit at t > {}",
        |v, epsilon| v.bugs.shadows.epsilon = Some(epsilon),
    )
    .with(Values::Numbers(&[0.1, 0.5, 0.02, 1.0, 2.0])),
];
