//! Large pages of memory.

/// Asks the system to put room for so many things, in which nothing has been written yet, on large pages where it is large enough: a
/// processor knows the places of only so many pages by heart.
pub fn large_pages<T>(room: *const T, count: usize) {
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
