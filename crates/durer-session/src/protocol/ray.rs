//! Answers to requests about rays, acceleration structures and models.

use super::scene::{FieldState, TextPosition};
use serde::{Deserialize, Serialize};
#[cfg(test)]
use ts_rs::TS;

/// Acceleration structure for the objects of a scene. A page shows how rays traverse it.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Serialize, Deserialize)]
#[cfg_attr(test, derive(TS))]
#[serde(rename_all = "snake_case")]
pub enum Structure {
    /// A bounding volume hierarchy.
    Tree,
    /// A uniform grid.
    Grid,
    /// No acceleration structure, so every object is tested.
    Nothing,
}

/// A camera ray through the centre of a pixel, with its first hit.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
#[cfg_attr(test, derive(TS))]
pub struct CameraRay {
    /// Origin.
    pub origin: [f32; 3],
    /// Direction, of length 1.
    pub direction: [f32; 3],
    /// Ray parameter of the first hit.
    pub t: Option<f32>,
    /// Number of the hit object.
    pub object: Option<u32>,
}

/// Test of an object during a traversal, with the value of `t` at its first hit.
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize)]
#[cfg_attr(test, derive(TS))]
pub struct TraversalTest {
    /// Number of the object.
    pub object: u32,
    /// Ray parameter of the first hit on the object.
    pub t: Option<f32>,
}

/// One step of a traversal. It contains the box or cell that the ray visits and the tests of
/// objects there.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
#[cfg_attr(test, derive(TS))]
pub struct TraversalStep {
    /// Two opposite corners; `None` for objects outside the structure.
    pub bounds: Option<[[f32; 3]; 2]>,
    /// Depth of the box in its tree.
    pub level: u32,
    /// Tests of the objects in it.
    pub tests: Vec<TraversalTest>,
    /// Ray parameter of the nearest hit after this step.
    pub closest: Option<f32>,
}

/// Traversal of an acceleration structure by a ray, as a list of steps.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
#[cfg_attr(test, derive(TS))]
pub struct Traversal {
    /// Visited boxes or cells, in visiting order.
    pub steps: Vec<TraversalStep>,
    /// Number of visited nodes or cells.
    pub visits: u32,
    /// Number of object tests.
    pub tests: u32,
    /// Number of objects.
    pub objects: u32,
    /// The first hit.
    pub hit: Option<TraversalTest>,
    /// Boxes of the tree, or cells that contain objects, up to a limit.
    pub boxes: Vec<TreeBox>,
}

/// Bounding box of a BVH node or a grid cell, which a page draws.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
#[cfg_attr(test, derive(TS))]
pub struct TreeBox {
    /// Depth; 0 for the root's box.
    pub level: u32,
    /// The eight corners, three coordinates each: bits 0, 1 and 2 of a corner's number select x, y
    /// and z.
    pub corners: Vec<f32>,
}

/// A node in the tree of groups and objects that a scene consists of.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
#[cfg_attr(test, derive(TS))]
pub struct SceneNode {
    /// Keyword or file name of the node.
    pub name: String,
    /// Position in the scene's text.
    pub place: Option<TextPosition>,
    /// Number of the object in the list of [`super::SceneSummary`]; `None` for groups, transforms
    /// and objects that are rendered as several.
    pub object: Option<u32>,
    /// Number of the node's material.
    pub material: Option<u32>,
    /// Child nodes.
    pub nodes: Vec<SceneNode>,
}

/// A material of a scene, with the fields that a page can show and edit.
#[derive(Clone, Debug, Serialize, Deserialize)]
#[cfg_attr(test, derive(TS))]
pub struct MaterialState {
    /// Keyword of the material.
    pub name: String,
    /// Position in the scene's text.
    pub place: Option<TextPosition>,
    /// Fields of the material.
    pub fields: Vec<FieldState>,
}
