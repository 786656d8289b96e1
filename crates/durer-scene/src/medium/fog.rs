use crate::describe::{FileName, Rule, described};
use crate::dialect::set;
use crate::math::Vec3;

described! {
    /// Fog, smoke or dust in the air, which scatters and absorbs the light of lights and sky; it
    /// does not fill bodies of glass, and Whitted ray tracing ignores it.
    Fog ["Fog" in set::DURER] {
        /// Extinction coefficient per world unit: the transmittance of a distance is e^(-extinction
        /// · distance).
        extinction: f32 = 0.1, optional, Rule::Positive, ["extinction" in set::DURER];
        /// Scattering albedo: the share of light that is scattered and not absorbed, from 0 to 1.
        color: Vec3 = Vec3::ONE, optional, Rule::Any, ["color" in set::DURER];
        /// Mean cosine of the scattering, from -1 (backward) over 0 (isotropic) to 1 (forward).
        anisotropy: f32 = 0.0, optional, Rule::Between(-1.0, 1.0), ["anisotropy" in set::DURER];
        /// Corner of the box that the fog fills; without it, the fog is everywhere.
        min: Option<Vec3> = None, optional, Rule::Any, ["min" in set::DURER];
        /// Opposite corner of the box.
        max: Option<Vec3> = None, optional, Rule::Any, ["max" in set::DURER];
        /// Density file (Mitsuba's `.vol`) that fills the box and multiplies `extinction`; without
        /// a box, it fills the box of the file.
        density: Option<FileName> = None, optional, Rule::Any, ["density" in set::DURER];
    }
}
