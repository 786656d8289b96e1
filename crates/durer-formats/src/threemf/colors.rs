//! Parses property resources, which are colours, mixtures of colours, and texture coordinates.

use super::model::{Color, Model, Properties, PropertyKind};
use super::parser::{ErrorReported, Parser};
use crate::xml::Tag;
use durer_image::decode_hexadecimal;
use durer_scene::math::Vec2;

impl Model {
    /// Returns the number of entries in a property list.
    pub fn count(&self, id: u32) -> Option<usize> {
        match &self.properties.get(&id)?.group {
            PropertyKind::Colors(colors) => Some(colors.len()),
            PropertyKind::Texture { uvs, .. } => Some(uvs.len()),
            PropertyKind::Picture { .. } => None,
        }
    }

    /// Returns the colour of a property, which is white for texture coordinates.
    fn color(&self, id: u32, index: u32) -> Option<Color> {
        match &self.properties.get(&id)?.group {
            PropertyKind::Colors(colors) => colors.get(index as usize).copied(),
            PropertyKind::Texture { uvs, .. } => uvs.get(index as usize).map(|_| [1.0; 4]),
            PropertyKind::Picture { .. } => None,
        }
    }
}

impl Parser<'_, '_> {
    /// Reads a property list.
    pub fn properties(&mut self, tag: &Tag) -> Result<(), ErrorReported> {
        let id = self.new_id(tag);
        let group = match tag.name {
            "basematerials" => self.colors("base", "displaycolor")?,
            "colorgroup" => self.colors("color", "color")?,
            "texture2d" => self.picture(tag)?,
            "texture2dgroup" => self.texture(tag)?,
            "compositematerials" => self.composites(tag)?,
            _ => self.multiproperties(tag)?,
        };
        if let (Some(id), Some(group)) = (id, group) {
            self.model.properties.insert(id, Properties { group, at: tag.at });
        }
        Ok(())
    }

    /// Reads an sRGB colour in the form `#RRGGBB` or `#RRGGBBAA` and returns linear values.
    fn color(&self, tag: &Tag, name: &str) -> Option<Color> {
        let Some(attribute) = tag.get(name) else {
            self.report.error(tag.at, format!("`<{}>` needs `{name}=\"#RRGGBB\"`", tag.name));
            return None;
        };
        let (color, alpha) = attribute.value.split_at_checked(7).unwrap_or((&attribute.value, ""));
        let color = decode_hexadecimal(color).and_then(|[r, g, b]| {
            let alpha = match alpha.len() {
                0 => 255,
                2 => u8::from_str_radix(alpha, 16).ok()?,
                _ => return None,
            };
            Some([r, g, b, f32::from(alpha) / 255.0])
        });
        if color.is_none() {
            self.report.error(attribute.at, format!("expected a colour as #RRGGBB, found `{}`", attribute.value));
        }
        color
    }

    fn colors(&mut self, name: &str, attribute: &str) -> Result<Option<PropertyKind>, ErrorReported> {
        let mut colors = Vec::new();
        while let Some(tag) = self.next()? {
            if tag.name == name {
                colors.push(self.color(&tag, attribute).unwrap_or([1.0; 4]));
            }
            self.skip()?;
        }
        Ok(Some(PropertyKind::Colors(colors)))
    }

    fn picture(&mut self, tag: &Tag) -> Result<Option<PropertyKind>, ErrorReported> {
        self.skip()?;
        let Some(path) = tag.get("path") else {
            self.report.error(tag.at, "`<texture2d>` needs `path=\"...\"`");
            return Ok(None);
        };
        let styles = ["tilestyleu", "tilestylev"].map(|name| tag.get(name).map(|style| style.value.to_string()));
        Ok(Some(PropertyKind::Picture { part: path.value.trim_start_matches('/').to_string(), styles, at: path.at }))
    }

    fn texture(&mut self, tag: &Tag) -> Result<Option<PropertyKind>, ErrorReported> {
        let picture = self.integer(tag, "texid");
        let mut uvs = Vec::new();
        while let Some(place) = self.next()? {
            if place.name == "tex2coord" {
                let [u, v] = ["u", "v"].map(|name| self.number(&place, name).unwrap_or(0.0));
                uvs.push(Vec2::new(u, v));
            }
            self.skip()?;
        }
        Ok(picture.map(|picture| PropertyKind::Texture { picture, uvs }))
    }

    /// Reads integers that are separated by spaces.
    fn list(&self, tag: &Tag, name: &str) -> Vec<u32> {
        let Some(attribute) = tag.get(name) else {
            self.report.error(tag.at, format!("`<{}>` needs `{name}=\"...\"`", tag.name));
            return Vec::new();
        };
        let numbers: Option<Vec<u32>> = attribute.value.split_whitespace().map(|word| word.parse().ok()).collect();
        numbers.unwrap_or_else(|| {
            self.report.error(attribute.at, format!("expected whole numbers, found `{}`", attribute.value));
            Vec::new()
        })
    }

    /// Reads composite materials, which are mixtures of base materials in given proportions.
    fn composites(&mut self, tag: &Tag) -> Result<Option<PropertyKind>, ErrorReported> {
        let (base, indices) = (self.integer(tag, "matid"), self.list(tag, "matindices"));
        let known = base.and_then(|base| self.model.count(base));
        if let (Some(base), None) = (base, known) {
            self.report.error(tag.at, format!("no base material list {base} is defined before this point"));
        }
        let parts: Vec<Color> = indices.iter().filter_map(|index| self.model.color(base?, *index)).collect();
        if known.is_some() && parts.len() < indices.len() {
            self.report.error(tag.at, "`matindices` refers to base materials that do not exist");
        }
        let mut colors = Vec::new();
        while let Some(mixture) = self.next()? {
            if mixture.name == "composite" {
                let text = mixture.get("values").map_or("", |values| &values.value).to_string();
                let shares = text.split_whitespace().map(|word| word.parse::<f32>().unwrap_or(0.0).max(0.0));
                let shares: Vec<f32> = shares.take(parts.len()).collect();
                let sum: f32 = shares.iter().sum();
                let mix = |channel: usize| match sum > 0.0 && sum.is_finite() {
                    true => shares.iter().zip(&parts).map(|(share, part)| share * part[channel]).sum::<f32>() / sum,
                    false => parts.iter().map(|part| part[channel]).sum::<f32>() / parts.len().max(1) as f32,
                };
                colors.push([mix(0), mix(1), mix(2), mix(3)]);
            }
            self.skip()?;
        }
        Ok(Some(PropertyKind::Colors(colors)))
    }

    /// Reads multiproperties, which are layers of properties; the last layer is on top.
    fn multiproperties(&mut self, tag: &Tag) -> Result<Option<PropertyKind>, ErrorReported> {
        let pids = self.list(tag, "pids");
        if let Some(missing) = pids.iter().find(|pid| !self.model.properties.contains_key(pid)) {
            self.report.error(tag.at, format!("no property list {missing} is defined before this point"));
        }
        if pids
            .iter()
            .any(|pid| matches!(self.model.properties.get(pid).map(|p| &p.group), Some(PropertyKind::Texture { .. })))
        {
            self.report.unsupported_once(
                tag.at,
                "pictures in multiproperties have no counterpart: only the colours are shown",
            );
        }
        let mut colors = Vec::new();
        while let Some(several) = self.next()? {
            if several.name == "multi" {
                let indices = self.list(&several, "pindices");
                let layers = pids.iter().enumerate().filter_map(|(i, pid)| {
                    let color = self.model.color(*pid, indices.get(i).copied().unwrap_or(0));
                    let texture = matches!(self.model.properties.get(pid)?.group, PropertyKind::Texture { .. });
                    color.filter(|_| !texture)
                });
                // Each layer hides the layers below it in proportion to its opacity.
                let over = layers.reduce(|below, above| {
                    let a = above[3];
                    let mix = |c: usize| a * above[c] + (1.0 - a) * below[c];
                    [mix(0), mix(1), mix(2), a + (1.0 - a) * below[3]]
                });
                colors.push(over.unwrap_or([1.0; 4]));
            }
            self.skip()?;
        }
        Ok(Some(PropertyKind::Colors(colors)))
    }
}
