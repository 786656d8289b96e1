//! Terms that users look up and that are not words of the language: synonyms, options of commands,
//! and examples.

/// Synonyms of terms that users look up and that the manual does not use.
pub const SYNONYMS: &[(&str, &[&str])] = &[
    ("glass", &["refract", "transmission", "transparent"]),
    ("refraction", &["refract"]),
    ("lens", &["aperture", "focus"]),
    ("dof", &["focus", "aperture"]),
    ("depth of field", &["focus", "aperture"]),
    ("ies", &["photometric", "ies"]),
    ("area light", &["emission", "emits"]),
    ("lamp", &["light"]),
    ("emission", &["emission", "emits"]),
    ("glow", &["emission", "emits"]),
    ("mirror", &["reflect"]),
    ("metal", &["metal"]),
    ("shiny", &["exponent", "roughness"]),
    ("hdri", &["environment"]),
    ("skybox", &["environment"]),
    ("sun", &["sun"]),
    ("fog", &["fog", "medium", "scatter"]),
    ("smoke", &["fog", "medium", "scatter"]),
    ("csg", &["difference", "intersection", "union"]),
    ("boolean", &["difference", "intersection", "union"]),
    ("model", &["mesh"]),
    ("transparency", &["transparent", "opacity"]),
    ("bump", &["bump", "normal map"]),
    ("cube", &["box"]),
    ("cuboid", &["box"]),
    ("size", &["size", "scale"]),
    ("kelvin", &["illuminant", "kelvin"]),
    ("color temperature", &["illuminant", "kelvin"]),
    ("colour temperature", &["illuminant", "kelvin"]),
    ("temperature", &["illuminant", "kelvin"]),
    ("cct", &["illuminant", "kelvin"]),
    ("blackbody", &["illuminant", "kelvin"]),
    ("watt", &["lumens", "candela"]),
    ("watts", &["lumens", "candela"]),
    ("power", &["lumens", "candela", "strength"]),
];

/// Terms that concern a command rather than the language, with what to use.
const TOPICS: &[(&[&str], &str)] = &[
    (
        &["supersampling", "antialiasing", "anti-aliasing", "multisampling", "jaggies", "aliasing"],
        "`durer render --samples 64` takes 64 samples per pixel, and `--filter` sets how they are averaged",
    ),
    (
        &["daylight autonomy", "epw", "weather", "climate", "udi", "sda", "useful daylight"],
        "`durer measure --weather city.epw` computes daylight autonomy and useful daylight over a year; docs/daylight.md has the \
         steps",
    ),
    (
        &["daylight factor", "daylight factors", "daylight"],
        "`cieSky` in `Background` sets a CIE sky and `durer measure` the illuminance inside and outside; docs/light.md has the \
         steps",
    ),
    (
        &["illuminance", "lux", "isolux", "uniformity", "irradiance"],
        "`durer measure` computes it at points and on grids, and `durer render --show illuminance` for each pixel",
    ),
    (
        &[
            "cylindrical illuminance",
            "semicylindrical",
            "cylindrical",
            "spherical illuminance",
            "scalar illuminance",
            "modelling",
        ],
        "`durer measure --illuminance cylindrical` or `spherical`",
    ),
    (
        &["passes", "render passes", "light passes", "terms", "diffuse term", "specular term", "ambient term", "aov"],
        "`durer render --show ambient,diffuse,highlight,reflection,refraction` writes the terms of Whitted's method as pictures",
    ),
    (
        &["crossings", "intersections", "all hits", "ray query", "inside", "point in mesh", "contains"],
        "`durer explain --ray 'OX OY OZ DX DY DZ' --crossings` lists all surfaces along a ray; docs/engineer.md and \
         docs/python.md have ray queries for programs",
    ),
    (
        &["depth", "depth map", "depth buffer", "z buffer", "distance"],
        "`durer render --show depth` writes the distance along the ray of each pixel, and 0 where it hits nothing",
    ),
    (
        &["cri", "color rendering", "colour rendering", "color rendering index"],
        "Dürer has no colour rendering index; `--color spectral` renders measured spectra of lights and surfaces",
    ),
    (
        &["wireframe", "edges"],
        "`durer render --show barycentric` shows each triangle of a mesh in the colours of its corners",
    ),
    (&["ugr", "glare"], "`durer measure --ugr EYE:TARGET` rates the glare of luminaires for an observer"),
    (
        &["transparent background", "alpha", "alpha channel"],
        "`durer render --background transparent` makes the picture transparent where the camera sees no object",
    ),
    (
        &["statistics", "stats", "timings", "ray counts"],
        "`durer render --stats` prints times and ray counts, and `--stats=FILE.json` writes them; `durer info` describes the \
         scene",
    ),
    (&["denoise", "denoising", "noise reduction"], "`durer render --denoise` removes noise; see also `--samples`"),
    (&["exposure", "brightness"], "`durer render --exposure auto` or a number of stops, and `--tone` for a tone curve"),
    (&["resolution", "picture size", "image size"], "`durer render --size 640x480`"),
];

/// Materials to copy, for terms that describe a look.
const EXAMPLES: &[(&[&str], &str)] = &[
    (
        &["glass", "refraction"],
        "PrincipledMaterial { preset glass }\n  in a course scene: PhongMaterial { diffuseColor 0 0 0 specularColor 1 1 1 \
         refractionIndex 1.5 }",
    ),
    (&["mirror"], "PrincipledMaterial { preset silver specularRoughness 0 }"),
    (&["metal"], "PrincipledMaterial { preset gold }"),
    (&["area light", "emission", "glow"], "PrincipledMaterial { baseColor 0 0 0 emissionLuminance 20 }"),
];

/// Returns what to use for a term that concerns a command.
pub fn topic(term: &str) -> Option<&'static str> {
    find(TOPICS, term)
}

/// Returns a material to copy for a term.
pub fn example(term: &str) -> Option<&'static str> {
    find(EXAMPLES, term)
}

fn find(rows: &[(&[&str], &'static str)], term: &str) -> Option<&'static str> {
    let term = term.to_lowercase();
    rows.iter().find(|(terms, _)| terms.contains(&term.trim())).map(|row| row.1)
}
