//! Readers and a writer of measured light distributions.

mod ies;
mod ldt;

use durer_diag::Diagnostics;
use durer_scene::light::photometric::PhotometricProfile;
pub use ies::write;

/// Reads a light profile in IES or EULUMDAT format; errors have spans.
pub fn read(bytes: &[u8], file: u32, diagnostics: &mut Diagnostics) -> Option<PhotometricProfile> {
    // Names of manufacturers can be in any encoding; all other text is ASCII. Replacing bytes one
    // by one preserves offsets.
    let text: String = bytes.iter().map(|&b| if b.is_ascii() { char::from(b) } else { '?' }).collect();
    match ldt::recognise(&text) {
        true => ldt::read(&text, file, diagnostics),
        false => ies::read(&text, file, diagnostics),
    }
}
