//! Implements `durer farm`, which prints job files for render farms, based on `--shard` and `durer
//! merge`.

mod quote;

use crate::failure::{Failure, invalid_input};
use crate::frames::{self, Frames, FramesArgs, MotionSource};
use crate::render::RenderCommand;
use crate::terminal::print_line;
use clap::{Args, FromArgMatches};
use quote::{bash_word, bash_word_of_frame, not_an_option, python_list, python_string};
use std::ffi::OsString;
use std::path::PathBuf;

const SLURM: &str = include_str!("farm/slurm.sh");
const KUBERNETES: &str = include_str!("farm/k8s.yaml");
const OPENJD: &str = include_str!("farm/openjd.yaml");
const DASK: &str = include_str!("farm/dask.py");

/// Print a job file that renders a scene in shards on an existing farm
#[derive(Args)]
#[command(after_help = "Examples:
  durer farm scene.txt --template slurm --shards 64 --samples 256 > job.sh && sbatch job.sh
  durer farm scene.txt --template k8s --shards 16 > job.yaml && kubectl apply -f job.yaml
  durer farm scene.txt --template openjd > job.yaml && openjd check job.yaml
  durer farm scene.txt --template dask > render.py && python render.py
  durer farm walk.glb --template slurm --frames 0-239 --fps 24 --samples 64 > job.sh && sbatch job.sh

Each shard is a `durer render --shard` command that can be repeated on another machine. `durer merge` produces the same
bytes as a single run. Options of `durer render` can also be given; they are checked when the job file is printed.")]
pub struct FarmArgs {
    /// Scene file
    pub scene: PathBuf,
    /// Job system of the farm
    #[arg(long, value_parser = ["slurm", "k8s", "openjd", "dask"])]
    pub template: String,
    /// Number of shards per picture [default: 16; 1 with --frames]
    #[arg(long, value_parser = clap::value_parser!(u32).range(1..=65535))]
    pub shards: Option<u32>,
    #[command(flatten)]
    pub frames: FramesArgs,
    /// Picture to write [default: the scene's name with .exr]
    #[arg(short, long, value_name = "PICTURE")]
    pub output: Option<PathBuf>,
    /// Options of `durer render`
    #[arg(trailing_var_arg = true, allow_hyphen_values = true, value_name = "RENDER OPTIONS")]
    pub options: Vec<String>,
}

/// Moves the options of `durer farm` to the front, because everything after the first option of
/// `durer render` belongs to the latter.
pub fn own_options_first(words: Vec<OsString>) -> Vec<OsString> {
    if words.get(1).is_none_or(|word| word != "farm") {
        return words;
    }
    // All options of `durer farm` have a value.
    let farm = FarmArgs::augment_args(clap::Command::new("farm"));
    let is_long =
        |name: &str| name.strip_prefix("--").is_some_and(|name| has(&farm, |arg| arg.get_long() == Some(name)));
    let is_short = |letter: Option<char>| letter.is_some() && has(&farm, |arg| arg.get_short() == letter);
    let (mut own, mut others) = (Vec::new(), Vec::new());
    let mut rest = words.into_iter();
    let name: Vec<OsString> = rest.by_ref().take(2).collect();
    while let Some(word) = rest.next() {
        let text = word.to_string_lossy().into_owned();
        let mut letters = text.strip_prefix('-').unwrap_or_default().chars();
        let is_short = is_short(letters.next());
        if text == "--" {
            others.push(word);
            others.extend(rest.by_ref());
        } else if is_long(&text) || is_short && letters.as_str().is_empty() {
            own.push(word);
            own.extend(rest.next());
        } else if is_short || text.split_once('=').is_some_and(|(name, _)| is_long(name)) {
            own.push(word);
        } else {
            others.push(word);
        }
    }
    name.into_iter().chain(own).chain(others).collect()
}

fn has(command: &clap::Command, is_wanted: impl Fn(&clap::Arg) -> bool) -> bool {
    command.get_arguments().any(is_wanted)
}

/// Runs `durer farm` and prints the job file.
pub fn run(args: &FarmArgs) -> Result<(), Failure> {
    check_options(&args.options)?;
    print_line(job_file(args)?.trim_end());
    Ok(())
}

/// Maximum length of a job name in characters. Kubernetes allows 63 characters, including the index
/// of the task.
const MAX_NAME_LENGTH: usize = 52;

/// Returns the name of a job, which contains only letters, digits and dashes.
fn job_name(stem: &str) -> String {
    let allowed = |c: char| if c.is_ascii_alphanumeric() { c.to_ascii_lowercase() } else { '-' };
    let name: String = stem.trim_matches(|c: char| !c.is_ascii_alphanumeric()).chars().map(allowed).collect();
    let name = &name[..name.len().min(MAX_NAME_LENGTH - "durer-".len())];
    format!("durer-{name}").trim_end_matches('-').into()
}

/// Returns the template with the values of the job filled in.
fn job_file(args: &FarmArgs) -> Result<String, Failure> {
    let text = |path: &std::path::Path| {
        path.to_str().map(String::from).ok_or_else(|| invalid_input(format!("{path:?} is not UTF-8")))
    };
    let scene = text(&args.scene)?;
    let names: Vec<&str> = std::iter::once(&scene).chain(&args.options).map(String::as_str).collect();
    let frames = args.frames.resolve(&args.scene, &names)?;
    let stem = args.scene.file_stem().and_then(|stem| stem.to_str()).unwrap_or("picture").to_string();
    let output = args.output.as_deref().map_or_else(|| Ok(format!("{stem}.exr")), text)?;
    let output = if frames.is_some() { frames::pattern(&output) } else { output };
    let options: Vec<String> = args.options.iter().map(|word| bash_word(word)).collect();
    let template = match args.template.as_str() {
        "slurm" => SLURM,
        "k8s" => KUBERNETES,
        "openjd" => OPENJD,
        _ => DASK,
    };
    let shards = args.shards.unwrap_or(if frames.is_some() { 1 } else { 16 });
    let is_animation = frames.is_some();
    let (numbers, moves) = frames.unwrap_or((Frames { first: 0, last: 0, step: 1 }, MotionSource::Names));
    let Some(tasks) = numbers.count().checked_mul(shards) else {
        return Err(invalid_input(format!("{} frames of {shards} shards are too many tasks", numbers.count())));
    };
    // The animation, both as command-line words and as an expression in the template language.
    let (moving, words) = match moves {
        MotionSource::Turntable(count) => {
            (format!("--turntable {count} "), format!(r#", "--turned", str(360 * frame / {count})"#))
        }
        MotionSource::Time(rate) => (format!("--fps {rate} "), format!(r#", "--at", str(frame / {rate:?})"#)),
        MotionSource::Names => (String::new(), String::new()),
    };
    let values = [
        ("NAME", job_name(&stem)),
        ("SHARDS", shards.to_string()),
        ("TASKS", tasks.to_string()),
        ("FIRST", numbers.first.to_string()),
        ("LAST", numbers.last.to_string()),
        ("STEP", numbers.step.to_string()),
        ("MOVING", moving),
        ("MOVING_WORDS", words),
        ("SCENE", bash_word(&not_an_option(&scene))),
        ("OUTPUT", bash_word(&not_an_option(&output))),
        ("OUTPUT_OF_FRAME", bash_word_of_frame(&not_an_option(&output))),
        ("OPTIONS", options.join(" ")),
        ("SCENE_PYTHON", python_string(&scene)),
        ("OUTPUT_PYTHON", python_string(&output)),
        ("WORDS_PYTHON", python_list(&args.options)),
    ];
    Ok(filled(&chosen(template, is_animation), &values))
}

/// Checks that the options are valid for `durer render`.
fn check_options(options: &[String]) -> Result<(), Failure> {
    // A shard needs an output file, and the template adds it.
    let words = ["render", "scene", "--output", "picture.png"].into_iter().chain(options.iter().map(String::as_str));
    let matches = RenderCommand::augment_args(clap::Command::new("render")).try_get_matches_from(words);
    match matches.and_then(|matches| RenderCommand::from_arg_matches(&matches)) {
        Ok(command) if command.frames.is_requested() => Err(invalid_input(
            "--frames and --turntable are options of `durer farm`: put both before the options of `durer render`",
        )),
        Ok(_) => Ok(()),
        Err(error) => {
            let text = error.render().to_string();
            let text = text.trim().trim_start_matches("error: ");
            Err(invalid_input(text.split("\n\nUsage:").next().unwrap_or(text).trim_end()))
        }
    }
}

/// Keeps the template lines for this kind of job. Lines that begin with `@frames` are for
/// animations, and lines that begin with `@still` are for single pictures.
fn chosen(template: &str, frames: bool) -> String {
    let (here, there) = if frames { ("@frames", "@still") } else { ("@still", "@frames") };
    let lines = template.lines().filter(|line| !line.starts_with(there));
    lines
        .map(|line| {
            line.strip_prefix(here).map_or(line, |rest| rest.strip_prefix(' ').unwrap_or(rest)).to_string() + "\n"
        })
        .collect()
}

/// Replaces each `@KEY@` in a template by its value, in a single pass so that values are not
/// expanded again.
fn filled(template: &str, values: &[(&str, String)]) -> String {
    let (mut name, mut rest) = (String::new(), template);
    while let Some((before, after)) = rest.split_once('@') {
        name += before;
        let known = after.split_once('@').and_then(|(key, after)| {
            let (_, value) = values.iter().find(|(known, _)| *known == key)?;
            Some((value, after))
        });
        match known {
            Some((value, after)) => (name, rest) = (name + value, after),
            None => (name, rest) = (name + "@", after),
        }
    }
    name + rest
}

#[cfg(test)]
mod tests;
