//! Named bugs of the official programs.

/// Set of compatibilities, as bits.
pub type CompatSet = u64;

macro_rules! compats {
    ($($(#[doc = $doc:literal])+ $variant:ident = $name:literal,)+) => {
        /// A named bug or quirk, of an official program unless stated otherwise. Off unless
        /// selected by its dialect or by name.
        #[derive(Clone, Copy, Debug, PartialEq, Eq)]
        #[repr(u8)]
        pub enum Compat { $($(#[doc = $doc])+ $variant,)+ }

        impl Compat {
            /// Every compatibility, with name and meaning.
            pub const ALL: &'static [(Compat, &'static str, &'static str)] =
                &[$((Compat::$variant, $name, concat!($($doc, "\n"),+)),)+];
        }
    };
}

compats! {
    /// The pixel centres of the first and last column and row lie on the picture's border.
    BorderPixels = "border-pixels",
    /// The camera's square is stretched over a picture that is not square.
    Stretch = "stretch",
    /// The camera's `up` is used as written: neither perpendicular nor normalised.
    RawUp = "raw-up",
    /// The camera's `up` is normalised, but not made perpendicular.
    SkewUp = "skew-up",
    /// The highlight of a light also appears on surfaces that face away from it.
    HighlightBehind = "highlight-behind",
    /// Shininess 0 makes the highlight 1 everywhere: 0 to the power of 0 is 1.
    PowZero = "pow-zero",
    /// A point light without falloff divides by zero, and its light is black.
    MissingFalloff = "missing-falloff",
    /// A surface seen from behind is black, without ambient light, unless it is shaded on both
    /// sides.
    BlackBacks = "black-backs",
    /// R0 assumes that every ray arrives in air: a ray that leaves glass reflects as if R0 were 0.
    ExitR0 = "exit-r0",
    /// A perspective ray is aimed at a world-space point, computed from the lower left corner of a
    /// screen at distance 1 and rounded there: far from the origin, rays are off by that rounding.
    ScreenPoint = "screen-point",
    /// A triangle extends a little beyond its edges: to barycentric coordinates of -0.00001.
    LooseTriangles = "loose-triangles",
    /// The interpolated normal decides which side of a surface is seen.
    ShadedSides = "shaded-sides",
    /// A mesh triangle is missed if (b - a) x (c - a) · d is less than 0.000001: a small one, seen
    /// at a grazing angle.
    ThinTriangles = "thin-triangles",
    /// On a texture, ambient light is that of the previously shaded pixel, in rows from the bottom.
    StaleTexels = "stale-texels",
    /// A light is occluded only if the nearest object towards it is seen from its front. Off with
    /// `exit-r0`, the quirk of an earlier version of the same program.
    ShadowFronts = "shadow-fronts",
    /// A `Matrix` is multiplied on the left of everything before it.
    MatrixOnLeft = "matrix-on-left",
    /// The product of the matrices of one transform loses its shear: it is decomposed into
    /// translation, rotation and scale. Shear between nested transforms stays.
    DroppedShear = "dropped-shear",
    /// A plane's normal keeps its written length, for lighting, mirrors and pictures of normals;
    /// not inside a transform.
    RawNormals = "raw-normals",
    /// Lighting uses unit normals, even with `raw-normals`.
    UnitLight = "unit-light",
    /// Only meshes show textures.
    MeshTextures = "mesh-textures",
    /// Ambient light is multiplied by the diffuse colour only if the material sets one.
    WrittenAmbient = "written-ambient",
    /// A camera ray is assumed to start in air, even if the camera is inside glass.
    AirAtEye = "air-at-eye",
    /// The last line of an `.obj` is lost if it has no line break.
    LostLastLine = "lost-last-line",
    /// A face of an `.obj` has three corners: the others are ignored.
    ThreeCorners = "three-corners",
    /// Normals of an `.obj` belong to the vertices by index, regardless of the indices in its
    /// faces.
    NormalsByVertex = "normals-by-vertex",
    /// The sky's face `back` is mirrored horizontally, and `down` is upside down, so neither
    /// matches its neighbours.
    MirroredBack = "mirrored-back",
    /// The background is black in depth pictures even if far is white.
    BlackSky = "black-sky",
    /// If nothing is hit, a picture of normals shows the normal of the previous hit, in rows from
    /// the bottom.
    StaleNormals = "stale-normals",
    /// The range of a depth picture is truncated to integers.
    WholeDepths = "whole-depths",
    /// Rings of wood are cones, with grain stretched along the axis: the first material's weight is
    /// the square of sin(frequency (r + y / 20) + amplitude N(x, y / 5, z)) + 1/2, clamped to 0 to
    /// 1.
    ConicRings = "conic-rings",
    /// Secondary rays have no minimum `t`: they start at the dialect's epsilon times their
    /// direction, and the distance to a light is measured from there.
    MovedStarts = "moved-starts",
    /// A plane is also hit at the very start of a ray.
    ClosedPlanes = "closed-planes",
    /// A triangle wins over earlier objects that are hit at the same distance.
    TiedTriangles = "tied-triangles",
    /// At a plane, refraction uses the normal with its written length.
    RawRefraction = "raw-refraction",
    /// A mirrored ray keeps the length that a non-unit normal gives it.
    LongMirrors = "long-mirrors",
    /// Meshes are traversed by the starter code's octree, in which a ray with a component of
    /// exactly 0 misses the far half of a cell.
    OctreeHoles = "octree-holes",
    /// A transform whose determinant is within 1.2e-7 of 0 is ignored.
    TinyTransforms = "tiny-transforms",
    /// A second section of lights is added to the first.
    AddedLights = "added-lights",
    /// A degenerate face makes the normals of its corners NaN: triangles there are black.
    SpoiledNormals = "spoiled-normals",
    /// A depth before the start of the given range is clamped to the start, and otherwise one
    /// beyond its end to the end. In a range that runs backwards, near is white and everything
    /// beyond is black; an empty range is black.
    ClampedDepths = "clamped-depths",
    /// `-jitter` alone writes all sub-pixels, and `-filter` alone averages three by three pixels.
    OddSizes = "odd-sizes",
    /// Meaningless values are drawn: negative radii and exponents, angles of 180 degrees, flat
    /// scales, a light without a direction, hexadecimal numbers.
    AnyValues = "any-values",
    /// Shading normals are transformed by the matrix itself, not by its inverse transpose. On in no
    /// dialect: a common mistake, which the lecture shows.
    MovedNormals = "moved-normals",
}

impl Compat {
    /// Returns its bit.
    pub const fn bit(self) -> CompatSet {
        1 << self as u8
    }

    /// Returns the compatibility of a name.
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
