//! The table of the mistakes that path tracers can make.

use crate::mistakes::path_bugs::{
    CosinePower, DiffusePi, DirectionSampling, EnvironmentBug, MissingFactor, PixelMean, RefractionBug, RouletteBug,
    Strategies,
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
        "the cosine at the surface {is left out|counts twice|is left out in light samples|counts twice in light \
         samples|is left out in light samples|is left out for point and directional lights}",
        "{throughput *= f * dot(n, wi) / pdf|throughput *= f * dot(n, wi) / pdf|L += f * dot(n, wi) * Le / pdf|L += f * \
         dot(n, wi) * Le / pdf|L += f * dot(n, wi) * Le / pdf|L += f * dot(n, wi) * I}",
        "{throughput *= f / pdf|throughput *= f * dot(n, wi) * dot(n, wi) / pdf|L += f * Le / pdf|L += f * dot(n, wi) * \
         dot(n, wi) * Le / pdf|L += f * Le / pdf|L += f * I}",
        |v, how| {
            v.paths.cosine_power = [
                CosinePower::None,
                CosinePower::Twice,
                CosinePower::NoneForLights,
                CosinePower::TwiceForLights,
                CosinePower::NoneForLights,
                CosinePower::NoneForPoints,
            ][(how as usize).min(5)];
            if how == 4.0 {
                v.paths.strategies = Strategies::LightSamples;
            }
        },
    )
    .with(Values::Only(&[0.0, 1.0, 2.0, 3.0, 4.0, 5.0])),
    row(
        "path-no-pi",
        "bounces",
        "the diffuse BSDF lacks the factor 1/pi{|, but only for light samples|, but only for scattered light}",
        "f = albedo / pi",
        "f = albedo",
        |v, how| {
            const ALL: [DiffusePi; 3] = [DiffusePi::Missing, DiffusePi::MissingForLights, DiffusePi::MissingForScattered];
            v.paths.diffuse_pi = ALL[(how as usize).min(2)];
        },
    )
    .with(Values::Only(&[0.0, 1.0, 2.0])),
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
        "scattered directions are {not transformed from the shading frame to world space|not transformed from the shading \
         frame to world space, and paths end at those below the surface|distributed about the y axis of the world, not the \
         normal|distributed about the y axis of the world, not the normal, and paths end at those below the surface}",
        "wi = x t + y b + z n",
        "wi = {(x, y, z)|(x, y, z)|(x, z, y)|(x, z, y)}",
        |v, how| {
            v.paths.direction_sampling = [
                DirectionSampling::LocalFrame,
                DirectionSampling::LocalFrameAbove,
                DirectionSampling::AboutY,
                DirectionSampling::AboutYAbove,
            ][(how as usize).min(3)];
        },
    )
    .with(Values::Only(&[0.0, 1.0, 2.0, 3.0])),
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
        |v, _| v.paths.strategies = Strategies::Unweighted,
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
        "refracted directions {use the inverted ratio of the indices|are bent to the wrong side|are not bent|have the wrong \
         sign of the root}",
        "wi = -eta wo + (eta cos1 - cos2) n, eta = n1 / n2",
        "{eta = n2 / n1|wi = +eta wo + ...|wi = -wo|wi = -eta wo + (eta cos1 + cos2) n}",
        |v, how| {
            const ALL: [RefractionBug; 4] = [
                RefractionBug::Inverted,
                RefractionBug::Flipped,
                RefractionBug::Straight,
                RefractionBug::RootSign,
            ];
            v.paths.refraction = ALL[(how as usize).min(3)];
        },
    )
    .with(Values::Only(&[0.0, 1.0, 2.0, 3.0])),
    row(
        "path-index",
        "refraction",
        "the index of refraction is inverted, both in refracted directions and in Fresnel's equations",
        "n1 outside, n2 inside; exchanged when leaving",
        "n2 outside, n1 inside",
        |v, _| v.paths.refraction = RefractionBug::Exchanged,
    ),
    row(
        "path-fresnel",
        "fresnel",
        "glass {chooses between reflection and refraction with probability 1/2, but does not divide by it|weights \
         reflection and refraction by the fraction with which they were already chosen|reflects nothing}",
        "if (random() < F) reflect, else refract; weight 1",
        "{if (random() < 1/2) reflect with weight F, else refract with weight 1 - F|if (random() < F) reflect with weight F, \
         else refract with weight 1 - F|refract}",
        |v, how| {
            const ALL: [RefractionBug; 3] =
                [RefractionBug::HalfChosen, RefractionBug::FresnelTwice, RefractionBug::NoReflection];
            v.paths.refraction = ALL[(how as usize).min(2)];
        },
    )
    .with(Values::Only(&[0.0, 1.0, 2.0])),
    row(
        "path-mirror-color",
        "reflection",
        "mirrors do not colour the light",
        "throughput *= kr",
        "(nothing)",
        |v, _| v.paths.colorless_mirrors = true,
    ),
    row(
        "path-emission-after-mirror",
        "mis",
        "lights are black in mirrors and behind glass: their emission is not added after mirrors and glass",
        "L += throughput * Le at the first hit and after mirrors and glass",
        "L += throughput * Le at the first hit only",
        |v, _| v.paths.no_emission_after_delta = true,
    ),
    row(
        "path-texture-flipped",
        "flat",
        "textures are upside down",
        "y = (1 - v) height",
        "y = v height",
        |v, _| v.paths.flipped_textures = true,
    ),
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
        "light samples {lack 1 / d^2|lack the cosine at the light|lack the area of the light|lack the division by the \
         probability of choosing the light|lack the division by the probability of choosing the light|have 1 / d instead of 1 \
         / d^2|of point and directional lights lack the factor pi|lack 1 / d^2|have 1 / d instead of 1 / d^2}",
        "L = f cos(n) {Le|Le|Le|Le|Le|Le|pi Le|Le|Le} cos(light) area / (d^2 probability)",
        "L = f cos(n) Le {cos(light) area / probability|area / (d^2 probability)|cos(light) / (d^2 probability)|cos(light) \
         area / d^2|cos(light) area / d^2|cos(light) area / (d probability)|cos(light) area / (d^2 probability)|cos(light) \
         area / probability|cos(light) area / (d probability)}",
        |v, how| {
            v.paths.missing_factor = [
                MissingFactor::Distance,
                MissingFactor::Cosine,
                MissingFactor::Area,
                MissingFactor::Choice,
                MissingFactor::UniformChoice,
                MissingFactor::DistanceOnce,
                MissingFactor::PointPi,
                MissingFactor::Distance,
                MissingFactor::DistanceOnce,
            ][(how as usize).min(8)];
            if how >= 7.0 {
                v.paths.strategies = Strategies::LightSamples;
            }
        },
    )
    .with(Values::Only(&[0.0, 1.0, 2.0, 3.0, 4.0, 5.0, 6.0, 7.0, 8.0])),
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
        "the environment is {upside down|sampled with a pdf that lacks sin(theta)|mirrored left to right|turned by half a \
         turn|sampled with a pdf that lacks sin(theta)}",
        "theta from the top, phi = atan2(x, -z), pdf = p(u, v) / (2 pi^2 sin(theta))",
        "{theta from the bottom|pdf = p(u, v) / (2 pi^2)|phi = atan2(-x, -z)|phi = atan2(-x, z)|pdf = p(u, v) / (2 pi^2)}",
        |v, how| {
            v.paths.environment = [
                EnvironmentBug::UpsideDown,
                EnvironmentBug::NoSine,
                EnvironmentBug::Mirrored,
                EnvironmentBug::HalfTurned,
                EnvironmentBug::NoSine,
            ][(how as usize).min(4)];
            if how == 4.0 {
                v.paths.strategies = Strategies::LightSamples;
            }
        },
    )
    .with(Values::Only(&[0.0, 1.0, 2.0, 3.0, 4.0])),
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
