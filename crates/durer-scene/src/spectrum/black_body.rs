//! Black-body radiation.

use crate::math::fp;

/// First radiation constant for radiance, 2 h c², scaled so that wavelengths in micrometres give a
/// result in W/(m² sr nm). Source: CODATA 2018 (exact h and c).
const C1: f32 = 1.191_043e5;

/// Second radiation constant, h c / k, in nm K. Source: CODATA 2018, 1.438776877e-2 m K (exact).
pub const C2: f32 = 1.438_776_9e7;

/// Spectral radiance of a black body at a wavelength in nanometres, in W/(m² sr nm). Source:
/// Planck's law.
pub fn planck(nm: f32, kelvin: f32) -> f32 {
    let um = nm * 1e-3;
    let value = C1 / (um * um * um * um * um * (fp::exp(C2 / (nm * kelvin)) - 1.0));
    if value.is_finite() { value } else { 0.0 }
}

/// Radiance of a black body relative to its radiance at 560 nm; 0 if the ratio is not finite.
pub fn planck_ratio(nm: f32, kelvin: f32) -> f32 {
    let ratio = planck(nm, kelvin) / planck(560.0, kelvin);
    if ratio.is_finite() { ratio } else { 0.0 }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn planck_agrees_with_wien_and_stefan_boltzmann() {
        // Wien's displacement law uses the constant 2.897771955e-3 m K.
        for kelvin in [3_000.0, 5_000.0, 7_000.0] {
            let peak = 2.897_772e6 / kelvin;
            assert!(planck(peak, kelvin) > planck(peak - 20.0, kelvin));
            assert!(planck(peak, kelvin) > planck(peak + 20.0, kelvin));
        }
        // The integral of the spectrum up to 40 um is sigma T^4 / pi, with sigma = 5.670374419e-8
        // W/(m² K^4).
        let kelvin = 5_000.0_f32;
        let sum: f64 = (0..40_000).map(|nm| f64::from(planck(nm as f32 + 0.5, kelvin))).sum();
        let expected = 5.670_374_4e-8 * f64::from(kelvin * kelvin) * f64::from(kelvin * kelvin) / std::f64::consts::PI;
        assert!((sum / expected - 1.0).abs() < 1e-3, "{sum} {expected}");
        assert_eq!(planck_ratio(560.0, 2_856.0), 1.0);
        assert_eq!(planck_ratio(400.0, 1.0), 0.0);
    }
}
