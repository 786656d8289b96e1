//! Arranges the options of commands in `--help`: the common options first, and all of them by topic
//! with `--help-all`.

use clap::{Arg, ArgAction, Command};

/// Topics of the options that several commands share, in the order of `--help-all`. Options that
/// are not listed belong to a single command; its help shows them first.
const TOPICS: &[(&str, &[&str])] = &[
    ("Picture", &["size", "crop", "show", "zoom", "depth-range", "light-range", "light-log"]),
    ("Camera", &["view", "eye", "target", "fov", "camera", "view-file", "fit", "turned"]),
    ("Model", &["up", "studio", "environment", "variant", "at"]),
    ("Reading", &["dialect", "compat", "strict", "assets", "allow-outside", "memory"]),
    (
        "Light",
        &[
            "integrator",
            "bounces",
            "min-throughput",
            "direct",
            "clamp",
            "color",
            "photons",
            "photon-radius",
            "ao-radius",
            "shadows",
            "transparent-shadows",
            "shade-back",
            "no-reflection",
            "no-refraction",
        ],
    ),
    (
        "Sampling",
        &["samples", "noise-threshold", "adaptive", "seed", "sampler", "filter", "filter-radius", "jitter", "blur"],
    ),
    ("Display", &["exposure", "tone", "transfer", "bits", "denoise", "shutter", "f-number", "iso"]),
    (
        "Long renders",
        &[
            "time-limit",
            "resume",
            "restart",
            "checkpoint",
            "checkpoint-every",
            "no-checkpoint",
            "preview",
            "shard",
            "shard-by",
        ],
    ),
    ("Animation", &["frames", "fps", "turntable"]),
    ("Speed", &["device", "threads", "accel", "grid", "tile"]),
];

/// Shared options that `--help` shows.
const COMMON: &[&str] = &[
    "size",
    "show",
    "view",
    "eye",
    "target",
    "fov",
    "studio",
    "environment",
    "dialect",
    "assets",
    "integrator",
    "bounces",
    "shadows",
    "samples",
    "noise-threshold",
    "exposure",
    "tone",
    "denoise",
    "time-limit",
    "resume",
    "frames",
    "turntable",
    "threads",
];

/// Minimum number of hidden options for which a command gets `--help-all`.
const MIN_HIDDEN: usize = 8;

/// Sorts the options of all commands by topic. If `all` is false, `--help` shows only the common
/// options.
pub fn arrange(program: Command, all: bool) -> Command {
    program.mut_subcommands(|command| arrange_command(command, all))
}

fn arrange_command(command: Command, all: bool) -> Command {
    let is_rare = |arg: &&Arg| !arg.is_hide_set() && topic(arg).is_some() && !is_common(arg);
    let rare = command.get_arguments().filter(is_rare).count();
    let has_more = rare >= MIN_HIDDEN;
    let command = command.mut_args(|arg| {
        let hide = has_more && !all && is_rare(&&arg);
        match topic(&arg) {
            Some((heading, order)) => {
                arg.help_heading(heading).display_order(order).hide_short_help(hide).hide_long_help(hide)
            }
            None => arg.help_heading(None::<&str>),
        }
    });
    if !has_more {
        return command;
    }
    let summary = match all {
        true => "Print all options, by topic".to_string(),
        false => format!("Print all options, by topic ({rare} more)"),
    };
    command.arg(Arg::new("help-all").long("help-all").action(ArgAction::HelpLong).help(summary))
}

/// Returns the topic of an option that commands share, and the option's place in the help.
fn topic(arg: &Arg) -> Option<(&'static str, usize)> {
    let name = arg.get_long()?;
    let place = |names: &[&str]| names.iter().position(|known| *known == name);
    TOPICS.iter().find_map(|(heading, names)| Some((*heading, place(names)?)))
}

fn is_common(arg: &Arg) -> bool {
    arg.get_long().is_some_and(|name| COMMON.contains(&name))
}

#[cfg(test)]
mod tests {
    use super::{COMMON, TOPICS, arrange};
    use crate::args::Cli;
    use clap::{Command, CommandFactory};
    use std::collections::BTreeSet;

    fn render(all: bool) -> Command {
        arrange(Cli::command(), all).find_subcommand("render").unwrap().clone()
    }

    #[test]
    fn topics_name_options_of_render_once() {
        let render = render(true);
        let options: BTreeSet<&str> = render.get_arguments().filter_map(|arg| arg.get_long()).collect();
        let mut listed = BTreeSet::new();
        for name in TOPICS.iter().flat_map(|(_, names)| *names) {
            assert!(options.contains(name), "{name} is not an option");
            assert!(listed.insert(*name), "{name} has two topics");
        }
        assert!(COMMON.iter().all(|name| listed.contains(name)));
        let own: Vec<&&str> = options.difference(&listed).collect();
        assert_eq!(own, [&"hash", &"help-all", &"output", &"pixel", &"quiet", &"sample", &"stats", &"watch"]);
    }

    #[test]
    fn help_shows_common_options_and_help_all_shows_all() {
        let (common, all) = (render(false).render_long_help().to_string(), render(true).render_long_help().to_string());
        for name in ["--size", "--samples", "--view", "--output", "--help-all", "--dialect"] {
            assert!(common.contains(name) && all.contains(name), "{name}");
        }
        for name in ["--photon-radius", "--shard-by", "--jitter", "--checkpoint-every"] {
            assert!(!common.contains(name) && all.contains(name), "{name}");
        }
        assert!(2 * common.lines().count() < all.lines().count() + 60);
    }
}
