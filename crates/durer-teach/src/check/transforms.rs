//! Checks for transforms that move objects out of the picture.

use super::finding::vector;
use super::scene_probe::SceneProbe;
use durer_diag::Span;
use durer_scene::math::{Aabb, Vec3};
use durer_scene::scene::{MatrixOp, MatrixRules, Object, ObjectKind};

/// Returns a transform's span and a sentence about it. It is the first transform that moves its
/// object to a place that cannot be seen, although the object would be seen if the transform were
/// reversed or removed. `is_free` returns false for places that an object hides.
pub(super) fn moved_out_of_view(scene_probe: &SceneProbe, is_free: &dyn Fn(Vec3) -> bool) -> Option<(Span, String)> {
    let objects = scene_probe.input.scene.root.iter().flat_map(|root| &root.objects);
    objects.filter_map(|object| of(scene_probe, object, is_free)).next()
}

fn of(scene_probe: &SceneProbe, object: &Object, is_free: &dyn Fn(Vec3) -> bool) -> Option<(Span, String)> {
    let (ops, inner) = match &object.node {
        ObjectKind::Transform(ops, inner) => (ops, inner),
        ObjectKind::Group(group) => {
            return group.objects.iter().find_map(|inner| of(scene_probe, inner, is_free));
        }
        _ => return None,
    };
    // Find the compiled object by the position of its keyword.
    let world = scene_probe.world();
    let own =
        world.objects().iter().find(|own| own.span.file == inner.span.file && own.span.start == inner.span.start)?;
    let (to_world, bounds) = (own.to_world.as_ref()?, own.bounds()?);
    let sees = |place: Vec3| super::visibility::is_in_view(scene_probe, place) && is_free(place);
    if around(bounds).into_iter().any(sees) {
        return None;
    }
    let matrix = |ops: &[MatrixOp]| MatrixOp::product(ops, MatrixRules::default());
    // The points of the object before its transforms.
    let local = around(bounds).map(|place| (to_world.inverse_point(place) + own.center).as_dvec3());
    let reversed: Vec<MatrixOp> = ops.iter().rev().copied().collect();
    let turned = local.map(|place| matrix(&reversed).transform_point3(place).as_vec3());
    let (from, to) = (vector(local[0].as_vec3()), vector(bounds.center()));
    if ops.len() > 1 && turned.into_iter().any(sees) {
        let words = format!(
            "the object's transforms move it from {from} to {to}; in the reverse order, they would move it to {}, in \
             the picture (the transform written last is applied first)",
            vector(turned[0])
        );
        return Some((object.span, words));
    }
    local.into_iter().any(|place| sees(place.as_vec3())).then(|| {
        let words = format!(
            "the object's transforms move it from {from} to {to}; without them, it would be in the picture: check \
             whether it is moved twice"
        );
        (object.span, words)
    })
}

/// Returns the centre of a box, and points near the centres of its faces. The surface of most
/// objects reaches these.
fn around(bounds: Aabb) -> [Vec3; 7] {
    let (center, half) = (bounds.center(), 0.45 * bounds.size());
    let [x, y, z] = [half * Vec3::X, half * Vec3::Y, half * Vec3::Z];
    [center, center - x, center + x, center - y, center + y, center - z, center + z]
}
