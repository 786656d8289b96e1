//! Dialects of the scene language, defined by one table of their differences.
//!
//! A [`Dialect`] is the version of the scene language that the course used in a certain year. Its
//! [`DialectRules`] define the meaning of its keywords. Its [`Quirk`]s are the known bugs of the
//! official program of that year. The quirks are active only if the user selects the dialect.

mod quirk;

use quirk::quirk_set;
pub use quirk::{Quirk, QuirkSet};
use serde::{Deserialize, Serialize};

/// Dialect of the scene language, either from one year of the course or Dürer's own. Each
/// discriminant is one bit of a [`DialectSet`].
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash, Serialize, Deserialize)]
#[serde(rename_all = "lowercase")]
pub enum Dialect {
    /// Course of 2003, with materials inside groups and transforms such as `Translate { 0 2 0 }`.
    F03 = 1,
    /// Fall 2004, assignments 1 to 8.
    F04 = 2,
    /// Fall 2012, assignment 4, and the course TIEA311.
    F12a4 = 4,
    /// Fall 2012, assignment 5.
    F12a5 = 8,
    /// Courses from 2016 to 2019.
    F16 = 16,
    /// Courses from 2020 to 2023, with nodes and components.
    F23 = 32,
    /// Dürer's own dialect, with every keyword of the other years and sensible rules.
    Durer = 64,
}

/// Set of [`Dialect`]s, with one bit for each.
pub type DialectSet = u8;

/// Sets of dialects that are used in tables.
pub mod set {
    use super::{Dialect, DialectSet};
    /// 2003.
    pub const F03: DialectSet = Dialect::F03 as u8;
    /// Fall 2004.
    pub const F04: DialectSet = Dialect::F04 as u8;
    /// Fall 2012, assignment 4.
    pub const F12A4: DialectSet = Dialect::F12a4 as u8;
    /// Fall 2012, assignment 5.
    pub const F12A5: DialectSet = Dialect::F12a5 as u8;
    /// Courses from 2016 to 2019.
    pub const F16: DialectSet = Dialect::F16 as u8;
    /// Courses from 2020 to 2023.
    pub const F23: DialectSet = Dialect::F23 as u8;
    /// Dürer's own.
    pub const DURER: DialectSet = Dialect::Durer as u8;
    /// Dialects of 2003 and 2004.
    pub const OLD: DialectSet = F03 | F04;
    /// Dialects of 2012 and later that do not use nodes.
    pub const NEW: DialectSet = F12A4 | F12A5 | F16;
    /// Dialects with the grammar of 2004.
    pub const CLASSIC: DialectSet = OLD | NEW | DURER;
    /// Every dialect.
    pub const ALL: DialectSet = CLASSIC | F23;
}

impl Dialect {
    /// All dialects from oldest to newest, followed by Dürer's own.
    pub const ALL: [Dialect; 7] =
        [Dialect::F03, Dialect::F04, Dialect::F12a4, Dialect::F12a5, Dialect::F16, Dialect::F23, Dialect::Durer];

    /// Returns the name of the dialect on the command line.
    pub fn name(self) -> &'static str {
        self.rules().name
    }

    /// Returns the dialect with this name.
    pub fn from_name(name: &str) -> Option<Dialect> {
        Dialect::ALL.into_iter().find(|d| d.name() == name)
    }

    /// True if a set contains the dialect.
    pub fn is_in(self, set: DialectSet) -> bool {
        set & self as u8 != 0
    }

    /// Returns the rules of the dialect, including the bugs of the old program.
    pub fn rules(self) -> &'static DialectRules {
        &TABLE[(self as u8).trailing_zeros() as usize]
    }
}

/// Ambient light of a scene without lights.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Serialize, Deserialize)]
pub enum AmbientWithoutLights {
    /// The ambient light of the scene.
    Own,
    /// The ambient light of the scene, or 1 1 1 if it is black.
    WhiteIfBlack,
    /// 1 1 1, regardless of the value in the scene.
    White,
}

/// Method by which a dialect computes normals for meshes without normals.
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize)]
pub enum MeshNormals {
    /// One normal per triangle.
    Flat,
    /// Mean of the normals of the faces around a vertex, weighted by area.
    SmoothByArea,
    /// Mean of the normals of the faces around a vertex, with equal weights.
    SmoothByFace,
    /// `SmoothByFace`, except that a degenerate face makes the normals of its vertices NaN.
    SpoiledByFace,
    /// `SmoothByArea` for meshes with more vertices than this number, otherwise `Flat`.
    SmoothAbove(usize),
    /// Mean of the normals of the faces around a vertex that meet at less than this angle in
    /// degrees, weighted by angle.
    Crease(f32),
}

/// Formula that a dialect uses to compute the specular highlights of lights.
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize)]
pub enum Highlight {
    /// max(0, N·H)^exponent, only where N·L > 0.
    Blinn,
    /// max(0, R·L)^shininess, where R is the mirrored view ray.
    Phong,
    /// No highlight.
    None,
    /// Blinn formula for `exponent`, and Phong formula where N·L > 0 for `shininess`.
    ByKeyword,
}

/// Formula that a dialect uses to attenuate a light at distance d, based on `attenuation a0 a1 a2`
/// or `falloff f`.
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize)]
pub enum Falloff {
    /// No attenuation.
    None,
    /// 1 / (a0 + a1 d + a2 d^2), or 1 / (1 + f d^2).
    #[serde(rename = "OnePlus")]
    Polynomial,
    /// 1 / (f d^2), where this value is the default for f. `None` means no attenuation by default.
    #[serde(rename = "Bare")]
    InverseSquare(Option<f32>),
}

/// Reflected and refracted rays that a dialect traces from a surface, and their weights.
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize)]
pub enum SecondaryRays {
    /// Direct lighting only, without secondary rays.
    None,
    /// Reflected and refracted rays, which are weighted by `reflectiveColor` and `transparentColor`
    /// and added together.
    Colors,
    /// Reflected ray, weighted by `specularColor`.
    Specular,
    /// Reflected and refracted rays, weighted by `specularColor`, and also by the Fresnel
    /// reflectance if `refractionIndex` is set.
    SpecularFresnel,
    /// Rays selected by the keywords that the material sets: `reflectiveColor`, `transparentColor`
    /// or `refractionIndex`.
    ByKeyword,
}

/// Mapping from surface normals to colours that a dialect uses in normal pictures.
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize)]
pub enum NormalsPicture {
    /// Absolute value |n|, with a black background.
    Abs,
    /// (n + 1) / 2, with a mid-grey background.
    Half,
}

/// Mapping from depths to grey values that a dialect uses in depth pictures.
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize)]
pub enum DepthPicture {
    /// (max - t) / (max - min), so that near surfaces are white, with a black background.
    NearWhite,
    /// (t - min) / (max - min), so that near surfaces are black, with a black background.
    NearBlack,
}

/// First folder in which a dialect looks for the files that a scene refers to.
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize)]
pub enum PathBase {
    /// The current directory.
    Current,
    /// The directory of the scene file.
    SceneFile,
    /// Subfolder of the current directory.
    Assets(&'static str),
}

/// Floating-point arithmetic used for camera rays and intersections, which determines how they are
/// rounded.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Serialize, Deserialize)]
pub enum Arithmetic {
    /// Dürer's own arithmetic.
    Own,
    /// Single precision, with the same sequence of operations as in the programs of Fall 2012.
    Of2012,
    /// Single precision as in the program of 2016.
    Of2016,
    /// Single precision as in the program of 2020, which uses the glm library.
    Of2020,
}

/// Rules of a dialect: its defaults, the meaning of its keywords, and its quirks.
#[derive(Clone, Debug, PartialEq, Serialize)]
pub struct DialectRules {
    /// Name of the dialect on the command line.
    pub name: &'static str,
    /// One-line title of the dialect.
    pub title: &'static str,
    /// Default picture size, in pixels.
    pub size: (u32, u32),
    /// Default number of levels of secondary rays.
    pub bounces: u32,
    /// True if lights cast shadows by default.
    pub shadows: bool,
    /// True if, by default, a surface seen from behind is shaded with its normal flipped.
    pub shade_back: bool,
    /// Method for computing the normals of meshes that have none.
    pub mesh_normals: MeshNormals,
    /// True if the normals stored in mesh files (`vn`) are used.
    pub file_normals: bool,
    /// Formula for specular highlights.
    pub highlight: Highlight,
    /// Formula for the attenuation of point lights.
    pub falloff: Falloff,
    /// Rays traced for reflection and refraction.
    pub secondary: SecondaryRays,
    /// Minimum `t` of secondary rays. With `None`, rays start at an error-bounded offset instead.
    pub epsilon: Option<f32>,
    /// Floating-point arithmetic used for camera rays and intersections.
    pub arithmetic: Arithmetic,
    /// Mapping from normals to colours in normal pictures.
    pub normals_picture: NormalsPicture,
    /// Mapping from depths to grey values in depth pictures.
    pub depth_picture: DepthPicture,
    /// True if textures and sky pictures are decoded with the sRGB curve; false if they are linear.
    pub srgb_textures: bool,
    /// First folder in which to look for files.
    pub paths: PathBase,
    /// True if the ambient light is multiplied by a material's texture or noise, instead of only by
    /// its `diffuseColor`.
    pub ambient_textured: bool,
    /// Ambient light of a scene without lights.
    pub ambient_without_lights: AmbientWithoutLights,
    /// True if coloured, transparent objects cast coloured shadows.
    pub transparent_shadows: bool,
    /// Quirks of the official program that the dialect reproduces.
    #[serde(rename = "compat")]
    pub quirks: QuirkSet,
}

impl DialectRules {
    /// True if a quirk is active.
    pub fn has(&self, compat: Quirk) -> bool {
        self.quirks & compat.bit() != 0
    }

    /// True if the picture must equal that of an official program. Such rules have an epsilon, and
    /// hit points are computed from the ray, including its rounding errors.
    pub fn is_bit_compatible(&self) -> bool {
        self.epsilon.is_some()
    }

    /// Returns these rules with Dürer's defaults and without the bugs of the old program.
    ///
    /// These rules are used for files if the user did not select a dialect.
    pub fn without_quirks(&self) -> DialectRules {
        let ours = Dialect::Durer.rules();
        DialectRules {
            size: ours.size,
            shadows: ours.shadows,
            shade_back: ours.shade_back,
            bounces: if self.bounces > 0 || self.secondary == SecondaryRays::Colors { ours.bounces } else { 0 },
            file_normals: true,
            epsilon: None,
            arithmetic: Arithmetic::Own,
            srgb_textures: true,
            paths: PathBase::SceneFile,
            ambient_textured: true,
            ambient_without_lights: match self.ambient_without_lights {
                AmbientWithoutLights::White => ours.ambient_without_lights,
                other => other,
            },
            quirks: 0,
            ..self.clone()
        }
    }
}

use Quirk::*;

const F03: DialectRules = DialectRules { name: "f03", title: "6.837 of 2003", ..F04 };

const F04: DialectRules = DialectRules {
    name: "f04",
    title: "6.837 of Fall 2004",
    size: (100, 100),
    bounces: 0,
    shadows: false,
    shade_back: false,
    mesh_normals: MeshNormals::Flat,
    file_normals: false,
    highlight: Highlight::Blinn,
    falloff: Falloff::Polynomial,
    secondary: SecondaryRays::Colors,
    epsilon: Some(1e-4),
    arithmetic: Arithmetic::Own,
    normals_picture: NormalsPicture::Abs,
    depth_picture: DepthPicture::NearWhite,
    srgb_textures: false,
    paths: PathBase::Current,
    ambient_textured: true,
    ambient_without_lights: AmbientWithoutLights::White,
    transparent_shadows: false,
    quirks: quirk_set(&[
        BlackBacks,
        ShadedSides,
        ScreenPoint,
        LooseTriangles,
        ThinTriangles,
        MatrixOnLeft,
        ThreeCorners,
        ConicRings,
    ]),
};

const F12A4: DialectRules = DialectRules {
    name: "f12a4",
    title: "6.837 of Fall 2012, assignment 4, and TIEA311",
    mesh_normals: MeshNormals::SmoothByArea,
    highlight: Highlight::Phong,
    falloff: Falloff::None,
    secondary: SecondaryRays::None,
    arithmetic: Arithmetic::Of2012,
    quirks: quirk_set(&[
        BorderPixels,
        ShadedSides,
        Stretch,
        HighlightBehind,
        PowZero,
        MatrixOnLeft,
        StaleTexels,
        RawNormals,
        MeshTextures,
        LostLastLine,
        ThreeCorners,
        TiedTriangles,
        ClampedDepths,
        AnyValues,
    ]),
    ..F04
};

const F12A5: DialectRules = DialectRules {
    name: "f12a5",
    title: "6.837 of Fall 2012, assignment 5",
    bounces: 4,
    mesh_normals: MeshNormals::SmoothAbove(120),
    highlight: Highlight::None,
    falloff: Falloff::Polynomial,
    secondary: SecondaryRays::SpecularFresnel,
    epsilon: Some(1e-3),
    ambient_textured: false,
    quirks: quirk_set(&[
        BorderPixels,
        ShadedSides,
        Stretch,
        HighlightBehind,
        PowZero,
        ShadowFronts,
        MatrixOnLeft,
        RawNormals,
        UnitLight,
        MeshTextures,
        AirAtEye,
        LostLastLine,
        ThreeCorners,
        MirroredBack,
        TiedTriangles,
        RawRefraction,
        LongMirrors,
        OctreeHoles,
        OddSizes,
        AnyValues,
    ]),
    ..F12A4
};

const F16: DialectRules = DialectRules {
    name: "f16",
    title: "6.837 of 2016 to 2019",
    mesh_normals: MeshNormals::SmoothByFace,
    falloff: Falloff::InverseSquare(None),
    secondary: SecondaryRays::Specular,
    epsilon: Some(1e-2),
    normals_picture: NormalsPicture::Half,
    depth_picture: DepthPicture::NearBlack,
    paths: PathBase::SceneFile,
    arithmetic: Arithmetic::Of2016,
    quirks: quirk_set(&[
        BorderPixels,
        ShadedSides,
        Stretch,
        RawUp,
        HighlightBehind,
        PowZero,
        MissingFalloff,
        MatrixOnLeft,
        BlackSky,
        RawNormals,
        LostLastLine,
        ThreeCorners,
        MirroredBack,
        MovedStarts,
        ClosedPlanes,
        LongMirrors,
        OctreeHoles,
        AddedLights,
        SpoiledNormals,
        AnyValues,
    ]),
    ..F12A4
};

const F23: DialectRules = DialectRules {
    name: "f23",
    title: "6.837 of 2020 to 2023",
    size: (200, 200),
    mesh_normals: MeshNormals::SmoothByArea,
    falloff: Falloff::InverseSquare(Some(20.0)),
    ambient_without_lights: AmbientWithoutLights::Own,
    paths: PathBase::Assets("assets/assignment4"),
    arithmetic: Arithmetic::Of2020,
    quirks: quirk_set(&[
        BorderPixels,
        ShadedSides,
        Stretch,
        SkewUp,
        HighlightBehind,
        PowZero,
        MatrixOnLeft,
        BlackSky,
        StaleNormals,
        WholeDepths,
        DroppedShear,
        WrittenAmbient,
        ThreeCorners,
        MirroredBack,
        NormalsByVertex,
        MovedStarts,
        ClosedPlanes,
        MissingFalloff,
        OctreeHoles,
        TinyTransforms,
        AnyValues,
    ]),
    ..F16
};

const DURER: DialectRules = DialectRules {
    name: "durer",
    title: "Dürer's own: every word of every year, without the quirks",
    size: (512, 512),
    bounces: 8,
    shadows: true,
    shade_back: true,
    mesh_normals: MeshNormals::Crease(40.0),
    file_normals: true,
    highlight: Highlight::ByKeyword,
    falloff: Falloff::Polynomial,
    secondary: SecondaryRays::ByKeyword,
    epsilon: None,
    arithmetic: Arithmetic::Own,
    normals_picture: NormalsPicture::Half,
    depth_picture: DepthPicture::NearWhite,
    srgb_textures: true,
    paths: PathBase::SceneFile,
    ambient_textured: true,
    ambient_without_lights: AmbientWithoutLights::WhiteIfBlack,
    transparent_shadows: false,
    quirks: 0,
};

/// Rules of all dialects, ordered by their discriminants.
static TABLE: [DialectRules; 7] = [F03, F04, F12A4, F12A5, F16, F23, DURER];

#[cfg(test)]
mod tests;
