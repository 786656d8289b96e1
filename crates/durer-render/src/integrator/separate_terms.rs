//! Colour of a camera ray, separated by the terms of Whitted's method.

use super::trace::{RayKind, TermKind, TraceNode, TraceRecorder};
use super::whitted::Whitted;
use durer_scene::math::{Color, Ray};

/// Colour of a camera ray, separated by the kinds of light at its first hit. The sum of all fields
/// is the colour of the ray, up to rounding.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct SeparateTerms {
    /// Ambient light.
    pub ambient: Color,
    /// Diffuse light from all light sources.
    pub diffuse: Color,
    /// Highlights of all light sources.
    pub highlight: Color,
    /// Light along mirrored rays.
    pub reflection: Color,
    /// Light along refracted rays.
    pub refraction: Color,
    /// Light of the background, for a ray that hits nothing.
    pub background: Color,
}

impl SeparateTerms {
    /// Traces a camera ray.
    pub fn trace(whitted: &Whitted, ray: &Ray) -> SeparateTerms {
        let (mut recorder, mut terms) = (TraceRecorder::default(), SeparateTerms::default());
        whitted.radiance(ray, &mut recorder);
        if let Some(tree) = recorder.into_tree() {
            terms.add_terms(&tree.root, Color::ONE);
        }
        terms
    }

    /// Adds the terms of a node, whose value contributes to the ray's colour with the factor
    /// `weight`.
    fn add_terms(&mut self, node: &TraceNode, weight: Color) {
        let weight = weight * node.scale.spectrum().truncate();
        for term in &node.terms {
            let light = weight * term.contribution().spectrum().truncate();
            match term.kind {
                TermKind::Ambient { .. } => self.ambient += light,
                TermKind::Diffuse { .. } => self.diffuse += light,
                TermKind::Highlight { .. } => self.highlight += light,
                TermKind::Ray { from: RayKind::Reflected, .. } => self.reflection += light,
                TermKind::Ray { from: RayKind::Transmitted, .. } => self.refraction += light,
                TermKind::Sky => self.background += light,
                _ => self.add_terms(term, weight * term.factor.spectrum().truncate()),
            }
        }
    }
}
