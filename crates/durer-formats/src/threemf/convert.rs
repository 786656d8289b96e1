//! Converts a model into a scene that contains meshes split by material, and components with their
//! transforms.

use super::model::{Mesh, Model, Object, ObjectRef, PropertyKind};
use super::package::Package;
use super::parser;
use crate::growth::MAX_OBJECTS;
use crate::pictures::asset;
use crate::shared_report::{SharedReport, suggest};
use crate::sticks::{ball, stick};
use durer_diag::Span;
use durer_scene::material::PrincipledMaterial;
use durer_scene::math::{Vec2, Vec3};
use durer_scene::scene::{self, Material, ObjectKind, PictureBytes, Scene, TextureImage};
use durer_scene::shape::MeshData;
use durer_scene::texture::{Mapping, Wrap};
use glam::DAffine3;
use std::collections::BTreeMap;
use std::rc::Rc;
use std::sync::Arc;

/// Maximum depth of nested objects, and maximum number of parts.
const MAX_DEPTH: u32 = 32;
const MAX_PARTS: usize = 4096;

/// Builder that converts the objects of a 3MF archive to a scene.
struct SceneMaker<'a> {
    package: Package<'a>,
    report: &'a SharedReport,
    models: BTreeMap<String, Option<Rc<Model>>>,
    /// Objects that have been converted, by part and id, each with the number of scene objects in
    /// it.
    converted: BTreeMap<(String, u32), (Rc<scene::Group>, usize)>,
    /// Material index for each texture resource, by part and id. The field after it is the material
    /// of meshes with vertex colours.
    pictures: BTreeMap<(String, u32), Option<u32>>,
    colored: Option<u32>,
    count: usize,
    scene: Scene,
}

/// Builds the scene of a 3MF package.
pub(super) fn scene(package: Package, report: &SharedReport) -> Option<Scene> {
    let root = package.root.clone();
    let at = Span { file: package.input.file, start: 0, end: 0 };
    let mut show = SceneMaker {
        package,
        report,
        models: BTreeMap::new(),
        converted: BTreeMap::new(),
        pictures: BTreeMap::new(),
        colored: None,
        count: 0,
        scene: Scene::default(),
    };
    let model = show.model(&root, at)?;
    let items = show.convert_refs(&root, &model.items, 0);
    show.scene.root = Some(scene::Group { objects: items });
    if show.count == 0 && !report.has_errors() {
        let warning = match model.items.is_empty() && !model.objects.is_empty() {
            true => durer_diag::Diagnostic::warning(format!(
                "the file shows none of its objects: `<build>` in `{root}` has no `<item>`"
            ))
            .help("add an item for each object, such as `<item objectid=\"1\"/>`"),
            false => durer_diag::Diagnostic::warning("the file has no visible shapes"),
        };
        report.push(warning.code("no-objects").at(at));
    }
    Some(show.scene)
}

impl SceneMaker<'_> {
    fn model(&mut self, part: &str, at: Span) -> Option<Rc<Model>> {
        if let Some(cached) = self.models.get(part) {
            return cached.clone();
        }
        if self.models.len() >= MAX_PARTS {
            self.report.error(at, format!("the archive has more than {MAX_PARTS} parts"));
            return None;
        }
        let model = parser::read(&mut self.package, part, at, self.report).map(Rc::new);
        self.models.insert(part.to_string(), model.clone());
        model
    }

    /// Converts the references to objects in build items or components.
    fn convert_refs(&mut self, part: &str, places: &[ObjectRef], depth: u32) -> Vec<scene::Object> {
        let mut objects = Vec::new();
        for place in places {
            let other = place.part.clone().unwrap_or(part.to_string());
            let Some((group, count)) = self.object(&other, place, depth) else { continue };
            self.count = self.count.saturating_add(count);
            if self.count > MAX_OBJECTS {
                let message =
                    format!("the model has more than {MAX_OBJECTS} objects, counting each use of a component");
                self.report.error(place.at, message);
                return objects;
            }
            let inner = scene::Object { node: ObjectKind::Group((*group).clone()), material: None, span: place.at };
            // Translations are measured in the unit of the part that contains the build item.
            let unit = self.models.get(part).and_then(Option::as_ref).map_or(1.0, |model| model.unit);
            objects.push(
                inner.transformed(DAffine3 { translation: unit * place.transform.translation, ..place.transform }),
            );
        }
        objects
    }

    /// Converts an object that a part contains. Each object is converted only once.
    fn object(&mut self, part: &str, place: &ObjectRef, depth: u32) -> Option<(Rc<scene::Group>, usize)> {
        let key = (part.to_string(), place.id);
        if let Some(cached) = self.converted.get(&key) {
            return Some(cached.clone());
        }
        if depth > MAX_DEPTH {
            self.report.error(
                place.at,
                format!("objects are nested more than {MAX_DEPTH} levels deep, or an object contains itself"),
            );
            return None;
        }
        let model = self.model(part, place.at)?;
        let Some((object, at)) = model.objects.get(&place.id) else {
            let ids: Vec<String> = model.objects.keys().map(u32::to_string).collect();
            let help = suggest(&place.id.to_string(), ids.iter().map(String::as_str));
            self.report.error_with_help(place.at, format!("object {} does not exist", place.id), help);
            return None;
        };
        let before = self.count;
        let objects = match object {
            Object::Mesh(mesh) => self.mesh((part, &model, place.id), mesh, *at),
            Object::Components(places) => self.convert_refs(part, places, depth + 1),
        };
        // The final count is added for each use of the object; see `convert_refs`.
        let count = (self.count - before).max(objects.len());
        self.count = before;
        let group = (Rc::new(scene::Group { objects }), count);
        self.converted.insert(key, group.clone());
        Some(group)
    }

    /// Converts the mesh of an object to one mesh for the triangles that have colours or no
    /// properties, and one mesh for each texture.
    fn mesh(&mut self, (part, model, id): (&str, &Model, u32), mesh: &Mesh, at: Span) -> Vec<scene::Object> {
        let unit = model.unit as f32;
        let property = |i: usize| {
            let own = mesh.properties.get(i).copied().flatten();
            own.or(mesh.default_property.map(|(list, index)| (list, [index; 3])))
        };
        // Triangles and the properties of their corners, grouped by texture; the group `None` has
        // no texture.
        let mut skins: BTreeMap<Option<u32>, MeshBuilder> = BTreeMap::new();
        for (i, triangle) in mesh.triangles.iter().enumerate() {
            let skin = |picture| (picture, [[1.0; 4]; 3], [Vec2::ZERO; 3]);
            let (picture, colors, uvs) = match property(i).map(|(list, at)| (model.properties.get(&list), at)) {
                Some((Some(properties), at)) => match &properties.group {
                    PropertyKind::Colors(colors) => {
                        let color = |k: u32| colors.get(k as usize).copied().unwrap_or([1.0; 4]);
                        (None, at.map(color), [Vec2::ZERO; 3])
                    }
                    PropertyKind::Texture { picture, uvs } => {
                        (Some(*picture), [[1.0; 4]; 3], at.map(|k| uvs.get(k as usize).copied().unwrap_or_default()))
                    }
                    PropertyKind::Picture { .. } => skin(None),
                },
                Some((None, _)) => {
                    let list = mesh.default_property.map_or(0, |default| default.0);
                    self.report.error(at, format!("no property list {list} is defined before this point"));
                    return Vec::new();
                }
                None => skin(None),
            };
            let [a, b, c] = *triangle;
            if a != b && b != c && c != a {
                skins.entry(picture).or_default().push(mesh, *triangle, colors, uvs, unit);
            }
        }
        let mut objects = Vec::new();
        for (picture, skin) in skins {
            let (material, name) = match picture {
                Some(picture) => (self.picture(part, model, picture, at), format!("{part}#{id}#{picture}")),
                None if skin.is_colored => (Some(self.colored()), format!("{part}#{id}")),
                None => (None, format!("{part}#{id}")),
            };
            let node = self.scene.add_mesh(&name, Arc::new(skin.finish(picture.is_some())), at);
            objects.push(scene::Object { node, material, span: at });
        }
        let mut ends: BTreeMap<u32, f32> = BTreeMap::new();
        for (corners, radii) in &mesh.beams {
            let [from, to] = corners.map(|i| unit * mesh.positions[i as usize]);
            let node = stick(from, to, radii.map(|radius| unit * radius));
            objects.extend(node.map(|node| scene::Object { node, material: None, span: at }));
            for (corner, radius) in corners.iter().zip(radii) {
                let end = ends.entry(*corner).or_default();
                *end = end.max(unit * radius);
            }
        }
        let balls = ends.into_iter().map(|(i, radius)| ball(unit * mesh.positions[i as usize], radius));
        objects.extend(balls.map(|node| scene::Object { node, material: None, span: at }));
        objects
    }

    /// Returns the material for meshes with vertex colours.
    fn colored(&mut self) -> u32 {
        let scene = &mut self.scene;
        *self.colored.get_or_insert_with(|| scene.add_material(Material::Principled(Box::new(plastic()))))
    }

    /// Returns the material that shows the texture of a resource.
    fn picture(&mut self, part: &str, model: &Model, id: u32, at: Span) -> Option<u32> {
        let key = (part.to_string(), id);
        if let Some(cached) = self.pictures.get(&key) {
            return *cached;
        }
        let Some(PropertyKind::Picture { part: name, styles, at: named }) = model.properties.get(&id).map(|p| &p.group)
        else {
            self.report.error(at, format!("`<texture2d>` {id} does not exist"));
            return None;
        };
        let bytes = self.package.bytes(name, *named);
        if bytes.is_none() && !self.report.has_errors() {
            self.report.error(*named, format!("the archive has no part `{name}`"));
        }
        let mut mapping = Mapping::default();
        for (wrap, style) in mapping.wrap.iter_mut().zip(styles) {
            *wrap = match style.as_deref().unwrap_or("wrap") {
                "mirror" => Wrap::Mirror,
                "clamp" | "none" => Wrap::Clamp,
                _ => Wrap::Repeat,
            };
        }
        let loaded = bytes.map(|bytes| {
            let picture = TextureImage { bytes: PictureBytes::Memory(name.clone(), bytes), mapping };
            let base_color_texture = Some(asset(&mut self.scene, picture, *named));
            self.scene
                .add_material(Material::Principled(Box::new(PrincipledMaterial { base_color_texture, ..plastic() })))
        });
        self.pictures.insert(key, loaded);
        loaded
    }
}

fn plastic() -> PrincipledMaterial {
    PrincipledMaterial { base_color: Vec3::ONE, specular_roughness: 0.4, ..PrincipledMaterial::default() }
}

/// Mesh that is being built from the triangles of one material; each corner has its own colour and
/// texture coordinates.
#[derive(Default)]
struct MeshBuilder {
    data: MeshData,
    is_colored: bool,
    known: BTreeMap<(u32, [u32; 4]), u32>,
}

impl MeshBuilder {
    fn push(&mut self, mesh: &Mesh, triangle: [u32; 3], colors: [[f32; 4]; 3], uvs: [Vec2; 3], unit: f32) {
        let data = &mut self.data;
        let mut corners = triangle;
        for (corner, color) in corners.iter_mut().zip(colors) {
            self.is_colored |= color != [1.0; 4];
            *corner = *self.known.entry((*corner, color.map(f32::to_bits))).or_insert_with(|| {
                data.positions.push(unit * mesh.positions[*corner as usize]);
                data.colors.push(color);
                data.positions.len() as u32 - 1
            });
        }
        data.triangles.push(corners);
        let first = data.uvs.len() as u32;
        data.triangle_uvs.push([first, first + 1, first + 2]);
        data.uvs.extend(uvs);
    }

    fn finish(self, pictured: bool) -> MeshData {
        let mut data = self.data;
        if !pictured {
            (data.uvs, data.triangle_uvs) = (Vec::new(), Vec::new());
        }
        if !self.is_colored {
            data.colors = Vec::new();
        }
        data.flat = true;
        data
    }
}
