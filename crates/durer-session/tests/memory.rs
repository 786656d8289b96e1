//! Tests that the memory of a session does not grow over many edits. The test has its own process,
//! because the allocations of other tests would also be counted.

mod page;

use page::Page;
use serde_json::json;

/// Returns the resident memory in bytes, if the system reports it.
fn resident() -> Option<u64> {
    let pages = std::fs::read_to_string("/proc/self/statm").ok()?;
    Some(4096 * pages.split(' ').nth(1)?.parse::<u64>().ok()?)
}

#[test]
fn memory_stays_flat_over_a_thousand_edits() {
    let mut page = Page::new(None);
    let text = std::fs::read_to_string(page::scene("whitted.txt")).unwrap();
    page.ask(&json!({ "kind": "open", "name": "scene.txt", "text": text }).to_string());
    page.ask(r#"{"kind":"size","width":48,"height":32}"#);
    let mut edit = |i: u32| {
        let moved = format!("{text}\n# {i}\nGroup {{ Sphere {{ center {} 0 0 radius 0.2 }} }}\n", i % 7);
        let read = page.ask(&json!({ "kind": "edit", "text": moved }).to_string());
        assert!(!read.is_empty());
        if i.is_multiple_of(10) {
            page.pictures();
        }
    };
    (0..200).for_each(&mut edit);
    let Some(before) = resident() else {
        return eprintln!("skipped: the system does not report how much memory is used");
    };
    (200..1200).for_each(&mut edit);
    let after = resident().unwrap();
    println!("resident memory: {} KiB after 200 edits, {} KiB after 1,200 edits", before >> 10, after >> 10);
    assert!(after < before + (8 << 20), "{} KiB became {} KiB", before >> 10, after >> 10);
}
