//! Maps options of other programs to equivalent options of Dürer.

use clap::builder::StyledStr;
use clap::error::{ContextKind, ContextValue, ErrorKind};
use clap::{Arg, Command, Error};
use std::ffi::OsString;

/// Options of other programs: their names, the option that a command must have for the hint to
/// apply, and the hint.
const HINTS: &[(&[&str], &str, &str)] = &[
    (&["--width", "--height", "--resolution", "--res", "-size"], "size", "use `--size 640x480`, width first"),
    (
        &["--spp", "--aa", "--antialias", "--samples-per-pixel"],
        "samples",
        "use `--samples 64` for 64 samples per pixel",
    ),
    (&["--format", "--type", "--filetype"], "output", "the file extension selects the format: `-o picture.exr`"),
    (&["--out", "--outfile", "-output"], "output", "use `-o picture.png`"),
    (
        &["--depth", "--max-depth", "--maxdepth", "-bounces"],
        "bounces",
        "use `--bounces 4` for the maximum depth of secondary rays",
    ),
    (&["--depth", "-depth"], "show", "use `--show depth --depth-range 8 12` for a depth picture"),
    (&["-normals"], "show", "use `--show normals` for a picture of the normals"),
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
    (&["--transparent", "--alpha"], "show", "pictures have no transparency: the camera sees the scene's `Background`"),
    (&["--jobs", "--cores"], "threads", "use `--threads 4`"),
];

/// Replaces clap's suggestion for an unknown option with a hint that names the equivalent option.
pub fn with_hint(mut error: Error, words: &[OsString], program: &Command) -> Error {
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
    let is_other = |render: &&Command| ![render.get_name(), program.get_name()].contains(&command.get_name());
    let render = program.find_subcommand("render").filter(is_other);
    let is_given = |argument: &Arg| match given.strip_prefix("--") {
        Some(name) => argument.get_long() == Some(name),
        None => {
            given.strip_prefix('-').is_some_and(|name| argument.get_short().map(String::from).as_deref() == Some(name))
        }
    };
    let help = match known {
        Some((_, _, help)) => help.to_string(),
        None if render.is_some_and(|render| render.get_arguments().any(is_given)) => {
            format!("`{given}` is an option of `durer render`, which has no meaning for `durer {}`", command.get_name())
        }
        None => return error,
    };
    let course = if whole.is_some() { " (`durer course` takes the course's options)" } else { "" };
    for kind in [ContextKind::SuggestedArg, ContextKind::SuggestedValue, ContextKind::Suggested, ContextKind::Usage] {
        error.remove(kind);
    }
    error.insert(ContextKind::InvalidArg, ContextValue::String(given.clone()));
    error.insert(ContextKind::Suggested, ContextValue::StyledStrs(vec![StyledStr::from(format!("{help}{course}"))]));
    error
}
