//! Polygon meshes and subdivision surfaces, with subsets of faces and primvars.
//!
//! Source: *OpenUSD documentation*, `UsdGeomMesh` and `UsdGeomSubset`.

use super::layer::Value;
use super::primvar::{DISPLAY_COLOR, Interpolation, Primvar};
use super::reader::{Inherited, Reader};
use super::skel::Pose;
use super::stage::Prim;
use crate::polygon::Triangulator;
use crate::smooth::smoothed;
use durer_scene::math::{Vec2, Vec3};
use durer_scene::scene::Object;
use durer_scene::shape::MeshData;
use durer_scene::shape::mesh::NO_INDEX;
use durer_scene::shape::tessellate::catmull_clark::{Crease, PolygonMesh};
use glam::DVec3;
use std::rc::Rc;
use std::sync::Arc;

/// Maximum number of faces of a subdivided mesh.
const MAX_FACES: usize = 1 << 20;
/// Number of subdivision levels, for meshes of few faces.
const LEVELS: u32 = 3;
/// Number of faces that a subdivided mesh may have by default.
const USUAL_FACES: usize = 1 << 16;

/// Polygons of a mesh, with the corners of all faces in one list.
struct Faces {
    points: Vec<Vec3>,
    /// Number of corners of each face.
    counts: Vec<u32>,
    /// Point of each corner.
    corners: Vec<u32>,
    /// First corner of each face.
    starts: Vec<usize>,
    /// Faces that are holes.
    holes: Vec<bool>,
}

/// Faces of a mesh that share a material.
struct Part {
    /// Name of the subset; empty for the rest of the mesh.
    name: String,
    material: Option<String>,
    /// Flag for each face.
    faces: Option<Vec<bool>>,
}

/// Display colours that become colours of the points.
enum Colors {
    None,
    /// Colours that vary over the mesh. A constant colour becomes a material.
    Varying,
    /// All colours; those of the given ancestor if the mesh has none.
    All(Option<Rc<Prim>>),
}

impl Colors {
    /// Returns a key that is equal for equal colours of the same mesh.
    fn key(&self) -> String {
        match self {
            Colors::None => "-".into(),
            Colors::Varying => String::new(),
            Colors::All(inherited) => format!("+{}", inherited.as_ref().map_or("", |prim| &prim.path)),
        }
    }
}

impl Reader<'_, '_> {
    /// Adds a mesh, as one object for each of its materials.
    pub fn mesh(&mut self, prim: &Prim, here: &Inherited, objects: &mut Vec<Object>) {
        let at = prim.span();
        let Some(count) = prim.get(self.stage, "faceVertexCounts").map(|counts| counts.value.numbers().len()) else {
            return;
        };
        let pose = Pose::of(self.stage, prim, here);
        let pose_key = pose.as_ref().map_or("", |pose| &pose.key);
        for part in self.parts(prim, here, count) {
            let bound = part.material.as_deref().and_then(|path| self.material(path));
            let uvs = bound.as_ref().map_or(Vec::new(), |bound| bound.uvs.clone());
            // A bound material replaces the display colours, unless it reads them.
            let colors = match &bound {
                None => Colors::Varying,
                Some(bound) if bound.uses_colors => Colors::All(here.display.clone()),
                Some(_) => Colors::None,
            };
            let key = format!("{}#{}@{}{}{pose_key}", prim.key(), part.name, uvs.join(","), colors.key());
            let data = match self.meshes.get(&key) {
                Some(known) => known.clone(),
                None => {
                    let chosen = part.faces.as_deref();
                    let data = self.mesh_data(prim, (&uvs, &colors), chosen, pose.as_ref()).map(Arc::new);
                    self.meshes.insert(key.clone(), data.clone());
                    data
                }
            };
            let Some(data) = data.filter(|data| !data.triangles.is_empty()) else { continue };
            let has_colors = !data.colors.is_empty();
            let material = match &bound {
                Some(bound) => Some(bound.number),
                None if has_colors => Some(self.vertex_color_material(at)),
                None => self.display_material(prim, here, at),
            };
            let node = self.scene.add_mesh(&key, data, at);
            self.add(node, material, here.to_world, at, objects);
        }
    }

    /// Splits the faces of a mesh by material.
    fn parts(&self, prim: &Prim, here: &Inherited, count: usize) -> Vec<Part> {
        let mut rest = vec![true; count];
        let mut parts = Vec::new();
        for subset in self.stage.children(prim) {
            if subset.type_name() != "GeomSubset" {
                continue;
            }
            let bound = self.bound_material(&subset).filter(|_| !here.is_stronger);
            let Some((material, _)) = bound else { continue };
            let Some(indices) = subset.get(self.stage, "indices") else { continue };
            let mut faces = vec![false; count];
            for index in indices.value.numbers() {
                if let Some(face) = faces.get_mut(*index as usize) {
                    // A face belongs to its first subset.
                    *face = std::mem::replace(&mut rest[*index as usize], false);
                }
            }
            parts.push(Part { name: subset.name().to_string(), material: Some(material), faces: Some(faces) });
        }
        let faces = if parts.is_empty() { None } else { Some(rest) };
        if faces.as_ref().is_none_or(|rest| rest.contains(&true)) {
            parts.push(Part { name: String::new(), material: here.material.clone(), faces });
        }
        parts
    }

    /// Converts the chosen faces of a mesh to triangles. `uvs` are the names of the texture
    /// coordinates that the material uses.
    fn mesh_data(
        &self,
        prim: &Prim,
        (uvs, colors): (&[String], &Colors),
        chosen: Option<&[bool]>,
        pose: Option<&Pose>,
    ) -> Option<MeshData> {
        let (files, at) = (self.stage.files, prim.span());
        let warn =
            |message: &str| files.report.warn_once("bad-mesh", at, format!("the mesh `{}` {message}", prim.name()));
        let mut faces = match self.faces(prim) {
            Ok(faces) => faces,
            Err(message) => {
                warn(&format!("is left out: {message}"));
                return None;
            }
        };
        if let Some(pose) = pose {
            pose.move_points(&mut faces.points);
        }
        // Counts the points, and for each corner a triangle with its normals and coordinates.
        let bytes = 48 * faces.points.len() + 96 * faces.corners.len();
        files.limits.count_bytes_or_report(bytes, 1, files.report, at).then_some(())?;
        let scheme = self.text(prim, "subdivisionScheme");
        let normals = ["primvars:normals", "normals"];
        let normals = normals.iter().find_map(|name| Primvar::read(self.stage, prim, name, 3, Interpolation::Point));
        let is_smooth = match scheme.as_deref() {
            Some("catmullClark" | "loop") => true,
            Some(_) => false,
            // Many exporters write normals and forget that meshes are subdivided by default.
            None => normals.is_none(),
        };
        let names: Vec<&str> = if uvs.is_empty() { vec!["st"] } else { uvs.iter().map(String::as_str).collect() };
        let coordinates: Vec<Option<Primvar>> =
            names.iter().take(2).map(|name| self.coordinates(prim, name, &faces)).collect();
        let display = |prim: &Prim| Primvar::read(self.stage, prim, DISPLAY_COLOR, 3, Interpolation::Constant);
        let color = match colors {
            Colors::None => None,
            Colors::Varying => display(prim).filter(|color| color.interpolation != Interpolation::Constant),
            Colors::All(ancestor) => {
                display(prim).or_else(|| Primvar::inherited(self.stage, ancestor.as_deref(), DISPLAY_COLOR, 3))
            }
        };
        let opacity = Primvar::read(self.stage, prim, "primvars:displayOpacity", 1, Interpolation::Constant);
        let reversed = self.text(prim, "orientation").as_deref() == Some("leftHanded");
        let levels = if is_smooth { self.levels(prim, &faces) } else { 0 };
        if levels > 0 {
            let data = self.subdivided(prim, &faces, coordinates.first().and_then(Option::as_ref), levels, chosen);
            return Some(if reversed { data.oriented(true) } else { data });
        }
        let mut data = MeshData { positions: faces.points.clone(), flat: normals.is_none(), ..MeshData::default() };
        let mut triangulator = Triangulator::new(files.input.bytes.len());
        // Values that belong to corners need a copy of the point for each corner.
        let is_split = [coordinates.get(1).and_then(Option::as_ref), color.as_ref()];
        let is_whole =
            |values: &Primvar| matches!(values.interpolation, Interpolation::Point | Interpolation::Constant);
        let is_split = is_split.into_iter().flatten().any(|values| !is_whole(values));
        if is_split {
            data.positions = faces.corners.iter().map(|point| faces.points[*point as usize]).collect();
        }
        for face in 0..faces.counts.len() {
            if faces.holes[face] || chosen.is_some_and(|chosen| !chosen[face]) {
                continue;
            }
            let start = faces.starts[face];
            let own = &faces.corners[start..start + faces.counts[face] as usize];
            let done = triangulator.triangulate(
                own.len(),
                |i| faces.points[own[i] as usize],
                |mut triangle| {
                    if reversed {
                        triangle.swap(1, 2);
                    }
                    let vertex = |i: usize| if is_split { (start + i) as u32 } else { own[i] };
                    data.triangles.push(triangle.map(vertex));
                    let index = |values: &Primvar, i: usize| {
                        values.index(face, own[i] as usize, start + i).map_or(NO_INDEX, |index| index as u32)
                    };
                    if let Some(values) = coordinates.first().and_then(Option::as_ref) {
                        data.triangle_uvs.push(triangle.map(|i| index(values, i)));
                    }
                    if let Some(values) = &normals {
                        data.triangle_normals.push(triangle.map(|i| index(values, i)));
                    }
                },
            );
            if done.is_err() {
                warn("is left out: its polygons are too large and too irregular");
                return None;
            }
        }
        let pair = |values: &Primvar| {
            values.values.as_chunks::<2>().0.iter().map(|[u, v]| Vec2::new(*u as f32, *v as f32)).collect()
        };
        if let Some(values) = coordinates.first().and_then(Option::as_ref) {
            data.uvs = pair(values);
        }
        if let Some(values) = &normals {
            data.normals =
                values.values.as_chunks::<3>().0.iter().map(|n| Vec3::from_array(n.map(|x| x as f32))).collect();
            if data.triangle_normals.iter().flatten().any(|index| *index == NO_INDEX) {
                data.triangle_normals
                    .iter_mut()
                    .filter(|all| all.contains(&NO_INDEX))
                    .for_each(|all| *all = [NO_INDEX; 3]);
            }
        }
        if let (Some(pose), Some(values)) = (pose, &normals) {
            // A normal belongs to the point of a corner that uses it.
            let mut turned = data.normals.clone();
            for (corners, indices) in data.triangles.iter().zip(&data.triangle_normals) {
                for (vertex, index) in corners.iter().zip(indices).filter(|(_, index)| **index != NO_INDEX) {
                    let point = if is_split { faces.corners[*vertex as usize] } else { *vertex };
                    let normal =
                        Vec3::from_slice(&values.value(*index as usize).iter().map(|x| *x as f32).collect::<Vec<_>>());
                    turned[*index as usize] = pose.turned(point as usize, normal);
                }
            }
            data.normals = turned;
        }
        let of_vertex = |values: &Primvar, vertex: usize| match is_split {
            true => values.index(faces.face_of(vertex), faces.corners[vertex] as usize, vertex),
            false => values.index(0, vertex, 0),
        };
        if let Some(values) = coordinates.get(1).and_then(Option::as_ref) {
            let at = |vertex| {
                of_vertex(values, vertex).map_or(Vec2::ZERO, |index| {
                    let value = values.value(index);
                    Vec2::new(value[0] as f32, value[1] as f32)
                })
            };
            data.second_uvs = (0..data.positions.len()).map(at).collect();
        }
        if let Some(color) = &color {
            let at = |vertex| {
                let rgb = of_vertex(color, vertex).map_or([1.0; 3], |index| {
                    let value = color.value(index);
                    [value[0], value[1], value[2]]
                });
                let alpha = opacity.as_ref().and_then(|values| Some(values.value(of_vertex(values, vertex)?)[0]));
                [rgb[0], rgb[1], rgb[2], alpha.unwrap_or(1.0)].map(|x| x as f32)
            };
            data.colors = (0..data.positions.len()).map(at).collect();
        }
        match data.validate() {
            Ok(()) => Some(data),
            Err(message) => {
                warn(&format!("is left out: {message}"));
                None
            }
        }
    }

    /// Reads the points and faces of a mesh, and checks their indices.
    fn faces(&self, prim: &Prim) -> Result<Faces, String> {
        let numbers = |name: &str| prim.get(self.stage, name).map(|opinion| opinion.value);
        let points = numbers("points").ok_or("it has no points")?;
        let points: Vec<Vec3> =
            points.numbers().as_chunks::<3>().0.iter().map(|p| Vec3::from_array(p.map(|x| x as f32))).collect();
        let whole = |value: &Value| -> Vec<u32> { value.numbers().iter().map(|x| *x as u32).collect() };
        let counts = numbers("faceVertexCounts").map_or(Vec::new(), |counts| whole(&counts));
        let corners = numbers("faceVertexIndices").map_or(Vec::new(), |corners| whole(&corners));
        let total: u64 = counts.iter().map(|count| u64::from(*count)).sum();
        if total != corners.len() as u64 {
            return Err(format!("its faces have {total} corners, but it has {} indices", corners.len()));
        }
        if let Some(wrong) = corners.iter().find(|index| **index as usize >= points.len()) {
            return Err(format!("index {wrong} is out of range, because it has {} points", points.len()));
        }
        let starts = counts.iter().scan(0, |start, count| {
            let own = *start;
            *start += *count as usize;
            Some(own)
        });
        let starts = starts.collect();
        let mut holes = vec![false; counts.len()];
        for index in numbers("holeIndices").iter().flat_map(Value::numbers) {
            holes.get_mut(*index as usize).into_iter().for_each(|hole| *hole = true);
        }
        // A face with a point that is not a number is left out.
        let is_finite: Vec<bool> = points.iter().map(|point| point.is_finite()).collect();
        let mut faces = Faces { points, counts, corners, starts, holes };
        for face in 0..faces.counts.len() {
            let own = &faces.corners[faces.starts[face]..faces.starts[face] + faces.counts[face] as usize];
            faces.holes[face] |= own.len() < 3 || own.iter().any(|point| !is_finite[*point as usize]);
        }
        faces.points.iter_mut().filter(|point| !point.is_finite()).for_each(|point| *point = Vec3::ZERO);
        Ok(faces)
    }

    /// Reads texture coordinates. If the file states no interpolation, their number decides.
    fn coordinates(&self, prim: &Prim, name: &str, faces: &Faces) -> Option<Primvar> {
        let mut values = Primvar::read(self.stage, prim, &format!("primvars:{name}"), 2, Interpolation::Constant)?;
        if values.interpolation == Interpolation::Constant {
            values.interpolation = match values.values.len() / 2 {
                count if count == faces.corners.len() => Interpolation::Corner,
                count if count == faces.points.len() => Interpolation::Point,
                _ => Interpolation::Constant,
            };
        }
        Some(values)
    }

    /// Returns the number of levels at which a mesh is subdivided.
    fn levels(&self, prim: &Prim, faces: &Faces) -> u32 {
        let corners = faces.corners.len().max(1);
        let fitting = |most: usize| (0..=LEVELS).rev().find(|level| corners << (2 * level.saturating_sub(1)) <= most);
        match fitting(USUAL_FACES) {
            Some(levels) if levels > 0 => levels,
            _ if corners <= MAX_FACES => 1,
            _ => {
                let message = "a subdivision surface with more than a million corners is rendered without subdivision";
                self.stage.files.report.unsupported_once(prim.span(), message);
                0
            }
        }
    }

    /// Subdivides a mesh, and triangulates the chosen faces.
    fn subdivided(
        &self,
        prim: &Prim,
        faces: &Faces,
        coordinates: Option<&Primvar>,
        levels: u32,
        chosen: Option<&[bool]>,
    ) -> MeshData {
        let numbers = |name: &str| prim.numbers(self.stage, name);
        let (lengths, indices, sharpness) =
            (numbers("creaseLengths"), numbers("creaseIndices"), numbers("creaseSharpnesses"));
        let mut creases = Vec::new();
        let (mut first, mut edge) = (0_usize, 0);
        for (i, length) in lengths.iter().enumerate() {
            let Some(chain) = indices.get(first..first + (*length).max(0.0) as usize) else { break };
            for pair in chain.windows(2) {
                // There is one sharpness for each crease, or for each edge.
                let of = if sharpness.len() == lengths.len() { i } else { edge };
                let sharpness = sharpness.get(of).copied().unwrap_or(0.0);
                creases.push(Crease { ends: [pair[0] as u32, pair[1] as u32], sharpness });
                edge += 1;
            }
            first += chain.len();
        }
        let sharp_points = numbers("cornerIndices").into_iter().zip(numbers("cornerSharpnesses"));
        let uv = |face: usize, i: usize| {
            let corner = faces.starts[face] + i;
            let value =
                coordinates.and_then(|uv| Some(uv.value(uv.index(face, faces.corners[corner] as usize, corner)?)));
            value.map_or([0.0; 2], |value| [value[0], value[1]])
        };
        let mut mesh = PolygonMesh::new(faces.points.iter().map(|p| p.as_dvec3()).collect());
        for face in (0..faces.counts.len()).filter(|face| !faces.holes[*face]) {
            let own = &faces.corners[faces.starts[face]..faces.starts[face] + faces.counts[face] as usize];
            mesh.add_face(own, (0..own.len()).map(|i| uv(face, i)), face as u32);
        }
        mesh.set_creases(creases, sharp_points.map(|(point, sharpness)| (point as u32, sharpness)));
        for _ in 0..levels {
            mesh = mesh.subdivided();
        }
        let mut data =
            MeshData { positions: mesh.points.iter().map(|p: &DVec3| p.as_vec3()).collect(), ..MeshData::default() };
        for (corners, uvs, origin) in mesh.quads() {
            if chosen.is_some_and(|chosen| !chosen[origin as usize]) {
                continue;
            }
            data.triangles.extend([[corners[0], corners[1], corners[2]], [corners[0], corners[2], corners[3]]]);
            if coordinates.is_some() {
                let first = data.uvs.len() as u32;
                data.uvs.extend(uvs.map(|[u, v]| Vec2::new(u as f32, v as f32)));
                data.triangle_uvs.extend([[first, first + 1, first + 2], [first, first + 2, first + 3]]);
            }
        }
        smoothed(&mut data, |_, _| Some(0));
        data
    }
}

impl Faces {
    /// Returns the face that a corner belongs to.
    fn face_of(&self, corner: usize) -> usize {
        self.starts.partition_point(|start| *start <= corner).saturating_sub(1)
    }
}
