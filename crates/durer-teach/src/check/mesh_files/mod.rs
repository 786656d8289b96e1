//! The meshes of a scene and the objects that use them.

pub(super) mod normals;
pub(super) mod topology;

use crate::check::finding::vector;
use crate::check::lines::lines;
use crate::check::probes::ProbeGrid;
use durer_diag::{Diagnostic, Diagnostics, Span};
use durer_formats::read_mesh;
use durer_render::world::{Material, Object as CompiledObject};
use durer_scene::camera::Projection;
use durer_scene::describe::FileName;
use durer_scene::math::{Aabb, Vec3};
use durer_scene::scene::{Object, ObjectKind, Scene};
use durer_scene::shape::MeshData;
use normals::InvalidNormals;
use topology::Topology;

/// Size in bytes above which a mesh file is skipped so that the checks remain interactive.
const MAX_BYTES: usize = 64 << 20;
/// Fraction of reversed triangles or triangles with wrong normals that is ignored because modelling
/// programs often leave a few.
const NEGLIGIBLE: f32 = 0.002;

/// A mesh file of the checked scene, with its topology, its irregular normals and the objects that
/// use it.
#[derive(Debug)]
pub(in crate::check) struct MeshFile<'s> {
    pub(super) name: &'s FileName,
    /// Index of the file in the scene's [`Files`](durer_diag::Files), or `u32::MAX` for a mesh of a
    /// model.
    pub(super) file: u32,
    pub(super) objects: Vec<&'s Object>,
    pub(super) data: MeshData,
    pub(super) topology: Topology,
    /// Triangles whose normals in the file are wrong, or `None` if the dialect ignores normals in
    /// files.
    pub(super) odd_normals: Option<InvalidNormals>,
}

/// Part of a mesh that points inwards: the order of the vertices of its triangles, the normals in
/// its file, or both.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(in crate::check) enum Inwards {
    Triangles,
    Normals,
    Both,
}

/// Returns all mesh files of a scene.
pub(in crate::check) fn files<'s>(grid: &ProbeGrid<'s>) -> Vec<MeshFile<'s>> {
    uses(grid.input.scene).into_iter().filter_map(|(name, objects)| read(grid, name, objects)).collect()
}

/// Maximum number of triangles for which a mesh in a model is checked.
const MAX_MODEL: usize = 300_000;

/// Returns the meshes of a scene that was read from a model file.
pub(in crate::check) fn models<'s>(grid: &ProbeGrid<'s>) -> Vec<MeshFile<'s>> {
    let meshes = &grid.input.scene.assets.meshes;
    let own = |(name, objects): (&'s FileName, Vec<&'s Object>)| {
        let data = meshes.get(&name.path).filter(|data| data.triangles.len() <= MAX_MODEL)?;
        Some(MeshFile::new(grid, name, u32::MAX, objects, MeshData::clone(data)))
    };
    uses(grid.input.scene).into_iter().filter_map(own).collect()
}

fn is_obj(name: &str) -> bool {
    name.to_ascii_lowercase().ends_with(".obj")
}

/// Mesh files of a scene, each with the objects that use it.
type Uses<'s> = Vec<(&'s FileName, Vec<&'s Object>)>;

fn uses(scene: &Scene) -> Uses<'_> {
    let mut uses = Uses::new();
    for object in scene.objects() {
        let ObjectKind::Mesh(mesh) = &object.node else { continue };
        match uses.iter_mut().find(|(name, _)| name.path == mesh.obj_file.path) {
            Some((_, objects)) => objects.push(object),
            None => uses.push((&mesh.obj_file, vec![object])),
        }
    }
    uses
}

fn read<'s>(grid: &ProbeGrid<'s>, name: &'s FileName, objects: Vec<&'s Object>) -> Option<MeshFile<'s>> {
    let files = grid.input.files;
    let file = (0..).take_while(|&i| files.name(i).is_some()).find(|&i| files.name(i) == Some(&name.path))?;
    let bytes = files.complete_bytes(file).filter(|bytes| bytes.len() <= MAX_BYTES)?;
    // The loader has already reported errors in the file.
    let data = read_mesh(bytes, file, &name.path, &mut Diagnostics::default())?;
    Some(MeshFile::new(grid, name, file, objects, data))
}

impl<'s> MeshFile<'s> {
    fn new(grid: &ProbeGrid, name: &'s FileName, file: u32, objects: Vec<&'s Object>, data: MeshData) -> Self {
        let topology = Topology::of(&data.positions, &data.triangles);
        let odd_normals = InvalidNormals::of(&data).filter(|_| grid.world().rules().file_normals);
        MeshFile { name, file, objects, data, topology, odd_normals }
    }
}

impl MeshFile<'_> {
    /// Returns true if the bad triangles are too small a fraction of the mesh to be reported.
    pub(super) fn is_negligible(&self, count: usize) -> bool {
        count == 0 || (count as f32) <= NEGLIGIBLE * self.data.triangles.len() as f32
    }

    /// Returns the line in an OBJ file that contains the face to which a triangle belongs. A face
    /// with n vertices has n - 2 triangles.
    pub(super) fn face(&self, grid: &ProbeGrid, triangle: u32) -> Option<Span> {
        let bytes = grid.input.files.bytes(self.file)?;
        let (mut before, mut found) = (0, None);
        for (span, line) in lines(bytes, self.file) {
            if line.starts_with(b"f ") || line.starts_with(b"f\t") {
                let corners = line.split(u8::is_ascii_whitespace).filter(|word| !word.is_empty()).count() - 1;
                let here = before..before + corners.saturating_sub(2);
                if here.contains(&(triangle as usize)) {
                    found = Some(span);
                }
                before = here.end;
            }
        }
        found.filter(|_| before == self.data.triangles.len())
    }

    /// Returns the line of an OBJ file that contains the vertex at a position.
    pub(super) fn vertex(&self, grid: &ProbeGrid, position: Vec3) -> Option<Span> {
        let file = if self.file == u32::MAX { self.name.span.file } else { self.file };
        let bytes = grid.input.files.bytes(file).filter(|_| grid.input.files.name(file).is_some_and(is_obj))?;
        let is_there = |line: &[u8]| {
            let text = str::from_utf8(line).unwrap_or_default().trim();
            let mut words = text.strip_prefix("v ").unwrap_or_default().split_ascii_whitespace();
            let numbers = [(); 3].map(|()| words.next().and_then(|word| word.parse::<f32>().ok()));
            numbers == position.to_array().map(Some)
        };
        lines(bytes, file).find(|(_, line)| is_there(line)).map(|(span, _)| span)
    }

    /// Places a warning about triangles at the first of them, or at the place where the scene names
    /// the file.
    pub(super) fn at_triangle(&self, grid: &ProbeGrid, diagnostic: Diagnostic, triangle: u32) -> Diagnostic {
        let corners = self.data.triangles[triangle as usize].map(|i| self.data.positions[i as usize]);
        match self.face(grid, triangle) {
            // The file of a model does not name itself.
            Some(span) if span.file == self.name.span.file => diagnostic.at(span).label("the first of them"),
            Some(span) => {
                diagnostic.at(span).label("the first of them").related(self.name.span, "the mesh is used here")
            }
            None => {
                let corners = corners.map(vector).join(", ");
                diagnostic.at(self.name.span).label(format!("triangle {triangle} is the first: {corners}"))
            }
        }
    }

    /// Returns the first glass object that uses the mesh.
    pub(super) fn glass(&self, grid: &ProbeGrid) -> Option<&Object> {
        let materials = grid.world().materials();
        let refracts = |material: u32| match materials.get(material as usize) {
            Some(Material::Phong(phong)) => phong.transparent.max_element() > 0.0 && phong.ior != 1.0,
            _ => false,
        };
        self.objects.iter().find(|object| object.material.is_some_and(refracts)).copied()
    }

    /// Iterates over the compiled objects that use the mesh.
    pub(super) fn compiled_objects<'w>(&self, grid: &ProbeGrid<'w>) -> impl Iterator<Item = &'w CompiledObject> {
        grid.world().objects().iter().filter(|object| self.is_used_at(object.span))
    }

    /// Returns true if the object at `span` in the scene file uses the mesh.
    pub(super) fn is_used_at(&self, span: Span) -> bool {
        self.objects.iter().any(|object| object.span.start == span.start)
    }

    /// Returns true if the camera is inside the mesh, for example in a room whose walls face
    /// inwards.
    pub(super) fn is_room(&self, grid: &ProbeGrid) -> bool {
        let eye = grid.world().camera().pose().center;
        self.compiled_objects(grid).filter_map(CompiledObject::bounds).any(|bounds| bounds.contains(eye))
    }

    /// Returns true if the mesh is the inner wall of a hollow glass object and therefore faces
    /// inwards.
    pub(super) fn is_hollow(&self, grid: &ProbeGrid) -> bool {
        let objects = grid.world().objects();
        let holds = |outer: &Aabb, inner: &Aabb| outer.contains(inner.min) && outer.contains(inner.max);
        self.compiled_objects(grid).filter_map(|object| Some((object, object.bounds()?))).any(|(inner, bounds)| {
            let around = |other: &CompiledObject| {
                other.span.start != inner.span.start && other.bounds().is_some_and(|outer| holds(&outer, &bounds))
            };
            self.glass(grid).is_some() && objects.iter().any(|other| other.material == inner.material && around(other))
        })
    }

    /// Returns what points inwards in a mesh that is inside out.
    pub(super) fn inwards(&self) -> Inwards {
        match &self.odd_normals {
            None => Inwards::Triangles,
            Some(normals) if normals.is_against_all() => Inwards::Normals,
            Some(_) => Inwards::Both,
        }
    }

    /// Returns true if the mesh is closed and its normals point inwards.
    pub(super) fn is_inside_out(&self) -> bool {
        let Topology { reversed: turned, volume, .. } = &self.topology;
        let against = self.odd_normals.as_ref().is_some_and(InvalidNormals::is_against_all);
        let has_area = self.topology.degenerate.len() < self.data.triangles.len();
        has_area
            && self.topology.is_nearly_closed()
            && turned.is_empty()
            && *volume != 0.0
            && (*volume < 0.0) != against
    }
}
