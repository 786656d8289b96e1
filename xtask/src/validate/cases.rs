//! Scenes with known answers.

use durer::math::{Vec3, fp};
use durer::texture::CieSky;
use std::f64::consts::PI;

/// A scene with a known answer: the quantity to measure, its formula and its value.
pub struct Case {
    pub name: &'static str,
    pub formula: &'static str,
    /// Fields of the `Background` block.
    pub background: String,
    pub materials: String,
    pub lights: String,
    pub group: String,
    pub what: Quantity,
    pub bounces: u32,
    pub answer: f64,
}

/// Quantity that a case measures.
pub enum Quantity {
    /// Illuminance at a point, for the side to which a normal points.
    Illuminance(Vec3, Vec3),
    /// Luminance seen from a point in a direction.
    Luminance(Vec3, Vec3),
    /// Flux through parallelograms (corner and two edges), on the side of the cross product of the
    /// edges.
    Flux(Vec<[Vec3; 3]>),
}

impl Quantity {
    /// Returns the unit of the quantity.
    pub fn unit(&self) -> &'static str {
        match self {
            Quantity::Illuminance(..) => "lx",
            Quantity::Luminance(..) => "cd/m²",
            Quantity::Flux(_) => "lm",
        }
    }
}

const MATTE: &str = "PrincipledMaterial { baseColor 0.5 0.5 0.5 specularWeight 0 }";
const BLACK: &str = "PrincipledMaterial { baseColor 0 0 0 specularWeight 0 }";
const LIGHT: &str = "PrincipledMaterial { baseColor 0 0 0 specularWeight 0 emissionLuminance 1000 }";
const GLASS: &str = "PrincipledMaterial { transmissionWeight 1 specularRoughness 0 }";
/// Fields of a point light of 100 cd. The colour of a light is its illuminance divided by pi.
const CANDELAS_100: &str = "color 31.830989 31.830989 31.830989 attenuation 0 0 1";
/// A sun at the zenith with an illuminance of 1000 lux.
const SUN: &str = "DirectionalLight { direction 0 -1 0 color 318.30989 318.30989 318.30989 }";
/// Fields of a sky with uniform luminance, also below the horizon.
const UNIFORM_SKY: &str = "color 1000 1000 1000";

/// Form factor from a floor element to a parallel rectangle that has a corner above the element.
/// The arguments are the sides of the rectangle divided by its distance.
fn parallel(x: f64, y: f64) -> f64 {
    let (p, q) = ((1.0 + x * x).sqrt(), (1.0 + y * y).sqrt());
    (x / p * fp::atan_f64(y / p) + y / q * fp::atan_f64(x / q)) / (2.0 * PI)
}

/// Form factor from an element to a perpendicular rectangle. The element is opposite a corner, and
/// its normal is along the sides of length `a`; `b` is the length of the other sides and `c` the
/// distance.
fn perpendicular(a: f64, b: f64, c: f64) -> f64 {
    let far = (a * a + c * c).sqrt();
    (fp::atan_f64(b / c) - c / far * fp::atan_f64(b / far)) / (2.0 * PI)
}

fn cos3(h: f64, x: f64) -> f64 {
    h / ((h * h + x * x) * (h * h + x * x).sqrt())
}

/// Returns the reflectance of a boundary for light polarised in the plane of incidence and
/// perpendicular to it, by Fresnel's equations.
fn polarised(cosine: f64, eta: f64) -> [f64; 2] {
    let behind = (1.0 - (1.0 - cosine * cosine) / (eta * eta)).sqrt();
    let parallel = (eta * cosine - behind) / (eta * cosine + behind);
    let across = (cosine - eta * behind) / (cosine + eta * behind);
    [parallel * parallel, across * across]
}

/// Returns the reflectance for unpolarised light.
fn fresnel(cosine: f64, eta: f64) -> f64 {
    let [parallel, across] = polarised(cosine, eta);
    0.5 * (parallel + across)
}

/// Returns the transmittance of two faces with reflectance `r`, including all inter-reflections.
/// Each pass between the faces keeps the fraction `kept`.
fn through_faces(r: f64, kept: f64) -> f64 {
    (1.0 - r) * (1.0 - r) * kept / (1.0 - r * r * kept * kept)
}

/// Returns the transmittance of a pane at an angle, for light that is unpolarised at each face.
fn pane(cosine: f64, kept: f64) -> f64 {
    through_faces(fresnel(cosine, 1.5), kept)
}

/// Returns the transmittance of a pane at an angle, for light that keeps its polarisation.
fn polarised_pane(cosine: f64, kept: f64) -> f64 {
    let [along, across] = polarised(cosine, 1.5).map(|r| through_faces(r, kept));
    0.5 * (along + across)
}

/// Returns the illuminance at the origin for normal `n`, from a sky seen through an opening, by the
/// midpoint rule with 2000 x 2000 cells.
fn through(opening: [Vec3; 3], n: Vec3, sky: impl Fn(Vec3) -> f64) -> f64 {
    const STEPS: u32 = 2_000;
    let [corner, a, b] = opening.map(|v| v.as_dvec3());
    let across = a.cross(b);
    let mut sum = 0.0;
    for i in 0..STEPS * STEPS {
        let share = |i: u32| (f64::from(i) + 0.5) / f64::from(STEPS);
        let place = corner + share(i % STEPS) * a + share(i / STEPS) * b;
        let (square, dir) = (place.length_squared(), place.normalize());
        sum += sky(dir.as_vec3()) * dir.dot(n.as_dvec3()).max(0.0) * dir.dot(across).abs() / square;
    }
    sum / f64::from(STEPS * STEPS)
}

/// Returns the text of a plate with a rectangular opening: four rectangles in the plane of the
/// opening.
fn walls_around(opening: [Vec3; 3]) -> String {
    let [corner, a, b] = opening;
    const FAR: f32 = 999.0;
    let (u, v) = (a.normalize(), b.normalize());
    let piece = |corner: Vec3, a: Vec3, b: Vec3| {
        let [c, a, b] = [corner, a, b].map(|v| format!("{} {} {}", v.x, v.y, v.z));
        format!("Rectangle {{ corner {c} edge0 {a} edge1 {b} }} ")
    };
    let low = corner - FAR * u - FAR * v;
    piece(low, FAR * u, 2.0 * FAR * v)
        + &piece(corner + a - FAR * v, FAR * u, 2.0 * FAR * v)
        + &piece(corner - FAR * v, a, FAR * v)
        + &piece(corner + b, a, FAR * v)
}

fn case(name: &'static str, formula: &'static str, what: Quantity, answer: f64) -> Case {
    let none = String::new;
    let materials = BLACK.into();
    Case { name, formula, background: none(), materials, lights: none(), group: none(), what, bounces: 0, answer }
}

fn floor() -> Quantity {
    Quantity::Illuminance(Vec3::ZERO, Vec3::Y)
}

/// Returns the six inner faces of a cube of 4 m around the origin, with normals pointing inwards.
fn inside_of_cube() -> Vec<[Vec3; 3]> {
    let side = |n: Vec3| {
        let u = n.any_orthonormal_vector().abs().round();
        let v = n.cross(u);
        [-1.999 * n - 2.0 * u - 2.0 * v, 4.0 * u, 4.0 * v]
    };
    [Vec3::X, Vec3::Y, Vec3::Z].iter().flat_map(|&n| [side(n), side(-n)]).collect()
}

/// Returns all cases.
pub fn cases() -> Vec<Case> {
    let mut all = area_lights();
    all.extend(skies());
    all.extend(reflections());
    all.extend(panes());
    all
}

fn area_lights() -> Vec<Case> {
    let light = |name, formula, form: &str, answer| Case {
        materials: LIGHT.into(),
        group: format!("MaterialIndex 0 {form}"),
        ..case(name, formula, floor(), answer)
    };
    vec![
        Case {
            lights: format!("PointLight {{ position 1.5 2 0 {CANDELAS_100} }}"),
            ..case(
                "[5.2] Point source of 100 cd, 2 m high, 1.5 m to the side",
                "E = I cos³θ / h²",
                floor(),
                100.0 * cos3(2.0, 1.5),
            )
        },
        light(
            "[5.3] Disc of 1000 cd/m², radius 1.5 m, 2 m overhead",
            "E = π L r² / (r² + d²)",
            "Disc { center 0 2 0 normal 0 -1 0 radius 1.5 }",
            PI * 1000.0 * 2.25 / 6.25,
        ),
        light(
            "Sphere of 1000 cd/m², radius 0.5 m, 3 m overhead",
            "E = π L (r / d)²",
            "Sphere { center 0 3 0 radius 0.5 }",
            PI * 1000.0 / 36.0,
        ),
        light(
            "[5.3] Panel of 1000 cd/m², 3 m x 1 m, 2 m overhead, corner over the point",
            "Howell C-11",
            "Rectangle { corner 0 2 0 edge0 3 0 0 edge1 0 0 1 }",
            PI * 1000.0 * parallel(1.5, 0.5),
        ),
        light(
            "The same panel as two triangles",
            "Lambert 1760: any polygon",
            "Triangle { vertex0 0 2 0 vertex1 3 2 0 vertex2 3 2 1 } Triangle { vertex0 0 2 0 vertex1 3 2 1 vertex2 0 2 1 }",
            PI * 1000.0 * parallel(1.5, 0.5),
        ),
        Case {
            what: Quantity::Illuminance(Vec3::new(0.0, 0.7, 0.0), Vec3::X),
            ..light(
                "[5.3] Panel of 1000 cd/m², 2 m x 1.5 m, on the floor next to a wall, point on the wall 0.7 m above its corner",
                "Howell C-12",
                "Rectangle { corner 0 0 0 edge0 0 0 1.5 edge1 2 0 0 }",
                PI * 1000.0 * perpendicular(2.0, 1.5, 0.7),
            )
        },
    ]
}

fn skies() -> Vec<Case> {
    let roof = [Vec3::new(0.0, 2.0, 0.0), Vec3::new(3.0, 0.0, 0.0), Vec3::new(0.0, 0.0, 1.0)];
    // A window on the +x side whose sill is 1 m above the point.
    let window = [Vec3::new(2.0, 1.0, -0.8), Vec3::new(0.0, 1.2, 0.0), Vec3::new(0.0, 0.0, 1.6)];
    let open =
        |name, formula, sky: &str, answer| Case { background: sky.into(), ..case(name, formula, floor(), answer) };
    let behind = |name, formula, sky: &str, opening: [Vec3; 3], answer| {
        // A lid covers the area behind a window.
        let lid = match opening[0] == window[0] {
            true => "Rectangle { corner -999 2.5 -999 edge0 1001 0 0 edge1 0 0 1998 }",
            false => "",
        };
        Case { group: format!("MaterialIndex 0 {} {lid}", walls_around(opening)), ..open(name, formula, sky, answer) }
    };
    let mut all = vec![
        open("Open field under a uniform sky of 1000 cd/m²", "E = π L", UNIFORM_SKY, PI * 1000.0),
        open(
            "Open field under the CIE overcast sky, 9000 cd/m² at the zenith",
            "E = 7 π Lz / 9",
            "cieSky 16 zenithLuminance 9000 groundReflectance 0",
            7_000.0 * PI,
        ),
        Case {
            what: Quantity::Illuminance(Vec3::new(0.0, 0.5, 0.0), Vec3::X),
            ..open(
                "Wall under the same sky, no light from the ground",
                "E = Lz (π/6 + 4/9): the cosine integrated over half the sky",
                "cieSky 16 zenithLuminance 9000 groundReflectance 0",
                9_000.0 * (PI / 6.0 + 4.0 / 9.0),
            )
        },
        Case {
            what: Quantity::Illuminance(Vec3::ZERO, Vec3::X),
            group:
                "MaterialIndex 0 Transform { UniformScale 1000 Disc { center 0 -0.000001 0 normal 0 -1 0 radius 1 } }"
                    .into(),
            ..open("Wall beside a black field, uniform sky of 1000 cd/m²", "E = π L / 2", UNIFORM_SKY, PI * 500.0)
        },
        behind(
            "[5.9] Open roof light of 3 m x 1 m, 2 m overhead, uniform sky",
            "E = π L F, Howell C-11",
            UNIFORM_SKY,
            roof,
            PI * 1000.0 * parallel(1.5, 0.5),
        ),
        behind(
            "[5.11] Open window of 1.6 m x 1.2 m, 2 m away, sill 1 m up, uniform sky",
            "E = π L F, Howell C-12",
            UNIFORM_SKY,
            window,
            2.0 * PI * 1000.0 * (perpendicular(2.2, 0.8, 2.0) - perpendicular(1.0, 0.8, 2.0)),
        ),
    ];
    for (name, sky, number) in [
        ("[5.9] The roof light, CIE sky 1, overcast", "cieSky 1", 1),
        ("[5.9] The roof light, CIE sky 7, partly cloudy", "cieSky 7 sun 1 1 0.5", 7),
        ("[5.9] The roof light, CIE sky 12, clear", "cieSky 12 sun 1 1 0.5", 12),
        ("[5.9] The roof light, CIE sky 16, overcast", "cieSky 16", 16),
    ] {
        let known = CieSky::new(number, Vec3::new(1.0, 1.0, 0.5), 10_000.0, 0.2);
        let answer = through(roof, Vec3::Y, |dir| f64::from(known.luminance(dir)));
        all.push(behind(name, "E = ∫ L cosθ dω, by quadrature", sky, roof, answer));
    }
    for (name, sky, number) in [
        ("[5.11] The window, CIE sky 5, uniform above the ground", "cieSky 5", 5),
        ("[5.11] The window, CIE sky 12, clear", "cieSky 12 sun 1 1 0.5", 12),
        ("[5.11] The window, CIE sky 16, overcast", "cieSky 16", 16),
    ] {
        let known = CieSky::new(number, Vec3::new(1.0, 1.0, 0.5), 10_000.0, 0.2);
        let answer = through(window, Vec3::Y, |dir| f64::from(known.luminance(dir)));
        all.push(behind(name, "E = ∫ L cosθ dω, by quadrature", sky, window, answer));
    }
    // A canopy over the window hides the sky above its edge. A screen in front hides the sky below
    // its top.
    let hidden = |low: f32, high: f32| {
        let part = [Vec3::new(2.0, low, -0.8), Vec3::new(0.0, high - low, 0.0), Vec3::new(0.0, 0.0, 1.6)];
        let known = CieSky::new(16, Vec3::Y, 10_000.0, 0.2);
        through(part, Vec3::Y, |dir| f64::from(known.luminance(dir)))
    };
    let masked = |name, plate: &str, answer| {
        let mut one = behind(name, "E = ∫ L cosθ dω over the visible part, by quadrature", "cieSky 16", window, answer);
        one.group += plate;
        one
    };
    all.push(masked(
        "[5.13] The window under a canopy 1 m deep, overcast",
        "Rectangle { corner 2.001 2.4 -999 edge0 0.999 0 0 edge1 0 0 1998 }",
        // Seen from the point, the canopy's edge at y = 2.4, x = 3 is at 1.6 in the window.
        hidden(1.0, 1.6),
    ));
    all.push(masked(
        "[5.14] The window opposite a black wall 4 m away and 3.2 m high, overcast",
        "Rectangle { corner 4 0 -999 edge0 0 3.2 0 edge1 0 0 1998 }",
        // Seen from the point, the top at y = 3.2, x = 4 is at 1.6 in the window.
        hidden(1.6, 2.2),
    ));
    all
}

fn reflections() -> Vec<Case> {
    let matte = |what, lights: &str, group: &str, bounces, name, formula, answer| Case {
        materials: format!("{MATTE} {BLACK}"),
        lights: lights.into(),
        group: format!("MaterialIndex 0 {group}"),
        bounces,
        ..case(name, formula, what, answer)
    };
    let light = |position: &str| format!("PointLight {{ position {position} {CANDELAS_100} }}");
    let patch = "Rectangle { corner 0 0 0 edge0 0 0 1.5 edge1 2 0 0 }";
    let flux = 400.0 * PI;
    // A black box with an opening in its ceiling: all flux that enters reaches the inside.
    let (a, b) = (Vec3::new(4.0, 0.0, 0.0), Vec3::new(0.0, 0.0, 4.0));
    let up = Vec3::new(0.0, 3.0, 0.0);
    let (low, far) = (Vec3::new(-2.0, 0.001, -2.0), Vec3::new(2.0, 0.001, 2.0));
    let inside = vec![
        [low, b, a],
        [low + 0.001 * Vec3::X, up, b],
        [low + 0.001 * Vec3::Z, a, up],
        [far - 0.001 * Vec3::X, up, -b],
        [far - 0.001 * Vec3::Z, -a, up],
    ];
    let roof = [Vec3::new(-1.0, 3.0, -0.5), Vec3::new(2.0, 0.0, 0.0), Vec3::new(0.0, 0.0, 1.0)];
    vec![
        Case {
            background: UNIFORM_SKY.into(),
            group: format!(
                "MaterialIndex 0 {} Rectangle {{ corner -2 0 -2 edge0 4 0 0 edge1 0 0 4 }} Rectangle {{ corner -2 0 -2 edge0 4 0 0 edge1 0 3.01 0 }} Rectangle {{ corner -2 0 2 edge0 4 0 0 edge1 0 3.01 0 }} \
                 Rectangle {{ corner -2 0 -2 edge0 0 0 4 edge1 0 3.01 0 }} Rectangle {{ corner 2 0 -2 edge0 0 0 4 edge1 0 3.01 0 }}",
                walls_around(roof)
            ),
            ..case(
                "[5.4] Flux into a black room of 4 m x 4 m x 3 m through a roof light of 2 m², uniform sky",
                "Φ = π L A: all flux reaches the walls and the floor",
                Quantity::Flux(inside),
                PI * 1000.0 * 2.0,
            )
        },
        matte(
            Quantity::Illuminance(Vec3::new(0.0, 0.7, 0.0), Vec3::X),
            SUN,
            patch,
            1,
            "[5.6] Wall beside a matte floor of 2 m x 1.5 m, ρ 0.5, in 1000 lx from above",
            "E = ρ E₀ F, Howell C-12",
            500.0 * perpendicular(2.0, 1.5, 0.7),
        ),
        matte(
            Quantity::Illuminance(Vec3::new(0.0, 2.0, 0.0), Vec3::NEG_Y),
            SUN,
            patch,
            1,
            "[5.6] Ceiling 2 m over the corner of the same floor",
            "E = ρ E₀ F, Howell C-11",
            500.0 * parallel(1.0, 0.75),
        ),
        matte(
            Quantity::Illuminance(Vec3::new(0.0, 2.0, 0.0), Vec3::NEG_Y),
            SUN,
            &format!("{patch} MaterialIndex 1 Rectangle {{ corner 1 0 -5 edge0 0 1 0 edge1 0 0 10 }}"),
            1,
            "[5.7] The same with a black screen, 1 m high, across the middle of the floor",
            "E = ρ E₀ F of the visible half",
            500.0 * parallel(0.5, 0.75),
        ),
        matte(
            Quantity::Illuminance(Vec3::new(0.0, 0.0, -1.999), Vec3::Z),
            &light("0 0 0"),
            "Sphere { center 0 0 0 radius 2 }",
            60,
            "[5.8] Integrating sphere, radius 2 m, ρ 0.5, point source of 100 cd at the centre",
            "E = I/r² + Φ/S · ρ/(1 − ρ)",
            100.0 / (1.999 * 1.999) + flux / (16.0 * PI),
        ),
        matte(
            Quantity::Flux(inside_of_cube()),
            &light("0.3 0.5 -0.4"),
            "Box { min -2 -2 -2 max 2 2 2 }",
            60,
            "[5.8] Flux inside a cube of 4 m, ρ 0.5, point source of 100 cd",
            "Φ = 4π I / (1 − ρ)",
            flux / 0.5,
        ),
    ]
}

fn panes() -> Vec<Case> {
    let ball = "Difference { Sphere { center 0 0 0 radius 1 } Sphere { center 0 0 0 radius 0.9 } }";
    let mut all = vec![Case {
        background: UNIFORM_SKY.into(),
        materials: GLASS.into(),
        group: format!("MaterialIndex 0 {ball}"),
        bounces: 60,
        ..case(
            "Inside a hollow glass ball in uniform light",
            "E = π L: non-absorbing glass is invisible",
            floor(),
            PI * 1000.0,
        )
    }];
    // An area light far behind a pane, black elsewhere.
    let light = |sine: f64, cosine: f64, pane: &str| {
        let (x, y) = (20.0 * sine, 20.0 * cosine);
        let (nx, ny) = (-sine, -cosine);
        format!("MaterialIndex 1 Disc {{ center {x} {y} 0 normal {nx} {ny} 0 radius 3 }} MaterialIndex 0 {pane}")
    };
    for (name, degrees, absorbed) in [
        ("[5.5] Through a clear glass pane, n 1.5, at 0°", 0.0, false),
        ("[5.5] The same at 40°", 40.0, false),
        ("[5.5] The same at 60°", 60.0, false),
        ("[5.5] The same at 80°", 80.0, false),
        ("[5.5] Through a tinted glass pane with 50 % internal transmittance at 0°, at 60°", 60.0, true),
    ] {
        let (sine, cosine) = fp::sin_cos_degrees(degrees);
        let inside = (1.0 - sine * sine / 2.25).sqrt();
        let (tint, kept) = match absorbed {
            true => (
                "transmissionColor 0.5 0.5 0.5 transmissionDepth 0.006",
                f64::from(fp::pow(0.5, (1.0 / inside) as f32)),
            ),
            false => ("", 1.0),
        };
        all.push(Case {
            materials: format!("PrincipledMaterial {{ transmissionWeight 1 specularRoughness 0 {tint} }} {LIGHT}"),
            group: light(sine, cosine, "Box { min -99 1 -99 max 99 1.006 99 }"),
            bounces: 60,
            ..case(
                name,
                "T = (1 − F)² τ / (1 − F² τ²), Fresnel at each face, and Beer",
                Quantity::Luminance(Vec3::ZERO, Vec3::new(sine as f32, cosine as f32, 0.0)),
                1000.0 * pane(cosine, kept),
            )
        });
        let name = match (degrees as u32, absorbed) {
            (60, false) => "[5.5] As a sheet (`walls thin` with a depth), at 60°",
            (80, false) => "[5.5] As a sheet, at 80°",
            (60, true) => "[5.5] As a tinted sheet, at 60°",
            _ => continue,
        };
        let tint = if absorbed { tint } else { "transmissionDepth 0.006" };
        all.push(Case {
            materials: format!(
                "PrincipledMaterial {{ transmissionWeight 1 specularRoughness 0 walls thin {tint} }} {LIGHT}"
            ),
            group: light(sine, cosine, "Rectangle { corner -99 1 -99 edge0 198 0 0 edge1 0 0 198 }"),
            ..case(
                name,
                "mean of T for both polarisations: light keeps its polarisation inside the sheet",
                Quantity::Luminance(Vec3::ZERO, Vec3::new(sine as f32, cosine as f32, 0.0)),
                1000.0 * polarised_pane(cosine, kept),
            )
        });
    }
    all
}
