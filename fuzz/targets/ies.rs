//! Arbitrary bytes as a photometric file.
#![no_main]

libfuzzer_sys::fuzz_target!(|data: &[u8]| durer::fuzz::profile(data));
