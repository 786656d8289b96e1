//! Textures, sky and patterns of the judge's tracer.

use super::Tracer;
use crate::teach::scene::{Material, Pattern, Pixels, Year};
use crate::teach::vector::{Matrix, Vec3};
use durer::math::noise::perlin;

impl Tracer<'_> {
    /// Returns the colour of the sky in a direction.
    pub(super) fn background(&self, d: Vec3) -> Vec3 {
        if !self.scene.sky {
            return self.scene.background;
        }
        let Vec3(x, y, z) = match () {
            () if self.is("sky-negated") => -d,
            () if self.is("sky-x") => Vec3(-d.0, d.1, d.2),
            () if self.is("sky-z-up") => Vec3(d.0, d.2, d.1),
            () if self.is("sky-turned") => Vec3(d.2, d.1, -d.0),
            () => d,
        };
        let most = x.abs().max(y.abs()).max(z.abs());
        let undivided = self.is("sky-undivided");
        let s = |v: f64| 0.5 + 0.5 * v / if undivided { 1.0 } else { most };
        // Seen from inside, u runs to the right and v upwards.
        let (face, u, v) = match () {
            () if x == -most => (0, s(-z), s(y)),
            () if x == most => (1, s(z), s(y)),
            () if y == most => (2, s(x), s(z)),
            () if y == -most => (3, s(x), s(-z)),
            () if z == most => (4, s(-x), s(y)),
            () => (5, s(x), s(y)),
        };
        let face = if self.is("sky-faces") && face < 2 { 1 - face } else { face };
        let (u, v) = match () {
            () if self.is("sky-mirrored") => (1.0 - u, v),
            () if self.is("sky-upside-down") => (u, 1.0 - v),
            () if self.is("sky-up-turned") && face == 2 => (1.0 - u, 1.0 - v),
            () if self.is("sky-front-mirrored") && face == 4 => (1.0 - u, v),
            () => (u, v),
        };
        self.texel(&Pixels::face(face), u, v, "sky")
    }

    /// Returns the colour of a picture at (u, v). `kind` begins the names of the mistakes.
    fn texel(&self, pixels: &Pixels, u: f64, v: f64, kind: &str) -> Vec3 {
        let made = |name: &str| self.mistakes.iter().any(|made| made.strip_prefix(kind) == Some(name));
        let (u, v) = match () {
            () if made("-exchanged") => (v, u),
            () if made("-flipped") => (u, 1.0 - v),
            () if made("-u-flipped") => (1.0 - u, v),
            () if made("-repeated") => (u - u.floor(), v - v.floor()),
            () => (u, v),
        };
        let (w, h) = (pixels.width as f64, pixels.height as f64);
        let (x, y) = match () {
            () if made("-less-one") => (u * (w - 1.0), (1.0 - v) * (h - 1.0)),
            () if made("-shifted") => (u * w - 0.5, (1.0 - v) * h - 0.5),
            () => (u * w, (1.0 - v) * h),
        };
        let decoded = |code: u8| {
            let c = f64::from(code) / 255.0;
            match () {
                () if self.scene.year != Year::Durer || made("-undecoded") => c,
                () if c <= 0.04045 => c / 12.92,
                () => ((c + 0.055) / 1.055).powf(2.4),
            }
        };
        let at = |i: f64, j: f64| {
            let place = |i: f64, n: f64| match made("-repeated") {
                true => i.rem_euclid(n) as usize,
                false => i.clamp(0.0, n - 1.0) as usize,
            };
            let [r, g, b] = pixels.at(place(i, w), place(j, h)).map(decoded);
            if made("-bgr") { Vec3(b, g, r) } else { Vec3(r, g, b) }
        };
        let (x, y) = if made("-repeated") { (x, y) } else { (x.clamp(0.0, w), y.clamp(0.0, h)) };
        let (i, j) = (x.floor(), y.floor());
        if made("-nearest") {
            return at(i, j);
        }
        let (a, b) = (x - i, y - j);
        at(i, j) * ((1.0 - a) * (1.0 - b))
            + at(i + 1.0, j) * (a * (1.0 - b))
            + at(i, j + 1.0) * ((1.0 - a) * b)
            + at(i + 1.0, j + 1.0) * (a * b)
    }

    /// Returns a material with its diffuse colour at a hit: `p` in world space, `local` in object
    /// space.
    pub(super) fn colored(&self, material: Material, p: Vec3, local: Vec3, uv: Option<(f64, f64)>) -> Material {
        if let (true, Some((u, v))) = (material.textured, uv) {
            let kd = self.texel(&Pixels::texture(), u, v, "texture");
            return Material { kd: if self.is("texture-times-diffuse") { kd * material.kd } else { kd }, ..material };
        }
        let Some((pattern, space, [first, second])) = material.pattern else { return material };
        let m = space.iter().fold(Matrix::ONE, |m, op| m.times(&op.matrix(f64::to_radians)));
        let q = match () {
            () if self.is("pattern-world") => p,
            () if self.is("pattern-inverse") => m.inverse().point(p),
            () if self.is("pattern-object") => m.point(local),
            () => m.point(p),
        };
        let share = self.share(pattern, q).clamp(0.0, 1.0);
        let share = if self.is("pattern-exchanged") { 1.0 - share } else { share };
        let [a, b] = [first, second].map(|i: usize| self.scene.materials[i]);
        Material { kd: a.kd * share + b.kd * (1.0 - share), ..a }
    }

    fn share(&self, pattern: Pattern, q: Vec3) -> f64 {
        let vein = |x: f64, octaves: u32, frequency: f64, amplitude: f64| {
            let n = self.noise(q, octaves);
            let phase = match () {
                () if self.is("veins-all-scaled") => frequency * (x + amplitude * n),
                () if self.is("veins-undistorted") => frequency * x,
                () => frequency * x + amplitude * n,
            };
            match () {
                () if self.is("veins-cosine") => 0.5 * (phase.cos() + 1.0),
                () if self.is("veins-unmapped") => phase.sin(),
                () => 0.5 * (phase.sin() + 1.0),
            }
        };
        match pattern {
            Pattern::Checkerboard => {
                let cell = |x: f64| match () {
                    () if self.is("checkerboard-truncated") => x as i64,
                    () if self.is("checkerboard-rounded") => x.round() as i64,
                    () => x.floor() as i64,
                };
                let sum = match () {
                    () if self.is("checkerboard-flat") => cell(q.0) + cell(q.2),
                    () if self.is("checkerboard-x") => cell(q.0),
                    () => cell(q.0) + cell(q.1) + cell(q.2),
                };
                let odd = if self.is("checkerboard-remainder") { sum % 2 == 1 } else { sum % 2 != 0 };
                if odd { 0.0 } else { 1.0 }
            }
            Pattern::Noise(octaves) => match () {
                () if self.is("noise-bare") => self.noise(q, octaves),
                () if self.is("noise-halved") => 0.5 * (self.noise(q, octaves) + 1.0),
                () => self.noise(q, octaves) + 0.5,
            },
            Pattern::Marble(octaves, frequency, amplitude) => {
                vein(if self.is("veins-y") { q.1 } else { q.0 }, octaves, frequency, amplitude)
            }
            Pattern::Wood(octaves, frequency, amplitude) => {
                let across = if self.is("veins-y") { q.0.hypot(q.1) } else { q.0.hypot(q.2) };
                vein(across, octaves, frequency, amplitude)
            }
        }
    }

    /// Returns the sum of noise octaves. The course gives the noise function to its students.
    fn noise(&self, q: Vec3, octaves: u32) -> f64 {
        let octaves = match () {
            () if self.is("octaves-more") => octaves + 1,
            () if self.is("octaves-less") => octaves - 1,
            () => octaves,
        };
        let one = |i: u32| {
            let f = 2.0_f64.powi(i as i32);
            let p = if self.is("frequency-same") { q } else { q * f };
            let n = f64::from(perlin([p.0 as f32, p.1 as f32, p.2 as f32].into()));
            let n = if self.is("noise-absolute") { n.abs() } else { n };
            if self.is("amplitude-same") { n } else { n / f }
        };
        (0..octaves).map(one).sum()
    }
}
