//! Forms of option values, which define how their text is checked, parsed and printed.

use durer_diag::did_you_mean;
use durer_image::decode_hexadecimal;
use durer_render::render::Backdrop;
use durer_scene::math::{Color, Vec3};

/// Form of the value of an option, such as a flag, a number in a range, or one of several words.
#[derive(Clone, Copy, Debug)]
pub enum OptionForm {
    /// No value.
    Flag,
    /// The word `on` or `off`. Without a value, the option is on.
    Switch,
    /// An integer in a range that includes both ends.
    Whole(u32, u32),
    /// A number, or several numbers joined by a letter. Contains the name of the value.
    Value(&'static str),
    /// A number that must pass a test. Contains the name of the value, the test, and the message
    /// that is shown if the test fails.
    Number(&'static str, fn(f32) -> bool, &'static str),
    /// Two numbers separated by a space. Contains the names of the numbers.
    Two(&'static str, &'static str),
    /// One of several words.
    Words(fn() -> Vec<&'static str>),
}

/// Definition of a render option, with its name, its documentation and the form of its value.
#[derive(Clone, Copy, Debug)]
pub struct JobOption {
    /// Name on the command line without dashes.
    pub name: &'static str,
    /// Meaning, unit and default of the option.
    pub doc: &'static str,
    /// Form of the value.
    pub form: OptionForm,
}

impl OptionForm {
    /// Checks that the text of a value has this form. Numbers without a fixed form are not checked.
    pub(crate) fn check(self, text: &str) -> Result<(), String> {
        match self {
            OptionForm::Whole(least, most) => match text.parse::<u32>() {
                Ok(number) if (least..=most).contains(&number) => Ok(()),
                Ok(_) => Err(format!("expected a number from {least} to {most}")),
                Err(_) => Err("expected a whole number".into()),
            },
            OptionForm::Words(words) => one_of(text, &words()),
            OptionForm::Number(_, test, otherwise) if !text.parse().is_ok_and(test) => Err(otherwise.into()),
            _ => Ok(()),
        }
    }
}

/// Checks that a text is one of the allowed words.
pub(super) fn one_of(text: &str, words: &[&str]) -> Result<(), String> {
    if words.contains(&text) { Ok(()) } else { Err(format!("expected one of {}", words.join(", "))) }
}

/// Returns the message for an option that does not exist. The message suggests the most similar
/// name.
pub(crate) fn unknown_option<'a>(name: &str, known: impl IntoIterator<Item = &'a str>) -> String {
    match did_you_mean(name, known) {
        Some(near) => format!("unknown option `{name}`; did you mean `{near}`?"),
        None => format!("unknown option `{name}`"),
    }
}

/// Parses three finite numbers that are separated by commas.
pub(crate) fn three_numbers(text: &str) -> Option<Vec3> {
    let numbers: Option<Vec<f32>> = text.split(',').map(|number| number.trim().parse().ok()).collect();
    let numbers: [f32; 3] = numbers?.try_into().ok()?;
    Some(Vec3::from(numbers)).filter(|vector| vector.is_finite())
}

/// Type of the value of an option. The value is parsed from text and printed as text.
pub(super) trait OptionValue: Sized {
    fn parse(text: &str) -> Result<Self, String>;
    fn to_text(&self) -> String;
}

impl OptionValue for bool {
    fn parse(text: &str) -> Result<Self, String> {
        match text {
            "on" => Ok(true),
            "off" => Ok(false),
            _ => Err("expected `on` or `off`".into()),
        }
    }
    fn to_text(&self) -> String {
        if *self { "on".into() } else { "off".into() }
    }
}

macro_rules! numbers {
    ($($type:ty: $what:literal),+) => {
        $(impl OptionValue for $type {
            fn parse(text: &str) -> Result<Self, String> {
                text.parse().map_err(|_| concat!("expected ", $what).into())
            }
            fn to_text(&self) -> String {
                self.to_string()
            }
        })+
    };
}

numbers!(u32: "a whole number", u64: "a whole number", f32: "a number", String: "a word");

/// Width and height in pixels.
impl OptionValue for (u32, u32) {
    fn parse(text: &str) -> Result<Self, String> {
        let parsed = text.split_once(['x', 'X']).and_then(|(w, h)| Some((w.parse().ok()?, h.parse().ok()?)));
        match parsed.ok_or("expected WIDTHxHEIGHT, for example 640x480")? {
            (0, _) | (_, 0) => Err("width and height must be at least 1".into()),
            size => Ok(size),
        }
    }
    fn to_text(&self) -> String {
        format!("{}x{}", self.0, self.1)
    }
}

/// Background that the camera sees.
impl OptionValue for Backdrop {
    fn parse(text: &str) -> Result<Self, String> {
        if text == "transparent" {
            return Ok(Backdrop::Transparent);
        }
        let color = match text {
            "white" => Some(Color::ONE),
            "black" => Some(Color::ZERO),
            _ => {
                let numbers = || three_numbers(text).filter(|color| color.min_element() >= 0.0);
                decode_hexadecimal(text).map(Color::from).or_else(numbers)
            }
        };
        let expected = "expected `transparent`, `white`, `black`, an sRGB colour such as #ffcc00, or red, green and blue as \
                        linear light, for example 0.5,0.5,0.5";
        Ok(Backdrop::Color(color.ok_or(expected)?))
    }
    fn to_text(&self) -> String {
        match self {
            Backdrop::Transparent => "transparent".into(),
            Backdrop::Color(color) => format!("{},{},{}", color.x, color.y, color.z),
        }
    }
}

/// Two numbers.
impl OptionValue for [f32; 2] {
    fn parse(text: &str) -> Result<Self, String> {
        let numbers: Option<Vec<f32>> = text.split_whitespace().map(|word| word.parse().ok()).collect();
        numbers.and_then(|numbers| numbers.try_into().ok()).ok_or_else(|| "expected two numbers".into())
    }
    fn to_text(&self) -> String {
        format!("{} {}", self[0], self[1])
    }
}
