//! A scene, and what was found in it.

use super::args::CheckArgs;
use crate::failure::Failure;
use crate::job::job;
use crate::open::load_options;
use crate::options::{accel, aspect};
use durer::check::{Finding, Subject, check, reported};
use durer::diag::{Diagnostics, Files};
use durer::load_text;
use std::path::{Path, PathBuf};
use std::sync::Arc;

/// A scene and what was found.
pub struct Checked {
    pub path: PathBuf,
    pub files: Files,
    pub findings: Vec<Finding>,
    /// Its dialect, where it could be read.
    pub dialect: Option<&'static str>,
    /// Whether a picture can be made of it.
    pub readable: bool,
    /// The files that it names.
    pub named: Vec<PathBuf>,
}

impl Checked {
    pub fn count(&self, wanted: impl Fn(&Finding) -> bool) -> usize {
        self.findings.iter().filter(|finding| wanted(finding)).count()
    }
}

/// Reads and checks a text that is, or is to be, in a file.
pub fn look(path: &Path, bytes: Arc<[u8]>, args: &CheckArgs) -> Result<Checked, Failure> {
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
            let exposure = args.exposure.factor()?;
            let (scene, dialect, files) = (&loaded.scene, loaded.dialect, &files);
            check(&Subject { scene, world, dialect, files, job: &job, exposure, rejected: None }, &diagnostics)
        }
        _ => reported(&diagnostics),
    };
    let named = loaded.map(|loaded| loaded.files()).unwrap_or_default();
    Ok(Checked { path: path.into(), files, findings, dialect, readable, named })
}
