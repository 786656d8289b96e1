//! Colour spaces that FLIP uses.

use durer_bvh::math::Vec3;

/// XYZ coordinates of white, which is the sum of red, green, and blue.
pub const WHITE: Vec3 = Vec3::new(0.950_428_55, 1.0, 1.088_900_4);

/// Converts linear Rec. 709 to CIE XYZ with the matrix of IEC 61966-2-1, computed in exact
/// fractions from the primaries.
#[inline(always)]
pub fn xyz_from_rgb(rgb: Vec3) -> Vec3 {
    const X: Vec3 = row(10_135_552.0, 8_788_810.0, 4_435_075.0, 24_577_794.0);
    const Y: Vec3 = row(2_613_072.0, 8_788_810.0, 887_015.0, 12_288_897.0);
    const Z: Vec3 = row(1_425_312.0, 8_788_810.0, 70_074_185.0, 73_733_382.0);
    Vec3::new(X.dot(rgb), Y.dot(rgb), Z.dot(rgb))
}

const fn row(r: f64, g: f64, b: f64, divisor: f64) -> Vec3 {
    Vec3::new((r / divisor) as f32, (g / divisor) as f32, (b / divisor) as f32)
}

/// Converts CIE XYZ to linear Rec. 709; this is the inverse of [`xyz_from_rgb`].
#[inline(always)]
pub fn rgb_from_xyz(xyz: Vec3) -> Vec3 {
    const R: Vec3 = Vec3::new(3.241_003_3, -1.537_399, -0.498_615_86);
    const G: Vec3 = Vec3::new(-0.969_224_33, 1.875_930_1, 0.041_554_224);
    const B: Vec3 = Vec3::new(0.055_639_423, -0.204_011_2, 1.057_148_9);
    Vec3::new(R.dot(xyz), G.dot(xyz), B.dot(xyz))
}

/// Converts XYZ values, relative to white, to L*a*b* with the Hunt effect, which scales a* and b*
/// by the lightness.
#[inline(always)]
pub fn hunt_lab(relative: Vec3) -> Vec3 {
    let f = |t: f32| {
        const DELTA: f32 = 6.0 / 29.0;
        let linear = t / (3.0 * DELTA * DELTA) + 4.0 / 29.0;
        if t > DELTA * DELTA * DELTA { cube_root(t) } else { linear }
    };
    let (x, y, z) = (f(relative.x), f(relative.y), f(relative.z));
    let lightness = 116.0 * y - 16.0;
    Vec3::new(lightness, 0.01 * lightness * 500.0 * (x - y), 0.01 * lightness * 200.0 * (y - z))
}

/// Returns the HyAB distance of two L*a*b* colours, which is the difference in lightness plus the
/// Euclidean distance in a* and b*.
///
/// Source: Abasi, Amani Tehran and Fairchild, *Distance metrics for very large color differences*,
/// 2020.
#[inline(always)]
pub fn hyab(a: Vec3, b: Vec3) -> f32 {
    let d = a - b;
    d.x.abs() + (d.y * d.y + d.z * d.z).sqrt()
}

/// Returns the cube root of a positive number, with an error of about two units in the last place.
/// Dividing the exponent by three gives the initial value for two iterations of Halley's method.
/// Unlike a library function, this code can be vectorised by compilers.
#[inline(always)]
fn cube_root(x: f32) -> f32 {
    let mut root = f32::from_bits(x.to_bits() / 3 + 0x2a51_37a0);
    for _ in 0..2 {
        let cube = root * root * root;
        root *= (cube + 2.0 * x) / (2.0 * cube + x);
    }
    root
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn cube_roots() {
        for i in 1..10_000 {
            let root = i as f32 / 5000.0;
            assert!((cube_root(root * root * root) / root - 1.0).abs() < 5e-7, "{root}");
        }
    }

    #[test]
    fn white_is_white_and_there_is_a_way_back() {
        assert!((xyz_from_rgb(Vec3::ONE) / WHITE - 1.0).length() < 1e-6);
        assert!((hunt_lab(Vec3::ONE) - Vec3::new(100.0, 0.0, 0.0)).length() < 1e-4);
        assert!(hunt_lab(Vec3::ZERO).length() < 1e-4);
        for rgb in [Vec3::X, Vec3::Y, Vec3::Z, Vec3::new(0.2, 0.7, 0.4)] {
            assert!((rgb_from_xyz(xyz_from_rgb(rgb)) - rgb).length() < 1e-5);
        }
    }
}
