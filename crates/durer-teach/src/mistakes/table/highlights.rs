//! Mistakes in highlights.

use super::{Mistake, Values, row};
use crate::mistakes::bugs::{HalfVector, Mirror};
use durer_render::world::HighlightModel;
use durer_scene::math::Color;

/// Common mistakes in highlights.
pub(super) const MISTAKES: &[Mistake] = &[
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
        "there are highlights, which the scene's dialect lacks ({by R.L|by R.L, where N.L > 0|by N.H})",
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
        "exponent-plus-one",
        "specular",
        "the highlights' exponent is one {more|less} than it should be",
        "pow(max(0, base), s)",
        "pow(max(0, base), s {+|-} 1)",
        |v, less| {
            v.phongs(|phong| {
                if let Some((_, exponent, _)) = &mut phong.highlight {
                    *exponent += if less == 0.0 { 1.0 } else { -1.0 };
                }
            });
        },
    )
    .with(Values::Only(&[0.0, 1.0])),
    row(
        "highlight-mirror",
        "specular",
        "the direction R of the highlights {lacks the factor 2|is negated|is the normal}",
        "R = d - 2 (d.N) N",
        "R = {d - (d.N) N|2 (d.N) N - d|N}",
        |v, how| v.bugs.highlights.mirror = [Mirror::Along, Mirror::Negated, Mirror::Normal][(how as usize).min(2)],
    )
    .with(Values::Only(&[0.0, 1.0, 2.0])),
    row(
        "highlight-factor",
        "specular",
        "the highlights are multiplied by {}",
        "color += ks * pow(max(0, N.H), s) * I",
        "color += {} * ks * pow(max(0, N.H), s) * I",
        |v, factor| v.bugs.highlights.factor = Some(factor),
    )
    .with(Values::Numbers(&[0.1, 0.5, 2.0])),
    row(
        "other-model",
        "specular",
        "the highlights use the other model: Phong's (R.L) instead of Blinn's (N.H), or the reverse",
        "as in the scene's dialect: max(0, dot(N, norm(L + V))) or max(0, dot(R, L))",
        "the other",
        |v, _| v.swap_highlight_model(),
    ),
    row(
        "highlight-cosine",
        "specular",
        "the highlights are multiplied by N.L",
        "color += ks * pow(base, s) * I",
        "color += ks * pow(base, s) * max(0, N.L) * I",
        |v, _| v.bugs.highlights.times_cosine = true,
    ),
    row(
        "highlight-diffuse",
        "specular",
        "the highlights are multiplied by the diffuse colour",
        "color += (kd * N.L + ks * pow(base, s)) * I",
        "color += kd * (N.L + ks * pow(base, s)) * I",
        |v, _| v.bugs.highlights.times_diffuse = true,
    ),
    row(
        "highlight-bare",
        "specular",
        "the highlights lack the specular colour: they are white, or have the light's colour",
        "ks * pow(base, s) * I",
        "pow(base, s) * I",
        |v, _| {
            v.highlights_everywhere();
            v.bugs.highlights.bare = true;
        },
    ),
    row(
        "half-sum",
        "specular",
        "the half vector H of the highlights is not normalised",
        "H = normalize(L + V)",
        "H = L + V",
        |v, _| v.bugs.highlights.half = HalfVector::Sum,
    ),
    row(
        "half-mean",
        "specular",
        "the half vector H of the highlights is halved instead of normalised",
        "H = normalize(L + V)",
        "H = (L + V) / 2",
        |v, _| v.bugs.highlights.half = HalfVector::Mean,
    ),
    row(
        "highlight-behind",
        "specular",
        "highlights on surfaces that face away from the light are present although the dialect has none, or the reverse",
        "as in the scene's dialect: with or without `if (dot(N, L) > 0)`",
        "the reverse",
        |v, _| {
            v.phongs(|phong| {
                if let Some((_, _, HighlightModel::Phong { behind })) = &mut phong.highlight {
                    *behind = !*behind;
                }
            });
        },
    ),
    row(
        "eye-negated",
        "specular",
        "the direction to the eye has the wrong sign in the highlights",
        "V = -d: H = normalize(L - d), R.L with R = d - 2 (d.N) N",
        "V = d: H = normalize(L + d), R = 2 (d.N) N - d",
        |v, _| v.bugs.highlights.eye_negated = true,
    ),
    row(
        "highlight-from-eye",
        "specular",
        "in mirrors and behind glass, the highlights use the direction to the eye instead of the ray's origin",
        "V = -d",
        "V = normalize(eye - p)",
        |v, _| v.bugs.highlights.from_eye = true,
    ),
    row(
        "highlight-along-axis",
        "specular",
        "the highlights use the direction of the camera, which is the same in all pixels, instead of the ray's",
        "V = -d",
        "V = -normalize(direction of the camera)",
        |v, _| v.bugs.highlights.along_axis = true,
    ),
    row(
        "colors-exchanged",
        "specular",
        "the diffuse and the specular colour are exchanged",
        "kd * max(0, N.L) + ks * pow(max(0, N.H), s)",
        "ks * max(0, N.L) + kd * pow(max(0, N.H), s)",
        |v, _| {
            v.highlights_everywhere();
            v.phongs(|phong| {
                if let Some((specular, ..)) = &mut phong.highlight {
                    std::mem::swap(specular, &mut phong.diffuse);
                }
            });
        },
    ),
    row(
        "highlight-two-sided",
        "specular",
        "the highlights ignore the sign of their base: there is a highlight on the opposite side too",
        "pow(max(0, base), s)",
        "pow(abs(base), s)",
        |v, _| v.bugs.highlights.two_sided = true,
    ),
    row(
        "highlight-lightless",
        "specular",
        "the highlights are not multiplied by the light's colour",
        "color += ks * pow(base, s) * I",
        "color += ks * pow(base, s)",
        |v, _| v.bugs.highlights.lightless = true,
    ),
    row(
        "highlight-white",
        "specular",
        "the specular colour is ignored: highlights and reflections are white",
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
        |v, _| v.bugs.highlights.everywhere = true,
    ),
];
