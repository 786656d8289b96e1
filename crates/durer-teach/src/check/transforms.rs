//! Checks for transforms that move objects out of the picture.

use super::scene_probe::SceneProbe;
use durer_diag::Span;
use durer_scene::math::Vec3;
use durer_scene::scene::{MatrixOp, MatrixRules, Object, ObjectKind};

/// If nothing is in the picture, returns a transform's span and a sentence about it. It is the
/// first transform that moves its object out of the picture but would not do so if it were reversed
/// or removed.
pub(super) fn moved_out_of_view(scene_probe: &SceneProbe) -> Option<(Span, String)> {
    let objects = scene_probe.input.scene.root.iter().flat_map(|root| &root.objects);
    objects.filter_map(|object| of(scene_probe, object)).next()
}

fn of(scene_probe: &SceneProbe, object: &Object) -> Option<(Span, String)> {
    let ObjectKind::Transform(ops, inner) = &object.node else { return None };
    // Find the compiled object by the position of its keyword.
    let world = scene_probe.world();
    let own =
        world.objects().iter().find(|own| own.span.file == inner.span.file && own.span.start == inner.span.start)?;
    let (to_world, bounds) = (own.to_world.as_ref()?, own.bounds()?);
    let local = to_world.inverse_point(bounds.center()) + own.center;
    let by =
        |ops: &[MatrixOp]| MatrixOp::product(ops, MatrixRules::default()).transform_point3(local.as_dvec3()).as_vec3();
    let aims = |place: Vec3| super::visibility::is_in_view(scene_probe, place);
    let place = super::finding::vector(bounds.center());
    let reversed: Vec<MatrixOp> = ops.iter().rev().copied().collect();
    let other = by(&reversed);
    if ops.len() > 1 && aims(other) {
        let words = format!(
            "the object's transforms move it to {place}; in the reverse order, they would move it to {}, in the \
             picture (the transform written last is applied first)",
            super::finding::vector(other)
        );
        return Some((object.span, words));
    }
    aims(local).then(|| {
        (object.span, format!("the object's transforms move it to {place}; without them, it would be in the picture"))
    })
}
