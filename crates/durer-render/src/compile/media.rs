//! Compilation of participating media, which fill objects or form fog.

use super::files::Loader;
use durer_diag::{Diagnostic, Diagnostics};
use durer_scene::material::PrincipledMaterial;
use durer_scene::material::principled::Walls;
use durer_scene::math::{Aabb, Affine, Color, Vec3, fp};
use durer_scene::medium::{Fog, HenyeyGreenstein, Medium, MediumRegion};
use glam::{DAffine3, DMat3, DVec3};

/// Returns the medium inside a material if it absorbs or scatters light.
pub(super) fn inside(m: &PrincipledMaterial, loader: &mut Loader, diagnostics: &mut Diagnostics) -> Option<Medium> {
    if m.walls == Walls::Thin {
        return None;
    }
    if m.transmission_weight > 0.0 {
        let medium = transmission(m)?;
        return Some(Medium { region: density(m, loader, diagnostics), ..medium });
    }
    m.has_subsurface().then(|| subsurface(m))
}

/// Returns the medium of the transmission layer. Source: OpenPBR, *Translucent base*. For a colour
/// T at a depth d, the extinction is -ln T / d, and the scattering is the scatter colour divided by
/// d.
fn transmission(m: &PrincipledMaterial) -> Option<Medium> {
    if m.transmission_depth <= 0.0 {
        return None;
    }
    // A black transmission colour would require infinite extinction.
    let extinction = m.transmission_color.map(|c| -fp::ln(c.clamp(1e-6, 1.0)) / m.transmission_depth);
    let scattering = m.transmission_scatter.max(Vec3::ZERO) / m.transmission_depth;
    // If the absorption is negative, increase it equally in all channels to preserve the hue.
    let absorption = extinction - scattering;
    let absorption = absorption - absorption.min_element().min(0.0);
    let extinction = if scattering == Color::ZERO { extinction } else { absorption + scattering };
    let phase = HenyeyGreenstein { anisotropy: m.transmission_scatter_anisotropy };
    (extinction != Color::ZERO).then(|| medium(extinction, scattering, phase))
}

/// Returns the density field of an object's interior if the density is not uniform.
fn density(m: &PrincipledMaterial, loader: &mut Loader, diagnostics: &mut Diagnostics) -> Option<MediumRegion> {
    let name = m.transmission_density.as_ref()?;
    let (bounds, grid) = loader.density(name, diagnostics)?;
    let place = MediumRegion { bounds, to_world: None, density: Some(grid) };
    let rows = m.transmission_density_box.len();
    if rows == 0 {
        return Some(place);
    }
    let mut refuse = |message: &str| {
        diagnostics.push(Diagnostic::error(message).code("bad-value").at(name.span));
        None
    };
    if rows != 4 {
        return refuse("`transmissionDensityBox` must have four rows: a corner and three edges");
    }
    let row = |i: usize| m.transmission_density_box.get(i).map_or(DVec3::ZERO, |row| Vec3::from_array(*row).as_dvec3());
    let map = DAffine3::from_mat3_translation(DMat3::from_cols(row(1), row(2), row(3)), row(0));
    let Some(placed) = Affine::new(map) else {
        return refuse("the edges of `transmissionDensityBox` must span a volume");
    };
    Some(MediumRegion { bounds: Aabb { min: Vec3::ZERO, max: Vec3::ONE }, to_world: Some(placed), ..place })
}

/// Returns an unbounded medium with this extinction and scattering, in 1/length.
fn medium(extinction: Color, scattering: Color, phase: HenyeyGreenstein) -> Medium {
    let share = |s: f32, all: f32| if all > 0.0 { s / all } else { 0.0 };
    let albedo = Color::from_array(std::array::from_fn(|i| share(scattering[i], extinction[i])));
    Medium { extinction, albedo, phase, region: None }
}

/// Returns the medium for which the albedo of a half-space is the subsurface colour.
///
/// Source: OpenPBR, *Subsurface*. The formula for inverting the albedo is from Kulla and Conty,
/// *Revisiting Physically Based Shading at Imageworks*, 2017.
fn subsurface(m: &PrincipledMaterial) -> Medium {
    let g = m.subsurface_scatter_anisotropy;
    let albedo = |color: f32| {
        let c = color.clamp(0.0, 1.0);
        let s = 4.097_12 + 4.208_63 * c - (9.592_17 + 41.680_8 * c + 17.712_6 * c * c).sqrt();
        ((1.0 - s * s) / (1.0 - g * s * s)).clamp(0.0, 1.0)
    };
    let radius = (m.subsurface_radius * m.subsurface_radius_scale).max(Vec3::splat(1e-6));
    Medium {
        extinction: 1.0 / radius,
        albedo: m.subsurface_color.map(albedo),
        phase: HenyeyGreenstein { anisotropy: g },
        region: None,
    }
}

/// Returns true if a surface neither reflects nor refracts light and only bounds a medium.
pub(super) fn is_interface(m: &PrincipledMaterial) -> bool {
    let tint = m.transmission_depth > 0.0 || m.transmission_color == Vec3::ONE;
    m.walls == Walls::Solid
        && m.specular_ior == 1.0
        && m.transmission_weight == 1.0
        && tint
        && m.base_metalness == 0.0
        && m.coat_weight == 0.0
        && m.fuzz_weight == 0.0
        && m.emission_luminance == 0.0
}

/// Returns the medium of the fog in a scene. The fog can be bounded by a box or a density grid.
pub(super) fn fog(written: &Fog, loader: &mut Loader, diagnostics: &mut Diagnostics) -> Option<Medium> {
    let corners = written.min.zip(written.max).map(|(min, max)| Aabb { min, max });
    let density = match &written.density {
        Some(name) => Some(loader.density(name, diagnostics)?),
        None => None,
    };
    let region = match (corners, density) {
        (None, None) => None,
        (Some(bounds), None) => Some(MediumRegion { bounds, to_world: None, density: None }),
        (corners, Some((bounds, density))) => {
            Some(MediumRegion { bounds: corners.unwrap_or(bounds), to_world: None, density: Some(density) })
        }
    };
    let albedo = written.color.clamp(Vec3::ZERO, Vec3::ONE);
    let phase = HenyeyGreenstein { anisotropy: written.anisotropy };
    Some(Medium { extinction: Color::splat(written.extinction), albedo, phase, region })
}
