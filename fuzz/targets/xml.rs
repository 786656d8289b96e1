//! Arbitrary bytes as a Mitsuba scene.
#![no_main]

libfuzzer_sys::fuzz_target!(|data: &[u8]| durer::fuzz::model(data, "x.xml"));
