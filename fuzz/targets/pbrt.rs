//! Arbitrary bytes as a pbrt scene.
#![no_main]

libfuzzer_sys::fuzz_target!(|data: &[u8]| durer::fuzz::model(data, "x.pbrt"));
