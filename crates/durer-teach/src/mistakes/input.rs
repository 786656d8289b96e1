//! Input and result of the search for mistakes.

use super::pictures::View;
use super::table::{Formulas, Mistake};
use super::variant::SceneVariant;
use durer_image::Transfer;
use durer_image::compare::{Picture, Scale};
use durer_render::render::Job;
use durer_render::world::World;
use durer_scene::math::Vec3;
use durer_scene::scene::Scene;

/// Maximum fraction of pixels in which a render of the scene may differ from the reference. If the
/// fraction is larger, no mistakes are searched for.
pub(super) const MAX_DIFFERENCE: f64 = 0.25;

/// Input of a search for mistakes: the reference picture, the picture to diagnose, and the scene
/// that both show.
#[derive(Clone, Copy, Debug)]
pub struct DiagnosisInput<'a> {
    /// The parsed scene.
    pub scene: &'a Scene,
    /// The scene, compiled with the rules of the dialect that the reference uses.
    pub world: &'a World,
    /// Options with which the reference was rendered, without a crop.
    pub job: &'a Job,
    /// Transfer curve of the eight-bit pictures.
    pub transfer: Transfer,
    /// The correct picture.
    pub reference: &'a Picture,
    /// The picture to diagnose.
    pub test: &'a Picture,
}

/// One or two mistakes that together explain a picture, and how well they do so.
#[derive(Clone, Debug)]
pub struct Explanation {
    /// The mistakes, each with its value.
    pub mistakes: Vec<(&'static Mistake, f32)>,
    /// Fraction of the squared difference that the mistakes explain, ignoring rounding.
    pub explained: f64,
    /// Fraction of the differing pixels that the mistakes reproduce.
    pub matched: f64,
}

/// Result of a search for the mistakes in a picture.
#[derive(Clone, Debug, Default)]
pub struct Diagnosis {
    /// Fraction of the pixels in which a render of the scene differs from the reference.
    pub reference_difference: f64,
    /// Explanations of the picture. There is more than one if several mistakes produce the same
    /// picture, and the list is empty if there is none.
    pub explanations: Vec<Explanation>,
    /// A mistake that reproduces nearly all of the difference, if there is also another difference
    /// in the picture. It is `None` if `explanations` is not empty.
    pub nearly: Option<Explanation>,
    /// Remark about the pictures if no mistake is named.
    pub remark: Option<String>,
    /// The trials that fit best, including those that do not count as explanations.
    pub closest_trials: Vec<Explanation>,
    /// Formulas of the scene, which are used to describe the mistakes.
    pub formulas: Formulas,
}

impl Diagnosis {
    /// Returns true if a render of the scene reproduces the reference.
    pub fn reference_matches_scene(&self) -> bool {
        self.reference_difference <= MAX_DIFFERENCE
    }
}

/// Returns the pixels of a picture in the given scale.
pub(super) fn values(picture: &Picture, scale: Scale, transfer: Transfer) -> Vec<Vec3> {
    let pixels = picture.image.pixels.iter();
    match picture.scale == scale {
        true => pixels.map(|v| if v.is_finite() { *v } else { Vec3::ZERO }).collect(),
        false => pixels.map(|light| Vec3::from(transfer.encode_pixel(*light).map(f32::from)) / 255.0).collect(),
    }
}

/// Returns the values of the reference, the view for rendering, and the scene without mistakes.
pub(super) fn prepare<'a>(input: &DiagnosisInput<'a>) -> (Vec<Vec3>, View<'a>, SceneVariant<'a>) {
    let screen = [input.reference, input.test].iter().any(|picture| picture.scale == Scale::Display);
    let scale = if screen { Scale::Display } else { Scale::Linear };
    let base = SceneVariant::new(input.scene, input.world.clone(), input.job.settings);
    let view = View { job: input.job, scale, transfer: input.transfer, max_value: 1.0 };
    (values(input.reference, scale, input.transfer), view, base)
}
