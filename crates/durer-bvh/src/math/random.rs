//! Reproducible random numbers for tests.

use glam::{DAffine3, DMat3, DQuat, Vec3};

/// Returns the number of rounds of a test: `usual` times `DURER_ROUNDS`, which `cargo xtask long`
/// sets. Under Miri, which is far slower, the number is divided by 500.
pub fn rounds(usual: usize) -> usize {
    let usual = if cfg!(miri) { usual.div_ceil(500) } else { usual };
    let times = std::env::var("DURER_ROUNDS").ok();
    usual * times.map_or(1, |times| times.parse::<usize>().expect("DURER_ROUNDS is a whole number"))
}

/// A SplitMix64 random number generator for reproducible tests. Source: Steele, Lea, Flood, *Fast
/// Splittable Pseudorandom Number Generators*, OOPSLA 2014.
pub struct Random(pub u64);

impl Random {
    /// Returns 64 random bits.
    pub fn bits(&mut self) -> u64 {
        self.0 = self.0.wrapping_add(0x9E37_79B9_7F4A_7C15);
        let z = (self.0 ^ self.0 >> 30).wrapping_mul(0xBF58_476D_1CE4_E5B9);
        let z = (z ^ z >> 27).wrapping_mul(0x94D0_49BB_1331_11EB);
        z ^ z >> 31
    }

    /// Returns a uniform random number in [0, 1).
    pub fn unit(&mut self) -> f32 {
        (self.bits() >> 40) as f32 / (1u64 << 24) as f32
    }

    /// Returns a uniform random number between `low` and `high`.
    pub fn between(&mut self, low: f32, high: f32) -> f32 {
        low + (high - low) * self.unit()
    }

    /// Returns a random integer below `count`.
    pub fn below(&mut self, count: usize) -> usize {
        (self.bits() % count as u64) as usize
    }

    /// Returns a uniform random point in the cube [-1, 1]^3.
    pub fn point(&mut self) -> Vec3 {
        Vec3::new(self.between(-1.0, 1.0), self.between(-1.0, 1.0), self.between(-1.0, 1.0))
    }

    /// Returns a uniform random direction on the sphere.
    pub fn direction(&mut self) -> Vec3 {
        loop {
            let p = self.point();
            if (0.01..=1.0).contains(&p.length_squared()) {
                return p.normalize();
            }
        }
    }

    /// Returns a rotation about a random axis.
    pub fn rotation(&mut self) -> DMat3 {
        let axis = self.direction().as_dvec3().normalize();
        DMat3::from_quat(DQuat::from_axis_angle(axis, f64::from(self.between(-3.1, 3.1))))
    }

    /// Returns a random map that scales along rotated axes by factors from 1/`stretch` to
    /// `stretch`, sometimes mirrors, and then translates within a cube of half size `distance`.
    pub fn affine(&mut self, stretch: f32, distance: f32) -> DAffine3 {
        let mut factor = || {
            let sign = if self.bits() & 1 == 0 { 1.0 } else { -1.0 };
            sign * libm::pow(f64::from(stretch), f64::from(self.between(-1.0, 1.0)))
        };
        let scale = DMat3::from_diagonal(glam::DVec3::new(factor(), factor(), factor()));
        let linear = self.rotation() * scale * self.rotation();
        DAffine3::from_mat3_translation(linear, (distance * self.point()).as_dvec3())
    }
}
