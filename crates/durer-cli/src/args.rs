//! The command line.

use crate::denoise::Denoiser;
mod values;

use crate::display::DisplayArgs;
use crate::frames::FramesArgs;
use crate::memory::Memory;
use crate::method::MethodArgs;
use crate::staging::StagingArgs;
use clap::builder::{ArgPredicate, PossibleValuesParser};
use clap::{Args, Parser, Subcommand};
use durer::dialect::{Compat, Dialect};
use durer::film::Filter;
use durer::film::aov::AOVS;
use durer::image::Transfer;
use durer::render::Shard;
use durer::sampler::Sampler;
use std::path::PathBuf;
use std::time::Duration;
pub use values::weight;
use values::{cells, compat, crop, noise, on_off, percent, pixel, size, tolerance};

/// A ray tracer: exact, explainable, deterministic.
#[derive(Parser)]
#[command(
    name = "durer",
    version,
    arg_required_else_help = true,
    after_help = "Examples:
  durer render scene.txt -o picture.png
  durer info scene.txt
  durer help render"
)]
pub struct Cli {
    #[command(subcommand)]
    pub command: Command,
}

#[derive(Subcommand)]
pub enum Command {
    Render(Box<RenderCommand>),
    Explain(Box<ExplainArgs>),
    Lesson(Box<LessonArgs>),
    Check(Box<CheckArgs>),
    Farm(crate::farm::FarmArgs),
    Merge(MergeArgs),
    Verify(Box<VerifyArgs>),
    Course(CourseArgs),
    Info(InfoArgs),
    Measure(Box<crate::measure::MeasureArgs>),
    Convert(ConvertArgs),
    Compare(Box<CompareArgs>),
    Photo(crate::photo::PhotoArgs),
    /// List the dialects of the scene language, and the old programs' habits that can be had by
    /// name
    #[command(after_help = "Example:\n  durer dialects")]
    Dialects,
    /// Look up a word of the scene language: what it takes, in which dialects, with an example
    #[command(
        after_help = "Examples:\n  durer words\n  durer words PhongMaterial\n  durer words falloff --dialect f16"
    )]
    Words(crate::words::WordsArgs),
    /// Print shell completions to standard output
    #[command(after_help = "Example:\n  durer completions bash > ~/.local/share/bash-completion/completions/durer")]
    Completions {
        /// The shell
        shell: clap_complete::Shell,
    },
    /// Print the manual page to standard output
    #[command(after_help = "Example:\n  durer man > durer.1 && man ./durer.1")]
    Man,
}

/// How a scene is read
#[derive(Args)]
pub struct SceneArgs {
    /// The scene's dialect, with all habits of that year's program; guessed where not given
    #[arg(long, value_parser = PossibleValuesParser::new(Dialect::ALL.map(Dialect::name)))]
    pub dialect: Option<String>,
    /// Turn an old program's habit on, or off with `no-` before it (see `durer dialects`)
    #[arg(long, value_name = "NAME", value_delimiter = ',', value_parser = compat)]
    pub compat: Vec<(Compat, bool)>,
    /// Allow only the words of the dialect: no comments, nothing of our own
    #[arg(long)]
    pub strict: bool,
    /// Let the scene name files outside its own folder
    #[arg(long)]
    pub allow_outside: bool,
    /// Look for missing meshes and pictures in this folder too
    #[arg(long, value_name = "FOLDER")]
    pub assets: Vec<PathBuf>,
    /// Refuse what needs more memory: bytes as in 512M or 8G, or a share of the machine's or
    /// control group's
    #[arg(long, default_value = "80%", value_name = "SIZE", value_parser = Memory::parse)]
    pub memory: Memory,
    #[command(flatten)]
    pub staging: StagingArgs,
}

/// Render a scene or a model to a picture
#[derive(Args)]
#[command(after_help = "Examples:
  durer render scene.txt -o picture.png
  durer render model.glb -o picture.png --view iso --studio sun
  durer render model.glb -o frame.png --turntable 36
  durer render walk.%04d.txt -o walk.png --frames 1-100
  durer render scene.txt -o picture.png --watch
  durer render scene.txt -o picture.exr --size 1920x1080 --samples 64
  durer render scene.txt -o picture.exr --noise 0.01 --time 10m --preview preview.png
  durer render scene.txt -o picture.exr --samples 256 --resume
  durer render scene.txt -o three.part --shard 3/16
  durer render scene.txt -o picture.png --show color,depth,normals --depth-range 9 10
  durer render room.txt -o room.png --show luminance,illuminance --light-range 10 100000 --light-log
  durer render scene.txt -o picture.png --dialect f04 --shadows --bounces 4 --transfer course
  durer render scene.txt -o dots.png --show samples --size 9x9 --sampler jittered --samples 9

A scene is a file of the course's language or a model: glTF, GLB, pbrt, Mitsuba, Radiance, 3MF, PLY, OBJ, STL. A model without camera and light is seen whole, in a studio.

The extension of PICTURE says the format: png, tga, bmp, ppm, pfm, exr, hdr. Several pictures go into one EXR file
as layers, or into files of their own: picture.depth.png and so on.

Work that takes long is saved every now and then into PICTURE.part, which --resume goes on with, and without which word or
--restart nothing of it is thrown away; it is removed when the picture is done. Ctrl-C, SIGTERM and SIGHUP save what is there.")]
pub struct RenderCommand {
    #[command(flatten)]
    pub render: RenderArgs,
    #[command(flatten)]
    pub frames: FramesArgs,
    /// Print what one pixel sees, and write nothing
    #[arg(long, value_name = "X,Y", value_parser = pixel)]
    pub pixel: Option<(u32, u32)>,
    /// Of that pixel, only this sample
    #[arg(long, value_name = "NUMBER", requires = "pixel")]
    pub sample: Option<u32>,
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
    /// Make only a part of the picture
    #[arg(long, value_name = "LEFT,TOP,WIDTHxHEIGHT", value_parser = crop)]
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

/// What the picture is
#[derive(Args)]
pub struct JobArgs {
    /// Size in pixels [default: 512x512; with --dialect, that year's]
    #[arg(long, value_name = "WIDTHxHEIGHT", value_parser = size)]
    pub size: Option<(u32, u32)>,
    /// Depths shown as the two ends of grey [default: those in the picture]
    #[arg(long, num_args = 2, value_names = ["MIN", "MAX"], allow_negative_numbers = true)]
    pub depth_range: Option<Vec<f32>>,
    /// Luminance or illuminance shown as the first and the last false colour [default: 0 and what
    /// 98 % of the picture stay below]
    #[arg(long, num_args = 2, value_names = ["LOW", "HIGH"], allow_negative_numbers = true)]
    pub light_range: Option<Vec<f32>>,
    /// False colours of light by equal ratios; --light-range begins above 0
    #[arg(long, requires = "light_range")]
    pub light_log: bool,
    #[command(flatten)]
    pub method: MethodArgs,
    /// Levels of mirrored and transmitted rays; of paths, how often light is scattered after the
    /// first time [default: 8, of paths 16; with --dialect, that year's]
    #[arg(long, value_parser = clap::value_parser!(u32).range(0..=256))]
    pub bounces: Option<u32>,
    /// Whether things cast shadows [default: on; with --dialect, off]
    #[arg(long, value_name = "on|off", num_args = 0..=1, require_equals = true, default_missing_value = "on", value_parser = on_off)]
    pub shadows: Option<bool>,
    /// Whether surfaces are shaded from behind too [default: on; with --dialect, off]
    #[arg(long, value_name = "on|off", num_args = 0..=1, require_equals = true, default_missing_value = "on", value_parser = on_off)]
    pub shade_back: Option<bool>,
    /// Let transparent things cast coloured shadows
    #[arg(long)]
    pub transparent_shadows: bool,
    /// Leave mirrored rays out
    #[arg(long)]
    pub no_reflection: bool,
    /// Leave transmitted rays out
    #[arg(long)]
    pub no_refraction: bool,
    /// Leave out rays that count for less than this [default: 1/256; with --dialect, 0]
    #[arg(long, allow_negative_numbers = true, value_parser = weight)]
    pub weight: Option<f32>,

    /// Samples a pixel; 1 is the pixel's centre [default: 16, or 64 through a lens or a hole; with
    /// --dialect, 1; with --time, no end; with --noise, 4096]
    #[arg(long, value_parser = clap::value_parser!(u32).range(1..=1 << 20))]
    pub samples: Option<u32>,
    /// Where samples lie; all but sobol are the course's, with its filters
    #[arg(long, default_value = "sobol", value_parser = PossibleValuesParser::new(Sampler::NAMES.map(|n| n.0)))]
    pub sampler: String,
    /// Reconstruction filter [default: blackman-harris; none for the course's samplers]
    #[arg(long, value_parser = PossibleValuesParser::new(Filter::NAMES.map(|n| n.0)))]
    pub filter: Option<String>,
    /// Radius of the filter in pixels; for the course's Gaussian, its standard deviation
    #[arg(long, value_name = "PIXELS", requires = "filter")]
    pub filter_radius: Option<f32>,
    /// Three by three jittered sub-pixels, as in 2012
    #[arg(long, conflicts_with_all = ["samples", "sampler", "filter"])]
    pub jitter: bool,
    /// Blur by five taps, as in 2012
    #[arg(long, conflicts_with_all = ["samples", "sampler", "filter"])]
    pub blur: bool,
    /// Stop where the estimated error of what is seen is below this; 0.01 is a hundredth of the way
    /// from black to white
    #[arg(long, value_name = "ERROR", value_parser = noise)]
    pub noise: Option<f32>,
    /// Seed of the random numbers
    #[arg(long, default_value_t = 0)]
    pub seed: u64,

    /// What finds the objects that a ray may hit
    #[arg(long, default_value = "bvh", default_value_if("grid", ArgPredicate::IsPresent, "grid"), value_parser = ["bvh", "grid", "none"])]
    pub accel: String,
    /// Cells of the grid, which is used then [default: suitable ones]
    #[arg(long, value_name = "XxYxZ", value_parser = cells)]
    pub grid: Option<[u32; 3]>,
}

/// When and with how much it is made
#[derive(Args)]
pub struct WorkArgs {
    /// Threads that build and render [default: as many as the machine has]
    #[arg(long, value_parser = clap::value_parser!(u16).range(1..=1024))]
    pub threads: Option<u16>,
    /// Pixels across and down the tiles that threads take, in steps of 8 [default: suitable ones]
    #[arg(long, value_name = "PIXELS", value_parser = clap::value_parser!(u32).range(8..=4096))]
    pub tile: Option<u32>,
    /// Stop after this time, as in 30s, 10m, 1h30m, once every pixel has a sample
    #[arg(long, value_name = "TIME", value_parser = humantime::parse_duration)]
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
    /// Make only one of several parts, for `durer merge`
    #[arg(long, value_name = "INDEX/COUNT", requires = "output")]
    pub shard: Option<Shard>,
    /// Whether parts have different pixels or different samples
    #[arg(long, value_name = "WHAT", default_value = "tiles", value_parser = ["tiles", "samples"], requires = "shard")]
    pub shard_by: String,
}

/// Put parts of a picture together
#[derive(Args)]
#[command(after_help = "Examples:
  durer merge one.part two.part three.part -o picture.exr
  durer merge shards/*.part -o picture.png --hash

The result is the same, bit for bit, as that of one run. Parts of other pictures, work that is in two parts and
work that is in none are refused.")]
pub struct MergeArgs {
    /// The parts, in any order
    #[arg(required = true)]
    pub parts: Vec<PathBuf>,
    /// The picture to write
    #[arg(short, long, value_name = "PICTURE")]
    pub output: PathBuf,
    #[command(flatten)]
    pub display: DisplayArgs,
    /// Print the hash of the film as the last line of standard output
    #[arg(long)]
    pub hash: bool,
    /// Say nothing but errors
    #[arg(short, long)]
    pub quiet: bool,
}

/// Render a scene in many ways, and see whether the film is always the same
#[derive(Args)]
#[command(after_help = "Examples:
  durer verify scene.txt
  durer verify scene.txt --trials 500 --size 64x48 --samples 24 --noise 0.02

Ways differ by threads, tile size, shards by tiles or samples, interruptions, the structure that finds what rays
hit, and the processor's instructions. A small picture is enough; its default is 64x48 with 8 samples.")]
pub struct VerifyArgs {
    /// The scene file
    pub scene: PathBuf,
    #[command(flatten)]
    pub reading: SceneArgs,
    #[command(flatten)]
    pub view: ViewArgs,
    #[command(flatten)]
    pub job: JobArgs,
    /// How many ways to try
    #[arg(long, default_value_t = 100, value_parser = clap::value_parser!(u32).range(1..=1_000_000))]
    pub trials: u32,
    /// Print the hash alone
    #[arg(short, long)]
    pub quiet: bool,
}

/// Say why a pixel has its colour: the tree of terms that sums to it
#[derive(Args)]
#[command(after_help = "Examples:
  durer explain scene.txt --pixel 200,150
  durer explain scene.txt --pixel 200,150 --sample 3 --size 640x480 --bounces 2
  durer explain scene.txt --brightest --html why.html
  durer explain scene.txt --ray '0 1 5 0 0 -1' --json

Give the options with which the picture was rendered: they decide the pixel. Those that only say where a picture goes
change nothing here. With one sample the pixel's centre is explained.")]
pub struct ExplainArgs {
    #[command(flatten)]
    pub render: RenderArgs,

    /// The pixel, counted from 0 at the upper left corner
    #[arg(long, value_name = "X,Y", value_parser = pixel, conflicts_with_all = ["ray", "brightest", "worst"])]
    pub pixel: Option<(u32, u32)>,
    /// The sample whose tree is shown, by its place in the list [default: the first of those that
    /// count most]
    #[arg(long, value_name = "N")]
    pub sample: Option<u32>,
    /// Any ray instead of a pixel's: origin and direction
    #[arg(long, value_name = "OX OY OZ DX DY DZ", value_delimiter = ' ', num_args = 1..=6, allow_negative_numbers = true, conflicts_with_all = ["brightest", "worst", "sample"])]
    pub ray: Option<Vec<f32>>,
    /// The brightest pixel of the picture
    #[arg(long, conflicts_with = "worst")]
    pub brightest: bool,
    /// The pixel least like those around it; of paths, the one to which a single sample adds most
    #[arg(long)]
    pub worst: bool,
    /// Leave out terms that are a smaller share of the pixel, in percent
    #[arg(long, value_name = "PERCENT", default_value_t = 0.0, value_parser = percent)]
    pub min: f64,
    /// Leave out terms that stand deeper in the tree
    #[arg(long, value_name = "N")]
    pub depth: Option<u32>,
    /// As JSON
    #[arg(long, conflicts_with = "html")]
    pub json: bool,
    /// As a page with the picture, the tree and the rays in space
    #[arg(long, value_name = "FILE")]
    pub html: Option<PathBuf>,
}

/// Show a scene in the order of the lecture: rays, distance, normals, light by light, with
/// equations and mistakes
#[derive(Args)]
#[command(after_help = "Examples:
  durer lesson scene.txt -o lesson/
  durer lesson scene.txt -o lesson/ --size 400x300 --samples 64
  durer lesson scene.txt -o lesson/ --dialect f04 --shadows --bounces 4 --transfer course
  durer lesson scenes/plates.txt -o lesson/ --samples 32

FOLDER gets a page for a browser, index.html, which needs nothing else, and the same as lesson.md with its pictures as
files. A folder that is there already keeps its other files; what an earlier lesson wrote is replaced.
Give the options with which the picture is rendered: with Whitted's light the last step is that picture. Without --size its
longer side has 256 pixels. A step of which nothing is seen in the scene is shown in a small scene of ours, and says so.
With --integrator path or photons, which some scenes have by themselves, the lesson goes on with soft shadows, bounces, lamps
found in two ways, caustics and spectra, as far as the scene has them.")]
pub struct LessonArgs {
    /// The scene file
    pub scene: PathBuf,
    /// The folder to write [default: the scene's name with -lesson, here]
    #[arg(short, long, value_name = "FOLDER")]
    pub output: Option<PathBuf>,
    #[command(flatten)]
    pub reading: SceneArgs,
    #[command(flatten)]
    pub job: JobArgs,
    /// Threads that build and render [default: as many as the machine has]
    #[arg(long, value_parser = clap::value_parser!(u16).range(1..=1024))]
    pub threads: Option<u16>,
    /// How colours become eight bits
    #[arg(long, default_value = "srgb", value_parser = PossibleValuesParser::new(Transfer::ALL.map(Transfer::name)))]
    pub transfer: String,
    /// Say nothing but errors
    #[arg(short, long)]
    pub quiet: bool,
}

/// Say what is wrong with a scene whose picture is black, white, empty or odd, and mend it
#[derive(Args)]
#[command(after_help = "Examples:
  durer check scene.txt
  durer check scene.txt --dialect f04 --bounces 4 --depth-range 9 10
  durer check scene.txt --fix -o mended.txt
  durer check class/*.txt --json

Give the options with which the picture is rendered: they decide what is odd. Findings stand in the order of cause: what comes
of others is told after them. --fix writes what is mechanical, in place or into FILE, and tells what it changed and what is
left; a change after which the finding is still there is not made.

JSON: {version, scenes: [{scene, dialect, readable, findings: [{code, severity, whole, message, label, effect, help, place,
related, fix}], mended: [{code, place, old, new}]}]}. A place is {file, line, column, end_line, end_column, start, end}, lines and
columns from 1, start and end in bytes; `fix` lists {place, text}, and `whole` says that the whole picture is spoilt. A higher
version may add fields; codes are never given another meaning.

Exit code: 0 nothing found but notes, 1 warnings, 2 a scene of which no picture can be made, or wrong options.")]
pub struct CheckArgs {
    /// The scene files
    #[arg(required_unless_present = "codes", value_name = "SCENE")]
    pub scenes: Vec<PathBuf>,
    #[command(flatten)]
    pub reading: SceneArgs,
    #[command(flatten)]
    pub view: ViewArgs,
    #[command(flatten)]
    pub job: JobArgs,
    /// The stops by which the picture is made brighter, as `render --exposure` has it: they decide
    /// what is too bright or too dark
    #[arg(long, value_name = "EV", default_value_t = 0.0, allow_negative_numbers = true)]
    pub exposure: f32,
    /// Write the scene anew, with all changed that is mechanical
    #[arg(long)]
    pub fix: bool,
    /// Where to write it [default: in place]
    #[arg(short, long, value_name = "FILE", requires = "fix")]
    pub output: Option<PathBuf>,
    /// As JSON
    #[arg(long)]
    pub json: bool,
    /// List the codes of all findings, with their meaning
    #[arg(long, conflicts_with_all = ["scenes", "fix"])]
    pub codes: bool,
}

/// Take the arguments of the course's own programs, of any year
#[derive(Args)]
#[command(
    disable_help_flag = true,
    after_help = "Example:
  durer course -input scene.txt -size 200 200 -output picture.tga -depth 9 10 depth.tga

`durer course --help` lists the options."
)]
pub struct CourseArgs {
    /// Arguments as the course's programs take them
    #[arg(trailing_var_arg = true, allow_hyphen_values = true)]
    pub arguments: Vec<String>,
}

/// Say what is in a scene
#[derive(Args)]
#[command(after_help = "Examples:\n  durer info scene.txt\n  durer info scene.txt --json")]
pub struct InfoArgs {
    /// The scene file
    pub scene: PathBuf,
    #[command(flatten)]
    pub reading: SceneArgs,
    /// As JSON, with the scene as `durer convert` writes it
    #[arg(long)]
    pub json: bool,
}

/// Write a scene anew: in its own or another dialect, as JSON, as glTF, or its meshes as PLY, OBJ
/// or STL
#[derive(Args)]
#[command(
    after_help = "Examples:\n  durer convert scene.txt -o scene_durer.txt --to durer\n  durer convert scene.txt -o scene.json\n  durer convert model.glb -o model.stl\n  durer convert scene.pbrt -o scene.glb"
)]
pub struct ConvertArgs {
    /// The scene file
    pub scene: PathBuf,
    /// The file to write
    #[arg(short, long)]
    pub output: PathBuf,
    #[command(flatten)]
    pub reading: SceneArgs,
    /// The dialect to write [default: the scene's]
    #[arg(long, value_parser = PossibleValuesParser::new(Dialect::ALL.map(Dialect::name)))]
    pub to: Option<String>,
}

/// Compare a picture with a reference: numbers, words, a heat map, a page to look at
#[derive(Args)]
#[command(after_help = "Examples:
  durer compare reference.png mine.png
  durer compare reference.png mine.png --report report.html --tolerance 2/255
  durer compare reference.exr mine.exr --heat heat.png --json
  durer compare reference.png mine.png --scene scene.txt --bounces 4 --report report.html
  durer compare reference/ mine/ --report report.html
  durer compare reference/ class/

Folders are compared picture by picture, by name; extensions may differ. Where no name of REFERENCE is in PICTURE itself, but
some are in folders in it, each of those is taken for one student's.
With --scene, each region that differs tells what is there: the object, its place in the file, the normal, and why the ray has
its colour. The options with which the picture was rendered decide that.
Exit code: 0 the same within the tolerance, 1 different or missing, 2 a picture that cannot be read, sizes that differ, wrong
options, or a file that cannot be written.")]
pub struct CompareArgs {
    /// The picture that is right, or a folder of such
    pub reference: PathBuf,
    /// The picture to judge, or a folder of such
    pub picture: PathBuf,
    /// Write a page for a browser, in one file: slider, blinking, heat map, table
    #[arg(long, value_name = "FILE.html")]
    pub report: Option<PathBuf>,
    /// Write a picture of the FLIP errors
    #[arg(long, value_name = "PICTURE")]
    pub heat: Option<PathBuf>,
    /// The largest difference of a channel that counts as the same, as 2/255 or a number
    #[arg(long, default_value = "1/255", value_parser = tolerance, allow_negative_numbers = true)]
    pub tolerance: f32,
    /// The share of pixels, in percent, that may differ by more
    #[arg(long, value_name = "PERCENT", default_value_t = 0.0, value_parser = percent, allow_negative_numbers = true)]
    pub allow: f64,
    /// How light becomes eight bits where the other picture has those: as when the reference was
    /// made
    #[arg(long, default_value = "srgb", value_parser = PossibleValuesParser::new(Transfer::ALL.map(Transfer::name)))]
    pub transfer: String,
    /// Everything as JSON
    #[arg(long)]
    pub json: bool,
    /// The scene of the pictures, or a folder of scenes of their names: the usual mistakes are
    /// tried on it, and the one that makes the picture is named. Give the options that made the
    /// reference as well
    #[arg(long, value_name = "SCENE")]
    pub scene: Option<PathBuf>,
    #[command(flatten)]
    pub reading: SceneArgs,
    #[command(flatten)]
    pub view: ViewArgs,
    #[command(flatten)]
    pub job: JobArgs,
}

/// Pictures that show not the scene but how it is sampled.
pub const DIAGRAMS: [&str; 2] = ["samples", "filter"];

/// The picture of how far pixels may be from the truth, which is made beside the work.
pub const ERROR: &str = "error";

fn shows() -> Vec<&'static str> {
    std::iter::once("color").chain(AOVS.iter().map(|aov| aov.name)).chain([ERROR]).chain(DIAGRAMS).collect()
}
