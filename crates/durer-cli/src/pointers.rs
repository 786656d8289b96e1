//! Maps options of other programs to their equivalents in Dürer.

use clap::builder::StyledStr;
use clap::error::{ContextKind, ContextValue, ErrorKind};
use clap::{Command, Error};
use std::ffi::OsString;

/// Options of other programs: their names, the option that a command must have for the hint to
/// apply, and the hint.
const POINTERS: &[(&[&str], &str, &str)] = &[
    (&["--width", "--height", "--resolution", "--res", "-size"], "size", "`--size 640x480` has both, the width first"),
    (&["--spp", "--aa", "--antialias", "--samples-per-pixel"], "samples", "samples a pixel are `--samples 64`"),
    (&["--format", "--type", "--filetype"], "output", "the ending of the file chooses the format: `-o picture.exr`"),
    (&["--out", "--outfile", "-output"], "output", "the file to write is `-o picture.png`"),
    (&["--depth", "--max-depth", "--maxdepth", "-bounces"], "bounces", "the depth of secondary rays is `--bounces 4`"),
    (&["--depth", "-depth"], "show", "the picture of depths is `--show depth --depth-range 8 12`"),
    (&["-normals"], "show", "the picture of normals is `--show normals`"),
    (&["-shadows"], "shadows", "shadows are `--shadows`"),
    (&["-shade_back"], "shade-back", "it is `--shade-back`"),
    (&["-weight"], "min-throughput", "it is `--min-throughput 0.01`"),
    (&["--gamma"], "transfer", "the curve of the picture is `--transfer srgb`, `linear` or `course`"),
    (&["--verbose", "--debug", "--log"], "stats", "`--stats` prints what was done"),
    (&["--verbose", "--debug", "--log"], "json", "`--json` prints everything"),
    (&["--jobs", "--cores"], "threads", "threads are `--threads 4`"),
];

/// Replaces clap's suggestion for an unknown option with a hint at the equivalent option.
pub fn corrected(mut error: Error, words: &[OsString], program: &Command) -> Error {
    if error.kind() != ErrorKind::UnknownArgument {
        return error;
    }
    let Some(ContextValue::String(given)) = error.get(ContextKind::InvalidArg) else { return error };
    // A long option with a single dash is parsed as several short options.
    let one_dash = |word: &&str| word.starts_with('-') && !word.starts_with("--") && word.len() > 2;
    let words: Vec<&str> = words.iter().filter_map(|word| word.to_str()).collect();
    let whole = words.iter().copied().filter(one_dash).find(|word| word.starts_with(given.as_str()));
    let given = whole.unwrap_or(given).split('=').next().unwrap_or_default().to_string();
    let command = words.get(1).and_then(|name| program.find_subcommand(name)).unwrap_or(program);
    let has = |option: &str| command.get_arguments().any(|argument| argument.get_long() == Some(option));
    let known = POINTERS.iter().find(|(names, option, _)| names.contains(&given.as_str()) && has(option));
    let Some((_, _, help)) = known else { return error };
    let course = if whole.is_some() { " (`durer course` takes the old programs' options)" } else { "" };
    for kind in [ContextKind::SuggestedArg, ContextKind::SuggestedValue, ContextKind::Suggested, ContextKind::Usage] {
        error.remove(kind);
    }
    error.insert(ContextKind::InvalidArg, ContextValue::String(given));
    error.insert(ContextKind::Suggested, ContextValue::StyledStrs(vec![StyledStr::from(format!("{help}{course}"))]));
    error
}
