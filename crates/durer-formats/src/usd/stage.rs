//! Composition: the prims of a scene from the opinions of all its layers.
//!
//! Each prim has a list of sites, which are places in layers that hold opinions about it, strongest
//! first: the prim itself, what it inherits, its selected variants, its references and payloads,
//! and what it specializes. The sites of a child are the children of its parent's sites, each
//! followed by what the child's own arcs add there.
//!
//! Source: *OpenUSD specification*, "Composition" (strength order LIVRPS). Opinions that a stronger
//! layer has about a class of a referenced layer are left out.

use super::files::{LayerFiles, joined};
use super::layer::{
    Layer, ListEdit, PrimSpec, Property, RETIMED, Reference, Specifier, Value, child_path, variant_path,
};
use durer_diag::{Diagnostic, Span, did_you_mean};
use std::cell::{Cell, RefCell};
use std::collections::{BTreeMap, BTreeSet};
use std::rc::Rc;

/// Maximum number of arcs between a prim and an opinion about it.
const MAX_ARCS: usize = 64;
/// Maximum number of sites in a scene.
const MAX_SITES: usize = 1 << 22;
/// Maximum number of sublayers of a layer.
const MAX_LAYERS: usize = 256;

/// Layer with its sublayers, strongest first.
type Stack = Rc<Vec<Rc<Layer>>>;

/// Translation of paths in a layer to paths in the scene.
#[derive(Debug)]
struct PathMap {
    from: String,
    to: String,
    /// Translation of paths that do not begin with `from`.
    outer: Option<Rc<PathMap>>,
}

impl PathMap {
    fn apply(&self, path: &str) -> Option<String> {
        let rest = match self.from.as_str() {
            "/" => Some(path),
            from => path.strip_prefix(from).filter(|rest| rest.is_empty() || rest.starts_with(['/', '.'])),
        };
        match (rest, &self.outer) {
            (Some(rest), _) if self.to == "/" => Some(rest.to_string()),
            (Some(rest), _) => Some(format!("{}{}", self.to, if rest == "/" { "" } else { rest })),
            (None, Some(outer)) => outer.apply(path),
            (None, None) => None,
        }
    }
}

/// Place in a stack of layers that holds opinions about a prim.
#[derive(Clone, Debug)]
struct Site {
    stack: Stack,
    path: String,
    map: Rc<PathMap>,
}

/// Composed prim of the scene.
#[derive(Clone, Debug)]
pub(super) struct Prim {
    /// Path in the scene.
    pub path: String,
    sites: Vec<Site>,
}

/// Opinion about a property: the property, and the layer that names it.
pub(super) struct Opinion {
    pub value: Value,
    /// Fields such as `interpolation`.
    pub metadata: BTreeMap<String, Value>,
    /// Name of the layer, relative to which the value names files.
    pub layer: String,
    pub span: Span,
}

/// Scene that is composed of layers.
pub(super) struct Stage<'a> {
    pub files: &'a LayerFiles<'a>,
    /// The root layer.
    pub root_layer: Rc<Layer>,
    root: Prim,
    stacks: RefCell<BTreeMap<String, Option<Stack>>>,
    site_count: Cell<usize>,
    /// Variant that the user chose: `variant`, or `set=variant`.
    wanted_variant: Option<&'a str>,
    /// Variants that exist, and whether the user's choice was among them.
    variants: RefCell<BTreeSet<String>>,
    found_variant: Cell<bool>,
}

/// Removes the selected variants from a path.
fn without_variants(path: &str) -> String {
    let mut plain = String::with_capacity(path.len());
    for (i, part) in path.split('{').enumerate() {
        match (i, part.split_once('}')) {
            (0, _) => plain.push_str(part),
            (_, Some((_, rest))) if rest.is_empty() || rest.starts_with(['/', '.']) => plain.push_str(rest),
            (_, Some((_, rest))) => {
                plain.push('/');
                plain.push_str(rest);
            }
            (_, None) => {}
        }
    }
    plain
}

impl<'a> Stage<'a> {
    /// Opens the scene whose root layer is given.
    pub fn open(files: &'a LayerFiles<'a>, root_layer: Layer, wanted_variant: Option<&'a str>) -> Self {
        let root_layer = Rc::new(root_layer);
        let mut stage = Stage {
            files,
            root_layer: root_layer.clone(),
            root: Prim { path: "/".into(), sites: Vec::new() },
            stacks: RefCell::default(),
            site_count: Cell::new(0),
            wanted_variant,
            variants: RefCell::default(),
            found_variant: Cell::new(false),
        };
        let mut layers = Vec::new();
        stage.add_layers(root_layer, &mut layers, &mut Vec::new());
        let map = Rc::new(PathMap { from: "/".into(), to: "/".into(), outer: None });
        stage.root.sites = vec![Site { stack: Rc::new(layers), path: "/".into(), map }];
        stage
    }

    /// Returns the pseudo-root, which is the parent of the outermost prims.
    pub fn root(&self) -> Prim {
        self.root.clone()
    }

    /// Returns the prim at a path, or `None` if there is none.
    pub fn prim(&self, path: &str) -> Option<Prim> {
        let mut names = path.strip_prefix('/')?.split('/').filter(|name| !name.is_empty());
        names.try_fold(self.root(), |prim, name| self.child(&prim, name))
    }

    /// Returns the children of a prim that are defined and active.
    pub fn children(&self, prim: &Prim) -> Vec<Prim> {
        let mut names: Vec<&String> = Vec::new();
        let mut known = BTreeSet::new();
        for (spec, _, _) in prim.specs().collect::<Vec<_>>().into_iter().rev() {
            names.extend(spec.children.iter().filter(|name| known.insert(name.as_str())));
        }
        let children = names.into_iter().filter_map(|name| self.child(prim, name));
        children.filter(|child| child.is_defined() && child.flag("active") != Some(false)).collect()
    }

    /// Returns a child of a prim.
    pub fn child(&self, prim: &Prim, name: &str) -> Option<Prim> {
        let path = child_path(&prim.path, name);
        let mut sites = Vec::new();
        for parent in &prim.sites {
            let site = Site { path: child_path(&parent.path, name), ..parent.clone() };
            self.expand(site, &path, &mut sites, &mut Vec::new());
        }
        (!sites.is_empty()).then_some(Prim { path, sites })
    }

    /// Adds a site and all that its arcs lead to. `chain` contains the sites that lead here.
    fn expand(&self, site: Site, prim: &str, sites: &mut Vec<Site>, chain: &mut Vec<(usize, String)>) {
        let specs: Vec<(Rc<Layer>, PrimSpec)> =
            site.stack.iter().filter_map(|layer| Some((layer.clone(), layer.prims.get(&site.path)?.arcs()))).collect();
        let Some((_, first)) = specs.first() else { return };
        let (at, report) = (first.span, self.files.report);
        let key = (Rc::as_ptr(&site.stack).addr(), site.path.clone());
        if chain.contains(&key) {
            return report.error(at, format!("`{}` refers to itself through references or inheritance", site.path));
        }
        self.site_count.set(self.site_count.get() + 1);
        if chain.len() >= MAX_ARCS || self.site_count.get() > MAX_SITES {
            if !report.has_errors() {
                report.error(at, "the layers refer to each other too often");
            }
            return;
        }
        chain.push(key);
        let own = sites.len();
        sites.push(site.clone());
        let to = site.map.apply(&without_variants(&site.path)).unwrap_or_else(|| prim.to_string());
        let classes = |field: fn(&PrimSpec) -> &ListEdit<String>| {
            let mut paths = Vec::new();
            specs.iter().rev().for_each(|(_, spec)| field(spec).apply(&mut paths));
            paths
        };
        let class = |path: String| {
            let outer = Some(site.map.clone());
            let map = PathMap { from: path.clone(), to: to.clone(), outer };
            Site { stack: site.stack.clone(), path, map: Rc::new(map) }
        };
        for path in classes(|spec| &spec.inherits) {
            self.expand(class(path), prim, sites, chain);
        }
        self.expand_variants(&site, &specs, prim, (sites, own), chain);
        for field in [|spec: &PrimSpec| spec.references.clone(), |spec: &PrimSpec| spec.payloads.clone()] {
            // Each reference is relative to the layer that contains it.
            let mut all: Vec<Reference> = Vec::new();
            for (layer, spec) in specs.iter().rev() {
                field(spec).of_layer(&layer.name).apply(&mut all);
            }
            for reference in all {
                let Some((stack, path)) = self.target(&site, &reference, at) else { continue };
                self.check_times(&site.stack, &stack, reference.is_retimed, at);
                let map = PathMap { from: path.clone(), to: to.clone(), outer: None };
                self.expand(Site { stack, path, map: Rc::new(map) }, prim, sites, chain);
            }
        }
        for path in classes(|spec| &spec.specializes) {
            self.expand(class(path), prim, sites, chain);
        }
        chain.pop();
    }

    /// Adds the selected variants of a site.
    fn expand_variants(
        &self,
        site: &Site,
        specs: &[(Rc<Layer>, PrimSpec)],
        prim: &str,
        (sites, own): (&mut Vec<Site>, usize),
        chain: &mut Vec<(usize, String)>,
    ) {
        let mut sets: BTreeMap<String, Vec<String>> = BTreeMap::new();
        for (set, names) in specs.iter().flat_map(|(_, spec)| &spec.variants) {
            sets.entry(set.clone()).or_default().extend(names.iter().cloned());
        }
        for (set, names) in sets {
            self.variants.borrow_mut().extend(names.iter().map(|name| format!("{set}={name}")));
            let by_user = self.wanted_variant.and_then(|wanted| {
                let (of_set, name) = wanted.split_once('=').unwrap_or((&set, wanted));
                (of_set == set && names.iter().any(|known| known == name)).then(|| name.to_string())
            });
            if by_user.is_some() {
                self.found_variant.set(true);
            }
            // The strongest selection counts, wherever it is.
            let selection = |site: &Site| {
                let specs = site.stack.iter().filter_map(|layer| layer.prims.get(&site.path));
                specs.filter_map(|spec| spec.selections.get(&set)).next().cloned()
            };
            let chosen = by_user.or_else(|| sites[..=own].iter().chain(&sites[own..]).find_map(selection));
            if let Some(name) = chosen.filter(|name| names.contains(name)) {
                let path = variant_path(&site.path, &set, &name);
                self.expand(Site { path, ..site.clone() }, prim, sites, chain);
            }
        }
    }

    /// Reports an error if the user chose a variant that does not exist.
    pub fn check_variant(&self) {
        let Some(wanted) = self.wanted_variant.filter(|_| !self.found_variant.get()) else { return };
        let known = self.variants.borrow();
        let names = known.iter().map(String::as_str);
        let short = known.iter().filter_map(|name| name.split_once('=')).map(|(_, name)| name);
        let help = match did_you_mean(wanted, names.chain(short)) {
            Some(similar) => format!("did you mean `{similar}`?"),
            None if known.is_empty() => "the scene has no variants".into(),
            None => format!("the variants are {}", known.iter().take(20).cloned().collect::<Vec<_>>().join(", ")),
        };
        let error = Diagnostic::error(format!("the scene has no variant `{wanted}`")).code("no-variant");
        self.files.report.push(error.help(help));
    }

    /// Warns of animations of a referenced layer that have other times than those of the scene.
    fn check_times(&self, from: &Stack, to: &Stack, is_retimed: bool, at: Span) {
        let rate = |stack: &Stack| stack.first().map_or(24.0, |layer| layer.time_codes_per_second());
        if is_retimed || rate(from) != rate(to) {
            self.report_times(at);
        }
    }

    fn report_times(&self, at: Span) {
        // Without a requested time, scenes are usually read for their pose.
        if self.files.input.scene_defaults.animation_time.is_none() {
            return;
        }
        let message = "times of layers that are moved or scaled have no counterpart: animations there keep their own \
                       time codes";
        self.files.report.unsupported_once(at, message);
    }

    /// Returns the stack and path that a reference names. Its file is relative to the scene's
    /// folder.
    fn target(&self, site: &Site, reference: &Reference, at: Span) -> Option<(Stack, String)> {
        let stack = match reference.asset.is_empty() {
            true => site.stack.clone(),
            false if reference.asset.ends_with(".mtlx") => {
                self.files
                    .report
                    .unsupported_once(at, "materials in MaterialX files have no counterpart: they are left out");
                return None;
            }
            false => self.stack(&reference.asset, at)?,
        };
        if !reference.prim.is_empty() {
            return Some((stack, reference.prim.clone()));
        }
        let first = stack.first()?;
        let default = first.field("defaultPrim").and_then(Value::text).map(str::to_string);
        let Some(default) = default.or_else(|| first.prims.get("/")?.children.first().cloned()) else {
            let warning = format!("the layer `{}` has no prim, so a reference to it is left out", first.name);
            self.files.report.unsupported_once(at, warning);
            return None;
        };
        Some((stack, child_path("/", default.trim_start_matches('/'))))
    }

    /// Returns a layer with its sublayers; `None` if it cannot be read.
    fn stack(&self, name: &str, at: Span) -> Option<Stack> {
        if let Some(known) = self.stacks.borrow().get(name) {
            return known.clone();
        }
        let stack = self.files.layer(name, at).map(|layer| {
            let mut layers = Vec::new();
            self.add_layers(Rc::new(layer), &mut layers, &mut Vec::new());
            Rc::new(layers)
        });
        self.stacks.borrow_mut().insert(name.to_string(), stack.clone());
        stack
    }

    /// Adds a layer and its sublayers to a stack. `chain` contains the names of the layers above
    /// it.
    fn add_layers(&self, layer: Rc<Layer>, layers: &mut Vec<Rc<Layer>>, chain: &mut Vec<String>) {
        let at = layer.prims.get("/").map_or(Span::default(), |root| root.span);
        let names = match layer.field("subLayers") {
            Some(Value::Texts(names)) => names.clone(),
            _ => Vec::new(),
        };
        if layer.field(RETIMED) == Some(&Value::Bool(true)) {
            self.report_times(at);
        }
        let (folder, rate) = (layer.name.clone(), layer.time_codes_per_second());
        chain.push(folder.clone());
        layers.push(layer);
        for name in names {
            let name = joined(&folder, &name);
            if layers.len() >= MAX_LAYERS || chain.contains(&name) {
                self.files
                    .report
                    .error(at, format!("`{name}` is a sublayer of itself, or there are too many sublayers"));
                return;
            }
            if let Some(sublayer) = self.files.layer(&name, at) {
                if sublayer.time_codes_per_second() != rate {
                    self.report_times(at);
                }
                self.add_layers(Rc::new(sublayer), layers, chain);
            }
        }
        chain.pop();
    }
}

impl PrimSpec {
    /// Returns a copy of the arcs, without properties and children.
    fn arcs(&self) -> PrimSpec {
        PrimSpec {
            references: self.references.clone(),
            payloads: self.payloads.clone(),
            inherits: self.inherits.clone(),
            specializes: self.specializes.clone(),
            variants: self.variants.clone(),
            span: self.span,
            ..PrimSpec::default()
        }
    }
}

impl ListEdit<Reference> {
    /// Replaces the files of references, which are relative to a layer, by names in the scene's
    /// folder, so that the edits of different layers can be compared.
    fn of_layer(&self, layer: &str) -> ListEdit<Reference> {
        let named = |one: &Reference| match one.asset.is_empty() {
            true => one.clone(),
            false => Reference { asset: joined(layer, &one.asset), ..one.clone() },
        };
        let all = |list: &Vec<Reference>| list.iter().map(named).collect();
        ListEdit {
            explicit: self.explicit.as_ref().map(all),
            prepended: all(&self.prepended),
            appended: all(&self.appended),
            deleted: all(&self.deleted),
        }
    }
}

impl Prim {
    /// Returns the opinions about the prim, strongest first.
    fn specs(&self) -> impl Iterator<Item = (&PrimSpec, &Layer, &Site)> {
        self.sites.iter().flat_map(|site| {
            site.stack.iter().filter_map(move |layer| Some((layer.prims.get(&site.path)?, &**layer, site)))
        })
    }

    /// Returns the name of the prim.
    pub fn name(&self) -> &str {
        self.path.rsplit('/').next().unwrap_or_default()
    }

    /// Returns the type of the prim, or an empty string.
    pub fn type_name(&self) -> &str {
        self.specs().map(|(spec, ..)| spec.type_name.as_str()).find(|name| !name.is_empty()).unwrap_or_default()
    }

    /// Returns the position of the strongest opinion.
    pub fn span(&self) -> Span {
        self.specs().next().map_or(Span::default(), |(spec, ..)| spec.span)
    }

    fn is_defined(&self) -> bool {
        let specifier = self.specs().map(|(spec, ..)| spec.specifier).find(|specifier| *specifier != Specifier::Over);
        specifier == Some(Specifier::Def)
    }

    /// Returns a truth value in the metadata.
    pub fn flag(&self, name: &str) -> Option<bool> {
        self.specs().find_map(|(spec, ..)| spec.metadata.get(name)?.boolean())
    }

    /// Returns the numbers of a metadata field.
    pub fn numbers_of(&self, name: &str) -> Vec<f64> {
        self.specs().find_map(|(spec, ..)| Some(spec.metadata.get(name)?.numbers().to_vec())).unwrap_or_default()
    }

    /// True if an API schema is applied to the prim.
    pub fn has_api(&self, schema: &str) -> bool {
        let mut schemas = Vec::new();
        for (spec, ..) in self.specs().collect::<Vec<_>>().into_iter().rev() {
            spec.api_schemas.apply(&mut schemas);
        }
        schemas.iter().any(|known| known == schema)
    }

    /// Returns the names of all properties.
    pub fn property_names(&self) -> BTreeSet<&str> {
        self.specs().flat_map(|(spec, ..)| spec.properties.keys().map(String::as_str)).collect()
    }

    /// Returns the strongest value of an attribute at the stage's time.
    pub fn get(&self, stage: &Stage, name: &str) -> Option<Opinion> {
        let time = stage.files.time.get();
        let mut opinions = self.specs().filter_map(|(spec, layer, _)| Some((spec.properties.get(name)?, layer)));
        let (value, property, layer) =
            opinions.find_map(|(property, layer)| Some((property.at(time)?, property, layer)))?;
        if value == Value::Blocked {
            return None;
        }
        // Metadata may be in a weaker layer than the value.
        let weaker = self.specs().filter_map(|(spec, ..)| spec.properties.get(name));
        let mut metadata = property.metadata.clone();
        weaker.for_each(|property| {
            property.metadata.iter().for_each(|(key, value)| {
                metadata.entry(key.clone()).or_insert_with(|| value.clone());
            })
        });
        Some(Opinion { value, metadata, layer: layer.name.clone(), span: property.span })
    }

    /// Returns the text of a metadata field of a property.
    pub fn field_of(&self, property: &str, name: &str) -> Option<String> {
        let fields = self.specs().filter_map(|(spec, ..)| spec.properties.get(property)?.metadata.get(name));
        fields.filter_map(Value::text).next().map(str::to_string)
    }

    /// Returns the numbers of an attribute; empty if it has none.
    pub fn numbers(&self, stage: &Stage, name: &str) -> Vec<f64> {
        self.get(stage, name).map_or(Vec::new(), |opinion| opinion.value.numbers().to_vec())
    }

    /// Returns the texts of an array; empty if the attribute is no array of texts.
    pub fn texts(&self, stage: &Stage, name: &str) -> Vec<String> {
        match self.get(stage, name).map(|opinion| opinion.value) {
            Some(Value::Texts(texts)) => texts,
            _ => Vec::new(),
        }
    }

    /// Returns the targets of a relationship, or the connections of an attribute, as paths in the
    /// scene.
    pub fn targets(&self, name: &str) -> Vec<String> {
        let mut targets = Vec::new();
        let properties = self.specs().filter_map(|(spec, _, site)| Some((spec.properties.get(name)?, site)));
        for (property, site) in properties.collect::<Vec<(&Property, &Site)>>().into_iter().rev() {
            let map = |list: &Vec<String>| -> Vec<String> {
                list.iter().filter_map(|path| site.map.apply(&without_variants(&absolute(path, &site.path)))).collect()
            };
            let ListEdit { explicit, prepended, appended, deleted } = &property.targets;
            let edit = ListEdit {
                explicit: explicit.as_ref().map(map),
                prepended: map(prepended),
                appended: map(appended),
                deleted: map(deleted),
            };
            edit.apply(&mut targets);
        }
        targets
    }

    /// Returns a key that is equal for prims whose properties come from the same places, such as
    /// the copies of an instanced mesh.
    pub fn key(&self) -> String {
        let sites = self.sites.iter().filter(|site| {
            let specs = site.stack.iter().filter_map(|layer| layer.prims.get(&site.path));
            specs.into_iter().any(|spec| !spec.properties.is_empty())
        });
        let parts = sites.map(|site| format!("{}<{}>", site.stack.first().map_or("", |layer| &layer.name), site.path));
        parts.collect::<Vec<_>>().join(" ")
    }
}

/// Returns a path relative to a prim as an absolute path.
fn absolute(path: &str, prim: &str) -> String {
    if path.starts_with('/') {
        return path.to_string();
    }
    let plain = without_variants(prim);
    let mut parts: Vec<&str> = plain.split('/').collect();
    let mut rest = path;
    while let Some(tail) = rest.strip_prefix("..") {
        parts.pop();
        rest = tail.trim_start_matches('/');
    }
    format!("{}/{rest}", parts.join("/"))
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn paths_are_translated() {
        let map = |from: &str, to: &str| PathMap { from: from.into(), to: to.into(), outer: None };
        assert_eq!(map("/Model", "/World/Chair").apply("/Model/Looks/Red").unwrap(), "/World/Chair/Looks/Red");
        assert_eq!(map("/Model", "/World/Chair").apply("/Model").unwrap(), "/World/Chair");
        assert!(map("/Model", "/World/Chair").apply("/Models/Red").is_none());
        assert_eq!(map("/", "/").apply("/A/B").unwrap(), "/A/B");
        assert_eq!(without_variants("/A{color=red}B{x=y}/C.p"), "/A/B/C.p");
        assert_eq!(absolute("../Looks/Red", "/A/B"), "/A/Looks/Red");
    }
}
