//! The error type of this crate.

use durer_diag::{Diagnostics, Files};
use durer_image::ImageError;
#[cfg(feature = "fs")]
use durer_image::SaveError;
use durer_render::render::RenderError;
use durer_scene::source::SourceError;

/// Error while loading, compiling or rendering a scene or saving its picture.
#[derive(Debug, thiserror::Error)]
#[non_exhaustive]
pub enum Error {
    /// The scene has errors.
    #[error(transparent)]
    Scene(#[from] SceneError),
    /// Options of a render job are invalid or contradict each other or the scene.
    #[error("{0}")]
    Options(String),
    /// The render failed or was cancelled.
    #[error(transparent)]
    Render(#[from] RenderError),
    /// The picture cannot be stored in the format of the file.
    #[error(transparent)]
    Image(#[from] ImageError),
    /// The file could not be written.
    #[cfg(feature = "fs")]
    #[error(transparent)]
    Save(#[from] SaveError),
    /// The scene file could not be read.
    #[error(transparent)]
    Source(#[from] SourceError),
}

/// Errors of a scene, with the files to which they refer. They are displayed with file name, line
/// and column.
#[derive(Debug)]
pub struct SceneError {
    diagnostics: Diagnostics,
    files: Files,
}

impl SceneError {
    pub(crate) fn new(diagnostics: Diagnostics, files: Files) -> Self {
        SceneError { diagnostics, files }
    }

    /// Returns the errors and all other diagnostics of the scene.
    pub fn diagnostics(&self) -> &Diagnostics {
        &self.diagnostics
    }

    /// Returns the files to which the spans of diagnostics refer.
    pub fn files(&self) -> &Files {
        &self.files
    }
}

impl std::error::Error for SceneError {}

impl std::fmt::Display for SceneError {
    /// Writes one line for each error: `file:line:column: message`.
    fn fmt(&self, f: &mut std::fmt::Formatter) -> std::fmt::Result {
        for (i, error) in self.diagnostics.errors().enumerate() {
            if i > 0 {
                writeln!(f)?;
            }
            let place = error.span.and_then(|span| Some((self.files.name(span.file)?, self.files.position(span)?)));
            if let Some((name, (line, column))) = place {
                write!(f, "{name}:{line}:{column}: ")?;
            }
            write!(f, "{}", error.message)?;
        }
        Ok(())
    }
}

impl From<Diagnostics> for Error {
    fn from(diagnostics: Diagnostics) -> Self {
        SceneError::new(diagnostics, Files::default()).into()
    }
}
