//! The table of mistakes of path tracers.

use crate::mistakes::path_habits::{Chosen, Lacks, Mean, Sky, Slant};
use crate::mistakes::table::{Mistake, Values, row};

pub const MISTAKES: &[Mistake] = &[
    row(
        "path-depth",
        "bounces",
        "paths {have one bounce less than asked for|have two bounces less than asked for|have one bounce more than asked for|stop at direct light|have one bounce, not as many as asked for}",
        "for (depth = 0; depth <= bounces; depth++)",
        "another end of the loop",
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
        |v, twice| v.paths.slant = if twice == 0.0 { Slant::None } else { Slant::Twice },
    )
    .with(Values::Only(&[0.0, 1.0])),
    row(
        "path-no-pi",
        "bounces",
        "the matte surface's value lacks 1/pi{|, for light samples alone}",
        "f = albedo / pi",
        "f = albedo",
        |v, lights| v.paths.no_pi = Some(lights > 0.0),
    )
    .with(Values::Only(&[0.0, 1.0])),
    row(
        "path-no-pdf",
        "mis",
        "{scattered light|the light of sampled lights} is not divided by the density",
        "throughput *= f * dot(n, wi) / pdf",
        "throughput *= f * dot(n, wi)",
        |v, lights| match lights == 0.0 {
            true => v.paths.chosen = Chosen::Undivided,
            false => v.paths.lacks = Lacks::Density,
        },
    )
    .with(Values::Only(&[0.0, 1.0])),
    row(
        "path-uniform",
        "bounces",
        "directions are uniform over the hemisphere, and divided by the density of the cosine",
        "uniform: pdf = 1 / (2 pi); by the cosine: pdf = cos / pi",
        "uniform directions with pdf = cos / pi",
        |v, _| v.paths.chosen = Chosen::Uniform,
    ),
    row(
        "path-local-frame",
        "bounces",
        "scattered directions are not turned from the surface's frame into the world",
        "wi = x t + y b + z n",
        "wi = (x, y, z)",
        |v, _| v.paths.chosen = Chosen::LocalFrame,
    ),
    row(
        "path-one-number",
        "bounces",
        "one random number is used for both dimensions of a direction",
        "u1 = random(), u2 = random()",
        "u1 = u2 = random()",
        |v, _| v.paths.chosen = Chosen::OneNumber,
    ),
    row(
        "path-emission-twice",
        "mis",
        "light is counted twice: by light samples and again where a scattered ray hits the light, without weights",
        "light sample: no emission at the next hit; or both with weights that sum to 1",
        "L += Le at every hit, and L += the light sample",
        |v, _| v.paths.unweighted = true,
    ),
    row(
        "path-roulette",
        "bounces",
        "what survives Russian roulette is not divided by its probability",
        "if (random() >= q) break; throughput /= q",
        "if (random() >= q) break",
        |v, _| v.paths.roulette = true,
    ),
    row(
        "path-light-factor",
        "mis",
        "a light sample lacks {1 / d^2|the cosine at the light|the area of the light|the division by the probability of the light}",
        "L = f cos(n) Le cos(light) area / (d^2 probability)",
        "L = f cos(n) Le {cos(light) area / probability|area / (d^2 probability)|cos(light) / (d^2 probability)|cos(light) area / d^2}",
        |v, how| {
            const ALL: [Lacks; 4] = [Lacks::Distance, Lacks::Cosine, Lacks::Area, Lacks::Choice];
            v.paths.lacks = ALL[(how as usize).min(3)];
        },
    )
    .with(Values::Only(&[0.0, 1.0, 2.0, 3.0])),
    row(
        "path-two-sided",
        "soft-shadows",
        "lights that shine to one side shine to both",
        "Le if dot(n_light, -wi) > 0, else 0",
        "Le",
        |v, _| v.paths.two_sided = true,
    ),
    row(
        "path-sky",
        "mis",
        "the environment is {upside down|sampled with a density that lacks sin(theta)}",
        "theta from the top, pdf = p(u, v) / (2 pi^2 sin(theta))",
        "{theta from the bottom|pdf = p(u, v) / (2 pi^2)}",
        |v, how| v.paths.sky = if how == 0.0 { Sky::UpsideDown } else { Sky::NoSine },
    )
    .with(Values::Only(&[0.0, 1.0])),
    row(
        "path-mean",
        "supersampling",
        "samples are {clamped to 1|encoded for the screen} before they are averaged",
        "encode(sum of samples / n)",
        "{encode(sum of min(1, sample) / n)|sum of encode(sample) / n}",
        |v, shown| v.paths.mean = if shown == 0.0 { Mean::Clamped } else { Mean::Shown },
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
        "the curve of sRGB is {missing|applied twice}",
        "value = srgb(c) * 255",
        "value = {c|srgb(srgb(c))} * 255",
        |v, more| {
            use crate::mistakes::bugs::OutputBug;
            v.output = if more == 0.0 { OutputBug::CurveLess(0.0) } else { OutputBug::CurveMore(0.0) };
        },
    )
    .with(Values::Only(&[0.0, 1.0])),
    row(
        "path-factor",
        "bounces",
        "the whole picture has {} times the light",
        "L",
        "{} * L",
        |v, factor| {
            use crate::mistakes::bugs::OutputBug;
            v.output = OutputBug::Times(factor);
        },
    )
    .with(Values::Only(&[0.5, 2.0, std::f32::consts::PI, std::f32::consts::FRAC_1_PI])),
];
