//! The table of checks, in the order of reporting: causes before their consequences.

use super::finding::Finding;
use super::scene_probe::SceneProbe;
use super::{
    air, beams, colors, exposure, extent, facing, fading, hidden, lamps, layers, lens, lights, mesh, method, names,
    numbers, objects, optics, patterns, physical, solid, unseen, view, year,
};

/// A kind of finding.
#[derive(Clone, Copy, Debug)]
pub struct Check {
    /// Stable code.
    pub code: &'static str,
    /// Short description.
    pub about: &'static str,
    /// Runs the check; empty for codes that the reader or the compiler reports.
    pub(super) find: fn(&SceneProbe) -> Vec<Finding>,
}

fn reported(_: &SceneProbe) -> Vec<Finding> {
    Vec::new()
}

macro_rules! checks {
    ($($code:literal: $about:literal, $find:expr;)+) => {
        /// Every kind of finding.
        pub const CHECKS: &[Check] = &[$(Check { code: $code, about: $about, find: $find },)+];
    };
}

checks! {
    // Reported by the reader and the compiler.
    "syntax": "a word or number that is not understood", reported;
    "unknown-word": "a word that means nothing where it stands", reported;
    "unclosed-block": "a brace that is missing", reported;
    "extra-brace": "a brace too many", reported;
    "missing-field": "a thing without a field that it needs", reported;
    "bad-value": "a value that a field cannot have", reported;
    "wrong-count": "a `numObjects`, `numLights` or `numMaterials` that is not the number that follows", reported;
    "flat-transform": "a transform that flattens space", reported;
    "no-camera": "no camera", reported;
    "missing-file": "a mesh or picture that is not there", reported;
    "bad-file": "a mesh or picture that cannot be used", reported;
    "open-solid": "a part of a solid that is not closed", reported;
    "no-objects": "nothing to be seen", view::no_objects;
    // The camera.
    "far-origin": "a scene so far from the origin that numbers have no digits left for its shapes", lens::far_origin;
    "epsilon": "a scene smaller than the distance at which this year's program lets shadow rays begin", lens::below_epsilon;
    "camera-inside": "the camera is inside an object", view::inside;
    "camera-away": "the camera looks past everything", view::away;
    "up-parallel": "the camera's `up` is parallel to its `direction`", reported;
    "too-small": "all things together are too small in the picture", extent::too_small;
    "too-narrow": "the picture shows a tiny part of the scene", extent::too_narrow;
    "empty-solid": "a solid of which nothing is left", objects::empty_solid;
    "idle-part": "a part of a solid that changes nothing", solid::idle_part;
    "wide-aperture": "an opening that no lens has", lens::wide_aperture;
    "out-of-focus": "a lens that is sharp where nothing is", lens::out_of_focus;
    "eyes-apart": "two eyes too far from each other", lens::eyes_apart;
    "hidden-behind": "one object hides all others, or most of the picture", hidden::hidden_behind;
    "below-plane": "a plane between the camera and all other things", hidden::below_plane;
    "plane-through": "a plane that passes through the middle of most things", view::plane_through;
    "upside-down": "a camera whose `up` points into the ground", view::upside_down;
    "edge-on": "a plane that is seen from its edge", lens::edge_on;
    "long-up": "a camera's `up` that is used as it is, and not of length 1", year::long_up;
    "stretched": "a picture that is not square, under a program that stretches it", year::stretched;
    "plane-normal": "a plane whose normal is not of length 1", year::plane_normal;
    "out-of-scale": "an object far larger or smaller than most", extent::out_of_scale;
    // Lights.
    "wrong-integrator": "light of a kind that the method leaves out", method::wrong_integrator;
    "black-sky": "an environment that is multiplied by 0", method::black_sky;
    "no-light": "no light", reported;
    "no-emitter": "a scene for paths in which nothing shines", physical::no_emitter;
    "fog-away": "fog that no ray of the picture goes through", air::away;
    "thick-fog": "fog that keeps all light off", air::thick_fog;
    "lamp-turned": "a lamp that shines away from all that is seen", lamps::turned;
    "lamp-blocked": "a lamp whose light something keeps off all that is seen", lamps::blocked;
    "lamp-in-glass": "a lamp that paths hardly find, since it is inside of glass", lamps::in_glass;
    "no-depth": "words of a medium that have no effect", physical::without_effect;
    "black-light": "a light without colour", reported;
    "light-divides": "a light that is divided by zero", fading::divides;
    "no-falloff": "a light without `falloff`, where the old program divides by it", reported;
    "light-away": "a spotlight or measured lamp that shines past all that is seen", beams::away;
    "light-narrow": "a spotlight whose cone holds next to nothing", beams::narrow;
    "light-near": "a light just above a surface, of which it lights a spot", beams::near;
    "light-inside": "a light inside an object", lights::inside;
    "light-blocked": "a light that an object keeps off all that is seen", lights::blocked;
    "light-behind": "a light that all that is seen faces away from", lights::behind;
    "light-faint": "a light that fades before it arrives", fading::faint;
    "inner-angle": "a spotlight whose inner cone is wider than the outer", beams::inner_angle;
    // Colours.
    "color-range": "a colour beyond 1", colors::too_large;
    "full-ambient": "ambient light that leaves nothing to the lamps", year::full_ambient;
    "pow-zero": "a highlight of an exponent of 0, or nearly so, which is everywhere", year::pow_zero;
    "no-exponent": "a highlight's colour without an exponent", year::no_exponent;
    "tiny-highlight": "a highlight smaller than a pixel", year::tiny_highlight;
    "same-parts": "a pattern of two equal parts", year::same_parts;
    "pattern-scale": "a pattern of which one part alone is seen, or that is finer than a pixel", patterns::scale;
    "material-index": "a `MaterialIndex` without a material", reported;
    "no-material": "objects before any `MaterialIndex`", reported;
    "not-there": "a material of opacity 0", layers::not_there;
    "black-material": "a material that gives back no light", colors::black;
    "light-cancelled": "a light of which the materials give back nothing", lights::cancelled;
    "negative-color": "a colour below zero", colors::negative;
    "no-bounces": "mirrors or glass without secondary rays", colors::no_bounces;
    "dull-glass": "glass whose colour lets nothing through", colors::dull_glass;
    "nothing-mirrored": "mirrors that have nothing to show", method::nothing_mirrored;
    "thick-film": "a film too thick to show colours", optics::thick_film;
    "wide-scatter": "a body thinner than the way of light in it", optics::wide_scatter;
    "no-spectrum": "glass that spreads colours, without light by wavelength", optics::no_spectrum;
    "odd-index": "glass of an index that no glass has", colors::odd_index;
    "same-color": "things of the colour of the background", colors::camouflaged;
    "no-coordinates": "a texture on a thing without texture coordinates", colors::no_coordinates;
    "flat-texture": "a texture of which one colour alone is seen", patterns::flat_texture;
    // Shapes and meshes.
    "seen-from-behind": "a surface seen from behind, which is not shaded", facing::from_behind;
    "turned-triangle": "triangles that face the other way than their neighbours", facing::turned_triangles;
    "winding": "triangles of a mesh that wind the other way than their neighbours", mesh::winding;
    "inside-out": "a closed mesh whose normals point inwards", mesh::inside_out;
    "odd-normals": "normals of a mesh file that contradict its faces, are missing or have no length", mesh::given_normals;
    "misread-mesh": "a mesh file of which the year's program loses a line, or that it gives other normals", mesh::misread;
    "flat-field": "a landscape without heights", unseen::flat_field;
    "open-mesh": "a mesh with holes through which its inside is seen", mesh::holes;
    "degenerate-mesh": "triangles of a mesh without area", mesh::degenerate;
    "degenerate-triangle": "a triangle without area", objects::degenerate;
    "mesh-quads": "faces that this year's program cannot read", year::quads;
    "open-glass": "a thing of glass that is not closed", mesh::open_glass;
    "squashed": "an object made flat, or next to nothing, by its transforms", objects::squashed;
    "same-place": "two objects with the same surface", objects::twice;
    "light-twice": "a light that is written twice", lights::twice;
    // The picture.
    "not-finite": "samples that are no finite numbers", numbers::not_finite;
    "depth-range": "a range of depths that none of the picture's lies in", exposure::depth_range;
    "too-bright": "more light than a picture of eight bits can hold", exposure::too_bright;
    "mostly-black": "lights that reach next to nothing of what is seen", method::mostly_black;
    "too-dark": "hardly any light", exposure::too_dark;
    "all-missed": "no ray hits anything, though the camera looks at the scene", view::missed;
    "one-color": "a picture of one colour, and nothing found that says why", exposure::one_color;
    // Odd, but mostly harmless.
    "dialect": "which year's language the scene was taken for", reported;
    "radians": "a rotation that seems to be in radians", extent::radians;
    "repeated": "a section or field that is written twice", reported;
    "foreign-word": "a word of another year", reported;
    "portability": "what the year's own program would refuse", reported;
    "comment": "a comment that does not begin with `#`", reported;
    "tiny": "an object smaller than a pixel", unseen::tiny;
    "unseen": "objects that are not in the picture, or hidden", unseen::unseen;
    "unused-define": "something that is defined and never used", names::unused_define;
    "unused-material": "a material that nothing is made of", colors::unused;
    "mesh-file": "something in a mesh file that was passed over", reported;
}

/// Returns the position of a code in the order of reporting; unknown codes come before the final
/// notes.
pub fn rank(code: &str) -> usize {
    let of = |code: &str| CHECKS.iter().position(|check| check.code == code);
    of(code).or(of("foreign-word")).unwrap_or(CHECKS.len())
}
