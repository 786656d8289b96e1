//! The judge's path tracer, which is independent of the library and can make common mistakes by
//! name. Each picture has at most one mistake.

use super::scenes::{Form, Matter, PathScene, SIDE, SKY_SIZE, Sky, TEXTURE_SIDE, Thing, sky_texel, texel};
use crate::teach::vector::Vec3;
use rayon::prelude::*;
use std::f64::consts::PI;

/// Smallest distance of a hit from the origin of its ray, in world units.
const EPSILON: f64 = 1e-6;

/// Path tracer for the judge's scenes.
pub struct PathTracer<'s> {
    scene: &'s PathScene,
    mistake: &'s str,
    /// True if light samples and scattered directions are combined by the power heuristic. With
    /// `false`, only light samples find the lights that can be sampled, unless the path comes from
    /// the camera, a mirror or glass.
    weighted: bool,
    lights: Vec<Light>,
    /// Cumulative probabilities of the texels of the sky.
    sky: Vec<f64>,
}

/// A light that is sampled.
#[derive(Clone, Copy)]
enum Light {
    /// Index of the object that emits the light.
    Area(usize),
    /// Index of the point light.
    Point(usize),
    Sky,
}

/// Random numbers, from an xorshift generator with a multiplier.
pub struct Random(u64);

/// Hit of a ray: distance, point, normal of the front and object.
struct Hit {
    t: f64,
    p: Vec3,
    n: Vec3,
    object: usize,
    /// Texture coordinates on rectangles, with v upwards.
    uv: (f64, f64),
}

/// Sample of a light.
struct LightSample {
    wi: Vec3,
    distance: f64,
    radiance: Vec3,
    /// Pdf per solid angle including the choice of the light, or only the probability of the
    /// choice for a point light.
    pdf: f64,
    is_point: bool,
}

/// A rendered picture in two halves, which have half of the samples each and show the noise.
pub struct Picture {
    /// Linear values of both halves.
    pub linear: [Vec<Vec3>; 2],
    /// Display values of both halves, without clamping or rounding.
    pub shown: [Vec<Vec3>; 2],
    /// Eight bits per channel, starting with the top row.
    pub bytes: Vec<[u8; 3]>,
}

impl Random {
    fn new(pixel: u64, seed: u64) -> Self {
        let mut x = pixel.wrapping_add(seed.wrapping_mul(0x1000_0000_01b3)).wrapping_add(1);
        for _ in 0..3 {
            x = (x ^ (x >> 31)).wrapping_mul(0x7fb5_d329_728e_a185);
        }
        Random(x | 1)
    }

    fn next(&mut self) -> f64 {
        self.0 ^= self.0 >> 12;
        self.0 ^= self.0 << 25;
        self.0 ^= self.0 >> 27;
        (self.0.wrapping_mul(0x2545_f491_4f6c_dd1d) >> 11) as f64 / (1_u64 << 53) as f64
    }
}

/// Returns two tangents that form a basis with a normal.
fn tangents(n: Vec3) -> (Vec3, Vec3) {
    let other = if n.0.abs() > 0.8 { Vec3(0.0, 1.0, 0.0) } else { Vec3(1.0, 0.0, 0.0) };
    let t = other.cross(n).unit();
    (t, n.cross(t))
}

fn mirrored(d: Vec3, n: Vec3) -> Vec3 {
    d - n * (2.0 * d.dot(n))
}

/// Returns the weight that the power heuristic gives to a sample with pdf `a`.
fn power(a: f64, b: f64) -> f64 {
    a * a / (a * a + b * b)
}

/// Encodes a linear value with the sRGB curve.
fn srgb(c: f64) -> f64 {
    if c <= 0.0031308 { 12.92 * c.max(0.0) } else { 1.055 * c.powf(1.0 / 2.4) - 0.055 }
}

/// Returns the reflectance of a smooth dielectric for unpolarised light. `eta` is the index in
/// front divided by the index behind.
fn fresnel(cosine: f64, eta: f64) -> f64 {
    let root = 1.0 - eta * eta * (1.0 - cosine * cosine);
    if root <= 0.0 {
        return 1.0;
    }
    let behind = root.sqrt();
    let parallel = (cosine - eta * behind) / (cosine + eta * behind);
    let perpendicular = (eta * cosine - behind) / (eta * cosine + behind);
    0.5 * (parallel * parallel + perpendicular * perpendicular)
}

impl<'s> PathTracer<'s> {
    /// Creates a path tracer with a mistake, or with none if `mistake` is empty.
    pub fn new(scene: &'s PathScene, mistake: &'s str, weighted: bool) -> Self {
        let emits = |i: &usize| scene.things[*i].emission != Vec3::ZERO;
        let mut lights: Vec<Light> = (0..scene.things.len()).filter(emits).map(Light::Area).collect();
        lights.extend((0..scene.points.len()).map(Light::Point));
        let mut sky = Vec::new();
        if scene.sky == Sky::Picture {
            lights.push(Light::Sky);
            let (width, height) = SKY_SIZE;
            let mut sum = 0.0;
            for i in 0..width * height {
                let sine = (PI * ((i / width) as f64 + 0.5) / height as f64).sin();
                sum += sky_texel(i % width, i / width).dot(Vec3::ONE) * sine;
                sky.push(sum);
            }
            sky.iter_mut().for_each(|entry| *entry /= sum);
        }
        PathTracer { scene, mistake, weighted, lights, sky }
    }

    fn is(&self, name: &str) -> bool {
        self.mistake == name
    }

    fn closest(&self, o: Vec3, d: Vec3, most: f64) -> Option<Hit> {
        let (mut best, mut found) = (most, None);
        for (object, thing) in self.scene.things.iter().enumerate() {
            if let Some((t, n, uv)) = hit(&thing.form, o, d, best) {
                best = t;
                found = Some(Hit { t, p: o + d * t, n, object, uv });
            }
        }
        found
    }

    /// Returns a direction of the sky turned to a direction of its picture, and the reverse.
    fn turned(&self, d: Vec3) -> Vec3 {
        if self.is("sky-upside-down") { Vec3(d.0, -d.1, d.2) } else { d }
    }

    fn sky_radiance(&self, d: Vec3) -> Vec3 {
        if let Sky::Constant(color) = self.scene.sky {
            return color;
        }
        let (width, height) = (SKY_SIZE.0 as i64, SKY_SIZE.1 as i64);
        let d = self.turned(d);
        let x = (0.5 + d.0.atan2(-d.2) / (2.0 * PI)) * width as f64 - 0.5;
        let y = d.1.clamp(-1.0, 1.0).acos() / PI * height as f64 - 0.5;
        let at = |dx: i64, dy: i64| {
            let (x, y) = (x.floor() as i64 + dx, y.floor() as i64 + dy);
            sky_texel(x.rem_euclid(width) as usize, y.clamp(0, height - 1) as usize)
        };
        let (a, b) = (x - x.floor(), y - y.floor());
        let row = |dy| at(0, dy) * (1.0 - a) + at(1, dy) * a;
        row(0) * (1.0 - b) + row(1) * b
    }

    /// Pdf of a texel of the sky per solid angle, at a direction in the picture.
    fn texel_pdf(&self, texel: usize, sine: f64) -> f64 {
        let p = self.sky[texel] - if texel > 0 { self.sky[texel - 1] } else { 0.0 };
        let sine = if self.is("sky-no-sine") { 1.0 } else { sine.max(1e-9) };
        p * self.sky.len() as f64 / (2.0 * PI * PI * sine)
    }

    fn sky_pdf(&self, d: Vec3) -> f64 {
        let d = self.turned(d);
        let (width, height) = SKY_SIZE;
        let x = ((0.5 + d.0.atan2(-d.2) / (2.0 * PI)) * width as f64) as usize;
        let y = (d.1.clamp(-1.0, 1.0).acos() / PI * height as f64) as usize;
        self.texel_pdf(y.min(height - 1) * width + x.min(width - 1), (1.0 - d.1 * d.1).max(0.0).sqrt())
    }

    /// Pdf per solid angle of a point on an area light at distance `t`, at which the cosine to its
    /// normal is `cosine`.
    fn area_pdf(&self, thing: &Thing, t: f64, cosine: f64) -> f64 {
        let Form::Rectangle(_, edge0, edge1) = thing.form else { return 0.0 };
        let area = if self.is("no-area") { 1.0 } else { edge0.cross(edge1).length() };
        let squared = if self.is("no-distance") { 1.0 } else { t * t };
        let cosine = if self.is("no-light-cosine") { 1.0 } else { cosine.max(1e-9) };
        squared / (cosine * area)
    }

    /// Probability of choosing a light.
    fn choice(&self) -> f64 {
        if self.is("no-choice") { 1.0 } else { 1.0 / self.lights.len() as f64 }
    }

    fn sample_light(&self, p: Vec3, random: &mut Random) -> Option<LightSample> {
        if self.lights.is_empty() || self.is("by-chance") {
            return None;
        }
        let chosen = self.lights[(random.next() * self.lights.len() as f64) as usize];
        let (mut u, mut v) = (random.next(), random.next());
        let choice = self.choice();
        match chosen {
            Light::Area(object) => {
                let thing = &self.scene.things[object];
                let Form::Rectangle(corner, edge0, edge1) = thing.form else { return None };
                if self.is("x-centre-only") {
                    (u, v) = (0.5, 0.5);
                }
                let way = corner + edge0 * u + edge1 * v - p;
                let (wi, distance) = (way.unit(), way.length());
                let cosine = -wi.dot(edge0.cross(edge1).unit());
                let cosine = if self.is("two-sided") { cosine.abs() } else { cosine };
                let pdf = self.area_pdf(thing, distance, cosine) * choice;
                (cosine > 0.0).then_some(LightSample { wi, distance, radiance: thing.emission, pdf, is_point: false })
            }
            Light::Point(i) => {
                let (at, color) = self.scene.points[i];
                let (wi, distance) = ((at - p).unit(), (at - p).length());
                let squared = if self.is("no-distance") { 1.0 } else { distance * distance };
                let radiance = color * (PI / squared);
                Some(LightSample { wi, distance, radiance, pdf: choice, is_point: true })
            }
            Light::Sky => {
                let (width, height) = SKY_SIZE;
                let target = random.next();
                let texel = self.sky.iter().position(|sum| *sum > target).unwrap_or(self.sky.len() - 1);
                let across = 2.0 * PI * (((texel % width) as f64 + u) / width as f64 - 0.5);
                let down = PI * ((texel / width) as f64 + v) / height as f64;
                let d = Vec3(down.sin() * across.sin(), down.cos(), -down.sin() * across.cos());
                let pdf = self.texel_pdf(texel, down.sin()) * choice;
                let wi = self.turned(d);
                Some(LightSample { wi, distance: f64::INFINITY, radiance: self.sky_radiance(wi), pdf, is_point: false })
            }
        }
    }

    fn albedo(&self, matter: &Matter, hit: &Hit) -> Vec3 {
        match *matter {
            Matter::Matte(color) if self.is("x-albedo-squared") => color * color,
            Matter::Matte(color) => color,
            _ => {
                let cell = |c: f64| ((c * TEXTURE_SIDE as f64) as usize).min(TEXTURE_SIDE - 1);
                let [r, g, b] =
                    texel(cell(hit.uv.0), TEXTURE_SIDE - 1 - cell(hit.uv.1)).map(|byte| f64::from(byte) / 255.0);
                let linear = |c: f64| if c <= 0.04045 { c / 12.92 } else { ((c + 0.055) / 1.055).powf(2.4) };
                let raw = Vec3(r, g, b);
                if self.is("texture-raw") { raw } else { raw.map(linear) }
            }
        }
    }

    /// Returns the BSDF of a matte or rough surface without the cosine, and its pdf.
    fn bsdf(&self, matter: &Matter, hit: &Hit, n: Vec3, wo: Vec3, wi: Vec3) -> (Vec3, f64) {
        let (co, ci) = (n.dot(wo), n.dot(wi));
        if let Matter::Metal(f0, alpha) = *matter {
            let h = (wo + wi).unit();
            let (hn, ho) = (h.dot(n), h.dot(wo));
            let stretch = hn * hn * (alpha * alpha - 1.0) + 1.0;
            let d = alpha * alpha / (PI * stretch * stretch);
            let lambda = |c: f64| 0.5 * ((1.0 + alpha * alpha * (1.0 / (c * c) - 1.0)).sqrt() - 1.0);
            let f = f0 + (Vec3::ONE - f0) * (1.0 - ho).powi(5);
            let value = d / ((1.0 + lambda(co) + lambda(ci)) * 4.0 * co * ci);
            return (f * value, d * hn / (4.0 * ho));
        }
        let f = if self.is("no-pi") { 1.0 } else { 1.0 / PI };
        (self.albedo(matter, hit) * f, ci.max(0.0) / PI)
    }

    fn cosine(&self, cosine: f64) -> f64 {
        match self.mistake {
            "no-cosine" => 1.0,
            "cosine-twice" => cosine * cosine,
            _ => cosine,
        }
    }

    /// Returns the contribution of a light sample.
    fn direct(&self, matter: &Matter, hit: &Hit, n: Vec3, wo: Vec3, random: &mut Random) -> Vec3 {
        let Some(light) = self.sample_light(hit.p, random) else { return Vec3::ZERO };
        let cosine = n.dot(light.wi);
        if cosine <= 0.0 {
            return Vec3::ZERO;
        }
        let reach = light.distance - EPSILON;
        if !self.is("no-shadow-rays") && self.closest(hit.p, light.wi, reach).is_some() {
            return Vec3::ZERO;
        }
        let (mut f, pdf) = self.bsdf(matter, hit, n, wo, light.wi);
        if self.is("no-pi-light") && !matches!(matter, Matter::Metal(..)) {
            f = f * PI;
        }
        let cosine = if self.is("no-cosine-light") { 1.0 } else { self.cosine(cosine) };
        let weighted = self.weighted && !light.is_point && !self.is("unweighted");
        let weight = if weighted { power(light.pdf, pdf) } else { 1.0 };
        let divisor = match self.mistake {
            "no-pdf-light" => 1.0,
            "other-pdf" if !light.is_point => pdf,
            _ => light.pdf,
        };
        f * light.radiance * (cosine * weight / divisor)
    }

    /// Returns a scattered direction, the factor on the throughput, and the pdf of the direction.
    fn scatter(&self, matter: &Matter, hit: &Hit, n: Vec3, wo: Vec3, random: &mut Random) -> Option<(Vec3, Vec3, f64)> {
        let u = random.next();
        let v = if self.is("one-number") { u } else { random.next() };
        let (t, b) = tangents(n);
        let polar = |z: f64| {
            let side = (1.0 - z * z).max(0.0).sqrt();
            Vec3(side * (2.0 * PI * v).cos(), side * (2.0 * PI * v).sin(), z)
        };
        let place = |local: Vec3| t * local.0 + b * local.1 + n * local.2;
        if let Matter::Metal(_, alpha) = *matter {
            let z = ((1.0 - u) / (1.0 + (alpha * alpha - 1.0) * u)).sqrt();
            let wi = mirrored(-wo, place(polar(z)));
            if wi.dot(n) <= 0.0 {
                return None;
            }
            let (f, pdf) = self.bsdf(matter, hit, n, wo, wi);
            let divisor = if self.is("no-pdf") { 1.0 } else { pdf };
            return Some((wi, f * (self.cosine(wi.dot(n)) / divisor), pdf));
        }
        let local = polar(if self.is("uniform-directions") { u } else { (1.0 - u).sqrt() });
        let wi = match self.mistake {
            "wrong-frame" => local,
            "wrong-frame-y" => Vec3(local.0, local.2, local.1),
            _ => place(local),
        };
        let (f, _) = self.bsdf(matter, hit, n, wo, place(local));
        let pdf = local.2.max(1e-6) / PI;
        let divisor = match self.mistake {
            "no-pdf" => 1.0,
            "uniform-pdf" => 0.5 / PI,
            _ => pdf,
        };
        Some((wi, f * (self.cosine(local.2.max(1e-6)) / divisor), pdf))
    }

    /// Returns the direction that continues a path at glass, and the factor on the throughput.
    fn pass_glass(&self, ior: f64, hit: &Hit, d: Vec3, random: &mut Random) -> (Vec3, Vec3) {
        let enters = d.dot(hit.n) < 0.0;
        let n = if enters { hit.n } else { -hit.n };
        let right = if enters { 1.0 / ior } else { ior };
        let cosine = -d.dot(n);
        let inverted = matches!(self.mistake, "index-inverted" | "index-inverted-ends");
        let eta = if inverted { 1.0 / right } else { right };
        let along = (d + n * cosine) * eta;
        let root = 1.0 - along.dot(along);
        let reflects = random.next() < fresnel(cosine, right) && !self.is("x-no-fresnel");
        if reflects || root <= 0.0 {
            let ends = !reflects && self.is("index-inverted-ends");
            return (mirrored(d, n), if ends { Vec3::ZERO } else { Vec3::ONE });
        }
        let through = match self.mistake {
            "bent-back" => -along - n * root.sqrt(),
            "not-bent" => d,
            _ => along - n * root.sqrt(),
        };
        let scale = match self.mistake {
            "eta-squared-divided" => 1.0 / (ior * ior),
            "eta-squared-multiplied" => ior * ior,
            _ => right * right,
        };
        (through, Vec3::ONE * scale)
    }

    /// Returns the weight of a sampled light that a path hits. `last` is the pdf of the direction
    /// at the last vertex, or `None` after the camera, a mirror or glass. `light` is the pdf of the
    /// light sample.
    fn hit_weight(&self, last: Option<f64>, light: f64, depth: u32) -> f64 {
        match last {
            None if depth > 0 && self.is("x-mirror-dark") => 0.0,
            None => 1.0,
            Some(_) if matches!(self.mistake, "unweighted" | "emission-again" | "by-chance") => 1.0,
            Some(pdf) if self.weighted => power(pdf, light),
            Some(_) => 0.0,
        }
    }

    fn walk(&self, mut o: Vec3, mut d: Vec3, throughput: &mut Vec3, random: &mut Random) -> Vec3 {
        let mut sum = Vec3::ZERO;
        let mut last = None;
        let bounces = match self.mistake {
            "depth-less" => self.scene.bounces - 1,
            "depth-more" => self.scene.bounces + 1,
            "direct-only" => 0,
            _ => self.scene.bounces,
        };
        for depth in 0.. {
            let Some(hit) = self.closest(o, d, f64::INFINITY) else {
                let weight = match self.scene.sky {
                    Sky::Constant(_) => 1.0,
                    Sky::Picture => self.hit_weight(last, self.sky_pdf(d) * self.choice(), depth),
                };
                return sum + *throughput * self.sky_radiance(d) * weight;
            };
            let thing = &self.scene.things[hit.object];
            let front = -d.dot(hit.n);
            if thing.emission != Vec3::ZERO && (front > 0.0 || self.is("two-sided")) {
                let pdf = self.area_pdf(thing, hit.t, front.abs()) * self.choice();
                let emission = thing.emission * self.hit_weight(last, pdf, depth);
                sum = sum + *throughput * emission * if self.is("light-halved") { 0.5 } else { 1.0 };
            }
            if depth > bounces {
                break;
            }
            let n = if front > 0.0 { hit.n } else { -hit.n };
            let (wi, factor, pdf) = match thing.matter {
                Matter::Mirror(color) => (mirrored(d, n), color, None),
                Matter::Glass(ior) => {
                    let (wi, factor) = self.pass_glass(ior, &hit, d, random);
                    (wi, factor, None)
                }
                matter => {
                    let direct = self.direct(&matter, &hit, n, -d, random);
                    sum = sum + *throughput * direct * if self.is("light-halved") { 0.5 } else { 1.0 };
                    let Some((wi, factor, pdf)) = self.scatter(&matter, &hit, n, -d, random) else { break };
                    (wi, factor, Some(pdf))
                }
            };
            *throughput = *throughput * factor;
            (o, d, last) = (hit.p, wi, pdf);
            let early = self.is("early-roulette");
            if depth >= 3 || early {
                let survival = if early { 0.7 } else { throughput.max_component().min(0.95) };
                if random.next() >= survival {
                    break;
                }
                *throughput = match self.mistake {
                    "no-roulette" | "early-roulette" => *throughput,
                    "roulette-per-channel" => throughput.map(|c| if c > 0.0 { c / c.min(0.95) } else { 0.0 }),
                    _ => *throughput * (1.0 / survival),
                };
            }
        }
        sum
    }

    /// Returns the direction of a camera ray through a point of the picture, in pixels from the
    /// upper left corner.
    fn camera(&self, x: f64, y: f64) -> Vec3 {
        let look = self.scene.look.unit();
        let right = look.cross(Vec3(0.0, 1.0, 0.0)).unit();
        let half = 0.5 * SIDE as f64;
        let scale = (0.5 * self.scene.angle.to_radians()).tan() / half;
        (look + right * ((x - half) * scale) + right.cross(look) * ((half - y) * scale)).unit()
    }

    /// Renders the scene with a number of samples per pixel.
    pub fn picture(&self, samples: usize, seed: u64) -> Picture {
        let shown = |c: f64| match self.mistake {
            "no-curve" | "gamma-first" => c,
            "curve-twice" => srgb(srgb(c)),
            _ => srgb(c),
        };
        let pixel = |pixel: usize| -> [Vec3; 2] {
            let mut random = Random::new(pixel as u64, seed);
            let mut sums = [Vec3::ZERO; 2];
            let mut throughput = Vec3::ONE;
            for sample in 0..samples {
                if !self.is("throughput-kept") {
                    throughput = Vec3::ONE;
                }
                let (x, y) = ((pixel % SIDE) as f64 + random.next(), (pixel / SIDE) as f64 + random.next());
                let light = self.walk(self.scene.eye, self.camera(x, y), &mut throughput, &mut random);
                let light = match self.mistake {
                    "clamped-first" => light.map(|c| c.min(1.0)),
                    "gamma-first" => light.map(|c| srgb(c).min(1.0)),
                    _ => light,
                };
                sums[sample % 2] = sums[sample % 2] + light;
            }
            sums.map(|sum| sum * (2.0 / samples as f64))
        };
        let all: Vec<[Vec3; 2]> = (0..SIDE * SIDE).into_par_iter().map(pixel).collect();
        let linear = [0, 1].map(|half| all.iter().map(|both| both[half]).collect::<Vec<Vec3>>());
        let byte = |c: f64| (shown(c) * 255.0 + 0.5).clamp(0.0, 255.0) as u8;
        let bytes = all.iter().map(|[a, b]| {
            let Vec3(r, g, b) = (*a + *b) * 0.5;
            [byte(r), byte(g), byte(b)]
        });
        Picture {
            bytes: bytes.collect(),
            shown: [0, 1].map(|half| linear[half].iter().map(|c| c.map(shown)).collect()),
            linear,
        }
    }
}

/// Returns distance, normal of the front and texture coordinates of the closest hit of a ray with a
/// shape. Unlimited rays have an infinite `most`.
fn hit(form: &Form, o: Vec3, d: Vec3, most: f64) -> Option<(f64, Vec3, (f64, f64))> {
    let inside = |t: &f64| *t > EPSILON && *t < most;
    match *form {
        Form::Sphere(center, radius) => {
            let (b, c) = (d.dot(o - center), (o - center).dot(o - center) - radius * radius);
            let root = b * b - c;
            if root < 0.0 {
                return None;
            }
            let t = [-b - root.sqrt(), -b + root.sqrt()].into_iter().find(inside)?;
            Some((t, (o + d * t - center) * (1.0 / radius), (0.0, 0.0)))
        }
        Form::Rectangle(corner, edge0, edge1) => {
            let n = edge0.cross(edge1);
            let t = Some((corner - o).dot(n) / d.dot(n)).filter(inside)?;
            let way = o + d * t - corner;
            let (u, v) = (way.dot(edge0) / edge0.dot(edge0), way.dot(edge1) / edge1.dot(edge1));
            ((0.0..=1.0).contains(&u) && (0.0..=1.0).contains(&v)).then(|| (t, n.unit(), (u, v)))
        }
        Form::Triangle([a, b, c]) => {
            let n = (b - a).cross(c - a);
            let t = Some((a - o).dot(n) / d.dot(n)).filter(inside)?;
            let p = o + d * t;
            let within = |a: Vec3, b: Vec3| (b - a).cross(p - a).dot(n) >= 0.0;
            (within(a, b) && within(b, c) && within(c, a)).then(|| (t, n.unit(), (0.0, 0.0)))
        }
    }
}
