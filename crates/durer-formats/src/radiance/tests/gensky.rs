//! Tests of the output of `gensky` and `gendaylit`.

use super::*;
use crate::radiance::args::RadPrimitive;
use crate::radiance::gensky;
use crate::radiance::sky::Sky;
use crate::radiance::words::{Word, Words};
use crate::shared_report::SharedReport;
use durer_scene::light::Light;
use glam::{DMat3, DVec3};

fn words(text: &str) -> Vec<Word> {
    let mut words = Words::new(text.as_bytes(), 0, 0..text.len());
    std::iter::from_fn(|| words.next()).collect()
}

/// Returns the radiance of the sun and the arguments of the sky.
fn printed(args: &str) -> (f64, Vec<f64>) {
    let (report, words) = (SharedReport::default(), words(&format!("gensky {args}")));
    let text = gensky::text(&report, &words[0], &words[1..]).unwrap_or_else(|| panic!("{args}"));
    let words: Vec<&str> = text.split_whitespace().collect();
    let after = |word: &str, skip: usize| {
        let at = words.iter().position(|other| *other == word);
        at.map_or(Vec::new(), |at| words[at + 1 + skip..].iter().map_while(|word| word.parse().ok()).collect())
    };
    let sun: Vec<f64> = after("solar", 2);
    (sun.get(1).copied().unwrap_or(0.0), after("skybright.cal", 2))
}

#[test]
fn output_matches_radiance_6_0() {
    let cases: [(&str, f64, &[f64]); 11] = [
        ("6 21 12 +s -a 42.3 -o 71 -m 75", 7.150e6, &[1.0, 24.09, 29.14, 1.368, -0.058393, -0.321824, 0.944997]),
        ("6 21 12:30EDT +i -a 42.3 -o 71 -g .3", 1.072e6, &[4.0, 32.35, 10.91, 1.107, 0.061608, -0.321682, 0.944841]),
        ("-ang 30 20 -u", 0.0, &[3.0, 21.79, 4.358]),
        ("6 21 12 -c -B 55", 0.0, &[2.0, 22.51, 3.501]),
        ("6 21 +9 -s", 0.0, &[1.0, 10.77, 22.85, 0.6427, 0.648701, -0.083341, 0.756467]),
        // If a year is given, both programs use a more accurate formula.
        ("2 28 12 -y 2011 +s", 6.747e6, &[1.0, 9.316, 20.86, 0.5563, 0.089294, -0.712975, 0.695481]),
        ("9 1 8.25 -i -t 4 -b 20", 0.0, &[4.0, 20.0, 6.981, 1.042, 0.843806, -0.21235, 0.492848]),
        // The sun is too close to the zenith for the formula.
        ("6 21 12 +s -a 23 -o 0 -m 0", 7.210e6, &[1.0, 148.6, 37.99, 2.714, 0.030374, 0.04262, 0.99863]),
        (
            "12 24 14.5 +s -R 100 -a -33.9 -o -151.2 -m -150",
            2.056e6,
            &[1.0, 12.63, 9.432, 0.7564, -0.577763, 0.067807, 0.813383],
        ),
        ("3 3 17:05CET -a 48 -o -16 -r 1e6", 1e6, &[1.0, 2.512, 1.459, 0.2818, -0.953988, -0.28813, 0.082998]),
        // At night.
        ("6 21 22", 0.0, &[1.0, 0.0, 0.0, 0.274, -0.491441, 0.78935, -0.367983]),
    ];
    for (args, sun, sky) in cases {
        let (found_sun, found) = printed(args);
        assert!((found_sun - sun).abs() <= 1e-3 * sun, "{args}: {found_sun}, not {sun}");
        let near = |(a, b): (&f64, &f64)| (a - b).abs() < 2e-3 * b.abs().max(0.3);
        assert!(found.len() == sky.len() && found.iter().zip(sky).all(near), "{args}: {found:?}, not {sky:?}");
    }
}

#[test]
fn command_gives_the_sky_of_its_output() {
    let glow = "skyfunc glow g 0 0 4 1 1 1 0 g source s 0 0 4 0 0 1 180\n";
    let sun = |text: &str| {
        let scene = clean(text);
        let [light] = &scene.lights.as_ref().unwrap()[..] else { panic!("one light") };
        let Light::Directional(light) = light.value.clone() else { panic!("a sun") };
        assert!(scene.background.environment.is_some());
        light.direction
    };
    let still = sun(&format!("!gensky 6 21 12 +s -a 42.3 -o 71 -m 75\n{glow}"));
    assert!((still - Vec3::new(0.058393, 0.321824, -0.944997)).length() < 1e-4, "{still}");
    // The output is rotated by the `xform` into which it is piped.
    let turned = sun(&format!("!gensky 6 21 12 +s -a 42.3 -o 71 -m 75 | xform -rz 90\n{glow}"));
    assert!((turned - Vec3::new(-0.321824, 0.058393, -0.944997)).length() < 1e-4, "{turned}");
}

#[test]
fn sun_below_the_horizon_is_a_warning() {
    let glow = "skyfunc glow g 0 0 4 1 1 1 0 g source s 0 0 4 0 0 1 180\n";
    let (scene, found) = read(&format!("!gensky 12 21 22 -a 48 -o -11 -m -15\n{glow}void sphere s 0 0 4 0 0 0 1\n"));
    let scene = scene.unwrap();
    assert!(scene.background.environment.is_none());
    let expected = "1:15 warning the sun is 54.0 degrees below the horizon (use a time between sunrise and sunset; for \
                    night, add lights)";
    assert!(found.iter().any(|line| line.ends_with(expected)), "{found:?}");
    // With a given zenith, there is light at night.
    let (scene, found) = read(&format!("!gensky 12 21 22 -b 1\n{glow}void sphere s 0 0 4 0 0 0 1\n"));
    assert!(scene.unwrap().background.environment.is_some());
    assert!(!found.iter().any(|line| line.contains("below the horizon")), "{found:?}");
}

#[test]
fn errors_have_positions() {
    for (text, expected) in [
        ("!gensky 6 21", "1:2 error `gensky` needs month, day and hour, or `-ang` with altitude and azimuth"),
        ("!gensky 13 21 12", "1:9 error the month must be from 1 to 12"),
        ("!gensky 6 21 25", "1:14 error the hour must be of the form 14.5, 14:30, 14:30EST or, in solar time, +14.5"),
        (
            "!gensky 6 21 12:75",
            "1:14 error the hour must be of the form 14.5, 14:30, 14:30EST or, in solar time, +14.5",
        ),
        ("!gensky 6 21 12 -q", "1:17 error `gensky` has no option `-q`"),
        ("!gensky 6 21 12 -a", "1:17 error `-a` needs a number"),
        ("!gensky 6 21 12 -a north", "1:20 error expected a number, found `north`"),
    ] {
        let (scene, found) = read(text);
        assert!(scene.is_none() && found == [format!("scene.rad:{expected}")], "{text}: {found:?}");
    }
    let (_, found) = read("!gensky 6 21 12:30XYZ");
    assert!(
        found[0].starts_with("scene.rad:1:14 error unknown time zone in `12:30XYZ`: known zones are YST"),
        "{found:?}"
    );
}

#[test]
fn perez_sky_matches_rtrace() {
    let text =
        "void brightfunc f 2 skybright perezlum.cal 0 10 37.1 29.99 -0.953158 -0.216935 17.406817 -3.934951 0.685099
        -0.058393 -0.321824 0.944997";
    let (report, mut all) = (SharedReport::default(), Words::new(text.as_bytes(), 0, 0..text.len()));
    let primitive = RadPrimitive::read(all.next().unwrap(), &mut all, &report).unwrap();
    let sky = Sky::perez(&primitive, DMat3::IDENTITY, &report).unwrap();
    let ways = [[0.0, 0.0, 1.0], [0.6, 0.772, 0.1736], [0.8, 0.0, -0.05], [0.3, -0.9, -0.3]];
    for (way, expected) in ways.into_iter().zip([54.42088, 27.81774, 32.10053, 29.99851]) {
        let found = sky.at(DVec3::from_array(way).normalize());
        assert!((found / expected - 1.0).abs() < 1e-3, "{way:?}: {found}, not {expected}");
    }
    // The output is used as a pattern in a scene.
    let scene = clean(&format!("{text}\nf glow g 0 0 4 1 1 1 0 g source s 0 0 4 0 0 1 180"));
    assert!(scene.background.environment.is_some());
}
