//! Tests of sessions.
//! They are one program, so that they are linked once.

#[path = "../page/mod.rs"]
mod page;

mod edits;
mod pictures;
mod requests;
mod shares;
