//! Trace of a ray's light: the tree of all terms that contribute to it.
//!
//! An integrator reports each term to a [`TraceListener`] twice: when it begins, with its parent
//! node, and when its value is known. Nodes are addressed by index, so terms of several rays may be
//! in progress at once and end in any order. Counters ignore the reports at no cost; a
//! [`TraceRecorder`] stores them. In every node,
//!
//! value = scale · (sum of the children's factor · value, in order).
//!
//! A tree adds up to the colour of the picture bit for bit, in the integrator's order of summation:
//! see [`Tree::sum`]. In spectral mode, terms are radiances at the wavelengths of the sample, and
//! [`Tree::sum`] is the colour of their sum.

use crate::world::emitters::LightId;
use crate::world::{HighlightModel, SurfaceInteraction, World};
use durer_bvh::{RayCount, TraversalCounter, TraversalStats};
use durer_scene::math::{Color, Ray, Ray64, Vec2, Vec3};
use durer_scene::spectrum::{Lanes, Spectrum};
use serde::Serialize;

/// Receives the terms of an integrator. The closures are called only by listeners that store terms.
pub trait TraceListener: TraversalCounter {
    /// True if terms without a contribution should also be reported.
    const LISTENS: bool = false;

    /// Sets the meaning of the lanes of all terms; RGB by default.
    fn lanes(&mut self, _lanes: &Lanes) {}
    /// Adds a term below `parent` and returns its node. Siblings keep the order in which they
    /// begin.
    fn begin(&mut self, _parent: NodeId, _what: impl FnOnce() -> TermKind) -> NodeId {
        NodeId::NONE
    }
    /// Records the hit of a ray's node.
    fn hit(&mut self, _node: NodeId, _hit: impl FnOnce() -> HitRecord) {}
    /// Records the result of a term: see [`TraceNode`].
    fn end(
        &mut self,
        _node: NodeId,
        _factor: impl Into<TermValue>,
        _scale: impl Into<TermValue>,
        _value: impl Into<TermValue>,
    ) {
    }
    /// Records, for a node of a path, the transmittance `scale` of the media before it, and the
    /// throughput: the product of all factors from the camera to here, by which its value, or the
    /// values of its terms, contribute to the pixel.
    fn weigh(&mut self, _node: NodeId, _scale: impl Into<TermValue>, _throughput: impl Into<TermValue>) {}
}

/// Index of a node of a trace, in the order in which terms began.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct NodeId(u32);

impl NodeId {
    /// No node, returned by listeners that store nothing.
    pub const NONE: NodeId = NodeId(u32::MAX);
    /// Parent of the root term.
    pub const ROOT: NodeId = NodeId(u32::MAX - 1);
}

impl TraceListener for () {}
impl TraceListener for RayCount {}
impl TraceListener for TraversalStats {}

/// Value of a term: a colour, or radiances at four wavelengths.
#[derive(Clone, Copy, Debug, PartialEq, Serialize)]
#[serde(untagged)]
pub enum TermValue {
    /// Red, green and blue.
    Color(Color),
    /// Radiances at the wavelengths of the sample.
    Waves(Spectrum),
}

impl From<Color> for TermValue {
    fn from(color: Color) -> Self {
        TermValue::Color(color)
    }
}

impl TermValue {
    /// Converts the lanes of a path.
    pub fn of(lanes: &Lanes, light: Spectrum) -> Self {
        match lanes {
            Lanes::Rgb => TermValue::Color(light.truncate()),
            Lanes::Waves(_) => TermValue::Waves(light),
        }
    }

    /// Returns the value in the lanes of a path.
    pub fn spectrum(self) -> Spectrum {
        match self {
            TermValue::Color(color) => color.extend(color.y),
            TermValue::Waves(light) => light,
        }
    }

    /// Returns the numbers, by lane.
    pub fn numbers(&self) -> &[f32] {
        match self {
            TermValue::Color(color) => color.as_ref(),
            TermValue::Waves(light) => light.as_ref(),
        }
    }

    /// Returns true if every lane equals `number`.
    pub fn is(&self, number: f32) -> bool {
        self.numbers().iter().all(|x| *x == number)
    }

    fn with(self, other: TermValue, apply: impl FnOnce(Spectrum, Spectrum) -> Spectrum) -> Self {
        let both = apply(self.spectrum(), other.spectrum());
        match (self, other) {
            (TermValue::Color(_), TermValue::Color(_)) => TermValue::Color(both.truncate()),
            _ => TermValue::Waves(both),
        }
    }
}

impl std::ops::Mul for TermValue {
    type Output = TermValue;
    fn mul(self, other: TermValue) -> TermValue {
        self.with(other, |a, b| a * b)
    }
}

impl std::ops::Add for TermValue {
    type Output = TermValue;
    fn add(self, other: TermValue) -> TermValue {
        self.with(other, |a, b| a + b)
    }
}

/// The trace of a ray.
#[derive(Clone, Debug, PartialEq, Serialize)]
pub struct Tree {
    /// The root term.
    #[serde(flatten)]
    pub root: TraceNode,
    /// Meaning of the lanes; in JSON only for wavelengths.
    #[serde(rename = "waves", skip_serializing_if = "Lanes::is_rgb")]
    pub lanes: Lanes,
}

impl Tree {
    /// Returns the colour of a term.
    pub fn color(&self, light: TermValue) -> Color {
        self.lanes.color(light.spectrum())
    }

    /// Computes the colour of the ray from the terms. It equals the picture bit for bit.
    ///
    /// For a path, adds throughput · value of each source in the order in which the path finds
    /// them: [`TraceNode::added`]. In such a tree the values of rays are only as exact as rounded
    /// sums. Other integrators have no throughputs; for them, sums the terms of each node:
    /// [`TraceNode::sum`].
    pub fn sum(&self) -> Color {
        self.color(self.root.added().unwrap_or_else(|| self.root.sum()))
    }
}

/// A term: its kind, its value, and its parts.
#[derive(Clone, Debug, PartialEq, Serialize)]
pub struct TraceNode {
    /// Kind of the term.
    pub what: TermKind,
    /// Factor in the parent node.
    pub factor: TermValue,
    /// Factor of the sum of the terms below.
    pub scale: TermValue,
    /// Value of the term.
    pub value: TermValue,
    /// Factor of the terms' values in the pixel, for paths; for a source of light, the factor of
    /// its value.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub throughput: Option<TermValue>,
    /// The terms that are summed, in order of addition; empty if `what` states how the value is
    /// computed.
    pub terms: Vec<TraceNode>,
}

impl TraceNode {
    /// Returns a path node's contribution to the pixel: the sum of throughput · value over the
    /// sources of light below, in order. `None` for integrators without throughputs.
    pub fn added(&self) -> Option<TermValue> {
        self.throughput.map(|_| self.add_sources(TermValue::Color(Color::ZERO)))
    }

    fn add_sources(&self, sum: TermValue) -> TermValue {
        match (&self.what, self.throughput) {
            (TermKind::Ray { .. } | TermKind::OneWavelength { .. }, _) => {
                self.terms.iter().fold(sum, |sum, term| term.add_sources(sum))
            }
            (_, Some(throughput)) => sum + throughput * self.value,
            _ => sum,
        }
    }

    /// Returns the contribution to the parent node.
    pub fn contribution(&self) -> TermValue {
        self.factor * self.value
    }

    /// Computes the sum of the terms again; returns `value` if there are none.
    pub fn sum(&self) -> TermValue {
        if self.terms.is_empty() {
            return self.value;
        }
        let none = TermValue::Color(Color::ZERO);
        self.terms.iter().fold(none, |sum, term| sum + term.contribution()) * self.scale
    }
}

/// Origin of a ray.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Serialize)]
#[serde(rename_all = "snake_case")]
pub enum RayKind {
    /// The camera.
    Camera,
    /// A mirror reflection.
    Reflected,
    /// A transmission through glass.
    Transmitted,
    /// A lobe that scatters into many directions.
    Scattered,
}

/// A ray as plain numbers.
#[derive(Clone, Copy, Debug, PartialEq, Serialize)]
pub struct RayRecord {
    /// Origin.
    pub origin: Vec3,
    /// Direction; not unit length in the space of a scaled object.
    pub dir: Vec3,
    /// Minimum `t` of hits.
    pub t_min: f32,
    /// Maximum `t` of hits; `null` in JSON if infinite.
    pub t_max: f32,
}

impl From<&Ray64> for RayRecord {
    fn from(ray: &Ray64) -> Self {
        RayRecord::from(&ray.rounded)
    }
}

impl From<&Ray> for RayRecord {
    fn from(ray: &Ray) -> Self {
        RayRecord { origin: ray.origin, dir: ray.dir, t_min: ray.t_min, t_max: ray.t_max }
    }
}

/// A hit and its surface attributes.
#[derive(Clone, Debug, PartialEq, Serialize)]
pub struct HitRecord {
    /// Index of the object in the world.
    pub object: u32,
    /// Index of the triangle in a mesh, else 0.
    pub part: u32,
    /// Distance along the ray.
    pub t: f32,
    /// Hit point.
    pub position: Vec3,
    /// Unit geometric normal.
    pub n_geo: Vec3,
    /// Unit shading normal of the surface.
    pub n_shade: Vec3,
    /// Normal used for lighting: `n_shade`, flipped if a back is shaded.
    pub n: Vec3,
    /// True if the ray hits the back.
    pub from_behind: bool,
    /// True if an old program leaves the back black.
    pub black: bool,
    /// Texture coordinates, if the shape has any.
    pub uv: Option<Vec2>,
    /// Barycentric coordinates; 0 for shapes other than triangles.
    pub barycentric: Vec3,
    /// The ray in object space, if there is a transform.
    pub local: Option<RayRecord>,
    /// Index of the material.
    pub material: u32,
}

impl HitRecord {
    /// Records a hit; `n` is the normal used for lighting.
    pub(super) fn new(world: &World, at: &SurfaceInteraction, n: Vec3, from_behind: bool, black: bool) -> Self {
        let SurfaceInteraction { ray, hit, surface, material, .. } = at;
        let object = &world.objects()[hit.object as usize];
        HitRecord {
            object: hit.object,
            part: world.triangle(hit),
            t: hit.t,
            position: surface.position,
            n_geo: surface.n_geo,
            n_shade: surface.n_shade,
            n,
            from_behind,
            black,
            uv: surface.uv.get(),
            barycentric: surface.barycentric,
            local: object.own_ray(ray).as_ref().map(Into::into),
            material: *material,
        }
    }
}

/// Sampling of a ray's direction.
#[derive(Clone, Copy, Debug, PartialEq, Serialize)]
pub struct Bounce {
    /// Lobe that was sampled.
    pub lobe: &'static str,
    /// Probability of choosing this lobe.
    pub probability: f32,
    /// Density per solid angle over all lobes; 0 for a delta lobe.
    pub pdf: f32,
    /// Survival probability of Russian roulette.
    pub survival: f32,
    /// Number of directions followed from the vertex.
    pub directions: u32,
}

/// Occlusion between a surface and a light.
#[derive(Clone, Debug, PartialEq, Serialize)]
pub struct Shadow {
    /// The shadow ray.
    pub ray: RayRecord,
    /// Index of the first object on it and the `t` of its hit; `None` if the light is unoccluded.
    pub blocker: Option<(u32, f32)>,
    /// Share of the light that arrives.
    pub share: TermValue,
}

/// Kinds of terms.
#[derive(Clone, Debug, PartialEq, Serialize)]
#[serde(rename_all = "snake_case", tag = "kind")]
pub enum TermKind {
    /// Radiance along a ray.
    Ray {
        /// Origin of the ray.
        from: RayKind,
        /// The ray.
        ray: RayRecord,
        /// Weight of the ray in the pixel.
        weight: f32,
        /// Hit of the ray.
        hit: Option<Box<HitRecord>>,
        /// Random choice of its direction.
        #[serde(skip_serializing_if = "Option::is_none")]
        bounce: Option<Bounce>,
    },
    /// Emission of a surface; the factor is its MIS weight.
    Emission {
        /// MIS weight.
        mis: f32,
    },
    /// Radiance of a sampled light; the factor is bsdf · mis · visibility / (choice · pdf).
    Direct {
        /// The light.
        light: LightId,
        /// Unit direction to the light.
        to_light: Vec3,
        /// Distance; `null` in JSON for lights at infinity.
        distance: f32,
        /// Probability of choosing this light.
        choice: f32,
        /// Density per solid angle of the direction; 0 for a light without extent, whose density
        /// counts as 1. For a direction resampled from several, the effective density.
        pdf: f32,
        /// BSDF times cosine.
        bsdf: TermValue,
        /// MIS weight.
        mis: f32,
        /// The shadow ray; `None` if shadows are off.
        shadow: Option<Shadow>,
    },
    /// Light via mirrors and glass, estimated from nearby photons; the value is the estimate.
    Photons {
        /// Search radius.
        radius: f32,
        /// Number of photons.
        photons: usize,
    },
    /// Light refracted by dispersive glass: only the hero wavelength continues, and the factor
    /// makes up for the other three.
    OneWavelength {
        /// Wavelength in nanometres.
        nm: f32,
    },
    /// The background or sky, for rays that miss.
    Sky,
    /// Ambient light. The value is the surface's colour; the factor is share · ambient light.
    Ambient {
        /// The material's share at the point.
        share: f32,
    },
    /// Light of one source: (diffuse + highlight) · arriving light, which is the scale. The factor
    /// is share · visibility.
    Light {
        /// Index of the light in the scene.
        light: usize,
        /// Unit direction to the light.
        to_light: Vec3,
        /// Distance; `null` in JSON for lights at infinity.
        distance: f32,
        /// The material's share at the point.
        share: f32,
        /// The shadow ray; `None` if shadows are off.
        shadow: Option<Shadow>,
    },
    /// Diffuse term. The factor is max(0, N·L); the value is the surface's colour.
    Diffuse {
        /// N·L.
        cosine: f32,
    },
    /// Highlight. The factor is max(0, base)^exponent; the value is the specular colour.
    Highlight {
        /// Name of the base.
        model: &'static str,
        /// N·H or R·L.
        base: f32,
        /// Exponent.
        exponent: f32,
    },
    /// Reflected and transmitted light.
    Secondary {
        /// Index of refraction on the ray's side.
        here: f32,
        /// Index of refraction behind the surface.
        there: f32,
        /// Reflected share, if Fresnel's law splits the light.
        fresnel: Option<f32>,
        /// True for total internal reflection.
        total: bool,
    },
    /// A ray that is not traced because its weight is too small.
    Cut {
        /// Weight of the ray.
        weight: f32,
    },
    /// Reflected and transmitted light cut off by the maximum depth.
    Spent,
}

impl TermKind {
    /// Returns the name of a highlight model's base.
    pub fn highlight(model: HighlightModel) -> &'static str {
        match model {
            HighlightModel::Blinn => "N·H",
            HighlightModel::Phong { .. } => "R·L",
        }
    }
}

/// Listener that stores every term.
#[derive(Debug, Default)]
pub struct TraceRecorder {
    /// Terms in the order in which they began, each with its parent.
    nodes: Vec<(NodeId, TraceNode)>,
    lanes: Lanes,
}

impl TraceRecorder {
    /// Builds the tree; `None` if no term was reported.
    pub fn into_tree(mut self) -> Option<Tree> {
        let mut root = None;
        // Parents precede their children: going backwards, each node is complete when it is
        // reached, with its children in reverse.
        while let Some((parent, mut node)) = self.nodes.pop() {
            node.terms.reverse();
            // A path knows the radiance along its rays only at its end.
            if node.throughput.is_some() && !node.terms.is_empty() {
                node.value = node.sum();
            }
            match self.nodes.get_mut(parent.0 as usize) {
                Some((_, parent)) => parent.terms.push(node),
                None => root = Some(node),
            }
        }
        root.map(|root| Tree { root, lanes: self.lanes })
    }
}

impl TraversalCounter for TraceRecorder {
    const COUNTS_WORK: bool = false;
}

impl TraceListener for TraceRecorder {
    const LISTENS: bool = true;

    fn lanes(&mut self, lanes: &Lanes) {
        self.lanes = *lanes;
    }

    fn begin(&mut self, parent: NodeId, what: impl FnOnce() -> TermKind) -> NodeId {
        let [one, zero] = [Color::ONE, Color::ZERO].map(TermValue::Color);
        let node =
            TraceNode { what: what(), factor: one, scale: one, value: zero, throughput: None, terms: Vec::new() };
        self.nodes.push((parent, node));
        NodeId(self.nodes.len() as u32 - 1)
    }

    fn hit(&mut self, node: NodeId, hit: impl FnOnce() -> HitRecord) {
        if let Some((_, TraceNode { what: TermKind::Ray { hit: place, .. }, .. })) = self.nodes.get_mut(node.0 as usize)
        {
            *place = Some(Box::new(hit()));
        }
    }

    fn end(
        &mut self,
        node: NodeId,
        factor: impl Into<TermValue>,
        scale: impl Into<TermValue>,
        value: impl Into<TermValue>,
    ) {
        if let Some((_, node)) = self.nodes.get_mut(node.0 as usize) {
            (node.factor, node.scale, node.value) = (factor.into(), scale.into(), value.into());
        }
    }

    fn weigh(&mut self, node: NodeId, scale: impl Into<TermValue>, throughput: impl Into<TermValue>) {
        if let Some((_, node)) = self.nodes.get_mut(node.0 as usize) {
            (node.scale, node.throughput) = (scale.into(), Some(throughput.into()));
        }
    }
}
