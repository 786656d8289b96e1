//! Quotes text for the languages used in job files. The result is a single line of printable
//! characters, so it cannot end a shell command, a comment or a YAML block.

use crate::frames;
use std::fmt::Write;

/// Returns true if a character does not need to be escaped in any of the languages.
fn is_plain(c: char) -> bool {
    // Letters of all alphabets are printable in YAML. Other non-ASCII characters can be line
    // breaks, bidirectional control characters or unprintable characters.
    matches!(c, ' '..='~') && !matches!(c, '\'' | '\\' | '{' | '}') || c.is_alphanumeric()
}

/// Quotes text as a single bash word.
///
/// Braces are escaped because `{{` starts an expression in Open Job Description templates.
pub fn bash_word(text: &str) -> String {
    let is_bare = |c: char| c.is_ascii_alphanumeric() || "_-./:=,+%".contains(c);
    if !text.is_empty() && text.chars().all(is_bare) {
        return text.into();
    }
    if text.chars().all(is_plain) {
        return format!("'{text}'");
    }
    let mut word = String::from("$'");
    for c in text.chars() {
        if is_plain(c) {
            word.push(c);
        } else {
            // Escape individual bytes because the meaning of `\u` depends on the locale.
            c.encode_utf8(&mut [0; 4]).bytes().for_each(|byte| {
                let _ = write!(word, "\\x{byte:02x}");
            });
        }
    }
    word + "'"
}

/// Quotes the file name pattern of an animation as a single bash word, with `$frame` in place of
/// the frame number.
pub fn bash_word_of_frame(pattern: &str) -> String {
    match frames::place(pattern) {
        None if pattern.is_empty() => String::new(),
        None => bash_word(pattern),
        Some((from, to, digits)) => {
            let before = if from == 0 { String::new() } else { bash_word(&pattern[..from]) };
            let number = format!("\"$(printf %0{digits}d \"$frame\")\"");
            let number = if digits == 0 { "\"$frame\"".into() } else { number };
            before + &number + &bash_word_of_frame(&pattern[to..])
        }
    }
}

/// Adds `./` to a path that begins with a dash, so that no command treats it as an option.
pub fn not_an_option(path: &str) -> String {
    if path.starts_with('-') { format!("./{path}") } else { path.into() }
}

/// Quotes text as a Python string literal.
pub fn python_string(text: &str) -> String {
    let mut string = String::from("\"");
    for c in text.chars() {
        match u32::from(c) {
            _ if is_plain(c) && c != '"' => string.push(c),
            code => drop(write!(string, "\\U{code:08x}")),
        }
    }
    string + "\""
}

/// Formats texts as a Python list of string literals.
pub fn python_list(texts: &[String]) -> String {
    format!("[{}]", texts.iter().map(|text| python_string(text)).collect::<Vec<_>>().join(", "))
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn words_are_one_line_and_plain_ones_are_bare() {
        for (text, word) in [
            ("a/b-1.txt", "a/b-1.txt"),
            ("", "''"),
            ("two words", "'two words'"),
            ("é è", "'é è'"),
            ("it's", "$'it\\x27s'"),
            ("a\nb", "$'a\\x0ab'"),
            ("{{Param.X}}", "$'\\x7b\\x7bParam.X\\x7d\\x7d'"),
            ("\u{2028}\\", "$'\\xe2\\x80\\xa8\\x5c'"),
            ("$(x)`y`", "'$(x)`y`'"),
        ] {
            assert_eq!(bash_word(text), word);
        }
        assert_eq!(bash_word_of_frame("a b.%04d.png"), r#"'a b.'"$(printf %04d "$frame")".png"#);
        assert_eq!(bash_word_of_frame("%d/%s\\n%d"), r#""$frame"$'/%s\x5cn'"$frame""#);
        assert_eq!(python_list(&["a".into(), "\"\n".into()]), r#"["a", "\U00000022\U0000000a"]"#);
        assert_eq!((not_an_option("-o"), not_an_option("o")), ("./-o".into(), "o".into()));
    }
}
