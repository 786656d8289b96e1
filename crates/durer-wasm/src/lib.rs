//! The sessions of `durer-session` in a Web Worker: messages come as texts, answers go as bytes.

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
    /// An engine without sessions.
    #[wasm_bindgen(constructor)]
    #[expect(clippy::new_without_default)]
    pub fn new() -> Engine {
        let clock: Clock = Arc::new(now);
        Engine(Host::new(Start::default(), clock))
    }

    /// Answers a message; `send` is called with each answer.
    pub fn receive(&mut self, message: &str, send: &Function) {
        self.0.receive(message, &mut |bytes| call(send, &bytes));
    }

    /// Does some milliseconds of work. Tells whether there is more.
    pub fn step(&mut self, send: &Function) -> bool {
        self.0.step(&mut |bytes| call(send, &bytes));
        self.0.is_busy()
    }
}

fn call(send: &Function, bytes: &[u8]) {
    // An error of the page's own code stays there.
    let _ = send.call1(&JsValue::NULL, &Uint8Array::from(bytes));
}
