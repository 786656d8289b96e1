//! Prints the dialects, shell completions and the manual page.

use crate::args::Cli;
use crate::failure::Failure;
use crate::terminal::print_line;
use clap::CommandFactory;
use durer::dialect::{Dialect, Quirk};

/// Implements `durer dialects`, which prints the dialects and the quirks.
pub fn dialects() -> Result<(), Failure> {
    print_line("Dialects (--dialect NAME):");
    for dialect in Dialect::ALL {
        let rules = dialect.rules();
        let names = Quirk::ALL.iter().filter(|row| rules.has(row.0)).map(|row| row.1);
        let quirks: Vec<&str> = names.collect();
        print_line(&format!("  {:<7}{}", rules.name, rules.title));
        if !quirks.is_empty() {
            print_line(&format!("         quirks: {}", quirks.join(", ")));
        }
    }
    print_line("\nQuirks of the official programs, and a common bug (--compat NAME, --compat no-NAME):");
    for (_, name, doc) in Quirk::ALL {
        print_line(&format!("  {name:<18}{}", doc.split_whitespace().collect::<Vec<_>>().join(" ")));
    }
    Ok(())
}

/// Implements `durer completions`, which prints a shell's completion script.
pub fn completions(shell: clap_complete::Shell) -> Result<(), Failure> {
    let mut text = Vec::new();
    clap_complete::generate(shell, &mut Cli::command(), "durer", &mut text);
    print_line(String::from_utf8_lossy(&text).trim_end());
    Ok(())
}

/// Implements `durer man`, which prints the manual page of the command followed by those of its
/// subcommands.
pub fn man() -> Result<(), Failure> {
    let mut text = Vec::new();
    let command = Cli::command();
    clap_mangen::Man::new(command.clone()).render(&mut text)?;
    for part in command.get_subcommands() {
        let name = format!("durer-{}", part.get_name());
        clap_mangen::Man::new(part.clone().name(name)).render(&mut text)?;
    }
    print_line(String::from_utf8_lossy(&text).trim_end());
    Ok(())
}
