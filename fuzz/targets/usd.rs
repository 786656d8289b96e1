//! Arbitrary bytes as a USD layer or package.
#![no_main]

libfuzzer_sys::fuzz_target!(|data: &[u8]| durer::fuzz::model(data, durer::fuzz::usd_name(data)));
