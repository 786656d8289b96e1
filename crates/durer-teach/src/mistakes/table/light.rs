//! Mistakes in local light, which consists of ambient and diffuse terms, lights, and their sum.

use super::{Mistake, Values, row};
use crate::mistakes::bugs::{Ambient, Attenuation, Cosine, LightSum, PointLightDirection};
use durer_scene::light::{Illuminate, Light};
use durer_scene::math::{Color, Vec3};

/// Common mistakes in local light.
pub(super) const MISTAKES: &[Mistake] = &[
    row(
        "no-ambient",
        "diffuse",
        "the ambient light is missing",
        "color = ambient * kd; for each light color += ...",
        "color = 0; for each light color += ...",
        |v, _| v.world.edit().ambient = Color::ZERO,
    ),
    row(
        "ambient-each-light",
        "diffuse",
        "the ambient light is added once per light, inside the loop",
        "color = ambient * kd; for each light color += ...",
        "for each light color += ambient * kd + ...",
        |v, _| v.bugs.ambient = Ambient::EachLight,
    ),
    row(
        "ambient-bare",
        "diffuse",
        "the ambient light is not multiplied by the diffuse colour",
        "color = ambient * kd",
        "color = ambient",
        |v, _| v.bugs.ambient = Ambient::Bare,
    ),
    row(
        "ambient-textured",
        "diffuse",
        "the ambient light is multiplied by the texture (or noise) instead of the diffuse colour, or vice versa",
        "as in the scene's dialect: ambient * texel, or ambient * diffuseColor",
        "the other one",
        |v, _| v.phongs(|phong| phong.ambient = phong.ambient.xor(Some(phong.diffuse))),
    ),
    row(
        "no-diffuse",
        "diffuse",
        "the diffuse term is missing",
        "color += kd * max(0, N.L) * I",
        "(nothing)",
        |v, _| v.bugs.cosine = Cosine::None,
    ),
    row(
        "no-cosine",
        "diffuse",
        "the diffuse term is not multiplied by N.L: surfaces have a flat colour",
        "color += kd * max(0, N.L) * I",
        "color += kd * I",
        |v, _| v.bugs.cosine = Cosine::One,
    ),
    row(
        "two-sided",
        "diffuse",
        "surfaces are lit from behind too: the sign of N.L is ignored",
        "max(0, dot(N, L))",
        "abs(dot(N, L))",
        |v, _| v.bugs.cosine = Cosine::TwoSided,
    ),
    row(
        "not-clamped-below",
        "diffuse",
        "light from behind is subtracted: negative N.L is not clamped",
        "max(0, dot(N, L))",
        "dot(N, L)",
        |v, _| v.bugs.cosine = Cosine::Signed,
    ),
    row(
        "white-diffuse",
        "diffuse",
        "the {diffuse term is|diffuse and ambient terms are} not multiplied by the surface's colour",
        "color += kd * max(0, N.L) * I",
        "color += max(0, N.L) * I",
        |v, which| {
            v.bugs.plain_diffuse = true;
            if which > 0.0 {
                v.phongs(|phong| (phong.diffuse, phong.texture, phong.noise) = (Color::ONE, None, None));
            }
        },
    )
    .with(Values::Only(&[0.0, 1.0])),
    row(
        "diffuse-lightless",
        "diffuse",
        "the diffuse term is not multiplied by the light's colour",
        "color += kd * max(0, N.L) * I",
        "color += kd * max(0, N.L)",
        |v, _| v.bugs.diffuse_lightless = true,
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
        "background",
        "flat",
        "{rays of the camera that hit|rays that hit|rays of the camera that hit|rays that hit} nothing are {black|black|white|white} instead of the background's colour",
        "if (!hit) return background",
        "if (!hit) return {0|0|1|1}",
        |v, how| {
            let color = if how < 2.0 { Color::ZERO } else { Color::ONE };
            v.bugs.sky = Some((color, how % 2.0 > 0.0));
        },
    )
    .with(Values::Only(&[0.0, 1.0, 2.0, 3.0])),
    row(
        "ambient-sky",
        "flat",
        "the ambient light is added to the background",
        "if (!hit) return background",
        "if (!hit) return background + ambient",
        |v, _| v.bugs.ambient_sky = true,
    ),
    row(
        "light-missing",
        "diffuse",
        "light {} (counted from 0) contributes nothing",
        "for (i = 0; i < numLights; i++)",
        "a loop that leaves out light {}",
        |v, light| {
            if (light as usize) < v.world.lights().len() {
                v.world.edit().lights.remove(light as usize);
            }
        },
    )
    .with(Values::Lights),
    row(
        "light-alone",
        "diffuse",
        "light {} (counted from 0) is the only one that contributes",
        "for (i = 0; i < numLights; i++)",
        "only light {}",
        |v, light| {
            // If there is a single light, this mistake changes nothing.
            v.world.edit().lights = v.world.lights().get(light as usize).cloned().into_iter().collect();
        },
    )
    .with(Values::Lights),
    row(
        "light-colors-equal",
        "diffuse",
        "all lights have the colour of the {first|last} one",
        "I = lights[i].color",
        "I = lights[{0|n - 1}].color",
        |v, last| {
            let lights = v.world.lights();
            let chosen = if last == 0.0 { lights.first() } else { lights.last() };
            let Some(color) = chosen.map(Illuminate::color) else { return };
            recolor(v.world.edit().lights.iter_mut(), |_| color);
        },
    )
    .with(Values::Only(&[0.0, 1.0])),
    row(
        "unlit",
        "diffuse",
        "surfaces have their diffuse colour, without any light",
        "color = ambient * kd; for each light color += ...",
        "color = kd",
        |v, _| v.bugs.unlit = true,
    ),
    row(
        "last-light-only",
        "diffuse",
        "each light replaces the lights before it, so only the last light is visible",
        "color += ...",
        "color = ambient * kd + ...",
        |v, seen| v.bugs.sum = if seen == 0.0 { LightSum::LastOnly } else { LightSum::LastUnoccluded },
    )
    .with(Values::Only(&[0.0, 1.0])),
    row(
        "white-lights",
        "diffuse",
        "{the colour of the lights is not used|lights emit the grey of their colours}",
        "color += (kd * N.L + ...) * I",
        "color += (kd * N.L + ...) * {1|(I.r + I.g + I.b) / 3}",
        |v, grey| {
            let of = |color: Color| if grey > 0.0 { Color::splat(color.element_sum() / 3.0) } else { Color::ONE };
            recolor(v.world.edit().lights.iter_mut(), of);
        },
    )
    .with(Values::Only(&[0.0, 1.0])),
    row(
        "lights-negated",
        "diffuse",
        "the direction to every light has the wrong sign, and shadow rays use it too",
        "L = normalize(position - p), or normalize(-direction)",
        "L = normalize(p - position), or normalize(direction)",
        |v, _| v.bugs.lights.all_negated = true,
    ),
    row(
        "light-negated",
        "diffuse",
        "directional lights shine from the opposite side: L is the direction itself",
        "L = normalize(-direction)",
        "L = normalize(direction)",
        |v, _| v.bugs.lights.negated = true,
    ),
    row(
        "point-light-negated",
        "diffuse",
        "the direction to point lights has the wrong sign",
        "L = normalize(position - p)",
        "L = normalize(p - position)",
        |v, _| v.bugs.lights.points = PointLightDirection::Negated,
    ),
    row(
        "light-long",
        "diffuse",
        "the direction of directional lights is not normalised",
        "L = normalize(-direction)",
        "L = -direction",
        |v, _| v.bugs.lights.long = true,
    ),
    row(
        "point-light-long",
        "diffuse",
        "the direction to point lights is not normalised",
        "L = normalize(position - p)",
        "L = position - p",
        |v, _| v.bugs.lights.long_points = true,
    ),
    row(
        "no-falloff",
        "diffuse",
        "light does not fade with distance",
        "I = color / (a0 + a1 d + a2 d^2)",
        "I = color",
        |v, _| {
            points(v.world.edit().lights.iter_mut(), |_| None);
        },
    ),
    row(
        "falloff-of-one-term",
        "diffuse",
        "{the diffuse term does|highlights do} not fade with distance",
        "I = color / (a0 + a1 d + a2 d^2), for both terms",
        "{color += kd * max(0, N.L) * color of the light|color += ks * pow(base, s) * color of the light}",
        |v, highlights| v.bugs.lights.unfaded = Some(highlights > 0.0),
    )
    .with(Values::Only(&[0.0, 1.0])),
    row(
        "falloff-linear",
        "diffuse",
        "light fades with the distance instead of its square",
        "I = color / (a0 + a1 d + a2 d^2)",
        "I = color / (a0 + a1 d + a2 d)",
        |v, _| {
            points(v.world.edit().lights.iter_mut(), |a| a.map(|a| Vec3::new(a.x, a.z + a.y, 0.0)));
        },
    ),
    row(
        "falloff-1-over-d",
        "diffuse",
        "light is divided by its distance, regardless of the scene",
        "I = color / (a0 + a1 d + a2 d^2)",
        "I = color / d",
        |v, _| v.bugs.lights.attenuation = Attenuation::Linear,
    ),
    row(
        "falloff-1-over-d2",
        "diffuse",
        "light is divided by the square of its distance, regardless of the scene",
        "I = color / (a0 + a1 d + a2 d^2)",
        "I = color / (d * d)",
        |v, _| v.bugs.lights.attenuation = Attenuation::Square,
    ),
    row(
        "falloff-multiplied",
        "diffuse",
        "light increases with distance: it is multiplied by the falloff instead of divided",
        "I = color / (a0 + a1 d + a2 d^2)",
        "I = color * (a0 + a1 d + a2 d^2)",
        |v, _| v.bugs.lights.attenuation = Attenuation::Multiplied,
    ),
    row(
        "falloff-without-one",
        "diffuse",
        "the falloff's constant is left out",
        "I = color / (a0 + a1 d + a2 d^2)",
        "the same formula without its constant",
        |v, _| {
            points(v.world.edit().lights.iter_mut(), |a| a.map(|a| Vec3::new(0.0, a.y, a.z)));
        },
    ),
    row(
        "falloff-with-one",
        "diffuse",
        "1 is added to the falloff",
        "I = color / (a0 + a1 d + a2 d^2)",
        "I = color / (1 + a0 + a1 d + a2 d^2)",
        |v, _| {
            points(v.world.edit().lights.iter_mut(), |a| a.map(|a| Vec3::new(a.x + 1.0, a.y, a.z)));
        },
    ),
    row(
        "falloff-reversed",
        "diffuse",
        "the three attenuation coefficients are in the wrong order",
        "color / (a0 + a1 d + a2 d^2)",
        "color / (a2 + a1 d + a0 d^2)",
        |v, _| {
            if v.has_three_factors() {
                points(v.world.edit().lights.iter_mut(), |a| a.map(|a| Vec3::new(a.z, a.y, a.x)));
            }
        },
    ),
    row(
        "attenuation-factors",
        "diffuse",
        "of the three attenuation coefficients, {the linear and the quadratic one are swapped|the constant one is \
         taken as 1|only the quadratic one is used|the linear one is left out|the quadratic one is left out|only \
         the linear one is used}",
        "I = color / (a0 + a1 d + a2 d^2)",
        "I = color / ({a0 + a2 d + a1 d^2|1 + a1 d + a2 d^2|a2 d^2|a0 + a2 d^2|a0 + a1 d|a1 d})",
        |v, how| {
            let change: fn(Vec3) -> Vec3 = match how as u32 {
                0 => |a| Vec3::new(a.x, a.z, a.y),
                1 => |a| Vec3::new(1.0, a.y, a.z),
                2 => |a| Vec3::new(0.0, 0.0, a.z),
                3 => |a| Vec3::new(a.x, 0.0, a.z),
                4 => |a| Vec3::new(a.x, a.y, 0.0),
                _ => |a| Vec3::new(0.0, a.y, 0.0),
            };
            // A single falloff coefficient has table rows of its own.
            if v.has_three_factors() {
                points(v.world.edit().lights.iter_mut(), |a| a.map(change));
            }
        },
    )
    .with(Values::Only(&[0.0, 1.0, 2.0, 3.0, 4.0, 5.0])),
    row(
        "lights-mean",
        "diffuse",
        "the sum over the lights is divided by their number",
        "for each light color += ...",
        "color / number of lights",
        |v, _| {
            let count = v.world.lights().len().max(1) as f32;
            recolor(v.world.edit().lights.iter_mut(), |color| color / count);
        },
    ),
    row(
        "clamped-before-bounces",
        "reflection",
        "the local colour is clamped to 1 before mirrored and transmitted light is added",
        "clamp once when the pixel is written",
        "color = min(1, local) + kr * trace(R)",
        |v, _| v.bugs.sum = LightSum::ClampedLocal,
    ),
    row(
        "clamped-light",
        "diffuse",
        "the contribution of each light is clamped to 1",
        "sum all, clamp once when the pixel is written",
        "for each light color += min(1, ...)",
        |v, _| v.bugs.sum = LightSum::ClampedLight,
    ),
    row(
        "clamped-rays",
        "reflection",
        "the colour that each ray returns is clamped to 1",
        "clamp once when the pixel is written",
        "trace(ray) returns min(1, color)",
        |v, _| v.bugs.clamped_rays = true,
    ),
    row(
        "clamped-each-light",
        "diffuse",
        "the colour is clamped to 1 after each light",
        "sum all, clamp once when the pixel is written",
        "for each light color = min(1, color + ...)",
        |v, _| v.bugs.sum = LightSum::ClampedEach,
    ),
    row(
        "cosine-squared",
        "diffuse",
        "N.L is squared in the diffuse term",
        "color += kd * max(0, N.L) * I",
        "color += kd * pow(max(0, N.L), 2) * I",
        |v, _| v.bugs.cosine = Cosine::Squared,
    ),
    row(
        "cosine-half",
        "diffuse",
        "the diffuse term extends to the dark side: (N.L + 1) / 2",
        "color += kd * max(0, N.L) * I",
        "color += kd * (0.5 * N.L + 0.5) * I",
        |v, _| v.bugs.cosine = Cosine::Half,
    ),
    row(
        "cosine-step",
        "diffuse",
        "the diffuse term is either 0 or 1: it is 1 where N.L > 0",
        "color += kd * max(0, N.L) * I",
        "if (N.L > 0) color += kd * I",
        |v, _| v.bugs.cosine = Cosine::Step,
    ),
    row(
        "cosine-of-view",
        "diffuse",
        "the diffuse term uses N.V, with the direction to the eye, instead of N.L",
        "color += kd * max(0, N.L) * I",
        "color += kd * max(0, N.V) * I",
        |v, _| v.bugs.cosine = Cosine::View,
    ),
    row(
        "diffuse-twice",
        "diffuse",
        "the diffuse colour is applied twice{ in the diffuse term|, in the ambient term too}",
        "color += kd * max(0, N.L) * I",
        "color += kd * kd * max(0, N.L) * I",
        |v, ambient| match ambient == 0.0 {
            true => v.bugs.diffuse_twice = true,
            false => v.phongs(|phong| phong.diffuse *= phong.diffuse),
        },
    )
    .with(Values::Only(&[0.0, 1.0])),
    row(
        "greatest-light",
        "diffuse",
        "the maximum of the lights is used instead of their sum{|, including the ambient light}",
        "for each light color += ...",
        "for each light color = max(color, ...)",
        |v, all| v.bugs.sum = if all == 0.0 { LightSum::Greatest } else { LightSum::GreatestOfAll },
    )
    .with(Values::Only(&[0.0, 1.0])),
    row(
        "point-light-from-eye",
        "diffuse",
        "the direction to point lights is taken from the eye, not from the surface{|, and their distance too}",
        "L = normalize(position - p)",
        "L = normalize(position - eye)",
        |v, all| v.bugs.lights.points = PointLightDirection::FromEye(all > 0.0),
    )
    .with(Values::Only(&[0.0, 1.0])),
    row(
        "diffuse-over-pi",
        "diffuse",
        "the diffuse term is divided by pi, unlike in the scene's dialect",
        "color += kd * max(0, N.L) * I",
        "color += kd / pi * max(0, N.L) * I",
        |v, _| v.bugs.cosine = Cosine::OverPi,
    ),
    row(
        "point-light-position",
        "diffuse",
        "the position of point lights is used as a direction{|, and negated|, and its length as the distance}",
        "L = normalize(position - p)",
        "L = normalize({position|-position|position}){||, d = length(position)}",
        |v, how| {
            v.bugs.lights.points =
                [PointLightDirection::Position, PointLightDirection::MinusPosition, PointLightDirection::PositionAlone][(how as usize).min(2)];
        },
    )
    .with(Values::Only(&[0.0, 1.0, 2.0])),
    row(
        "falloff-root",
        "diffuse",
        "light is divided by the square root of its falloff",
        "I = color / (a0 + a1 d + a2 d^2)",
        "I = color / sqrt(a0 + a1 d + a2 d^2)",
        |v, _| v.bugs.lights.attenuation = Attenuation::Root,
    ),
    row(
        "falloff-squared-twice",
        "diffuse",
        "the distance is squared twice before light is divided by it",
        "I = color / (a0 + a1 d + a2 d^2)",
        "d = dot(v, v), I = color / (a0 + a1 d + a2 d^2)",
        |v, _| v.bugs.lights.attenuation = Attenuation::SquaredTwice,
    ),
    row(
        "falloff-of-other-length",
        "diffuse",
        "light fades with {the length of the ray that hits the surface|the distance from the eye to the light} instead \
         of the distance to the light",
        "I = color / (a0 + a1 d + a2 d^2) with d = length(position - p)",
        "the same formula with d = {t of the ray|length(position - eye)}",
        |v, eye| v.bugs.lights.attenuation = if eye == 0.0 { Attenuation::RayLength } else { Attenuation::FromEye },
    )
    .with(Values::Only(&[0.0, 1.0])),
    row(
        "ambient-factor",
        "diffuse",
        "the ambient light is multiplied by {}",
        "color = ambient * kd",
        "color = {} * ambient * kd",
        |v, factor| v.world.edit().ambient *= factor,
    )
    .with(Values::Numbers(&[0.1, 0.5, 2.0])),
    row(
        "diffuse-term-factor",
        "diffuse",
        "the diffuse term is multiplied by {}",
        "color += kd * max(0, N.L) * I",
        "color += {} * kd * max(0, N.L) * I",
        |v, factor| v.bugs.diffuse_factor = Some(factor),
    )
    .with(Values::Numbers(&[0.5, 0.9, 2.0])),
    row(
        "diffuse-factor",
        "diffuse",
        "the lights are multiplied by {}",
        "color += (kd * N.L + ks * ...) * I",
        "color += {} * (kd * N.L + ks * ...) * I",
        |v, factor| recolor(v.world.edit().lights.iter_mut(), |color| color * factor),
    )
    .with(Values::Numbers(&[0.5, 0.8, 2.0])),
];

fn recolor<'l>(lights: impl Iterator<Item = &'l mut Light>, change: impl Fn(Color) -> Color) {
    lights.for_each(|light| light.recolor(&change));
}

/// Changes the attenuation coefficients of the point lights.
fn points<'l>(lights: impl Iterator<Item = &'l mut Light>, change: impl Fn(Option<Vec3>) -> Option<Vec3>) {
    lights.for_each(|light| {
        if let Light::Point(light) = light {
            light.attenuation = change(light.attenuation);
        }
    });
}
