//! Reads and writes the camera and point files of other programs.

mod bal;
mod bundler;
mod colmap;
mod colmap_binary;
mod colmap_text;
mod compressed;
mod fspy;
mod gltf;
mod opensfm;
mod ply;
mod scene;
mod text;
mod user_input;

use crate::{Error, Lens, Pose, Reconstruction};
use nalgebra::{Matrix3, Vector2, Vector3};
use std::fmt::Display;
use std::path::{Path, PathBuf};
use std::sync::Arc;
use text::TokenReader;

pub use crate::known::ControlPoint;
pub use fspy::read_project;
pub use scene::projective_camera;
pub use user_input::{read_control, read_lines, read_points};

/// Row of the table of file formats, which describes the coordinate conventions of one format as
/// text for the manual.
pub struct Convention {
    /// Name of the format.
    pub name: &'static str,
    /// File extensions by which the format is recognised.
    pub files: &'static str,
    /// Supported directions, which can be in, out, or both.
    pub direction: &'static str,
    /// Camera frame.
    pub frame: &'static str,
    /// Representation of rotations in the format.
    pub rotation: &'static str,
    /// Formula for the translation, or its meaning.
    pub translation: &'static str,
    /// Units and origin of pixels.
    pub pixels: &'static str,
    /// Parameters that describe a lens.
    pub lens: &'static str,
}

/// Coordinate conventions of all formats, as shown in docs/photographs.md.
pub const CONVENTIONS: [Convention; 9] = {
    const fn row(f: [&'static str; 8]) -> Convention {
        let [name, files, direction, frame, rotation, translation, pixels, lens] = f;
        Convention { name, files, direction, frame, rotation, translation, pixels, lens }
    }
    const T: &str = "P = R X + t";
    const CORNER: &str = "pixels from the upper left corner, y down";
    const MIDDLE: &str = "pixels from the middle, y up";
    const DOWN: &str = "x right, y down, z forward";
    const UP: &str = "x right, y up, z backward";
    [
        row(["Dürer", "in memory", "", DOWN, "matrix", T, CORNER, "f, aspect, cx, cy, k1, k2"]),
        row(["Bundler", "`.out`", "in, out", UP, "matrix by rows", T, MIDDLE, "f, k1, k2"]),
        row(["BAL", "`.txt`", "in, out", UP, "axis times angle", T, MIDDLE, "f, k1, k2"]),
        row([
            "COLMAP text",
            "a folder",
            "in, out",
            DOWN,
            "quaternion w x y z",
            T,
            CORNER,
            "SIMPLE_PINHOLE, PINHOLE, SIMPLE_RADIAL, RADIAL, OPENCV",
        ]),
        row(["COLMAP binary", "a folder", "in, out", DOWN, "quaternion w x y z", T, CORNER, "the same"]),
        row([
            "OpenSfM",
            "`.json`",
            "in, out",
            DOWN,
            "axis times angle",
            T,
            "longer side = 1, from the middle, y down",
            "f / longer side, k1, k2",
        ]),
        row([
            "fSpy",
            "`.fspy`, `.json`",
            "in",
            UP,
            "4x4 matrix",
            T,
            "longer side from -1 to 1, y up; lines from 0 to 1, y down",
            "f / half the longer side, cx, cy",
        ]),
        row(["PLY", "`.ply`", "in, out", "none", "none", "points, then camera centres", "none", "none"]),
        row([
            "glTF",
            "`.gltf`, `.glb` (in)",
            "in, out",
            UP,
            "quaternion x y z w, camera to world",
            "camera centre",
            "none",
            "vertical field of view; size, cx, cy, k1, k2 as `extras`",
        ]),
    ]
};

/// Converts a pose between the two camera frames: -z forward with y up, and +z forward with y down.
fn flip_camera_axes(pose: &Pose) -> Pose {
    let turn = Matrix3::from_diagonal(&Vector3::new(1.0, -1.0, -1.0));
    Pose { rotation: turn * pose.rotation, translation: turn * pose.translation }
}

/// Returns true if a matrix is a rotation, apart from rounding errors.
fn is_rotation(matrix: &Matrix3<f64>) -> bool {
    (matrix * matrix.transpose() - Matrix3::identity()).norm() < 1e-3 && matrix.determinant() > 0.0
}

fn joined<T: Display>(values: impl IntoIterator<Item = T>) -> String {
    text::join(values)
}

/// Returns an error if a lens has non-square pixels, which `format` does not support.
fn require_square_pixels(lens: &Lens, format: &str) -> Result<(), Error> {
    if lens.aspect == 1.0 {
        return Ok(());
    }
    Err(Error::new(format!("{format} supports square pixels only, but a lens has the aspect {}", lens.aspect)))
}

/// Callback that returns the bytes of the file at a path.
pub type OpenFile<'a> = dyn FnMut(&Path) -> Result<Arc<[u8]>, Error> + 'a;

/// Reads a file, and decompresses it if it is in gzip or bzip2 format.
fn bytes(path: &Path, open: &mut OpenFile) -> Result<Arc<[u8]>, Error> {
    compressed::decompress(&path.to_string_lossy(), open(path)?)
}

/// Returns the files that [`read`] opens for a path.
pub fn inputs(path: &Path) -> Vec<PathBuf> {
    if path.is_dir() {
        let end = if path.join("cameras.bin").exists() { "bin" } else { "txt" };
        return ["cameras", "images", "points3D"].map(|name| path.join(format!("{name}.{end}"))).into();
    }
    tracks_of(path).into_iter().chain([path.to_path_buf()]).collect()
}

/// Returns the path of the file with the tracks of an OpenSfM reconstruction. Its name contains
/// `tracks` instead of `reconstruction`.
fn tracks_of(path: &Path) -> Option<PathBuf> {
    let name = path.file_name()?.to_str()?;
    let other = path.with_file_name(name.replace("reconstruction", "tracks")).with_extension("csv");
    (path.extension()? == "json" && other.exists()).then_some(other)
}

/// Reads cameras and points. The format is determined by the extension, ignoring a final `.gz` or
/// `.bz2`. A folder must be in COLMAP's format.
pub fn read(path: &Path) -> Result<Reconstruction, Error> {
    read_with(path, &mut |path| {
        let read = std::fs::read(path).map(Into::into);
        read.map_err(|error| Error::in_file(&path.to_string_lossy(), format!("cannot read the file: {error}")))
    })
}

/// Reads cameras and points as [`read`] does, but opens the files with `open`; see [`inputs`].
pub fn read_with(path: &Path, open: &mut OpenFile) -> Result<Reconstruction, Error> {
    let file = path.to_string_lossy();
    if path.is_dir() {
        let paths = inputs(path);
        let contents = paths.iter().map(|path| bytes(path, open)).collect::<Result<Vec<_>, _>>()?;
        let names: Vec<_> = paths.iter().map(|path| path.to_string_lossy()).collect();
        let tables = [0, 1, 2].map(|i| (&*names[i], &*contents[i]));
        return match paths[0].extension().is_some_and(|end| end == "bin") {
            true => colmap_binary::read(&file, tables),
            false => colmap_text::read(&file, tables),
        };
    }
    let content = bytes(path, open)?;
    match compressed::without_compression_extension(path).extension().and_then(|end| end.to_str()) {
        Some("out") => bundler::read(&file, &content),
        Some("txt") => bal::read(&file, &content),
        Some("ply") => ply::read(&file, &content),
        Some("gltf" | "glb") => gltf::read(&file, &content),
        Some("json") if is_matches(&content) => Err(Error::in_file(
            &file,
            "the file contains matches without cameras: compute the cameras with `durer photo solve`",
        )),
        Some("json") if content.trim_ascii_start().starts_with(b"{") => fspy::read_camera(&file, &content),
        Some("json") => {
            let tracks = tracks_of(path).map(|path| Ok((path.to_string_lossy().into_owned(), bytes(&path, open)?)));
            let tracks = tracks.transpose()?;
            opensfm::read(&file, &content, tracks.as_ref().map(|(name, bytes)| (&**name, &**bytes)))
        }
        _ => Err(Error::in_file(
            &file,
            "the name must end in .out (Bundler), .txt (BAL), .json (OpenSfM, fSpy), .gltf, .glb or .ply, or the path \
             must be a COLMAP folder",
        )),
    }
}

/// Returns true if the first line shows that
/// [`Matches::to_json`](crate::matching::Matches::to_json) wrote the file.
pub fn is_matches(content: &[u8]) -> bool {
    let head = String::from_utf8_lossy(&content[..content.len().min(80)]);
    head.contains("\"format\"") && head.contains(crate::matching::FORMAT)
}

/// File format in which cameras and points are written.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Output {
    /// Bundler's `.out` file.
    Bundler,
    /// Problem file of *Bundle Adjustment in the Large*.
    Bal,
    /// COLMAP folder with text files.
    ColmapText,
    /// COLMAP folder with binary files.
    ColmapBinary,
    /// JSON file of OpenSfM, with its tracks in a separate file next to it.
    OpenSfm,
    /// PLY file that contains points.
    Ply,
    /// glTF file that contains cameras and points.
    Gltf,
}

impl Output {
    /// Returns the output format for a path, based on its extension. A path without an extension
    /// denotes a folder.
    pub fn of(path: &Path, binary: bool) -> Result<Self, Error> {
        Ok(match path.extension().and_then(|end| end.to_str()) {
            None if binary => Output::ColmapBinary,
            None => Output::ColmapText,
            Some("out") => Output::Bundler,
            Some("txt") => Output::Bal,
            Some("json") => Output::OpenSfm,
            Some("ply") => Output::Ply,
            Some("gltf") => Output::Gltf,
            Some(_) => {
                let file = path.to_string_lossy();
                let why =
                    "the name must end in .out, .txt, .json, .ply or .gltf, or have no extension for a COLMAP folder";
                return Err(Error::in_file(&file, why));
            }
        })
    }

    /// Returns true if the output is a folder.
    pub fn is_folder(self) -> bool {
        matches!(self, Output::ColmapText | Output::ColmapBinary)
    }

    /// Returns the paths of the output files, in the order of [`Output::write`].
    pub fn files(self, path: &Path) -> Vec<PathBuf> {
        let table = |end: &str| ["cameras", "images", "points3D"].map(|name| path.join(format!("{name}.{end}"))).into();
        match self {
            Output::ColmapText => table("txt"),
            Output::ColmapBinary => table("bin"),
            Output::OpenSfm => {
                let name = path.file_stem().unwrap_or_default().to_string_lossy();
                let name = match name.contains("reconstruction") {
                    true => name.replace("reconstruction", "tracks"),
                    false => name.into_owned(),
                };
                vec![path.to_path_buf(), path.with_file_name(name).with_extension("csv")]
            }
            _ => vec![path.to_path_buf()],
        }
    }

    /// Returns the contents of the output files.
    pub fn write(self, reconstruction: &Reconstruction) -> Result<Vec<Vec<u8>>, Error> {
        Ok(match self {
            Output::Bundler => vec![bundler::write(reconstruction)?],
            Output::Bal => vec![bal::write(reconstruction)?],
            Output::ColmapText => colmap_text::write(reconstruction).map(String::into_bytes).into(),
            Output::ColmapBinary => colmap_binary::write(reconstruction).into(),
            Output::OpenSfm => opensfm::write(reconstruction)?.map(String::into_bytes).into(),
            Output::Ply => vec![ply::write(reconstruction)],
            Output::Gltf => vec![gltf::write(reconstruction)?],
        })
    }
}

impl Reconstruction {
    /// Sets the name and the size of a photograph that was read from a format without names and
    /// sizes. Pixels of the photograph are then relative to the upper left corner instead of the
    /// image centre.
    pub fn set_image(&mut self, view: usize, name: &str, size: [u32; 2]) {
        self.views[view].name = name.to_string();
        let lens = self.views[view].lens;
        if self.lenses[lens].size != [0, 0] {
            return;
        }
        let shift = Vector2::from(size.map(|side| f64::from(side) / 2.0));
        self.lenses[lens].size = size;
        self.lenses[lens].principal_point = shift.into();
        let views: Vec<bool> = self.views.iter().map(|view| view.lens == lens).collect();
        let observations = self.points.iter_mut().flat_map(|point| &mut point.track);
        observations.filter(|observation| views[observation.view]).for_each(|observation| observation.pixel += shift);
    }
}
