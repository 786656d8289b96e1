//! Access to the parts of a ZIP archive: finds the model part, and reads parts by their names.

use crate::files::percent_decoded;
use crate::model::ReadInput;
use crate::shared_report::{SharedReport, suggest};
use crate::xml::{Event, Xml, utf8};
use crate::zip::Zip;
use durer_diag::{Diagnostic, Span};
use std::sync::Arc;

/// Ending of the type of the relationship that marks the model part.
const MODEL: &str = "/3dmodel";
const RELATIONS: &str = "_rels/.rels";

/// An open 3MF archive, which finds and reads parts and reports errors.
pub(super) struct Package<'a> {
    pub input: &'a ReadInput<'a>,
    report: &'a SharedReport,
    zip: Zip<'a>,
    /// Name of the root model part.
    pub root: String,
}

impl<'a> Package<'a> {
    /// Opens an archive and finds its root model part.
    pub fn open(input: &'a ReadInput<'a>, report: &'a SharedReport) -> Option<Self> {
        let at = Span { file: input.file, start: 0, end: 0 };
        let zip = match Zip::open(input.bytes) {
            Ok(zip) => zip,
            Err(problem) => {
                report
                    .push(Diagnostic::error(format!("the archive cannot be read: {problem}")).code("bad-file").at(at));
                return None;
            }
        };
        let mut package = Package { input, report, zip, root: String::new() };
        package.root = package.find_model(at)?;
        Some(package)
    }

    /// Returns the name of the model part, which is the target of the relationship or else the only
    /// part whose name ends in `.model`.
    fn find_model(&mut self, at: Span) -> Option<String> {
        let (mut roots, mut broken) = (Vec::new(), false);
        if let Some((bytes, file)) = self.part(RELATIONS, at) {
            let mut xml = match Xml::new(&bytes, file) {
                Ok(xml) => xml,
                Err(error) => {
                    self.report.push(*error);
                    return None;
                }
            };
            loop {
                match xml.next() {
                    Ok(Event::Open(tag)) if tag.name == "Relationship" => {
                        let kind = tag.get("Type").is_none_or(|kind| kind.value.ends_with(MODEL));
                        let Some(target) = tag.get("Target").filter(|_| kind) else { continue };
                        let name = target.value.trim_start_matches('/').to_string();
                        if name.to_lowercase().ends_with(".model") {
                            roots.push((name, target.at));
                        }
                    }
                    Ok(Event::End) => break,
                    Ok(_) => {}
                    Err(error) => {
                        self.report.push(*error);
                        broken = true;
                        break;
                    }
                }
            }
        }
        if let [_, (name, second), ..] = roots.as_slice() {
            let message = format!("an archive can have only one model, and `{name}` is the second");
            self.report.push(Diagnostic::error(message).code("bad-file").at(*second));
            return None;
        }
        if let Some((name, at)) = roots.into_iter().next() {
            if self.find_part(&name).is_none() {
                let help = suggest(&name, self.zip.names());
                self.report.error_with_help(at, format!("the archive has no part `{name}`"), help);
                return None;
            }
            return Some(name);
        }
        let models: Vec<&str> = self.zip.names().filter(|name| name.to_lowercase().ends_with(".model")).collect();
        match models.as_slice() {
            _ if broken => None,
            [only] => Some(only.to_string()),
            _ => {
                let message = "the archive has no model: it is not a 3MF file";
                self.report.push(Diagnostic::error(message).code("bad-file").at(at));
                None
            }
        }
    }

    /// Finds the name of a part in the archive; ignores letter case and decodes percent escapes.
    fn find_part(&self, name: &str) -> Option<String> {
        let plain = |name: &str| percent_decoded(name).unwrap_or_else(|| name.to_string()).to_lowercase();
        let same = |part: &&str| *part == name;
        let alike = |part: &&str| plain(part) == plain(name);
        self.zip.names().find(same).or_else(|| self.zip.names().find(alike)).map(str::to_string)
    }

    /// Returns the bytes of a part; reports an error if the part cannot be read.
    pub fn bytes(&mut self, name: &str, at: Span) -> Option<Arc<[u8]>> {
        let name = &self.find_part(name)?;
        match self.zip.part(name)? {
            Ok(bytes) => Some(bytes.into()),
            Err(problem) => {
                let message = format!("the part `{name}` cannot be read: {problem}");
                self.report.push(Diagnostic::error(message).code("bad-file").at(at));
                None
            }
        }
    }

    /// Reads a part that contains text and registers it as a file, so that spans can refer to it.
    pub fn part(&mut self, name: &str, at: Span) -> Option<(Arc<[u8]>, u32)> {
        let bytes = utf8(self.bytes(name, at)?);
        if bytes.len() >= u32::MAX as usize {
            self.report.error(at, format!("the part `{name}` is too large"));
            return None;
        }
        let file = self.input.files.borrow_mut().add(format!("{}/{name}", self.input.name), bytes.clone());
        Some((bytes, file))
    }
}
