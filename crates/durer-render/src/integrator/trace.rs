//! An account of a ray's light: the tree of everything that made it.
//!
//! An integrator reports each term to a [`TraceListener`] twice: when it begins, with the node that
//! it belongs to, and when its value is known. Nodes are addressed by number, so terms of several
//! rays may be under way at once and end in any order. Counters ignore all of it at no cost; a
//! [`TraceRecorder`] keeps it. In every node,
//!
//! value = scale · (sum of the children's factor · value, in order).
//!
//! A tree adds up to the colour of the picture bit for bit, in the order in which the integrator
//! sums: see [`Tree::sum`]. In spectral mode, terms are the light at the wavelengths of the sample,
//! and [`Tree::sum`] is the colour of their sum.

use crate::world::emitters::LightId;
use crate::world::{HighlightModel, Interaction, World};
use durer_bvh::{RayCount, TraversalCounter, TraversalStats};
use durer_scene::math::{Color, Ray, Ray64, Vec2, Vec3};
use durer_scene::spectrum::{Lanes, Spectrum};
use serde::Serialize;

/// Hears what an integrator does. The closures are called only by those that listen.
pub trait TraceListener: TraversalCounter {
    /// Whether it wants to be told of terms that come to nothing too.
    const LISTENS: bool = false;

    /// What the lanes of all terms are; where it is not told, they are colours.
    fn lanes(&mut self, _lanes: &Lanes) {}
    /// Adds a term below `parent` and returns its node. Siblings keep the order in which they begin.
    fn begin(&mut self, _parent: NodeId, _what: impl FnOnce() -> TermKind) -> NodeId {
        NodeId::NONE
    }
    /// Records the hit of a ray's node.
    fn hit(&mut self, _node: NodeId, _hit: impl FnOnce() -> HitRecord) {}
    /// Records what became of a term: see [`TraceNode`].
    fn end(
        &mut self,
        _node: NodeId,
        _factor: impl Into<TermValue>,
        _scale: impl Into<TermValue>,
        _value: impl Into<TermValue>,
    ) {
    }
    /// Records, for a node of a path, the fraction `scale` of its light that the way through media
    /// leaves, and the throughput: the product of all factors from the camera to here, by which the
    /// values of its terms, or its own, count in the pixel.
    fn weigh(&mut self, _node: NodeId, _scale: impl Into<TermValue>, _throughput: impl Into<TermValue>) {}
}

/// Number of a node of a trace, in the order in which terms began.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct NodeId(u32);

impl NodeId {
    /// No node: what listeners return that keep nothing.
    pub const NONE: NodeId = NodeId(u32::MAX);
    /// Parent of the term that all others belong to.
    pub const ROOT: NodeId = NodeId(u32::MAX - 1);
}

impl TraceListener for () {}
impl TraceListener for RayCount {}
impl TraceListener for TraversalStats {}

/// What a term is: a colour, or light at four wavelengths.
#[derive(Clone, Copy, Debug, PartialEq, Serialize)]
#[serde(untagged)]
pub enum TermValue {
    /// Red, green and blue.
    Color(Color),
    /// At the wavelengths of the sample.
    Waves(Spectrum),
}

impl From<Color> for TermValue {
    fn from(color: Color) -> Self {
        TermValue::Color(color)
    }
}

impl TermValue {
    /// Light in the lanes of a path.
    pub fn of(lanes: &Lanes, light: Spectrum) -> Self {
        match lanes {
            Lanes::Rgb => TermValue::Color(light.truncate()),
            Lanes::Waves(_) => TermValue::Waves(light),
        }
    }

    /// As the lanes of a path have it.
    pub fn spectrum(self) -> Spectrum {
        match self {
            TermValue::Color(color) => color.extend(color.y),
            TermValue::Waves(light) => light,
        }
    }

    /// Its numbers, by lane.
    pub fn numbers(&self) -> &[f32] {
        match self {
            TermValue::Color(color) => color.as_ref(),
            TermValue::Waves(light) => light.as_ref(),
        }
    }

    /// Whether all of it is this number.
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

/// All light along a ray.
#[derive(Clone, Debug, PartialEq, Serialize)]
pub struct Tree {
    /// The term that all others belong to.
    #[serde(flatten)]
    pub root: TraceNode,
    /// What its terms are; in JSON only if they are light at wavelengths.
    #[serde(rename = "waves", skip_serializing_if = "Lanes::is_rgb")]
    pub lanes: Lanes,
}

impl Tree {
    /// The colour that a term is.
    pub fn color(&self, light: TermValue) -> Color {
        self.lanes.color(light.spectrum())
    }

    /// Colour of the ray, computed again from the terms. It has the bits of the picture.
    ///
    /// A path adds throughput · value of each source in the order in which it finds them, and so
    /// does this: [`TraceNode::added`]. In such a tree the values of rays are only as exact as the
    /// rounding of sums. Other integrators have no throughputs, and sum the terms of each node:
    /// [`TraceNode::sum`].
    pub fn sum(&self) -> Color {
        self.color(self.root.added().unwrap_or_else(|| self.root.sum()))
    }
}

/// A term: what it is, how it counts, and of what it is made.
#[derive(Clone, Debug, PartialEq, Serialize)]
pub struct TraceNode {
    /// What it is.
    pub what: TermKind,
    /// What it is multiplied by in the node above.
    pub factor: TermValue,
    /// What the sum of the terms below is multiplied by.
    pub scale: TermValue,
    /// What comes of it.
    pub value: TermValue,
    /// Of a path: what the values of its terms are multiplied by in the pixel, or its own if it is
    /// a source of light.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub throughput: Option<TermValue>,
    /// The terms that it is the sum of, in the order of addition; none where `what` itself says how
    /// it is computed.
    pub terms: Vec<TraceNode>,
}

impl TraceNode {
    /// What a node of a path adds to the pixel: the sum of throughput · value over the sources of
    /// light below, in order. `None` for integrators without throughputs.
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

    /// What the node adds to the one above.
    pub fn contribution(&self) -> TermValue {
        self.factor * self.value
    }

    /// The sum that `value` is, computed anew from the terms; `value` itself where there are none.
    pub fn sum(&self) -> TermValue {
        if self.terms.is_empty() {
            return self.value;
        }
        let none = TermValue::Color(Color::ZERO);
        self.terms.iter().fold(none, |sum, term| sum + term.contribution()) * self.scale
    }
}

/// What sent a ray out.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Serialize)]
#[serde(rename_all = "snake_case")]
pub enum RayKind {
    /// The camera.
    Camera,
    /// A mirror.
    Reflected,
    /// Glass.
    Transmitted,
    /// A surface that scatters light into many directions.
    Scattered,
}

/// A ray as numbers.
#[derive(Clone, Copy, Debug, PartialEq, Serialize)]
pub struct RayRecord {
    /// Where it begins.
    pub origin: Vec3,
    /// Its direction; not of length 1 in the space of an object that was scaled.
    pub dir: Vec3,
    /// Hits count from this `t` on.
    pub t_min: f32,
    /// Hits count up to this `t`; `null` in JSON where there is no end.
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

/// What a ray hit, and how the surface is there.
#[derive(Clone, Debug, PartialEq, Serialize)]
pub struct HitRecord {
    /// Number of the object in the world.
    pub object: u32,
    /// Number of the triangle in a mesh, else 0.
    pub part: u32,
    /// Position along the ray.
    pub t: f32,
    /// The point.
    pub position: Vec3,
    /// Unit normal of the true surface.
    pub n_geo: Vec3,
    /// Unit normal for shading, as the surface has it.
    pub n_shade: Vec3,
    /// The normal that light is reckoned with: `n_shade`, turned where a surface is shaded from
    /// behind.
    pub n: Vec3,
    /// Whether the surface is seen from behind.
    pub from_behind: bool,
    /// Whether its back is left black, as an old program has it.
    pub black: bool,
    /// Texture coordinates, if the shape has any.
    pub uv: Option<Vec2>,
    /// Barycentric coordinates; 0 on what is no triangle.
    pub barycentric: Vec3,
    /// The ray in the object's own space, where a transform applies.
    pub local: Option<RayRecord>,
    /// Numbers of the materials that make up the point, with their shares.
    pub material: u32,
}

impl HitRecord {
    /// Of a hit, of which `n` is the normal that light is reckoned with.
    pub(super) fn new(world: &World, at: &Interaction, n: Vec3, from_behind: bool, black: bool) -> Self {
        let Interaction { ray, hit, surface, material, .. } = at;
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

/// How a ray's direction was chosen.
#[derive(Clone, Copy, Debug, PartialEq, Serialize)]
pub struct Bounce {
    /// The lobe that chose it.
    pub lobe: &'static str,
    /// The probability with which that lobe was chosen.
    pub probability: f32,
    /// The density per solid angle over all lobes; 0 for a single direction.
    pub pdf: f32,
    /// The probability that the path went on here.
    pub survival: f32,
    /// How many directions were followed from there; each brings its part.
    pub directions: u32,
}

/// What stands between a surface and a light.
#[derive(Clone, Debug, PartialEq, Serialize)]
pub struct Shadow {
    /// The ray to the light.
    pub ray: RayRecord,
    /// Number of the first object on it and the `t` of its hit; none where the light is free.
    pub blocker: Option<(u32, f32)>,
    /// The share of the light that comes through.
    pub share: TermValue,
}

/// One kind of term.
#[derive(Clone, Debug, PartialEq, Serialize)]
#[serde(rename_all = "snake_case", tag = "kind")]
pub enum TermKind {
    /// The light that comes along a ray.
    Ray {
        /// What sent it out.
        from: RayKind,
        /// The ray.
        ray: RayRecord,
        /// How much it counts for in the pixel.
        weight: f32,
        /// What it hit.
        hit: Option<Box<HitRecord>>,
        /// How its direction was chosen at random.
        #[serde(skip_serializing_if = "Option::is_none")]
        bounce: Option<Bounce>,
    },
    /// A surface's own light, the value; the factor is its weight beside that of being chosen as a
    /// light.
    Emission {
        /// That weight, by multiple importance sampling.
        mis: f32,
    },
    /// The light of one that was chosen at random, the value; the factor is bsdf · mis · what comes
    /// through / (choice · density).
    Direct {
        /// Which it is.
        light: LightId,
        /// Unit vector to it.
        to_light: Vec3,
        /// How far it is; `null` in JSON for what has no place.
        distance: f32,
        /// The probability with which it was chosen.
        choice: f32,
        /// The density per solid angle of the direction; 0 for a light without extent, whose
        /// density counts as 1. Where it was taken of several to the surroundings, what counts as
        /// its density.
        pdf: f32,
        /// The surface's value times the cosine.
        bsdf: TermValue,
        /// Its weight beside that of being met by chance, by multiple importance sampling.
        mis: f32,
        /// The shadow ray; none where shadows are off.
        shadow: Option<Shadow>,
    },
    /// The light of lamps over mirrors and glass, from photons nearby; the value says how much.
    Photons {
        /// How far away they are at most.
        radius: f32,
        /// How many there are.
        photons: usize,
    },
    /// What glass scatters that spreads colours: the other wavelengths go elsewhere, and the first
    /// counts for all four, by the factor.
    OneWavelength {
        /// That wavelength in nanometres.
        nm: f32,
    },
    /// The background or sky, where a ray hits nothing.
    Sky,
    /// Ambient light times the surface's colour, the value; the factor is share · ambient light.
    Ambient {
        /// The material's share in the point.
        share: f32,
    },
    /// The light of one lamp: (diffuse + highlight) · what arrives, which is the scale. The factor
    /// is share · what comes through.
    Light {
        /// Number of the light in the scene.
        light: usize,
        /// Unit vector to it.
        to_light: Vec3,
        /// How far it is; `null` in JSON for a light without a place.
        distance: f32,
        /// The material's share in the point.
        share: f32,
        /// The shadow ray; none where shadows are off.
        shadow: Option<Shadow>,
    },
    /// max(0, N·L), the factor, times the surface's colour, the value.
    Diffuse {
        /// N·L.
        cosine: f32,
    },
    /// max(0, base)^exponent, the factor, times the specular colour, the value.
    Highlight {
        /// Which base it has.
        model: &'static str,
        /// N·H or R·L.
        base: f32,
        /// How sharp it is.
        exponent: f32,
    },
    /// Mirrored and transmitted light.
    Secondary {
        /// Index of refraction on the ray's side.
        here: f32,
        /// Index of refraction behind the surface.
        there: f32,
        /// The mirrored share, where Fresnel's law divides the light.
        fresnel: Option<f32>,
        /// Whether no light gets through, by total reflection.
        total: bool,
    },
    /// A ray that counts for too little to be traced.
    Cut {
        /// What it would count for.
        weight: f32,
    },
    /// Mirrored and transmitted light, of which no more levels are wanted.
    Spent,
}

impl TermKind {
    /// A name for a model of highlights.
    pub fn highlight(model: HighlightModel) -> &'static str {
        match model {
            HighlightModel::Blinn => "N·H",
            HighlightModel::Phong { .. } => "R·L",
        }
    }
}

/// Listener that keeps every term.
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
        // A parent comes before its children: from the end on, each node is complete when its turn
        // comes, with its children in reverse.
        while let Some((parent, mut node)) = self.nodes.pop() {
            node.terms.reverse();
            // A path ends before anyone knows the light along its rays.
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
