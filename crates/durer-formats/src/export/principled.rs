//! Principled materials as mixes of simple surfaces.

use super::Export;
use super::surface::{Mask, MetalIndex, Opaque, Paint, Rough, Surface};
use durer_scene::bsdf::fresnel::schlick_82;
use durer_scene::bsdf::layers::opaque_ior;
use durer_scene::bsdf::microfacet::Ggx;
use durer_scene::describe::FileName;
use durer_scene::material::PrincipledMaterial;
use durer_scene::material::parameters::TEXTURE_FIELDS;
use durer_scene::material::principled::{Backs, Layering, Switch, Walls};
use durer_scene::math::Vec3;
use durer_scene::scene::TextureImage;
use durer_scene::spectrum::Curve;
use durer_scene::texture::Channel;

impl Export<'_> {
    pub(super) fn principled(&mut self, m: &PrincipledMaterial, program: &str) -> Surface {
        let layers = (m.layering == Layering::Disney).then(|| crate::disney::as_layers(m));
        self.report_losses(m, program);
        let m = layers.as_ref().unwrap_or(m);
        let base_color = m.base_color_texture.as_ref().map(|name| self.picture(name));
        let mut surface = self.layers(m, base_color.clone(), program);
        let shadows = m.normal_shadowing == Switch::On;
        if let Some(name) = &m.bump_texture {
            surface = Surface::BumpMapped(Box::new(surface), self.picture(name), m.bump_height, shadows);
        }
        if let Some(name) = &m.normal_texture {
            surface = Surface::NormalMapped(Box::new(surface), self.picture(name), shadows);
        }
        let mask = m.opacity_texture.as_ref().map(|name| {
            let picture = self.picture(name);
            Mask { is_alpha: picture.mapping.channel.is_none_or(|channel| channel == Channel::Alpha), picture }
        });
        let by_color = base_color.filter(|picture| picture.mapping.cutoff != Some(0.0));
        let by_color = by_color.filter(|picture| mask.is_none() && self.has_alpha(picture));
        let mask = mask.or(by_color.map(|picture| Mask { picture, is_alpha: true }));
        match mask {
            None if m.opacity >= 1.0 => surface,
            mask => Surface::Masked(Box::new(surface), m.opacity, mask),
        }
    }

    /// Returns the layers of a principled material from the coat downwards.
    fn layers(&mut self, m: &PrincipledMaterial, picture: Option<TextureImage>, program: &str) -> Surface {
        let metal_picture = match (&m.base_metalness_texture, &m.metallic_roughness_texture) {
            (Some(name), _) => Some(self.number_picture(name, None)),
            (None, Some(name)) => Some(self.number_picture(name, Some(Channel::Blue))),
            (None, None) => None,
        };
        let clear_picture = m.transmission_weight_texture.as_ref().map(|name| self.number_picture(name, None));
        let metal = self.metal(m, picture.clone(), program);
        let clear = self.clear(m, program);
        let opaque = self.opaque(m, picture, program);
        Surface::mix(
            metal,
            Surface::mix(clear, opaque, m.transmission_weight, clear_picture),
            m.base_metalness,
            metal_picture,
        )
    }

    fn metal(&mut self, m: &PrincipledMaterial, picture: Option<TextureImage>, program: &str) -> Surface {
        if m.base_metalness <= 0.0 {
            return Surface::diffuse(Vec3::ZERO);
        }
        let (base, weight) = (self.base_color(m, program), m.specular_weight.min(1.0));
        let (f0, f82) = (weight * base, weight * schlick_82(base) * m.specular_color);
        let rough = self.rough(m, program);
        let tint = weight * m.specular_color;
        let index = m.metal_ior.map(|eta| MetalIndex { eta, k: m.metal_extinction, tint });
        Surface::Opaque(Opaque::Metal { f0, f82: f82.min(Vec3::ONE), index, picture, rough }, m.backs != Backs::Black)
    }

    fn clear(&mut self, m: &PrincipledMaterial, program: &str) -> Surface {
        if m.transmission_weight <= 0.0 {
            return Surface::diffuse(Vec3::ZERO);
        }
        let tint = if m.transmission_depth > 0.0 && m.walls == Walls::Solid { Vec3::ONE } else { m.transmission_color };
        let (ior, reflected, transmitted) =
            (m.specular_ior, m.specular_color.min(Vec3::ONE), tint.clamp(Vec3::ZERO, Vec3::ONE));
        let rough = self.rough(m, program);
        if m.walls == Walls::Solid {
            return Surface::Glass { ior, rough, reflected, transmitted };
        }
        if !rough.is_smooth() {
            self.warn_lost(format!("{program} has no rough panes: a smooth one is written"));
        }
        Surface::Pane { ior, reflected, transmitted }
    }

    fn opaque(&mut self, m: &PrincipledMaterial, picture: Option<TextureImage>, program: &str) -> Surface {
        if m.base_metalness >= 1.0 && m.base_metalness_texture.is_none() && m.metallic_roughness_texture.is_none() {
            return Surface::diffuse(Vec3::ZERO);
        }
        let both = m.backs != Backs::Black;
        let mut base = Paint { color: self.base_color(m, program), picture, is_linear: false };
        let is_sheet = m.walls == Walls::Thin && m.subsurface_weight > 0.0;
        if m.subsurface_weight > 0.0 && !is_sheet {
            self.warn_lost(format!("subsurface scattering is not written to {program}: a diffuse colour is written"));
            base.color = base.color.lerp(m.subsurface_color, m.subsurface_weight);
        }
        let (ior, rough) = (opaque_ior(m), self.rough(m, program));
        let coat_rough = Rough {
            picture: m.coat_roughness_texture.as_ref().map(|name| self.number_picture(name, None)),
            ..Rough::of_alpha(m.coat_roughness * m.coat_roughness)
        };
        let matte = match ior == 1.0 {
            true => Opaque::Diffuse(base.clone()),
            false => Opaque::Plastic {
                base: base.clone(),
                ior,
                rough,
                specular: m.specular_color.min(Vec3::ONE),
                darkens: false,
            },
        };
        let mut surface = Surface::Opaque(matte, both);
        if is_sheet {
            let color = Paint {
                picture: m.subsurface_color_texture.as_ref().map(|name| self.picture(name)),
                ..Paint::plain(m.subsurface_color + m.subsurface_through.unwrap_or_default())
            };
            let through = match m.subsurface_through {
                Some(through) => through / (m.subsurface_color + through).max(Vec3::splat(1e-6)),
                None => Vec3::splat(0.5 * (1.0 + m.subsurface_scatter_anisotropy)),
            };
            let sheet = Surface::Sheet { color, through };
            surface = Surface::mix(sheet, surface, m.subsurface_weight, None);
        }
        if m.coat_weight <= 0.0 {
            return surface;
        }
        if is_sheet || m.specular_weight > 0.0 && m.coat_weight > 0.0 && ior != 1.0 {
            self.warn_lost(format!("{program} has a coat over a diffuse base only: the boundary below is left out"));
        }
        if m.coat_darkening > 0.0 && m.coat_darkening < 1.0 {
            self.warn_lost(format!("coats of {program} darken their base fully"));
        }
        base.color *= m.coat_color;
        let coated = Opaque::Plastic {
            base,
            ior: m.coat_ior,
            rough: coat_rough,
            specular: Vec3::ONE,
            darkens: m.coat_darkening > 0.0,
        };
        let picture = m.coat_weight_texture.as_ref().map(|name| self.number_picture(name, None));
        Surface::mix(Surface::Opaque(coated, both), surface, m.coat_weight, picture)
    }

    fn base_color(&mut self, m: &PrincipledMaterial, program: &str) -> Vec3 {
        let measured = m.base_spectrum.as_ref().map(|name| (name, self.spectrum(name).and_then(Curve::reflectance)));
        let color = match measured {
            Some((_, Some(curve))) => curve.color(),
            Some((name, None)) => {
                self.warn_lost(format!(
                    "the spectrum `{}` is not written to {program}: its base colour is written",
                    name.path
                ));
                m.base_color
            }
            None => m.base_color,
        };
        (m.base_weight * color).clamp(Vec3::ZERO, Vec3::ONE)
    }

    /// Returns the rows of a spectrum, which is a file or the name of an illuminant.
    pub(crate) fn spectrum(&self, name: &FileName) -> Option<Vec<[f32; 2]>> {
        let (path, column) = match name.path.rsplit_once(':') {
            Some((path, column)) if !column.contains(['/', '\\']) => (path, Some(column)),
            _ => (&name.path[..], None),
        };
        let bytes = self.context.source.read(path).ok()?;
        crate::curve::read(&bytes, column, 0, &mut Default::default())
    }

    fn rough(&mut self, m: &PrincipledMaterial, program: &str) -> Rough {
        let picture = match (&m.specular_roughness_texture, &m.metallic_roughness_texture) {
            (Some(name), _) => Some(self.number_picture(name, None)),
            (None, Some(name)) => Some(self.number_picture(name, Some(Channel::Green))),
            (None, None) => None,
        };
        let mut alpha = Ggx::new(m.specular_roughness, m.specular_anisotropy).alpha.to_array();
        if m.specular_anisotropy > 0.0 {
            match (4.0 * m.specular_rotation).rem_euclid(2.0) {
                0.0 => {}
                1.0 => alpha.swap(0, 1),
                _ => self.warn_lost(format!(
                    "highlights of {program} are stretched along u or v only: the rotation is left out"
                )),
            }
        }
        Rough { alpha, facets: m.specular_facets, picture }
    }

    /// Returns a picture of numbers, in which `channel` is used if the picture does not select one.
    fn number_picture(&self, name: &FileName, channel: Option<Channel>) -> TextureImage {
        let mut picture = self.picture(name);
        picture.mapping.channel = picture.mapping.channel.or(channel);
        picture
    }

    /// Warns about parameters that no simple surface has.
    fn report_losses(&mut self, m: &PrincipledMaterial, program: &str) {
        const WRITTEN: [&str; 8] = [
            "base_color_texture",
            "base_metalness_texture",
            "specular_roughness_texture",
            "metallic_roughness_texture",
            "transmission_weight_texture",
            "subsurface_color_texture",
            "coat_weight_texture",
            "coat_roughness_texture",
        ];
        for row in TEXTURE_FIELDS.iter().filter(|row| !WRITTEN.contains(&row.field) && (row.texture_file)(m).is_some())
        {
            self.warn_lost(format!("textures of `{}` are not written to {program}: they are left out", row.field));
        }
        let losses = [
            (m.base_diffuse_roughness > 0.0, "rough diffuse surfaces", "a Lambertian surface is written"),
            (m.fuzz_weight > 0.0, "fuzz", "it is left out"),
            (m.base_flatness > 0.0, "flatness", "the base stays diffuse"),
            (m.thin_film_weight > 0.0, "thin films", "they are left out"),
            (m.disperses(), "dispersion", "one index of refraction is written"),
            (m.backs == Backs::Hidden, "hidden back sides", "they are visible"),
            (m.seen_by_camera == Switch::Off, "surfaces that the camera does not see", "they are visible"),
            (
                m.coat_weight > 0.0 && (m.base_metalness > 0.0 || m.transmission_weight > 0.0),
                "coats over metal or glass",
                "they are left out",
            ),
            (m.opacity_cutoff.is_some(), "opacity thresholds", "they are left out"),
        ];
        for (_, what, instead) in losses.into_iter().filter(|row| row.0) {
            self.warn_lost(format!("{what} cannot be written to {program}: {instead}"));
        }
        // At this roughness, single scattering loses a hundredth of the light.
        const ROUGH: f32 = 0.35;
        let scatters = m.base_metalness > 0.0 || m.transmission_weight > 0.0 && m.walls == Walls::Solid;
        if m.energy_compensation == Switch::On && scatters && m.specular_roughness > ROUGH {
            self.warn_lost(format!(
                "rough metal and glass of {program} lose the light that bounces between facets, so they are darker"
            ));
        }
    }
}
