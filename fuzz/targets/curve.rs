//! Arbitrary bytes as a spectrum.
#![no_main]

libfuzzer_sys::fuzz_target!(|data: &[u8]| durer::fuzz::curve(data));
