//! Media as pbrt and Mitsuba describe them, by absorption and scattering.

use super::said::Said;
use durer_diag::Span;
use durer_scene::describe::FileName;
use durer_scene::material::PrincipledMaterial;
use durer_scene::math::{Color, fp};
use durer_scene::medium::Fog;
use durer_scene::scene::Spanned;
use glam::DAffine3;

/// A medium that absorbs and scatters light; coefficients are per unit of length.
#[derive(Clone, Debug, PartialEq)]
pub(super) struct Medium {
    /// The absorption coefficient.
    pub absorption: Color,
    /// The scattering coefficient.
    pub scattering: Color,
    /// The mean cosine of scattering.
    pub anisotropy: f32,
    /// Densities that multiply the coefficients; `None`: 1 everywhere.
    pub density: Option<Density>,
}

/// A grid of densities in the world.
#[derive(Clone, Debug, PartialEq)]
pub(super) struct Density {
    /// The name of an asset or file.
    pub name: FileName,
    /// From the unit cube to the world; none: the file's own box.
    pub placed: Option<DAffine3>,
}

impl Medium {
    fn extinction(&self) -> Color {
        self.absorption + self.scattering
    }

    /// Sets the interior of a material.
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
        if let Some(Density { name, placed }) = &self.density {
            m.transmission_density = Some(name.clone());
            let DAffine3 { matrix3: edges, translation } = placed.unwrap_or_default();
            let rows = [translation, edges.x_axis, edges.y_axis, edges.z_axis];
            m.transmission_density_box = placed.iter().flat_map(|_| rows.map(|row| row.as_vec3().to_array())).collect();
        }
    }

    /// The fog of a medium around the camera; `None` where it is clear.
    pub(super) fn fog(&self, at: Span, said: &Said) -> Option<Spanned<Fog>> {
        let extinction = self.extinction();
        let most = extinction.max_element();
        if most <= 0.0 {
            return None;
        }
        if self.density.is_some() {
            said.once(at, "what is around the camera is the same everywhere here, and this is not: it is left out");
            return None;
        }
        if extinction.min_element() < 0.99 * most {
            said.once(at, "what is around the camera thins all colours alike: the strongest counts");
        }
        let (color, anisotropy) = (self.scattering / most, self.anisotropy);
        Some(Spanned { value: Fog { extinction: most, color, anisotropy, ..Fog::default() }, span: at })
    }
}
