//! What the program says of itself.

use crate::args::Cli;
use crate::failure::Failure;
use crate::terminal::say;
use clap::CommandFactory;
use durer::dialect::{Compat, Dialect};

/// `durer dialects`: the table, and the quirks by name.
pub fn dialects() -> Result<(), Failure> {
    say("Dialects (--dialect NAME):");
    for dialect in Dialect::ALL {
        let rules = dialect.rules();
        let names = Compat::ALL.iter().filter(|row| rules.has(row.0)).map(|row| row.1);
        let quirks: Vec<&str> = names.collect();
        say(&format!("  {:<7}{}", rules.name, rules.title));
        if !quirks.is_empty() {
            say(&format!("         quirks: {}", quirks.join(", ")));
        }
    }
    say("\nHabits of old programs, and a usual mistake (--compat NAME, --compat no-NAME):");
    for (_, name, doc) in Compat::ALL {
        say(&format!("  {name:<18}{}", doc.split_whitespace().collect::<Vec<_>>().join(" ")));
    }
    Ok(())
}

/// `durer completions`.
pub fn completions(shell: clap_complete::Shell) -> Result<(), Failure> {
    let mut text = Vec::new();
    clap_complete::generate(shell, &mut Cli::command(), "durer", &mut text);
    say(String::from_utf8_lossy(&text).trim_end());
    Ok(())
}

/// `durer man`: the page of the command, followed by those of its parts.
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
