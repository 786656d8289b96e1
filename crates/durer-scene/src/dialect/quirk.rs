//! Named bugs of the official programs.

/// Set of [`Quirk`]s, with one bit for each.
pub type QuirkSet = u64;

macro_rules! quirks {
    ($($(#[doc = $doc:literal])+ $variant:ident = $name:literal,)+) => {
        /// Bug that Dürer can reproduce, found in an official program unless stated otherwise. A
        /// quirk is off unless it is selected by its dialect or by name.
        #[derive(Clone, Copy, Debug, PartialEq, Eq)]
        #[repr(u8)]
        pub enum Quirk { $($(#[doc = $doc])+ $variant,)+ }

        impl Quirk {
            /// Every quirk, with its name and meaning.
            pub const ALL: &'static [(Quirk, &'static str, &'static str)] =
                &[$((Quirk::$variant, $name, concat!($($doc, "\n"),+)),)+];
        }
    };
}

quirks! {
    /// The pixel centres of the first and last columns and rows are on the picture's border.
    BorderPixels = "border-pixels",
    /// A picture that is not square shows the camera's square view stretched to its shape.
    Stretch = "stretch",
    /// The camera's `up` is used as written: it is neither made perpendicular nor normalised.
    RawUp = "raw-up",
    /// The camera's `up` is normalised, but not made perpendicular.
    SkewUp = "skew-up",
    /// The highlight of a light also appears on surfaces that face away from it.
    HighlightBehind = "highlight-behind",
    /// Shininess 0 makes the highlight 1 everywhere: 0 to the power of 0 is 1.
    PowZero = "pow-zero",
    /// A point light without falloff causes a division by zero, and its light is black.
    MissingFalloff = "missing-falloff",
    /// A surface seen from behind is black, without ambient light, unless it is shaded on both
    /// sides.
    BlackBacks = "black-backs",
    /// R0 is computed as if every ray arrived from air: for a ray that leaves glass, it is 0.
    ExitR0 = "exit-r0",
    /// A perspective ray is aimed at a world-space point on a screen at distance 1, which is
    /// computed from the screen's lower left corner and rounded. Far from the origin, this rounding
    /// changes the direction of the rays.
    ScreenPoint = "screen-point",
    /// A triangle extends slightly beyond its edges, to barycentric coordinates of -0.00001.
    LooseTriangles = "loose-triangles",
    /// The interpolated normal determines which side of a surface is seen.
    ShadedSides = "shaded-sides",
    /// A mesh triangle is missed if (b - a) x (c - a) · d is less than 0.000001, which happens with
    /// small triangles seen at a grazing angle.
    ThinTriangles = "thin-triangles",
    /// The ambient term on a textured surface uses the texel of the previous pixel with the same
    /// material, in rows from the bottom.
    StaleTexels = "stale-texels",
    /// A light is occluded only if the nearest object towards it is hit from its front. Disabled by
    /// `exit-r0`, a quirk of an earlier version of the same program.
    ShadowFronts = "shadow-fronts",
    /// A `Matrix` is multiplied from the left with everything before it.
    MatrixOnLeft = "matrix-on-left",
    /// The product of the matrices of one transform loses its shear: it is decomposed into
    /// translation, rotation and scale. Shear between nested transforms is kept.
    DroppedShear = "dropped-shear",
    /// The normal of a plane is not normalised for lighting, mirrors and normal pictures, except
    /// inside a transform.
    RawNormals = "raw-normals",
    /// Lighting uses unit normals, even with `raw-normals`.
    UnitLight = "unit-light",
    /// Textures are shown on meshes only.
    MeshTextures = "mesh-textures",
    /// Ambient light is multiplied by the diffuse colour only if the material sets one.
    WrittenAmbient = "written-ambient",
    /// A camera ray is assumed to start in air, even if the camera is inside glass.
    AirAtEye = "air-at-eye",
    /// The last line of an `.obj` file is ignored if it does not end with a newline.
    LostLastLine = "lost-last-line",
    /// Only the first three vertices of a face in an `.obj` file are used.
    ThreeCorners = "three-corners",
    /// Normal i of an `.obj` file belongs to vertex i, regardless of the indices in its faces.
    NormalsByVertex = "normals-by-vertex",
    /// The face `back` of the sky is mirrored horizontally and `down` is upside down, so neither
    /// matches its neighbours.
    MirroredBack = "mirrored-back",
    /// The background is black in depth pictures even if distant surfaces are white.
    BlackSky = "black-sky",
    /// A normal picture shows the normal of the previous hit where nothing is hit, in rows from the
    /// bottom.
    StaleNormals = "stale-normals",
    /// The range of a depth picture is truncated to integers.
    WholeDepths = "whole-depths",
    /// The rings of wood are cones, with grain stretched along the axis. The weight of the first
    /// material is the square of sin(frequency (r + y / 20) + amplitude N(x, y / 5, z)) + 1/2,
    /// clamped to 0 to 1.
    ConicRings = "conic-rings",
    /// Secondary rays have no minimum `t`: they start at the dialect's epsilon times their
    /// direction, and the distance to a light is measured from there.
    MovedStarts = "moved-starts",
    /// A plane is also hit exactly at the start of a ray.
    ClosedPlanes = "closed-planes",
    /// A triangle takes precedence over earlier objects that are hit at the same distance.
    TiedTriangles = "tied-triangles",
    /// At a plane, refraction uses the normal without normalising it.
    RawRefraction = "raw-refraction",
    /// A mirrored ray is not normalised, so a non-unit normal changes its length.
    LongMirrors = "long-mirrors",
    /// Meshes are traversed with the octree of the starter code, in which a ray with a direction
    /// component of exactly 0 misses the far half of a cell.
    OctreeHoles = "octree-holes",
    /// A transform whose determinant is within 1.2e-7 of 0 is ignored.
    TinyTransforms = "tiny-transforms",
    /// A second section of lights is added to the first.
    AddedLights = "added-lights",
    /// A degenerate face makes the normals of its vertices NaN, so triangles there are black.
    SpoiledNormals = "spoiled-normals",
    /// Depths before the start of the given range are clamped to the start; otherwise, depths
    /// beyond its end are clamped to the end. In a reversed range, near is white and everything
    /// beyond is black. An empty range is black.
    ClampedDepths = "clamped-depths",
    /// `-jitter` alone writes all subpixels, and `-filter` alone averages 3x3 pixels.
    OddSizes = "odd-sizes",
    /// Invalid values are accepted: negative radii and exponents, angles of 180 degrees, scales of
    /// zero, a light without a direction, hexadecimal numbers.
    AnyValues = "any-values",
    /// Shading normals are transformed by the matrix itself instead of its inverse transpose. Not
    /// part of any dialect: this is a common mistake that the lecture shows.
    MovedNormals = "moved-normals",
}

impl Quirk {
    /// Returns the bit that represents this quirk in a [`QuirkSet`].
    pub const fn bit(self) -> QuirkSet {
        1 << self as u8
    }

    /// Returns the quirk with this name.
    pub fn from_name(name: &str) -> Option<Quirk> {
        Quirk::ALL.iter().find(|row| row.1 == name).map(|row| row.0)
    }
}

pub(super) const fn quirk_set(list: &[Quirk]) -> QuirkSet {
    let mut set = 0;
    let mut i = 0;
    while i < list.len() {
        set |= list[i].bit();
        i += 1;
    }
    set
}
