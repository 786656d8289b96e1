//! The table of checks, in the order in which findings are reported: causes come before their
//! consequences.

use super::finding::Finding;
use super::scene_probe::SceneProbe;
use super::{
    area_lights, attenuation, beams, clipping, colors, exposure, extent, facing, fine_textures, fog, hidden,
    idle_layers, integrator, invisible, layers, lens, lights, mesh, metals, names, numbers, objects, optics,
    pattern_border, patterns, physical, quadrics, quirks, room, secondary, solid, strays, textures, transforms, view,
};

/// A kind of finding, with its stable code and the function that searches for it. Each is a row of
/// [`CHECKS`].
#[derive(Clone, Copy, Debug)]
pub struct Check {
    /// Stable code.
    pub code: &'static str,
    /// Short description, as listed by `durer check --codes`.
    pub about: &'static str,
    /// Runs the check. The function returns nothing for codes that the reader or the compiler
    /// reports.
    pub(super) find: fn(&SceneProbe) -> Vec<Finding>,
}

fn reported(_: &SceneProbe) -> Vec<Finding> {
    Vec::new()
}

macro_rules! checks {
    ($($code:literal: $about:literal, $find:expr;)+) => {
        /// All kinds of findings, in the order in which they are reported.
        pub const CHECKS: &[Check] = &[$(Check { code: $code, about: $about, find: $find },)+];
    };
}

checks! {
    // The reader and the compiler report these.
    "syntax": "a word or number that cannot be parsed", reported;
    "unknown-word": "a word that is not allowed at its position", reported;
    "unclosed-block": "a missing brace", reported;
    "extra-brace": "an extra brace", reported;
    "missing-field": "a missing field", reported;
    "bad-value": "a value that a field does not allow", reported;
    "wrong-count": "a `numObjects`, `numLights` or `numMaterials` that differs from the actual number", reported;
    "flat-transform": "a transform that flattens space", reported;
    "no-camera": "no camera", reported;
    "missing-file": "a mesh or image that does not exist", reported;
    "bad-file": "a mesh or image that cannot be used", reported;
    "open-solid": "a part of a solid that is not closed", reported;
    "no-objects": "a scene without objects", view::no_objects;
    "repeated": "a section or field that appears twice", reported;
    "bad-place": "a statement in a place where it has no effect", reported;
    // The camera.
    "far-origin": "a scene so far from the origin that single precision cannot resolve its shapes", lens::far_origin;
    "epsilon": "a scene smaller than the distance at which this year's program starts shadow rays", lens::below_epsilon;
    "camera-inside": "a camera inside an object", view::inside;
    "clipped": "clip distances that cut away everything in the picture", clipping::clipped;
    "camera-away": "a camera that looks past everything", view::looks_elsewhere;
    "up-parallel": "a camera whose `up` is parallel to its `direction`", reported;
    "stray-points": "a few vertices of a mesh far away from all others", strays::stray_points;
    "too-small": "objects that together are too small in the picture", extent::too_small;
    "too-narrow": "a picture that shows a tiny part of the scene", extent::too_narrow;
    "no-surface": "a quadric whose equation has no real solution", quadrics::no_surface;
    "empty-solid": "an empty solid or grid", objects::empty_solid;
    "idle-part": "a part of a solid without effect", solid::part_without_effect;
    "wide-aperture": "an aperture or a pinhole that is too large", lens::wide_aperture;
    "out-of-focus": "a lens that focuses where there is nothing", lens::out_of_focus;
    "eyes-apart": "eyes that are too far apart", lens::eyes_apart;
    "hidden-behind": "an object that hides all others, or most of the picture", room::hidden_behind;
    "below-plane": "a plane between the camera and all other objects", hidden::below_plane;
    "plane-through": "a plane that passes through the middle of most objects", view::plane_through;
    "upside-down": "a camera whose `up` points into the ground", view::upside_down;
    "mirrored-wall": "a screen of a CAVE whose corners are in mirrored order", lens::mirrored_wall;
    "edge-on": "a plane seen edge-on", lens::edge_on;
    "long-up": "a camera's `up` that is used as written, without unit length", quirks::long_up;
    "stretched": "a picture that is not square, with a program that stretches it", quirks::stretched;
    "plane-normal": "a plane whose normal does not have unit length", quirks::plane_normal;
    "out-of-scale": "an object far larger or smaller than most", extent::out_of_scale;
    // Lights.
    "wrong-integrator": "light of a kind that the integrator does not support", integrator::wrong_integrator;
    "black-sky": "an environment that is multiplied by 0", integrator::black_sky;
    "sun-below": "a sun below the horizon", reported;
    "no-light": "no light", reported;
    "no-emitter": "a path-traced scene in which nothing emits light", physical::no_emitter;
    "fog-away": "fog that no camera ray passes through", fog::away;
    "thick-fog": "fog that blocks all light", fog::thick_fog;
    "black-fog": "fog that only absorbs light and leaves the picture dark", fog::black_fog;
    "lamp-turned": "an area light that faces away from everything visible", area_lights::facing_away;
    "lamp-blocked": "an area light that is occluded from everything visible", area_lights::blocked;
    "lamp-in-glass": "a light inside or behind glass, which paths find only by chance or never", area_lights::in_glass;
    "no-depth": "medium parameters that have no effect", physical::without_effect;
    "black-light": "a light without colour", reported;
    "light-divides": "a light whose falloff is zero, which causes a division by zero", attenuation::invalid_divisor;
    "no-falloff": "a light without `falloff`, where the old program divides by it", reported;
    "light-away": "a spotlight or photometric light that misses everything visible", beams::away;
    "light-narrow": "a spotlight whose cone contains almost nothing", beams::narrow;
    "light-near": "a light just above a surface, which lights only a small spot", beams::near;
    "light-inside": "a light inside an object", lights::inside;
    "light-blocked": "a light that an object blocks from everything visible", lights::blocked;
    "light-behind": "a light that all visible surfaces face away from", lights::behind;
    "light-faint": "a light that fades before it arrives", attenuation::faint;
    "inner-angle": "a spotlight whose inner cone is wider than the outer", beams::inner_angle;
    // Colours.
    "color-range": "a colour above 1", colors::too_large;
    "full-ambient": "ambient light so strong that it leaves no range for the lights", quirks::full_ambient;
    "pow-zero": "a highlight with an exponent near 0, which covers everything", quirks::pow_zero;
    "no-exponent": "a highlight colour without an exponent", quirks::no_exponent;
    "tiny-highlight": "a highlight smaller than a pixel", quirks::tiny_highlight;
    "same-parts": "a pattern with two equal parts", quirks::same_parts;
    "pattern-scale": "a pattern that shows only one part, or is finer than a pixel", patterns::scale;
    "pattern-border": "a surface exactly on the border between the cells of a checkerboard", pattern_border::on_border;
    "material-index": "a `MaterialIndex` without a material", reported;
    "no-material": "objects before any `MaterialIndex`", reported;
    "not-there": "a material of opacity 0", layers::zero_opacity;
    "black-material": "a material that reflects no light", colors::black;
    "light-cancelled": "a light whose colour the materials do not reflect", lights::cancelled;
    "negative-color": "a colour below zero", colors::negative;
    "no-bounces": "paths or secondary rays that end too early for mirrors, glass or indirect light", secondary::no_bounces;
    "metal-default": "a glTF material that is a black metal because it states no `metallicFactor`", metals::metal_by_default;
    "idle-layer": "a layer of a material that another field of the material removes", idle_layers::idle_layer;
    "dull-glass": "glass whose colour absorbs all light", secondary::opaque_glass;
    "nothing-mirrored": "mirrors that have nothing to reflect", integrator::nothing_mirrored;
    "thick-film": "a thin film that is too thick to show colours", optics::thick_film;
    "wide-scatter": "a scattering object much thinner than the mean free path of light in it", optics::wide_scatter;
    "no-spectrum": "glass with dispersion in a picture that is not rendered spectrally", optics::no_spectrum;
    "odd-index": "glass with an impossible index of refraction", secondary::odd_index;
    "same-color": "objects with the colour of the background", colors::background_colored;
    "no-coordinates": "a texture on an object without texture coordinates", textures::no_coordinates;
    "flat-texture": "a texture that shows only one colour or value", textures::flat_texture;
    "fine-texture": "a texture whose repetitions are smaller than a pixel", fine_textures::fine_texture;
    "normal-map": "a normal map that contains heights or colours", textures::normal_maps;
    "high-bumps": "a bump map as high as its object is wide", textures::high_bumps;
    // Shapes and meshes.
    "seen-from-behind": "a surface seen from behind, which is not shaded", facing::from_behind;
    "turned-triangle": "triangles that face the opposite way from their neighbours", facing::turned_triangles;
    "winding": "triangles of a mesh with the opposite winding to their neighbours", mesh::winding;
    "inside-out": "a closed mesh whose normals point inwards", mesh::inside_out;
    "odd-normals": "normals of a mesh file that contradict its faces, are missing or have zero length", mesh::file_normals;
    "misread-mesh": "a mesh file that this year's program reads with a missing line, other faces or other normals", mesh::quirky_files;
    "flat-field": "a height field that is flat", invisible::flat_field;
    "open-mesh": "a mesh with holes through which its inside is visible", mesh::holes;
    "degenerate-mesh": "triangles of a mesh without area", mesh::degenerate;
    "degenerate-triangle": "a triangle without area", objects::degenerate;
    "mesh-quads": "faces that this year's program cannot read", quirks::quads;
    "open-glass": "a glass object that is not closed", mesh::open_glass;
    "squashed": "an object that its transforms make flat or tiny", objects::squashed;
    "scaled-move": "a translation that a scale before it makes tiny or huge", transforms::scaled_move;
    "angle-first": "a rotation whose angle is written before its axis", transforms::angle_first;
    "same-place": "two objects with coinciding surfaces", objects::duplicates;
    "light-twice": "a light that is defined twice", lights::duplicates;
    // The picture.
    "not-finite": "samples that are NaN or infinite", numbers::not_finite;
    "depth-range": "a depth range that contains no depth of the picture", exposure::depth_range;
    "too-bright": "more light than an 8-bit picture can show", exposure::too_bright;
    "mostly-black": "lights that reach hardly any of the visible surfaces", integrator::mostly_black;
    "too-dark": "hardly any light", exposure::too_dark;
    "all-missed": "no ray hits anything, although the camera looks at the scene", view::empty_view;
    "one-color": "a picture of one colour, from an unknown cause", exposure::one_color;
    // These are unusual but mostly harmless.
    "dialect": "the dialect that was detected for the scene", reported;
    "radians": "an angle that may be in radians", extent::radians;
    "foreign-word": "a word from the dialect of another year", reported;
    "portability": "a scene that the official program of that year would reject", reported;
    "comment": "a comment that does not begin with `#`", reported;
    "tiny": "an object smaller than a pixel", invisible::tiny;
    "unseen": "objects outside the picture, or hidden", invisible::invisible;
    "unused-define": "a definition that is never used", names::unused_define;
    "unused-material": "a material that no object uses", names::unused_material;
    "mesh-file": "a part of a mesh file that was ignored", reported;
}

/// Returns the position of a code in the order of reporting. Unknown codes come before the final
/// notes.
pub fn rank(code: &str) -> usize {
    let of = |code: &str| CHECKS.iter().position(|check| check.code == code);
    of(code).or(of("foreign-word")).unwrap_or(CHECKS.len())
}
