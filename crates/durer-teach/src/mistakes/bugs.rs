//! The mistakes that a student's tracer can make, as options of
//! [`BuggyTracer`](super::BuggyTracer).

use durer_scene::math::{Color, Vec2};

/// Which hit along a ray a student's tracer uses; only `Nearest` is correct.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub enum HitChoice {
    /// The nearest hit, which is correct.
    #[default]
    Nearest,
    /// The nearest hit of the object whose nearest hit is farthest away.
    FarthestObject,
    /// The last intersection with any surface.
    Last,
    /// The hit of the object that is last in the file.
    LastInFile,
    /// The hit of the object that is first in the file.
    FirstInFile,
    /// The nearest hit, but with the far side of spheres.
    FarSpheres,
    /// `FarthestObject`, but with the farthest triangle of meshes.
    FarthestTriangle,
    /// `LastInFile`, but with the last triangle of meshes.
    LastTriangle,
    /// The nearest hit, except that spheres are not hit from inside.
    NearRoots,
    /// The nearest front-facing hit; with `true`, only triangles are culled.
    Fronts(bool),
    /// The hit of the nearest object; for a mesh, the first triangle in the file that is hit.
    FirstOfMesh,
    /// The hit of the nearest object; for a mesh, the last triangle in the file that is hit.
    LastOfMesh,
    /// The nearest hit, with wrong roots for spheres.
    Roots(Roots),
    /// The nearest hit, with ray directions transformed to object space like points.
    MovedDirection,
}

/// Wrong formulas for the roots in ray-sphere intersection, with a = d·d and b = d·(o - center).
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Roots {
    /// (-b ± √(b² - 4 a c)) / 2a.
    FourHalf,
    /// (-b ± √(b² - 4 a c)) / a.
    FourWhole,
    /// (-b ± √(b² - a c)) / 2a.
    TwiceA,
}

/// Formula for the normal of a sphere at a point p.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub enum SphereNormal {
    /// norm(p - center), which is correct.
    #[default]
    Correct,
    /// norm(p).
    Position,
    /// p - center.
    Long,
}

/// How a student's tracer transforms normals from object to world space.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub enum Normals {
    /// Inverse transpose, normalised, which is correct.
    #[default]
    Correct,
    /// No transform.
    Local,
    /// Inverse transpose, not normalised.
    Long,
    /// Inverse, not transposed.
    ByInverse,
}

/// How a student's tracer adds the ambient light.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub enum Ambient {
    /// Multiplied by the diffuse colour and added once, which is correct.
    #[default]
    Correct,
    /// Added once for each light.
    EachLight,
    /// Not multiplied by the diffuse colour.
    Bare,
}

/// Cosine factor of the diffuse term in a student's tracer.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub enum Cosine {
    /// max(0, N·L), which is correct.
    #[default]
    Clamped,
    /// |N·L|.
    TwoSided,
    /// N·L, without clamping.
    Signed,
    /// 1, independent of the direction.
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

/// How a student's tracer computes the half vector of Blinn's highlights.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub enum HalfVector {
    /// norm(L + V), which is correct.
    #[default]
    Unit,
    /// L + V.
    Sum,
    /// (L + V) / 2.
    Mean,
}

/// Rays for which a student's tracer accepts hits behind the origin.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum BehindOrigin {
    /// Every ray.
    All,
    /// Camera rays.
    Camera,
}

/// How a student's tracer adds up the contributions of the lights.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub enum LightSum {
    /// Sum, clamped only when the pixel is written, which is correct.
    #[default]
    Correct,
    /// The sum is clamped to 1 after each light.
    ClampedEach,
    /// Each light's contribution is clamped to 1.
    ClampedLight,
    /// The sum is clamped to 1 before reflected and transmitted light is added.
    ClampedLocal,
    /// Each light replaces the previous ones.
    LastOnly,
    /// Each light that is not in shadow replaces the previous ones.
    LastUnoccluded,
    /// Maximum of the lights, for each channel.
    Greatest,
    /// Maximum of the lights and the ambient light, for each channel.
    GreatestOfAll,
}

/// How a student's tracer attenuates a point light at distance d.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub enum Attenuation {
    /// Divided by the scene's polynomial, which is correct.
    #[default]
    Correct,
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

/// How a student's tracer computes the direction L to a point light, and sometimes the distance d.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub enum PointLightDirection {
    /// L = norm(position - p), which is correct.
    #[default]
    Correct,
    /// L = norm(p - position).
    Negated,
    /// L = norm(position).
    Position,
    /// L = norm(-position).
    MinusPosition,
    /// L = norm(position), and d = |position|.
    PositionAlone,
    /// L = norm(position - eye); with `true`, also d = |position - eye|.
    FromEye(bool),
}

/// How a student's tracer computes the direction of a reflected ray.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub enum Mirror {
    /// d - 2 (d·N) N, which is correct.
    #[default]
    Correct,
    /// The correct direction, negated.
    Negated,
    /// d - (d·N) N: along the surface.
    Along,
    /// d + 2 (d·N) N.
    Plus,
    /// N.
    Normal,
}

/// How a student's tracer computes the direction of a transmitted ray.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub enum Glass {
    /// Snell's law, which is correct.
    #[default]
    Correct,
    /// The ratio of the indices is inverted.
    Inverted,
    /// The ratio for entering is also used when the ray leaves.
    IndicesNotSwapped,
    /// The ray is not refracted.
    Straight,
    /// The outward normal is also used when the ray leaves.
    Outward,
    /// The root is added instead of subtracted.
    RootAdded,
    /// The indices are exchanged, also in Fresnel's law.
    Exchanged,
    /// The component along the normal has the wrong sign.
    SignChanged,
    /// The root is left out.
    NoRoot,
    /// η replaces η² below the root.
    Unsquared,
}

/// Fresnel term of glass in a student's tracer.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub enum Fresnel {
    /// Schlick's approximation, which is correct.
    #[default]
    Correct,
    /// R0 at every angle.
    Constant,
    /// None: the reflected and the transmitted ray both have weight 1.
    None,
    /// This fraction is reflected at every angle.
    Share(f32),
    /// Reflected and transmitted fractions are exchanged.
    Exchanged,
    /// Schlick's approximation with the angle of the incoming ray even when it leaves the glass.
    Incoming,
    /// Schlick's approximation with R0 not squared.
    Unsquared,
    /// Schlick's approximation with this power instead of 5.
    Power(f32),
}

/// Mistakes in the direction and attenuation of lights.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct LightBugs {
    /// L of directional lights is the direction from the file, not its negative.
    pub negated: bool,
    /// L of all lights has the wrong sign, also for shadow rays.
    pub all_negated: bool,
    /// L of directional lights is not normalised.
    pub long: bool,
    /// L of point lights is not normalised.
    pub long_points: bool,
    /// Attenuation of point lights.
    pub attenuation: Attenuation,
    /// Direction to point lights.
    pub points: PointLightDirection,
}

/// Mistakes in the highlights of Blinn's and Phong's models.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct HighlightBugs {
    /// The highlight is multiplied by max(0, N·L).
    pub times_cosine: bool,
    /// The highlight is multiplied by the diffuse colour.
    pub times_diffuse: bool,
    /// The highlight has the light's colour: it is not multiplied by the specular colour.
    pub bare: bool,
    /// Half vector of Blinn's model.
    pub half: HalfVector,
    /// The view direction has the wrong sign.
    pub eye_negated: bool,
    /// The highlight is not multiplied by the light's colour.
    pub lightless: bool,
    /// The highlight is multiplied by this factor.
    pub factor: Option<f32>,
    /// The base of the power is an absolute value.
    pub two_sided: bool,
    /// Blinn's highlight is also added where N·L <= 0.
    pub everywhere: bool,
    /// Direction R in Phong's model.
    pub mirror: Mirror,
}

/// Direction of the shadow rays in a student's tracer.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub enum ShadowDirection {
    /// Towards the light, which is correct.
    #[default]
    Light,
    /// Away from the light.
    Away,
    /// Along the surface normal.
    Normal,
}

/// End of the shadow rays in a student's tracer, for a point light at distance d.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub enum ShadowRayEnd {
    /// At d, which is correct.
    #[default]
    Correct,
    /// At 1.
    One,
    /// At d²: `t` ends at d although the ray direction has length d.
    Squared,
}

/// Mistakes in shadow rays, and in the light that remains in shadow.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct ShadowBugs {
    /// Shadow rays do not end at the light.
    pub endless: bool,
    /// Ambient light is missing in shadow.
    pub ambient_too: bool,
    /// Start distance of shadow rays, if different.
    pub epsilon: Option<f32>,
    /// Fraction of a light that remains in its shadow.
    pub remaining_light: f32,
    /// If one light is blocked, all later lights are missing too.
    pub later_too: bool,
    /// If any light is blocked, the ambient light is missing.
    pub ambient_of_any: bool,
    /// Only the light with this index casts shadows.
    pub only_light: Option<usize>,
    /// Transparent objects cast no shadows.
    pub no_glass: bool,
    /// Direction of shadow rays.
    pub direction: ShadowDirection,
    /// A light contributes where it is blocked, instead of where it is visible.
    pub inverted: bool,
    /// Shadow rays to directional lights end at distance 1.
    pub short: bool,
    /// Highlights remain in shadow.
    pub highlights_left: bool,
    /// Diffuse light remains in shadow.
    pub diffuse_left: bool,
    /// Shadow rays start at the eye.
    pub from_eye: bool,
    /// End of the shadow rays to point lights.
    pub ray_end: ShadowRayEnd,
    /// If one light is blocked, all direct light is missing; with `true`, also reflected and
    /// transmitted light.
    pub black: Option<bool>,
}

/// Mistakes in reflected and transmitted rays.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct SecondaryBugs {
    /// Reflected light is not multiplied by the mirror's colour.
    pub mirror_in_full: bool,
    /// Transmitted light is not multiplied by the glass's colour.
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
    /// Secondary rays are traced once for each light.
    pub each_light: bool,
    /// Secondary rays that miss return black.
    pub black_sky: bool,
    /// Directions of secondary rays are normalised.
    pub unit: bool,
    /// Only the first hit of a camera ray has shadows.
    pub unshadowed: bool,
    /// Start distance of secondary rays, if different.
    pub epsilon: Option<f32>,
}

/// The mistakes of a student's tracer ([`BuggyTracer`](super::BuggyTracer)). The default is a
/// correct tracer.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct Bugs {
    /// The hit that is used along a ray.
    pub hit_choice: HitChoice,
    /// Rays for which hits behind the origin count, if any.
    pub behind: Option<BehindOrigin>,
    /// The colour that each ray returns is clamped to 1.
    pub clamped_rays: bool,
    /// Ray directions are normalised in object space, so that `t` differs there.
    pub local_unit: bool,
    /// Transform of normals.
    pub normals: Normals,
    /// Interpolated vertex normals are not normalised.
    pub unnormalized_mesh_normals: bool,
    /// Meshes are shaded with one normal per triangle.
    pub flat: bool,
    /// Triangle normals are negated.
    pub triangles_turned: bool,
    /// Sphere normals point inwards.
    pub spheres_turned: bool,
    /// Plane normals are negated.
    pub planes_turned: bool,
    /// Permutation of the vertex normals of a triangle; 0 is the correct order.
    pub normal_permutation: usize,
    /// Shading normals are flipped to face the eye.
    pub faced: bool,
    /// How ambient light is added.
    pub ambient: Ambient,
    /// Cosine factor of the diffuse term.
    pub cosine: Cosine,
    /// The diffuse term is not multiplied by the surface's colour.
    pub plain_diffuse: bool,
    /// The diffuse term is not multiplied by the light's colour.
    pub diffuse_lightless: bool,
    /// Factor by which the diffuse term is multiplied.
    pub diffuse_factor: Option<f32>,
    /// The diffuse term is multiplied by the diffuse colour twice.
    pub diffuse_twice: bool,
    /// Normals of spheres.
    pub sphere_normals: SphereNormal,
    /// Colour of camera rays that miss; with `true`, other rays return it too.
    pub sky: Option<(Color, bool)>,
    /// Mistakes in lights.
    pub lights: LightBugs,
    /// Mistakes in highlights.
    pub highlights: HighlightBugs,
    /// Mistakes in shadow rays.
    pub shadows: ShadowBugs,
    /// How the contributions of the lights are added up.
    pub sum: LightSum,
    /// Mistakes in reflected and transmitted rays.
    pub bounces: SecondaryBugs,
}

/// Which side of a non-square picture a student's camera applies the field of view to.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub enum Aspect {
    /// The side that the dialect's program uses.
    #[default]
    Correct,
    /// The smaller side spans the field of view.
    Smaller,
    /// The smaller side is scaled by the reciprocal of the correct factor.
    Turned,
}

/// Mistakes in the generation of camera rays, in addition to the quirks of the scene's dialect.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct CameraBugs {
    /// Position of the sample in the pixel; (0.5, 0.5) is the centre.
    pub sample_position: Vec2,
    /// Factor for the position on the picture plane.
    pub scale: f32,
    /// How the field of view applies to non-square pictures.
    pub aspect: Aspect,
    /// Number of rays per pixel.
    pub rays: RayCount,
}

/// Number of camera rays per pixel in a student's tracer.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub enum RayCount {
    /// The number set in the job.
    #[default]
    Correct,
    /// One ray through the centre.
    One,
    /// A regular grid of 4 by 4 rays.
    Sixteen,
}

impl Default for CameraBugs {
    fn default() -> Self {
        CameraBugs { sample_position: Vec2::splat(0.5), scale: 1.0, aspect: Aspect::Correct, rays: RayCount::Correct }
    }
}

impl CameraBugs {
    /// Returns the factors for positions on the picture plane, for each axis.
    pub fn factor(&self, width: u32, height: u32) -> Vec2 {
        let (w, h) = (width as f32, height as f32);
        let ratio = w.max(h) / w.min(h);
        let aspect = match self.aspect {
            Aspect::Correct => Vec2::ONE,
            Aspect::Smaller => Vec2::splat(ratio),
            Aspect::Turned if w > h => Vec2::new(1.0, ratio * ratio),
            Aspect::Turned => Vec2::new(ratio * ratio, 1.0),
        };
        self.scale * aspect
    }
}

/// Mistakes in converting radiance to the eight-bit values of a file.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub enum OutputBug {
    /// None: the transfer curve is correct.
    #[default]
    Correct,
    /// The value times this number, modulo 256.
    Wrapped(u16),
    /// Divided by the brightest value in the picture.
    Scaled,
    /// Rounded instead of truncated, or the reverse.
    OtherRounding,
    /// Raised to the reciprocal of this power; 0 stands for the sRGB curve.
    ExtraCurve(f32),
    /// c / (1 + c).
    Toned,
    /// Multiplied by this factor.
    Times(f32),
    /// 1 - c.
    Negative,
    /// Grey: 0 is the mean of the channels, 1 the luma of Rec. 601, 2 the luminance, 3 the maximum,
    /// 4 red, 5 green, 6 blue.
    Grey(u32),
    /// Quantised to this many levels.
    Steps(u32),
    /// Raised to this power; 0 stands for omitting the sRGB curve, or applying its inverse.
    MissingCurve(f32),
}

/// How a student's program rearranges the pixels and channels of a picture, for example by
/// mirroring it.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub struct PixelOrder {
    /// Columns and rows are exchanged, if the picture is square.
    pub exchange: bool,
    /// The order of the columns is reversed.
    pub columns_back: bool,
    /// The order of the rows is reversed.
    pub rows_back: bool,
    /// Order of the channels, as an index into [`PixelOrder::ORDERS`]: 0 is unchanged, 1 exchanges
    /// red and blue.
    pub channels: u8,
    /// Shift of the picture in pixels, to the right and down.
    pub moved: (i32, i32),
    /// Pixels without a source are black instead of repeating the border.
    pub black_border: bool,
    /// Pixels that leave the picture on one side enter it on the other.
    pub rolled: bool,
    /// Blocks of 2 by 2 pixels have the same value.
    pub halved: bool,
}

impl PixelOrder {
    /// Source channels of red, green and blue, for each order.
    pub const ORDERS: [[usize; 3]; 6] = [[0, 1, 2], [2, 1, 0], [0, 2, 1], [1, 0, 2], [1, 2, 0], [2, 0, 1]];

    /// Returns true if the pixel at a position has no source and is black.
    pub fn is_empty(self, width: u32, height: u32, (x, y): (u32, u32)) -> bool {
        let out = |at: u32, by: i32, size: u32| !(0..i64::from(size)).contains(&(i64::from(at) - i64::from(by)));
        self.black_border && (out(x, self.moved.0, width) || out(y, self.moved.1, height))
    }

    /// Returns the source of the pixel at a position.
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
