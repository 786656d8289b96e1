//! Any bytes as a scene of Mitsuba's.
#![no_main]

libfuzzer_sys::fuzz_target!(|data: &[u8]| durer::fuzz::model(data, "x.xml"));
