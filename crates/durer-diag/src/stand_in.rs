//! Recognises files that were stored in place of the wanted file.

/// File that a program stored in place of the wanted one, such as the error page of a web server.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct StandIn {
    /// Kind of file, such as "a web page".
    pub what: &'static str,
    /// Advice on how to get the wanted file.
    pub help: &'static str,
    /// Number of bytes at the start of the file that identify it.
    pub length: usize,
}

/// Returns what a file is if it begins like a web page or like a pointer of Git LFS. Such files
/// result from failed downloads and incomplete clones.
pub fn stand_in(bytes: &[u8]) -> Option<StandIn> {
    let blank = bytes.strip_prefix(b"\xef\xbb\xbf").unwrap_or(bytes);
    let text = blank.trim_ascii_start();
    let begins = |word: &str| text.get(..word.len()).is_some_and(|start| start.eq_ignore_ascii_case(word.as_bytes()));
    let length = |word: &str| bytes.len() - text.len() + word.len();
    for word in ["<!doctype html", "<html"] {
        if begins(word) {
            let help = "the download probably failed: open the file in a browser to see why, and download it again";
            return Some(StandIn { what: "a web page", help, length: length(word) });
        }
    }
    let word = "version https://git-lfs.github.com/spec/";
    begins(word).then(|| StandIn {
        what: "a pointer of Git LFS, not the file itself",
        help: "run `git lfs pull` in the repository that the file comes from",
        length: length(word),
    })
}

#[cfg(test)]
mod tests {
    use super::stand_in;

    #[test]
    fn pages_and_pointers_are_recognised() {
        for page in ["<!DOCTYPE html>", "<!doctype HTML PUBLIC", "\u{feff}\n  <html lang=\"en\">"] {
            let found = stand_in(page.as_bytes()).unwrap();
            assert_eq!((found.what, found.length <= page.len()), ("a web page", true));
        }
        let pointer = b"version https://git-lfs.github.com/spec/v1\noid sha256:4d7a\nsize 12345\n";
        assert!(stand_in(pointer).unwrap().help.contains("git lfs pull"));
        for other in [&b""[..], b"<", b"<htm", b"# version", b"<scene version=\"3.0.0\">"] {
            assert_eq!(stand_in(other), None);
        }
    }
}
