//! Answers to requests about rays, structures and models.

use super::scene::{FieldState, Place};
use serde::{Deserialize, Serialize};
#[cfg(test)]
use ts_rs::TS;

/// Acceleration structure over the objects of a scene.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Serialize, Deserialize)]
#[cfg_attr(test, derive(TS))]
#[serde(rename_all = "snake_case")]
pub enum Structure {
    /// Bounding volume hierarchy.
    Tree,
    /// A uniform grid.
    Grid,
    /// No structure: every object is tested.
    Nothing,
}

/// A camera ray.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
#[cfg_attr(test, derive(TS))]
pub struct RayAccount {
    /// Origin.
    pub origin: [f32; 3],
    /// Direction, of length 1.
    pub direction: [f32; 3],
    /// Ray parameter of the first hit.
    pub t: Option<f32>,
    /// Number of the hit object.
    pub object: Option<u32>,
}

/// Test of an object against a ray.
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize)]
#[cfg_attr(test, derive(TS))]
pub struct WalkTest {
    /// Number of the object.
    pub object: u32,
    /// Ray parameter of the first hit on the object.
    pub t: Option<f32>,
}

/// Visit of a box or cell.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
#[cfg_attr(test, derive(TS))]
pub struct WalkStep {
    /// Two opposite corners; `None` for objects outside the structure.
    pub bounds: Option<[[f32; 3]; 2]>,
    /// Depth of the box in its tree.
    pub level: u32,
    /// Tests of the objects in it.
    pub tests: Vec<WalkTest>,
    /// Ray parameter of the nearest hit after this step.
    pub closest: Option<f32>,
}

/// Traversal of a structure by a ray.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
#[cfg_attr(test, derive(TS))]
pub struct WalkAccount {
    /// Visited boxes or cells, in visiting order.
    pub steps: Vec<WalkStep>,
    /// Number of visited nodes or cells.
    pub visits: u32,
    /// Number of object tests.
    pub tests: u32,
    /// Number of objects.
    pub objects: u32,
    /// The first hit.
    pub hit: Option<WalkTest>,
    /// Boxes of the tree, or cells that contain objects, up to a limit.
    pub boxes: Vec<BoxState>,
}

/// A box, for drawing.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
#[cfg_attr(test, derive(TS))]
pub struct BoxState {
    /// Depth; 0 for the root's box.
    pub level: u32,
    /// The eight corners, three coordinates each: bits 0, 1 and 2 of a corner's number select x, y
    /// and z.
    pub corners: Vec<f32>,
}

/// A node of a scene.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
#[cfg_attr(test, derive(TS))]
pub struct TreeNode {
    /// Keyword or file name of the node.
    pub name: String,
    /// Position in the scene's text.
    pub place: Option<Place>,
    /// Number of the node's material.
    pub material: Option<u32>,
    /// Child nodes.
    pub nodes: Vec<TreeNode>,
}

/// A material.
#[derive(Clone, Debug, Serialize, Deserialize)]
#[cfg_attr(test, derive(TS))]
pub struct MaterialState {
    /// Keyword of the material.
    pub name: String,
    /// Position in the scene's text.
    pub place: Option<Place>,
    /// Fields of the material.
    pub fields: Vec<FieldState>,
}
