//! Tests that the pictures of sessions are bit-identical to those of the library, regardless of
//! earlier requests.

use crate::page::{Page, scene};
use durer::prelude::*;
use durer_session::protocol::Event;

/// Renders a picture in one pass and returns its hash.
fn hash(scene: &CompiledScene, job: RenderJob) -> String {
    let job = scene.job(&job).unwrap();
    let part = durer::render::PartialRender::new(scene.world(), &job, durer::render::Shard::WHOLE).unwrap();
    part.render(scene.world(), &Control::default(), &mut |_, _| {}).unwrap();
    part.hash().to_string()
}

#[test]
fn finished_pictures_have_the_hash_of_the_command() {
    for (name, integrator) in [
        ("whitted.txt", ""),
        ("cornell-box.txt", ""),
        ("mirrors.txt", "ao"),
        ("transforms.txt", ""),
        ("caustic.txt", "photons"),
    ] {
        let mut page = Page::new(Some(scene(name)));
        let opened = page.ask(r#"{"kind":"open","name":"","text":null}"#);
        assert!(matches!(opened[0].0, Event::Opened { saves: true, .. }), "{name}: {opened:?}");
        page.ask(r#"{"kind":"size","width":96,"height":64}"#);
        let mut job = RenderJob::default().size((96, 64)).samples(3_u32);
        let mut options = r#"{"name":"samples","value":"3"}"#.to_string();
        if !integrator.is_empty() {
            job = job.integrator(integrator);
            options += &format!(r#",{{"name":"integrator","value":"{integrator}"}}"#);
        }
        page.ask(&format!(r#"{{"kind":"options","options":[{options}]}}"#));
        let pictures = page.pictures();
        let (first, last) = (&pictures[0].0, &pictures[pictures.len() - 1]);
        assert!(first.width < 96 && first.hash.is_none(), "{name}: the first picture is coarse: {first:?}");
        assert_eq!(last.1.len(), 4 * 96 * 64);
        assert_eq!(last.0.hash, Some(hash(&durer::open(scene(name)).unwrap(), job)), "{name}");
    }
}

#[test]
fn motion_renders_coarse_pictures_only_and_home_restores_the_picture() {
    let mut page = Page::new(Some(scene("sphere.txt")));
    page.ask(r#"{"kind":"open","name":"","text":null}"#);
    page.ask(r#"{"kind":"size","width":80,"height":60}"#);
    let before = page.pictures().pop().unwrap();
    for _ in 0..5 {
        page.ask(r#"{"kind":"move","motion":{"kind":"orbit","right":0.3,"up":0.1},"moving":true}"#);
        let pictures = page.pictures();
        assert_eq!(pictures.len(), 1);
        assert_eq!(pictures[0].0.hash, None);
    }
    page.ask(r#"{"kind":"move","motion":{"kind":"orbit","right":0.0,"up":0.0},"moving":false}"#);
    assert_ne!(page.pictures().pop().unwrap().1, before.1);
    page.ask(r#"{"kind":"move","motion":{"kind":"home"},"moving":false}"#);
    let home = page.pictures().pop().unwrap();
    assert_eq!((home.1, home.0.hash), (before.1, before.0.hash));
}

#[test]
fn camera_written_into_text_renders_the_same_picture() {
    let mut page = Page::new(None);
    let text = std::fs::read_to_string(scene("whitted.txt")).unwrap();
    let open = serde_json::json!({ "kind": "open", "name": "scene.txt", "text": text });
    page.ask(&open.to_string());
    page.ask(r#"{"kind":"size","width":64,"height":48}"#);
    page.ask(r#"{"kind":"move","motion":{"kind":"orbit","right":0.7,"up":-0.2},"moving":false}"#);
    let moved = page.pictures().pop().unwrap();
    let written = page.ask(r#"{"kind":"write_camera"}"#);
    let Event::Text { text: now, from_disk: false } = &written[0].0 else { panic!("{written:?}") };
    assert!(now.contains("# Homage to Turner Whitted") && now.contains("PerspectiveCamera { center "), "{now}");
    assert_eq!(now.lines().count(), text.lines().count());
    assert_eq!(page.pictures().pop().unwrap().0.hash, moved.0.hash);
    // The command renders the same picture from the text that the session wrote.
    let folder = std::env::temp_dir().join(format!("durer-session-{}.txt", std::process::id()));
    std::fs::write(&folder, now).unwrap();
    let command = hash(&durer::open(&folder).unwrap(), RenderJob::default().size((64, 48)));
    std::fs::remove_file(&folder).unwrap();
    assert_eq!(moved.0.hash, Some(command));
}

#[test]
fn text_with_errors_keeps_the_picture_and_reports_the_place() {
    let mut page = Page::new(None);
    let text = std::fs::read_to_string(scene("sphere.txt")).unwrap();
    page.ask(&serde_json::json!({ "kind": "open", "name": "scene.txt", "text": text }).to_string());
    page.ask(r#"{"kind":"size","width":32,"height":32}"#);
    let before = page.pictures().pop().unwrap();
    let broken = text.replace("Sphere {", "Sphre {");
    let answers = page.ask(&serde_json::json!({ "kind": "edit", "text": broken }).to_string());
    let Event::Scene { findings, contents: None, .. } = &answers[0].0 else { panic!("{answers:?}") };
    let place = findings[0].place.unwrap();
    assert_eq!(&broken[place.start as usize..place.end as usize], "Sphre");
    assert_eq!(place.line as usize, broken[..place.start as usize].lines().count());
    assert!(findings[0].help.as_deref().unwrap_or_default().contains("Sphere"), "{findings:?}");
    let answers = page.ask(&serde_json::json!({ "kind": "edit", "text": text }).to_string());
    assert!(matches!(answers[0].0, Event::Scene { contents: Some(_), .. }));
    assert_eq!(page.pictures().pop().unwrap().0.hash, before.0.hash);
}

#[test]
fn terms_of_a_pixel_sum_to_it() {
    for name in ["whitted.txt", "cornell-box.txt"] {
        let mut page = Page::new(Some(scene(name)));
        page.ask(r#"{"kind":"open","name":"","text":null}"#);
        page.ask(r#"{"kind":"options","options":[{"name":"samples","value":"4"}]}"#);
        page.ask(r#"{"kind":"size","width":60,"height":60}"#);
        for (x, y) in [(20, 24), (30, 44), (41, 33)] {
            let answers = page.ask(&format!(r#"{{"kind":"explain","x":{x},"y":{y},"sample":2}}"#));
            let Event::Explained { pixel } = &answers[0].0 else { panic!("{answers:?}") };
            let tree = pixel.tree.as_ref().unwrap();
            fn leaves(term: &durer_session::protocol::Term, sum: &mut [f64; 3]) {
                match term.terms.is_empty() {
                    true => (0..3).for_each(|i| sum[i] += f64::from(term.adds[i])),
                    false => term.terms.iter().for_each(|term| leaves(term, sum)),
                }
            }
            let mut sum = [0.0; 3];
            leaves(tree, &mut sum);
            for i in 0..3 {
                let whole = f64::from(tree.adds[i]);
                assert!((sum[i] - whole).abs() <= 1e-5 * (1.0 + whole), "{name} {x},{y}: {sum:?} {:?}", tree.adds);
            }
        }
    }
}

#[test]
fn cast_reports_a_verdict_for_each_object() {
    let mut page = Page::new(Some(scene("whitted.txt")));
    page.ask(r#"{"kind":"open","name":"","text":null}"#);
    let answers = page.ask(r#"{"kind":"cast","origin":[1.15,1.2,6],"direction":[0,0,-2],"t_max":null}"#);
    let Event::Cast { cast } = &answers[0].0 else { panic!("{answers:?}") };
    let verdicts: Vec<String> = cast.tests.iter().map(|test| format!("{:?}", test.verdict)).collect();
    assert_eq!(verdicts, ["Missed", "Missed", "Closest"]);
    assert_eq!(cast.hit.as_ref().unwrap().object, 2);
    // The centre of the sphere is at z = -1.6, and its radius is 1.2. The ray starts at z = 6 and
    // moves by 2 units per unit of t.
    let value = |name: &str| cast.tests[2].rows.iter().find(|row| row.name == name).unwrap().value.unwrap();
    assert!((value("t₁") - 3.2).abs() < 1e-6 && (value("t₂") - 4.4).abs() < 1e-6);
    assert!((f64::from(cast.hit.as_ref().unwrap().t) - value("t₁")).abs() < 1e-6);
}

#[test]
fn invalid_requests_are_refused() {
    let mut page = Page::new(None);
    for request in [
        "{}",
        r#"{"kind":"nonsense"}"#,
        r#"{"kind":"explain","x":0,"y":0,"sample":null}"#,
        r#"{"kind":"open","name":"","text":null}"#,
        r#"{"kind":"give","name":"a","base64":"%%%","opens":true}"#,
        r#"{"kind":"save","force":true}"#,
        r#"{"kind":"cast","origin":[0,0,0],"direction":[0,0,0],"t_max":null}"#,
        r#"{"kind":"show","picture":"nothing","stops":0,"tone":"none"}"#,
        r#"{"kind":"field","name":"angle","values":[1],"moving":false}"#,
    ] {
        let answers = page.ask(request);
        assert!(matches!(&answers[..], [(Event::Refused { .. }, _)]), "{request}: {answers:?}");
    }
}
