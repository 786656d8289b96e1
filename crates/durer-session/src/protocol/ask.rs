//! Answers about rays, structures and models.

use super::scene::{FieldState, Place};
use serde::{Deserialize, Serialize};
#[cfg(test)]
use ts_rs::TS;

/// A structure over the objects of a scene.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Serialize, Deserialize)]
#[cfg_attr(test, derive(TS))]
#[serde(rename_all = "snake_case")]
pub enum Structure {
    /// A tree of boxes.
    Tree,
    /// A uniform grid.
    Grid,
    /// None: every object is tested.
    Nothing,
}

/// A ray of the camera.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
#[cfg_attr(test, derive(TS))]
pub struct RayAccount {
    /// Origin.
    pub origin: [f32; 3],
    /// Direction, of length 1.
    pub direction: [f32; 3],
    /// Position of the first hit along the ray.
    pub t: Option<f32>,
    /// Number of the object that is hit.
    pub object: Option<u32>,
}

/// Test of a ray against an object.
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize)]
#[cfg_attr(test, derive(TS))]
pub struct WalkTest {
    /// Number of the object.
    pub object: u32,
    /// Position of its first hit along the ray.
    pub t: Option<f32>,
}

/// Visit of a box or cell.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
#[cfg_attr(test, derive(TS))]
pub struct WalkStep {
    /// Two opposite corners; `None` for objects outside the structure.
    pub bounds: Option<[[f32; 3]; 2]>,
    /// Depth of a box in its tree.
    pub level: u32,
    /// Objects that are tested there.
    pub tests: Vec<WalkTest>,
    /// Least `t` after it.
    pub closest: Option<f32>,
}

/// Way of a ray through a structure.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
#[cfg_attr(test, derive(TS))]
pub struct WalkAccount {
    /// Visited boxes or cells, in order.
    pub steps: Vec<WalkStep>,
    /// Number of visited nodes or cells.
    pub visits: u32,
    /// Number of tests against objects.
    pub tests: u32,
    /// Number of objects.
    pub objects: u32,
    /// The first hit.
    pub hit: Option<WalkTest>,
    /// Boxes of the tree, or cells with objects in them, up to a limit.
    pub boxes: Vec<BoxState>,
}

/// A box, for drawing.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
#[cfg_attr(test, derive(TS))]
pub struct BoxState {
    /// Depth; 0 for the box around everything.
    pub level: u32,
    /// Its eight corners, three numbers each: bit 0 of a corner's number is x, bit 1 y, bit 2 z.
    pub corners: Vec<f32>,
}

/// A node of a scene.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
#[cfg_attr(test, derive(TS))]
pub struct TreeNode {
    /// Its keyword or file.
    pub name: String,
    /// Place in the scene's text.
    pub place: Option<Place>,
    /// Number of its material.
    pub material: Option<u32>,
    /// Nodes below it.
    pub nodes: Vec<TreeNode>,
}

/// A material.
#[derive(Clone, Debug, Serialize, Deserialize)]
#[cfg_attr(test, derive(TS))]
pub struct MaterialState {
    /// Its keyword.
    pub name: String,
    /// Place in the scene's text.
    pub place: Option<Place>,
    /// Its fields.
    pub fields: Vec<FieldState>,
}
