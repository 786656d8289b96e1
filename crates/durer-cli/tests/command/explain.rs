//! Tests `durer explain`.

use crate::common::browser::sees;
use crate::common::{self, TestFolder};
use serde_json::Value;

const SMALL: &str = "--size 40x30 --quiet";

/// Sums the terms of a node in order, in single precision.
fn sum(node: &Value) -> [f32; 3] {
    let color = |name: &str| -> [f32; 3] { std::array::from_fn(|i| node[name][i].as_f64().unwrap() as f32) };
    let terms = node["terms"].as_array().unwrap();
    if terms.is_empty() {
        return color("value");
    }
    let mut total = [0.0; 3];
    for term in terms {
        let (value, factor) = (sum(term), &term["factor"]);
        for i in 0..3 {
            total[i] += factor[i].as_f64().unwrap() as f32 * value[i];
        }
    }
    let scale = color("scale");
    std::array::from_fn(|i| total[i] * scale[i])
}

/// A ball inside a box, whose front face is that of another box.
#[test]
fn crossings_of_a_ray_are_all_listed() {
    let folder = TestFolder::new();
    folder.write(
        "nested.txt",
        "PerspectiveCamera { center 0 0 5 direction 0 0 -1 up 0 1 0 angle 40 } Lights { }
Materials { PhongMaterial { diffuseColor 1 1 1 } }
Group { Box { min -2 -2 -2 max 2 2 2 } Sphere { center 0 0 0 radius 1 } Box { min -2 -2 2 max 2 2 3 } }",
    );
    let crossings = "explain nested.txt --crossings --ray";
    let text = folder.expect_exit(0, &format!("{crossings} 0.5 0.25 5 0 0 -2")).out;
    let lines: Vec<&str> = text.lines().collect();
    assert!(lines[0].starts_with("6 crossings along (0.5, 0.25, 5) + t (0, 0, -1)"), "{text}");
    assert!(lines[2].starts_with("  t = 3: leaves Box") && lines[3].starts_with("  t = 3: enters Box"), "{text}");
    assert!(lines[1].starts_with("  t = 2: enters Box") && lines[6].starts_with("  t = 7: leaves Box"), "{text}");
    let json: Value =
        serde_json::from_str(&folder.expect_exit(0, &format!("{crossings} 0.5 0.25 0 0 1 0 --json")).out).unwrap();
    let places: Vec<f64> = json["crossings"].as_array().unwrap().iter().map(|row| row["t"].as_f64().unwrap()).collect();
    assert!((places[0] - (0.75_f64.sqrt() - 0.25)).abs() < 1e-6 && places[1] == 1.75, "{json}");
    assert!(json["count"] == 2 && json["crossings"][0]["enters"] == false, "{json}");
    assert!(folder.expect_exit(0, &format!("{crossings} 9 9 9 1 0 0")).out.starts_with("0 crossings"));
    folder.expect_failure(2, "explain nested.txt --pixel 3,3 --crossings", &["--crossings"]);
}

#[test]
fn pixel_of_render_is_that_of_the_picture() {
    let folder = TestFolder::new();
    for options in ["--samples 5", "--samples 1", "--samples 9 --integrator path", "--dialect f04 --filter tent"] {
        let text = folder.expect_exit(0, &format!("explain scene.txt --pixel 20,15 --json {options} {SMALL}")).out;
        let json: Value = serde_json::from_str(&text).unwrap();
        let color: Vec<f32> =
            json["pixel"]["color"].as_array().unwrap().iter().map(|x| x.as_f64().unwrap() as f32).collect();
        let shown = folder.expect_exit(0, &format!("render scene.txt --pixel 20,15 {options} {SMALL}")).out;
        let numbers: Vec<f32> = shown.split_whitespace().skip(2).map(|number| number.parse().unwrap()).collect();
        assert_eq!(numbers, color, "{options}: {shown}");
    }
    folder.expect_failure(2, "render scene.txt --pixel 20,15 --denoise", &["--denoise needs the whole picture"]);
}

#[test]
fn direction_of_a_ray_can_have_any_length() {
    let folder = TestFolder::new();
    let of = |direction: &str| {
        folder.expect_exit(0, &format!("explain scene.txt --ray 0,0.2,5,{direction} --dialect f04 {SMALL}")).out
    };
    let unit = of("0,-0.6,-0.8");
    assert!(unit.contains("N = ") && of("0,-6,-8") == unit && of("0,-0.006,-0.008") == unit, "{unit}");
    folder.expect_failure(2, "explain scene.txt --ray 0,0,5,0,0,0", &["a direction other than 0 0 0"]);
}

#[test]
fn tree_is_drawn_as_svg() {
    let folder = TestFolder::new();
    folder.expect_exit(0, &format!("explain scene.txt --pixel 20,15 --svg tree.svg {SMALL}"));
    let drawn = std::fs::read_to_string(folder.path("tree.svg")).unwrap();
    let text = folder.expect_exit(0, &format!("explain scene.txt --pixel 20,15 {SMALL}")).out;
    let terms = text.lines().filter(|line| line.trim_start().starts_with("+ (")).count();
    // One row is the pixel itself.
    assert!(terms > 3 && drawn.matches("<text").count() == terms + 1, "{text} {drawn}");
    folder.expect_failure(2, "explain scene.txt --pixel 20,15 --svg scene.txt", &["scene.txt"]);
    // The camera ray and the shadow ray of the light, from the side and from above.
    let rays = |options: &str| {
        folder.expect_exit(0, &format!("explain scene.txt --pixel 20,15 --rays rays.svg {options} {SMALL}"));
        std::fs::read_to_string(folder.path("rays.svg")).unwrap()
    };
    let side = rays("");
    assert!(side.contains(">camera<") && side.contains(">to a light<") && !side.contains(">reflected<"), "{side}");
    assert_ne!(rays("--from-above"), side);
    folder.expect_failure(2, "explain scene.txt --pixel 20,15 --from-above", &["--rays"]);
}

#[test]
fn tree_sums_to_the_pixel_of_the_picture() {
    let folder = TestFolder::new();
    folder.expect_exit(0, &format!("render scene.txt -o p.pfm --samples 1 {SMALL}"));
    let picture = folder.image("p.pfm");
    for (x, y) in [(20, 12), (20, 26), (3, 3), (31, 20)] {
        let output = folder.expect_exit(0, &format!("explain scene.txt --pixel {x},{y} --samples 1 --json {SMALL}"));
        let json: Value = serde_json::from_str(&output.out).unwrap();
        let light = &json["pixel"]["samples"][0]["light"];
        assert_eq!(sum(light), picture.get(x, y).unwrap().to_array(), "{x},{y}");
    }
}

#[test]
fn course_samplers_are_explained_with_neighbouring_pixels() {
    let folder = TestFolder::new();
    let output =
        |options: &str| folder.expect_exit(0, &format!("explain scene.txt --pixel 20,13 {options} {SMALL}")).out;
    let text = output("--sampler jittered --samples 4 --filter gaussian");
    assert!(text.contains("weighted mean of 36 samples, including samples of neighbouring pixels; "), "{text}");
    assert!(text.contains("(number 3 of pixel 21,14) at 21."), "{text}");
    // For surfaces that are too far away, only the number is printed.
    let text = output("--sampler uniform --samples 4 --filter tent --filter-radius 0.9");
    assert!(text.contains(" more samples have no weight in this pixel"), "{text}");
    let text = output("--jitter --blur");
    assert!(text.contains("weighted mean of 49 samples: subpixels, blurred"), "{text}");
    assert!(text.contains("hits Sphere of line 8"), "{text}");
    assert_eq!(output("--sampler random --samples 5").matches("  sample ").count(), 5);
}

#[test]
fn text_names_objects_by_file_position() {
    let folder = TestFolder::new();
    let result = folder.expect_exit(0, &format!("explain scene.txt --pixel 20,13 {SMALL}"));
    for wanted in [
        "pixel 20,13 = (",
        "weighted mean of 16 samples",
        "hits Sphere of line 8 at t = ",
        "material 0 of line 5",
        "DirectionalLight of line 2: (sum below) · (0.9, 0.9, 0.8)",
        "in eight bits ",
        " alone ",
        "the shadow ray is unoccluded",
    ] {
        assert!(result.out.contains(wanted), "{wanted}\n{}", result.out);
    }
    assert!(!result.out.contains('\x1b'), "no colours into a pipe");
    let result = folder.expect_exit(2, "explain scene.txt --quiet --ray 0;3;0;0;-1;0");
    assert!(result.err.contains("--ray"), "{}", result.err);
    for ray in [
        &["0 3 0 0 -1 0"][..],
        &["0", "3", "0", "0", "-1", "0"],
        &["-0 3 0  0 -1 0"],
        &["-0,3,0,0,-1,0"],
        &["0,3,0, 0,-1,0"],
        &["-0", "3", "0", "0", "-1", "0"],
    ] {
        let output = folder.command("explain scene.txt --quiet --ray").args(ray).output().unwrap();
        let out = String::from_utf8(output.stdout).unwrap();
        assert!(out.contains("camera ray") && out.contains("hits Sphere of line 8 at t = 1.5"), "{out}");
    }
}

/// Prints the vectors of highlights, and the weight of the colour in the glass of 2012.
#[test]
fn formulas_show_all_factors() {
    let folder = TestFolder::new();
    let scene = common::SCENE
        .replace("diffuseColor 0.8 0.3 0.2", "diffuseColor 0.8 0.3 0.2 specularColor 0.5 0.5 0.5 shininess 4");
    for (year, words, wanted) in [
        ("f04", "exponent 4", "H = norm(L + V) = ("),
        ("f12a4", "shininess 4", "R = d - 2 (d·N) N = ("),
        ("f12a5", "refractionIndex 1.5", "`specularColor` (0.5, 0.5, 0.5) · 0.04"),
    ] {
        folder.write("year.txt", scene.replace("shininess 4", words));
        let output =
            folder.expect_exit(0, &format!("explain year.txt --pixel 19,13 --bounces 1 --dialect {year} {SMALL}"));
        assert!(output.out.contains(wanted), "{year}: {}", output.out);
    }
    folder.expect_exit(0, &format!("explain scene.txt --pixel 19,13 --transfer linear --html linear.html {SMALL}"));
    assert!(String::from_utf8(folder.bytes("linear.html")).unwrap().contains("\"transfer\":\"linear\""));
}

/// Omits small and deep terms and says that they are omitted. Prints no minus sign before 0, and
/// prints at most four digits.
#[test]
fn text_is_readable() {
    let folder = TestFolder::new();
    let output = |options: &str| {
        folder.expect_exit(0, &format!("explain scene.txt --pixel 20,26 --samples 1 {options} {SMALL}")).out
    };
    let all = output("");
    assert!(all.contains("mirrored light\n") && !all.contains("index 1 to 1"), "{all}");
    assert!(!all.contains("-0,") && !all.contains("-0)"), "{all}");
    let digits =
        |word: &str| word.chars().filter(char::is_ascii_digit).collect::<String>().trim_start_matches('0').len();
    assert!(all.split(|c: char| !(c.is_ascii_digit() || c == '.')).all(|word| digits(word) <= 4), "{all}");
    let pruned = output("--min 20%");
    assert!(pruned.contains("of less than 20 % each (--min)") && pruned.len() < all.len(), "{pruned}");
    let flat = output("--depth 3");
    assert!(flat.contains(" below (--depth)") && flat.len() < all.len(), "{flat}");
}

#[test]
fn brightest_and_worst_pixels_are_found() {
    let folder = TestFolder::new();
    let scene = common::SCENE.replace("color 0.2 0.1 0.5", "color 0 0 0");
    folder.write("dark.txt", scene);
    folder.expect_exit(0, &format!("render dark.txt -o p.pfm {SMALL}"));
    let picture = folder.image("p.pfm");
    let light = |x, y| picture.get(x, y).unwrap().dot([0.2126, 0.7152, 0.0722].into());
    let output = folder.expect_exit(0, &format!("explain dark.txt --brightest --json {SMALL}"));
    let json: Value = serde_json::from_str(&output.out).unwrap();
    let (x, y) = (json["pixel"]["x"].as_u64().unwrap() as u32, json["pixel"]["y"].as_u64().unwrap() as u32);
    let most = (0..30).flat_map(|y| (0..40).map(move |x| (x, y))).map(|(x, y)| light(x, y)).fold(0.0, f32::max);
    assert_eq!(light(x, y), most);
    folder.expect_exit(0, &format!("explain dark.txt --worst {SMALL}"));
}

#[test]
fn invalid_options_are_refused() {
    let folder = TestFolder::new();
    for (question, answer) in [
        ("", "choose a pixel or a ray"),
        ("--pixel 40,3", "pixel 40,3 is outside the picture of 40 x 30 pixels"),
        ("--pixel 4;3", "for example 200,150"),
        ("--pixel 4,3 --sample 16", "no sample 16: the pixel's samples are numbered from 0 to 15"),
        ("--pixel 4,3 --time-limit 1s", "`--time-limit` is an option of `durer render`"),
        ("--pixel 4,3 --brightest", "cannot be used with"),
    ] {
        let output = folder.expect_exit(2, &format!("explain scene.txt {SMALL} {question}"));
        assert!(output.err.contains(answer), "{question}: {}", output.err);
    }
}

#[test]
fn page_is_self_contained() {
    let folder = TestFolder::new();
    folder.write("a<b.txt", common::SCENE);
    let output = folder.expect_exit(0, "explain a<b.txt --pixel 20,12 --size 40x30 --html why.html");
    assert!(output.out.contains("wrote why.html"), "{}", output.out);
    let page = std::fs::read_to_string(folder.path("why.html")).unwrap();
    assert!(page.contains("data:image/png;base64,iVBOR") && page.contains("a\\u003cb.txt") && !page.contains("@DATA@"));
    // The namespaces of XML are never loaded.
    let page = page.replace("http://www.w3.org/", "");
    assert!(!page.contains("http:") && !page.contains("https:"), "nothing is fetched");
}

/// Collects the field names and node kinds in a JSON value.
fn words(json: &Value, found: &mut std::collections::BTreeSet<String>) {
    match json {
        Value::Array(values) => values.iter().for_each(|value| words(value, found)),
        Value::Object(fields) => {
            for (name, value) in fields {
                // Some objects have numbers as keys.
                if name.parse::<u32>().is_err() {
                    found.insert(name.clone());
                }
                match (name.as_str(), value.as_str()) {
                    ("kind" | "from", Some(kind)) => drop(found.insert(kind.into())),
                    _ => words(value, found),
                }
            }
        }
        _ => {}
    }
}

#[test]
fn every_json_field_is_documented() {
    let (folder, mut found) = (TestFolder::new(), Default::default());
    let glass = common::ENDLESS.replace("indexOfRefraction", "refractionIndex");
    folder.write("glass.txt", glass);
    for arguments in [
        "scene.txt --pixel 20,26 --bounces 1 --samples 1",
        "scene.txt --pixel 0,0 --jitter --blur",
        "scene.txt --pixel 20,13 --sampler random --samples 2 --filter box",
        "glass.txt --pixel 20,13 --bounces 3 --min-throughput 0.5 --samples 1",
    ] {
        let output = folder.expect_exit(0, &format!("explain {arguments} --json {SMALL}"));
        words(&serde_json::from_str(&output.out).unwrap(), &mut found);
    }
    assert!(found.len() > 60, "{found:?}");
    let guide = std::fs::read_to_string(concat!(env!("CARGO_MANIFEST_DIR"), "/../../docs/explain.md")).unwrap();
    let missing: Vec<_> = found.iter().filter(|word| !guide.contains(&format!("`{word}`"))).collect();
    assert!(missing.is_empty(), "{missing:?}");
}

/// Script that unfolds the tree, selects a term and another sample, and rotates the view.
const CLICKS: &str = r##"
(async () => {
  await wait();
  const terms = () => count(".tree [role=treeitem]"), before = terms();
  see(`terms ${before > 5}`);
  find(".tree .fold").click();
  await wait();
  see(`folded ${terms() === 1}`);
  find(".tree .fold").click();
  await wait();
  see(`unfolded ${terms() === before}`);
  see(`shadow rays ${count(".tree .ray-lit, .tree .ray-shadowed")}`);
  document.querySelectorAll(".tree .title")[1].click();
  await wait();
  see(`chosen ${count(".tree .term.chosen")}, formulas ${count(".tree .detail .rows > div") > 0}`);
  see(`share ${find(".tree .share").textContent}`);
  find(".tree .title").click();
  await wait();
  see(`tested ${count(".tests .test")}`);
  const space = find("canvas.rays"), shown = () => space.toDataURL();
  // The view may still be drawing.
  let still = shown();
  for (let last = ""; last !== still; ) {
    last = still;
    await wait();
    still = shown();
  }
  mouse(space, "pointermove", 0.99, 0.99, 0);
  await wait();
  see(`unheld ${shown() === still}`);
  mouse(space, "pointerdown", 0.2, 0.5);
  mouse(space, "pointermove", 0.6, 0.7);
  mouse(space, "pointerup", 0.6, 0.7, 0);
  await wait();
  const turned = shown();
  see(`orbited ${turned !== still}`);
  space.dispatchEvent(new WheelEvent("wheel", { deltaY: -200, bubbles: true, cancelable: true }));
  await wait();
  const nearer = shown();
  see(`nearer ${nearer !== turned}`);
  space.dispatchEvent(new KeyboardEvent("keydown", { key: "ArrowRight", bubbles: true }));
  await wait();
  see(`keys ${shown() !== nearer}`);
  const select = find(".sample-choice select"), old = find(".tree").textContent;
  select.value = "3";
  select.dispatchEvent(new Event("change", { bubbles: true }));
  await wait();
  see(`another sample ${find(".tree").textContent !== old}, ${select.selectedOptions[0].textContent.split(",")[0]}`);
  document.querySelectorAll(".why [role=tab]")[1].click();
  await wait();
  await wait();
  see(`steps ${count(".code li.now")}`);
  const picture = find(".marked-picture img");
  see(`picture ${picture.complete} ${picture.naturalWidth}x${picture.naturalHeight}`);
  done();
})();
"##;

#[test]
fn page_works_in_a_browser_without_network() {
    let folder = TestFolder::new();
    folder.expect_exit(0, &format!("explain scene.txt --pixel 20,26 --html why.html --samples 4 {SMALL}"));
    let wanted = [
        "terms true",
        "folded true",
        "unfolded true",
        // The floor and its reflection each have a ray to the light.
        "shadow rays 2",
        "chosen 1, formulas true",
        "share 100 %",
        "tested 2",
        "unheld true",
        "orbited true",
        "nearer true",
        "another sample true, 3",
        "keys true",
        "steps 1",
        "picture true 40x30",
    ];
    sees(&folder, "why.html", CLICKS, &wanted);
}

const ORIGINS: &str = "PerspectiveCamera { center 0 0 5 direction 0 0 -1 up 0 1 0 angle 60 }
Lights { DirectionalLight { direction 0 -0.2 -1 color 0.8 0.8 0.8 } }
Background { color 0.2 0.3 0.4 ambientLight 0.1 0.1 0.1 }
Materials {
  PhongMaterial { diffuseColor 0.8 0.3 0.2 }
  PhongMaterial { diffuseColor 0.2 0.2 0.2 }
  Checkerboard { materialIndex 0 materialIndex 1 }
  PhongMaterial { texture two.ppm }
  PhongMaterial { diffuseColor 0 0 0 transparentColor 0.9 0.9 0.9 reflectiveColor 0.5 0.5 0.5 indexOfRefraction 1.5 }
}
Group {
  MaterialIndex 0 Transform { Translate 0 0 -1 Sphere { center 0 0 0 radius 1 } }
  MaterialIndex 2 Plane { normal 0 1 0 offset -1.5 }
  MaterialIndex 3 TriangleMesh { obj_file sheet.obj }
  MaterialIndex 4 Sphere { center 3 0 0 radius 1 }
}
";

/// Terms show where they come from, for example the equation of a hit, a matrix, a cell, texels, or
/// Snell's law.
#[test]
fn numbers_say_where_they_come_from() {
    let folder = TestFolder::new();
    folder.write("s.txt", ORIGINS);
    folder.write("two.ppm", "P3\n2 1\n255\n99 99 99 200 20 20\n");
    folder.write(
        "sheet.obj",
        "v -4 -1 0\nv -2 -1 0\nv -2 1 0\nv -4 1 0\nvt 0 0\nvt 1 0\nvt 1 1\nvt 0 1\nf 1/1 2/2 3/3\nf 1/1 3/3 4/4\n",
    );
    for (ray, words) in [
        (
            "0 0 5 0 0 -1",
            &["a t² + 2 b t + c = 0: a = d·d = 1", "c = |o - C|² - r² = 35", "= 5 or 7", "M = (1 0 0 0)"][..],
        ),
        (
            "0 0 5 0 -0.5 -1",
            &["t = (offset - n·o) / n·d = (-1.5 - 0) / -0.4472 = 3.354", "checkerboard: ", "material "],
        ),
        ("-3.2 0.1 5 0 0 -1", &["texture `two.ppm` of 2 x 1 texels", "99 99 99 by the sRGB curve", "· texel (0, 0)"]),
        ("3.3 0 5 0 0 -1", &["Snell: sin i = 0.3, sin t = n₁/n₂ sin i = 1 / 1.5 · 0.3 = 0.2"]),
    ] {
        let text = folder.expect_exit(0, &format!("explain s.txt --bounces 2 --ray {ray}")).out;
        for word in words {
            assert!(text.contains(word), "`{word}` is not in:\n{text}");
        }
        let json = folder.expect_exit(0, &format!("explain s.txt --bounces 2 --json --ray {ray}")).out;
        assert!(json.contains("\"origins\"") && json.contains(words[0]), "{json}");
    }
    // The sky comes from the face that the ray hits.
    std::fs::create_dir(folder.path("sky")).unwrap();
    for face in ["left", "right", "up", "down", "front", "back"] {
        folder.write(&format!("sky/{face}.ppm"), "P3\n1 1\n255\n99 99 99\n");
    }
    folder.write("sky.txt", ORIGINS.replace("Background {", "Background { cubeMap sky"));
    for form in ["", "--json"] {
        let text = folder.expect_exit(0, &format!("explain sky.txt --ray 0 40 5 0.1 1 0.1 {form}")).out;
        assert!(text.contains("face `up` of the cube map `sky` of 1 x 1 texels"), "{text}");
        assert!(text.contains("1 · texel (0, 0): 99 99 99 by the sRGB curve"), "{text}");
    }
}
