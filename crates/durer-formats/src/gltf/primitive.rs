//! Converts the attributes and indices of mesh primitives to triangles.

use super::Model;
use super::accessor::{Accessor, ComponentType};
use super::deform::{Deformation, copy};
use super::json::JsonRef;
use crate::sticks::sticks_and_balls;
use durer_diag::Diagnostic;
use durer_scene::math::{Vec2, Vec3};
use durer_scene::shape::MeshData;
use glam::DAffine3;
use rayon::prelude::*;
use std::sync::Arc;
use std::sync::atomic::AtomicBool;
use std::sync::atomic::Ordering::Relaxed;

/// Primitives of a glTF mesh, with `None` in place of those that are left out.
pub(super) type Primitives = Vec<Option<Primitive>>;

/// Primitive of a glTF mesh after its conversion to triangles that share a material.
#[derive(Clone)]
pub(super) struct Primitive {
    pub data: Arc<MeshData>,
    pub material: Option<u32>,
    /// True if the file has vertex normals, in which case the normals are deformed together with
    /// the positions.
    pub has_normals: bool,
    /// Joints and morph targets of the primitive, if there are any.
    pub pose: Option<Arc<Deformation>>,
}

impl Primitive {
    /// Returns the mesh after its vertices have been deformed.
    pub fn deformed(&self, pose: &Deformation, weights: &[f32], bones: Option<&[DAffine3]>) -> MeshData {
        let mut data = MeshData::clone(&self.data);
        pose.apply(&mut data, weights, bones);
        index(&mut data, self.has_normals);
        data
    }
}

/// Modes of primitives; see chapter 3.7.2.1 of the specification.
const POINTS: u64 = 0;
const LINES: u64 = 1;
const LINE_LOOP: u64 = 2;
const LINE_STRIP: u64 = 3;
const TRIANGLES: u64 = 4;
const STRIP: u64 = 5;
const FAN: u64 = 6;

impl Model<'_> {
    /// Reads all meshes and converts their primitives to triangles.
    pub(super) fn meshes(&self, root: &JsonRef) -> Vec<Primitives> {
        let Some(meshes) = root.get("meshes") else { return Vec::new() };
        meshes.items().map(|mesh| self.mesh(&mesh)).collect()
    }

    fn mesh(&self, at: &JsonRef) -> Primitives {
        let Some(primitives) = at.object().and_then(|_| at.required("primitives")) else { return Vec::new() };
        if let Some(weights) = at.get("weights") {
            let targets = primitives.items().next().map_or(0, |first| first.list("targets", |_| ()).len());
            let count = weights.items().len();
            if count != targets {
                weights.error(
                    "MESH_INVALID_WEIGHTS_COUNT",
                    format!("the mesh has {targets} morph targets, but {count} weights"),
                );
            }
        }
        let counts: Vec<usize> = primitives.items().map(|primitive| primitive.list("targets", |_| ()).len()).collect();
        if counts.iter().any(|count| *count != counts[0]) {
            primitives.error(
                "MESH_PRIMITIVES_UNEQUAL_TARGETS_COUNT",
                "all primitives must have the same number of morph targets",
            );
        }
        primitives.items().map(|primitive| self.primitive(&primitive)).collect()
    }

    /// Returns the accessor whose index is this value.
    pub(super) fn accessor(&self, at: &JsonRef) -> Option<&Accessor> {
        self.accessors[at.index(self.accessors.len())?].as_ref()
    }

    /// Returns the accessor of an attribute, and reports an error if its format is not valid for
    /// the attribute.
    fn attribute(&self, at: &JsonRef, name: &str, widths: &[usize], whole: &[ComponentType]) -> Option<&Accessor> {
        let accessor = self.accessor(at)?;
        let quantized = self.quantized && !matches!(accessor.component, ComponentType::U32);
        let right = accessor.component == ComponentType::F32
            || quantized
            || accessor.normalized && whole.contains(&accessor.component);
        if right && widths.contains(&accessor.width) && !accessor.is_matrix {
            return Some(accessor);
        }
        let message = format!(
            "an accessor for {name} cannot have component type {:?} with {} components",
            accessor.component, accessor.width
        );
        at.error("MESH_PRIMITIVE_ATTRIBUTES_ACCESSOR_INVALID_FORMAT", message);
        None
    }

    fn primitive(&self, at: &JsonRef) -> Option<Primitive> {
        at.object()?;
        let material = self.material_of(at)?;
        let mode = at.get("mode").map_or(Some(TRIANGLES), |mode| mode.integer(0..=6))?;
        let attributes = at.required("attributes")?;
        if attributes.object()?.is_empty() {
            attributes.error("EMPTY_ENTITY", "`attributes` must not be empty");
        }
        let Some(positions) = attributes.get("POSITION") else {
            attributes.warning("MESH_PRIMITIVE_NO_POSITION", "a primitive without a POSITION attribute is left out");
            return None;
        };
        let place = self.attribute(&positions, "POSITION", &[3], &[])?;
        if !place.has_bounds {
            let message = "the accessor of POSITION must have `min` and `max`";
            positions.error("MESH_PRIMITIVE_POSITION_ACCESSOR_WITHOUT_BOUNDS", message);
        }
        let count = place.count;
        let positions = self.rows_as(place, &positions, Vec3::from_array)?;
        let mut data = MeshData { positions, ..MeshData::default() };
        for key in attributes.object()?.keys() {
            let Some(attribute) = attributes.get(key) else { continue };
            let equal = self.accessor(&attribute).is_none_or(|accessor| accessor.count == count);
            if !equal {
                let message = format!("all attributes must have {count} rows, as POSITION has");
                attribute.error("MESH_PRIMITIVE_UNEQUAL_ACCESSOR_COUNT", message);
                continue;
            }
            self.fill(&mut data, key, &attribute);
        }
        self.check_second_set(&data, material);
        let has_normals = data.normals.len() == count;
        if material.is_none_or(|material| !self.translucent[material as usize]) {
            data.colors.iter_mut().for_each(|color| color[3] = 1.0);
        }
        let mut pose = self.pose(at, &attributes, count);
        let order = self.order(at, count)?;
        // Count the memory for the corners with their normals and texture coordinates. A strip has
        // almost as many triangles as indices.
        let triangles = if mode == TRIANGLES { order.len() / 3 } else { order.len() };
        let lists = 1 + usize::from(has_normals) + usize::from(!data.uvs.is_empty());
        self.count_kept(triangles, 12 * lists, at)?;
        // Count the memory for the flags that mark the vertices in use.
        self.count_kept(count, 5, at)?;
        data.triangles = match mode {
            TRIANGLES => order.as_chunks::<3>().0.par_iter().copied().collect(),
            // Every second triangle of a strip has the opposite winding.
            STRIP => order.windows(3).enumerate().map(|(i, t)| [t[0], t[1 + i % 2], t[2 - i % 2]]).collect(),
            FAN => order.windows(2).skip(1).map(|t| [order[0], t[0], t[1]]).collect(),
            _ => return self.thickened(&data, mode, &order, material, at),
        };
        // Degenerate triangles only connect strips.
        let has_area = |[a, b, c]: &[u32; 3]| a != b && b != c && c != a;
        if !data.triangles.par_iter().all(has_area) {
            data.triangles.retain(has_area);
        }
        compact(&mut data, pose.is_some());
        index(&mut data, has_normals);
        if data.tangents.is_empty() && material.is_some_and(|material| self.needs_tangents[material as usize]) {
            let originals = data.make_tangents();
            copy(&mut data.normals, &originals);
            copy(&mut data.uvs, &originals);
            index(&mut data, has_normals);
            pose.iter_mut().for_each(|pose| pose.copy(&originals));
        }
        Some(Primitive { data: Arc::new(data), material, has_normals, pose: pose.map(Arc::new) })
    }

    /// Warns if the material of a primitive uses a second set of texture coordinates that the
    /// primitive does not have.
    fn check_second_set(&self, data: &MeshData, material: Option<u32>) {
        let Some(material) = material.filter(|_| data.second_uvs.is_empty()) else { return };
        let (sets, prefix) = (self.second_sets.borrow(), format!("/materials/{material}/"));
        if let Some(texture) = sets.iter().find(|pointer| pointer.starts_with(&prefix)) {
            let message = match data.uvs.is_empty() {
                true => "the mesh has no texture coordinates, so the texture is not shown",
                false => "the mesh has no TEXCOORD_1, so the texture is not shown; TEXCOORD_0 exists",
            };
            self.report.report(
                Diagnostic::warning,
                "MESH_PRIMITIVE_TOO_FEW_TEXCOORDS",
                &format!("{texture}/texCoord"),
                message,
            );
        }
    }

    /// Converts points and lines, which have no surface, to small balls and thin cylinders.
    fn thickened(
        &self,
        data: &MeshData,
        mode: u64,
        order: &[u32],
        material: Option<u32>,
        at: &JsonRef,
    ) -> Option<Primitive> {
        let name = at.name();
        let message =
            format!("points and lines of mesh{name} have no surface, so small balls and thin sticks are shown");
        self.once_at("points-and-lines", &at.pointer(), &message);
        // About a dozen vertices are needed for each point or line.
        self.charge(order.len(), 12 * 64, at)?;
        self.count_kept(order.len(), 12 * 64, at)?;
        let strip = || order.windows(2).map(|pair| [pair[0], pair[1]]);
        let lines: Vec<[u32; 2]> = match mode {
            LINES => order.as_chunks::<2>().0.to_vec(),
            LINE_STRIP => strip().collect(),
            LINE_LOOP => strip().chain(order.last().zip(order.first()).map(|(last, first)| [*last, *first])).collect(),
            _ => Vec::new(),
        };
        let points = if mode == POINTS { order } else { &[] };
        let data = Arc::new(sticks_and_balls(data, &lines, points));
        Some(Primitive { data, material, has_normals: true, pose: None })
    }

    /// Reads an attribute other than the vertex positions.
    fn fill(&self, data: &mut MeshData, key: &str, at: &JsonRef) {
        const UNSIGNED: &[ComponentType] = &[ComponentType::U8, ComponentType::U16];
        match key {
            "POSITION" | "JOINTS_0" | "WEIGHTS_0" => {}
            "NORMAL" => {
                let accessor = self.attribute(at, key, &[3], &[]);
                let normals = accessor.and_then(|accessor| self.rows_as(accessor, at, Vec3::from_array));
                data.normals = normals.unwrap_or_default();
                if !data.normals.is_empty() && data.normals.iter().all(|normal| *normal == Vec3::ZERO) {
                    at.warning("odd-normals", "all normals are 0 0 0: the normals of the faces are used instead");
                }
            }
            "TANGENT" => {
                let rows = self.attribute(at, key, &[4], &[]).and_then(|accessor| self.rows(accessor, at));
                data.tangents = rows.unwrap_or_default();
            }
            "TEXCOORD_0" | "TEXCOORD_1" => {
                let accessor = self.attribute(at, key, &[2], UNSIGNED);
                // In a Dürer scene, v increases upwards.
                let uvs = accessor.and_then(|accessor| self.rows_as(accessor, at, |[u, v]| Vec2::new(u, 1.0 - v)));
                let uvs = uvs.unwrap_or_default();
                *(if key == "TEXCOORD_0" { &mut data.uvs } else { &mut data.second_uvs }) = uvs;
            }
            "COLOR_0" => {
                let Some(accessor) = self.attribute(at, key, &[3, 4], UNSIGNED) else { return };
                data.colors = self.rows(accessor, at).unwrap_or_default();
                let is_black = |color: &[f32; 4]| color[..3] == [0.0; 3];
                if !data.colors.is_empty() && data.colors.iter().all(is_black) {
                    let message = "all vertex colours are black, and the base colour is multiplied by them";
                    at.warning("dark-colors", message);
                }
                if accessor.width == 3 {
                    data.colors.iter_mut().for_each(|color| color[3] = 1.0);
                }
            }
            _ if key.starts_with('_') => {}
            _ => {
                let set = key.rsplit_once('_').filter(|(_, set)| set.parse::<u32>().is_ok());
                match set.map(|(word, _)| word) {
                    Some("TEXCOORD" | "COLOR" | "JOINTS" | "WEIGHTS") => {
                        let message =
                            format!("additional attribute sets, for example of mesh{}, are left out", at.name());
                        self.once_at("further-attributes", &at.pointer(), &message);
                    }
                    _ => at.error("MESH_PRIMITIVE_INVALID_ATTRIBUTE", format!("invalid attribute name `{key}`")),
                }
            }
        }
    }

    /// Returns the vertex indices of the primitive in the order of drawing.
    fn order(&self, at: &JsonRef, count: usize) -> Option<Vec<u32>> {
        let Some(indices) = at.get("indices") else {
            self.count_kept(count, 4, at)?;
            return Some((0..count as u32).collect());
        };
        let accessor = self.accessor(&indices)?;
        if accessor.width != 1
            || !matches!(accessor.component, ComponentType::U8 | ComponentType::U16 | ComponentType::U32)
        {
            indices.error("MESH_PRIMITIVE_INDICES_ACCESSOR_INVALID_FORMAT", "indices must be unsigned integers");
            return None;
        }
        if accessor.strided {
            let message = "the buffer view of indices must not have a stride";
            indices.error("MESH_PRIMITIVE_INDICES_ACCESSOR_WITH_BYTESTRIDE", message);
        }
        self.charge(accessor.count, 4, &indices)?;
        self.count_kept(accessor.count, 4, &indices)?;
        let order = accessor.integers();
        if accessor.component == ComponentType::U8 && accessor.holds_shorts() {
            indices.warning(
                "INDICES_LOOK_LIKE_SHORTS",
                format!(
                    "the {} indices are declared as bytes and use half of their buffer view, in which every second \
                     byte is 0: they are probably 16-bit numbers (componentType 5123)",
                    accessor.count
                ),
            );
        }
        let most = u32::MAX >> (32 - 8 * accessor.component.size());
        let greatest = order.par_iter().copied().max().unwrap_or(0);
        if greatest == most {
            let message = format!("index {most} is reserved for primitive restart and must not be used");
            indices.error("ACCESSOR_INDEX_PRIMITIVE_RESTART", message);
            return None;
        }
        if greatest as usize >= count {
            let wrong = order.iter().find(|&&i| i as usize >= count).unwrap_or(&greatest);
            let message = format!("index {wrong} is out of range, because there are only {count} vertices");
            match accessor.view().and_then(|view| self.overlapping(view)) {
                Some((view, other)) => {
                    let message = format!("this view of indices overlaps buffer view {other}: {message}");
                    let pointer = format!("/bufferViews/{view}/byteOffset");
                    self.report.report(Diagnostic::error, "ACCESSOR_INDEX_OOB", &pointer, &message);
                }
                None => indices.error("ACCESSOR_INDEX_OOB", message),
            }
            return None;
        }
        Some(order)
    }
}

/// Removes unused vertices, because many primitives often share one list of vertices.
fn compact(data: &mut MeshData, keep: bool) {
    const UNUSED: u32 = u32::MAX;
    if keep {
        return;
    }
    let is_used: Vec<AtomicBool> = data.positions.par_iter().map(|_| AtomicBool::new(false)).collect();
    data.triangles
        .par_iter()
        .for_each(|corners| corners.iter().for_each(|&i| is_used[i as usize].store(true, Relaxed)));
    if is_used.par_iter().all(|used| used.load(Relaxed)) {
        return;
    }
    let mut numbers: Vec<u32> = is_used.into_iter().map(|used| if used.into_inner() { 0 } else { UNUSED }).collect();
    let mut next = 0;
    for number in numbers.iter_mut().filter(|number| **number != UNUSED) {
        (*number, next) = (next, next + 1);
    }
    fn thin<T: Copy>(values: &mut Vec<T>, numbers: &[u32]) {
        let used = values.iter().zip(numbers).filter(|(_, number)| **number != UNUSED);
        *values = used.map(|(value, _)| *value).collect();
    }
    thin(&mut data.positions, &numbers);
    thin(&mut data.normals, &numbers);
    thin(&mut data.uvs, &numbers);
    thin(&mut data.second_uvs, &numbers);
    thin(&mut data.colors, &numbers);
    thin(&mut data.tangents, &numbers);
    data.triangles.iter_mut().flatten().for_each(|i| *i = numbers[*i as usize]);
}

/// Sets the indices of normals and texture coordinates to the vertex indices. Shading is flat if
/// the file has no normals.
fn index(data: &mut MeshData, has_normals: bool) {
    data.flat = !has_normals;
    let own = || data.triangles.par_iter().copied().collect();
    if has_normals {
        data.triangle_normals = own();
    }
    if !data.uvs.is_empty() {
        data.triangle_uvs = own();
    }
}
