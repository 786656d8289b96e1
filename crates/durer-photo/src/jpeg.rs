//! Detects truncated JPEG files, since decoders fill missing parts with grey.

/// Returns true if the file contains the end marker of the image itself, rather than only that of a
/// thumbnail in its header.
///
/// Source: ITU-T T.81, *Digital Compression and Coding of Continuous-Tone Still Images*, annex B.
pub fn is_complete(bytes: &[u8]) -> bool {
    const START: u8 = 0xd8;
    const END: u8 = 0xd9;
    let mut at = 0;
    // In coded data, 0xff is followed by 0 or by a restart marker, 0xd0 to 0xd7. Fill bytes of 0xff
    // can precede a marker.
    let is_marker = |pair: &[u8]| pair[0] == 0xff && !matches!(pair[1], 0 | 1 | 0xff | 0xd0..=0xd7);
    while let Some(pair) = bytes.get(at..at + 2) {
        at += match pair[1] {
            _ if !is_marker(pair) => 1,
            START => 2,
            END => return true,
            // Other markers begin a segment whose length includes the two bytes of the length
            // field.
            _ => match bytes.get(at + 2..at + 4) {
                Some(length) => 2 + usize::from(u16::from_be_bytes([length[0], length[1]])),
                None => return false,
            },
        };
    }
    false
}

#[cfg(test)]
mod tests {
    use super::is_complete;

    #[test]
    fn end_marker_of_the_picture_is_found() {
        let head: &[u8] = &[0xff, 0xd8, 0xff, 0xe1, 0, 6, 0xff, 0xd8, 0xff, 0xd9, 0xff, 0xda, 0, 2];
        let with = |data: &[u8]| [head, data].concat();
        assert!(is_complete(&with(&[1, 0xff, 0, 0xff, 0xd0, 7, 0xff, 0xff, 0xd9])));
        assert!(is_complete(&with(&[1, 0xff, 0xd9, 4, 4])));
        for cut in [&[][..], &[1, 2, 0xff], &[1, 0xff, 0, 0xd9], &[0xff, 0xc4], &[0xff, 0xc4, 0, 9, 0xff, 0xd9]] {
            assert!(!is_complete(&with(cut)), "{cut:?}");
        }
        assert!(!is_complete(&[]));
    }
}
