//! Evaluates patterns and textures. Each of them is replaced with a constant colour, which is its
//! mean if the mean can be computed.

use super::args::RadPrimitive;
use super::converted::PatternEffect;
use super::data::Table;
use super::distribution::{self, DirectionalDistribution, IntensityTable};
use super::sky::Sky;
use super::state::Reader;
use super::words::Word;
use super::xform::TransformSequence;
use crate::number::parse_f32;
use crate::pictures::picture_error;
use durer_image::{self as image, Encoded};
use durer_scene::math::{Color, Vec3};
use glam::{DAffine3, DMat3};
use std::rc::Rc;

impl Reader<'_> {
    /// Evaluates the pattern with the index `number` as a factor on the emission or reflectance.
    /// `transform` is the transform of the text that contains the pattern.
    pub fn pattern(&mut self, number: usize, primitive: &RadPrimitive, transform: &DAffine3) -> PatternEffect {
        let (at, kind, report) = (primitive.at(), primitive.kind.text.as_str(), self.report);
        let text = |i: usize| primitive.texts.get(i).map_or("", |word| word.text.as_str());
        let literal = |i: usize| parse_f32(text(i).as_bytes()).ok().map(|x| x.max(0.0));
        let tint = match kind {
            "texfunc" | "texdata" => {
                report.unsupported_once(at, "textures (bumps) have no counterpart: the surface stays unchanged");
                Vec3::ONE
            }
            "brightfunc" if text(0) == "skybr" => {
                let sky = Sky::of(primitive, transform.matrix3 * self.trailing_rotation(primitive, 2), report);
                return PatternEffect { sky, ..PatternEffect::default() };
            }
            "brightfunc" if text(0) == "skybright" && text(1).ends_with("perezlum.cal") => {
                let sky = Sky::perez(primitive, transform.matrix3 * self.trailing_rotation(primitive, 2), report);
                return PatternEffect { sky, ..PatternEffect::default() };
            }
            "brightfunc" if literal(0).is_some() => Vec3::splat(literal(0).unwrap_or(1.0)),
            "colorfunc" if (0..3).all(|i| literal(i).is_some()) => {
                Vec3::from_array([0, 1, 2].map(|i| literal(i).unwrap_or(1.0)))
            }
            "brightfunc" | "colorfunc" | "spectrum" => {
                report.unsupported_once(
                    at,
                    format!("function patterns (`{kind}`) have no counterpart: the pattern is left out"),
                );
                Vec3::ONE
            }
            "brighttext" | "colortext" => {
                report.unsupported_once(at, "text has no counterpart: its background is used");
                background(primitive)
            }
            "colorpict" => match primitive.texts.get(3).and_then(|name| self.mean_of_picture(name)) {
                Some(mean) => {
                    report.unsupported_once(at, "picture patterns have no counterpart: the mean colour is used");
                    mean
                }
                None => Vec3::ONE,
            },
            "brightdata" if distribution::coordinates(primitive) > 0 => {
                if let Some(spread) = self.distribution_table(number, primitive, transform) {
                    return PatternEffect { spread: Some(spread), ..PatternEffect::default() };
                }
                Vec3::splat(self.mean_of_data(primitive, primitive.texts.get(1)))
            }
            "brightdata" => Vec3::splat(self.mean_of_data(primitive, primitive.texts.get(1))),
            "colordata" => {
                Vec3::from_array([0, 1, 2].map(|i| self.mean_of_data(primitive, primitive.texts.get(3 + i))))
            }
            _ => Vec3::ONE,
        };
        PatternEffect { tint, ..PatternEffect::default() }
    }

    /// Returns the rotation that `xform` has appended to the arguments of a function, after the
    /// first `names` words.
    fn trailing_rotation(&self, primitive: &RadPrimitive, names: usize) -> DMat3 {
        let (mut rest, mut transform) =
            (primitive.texts.get(names..).unwrap_or_default(), TransformSequence::default());
        while transform.option(&mut rest, self.report) {}
        transform.copies().and_then(|places| places.first().map(|map| map.matrix3)).unwrap_or(DMat3::IDENTITY)
    }

    /// Returns the table for the directional distribution of a light. Each table is read only once.
    fn distribution_table(
        &mut self,
        number: usize,
        primitive: &RadPrimitive,
        transform: &DAffine3,
    ) -> Option<Rc<DirectionalDistribution>> {
        if let Some(cached) = self.distributions.get(&number) {
            return Some(cached.clone());
        }
        let table = self.table(primitive, primitive.texts.get(1))?;
        let turn = transform.matrix3 * self.trailing_rotation(primitive, 3 + distribution::coordinates(primitive));
        let turn = (turn * (1.0 / turn.x_axis.length())).transpose();
        let spread = Rc::new(DirectionalDistribution::Table(IntensityTable::new(primitive, table, turn)?));
        self.distributions.insert(number, spread.clone());
        Some(spread)
    }

    fn table(&self, primitive: &RadPrimitive, name: Option<&Word>) -> Option<Table> {
        let Some(name) = name else {
            self.report.error(primitive.at(), "a data pattern needs a function, a file and coordinates");
            return None;
        };
        let (bytes, file) = self.open(name)?;
        Table::read(&bytes, file, self.report)
    }

    /// Returns the mean of the values in a data file.
    fn mean_of_data(&self, primitive: &RadPrimitive, name: Option<&Word>) -> f32 {
        let Some(table) = self.table(primitive, name) else { return 1.0 };
        self.report.unsupported_once(primitive.at(), "data patterns have no counterpart: the mean is used");
        table.mean()
    }

    /// Returns the mean colour of a picture.
    fn mean_of_picture(&self, name: &Word) -> Option<Color> {
        let (bytes, _) = self.open(name)?;
        // The names of Radiance pictures follow no convention, so their format is recognized by the
        // content.
        let hint = if bytes.starts_with(b"#?") { "picture.hdr" } else { name.text.as_str() };
        let memory = self.input.memory;
        let read = Encoded::open(&bytes, hint).and_then(|encoded| encoded.read(memory, image::decode_srgb));
        match read {
            Ok(picture) => {
                let sum: glam::DVec3 = picture.pixels.iter().filter(|p| p.is_finite()).map(|p| p.as_dvec3()).sum();
                Some((sum / picture.pixels.len().max(1) as f64).as_vec3())
            }
            Err(error) => {
                self.report.push(picture_error(&name.text, &error).at(name.at));
                None
            }
        }
    }
}

/// Returns the colour of the area around letters. The arguments are nine coordinates for the
/// position of the letters, the foreground and background colours, and distances.
fn background(primitive: &RadPrimitive) -> Color {
    match primitive.kind.text.as_str() {
        "brighttext" => Vec3::splat(primitive.number(10).unwrap_or(1.0).max(0.0)),
        _ if primitive.numbers.len() >= 15 => primitive.color(12),
        _ => Vec3::ONE,
    }
}
