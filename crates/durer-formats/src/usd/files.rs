//! Files that the layers of a USD scene are read from: the scene's folder, or a `.usdz` package.

use super::layer::Layer;
use super::time::SampleTime;
use super::{binary, text};
use crate::files::read_named;
use crate::growth::ResourceLimits;
use crate::model::ReadInput;
use crate::pictures::Pictures;
use crate::shared_report::SharedReport;
use crate::zip::{self, Zip};
use durer_diag::{Diagnostic, Span};
use durer_scene::scene::PictureBytes;
use std::cell::{Cell, RefCell};
use std::sync::Arc;

/// Reads layers and finds pictures for one scene.
pub(super) struct LayerFiles<'a> {
    pub input: &'a ReadInput<'a>,
    pub report: &'a SharedReport,
    pub limits: &'a ResourceLimits,
    /// Package that contains all files, if the scene is a `.usdz` file.
    package: Option<RefCell<Zip<'a>>>,
    /// Time at which attributes are read; known after the root layer has been read.
    pub time: Cell<SampleTime>,
}

/// Joins the path of a file to the folder of the layer that names it, and removes `.` and `..`.
pub(super) fn joined(layer: &str, asset: &str) -> String {
    let asset = asset.replace('\\', "/");
    let folder = layer.rsplit_once('/').map_or("", |(folder, _)| folder);
    let is_absolute = asset.starts_with('/') || asset.as_bytes().get(1) == Some(&b':');
    let whole = if is_absolute || folder.is_empty() { asset } else { format!("{folder}/{asset}") };
    let mut parts: Vec<&str> = Vec::new();
    for part in whole.split('/') {
        match part {
            "." => {}
            ".." if parts.last().is_some_and(|last| *last != ".." && !last.is_empty()) => {
                parts.pop();
            }
            _ => parts.push(part),
        }
    }
    parts.join("/")
}

impl<'a> LayerFiles<'a> {
    /// Opens the file of a scene, and reads its root layer.
    pub fn open(
        input: &'a ReadInput<'a>,
        report: &'a SharedReport,
        limits: &'a ResourceLimits,
    ) -> Option<(Self, Layer)> {
        let at = Span { file: input.file, start: 0, end: 0 };
        let mut files = LayerFiles { input, report, limits, package: None, time: Cell::new(SampleTime::First) };
        if !zip::recognise(input.bytes) {
            let layer = files.parse(input.bytes, input.file, input.name, at)?;
            return Some((files, layer));
        }
        let package =
            Zip::open(input.bytes).map_err(|error| report.error(at, format!("the package is damaged: {error}")));
        let package = package.ok()?;
        // The first layer of a package is its root layer. A package lists its files in order, but
        // the list here is sorted, so prefer the file whose offset is lowest.
        let Some(root) = package.first_name(is_layer).map(str::to_string) else {
            report.error(at, "the package contains no USD layer");
            return None;
        };
        files.package = Some(RefCell::new(package));
        let layer = files.layer(&root, at)?;
        Some((files, layer))
    }

    /// Reads the root layer again, after the time has been set.
    pub fn root_again(&self, name: &str) -> Option<Layer> {
        let at = Span { file: self.input.file, start: 0, end: 0 };
        match self.package {
            None => self.parse(self.input.bytes, self.input.file, name, at),
            Some(_) => self.layer(name, at),
        }
    }

    /// Reads a layer by its name relative to the scene's folder or to the package.
    pub fn layer(&self, name: &str, at: Span) -> Option<Layer> {
        let (bytes, file) = match &self.package {
            None => read_named(self.input, self.report, "the layer", name, at)?,
            Some(_) => {
                let bytes = self.part(name, at)?;
                let file = self.input.files.borrow_mut().add(name, bytes.clone());
                (bytes, file)
            }
        };
        self.limits.add_input(bytes.len());
        self.parse(&bytes, file, name, at)
    }

    /// Returns a part of the package.
    fn part(&self, name: &str, at: Span) -> Option<Arc<[u8]>> {
        let package = self.package.as_ref()?;
        match package.borrow_mut().part(name) {
            Some(Ok(bytes)) => Some(bytes.into()),
            Some(Err(error)) => {
                self.report.error(at, format!("`{name}` in the package is damaged: {error}"));
                None
            }
            None => {
                let missing = Diagnostic::error(format!("the package contains no file `{name}`"));
                self.report.push(missing.code("missing-file").at(at));
                None
            }
        }
    }

    /// Returns the bytes of a picture, or its file name. The name of a picture in a package begins
    /// with the name of the package.
    pub fn picture(&self, name: &str, at: Span) -> Option<PictureBytes> {
        match &self.package {
            None => Some(PictureBytes::File(name.to_string())),
            Some(_) => {
                let bytes = self.part(name, at)?;
                self.limits.count_bytes_or_report(bytes.len(), 1, self.report, at).then_some(())?;
                Some(PictureBytes::Memory(format!("{}/{name}", self.input.name), bytes))
            }
        }
    }

    /// Returns a reader of pictures, which decodes them.
    pub fn pictures(&self) -> Pictures<'_> {
        Pictures { input: self.input, report: self.report }
    }

    fn parse(&self, bytes: &Arc<[u8]>, file: u32, name: &str, at: Span) -> Option<Layer> {
        if bytes.starts_with(binary::MAGIC) {
            let layer = binary::read(bytes, file, name, self.time.get(), self.limits);
            // Positions in a binary file help nobody.
            return layer.map_err(|error| self.report.error(at, format!("`{name}` cannot be read: {error}"))).ok();
        }
        match std::str::from_utf8(bytes) {
            Ok(source) if source.trim_start().starts_with("#usda") || source.trim_start().starts_with("#sdf") => {
                // A number or word takes at least two bytes, and about 40 bytes of memory.
                self.limits.count_bytes_or_report(source.len(), 20, self.report, at).then_some(())?;
                let layer = text::parse(source, file, name);
                layer
                    .map_err(|error| self.report.push(Diagnostic::error(error.message).code("syntax").at(error.at)))
                    .ok()
            }
            _ => {
                let message = format!("`{name}` is not a USD file: it begins with neither `#usda` nor `PXR-USDC`");
                self.report.push(Diagnostic::error(message).code("bad-file").at(at));
                None
            }
        }
    }
}

/// True if the extension of a file name is one of USD's.
fn is_layer(name: &str) -> bool {
    matches!(crate::extension(name).as_str(), "usd" | "usda" | "usdc")
}

#[cfg(test)]
mod tests {
    use super::joined;

    #[test]
    fn names_are_relative_to_their_layer() {
        let all = [("a.usda", "b.usd"), ("x/a.usda", "./b.usd"), ("x/y/a.usda", "../b.png"), ("a.usda", "../b.usd")];
        let joined = all.map(|(layer, asset)| joined(layer, asset));
        assert_eq!(joined, ["b.usd", "x/b.usd", "x/b.png", "../b.usd"]);
    }
}
