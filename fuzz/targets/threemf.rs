//! Arbitrary bytes as a 3MF model.
#![no_main]

libfuzzer_sys::fuzz_target!(|data: &[u8]| durer::fuzz::model(data, "x.3mf"));
