use crate::describe::{FileName, Rule, described};
use crate::dialect::set;
use crate::math::Vec3;

described! {
    /// What is in the air: fog, smoke, dust. Light of lamps and of the sky is scattered and
    /// absorbed in it. It is not in bodies of glass, and Whitted's light does not see it.
    Fog ["Fog" in set::DURER] {
        /// How dense it is: of light that goes straight on, a share of e^(-extinction · distance)
        /// is left.
        extinction: f32 = 0.1, optional, Rule::Positive, ["extinction" in set::DURER];
        /// The share of light that is scattered, and not absorbed, where it meets the fog; from 0
        /// to 1.
        color: Vec3 = Vec3::ONE, optional, Rule::Any, ["color" in set::DURER];
        /// Where light goes that is scattered: from -1 (back) over 0 (evenly) to 1 (onwards).
        anisotropy: f32 = 0.0, optional, Rule::Between(-1.0, 1.0), ["anisotropy" in set::DURER];
        /// A corner of the box that the fog is in; without, it is everywhere.
        min: Option<Vec3> = None, optional, Rule::Any, ["min" in set::DURER];
        /// The corner across.
        max: Option<Vec3> = None, optional, Rule::Any, ["max" in set::DURER];
        /// A file of densities (Mitsuba's `.vol`) that fill the box and multiply `extinction`;
        /// without a box, that of the file.
        density: Option<FileName> = None, optional, Rule::Any, ["density" in set::DURER];
    }
}
