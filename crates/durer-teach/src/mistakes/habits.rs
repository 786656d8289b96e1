//! What a pupil's tracer does otherwise than it should.

use durer_scene::math::{Color, Vec2};

/// Which of the hits along a ray is taken.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub enum Pick {
    /// The nearest, as it should be.
    #[default]
    Nearest,
    /// The nearest hit of the object whose nearest hit is farthest.
    FarthestObject,
    /// The last crossing of any surface.
    Last,
    /// That of the object that is written last.
    LastWritten,
    /// That of the object that is written first.
    FirstWritten,
    /// The nearest, but of spheres the far side.
    FarSpheres,
    /// As the farthest object, and of meshes the farthest triangle.
    FarthestTriangle,
    /// As what is written last, and of meshes the last triangle.
    LastTriangle,
    /// The nearest, but spheres are not hit from inside.
    NearRoots,
}

/// How normals of transformed things come to the world.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub enum Normals {
    /// By the inverse transpose, normalised.
    #[default]
    Right,
    /// Not at all.
    Local,
    /// By the inverse transpose, and of any length.
    Long,
    /// By the inverse, without the transpose.
    ByInverse,
}

/// What becomes of the ambient light.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub enum Ambient {
    /// Times the diffuse colour, once.
    #[default]
    Right,
    /// Once for each light.
    EachLight,
    /// Not times the diffuse colour.
    Bare,
}

/// The factor of a diffuse term.
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
}

/// The vector between light and eye of Blinn's highlights.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub enum Half {
    /// norm(L + V).
    #[default]
    Unit,
    /// L + V.
    Sum,
    /// (L + V) / 2.
    Mean,
}

/// Rays for which hits behind their origin count.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Behind {
    /// All.
    All,
    /// Those of the camera.
    Camera,
}

/// How what the lights give is added.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub enum Sum {
    /// All of it, clamped at the very end.
    #[default]
    Right,
    /// Clamped to 1 after each light.
    ClampedEach,
    /// What each light gives is clamped to 1 by itself.
    ClampedLight,
    /// Clamped to 1 before mirrored and transmitted light is added.
    ClampedLocal,
    /// Each light replaces those before it.
    LastOnly,
    /// Each light that is not in shadow replaces those before it.
    LastSeen,
}

/// What fades light with distance d, beside the factors of the scene.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub enum Fading {
    /// Divided by the scene's polynomial.
    #[default]
    Right,
    /// Multiplied with it.
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

/// Where point lights are taken to be.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub enum PointLamp {
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
}

/// The direction of a mirrored ray.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub enum Mirror {
    /// d - 2 (d·N) N.
    #[default]
    Right,
    /// Its negative.
    Negated,
    /// d - (d·N) N: along the surface.
    Along,
    /// d + 2 (d·N) N.
    Plus,
}

/// The direction of a transmitted ray.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub enum Glass {
    /// Snell's law.
    #[default]
    Right,
    /// With the ratio of indices turned round.
    Inverted,
    /// With the ratio of entering also where the ray leaves.
    NotSwapped,
    /// As if there were no surface.
    Straight,
    /// With the outward normal also where the ray leaves.
    Outward,
    /// With the root added that should be taken away.
    RootAdded,
    /// With each index in place of the other, in Fresnel's law too.
    Exchanged,
}

/// How the divisor of glass is found.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub enum Fresnel {
    /// Schlick's formula.
    #[default]
    Right,
    /// R0 at every angle.
    Constant,
    /// Not at all: both rays count in full.
    None,
    /// This share is mirrored at every angle.
    Share(f32),
    /// What should be mirrored is transmitted, and the other way.
    Exchanged,
    /// Schlick's formula with the angle of the incoming ray also where it leaves glass.
    Incoming,
    /// Schlick's formula with an R0 that is not squared.
    Unsquared,
    /// Schlick's formula with another power than 5.
    Power(f32),
}

/// What a light is as a thing in space.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct Lamps {
    /// L of directional lights is the direction as written, not its negative.
    pub negated: bool,
    /// L of all lights has the wrong sign, for shadow rays too.
    pub all_negated: bool,
    /// L of directional lights has the length that is written.
    pub long: bool,
    /// L of point lights has the length of the distance.
    pub long_points: bool,
    /// How light fades.
    pub fading: Fading,
    /// Where point lights are.
    pub points: PointLamp,
}

/// What highlights do.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct Highlights {
    /// They are times max(0, N·L).
    pub times_cosine: bool,
    /// They are times the diffuse colour.
    pub times_diffuse: bool,
    /// They have the light's colour, not times the specular colour.
    pub bare: bool,
    /// The vector of Blinn's model.
    pub half: Half,
    /// The direction to the eye has the wrong sign.
    pub eye_negated: bool,
    /// They do not have the light's colour.
    pub lightless: bool,
    /// By what they are multiplied, if given.
    pub factor: Option<f32>,
    /// The base of the power has lost its sign.
    pub two_sided: bool,
    /// Blinn's model too shows them where N·L <= 0.
    pub everywhere: bool,
}

/// Where shadow rays go.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub enum ShadowWay {
    /// To the light.
    #[default]
    Light,
    /// Away from it.
    Away,
    /// Along the normal.
    Normal,
}

/// What shadow rays do.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct Shadows {
    /// They do not end at the light.
    pub endless: bool,
    /// In shadow there is no ambient light either.
    pub ambient_too: bool,
    /// They begin this far along, if given.
    pub epsilon: Option<f32>,
    /// The share of a light that is left in its shadow.
    pub left: f32,
    /// Where one light is blocked, those after it are too.
    pub later_too: bool,
    /// Where any light is blocked, there is no ambient light.
    pub ambient_of_any: bool,
    /// Only the light of this number casts shadows, if given.
    pub only_light: Option<usize>,
    /// Things that let light through cast none.
    pub no_glass: bool,
    /// Where they go.
    pub way: ShadowWay,
    /// Light counts where they hit something.
    pub inverted: bool,
    /// Those to directional lights end at distance 1.
    pub short: bool,
    /// Highlights are there in shadow too.
    pub highlights_left: bool,
    /// Where one light is blocked, there is no light at all; with `true`, mirrored and transmitted
    /// light neither.
    pub black: Option<bool>,
}

/// What secondary rays do.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct Bounces {
    /// Mirrored light counts in full.
    pub mirror_in_full: bool,
    /// Transmitted light counts in full.
    pub glass_in_full: bool,
    /// Mirrored rays bring nothing; glass is divided as if they did.
    pub no_mirror: bool,
    /// Transmitted rays bring nothing; glass is divided as if they did.
    pub no_glass: bool,
    /// Where mirrored rays go.
    pub mirror: Mirror,
    /// Where transmitted rays go.
    pub glass: Glass,
    /// What divides glass.
    pub fresnel: Fresnel,
    /// Local light counts for what the mirror's colour leaves of it.
    pub mixed: bool,
    /// Mirrored light is times the diffuse colour.
    pub times_diffuse: bool,
    /// Mirrors have no local light.
    pub instead: bool,
    /// They are traced once for each light.
    pub each_light: bool,
    /// Where they hit nothing, they bring no light.
    pub black_sky: bool,
    /// Shadows are looked for at the first hit only.
    pub unshadowed: bool,
    /// They begin this far along, if given.
    pub epsilon: Option<f32>,
}

/// Everything that a pupil's tracer does otherwise. The default is a tracer that is right.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct Habits {
    /// Which hit is taken.
    pub pick: Pick,
    /// Hits behind the ray's origin count: for camera rays, or for all.
    pub behind: Option<Behind>,
    /// The colour that each ray brings back is clamped to 1.
    pub clamped_rays: bool,
    /// Directions are normalised in object space, so that `t` is another there.
    pub local_unit: bool,
    /// Normals of transformed things.
    pub normals: Normals,
    /// Normals between the corners of a mesh keep the length that mixing gives them.
    pub long_mixed: bool,
    /// Meshes have one normal a triangle.
    pub flat: bool,
    /// Normals of triangles point the other way.
    pub triangles_turned: bool,
    /// Normals of spheres point inwards.
    pub spheres_turned: bool,
    /// Those of planes do.
    pub planes_turned: bool,
    /// Which normals of a triangle's corners its three weights belong to; 0 is right.
    pub mixed_otherwise: usize,
    /// Shaded normals always face the eye.
    pub faced: bool,
    /// Ambient light.
    pub ambient: Ambient,
    /// The diffuse term.
    pub cosine: Cosine,
    /// It has not the surface's colour.
    pub plain_diffuse: bool,
    /// It has not the light's colour.
    pub diffuse_lightless: bool,
    /// By what it is multiplied, if given.
    pub diffuse_factor: Option<f32>,
    /// What rays of the camera bring that hit nothing, if given, and whether others do too.
    pub sky: Option<(Color, bool)>,
    /// Lights.
    pub lamps: Lamps,
    /// Highlights.
    pub highlights: Highlights,
    /// Shadow rays.
    pub shadows: Shadows,
    /// How lights are added.
    pub sum: Sum,
    /// Secondary rays.
    pub bounces: Bounces,
}

/// To which sides of a picture that is not square the angle belongs.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub enum Aspect {
    /// As the year has it.
    #[default]
    Right,
    /// The smaller side spans the angle.
    Smaller,
    /// The smaller side spans as much more as it should span less.
    Turned,
}

/// Where the rays of a pixel go, beside what the scene's rules say.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Aim {
    /// The place in a pixel, of which (0.5, 0.5) is the middle.
    pub place: Vec2,
    /// By what the point in the picture is multiplied.
    pub scale: f32,
    /// What becomes of a picture that is not square.
    pub aspect: Aspect,
    /// How many rays a pixel has.
    pub rays: Rays,
}

/// How many rays a pixel has.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub enum Rays {
    /// As asked for.
    #[default]
    Right,
    /// One.
    One,
    /// Four by four, evenly.
    Sixteen,
}

impl Default for Aim {
    fn default() -> Self {
        Aim { place: Vec2::splat(0.5), scale: 1.0, aspect: Aspect::Right, rays: Rays::Right }
    }
}

impl Aim {
    /// By what points of a picture are multiplied.
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

/// What becomes of light in a file.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub enum Output {
    /// What the transfer curve says.
    #[default]
    Right,
    /// 255 times the value, of which eight bits are kept.
    Wrapped,
    /// Divided by the brightest of the picture.
    Scaled,
    /// Rounded where it should be cut off, or the other way.
    OtherRounding,
    /// Values to the power of one over this; the curve of sRGB for 0.
    CurveMore(f32),
    /// c / (1 + c).
    Toned,
    /// Times this.
    Times(f32),
    /// 1 - c.
    Negative,
    /// Grey: 0 the mean of the channels, 1 and 2 as television weighs them, 3 the greatest, 4 red,
    /// 5 green, 6 blue.
    Grey(u32),
    /// In so many steps.
    Steps(u32),
    /// Values to the power of this; without the curve of sRGB, or its inverse, for 0.
    CurveLess(f32),
}

/// Where a pixel of the file comes from.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub struct Turn {
    /// Columns and rows are exchanged, in a square picture.
    pub exchange: bool,
    /// Columns run backwards.
    pub columns_back: bool,
    /// Rows run backwards.
    pub rows_back: bool,
    /// Red and blue are exchanged.
    pub bgr: bool,
    /// By how many pixels the picture is moved to the right and down.
    pub moved: (i32, i32),
    /// What nothing is moved to is black, and does not repeat the border.
    pub black_border: bool,
    /// What leaves the picture comes in on the other side.
    pub rolled: bool,
    /// Two by two pixels are one.
    pub halved: bool,
}

impl Turn {
    /// Whether no pixel of the right picture comes to a place.
    pub fn is_empty(self, width: u32, height: u32, (x, y): (u32, u32)) -> bool {
        let out = |at: u32, by: i32, size: u32| !(0..i64::from(size)).contains(&(i64::from(at) - i64::from(by)));
        self.black_border && (out(x, self.moved.0, width) || out(y, self.moved.1, height))
    }

    /// The pixel of the right picture that comes to a place.
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
