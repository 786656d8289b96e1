//! Options of a render as pairs of a name and a text, for the command line and Python.
//!
//! [`option_descriptions`] lists all options with their meaning, and [`RenderOptions::set`] parses
//! a single option. Options that are not set have the same defaults as on the command line. Equal
//! options therefore give bit-identical pictures in every language.
//!
//! ```
//! use durer::options::RenderOptions;
//!
//! let mut options = RenderOptions::default();
//! options.set("samples", "64").unwrap();
//! options.set("accel", "grid").unwrap();
//! let error = options.set("size", "64").unwrap_err();
//! assert_eq!(error, "--size cannot be 64: expected WIDTHxHEIGHT, for example 640x480");
//! ```

pub mod memory;
mod rows;

pub use crate::job::{JobOption, OptionForm};
use crate::job::{OutputSelection, RenderJob, option_index, option_name, unknown_option};
use crate::{LoadOptions, LoadedScene};
use durer_render::integrator::IntegratorKind;
use durer_render::render::{Control, Job, Shard};
use durer_scene::describe::{DescribedKind, Field, FieldKind};
use memory::Memory;
use rows::{EXECUTION, LOADING, VIEW};
pub use rows::{compat, crop, doc, grid_cells, vector};
use std::time::Duration;

/// The options of `durer render`, parsed from text. They include options for loading, for the
/// picture and for execution.
#[derive(Clone, Debug)]
#[non_exhaustive]
pub struct RenderOptions {
    /// Options for reading and compiling the scene.
    pub load: LoadOptions,
    /// Options of the picture, such as size, samples and integrator.
    pub job: RenderJob,
    /// Crop and selection of the pictures to write.
    pub view: OutputSelection,
    /// Memory limit for the scene and the picture.
    pub memory: Memory,
    /// Number of threads, or `None` for one thread per processor.
    pub threads: Option<usize>,
    /// Width and height of a tile in pixels, or `None` to choose them from the size of the picture.
    pub tile: Option<u32>,
    /// Time after which no more samples are taken, or `None` for no limit.
    pub time_limit: Option<Duration>,
    /// Part of the work that is done if the render is divided into shards.
    pub shard: Shard,
}

impl Default for RenderOptions {
    fn default() -> Self {
        RenderOptions {
            load: LoadOptions::default(),
            job: RenderJob::default(),
            view: OutputSelection::default(),
            memory: Memory::default(),
            threads: None,
            tile: None,
            time_limit: None,
            shard: Shard::WHOLE,
        }
    }
}

impl RenderOptions {
    /// Sets an option by its name without dashes. `text` is empty for a flag. If an option can be
    /// repeated (`assets`, `compat`), the value is added to the previous values.
    ///
    /// # Errors
    ///
    /// Returns a message if the option is unknown or the text is not a valid value.
    pub fn set(&mut self, name: &str, text: &str) -> Result<(), String> {
        let mut rows = LOADING.iter().chain(VIEW).chain(EXECUTION);
        let set = match rows.find(|row| row.option.name == name) {
            Some(row) => row.option.form.check(text).and_then(|()| (row.set)(self, text)),
            None if !is_known(name) => {
                return Err(unknown_option(name, option_descriptions().iter().map(|option| option.name)));
            }
            None => self.job.set(name, text),
        };
        set.map_err(|reason| match text {
            "" => format!("--{name} needs a value: {reason}"),
            _ => format!("--{name} cannot be {text}: {reason}"),
        })
    }

    /// Returns the options for loading, including the threads, the memory and the aspect ratio.
    pub fn load_options(&self) -> LoadOptions {
        let mut load = self.load.clone();
        load.threads = self.threads;
        load.memory = self.memory.bytes();
        self.job.adapt(&mut load.scene_defaults);
        load
    }

    /// Resolves the options into a job for a scene.
    ///
    /// # Errors
    ///
    /// Returns a message if options contradict each other or the scene.
    pub fn resolve(&self, loaded: &LoadedScene) -> Result<Job, String> {
        self.job.resolve(&loaded.job_context(self.time_limit.is_some()), Some(&self.view))
    }

    /// Returns the execution options.
    pub fn control(&self) -> Control {
        Control {
            threads: self.threads,
            tile_size: self.tile,
            time_limit: self.time_limit,
            memory: self.memory.bytes(),
            ..Control::default()
        }
    }
}

/// Category of a render option by its effect on the picture.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum OptionGroup {
    /// Options for reading and compiling the scene.
    Loading,
    /// Options of the picture. Together with the scene, these options determine every bit of the
    /// picture.
    Picture,
    /// Options for execution, such as threads, time and shards. These options do not change a
    /// finished picture.
    Execution,
}

/// Documentation of a render option, from which help texts and bindings are generated.
#[derive(Clone, Debug)]
#[non_exhaustive]
pub struct OptionDescription {
    /// Name of the option without dashes.
    pub name: &'static str,
    /// Meaning, unit and default value of the option.
    pub help: String,
    /// Name of the value, or `None` for a flag.
    pub value: Option<String>,
    /// Allowed words, if only certain words are allowed.
    pub words: Vec<&'static str>,
    /// Category of the option.
    pub group: OptionGroup,
}

/// Returns the descriptions of all options.
pub fn option_descriptions() -> Vec<OptionDescription> {
    let rows = |rows: &[rows::Row], group| rows.iter().map(|row| describe(&row.option, group)).collect::<Vec<_>>();
    let mut all = rows(LOADING, OptionGroup::Loading);
    all.push(OptionDescription {
        name: "integrator",
        help: integrator_help(),
        value: Some("METHOD".into()),
        words: IntegratorKind::kinds().iter().map(IntegratorKind::name).collect(),
        group: OptionGroup::Picture,
    });
    all.extend(integrator_options().into_iter().map(|(field, help)| OptionDescription {
        name: option_name(&field),
        help,
        value: Some(if let FieldKind::Word(_) = field.kind { "WORD" } else { "NUMBER" }.into()),
        words: if let FieldKind::Word(words) = field.kind { words.to_vec() } else { Vec::new() },
        group: OptionGroup::Picture,
    }));
    all.extend(RenderJob::OPTIONS.iter().map(|option| describe(option, OptionGroup::Picture)));
    all.extend(rows(VIEW, OptionGroup::Picture));
    all.extend(rows(EXECUTION, OptionGroup::Execution));
    all
}

fn describe(option: &JobOption, group: OptionGroup) -> OptionDescription {
    let (value, words) = match option.form {
        OptionForm::Flag => (None, Vec::new()),
        OptionForm::Switch => (Some("on|off".into()), Vec::new()),
        OptionForm::Whole(..) => (Some(option.name.to_uppercase()), Vec::new()),
        OptionForm::Value(value) | OptionForm::Number(value, ..) => (Some(value.into()), Vec::new()),
        OptionForm::Two(first, second) => (Some(format!("{first} {second}")), Vec::new()),
        OptionForm::Words(words) => (Some(option.name.to_uppercase()), words()),
    };
    OptionDescription { name: option.name, help: one_line(option.doc), value, words, group }
}

fn is_known(name: &str) -> bool {
    name == "integrator"
        || RenderJob::OPTIONS.iter().any(|option| option.name == name)
        || IntegratorKind::kinds().iter().any(|kind| option_index(kind, name).is_some())
}

/// Returns the help text of `--integrator`, which lists each integrator with its meaning.
pub fn integrator_help() -> String {
    let kinds = IntegratorKind::kinds();
    let listed: Vec<String> = kinds.iter().map(|kind| format!("{} ({})", kind.name(), one_line(kind.doc()))).collect();
    format!(
        "Integrator: {} [default: path for scenes with principled materials, an environment, fog or emissive surfaces, \
         else whitted]",
        listed.join(", ")
    )
}

/// Returns the options of all integrators with their help texts. Each option is listed once.
pub fn integrator_options() -> Vec<(Field, String)> {
    let kinds = IntegratorKind::kinds();
    let mut all: Vec<(Field, String)> = Vec::new();
    for field in kinds.iter().flat_map(|kind| kind.fields()) {
        let name = option_name(field);
        if all.iter().any(|(known, _)| option_name(known) == name) {
            continue;
        }
        let having = kinds.iter().filter(|kind| option_index(kind, name).is_some()).map(IntegratorKind::name);
        let help = one_line(field.doc);
        let (first, rest) = help.split_at(1);
        let help = format!("With {}: {}{rest}", having.collect::<Vec<_>>().join(" and "), first.to_lowercase());
        all.push((*field, help));
    }
    all
}

/// Joins the lines of a description into one.
pub fn one_line(doc: &str) -> String {
    doc.split_whitespace().collect::<Vec<_>>().join(" ")
}

#[cfg(test)]
mod tests;
