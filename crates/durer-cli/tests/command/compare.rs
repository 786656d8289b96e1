//! Tests `durer compare`: metrics, exit codes, folders, heat maps, and the report in a real
//! browser.

use crate::common::browser::sees;
use crate::common::{self, TestFolder, corpus};
use durer::image::{Image8, read8};
use serde_json::Value;
use std::path::Path;
use std::process::Command;

/// Writes a picture as PPM.
fn put(place: &TestFolder, name: &str, picture: &Image8) {
    let mut bytes = format!("P6 {} {} 255\n", picture.width, picture.height).into_bytes();
    bytes.extend(picture.pixels.iter().flatten());
    if let Some(folder) = place.path(name).parent() {
        std::fs::create_dir_all(folder).unwrap();
    }
    place.write(name, bytes);
}

fn changed(picture: &Image8, change: impl Fn(u32, u32, &dyn Fn(u32, u32) -> [u8; 3]) -> [u8; 3]) -> Image8 {
    let at = |x: u32, y: u32| picture.pixels[(y * picture.width + x) as usize];
    let places = (0..picture.height).flat_map(|y| (0..picture.width).map(move |x| (x, y)));
    Image8 { pixels: places.map(|(x, y)| change(x, y, &at)).collect(), alpha: Vec::new(), ..*picture }
}

fn json(text: &str) -> Value {
    serde_json::from_str(text).unwrap()
}

/// Renders `a.png`, and the same picture in floating point as `a.exr`.
fn rendered() -> (TestFolder, Image8) {
    let folder = TestFolder::new();
    folder.expect_exit(0, "render scene.txt --size 60x50 --samples 1 -q -o a.png");
    folder.expect_exit(0, "render scene.txt --size 60x50 --samples 1 -q -o a.exr");
    let picture = folder.image8("a.png");
    (folder, picture)
}

#[test]
fn exit_codes_and_words() {
    let (folder, a) = rendered();
    assert!(folder.expect_exit(0, "compare a.png a.png").out.starts_with("identical\n"));
    put(&folder, "mirror.ppm", &changed(&a, |x, y, at| at(a.width - 1 - x, y)));
    let output = folder.expect_exit(1, "compare a.png mirror.ppm");
    assert!(output.out.starts_with("different: ") && output.err.is_empty(), "{}{}", output.out, output.err);
    for word in ["mirrored left to right: explains 100.0 %", "RMSE", "PSNR", "SSIM", "FLIP", "largest", "where"] {
        assert!(output.out.contains(word), "{word}: {}", output.out);
    }
    put(&folder, "near.ppm", &changed(&a, |x, y, at| at(x, y).map(|v| v.saturating_add(2))));
    folder.expect_exit(1, "compare a.png near.ppm");
    assert!(folder.expect_exit(0, "compare a.png near.ppm --tolerance 2/255").out.starts_with("same: 0 of"));
    folder.expect_exit(0, "compare a.png near.ppm --tolerance 0.008");
    folder.expect_exit(0, "compare a.png near.ppm --allow 100");
    // A floating-point picture is equal to its 8-bit version.
    folder.expect_exit(0, "compare a.png a.exr");
    folder.expect_exit(1, "compare a.png a.exr --transfer linear");
    let light = json(&folder.expect_exit(0, "compare a.exr a.exr --json").out);
    assert_eq!(light["pairs"][0]["hdr_flip"].as_f64(), Some(0.0));
}

#[test]
fn regions_name_the_hit_objects() {
    let place = TestFolder::new();
    ["a", "b"].iter().for_each(|folder| std::fs::create_dir(place.path(folder)).unwrap());
    place.expect_exit(0, "render scene.txt --size 60x50 --samples 1 -q -o a/scene.png");
    place.expect_exit(0, "render scene.txt --size 60x50 --samples 1 --shadows=off -q -o b/scene.png");
    for (pictures, scene) in [("a/scene.png b/scene.png", "scene.txt"), ("a b", ".")] {
        let found = json(&place.expect_exit(1, &format!("compare {pictures} --scene {scene} --json")).out);
        let regions = found["pairs"][0]["regions"].as_array().unwrap();
        assert!(!regions.is_empty());
        for region in regions {
            let (there, worst) = (&region["there"], &region["worst"]);
            // The plane is partly in shadow.
            assert!(there["hit"]["object"].as_str().unwrap().starts_with("Plane "), "{there}");
            assert_eq!(there["hit"]["normal"], serde_json::json!([0.0, 1.0, 0.0]));
            let command = there["command"].as_str().unwrap().strip_prefix("durer ").unwrap();
            // The command contains every option of the reference, including inferred ones.
            let options = format!("--pixel {},{} --size 60x50 --samples 1", worst[0], worst[1]);
            assert!(command.ends_with(&options), "{command}");
            place.expect_exit(0, command);
            let output = there["explanation"].as_array().unwrap();
            assert!(output.iter().any(|line| line.as_str().unwrap().contains("DirectionalLight")), "{output:?}");
        }
    }
    let text = place.expect_exit(1, "compare a/scene.png b/scene.png --scene scene.txt").out;
    assert!(text.contains("Plane scene.txt:") && text.contains("durer explain scene.txt --pixel"), "{text}");
    assert!(place.expect_exit(1, "compare a/scene.png b/scene.png --json").out.contains("\"there\": null"));
    place.expect_failure(2, "compare a b --scene a", &["no `scene.txt`"]);
    place.expect_failure(2, "compare a b --scene none.txt", &["none.txt"]);
    place.expect_exit(1, "compare a/scene.png b/scene.png --scene scene.txt --report r.html");
    assert!(String::from_utf8(place.bytes("r.html")).unwrap().contains("durer explain scene.txt --pixel"));
}

#[test]
fn bad_input_is_exit_code_2() {
    let (folder, a) = rendered();
    let small = Image8 { width: 1, height: 1, pixels: vec![[0; 3]], alpha: Vec::new() };
    put(&folder, "small.ppm", &small);
    folder.write("broken.png", &folder.bytes("a.png")[..200]);
    folder.write("no.png", "no picture");
    std::fs::create_dir(folder.path("empty")).unwrap();
    for (arguments, words) in [
        ("a.png small.ppm", "60 x 50 and 1 x 1"),
        ("a.png missing.png", "missing.png"),
        ("a.png broken.png", "broken.png"),
        ("a.png no.png", "no.png"),
        ("a.png scene.txt", "scene.txt"),
        ("a.png empty", "one is a folder"),
        ("empty empty", "no pictures in `empty`"),
        (". empty", "no picture in `empty`"),
        ("a.png a.png --tolerance -1", "2/255"),
        ("a.png a.png --tolerance 1/0", "2/255"),
        ("a.png a.png --tolerance x", "2/255"),
        ("a.png a.png --allow 101", "0 to 100"),
        ("a.png a.png --heat heat.txt", ".png"),
        ("a.png a.png --heat missing/heat.png", "does not exist"),
        ("a.png a.png --report missing/r.html", "does not exist"),
        ("a.png", "PICTURE"),
    ] {
        folder.expect_failure(2, &format!("compare {arguments}"), &[words]);
    }
    put(&folder, "f/a.ppm", &a);
    put(&folder, "g/a.ppm", &a);
    folder.expect_failure(2, "compare f g --heat heat.png", &["--heat"]);
    #[cfg(target_os = "linux")]
    {
        std::os::unix::fs::symlink("/dev/full", folder.path("full.html")).unwrap();
        assert!(folder.expect_exit(2, "compare a.png a.png --report full.html").err.contains("No space left"));
    }
}

#[test]
fn folders_of_pictures_and_of_students() {
    let (folder, a) = rendered();
    let dark = changed(&a, |x, y, at| at(x, y).map(|v| v / 2));
    for (name, picture) in [
        ("ref/one.ppm", &a),
        ("ref/deep/two.ppm", &a),
        ("mine/one.ppm", &a),
        ("mine/deep/two.ppm", &dark),
        ("mine/more.ppm", &a),
        ("class/ada/one.ppm", &a),
        ("class/ada/deep/two.ppm", &a),
        ("class/bob/one.ppm", &dark),
        ("class/eve/deep/two.ppm", &a),
    ] {
        put(&folder, name, picture);
    }
    let output = folder.expect_exit(1, "compare ref mine");
    assert!(
        output.out.contains("darker by a factor of 0.49") && output.err.contains("more.ppm"),
        "{}{}",
        output.out,
        output.err
    );
    folder.expect_exit(0, "compare ref/deep mine/deep --allow 100");
    let found = json(&folder.expect_exit(1, "compare ref mine --json").out);
    assert_eq!(
        (found["version"].as_u64(), found["identical"].as_u64(), found["different"].as_u64()),
        (Some(1), Some(1), Some(1))
    );
    assert_eq!(found["pairs"][0]["findings"][0]["kind"], "factor");

    let output = folder.expect_exit(1, "compare ref class");
    let row = |who: &str| {
        output
            .out
            .lines()
            .rfind(|l| l.starts_with(who))
            .unwrap()
            .split_whitespace()
            .skip(1)
            .map(String::from)
            .collect::<Vec<_>>()
    };
    assert_eq!(
        (row("ada"), row("bob"), row("eve")),
        (
            ["2", "0", "0", "0"].map(String::from).to_vec(),
            ["0", "1", "1", "0"].map(String::from).to_vec(),
            ["1", "0", "1", "0"].map(String::from).to_vec(),
        )
    );
    // An unreadable picture does not affect the others.
    folder.write("class/bob/deep.png", "");
    folder.write("class/ada/one.ppm", "P6 9 9");
    let output = folder.expect_exit(2, "compare ref class --report class.html");
    assert!(
        output.out.contains("eve/one.ppm") && output.out.contains("error") && output.err.contains("1 of 6"),
        "{}{}",
        output.out,
        output.err
    );
    assert!(folder.path("class.html").is_file());
}

#[test]
fn heat_map_is_black_where_nothing_differs() {
    let (folder, a) = rendered();
    put(&folder, "patch.ppm", &changed(&a, |x, y, at| if x > 50 && y > 40 { [255, 0, 255] } else { at(x, y) }));
    let output = folder.expect_exit(1, "compare a.png patch.ppm --heat heat.png");
    assert!(output.out.contains("wrote heat.png"));
    let heat = folder.image8("heat.png");
    assert_eq!((heat.width, heat.height, heat.pixels[0]), (60, 50, [0, 0, 8]));
    assert!(heat.pixels[60 * 50 - 1][0] > 200);
}

/// Finds the mistakes of students in pictures of the course.
#[test]
fn mistakes_in_real_pictures_are_named() {
    let Some(course) = corpus() else { return };
    let folder = TestFolder::new();
    for name in ["f04/f04-handout/output2_14.png", "f04/f04-handout/output6_04ab.png", "f12a4/binary-f12-a4/07.png"] {
        let path = course.join("reference").join(name);
        let a = read8(&std::fs::read(&path).unwrap(), name).unwrap();
        let (width, height) = (a.width, a.height);
        // Change one in twenty pixels, without any pattern.
        let speckle = |x: u32, y: u32| {
            let mixed = x.wrapping_mul(0x9e37_79b9) ^ y.wrapping_mul(0x85eb_ca6b).rotate_left(13);
            ((mixed ^ mixed >> 15).wrapping_mul(0xc2b2_ae35) >> 16).is_multiple_of(20)
        };
        let curve = |v: u8| durer::image::Transfer::Srgb.encode(f32::from(v) / 255.0);
        let wrong: [(&str, Image8); 7] = [
            ("mirrored", changed(&a, |x, y, at| at(width - 1 - x, y))),
            ("upside-down", changed(&a, |x, y, at| at(x, height - 1 - y))),
            ("shifted", changed(&a, |x, y, at| at(x, y.saturating_sub(1)))),
            ("inverted", changed(&a, |x, y, at| at(x, y).map(|v| 255 - v))),
            ("factor", changed(&a, |x, y, at| at(x, y).map(|v| v / 2))),
            ("gamma-once-more", changed(&a, |x, y, at| at(x, y).map(curve))),
            ("dark-speckles", changed(&a, |x, y, at| if speckle(x, y) { at(x, y).map(|v| v / 5) } else { at(x, y) })),
        ];
        for (kind, picture) in &wrong {
            put(&folder, "wrong.ppm", picture);
            let arguments = ["compare", "--json", path.to_str().unwrap(), "wrong.ppm"];
            let output = Command::new(common::durer()).args(arguments).current_dir(folder.path("")).output().unwrap();
            let found = json(&String::from_utf8(output.stdout).unwrap());
            let findings = &found["pairs"][0]["findings"];
            assert_eq!(findings[0]["kind"], *kind, "{name}: {findings}");
        }
    }
}

/// Students often trace rays through the corners of pixels instead of their centres.
#[test]
fn border_pixels_and_missing_shadows_are_recognised() {
    let folder = TestFolder::new();
    let scene = Path::new(env!("CARGO_MANIFEST_DIR")).join("../../scenes/whitted.txt");
    std::fs::copy(&scene, folder.path("whitted.txt")).unwrap();
    for (name, options) in [("right", ""), ("border", "--compat border-pixels"), ("bare", "--shadows=off")] {
        folder.expect_exit(0, &format!("render whitted.txt --size 150x150 --samples 1 -q -o {name}.png {options}"));
    }
    let words = |name: &str| folder.expect_exit(1, &format!("compare right.png {name}.png")).out;
    // A fine pattern changes pixels everywhere, so the pixels alone are not enough for a diagnosis.
    assert!(!words("border").contains("noise"), "{}", words("border"));
    // The brightness can have many causes, so the pixels alone are not enough for a diagnosis.
    assert!(
        words("bare").contains("and the rest is equal: the pictures alone do not show the cause"),
        "{}",
        words("bare")
    );
    let tried = |name: &str| folder.expect_exit(1, &format!("compare right.png {name}.png --scene whitted.txt")).out;
    assert!(tried("bare").contains("there are no shadows: explains 100.0 %"), "{}", tried("bare"));
    assert!(tried("border").contains("on the picture's border"), "{}", tried("border"));
}

/// Script that clicks through the page and records what the page shows.
const CLICKS: &str = r##"
(async () => {
  await wait();
  const over = () => document.querySelectorAll(".wipe img")[1];
  const look = () => { const { visibility, clipPath, mixBlendMode } = getComputedStyle(over()); return `${visibility} ${clipPath} ${mixBlendMode}`; };
  const choose = async mode => { find(`button[data-mode=${mode}]`).click(); await wait(); see(`${mode}: ${look()}`); };
  see(`rows ${count(".pairs tbody .link")}`);
  see(`natural ${over().complete && over().naturalWidth}x${over().naturalHeight}`);
  const picture = over().src;
  for (const mode of ["slider", "reference", "picture", "difference", "blink"]) await choose(mode);
  await choose("heat");
  see(`heat ${over().src !== picture && over().src.startsWith("data:image/png")}`);
  await choose("slider");
  mouse(find(".wipe"), "pointerdown", 0.25, 0.1);
  mouse(find(".wipe"), "pointermove", 0.75, 0.1);
  await wait();
  see(`slid ${getComputedStyle(over()).clipPath}; ${find(".below output").textContent}`);
  find(".regions .place").click();
  await wait();
  see(`box ${find(".wipe .box").style.left}`);
  const zoom = find(".zoom-choice select");
  zoom.value = "8";
  zoom.dispatchEvent(new Event("change", { bubbles: true }));
  await wait();
  see(`zoomed ${find(".wipe").offsetWidth}`);
  document.querySelectorAll(".pairs tbody .link")[0].click();
  await wait();
  see(`name ${find(".finding h2").textContent}`);
  window.dispatchEvent(new KeyboardEvent("keydown", { key: "2" }));
  setTimeout(() => { see(`blinked ${getComputedStyle(over()).visibility}`); done(); }, 700);
})();
"##;

/// The report of a class groups equal mistakes, and its table can be saved.
#[test]
fn class_report_is_a_matrix_of_students_and_pictures() {
    let folder = TestFolder::new();
    std::fs::create_dir_all(folder.path("ref")).unwrap();
    folder.expect_exit(0, "render scene.txt --size 60x50 --samples 1 -q -o ref/scene.png");
    for (who, options) in [("ada", "--shadows=off"), ("bob", "--shadows=off"), ("eve", "")] {
        std::fs::create_dir_all(folder.path(&format!("class/{who}"))).unwrap();
        folder.expect_exit(
            0,
            &format!("render scene.txt --size 60x50 --samples 1 -q -o class/{who}/scene.png {options}"),
        );
    }
    folder.expect_exit(1, "compare ref class --scene . --report class.html");
    let clicks = r##"
(async () => {
  await wait();
  see(`cells ${count(".matrix button.cell img")}`);
  see(`same ${find(".groups li").textContent}`);
  const { csv } = JSON.parse(find("#report").textContent);
  see(`csv ${csv.split("\r\n").length} ${csv.includes(",no-shadows,")}`);
  const link = [];
  HTMLAnchorElement.prototype.click = function () { link.push(this.download); };
  [...document.querySelectorAll("button")].find(button => button.textContent === "Save as CSV").click();
  see(`saved ${link}`);
  find(".matrix button.cell").click();
  await wait();
  see(`picked ${find(".finding h2").textContent}`);
  see(`code ${count(".code-line.right")} ${count(".code-line.wrong")}`);
  see(`narrow ${document.documentElement.scrollWidth <= document.documentElement.clientWidth}`);
  done();
})();
"##;
    let wanted = [
        "cells 3",
        "same there are no shadowsscene.png: ada, bob",
        "csv 5 true",
        "saved class.csv",
        "picked ada/scene.png different",
        "code 1 1",
        "narrow true",
    ];
    sees(&folder, "class.html", clicks, &wanted);
}

#[test]
fn page_works_in_a_browser_without_network() {
    let (folder, a) = rendered();
    // Names that would end the script if they were not escaped.
    for (name, left) in
        [("ref/one.ppm", 99), ("ref/</script><b>.ppm", 99), ("mine/one.ppm", 99), ("mine/</script><b>.ppm", 30)]
    {
        let name = name.replace("</", "<").replace('/', std::path::MAIN_SEPARATOR_STR);
        put(&folder, &name, &changed(&a, |x, y, at| if x > left { [255, 0, 0] } else { at(x, y) }));
    }
    folder.expect_exit(1, "compare ref mine --report report.html");
    let wanted = [
        "rows 2",
        "natural 60x50",
        "slider: visible inset(0px 0px 0px 50%) normal",
        "reference: hidden",
        "picture: visible none normal",
        "difference: visible none difference",
        "heat true",
        "slid inset(0px 0px 0px 75%); pixel 45,",
        "box 51.6",
        "zoomed 480",
        "name &lt;script&gt;&lt;b&gt;.ppm different",
        "blinked hidden",
    ];
    sees(&folder, "report.html", CLICKS, &wanted);
}

const ROOM: &str = "PerspectiveCamera { center 2 1.6 5.8 direction 0 -0.06 -1 up 0 1 0 angle 60 }
Background { color 0 0 0 }
Materials {
  PrincipledMaterial { baseColor 0.7 0.7 0.7 specularWeight 0 }
  PrincipledMaterial { baseColor 0.7 0.2 0.1 specularWeight 0 }
  PrincipledMaterial { baseColor 0 0 0 specularWeight 0 emissionLuminance 9 }
}
Group {
  MaterialIndex 0
  Rectangle { corner 0 0 0 edge0 0 0 6 edge1 4 0 0 }
  Rectangle { corner 0 3 0 edge0 4 0 0 edge1 0 0 6 }
  Rectangle { corner 0 0 0 edge0 4 0 0 edge1 0 3 0 }
  MaterialIndex 1
  Rectangle { corner 0 0 0 edge0 0 3 0 edge1 0 0 6 }
  MaterialIndex 0
  Rectangle { corner 4 0 0 edge0 0 0 6 edge1 0 3 0 }
  MaterialIndex 2
  Rectangle { corner 1.4 2.98 2 edge0 1.2 0 0 edge1 0 0 1.2 }
  MaterialIndex 0
  Sphere { center 1.4 0.6 2 radius 0.6 }
}
";

/// Differences within the noise of path-traced pictures are recognised. Errors that occur while
/// other dialects are tried are not printed.
#[test]
fn pictures_of_paths_are_judged_against_their_noise() {
    let folder = TestFolder::new();
    folder.write("room.txt", ROOM);
    let options = "--integrator path --samples 32 --bounces 6";
    let render = |name: &str, options: &str| {
        folder.expect_exit(0, &format!("render room.txt -o {name}.png -q --size 64x48 --integrator path {options}"));
    };
    render("right", "--samples 32 --bounces 6");
    render("other", "--samples 32 --bounces 6 --seed 5");
    render("few", "--samples 4 --bounces 6 --seed 3");
    render("direct", "--samples 32 --bounces 0");
    render("one", "--samples 32 --bounces 1 --seed 9");
    let text = |name: &str| {
        let output = folder.expect_exit(1, &format!("compare right.png {name}.png --scene room.txt {options} --json"));
        assert!(!output.err.contains("error["), "{}", output.err);
        json(&output.out)["pairs"][0]["diagnosis"].clone()
    };
    let words = |name: &str| text(name)["lines"][0].as_str().unwrap().to_string();
    assert!(words("other").contains("the difference is noise"), "{}", words("other"));
    assert!(words("few").contains("times the variance of the reference"), "{}", words("few"));
    for name in ["direct", "one"] {
        let text = text(name);
        assert_eq!(text["named"][0]["mistakes"][0]["name"], "path-depth", "{text:#}");
    }
    // If the reference belongs to another scene, this is reported because more pixels differ than
    // noise can explain.
    folder.write(
        "other.txt",
        ROOM.replace("baseColor 0.7 0.2 0.1", "baseColor 0.1 0.7 0.2").replace("0.6 2 radius", "1.6 2 radius"),
    );
    let output = folder.expect_exit(1, &format!("compare right.png one.png --scene other.txt {options}"));
    assert!(output.out.contains("cause unknown") && !output.err.contains("error["), "{}{}", output.out, output.err);
}

/// A table lists a scene and options for each picture, and the CSV output names the mistakes.
#[test]
fn each_picture_can_have_its_own_scene_and_options() {
    let folder = TestFolder::new();
    ["ref", "class/ann", "class/bob", "scenes"]
        .iter()
        .for_each(|name| std::fs::create_dir_all(folder.path(name)).unwrap());
    std::fs::rename(folder.path("scene.txt"), folder.path("scenes/one.txt")).unwrap();
    let one = std::fs::read_to_string(folder.path("scenes/one.txt")).unwrap();
    folder.write("scenes/two.txt", one.replace("color 0.2 0.1 0.5", "color 0.5 0.1 0.2"));
    let (a, b) = ("--size 60x50 --samples 1", "--size 50x50 --samples 1 --dialect f04 --transfer course");
    for (picture, scene, options) in [
        ("ref/a", "one", a),
        ("ref/b", "two", b),
        ("class/ann/a", "one", "--size 60x50 --samples 1 --shadows=off"),
        ("class/ann/b", "two", b),
        ("class/bob/a", "one", a),
        ("class/bob/b", "two", "--size 50x50 --samples 1 --dialect f04 --transfer course --shadows=on"),
    ] {
        folder.expect_exit(0, &format!("render scenes/{scene}.txt -q -o {picture}.png {options}"));
    }
    let options = "--samples 1 --dialect f04 --transfer course";
    folder.write(
        "class.csv",
        format!("Picture,Scene,Options\r\na.png,scenes/one.txt,--samples 1\r\nb,scenes/two.txt,{options}\r\n"),
    );
    let output = folder.expect_exit(1, "compare ref class --table class.csv --csv");
    let line = |start: &str| output.out.lines().find(|line| line.starts_with(start)).unwrap().to_string();
    assert!(line("ann,a.png").contains(",no-shadows,there are no shadows"), "{}", output.out);
    assert!(line("bob,b.png").contains(",shadows-added,"), "{}", output.out);
    assert!(line("ann,b.png").contains(",identical,") && line("bob,a.png").contains(",identical,"), "{}", output.out);
    // Errors name the line of the table.
    for (text, words) in [
        ("scene\nscenes/one.txt\n", "has no column `picture`"),
        ("picture;scene\na.png;scenes/one.txt\nc.png;x.txt\n", "class.csv:3: there is no reference picture `c.png`"),
        ("picture,options\na,--samples 1\nb,--sample 1\n", "class.csv:3: in the column `options`: unexpected argument"),
        ("picture\na\na\n", "class.csv:3: the picture `a` is already in class.csv:2"),
        ("picture,options\na,\"--dialect 'f04\"\n", "class.csv:2: a quotation mark"),
    ] {
        folder.write("class.csv", text);
        folder.expect_failure(2, "compare ref class --table class.csv", &[words]);
    }
    folder.expect_failure(2, "compare ref class --table none.csv", &["none.csv"]);
}

#[test]
fn class_table_is_comma_separated() {
    let (folder, picture) = rendered();
    std::fs::create_dir_all(folder.path("ref")).unwrap();
    std::fs::create_dir_all(folder.path("class/ann")).unwrap();
    put(&folder, "ref/a.ppm", &picture);
    put(&folder, "class/ann/a.ppm", &changed(&picture, |x, y, at| at(picture.width - 1 - x, y)));
    let output = folder.expect_exit(1, "compare ref class --csv");
    let lines: Vec<&str> = output.out.lines().collect();
    assert_eq!(lines[0], "student,picture,verdict,differ_percent,rmse,ssim,flip,mistake,why");
    assert!(lines[1].starts_with("ann,a.ppm,different,") && lines[1].contains(",mirrored,"), "{}", output.out);
    folder.expect_failure(2, "compare ref class --csv --json", &["--csv"]);
}
