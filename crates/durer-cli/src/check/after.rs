//! After a render whose result looks wrong: why that may be.

use crate::open::Opened;
use crate::report;
use codespan_reporting::term::termcolor::StandardStream;
use durer::check::picture::{Oddity, oddity};
use durer::check::{Subject, check};
use durer::image::Layer;
use durer::math::Color;
use durer::render::{Job, Statistics};

/// At most so many findings are told.
const MOST: usize = 3;

/// After `durer render`: whatever looks wrong is told of.
pub fn after_render(opened: &Opened, job: &Job, pictures: &[Layer], statistics: &Statistics) {
    after(opened, job, pictures, statistics, |_| true);
}

/// After `durer course`: pictures of one colour alone, for those are not meant in any year.
pub fn after_course(opened: &Opened, job: &Job, pictures: &[Layer], statistics: &Statistics) {
    after(opened, job, pictures, statistics, |oddity| matches!(oddity, Oddity::Black | Oddity::OneColor));
}

fn after(opened: &Opened, job: &Job, pictures: &[Layer], statistics: &Statistics, is_odd: impl Fn(&Oddity) -> bool) {
    let color = pictures.first().filter(|_| job.color);
    match color.and_then(|layer| oddity(&layer.image, statistics)).filter(is_odd) {
        Some(oddity) => tell(opened, job, statistics, &format!("the picture {}", oddity.words())),
        None => depths(opened, job, pictures, statistics),
    }
}

/// A picture of depths without any grey, where its range was asked for.
fn depths(opened: &Opened, job: &Job, pictures: &[Layer], statistics: &Statistics) {
    let Some(layer) = pictures.iter().find(|layer| layer.name == "depth").filter(|_| job.depth_range.is_some()) else {
        return;
    };
    let grey = |pixel: &Color| pixel.x > 0.0 && pixel.x < 1.0;
    if !layer.image.pixels.iter().any(grey) {
        tell(opened, job, statistics, "the picture of depths is black and white");
    }
}

fn tell(opened: &Opened, job: &Job, statistics: &Statistics, what: &str) {
    let rejected = statistics.first_rejected.first().map(|first| (first.x, first.y, first.sample));
    let (loaded, files) = (&opened.loaded, &opened.files);
    let (scene, world, dialect) = (&loaded.scene, &opened.world, loaded.dialect);
    let subject = Subject { scene, world, dialect, files, job, exposure: 1.0, rejected };
    let found = check(&subject, &opened.diagnostics);
    let told: Vec<_> = found.iter().filter(|f| f.is_serious()).take(MOST).map(|finding| &finding.diagnostic).collect();
    report::complain(&match told.is_empty() {
        true => format!("warning: {what}"),
        false => format!("warning: {what}; `durer check` says:"),
    });
    report::print_to(StandardStream::stderr(report::colors(&std::io::stderr())), files, &told);
}
