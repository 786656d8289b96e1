//! Tests that several workers that share a picture render the same bits as one worker, whatever
//! happens in between.

use crate::page::{Page, SharedPage, scene};
use durer_session::protocol::Event;
use serde_json::json;

const SIZE: &str = r#"{"kind":"size","width":83,"height":61}"#;
const ORBIT: &str = r#"{"kind":"move","motion":{"kind":"orbit","right":0.3,"up":0.1},"moving":MOVING}"#;

fn open(name: &str) -> String {
    let text = std::fs::read_to_string(scene(name)).unwrap();
    json!({ "kind": "open", "name": name, "text": text }).to_string()
}

fn samples(count: u32) -> String {
    json!({ "kind": "options", "options": [{ "name": "samples", "value": count.to_string() }] }).to_string()
}

/// Returns the finished picture of a single worker after some requests.
fn alone(requests: &[&str]) -> (Option<String>, Vec<u8>) {
    let mut page = Page::new(None);
    for request in requests {
        page.ask(request);
    }
    let (head, bytes) = page.pictures().pop().unwrap();
    (head.hash, bytes)
}

#[test]
fn workers_render_the_picture_of_one() {
    for (name, count) in [("whitted.txt", 2), ("cornell-box.txt", 3), ("caustic.txt", 4)] {
        let (open, samples) = (open(name), samples(9));
        let requests = [open.as_str(), SIZE, &samples];
        let mut page = SharedPage::new(count);
        for request in requests {
            page.ask(request);
        }
        let mut pictures = page.pictures();
        let (head, bytes) = pictures.pop().unwrap();
        assert_eq!((head.hash, bytes), alone(&requests), "{name}");
        assert!(head.rays > 0.0 && head.noise.is_some());
        // No picture with missing blocks is shown.
        assert!(pictures.iter().all(|(head, bytes)| bytes.len() == 4 * (head.width * head.height) as usize));
        assert!(pictures.iter().all(|(_, bytes)| bytes.chunks(4).all(|pixel| pixel[3] == 255)));
    }
}

#[test]
fn changes_in_the_middle_of_a_picture_lead_to_the_same_picture() {
    let (open, few, many) = (open("whitted.txt"), samples(4), samples(16));
    let (moving, rested) = (ORBIT.replace("MOVING", "true"), ORBIT.replace("MOVING", "false"));
    let depth = r#"{"kind":"show","picture":"depth","stops":0.0,"tone":"none"}"#;
    let color = r#"{"kind":"show","picture":"color","stops":0.0,"tone":"none"}"#;
    let crop = r#"{"kind":"crop","crop":[9,7,40,30]}"#;
    let broken = r#"{"kind":"edit","text":"PerspectiveCamera {"}"#;
    let all = [&open, SIZE, &few, &many, &moving, &rested, depth, color, crop, &few];
    let wanted = alone(&all);
    for pause in [0, 1, 2, 5, 13] {
        for delivers in [true, false] {
            let mut page = SharedPage::new(3);
            for request in all {
                page.ask(request);
                (0..pause).for_each(|_| drop(page.step(delivers)));
            }
            // Parts that arrive after an edit with errors are outdated, even if nothing changes.
            page.ask(broken);
            page.ask(r#"{"kind":"denoise","on":false}"#);
            page.ask(color);
            page.pictures();
            let exported = page.ask(r#"{"kind":"export","name":"a.png"}"#);
            assert!(matches!(exported[0], Event::Exported { .. }), "{exported:?}");
            let shown = page.ask(r#"{"kind":"values","left":20,"top":20,"width":1,"height":1}"#);
            assert!(matches!(shown[0], Event::Values { .. }), "{shown:?}");
            page.ask(&few);
            let (head, bytes) = page.pictures().pop().unwrap();
            assert!((head.hash, bytes) == wanted, "{pause} {delivers}");
        }
    }
}

#[test]
fn pictures_that_cannot_be_divided_are_rendered_by_one_worker() {
    let open = open("sphere.txt");
    let tiny = r#"{"kind":"size","width":8,"height":8}"#;
    let mut page = SharedPage::new(4);
    page.ask(&open);
    page.ask(tiny);
    let (head, bytes) = page.pictures().pop().unwrap();
    assert_eq!((head.hash, bytes), alone(&[&open, tiny]));
}

#[test]
fn a_lost_worker_is_replaced_by_the_first() {
    let open = open("sphere.txt");
    let mut page = SharedPage::new(2);
    page.ask(&open);
    page.ask(SIZE);
    (0..20).for_each(|_| drop(page.step(false)));
    page.ask(r#"{"kind":"share","index":1,"count":1}"#);
    let (head, bytes) = page.pictures().pop().unwrap();
    assert_eq!((head.hash, bytes), alone(&[&open, SIZE]));
}

#[test]
fn impossible_shares_and_foreign_parts_are_ignored() {
    let mut page = Page::new(None);
    for (index, count) in [(0, 1), (2, 1), (1, 0), (1, 65)] {
        let ask = json!({ "kind": "share", "index": index, "count": count }).to_string();
        assert!(matches!(page.ask(&ask)[0].0, Event::Refused { .. }));
    }
    let mut host = durer_session::Host::new(Default::default(), std::sync::Arc::new(|| 0.0));
    host.receive_part(b"");
    host.receive_part(&[255; 40]);
    host.receive_part(b"\x02\0\0\0{}");
}
