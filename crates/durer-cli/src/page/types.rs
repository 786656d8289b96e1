//! Data of the HTML reports. `web/src/report/types.ts` is generated from these types.

use durer_session::{DrawnScene, ExplainedSample};
use serde::Serialize;
use std::collections::BTreeMap;
#[cfg(test)]
use ts_rs::TS;

/// Data of a report. Its kind selects what the page shows.
#[derive(Serialize)]
#[cfg_attr(test, derive(TS))]
#[serde(tag = "kind", rename_all = "snake_case")]
pub enum Report {
    /// The colour of a pixel, or the light along a ray.
    Explain(ExplainReport),
    /// Pictures and their references.
    Compare(CompareReport),
    /// A lesson about a scene.
    Lesson(LessonReport),
    /// Photographs and points in 3D.
    Tour(TourReport),
}

/// Report of `durer explain`.
#[derive(Serialize)]
#[cfg_attr(test, derive(TS))]
pub struct ExplainReport {
    /// Name of the scene's file.
    pub file: String,
    /// The explained pixel; `None` for a ray.
    pub pixel: Option<[u32; 2]>,
    /// Name of the transfer curve of eight-bit colours.
    pub transfer: String,
    /// Index of the sample that is shown first.
    pub sample: usize,
    /// Samples of the pixel, or a single one for a ray.
    #[cfg_attr(test, ts(type = "Array<ExplainedSample>"))]
    pub samples: Vec<ExplainedSample>,
    /// Reasons why a sample is far brighter than the others; usually empty.
    pub notes: Vec<String>,
    /// The rendered picture as a data URI; `None` for a ray.
    pub picture: Option<String>,
    /// Width and height of the picture in pixels.
    pub size: [u32; 2],
    /// Line drawing of the scene.
    #[cfg_attr(test, ts(type = "DrawnScene"))]
    pub scene: DrawnScene,
}

/// Report of `durer compare`.
#[derive(Serialize)]
#[cfg_attr(test, derive(TS))]
pub struct CompareReport {
    /// Reference, or folder of references.
    pub reference: String,
    /// Picture, or folder of pictures.
    pub picture: String,
    /// Largest difference per channel that counts as equal.
    pub tolerance: f32,
    /// Percentage of pixels that may exceed the tolerance.
    pub allow: f64,
    /// Pictures without a reference.
    pub extra: Vec<String>,
    /// Number of each student's pictures by verdict; empty if the pictures have no students.
    pub students: Vec<StudentResult>,
    /// The results as comma-separated values, as `--csv` prints them.
    pub csv: String,
    /// Pairs of pictures.
    pub pairs: Vec<PairReport>,
}

/// Number of a student's pictures by verdict.
#[derive(Serialize)]
#[cfg_attr(test, derive(TS))]
pub struct StudentResult {
    /// Name of the student's folder.
    pub name: String,
    /// Pictures that are the same or identical.
    pub same: usize,
    /// Pictures that differ.
    pub different: usize,
    /// Pictures that are missing.
    pub missing: usize,
    /// Pictures that cannot be compared.
    pub error: usize,
}

/// Result of comparing one pair of pictures.
#[derive(Serialize)]
#[cfg_attr(test, derive(TS))]
pub struct PairReport {
    /// Name of the picture after the name of the student.
    pub title: String,
    /// Name of the picture.
    pub name: String,
    /// Name of the student.
    pub student: Option<String>,
    /// `identical`, `same`, `different`, `missing` or `error`.
    pub verdict: String,
    /// Reason why the pictures cannot be compared.
    pub error: Option<String>,
    /// The mistake that explains the difference, in words.
    pub mistake: Option<String>,
    /// Lines that explain the difference.
    pub causes: Vec<String>,
    /// Note about the options of the reference.
    pub note: Option<String>,
    /// Metrics and pictures; `None` if the pictures were not compared.
    pub comparison: Option<ComparisonReport>,
}

/// Metrics and pictures of a pair.
#[derive(Serialize)]
#[cfg_attr(test, derive(TS))]
pub struct ComparisonReport {
    /// Width in pixels.
    pub width: u32,
    /// Height in pixels.
    pub height: u32,
    /// True if linear light was compared, false for display values.
    pub linear: bool,
    /// Root mean square error.
    pub rmse: f64,
    /// Peak signal-to-noise ratio in decibels; `None` if it is infinite.
    pub psnr: Option<f64>,
    /// Structural similarity; `None` if a picture is too small.
    pub ssim: Option<f64>,
    /// Mean FLIP error.
    pub flip: f64,
    /// Mean HDR-FLIP error, for linear light.
    pub hdr_flip: Option<f64>,
    /// Number of pixels over the tolerance.
    pub over_tolerance: usize,
    /// Number of pixels with a value that is not finite, in the reference and in the picture.
    pub not_finite: [usize; 2],
    /// Pixel that differs most.
    pub largest: Option<LargestDifference>,
    /// Regions that differ.
    pub regions: Vec<RegionReport>,
    /// The pictures.
    pub pictures: PairPictures,
}

/// Pixel that differs most.
#[derive(Serialize)]
#[cfg_attr(test, derive(TS))]
pub struct LargestDifference {
    /// Absolute difference in one channel.
    pub difference: f32,
    /// Column.
    pub x: u32,
    /// Row.
    pub y: u32,
    /// Colour in the reference.
    pub reference: [f32; 3],
    /// Colour in the picture.
    pub picture: [f32; 3],
}

/// Region in which the pictures differ.
#[derive(Serialize)]
#[cfg_attr(test, derive(TS))]
pub struct RegionReport {
    /// Leftmost column.
    pub x: u32,
    /// Top row.
    pub y: u32,
    /// Width in pixels.
    pub width: u32,
    /// Height in pixels.
    pub height: u32,
    /// Size, place and difference in words.
    pub text: String,
    /// The hit in the scene there; `None` without a scene.
    pub there: Option<RegionHit>,
}

/// First hit of the ray through the pixel that differs most in a region.
#[derive(Serialize)]
#[cfg_attr(test, derive(TS))]
pub struct RegionHit {
    /// The hit in words.
    pub hit: String,
    /// Command that explains the pixel.
    pub command: String,
    /// Lines that the command prints for this ray.
    pub explanation: Vec<String>,
}

/// The pictures of a pair, as data URIs of PNG files.
#[derive(Clone, Serialize)]
#[cfg_attr(test, derive(TS))]
pub struct PairPictures {
    /// The reference.
    pub reference: String,
    /// The picture.
    pub picture: String,
    /// Heat map of the FLIP error.
    pub heat: String,
}

/// Report of `durer lesson`.
#[derive(Serialize)]
#[cfg_attr(test, derive(TS))]
pub struct LessonReport {
    /// Name of the scene's file.
    pub scene: String,
    /// Steps in order.
    pub steps: Vec<LessonStep>,
    /// Pictures as data URIs, by name.
    pub pictures: BTreeMap<String, String>,
    /// Text of the built-in scene, if a step uses it.
    pub own_scene: Option<String>,
}

/// Step of a lesson.
#[derive(Serialize)]
#[cfg_attr(test, derive(TS))]
pub struct LessonStep {
    /// Title.
    pub title: String,
    /// Reason why the step uses the built-in scene; `None` if it uses the user's scene.
    pub elsewhere: Option<String>,
    /// Explanation; `None` if the step continues the topic of the previous one.
    pub words: Option<String>,
    /// Equations; empty if the step continues a topic.
    pub equations: Vec<String>,
    /// Picture before the step.
    pub before: Option<LessonFigure>,
    /// Picture after the step.
    pub after: LessonFigure,
    /// Name of the picture of the change.
    pub change: Option<String>,
    /// SVG drawing of the rays from above. It contains no text of the scene.
    pub plan: Option<String>,
    /// Effect of the step, in numbers.
    pub facts: String,
    /// Files and symbols in the source code.
    pub places: Vec<[String; 2]>,
}

/// Picture of a lesson with its caption.
#[derive(Serialize)]
#[cfg_attr(test, derive(TS))]
pub struct LessonFigure {
    /// Caption.
    pub caption: String,
    /// Name of the picture.
    pub file: String,
}

/// Report of `durer photo tour`.
#[derive(Serialize)]
#[cfg_attr(test, derive(TS))]
pub struct TourReport {
    /// Photographs with a known camera.
    pub photographs: Vec<TourPhotograph>,
    /// Positions of the points.
    pub points: Vec<[f64; 3]>,
    /// Colours of the points.
    pub colors: Vec<[u8; 3]>,
}

/// Photograph with its camera.
#[derive(Serialize)]
#[cfg_attr(test, derive(TS))]
pub struct TourPhotograph {
    /// File name.
    pub name: String,
    /// The photograph as a data URI.
    pub picture: String,
    /// Width and height in pixels.
    pub size: [u32; 2],
    /// Focal length in pixels.
    pub focal: f64,
    /// Position of the camera.
    pub center: [f64; 3],
    /// Right, down and forward directions of the camera.
    pub rotation: [[f64; 3]; 3],
    /// Corners of the photograph in space: upper left, upper right, lower right, lower left.
    pub corners: [[f64; 3]; 4],
    /// Indices of the points that the photograph shows.
    pub points: Vec<usize>,
}

#[cfg(test)]
mod tests {
    use super::*;
    use std::path::Path;

    #[test]
    fn typescript_types_match() {
        macro_rules! declarations {
            ($($type:ty),+ $(,)?) => { [$(format!("export {}\n", <$type>::decl())),+] };
        }
        let all = declarations![
            Report,
            ExplainReport,
            CompareReport,
            StudentResult,
            PairReport,
            ComparisonReport,
            LargestDifference,
            RegionReport,
            RegionHit,
            PairPictures,
            LessonReport,
            LessonStep,
            LessonFigure,
            TourReport,
            TourPhotograph,
        ];
        let head = "// Written by `DURER_WRITE=1 cargo test -p durer-cli --lib` from crates/durer-cli/src/page/types.rs.\n\n\
                    import type { DrawnScene, ExplainedSample } from \"../protocol\";\n";
        let wanted = format!("{head}\n{}", all.join("\n"));
        let path = Path::new(env!("CARGO_MANIFEST_DIR")).join("../../web/src/report/types.ts");
        if std::env::var_os("DURER_WRITE").is_some() {
            std::fs::write(&path, &wanted).unwrap();
        }
        let there = std::fs::read_to_string(&path).unwrap_or_default();
        assert!(there == wanted, "web/src/report/types.ts is stale: DURER_WRITE=1 cargo test -p durer-cli --lib");
    }
}
