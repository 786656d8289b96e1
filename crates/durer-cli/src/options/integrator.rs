//! Command-line options of the integrators, which are generated from the library's table.

use clap::builder::{PossibleValuesParser, TypedValueParser, ValueParser};
use clap::{Arg, ArgMatches, Args, Command, FromArgMatches};
use durer::describe::{DescribedKind, FieldKind, Value};
use durer::integrator::IntegratorKind;
use durer::job::{RenderJob, option_name};
use durer::options::{integrator_help, integrator_options};

/// The integrator options given on the command line.
#[derive(Clone, Default)]
pub struct IntegratorArgs(pub RenderJob);

impl Args for IntegratorArgs {
    fn augment_args(command: Command) -> Command {
        let integrator = Arg::new("integrator")
            .long("integrator")
            .value_name("METHOD")
            .value_parser(PossibleValuesParser::new(IntegratorKind::kinds().iter().map(IntegratorKind::name)))
            .help(integrator_help());
        integrator_options().into_iter().fold(command.arg(integrator), |command, (field, help)| {
            let (value, parser) = match field.kind {
                FieldKind::Word(words) => ("WORD", PossibleValuesParser::new(words).map(Value::Word).into()),
                FieldKind::Int => ("N", clap::value_parser!(u32).map(Value::Int).into()),
                _ => ("NUMBER", ValueParser::new(number)),
            };
            let name = option_name(&field);
            command.arg(Arg::new(name).long(name).value_name(value).value_parser(parser).help(help))
        })
    }

    fn augment_args_for_update(command: Command) -> Command {
        Self::augment_args(command)
    }
}

impl FromArgMatches for IntegratorArgs {
    fn from_arg_matches(matches: &ArgMatches) -> Result<Self, clap::Error> {
        let mut job = RenderJob::default();
        if let Some(name) = matches.get_one::<String>("integrator") {
            job = job.integrator(name);
        }
        for (field, _) in integrator_options() {
            if let Some(value) = matches.get_one::<Value>(option_name(&field)) {
                let wrong = |message| clap::Error::raw(clap::error::ErrorKind::InvalidValue, message);
                job.set_integrator_option(option_name(&field), value.clone()).map_err(wrong)?;
            }
        }
        Ok(IntegratorArgs(job))
    }

    fn update_from_arg_matches(&mut self, matches: &ArgMatches) -> Result<(), clap::Error> {
        *self = Self::from_arg_matches(matches)?;
        Ok(())
    }
}

fn number(text: &str) -> Result<Value, String> {
    let number: f32 = text.parse().map_err(|_| "expected a number".to_string())?;
    if number.is_finite() { Ok(Value::Float(number)) } else { Err("expected a finite number".into()) }
}
