//! Standard views of `rad`, which have names such as `XYZ` and `yl` and show a box from its sides
//! and corners.
//!
//! Source: the manual page of rad, and the output of `rad -n`.

use super::state::Reader;
use super::view::View;
use super::words::Word;
use durer_diag::Span;
use durer_scene::scene::ObjectKind;
use durer_scene::shape::Shape;
use glam::DVec3;

/// `ZONE` and `UP` settings of a `rad` input file, which are the box that standard views show and
/// the up axis.
pub(super) struct ViewBox {
    min: DVec3,
    size: DVec3,
    /// True if the cameras are inside the box.
    interior: bool,
    /// Index of the up axis, and its sign.
    up: (usize, f64),
}

/// Names of the axes.
const AXES: [char; 3] = ['X', 'Y', 'Z'];

/// Returns the direction from the centre of the box to the camera, and the view type, for the name
/// of a standard view.
pub(super) fn standard(name: &str) -> Option<(DVec3, char)> {
    let (mut rest, mut direction) = (name, DVec3::ZERO);
    for (axis, letter) in AXES.into_iter().enumerate() {
        for (letter, side) in [(letter, 1.0), (letter.to_ascii_lowercase(), -1.0)] {
            if let (true, Some(more)) = (direction[axis] == 0.0, rest.strip_prefix(letter)) {
                (rest, direction[axis]) = (more, side);
            }
        }
    }
    let kind = match rest {
        "" => 'v',
        "v" | "l" | "a" | "h" | "s" | "c" => rest.chars().next()?,
        _ => return None,
    };
    (direction != DVec3::ZERO).then_some((direction, kind))
}

impl ViewBox {
    /// Reads the values of `ZONE` and `UP`. By default, the box is the bounding cube of all
    /// surfaces, the cameras are outside it, and the up axis is z.
    pub fn of(zone: Option<&[Word]>, up: Option<&[Word]>, reader: &Reader) -> ViewBox {
        let up = up.and_then(|words| words.first()).map_or("", |word| word.text.as_str());
        let letter = up.trim_start_matches(['+', '-']).chars().next().map(|letter| letter.to_ascii_uppercase());
        let axis = AXES.iter().position(|axis| Some(*axis) == letter).unwrap_or(2);
        let up = (axis, if up.starts_with('-') { -1.0 } else { 1.0 });
        let interior = zone.and_then(|words| words.first()).is_some_and(|word| word.text.starts_with(['I', 'i']));
        let sides: Option<Vec<f64>> =
            zone.and_then(|words| words.get(1..7)?.iter().map(|word| word.text.parse().ok()).collect());
        let [min, max] = match sides {
            Some(v) => [DVec3::new(v[0], v[2], v[4]), DVec3::new(v[1], v[3], v[5])],
            None => reader.cube(),
        };
        ViewBox { min, size: max - min, interior, up }
    }

    /// Returns a standard view of the box for a result of [`standard`].
    pub fn view(&self, (direction, kind): (DVec3, char), at: Span) -> View {
        let middle = self.min + 0.5 * self.size;
        let point = middle + if self.interior { 0.45 } else { 2.0 } * direction * self.size;
        let (axis, side) = self.up;
        // Use the previous axis if the view direction is parallel to the up axis.
        let up = match (0..3).map(|i| (axis + 3 - i) % 3).find(|up| (0..3).any(|i| i != *up && direction[i] != 0.0)) {
            Some(up) if up == axis => side * DVec3::AXES[up],
            Some(up) => DVec3::AXES[up],
            None => DVec3::Z,
        };
        let size = match kind {
            'v' => [45.0; 2],
            'l' => [self.size.length(); 2],
            'c' => [180.0, 90.0],
            _ => [180.0; 2],
        };
        let mut view = View::new(at);
        (view.kind, view.point, view.direction, view.up) = (kind, point, -direction * self.size, up);
        view.size = size;
        view
    }
}

impl Reader<'_> {
    /// Returns the bounding cube of all surfaces that have been read so far.
    fn cube(&self) -> [DVec3; 2] {
        let objects = self.scene.root.iter().flat_map(|root| &root.objects);
        let shapes = objects.filter_map(|object| match &object.node {
            ObjectKind::Primitive(shape) => shape.bounds().map(|bounds| [bounds.min, bounds.max]),
            _ => None,
        });
        let all = shapes.chain(self.bodies.values().map(|body| body.bounds()));
        let Some([min, max]) = all.reduce(|a, b| [a[0].min(b[0]), a[1].max(b[1])]) else {
            return [DVec3::NEG_ONE, DVec3::ONE];
        };
        let (middle, half) = (0.5 * (min + max), 0.5 * (max - min).max_element());
        [middle - half, middle + half].map(|corner| corner.as_dvec3())
    }
}
