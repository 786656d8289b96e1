//! Readers and a writer for measured light distributions.

mod ies;
mod ldt;

use durer_diag::Diagnostics;
use durer_scene::light::photometric::PhotometricProfile;
pub use ies::write;

/// Reads a light profile in IES or EULUMDAT format; errors contain spans.
pub fn read(bytes: &[u8], file: u32, diagnostics: &mut Diagnostics) -> Option<PhotometricProfile> {
    // The names of manufacturers can be in any encoding, but all other text is ASCII. Replacing
    // single bytes keeps all offsets valid.
    let text: String = bytes.iter().map(|&b| if b.is_ascii() { char::from(b) } else { '?' }).collect();
    match ldt::recognise(&text) {
        true => ldt::read(&text, file, diagnostics),
        false => ies::read(&text, file, diagnostics),
    }
}
