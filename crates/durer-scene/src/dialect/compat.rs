//! Named bugs of the official programs.

/// Some compatibilities, as bits.
pub type CompatSet = u64;

macro_rules! compats {
    ($($(#[doc = $doc:literal])+ $variant:ident = $name:literal,)+) => {
        /// A named bug or quirk, of an official program where nothing else is said. Off unless
        /// its dialect, or it by name, is asked for.
        #[derive(Clone, Copy, Debug, PartialEq, Eq)]
        #[repr(u8)]
        pub enum Compat { $($(#[doc = $doc])+ $variant,)+ }

        impl Compat {
            /// All of them, with name and meaning.
            pub const ALL: &'static [(Compat, &'static str, &'static str)] =
                &[$((Compat::$variant, $name, concat!($($doc, "\n"),+)),)+];
        }
    };
}

compats! {
    /// Pixel centres of the first and last column and row lie on the picture's border.
    BorderPixels = "border-pixels",
    /// The picture of a camera is stretched over a picture that is not square.
    Stretch = "stretch",
    /// The camera's `up` is used as written: not made perpendicular, not normalised.
    RawUp = "raw-up",
    /// The camera's `up` is normalised, but not made perpendicular.
    SkewUp = "skew-up",
    /// The highlight of a light appears also where the surface faces away from it.
    HighlightBehind = "highlight-behind",
    /// Shininess 0 makes the highlight 1 everywhere: 0 to the power of 0 is 1.
    PowZero = "pow-zero",
    /// A point light without falloff divides by zero, and its light is black.
    MissingFalloff = "missing-falloff",
    /// A surface seen from behind is black, without ambient light, unless it is shaded both ways.
    BlackBacks = "black-backs",
    /// R0 takes the side that a ray comes from for air: a ray that leaves glass reflects as if R0
    /// were 0.
    ExitR0 = "exit-r0",
    /// A perspective ray is aimed at a point in the world, reckoned from the lower left corner of a
    /// screen at distance 1 and rounded there: far from the origin, rays are off by that rounding.
    ScreenPoint = "screen-point",
    /// A triangle reaches a little beyond its edges: to barycentric coordinates of -0.00001.
    LooseTriangles = "loose-triangles",
    /// Which side of a surface is seen is judged by its interpolated normal.
    ShadedSides = "shaded-sides",
    /// A mesh's triangle is missed where (b - a) x (c - a) · d is less than 0.000001: a small one,
    /// seen from its side.
    ThinTriangles = "thin-triangles",
    /// On a texture, ambient light is that of the pixel shaded before, in rows from the bottom.
    StaleTexels = "stale-texels",
    /// A light is blocked only where the nearest thing towards it is seen from its front. Off where
    /// `exit-r0` is asked for, the quirk of an earlier version of the same program.
    ShadowFronts = "shadow-fronts",
    /// A `Matrix` is multiplied on the left of everything before it.
    MatrixOnLeft = "matrix-on-left",
    /// The matrices of one transform lose the shear of their product: it is taken apart into
    /// moving, turning and stretching. Shear between nested transforms stays.
    DroppedShear = "dropped-shear",
    /// A plane's normal keeps the length that is written, for light, mirrors and pictures of
    /// normals; not inside a transform.
    RawNormals = "raw-normals",
    /// Light falls on normals of length 1, also where `raw-normals` holds.
    UnitLight = "unit-light",
    /// Only meshes show textures.
    MeshTextures = "mesh-textures",
    /// Ambient light meets the diffuse colour only where that is written.
    WrittenAmbient = "written-ambient",
    /// A camera ray is taken to run in air, also where the camera is inside glass.
    AirAtEye = "air-at-eye",
    /// The last line of an `.obj` is lost where no end of line follows it.
    LostLastLine = "lost-last-line",
    /// A face of an `.obj` has three corners: the others are passed over.
    ThreeCorners = "three-corners",
    /// Normals of an `.obj` belong to the vertices, number by number, whatever its faces say.
    NormalsByVertex = "normals-by-vertex",
    /// The sky's face `back` is mirrored, left for right, and `down` stands on its head, so that
    /// neither meets its neighbours.
    MirroredBack = "mirrored-back",
    /// The background is black in depth pictures even where far is white.
    BlackSky = "black-sky",
    /// Where nothing is hit, a picture of normals shows the normal hit last, in rows from the
    /// bottom.
    StaleNormals = "stale-normals",
    /// The range of a depth picture is cut to whole numbers.
    WholeDepths = "whole-depths",
    /// Rings of wood are cones, whose grain is stretched along the axis: the first material's share
    /// is the square of sin(frequency (r + y / 20) + amplitude N(x, y / 5, z)) + 1/2, kept between
    /// 0 and 1.
    ConicRings = "conic-rings",
    /// Secondary rays have no least `t`: they start the dialect's epsilon times their direction along,
    /// and the way to a light is counted from there.
    MovedStarts = "moved-starts",
    /// A plane is hit at the very start of a ray too.
    ClosedPlanes = "closed-planes",
    /// A triangle wins over earlier things that are hit at the same place.
    TiedTriangles = "tied-triangles",
    /// At a plane, refraction takes the normal with the length that is written.
    RawRefraction = "raw-refraction",
    /// A mirrored ray keeps the length that a normal which is not of length 1 gives it.
    LongMirrors = "long-mirrors",
    /// Meshes are walked by the starter's octree, where a ray with a component of exactly 0 misses
    /// the far half of a cell.
    OctreeHoles = "octree-holes",
    /// A transform whose determinant is within 1.2e-7 of 0 is passed over.
    TinyTransforms = "tiny-transforms",
    /// A second section of lights is added to the first.
    AddedLights = "added-lights",
    /// A face without area spoils the normals of its corners: triangles there are black.
    SpoiledNormals = "spoiled-normals",
    /// A depth before the start of the given range becomes its start, and else one behind its end
    /// that end, before they become greys: of a range that runs backwards what is near is white, and
    /// all beyond is black; an empty range is black.
    ClampedDepths = "clamped-depths",
    /// `-jitter` alone writes all sub-pixels, and `-filter` alone averages three by three pixels.
    OddSizes = "odd-sizes",
    /// Values that mean nothing are drawn: radii and exponents below 0, angles of 180 degrees, flat
    /// scales, a light without a direction, hexadecimal numbers.
    AnyValues = "any-values",
    /// Shading normals are transformed by the matrix itself, not by its inverse transpose. On in no
    /// dialect: a usual mistake, which the lecture shows.
    MovedNormals = "moved-normals",
}

impl Compat {
    /// Its bit.
    pub const fn bit(self) -> CompatSet {
        1 << self as u8
    }

    /// The one of a name.
    pub fn from_name(name: &str) -> Option<Compat> {
        Compat::ALL.iter().find(|row| row.1 == name).map(|row| row.0)
    }
}

pub(super) const fn bits(list: &[Compat]) -> CompatSet {
    let mut set = 0;
    let mut i = 0;
    while i < list.len() {
        set |= list[i].bit();
        i += 1;
    }
    set
}
