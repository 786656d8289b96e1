//! Mistakes of mirrors and glass.

use super::{Mistake, Values, row};
use crate::mistakes::bugs::{Fresnel, Glass, Mirror, TotalReflection};
use durer_scene::math::Color;

/// Common mistakes in reflection and refraction.
pub(super) const MISTAKES: &[Mistake] = &[
    row(
        "no-reflection",
        "reflection",
        "reflections are missing",
        "color += kr * trace(p, R, bounces - 1)",
        "(nothing)",
        |v, divided| if divided == 0.0 { v.settings.reflection = false } else { v.bugs.bounces.no_mirror = true },
    )
    .with(Values::Only(&[0.0, 1.0])),
    row(
        "no-refraction",
        "refraction",
        "glass is opaque: the transmitted ray is missing",
        "color += kt * trace(p, T, bounces - 1)",
        "(nothing)",
        |v, divided| if divided == 0.0 { v.settings.refraction = false } else { v.bugs.bounces.no_glass = true },
    )
    .with(Values::Only(&[0.0, 1.0])),
    row(
        "no-bounces",
        "reflection",
        "there are no secondary rays: neither reflection nor transmission",
        "if (bounces > 0) color += ...",
        "(nothing)",
        |v, _| v.settings.bounces = 0,
    ),
    row(
        "bounce-less",
        "reflection",
        "the maximum depth is {one level|two levels} too small",
        "trace(ray, bounces), recursing while bounces > 0",
        "trace(ray, bounces), recursing while bounces > {1|2}",
        |v, more| v.settings.bounces = v.settings.bounces.saturating_sub(1 + more as u32),
    )
    .with(Values::Only(&[0.0, 1.0])),
    row(
        "bounce-more",
        "reflection",
        "the maximum depth is {one level|two levels} too large",
        "trace(ray, bounces), recursing while bounces > 0",
        "trace(ray, bounces), recursing while bounces >= {0|-1}",
        |v, more| v.settings.bounces += 1 + more as u32,
    )
    .with(Values::Only(&[0.0, 1.0])),
    row(
        "bounce-one",
        "reflection",
        "there is only one level of secondary rays",
        "trace(ray, bounces), and again while bounces > 0",
        "trace(ray, 1)",
        |v, _| v.settings.bounces = v.settings.bounces.min(1),
    ),
    row(
        "mirror-in-full",
        "reflection",
        "mirrored light is not multiplied by the mirror's colour",
        "color += kr * trace(p, R)",
        "color += trace(p, R)",
        |v, _| v.bugs.bounces.mirror_in_full = true,
    ),
    row(
        "glass-in-full",
        "refraction",
        "transmitted light is not multiplied by the glass's colour",
        "color += kt * trace(p, T)",
        "color += trace(p, T)",
        |v, _| v.bugs.bounces.glass_in_full = true,
    ),
    row(
        "mirror-negated",
        "reflection",
        "the mirrored direction is negated",
        "R = d - 2 (d.N) N",
        "R = 2 (d.N) N - d",
        |v, _| v.bugs.bounces.mirror = Mirror::Negated,
    ),
    row(
        "mirror-along",
        "reflection",
        "the factor 2 of the mirrored direction is missing",
        "R = d - 2 (d.N) N",
        "R = {d - (d.N) N|normalize(d - (d.N) N)}",
        |v, unit| (v.bugs.bounces.mirror, v.bugs.bounces.unit) = (Mirror::Along, unit > 0.0),
    )
    .with(Values::Only(&[0.0, 1.0])),
    row(
        "mirror-plus",
        "reflection",
        "the formula of the mirrored direction has a wrong sign",
        "R = d - 2 (d.N) N",
        "R = {d + 2 (d.N) N|normalize(d + 2 (d.N) N)}",
        |v, unit| (v.bugs.bounces.mirror, v.bugs.bounces.unit) = (Mirror::Plus, unit > 0.0),
    )
    .with(Values::Only(&[0.0, 1.0])),
    row(
        "mirror-multiple",
        "reflection",
        "the mirrored direction {is that of the ray|has the factor 4 instead of 2|has the factor 4 instead of 2|has the \
         factor 3 instead of 2|has the factor 3 instead of 2}",
        "R = d - 2 (d.N) N",
        "R = {d|d - 4 (d.N) N|normalize(d - 4 (d.N) N)|d - 3 (d.N) N|normalize(d - 3 (d.N) N)}",
        |v, how| {
            let (factor, unit) = [(0, false), (4, false), (4, true), (3, false), (3, true)][(how as usize).min(4)];
            (v.bugs.bounces.mirror, v.bugs.bounces.unit) = (Mirror::Multiple(factor), unit);
        },
    )
    .with(Values::Only(&[0.0, 1.0, 2.0, 3.0, 4.0])),
    row(
        "mirror-from-eye",
        "reflection",
        "mirrored rays start at the eye, not at the surface",
        "Ray(p, R)",
        "Ray(eye, R)",
        |v, _| v.bugs.bounces.from_eye = true,
    ),
    row(
        "mirror-one-channel",
        "reflection",
        "the {red|green|blue} of the mirror's colour is used for all channels",
        "color += kr * trace(p, R)",
        "color += kr.{r|g|b} * trace(p, R)",
        |v, channel| v.phongs(|phong| phong.reflective = Color::splat(phong.reflective[(channel as usize).min(2)])),
    )
    .with(Values::Only(&[0.0, 1.0, 2.0])),
    row(
        "secondary-no-ambient",
        "reflection",
        "the ambient light is missing in mirrors and behind glass",
        "ambient * kd at every hit",
        "ambient * kd at the first hit only",
        |v, _| v.bugs.bounces.no_ambient = true,
    ),
    row(
        "secondary-no-highlights",
        "reflection",
        "highlights are missing in mirrors and behind glass",
        "ks * pow(max(0, N.H), s) * I at every hit",
        "ks * pow(max(0, N.H), s) * I at the first hit only",
        |v, _| v.bugs.highlights.first_only = true,
    ),
    row(
        "mirror-normal",
        "reflection",
        "mirrored rays go along the normal",
        "R = d - 2 (d.N) N",
        "R = N",
        |v, _| v.bugs.bounces.mirror = Mirror::Normal,
    ),
    row(
        "secondary-each-light",
        "reflection",
        "secondary rays are added once per light, inside the loop",
        "for each light { local }; color += kr * trace(p, R)",
        "for each light { local; color += kr * trace(p, R) }",
        |v, _| v.bugs.bounces.each_light = true,
    ),
    row(
        "secondary-black-sky",
        "reflection",
        "mirrored and transmitted rays that miss return black instead of the background",
        "if (!hit) return background(d)",
        "if (!hit) return 0, for secondary rays",
        |v, _| v.bugs.bounces.black_sky = true,
    ),
    row(
        "secondary-unshadowed",
        "shadows",
        "shadows are missing in mirrors and behind glass",
        "shadow rays at every hit",
        "shadow rays at the first hit only",
        |v, _| v.bugs.bounces.unshadowed = true,
    ),
    row(
        "secondary-epsilon",
        "epsilon",
        "the epsilon of mirrored and transmitted rays is far too large: {}",
        "hits count at t > 1e-4",
        "hits count at t > {}",
        |v, epsilon| v.bugs.bounces.epsilon = Some(epsilon),
    )
    .with(Values::Numbers(&[0.1, 0.5, 1.0, 2.0])),
    row(
        "epsilon-large",
        "epsilon",
        "the epsilon of all secondary rays is far too large: {}",
        "hits count at t > 1e-4",
        "hits count at t > {}",
        |v, epsilon| {
            v.bugs.shadows.epsilon = Some(epsilon);
            v.bugs.bounces.epsilon = Some(epsilon);
        },
    )
    .with(Values::Numbers(&[0.1, 0.5, 0.02, 1.0, 2.0, 0.2, 0.3])),
    row(
        "mirror-start",
        "epsilon",
        "mirrored rays start too far above the surface: by {}",
        "Ray(p, R), hits count at t > 1e-4",
        "Ray(p + {} * N, R)",
        |v, height| v.bugs.bounces.mirror_height = height,
    )
    .with(Values::Numbers(&[0.1, 0.3, 1.0])),
    row(
        "epsilon-0",
        "epsilon",
        "rays that leave a surface hit it again (acne): the epsilon is 0 or too small",
        "hits count at t > 1e-4",
        "hits count at t > 0",
        |v, _| v.change_rules(|rules| rules.epsilon = Some(0.0)),
    ),
    row(
        "index-inverted",
        "refraction",
        "the ratio of the indices of refraction is inverted",
        "eta = n1 / n2 (from, to)",
        "eta = n2 / n1",
        |v, _| v.bugs.bounces.glass = Glass::Inverted,
    ),
    row(
        "exit-not-swapped",
        "refraction",
        "the indices are not swapped when a ray leaves the glass",
        "leaving: eta = n / 1",
        "leaving: eta = 1 / n",
        |v, _| v.bugs.bounces.glass = Glass::IndicesNotSwapped,
    ),
    row(
        "not-bent",
        "refraction",
        "rays pass straight through glass, as if its index were 1{|, except in total internal reflection}",
        "T by Snell's law",
        "T = d",
        |v, total| v.bugs.bounces.glass = if total == 0.0 { Glass::Straight } else { Glass::StraightUnlessTotal },
    )
    .with(Values::Only(&[0.0, 1.0])),
    row(
        "fresnel-constant",
        "fresnel",
        "glass reflects the same fraction at every angle: R0 instead of Schlick's formula",
        "R = R0 + (1 - R0) (1 - c)^5",
        "R = R0",
        |v, _| v.bugs.bounces.fresnel = Fresnel::Constant,
    ),
    row(
        "no-fresnel",
        "fresnel",
        "Fresnel's law is missing: the mirrored and transmitted light of glass are both added in full",
        "R * trace(R) + (1 - R) * trace(T)",
        "trace(R) + trace(T)",
        |v, _| v.bugs.bounces.fresnel = Fresnel::None,
    ),
    row(
        "fresnel-share",
        "fresnel",
        "glass reflects the same fraction of light at every angle: {}",
        "R = R0 + (1 - R0) (1 - c)^5",
        "R = {}",
        |v, share| v.bugs.bounces.fresnel = Fresnel::Share(share),
    )
    .with(Values::Only(&[0.0, 0.5, 1.0])),
    row(
        "fresnel-exchanged",
        "fresnel",
        "the mirrored and transmitted fractions of glass are swapped",
        "R * trace(R) + (1 - R) * trace(T)",
        "(1 - R) * trace(R) + R * trace(T)",
        |v, _| v.bugs.bounces.fresnel = Fresnel::Exchanged,
    ),
    row(
        "mirror-mixed",
        "reflection",
        "the local light of mirrors is scaled by 1 minus the mirror's colour",
        "local + kr * trace(p, R)",
        "(1 - kr) * local + kr * trace(p, R)",
        |v, _| v.bugs.bounces.mixed = true,
    ),
    row(
        "glass-mixed",
        "refraction",
        "the local light {of glass is|and the mirrored light of glass are} scaled by 1 minus the glass's colour",
        "local + kr * trace(p, R) + kt * trace(p, T)",
        "{(1 - kt) * local + kr * trace(p, R)|(1 - kt) * (local + kr * trace(p, R))} + kt * trace(p, T)",
        |v, mirrored| v.bugs.bounces.glass_mixed = Some(mirrored > 0.0),
    )
    .with(Values::Only(&[0.0, 1.0])),
    row(
        "mirror-instead",
        "reflection",
        "mirrored light replaces the local light of mirrors",
        "color = local + kr * trace(p, R)",
        "color = kr * trace(p, R)",
        |v, _| v.bugs.bounces.instead = true,
    ),
    row(
        "exit-not-turned",
        "refraction",
        "the normal is not flipped when a ray leaves the glass",
        "leaving: T of -N",
        "leaving: T of N",
        |v, _| v.bugs.bounces.glass = Glass::Outward,
    ),
    row(
        "exit-r0",
        "fresnel",
        "R0 of Schlick's formula differs when a ray leaves the glass",
        "R0 = ((n2 - n1) / (n2 + n1))^2 on both sides",
        "R0 = 0 on the way out",
        |v, _| v.toggle(durer_scene::dialect::Quirk::ExitR0),
    ),
    row(
        "mirror-diffuse",
        "reflection",
        "mirrored light is also multiplied by the diffuse colour",
        "color += kr * trace(p, R)",
        "color += kd * kr * trace(p, R), or kd * (local + kr * trace(p, R))",
        |v, _| v.bugs.bounces.times_diffuse = true,
    ),
    row(
        "secondary-diffuse",
        "reflection",
        "{mirrored light is|transmitted light is|mirrored and transmitted light are} scaled by the diffuse colour instead \
         of the specular one",
        "color += ks * trace(...)",
        "color += kd * trace(...)",
        |v, which| {
            v.phongs(|phong| {
                let weight =
                    |own: &mut Color, here: bool| *own = if here && *own != Color::ZERO { phong.diffuse } else { *own };
                weight(&mut phong.reflective, which != 1.0);
                weight(&mut phong.transparent, which != 0.0);
            });
        },
    )
    .with(Values::Only(&[0.0, 1.0, 2.0])),
    row(
        "glass-white",
        "refraction",
        "{light transmitted by glass is|light transmitted and mirrored by glass is} not multiplied by the glass's \
         colour",
        "color += kt * trace(p, T)",
        "color += trace(p, T)",
        |v, which| {
            v.phongs(|phong| {
                if phong.transparent != Color::ZERO {
                    phong.transparent = Color::ONE;
                    phong.reflective = if which == 0.0 { phong.reflective } else { Color::ONE };
                }
            });
        },
    )
    .with(Values::Only(&[0.0, 1.0])),
    row(
        "mirror-squared",
        "reflection",
        "the mirror's colour is applied twice",
        "color += kr * trace(p, R)",
        "color += kr * kr * trace(p, R)",
        |v, _| v.phongs(|phong| phong.reflective *= phong.reflective),
    ),
    row(
        "glass-squared",
        "refraction",
        "the glass's colour is applied twice",
        "color += kt * trace(p, T)",
        "color += kt * kt * trace(p, T)",
        |v, _| v.phongs(|phong| phong.transparent *= phong.transparent),
    ),
    row(
        "fresnel-incoming",
        "fresnel",
        "Schlick's formula uses the angle of the incoming ray even when it leaves the glass",
        "c = cosine on the side of air",
        "c = dot(-d, N) always",
        |v, _| v.bugs.bounces.fresnel = Fresnel::Incoming,
    ),
    row(
        "root-added",
        "refraction",
        "the root of Snell's law has the wrong sign",
        "T = eta d + (eta c - sqrt(1 - eta^2 (1 - c^2))) N",
        "T = eta d + (eta c + sqrt(1 - eta^2 (1 - c^2))) N",
        |v, _| v.bugs.bounces.glass = Glass::RootAdded,
    ),
    row(
        "refraction-formula",
        "refraction",
        "in Snell's law {the part along the normal has the wrong sign|the root is missing|eta below the root is not squared|the part along the normal has the wrong sign|the root is missing|eta below the root is not squared}",
        "T = eta d + (eta c - sqrt(1 - eta^2 (1 - c^2))) N",
        "T = {eta d - (eta c - sqrt(1 - eta^2 (1 - c^2))) N|eta d + (eta c - (1 - eta^2 (1 - c^2))) N|eta d + (eta c - sqrt(1 - eta (1 - c^2))) N|eta d - (eta c - sqrt(1 - eta^2 (1 - c^2))) N|eta d + (eta c - (1 - eta^2 (1 - c^2))) N|eta d + (eta c - sqrt(1 - eta (1 - c^2))) N}",
        |v, how| {
            v.bugs.bounces.glass = [Glass::SignChanged, Glass::NoRoot, Glass::Unsquared][how as usize % 3];
            v.bugs.bounces.unit = how >= 3.0;
        },
    )
    .with(Values::Only(&[0.0, 1.0, 2.0, 3.0, 4.0, 5.0])),
    row(
        "mirror-factor",
        "reflection",
        "mirrored light is multiplied by {}",
        "color += kr * trace(p, R)",
        "color += {} * kr * trace(p, R)",
        |v, factor| v.phongs(|phong| phong.reflective *= factor),
    )
    .with(Values::Numbers(&[0.5, 2.0])),
    row(
        "index-of-all",
        "refraction",
        "the index of refraction is {}, regardless of the scene",
        "the material's index",
        "{}",
        |v, index| {
            v.phongs(|phong| {
                if phong.transparent != durer_scene::math::Color::ZERO && phong.ior != 1.0 {
                    phong.ior = index;
                }
            });
        },
    )
    .with(Values::Numbers(&[1.33, 1.5, 2.0])),
    row(
        "indices-exchanged",
        "refraction",
        "the two indices of refraction are swapped, and so is the angle in Schlick's formula",
        "n1 outside, n2 inside; swapped when leaving",
        "n1 inside, n2 outside",
        |v, _| v.bugs.bounces.glass = Glass::Exchanged,
    ),
    row(
        "fresnel-not-squared",
        "fresnel",
        "R0 of Schlick's formula is not squared",
        "R0 = ((n2 - n1) / (n2 + n1))^2",
        "R0 = |n2 - n1| / (n2 + n1)",
        |v, _| v.bugs.bounces.fresnel = Fresnel::Unsquared,
    ),
    row(
        "fresnel-power",
        "fresnel",
        "Schlick's formula has the power {} instead of 5",
        "R = R0 + (1 - R0) (1 - c)^5",
        "R = R0 + (1 - R0) (1 - c)^{}",
        |v, power| v.bugs.bounces.fresnel = Fresnel::Power(power),
    )
    .with(Values::Only(&[1.0, 2.0, 3.0, 4.0, 6.0])),
    row(
        "epsilon-negative",
        "epsilon",
        "secondary and shadow rays start behind the surface that they leave: the epsilon has the wrong sign",
        "t_min = epsilon",
        "t_min = -epsilon",
        |v, _| {
            v.bugs.shadows.epsilon = Some(-1e-3);
            v.bugs.bounces.epsilon = Some(-1e-3);
        },
    ),
    row(
        "total-reflection",
        "refraction",
        "in total internal reflection {a negative number below the root counts as 0|the mirrored light of glass is not \
         increased|the transmitted ray is mirrored|the transmitted ray is not bent|the root of a negative number makes \
         pixels black|a negative number below the root counts as 0|the sign of the number below the root is ignored|the \
         sign of the number below the root is ignored|the hit is black}",
        "k = 1 - eta^2 (1 - c^2); if (k < 0) the mirrored ray gets all light",
        "if (k < 0) {k = 0|only leave out the transmitted ray|T = R|T = d|(nothing): sqrt(k) is NaN|k = \
         0, and normalize(T)|k = -k|k = -k, and normalize(T)|return black}",
        |v, how| {
            v.bugs.bounces.total = [
                TotalReflection::Clamped,
                TotalReflection::Lost,
                TotalReflection::Mirrored,
                TotalReflection::Straight,
                TotalReflection::NotANumber,
                TotalReflection::Clamped,
                TotalReflection::Absolute,
                TotalReflection::Absolute,
                TotalReflection::Black,
            ][(how as usize).min(8)];
            v.bugs.bounces.unit = how == 5.0 || how == 7.0;
        },
    )
    .with(Values::Only(&[0.0, 1.0, 2.0, 3.0, 4.0, 5.0, 6.0, 7.0, 8.0])),
    row(
        "glass-in-front",
        "epsilon",
        "transmitted rays start in front of the surface and enter it again: the offset is on the wrong side",
        "Ray(p - epsilon * N, T)",
        "Ray(p + epsilon * N, T)",
        |v, _| v.bugs.bounces.glass_in_front = true,
    ),
];
