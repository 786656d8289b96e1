//! Implements `durer compare`, which compares pictures with references.

mod args;
mod class_table;
mod compared_pair;
mod mistakes;
mod page;
mod pairs;
mod pixel_hit;
mod stage;
mod text;

use crate::failure::{Failure, invalid_input};
use crate::file_registry::FileRegistry;
use crate::output::{encode, format, save};
use crate::progress;
use crate::report::counted;
use crate::terminal::print_line;
pub use args::CompareArgs;
use args::RenderingArgs;
use class_table::ClassTable;
use compared_pair::{ComparedPair, Outcome, name};
use durer::diag::{format_bytes_down, format_bytes_up};
use durer::format::folder::FolderSource;
use durer::image::compare::{Options, Picture, Verdict, compare, memory_needed};
use durer::image::{Destination, Encoded, Transfer};
use page::heat;
use pairs::Pair;
use pixel_hit::pixel_hits;
use stage::{ReferenceScene, stage};
use std::path::{Path, PathBuf};

/// Runs `durer compare`. Failures use the exit code for invalid input because 1 means that pictures
/// differ.
pub fn run(args: &CompareArgs) -> Result<(), Failure> {
    work(args).map_err(|failure| match failure {
        Failure::Other(error) => Failure::Input(Some(error.to_string())),
        failure => failure,
    })
}

fn work(args: &CompareArgs) -> Result<(), Failure> {
    let comparison = pairs::find(&args.reference, &args.picture)?;
    let heat_format = args.heat.as_deref().map(format).transpose()?;
    if args.heat.is_some() && comparison.folders {
        return Err(invalid_input(
            "`--heat` compares two pictures; for folders, use `--report`, which includes heat maps",
        ));
    }
    let mut registry = FileRegistry::default();
    for pair in &comparison.pairs {
        registry.register_input(&pair.reference)?;
        pair.picture.iter().try_for_each(|path| registry.register_input(path))?;
    }
    let report = args.report.as_ref().map(|path| registry.register_output("--report", path)).transpose()?;
    let heat_file = args.heat.as_ref().map(|path| registry.register_output("--heat", path)).transpose()?;
    let memory = args.rendering.reading.memory.limit();
    let table = args.table.as_deref().map(|path| ClassTable::read(path, memory)).transpose()?;
    args.table.iter().try_for_each(|path| registry.register_input(path))?;
    table.iter().try_for_each(|table| table.check(&comparison.pairs))?;
    let options = |pair: &Pair| Options {
        tolerance: args.tolerance,
        allowed_share: args.allow / 100.0,
        transfer: rendering(args, table.as_ref(), pair).transfer(),
    };

    let (names, folders, extra) =
        (comparison.pairs.iter().map(name).collect::<Vec<_>>(), comparison.folders, comparison.extra);
    let mut all: Vec<ComparedPair> = progress::each(&names, comparison.pairs, false, |pair| {
        let options = options(&pair);
        one(pair, &options, memory, args.report.is_some())
    });
    if let ([ComparedPair { outcome: Outcome::Failed(reason), .. }], false) = (&all[..], folders) {
        return Err(invalid_input(reason));
    }
    explain(args, table.as_ref(), &mut all, memory, &mut registry)?;

    if args.json {
        print_line(&serde_json::to_string_pretty(&text::json(&all, &extra, args))?);
    } else if args.csv {
        print_line(text::csv(&all).trim_end());
    } else if folders {
        text::table(&all, &extra);
    } else {
        text::single(&all[0], args.tolerance);
    }
    let mut files: Vec<(&Destination, Vec<u8>)> = Vec::new();
    if let (Some(destination), Some(format), Outcome::Compared(comparison)) = (&heat_file, heat_format, &all[0].outcome)
    {
        files.push((destination, encode(format, &[heat(comparison)], Transfer::Linear, &[])?));
    }
    if let Some(destination) = &report {
        files.push((destination, page::page(&all, &extra, args)?.into_bytes()));
    }
    if !files.is_empty() {
        save(&files, args.json)?;
    }
    let failed = all.iter().filter(|c| matches!(c.outcome, Outcome::Failed(_))).count();
    let bad_verdict = |c: &ComparedPair| match &c.outcome {
        Outcome::Compared(comparison) => comparison.verdict == Verdict::Different,
        _ => true,
    };
    match failed {
        0 if all.iter().any(bad_verdict) => Err(Failure::Different),
        0 => Ok(()),
        count => Err(invalid_input(format!("{count} of {} could not be compared", counted(all.len(), "picture")))),
    }
}

/// Traces the scene where pictures differ, and finds the mistakes that explain the difference.
fn explain(
    args: &CompareArgs,
    table: Option<&ClassTable>,
    all: &mut [ComparedPair],
    memory: u64,
    registry: &mut FileRegistry,
) -> Result<(), Failure> {
    let mut stages: Vec<(PathBuf, ReferenceScene)> = Vec::new();
    for compared in all {
        let (Outcome::Compared(comparison), Some(picture)) = (&compared.outcome, &compared.pair.picture) else {
            continue;
        };
        let listed = table.and_then(|table| table.scene(&compared.pair));
        let Some(scene) = listed.or(args.scene.as_deref()) else { continue };
        let [reference, test] = read_both([&compared.pair.reference, picture], memory).map_err(invalid_input)?;
        // Open the scene only once per reference because all pictures of a class share it.
        if stages.iter().all(|(path, _)| *path != compared.pair.reference) {
            stages.truncate(16);
            let options = rendering(args, table, &compared.pair);
            let stage = stage(scene, options, &compared.pair, &reference, registry)?;
            stages.insert(0, (compared.pair.reference.clone(), stage));
        }
        let index = stages.iter().find(|(path, _)| *path == compared.pair.reference);
        let Some((_, stage)) = index else { continue };
        if comparison.verdict == Verdict::Different {
            compared.note = stage.note.clone();
            compared.hits = pixel_hits(stage, comparison)?;
            compared.diagnosis = Some(mistakes::find_mistakes(stage, &reference, &test));
        }
    }
    Ok(())
}

/// Returns the options of a pair, which come from the table or from the command line.
fn rendering<'a>(args: &'a CompareArgs, table: Option<&'a ClassTable>, pair: &Pair) -> &'a RenderingArgs {
    table.and_then(|table| table.options(pair)).unwrap_or(&args.rendering)
}

/// Compares one pair of pictures. `page` is true if a report needs their pixels.
fn one(pair: Pair, options: &Options, memory: u64, page: bool) -> ComparedPair {
    let Some(path) = &pair.picture else {
        return ComparedPair::new(pair, Outcome::Missing, None);
    };
    let compared = read_both([&pair.reference, path], memory).and_then(|[reference, picture]| {
        let comparison = compare(&reference, &picture, options)
            .map_err(|error| format!("`{}` and `{}`: {error}", pair.reference.display(), path.display()))?;
        let pictures = page.then(|| page::pair_pictures(&reference, &picture, &comparison)).transpose()?;
        Ok((comparison, pictures, reference.shows_color()))
    });
    match compared {
        Ok((comparison, pictures, shows_color)) => {
            ComparedPair { shows_color, ..ComparedPair::new(pair, Outcome::Compared(Box::new(comparison)), pictures) }
        }
        Err(reason) => ComparedPair::new(pair, Outcome::Failed(reason), None),
    }
}

/// Reads a pair of pictures. Checks their sizes and the memory limit before decoding them.
fn read_both(paths: [&Path; 2], memory: u64) -> Result<[Picture; 2], String> {
    let [a, b] = paths.map(|path| {
        let unreadable = |error: String| format!("cannot read `{}`: {error}", path.display());
        match path.is_dir() {
            true => Err(unreadable("it is a folder".into())),
            false => {
                let bytes = FolderSource::new(".").budget(memory).read_path(path, &path.to_string_lossy());
                bytes.map_err(|error| error.to_string())
            }
        }
    });
    let (a, b) = (a?, b?);
    let open = |bytes, path: &Path| {
        let unreadable = |error| format!("cannot read `{}`: {error}", path.display());
        Encoded::open(bytes, &path.to_string_lossy()).map_err(unreadable)
    };
    let (a, b) = (open(&a, paths[0])?, open(&b, paths[1])?);
    let both = format!("`{}` and `{}`", paths[0].display(), paths[1].display());
    let needed = memory_needed(&a, &b).map_err(|error| format!("{both}: {error}"))?;
    if needed > memory {
        let (needed, memory) = (format_bytes_up(needed), format_bytes_down(memory));
        return Err(format!(
            "comparing {both} needs about {needed} of memory, but the limit is {memory}; see --memory"
        ));
    }
    let decode = |picture: &Encoded, path: &Path| {
        Picture::decode(picture, memory).map_err(|error| format!("cannot read `{}`: {error}", path.display()))
    };
    let (a, b) = rayon::join(|| decode(&a, paths[0]), || decode(&b, paths[1]));
    Ok([a?, b?])
}
