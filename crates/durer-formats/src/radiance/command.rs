//! Executes the commands `!xform`, `!cat`, `!genbox`, `!genprism` and `!gensky`, whose output can
//! be piped into `xform`. The reader does not run any program, but generates the output itself.

use super::body::Facets;
use super::context::PrimitiveContext;
use super::gensky;
use super::state::Reader;
use super::words::{Word, Words};
use super::xform::TransformSequence;
use crate::report::quoted;
use durer_diag::Diagnostic;
use glam::{DAffine3, DVec3};
use std::sync::Arc;

/// Transforms and settings, with one entry for each copy of a command's output.
type Places = Vec<PrimitiveContext>;

impl Reader<'_> {
    /// Executes a command.
    pub(super) fn command(&mut self, mut words: Words, place: &PrimitiveContext) {
        let mut stages: Vec<Vec<Word>> = vec![Vec::new()];
        while let Some(word) = words.next() {
            match word.text.as_str() {
                "|" => stages.push(Vec::new()),
                _ => stages.last_mut().into_iter().for_each(|stage| stage.push(word.clone())),
            }
        }
        if let Some(empty) = stages.iter().position(Vec::is_empty) {
            let what =
                if stages.len() == 1 { "a command is missing after `!`" } else { "a command is missing beside `|`" };
            let at = stages.iter().skip(empty).flatten().next().map_or(words.end(), |word| word.at);
            return self.report.error(at, what);
        }
        // The output passes through the last stage of the pipe at the end, so the transform of that
        // stage is the outermost one.
        let mut places = vec![place.clone()];
        for stage in stages[1..].iter().rev() {
            if stage[0].text != "xform" {
                return refuse(self, &stage[0]);
            }
            let Some((next, files, _)) = xform(self, &stage[1..], &places) else { return };
            if let Some(file) = files.first() {
                return self.report.error(file.at, "`xform` after a `|` reads the piped text and takes no files");
            }
            places = next;
        }
        let (name, args) = (&stages[0][0], &stages[0][1..]);
        match name.text.as_str() {
            "xform" => {
                let Some((places, files, beside)) = xform(self, args, &places) else { return };
                if files.is_empty() {
                    self.report.error(name.at, "`xform` needs a file name here");
                }
                places.iter().for_each(|place| files.iter().for_each(|file| self.file(file, place, beside)));
            }
            "cat" => places.iter().for_each(|place| args.iter().for_each(|file| self.file(file, place, false))),
            "genbox" => {
                let facets = genbox(self, name, args);
                build(self, facets, args, &places);
            }
            "genprism" => {
                let facets = genprism(self, name, args, place);
                build(self, facets, args, &places);
            }
            "gensky" => {
                let Some(text) = gensky::text(self.report, name, args) else { return };
                let bytes: Arc<[u8]> = text.into_bytes().into();
                let file = self.input.files.borrow_mut().add("output of gensky", bytes.clone());
                places.iter().for_each(|place| self.text(&bytes, file, place));
            }
            _ => refuse(self, name),
        }
    }
}

/// Reports an unsupported command and suggests a workaround.
fn refuse(reader: &Reader, name: &Word) {
    let help = format!(
        "supported commands are `xform`, `cat`, `genbox`, `genprism` and `gensky`. Run Radiance's own `{}`, save its output in a \
         file beside the scene, and write `!cat FILE` here",
        name.text
    );
    let error = Diagnostic::error(format!("the command {} is not supported", name.quoted())).code("no-command");
    reader.report.push(Diagnostic { help: Some(help), ..error.at(name.at) });
}

/// Applies an `xform` command to each of the contexts in which it is used. Returns the new
/// contexts, the files that the command names, and whether commands in these files run in the
/// files' own folders.
fn xform<'w>(reader: &Reader, words: &'w [Word], outer: &[PrimitiveContext]) -> Option<(Places, &'w [Word], bool)> {
    let (mut transform, mut modifier, mut inverted) = (TransformSequence::default(), None, false);
    let mut beside = true;
    let mut rest = words;
    while let Some(option) = rest.first().filter(|word| word.text.starts_with('-')) {
        if transform.option(&mut rest, reader.report) {
            continue;
        }
        let takes = match option.text.as_str() {
            "-m" | "-n" => 1,
            "-c" | "-e" => {
                // The option `-c` copies commands unchanged, and `-e` expands them.
                beside = option.text == "-e";
                0
            }
            "-I" => {
                inverted = !inverted;
                0
            }
            _ => {
                reader.report.error(option.at, format!("`xform` has no option {}", option.quoted()));
                return None;
            }
        };
        if rest.len() <= takes {
            let needs = if takes == 1 { "needs a name" } else { "needs a file after it" };
            reader.report.error(option.at, format!("{} {needs}", option.quoted()));
            return None;
        }
        if option.text == "-m" {
            modifier = Some(rest[1].clone());
        }
        rest = &rest[1 + takes..];
    }
    let Some(maps) = transform.copies().filter(|maps| maps.len().saturating_mul(outer.len()) <= 1 << 20) else {
        reader.report.error(words[0].at, "these arrays make too many copies");
        return None;
    };
    let place = |outer: &PrimitiveContext, map: &DAffine3| PrimitiveContext {
        map: outer.map * *map,
        modifier: outer.modifier.clone().or_else(|| modifier.clone()),
        inverted: outer.inverted != inverted,
        ..outer.clone()
    };
    Some((outer.iter().flat_map(|outer| maps.iter().map(move |map| place(outer, map))).collect(), rest, beside))
}

/// Adds polygons whose material is the first argument of a generator.
fn build(reader: &mut Reader, facets: Option<Facets>, args: &[Word], places: &[PrimitiveContext]) {
    let Some(facets) = facets else { return };
    for place in places {
        let modifier = place.modifier.as_ref().unwrap_or(&args[0]);
        for (i, corners) in facets.iter().enumerate() {
            reader.facet(modifier, corners, &args[1], place, i == 0);
        }
    }
}

/// Reads the first `count` arguments of a generator, which must be numbers.
fn numbers(reader: &Reader, args: &[Word], count: usize) -> Option<Vec<f64>> {
    args[..count].iter().map(|word| word.number(reader.report)).collect()
}

fn genbox(reader: &Reader, name: &Word, args: &[Word]) -> Option<Facets> {
    if args.len() < 5 {
        reader.report.error(name.at, "`genbox` needs a material, a name and three sizes");
        return None;
    }
    let size = numbers(reader, &args[2..], 3)?;
    let mut inward = false;
    let mut rest = &args[5..];
    while let Some(option) = rest.first() {
        rest = &rest[1..];
        match option.text.as_str() {
            "-i" => inward = true,
            "-o" => {}
            "-b" | "-r" | "-n" => {
                reader.report.unsupported_once(
                    option.at,
                    "bevelled and rounded edges of `genbox` have no counterpart: sharp edges are used",
                );
                rest = rest.get(1..).unwrap_or_default();
            }
            "-s" => {}
            _ => {
                reader.report.error(option.at, format!("`genbox` has no option {}", option.quoted()));
                return None;
            }
        }
    }
    let corner = |i: usize| {
        DVec3::new(
            size[0] * f64::from(i as u8 & 1),
            size[1] * f64::from((i as u8 >> 1) & 1),
            size[2] * f64::from((i as u8 >> 2) & 1),
        )
    };
    const SIDES: [[usize; 4]; 6] = [[0, 2, 3, 1], [4, 5, 7, 6], [0, 1, 5, 4], [2, 6, 7, 3], [0, 4, 6, 2], [1, 3, 7, 5]];
    let negative = size.iter().filter(|x| **x < 0.0).count() % 2 == 1;
    Some(SIDES.iter().map(|side| reversed_if(side.map(corner).to_vec(), inward != negative)).collect())
}

/// Returns the corners, in reverse order if `other` is true.
fn reversed_if(mut corners: Vec<DVec3>, other: bool) -> Vec<DVec3> {
    if other {
        corners.reverse();
    }
    corners
}

fn genprism(reader: &mut Reader, name: &Word, args: &[Word], place: &PrimitiveContext) -> Option<Facets> {
    if args.len() < 3 {
        reader.report.error(name.at, "`genprism` needs a material, a name and the vertices of its base");
        return None;
    }
    let (corners, mut rest) = match args[2].text.parse::<usize>() {
        Ok(count) if (3..=args.len()).contains(&count) && args.len() >= 3 + 2 * count => {
            (numbers(reader, &args[3..], 2 * count)?, &args[3 + 2 * count..])
        }
        Ok(_) => {
            reader.report.error(args[2].at, "the base needs at least 3 vertices with 2 numbers each");
            return None;
        }
        Err(_) => {
            let (bytes, file) = reader.open(&place.resolved(&args[2]))?;
            let mut words = Words::new(&bytes, file, 0..bytes.len());
            let mut list = Vec::new();
            while let Some(word) = words.next() {
                list.push(word.number(reader.report)?);
            }
            if list.len() < 6 || list.len() % 2 != 0 {
                let name = quoted(args[2].text.as_bytes());
                let message = format!("the file {name} must contain at least 3 vertices with 2 numbers each");
                reader.report.error(args[2].at, message);
                return None;
            }
            (list, &args[3..])
        }
    };
    let (mut along, mut closed, mut ends) = (DVec3::Z, true, true);
    while let Some((option, more)) = rest.split_first() {
        rest = more;
        match option.text.as_str() {
            "-l" if more.len() >= 3 => {
                let v = numbers(reader, more, 3)?;
                (along, rest) = (DVec3::new(v[0], v[1], v[2]), &more[3..]);
            }
            "-c" => closed = false,
            "-e" => ends = false,
            "-r" if !more.is_empty() => {
                reader.report.unsupported_once(
                    option.at,
                    "rounded edges of `genprism` have no counterpart: sharp edges are used",
                );
                rest = &more[1..];
            }
            _ => {
                reader.report.error(
                    option.at,
                    format!("`genprism` has no option {}, or its arguments are missing", option.quoted()),
                );
                return None;
            }
        }
    }
    let base: Vec<DVec3> = corners.chunks_exact(2).map(|c| DVec3::new(c[0], c[1], 0.0)).collect();
    let next = |i: usize| base[(i + 1) % base.len()];
    let area: f64 = (0..base.len()).map(|i| base[i].x * next(i).y - next(i).x * base[i].y).sum();
    // If the base winds counter-clockwise around the extrusion direction, faces with the same
    // winding would point inwards.
    let inward = (area > 0.0) == (along.z > 0.0);
    let mut facets = Facets::new();
    if ends {
        facets.push(reversed_if(base.clone(), inward));
        facets.push(reversed_if(base.iter().map(|p| *p + along).collect(), !inward));
    }
    let sides = base.iter().zip(base.iter().cycle().skip(1)).take(base.len() - usize::from(!closed));
    facets.extend(sides.map(|(&a, &b)| reversed_if(vec![a, a + along, b + along, b], inward)));
    Some(facets)
}
