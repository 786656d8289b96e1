//! Deviations of a student's tracer from a correct one.

use durer_scene::math::{Color, Vec2};

/// Hit that the tracer selects along a ray.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub enum HitChoice {
    /// The nearest, which is correct.
    #[default]
    Nearest,
    /// The nearest hit of the object whose nearest hit is farthest.
    FarthestObject,
    /// The last crossing of any surface.
    Last,
    /// The hit of the last object in the file.
    LastWritten,
    /// The hit of the first object in the file.
    FirstWritten,
    /// The nearest, but the far side of spheres.
    FarSpheres,
    /// `FarthestObject`, with the farthest triangle of meshes.
    FarthestTriangle,
    /// `LastWritten`, with the last triangle of meshes.
    LastTriangle,
    /// The nearest, but spheres are not hit from inside.
    NearRoots,
    /// The nearest front-facing hit; with `true`, only triangles are culled.
    Fronts(bool),
    /// The nearest object; in meshes, the first triangle in the file that is hit.
    FirstOfMesh,
    /// The nearest object; in meshes, the last triangle in the file that is hit.
    LastOfMesh,
    /// The nearest, with wrong roots of spheres.
    Roots(Roots),
    /// The nearest, with ray directions transformed like points into object space.
    MovedDirection,
}

/// Mistakes in the roots of a sphere's equation, with a = d·d and b = d·(o - center).
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Roots {
    /// (-b ± √(b² - 4 a c)) / 2a.
    FourHalf,
    /// (-b ± √(b² - 4 a c)) / a.
    FourWhole,
    /// (-b ± √(b² - a c)) / 2a.
    TwiceA,
}

/// Normal of a sphere at p.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub enum Ball {
    /// norm(p - center).
    #[default]
    Right,
    /// norm(p).
    Position,
    /// p - center.
    Long,
}

/// Transform of normals from object to world space.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub enum Normals {
    /// Inverse transpose, normalised.
    #[default]
    Right,
    /// No transform.
    Local,
    /// Inverse transpose, not normalised.
    Long,
    /// Inverse, not transposed.
    ByInverse,
}

/// Use of the ambient light.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub enum Ambient {
    /// Times the diffuse colour, once.
    #[default]
    Right,
    /// Once for each light.
    EachLight,
    /// Not multiplied by the diffuse colour.
    Bare,
}

/// Factor of a diffuse term.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub enum Cosine {
    /// max(0, N·L).
    #[default]
    Clamped,
    /// |N·L|.
    TwoSided,
    /// N·L, negative or not.
    Signed,
    /// 1.
    One,
    /// No diffuse term.
    None,
    /// max(0, N·L)².
    Squared,
    /// (N·L + 1) / 2.
    Half,
    /// 1 where N·L > 0.
    Step,
    /// max(0, N·L) / π.
    OverPi,
    /// max(0, N·V).
    View,
}

/// Half vector of Blinn's highlights.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub enum HalfVector {
    /// norm(L + V).
    #[default]
    Unit,
    /// L + V.
    Sum,
    /// (L + V) / 2.
    Mean,
}

/// Rays for which hits behind the origin count.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum BehindOrigin {
    /// Every ray.
    All,
    /// Camera rays.
    Camera,
}

/// Accumulation of the lights' contributions.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub enum LightSum {
    /// Sum, clamped at the very end.
    #[default]
    Right,
    /// Clamped to 1 after each light.
    ClampedEach,
    /// Each light's contribution is clamped to 1.
    ClampedLight,
    /// Clamped to 1 before reflected and transmitted light is added.
    ClampedLocal,
    /// Each light replaces those before it.
    LastOnly,
    /// Each light that is not in shadow replaces those before it.
    LastSeen,
    /// The greatest of the lights counts, channel by channel.
    Greatest,
    /// The greatest of the lights and the ambient light counts, channel by channel.
    GreatestOfAll,
}

/// Attenuation of light at distance d, in addition to the factors of the scene.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub enum Attenuation {
    /// Divided by the scene's polynomial.
    #[default]
    Right,
    /// Multiplied by the scene's polynomial.
    Multiplied,
    /// Divided by d.
    Linear,
    /// Divided by d².
    Square,
    /// Divided by the root of the scene's polynomial.
    Root,
    /// Divided by the scene's polynomial of d².
    SquaredTwice,
}

/// Direction to a point light.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub enum PointLightDirection {
    /// L = norm(position - p).
    #[default]
    Right,
    /// L = norm(p - position).
    Negated,
    /// L = norm(position).
    Position,
    /// L = norm(-position).
    MinusPosition,
    /// L = norm(position), and d = |position|.
    PositionAlone,
    /// L = norm(position - eye); with `true` d = |position - eye| too.
    FromEye(bool),
}

/// Direction of a reflected ray.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub enum Mirror {
    /// d - 2 (d·N) N.
    #[default]
    Right,
    /// The correct direction, negated.
    Negated,
    /// d - (d·N) N: along the surface.
    Along,
    /// d + 2 (d·N) N.
    Plus,
    /// N.
    Normal,
}

/// Direction of a transmitted ray.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub enum Glass {
    /// Snell's law.
    #[default]
    Right,
    /// Inverse ratio of indices.
    Inverted,
    /// The entering ratio also when the ray leaves.
    NotSwapped,
    /// Not refracted.
    Straight,
    /// The outward normal also when the ray leaves.
    Outward,
    /// The root added instead of subtracted.
    RootAdded,
    /// Indices exchanged, in Fresnel's law too.
    Exchanged,
    /// The normal component has the wrong sign.
    SignChanged,
    /// The root left out.
    NoRoot,
    /// η in place of η² below the root.
    Unsquared,
}

/// Fresnel term of glass.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub enum Fresnel {
    /// Schlick's approximation.
    #[default]
    Right,
    /// R0 at every angle.
    Constant,
    /// None: both rays count in full.
    None,
    /// This share is reflected at every angle.
    Share(f32),
    /// Reflected and transmitted fractions are exchanged.
    Exchanged,
    /// Schlick's approximation with the angle of the incoming ray also when it leaves glass.
    Incoming,
    /// Schlick's approximation with an R0 that is not squared.
    Unsquared,
    /// Schlick's approximation with another power than 5.
    Power(f32),
}

/// Deviations of the lights.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct LightBugs {
    /// L of directional lights is the direction as written, not negated.
    pub negated: bool,
    /// L of all lights has the wrong sign, for shadow rays too.
    pub all_negated: bool,
    /// L of directional lights is not normalised.
    pub long: bool,
    /// L of point lights is not normalised.
    pub long_points: bool,
    /// Attenuation.
    pub fading: Attenuation,
    /// Direction to point lights.
    pub points: PointLightDirection,
}

/// Deviations of highlights.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct HighlightBugs {
    /// Multiplied by max(0, N·L).
    pub times_cosine: bool,
    /// Multiplied by the diffuse colour.
    pub times_diffuse: bool,
    /// The light's colour, not multiplied by the specular colour.
    pub bare: bool,
    /// Half vector of Blinn's model.
    pub half: HalfVector,
    /// The view direction has the wrong sign.
    pub eye_negated: bool,
    /// Not multiplied by the light's colour.
    pub lightless: bool,
    /// Additional factor.
    pub factor: Option<f32>,
    /// Absolute value as the base of the power.
    pub two_sided: bool,
    /// Blinn's highlight also where N·L <= 0.
    pub everywhere: bool,
    /// Direction R of Phong's model.
    pub mirror: Mirror,
}

/// Direction of shadow rays.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub enum ShadowDirection {
    /// Towards the light.
    #[default]
    Light,
    /// Away from it.
    Away,
    /// Along the normal.
    Normal,
}

/// End of shadow rays to a point light at distance d.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub enum Reach {
    /// d.
    #[default]
    Right,
    /// 1.
    One,
    /// d²: t ends at d, for a ray direction of length d.
    Squared,
}

/// Deviations of shadow rays.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct ShadowBugs {
    /// Do not end at the light.
    pub endless: bool,
    /// No ambient light in shadow.
    pub ambient_too: bool,
    /// Start distance.
    pub epsilon: Option<f32>,
    /// Share of a light that remains in its shadow.
    pub left: f32,
    /// If one light is blocked, later ones are too.
    pub later_too: bool,
    /// If any light is blocked, ambient light is missing.
    pub ambient_of_any: bool,
    /// Only the light of this index casts shadows.
    pub only_light: Option<usize>,
    /// Transparent objects cast no shadows.
    pub no_glass: bool,
    /// Direction of shadow rays.
    pub way: ShadowDirection,
    /// Light counts where the ray hits something.
    pub inverted: bool,
    /// Rays to directional lights end at distance 1.
    pub short: bool,
    /// Highlights remain in shadow.
    pub highlights_left: bool,
    /// Diffuse light remains in shadow.
    pub diffuse_left: bool,
    /// Rays start at the eye.
    pub from_eye: bool,
    /// End of rays to point lights at distance d.
    pub reach: Reach,
    /// If one light is blocked, all direct light is missing; with `true`, also reflected and
    /// transmitted light.
    pub black: Option<bool>,
}

/// Deviations of secondary rays.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct SecondaryBugs {
    /// Reflected light counts in full.
    pub mirror_in_full: bool,
    /// Transmitted light counts in full.
    pub glass_in_full: bool,
    /// Reflected rays return nothing; the Fresnel term still applies.
    pub no_mirror: bool,
    /// Transmitted rays return nothing; the Fresnel term still applies.
    pub no_glass: bool,
    /// Direction of reflected rays.
    pub mirror: Mirror,
    /// Direction of transmitted rays.
    pub glass: Glass,
    /// Fresnel term of glass.
    pub fresnel: Fresnel,
    /// Local light is scaled by 1 minus the mirror's colour.
    pub mixed: bool,
    /// Reflected light is multiplied by the diffuse colour.
    pub times_diffuse: bool,
    /// Mirrors have no local light.
    pub instead: bool,
    /// Traced once for each light.
    pub each_light: bool,
    /// Misses return black.
    pub black_sky: bool,
    /// Directions are normalised.
    pub unit: bool,
    /// Shadows at the first hit only.
    pub unshadowed: bool,
    /// Start distance.
    pub epsilon: Option<f32>,
}

/// Deviations of a student's tracer. The default is a correct tracer.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct Bugs {
    /// Hit that is selected.
    pub pick: HitChoice,
    /// Rays for which hits behind the origin count.
    pub behind: Option<BehindOrigin>,
    /// The colour that each ray returns is clamped to 1.
    pub clamped_rays: bool,
    /// Directions are normalised in object space, so that `t` differs there.
    pub local_unit: bool,
    /// Transform of normals.
    pub normals: Normals,
    /// Interpolated mesh normals are not normalised.
    pub long_mixed: bool,
    /// Meshes have one normal per triangle.
    pub flat: bool,
    /// Triangle normals are negated.
    pub triangles_turned: bool,
    /// Sphere normals point inwards.
    pub spheres_turned: bool,
    /// Plane normals are negated.
    pub planes_turned: bool,
    /// Permutation of the vertex normals of a triangle; 0 is correct.
    pub mixed_otherwise: usize,
    /// Shading normals always face the eye.
    pub faced: bool,
    /// Ambient light.
    pub ambient: Ambient,
    /// Diffuse term.
    pub cosine: Cosine,
    /// The diffuse term lacks the surface's colour.
    pub plain_diffuse: bool,
    /// The diffuse term lacks the light's colour.
    pub diffuse_lightless: bool,
    /// Additional factor of the diffuse term.
    pub diffuse_factor: Option<f32>,
    /// The diffuse term counts the diffuse colour twice.
    pub diffuse_twice: bool,
    /// Normals of spheres.
    pub balls: Ball,
    /// Colour of camera rays that miss, and true if other rays return it too.
    pub sky: Option<(Color, bool)>,
    /// Lights.
    pub lights: LightBugs,
    /// Highlights.
    pub highlights: HighlightBugs,
    /// Shadow rays.
    pub shadows: ShadowBugs,
    /// Accumulation of lights.
    pub sum: LightSum,
    /// Secondary rays.
    pub bounces: SecondaryBugs,
}

/// Sides of a non-square picture to which the field of view applies.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub enum Aspect {
    /// As in that year's program.
    #[default]
    Right,
    /// The smaller side spans the angle.
    Smaller,
    /// The smaller side is scaled by the reciprocal of the correct factor.
    Turned,
}

/// Deviations of camera rays, in addition to the scene's rules.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct CameraBugs {
    /// Position in the pixel; (0.5, 0.5) is the centre.
    pub place: Vec2,
    /// Scale of the point in the picture.
    pub scale: f32,
    /// Treatment of non-square pictures.
    pub aspect: Aspect,
    /// Number of rays per pixel.
    pub rays: RayCount,
}

/// Number of rays per pixel.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub enum RayCount {
    /// As in the job.
    #[default]
    Right,
    /// One.
    One,
    /// A regular grid of four by four.
    Sixteen,
}

impl Default for CameraBugs {
    fn default() -> Self {
        CameraBugs { place: Vec2::splat(0.5), scale: 1.0, aspect: Aspect::Right, rays: RayCount::Right }
    }
}

impl CameraBugs {
    /// Returns the scale of picture points.
    pub fn factor(&self, width: u32, height: u32) -> Vec2 {
        let (w, h) = (width as f32, height as f32);
        let ratio = w.max(h) / w.min(h);
        let aspect = match self.aspect {
            Aspect::Right => Vec2::ONE,
            Aspect::Smaller => Vec2::splat(ratio),
            Aspect::Turned if w > h => Vec2::new(1.0, ratio * ratio),
            Aspect::Turned => Vec2::new(ratio * ratio, 1.0),
        };
        self.scale * aspect
    }
}

/// Deviations in the conversion of light to a file.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub enum OutputBug {
    /// The transfer curve, which is correct.
    #[default]
    Right,
    /// This many times the value, modulo 256.
    Wrapped(u16),
    /// Divided by the brightest value of the picture.
    Scaled,
    /// Rounded instead of truncated, or the reverse.
    OtherRounding,
    /// Raised to the reciprocal of this power; 0 means the sRGB curve.
    CurveMore(f32),
    /// c / (1 + c).
    Toned,
    /// Times this factor.
    Times(f32),
    /// 1 - c.
    Negative,
    /// Grey: 0 the mean of the channels, 1 and 2 luma of Rec. 601 and luminance, 3 the maximum, 4
    /// red, 5 green, 6 blue.
    Grey(u32),
    /// Quantised to this many levels.
    Steps(u32),
    /// Raised to this power; 0 means without the sRGB curve, or its inverse.
    CurveLess(f32),
}

/// Source of a pixel in the file.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub struct PictureTurn {
    /// Columns and rows are exchanged, in a square picture.
    pub exchange: bool,
    /// Columns run backwards.
    pub columns_back: bool,
    /// Rows run backwards.
    pub rows_back: bool,
    /// Order of the channels: 0 as they are, 1 with red and blue exchanged, then the others of
    /// [`PictureTurn::ORDERS`].
    pub channels: u8,
    /// Shift of the picture in pixels, to the right and down.
    pub moved: (i32, i32),
    /// Pixels without a source are black instead of repeating the border.
    pub black_border: bool,
    /// Pixels wrap around at the border.
    pub rolled: bool,
    /// Blocks of two by two pixels are averaged.
    pub halved: bool,
}

impl PictureTurn {
    /// Source channel of red, green and blue.
    pub const ORDERS: [[usize; 3]; 6] = [[0, 1, 2], [2, 1, 0], [0, 2, 1], [1, 0, 2], [1, 2, 0], [2, 0, 1]];

    /// Returns true if no source pixel maps to a position.
    pub fn is_empty(self, width: u32, height: u32, (x, y): (u32, u32)) -> bool {
        let out = |at: u32, by: i32, size: u32| !(0..i64::from(size)).contains(&(i64::from(at) - i64::from(by)));
        self.black_border && (out(x, self.moved.0, width) || out(y, self.moved.1, height))
    }

    /// Returns the source pixel of a position.
    pub fn source(self, width: u32, height: u32, (x, y): (u32, u32)) -> (u32, u32) {
        let x = if self.columns_back { width - 1 - x } else { x };
        let y = if self.rows_back { height - 1 - y } else { y };
        let (x, y) = if self.exchange && width == height { (y, x) } else { (x, y) };
        let from = |at: u32, by: i32, size: u32| match self.rolled {
            true => (i64::from(at) - i64::from(by)).rem_euclid(i64::from(size)) as u32,
            false => at.saturating_add_signed(-by).min(size - 1),
        };
        let (x, y) = if self.halved { (x & !1, y & !1) } else { (x, y) };
        (from(x, self.moved.0, width), from(y, self.moved.1, height))
    }
}
