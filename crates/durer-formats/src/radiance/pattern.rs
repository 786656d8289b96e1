//! Patterns and textures: each is replaced by a constant colour, the mean if it can be computed.

use super::args::Thing;
use super::data::Table;
use super::made::Below;
use super::sky::Sky;
use super::spread::{self, Lamp, Spread};
use super::state::Reader;
use super::words::Word;
use super::xform::Transform;
use crate::number::parse_f32;
use crate::pictures::unusable;
use durer_image::{self as image, Encoded};
use durer_scene::math::{Color, Vec3};
use glam::{DAffine3, DMat3};
use std::rc::Rc;

impl Reader<'_> {
    /// Evaluates a pattern, a modifier given by its index, as a factor of the emission or
    /// reflectance. `map` is the transform of the text that contains it.
    pub fn pattern(&mut self, number: usize, thing: &Thing, map: &DAffine3) -> Below {
        let (at, kind, said) = (thing.at(), thing.kind.text.as_str(), self.said);
        let text = |i: usize| thing.texts.get(i).map_or("", |word| word.text.as_str());
        let literal = |i: usize| parse_f32(text(i).as_bytes()).ok().map(|x| x.max(0.0));
        let tint = match kind {
            "texfunc" | "texdata" => {
                said.once(at, "textures (bumps) have no counterpart: the surface stays unchanged");
                Vec3::ONE
            }
            "brightfunc" if text(0) == "skybr" => {
                let sky = Sky::of(thing, map.matrix3 * self.own_turn(thing, 2), said);
                return Below { sky, ..Below::default() };
            }
            "brightfunc" if text(0) == "skybright" && text(1).ends_with("perezlum.cal") => {
                let sky = Sky::perez(thing, map.matrix3 * self.own_turn(thing, 2), said);
                return Below { sky, ..Below::default() };
            }
            "brightfunc" if literal(0).is_some() => Vec3::splat(literal(0).unwrap_or(1.0)),
            "colorfunc" if (0..3).all(|i| literal(i).is_some()) => {
                Vec3::from_array([0, 1, 2].map(|i| literal(i).unwrap_or(1.0)))
            }
            "brightfunc" | "colorfunc" | "spectrum" => {
                said.once(at, format!("function patterns (`{kind}`) have no counterpart: the pattern is left out"));
                Vec3::ONE
            }
            "brighttext" | "colortext" => {
                said.once(at, "text has no counterpart: its background is used");
                background(thing)
            }
            "colorpict" => match thing.texts.get(3).and_then(|name| self.mean_of_picture(name)) {
                Some(mean) => {
                    said.once(at, "picture patterns have no counterpart: the mean colour is used");
                    mean
                }
                None => Vec3::ONE,
            },
            "brightdata" if spread::coordinates(thing) > 0 => {
                if let Some(spread) = self.spread(number, thing, map) {
                    return Below { spread: Some(spread), ..Below::default() };
                }
                Vec3::splat(self.mean_of_data(thing, thing.texts.get(1)))
            }
            "brightdata" => Vec3::splat(self.mean_of_data(thing, thing.texts.get(1))),
            "colordata" => Vec3::from_array([0, 1, 2].map(|i| self.mean_of_data(thing, thing.texts.get(3 + i)))),
            _ => Vec3::ONE,
        };
        Below { tint, ..Below::default() }
    }

    /// Rotation that `xform` appended after the first `names` words of a function's arguments.
    fn own_turn(&self, thing: &Thing, names: usize) -> DMat3 {
        let (mut rest, mut transform) = (thing.texts.get(names..).unwrap_or_default(), Transform::default());
        while transform.option(&mut rest, self.said) {}
        transform.places().and_then(|places| places.first().map(|map| map.matrix3)).unwrap_or(DMat3::IDENTITY)
    }

    /// Table of a light's directional distribution; it is read once.
    fn spread(&mut self, number: usize, thing: &Thing, map: &DAffine3) -> Option<Rc<Spread>> {
        if let Some(known) = self.spreads.get(&number) {
            return Some(known.clone());
        }
        let table = self.table(thing, thing.texts.get(1))?;
        let turn = map.matrix3 * self.own_turn(thing, 3 + spread::coordinates(thing));
        let turn = (turn * (1.0 / turn.x_axis.length())).transpose();
        let spread = Rc::new(Spread::Table(Lamp::new(thing, table, turn)?));
        self.spreads.insert(number, spread.clone());
        Some(spread)
    }

    fn table(&self, thing: &Thing, name: Option<&Word>) -> Option<Table> {
        let Some(name) = name else {
            self.said.bad(thing.at(), "a data pattern needs a function, a file and coordinates");
            return None;
        };
        let (bytes, file) = self.open(name)?;
        Table::read(&bytes, file, self.said)
    }

    /// Mean of a data file.
    fn mean_of_data(&self, thing: &Thing, name: Option<&Word>) -> f32 {
        let Some(table) = self.table(thing, name) else { return 1.0 };
        self.said.once(thing.at(), "data patterns have no counterpart: the mean is used");
        table.mean()
    }

    /// Mean colour of a picture.
    fn mean_of_picture(&self, name: &Word) -> Option<Color> {
        let (bytes, _) = self.open(name)?;
        // The names of Radiance's pictures follow no rule, so the content decides.
        let hint = if bytes.starts_with(b"#?") { "picture.hdr" } else { name.text.as_str() };
        let memory = self.input.memory;
        let read = Encoded::open(&bytes, hint).and_then(|encoded| encoded.read(memory, image::decode_srgb));
        match read {
            Ok(picture) => {
                let sum: glam::DVec3 = picture.pixels.iter().filter(|p| p.is_finite()).map(|p| p.as_dvec3()).sum();
                Some((sum / picture.pixels.len().max(1) as f64).as_vec3())
            }
            Err(error) => {
                self.said.push(unusable(&name.text, &error).at(name.at));
                None
            }
        }
    }
}

/// Colour around letters. The arguments are nine numbers of their position, the foreground and
/// background colours, and distances.
fn background(thing: &Thing) -> Color {
    match thing.kind.text.as_str() {
        "brighttext" => Vec3::splat(thing.number(10).unwrap_or(1.0).max(0.0)),
        _ if thing.numbers.len() >= 15 => thing.color(12),
        _ => Vec3::ONE,
    }
}
