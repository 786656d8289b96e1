//! What the checks ask of a coarse look at the picture again and again: each is found out once.

use super::aim::{Aim, aim};
use super::brightness::{brightest, light};
use super::mesh_files::{MeshFile, files};
use super::probes::{ProbeGrid, Subject};
use super::verdict::{Verdict, verdicts};
use super::visibility::{Visibility, visibilities};
use durer_scene::math::Color;
use std::ops::Deref;
use std::sync::OnceLock;

/// What is darker shows nothing.
const DARK: f32 = 0.02;

/// A scene, and what a coarse look at its picture found.
#[derive(Debug)]
pub struct SceneProbe<'a> {
    grid: ProbeGrid<'a>,
    visibilities: OnceLock<Vec<Visibility>>,
    verdicts: OnceLock<Vec<Verdict>>,
    aims: OnceLock<Vec<Option<Aim>>>,
    light: OnceLock<Vec<Color>>,
    meshes: OnceLock<Vec<MeshFile<'a>>>,
    material_rays: OnceLock<Vec<usize>>,
}

impl<'a> Deref for SceneProbe<'a> {
    type Target = ProbeGrid<'a>;

    fn deref(&self) -> &ProbeGrid<'a> {
        &self.grid
    }
}

impl<'a> SceneProbe<'a> {
    /// Looks at a scene.
    pub fn new(subject: &Subject<'a>) -> Self {
        SceneProbe {
            grid: ProbeGrid::new(subject),
            visibilities: OnceLock::new(),
            verdicts: OnceLock::new(),
            aims: OnceLock::new(),
            light: OnceLock::new(),
            meshes: OnceLock::new(),
            material_rays: OnceLock::new(),
        }
    }

    /// How each object is seen.
    pub(super) fn visibilities(&self) -> &[Visibility] {
        self.visibilities.get_or_init(|| visibilities(self))
    }

    /// What each light does to what is seen.
    pub(super) fn verdicts(&self) -> &[Verdict] {
        self.verdicts.get_or_init(|| verdicts(self, self.aims()))
    }

    /// Which lights have beams that miss what is seen.
    pub(super) fn aims(&self) -> &[Option<Aim>] {
        let lights = 0..self.world().lights().len();
        self.aims.get_or_init(|| lights.map(|light| aim(self, light)).collect())
    }

    /// The colours of the picture, exposed: of all rays, or under a path tracer of a part of them,
    /// each the mean of a few samples.
    pub(super) fn light(&self) -> &[Color] {
        self.light.get_or_init(|| light(self))
    }

    /// Whether a path tracer's picture is black, or nearly so.
    pub(super) fn is_dark(&self) -> bool {
        self.is_physical() && !self.light().is_empty() && brightest(self.light()) < DARK
    }

    /// Its mesh files.
    pub(super) fn meshes(&self) -> &[MeshFile<'a>] {
        self.meshes.get_or_init(|| files(self))
    }

    /// How many rays see each material, or one that is mixed of it.
    pub(super) fn material_rays(&self) -> &[usize] {
        self.material_rays.get_or_init(|| self.count_rays())
    }
}
