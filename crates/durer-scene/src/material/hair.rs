//! Hair and fur: fibres that light goes through.

use crate::describe::{Rule, described};
use crate::dialect::set;
use crate::math::Vec3;

described! {
    /// Hair or fur, for paths: what mirrors light, lets it through and colours it on the way. It
    /// is meant for thin tubes, along which the texture coordinate u grows, as curves of other
    /// programs become them; from inside they are not seen. `absorption` counts, else `color`, else
    /// the melanins.
    HairMaterial ["HairMaterial" in set::DURER] {
        /// How much of brown and black pigment there is: 0.3 in blond hair, 1.3 in brown, 8 in black.
        eumelanin: f32 = 1.3, optional, Rule::NonNegative, ["eumelanin" in set::DURER];
        /// How much of yellow and red pigment there is: 1.2 or more in red hair.
        pheomelanin: f32 = 0.0, optional, Rule::NonNegative, ["pheomelanin" in set::DURER];
        /// The colour that many fibres show together, from 0 to 1.
        color: Option<Vec3> = None, optional, Rule::Any, ["color" in set::DURER];
        /// How much light loses inside for each radius of a fibre, for red, green and blue.
        absorption: Option<Vec3> = None, optional, Rule::Any, ["absorption" in set::DURER];
        /// How much light spreads along a fibre.
        longitudinal_roughness: f32 = 0.3, optional, Rule::Share, ["longitudinalRoughness" in set::DURER];
        /// How much light spreads around a fibre.
        azimuthal_roughness: f32 = 0.3, optional, Rule::Share, ["azimuthalRoughness" in set::DURER];
        /// By how many degrees the scales of a fibre rise towards its end.
        scale_tilt: f32 = 2.0, optional, Rule::From(-45.0, 45.0), ["scaleTilt" in set::DURER];
        /// Index of refraction.
        ior: f32 = 1.55, optional, Rule::From(1.0, 4.0), ["ior" in set::DURER];
    }
}
