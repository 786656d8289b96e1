//! Converts materials to OpenPBR parameters.
//!
//! Ward's roughness is the mean slope of the surface. GGX's alpha is also the mean slope, and it is
//! the square of OpenPBR's roughness. Sources: the reference manual of Radiance; Ward,
//! *Measuring and Modeling Anisotropic Reflection*, SIGGRAPH 1992.

use super::args::RadPrimitive;
use super::converted::{ConvertedModifier, MaterialKind, PatternEffect};
use super::distribution::DirectionalDistribution;
use super::state::Reader;
use durer_diag::{Diagnostic, Span};
use durer_scene::bsdf::fresnel::schlick_82;
use durer_scene::material::PrincipledMaterial;
use durer_scene::material::mix::Mix;
use durer_scene::material::principled::Walls;
use durer_scene::math::{Color, LUMINANCE, Vec3, fp};
use durer_scene::medium::Fog;
use durer_scene::scene::{Material, Spanned};

const OWN_TANGENTS: &str = "anisotropic highlights follow the surface's own tangents, not the given direction";

/// Returns a matte material that has no specular layer.
fn matte(base_color: Color) -> PrincipledMaterial {
    let base_color = base_color.min(Vec3::ONE);
    PrincipledMaterial { base_color, specular_weight: 0.0, specular_roughness: 1.0, ..PrincipledMaterial::default() }
}

/// Sets roughness and anisotropy from Ward's roughness along u and along v.
fn rough(m: &mut PrincipledMaterial, [u, v]: [f32; 2]) {
    let [u, v] = [u, v].map(|alpha| alpha.clamp(0.0, 1.0));
    m.specular_roughness = (0.5 * (u * u + v * v)).sqrt().sqrt();
    m.specular_anisotropy = if u == v { 0.0 } else { 1.0 - u.min(v) / u.max(v) };
    m.specular_rotation = if v > u { 0.25 } else { 0.0 };
}

/// Returns plastic, which is a matte base below a dielectric layer that reflects the fraction
/// `specular` of light at normal incidence.
fn plastic(color: Color, specular: f32, roughness: [f32; 2]) -> PrincipledMaterial {
    let mut m = matte(color);
    if specular > 0.0 {
        let root = specular.min(0.9).sqrt();
        (m.specular_weight, m.specular_ior) = (1.0, (1.0 + root) / (1.0 - root));
        rough(&mut m, roughness);
    }
    m
}

/// Returns a metal whose reflectance is the same at all angles.
fn metal(color: Color, specular: f32, roughness: [f32; 2]) -> PrincipledMaterial {
    let color = color.min(Vec3::ONE);
    // Schlick's approximation at 82 degrees, relative to which the specular colour is defined.
    let specular_color = color / schlick_82(color).max(Vec3::splat(1e-6));
    let mut m = PrincipledMaterial { base_metalness: specular.min(1.0), specular_color, ..matte(color) };
    if specular > 0.0 {
        m.specular_weight = 1.0;
    }
    rough(&mut m, roughness);
    m
}

/// Returns a translucent sheet that has diffuse and specular transmission.
fn trans(color: Color, [specular, transmitted, straight]: [f32; 3], roughness: [f32; 2]) -> PrincipledMaterial {
    let [transmitted, straight] = [transmitted, straight].map(|share| share.clamp(0.0, 1.0));
    let through = transmitted * straight;
    let (back, forth) = (1.0 - transmitted, transmitted * (1.0 - straight));
    // Both sides of the sheet reflect light that is transmitted specularly, with a total
    // reflectance of 2 F / (1 + F). All other light is reflected only once, with a reflectance of
    // F. These values of F and of the weight of the sheet give the specified fractions at normal
    // incidence.
    let specular = specular.min(0.9);
    let once = specular / (1.0 + (1.0 - specular) * through);
    let sheet = (1.0 - specular) * through * (1.0 + once) / (1.0 - once);
    let mut m = plastic(color, once, roughness);
    if specular == 0.0 && through > 0.0 {
        // The roughness scatters the transmitted light even if there is no reflection.
        m.specular_ior = 1.0;
        rough(&mut m, roughness);
    }
    PrincipledMaterial {
        transmission_weight: sheet,
        transmission_color: color,
        subsurface_weight: 1.0,
        subsurface_color: color,
        subsurface_scatter_anisotropy: ((forth - back) / (forth + back).max(1e-6)).clamp(-0.999, 0.999),
        walls: Walls::Thin,
        ..m
    }
}

/// Returns a dielectric body with the given index of refraction. `left` is the transmittance of the
/// body over a distance of 1.
fn body(left: Color, index: f32) -> PrincipledMaterial {
    let m = PrincipledMaterial {
        transmission_weight: 1.0,
        specular_ior: index,
        specular_roughness: 0.0,
        ..PrincipledMaterial::default()
    };
    match left.min_element() >= 1.0 {
        true => m,
        false => PrincipledMaterial {
            transmission_color: left.clamp(Vec3::splat(1e-6), Vec3::ONE),
            transmission_depth: 1.0,
            ..m
        },
    }
}

/// Returns an emitter that does not reflect any light.
fn emissive(radiance: Color) -> PrincipledMaterial {
    let most = radiance.max_element();
    let emission_color = if most > 0.0 { radiance / most } else { Vec3::ONE };
    PrincipledMaterial { emission_luminance: most, emission_color, ..matte(Vec3::ZERO) }
}

impl Reader<'_> {
    /// Adds a material to the scene and returns its index.
    pub fn add_material(&mut self, m: PrincipledMaterial, at: Span) -> u32 {
        self.scene.materials.push(Spanned { value: Material::Principled(Box::new(m)), span: at });
        (self.scene.materials.len() - 1) as u32
    }

    /// Converts a material, including the effect of the patterns that apply to it.
    pub fn material(&mut self, number: usize, primitive: &RadPrimitive, above: &PatternEffect) -> ConvertedModifier {
        let (kind, at, report) = (primitive.kind.text.as_str(), primitive.at(), self.report);
        let counts: &[usize] = match kind {
            "plastic" | "metal" | "dielectric" => &[5],
            "plastic2" | "metal2" => &[6],
            "trans" => &[7],
            "trans2" | "interface" | "ashik2" => &[8],
            "glass" => &[3, 4],
            "mirror" | "light" | "illum" => &[3],
            "glow" => &[4],
            "spotlight" => &[7],
            "mist" => &[0, 3, 6, 7],
            _ => &[],
        };
        if !counts.is_empty() && !primitive.has(counts, report) {
            return ConvertedModifier::void();
        }
        let value = |i: usize| primitive.number(i).unwrap_or(0.0).max(0.0);
        let both = |i: usize| [value(i); 2];
        let color = primitive.color(0) * above.tint;
        let reflects = !matches!(kind, "light" | "illum" | "glow" | "spotlight" | "mist" | "interface" | "dielectric");
        if reflects && !counts.is_empty() && color.max_element() > 1.0 {
            let bytes = primitive.color(0) / 255.0;
            let mended = match color.max_element() > 2.0 {
                true => format!(": if it is in bytes, write `{:.3} {:.3} {:.3}`", bytes.x, bytes.y, bytes.z),
                false => String::new(),
            };
            let message =
                format!("the colour of `{kind}` is above 1, so it reflects more light than it receives{mended}");
            report.warn_once("color-range", at, message);
        }
        let instead = |what: &str| report.unsupported_once(at, format!("`{kind}` has no counterpart: {what}"));
        if matches!(kind, "plastic" | "plastic2") && value(3) > 0.0 {
            let roughness = if kind == "plastic" { both(4) } else { [value(4), value(5)] };
            if roughness[0] != roughness[1] {
                report.unsupported_once(at, OWN_TANGENTS);
            }
            if roughness != [0.0; 2] {
                return self.rough_plastic(color, value(3).min(1.0), roughness, at);
            }
        }
        let m = match kind {
            "plastic" => plastic(color, value(3), both(4)),
            "metal" => metal(color, value(3), both(4)),
            "trans" => trans(color, [value(3), value(5), value(6)], both(4)),
            "plastic2" => plastic(color, value(3), [value(4), value(5)]),
            "metal2" => metal(color, value(3), [value(4), value(5)]),
            "trans2" => trans(color, [value(3), value(6), value(7)], [value(4), value(5)]),
            "ashik2" => {
                // An exponent on the cosine of the half vector corresponds to a slope of sqrt(2 /
                // (exponent + 2)).
                let slope = |power: f32| (2.0 / (power + 2.0)).sqrt();
                let specular = primitive.color(3);
                plastic(color, specular.element_sum() / 3.0, [slope(value(6)), slope(value(7))])
            }
            "plasfunc" | "plasdata" => {
                instead("plastic of that colour and specularity with roughness 0.1 is used");
                plastic(color, value(3), [0.1; 2])
            }
            "metfunc" | "metdata" => {
                instead("metal of that colour and specularity with roughness 0.1 is used");
                metal(color, value(3), [0.1; 2])
            }
            "transfunc" | "transdata" => {
                instead("a sheet (`trans`) of that colour and those fractions with roughness 0.1 is used");
                trans(color, [value(3), value(4), value(5)], [0.1; 2])
            }
            "BRTDfunc" => {
                instead("the diffuse colour of its front face is used");
                matte(color)
            }
            "BSDF" | "aBSDF" | "WGMDfunc" => {
                instead("diffuse grey is used");
                matte(Vec3::splat(0.5) * above.tint)
            }
            "prism1" | "prism2" => {
                instead("a clear sheet without deflection is used");
                sheet(Vec3::ONE, 1.0)
            }
            "mirror" if primitive.texts.is_empty() => metal(color, 1.0, [0.0; 2]),
            "glass" => sheet(color, primitive.number(3).unwrap_or(1.52)),
            "dielectric" => {
                if primitive.number(4) != Some(0.0) {
                    report.unsupported_once(at, "Hartmann's constant has no counterpart: dispersion is left out");
                }
                let inside = self.add_material(body(color, value(3)), at);
                let bubble = self.add_material(body(Vec3::ONE, 1.0), at);
                return ConvertedModifier {
                    number: Some(inside),
                    kind: MaterialKind::Glass { outside: Some(bubble) },
                    ..ConvertedModifier::void()
                };
            }
            "interface" => {
                let inside = self.add_material(body(color, value(3)), at);
                let outside = self.add_material(body(primitive.color(4), value(7)), at);
                return ConvertedModifier {
                    number: Some(inside),
                    kind: MaterialKind::Glass { outside: Some(outside) },
                    ..ConvertedModifier::void()
                };
            }
            "mist" => return self.mist(primitive),
            "antimatter" => {
                instead("the `antimatter` is left out and removes nothing");
                return ConvertedModifier::void();
            }
            "illum" | "mirror"
                if primitive.texts.first().is_some_and(|name| kind == "mirror" || name.text != "void") =>
            {
                instead(match kind {
                    "illum" => "its substitute material is used, which transmits light itself",
                    _ => "its substitute material is used, which does not mirror lights",
                });
                let other = self.modifiers[number].others[0];
                return match other {
                    Some(other) => {
                        let converted = self.convert(other);
                        ConvertedModifier { number: converted.number, ..ConvertedModifier::void() }
                    }
                    None => ConvertedModifier::void(),
                };
            }
            "light" | "glow" | "illum" => {
                if kind == "illum" {
                    instead("the surface becomes a visible emitter");
                }
                if kind == "glow" && primitive.number(3).is_some_and(|reach| reach != 0.0) {
                    report.unsupported_once(
                        at,
                        "the maximum radius of a `glow` has no counterpart: surfaces at any distance are illuminated",
                    );
                }
                if kind == "light" && color == Vec3::ZERO {
                    let warning = Diagnostic::warning("this `light` emits nothing: its radiance is 0 0 0");
                    report.push(warning.code("black-light").at(at));
                }
                if let Some(spread) = above.spread.clone() {
                    return ConvertedModifier {
                        kind: MaterialKind::DirectionalEmitter { radiance: color, spread, at },
                        ..ConvertedModifier::void()
                    };
                }
                let number = Some(self.add_material(emissive(color), at));
                let patterns = PatternEffect { sky: above.sky.clone(), ..PatternEffect::default() };
                return ConvertedModifier { number, kind: MaterialKind::Emitter { radiance: color }, patterns };
            }
            "spotlight" => {
                let focus = self.modifiers[number].map.transform_vector3(primitive.point(4));
                let direction = focus.normalize_or_zero();
                if direction == glam::DVec3::ZERO {
                    report.error(at, "a spotlight needs a direction");
                }
                let degrees = f64::from(0.5 * value(3).clamp(0.01, 360.0));
                let spread = DirectionalDistribution::Cone { aim: direction, degrees, focus: focus.length() }.into();
                return ConvertedModifier {
                    kind: MaterialKind::DirectionalEmitter { radiance: color, spread, at },
                    ..ConvertedModifier::void()
                };
            }
            _ => matte(color),
        };
        if matches!(kind, "plastic2" | "metal2" | "trans2" | "ashik2") && m.specular_anisotropy > 0.0 {
            report.unsupported_once(at, OWN_TANGENTS);
        }
        ConvertedModifier { number: Some(self.add_material(m, at)), ..ConvertedModifier::void() }
    }

    /// Converts rough plastic to a mix of two parts. The first part is a white highlight with the
    /// same reflectance at all angles, and the second part is matte. Only smooth plastic reflects
    /// more light at grazing angles.
    fn rough_plastic(&mut self, color: Color, share: f32, roughness: [f32; 2], at: Span) -> ConvertedModifier {
        let material1 = self.add_material(metal(Vec3::ONE, 1.0, roughness), at);
        let material2 = self.add_material(matte(color), at);
        let mix = Material::Solid(Mix { material1, material2, share, share_texture: None }.into(), Vec::new());
        self.scene.materials.push(Spanned { value: mix, span: at });
        ConvertedModifier { number: Some((self.scene.materials.len() - 1) as u32), ..ConvertedModifier::void() }
    }

    /// Converts `mist`, which fills a body that does not refract light.
    fn mist(&mut self, primitive: &RadPrimitive) -> ConvertedModifier {
        let extinction = primitive.color(0);
        let most = extinction.max_element();
        if primitive.numbers.is_empty() || most <= 0.0 {
            return ConvertedModifier::void();
        }
        let albedo = if primitive.numbers.len() >= 6 { primitive.color(3).min(Vec3::ONE) } else { Vec3::ZERO };
        let anisotropy = primitive.number(6).unwrap_or(0.0).clamp(-0.99, 0.99);
        let depth = 1.0 / most;
        let m = PrincipledMaterial {
            transmission_depth: depth,
            transmission_color: extinction.map(|sigma| fp::exp(-sigma * depth)),
            transmission_scatter: depth * albedo * extinction,
            transmission_scatter_anisotropy: anisotropy,
            ..body(Vec3::ONE, 1.0)
        };
        let number = self.add_material(m, primitive.at());
        // Fog attenuates all colours equally, so use the luminance of the coefficients.
        let mean = extinction.dot(LUMINANCE);
        let color = (albedo * extinction / mean).min(Vec3::ONE);
        self.mist_fog.insert(number, Fog { extinction: mean, color, anisotropy, ..Fog::default() });
        let number = Some(number);
        ConvertedModifier { number, kind: MaterialKind::Glass { outside: None }, ..ConvertedModifier::void() }
    }
}

/// Returns a pane of glass, which reflects light or transmits it without scattering. `left` is the
/// transmittance of the glass inside the pane.
fn sheet(left: Color, index: f32) -> PrincipledMaterial {
    PrincipledMaterial {
        transmission_color: left.min(Vec3::ONE),
        transmission_depth: 1.0,
        walls: Walls::Thin,
        ..body(Vec3::ONE, index)
    }
}
