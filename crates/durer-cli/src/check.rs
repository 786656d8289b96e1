//! `durer check`.

mod after;
mod json;
mod mend;

use crate::args::CheckArgs;
use crate::display::factor;
use crate::guard::Guard;
use crate::job::{accel, aspect, job};
use crate::open::load_options;
use crate::output::say;
use crate::report::counted;
use crate::{Failure, bad, output, report};
use codespan_reporting::term::termcolor::StandardStream;
use durer::check::{CHECKS, Finding, Subject, check, reported};
use durer::diag::{Diagnostics, Edit, Files, Severity};
use durer::load_text;
use durer::source::Source;
use std::path::{Path, PathBuf};
use std::sync::Arc;

pub use after::{after_course, after_render};
pub use json::finding;

/// A scene and what was found.
struct Checked {
    path: PathBuf,
    files: Files,
    findings: Vec<Finding>,
    /// Its dialect, where it could be read.
    dialect: Option<&'static str>,
    /// Whether a picture can be made of it.
    readable: bool,
    /// The files that it names.
    named: Vec<PathBuf>,
}

impl Checked {
    fn count(&self, wanted: impl Fn(&Finding) -> bool) -> usize {
        self.findings.iter().filter(|finding| wanted(finding)).count()
    }
}

pub fn run(args: &CheckArgs) -> Result<(), Failure> {
    if args.codes {
        let width = CHECKS.iter().map(|check| check.code.len()).max().unwrap_or_default();
        CHECKS.iter().for_each(|check| say(&format!("{:width$}  {}", check.code, check.about)));
        return Ok(());
    }
    if args.output.is_some() && args.scenes.len() > 1 {
        return Err(bad("--output is for one scene; without it each is mended in place"));
    }
    let mut all = Vec::with_capacity(args.scenes.len());
    let mut unread = false;
    for path in &args.scenes {
        match one(path, args) {
            Ok(checked) => all.push(checked),
            // The others are checked all the same.
            Err(failure) if args.scenes.len() > 1 => {
                failure.report();
                unread = true;
            }
            Err(failure) => return Err(failure),
        }
    }
    if args.json {
        say(&serde_json::to_string_pretty(&json::document(&all))?);
    }
    if unread || all.iter().any(|(checked, _)| !checked.readable) {
        return Err(Failure::Input(None));
    }
    let serious = all.iter().any(|(checked, _)| checked.count(Finding::is_serious) > 0);
    if serious { Err(Failure::Found) } else { Ok(()) }
}

/// Checks one scene, mends it where that is wanted, and says what was found.
fn one(path: &Path, args: &CheckArgs) -> Result<(Checked, Vec<mend::Change>), Failure> {
    let bytes = Source::folder(".").allow_outside().read_path(path, &path.display().to_string());
    let bytes = bytes.map_err(report::unreadable)?;
    let mut checked = look(path, bytes.clone(), args)?;
    let mut changes = Vec::new();
    if !args.fix {
        mend::withdraw(&mut checked, &bytes, args)?;
    }
    if args.fix {
        let mut guard = Guard::default();
        let place = match &args.output {
            Some(other) => {
                guard.reads(path)?;
                guard.writes("--output", other)?
            }
            // That the scene is replaced is what was asked for.
            None => guard.writes("--fix", path)?,
        };
        checked.named.iter().try_for_each(|named| guard.reads(named))?;
        let (text, made) = mend::mend(&mut checked, bytes.clone(), args)?;
        changes = made;
        if !args.json {
            changes.iter().for_each(|change| say(&change.line()));
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

/// Reads and checks a text that is, or is to be, in a file.
fn look(path: &Path, bytes: Arc<[u8]>, args: &CheckArgs) -> Result<Checked, Failure> {
    let (mut files, mut diagnostics) = (Files::default(), Diagnostics::default());
    let mut options = load_options(&args.reading);
    options.accel = accel(&args.job)?;
    options.staging.aspect = aspect(&args.job);
    let loaded = load_text(path, bytes, &options, &mut files, &mut diagnostics);
    let dialect = loaded.as_ref().map(|loaded| loaded.dialect.name());
    let world = loaded.as_ref().and_then(|loaded| loaded.compile(&options, &mut files, &mut diagnostics));
    let readable = world.is_some();
    let findings = match (&loaded, &world) {
        (Some(loaded), Some(world)) => {
            let job = job(&args.job, Some(&args.view), loaded, false)?;
            let exposure = factor(args.exposure)?;
            let (scene, dialect, files) = (&loaded.scene, loaded.dialect, &files);
            check(&Subject { scene, world, dialect, files, job: &job, exposure, rejected: None }, &diagnostics)
        }
        _ => reported(&diagnostics),
    };
    let named = loaded.map(|loaded| loaded.files()).unwrap_or_default();
    Ok(Checked { path: path.into(), files, findings, dialect, readable, named })
}

/// What edits do to the text.
fn does(edits: &[Edit]) -> String {
    let one = |edit: &Edit| match edit.text.trim() {
        "" => "takes it out".to_string(),
        text => format!("writes `{}`", text.replace('\n', " ")),
    };
    match edits {
        [only] => one(only),
        [first, rest @ ..] => format!("{}, and makes {}", one(first), counted(rest.len(), "change") + " more"),
        [] => String::new(),
    }
}

/// Prints findings, and how many there are.
fn print(checked: &Checked, mended: bool) {
    let offer = |finding: &Finding| {
        let mut diagnostic = finding.diagnostic.clone();
        if !diagnostic.fix.is_empty() && !mended {
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
    let found = match (counts.is_empty(), mended) {
        (true, false) => "nothing found".to_string(),
        (true, true) => "nothing is left".to_string(),
        (false, true) => format!("{counts} left"),
        (false, false) => counts,
    };
    say(&format!("{}: {found}", checked.path.display()));
}
