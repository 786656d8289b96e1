//! Finds the byte range of the value at a JSON pointer. This module is needed only for diagnostics.

use std::ops::Range;

/// Returns the byte range of the value at a JSON pointer. If the value does not exist, returns the
/// range of the innermost enclosing value that exists.
pub(super) fn locate(text: &[u8], pointer: &str) -> Range<usize> {
    let mut walk = Cursor { text, at: 0 };
    walk.skip_whitespace();
    'steps: for step in pointer.split('/').skip(1).map(|step| step.replace("~1", "/").replace("~0", "~")) {
        let range = walk.here();
        let opening = walk.peek();
        if !matches!(opening, Some(b'{' | b'[')) {
            break;
        }
        walk.at += 1;
        let mut number = 0;
        loop {
            walk.skip_whitespace();
            if matches!(walk.peek(), None | Some(b'}' | b']')) {
                return range;
            }
            let span = match opening {
                Some(b'{') => {
                    let key = walk.key();
                    walk.skip_whitespace();
                    walk.at += 1; // the colon
                    walk.skip_whitespace();
                    key == step
                }
                _ => number.to_string() == step,
            };
            if span {
                continue 'steps;
            }
            walk.skip();
            walk.skip_whitespace();
            if walk.peek() == Some(b',') {
                walk.at += 1;
            }
            number += 1;
        }
    }
    walk.here()
}

/// Returns the byte offsets of the items of a top-level list.
pub(super) fn items(text: &[u8], key: &str) -> Vec<usize> {
    let list = locate(text, &format!("/{key}"));
    let (mut walk, mut starts) = (Cursor { text, at: list.start }, Vec::new());
    if walk.peek() != Some(b'[') {
        return starts;
    }
    walk.at += 1;
    loop {
        walk.skip_whitespace();
        if matches!(walk.peek(), None | Some(b']' | b'}')) {
            return starts;
        }
        starts.push(walk.at);
        walk.skip();
        walk.skip_whitespace();
        if walk.peek() == Some(b',') {
            walk.at += 1;
        }
    }
}

/// Cursor that moves through JSON text and skips values without parsing them.
struct Cursor<'a> {
    text: &'a [u8],
    at: usize,
}

impl Cursor<'_> {
    fn peek(&self) -> Option<u8> {
        self.text.get(self.at).copied()
    }

    fn skip_whitespace(&mut self) {
        while matches!(self.peek(), Some(b' ' | b'\t' | b'\n' | b'\r')) {
            self.at += 1;
        }
    }

    /// Returns the range of the value at the cursor. For an object or array, this is only its first
    /// byte.
    fn here(&self) -> Range<usize> {
        let mut walk = Cursor { ..*self };
        if matches!(walk.peek(), Some(b'{' | b'[')) {
            return self.at..self.at + 1;
        }
        walk.skip();
        self.at.min(self.text.len())..walk.at.min(self.text.len())
    }

    fn key(&mut self) -> String {
        let start = self.at;
        self.string();
        let text = &self.text[start.min(self.text.len())..self.at.min(self.text.len())];
        serde_json::from_slice(text).unwrap_or_default()
    }

    fn string(&mut self) {
        self.at += 1;
        while let Some(byte) = self.peek() {
            self.at += 1;
            match byte {
                b'"' => return,
                b'\\' => self.at += 1,
                _ => {}
            }
        }
    }

    /// Skips a value and everything that is nested in it.
    fn skip(&mut self) {
        let mut depth = 0usize;
        loop {
            match self.peek() {
                None => return,
                Some(b'"') => self.string(),
                Some(b'{' | b'[') => {
                    depth += 1;
                    self.at += 1;
                }
                Some(b'}' | b']') => {
                    if depth == 0 {
                        return;
                    }
                    depth -= 1;
                    self.at += 1;
                    if depth == 0 {
                        return;
                    }
                }
                Some(b',') if depth == 0 => return,
                Some(b' ' | b'\t' | b'\n' | b'\r') if depth == 0 => return,
                Some(_) => self.at += 1,
            }
            if depth == 0 && self.text.get(self.at.wrapping_sub(1)) == Some(&b'"') {
                return;
            }
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn pointers_lead_to_values() {
        let text = br#"{ "a": [1, {"b/c": "x\"}y", "d": [ ]}, -2.5e3], "e": true }"#;
        let at = |pointer: &str| String::from_utf8_lossy(&text[locate(text, pointer)]).into_owned();
        assert_eq!(at(""), "{");
        assert_eq!(at("/a"), "[");
        assert_eq!((at("/a/0"), at("/a/2"), at("/e")), ("1".into(), "-2.5e3".into(), "true".into()));
        assert_eq!(at("/a/1/b~1c"), r#""x\"}y""#);
        assert_eq!(at("/a/1/d"), "[");
        assert_eq!(items(text, "a").iter().map(|&i| text[i]).collect::<Vec<_>>(), b"1{-");
        assert!(items(text, "e").is_empty() && items(text, "x").is_empty());
        // For a missing value, the result is the enclosing value.
        assert_eq!((at("/a/7"), at("/a/1/none"), at("/e/x")), ("[".into(), "{".into(), "true".into()));
        for end in 0..text.len() {
            for pointer in ["", "/a/2", "/a/1/d/0", "/e", "/e/f/g"] {
                let range = locate(&text[..end], pointer);
                assert!(range.start <= range.end && range.end <= end, "{end} {pointer}");
            }
        }
    }
}
