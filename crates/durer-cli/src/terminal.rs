//! Prints lines on standard output and standard error.

use std::borrow::Cow;
use std::io::{ErrorKind, IsTerminal, Write};
use std::sync::OnceLock;
use std::sync::atomic::{AtomicBool, Ordering::Relaxed};

/// Exit code of all failures except invalid input. It includes failures to write to standard
/// output.
pub const OTHER_FAILURE: u8 = 1;

/// True if the program was started without a standard output.
static CLOSED: AtomicBool = AtomicBool::new(false);

/// Type of function that ends the program with an exit code.
pub type ExitFn = fn(u8) -> !;

/// Function that ends the program early. See [`set_end`].
static END: OnceLock<ExitFn> = OnceLock::new();

/// Sets the function that ends the program. Only the first call has an effect.
pub fn set_end(end: ExitFn) {
    let _ = END.set(end);
}

/// Ends the program with an exit code.
///
/// # Panics
///
/// Panics if [`set_end`] was not called.
pub fn end(code: u8) -> ! {
    match END.get() {
        Some(end) => end(code),
        None => panic!("the program would end with exit code {code}"),
    }
}

/// Records whether the program was started with a standard output.
#[cfg(unix)]
pub fn check_standard_output() {
    CLOSED.store(rustix::io::fcntl_getfd(rustix::stdio::stdout()).is_err(), Relaxed);
}

/// Returns true if there is a standard output.
pub fn has_standard_output() -> bool {
    !CLOSED.load(Relaxed)
}

/// Returns true for characters that could control the terminal or change the order of the text:
/// control characters except line breaks and tabs, and marks of text direction.
pub fn controls_terminal(c: char) -> bool {
    c.is_control() && !matches!(c, '\n' | '\t')
        || matches!(c, '\u{61c}' | '\u{200e}' | '\u{200f}' | '\u{202a}'..='\u{202e}' | '\u{2066}'..='\u{2069}')
}

/// Returns true if terminals should show colours and bold text. See <https://no-color.org>.
pub fn has_styles() -> bool {
    let set = |name: &str| std::env::var_os(name).filter(|value| !value.is_empty());
    set("NO_COLOR").is_none() && set("TERM").is_none_or(|term| term != "dumb")
}

/// Replaces characters that could control the terminal by escapes such as `\u{1b}`, because names
/// of files and texts in files can contain them. Changes of the text's style (`ESC [ ... m`), which
/// this program prints itself, are kept.
pub fn printable(text: &str) -> Cow<'_, str> {
    if !text.contains(controls_terminal) {
        return Cow::Borrowed(text);
    }
    let mut plain = String::with_capacity(text.len());
    for (at, c) in text.char_indices() {
        match controls_terminal(c) && !(c == '\u{1b}' && begins_style(&text[at + 1..])) {
            true => plain.extend(c.escape_unicode()),
            false => plain.push(c),
        }
    }
    Cow::Owned(plain)
}

/// Replaces line breaks as well as the characters that [`printable`] replaces, so that the result
/// is a single line.
pub fn printable_line(text: &str) -> String {
    printable(text).replace('\n', "\\n")
}

/// Returns true if the rest of an escape sequence only changes the style of the text.
fn begins_style(rest: &str) -> bool {
    let numbers = rest.strip_prefix('[').and_then(|rest| rest.split_once('m')).map(|(numbers, _)| numbers);
    numbers.is_some_and(|numbers| numbers.len() < 16 && numbers.bytes().all(|b| b.is_ascii_digit() || b == b';'))
}

/// Prints a line on standard output. A closed pipe is not an error because the reader already has
/// all that it needs.
pub fn print_line(line: &str) {
    let written = match has_standard_output() {
        true if std::io::stdout().is_terminal() => writeln!(std::io::stdout(), "{}", printable(line)),
        true => writeln!(std::io::stdout(), "{line}"),
        false => Err(std::io::Error::other("the stream is closed")),
    };
    match written {
        Err(error) if error.kind() != ErrorKind::BrokenPipe => {
            print_error_line(&format!("error: cannot write to standard output: {error}"));
            end(OTHER_FAILURE);
        }
        _ => {}
    }
}

/// Prints a line on standard error. Errors are ignored because there is nowhere to report them.
pub fn print_error_line(line: &str) {
    let _ = writeln!(std::io::stderr(), "{}", printable(line));
}

#[cfg(test)]
mod tests {
    use super::{printable, printable_line};

    #[test]
    fn names_cannot_control_the_terminal() {
        assert_eq!(printable("a\tb\nDürer \u{1b}[1;2m漢\u{1b}[0m"), "a\tb\nDürer \u{1b}[1;2m漢\u{1b}[0m");
        assert_eq!(printable("x\u{1b}[2J\u{7f}\u{9b}\u{202e}.png"), "x\\u{1b}[2J\\u{7f}\\u{9b}\\u{202e}.png");
        assert_eq!(printable_line("a\nb\r.png"), "a\\nb\\u{d}.png");
    }
}
