//! The table of `durer compare --table`, which lists a scene and options for each picture.

use super::args::RenderingArgs;
use super::pairs::Pair;
use crate::failure::{Failure, invalid_input};
use clap::Parser;
use durer::format::folder::FolderSource;
use std::path::{Path, PathBuf};

/// Scenes and options of pictures, read from a file of comma-separated values.
pub struct ClassTable {
    rows: Vec<TableRow>,
}

/// Scene and options of one picture.
struct TableRow {
    /// File and line, for messages.
    at: String,
    /// Path of the picture, relative to the folder of references.
    picture: PathBuf,
    scene: Option<PathBuf>,
    options: Option<RenderingArgs>,
}

/// Options in a cell of the table, written as on the command line
#[derive(Parser)]
#[command(no_binary_name = true, disable_help_flag = true)]
struct RowOptions {
    #[command(flatten)]
    rendering: RenderingArgs,
}

impl ClassTable {
    /// Reads a table. Its first line names the columns: `picture`, `scene` and `options`.
    pub fn read(path: &Path, memory: u64) -> Result<Self, Failure> {
        let shown = path.to_string_lossy();
        let bytes = FolderSource::new(".").budget(memory).read_path(path, &shown);
        let bytes = bytes.map_err(|error| invalid_input(error.to_string()))?;
        let Ok(text) = std::str::from_utf8(&bytes) else {
            return Err(invalid_input(format!("`{shown}` is not UTF-8 text; save the table as CSV in UTF-8")));
        };
        let text = text.trim_start_matches('\u{feff}');
        let header = text.lines().next().unwrap_or_default();
        let delimiter = [',', ';', '\t'].into_iter().max_by_key(|&c| header.matches(c).count()).unwrap_or(',');
        let mut records = records(text, delimiter).into_iter();
        let columns: Vec<String> = records.next().map(|(_, cells)| cells).unwrap_or_default();
        let find = |name: &str| columns.iter().position(|cell| cell.eq_ignore_ascii_case(name));
        let (Some(picture), scene, options) = (find("picture"), find("scene"), find("options")) else {
            return Err(invalid_input(format!(
                "`{shown}` has no column `picture`; the first line names the columns `picture`, `scene` and `options`"
            )));
        };
        let folder = path.parent().unwrap_or(Path::new(""));
        let mut rows: Vec<TableRow> = Vec::new();
        for (line, cells) in records {
            let at = format!("{shown}:{line}");
            let cell = |column: Option<usize>| {
                column.and_then(|i| cells.get(i)).map(|cell| cell.trim()).filter(|cell| !cell.is_empty())
            };
            let Some(name) = cell(Some(picture)) else {
                if cells.iter().all(|cell| cell.trim().is_empty()) {
                    continue;
                }
                return Err(invalid_input(format!("{at}: the column `picture` is empty")));
            };
            if let Some(first) = rows.iter().find(|row| row.picture == Path::new(name)) {
                return Err(invalid_input(format!("{at}: the picture `{name}` is already in {}", first.at)));
            }
            let options = cell(options).map(|text| parsed(text, &at)).transpose()?;
            let scene = cell(scene).map(|scene| folder.join(scene));
            rows.push(TableRow { at, picture: name.into(), scene, options });
        }
        Ok(ClassTable { rows })
    }

    /// Returns an error if the table lists a picture that is not compared.
    pub fn check(&self, pairs: &[Pair]) -> Result<(), Failure> {
        match self.rows.iter().find(|row| !pairs.iter().any(|pair| row.is_for(pair))) {
            Some(TableRow { at, picture, .. }) => {
                let picture = picture.display();
                Err(invalid_input(format!("{at}: there is no reference picture `{picture}`; names must match")))
            }
            None => Ok(()),
        }
    }

    fn row(&self, pair: &Pair) -> Option<&TableRow> {
        self.rows.iter().find(|row| row.is_for(pair))
    }

    /// Returns the scene of a pair, if the table lists one.
    pub fn scene(&self, pair: &Pair) -> Option<&Path> {
        self.row(pair)?.scene.as_deref()
    }

    /// Returns the options of a pair, if the table lists any.
    pub fn options(&self, pair: &Pair) -> Option<&RenderingArgs> {
        self.row(pair)?.options.as_ref()
    }
}

impl TableRow {
    /// Returns true if the row is about the picture of a pair. The extension may be left out.
    fn is_for(&self, pair: &Pair) -> bool {
        let name = Path::new(&pair.name);
        self.picture == name || self.picture == name.with_extension("")
    }
}

/// Parses the options in a cell.
fn parsed(text: &str, at: &str) -> Result<RenderingArgs, Failure> {
    let Some(words) = shlex::split(text) else {
        return Err(invalid_input(format!("{at}: a quotation mark in `{text}` is not closed")));
    };
    match RowOptions::try_parse_from(words) {
        Ok(row) => Ok(row.rendering),
        Err(error) => {
            let text = error.render().to_string();
            let first = text.lines().next().unwrap_or_default().trim_start_matches("error: ");
            Err(invalid_input(format!("{at}: in the column `options`: {first}")))
        }
    }
}

/// Splits comma-separated values (RFC 4180) into records, each with the number of its first line.
fn records(text: &str, delimiter: char) -> Vec<(usize, Vec<String>)> {
    let mut records = Vec::new();
    let (mut line, mut first) = (1, 1);
    let (mut cells, mut cell, mut quoted) = (Vec::new(), String::new(), false);
    let mut chars = text.chars().peekable();
    while let Some(c) = chars.next() {
        line += usize::from(c == '\n');
        match c {
            '"' if quoted && chars.peek() == Some(&'"') => {
                chars.next();
                cell.push('"');
            }
            '"' if quoted || cell.is_empty() => quoted = !quoted,
            '\r' if !quoted => {}
            '\n' if !quoted => {
                cells.push(std::mem::take(&mut cell));
                records.push((first, std::mem::take(&mut cells)));
                first = line;
            }
            c if c == delimiter && !quoted => cells.push(std::mem::take(&mut cell)),
            c => cell.push(c),
        }
    }
    if !cell.is_empty() || !cells.is_empty() {
        cells.push(cell);
        records.push((first, cells));
    }
    records
}

#[cfg(test)]
mod tests {
    use super::records;

    #[test]
    fn records_have_quoted_cells_and_line_numbers() {
        let text = "picture,options\r\n\"a, b\",\"x \"\"y\"\"\nz\"\nc,";
        let cells = |cells: [&str; 2]| cells.map(String::from).to_vec();
        let wanted = [(1, cells(["picture", "options"])), (2, cells(["a, b", "x \"y\"\nz"])), (4, cells(["c", ""]))];
        assert_eq!(records(text, ','), wanted);
        assert_eq!(records("a;b\n", ';'), [(1, cells(["a", "b"]))]);
    }
}
