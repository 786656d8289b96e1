//! Arbitrary bytes as a picture named `x.ktx2`.
#![no_main]

libfuzzer_sys::fuzz_target!(|data: &[u8]| durer::fuzz::picture(data, "x.ktx2"));
