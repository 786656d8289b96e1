//! Errors returned when building, refitting, or loading trees.

use std::fmt;

/// Error returned when building or refitting a [`TriangleBvh`](super::TriangleBvh) or when building
/// a [`HeightGrid`](super::HeightGrid).
#[derive(Clone, Debug, PartialEq, Eq)]
#[non_exhaustive]
pub enum BuildError {
    /// A triangle refers to a vertex that does not exist.
    MissingVertex {
        /// Number of the triangle.
        triangle: usize,
        /// Index of the missing vertex.
        index: u32,
        /// Number of vertices in the mesh.
        vertices: usize,
    },
    /// There are 2^28 triangles or more.
    TooManyTriangles {
        /// Number of triangles.
        triangles: usize,
    },
    /// The length of a flat list of coordinates or indices is not a multiple of three.
    NotMultipleOfThree {
        /// `positions` or `indices`.
        list: &'static str,
        /// Length of the list.
        len: usize,
    },
    /// A height grid has fewer than two lines along an axis, or the number of heights differs from
    /// the number of grid points.
    InvalidGridSize {
        /// Number of lines along z.
        columns: usize,
        /// Number of lines along x.
        rows: usize,
        /// Number of heights.
        heights: usize,
    },
    /// A height grid contains a non-finite value.
    NotFinite,
    /// A tree was refitted to a mesh with a different number of triangles.
    TriangleCountMismatch {
        /// Number of triangles when the tree was built.
        built: usize,
        /// Number of triangles when the tree was refitted.
        refitted: usize,
    },
}

impl fmt::Display for BuildError {
    fn fmt(&self, f: &mut fmt::Formatter) -> fmt::Result {
        match self {
            BuildError::MissingVertex { triangle, index, vertices } => {
                write!(
                    f,
                    "triangle {triangle} has the vertex index {index}, which must be less than the number of vertices, \
                     {vertices}"
                )
            }
            BuildError::TooManyTriangles { triangles } => {
                write!(f, "a tree must have fewer than 2^28 triangles, not {triangles}")
            }
            BuildError::NotMultipleOfThree { list, len } => {
                write!(f, "the number of values in `{list}`, {len}, is not a multiple of 3")
            }
            BuildError::InvalidGridSize { columns, rows, heights } => {
                write!(
                    f,
                    "a height grid needs at least 2 x 2 lines and one height per crossing, not {columns} x {rows} \
                     lines and {heights} heights"
                )
            }
            BuildError::NotFinite => write!(f, "the height grid has values that are not finite"),
            BuildError::TriangleCountMismatch { built, refitted } => {
                write!(f, "the tree was built over {built} triangles, but {refitted} were given")
            }
        }
    }
}

impl std::error::Error for BuildError {}

/// Error returned when loading a tree that [`TriangleBvh::to_bytes`](super::TriangleBvh::to_bytes)
/// saved.
#[derive(Clone, Debug, PartialEq, Eq)]
#[non_exhaustive]
pub enum LoadError {
    /// The data does not begin with the header of a saved tree.
    NotATree,
    /// The data has a format version that this version of the crate does not support.
    UnsupportedVersion(u32),
    /// The length of the data differs from the length stored in the header.
    WrongLength {
        /// Expected length in bytes.
        expected: u64,
        /// Actual length in bytes.
        actual: usize,
    },
    /// The checksum is wrong, so the data is damaged.
    Damaged,
    /// The contents are not a valid tree. The string states the reason.
    Invalid(&'static str),
}

impl fmt::Display for LoadError {
    fn fmt(&self, f: &mut fmt::Formatter) -> fmt::Result {
        match self {
            LoadError::NotATree => f.write_str("the data is not a saved tree"),
            LoadError::UnsupportedVersion(version) => {
                write!(
                    f,
                    "the saved tree has format version {version}, which this version of the crate does not support"
                )
            }
            LoadError::WrongLength { expected, actual } => {
                write!(f, "the saved tree should have {expected} bytes, but has {actual}")
            }
            LoadError::Damaged => f.write_str("the saved tree is damaged: its checksum is wrong"),
            LoadError::Invalid(what) => write!(f, "the saved tree is invalid: {what}"),
        }
    }
}

impl std::error::Error for LoadError {}
