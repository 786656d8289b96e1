//! What computes the light, from options. The integrators state their own.

use crate::failure::{Failure, bad};
use clap::builder::{PossibleValuesParser, TypedValueParser, ValueParser};
use clap::{Arg, ArgMatches, Args, Command, FromArgMatches};
use durer::describe::{DescribedList, Field, Kind, Value};
use durer::dialect::Dialect;
use durer::integrator::Method;
use durer::scene::Scene;

/// What computes the light: the options that are given.
#[derive(Clone, Default)]
pub struct MethodArgs {
    integrator: Option<String>,
    options: Vec<(&'static str, Value)>,
}

/// The method that a scene needs.
pub fn usual(scene: &Scene) -> Method {
    if scene.is_physical() { Method::PATH } else { Method::WHITTED }
}

fn word(field: &Field) -> &'static str {
    field.spelling(Dialect::Durer).unwrap_or(field.name)
}

/// Which of a method's options has a name.
fn position(method: &Method, option: &str) -> Option<usize> {
    method.fields().iter().position(|field| word(field) == option)
}

/// All options of all methods, each once.
fn options() -> Vec<Field> {
    let mut all: Vec<Field> = Vec::new();
    for field in Method::kinds().iter().flat_map(|kind| kind.fields()) {
        if !all.iter().any(|known| word(known) == word(field)) {
            all.push(*field);
        }
    }
    all
}

/// The names of the methods that an option belongs to.
fn of(option: &str) -> Vec<&'static str> {
    Method::kinds().iter().filter(|kind| position(kind, option).is_some()).map(Method::name).collect()
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
            let help = format!("With {}: {}{rest}", of(word(field)).join(" and "), first.to_lowercase());
            command.arg(Arg::new(word(field)).long(word(field)).value_name(value).value_parser(parser).help(help))
        })
    }

    fn augment_args_for_update(command: Command) -> Command {
        Self::augment_args(command)
    }
}

impl FromArgMatches for MethodArgs {
    fn from_arg_matches(matches: &ArgMatches) -> Result<Self, clap::Error> {
        let given = |field: Field| Some((word(&field), matches.get_one::<Value>(word(&field))?.clone()));
        let options = options().into_iter().filter_map(given).collect();
        Ok(MethodArgs { integrator: matches.get_one::<String>("integrator").cloned(), options })
    }

    fn update_from_arg_matches(&mut self, matches: &ArgMatches) -> Result<(), clap::Error> {
        *self = Self::from_arg_matches(matches)?;
        Ok(())
    }
}

/// Text of a statement in one line.
fn plain(doc: &str) -> String {
    doc.split_whitespace().collect::<Vec<_>>().join(" ")
}

fn number(text: &str) -> Result<Value, String> {
    let number: f32 = text.parse().map_err(|_| "no number".to_string())?;
    if number.is_finite() { Ok(Value::Float(number)) } else { Err("must be finite".into()) }
}

impl MethodArgs {
    /// The method that the options ask for; without any, the usual one.
    pub fn method(&self, usual: Method) -> Result<Method, Failure> {
        let has = |kind: &Method, (option, _): &(&str, Value)| position(kind, option).is_some();
        let mut methods = std::iter::once(usual).chain(Method::kinds());
        // The one that has all the options, or at least the last.
        let fitting = methods.clone().find(|kind| self.options.iter().all(|option| has(kind, option)));
        let mut method = match &self.integrator {
            Some(asked) => methods.find(|kind| kind.name() == asked),
            None => fitting.or_else(|| methods.find(|kind| self.options.last().is_none_or(|option| has(kind, option)))),
        }
        .unwrap_or_default();
        for (option, value) in &self.options {
            let Some(at) = position(&method, option) else {
                return Err(bad(format!("--{option} makes no sense with --integrator {}", method.name())));
            };
            if let Err(wrong) = method.fields()[at].rule.validate(value) {
                return Err(bad(format!("--{option} {wrong}")));
            }
            method.set(at, value.clone());
        }
        Ok(method)
    }
}

/// The options that make a method of a scene, where it is not what the scene has by itself.
pub fn spelled(method: Method, scene: &Scene) -> Vec<String> {
    let own = method.fields().iter().enumerate();
    let plain = Method::kinds().into_iter().find(|kind| kind.name() == method.name()).unwrap_or_default();
    let differing = own.filter(|&(at, _)| method.get(at) != plain.get(at)).filter_map(|(at, field)| {
        let value = match method.get(at)? {
            Value::Float(number) => number.to_string(),
            Value::Int(number) => number.to_string(),
            Value::Word(word) => word,
            _ => return None,
        };
        Some(format!("--{} {value}", word(field)))
    });
    let unusual = method.name() != usual(scene).name();
    unusual.then(|| format!("--integrator {}", method.name())).into_iter().chain(differing).collect()
}
