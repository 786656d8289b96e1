//! Arbitrary bytes as a picture named `x.pfm`.
#![no_main]

libfuzzer_sys::fuzz_target!(|data: &[u8]| durer::fuzz::picture(data, "x.pfm"));
