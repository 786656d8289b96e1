//! Interactive sessions: edit a scene's text, move its camera, render progressively from coarse to
//! fine, and explain pixels.
//!
//! [`Session`] does the work and [`Host`] holds several sessions. They exchange the messages of
//! [`protocol`] and are independent of sockets and browsers: `durer-live` and `durer-wasm`
//! transport the messages.

mod candidates;
mod display;
mod document;
mod export;
mod fields;
mod host;
mod language;
mod model;
mod motion;
mod outlines;
pub mod protocol;
mod rows;
mod session;
mod terms;
mod viewer;
mod walk;

pub use host::Host;
pub use session::{Clock, Session, Start};
