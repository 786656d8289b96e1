//! Hair and fur: fibres that transmit light.

use crate::describe::{Constraint, described};
use crate::dialect::set;
use crate::math::Vec3;

described! {
    /// Hair or fur for path tracing, on thin tubes along which the texture coordinate u increases,
    /// such as converted curves; their inside is not visible. `absorption` takes precedence over
    /// `color`, and `color` over the melanins.
    HairMaterial ["HairMaterial" in set::DURER] {
        /// Amount of brown and black pigment: 0.3 in blond hair, 1.3 in brown, 8 in black.
        eumelanin: f32 = 1.3, optional, Constraint::NonNegative, ["eumelanin" in set::DURER];
        /// Amount of yellow and red pigment: 1.2 or more in red hair.
        pheomelanin: f32 = 0.0, optional, Constraint::NonNegative, ["pheomelanin" in set::DURER];
        /// Colour of a bundle of many fibres, from 0 to 1.
        color: Option<Vec3> = None, optional, Constraint::Any, ["color" in set::DURER];
        /// Absorption coefficient inside a fibre, per fibre radius, for red, green and blue.
        absorption: Option<Vec3> = None, optional, Constraint::Any, ["absorption" in set::DURER];
        /// Roughness along a fibre, from 0 to 1.
        longitudinal_roughness: f32 = 0.3, optional, Constraint::UnitInterval, ["longitudinalRoughness" in set::DURER];
        /// Roughness around a fibre, from 0 to 1.
        azimuthal_roughness: f32 = 0.3, optional, Constraint::UnitInterval, ["azimuthalRoughness" in set::DURER];
        /// Tilt in degrees of the cuticle scales of a fibre towards its tip.
        scale_tilt: f32 = 2.0, optional, Constraint::Within(-45.0, 45.0), ["scaleTilt" in set::DURER];
        /// Index of refraction.
        ior: f32 = 1.55, optional, Constraint::Within(1.0, 4.0), ["ior" in set::DURER];
    }
}
