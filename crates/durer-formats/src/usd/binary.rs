//! Reader of USD binary files (`.usdc`): the tables of tokens, fields, paths and specs.
//!
//! Source: *OpenUSD specification*, "USDC file format", versions 0.4 to 0.13.

use super::binary_values::{Cursor, Decoded, Tables};
use super::codec::decompress;
use super::layer::{Layer, PrimSpec, Property, Specifier, Value, child_path};
use super::time::SampleTime;
use crate::growth::ResourceLimits;
use durer_diag::Span;
use std::collections::BTreeMap;

/// First bytes of a binary file.
pub(super) const MAGIC: &[u8] = b"PXR-USDC";

/// Oldest and newest minor version that is supported (of major version 0).
const VERSIONS: std::ops::RangeInclusive<u8> = 4..=13;

/// Maximum nesting depth of prims.
const MAX_DEPTH: usize = 256;

/// Kinds of specs in a file.
const ATTRIBUTE: i32 = 1;
const PRIM: i32 = 6;
const PSEUDO_ROOT: i32 = 7;
const RELATIONSHIP: i32 = 8;
const VARIANT: i32 = 10;
const VARIANT_SET: i32 = 11;

/// Fields of prims that are read. Of the pseudo-root, all fields are read.
const PRIM_FIELDS: [&str; 12] = [
    "specifier",
    "typeName",
    "primChildren",
    "references",
    "payload",
    "inheritPaths",
    "specializes",
    "apiSchemas",
    "variantSetNames",
    "variantSelection",
    "active",
    "instanceable",
];

/// Reads a binary file. `time` selects the samples of attributes that change over time.
pub(super) fn read(
    bytes: &[u8],
    file: u32,
    name: &str,
    time: SampleTime,
    limits: &ResourceLimits,
) -> Result<Layer, String> {
    const SHORT: &str = "the file ends too early";
    let version = *bytes.get(9).ok_or(SHORT)?;
    if bytes[8] != 0 || !VERSIONS.contains(&version) {
        return Err(format!(
            "version {}.{version} of the binary format is not supported, only 0.{} to 0.{}",
            bytes[8],
            VERSIONS.start(),
            VERSIONS.end()
        ));
    }
    let mut tables = Tables { bytes, version, tokens: Vec::new(), strings: Vec::new(), paths: Vec::new(), limits };
    let sections = sections(&tables)?;
    let section = |name: &str| {
        let start = *sections.get(name).ok_or_else(|| format!("the section {name} is missing"))?;
        Ok::<_, String>(Cursor::new(bytes, start))
    };
    tables.tokens = tokens(section("TOKENS")?)?;
    let mut at = section("STRINGS")?;
    let count = at.count(4)?;
    tables.strings = (0..count).map(|_| at.u32()).collect::<Result<_, _>>()?;

    let mut at = section("FIELDS")?;
    let count = at.count(0)?;
    let names = at.compressed_integers(count)?;
    let packed = at.sized()?;
    let values = decompress(packed, 8 * count)?;
    let fields: Vec<(&str, u64)> = names
        .iter()
        .zip(values.as_chunks::<8>().0)
        .map(|(name, value)| Ok((tables.token(*name)?, u64::from_le_bytes(*value))))
        .collect::<Result<_, String>>()?;

    let mut at = section("FIELDSETS")?;
    let count = at.count(0)?;
    let sets = at.compressed_integers(count)?;

    let mut at = section("PATHS")?;
    let paths = paths(&mut at, &tables)?;
    let fields: Vec<(String, u64)> = fields.into_iter().map(|(name, value)| (name.to_string(), value)).collect();
    tables.paths = paths;

    let mut at = section("SPECS")?;
    let count = at.count(0)?;
    let of_paths = at.compressed_integers(count)?;
    let of_sets = at.compressed_integers(count)?;
    let kinds = at.compressed_integers(count)?;
    let mut builder =
        Builder { layer: Layer { name: name.to_string(), is_binary: true, ..Layer::default() }, file, time };
    for ((path, set), kind) in of_paths.iter().zip(&of_sets).zip(&kinds) {
        let path = tables.paths.get(*path as usize).ok_or("a spec has an invalid path")?;
        let tail = sets.get(*set as usize..).ok_or("a spec has an invalid set of fields")?;
        let own = tail.iter().take_while(|field| **field >= 0);
        let own: Vec<&(String, u64)> =
            own.map(|field| fields.get(*field as usize).ok_or("a field is invalid")).collect::<Result<_, _>>()?;
        builder.add(&tables, path, *kind, &own)?;
    }
    Ok(builder.layer)
}

/// Returns the offset of each section.
fn sections(tables: &Tables) -> Result<BTreeMap<String, usize>, String> {
    let start = Cursor::new(tables.bytes, 16).u64()?;
    let mut at = Cursor::new(tables.bytes, usize::try_from(start).unwrap_or(usize::MAX));
    let count = at.count(32)?;
    let mut sections = BTreeMap::new();
    for _ in 0..count {
        let name = at.take(16)?;
        let name = String::from_utf8_lossy(name.split(|byte| *byte == 0).next().unwrap_or_default()).into_owned();
        let start = at.u64()?;
        at.u64()?;
        sections.insert(name, usize::try_from(start).unwrap_or(usize::MAX));
    }
    Ok(sections)
}

fn tokens(mut at: Cursor) -> Result<Vec<String>, String> {
    let count = at.count(0)?;
    let size = at.count(0)?;
    let plain = decompress(at.sized()?, size)?;
    let tokens: Vec<String> =
        plain.split(|byte| *byte == 0).take(count).map(|token| String::from_utf8_lossy(token).into_owned()).collect();
    match tokens.len() == count {
        true => Ok(tokens),
        false => Err("tokens are missing".into()),
    }
}

/// Rebuilds the paths, which are stored as a tree of name tokens.
fn paths(at: &mut Cursor, tables: &Tables) -> Result<Vec<String>, String> {
    // Some paths, such as the empty path, are not part of the tree.
    let (total, count) = (at.count(0)?, at.count(0)?);
    let numbers = at.compressed_integers(count)?;
    let names = at.compressed_integers(count)?;
    let jumps = at.compressed_integers(count)?;
    let mut paths = vec![String::new(); total];
    // Entries that are still to be visited, each with its parent's path and depth. An entry is
    // visited once, so that damaged jumps cannot repeat parts of the tree.
    let mut stack = vec![(0, String::new(), 0)];
    let mut left = count;
    while let Some((start, parent, depth)) = stack.pop() {
        let (mut entry, mut parent, mut depth) = (start, parent, depth);
        loop {
            if left == 0 || depth > MAX_DEPTH {
                return Err("the tree of paths is damaged, or too deep".into());
            }
            left -= 1;
            let (number, name, jump) = match (numbers.get(entry), names.get(entry), jumps.get(entry)) {
                (Some(number), Some(name), Some(jump)) => (*number as usize, *name, *jump),
                _ => return Err("the tree of paths is damaged".into()),
            };
            let path = match (depth, name < 0) {
                (0, _) => "/".to_string(),
                (_, true) => format!("{parent}.{}", tables.token(name.saturating_neg())?),
                (_, false) => {
                    let token = tables.token(name)?;
                    match token.starts_with('{') {
                        true => format!("{parent}{token}"),
                        false => child_path(&parent, token),
                    }
                }
            };
            if tables.limits.bytes(path.len(), 2).is_err() {
                return Err("its paths need too much memory".into());
            }
            paths.get_mut(number).ok_or("a path is invalid")?.clone_from(&path);
            let (has_child, has_sibling) = (jump > 0 || jump == -1, jump >= 0);
            if has_child && has_sibling {
                stack.push((entry + jump as usize, parent.clone(), depth));
            }
            match (has_child, has_sibling) {
                (true, _) => (parent, depth) = (path, depth + 1),
                (false, true) => {}
                (false, false) => break,
            }
            entry += 1;
        }
    }
    Ok(paths)
}

/// Collects the specs of a file as a layer.
struct Builder {
    layer: Layer,
    file: u32,
    time: SampleTime,
}

impl Builder {
    fn add(&mut self, tables: &Tables, path: &str, kind: i32, fields: &[&(String, u64)]) -> Result<(), String> {
        match kind {
            PRIM | PSEUDO_ROOT | VARIANT => {
                let mut prim = PrimSpec { span: Span { file: self.file, start: 0, end: 0 }, ..PrimSpec::default() };
                for (name, value) in fields {
                    self.prim_field(tables, &mut prim, path, name, *value)?;
                }
                // A property of the prim may have been read before.
                let known = self.layer.prims.entry(path.to_string()).or_default();
                prim.properties = std::mem::take(&mut known.properties);
                prim.variants = std::mem::take(&mut known.variants);
                *known = prim;
            }
            ATTRIBUTE | RELATIONSHIP => {
                let Some((prim, name)) = path.rsplit_once('.') else { return Ok(()) };
                let mut property = Property { span: Span { file: self.file, start: 0, end: 0 }, ..Property::default() };
                for (field, value) in fields {
                    self.property_field(tables, &mut property, field, *value)?;
                }
                let prim = self.layer.prims.entry(prim.to_string()).or_default();
                prim.properties.insert(name.to_string(), property);
            }
            VARIANT_SET => {
                // The path is that of the prim followed by `{set=}`.
                let Some((prim, set)) = path.rsplit_once('{') else { return Ok(()) };
                let set = set.trim_end_matches('}').trim_end_matches('=').to_string();
                let names = fields.iter().find(|(name, _)| name == "variantChildren");
                let names = names.map(|(_, value)| tables.decode(*value)).transpose()?;
                if let Some(Decoded::Value(Value::Texts(names))) = names {
                    self.layer.prims.entry(prim.to_string()).or_default().variants.insert(set, names);
                }
            }
            _ => {}
        }
        Ok(())
    }

    fn prim_field(
        &self,
        tables: &Tables,
        prim: &mut PrimSpec,
        path: &str,
        name: &str,
        value: u64,
    ) -> Result<(), String> {
        if path != "/" && !PRIM_FIELDS.contains(&name) {
            return Ok(());
        }
        match (name, tables.decode(value)?) {
            ("specifier", Decoded::Value(Value::Number(number))) => {
                prim.specifier = match number as u8 {
                    0 => Specifier::Def,
                    1 => Specifier::Over,
                    _ => Specifier::Class,
                };
            }
            ("typeName", Decoded::Value(value)) => prim.type_name = value.text().unwrap_or_default().to_string(),
            ("primChildren", Decoded::Value(Value::Texts(children))) => prim.children = children,
            ("references", Decoded::References(edit)) => prim.references = edit,
            ("payload", Decoded::References(edit)) => prim.payloads = edit,
            ("inheritPaths", Decoded::Texts(edit)) => prim.inherits = edit,
            ("specializes", Decoded::Texts(edit)) => prim.specializes = edit,
            ("apiSchemas", Decoded::Texts(edit)) => prim.api_schemas = edit,
            ("variantSetNames", Decoded::Texts(edit)) => prim.variant_sets = edit,
            ("variantSelection", Decoded::Value(Value::Dictionary(chosen))) => {
                prim.selections =
                    chosen.into_iter().filter_map(|(set, v)| Some((set, v.text()?.to_string()))).collect();
            }
            (_, Decoded::Value(value)) => {
                prim.metadata.insert(name.to_string(), value);
            }
            _ => {}
        }
        Ok(())
    }

    fn property_field(&self, tables: &Tables, property: &mut Property, field: &str, value: u64) -> Result<(), String> {
        match field {
            "default" => {
                if let Decoded::Value(value) = tables.decode(value)? {
                    property.value = Some(value);
                }
            }
            "timeSamples" => property.samples = tables.samples(value, self.time)?,
            "targetPaths" | "connectionPaths" => {
                if let Decoded::Texts(edit) = tables.decode(value)? {
                    property.targets = edit;
                }
            }
            "interpolation" | "elementSize" => {
                if let Decoded::Value(value) = tables.decode(value)? {
                    property.metadata.insert(field.to_string(), value);
                }
            }
            _ => {}
        }
        Ok(())
    }
}
