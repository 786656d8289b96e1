//! Light against answers in closed form, as a table that a lighting engineer can read: docs/validation.md.

use anyhow::{Context, Result, bail};
use durer::diag::{Diagnostics, Files};
use durer::integrator::{Path, Settings};
use durer::math::{Vec3, fp};
use durer::render::Job;
use durer::sampler::SampleId;
use durer::spectrum::ColorMode;
use durer::world::World;
use durer::{LoadOptions, load_text};
use std::f64::consts::PI;
use std::fmt::Write as _;
use std::process::ExitCode;

/// Samples of each case, unless asked otherwise.
const SAMPLES: u32 = 1 << 16;

/// A case whose answer is known.
struct Case {
    name: &'static str,
    formula: &'static str,
    background: f32,
    materials: &'static str,
    lights: String,
    group: &'static str,
    /// Where the illuminance is measured, and on which side.
    at: (Vec3, Vec3),
    bounces: u32,
    answer: f64,
}

const MATTE: &str = "PrincipledMaterial { baseColor 0.5 0.5 0.5 specularWeight 0 }";
const LAMP: &str = "PrincipledMaterial { baseColor 0 0 0 specularWeight 0 emissionLuminance 1000 }";
const GLASS: &str = "PrincipledMaterial { transmissionWeight 1 specularRoughness 0 }";

/// The view factor of a parallel rectangle with a corner over the point, its sides over its distance.
fn corner(x: f64, y: f64) -> f64 {
    let (p, q) = ((1.0 + x * x).sqrt(), (1.0 + y * y).sqrt());
    (x / p * fp::atan_f64(y / p) + y / q * fp::atan_f64(x / q)) / (2.0 * PI)
}

fn cases() -> Vec<Case> {
    let floor = (Vec3::ZERO, Vec3::Y);
    let case = |name, formula, materials, lights: &str, group, answer| Case {
        name,
        formula,
        background: 0.0,
        materials,
        lights: lights.into(),
        group,
        at: floor,
        bounces: 0,
        answer,
    };
    let cos3 = |h: f64, x: f64| h / ((h * h + x * x) * (h * h + x * x).sqrt());
    vec![
        case(
            "Point source of 100 cd, 2 m high, 1.5 m aside",
            "E = I cos³θ / h²",
            MATTE,
            // A light's colour is illuminance over pi.
            "PointLight { position 1.5 2 0 color 31.830989 31.830989 31.830989 attenuation 0 0 1 }",
            "",
            100.0 * cos3(2.0, 1.5),
        ),
        case(
            "Disc of 1000 cd/m², radius 1.5 m, 2 m overhead",
            "E = π L r² / (r² + d²)",
            LAMP,
            "",
            "MaterialIndex 0 Disc { center 0 2 0 normal 0 -1 0 radius 1.5 }",
            PI * 1000.0 * 2.25 / 6.25,
        ),
        case(
            "Sphere of 1000 cd/m², radius 0.5 m, 3 m overhead",
            "E = π L (r / d)²",
            LAMP,
            "",
            "MaterialIndex 0 Sphere { center 0 3 0 radius 0.5 }",
            PI * 1000.0 / 36.0,
        ),
        case(
            "Panel of 1000 cd/m², 3 m x 1 m, 2 m overhead, corner over the point",
            "Howell C-11",
            LAMP,
            "",
            "MaterialIndex 0 Rectangle { corner 0 2 0 edge0 3 0 0 edge1 0 0 1 }",
            PI * 1000.0 * corner(1.5, 0.5),
        ),
        case(
            "The same of two triangles",
            "Lambert 1760: any polygon",
            LAMP,
            "",
            "MaterialIndex 0 Triangle { vertex0 0 2 0 vertex1 3 2 0 vertex2 3 2 1 } Triangle { vertex0 0 2 0 vertex1 3 2 1 vertex2 0 2 1 }",
            PI * 1000.0 * corner(1.5, 0.5),
        ),
        Case {
            background: 1000.0,
            ..case("Open field under a uniform sky of 1000 cd/m²", "E = π L", MATTE, "", "", PI * 1000.0)
        },
        Case {
            background: 1000.0,
            at: (Vec3::ZERO, Vec3::X),
            ..case(
                "Vertical surface before a dark field, the same sky",
                "E = π L / 2",
                LAMP,
                "",
                "MaterialIndex 0 Transform { UniformScale 1000 Disc { center 0 -0.000001 0 normal 0 -1 0 radius 1 } }",
                PI * 500.0,
            )
        },
        Case {
            background: 1000.0,
            ..case(
                "Unglazed roof opening of 3 m x 1 m, 2 m overhead, its corner over the point",
                "E = π L F, Howell C-11",
                "PrincipledMaterial { baseColor 0 0 0 specularWeight 0 }",
                "",
                "MaterialIndex 0 Rectangle { corner -999 2 -999 edge0 999 0 0 edge1 0 0 1999 } Rectangle { corner 3 2 -999 edge0 999 0 0 edge1 0 0 1999 } Rectangle { corner 0 2 -999 edge0 3 0 0 edge1 0 0 999 } Rectangle { corner 0 2 1 edge0 3 0 0 edge1 0 0 999 }",
                PI * 1000.0 * corner(1.5, 0.5),
            )
        },
        Case {
            at: (Vec3::new(0.0, 0.0, -1.999), Vec3::Z),
            bounces: 60,
            ..case(
                "Integrating sphere, radius 2 m, albedo 0.5, a source of 100 cd in the middle",
                "E = I/r² + Φ/S · ρ/(1 − ρ)",
                MATTE,
                "PointLight { position 0 0 0 color 31.830989 31.830989 31.830989 attenuation 0 0 1 }",
                "MaterialIndex 0 Sphere { center 0 0 0 radius 2 }",
                100.0 / (1.999 * 1.999) + 400.0 * PI / (16.0 * PI) * 1.0,
            )
        },
        Case {
            background: 1000.0,
            at: (Vec3::ZERO, Vec3::Y),
            bounces: 60,
            ..case(
                "In a hollow glass ball under a uniform sky all around",
                "E = π L: glass that absorbs nothing is not there",
                GLASS,
                "",
                "MaterialIndex 0 Difference { Sphere { center 0 0 0 radius 1 } Sphere { center 0 0 0 radius 0.9 } }",
                PI * 1000.0,
            )
        },
    ]
}

fn world(case: &Case) -> Result<World> {
    let Case { background: b, materials, lights, group, .. } = case;
    let text = format!(
        "PerspectiveCamera {{ center 0 1 9 direction 0 0 -1 up 0 1 0 angle 30 }}\nBackground {{ color {b} {b} {b} }}\n\
         Lights {{ {lights} }}\nMaterials {{ {materials} }}\nGroup {{ {group} }}\n"
    );
    let options = LoadOptions::default();
    let (mut files, mut diagnostics) = (Files::default(), Diagnostics::default());
    let path = std::path::Path::new("validation.txt");
    let loaded = load_text(path, text.as_bytes().into(), &options, &mut files, &mut diagnostics);
    loaded
        .and_then(|loaded| loaded.compile(&options, &mut files, &mut diagnostics))
        .with_context(|| format!("{}: {diagnostics:?}", case.name))
}

/// The mean of many samples, and its standard error.
fn measured(case: &Case, samples: u32) -> Result<(f64, f64)> {
    let world = world(case)?;
    let settings = Settings { bounces: case.bounces, ..Job::default().settings };
    let path = Path { world: &world, settings, clamp: None, color: ColorMode::Rgb, photons: None, cancel: None };
    let (mut sum, mut squares) = (0.0, 0.0);
    for sample in 0..samples {
        let (point, normal) = case.at;
        let id = SampleId::new(0, (0, 0), sample);
        let value = f64::from(path.irradiance(point.as_dvec3(), normal, id, &mut ()).y);
        (sum, squares) = (sum + value, squares + value * value);
    }
    let n = f64::from(samples);
    Ok((sum / n, ((squares / n - (sum / n) * (sum / n)).max(0.0) / n).sqrt()))
}

pub fn run(arguments: &[String]) -> Result<ExitCode> {
    let samples = match arguments {
        [] => SAMPLES,
        [flag, number] if flag == "--samples" => number.parse()?,
        _ => bail!("usage: cargo xtask validate [--samples N]"),
    };
    let mut table = String::from(
        "# Light against answers in closed form\n\nMade by `cargo xtask validate`. Each row is an illuminance in lux that follows from first \
         principles, and what the\npath tracer measures at the same point with its standard error (of independent samples: ours are spread more \
         evenly). Scenes\nand formulas are in `xtask/src/validate.rs`.\n\n\
         | case | formula | answer | measured | off |\n| --- | --- | ---: | ---: | ---: |\n",
    );
    let mut wrong = 0;
    for case in cases() {
        let (mean, error) = measured(&case, samples)?;
        let off = mean / case.answer - 1.0;
        let right = (mean - case.answer).abs() <= 3.0 * error + 0.001 * case.answer;
        wrong += usize::from(!right);
        let row = format!(
            "| {} | {} | {:.3} | {mean:.3} ± {error:.3} | {:+.3} % |",
            case.name,
            case.formula,
            case.answer,
            100.0 * off
        );
        println!("{row}{}", if right { "" } else { "  WRONG" });
        writeln!(table, "{row}")?;
    }
    if wrong > 0 {
        println!("{wrong} cases are off by more than three standard errors and a thousandth");
        return Ok(ExitCode::FAILURE);
    }
    std::fs::write("docs/validation.md", table)?;
    println!("wrote docs/validation.md");
    Ok(ExitCode::SUCCESS)
}
