//! Camera rays and the picture of the judge's tracer.

use super::super::scene::Year;
use super::super::vector::Vec3;
use super::{Picture, Tracer};

impl Tracer<'_> {
    /// Returns origin and direction of the ray of a pixel. Rows are counted from the top.
    fn ray(&self, i: usize, j: usize) -> (Vec3, Vec3) {
        let scene = self.scene;
        let (w, h) = (scene.size.0 as f64, scene.size.1 as f64);
        let (i, j) = (i as f64, h - 1.0 - j as f64);
        let border = matches!(scene.year, Year::F12a4 | Year::F12a5 | Year::F16) != self.is("border-pixels");
        let place = |i: f64, n: f64| match (border, self.is("pixel-corner")) {
            (_, true) => 2.0 * i / n - 1.0,
            (true, _) => 2.0 * i / (n - 1.0) - 1.0,
            (false, _) => 2.0 * (i + 0.5) / n - 1.0,
        };
        let (mut x, mut y) = (place(i, w), place(j, h));
        if self.is("border-columns") {
            x = 2.0 * i / (w - 1.0) - 1.0;
        }
        if self.is("center-over-less-one") {
            (x, y) = (2.0 * (i + 0.5) / (w - 1.0) - 1.0, 2.0 * (j + 0.5) / (h - 1.0) - 1.0);
        }
        let stretched = matches!(scene.year, Year::F12a4 | Year::F12a5 | Year::F16) != self.is("stretch");
        if !stretched {
            let most = w.max(h);
            (x, y) = match () {
                () if self.is("aspect-other-axis") && w > h => (x, y * w / h),
                () if self.is("aspect-smaller-side") => (x * w / h.min(w), y * h / h.min(w)),
                () => (x * w / most, y * h / most),
            };
        }
        let w = if self.is("direction-not-unit") { scene.look } else { scene.look.unit() };
        let u = scene.look.unit().cross(scene.up);
        let u = if self.is("right-not-unit") { u } else { u.unit() };
        let raw = (scene.year == Year::F16) != self.is("up-not-orthogonal");
        let v = if raw { scene.up } else { u.cross(scene.look.unit()) };
        if scene.angle < 0.0 {
            let half = -scene.angle * if self.is("size-doubled") { 1.0 } else { 0.5 };
            return (scene.eye + u * (x * half) + v * (y * half), w);
        }
        let half = match () {
            () if self.is("angle-not-halved") => scene.angle.to_radians().tan(),
            () if self.is("angle-ignored") => 1.0,
            () if self.is("angle-inverted") => 1.0 / (0.5 * scene.angle.to_radians()).tan(),
            () if self.is("x-wider") => (0.58 * scene.angle.to_radians()).tan(),
            () => (0.5 * scene.angle.to_radians()).tan(),
        };
        let eye = if self.is("x-eye-moved") { scene.eye + Vec3(0.3, 0.2, 0.0) } else { scene.eye };
        (eye, (w * (1.0 / half) + u * x + v * y).unit())
    }

    /// Renders the scene to a picture.
    pub fn picture(&self) -> Picture {
        let (w, h) = self.scene.size;
        let bounces = match () {
            () if self.is("bounce-less") => self.scene.bounces - 1,
            () if self.is("bounce-more") => self.scene.bounces + 1,
            () if self.is("bounce-one") => 1,
            () => self.scene.bounces,
        };
        let all: Vec<Vec3> = (0..w * h)
            .map(|pixel| {
                let (o, d) = self.ray(pixel % w, pixel / w);
                self.trace(o, d, bounces, 1.0, true)
            })
            .collect();
        let most = all.iter().map(|c| c.max_component()).fold(0.0, f64::max);
        let curve = |c: f64| match () {
            () if self.scene.year != Year::Durer => c,
            () if c <= 0.0031308 => 12.92 * c,
            () => 1.055 * c.powf(1.0 / 2.4) - 0.055,
        };
        let eight = |c: f64| {
            let c = if self.is("scaled-to-maximum") { c / most } else { c };
            let c = match () {
                () if self.is("curve-more") => curve(c.max(0.0)).powf(1.0 / 2.2),
                () if self.is("curve-less") => curve(c.max(0.0)).powf(2.2),
                () => curve(c.max(0.0)),
            };
            match (self.is("wrapped"), self.scene.year) {
                (true, Year::Durer) => ((c * 255.0 + 0.5) as i64 & 255) as u8,
                (true, _) => ((c * 255.0) as i64 & 255) as u8,
                (_, Year::Durer) => (c * 255.0 + 0.5).clamp(0.0, 255.0) as u8,
                _ => (c * 255.0).clamp(0.0, 255.0) as u8,
            }
        };
        let at = |i: usize, j: usize| {
            let (i, j) = match () {
                () if self.is("mirrored") => (w - 1 - i, j),
                () if self.is("upside-down") => (i, h - 1 - j),
                () if self.is("transposed") => (j, i),
                () => (i, j),
            };
            let Vec3(r, g, b) = all[j * w + i];
            match () {
                () if self.is("bgr") => [eight(b), eight(g), eight(r)],
                () if self.is("channels") => [eight(g), eight(b), eight(r)],
                () => [eight(r), eight(g), eight(b)],
            }
        };
        (0..w * h).map(|pixel| at(pixel % w, pixel / w)).collect()
    }
}
