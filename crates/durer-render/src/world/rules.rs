//! Rules for shading and display, which the dialect selects when a scene is compiled.

use durer_scene::dialect::{DepthPicture, NormalsPicture};
use durer_scene::math::Vec3;
use serde::{Deserialize, Serialize};

/// Method by which an official program prevents secondary rays from hitting the surface that they
/// start from.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum Epsilon {
    /// Counts only hits beyond this `t`.
    MinT(f32),
    /// Moves the origin by the direction multiplied by this factor.
    OffsetOrigin(f32),
}

/// Rules for intersection, and for shading in the Whitted integrator, which the dialect selects.
/// The default rules are those of Dürer itself, without the bugs of the official programs.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct ShadingRules {
    /// Method by which secondary rays avoid the surface that they start from. If `None`, the origin
    /// is offset by the error bound of the surface point, and all hits count.
    pub epsilon: Option<Epsilon>,
    /// True if hit points are computed from the rounded ray, without an error bound.
    pub points_on_ray: bool,
    /// True if a ray has a single index of refraction, with air behind glass. If false, glass can
    /// be nested.
    pub one_medium: bool,
    /// True if the weight of a ray is multiplied by the length of a colour vector. If false, the
    /// weight is multiplied by the largest component of the colour.
    pub weight_by_length: bool,
    /// True if the shading normal decides which side of a surface is seen. If false, the geometric
    /// normal decides this.
    pub shaded_sides: bool,
    /// True if surfaces seen from behind are black, unless both sides are shaded.
    pub black_backs: bool,
    /// True if surfaces with a NaN normal are black.
    pub spoiled_normals: bool,
    /// True if shading normals are normalized before lighting is computed.
    pub unit_light: bool,
    /// True if shading normals can have any length, so that reflected directions must be
    /// normalized.
    pub raw_normals: bool,
    /// True if refraction does not normalize shading normals.
    pub raw_refraction: bool,
    /// True if reflected directions are not normalized.
    pub long_mirrors: bool,
    /// True if R0 is computed as if the index of refraction on the ray's side were 1.
    pub exit_r0: bool,
    /// True if only surfaces whose front faces the shadow ray cast shadows.
    pub shadow_fronts: bool,
    /// True if a ray that leaves glass that it never entered is assumed to have started in air.
    pub air_at_eye: bool,
    /// True if only meshes have texture coordinates.
    pub mesh_textures: bool,
    /// True if shading normals are transformed by the matrix itself instead of its inverse
    /// transpose.
    pub moved_normals: bool,
    /// True if the rings of wood are cones, as in the program of 2004.
    pub conic_rings: bool,
    /// True if ambient light on a texture uses the texel of the previous pixel. This rule is
    /// implemented in `render::stale` rather than in the integrators.
    pub stale_texels: bool,
}

/// Rules for displaying AOVs as pictures, which the dialect selects.
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize)]
pub struct DisplayRules {
    /// Method of converting normals to colours.
    pub normals: NormalsPicture,
    /// Method of converting depths to greys.
    pub depth: DepthPicture,
    /// True if a depth range set by the user is truncated to integers.
    #[serde(default)]
    pub whole_depths: bool,
    /// True if the background of a depth picture is black even though distant objects are white.
    #[serde(default)]
    pub black_sky: bool,
    /// True if a picture of normals shows the normal of the previous hit where a ray hits nothing.
    /// In this mode, rows are processed from the bottom up.
    #[serde(default)]
    pub stale_normals: bool,
    /// True if depths are clamped to the range set by the user before they are converted to greys.
    #[serde(default)]
    pub clamped_depths: bool,
    /// Luminous efficacy of each colour channel in lumens per watt, if light is measured in watts.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub lumens: Option<Vec3>,
}
