//! Imitates how the course programs read Wavefront files.

use super::{Statement, statement, words::Words};
use durer_scene::dialect::{Quirk, QuirkSet};
use std::borrow::Cow;

/// Returns the file without the parts that programs with these quirks ignore. Ignored corners are
/// overwritten with spaces, so that byte offsets stay valid; an ignored last line is cut off.
///
/// The quirks are [`Quirk::LostLastLine`] and [`Quirk::ThreeCorners`].
pub fn apply_quirks(bytes: &[u8], quirks: QuirkSet) -> Cow<'_, [u8]> {
    let has = |compat: Quirk| quirks & compat.bit() != 0;
    let end = match bytes.iter().rposition(|&byte| byte == b'\n') {
        _ if !has(Quirk::LostLastLine) => bytes.len(),
        last => last.map_or(0, |last| last + 1),
    };
    let mut known = Cow::from(&bytes[..end]);
    if has(Quirk::ThreeCorners) {
        let mut words = Words::new(&bytes[..end]);
        while let Some(keyword) = words.next_statement() {
            if statement(&bytes[keyword]) == Some(Statement::Face) {
                let corners = std::iter::from_fn(|| words.next_word());
                corners.skip(3).for_each(|corner| known.to_mut()[corner].fill(b' '));
            }
            words.skip_rest();
        }
    }
    known
}

#[cfg(test)]
mod tests {
    use super::*;

    const SQUARE: &[u8] = b"v 0 0 0\nv 1 0 0\nv 1 1 0\nv 0 1 0\nf 1/1 2/1 3/1 4/1 # all\nf 1 2 4";

    #[test]
    fn ignored_parts_become_blank_or_are_cut_off() {
        assert_eq!(apply_quirks(SQUARE, 0), SQUARE);
        let last = apply_quirks(SQUARE, Quirk::LostLastLine.bit());
        assert_eq!(*last, SQUARE[..SQUARE.len() - 7]);
        assert_eq!(apply_quirks(&last, Quirk::LostLastLine.bit()), last);
        let three = apply_quirks(SQUARE, Quirk::ThreeCorners.bit());
        assert_eq!(three.len(), SQUARE.len());
        assert!(three.ends_with(b"f 1/1 2/1 3/1     # all\nf 1 2 4"), "{}", String::from_utf8_lossy(&three));
        assert!(apply_quirks(b"f 1 2 3", Quirk::LostLastLine.bit()).is_empty());
    }
}
