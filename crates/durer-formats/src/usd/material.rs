//! Materials: UsdPreviewSurface as a principled material.
//!
//! Source: *UsdPreviewSurface Specification*, version 2.6.

use super::primvar::{DISPLAY_COLOR, Interpolation, Primvar};
use super::reader::{BoundMaterial, Inherited, Reader};
use super::shader::{self, Input, Texture, input, shader_of};
use super::stage::Prim;
use crate::pictures::asset;
use durer_diag::{Diagnostic, Span};
use durer_scene::describe::FileName;
use durer_scene::material::PrincipledMaterial;
use durer_scene::material::principled::Walls;
use durer_scene::math::Vec3;
use durer_scene::scene::TextureImage;
use durer_scene::texture::{Channel, Mapping};
use std::rc::Rc;

/// Reflectance at normal incidence of a surface without a colour of its own: an index of 1.5.
const USUAL_REFLECTANCE: f32 = 0.04;

/// Material that is being read.
struct Surface {
    material: PrincipledMaterial,
    uvs: Vec<String>,
    uses_colors: bool,
}

impl Reader<'_, '_> {
    /// Returns the material for a shape without subsets.
    pub fn material_of(&mut self, prim: &Prim, here: &Inherited, at: Span) -> Option<u32> {
        match here.material.as_deref().and_then(|path| self.material(path)) {
            Some(material) => Some(material.number),
            None => self.display_material(prim, here, at),
        }
    }

    /// Returns a material with the constant display colour of a prim or, if it has none, of its
    /// ancestors. Returns `None` if they have none.
    pub fn display_material(&mut self, prim: &Prim, here: &Inherited, at: Span) -> Option<u32> {
        let read = |name: &str, width: usize| {
            let own = Primvar::read(self.stage, prim, name, width, Interpolation::Constant);
            own.or_else(|| Primvar::inherited(self.stage, here.display.as_deref(), name, width))
        };
        let (color, opacity) = (read(DISPLAY_COLOR, 3)?, read("primvars:displayOpacity", 1));
        if color.values.iter().any(|value| *value > 1.5) {
            let warning = Diagnostic::warning("`displayColor` exceeds 1: colours go from 0 to 1, not to 255");
            let help = "divide the values by 255, and convert them from sRGB to linear values";
            self.stage.files.report.push(warning.code("color-range").at(at).help(help));
        }
        let color = Vec3::from_array(std::array::from_fn(|k| color.values[k] as f32)).clamp(Vec3::ZERO, Vec3::ONE);
        let opacity = opacity.map_or(1.0, |opacity| opacity.values[0] as f32).clamp(0.0, 1.0);
        let key = format!("{color:?} {opacity}");
        if let Some(known) = self.plain_materials.get(&key) {
            return Some(*known);
        }
        let base_color = if color.is_finite() { color } else { Vec3::splat(0.18) };
        let number = self.add_material(PrincipledMaterial { base_color, opacity, ..display() }, at);
        self.plain_materials.insert(key, number);
        Some(number)
    }

    /// Returns a white material for meshes with colours at their points.
    pub fn vertex_color_material(&mut self, at: Span) -> u32 {
        if let Some(known) = self.plain_materials.get("colors") {
            return *known;
        }
        let number = self.add_material(PrincipledMaterial { base_color: Vec3::ONE, ..display() }, at);
        self.plain_materials.insert("colors".into(), number);
        number
    }

    /// Returns the material at a path, or `None` if there is none or it has no known surface.
    pub fn material(&mut self, path: &str) -> Option<Rc<BoundMaterial>> {
        if let Some(known) = self.materials.get(path) {
            return known.clone();
        }
        let material = self.read_material(path).map(Rc::new);
        self.materials.insert(path.to_string(), material.clone());
        material
    }

    fn read_material(&mut self, path: &str) -> Option<BoundMaterial> {
        let report = self.stage.files.report;
        let Some(prim) = self.stage.prim(path) else {
            let message = format!("the material `{path}` does not exist: the display colour is used");
            report.unsupported_once(Span { file: self.stage.files.input.file, start: 0, end: 0 }, message);
            return None;
        };
        let at = prim.span();
        let outputs = ["outputs:surface", "outputs:glslfx:surface", "outputs:mtlx:surface"];
        let shaders = outputs.iter().filter_map(|output| shader_of(self.stage, &prim, output));
        let mut unknown = String::new();
        for (shader, _) in shaders.collect::<Vec<_>>() {
            let id = self.text(&shader, "info:id").unwrap_or_default();
            if id == "UsdPreviewSurface" {
                let Surface { mut material, uvs, uses_colors } = self.preview_surface(&shader);
                limit(&mut material);
                return Some(BoundMaterial { number: self.add_material(material, at), uvs, uses_colors });
            }
            unknown = id;
        }
        let message = match unknown.is_empty() {
            true => "a material without a surface shader is left out: the display colour is used".to_string(),
            false => format!("the surface shader `{unknown}` has no counterpart: the display colour is used"),
        };
        report.unsupported_once(at, message);
        None
    }

    fn preview_surface(&mut self, shader: &Prim) -> Surface {
        let material = PrincipledMaterial {
            base_color: Vec3::splat(0.18),
            specular_roughness: 0.5,
            coat_roughness: 0.01,
            coat_ior: 1.5,
            ..PrincipledMaterial::default()
        };
        let mut surface = Surface { material, uvs: Vec::new(), uses_colors: false };
        let s = &mut surface;
        let own = |name: &str| shader::numbers(self.stage, shader, name).and_then(|all| all.first().map(|x| *x as f32));
        let is_specular = own("useSpecularWorkflow") == Some(1.0);
        s.material.specular_ior = own("ior").filter(|ior| *ior > 0.0).unwrap_or(1.5);
        if let Some(diffuse) = self.color(shader, "diffuseColor", s, true) {
            (s.material.base_color, s.material.base_color_texture) = diffuse;
        }
        if let Some((color, picture)) = self.color(shader, "emissiveColor", s, true)
            && color != Vec3::ZERO
        {
            s.material.emission_luminance = 1.0;
            (s.material.emission_color, s.material.emission_texture) = (color, picture);
        }
        let number = |reader: &mut Self, name: &str, s: &mut Surface| reader.factor(shader, name, s);
        if let Some((value, picture)) = number(self, "roughness", s) {
            (s.material.specular_roughness, s.material.specular_roughness_texture) = (value, picture);
        }
        if let Some((value, picture)) = number(self, "clearcoat", s) {
            (s.material.coat_weight, s.material.coat_weight_texture) = (value, picture);
        }
        if let Some((value, picture)) = number(self, "clearcoatRoughness", s) {
            (s.material.coat_roughness, s.material.coat_roughness_texture) = (value, picture);
        }
        match is_specular {
            true => self.specular_workflow(shader, s),
            false => {
                if let Some((value, picture)) = number(self, "metallic", s) {
                    (s.material.base_metalness, s.material.base_metalness_texture) = (value, picture);
                }
            }
        }
        self.opacity(shader, s);
        if let Some(Input::Texture(texture)) = input(self.stage, shader, "normal") {
            s.material.normal_texture = self.picture(&texture, s, |_| ());
        }
        if input(self.stage, shader, "displacement").is_some_and(|displacement| match displacement {
            Input::Value(opinion) => opinion.value.number() != Some(0.0),
            _ => true,
        }) {
            let message = "displacement has no counterpart: it is left out";
            self.stage.files.report.unsupported_once(shader.span(), message);
        }
        surface
    }

    /// Reads the colour of the reflection at normal incidence.
    fn specular_workflow(&mut self, shader: &Prim, s: &mut Surface) {
        let (color, picture) = self.color(shader, "specularColor", s, true).unwrap_or((Vec3::ZERO, None));
        let most = color.max_element();
        if most > 0.5 && s.material.base_color.max_element() < 0.2 && s.material.base_color_texture.is_none() {
            (s.material.base_color, s.material.base_color_texture) = (color, picture);
            s.material.base_metalness = 1.0;
            return;
        }
        s.material.specular_ior = 1.5;
        s.material.specular_weight = most / USUAL_REFLECTANCE;
        s.material.specular_color = if most > 0.0 { color / most } else { Vec3::ONE };
        s.material.specular_color_texture = picture;
    }

    fn opacity(&mut self, shader: &Prim, s: &mut Surface) {
        let own = |name: &str| shader::numbers(self.stage, shader, name).and_then(|all| all.first().map(|x| *x as f32));
        let threshold = own("opacityThreshold").filter(|threshold| *threshold > 0.0);
        let is_presence = self.text(shader, "inputs:opacityMode").as_deref() == Some("presence");
        let Some((opacity, picture)) = self.factor(shader, "opacity", s) else { return };
        s.material.opacity_cutoff = threshold;
        if picture.is_none() && threshold.is_none() && !is_presence && opacity < 1.0 {
            // Diffuse light fades, but reflections stay.
            s.material.transmission_weight = 1.0 - opacity.max(0.0);
            s.material.walls = Walls::Thin;
            return;
        }
        (s.material.opacity, s.material.opacity_texture) = (opacity, picture);
    }

    /// Returns a colour and its picture.
    fn color(
        &mut self,
        shader: &Prim,
        name: &str,
        s: &mut Surface,
        is_color: bool,
    ) -> Option<(Vec3, Option<FileName>)> {
        match input(self.stage, shader, name)? {
            Input::Value(opinion) => {
                let all = opinion.value.numbers().first_chunk::<3>().copied()?;
                let color = Vec3::from_array(all.map(|x| x as f32));
                color.is_finite().then_some((color.max(Vec3::ZERO), None))
            }
            Input::VertexColor => {
                s.uses_colors = true;
                Some((Vec3::ONE, None))
            }
            Input::Texture(texture) => {
                let scale = Vec3::from_array(std::array::from_fn(|k| texture.scale[k] as f32)).max(Vec3::ZERO);
                // A colour cannot exceed 1, but a texel can be multiplied by more.
                let gain = scale.max_element().max(1.0);
                let scale = scale / gain;
                if texture.bias[..3] != [0.0; 3] {
                    let message = "the `bias` of a colour texture has no counterpart: it is left out";
                    self.stage.files.report.unsupported_once(texture.at, message);
                }
                let is_raw = is_color && texture.is_raw == Some(true);
                let picture = self.color_picture(&texture, s, (is_raw, gain));
                let fallback = texture.fallback.map(|all| Vec3::from_array(std::array::from_fn(|k| all[k] as f32)));
                match picture {
                    Some(picture) => Some((scale, Some(picture))),
                    None => fallback.map(|color| (color.max(Vec3::ZERO), None)),
                }
            }
        }
    }

    /// Returns a number and the picture that multiplies it.
    fn factor(&mut self, shader: &Prim, name: &str, s: &mut Surface) -> Option<(f32, Option<FileName>)> {
        match input(self.stage, shader, name)? {
            Input::Value(opinion) => shader::number(&opinion.value).map(|number| (number, None)),
            Input::VertexColor => None,
            Input::Texture(texture) => {
                let channel = texture.channel.unwrap_or(Channel::Red);
                let index = [Channel::Red, Channel::Green, Channel::Blue, Channel::Alpha];
                let index = index.iter().position(|known| *known == channel).unwrap_or(0);
                let (scale, bias) = (texture.scale[index] as f32, texture.bias[index] as f32);
                let range = [bias, bias + scale];
                let picture = self.picture(&texture, s, |mapping| {
                    (mapping.channel, mapping.range) = (Some(channel), range);
                });
                match picture {
                    Some(picture) => Some((1.0, Some(picture))),
                    None => texture.fallback.map(|all| (all[index] as f32, None)),
                }
            }
        }
    }

    /// Adds a picture of colours, whose alpha is ignored and whose texels are multiplied by `gain`.
    fn color_picture(&mut self, texture: &Texture, s: &mut Surface, (is_raw, gain): (bool, f32)) -> Option<FileName> {
        let opaque = |mapping: &mut Mapping| (mapping.cutoff, mapping.range) = (Some(0.0), [0.0, gain]);
        if !is_raw {
            return self.picture(texture, s, opaque);
        }
        let mut mapping = self.mapping(texture, s);
        opaque(&mut mapping);
        let bytes = self.stage.files.picture(&texture.file, texture.at)?;
        let raw = TextureImage { bytes, mapping };
        let picture = self.stage.files.pictures().reencoded(&raw, texture.at, true, |x| x).unwrap_or(raw);
        Some(asset(&mut self.scene, picture, texture.at))
    }

    fn picture(&mut self, texture: &Texture, s: &mut Surface, change: impl FnOnce(&mut Mapping)) -> Option<FileName> {
        let bytes = self.stage.files.picture(&texture.file, texture.at)?;
        let mut mapping = self.mapping(texture, s);
        change(&mut mapping);
        Some(asset(&mut self.scene, TextureImage { bytes, mapping }, texture.at))
    }

    /// Returns the mapping of a texture. A mesh has at most two sets of coordinates.
    fn mapping(&self, texture: &Texture, s: &mut Surface) -> Mapping {
        let known = s.uvs.iter().position(|name| *name == texture.uv_name);
        let set = known.unwrap_or_else(|| {
            s.uvs.push(texture.uv_name.clone());
            s.uvs.len() - 1
        });
        if set > 1 {
            let message = "a material can use only two sets of texture coordinates: the first is used";
            self.stage.files.report.unsupported_once(texture.at, message);
        }
        Mapping { second: set == 1, ..texture.mapping }
    }
}

/// Material for display colours: matte, as no gloss is known.
fn display() -> PrincipledMaterial {
    PrincipledMaterial { specular_roughness: 0.5, ..PrincipledMaterial::default() }
}

/// Brings the numbers of a material into their ranges.
fn limit(m: &mut PrincipledMaterial) {
    let unit = [
        &mut m.base_metalness,
        &mut m.specular_roughness,
        &mut m.coat_weight,
        &mut m.coat_roughness,
        &mut m.opacity,
        &mut m.transmission_weight,
    ];
    unit.into_iter().for_each(|number| *number = number.clamp(0.0, 1.0));
    m.base_color = m.base_color.min(Vec3::ONE);
}
