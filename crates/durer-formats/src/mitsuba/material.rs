//! Converts materials to OpenPBR parameters.
//!
//! Source: *Mitsuba 3 documentation*, "BSDFs". GGX's alpha is the square of Dürer's roughness.

use super::defs::{AreaEmitter, MaterialDef, matte};
use super::metals;
use super::plugin::{Key, Plugin, Value};
use super::rough::Boundary;
use super::state::Reader;
use super::texture::{Texture, is_file};
use crate::medium::Medium;
use crate::pictures::asset;
use crate::shared_report::NO_COUNTERPART;
use crate::shared_report::suggest;
use durer_diag::{Diagnostic, Span};
use durer_image::decode_srgb;
use durer_scene::bsdf::fresnel::conductor_colors;
use durer_scene::bsdf::microfacet::Ggx;
use durer_scene::material::mix::Mix;
use durer_scene::material::principled::{
    Backs, BumpGradient, Facets, NormalBacks, NormalBending, NormalGreen, Surroundings, Switch, Walls,
};
use durer_scene::material::two_sided::TwoSided;
use durer_scene::material::{HairMaterial, PatternMaterial, PrincipledMaterial};
use durer_scene::math::Vec3;
use durer_scene::scene::{Material, Spanned};
use durer_scene::spectrum::SpectrumSource;
use std::rc::Rc;

const BSDFS: [&str; 18] = [
    "diffuse",
    "dielectric",
    "thindielectric",
    "roughdielectric",
    "conductor",
    "roughconductor",
    "plastic",
    "roughplastic",
    "principled",
    "principledthin",
    "twosided",
    "mask",
    "null",
    "blendbsdf",
    "bumpmap",
    "normalmap",
    "mixturebsdf",
    "hair",
];

/// Index of refraction of air.
const AIR: f32 = 1.000277;

/// Number of texels that are interpolated along each side of a texel before colours are converted.
const FINER: u32 = 8;

/// Maximum number of materials that one material can consist of, counting repeated ones each time.
const MAX_PARTS: usize = 4096;

impl Reader<'_> {
    /// Converts the material that a plugin defines. Each plugin is converted only once.
    pub fn material(&mut self, plugin: &Rc<Plugin>, depth: u32) -> Rc<MaterialDef> {
        let key = (plugin.key(), self.inside_out);
        if let Some(cached) = self.materials.get(&key) {
            return cached.clone();
        }
        if self.too_deep(depth, plugin.at) {
            return Rc::new(MaterialDef::matte(0.5));
        }
        let mut material = self.convert_material(plugin, depth);
        plugin.warn_unused(self.report);
        if !self.has_room_for(&material, plugin.at) {
            material = Rc::new(MaterialDef::matte(0.5));
        }
        self.materials.insert(key, material.clone());
        material
    }

    /// Returns true if a material has few enough parts to be copied, and otherwise reports an
    /// error.
    fn has_room_for(&self, material: &MaterialDef, at: Span) -> bool {
        let count = material.count(MAX_PARTS);
        if count > MAX_PARTS {
            self.report.error(at, format!("this material consists of more than {MAX_PARTS} materials"));
        }
        count <= MAX_PARTS
            && self.loader.limits.count_bytes_or_report(count, size_of::<PrincipledMaterial>(), self.report, at)
    }

    fn convert_material(&mut self, plugin: &Rc<Plugin>, depth: u32) -> Rc<MaterialDef> {
        let mut m = PrincipledMaterial::default();
        match plugin.kind.as_str() {
            "diffuse" | "roughdiffuse" => {
                let (color, picture) = self.color_or_texture(plugin, "reflectance", 0.5);
                m = PrincipledMaterial { base_color_texture: picture, ..matte(color) };
                plugin.warn_unsupported(self.report, &["alpha", "use_fast_approx"], "the surface is Lambertian");
            }
            "dielectric" | "roughdielectric" | "thindielectric" => self.glass(plugin, &mut m),
            "conductor" | "roughconductor" => self.conductor(plugin, &mut m),
            "plastic" | "roughplastic" => self.plastic(plugin, &mut m),
            "principled" | "principledthin" => m = self.principled(plugin),
            "hair" => return Rc::new(self.hair(plugin)),
            "null" => return Rc::new(MaterialDef::Null),
            "twosided" => {
                let both = |material: &MaterialDef| {
                    Rc::new(material.changed(&|m| {
                        m.backs = Backs::Shown;
                        // A map within sees both sides as the front.
                        if m.normal_texture.is_some() || m.bump_texture.is_some() {
                            m.normal_backs = NormalBacks::Mirrored;
                        }
                    }))
                };
                let parts = self.child_plugins(plugin, Some("bsdf"));
                return match parts.as_slice() {
                    [(_, front), (_, back)] => {
                        let sides = [front, back].map(|side| both(&self.material(side, depth + 1)));
                        // The front side of an inverted sphere is the back side in Dürer.
                        let [front, back] = sides;
                        Rc::new(if self.inside_out {
                            MaterialDef::TwoSided(back, front)
                        } else {
                            MaterialDef::TwoSided(front, back)
                        })
                    }
                    _ => both(&self.nested_material(plugin, depth)),
                };
            }
            "mask" => {
                let (opacity, picture) = self.number_or_texture(plugin, "opacity", 0.5, |x| x.clamp(0.0, 1.0));
                return Rc::new(self.nested_material(plugin, depth).with_opacity(opacity, picture));
            }
            "bumpmap" => return self.bump_map(plugin, depth),
            "normalmap" => return self.normal_map(plugin, depth),
            "blendbsdf" => {
                let parts = self.child_plugins(plugin, Some("bsdf"));
                let [(_, a), (_, b)] = parts.as_slice() else {
                    self.report.error(plugin.at, format!("a `blendbsdf` needs two materials, found {}", parts.len()));
                    return Rc::new(MaterialDef::matte(0.5));
                };
                let (a, b) = (self.material(a, depth + 1), self.material(b, depth + 1));
                // A blend with nothing is an opacity, which is the share of the other material.
                let is_of_second = matches!(*a, MaterialDef::Null);
                let share = |weight: f32| if is_of_second { weight } else { 1.0 - weight };
                let (share, picture) =
                    self.number_or_texture(plugin, "weight", 0.5, |weight| share(weight.clamp(0.0, 1.0)));
                return Rc::new(match (&*a, &*b) {
                    (MaterialDef::Null, _) => b.with_opacity(share, picture),
                    (_, MaterialDef::Null) => a.with_opacity(share, picture),
                    _ => MaterialDef::Mix(a, b, share, picture),
                });
            }
            other => {
                let message = format!("the material `{other}` has no counterpart: diffuse grey is used");
                let warning = Diagnostic::warning(message).code(NO_COUNTERPART).at(plugin.at);
                self.report.push(Diagnostic { help: suggest(other, BSDFS), ..warning });
                // Do not report the properties of this plugin as unused, because they were not
                // read.
                plugin.properties.iter().for_each(|property| property.used.set(true));
                return Rc::new(MaterialDef::matte(0.5));
            }
        }
        // Materials other than glass are black from behind unless they are `twosided`.
        let is_open = m.transmission_weight > 0.0 || m.walls == Walls::Thin || m.transmission_weight_texture.is_some();
        if !is_open {
            // A point whose normal faces away from the viewer is black too.
            m.normal_bending = NormalBending::Off;
            if !self.inside_out {
                m.backs = Backs::Black;
            }
        }
        Rc::new(MaterialDef::Principled(Box::new(m)))
    }

    /// Reads a hair material, which is defined by its absorption or by its melanin.
    fn hair(&self, plugin: &Plugin) -> MaterialDef {
        let default = HairMaterial::default();
        let number = |name| plugin.number(self.report, name);
        let share = |name, default: f32| number(name).unwrap_or(default).clamp(0.0, 1.0);
        let scale = number("scale").unwrap_or(1.0);
        let absorbed = || scale * self.color(plugin, "sigma_a", Vec3::ZERO).max(Vec3::ZERO);
        let absorption = plugin.get("sigma_a").is_some().then(absorbed);
        MaterialDef::Hair(HairMaterial {
            eumelanin: number("eumelanin").unwrap_or(1.3).max(0.0),
            pheomelanin: number("pheomelanin").unwrap_or(0.2).max(0.0),
            color: None,
            absorption,
            longitudinal_roughness: share("longitudinal_roughness", default.longitudinal_roughness),
            azimuthal_roughness: share("azimuthal_roughness", default.azimuthal_roughness),
            scale_tilt: number("scale_tilt").unwrap_or(default.scale_tilt).clamp(-45.0, 45.0),
            ior: self.relative_index(plugin, default.ior).clamp(1.0, 4.0),
        })
    }

    /// Returns the material that is nested in another material.
    fn nested_material(&mut self, plugin: &Plugin, depth: u32) -> Rc<MaterialDef> {
        match self.child_plugins(plugin, Some("bsdf")).first() {
            Some((_, part)) => self.material(part, depth + 1),
            None => {
                self.report.error(plugin.at, format!("a `{}` needs a nested material", plugin.kind));
                Rc::new(MaterialDef::matte(0.5))
            }
        }
    }

    /// Reads a bump map. `scale` is the height at a picture value of 1.
    fn bump_map(&mut self, plugin: &Plugin, depth: u32) -> Rc<MaterialDef> {
        let inner = self.nested_material(plugin, depth);
        let height = plugin.number(self.report, "scale").unwrap_or(1.0);
        let Some((property, _)) = self.child_plugins(plugin, Some("texture")).into_iter().next() else {
            self.report.unsupported_once(plugin.at, "a `bumpmap` needs a texture: the surface stays smooth");
            return inner;
        };
        let (bending, shadowing) = self.mapped_normals(plugin);
        let picture = self.number_texture(property, |x| x);
        if picture.is_none() {
            self.report.unsupported_once(property.at, "a `bumpmap` needs a picture: the surface stays smooth");
        }
        Rc::new(inner.changed(&|m| {
            (m.bump_texture, m.bump_height, m.bump_gradient) = (picture.clone(), height, BumpGradient::Exact);
            (m.normal_bending, m.normal_shadowing) = (bending, shadowing);
        }))
    }

    /// Reads what a bump or normal map does to normals that face away, and whether their points
    /// hide light from each other.
    fn mapped_normals(&self, plugin: &Plugin) -> (NormalBending, Switch) {
        let on = |name| plugin.boolean(self.report, name).unwrap_or(true);
        let bending = if on("flip_invalid_normals") { NormalBending::Turned } else { NormalBending::Off };
        (bending, if on("use_shadowing_function") { Switch::On } else { Switch::Off })
    }

    fn normal_map(&mut self, plugin: &Plugin, depth: u32) -> Rc<MaterialDef> {
        let inner = self.nested_material(plugin, depth);
        let texture = self.child_plugins(plugin, Some("texture")).into_iter().next();
        let Some((property, texture)) = texture.filter(|(_, texture)| texture.kind == "bitmap") else {
            self.report.unsupported_once(plugin.at, "a `normalmap` needs a `bitmap`: the surface stays smooth");
            return inner;
        };
        let (bending, shadowing) = self.mapped_normals(plugin);
        let raw = texture.boolean(self.report, "raw").unwrap_or(false);
        let picture = self.bitmap(&texture);
        texture.warn_unused(self.report);
        let Some(mut picture) = picture else { return inner };
        // Normals are linear values.
        if !raw || !is_file(&picture) {
            let linear = self.pictures().linear(&picture, property.at, decode_srgb, |texel| texel);
            picture = linear.unwrap_or(picture);
        }
        let name = asset(&mut self.scene, picture, property.at);
        Rc::new(inner.changed(&|m| {
            (m.normal_texture, m.normal_green) = (Some(name.clone()), NormalGreen::Cross);
            (m.normal_bending, m.normal_shadowing) = (bending, shadowing);
        }))
    }

    /// Reads an index of refraction, which is given as a number or as the name of a substance.
    fn index(&self, plugin: &Plugin, name: &'static str, default: f32) -> f32 {
        let Some(property) = plugin.get(name) else { return default };
        if let Value::Text(text) = &property.value {
            return metals::dielectric_ior(text).unwrap_or_else(|| {
                let help = suggest(text, metals::dielectric_names());
                self.report.error_with_help(
                    property.at,
                    format!("the material `{text}` has no known index of refraction"),
                    help,
                );
                default
            });
        }
        plugin.positive(self.report, name).unwrap_or(default)
    }

    /// Returns the interior index of refraction divided by the exterior one.
    fn relative_index(&self, plugin: &Plugin, default: f32) -> f32 {
        self.index(plugin, "int_ior", default) / self.index(plugin, "ext_ior", AIR)
    }

    /// Computes roughness, anisotropy and rotation from GGX's alpha along u and v.
    fn roughness(&mut self, plugin: &Plugin, m: &mut PrincipledMaterial) {
        m.energy_compensation = Switch::Off;
        if !plugin.kind.starts_with("rough") {
            m.specular_roughness = 0.0;
            return;
        }
        let apart = ["alpha_u", "alpha_v"].iter().any(|name| plugin.get(name).is_some());
        if apart {
            let alphas = ["alpha_u", "alpha_v"].map(|name| self.value(plugin, name, 0.1));
            [m.specular_roughness, m.specular_anisotropy, m.specular_rotation] = Ggx::parameters(alphas);
        } else {
            (m.specular_roughness, m.specular_roughness_texture) = self.root_or_texture(plugin, "alpha", 0.1);
        }
        match plugin.text(self.report, "distribution").as_deref() {
            Some("ggx") => m.specular_facets = Facets::GgxSeparable,
            Some("beckmann") | None => m.specular_facets = Facets::Beckmann,
            Some(distribution @ ("phong" | "as")) => {
                m.specular_facets = Facets::Beckmann;
                let what = format!(
                    "the distribution `{distribution}` has no counterpart: `beckmann` of the same alpha is used"
                );
                self.report.unsupported_once(plugin.span("distribution"), what);
            }
            Some(other) => {
                let help = suggest(other, ["beckmann", "ggx"]);
                self.report.error_with_help(
                    plugin.span("distribution"),
                    format!("unknown distribution `{other}`"),
                    help,
                );
            }
        }
        plugin.mark_known(&["sample_visible"]);
    }

    /// Reads the colour of the specular reflection.
    fn tint(&mut self, plugin: &Plugin, m: &mut PrincipledMaterial) {
        (m.specular_color, m.specular_color_texture) = self.color_or_texture(plugin, "specular_reflectance", 1.0);
        m.specular_color = m.specular_color.min(Vec3::ONE);
    }

    fn glass(&mut self, plugin: &Plugin, m: &mut PrincipledMaterial) {
        m.transmission_weight = 1.0;
        let index = self.relative_index(plugin, 1.5046);
        let is_thin = plugin.kind == "thindielectric";
        m.specular_ior = if self.inside_out && !is_thin { 1.0 / index } else { index };
        // `ext_ior` is used instead of the index of refraction of the surrounding medium.
        m.surroundings = Surroundings::Ignored;
        self.tint(plugin, m);
        (m.transmission_color, m.transmission_color_texture) =
            self.color_or_texture(plugin, "specular_transmittance", 1.0);
        m.transmission_color = m.transmission_color.min(Vec3::ONE);
        m.walls = if is_thin { Walls::Thin } else { Walls::Solid };
        self.roughness(plugin, m);
    }

    fn conductor(&mut self, plugin: &Plugin, m: &mut PrincipledMaterial) {
        let name = plugin.text(self.report, "material").unwrap_or("none".into());
        let by_numbers = ["eta", "k"].iter().any(|name| plugin.get(name).is_some());
        if by_numbers && plugin.get("material").is_some() {
            self.report
                .error(plugin.span("material"), "a conductor takes either `material`, or `eta` and `k`, but not both");
        }
        let metal = if name == "none" { Some([[0.0; 3], [1.0; 3]]) } else { metals::metal(&name) };
        let metal = metal.unwrap_or_else(|| {
            let help = suggest(&name, metals::metal_names());
            self.report.error_with_help(plugin.span("material"), format!("unknown metal `{name}`"), help);
            [[0.0; 3], [1.0; 3]]
        });
        let outside = self.index(plugin, "ext_eta", 1.0);
        let [n, k] = [("eta", metal[0]), ("k", metal[1])]
            .map(|(name, default)| self.color(plugin, name, Vec3::from_array(default)) / outside);
        (m.metal_ior, m.metal_extinction) = (Some(n), k);
        let [f0, _] = conductor_colors(&SpectrumSource::Rgb(n), &SpectrumSource::Rgb(k), 1.0);
        // The tint applies at all angles.
        (m.specular_color, m.specular_color_texture) = self.color_or_texture(plugin, "specular_reflectance", 1.0);
        (m.base_color, m.base_color_texture) = (f0 * m.specular_color, m.specular_color_texture.clone());
        m.base_metalness = 1.0;
        self.roughness(plugin, m);
    }

    fn plastic(&mut self, plugin: &Plugin, m: &mut PrincipledMaterial) {
        (m.base_color, m.base_color_texture) = self.color_or_texture(plugin, "diffuse_reflectance", 0.5);
        let index = self.relative_index(plugin, 1.49);
        self.tint(plugin, m);
        self.roughness(plugin, m);
        m.specular_ior = index;
        let nonlinear = plugin.boolean(self.report, "nonlinear").unwrap_or(false);
        let roughness = if m.specular_roughness_texture.is_some() { 0.0 } else { m.specular_roughness };
        let boundary = Boundary::new(index, roughness, m.specular_facets);
        let picture =
            m.base_color_texture.as_ref().and_then(|name| self.scene.assets.pictures.get(&name.path)).cloned();
        match picture.filter(|_| nonlinear) {
            Some(picture) => {
                let at = plugin.span("diffuse_reflectance");
                // Mitsuba converts the interpolated colours, so convert a finer picture.
                let scale = m.base_color;
                let convert = |color: Vec3| (scale * color).map(|x| boundary.faded(x.min(1.0)));
                if let Some(picture) = self.pictures().refined(&picture, at, decode_srgb, FINER, convert) {
                    m.base_color_texture = Some(asset(&mut self.scene, picture, at));
                    m.base_color = Vec3::splat(boundary.below());
                }
            }
            None if nonlinear => m.base_color = boundary.below() * m.base_color.map(|color| boundary.faded(color)),
            None => m.base_color *= boundary.below(),
        }
        if let Texture::Constant(color) = self.texture(plugin, "specular_transmittance", Vec3::ONE) {
            m.base_color *= color;
        }
    }

    /// Returns the scene index of a material with its emission and interior medium, or `None` for a
    /// material that is not rendered.
    pub fn material_index(
        &mut self,
        bsdf: Option<&Rc<Plugin>>,
        emitter: Option<&AreaEmitter>,
        inside: Option<(Medium, Key)>,
        at: Span,
    ) -> Option<u32> {
        let key =
            [bsdf.map(|bsdf| bsdf.key()), emitter.map(|emitter| emitter.key), inside.as_ref().map(|inside| inside.1)];
        let key = (key, [self.inside_out, self.hides_backs]);
        if let Some(cached) = self.material_indices.get(&key) {
            return *cached;
        }
        // An emitter without a material does not scatter light.
        let grey = if emitter.is_some() { 0.0 } else { 0.5 };
        let mut material = bsdf.map_or_else(|| Rc::new(MaterialDef::matte(grey)), |bsdf| self.material(bsdf, 0));
        if let Some((medium, _)) = inside {
            material = Rc::new(with_medium(&material, &medium));
        }
        if self.hides_backs {
            material = material.with_hidden_backs();
        }
        let at = bsdf.map_or(at, |bsdf| bsdf.at);
        let number = if self.has_room_for(&material, at) { self.add_material(&material, emitter, at) } else { None };
        self.material_indices.insert(key, number);
        number
    }

    fn add_material(&mut self, def: &MaterialDef, emitter: Option<&AreaEmitter>, at: Span) -> Option<u32> {
        let material = match def {
            MaterialDef::Null => return None,
            MaterialDef::Principled(layers) => {
                let mut layers = layers.clone();
                layers.smooth_shadows = Switch::Off;
                let most = emitter.map_or(0.0, |emitter| emitter.color.max_element());
                if let Some(emitter) = emitter.filter(|_| most > 0.0) {
                    (layers.emission_luminance, layers.emission_color) = (most, emitter.color / most);
                    if let Some(picture) = &emitter.picture {
                        layers.emission_texture = Some(asset(&mut self.scene, picture.clone(), emitter.at));
                    }
                }
                Material::Principled(layers)
            }
            MaterialDef::Hair(hair) => {
                if emitter.is_some() {
                    self.report.unsupported_once(at, "emission of hair has no counterpart: it is ignored");
                }
                Material::Hair(hair.clone())
            }
            MaterialDef::TwoSided(front, back) => {
                match (self.add_material(front, emitter, at), self.add_material(back, None, at)) {
                    (Some(material1), Some(material2)) => {
                        Material::Solid(PatternMaterial::from(TwoSided { material1, material2 }), Vec::new())
                    }
                    (only, other) => return only.or(other),
                }
            }
            MaterialDef::Mix(a, b, share, picture) => {
                match (self.add_material(a, emitter, at), self.add_material(b, emitter, at)) {
                    (Some(material1), Some(material2)) => {
                        let mix = Mix { material1, material2, share: *share, share_texture: picture.clone() };
                        Material::Solid(PatternMaterial::from(mix), Vec::new())
                    }
                    (Some(only), None) | (None, Some(only)) => {
                        self.report.unsupported_once(
                            at,
                            "a blend with a `null` material has no counterpart: only the other material is used",
                        );
                        return Some(only);
                    }
                    (None, None) => return None,
                }
            }
        };
        self.scene.materials.push(Spanned { value: material, span: at });
        Some((self.scene.materials.len() - 1) as u32)
    }
}

/// Returns the material after filling its interior with a medium.
fn with_medium(material: &MaterialDef, medium: &Medium) -> MaterialDef {
    match material {
        MaterialDef::Null => {
            let mut m =
                PrincipledMaterial { specular_ior: 1.0, transmission_weight: 1.0, ..PrincipledMaterial::default() };
            medium.fill(&mut m);
            MaterialDef::Principled(Box::new(m))
        }
        // Light does not enter objects made of opaque materials.
        _ => material.changed(&|m| {
            if m.transmission_weight > 0.0 && m.walls == Walls::Solid {
                medium.fill(m);
            }
        }),
    }
}
