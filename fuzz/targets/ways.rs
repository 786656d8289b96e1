//! Scenes that can be rendered, by tree, grid and brute force: one picture.
#![no_main]

libfuzzer_sys::fuzz_target!(|data: &[u8]| durer::fuzz::ways(data));
