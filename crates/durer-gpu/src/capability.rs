//! Features that the device can render, and those that a scene and a job need.
//!
//! Every feature that matters to the device is a row of the table `features!`. The refusals, the
//! choice of `--device auto` and the table in `docs/gpu.md` all come from it.

mod needs;

pub use needs::needs;

use durer_render::integrator::IntegratorKind;

macro_rules! features {
    ($($(#[$doc:meta])* $variant:ident: $name:literal, $whitted:literal, $path:literal;)+) => {
        /// Feature of a scene or of a job that the device either can or cannot render.
        #[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord)]
        pub enum Feature {
            $($(#[$doc])* $variant,)+
        }

        impl Feature {
            /// All features, in the order of the documentation.
            pub const ALL: &[Feature] = &[$(Feature::$variant,)+];

            /// Returns the name of the feature, in the plural where possible.
            pub fn name(self) -> &'static str {
                match self { $(Feature::$variant => $name,)+ }
            }

            /// Returns true if the device can render the feature with `whitted` and with `path`.
            pub fn support(self) -> (bool, bool) {
                match self { $(Feature::$variant => ($whitted, $path),)+ }
            }
        }
    };
}

features! {
    /// Spheres and ellipsoids.
    Spheres: "spheres and ellipsoids", true, true;
    /// Infinite planes.
    Planes: "planes", true, true;
    /// Boxes.
    Boxes: "boxes", true, true;
    /// Cylinders and cones.
    Frustums: "cylinders and cones", true, true;
    /// Discs and rectangles.
    FlatShapes: "discs and rectangles", true, true;
    /// Triangles and meshes.
    Meshes: "triangles and meshes", true, true;
    /// Height fields, which are uploaded as triangles.
    HeightFields: "height fields", true, true;
    /// Transforms and instances of meshes.
    Transforms: "transforms and instances", true, true;
    /// Tori.
    Tori: "tori", false, false;
    /// Surfaces of degree two other than those above.
    Quadrics: "general quadrics", false, false;
    /// Solids made of other solids by Boolean operations.
    Solids: "solids with Boolean operations", false, false;
    /// Phong materials.
    PhongMaterials: "Phong materials", true, true;
    /// Mirrors and glass of Phong materials.
    MirrorsAndGlass: "mirrors and glass", true, true;
    /// Checkerboards, mixes and two-sided materials.
    Patterns: "checkerboards, mixes and two-sided materials", true, true;
    /// More materials at one point than the device can mix.
    DeepMixes: "mixtures of more than 4 materials at one point", false, false;
    /// Marble, wood and noise.
    SolidTextures: "marble, wood and noise", true, true;
    /// Textures.
    Textures: "textures", false, false;
    /// Colours of vertices.
    VertexColors: "vertex colours", false, false;
    /// Shadow rays that start on the triangles of smooth meshes.
    FlatShadows: "smooth meshes with `smoothShadows off`, as in files of Mitsuba and pbrt", false, false;
    /// Principled materials with a base of any kind: diffuse, plastic, metal or smooth glass.
    PrincipledMaterials: "principled materials: diffuse, plastic, metal and smooth glass", true, true;
    /// Other layers of principled materials. The Whitted integrator approximates them.
    Layers: "coats, fuzz, films, thin walls, subsurface scattering, rough glass, anisotropy", true, false;
    /// Opacity below 1, hidden or black backs, surfaces that the camera does not see.
    Cutouts: "opacity below 1, hidden or black backs, surfaces that the camera does not see", true, false;
    /// Hair.
    Hair: "hair", true, false;
    /// Emissive surfaces.
    EmissiveSurfaces: "emissive surfaces", true, true;
    /// Point, spot and directional lights.
    Lights: "point, spot and directional lights", true, true;
    /// Measured lights.
    PhotometricLights: "photometric lights", false, false;
    /// Background colour.
    Background: "background colours", true, true;
    /// Environment maps, skies and cube maps.
    Environments: "environment maps, skies and cube maps", false, false;
    /// Fog and other media.
    Media: "fog and other media", true, false;
    /// Camera inside a transparent object.
    EyeInGlass: "cameras inside transparent objects", false, false;
    /// All cameras, with depth of field.
    Cameras: "all cameras, with depth of field", true, true;
    /// Arithmetic and rules of the official programs.
    DialectRules: "the rules of the official programs", false, false;
    /// Sampling methods of old assignments.
    CourseSampling: "the sampling methods of old assignments", false, false;
    /// Many bounces of the Whitted integrator.
    ManyBounces: "more than 32 bounces with whitted", false, true;
    /// Spectral colour.
    Spectral: "spectral colour", true, false;
    /// Direct light by one strategy only.
    OneStrategy: "direct light by one strategy only", true, false;
    /// Photon mapping.
    Photons: "photon mapping", false, false;
    /// Ambient occlusion.
    AmbientOcclusion: "ambient occlusion", false, false;
}

/// Returns true if the device can render a feature with an integrator.
fn is_supported(feature: Feature, method: IntegratorKind) -> bool {
    let (whitted, path) = feature.support();
    match method {
        IntegratorKind::Whitted(_) => whitted,
        IntegratorKind::Path(_) => path,
        _ => false,
    }
}

/// Returns the features of a scene and a job that the device cannot render, without duplicates.
pub fn refusals(world: &durer_render::world::World, job: &durer_render::render::Job) -> Vec<Feature> {
    let mut found: Vec<Feature> = needs(world, job);
    found.retain(|feature| !is_supported(*feature, job.method));
    found.sort_unstable();
    found.dedup();
    found
}

/// Returns a sentence that names the features that the device cannot render.
pub fn sentence(features: &[Feature]) -> String {
    let names: Vec<&str> = features.iter().map(|feature| feature.name()).collect();
    let list = match &names[..] {
        [one] => (*one).to_string(),
        [first, second] => format!("{first} or {second}"),
        [some @ .., last] => format!("{} or {last}", some.join(", ")),
        [] => "this".into(),
    };
    format!("the GPU cannot render {list} yet")
}

/// Returns the table of features in Markdown, for the documentation.
pub fn markdown() -> String {
    let mut text = String::from("| feature | `whitted` | `path` |\n| --- | --- | --- |\n");
    for feature in Feature::ALL {
        let yes = |supported| if supported { "yes" } else { "no" };
        let (whitted, path) = feature.support();
        text += &format!("| {} | {} | {} |\n", feature.name(), yes(whitted), yes(path));
    }
    text
}

#[cfg(test)]
mod tests;
