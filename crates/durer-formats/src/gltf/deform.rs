//! Deforms vertices with morph targets and skins.
//!
//! Source: *glTF 2.0 Specification*, chapters 3.7.2.2 and 3.7.3.

use super::Model;
use super::accessor::ComponentType;
use super::json::JsonRef;
use durer_scene::math::Vec3;
use durer_scene::shape::MeshData;
use glam::{DAffine3, DMat3, DMat4, DVec3};

/// Data that deforms the vertices of a glTF primitive: its morph targets, and the joints and
/// weights for each vertex.
#[derive(Clone, Default)]
pub(super) struct Deformation {
    targets: Vec<MorphTarget>,
    joints: Vec<[u32; 4]>,
    weights: Vec<[f32; 4]>,
}

/// Offsets that a morph target adds to positions and to normals. A list is empty if the target does
/// not change these values.
#[derive(Clone, Default)]
struct MorphTarget {
    positions: Vec<Vec3>,
    normals: Vec<Vec3>,
}

/// Skin of a glTF file, which consists of the nodes that are its joints and of their inverse bind
/// matrices.
#[derive(Clone)]
pub(super) struct Skin {
    joints: Vec<usize>,
    /// Transforms from mesh space to the space of each joint.
    inverse: Vec<DAffine3>,
}

impl Skin {
    /// Returns the transform from mesh space to world space for each joint of a skin.
    pub fn bones(&self, maps: &[DAffine3]) -> Vec<DAffine3> {
        self.joints.iter().zip(&self.inverse).map(|(&joint, inverse)| maps[joint] * *inverse).collect()
    }
}

impl Model<'_> {
    /// Reads all skins, and returns `None` in place of each invalid one.
    pub(super) fn read_skins(&self, root: &JsonRef) -> Vec<Option<Skin>> {
        let nodes = root.get("nodes").and_then(|nodes| nodes.value.as_array()).map_or(0, Vec::len);
        root.list("skins", |skin| self.skin(skin, nodes))
    }

    fn skin(&self, at: &JsonRef, nodes: usize) -> Option<Skin> {
        at.object()?;
        let joints = at.required("joints")?;
        let joints: Vec<usize> = joints.items().map(|joint| joint.index(nodes)).collect::<Option<_>>()?;
        if let Some(skeleton) = at.get("skeleton") {
            skeleton.index(nodes);
        }
        let Some(matrices) = at.get("inverseBindMatrices") else {
            return Some(Skin { inverse: vec![DAffine3::IDENTITY; joints.len()], joints });
        };
        let accessor = self.accessor(&matrices)?;
        if accessor.width != 16 || accessor.component != ComponentType::F32 {
            matrices.error("SKIN_IBM_INVALID_FORMAT", "inverse bind matrices must have type MAT4 and single precision");
            return None;
        }
        if accessor.count < joints.len() {
            let message =
                format!("there are only {} inverse bind matrices for {} joints", accessor.count, joints.len());
            matrices.error("INVALID_IBM_ACCESSOR_COUNT", message);
            return None;
        }
        let rows = self.rows::<16>(accessor, &matrices)?;
        if rows.iter().any(|m| [m[3], m[7], m[11], m[15]] != [0.0, 0.0, 0.0, 1.0]) {
            matrices.error("ACCESSOR_INVALID_IBM", "the last row of an inverse bind matrix must be 0 0 0 1");
            return None;
        }
        let map = |m: [f32; 16]| DAffine3::from_mat4(DMat4::from_cols_array(&m.map(f64::from)));
        Some(Skin { joints, inverse: rows.into_iter().map(map).collect() })
    }

    /// Reads the morph targets and joints of a primitive, if there are any.
    pub(super) fn pose(&self, primitive: &JsonRef, attributes: &JsonRef, count: usize) -> Option<Deformation> {
        let targets = primitive.list("targets", |target| self.target(target, count));
        let joints = attributes.get("JOINTS_0");
        let weights = attributes.get("WEIGHTS_0");
        if joints.is_some() != weights.is_some() {
            attributes.error("MESH_PRIMITIVE_JOINTS_WEIGHTS_MISMATCH", "JOINTS_0 and WEIGHTS_0 must occur together");
        }
        let mut pose = Deformation { targets, ..Deformation::default() };
        if let (Some(joints), Some(weights)) = (joints, weights) {
            let numbers = self.accessor(&joints)?;
            if numbers.width != 4
                || !matches!(numbers.component, ComponentType::U8 | ComponentType::U16)
                || numbers.normalized
            {
                let message = "JOINTS_0 must have four unsigned integers of 8 or 16 bits";
                joints.error("MESH_PRIMITIVE_ATTRIBUTES_ACCESSOR_INVALID_FORMAT", message);
                return None;
            }
            let rows = self.rows::<4>(numbers, &joints)?;
            pose.joints = rows.into_iter().map(|row| row.map(|joint| joint as u32)).collect();
            pose.weights = self.rows::<4>(self.accessor(&weights)?, &weights)?;
        }
        let right = |rows: usize| rows == 0 || rows == count;
        let sizes = right(pose.joints.len()) && right(pose.weights.len());
        (sizes && !(pose.targets.is_empty() && pose.joints.is_empty())).then_some(pose)
    }

    fn target(&self, at: &JsonRef, count: usize) -> MorphTarget {
        at.object();
        let rows = |key| {
            let Some(attribute) = at.get(key) else { return Vec::new() };
            let Some(accessor) = self.accessor(&attribute) else { return Vec::new() };
            if accessor.count != count || accessor.width != 3 {
                let message = format!("a morph target must have {count} rows of 3 numbers, as the primitive has");
                attribute.error("MESH_PRIMITIVE_MORPH_TARGET_INVALID_ATTRIBUTE_COUNT", message);
                return Vec::new();
            }
            if key == "POSITION" && !accessor.has_bounds {
                let message = "the accessor of POSITION must have `min` and `max`";
                attribute.error("MESH_PRIMITIVE_POSITION_ACCESSOR_WITHOUT_BOUNDS", message);
            }
            let rows = self.rows(accessor, &attribute).unwrap_or_default();
            rows.into_iter().map(Vec3::from_array).collect()
        };
        MorphTarget { positions: rows("POSITION"), normals: rows("NORMAL") }
    }
}

impl Deformation {
    /// Returns true if morph target weights or joints move any vertices.
    pub fn moves(&self, weights: &[f32], skinned: bool) -> bool {
        skinned && !self.joints.is_empty() || weights.iter().zip(&self.targets).any(|(weight, _)| *weight != 0.0)
    }

    /// Duplicates the deformation data for new vertices that are copies of the vertices in
    /// `originals`.
    pub fn copy(&mut self, originals: &[u32]) {
        copy(&mut self.joints, originals);
        copy(&mut self.weights, originals);
        for target in &mut self.targets {
            copy(&mut target.positions, originals);
            copy(&mut target.normals, originals);
        }
    }

    /// Deforms the vertices of a mesh, which must be those of the primitive.
    pub fn apply(&self, data: &mut MeshData, weights: &[f32], bones: Option<&[DAffine3]>) {
        for (target, &weight) in self.targets.iter().zip(weights) {
            let add = |values: &mut [Vec3], moves: &[Vec3]| {
                values.iter_mut().zip(moves).for_each(|(value, by)| *value += weight * by);
            };
            add(&mut data.positions, &target.positions);
            add(&mut data.normals, &target.normals);
        }
        if let Some(bones) = bones.filter(|_| !self.joints.is_empty()) {
            for i in 0..data.positions.len() {
                let map = self.bone(i, bones);
                data.positions[i] = map.transform_point3(data.positions[i].as_dvec3()).as_vec3();
                let turn = |matrix: DMat3, v: Vec3| (matrix * v.as_dvec3()).normalize_or(v.as_dvec3()).as_vec3();
                if let Some(normal) = data.normals.get_mut(i) {
                    *normal = turn(normal_matrix(map.matrix3), *normal);
                }
                if let Some([x, y, z, _]) = data.tangents.get_mut(i) {
                    [*x, *y, *z] = turn(map.matrix3, Vec3::new(*x, *y, *z)).to_array();
                }
            }
        }
        // The joint transforms in a file can cause an overflow.
        data.positions.iter_mut().filter(|p| !p.is_finite()).for_each(|p| *p = Vec3::ZERO);
    }

    /// Returns the weighted mean of the joint transforms that affect a vertex.
    fn bone(&self, vertex: usize, bones: &[DAffine3]) -> DAffine3 {
        let (joints, weights) = (self.joints[vertex], self.weights[vertex]);
        let total: f64 = weights.iter().map(|&w| f64::from(w)).sum();
        if total <= 0.0 {
            return bones.get(joints[0] as usize).copied().unwrap_or(DAffine3::IDENTITY);
        }
        let mut mean = [DVec3::ZERO; 4];
        for (joint, weight) in joints.into_iter().zip(weights) {
            let bone = bones.get(joint as usize).copied().unwrap_or(DAffine3::IDENTITY);
            let weight = f64::from(weight) / total;
            let columns = [bone.matrix3.x_axis, bone.matrix3.y_axis, bone.matrix3.z_axis, bone.translation];
            mean.iter_mut().zip(columns).for_each(|(sum, column)| *sum += weight * column);
        }
        DAffine3::from_cols(mean[0], mean[1], mean[2], mean[3])
    }
}

/// Returns the matrix that transforms normals, which is the transposed inverse times a positive
/// factor. The matrix also exists for singular transforms.
pub(super) fn normal_matrix(map: DMat3) -> DMat3 {
    let [x, y, z] = [map.x_axis, map.y_axis, map.z_axis];
    1f64.copysign(map.determinant()) * DMat3::from_cols(y.cross(z), z.cross(x), x.cross(y))
}

/// Appends copies of the values at the indices `originals`, unless the list is empty.
pub(super) fn copy<T: Copy>(values: &mut Vec<T>, originals: &[u32]) {
    if !values.is_empty() {
        values.extend(originals.iter().map(|&i| values[i as usize]).collect::<Vec<_>>());
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn skinned_normals_stay_perpendicular() {
        let pose = Deformation { joints: vec![[0; 4]], weights: vec![[1.0, 0.0, 0.0, 0.0]], ..Deformation::default() };
        let (n, u) = (Vec3::new(0.48, 0.6, 0.64), Vec3::new(0.8, 0.0, -0.6));
        let v = n.cross(u);
        let tall = DMat3::from_diagonal(DVec3::new(1.0, 1.0, 3.0));
        let sheared = DMat3::from_cols(DVec3::X, DVec3::new(0.7, 1.0, 0.0), DVec3::new(0.0, -0.3, 2.0));
        for map in [tall, sheared, DMat3::from_diagonal(DVec3::new(-1.0, 2.0, 1.0)), DMat3::from_rotation_x(1.0)] {
            let mut data = MeshData { positions: vec![n], normals: vec![n], ..MeshData::default() };
            pose.apply(&mut data, &[], Some(&[DAffine3::from_mat3(map)]));
            let turned = data.normals[0];
            for along in [u, v] {
                assert!((map * along.as_dvec3()).as_vec3().dot(turned).abs() < 1e-5, "{map}: {turned}");
            }
            assert!((map * n.as_dvec3()).as_vec3().dot(turned) > 0.0 && (turned.length() - 1.0).abs() < 1e-5);
        }
    }
}
