//! Reads a scene and checks it.

use super::args::CheckArgs;
use super::views;
use crate::failure::Failure;
use crate::job::job;
use crate::open::load_options;
use crate::options::accel;
use durer::check::{CheckInput, Finding, check, reader_findings};
use durer::diag::{Diagnostics, Files};
use durer::load_text;
use std::path::{Path, PathBuf};
use std::sync::Arc;

/// A scene file after `durer check`: the files it uses, its findings, and whether it can be
/// rendered.
pub struct CheckedScene {
    pub path: PathBuf,
    pub files: Files,
    pub findings: Vec<Finding>,
    /// Dialect of the scene, or `None` if the scene could not be read.
    pub dialect: Option<&'static str>,
    /// True if the scene can be rendered.
    pub readable: bool,
    /// Files that the scene refers to.
    pub referenced_files: Vec<PathBuf>,
}

impl CheckedScene {
    /// Returns the number of findings for which `wanted` returns true.
    pub fn count(&self, wanted: impl Fn(&Finding) -> bool) -> usize {
        self.findings.iter().filter(|finding| wanted(finding)).count()
    }
}

/// Reads and checks the text of a scene file. The text does not have to be saved yet.
pub fn check_text(path: &Path, bytes: Arc<[u8]>, args: &CheckArgs) -> Result<CheckedScene, Failure> {
    let (mut files, mut diagnostics) = (Files::default(), Diagnostics::default());
    let mut options = load_options(&args.reading);
    options.accel = accel(&args.job)?;
    args.job.options.adapt(&mut options.scene_defaults);
    let loaded = load_text(path, bytes, &options, &mut files, &mut diagnostics);
    let dialect = loaded.as_ref().map(|loaded| loaded.dialect.name());
    let world = loaded.as_ref().and_then(|loaded| loaded.compile(&options, &mut files, &mut diagnostics));
    let readable = world.is_some();
    let findings = match (&loaded, &world) {
        (Some(loaded), Some(world)) => {
            let job = job(&args.job, Some(&args.view), loaded, false)?;
            let exposure = args.exposure.factor(None);
            let (scene, dialect, files) = (&loaded.scene, loaded.dialect, &files);
            let input = CheckInput { scene, world, dialect, files, job: &job, exposure, rejected: None };
            let mut findings = check(&input, &diagnostics);
            views::offer(&mut findings, scene, path);
            findings
        }
        _ => reader_findings(&diagnostics),
    };
    let referenced_files = loaded.map(|loaded| loaded.files()).unwrap_or_default();
    Ok(CheckedScene { path: path.into(), files, findings, dialect, readable, referenced_files })
}
