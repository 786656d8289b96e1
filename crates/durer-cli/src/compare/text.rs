//! Prints comparisons as text, CSV and JSON.

use super::args::CompareArgs;
use super::compared_pair::{ComparedPair, Outcome, name};
use super::mistakes;
use super::pixel_hit::PixelHit;
use crate::report::counted;
use crate::terminal::{print_error_line, print_line};
use durer::image::compare::{Region, Verdict};
use durer::report;
use serde_json::{Value, json};
use std::collections::BTreeMap;
use std::path::PathBuf;

/// Version of the JSON form. It increases if the meaning of a field changes or a field is removed.
const VERSION: u32 = 1;

/// Prints the comparison of a single pair.
pub fn single(compared: &ComparedPair, largest_allowed: f32) {
    let Outcome::Compared(comparison) = &compared.outcome else { return };
    let measures = &comparison.measures;
    let pixels = comparison.width as usize * comparison.height as usize;
    let over = format!(
        "{} of {} ({:.3} %) differ by more than {}",
        measures.over_tolerance,
        counted(pixels, "pixel"),
        100.0 * measures.over_tolerance as f64 / pixels as f64,
        tolerance(largest_allowed),
    );
    match comparison.verdict {
        Verdict::Identical => print_line("identical"),
        verdict => print_line(&format!("{}: {over}", verdict.name())),
    }
    compared.note.iter().for_each(|line| note(line));
    for line in compared.causes() {
        print_line(&format!("  {line}"));
    }
    print_line(&format!("  RMSE      {:.6}", measures.rmse));
    print_line(&format!(
        "  PSNR      {} dB",
        if measures.psnr.is_finite() { format!("{:.2}", measures.psnr) } else { "infinite".into() }
    ));
    print_line(&format!(
        "  SSIM      {}",
        measures.ssim.map_or("- (a side has fewer than 11 pixels)".into(), |s| format!("{s:.5}"))
    ));
    print_line(&format!("  FLIP      {:.5}", measures.flip));
    if let Some(flip) = measures.hdr_flip {
        print_line(&format!("  HDR-FLIP  {flip:.5}"));
    }
    if let Some(largest) = &measures.largest {
        let values = |color: [f32; 3]| color.map(|value| format!("{value:.4}")).join(" ");
        print_line(&format!(
            "  largest   {} at {},{}: {} in the reference, {} in the picture",
            tolerance(largest.difference),
            largest.x,
            largest.y,
            values(largest.reference.to_array()),
            values(largest.test.to_array())
        ));
    }
    if let Some((x, y)) = measures.first_not_finite {
        let [reference, picture] = measures.not_finite;
        print_line(&format!(
            "  not finite  {reference} pixels of the reference, {picture} of the picture; first difference at {x},{y}"
        ));
    }
    for (i, region) in comparison.regions.iter().enumerate().take(3) {
        print_line(&format!("  where     {}", region_text(region)));
        if let Some(hit) = compared.hits.get(i) {
            print_line(&format!("            {}", hit.line()));
            print_line(&format!("            {}", hit.command));
        }
    }
}

/// Describes a region of differing pixels.
pub fn region_text(region: &Region) -> String {
    let Region { x, y, width, height, pixels, mean_difference, share, worst } = region;
    let [r, g, b] = mean_difference.to_array();
    format!(
        "{width}x{height} at {x},{y}: {}, on average {r:+.3} {g:+.3} {b:+.3}, {:.1} % of the squared difference, most at {},{}",
        counted(*pixels, "pixel"),
        100.0 * share,
        worst.0,
        worst.1
    )
}

/// Formats a tolerance. A multiple of 1/255 is written as n/255.
fn tolerance(value: f32) -> String {
    let steps = value * 255.0;
    if (steps - steps.round()).abs() < 1e-3 && steps < 256.0 { format!("{steps:.0}/255") } else { format!("{value}") }
}

/// Prints a line for each picture in a folder and a line for each student.
pub fn table(all: &[ComparedPair], extra: &[PathBuf]) {
    let names: Vec<String> = all.iter().map(|compared| name(&compared.pair)).collect();
    let wide = names.iter().map(|name| name.chars().count()).max().unwrap_or(0).max(7);
    print_line(&format!("{:wide$}  verdict    differ %     RMSE    SSIM    FLIP  why", "picture"));
    for (name, compared) in names.iter().zip(all) {
        let verdict = compared.verdict();
        match &compared.outcome {
            Outcome::Compared(comparison) => {
                let m = &comparison.measures;
                let share =
                    100.0 * m.over_tolerance as f64 / (f64::from(comparison.width) * f64::from(comparison.height));
                let ssim = m.ssim.map_or("-".into(), |ssim| format!("{ssim:.4}"));
                let flip = m.hdr_flip.unwrap_or(m.flip);
                let why = compared.causes().first().cloned().unwrap_or_default();
                let line =
                    format!("{name:wide$}  {verdict:9}  {share:8.3}  {:7.4}  {ssim:>6}  {flip:6.4}  {why}", m.rmse);
                print_line(line.trim_end());
            }
            Outcome::Missing => print_line(&format!("{name:wide$}  {verdict}")),
            Outcome::Failed(reason) => print_line(&format!("{name:wide$}  {verdict}      {reason}")),
        }
    }
    let students = students(all);
    if !students.is_empty() {
        let wide = students.keys().map(|who| who.chars().count()).max().unwrap_or(0).max(7);
        print_line(&format!("\n{:wide$}  same  different  missing  error", "student"));
        for (who, [same, different, missing, error]) in &students {
            print_line(&format!("{who:wide$}  {same:4}  {different:9}  {missing:7}  {error:5}"));
        }
    }
    if !extra.is_empty() {
        let shown: Vec<String> = extra.iter().take(5).map(|path| path.display().to_string()).collect();
        let more = if extra.len() > 5 { " and others" } else { "" };
        note(&format!("{} without a reference: {}{more}", counted(extra.len(), "picture"), shown.join(", ")));
    }
}

/// Returns the results as comma-separated values (RFC 4180). Each line describes one picture with
/// the verdict, metrics, and the names and descriptions of mistakes.
pub fn csv(all: &[ComparedPair]) -> String {
    let quoted = |text: &str| match text.contains([',', '"', '\n', '\r']) {
        true => format!("\"{}\"", text.replace('"', "\"\"")),
        false => text.to_string(),
    };
    let mut table = "student,picture,verdict,differ_percent,rmse,ssim,flip,mistake,why\r\n".to_string();
    for compared in all {
        let pair = &compared.pair;
        let mut cells =
            vec![pair.student.clone().unwrap_or_default(), pair.name.clone(), compared.verdict().to_string()];
        let (numbers, why) = match &compared.outcome {
            Outcome::Compared(comparison) => {
                let m = &comparison.measures;
                let share =
                    100.0 * m.over_tolerance as f64 / (f64::from(comparison.width) * f64::from(comparison.height));
                let ssim = m.ssim.map_or(String::new(), |ssim| ssim.to_string());
                let flip = m.hdr_flip.unwrap_or(m.flip).to_string();
                ([share.to_string(), m.rmse.to_string(), ssim, flip], compared.causes().first().cloned())
            }
            Outcome::Missing => Default::default(),
            Outcome::Failed(reason) => (Default::default(), Some(reason.clone())),
        };
        cells.extend(numbers);
        cells.push(compared.mistakes());
        cells.push(why.unwrap_or_default());
        table += &cells.iter().map(|cell| quoted(cell)).collect::<Vec<_>>().join(",");
        table += "\r\n";
    }
    table
}

/// Counts the pictures of each student by verdict: same, different, missing, failed.
pub fn students(all: &[ComparedPair]) -> BTreeMap<String, [usize; 4]> {
    let mut students = BTreeMap::new();
    for compared in all {
        let Some(who) = &compared.pair.student else { continue };
        let counts: &mut [usize; 4] = students.entry(who.clone()).or_default();
        counts[match &compared.outcome {
            Outcome::Compared(comparison) => usize::from(comparison.verdict == Verdict::Different),
            Outcome::Missing => 2,
            Outcome::Failed(_) => 3,
        }] += 1;
    }
    students
}

/// Returns all results as JSON. `psnr` is null if it is infinite. `ssim` is null if a picture is
/// too small.
pub fn json(all: &[ComparedPair], extra: &[PathBuf], args: &CompareArgs) -> Value {
    let verdicts = |wanted: &str| all.iter().filter(|compared| compared.verdict() == wanted).count();
    json!({
        "version": VERSION,
        "tolerance": args.tolerance,
        "allow_percent": args.allow,
        "identical": verdicts("identical"),
        "same": verdicts("same"),
        "different": verdicts("different"),
        "missing": verdicts("missing"),
        "errors": verdicts("error"),
        "pairs": all.iter().map(pair).collect::<Vec<_>>(),
        "without_reference": extra.iter().map(|path| path.to_string_lossy()).collect::<Vec<_>>(),
    })
}

/// Returns one pair as JSON.
pub fn pair(compared: &ComparedPair) -> Value {
    let pair = &compared.pair;
    let mut value = json!({
        "name": pair.name,
        "student": pair.student,
        "reference": pair.reference.to_string_lossy(),
        "picture": pair.picture.as_ref().map(|path| path.to_string_lossy()),
        "verdict": compared.verdict(),
    });
    let more = match &compared.outcome {
        Outcome::Missing => json!({}),
        Outcome::Failed(reason) => json!({ "error": reason }),
        Outcome::Compared(comparison) => {
            report::comparison(comparison, &compared.hits.iter().map(PixelHit::json).collect::<Vec<_>>())
        }
    };
    if let Some(diagnosis) = &compared.diagnosis {
        value["diagnosis"] = mistakes::json(diagnosis);
    }
    if let (Value::Object(value), Value::Object(more)) = (&mut value, more) {
        value.extend(more);
    }
    value
}

/// Prints a note.
fn note(line: &str) {
    print_error_line(&format!("note: {line}"));
}
