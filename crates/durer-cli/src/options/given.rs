//! Names of the options that a command line contains, for commands to which some options do not
//! apply.

use clap::parser::ValueSource;
use clap::{ArgMatches, Args, Command, FromArgMatches};

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
        let is_given = |id: &&str| matches.value_source(id) == Some(ValueSource::CommandLine);
        // Groups have the names of their types.
        let is_option = |id: &&str| !id.starts_with(char::is_uppercase);
        let ids = matches.ids().map(clap::Id::as_str).filter(is_option).filter(is_given);
        Ok(GivenOptions(ids.map(|id| id.replace('_', "-")).collect()))
    }

    fn update_from_arg_matches(&mut self, matches: &ArgMatches) -> Result<(), clap::Error> {
        *self = Self::from_arg_matches(matches)?;
        Ok(())
    }
}
