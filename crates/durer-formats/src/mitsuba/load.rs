//! Converts XML to plugins, and handles variables, included files and values.
//!
//! Source: *Mitsuba 3 documentation*, section "Scene XML file format", versions of 2022 to 2025.
//! Property names of Mitsuba 0.6 (`toWorld`) are converted to current names (`to_world`).

use super::plugin::{Plugin, Property, Value};
use crate::growth::ResourceLimits;
use crate::model::ReadInput;
use crate::shared_report::{SharedReport, suggest};
use crate::xml::{Attribute, Event, Tag, Xml, utf8};
use durer_diag::{Diagnostic, Span};
use durer_image::{decode_hexadecimal, decode_srgb};
use durer_scene::math::Vec3;
use durer_scene::source::SourceError;
use glam::DVec3;
use std::cell::Cell;
use std::collections::BTreeMap;
use std::rc::Rc;
use std::sync::Arc;

/// Limits on the depth of nested includes, the number of files and the number of elements.
const MAX_INCLUDE_DEPTH: usize = 15;
const MAX_FILES: usize = 4096;
const MAX_ELEMENTS: usize = 1 << 22;
/// Maximum size of a value in bytes after variables have been substituted.
const MAX_VALUE: usize = 1 << 20;

/// Element names that define plugins. The name `camera` is from Mitsuba 0.6.
const CLASSES: [&str; 14] = [
    "scene",
    "sensor",
    "film",
    "sampler",
    "integrator",
    "rfilter",
    "shape",
    "bsdf",
    "texture",
    "emitter",
    "medium",
    "phase",
    "volume",
    "camera",
];
/// Names of other elements.
const OTHER_ELEMENTS: [&str; 15] = [
    "float",
    "integer",
    "boolean",
    "string",
    "vector",
    "point",
    "rgb",
    "srgb",
    "spectrum",
    "transform",
    "ref",
    "default",
    "include",
    "alias",
    "path",
];

/// Loader that converts the XML of a Mitsuba scene and of its included files to plugins.
pub(super) struct Loader<'a> {
    input: &'a ReadInput<'a>,
    pub(super) report: &'a SharedReport,
    variables: BTreeMap<String, String>,
    /// Plugins by their ids.
    pub plugins: BTreeMap<String, Rc<Plugin>>,
    /// Additional folders that are searched for files.
    pub folders: Vec<String>,
    /// Names of the files that are being read, starting with the outermost one.
    open_files: Vec<String>,
    files: usize,
    elements: usize,
    pub limits: ResourceLimits,
    /// True if the file was written for a version before Mitsuba 2.
    pub(super) is_old: bool,
}

/// Error that ends loading and that has already been reported.
pub(super) struct ErrorReported;

/// Converts a name to snake case, for example `toWorld` to `to_world` and `intIOR` to `int_ior`.
fn snake_case(name: &str) -> String {
    let mut words = String::new();
    let mut small = false;
    for c in name.chars() {
        if c.is_ascii_uppercase() && small {
            words.push('_');
        }
        small = c.is_ascii_lowercase() || c.is_ascii_digit();
        words.push(c.to_ascii_lowercase());
    }
    words
}

/// Parses numbers that are separated by whitespace or commas.
pub(super) fn numbers(text: &str) -> Option<Vec<f64>> {
    let words = text.split(|c: char| c.is_whitespace() || c == ',').filter(|word| !word.is_empty());
    words.map(|word| word.parse::<f64>().ok().filter(|x| (*x as f32).is_finite())).collect()
}

impl<'a> Loader<'a> {
    pub fn new(input: &'a ReadInput<'a>, report: &'a SharedReport) -> Self {
        Loader {
            input,
            report,
            variables: BTreeMap::new(),
            plugins: BTreeMap::new(),
            folders: Vec::new(),
            open_files: Vec::new(),
            files: 0,
            elements: 0,
            limits: ResourceLimits::of_file(input.bytes.len(), input.memory),
            is_old: false,
        }
    }

    /// Loads the scene from the main file. If the root element is not `<scene>`, it becomes the
    /// only child of a scene.
    pub fn scene(&mut self) -> Result<Plugin, ErrorReported> {
        let at = Span { file: self.input.file, start: 0, end: 0 };
        let mut scene = Plugin::new("scene", String::new(), at);
        let (bytes, name) = (self.input.bytes.clone(), self.input.name.to_string());
        self.file(&bytes, self.input.file, name, &mut scene)?;
        Ok(scene)
    }

    fn file(&mut self, bytes: &Arc<[u8]>, file: u32, name: String, scene: &mut Plugin) -> Result<(), ErrorReported> {
        self.open_files.push(name);
        let report = self.report;
        let broken = |error: Box<Diagnostic>| {
            report.push(*error);
            ErrorReported
        };
        let mut xml = Xml::new(bytes, file).map_err(broken)?;
        while let Event::Open(tag) = xml.next().map_err(broken)? {
            match tag.name {
                "scene" => {
                    self.is_old |= tag.get("version").is_some_and(|version| version.value.starts_with("0."));
                    self.children(&mut xml, scene)?;
                }
                _ => self.child(&mut xml, &tag, scene)?,
            }
        }
        self.open_files.pop();
        Ok(())
    }

    /// Returns the next child element, or `None` at the end of the current element.
    fn next<'x>(&mut self, xml: &mut Xml<'x>) -> Result<Option<Tag<'x>>, ErrorReported> {
        self.elements += 1;
        match xml.next() {
            Ok(Event::Open(tag)) if self.elements <= MAX_ELEMENTS && !self.report.is_full() => Ok(Some(tag)),
            Ok(Event::Open(tag)) => {
                if !self.report.is_full() {
                    self.report.error(tag.at, format!("the scene has more than {MAX_ELEMENTS} elements"));
                }
                Err(ErrorReported)
            }
            Ok(_) => Ok(None),
            Err(error) => {
                self.report.push(*error);
                Err(ErrorReported)
            }
        }
    }

    /// Skips the content of an element, and reports any child elements.
    fn leaf(&mut self, xml: &mut Xml, of: &str) -> Result<(), ErrorReported> {
        while let Some(tag) = self.next(xml)? {
            self.report.error(tag.at, format!("`<{of}>` cannot contain other elements"));
            self.skip(xml)?;
        }
        Ok(())
    }

    fn skip(&mut self, xml: &mut Xml) -> Result<(), ErrorReported> {
        let mut depth = 1;
        while depth > 0 {
            match self.next(xml)? {
                Some(_) => depth += 1,
                None => depth -= 1,
            }
        }
        Ok(())
    }

    fn children(&mut self, xml: &mut Xml, parent: &mut Plugin) -> Result<(), ErrorReported> {
        while let Some(tag) = self.next(xml)? {
            self.child(xml, &tag, parent)?;
        }
        Ok(())
    }

    /// Reads a child element of a plugin.
    fn child(&mut self, xml: &mut Xml, tag: &Tag, parent: &mut Plugin) -> Result<(), ErrorReported> {
        match tag.name {
            "default" => self.default(tag),
            "include" => self.include(tag, parent)?,
            "path" => {
                if let Some((folder, _)) = self.attribute(tag, "value") {
                    self.folders.push(folder);
                }
            }
            "alias" => self.alias(tag),
            "transform" => {
                let transform = self.transform(xml)?;
                if let Some(name) = self.name(tag) {
                    self.add_property(parent, name, Value::Transform(transform), tag.at);
                }
                return Ok(());
            }
            "ref" => {
                let name = tag.get("name").map(|name| snake_case(&name.value)).unwrap_or_default();
                if let Some((id, at)) = self.attribute(tag, "id") {
                    self.add_property(parent, name, Value::Ref(id), at);
                }
            }
            class if CLASSES.contains(&class) => return self.plugin(xml, tag, parent),
            // A spectrum can be a number, a list of numbers or a plugin.
            "spectrum" if tag.get("type").is_some() => return self.plugin(xml, tag, parent),
            kind if OTHER_ELEMENTS.contains(&kind) => {
                if let (Some(name), Some((value, at))) = (self.name(tag), self.value(tag)) {
                    self.add_property(parent, name, value, at);
                    if let (Some(own), Some(last)) = (tag.get("name"), parent.properties.last_mut()) {
                        last.written = Some((own.value.to_string(), own.at));
                    }
                }
            }
            other => {
                let help = suggest(other, CLASSES.into_iter().chain(OTHER_ELEMENTS));
                self.report.error_with_help(tag.at, format!("unknown element `<{other}>`"), help);
                return self.skip(xml);
            }
        }
        self.leaf(xml, tag.name)
    }

    fn plugin(&mut self, xml: &mut Xml, tag: &Tag, parent: &mut Plugin) -> Result<(), ErrorReported> {
        let class = match tag.name {
            "camera" => "sensor",
            "spectrum" => "texture",
            name => name,
        };
        let Some((kind, at)) = self.attribute(tag, "type") else { return self.skip(xml) };
        let name = tag.get("name").map(|name| snake_case(&name.value)).unwrap_or_default();
        let id = tag.get("id").and_then(|id| Some((self.substituted(id)?, id.at)));
        let mut plugin = Plugin::new(class, kind, at);
        self.children(xml, &mut plugin)?;
        let plugin = Rc::new(plugin);
        if let Some((id, at)) = id {
            self.register(id, at, plugin.clone());
        }
        parent.properties.push(Property {
            name,
            value: Value::Plugin(plugin),
            at,
            written: None,
            used: Cell::default(),
        });
        Ok(())
    }

    fn register(&mut self, id: String, at: Span, plugin: Rc<Plugin>) {
        if let Some(other) = self.plugins.get(&id) {
            let error = Diagnostic::error(format!("the id `{id}` is given twice")).code("bad-value").at(at);
            return self.report.push(error.related(other.at, "the first one is here"));
        }
        self.plugins.insert(id, plugin);
    }

    fn alias(&mut self, tag: &Tag) {
        let (Some((id, at)), Some((other, other_at))) = (self.attribute(tag, "id"), self.attribute(tag, "as")) else {
            return;
        };
        match self.plugins.get(&id).cloned() {
            Some(plugin) => self.register(other, other_at, plugin),
            None => {
                let help = suggest(&id, self.plugins.keys().map(String::as_str));
                self.report.error_with_help(at, format!("no plugin has the id `{id}` before this point"), help);
            }
        }
    }

    /// Adds a property, and reports an error if there is already one with the same name.
    fn add_property(&self, parent: &mut Plugin, name: String, value: Value, at: Span) {
        if let Some(other) = parent.properties.iter().find(|other| !name.is_empty() && other.name == name) {
            let error = Diagnostic::error(format!("`{name}` is given twice")).code("bad-value").at(at);
            return self.report.push(error.related(other.at, "the first one is here"));
        }
        parent.properties.push(Property { name, value, at, written: None, used: Cell::default() });
    }

    fn default(&mut self, tag: &Tag) {
        let (Some((name, _)), Some((value, _))) = (self.attribute(tag, "name"), self.attribute(tag, "value")) else {
            return;
        };
        // The first value takes effect, so that an including file can override the file that it
        // includes.
        self.variables.entry(name).or_insert(value);
    }

    fn include(&mut self, tag: &Tag, parent: &mut Plugin) -> Result<(), ErrorReported> {
        let Some((name, at)) = self.attribute(tag, "filename") else { return Ok(()) };
        self.files += 1;
        let refused = if self.open_files.contains(&name) {
            Some(format!("`{name}` includes itself"))
        } else if self.open_files.len() > MAX_INCLUDE_DEPTH {
            Some(format!("includes are nested more than {MAX_INCLUDE_DEPTH} levels deep"))
        } else if self.files > MAX_FILES {
            Some(format!("more than {MAX_FILES} files are included"))
        } else {
            None
        };
        if let Some(message) = refused {
            self.report.error(at, message);
            return Err(ErrorReported);
        }
        let bytes = match self.input.source.read(&self.path(&name)) {
            Ok(bytes) if bytes.len() < u32::MAX as usize => utf8(bytes),
            Ok(_) => {
                self.report.error(at, format!("`{name}` is too large"));
                return Ok(());
            }
            Err(error) => {
                self.missing(&error, at);
                return Ok(());
            }
        };
        self.limits.add_input(bytes.len());
        let file = self.input.files.borrow_mut().add(name.clone(), bytes.clone());
        self.file(&bytes, file, name, parent)
    }

    /// Reports a file that cannot be read.
    fn missing(&self, error: &SourceError, at: Span) {
        let help = error.help();
        self.report.push(Diagnostic { help, ..Diagnostic::error(error.to_string()).code("missing-file").at(at) });
    }

    /// Returns the path of a file, which is in the scene's folder or in a folder added by `<path>`.
    pub fn path(&self, name: &str) -> String {
        let source = self.input.source;
        let others = self.folders.iter().map(|folder| format!("{folder}/{name}"));
        others.into_iter().find(|path| !source.contains(name) && source.contains(path)).unwrap_or(name.into())
    }

    /// Returns the value of a required attribute after substituting its variables.
    pub fn attribute(&self, tag: &Tag, name: &str) -> Option<(String, Span)> {
        match tag.get(name) {
            Some(attribute) => Some((self.substituted(attribute)?, attribute.at)),
            None => {
                self.report.error(tag.at, format!("`<{}>` needs `{name}=\"...\"`", tag.name));
                None
            }
        }
    }

    fn name(&self, tag: &Tag) -> Option<String> {
        self.attribute(tag, "name").map(|(name, _)| snake_case(&name))
    }

    /// Returns a value after substituting its variables. If several variable names match, the
    /// longest one is used. Reports an undefined variable and returns `None`.
    pub fn substituted(&self, attribute: &Attribute) -> Option<String> {
        let mut text = String::new();
        let mut rest: &str = &attribute.value;
        while let Some(at) = rest.find('$') {
            text.push_str(&rest[..at]);
            rest = &rest[at + 1..];
            let variable = self.variables.iter().rev().find(|(name, _)| rest.starts_with(name.as_str()));
            match variable {
                Some((name, value)) => {
                    if text.len() + value.len() > MAX_VALUE {
                        let message =
                            format!("this value is longer than {MAX_VALUE} bytes after its variables are replaced");
                        self.report.error(attribute.at, message);
                        return None;
                    }
                    if !self.limits.count_bytes_or_report(value.len(), 1, self.report, attribute.at) {
                        return None;
                    }
                    text.push_str(value);
                    rest = &rest[name.len()..];
                }
                None => {
                    let end = rest.find(|c: char| !c.is_alphanumeric() && c != '_').unwrap_or(rest.len());
                    let word = &rest[..end];
                    let help = suggest(word, self.variables.keys().map(String::as_str));
                    let help = help.or_else(|| Some(format!("write `<default name=\"{word}\" value=\"...\"/>`")));
                    self.report.error_with_help(attribute.at, format!("the variable `${word}` is undefined"), help);
                    return None;
                }
            }
        }
        Some(text + rest)
    }

    /// Parses `N` numbers from an attribute.
    pub fn numbers<const N: usize>(&self, (text, at): &(String, Span)) -> Option<[f64; N]> {
        let variable = numbers(text).and_then(|all| <[f64; N]>::try_from(all).ok());
        if variable.is_none() {
            let what = if N == 1 { "a number".into() } else { format!("{N} numbers") };
            self.report.error(*at, format!("expected {what}, found `{text}`"));
        }
        variable
    }

    /// Reads three coordinates, given as `x`, `y` and `z`, or all together as `value`.
    pub fn triple(&self, tag: &Tag, default: f64) -> Option<DVec3> {
        if let Some(value) = tag.get("value") {
            return self.numbers(&(self.substituted(value)?, value.at)).map(DVec3::from_array);
        }
        let mut triple = [default; 3];
        for (axis, name) in triple.iter_mut().zip(["x", "y", "z"]) {
            if let Some(attribute) = tag.get(name) {
                [*axis] = self.numbers(&(self.substituted(attribute)?, attribute.at))?;
            }
        }
        Some(DVec3::from_array(triple))
    }

    fn value(&self, tag: &Tag) -> Option<(Value, Span)> {
        if matches!(tag.name, "vector" | "point") {
            return self.triple(tag, 0.0).map(|vector| (Value::Vector(vector), tag.at));
        }
        if let ("spectrum", Some(_)) = (tag.name, tag.get("filename")) {
            let (name, at) = self.attribute(tag, "filename")?;
            let bytes = self.input.source.read(&self.path(&name)).map_err(|error| self.missing(&error, at)).ok()?;
            let text = String::from_utf8_lossy(&bytes);
            let lines: Vec<&str> = text.lines().map(|line| line.split('#').next().unwrap_or("")).collect();
            let all = numbers(&lines.join(" ")).filter(|all| all.len() > 1 && all.len() % 2 == 0);
            let Some(all) = all else {
                self.report.error(at, format!("`{name}` must contain pairs of wavelength and value"));
                return None;
            };
            return self.curve(all, at).map(|curve| (curve, at));
        }
        let attribute = self.attribute(tag, "value")?;
        let at = attribute.1;
        let value = match tag.name {
            "float" => self.numbers(&attribute).map(|[number]| Value::Number(number)),
            "integer" => {
                let number = attribute.0.trim().parse::<i64>().ok();
                if number.is_none() {
                    self.report.error(at, format!("expected an integer, found `{}`", attribute.0));
                }
                number.map(|number| Value::Number(number as f64))
            }
            "boolean" => match attribute.0.trim().to_lowercase().as_str() {
                "true" => Some(Value::Bool(true)),
                "false" => Some(Value::Bool(false)),
                _ => {
                    self.report.error(at, format!("expected `true` or `false`, found `{}`", attribute.0));
                    None
                }
            },
            "string" => Some(Value::Text(attribute.0)),
            "rgb" | "srgb" => self.rgb(&attribute, tag.name == "srgb").map(Value::Rgb),
            _ => self.spectrum(&attribute),
        };
        value.map(|value| (value, at))
    }

    /// Parses three numbers, a single number for all three, or a colour `#rrggbb` in sRGB.
    fn rgb(&self, attribute: &(String, Span), curved: bool) -> Option<Vec3> {
        let text = attribute.0.trim();
        if let Some(color) = decode_hexadecimal(text) {
            return Some(color.into());
        }
        let color = match numbers(text).as_deref() {
            Some([one]) => Vec3::splat(*one as f32),
            Some(&[r, g, b]) => DVec3::new(r, g, b).as_vec3(),
            _ => {
                self.report.error(attribute.1, format!("expected three numbers, found `{}`", attribute.0));
                return None;
            }
        };
        Some(if curved { color.map(|share| decode_srgb((255.0 * share).round() as u8)) } else { color })
    }

    /// Parses a number, or pairs of a wavelength and a value, such as `400:0.1, 500:0.2`.
    fn spectrum(&self, attribute: &(String, Span)) -> Option<Value> {
        if !attribute.0.contains(':') {
            return match numbers(&attribute.0).as_deref() {
                // In Mitsuba 0.6, the value can also be a colour.
                Some(&[r, g, b]) => Some(Value::Rgb(DVec3::new(r, g, b).as_vec3())),
                _ => self.numbers(attribute).map(|[number]| Value::ConstantSpectrum(number as f32)),
            };
        }
        let all = numbers(&attribute.0.replace(':', " ")).filter(|all| all.len() % 2 == 0);
        let Some(all) = all else {
            self.report.error(attribute.1, format!("expected pairs `wavelength:value`, found `{}`", attribute.0));
            return None;
        };
        self.curve(all, attribute.1)
    }

    fn curve(&self, all: Vec<f64>, at: Span) -> Option<Value> {
        let curve: Vec<[f32; 2]> = all.chunks_exact(2).map(|pair| [pair[0] as f32, pair[1] as f32]).collect();
        if let Some(pair) = curve.windows(2).find(|pair| pair[1][0] <= pair[0][0]) {
            let message =
                format!("the wavelengths of a spectrum must increase: {} comes after {}", pair[1][0], pair[0][0]);
            self.report.error(at, message);
            return None;
        }
        Some(Value::Spectrum(curve))
    }

    /// Reports an error at an element.
    pub fn error(&self, at: Span, message: impl Into<String>, help: Option<String>) {
        self.report.error_with_help(at, message, help);
    }

    /// Warns that part of an element has no exact counterpart in Dürer.
    pub fn warn(&self, at: Span, message: &str) {
        self.report.unsupported_once(at, message);
    }

    /// Warns once about a value that is probably a mistake.
    pub fn warn_value(&self, at: Span, message: String) {
        self.report.warn_once("bad-value", at, message);
    }

    /// Returns the next element of a transform, and also consumes its end tag.
    pub fn next_leaf<'x>(&mut self, xml: &mut Xml<'x>) -> Result<Option<Tag<'x>>, ErrorReported> {
        let Some(tag) = self.next(xml)? else { return Ok(None) };
        self.leaf(xml, tag.name)?;
        Ok(Some(tag))
    }
}
