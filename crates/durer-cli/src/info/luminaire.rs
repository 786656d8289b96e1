//! Summary of a photometric file: flux, efficacy, peak, beam and field angles.

use super::{InfoArgs, polar};
use crate::failure::Failure;
use crate::file_registry::FileRegistry;
use crate::output::print_written;
use crate::report;
use crate::terminal::{print_line, printable_line};
use durer::diag::{Diagnostics, Files};
use durer::format::folder::FolderSource;
use durer::format::photometry::{Luminaire, read_luminaire};
use durer::image::save_all;
use durer::light::PhotometricSummary;
use std::path::Path;

/// Maximum size of a photometric file, in bytes. Files with a value per degree take 1 MB.
const MAX_BYTES: u64 = 64 << 20;

/// Returns true if a file has the extension of a photometric file.
pub fn is_photometric(path: &Path) -> bool {
    path.extension()
        .is_some_and(|extension| extension.eq_ignore_ascii_case("ies") || extension.eq_ignore_ascii_case("ldt"))
}

/// Runs `durer info` for a photometric file.
pub fn run(args: &InfoArgs) -> Result<(), Failure> {
    let (path, name) = (&args.scene, args.scene.display().to_string());
    let mut registry = FileRegistry::default();
    registry.register_input(path)?;
    let target = args.polar.as_ref().map(|polar| registry.register_output_as("--polar", polar, "svg")).transpose()?;
    let bytes = FolderSource::new(".").budget(MAX_BYTES).read_path(path, &name).map_err(report::unreadable)?;
    let (mut files, mut diagnostics) = (Files::default(), Diagnostics::default());
    let file = files.add(name, bytes.clone());
    let luminaire = read_luminaire(&bytes, file, &mut diagnostics);
    report::print(&files, &diagnostics, args.json);
    let Some(luminaire) = luminaire else { return Err(Failure::Input(None)) };
    let summary = luminaire.profile.summary();
    match args.json {
        true => print_line(&serde_json::to_string_pretty(&json(&luminaire, &summary))?),
        false => lines(&luminaire, &summary).iter().for_each(|(what, text)| print_line(&format!("{what:<13}{text}"))),
    }
    if let Some(target) = target {
        save_all(&[(&target, polar::draw(&luminaire.profile, &title(&luminaire, path)).into_bytes())])?;
        print_written(&target, args.json);
    }
    Ok(())
}

/// Returns the name of the luminaire or, if the file has none, of the file.
fn title(luminaire: &Luminaire, path: &Path) -> String {
    let name = luminaire.names.iter().find(|(what, _)| *what == "luminaire").map(|(_, name)| name.clone());
    name.unwrap_or_else(|| path.file_name().unwrap_or_default().to_string_lossy().into_owned())
}

fn lines(luminaire: &Luminaire, summary: &PhotometricSummary) -> Vec<(&'static str, String)> {
    let profile = &luminaire.profile;
    let names = luminaire.names.iter().map(|(what, name)| (*what, printable_line(name)));
    let mut lines: Vec<_> = names.collect();
    let (rows, columns) = (profile.vertical.len(), profile.horizontal.len());
    let kind = profile.kind.letter();
    lines.push((
        "format",
        format!("{}, type {kind}, {rows} vertical and {columns} horizontal angles", luminaire.format),
    ));
    let down = 100.0 * summary.downward;
    lines.push(("flux", format!("{:.1} lm, {down:.1} % of it downwards", summary.flux)));
    if let Some(source) = luminaire.source_flux {
        let ratio = 100.0 * summary.flux / source;
        lines.push(("sources", format!("{source:.1} lm; light output ratio {ratio:.1} %")));
    }
    if let Some(watts) = luminaire.watts {
        lines.push(("power", format!("{watts:.1} W; luminous efficacy {:.1} lm/W", summary.flux / watts)));
    }
    let [vertical, horizontal] = summary.peak_angles;
    lines.push(("peak", format!("{:.1} cd at vertical angle {vertical}, horizontal angle {horizontal}", summary.peak)));
    let planes = |[a, b]: [f64; 2]| format!("{a:.1} degrees in plane 0-180, {b:.1} degrees in plane 90-270");
    lines.push(("beam", format!("{} (half of the maximum)", planes(summary.beam_angles))));
    lines.push(("field", format!("{} (a tenth of the maximum)", planes(summary.field_angles))));
    lines
}

fn json(luminaire: &Luminaire, summary: &PhotometricSummary) -> serde_json::Value {
    let names: serde_json::Map<_, _> =
        luminaire.names.iter().map(|(what, name)| (what.to_string(), name.as_str().into())).collect();
    serde_json::json!({
        "format": luminaire.format,
        "type": luminaire.profile.kind.letter().to_string(),
        "names": names,
        "flux_lm": summary.flux,
        "downward_share": summary.downward,
        "source_flux_lm": luminaire.source_flux,
        "watts": luminaire.watts,
        "efficacy_lm_per_w": luminaire.watts.map(|watts| summary.flux / watts),
        "peak_cd": summary.peak,
        "peak_angles_deg": summary.peak_angles,
        "beam_angles_deg": summary.beam_angles,
        "field_angles_deg": summary.field_angles,
        "vertical_deg": luminaire.profile.vertical,
        "horizontal_deg": luminaire.profile.horizontal,
        "candela": luminaire.profile.candela,
    })
}
