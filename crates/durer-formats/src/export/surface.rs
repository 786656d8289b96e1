//! Materials reduced to a few simple surfaces that pbrt and Mitsuba have, and to mixes of them.

use super::Export;
use crate::medium::Medium;
use durer_scene::bsdf::lobe::hair::Fibre;
use durer_scene::bsdf::microfacet::Ggx;
use durer_scene::material::principled::{Facets, Walls};
use durer_scene::material::{Pattern as _, PatternMaterial, PrincipledMaterial};
use durer_scene::math::{Vec3, fp};
use durer_scene::scene::{Material, TextureImage};

/// Simple surface, or a combination of surfaces.
#[derive(Clone, Debug, PartialEq)]
pub(crate) enum Surface {
    /// Surface that light does not cross. The flag is true if both sides scatter light.
    Opaque(Opaque, bool),
    /// Boundary of a transparent body.
    Glass { ior: f32, rough: Rough, reflected: Vec3, transmitted: Vec3 },
    /// Thin sheet of glass.
    Pane { ior: f32, reflected: Vec3, transmitted: Vec3 },
    /// Thin sheet that scatters light to both sides; `through` is the fraction of it that crosses,
    /// for red, green and blue.
    Sheet { color: Paint, through: Vec3 },
    /// Mix of two surfaces; the picture multiplies the share of the first one.
    Mix(Box<[Surface; 2]>, f32, Option<TextureImage>),
    /// One surface on the front and another one on the back.
    Sides(Box<[Surface; 2]>),
    /// Surface of which only a part is present.
    Masked(Box<Surface>, f32, Option<Mask>),
    /// Surface with a normal map. The flag is true if its bumps hide light from each other.
    NormalMapped(Box<Surface>, TextureImage, bool),
    /// Surface with a bump map, the height of white and the same flag.
    BumpMapped(Box<Surface>, TextureImage, f32, bool),
}

/// Surface that light does not cross.
#[derive(Clone, Debug, PartialEq)]
pub(crate) enum Opaque {
    Diffuse(Paint),
    /// Metal, given by its reflectance at normal incidence and at 82 degrees, or by its index, and
    /// by a picture that multiplies them.
    Metal {
        f0: Vec3,
        f82: Vec3,
        index: Option<MetalIndex>,
        picture: Option<TextureImage>,
        rough: Rough,
    },
    /// Diffuse base below a boundary. If `darkens` is true, light that is reflected between both is
    /// tinted by the base each time.
    Plastic {
        base: Paint,
        ior: f32,
        rough: Rough,
        specular: Vec3,
        darkens: bool,
    },
}

/// Complex index of refraction of a metal, and a factor on its reflectance.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(crate) struct MetalIndex {
    pub eta: Vec3,
    pub k: Vec3,
    pub tint: Vec3,
}

/// Colour and a picture that multiplies it.
#[derive(Clone, Debug, PartialEq)]
pub(crate) struct Paint {
    pub color: Vec3,
    pub picture: Option<TextureImage>,
    /// True if the 8-bit values of the picture are linear.
    pub is_linear: bool,
}

/// Roughness: alpha along u and v, the distribution of the facets, and a picture that multiplies
/// the square root of alpha.
#[derive(Clone, Debug, PartialEq)]
pub(crate) struct Rough {
    pub alpha: [f32; 2],
    pub facets: Facets,
    pub picture: Option<TextureImage>,
}

/// Picture of an opacity, which is its alpha channel if `is_alpha` is true.
#[derive(Clone, Debug, PartialEq)]
pub(crate) struct Mask {
    pub picture: TextureImage,
    pub is_alpha: bool,
}

/// Light that a surface emits.
#[derive(Clone, Debug, PartialEq)]
pub(crate) struct Emission {
    pub radiance: Vec3,
    pub picture: Option<TextureImage>,
    pub is_two_sided: bool,
}

/// Material of an object: its surface, the light that it emits, and the medium inside.
#[derive(Clone, Debug, PartialEq)]
pub(crate) struct Look {
    pub surface: Surface,
    pub emission: Option<Emission>,
    pub medium: Option<Medium>,
}

impl Paint {
    pub fn plain(color: Vec3) -> Paint {
        Paint { color, picture: None, is_linear: false }
    }
}

impl Rough {
    pub fn of_alpha(alpha: f32) -> Rough {
        Rough { alpha: [alpha; 2], facets: Facets::Ggx, picture: None }
    }

    pub fn is_smooth(&self) -> bool {
        Ggx { alpha: self.alpha.into(), facets: self.facets }.is_smooth()
    }
}

impl Surface {
    pub fn diffuse(color: Vec3) -> Surface {
        Surface::Opaque(Opaque::Diffuse(Paint::plain(color)), true)
    }

    /// Returns a mix, or one of the two surfaces if it has no share.
    pub fn mix(first: Surface, second: Surface, share: f32, picture: Option<TextureImage>) -> Surface {
        match (share, &picture) {
            (share, _) if share <= 0.0 => second,
            (share, None) if share >= 1.0 => first,
            _ => Surface::Mix(Box::new([first, second]), share, picture),
        }
    }

    /// True if the surface has a picture or if the direction of u matters.
    pub fn needs_uv(&self) -> bool {
        let rough = |rough: &Rough| rough.picture.is_some() || rough.alpha[0] != rough.alpha[1];
        match self {
            Surface::Opaque(Opaque::Diffuse(paint), _) | Surface::Sheet { color: paint, .. } => paint.picture.is_some(),
            Surface::Opaque(Opaque::Metal { rough: alpha, picture, .. }, _) => picture.is_some() || rough(alpha),
            Surface::Glass { rough: alpha, .. } => rough(alpha),
            Surface::Opaque(Opaque::Plastic { base, rough: alpha, .. }, _) => base.picture.is_some() || rough(alpha),
            Surface::Pane { .. } => false,
            Surface::Mix(parts, _, picture) => picture.is_some() || parts.iter().any(Surface::needs_uv),
            Surface::Sides(parts) => parts.iter().any(Surface::needs_uv),
            Surface::Masked(inner, _, picture) => picture.is_some() || inner.needs_uv(),
            Surface::NormalMapped(..) | Surface::BumpMapped(..) => true,
        }
    }
}

impl Look {
    /// Look of objects without a material.
    pub fn plain() -> Look {
        Look { surface: Surface::diffuse(Vec3::ONE), emission: None, medium: None }
    }

    /// True if the surface or its light has a picture, or if the direction of u matters.
    pub fn needs_uv(&self) -> bool {
        self.surface.needs_uv() || self.emission.as_ref().is_some_and(|emission| emission.picture.is_some())
    }

    /// True if the surface neither reflects nor refracts light.
    pub fn is_interface(&self) -> bool {
        matches!(self.surface, Surface::Glass { ior, transmitted, .. } if ior == 1.0 && transmitted == Vec3::ONE)
    }
}

/// Returns the name of a material in the file, by its number.
pub(crate) fn material_name(material: Option<u32>) -> String {
    material.map_or("material-none".into(), |number| format!("material-{number}"))
}

impl Export<'_> {
    /// Returns the look of a material by its number. `program` is the name of the other program,
    /// for messages.
    pub fn look(&mut self, number: u32, program: &str) -> Look {
        let Some(material) = self.scene.materials.get(number as usize) else { return Look::plain() };
        match &material.value {
            Material::Principled(m) => {
                let surface = self.principled(m, program);
                Look { surface, emission: self.emission(m), medium: self.medium(m, program) }
            }
            Material::Phong(phong, noise) => {
                if noise.is_some() {
                    self.warn_lost(format!("{program} has no noise: the material's own colour is written"));
                }
                Look { surface: self.phong(phong, program), ..Look::plain() }
            }
            Material::Hair(hair) => {
                self.warn_lost(format!("hair is not written to {program}: a diffuse colour is written"));
                Look { surface: Surface::diffuse(Fibre::new(hair).color()), ..Look::plain() }
            }
            Material::Solid(pattern, _) => {
                // A pattern can refer only to earlier materials, so the recursion ends.
                let [first, second] = pattern
                    .materials()
                    .map(|part| if part < number { self.look(part, program) } else { Look::plain() });
                let emission = first.emission.or(second.emission);
                let surface = match pattern {
                    PatternMaterial::TwoSided(_) => Surface::Sides(Box::new([first.surface, second.surface])),
                    PatternMaterial::Mix(mix) => {
                        let picture = mix.share_texture.as_ref().map(|name| self.picture(name));
                        Surface::mix(first.surface, second.surface, mix.share, picture)
                    }
                    _ => {
                        self.warn_lost(format!(
                            "{program} has no patterns in space: an even mix of both materials is written"
                        ));
                        Surface::mix(first.surface, second.surface, 0.5, None)
                    }
                };
                Look { surface, emission, medium: first.medium.or(second.medium) }
            }
        }
    }

    /// Returns the radiance that a material emits.
    pub fn emitted(&mut self, m: &PrincipledMaterial) -> Vec3 {
        let mut color = m.emission_color;
        if let Some(name) = &m.emission_spectrum {
            match self.light_spectrum(name) {
                Some(curve) => color *= curve.color(),
                None => self.warn_lost(format!("the spectrum `{}` is left out", name.path)),
            }
        }
        m.emission_luminance * color.max(Vec3::ZERO)
    }

    fn emission(&mut self, m: &PrincipledMaterial) -> Option<Emission> {
        let radiance = self.emitted(m);
        (m.emission_luminance > 0.0).then(|| Emission {
            radiance,
            picture: m.emission_texture.as_ref().map(|name| self.picture(name)),
            is_two_sided: m.walls == Walls::Thin,
        })
    }

    /// Returns the medium inside a body.
    fn medium(&mut self, m: &PrincipledMaterial, program: &str) -> Option<Medium> {
        if m.transmission_weight <= 0.0 || m.transmission_depth <= 0.0 || m.walls == Walls::Thin {
            return None;
        }
        if m.transmission_density.is_some() {
            self.warn_lost(format!(
                "media with a density grid are not written to {program}: an even density is written"
            ));
        }
        let extinction = m.transmission_color.map(|c| -fp::ln(c.clamp(1e-6, 1.0)) / m.transmission_depth);
        let scattering = (m.transmission_scatter.max(Vec3::ZERO) / m.transmission_depth).min(extinction);
        let anisotropy = m.transmission_scatter_anisotropy;
        Some(Medium { absorption: extinction - scattering, scattering, anisotropy, density: None })
    }
}
