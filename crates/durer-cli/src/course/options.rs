//! Table of the options of the course's programs, and a parser for them.

use crate::failure::{Failure, invalid_input};
use crate::terminal::{print_error_line, print_line};
use durer::diag::did_you_mean;
use durer::dialect::{Dialect, DialectSet, Quirk, set};
use durer::format::course::Hint;
use std::path::Path;

/// An official program of the course, which `durer course` emulates: its name, its dialect, and its
/// other quirks.
pub struct Program {
    pub name: &'static str,
    pub dialect: Dialect,
    pub compat: &'static [Quirk],
}

/// The official programs of the course.
pub const PROGRAMS: [Program; 7] = [
    Program { name: "raytracer", dialect: Dialect::F04, compat: &[] },
    Program { name: "a4soln", dialect: Dialect::F12a4, compat: &[] },
    Program { name: "a5soln", dialect: Dialect::F12a5, compat: &[Quirk::ExitR0] },
    Program { name: "a5soln-v2", dialect: Dialect::F12a5, compat: &[] },
    Program { name: "a4", dialect: Dialect::F16, compat: &[] },
    Program { name: "a4soln19", dialect: Dialect::F16, compat: &[] },
    Program { name: "assignment4", dialect: Dialect::F23, compat: &[] },
];

/// Returns the official program with the given name.
pub fn program(name: &str) -> Option<&'static Program> {
    PROGRAMS.iter().find(|program| program.name == name)
}

/// An option of the course's programs: its name, the names of its values, the years that have it,
/// and its help text.
pub struct CourseOption(&'static str, &'static [&'static str], DialectSet, &'static str);

const NOT_A4: DialectSet = set::ALL & !set::F12A4;

#[rustfmt::skip]
const OPTIONS: [CourseOption; 32] = [
    CourseOption("-input", &["FILE"], set::ALL, "the scene"),
    CourseOption("-size", &["W", "H"], set::ALL, "size of the pictures in pixels"),
    CourseOption("-output", &["FILE"], set::ALL, "the colour picture"),
    CourseOption("-depth", &["MIN", "MAX", "FILE"], set::ALL, "the depth picture"),
    CourseOption("-normals", &["FILE"], set::ALL, "the picture of normals"),
    CourseOption("-shadows", &[], NOT_A4, "cast shadows"),
    CourseOption("-bounces", &["N"], NOT_A4, "maximum depth of reflected and transmitted rays"),
    CourseOption("-shade_back", &[], set::OLD, "also shade surfaces seen from behind"),
    CourseOption("-weight", &["X"], set::OLD, "minimum weight of a ray"),
    CourseOption("-grid", &["NX", "NY", "NZ"], set::OLD, "use a uniform grid"),
    CourseOption("-visualize_grid", &[], set::OLD, "show the grid's occupied cells"),
    CourseOption("-stats", &[], set::OLD, "print the number of objects and rays"),
    CourseOption("-random_samples", &["N"], set::OLD, "samples per pixel, at random positions"),
    CourseOption("-uniform_samples", &["N"], set::OLD, "samples per pixel, in a regular pattern"),
    CourseOption("-jittered_samples", &["N"], set::OLD, "samples per pixel, one at a random position per grid cell"),
    CourseOption("-box_filter", &["R"], set::OLD, "box filter"),
    CourseOption("-tent_filter", &["R"], set::OLD, "tent filter"),
    CourseOption("-gaussian_filter", &["SIGMA"], set::OLD, "Gaussian filter"),
    CourseOption("-render_samples", &["FILE", "ZOOM"], set::OLD, "show the sample positions"),
    CourseOption("-render_filter", &["FILE", "ZOOM"], set::OLD, "show the filter's weights"),
    CourseOption("-transparent_shadows", &[], set::OLD, "transparent objects cast coloured shadows"),
    CourseOption("-gui", &[], set::OLD, "ignored: Dürer has no window"),
    CourseOption("-tessellation", &["THETA", "PHI"], set::OLD, "ignored: for the window only"),
    CourseOption("-gouraud", &[], set::OLD, "ignored: for the window only"),
    CourseOption("-jitter", &[], set::F12A5 | set::F16 | set::F23, "3x3 jittered subpixels"),
    CourseOption("-filter", &[], set::F12A5 | set::F16 | set::F23, "five-tap blur"),
    CourseOption("-reflection_off", &[], set::F12A5, "do not trace reflected rays"),
    CourseOption("-refraction_off", &[], set::F12A5, "do not trace transmitted rays"),
    CourseOption("--program", &["NAME"], set::ALL, "emulate this official program"),
    CourseOption("--dialect", &["NAME"], set::ALL, "dialect of the scene [default: detected from the scene and the options]"),
    CourseOption("--compat", &["NAMES"], set::ALL, "quirks by name; see `durer dialects`"),
    CourseOption("--assets", &["FOLDER"], set::ALL, "folder to search for missing meshes and textures"),
];

/// Dürer's own options, which the course's programs do not have.
const CONTROL: [CourseOption; 4] = [
    CourseOption("--seed", &["N"], set::ALL, "seed of the random number generator"),
    CourseOption("--threads", &["N"], set::ALL, "threads"),
    CourseOption("--quiet", &[], set::ALL, "print only errors"),
    CourseOption("--allow-outside", &[], set::ALL, "allow files outside the scene's folder"),
];

/// Iterates over all options.
pub fn rows() -> impl Iterator<Item = &'static CourseOption> {
    OPTIONS.iter().chain(&CONTROL)
}

/// The parsed command line of `durer course`.
pub struct Arguments {
    options: Vec<(&'static CourseOption, Vec<String>)>,
    unknown: Vec<String>,
}

impl Arguments {
    /// Parses a command line. Unknown words are stored for [`Arguments::check_unknown`].
    pub fn parse(arguments: Vec<String>) -> Result<Self, Failure> {
        let mut parsed = Arguments { options: Vec::new(), unknown: Vec::new() };
        let mut rest = arguments.into_iter();
        while let Some(word) = rest.next() {
            let Some(row) = rows().find(|row| row.0 == word) else {
                parsed.unknown.push(word);
                continue;
            };
            let values: Vec<String> = rest.by_ref().take(row.1.len()).collect();
            // If an option appears in place of a value, the value is missing.
            let option = values.iter().find(|value| rows().any(|row| row.0 == **value));
            if values.len() < row.1.len() || option.is_some() {
                let found = option.map(|option| format!(", but found {option}")).unwrap_or_default();
                return Err(invalid_input(format!("{word} needs {}{found}", row.1.join(" "))));
            }
            parsed.options.push((row, values));
        }
        Ok(parsed)
    }

    /// Returns true if an option is present.
    pub fn has(&self, name: &str) -> bool {
        self.options.iter().any(|(row, _)| row.0 == name)
    }

    /// Returns the values of an option. If the option is given several times, the last one counts.
    pub fn values(&self, name: &str) -> Option<&[String]> {
        self.options.iter().rev().find(|(row, _)| row.0 == name).map(|(_, values)| values.as_slice())
    }

    /// Returns the first value of an option.
    pub fn text(&self, name: &str) -> Option<&str> {
        self.values(name)?.first().map(String::as_str)
    }

    /// Returns the first `count` values of an option as numbers.
    pub fn numbers<T: std::str::FromStr>(&self, name: &str, count: usize) -> Result<Option<Vec<T>>, Failure> {
        let Some(values) = self.values(name) else { return Ok(None) };
        let parse =
            |text: &String| text.parse().map_err(|_| invalid_input(format!("{name}: `{text}` is not a valid number")));
        values.iter().take(count).map(parse).collect::<Result<_, _>>().map(Some)
    }

    /// Returns the first value of an option as a number.
    pub fn number<T: std::str::FromStr>(&self, name: &str) -> Result<Option<T>, Failure> {
        Ok(self.numbers(name, 1)?.and_then(|mut values| values.pop()))
    }

    /// Returns the magnification of a diagram if the diagram is requested.
    pub fn zoom(&self, name: &str) -> Result<Option<u32>, Failure> {
        let Some(values) = self.values(name) else { return Ok(None) };
        let zoom = values[1].parse().ok().filter(|zoom| (1..=1000).contains(zoom));
        zoom.map(Some).ok_or_else(|| invalid_input(format!("{name}: the zoom must be from 1 to 1000")))
    }

    /// Reports options that are unknown. The program of f12a4 ignores unknown options, and the
    /// others fail.
    pub fn check_unknown(&self, dialect: Option<Dialect>, quiet: bool) -> Result<(), Failure> {
        for word in &self.unknown {
            let near = did_you_mean(word, rows().map(|row| row.0));
            let message = match near {
                Some(near) => format!("unknown option {word}; did you mean {near}?"),
                None => format!("unknown option {word}; `durer course` lists all options"),
            };
            if dialect != Some(Dialect::F12a4) {
                return Err(invalid_input(message));
            }
            if !quiet {
                print_error_line(&format!("warning: {message} (the option is ignored, as by the official program)"));
            }
        }
        Ok(())
    }

    /// Returns the hints about the dialect that the options give.
    pub fn hints(&self) -> Vec<Hint> {
        let mut hints: Vec<Hint> = self
            .options
            .iter()
            .filter(|(row, _)| row.2 != set::ALL)
            .map(|(row, _)| Hint {
                set: row.2,
                reason: format!("`{}` is an option of that year's program", row.0),
                weak: false,
            })
            .collect();
        let extension = self.text("-output").and_then(|name| Path::new(name).extension()?.to_str());
        let wanted =
            |set: DialectSet, format: &str| Hint { set, reason: format!("the output is a {format} file"), weak: true };
        hints.extend(match extension {
            Some("bmp") => Some(wanted(set::F12A4 | set::F12A5, "BMP")),
            Some("png") => Some(wanted(set::F16 | set::F23, "PNG")),
            Some("tga") => Some(wanted(set::OLD, "TGA")),
            _ => None,
        });
        hints
    }
}

/// Prints the options and the emulated programs.
pub fn usage() {
    print_line("durer course: accepts the arguments of the course's own programs from any year\n");
    print_line(
        "  durer course -input scene.txt -size 200 200 -output o.tga -depth 9 10 d.tga -normals n.tga -shadows -bounces 4\n",
    );
    for CourseOption(name, values, years, doc) in rows() {
        let left = format!("{name} {}", values.join(" "));
        let all = *years == set::ALL;
        let names: Vec<&str> =
            Dialect::ALL.iter().filter(|d| d.is_in(*years) && **d != Dialect::Durer).map(|d| d.name()).collect();
        let years = if all { String::new() } else { format!(" ({})", names.join(", ")) };
        print_line(&format!("  {left:<28}{doc}{years}"));
    }
    print_line(&format!("\nPrograms: {}.", PROGRAMS.map(|p| p.name).join(", ")));
    print_line("A link to durer with one of these names emulates that program.");
}
