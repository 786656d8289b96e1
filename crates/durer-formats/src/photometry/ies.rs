//! Reader and writer of IES files, which contain the light distributions of luminaires, according
//! to ANSI/IES LM-63, versions 1986 to 2019.
//!
//! A file begins with lines of text, the last of which starts with `TILT=`. The lines are followed
//! by numbers: the number of angles of each kind, the angles, and the candela values.

use super::Luminaire;
use durer_diag::{Diagnostic, Diagnostics, Severity, Span};
use durer_scene::light::photometric::{PhotometricProfile, ProfileKind};

/// Maximum number of angles, which is more than any photometer measures.
const MAX_ANGLES: f64 = 4_000.0;

/// Cursor that reads the numbers of an IES file.
struct Numbers<'t> {
    text: &'t str,
    at: usize,
    file: u32,
}

impl Numbers<'_> {
    fn error(&self, start: usize, end: usize, message: impl Into<String>) -> Box<Diagnostic> {
        let span = Span { file: self.file, start: start as u32, end: end.max(start) as u32 };
        Box::new(Diagnostic::error(message).code("bad-file").at(span))
    }

    /// Reads the next number; `what` is its name in error messages. Some files in circulation use
    /// commas as well to separate numbers.
    fn next(&mut self, what: &str) -> Result<(f64, usize), Box<Diagnostic>> {
        let rest = &self.text[self.at..];
        let between = |c: char| c.is_whitespace() || c == ',';
        let start = self.at + rest.find(|c| !between(c)).unwrap_or(rest.len());
        let word = self.text[start..].split(between).next().unwrap_or("");
        let end = start + word.len();
        if word.is_empty() {
            return Err(self.error(start, start, format!("the file ends where the {what} should be")));
        }
        self.at = end;
        match word.parse::<f64>() {
            Ok(number) if number.is_finite() => Ok((number, start)),
            _ => Err(self.error(start, end, format!("expected the {what}, found `{word}`"))),
        }
    }

    fn count(&mut self, what: &str) -> Result<usize, Box<Diagnostic>> {
        let (number, start) = self.next(what)?;
        match (1.0..=MAX_ANGLES).contains(&number) && number.fract() == 0.0 {
            true => Ok(number as usize),
            false => {
                Err(self.error(start, self.at, format!("the {what} must be a whole number from 1 to {MAX_ANGLES}")))
            }
        }
    }

    /// Reads a factor that must not be negative, and returns it with its start.
    fn factor(&mut self, what: &str) -> Result<(f64, usize), Box<Diagnostic>> {
        let (number, start) = self.next(what)?;
        match number >= 0.0 {
            true => Ok((number, start)),
            false => Err(self.error(start, self.at, format!("the {what} must not be less than 0"))),
        }
    }

    /// Reads angles from -360 to 360 degrees, in ascending order.
    fn angles(&mut self, count: usize, what: &str) -> Result<Vec<f32>, Box<Diagnostic>> {
        let mut angles: Vec<f32> = Vec::with_capacity(count);
        for _ in 0..count {
            let (angle, start) = self.next(what)?;
            if angles.last().is_some_and(|last| angle as f32 <= *last) {
                let error = self.error(start, self.at, format!("the {what}s must be in ascending order"));
                let help = format!("the header declares {count} {what}s: check the number, and that the file has all");
                return Err(Box::new((*error).help(help)));
            }
            if angle.abs() > 360.0 {
                return Err(self.error(start, self.at, format!("a {what} must lie between -360 and 360 degrees")));
            }
            angles.push(angle as f32);
        }
        Ok(angles)
    }
}

/// Reads an IES file. If there are errors, adds them to the diagnostics and returns `None`.
pub fn read(text: &str, file: u32, diagnostics: &mut Diagnostics) -> Option<Luminaire> {
    let (luminaire, odd) = parse(text, file).map_err(|error| diagnostics.push(*error)).ok()?;
    odd.into_iter().for_each(|warning| diagnostics.push(warning));
    Some(luminaire)
}

/// Returns the names in the keyword lines before `TILT=`, such as `[MANUFAC] Name`.
fn names(text: &str) -> Vec<(&'static str, String)> {
    const KEYWORDS: [(&str, &str); 4] =
        [("[MANUFAC]", "manufacturer"), ("[LUMCAT]", "catalogue"), ("[LUMINAIRE]", "luminaire"), ("[LAMP]", "lamp")];
    let head = text.lines().take_while(|line| !line.trim().starts_with("TILT="));
    let name = |line: &str| {
        let (keyword, what) = KEYWORDS.iter().find(|(keyword, _)| line.trim().starts_with(keyword))?;
        let name = line.trim()[keyword.len()..].trim().to_string();
        (!name.is_empty()).then_some((*what, name))
    };
    head.filter_map(name).collect()
}

fn parse(text: &str, file: u32) -> Result<(Luminaire, Vec<Diagnostic>), Box<Diagnostic>> {
    let mut numbers = Numbers { text, at: 0, file };
    let mut tilt = None;
    let mut place = 0;
    for line in text.split_inclusive('\n') {
        if let Some(what) = line.trim().strip_prefix("TILT=") {
            tilt = Some((what.trim().to_ascii_uppercase(), place));
            numbers.at = place + line.len();
            break;
        }
        place += line.len();
    }
    let Some((tilt, start)) = tilt else {
        return Err(numbers.error(
            0,
            text.lines().next().unwrap_or("").len(),
            "the file has no line `TILT=`, so it is not an IES or EULUMDAT file, or is damaged",
        ));
    };
    match tilt.as_str() {
        "NONE" => {}
        "INCLUDE" => {
            // Skip the factors for tilted luminaires, which have no effect when the luminaire is
            // mounted in its usual position.
            numbers.next("tilt geometry")?;
            let pairs = numbers.count("number of tilt angles")?;
            numbers.angles(pairs, "tilt angle")?;
            for _ in 0..pairs {
                numbers.next("tilt factor")?;
            }
        }
        other => {
            let message = format!("tilt data in another file (`{other}`) is not supported");
            return Err(Box::new(
                (*numbers.error(start, numbers.at, message))
                    .help("write `TILT=NONE`, which is equivalent for a luminaire in its usual position"),
            ));
        }
    }
    let (sources, _) = numbers.next("number of light sources")?;
    let (lumens, _) = numbers.next("lumens per light source")?;
    let (multiplier, start) = numbers.factor("multiplier")?;
    let multiplier_at = start..numbers.at;
    let verticals = numbers.count("number of vertical angles")?;
    let horizontals = numbers.count("number of horizontal angles")?;
    let (kind, kind_at) = numbers.next("photometric type")?;
    let kind = match kind as i64 {
        1 => ProfileKind::C,
        2 => ProfileKind::B,
        3 => ProfileKind::A,
        _ => return Err(numbers.error(kind_at, numbers.at, "the photometric type must be 1 (C), 2 (B) or 3 (A)")),
    };
    for what in ["units", "width", "length", "height"] {
        numbers.next(what)?;
    }
    let (ballast, _) = numbers.factor("ballast factor")?;
    // The standard of 1986 defines this number as a photometric factor. In later standards, this
    // number is reserved and always 1.
    let (reserved, _) = numbers.next("reserved number")?;
    let (watts, _) = numbers.next("watts")?;
    let vertical = numbers.angles(verticals, "vertical angle")?;
    let around = numbers.at + text[numbers.at..].find(|c: char| !c.is_whitespace()).unwrap_or(0);
    let mut horizontal = numbers.angles(horizontals, "horizontal angle")?;
    let angles = around..numbers.at;
    let scale = multiplier * ballast * if reserved > 0.0 { reserved } else { 1.0 };
    let mut candela = Vec::with_capacity(verticals * horizontals);
    for i in 0..verticals * horizontals {
        let what = format!("candela value {} of {}", i + 1, verticals * horizontals);
        let (value, start) = numbers.next(&what)?;
        if value < 0.0 {
            return Err(numbers.error(start, numbers.at, "a candela value must not be less than 0"));
        }
        let value = (scale * value) as f32;
        if !value.is_finite() {
            return Err(numbers.error(
                start,
                numbers.at,
                "the candela value exceeds the range of 32-bit floating point",
            ));
        }
        candela.push(value);
    }
    let more = numbers.next("end").ok().map(|(_, start)| start..numbers.at);
    let mut odd = Vec::new();
    let mut warn = |at: std::ops::Range<usize>, code: &'static str, message: &str| {
        let error = numbers.error(at.start, at.end, message);
        odd.push(Diagnostic { severity: Severity::Warning, code, ..*error });
    };
    let (first, last) = (horizontal[0], horizontal[horizontals - 1]);
    if kind == ProfileKind::C && horizontals > 1 && first == 0.0 && last > 180.0 && last < 360.0 {
        // The file does not define the remaining angles, so close the circle with the values of the
        // first angle.
        warn(
            angles.clone(),
            "bad-file",
            "the horizontal angles end before 360 degrees: the gap is interpolated linearly",
        );
        horizontal.push(360.0);
        candela.extend_from_within(..verticals);
    }
    if candela.iter().all(|candela| *candela == 0.0) {
        match multiplier == 0.0 {
            true => {
                let message = "this luminaire emits no light, because the multiplier of its candela values is 0";
                warn(multiplier_at, "black-light", message);
            }
            false if ballast == 0.0 => {
                warn(angles, "black-light", "this luminaire emits no light, because its ballast factor is 0");
            }
            false => {
                warn(angles, "black-light", "this luminaire emits no light, because all its candela values are 0");
            }
        }
    }
    if let Some(more) = more {
        warn(
            more,
            "bad-file",
            "more numbers follow the last candela value, for example because of decimal commas or missing angles",
        );
    }
    let luminaire = Luminaire {
        profile: PhotometricProfile { kind, vertical, horizontal, candela },
        format: "IES LM-63",
        watts: Some(watts).filter(|watts| *watts > 0.0),
        // The standard writes -1 for absolute photometry.
        source_flux: Some(sources * lumens).filter(|flux| *flux > 0.0),
        names: names(text),
    };
    Ok((luminaire, odd))
}

/// Encodes a profile as an IES file that reads back exactly, bit for bit.
pub fn write(profile: &PhotometricProfile) -> Vec<u8> {
    let PhotometricProfile { kind, vertical, horizontal, candela } = profile;
    let kind = match kind {
        ProfileKind::C => 1,
        ProfileKind::B => 2,
        ProfileKind::A => 3,
    };
    let mut text = String::from("IESNA:LM-63-2002\nTILT=NONE\n");
    text += &format!("1 -1 1 {} {} {kind} 2 0 0 0\n1 1 0\n", vertical.len(), horizontal.len());
    for values in [vertical, horizontal, candela] {
        // A line may have at most 256 characters.
        for line in values.chunks(10) {
            let words: Vec<String> = line.iter().map(f32::to_string).collect();
            text += &(words.join(" ") + "\n");
        }
    }
    text.into_bytes()
}

#[cfg(test)]
mod tests {
    use super::*;
    use durer_diag::Files;

    fn parsed(text: &str) -> Result<PhotometricProfile, String> {
        let mut files = Files::default();
        let file = files.add("lamp.ies", text.as_bytes().into());
        let mut diagnostics = Diagnostics::default();
        read(text, file, &mut diagnostics).map(|luminaire| luminaire.profile).ok_or_else(|| {
            let error = diagnostics.iter().next().unwrap();
            let (line, column) = files.position(error.span.unwrap()).unwrap();
            format!("{line}:{column} {}", error.message)
        })
    }

    #[test]
    fn flux_matches_closed_form() {
        // An intensity of 1000 cos(gamma) cd over the lower half gives a flux of 1000 pi lm. An
        // intensity of 100 cd in all directions gives 400 pi lm.
        let angles: Vec<f64> = (0..=36).map(|i| 2.5 * f64::from(i)).collect();
        let cosine: Vec<String> = angles.iter().map(|a| format!("{}", 1000.0 * fp_cos(*a))).collect();
        let angles: Vec<String> = angles.iter().map(f64::to_string).collect();
        let lambert = format!(
            "IESNA:LM-63-2002\nTILT=NONE\n1 -1 1 37 1 1 2 0 0 0\n1 1 60\n{}\n0\n{}\n",
            angles.join(" "),
            cosine.join(" ")
        );
        let flux = parsed(&lambert).unwrap().flux();
        assert!((flux / (1000.0 * std::f64::consts::PI) - 1.0).abs() < 2e-3, "{flux}");
        let even = "IESNA91\nTILT=NONE\n1 -1 2 3 1 1 2 0 0 0\n0.5 1 60\n0 90 180\n0\n100 100 100\n";
        let flux = parsed(even).unwrap().flux();
        assert!((flux / (400.0 * std::f64::consts::PI) - 1.0).abs() < 1e-3, "{flux}");
    }

    fn fp_cos(degrees: f64) -> f64 {
        durer_scene::math::fp::sin_cos_degrees(degrees).1
    }

    #[test]
    fn profile_round_trips_bit_for_bit() {
        let mut random = durer_scene::math::random::Random(7);
        for kind in [ProfileKind::A, ProfileKind::B, ProfileKind::C] {
            let rising = |count: usize| (0..count).map(|i| i as f32 * 90.0 / count as f32).collect::<Vec<_>>();
            let (vertical, horizontal) = (rising(23), rising(11));
            let candela = (0..23 * 11).map(|i| random.unit() * [1e-6, 0.1, 1.0, 2e3, 1e9][i % 5]).collect();
            let profile = PhotometricProfile { kind, vertical, horizontal, candela };
            let text = String::from_utf8(write(&profile)).unwrap();
            assert!(text.lines().all(|line| line.len() < 256));
            assert_eq!(parsed(&text).unwrap(), profile);
        }
    }

    #[test]
    fn warning_has_line_and_column() {
        for (text, expected) in [
            ("TILT=NONE\n1 1 1 2 1 1 2 0 0 0 1 1 1\n0 90\n0\n7 8\n9", "6:1 more numbers follow"),
            ("TILT=NONE\n1 1 1 2 1 1 2 0 0 0 1 1 1\n0 90\n0\n0 0", "4:1 this luminaire emits no light"),
            (
                "TILT=NONE\n1 1 1 2 3 1 2 0 0 0 1 1 1\n0 90\n0 90 270\n1 1 2 2 3 3",
                "4:1 the horizontal angles end before 360",
            ),
        ] {
            let mut files = Files::default();
            let file = files.add("lamp.ies", text.as_bytes().into());
            let mut diagnostics = Diagnostics::default();
            let profile = read(text, file, &mut diagnostics).unwrap().profile;
            let [warning] = &diagnostics.iter().collect::<Vec<_>>()[..] else { panic!("{text}: {diagnostics:?}") };
            let (line, column) = files.position(warning.span.unwrap()).unwrap();
            assert!(
                format!("{line}:{column} {}", warning.message).starts_with(expected), // prose: keep
                "{text}: {line}:{column} {warning:?}"
            );
            if expected.contains("360") {
                // The angle is halfway between 270 and 360 degrees.
                let (sin, cos) = durer_scene::math::fp::sin_cos_degrees(315.0);
                let dir = durer_scene::math::Vec3::new(cos as f32, sin as f32, 0.0);
                assert!((profile.at(dir) - 2.0).abs() < 1e-3, "{}", profile.at(dir));
            }
        }
    }

    #[test]
    fn symmetries_fill_the_circle() {
        let file = |horizontal: &str, values: &str, count: usize| {
            parsed(&format!("TILT=NONE\n1 1 1 2 {count} 1 2 0 0 0 1 1 1\n0 90\n{horizontal}\n{values}")).unwrap()
        };
        let at = |profile: &PhotometricProfile, degrees: f64| {
            let (sin, cos) = durer_scene::math::fp::sin_cos_degrees(degrees);
            profile.at(durer_scene::math::Vec3::new(cos as f32, sin as f32, 0.0))
        };
        let quadrant = file("0 90", "0 10 0 30", 2);
        for (degrees, value) in [(0.0, 10.0), (45.0, 20.0), (90.0, 30.0), (135.0, 20.0), (180.0, 10.0), (270.0, 30.0)] {
            assert!((at(&quadrant, degrees) - value).abs() < 1e-2, "{degrees}");
        }
        let half = file("0 90 180", "0 10 0 30 0 50", 3);
        assert!((at(&half, 270.0) - 30.0).abs() < 1e-2 && (at(&half, 179.9) - 50.0).abs() < 0.1);
        let across = file("90 180 270", "0 10 0 30 0 50", 3);
        assert!((at(&across, 0.0) - 30.0).abs() < 1e-2 && (at(&across, 45.0) - 20.0).abs() < 1e-2);
        let full = file("0 90 180 270 360", "0 1 0 2 0 3 0 4 0 1", 5);
        assert!((at(&full, 315.0) - 2.5).abs() < 1e-2);
    }

    #[test]
    fn error_has_line_and_column() {
        for (text, error) in [
            (
                "IESNA:LM-63-2002\n1 2 3\n",
                "1:1 the file has no line `TILT=`, so it is not an IES or EULUMDAT file, or is damaged",
            ),
            (
                "TILT=NONE\n1 1 1 3 1 1 2 0 0 0\n1 1 60\n0 90 45\n0\n1 2 3",
                "4:6 the vertical angles must be in ascending order",
            ),
            (
                "TILT=NONE\n1 1 1 3 1 1 2 0 0 0\n1 1 60\n0 45 90\n0\n1 2",
                "6:4 the file ends where the candela value 3 of 3 should be",
            ),
            ("TILT=NONE\n1 1 1 1e9 1 1 2", "2:7 the number of vertical angles must be a whole number from 1 to 4000"),
            ("TILT=lamp.tlt\n1 1", "1:1 tilt data in another file (`LAMP.TLT`) is not supported"), // prose: keep
            ("TILT=NONE\n1 x", "2:3 expected the lumens per light source, found `x`"),
            // Fuzzing found this case: the difference to the next angle is not finite.
            (
                "TILT=NONE\n1 1 1 2 1 1 2 0 0 0\n1 1 1\n-1e126 2\n0\n1 2",
                "4:1 a vertical angle must lie between -360 and 360 degrees",
            ),
            ("TILT=NONE\n1 1 -1 2", "2:5 the multiplier must not be less than 0"),
            ("TILT=NONE\n1 1 1 2 1 1 2 0 0 0\n-0.5", "3:1 the ballast factor must not be less than 0"),
            ("TILT=NONE\n1 1 1 2 1 7 2", "2:11 the photometric type must be 1 (C), 2 (B) or 3 (A)"),
        ] {
            assert_eq!(parsed(text).unwrap_err(), error);
        }
    }
}
