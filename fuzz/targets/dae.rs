//! Arbitrary bytes as a COLLADA scene.
#![no_main]

libfuzzer_sys::fuzz_target!(|data: &[u8]| durer::fuzz::model(data, "x.dae"));
