//! The side of the protocol that a web page implements, for tests.

#![allow(dead_code, reason = "each test uses a part")]

use durer_session::protocol::{Event, EventMessage, PictureInfo};
use durer_session::{Host, SessionFiles};
use std::path::PathBuf;
use std::sync::Arc;
use std::sync::atomic::{AtomicU64, Ordering::Relaxed};

/// A simulated page with its own [`Host`]. The clock of the host advances by one millisecond each
/// time it is read.
pub struct Page(Host);

impl Page {
    pub fn new(file: Option<PathBuf>) -> Page {
        Page::begin(SessionFiles { file, lesson: None })
    }

    pub fn begin(start: SessionFiles) -> Page {
        let now = Arc::new(AtomicU64::new(0));
        Page(Host::new(start, Arc::new(move || now.fetch_add(1, Relaxed) as f64)))
    }

    pub fn ask(&mut self, request: &str) -> Vec<(Event, Vec<u8>)> {
        let mut all = Vec::new();
        let ask = format!(r#"{{"session":1,"id":1,"request":{request}}}"#);
        self.0.receive(&ask, &mut |bytes| all.push(read(&bytes)));
        all
    }

    /// Returns the pictures that the session sends until it becomes idle.
    pub fn pictures(&mut self) -> Vec<(PictureInfo, Vec<u8>)> {
        let mut all = Vec::new();
        while self.0.is_busy() {
            self.0.step(&mut |bytes| {
                if let (Event::Picture { head }, bytes) = read(&bytes) {
                    all.push((head, bytes));
                }
            });
        }
        all
    }
}

fn read(bytes: &[u8]) -> (Event, Vec<u8>) {
    let length = u32::from_le_bytes(bytes[..4].try_into().unwrap()) as usize;
    let answer: EventMessage = serde_json::from_slice(&bytes[4..4 + length]).unwrap();
    (answer.event, bytes[4 + length..].to_vec())
}

pub fn scene(name: &str) -> PathBuf {
    PathBuf::from(env!("CARGO_MANIFEST_DIR")).join("../../scenes").join(name)
}
