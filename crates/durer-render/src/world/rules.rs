//! Rules of shading and display, resolved from a scene's dialect when it is compiled.

use durer_scene::dialect::{DepthPicture, NormalsPicture};
use durer_scene::math::Vec3;
use serde::{Deserialize, Serialize};

/// Rule of an official program that keeps a secondary ray off the surface that it leaves.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum Epsilon {
    /// Hits count beyond this `t`.
    Least(f32),
    /// The ray's origin is offset by this multiple of its direction.
    Along(f32),
}

/// Rules of intersection and of Whitted's shading. Plain values, constant in a world; the default
/// is Dürer's own, without the bugs of old programs.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct ShadingRules {
    /// Rule that keeps secondary rays off surfaces. `None`: they start next to the surface, by the
    /// bound on its error, and every hit counts.
    pub epsilon: Option<Epsilon>,
    /// A hit's position is the rounded point on the ray, without an error bound.
    pub points_on_ray: bool,
    /// A ray carries one index of refraction, and air is assumed behind glass. Otherwise, media
    /// nest.
    pub one_medium: bool,
    /// A ray's throughput is multiplied by the length of a colour; otherwise, by its largest
    /// component.
    pub weight_by_length: bool,
    /// The shading normal determines which side of a surface is seen; otherwise, the geometric
    /// normal.
    pub shaded_sides: bool,
    /// A surface seen from behind is black, unless it is shaded on both sides.
    pub black_backs: bool,
    /// A surface with a NaN normal is black.
    pub spoiled_normals: bool,
    /// Lighting uses unit normals, regardless of the length of the shading normal.
    pub unit_light: bool,
    /// Shading normals may not be unit length, so reflected directions are normalised.
    pub raw_normals: bool,
    /// Refraction uses such a normal without normalising it.
    pub raw_refraction: bool,
    /// Mirrored directions are not normalised.
    pub long_mirrors: bool,
    /// R0 assumes that the ray's side of glass is air.
    pub exit_r0: bool,
    /// Only a blocker that is seen from its front casts a shadow.
    pub shadow_fronts: bool,
    /// A ray that leaves glass without having entered it is assumed to start in air.
    pub air_at_eye: bool,
    /// Only meshes have texture coordinates.
    pub mesh_textures: bool,
    /// Shading normals are transformed by the matrix itself, not by its inverse transpose.
    pub moved_normals: bool,
    /// Rings of wood are cones, with the formula of the program of 2004.
    pub conic_rings: bool,
    /// On a texture, ambient light uses the texel of the previous pixel. Implemented in
    /// `render::course`, not by integrators.
    pub stale_texels: bool,
}

/// Rules for displaying values, resolved from a scene's dialect at compilation.
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize)]
pub struct DisplayRules {
    /// Normals as colours.
    pub normals: NormalsPicture,
    /// Depth as grey.
    pub depth: DepthPicture,
    /// A given depth range is truncated to whole numbers.
    #[serde(default)]
    pub whole_depths: bool,
    /// The background of a depth picture is black, even if far is white.
    #[serde(default)]
    pub black_sky: bool,
    /// At misses, a normal picture shows the previous hit's normal, in rows from the bottom.
    #[serde(default)]
    pub stale_normals: bool,
    /// A depth is clamped to the given range before it is converted to grey.
    #[serde(default)]
    pub clamped_depths: bool,
    /// Lumens per watt by colour channel, if light is in watts.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub lumens: Option<Vec3>,
}
