//! Tests of the source structure. Crates use only crates of lower layers, the modules of a folder
//! have no cyclic dependencies, and files are small.

use std::collections::{BTreeMap, BTreeSet};
use std::fs;
use std::path::{Path, PathBuf};
use syn::{Item, UseTree};

/// The crates in each layer, as in ARCHITECTURE.md. A crate may use only crates of lower layers.
const LAYERS: [&[&str]; 10] = [
    &["durer-bvh", "durer-diag", "durer-photo"],
    &["durer-image"],
    &["durer-scene"],
    &["durer-formats", "durer-render"],
    &["durer-gpu", "durer-teach"],
    &["durer"],
    &["durer-session"],
    &["durer-live", "durer-wasm"],
    &["durer-cli"],
    &["xtask"],
];

/// The only dependency that is used solely by tests. The tests read scene texts.
const FOR_TESTS: (&str, &str) = ("durer-render", "durer-formats");

fn root() -> PathBuf {
    Path::new(env!("CARGO_MANIFEST_DIR")).join("../..")
}

fn folder_of(name: &str) -> PathBuf {
    if name == "xtask" { root().join(name) } else { root().join("crates").join(name) }
}

fn layer(name: &str) -> Option<usize> {
    LAYERS.iter().position(|crates| crates.contains(&name))
}

/// Returns the crates of this workspace that are listed in the `[dependencies]` of a Cargo.toml
/// file.
fn dependencies(manifest: &str) -> Vec<String> {
    let mut section = "";
    let mut found = Vec::new();
    for line in manifest.lines() {
        if line.starts_with('[') {
            section = line.trim();
        } else if section == "[dependencies]" {
            let name = line.split(['.', '=', ' ']).next().unwrap_or("");
            found.extend(Some(name.to_string()).filter(|name| name.starts_with("durer")));
        }
    }
    found
}

#[test]
fn crates_use_only_lower_layers() {
    for (own, crates) in LAYERS.iter().enumerate() {
        for name in *crates {
            let manifest = fs::read_to_string(folder_of(name).join("Cargo.toml")).unwrap();
            for other in dependencies(&manifest) {
                let below = layer(&other).unwrap_or_else(|| panic!("{other} has no layer"));
                let for_tests = (*name, &other[..]) == FOR_TESTS;
                assert!(below < own || for_tests, "{name} may not use {other}");
            }
        }
    }
}

fn files(folder: &Path, found: &mut Vec<PathBuf>) {
    for entry in fs::read_dir(folder).unwrap() {
        let path = entry.unwrap().path();
        if path.is_dir() {
            files(&path, found);
        } else if path.extension().is_some_and(|extension| extension == "rs") {
            found.push(path);
        }
    }
}

/// Path of a module from the root of its crate, as a list of names.
type Module = Vec<String>;

/// Returns the source files of a crate by module path from the root of the crate. Tests are not
/// included.
fn modules(source: &Path) -> BTreeMap<Module, PathBuf> {
    let mut all = Vec::new();
    files(source, &mut all);
    let module = |path: PathBuf| {
        let relative = path.strip_prefix(source).unwrap().with_extension("");
        let mut module: Module = relative.iter().map(|part| part.to_string_lossy().into_owned()).collect();
        if module == ["lib"] || module == ["main"] || module.last().is_some_and(|last| last == "mod") {
            module.pop();
        }
        (module, path)
    };
    let is_test = |module: &Module| module.iter().any(|part| part.contains("test"));
    all.into_iter().map(module).filter(|(module, _)| !is_test(module)).collect()
}

/// Flattens a `use` tree into paths, which are lists of segments.
fn paths(tree: &UseTree, before: &mut Module, found: &mut Vec<Module>) {
    match tree {
        UseTree::Path(path) => {
            before.push(path.ident.to_string());
            paths(&path.tree, before, found);
            before.pop();
        }
        UseTree::Group(group) => group.items.iter().for_each(|tree| paths(tree, before, found)),
        UseTree::Name(name) => found.push([&before[..], &[name.ident.to_string()]].concat()),
        UseTree::Rename(name) => found.push([&before[..], &[name.ident.to_string()]].concat()),
        _ => found.push(before.clone()),
    }
}

/// Returns the module of this crate to which a `use` path in the module `own` refers. Returns
/// `None` for paths to other crates.
fn target(path: &[String], own: &Module, modules: &BTreeMap<Module, PathBuf>) -> Option<Module> {
    let (mut at, rest) = match path[0].as_str() {
        "crate" => (Vec::new(), &path[1..]),
        "self" => (own.clone(), &path[1..]),
        "super" => (own.clone(), path),
        first => (own.clone(), modules.contains_key(&[&own[..], &[first.into()]].concat()).then_some(path)?),
    };
    for segment in rest {
        if segment == "super" {
            at.pop();
            continue;
        }
        at.push(segment.clone());
        if !modules.contains_key(&at) {
            at.pop();
            break;
        }
    }
    Some(at)
}

/// Returns the dependencies between the modules of each folder. The `mod.rs` of a folder is
/// excluded, because it declares the files of the folder and they use it.
fn arrows(source: &Path) -> BTreeMap<Module, BTreeMap<String, BTreeSet<String>>> {
    let modules = modules(source);
    let mut arrows: BTreeMap<Module, BTreeMap<String, BTreeSet<String>>> = BTreeMap::new();
    for (own, path) in &modules {
        let text = fs::read_to_string(path).unwrap();
        let file = syn::parse_file(&text).unwrap_or_else(|error| panic!("{}: {error}", path.display()));
        let mut found = Vec::new();
        for item in &file.items {
            if let Item::Use(item) = item {
                paths(&item.tree, &mut Vec::new(), &mut found);
            }
        }
        for other in found.iter().filter_map(|path| target(path, own, &modules)) {
            let shared = own.iter().zip(&other).take_while(|(a, b)| a == b).count();
            if shared < own.len() && shared < other.len() {
                let folder = arrows.entry(own[..shared].to_vec()).or_default();
                folder.entry(own[shared].clone()).or_default().insert(other[shared].clone());
            }
        }
    }
    arrows
}

/// Returns the modules of a folder that depend on themselves through other modules of the folder.
fn in_circles(arrows: &BTreeMap<String, BTreeSet<String>>) -> Vec<&String> {
    let reaches_itself = |start: &String| {
        let mut seen = BTreeSet::new();
        let mut waiting = vec![start];
        while let Some(at) = waiting.pop() {
            for next in arrows.get(at).into_iter().flatten() {
                if next == start {
                    return true;
                }
                if seen.insert(next) {
                    waiting.push(next);
                }
            }
        }
        false
    };
    arrows.keys().filter(|name| reaches_itself(name)).collect()
}

#[test]
fn modules_have_no_cyclic_dependencies() {
    let mut count = 0;
    for name in LAYERS.concat() {
        for (folder, arrows) in arrows(&folder_of(name).join("src")) {
            count += arrows.values().map(BTreeSet::len).sum::<usize>();
            let circle = in_circles(&arrows);
            assert!(circle.is_empty(), "{name}, {}: {circle:?} depend on each other in a cycle", folder.join("::"));
        }
    }
    assert!(count > 500, "only {count} dependencies were found");
}

#[test]
fn cycle_is_found() {
    let arrow = |from: &str, to: &str| (from.to_string(), BTreeSet::from([to.to_string()]));
    let arrows = BTreeMap::from([arrow("a", "b"), arrow("b", "c"), arrow("c", "b"), arrow("d", "a")]);
    assert_eq!(in_circles(&arrows), ["b", "c"]);
}

#[test]
fn files_stay_small() {
    let mut sizes = Vec::new();
    for name in LAYERS.concat() {
        let mut all = Vec::new();
        files(&folder_of(name).join("src"), &mut all);
        sizes.extend(all.into_iter().map(|path| (fs::read_to_string(&path).unwrap().lines().count(), path)));
    }
    sizes.sort();
    let (median, ninth, largest) = (sizes.len() / 2, sizes.len() * 9 / 10, sizes.len() - 1);
    assert!(sizes[median].0 <= 150, "median {:?}", sizes[median]);
    assert!(sizes[ninth].0 <= 400, "nine in ten {:?}", sizes[ninth]);
    assert!(sizes[largest].0 <= 600, "largest {:?}", sizes[largest]);
}
