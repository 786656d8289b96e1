//! Any bytes as a file of measured light.
#![no_main]

libfuzzer_sys::fuzz_target!(|data: &[u8]| durer::fuzz::profile(data));
