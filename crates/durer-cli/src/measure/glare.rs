//! Glare ratings of observers, for `--ugr`.

use super::MeasureArgs;
use super::printed::vector as text_of;
use crate::failure::Failure;
use crate::open::CompiledInput;
use crate::report;
use crate::terminal::print_line;
use durer::diag::Diagnostic;
use durer::glare::{Glare, GlareOptions, Observer, glare};
use durer::integrator::Path;
use durer::math::{Color, Vec3};
use durer::options::vector;
use durer::render::explain::SceneNames;
use serde_json::{Value, json};

/// Samples for the background luminance of an observer.
const SAMPLES: u32 = 1 << 14;

/// Solid angles of luminaires for which the rating is defined, in steradians. Source: CIE 117.
const DEFINED: std::ops::RangeInclusive<f64> = 3e-4..=0.1;

/// Parses an eye and the point at which it looks, for example `2,1.2,0:2,1.2,6`.
pub fn parse(text: &str) -> Result<[Vec3; 2], String> {
    let (eye, target) = text.split_once(':').ok_or("expected EYE:TARGET, for example 2,1.2,0:2,1.2,6")?;
    let [eye, target] = [vector(eye)?, vector(target)?];
    if eye == target {
        return Err("the eye and the point at which it looks must differ".into());
    }
    Ok([eye, target])
}

/// Prints the glare ratings of all observers.
pub fn run(args: &MeasureArgs, compiled: &CompiledInput, path: &Path, up: Vec3, lumens: Color) -> Result<(), Failure> {
    let options = GlareOptions { samples: args.samples.unwrap_or(SAMPLES), seed: args.seed, lumens };
    let names = SceneNames { files: &compiled.files, scene: &compiled.loaded.scene, world: &compiled.world };
    let rate = |&[eye, target]: &[Vec3; 2]| {
        let direction = (target - eye).normalize();
        ([eye, target], glare(path, &Observer { eye, direction, up }, &options))
    };
    let rated: Vec<([Vec3; 2], Glare)> = args.observers.iter().map(rate).collect();
    if args.json {
        let values: Vec<Value> = rated.iter().map(|(observer, glare)| as_json(observer, glare, &names)).collect();
        let units = json!({ "luminance": "cd/m^2", "solid_angle": "sr" });
        print_line(&serde_json::to_string_pretty(&json!({ "units": units, "observers": values }))?);
    } else {
        print_line("x,y,z,target_x,target_y,target_z,ugr,background,background_error,luminaires");
        for ([eye, target], Glare { ugr, background, background_error, sources }) in &rated {
            let ugr = ugr.map_or(String::new(), |ugr| format!("{ugr:.2}"));
            let [eye, target] = [*eye, *target].map(text_of);
            print_line(&format!("{eye},{target},{ugr},{background:.4},{background_error:.4},{}", sources.len()));
        }
    }
    if !args.quiet {
        rated.iter().for_each(|(observer, glare)| warn(observer, glare, &names));
        let count = compiled.world.lights().len();
        if count > 0 {
            let message = format!(
                "{} without extent left out: only surfaces with emission have a luminance",
                report::counted(count, "light")
            );
            report::note(&Diagnostic::warning(message).code("light-without-extent"));
        }
    }
    Ok(())
}

fn as_json([eye, target]: &[Vec3; 2], glare: &Glare, names: &SceneNames) -> Value {
    let sources = glare.sources.iter().map(|source| {
        json!({
            "object": names.object(source.object),
            "luminance": source.luminance,
            "solid_angle": source.solid_angle,
            "position_index": source.position_index,
        })
    });
    json!({
        "eye": eye.to_array(),
        "target": target.to_array(),
        "ugr": glare.ugr,
        "background": glare.background,
        "background_error": glare.background_error,
        "luminaires": sources.collect::<Vec<_>>(),
    })
}

/// Warns if the rating of an observer is undefined.
fn warn([eye, _]: &[Vec3; 2], glare: &Glare, names: &SceneNames) {
    let note = |message: String| report::note(&Diagnostic::warning(message).code("ugr-undefined"));
    let eye = text_of(*eye);
    if glare.sources.is_empty() {
        note(format!("the observer at {eye} sees no luminaire, so there is no UGR"));
    } else if glare.ugr.is_none() {
        note(format!("the observer at {eye} sees a black background, so there is no UGR"));
    }
    for source in glare.sources.iter().filter(|source| !DEFINED.contains(&source.solid_angle)) {
        note(format!(
            "{} covers {:.2e} sr as seen from {eye}, but UGR is defined for luminaires from 3e-4 to 0.1 sr",
            names.object(source.object),
            source.solid_angle
        ));
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn observers_are_parsed() {
        assert_eq!(parse("2,1.2,0:2,1.2,6"), Ok([Vec3::new(2.0, 1.2, 0.0), Vec3::new(2.0, 1.2, 6.0)]));
        for wrong in ["2,1.2,0", "1,2:1,2,3", "1,2,3:1,2,3", "1,2,3:nan,0,0", ""] {
            assert!(parse(wrong).is_err(), "{wrong}");
        }
    }
}
