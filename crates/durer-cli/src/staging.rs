//! Options about models: files that hold things and no whole scene.

use clap::{Args, ValueEnum};
use durer::scene::{Axis, Staging, Studio, View};
use std::path::PathBuf;

/// How a model (glTF, pbrt, Radiance, OBJ, PLY, STL) becomes a scene; nothing of it concerns files
/// that are scenes
#[derive(Args)]
#[command(next_help_heading = "Models")]
pub struct StagingArgs {
    /// What is up in a model [default: y; z for Radiance and STL]
    #[arg(long, value_name = "AXIS", value_enum)]
    pub up: Option<Up>,
    /// Whence a model is seen that has no camera, or instead of by its own [default: three-quarter]
    #[arg(long, value_name = "FROM", value_enum)]
    pub view: Option<From>,
    /// Light for a model that has none, or instead of its own [default: soft]
    #[arg(long, value_name = "LIGHT", value_enum)]
    pub studio: Option<Light>,
    /// A picture of all directions (.hdr, .exr) that lights the model, instead of its own sky or of
    /// a studio
    #[arg(long, value_name = "FILE")]
    pub environment: Option<PathBuf>,
    /// A file of Radiance's views (.vf), whose last is the camera
    #[arg(long, value_name = "FILE", conflicts_with = "view")]
    pub view_file: Option<PathBuf>,
    /// Name or number of the model's camera that is wanted [default: the first]
    #[arg(long, value_name = "NAME")]
    pub camera: Option<String>,
    /// Name or number of the look that is wanted of a glTF file with several [default: its own
    /// materials]
    #[arg(long, value_name = "NAME")]
    pub variant: Option<String>,
    /// Move the model's own camera to where it sees all of it, in the direction in which it looks
    #[arg(long, conflicts_with = "view")]
    pub fit: bool,
    /// Degrees by which whence the model is seen lies further around it
    #[arg(long, value_name = "DEGREES", value_parser = degrees, allow_negative_numbers = true)]
    pub turned: Option<f32>,
    /// Moment of the model's animation, in seconds [default: as it stands without]
    #[arg(long, value_name = "SECONDS", value_parser = seconds)]
    pub at: Option<f32>,
}

#[derive(Clone, Copy, ValueEnum)]
pub enum Up {
    X,
    Y,
    Z,
}

#[derive(Clone, Copy, ValueEnum)]
pub enum From {
    /// From the front, a little from the right and from above, in perspective
    ThreeQuarter,
    /// From the front, without perspective
    Front,
    /// From the right, without perspective
    Side,
    /// From above, without perspective
    Top,
    /// Without perspective, all three axes alike
    Iso,
}

#[derive(Clone, Copy, ValueEnum)]
pub enum Light {
    /// No light and no ground
    None,
    /// A soft key light, a fill, a light ground
    Soft,
    /// A low sun under a blue sky
    Sun,
}

fn seconds(text: &str) -> Result<f32, String> {
    let at = text.parse().ok().filter(|&at: &f64| at.is_finite() && at >= 0.0);
    at.map(|at| at as f32).ok_or("expected a number of seconds, 0 or more".into())
}

fn degrees(text: &str) -> Result<f32, String> {
    let turned = text.parse().ok().filter(|turned: &f64| turned.is_finite());
    turned.map(|turned| turned as f32).ok_or("expected a number of degrees".into())
}

impl StagingArgs {
    /// What they say, for a picture of some width and height.
    pub fn staging(&self) -> Staging {
        Staging {
            up: self.up.map(|up| match up {
                Up::X => Axis::X,
                Up::Y => Axis::Y,
                Up::Z => Axis::Z,
            }),
            view: self.view.map(|view| match view {
                From::ThreeQuarter => View::ThreeQuarter,
                From::Front => View::Front,
                From::Side => View::Side,
                From::Top => View::Top,
                From::Iso => View::Iso,
            }),
            studio: self.studio.map(|studio| match studio {
                Light::None => Studio::None,
                Light::Soft => Studio::Soft,
                Light::Sun => Studio::Sun,
            }),
            camera: self.camera.clone(),
            variant: self.variant.clone(),
            at: self.at,
            fit: self.fit,
            turned: self.turned,
            bare: false,
            own_light: false,
            view_file: self.view_file.clone(),
            environment: self.environment.clone(),
            aspect: None,
        }
    }
}
