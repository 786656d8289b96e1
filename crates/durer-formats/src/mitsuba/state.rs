//! Converts plugins to a scene.

use super::defs::{InfiniteLight, MaterialDef};
use super::load::Loader;
use super::plugin::{Key, Plugin, Property, Value};
use crate::bodies::join_bodies;
use crate::model::Input;
use crate::pictures::Pictures;
use crate::shared_report::{SharedReport, suggest};
use crate::unscattered;
use durer_diag::{Diagnostic, Span};
use durer_scene::scene::{Group, Object, Scene};
use durer_scene::shape::MeshData;
use std::collections::{BTreeMap, HashSet};
use std::rc::Rc;
use std::sync::Arc;

/// Maximum depth of nested plugins, counting references.
pub(super) const DEEPEST: u32 = 32;

/// Reader that converts the plugins of a Mitsuba scene to a Dürer scene.
pub(super) struct Reader<'a> {
    pub input: &'a Input<'a>,
    pub report: &'a SharedReport,
    pub loader: Loader<'a>,
    /// Converted materials by plugin; the flag is true if their shape is turned inside out.
    pub materials: BTreeMap<(Key, bool), Rc<MaterialDef>>,
    /// Material indices in the scene, by the plugins of the material, the light and the interior
    /// medium. The flag is true if the shape is turned inside out.
    pub numbers: BTreeMap<([Option<Key>; 3], bool), Option<u32>>,
    /// Meshes by file name and by the changes made to them.
    pub meshes: BTreeMap<String, Option<Arc<MeshData>>>,
    /// Contents of shape groups, with their number of objects.
    pub groups: BTreeMap<Key, (Rc<Group>, usize)>,
    /// True if the current shape is turned inside out, so that the interior index of its glass is
    /// on the outside.
    pub inside_out: bool,
    pub infinite: Option<InfiniteLight>,
    /// True if scattered light is not rendered (`max_depth` below 2).
    pub emitters_only: bool,
    pub scene: Scene,
}

impl<'a> Reader<'a> {
    pub fn new(input: &'a Input<'a>, report: &'a SharedReport, loader: Loader<'a>) -> Self {
        Reader {
            input,
            report,
            loader,
            materials: BTreeMap::new(),
            numbers: BTreeMap::new(),
            meshes: BTreeMap::new(),
            groups: BTreeMap::new(),
            inside_out: false,
            infinite: None,
            emitters_only: false,
            scene: Scene::default(),
        }
    }

    /// Converts all plugins to a scene.
    pub fn read(mut self, all: &Plugin) -> Scene {
        let mut sensors = Vec::new();
        for (property, plugin) in self.parts(all, None) {
            if self.report.is_full() {
                break;
            }
            property.used.set(true);
            match plugin.class.as_str() {
                "shape" => {
                    let mut objects = Vec::new();
                    self.shape(&plugin, &mut objects, 0);
                    self.scene.root.get_or_insert_default().objects.extend(objects);
                }
                "emitter" => self.emitter(&plugin),
                "sensor" => sensors.push(plugin),
                "integrator" => self.integrator(&plugin, 0),
                // Ignore plugins that have no effect on their own, such as materials. Shapes refer
                // to them.
                _ => {}
            }
        }
        self.camera(&sensors);
        self.surround();
        join_bodies(&mut self.scene, self.input.name);
        if self.emitters_only {
            unscattered::blacken(&mut self.scene);
        }
        if self.scene.root.is_none() && !self.report.has_errors() {
            let at = Span { end: all.at.start, ..all.at };
            let warning = Diagnostic::warning("the file has no visible shapes");
            self.report.push(warning.code("no-objects").at(at));
        }
        self.scene
    }

    /// Returns each plugin of the given classes that can be reached from a plugin through plugins
    /// of these classes. Reports nothing, and does not mark anything as used.
    pub fn reachable(&self, plugin: &Plugin, classes: &[&str]) -> Vec<Rc<Plugin>> {
        let part = |property: &Property| match &property.value {
            Value::Plugin(part) => Some(part.clone()),
            Value::Ref(id) => self.loader.plugins.get(id).cloned(),
            _ => None,
        };
        let parts = |plugin: &Plugin| -> Vec<Rc<Plugin>> {
            let parts = plugin.properties.iter().filter_map(part);
            parts.filter(|part| classes.contains(&part.class.as_str())).collect()
        };
        let (mut seen, mut found, mut left) = (HashSet::new(), Vec::new(), parts(plugin));
        while let Some(part) = left.pop() {
            if seen.insert(part.key()) {
                left.extend(parts(&part));
                found.push(part);
            }
        }
        found
    }

    /// Returns a reader for pictures that the scene names.
    pub fn pictures(&self) -> Pictures<'a> {
        Pictures { input: self.input, report: self.report }
    }

    /// Returns the child plugins in file order; `class` selects one class.
    pub fn parts<'p>(&self, plugin: &'p Plugin, class: Option<&str>) -> Vec<(&'p Property, Rc<Plugin>)> {
        let found = plugin.properties.iter().filter_map(|property| {
            let part = self.part(property)?;
            class.is_none_or(|class| part.class == class).then_some((property, part))
        });
        found.inspect(|(property, _)| property.used.set(true)).collect()
    }

    /// Returns the plugin that is the value of a named property.
    pub fn named_part(&self, plugin: &Plugin, name: &'static str) -> Option<Rc<Plugin>> {
        plugin.get(name).and_then(|property| self.part(property))
    }

    /// Returns the plugin that is the value of a property.
    pub fn part(&self, property: &Property) -> Option<Rc<Plugin>> {
        match &property.value {
            Value::Plugin(plugin) => Some(plugin.clone()),
            Value::Ref(id) => {
                let found = self.loader.plugins.get(id).cloned();
                if found.is_none() {
                    let help = suggest(id, self.loader.plugins.keys().map(String::as_str));
                    let message = format!("no plugin has the id `{id}`");
                    if !property.used.replace(true) {
                        self.report.bad_with(property.at, message, help);
                    }
                }
                found
            }
            _ => None,
        }
    }

    /// Returns true and reports an error if plugins are nested more than [`DEEPEST`] levels deep,
    /// for example because they refer to each other in a cycle.
    pub fn too_deep(&self, depth: u32, at: Span) -> bool {
        if depth > DEEPEST {
            self.report
                .bad(at, format!("plugins are nested more than {DEEPEST} levels deep: does one refer to itself?"));
        }
        depth > DEEPEST
    }

    /// Counts `more` objects; returns false and reports an error if the limit is exceeded.
    pub fn room_for(&self, more: usize, at: Span) -> bool {
        self.loader.growth.has_objects(more, self.report, at)
    }

    /// Adds an object to a list.
    pub fn add(&self, objects: &mut Vec<Object>, object: Object) {
        if self.room_for(1, object.span) {
            objects.push(object);
        }
    }
}
