//! Converts the layers of a principled material to lobes: fuzz on a coat on metal, glass or a
//! diffuse base.
//!
//! Light that is reflected by a layer does not reach the layer below. Each layer is weighted by the
//! share of light that the layers above let through in the view direction. OpenPBR calls this
//! method albedo scaling. This weighting conserves energy, but the sum of the lobes is not
//! reciprocal. A diffuse base is also weighted by the direction of the light ([`Boundary`]), so
//! plastic is reciprocal.

use super::Bsdf;
use super::albedo::{self, DielectricAlbedo};
use super::disney::DisneyStack;
use super::film::Film;
use super::fresnel::{self, F82, MetalCurve, Sheet};
use super::lobe::diffuse::{Boundary, Diffuse, DiffuseTransmission};
use super::lobe::fuzz::Fuzz;
use super::lobe::glass::{Mirror, Refraction, StraightTransmission};
use super::lobe::rough::{Facet, RoughReflection};
use super::lobe::rough_glass::RoughGlass;
use super::microfacet::Ggx;
use super::view::View;
use crate::describe::FileName;
use crate::material::principled::{Facets, Layering, Switch, Walls};
use crate::material::{Parameters, PrincipledMaterial};
use crate::math::{Vec3, fp};
use crate::spectrum::{Curve, Spectrum};
use std::sync::Arc;

/// Albedo tables of a principled material and the measured spectrum of its base. The tables are
/// computed once for each material.
#[derive(Clone, Debug, PartialEq)]
pub struct Tables {
    /// Boundary of an opaque base.
    opaque: Arc<DielectricAlbedo>,
    /// Boundary of glass.
    glass: Arc<DielectricAlbedo>,
    /// Boundary of the coat.
    coat: Arc<DielectricAlbedo>,
    /// Measured spectrum of the base colour.
    measured: Option<Arc<Curve>>,
}

impl Tables {
    /// Creates the tables of a material. `measured` is the measured spectrum of the base of the
    /// material, if there is one. `cache` holds boundaries that were already created, which are
    /// identified by their index of refraction.
    pub fn new(
        material: &PrincipledMaterial,
        measured: Option<Arc<Curve>>,
        cache: &mut Vec<Arc<DielectricAlbedo>>,
    ) -> Self {
        let mut of = |ior: f32, facets: Facets| {
            let found = cache.iter().find(|tables| tables.ior == ior && tables.facets == facets).cloned();
            found.unwrap_or_else(|| {
                cache.push(Arc::new(DielectricAlbedo::new(ior, facets)));
                cache[cache.len() - 1].clone()
            })
        };
        let loses_light = material.energy_compensation == Switch::Off;
        Tables {
            opaque: of(opaque_ior(material), if loses_light { material.specular_facets } else { Facets::Ggx }),
            glass: of(material.specular_ior, Facets::Ggx),
            measured,
            coat: of(material.coat_ior, Facets::Ggx),
        }
    }

    /// Returns the boundary of an opaque base.
    pub fn opaque_boundary(&self) -> &DielectricAlbedo {
        &self.opaque
    }

    /// Computes the tables that the material can use, on all threads, so that no render thread has
    /// to compute them.
    pub fn prepare(&self, m: &PrincipledMaterial) {
        if m.layering == Layering::Disney {
            return;
        }
        // A texture multiplies the parameter. The product is still 0 if the parameter is 0, but any
        // other value may change.
        let all = |share: f32, picture: &Option<FileName>| share == 1.0 && picture.is_none();
        let metal = all(m.base_metalness, &m.base_metalness_texture) && m.metallic_roughness_texture.is_none();
        let glass = all(m.transmission_weight, &m.transmission_weight_texture);
        let rough_coat = m.coat_weight > 0.0 && m.coat_roughness > 0.0;
        let rough = m.specular_roughness > 0.0 || rough_coat;
        let through = rough && !metal && m.transmission_weight > 0.0;
        if m.fuzz_weight > 0.0 {
            albedo::fuzz(1.0, 0.0);
        }
        let facets = rough && m.base_metalness > 0.0 || through && m.walls == Walls::Thin;
        let compensates = m.energy_compensation == Switch::On;
        if facets && compensates {
            albedo::ggx(1.0, 0.0);
        }
        let boundaries = [
            (rough_coat && self.coat.ior != 1.0, &self.coat),
            (rough && !metal && !glass && (self.opaque.ior != 1.0 || m.thin_film_weight > 0.0), &self.opaque),
            (through && compensates && m.walls == Walls::Solid, &self.glass),
        ];
        boundaries.into_iter().filter(|(requested, _)| *requested).for_each(|(_, boundary)| {
            boundary.gain(false, 1.0, 0.0);
            boundary.mean(1.0);
        });
        if m.specular_anisotropy > 0.0 && m.specular_roughness > 0.0 && compensates {
            let uneven = Ggx::new(1.0, 0.5);
            if facets {
                albedo::ggx_for(uneven, Vec3::Z, 1.0);
            }
            if through && m.walls == Walls::Solid {
                self.glass.gain_for(false, self.glass.ior, uneven, Vec3::Z, 1.0);
            }
        }
    }

    /// Returns three flags, which are true if the albedo tables of the opaque base, the glass and
    /// the coat have been built.
    #[cfg(any(test, feature = "testing"))]
    pub fn prepared(&self) -> [bool; 3] {
        [&self.opaque, &self.glass, &self.coat].map(|boundary| boundary.is_prepared())
    }
}

/// Returns the index of refraction of an opaque base. `specularWeight` scales the reflectance at
/// normal incidence.
pub fn opaque_ior(material: &PrincipledMaterial) -> f32 {
    if material.specular_weight == 1.0 {
        return material.specular_ior;
    }
    let ratio = (material.specular_ior - 1.0) / (material.specular_ior + 1.0);
    fresnel::ior_of_reflectance(material.specular_weight * ratio * ratio)
}

fn power(base: Spectrum, exponent: f32) -> Spectrum {
    base.max(Spectrum::ZERO).map(|x| fp::pow(x, exponent))
}

fn mix(a: f32, b: f32, share: f32) -> f32 {
    a + share * (b - a)
}

/// Returns the quotient `shares / of` for each lane, or 1 where `of` is 0.
fn ratios(shares: Spectrum, of: Spectrum) -> Spectrum {
    Spectrum::select(of.cmpgt(Spectrum::splat(1e-6)), shares / of, Spectrum::ONE)
}

/// Adds the lobes of a material with `parameters` to `bsdf`, each scaled by `factor`.
pub fn push_lobes<'a>(bsdf: &mut Bsdf<'a>, factor: f32, parameters: &Parameters, tables: &'a Tables, view: View) {
    let base = match &tables.measured {
        Some(curve) => view.lanes.measured(parameters.base_color, curve),
        None => view.lanes.reflectance(parameters.base_color),
    };
    if parameters.layering == Layering::Disney {
        return DisneyStack { parameters, view, base, factor }.push_lobes(bsdf);
    }
    let stack =
        LayerStack { parameters, tables, view, base, specular: view.lanes.reflectance(parameters.specular_color) };
    stack.push_lobes(bsdf, factor);
}

/// Layers of a principled material at one surface point, from which its lobes are built.
struct LayerStack<'a, 't> {
    parameters: &'a Parameters,
    tables: &'t Tables,
    view: View<'a>,
    base: Spectrum,
    specular: Spectrum,
}

impl<'t> LayerStack<'_, 't> {
    fn push_lobes(&self, bsdf: &mut Bsdf<'t>, factor: f32) {
        let (m, view) = (self.parameters, self.view);
        let mu = view.wo.z;
        let mut below = Spectrum::splat(factor);
        if m.fuzz_weight > 0.0 && !view.inside {
            let roughness = m.fuzz_roughness;
            let reflectance = albedo::fuzz(mu, roughness);
            // At grazing angles, the fibres would reflect more light than arrives, so limit their
            // albedo to 1.
            let scale = m.fuzz_weight * (1.0 / reflectance).min(1.0);
            bsdf.push(
                Fuzz { roughness },
                below * scale * view.lanes.reflectance(m.fuzz_color),
                factor * scale * reflectance,
            );
            below *= 1.0 - scale * reflectance;
        }
        let mut roughness = self.parameters.specular_roughness;
        if m.coat_weight > 0.0 && !view.inside {
            let weight = m.coat_weight;
            let reflectance = self.boundary(bsdf, &self.tables.coat, m.coat_roughness, weight * below, None);
            below *= Spectrum::ONE - weight * reflectance;
            below *= Spectrum::ONE.lerp(self.coat(mu), weight);
            let fourth = |r: f32| r * r * r * r;
            let both = (fourth(roughness) + 2.0 * fourth(m.coat_roughness)).min(1.0);
            roughness = mix(roughness, both.sqrt().sqrt(), weight);
        }
        self.metal(bsdf, roughness, below * self.parameters.base_metalness);
        let dielectric = below * (1.0 - self.parameters.base_metalness);
        let through = dielectric * m.transmission_weight;
        if through.max_element() > 0.0 {
            match m.walls {
                Walls::Solid => self.glass(bsdf, roughness, through),
                Walls::Thin => self.sheet(bsdf, roughness, through),
            }
        }
        let opaque = dielectric * (1.0 - m.transmission_weight);
        if opaque.max_element() > 0.0 {
            if view.inside && m.has_body && m.transmission_weight == 0.0 {
                // Light that is scattered inside the body leaves in all directions.
                return bsdf.push(DiffuseTransmission { color: Spectrum::ONE }, opaque, opaque.max_element());
            }
            let film = self.film(self.tables.opaque.ior);
            let specular = m.reflection * self.specular;
            let reflectance = self.boundary(bsdf, &self.tables.opaque, roughness, opaque * specular, film);
            let dielectric = &*self.tables.opaque;
            let boundary = Boundary { dielectric, roughness, reflection: m.reflection };
            let boundary = (dielectric.ior != 1.0).then_some(boundary);
            let (color, roughness, normal) = (self.base, m.base_diffuse_roughness, view.normal);
            let diffuse = Diffuse { color, roughness, boundary, normal };
            let weight = opaque * (Spectrum::ONE - m.reflection * reflectance);
            let matte = weight * (1.0 - m.subsurface_weight);
            bsdf.push(diffuse, matte, (matte * self.base).max_element());
            self.subsurface(bsdf, weight * m.subsurface_weight, boundary);
        }
    }

    /// Adds the lobe for light that enters the body, or the lobes for light that a thin sheet
    /// scatters to both sides.
    fn subsurface(&self, bsdf: &mut Bsdf<'t>, weight: Spectrum, boundary: Option<Boundary<'t>>) {
        if weight.max_element() <= 0.0 {
            return;
        }
        let m = self.parameters;
        if m.has_body {
            let entering =
                if m.entry_tint == Vec3::ONE { Spectrum::ONE } else { self.view.lanes.reflectance(m.entry_tint) };
            let share = (weight * entering).max_element();
            return bsdf.push(DiffuseTransmission { color: entering }, weight, share);
        }
        let color = self.view.lanes.reflectance(m.subsurface_color);
        let share = (weight * color).max_element();
        let diffuse = Diffuse { boundary, normal: self.view.normal, ..Diffuse::lambert(color) };
        if let Some(through) = m.subsurface_through {
            let through = self.view.lanes.reflectance(through);
            bsdf.push(diffuse, weight, share);
            bsdf.push(DiffuseTransmission { color: through }, weight, (weight * through).max_element());
            return;
        }
        let onwards = 0.5 * (1.0 + m.subsurface_scatter_anisotropy);
        bsdf.push(diffuse, weight * (1.0 - onwards), share * (1.0 - onwards));
        bsdf.push(DiffuseTransmission { color }, weight * onwards, share * onwards);
    }

    /// Returns the film on a dielectric of relative index `eta`, if there is one.
    fn film(&self, eta: f32) -> Option<Film> {
        let m = self.parameters;
        // The outside is air. For light from inside, the body is in front of the film.
        let ior = m.thin_film_ior * eta.min(1.0);
        (m.thin_film_weight > 0.0)
            .then(|| Film::on_dielectric(self.view.lanes, m.thin_film_thickness, ior, eta, m.thin_film_weight))
    }

    /// Adds the reflection of a dielectric boundary seen from outside, and returns its albedo.
    fn boundary(
        &self,
        bsdf: &mut Bsdf<'t>,
        tables: &DielectricAlbedo,
        roughness: f32,
        weight: Spectrum,
        film: Option<Film>,
    ) -> Spectrum {
        // If the index does not change, nothing is reflected, at any roughness.
        if tables.ior == 1.0 && film.is_none() {
            return Spectrum::ZERO;
        }
        let (ggx, mu) = (Ggx::new(roughness, 0.0).with(self.parameters.specular_facets), self.view.wo.z);
        if ggx.is_smooth() {
            let plain = || Spectrum::splat(fresnel::dielectric(mu, tables.ior));
            let reflectance = film.map_or_else(plain, |film| film.reflected(mu));
            bsdf.push(Mirror, weight * reflectance, (weight * reflectance).max_element());
            return reflectance;
        }
        let (facet, reflectance) = match film {
            Some(film) => (Facet::Film(film), albedo::over_facets(ggx, self.view.wo, |cosine| film.reflected(cosine))),
            None => (Facet::Dielectric(tables.ior), Spectrum::splat(tables.rough_reflectance(mu, roughness))),
        };
        let rough = RoughReflection { ggx: ggx.clamped(), facet, transmits: false };
        let gain = if self.compensates() { tables.gain(false, mu, roughness) } else { 1.0 };
        bsdf.push(rough, weight * gain, (weight * reflectance).max_element());
        reflectance
    }

    /// True if the energy that is lost to multiple scattering between facets is restored.
    fn compensates(&self) -> bool {
        self.parameters.energy_compensation == Switch::On
    }

    /// Returns the albedo of single scattering at facets that reflect all light, or 1 without
    /// energy compensation.
    fn facets(&self, ggx: Ggx, roughness: f32) -> f32 {
        if self.compensates() { albedo::ggx_for(ggx, self.view.wo, roughness) } else { 1.0 }
    }

    /// Returns a factor for the base below a coat. The factor accounts for absorption on the way in
    /// and out, and for internal reflection.
    fn coat(&self, mu: f32) -> Spectrum {
        let m = self.parameters;
        let eta = m.coat_ior;
        let inside = (1.0 - (1.0 - mu * mu) / (eta * eta)).max(0.01).sqrt();
        // On average, light enters at normal incidence. The light leaves along the view direction.
        let tint = power(self.view.lanes.reflectance(m.coat_color), 0.5 + 0.5 / inside);
        let roughness = mix(1.0, self.parameters.specular_roughness, self.parameters.base_metalness);
        let thrown_back = mix(fresnel::dielectric(mu, eta), fresnel::diffuse(1.0 / eta), roughness);
        let base = self.base.lerp(Spectrum::ONE, (1.0 - self.parameters.base_metalness) * m.transmission_weight);
        let base = base.clamp(Spectrum::ZERO, Spectrum::ONE);
        let darker = (1.0 - thrown_back) / (Spectrum::ONE - base * thrown_back);
        tint * Spectrum::ONE.lerp(darker, m.coat_darkening)
    }

    /// Returns the reflectance curve of the metal, from its complex index or from its colours.
    fn metal_curve(&self) -> MetalCurve {
        match self.parameters.metal_ior {
            Some(n) => MetalCurve::Index {
                n: self.view.lanes.reflectance(n),
                k: self.view.lanes.reflectance(self.parameters.metal_extinction),
                tint: self.specular,
            },
            None => MetalCurve::F82(F82::new(self.base, self.specular)),
        }
    }

    fn metal(&self, bsdf: &mut Bsdf<'t>, roughness: f32, weight: Spectrum) {
        if weight.max_element() <= 0.0 {
            return;
        }
        let (m, wo, mu) = (self.parameters, self.view.wo, self.view.wo.z);
        let curve = self.metal_curve();
        let ggx = Ggx::new(roughness, m.specular_anisotropy).with(m.specular_facets);
        let mut weight = weight * m.specular_weight.min(1.0) * m.reflection;
        if m.thin_film_weight > 0.0 {
            let film = Film::on_metal(self.view.lanes, m.thin_film_thickness, m.thin_film_ior, self.base);
            let covered = m.thin_film_weight * weight;
            weight *= 1.0 - m.thin_film_weight;
            if ggx.is_smooth() {
                let reflected = covered * film.reflected(mu);
                bsdf.push(Mirror, reflected, reflected.max_element());
            } else {
                let reflectance = self.facets(ggx, roughness);
                let color = albedo::over_facets(ggx, wo, |cosine| film.reflected(cosine));
                let again = Spectrum::ONE + color * ((1.0 - reflectance) / reflectance);
                let rough = RoughReflection { ggx: ggx.clamped(), facet: Facet::Film(film), transmits: false };
                bsdf.push(rough, covered * again, (covered * color).max_element());
            }
        }
        if ggx.is_smooth() {
            let reflected = weight * curve.at(mu);
            return bsdf.push(Mirror, reflected, reflected.max_element());
        }
        let reflectance = self.facets(ggx, roughness);
        // Each further reflection between facets is tinted by the colour of the metal again.
        let again = Spectrum::ONE + self.base * ((1.0 - reflectance) / reflectance);
        let rough = RoughReflection { ggx: ggx.clamped(), facet: Facet::Metal(curve), transmits: false };
        bsdf.push(rough, weight * again, (weight * curve.at(mu)).max_element());
    }

    fn glass(&self, bsdf: &mut Bsdf<'t>, roughness: f32, weight: Spectrum) {
        let (m, View { wo, inside, eta, .. }) = (self.parameters, self.view);
        // With a depth, the colour applies to the interior instead of the surface.
        let tint = match m.transmission_depth > 0.0 {
            true => Spectrum::ONE,
            false => self.view.lanes.reflectance(m.transmission_color),
        };
        let film = self.film(eta);
        if eta == 1.0 && film.is_none() {
            return bsdf.push(StraightTransmission, weight * tint, weight.max_element());
        }
        let ggx = Ggx::new(roughness, m.specular_anisotropy).with(m.specular_facets);
        let plain = fresnel::dielectric(wo.z, eta);
        let reflected = film.map_or(Spectrum::splat(plain), |film| film.reflected(wo.z));
        // If the index does not change, rough glass does not scatter.
        if ggx.is_smooth() || eta == 1.0 {
            let (up, down) = (weight * reflected, weight * (Spectrum::ONE - reflected));
            bsdf.push(Mirror, self.specular * up, up.max_element());
            return match eta == 1.0 {
                true => bsdf.push(StraightTransmission, tint * down, down.max_element()),
                false => bsdf.push(Refraction { eta }, tint * down, down.max_element()),
            };
        }
        let (mut up, mut down) = (self.specular, tint);
        if let Some(film) = film {
            // All facets share one film colour, which is chosen so that no energy is lost.
            let mean = |value: &dyn Fn(f32) -> Spectrum| albedo::over_facets(ggx, wo, value);
            let with = mean(&|cosine| film.reflected(cosine));
            let without = mean(&|cosine| Spectrum::splat(fresnel::dielectric(cosine, eta)));
            (up, down) = (up * with / without, down * ratios(Spectrum::ONE - with, Spectrum::ONE - without));
        }
        let rough = RoughGlass { ggx: ggx.clamped(), eta, reflected: up, transmitted: down };
        let gain = match self.compensates() {
            true => self.tables.glass.gain_for(inside, eta, ggx, wo, roughness),
            false => 1.0,
        };
        bsdf.push(rough, weight * gain, weight.max_element());
    }

    /// Adds a thin sheet with internal reflections. Transmitted light keeps its direction.
    fn sheet(&self, bsdf: &mut Bsdf<'t>, roughness: f32, weight: Spectrum) {
        let (m, wo, mu) = (self.parameters, self.view.wo, self.view.wo.z);
        let (eta, ggx) = (m.specular_ior, Ggx::new(roughness, m.specular_anisotropy).with(m.specular_facets));
        let color = self.view.lanes.reflectance(m.transmission_color);
        // With a depth, the colour applies to the interior. Without a depth, it tints all
        // transmitted light.
        let (inside, tint) = if m.transmission_depth > 0.0 { (Some(color), Spectrum::ONE) } else { (None, color) };
        let sheet = Sheet { eta, inside };
        // The film is on one of the two faces.
        let film = self.film(eta);
        let faced = |film: Film, cosine: f32| sheet.with_front_face(film.reflected(cosine), cosine);
        let (reflected, through) = film.map_or_else(|| sheet.at(mu), |film| faced(film, mu));
        let (mut up, mut down) = (weight * self.specular, weight * tint);
        let shares = ((weight * reflected).max_element(), (weight * through).max_element());
        if ggx.is_smooth() || film.is_some() && eta == 1.0 {
            bsdf.push(Mirror, up * reflected, shares.0);
            return bsdf.push(StraightTransmission, down * through, shares.1);
        }
        if let Some(film) = film {
            let mean = |value: &dyn Fn(f32) -> Spectrum| albedo::over_facets(ggx, wo, value);
            up *= ratios(mean(&|cosine| faced(film, cosine).0), mean(&|cosine| sheet.at(cosine).0));
            down *= ratios(mean(&|cosine| faced(film, cosine).1), mean(&|cosine| sheet.at(cosine).1));
        }
        let gain = 1.0 / self.facets(ggx, roughness);
        let rough = |facet, transmits| RoughReflection { ggx: ggx.clamped(), facet, transmits };
        bsdf.push(rough(Facet::Sheet(sheet), false), up * gain, shares.0);
        bsdf.push(rough(Facet::SheetTransmission(sheet), true), down * gain, shares.1);
    }
}
