//! Names of the options that a command line contains, for commands to which some options do not
//! apply.

use clap::parser::ValueSource;
use clap::{ArgMatches, Args, Command, FromArgMatches, Id};

/// Returns the name of an option without dashes. It differs from the option's long name where a
/// command has renamed a shared option.
pub fn name_of(id: &Id) -> String {
    id.as_str().replace('_', "-")
}

/// Names of the arguments that were given on the command line, without dashes. It must be the first
/// field of a command, because the parser removes the values of the fields before it.
#[derive(Clone, Default)]
pub struct GivenOptions(Vec<String>);

impl GivenOptions {
    /// Returns the first given option for which `is_wanted` returns true.
    pub fn find(&self, is_wanted: impl Fn(&str) -> bool) -> Option<&str> {
        self.0.iter().map(String::as_str).find(|name| is_wanted(name))
    }
}

impl Args for GivenOptions {
    fn augment_args(command: Command) -> Command {
        command
    }

    fn augment_args_for_update(command: Command) -> Command {
        command
    }
}

impl FromArgMatches for GivenOptions {
    fn from_arg_matches(matches: &ArgMatches) -> Result<Self, clap::Error> {
        let is_given = |id: &&Id| matches.value_source(id.as_str()) == Some(ValueSource::CommandLine);
        // Groups have the names of their types.
        let is_option = |id: &&Id| !id.as_str().starts_with(char::is_uppercase);
        Ok(GivenOptions(matches.ids().filter(is_option).filter(is_given).map(name_of).collect()))
    }

    fn update_from_arg_matches(&mut self, matches: &ArgMatches) -> Result<(), clap::Error> {
        *self = Self::from_arg_matches(matches)?;
        Ok(())
    }
}
