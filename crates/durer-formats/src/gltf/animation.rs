//! Evaluates animations, which give transforms of nodes and weights of morph targets at a given
//! time.
//!
//! Source: *glTF 2.0 Specification*, chapter 3.11 and appendix C.

use super::Model;
use super::json::JsonRef;
use super::nodes::NodeData;
use crate::named_choice::choose;
use crate::report::count_text;
use durer_scene::math::fp;
use glam::{DQuat, DVec3, DVec4};
use serde_json::Value;

/// Interpolation between the key frames of a glTF animation.
#[derive(Clone, Copy, PartialEq)]
enum Interpolation {
    Step,
    Linear,
    Cubic,
}

/// Key frames of a glTF animation sampler, with their times, their values and the interpolation.
struct Sampler {
    times: Vec<f32>,
    /// Values of all key frames in order. For cubic splines, each key frame has an in-tangent, a
    /// value and an out-tangent.
    values: Vec<f32>,
    interpolation: Interpolation,
}

impl Model<'_> {
    /// Returns the names of the animations and their lengths in seconds.
    pub(super) fn animations(&self, root: &JsonRef) -> Vec<(String, f32)> {
        let end_of = |sampler: &Value| {
            let input = usize::try_from(sampler.get("input")?.as_u64()?).ok()?;
            root.value.get("accessors")?.get(input)?.get("max")?.get(0)?.as_f64()
        };
        let summary = |animation: &Value| {
            let name = animation.get("name").and_then(Value::as_str).unwrap_or_default().to_string();
            let samplers = animation.get("samplers").and_then(Value::as_array);
            (name, samplers.into_iter().flatten().filter_map(end_of).fold(0.0, f64::max) as f32)
        };
        root.value.get("animations").and_then(Value::as_array).into_iter().flatten().map(summary).collect()
    }

    /// Sets the transforms and weights of the nodes to the values that the requested animation, or
    /// otherwise the first, has at the requested time.
    pub(super) fn animate(&self, root: &JsonRef, nodes: &mut [NodeData], all: &[(String, f32)]) {
        let defaults = self.input.scene_defaults;
        let wanted = defaults.animation.as_deref();
        let (at, animations) = match (defaults.animation_time.or(wanted.map(|_| 0.0)), root.get("animations")) {
            (Some(at), Some(animations)) => (at, animations),
            (Some(_), None) => {
                let option = if wanted.is_some() { "--animation" } else { "--at" };
                let message = format!("`{option}` has no effect, because the file has no animation");
                return root.warning("no-animation", message);
            }
            (None, Some(animations)) => return at_rest(&animations),
            (None, None) => return,
        };
        let names: Vec<Vec<&str>> = all.iter().map(|(name, _)| vec![&**name]).collect();
        let chosen = choose("animation", &names, wanted).map_err(|message| root.error("no-animation", message));
        let Ok(Some(index)) = chosen else { return };
        let Some(animation) = animations.items().nth(index) else { return };
        let end = all[index].1;
        if at > end && end > 0.0 {
            animation.note(
                "animations",
                format!("the animation{} ends after {end} s: its last moment is shown", animation.name()),
            );
        }
        let (Some(channels), Some(samplers)) = (animation.required("channels"), animation.required("samplers")) else {
            return;
        };
        let samplers: Vec<Option<Sampler>> = samplers.items().map(|sampler| self.track(&sampler)).collect();
        for channel in channels.items() {
            self.channel(&channel, &samplers, at, nodes);
        }
    }

    fn channel(&self, channel: &JsonRef, samplers: &[Option<Sampler>], at: f32, nodes: &mut [NodeData]) -> Option<()> {
        let track = samplers[channel.required("sampler")?.index(samplers.len())?].as_ref()?;
        let target = channel.required("target")?;
        let node = &mut nodes[target.get("node")?.index(nodes.len())?];
        let path = target.required("path")?;
        match path.string()? {
            "translation" => node.local.translation = track.vector(at)?,
            "scale" => node.local.scale = track.vector(at)?,
            "rotation" => node.local.rotation = track.rotation(at)?,
            "weights" => node.weights = track.row(at, track.width()?)?,
            other => path.warning("ANIMATION_CHANNEL_TARGET_PATH", format!("animation of `{other}` is not supported")),
        }
        Some(())
    }

    fn track(&self, at: &JsonRef) -> Option<Sampler> {
        let words =
            [("STEP", Interpolation::Step), ("LINEAR", Interpolation::Linear), ("CUBICSPLINE", Interpolation::Cubic)];
        let interpolation = at.get("interpolation").map_or(Some(Interpolation::Linear), |word| word.word(&words))?;
        let (input, output) = (at.required("input")?, at.required("output")?);
        let times = self.rows::<1>(self.accessor(&input)?, &input)?.into_iter().map(|[t]| t).collect::<Vec<_>>();
        if !times.is_sorted() {
            input.error("ACCESSOR_ANIMATION_INPUT_NON_INCREASING", "the times of key frames must increase");
            return None;
        }
        let accessor = self.accessor(&output)?;
        let rows = self.rows::<4>(accessor, &output)?;
        let values = rows.iter().flat_map(|row| row[..accessor.width.min(4)].iter().copied()).collect();
        Some(Sampler { times, values, interpolation })
    }
}

impl Sampler {
    /// Returns the number of components for each key frame.
    fn width(&self) -> Option<usize> {
        let rows = self.times.len() * if self.interpolation == Interpolation::Cubic { 3 } else { 1 };
        self.values.len().checked_div(rows).filter(|&width| width > 0)
    }

    fn vector(&self, at: f32) -> Option<DVec3> {
        let row = self.row(at, 3)?;
        Some(DVec3::new(row[0].into(), row[1].into(), row[2].into()))
    }

    fn rotation(&self, at: f32) -> Option<DQuat> {
        let (i, share, _) = self.keyframes_around(at);
        let row = match self.interpolation {
            Interpolation::Linear if share > 0.0 => slerp(self.key(i, 4)?, self.key(i + 1, 4)?, share),
            _ => self.row(at, 4)?,
        };
        let q = DQuat::from_array([row[0].into(), row[1].into(), row[2].into(), row[3].into()]);
        (q.length() > 1e-6).then(|| q.normalize())
    }

    /// Returns the last key frame before a time, the relative position of the time in the interval
    /// to the next key frame (0 to 1), and the length of the interval in seconds.
    fn keyframes_around(&self, at: f32) -> (usize, f32, f32) {
        let next = self.times.partition_point(|&time| time <= at);
        match (next.checked_sub(1), self.times.get(next)) {
            (Some(i), Some(&end)) => {
                let length = end - self.times[i];
                (i, (at - self.times[i]) / length, length)
            }
            // Clamp times that are before the first key frame or after the last one.
            (Some(i), None) => (i, 0.0, 0.0),
            (None, _) => (0, 0.0, 0.0),
        }
    }

    fn key(&self, i: usize, width: usize) -> Option<&[f32]> {
        let (stride, skip) = if self.interpolation == Interpolation::Cubic { (3 * width, width) } else { (width, 0) };
        self.values.get(i * stride + skip..i * stride + skip + width)
    }

    fn row(&self, at: f32, width: usize) -> Option<Vec<f32>> {
        let (i, t, length) = self.keyframes_around(at);
        let first = self.key(i, width)?;
        if t == 0.0 || self.interpolation == Interpolation::Step {
            return Some(first.to_vec());
        }
        let second = self.key(i + 1, width)?;
        if self.interpolation == Interpolation::Linear {
            return Some(first.iter().zip(second).map(|(a, b)| a + t * (b - a)).collect());
        }
        // Cubic Hermite spline that uses the out-tangent of the first key frame and the in-tangent
        // of the second one.
        let out = self.values.get((3 * i + 2) * width..(3 * i + 3) * width)?;
        let into = self.values.get(3 * (i + 1) * width..(3 * (i + 1) + 1) * width)?;
        let (t2, t3) = (t * t, t * t * t);
        let mix = |k: usize| {
            (2.0 * t3 - 3.0 * t2 + 1.0) * first[k]
                + length * (t3 - 2.0 * t2 + t) * out[k]
                + (3.0 * t2 - 2.0 * t3) * second[k]
                + length * (t3 - t2) * into[k]
        };
        Some((0..width).map(mix).collect())
    }
}

/// Adds a note that the file has animations and that they are not applied.
fn at_rest(animations: &JsonRef) {
    let mut all = animations.items();
    let count = all.len();
    let name = all.next().map_or(String::new(), |first| first.name());
    let moment = match (count, name.is_empty()) {
        (0 | 1, _) => "the first moment of the animation".into(),
        (_, true) => "the first moment of the first animation".into(),
        (_, false) => format!("the first moment of the first animation,{name}, and `--animation NAME` to show another"),
    };
    let count = count_text(count, "animation", "animations");
    animations.note("animations", format!("the file has {count} and is shown at rest; use `--at 0` to show {moment}"));
}

/// Interpolates between two quaternions along the shorter arc (slerp).
fn slerp(a: &[f32], b: &[f32], t: f32) -> Vec<f32> {
    let four = |q: &[f32]| DVec4::new(q[0].into(), q[1].into(), q[2].into(), q[3].into()).normalize_or(DVec4::W);
    let (a, b) = (four(a), four(b));
    let b = if a.dot(b) < 0.0 { -b } else { b };
    let angle = 2.0 * fp::atan2_f64((a - b).length(), (a + b).length());
    let t = f64::from(t);
    let sine = |x: f64| fp::sin_cos_f64(x).0;
    let mixed = match angle > 1e-6 {
        true => (sine((1.0 - t) * angle) * a + sine(t * angle) * b) / sine(angle),
        false => a.lerp(b, t),
    };
    mixed.as_vec4().to_array().to_vec()
}
