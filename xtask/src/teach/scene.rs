//! Scenes of the judge as plain data, and their text in the course's language.

use super::vector::{Matrix, Vec3};
use std::fmt::Write;

/// Dialect of a scene of the judge.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Year {
    F04,
    F12a4,
    F12a5,
    F16,
    Durer,
}

/// One matrix of an object's transform in a scene of the judge.
#[derive(Clone, Debug)]
pub enum Transform {
    Translate(Vec3),
    Scale(Vec3),
    X(f64),
    Y(f64),
    Z(f64),
}

/// Shape of an object in a scene of the judge.
#[derive(Clone, Debug)]
pub enum Shape {
    Sphere(Vec3, f64),
    Plane(Vec3, f64),
    Triangle([Vec3; 3]),
    /// File name, vertices and triangles of a mesh. The year determines whether it is shaded
    /// smoothly.
    Mesh(&'static str, Vec<Vec3>, Vec<[usize; 3]>),
}

/// An object in a scene of the judge: shape, transform and index of its material.
#[derive(Clone, Debug)]
pub struct Object {
    pub shape: Shape,
    pub ops: Vec<Transform>,
    pub material: usize,
}

/// Pattern that mixes two materials of a scene of the judge: a checkerboard, noise by its octaves,
/// or veins by octaves, frequency and amplitude.
#[derive(Clone, Copy, Debug)]
pub enum Pattern {
    Checkerboard,
    Noise(u32),
    Marble(u32, f64, f64),
    Wood(u32, f64, f64),
}

/// Pixels of a texture or of a face of the sky, starting with the top row.
pub struct Pixels {
    pub width: usize,
    pub height: usize,
    seed: u32,
}

impl Pixels {
    /// Returns the texture of the textured materials.
    pub fn texture() -> Self {
        Pixels { width: 7, height: 5, seed: 1 }
    }

    /// Returns a face of the sky, in the order left, right, up, down, front, back.
    pub fn face(face: u32) -> Self {
        Pixels { width: 6, height: 6, seed: 2 + face }
    }

    /// Returns a pixel.
    pub fn at(&self, x: usize, y: usize) -> [u8; 3] {
        let mix = |channel: u32| {
            let n = (self.seed * 64 + (y * self.width + x) as u32).wrapping_mul(3) + channel;
            let n = (n ^ n >> 3).wrapping_mul(0x9e37_79b9);
            40 + ((n ^ n >> 15).wrapping_mul(0x85eb_ca6b) >> 24) as u8 / 5 * 4
        };
        [mix(0), mix(1), mix(2)]
    }

    /// Returns the pixels as a PPM file.
    fn ppm(&self) -> String {
        let mut text = format!("P3\n{} {}\n255\n", self.width, self.height);
        for pixel in 0..self.width * self.height {
            let [r, g, b] = self.at(pixel % self.width, pixel / self.width);
            let _ = writeln!(text, "{r} {g} {b}");
        }
        text
    }
}

/// Phong material in a scene of the judge.
#[derive(Clone, Copy, Debug, Default)]
pub struct Material {
    /// True if the texture replaces the diffuse colour.
    pub textured: bool,
    /// Pattern with its transform, and the indices of the two materials that it mixes.
    pub pattern: Option<(Pattern, &'static [Transform], [usize; 2])>,
    pub kd: Vec3,
    pub ks: Vec3,
    pub shininess: f64,
    pub kr: Vec3,
    pub kt: Vec3,
    pub index: f64,
}

/// Light in a scene of the judge: directional or a point light.
#[derive(Clone, Copy, Debug)]
pub enum Light {
    Directional(Vec3, Vec3),
    /// Position, colour, and attenuation coefficients a0, a1, a2.
    Point(Vec3, Vec3, Vec3),
}

/// A scene that the judge's tracer renders and that can be written as a scene file.
#[derive(Clone, Debug)]
pub struct Scene {
    pub name: &'static str,
    pub year: Year,
    pub size: (usize, usize),
    pub shadows: bool,
    pub bounces: u32,
    pub eye: Vec3,
    pub look: Vec3,
    pub up: Vec3,
    /// Field of view in degrees, or minus the size of an orthographic picture.
    pub angle: f64,
    pub background: Vec3,
    /// True if a cube map replaces the background.
    pub sky: bool,
    pub ambient: Vec3,
    pub lights: Vec<Light>,
    pub materials: Vec<Material>,
    pub objects: Vec<Object>,
}

impl Transform {
    /// Returns the matrix of the transform. `degrees` converts angles to radians.
    pub fn matrix(&self, degrees: impl Fn(f64) -> f64) -> Matrix {
        let turn = |angle: f64, a: usize, b: usize| {
            let (s, c) = degrees(angle).sin_cos();
            let mut m = [[1.0, 0.0, 0.0], [0.0, 1.0, 0.0], [0.0, 0.0, 1.0]];
            (m[a][a], m[b][b], m[a][b], m[b][a]) = (c, c, -s, s);
            Matrix { rows: m.map(|r| Vec3(r[0], r[1], r[2])), by: Vec3::ZERO }
        };
        match *self {
            Transform::Translate(by) => Matrix { by, ..Matrix::ONE },
            Transform::Scale(Vec3(x, y, z)) => {
                Matrix { rows: [Vec3(x, 0.0, 0.0), Vec3(0.0, y, 0.0), Vec3(0.0, 0.0, z)], by: Vec3::ZERO }
            }
            Transform::X(angle) => turn(angle, 1, 2),
            Transform::Y(angle) => turn(angle, 2, 0),
            Transform::Z(angle) => turn(angle, 0, 1),
        }
    }
}

fn v(Vec3(x, y, z): Vec3) -> String {
    format!("{x} {y} {z}")
}

fn ops(all: &[Transform]) -> String {
    let one = |op: &Transform| match op {
        Transform::Translate(by) => format!("Translate {}", v(*by)),
        Transform::Scale(by) => format!("Scale {}", v(*by)),
        Transform::X(angle) => format!("XRotate {angle}"),
        Transform::Y(angle) => format!("YRotate {angle}"),
        Transform::Z(angle) => format!("ZRotate {angle}"),
    };
    all.iter().map(one).collect::<Vec<_>>().join(" ")
}

/// Returns the texture coordinates of a mesh's vertex.
pub fn uv(Vec3(x, y, _): Vec3) -> (f64, f64) {
    (0.5 + 0.6 * x, 0.5 + 0.7 * y)
}

impl Scene {
    /// Returns the scene as text in the course's language.
    pub fn text(&self) -> String {
        let mut t = String::new();
        let camera = if self.angle > 0.0 { "PerspectiveCamera" } else { "OrthographicCamera" };
        let lens = if self.angle > 0.0 { format!("angle {}", self.angle) } else { format!("size {}", -self.angle) };
        let (eye, look, up) = (v(self.eye), v(self.look), v(self.up));
        let _ = writeln!(t, "{camera} {{\n  center {eye}\n  direction {look}\n  up {up}\n  {lens}\n}}");
        let _ = writeln!(t, "Lights {{\n  numLights {}", self.lights.len());
        for light in &self.lights {
            let _ = match *light {
                Light::Directional(d, c) => writeln!(t, "  DirectionalLight {{ direction {} color {} }}", v(d), v(c)),
                Light::Point(p, c, a) => {
                    let fade = match self.year {
                        Year::F04 | Year::Durer => format!(" attenuation {}", v(a)),
                        Year::F12a4 => String::new(),
                        Year::F12a5 | Year::F16 => format!(" falloff {}", a.2),
                    };
                    writeln!(t, "  PointLight {{ position {} color {}{fade} }}", v(p), v(c))
                }
            };
        }
        let sky = if self.sky { " cubeMap sky" } else { "" };
        let _ = writeln!(t, "}}\nBackground {{ color {} ambientLight {}{sky} }}", v(self.background), v(self.ambient));
        let _ = writeln!(t, "Materials {{\n  numMaterials {}", self.materials.len());
        for m in &self.materials {
            if let Some((pattern, space, [first, second])) = m.pattern {
                let (word, numbers) = match pattern {
                    Pattern::Checkerboard => ("Checkerboard", String::new()),
                    Pattern::Noise(octaves) => ("Noise", format!(" octaves {octaves}")),
                    Pattern::Marble(o, f, a) => ("Marble", format!(" octaves {o} frequency {f} amplitude {a}")),
                    Pattern::Wood(o, f, a) => ("Wood", format!(" octaves {o} frequency {f} amplitude {a}")),
                };
                let space = ops(space);
                let _ = writeln!(
                    t,
                    "  {word} {{ Transform {{ {space} }} materialIndex {first} materialIndex {second}{numbers} }}"
                );
                continue;
            }
            let _ = write!(t, "  Material {{ diffuseColor {} specularColor {}", v(m.kd), v(m.ks));
            let _ = match self.year {
                Year::F04 | Year::Durer => write!(
                    t,
                    " exponent {} reflectiveColor {} transparentColor {} indexOfRefraction {}",
                    m.shininess,
                    v(m.kr),
                    v(m.kt),
                    if m.index > 0.0 { m.index } else { 1.0 }
                ),
                Year::F12a5 if m.index > 0.0 => write!(t, " shininess {} refractionIndex {}", m.shininess, m.index),
                _ => write!(t, " shininess {}", m.shininess),
            };
            if m.textured {
                let _ = write!(t, " texture texture.ppm");
            }
            let _ = writeln!(t, " }}");
        }
        let _ = writeln!(t, "}}\nGroup {{\n  numObjects {}", self.objects.len());
        for object in &self.objects {
            let shape = match &object.shape {
                Shape::Sphere(c, r) => format!("Sphere {{ center {} radius {r} }}", v(*c)),
                Shape::Plane(n, d) => format!("Plane {{ normal {} offset {d} }}", v(*n)),
                Shape::Triangle([a, b, c]) => {
                    format!("Triangle {{ vertex0 {} vertex1 {} vertex2 {} }}", v(*a), v(*b), v(*c))
                }
                Shape::Mesh(file, ..) => format!("TriangleMesh {{ obj_file {file} }}"),
            };
            let _ = match object.ops.is_empty() {
                true => writeln!(t, "  MaterialIndex {}\n  {shape}", object.material),
                false => {
                    writeln!(
                        t,
                        "  MaterialIndex {}\n  Transform {{ {}\n    {shape} }}",
                        object.material,
                        ops(&object.ops)
                    )
                }
            };
        }
        t + "}\n"
    }

    /// Returns names and contents of the files that the scene refers to.
    pub fn files(&self) -> Vec<(&'static str, String)> {
        let mut files = Vec::new();
        for object in &self.objects {
            if let Shape::Mesh(name, corners, faces) = &object.shape {
                let mut text = String::new();
                text.extend(corners.iter().map(|p| format!("v {}\n", v(*p))));
                if self.materials[object.material].textured {
                    text.extend(corners.iter().map(|p| uv(*p)).map(|(u, v)| format!("vt {u} {v}\n")));
                    let corner = |i: usize| format!("{0}/{0}", i + 1);
                    text.extend(faces.iter().map(|f| format!("f {}\n", f.map(corner).join(" "))));
                } else {
                    text.extend(faces.iter().map(|f| format!("f {} {} {}\n", f[0] + 1, f[1] + 1, f[2] + 1)));
                }
                files.push((*name, text + "\n"));
            }
        }
        if self.materials.iter().any(|material| material.textured) {
            files.push(("texture.ppm", Pixels::texture().ppm()));
        }
        if self.sky {
            let names =
                ["sky/left.ppm", "sky/right.ppm", "sky/up.ppm", "sky/down.ppm", "sky/front.ppm", "sky/back.ppm"];
            files.extend((0..6).zip(names).map(|(face, name)| (name, Pixels::face(face).ppm())));
        }
        files
    }

    /// Returns the options of `durer` for rendering the scene.
    pub fn options(&self) -> Vec<String> {
        let dialect = match self.year {
            Year::F04 => "f04",
            Year::F12a4 => "f12a4",
            Year::F12a5 => "f12a5",
            Year::F16 => "f16",
            Year::Durer => "durer",
        };
        let (transfer, w, h) = (if self.year == Year::Durer { "srgb" } else { "course" }, self.size.0, self.size.1);
        let shadows = if self.shadows { "on" } else { "off" };
        let words = format!(
            "--dialect {dialect} --size {w}x{h} --bounces {} --shadows={shadows} --transfer {transfer} --samples 1",
            self.bounces
        );
        words.split(' ').map(String::from).collect()
    }
}
