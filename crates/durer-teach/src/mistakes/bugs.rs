//! The mistakes that a student's tracer can make, given as options of
//! [`BuggyTracer`](super::BuggyTracer).

mod camera;
mod colors;

pub use camera::{Aspect, CameraBugs, OutputBug, PixelOrder, RayCount};
pub use colors::{Cells, ColorBugs, NoiseShare, Octaves, PatternSpace, SkyDirection, SkyFaces, TextureBug, Veins};
use durer_scene::math::Color;

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
    /// The roots are -b ± √(b² - c).
    Unit,
    /// The roots are -b ± √(b² - a c).
    UnitDivisor,
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
    /// The normal is (p - center) / r², for a sphere whose radius should be r² instead of r.
    OverSquare,
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
    /// The matrix is transposed, but it is not inverted.
    Transposed,
    /// The matrix is that of points, and the result is not normalised.
    LongMoved,
    /// The normal is transformed as a point, including the translation.
    MovedPoint,
    /// The correct result is then transformed by M as a point.
    MovedTwice,
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
    /// Every ray, except for hits within epsilon of the origin.
    Beyond,
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
    /// The light is divided by the scene's polynomial of the length of the ray that hits the
    /// surface.
    RayLength,
    /// The light is divided by the scene's polynomial of the distance from the eye to the light.
    FromEye,
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
    /// The direction is d - k (d·N) N with this k.
    Multiple(u8),
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
    /// The ray is not refracted, but there is none in the case of total internal reflection.
    StraightUnlessTotal,
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

/// Behaviour of a student's tracer in the case of total internal reflection.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub enum TotalReflection {
    /// There is no transmitted ray, and glass with a Fresnel term reflects all light, which is
    /// correct.
    #[default]
    Correct,
    /// A negative number below the square root counts as 0.
    Clamped,
    /// There is no transmitted ray, but glass reflects no more light than otherwise.
    Lost,
    /// The transmitted ray is a reflected ray.
    Mirrored,
    /// The transmitted ray is not bent.
    Straight,
    /// The root is not a number, which makes the pixel black.
    NotANumber,
    /// A negative number below the square root is replaced by its absolute value.
    Absolute,
    /// The hit is black.
    Black,
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
    /// Part of the light of point lights that is not attenuated: the diffuse term or, if `true`,
    /// the highlight.
    pub unfaded: Option<bool>,
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
    /// The view direction points to the eye, even at hits of mirrored rays.
    pub from_eye: bool,
    /// The view direction is that of the camera, the same at all hits.
    pub along_axis: bool,
    /// Only the first hit of a camera ray has highlights.
    pub first_only: bool,
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
    /// Lights, as sets of bits, that are blocked at the first hit of a camera ray and at other
    /// hits.
    pub blocked_lights: [u32; 2],
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
    /// Total internal reflection.
    pub total: TotalReflection,
    /// Transmitted rays start in front of the surface instead of behind it.
    pub glass_in_front: bool,
    /// Fresnel term of glass.
    pub fresnel: Fresnel,
    /// The local light is multiplied by 1 minus the mirror's colour.
    pub mixed: bool,
    /// The local light is multiplied by 1 minus the glass's colour. With `true`, so is the
    /// reflected light.
    pub glass_mixed: Option<bool>,
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
    /// Only the first hit of a camera ray has ambient light.
    pub no_ambient: bool,
    /// Mirrored rays start at the eye.
    pub from_eye: bool,
    /// Distance above the surface at which mirrored rays start.
    pub mirror_height: f32,
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
    /// Mirrors and glass use only the shading normal, even where it points away from the ray.
    pub one_normal: bool,
    /// Interpolated vertex normals are not normalised.
    pub unnormalized_mesh_normals: bool,
    /// Meshes are shaded with one normal per triangle.
    pub flat: bool,
    /// Triangle normals are negated.
    pub triangles_turned: bool,
    /// Normals of triangles that are not transformed are not normalised.
    pub long_triangles: bool,
    /// Surfaces have their diffuse colour, without any light.
    pub unlit: bool,
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
    /// The ambient light is added to the background.
    pub ambient_sky: bool,
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
    /// Mistakes in textures, the sky and patterns.
    pub colors: ColorBugs,
}
