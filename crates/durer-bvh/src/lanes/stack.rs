//! Stack of nodes to visit, each with the distance at which the ray enters the node.

use crate::node::{MAX_DEPTH, WIDTH};
use std::mem::MaybeUninit;

/// Maximum height of the stack for a tree with [`MAX_DEPTH`](crate::node::MAX_DEPTH) levels, plus
/// space for storing a full vector.
const CAPACITY: usize = (WIDTH - 1) * MAX_DEPTH + 2 * WIDTH;

/// Uninitialised memory for the [`Stack`] of a traversal.
pub struct StackStorage {
    children: MaybeUninit<[u32; CAPACITY]>,
    near: MaybeUninit<[f32; CAPACITY]>,
}

impl StackStorage {
    #[inline(always)]
    pub fn new() -> Self {
        StackStorage { children: MaybeUninit::uninit(), near: MaybeUninit::uninit() }
    }
}

/// Traversal stack of the nodes and leaves that have not been visited yet, with their entry
/// distances.
pub struct Stack<'a> {
    // The memory is separate from the height because otherwise an empty stack would be copied from
    // a constant for every ray.
    storage: &'a mut StackStorage,
    height: usize,
}

impl<'a> Stack<'a> {
    #[inline(always)]
    pub fn new(storage: &'a mut StackStorage) -> Self {
        Stack { storage, height: 0 }
    }

    #[inline(always)]
    pub fn push(&mut self, child: u32, near: f32) {
        let (to, to_near) = self.top();
        // SAFETY: `top` checks the capacity.
        unsafe {
            to.write(child);
            to_near.write(near);
        }
        self.height += 1;
    }

    /// Removes the topmost child and returns it with its entry distance.
    #[inline(always)]
    pub fn pop_near(&mut self) -> Option<(u32, f32)> {
        self.height = self.height.checked_sub(1)?;
        let (children, near, height) = self.all();
        // SAFETY: all entries below the previous height have been written.
        Some(unsafe { (*children.add(height), *near.add(height)) })
    }

    /// Pops children until the entry distance of one is at most `far`, and returns that child. Such
    /// a child must exist.
    #[inline(always)]
    pub fn pop_until(&mut self, far: f32) -> u32 {
        loop {
            match self.pop_near() {
                Some((_, near)) if near > far => {}
                Some((child, _)) => return child,
                None => unreachable!("the lowest child is entered in time"),
            }
        }
    }

    pub fn clear(&mut self) {
        self.height = 0;
    }

    /// Returns the topmost child and removes it if `wanted` is true. The stack must not be empty.
    #[inline(always)]
    pub fn pop_if(&mut self, wanted: bool) -> u32 {
        assert!(self.height > 0);
        self.height -= usize::from(wanted);
        // SAFETY: all entries below the previous height have been written.
        unsafe { *self.storage.children.as_ptr().cast::<u32>().add(self.height - usize::from(!wanted)) }
    }

    /// Returns pointers to the top of the stack, where there is space for a full vector. The caller
    /// must call [`Stack::grow`] after writing to them.
    #[inline(always)]
    pub(super) fn top(&mut self) -> (*mut u32, *mut f32) {
        assert!(self.height <= CAPACITY - WIDTH);
        let (children, near, height) = self.all();
        // SAFETY: there is space for a vector above the current height.
        unsafe { (children.add(height), near.add(height)) }
    }

    /// # Safety
    ///
    /// `count` must be at most eight, and that many entries must have been written to
    /// [`Stack::top`].
    #[cfg(any(target_arch = "x86_64", all(target_arch = "wasm32", target_feature = "simd128")))]
    #[inline(always)]
    pub(super) unsafe fn grow(&mut self, count: u32) {
        self.height += count as usize;
    }

    /// Returns pointers to the bottom child and its distance, and the height.
    #[inline(always)]
    pub(super) fn all(&mut self) -> (*mut u32, *mut f32, usize) {
        (self.storage.children.as_mut_ptr().cast::<u32>(), self.storage.near.as_mut_ptr().cast::<f32>(), self.height)
    }
}
