//! Prints and writes reconstructions.

use super::args::ResultArgs;
use super::inputs::from_photo_error;
use crate::failure::{Failure, invalid_input};
use crate::file_registry::FileRegistry;
use crate::output::save;
use crate::terminal::print_line;
use durer::image::Destination;
use durer_photo::Reconstruction;
use durer_photo::format::Output;
use std::path::{Path, PathBuf};

/// Prints a summary of a reconstruction and its residuals.
pub fn report(all: &Reconstruction) {
    let (fit, count) = (all.reprojection_error(), all.registered_count());
    print_line(&format!("{count} of {} photographs registered; {} points", all.views.len(), all.points.len()));
    if fit.observations > 0 {
        let (track, n) = (all.track_length(), fit.observations);
        let (rms, max, cost) = (fit.rms, fit.max, fit.cost);
        print_line(&format!(
            "{n} observations, {track:.2} per point; rms {rms:.4} pixels, at most {max:.2}; cost {cost:.6e}"
        ));
    }
}

/// Output files for cameras and points, with their formats and encoded contents.
pub struct Results {
    outputs: Vec<(Output, PathBuf, Vec<Destination>)>,
    folders: Vec<PathBuf>,
    files: Vec<Vec<u8>>,
}

impl Results {
    /// Checks before the work starts that the files can be written. Folders are created only when
    /// the files are saved.
    pub fn new(args: &ResultArgs, registry: &mut FileRegistry) -> Result<Self, Failure> {
        let mut results = Results { outputs: Vec::new(), folders: Vec::new(), files: Vec::new() };
        for path in &args.output {
            let output = Output::of(path, args.binary).map_err(from_photo_error)?;
            if output.is_folder() && !path.exists() {
                let parent = path.parent().filter(|parent| !parent.as_os_str().is_empty()).unwrap_or(Path::new("."));
                if !parent.is_dir() {
                    return Err(invalid_input(format!("folder `{}` does not exist", parent.display())));
                }
                results.folders.push(path.clone());
                results.outputs.push((output, path.clone(), Vec::new()));
                continue;
            }
            let places = output
                .files(path)
                .iter()
                .map(|file| registry.register_output("--output", file))
                .collect::<Result<_, _>>()?;
            results.outputs.push((output, path.clone(), places));
        }
        Ok(results)
    }

    /// Encodes a reconstruction for each output.
    pub fn add(&mut self, all: &Reconstruction) -> Result<(), Failure> {
        for (output, ..) in &self.outputs {
            self.files.extend(output.write(all).map_err(from_photo_error)?);
        }
        Ok(())
    }

    /// Writes either all files or none.
    pub fn save(mut self, quiet: bool) -> Result<(), Failure> {
        for folder in &self.folders {
            std::fs::create_dir(folder)
                .map_err(|error| anyhow::anyhow!("cannot create the folder `{}`: {error}", folder.display()))?;
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
            // Remove the folders that this run created. If that fails, empty folders remain.
            self.folders.iter().for_each(|folder| drop(std::fs::remove_dir(folder)));
        }
        saved
    }
}
