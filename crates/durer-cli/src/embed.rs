//! The command's options for other programs: the same words make the same job, with the same bits.

use crate::failure::Failure;
use crate::job::{accel, aspect};
use crate::open::load_options;
use crate::options::RenderArgs;
use crate::render::RenderCommand;
use crate::{check, compare, explain, job};
use clap::{Args, FromArgMatches};
use durer::check::{Subject, check as find};
use durer::diag::{Diagnostics, Files};
use durer::image::compare::Comparison;
use durer::render::explain::{Explanation, Names};
use durer::render::{Control, Job, Shard, ShardBy};
use durer::world::World;
use durer::{LoadOptions, Loaded};
use serde_json::{Value, json};

/// The options of `durer render`, understood.
pub struct Asked(RenderArgs);

impl Asked {
    /// Understands words as they follow `durer render SCENE`.
    ///
    /// # Errors
    /// What the command would say of them.
    pub fn new(words: &[String]) -> Result<Asked, String> {
        // A shard must be told its file, which here is the caller's.
        let words = ["render", "scene", "--output", "picture.png"].into_iter().chain(words.iter().map(String::as_str));
        let matches = render().try_get_matches_from(words);
        match matches.and_then(|matches| RenderCommand::from_arg_matches(&matches)) {
            Ok(command) if command.frames.is_asked() => {
                Err("--frames and --turntable make many pictures, and here one is made".into())
            }
            Ok(command) => Ok(Asked(command.render)),
            Err(error) => Err(plain(&error.render().to_string())),
        }
    }

    /// How the scene is read.
    ///
    /// # Errors
    /// Options that contradict each other.
    pub fn load_options(&self) -> Result<LoadOptions, String> {
        let accel = accel(&self.0.job).map_err(said)?;
        let mut options = load_options(&self.0.reading);
        options.staging.aspect = aspect(&self.0.job);
        Ok(LoadOptions { accel, threads: self.threads(), ..options })
    }

    /// What the picture is.
    ///
    /// # Errors
    /// Options that contradict each other or the scene.
    pub fn job(&self, loaded: &Loaded) -> Result<Job, String> {
        job::job(&self.0.job, Some(&self.0.view), loaded, self.0.work.time.is_some()).map_err(said)
    }

    /// Which part of the work is wanted.
    pub fn shard(&self) -> Shard {
        let shard = self.0.work.shard.unwrap_or(Shard::WHOLE);
        if self.0.work.shard_by == "samples" { Shard { by: ShardBy::Samples, ..shard } } else { shard }
    }

    /// When and with how much it is made.
    pub fn control(&self) -> Control {
        let (work, memory) = (&self.0.work, self.0.reading.memory.bytes());
        Control { threads: self.threads(), tile: work.tile, time: work.time, memory, ..Control::default() }
    }

    fn threads(&self) -> Option<usize> {
        self.0.work.threads.map(usize::from)
    }
}

/// The command line of `durer render`.
fn render() -> clap::Command {
    RenderCommand::augment_args(clap::Command::new("render"))
}

/// What the command says of wrong words, without the ornaments of a terminal.
fn plain(text: &str) -> String {
    let text = text.trim().trim_start_matches("error: ");
    text.split("\n\nUsage:").next().unwrap_or(text).trim_end().into()
}

fn said(failure: Failure) -> String {
    match failure {
        Failure::Input(Some(message)) | Failure::Interrupted(message) => message,
        Failure::Other(error) => error.to_string(),
        _ => "the options cannot be used".into(),
    }
}

/// An option of `durer render`.
#[derive(Clone, Debug)]
pub struct OptionStatement {
    /// Its name, without dashes.
    pub name: String,
    /// What it does.
    pub help: String,
    /// What follows it; `None`: nothing.
    pub value: Option<String>,
    /// The words that it takes, where only some are allowed.
    pub words: Vec<String>,
}

/// All options of `durer render` that concern what is read, made and how.
pub fn options() -> Vec<OptionStatement> {
    render().get_arguments().filter_map(option).collect()
}

fn option(arg: &clap::Arg) -> Option<OptionStatement> {
    let name = arg.get_long()?.to_string();
    let takes = arg.get_action().takes_values();
    let value = arg.get_value_names().map(|names| names.iter().map(|name| name.as_str()).collect::<Vec<_>>().join(" "));
    let words = if takes { arg.get_possible_values() } else { Vec::new() };
    Some(OptionStatement {
        help: arg.get_help().map(ToString::to_string).unwrap_or_default(),
        value: takes.then(|| value.unwrap_or_default()),
        words: words.iter().map(|word| word.get_name().to_string()).collect(),
        name,
    })
}

/// What is odd about a scene, as `durer check --json` lists it.
pub fn findings(loaded: &Loaded, world: &World, files: &Files, read: &Diagnostics, job: &Job) -> Value {
    let (scene, dialect) = (&loaded.scene, loaded.dialect);
    let found = find(&Subject { scene, world, dialect, files, job, exposure: 1.0, rejected: None }, read);
    json!(found.iter().map(|finding| check::finding(finding, files)).collect::<Vec<_>>())
}

/// What is wrong with a scene that cannot be rendered, as `durer check --json` lists it.
pub fn reported(files: &Files, read: &Diagnostics) -> Value {
    let found = durer::check::reported(read);
    json!(found.iter().map(|finding| check::finding(finding, files)).collect::<Vec<_>>())
}

/// Why a pixel has its colour, as `durer explain --json` tells it.
///
/// # Errors
/// The pixel does not lie in the picture, or its samples cannot be counted.
pub fn explanation(
    loaded: &Loaded,
    world: &World,
    files: &Files,
    job: &Job,
    (x, y): (u32, u32),
) -> Result<Value, String> {
    let found: Explanation = explain::deep(|| durer::render::explain::explain(world, job, x, y))
        .map_err(said)?
        .map_err(|error| error.to_string())?;
    let names = Names { scene: &loaded.scene, world, files };
    Ok(explain::json(&explain::Subject::Pixel(found), &names))
}

/// How two pictures differ, as `durer compare --json` tells it of a pair.
pub fn comparison(found: &Comparison) -> Value {
    let mut value = json!({ "verdict": found.verdict.name() });
    if let (Value::Object(value), Value::Object(more)) = (&mut value, compare::numbers(found)) {
        value.extend(more);
    }
    value
}
