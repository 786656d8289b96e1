//! Implements `durer check`, which finds and fixes mistakes in scenes.

mod args;
mod change;
mod checked_scene;
mod fix;
mod json;
mod render_review;
mod views;

use crate::failure::{Failure, invalid_input};
use crate::file_registry::FileRegistry;
use crate::open::{is_stream, name_of, read_standard_input};
use crate::report::counted;
use crate::terminal::print_line;
use crate::{output, report};
use codespan_reporting::term::termcolor::StandardStream;
use durer::check::{CHECKS, Finding};
use durer::diag::{Edit, Severity};
use durer::format::folder::FolderSource;
use std::path::Path;
use std::sync::Arc;

pub use args::CheckArgs;
use change::Change;
use checked_scene::{CheckedScene, check_text};
pub use render_review::{after_course, after_render, scan};

/// Runs `durer check`. Fails with exit code 1 if there are warnings or errors.
pub fn run(args: &CheckArgs) -> Result<(), Failure> {
    if args.codes {
        let width = CHECKS.iter().map(|check| check.code.len()).max().unwrap_or_default();
        CHECKS.iter().for_each(|check| print_line(&format!("{:width$}  {}", check.code, check.about)));
        return Ok(());
    }
    if args.output.is_some() && args.scenes.len() > 1 {
        return Err(invalid_input(
            "--output can be used with only one scene; without --output, each scene is fixed in place",
        ));
    }
    let mut all = Vec::with_capacity(args.scenes.len());
    let mut unread = false;
    for path in &args.scenes {
        match one(path, args) {
            Ok(checked) => all.push(checked),
            // Check the remaining scenes anyway.
            Err(failure) if args.scenes.len() > 1 => {
                failure.report();
                unread = true;
            }
            Err(failure) => return Err(failure),
        }
    }
    if args.json {
        print_line(&serde_json::to_string_pretty(&json::document(&all))?);
    }
    if unread || all.iter().any(|(checked, _)| !checked.readable) {
        return Err(Failure::Input(None));
    }
    let serious = all.iter().any(|(checked, _)| checked.count(Finding::is_serious) > 0);
    if serious { Err(Failure::FindingsReported) } else { Ok(()) }
}

/// Checks one scene, applies fixes with `--fix`, and prints the findings.
fn one(path: &Path, args: &CheckArgs) -> Result<(CheckedScene, Vec<Change>), Failure> {
    let is_standard_input = is_stream(path);
    let (path, bytes): (&Path, Arc<[u8]>) = match is_standard_input {
        true if args.fix && args.output.is_none() => {
            return Err(invalid_input("--fix cannot change standard input in place: name a file with --output"));
        }
        true => {
            let bytes = read_standard_input(args.reading.memory.limit())?;
            (Path::new(name_of(&bytes)), bytes.into())
        }
        false => {
            let bytes = FolderSource::new(".").allow_outside().read_path(path, &path.display().to_string());
            (path, bytes.map_err(report::unreadable)?)
        }
    };
    let mut checked = check_text(path, bytes.clone(), args)?;
    let mut changes = Vec::new();
    if !args.fix {
        fix::remove_useless_fixes(&mut checked, &bytes, args)?;
    }
    if args.fix {
        let mut registry = FileRegistry::default();
        let place = match &args.output {
            Some(other) => {
                if !is_standard_input {
                    registry.register_input(path)?;
                }
                registry.register_output("--output", other)?
            }
            // Without --output, the scene file itself is replaced.
            None => registry.register_output("--fix", path)?,
        };
        checked.referenced_files.iter().try_for_each(|named| registry.register_input(named))?;
        let (text, fixes) = fix::apply_fixes(&mut checked, bytes.clone(), args)?;
        changes = fixes;
        if !args.json {
            changes.iter().for_each(|change| print_line(&change.line()));
        }
        if args.output.is_some() || text != bytes {
            output::save(&[(&place, text.to_vec())], args.json)?;
        }
    }
    if !args.json {
        print(&checked, args.fix);
    }
    Ok((checked, changes))
}

/// Describes the changes that edits make to the text.
fn does(edits: &[Edit]) -> String {
    let one = |edit: &Edit| match edit.text.trim() {
        "" => "removes the marked text".to_string(),
        text => format!("writes `{}`", text.replace('\n', " ")),
    };
    match edits {
        [only] => one(only),
        [first, rest @ ..] => format!("{}, and makes {}", one(first), counted(rest.len(), "more change")),
        [] => String::new(),
    }
}

/// Prints findings and their counts.
fn print(checked: &CheckedScene, fixed: bool) {
    let offer = |finding: &Finding| {
        let mut diagnostic = finding.diagnostic.clone();
        if !diagnostic.fix.is_empty() && !fixed {
            let does = does(&diagnostic.fix);
            let help = diagnostic.help.get_or_insert_default();
            *help += &if help.is_empty() { format!("`--fix` {does}") } else { format!(" (`--fix` {does})") };
        }
        diagnostic
    };
    let shown: Vec<_> = checked.findings.iter().map(offer).collect();
    report::print_to(
        StandardStream::stdout(report::colors(&std::io::stdout())),
        &checked.files,
        &shown.iter().collect::<Vec<_>>(),
    );
    let kinds = [(Severity::Error, "error"), (Severity::Warning, "warning"), (Severity::Note, "note")];
    let counts = kinds.iter().filter_map(|(severity, word)| {
        let count = checked.count(|finding| finding.diagnostic.severity == *severity);
        (count > 0).then(|| counted(count, word))
    });
    let counts = counts.collect::<Vec<_>>().join(", ");
    let found = match (counts.is_empty(), fixed) {
        (true, false) => "no findings".to_string(),
        (true, true) => "no findings left".to_string(),
        (false, true) => format!("{counts} left"),
        (false, false) => counts,
    };
    print_line(&format!("{}: {found}", checked.path.display()));
}
