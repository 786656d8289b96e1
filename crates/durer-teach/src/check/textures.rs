//! Checks textures: those that show only one value, normal maps that contain something else, and
//! objects that lack the texture coordinates.

use super::colors::phongs;
use super::finding::{Finding, MAX_FINDINGS, number as number_word};
use super::layers::{Layered, layers};
use super::scene_probe::SceneProbe;
use super::shapes::is_black;
use durer_diag::Diagnostic;
use durer_render::world::{Geometry, Material, Object, Principled};
use durer_scene::dialect::Quirk;
use durer_scene::material::parameters::TEXTURE_FIELDS;
use durer_scene::math::Vec3;
use durer_scene::texture::{Mapping, Texture};
use std::cell::Cell;

/// Differences below two steps of an 8-bit value count as rounding errors.
const GREY: f32 = 2.0 / 255.0;
/// Value in blue below which a texel of a normal map points into the surface, and fraction of such
/// texels above which the picture is no normal map.
const INWARDS: f32 = 0.45;
const MAX_INWARDS: f32 = 0.2;

/// Returns true if a mapping gives all points the same texture coordinates.
fn is_constant(mapping: &Mapping) -> bool {
    mapping.transform.iter().all(|row| row[..2] == [0.0, 0.0])
}

/// Returns the textures of a layered material, each with the field that names it.
pub(super) fn maps_of(principled: &Principled) -> Vec<(String, u32)> {
    let maps = &principled.maps;
    let own = [
        ("base_color_texture", maps.base_color),
        ("emission_texture", maps.emission),
        ("opacity_texture", maps.opacity),
        ("normal_texture", maps.normal),
        ("bump_texture", maps.bump),
    ];
    let own = own.into_iter().filter_map(|(field, map)| Some((field, map?)));
    let rest = maps.parameters.iter().map(|map| (TEXTURE_FIELDS[map.row].field, map.texture));
    own.chain(rest).map(|(field, map)| (in_camel_case(field), map)).collect()
}

/// Converts the name of a field in the code to that in a scene file.
fn in_camel_case(field: &str) -> String {
    let mut upper = false;
    let letter = |c: char| {
        let shown = if upper { c.to_ascii_uppercase() } else { c };
        upper = c == '_';
        (c != '_').then_some(shown)
    };
    field.chars().filter_map(letter).collect()
}

/// Reports textures that show a single colour. Either the image has only one colour, or all
/// vertices of a mesh have the same texture coordinates.
pub(super) fn flat_texture(scene_probe: &SceneProbe) -> Vec<Finding> {
    let world = scene_probe.world();
    let mut findings = Vec::new();
    for (number, material) in scene_probe.input.scene.materials.iter().enumerate().take(MAX_FINDINGS) {
        let Some(Material::Phong(phong)) = world.materials().get(number) else { continue };
        findings.extend(phong.principled.iter().filter_map(|own| uniform_parameter(scene_probe, number, own)));
        let Some(texture) = phong.texture.and_then(|texture| world.textures().get(texture as usize)) else { continue };
        let own = || world.objects().iter().filter(|object| object.material as usize == number);
        let is_still =
            |geometry: &Geometry| matches!(geometry, Geometry::Mesh(tree) if tree.mesh.constant_uv().is_some());
        let one_place = own().find(|object| is_still(&object.geometry));
        let invisible = "the texture is invisible";
        let (message, effect, help) = if scene_probe.material_rays()[number] == 0 {
            continue;
        } else if texture.is_flat() && is_black(texture) {
            (
                format!("the texture of material {number} is black everywhere"),
                "objects with this material are black",
                "check whether the image is the right one",
            )
        } else if texture.is_flat() {
            (
                format!("the texture of material {number} has only one colour"),
                invisible,
                "check whether the image is the right one",
            )
        } else if texture.mapping().is_some_and(is_constant) {
            (
                format!("the `uvTransform` of the texture of material {number} maps all points to one texel"),
                invisible,
                "write `uvTransform { 1 0 0  0 1 0 }`, which leaves texture coordinates unchanged",
            )
        } else if let Some(object) = one_place {
            let name = scene_probe.text(object.span);
            let message = format!("all vertices of the `{name}` have the same texture coordinates");
            (message, invisible, "export the texture coordinates of the mesh: the `vt` lines of its file are all equal")
        } else {
            continue;
        };
        let diagnostic = Diagnostic::warning(message).effect(effect).help(help);
        let fields = ["texture", "baseColorTexture"];
        findings.push(Finding::from(scene_probe.at_value(diagnostic, material.span, &fields)));
    }
    findings
}

/// Reports a texture of a parameter whose `texelRange` maps all texels to one value, and a texture
/// that makes the emission black.
fn uniform_parameter(scene_probe: &SceneProbe, number: usize, own: &Principled) -> Option<Finding> {
    let world = scene_probe.world();
    let span = scene_probe.input.scene.materials.get(number)?.span;
    let is_used = world.objects().iter().any(|object| object.material as usize == number);
    let finding = maps_of(own).into_iter().filter(|_| is_used).find_map(|(field, map)| {
        let texture = world.textures().get(map as usize)?;
        let [low, high] = texture.mapping().map_or([0.0, 1.0], |mapping| mapping.range);
        let diagnostic = if field == "emissionTexture" {
            let emits = own.definition.emission_luminance > 0.0 && is_black(texture);
            let message = format!("the `emissionTexture` of material {number} is black");
            emits.then(|| {
                Diagnostic::warning(message)
                    .effect("the material emits no light")
                    .help("use a picture that is bright where light is emitted, or remove the field")
            })?
        } else if low == high {
            let message = match scene_probe.model_format() {
                Some(_) => format!("a texture of material {number} has the value {} everywhere", number_word(low)),
                None => format!(
                    "the `texelRange` of the `{field}` of material {number} maps all texels to {}",
                    number_word(low)
                ),
            };
            Diagnostic::warning(message)
                .effect("the texture is invisible: its value is the same everywhere")
                .help("write `texelRange { 0 1 }`, which leaves the values of the picture unchanged")
        } else {
            return None;
        };
        Some(scene_probe.at_value(diagnostic, span, &[field.as_str()]))
    });
    finding.map(Finding::from)
}

/// Reports normal maps that are height maps, because red, green and blue are equal everywhere, or
/// pictures of colours, because the normals point into the surface.
pub(super) fn normal_maps(scene_probe: &SceneProbe) -> Vec<Finding> {
    let world = scene_probe.world();
    let is_grey = |[r, g, b]: [f32; 3]| (r - g).abs() < GREY && (g - b).abs() < GREY;
    let map = |number: usize| match world.materials().get(number)? {
        Material::Phong(phong) => world.textures().get(phong.principled.as_ref()?.maps.normal? as usize),
        Material::Mix(..) => None,
    };
    let say = |(number, material, _)| {
        let texture = map(number).filter(|_| scene_probe.material_rays()[number] > 0)?;
        let diagnostic = if texture.all_texels(is_grey) {
            Diagnostic::warning(format!("the normal map of material {number} is grey everywhere"))
                .effect("all normals point in nearly the same wrong direction, so surfaces are too dark or too bright")
                .help("use `bumpTexture` for a map of heights; a normal map is mostly light blue")
        } else {
            let share = inwards(texture).filter(|share| *share > MAX_INWARDS)?;
            let message = format!(
                "the normal map of material {number} is no normal map: {:.0} % of its normals point into the surface",
                100.0 * share
            );
            Diagnostic::warning(message)
                .effect("surfaces are shaded in wrong directions, so they have dark and bright specks")
                .help("a normal map is mostly light blue: use `baseColorTexture` for a picture of colours")
        };
        let span: &durer_scene::scene::Spanned<_> = material;
        Some(Finding::from(scene_probe.at_value(diagnostic, span.span, &["normalTexture"])))
    };
    layers(scene_probe).into_iter().filter_map(say).collect()
}

/// Returns the fraction of a normal map's texels that point into the surface.
fn inwards(texture: &Texture) -> Option<f32> {
    let (all, wrong) = (Cell::new(0u32), Cell::new(0u32));
    texture.all_texels(|[_, _, b]| {
        all.set(all.get().saturating_add(1));
        wrong.set(wrong.get() + u32::from(b < INWARDS));
        true
    });
    (all.get() > 0).then(|| wrong.get() as f32 / all.get() as f32)
}

/// Height of a bump map, as a fraction of the largest side of its object, above which it is
/// probably in another unit.
const MAX_BUMP: f32 = 0.2;

/// Reports bump maps whose heights are comparable to the sizes of their objects.
pub(super) fn high_bumps(scene_probe: &SceneProbe) -> Vec<Finding> {
    let objects = scene_probe.world().objects();
    let say = |(number, material, m): Layered| {
        m.bump_texture.as_ref().filter(|_| scene_probe.material_rays()[number] > 0)?;
        let own = objects.iter().filter(|object| object.material as usize == number);
        let sizes: Option<Vec<f32>> = own.map(|object| Some(object.bounds()?.size().max_element())).collect();
        let size = sizes?.into_iter().fold(0.0, f32::max);
        let height = number_word(m.bump_height);
        if m.bump_height.abs() <= MAX_BUMP * size {
            return None;
        }
        let diagnostic = Diagnostic::warning(format!(
            "the bumps of material {number} are {height} high, on objects {} wide",
            number_word(size)
        ))
        .effect("surfaces are shaded as if they were steep everywhere, in dark and bright spots")
        .help(format!(
            "`bumpHeight` is the difference in height between black and white, in units of the scene: try \
                     `bumpHeight {}`",
            number_word(0.005 * size)
        ));
        Some(Finding::from(scene_probe.at_value(diagnostic, material.span, &["bumpHeight", "bumpTexture"])))
    };
    if scene_probe.model_format().is_some() || !scene_probe.is_physical() {
        return Vec::new();
    }
    layers(scene_probe).into_iter().filter_map(say).collect()
}

/// Returns true if a mesh has a second set of texture coordinates.
fn has_second_set(object: &Object) -> bool {
    matches!(&object.geometry, Geometry::Mesh(tree) if tree.mesh.second_uv(0, Vec3::splat(1.0 / 3.0)).is_some())
}

/// Reports textured objects without the texture coordinates that the texture uses.
pub(super) fn no_coordinates(scene_probe: &SceneProbe) -> Vec<Finding> {
    let (world, meshes_only) = (scene_probe.world(), scene_probe.world().rules().has(Quirk::MeshTextures));
    let textured = phongs(scene_probe).filter(|(_, _, phong)| phong.texture.is_some());
    let mut findings = Vec::new();
    for (i, material, phong) in textured {
        let map = phong.texture.and_then(|texture| world.textures().get(texture as usize)?.mapping());
        let second = map.is_some_and(|mapping| mapping.second);
        let lacks = |object: u32, has_uv: bool| match second {
            true => !has_second_set(&world.objects()[object as usize]),
            false => !has_uv,
        };
        let bare = scene_probe.hits().find(|(_, hit)| hit.material == i && lacks(hit.object, hit.has_uv));
        if let Some((_, hit)) = bare {
            let name = scene_probe.object(hit.object);
            let what = if second { "no second set of texture coordinates" } else { "no texture coordinates" };
            let model = scene_probe.model_format().is_some();
            let diagnostic = Diagnostic::warning(format!("material {i} has a texture, but the {name} has {what}"))
                .related(scene_probe.object_span(hit.object), "uses the material")
                .effect(match phong.principled {
                    _ if model => "the texture is invisible; the plain colour of the material is used instead",
                    Some(_) => "the texture is invisible; `baseColor` is used instead",
                    None => "the texture is invisible; `diffuseColor` is used instead",
                })
                .help(match (&world.objects()[hit.object as usize].geometry, meshes_only) {
                    _ if second => "remove `uvSet 1` from the texture, which then uses the first set",
                    (Geometry::Mesh(_), _) => "add `vt` lines to the mesh file, and write faces as `f 1/1 2/2 3/3`",
                    (_, true) => {
                        "this year's program shows textures on meshes only: use a `TriangleMesh` with `vt` lines"
                    }
                    (_, false) => "use a shape with texture coordinates, or a `TriangleMesh` with `vt` lines",
                });
            let fields = ["texture", "baseColorTexture"];
            findings.push(Finding::from(scene_probe.at_value(diagnostic, material.span, &fields)));
        }
    }
    findings
}
