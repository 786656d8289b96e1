//! Environment maps with importance sampling.
//!
//! Directions are sampled in proportion to the part of the radiance that exceeds the mean. Multiple
//! importance sampling combines light samples with BSDF samples. Since BSDF sampling handles nearly
//! uniform parts well, light samples are best spent on the brighter parts. Source: Karlík, Šik,
//! Vévoda, Skřivan, Křivánek, *MIS Compensation: Optimizing Sampling Techniques in Multiple
//! Importance Sampling*, SIGGRAPH Asia 2019.

use crate::math::{Color, Vec2, Vec3, fp};
use glam::Vec4;
use std::f32::consts::PI;
use std::sync::Arc;

/// Position in an environment map that corresponds to a direction, in texels.
#[derive(Clone, Copy, Debug)]
pub struct TexelPosition {
    x: f32,
    y: f32,
    /// Sine of the angle between the direction and the y axis.
    sine: f32,
}

/// Environment map, which lights the scene from infinity and is importance-sampled. Its centre is
/// in the direction -z and its upper edge at +y, as in `EquirectangularCamera`.
#[derive(Clone, Debug, PartialEq)]
pub struct Environment {
    width: usize,
    height: usize,
    /// Colours of the texels, where w is the cumulative weight of the row up to the texel. Storing
    /// both together avoids cache misses.
    texels: Arc<[Vec4]>,
    /// Rotation about y, as a fraction of a turn from 0 to 1.
    turn: f32,
    scale: Color,
    /// Mean brightness over all directions, before scaling.
    mean: f32,
    rows: Arc<[Row]>,
    /// Indices at which the search in the cumulative weights of a row starts, one for each step of
    /// the searched fraction.
    hints: Arc<[u32]>,
    /// Cumulative weights of the rows, starting at the top.
    row_sums: Arc<[f32]>,
    row_hints: Arc<[u32]>,
}

/// Sampling weights of a row of an environment map.
#[derive(Clone, Copy, Debug, PartialEq)]
struct Row {
    /// Sum of the weights of the row's texels.
    sum: f32,
    /// Fraction of the sum over all rows that this row contributes.
    share: f32,
}

/// Minimum weight of a direction, as a fraction of its brightness. Some light is found only by
/// light sampling, for example light behind panes at which paths end.
const MIN_WEIGHT: f32 = 0.05;

/// Number of table entries per start index.
const STEP: usize = 4;

/// Number of entries that the search compares at a time.
const SEARCH_WIDTH: usize = 8;

/// Returns the index of the first entry that exceeds each step of the fraction from 0 to 1.
fn hints(sums: &[f32]) -> impl Iterator<Item = u32> {
    let steps = sums.len().div_ceil(STEP);
    let mut i = 0;
    (0..steps).map(move |step| {
        let target = step as f32 / steps as f32 * sums[sums.len() - 1];
        i += sums[i..].iter().take_while(|sum| **sum <= target).count();
        i = i.min(sums.len() - 1);
        i as u32
    })
}

impl Environment {
    /// Creates a map from linear colours, starting with the top row. Returns `None` if the number
    /// of colours is not width times height, or if the map is black.
    pub fn new(width: u32, height: u32, texels: Vec<Color>, degrees: f32, scale: Color) -> Option<Self> {
        let (width, height) = (width as usize, height as usize);
        if width == 0 || height == 0 || texels.len() != width * height {
            return None;
        }
        let texels: Vec<Color> =
            texels.into_iter().map(|c| if c.is_finite() { c.max(Vec3::ZERO) } else { Vec3::ZERO }).collect();
        let brightness = |x: usize, y: usize| texels[y * width + x].dot(Vec3::splat(1.0 / 3.0));
        // Rows near the poles cover a smaller part of the sphere.
        let sines: Vec<f32> = (0..height).map(|y| fp::sin(PI * (y as f32 + 0.5) / height as f32)).collect();
        let mut sums = Vec::with_capacity(width * height);
        let mut whole = 0.0_f64;
        for (y, sine) in sines.iter().enumerate() {
            let mut row = 0.0_f64;
            for x in 0..width {
                // Colours are interpolated between texel centres, so compute the mean over each
                // texel.
                let mean = |[before, here, after]: [f32; 3]| 0.125 * (before + after) + 0.75 * here;
                let column = |x: usize| {
                    let x = x % width;
                    mean([y.saturating_sub(1), y, (y + 1).min(height - 1)].map(|y| brightness(x, y)))
                };
                let light = mean([x + width - 1, x, x + 1].map(column));
                sums.push(light);
                row += f64::from(light * sine);
            }
            whole += row;
        }
        let mean = (whole / (width as f64 * sines.iter().map(|&sine| f64::from(sine)).sum::<f64>())) as f32;
        let mut columns = Vec::with_capacity(height);
        let mut all = 0.0_f64;
        for (row, sine) in sums.chunks_mut(width).zip(&sines) {
            let mut sum = 0.0_f64;
            for light in row {
                sum += f64::from((*light - (1.0 - MIN_WEIGHT) * mean).max(MIN_WEIGHT * *light) * sine);
                *light = sum as f32;
            }
            all += sum;
            columns.push(all as f32);
        }
        let turn = (degrees / 360.0).rem_euclid(1.0);
        let sound = all > 0.0 && mean.is_finite() && turn.is_finite();
        let row_hints = hints(&columns).collect();
        let share = |y: usize| (columns[y] - if y > 0 { columns[y - 1] } else { 0.0 }) / columns[height - 1];
        let row = |y: usize| Row { sum: sums[(y + 1) * width - 1], share: share(y) };
        sound.then(|| Environment {
            rows: (0..height).map(row).collect(),
            hints: sums.chunks(width).flat_map(hints).collect(),
            row_hints,
            width,
            height,
            texels: texels.iter().zip(&sums).map(|(color, sum)| color.extend(*sum)).collect(),
            turn,
            scale,
            mean,
            row_sums: columns.as_slice().into(),
        })
    }

    /// Approximate mean radiance over all directions.
    pub fn mean(&self) -> Color {
        self.scale * self.mean
    }

    /// Approximate mean of the sampling weights, which is the radiance above [`Environment::mean`].
    pub fn mean_above(&self) -> Color {
        // Weights are means over texels, multiplied by the sine of the row.
        self.scale * (self.row_sums[self.height - 1] * PI / 2.0 / (self.width * self.height) as f32)
    }

    /// Approximate maximum of the ratio of radiance to pdf. It is reached in the directions with
    /// the lowest pdf relative to their brightness.
    pub fn max_weight(&self) -> Color {
        4.0 * PI * self.mean_above() / MIN_WEIGHT
    }

    /// Temporary memory that [`Environment::new`] needs in addition to the given texels, in bytes
    /// per texel. It holds the texels with their sums, the sums alone, and the hints while their
    /// list grows.
    pub const BUILD_BYTES_PER_TEXEL: usize = size_of::<Vec4>() + size_of::<[f32; 2]>();

    /// Size in memory in bytes.
    pub fn bytes(&self) -> usize {
        size_of_val(&*self.texels) + size_of_val(&*self.hints)
    }

    fn place(&self, dir: Vec3) -> TexelPosition {
        let beside = (dir.x * dir.x + dir.z * dir.z).sqrt();
        let u = 0.5 + fp::atan2_turn(dir.x, -dir.z) - self.turn;
        let u = if u < 0.0 { u + 1.0 } else { u };
        let v = 2.0 * fp::atan2_turn(beside, dir.y);
        TexelPosition { x: u * self.width as f32, y: v * self.height as f32, sine: beside / dir.length() }
    }

    /// Radiance at a position, interpolated bilinearly.
    pub fn light(&self, place: &TexelPosition) -> Color {
        // Integer coordinates, counted from 0, of the texel after the position.
        let (x, y) = (place.x + 0.5, place.y + 0.5);
        let (right, below) = (x as usize, y as usize);
        let part = Vec2::new(x - right as f32, y - below as f32);
        let left = if right == 0 { self.width - 1 } else { (right - 1).min(self.width - 1) };
        let right = if right >= self.width { 0 } else { right };
        let row = |y: usize| self.row(y)[left].lerp(self.row(y)[right], part.x);
        let last = self.height - 1;
        self.scale * row(below.saturating_sub(1).min(last)).lerp(row(below.min(last)), part.y).truncate()
    }

    /// Pdf of a position in the map, per solid angle.
    fn density(&self, place: &TexelPosition) -> f32 {
        let (x, y) = ((place.x as usize).min(self.width - 1), (place.y as usize).min(self.height - 1));
        self.density_in((x, y), place.sine)
    }

    /// Pdf per solid angle within a texel, where `sine` is the sine of the angle to the y axis.
    fn density_in(&self, (x, y): (usize, usize), sine: f32) -> f32 {
        let (Row { sum, share }, row) = (self.rows[y], self.row(y));
        if sum <= 0.0 {
            return 0.0;
        }
        let p = share * ((row[x].w - if x > 0 { row[x - 1].w } else { 0.0 }) / sum);
        let density = p * (self.width * self.height) as f32 / (2.0 * PI * PI * sine);
        if density.is_finite() { density } else { 0.0 }
    }

    fn row(&self, y: usize) -> &[Vec4] {
        &self.texels[y * self.width..(y + 1) * self.width]
    }

    /// Radiance that arrives from a direction in world space, which can have any length.
    pub fn at(&self, dir: Vec3) -> Color {
        self.light(&self.place(dir))
    }

    /// Pdf with which a direction is sampled, per solid angle.
    pub fn pdf(&self, dir: Vec3) -> f32 {
        self.density(&self.place(dir))
    }

    /// Radiance that arrives from a direction, and the pdf of the direction per solid angle.
    pub fn at_with_pdf(&self, dir: Vec3) -> (Color, f32) {
        let place = self.place(dir);
        (self.light(&place), self.density(&place))
    }

    /// Samples a direction from two numbers in [0, 1). Returns the direction together with its
    /// radiance and its pdf per solid angle.
    pub fn sample(&self, u: Vec2) -> Option<(Vec3, Color, f32)> {
        let (dir, place, pdf) = self.direction(u)?;
        Some((dir, self.light(&place), pdf))
    }

    /// Samples a direction from two numbers in [0, 1). Returns the direction together with its
    /// position in the map and its pdf per solid angle.
    pub fn direction(&self, u: Vec2) -> Option<(Vec3, TexelPosition, f32)> {
        let steps = self.width.div_ceil(STEP);
        let (y, v) = find_entry(&self.row_sums, |sum| *sum, self.row_sums[self.height - 1], &self.row_hints, u.y);
        let hints = &self.hints[y * steps..(y + 1) * steps];
        let (x, h) = find_entry(self.row(y), |texel| texel.w, self.rows[y].sum, hints, u.x);
        let [across, down] = [x as f32 + h, y as f32 + v];
        let (sine, cosine) = fp::sin_cos_turn(0.5 * down / self.height as f32);
        let (sin_turn, cos_turn) = fp::sin_cos_turn(across / self.width as f32 + self.turn - 0.5);
        let pdf = self.density_in((x, y), sine);
        let dir = Vec3::new(sine * sin_turn, cosine, -sine * cos_turn);
        (pdf > 0.0).then_some((dir, TexelPosition { x: across, y: down, sine }, pdf))
    }
}

/// Returns the index of the entry at which the cumulative sum reaches the fraction `u` of the
/// total, and the position within that entry.
fn find_entry<T>(entries: &[T], sum: impl Fn(&T) -> f32, whole: f32, hints: &[u32], u: f32) -> (usize, f32) {
    let last = entries.len() - 1;
    let target = u * whole;
    let mut i = hints[((u * hints.len() as f32) as usize).min(hints.len() - 1)] as usize;
    // Rounding errors can make the start index too large.
    while i > 0 && sum(&entries[i - 1]) > target {
        i -= 1;
    }
    // Compare several entries at once to avoid branch mispredictions.
    while let Some(ahead) = entries[i..last].first_chunk::<SEARCH_WIDTH>() {
        let below = ahead.iter().filter(|entry| sum(entry) <= target).count();
        i += below;
        if below < SEARCH_WIDTH {
            break;
        }
    }
    while i < last && sum(&entries[i]) <= target {
        i += 1;
    }
    let before = if i > 0 { sum(&entries[i - 1]) } else { 0.0 };
    let inside = (target - before) / (sum(&entries[i]) - before);
    (i, if inside.is_finite() { inside.clamp(0.0, 1.0 - f32::EPSILON * 0.5) } else { 0.5 })
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::math::random::Random;

    fn picture() -> Environment {
        let mut random = Random(3);
        let texels =
            (0..32 * 16).map(|i| Vec3::splat(if i == 100 { 500.0 } else { random.between(0.0, 1.0) })).collect();
        Environment::new(32, 16, texels, 40.0, Vec3::ONE).unwrap()
    }

    #[test]
    fn samples_agree_with_pdf_and_pdf_integrates_to_one() {
        let sky = picture();
        let n = 2000;
        let (mut all, mut flux) = (0.0, 0.0);
        for i in 0..n * n {
            let (u, v) = ((i % n) as f32 + 0.5, (i / n) as f32 + 0.5);
            let cosine = 1.0 - 2.0 * v / n as f32;
            let (sin, cos) = fp::sin_cos_degrees(f64::from(u / n as f32) * 360.0);
            let sine = (1.0 - cosine * cosine).sqrt();
            let dir = Vec3::new(sine * cos as f32, cosine, sine * sin as f32);
            all += f64::from(sky.pdf(dir)) * 4.0 * std::f64::consts::PI / f64::from(n * n);
            flux += f64::from(sky.at(dir).x) * 4.0 * std::f64::consts::PI / f64::from(n * n);
        }
        assert!((all - 1.0).abs() < 0.01, "{all}");
        let samples = 65_536;
        let mean: f64 = (0..samples)
            .map(|i| crate::sampler::sample_2d(0, 0, 0, i, 2))
            .filter_map(|u| sky.sample(u))
            .map(|(dir, light, pdf)| {
                assert!((dir.length() - 1.0).abs() < 1e-5);
                f64::from(light.x / pdf)
            })
            .sum::<f64>()
            / f64::from(samples);
        assert!((mean - flux).abs() < 0.01 * flux, "{mean} {flux}");
    }

    #[test]
    fn centre_is_at_minus_z_and_rotation_turns_the_map() {
        let mut texels = vec![Vec3::ZERO; 8 * 4];
        // Set a texel in the column to the right of the centre, in the upper half.
        texels[8 + 4] = Vec3::ONE;
        let at =
            |degrees: f32, dir: Vec3| Environment::new(8, 4, texels.clone(), degrees, Vec3::ONE).unwrap().at(dir).x;
        let right_of_middle = Vec3::new(0.38, 0.41, -0.92);
        assert!(at(0.0, right_of_middle) > 0.9, "{}", at(0.0, right_of_middle));
        assert!(at(90.0, Vec3::new(0.92, 0.41, 0.38)) > 0.9);
        assert!(at(0.0, Vec3::new(0.38, -0.41, 0.92)) == 0.0);
    }
}
