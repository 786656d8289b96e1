//! Prints the dialects, shell completions and the manual page.

use crate::args::Cli;
use crate::failure::Failure;
use crate::terminal::say;
use clap::CommandFactory;
use durer::dialect::{Dialect, Quirk};

/// `durer dialects`: prints the dialects and the quirks.
pub fn dialects() -> Result<(), Failure> {
    say("Dialects (--dialect NAME):");
    for dialect in Dialect::ALL {
        let rules = dialect.rules();
        let names = Quirk::ALL.iter().filter(|row| rules.has(row.0)).map(|row| row.1);
        let quirks: Vec<&str> = names.collect();
        say(&format!("  {:<7}{}", rules.name, rules.title));
        if !quirks.is_empty() {
            say(&format!("         quirks: {}", quirks.join(", ")));
        }
    }
    say("\nQuirks of the official programs, and a common bug (--compat NAME, --compat no-NAME):");
    for (_, name, doc) in Quirk::ALL {
        say(&format!("  {name:<18}{}", doc.split_whitespace().collect::<Vec<_>>().join(" ")));
    }
    Ok(())
}

/// `durer completions`: prints a shell's completion script.
pub fn completions(shell: clap_complete::Shell) -> Result<(), Failure> {
    let mut text = Vec::new();
    clap_complete::generate(shell, &mut Cli::command(), "durer", &mut text);
    say(String::from_utf8_lossy(&text).trim_end());
    Ok(())
}

/// `durer man`: prints the manual page of the command, then those of its subcommands.
pub fn man() -> Result<(), Failure> {
    let mut text = Vec::new();
    let command = Cli::command();
    clap_mangen::Man::new(command.clone()).render(&mut text)?;
    for part in command.get_subcommands() {
        let name = format!("durer-{}", part.get_name());
        clap_mangen::Man::new(part.clone().name(name)).render(&mut text)?;
    }
    say(String::from_utf8_lossy(&text).trim_end());
    Ok(())
}
