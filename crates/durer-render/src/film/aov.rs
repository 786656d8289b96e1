//! Arbitrary output variables (AOVs): pictures of values other than colour.
//!
//! Most AOVs trace one ray through the centre of each pixel. Some use statistics of the colour
//! samples instead. Floating-point files store the values unchanged. For eight-bit files, the
//! values are mapped to display colours from 0 to 1.

use super::false_color::FalseColorScale;
use super::{Film, luminance_of};
use crate::integrator::separate_terms::SeparateTerms;
use crate::world::{DisplayRules, SurfaceInteraction};
use durer_bvh::TraversalStats;
use durer_scene::dialect::{DepthPicture, NormalsPicture};
use durer_scene::math::{Aabb, Color, Vec3};
use durer_scene::sampler::hash;
use durer_scene::shape::SurfacePoint;

/// Data at the first hit of the ray through a pixel's centre, from which AOVs are computed.
#[derive(Clone, Copy, Debug)]
pub struct AovInput {
    /// True if the camera has a ray through this pixel's centre.
    pub covered: bool,
    /// Surface that the ray hits first.
    pub hit: Option<SurfaceInteraction>,
    /// Diffuse colour at the hit.
    pub albedo: Color,
    /// Statistics of BVH traversal for the pixel, including all secondary rays.
    pub counts: TraversalStats,
    /// Illuminance at the surface, in lux if the light of the scene is given in cd/m^2 or watts. It
    /// is 0 unless it was requested.
    pub illuminance: f32,
    /// Terms of the colour by Whitted's method, which are 0 unless one of them was requested.
    pub terms: SeparateTerms,
}

impl AovInput {
    /// Input for a pixel for which the camera has no ray.
    pub const NOTHING: AovInput = AovInput {
        covered: false,
        hit: None,
        albedo: Vec3::ZERO,
        counts: TraversalStats { rays: 0, nodes: 0, primitive_tests: 0 },
        illuminance: 0.0,
        terms: SeparateTerms {
            ambient: Vec3::ZERO,
            diffuse: Vec3::ZERO,
            highlight: Vec3::ZERO,
            reflection: Vec3::ZERO,
            refraction: Vec3::ZERO,
            background: Vec3::ZERO,
        },
    };
}

/// Sample count, mean and variance of one pixel's colour. They are computed on demand for AOVs.
#[derive(Clone, Copy, Debug)]
pub struct PixelStatistics<'a> {
    /// The film and the pixel's coordinates, or `None` if the pixel has no samples yet.
    pub pixel: Option<(&'a Film, u32, u32)>,
    /// Magnitude of the sample weights relative to their mean. See [`Film::variance`].
    pub gain: f32,
    /// Luminous efficacy of each colour channel if light is measured in watts.
    pub lumens: Option<Vec3>,
}

impl PixelStatistics<'_> {
    /// Returns the number of samples.
    pub fn samples(&self) -> u64 {
        self.pixel.map_or(0, |(film, x, y)| film.samples(x, y))
    }

    /// Returns the estimated variance of the pixel's mean luminance.
    pub fn variance(&self) -> f64 {
        self.pixel.map_or(f64::INFINITY, |(film, x, y)| film.variance(x, y, self.gain))
    }

    /// Returns the luminance of the pixel's mean colour.
    pub fn luminance(&self) -> f64 {
        self.pixel.map_or(0.0, |(film, x, y)| brightness(film.resolve(x, y), self.lumens))
    }
}

/// Returns the luminance of a colour. If light is measured in watts, `lumens` is the luminous
/// efficacy of each channel.
pub fn brightness(light: Color, lumens: Option<Vec3>) -> f64 {
    lumens.map_or_else(|| luminance_of(light), |lumens| light.as_dvec3().dot(lumens.as_dvec3()))
}

/// Parameters for mapping AOV values to display colours, such as ranges, scales and the dialect's
/// rules.
#[derive(Clone, Copy, Debug)]
pub struct Display {
    /// Display rules of the dialect.
    pub rules: DisplayRules,
    /// Depths that are shown as black and white. `None` means the minimum and maximum of the
    /// picture.
    pub depth_range: Option<(f32, f32)>,
    /// Scale of values for false-colour pictures.
    pub light_scale: FalseColorScale,
    /// Bounds of the values at pixels with a hit.
    pub hit_bounds: Aabb,
    /// Bounds of the values of all pixels.
    pub all_bounds: Aabb,
}

/// Function that computes the value of an AOV at a pixel, either from a ray or from the colour
/// samples.
#[derive(Clone, Copy, Debug)]
pub enum AovFunction {
    /// Function that uses the ray through the pixel's centre.
    Ray(fn(&AovInput) -> Vec3),
    /// Function that uses the statistics of the colour samples.
    Sums(fn(&PixelStatistics) -> Vec3),
}

/// Entry in the table of arbitrary output variables (AOVs), such as `depth` and `normals`.
#[derive(Debug)]
pub struct Aov {
    /// Name of the AOV on the command line and in files.
    pub name: &'static str,
    /// Description that the help shows.
    pub doc: &'static str,
    /// Function that computes the value at a pixel. Floating-point files store this value.
    pub value: AovFunction,
    /// Function that maps a value to a display colour. The flag is true for hits.
    pub picture: fn(Vec3, bool, &Display) -> Color,
    /// True if the display colour depends on the values of other pixels.
    pub relative: bool,
    /// Unit of the values in a false-colour picture. A scale with this unit is drawn next to the
    /// picture.
    pub unit: Option<&'static str>,
    /// True if the values are light, which pictures show with the exposure and the transfer
    /// function of the colour.
    pub is_light: bool,
}

impl Aov {
    /// Finds an AOV by name.
    pub fn from_name(name: &str) -> Option<&'static Aov> {
        AOVS.iter().find(|aov| aov.name == name)
    }
}

/// Fills each pixel without a hit with the colour of the previous hit. Rows are processed from
/// bottom to top, and each row from left to right.
pub fn fill_from_last_hit(pixels: &mut [Color], hits: &[bool], width: usize) {
    let rows = pixels.len() / width.max(1);
    let mut last = None;
    for y in (0..rows).rev() {
        for i in y * width..(y + 1) * width {
            match (hits[i], last) {
                (true, _) => last = Some(pixels[i]),
                (false, Some(color)) => pixels[i] = color,
                (false, None) => {}
            }
        }
    }
}

/// Table of all AOVs in the order in which the help lists them.
pub static AOVS: &[Aov] = &[
    Aov {
        name: "depth",
        doc: "ray parameter t of the first hit, which is a distance for camera rays; 0 for a miss",
        value: AovFunction::Ray(|input| Vec3::splat(input.hit.map_or(f32::INFINITY, |at| at.hit.t))),
        picture: depth_picture,
        relative: true,
        unit: None,
        is_light: false,
    },
    Aov {
        name: "normals",
        doc: "shading normal, in world space",
        value: AovFunction::Ray(|input| of_surface(input, |s| s.n_shade)),
        picture: normal_picture,
        // With one quirk, a pixel without a hit shows the normal of the previous hit.
        relative: true,
        unit: None,
        is_light: false,
    },
    Aov {
        name: "geometric-normals",
        doc: "geometric normal, in world space",
        value: AovFunction::Ray(|input| of_surface(input, |s| s.n_geo)),
        picture: normal_picture,
        relative: false,
        unit: None,
        is_light: false,
    },
    Aov {
        name: "position",
        doc: "hit point, in world space; as a picture, relative to the bounds of all hit points",
        value: AovFunction::Ray(|input| of_surface(input, |s| s.position)),
        picture: |p, hit, display| {
            let (size, min) = (display.hit_bounds.size(), display.hit_bounds.min);
            let one = |axis: usize| if size[axis] > 0.0 { (p[axis] - min[axis]) / size[axis] } else { 0.5 };
            if hit { Vec3::new(one(0), one(1), one(2)) } else { Vec3::ZERO }
        },
        relative: true,
        unit: None,
        is_light: false,
    },
    Aov {
        name: "uv",
        doc: "texture coordinates in red and green, 0 if there are none; as a picture, their fractional part",
        value: AovFunction::Ray(|input| of_surface(input, |s| s.uv.get().unwrap_or_default().extend(0.0))),
        picture: |uv, _, _| uv - uv.floor(),
        relative: false,
        unit: None,
        is_light: false,
    },
    Aov {
        name: "barycentric",
        doc: "barycentric coordinates on triangles, 0 on other shapes",
        value: AovFunction::Ray(|input| of_surface(input, |s| s.barycentric)),
        picture: |b, _, _| b,
        relative: false,
        unit: None,
        is_light: false,
    },
    Aov {
        name: "albedo",
        doc: "diffuse colour with textures and patterns, without lighting; 0 for a miss",
        value: AovFunction::Ray(|input| input.albedo),
        picture: |albedo, _, _| albedo,
        relative: false,
        unit: None,
        is_light: false,
    },
    Aov {
        name: "object",
        doc: "index of the object, -1 for a miss; as a picture, one colour per object",
        value: AovFunction::Ray(|input| Vec3::splat(input.hit.map_or(-1.0, |at| at.hit.object as f32))),
        picture: |id, hit, _| if hit { id_color(id.x) } else { Vec3::ZERO },
        relative: false,
        unit: None,
        is_light: false,
    },
    Aov {
        name: "material",
        doc: "index of the material, -1 for a miss; as a picture, one colour per material",
        value: AovFunction::Ray(|input| Vec3::splat(input.hit.map_or(-1.0, |at| at.material as f32))),
        picture: |id, hit, _| if hit { id_color(id.x) } else { Vec3::ZERO },
        relative: false,
        unit: None,
        is_light: false,
    },
    term(
        "ambient",
        "ambient term of the colour by Whitted's method, for the ray through the pixel's centre",
        |input| input.terms.ambient,
    ),
    term("diffuse", "diffuse terms of all lights, with shadows, by Whitted's method", |input| input.terms.diffuse),
    term("highlight", "highlights of all lights, with shadows, by Whitted's method", |input| input.terms.highlight),
    term("reflection", "light along mirrored rays, by Whitted's method", |input| input.terms.reflection),
    term("refraction", "light along refracted rays, by Whitted's method", |input| input.terms.refraction),
    term(
        "background",
        "background where a ray hits nothing; it and the five terms before it add up to the colour",
        |input| input.terms.background,
    ),
    Aov {
        name: "luminance",
        doc: "luminance of the colour, in cd/m^2 if the scene's light is in cd/m^2 or in watts; as a picture, false colours with a scale",
        value: AovFunction::Sums(|sums| Vec3::splat(sums.luminance() as f32)),
        picture: light_picture,
        relative: true,
        unit: Some("cd/m2"),
        is_light: false,
    },
    Aov {
        name: "illuminance",
        doc: "illuminance of the surface by path tracing, in lux if the scene's light is in cd/m^2 or in watts; as a picture, false colours with a scale",
        value: AovFunction::Ray(|input| Vec3::splat(input.illuminance)),
        picture: |value, hit, display| if hit { light_picture(value, hit, display) } else { Vec3::ZERO },
        relative: true,
        unit: Some("lux"),
        is_light: false,
    },
    Aov {
        name: "sample-count",
        doc: "number of samples of the pixel; as a picture, a heat map",
        value: AovFunction::Sums(|sums| Vec3::splat(sums.samples() as f32)),
        picture: heat_picture,
        relative: true,
        unit: None,
        is_light: false,
    },
    Aov {
        name: "variance",
        doc: "estimated variance of the mean luminance, infinite for one sample; as a picture, a heat map of its square root, up to 0.1",
        value: AovFunction::Sums(|sums| Vec3::splat(sums.variance() as f32)),
        picture: |variance, _, _| heat(variance.x.sqrt() * 10.0),
        relative: false,
        unit: None,
        is_light: false,
    },
    Aov {
        name: "cost",
        doc: "number of box and shape tests of the pixel, secondary rays included; as a picture, a heat map",
        value: AovFunction::Ray(|input| Vec3::splat((input.counts.nodes + input.counts.primitive_tests) as f32)),
        picture: heat_picture,
        relative: true,
        unit: None,
        is_light: false,
    },
];

/// Returns the entry for a term of the colour by Whitted's method.
const fn term(name: &'static str, doc: &'static str, value: fn(&AovInput) -> Vec3) -> Aov {
    let value = AovFunction::Ray(value);
    Aov { name, doc, value, picture: |light, _, _| light, relative: false, unit: None, is_light: true }
}

/// Converts a normal to a colour as the dialect prescribes.
fn normal_picture(n: Vec3, _: bool, display: &Display) -> Color {
    match display.rules.normals {
        NormalsPicture::Abs => n.abs(),
        NormalsPicture::Half => (n + 1.0) * 0.5,
    }
}

/// Converts a luminance or illuminance to a false colour.
fn light_picture(value: Vec3, _: bool, display: &Display) -> Color {
    display.light_scale.color(value.x)
}

/// Converts a count to a colour of a heat map, relative to the maximum of the picture.
fn heat_picture(value: Vec3, _: bool, display: &Display) -> Color {
    heat(value.x / display.all_bounds.max.x.max(1.0))
}

/// Returns an attribute of the surface at the hit, or zero if there was no hit.
fn of_surface(input: &AovInput, value: impl Fn(&SurfacePoint) -> Vec3) -> Vec3 {
    input.hit.map_or(Vec3::ZERO, |at| value(&at.surface))
}

/// Converts a depth to a shade of grey as the dialect prescribes.
fn depth_picture(depth: Vec3, hit: bool, display: &Display) -> Color {
    let rules = display.rules;
    let (least, greatest) = (display.hit_bounds.min.x, display.hit_bounds.max.x);
    let (min, max) = match display.depth_range {
        // Truncate the ends of the range to integers, unless they would become equal.
        Some((min, max)) if rules.whole_depths && min.trunc() != max.trunc() => (min.trunc(), max.trunc()),
        Some(range) => range,
        None => (least, if greatest > least { greatest } else { least + 1.0 }),
    };
    let depth = match display.depth_range {
        Some((min, _)) if rules.clamped_depths && depth.x < min => Vec3::splat(min),
        Some((_, max)) if rules.clamped_depths && depth.x > max => Vec3::splat(max),
        _ => depth,
    };
    Vec3::splat(match rules.depth {
        DepthPicture::NearWhite if !hit => 0.0,
        DepthPicture::NearWhite => ((max - depth.x) / (max - min)).clamp(0.0, 1.0),
        DepthPicture::NearBlack if !hit => {
            if rules.black_sky {
                0.0
            } else {
                1.0
            }
        }
        DepthPicture::NearBlack => ((depth.x - min) / (max - min)).clamp(0.0, 1.0),
    })
}

/// Returns a bright pseudo-random colour for an object or material index.
fn id_color(id: f32) -> Color {
    let bits = hash(0, id as u32, 0, 0, 0);
    let channel = |shift: u32| 0.25 + 0.75 * ((bits >> shift) & 0xff) as f32 / 255.0;
    Vec3::new(channel(0), channel(8), channel(16))
}

/// Maps numbers from 0 to 1 to the colours of a heat map: black, blue, red, yellow, white.
pub(crate) fn heat(x: f32) -> Color {
    const STEPS: [Vec3; 5] =
        [Vec3::ZERO, Vec3::new(0.1, 0.1, 0.8), Vec3::new(0.9, 0.1, 0.1), Vec3::new(1.0, 0.9, 0.1), Vec3::ONE];
    let place = x.clamp(0.0, 1.0) * 4.0;
    let step = (place as usize).min(3);
    let part = place - step as f32;
    (1.0 - part) * STEPS[step] + part * STEPS[step + 1]
}
