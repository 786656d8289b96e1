//! Readers and a writer for measured light distributions.

mod ies;
mod ldt;

use durer_diag::Diagnostics;
use durer_scene::light::photometric::PhotometricProfile;
pub use ies::write;

/// Luminaire as its file describes it.
#[derive(Clone, Debug, PartialEq)]
pub struct Luminaire {
    /// Measured intensities.
    pub profile: PhotometricProfile,
    /// Name of the file format.
    pub format: &'static str,
    /// Power that the luminaire takes from the mains, in watts; `None` if the file states 0.
    pub watts: Option<f64>,
    /// Flux of its light sources without the luminaire, in lumens; `None` if the file gives the
    /// intensities of the luminaire as a whole (absolute photometry).
    pub source_flux: Option<f64>,
    /// Manufacturer, luminaire and other names, in the file's order, each with its kind.
    pub names: Vec<(&'static str, String)>,
}

/// Reads a light profile in IES or EULUMDAT format; errors contain spans.
pub fn read(bytes: &[u8], file: u32, diagnostics: &mut Diagnostics) -> Option<PhotometricProfile> {
    read_luminaire(bytes, file, diagnostics).map(|luminaire| luminaire.profile)
}

/// Reads a light profile like [`read`], and what the file says about the luminaire.
pub fn read_luminaire(bytes: &[u8], file: u32, diagnostics: &mut Diagnostics) -> Option<Luminaire> {
    // The names of manufacturers can be in any encoding, but all other text is ASCII. Replacing
    // single bytes keeps all offsets valid.
    let text: String = bytes.iter().map(|&b| if b.is_ascii() { char::from(b) } else { '?' }).collect();
    match ldt::recognise(&text) {
        true => ldt::read(&text, file, diagnostics),
        false => ies::read(&text, file, diagnostics),
    }
}
