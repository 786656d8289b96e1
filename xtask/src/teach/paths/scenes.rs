//! Scenes of the judge's path tracer as plain data, and their text in Dürer's own language.

use crate::teach::vector::Vec3;
use std::fmt::Write;

/// Scattering of a surface in a scene of the judge's path tracer.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum Matter {
    /// Lambertian surface with its albedo.
    Matte(Vec3),
    /// Lambertian surface with the albedo of the texture.
    Textured,
    /// Perfect mirror with its reflectance.
    Mirror(Vec3),
    /// Smooth glass with its index of refraction.
    Glass(f64),
    /// Rough conductor with its reflectance at normal incidence and GGX's alpha.
    Metal(Vec3, f64),
}

/// Shape of an object in a scene of the judge's path tracer.
#[derive(Clone, Copy, Debug)]
pub enum Form {
    /// Centre and radius.
    Sphere(Vec3, f64),
    /// Corner and two edges. Seen from the front, the second edge is counter-clockwise from the
    /// first.
    Rectangle(Vec3, Vec3, Vec3),
    /// Corners, counter-clockwise when seen from the front.
    Triangle([Vec3; 3]),
}

/// An object in a scene of the judge's path tracer. Only rectangles emit light.
#[derive(Clone, Copy, Debug)]
pub struct Thing {
    pub form: Form,
    pub matter: Matter,
    /// Radiance that the front emits.
    pub emission: Vec3,
}

/// Environment of a scene of the judge's path tracer.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum Sky {
    Constant(Vec3),
    /// The small picture of a sky, [`sky_texel`].
    Picture,
}

/// A scene that the judge's path tracer renders and that can be written as a scene file.
pub struct PathScene {
    pub name: &'static str,
    /// Scattering events after the first hit.
    pub bounces: u32,
    pub eye: Vec3,
    pub look: Vec3,
    /// Field of view in degrees.
    pub angle: f64,
    pub sky: Sky,
    /// Position and colour of each point light, whose light falls off by the squared distance.
    pub points: Vec<(Vec3, Vec3)>,
    pub things: Vec<Thing>,
}

/// Width and height of the pictures, in pixels.
pub const SIDE: usize = 32;
/// Width and height of the picture of the sky, in texels.
pub const SKY_SIZE: (usize, usize) = (16, 8);
/// Number of texels along each side of the texture.
pub const TEXTURE_SIDE: usize = 6;

/// Returns the colour of a texel of the sky. Rows are counted from the top.
pub fn sky_texel(x: usize, y: usize) -> Vec3 {
    match (x, y) {
        (11, 1 | 2) => Vec3(9.0, 7.5, 5.0),
        (_, 0..4) => Vec3(0.25, 0.375, 0.75) * (1.0 + 0.125 * y as f64),
        (0..8, _) => Vec3(0.25, 0.125, 0.0625),
        _ => Vec3(0.125, 0.1875, 0.0625),
    }
}

/// Returns the display values of a texel of the texture. Rows are counted from the top.
pub fn texel(x: usize, y: usize) -> [u8; 3] {
    match ((x + y) % 2, x > y) {
        (0, _) => [180, 170, 150],
        (_, true) => [150, 60, 50],
        (_, false) => [50, 80, 140],
    }
}

fn thing(form: Form, matter: Matter) -> Thing {
    Thing { form, matter, emission: Vec3::ZERO }
}

fn sphere(center: Vec3, radius: f64, matter: Matter) -> Thing {
    thing(Form::Sphere(center, radius), matter)
}

fn rectangle(corner: Vec3, edge0: Vec3, edge1: Vec3, matter: Matter) -> Thing {
    thing(Form::Rectangle(corner, edge0, edge1), matter)
}

/// Returns a rectangle that emits light downwards. `at` is its corner with the smallest
/// coordinates.
fn area_light(at: Vec3, width: f64, depth: f64, emission: Vec3) -> Thing {
    let matter = Matter::Matte(Vec3(0.5, 0.5, 0.5));
    Thing { emission, ..rectangle(at, Vec3(width, 0.0, 0.0), Vec3(0.0, 0.0, depth), matter) }
}

/// Returns a floor at height 0 around the origin.
fn floor(half: f64, matter: Matter) -> Thing {
    let side = 2.0 * half;
    rectangle(Vec3(-half, 0.0, half), Vec3(side, 0.0, 0.0), Vec3(0.0, 0.0, -side), matter)
}

/// Returns floor, ceiling, back, left and right of a room that is open at the front.
fn walls(half: f64, height: f64, depth: f64, colors: [Vec3; 3]) -> Vec<Thing> {
    let [white, left, right] = colors.map(Matter::Matte);
    let (x, y, z) = (Vec3(2.0 * half, 0.0, 0.0), Vec3(0.0, height, 0.0), Vec3(0.0, 0.0, depth));
    let corner = Vec3(-half, 0.0, -half);
    vec![
        rectangle(corner, z, x, white),
        rectangle(corner + y, x, z, white),
        rectangle(corner, x, y, white),
        rectangle(corner, y, z, left),
        rectangle(corner + x, z, y, right),
    ]
}

/// Returns the scenes.
pub fn scenes() -> Vec<PathScene> {
    let matte = |r, g, b| Matter::Matte(Vec3(r, g, b));
    let mut cornell = walls(1.0, 2.0, 2.0, [Vec3(0.8, 0.8, 0.75), Vec3(0.7, 0.08, 0.06), Vec3(0.12, 0.6, 0.14)]);
    cornell.extend([
        area_light(Vec3(-0.35, 1.98, -0.35), 0.7, 0.7, Vec3(5.0, 4.0, 2.5)),
        sphere(Vec3(-0.45, 0.4, -0.35), 0.4, Matter::Mirror(Vec3(0.9, 0.9, 0.9))),
        sphere(Vec3(0.45, 0.35, 0.2), 0.35, matte(0.75, 0.7, 0.6)),
    ]);
    let cornell = PathScene {
        name: "box",
        bounces: 3,
        eye: Vec3(0.0, 1.0, 3.6),
        look: Vec3(0.0, 0.0, -1.0),
        angle: 42.0,
        sky: Sky::Constant(Vec3::ZERO),
        points: Vec::new(),
        things: cornell,
    };
    let sky = PathScene {
        name: "sky",
        bounces: 1,
        eye: Vec3(0.5, 1.4, 5.0),
        look: Vec3(-0.1, -0.12, -1.0),
        angle: 44.0,
        sky: Sky::Picture,
        points: Vec::new(),
        things: vec![
            floor(2.5, matte(0.5, 0.5, 0.45)),
            sphere(Vec3(-0.9, 0.9, 0.0), 0.9, matte(0.7, 0.35, 0.25)),
            sphere(Vec3(0.9, 0.7, 0.6), 0.7, Matter::Mirror(Vec3(0.8, 0.8, 0.85))),
        ],
    };
    let mut room = walls(2.0, 3.0, 4.0, [Vec3(0.7, 0.68, 0.6), Vec3(0.25, 0.35, 0.6), Vec3(0.65, 0.6, 0.5)]);
    room.extend([
        area_light(Vec3(-1.5, 2.3, -1.0), 1.4, 1.2, Vec3(1.2, 1.6, 2.2)),
        area_light(Vec3(0.9, 1.9, -0.2), 0.3, 0.3, Vec3(22.0, 16.0, 9.0)),
        sphere(Vec3(-0.7, 0.6, -0.4), 0.6, matte(0.6, 0.6, 0.3)),
        sphere(Vec3(0.8, 0.5, 0.5), 0.5, Matter::Metal(Vec3(0.9, 0.65, 0.35), 0.25)),
    ]);
    let room = PathScene {
        name: "room",
        bounces: 1,
        eye: Vec3(0.2, 1.5, 6.2),
        look: Vec3(-0.02, -0.02, -1.0),
        angle: 42.0,
        sky: Sky::Constant(Vec3(0.1, 0.12, 0.16)),
        points: Vec::new(),
        things: room,
    };
    let glass = PathScene {
        name: "glass",
        bounces: 6,
        eye: Vec3(0.4, 1.6, 4.6),
        look: Vec3(-0.08, -0.22, -1.0),
        angle: 40.0,
        sky: Sky::Constant(Vec3(0.2, 0.25, 0.3)),
        points: Vec::new(),
        things: vec![
            floor(3.0, matte(0.6, 0.55, 0.5)),
            rectangle(Vec3(-3.0, 0.0, -1.8), Vec3(6.0, 0.0, 0.0), Vec3(0.0, 2.5, 0.0), matte(0.35, 0.5, 0.35)),
            area_light(Vec3(-1.6, 2.8, -1.2), 2.4, 2.2, Vec3(1.8, 1.6, 1.4)),
            sphere(Vec3(-0.4, 0.75, 0.2), 0.75, Matter::Glass(1.5)),
            sphere(Vec3(1.0, 0.5, -0.6), 0.5, matte(0.75, 0.3, 0.2)),
        ],
    };
    let textured = PathScene {
        name: "floor",
        bounces: 1,
        eye: Vec3(0.3, 2.4, 4.6),
        look: Vec3(-0.06, -0.45, -1.0),
        angle: 42.0,
        sky: Sky::Constant(Vec3(0.15, 0.18, 0.25)),
        points: vec![(Vec3(-1.6, 1.7, 1.2), Vec3(1.0, 0.9, 0.7))],
        things: vec![
            floor(2.4, Matter::Textured),
            area_light(Vec3(0.5, 2.0, -0.9), 0.8, 0.8, Vec3(4.0, 3.5, 3.0)),
            sphere(Vec3(0.7, 0.5, -0.3), 0.5, matte(0.7, 0.7, 0.65)),
            thing(
                Form::Triangle([Vec3(-1.4, 0.0, -0.9), Vec3(-0.2, 0.0, -1.3), Vec3(-0.9, 1.3, -1.2)]),
                matte(0.65, 0.6, 0.2),
            ),
        ],
    };
    // Closed, so that light is scattered many times.
    let mut white = walls(1.0, 2.0, 2.0, [Vec3(0.94, 0.9, 0.8), Vec3(0.92, 0.85, 0.6), Vec3(0.8, 0.9, 0.92)]);
    white.extend([
        rectangle(Vec3(-1.0, 0.0, 1.0), Vec3(0.0, 2.0, 0.0), Vec3(2.0, 0.0, 0.0), matte(0.9, 0.9, 0.85)),
        area_light(Vec3(-0.5, 1.98, -0.5), 1.0, 1.0, Vec3(0.3, 0.28, 0.25)),
        sphere(Vec3(-0.2, 0.5, -0.3), 0.5, matte(0.9, 0.8, 0.75)),
    ]);
    let white = PathScene {
        name: "white",
        bounces: 10,
        eye: Vec3(0.3, 1.1, 0.95),
        look: Vec3(-0.15, -0.15, -1.0),
        angle: 75.0,
        sky: Sky::Constant(Vec3::ZERO),
        points: Vec::new(),
        things: white,
    };
    vec![cornell, sky, room, glass, textured, white]
}

fn v(Vec3(x, y, z): Vec3) -> String {
    format!("{x} {y} {z}")
}

impl PathScene {
    /// Returns the scene as text in Dürer's own language.
    pub fn text(&self) -> String {
        let mut t = String::new();
        let (eye, look) = (v(self.eye), v(self.look));
        let _ = writeln!(t, "PerspectiveCamera {{ center {eye} direction {look} up 0 1 0 angle {} }}", self.angle);
        let _ = match self.sky {
            Sky::Constant(color) => writeln!(t, "Background {{ color {} }}", v(color)),
            Sky::Picture => writeln!(t, "Background {{ environment sky.pfm }}"),
        };
        let _ = writeln!(t, "Lights {{");
        for (at, color) in &self.points {
            let _ = writeln!(t, "  PointLight {{ position {} color {} attenuation 0 0 1 }}", v(*at), v(*color));
        }
        let _ =
            writeln!(t, "}}\nTextures {{ Texture {{ name tiles picture tiles.ppm texels nearest }} }}\nMaterials {{");
        for thing in &self.things {
            let _ = match thing.matter {
                Matter::Mirror(color) => {
                    writeln!(t, "  PhongMaterial {{ diffuseColor 0 0 0 reflectiveColor {} }}", v(color))
                }
                Matter::Glass(ior) => {
                    writeln!(t, "  PrincipledMaterial {{ transmissionWeight 1 specularRoughness 0 specularIor {ior} }}")
                }
                Matter::Metal(color, alpha) => writeln!(
                    t,
                    "  PrincipledMaterial {{ baseColor {} baseMetalness 1 specularRoughness {} \
                     energyCompensation off }}",
                    v(color),
                    alpha.sqrt()
                ),
                Matter::Textured => {
                    writeln!(t, "  PrincipledMaterial {{ baseColor 1 1 1 baseColorTexture tiles specularWeight 0 }}")
                }
                Matter::Matte(color) => {
                    let _ = write!(t, "  PrincipledMaterial {{ baseColor {} specularWeight 0", v(color));
                    if thing.emission != Vec3::ZERO {
                        let most = thing.emission.max_component();
                        let hue = v(thing.emission * (1.0 / most));
                        let _ = write!(t, " emissionLuminance {most} emissionColor {hue}");
                    }
                    writeln!(t, " }}")
                }
            };
        }
        let _ = writeln!(t, "}}\nGroup {{");
        for (i, thing) in self.things.iter().enumerate() {
            let form = match thing.form {
                Form::Sphere(center, radius) => format!("Sphere {{ center {} radius {radius} }}", v(center)),
                Form::Rectangle(corner, edge0, edge1) => {
                    format!("Rectangle {{ corner {} edge0 {} edge1 {} }}", v(corner), v(edge0), v(edge1))
                }
                Form::Triangle([a, b, c]) => {
                    format!("Triangle {{ vertex0 {} vertex1 {} vertex2 {} }}", v(a), v(b), v(c))
                }
            };
            let _ = writeln!(t, "  MaterialIndex {i} {form}");
        }
        t + "}\n"
    }
}

/// Returns names and contents of the pictures that the scenes refer to.
pub fn files() -> [(&'static str, Vec<u8>); 2] {
    let mut texture = format!("P6\n{TEXTURE_SIDE} {TEXTURE_SIDE}\n255\n").into_bytes();
    texture.extend((0..TEXTURE_SIDE * TEXTURE_SIDE).flat_map(|i| texel(i % TEXTURE_SIDE, i / TEXTURE_SIDE)));
    let (width, height) = SKY_SIZE;
    let mut sky = format!("PF\n{width} {height}\n-1.0\n").into_bytes();
    // The format starts with the bottom row.
    for (y, x) in (0..height).rev().flat_map(|y| (0..width).map(move |x| (y, x))) {
        let Vec3(r, g, b) = sky_texel(x, y);
        sky.extend([r, g, b].iter().flat_map(|value| (*value as f32).to_le_bytes()));
    }
    [("tiles.ppm", texture), ("sky.pfm", sky)]
}
