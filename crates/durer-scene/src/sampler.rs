//! Random numbers for samples. Each is a pure function of the seed, the pixel, the sample index and
//! the dimension.
//!
//! The generators have no state, so the order of work cannot change a number.
//!
//! Sources: the mixing function is the finaliser of SplitMix64 (Steele, Lea, Flood, *Fast
//! Splittable Pseudorandom Number Generators*, OOPSLA 2014; constants: Stafford's variant 13). The
//! sequence is the two-dimensional Sobol sequence with hash-based nested uniform scrambling (Laine,
//! Karras, *Stratified Sampling for Stochastic Transparency*, EGSR 2011). It is padded and shuffled
//! as in Burley, *Practical Hash-based Owen Scrambling*, JCGT 9(4), 2020. The scrambling hash is
//! taken from Vegdahl, *Building a Better LK Hash*, 2021, and is less biased than the published
//! constants.

use crate::math::Vec2;
use durer_bvh::internal::{PlainKernel, run_plain};
use serde::{Deserialize, Serialize};
use std::array::from_fn;

#[cfg(any(test, feature = "testing"))]
#[doc(hidden)]
pub mod testing;
#[cfg(test)]
mod tests;

/// Method that distributes samples within a pixel, selected by `--sampler`.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Serialize, Deserialize)]
pub enum Sampler {
    /// Owen-scrambled Sobol (0,2)-sequence, scrambled differently in each pixel. This sampler gives
    /// the least noise.
    #[default]
    Sobol,
    /// Independent, uniformly distributed random positions.
    Random,
    /// Centres of the cells of a regular grid.
    Uniform,
    /// One uniformly distributed position in each cell of a regular grid.
    Jittered,
}

/// The largest `f32` below 1.
const BELOW_ONE: f32 = 1.0 - f32::EPSILON * 0.5;

impl Sampler {
    /// Samplers and their names on the command line.
    pub const NAMES: [(&'static str, Sampler); 4] = [
        ("sobol", Sampler::Sobol),
        ("random", Sampler::Random),
        ("uniform", Sampler::Uniform),
        ("jittered", Sampler::Jittered),
    ];

    /// Returns the sampler with this name.
    pub fn from_name(name: &str) -> Option<Self> {
        Self::NAMES.iter().find(|(n, _)| *n == name).map(|&(_, sampler)| sampler)
    }

    /// Number of samples that a pixel gets if `samples` are requested. It is at least one. For grid
    /// samplers, it is the next square number, at most 65535^2.
    pub fn round_up(self, samples: u32) -> u32 {
        match self {
            Sampler::Sobol | Sampler::Random => samples.max(1),
            Sampler::Uniform | Sampler::Jittered => grid_side(samples).pow(2),
        }
    }

    /// Position of a sample on the camera's lens, in [0,1)^2. The position on the lens is
    /// independent of the position in the pixel.
    pub fn lens_position(self, seed: u64, x: u32, y: u32, sample: u32) -> Vec2 {
        match self {
            Sampler::Sobol => sample_2d(seed, x, y, sample, LENS_DIMENSION),
            _ => random_2d(seed, x, y, sample, LENS_DIMENSION),
        }
    }

    /// Position of a sample in its pixel, in [0,1)^2 from the pixel's top left corner.
    ///
    /// `sample` counts from 0 to `round_up(samples) - 1`. On a grid, samples are numbered along the
    /// rows, starting with the top row.
    pub fn pixel_position(self, seed: u64, x: u32, y: u32, sample: u32, samples: u32) -> Vec2 {
        let in_cell = match self {
            Sampler::Sobol => return sample_2d(seed, x, y, sample, PIXEL_DIMENSION),
            Sampler::Random => return random_2d(seed, x, y, sample, PIXEL_DIMENSION),
            Sampler::Uniform => Vec2::splat(0.5),
            Sampler::Jittered => random_2d(seed, x, y, sample, PIXEL_DIMENSION),
        };
        let side = grid_side(samples);
        let cell = Vec2::new((sample % side) as f32, (sample / side % side) as f32);
        // A position close to the far edge of the last cell can round to 1.
        ((cell + in_cell) / side as f32).min(Vec2::splat(BELOW_ONE))
    }
}

/// Dimension used for positions within the pixel.
pub const PIXEL_DIMENSION: u32 = 0;

/// Dimension used for positions on the camera's lens. Integrators use dimensions 2 and above.
pub const LENS_DIMENSION: u32 = 1;

/// Identifier of a sample of a pixel, from which all its random numbers are computed.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub struct SampleId {
    /// Hash of the seed and the pixel.
    key: u64,
    /// Index of the sample in its pixel.
    pub sample: u32,
    /// First dimension that the sample uses.
    first: u32,
}

/// First of the dimensions reserved for layers that a ray passes through. The number of layers is
/// unlimited.
const LAYER_DIMENSIONS: u32 = 1 << 16;

/// Dimension used to choose the wavelengths.
const WAVELENGTH_DIMENSION: u32 = 1 << 15;

impl SampleId {
    /// Creates the identifier of a sample of a pixel.
    pub fn new(seed: u64, pixel: (u32, u32), sample: u32) -> Self {
        SampleId { key: key(seed, pixel.0, pixel.1), sample, first: LENS_DIMENSION + 1 }
    }

    /// Returns the hash of the seed and the pixel, from which other generators can derive numbers.
    pub fn key(&self) -> u64 {
        self.key
    }

    /// Returns the identifier of another sample of the same pixel.
    pub fn with_sample(self, sample: u32) -> Self {
        SampleId { sample, ..self }
    }

    /// Returns the sequence of points for one dimension of the pixel. The points equal those of
    /// [`sample_2d`].
    pub fn sequence(&self, dimension: u32) -> Sequence {
        Sequence::of(self.key, dimension)
    }

    /// Returns the sample with a different first dimension. `first` is relative to the first
    /// dimension that integrators use.
    pub fn with_first_dimension(self, first: u32) -> Self {
        SampleId { first: LENS_DIMENSION + 1 + first, ..self }
    }

    /// Returns two numbers in [0,1). The pairs of all samples of the pixel are stratified in the
    /// unit square.
    pub fn pair(&self, dimension: u32) -> Vec2 {
        Sequence::of(self.key, self.first + dimension).point(self.sample)
    }

    /// Returns the pairs for the first `N` dimensions. They equal those of [`SampleId::pair`].
    pub fn pairs<const N: usize>(&self) -> [Vec2; N] {
        run_plain(Pairs::<N>(*self))
    }

    /// Returns a number in [0,1) that is used to choose the wavelengths.
    pub fn wavelength(&self) -> f32 {
        Sequence::of(self.key, WAVELENGTH_DIMENSION).point(self.sample).x
    }

    /// Returns a number in [0,1) for a layer that a path meets after `depth` bounces.
    pub fn layer(&self, depth: u32, layer: u32) -> f32 {
        independent(sample_hash(self.key, self.sample, LAYER_DIMENSIONS + (depth << 8) + layer)).x
    }
}

/// SIMD kernel that computes the number pairs of `N` dimensions of a sample.
struct Pairs<const N: usize>(SampleId);

impl<const N: usize> PlainKernel for Pairs<N> {
    type Output = [Vec2; N];

    #[inline(always)]
    fn run(self) -> [Vec2; N] {
        let SampleId { key, sample, first } = self.0;
        let sequences = from_fn(|i| Sequence::of(key, first + i as u32));
        let [x, y] = Sequence::points(&sequences, &[sample; N]);
        from_fn(|i| Vec2::new(x[i], y[i]))
    }
}

/// First of the dimensions reserved for media. The number of scattering events is unlimited.
const MEDIUM_DIMENSIONS: u32 = 1 << 17;

/// Stream of random numbers in [0,1) for a path segment in a medium. It provides as many numbers as
/// needed.
#[derive(Clone, Copy, Debug)]
pub struct Stream {
    id: SampleId,
    dimension: u32,
    count: u32,
}

impl SampleId {
    /// Returns the random numbers for a path segment after `depth` bounces. `side` distinguishes
    /// segments that start at the same point.
    pub fn stream(&self, depth: u32, side: u32) -> Stream {
        Stream { id: *self, dimension: MEDIUM_DIMENSIONS + 2 * depth + side, count: 0 }
    }
}

impl Stream {
    /// Returns the next number. The first two numbers are stratified over the samples of a pixel,
    /// and all others are independent.
    pub fn number(&mut self) -> f32 {
        let SampleId { key, sample, .. } = self.id;
        self.count += 1;
        match self.count {
            1 => Sequence::of(key, self.dimension).point(sample).x,
            2 => Sequence::of(key, self.dimension).point(sample).y,
            n => unit(mix(sample_hash(key, sample, self.dimension) ^ u64::from(n)) as u32),
        }
    }

    /// Returns the next two numbers.
    pub fn pair(&mut self) -> Vec2 {
        Vec2::new(self.number(), self.number())
    }
}

/// Smallest integer from 1 to 65535 whose square is at least `samples`.
fn grid_side(samples: u32) -> u32 {
    let root = samples.isqrt();
    let up = if root * root < samples { root + 1 } else { root };
    up.clamp(1, 65535)
}

/// Point in [0,1)^2 of a stratified sequence that is indexed by `sample`.
///
/// The first 2^k samples of a dimension, and each aligned block of 2^k samples, have one point in
/// every elementary interval of area 2^-k. Points of different pixels or different dimensions are
/// independent.
pub fn sample_2d(seed: u64, x: u32, y: u32, sample: u32, dimension: u32) -> Vec2 {
    Sequence::of(key(seed, x, y), dimension).point(sample)
}

/// Sequence of stratified points for one dimension of a pixel. It stores the hashes that all the
/// points share.
#[derive(Clone, Copy, Debug)]
pub struct Sequence {
    shuffle: u32,
    scramble: u64,
}

impl Sequence {
    #[inline(always)]
    fn of(key: u64, dimension: u32) -> Self {
        // One hash is the key for shuffling, and another contains the keys for scrambling both
        // coordinates.
        Sequence { shuffle: sample_hash(key, 0, dimension) as u32, scramble: sample_hash(key, 1, dimension) }
    }

    /// Returns one point from each of several sequences: all x coordinates, followed by all y
    /// coordinates. The points equal those of [`Sequence::point`]. The loops are written for
    /// auto-vectorization.
    #[inline(always)]
    pub fn points<const N: usize>(sequences: &[Sequence; N], samples: &[u32; N]) -> [[f32; N]; 2] {
        let (mut shuffle, mut scramble) = ([0; N], [[0; N]; 2]);
        for i in 0..N {
            let Sequence { shuffle: own, scramble: both } = sequences[i];
            (shuffle[i], scramble[0][i], scramble[1][i]) = (own, both as u32, (both >> 32) as u32);
        }
        let mut points = [[0.0; N]; 2];
        for i in 0..N {
            let index = nested_uniform_scramble(samples[i], shuffle[i]);
            points[0][i] = unit(nested_uniform_scramble(index.reverse_bits(), scramble[0][i]));
            points[1][i] = unit(nested_uniform_scramble(sobol_second(index), scramble[1][i]));
        }
        points
    }

    /// Returns the point of the sequence that belongs to a sample.
    pub fn point(&self, sample: u32) -> Vec2 {
        let index = nested_uniform_scramble(sample, self.shuffle);
        Vec2::new(
            unit(nested_uniform_scramble(index.reverse_bits(), self.scramble as u32)),
            unit(nested_uniform_scramble(sobol_second(index), (self.scramble >> 32) as u32)),
        )
    }
}

/// Uniformly distributed point in [0,1)^2 that is independent of all other points.
pub fn random_2d(seed: u64, x: u32, y: u32, sample: u32, dimension: u32) -> Vec2 {
    independent(hash(seed, x, y, sample, dimension))
}

fn independent(hash: u64) -> Vec2 {
    // Mix once more than for the keys of `sample_2d`, so that no hash is used twice.
    let bits = mix(hash);
    Vec2::new(unit(bits as u32), unit((bits >> 32) as u32))
}

/// Computes a well-mixed 64-bit hash of a seed, a pixel, a sample index and a dimension.
pub fn hash(seed: u64, x: u32, y: u32, sample: u32, dimension: u32) -> u64 {
    sample_hash(key(seed, x, y), sample, dimension)
}

/// Hash of the seed and the pixel, on which all hashes of the pixel are based.
fn key(seed: u64, x: u32, y: u32) -> u64 {
    mix(mix(seed) ^ (u64::from(x) | u64::from(y) << 32))
}

#[inline(always)]
fn sample_hash(key: u64, sample: u32, dimension: u32) -> u64 {
    mix(key ^ (u64::from(sample) | u64::from(dimension) << 32))
}

/// Performs one step of SplitMix64, which is a permutation of the 64-bit integers.
#[inline(always)]
fn mix(state: u64) -> u64 {
    let mut z = state.wrapping_add(0x9e37_79b9_7f4a_7c15);
    z = (z ^ z >> 30).wrapping_mul(0xbf58_476d_1ce4_e5b9);
    z = (z ^ z >> 27).wrapping_mul(0x94d0_49bb_1331_11eb);
    z ^ z >> 31
}

/// Converts the upper 24 bits to a number in [0,1), which is exact and never 1.
#[inline(always)]
fn unit(bits: u32) -> f32 {
    (bits >> 8) as f32 * (f32::EPSILON * 0.5)
}

/// Applies Owen scrambling, which flips each bit depending on the key and the bits above it.
#[inline(always)]
fn nested_uniform_scramble(bits: u32, key: u32) -> u32 {
    let mut v = bits.reverse_bits();
    v ^= v.wrapping_mul(0x3d20_adea);
    v = v.wrapping_add(key);
    v = v.wrapping_mul(key >> 16 | 1);
    v ^= v.wrapping_mul(0x0552_6c56);
    v ^= v.wrapping_mul(0x53a2_2864);
    v.reverse_bits()
}

/// Second coordinate of the Sobol sequence, in units of 2^-32. The first coordinate is the
/// bit-reversed index.
///
/// The generator matrix is Pascal's triangle modulo 2. It is a Kronecker power, so five steps
/// suffice instead of 32.
#[inline(always)]
fn sobol_second(index: u32) -> u32 {
    let mut v = index;
    v ^= v >> 16;
    v ^= (v & 0xff00_ff00) >> 8;
    v ^= (v & 0xf0f0_f0f0) >> 4;
    v ^= (v & 0xcccc_cccc) >> 2;
    v ^= (v & 0xaaaa_aaaa) >> 1;
    v.reverse_bits()
}
