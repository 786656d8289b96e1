//! Tracking of the objects that contain a ray, such as nested glass, for refraction.

use crate::world::{SurfaceInteraction, World};
use durer_scene::math::Vec3;
use smallvec::SmallVec;

/// Indices of refraction and media on both sides of a surface that a ray may pass through.
pub struct MediumTransition {
    /// Index of refraction in front of the surface.
    pub ior_front: f32,
    /// Index of refraction behind the surface.
    pub ior_behind: f32,
    /// Objects that contain the ray behind the surface.
    pub behind: MediumStack,
    /// True if the surface has no effect because it is inside an object that displaces its own
    /// object.
    pub displaced: bool,
}

impl MediumTransition {
    /// Returns the ratio of the index of refraction behind the surface to that in front of it.
    pub(crate) fn eta(&self) -> f32 {
        self.ior_behind / self.ior_front
    }

    /// Returns the transition without surrounding media, where the index is `ior` inside the object
    /// and 1 outside.
    pub(crate) fn without_surroundings(self, ior: f32, leaving: bool) -> MediumTransition {
        let (ior_front, ior_behind) = if leaving { (ior, 1.0) } else { (1.0, ior) };
        MediumTransition { ior_front, ior_behind, displaced: false, ..self }
    }
}

impl Default for MediumTransition {
    fn default() -> Self {
        MediumTransition { ior_front: 1.0, ior_behind: 1.0, behind: MediumStack::default(), displaced: false }
    }
}

/// Object with an index of refraction that contains the ray; an entry of a [`MediumStack`].
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct MediumEntry {
    /// Index of the object.
    pub object: u32,
    /// Index of refraction.
    pub ior: f32,
    /// Half the surface area of the object's bounds. It is `None` for an open surface, which has no
    /// inside.
    pub size: Option<f32>,
}

impl MediumEntry {
    fn new(world: &World, object: u32, ior: f32) -> Self {
        MediumEntry { object, ior, size: world.half_area(object) }
    }

    /// Returns true if this object displaces `other` where they overlap. If both objects are
    /// closed, the smaller one displaces the larger: ice displaces water, whatever the ray's
    /// direction. Otherwise, the object that the ray entered later displaces the other.
    fn displaces(&self, other: &MediumEntry, met_later: bool) -> bool {
        match (self.size, other.size) {
            (Some(a), Some(b)) if a != b => a < b,
            (Some(_), Some(_)) => self.object > other.object,
            _ => met_later,
        }
    }
}

/// Stack of the objects that contain a ray. The last object fills the space around the ray; an
/// empty stack means air.
///
/// The idea comes from Charles M. Schmidt and Brian Budge, *Simple Nested Dielectrics in Ray Traced
/// Images*, Journal of Graphics Tools 7(2), 2002. In that article, explicit priorities define the
/// order.
#[derive(Debug, Default, PartialEq)]
pub struct MediumStack(SmallVec<[MediumEntry; 2]>);

impl Clone for MediumStack {
    // Copying the slice is faster than cloning element by element.
    fn clone(&self) -> Self {
        MediumStack(SmallVec::from_slice(&self.0))
    }
}

impl MediumStack {
    /// Returns a stack of the objects that contain a point.
    pub fn around(world: &World, point: Vec3) -> Self {
        MediumStack::within(world, world.bodies_around(point))
    }

    /// Builds a stack from objects and their indices of refraction.
    fn within(world: &World, bodies: impl Iterator<Item = (u32, f32)>) -> Self {
        bodies.fold(MediumStack::default(), |media, (object, ior)| {
            media.with_object(MediumEntry::new(world, object, ior))
        })
    }

    /// Creates a stack with a single object.
    pub fn single(medium: MediumEntry) -> Self {
        MediumStack(SmallVec::from_slice(&[medium]))
    }

    /// Removes all objects, which leaves air.
    pub fn clear(&mut self) {
        self.0.clear();
    }

    /// Returns true if the ray is in air.
    pub fn is_air(&self) -> bool {
        self.0.is_empty()
    }

    /// Returns the index of refraction of the space around the ray, which is 1 in air.
    pub fn ior(&self) -> f32 {
        self.0.last().map_or(1.0, |medium| medium.ior)
    }

    /// Returns true if the ray is inside the given object.
    pub fn contains(&self, object: u32) -> bool {
        self.0.iter().any(|medium| medium.object == object)
    }

    /// Returns the object that fills the space around the ray, or `None` in air.
    pub fn object(&self) -> Option<u32> {
        self.0.last().map(|medium| medium.object)
    }

    /// Returns the stack after the ray enters an object.
    pub fn with_object(&self, medium: MediumEntry) -> Self {
        if self.is_air() {
            return MediumStack::single(medium);
        }
        let mut inside = self.0.clone();
        let behind = inside.iter().rev().take_while(|other| !medium.displaces(other, true)).count();
        inside.insert(inside.len() - behind, medium);
        MediumStack(inside)
    }

    /// Returns the stack after the ray leaves an object.
    pub fn without_object(&self, object: u32) -> Self {
        if let [only] = &self.0[..] {
            return if only.object == object { MediumStack::default() } else { MediumStack::single(*only) };
        }
        let mut inside = self.0.clone();
        if let Some(place) = inside.iter().rposition(|medium| medium.object == object) {
            inside.remove(place);
        }
        MediumStack(inside)
    }

    /// Returns the transition of a ray through the surface that it hit, taking nested and
    /// overlapping glass into account, as in Dürer's own dialect.
    pub(crate) fn nested_transition(
        &self,
        world: &World,
        at: &SurfaceInteraction,
        ior: f32,
        leaving: bool,
    ) -> MediumTransition {
        self.transition_into(world, (at.hit.object, at.ray.rounded.origin), ior, leaving)
    }

    /// Returns the transition through the surface of an object for a ray that starts at `start`.
    /// See [`MediumStack::nested_transition`].
    pub(crate) fn transition_into(
        &self,
        world: &World,
        (object, start): (u32, Vec3),
        ior: f32,
        leaving: bool,
    ) -> MediumTransition {
        let entry = MediumEntry::new(world, object, ior);
        if !leaving {
            let behind = self.with_object(entry);
            let displaced = !self.is_air() && behind.object() == self.object() && self.object() != Some(object);
            return MediumTransition { ior_front: self.ior(), ior_behind: behind.ior(), behind, displaced };
        }
        let stack = if self.contains(object) {
            self.clone()
        } else if entry.size.is_none() {
            self.with_object(entry)
        } else if world.objects()[object as usize].contains(start) {
            // The ray leaves an object that it never entered, so it must have started inside.
            let others = world.glass_around(start).filter(|&(other, _)| other != object);
            MediumStack::within(world, others.chain([(object, ior)]))
        } else {
            // The normals are inverted, so the surface is the wall of a cavity in the surrounding
            // medium.
            let behind = self.object().map_or(MediumStack::default(), |around| self.without_object(around));
            return MediumTransition {
                ior_front: if self.is_air() { entry.ior } else { self.ior() },
                ior_behind: behind.ior(),
                behind,
                displaced: false,
            };
        };
        let behind = stack.without_object(object);
        let displaced = stack.object() != Some(object);
        MediumTransition { ior_front: stack.ior(), ior_behind: behind.ior(), behind, displaced }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    const GLASS: MediumEntry = MediumEntry { object: 7, ior: 1.5, size: Some(9.0) };
    const WATER: MediumEntry = MediumEntry { object: 3, ior: 1.33, size: Some(5.0) };
    const ICE: MediumEntry = MediumEntry { object: 5, ior: 1.31, size: Some(1.0) };
    const PANE: MediumEntry = MediumEntry { object: 1, ior: 1.4, size: None };

    #[test]
    fn smallest_closed_object_fills_the_space_in_any_order_of_entering() {
        for order in [[GLASS, WATER, ICE], [ICE, WATER, GLASS], [WATER, ICE, GLASS], [ICE, GLASS, WATER]] {
            let all = order.into_iter().fold(MediumStack::default(), |media, medium| media.with_object(medium));
            assert_eq!((all.ior(), all.object()), (1.31, Some(5)));
            assert_eq!((all.without_object(5).ior(), all.without_object(5).without_object(3).ior()), (1.33, 1.5));
            assert_eq!(all.without_object(3).ior(), 1.31);
            assert!(all.without_object(3).without_object(5).without_object(7).is_air());
        }
        // A ray can enter an object twice if its surface overlaps itself.
        let twice = MediumStack::single(ICE).with_object(ICE);
        assert!(twice.without_object(5).contains(5) && twice.without_object(5).without_object(5).is_air());
        assert_eq!(MediumStack::default().without_object(2), MediumStack::default());
    }

    #[test]
    fn an_open_surface_hides_nothing() {
        let behind = MediumStack::single(PANE);
        assert_eq!((behind.ior(), behind.with_object(GLASS).ior()), (1.4, 1.5));
        assert_eq!(behind.with_object(GLASS).without_object(7).ior(), 1.4);
        assert_eq!(MediumStack::single(ICE).with_object(PANE).ior(), 1.4);
    }
}
