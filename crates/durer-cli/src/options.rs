//! Options shared by several commands.

mod given;
mod integrator;
mod job;

use crate::denoise::Denoiser;
use crate::device::DeviceChoice;
use crate::display::DisplayArgs;
use crate::scene_defaults::SceneDefaultsArgs;
use crate::terminal_picture::Graphics;
use clap::Args;
use clap::builder::PossibleValuesParser;
use durer::CameraPlacement;
use durer::dialect::{Dialect, Quirk};
use durer::film::aov::AOVS;
use durer::math::Vec3;
use durer::options::memory::Memory;
use durer::options::{compat, crop, doc, vector};
use durer::render::Shard;
use std::path::{Path, PathBuf};
use std::time::Duration;

pub use given::{GivenOptions, name_of};
pub use integrator::IntegratorArgs;
pub use job::{JobArgs, accel};

/// Options for reading a scene
#[derive(Args)]
pub struct SceneArgs {
    #[arg(long, value_parser = PossibleValuesParser::new(Dialect::ALL.map(Dialect::name)), help = doc("dialect"))]
    pub dialect: Option<String>,
    #[arg(long, value_name = "NAME", value_delimiter = ',', value_parser = compat, help = doc("compat"))]
    pub compat: Vec<(Quirk, bool)>,
    #[arg(long, help = doc("strict"))]
    pub strict: bool,
    #[arg(long, help = doc("allow-outside"))]
    pub allow_outside: bool,
    #[arg(long, value_name = "FOLDER", help = doc("assets"))]
    pub assets: Vec<PathBuf>,
    #[arg(long, default_value = "80%", hide_default_value = true, value_name = "SIZE", value_parser = Memory::parse, help = doc("memory"))]
    pub memory: Memory,
    #[command(flatten)]
    pub placement: PlacementArgs,
    #[command(flatten)]
    pub scene_defaults: SceneDefaultsArgs,
}

/// Options that place the camera in any scene
#[derive(Args)]
#[command(next_help_heading = "Camera")]
pub struct PlacementArgs {
    #[arg(long, value_name = "X,Y,Z", value_parser = vector, allow_hyphen_values = true, help = doc("eye"))]
    pub eye: Option<Vec3>,
    #[arg(long, value_name = "X,Y,Z", value_parser = vector, allow_hyphen_values = true, help = doc("target"))]
    pub target: Option<Vec3>,
    #[arg(long, value_name = "DEGREES", value_parser = fov, help = doc("fov"))]
    pub fov: Option<f32>,
}

fn fov(text: &str) -> Result<f32, String> {
    let fov = text.parse().ok().filter(|fov| (f32::MIN_POSITIVE..180.0).contains(fov));
    fov.ok_or_else(|| "expected degrees, more than 0 and less than 180".into())
}

impl PlacementArgs {
    /// Converts the options to those of the library.
    pub fn placement(&self) -> CameraPlacement {
        CameraPlacement { eye: self.eye, target: self.target, fov: self.fov }
    }
}

/// Options for rendering a picture
#[derive(Args)]
pub struct RenderArgs {
    /// Scene or model file
    pub scene: PathBuf,
    /// Picture to write, or the part file with --shard [default: the scene's name with .png, in the
    /// current folder]
    #[arg(short, long, value_name = "PICTURE")]
    pub output: Option<PathBuf>,
    #[command(flatten)]
    pub reading: SceneArgs,
    #[command(flatten)]
    pub view: ViewArgs,
    #[command(flatten)]
    pub job: JobArgs,
    #[command(flatten)]
    pub work: WorkArgs,
    #[command(flatten)]
    pub display: DisplayArgs,
    /// Denoise the colour picture with oidn (Open Image Denoise), own (built in), or auto (oidn if
    /// found, else own). EXR files keep the noisy picture and add a `denoised` layer; --hash
    /// ignores denoising
    #[arg(long, value_name = "BY", num_args = 0..=1, require_equals = true, default_missing_value = "auto", value_parser = Denoiser::parser())]
    pub denoise: Option<Denoiser>,
    /// Render again whenever the scene or one of its files is saved; the picture is updated while
    /// it renders. Press Ctrl-C to stop
    #[arg(long, conflicts_with_all = ["pixel", "shard", "checkpoint", "resume", "restart", "preview"])]
    pub watch: bool,
    /// Print the film's hash as the last line of standard output
    #[arg(long)]
    pub hash: bool,
    /// Print timings, ray counts and the fraction of time spent in ray traversal to standard error,
    /// or write them to FILE as JSON
    #[arg(long, value_name = "FILE.json", num_args = 0..=1, require_equals = true, default_missing_value = "-")]
    pub stats: Option<PathBuf>,
    /// Print only errors
    #[arg(short, long)]
    pub quiet: bool,
}

impl RenderArgs {
    /// Returns the file for the statistics, unless they are printed.
    pub fn stats_file(&self) -> Option<&Path> {
        self.stats.as_deref().filter(|path| *path != Path::new("-"))
    }
}

/// Options of the pictures to write
#[derive(Args)]
pub struct ViewArgs {
    #[arg(long, value_name = "LEFT,TOP,WIDTHxHEIGHT", value_parser = crop, help = doc("crop"))]
    pub crop: Option<(u32, u32, u32, u32)>,
    /// Comma-separated list of pictures to write; `error`, for path and photons only, bounds the
    /// luminance error (noise plus photon bias) at 90 % confidence
    #[arg(long, value_delimiter = ',', default_value = "color", value_parser = PossibleValuesParser::new(shows()))]
    pub show: Vec<String>,
    /// Magnification of the `samples` and `filter` pictures, in output pixels per rendered pixel
    /// [default: 20]
    #[arg(long, value_parser = clap::value_parser!(u32).range(1..=1000))]
    pub zoom: Option<u32>,
}

impl ViewArgs {
    /// Returns the magnification of diagrams.
    pub fn zoom(&self) -> u32 {
        self.zoom.unwrap_or(20)
    }
}

/// Options for threads, time and saved work
#[derive(Args)]
pub struct WorkArgs {
    /// Processor that computes the colours: cpu, gpu, or auto (gpu if it can render the scene, else
    /// cpu). Parts from different devices do not merge; see docs/gpu.md
    #[arg(
        long,
        value_name = "DEVICE",
        default_value = "cpu",
        hide_default_value = true,
        hide_possible_values = true,
        value_enum
    )]
    pub device: DeviceChoice,
    #[arg(long, value_parser = clap::value_parser!(u16).range(1..=1024), help = doc("threads"))]
    pub threads: Option<u16>,
    #[arg(long, value_name = "PIXELS", value_parser = clap::value_parser!(u32).range(8..=4096), help = doc("tile"))]
    pub tile: Option<u32>,
    #[arg(id = "time-limit", long = "time-limit", alias = "time", value_name = "TIME", value_parser = duration, help = doc("time-limit"))]
    pub time: Option<Duration>,
    /// Continue saved work; start from the beginning if there is none
    #[arg(long)]
    pub resume: bool,
    /// Discard unfinished saved work and start again
    #[arg(long, conflicts_with_all = ["resume", "no_checkpoint"])]
    pub restart: bool,
    /// Checkpoint file, from which --resume continues [default: PICTURE.part]
    #[arg(long, value_name = "FILE", conflicts_with = "shard")]
    pub checkpoint: Option<PathBuf>,
    /// Time between saves of unfinished work
    #[arg(long, default_value = "30s", value_name = "TIME", value_parser = duration)]
    pub checkpoint_every: Duration,
    /// Do not save unfinished work
    #[arg(long, conflicts_with_all = ["checkpoint", "resume", "shard"])]
    pub no_checkpoint: bool,
    /// After each pass over all pixels, also write the unfinished picture to this file
    #[arg(long, value_name = "PICTURE", conflicts_with = "shard")]
    pub preview: Option<PathBuf>,
    /// Draw the picture in the terminal and refine it after each pass. GRAPHICS is kitty, iterm,
    /// sixel, or blocks; by default, the best that the terminal supports
    #[arg(
        long,
        value_name = "GRAPHICS",
        value_enum,
        num_args = 0..=1,
        require_equals = true,
        default_missing_value = "auto",
        hide_possible_values = true,
        conflicts_with_all = ["shard", "pixel"]
    )]
    pub terminal: Option<Graphics>,
    #[arg(long, value_name = "INDEX/COUNT", requires = "output", help = doc("shard"))]
    pub shard: Option<Shard>,
    #[arg(long, value_name = "WHAT", default_value = "tiles", hide_default_value = true, value_parser = ["tiles", "samples"], requires = "shard", help = doc("shard-by"))]
    pub shard_by: String,
}

/// Parses a time with its unit.
fn duration(text: &str) -> Result<Duration, String> {
    humantime::parse_duration(text).map_err(|_| "expected a time with its unit, for example 30s, 10m or 1h30m".into())
}

/// Names of pictures that show how the scene is sampled rather than the scene itself.
pub const DIAGRAMS: [&str; 2] = ["samples", "filter"];

/// Name of the picture of error bounds, which is computed in addition to the rendered picture.
pub const ERROR: &str = "error";

fn shows() -> Vec<&'static str> {
    std::iter::once("color").chain(AOVS.iter().map(|aov| aov.name)).chain([ERROR]).chain(DIAGRAMS).collect()
}
