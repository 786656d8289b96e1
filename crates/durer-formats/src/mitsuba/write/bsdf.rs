//! Writes materials as BSDF plugins. The conversion is the inverse of that in the reader.

use super::element::Element;
use super::{PROGRAM, Writer};
use crate::export::metal::indices_of_refraction;
use crate::export::picture::PictureFile;
use crate::export::surface::{MetalIndex, Opaque, Paint, Rough, Surface};
use crate::mitsuba::rough::Boundary;
use durer_scene::material::principled::Facets;
use durer_scene::math::Vec3;
use durer_scene::scene::TextureImage;
use durer_scene::texture::{Mapping, Wrap};

impl Writer<'_> {
    /// Returns the element of a surface.
    pub(super) fn bsdf(&mut self, surface: &Surface) -> Element {
        match surface {
            Surface::Opaque(opaque, both) => {
                let element = self.opaque(opaque);
                if *both { Element::plugin("bsdf", "twosided").and(element) } else { element }
            }
            Surface::Glass { ior, rough, reflected, transmitted } => {
                let kind = if rough.is_smooth() { "dielectric" } else { "roughdielectric" };
                let glass = self.rough(Element::plugin("bsdf", kind), rough, true);
                tinted(glass.float("int_ior", ior).float("ext_ior", 1), *reflected, *transmitted)
            }
            Surface::Pane { ior, reflected, transmitted } => {
                let pane = Element::plugin("bsdf", "thindielectric").float("int_ior", ior).float("ext_ior", 1);
                tinted(pane, *reflected, *transmitted)
            }
            Surface::Sheet { color, through } => {
                // At this roughness, the diffuse lobe of Disney's material has an albedo of about
                // 1.
                const ROUGHNESS: f32 = 0.5;
                let albedo = crate::disney::diffuse_albedo(ROUGHNESS);
                if through.max_element() - through.min_element() > 1e-3 {
                    self.export.warn_lost("sheets of Mitsuba reflect and transmit one colour: their sum is written");
                }
                let through = through.element_sum() / 3.0;
                let color = Paint { color: color.color / albedo, ..color.clone() };
                let sheet = Element::plugin("bsdf", "principledthin").float("diff_trans", 2.0 * through);
                self.paint(sheet.float("roughness", ROUGHNESS), "base_color", &color)
            }
            Surface::Mix(parts, share, picture) => {
                // The weight is that of the second material.
                let mix = Element::plugin("bsdf", "blendbsdf");
                let file = picture.as_ref().and_then(|picture| {
                    let file = self.export.number_file(picture, &format!("weight-{share}"), |x| 1.0 - share * x)?;
                    Some(self.bitmap("weight", &file, &picture.mapping))
                });
                let mix = match file {
                    Some(file) => mix.and(file),
                    None => mix.float("weight", 1.0 - share),
                };
                let [first, second] = &**parts;
                let first = self.bsdf(first);
                mix.and(first).and(self.bsdf(second))
            }
            Surface::Sides(parts) => {
                let sides = [&parts[0], &parts[1]].map(|side| self.bsdf(&one_sided(side)));
                Element::plugin("bsdf", "twosided").and_all(sides)
            }
            Surface::Masked(inner, opacity, mask) => {
                let masked = Element::plugin("bsdf", "mask");
                let file = mask.as_ref().and_then(|mask| {
                    let file = self.export.opacity_file(mask, *opacity)?;
                    Some(self.bitmap("opacity", &file, &mask.picture.mapping))
                });
                let masked = match file {
                    Some(bitmap) => masked.and(bitmap),
                    None => masked.float("opacity", opacity),
                };
                masked.and(self.bsdf(inner))
            }
            Surface::NormalMapped(inner, picture, shadows) => {
                if picture.mapping.strength != 1.0 {
                    self.export.warn_lost("normal maps of Mitsuba have no strength: they are written as they are");
                }
                let inner = self.bsdf(inner);
                match self.export.color_file(picture, true, "color", |color| color) {
                    Some(file) => Element::plugin("bsdf", "normalmap")
                        .and(self.bitmap("normalmap", &file, &picture.mapping))
                        .boolean("use_shadowing_function", *shadows)
                        .and(inner),
                    None => inner,
                }
            }
            Surface::BumpMapped(inner, picture, height, shadows) => {
                let inner = self.bsdf(inner);
                match self.export.number_file(picture, "height", |x| x) {
                    Some(file) => Element::plugin("bsdf", "bumpmap")
                        .and(self.bitmap("arbitrary", &file, &picture.mapping))
                        .float("scale", height)
                        .boolean("use_shadowing_function", *shadows)
                        .and(inner),
                    None => inner,
                }
            }
        }
    }

    fn opaque(&mut self, opaque: &Opaque) -> Element {
        match opaque {
            Opaque::Diffuse(paint) => self.paint(Element::plugin("bsdf", "diffuse"), "reflectance", paint),
            Opaque::Metal { f0, f82, index, picture, rough } => {
                self.metal([*f0, *f82], *index, picture.as_ref(), rough)
            }
            Opaque::Plastic { base, ior, rough, specular, darkens } => {
                let is_smooth = rough.is_smooth();
                let kind = if is_smooth { "plastic" } else { "roughplastic" };
                let mut paint = base.clone();
                if !is_smooth {
                    // The inverse of the reader's conversion.
                    let boundary = Boundary::new(*ior, rough.alpha[0].sqrt(), rough.facets);
                    let fades = *darkens && base.picture.is_none();
                    paint.color = base.color.map(|color| boundary.color(color, fades));
                    // Rough plastic of Mitsuba loses light between its facets. A colour above 1
                    // cannot make up for that, but Disney's material loses none.
                    if paint.color.max_element() > 1.0 + 1e-3 {
                        return self.disney(base, *ior, *specular, rough);
                    }
                }
                let plastic = self.rough(Element::plugin("bsdf", kind), rough, false);
                let plastic = plastic.float("int_ior", ior).float("ext_ior", 1).boolean("nonlinear", *darkens);
                let plastic =
                    if *specular == Vec3::ONE { plastic } else { plastic.rgb("specular_reflectance", *specular) };
                self.paint(plastic, "diffuse_reflectance", &paint)
            }
        }
    }

    /// Returns an opaque dielectric with the layers of Disney's material.
    fn disney(&mut self, base: &Paint, ior: f32, specular: Vec3, rough: &Rough) -> Element {
        if specular != Vec3::ONE {
            self.export.warn_lost("`principled` of Mitsuba has no colour of its highlights: they are white");
        }
        let roughness = (rough.alpha[0] * rough.alpha[1]).sqrt().sqrt();
        let element = Element::plugin("bsdf", "principled").float("eta", ior);
        let file = rough.picture.as_ref().and_then(|picture| {
            let what = format!("roughness-{roughness}");
            Some((self.export.number_file(picture, &what, |x| roughness * x)?, picture.mapping))
        });
        let element = match file {
            Some((file, mapping)) => element.and(self.bitmap("roughness", &file, &mapping)),
            None => element.float("roughness", roughness),
        };
        self.paint(element, "base_color", base)
    }

    fn metal(
        &mut self,
        [f0, f82]: [Vec3; 2],
        index: Option<MetalIndex>,
        picture: Option<&TextureImage>,
        rough: &Rough,
    ) -> Element {
        let kind = if rough.is_smooth() { "conductor" } else { "roughconductor" };
        let metal = self.rough(Element::plugin("bsdf", kind), rough, true);
        if let Some(MetalIndex { eta, k, tint }) = index {
            let paint = Paint { color: tint, picture: picture.cloned(), is_linear: false };
            return self.paint(metal.rgb("eta", eta).rgb("k", k), "specular_reflectance", &paint);
        }
        if let Some(picture) = picture {
            let paint = Paint { color: f0, picture: Some(picture.clone()), is_linear: false };
            return self.paint(metal.text("material", "none"), "specular_reflectance", &paint);
        }
        // Mirrors have the same colour at all angles.
        if (f0 - f82).abs().max_element() < 1e-3 {
            return metal.text("material", "none").rgb("specular_reflectance", f0.min(Vec3::ONE));
        }
        let [eta, k] = indices_of_refraction(f0, f82);
        metal.rgb("eta", eta).rgb("k", k)
    }

    /// Adds the distribution of the facets. `can_stretch` is true if alpha can differ along u and v
    /// and can have a picture.
    fn rough(&mut self, element: Element, rough: &Rough, can_stretch: bool) -> Element {
        if rough.is_smooth() {
            return element;
        }
        let distribution = if rough.facets == Facets::Beckmann { "beckmann" } else { "ggx" };
        let element = element.text("distribution", distribution);
        let [u, v] = rough.alpha;
        if let Some(picture) = rough.picture.as_ref().filter(|_| can_stretch) {
            let file = self.export.number_file(picture, &format!("alpha-{u}"), |x| u * x * x);
            if let Some(file) = file {
                return element.and(self.bitmap("alpha", &file, &picture.mapping));
            }
        }
        if rough.picture.is_some() {
            self.export.warn_lost("plastic of Mitsuba has no picture of its roughness: one roughness is written");
        }
        match u == v || !can_stretch {
            true => element.float("alpha", (u * v).sqrt()),
            false => element.float("alpha_u", u).float("alpha_v", v),
        }
    }

    /// Adds a colour, or a picture that is multiplied by the colour.
    fn paint(&mut self, element: Element, name: &'static str, paint: &Paint) -> Element {
        let file = paint.picture.as_ref().and_then(|picture| {
            let color = paint.color;
            let what = if color == Vec3::ONE { "color".to_string() } else { format!("color-{color}") };
            Some((self.export.color_file(picture, paint.is_linear, &what, |p| p * color)?, picture.mapping))
        });
        if paint.color.max_element() > 1.0 + 1e-3 {
            self.export.warn_lost("reflectances of Mitsuba are at most 1: brighter colours are clipped");
        }
        match file {
            Some((file, mapping)) => element.and(self.bitmap(name, &file, &mapping)),
            None => element.rgb(name, paint.color.clamp(Vec3::ZERO, Vec3::ONE)),
        }
    }

    /// Returns the element of a picture.
    pub(super) fn bitmap(&mut self, name: &'static str, file: &PictureFile, mapping: &Mapping) -> Element {
        let mut bitmap = Element::plugin("texture", "bitmap").with("name", name).text("filename", &file.path);
        if file.is_linear {
            bitmap = bitmap.boolean("raw", true);
        }
        if mapping.nearest {
            bitmap = bitmap.text("filter_type", "nearest");
        }
        if mapping.wrap[0] != mapping.wrap[1] {
            self.export
                .warn_lost("pictures of Mitsuba continue in the same way in both directions: the first is written");
        }
        match mapping.wrap[0] {
            Wrap::Repeat => {}
            Wrap::Mirror => bitmap = bitmap.text("wrap_mode", "mirror"),
            Wrap::Clamp => bitmap = bitmap.text("wrap_mode", "clamp"),
        }
        if mapping.second {
            self.export.warn_lost(format!("{PROGRAM} has one set of texture coordinates: the first is used"));
        }
        if mapping.transform == Mapping::default().transform {
            return bitmap;
        }
        let [[a, b, x], [c, d, y]] = mapping.transform;
        let matrix = Element::new("matrix").with("value", format!("{a} {b} 0 {x} {c} {d} 0 {y} 0 0 1 0 0 0 0 1"));
        bitmap.and(Element::new("transform").with("name", "to_uv").and(matrix))
    }
}

/// Returns the surface without light on its back.
fn one_sided(surface: &Surface) -> Surface {
    match surface {
        Surface::Opaque(opaque, _) => Surface::Opaque(opaque.clone(), false),
        Surface::Mix(parts, share, picture) => {
            Surface::Mix(Box::new([one_sided(&parts[0]), one_sided(&parts[1])]), *share, picture.clone())
        }
        Surface::NormalMapped(inner, picture, shadows) => {
            Surface::NormalMapped(Box::new(one_sided(inner)), picture.clone(), *shadows)
        }
        Surface::BumpMapped(inner, picture, height, shadows) => {
            Surface::BumpMapped(Box::new(one_sided(inner)), picture.clone(), *height, *shadows)
        }
        other => other.clone(),
    }
}

/// Adds the colours of reflected and transmitted light, unless they are white.
fn tinted(element: Element, reflected: Vec3, transmitted: Vec3) -> Element {
    let element = if reflected == Vec3::ONE { element } else { element.rgb("specular_reflectance", reflected) };
    if transmitted == Vec3::ONE { element } else { element.rgb("specular_transmittance", transmitted) }
}
