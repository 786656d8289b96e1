//! Division of a session's pictures among several workers, each of which has its own memory.
//!
//! All workers receive the requests that change the picture, so they agree on the scene, the
//! camera and the options. Each one renders its shard of the blocks. The first worker collects the
//! blocks of the others and shows the pictures.

use crate::protocol::{Event, Request};
use durer::render::{PartialRender, ProgressiveRender, Shard, ShardBy};
use std::collections::{BTreeMap, BTreeSet};

/// Maximum number of workers.
const MAX_WORKERS: u32 = 64;

/// Part of a picture that another worker has rendered.
#[derive(Debug)]
pub(crate) struct ReceivedPart {
    /// Number of changes before the picture.
    pub revision: u32,
    /// Number of the worker.
    pub index: u32,
    /// True if the worker's share is finished.
    pub finished: bool,
    pub part: PartialRender,
}

/// Share of a session in the pictures that several workers render.
#[derive(Debug)]
pub(crate) struct Share {
    pub shard: Shard,
    /// Number of changes to the picture so far.
    revision: u32,
    /// Latest part of each of the other workers that is not in the picture yet.
    waiting: BTreeMap<u32, ReceivedPart>,
    /// Workers whose shares are completely in the picture.
    finished: BTreeSet<u32>,
}

impl Default for Share {
    fn default() -> Self {
        Share { shard: Shard::WHOLE, revision: 0, waiting: BTreeMap::new(), finished: BTreeSet::new() }
    }
}

impl Share {
    /// Returns the share of one of `count` workers.
    pub fn new(index: u32, count: u32) -> Result<Self, String> {
        if !(1..=MAX_WORKERS).contains(&count) || !(1..=count).contains(&index) {
            return Err(format!("a picture can be shared by 1 to {MAX_WORKERS} workers"));
        }
        Ok(Share { shard: Shard { index, count, by: ShardBy::Tiles }, ..Share::default() })
    }

    /// True for a worker that renders for the first worker and shows nothing.
    pub fn is_helper(&self) -> bool {
        self.shard.index > 1
    }

    /// Marks all parts of the previous picture as outdated.
    pub fn change(&mut self) {
        self.revision = self.revision.wrapping_add(1);
        self.waiting.clear();
        self.finished.clear();
    }

    /// Receives a part of another worker. Returns false if it is outdated.
    pub fn receive(&mut self, part: ReceivedPart) -> bool {
        let is_current = part.revision == self.revision && !self.is_helper();
        if is_current {
            self.waiting.insert(part.index, part);
        }
        is_current
    }

    /// Copies the received parts into the picture. Returns false if one of them belongs to another
    /// picture.
    pub fn absorb(&mut self, render: &mut ProgressiveRender) -> bool {
        for (index, received) in std::mem::take(&mut self.waiting) {
            if render.absorb(&received.part).is_err() {
                return false;
            }
            if received.finished {
                self.finished.insert(index);
            }
        }
        true
    }

    /// True if the other workers have finished their shares of this picture.
    pub fn is_complete(&self, render: &ProgressiveRender) -> bool {
        self.finished.len() as u32 + 1 >= render.part().shard().count
    }

    /// Returns the message with a helper's part.
    pub fn message(&self, finished: bool) -> Event {
        Event::Part { revision: self.revision, index: self.shard.index, finished }
    }
}

/// Returns true for requests that can change the rendered picture. All workers handle these.
/// `shown` is the name of the picture that is shown now.
pub(crate) fn changes_picture(request: &Request, shown: &str) -> bool {
    match request {
        Request::Show { picture, .. } => picture != shown,
        Request::Open { .. }
        | Request::Give { .. }
        | Request::Edit { .. }
        | Request::Size { .. }
        | Request::Options { .. }
        | Request::Move { .. }
        | Request::Field { .. }
        | Request::Look { .. }
        | Request::Camera { .. }
        | Request::WriteCamera
        | Request::Crop { .. }
        | Request::Epsilon { .. }
        | Request::Material { .. }
        | Request::AsText => true,
        Request::Explain { .. }
        | Request::Cast { .. }
        | Request::Rays { .. }
        | Request::Walk { .. }
        | Request::Boxes
        | Request::Values { .. }
        | Request::Denoise { .. }
        | Request::Tree
        | Request::Pack
        | Request::Lesson
        | Request::Mistakes
        | Request::Mistake { .. }
        | Request::Outlines
        | Request::Language
        | Request::Export { .. }
        | Request::Save { .. }
        | Request::Share { .. }
        | Request::Pause { .. }
        | Request::Close => false,
    }
}
