//! Arbitrary bytes with a valid checksum as a partial render.
#![no_main]

libfuzzer_sys::fuzz_target!(|data: &[u8]| durer::fuzz::part(data));
