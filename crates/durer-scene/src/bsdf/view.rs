//! View of a surface point, for which the lobes of a material are built.

#[cfg(doc)]
use super::lobe::diffuse::Diffuse;
use crate::math::Vec3;
use crate::spectrum::Lanes;

/// View of a surface point for which the lobes of a principled material are built. The view
/// consists of a direction, lanes and the relative index of refraction.
#[derive(Clone, Copy, Debug)]
pub struct View<'a> {
    /// RGB lanes or wavelengths in which light is represented.
    pub lanes: &'a Lanes,
    /// Local direction to the viewer.
    pub wo: Vec3,
    /// Local normal of the diffuse lobes; see [`Diffuse::normal`].
    pub normal: Vec3,
    /// True if the point is seen from inside.
    pub inside: bool,
    /// Index of refraction behind the boundary, relative to the index in front of it.
    pub eta: f32,
}
