//! Large pages of memory.

use rayon::prelude::*;

/// An empty list with room for so many things, on large pages.
pub fn room<T>(count: usize) -> Vec<T> {
    let room = Vec::with_capacity(count);
    large_pages(room.as_ptr(), count);
    room
}

/// A list of so many things that are all the same, on large pages. All threads write it: to touch memory for the first time takes longer
/// than to write to it.
pub fn repeated<T: Clone + Send + Sync>(thing: T, count: usize) -> Vec<T> {
    const AT_ONCE: usize = 1 << 14;
    let mut all = room(count);
    all.par_extend(rayon::iter::repeat_n(thing, count).with_min_len(AT_ONCE));
    all
}

/// Asks the system to put room for so many things, in which nothing has been written yet, on large pages where it is large enough: a
/// processor knows the places of only so many pages by heart.
fn large_pages<T>(room: *const T, count: usize) {
    #[cfg(target_os = "linux")]
    {
        use rustix::mm::{Advice, madvise};
        const LARGE: usize = 2 << 20;
        let start = room.addr().next_multiple_of(LARGE);
        let end = (room.addr() + count * size_of::<T>()) / LARGE * LARGE;
        if start < end {
            // It is no loss if there are none to be had.
            // SAFETY: this advice changes nothing in what memory holds, whoever's it is.
            let _ = unsafe { madvise(room.with_addr(start).cast_mut().cast(), end - start, Advice::LinuxHugepage) };
        }
    }
    #[cfg(not(target_os = "linux"))]
    let _ = (room, count);
}
