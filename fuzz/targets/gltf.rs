//! Arbitrary bytes as a glTF model.
#![no_main]

libfuzzer_sys::fuzz_target!(|data: &[u8]| durer::fuzz::model(data, "x.gltf"));
