//! Results of plugins: materials, emission and infinite lights.

use super::plugin::Key;
use durer_diag::Span;
use durer_scene::describe::FileName;
use durer_scene::material::{HairMaterial, PrincipledMaterial};
use durer_scene::math::{Color, Vec3};
use durer_scene::scene::Picture;
use durer_scene::texture::Sky;
use glam::DAffine3;
use std::rc::Rc;

/// Material as declared.
pub(super) enum Made {
    Layers(Box<PrincipledMaterial>),
    Hair(HairMaterial),
    /// Mix of two materials, with the share of the first and a picture that multiplies it.
    Mix(Rc<Made>, Rc<Made>, f32, Option<FileName>),
    /// One material on the front and another on the back.
    Sides(Rc<Made>, Rc<Made>),
    /// Material of a surface that is not rendered.
    Nothing,
}

impl Made {
    /// Matte grey. 0.5 is the default material of shapes.
    pub fn matte(grey: f32) -> Made {
        Made::Layers(Box::new(matte(Vec3::splat(grey))))
    }

    /// Number of materials in it, at most `most + 1`: a material may stand in it many times.
    pub fn count(&self, most: usize) -> usize {
        match self {
            Made::Mix(a, b, ..) | Made::Sides(a, b) => {
                let first = 1 + a.count(most);
                if first > most { first } else { first + b.count(most - first) }
            }
            _ => 1,
        }
    }

    /// Copy with `change` applied to all layers.
    pub fn changed(&self, change: &impl Fn(&mut PrincipledMaterial)) -> Made {
        match self {
            Made::Layers(layers) => {
                let mut layers = layers.clone();
                change(&mut layers);
                Made::Layers(layers)
            }
            Made::Mix(a, b, share, picture) => {
                Made::Mix(a.changed(change).into(), b.changed(change).into(), *share, picture.clone())
            }
            Made::Sides(front, back) => Made::Sides(front.changed(change).into(), back.changed(change).into()),
            Made::Hair(hair) => Made::Hair(hair.clone()),
            Made::Nothing => Made::Nothing,
        }
    }
}

/// Diffuse material without a specular boundary.
pub(super) fn matte(base_color: Color) -> PrincipledMaterial {
    PrincipledMaterial { base_color, specular_weight: 0.0, specular_roughness: 1.0, ..PrincipledMaterial::default() }
}

/// Emission of a shape: radiance, and a picture that multiplies it.
pub(super) struct Shine {
    pub color: Color,
    pub picture: Option<Picture>,
    /// True if both sides emit.
    pub both: bool,
    pub at: Span,
    pub key: Key,
}

/// Infinite light. A scene of Mitsuba has at most one.
pub(super) enum Infinite {
    Even(Color, Span),
    Picture {
        name: String,
        at: Span,
        scale: f32,
        to_world: DAffine3,
    },
    /// Clear sky with y up, and its transform to world space.
    Sky {
        sky: Sky,
        at: Span,
        scale: f32,
        to_world: DAffine3,
    },
}

impl Infinite {
    pub fn at(&self) -> Span {
        let (Infinite::Even(_, at) | Infinite::Picture { at, .. } | Infinite::Sky { at, .. }) = self;
        *at
    }
}
