//! `durer photo`: from photographs to cameras and points.

mod args;
mod camera;
mod explain;
mod matching;
mod place;
mod solve;
mod tour;

pub use args::PhotoArgs;

use crate::guard::Guard;
use crate::output::{save, say};
use crate::{Failure, bad};
use args::{PhotoCommand, ResultArgs};
use durer::image::Destination;
use durer_photo::format::{Output, inputs};
use durer_photo::{Error, Reconstruction};
use std::path::{Path, PathBuf};

pub fn run(args: &PhotoArgs) -> Result<(), Failure> {
    match &args.command {
        PhotoCommand::Match(args) => matching::run(args),
        PhotoCommand::Solve(args) => solve::run(args),
        PhotoCommand::Camera(args) => camera::run(args),
        PhotoCommand::Place(args) => place::run(args),
        PhotoCommand::Explain(args) => explain::run(args),
        PhotoCommand::Convert(args) => {
            let mut guard = Guard::default();
            let mut results = Results::new(&args.results, &mut guard)?;
            let all = read(&args.file, args.pictures.as_deref(), &mut guard)?;
            results.add(&all)?;
            results.save(args.quiet)?;
            if !args.quiet {
                tell(&all);
            }
            Ok(())
        }
        PhotoCommand::Tour(args) => tour::run(args),
    }
}

fn wrong(error: Error) -> Failure {
    bad(error.to_string())
}

/// A file's bytes.
fn bytes(path: &Path, guard: &mut Guard) -> Result<Vec<u8>, Failure> {
    guard.reads(path)?;
    std::fs::read(path).map_err(|error| bad(format!("cannot read `{}`: {error}", path.display())))
}

/// Runs on so many threads.
fn threaded<R: Send>(threads: Option<u16>, work: impl FnOnce() -> R + Send) -> Result<R, Failure> {
    let pool = rayon::ThreadPoolBuilder::new().num_threads(threads.map_or(0, usize::from)).build()?;
    Ok(pool.install(work))
}

/// The photographs of a folder, by name.
fn photographs(folder: &Path) -> Result<Vec<PathBuf>, Failure> {
    let entries = std::fs::read_dir(folder)
        .map_err(|error| bad(format!("cannot read the folder `{}`: {error}", folder.display())))?;
    let mut paths = entries.map(|entry| Ok(entry?.path())).collect::<Result<Vec<_>, Failure>>()?;
    let known = |path: &PathBuf| {
        let end = path.extension().unwrap_or_default().to_string_lossy().to_lowercase();
        ["jpg", "jpeg", "png"].contains(&&*end) && path.is_file()
    };
    paths.retain(known);
    paths.sort();
    match paths.is_empty() {
        true => Err(bad(format!("there are no photographs in `{}`: no .jpg, .jpeg or .png", folder.display()))),
        false => Ok(paths),
    }
}

fn name(path: &Path) -> String {
    path.file_name().unwrap_or_default().to_string_lossy().into_owned()
}

/// Cameras and points of a file. Where that has no names and sizes of photographs, they are those
/// of a folder, in order.
fn read(file: &Path, pictures: Option<&Path>, guard: &mut Guard) -> Result<Reconstruction, Failure> {
    inputs(file).iter().try_for_each(|path| guard.reads(path))?;
    let mut all = durer_photo::format::read(file).map_err(wrong)?;
    let Some(folder) = pictures.filter(|_| all.lenses.iter().any(|lens| lens.size == [0, 0])) else { return Ok(all) };
    let paths = photographs(folder)?;
    if paths.len() != all.views.len() {
        return Err(bad(format!(
            "there are {} photographs in `{}`, and {} cameras in `{}`",
            paths.len(),
            folder.display(),
            all.views.len(),
            file.display()
        )));
    }
    for (i, path) in paths.iter().enumerate() {
        let size = durer_photo::photo::size(&path.to_string_lossy(), &bytes(path, guard)?).map_err(wrong)?;
        all.set_picture(i, &name(path), size);
    }
    Ok(all)
}

/// Says how many there are of everything, and how well it fits.
fn tell(all: &Reconstruction) {
    let (fit, count) = (all.fit(), all.registered());
    say(&format!("{count} of {} photographs have a place; {} points", all.views.len(), all.points.len()));
    if fit.observations > 0 {
        let (track, n) = (all.track_length(), fit.observations);
        let (rms, max, cost) = (fit.rms, fit.max, fit.cost);
        say(&format!("{n} observations, {track:.2} a point; rms {rms:.4} pixels, at most {max:.2}; cost {cost:.6e}"));
    }
}

/// Where cameras and points go, each in its format.
struct Results {
    outputs: Vec<(Output, PathBuf, Vec<Destination>)>,
    folders: Vec<PathBuf>,
    files: Vec<Vec<u8>>,
}

impl Results {
    /// Says now what is known to prevent writing. Folders are made when there is something to put
    /// into them.
    fn new(args: &ResultArgs, guard: &mut Guard) -> Result<Self, Failure> {
        let mut results = Results { outputs: Vec::new(), folders: Vec::new(), files: Vec::new() };
        for path in &args.output {
            let output = Output::of(path, args.binary).map_err(wrong)?;
            if output.is_folder() && !path.exists() {
                let parent = path.parent().filter(|parent| !parent.as_os_str().is_empty()).unwrap_or(Path::new("."));
                if !parent.is_dir() {
                    return Err(bad(format!("there is no folder `{}`", parent.display())));
                }
                results.folders.push(path.clone());
                results.outputs.push((output, path.clone(), Vec::new()));
                continue;
            }
            let places =
                output.files(path).iter().map(|file| guard.writes("--output", file)).collect::<Result<_, _>>()?;
            results.outputs.push((output, path.clone(), places));
        }
        Ok(results)
    }

    /// Makes the files' contents.
    fn add(&mut self, all: &Reconstruction) -> Result<(), Failure> {
        for (output, ..) in &self.outputs {
            self.files.extend(output.write(all).map_err(wrong)?);
        }
        Ok(())
    }

    /// Writes all files or none.
    fn save(mut self, quiet: bool) -> Result<(), Failure> {
        for folder in &self.folders {
            std::fs::create_dir(folder)
                .map_err(|error| anyhow::anyhow!("cannot make the folder `{}`: {error}", folder.display()))?;
        }
        let saved = (|| {
            for (output, path, places) in &mut self.outputs {
                if places.is_empty() {
                    *places = output.files(path).into_iter().map(Destination::new).collect::<Result<_, _>>()?;
                }
            }
            let places = self.outputs.iter().flat_map(|(_, _, places)| places);
            save(&places.zip(std::mem::take(&mut self.files)).collect::<Vec<_>>(), quiet)
        })();
        if saved.is_err() {
            // Folders that were made for nothing go; where that fails they stay, empty.
            self.folders.iter().for_each(|folder| drop(std::fs::remove_dir(folder)));
        }
        saved
    }
}
