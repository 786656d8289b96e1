//! Lists stored on large pages, and prefetching.

use crate::parallel;

/// Creates an empty list with capacity for `count` items, on large pages.
pub fn vec_on_large_pages<T>(count: usize) -> Vec<T> {
    let list = Vec::with_capacity(count);
    large_pages(list.as_ptr(), count);
    list
}

/// Creates a list of `of(0)`, ..., `of(count - 1)` on large pages, with capacity for `more`
/// additional items. All threads fill the list because the first access to each page is slow.
pub fn parallel_vec<T: Send>(count: usize, more: usize, of: impl Fn(usize) -> T + Sync + Send) -> Vec<T> {
    const AT_ONCE: usize = 4096;
    let mut all = vec_on_large_pages(count + more);
    parallel::extend(&mut all, count, AT_ONCE, of);
    all
}

/// Prefetches a value into the cache on x86-64, and does nothing on other processors.
#[inline]
pub fn prefetch<T>(value: &T) {
    #[cfg(target_arch = "x86_64")]
    {
        use std::arch::x86_64::{_MM_HINT_T0, _mm_prefetch};
        // The value may begin in the middle of a cache line.
        for byte in (0..size_of::<T>()).step_by(64).chain([size_of::<T>().saturating_sub(1)]) {
            // SAFETY: the instruction accepts any address, and every x86-64 processor has it.
            unsafe { _mm_prefetch::<_MM_HINT_T0>(std::ptr::from_ref(value).cast::<i8>().wrapping_add(byte)) };
        }
    }
    #[cfg(not(target_arch = "x86_64"))]
    let _ = value;
}

/// Asks the operating system for large pages for the uninitialised memory of `count` items if that
/// memory is large enough. This avoids TLB misses because the processor caches the addresses of
/// only a limited number of pages.
fn large_pages<T>(list: *const T, count: usize) {
    #[cfg(target_os = "linux")]
    {
        use std::ffi::{c_int, c_void};
        unsafe extern "C" {
            /// The function comes from the C library that `std` is linked with.
            fn madvise(from: *mut c_void, bytes: usize, advice: c_int) -> c_int;
        }
        /// Linux's `MADV_HUGEPAGE`.
        const USE_LARGE_PAGES: c_int = 14;
        const LARGE: usize = 2 << 20;
        let start = list.addr().next_multiple_of(LARGE);
        let end = (list.addr() + count * size_of::<T>()) / LARGE * LARGE;
        if start < end {
            // A failure is harmless: the memory then stays on small pages. SAFETY: this advice does
            // not change the contents of memory.
            let _ = unsafe { madvise(list.with_addr(start).cast_mut().cast(), end - start, USE_LARGE_PAGES) };
        }
    }
    #[cfg(not(target_os = "linux"))]
    let _ = (list, count);
}
