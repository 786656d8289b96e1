//! Words of findings about model files, which lack the keywords of the scene language.

use super::finding::Finding;

/// Codes of findings, each with the help that applies to any file format.
const HELP: &[(&str, &str)] = &[
    ("camera-inside", "move the camera out of the object"),
    ("camera-away", "turn the camera towards the scene, or move the camera"),
    ("too-small", "show a smaller area, or move the camera closer"),
    ("too-narrow", "show a larger area"),
    ("wide-aperture", "use a smaller aperture"),
    ("out-of-focus", "focus at the distance of the objects, or use a smaller aperture"),
    ("hidden-behind", "move the object, the camera or the hidden objects"),
    ("below-plane", "move the plane or the camera"),
    ("upside-down", "turn the camera the right way up"),
    ("edge-on", "move the camera out of the plane"),
    ("out-of-scale", "check the size of the object and the transforms that enclose it"),
    ("black-sky", "give the environment a scale above 0"),
    ("lamp-in-glass", "use `--integrator photons`, or move the light out of the glass"),
    ("no-depth", "check the scattering parameters of the material"),
    ("black-light", "give the light a colour above 0"),
    ("light-narrow", "use a wider cone"),
    ("light-near", "move the light away from the object"),
    ("light-inside", "move the light out of the object"),
    ("light-blocked", "turn the light towards the scene, or move the light or the occluder"),
    ("light-behind", "turn the light towards the scene, or move the light"),
    ("light-faint", "increase the intensity of the light"),
    ("inner-angle", "make the inner cone narrower than the outer cone"),
    ("not-there", "increase the opacity, the fraction of the surface that is present"),
    ("black-material", "increase the base colour, the fraction of light that the material reflects"),
    ("negative-color", "use colours from 0 to 1"),
    ("dull-glass", "use a brighter colour for the glass, or let it absorb light over a greater distance"),
    ("odd-index", "use an index of refraction of 1.5 for glass or 1.33 for water"),
    ("thick-film", "use a film about as thick as a wavelength of light"),
    ("wide-scatter", "use a smaller scattering distance"),
    ("no-coordinates", "add texture coordinates to the mesh"),
    ("normal-map", "a normal map is mostly light blue: use this picture for heights or colours instead"),
    ("flat-texture", "check the image, its transform and the texture coordinates"),
    ("squashed", "check the transforms that enclose the object"),
    ("tiny", "check the size of the object and the transforms that enclose it"),
    ("unused-material", "check which materials the objects use"),
];

/// Keywords of the scene language in messages and effects, each with its neutral words.
const WORDS: &[(&str, &str)] = &[
    ("`emissionColor`", "emission colour"),
    ("`emissionLuminance`", "emission"),
    ("`emissionTexture`", "emission texture"),
    ("`opacity`", "opacity"),
    ("`transmissionColor`", "transmission colour"),
    ("`transmissionDepth` is 0", "the absorption distance is 0"),
    ("`transmissionScatter`", "the scattering colour"),
    ("`transmissionWeight`", "the transmission weight"),
    ("`subsurfaceWeight`", "the subsurface weight"),
    ("`uvTransform`", "transform"),
    ("`diffuseColor`", "the base colour"),
    ("`near`", "near"),
    ("`far`", "far"),
    ("`aperture`", "aperture"),
    ("`innerAngle`", "inner angle"),
    ("`angle`", "outer angle"),
    ("camera's `up`", "camera's up direction"),
];

/// Returns true if a text contains a keyword. Options of the command line are not keywords.
fn names_keyword(text: &str) -> bool {
    text.split('`').skip(1).step_by(2).any(|word| !word.starts_with("--"))
}

/// Replaces the keywords of the scene language in a finding about a model, and removes edits, which
/// would insert such keywords.
pub(super) fn neutral(mut finding: Finding) -> Finding {
    let diagnostic = &mut finding.diagnostic;
    let reword = |text: &mut String| WORDS.iter().for_each(|(word, neutral)| *text = text.replace(word, neutral));
    reword(&mut diagnostic.message);
    diagnostic.effect.iter_mut().for_each(reword);
    let help = HELP.iter().find(|(code, _)| *code == diagnostic.code).map(|(_, help)| *help);
    if let Some(help) = help.filter(|_| diagnostic.help.as_deref().is_some_and(names_keyword)) {
        diagnostic.help = Some(help.into());
        diagnostic.fix.clear();
    }
    finding
}
