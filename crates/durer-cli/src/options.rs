//! Options that several commands have.

mod job;
mod method;

use crate::denoise::Denoiser;
use crate::display::DisplayArgs;
use crate::staging::StagingArgs;
use clap::Args;
use clap::builder::PossibleValuesParser;
use durer::dialect::{Compat, Dialect};
use durer::film::aov::AOVS;
use durer::options::memory::Memory;
use durer::options::{compat, crop, doc};
use durer::render::Shard;
use std::path::PathBuf;
use std::time::Duration;

pub use job::{JobArgs, accel, aspect};
pub use method::MethodArgs;

/// How a scene is read
#[derive(Args)]
pub struct SceneArgs {
    #[arg(long, value_parser = PossibleValuesParser::new(Dialect::ALL.map(Dialect::name)), help = doc("dialect"))]
    pub dialect: Option<String>,
    #[arg(long, value_name = "NAME", value_delimiter = ',', value_parser = compat, help = doc("compat"))]
    pub compat: Vec<(Compat, bool)>,
    #[arg(long, help = doc("strict"))]
    pub strict: bool,
    #[arg(long, help = doc("allow-outside"))]
    pub allow_outside: bool,
    #[arg(long, value_name = "FOLDER", help = doc("assets"))]
    pub assets: Vec<PathBuf>,
    #[arg(long, default_value = "80%", value_name = "SIZE", value_parser = Memory::parse, help = doc("memory"))]
    pub memory: Memory,
    #[command(flatten)]
    pub staging: StagingArgs,
}

/// What is rendered, how, and whereto
#[derive(Args)]
pub struct RenderArgs {
    /// The scene file
    pub scene: PathBuf,
    /// The picture to write; with --shard, the part [default: the scene's name with .png, here]
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
    /// Take the noise out of the colour picture, by what is known of each pixel's surface and of
    /// its noise; EXR keeps the picture as it was rendered, beside a layer `denoised`, and
    /// --hash knows nothing of it. By Open Image Denoise (oidn) where that is found, else by
    /// our own (own)
    #[arg(long, value_name = "BY", num_args = 0..=1, require_equals = true, default_missing_value = "auto", value_parser = Denoiser::parser())]
    pub denoise: Option<Denoiser>,
    /// Render again whenever the scene, a mesh or a picture of it is saved; the picture grows as it
    /// is made, and Ctrl-C ends
    #[arg(long, conflicts_with_all = ["pixel", "shard", "checkpoint", "resume", "restart", "preview"])]
    pub watch: bool,
    /// Print the hash of the film as the last line of standard output
    #[arg(long)]
    pub hash: bool,
    /// Tell on standard error what the time went into, which rays there were, and how much of the
    /// time they took
    #[arg(long)]
    pub stats: bool,
    /// Say nothing but errors
    #[arg(short, long)]
    pub quiet: bool,
}

/// Which pictures are made
#[derive(Args)]
pub struct ViewArgs {
    #[arg(long, value_name = "LEFT,TOP,WIDTHxHEIGHT", value_parser = crop, help = doc("crop"))]
    pub crop: Option<(u32, u32, u32, u32)>,
    /// What to show; several are joined by commas. With paths and photons, `error` is how far the
    /// luminance may be from the truth, noise and the bias of photons together, with 90 %
    /// confidence
    #[arg(long, value_delimiter = ',', default_value = "color", value_parser = PossibleValuesParser::new(shows()))]
    pub show: Vec<String>,
    /// Pixels for a pixel in the pictures `samples` and `filter`
    #[arg(long, default_value_t = 20, value_parser = clap::value_parser!(u32).range(1..=1000))]
    pub zoom: u32,
}

/// When and with how much it is made
#[derive(Args)]
pub struct WorkArgs {
    #[arg(long, value_parser = clap::value_parser!(u16).range(1..=1024), help = doc("threads"))]
    pub threads: Option<u16>,
    #[arg(long, value_name = "PIXELS", value_parser = clap::value_parser!(u32).range(8..=4096), help = doc("tile"))]
    pub tile: Option<u32>,
    #[arg(long = "time-limit", alias = "time", value_name = "TIME", value_parser = humantime::parse_duration, help = doc("time-limit"))]
    pub time: Option<Duration>,
    /// Go on with the work that was saved; from the start where none was
    #[arg(long)]
    pub resume: bool,
    /// Throw away unfinished work that was saved, and begin anew
    #[arg(long, conflicts_with_all = ["resume", "no_checkpoint"])]
    pub restart: bool,
    /// Where work is saved [default: PICTURE.part, from the first second on]
    #[arg(long, value_name = "FILE", conflicts_with = "shard")]
    pub checkpoint: Option<PathBuf>,
    /// How often work is saved, beside the ends of passes
    #[arg(long, default_value = "30s", value_name = "TIME", value_parser = humantime::parse_duration)]
    pub checkpoint_every: Duration,
    /// Do not save work before it is done
    #[arg(long, conflicts_with_all = ["checkpoint", "resume", "shard"])]
    pub no_checkpoint: bool,
    /// Write what is there into this picture too, after each pass over all pixels
    #[arg(long, value_name = "PICTURE", conflicts_with = "shard")]
    pub preview: Option<PathBuf>,
    #[arg(long, value_name = "INDEX/COUNT", requires = "output", help = doc("shard"))]
    pub shard: Option<Shard>,
    #[arg(long, value_name = "WHAT", default_value = "tiles", value_parser = ["tiles", "samples"], requires = "shard", help = doc("shard-by"))]
    pub shard_by: String,
}

/// Pictures that show not the scene but how it is sampled.
pub const DIAGRAMS: [&str; 2] = ["samples", "filter"];

/// The picture of how far pixels may be from the truth, which is made beside the work.
pub const ERROR: &str = "error";

fn shows() -> Vec<&'static str> {
    std::iter::once("color").chain(AOVS.iter().map(|aov| aov.name)).chain([ERROR]).chain(DIAGRAMS).collect()
}
