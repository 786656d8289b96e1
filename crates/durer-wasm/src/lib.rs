//! Sessions of `durer-session` in a Web Worker. Requests arrive as JSON text, and answers leave as
//! bytes.

use durer_session::{Clock, Host, Start};
use js_sys::{Function, Uint8Array};
use std::sync::Arc;
use wasm_bindgen::prelude::*;

#[wasm_bindgen]
extern "C" {
    #[wasm_bindgen(js_namespace = performance)]
    fn now() -> f64;
}

/// The sessions of a page.
#[wasm_bindgen]
pub struct Engine(Host);

#[wasm_bindgen]
impl Engine {
    /// Creates an engine without sessions.
    #[wasm_bindgen(constructor)]
    #[expect(clippy::new_without_default)]
    pub fn new() -> Engine {
        let clock: Clock = Arc::new(now);
        Engine(Host::new(Start::default(), clock))
    }

    /// Handles a message and calls `send` with each answer.
    pub fn receive(&mut self, message: &str, send: &Function) {
        self.0.receive(message, &mut |bytes| call(send, &bytes));
    }

    /// Works for a few milliseconds. Returns true if work is left.
    pub fn step(&mut self, send: &Function) -> bool {
        self.0.step(&mut |bytes| call(send, &bytes));
        self.0.is_busy()
    }
}

fn call(send: &Function, bytes: &[u8]) {
    // Ignore exceptions of the callback.
    let _ = send.call1(&JsValue::NULL, &Uint8Array::from(bytes));
}
