//! Rules for shading and display, which the dialect determines when a scene is compiled.

use durer_scene::dialect::{DepthPicture, NormalsPicture};
use durer_scene::math::Vec3;
use serde::{Deserialize, Serialize};

/// How an official program prevents secondary rays from hitting the surface that they start from.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum Epsilon {
    /// Only hits beyond this `t` count.
    MinT(f32),
    /// The origin is moved along the direction by this multiple of it.
    OffsetOrigin(f32),
}

/// Rules for intersection and for shading in the Whitted integrator, which the dialect determines.
/// The default rules are Dürer's own, without the bugs of the official programs.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct ShadingRules {
    /// How secondary rays avoid the surface they start from. `None`: the origin is offset by the
    /// error bound of the surface point, and all hits count.
    pub epsilon: Option<Epsilon>,
    /// Hit points are computed from the rounded ray, without an error bound.
    pub points_on_ray: bool,
    /// A ray has a single index of refraction, with air behind glass. If false, glass can be
    /// nested.
    pub one_medium: bool,
    /// The weight of a ray is multiplied by the length of a colour. If false, by its largest
    /// component.
    pub weight_by_length: bool,
    /// The shading normal decides which side of a surface is seen. If false, the geometric normal
    /// does.
    pub shaded_sides: bool,
    /// Surfaces seen from behind are black, unless both sides are shaded.
    pub black_backs: bool,
    /// Surfaces with a NaN normal are black.
    pub spoiled_normals: bool,
    /// Lighting normalizes shading normals first.
    pub unit_light: bool,
    /// Shading normals can have any length, so reflected directions must be normalized.
    pub raw_normals: bool,
    /// Refraction does not normalize such normals.
    pub raw_refraction: bool,
    /// Reflected directions are not normalized.
    pub long_mirrors: bool,
    /// R0 is computed as if the index of refraction on the ray's side were 1.
    pub exit_r0: bool,
    /// Only surfaces whose front faces the shadow ray cast shadows.
    pub shadow_fronts: bool,
    /// A ray that leaves glass that it did not enter is assumed to start in air.
    pub air_at_eye: bool,
    /// Shapes other than meshes have no texture coordinates.
    pub mesh_textures: bool,
    /// Shading normals are transformed by the matrix itself instead of its inverse transpose.
    pub moved_normals: bool,
    /// The rings of wood are cones, as in the program of 2004.
    pub conic_rings: bool,
    /// On a texture, ambient light uses the texel of the previous pixel. Implemented in
    /// `render::stale`, not in the integrators.
    pub stale_texels: bool,
}

/// Rules for displaying AOVs as pictures, which the dialect determines.
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize)]
pub struct DisplayRules {
    /// How normals are converted to colours.
    pub normals: NormalsPicture,
    /// How depths are converted to greys.
    pub depth: DepthPicture,
    /// A depth range set by the user is truncated to integers.
    #[serde(default)]
    pub whole_depths: bool,
    /// The background of a depth picture is black, even if far objects are white.
    #[serde(default)]
    pub black_sky: bool,
    /// At misses, a picture of normals shows the previous hit's normal. Rows are processed from the
    /// bottom up.
    #[serde(default)]
    pub stale_normals: bool,
    /// Depths are clamped to the range set by the user before they are converted to greys.
    #[serde(default)]
    pub clamped_depths: bool,
    /// Luminous efficacy of each colour channel in lumens per watt, if light is in watts.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub lumens: Option<Vec3>,
}
