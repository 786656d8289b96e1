//! From plugins to a scene.

use super::load::Loader;
use super::made::{Infinite, Made};
use super::plugin::{Key, Plugin, Property, Value};
use crate::bodies::join_bodies;
use crate::model::Input;
use crate::pictures::Pictures;
use crate::said::{Said, meant};
use crate::unscattered;
use durer_diag::{Diagnostic, Span};
use durer_scene::scene::{Group, Object, Scene};
use durer_scene::shape::MeshData;
use std::collections::{BTreeMap, HashSet};
use std::rc::Rc;
use std::sync::Arc;

/// Plugins in plugins, those counted to which others refer.
pub(super) const DEEPEST: u32 = 32;

/// A file on its way to a scene.
pub(super) struct Reader<'a> {
    pub input: &'a Input<'a>,
    pub said: &'a Said,
    pub loader: Loader<'a>,
    /// Materials by their plugins, and whether they are turned inside out.
    pub materials: BTreeMap<(Key, bool), Rc<Made>>,
    /// Numbers in the scene of materials with a light, with something inside, turned inside out.
    pub numbers: BTreeMap<([Option<Key>; 3], bool), Option<u32>>,
    /// Meshes of files, by name and how they are turned.
    pub meshes: BTreeMap<String, Option<Arc<MeshData>>>,
    /// What shape groups hold, and how many objects that is.
    pub groups: BTreeMap<Key, (Rc<Group>, usize)>,
    /// Whether the shape at hand is turned inside out: the index inside of its glass is outside.
    pub inside_out: bool,
    pub infinite: Option<Infinite>,
    /// Whether light that was scattered is not to be seen.
    pub emitters_only: bool,
    pub scene: Scene,
}

impl<'a> Reader<'a> {
    pub fn new(input: &'a Input<'a>, said: &'a Said, loader: Loader<'a>) -> Self {
        Reader {
            input,
            said,
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

    /// The scene of its plugins.
    pub fn read(mut self, all: &Plugin) -> Scene {
        let mut sensors = Vec::new();
        for (property, plugin) in self.parts(all, None) {
            if self.said.is_full() {
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
                // What nothing refers to has no place: it is not looked at.
                _ => {}
            }
        }
        self.camera(&sensors);
        self.surround();
        join_bodies(&mut self.scene, self.input.name);
        if self.emitters_only {
            unscattered::blacken(&mut self.scene);
        }
        if self.scene.root.is_none() && !self.said.has_errors() {
            let at = Span { end: all.at.start, ..all.at };
            let warning = Diagnostic::warning("the file has no shapes that can be shown");
            self.said.push(warning.code("no-objects").at(at));
        }
        self.scene
    }

    /// All plugins inside of one, of some tags and through such, each once. Nothing is told, and
    /// nothing counts as used.
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

    pub fn pictures(&self) -> Pictures<'a> {
        Pictures { input: self.input, said: self.said }
    }

    /// The plugins inside another, of a class or of all, in their order.
    pub fn parts<'p>(&self, plugin: &'p Plugin, class: Option<&str>) -> Vec<(&'p Property, Rc<Plugin>)> {
        let found = plugin.properties.iter().filter_map(|property| {
            let part = self.part(property)?;
            class.is_none_or(|class| part.class == class).then_some((property, part))
        });
        found.inspect(|(property, _)| property.used.set(true)).collect()
    }

    /// The plugin of the property of a name.
    pub fn named_part(&self, plugin: &Plugin, name: &'static str) -> Option<Rc<Plugin>> {
        plugin.get(name).and_then(|property| self.part(property))
    }

    /// The plugin of a property.
    pub fn part(&self, property: &Property) -> Option<Rc<Plugin>> {
        match &property.value {
            Value::Plugin(plugin) => Some(plugin.clone()),
            Value::Ref(id) => {
                let found = self.loader.plugins.get(id).cloned();
                if found.is_none() {
                    let help = meant(id, self.loader.plugins.keys().map(String::as_str));
                    let message = format!("there is nothing with the id `{id}`");
                    if !property.used.replace(true) {
                        self.said.bad_with(property.at, message, help);
                    }
                }
                found
            }
            _ => None,
        }
    }

    /// Whether this is too deep: plugins may refer to each other in a circle.
    pub fn too_deep(&self, depth: u32, at: Span) -> bool {
        if depth > DEEPEST {
            self.said.bad(at, format!("plugins are nested more than {DEEPEST} deep: does one refer to itself?"));
        }
        depth > DEEPEST
    }

    /// Whether so many objects more are allowed.
    pub fn room_for(&self, more: usize, at: Span) -> bool {
        self.loader.growth.has_objects(more, self.said, at)
    }

    /// Adds an object to others.
    pub fn add(&self, objects: &mut Vec<Object>, object: Object) {
        if self.room_for(1, object.span) {
            objects.push(object);
        }
    }
}
