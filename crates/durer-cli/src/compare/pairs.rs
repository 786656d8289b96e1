//! Forms pairs of the pictures in two files or folders.

use crate::failure::{Failure, invalid_input};
use crate::open::is_stream;
use durer::image::format_for;
use std::path::{Path, PathBuf};

/// A reference picture and the picture to compare with it.
pub struct Pair {
    /// Name of the student if there is a folder for each student.
    pub student: Option<String>,
    /// File name, or the path relative to the folder.
    pub name: String,
    pub reference: PathBuf,
    /// Picture to compare, or `None` if there is none for this reference.
    pub picture: Option<PathBuf>,
}

/// The pairs of pictures that `durer compare` compares, and the pictures without a reference.
pub struct Pairs {
    pub pairs: Vec<Pair>,
    pub extra: Vec<PathBuf>,
    /// True if folders are compared.
    pub folders: bool,
}

/// Maximum depth of nested folders. It is limited because links can form cycles.
const DEPTH: usize = 16;

/// Pairs two pictures, or pairs the pictures with the same names in two folders.
pub fn find(reference: &Path, picture: &Path) -> Result<Pairs, Failure> {
    for path in [reference, picture] {
        if is_stream(path) {
            return Err(invalid_input("`durer compare` reads files only: a picture cannot come from standard input"));
        }
        if !path.exists() {
            return Err(invalid_input(format!("cannot read `{}`: no such file or folder", path.display())));
        }
    }
    match (reference.is_dir(), picture.is_dir()) {
        (false, false) => {
            let name = picture.file_name().unwrap_or(picture.as_os_str()).to_string_lossy().into_owned();
            let pair = Pair { student: None, name, reference: reference.into(), picture: Some(picture.into()) };
            Ok(Pairs { pairs: vec![pair], extra: Vec::new(), folders: false })
        }
        (true, true) => folders(reference, picture),
        _ => Err(invalid_input(format!(
            "`{}` and `{}`: one is a folder and the other is a file; pass two pictures or two folders",
            reference.display(),
            picture.display()
        ))),
    }
}

fn folders(reference: &Path, picture: &Path) -> Result<Pairs, Failure> {
    let mut references = Vec::new();
    pictures(reference, Path::new(""), DEPTH, &mut references)?;
    if references.is_empty() {
        return Err(invalid_input(format!("no pictures in `{}`", reference.display())));
    }
    let mut pairs = Pairs { pairs: Vec::new(), extra: Vec::new(), folders: true };
    let matched = pairs.add(None, reference, picture, &references)?;
    if matched == 0 {
        // The picture folder contains one folder for each student.
        let mut class = Pairs { pairs: Vec::new(), extra: Vec::new(), folders: true };
        let mut any = 0;
        for name in names(picture)? {
            let folder = picture.join(&name);
            if folder.is_dir() {
                any += class.add(Some(name.to_string_lossy().into_owned()), reference, &folder, &references)?;
            }
        }
        if any == 0 {
            return Err(invalid_input(format!(
                "no picture in `{}` has the same name as a picture in `{}`",
                picture.display(),
                reference.display()
            )));
        }
        pairs = class;
    }
    Ok(pairs)
}

impl Pairs {
    /// Adds the pairs in one folder. Returns the number of references with a counterpart.
    fn add(
        &mut self,
        who: Option<String>,
        reference: &Path,
        folder: &Path,
        references: &[PathBuf],
    ) -> Result<usize, Failure> {
        let mut own = Vec::new();
        pictures(folder, Path::new(""), DEPTH, &mut own)?;
        let mut matched = 0;
        let mut used = vec![false; own.len()];
        for name in references {
            let stem = name.with_extension("");
            let exact = own.iter().position(|path| path == name);
            let index = exact.or_else(|| own.iter().position(|path| path.with_extension("") == stem));
            if let Some(index) = index {
                used[index] = true;
                matched += 1;
            }
            self.pairs.push(Pair {
                student: who.clone(),
                name: name.display().to_string(),
                reference: reference.join(name),
                picture: index.map(|index| folder.join(&own[index])),
            });
        }
        self.extra.extend(own.iter().zip(used).filter(|(_, used)| !used).map(|(path, _)| folder.join(path)));
        Ok(matched)
    }
}

/// Returns the sorted names of the entries in a folder, without hidden files.
fn names(folder: &Path) -> Result<Vec<std::ffi::OsString>, Failure> {
    let unreadable =
        |error: std::io::Error| invalid_input(format!("cannot read the folder `{}`: {error}", folder.display()));
    let mut names = Vec::new();
    for entry in std::fs::read_dir(folder).map_err(unreadable)? {
        names.push(entry.map_err(unreadable)?.file_name());
    }
    names.retain(|name| !name.to_string_lossy().starts_with('.'));
    names.sort();
    Ok(names)
}

/// Collects the pictures in a folder and its subfolders, recognised by their extensions.
fn pictures(root: &Path, below: &Path, depth: usize, pairs: &mut Vec<PathBuf>) -> Result<(), Failure> {
    for name in names(&root.join(below))? {
        let path = below.join(&name);
        if root.join(&path).is_dir() {
            if depth > 0 {
                pictures(root, &path, depth - 1, pairs)?;
            }
        } else if format_for(&path).is_ok() {
            pairs.push(path);
        }
    }
    Ok(())
}
