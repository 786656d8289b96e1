//! The mistakes that a student's tracer can make, given as options of
//! [`BuggyTracer`](super::BuggyTracer).

use durer_scene::math::{Color, Vec2};

/// Hit along a ray that a student's tracer uses. Only `Nearest` is correct.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub enum HitChoice {
    /// The nearest hit, which is correct.
    #[default]
    Nearest,
    /// The nearest hit of one object, which is the object whose nearest hit is farthest away.
    FarthestObject,
    /// The last intersection with any surface.
    Last,
    /// The hit of the object that comes last in the file.
    LastInFile,
    /// The hit of the object that comes first in the file.
    FirstInFile,
    /// The nearest hit, but with the far side of spheres.
    FarSpheres,
    /// The hit of `FarthestObject`, but with the farthest triangle of meshes.
    FarthestTriangle,
    /// The hit of `LastInFile`, but with the last triangle of meshes.
    LastTriangle,
    /// The nearest hit, except that spheres are not hit from inside.
    NearRoots,
    /// The nearest front-facing hit. With `true`, only triangles are culled.
    Fronts(bool),
    /// The hit of the nearest object. For a mesh, this is the first triangle in the file that is
    /// hit.
    FirstOfMesh,
    /// The hit of the nearest object. For a mesh, this is the last triangle in the file that is
    /// hit.
    LastOfMesh,
    /// The nearest hit, with wrong roots for spheres.
    Roots(Roots),
    /// The nearest hit, with ray directions transformed to object space as if they were points.
    MovedDirection,
}

/// Wrong formulas for the roots in ray-sphere intersection, with a = d·d and b = d·(o - center).
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Roots {
    /// The roots are (-b ± √(b² - 4 a c)) / 2a.
    FourHalf,
    /// The roots are (-b ± √(b² - 4 a c)) / a.
    FourWhole,
    /// The roots are (-b ± √(b² - a c)) / 2a.
    TwiceA,
}

/// Formula for the normal of a sphere at a point p.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub enum SphereNormal {
    /// The normal is norm(p - center), which is correct.
    #[default]
    Correct,
    /// The normal is norm(p).
    Position,
    /// The normal is p - center.
    Long,
}

/// Method by which a student's tracer transforms normals from object to world space.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub enum Normals {
    /// The matrix is the inverse transpose, and the result is normalised, which is correct.
    #[default]
    Correct,
    /// The normals are not transformed.
    Local,
    /// The matrix is the inverse transpose, but the result is not normalised.
    Long,
    /// The matrix is the inverse, but it is not transposed.
    ByInverse,
}

/// Method by which a student's tracer adds the ambient light.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub enum Ambient {
    /// It is multiplied by the diffuse colour and added once, which is correct.
    #[default]
    Correct,
    /// It is added once for each light.
    EachLight,
    /// It is not multiplied by the diffuse colour.
    Bare,
}

/// Cosine factor of the diffuse term in a student's tracer.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub enum Cosine {
    /// The factor is max(0, N·L), which is correct.
    #[default]
    Clamped,
    /// The factor is |N·L|.
    TwoSided,
    /// The factor is N·L without clamping.
    Signed,
    /// The factor is 1, independent of the direction.
    One,
    /// There is no diffuse term.
    None,
    /// The factor is max(0, N·L)².
    Squared,
    /// The factor is (N·L + 1) / 2.
    Half,
    /// The factor is 1 where N·L > 0.
    Step,
    /// The factor is max(0, N·L) / π.
    OverPi,
    /// The factor is max(0, N·V).
    View,
}

/// Formula by which a student's tracer computes the half vector of Blinn's highlights.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub enum HalfVector {
    /// The half vector is norm(L + V), which is correct.
    #[default]
    Unit,
    /// The half vector is L + V.
    Sum,
    /// The half vector is (L + V) / 2.
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

/// Method by which a student's tracer adds up the contributions of the lights.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub enum LightSum {
    /// The contributions are summed, and the sum is clamped only when the pixel is written, which
    /// is correct.
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
    /// The result is the maximum of the lights, for each channel.
    Greatest,
    /// The result is the maximum of the lights and the ambient light, for each channel.
    GreatestOfAll,
}

/// Formula by which a student's tracer attenuates a point light at distance d.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub enum Attenuation {
    /// The light is divided by the scene's polynomial, which is correct.
    #[default]
    Correct,
    /// The light is multiplied by the scene's polynomial.
    Multiplied,
    /// The light is divided by d.
    Linear,
    /// The light is divided by d².
    Square,
    /// The light is divided by the square root of the scene's polynomial.
    Root,
    /// The light is divided by the scene's polynomial of d².
    SquaredTwice,
}

/// Formula by which a student's tracer computes the direction L to a point light, and sometimes the
/// distance d.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub enum PointLightDirection {
    /// The formula is L = norm(position - p), which is correct.
    #[default]
    Correct,
    /// The formula is L = norm(p - position).
    Negated,
    /// The formula is L = norm(position).
    Position,
    /// The formula is L = norm(-position).
    MinusPosition,
    /// The formulas are L = norm(position) and d = |position|.
    PositionAlone,
    /// The formula is L = norm(position - eye). With `true`, d = |position - eye| is also used.
    FromEye(bool),
}

/// Formula by which a student's tracer computes the direction of a reflected ray.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub enum Mirror {
    /// The direction is d - 2 (d·N) N, which is correct.
    #[default]
    Correct,
    /// The direction is the negated correct direction.
    Negated,
    /// The direction is d - (d·N) N, which is along the surface.
    Along,
    /// The direction is d + 2 (d·N) N.
    Plus,
    /// N.
    Normal,
}

/// Formula by which a student's tracer computes the direction of a transmitted ray.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub enum Glass {
    /// The direction follows Snell's law, which is correct.
    #[default]
    Correct,
    /// The ratio of the indices is inverted.
    Inverted,
    /// The ratio for entering the object is also used when the ray leaves it.
    IndicesNotSwapped,
    /// The ray is not refracted.
    Straight,
    /// The outward normal is also used when the ray leaves the object.
    Outward,
    /// The square root is added instead of subtracted.
    RootAdded,
    /// The indices are exchanged, also in Fresnel's law.
    Exchanged,
    /// The component along the normal has the wrong sign.
    SignChanged,
    /// The square root is left out.
    NoRoot,
    /// In the square root, η takes the place of η².
    Unsquared,
}

/// Fresnel term of glass in a student's tracer.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub enum Fresnel {
    /// The term is Schlick's approximation, which is correct.
    #[default]
    Correct,
    /// The term is R0 at every angle.
    Constant,
    /// There is no Fresnel term, so the reflected and the transmitted ray both have weight 1.
    None,
    /// This fraction is reflected at every angle.
    Share(f32),
    /// The reflected and the transmitted fraction are exchanged.
    Exchanged,
    /// The term is Schlick's approximation with the angle of the incoming ray, even when the ray
    /// leaves the glass.
    Incoming,
    /// The term is Schlick's approximation with R0 not squared.
    Unsquared,
    /// The term is Schlick's approximation with this power instead of 5.
    Power(f32),
}

/// Mistakes in the direction and attenuation of lights.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct LightBugs {
    /// L of a directional light is the direction written in the file; it should be the opposite
    /// direction.
    pub negated: bool,
    /// The L of all lights has the wrong sign, also for shadow rays.
    pub all_negated: bool,
    /// The L of directional lights is not normalised.
    pub long: bool,
    /// The L of point lights is not normalised.
    pub long_points: bool,
    /// Attenuation formula of point lights.
    pub attenuation: Attenuation,
    /// Formula for the direction to point lights.
    pub points: PointLightDirection,
}

/// Mistakes in the highlights of Blinn's and Phong's models.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct HighlightBugs {
    /// The highlight is multiplied by max(0, N·L).
    pub times_cosine: bool,
    /// The highlight is multiplied by the diffuse colour.
    pub times_diffuse: bool,
    /// The highlight has the light's colour because it is not multiplied by the specular colour.
    pub bare: bool,
    /// Half vector in Blinn's model.
    pub half: HalfVector,
    /// The view direction has the wrong sign.
    pub eye_negated: bool,
    /// The highlight is not multiplied by the light's colour.
    pub lightless: bool,
    /// The highlight is multiplied by this factor.
    pub factor: Option<f32>,
    /// The base of the power is replaced by its absolute value.
    pub two_sided: bool,
    /// Blinn's highlight is also added where N·L <= 0.
    pub everywhere: bool,
    /// Direction R in Phong's model.
    pub mirror: Mirror,
}

/// Direction of the shadow rays in a student's tracer.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub enum ShadowDirection {
    /// The rays point towards the light, which is correct.
    #[default]
    Light,
    /// The rays point away from the light.
    Away,
    /// The rays point along the surface normal.
    Normal,
}

/// End of the shadow rays in a student's tracer, for a point light at distance d.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub enum ShadowRayEnd {
    /// The rays end at d, which is correct.
    #[default]
    Correct,
    /// At 1.
    One,
    /// The rays end at d² because `t` ends at d although the ray direction has length d.
    Squared,
}

/// Mistakes that a student's tracer can make in shadow rays and in the ambient term.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct ShadowBugs {
    /// Shadow rays do not end at the light.
    pub endless: bool,
    /// Ambient light is missing in shadow.
    pub ambient_too: bool,
    /// Distance at which shadow rays start, if it is different.
    pub epsilon: Option<f32>,
    /// Fraction of a light that remains in its shadow.
    pub remaining_light: f32,
    /// If one light is blocked, all later lights are also missing.
    pub later_too: bool,
    /// If any light is blocked, the ambient light is missing.
    pub ambient_of_any: bool,
    /// Only the light with this index casts shadows.
    pub only_light: Option<usize>,
    /// Transparent objects cast no shadows.
    pub no_glass: bool,
    /// Direction of shadow rays.
    pub direction: ShadowDirection,
    /// A light contributes where it is blocked instead of where it is visible.
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
    /// If one light is blocked, all direct light is missing. With `true`, reflected and transmitted
    /// light is also missing.
    pub black: Option<bool>,
}

/// Mistakes in reflected and transmitted rays.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct SecondaryBugs {
    /// Reflected light is not multiplied by the mirror's colour.
    pub mirror_in_full: bool,
    /// Transmitted light is not multiplied by the glass's colour.
    pub glass_in_full: bool,
    /// Reflected rays return nothing, but the Fresnel term still applies.
    pub no_mirror: bool,
    /// Transmitted rays return nothing, but the Fresnel term still applies.
    pub no_glass: bool,
    /// Direction of reflected rays.
    pub mirror: Mirror,
    /// Direction of transmitted rays.
    pub glass: Glass,
    /// Fresnel term of glass.
    pub fresnel: Fresnel,
    /// The local light is multiplied by 1 minus the mirror's colour.
    pub mixed: bool,
    /// Reflected light is multiplied by the diffuse colour.
    pub times_diffuse: bool,
    /// Mirrors have no local light.
    pub instead: bool,
    /// Secondary rays are traced once for each light.
    pub each_light: bool,
    /// Secondary rays that miss everything return black.
    pub black_sky: bool,
    /// The directions of secondary rays are normalised.
    pub unit: bool,
    /// Only the first hit of a camera ray has shadows.
    pub unshadowed: bool,
    /// Distance at which secondary rays start, if it is different.
    pub epsilon: Option<f32>,
}

/// The mistakes of a student's tracer ([`BuggyTracer`](super::BuggyTracer)). The default is a
/// correct tracer.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct Bugs {
    /// The hit along a ray that the tracer uses.
    pub hit_choice: HitChoice,
    /// Rays for which hits behind the origin count, if there are any.
    pub behind: Option<BehindOrigin>,
    /// The colour that each ray returns is clamped to 1.
    pub clamped_rays: bool,
    /// Ray directions are normalised in object space, so `t` has a different scale there.
    pub local_unit: bool,
    /// Method for transforming normals.
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
    /// Permutation of the vertex normals of a triangle. The value 0 is the correct order.
    pub normal_permutation: usize,
    /// Shading normals are flipped so that they face the eye.
    pub faced: bool,
    /// Method for adding ambient light.
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
    /// Formula for the normals of spheres.
    pub sphere_normals: SphereNormal,
    /// Colour of camera rays that miss everything. With `true`, other rays also return it.
    pub sky: Option<(Color, bool)>,
    /// Mistakes in lights.
    pub lights: LightBugs,
    /// Mistakes in highlights.
    pub highlights: HighlightBugs,
    /// Mistakes in shadow rays.
    pub shadows: ShadowBugs,
    /// Method for adding up the contributions of the lights.
    pub sum: LightSum,
    /// Mistakes in reflected and transmitted rays.
    pub bounces: SecondaryBugs,
}

/// Side of a non-square picture to which a student's camera applies the field of view.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub enum Aspect {
    /// The field of view spans the side that the dialect's program uses.
    #[default]
    Correct,
    /// The field of view spans the smaller side.
    Smaller,
    /// The smaller side is scaled by the reciprocal of the correct factor.
    Turned,
}

/// Mistakes in generating camera rays, in addition to the quirks of the scene's dialect.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct CameraBugs {
    /// Position of the sample in the pixel. The centre is (0.5, 0.5).
    pub sample_position: Vec2,
    /// Factor by which positions on the picture plane are multiplied.
    pub scale: f32,
    /// Side to which the field of view applies in non-square pictures.
    pub aspect: Aspect,
    /// Number of rays per pixel.
    pub rays: RayCount,
}

/// Number of camera rays per pixel in a student's tracer.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub enum RayCount {
    /// The number that is set in the job.
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
    /// Returns the factors for positions on the picture plane, one for each axis.
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

/// Mistake that a student's program can make when it converts radiance to eight-bit values.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub enum OutputBug {
    /// There is no mistake, so the transfer curve is correct.
    #[default]
    Correct,
    /// The value is multiplied by this number and taken modulo 256.
    Wrapped(u16),
    /// The value is divided by the brightest value in the picture.
    Scaled,
    /// The value is rounded instead of truncated, or the reverse.
    OtherRounding,
    /// The value is raised to the reciprocal of this power, where 0 stands for the sRGB curve.
    ExtraCurve(f32),
    /// The value c becomes c / (1 + c).
    Toned,
    /// The value is multiplied by this factor.
    Times(f32),
    /// The value c becomes 1 - c.
    Negative,
    /// The picture is grey: 0 selects the mean of the channels, 1 the luma of Rec. 601, 2 the
    /// luminance, 3 the maximum, 4 red, 5 green, and 6 blue.
    Grey(u32),
    /// The value is quantised to this many levels.
    Steps(u32),
    /// The value is raised to this power, where 0 stands for omitting the sRGB curve or applying
    /// its inverse.
    MissingCurve(f32),
}

/// The way in which a student's program rearranges the pixels and channels of a picture, for
/// example by mirroring it.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub struct PixelOrder {
    /// Columns and rows are exchanged if the picture is square.
    pub exchange: bool,
    /// The order of the columns is reversed.
    pub columns_back: bool,
    /// The order of the rows is reversed.
    pub rows_back: bool,
    /// Order of the channels, as an index into [`PixelOrder::ORDERS`]. The index 0 means unchanged,
    /// and 1 exchanges red and blue.
    pub channels: u8,
    /// Shift of the picture in pixels, to the right and downwards.
    pub moved: (i32, i32),
    /// Pixels without a source are black instead of repeating the border.
    pub black_border: bool,
    /// Pixels that leave the picture on one side enter it on the other.
    pub rolled: bool,
    /// All pixels in each block of 2 by 2 have the same value.
    pub halved: bool,
}

impl PixelOrder {
    /// Source channels of red, green and blue, for each order.
    pub const ORDERS: [[usize; 3]; 6] = [[0, 1, 2], [2, 1, 0], [0, 2, 1], [1, 0, 2], [1, 2, 0], [2, 0, 1]];

    /// Returns true if the pixel at a position has no source and is therefore black.
    pub fn is_empty(self, width: u32, height: u32, (x, y): (u32, u32)) -> bool {
        let out = |at: u32, by: i32, size: u32| !(0..i64::from(size)).contains(&(i64::from(at) - i64::from(by)));
        self.black_border && (out(x, self.moved.0, width) || out(y, self.moved.1, height))
    }

    /// Returns the source position of the pixel at a position.
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
