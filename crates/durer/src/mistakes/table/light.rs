//! Mistakes of local light: ambient, diffuse, highlights, lamps, shadows, sums.

use super::{Mistake, Values, row};
use crate::light::Light;
use crate::math::{Color, Vec3};
use crate::mistakes::habits::{Ambient, Cosine, Fading, Half, PointLamp, ShadowWay, Sum};
use crate::world::HighlightModel;

pub(super) const MISTAKES: &[Mistake] = &[
    row(
        "no-ambient",
        "diffuse",
        "the ambient light is missing",
        "color = ambient * kd; for each light color += ...",
        "color = 0; for each light color += ...",
        |v, _| v.world.ambient = Color::ZERO,
    ),
    row(
        "ambient-each-light",
        "diffuse",
        "the ambient light is added once for each light, inside the loop",
        "color = ambient * kd; for each light color += ...",
        "for each light color += ambient * kd + ...",
        |v, _| v.habits.ambient = Ambient::EachLight,
    ),
    row(
        "ambient-bare",
        "diffuse",
        "the ambient light is added as it is, not times the diffuse colour",
        "color = ambient * kd",
        "color = ambient",
        |v, _| v.habits.ambient = Ambient::Bare,
    ),
    row(
        "ambient-textured",
        "diffuse",
        "the ambient light is multiplied with the other of texture (or noise) and diffuse colour",
        "as the year has it: ambient * texel, or ambient * diffuseColor",
        "the other one",
        |v, _| v.phongs(|phong| phong.ambient = phong.ambient.xor(Some(phong.diffuse))),
    ),
    row(
        "no-diffuse",
        "diffuse",
        "the diffuse term is missing",
        "color += kd * max(0, N.L) * I",
        "(nothing)",
        |v, _| v.habits.cosine = Cosine::None,
    ),
    row(
        "no-cosine",
        "diffuse",
        "the diffuse term is not times N.L: surfaces have their flat colour",
        "color += kd * max(0, N.L) * I",
        "color += kd * I",
        |v, _| v.habits.cosine = Cosine::One,
    ),
    row(
        "two-sided",
        "diffuse",
        "surfaces are lit from behind too: N.L without its sign",
        "max(0, dot(N, L))",
        "abs(dot(N, L))",
        |v, _| v.habits.cosine = Cosine::TwoSided,
    ),
    row(
        "not-clamped-below",
        "diffuse",
        "light from behind is taken away: negative N.L is not clamped",
        "max(0, dot(N, L))",
        "dot(N, L)",
        |v, _| v.habits.cosine = Cosine::Signed,
    ),
    row(
        "white-diffuse",
        "diffuse",
        "the diffuse term has not the surface's colour",
        "color += kd * max(0, N.L) * I",
        "color += max(0, N.L) * I",
        |v, _| {
            v.phongs(|phong| {
                (phong.diffuse, phong.texture, phong.noise) = (Color::ONE, None, None);
            });
        },
    ),
    row(
        "no-texture",
        "flat",
        "textures and noise are missing: surfaces have their diffuse colour",
        "kd = texture ? texture(u, v) : diffuseColor",
        "kd = diffuseColor",
        |v, _| v.phongs(|phong| (phong.texture, phong.noise) = (None, None)),
    ),
    row(
        "no-highlights",
        "specular",
        "the highlights (the specular term) are missing",
        "color += ks * pow(max(0, N.H), s) * I",
        "(nothing)",
        |v, _| v.phongs(|phong| phong.highlight = None),
    ),
    row(
        "highlights-added",
        "specular",
        "there are highlights, which this year's program does not have ({by R.L|by R.L, where N.L > 0|by N.H})",
        "(nothing)",
        "color += ks * pow(max(0, R.L), s) * I",
        |v, model| v.add_highlights(model),
    )
    .with(Values::Only(&[0.0, 1.0, 2.0])),
    row(
        "exponent",
        "specular",
        "the highlights' exponent is {} times what it should be",
        "pow(base, s)",
        "pow(base, {} * s)",
        |v, factor| {
            v.phongs(|phong| {
                if let Some((_, exponent, _)) = &mut phong.highlight {
                    *exponent *= factor;
                }
            });
        },
    )
    .with(Values::Numbers(&[2.0, 0.5, 4.0, 0.25, 8.0, 0.125])),
    row(
        "exponent-one",
        "specular",
        "the highlights have no exponent",
        "pow(max(0, base), s)",
        "max(0, base)",
        |v, _| {
            v.phongs(|phong| {
                if let Some((_, exponent, _)) = &mut phong.highlight {
                    *exponent = 1.0;
                }
            });
        },
    ),
    row(
        "other-model",
        "specular",
        "the highlights are of the other model: Phong's (R.L) for Blinn's (N.H), or the other way",
        "the year's: max(0, dot(N, norm(L + V))) or max(0, dot(R, L))",
        "the other",
        |v, _| v.other_highlights(),
    ),
    row(
        "highlight-cosine",
        "specular",
        "the highlights are multiplied with N.L",
        "color += ks * pow(base, s) * I",
        "color += ks * pow(base, s) * max(0, N.L) * I",
        |v, _| v.habits.highlights.times_cosine = true,
    ),
    row(
        "highlight-diffuse",
        "specular",
        "the highlights are multiplied with the diffuse colour",
        "color += (kd * N.L + ks * pow(base, s)) * I",
        "color += kd * (N.L + ks * pow(base, s)) * I",
        |v, _| v.habits.highlights.times_diffuse = true,
    ),
    row(
        "highlight-bare",
        "specular",
        "the highlights have not the specular colour: they are white, or the light's",
        "ks * pow(base, s) * I",
        "pow(base, s) * I",
        |v, _| {
            v.highlights_everywhere();
            v.habits.highlights.bare = true;
        },
    ),
    row(
        "half-sum",
        "specular",
        "the half vector H of the highlights is not normalised",
        "H = normalize(L + V)",
        "H = L + V",
        |v, _| v.habits.highlights.half = Half::Sum,
    ),
    row(
        "half-mean",
        "specular",
        "the half vector H of the highlights is halved instead of normalised",
        "H = normalize(L + V)",
        "H = (L + V) / 2",
        |v, _| v.habits.highlights.half = Half::Mean,
    ),
    row(
        "highlight-behind",
        "specular",
        "highlights on surfaces that face away from the light are shown where the year has none, or left out where it has them",
        "as the year has it: with or without `if (dot(N, L) > 0)`",
        "the other way",
        |v, _| {
            v.phongs(|phong| {
                if let Some((_, _, HighlightModel::Phong { behind })) = &mut phong.highlight {
                    *behind = !*behind;
                }
            });
        },
    ),
    row(
        "light-missing",
        "diffuse",
        "light {} (counted from 0) adds nothing",
        "for (i = 0; i < numLights; i++)",
        "a loop that leaves out light {}",
        |v, light| {
            if (light as usize) < v.world.lights.len() {
                v.world.lights.remove(light as usize);
            }
        },
    )
    .with(Values::Lights),
    row(
        "light-alone",
        "diffuse",
        "light {} (counted from 0) is the only one that adds anything",
        "for (i = 0; i < numLights; i++)",
        "only light {}",
        |v, light| {
            // Where there is one light only, it is alone anyway.
            v.world.lights = v.world.lights.get(light as usize).cloned().into_iter().collect();
        },
    )
    .with(Values::Lights),
    row(
        "last-light-only",
        "diffuse",
        "each light replaces those before it, so that only the last one is seen",
        "color += ...",
        "color = ambient * kd + ...",
        |v, seen| v.habits.sum = if seen == 0.0 { Sum::LastOnly } else { Sum::LastSeen },
    )
    .with(Values::Only(&[0.0, 1.0])),
    row(
        "white-lights",
        "diffuse",
        "the colour of the lights is not used",
        "color += (kd * N.L + ...) * I",
        "color += kd * N.L + ...",
        |v, _| recolor(v.world.lights.iter_mut(), |_| Color::ONE),
    ),
    row(
        "light-negated",
        "diffuse",
        "directional lights shine from where they should shine to: L is the direction itself",
        "L = normalize(-direction)",
        "L = normalize(direction)",
        |v, _| v.habits.lamps.negated = true,
    ),
    row(
        "light-long",
        "diffuse",
        "the direction of directional lights is not normalised",
        "L = normalize(-direction)",
        "L = -direction",
        |v, _| v.habits.lamps.long = true,
    ),
    row(
        "point-light-long",
        "diffuse",
        "the direction to point lights is not normalised",
        "L = normalize(position - p)",
        "L = position - p",
        |v, _| v.habits.lamps.long_points = true,
    ),
    row(
        "no-falloff",
        "diffuse",
        "light does not fade with distance",
        "I = color / (a0 + a1 d + a2 d^2)",
        "I = color",
        |v, _| {
            points(v.world.lights.iter_mut(), |_| None);
        },
    ),
    row(
        "falloff-linear",
        "diffuse",
        "light fades with the distance, not with its square",
        "I = color / (a0 + a1 d + a2 d^2)",
        "I = color / (a0 + a2 d)",
        |v, _| {
            points(v.world.lights.iter_mut(), |a| a.map(|a| Vec3::new(a.x, a.z + a.y, 0.0)));
        },
    ),
    row(
        "falloff-1-over-d",
        "diffuse",
        "light is divided by its distance, whatever the scene says",
        "I = color / (a0 + a1 d + a2 d^2)",
        "I = color / d",
        |v, _| v.habits.lamps.fading = Fading::Linear,
    ),
    row(
        "falloff-1-over-d2",
        "diffuse",
        "light is divided by the square of its distance, whatever the scene says",
        "I = color / (a0 + a1 d + a2 d^2)",
        "I = color / (d * d)",
        |v, _| v.habits.lamps.fading = Fading::Square,
    ),
    row(
        "falloff-multiplied",
        "diffuse",
        "light grows with distance: the falloff is multiplied, not divided by",
        "I = color / (a0 + a1 d + a2 d^2)",
        "I = color * (a0 + a1 d + a2 d^2)",
        |v, _| v.habits.lamps.fading = Fading::Multiplied,
    ),
    row(
        "falloff-without-one",
        "diffuse",
        "the falloff's constant is left out",
        "I = color / (1 + f d^2)",
        "I = color / (f d^2)",
        |v, _| {
            points(v.world.lights.iter_mut(), |a| a.map(|a| Vec3::new(0.0, a.y, a.z)));
        },
    ),
    row(
        "falloff-with-one",
        "diffuse",
        "1 is added to the falloff",
        "I = color / (f d^2)",
        "I = color / (1 + f d^2)",
        |v, _| {
            points(v.world.lights.iter_mut(), |a| a.map(|a| Vec3::new(a.x + 1.0, a.y, a.z)));
        },
    ),
    row(
        "falloff-reversed",
        "diffuse",
        "the three factors of the attenuation are taken in the wrong order",
        "color / (a0 + a1 d + a2 d^2)",
        "color / (a2 + a1 d + a0 d^2)",
        |v, _| {
            points(v.world.lights.iter_mut(), |a| a.map(|a| Vec3::new(a.z, a.y, a.x)));
        },
    ),
    row("no-shadows", "shadows", "there are no shadows", "if (occluded(p, L, d)) continue", "(nothing)", |v, _| {
        v.settings.shadows = false
    }),
    row(
        "shadows-added",
        "shadows",
        "there are shadows, which this picture should not have",
        "(nothing, without -shadows)",
        "if (occluded(p, L, d)) continue",
        |v, _| v.settings.shadows = true,
    ),
    row(
        "shadows-endless",
        "shadows",
        "shadow rays do not end at the light: what is behind it blocks it too",
        "occluded if hit at eps < t < distance to the light",
        "occluded if hit at t > eps",
        |v, _| v.habits.shadows.endless = true,
    ),
    row(
        "shadows-ambient",
        "shadows",
        "in shadow the ambient light is missing too",
        "color = ambient * kd; if (!occluded) color += ...",
        "if (!occluded) color += ambient * kd + ...",
        |v, _| v.habits.shadows.ambient_too = true,
    ),
    row(
        "shadows-later",
        "shadows",
        "where one light is blocked, all lights after it are missing too",
        "if (occluded) continue",
        "if (occluded) break",
        |v, _| v.habits.shadows.later_too = true,
    ),
    row(
        "shadows-black",
        "shadows",
        "where one light is blocked, all light is missing, the ambient light too{, but not what mirrors and glass bring|, and what mirrors and glass bring}",
        "if (occluded) continue",
        "if (occluded) return black",
        |v, all| v.habits.shadows.black = Some(all > 0.0),
    )
    .with(Values::Only(&[0.0, 1.0])),
    row(
        "shadows-weak",
        "shadows",
        "in its shadow a light still counts for {} of what it gives",
        "if (occluded) continue",
        "if (occluded) I *= {}",
        |v, left| v.habits.shadows.left = left,
    )
    .with(Values::Numbers(&[0.5, 0.2])),
    row(
        "lights-mean",
        "diffuse",
        "the sum over the lights is divided by their number",
        "for each light color += ...",
        "color / number of lights",
        |v, _| {
            let count = v.world.lights.len().max(1) as f32;
            recolor(v.world.lights.iter_mut(), |color| color / count);
        },
    ),
    row(
        "eye-negated",
        "specular",
        "the direction to the eye has the wrong sign in the highlights",
        "V = -d: H = normalize(L - d), R.L with R = d - 2 (d.N) N",
        "V = d: H = normalize(L + d), R = 2 (d.N) N - d",
        |v, _| v.habits.highlights.eye_negated = true,
    ),
    row(
        "shadows-epsilon",
        "epsilon",
        "the epsilon of shadow rays is far too large: {}",
        "occluded if hit at t > 1e-4",
        "occluded if hit at t > {}",
        |v, epsilon| v.habits.shadows.epsilon = Some(epsilon),
    )
    .with(Values::Numbers(&[0.1, 0.5, 0.02, 1.0, 2.0])),
    row(
        "shadows-transparent",
        "shadows",
        "things of glass cast coloured shadows, or full ones where they should not",
        "as asked for",
        "the other way",
        |v, _| v.settings.transparent_shadows = !v.settings.transparent_shadows,
    ),
    row(
        "clamped-each-light",
        "diffuse",
        "the colour is clamped to 1 after each light",
        "sum all, clamp once when the pixel is written",
        "for each light color = min(1, color + ...)",
        |v, _| v.habits.sum = Sum::ClampedEach,
    ),
    row(
        "clamped-before-bounces",
        "reflection",
        "the local colour is clamped to 1 before mirrored and transmitted light is added",
        "clamp once when the pixel is written",
        "color = min(1, local) + kr * trace(R)",
        |v, _| v.habits.sum = Sum::ClampedLocal,
    ),
    row(
        "cosine-squared",
        "diffuse",
        "N.L is squared in the diffuse term",
        "color += kd * max(0, N.L) * I",
        "color += kd * pow(max(0, N.L), 2) * I",
        |v, _| v.habits.cosine = Cosine::Squared,
    ),
    row(
        "cosine-half",
        "diffuse",
        "the diffuse term goes around to the dark side: (N.L + 1) / 2",
        "color += kd * max(0, N.L) * I",
        "color += kd * (0.5 * N.L + 0.5) * I",
        |v, _| v.habits.cosine = Cosine::Half,
    ),
    row(
        "cosine-step",
        "diffuse",
        "the diffuse term is all or nothing: 1 where N.L > 0",
        "color += kd * max(0, N.L) * I",
        "if (N.L > 0) color += kd * I",
        |v, _| v.habits.cosine = Cosine::Step,
    ),
    row(
        "diffuse-over-pi",
        "diffuse",
        "the diffuse term is divided by pi, which this year's light is not",
        "color += kd * max(0, N.L) * I",
        "color += kd / pi * max(0, N.L) * I",
        |v, _| v.habits.cosine = Cosine::OverPi,
    ),
    row(
        "highlight-two-sided",
        "specular",
        "the highlights have lost the sign of their base: there is one on the other side too",
        "pow(max(0, base), s)",
        "pow(abs(base), s)",
        |v, _| v.habits.highlights.two_sided = true,
    ),
    row(
        "highlight-lightless",
        "specular",
        "the highlights are not multiplied with the light's colour",
        "color += ks * pow(base, s) * I",
        "color += ks * pow(base, s)",
        |v, _| v.habits.highlights.lightless = true,
    ),
    row(
        "highlight-white",
        "specular",
        "the specular colour is ignored: what has one has white highlights",
        "ks * pow(base, s) * I, ks * trace(R)",
        "pow(base, s) * I, trace(R)",
        |v, _| {
            v.phongs(|phong| {
                if let Some((color, ..)) = &mut phong.highlight {
                    *color = Color::ONE;
                }
            });
        },
    ),
    row(
        "specular-white",
        "specular",
        "the specular colour is ignored, in highlights and in mirrors: both are white",
        "ks * pow(base, s) * I + ks * trace(R)",
        "pow(base, s) * I + trace(R)",
        |v, _| {
            v.phongs(|phong| {
                if let Some((color, ..)) = &mut phong.highlight {
                    *color = Color::ONE;
                }
                if phong.reflective != Color::ZERO {
                    phong.reflective = Color::ONE;
                }
            });
        },
    ),
    row(
        "highlight-everywhere",
        "specular",
        "there are highlights on surfaces that face away from the light",
        "if (dot(N, L) > 0) color += ks * pow(max(0, N.H), s) * I",
        "color += ks * pow(max(0, N.H), s) * I",
        |v, _| v.habits.highlights.everywhere = true,
    ),
    row(
        "point-light-negated",
        "diffuse",
        "the direction to point lights has the wrong sign",
        "L = normalize(position - p)",
        "L = normalize(p - position)",
        |v, _| v.habits.lamps.points = PointLamp::Negated,
    ),
    row(
        "point-light-position",
        "diffuse",
        "the position of point lights is taken as a direction{|, and negated}",
        "L = normalize(position - p)",
        "L = normalize(position)",
        |v, sign| v.habits.lamps.points = if sign == 0.0 { PointLamp::Position } else { PointLamp::MinusPosition },
    )
    .with(Values::Only(&[0.0, 1.0])),
    row(
        "falloff-root",
        "diffuse",
        "light is divided by the root of its falloff",
        "I = color / (a0 + a1 d + a2 d^2)",
        "I = color / sqrt(a0 + a1 d + a2 d^2)",
        |v, _| v.habits.lamps.fading = Fading::Root,
    ),
    row(
        "shadows-ambient-any",
        "shadows",
        "where any light is blocked the ambient light is missing too",
        "color = ambient * kd; if (!occluded) color += ...",
        "if (occluded) the ambient light is taken away, or never added",
        |v, _| v.habits.shadows.ambient_of_any = true,
    ),
    row(
        "shadows-of-one-light",
        "shadows",
        "only light {} (counted from 0) casts shadows",
        "for each light if (occluded) continue",
        "a shadow ray for light {} alone",
        |v, light| {
            if v.world.lights.len() > 1 {
                v.habits.shadows.only_light = Some(light as usize);
            }
        },
    )
    .with(Values::Lights),
    row(
        "shadows-away",
        "shadows",
        "shadow rays go away from the light",
        "Ray(p, L)",
        "Ray(p, -L)",
        |v, _| v.habits.shadows.way = ShadowWay::Away,
    ),
    row(
        "shadows-along-normal",
        "shadows",
        "shadow rays go along the normal, not to the light",
        "Ray(p, L)",
        "Ray(p, N)",
        |v, _| v.habits.shadows.way = ShadowWay::Normal,
    ),
    row(
        "shadows-not-of-glass",
        "shadows",
        "things that let light through cast no shadow",
        "occluded by any hit",
        "occluded by hits that are not transparent",
        |v, _| v.habits.shadows.no_glass = true,
    ),
    row(
        "ambient-factor",
        "diffuse",
        "the ambient light counts {} times",
        "color = ambient * kd",
        "color = {} * ambient * kd",
        |v, factor| v.world.ambient *= factor,
    )
    .with(Values::Numbers(&[0.5, 2.0])),
    row(
        "diffuse-factor",
        "diffuse",
        "the lights count {} times",
        "color += (kd * N.L + ks * ...) * I",
        "color += {} * (kd * N.L + ks * ...) * I",
        |v, factor| recolor(v.world.lights.iter_mut(), |color| color * factor),
    )
    .with(Values::Numbers(&[0.5, 0.8, 2.0])),
];

fn recolor<'l>(lights: impl Iterator<Item = &'l mut Light>, change: impl Fn(Color) -> Color) {
    lights.for_each(|light| match light {
        Light::Directional(light) => light.color = change(light.color),
        Light::Point(light) => light.color = change(light.color),
        Light::Spot(light) => light.color = change(light.color),
        Light::Photometric(light) => light.color = change(light.color),
    });
}

/// Changes the three factors of the point lights' attenuation.
fn points<'l>(lights: impl Iterator<Item = &'l mut Light>, change: impl Fn(Option<Vec3>) -> Option<Vec3>) {
    lights.for_each(|light| {
        if let Light::Point(light) = light {
            light.attenuation = change(light.attenuation);
        }
    });
}
