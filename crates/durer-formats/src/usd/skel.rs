//! Skeletons: meshes whose points follow joints.
//!
//! Source: *OpenUSD documentation*, UsdSkel. A point is the weighted sum over its joints of
//! (joint in the pose) · (joint at binding)⁻¹ · (mesh at binding) · point, in the space of the
//! skeleton. Dual quaternions and blend shapes have no counterpart.

use super::layer::Value;
use super::reader::Inherited;
use super::stage::{Prim, Stage};
use super::transform::local_transform;
use durer_scene::math::Vec3;
use glam::{DAffine3, DMat3, DMat4, DQuat, DVec3};

/// Pose of the skeleton that moves a mesh.
pub(super) struct Pose {
    /// Maps a point of the mesh at rest to the mesh in the pose, for each joint of the mesh.
    joints: Vec<DAffine3>,
    /// Joints and weights of the points, `width` for each; a rigid mesh has them only once.
    indices: Vec<f64>,
    weights: Vec<f64>,
    width: usize,
    is_rigid: bool,
    /// Key that is equal for equal poses.
    pub key: String,
}

/// Returns the path of the skeleton and of the animation that a prim binds itself or inherits.
pub(super) fn binding(prim: &Prim, inherited: &Inherited) -> [Option<String>; 2] {
    let own = |name: &str| prim.targets(name).into_iter().next();
    let [skeleton, animation] = &inherited.skeleton;
    [own("skel:skeleton").or_else(|| skeleton.clone()), own("skel:animationSource").or_else(|| animation.clone())]
}

impl Pose {
    /// Returns the pose of a mesh, or `None` if no skeleton moves it.
    pub fn of(stage: &Stage, prim: &Prim, inherited: &Inherited) -> Option<Pose> {
        let [skeleton, animation] = &inherited.skeleton;
        let skeleton = stage.prim(skeleton.as_deref()?).filter(|skeleton| skeleton.type_name() == "Skeleton")?;
        let get = |name: &str| prim.get(stage, name);
        let indices = get("primvars:skel:jointIndices")?;
        let weights = get("primvars:skel:jointWeights")?;
        let width = indices.metadata.get("elementSize").and_then(Value::number).unwrap_or(1.0).max(1.0) as usize;
        let is_rigid = indices.metadata.get("interpolation").and_then(Value::text) == Some("constant");
        let names = skeleton.texts(stage, "joints");
        let bind = matrices(&skeleton, stage, "bindTransforms");
        let rest = matrices(&skeleton, stage, "restTransforms");
        if names.is_empty() || bind.len() != names.len() {
            return None;
        }
        let animation = skeleton.targets("skel:animationSource").into_iter().next().or_else(|| animation.clone());
        let animation = animation.and_then(|path| stage.prim(&path));
        let moved = animation.as_ref().map_or(Vec::new(), |animation| animated(animation, stage));
        let mut in_pose: Vec<DAffine3> = Vec::with_capacity(names.len());
        for (i, name) in names.iter().enumerate() {
            let local = moved.iter().find(|(joint, _)| joint == name).map(|(_, map)| *map);
            let local = local.or_else(|| rest.get(i).copied()).unwrap_or(DAffine3::IDENTITY);
            // A parent precedes its children.
            let mut parent = name.as_str();
            let above = loop {
                let Some((before, _)) = parent.rsplit_once('/') else { break None };
                parent = before;
                if let Some(found) = names[..i].iter().position(|name| name == parent) {
                    break Some(found);
                }
            };
            in_pose.push(above.map_or(DAffine3::IDENTITY, |above| in_pose[above]) * local);
        }
        let at_binding = get("primvars:skel:geomBindTransform").and_then(|map| matrix(map.value.numbers()));
        let at_binding = at_binding.unwrap_or(DAffine3::IDENTITY);
        let to_mesh = path_transform(stage, &prim.path).inverse() * path_transform(stage, &skeleton.path);
        let map = |joint: usize| to_mesh * in_pose[joint] * bind[joint].inverse() * at_binding;
        // A mesh can name its own joints.
        let own = prim.texts(stage, "skel:joints");
        let joints: Vec<DAffine3> = match own.is_empty() {
            true => (0..names.len()).map(map).collect(),
            false => own
                .iter()
                .map(|name| names.iter().position(|known| known == name).map_or(DAffine3::IDENTITY, map))
                .collect(),
        };
        let animation = animation.map_or(String::new(), |animation| animation.key());
        Some(Pose {
            joints,
            indices: indices.value.numbers().to_vec(),
            weights: weights.value.numbers().to_vec(),
            width,
            is_rigid,
            key: format!("{} {animation}", skeleton.key()),
        })
    }

    /// Returns the weighted map of a point.
    fn map(&self, point: usize) -> Option<DAffine3> {
        let first = if self.is_rigid { 0 } else { point * self.width };
        let range = first..first + self.width;
        let (indices, weights) = (self.indices.get(range.clone())?, self.weights.get(range)?);
        let (mut sum, mut total) = (DAffine3 { matrix3: DMat3::ZERO, translation: DVec3::ZERO }, 0.0);
        for (index, weight) in indices.iter().zip(weights).filter(|(_, weight)| **weight > 0.0) {
            let joint = self.joints.get(*index as usize).filter(|_| *index >= 0.0)?;
            sum.matrix3 += *weight * joint.matrix3;
            sum.translation += *weight * joint.translation;
            total += weight;
        }
        let scale = 1.0 / total;
        (total > 0.0).then(|| DAffine3 { matrix3: scale * sum.matrix3, translation: scale * sum.translation })
    }

    /// Moves the points of a mesh. Points without valid weights stay where they are.
    pub fn move_points(&self, points: &mut [Vec3]) {
        for (i, point) in points.iter_mut().enumerate() {
            if let Some(map) = self.map(i) {
                *point = map.transform_point3(point.as_dvec3()).as_vec3();
            }
        }
    }

    /// Turns a normal at a point.
    pub fn turned(&self, point: usize, normal: Vec3) -> Vec3 {
        let Some(map) = self.map(point).filter(|map| map.matrix3.determinant() != 0.0) else { return normal };
        (map.matrix3.inverse().transpose() * normal.as_dvec3()).normalize_or(normal.as_dvec3()).as_vec3()
    }
}

/// Returns the transforms of the joints of an animation, relative to their parents.
fn animated(animation: &Prim, stage: &Stage) -> Vec<(String, DAffine3)> {
    let numbers = |name: &str| animation.numbers(stage, name);
    let (moves, turns, scales) = (numbers("translations"), numbers("rotations"), numbers("scales"));
    let joint = |(i, name): (usize, String)| {
        let triple = |list: &[f64]| list.as_chunks::<3>().0.get(i).copied().map(DVec3::from_array);
        let [w, x, y, z] = turns.as_chunks::<4>().0.get(i).copied().unwrap_or([1.0, 0.0, 0.0, 0.0]);
        let turn = DQuat::from_xyzw(x, y, z, w);
        let turn = if turn.length() > 1e-9 { turn.normalize() } else { DQuat::IDENTITY };
        let (scale, place) = (triple(&scales).unwrap_or(DVec3::ONE), triple(&moves).unwrap_or(DVec3::ZERO));
        (name, DAffine3::from_scale_rotation_translation(scale, turn, place))
    };
    animation.texts(stage, "joints").into_iter().enumerate().map(joint).collect()
}

fn matrix(numbers: &[f64]) -> Option<DAffine3> {
    Some(DAffine3::from_mat4(DMat4::from_cols_array(numbers.first_chunk::<16>()?)))
}

fn matrices(prim: &Prim, stage: &Stage, name: &str) -> Vec<DAffine3> {
    prim.numbers(stage, name).as_chunks::<16>().0.iter().filter_map(|numbers| matrix(numbers)).collect()
}

/// Returns the transform of a prim to world space, without instancers.
fn path_transform(stage: &Stage, path: &str) -> DAffine3 {
    let (mut prim, mut map) = (stage.root(), DAffine3::IDENTITY);
    for name in path.split('/').filter(|name| !name.is_empty()) {
        let Some(child) = stage.child(&prim, name) else { return map };
        let (local, resets) = local_transform(stage, &child);
        map = if resets { local } else { map * local };
        prim = child;
    }
    map
}
