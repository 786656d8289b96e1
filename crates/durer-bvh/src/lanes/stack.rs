//! Nodes that are still to be visited, each with the distance at which the ray enters it.

use crate::node::{MAX_DEPTH, WIDTH};
use std::mem::MaybeUninit;

/// As high as the stack of a tree of [`MAX_DEPTH`](crate::node::MAX_DEPTH) levels can get, and a
/// vector's width more.
const ROOM: usize = (WIDTH - 1) * MAX_DEPTH + 2 * WIDTH;

/// Where a stack lies. It costs nothing to make: what lies above the stack's height is never
/// initialised.
pub struct StackStorage {
    children: MaybeUninit<[u32; ROOM]>,
    near: MaybeUninit<[f32; ROOM]>,
}

impl StackStorage {
    #[inline(always)]
    pub fn new() -> Self {
        StackStorage { children: MaybeUninit::uninit(), near: MaybeUninit::uninit() }
    }
}

/// A stack of nodes.
pub struct Stack<'a> {
    // Apart from the height: a constant of both would be written out in full for every ray.
    room: &'a mut StackStorage,
    height: usize,
}

impl<'a> Stack<'a> {
    #[inline(always)]
    pub fn new(room: &'a mut StackStorage) -> Self {
        Stack { room, height: 0 }
    }

    #[inline(always)]
    pub fn push(&mut self, child: u32, near: f32) {
        let (to, to_near) = self.top();
        // SAFETY: `top` checks that there is room.
        unsafe {
            to.write(child);
            to_near.write(near);
        }
        self.height += 1;
    }

    /// The topmost child and where the ray enters it.
    #[inline(always)]
    pub fn pop_near(&mut self) -> Option<(u32, f32)> {
        self.height = self.height.checked_sub(1)?;
        let (children, near, height) = self.all();
        // SAFETY: everything below what was the height was written.
        Some(unsafe { (*children.add(height), *near.add(height)) })
    }

    /// The topmost child that is entered at `far` or before; it and those above are removed. There
    /// must be one.
    #[inline(always)]
    pub fn pop_until(&mut self, far: f32) -> u32 {
        loop {
            match self.pop_near() {
                Some((_, near)) if near > far => {}
                Some((child, _)) => return child,
                None => unreachable!("the lowest is entered in time"),
            }
        }
    }

    pub fn clear(&mut self) {
        self.height = 0;
    }

    /// The topmost child, which is removed if wanted; there must be one.
    #[inline(always)]
    pub fn pop_if(&mut self, wanted: bool) -> u32 {
        assert!(self.height > 0);
        self.height -= usize::from(wanted);
        // SAFETY: everything below what was the height was written.
        unsafe { *self.room.children.as_ptr().cast::<u32>().add(self.height - usize::from(!wanted)) }
    }

    /// Room for a whole vector on top, to be followed by [`Stack::grow`].
    #[inline(always)]
    pub(super) fn top(&mut self) -> (*mut u32, *mut f32) {
        assert!(self.height <= ROOM - WIDTH);
        let (children, near, height) = self.all();
        // SAFETY: there is room for a vector above the height.
        unsafe { (children.add(height), near.add(height)) }
    }

    /// # Safety
    ///
    /// So many entries must have been written to [`Stack::top`], eight at most.
    #[cfg(any(target_arch = "x86_64", all(target_arch = "wasm32", target_feature = "simd128")))]
    #[inline(always)]
    pub(super) unsafe fn grow(&mut self, count: u32) {
        self.height += count as usize;
    }

    /// The lowest child and distance, and the height.
    #[inline(always)]
    pub(super) fn all(&mut self) -> (*mut u32, *mut f32, usize) {
        (self.room.children.as_mut_ptr().cast::<u32>(), self.room.near.as_mut_ptr().cast::<f32>(), self.height)
    }
}
