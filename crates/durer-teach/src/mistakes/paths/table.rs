//! The table of the mistakes that path tracers can make.

use crate::mistakes::path_bugs::{
    CosinePower, DirectionSampling, EnvironmentBug, MissingFactor, PixelMean, RefractionBug, RouletteBug,
};
use crate::mistakes::table::{Mistake, Values, row};

/// Common mistakes in path tracers. [`diagnose`](super::search::diagnose) tries all of them.
pub const MISTAKES: &[Mistake] = &[
    row(
        "path-depth",
        "bounces",
        "paths {have one bounce too few|have two bounces too few|have one bounce too many|stop at direct light|have only one bounce}",
        "for (depth = 0; depth <= bounces; depth++)",
        "another condition of the loop",
        |v, how| {
            let all = v.settings.bounces;
            v.settings.bounces = match how as u32 {
                0 => all.saturating_sub(1),
                1 => all.saturating_sub(2),
                2 => all + 1,
                3 => 0,
                _ => 1,
            };
        },
    )
    .with(Values::Only(&[0.0, 2.0, 3.0, 4.0, 1.0])),
    row(
        "path-cosine",
        "bounces",
        "the cosine at the surface {is left out|counts twice}",
        "throughput *= f * dot(n, wi) / pdf",
        "throughput *= f {/ pdf|* dot(n, wi) * dot(n, wi) / pdf}",
        |v, twice| v.paths.cosine_power = if twice == 0.0 { CosinePower::None } else { CosinePower::Twice },
    )
    .with(Values::Only(&[0.0, 1.0])),
    row(
        "path-no-pi",
        "bounces",
        "the diffuse BSDF lacks the factor 1/pi{|, but only for light samples}",
        "f = albedo / pi",
        "f = albedo",
        |v, lights| v.paths.no_pi = Some(lights > 0.0),
    )
    .with(Values::Only(&[0.0, 1.0])),
    row(
        "path-no-pdf",
        "mis",
        "{scattered light|the contribution of light samples} is not divided by the pdf",
        "throughput *= f * dot(n, wi) / pdf",
        "throughput *= f * dot(n, wi)",
        |v, lights| match lights == 0.0 {
            true => v.paths.direction_sampling = DirectionSampling::Undivided,
            false => v.paths.missing_factor = MissingFactor::Density,
        },
    )
    .with(Values::Only(&[0.0, 1.0])),
    row(
        "path-uniform",
        "bounces",
        "directions {are uniform over the hemisphere, but the light is divided by the pdf of cosine sampling|follow the \
         BSDF, but the light is divided by the pdf of uniform sampling}",
        "uniform: pdf = 1 / (2 pi); by the cosine: pdf = cos / pi",
        "{uniform directions with pdf = cos / pi|cosine-distributed directions with pdf = 1 / (2 pi)}",
        |v, other| {
            let bug = if other == 0.0 { DirectionSampling::Uniform } else { DirectionSampling::UniformPdf };
            v.paths.direction_sampling = bug;
        },
    )
    .with(Values::Only(&[0.0, 1.0])),
    row(
        "path-light-pdf",
        "mis",
        "light samples are divided by the pdf of BSDF sampling",
        "L = f cos(n) Le / pdf_light",
        "L = f cos(n) Le / pdf_bsdf",
        |v, _| v.paths.missing_factor = MissingFactor::OwnDensity,
    ),
    row(
        "path-local-frame",
        "bounces",
        "scattered directions are not transformed from the shading frame to world space",
        "wi = x t + y b + z n",
        "wi = (x, y, z)",
        |v, _| v.paths.direction_sampling = DirectionSampling::LocalFrame,
    ),
    row(
        "path-one-number",
        "bounces",
        "one random number is used for both dimensions of a direction",
        "u1 = random(), u2 = random()",
        "u1 = u2 = random()",
        |v, _| v.paths.direction_sampling = DirectionSampling::OneNumber,
    ),
    row(
        "path-emission-twice",
        "mis",
        "direct light is counted twice, without weights: by light samples and again where a scattered ray hits the light",
        "light sample: no emission at the next hit; or both with weights that sum to 1",
        "L += Le at every hit, and L += the light sample",
        |v, _| v.paths.unweighted = true,
    ),
    row(
        "path-roulette",
        "bounces",
        "paths that survive Russian roulette are {not divided by the survival probability|divided by the throughput of \
         each channel instead of the survival probability}",
        "if (random() >= q) break; throughput /= q",
        "if (random() >= q) break{|; throughput /= throughput}",
        |v, channel| v.paths.roulette = if channel == 0.0 { RouletteBug::Undivided } else { RouletteBug::PerChannel },
    )
    .with(Values::Only(&[0.0, 1.0])),
    row(
        "path-throughput",
        "bounces",
        "the throughput is not reset to 1 at the start of a path",
        "for each sample: throughput = 1",
        "throughput = 1 once for each pixel",
        |v, _| v.paths.kept_throughput = true,
    ),
    row(
        "path-eta-squared",
        "refraction",
        "refracted radiance is {not scaled by the squared index of refraction|divided by the squared index both when \
         entering and when leaving|multiplied by the squared index both when entering and when leaving}",
        "throughput *= (n1 / n2)^2, where n1 is on the side of the incoming ray",
        "{no factor|throughput /= n^2 on both sides|throughput *= n^2 on both sides}",
        |v, how| {
            const ALL: [RefractionBug; 3] =
                [RefractionBug::Unscaled, RefractionBug::DividedTwice, RefractionBug::MultipliedTwice];
            v.paths.refraction = ALL[(how as usize).min(2)];
        },
    )
    .with(Values::Only(&[0.0, 1.0, 2.0])),
    row(
        "path-refraction",
        "refraction",
        "refracted directions {use the inverted ratio of the indices|are bent to the wrong side|are not bent}",
        "wi = -eta wo + (eta cos1 - cos2) n, eta = n1 / n2",
        "{eta = n2 / n1|wi = +eta wo + ...|wi = -wo}",
        |v, how| {
            const ALL: [RefractionBug; 3] = [RefractionBug::Inverted, RefractionBug::Flipped, RefractionBug::Straight];
            v.paths.refraction = ALL[(how as usize).min(2)];
        },
    )
    .with(Values::Only(&[0.0, 1.0, 2.0])),
    row(
        "path-texture",
        "flat",
        "colours of textures are not decoded from sRGB",
        "color = srgb_to_linear(texel / 255)",
        "color = texel / 255",
        |v, _| v.undecoded_textures(),
    ),
    row(
        "path-light-factor",
        "mis",
        "light samples lack {1 / d^2|the cosine at the light|the area of the light|the division by the probability of choosing the light}",
        "L = f cos(n) Le cos(light) area / (d^2 probability)",
        "L = f cos(n) Le {cos(light) area / probability|area / (d^2 probability)|cos(light) / (d^2 probability)|cos(light) area / d^2}",
        |v, how| {
            const ALL: [MissingFactor; 4] = [MissingFactor::Distance, MissingFactor::Cosine, MissingFactor::Area, MissingFactor::Choice];
            v.paths.missing_factor = ALL[(how as usize).min(3)];
        },
    )
    .with(Values::Only(&[0.0, 1.0, 2.0, 3.0])),
    row(
        "path-two-sided",
        "soft-shadows",
        "one-sided area lights emit on both sides",
        "Le if dot(n_light, -wi) > 0, else 0",
        "Le",
        |v, _| v.paths.two_sided = true,
    ),
    row(
        "path-sky",
        "mis",
        "the environment is {upside down|sampled with a pdf that lacks sin(theta)}",
        "theta from the top, pdf = p(u, v) / (2 pi^2 sin(theta))",
        "{theta from the bottom|pdf = p(u, v) / (2 pi^2)}",
        |v, how| v.paths.environment = if how == 0.0 { EnvironmentBug::UpsideDown } else { EnvironmentBug::NoSine },
    )
    .with(Values::Only(&[0.0, 1.0])),
    row(
        "path-mean",
        "supersampling",
        "samples are {clamped to 1|encoded for the screen} before they are averaged",
        "encode(sum of samples / n)",
        "{encode(sum of min(1, sample) / n)|sum of encode(sample) / n}",
        |v, shown| v.paths.pixel_mean = if shown == 0.0 { PixelMean::Clamped } else { PixelMean::Shown },
    )
    .with(Values::Only(&[0.0, 1.0])),
    row(
        "path-no-shadows",
        "shadows",
        "light samples have no shadow rays",
        "if (!occluded(p, light)) L += ...",
        "L += ...",
        |v, _| v.settings.shadows = false,
    ),
    row(
        "path-curve",
        "flat",
        "the sRGB curve is {missing|applied twice}",
        "value = srgb(c) * 255",
        "value = {c|srgb(srgb(c))} * 255",
        |v, more| {
            use crate::mistakes::bugs::OutputBug;
            v.output = if more == 0.0 { OutputBug::MissingCurve(0.0) } else { OutputBug::ExtraCurve(0.0) };
        },
    )
    .with(Values::Only(&[0.0, 1.0])),
    row(
        "path-factor",
        "bounces",
        "the whole picture is {} times as bright as it should be",
        "L",
        "{} * L",
        |v, factor| {
            use crate::mistakes::bugs::OutputBug;
            v.output = OutputBug::Times(factor);
        },
    )
    .with(Values::Only(&[0.5, 2.0, std::f32::consts::PI, std::f32::consts::FRAC_1_PI])),
];
