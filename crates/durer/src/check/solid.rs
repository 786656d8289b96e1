//! Solids: in which objects a point lies, and parts that change nothing.

use super::MOST_SOUGHT;
use super::finding::Finding;
use super::scout::Scout;
use crate::diag::Diagnostic;
use crate::math::{Aabb, Ray, Ray64, Vec3};
use crate::scene::{Node, Operation, extent};
use crate::world::World;

/// Directions in which no edge of a thing that was made by hand is likely to run.
const DIRECTIONS: [Vec3; 5] = [
    Vec3::new(0.532, 0.741, 0.411),
    Vec3::new(-0.613, 0.274, 0.741),
    Vec3::new(0.317, -0.831, 0.457),
    Vec3::new(-0.443, -0.389, -0.808),
    Vec3::new(0.687, 0.173, -0.706),
];

/// The objects with an end in which a point lies: a ray to any side leaves them once more than it
/// enters them.
pub(super) fn around(world: &World, point: Vec3) -> Vec<u32> {
    let boxed = |object: &u32| {
        let bounds = world.objects()[*object as usize].bounds();
        bounds.is_some_and(|b| b.holds(point))
    };
    let mut inside: Vec<u32> = (0..world.objects().len() as u32).filter(boxed).collect();
    for direction in DIRECTIONS {
        if inside.is_empty() {
            break;
        }
        // Each by itself: where two surfaces lie in one another, one of them alone is met by a ray.
        inside.retain(|&object| {
            let mut rest = Ray64::from(Ray::new(point, direction));
            let crossings = std::iter::from_fn(|| {
                let t = world.hit_of(object, &rest)?.t;
                rest.rounded.t_min = t;
                Some(t)
            });
            crossings.count() % 2 == 1
        });
    }
    inside
}

/// Parts that are cut away where the first is not, as far as boxes tell.
pub(super) fn idle_part(scout: &Scout) -> Vec<Finding> {
    let scene = scout.subject.scene;
    let mut found = Vec::new();
    let mut all: Vec<&crate::scene::Object> = scene.root.iter().flat_map(|root| &root.objects).collect();
    while let Some(object) = all.pop().filter(|_| found.len() < MOST_SOUGHT) {
        match &object.node {
            Node::Group(group) => all.extend(&group.objects),
            Node::Transform(_, inner) => all.push(inner),
            Node::Solid(operation, parts) => {
                all.extend(parts);
                let bounds = |part: &crate::scene::Object| {
                    let mut bounds = Aabb::EMPTY;
                    extent::of(scene, part, &mut |p| bounds = bounds.with(p.as_vec3()));
                    Some(bounds).filter(|bounds| !bounds.is_empty())
                };
                let Some(first) = parts.first().and_then(bounds).filter(|_| *operation == Operation::Difference) else {
                    continue;
                };
                let apart = |b: &Aabb| b.min.cmpgt(first.max).any() || b.max.cmplt(first.min).any();
                for part in parts[1..].iter().filter(|part| bounds(part).is_some_and(|b| apart(&b))) {
                    let diagnostic = Diagnostic::warning("this part is taken away from where nothing is")
                        .at(part.span)
                        .related(parts[0].span, "it does not touch this")
                        .effect("it changes nothing: there is no hole")
                        .help("move it into the first part: look at its place and the transforms around it");
                    found.push(Finding::from(diagnostic));
                }
            }
            _ => {}
        }
    }
    found
}
