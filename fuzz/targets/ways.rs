//! Random valid scenes: BVH, grid and brute force give the same picture.
#![no_main]

libfuzzer_sys::fuzz_target!(|data: &[u8]| durer::fuzz::ways(data));
