//! Converts plugins to a Dürer scene.

use super::defs::{InfiniteLight, MaterialDef};
use super::load::Loader;
use super::plugin::{Key, Plugin, Property, Value};
use crate::emitters_only;
use crate::glass_bodies::join_bodies;
use crate::model::ReadInput;
use crate::pictures::Pictures;
use crate::shared_report::{SharedReport, suggest};
use durer_diag::{Diagnostic, Span};
use durer_scene::scene::{Group, Object, Scene};
use durer_scene::shape::MeshData;
use std::collections::{BTreeMap, HashSet};
use std::rc::Rc;
use std::sync::Arc;

/// Maximum depth of nested plugins, including plugins that are nested by reference.
pub(super) const MAX_DEPTH: u32 = 32;

/// Keys of the plugins of a material, and two flags of the shape that uses it.
type MaterialKey = ([Option<Key>; 3], [bool; 2]);

/// Reader that converts the plugins of a Mitsuba scene to a Dürer scene.
pub(super) struct Reader<'a> {
    pub input: &'a ReadInput<'a>,
    pub report: &'a SharedReport,
    pub loader: Loader<'a>,
    /// Converted materials by plugin. The flag is true if the shape that uses the material is
    /// turned inside out.
    pub materials: BTreeMap<(Key, bool), Rc<MaterialDef>>,
    /// Indices of materials in the scene, by the plugins of the material, the light and the
    /// interior medium, and by `inside_out` and `hides_backs` of the shape.
    pub material_indices: BTreeMap<MaterialKey, Option<u32>>,
    /// Meshes by file name and by the changes that were applied to them.
    pub meshes: BTreeMap<String, Option<Arc<MeshData>>>,
    /// Contents of shape groups, with the number of objects in each group.
    pub groups: BTreeMap<Key, (Rc<Group>, usize)>,
    /// True if the current shape is turned inside out, so that the interior index of refraction of
    /// its glass applies outside it.
    pub inside_out: bool,
    /// True if rays pass through the current shape from behind, as they do in Mitsuba's curves.
    pub hides_backs: bool,
    pub infinite: Option<InfiniteLight>,
    pub scene: Scene,
}

impl<'a> Reader<'a> {
    pub fn new(input: &'a ReadInput<'a>, report: &'a SharedReport, loader: Loader<'a>) -> Self {
        Reader {
            input,
            report,
            loader,
            materials: BTreeMap::new(),
            material_indices: BTreeMap::new(),
            meshes: BTreeMap::new(),
            groups: BTreeMap::new(),
            inside_out: false,
            hides_backs: false,
            infinite: None,
            scene: Scene::default(),
        }
    }

    /// Converts all plugins to a Dürer scene.
    pub fn read(mut self, all: &Plugin) -> Scene {
        let mut sensors = Vec::new();
        for (property, plugin) in self.child_plugins(all, None) {
            if self.report.is_full() {
                break;
            }
            property.used.set(true);
            match plugin.element.as_str() {
                "shape" => {
                    let mut objects = Vec::new();
                    self.shape(&plugin, &mut objects, 0);
                    self.scene.root.get_or_insert_default().objects.extend(objects);
                }
                "emitter" => self.emitter(&plugin),
                "sensor" => sensors.push(plugin),
                "integrator" => self.integrator(&plugin, 0),
                // Ignore plugins that have no effect on their own, such as materials. Shapes refer
                // to these plugins.
                _ => {}
            }
        }
        self.camera(&sensors);
        self.set_environment();
        join_bodies(&mut self.scene, self.input.name);
        if self.scene.render_defaults.no_scattering.is_some() {
            emitters_only::blacken(&mut self.scene);
        }
        if self.scene.root.is_none() && !self.report.has_errors() {
            let at = Span { end: all.at.start, ..all.at };
            let warning = Diagnostic::warning("the file has no visible shapes");
            self.report.push(warning.code("no-objects").at(at));
        }
        self.scene
    }

    /// Returns every plugin of the given classes that is connected to a plugin by a chain of
    /// plugins of these classes. This function does not report anything, and does not mark any
    /// property as used.
    pub fn reachable(&self, plugin: &Plugin, classes: &[&str]) -> Vec<Rc<Plugin>> {
        let part = |property: &Property| match &property.value {
            Value::Plugin(part) => Some(part.clone()),
            Value::Ref(id) => self.loader.plugins.get(id).cloned(),
            _ => None,
        };
        let parts = |plugin: &Plugin| -> Vec<Rc<Plugin>> {
            let parts = plugin.properties.iter().filter_map(part);
            parts.filter(|part| classes.contains(&part.element.as_str())).collect()
        };
        let (mut seen, mut plugins, mut left) = (HashSet::new(), Vec::new(), parts(plugin));
        while let Some(part) = left.pop() {
            if seen.insert(part.key()) {
                left.extend(parts(&part));
                plugins.push(part);
            }
        }
        plugins
    }

    /// Returns a reader for the pictures that the scene names.
    pub fn pictures(&self) -> Pictures<'a> {
        Pictures { input: self.input, report: self.report }
    }

    /// Returns the child plugins in the order of the file. If `class` is given, returns only those
    /// of that class.
    pub fn child_plugins<'p>(&self, plugin: &'p Plugin, class: Option<&str>) -> Vec<(&'p Property, Rc<Plugin>)> {
        let plugins = plugin.properties.iter().filter_map(|property| {
            let part = self.child_plugin(property)?;
            class.is_none_or(|class| part.element == class).then_some((property, part))
        });
        plugins.inspect(|(property, _)| property.used.set(true)).collect()
    }

    /// Returns the plugin that is the value of a named property.
    pub fn named_plugin(&self, plugin: &Plugin, name: &'static str) -> Option<Rc<Plugin>> {
        plugin.get(name).and_then(|property| self.child_plugin(property))
    }

    /// Returns the plugin that is the value of a property.
    pub fn child_plugin(&self, property: &Property) -> Option<Rc<Plugin>> {
        match &property.value {
            Value::Plugin(plugin) => Some(plugin.clone()),
            Value::Ref(id) => {
                let plugins = self.loader.plugins.get(id).cloned();
                if plugins.is_none() {
                    let help = suggest(id, self.loader.plugins.keys().map(String::as_str));
                    let message = format!("no plugin has the id `{id}`");
                    if !property.used.replace(true) {
                        self.report.error_with_help(property.at, message, help);
                    }
                }
                plugins
            }
            _ => None,
        }
    }

    /// Reports an error and returns true if plugins are nested more than [`MAX_DEPTH`] levels deep,
    /// for example because they refer to each other in a cycle.
    pub fn too_deep(&self, depth: u32, at: Span) -> bool {
        if depth > MAX_DEPTH {
            self.report.error(
                at,
                format!("plugins are nested more than {MAX_DEPTH} levels deep, or a plugin refers to itself"),
            );
        }
        depth > MAX_DEPTH
    }

    /// Counts `more` additional objects. If the limit is exceeded, reports an error and returns
    /// false.
    pub fn count_objects(&self, more: usize, at: Span) -> bool {
        self.loader.limits.count_objects_or_report(more, self.report, at)
    }

    /// Adds an object to a list.
    pub fn add(&self, objects: &mut Vec<Object>, object: Object) {
        if self.count_objects(1, object.span) {
            objects.push(object);
        }
    }
}
