//! What computes the light, from options. The integrators state their own.

use clap::builder::{PossibleValuesParser, TypedValueParser, ValueParser};
use clap::{Arg, ArgMatches, Args, Command, FromArgMatches};
use durer::describe::{DescribedList, Field, Kind, Value};
use durer::integrator::Method;
use durer::job::{RenderJob, option_index, option_name};

/// What computes the light: the options that are given.
#[derive(Clone, Default)]
pub struct MethodArgs(pub RenderJob);

/// All options of all methods, each once.
fn options() -> Vec<Field> {
    let mut all: Vec<Field> = Vec::new();
    for field in Method::kinds().iter().flat_map(|kind| kind.fields()) {
        if !all.iter().any(|known| option_name(known) == option_name(field)) {
            all.push(*field);
        }
    }
    all
}

/// The names of the methods that an option belongs to.
fn of(option: &str) -> Vec<&'static str> {
    Method::kinds().iter().filter(|kind| option_index(kind, option).is_some()).map(Method::name).collect()
}

impl Args for MethodArgs {
    fn augment_args(command: Command) -> Command {
        let kinds = Method::kinds();
        let told: Vec<String> = kinds.iter().map(|kind| format!("{} ({})", kind.name(), plain(kind.doc()))).collect();
        let integrator = Arg::new("integrator")
            .long("integrator")
            .value_name("METHOD")
            .value_parser(PossibleValuesParser::new(kinds.iter().map(Method::name)))
            .help(format!(
                "What computes the light: {} [default: path for scenes with principled materials or an environment, \
                 else whitted]",
                told.join(", ")
            ));
        options().iter().fold(command.arg(integrator), |command, field| {
            let (value, parser) = match field.kind {
                Kind::Word(words) => ("WORD", PossibleValuesParser::new(words).map(Value::Word).into()),
                Kind::Int => ("N", clap::value_parser!(u32).map(Value::Int).into()),
                _ => ("NUMBER", ValueParser::new(number)),
            };
            let help = plain(field.doc);
            let (first, rest) = help.split_at(1);
            let help = format!("With {}: {}{rest}", of(option_name(field)).join(" and "), first.to_lowercase());
            command.arg(
                Arg::new(option_name(field)).long(option_name(field)).value_name(value).value_parser(parser).help(help),
            )
        })
    }

    fn augment_args_for_update(command: Command) -> Command {
        Self::augment_args(command)
    }
}

impl FromArgMatches for MethodArgs {
    fn from_arg_matches(matches: &ArgMatches) -> Result<Self, clap::Error> {
        let mut job = RenderJob::default();
        if let Some(name) = matches.get_one::<String>("integrator") {
            job = job.integrator(name);
        }
        for field in options() {
            if let Some(value) = matches.get_one::<Value>(option_name(&field)) {
                let wrong = |message| clap::Error::raw(clap::error::ErrorKind::InvalidValue, message);
                job.set_integrator_option(option_name(&field), value.clone()).map_err(wrong)?;
            }
        }
        Ok(MethodArgs(job))
    }

    fn update_from_arg_matches(&mut self, matches: &ArgMatches) -> Result<(), clap::Error> {
        *self = Self::from_arg_matches(matches)?;
        Ok(())
    }
}

/// Text of a statement in one line.
pub fn plain(doc: &str) -> String {
    doc.split_whitespace().collect::<Vec<_>>().join(" ")
}

fn number(text: &str) -> Result<Value, String> {
    let number: f32 = text.parse().map_err(|_| "no number".to_string())?;
    if number.is_finite() { Ok(Value::Float(number)) } else { Err("must be finite".into()) }
}
