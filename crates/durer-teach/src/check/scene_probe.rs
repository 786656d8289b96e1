//! Results that several checks use and that are computed on demand.

use super::aim::{BeamMiss, beam_miss};
use super::brightness::{brightest, exposed_colors};
use super::mesh_files::{MeshFile, files, models};
use super::probes::{CheckInput, Probe, ProbeGrid};
use super::shapes::is_black;
use super::verdict::{LightVerdict, verdicts};
use super::visibility::{Visibility, visibilities};
use durer_render::world::Material;
use durer_scene::math::{Color, Ray, Vec3};
use std::ops::Deref;
use std::sync::OnceLock;

/// Brightness below which a picture counts as black.
const DARK: f32 = 0.02;

/// A scene being checked. It contains the probes, and results that several checks use and that are
/// computed on first use.
#[derive(Debug)]
pub struct SceneProbe<'a> {
    grid: ProbeGrid<'a>,
    visibilities: OnceLock<Vec<Visibility>>,
    verdicts: OnceLock<Vec<LightVerdict>>,
    aims: OnceLock<Vec<Option<BeamMiss>>>,
    light: OnceLock<(Vec<usize>, Vec<Color>)>,
    meshes: OnceLock<Vec<MeshFile<'a>>>,
    models: OnceLock<Vec<MeshFile<'a>>>,
    material_rays: OnceLock<Vec<usize>>,
    radiances: OnceLock<Vec<Color>>,
    pub(super) reach: OnceLock<Reach>,
}

/// Points from which light can reach the camera. They are visible, or random paths from the visible
/// points lead to them.
#[derive(Debug, Default)]
pub(super) struct Reach {
    /// Each point with the normal of the visible side. Points in fog have no normal.
    pub(super) points: Vec<(Vec3, Option<Vec3>)>,
    /// The rays that are reflected at the visible points, with the objects that they leave and hit.
    pub(super) first: Vec<(u32, Option<u32>)>,
    /// The reflected rays that end on an object, and that object.
    pub(super) ends: Vec<(Ray, u32)>,
    /// True if some reflected ray leaves the scene.
    pub(super) escapes: bool,
}

impl<'a> Deref for SceneProbe<'a> {
    type Target = ProbeGrid<'a>;

    fn deref(&self) -> &ProbeGrid<'a> {
        &self.grid
    }
}

impl<'a> SceneProbe<'a> {
    /// Traces the probes of a scene.
    pub fn new(input: &CheckInput<'a>) -> Self {
        SceneProbe {
            grid: ProbeGrid::new(input),
            visibilities: OnceLock::new(),
            verdicts: OnceLock::new(),
            aims: OnceLock::new(),
            light: OnceLock::new(),
            meshes: OnceLock::new(),
            models: OnceLock::new(),
            material_rays: OnceLock::new(),
            radiances: OnceLock::new(),
            reach: OnceLock::new(),
        }
    }

    /// Returns the visibility of each object, by index.
    pub(super) fn visibilities(&self) -> &[Visibility] {
        self.visibilities.get_or_init(|| visibilities(self))
    }

    /// Returns the verdict on each light, by index.
    pub(super) fn verdicts(&self) -> &[LightVerdict] {
        self.verdicts.get_or_init(|| verdicts(self, self.aims()))
    }

    /// Returns, for each light, the way in which its beam misses the visible points, or `None` if
    /// it does not miss them.
    pub(super) fn aims(&self) -> &[Option<BeamMiss>] {
        let lights = 0..self.world().lights().len();
        self.aims.get_or_init(|| lights.map(|light| beam_miss(self, light)).collect())
    }

    /// Returns exposed colours of the picture. There is one for each probe or, with path tracing,
    /// the mean of a few samples for some of the probes.
    pub(super) fn exposed_colors(&self) -> &[Color] {
        &self.lit().1
    }

    fn lit(&self) -> &(Vec<usize>, Vec<Color>) {
        self.light.get_or_init(|| exposed_colors(self))
    }

    /// Iterates over the probes whose exposed colours are known, together with their colours.
    pub(super) fn lit_probes(&self) -> impl Iterator<Item = (&Probe, Color)> {
        let (probes, colors) = self.lit();
        probes.iter().zip(colors).map(|(probe, color)| (&self.probes[*probe], *color))
    }

    /// Returns true if photons may bring light that the samples of [`Self::exposed_colors`] lack.
    pub(super) fn lacks_photons(&self) -> bool {
        let focuses = |material: &Material| match material {
            Material::Phong(phong) => {
                let own = phong.principled.as_ref().map(|principled| &principled.definition);
                phong.is_entered() || own.is_some_and(|m| m.base_metalness > 0.5 || m.transmission_weight > 0.0)
            }
            Material::Mix(..) => false,
        };
        self.input.job.method.prepares() && self.world().materials().iter().any(focuses)
    }

    /// Returns true if a path-traced picture is black or nearly black.
    pub(super) fn is_dark(&self) -> bool {
        self.is_physical()
            && !self.lacks_photons()
            && !self.exposed_colors().is_empty()
            && brightest(self.exposed_colors()) < DARK
    }

    /// Returns the mesh files of the scene.
    pub(super) fn meshes(&self) -> &[MeshFile<'a>] {
        self.meshes.get_or_init(|| files(self))
    }

    /// Returns the meshes of a scene that was read from a model file.
    pub(super) fn models(&self) -> &[MeshFile<'a>] {
        self.models.get_or_init(|| models(self))
    }

    /// Returns the radiance that a material emits, before a texture is applied. It is black if the
    /// texture is black everywhere, and for a mix of materials.
    pub(super) fn radiance(&self, material: usize) -> Color {
        let world = self.world();
        let emitted = |material: &Material| {
            let Material::Phong(phong) = material else { return Color::ZERO };
            let map = phong.principled.as_ref().and_then(|own| own.maps.emission);
            let texture = map.and_then(|map| world.textures().get(map as usize));
            match &phong.emission {
                Some(emission) if !texture.is_some_and(is_black) => emission.radiance,
                _ => Color::ZERO,
            }
        };
        let all = self.radiances.get_or_init(|| world.materials().iter().map(emitted).collect());
        all.get(material).copied().unwrap_or_default()
    }

    /// Returns, for each material, the number of rays that hit it, either directly or as part of a
    /// mix.
    pub(super) fn material_rays(&self) -> &[usize] {
        self.material_rays.get_or_init(|| self.count_rays())
    }
}
