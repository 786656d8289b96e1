//! `cargo xtask manual`: writes the language reference with its pictures, and a grammar for
//! editors, from the descriptions in the code.

mod python;

use anyhow::{Context, Result, bail};
use durer::format::course::reference::{Chapter, Entry, Spelling, dialect_names, entries};
use std::fmt::Write;
use std::path::{Path, PathBuf};
use std::process::{Command, ExitCode};

const GENERATED: &str = "Written by `cargo xtask manual` from what the code states; a test holds it to that.";

/// Size of the example pictures in pixels.
const SIZE: &str = "240x180";

/// Runs `cargo xtask manual`.
pub fn run() -> Result<ExitCode> {
    for (path, text) in pages() {
        std::fs::create_dir_all(path.parent().context("a folder")?)?;
        std::fs::write(&path, text)?;
        println!("wrote {}", path.display());
    }
    let durer = crate::build::durer()?;
    std::fs::create_dir_all(pictures())?;
    for entry in entries() {
        let Some(scene) = entry.scene() else { continue };
        // Examples can refer to files in the `scenes` folder.
        let file = tempfile::Builder::new().suffix(".txt").tempfile_in(docs().join("../scenes"))?;
        std::fs::write(file.path(), scene)?;
        let picture = pictures().join(picture_name(&entry));
        let mut command = Command::new(&durer);
        command.arg("render").arg(file.path()).arg("-o").arg(&picture).args(["--dialect", "durer", "--size", SIZE]);
        let output = command.output()?;
        if !output.status.success() {
            bail!("the example of {} makes no picture: {}", entry.name(), String::from_utf8_lossy(&output.stderr));
        }
    }
    println!("wrote {}", pictures().display());
    Ok(ExitCode::SUCCESS)
}

fn docs() -> PathBuf {
    Path::new(env!("CARGO_MANIFEST_DIR")).join("../docs")
}

fn pictures() -> PathBuf {
    docs().join("language/pictures")
}

fn picture_name(entry: &Entry) -> String {
    let chapter = entry.chapter.title().to_lowercase();
    // Two entries can have the same keyword in different contexts, for example `Noise`.
    let kind = if entry.doc.contains("which replace the diffuse") { "-color" } else { "" };
    format!("{chapter}-{}{kind}.png", entry.name().to_lowercase())
}

/// Returns the texts to write, with their paths.
fn pages() -> Vec<(PathBuf, String)> {
    let folder = docs().join("language");
    let mut pages = vec![(folder.join("index.md"), index()), (docs().join("editors/durer.tmLanguage.json"), grammar())];
    pages.push((folder.join("scene.schema.json"), format!("{:#}\n", durer::format::json::schema::schema())));
    pages.push((docs().join("../crates/durer-py/python/durer/words.py"), python::words()));
    pages.extend(Chapter::ALL.map(|chapter| (folder.join(file_name(chapter)), page(chapter))));
    pages
}

fn file_name(chapter: Chapter) -> String {
    format!("{}.md", chapter.title().to_lowercase())
}

fn index() -> String {
    let mut out = format!(
        "# The scene language\n\n{GENERATED}\n\nA scene file has a camera, a background, lights, materials and a group of \
         objects, each a word and a block in braces:\n\n```\nPerspectiveCamera {{ center 0 1 8 direction 0 -0.1 -1 up 0 1 0 \
         angle 40 }}\nBackground {{ color 0.2 0.1 0.5 ambientLight 0.2 0.2 0.2 }}\nLights {{ DirectionalLight {{ direction -1 \
         -2 -1 color 0.9 0.9 0.8 }} }}\nMaterials {{ PhongMaterial {{ diffuseColor 0.8 0.3 0.2 }} }}\nGroup {{ MaterialIndex \
         0 Sphere {{ center 0 0.5 0 radius 1 }} }}\n```\n\nComments begin with `#`. Lengths are in the units of the scene, \
         angles in degrees, colours linear Rec.709 from 0 to 1 (and beyond). Words of the course's own years are marked with \
         their dialects; `durer dialects` explains these, `durer words WORD` tells what is here in a terminal. \
         `docs/editors/durer.tmLanguage.json` is a TextMate grammar that editors colour scenes with.\n\nThe same can be said \
         [as JSON](json.md).\n"
    );
    for chapter in Chapter::ALL {
        let words: Vec<String> = entries()
            .iter()
            .filter(|entry| entry.chapter == chapter)
            .map(|entry| format!("[{}]({}#{})", shown(entry.name()), file_name(chapter), anchor(entry.name())))
            .collect();
        let _ = write!(out, "\n**[{}]({})**: {}\n", chapter.title(), file_name(chapter), words.join(", "));
    }
    out
}

/// Escapes a name for Markdown, where `<Object>` would be parsed as HTML.
fn shown(name: &str) -> String {
    if name.contains('<') { format!("`{name}`") } else { name.into() }
}

/// Returns the anchor of a heading, computed as by GitHub and mdBook.
fn anchor(name: &str) -> String {
    name.to_lowercase().chars().filter(|c| c.is_alphanumeric() || *c == '_' || *c == '-').collect()
}

fn page(chapter: Chapter) -> String {
    let mut out = format!("# {}\n\n{GENERATED}\n", chapter.title());
    for entry in entries().into_iter().filter(|entry| entry.chapter == chapter) {
        // Writing to a String cannot fail.
        let _ = write!(out, "\n## {}\n\n{}\n\nWritten {}.\n", shown(entry.name()), entry.doc, spelled(&entry.keywords));
        if !entry.values.is_empty() {
            let _ = write!(out, "\n`{} {}`\n", entry.name(), entry.values);
        }
        if !entry.fields.is_empty() {
            out += "\n| field | value | default | meaning |\n| --- | --- | --- | --- |\n";
        }
        for field in &entry.fields {
            let words: Vec<String> = field
                .words
                .iter()
                .filter(|word| word.1 != 0)
                .map(|&(word, dialects)| match dialects == entry.dialects() {
                    true => format!("`{word}`"),
                    false => format!("`{word}` ({})", dialect_names(dialects)),
                })
                .collect();
            let default = match (&field.default, field.required) {
                (Some(default), _) => default.as_str(),
                (None, true) => "must be given",
                (None, false) => "",
            };
            let _ = writeln!(out, "| {} | {} | {default} | {} |", words.join("<br>"), field.value, field.doc);
        }
        let _ = write!(out, "\n```\n{}\n```\n", entry.example);
        if entry.scene().is_some() {
            let _ = write!(out, "\n![{}](pictures/{})\n", entry.name(), picture_name(&entry));
        }
    }
    out
}

fn spelled(keywords: &[Spelling]) -> String {
    let one = |&(word, dialects): &Spelling| format!("`{word}` in {}", dialect_names(dialects));
    keywords.iter().map(one).collect::<Vec<_>>().join(", ")
}

/// Returns a TextMate grammar with comments, numbers, blocks, fields and paths.
fn grammar() -> String {
    let (mut blocks, mut fields): (Vec<&str>, Vec<&str>) = (Vec::new(), Vec::new());
    for entry in entries() {
        let list = if entry.name().starts_with(char::is_uppercase) { &mut blocks } else { &mut fields };
        list.extend(entry.keywords.iter().map(|keyword| keyword.0));
        fields.extend(entry.fields.iter().flat_map(|field| field.words.iter().map(|word| word.0)));
    }
    let pattern = |list: &mut Vec<&str>| {
        list.sort_unstable();
        list.dedup();
        // `Component<Object>` does not end in a letter.
        format!("(?<![\\\\w<])(?:{})(?![\\\\w<])", list.join("|"))
    };
    format!(
        r##"{{
  "name": "Dürer scene",
  "scopeName": "source.durer",
  "fileTypes": ["txt"],
  "patterns": [
    {{ "name": "comment.line.number-sign.durer", "match": "#.*$" }},
    {{ "name": "constant.numeric.durer", "match": "(?<![\\w.])[-+]?(?:\\d+\\.?\\d*|\\.\\d+)(?:[eE][-+]?\\d+)?(?![\\w.])" }},
    {{ "name": "keyword.other.block.durer", "match": "{}" }},
    {{ "name": "variable.parameter.durer", "match": "{}" }},
    {{ "name": "string.unquoted.path.durer", "match": "[\\w./-]+\\.(?:obj|ply|png|ppm|tga|bmp|exr|hdr|pfm)" }}
  ]
}}
"##,
        pattern(&mut blocks),
        pattern(&mut fields)
    )
}

#[test]
fn pages_match_the_code() {
    for (path, text) in pages() {
        let written = std::fs::read_to_string(&path).unwrap_or_default();
        assert!(written == text, "{} is old: run `cargo xtask manual`", path.display());
    }
    for entry in entries().iter().filter(|entry| entry.scene().is_some()) {
        assert!(
            pictures().join(picture_name(entry)).exists(),
            "{} has no picture: run `cargo xtask manual`",
            entry.name()
        );
    }
}
