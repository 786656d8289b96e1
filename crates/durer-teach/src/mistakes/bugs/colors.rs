//! Mistakes in textures, cube maps and patterns, as functions that compute the wrong value.

use durer_scene::material::{ColorNoise, Pattern, PatternMaterial};
use durer_scene::math::{Color, Vec2, Vec3, fp, noise};
use durer_scene::texture::{CubeMap, Mapping, Texture, Wrap};

/// Mistakes in the colours that come from textures, the sky and patterns.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct ColorBugs {
    /// Mistake in the lookup of textures.
    pub texture: TextureBug,
    /// Permutation of the texture coordinates of a triangle's vertices. The value 0 is the correct
    /// order.
    pub uv_permutation: usize,
    /// Direction in which the sky is looked up.
    pub sky: SkyDirection,
    /// Mistake in the faces of the cube map.
    pub faces: SkyFaces,
    /// Mistake in the lookup of the cube map's textures.
    pub face_texture: TextureBug,
    /// Space in which patterns are evaluated.
    pub space: PatternSpace,
    /// The two materials of a pattern are exchanged.
    pub exchanged: bool,
    /// Cells of a checkerboard.
    pub cells: Cells,
    /// Sum of noise octaves.
    pub octaves: Octaves,
    /// Share of the first material of a noise pattern.
    pub share: NoiseShare,
    /// Veins of marble, wood and colour noise.
    pub veins: Veins,
    /// Number of places by which the axes of marble and wood are rotated.
    pub axis: usize,
}

/// Mistake that a student's program can make when it looks up a texture.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub enum TextureBug {
    /// The lookup is correct.
    #[default]
    Correct,
    /// The coordinates u and v are exchanged.
    Exchanged,
    /// The coordinate u, v or both run in the other direction.
    Flipped(bool, bool),
    /// The texel at the rounded-down position is used, without interpolation.
    Nearest,
    /// The texel nearest to the position is used, if texels lie at integers.
    NearestRounded,
    /// The texel at u · (width - 1), rounded down, is used.
    NearestInside,
    /// The position is u · (width - 1) instead of u · width.
    LessOne,
    /// The texture is shifted by this number of texels in both directions.
    Shifted(f32),
    /// The texture is repeated beyond its border.
    Repeated,
    /// The texture is clamped to its border.
    Clamped,
    /// Red and blue are exchanged.
    BlueFirst,
}

impl TextureBug {
    /// Returns the colour of a texture at the coordinates (u, v).
    pub fn color(self, texture: &Texture, uv: Vec2) -> Color {
        let (width, height) = texture.size();
        let size = Vec2::new(width as f32, height as f32);
        // Without a mapping, texels lie at integers, otherwise at integers and a half.
        let center = if texture.mapping().is_some() { 0.5 } else { 0.0 };
        let texels = Vec2::new(uv.x, 1.0 - uv.y) * size;
        let at = |texels: Vec2| texture.at(Vec2::new(texels.x / size.x, 1.0 - texels.y / size.y));
        let inside = texels * (size - 1.0) / size;
        match self {
            TextureBug::Correct => texture.at(uv),
            TextureBug::Exchanged => texture.at(Vec2::new(uv.y, uv.x)),
            TextureBug::Flipped(u, v) => {
                let flipped = |x: f32, flip: bool| if flip { 1.0 - x } else { x };
                texture.at(Vec2::new(flipped(uv.x, u), flipped(uv.y, v)))
            }
            TextureBug::Nearest => at(texels.floor() + center),
            TextureBug::NearestRounded => at((texels + 0.5).floor() + center),
            TextureBug::NearestInside => at(inside.floor() + center),
            TextureBug::LessOne => at(inside + center),
            TextureBug::Shifted(by) => at(texels + by),
            TextureBug::Clamped => texture.at(uv.clamp(Vec2::ZERO, Vec2::ONE)),
            TextureBug::Repeated => {
                let mapping = Mapping { wrap: [Wrap::Repeat; 2], ..texture.mapping().copied().unwrap_or_default() };
                let offset = (0.5 - center) / size;
                let [r, g, b, _] = texture.texel(&mapping, uv + Vec2::new(offset.x, -offset.y), 0.0);
                Color::new(r, g, b)
            }
            TextureBug::BlueFirst => {
                let Vec3 { x, y, z } = texture.at(uv);
                Color::new(z, y, x)
            }
        }
    }
}

/// Direction in which a student's program looks up the sky.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub enum SkyDirection {
    /// The direction of the ray, which is correct.
    #[default]
    Correct,
    /// The opposite direction.
    Opposite,
    /// The direction with one coordinate negated.
    Negated(usize),
    /// The direction with two coordinates exchanged. The number is that of the third coordinate.
    Exchanged(usize),
    /// The direction turned by 90 degrees about the y axis, to the left or, if `true`, to the
    /// right.
    Turned(bool),
}

impl SkyDirection {
    /// Returns the direction for a ray with direction `d`.
    pub fn of(self, mut d: Vec3) -> Vec3 {
        match self {
            SkyDirection::Correct => d,
            SkyDirection::Opposite => -d,
            SkyDirection::Negated(axis) => {
                d[axis] = -d[axis];
                d
            }
            SkyDirection::Exchanged(axis) => {
                let (a, b) = ((axis + 1) % 3, (axis + 2) % 3);
                (d[a], d[b]) = (d[b], d[a]);
                d
            }
            SkyDirection::Turned(false) => Vec3::new(d.z, d.y, -d.x),
            SkyDirection::Turned(true) => Vec3::new(-d.z, d.y, d.x),
        }
    }
}

/// Mistake of a student's program in the faces of a cube map.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub enum SkyFaces {
    /// The faces are correct.
    #[default]
    Correct,
    /// The two faces on an axis are exchanged. The number 3 stands for all three axes.
    Exchanged(usize),
    /// The images of some faces, given as a set of bits, are flipped along u, along v, or both.
    Flipped(u8, bool, bool),
    /// The images of some faces, given as a set of bits, are transposed.
    Transposed(u8),
    /// The coordinates are not divided by the greatest component of the unit direction.
    Undivided,
}

impl SkyFaces {
    /// Returns the colour of a cube map in a direction.
    pub fn color(self, map: &CubeMap, direction: Vec3, texture: TextureBug) -> Color {
        let (face, uv) = map.face(direction);
        let bit = |faces: u8| faces >> face & 1 == 1;
        let (face, uv) = match self {
            SkyFaces::Exchanged(axis) if axis == 3 || face / 2 == axis => (face ^ 1, uv),
            SkyFaces::Flipped(faces, u, v) if bit(faces) => {
                let flipped = |x: f32, flip: bool| if flip { 1.0 - x } else { x };
                (face, Vec2::new(flipped(uv.x, u), flipped(uv.y, v)))
            }
            SkyFaces::Transposed(faces) if bit(faces) => (face, Vec2::new(uv.y, uv.x)),
            SkyFaces::Undivided => (face, 0.5 + (uv - 0.5) * direction.normalize_or(direction).abs().max_element()),
            _ => (face, uv),
        };
        texture.color(&map.faces[face], uv)
    }
}

/// Space in which a student's program evaluates patterns.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub enum PatternSpace {
    /// The pattern's own space, which is correct.
    #[default]
    Correct,
    /// World space, because the pattern's transform is ignored.
    World,
    /// The space that results from the inverse of the correct transform.
    Inverse,
    /// The space of the object that was hit.
    Object,
}

/// Cells of a checkerboard in a student's program.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub enum Cells {
    /// Unit cubes, which are correct.
    #[default]
    Correct,
    /// Coordinates are truncated, so the cells around 0 are twice as wide.
    Truncated,
    /// Coordinates are rounded, so the cells are shifted by a half.
    Rounded,
    /// The test for odd cells is `sum % 2 == 1`, which fails for negative sums.
    SignedRemainder,
    /// One coordinate is ignored.
    Without(usize),
    /// Only one coordinate is used.
    Only(usize),
    /// The cells have twice or half the size.
    Scaled(bool),
}

impl Cells {
    fn share(self, q: Vec3) -> f32 {
        let q = match self {
            Cells::Scaled(true) => 0.5 * q,
            Cells::Scaled(false) => 2.0 * q,
            _ => q,
        };
        let mut cell = match self {
            Cells::Truncated => q.trunc(),
            Cells::Rounded => q.round(),
            _ => q.floor(),
        };
        match self {
            Cells::Without(axis) => cell[axis] = 0.0,
            Cells::Only(axis) => cell = Vec3::new(cell[axis], 0.0, 0.0),
            Cells::SignedRemainder if cell.element_sum() < 0.0 => return 1.0,
            _ => {}
        }
        let is_even = cell.rem_euclid(Vec3::splat(2.0)).element_sum().rem_euclid(2.0) == 0.0;
        if is_even { 1.0 } else { 0.0 }
    }
}

/// Sum of noise octaves in a student's program.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub enum Octaves {
    /// The frequency doubles and the weight halves from octave to octave, which is correct.
    #[default]
    Correct,
    /// One octave too many.
    More,
    /// One octave too few.
    Fewer,
    /// Only the first octave.
    One,
    /// All octaves have weight 1.
    FullWeights,
    /// All octaves have frequency 1.
    SameFrequency,
    /// The weight is a quarter of the previous one.
    QuarterWeights,
    /// The absolute value of the noise is added.
    Absolute,
    /// The first octave has frequency 2 and weight 1/2.
    SecondFirst,
}

impl Octaves {
    /// Returns the sum of the octaves at a point.
    fn sum(self, q: Vec3, octaves: u32) -> f32 {
        let octaves = match self {
            Octaves::More => octaves + 1,
            Octaves::Fewer => octaves.saturating_sub(1),
            Octaves::One => octaves.min(1),
            _ => octaves,
        };
        let (mut sum, mut frequency) = (0.0, if self == Octaves::SecondFirst { 2.0 } else { 1.0_f32 });
        for _ in 0..octaves {
            let value = noise::perlin(if self == Octaves::SameFrequency { q } else { frequency * q });
            sum += match self {
                Octaves::FullWeights => value,
                Octaves::QuarterWeights => value / (frequency * frequency),
                Octaves::Absolute => value.abs() / frequency,
                _ => value / frequency,
            };
            frequency *= 2.0;
        }
        sum
    }
}

/// Share of the first material of a noise pattern in a student's program, where N is the sum of
/// octaves.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub enum NoiseShare {
    /// The share is N + 1/2, which is correct.
    #[default]
    Correct,
    /// The share is N.
    Bare,
    /// The share is (N + 1) / 2.
    Halved,
    /// The share is |N|.
    Absolute,
}

/// Veins of marble, wood and colour noise in a student's program, which are correct if they are
/// (sin(frequency x + amplitude N) + 1) / 2.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub enum Veins {
    /// The veins are correct.
    #[default]
    Correct,
    /// The cosine is used instead of the sine.
    Cosine,
    /// The sine is not mapped to the range from 0 to 1, so negative values count as 0.
    Unmapped,
    /// The absolute value of the sine is used.
    Absolute,
    /// The frequency also multiplies the noise.
    AllScaled,
    /// The frequency also multiplies the point at which the noise is evaluated.
    PointScaled,
    /// There is no noise.
    Undistorted,
    /// The frequency is ignored.
    NoFrequency,
    /// The amplitude is ignored.
    NoAmplitude,
}

impl ColorBugs {
    /// Returns the share of the first material of a pattern at a point in pattern space. With
    /// `conic_rings`, wood has the rings of the 2004 program.
    pub fn pattern_share(&self, pattern: &PatternMaterial, q: Vec3, conic_rings: bool) -> f32 {
        let turned = |q: Vec3| Vec3::new(q[self.axis % 3], q[(self.axis + 1) % 3], q[(self.axis + 2) % 3]);
        let share = match pattern {
            PatternMaterial::Checkerboard(_) => self.cells.share(q),
            PatternMaterial::Noise(noise) => {
                let sum = self.octaves.sum(q, noise.octaves);
                let share = match self.share {
                    NoiseShare::Correct => sum + 0.5,
                    NoiseShare::Bare => sum,
                    NoiseShare::Halved => 0.5 * sum + 0.5,
                    NoiseShare::Absolute => sum.abs(),
                };
                share.clamp(0.0, 1.0)
            }
            PatternMaterial::Marble(m) => self.vein(q, turned(q).x, [m.frequency, m.amplitude], m.octaves),
            PatternMaterial::Wood(wood) if !conic_rings => {
                let around = turned(q);
                let radius = (around.x * around.x + around.z * around.z).sqrt();
                self.vein(q, radius, [wood.frequency, wood.amplitude], wood.octaves)
            }
            PatternMaterial::Wood(wood) => wood.conic(turned(q)),
            // Patterns that the course's programs lack.
            _ => pattern.weight(q),
        };
        if self.exchanged { 1.0 - share } else { share }
    }

    /// Returns the colour of colour noise at a point.
    pub fn noise_color(&self, noise: &ColorNoise, p: Vec3) -> Color {
        let share = self.vein(p, p[self.axis % 3], [noise.frequency, noise.amplitude], noise.octaves);
        let share = if self.exchanged { 1.0 - share } else { share };
        share * noise.color1 + (1.0 - share) * noise.color2
    }

    fn vein(&self, q: Vec3, x: f32, [frequency, amplitude]: [f32; 2], octaves: u32) -> f32 {
        let sum = self.octaves.sum(if self.veins == Veins::PointScaled { frequency * q } else { q }, octaves);
        let phase = match self.veins {
            Veins::AllScaled => frequency * (x + amplitude * sum),
            Veins::Undistorted => frequency * x,
            Veins::NoFrequency => x + amplitude * sum,
            Veins::NoAmplitude => frequency * x + sum,
            _ => frequency * x + amplitude * sum,
        };
        let sine = fp::sin(if self.veins == Veins::Cosine { phase + std::f32::consts::FRAC_PI_2 } else { phase });
        match self.veins {
            Veins::Unmapped => sine.max(0.0),
            Veins::Absolute => sine.abs(),
            _ => 0.5 * sine + 0.5,
        }
    }
}
