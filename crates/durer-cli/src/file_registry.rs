//! Tracks the input and output files of a run. No file can be both, and no output can be named
//! twice.
//!
//! Every file that the user names is registered here, and [`crate::output`] writes only registered
//! files. Files are compared by identity, so that different names of the same file and links to it
//! are recognised.

use crate::failure::{Failure, invalid_input};
use durer::image::Destination;
use durer::render::PartialRender;
use std::io::Read;
use std::path::{Path, PathBuf};

/// Input and output files of one run. They are registered so that no input is overwritten.
#[derive(Default)]
pub struct FileRegistry {
    inputs: Vec<NamedFile>,
    outputs: Vec<NamedFile>,
}

/// A registered file, the option that names it, and the identity of the file.
struct NamedFile {
    option: &'static str,
    path: PathBuf,
    identity: Identity,
}

/// Identity of a file, which shows that different names refer to the same file.
#[derive(PartialEq)]
struct Identity {
    /// Canonical path. For a file that does not exist yet, the identity is its name in the
    /// canonical folder.
    name: Option<PathBuf>,
    /// Device and inode numbers, which are equal for hard links.
    inode: Option<(u64, u64)>,
}

impl Identity {
    fn of(path: &Path) -> Self {
        let folder = path.parent().filter(|folder| !folder.as_os_str().is_empty()).unwrap_or(Path::new("."));
        let within = || Some(folder.canonicalize().ok()?.join(path.file_name()?));
        let name = path.canonicalize().ok().or_else(within);
        // File systems on these platforms usually ignore case.
        let same_case = cfg!(any(windows, target_os = "macos"));
        let name = name.map(|name| if same_case { name.to_string_lossy().to_lowercase().into() } else { name });
        Identity { name, inode: inode(path) }
    }

    fn is_same(&self, other: &Identity) -> bool {
        self.name.is_some() && self.name == other.name || self.inode.is_some() && self.inode == other.inode
    }
}

#[cfg(unix)]
fn inode(path: &Path) -> Option<(u64, u64)> {
    use std::os::unix::fs::MetadataExt;
    path.metadata().ok().map(|metadata| (metadata.dev(), metadata.ino()))
}

#[cfg(not(unix))]
fn inode(_: &Path) -> Option<(u64, u64)> {
    None
}

impl FileRegistry {
    /// Registers an input file. Fails if the file is already registered as an output.
    pub fn register_input(&mut self, path: &Path) -> Result<(), Failure> {
        let input = NamedFile { option: "", path: path.into(), identity: Identity::of(path) };
        if let Some(output) = self.outputs.iter().find(|output| output.identity.is_same(&input.identity)) {
            return Err(both(output, &input));
        }
        self.inputs.push(input);
        Ok(())
    }

    /// Registers the output file of the option `what`. Fails if the file cannot be written, is an
    /// input or another output, or holds saved work.
    pub fn register_output(&mut self, what: &'static str, path: &Path) -> Result<Destination, Failure> {
        let place = self.register_saved_work(what, path)?;
        match is_saved_work(path) {
            false => Ok(place),
            true => Err(invalid_input(format!(
                "{what} would overwrite `{}`, which holds saved work: choose another name",
                path.display()
            ))),
        }
    }

    /// Registers the output file of the option `what`, whose name must end in `.extension`.
    pub fn register_output_as(
        &mut self,
        what: &'static str,
        path: &Path,
        extension: &str,
    ) -> Result<Destination, Failure> {
        if !path.extension().is_some_and(|own| own.eq_ignore_ascii_case(extension)) {
            let (format, path) = (extension.to_uppercase(), path.display());
            return Err(invalid_input(format!("{what} writes {format}: `{path}` must end in .{extension}")));
        }
        self.register_output(what, path)
    }

    /// Registers an output file for saved work, which may replace older saved work.
    pub fn register_saved_work(&mut self, what: &'static str, path: &Path) -> Result<Destination, Failure> {
        self.register_removal(what, path)?;
        let own = ["/dev/stdout", "/dev/fd/1", "/proc/self/fd/1"].iter().any(|own| path == Path::new(own));
        if own && !crate::terminal::has_standard_output() {
            return Err(anyhow::anyhow!("cannot write `{}`: the stream is closed", path.display()).into());
        }
        Ok(Destination::new(path)?)
    }

    /// Registers a file that is only removed, or that is written through another registration.
    pub fn register_removal(&mut self, what: &'static str, path: &Path) -> Result<(), Failure> {
        let output = NamedFile { option: what, path: path.into(), identity: Identity::of(path) };
        let same = |other: &&NamedFile| other.identity.is_same(&output.identity);
        if let Some(input) = self.inputs.iter().find(same) {
            return Err(both(&output, input));
        }
        // Devices and pipes may be named twice.
        let file = !path.exists() || path.is_file();
        if let Some(other) = self.outputs.iter().find(same).filter(|_| file) {
            let (what, first) = (output.option, other.option);
            return Err(invalid_input(format!(
                "{first} and {what} both name `{}`: choose another name for one of them",
                path.display()
            )));
        }
        self.outputs.push(output);
        Ok(())
    }
}

/// Returns true if a file is a part file.
fn is_saved_work(path: &Path) -> bool {
    // Opening a FIFO would block the program.
    path.is_file() && start_of(path).is_ok_and(|start| start == PartialRender::MAGIC)
}

/// Reads the first bytes of a file, up to the length of [`PartialRender::MAGIC`].
pub fn start_of(path: &Path) -> std::io::Result<Vec<u8>> {
    let mut start = Vec::new();
    std::fs::File::open(path)?.take(PartialRender::MAGIC.len() as u64).read_to_end(&mut start)?;
    Ok(start)
}

fn both(output: &NamedFile, input: &NamedFile) -> Failure {
    let (what, path) = (output.option, output.path.display());
    let named =
        if output.path == input.path { String::new() } else { format!(", given as `{}`", input.path.display()) };
    invalid_input(format!("{what} would overwrite `{path}`, which is an input of this run{named}: choose another name"))
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn no_file_is_input_and_output_under_any_name() {
        let folder = tempfile::tempdir().unwrap();
        let at = |name: &str| folder.path().join(name);
        std::fs::create_dir(at("a")).unwrap();
        std::fs::write(at("in"), "").unwrap();
        std::fs::write(at("other"), "").unwrap();
        let mut same = vec![at("in"), at("./a/../in")];
        std::fs::hard_link(at("in"), at("hard")).unwrap();
        same.push(at("hard"));
        #[cfg(unix)]
        for (target, link) in [("in", "soft"), ("soft", "softer"), (".", "here")] {
            std::os::unix::fs::symlink(target, at(link)).unwrap();
            same.push(if link == "here" { at("here/in") } else { at(link) });
        }
        for name in &same {
            let (mut before, mut after) = (FileRegistry::default(), FileRegistry::default());
            before.register_input(&at("in")).unwrap_or_else(|_| panic!("nothing is written yet"));
            assert!(before.register_output("-o", name).is_err(), "{}", name.display());
            assert!(before.register_output("-o", &at("other")).is_ok());
            assert!(after.register_output("-o", name).is_ok());
            assert!(after.register_input(&at("in")).is_err(), "{}", name.display());
            assert!(after.register_output("--preview", &at("in")).is_err(), "{}", name.display());
        }
        // Files that do not exist yet.
        let mut registry = FileRegistry::default();
        assert!(
            registry.register_output("-o", &at("new")).is_ok() && registry.register_output("-o", &at("a/new")).is_ok()
        );
        assert!(registry.register_output("--preview", &at("a/../new")).is_err());
    }
}
