//! What computes the light, from options.

use crate::{Failure, bad};
use clap::Args;
use clap::builder::{PossibleValuesParser, TypedValueParser};
use durer::integrator::{Direct, Method, Transport};
use durer::scene::Scene;
use durer::spectrum::ColorMode;

/// What computes the light
#[derive(Args, Clone)]
pub struct MethodArgs {
    /// What computes the light: whitted (local light, mirrors, glass), path (all light), photons
    /// (all light, with what mirrors and glass throw on things by photons: caustics) or ao (how
    /// much of the sky is free) [default: path for scenes with principled materials or an
    /// environment, else whitted]
    #[arg(long, value_name = "METHOD", value_parser = PossibleValuesParser::new(Method::NAMES.iter()))]
    pub integrator: Option<String>,
    /// With path and photons: light that was scattered more than once is not brighter than this in
    /// a sample; takes away bright specks, and light with them [default: no limit]
    #[arg(long, value_name = "RADIANCE")]
    pub clamp: Option<f32>,
    /// With path and photons: what light is made of: rgb, or spectral (four wavelengths at a time:
    /// coloured light on coloured things, prisms) [default: rgb]
    #[arg(long, value_name = "MODE", value_parser = color_mode())]
    pub color: Option<ColorMode>,
    /// With path and photons: how light straight from lamps is found: both (by points of lamps and
    /// by the directions in which surfaces scatter, weighed), lights or bsdf (one of these
    /// alone: the same mean and more noise, to see what each is good for) [default: both]
    #[arg(long, value_name = "WAY", value_parser = direct())]
    pub direct: Option<Direct>,
    /// With photons: how many each sample sends out [default: 100000]
    #[arg(long, value_name = "N", value_parser = clap::value_parser!(u32).range(1..=100_000_000))]
    pub photons: Option<u32>,
    /// With photons: how far the first sample looks for them, in units of the world; later ones
    /// look less far [default: a twentieth of the radius of the smallest thing that mirrors or
    /// refracts]
    #[arg(long, value_name = "DISTANCE")]
    pub photon_radius: Option<f32>,
    /// With ao: how far things count, in units of the world [default: all count]
    #[arg(long, value_name = "DISTANCE")]
    pub ao_radius: Option<f32>,
}

/// Reads what light is made of.
pub fn color_mode() -> impl TypedValueParser<Value = ColorMode> {
    PossibleValuesParser::new(ColorMode::NAMES).map(|name| ColorMode::from_name(&name).unwrap_or_default())
}

fn direct() -> impl TypedValueParser<Value = Direct> {
    PossibleValuesParser::new(Direct::CHOICES.map(Direct::name))
        .map(|name| Direct::from_name(&name).unwrap_or_default())
}

/// The method that the options ask for, or that the scene needs.
pub fn method(args: &MethodArgs, scene: &Scene) -> Result<Method, Failure> {
    let usual = if args.ao_radius.is_some() {
        "ao"
    } else if args.photons.is_some() || args.photon_radius.is_some() {
        "photons"
    } else if args.clamp.is_some() || args.color.is_some() || args.direct.is_some() || scene.is_physical() {
        "path"
    } else {
        "whitted"
    };
    let name = args.integrator.as_deref().unwrap_or(usual);
    let paths: &[&str] = &["path", "photons"];
    let number = |value: Option<f32>| (value.is_some(), value.is_none_or(|value| value > 0.0));
    for (option, (given, sound), of) in [
        ("--clamp", number(args.clamp), paths),
        ("--color", (args.color.is_some(), true), paths),
        ("--direct", (args.direct.is_some(), true), paths),
        ("--photons", (args.photons.is_some(), true), &paths[1..]),
        ("--photon-radius", number(args.photon_radius), &paths[1..]),
        ("--ao-radius", number(args.ao_radius), &["ao"]),
    ] {
        if given && !of.contains(&name) {
            return Err(bad(format!("{option} makes no sense with --integrator {name}")));
        }
        if !sound {
            return Err(bad(format!("{option} must be more than 0")));
        }
    }
    let transport =
        Transport { clamp: args.clamp, color: args.color.unwrap_or_default(), direct: args.direct.unwrap_or_default() };
    Ok(match name {
        "path" => Method::Path(transport),
        "photons" => {
            let count = args.photons.unwrap_or(Method::PHOTONS);
            Method::Photons { transport, count, radius: args.photon_radius, corrected: false }
        }
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
    if let Some(Transport { clamp, color, direct }) = method.transport() {
        words.extend(clamp.map(|clamp| format!("--clamp {clamp}")));
        if color != ColorMode::default() {
            words.push(format!("--color {}", color.name()));
        }
        if direct != Direct::default() {
            words.push(format!("--direct {}", direct.name()));
        }
    }
    match method {
        Method::Photons { count, radius, .. } => {
            words.extend((count != Method::PHOTONS).then(|| format!("--photons {count}")));
            words.extend(radius.map(|radius| format!("--photon-radius {radius}")));
        }
        Method::Ao { radius } if radius.is_finite() => words.push(format!("--ao-radius {radius}")),
        _ => {}
    }
    words
}
