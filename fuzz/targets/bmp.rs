//! Arbitrary bytes as a picture named `x.bmp`.
#![no_main]

libfuzzer_sys::fuzz_target!(|data: &[u8]| durer::fuzz::picture(data, "x.bmp"));
