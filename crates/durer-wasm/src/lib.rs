//! Runs `durer-session` in a Web Worker. Requests arrive as JSON text, and answers are sent as
//! bytes.

use durer_session::{Clock, Host, SessionFiles};
use js_sys::{Function, Uint8Array};
use std::sync::Arc;
use wasm_bindgen::prelude::*;

#[wasm_bindgen]
extern "C" {
    #[wasm_bindgen(js_namespace = performance)]
    fn now() -> f64;
}

/// Host of all sessions of a web page; JavaScript creates one in its Web Worker and passes messages
/// to it.
#[wasm_bindgen]
pub struct Engine(Host);

#[wasm_bindgen]
impl Engine {
    /// Creates an engine without sessions.
    #[wasm_bindgen(constructor)]
    #[expect(clippy::new_without_default)]
    pub fn new() -> Engine {
        let clock: Clock = Arc::new(now);
        Engine(Host::new(SessionFiles::default(), clock))
    }

    /// Handles a message, and calls `send` with each answer.
    pub fn receive(&mut self, message: &str, send: &Function) {
        self.0.receive(message, &mut |bytes| call(send, &bytes));
    }

    /// Receives a part of a picture that the engine of another worker has sent.
    pub fn receive_part(&mut self, message: &[u8]) {
        self.0.receive_part(message);
    }

    /// Works for a few milliseconds. Returns true if work remains.
    pub fn step(&mut self, send: &Function) -> bool {
        self.0.step(&mut |bytes| call(send, &bytes));
        self.0.is_busy()
    }
}

fn call(send: &Function, bytes: &[u8]) {
    // Ignore exceptions thrown by the callback.
    let _ = send.call1(&JsValue::NULL, &Uint8Array::from(bytes));
}
