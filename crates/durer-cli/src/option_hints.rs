//! Maps options of other programs to equivalent options of Dürer.

use clap::builder::StyledStr;
use clap::error::{ContextKind, ContextValue, ErrorKind};
use clap::{Arg, Command, Error};
use durer::diag::did_you_mean;
use std::ffi::OsString;

/// Options of other programs: their names, the option that a command must have for the hint to
/// apply, and the hint.
const HINTS: &[(&[&str], &str, &str)] = &[
    (
        &["--width", "--height", "--resolution", "--res", "-size", "-w", "-W", "-H"],
        "size",
        "use `--size 640x480`, width first",
    ),
    (
        &["--spp", "--aa", "--antialias", "--samples-per-pixel", "-n"],
        "samples",
        "use `--samples 64` for 64 samples per pixel",
    ),
    (&["--format", "--type", "--filetype"], "output", "the file extension selects the format: `-o picture.exr`"),
    (&["--format", "--type"], "json", "use `--json` for the full output"),
    (&["--out", "--outfile", "-output"], "output", "use `-o picture.png`"),
    (
        &["--depth"],
        "bounces",
        "use `--bounces 4` for the maximum depth of secondary rays, or `--show depth` for a depth picture",
    ),
    (
        &["--max-depth", "--maxdepth", "-bounces"],
        "bounces",
        "use `--bounces 4` for the maximum depth of secondary rays",
    ),
    (&["-depth"], "show", "use `--show depth --depth-range 8 12` for a depth picture"),
    (&["-normals", "--normals", "--normal"], "show", "use `--show normals` for a picture of the normals"),
    (&["-shadows"], "shadows", "use `--shadows`"),
    (&["-shade_back"], "shade-back", "use `--shade-back`"),
    (&["-weight"], "min-throughput", "use `--min-throughput 0.01`"),
    (&["--gamma"], "transfer", "use `--transfer srgb`, `linear` or `course` for the transfer curve"),
    (&["--verbose", "--debug", "--log"], "stats", "use `--stats` for timings and ray counts"),
    (&["--verbose", "--debug", "--log"], "json", "use `--json` for the full output"),
    (
        &["--json"],
        "stats",
        "use `--stats=FILE.json` for the statistics of a render; `durer info --json` describes the scene",
    ),
    (&["--transparent", "--alpha"], "background", "use `--background transparent`"),
    (&["--jobs", "--cores"], "threads", "use `--threads 4`"),
    (&["--hdri", "--hdr", "--env", "--envmap", "--skybox"], "environment", "use `--environment sky.hdr`"),
    (&["--light", "--lights", "--sun", "--lighting"], "studio", "use `--studio soft`, `sun` or `none`"),
    (
        &["--ground", "--no-ground", "--floor", "--plane"],
        "add-ground",
        "`--add-ground` adds a ground, `--studio none` adds neither lights nor a ground, and `--background white` leaves out the ground",
    ),
    (
        &["--rotate-environment", "--env-rotation", "--rotate-env", "--envmap-rotation", "--hdri-rotation"],
        "environment-rotation",
        "use `--environment-rotation 90`",
    ),
    (&["--cylindrical", "--spherical"], "kind", "use `--illuminance cylindrical` or `spherical`"),
    (&["--intersections", "--all-hits", "--count"], "crossings", "use `--crossings`"),
    (&["--rotate", "--yaw", "--orbit", "--angle"], "turned", "use `--turned 45` to orbit the model by 45 degrees"),
    (
        &["--lens", "--aperture", "--dof", "--fstop", "--focus"],
        "eye",
        "depth of field needs a `ThinLensCamera` in the scene: docs/models.md has the steps",
    ),
    (
        &["--scale", "--unit", "--units"],
        "eye",
        "write a scene file with `Transform { UniformScale 1000 TriangleMesh { obj_file model.obj } }`",
    ),
    (
        &["--material", "--color", "--colour"],
        "eye",
        "materials belong to the scene: `durer convert model.obj -o model.txt` writes one to edit",
    ),
    (&["--wireframe", "--wire"], "show", "use `--show geometric-normals` or `--show barycentric` to see the triangles"),
    (
        &["--daylight-factor", "--df"],
        "at",
        "divide the illuminance inside by that outside: docs/light.md has the steps",
    ),
    (
        &["--host", "--bind", "--public", "--address", "--listen"],
        "port",
        "the page is served to this machine only; from another one, use `ssh -L 8000:127.0.0.1:8000 machine`",
    ),
    (&["-o", "--output", "--out"], "points", "results are printed: add `> results.csv`"),
];

/// Replaces clap's suggestion for an unknown option with a hint that names the equivalent option.
pub fn with_hint(mut error: Error, words: &[OsString], program: &Command) -> Error {
    if error.kind() == ErrorKind::InvalidSubcommand
        && let Some(ContextValue::String(given)) = error.get(ContextKind::InvalidSubcommand)
        && given.contains('.')
    {
        let hint = StyledStr::from(format!("use `durer render {given}` to render a file"));
        error.insert(ContextKind::Suggested, ContextValue::StyledStrs(vec![hint]));
        return error;
    }
    if error.kind() != ErrorKind::UnknownArgument {
        return error;
    }
    let Some(ContextValue::String(given)) = error.get(ContextKind::InvalidArg) else { return error };
    // clap parses a long option with a single dash as several short options.
    let one_dash = |word: &&str| word.starts_with('-') && !word.starts_with("--") && word.len() > 2;
    let words: Vec<&str> = words.iter().filter_map(|word| word.to_str()).collect();
    let whole = words.iter().copied().filter(one_dash).find(|word| word.starts_with(given.as_str()));
    let given = whole.unwrap_or(given).split('=').next().unwrap_or_default().to_string();
    let command = words.get(1).and_then(|name| program.find_subcommand(name)).unwrap_or(program);
    let has = |option: &str| command.get_arguments().any(|argument| argument.get_long() == Some(option));
    let known = HINTS.iter().find(|(names, option, _)| names.contains(&given.as_str()) && has(option));
    let several = || {
        let is_second_scene = command.get_name() == "render" && !given.starts_with('-') && given.contains('.');
        is_second_scene.then(|| {
            "`durer render` takes one scene: `for scene in *.txt; do durer render $scene -o ${scene%.txt}.png; done`"
                .to_string()
        })
    };
    let is_other = |render: &&Command| ![render.get_name(), program.get_name()].contains(&command.get_name());
    let render = program.find_subcommand("render").filter(is_other);
    let is_given = |argument: &Arg| match given.strip_prefix("--") {
        Some(name) => argument.get_long() == Some(name),
        None => {
            given.strip_prefix('-').is_some_and(|name| argument.get_short().map(String::from).as_deref() == Some(name))
        }
    };
    let of_render = || {
        render?.get_arguments().any(is_given).then(|| {
            format!("`{given}` is an option of `durer render`, which has no meaning for `durer {}`", command.get_name())
        })
    };
    let similar = || {
        let near = did_you_mean(given.strip_prefix("--")?, command.get_arguments().filter_map(Arg::get_long));
        let list = if has("help-all") { "--help-all" } else { "--help" };
        let listed = || match command.get_name() == program.get_name() {
            true => "`durer --help` lists the commands, and `durer COMMAND --help` their options".into(),
            false => format!("`durer {} {list}` lists the options", command.get_name()),
        };
        Some(near.map_or_else(listed, |near| format!("did you mean `--{near}`?")))
    };
    let help = known.map(|row| row.2.to_string()).or_else(|| separate_value(&words, &given)).or_else(several);
    let Some(help) = help.or_else(|| negation(&given, command)).or_else(of_render).or_else(similar) else {
        return error;
    };
    let course = if whole.is_some() { " (`durer course` takes the course's options)" } else { "" };
    for kind in [ContextKind::SuggestedArg, ContextKind::SuggestedValue, ContextKind::Suggested, ContextKind::Usage] {
        error.remove(kind);
    }
    error.insert(ContextKind::InvalidArg, ContextValue::String(given.clone()));
    error.insert(ContextKind::Suggested, ContextValue::StyledStrs(vec![StyledStr::from(format!("{help}{course}"))]));
    error
}

/// Returns a hint for a word that belongs to the value of the option before it, as in
/// `--size 640 480` or `--shadows off`.
fn separate_value(words: &[&str], given: &str) -> Option<String> {
    let at = words.iter().position(|word| *word == given)?;
    let first = words[..at].iter().rposition(|word| word.starts_with("--"))?;
    let option = words[first];
    let is_number = |word: &&str| word.parse::<f64>().is_ok();
    if words[first + 1..=at].iter().all(is_number) {
        let end = words[at..].iter().take_while(|word| is_number(word)).count();
        let joint = if option == "--size" { "x" } else { "," };
        return Some(format!("write the numbers as one word: `{option} {}`", words[first + 1..at + end].join(joint)));
    }
    (at == first + 1 && matches!(given, "on" | "off")).then(|| format!("use `{option}={given}`"))
}

/// Returns a hint for the negation of a switch, as in `--no-shadows`.
fn negation(given: &str, command: &Command) -> Option<String> {
    let name = given.strip_prefix("--no-")?;
    let argument = command.get_arguments().find(|argument| argument.get_long() == Some(name))?;
    let is_switch = argument.get_num_args().is_some_and(|number| number.min_values() == 0);
    is_switch.then(|| format!("use `--{name}=off`"))
}
