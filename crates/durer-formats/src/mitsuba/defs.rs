//! Materials, emission and infinite lights that result from reading plugins.

use super::plugin::Key;
use durer_diag::Span;
use durer_scene::describe::FileName;
use durer_scene::material::principled::Walls;
use durer_scene::material::{HairMaterial, PrincipledMaterial};
use durer_scene::math::{Color, Vec3};
use durer_scene::scene::TextureImage;
use durer_scene::texture::sky::Hosek;
use glam::DAffine3;
use std::rc::Rc;

/// Material that was read from a Mitsuba BSDF plugin, before it gets an index in the scene.
pub(super) enum MaterialDef {
    Principled(Box<PrincipledMaterial>),
    Hair(HairMaterial),
    /// Mix of two materials: both materials, the share of the first one, and a picture that
    /// multiplies the share.
    Mix(Rc<MaterialDef>, Rc<MaterialDef>, f32, Option<FileName>),
    /// One material for the front side and another one for the back side.
    TwoSided(Rc<MaterialDef>, Rc<MaterialDef>),
    /// Material of a surface that is not rendered (the plugin `null`).
    Null,
}

impl MaterialDef {
    /// Returns a grey matte material. Shapes without a material use a reflectance of 0.5.
    pub fn matte(grey: f32) -> MaterialDef {
        MaterialDef::Principled(Box::new(matte(Vec3::splat(grey))))
    }

    /// Returns the number of materials that this material consists of, counting repeated ones each
    /// time. Stops counting at `most + 1`.
    pub fn count(&self, most: usize) -> usize {
        match self {
            MaterialDef::Mix(a, b, ..) | MaterialDef::TwoSided(a, b) => {
                let first = 1 + a.count(most);
                if first > most { first } else { first + b.count(most - first) }
            }
            _ => 1,
        }
    }

    /// Returns a copy of which only a share is there, given by a number and a picture.
    pub fn with_opacity(&self, opacity: f32, picture: Option<FileName>) -> MaterialDef {
        self.changed(&|m| {
            m.opacity *= opacity;
            if picture.is_some() {
                m.opacity_texture = picture.clone();
            }
        })
    }

    /// Returns a material that lets light through from behind, as if the surface were not there.
    /// Glass and hair stay as they are.
    pub fn with_hidden_backs(self: &Rc<MaterialDef>) -> Rc<MaterialDef> {
        let is_opaque = match &**self {
            MaterialDef::Principled(m) => m.transmission_weight == 0.0 && m.walls == Walls::Solid,
            MaterialDef::Mix(..) => true,
            MaterialDef::TwoSided(front, _) => return front.with_hidden_backs(),
            MaterialDef::Hair(_) | MaterialDef::Null => false,
        };
        if !is_opaque {
            return self.clone();
        }
        let nothing = PrincipledMaterial { opacity: 0.0, ..matte(Vec3::ZERO) };
        Rc::new(MaterialDef::TwoSided(self.clone(), Rc::new(MaterialDef::Principled(Box::new(nothing)))))
    }

    /// Returns a copy in which `change` has been applied to each `PrincipledMaterial`.
    pub fn changed(&self, change: &impl Fn(&mut PrincipledMaterial)) -> MaterialDef {
        match self {
            MaterialDef::Principled(layers) => {
                let mut layers = layers.clone();
                change(&mut layers);
                MaterialDef::Principled(layers)
            }
            MaterialDef::Mix(a, b, share, picture) => {
                MaterialDef::Mix(a.changed(change).into(), b.changed(change).into(), *share, picture.clone())
            }
            MaterialDef::TwoSided(front, back) => {
                MaterialDef::TwoSided(front.changed(change).into(), back.changed(change).into())
            }
            MaterialDef::Hair(hair) => MaterialDef::Hair(hair.clone()),
            MaterialDef::Null => MaterialDef::Null,
        }
    }
}

/// Returns a diffuse material that has no specular boundary.
pub(super) fn matte(base_color: Color) -> PrincipledMaterial {
    PrincipledMaterial { base_color, specular_weight: 0.0, specular_roughness: 1.0, ..PrincipledMaterial::default() }
}

/// Emission of a shape, from its `area` emitter: a radiance, and optionally a picture that
/// multiplies it.
pub(super) struct AreaEmitter {
    pub color: Color,
    pub picture: Option<TextureImage>,
    pub at: Span,
    pub key: Key,
}

/// Light from infinitely far away: a constant colour, an environment map or a sky. A Mitsuba scene
/// has at most one such light.
pub(super) enum InfiniteLight {
    Constant(Color, Span),
    Picture {
        name: String,
        at: Span,
        scale: f32,
        to_world: DAffine3,
    },
    /// Clear sky with y up, and the transform from the axes of the sky to world space.
    Sky {
        sky: Hosek,
        at: Span,
        scale: f32,
        to_world: DAffine3,
    },
}

impl InfiniteLight {
    /// Returns the span of the light.
    pub fn at(&self) -> Span {
        let (InfiniteLight::Constant(_, at) | InfiniteLight::Picture { at, .. } | InfiniteLight::Sky { at, .. }) = self;
        *at
    }
}
