//! The command line of `durer photo`.

use crate::options::{JobArgs, SceneArgs};
use clap::{ArgGroup, Args, Subcommand};
use std::path::PathBuf;

/// Reconstruct cameras and points from photographs, and make a virtual tour of them
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

// The subcommands of `durer photo`. A doc comment would replace the description of the command.
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

/// Find features in photographs and match them
#[derive(Args)]
#[command(after_help = "Examples:
  durer photo match photos/ -o matches.json
  durer photo match photos/ -o matches.json --side 3000 --features 12000
  durer photo match photos/ -o matches.json --ignore-exif --field 60

The initial focal length comes from EXIF, or from --field if EXIF has none. The output does not depend on the number of
threads.")]
pub struct MatchArgs {
    /// Folder of photographs: JPEG or PNG
    pub folder: PathBuf,
    /// File to write
    #[arg(short, long, value_name = "FILE.json", default_value = "matches.json")]
    pub output: PathBuf,
    /// Maximum number of features per photograph
    #[arg(long, default_value_t = 6000, value_parser = clap::value_parser!(u32).range(16..=100_000))]
    pub features: u32,
    /// Scale photographs down so that the longer side has at most this many pixels
    #[arg(long, value_name = "PIXELS", default_value_t = 1600, value_parser = clap::value_parser!(u32).range(64..=20_000))]
    pub side: u32,
    /// Horizontal field of view for photographs whose EXIF has no focal length
    #[arg(long, value_name = "DEGREES", default_value_t = 45.0, value_parser = field)]
    pub field: f64,
    /// Ignore the focal length in EXIF
    #[arg(long)]
    pub ignore_exif: bool,
    #[command(flatten)]
    pub run: RunArgs,
}

/// Seed, threads and messages
#[derive(Args)]
pub struct RunArgs {
    /// Seed of the random number generator
    #[arg(long, default_value_t = 0)]
    pub seed: u64,
    /// Number of threads [default: one per processor]
    #[arg(long, value_parser = clap::value_parser!(u16).range(1..=1024))]
    pub threads: Option<u16>,
    /// Print only errors
    #[arg(short, long)]
    pub quiet: bool,
}

/// Output files for cameras and points
#[derive(Args)]
pub struct ResultArgs {
    /// File to write, by extension: .out (Bundler), .txt (BAL), .json (OpenSfM), .ply, .gltf, or a
    /// folder for COLMAP; can be given several times
    #[arg(short, long, value_name = "FILE")]
    pub output: Vec<PathBuf>,
    /// Write COLMAP's binary files
    #[arg(long)]
    pub binary: bool,
}

/// Compute cameras and points from matches, or adjust the cameras and points of a file
#[derive(Args)]
#[command(after_help = "Examples:
  durer photo solve matches.json -o solved/
  durer photo solve matches.json -o bundle.out -o points.ply -o scene.gltf
  durer photo solve matches.json -o solved/ --control control.txt --covariance
  durer photo solve problem-16-22106-pre.txt -o adjusted.txt

If the file already has cameras (Bundler, BAL, COLMAP, OpenSfM), only bundle adjustment is run. Photographs from the same
camera, with the same size and focal length, share a lens unless --own-lenses is given.
Each row of a control point file is `X Y Z photograph u v photograph u v ...`: the position of a point, and its pixel in
each photograph.")]
pub struct SolveArgs {
    /// File written by `durer photo match`, or cameras and points
    pub file: PathBuf,
    #[command(flatten)]
    pub results: ResultArgs,
    /// Folder of photographs, needed if the file does not contain their sizes
    #[arg(long, value_name = "FOLDER")]
    pub pictures: Option<PathBuf>,
    /// Use a separate lens for each photograph
    #[arg(long)]
    pub own_lenses: bool,
    /// Keep the focal lengths fixed
    #[arg(long)]
    pub fixed_focal: bool,
    /// Keep the distortion coefficients k1 and k2 fixed
    #[arg(long)]
    pub no_distortion: bool,
    /// Loss function when a file with cameras is adjusted; huber and cauchy reduce the weight of
    /// outliers
    #[arg(long, default_value = "squared", value_parser = ["squared", "huber", "cauchy"])]
    pub loss: String,
    /// Residual in pixels above which an observation is an outlier; scaled up for photographs
    /// larger than 1600 pixels
    #[arg(long, value_name = "PIXELS", default_value_t = 2.5, value_parser = positive)]
    pub threshold: f64,
    /// Align the result with these control points
    #[arg(long, value_name = "FILE")]
    pub control: Option<PathBuf>,
    /// Print the standard deviation of each camera
    #[arg(long)]
    pub covariance: bool,
    #[command(flatten)]
    pub run: RunArgs,
}

/// Compute the camera of one photograph from known points or vanishing lines
#[derive(Args)]
#[command(after_help = "Examples:
  durer photo camera table.jpg --points table.points
  durer photo camera table.jpg --points table.points --focal 2900 -o camera.txt
  durer photo camera house.jpg --lines house.lines
  durer photo camera house.fspy -o camera.txt

Each row of the --points file is `X Y Z u v`: a world-space point and its pixel, measured from the upper left corner. Each
row of the --lines file is `x u1 v1 u2 v2`: the world axis that points towards the vanishing point (x, -x, y, ...), and two
pixels on a line along this axis. A row `origin u v` sets the pixel of the world origin. At least two axes are needed, with
at least two lines each. An fSpy project contains all of this.
The output is a camera in Dürer's scene language. A scene rendered with this camera matches the photograph: see `durer photo
place`.")]
pub struct CameraArgs {
    /// Photograph, or an fSpy project
    pub picture: PathBuf,
    /// File of world-space points and their pixels
    #[arg(long, value_name = "FILE", conflicts_with = "lines")]
    pub points: Option<PathBuf>,
    /// File of lines in the photograph that are parallel to the world axes
    #[arg(long, value_name = "FILE")]
    pub lines: Option<PathBuf>,
    /// Focal length in pixels, if it is known
    #[arg(long, value_name = "PIXELS", requires = "points", value_parser = positive)]
    pub focal: Option<f64>,
    /// Also estimate the lens distortion
    #[arg(long, requires = "points")]
    pub distortion: bool,
    /// Residual in pixels above which a point is an outlier [default: 0.5 % of the longer side]
    #[arg(long, value_name = "PIXELS", requires = "points", value_parser = positive)]
    pub threshold: Option<f64>,
    /// Distance from the camera to the origin with --lines, which a photograph does not determine
    #[arg(long, value_name = "LENGTH", default_value_t = 10.0, value_parser = positive)]
    pub distance: f64,
    /// File to write
    #[arg(short, long, value_name = "FILE")]
    pub output: Option<PathBuf>,
    /// Print only errors and, without -o, the camera
    #[arg(short, long)]
    pub quiet: bool,
}

/// Insert objects from a scene into a photograph, with their shadows
#[derive(Args)]
#[command(after_help = "Examples:
  durer photo place table.txt --backplate table.jpg -o placed.png
  durer photo place table.txt --backplate table.jpg --stand-in 0,3 -o placed.exr --samples 64

The scene contains the photograph's camera, as computed by `durer photo camera`, the objects to insert, and stand-ins for
objects in the photograph, for example a plane for a table. Stand-ins are invisible, but they catch shadows and hide what is
behind them. The lights should match those in the photograph. The scene is rendered with and without the inserted objects,
and the photograph is darkened or brightened as much as the stand-ins are. The colours of the stand-ins only matter in
mirrors.")]
pub struct PlaceArgs {
    /// Scene file
    pub scene: PathBuf,
    /// Photograph: JPEG or PNG
    #[arg(long, value_name = "PICTURE")]
    pub backplate: PathBuf,
    /// Comma-separated list of the material numbers of the stand-ins
    #[arg(long, value_name = "NUMBERS", value_delimiter = ',', default_value = "0")]
    pub stand_in: Vec<u32>,
    /// Picture to write
    #[arg(short, long, value_name = "PICTURE")]
    pub output: PathBuf,
    #[command(flatten)]
    pub reading: SceneArgs,
    #[command(flatten)]
    pub job: JobArgs,
    /// Number of threads [default: one per processor]
    #[arg(long, value_parser = clap::value_parser!(u16).range(1..=1024))]
    pub threads: Option<u16>,
    /// Print only errors
    #[arg(short, long)]
    pub quiet: bool,
}

/// Explain a camera or a point: rays, equations with numbers, residuals
#[derive(Args)]
#[command(group(ArgGroup::new("asked").required(true)))]
#[command(after_help = "Examples:
  durer photo explain solved/ --point 12
  durer photo explain solved/ --camera IMG_1.jpg")]
pub struct ExplainArgs {
    /// File or folder of cameras and points
    pub file: PathBuf,
    /// Number of the point to explain, counted from 0
    #[arg(long, value_name = "NUMBER", group = "asked")]
    pub point: Option<usize>,
    /// Name or number of the photograph to explain, counted from 0
    #[arg(long, value_name = "NAME", group = "asked")]
    pub camera: Option<String>,
    /// Folder of photographs, needed if the file does not contain their sizes
    #[arg(long, value_name = "FOLDER")]
    pub pictures: Option<PathBuf>,
}

/// Convert cameras and points to another format
#[derive(Args)]
#[command(after_help = "Examples:
  durer photo convert bundle.out --pictures photos/ -o colmap/ --binary
  durer photo convert colmap/ -o scene.gltf -o points.ply
  durer photo convert problem.txt
  durer photo convert cloud.ply -o cloud.gltf

Without -o, prints a summary of the file and its residuals. PLY files contain only points, and glTF files (.gltf, .glb)
contain cameras and points. Neither records which photographs see a point.")]
pub struct ConvertArgs {
    /// File or folder of cameras and points
    pub file: PathBuf,
    #[command(flatten)]
    pub results: ResultArgs,
    /// Folder of photographs, needed if the file does not contain their sizes
    #[arg(long, value_name = "FOLDER")]
    pub pictures: Option<PathBuf>,
    /// Print only errors
    #[arg(short, long)]
    pub quiet: bool,
}

/// Make an HTML page for moving through the photographs in 3D
#[derive(Args)]
#[command(after_help = "Example:
  durer photo tour solved/ --pictures photos/ -o tour.html

The page is one self-contained file. Drag to rotate, scroll to zoom, click a photograph to fly to it, click a point
to list all photographs that show it.")]
pub struct TourArgs {
    /// File or folder of cameras and points
    pub file: PathBuf,
    /// Folder of photographs
    #[arg(long, value_name = "FOLDER")]
    pub pictures: PathBuf,
    /// Page to write
    #[arg(short, long, value_name = "FILE.html", default_value = "tour.html")]
    pub output: PathBuf,
    /// Length of the longer side of the photographs in the page
    #[arg(long, value_name = "PIXELS", default_value_t = 640, value_parser = clap::value_parser!(u32).range(32..=4096))]
    pub side: u32,
    /// Print only errors
    #[arg(short, long)]
    pub quiet: bool,
}

fn positive(text: &str) -> Result<f64, String> {
    text.parse().ok().filter(|n: &f64| n.is_finite() && *n > 0.0).ok_or_else(|| "expected a number above 0".into())
}

fn field(text: &str) -> Result<f64, String> {
    let inside = |degrees: &f64| (1.0..=170.0).contains(degrees);
    text.parse().ok().filter(inside).ok_or_else(|| "expected degrees from 1 to 170".into())
}
