//! Compiled scenes, which are ready for rendering and ray queries.

use crate::error::{Error, SceneError};
use crate::job::{JobContext, OutputSelection, RenderJob};
#[cfg(feature = "fs")]
use crate::load::{LoadOptions, load};
use durer_diag::{Diagnostics, Files};
use durer_formats::Decoder;
use durer_render::compile::{AccelKind, Resources, compile};
use durer_render::render::Job;
use durer_render::world::World;
use durer_scene::dialect::{Dialect, DialectRules};
use durer_scene::scene::Scene;
use durer_scene::source::{AssetSource, MemorySource};
use std::ops::Deref;
#[cfg(feature = "fs")]
use std::path::Path;

/// A scene that is ready for rendering and ray queries. It contains the description of the scene
/// and the [`World`] that was compiled from it, and it dereferences to this world.
#[derive(Debug)]
pub struct CompiledScene {
    scene: Scene,
    world: World,
    rules: DialectRules,
    dialect: Dialect,
    emulates_program: bool,
    diagnostics: Diagnostics,
    files: Files,
}

impl Deref for CompiledScene {
    type Target = World;

    fn deref(&self) -> &World {
        &self.world
    }
}

impl CompiledScene {
    /// Returns the description of the scene.
    pub fn scene(&self) -> &Scene {
        &self.scene
    }

    /// Returns the compiled world.
    pub fn world(&self) -> &World {
        &self.world
    }

    /// Returns the dialect of the scene file.
    pub fn dialect(&self) -> Dialect {
        self.dialect
    }

    /// Returns the warnings and notes about the scene.
    pub fn diagnostics(&self) -> &Diagnostics {
        &self.diagnostics
    }

    /// Returns the files to which the spans of diagnostics refer.
    pub fn files(&self) -> &Files {
        &self.files
    }

    /// Returns the context that determines the defaults of a job.
    pub fn job_context(&self) -> JobContext<'_> {
        JobContext { scene: &self.scene, rules: &self.rules, emulates: self.emulates_program, timed: false }
    }

    /// Resolves options into a job for a colour picture. Options that are not set get the scene's
    /// defaults.
    ///
    /// # Errors
    ///
    /// [`Error::Options`].
    pub fn job(&self, options: &RenderJob) -> Result<Job, Error> {
        let job = options.resolve(&self.job_context(), Some(&OutputSelection::default())).map_err(Error::Options)?;
        job.validate()?;
        Ok(job)
    }
}

impl RenderJob {
    /// Returns the default job of a scene. The size, integrator, depth and samples are set
    /// explicitly, so that each of them can be read and changed.
    pub fn for_scene(scene: &CompiledScene) -> RenderJob {
        let context = scene.job_context();
        match RenderJob::default().resolve(&context, Some(&OutputSelection::default())) {
            Ok(job) => RenderJob::of(&job, &context)
                .size((job.width, job.height))
                .integrator(job.method.name())
                .bounces(job.settings.bounces)
                .samples(job.sampling.samples()),
            Err(_) => RenderJob::default(),
        }
    }
}

/// Extension of [`Scene`] that compiles scenes built in code.
pub trait CompileScene {
    /// Compiles the scene with the rules of Dürer's own language. All meshes and pictures must be
    /// in memory.
    ///
    /// # Errors
    ///
    /// Returns [`Error::Scene`] if a value is invalid or the scene names a file.
    fn compile(self) -> Result<CompiledScene, Error>;

    /// Compiles the scene and loads the files that it names from `source`.
    ///
    /// # Errors
    ///
    /// Returns [`Error::Scene`] if a value is invalid or a file is missing or damaged.
    fn compile_with(self, source: &dyn AssetSource) -> Result<CompiledScene, Error>;
}

impl CompileScene for Scene {
    fn compile(self) -> Result<CompiledScene, Error> {
        self.compile_with(&MemorySource::default())
    }

    fn compile_with(self, source: &dyn AssetSource) -> Result<CompiledScene, Error> {
        let (mut files, mut diagnostics) = (Files::default(), Diagnostics::default());
        let (dialect, rules) = (Dialect::Durer, Dialect::Durer.rules().clone());
        let resources = Resources::new(source, &Decoder, &mut files);
        match compile(&self, &rules, AccelKind::Bvh, resources, &mut diagnostics) {
            Some(world) => {
                Ok(CompiledScene { scene: self, world, rules, dialect, emulates_program: false, diagnostics, files })
            }
            None => Err(SceneError::new(diagnostics, files).into()),
        }
    }
}

/// Reads and compiles a scene file. The format and dialect of the file are detected.
///
/// # Errors
///
/// Returns [`Error::Source`] if the file cannot be read and [`Error::Scene`] if it contains errors.
#[cfg(feature = "fs")]
pub fn open(path: impl AsRef<Path>) -> Result<CompiledScene, Error> {
    let (options, mut files, mut diagnostics) = (LoadOptions::default(), Files::default(), Diagnostics::default());
    let loaded = load(path.as_ref(), &options, &mut files, &mut diagnostics)?;
    let world = loaded.as_ref().and_then(|loaded| loaded.compile(&options, &mut files, &mut diagnostics));
    match (loaded, world) {
        (Some(loaded), Some(world)) => Ok(CompiledScene {
            emulates_program: false,
            scene: loaded.scene,
            world,
            rules: loaded.rules,
            dialect: loaded.dialect,
            diagnostics,
            files,
        }),
        _ => Err(SceneError::new(diagnostics, files).into()),
    }
}
