//! Gradient noise.
//!
//! Source: Ken Perlin, *Improving Noise*, SIGGRAPH 2002, including its published permutation.

use super::{Vec3, fp};

/// Published permutation of the integers from 0 to 255.
#[rustfmt::skip]
pub const PERMUTATION: [u8; 256] = [
    151,160,137,91,90,15,131,13,201,95,96,53,194,233,7,225,140,36,103,30,69,142,8,99,37,240,21,10,23,
    190,6,148,247,120,234,75,0,26,197,62,94,252,219,203,117,35,11,32,57,177,33,88,237,149,56,87,174,20,
    125,136,171,168,68,175,74,165,71,134,139,48,27,166,77,146,158,231,83,111,229,122,60,211,133,230,220,
    105,92,41,55,46,245,40,244,102,143,54,65,25,63,161,1,216,80,73,209,76,132,187,208,89,18,169,200,196,
    135,130,116,188,159,86,164,100,109,198,173,186,3,64,52,217,226,250,124,123,5,202,38,147,118,126,255,
    82,85,212,207,206,59,227,47,16,58,17,182,189,28,42,223,183,170,213,119,248,152,2,44,154,163,70,221,
    153,101,155,167,43,172,9,129,22,39,253,19,98,108,110,79,113,224,232,178,185,112,104,218,246,97,228,
    251,34,242,193,238,210,144,12,191,179,162,241,81,51,145,235,249,14,239,107,49,192,214,31,181,199,
    106,157,184,84,204,176,115,121,50,45,127,4,150,254,138,236,205,93,222,114,67,29,24,72,243,141,128,
    195,78,66,215,61,156,180,
];

fn permute(i: i32) -> i32 {
    i32::from(PERMUTATION[(i & 255) as usize])
}

/// Perlin's improved noise, which is smooth, zero at integer points, and within about (-1, 1).
pub fn perlin(p: Vec3) -> f32 {
    let floor = p.floor();
    // The lattice repeats every 256 cells because the permutation does.
    let cell = floor.rem_euclid(Vec3::splat(256.0));
    let (x, y, z) = (cell.x as i32, cell.y as i32, cell.z as i32);
    let f = p - floor;
    let fade = |t: f32| t * t * t * (t * (t * 6.0 - 15.0) + 10.0);
    let (u, v, w) = (fade(f.x), fade(f.y), fade(f.z));
    // Dot product of the gradient at a corner of the cell with the offset from that corner.
    let corner = |dx: i32, dy: i32, dz: i32| {
        let hash = permute(permute(permute(x + dx) + y + dy) + z + dz);
        gradient(hash, f - Vec3::new(dx as f32, dy as f32, dz as f32))
    };
    let edge = |dy, dz| lerp(u, corner(0, dy, dz), corner(1, dy, dz));
    let face = |dz| lerp(v, edge(0, dz), edge(1, dz));
    lerp(w, face(0), face(1))
}

/// Sum of noise octaves, where octave i has frequency 2^i and weight 2^-i. The sum is 0 without
/// octaves.
pub fn turbulence(p: Vec3, octaves: u32) -> f32 {
    let mut sum = 0.0;
    let mut frequency = 1.0;
    for _ in 0..octaves {
        sum += perlin(frequency * p) / frequency;
        frequency *= 2.0;
    }
    sum
}

/// Veins distorted by noise: (sin(frequency x + amplitude N(p)) + 1) / 2, where x is the coordinate
/// of `p` perpendicular to the veins.
pub fn veins(p: Vec3, x: f32, frequency: f32, amplitude: f32, octaves: u32) -> f32 {
    let phase = frequency * x + amplitude * turbulence(p, octaves);
    0.5 * (fp::sin(phase) + 1.0)
}

fn lerp(t: f32, a: f32, b: f32) -> f32 {
    a + t * (b - a)
}

/// Dot product with one of the twelve vectors from the centre of a cube to its edges.
fn gradient(hash: i32, p: Vec3) -> f32 {
    let h = hash & 15;
    let u = if h < 8 { p.x } else { p.y };
    let v = match h {
        0..4 => p.y,
        12 | 14 => p.x,
        _ => p.z,
    };
    (if h & 1 == 0 { u } else { -u }) + (if h & 2 == 0 { v } else { -v })
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn table_is_a_permutation() {
        let mut sorted = PERMUTATION;
        sorted.sort_unstable();
        assert!(sorted.iter().enumerate().all(|(i, &p)| i == usize::from(p)));
    }

    #[test]
    fn noise_is_zero_on_the_lattice_and_continuous() {
        for i in -300..300 {
            let p = Vec3::new(i as f32, (i * 7) as f32, (-i * 3) as f32);
            assert_eq!(perlin(p), 0.0);
            let q = p * 0.37;
            assert!((perlin(q + Vec3::splat(1e-3)) - perlin(q)).abs() < 0.02);
        }
    }
}
