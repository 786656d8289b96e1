//! Reader of EULUMDAT files (`.ldt`), which contain the light distributions of luminaires and are
//! common in Europe.
//!
//! A file has one value per line, in a fixed order: the type of the luminaire, the symmetry of its
//! half-planes, its light sources and their flux, the angles, and the intensities in candela per
//! 1000 lumens of that flux.
//!
//! Source: A. W. Stockmar, *EULUMDAT: ein Leuchtendatenformat für den europäischen
//! Beleuchtungsplaner*, Licht '90; the order of the lines follows the descriptions that Paul Bourke
//! and Lighting Sciences have published.

use super::Luminaire;
use durer_diag::{Diagnostic, Diagnostics, Severity, Span};
use durer_scene::light::photometric::{PhotometricProfile, ProfileKind};

/// Limits of the format: the number of half-planes, and the number of angles in each of them.
const MAX_PLANES: usize = 721;
const MAX_ANGLES: usize = 361;

/// Symmetry of a EULUMDAT light distribution, which determines which half-planes the file lists.
#[derive(Clone, Copy)]
enum Symmetry {
    None,
    /// Rotational symmetry, which makes all half-planes equal.
    Axis,
    /// Mirror symmetry about the plane through C = 0 and 180 degrees.
    C0,
    /// Mirror symmetry about the plane through C = 90 and 270 degrees.
    C90,
    /// Mirror symmetry about both of these planes.
    Both,
}

/// Cursor that reads the lines of a EULUMDAT file.
struct Lines<'t> {
    text: &'t str,
    at: usize,
    file: u32,
}

type LdtResult<T> = Result<T, Box<Diagnostic>>;

impl<'t> Lines<'t> {
    fn error(&self, start: usize, end: usize, message: impl Into<String>) -> Box<Diagnostic> {
        let span = Span { file: self.file, start: start as u32, end: end.max(start) as u32 };
        Box::new(Diagnostic::error(message).code("bad-file").at(span))
    }

    /// Returns the next line without surrounding whitespace, and the offset of the line.
    fn next(&mut self, what: &str) -> LdtResult<(&'t str, usize)> {
        if self.at >= self.text.len() {
            return Err(self.error(self.at, self.at, format!("the file ends where the {what} should be")));
        }
        let rest = &self.text[self.at..];
        let line = rest.split_inclusive('\n').next().unwrap_or("");
        let start = self.at + (line.len() - line.trim_start().len());
        self.at += line.len();
        Ok((line.trim(), start))
    }

    fn skip(&mut self, lines: usize, what: &str) -> LdtResult<()> {
        (0..lines).try_for_each(|_| self.next(what).map(drop))
    }

    /// Reads a number, in which the decimal separator may be a comma.
    fn number(&mut self, what: &str) -> LdtResult<(f64, usize, usize)> {
        let (line, start) = self.next(what)?;
        let end = start + line.len();
        match line.replace(',', ".").parse::<f64>() {
            Ok(number) if number.is_finite() => Ok((number, start, end)),
            _ => Err(self.error(start, end, format!("expected the {what}, found `{line}`"))),
        }
    }

    fn integer(&mut self, what: &str, from: usize, to: usize) -> LdtResult<usize> {
        let (number, start, end) = self.number(what)?;
        match number.fract() == 0.0 && (from as f64..=to as f64).contains(&number) {
            true => Ok(number as usize),
            false => Err(self.error(start, end, format!("the {what} must be a whole number from {from} to {to}"))),
        }
    }

    fn not_negative(&mut self, what: &str) -> LdtResult<f64> {
        let (number, start, end) = self.number(what)?;
        if number < 0.0 {
            return Err(self.error(start, end, format!("the {what} must not be less than 0")));
        }
        Ok(number)
    }

    /// Reads angles from 0 to `most` degrees, in ascending order.
    fn angles(&mut self, count: usize, what: &str, most: f64) -> LdtResult<Vec<f32>> {
        let mut angles: Vec<f32> = Vec::with_capacity(count);
        for _ in 0..count {
            let (angle, start, end) = self.number(what)?;
            if angles.last().is_some_and(|last| angle as f32 <= *last) {
                return Err(self.error(start, end, format!("the {what}s must be in ascending order")));
            }
            if !(0.0..=most).contains(&angle) {
                return Err(self.error(start, end, format!("a {what} must lie between 0 and {most} degrees")));
            }
            angles.push(angle as f32);
        }
        Ok(angles)
    }
}

/// Returns true if a text begins like a EULUMDAT file: its second and third lines, the type of the
/// luminaire and its symmetry, are integers.
pub(super) fn recognise(text: &str) -> bool {
    let mut lines = text.lines().map(str::trim).skip(1);
    let mut is_whole = || lines.next().is_some_and(|line| line.parse::<u32>().is_ok());
    is_whole() && is_whole()
}

/// Reads a EULUMDAT file. If there are errors, adds them to the diagnostics and returns `None`.
pub fn read(text: &str, file: u32, diagnostics: &mut Diagnostics) -> Option<Luminaire> {
    parse(text, file, diagnostics).map_err(|error| diagnostics.push(*error)).ok()
}

fn parse(text: &str, file: u32, diagnostics: &mut Diagnostics) -> LdtResult<Luminaire> {
    let mut lines = Lines { text, at: 0, file };
    let mut names = vec![("manufacturer", lines.next("manufacturer")?.0.to_string())];
    lines.skip(1, "file type")?;
    let symmetry = match lines.integer("symmetry", 0, 4)? {
        0 => Symmetry::None,
        1 => Symmetry::Axis,
        2 => Symmetry::C0,
        3 => Symmetry::C90,
        _ => Symmetry::Both,
    };
    let count = lines.integer("number of C planes", 1, MAX_PLANES)?;
    lines.skip(1, "distance between C planes")?;
    let verticals = lines.integer("number of intensities in each plane", 1, MAX_ANGLES)?;
    lines.skip(1, "distance between intensities")?;
    lines.skip(1, "number of the report")?;
    names.push(("luminaire", lines.next("luminaire name")?.0.to_string()));
    names.push(("catalogue", lines.next("luminaire number")?.0.to_string()));
    lines.skip(2, "file name and date")?;
    lines.skip(9, "size of the luminaire")?;
    lines.skip(2, "downward flux and light output ratio")?;
    let factor = lines.not_negative("conversion factor")?;
    lines.skip(1, "tilt")?;
    let sets = lines.integer("number of sets of light sources", 1, 20)?;
    // The sets of light sources are alternatives, so use the first one.
    lines.skip(1, "number of the light sources")?;
    names.push(("lamp", lines.next("type of the light sources")?.0.to_string()));
    let flux = lines.not_negative("flux of the light sources")?;
    lines.skip(2, "colour of the light sources")?;
    // The number is not needed for the light, so text is accepted.
    let watts = lines.next("watts of the light sources")?.0.replace(',', ".").parse::<f64>().ok();
    lines.skip(6 * (sets - 1), "other sets of light sources")?;
    lines.skip(10, "direct ratios")?;
    let around = lines.at;
    let planes = lines.angles(count, "C angle", 360.0)?;
    let angles = around..lines.at;
    let vertical = lines.angles(verticals, "gamma angle", 180.0)?;
    let horizontal = lines.select_planes(symmetry, planes, angles.clone())?;
    let scale = factor * flux / 1000.0;
    let all = horizontal.len() * verticals;
    let mut candela = Vec::with_capacity(all);
    for i in 0..all {
        let value = lines.not_negative(&format!("intensity number {} of {all}", i + 1))?;
        let value = (scale * value) as f32;
        if !value.is_finite() {
            return Err(lines.error(
                lines.at,
                lines.at,
                "the candela value exceeds the range of 32-bit floating point",
            ));
        }
        candela.push(value);
    }
    let mut profile = PhotometricProfile { kind: ProfileKind::C, vertical, horizontal, candela };
    match symmetry {
        // Close the circle by repeating the first half-plane.
        Symmetry::None if count > 1 && profile.horizontal[count - 1] < 360.0 => {
            profile.horizontal.push(360.0);
            profile.candela.extend_from_within(..verticals);
        }
        // For this symmetry, EULUMDAT files list the half-planes from C = 270 through 0 to 90
        // degrees, whereas profiles list those from 90 to 270 degrees, as IES files do.
        Symmetry::C90 => mirror_half(&mut profile),
        _ => {}
    }
    if profile.candela.iter().all(|candela| *candela == 0.0) {
        let error = lines.error(
            angles.start,
            angles.end,
            "this luminaire emits no light, because its flux or all its intensities are 0",
        );
        diagnostics.push(Diagnostic { severity: Severity::Warning, code: "black-light", ..*error });
    }
    names.retain(|(_, name)| !name.is_empty());
    Ok(Luminaire {
        profile,
        format: "EULUMDAT",
        watts: watts.filter(|watts| watts.is_finite() && *watts > 0.0),
        source_flux: Some(flux).filter(|flux| *flux > 0.0),
        names,
    })
}

impl Lines<'_> {
    /// Selects the half-planes for which the file contains intensities.
    fn select_planes(&self, symmetry: Symmetry, planes: Vec<f32>, at: std::ops::Range<usize>) -> LdtResult<Vec<f32>> {
        let within = |from: f32, to: f32| planes.iter().copied().filter(|c| (from..=to).contains(c)).collect();
        let (kept, ends): (Vec<f32>, _) = match symmetry {
            Symmetry::Axis => return Ok(planes[..1].to_vec()),
            Symmetry::None => (planes, [0.0, f32::NAN]),
            Symmetry::C0 => (within(0.0, 180.0), [0.0, 180.0]),
            Symmetry::C90 => {
                // The half-planes are listed from 270 to 360 degrees, and then from 0 to 90
                // degrees.
                let below = planes.iter().filter(|c| **c >= 270.0 && **c < 360.0).map(|c| c - 360.0);
                (below.chain(within(0.0, 90.0)).collect(), [-90.0, 90.0])
            }
            Symmetry::Both => (within(0.0, 90.0), [0.0, 90.0]),
        };
        // Without symmetry, the last half-plane may be at any angle.
        let [first, last] = ends;
        if kept.first() == Some(&first) && (last.is_nan() || kept.last() == Some(&last)) {
            return Ok(kept);
        }
        let first = if first < 0.0 { first + 360.0 } else { first };
        let named =
            if last.is_nan() { format!("a C plane at {first}") } else { format!("C planes at {first} and {last}") };
        Err(self.error(at.start, at.end, format!("for this symmetry, the file must have {named} degrees")))
    }
}

/// Replaces the half-planes between -90 and 90 degrees with their mirror images between 90 and 270
/// degrees.
fn mirror_half(profile: &mut PhotometricProfile) {
    let verticals = profile.vertical.len();
    profile.horizontal = profile.horizontal.iter().rev().map(|c| 180.0 - c).collect();
    profile.candela = profile.candela.chunks(verticals).rev().flatten().copied().collect();
}

#[cfg(test)]
mod tests {
    use super::*;
    use durer_diag::Files;
    use durer_scene::math::{Vec3, fp};

    /// Returns a test file with the given symmetry, number of half-planes around the circle, and
    /// flux. Its intensities are a function of C and gamma. The file contains only the half-planes
    /// in `written`.
    fn file(symmetry: u32, count: usize, flux: &str, written: &[f64], value: impl Fn(f64, f64) -> f64) -> String {
        let gammas: Vec<f64> = (0..=36).map(|i| 5.0 * f64::from(i)).collect();
        let planes = (0..count).map(|i| 360.0 / count as f64 * i as f64);
        let mut lines = vec!["Maker".to_string(), "1".into(), symmetry.to_string(), count.to_string()];
        lines.push((360.0 / count as f64).to_string());
        lines.extend(["37", "5", "No. 7", "Lamp", "7", "lamp.ldt", "2026-11-26"].map(String::from));
        lines.extend((0..9).map(|i| (100 * i).to_string()));
        lines.extend(["50", "80,5", "1.0", "0", "1", "-1", "LED", flux, "3000", "80", "20"].map(String::from));
        lines.extend((0..10).map(|i| format!("0.{i}")));
        lines.extend(planes.chain(gammas.iter().copied()).map(|angle| angle.to_string()));
        lines.extend(
            written.iter().flat_map(|&c| gammas.iter().map(move |&g| (c, g))).map(|(c, g)| value(c, g).to_string()),
        );
        lines.join("\r\n") + "\r\n"
    }

    fn parsed(text: &str) -> Result<PhotometricProfile, String> {
        let mut files = Files::default();
        let file = files.add("lamp.ldt", text.as_bytes().into());
        let mut diagnostics = Diagnostics::default();
        let profile = super::super::read(text.as_bytes(), file, &mut diagnostics);
        let messages = diagnostics.iter().next().map(|messages| {
            let (line, column) = files.position(messages.span.unwrap()).unwrap();
            format!("{line}:{column} {}", messages.message) // prose: keep
        });
        match (profile, messages) {
            (Some(profile), None) => Ok(profile),
            (_, messages) => Err(messages.unwrap()),
        }
    }

    #[test]
    fn every_symmetry_fills_the_circle() {
        // The values are in candela per 1000 lumens, and the flux is 2000 lumens. Each function has
        // the symmetry that is named in its row.
        let cos = |degrees: f64| fp::sin_cos_degrees(degrees).1;
        let sin = |degrees: f64| fp::sin_cos_degrees(degrees).0;
        let all: Vec<f64> = (0..24).map(|i| 15.0 * f64::from(i)).collect();
        let some = |from: usize, to: usize| all[from..=to].to_vec();
        let right = [some(18, 23), some(0, 6)].concat();
        type Value = fn(f64, f64) -> f64;
        let cases: [(u32, Vec<f64>, Value); 5] = [
            (0, all.clone(), |x, y| 90.0 + 20.0 * x + 30.0 * y),
            (1, vec![0.0], |_, _| 90.0),
            (2, some(0, 12), |x, _| 90.0 + 20.0 * x),
            (3, right, |_, y| 90.0 + 30.0 * y),
            (4, some(0, 6), |x, y| 90.0 + 20.0 * x * x + 30.0 * y * y),
        ];
        for (symmetry, written, value) in cases {
            let text = file(symmetry, 24, "2000", &written, |c, g| value(cos(c), sin(c)) * (1.0 + cos(g)));
            let profile = parsed(&text).unwrap();
            for degrees in 0..72 {
                let c = 5.0 * f64::from(degrees);
                for g in [10.0, 60.0, 130.0] {
                    let flat = sin(g);
                    let dir = Vec3::new((flat * cos(c)) as f32, (flat * sin(c)) as f32, cos(g) as f32);
                    let expected = 2.0 * value(cos(c), sin(c)) * (1.0 + cos(g));
                    let found = f64::from(profile.at(dir));
                    // Values between the half-planes are interpolated linearly.
                    assert!(
                        (found - expected).abs() < 0.006 * expected,
                        "{symmetry}, {c}, {g}: {found}, not {expected}"
                    );
                }
            }
        }
    }

    #[test]
    fn flux_of_a_uniform_profile_is_four_pi_times_its_candela() {
        let even = parsed(&file(1, 1, "1000", &[0.0], |_, _| 100.0)).unwrap();
        assert!((even.flux() / (400.0 * std::f64::consts::PI) - 1.0).abs() < 1e-3, "{}", even.flux());
    }

    #[test]
    fn error_has_line_and_column() {
        let good = file(4, 4, "1000", &[0.0, 90.0], |_, _| 100.0);
        let line = |number: usize, with: &str| {
            let mut lines: Vec<&str> = good.lines().collect();
            lines[number - 1] = with;
            lines.join("\n")
        };
        assert!(parsed(&good).is_ok());
        for (text, expected) in [
            (line(3, "5"), "3:1 the symmetry must be a whole number from 0 to 4"),
            (line(4, "four"), "4:1 expected the number of C planes, found `four`"),
            (line(4, "1e9"), "4:1 the number of C planes must be a whole number from 1 to 721"),
            (line(24, "-1"), "24:1 the conversion factor must not be less than 0"),
            (line(29, "nan"), "29:1 expected the flux of the light sources, found `nan`"),
            (line(44, " 0"), "44:2 the C angles must be in ascending order"),
            (line(44, "80"), "43:1 for this symmetry, the file must have C planes at 0 and 90 degrees"),
            (line(29, "0"), "43:1 this luminaire emits no light, because its flux or all its intensities are 0"),
            (line(90, "-1"), "90:1 the intensity number 7 of 74 must not be less than 0"),
            (
                good.lines().take(100).collect::<Vec<_>>().join("\n"),
                "100:4 the file ends where the intensity number 18 of 74 should be",
            ),
        ] {
            assert_eq!(parsed(&text).unwrap_err(), expected);
        }
    }
}
