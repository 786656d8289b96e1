//! Arranges the options of commands in `--help`: the common options first, and all of them by topic
//! with `--help-all`.

use crate::options::name_of;
use clap::{Arg, ArgAction, Command};

/// Topics of the options that several commands share, in the order of `--help-all`. Options that
/// are not listed belong to a single command; its help shows them first.
const TOPICS: &[(&str, &[&str])] = &[
    ("Picture", &["size", "crop", "show", "zoom", "background", "depth-range", "light-range", "light-log"]),
    ("Camera", &["view", "eye", "target", "fov", "camera", "view-file", "fit", "turned"]),
    ("Model", &["up", "studio", "environment", "environment-rotation", "add-ground", "variant", "animation", "at"]),
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
            "terminal",
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
    "background",
    "denoise",
    "time-limit",
    "resume",
    "terminal",
    "frames",
    "turntable",
    "threads",
];

/// Minimum number of hidden options for which a command gets `--help-all`.
const MIN_HIDDEN: usize = 8;

/// Sorts the options of all commands by topic. If `all` is false, `--help` shows only the common
/// options.
pub fn arrange(program: Command, all: bool) -> Command {
    reflowed(program).mut_subcommands(|command| arrange_command(reflowed(command), all))
}

/// Joins the lines of each paragraph at the end of a command's help, because the lines are wrapped
/// again for the terminal. Indented lines, such as examples, and the lines before them stay as they
/// are.
fn reflowed(command: Command) -> Command {
    let Some(text) = command.get_after_help().map(ToString::to_string) else { return command };
    let mut joined = String::new();
    let mut lines = text.lines().peekable();
    while let Some(line) = lines.next() {
        let is_plain = |line: &str| !line.is_empty() && !line.starts_with(' ');
        joined += line;
        joined += match lines.peek() {
            Some(next) if is_plain(line) && is_plain(next) => " ",
            Some(_) => "\n",
            None => "",
        };
    }
    command.after_help(joined)
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
    let option = Arg::new("help-all").long("help-all").action(ArgAction::HelpLong).help(summary);
    command.arg(option.help_heading(None::<&str>))
}

/// Returns the topic of an option that commands share, and the option's place in the help. An
/// option is known by its id, because a command can have an option of its own with the same name.
fn topic(arg: &Arg) -> Option<(&'static str, usize)> {
    let name = arg.get_long().and(Some(name_of(arg.get_id())))?;
    let place = |names: &[&str]| names.iter().position(|known| *known == name);
    TOPICS.iter().find_map(|(heading, names)| Some((*heading, place(names)?)))
}

fn is_common(arg: &Arg) -> bool {
    COMMON.contains(&&*name_of(arg.get_id()))
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
    fn own_options_come_first_and_closing_texts_are_wrapped_once() {
        let help = |name: &str| {
            let program = arrange(Cli::command(), false);
            program.find_subcommand(name).unwrap().clone().render_long_help().to_string()
        };
        let measure = help("measure");
        let (own, shared) = (measure.find("Options:").unwrap(), measure.find("\nModel:").unwrap());
        for name in ["--at <X,Y,Z>", "--grid <CORNER", "--points", "--normal", "--plan", "--help-all"] {
            assert!(
                (own..shared).contains(&measure.find(name).unwrap_or_else(|| panic!("{name}: {measure}"))),
                "{name}"
            );
        }
        for name in ["--eye", "--view", "--fov", "--camera"] {
            assert!(!measure.contains(name), "{name} does not change what is measured");
        }
        let explain = help("explain");
        for name in ["--output", "--hash", "--stats", "--watch", "--exposure", "--resume"] {
            assert!(!explain.contains(name), "{name}");
        }
        for name in ["info", "measure", "compare", "lesson"] {
            assert!(!help(name).contains("\nModels:"), "{name}");
        }
        assert!(help("render").contains("OBJ, STL. A model without a camera"));
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
