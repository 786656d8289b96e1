//! Checks a scene after a render whose picture looks wrong.

use super::views;
use crate::open::CompiledInput;
use crate::report;
use crate::terminal::print_error_line;
use codespan_reporting::term::termcolor::StandardStream;
use durer::check::picture::{PictureFault, PictureScan};
use durer::check::{CheckInput, check};
use durer::diag::Diagnostic;
use durer::image::{Display, Layer, Tone};
use durer::math::Color;
use durer::render::{Job, Statistics};
use std::path::Path;

/// Maximum number of findings printed.
const MAX_PRINTED: usize = 3;

/// Returns the scan of the first picture if it is the colour picture.
pub fn scan(job: &Job, pictures: &[Layer], exposure: f32) -> Option<PictureScan> {
    let color = pictures.first().filter(|_| job.color)?;
    let mut scan = PictureScan::new(exposure);
    scan.add(&color.image.pixels);
    Some(scan)
}

/// Reports a visible fault in a picture from `durer render`, together with its likely causes.
pub fn after_render(
    compiled: &CompiledInput,
    job: &Job,
    scan: Option<&PictureScan>,
    pictures: &[Layer],
    statistics: &Statistics,
    display: Display,
) {
    // A tone curve maps values above white back into the displayable range.
    let is_odd = |oddity: &PictureFault| display.tone == Tone::default() || *oddity != PictureFault::White;
    RenderReview { compiled, job, statistics, exposure: display.exposure }.review(scan, pictures, is_odd);
}

/// Reports pictures from `durer course` that are black or have a single colour. No course scene of
/// any year is meant to produce such a picture.
pub fn after_course(compiled: &CompiledInput, job: &Job, pictures: &[Layer], statistics: &Statistics) {
    let is_odd = |oddity: &PictureFault| matches!(oddity, PictureFault::Black | PictureFault::OneColor);
    let scan = scan(job, pictures, 1.0);
    RenderReview { compiled, job, statistics, exposure: 1.0 }.review(scan.as_ref(), pictures, is_odd);
}

/// A finished render and its scene, which is checked if the picture looks wrong.
struct RenderReview<'a> {
    compiled: &'a CompiledInput,
    job: &'a Job,
    statistics: &'a Statistics,
    exposure: f32,
}

impl RenderReview<'_> {
    fn review(&self, scan: Option<&PictureScan>, pictures: &[Layer], is_odd: impl Fn(&PictureFault) -> bool) {
        match scan.and_then(|scan| scan.fault(self.statistics)).filter(is_odd) {
            Some(oddity) => self.report(&format!("the picture {}", oddity.description()), Some(oddity)),
            None => self.depths(pictures),
        }
    }

    /// Warns if a depth picture has no grey pixels although the user set its range.
    fn depths(&self, pictures: &[Layer]) {
        let is_requested = self.job.depth_range.is_some();
        let Some(layer) = pictures.iter().find(|layer| layer.name == "depth").filter(|_| is_requested) else { return };
        let grey = |pixel: &Color| pixel.x > 0.0 && pixel.x < 1.0;
        if !layer.image.pixels.iter().any(grey) {
            self.report("the depth picture has only black and white pixels and no grey ones", None);
        }
    }

    fn report(&self, what: &str, fault: Option<PictureFault>) {
        let rejected = self.statistics.first_rejected.first().map(|first| (first.x, first.y, first.sample));
        let (loaded, files) = (&self.compiled.loaded, &self.compiled.files);
        let (scene, world, dialect) = (&loaded.scene, &self.compiled.world, loaded.dialect);
        let input = CheckInput { scene, world, dialect, files, job: self.job, exposure: self.exposure, rejected };
        let mut found = check(&input, &self.compiled.diagnostics);
        views::offer(&mut found, scene, Path::new(files.name(0).unwrap_or_default()));
        let serious: Vec<_> = found.iter().filter(|f| f.is_serious()).map(|finding| &finding.diagnostic).collect();
        // Skip findings that were already printed before the render.
        let is_known = |diagnostic: &Diagnostic| {
            let same = |known: &Diagnostic| known.code == diagnostic.code && known.message == diagnostic.message;
            self.compiled.diagnostics.iter().any(same)
        };
        let reported: Vec<_> =
            serious.iter().filter(|diagnostic| !is_known(diagnostic)).take(MAX_PRINTED).copied().collect();
        print_error_line(&match (serious.is_empty(), reported.is_empty()) {
            (true, _) if matches!(fault, Some(PictureFault::Dark | PictureFault::White)) => {
                format!("note: {what}; `--exposure auto` chooses another exposure")
            }
            (true, _) => format!("warning: {what}"),
            (false, true) => format!("warning: {what}; the findings above explain why"),
            (false, false) => format!("warning: {what}; `durer check` reports:"),
        });
        report::print_to(StandardStream::stderr(report::colors(&std::io::stderr())), files, &reported);
    }
}
