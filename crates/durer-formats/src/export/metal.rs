//! Metals as complex indices of refraction.

use durer_scene::bsdf::fresnel::conductor;
use durer_scene::math::Vec3;

/// Largest reflectance at normal incidence for which an index is computed.
const PERFECT: f32 = 0.999;

/// Returns the complex index of refraction [eta, k] of a metal with these reflectances at normal
/// incidence and at 82 degrees. If there is none, the reflectance at 82 degrees is as near as
/// possible.
///
/// Source: Gulbrandsen, *Artist Friendly Metallic Fresnel*, Journal of Computer Graphics Techniques
/// 3(4), 2014, for the range of eta and for k as a function of eta; eta is found by bisection.
fn index_of_refraction(f0: f32, f82: f32) -> [f32; 2] {
    let f0 = f0.clamp(1e-4, PERFECT);
    let k_of = |n: f32| ((f0 * (n + 1.0) * (n + 1.0) - (n - 1.0) * (n - 1.0)) / (1.0 - f0)).max(0.0).sqrt();
    // The reflectance at 82 degrees falls as eta grows.
    let root = f0.sqrt();
    let (mut low, mut high) = ((1.0 - root) / (1.0 + root), (1.0 + root) / (1.0 - root));
    for _ in 0..48 {
        let middle = 0.5 * (low + high);
        if conductor(1.0 / 7.0, middle, k_of(middle)) > f82 { low = middle } else { high = middle }
    }
    let n = 0.5 * (low + high);
    [n, k_of(n)]
}

/// Returns [`index_of_refraction`] for red, green and blue: eta, and k.
pub(crate) fn indices_of_refraction(f0: Vec3, f82: Vec3) -> [Vec3; 2] {
    let index: [_; 3] = std::array::from_fn(|i| index_of_refraction(f0[i], f82[i]));
    [0, 1].map(|column| Vec3::from_array(index.map(|pair| pair[column])))
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn index_has_the_reflectances_of_the_metal() {
        // Values at 630, 532 and 465 nm; source: Palik, *Handbook of Optical Constants of Solids*,
        // 1985: gold, aluminium and chromium.
        for [n, k] in [[0.18, 3.0], [0.54, 2.23], [1.42, 1.84], [1.37, 7.6], [0.92, 6.4], [3.1, 3.3]] {
            let [f0, f82] = [1.0, 1.0 / 7.0].map(|cosine| conductor(cosine, n, k));
            let [eta, k] = index_of_refraction(f0, f82);
            let [r0, r82] = [1.0, 1.0 / 7.0].map(|cosine| conductor(cosine, eta, k));
            assert!((r0 - f0).abs() < 1e-4 && (r82 - f82).abs() < 1e-3, "{n}: {eta} {k}, {r82} {f82}");
        }
    }
}
