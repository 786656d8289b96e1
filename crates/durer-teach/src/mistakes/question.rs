//! Input and result of a diagnosis.

use super::pictures::View;
use super::table::{Formulas, Mistake};
use super::variant::SceneVariant;
use durer_image::Transfer;
use durer_image::compare::{Picture, Scale};
use durer_render::render::Job;
use durer_render::world::World;
use durer_scene::math::Vec3;
use durer_scene::scene::Scene;

/// Share of pixels in which the scene's own picture may differ from the reference; above it,
/// nothing is reported.
pub(super) const MAX_OFF: f64 = 0.25;

/// Two pictures, and the scene of the reference.
#[derive(Clone, Copy, Debug)]
pub struct DiagnosisInput<'a> {
    /// The scene as written.
    pub scene: &'a Scene,
    /// The scene compiled with the rules of the reference.
    pub world: &'a World,
    /// The job of the reference: the pictures' size, without a crop.
    pub job: &'a Job,
    /// Transfer curve of the eight-bit pictures.
    pub transfer: Transfer,
    /// The correct picture.
    pub reference: &'a Picture,
    /// The picture to diagnose.
    pub test: &'a Picture,
}

/// Mistakes that together explain a picture.
#[derive(Clone, Debug)]
pub struct Explanation {
    /// The mistakes, each with its value.
    pub mistakes: Vec<(&'static Mistake, f32)>,
    /// Share of the squared difference that they explain, without rounding.
    pub explained: f64,
    /// Share of the differing pixels that they reproduce.
    pub matched: f64,
}

/// Result of a diagnosis.
#[derive(Clone, Debug, Default)]
pub struct Diagnosis {
    /// Share of the pixels in which the scene's own picture differs from the reference.
    pub off: f64,
    /// Explanations of the picture, more than one if several give the same picture; empty if none
    /// does.
    pub named: Vec<Explanation>,
    /// A mistake that reproduces nearly all of the difference, but the picture has another
    /// difference too. `None` if `named` is not empty.
    pub nearly: Option<Explanation>,
    /// Remark if no mistake is named.
    pub remark: Option<String>,
    /// The closest trials, including those that do not explain the picture.
    pub tried: Vec<Explanation>,
    /// Formulas for describing the mistakes.
    pub formulas: Formulas,
}

impl Diagnosis {
    /// Returns true if the scene and the options reproduce the reference.
    pub fn is_of_scene(&self) -> bool {
        self.off <= MAX_OFF
    }
}

/// Converts a picture's values to a scale.
pub(super) fn values(picture: &Picture, scale: Scale, transfer: Transfer) -> Vec<Vec3> {
    let pixels = picture.image.pixels.iter();
    match picture.scale == scale {
        true => pixels.map(|v| if v.is_finite() { *v } else { Vec3::ZERO }).collect(),
        false => pixels.map(|light| Vec3::from(transfer.encode_pixel(*light).map(f32::from)) / 255.0).collect(),
    }
}

/// Returns the reference's values, the view, and the scene without mistakes.
pub(super) fn prepared<'a>(question: &DiagnosisInput<'a>) -> (Vec<Vec3>, View<'a>, SceneVariant<'a>) {
    let screen = [question.reference, question.test].iter().any(|picture| picture.scale == Scale::Display);
    let scale = if screen { Scale::Display } else { Scale::Linear };
    let base = SceneVariant::new(question.scene, question.world.clone(), question.job.settings);
    let view = View { job: question.job, scale, transfer: question.transfer, brightest: 1.0 };
    (values(question.reference, scale, question.transfer), view, base)
}
