//! Memory: large pages, and what is brought near.

use crate::parallel;

/// An empty list with room for so many things, on large pages.
pub fn room<T>(count: usize) -> Vec<T> {
    let room = Vec::with_capacity(count);
    large_pages(room.as_ptr(), count);
    room
}

/// A list of what belongs to 0, 1, 2, ..., on large pages, with room for so many more. All threads
/// write it: to touch memory for the first time takes longer than to write to it.
pub fn listed<T: Send>(count: usize, more: usize, of: impl Fn(usize) -> T + Sync + Send) -> Vec<T> {
    const AT_ONCE: usize = 4096;
    let mut all = room(count + more);
    parallel::extend(&mut all, count, AT_ONCE, of);
    all
}

/// Has something that lies far away in memory brought near, where the processor can do that while
/// it goes on.
#[inline]
pub fn bring_near<T>(thing: &T) {
    #[cfg(target_arch = "x86_64")]
    {
        use std::arch::x86_64::{_MM_HINT_T0, _mm_prefetch};
        // It may begin in the middle of a line.
        for byte in (0..size_of::<T>()).step_by(64).chain([size_of::<T>().saturating_sub(1)]) {
            // SAFETY: the instruction takes any address, and every processor has it.
            unsafe { _mm_prefetch::<_MM_HINT_T0>(std::ptr::from_ref(thing).cast::<i8>().wrapping_add(byte)) };
        }
    }
    #[cfg(not(target_arch = "x86_64"))]
    let _ = thing;
}

/// Asks the system to put room for so many things, in which nothing has been written yet, on large
/// pages where it is large enough: a processor knows the places of only so many pages by heart.
fn large_pages<T>(room: *const T, count: usize) {
    #[cfg(target_os = "linux")]
    {
        use std::ffi::{c_int, c_void};
        unsafe extern "C" {
            /// Of the C library that `std` is linked with.
            fn madvise(from: *mut c_void, bytes: usize, advice: c_int) -> c_int;
        }
        /// `MADV_HUGEPAGE` of Linux.
        const USE_LARGE_PAGES: c_int = 14;
        const LARGE: usize = 2 << 20;
        let start = room.addr().next_multiple_of(LARGE);
        let end = (room.addr() + count * size_of::<T>()) / LARGE * LARGE;
        if start < end {
            // It is no loss if there are none to be had.
            // SAFETY: this advice changes nothing in what memory holds, whoever's it is.
            let _ = unsafe { madvise(room.with_addr(start).cast_mut().cast(), end - start, USE_LARGE_PAGES) };
        }
    }
    #[cfg(not(target_os = "linux"))]
    let _ = (room, count);
}
