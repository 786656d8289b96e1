//! Writes materials and their textures. The conversion is the inverse of that in the reader.

use super::text::Directive;
use super::{PROGRAM, Writer};
use crate::export::metal::indices_of_refraction;
use crate::export::picture::PictureFile;
use crate::export::surface::{MetalIndex, Opaque, Paint, Rough, Surface};
use durer_scene::bsdf::fresnel;
use durer_scene::material::principled::Facets;
use durer_scene::math::Vec3;
use durer_scene::scene::TextureImage;
use durer_scene::texture::{Mapping, Wrap};

/// Thickness of a coat, so thin that light crosses it without loss.
const THIN: f32 = 1e-6;

/// Normal map, and bump map with the height of white.
type Relief<'a> = (Option<&'a TextureImage>, Option<(&'a TextureImage, f32)>);

impl Writer<'_> {
    /// Writes a surface as a named material.
    pub(super) fn material(&mut self, name: &str, surface: &Surface) {
        let directive = Directive::new("MakeNamedMaterial", name);
        let directive = match surface {
            Surface::Opaque(opaque, both) => {
                if !both {
                    self.export.warn_lost("opaque surfaces of pbrt scatter light on both sides: backs are visible");
                }
                self.opaque(directive, opaque, None)
            }
            Surface::NormalMapped(inner, picture, _) => return self.relief(name, inner, Some(picture), None),
            Surface::BumpMapped(inner, picture, height, _) => {
                return self.relief(name, inner, None, Some((picture, *height)));
            }
            Surface::Glass { ior, rough, reflected, transmitted } => {
                self.warn_tint(*reflected, *transmitted);
                self.rough(directive.string("type", "dielectric").float("eta", ior), rough)
            }
            Surface::Pane { ior, reflected, transmitted } => {
                self.warn_tint(*reflected, *transmitted);
                directive.string("type", "thindielectric").float("eta", ior)
            }
            Surface::Sheet { color, through } => {
                if color.picture.is_some() {
                    self.export.warn_lost("sheets of pbrt that scatter light have no pictures: one colour is written");
                }
                let sheet = directive.string("type", "diffusetransmission");
                sheet.rgb("reflectance", (1.0 - through) * color.color).rgb("transmittance", through * color.color)
            }
            Surface::Mix(parts, share, picture) => {
                let names = [0, 1].map(|i| format!("{name}-{i}"));
                names.iter().zip(parts.iter()).for_each(|(name, part)| self.material(name, part));
                let mix = directive.string("type", "mix").texts("string", "materials", &[&names[0], &names[1]]);
                // The amount is that of the second material.
                let texture = picture.as_ref().and_then(|picture| {
                    let file = self.export.number_file(picture, &format!("amount-{share}"), |x| 1.0 - share * x)?;
                    Some(self.texture("float", &file, &picture.mapping, 1.0))
                });
                match texture {
                    Some(texture) => mix.texts("texture", "amount", &[&texture]),
                    None => mix.float("amount", 1.0 - share),
                }
            }
            Surface::Sides(parts) => {
                self.export.warn_lost("materials of pbrt are equal on both sides: that of the front is written");
                return self.material(name, &parts[0]);
            }
            // The opacity belongs to the shape.
            Surface::Masked(inner, ..) => return self.material(name, inner),
        };
        self.named += &directive.line();
    }

    /// Writes a surface with a normal map or a bump map.
    fn relief(
        &mut self,
        name: &str,
        inner: &Surface,
        normals: Option<&TextureImage>,
        heights: Option<(&TextureImage, f32)>,
    ) {
        let Surface::Opaque(opaque, _) = inner else {
            self.export.warn_lost("normal and bump maps are written to pbrt for opaque surfaces: others are smooth");
            return self.material(name, inner);
        };
        let relief = (normals, heights);
        let directive = Directive::new("MakeNamedMaterial", name);
        let line = self.opaque(directive, opaque, Some(relief)).line();
        self.named += &line;
    }

    fn opaque(&mut self, directive: Directive, opaque: &Opaque, relief: Option<Relief>) -> Directive {
        let directive = match opaque {
            Opaque::Diffuse(paint) => {
                self.paint(directive.string("type", "diffuse"), "reflectance", paint, "color", |color| color)
            }
            Opaque::Metal { f0, f82, index, picture, rough } => {
                let metal = self.rough(directive.string("type", "conductor"), rough);
                match (index, picture) {
                    (Some(MetalIndex { eta, k, tint }), None) => {
                        if *tint != Vec3::ONE {
                            self.export.warn_lost("metals of pbrt have no tint: it is left out");
                        }
                        metal.rgb("eta", *eta).rgb("k", *k)
                    }
                    (_, Some(picture)) => {
                        let paint = Paint { color: *f0, picture: Some(picture.clone()), is_linear: false };
                        self.paint(metal, "reflectance", &paint, "color", |color| color)
                    }
                    (None, None) => {
                        let [eta, k] = indices_of_refraction(*f0, *f82);
                        metal.rgb("eta", eta).rgb("k", k)
                    }
                }
            }
            Opaque::Plastic { base, ior, rough, specular, darkens } => {
                if *specular != Vec3::ONE {
                    self.export.warn_lost("coats of pbrt reflect white light: a coloured reflection is left out");
                }
                let coat = directive.string("type", "coateddiffuse").float("eta", ior).float("thickness", THIN);
                let coat = self.rough(coat, rough);
                // pbrt tints light each time it is reflected between base and boundary. If Dürer
                // does not, choose the colour for which the sum over all reflections is the same.
                let inside = fresnel::diffuse(1.0 / ior);
                let darker = |color: Vec3| color / (Vec3::splat(1.0 - inside) + inside * color);
                match darkens {
                    true => self.paint(coat, "reflectance", base, "color", |color| color),
                    false => self.paint(coat, "reflectance", base, &format!("coated-{ior}"), darker),
                }
            }
        };
        let Some((normals, heights)) = relief else { return directive };
        let mut directive = directive;
        if let Some(picture) = normals {
            if picture.mapping.strength != 1.0 || picture.mapping.transform != Mapping::default().transform {
                self.export
                    .warn_lost("normal maps of pbrt have no strength and no mapping: they are written as they are");
            }
            if let Some(file) = self.export.color_file(picture, true, "color", |color| color) {
                directive = directive.string("normalmap", &file.path);
            }
        }
        if let Some((picture, height)) = heights
            && let Some(file) = self.export.number_file(picture, "height", |x| x)
        {
            let texture = self.texture("float", &file, &picture.mapping, height);
            directive = directive.texts("texture", "displacement", &[&texture]);
        }
        directive
    }

    fn warn_tint(&mut self, reflected: Vec3, transmitted: Vec3) {
        if reflected != Vec3::ONE || transmitted != Vec3::ONE {
            self.export.warn_lost("glass of pbrt has no colour: clear glass is written");
        }
    }

    /// Adds alpha.
    fn rough(&mut self, directive: Directive, rough: &Rough) -> Directive {
        if rough.is_smooth() {
            return directive.float("roughness", 0);
        }
        if rough.facets == Facets::Beckmann {
            self.export.warn_lost("pbrt has no facets by Beckmann: GGX is written, whose highlights have longer tails");
        }
        let directive = directive.boolean("remaproughness", false);
        let [u, v] = rough.alpha;
        let texture = rough.picture.as_ref().and_then(|picture| {
            let file = self.export.number_file(picture, &format!("alpha-{u}"), |x| u * x * x)?;
            Some(self.texture("float", &file, &picture.mapping, 1.0))
        });
        match texture {
            Some(texture) => directive.texts("texture", "roughness", &[&texture]),
            None if u == v => directive.float("roughness", u),
            None => directive.float("uroughness", u).float("vroughness", v),
        }
    }

    /// Adds a colour, or a picture that is multiplied by the colour. `change`, which `what` names,
    /// is applied to the product.
    fn paint(
        &mut self,
        directive: Directive,
        name: &str,
        paint: &Paint,
        what: &str,
        change: impl Fn(Vec3) -> Vec3,
    ) -> Directive {
        let texture = paint.picture.as_ref().and_then(|picture| {
            let color = paint.color;
            let what = if color == Vec3::ONE { what.to_string() } else { format!("{what}-{color}") };
            let file = self.export.color_file(picture, paint.is_linear, &what, |p| change(p * color))?;
            Some(self.texture("spectrum", &file, &picture.mapping, 1.0))
        });
        match texture {
            Some(texture) => directive.texts("texture", name, &[&texture]),
            None => directive.rgb(name, change(paint.color).clamp(Vec3::ZERO, Vec3::ONE)),
        }
    }

    /// Writes a texture that shows a picture, and returns its name.
    pub(super) fn texture(&mut self, kind: &str, file: &PictureFile, mapping: &Mapping, scale: f32) -> String {
        let mut texture = Directive::empty();
        texture = texture.string("filename", &file.path);
        if file.is_linear {
            texture = texture.string("encoding", "linear");
        }
        if mapping.nearest {
            texture = texture.string("filter", "point");
        }
        match mapping.wrap {
            [Wrap::Repeat, Wrap::Repeat] => {}
            [Wrap::Clamp, Wrap::Clamp] => texture = texture.string("wrap", "clamp"),
            _ => self.export.warn_lost("pictures of pbrt repeat or are clamped on all sides: they repeat"),
        }
        if mapping.second {
            self.export.warn_lost(format!("{PROGRAM} has one set of texture coordinates: the first is used"));
        }
        let [[a, b, x], [c, d, y]] = mapping.transform;
        if b != 0.0 || c != 0.0 {
            self.export.warn_lost("pictures of pbrt are neither rotated nor sheared: that is left out");
        }
        // In pbrt, v increases upwards.
        let parts = [("uscale", a, 1.0), ("vscale", d, 1.0), ("udelta", x, 0.0), ("vdelta", 1.0 - d - y, 0.0)];
        for (name, value, _) in parts.into_iter().filter(|(_, value, default)| value != default) {
            texture = texture.float(name, value);
        }
        if scale != 1.0 {
            texture = texture.float("scale", scale);
        }
        let parameters = texture.line();
        let key = format!("{kind}{parameters}");
        let count = self.textures.len();
        let number = self.textures.get(&key).copied().unwrap_or(count);
        if number == count {
            self.named += &format!("Texture \"texture-{number}\" \"{kind}\" \"imagemap\"{parameters}");
            self.textures.insert(key, number);
        }
        format!("texture-{number}")
    }
}
