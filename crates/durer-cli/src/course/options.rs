//! The options of the course's programs, as one table, and the arguments sorted by it.

use crate::failure::{Failure, bad};
use crate::terminal::{complain, say};
use durer::diag::did_you_mean;
use durer::dialect::{Compat, Dialect, DialectSet, set};
use durer::format::course::Hint;
use std::path::Path;

/// An official program: its name, its dialect, and quirks beyond those of the dialect.
pub struct Program {
    pub name: &'static str,
    pub dialect: Dialect,
    pub compat: &'static [Compat],
}

pub const PROGRAMS: [Program; 7] = [
    Program { name: "raytracer", dialect: Dialect::F04, compat: &[] },
    Program { name: "a4soln", dialect: Dialect::F12a4, compat: &[] },
    Program { name: "a5soln", dialect: Dialect::F12a5, compat: &[Compat::ExitR0] },
    Program { name: "a5soln-v2", dialect: Dialect::F12a5, compat: &[] },
    Program { name: "a4", dialect: Dialect::F16, compat: &[] },
    Program { name: "a4soln19", dialect: Dialect::F16, compat: &[] },
    Program { name: "assignment4", dialect: Dialect::F23, compat: &[] },
];

/// The official program of a name.
pub fn program(name: &str) -> Option<&'static Program> {
    PROGRAMS.iter().find(|program| program.name == name)
}

/// One option: its name, its values, the years that have it, and what it does.
pub struct Row(&'static str, &'static [&'static str], DialectSet, &'static str);

const NOT_A4: DialectSet = set::ALL & !set::F12A4;

#[rustfmt::skip]
const OPTIONS: [Row; 32] = [
    Row("-input", &["FILE"], set::ALL, "the scene"),
    Row("-size", &["W", "H"], set::ALL, "size of the pictures in pixels"),
    Row("-output", &["FILE"], set::ALL, "the colour picture"),
    Row("-depth", &["MIN", "MAX", "FILE"], set::ALL, "the depth picture"),
    Row("-normals", &["FILE"], set::ALL, "the picture of normals"),
    Row("-shadows", &[], NOT_A4, "lights cast shadows"),
    Row("-bounces", &["N"], NOT_A4, "levels of mirrored and transmitted rays"),
    Row("-shade_back", &[], set::OLD, "surfaces are shaded from behind too"),
    Row("-weight", &["X"], set::OLD, "rays that count for less are left out"),
    Row("-grid", &["NX", "NY", "NZ"], set::OLD, "a uniform grid finds the objects"),
    Row("-visualize_grid", &[], set::OLD, "show the grid's occupied cells"),
    Row("-stats", &[], set::OLD, "print how much was computed"),
    Row("-random_samples", &["N"], set::OLD, "samples a pixel, at random"),
    Row("-uniform_samples", &["N"], set::OLD, "samples a pixel, in a regular pattern"),
    Row("-jittered_samples", &["N"], set::OLD, "samples a pixel, one at random in each cell of a pattern"),
    Row("-box_filter", &["R"], set::OLD, "weigh samples within a square"),
    Row("-tent_filter", &["R"], set::OLD, "weigh samples by a cone"),
    Row("-gaussian_filter", &["SIGMA"], set::OLD, "weigh samples by a Gaussian"),
    Row("-render_samples", &["FILE", "ZOOM"], set::OLD, "show where the samples lie"),
    Row("-render_filter", &["FILE", "ZOOM"], set::OLD, "show the filter's weights"),
    Row("-transparent_shadows", &[], set::OLD, "transparent things cast coloured shadows"),
    Row("-gui", &[], set::OLD, "ignored: there is no window"),
    Row("-tessellation", &["THETA", "PHI"], set::OLD, "ignored: it concerns the window only"),
    Row("-gouraud", &[], set::OLD, "ignored: it concerns the window only"),
    Row("-jitter", &[], set::F12A5 | set::F16 | set::F23, "three by three jittered sub-pixels"),
    Row("-filter", &[], set::F12A5 | set::F16 | set::F23, "blur by five taps"),
    Row("-reflection_off", &[], set::F12A5, "leave mirrored rays out"),
    Row("-refraction_off", &[], set::F12A5, "leave transmitted rays out"),
    Row("--program", &["NAME"], set::ALL, "be this official program"),
    Row("--dialect", &["NAME"], set::ALL, "the scene's dialect; else guessed from scene and options"),
    Row("--compat", &["NAMES"], set::ALL, "quirks by name, see `durer dialects`"),
    Row("--assets", &["FOLDER"], set::ALL, "look for missing meshes and pictures here too"),
];

/// More rows of ours, which concern only how the work is done.
const CONTROL: [Row; 4] = [
    Row("--seed", &["N"], set::ALL, "seed of the random numbers"),
    Row("--threads", &["N"], set::ALL, "threads"),
    Row("--quiet", &[], set::ALL, "say nothing but errors"),
    Row("--allow-outside", &[], set::ALL, "let the scene name files anywhere"),
];

pub fn rows() -> impl Iterator<Item = &'static Row> {
    OPTIONS.iter().chain(&CONTROL)
}

/// The arguments, sorted.
pub struct Given {
    options: Vec<(&'static Row, Vec<String>)>,
    unknown: Vec<String>,
}

impl Given {
    pub fn parse(arguments: Vec<String>) -> Result<Self, Failure> {
        let mut given = Given { options: Vec::new(), unknown: Vec::new() };
        let mut rest = arguments.into_iter();
        while let Some(word) = rest.next() {
            let Some(row) = rows().find(|row| row.0 == word) else {
                given.unknown.push(word);
                continue;
            };
            let values: Vec<String> = rest.by_ref().take(row.1.len()).collect();
            // An option in place of a value: the value was forgotten.
            let option = values.iter().find(|value| rows().any(|row| row.0 == **value));
            if values.len() < row.1.len() || option.is_some() {
                let found = option.map(|option| format!(", but found {option}")).unwrap_or_default();
                return Err(bad(format!("{word} needs {}{found}", row.1.join(" "))));
            }
            given.options.push((row, values));
        }
        Ok(given)
    }

    pub fn has(&self, name: &str) -> bool {
        self.options.iter().any(|(row, _)| row.0 == name)
    }

    /// The values of an option; the last counts.
    pub fn values(&self, name: &str) -> Option<&[String]> {
        self.options.iter().rev().find(|(row, _)| row.0 == name).map(|(_, values)| values.as_slice())
    }

    pub fn text(&self, name: &str) -> Option<&str> {
        self.values(name)?.first().map(String::as_str)
    }

    pub fn numbers<T: std::str::FromStr>(&self, name: &str, count: usize) -> Result<Option<Vec<T>>, Failure> {
        let Some(values) = self.values(name) else { return Ok(None) };
        let parse = |text: &String| text.parse().map_err(|_| bad(format!("{name}: `{text}` is not such a number")));
        values.iter().take(count).map(parse).collect::<Result<_, _>>().map(Some)
    }

    pub fn number<T: std::str::FromStr>(&self, name: &str) -> Result<Option<T>, Failure> {
        Ok(self.numbers(name, 1)?.and_then(|mut values| values.pop()))
    }

    /// The zoom of a diagram, if it is wanted.
    pub fn zoom(&self, name: &str) -> Result<Option<u32>, Failure> {
        let Some(values) = self.values(name) else { return Ok(None) };
        let zoom = values[1].parse().ok().filter(|zoom| (1..=1000).contains(zoom));
        zoom.map(Some).ok_or_else(|| bad(format!("{name}: the zoom must be from 1 to 1000")))
    }

    /// Unknown options: one year's program ignored them, the others stopped.
    pub fn check_unknown(&self, dialect: Option<Dialect>, quiet: bool) -> Result<(), Failure> {
        for word in &self.unknown {
            let near = did_you_mean(word, rows().map(|row| row.0));
            let message = match near {
                Some(near) => format!("there is no option {word}; did you mean {near}?"),
                None => format!("there is no option {word}; `durer course` lists them"),
            };
            if dialect != Some(Dialect::F12a4) {
                return Err(bad(message));
            }
            if !quiet {
                complain(&format!("warning: {message} (ignored, as the official program does)"));
            }
        }
        Ok(())
    }

    /// What the options tell of the dialect.
    pub fn hints(&self) -> Vec<Hint> {
        let mut hints: Vec<Hint> = self
            .options
            .iter()
            .filter(|(row, _)| row.2 != set::ALL)
            .map(|(row, _)| Hint { set: row.2, why: format!("`{}` is an option of that year", row.0), weak: false })
            .collect();
        let extension = self.text("-output").and_then(|name| Path::new(name).extension()?.to_str());
        let wanted = |set: DialectSet, format: &str| Hint { set, why: format!("it wants a {format} file"), weak: true };
        hints.extend(match extension {
            Some("bmp") => Some(wanted(set::F12A4 | set::F12A5, "BMP")),
            Some("png") => Some(wanted(set::F16 | set::F23, "PNG")),
            Some("tga") => Some(wanted(set::OLD, "TGA")),
            _ => None,
        });
        hints
    }
}

pub fn usage() {
    say("durer course: the arguments of the course's own programs, of any year\n");
    say(
        "  durer course -input scene.txt -size 200 200 -output o.tga -depth 9 10 d.tga -normals n.tga -shadows -bounces 4\n",
    );
    for Row(name, values, years, doc) in rows() {
        let left = format!("{name} {}", values.join(" "));
        let all = *years == set::ALL;
        let names: Vec<&str> =
            Dialect::ALL.iter().filter(|d| d.is_in(*years) && **d != Dialect::Durer).map(|d| d.name()).collect();
        let years = if all { String::new() } else { format!(" ({})", names.join(", ")) };
        say(&format!("  {left:<28}{doc}{years}"));
    }
    say(&format!("\nPrograms: {}.", PROGRAMS.map(|p| p.name).join(", ")));
    say("A link to durer with one of these names is that program.");
}
