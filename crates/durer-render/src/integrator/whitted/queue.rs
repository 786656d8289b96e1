//! Rays that wait to be traced, and the sums that their light becomes.

use crate::integrator::media::Media;
use crate::integrator::trace::{NodeId, TraceListener};
use crate::world::TOGETHER;
use durer_scene::math::{Color, Ray, Ray64, Vec3};

/// Parent of a camera ray.
const CAMERA: u32 = u32::MAX;

/// A ray, and the light that is known to come along it.
pub(super) struct Segment {
    pub(super) ray: Ray64,
    /// Hits count from this `t` on: behind surfaces that are none.
    pub(super) t_min: f32,
    /// Bodies that the ray runs in.
    pub(super) media: Media,
    /// Levels of secondary rays that may follow it.
    pub(super) bounces: u32,
    /// Share of the pixel that its light may make up; see [`super::Settings::least_weight`].
    pub(super) weight: f32,
    /// Number of the camera ray that it belongs to.
    pub(super) camera: u32,
    /// The segment that spawned it, or [`CAMERA`].
    pub(super) parent: u32,
    /// Which of its parent's branches it is: 0 mirrored, 1 transmitted.
    pub(super) branch: usize,
    /// Weight of its light in its parent's sum.
    pub(super) factor: Color,
    /// Its node in the trace.
    pub(super) node: NodeId,
    /// Light from its hit itself: ambient light and lights.
    pub(super) local: Color,
    /// Weighted light of its branches.
    pub(super) branches: [Color; 2],
    /// How many of its branches are still under way.
    pub(super) pending: u32,
    /// Node of the sum of its branches.
    pub(super) secondary: NodeId,
}

impl Default for Segment {
    fn default() -> Self {
        Segment {
            ray: Ray64::from(Ray::new(Vec3::ZERO, Vec3::X)),
            t_min: 0.0,
            media: Media::default(),
            bounces: 0,
            weight: 1.0,
            camera: 0,
            parent: CAMERA,
            branch: 0,
            factor: Color::ONE,
            node: NodeId::NONE,
            local: Color::ZERO,
            branches: [Color::ZERO; 2],
            pending: 0,
            secondary: NodeId::NONE,
        }
    }
}

/// Segments under way. Those that wait to be traced form a stack, so that at most a batch for each
/// level of secondary rays is under way, and no call nests.
#[derive(Default)]
pub(super) struct Queue {
    /// Segments under way are among the first `used`; the others are room that was taken before.
    segments: Vec<Segment>,
    used: u32,
    /// Numbers of segments that are done, to be used again.
    free: Vec<u32>,
    waiting: Vec<u32>,
}

impl Queue {
    pub(super) fn clear(&mut self) {
        self.used = 0;
        self.free.clear();
        self.waiting.clear();
    }

    #[inline]
    pub(super) fn segment(&mut self, number: u32) -> &mut Segment {
        &mut self.segments[number as usize]
    }

    /// Adds a camera ray, to be traced next.
    #[inline]
    pub(super) fn push_camera(&mut self, ray: &Ray64, camera: u32, bounces: u32, node: NodeId) {
        let segment = self.push(ray, node);
        segment.media.clear();
        (segment.bounces, segment.weight, segment.factor) = (bounces, 1.0, Color::ONE);
        (segment.camera, segment.parent) = (camera, CAMERA);
    }

    /// Adds a segment, to be traced next. It is filled in place: a copy of one costs as much as a hit. The
    /// caller sets what is not set here, but for the sums, which [`super::secondary`] begins.
    #[inline]
    pub(super) fn push(&mut self, ray: &Ray64, node: NodeId) -> &mut Segment {
        let number = self.free.pop().unwrap_or_else(|| {
            if self.used as usize == self.segments.len() {
                self.segments.push(Segment::default());
            }
            self.used += 1;
            self.used - 1
        });
        self.waiting.push(number);
        let segment = &mut self.segments[number as usize];
        (segment.ray, segment.t_min, segment.node) = (*ray, ray.rounded.t_min, node);
        segment
    }

    /// Has a segment traced on.
    pub(super) fn push_again(&mut self, number: u32) {
        self.waiting.push(number);
    }

    /// Takes up to [`TOGETHER`] of the segments that were added last; returns how many.
    pub(super) fn take(&mut self, batch: &mut [u32; TOGETHER]) -> usize {
        let count = self.waiting.len().min(TOGETHER);
        let start = self.waiting.len() - count;
        batch[..count].copy_from_slice(&self.waiting[start..]);
        self.waiting.truncate(start);
        count
    }

    /// Ends a segment along which this light comes, and all those whose sums are complete with it.
    pub(super) fn finish<T: TraceListener>(
        &mut self,
        mut number: u32,
        mut light: Color,
        colors: &mut [Color],
        tally: &mut T,
    ) {
        loop {
            let &mut Segment { parent, branch, factor, node, camera, .. } = self.segment(number);
            tally.end(node, factor, Color::ONE, light);
            self.free.push(number);
            if parent == CAMERA {
                colors[camera as usize] = light;
                return;
            }
            let above = self.segment(parent);
            above.branches[branch] = factor * light;
            above.pending -= 1;
            if above.pending > 0 {
                return;
            }
            let [mirrored, transmitted] = above.branches;
            let secondary = Color::ZERO + mirrored + transmitted;
            tally.end(above.secondary, Color::ONE, Color::ONE, secondary);
            (number, light) = (parent, above.local + secondary);
        }
    }
}
