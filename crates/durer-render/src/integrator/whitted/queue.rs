//! Queue of rays that the Whitted integrator traces, with the sums of the light along them.

use crate::integrator::media::MediumStack;
use crate::integrator::trace::{NodeId, TraceListener};
use durer_scene::math::{Color, Ray, Ray64, Vec3};

/// Parent index of camera rays.
const CAMERA: u32 = u32::MAX;

/// Ray in the queue of the Whitted integrator, with the light found along it so far.
pub(super) struct Segment {
    pub(super) ray: Ray64,
    /// Minimum value of `t` for hits. The value is chosen so that surfaces that were ignored are
    /// skipped.
    pub(super) t_min: f32,
    /// Objects that contain the ray.
    pub(super) media: MediumStack,
    /// Maximum depth of secondary rays that start from this ray.
    pub(super) bounces: u32,
    /// Weight of the ray in the pixel; see [`super::RenderSettings::min_weight`].
    pub(super) weight: f32,
    /// Index of the camera ray from which this ray descends.
    pub(super) camera: u32,
    /// Index of the parent segment, or [`CAMERA`] if there is none.
    pub(super) parent: u32,
    /// Kind of ray: 0 for reflected, 1 for transmitted.
    pub(super) branch: usize,
    /// Weight of the ray in the radiance of its parent.
    pub(super) factor: Color,
    /// Node of the ray in the trace.
    pub(super) node: NodeId,
    /// Ambient and direct light at the segment's own hit.
    pub(super) local: Color,
    /// Weighted radiance of the reflected ray and the transmitted ray.
    pub(super) branches: [Color; 2],
    /// Number of secondary rays that are not finished.
    pub(super) pending: u32,
    /// Trace node for the sum of the secondary rays.
    pub(super) secondary: NodeId,
}

impl Default for Segment {
    fn default() -> Self {
        Segment {
            ray: Ray64::from(Ray::new(Vec3::ZERO, Vec3::X)),
            t_min: 0.0,
            media: MediumStack::default(),
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

/// Rays that the Whitted integrator is tracing. The waiting rays form a stack, so that at most one
/// batch per level of secondary rays is in progress, and there is no recursion.
#[derive(Default)]
pub(super) struct Queue {
    /// Segments, of which the first `used` are in use or free. The remaining segments are kept for
    /// reuse.
    segments: Vec<Segment>,
    used: u32,
    /// Indices of the finished segments among the first `used` ones.
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

    /// Adds a camera ray as the next ray to trace.
    #[inline]
    pub(super) fn push_camera(&mut self, ray: &Ray64, camera: u32, bounces: u32, node: NodeId) {
        let segment = self.push(ray, node);
        segment.media.clear();
        (segment.bounces, segment.weight, segment.factor) = (bounces, 1.0, Color::ONE);
        (segment.camera, segment.parent) = (camera, CAMERA);
    }

    /// Adds a segment as the next one to trace. The segment is filled in place, since copying a
    /// segment costs as much as an intersection. The caller sets all remaining fields except the
    /// sums, which [`super::secondary`] initializes.
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

    /// Queues a segment again after it passed an ignored surface.
    pub(super) fn push_again(&mut self, number: u32) {
        self.waiting.push(number);
    }

    /// Moves the most recently added segments from the stack to `batch` until it is full, and
    /// returns their number.
    pub(super) fn take(&mut self, batch: &mut [u32]) -> usize {
        let count = self.waiting.len().min(batch.len());
        let start = self.waiting.len() - count;
        batch[..count].copy_from_slice(&self.waiting[start..]);
        self.waiting.truncate(start);
        count
    }

    /// Finishes a segment, given its radiance, and all ancestors whose sums are complete as a
    /// result.
    pub(super) fn finish<T: TraceListener>(
        &mut self,
        mut number: u32,
        mut light: Color,
        colors: &mut [Color],
        listener: &mut T,
    ) {
        loop {
            let &mut Segment { parent, branch, factor, node, camera, .. } = self.segment(number);
            listener.end(node, factor, Color::ONE, light);
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
            listener.end(above.secondary, Color::ONE, Color::ONE, secondary);
            (number, light) = (parent, above.local + secondary);
        }
    }
}
