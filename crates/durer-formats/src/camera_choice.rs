//! Choice of one of the cameras of a model by its name or number.

use crate::report::range_text;
use durer_diag::did_you_mean;

/// Code of the error for a camera that the file does not have.
pub const NO_CAMERA: &str = "no-camera";

/// Returns the index of the requested camera, or of the first camera if none is requested. `names`
/// are the names of each camera, of which some can be empty.
///
/// # Errors
///
/// Returns a message that names similar or all cameras if there is no such camera.
pub fn choose_camera(names: &[Vec<&str>], wanted: Option<&str>) -> Result<Option<usize>, String> {
    let Some(wanted) = wanted else { return Ok((!names.is_empty()).then_some(0)) };
    let by_name = names.iter().position(|names| names.contains(&wanted));
    let by_number = || wanted.parse().ok().filter(|number| *number < names.len());
    if let Some(index) = by_name.or_else(by_number) {
        return Ok(Some(index));
    }
    let all: Vec<&str> = names.iter().flatten().copied().filter(|name| !name.is_empty()).collect();
    let known = match did_you_mean(wanted, all.iter().copied()) {
        Some(similar) => format!("did you mean `{similar}`?"),
        None if names.is_empty() => "it has no cameras".into(),
        None if all.is_empty() => format!("it has {}", range_text(names.len(), "camera", "cameras")),
        None => format!("the cameras are `{}`", all.join("`, `")),
    };
    Err(format!("the scene has no camera `{wanted}`: {known}"))
}
