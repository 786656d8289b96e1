//! What computes the light, from options.

use crate::{Failure, bad};
use clap::Args;
use clap::builder::{PossibleValuesParser, TypedValueParser};
use durer::integrator::Method;
use durer::scene::Scene;
use durer::spectrum::ColorMode;

/// What computes the light
#[derive(Args)]
pub struct MethodArgs {
    /// What computes the light: whitted (local light, mirrors, glass), path (all light) or ao (how much of the sky is
    /// free) [default: path for scenes with principled materials or an environment, else whitted]
    #[arg(long, value_name = "METHOD", value_parser = PossibleValuesParser::new(Method::NAMES))]
    pub integrator: Option<String>,
    /// With path: light that was scattered more than once is not brighter than this in a sample; takes away bright
    /// specks, and light with them [default: no limit]
    #[arg(long, value_name = "RADIANCE")]
    pub clamp: Option<f32>,
    /// With path: what light is made of: rgb, or spectral (four wavelengths at a time: coloured light on coloured things,
    /// prisms) [default: rgb]
    #[arg(long, value_name = "MODE", value_parser = color_mode())]
    pub color: Option<ColorMode>,
    /// With ao: how far things count, in units of the world [default: all count]
    #[arg(long, value_name = "DISTANCE")]
    pub ao_radius: Option<f32>,
}

/// Reads what light is made of.
pub fn color_mode() -> impl TypedValueParser<Value = ColorMode> {
    PossibleValuesParser::new(ColorMode::NAMES).map(|name| ColorMode::from_name(&name).unwrap_or_default())
}

/// The method that the options ask for, or that the scene needs.
pub fn method(args: &MethodArgs, scene: &Scene) -> Result<Method, Failure> {
    let usual = if args.ao_radius.is_some() {
        "ao"
    } else if args.clamp.is_some() || args.color.is_some() || scene.is_physical() {
        "path"
    } else {
        "whitted"
    };
    let name = args.integrator.as_deref().unwrap_or(usual);
    for (option, value, of) in [("--clamp", args.clamp, "path"), ("--ao-radius", args.ao_radius, "ao")] {
        if value.is_some() && name != of {
            return Err(bad(format!("{option} makes no sense with --integrator {name}")));
        }
        if value.is_some_and(|value| value.is_nan() || value <= 0.0) {
            return Err(bad(format!("{option} must be more than 0")));
        }
    }
    if args.color.is_some() && name != "path" {
        return Err(bad(format!("--color makes no sense with --integrator {name}")));
    }
    Ok(match name {
        "path" => Method::Path { clamp: args.clamp, color: args.color.unwrap_or_default() },
        "ao" => Method::Ao { radius: args.ao_radius.unwrap_or(f32::INFINITY) },
        _ => Method::Whitted,
    })
}

/// The options that make a method of a scene, where it is not what the scene has by itself.
pub fn spelled(method: Method, scene: &Scene) -> Vec<String> {
    let usual = if scene.is_physical() { "path" } else { "whitted" };
    let mut words = Vec::new();
    if method.name() != usual {
        words.push(format!("--integrator {}", method.name()));
    }
    match method {
        Method::Path { clamp, color } => {
            words.extend(clamp.map(|clamp| format!("--clamp {clamp}")));
            if color != ColorMode::default() {
                words.push(format!("--color {}", color.name()));
            }
        }
        Method::Ao { radius } if radius.is_finite() => words.push(format!("--ao-radius {radius}")),
        _ => {}
    }
    words
}
