use crate::describe::{Constraint, FileName, described};
use crate::dialect::set;
use crate::math::Vec3;

described! {
    /// Fog, smoke or dust in the air, which scatters and absorbs light. It does not fill glass
    /// objects, and Whitted ray tracing ignores it.
    Fog ["Fog" in set::DURER] {
        /// Extinction coefficient per world unit: the transmittance over a distance is
        /// e^(-extinction · distance).
        extinction: f32 = 0.1, optional, Constraint::Positive, ["extinction" in set::DURER];
        /// Scattering albedo: the fraction of light that is scattered instead of absorbed, from 0
        /// to 1.
        color: Vec3 = Vec3::ONE, optional, Constraint::Any, ["color" in set::DURER];
        /// Mean cosine of the scattering angle: -1 is backward, 0 isotropic, 1 forward.
        anisotropy: f32 = 0.0, optional, Constraint::Between(-1.0, 1.0), ["anisotropy" in set::DURER];
        /// Corner of the box that the fog fills; without it, the fog is everywhere.
        min: Option<Vec3> = None, optional, Constraint::Any, ["min" in set::DURER];
        /// Opposite corner of the box.
        max: Option<Vec3> = None, optional, Constraint::Any, ["max" in set::DURER];
        /// Density file (Mitsuba's `.vol`) that is fitted to the box and multiplies `extinction`;
        /// without `min` and `max`, the box in the file is used.
        density: Option<FileName> = None, optional, Constraint::Any, ["density" in set::DURER];
    }
}
