//! A scene that somebody looks at: its text is edited, the camera is moved, pictures come from
//! coarse to
//! fine, and pixels are explained.
//!
//! [`Session`] does the work and [`Host`] keeps several. They speak the messages of [`protocol`],
//! and know
//! neither sockets nor browsers: `durer-live` and `durer-wasm` carry the messages.

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
