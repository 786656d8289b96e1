//! Command-line options of the acceleration structure and of the render job. The latter are
//! generated from the library's table.

use super::integrator::IntegratorArgs;
use crate::failure::{Failure, invalid_input};
use clap::builder::{ArgPredicate, PossibleValuesParser, TypedValueParser};
use clap::parser::ValueSource;
use clap::{Arg, ArgAction, ArgMatches, Args, Command, FromArgMatches, value_parser};
use durer::compile::AccelKind;
use durer::job::{JobOption, OptionForm, RenderJob};
use durer::options::{doc as meaning, grid_cells, one_line};

/// Command-line options that determine a picture: the render job and the acceleration structure.
pub struct JobArgs {
    /// Options of the render job.
    pub options: RenderJob,
    accel: AccelArgs,
}

/// Options of the acceleration structure
#[derive(Args)]
struct AccelArgs {
    #[arg(long, help = meaning("accel"), default_value = "bvh", hide_default_value = true, default_value_if("grid", ArgPredicate::IsPresent, "grid"), value_parser = ["bvh", "grid", "none"])]
    accel: String,
    #[arg(long, help = meaning("grid"), value_name = "XxYxZ", value_parser = grid_cells)]
    grid: Option<[u32; 3]>,
}

/// Creates the clap argument for an option of the library.
fn arg(option: &'static JobOption) -> Arg {
    let JobOption { name, doc, form } = *option;
    let arg = Arg::new(name).long(name).help(one_line(doc));
    // Validate the text but store it as text.
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
            let command = if option.name == "bounces" { IntegratorArgs::augment_args(command) } else { command };
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
        let IntegratorArgs(mut options) = IntegratorArgs::from_arg_matches(matches)?;
        let given = |name: &str| matches.value_source(name).is_some_and(|source| source != ValueSource::DefaultValue);
        for JobOption { name, form, .. } in RenderJob::OPTIONS.iter().filter(|option| given(option.name)) {
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

/// Returns the requested acceleration structure.
pub fn accel(args: &JobArgs) -> Result<AccelKind, Failure> {
    let AccelArgs { accel, grid } = &args.accel;
    if grid.is_some() && accel != "grid" {
        return Err(invalid_input(format!("--grid does not apply to --accel {accel}")));
    }
    Ok(match accel.as_str() {
        "grid" => AccelKind::Grid(*grid),
        "none" => AccelKind::None,
        _ => AccelKind::Bvh,
    })
}
