//! Interactive sessions: edit a scene's text, move its camera, render progressively from coarse to
//! fine, and explain pixels.
//!
//! [`Session`] does the work and [`Host`] holds several sessions. They exchange the messages of
//! [`protocol`] and are independent of sockets and browsers: `durer-live` and `durer-wasm`
//! transport the messages.

mod display;
mod document;
mod export;
mod fields;
mod host;
mod intersection_tests;
mod language;
mod model;
mod motion;
mod outlines;
pub mod protocol;
mod rows;
mod session;
mod terms;
mod traversal;
mod viewer;

pub use host::Host;
pub use session::{Clock, Session, SessionFiles};
