//! `cargo xtask site`: the playground, the book and the documentation of the library as one web
//! site. Each scene of the language reference and of the gallery has a link that opens it in the
//! playground.

use crate::page::call;
use anyhow::{Context, Result};
use durer::diag::{Diagnostics, Files};
use durer::format::course::reference::entries;
use durer::{LoadOptions, load_text};
use std::collections::BTreeMap;
use std::fs;
use std::path::{Path, PathBuf};
use std::process::{Command, ExitCode};

/// Writes the site into a folder: the playground at its root, `book/`, `api/`, and the scenes with
/// their files in `scenes/`.
pub fn run(arguments: &[String]) -> Result<ExitCode> {
    let root = crate::root()?;
    let folder = PathBuf::from(crate::value(arguments, "-o").context("the output folder is missing: pass -o FOLDER")?);
    crate::page::playground(arguments)?;
    let folder = folder.canonicalize()?;
    book(&root, &folder)?;
    api(&root, &folder)?;
    println!("{}: any web server can serve it", folder.display());
    Ok(ExitCode::SUCCESS)
}

/// Builds the book from copies of the documents to which links are added.
fn book(root: &Path, folder: &Path) -> Result<()> {
    let copy = tempfile::tempdir()?;
    fs::copy(root.join("book.toml"), copy.path().join("book.toml"))?;
    copy_folder(&root.join("docs"), &copy.path().join("docs"))?;
    let edit = |name: &str, change: &dyn Fn(&str) -> Result<String>| -> Result<()> {
        let path = copy.path().join("docs").join(name);
        let text = fs::read_to_string(&path)?;
        Ok(fs::write(&path, change(&text).with_context(|| name.to_string())?)?)
    };
    let scenes = Scenes { from: root.join("scenes"), to: folder.join("scenes") };
    edit("gallery.md", &|text| gallery(text, |name| scenes.publish(name, &fs::read(scenes.from.join(name))?)))?;
    edit("live.md", &|text| Ok(format!("{text}\n{}", frame("../"))))?;
    let mut examples = BTreeMap::new();
    for entry in entries() {
        let Some(scene) = entry.scene() else { continue };
        let picture = crate::manual::picture_name(&entry);
        let name = format!("example-{}", picture.replace(".png", ".txt"));
        examples.insert(picture, scenes.publish(&name, scene.as_bytes())?);
    }
    for page in fs::read_dir(copy.path().join("docs/language"))? {
        let name = format!("language/{}", page?.file_name().to_string_lossy());
        if name.ends_with(".md") {
            edit(&name, &|text| Ok(reference(text, &examples)))?;
        }
    }
    let mut mdbook = Command::new("mdbook");
    call(mdbook.arg("build").arg(copy.path()).arg("--dest-dir").arg(folder.join("book")))
        .context("the book needs mdBook: `cargo install mdbook`")
}

/// Builds the documentation of the library, with a link to the playground on every page.
fn api(root: &Path, folder: &Path) -> Result<()> {
    let target = root.join("target/site");
    let links = tempfile::Builder::new().suffix(".html").tempfile()?;
    fs::write(&links, API_LINKS.replace("FRAME", &frame("${site}")))?;
    call(
        Command::new(crate::cargo())
            .args(["doc", "--no-deps", "--lib", "--target-dir"])
            .arg(&target)
            .env("RUSTDOCFLAGS", format!("--html-before-content {}", links.path().display()))
            .current_dir(root),
    )?;
    copy_folder(&target.join("doc"), &folder.join("api"))
}

/// HTML at the top of each page of the library's documentation: links to the playground and the
/// book, and `FRAME`, the playground itself, on the first page.
const API_LINKS: &str = r#"<script>
addEventListener("DOMContentLoaded", () => {
    const site = document.querySelector('meta[name="rustdoc-vars"]').dataset.rootPath + "../";
    const page = document.querySelector("main");
    page.insertAdjacentHTML(
        "afterbegin",
        `<nav id="durer-site"><a href="${site}#/viewer">Playground</a> · <a href="${site}book/index.html">Book</a></nav>`,
    );
    if (/\/durer\/(index\.html)?$/.test(location.pathname)) {
        page.insertAdjacentHTML("beforeend", `FRAME`);
    }
});
</script>
"#;

/// Returns HTML that shows the playground at an address, which ends with a slash, in a page.
fn frame(site: &str) -> String {
    format!(
        "<iframe src=\"{site}\" title=\"Playground\" loading=\"lazy\" style=\"width:100%;height:80vh;border:0\"></iframe>\n"
    )
}

/// Scenes of the repository, and the folder of the site that gets copies of them.
struct Scenes {
    from: PathBuf,
    to: PathBuf,
}

impl Scenes {
    /// Copies a scene and the files that it refers to. Returns the fragment of the link that opens
    /// it in the playground.
    fn publish(&self, name: &str, bytes: &[u8]) -> Result<String> {
        let (mut files, mut diagnostics) = (Files::default(), Diagnostics::default());
        let path = self.from.join(name);
        let loaded = load_text(&path, bytes.into(), &LoadOptions::default(), &mut files, &mut diagnostics);
        let loaded = loaded.with_context(|| format!("{name}: {diagnostics:?}"))?;
        let mut paths = vec![PathBuf::from(name)];
        for file in loaded.named_files() {
            let inside = file.canonicalize()?.strip_prefix(&self.from)?.to_path_buf();
            if !paths.contains(&inside) {
                paths.push(inside);
            }
        }
        for path in &paths {
            let to = self.to.join(path);
            fs::create_dir_all(to.parent().context("a folder")?)?;
            if path == Path::new(name) {
                fs::write(to, bytes)?;
            } else {
                fs::copy(self.from.join(path), to)?;
            }
        }
        let names: Vec<String> = paths.iter().map(|path| encode(&format!("scenes/{}", path.display()))).collect();
        Ok(format!("#/open/{}", names.join(",")))
    }
}

/// Adds a link to each scene of the gallery, `[name](../scenes/name.txt)`.
fn gallery(text: &str, mut publish: impl FnMut(&str) -> Result<String>) -> Result<String> {
    let mut parts = text.split("](../scenes/");
    let mut out = parts.next().unwrap_or_default().to_string();
    for part in parts {
        let (name, rest) = part.split_once(')').context("a link without an end")?;
        out += &format!("](../scenes/{name}) · [open](../{}){rest}", publish(name)?);
    }
    Ok(out)
}

/// Adds a link below each picture of an example in the language reference.
fn reference(text: &str, examples: &BTreeMap<String, String>) -> String {
    let mut out = String::new();
    for line in text.lines() {
        out += line;
        out += "\n";
        let picture = line.strip_suffix(')').and_then(|line| line.split_once("](pictures/"));
        if let Some(fragment) = picture.and_then(|(_, name)| examples.get(name)) {
            out += &format!("\n[Open](../../{fragment})\n");
        }
    }
    out
}

/// Encodes a path for the fragment of a URL, where a comma separates paths.
fn encode(path: &str) -> String {
    let plain = |byte: u8| byte.is_ascii_alphanumeric() || b"-_./".contains(&byte);
    path.bytes().map(|byte| if plain(byte) { char::from(byte).to_string() } else { format!("%{byte:02X}") }).collect()
}

fn copy_folder(from: &Path, to: &Path) -> Result<()> {
    fs::create_dir_all(to)?;
    for entry in fs::read_dir(from).with_context(|| from.display().to_string())? {
        let entry = entry?;
        let target = to.join(entry.file_name());
        if entry.file_type()?.is_dir() {
            copy_folder(&entry.path(), &target)?;
        } else {
            fs::copy(entry.path(), target)?;
        }
    }
    Ok(())
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn gallery_links_open_their_scenes() {
        let text = "| ![A](gallery/a.png)<br>[a](../scenes/a.txt) | ![B](gallery/b.png)<br>[b](../scenes/b.pbrt) |";
        let linked = gallery(text, |name| Ok(format!("#/open/{name}"))).unwrap();
        let expected = "| ![A](gallery/a.png)<br>[a](../scenes/a.txt) · [open](../#/open/a.txt) | \
                        ![B](gallery/b.png)<br>[b](../scenes/b.pbrt) · [open](../#/open/b.pbrt) |";
        assert_eq!(linked, expected);
    }

    #[test]
    fn examples_have_links_below_their_pictures() {
        let examples = BTreeMap::from([("shapes-ball.png".to_string(), "#/open/x.txt".to_string())]);
        let text = "## Ball\n\n![Ball](pictures/shapes-ball.png)\n\n![Other](pictures/other.png)\n";
        let expected = "## Ball\n\n![Ball](pictures/shapes-ball.png)\n\n[Open](../../#/open/x.txt)\n\n\
                        ![Other](pictures/other.png)\n";
        assert_eq!(reference(text, &examples), expected);
    }

    #[test]
    fn published_scene_has_its_files() {
        let site = tempfile::tempdir().unwrap();
        let from = crate::root().unwrap().join("scenes");
        let scenes = Scenes { from, to: site.path().to_path_buf() };
        let text = b"PerspectiveCamera { center 0 0 5 direction 0 0 -1 up 0 1 0 angle 30 }\n\
                     Group { TriangleMesh { obj_file meshes/cube.obj } }\n";
        let fragment = scenes.publish("cube, plain.txt", text).unwrap();
        assert_eq!(fragment, "#/open/scenes/cube%2C%20plain.txt,scenes/meshes/cube.obj");
        assert_eq!(fs::read(site.path().join("cube, plain.txt")).unwrap(), text);
        assert!(site.path().join("meshes/cube.obj").exists());
    }
}
