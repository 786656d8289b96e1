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
        self.0.receive(&message(request), &mut |bytes| all.push(read(&bytes)));
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
    let (answer, payload) = EventMessage::decode(bytes).unwrap();
    (answer.event, payload.to_vec())
}

/// A page whose pictures several hosts render together, as Web Workers do.
pub struct SharedPage {
    hosts: Vec<Host>,
    /// Messages of the helpers that have not reached the first host yet.
    parts: Vec<Vec<u8>>,
}

impl SharedPage {
    pub fn new(count: u32) -> SharedPage {
        let host = |index: u32| {
            let now = Arc::new(AtomicU64::new(0));
            let clock = Arc::new(move || now.fetch_add(3, Relaxed) as f64);
            let mut host = Host::new(SessionFiles::default(), clock);
            let share = format!(r#"{{"kind":"share","index":{index},"count":{count}}}"#);
            host.receive(&message(&share), &mut |bytes| panic!("{:?}", read(&bytes)));
            host
        };
        SharedPage { hosts: (1..=count).map(host).collect(), parts: Vec::new() }
    }

    /// Sends a request to all hosts, and returns the answers of the first one.
    pub fn ask(&mut self, request: &str) -> Vec<Event> {
        let mut all = Vec::new();
        self.hosts[0].receive(&message(request), &mut |bytes| all.push(read(&bytes).0));
        for host in &mut self.hosts[1..] {
            host.receive(&message(request), &mut |bytes| panic!("a helper answered {:?}", read(&bytes)));
        }
        all
    }

    /// Lets each host take some steps, and delivers the parts that are in flight if `delivers`.
    pub fn step(&mut self, delivers: bool) -> Vec<(PictureInfo, Vec<u8>)> {
        let mut pictures = Vec::new();
        for host in &mut self.hosts[1..] {
            host.step(&mut |bytes| self.parts.push(bytes));
        }
        for part in self.parts.drain(..).filter(|_| delivers) {
            self.hosts[0].receive_part(&part);
        }
        self.hosts[0].step(&mut |bytes| {
            if let (Event::Picture { head }, bytes) = read(&bytes) {
                pictures.push((head, bytes));
            }
        });
        pictures
    }

    /// Returns the pictures until all hosts are idle.
    pub fn pictures(&mut self) -> Vec<(PictureInfo, Vec<u8>)> {
        let mut all = Vec::new();
        while self.hosts.iter().any(Host::is_busy) || !self.parts.is_empty() {
            all.extend(self.step(true));
        }
        all
    }
}

fn message(request: &str) -> String {
    format!(r#"{{"session":1,"id":1,"request":{request}}}"#)
}

pub fn scene(name: &str) -> PathBuf {
    PathBuf::from(env!("CARGO_MANIFEST_DIR")).join("../../scenes").join(name)
}
