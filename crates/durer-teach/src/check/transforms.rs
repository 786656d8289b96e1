//! Checks for transforms in the wrong order: those that move objects out of the picture, scales
//! that also scale a translation, and rotations whose angle comes first.

use super::finding::{Finding, MAX_FINDINGS, number, vector};
use super::lines::is_same_span;
use super::scene_probe::SceneProbe;
use super::visibility::Visibility;
use durer_diag::{Diagnostic, Span};
use durer_scene::math::{Aabb, Vec3};
use durer_scene::scene::{MatrixOp, MatrixRules, Object, ObjectKind};

/// Returns a transform's span and a sentence about it. It is the first transform that moves its
/// object to a place that cannot be seen, although the object would be seen if the transform were
/// reversed or removed. `is_free` returns false for places that an object hides.
pub(super) fn moved_out_of_view(scene_probe: &SceneProbe, is_free: &dyn Fn(Vec3) -> bool) -> Option<(Span, String)> {
    let objects = scene_probe.input.scene.root.iter().flat_map(|root| &root.objects);
    objects.filter_map(|object| of(scene_probe, object, is_free)).next()
}

/// Returns the span of the transform around an object that is not in the picture, and a sentence
/// about how it moves the object there.
pub(super) fn why_moved(scene_probe: &SceneProbe, number: u32) -> Option<(Span, String)> {
    let span = scene_probe.object_span(number);
    let mut all: Vec<&Object> = scene_probe.input.scene.root.iter().flat_map(|root| &root.objects).collect();
    while let Some(object) = all.pop() {
        if let ObjectKind::Transform(_, inner) = &object.node
            && is_same_span(inner.span, span)
        {
            return of(scene_probe, object, &|_| true);
        }
        if !matches!(object.node, ObjectKind::Solid(..)) {
            all.extend(object.node.children());
        }
    }
    None
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
    // One translation alone may move it away.
    let without = |left_out: usize| {
        let rest: Vec<MatrixOp> = ops.iter().enumerate().filter(|(i, _)| *i != left_out).map(|(_, op)| *op).collect();
        local.map(|place| matrix(&rest).transform_point3(place).as_vec3())
    };
    let moves = ops.iter().enumerate().filter(|(_, op)| matches!(op, MatrixOp::Translate(_)));
    let mut to_blame = moves.filter(|(i, _)| ops.len() > 1 && without(*i).into_iter().any(sees));
    if let (Some((i, MatrixOp::Translate(by))), None) = (to_blame.next(), to_blame.next()) {
        let words = format!(
            "the object's transforms move it from {from} to {to}; without the translation by {}, it would be at {}, in \
             the picture",
            vector(*by),
            vector(without(i)[0])
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

/// Fraction of an object's size below which a scaled translation hardly moves the object, and above
/// which the translation is meant to move it.
const NEGLIGIBLE: f32 = 0.05;
const NOTABLE: f32 = 0.3;
/// Factor by which a scale must change a translation to be reported.
const MIN_FACTOR: f32 = 4.0;

/// Reports scales before a translation that make it tiny or huge.
pub(super) fn scaled_move(scene_probe: &SceneProbe) -> Vec<Finding> {
    let world = scene_probe.world();
    let mut findings = Vec::new();
    for object in scene_probe.input.scene.objects() {
        let ObjectKind::Transform(ops, inner) = &object.node else { continue };
        let found = world.objects().iter().enumerate().find(|(_, own)| is_same_span(own.span, inner.span));
        let Some((index, own)) = found else { continue };
        let Some((scale, by, scaled)) = scale_before_move(ops) else { continue };
        let Some(bounds) = own.bounds().filter(|bounds| !bounds.is_empty()) else { continue };
        let size = bounds.size().max_element();
        let factor = scaled.length() / by.length();
        let shrinks = factor < 1.0 / MIN_FACTOR;
        let whole: f32 = ops.iter().filter_map(scale_of).map(|scale| (scale * by).length() / by.length()).product();
        // A later scale that undoes the first one shows that the size is intended, and so does a
        // scale that makes the object flat.
        let is_undone = (0.1..10.0).contains(&whole) || scale.max_element() > MIN_FACTOR * scale.min_element();
        let hardly = is_undone && shrinks && scaled.length() < NEGLIGIBLE * size && by.length() > NOTABLE * size;
        let meant = bounds.center() + by - scaled;
        let is_lost = match scene_probe.visibilities()[index] {
            Visibility::Outside => factor > MIN_FACTOR,
            Visibility::Hidden(_) => shrinks && by.length() > NOTABLE * size,
            _ => false,
        };
        let lost = is_lost && super::visibility::is_in_view(scene_probe, meant);
        // A translation before a scale often moves the middle or a side of an object to the origin.
        let is_centering = own.to_world.as_ref().is_some_and(|to_world| {
            let local = Aabb::around(bounds.corners().map(|corner| to_world.inverse_point(corner) + own.center + by));
            let near = 0.1 * local.size().max(0.1 * by.abs());
            let is_zero = |place: Vec3| place.abs().cmple(near) | by.abs().cmplt(Vec3::splat(0.1 * by.length()));
            shrinks && (is_zero(local.center()) | is_zero(local.min) | is_zero(local.max)).all()
        });
        if !hardly && !lost || is_centering || findings.len() == MAX_FINDINGS {
            continue;
        }
        let is_uniform = scale.max_element() - scale.min_element() < 1e-3 * scale.max_element();
        let message = format!(
            "the scale by {} before the translation by {} also scales it: the object moves by {}",
            if is_uniform { number(scale.x) } else { vector(scale) },
            vector(by),
            vector(scaled)
        );
        let keyword = |classic, nodes| scene_probe.keyword_of_grammar(classic, nodes);
        let help = format!(
            "write the `{}` before the `{}`: the transform written last is applied first",
            keyword("Translate", "translate"),
            keyword("Scale", "scale")
        );
        let diagnostic = Diagnostic::warning(message)
            .at(object.span)
            .effect(match lost {
                true if shrinks => "the object is hidden by another object",
                true => "the object is outside the picture",
                false => "the object is hardly moved",
            })
            .help(help);
        findings.push(Finding::from(diagnostic));
    }
    findings
}

/// Returns the factors of an operation that scales.
fn scale_of(op: &MatrixOp) -> Option<Vec3> {
    match *op {
        MatrixOp::UniformScale(s) => Some(Vec3::splat(s.abs())),
        MatrixOp::Scale(v) => Some(v.abs()),
        _ => None,
    }
}

/// Returns the last scale before the first translation of a transform, the translation, and the
/// translation scaled by all scales before it.
fn scale_before_move(ops: &[MatrixOp]) -> Option<(Vec3, Vec3, Vec3)> {
    let at = ops.iter().position(|op| matches!(op, MatrixOp::Translate(_)))?;
    let MatrixOp::Translate(by) = ops[at] else { return None };
    let scales: Vec<Vec3> = ops[..at].iter().filter_map(scale_of).collect();
    let scaled = scales.iter().fold(by, |scaled, scale| scaled * *scale);
    let is_far = !(1.0 / MIN_FACTOR..=MIN_FACTOR).contains(&(scaled.length() / by.length()));
    scales.last().filter(|_| is_far && by != Vec3::ZERO).map(|scale| (*scale, by, scaled))
}

/// Component of an axis above which it is probably an angle in degrees.
const MIN_DEGREES: f32 = 5.0;

/// Reports rotations whose four numbers are probably the angle and then the axis.
pub(super) fn angle_first(scene_probe: &SceneProbe) -> Vec<Finding> {
    let mut findings = Vec::new();
    for object in scene_probe.input.scene.objects() {
        let ObjectKind::Transform(ops, _) = &object.node else { continue };
        for op in ops {
            let MatrixOp::Rotate(axis, angle) = *op else { continue };
            let rest = Vec3::new(axis.y, axis.z, angle);
            let is_axis = rest.abs().max_element() <= 1.0 && (rest.length() - 1.0).abs() < 0.02;
            if axis.x.abs() < MIN_DEGREES || !is_axis || findings.len() == MAX_FINDINGS {
                continue;
            }
            let message = format!("this rotation turns by {} degrees about the axis {}", number(angle), vector(axis));
            let right = format!("{} {}", vector(rest), number(axis.x));
            let effect = if angle == 0.0 { "the object is not rotated" } else { "the object is hardly rotated" };
            let diagnostic = Diagnostic::warning(message)
                .effect(effect)
                .help(format!("the axis comes first, and then the angle: write `Rotate {{ {right} }}`"));
            findings.push(Finding::from(match rotation_values(scene_probe, object.span) {
                Some(place) => diagnostic.at(place).fix(place, right),
                None => diagnostic.at(object.span),
            }));
        }
    }
    findings
}

/// Returns the span of the four numbers of the first rotation in a transform.
fn rotation_values(scene_probe: &SceneProbe, transform: Span) -> Option<Span> {
    let bytes = scene_probe.input.files.bytes(transform.file)?;
    let rest = bytes.get(transform.end as usize..)?;
    let word = rest.windows(6).position(|word| word.eq_ignore_ascii_case(b"rotate"))?;
    let open = word + rest[word..].iter().position(|byte| *byte == b'{')? + 1;
    let close = open + rest[open..].iter().position(|byte| *byte == b'}')?;
    let (text, file) = (&rest[open..close], transform.file);
    let before = text.iter().take_while(|byte| byte.is_ascii_whitespace()).count();
    let start = transform.end as usize + open + before;
    let length = text.trim_ascii().len();
    (text.trim_ascii().split(u8::is_ascii_whitespace).filter(|part| !part.is_empty()).count() == 4).then_some(Span {
        file,
        start: start as u32,
        end: (start + length) as u32,
    })
}
