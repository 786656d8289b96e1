//! Meshes: lists of triangles, polygons and strips, whose corners have an index for each input.

use super::document::Element;
use super::parts::{Part, Source};
use super::reader::Reader;
use super::skin::Skin;
use crate::polygon::Triangulator;
use durer_diag::Span;
use durer_scene::math::{Vec2, Vec3};
use durer_scene::shape::MeshData;
use durer_scene::shape::mesh::NO_INDEX;
use std::collections::HashMap;
use std::rc::Rc;
use std::sync::Arc;

/// Largest offset of an input.
const MAX_OFFSET: u32 = 255;

/// Inputs of the corners of a primitive list.
struct Inputs {
    /// Number of indices of each corner.
    stride: usize,
    positions: (Rc<Source>, usize),
    normals: Option<(Rc<Source>, usize)>,
    colors: Option<(Rc<Source>, usize)>,
    /// Texture coordinates, in the order of their sets.
    uvs: Vec<(u32, Rc<Source>, usize)>,
}

/// Mesh of the triangles of one primitive list.
struct Builder<'b> {
    inputs: &'b Inputs,
    skin: Option<&'b Skin>,
    is_linear: bool,
    data: MeshData,
    /// Vertices by their position, and by the corner of the values that belong to vertices.
    vertices: HashMap<[u32; 3], u32>,
    /// Indices in the mesh of texture coordinates and normals, by their indices in the file.
    uvs: HashMap<u32, u32>,
    normals: HashMap<[u32; 2], u32>,
    triangulator: Triangulator,
    is_too_complex: bool,
    /// Number of polygons that are left out because of points that are not numbers, or because they
    /// have fewer than three corners.
    bad: usize,
}

impl<'r> Reader<'r> {
    /// Returns the parts of a geometry. A skin moves its points.
    pub fn mesh(&mut self, geometry: &'r Element<'r>, skin: Option<&Skin>) -> Vec<Part> {
        let Some(mesh) = geometry.child("mesh").or_else(|| geometry.child("convex_mesh")) else {
            if let Some(other) = geometry.children.iter().find(|child| matches!(child.name, "spline" | "brep")) {
                let message = format!("a `{}` has no counterpart: it is left out", other.name);
                self.report.unsupported_once(other.at, message);
            }
            return Vec::new();
        };
        let mut parts = Vec::new();
        for list in &mesh.children {
            match list.name {
                "triangles" | "polylist" | "polygons" | "tristrips" | "trifans" => {
                    parts.extend(self.part(mesh, list, skin));
                }
                "lines" | "linestrips" => {
                    let message = format!("`{}` have no counterpart: they are left out", list.name);
                    self.report.unsupported_once(list.at, message);
                }
                _ => {}
            }
        }
        parts
    }

    /// Reads one list of triangles or polygons.
    fn part(&mut self, mesh: &'r Element<'r>, list: &'r Element<'r>, skin: Option<&Skin>) -> Option<Part> {
        let (report, limits) = (self.report, self.limits);
        let holed = list.all("ph").filter_map(|ph| ph.child("p"));
        let is_empty = list.all("p").chain(holed).all(|p| p.text().is_empty());
        if list.get("count").is_some_and(|count| count.trim() == "0") || is_empty {
            return None;
        }
        let inputs = self.inputs(mesh, list)?;
        let lists: Vec<(Vec<u32>, Span)> = list
            .children
            .iter()
            .filter_map(|child| match child.name {
                "p" => Some(child),
                "ph" => {
                    report.unsupported_once(child.at, "holes of polygons have no counterpart: they are filled");
                    child.child("p")
                }
                _ => None,
            })
            .map(|p| (p.integers(report, limits), p.text_span()))
            .collect();
        let total: usize = lists.iter().map(|(numbers, _)| numbers.len() / inputs.stride).sum();
        // Each corner can become a vertex, and three corners of triangles, with entries of maps.
        let bytes = 3 * size_of::<[u32; 9]>() + 2 * size_of::<[f32; 12]>() + 64;
        limits.count_bytes_or_report(total, bytes, report, list.at).then_some(())?;
        let mut builder = Builder {
            inputs: &inputs,
            skin,
            is_linear: self.is_linear,
            data: MeshData { flat: inputs.normals.is_none(), ..MeshData::default() },
            vertices: HashMap::new(),
            uvs: HashMap::new(),
            normals: HashMap::new(),
            triangulator: Triangulator::new(self.input.bytes.len()),
            is_too_complex: false,
            bad: 0,
        };
        let counts = list.child("vcount").map_or(Vec::new(), |counts| counts.integers(report, limits));
        for (numbers, at) in &lists {
            if numbers.len() % inputs.stride != 0 {
                let message = format!("each corner has {} indices, but there are {}", inputs.stride, numbers.len());
                report.error(*at, message);
                return None;
            }
            if let Some(message) = inputs.wrong_index(numbers) {
                report.error(*at, message);
                return None;
            }
            let corners: Vec<&[u32]> = numbers.chunks_exact(inputs.stride).collect();
            match list.name {
                "triangles" => corners.chunks_exact(3).for_each(|corners| builder.polygon(corners)),
                "polylist" => {
                    let mut rest = &corners[..];
                    for count in &counts {
                        let Some((own, after)) = rest.split_at_checked(*count as usize) else {
                            let (count, total) = (counts.len(), corners.len());
                            report.error(
                                *at,
                                format!("`vcount` lists more corners than the {total} of `p`, in {count} polygons"),
                            );
                            return None;
                        };
                        builder.polygon(own);
                        rest = after;
                    }
                }
                "tristrips" => {
                    for (i, own) in corners.windows(3).enumerate() {
                        let turned = if i % 2 == 0 { [own[0], own[1], own[2]] } else { [own[1], own[0], own[2]] };
                        builder.polygon(&turned);
                    }
                }
                "trifans" => corners.windows(2).skip(1).for_each(|own| builder.polygon(&[corners[0], own[0], own[1]])),
                _ => builder.polygon(&corners),
            }
        }
        let Builder { data, bad, is_too_complex, .. } = builder;
        if is_too_complex {
            let message = "a mesh is left out: its polygons are too large and too irregular";
            report.warn_once("bad-mesh", list.at, message);
            return None;
        }
        if bad > 0 {
            let message = format!("{bad} polygons without area or with points that are not numbers are left out");
            report.warn_once("bad-mesh", list.at, message);
        }
        if let Err(message) = data.validate() {
            report.error(list.at, format!("the mesh is not valid: {message}"));
            return None;
        }
        let sets = inputs.uvs.iter().take(2).map(|(set, ..)| *set).collect();
        (!data.triangles.is_empty()).then(|| Part {
            symbol: list.get("material").map(str::to_string),
            data: Arc::new(data),
            sets,
            at: list.at,
        })
    }

    /// Reads the inputs of a primitive list, of which `VERTEX` stands for those of `vertices`.
    fn inputs(&mut self, mesh: &'r Element<'r>, list: &'r Element<'r>) -> Option<Inputs> {
        let report = self.report;
        let mut flat: Vec<(&str, &'r Element<'r>, u32, u32)> = Vec::new();
        let mut last = 0;
        for input in list.all("input") {
            let number = |name: &str| -> Option<u32> {
                let text = input.get(name).unwrap_or("0").trim();
                let number = text.parse::<u32>().ok().filter(|number| *number <= MAX_OFFSET);
                if number.is_none() {
                    report.error(input.span_of(name), format!("`{name}` must be an integer from 0 to {MAX_OFFSET}"));
                }
                number
            };
            let (offset, set) = (number("offset")?, number("set")?);
            last = last.max(offset);
            match input.get("semantic").unwrap_or_default() {
                "VERTEX" => {
                    let vertices = self.referred(input, "source", "vertices")?;
                    flat.extend(
                        vertices
                            .all("input")
                            .map(|inner| (inner.get("semantic").unwrap_or_default(), inner, offset, set)),
                    );
                }
                other => flat.push((other, input, offset, set)),
            }
        }
        let (mut positions, mut normals, mut colors, mut uvs) = (None, None, None, Vec::new());
        for (semantic, input, offset, set) in flat {
            let offset = offset as usize;
            match semantic {
                "POSITION" => positions = Some((self.source(input, 3)?, offset)),
                "NORMAL" => normals = Some((self.source(input, 3)?, offset)),
                "COLOR" if colors.is_none() => colors = Some((self.source(input, 3)?, offset)),
                "TEXCOORD" | "UV" => uvs.push((set, self.source(input, 2)?, offset)),
                // Tangents follow from the texture coordinates.
                _ => {}
            }
        }
        let Some(positions) = positions else {
            report.error(list.at, format!("`{}` of `{}` has no input `POSITION`", list.name, mesh.name));
            return None;
        };
        uvs.sort_by_key(|(set, ..)| *set);
        uvs.dedup_by_key(|(set, ..)| *set);
        if let Some((wrong, what)) = [(Some(&positions), "positions"), (normals.as_ref(), "normals")]
            .into_iter()
            .find_map(|(source, what)| Some((source.filter(|(source, _)| source.width() < 3)?, what)))
        {
            report.error(list.at, format!("its {what} have {} components in place of 3", wrong.0.width()));
            return None;
        }
        Some(Inputs { stride: last as usize + 1, positions, normals, colors, uvs })
    }
}

impl Inputs {
    /// Returns the message about the first index that is out of range.
    fn wrong_index(&self, numbers: &[u32]) -> Option<String> {
        let named = [("positions", Some(&self.positions)), ("normals", self.normals.as_ref())].into_iter();
        let named = named.chain([("colours", self.colors.as_ref())]);
        let named = named.filter_map(|(name, pair)| pair.map(|(source, offset)| (name, source, *offset)));
        let uvs = self.uvs.iter().map(|(_, source, offset)| ("texture coordinates", source, *offset));
        for (name, source, offset) in named.chain(uvs) {
            let mut own = numbers.iter().skip(offset).step_by(self.stride);
            if let Some(wrong) = own.find(|index| **index as usize >= source.count) {
                let shown = if *wrong == u32::MAX { "a negative index".into() } else { format!("index {wrong}") };
                return Some(format!("{shown} is out of range: there are {} {name}", source.count));
            }
        }
        None
    }
}

impl Builder<'_> {
    /// Adds a polygon, given by the indices of its corners.
    fn polygon(&mut self, corners: &[&[u32]]) {
        let inputs = self.inputs;
        let (positions, offset) = &inputs.positions;
        let is_sound =
            |corner: &&[u32]| positions.get(corner[*offset] as usize).iter().take(3).all(|number| number.is_finite());
        if corners.len() < 3 || !corners.iter().all(is_sound) {
            self.bad += 1;
            return;
        }
        let mut triangles: Vec<[usize; 3]> = Vec::with_capacity(corners.len() - 2);
        let position = |i: usize| Vec3::from_array(positions.vector(corners[i][*offset] as usize));
        let done = self.triangulator.triangulate(corners.len(), position, |triangle| triangles.push(triangle));
        self.is_too_complex |= done.is_err();
        for triangle in triangles {
            let corners = triangle.map(|i| corners[i]);
            let own = corners.map(|corner| self.vertex(corner));
            self.data.triangles.push(own);
            if let Some((_, source, offset)) = inputs.uvs.first() {
                let own = corners.map(|corner| {
                    let next = self.data.uvs.len() as u32;
                    *self.uvs.entry(corner[*offset]).or_insert_with(|| {
                        self.data.uvs.push(Vec2::from_array(source.vector(corner[*offset] as usize)));
                        next
                    })
                });
                self.data.triangle_uvs.push(own);
            }
            if let Some((source, offset)) = &inputs.normals {
                let own = corners.map(|corner| self.normal(source, corner[*offset], corner[inputs.positions.1]));
                let own = if own.contains(&NO_INDEX) { [NO_INDEX; 3] } else { own };
                self.data.triangle_normals.push(own);
            }
        }
    }

    /// Returns the vertex of a corner.
    fn vertex(&mut self, corner: &[u32]) -> u32 {
        let inputs = self.inputs;
        let second = inputs.uvs.get(1);
        let point = corner[inputs.positions.1];
        let key = [
            point,
            inputs.colors.as_ref().map_or(0, |(_, offset)| corner[*offset]),
            second.map_or(0, |(.., offset)| corner[*offset]),
        ];
        let next = self.data.positions.len() as u32;
        let number = *self.vertices.entry(key).or_insert(next);
        if number < next {
            return number;
        }
        let position = Vec3::from_array(inputs.positions.0.vector(point as usize));
        self.data.positions.push(self.skin.map_or(position, |skin| skin.moved(point as usize, position)));
        if let Some((_, source, offset)) = second {
            self.data.second_uvs.push(Vec2::from_array(source.vector(corner[*offset] as usize)));
        }
        if let Some((source, offset)) = &inputs.colors {
            let [r, g, b, a] = source.vector::<4>(corner[*offset] as usize);
            let rgb = super::shader::linear(Vec3::new(r, g, b), self.is_linear).max(Vec3::ZERO);
            let alpha = if source.width() < 4 { 1.0 } else { a.clamp(0.0, 1.0) };
            self.data.colors.push(rgb.extend(alpha).to_array());
        }
        number
    }

    /// Returns the index of a normal, which depends on the point if a skin turns it.
    fn normal(&mut self, source: &Source, index: u32, point: u32) -> u32 {
        let key = [index, if self.skin.is_some() { point } else { 0 }];
        if let Some(known) = self.normals.get(&key) {
            return *known;
        }
        let normal = Vec3::from_array(source.vector(index as usize));
        let normal = self.skin.map_or(normal, |skin| skin.turned(point as usize, normal));
        let number = match normal.try_normalize() {
            Some(normal) => {
                self.data.normals.push(normal);
                self.data.normals.len() as u32 - 1
            }
            None => NO_INDEX,
        };
        self.normals.insert(key, number);
        number
    }
}
