//! Options for models, which are files that contain objects but no complete scene.

use clap::{Args, ValueEnum};
use durer::options::doc;
use durer::scene::{Axis, DefaultLighting, PresetView, SceneDefaults};
use std::path::PathBuf;

/// Options that turn a model into a scene (glTF, pbrt, Radiance, OBJ, PLY, STL); scene files ignore
/// them
#[derive(Args)]
#[command(next_help_heading = "Models")]
pub struct SceneDefaultsArgs {
    #[arg(long, value_name = "AXIS", value_enum, help = doc("up"))]
    pub up: Option<Up>,
    #[arg(long, value_name = "FROM", value_enum, help = doc("view"))]
    pub view: Option<ViewDirection>,
    #[arg(long, value_name = "LIGHT", value_enum, help = doc("studio"))]
    pub studio: Option<StudioLight>,
    #[arg(long, value_name = "FILE", help = doc("environment"))]
    pub environment: Option<PathBuf>,
    #[arg(
        long,
        value_name = "DEGREES",
        value_parser = degrees,
        allow_negative_numbers = true,
        requires = "environment",
        help = doc("environment-rotation")
    )]
    pub environment_rotation: Option<f32>,
    #[arg(long, help = doc("add-ground"))]
    pub add_ground: bool,
    #[arg(long, value_name = "FILE", conflicts_with = "view", help = doc("view-file"))]
    pub view_file: Option<PathBuf>,
    #[arg(long, value_name = "NAME", help = doc("camera"))]
    pub camera: Option<String>,
    #[arg(long, value_name = "NAME", help = doc("variant"))]
    pub variant: Option<String>,
    #[arg(long, conflicts_with = "view", help = doc("fit"))]
    pub fit: bool,
    #[arg(long, value_name = "DEGREES", value_parser = degrees, allow_negative_numbers = true, help = doc("turned"))]
    pub turned: Option<f32>,
    #[arg(long, value_name = "NAME", help = doc("animation"))]
    pub animation: Option<String>,
    #[arg(long, value_name = "SECONDS", value_parser = seconds, help = doc("at"))]
    pub at: Option<f32>,
}

/// The axis of a model that points up, as given by `--up`.
#[derive(Clone, Copy, ValueEnum)]
pub enum Up {
    X,
    Y,
    Z,
}

/// The view of a model, as given by `--view`.
#[derive(Clone, Copy, ValueEnum)]
pub enum ViewDirection {
    /// From the front, slightly from the right and above, in perspective
    ThreeQuarter,
    /// From the front, without perspective
    Front,
    /// From behind, without perspective
    Back,
    /// From the left, without perspective
    Left,
    /// From the right, without perspective
    #[value(alias = "side")]
    Right,
    /// From above, without perspective
    Top,
    /// From below, without perspective
    Bottom,
    /// Isometric, from the upper right front corner: without perspective, with the same scale along
    /// all three axes
    #[value(alias = "isometric")]
    Iso,
    /// Isometric, from the upper left front corner
    IsoLeft,
    /// Isometric, from the upper right back corner
    IsoBack,
}

/// Lights that are added to a model, as given by `--studio`.
#[derive(Clone, Copy, ValueEnum)]
pub enum StudioLight {
    /// No lights and no ground
    None,
    /// A soft key light, a fill light and a bright ground
    Soft,
    /// A low sun under a blue sky
    Sun,
}

fn seconds(text: &str) -> Result<f32, String> {
    let at = text.parse().ok().filter(|&at: &f64| at.is_finite() && at >= 0.0);
    at.map(|at| at as f32).ok_or("expected seconds, 0 or more".into())
}

fn degrees(text: &str) -> Result<f32, String> {
    let turned = text.parse().ok().filter(|turned: &f64| turned.is_finite());
    turned.map(|turned| turned as f32).ok_or("expected a number of degrees".into())
}

impl SceneDefaultsArgs {
    /// Converts the options to those of the library.
    pub fn scene_defaults(&self) -> SceneDefaults {
        SceneDefaults {
            up: self.up.map(|up| match up {
                Up::X => Axis::X,
                Up::Y => Axis::Y,
                Up::Z => Axis::Z,
            }),
            view: self.view.map(|view| match view {
                ViewDirection::ThreeQuarter => PresetView::ThreeQuarter,
                ViewDirection::Front => PresetView::Front,
                ViewDirection::Back => PresetView::Back,
                ViewDirection::Left => PresetView::Left,
                ViewDirection::Right => PresetView::Right,
                ViewDirection::Top => PresetView::Top,
                ViewDirection::Bottom => PresetView::Bottom,
                ViewDirection::Iso => PresetView::Iso,
                ViewDirection::IsoLeft => PresetView::IsoLeft,
                ViewDirection::IsoBack => PresetView::IsoBack,
            }),
            lighting: self.studio.map(|studio| match studio {
                StudioLight::None => DefaultLighting::None,
                StudioLight::Soft => DefaultLighting::Soft,
                StudioLight::Sun => DefaultLighting::Sun,
            }),
            camera: self.camera.clone(),
            variant: self.variant.clone(),
            animation: self.animation.clone(),
            animation_time: self.at,
            fit: self.fit,
            orbit_degrees: self.turned,
            convert_only: false,
            ground: self.add_ground,
            no_ground: false,
            own_light: false,
            view_file: self.view_file.clone(),
            environment: self.environment.clone(),
            environment_rotation: self.environment_rotation,
            aspect: None,
        }
    }
}
