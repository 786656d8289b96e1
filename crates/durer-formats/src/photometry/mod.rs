//! Files of measured light of lamps.

mod ies;
mod ldt;

use durer_diag::Diagnostics;
use durer_scene::light::photometric::Profile;
pub use ies::write;

/// Reads a profile of either format; what is wrong is said at its place.
pub fn read(bytes: &[u8], file: u32, diagnostics: &mut Diagnostics) -> Option<Profile> {
    // Names of makers may be in any encoding; all else is ASCII, and places stay the same.
    let text: String = bytes.iter().map(|&b| if b.is_ascii() { char::from(b) } else { '?' }).collect();
    match ldt::recognise(&text) {
        true => ldt::read(&text, file, diagnostics),
        false => ies::read(&text, file, diagnostics),
    }
}
