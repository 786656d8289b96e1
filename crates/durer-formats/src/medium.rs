//! Participating media of pbrt and Mitsuba, which are defined by absorption and scattering
//! coefficients.

use super::shared_report::SharedReport;
use durer_diag::Span;
use durer_scene::describe::FileName;
use durer_scene::material::PrincipledMaterial;
use durer_scene::math::{Color, fp};
use durer_scene::medium::Fog;
use durer_scene::scene::Spanned;
use glam::DAffine3;

/// Participating medium read from a pbrt or Mitsuba scene, homogeneous or with a density grid. The
/// coefficients are per unit of length.
#[derive(Clone, Debug, PartialEq)]
pub(super) struct Medium {
    /// Absorption coefficient.
    pub absorption: Color,
    /// Scattering coefficient.
    pub scattering: Color,
    /// Mean cosine of the phase function.
    pub anisotropy: f32,
    /// Grid of factors by which the coefficients are multiplied; `None` if the medium is
    /// homogeneous.
    pub density: Option<Density>,
}

/// Density grid of a participating medium, together with its placement in the scene.
#[derive(Clone, Debug, PartialEq)]
pub(super) struct Density {
    /// Name of the asset or file that contains the densities.
    pub name: FileName,
    /// Transform from the unit cube to world space; `None` if the bounds given in the file apply.
    pub to_world: Option<DAffine3>,
}

impl Medium {
    fn extinction(&self) -> Color {
        self.absorption + self.scattering
    }

    /// Makes the medium the interior of a material.
    pub(super) fn fill(&self, m: &mut PrincipledMaterial) {
        let most = self.extinction().max_element();
        if most <= 0.0 {
            return;
        }
        let depth = 1.0 / most;
        m.transmission_depth = depth;
        m.transmission_color = self.extinction().map(|sigma| fp::exp(-sigma * depth));
        m.transmission_scatter = depth * self.scattering;
        m.transmission_scatter_anisotropy = self.anisotropy;
        if let Some(Density { name, to_world }) = &self.density {
            m.transmission_density = Some(name.clone());
            let DAffine3 { matrix3: edges, translation } = to_world.unwrap_or_default();
            let rows = [translation, edges.x_axis, edges.y_axis, edges.z_axis];
            m.transmission_density_box =
                to_world.iter().flat_map(|_| rows.map(|row| row.as_vec3().to_array())).collect();
        }
    }

    /// Returns fog for a medium that surrounds the camera; `None` if the medium is clear or cannot
    /// be represented as fog.
    pub(super) fn fog(&self, at: Span, report: &SharedReport) -> Option<Spanned<Fog>> {
        let extinction = self.extinction();
        let most = extinction.max_element();
        if most <= 0.0 {
            return None;
        }
        if self.density.is_some() {
            report.unsupported_once(at, "a medium around the camera must be homogeneous: this medium is left out");
            return None;
        }
        if extinction.min_element() < 0.99 * most {
            report.unsupported_once(
                at,
                "a medium around the camera can have only one extinction for all colours: the largest is used",
            );
        }
        let (color, anisotropy) = (self.scattering / most, self.anisotropy);
        Some(Spanned { value: Fog { extinction: most, color, anisotropy, ..Fog::default() }, span: at })
    }
}
