//! Options of path tracing and of photon mapping.

use super::{Path, PhotonTracer};
use crate::integrator::{IntegratorContext, IntegratorOptions};
use durer_scene::describe::{Constraint, Describe, Field, FieldKind, FieldType, Value, described};
use durer_scene::dialect::{DialectSet, set};
use durer_scene::spectrum::ColorMode;
use serde::{Deserialize, Serialize};
use std::sync::Arc;

described! {
    /// path tracing: global illumination
    PathOptions ["path" in set::DURER] {
        /// Maximum brightness of one contribution (one light seen from one path vertex) after more
        /// than one scattering event; suppresses fireflies but also removes some light [default: no
        /// limit]
        clamp: Option<f32> = None, optional, Constraint::Positive, ["clamp" in set::DURER];
        /// Colour mode: rgb, or spectral, which traces four wavelengths per path, for dispersion
        /// and for coloured light on coloured surfaces [default: rgb]
        color: ColorMode = ColorMode::Rgb, optional, Constraint::Any, ["color" in set::DURER];
        /// Sampling of direct light: both (light and BSDF sampling, combined by MIS), or for
        /// comparison only lights or only bsdf (same mean, more noise) [default: both]
        direct: DirectSampling = DirectSampling::Both, optional, Constraint::Any, ["direct" in set::DURER];
    }
}

impl Copy for PathOptions {}

impl IntegratorOptions for PathOptions {
    type Integrator<'w> = Path<'w>;

    fn create(self, IntegratorContext { world, settings, cone, cancel, .. }: IntegratorContext<'_>) -> Path<'_> {
        // The footprint is needed only for mipmaps.
        let cone = cone.filter(|_| world.has_mipmaps());
        Path { cancel, cone, ..Path::new(world, settings, self) }
    }

    fn path_options(&self) -> Option<PathOptions> {
        Some(*self)
    }
}

/// Options of path tracing with photons for caustics (`--integrator photons`).
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize)]
pub struct PhotonParameters {
    /// Options of the path tracer.
    #[serde(flatten)]
    pub transport: PathOptions,
    /// Number of photons per sample.
    pub count: u32,
    /// Search radius for photons in the first sample, in world units.
    pub radius: Option<f32>,
    /// True to remove the bias to second order, which increases noise; see
    /// [`PhotonTracer::corrected`].
    pub corrected: bool,
}

impl Default for PhotonParameters {
    fn default() -> Self {
        PhotonParameters { transport: PathOptions::default(), count: 100_000, radius: None, corrected: false }
    }
}

impl Describe for PhotonParameters {
    const KEYWORDS: &'static [(&'static str, DialectSet)] = &[("photons", set::DURER)];
    const DOC: &'static str = "path tracing with a photon map for caustics";
    const FIELDS: &'static [Field] = &[
        PathOptions::FIELDS[0],
        PathOptions::FIELDS[1],
        PathOptions::FIELDS[2],
        Field {
            name: "count",
            kind: FieldKind::Int,
            required: false,
            constraint: Constraint::OneTo(100_000_000),
            keywords: &[("photons", set::DURER)],
            doc: "Photons emitted per sample [default: 100000]",
        },
        Field {
            name: "radius",
            kind: FieldKind::Float,
            required: false,
            constraint: Constraint::Positive,
            keywords: &[("photon-radius", set::DURER)],
            doc: "Search radius for photons in the first sample, in world units; it shrinks with later samples \
                  [default: one twentieth of the radius of the smallest object that reflects or refracts]",
        },
    ];

    fn get(&self, field: usize) -> Option<Value> {
        match field {
            0..3 => self.transport.get(field),
            3 => self.count.value(),
            _ => self.radius.value(),
        }
    }

    fn set(&mut self, field: usize, value: Value) {
        match field {
            0..3 => self.transport.set(field, value),
            3 => self.count = FieldType::from_value(value).unwrap_or(self.count),
            _ => self.radius = FieldType::from_value(value).unwrap_or(self.radius),
        }
    }
}

impl IntegratorOptions for PhotonParameters {
    type Integrator<'w> = Path<'w>;

    const PREPARES: bool = true;

    fn create(self, context: IntegratorContext<'_>) -> Path<'_> {
        let photons = PhotonTracer::new(context.world, context.seed, self.count, self.radius);
        let photons = if self.corrected { photons.corrected() } else { photons };
        Path { photons: Some(Arc::new(photons)), ..self.transport.create(context) }
    }

    fn path_options(&self) -> Option<PathOptions> {
        Some(self.transport)
    }
}

/// Strategy for sampling direct light from emitters with an extent, which is light sampling, BSDF
/// sampling or both. All strategies except [`DirectSampling::Center`] have the same mean and differ
/// only in noise.
///
/// Source: Veach, *Robust Monte Carlo Methods for Light Transport Simulation*, 1997, chapter 9.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Serialize, Deserialize)]
#[serde(rename_all = "snake_case")]
pub enum DirectSampling {
    /// Light sampling and BSDF sampling, combined by the power heuristic.
    #[default]
    Both,
    /// Light sampling alone. BSDF samples count only if they hit emitters that light sampling never
    /// finds.
    Lights,
    /// BSDF sampling alone. Light samples count only if they sample lights that BSDF sampling
    /// cannot hit.
    Bsdf,
    /// Light sampling as in [`DirectSampling::Lights`], but with a fixed point on each emitter,
    /// which is the centre of a sphere, disc or rectangle. With this strategy, shadows become hard.
    /// The results are biased, so it is for teaching only.
    #[serde(rename = "middle")]
    Center,
}

impl DirectSampling {
    /// Strategies that the user can choose.
    pub const CHOICES: [DirectSampling; 3] = [DirectSampling::Both, DirectSampling::Lights, DirectSampling::Bsdf];

    /// Names of [`DirectSampling::CHOICES`].
    const NAMES: [&str; 3] =
        [DirectSampling::CHOICES[0].name(), DirectSampling::CHOICES[1].name(), DirectSampling::CHOICES[2].name()];

    /// Returns the name of the strategy, as used in options.
    pub const fn name(self) -> &'static str {
        match self {
            DirectSampling::Both => "both",
            DirectSampling::Lights => "lights",
            DirectSampling::Bsdf => "bsdf",
            DirectSampling::Center => "middle",
        }
    }
}

impl FieldType for DirectSampling {
    const KIND: FieldKind = FieldKind::Word(&DirectSampling::NAMES);

    fn value(&self) -> Option<Value> {
        Some(Value::Word(self.name().into()))
    }

    fn from_value(value: Value) -> Option<Self> {
        let Value::Word(word) = value else { return None };
        DirectSampling::CHOICES.into_iter().find(|direct| direct.name() == word)
    }
}
