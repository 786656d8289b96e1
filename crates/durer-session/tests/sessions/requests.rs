//! Tests that the answers about rays, structures, pixels and models agree with the library.

use crate::page::{Page, scene};
use durer_session::SessionFiles;
use durer_session::protocol::{Event, NamedChoice, PictureInfo, SceneNode, Structure, Traversal};
use serde_json::json;

const CAMERA: &str = "PerspectiveCamera { center 0 0 9 direction 0 0 -1 up 0 1 0 angle 40 }";

/// Returns a scene of sixty small balls on a floor.
fn balls() -> String {
    let ball = |i: i32| {
        let (x, y, z) = (i % 5 - 2, i / 5 % 4 - 1, i / 20 - 1);
        format!("Sphere {{ center {}.1 {} {}.3 radius 0.35 }}", x, y, z)
    };
    let all: Vec<String> = (0..60).map(ball).collect();
    format!("{CAMERA}\nGroup {{ Plane {{ normal 0 1 0 offset -3 }} {} }}\n", all.join("\n"))
}

fn open(text: &str) -> Page {
    let mut page = Page::new(None);
    page.ask(&json!({ "kind": "open", "name": "scene.txt", "text": text }).to_string());
    page
}

fn one(page: &mut Page, request: serde_json::Value) -> Event {
    let mut answers = page.ask(&request.to_string());
    assert_eq!(answers.len(), 1, "{request}: {answers:?}");
    answers.remove(0).0
}

fn walk(page: &mut Page, structure: Structure, origin: [f32; 3], direction: [f32; 3]) -> Traversal {
    let ask = json!({ "kind": "walk", "structure": structure, "origin": origin, "direction": direction, "any": false });
    let Event::Walk { walk } = one(page, ask) else { panic!() };
    walk
}

#[test]
fn all_structures_find_the_hit_and_a_tree_tests_least() {
    let mut page = open(&balls());
    let mut tested = [0, 0, 0];
    for turn in 0..30_i16 {
        let direction = [0.04 * f32::from(turn - 15), 0.03 * f32::from(turn % 7 - 3), -1.0];
        let origin = [0.05, 0.1, 9.0];
        let ask = json!({ "kind": "cast", "origin": origin, "direction": direction, "t_max": null });
        let Event::Cast { cast } = one(&mut page, ask) else { panic!() };
        let wanted = cast.hit.map(|hit| (hit.object, hit.t));
        for (i, structure) in [Structure::Nothing, Structure::Grid, Structure::Tree].into_iter().enumerate() {
            let walk = walk(&mut page, structure, origin, direction);
            assert_eq!(walk.hit.map(|hit| (hit.object, hit.t.unwrap())), wanted, "{structure:?} {direction:?}");
            assert_eq!(walk.objects, 61);
            assert_eq!(walk.tests as usize, walk.steps.iter().map(|step| step.tests.len()).sum::<usize>());
            let ends: Vec<f32> = walk.steps.iter().map(|step| step.closest.unwrap_or(f32::INFINITY)).collect();
            assert!(ends.windows(2).all(|pair| pair[1] <= pair[0]), "{ends:?}");
            tested[i] += walk.tests;
        }
    }
    assert_eq!(tested[0], 30 * 61);
    assert!(tested[1] < tested[0] / 2 && tested[2] < tested[0] / 3, "{tested:?}");
}

#[test]
fn boxes_come_level_by_level_and_lie_in_the_first() {
    let mut page = Page::new(Some(scene("knot.txt")));
    page.ask(r#"{"kind":"open","name":"","text":null}"#);
    let Event::Boxes { boxes } = one(&mut page, json!({ "kind": "boxes" })) else { panic!() };
    assert!(boxes.len() > 100 && boxes[0].level == 0);
    assert!(boxes.windows(2).all(|pair| pair[0].level <= pair[1].level));
    let corner = |i: usize, corner: usize| &boxes[i].corners[3 * corner..3 * corner + 3];
    for i in 0..boxes.len() {
        for (axis, x) in corner(i, 0).iter().enumerate() {
            assert!(*x >= corner(0, 0)[axis] - 1e-4 && corner(i, 7)[axis] <= corner(0, 7)[axis] + 1e-4);
        }
    }
}

#[test]
fn rays_of_the_camera_are_those_of_its_pixels() {
    let mut page = open(&balls());
    let Event::Rays { rays } = one(&mut page, json!({ "kind": "rays", "columns": 9, "rows": 5, "row": 2 })) else {
        panic!()
    };
    assert_eq!(rays.len(), 9);
    let middle = rays[4].as_ref().unwrap();
    assert_eq!((middle.origin, middle.direction), ([0.0, 0.0, 9.0], [0.0, 0.0, -1.0]));
    let ask = json!({ "kind": "cast", "origin": middle.origin, "direction": middle.direction, "t_max": null });
    let Event::Cast { cast } = one(&mut page, ask) else { panic!() };
    assert_eq!(middle.t, cast.hit.map(|hit| hit.t));
    // A circular picture has no rays in its corners.
    let mut page = Page::new(Some(scene("fisheye.txt")));
    page.ask(r#"{"kind":"open","name":"","text":null}"#);
    let Event::Rays { rays } = one(&mut page, json!({ "kind": "rays", "columns": 8, "rows": 8, "row": null })) else {
        panic!()
    };
    assert!(rays[0].is_none() && rays[8 * 4 + 4].is_some());
    for (columns, rows, row) in [(0, 1, None), (1, 2, Some(2)), (70_000, 1, None), (4000, 4000, None)] {
        let ask = json!({ "kind": "rays", "columns": columns, "rows": rows, "row": row });
        assert!(matches!(one(&mut page, ask), Event::Refused { .. }), "{columns} {rows} {row:?}");
    }
}

fn last(page: &mut Page) -> (PictureInfo, Vec<u8>) {
    page.pictures().pop().unwrap()
}

#[test]
fn a_part_of_the_picture_has_the_pixels_of_the_whole() {
    let mut page = Page::new(Some(scene("whitted.txt")));
    page.ask(r#"{"kind":"open","name":"","text":null}"#);
    page.ask(r#"{"kind":"size","width":90,"height":60}"#);
    let whole = last(&mut page);
    assert_eq!(whole.0.region, [0, 0, 90, 60]);
    page.ask(r#"{"kind":"crop","crop":[31,22,20,11]}"#);
    let part = last(&mut page);
    assert_eq!((part.0.region, part.0.width, part.0.height), ([31, 22, 20, 11], 20, 11));
    for (i, pixel) in part.1.chunks(4).enumerate() {
        let at = 4 * ((22 + i / 20) * 90 + 31 + i % 20);
        assert_eq!(pixel, &whole.1[at..at + 4], "{i}");
    }
    // A crop that extends beyond the edges is clipped to the picture.
    page.ask(r#"{"kind":"crop","crop":[80,50,4000000000,4000000000]}"#);
    assert_eq!(last(&mut page).0.region, [80, 50, 10, 10]);
    page.ask(r#"{"kind":"crop","crop":null}"#);
    assert_eq!(last(&mut page).0.hash, whole.0.hash);
}

#[test]
fn numbers_of_pixels_are_the_light_that_is_shown() {
    let mut page = Page::new(Some(scene("whitted.txt")));
    page.ask(r#"{"kind":"open","name":"","text":null}"#);
    page.ask(r#"{"kind":"size","width":90,"height":60}"#);
    let (_, bytes) = last(&mut page);
    let Event::Values { values, .. } =
        one(&mut page, json!({ "kind": "values", "left": 40, "top": 20, "width": 3, "height": 2 }))
    else {
        panic!()
    };
    assert_eq!(values.len(), 18);
    for (i, value) in values.chunks(3).enumerate() {
        let at = 4 * ((20 + i / 3) * 90 + 40 + i % 3);
        let light = durer::math::Vec3::from([0, 1, 2].map(|axis| value[axis].unwrap()));
        assert_eq!(durer::image::Transfer::Srgb.encode_pixel(light), bytes[at..at + 3]);
    }
    for ask in [[0, 0, 100, 1], [89, 0, 2, 1], [0, 0, 0, 0], [0, 0, 90, 60]] {
        let [left, top, width, height] = ask;
        let ask = json!({ "kind": "values", "left": left, "top": top, "width": width, "height": height });
        assert!(matches!(one(&mut page, ask.clone()), Event::Refused { .. }), "{ask}");
    }
}

#[test]
fn denoising_changes_what_is_shown_and_not_the_sums() {
    let mut page = Page::new(Some(scene("cornell-box.txt")));
    page.ask(r#"{"kind":"open","name":"","text":null}"#);
    page.ask(r#"{"kind":"options","options":[{"name":"samples","value":"8"}]}"#);
    page.ask(r#"{"kind":"size","width":64,"height":64}"#);
    let pictures = page.pictures();
    assert!(pictures.iter().any(|(head, _)| head.left_ms.is_some_and(|left| left >= 0.0)));
    let noisy = pictures.into_iter().next_back().unwrap();
    assert!(noisy.0.noise.is_some_and(|noise| noise > 1e-3) && !noisy.0.denoised);
    let mut answers = page.ask(r#"{"kind":"denoise","on":true}"#);
    let (Event::Picture { head }, clean) = answers.remove(0) else { panic!() };
    assert!(head.denoised && head.hash == noisy.0.hash && clean != noisy.1);
    let rough = |bytes: &[u8]| {
        bytes.chunks(4).zip(bytes[4..].chunks(4)).map(|(a, b)| u32::from(a[0].abs_diff(b[0]))).sum::<u32>()
    };
    assert!(rough(&clean) < rough(&noisy.1));
    let mut answers = page.ask(r#"{"kind":"denoise","on":false}"#);
    let (Event::Picture { head }, again) = answers.remove(0) else { panic!() };
    assert!(!head.denoised && again == noisy.1);
}

#[test]
fn an_epsilon_is_a_rule_of_the_scene_until_it_is_taken_back() {
    let text = format!(
        "{CAMERA}\nLights {{ PointLight {{ position 3 4 6 color 1 1 1 }} }}\nMaterials {{ PhongMaterial {{ diffuseColor 1 1 1 }} }}\n\
         Group {{ MaterialIndex 0 Sphere {{ center 0 0 0 radius 1.7 }} }}\n"
    );
    let mut page = open(&text);
    page.ask(r#"{"kind":"size","width":64,"height":64}"#);
    let exact = last(&mut page);
    let dark = |bytes: &[u8]| bytes.chunks(4).filter(|pixel| pixel[0] < 5).count();
    page.ask(r#"{"kind":"epsilon","epsilon":0.0}"#);
    let acne = last(&mut page);
    assert!(dark(&acne.1) > dark(&exact.1), "{} {}", dark(&acne.1), dark(&exact.1));
    page.ask(r#"{"kind":"epsilon","epsilon":0.001}"#);
    assert!(dark(&last(&mut page).1).abs_diff(dark(&exact.1)) < 5);
    page.ask(r#"{"kind":"epsilon","epsilon":null}"#);
    assert_eq!(last(&mut page).0.hash, exact.0.hash);
    let refused = one(&mut page, json!({ "kind": "epsilon", "epsilon": -1.0 }));
    assert!(matches!(refused, Event::Refused { .. }));
}

fn count(nodes: &[SceneNode]) -> usize {
    nodes.iter().map(|node| 1 + count(&node.nodes)).sum()
}

#[test]
fn a_model_has_a_tree_and_materials_that_change_and_becomes_a_text() {
    let mut page = Page::new(Some(scene("meshes/knot.ply")));
    let opened = page.ask(r#"{"kind":"open","name":"","text":null}"#);
    assert!(matches!(opened[0].0, Event::Opened { text: None, saves: false, .. }), "{opened:?}");
    page.ask(r#"{"kind":"size","width":48,"height":48}"#);
    page.ask(r#"{"kind":"options","options":[{"name":"samples","value":"4"}]}"#);
    let before = last(&mut page);
    let Event::Tree { nodes, materials } = one(&mut page, json!({ "kind": "tree" })) else { panic!() };
    assert!(count(&nodes) > 0 && !materials.is_empty(), "{nodes:?}");
    let (number, field) = materials
        .iter()
        .enumerate()
        .find_map(|(i, material)| {
            Some((
                i,
                material
                    .fields
                    .iter()
                    .find(|field| field.name.to_lowercase().contains("color") && field.values.len() == 3)?,
            ))
        })
        .unwrap();
    let set = |values: [f32; 3]| json!({ "kind": "material", "number": number, "name": field.name, "values": values });
    let red = page.ask(&set([0.9, 0.02, 0.02]).to_string());
    assert!(matches!(red[0].0, Event::Scene { contents: Some(_), .. }), "{red:?}");
    let red = last(&mut page);
    assert!(red.1 != before.1 && red.0.hash != before.0.hash);
    let short = json!({ "kind": "material", "number": number, "name": field.name, "values": [0.5] });
    assert!(matches!(one(&mut page, short), Event::Refused { .. }));
    let absent = json!({ "kind": "material", "number": 999, "name": field.name, "values": [0.5, 0.5, 0.5] });
    assert!(matches!(one(&mut page, absent), Event::Refused { .. }));
    // After conversion to text, the scene gives the same picture, apart from the rounding of its
    // numbers.
    let opened = page.ask(r#"{"kind":"as_text"}"#);
    let Event::Opened { text: Some(text), name, .. } = &opened[0].0 else { panic!("{opened:?}") };
    assert!(name == "knot.txt" && text.contains("knot/"), "{name} {text}");
    assert!(matches!(opened[1].0, Event::Scene { contents: Some(_), .. }), "{opened:?}");
    let text = last(&mut page);
    let off: u32 = text.1.iter().zip(&red.1).map(|(a, b)| u32::from(a.abs_diff(*b))).sum();
    assert!(f64::from(off) / (text.1.len() as f64) < 3.0, "{off}");
    let mut packed = page.ask(r#"{"kind":"pack"}"#);
    let (Event::Packed { names, sizes }, bytes) = packed.remove(0) else { panic!() };
    assert_eq!(names[0], "knot.txt");
    assert!(names.len() > 1 && sizes.iter().map(|size| *size as usize).sum::<usize>() == bytes.len());
    // If a scene has text, its materials are edited in the text.
    assert!(matches!(one(&mut page, set([0.1; 3])), Event::Refused { .. }));
}

#[test]
fn a_lesson_and_scenes_beside_it_are_read_from_its_folder_alone() {
    let folder = tempfile::tempdir().unwrap();
    let inner = folder.path().join("inner");
    std::fs::create_dir(&inner).unwrap();
    std::fs::write(folder.path().join("secret.txt"), balls()).unwrap();
    std::fs::write(inner.join("balls.txt"), balls()).unwrap();
    std::fs::write(inner.join("monday.md"), "# Balls\n\n![Sixty](balls.txt)\n").unwrap();
    let mut page = Page::begin(SessionFiles { file: None, lesson: Some(inner.join("monday.md")) });
    let Event::Lesson { text: Some(text) } = one(&mut page, json!({ "kind": "lesson" })) else { panic!() };
    assert!(text.starts_with("# Balls"));
    let opened = page.ask(r#"{"kind":"open","name":"balls.txt","text":null}"#);
    assert!(matches!(&opened[1].0, Event::Scene { contents: Some(contents), .. } if contents.object_count == 61));
    for name in ["../secret.txt", "secret.txt", folder.path().join("secret.txt").to_str().unwrap()] {
        let answer = one(&mut page, json!({ "kind": "open", "name": name, "text": null }));
        assert!(matches!(answer, Event::Refused { .. }), "{name}");
    }
    assert!(matches!(one(&mut Page::new(None), json!({ "kind": "lesson" })), Event::Lesson { text: None }));
}

#[test]
fn shadow_rays_end_at_any_hit() {
    let mut page = open(&balls());
    let mut counts = [0, 0];
    for turn in 0..30_i16 {
        let direction = [0.04 * f32::from(turn - 15), 0.03 * f32::from(turn % 7 - 3), -1.0];
        for structure in [Structure::Nothing, Structure::Grid, Structure::Tree] {
            let mut ask = |any: bool, t_max: Option<f32>| {
                let ask = json!({ "kind": "walk", "structure": structure, "origin": [0.05, 0.1, 9.0],
                    "direction": direction, "t_max": t_max, "any": any });
                let Event::Walk { walk } = one(&mut page, ask) else { panic!() };
                walk
            };
            let (closest, any) = (ask(false, None), ask(true, None));
            assert_eq!(any.hit.is_some(), closest.hit.is_some());
            assert!(any.tests <= closest.tests);
            let hits = any.steps.iter().flat_map(|step| &step.tests).filter(|test| test.t.is_some()).count();
            assert_eq!(hits, usize::from(any.hit.is_some()), "a shadow ray ends at its first hit");
            counts[0] += closest.tests;
            counts[1] += any.tests;
            let before = closest.hit.and_then(|hit| hit.t).map(|t| 0.5 * t);
            assert!(before.is_none_or(|before| ask(true, Some(before)).hit.is_none()));
        }
    }
    assert!(counts[1] < counts[0], "{counts:?}");
}

#[test]
fn cameras_change_their_kind_and_keep_their_place() {
    let mut page = Page::new(None);
    let text = balls();
    let opened = page.ask(&json!({ "kind": "open", "name": "scene.txt", "text": text }).to_string());
    let Event::Opened { cameras, .. } = &opened[0].0 else { panic!() };
    assert!(cameras.len() >= 15);
    for camera in cameras {
        let ask = json!({ "kind": "camera", "keyword": camera.name });
        let Event::Camera { camera: state } = one(&mut page, ask) else { panic!("{}", camera.name) };
        assert_eq!(state.keyword, camera.name);
        assert!(!camera.doc.is_empty());
        let pinholes = ["PerspectiveCamera", "PinholeCamera", "ThinLensCamera", "ProjectiveCamera"];
        assert_eq!(state.projects, pinholes.contains(&state.keyword.as_str()), "{}", state.keyword);
        let [eye, wanted] = [state.eye, [0.0, 0.0, 9.0]].map(glam::Vec3::from);
        assert!(eye.distance(wanted) < 1e-4, "{}: {eye}", state.keyword);
    }
    let ask = json!({ "kind": "camera", "keyword": "Camcorder" });
    assert!(matches!(one(&mut page, ask), Event::Refused { .. }));
    // The text with each camera is valid and has that camera.
    let Event::Opened { cameras, .. } = opened[0].0.clone() else { panic!() };
    for NamedChoice { name, .. } in cameras {
        let mut page = open(&text);
        one(&mut page, json!({ "kind": "camera", "keyword": name }));
        let written = page.ask(&json!({ "kind": "write_camera" }).to_string());
        let Event::Text { text, .. } = &written[0].0 else { panic!("{written:?}") };
        assert!(text.starts_with(&format!("{name} {{")), "{text}");
        let Event::Scene { contents: Some(contents), .. } = &written[1].0 else { panic!("{name}: {:?}", written[1]) };
        assert!(!contents.camera.moved, "{name}: {}", contents.camera.statement);
    }
}

#[test]
fn fields_state_their_bounds_and_words() {
    let mut page = open(&balls());
    let Event::Camera { camera } = one(&mut page, json!({ "kind": "camera", "keyword": "FisheyeCamera" })) else {
        panic!()
    };
    for field in &camera.fields {
        assert!(field.choices.is_empty() || field.choices.contains(&field.text), "{field:?}");
    }
    let field = |name: &str| camera.fields.iter().find(|field| field.name == name).unwrap().clone();
    let angle = field("angle");
    assert_eq!((angle.least, angle.above_least, angle.whole), (Some(0.0), true, false), "{angle:?}");
    let word = camera.fields.iter().find(|field| field.choices.len() > 1).unwrap();
    let last = word.choices.last().unwrap();
    let ask = json!({ "kind": "field", "name": word.name, "values": [], "word": last, "moving": false });
    let Event::Camera { camera: changed } = one(&mut page, ask) else { panic!() };
    assert_eq!(&changed.fields.iter().find(|field| field.name == word.name).unwrap().text, last);
    let ask = json!({ "kind": "field", "name": word.name, "values": [], "word": "sideways", "moving": false });
    let Event::Refused { why } = one(&mut page, ask) else { panic!() };
    assert!(why.contains(last), "{why}");
}

#[test]
fn places_include_the_block_of_a_statement() {
    let text = balls();
    let mut page = Page::new(None);
    let answers = page.ask(&json!({ "kind": "open", "name": "scene.txt", "text": text }).to_string());
    let Event::Scene { contents: Some(contents), .. } = &answers[1].0 else { panic!() };
    let place = contents.objects[1].place.unwrap();
    let statement = &text[place.start as usize..place.block_end as usize];
    assert_eq!(statement, "Sphere { center -2.1 -1 -1.3 radius 0.35 }");
    assert_eq!(&text[place.start as usize..place.end as usize], "Sphere");
}

#[test]
fn mistakes_are_listed_and_rendered() {
    let mut page = open(
        "PerspectiveCamera { center 0 0 9 direction 0 0 -1 up 0 1 0 angle 40 }
        Lights { PointLight { position 4 6 8 color 1 1 1 } }
        Materials { PhongMaterial { diffuseColor 1 0.5 0.2 } }
        Group { MaterialIndex 0 Transform { Scale 1 3 1 Sphere { center 0 0 0 radius 1 } } }",
    );
    let Event::Mistakes { mistakes } = one(&mut page, json!({ "kind": "mistakes" })) else { panic!() };
    assert!(mistakes.len() > 200);
    assert!(mistakes.iter().all(|mistake| !mistake.description.is_empty() && !mistake.values.is_empty()));
    let mut render = |name: Option<&str>| {
        let ask = json!({ "kind": "mistake", "name": name, "value": null, "width": 40, "height": 30 });
        let mut answers = page.ask(&ask.to_string());
        let (Event::Mistaken { width: 40, height: 30, changed, mistake }, bytes) = answers.remove(0) else { panic!() };
        assert_eq!(bytes.len(), 4 * 40 * 30);
        assert_eq!(mistake.map(|mistake| mistake.name).as_deref(), name);
        (changed, bytes)
    };
    let (none, right) = render(None);
    assert_eq!(none, 0.0);
    let (changed, wrong) = render(Some("normals-moved"));
    let counted = right.chunks(4).zip(wrong.chunks(4)).filter(|(right, wrong)| right != wrong).count();
    assert!(changed > 0.05, "{changed}");
    assert_eq!(changed, counted as f64 / 1200.0);
    // The correct picture is the one that the session shows.
    page.ask(r#"{"kind":"size","width":40,"height":30}"#);
    assert!(page.pictures().pop().unwrap().1 == right);
    let ask = json!({ "kind": "mistake", "name": "typo", "width": 40, "height": 30 });
    assert!(matches!(one(&mut page, ask), Event::Refused { .. }));
    let ask = json!({ "kind": "mistake", "name": null, "width": 1 << 20, "height": 1 << 20 });
    assert!(matches!(one(&mut page, ask), Event::Refused { .. }));
}
