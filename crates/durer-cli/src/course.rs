//! `durer course`: the command lines of the course's own programs, of every year.

use crate::output::say;
use crate::render::{Opened, failure, filter_layer, open, rejected, samples_layer};
use crate::{Failure, bad, output, progress};
use durer::LoadOptions;
use durer::compile::AccelKind;
use durer::diag::did_you_mean;
use durer::dialect::{Compat, Dialect, DialectSet, set};
use durer::film::aov::Aov;
use durer::film::course::CourseFilter;
use durer::format::course::Hint;
use durer::image::{FORMATS, Format, Transfer, format_for};
use durer::integrator::Settings;
use durer::render::{Control, Job, Sampling};
use durer::sampler::Sampler;
use std::path::{Path, PathBuf};
use std::sync::Arc;

/// An official program: its name, its dialect, and habits beyond those of the dialect.
pub struct Program {
    name: &'static str,
    dialect: Dialect,
    compat: &'static [Compat],
}

const PROGRAMS: [Program; 7] = [
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
struct Row(&'static str, &'static [&'static str], DialectSet, &'static str);

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
    Row("--compat", &["NAMES"], set::ALL, "habits by name, see `durer dialects`"),
    Row("--assets", &["FOLDER"], set::ALL, "look for missing meshes and pictures here too"),
];

/// More rows of ours, which concern only how the work is done.
const CONTROL: [Row; 4] = [
    Row("--seed", &["N"], set::ALL, "seed of the random numbers"),
    Row("--threads", &["N"], set::ALL, "threads"),
    Row("--quiet", &[], set::ALL, "say nothing but errors"),
    Row("--allow-outside", &[], set::ALL, "let the scene name files anywhere"),
];

fn rows() -> impl Iterator<Item = &'static Row> {
    OPTIONS.iter().chain(&CONTROL)
}

/// The arguments, sorted.
struct Given {
    options: Vec<(&'static Row, Vec<String>)>,
    unknown: Vec<String>,
}

impl Given {
    fn parse(arguments: Vec<String>) -> Result<Self, Failure> {
        let mut given = Given { options: Vec::new(), unknown: Vec::new() };
        let mut rest = arguments.into_iter();
        while let Some(word) = rest.next() {
            let Some(row) = rows().find(|row| row.0 == word) else {
                given.unknown.push(word);
                continue;
            };
            let values: Vec<String> = rest.by_ref().take(row.1.len()).collect();
            if values.len() < row.1.len() {
                return Err(bad(format!("{word} needs {}", row.1.join(" "))));
            }
            given.options.push((row, values));
        }
        Ok(given)
    }

    fn has(&self, name: &str) -> bool {
        self.options.iter().any(|(row, _)| row.0 == name)
    }

    /// The values of an option; the last counts.
    fn values(&self, name: &str) -> Option<&[String]> {
        self.options.iter().rev().find(|(row, _)| row.0 == name).map(|(_, values)| values.as_slice())
    }

    fn text(&self, name: &str) -> Option<&str> {
        self.values(name)?.first().map(String::as_str)
    }

    fn numbers<T: std::str::FromStr>(&self, name: &str, count: usize) -> Result<Option<Vec<T>>, Failure> {
        let Some(values) = self.values(name) else { return Ok(None) };
        let parse = |text: &String| text.parse().map_err(|_| bad(format!("{name}: `{text}` is not such a number")));
        values.iter().take(count).map(parse).collect::<Result<_, _>>().map(Some)
    }

    fn number<T: std::str::FromStr>(&self, name: &str) -> Result<Option<T>, Failure> {
        Ok(self.numbers(name, 1)?.and_then(|mut values| values.pop()))
    }

    /// What the options tell of the dialect.
    fn hints(&self) -> Vec<Hint> {
        let mut hints: Vec<Hint> = self
            .options
            .iter()
            .filter(|(row, _)| row.2 != set::ALL)
            .map(|(row, _)| Hint { set: row.2, why: format!("`{}` is an option of that year", row.0) })
            .collect();
        let extension = self.text("-output").and_then(|name| Path::new(name).extension()?.to_str());
        hints.extend(match extension {
            Some("bmp") => Some(Hint { set: set::F12A4 | set::F12A5, why: "it wants a BMP file".into() }),
            Some("png") => Some(Hint { set: set::F16 | set::F23, why: "it wants a PNG file".into() }),
            Some("tga") => Some(Hint { set: set::OLD | set::F12A4, why: "it wants a TGA file".into() }),
            _ => None,
        });
        hints
    }
}

pub fn run(arguments: Vec<String>, program_name: Option<&'static Program>) -> Result<(), Failure> {
    if arguments.is_empty() || arguments.iter().any(|a| a == "--help" || a == "-h" || a == "-help") {
        usage();
        return if arguments.is_empty() { Err(Failure::Input(None)) } else { Ok(()) };
    }
    let given = Given::parse(arguments)?;
    let quiet = given.has("--quiet");
    let options = load_options(&given, program_name)?;
    check_unknown(&given, options.dialect)?;
    let scene = given.text("-input").ok_or_else(|| bad("-input is missing: which scene?"))?;
    // Wrong file names are better known before than after the work.
    let outputs = Outputs::of(&given)?;
    let opened = open(Path::new(scene), &options, quiet)?;
    let job = job(&given, &opened)?;
    let control = Arc::new(Control { threads: given.number("--threads")?, ..Control::default() });
    let world = &opened.world;
    let zooms = (given.zoom("-render_samples")?, given.zoom("-render_filter")?);
    let (rendered, diagrams) = progress::watch(&job, &control, quiet, || {
        let mut rendered = durer::render::render(world, &job, &control)?;
        if given.has("-visualize_grid")
            && let Some(layer) = rendered.pictures.first_mut().filter(|_| job.color)
        {
            layer.image = durer::render::grid_picture(world, &job)?;
        }
        let mut diagrams = Vec::new();
        if let Some(zoom) = zooms.0 {
            diagrams.push(samples_layer(world, &job, &control, zoom)?);
        }
        if let Some(zoom) = zooms.1 {
            diagrams.push(filter_layer(&job, zoom)?);
        }
        Ok((rendered, diagrams))
    })
    .map_err(failure)?;
    rejected(&rendered);
    if given.has("-stats") {
        stats(&opened, &control);
    }
    let layers = rendered.pictures.iter().chain(&diagrams);
    let mut files = Vec::new();
    for (layer, (path, format)) in layers.zip(&outputs.0) {
        files.push((path.clone(), output::encode(format, std::slice::from_ref(layer), Transfer::Course)?));
    }
    output::save(&files, quiet)
}

impl Given {
    /// The zoom of a diagram, if it is wanted.
    fn zoom(&self, name: &str) -> Result<Option<u32>, Failure> {
        let Some(values) = self.values(name) else { return Ok(None) };
        let zoom = values[1].parse().ok().filter(|zoom| (1..=1000).contains(zoom));
        zoom.map(Some).ok_or_else(|| bad(format!("{name}: the zoom must be from 1 to 1000")))
    }
}

fn load_options(given: &Given, program_name: Option<&'static Program>) -> Result<LoadOptions, Failure> {
    let named = match given.text("--program") {
        Some(name) => Some(program(name).ok_or_else(|| {
            bad(format!("there is no program {name}: known are {}", PROGRAMS.map(|p| p.name).join(", ")))
        })?),
        None => program_name,
    };
    let dialect = match given.text("--dialect") {
        Some(name) => Some(Dialect::from_name(name).ok_or_else(|| {
            bad(format!("there is no dialect {name}: known are {}", Dialect::ALL.map(Dialect::name).join(", ")))
        })?),
        None => named.map(|program| program.dialect),
    };
    let mut compat: Vec<(Compat, bool)> = named.iter().flat_map(|p| p.compat).map(|&compat| (compat, true)).collect();
    for word in given.text("--compat").into_iter().flat_map(|names| names.split(',')) {
        let (name, on) = word.strip_prefix("no-").map_or((word, true), |name| (name, false));
        let known = Compat::from_name(name).ok_or_else(|| bad(format!("--compat: there is no habit {name}")))?;
        compat.push((known, on));
    }
    let cells = given.numbers::<u32>("-grid", 3)?.and_then(|cells| <[u32; 3]>::try_from(cells).ok());
    Ok(LoadOptions {
        dialect,
        course: true,
        hints: given.hints(),
        compat,
        allow_outside: given.has("--allow-outside"),
        assets: given.text("--assets").map(PathBuf::from).into_iter().collect(),
        accel: cells.map_or(AccelKind::Bvh, |cells| AccelKind::Grid(Some(cells))),
        strict: false,
    })
}

/// Unknown options: one year's program ignored them, the others stopped.
fn check_unknown(given: &Given, dialect: Option<Dialect>) -> Result<(), Failure> {
    for word in &given.unknown {
        let near = did_you_mean(word, rows().map(|row| row.0));
        let message = match near {
            Some(near) => format!("there is no option {word}; did you mean {near}?"),
            None => format!("there is no option {word}; `durer course` lists them"),
        };
        if dialect != Some(Dialect::F12a4) {
            return Err(bad(message));
        }
        eprintln!("warning: {message} (ignored, as the official program does)");
    }
    Ok(())
}

/// The files to be written, in the order of the pictures.
struct Outputs(Vec<(PathBuf, &'static Format)>);

impl Outputs {
    fn of(given: &Given) -> Result<Self, Failure> {
        let names = [
            given.text("-output"),
            given.values("-depth").map(|values| values[2].as_str()),
            given.text("-normals"),
            given.text("-render_samples"),
            given.text("-render_filter"),
        ];
        let named = names.into_iter().flatten().map(|name| Ok((PathBuf::from(name), course_format(name)?)));
        let files: Vec<_> = named.collect::<Result<_, Failure>>()?;
        if files.is_empty() {
            return Err(bad(
                "there is nothing to write: give -output, -depth, -normals, -render_samples or -render_filter",
            ));
        }
        Ok(Outputs(files))
    }
}

/// The format of a name; TGA for names that say nothing, as the old programs have it.
fn course_format(name: &str) -> Result<&'static Format, Failure> {
    let tga = FORMATS.iter().find(|format| format.extensions.contains(&"tga"));
    match (format_for(name), tga) {
        (Ok(format), _) => Ok(format),
        (Err(_), Some(tga)) if Path::new(name).extension().is_none() => Ok(tga),
        (Err(error), _) => Err(bad(error.to_string())),
    }
}

fn job(given: &Given, opened: &Opened) -> Result<Job, Failure> {
    let rules = &opened.loaded.rules;
    let size = given.numbers::<u32>("-size", 2)?;
    let (width, height) = size.map_or(rules.size, |size| (size[0], size[1]));
    if width == 0 || height == 0 {
        return Err(bad("-size: a picture has at least one pixel"));
    }
    let depth = given.numbers::<f32>("-depth", 2)?;
    let depth_range = depth.map(|range| (range[0], range[1]));
    if depth_range.is_some_and(|(min, max)| !(min.is_finite() && max.is_finite() && min != max)) {
        return Err(bad("-depth needs two different numbers"));
    }
    let bounces = given.number("-bounces")?.unwrap_or(rules.bounces);
    if bounces > Settings::MOST_BOUNCES {
        return Err(bad(format!("-bounces: at most {}", Settings::MOST_BOUNCES)));
    }
    let wanted = [("-depth", "depth"), ("-normals", "normals")];
    Ok(Job {
        width,
        height,
        crop: None,
        seed: given.number("--seed")?.unwrap_or(0),
        sampling: sampling(given, opened.loaded.dialect)?,
        settings: Settings {
            bounces,
            shadows: given.has("-shadows") || rules.shadows,
            shade_back: given.has("-shade_back") || rules.shade_back,
            transparent_shadows: given.has("-transparent_shadows"),
            reflection: !given.has("-reflection_off"),
            refraction: !given.has("-refraction_off"),
            least_weight: given.number("-weight")?.unwrap_or(0.0),
        },
        color: given.has("-output"),
        aovs: wanted.iter().filter(|w| given.has(w.0)).filter_map(|w| Aov::from_name(w.1)).collect(),
        depth_range,
    })
}

fn sampling(given: &Given, dialect: Dialect) -> Result<Sampling, Failure> {
    let (jitter, blur) = (given.has("-jitter"), given.has("-filter"));
    if jitter || blur {
        // The programs of 2016 and later accept both, and do nothing.
        let ignored = matches!(dialect, Dialect::F16 | Dialect::F23);
        return Ok(if ignored { Sampling::Center } else { Sampling::Course2012 { jitter, blur } });
    }
    let samplers = [
        ("-random_samples", Sampler::Random),
        ("-uniform_samples", Sampler::Uniform),
        ("-jittered_samples", Sampler::Jittered),
    ];
    let sampler = samplers.into_iter().find(|(name, _)| given.has(name));
    let radius = |name: &str| -> Result<Option<f32>, Failure> {
        let radius = given.number::<f32>(name)?;
        if radius.is_some_and(|r| !(0.0..=64.0).contains(&r)) {
            return Err(bad(format!("{name}: must be from 0 to 64")));
        }
        Ok(radius)
    };
    let filter = if let Some(radius) = radius("-box_filter")? {
        Some(CourseFilter::Box { radius })
    } else if let Some(radius) = radius("-tent_filter")? {
        Some(CourseFilter::Tent { radius })
    } else {
        radius("-gaussian_filter")?.map(|sigma| CourseFilter::Gaussian { sigma })
    };
    let samples = sampler.map(|(name, _)| given.number::<u32>(name)).transpose()?.flatten();
    if samples.is_some_and(|n| n == 0 || n > 1 << 16) {
        return Err(bad("the number of samples must be from 1 to 65536"));
    }
    Ok(match (sampler, filter) {
        (None, None) => Sampling::Center,
        (sampler, filter) => Sampling::Course2004 {
            sampler: sampler.map_or(Sampler::Uniform, |(_, sampler)| sampler),
            samples: samples.unwrap_or(1),
            filter,
        },
    })
}

/// `-stats`.
fn stats(opened: &Opened, control: &Control) {
    let rays = control.rays.load(std::sync::atomic::Ordering::Relaxed);
    say(&format!("objects {}, rays {rays}", opened.world.objects.len()));
}

fn usage() {
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
