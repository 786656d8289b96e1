//! Arbitrary bytes as a weather file.
#![no_main]

libfuzzer_sys::fuzz_target!(|data: &[u8]| durer::fuzz::weather(data));
