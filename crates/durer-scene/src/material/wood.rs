//! Wood pattern of rings around the y axis. The share of the first material is (sin(frequency r +
//! amplitude N) + 1) / 2, where r is the distance from the axis and N is noise.
//!
//! The course does not define the profile of the rings. [`Wood::conic`] uses the profile of the
//! official program.

use super::{MAX_OCTAVES, Pattern};
use crate::describe::{Constraint, described};
use crate::dialect::set;
use crate::math::{Vec3, fp, noise};

described! {
    /// A wood pattern: two materials in rings around the y axis.
    Wood ["Wood" in set::OLD | set::DURER] {
        /// Material where the sine is 1.
        material1: u32 = 0, required, Constraint::Any, ["materialIndex" in set::ALL];
        /// Material where the sine is -1.
        material2: u32 = 0, required, Constraint::Any, ["materialIndex" in set::ALL];
        /// Number of noise octaves, each with twice the frequency of the previous one.
        octaves: u32 = 0, required, Constraint::AtMost(MAX_OCTAVES), ["octaves" in set::ALL];
        /// Number of rings per 2 pi along the radius.
        frequency: f32 = 1.0, required, Constraint::Any, ["frequency" in set::ALL];
        /// Strength of the noise that distorts the rings.
        amplitude: f32 = 1.0, required, Constraint::Any, ["amplitude" in set::ALL];
    }
}

impl Wood {
    /// Share of the first material with the quirk `conic-rings`. The rings resemble those of a
    /// trunk, since their radius decreases by a twentieth of the height. They have bands of full
    /// colour with edges that rise quadratically.
    pub fn conic(&self, q: Vec3) -> f32 {
        let radius = (q.x * q.x + q.z * q.z).sqrt() + 0.05 * q.y;
        let grain = noise::turbulence(Vec3::new(q.x, 0.2 * q.y, q.z), self.octaves);
        let share = (fp::sin(self.frequency * radius + self.amplitude * grain) + 0.5).clamp(0.0, 1.0);
        share * share
    }
}

impl Pattern for Wood {
    fn weight(&self, q: Vec3) -> f32 {
        let radius = (q.x * q.x + q.z * q.z).sqrt();
        noise::veins(q, radius, self.frequency, self.amplitude, self.octaves)
    }

    fn materials(&self) -> [u32; 2] {
        [self.material1, self.material2]
    }
}
