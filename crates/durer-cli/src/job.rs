//! From options to a job.

use crate::failure::{Failure, bad};
use crate::method::{MethodArgs, plain};
use crate::options::{SceneArgs, ViewArgs};
use crate::report;
use crate::values::cells;
use clap::builder::{ArgPredicate, PossibleValuesParser, TypedValueParser};
use clap::{Arg, ArgAction, ArgMatches, Args, Command, FromArgMatches, value_parser};
use durer::Loaded;
use durer::camera::{Projection, Raster};
use durer::compile::AccelKind;
use durer::diag::Diagnostic;
use durer::dialect::{Compat, Dialect};
use durer::job::{JobContext, JobOption, OptionForm, RenderJob, View};
use durer::render::{Job, Sampling};
use durer::world::World;

/// What the picture is: the options that the library states, and what finds objects.
pub struct JobArgs {
    /// Options of the picture.
    pub options: RenderJob,
    accel: AccelArgs,
}

/// What finds objects
#[derive(Args)]
struct AccelArgs {
    /// What finds the objects that a ray may hit
    #[arg(long, default_value = "bvh", default_value_if("grid", ArgPredicate::IsPresent, "grid"), value_parser = ["bvh", "grid", "none"])]
    accel: String,
    /// Cells of the grid, which is used then [default: suitable ones]
    #[arg(long, value_name = "XxYxZ", value_parser = cells)]
    grid: Option<[u32; 3]>,
}

/// An option as the command line has it.
fn arg(option: &'static JobOption) -> Arg {
    let JobOption { name, doc, form } = *option;
    let arg = Arg::new(name).long(name).help(plain(doc));
    // Checks a text, and keeps it.
    let checked = move |text: &str| RenderJob::default().set(name, text).map(|()| text.to_string());
    let arg = match form {
        OptionForm::Flag => arg.action(ArgAction::SetTrue),
        OptionForm::Switch => arg
            .value_name("on|off")
            .num_args(0..=1)
            .require_equals(true)
            .default_missing_value("on")
            .value_parser(checked),
        OptionForm::Whole(least, most) => {
            let parser = value_parser!(u32).range(i64::from(least)..=i64::from(most));
            arg.value_name(name.to_uppercase()).value_parser(parser.map(|number| number.to_string()))
        }
        OptionForm::Value(value) => arg.value_name(value).value_parser(checked),
        OptionForm::Number(value, ..) => arg.value_name(value).value_parser(checked),
        OptionForm::Two(first, second) => {
            arg.num_args(2).value_names([first, second]).allow_negative_numbers(true).value_parser(value_parser!(f32))
        }
        OptionForm::Words(words) => {
            arg.value_name(name.to_uppercase()).value_parser(PossibleValuesParser::new(words()))
        }
    };
    match name {
        "light-log" => arg.requires("light-range"),
        "min-throughput" => arg.alias("weight").allow_negative_numbers(true),
        "sampler" => arg.default_value("sobol"),
        "filter-radius" => arg.requires("filter"),
        "jitter" | "blur" => arg.conflicts_with_all(["samples", "sampler", "filter"]),
        "noise-threshold" => arg.alias("noise"),
        "adaptive" => arg.conflicts_with_all(["noise-threshold", "jitter", "blur"]),
        "seed" => arg.default_value("0"),
        _ => arg,
    }
}

impl Args for JobArgs {
    fn augment_args(command: Command) -> Command {
        let command = RenderJob::OPTIONS.iter().fold(command, |command, option| {
            let command = if option.name == "bounces" { MethodArgs::augment_args(command) } else { command };
            command.arg(arg(option))
        });
        AccelArgs::augment_args(command)
    }

    fn augment_args_for_update(command: Command) -> Command {
        Self::augment_args(command)
    }
}

impl FromArgMatches for JobArgs {
    fn from_arg_matches(matches: &ArgMatches) -> Result<Self, clap::Error> {
        let MethodArgs(mut options) = MethodArgs::from_arg_matches(matches)?;
        for JobOption { name, form, .. } in RenderJob::OPTIONS {
            let text = match form {
                OptionForm::Flag => matches.get_flag(name).then(|| "on".to_string()),
                OptionForm::Two(..) => matches
                    .get_many::<f32>(name)
                    .map(|numbers| numbers.map(f32::to_string).collect::<Vec<_>>().join(" ")),
                _ => matches.get_one::<String>(name).cloned(),
            };
            if let Some(text) = text {
                let wrong = |message| clap::Error::raw(clap::error::ErrorKind::InvalidValue, message);
                options.set(name, &text).map_err(wrong)?;
            }
        }
        Ok(JobArgs { options, accel: AccelArgs::from_arg_matches(matches)? })
    }

    fn update_from_arg_matches(&mut self, matches: &ArgMatches) -> Result<(), clap::Error> {
        *self = Self::from_arg_matches(matches)?;
        Ok(())
    }
}

/// The structure that the options ask for.
pub fn accel(args: &JobArgs) -> Result<AccelKind, Failure> {
    let AccelArgs { accel, grid } = &args.accel;
    if grid.is_some() && accel != "grid" {
        return Err(bad(format!("--grid makes no sense with --accel {accel}")));
    }
    Ok(match accel.as_str() {
        "grid" => AccelKind::Grid(*grid),
        "none" => AccelKind::None,
        _ => AccelKind::Bvh,
    })
}

/// The width over the height of the picture that the options ask for.
pub fn aspect(args: &JobArgs) -> Option<f32> {
    args.options.given_size().map(|(width, height)| width as f32 / height.max(1) as f32)
}

/// What defaults follow from.
fn context(loaded: &Loaded, timed: bool) -> JobContext<'_> {
    // Ours is a dialect like others to ask for, but not an old program.
    let emulates = loaded.guess.is_none() && loaded.dialect != Dialect::Durer;
    JobContext { scene: &loaded.scene, rules: &loaded.rules, emulates, timed }
}

/// The job that the options ask for, the colour of the whole picture without a view; `timed` if
/// time decides when it ends.
pub fn job(args: &JobArgs, view: Option<&ViewArgs>, loaded: &Loaded, timed: bool) -> Result<Job, Failure> {
    let view = view.map(|view| View { crop: view.crop, show: view.show.clone() });
    args.options.resolve(&context(loaded, timed), view.as_ref()).map_err(bad)
}

/// Warns of a picture that its camera does not fill, or whose lens stays unused.
pub fn warn(job: &Job, world: &World) {
    let camera = world.camera();
    let (columns, rows) = durer::render::raster(world, job.width, job.height).empty();
    if (columns, rows) != (0, 0) {
        let (count, what) = if columns > 0 { (columns, "columns") } else { (rows, "rows") };
        let (w, h) = Raster::natural_size(camera.proportions(), (job.width, job.height));
        report::note(&Diagnostic::warning(format!(
            "{count} {what} of {}x{} stay empty: this camera's picture has another shape; `--size {w}x{h}` has it",
            job.width, job.height
        )));
    }
    if job.sampling == Sampling::Center && camera.has_aperture() {
        let message = "with one sample a pixel only the middle of the lens is used, and nothing is out of focus; ask for \
                       more `--samples`, 64 say";
        report::note(&Diagnostic::warning(message));
    }
}

/// The options that make a job of a scene, but for its size: those that are not what the scene has
/// by itself.
pub fn spelled(reading: &SceneArgs, job: &Job, loaded: &Loaded) -> String {
    let asked = loaded.guess.is_none();
    let mut words: Vec<String> = Vec::new();
    let mut add = |word: String| words.push(word);
    if asked {
        add(format!("--dialect {}", loaded.dialect.name()));
    }
    for (compat, on) in &reading.compat {
        let name = Compat::ALL.iter().find(|row| row.0 == *compat).map_or("", |row| row.1);
        add(format!("--compat {}{name}", if *on { "" } else { "no-" }));
    }
    for assets in &reading.assets {
        add(format!("--assets {}", shlex::try_quote(&assets.to_string_lossy()).unwrap_or_default()));
    }
    for (flag, on) in [("--strict", reading.strict), ("--allow-outside", reading.allow_outside)] {
        if on {
            add(flag.into());
        }
    }
    words.extend(RenderJob::of(job, &context(loaded, false)).spelled());
    words.join(" ")
}
