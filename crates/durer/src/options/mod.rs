//! Options of a render as pairs of name and text, as the command line and Python have them.
//!
//! [`statements`] lists all options with their meaning, [`RenderOptions::set`] reads one. What is not
//! given has the command's defaults, so equal options give equal bits in every language.
//!
//! ```
//! use durer::options::RenderOptions;
//!
//! let mut options = RenderOptions::default();
//! options.set("samples", "64").unwrap();
//! options.set("accel", "grid").unwrap();
//! let error = options.set("size", "64").unwrap_err();
//! assert_eq!(error, "--size cannot be 64: say it as 640x480");
//! ```

pub mod memory;
mod rows;

pub use crate::job::{JobOption, OptionForm};
use crate::job::{RenderJob, View, option_index, option_name};
use crate::{LoadOptions, Loaded};
use durer_diag::did_you_mean;
use durer_render::integrator::Method;
use durer_render::render::{Control, Job, Shard};
use durer_scene::describe::{DescribedList, Field, Kind};
use memory::Memory;
use rows::{READING, VIEW, WORK};
pub use rows::{compat, crop, doc, grid_cells};
use std::time::Duration;

/// Everything that options decide about a render.
#[derive(Clone, Debug)]
#[non_exhaustive]
pub struct RenderOptions {
    /// How the scene is read and compiled.
    pub load: LoadOptions,
    /// The picture: size, samples, integrator.
    pub job: RenderJob,
    /// Which pictures are made of which part.
    pub view: View,
    /// Memory that scene and picture may take.
    pub memory: Memory,
    /// Threads; `None`: one for each processor.
    pub threads: Option<usize>,
    /// Width and height of a tile in pixels; `None`: chosen by the picture's size.
    pub tile: Option<u32>,
    /// Time after which no more samples are taken; `None`: no limit.
    pub time_limit: Option<Duration>,
    /// Part of the work.
    pub shard: Shard,
}

impl Default for RenderOptions {
    fn default() -> Self {
        RenderOptions {
            load: LoadOptions::default(),
            job: RenderJob::default(),
            view: View::default(),
            memory: Memory::default(),
            threads: None,
            tile: None,
            time_limit: None,
            shard: Shard::WHOLE,
        }
    }
}

impl RenderOptions {
    /// Sets an option by its name without dashes. `text` is empty for a flag. Options that name several
    /// things (`assets`, `compat`) add to what was set before.
    ///
    /// # Errors
    ///
    /// A sentence, if there is no such option, or the text is not a value of it.
    pub fn set(&mut self, name: &str, text: &str) -> Result<(), String> {
        let mut rows = READING.iter().chain(VIEW).chain(WORK);
        let set = match rows.find(|row| row.option.name == name) {
            Some(row) => check(row.option.form, text).and_then(|()| (row.set)(self, text)),
            None if !is_known(name) => return Err(unknown(name)),
            None => self.job.set(name, text),
        };
        set.map_err(|reason| match text {
            "" => format!("--{name} needs a value: {reason}"),
            _ => format!("--{name} cannot be {text}: {reason}"),
        })
    }

    /// How the scene is read and compiled, with what the picture's size and the machine have to do with it.
    pub fn load_options(&self) -> LoadOptions {
        let mut load = self.load.clone();
        load.threads = self.threads;
        load.memory = self.memory.bytes();
        load.staging.aspect = self.job.given_size().map(|(width, height)| width as f32 / height.max(1) as f32);
        load
    }

    /// The job for a scene.
    ///
    /// # Errors
    ///
    /// A sentence, if options contradict each other or the scene.
    pub fn resolve(&self, loaded: &Loaded) -> Result<Job, String> {
        self.job.resolve(&loaded.job_context(self.time_limit.is_some()), Some(&self.view))
    }

    /// How the work is done.
    pub fn control(&self) -> Control {
        Control {
            threads: self.threads,
            tile: self.tile,
            time: self.time_limit,
            memory: self.memory.bytes(),
            ..Control::default()
        }
    }
}

/// Checks a text by what an option may be.
fn check(form: OptionForm, text: &str) -> Result<(), String> {
    match form {
        OptionForm::Whole(least, most) => match text.parse::<u32>() {
            Ok(number) if (least..=most).contains(&number) => Ok(()),
            Ok(_) => Err(format!("it is a number from {least} to {most}")),
            Err(_) => Err("it is a whole number".into()),
        },
        OptionForm::Words(words) if !words().contains(&text) => Err(format!("it is one of {}", words().join(", "))),
        OptionForm::Number(_, test, otherwise) if !text.parse().is_ok_and(test) => Err(otherwise.into()),
        _ => Ok(()),
    }
}

/// What an option concerns.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum OptionGroup {
    /// How the scene is read and compiled.
    Reading,
    /// The picture. These options decide every bit of it.
    Picture,
    /// Threads, time and shards. These change no bit of a finished picture.
    Work,
}

/// Statement of an option.
#[derive(Clone, Debug)]
#[non_exhaustive]
pub struct OptionStatement {
    /// Name without dashes.
    pub name: &'static str,
    /// Meaning, unit and default.
    pub help: String,
    /// Name of its value; `None` for a flag.
    pub value: Option<String>,
    /// The words that its value may be, where only some are allowed.
    pub words: Vec<&'static str>,
    /// What it concerns.
    pub group: OptionGroup,
}

/// All options.
pub fn statements() -> Vec<OptionStatement> {
    let of = |group| move |option: &JobOption| stated(option, group);
    let rows = |rows: &[rows::Row], group| rows.iter().map(|row| stated(&row.option, group)).collect::<Vec<_>>();
    let mut all = rows(READING, OptionGroup::Reading);
    all.push(OptionStatement {
        name: "integrator",
        help: integrator_help(),
        value: Some("METHOD".into()),
        words: Method::kinds().iter().map(Method::name).collect(),
        group: OptionGroup::Picture,
    });
    all.extend(integrator_options().into_iter().map(|(field, help)| OptionStatement {
        name: option_name(&field),
        help,
        value: Some(if let Kind::Word(_) = field.kind { "WORD" } else { "NUMBER" }.into()),
        words: if let Kind::Word(words) = field.kind { words.to_vec() } else { Vec::new() },
        group: OptionGroup::Picture,
    }));
    all.extend(RenderJob::OPTIONS.iter().map(of(OptionGroup::Picture)));
    all.extend(rows(VIEW, OptionGroup::Picture));
    all.extend(rows(WORK, OptionGroup::Work));
    all
}

fn stated(option: &JobOption, group: OptionGroup) -> OptionStatement {
    let (value, words) = match option.form {
        OptionForm::Flag => (None, Vec::new()),
        OptionForm::Switch => (Some("on|off".into()), Vec::new()),
        OptionForm::Whole(..) => (Some(option.name.to_uppercase()), Vec::new()),
        OptionForm::Value(value) | OptionForm::Number(value, ..) => (Some(value.into()), Vec::new()),
        OptionForm::Two(first, second) => (Some(format!("{first} {second}")), Vec::new()),
        OptionForm::Words(words) => (Some(option.name.to_uppercase()), words()),
    };
    OptionStatement { name: option.name, help: one_line(option.doc), value, words, group }
}

fn is_known(name: &str) -> bool {
    name == "integrator"
        || RenderJob::OPTIONS.iter().any(|option| option.name == name)
        || Method::kinds().iter().any(|kind| option_index(kind, name).is_some())
}

fn unknown(name: &str) -> String {
    let all = statements();
    match did_you_mean(name, all.iter().map(|option| option.name)) {
        Some(near) => format!("there is no option `{name}`; did you mean `{near}`?"),
        None => format!("there is no option `{name}`"),
    }
}

/// Help of `--integrator`: each integrator with its meaning.
pub fn integrator_help() -> String {
    let kinds = Method::kinds();
    let listed: Vec<String> = kinds.iter().map(|kind| format!("{} ({})", kind.name(), one_line(kind.doc()))).collect();
    format!(
        "What computes the light: {} [default: path for scenes with principled materials or an environment, else \
         whitted]",
        listed.join(", ")
    )
}

/// Options that integrators state, each once, with their help.
pub fn integrator_options() -> Vec<(Field, String)> {
    let kinds = Method::kinds();
    let mut all: Vec<(Field, String)> = Vec::new();
    for field in kinds.iter().flat_map(|kind| kind.fields()) {
        let name = option_name(field);
        if all.iter().any(|(known, _)| option_name(known) == name) {
            continue;
        }
        let having = kinds.iter().filter(|kind| option_index(kind, name).is_some()).map(Method::name);
        let help = one_line(field.doc);
        let (first, rest) = help.split_at(1);
        let help = format!("With {}: {}{rest}", having.collect::<Vec<_>>().join(" and "), first.to_lowercase());
        all.push((*field, help));
    }
    all
}

/// A statement's text in one line.
pub fn one_line(doc: &str) -> String {
    doc.split_whitespace().collect::<Vec<_>>().join(" ")
}

#[cfg(test)]
mod tests;
