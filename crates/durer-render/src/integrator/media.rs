//! Tracking of the objects that a ray is inside, such as nested glass, for refraction.

use crate::world::{SurfaceInteraction, World};
use durer_scene::math::Vec3;
use smallvec::SmallVec;

/// Refractive indices and media on both sides of a surface that a ray may pass.
pub struct Passage {
    /// Index of refraction in front of the surface.
    pub here: f32,
    /// Index of refraction behind the surface.
    pub there: f32,
    /// Media of a ray behind the surface.
    pub behind: Media,
    /// True if the surface is inside an object that displaces it, so that it has no effect.
    pub hidden: bool,
}

impl Passage {
    /// Returns the index of refraction behind the surface divided by that in front of it.
    pub(crate) fn eta(&self) -> f32 {
        self.there / self.here
    }

    /// Returns the passage without surrounding media: the index is `ior` inside and 1 outside.
    pub(crate) fn across(self, ior: f32, leaving: bool) -> Passage {
        let (here, there) = if leaving { (ior, 1.0) } else { (1.0, ior) };
        Passage { here, there, hidden: false, ..self }
    }
}

impl Default for Passage {
    fn default() -> Self {
        Passage { here: 1.0, there: 1.0, behind: Media::default(), hidden: false }
    }
}

/// Object with an index of refraction that contains the ray, an entry of [`Media`].
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Body {
    /// Index of the object.
    pub object: u32,
    /// Index of refraction.
    pub ior: f32,
    /// Half the surface area of the object's bounds. `None` for an open surface, which has no
    /// inside.
    pub size: Option<f32>,
}

impl Body {
    fn new(world: &World, object: u32, ior: f32) -> Self {
        Body { object, ior, size: world.extent(object) }
    }

    /// Returns true if this object displaces `other` where they overlap. If both are closed, the
    /// smaller one does: ice displaces water, whatever the ray's direction. Otherwise it is the one
    /// that the ray entered later.
    fn fills(&self, other: &Body, met_later: bool) -> bool {
        match (self.size, other.size) {
            (Some(a), Some(b)) if a != b => a < b,
            (Some(_), Some(_)) => self.object > other.object,
            _ => met_later,
        }
    }
}

/// Stack of the objects that contain a ray. The last one fills the space; an empty stack is air.
///
/// Source of the idea: Charles M. Schmidt and Brian Budge, *Simple Nested Dielectrics in Ray Traced
/// Images*, Journal of Graphics Tools 7(2), 2002. There, explicit priorities define the order.
#[derive(Debug, Default, PartialEq)]
pub struct Media(SmallVec<[Body; 2]>);

impl Clone for Media {
    // This is faster than cloning element by element.
    fn clone(&self) -> Self {
        Media(SmallVec::from_slice(&self.0))
    }
}

impl Media {
    /// Returns the objects that contain a point.
    pub fn around(world: &World, point: Vec3) -> Self {
        Media::within(world, world.bodies_around(point))
    }

    /// Builds the stack from objects and their indices of refraction.
    fn within(world: &World, bodies: impl Iterator<Item = (u32, f32)>) -> Self {
        bodies.fold(Media::default(), |media, (object, ior)| media.entered(Body::new(world, object, ior)))
    }

    /// Creates a stack with a single object.
    pub fn only(medium: Body) -> Self {
        Media(SmallVec::from_slice(&[medium]))
    }

    /// Removes all objects, which leaves air.
    pub fn clear(&mut self) {
        self.0.clear();
    }

    /// Returns true if the ray is in air.
    pub fn is_air(&self) -> bool {
        self.0.is_empty()
    }

    /// Returns the index of refraction of the space around the ray; 1 in air.
    pub fn ior(&self) -> f32 {
        self.0.last().map_or(1.0, |medium| medium.ior)
    }

    /// Returns true if the ray is inside this object.
    pub fn holds(&self, object: u32) -> bool {
        self.0.iter().any(|medium| medium.object == object)
    }

    /// Returns the object that fills the space around the ray; `None` in air.
    pub fn object(&self) -> Option<u32> {
        self.0.last().map(|medium| medium.object)
    }

    /// Returns the stack after entering an object.
    pub fn entered(&self, medium: Body) -> Self {
        if self.is_air() {
            return Media::only(medium);
        }
        let mut inside = self.0.clone();
        let behind = inside.iter().rev().take_while(|other| !medium.fills(other, true)).count();
        inside.insert(inside.len() - behind, medium);
        Media(inside)
    }

    /// Returns the stack after leaving an object.
    pub fn left(&self, object: u32) -> Self {
        if let [only] = &self.0[..] {
            return if only.object == object { Media::default() } else { Media::only(*only) };
        }
        let mut inside = self.0.clone();
        if let Some(place) = inside.iter().rposition(|medium| medium.object == object) {
            inside.remove(place);
        }
        Media(inside)
    }

    /// Returns the passage of a ray through the surface it hit, with nested and overlapping glass,
    /// as in Dürer's own dialect.
    pub(crate) fn nested_passage(&self, world: &World, at: &SurfaceInteraction, ior: f32, leaving: bool) -> Passage {
        self.passage_into(world, (at.hit.object, at.ray.rounded.origin), ior, leaving)
    }

    /// Returns the passage through an object's surface for a ray from `start`. See
    /// [`Media::nested_passage`].
    pub(crate) fn passage_into(&self, world: &World, (object, start): (u32, Vec3), ior: f32, leaving: bool) -> Passage {
        let own = Body::new(world, object, ior);
        if !leaving {
            let behind = self.entered(own);
            let hidden = !self.is_air() && behind.object() == self.object() && self.object() != Some(object);
            return Passage { here: self.ior(), there: behind.ior(), behind, hidden };
        }
        let found = if self.holds(object) {
            self.clone()
        } else if own.size.is_none() {
            self.entered(own)
        } else if world.objects()[object as usize].contains(start) {
            // The ray leaves an object that it never entered, so it started inside.
            let others = world.glass_around(start).filter(|&(other, _)| other != object);
            Media::within(world, others.chain([(object, ior)]))
        } else {
            // The normals are inverted: the surface is the wall of a cavity in the surrounding
            // medium.
            let behind = self.object().map_or(Media::default(), |around| self.left(around));
            return Passage {
                here: if self.is_air() { own.ior } else { self.ior() },
                there: behind.ior(),
                behind,
                hidden: false,
            };
        };
        let behind = found.left(object);
        let hidden = found.object() != Some(object);
        Passage { here: found.ior(), there: behind.ior(), behind, hidden }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    const GLASS: Body = Body { object: 7, ior: 1.5, size: Some(9.0) };
    const WATER: Body = Body { object: 3, ior: 1.33, size: Some(5.0) };
    const ICE: Body = Body { object: 5, ior: 1.31, size: Some(1.0) };
    const PANE: Body = Body { object: 1, ior: 1.4, size: None };

    #[test]
    fn smallest_closed_object_fills_the_space_in_any_order_of_entering() {
        for order in [[GLASS, WATER, ICE], [ICE, WATER, GLASS], [WATER, ICE, GLASS], [ICE, GLASS, WATER]] {
            let all = order.into_iter().fold(Media::default(), |media, medium| media.entered(medium));
            assert_eq!((all.ior(), all.object()), (1.31, Some(5)));
            assert_eq!((all.left(5).ior(), all.left(5).left(3).ior()), (1.33, 1.5));
            assert_eq!(all.left(3).ior(), 1.31);
            assert!(all.left(3).left(5).left(7).is_air());
        }
        // A ray can enter an object twice if its surface overlaps itself.
        let twice = Media::only(ICE).entered(ICE);
        assert!(twice.left(5).holds(5) && twice.left(5).left(5).is_air());
        assert_eq!(Media::default().left(2), Media::default());
    }

    #[test]
    fn an_open_surface_hides_nothing() {
        let behind = Media::only(PANE);
        assert_eq!((behind.ior(), behind.entered(GLASS).ior()), (1.4, 1.5));
        assert_eq!(behind.entered(GLASS).left(7).ior(), 1.4);
        assert_eq!(Media::only(ICE).entered(PANE).ior(), 1.4);
    }
}
