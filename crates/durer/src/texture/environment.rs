//! A picture of all directions around the scene, from which directions are chosen by how bright
//! they are.

use crate::math::{Color, Vec2, Vec3, fp};
use std::f32::consts::{PI, TAU};
use std::sync::Arc;

/// Light from all around: the picture's middle is where -z points, its upper edge is +y, as in
/// `EquirectangularCamera`.
#[derive(Clone, Debug, PartialEq)]
pub struct Environment {
    width: usize,
    height: usize,
    texels: Arc<[Color]>,
    /// How far it is turned about y, as a share of a whole turn.
    turn: f32,
    scale: Color,
    /// For each row the sums of its texels' weights from the left, and last the sums of the rows.
    rows: Arc<[f32]>,
    columns: Arc<[f32]>,
}

impl Environment {
    /// From linear colours, the upper row first. `None` unless there are width times height of
    /// them, and some light.
    pub fn new(width: u32, height: u32, texels: Vec<Color>, degrees: f32, scale: Color) -> Option<Self> {
        let (width, height) = (width as usize, height as usize);
        if width == 0 || height == 0 || texels.len() != width * height {
            return None;
        }
        let texels: Vec<Color> =
            texels.into_iter().map(|c| if c.is_finite() { c.max(Vec3::ZERO) } else { Vec3::ZERO }).collect();
        let brightness = |x: usize, y: usize| texels[y * width + x].dot(Vec3::splat(1.0 / 3.0));
        let (mut rows, mut columns) = (Vec::with_capacity(width * height), Vec::with_capacity(height));
        let mut all = 0.0_f64;
        for y in 0..height {
            // Rows near the poles stand for less of the sphere.
            let sine = fp::sin(PI * (y as f32 + 0.5) / height as f32);
            let mut sum = 0.0_f64;
            for x in 0..width {
                // Colours are mixed between texels, so that neighbours shine into a texel.
                let near = [x + width - 1, x, x + 1].map(|x| {
                    let x = x % width;
                    brightness(x, y.saturating_sub(1)) + brightness(x, y) + brightness(x, (y + 1).min(height - 1))
                });
                sum += f64::from(near.iter().sum::<f32>() * sine);
                rows.push(sum as f32);
            }
            all += sum;
            columns.push(all as f32);
        }
        let sound = all > 0.0 && (all as f32).is_finite();
        let turn = degrees / 360.0;
        sound.then(|| Environment {
            width,
            height,
            texels: texels.into(),
            turn,
            scale,
            rows: rows.into(),
            columns: columns.into(),
        })
    }

    /// The mean over all directions, nearly.
    pub fn mean(&self) -> Color {
        // Weights are sums over nine texels, times the sine of the row.
        let sum = self.columns[self.height - 1] / 9.0;
        self.scale * (sum * PI / 2.0 / (self.width * self.height) as f32)
    }

    /// Bytes in memory.
    pub fn bytes(&self) -> usize {
        self.texels.len() * size_of::<[f32; 4]>()
    }

    fn place(&self, dir: Vec3) -> Vec2 {
        let u = 0.5 + fp::atan2(dir.x, -dir.z) / TAU - self.turn;
        let v = fp::atan2((dir.x * dir.x + dir.z * dir.z).sqrt(), dir.y) / PI;
        Vec2::new(u - u.floor(), v.clamp(0.0, 1.0))
    }

    /// The light from a direction of any length.
    pub fn at(&self, dir: Vec3) -> Color {
        let p = self.place(dir) * Vec2::new(self.width as f32, self.height as f32) - 0.5;
        let corner = p.floor();
        let part = p - corner;
        let texel = |dx: i64, dy: i64| {
            let x = (corner.x as i64 + dx).rem_euclid(self.width as i64) as usize;
            let y = (corner.y as i64 + dy).clamp(0, self.height as i64 - 1) as usize;
            self.texels[y * self.width + x]
        };
        let row = |dy: i64| texel(0, dy).lerp(texel(1, dy), part.x);
        self.scale * row(0).lerp(row(1), part.y)
    }

    /// A direction chosen by two numbers from 0 to 1, its light, and its density per solid angle.
    pub fn sample(&self, u: Vec2) -> Option<(Vec3, Color, f32)> {
        let (y, v) = choose(&self.columns, u.y);
        let (x, h) = choose(&self.rows[y * self.width..(y + 1) * self.width], u.x);
        let place = Vec2::new((x as f32 + h) / self.width as f32, (y as f32 + v) / self.height as f32);
        let (sin, cos) = fp::sin_cos_degrees(180.0 * f64::from(place.y));
        let (sin_turn, cos_turn) = fp::sin_cos_degrees(360.0 * f64::from(place.x + self.turn - 0.5));
        let dir = Vec3::new((sin * sin_turn) as f32, cos as f32, (-sin * cos_turn) as f32);
        let pdf = self.pdf(dir);
        (pdf > 0.0).then(|| (dir, self.at(dir), pdf))
    }

    /// The density per solid angle with which a direction is chosen.
    pub fn pdf(&self, dir: Vec3) -> f32 {
        let place = self.place(dir);
        let x = ((place.x * self.width as f32) as usize).min(self.width - 1);
        let y = ((place.y * self.height as f32) as usize).min(self.height - 1);
        let row = &self.rows[y * self.width..(y + 1) * self.width];
        let weight = |sums: &[f32], i: usize| sums[i] - if i > 0 { sums[i - 1] } else { 0.0 };
        let row_sum = row[self.width - 1];
        if row_sum <= 0.0 {
            return 0.0;
        }
        let p = weight(&self.columns, y) / self.columns[self.height - 1] * (weight(row, x) / row_sum);
        let sine = (dir.x * dir.x + dir.z * dir.z).sqrt() / dir.length();
        let density = p * (self.width * self.height) as f32 / (2.0 * PI * PI * sine);
        if density.is_finite() { density } else { 0.0 }
    }
}

/// The entry at which a share of the whole sum is reached, and how far in it that is.
fn choose(sums: &[f32], u: f32) -> (usize, f32) {
    let wanted = u * sums[sums.len() - 1];
    let i = sums.partition_point(|&sum| sum <= wanted).min(sums.len() - 1);
    let before = if i > 0 { sums[i - 1] } else { 0.0 };
    let inside = (wanted - before) / (sums[i] - before);
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
    fn directions_are_chosen_by_their_density_and_it_integrates_to_one() {
        let sky = picture();
        let n = 400;
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
    fn the_middle_is_where_minus_z_points_and_rotation_turns_it() {
        let mut texels = vec![Vec3::ZERO; 8 * 4];
        // The column right of the middle, upper half.
        texels[8 + 4] = Vec3::ONE;
        let at =
            |degrees: f32, dir: Vec3| Environment::new(8, 4, texels.clone(), degrees, Vec3::ONE).unwrap().at(dir).x;
        let right_of_middle = Vec3::new(0.38, 0.41, -0.92);
        assert!(at(0.0, right_of_middle) > 0.9, "{}", at(0.0, right_of_middle));
        assert!(at(90.0, Vec3::new(0.92, 0.41, 0.38)) > 0.9);
        assert!(at(0.0, Vec3::new(0.38, -0.41, 0.92)) == 0.0);
    }
}
