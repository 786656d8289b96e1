//! Broken scenes.

use anyhow::Result;
use std::path::Path;

pub fn judge(_: &Path, _: &Path, _: &dyn Fn(&str) -> bool) -> Result<bool> {
    Ok(true)
}
