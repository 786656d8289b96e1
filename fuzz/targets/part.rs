//! Any bytes before a right checksum as saved work.
#![no_main]

libfuzzer_sys::fuzz_target!(|data: &[u8]| durer::fuzz::part(data));
