//! The command line of `durer photo`.

use crate::options::{JobArgs, SceneArgs};
use clap::{ArgGroup, Args, Subcommand};
use std::path::PathBuf;

/// From photographs of a scene to cameras and points, and a way to walk among them
#[derive(Args)]
#[command(after_help = "Examples:
  durer photo match photos/ -o matches.json
  durer photo solve matches.json -o solved/ -o points.ply
  durer photo explain solved/ --camera IMG_1.jpg
  durer photo tour solved/ --pictures photos/ -o tour.html")]
pub struct PhotoArgs {
    #[command(subcommand)]
    pub command: PhotoCommand,
}

#[derive(Subcommand)]
pub enum PhotoCommand {
    Match(MatchArgs),
    Solve(Box<SolveArgs>),
    Camera(CameraArgs),
    Place(Box<PlaceArgs>),
    Explain(ExplainArgs),
    Convert(ConvertArgs),
    Tour(TourArgs),
}

/// Find salient points in photographs, and which of them are the same point of the scene
#[derive(Args)]
#[command(after_help = "Examples:
  durer photo match photos/ -o matches.json
  durer photo match photos/ -o matches.json --side 3000 --features 12000
  durer photo match photos/ -o matches.json --ignore-exif --field 60

The focal length to begin with is EXIF's, or else follows from --field. The same photographs give the same file, on any number
of threads.")]
pub struct MatchArgs {
    /// The folder of photographs: JPEG or PNG
    pub folder: PathBuf,
    /// The file to write
    #[arg(short, long, value_name = "FILE.json", default_value = "matches.json")]
    pub output: PathBuf,
    /// Salient points of a photograph at most
    #[arg(long, default_value_t = 6000, value_parser = clap::value_parser!(u32).range(16..=100_000))]
    pub features: u32,
    /// Make photographs smaller until their longer side has at most so many pixels
    #[arg(long, value_name = "PIXELS", default_value_t = 1600, value_parser = clap::value_parser!(u32).range(64..=20_000))]
    pub side: u32,
    /// The horizontal field of view where EXIF tells nothing
    #[arg(long, value_name = "DEGREES", default_value_t = 45.0, value_parser = field)]
    pub field: f64,
    /// Take no focal length from EXIF
    #[arg(long)]
    pub ignore_exif: bool,
    #[command(flatten)]
    pub run: RunArgs,
}

/// How the work is done
#[derive(Args)]
pub struct RunArgs {
    /// Seed of the random numbers
    #[arg(long, default_value_t = 0)]
    pub seed: u64,
    /// Threads [default: as many as the machine has]
    #[arg(long, value_parser = clap::value_parser!(u16).range(1..=1024))]
    pub threads: Option<u16>,
    /// Say nothing but errors
    #[arg(short, long)]
    pub quiet: bool,
}

/// Where cameras and points go
#[derive(Args)]
pub struct ResultArgs {
    /// What to write, by its extension: .out (Bundler), .txt (BAL), .json (OpenSfM), .ply, .gltf,
    /// or a folder for COLMAP; may be given several times
    #[arg(short, long, value_name = "FILE")]
    pub output: Vec<PathBuf>,
    /// Write COLMAP's binary files
    #[arg(long)]
    pub binary: bool,
}

/// Find where photographs were taken and where the points are; or adjust cameras and points of a
/// file
#[derive(Args)]
#[command(after_help = "Examples:
  durer photo solve matches.json -o solved/
  durer photo solve matches.json -o bundle.out -o points.ply -o scene.gltf
  durer photo solve matches.json -o solved/ --control control.txt --covariance
  durer photo solve problem-16-22106-pre.txt -o adjusted.txt

What has cameras already (Bundler, BAL, COLMAP, OpenSfM) is only adjusted. Photographs of one camera, size and focal length share
a lens, unless --own-lenses says otherwise.
A file of control points has rows `X Y Z photograph u v photograph u v ...`: where a point is, and at which pixels it is seen.")]
pub struct SolveArgs {
    /// What `durer photo match` wrote, or cameras and points
    pub file: PathBuf,
    #[command(flatten)]
    pub results: ResultArgs,
    /// The folder of photographs, where the file does not know their sizes
    #[arg(long, value_name = "FOLDER")]
    pub pictures: Option<PathBuf>,
    /// Each photograph has a lens of its own
    #[arg(long)]
    pub own_lenses: bool,
    /// Hold the focal lengths
    #[arg(long)]
    pub fixed_focal: bool,
    /// Hold k1 and k2
    #[arg(long)]
    pub no_distortion: bool,
    /// How much a residual counts, when a file is adjusted: its square; Huber's and Cauchy's count
    /// far ones for less
    #[arg(long, default_value = "squared", value_parser = ["squared", "huber", "cauchy"])]
    pub loss: String,
    /// The residual beyond which an observation is false, in pixels, for photographs of up to 1600
    /// pixels
    #[arg(long, value_name = "PIXELS", default_value_t = 2.5, value_parser = positive)]
    pub threshold: f64,
    /// Put all where these points are
    #[arg(long, value_name = "FILE")]
    pub control: Option<PathBuf>,
    /// Say how exactly each camera is known
    #[arg(long)]
    pub covariance: bool,
    #[command(flatten)]
    pub run: RunArgs,
}

/// Find the camera of one photograph, from known points or from vanishing lines
#[derive(Args)]
#[command(after_help = "Examples:
  durer photo camera table.jpg --points table.points
  durer photo camera table.jpg --points table.points --focal 2900 -o camera.txt
  durer photo camera house.jpg --lines house.lines
  durer photo camera house.fspy -o camera.txt

Rows of --points are `X Y Z u v`: a point of the world and its pixel, from the upper left corner. Rows of --lines are
`x u1 v1 u2 v2`: the axis of the world that leads towards the vanishing point (x, -x, y, ...), and two pixels of a line along it; and
`origin u v`. Two axes are needed, and two lines or more of each. A project of fSpy's has all of that in it.
What is printed, or written by -o, is a block of Dürer's scene language: with it as the camera, a rendered object sits in the
photograph: see `durer photo place`.")]
pub struct CameraArgs {
    /// The photograph, or a project of fSpy's
    pub picture: PathBuf,
    /// Points of the world and their pixels
    #[arg(long, value_name = "FILE", conflicts_with = "lines")]
    pub points: Option<PathBuf>,
    /// Lines that are parallel in the world
    #[arg(long, value_name = "FILE")]
    pub lines: Option<PathBuf>,
    /// The focal length in pixels, if it is known
    #[arg(long, value_name = "PIXELS", requires = "points", value_parser = positive)]
    pub focal: Option<f64>,
    /// Look for the lens's distortion too
    #[arg(long, requires = "points")]
    pub distortion: bool,
    /// The residual in pixels beyond which a point is false [default: 0.5 % of the longer side]
    #[arg(long, value_name = "PIXELS", requires = "points", value_parser = positive)]
    pub threshold: Option<f64>,
    /// How far away the origin is, with --lines: photographs do not tell
    #[arg(long, value_name = "LENGTH", default_value_t = 10.0, value_parser = positive)]
    pub distance: f64,
    /// The file to write
    #[arg(short, long, value_name = "FILE")]
    pub output: Option<PathBuf>,
    /// Say nothing but errors and, without -o, the camera
    #[arg(short, long)]
    pub quiet: bool,
}

/// Put things of a scene into a photograph, with the shadows that they cast there
#[derive(Args)]
#[command(after_help = "Examples:
  durer photo place table.txt --backplate table.jpg -o placed.png
  durer photo place table.txt --backplate table.jpg --stand-in 0,3 -o placed.exr --samples 64

The scene has the photograph's camera, as `durer photo camera` finds it; things to be seen; and stand-ins for what is in the
photograph, a plane for its table say, which catch shadows and hide what is behind them, and are not seen themselves. The lights
should be those of the photograph. The scene is rendered with the things and without them: what the photograph shows becomes
darker and brighter as the stand-ins do. Their colours only matter in mirrors.")]
pub struct PlaceArgs {
    /// The scene file
    pub scene: PathBuf,
    /// The photograph: JPEG or PNG
    #[arg(long, value_name = "PICTURE")]
    pub backplate: PathBuf,
    /// The materials of stand-ins, by number; several are joined by commas
    #[arg(long, value_name = "NUMBERS", value_delimiter = ',', default_value = "0")]
    pub stand_in: Vec<u32>,
    /// The picture to write
    #[arg(short, long, value_name = "PICTURE")]
    pub output: PathBuf,
    #[command(flatten)]
    pub reading: SceneArgs,
    #[command(flatten)]
    pub job: JobArgs,
    /// Threads [default: as many as the machine has]
    #[arg(long, value_parser = clap::value_parser!(u16).range(1..=1024))]
    pub threads: Option<u16>,
    /// Say nothing but errors
    #[arg(short, long)]
    pub quiet: bool,
}

/// Say why a camera or a point is where it is: rays, equations with numbers, residuals
#[derive(Args)]
#[command(group(ArgGroup::new("asked").required(true)))]
#[command(after_help = "Examples:
  durer photo explain solved/ --point 12
  durer photo explain solved/ --camera IMG_1.jpg")]
pub struct ExplainArgs {
    /// Cameras and points
    pub file: PathBuf,
    /// A point, by its number from 0
    #[arg(long, value_name = "NUMBER", group = "asked")]
    pub point: Option<usize>,
    /// A photograph, by its name or number from 0
    #[arg(long, value_name = "NAME", group = "asked")]
    pub camera: Option<String>,
    /// The folder of photographs, where the file does not know their sizes
    #[arg(long, value_name = "FOLDER")]
    pub pictures: Option<PathBuf>,
}

/// Write cameras and points in another format
#[derive(Args)]
#[command(after_help = "Examples:
  durer photo convert bundle.out --pictures photos/ -o colmap/ --binary
  durer photo convert colmap/ -o scene.gltf -o points.ply
  durer photo convert problem.txt
  durer photo convert cloud.ply -o cloud.gltf

Without -o it only says what is in the file, and how well it fits. PLY has points alone, and of glTF (.gltf, .glb) cameras and points
are read: neither tells which photographs see a point.")]
pub struct ConvertArgs {
    /// Cameras and points
    pub file: PathBuf,
    #[command(flatten)]
    pub results: ResultArgs,
    /// The folder of photographs, where the file does not know their sizes
    #[arg(long, value_name = "FOLDER")]
    pub pictures: Option<PathBuf>,
    /// Say nothing but errors
    #[arg(short, long)]
    pub quiet: bool,
}

/// Make a page on which one walks among the photographs
#[derive(Args)]
#[command(after_help = "Example:
  durer photo tour solved/ --pictures photos/ -o tour.html

The page is one file that needs nothing else. Drag to turn, scroll to come closer, click a photograph to fly into it, click a point
of it to see all photographs of what is there.")]
pub struct TourArgs {
    /// Cameras and points
    pub file: PathBuf,
    /// The folder of photographs
    #[arg(long, value_name = "FOLDER")]
    pub pictures: PathBuf,
    /// The page to write
    #[arg(short, long, value_name = "FILE.html", default_value = "tour.html")]
    pub output: PathBuf,
    /// The longer side of photographs in the page
    #[arg(long, value_name = "PIXELS", default_value_t = 640, value_parser = clap::value_parser!(u32).range(32..=4096))]
    pub side: u32,
    /// Say nothing but errors
    #[arg(short, long)]
    pub quiet: bool,
}

fn positive(text: &str) -> Result<f64, String> {
    text.parse().ok().filter(|n: &f64| n.is_finite() && *n > 0.0).ok_or_else(|| "say a number more than 0".into())
}

fn field(text: &str) -> Result<f64, String> {
    let inside = |degrees: &f64| (1.0..=170.0).contains(degrees);
    text.parse().ok().filter(inside).ok_or_else(|| "say degrees from 1 to 170".into())
}
