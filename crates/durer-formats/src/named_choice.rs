//! Choice of a part of a model, such as one of its cameras, by name or number.

use crate::report::range_text;
use durer_diag::did_you_mean;

/// Code of the error for a camera that the file does not have.
pub const NO_CAMERA: &str = "no-camera";

/// Returns the index of the requested part, or of the first if none is requested. `what` is the
/// kind of the parts in the singular, and `names` are the names of each part, of which some can be
/// empty.
///
/// # Errors
///
/// Returns a message that names a similar part or all parts if there is no such part.
pub fn choose(what: &str, names: &[Vec<&str>], wanted: Option<&str>) -> Result<Option<usize>, String> {
    let Some(wanted) = wanted else { return Ok((!names.is_empty()).then_some(0)) };
    let by_name = names.iter().position(|names| names.contains(&wanted));
    let by_number = || wanted.parse().ok().filter(|number| *number < names.len());
    if let Some(index) = by_name.or_else(by_number) {
        return Ok(Some(index));
    }
    let all: Vec<&str> = names.iter().flatten().copied().filter(|name| !name.is_empty()).collect();
    let known = match did_you_mean(wanted, all.iter().copied()) {
        Some(similar) => format!("did you mean `{similar}`?"),
        None if all.is_empty() => format!("it has {}", range_text(names.len(), what, &format!("{what}s"))),
        None => format!("the {what}s are `{}`", all.join("`, `")),
    };
    Err(format!("the scene has no {what} `{wanted}`: {known}"))
}
