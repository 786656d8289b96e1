//! What can be wrong with what trees are made of.

use std::fmt;

/// Why a tree cannot be built, or fitted to other vertices.
#[derive(Clone, Debug, PartialEq, Eq)]
#[non_exhaustive]
pub enum BuildError {
    /// A triangle names a vertex that is not there.
    MissingVertex {
        /// Number of the triangle.
        triangle: usize,
        /// The vertex that it names.
        index: u32,
        /// How many vertices there are.
        vertices: usize,
    },
    /// There are 2^28 triangles or more.
    TooManyTriangles {
        /// How many there are.
        triangles: usize,
    },
    /// A flat list of coordinates or indices has a length that is no multiple of three.
    NotInThrees {
        /// `positions` or `indices`.
        list: &'static str,
        /// Its length.
        len: usize,
    },
    /// There are fewer than two lines either way, or not as many heights as crossings.
    NoGrid {
        /// How many lines go along z.
        columns: usize,
        /// How many lines go along x.
        rows: usize,
        /// How many heights were given.
        heights: usize,
    },
    /// A grid of heights has numbers that are not finite.
    NotFinite,
    /// A tree is refitted to another number of triangles than it was built over.
    OtherTriangles {
        /// How many it was built over.
        built: usize,
        /// How many were given.
        given: usize,
    },
}

impl fmt::Display for BuildError {
    fn fmt(&self, f: &mut fmt::Formatter) -> fmt::Result {
        match self {
            BuildError::MissingVertex { triangle, index, vertices } => {
                write!(f, "triangle {triangle} names vertex {index}, but there are {vertices}, counted from 0")
            }
            BuildError::TooManyTriangles { triangles } => {
                write!(f, "{triangles} triangles: a tree holds less than 2^28")
            }
            BuildError::NotInThrees { list, len } => write!(f, "{list} has {len} numbers, which is no multiple of 3"),
            BuildError::NoGrid { columns, rows, heights } => {
                write!(
                    f,
                    "{columns} times {rows} lines need two at least either way, and as many heights: not {heights}"
                )
            }
            BuildError::NotFinite => write!(f, "a grid of heights has numbers that are not finite"),
            BuildError::OtherTriangles { built, given } => {
                write!(f, "the tree was built over {built} triangles, but {given} were given")
            }
        }
    }
}

impl std::error::Error for BuildError {}

/// Why bytes are no tree.
#[derive(Clone, Debug, PartialEq, Eq)]
#[non_exhaustive]
pub enum LoadError {
    /// They do not begin as saved trees do.
    NotATree,
    /// They were saved in a format that this version does not read.
    Version(u32),
    /// There are fewer or more of them than they say.
    Length {
        /// As many as there should be.
        expected: u64,
        /// As many as there are.
        found: usize,
    },
    /// Their checksum is wrong: they were damaged.
    Damaged,
    /// They are no tree that this crate has made; what is wrong.
    Invalid(&'static str),
}

impl fmt::Display for LoadError {
    fn fmt(&self, f: &mut fmt::Formatter) -> fmt::Result {
        match self {
            LoadError::NotATree => f.write_str("this is no saved tree"),
            LoadError::Version(version) => write!(f, "the tree is saved in format {version}, which is not known here"),
            LoadError::Length { expected, found } => {
                write!(f, "the saved tree should have {expected} bytes, but has {found}")
            }
            LoadError::Damaged => f.write_str("the saved tree is damaged: its checksum is wrong"),
            LoadError::Invalid(what) => write!(f, "the saved tree is wrong: {what}"),
        }
    }
}

impl std::error::Error for LoadError {}
