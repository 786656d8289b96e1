//! Surfaces that the camera sees, and those that it looks through.

use super::coincident::PassedSurfaces;
use super::{SurfaceInteraction, World};
use durer_bvh::TraversalCounter;
use durer_scene::math::{Ray, Ray64};
use durer_scene::sampler::SampleId;

impl World {
    /// Returns true if path tracing looks through some surfaces on camera rays.
    pub fn is_seen_through(&self) -> bool {
        self.has_unseen() || self.has_cutouts() || self.hides_backs() || self.hides_emitters()
    }

    /// Returns the first surface on a camera ray that the camera sees with path tracing. Like the
    /// path of a sample, the ray passes cutouts at random; without a sample, it stops there.
    pub fn first_seen<T: TraversalCounter>(
        &self,
        ray: &Ray,
        sample: Option<&SampleId>,
        counter: &mut T,
    ) -> Option<SurfaceInteraction> {
        let (mut rest, mut passed, mut layers) = (Ray64::from(*ray), PassedSurfaces::default(), 0);
        loop {
            let hit = passed.next_hit(self, &mut rest, counter)?;
            let at = self.interaction(rest, hit);
            let is_hidden = self.is_unseen(&at)
                || self.hides_backs() && self.is_hidden(rest.dir(), &at)
                || self.hides_emitters() && self.emits(at.material);
            if !is_hidden && !self.passes_cutout(&at, sample, &mut layers) {
                return Some(at);
            }
            passed.pass(&hit);
        }
    }

    /// Returns true if the path of a sample passes a surface because of its opacity. `layers`
    /// counts the surfaces.
    fn passes_cutout(&self, at: &SurfaceInteraction, sample: Option<&SampleId>, layers: &mut u32) -> bool {
        let Some(sample) = sample.filter(|_| self.has_cutouts()) else { return false };
        let opacity = self.opacity(at);
        *layers += 1;
        opacity < 1.0 && sample.layer(0, *layers) >= opacity
    }
}
