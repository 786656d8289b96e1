//! Interactive sessions for editing the text of a scene, moving its camera, rendering progressively
//! from coarse to fine, and explaining pixels.
//!
//! [`Session`] does the work, and [`Host`] contains several sessions. Both exchange the messages of
//! [`protocol`] and are independent of sockets and browsers. `durer-live` and `durer-wasm`
//! transport the messages. [`explained_samples`] explains a pixel for a page without a session.

mod display;
mod document;
mod explained;
mod export;
mod fields;
mod host;
mod intersection_tests;
mod language;
mod mistakes;
mod model;
mod motion;
mod outlines;
pub mod protocol;
mod rows;
mod session;
mod share;
mod terms;
mod traversal;
mod viewer;

pub use explained::{DrawnScene, ExplainedSample, TermCast, drawn_scene, explained_samples};
pub use host::Host;
pub use session::{Clock, Session, SessionFiles};
