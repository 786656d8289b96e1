//! Writes materials as `UsdPreviewSurface`, and their pictures.

use super::prim::{Prim, tuple};
use super::{PROGRAM, Writer};
use crate::export::layers::principled_of_phong;
use durer_scene::bsdf::lobe::hair::Fibre;
use durer_scene::describe::FileName;
use durer_scene::material::parameters::TEXTURE_FIELDS;
use durer_scene::material::principled::{Backs, Facets, Layering, Switch, Walls};
use durer_scene::material::{Pattern as _, PrincipledMaterial};
use durer_scene::math::Vec3;
use durer_scene::scene::{Material, TextureImage};
use durer_scene::spectrum::Curve;
use durer_scene::texture::{Channel, Mapping, Wrap};

/// Reflectance at normal incidence of an index of 1.5.
const USUAL_REFLECTANCE: f32 = 0.04;
/// Index of refraction of coats.
const COAT_IOR: f32 = 1.5;

/// Material of which the prim is written.
#[derive(Clone)]
pub(super) struct Bound {
    pub name: String,
    pub has_picture: bool,
    pub is_double_sided: bool,
    /// Colour that multiplies the colours of vertices.
    pub vertex_tint: Vec3,
}

/// Shader that is being written, with its textures.
struct Shader {
    path: String,
    lines: Vec<String>,
    nodes: Vec<Prim>,
}

impl Writer<'_> {
    /// Returns a material by its number, which is written when it is used for the first time.
    pub(super) fn material(&mut self, number: Option<u32>) -> Bound {
        if let Some(known) = self.materials.get(&number) {
            return known.clone();
        }
        let name = number.map_or("Material_None".to_string(), |number| format!("Material_{number}"));
        let plain = PrincipledMaterial { base_color: Vec3::ONE, specular_weight: 0.0, ..Default::default() };
        let m = number.map_or(plain, |number| self.layers(number));
        let bound = self.surface(name, &m);
        self.materials.insert(number, bound.clone());
        bound
    }

    /// Returns the layers of a material.
    fn layers(&mut self, number: u32) -> PrincipledMaterial {
        let scene = self.export.scene;
        match scene.materials.get(number as usize).map(|material| &material.value) {
            Some(Material::Principled(m)) if m.layering == Layering::Disney => crate::disney::as_layers(m),
            Some(Material::Principled(m)) => (**m).clone(),
            Some(Material::Phong(phong, noise)) => {
                if noise.is_some() {
                    self.export.warn_lost("USD has no noise: the material's own colour is written");
                }
                self.export.warn_lost("materials of the course are written to USD as similar layers");
                principled_of_phong(phong)
            }
            Some(Material::Hair(hair)) => {
                self.export.warn_lost("hair is not written to USD: a diffuse colour is written");
                let base_color = Fibre::new(hair).color();
                PrincipledMaterial { base_color, specular_weight: 0.0, ..PrincipledMaterial::default() }
            }
            Some(Material::Solid(pattern, _)) => {
                self.export.warn_lost("USD has no patterns of two materials: the first material is written");
                // A pattern can refer only to earlier materials, so the recursion ends.
                let first = pattern.materials()[0];
                if first < number { self.layers(first) } else { PrincipledMaterial::default() }
            }
            None => PrincipledMaterial::default(),
        }
    }

    fn surface(&mut self, name: String, m: &PrincipledMaterial) -> Bound {
        self.report_losses(m);
        let path = format!("/World/Materials/{name}");
        let mut shader = Shader { path: path.clone(), lines: Vec::new(), nodes: Vec::new() };
        let base_color = self.base_color(m);
        let base_picture = m.base_color_texture.as_ref().map(|name| self.export.picture(name));
        match &base_picture {
            Some(picture) => self.color(&mut shader, "diffuseColor", base_color, picture),
            None => {
                shader.lines.push(format!("color3f inputs:diffuseColor = {}", tuple(base_color.to_array())));
            }
        }
        if m.emission_luminance > 0.0 {
            let radiance = self.export.emitted(m);
            match &m.emission_texture {
                Some(name) => {
                    let picture = self.export.picture(name);
                    self.color(&mut shader, "emissiveColor", radiance, &picture);
                }
                None => shader.lines.push(format!("color3f inputs:emissiveColor = {}", tuple(radiance.to_array()))),
            }
        }
        self.reflection(&mut shader, m);
        if m.coat_weight > 0.0 {
            self.number(&mut shader, "clearcoat", m.coat_weight, m.coat_weight_texture.as_ref(), None);
            self.number(&mut shader, "clearcoatRoughness", m.coat_roughness, m.coat_roughness_texture.as_ref(), None);
        }
        self.opacity(&mut shader, m, base_picture.as_ref());
        if let Some(name) = &m.normal_texture {
            let picture = self.export.picture(name);
            if let Some(file) = self.export.color_file(&picture, true, "color", |color| color) {
                let node = texture(&mut shader, "normal", &file.path, true, &picture.mapping);
                let node = node.line("float4 inputs:scale = (2, 2, 2, 1)").line("float4 inputs:bias = (-1, -1, -1, 0)");
                shader.connect("normal3f", "normal", node, "float3", "rgb");
            }
            if picture.mapping.strength != 1.0 {
                self.export.warn_lost("the strength of normal maps is not written to USD: it is 1");
            }
        }
        let surface = Prim::new("Shader", "Surface").line("uniform token info:id = \"UsdPreviewSurface\"");
        let surface = surface.lines(shader.lines).line("token outputs:surface");
        let mut material = Prim::new("Material", name.clone())
            .line(format!("token outputs:surface.connect = <{path}/Surface.outputs:surface>"));
        material.children.push(surface);
        let has_picture = !shader.nodes.is_empty();
        material.children.extend(shader.nodes);
        self.material_prims.push(material);
        Bound { name, has_picture, is_double_sided: m.backs == Backs::Shown, vertex_tint: Vec3::ONE }
    }

    /// Writes how much a surface reflects, and how rough it is.
    fn reflection(&mut self, shader: &mut Shader, m: &PrincipledMaterial) {
        let (shared, metal) = (m.metallic_roughness_texture.as_ref(), m.base_metalness_texture.as_ref());
        let is_metal = m.base_metalness > 0.0 || metal.is_some();
        let ior = m.specular_ior;
        if is_metal {
            shader.lines.push(format!("float inputs:ior = {ior}"));
            let (name, channel) = metal.map_or((shared, Some(Channel::Blue)), |name| (Some(name), None));
            self.number(shader, "metallic", m.base_metalness, name, channel);
        } else if m.specular_weight == 1.0 && m.specular_color == Vec3::ONE {
            shader.lines.push(format!("float inputs:ior = {ior}"));
        } else {
            let root = (ior - 1.0) / (ior + 1.0);
            let usual = if ior == 1.5 { USUAL_REFLECTANCE } else { root * root };
            let color = usual * m.specular_weight * m.specular_color;
            shader.lines.push("int inputs:useSpecularWorkflow = 1".into());
            shader.lines.push(format!("color3f inputs:specularColor = {}", tuple(color.min(Vec3::ONE).to_array())));
            if ior != 1.5 && m.specular_weight > 0.0 {
                self.export.warn_lost(
                    "tinted highlights of USD have the index 1.5: they reflect as much at normal incidence only",
                );
            }
        }
        let own = m.specular_roughness_texture.as_ref();
        let (name, channel) = own.map_or((shared, Some(Channel::Green)), |name| (Some(name), None));
        self.number(shader, "roughness", m.specular_roughness, name, channel);
    }

    fn opacity(&mut self, shader: &mut Shader, m: &PrincipledMaterial, base: Option<&TextureImage>) {
        let by_color = base.filter(|picture| {
            m.opacity_texture.is_none() && picture.mapping.cutoff != Some(0.0) && self.export.has_alpha(picture)
        });
        let cutoff = m.opacity_cutoff.or(by_color.and_then(|picture| picture.mapping.cutoff));
        if let Some(cutoff) = cutoff.filter(|cutoff| *cutoff > 0.0) {
            shader.lines.push(format!("float inputs:opacityThreshold = {cutoff}"));
        }
        if m.opacity_texture.is_some() || by_color.is_some() || m.opacity < 1.0 {
            shader.lines.push("token inputs:opacityMode = \"presence\"".into());
        }
        match (&m.opacity_texture, by_color) {
            (Some(name), _) => {
                let picture = self.export.picture(name);
                let is_alpha = picture.mapping.channel.is_none() && self.export.has_alpha(&picture);
                let channel = Some(if is_alpha { Channel::Alpha } else { Channel::Red });
                self.number(shader, "opacity", m.opacity, Some(name), channel);
            }
            (None, Some(picture)) => {
                let picture = picture.clone();
                self.number_picture(shader, "opacity", m.opacity, &picture, Channel::Alpha);
            }
            (None, None) if m.opacity < 1.0 => shader.lines.push(format!("float inputs:opacity = {}", m.opacity)),
            (None, None) if m.transmission_weight > 0.0 => {
                shader.lines.push(format!("float inputs:opacity = {}", 1.0 - m.transmission_weight));
            }
            (None, None) => {}
        }
    }

    /// Writes a colour that multiplies a picture.
    fn color(&mut self, shader: &mut Shader, input: &str, color: Vec3, picture: &TextureImage) {
        let Some(file) = self.export.color_file(picture, false, "color", |color| color) else { return };
        let node = texture(shader, input, &file.path, false, &picture.mapping);
        let [r, g, b] = color.to_array();
        let node = node.line(format!("float4 inputs:scale = ({r}, {g}, {b}, 1)"));
        shader.connect("color3f", input, node, "float3", "rgb");
    }

    /// Writes a number, which may multiply a picture. `channel` is used if the picture does not
    /// select one.
    fn number(
        &mut self,
        shader: &mut Shader,
        input: &str,
        number: f32,
        name: Option<&FileName>,
        channel: Option<Channel>,
    ) {
        match name {
            Some(name) => {
                let picture = self.export.picture(name);
                let channel = picture.mapping.channel.or(channel).unwrap_or(Channel::Red);
                self.number_picture(shader, input, number, &picture, channel);
            }
            None => shader.lines.push(format!("float inputs:{input} = {number}")),
        }
    }

    fn number_picture(
        &mut self,
        shader: &mut Shader,
        input: &str,
        number: f32,
        picture: &TextureImage,
        channel: Channel,
    ) {
        let output = match channel {
            Channel::Red | Channel::Angle => "r",
            Channel::Green => "g",
            Channel::Blue => "b",
            Channel::Alpha => "a",
        };
        let Some(file) = self.export.color_file(picture, true, "color", |color| color) else { return };
        let [low, high] = picture.mapping.range.map(|x| number * x);
        let node = texture(shader, input, &file.path, true, &picture.mapping)
            .line(format!("float4 inputs:scale = {}", tuple([high - low; 4])))
            .line(format!("float4 inputs:bias = {}", tuple([low; 4])));
        shader.connect("float", input, node, "float", output);
    }

    fn base_color(&mut self, m: &PrincipledMaterial) -> Vec3 {
        let measured =
            m.base_spectrum.as_ref().map(|name| (name, self.export.spectrum(name).and_then(Curve::reflectance)));
        let color = match measured {
            Some((_, Some(curve))) => curve.color(),
            Some((name, None)) => {
                self.export
                    .warn_lost(format!("the spectrum `{}` cannot be read: the base colour is written", name.path));
                m.base_color
            }
            None => m.base_color,
        };
        // A metal reflects the weight of its highlight too.
        let weight = if m.base_metalness == 1.0 { m.specular_weight.min(1.0) } else { 1.0 };
        (weight * m.base_weight * color).clamp(Vec3::ZERO, Vec3::ONE)
    }

    /// Warns about parameters that `UsdPreviewSurface` lacks.
    fn report_losses(&mut self, m: &PrincipledMaterial) {
        const WRITTEN: [&str; 10] = [
            "base_color_texture",
            "base_metalness_texture",
            "specular_roughness_texture",
            "metallic_roughness_texture",
            "coat_weight_texture",
            "coat_roughness_texture",
            "opacity_texture",
            "emission_texture",
            "normal_texture",
            "",
        ];
        for row in TEXTURE_FIELDS.iter().filter(|row| !WRITTEN.contains(&row.field) && (row.texture_file)(m).is_some())
        {
            self.export
                .warn_lost(format!("textures of `{}` are not written to {PROGRAM}: they are left out", row.field));
        }
        let is_clear = m.transmission_weight > 0.0;
        let is_metal = m.base_metalness > 0.0;
        let losses = [
            (m.base_diffuse_roughness > 0.0, "rough diffuse surfaces", "a Lambertian surface is written"),
            (m.fuzz_weight > 0.0, "fuzz", "it is left out"),
            (m.subsurface_weight > 0.0, "subsurface scattering", "the base colour is written"),
            (m.thin_film_weight > 0.0, "thin films", "they are left out"),
            (m.specular_anisotropy > 0.0, "anisotropy", "highlights are round"),
            (m.disperses(), "dispersion", "it is left out"),
            (
                is_clear && m.walls == Walls::Solid,
                "glass bodies",
                "sheets that light crosses in a straight line are written",
            ),
            (is_clear && m.transmission_color != Vec3::ONE, "the colour of glass", "the sheet is clear"),
            (is_clear && m.opacity < 1.0, "glass with an opacity", "the opacity is written"),
            (m.backs == Backs::Black, "black back sides", "they are like the front sides"),
            (m.backs == Backs::Hidden, "hidden back sides", "they are visible"),
            (m.seen_by_camera == Switch::Off, "surfaces that the camera does not see", "they are visible"),
            (is_metal && m.metal_ior.is_some(), "the index of refraction of metals", "their colour is written"),
            (is_metal && m.specular_color != Vec3::ONE, "the tint of metals at grazing angles", "it is left out"),
            (is_metal && m.base_metalness < 1.0 && m.specular_weight != 1.0, "weights of mixed metals", "they are 1"),
            (m.specular_facets != Facets::Ggx, "facets other than GGX", "GGX is written"),
            (m.coat_weight > 0.0 && m.coat_ior != COAT_IOR, "the index of refraction of coats", "it is 1.5"),
            (m.coat_weight > 0.0 && m.coat_color != Vec3::ONE, "the colour of coats", "they are clear"),
            (m.coat_weight > 0.0 && m.coat_darkening != 1.0, "the darkening by coats", "it is that of a clear coat"),
            (
                m.energy_compensation == Switch::Off && is_metal && m.specular_roughness > 0.35,
                "the light that rough metals lose between facets",
                "they are brighter",
            ),
            (m.bump_texture.is_some(), "bump maps", "they are left out"),
            (m.walls == Walls::Thin && m.emission_luminance > 0.0, "light from both sides", "one side emits"),
        ];
        for (_, what, instead) in losses.into_iter().filter(|row| row.0) {
            self.export.warn_lost(format!("{what} cannot be written to {PROGRAM}: {instead}"));
        }
    }
}

impl Shader {
    /// Connects an input of the surface to an output of a node.
    fn connect(&mut self, kind: &str, input: &str, node: Prim, of: &str, output: &str) {
        let target = format!("{}/{}.outputs:{output}", self.path, node.name);
        self.lines.push(format!("{kind} inputs:{input}.connect = <{target}>"));
        self.nodes.push(node.line(format!("{of} outputs:{output}")));
    }
}

/// Returns the node of a texture for an input, and adds the nodes of its coordinates.
fn texture(shader: &mut Shader, input: &str, path: &str, is_raw: bool, mapping: &Mapping) -> Prim {
    let st = if mapping.second { "st1" } else { "st" };
    let reader = format!("Reader_{input}");
    shader.nodes.push(
        Prim::new("Shader", reader.clone())
            .line("uniform token info:id = \"UsdPrimvarReader_float2\"")
            .line(format!("string inputs:varname = \"{st}\""))
            .line("float2 outputs:result"),
    );
    let mut source = reader;
    if mapping.transform != Mapping::default().transform {
        let [scale, turn, translation] = parts(mapping.transform);
        let place = format!("Place_{input}");
        shader.nodes.push(
            Prim::new("Shader", place.clone())
                .line("uniform token info:id = \"UsdTransform2d\"")
                .line(format!("float2 inputs:in.connect = <{}/{source}.outputs:result>", shader.path))
                .line(format!("float2 inputs:scale = {}", tuple(scale)))
                .line(format!("float inputs:rotation = {}", turn[0]))
                .line(format!("float2 inputs:translation = {}", tuple(translation)))
                .line("float2 outputs:result"),
        );
        source = place;
    }
    let wrap = |wrap: Wrap| match wrap {
        Wrap::Repeat => "repeat",
        Wrap::Mirror => "mirror",
        Wrap::Clamp => "clamp",
    };
    Prim::new("Shader", format!("Texture_{input}"))
        .line("uniform token info:id = \"UsdUVTexture\"")
        .line(format!("asset inputs:file = @{path}@"))
        .line(format!("float2 inputs:st.connect = <{}/{source}.outputs:result>", shader.path))
        .line(format!("token inputs:sourceColorSpace = \"{}\"", if is_raw { "raw" } else { "sRGB" }))
        .line(format!("token inputs:wrapS = \"{}\"", wrap(mapping.wrap[0])))
        .line(format!("token inputs:wrapT = \"{}\"", wrap(mapping.wrap[1])))
}

/// Returns the scale, the rotation in degrees and the translation of coordinates with v upwards,
/// for a transform with v downwards.
pub(super) fn parts([[a, b, x], [c, d, y]]: [[f32; 3]; 2]) -> [[f32; 2]; 3] {
    // The reader makes the rows (cos sx, sin sy, x - sin sy) and (-sin sx, cos sy, 1 - cos sy - y).
    let (sx, side) = ((a * a + c * c).sqrt(), if a * d - b * c < 0.0 { -1.0 } else { 1.0 });
    let sy = side * (b * b + d * d).sqrt();
    let turn = durer_scene::math::fp::atan2(-c, a);
    [[sx, sy], [turn.to_degrees(), 0.0], [x + b, 1.0 - d - y]]
}
