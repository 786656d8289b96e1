//! Checks for definitions and materials that are never used, and names materials in findings.

use super::finding::{Finding, counted};
use super::scene_probe::SceneProbe;
use durer_diag::{Diagnostic, Severity, Span};
use durer_formats::course::place::{name, values};
use durer_render::world::{Geometry, Material};
use durer_scene::dialect::Dialect;
use durer_scene::material::Pattern as _;
use durer_scene::scene::ObjectKind;

/// Reports `define` statements whose names are never used.
pub(super) fn unused_define(scene_probe: &SceneProbe) -> Vec<Finding> {
    // Definitions in included files form a library and do not have to be used.
    let file = scene_probe.input.scene.camera_span.file;
    let Some(bytes) = scene_probe.input.files.bytes(file) else { return Vec::new() };
    let files = (0..).map_while(|i| scene_probe.input.files.bytes(i).map(|bytes| (i, bytes)));
    let used: Vec<String> =
        files.flat_map(|(i, bytes)| values(bytes, i, "use")).map(|span| scene_probe.text(span)).collect();
    let defined = values(bytes, file, "define");
    let unused: Vec<&Span> = defined.iter().filter(|span| !used.contains(&scene_probe.text(**span))).collect();
    let say = |span: &&Span| {
        let name = scene_probe.text(**span);
        let mut diagnostic = Diagnostic::note(format!("`{name}` is defined and never used"))
            .at(**span)
            .effect("the object is not in the picture: `define` only gives it a name")
            .help(format!("write `use {name}` in the `Group` where the object should appear"));
        // If none of the definitions is used, that is probably a mistake.
        if unused.len() == defined.len() {
            diagnostic.severity = Severity::Warning;
        }
        let empty = scene_probe.world().objects().is_empty() && diagnostic.severity == Severity::Warning;
        Finding::from(diagnostic).affecting_whole_picture(empty)
    };
    unused.iter().map(say).collect()
}

/// Reports materials that no object uses.
pub(super) fn unused_material(scene_probe: &SceneProbe) -> Vec<Finding> {
    let unused = unused_materials(scene_probe);
    let material = &scene_probe.input.scene.materials;
    let Some(&first) = unused.first() else { return Vec::new() };
    let label = |number: &usize| material_name(scene_probe, *number).unwrap_or_else(|| number.to_string());
    let list: Vec<String> = unused.iter().take(8).map(label).collect();
    let message = match unused.len() {
        1 => format!("no object uses material {first}"),
        n => format!("no object uses {}: {}", counted(n, "material", "materials"), list.join(", ")),
    };
    let diagnostic = Diagnostic::note(message)
        .at(material[first].span)
        .effect("unused materials have no effect on the picture")
        .help(match scene_probe.input.dialect {
            Dialect::F23 => "check the `index` of each `Component<Material>`: indices start at 0",
            _ if material_name(scene_probe, first).is_some() => "check the name after each `MaterialIndex`",
            _ => "check each `MaterialIndex`: indices start at 0",
        });
    vec![Finding::from(diagnostic)]
}

/// Returns the name of a material in the scene language, in backquotes, if it has one.
pub(super) fn material_name(scene_probe: &SceneProbe, number: usize) -> Option<String> {
    let material = scene_probe.input.scene.materials.get(number).filter(|_| scene_probe.model_format().is_none())?;
    let bytes = scene_probe.input.files.bytes(material.span.file)?;
    Some(format!("`{}`", scene_probe.text(name(bytes, material.span)?)))
}

/// Replaces the numbers of materials that have a name in the texts of a finding.
pub(super) fn name_materials(scene_probe: &SceneProbe, mut finding: Finding) -> Finding {
    let named = |text: &mut String| {
        let mut from = 0;
        while let Some(at) = text[from..].find("material ").map(|at| from + at + "material ".len()) {
            let digits = text[at..].bytes().take_while(u8::is_ascii_digit).count();
            let number = text[at..at + digits].parse().ok();
            let name = number.and_then(|number| material_name(scene_probe, number));
            match name {
                Some(name) => text.replace_range(at..at + digits, &name),
                // In a model, a number says nothing.
                None if digits > 0 && scene_probe.model_format().is_some() => {
                    text.replace_range(at - "material ".len()..at + digits, "this material");
                }
                None => {}
            }
            from = at.min(text.len());
        }
    };
    let diagnostic = &mut finding.diagnostic;
    named(&mut diagnostic.message);
    diagnostic.effect.iter_mut().chain(&mut diagnostic.help).for_each(named);
    finding
}

/// Returns the numbers of the materials that no object uses.
pub(super) fn unused_materials(scene_probe: &SceneProbe) -> Vec<usize> {
    let world = scene_probe.world();
    let mut used = vec![false; world.materials().len()];
    for object in world.objects() {
        match &object.geometry {
            Geometry::Solid(solid) => solid.parts().for_each(|part| used[part.material as usize] = true),
            _ => used[object.material as usize] = true,
        }
    }
    // A mix refers only to materials that precede it, so the loop runs backwards.
    for i in (0..world.materials().len()).rev() {
        if let (Material::Mix(solid, ..), true) = (&world.materials()[i], used[i]) {
            solid.materials().into_iter().for_each(|part| used[part as usize] = true);
        }
    }
    // Empty solids have no compiled parts.
    for object in scene_probe.input.scene.objects() {
        let of_parts = matches!(object.node, ObjectKind::Group(_) | ObjectKind::Transform(..) | ObjectKind::Solid(..));
        if let Some(used) = object.material.filter(|_| !of_parts).and_then(|material| used.get_mut(material as usize)) {
            *used = true;
        }
    }
    (0..scene_probe.input.scene.materials.len()).filter(|&i| !used[i]).collect()
}
