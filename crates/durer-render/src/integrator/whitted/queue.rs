//! Queue of rays to trace, and the sums of their light.

use crate::integrator::media::Media;
use crate::integrator::trace::{NodeId, TraceListener};
use crate::world::MAX_BATCH;
use durer_scene::math::{Color, Ray, Ray64, Vec3};

/// Parent index of a camera ray.
const CAMERA: u32 = u32::MAX;

/// A ray and the radiance found along it so far.
pub(super) struct Segment {
    pub(super) ray: Ray64,
    /// Minimum `t` of hits: beyond surfaces that were ignored.
    pub(super) t_min: f32,
    /// Objects that contain the ray.
    pub(super) media: Media,
    /// Remaining depth of secondary rays.
    pub(super) bounces: u32,
    /// Throughput relative to the pixel; see [`super::WhittedOptions::least_weight`].
    pub(super) weight: f32,
    /// Index of its camera ray.
    pub(super) camera: u32,
    /// Index of the parent segment, or [`CAMERA`].
    pub(super) parent: u32,
    /// Branch of the parent: 0 reflected, 1 transmitted.
    pub(super) branch: usize,
    /// Weight in the parent's sum.
    pub(super) factor: Color,
    /// Node in the trace.
    pub(super) node: NodeId,
    /// Light at its own hit: ambient light and lights.
    pub(super) local: Color,
    /// Weighted radiance of its branches.
    pub(super) branches: [Color; 2],
    /// Number of unfinished branches.
    pub(super) pending: u32,
    /// Trace node of the sum of its branches.
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

/// Segments in progress. Waiting segments form a stack, so that at most one batch for each level of
/// secondary rays is in progress, and nothing recurses.
#[derive(Default)]
pub(super) struct Queue {
    /// The first `used` are in use or free; the others are kept for reuse.
    segments: Vec<Segment>,
    used: u32,
    /// Indices of finished segments, for reuse.
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

    /// Adds a segment, to be traced next. Fills it in place, since copying a segment costs as much
    /// as a hit. The caller sets the remaining fields except the sums, which [`super::secondary`]
    /// initializes.
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

    /// Queues a segment to be traced further.
    pub(super) fn push_again(&mut self, number: u32) {
        self.waiting.push(number);
    }

    /// Removes up to [`MAX_BATCH`] of the most recently added segments; returns their number.
    pub(super) fn take(&mut self, batch: &mut [u32; MAX_BATCH]) -> usize {
        let count = self.waiting.len().min(MAX_BATCH);
        let start = self.waiting.len() - count;
        batch[..count].copy_from_slice(&self.waiting[start..]);
        self.waiting.truncate(start);
        count
    }

    /// Finishes a segment with its radiance, and all ancestors whose sums are complete with it.
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
