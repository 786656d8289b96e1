//! Prints the dialects, shell completions and the manual pages.

use crate::args::{Cli, ManArgs};
use crate::failure::{Failure, invalid_input};
use crate::help::arrange;
use crate::terminal::print_line;
use clap::{Command, CommandFactory};
use durer::dialect::{Dialect, Quirk};
use durer::image::save;

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
    clap_complete::generate(shell, &mut arrange(Cli::command(), true), "durer", &mut text);
    print_line(String::from_utf8_lossy(&text).trim_end());
    Ok(())
}

/// Implements `durer man`.
pub fn man(args: &ManArgs) -> Result<(), Failure> {
    let program = arrange(Cli::command(), true);
    let named = |part: &Command| part.clone().name(format!("durer-{}", part.get_name()));
    match (&args.folder, &args.command) {
        (Some(folder), _) => {
            let pages = std::iter::once(program.clone()).chain(program.get_subcommands().map(named));
            let file = |page: Command| Ok((folder.join(format!("{}.1", page.get_name())), troff(page)?));
            let files = pages.map(file).collect::<Result<Vec<_>, Failure>>()?;
            std::fs::create_dir_all(folder)
                .map_err(|error| invalid_input(format!("cannot create {}: {error}", folder.display())))?;
            for (path, text) in &files {
                save(path, text).map_err(|error| Failure::Other(error.into()))?;
            }
            print_line(&format!("wrote {} pages to {}", files.len(), folder.display()));
        }
        (None, Some(name)) => {
            let part = program.find_subcommand(name).ok_or_else(|| {
                let names: Vec<&str> = program.get_subcommands().map(Command::get_name).collect();
                invalid_input(format!("there is no command `{name}`; the commands are {}", names.join(", ")))
            })?;
            print_line(String::from_utf8_lossy(&troff(named(part))?).trim_end());
        }
        (None, None) => print_line(String::from_utf8_lossy(&troff(program)?).trim_end()),
    }
    Ok(())
}

/// Returns a manual page in the language of `man`.
fn troff(page: Command) -> Result<Vec<u8>, Failure> {
    let mut text = Vec::new();
    clap_mangen::Man::new(page).render(&mut text)?;
    Ok(text)
}
