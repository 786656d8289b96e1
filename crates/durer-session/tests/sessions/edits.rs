//! Tests that a session survives thousands of random edits.

use durer_session::{Host, SessionFiles};
use std::path::Path;
use std::sync::Arc;

/// A linear congruential random number generator that makes the edits reproducible.
struct Random(u64);

impl Random {
    fn below(&mut self, end: usize) -> usize {
        self.0 = self.0.wrapping_mul(6_364_136_223_846_793_005).wrapping_add(1_442_695_040_888_963_407);
        ((self.0 >> 33) as usize) % end
    }
}

const WORDS: [&str; 16] = [
    "{",
    "}",
    "Sphere",
    "Transform { Scale 0 0 0",
    "1e39",
    "-0",
    "nan",
    "MaterialIndex 7",
    "#",
    "Group {",
    "radius -1",
    "\u{fc}",
    "Difference {",
    "angle 180",
    "Plane { normal 0 0 0 offset 1 }",
    "Noise {",
];

/// Returns the text after a random part has been removed, inserted or repeated, at character
/// boundaries.
fn changed(text: &str, random: &mut Random) -> String {
    let mut place = || {
        let at = random.below(text.len() + 1);
        (at..=text.len()).find(|&at| text.is_char_boundary(at)).unwrap_or(0)
    };
    let (a, b) = (place(), place());
    let (start, end) = (a.min(b), a.max(b).min(a.min(b) + 40));
    let end = (end..=text.len()).find(|&at| text.is_char_boundary(at)).unwrap_or(text.len());
    match random.below(3) {
        0 => format!("{}{}", &text[..start], &text[end..]),
        1 => format!("{} {} {}", &text[..start], WORDS[random.below(WORDS.len())], &text[start..]),
        _ => format!("{}{}{}", &text[..end], &text[start..end], &text[end..]),
    }
}

#[test]
fn edits_never_end_a_session() {
    let scenes = Path::new(env!("CARGO_MANIFEST_DIR")).join("../../scenes");
    let mut host = Host::new(SessionFiles::default(), Arc::new(|| 0.0));
    let mut random = Random(1);
    let mut counts = [0_usize; 2];
    // `cargo xtask page --measure` makes 10,000 edits.
    let edits = std::env::var("DURER_EDITS").map_or(1000, |count| count.parse().unwrap());
    for name in ["whitted.txt", "marble.txt", "gear.txt"] {
        let text = std::fs::read_to_string(scenes.join(name)).unwrap();
        let mut ask = |request: serde_json::Value| {
            let (mut answers, mut valid) = (0, false);
            let ask = serde_json::json!({ "session": 1, "id": 1, "request": request });
            host.receive(&ask.to_string(), &mut |bytes| {
                answers += 1;
                valid |= String::from_utf8_lossy(&bytes).contains(r#""contents":{"#);
            });
            assert!(answers > 0 || !matches!(request["kind"].as_str(), Some("open" | "edit")));
            counts[usize::from(valid)] += 1;
            valid
        };
        assert!(ask(serde_json::json!({ "kind": "open", "name": name, "text": text })));
        ask(serde_json::json!({ "kind": "size", "width": 8, "height": 8 }));
        for _ in 0..edits {
            let mut edited = text.clone();
            for _ in 0..=random.below(3) {
                edited = changed(&edited, &mut random);
            }
            ask(serde_json::json!({ "kind": "edit", "text": edited }));
        }
        assert!(ask(serde_json::json!({ "kind": "edit", "text": text })));
    }
    // About one in twenty edits gives a valid scene.
    assert!(counts.iter().all(|&count| count > 100), "{counts:?}");
}
