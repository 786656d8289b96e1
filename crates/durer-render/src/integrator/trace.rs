//! Trace of a camera ray, which is a tree of all terms that contribute to the ray's colour.
//!
//! An integrator reports each term to a [`TraceListener`] twice: when the term begins, together
//! with its parent node, and when its value is known. Nodes are addressed by index, so terms of
//! several rays can be in progress at the same time and end in any order. Listeners that only count
//! rays ignore the reports at no cost, whereas a [`TraceRecorder`] stores them. In every node, the
//! following formula holds:
//!
//! value = scale · (sum of factor · value over the children, in order).
//!
//! The terms of a tree add up to exactly the same bits as the picture's colour, since they are
//! summed in the integrator's order: see [`Tree::sum`]. In spectral mode, terms are radiances at
//! the wavelengths of the sample, and [`Tree::sum`] is the colour of their sum.

use crate::world::emitters::LightId;
use crate::world::{HighlightModel, SurfaceInteraction, World};
use durer_bvh::{RayCount, TraversalCounter, TraversalStats};
use durer_scene::math::{Color, Ray, Ray64, Vec2, Vec3};
use durer_scene::spectrum::{Lanes, Spectrum};
use serde::Serialize;

/// Receiver of the terms of light that an integrator reports, used to count rays or to explain the
/// colour of a pixel. The closures are called only by listeners that store terms.
pub trait TraceListener: TraversalCounter {
    /// True if the integrator should also report terms that contribute nothing.
    const LISTENS: bool = false;

    /// Sets the meaning of the lanes of all terms; the default is RGB.
    fn lanes(&mut self, _lanes: &Lanes) {}
    /// Adds a term below `parent` and returns its node. Siblings are ordered by the time at which
    /// they begin.
    fn begin(&mut self, _parent: NodeId, _kind: impl FnOnce() -> TermKind) -> NodeId {
        NodeId::NONE
    }
    /// Records the hit of a term that is a ray.
    fn hit(&mut self, _node: NodeId, _hit: impl FnOnce() -> HitRecord) {}
    /// Records the result of a term; see the fields of [`TraceNode`].
    fn end(
        &mut self,
        _node: NodeId,
        _factor: impl Into<TermValue>,
        _scale: impl Into<TermValue>,
        _value: impl Into<TermValue>,
    ) {
    }
    /// Records the transmittance `scale` of the media before a node of a path, and the node's
    /// throughput. The throughput is the product of all factors since the camera by which the
    /// node's value, or the values of its terms, contribute to the pixel.
    fn weigh(&mut self, _node: NodeId, _scale: impl Into<TermValue>, _throughput: impl Into<TermValue>) {}
    /// Receives a direction of the environment from which a path finds light.
    fn sky(&mut self, _light: impl FnOnce() -> SkyLight) {}
}

/// Light that a path finds in a direction of the environment.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct SkyLight {
    /// Direction towards the environment in world space, of any length.
    pub dir: Vec3,
    /// True if the light reaches the first vertex that scatters it in many directions without a
    /// detour. It can pass thin sheets on its way.
    pub is_direct: bool,
    /// Factor by which white light from the direction contributes to the radiance of the path, per
    /// channel.
    pub throughput: Color,
}

/// Index of a node in a trace, numbered in the order in which terms began.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct NodeId(u32);

impl NodeId {
    /// Value that means no node, returned by listeners that store nothing.
    pub const NONE: NodeId = NodeId(u32::MAX);
    /// Parent of the root term.
    pub const ROOT: NodeId = NodeId(u32::MAX - 1);
}

impl TraceListener for () {}
impl TraceListener for RayCount {}
impl TraceListener for TraversalStats {}

/// Value in a trace, which is an RGB colour or, in spectral mode, the radiances at four
/// wavelengths.
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
    /// Converts the lanes of a path's spectrum to a value.
    pub fn of(lanes: &Lanes, light: Spectrum) -> Self {
        match lanes {
            Lanes::Rgb => TermValue::Color(light.truncate()),
            Lanes::Wavelengths(_) => TermValue::Waves(light),
        }
    }

    /// Returns the value as the lanes of a path's spectrum.
    pub fn spectrum(self) -> Spectrum {
        match self {
            TermValue::Color(color) => color.extend(color.y),
            TermValue::Waves(light) => light,
        }
    }

    /// Returns the numbers of all lanes.
    pub fn numbers(&self) -> &[f32] {
        match self {
            TermValue::Color(color) => color.as_ref(),
            TermValue::Waves(light) => light.as_ref(),
        }
    }

    /// Returns true if every lane equals `number`.
    pub fn equals(&self, number: f32) -> bool {
        self.numbers().iter().all(|x| *x == number)
    }

    /// Combines two values lane by lane.
    fn zip_with(self, other: TermValue, apply: impl FnOnce(Spectrum, Spectrum) -> Spectrum) -> Self {
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
        self.zip_with(other, |a, b| a * b)
    }
}

impl std::ops::Add for TermValue {
    type Output = TermValue;
    fn add(self, other: TermValue) -> TermValue {
        self.zip_with(other, |a, b| a + b)
    }
}

/// Trace of a camera ray, which is the tree of all terms that contribute to its colour.
#[derive(Clone, Debug, PartialEq, Serialize)]
pub struct Tree {
    /// The root term.
    #[serde(flatten)]
    pub root: TraceNode,
    /// Meaning of the lanes, written to JSON only in spectral mode.
    #[serde(rename = "waves", skip_serializing_if = "Lanes::is_rgb")]
    pub lanes: Lanes,
}

impl Tree {
    /// Returns the colour of a term.
    pub fn color(&self, light: TermValue) -> Color {
        self.lanes.color(light.spectrum())
    }

    /// Computes the ray's colour from the terms. The result equals the pixel's colour bit for bit.
    ///
    /// For a path, the function adds throughput · value of each light source in the order in which
    /// the path finds them; see [`TraceNode::path_contribution`]. In such a tree, the values of
    /// rays have rounding errors. Other integrators report no throughput; in their trees, the terms
    /// of each node are summed; see [`TraceNode::sum`].
    pub fn sum(&self) -> Color {
        self.color(self.root.path_contribution().unwrap_or_else(|| self.root.sum()))
    }
}

/// Node of a trace, which is one term of the light along a ray, with its value and the terms that
/// the value consists of.
#[derive(Clone, Debug, PartialEq, Serialize)]
pub struct TraceNode {
    /// Kind of the term.
    #[serde(rename = "what")]
    pub kind: TermKind,
    /// Factor by which the value contributes to the parent node.
    pub factor: TermValue,
    /// Factor by which the sum of `terms` is multiplied.
    pub scale: TermValue,
    /// Value of the term.
    pub value: TermValue,
    /// For paths, the factor by which the values of `terms` contribute to the pixel or, if the node
    /// is a light source, the factor of its own value.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub throughput: Option<TermValue>,
    /// Terms whose sum gives the value, in order of addition. The list is empty if `kind` explains
    /// how the value is computed.
    pub terms: Vec<TraceNode>,
}

impl TraceNode {
    /// Returns the contribution of a path node to the pixel, which is the sum of throughput · value
    /// over the light sources below the node, in order. Returns `None` for integrators that report
    /// no throughput.
    pub fn path_contribution(&self) -> Option<TermValue> {
        self.throughput.map(|_| self.add_sources(TermValue::Color(Color::ZERO)))
    }

    /// Adds throughput · value of each light source below the node to `sum`, in order.
    fn add_sources(&self, sum: TermValue) -> TermValue {
        match (&self.kind, self.throughput) {
            (TermKind::Ray { .. } | TermKind::Dispersion { .. }, _) => {
                self.terms.iter().fold(sum, |sum, term| term.add_sources(sum))
            }
            (_, Some(throughput)) => sum + throughput * self.value,
            _ => sum,
        }
    }

    /// Returns the node's contribution to its parent.
    pub fn contribution(&self) -> TermValue {
        self.factor * self.value
    }

    /// Computes the sum of the terms again. Returns `value` if there are no terms.
    pub fn sum(&self) -> TermValue {
        if self.terms.is_empty() {
            return self.value;
        }
        let none = TermValue::Color(Color::ZERO);
        self.terms.iter().fold(none, |sum, term| sum + term.contribution()) * self.scale
    }
}

/// Source of a ray in a trace, which is the camera or a kind of scattering.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Serialize)]
#[serde(rename_all = "snake_case")]
pub enum RayKind {
    /// The camera.
    Camera,
    /// A mirror reflection.
    Reflected,
    /// A transmission through glass.
    Transmitted,
    /// A scattering lobe that covers many directions.
    Scattered,
}

/// Ray in a trace, which has single precision and is serializable.
#[derive(Clone, Copy, Debug, PartialEq, Serialize)]
pub struct RayRecord {
    /// Origin.
    pub origin: Vec3,
    /// Direction. In the space of a scaled object, the direction is not of unit length.
    pub dir: Vec3,
    /// Minimum value of `t` for hits.
    pub t_min: f32,
    /// Maximum value of `t` for hits; `null` in JSON if it is infinite.
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

/// Hit of a ray in a trace, with the attributes of the surface at that point.
#[derive(Clone, Debug, PartialEq, Serialize)]
pub struct HitRecord {
    /// Index of the object in the world.
    pub object: u32,
    /// Index of the triangle in a mesh; 0 for other shapes.
    pub part: u32,
    /// Distance of the hit along the ray.
    pub t: f32,
    /// Hit point.
    pub position: Vec3,
    /// Unit geometric normal.
    pub n_geo: Vec3,
    /// Unit shading normal of the surface.
    pub n_shade: Vec3,
    /// Normal used for lighting, which is `n_shade`, flipped if the back is shaded.
    pub n: Vec3,
    /// True if the ray hits the back of the surface.
    pub from_behind: bool,
    /// True if the official program leaves the back of the surface black.
    pub black: bool,
    /// Texture coordinates, if the shape has any.
    pub uv: Option<Vec2>,
    /// Barycentric coordinates; 0 for shapes other than triangles.
    pub barycentric: Vec3,
    /// The ray in object space, if the object has a transform.
    pub local: Option<RayRecord>,
    /// Index of the material.
    pub material: u32,
}

impl HitRecord {
    /// Records a hit. `n` is the normal used for lighting.
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

/// Record in a trace that explains how the direction of a ray was sampled at a path vertex.
#[derive(Clone, Copy, Debug, PartialEq, Serialize)]
pub struct Bounce {
    /// Lobe that was sampled.
    pub lobe: &'static str,
    /// Probability of choosing this lobe.
    pub probability: f32,
    /// Density of the direction per solid angle, over all lobes; 0 for a delta lobe.
    pub pdf: f32,
    /// Survival probability used for Russian roulette.
    pub survival: f32,
    /// Number of directions that the path follows from the vertex.
    pub directions: u32,
}

/// Shadow ray in a trace, from a surface to a light, with the object that it hits.
#[derive(Clone, Debug, PartialEq, Serialize)]
pub struct Shadow {
    /// The shadow ray.
    pub ray: RayRecord,
    /// Index of the first object that the ray hits and the `t` of that hit; `None` if the ray hits
    /// nothing.
    pub blocker: Option<(u32, f32)>,
    /// Fraction of the light that arrives.
    pub share: TermValue,
}

/// Kind of a term in a trace, with data that explains its value.
#[derive(Clone, Debug, PartialEq, Serialize)]
#[serde(rename_all = "snake_case", tag = "kind")]
pub enum TermKind {
    /// Radiance along a ray.
    Ray {
        /// Source of the ray: the camera or a kind of scattering.
        from: RayKind,
        /// The ray.
        ray: RayRecord,
        /// Weight of the ray in the pixel.
        weight: f32,
        /// Hit of the ray.
        hit: Option<Box<HitRecord>>,
        /// Record of how the ray's direction was sampled; `None` if the direction was not random.
        #[serde(skip_serializing_if = "Option::is_none")]
        bounce: Option<Bounce>,
    },
    /// Light that a surface emits. The factor of this term is the MIS weight.
    Emission {
        /// MIS weight.
        mis: f32,
    },
    /// Radiance of a light that was chosen by light sampling. The factor of this term is BSDF · MIS
    /// weight · visibility / (choice · pdf).
    Direct {
        /// The light.
        light: LightId,
        /// Unit direction to the light.
        to_light: Vec3,
        /// Distance to the light; `null` in JSON for lights at infinity.
        distance: f32,
        /// Probability of choosing this light.
        choice: f32,
        /// Density of the direction per steradian, or the effective density if the direction was
        /// selected from several. It is 0 for a light without extent, whose density counts as 1.
        pdf: f32,
        /// BSDF times cosine.
        bsdf: TermValue,
        /// MIS weight.
        mis: f32,
        /// The shadow ray; `None` if shadows are off.
        shadow: Option<Shadow>,
    },
    /// Light that mirrors and glass focus at this point, estimated from nearby photons. The value
    /// of this term is the estimate.
    Photons {
        /// Search radius.
        radius: f32,
        /// Number of photons that contributed.
        photons: usize,
    },
    /// Dispersion by glass. Only the hero wavelength continues, and the factor of this term makes
    /// up for the other three wavelengths.
    #[serde(rename = "one_wavelength")]
    Dispersion {
        /// Wavelength in nanometres.
        nm: f32,
    },
    /// Background or sky, as seen by rays that hit nothing.
    Sky,
    /// Ambient light. The value is the surface colour, and the factor is share · ambient light.
    Ambient {
        /// Share of the material in the mixture at this point.
        share: f32,
    },
    /// Light from one light source. The scale is the arriving light, by which diffuse + highlight
    /// is multiplied, and the factor is share · visibility.
    Light {
        /// Index of the light in the scene.
        light: usize,
        /// Unit direction to the light.
        to_light: Vec3,
        /// Distance to the light; `null` in JSON for lights at infinity.
        distance: f32,
        /// Share of the material in the mixture at this point.
        share: f32,
        /// The shadow ray; `None` if shadows are off.
        shadow: Option<Shadow>,
    },
    /// Diffuse term. The factor is max(0, N·L), and the value is the surface colour.
    Diffuse {
        /// N·L.
        cosine: f32,
    },
    /// Highlight. The factor is max(0, base)^exponent, and the value is the specular colour.
    Highlight {
        /// Name of the base, which is `N·H` or `R·L`.
        model: &'static str,
        /// Value of the base.
        base: f32,
        /// Exponent.
        exponent: f32,
    },
    /// Sum of the reflected and the transmitted light.
    Secondary {
        /// Index of refraction on the ray's side.
        here: f32,
        /// Index of refraction behind the surface.
        there: f32,
        /// Fraction of the light that is reflected, if Fresnel's equations split the light.
        fresnel: Option<f32>,
        /// True if there is total internal reflection.
        total: bool,
    },
    /// A ray that is not traced because its weight is too small.
    #[serde(rename = "cut")]
    BelowMinWeight {
        /// Weight of the ray.
        weight: f32,
    },
    /// Reflected and transmitted light that is missing because of the maximum depth.
    #[serde(rename = "spent")]
    DepthLimit,
}

impl TermKind {
    /// Returns the name of the cosine that a highlight model raises to its exponent.
    pub fn highlight(model: HighlightModel) -> &'static str {
        match model {
            HighlightModel::Blinn => "N·H",
            HighlightModel::Phong { .. } => "R·L",
        }
    }
}

/// Listener that stores all terms of a camera ray, from which it builds a [`Tree`].
#[derive(Debug, Default)]
pub struct TraceRecorder {
    /// Terms in the order in which they began, each with its parent.
    nodes: Vec<(NodeId, TraceNode)>,
    lanes: Lanes,
}

impl TraceRecorder {
    /// Builds the tree, or returns `None` if no term was reported.
    pub fn into_tree(mut self) -> Option<Tree> {
        let mut root = None;
        // Parents precede their children. In a backward pass, each node is complete when it is
        // reached, except that its children are in reverse order.
        while let Some((parent, mut node)) = self.nodes.pop() {
            node.terms.reverse();
            // The radiance along the rays of a path is known only after all its terms are known.
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

    fn begin(&mut self, parent: NodeId, kind: impl FnOnce() -> TermKind) -> NodeId {
        let [one, zero] = [Color::ONE, Color::ZERO].map(TermValue::Color);
        let node =
            TraceNode { kind: kind(), factor: one, scale: one, value: zero, throughput: None, terms: Vec::new() };
        self.nodes.push((parent, node));
        NodeId(self.nodes.len() as u32 - 1)
    }

    fn hit(&mut self, node: NodeId, hit: impl FnOnce() -> HitRecord) {
        if let Some((_, TraceNode { kind: TermKind::Ray { hit: place, .. }, .. })) = self.nodes.get_mut(node.0 as usize)
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
