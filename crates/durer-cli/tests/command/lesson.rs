//! Tests `durer lesson`, both the folder and the page in a real browser.

use crate::common::browser::sees;
use crate::common::{self, TestFolder};
use std::path::Path;

const SMALL: &str = "--size 40x30 --samples 4";

fn names(folder: &Path) -> Vec<String> {
    let entries = std::fs::read_dir(folder).unwrap();
    let mut names: Vec<String> = entries.map(|entry| entry.unwrap().file_name().into_string().unwrap()).collect();
    names.sort();
    names
}

#[test]
fn lesson_folder_has_page_text_and_pictures() {
    let folder = TestFolder::new();
    let output = folder.expect_exit(0, &format!("lesson scene.txt -o out {SMALL}"));
    assert!(output.out.starts_with("wrote out/index.html, lesson.md and "), "{}", output.out);
    let (text, files) = (String::from_utf8(folder.bytes("out/lesson.md")).unwrap(), names(&folder.path("out")));
    // The folder contains exactly the files that the text links to.
    let shown = |name: &str| text.contains(&format!("]({name})")) || name == "lesson.md";
    assert!(files.iter().all(|name| shown(name)), "{files:?}");
    assert_eq!(
        text.matches("](").count(),
        text.matches(".png)").count() + text.matches(".svg)").count() + 1 + { text.matches("(our-scene.txt)").count() }
    );
    assert!(text.contains("> scene.txt cannot show this step: no glass is visible in it"), "{text}");
    assert!(text.contains("`crates/durer-render/src/integrator/whitted/secondary.rs`: `fn refract`"));
    // The last picture is the same as the one that `render` writes.
    folder.expect_exit(0, &format!("render scene.txt -o p.png -q {SMALL}"));
    let last = files.iter().rfind(|name| name.ends_with("-supersampling.png")).unwrap();
    assert_eq!(folder.bytes(&format!("out/{last}")), folder.bytes("p.png"));
    // A second run writes identical files.
    folder.expect_exit(0, &format!("lesson scene.txt -o again --quiet {SMALL}"));
    assert_eq!(names(&folder.path("again")), files);
    assert!(files.iter().all(|name| folder.bytes(&format!("out/{name}")) == folder.bytes(&format!("again/{name}"))));
}

#[test]
fn lessons_in_markdown_refuse_options() {
    let folder = TestFolder::new();
    folder.write("monday.md", "# Monday\n");
    folder.expect_failure(2, "lesson monday.md -o out.html", &["shown in the browser", "--output"]);
    folder.expect_failure(2, "lesson monday.md --samples 4", &["--samples"]);
    assert!(!folder.path("out.html").exists());
}

#[test]
fn only_files_of_an_earlier_lesson_are_replaced() {
    let folder = TestFolder::new();
    std::fs::create_dir(folder.path("out")).unwrap();
    folder.write("out/notes.txt", "mine");
    folder.expect_exit(0, &format!("lesson scene.txt -o out -q {SMALL}"));
    let first = names(&folder.path("out"));
    // Another scene has different steps. Files that are no longer needed are removed, and other
    // files are kept.
    folder.write("dull.txt", common::SCENE.replace("reflectiveColor 0.5 0.5 0.5", ""));
    folder.expect_exit(0, &format!("lesson dull.txt -o out -q {SMALL}"));
    folder.expect_exit(0, &format!("lesson dull.txt -o fresh -q {SMALL}"));
    let mut fresh = names(&folder.path("fresh"));
    fresh.push("notes.txt".into());
    fresh.sort();
    assert_ne!(first, fresh);
    assert_eq!(names(&folder.path("out")), fresh);
    assert_eq!(folder.bytes("out/notes.txt"), b"mine");
    // If an unrelated file has the same name as a file of the lesson, nothing is written.
    std::fs::create_dir(folder.path("site")).unwrap();
    folder.write("site/index.html", "my own page");
    let output = folder.expect_exit(2, &format!("lesson scene.txt -o site -q {SMALL}"));
    assert!(output.err.contains("`site/index.html` does not belong to an earlier lesson"), "{}", output.err);
    assert_eq!(names(&folder.path("site")), ["index.html"]);
}

#[test]
fn invalid_arguments_leave_no_files() {
    let folder = TestFolder::new();
    folder.write("broken.txt", "PerspectiveCamera {");
    for (arguments, words) in [
        ("scene.txt -o scene.txt", "is a file"),
        ("scene.txt -o no/such/folder", "folder `no/such` does not exist"),
        ("scene.txt -o out --show depth", "unexpected argument '--show'"),
        ("scene.txt -o out --crop 1,1,4x4", "unexpected argument '--crop'"),
        ("scene.txt -o out --size 40", "640x480"),
        ("missing.txt -o out", "missing.txt"),
        ("broken.txt -o out", "broken.txt"),
    ] {
        folder.expect_failure(2, &format!("lesson {arguments}"), &[words]);
    }
    #[cfg(target_os = "linux")]
    {
        std::fs::create_dir(folder.path("out")).unwrap();
        std::os::unix::fs::symlink("/dev/full", folder.path("out/x.png")).unwrap();
        folder.write("out/lesson.md", "<!-- Written by durer lesson, which also replaces or removes the files that are linked here. -->\n![x](index.html)");
        std::os::unix::fs::symlink("/dev/full", folder.path("out/index.html")).unwrap();
        let output = folder.expect_exit(1, &format!("lesson scene.txt -o out {SMALL}"));
        assert!(output.err.contains("No space left"), "{}", output.err);
        assert_eq!(names(&folder.path("out")), ["index.html", "lesson.md", "x.png"]);
    }
}

/// Script that visits all steps, moves the slider and drags across the picture.
const CLICKS: &str = r##"
(async () => {
  await wait();
  see(`heading ${document.title}`);
  const links = [...document.querySelectorAll(".contents a[href*=step]")];
  const images = [];
  let plans = 0, subscripts = 0, wipes = 0;
  for (const link of links) {
    link.click();
    await wait();
    images.push(...[...document.querySelectorAll("img")].map(image => image.src));
    plans += count(".plan line") > 5;
    subscripts += count(".equation sub");
    wipes += count(".wipe");
  }
  see(`steps ${links.length} with ${wipes} sliders`);
  see(`plan ${plans > 0} subscripts ${subscripts > 5} pictures ${images.length > 20}`);
  links[4].click();
  await wait();
  see(`at ${location.hash}`);
  const stage = find(".wipe"), clip = () => getComputedStyle(stage.querySelectorAll("img")[1]).clipPath;
  const slider = find(".shot input[type=range]");
  see(`half ${clip()}`);
  slider.value = 20;
  slider.dispatchEvent(new Event("input", { bubbles: true }));
  await wait();
  see(`slid ${clip()}`);
  mouse(stage, "pointermove", 0.9, 0.5, 0);
  await wait();
  see(`unheld ${clip()}`);
  mouse(stage, "pointerdown", 0.5, 0.5);
  mouse(stage, "pointermove", 0.75, 0.5);
  await wait();
  see(`dragged ${clip()} ${slider.value}`);
  stage.dispatchEvent(new KeyboardEvent("keydown", { key: "ArrowLeft", bubbles: true }));
  await wait();
  see(`key ${slider.value} ${location.hash}`);
  window.dispatchEvent(new KeyboardEvent("keydown", { key: "ArrowRight" }));
  await wait();
  see(`next ${location.hash}`);
  see(`sizes ${[...document.querySelectorAll("img")].every(image => image.complete && image.naturalWidth === 40)}`);
  document.querySelectorAll(".contents a").item(links.length).click();
  await wait();
  see(`built-in ${find(".source").textContent.includes("Camera")}`);
  done();
})();
"##;

#[test]
fn page_works_in_a_browser_without_network() {
    let folder = TestFolder::new();
    // If this name were not escaped, it would end the script, or it would link to a file that would
    // be removed.
    let scene = "<b>](a).txt";
    folder.write(scene, common::SCENE);
    folder.expect_exit(0, &format!("lesson {scene} -o out -q {SMALL}"));
    let text = String::from_utf8(folder.bytes("out/lesson.md")).unwrap();
    assert!(text.contains("# &lt;b>&#93;(a).txt") && !text.contains("](a)"), "{text}");
    let changes = names(&folder.path("out")).iter().filter(|name| name.ends_with("-change.png")).count();
    let steps = format!("steps {} with {changes} sliders", changes + 4);
    let wanted = [
        // The browser shows the title as text.
        "heading &lt;b&gt;](a).txt, in the order of the lecture",
        steps.as_str(),
        "plan true subscripts true pictures true",
        "at #/lesson/step-5",
        "half inset(0px 0px 0px 50%)",
        "slid inset(0px 0px 0px 20%)",
        "unheld inset(0px 0px 0px 20%)",
        "dragged inset(0px 0px 0px 75%) 75",
        "key 73 #/lesson/step-5",
        "next #/lesson/step-6",
        "sizes true",
        "built-in true",
    ];
    sees(&folder, "out/index.html", CLICKS, &wanted);
}
