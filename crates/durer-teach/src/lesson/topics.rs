//! The table of the lesson's topics, with their text, equations, pictures and references to the
//! source code. The topics of path tracing come last.

use durer_render::integrator::DirectSampling;
use durer_scene::spectrum::ColorMode;

/// Options of one picture of the lesson. They determine which parts of the light it shows and which
/// mistake it includes.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct ShotOptions {
    /// True if lights illuminate the scene. Otherwise, each surface shows its flat colour.
    pub lights: bool,
    /// True if surfaces have highlights.
    pub highlights: bool,
    /// True if lights cast shadows.
    pub shadows: bool,
    /// Maximum depth of reflected and transmitted rays. The job's maximum also applies.
    pub bounces: u32,
    /// How glass is rendered.
    pub glass: Glass,
    /// Name of the mistake to include, from [`crate::mistakes::MISTAKES`].
    pub mistake: Option<&'static str>,
    /// True if each pixel has several samples.
    pub sampled: bool,
    /// Options of path tracing, or `None` for Whitted's method.
    pub paths: Option<PathSettings>,
}

/// Path-tracing options of one picture of the lesson.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct PathSettings {
    /// Sampling strategy for direct light.
    pub direct: DirectSampling,
    /// True if photons are used to render caustics.
    pub photons: bool,
    /// Colour representation of the light, either RGB or spectral.
    pub color: ColorMode,
    /// True if glass has dispersion.
    pub disperses: bool,
}

impl PathSettings {
    /// Path tracing in RGB, with both sampling strategies for direct light.
    pub const PLAIN: PathSettings =
        PathSettings { direct: DirectSampling::Both, photons: false, color: ColorMode::Rgb, disperses: true };
}

/// The way in which a picture of the lesson renders glass.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Glass {
    /// Glass is rendered as an opaque surface.
    None,
    /// Glass transmits all light, without Fresnel reflection.
    Transmits,
    /// Glass has Fresnel reflection, as in the scene.
    Fresnel,
}

/// One picture of a topic, which a [`LessonScene`](super::stage::LessonScene) renders.
#[derive(Clone, Copy, Debug)]
pub struct Shot {
    /// Short caption.
    pub caption: &'static str,
    /// `rays`, or an AOV of [`durer_render::film::aov::AOVS`]. It is `None` for colour.
    pub aov: Option<&'static str>,
    /// Parts of the light to show.
    pub options: ShotOptions,
}

/// A reference from the lesson to the source code. It consists of a file, relative to the root of
/// the repository, and text to find in that file.
#[derive(Clone, Copy, Debug)]
pub struct SourcePlace {
    /// Path of the file.
    pub file: &'static str,
    /// Start of a definition in that file.
    pub symbol: &'static str,
}

/// A topic of the lesson, such as shadows, with one or more pictures. Each is a row of [`TOPICS`].
#[derive(Debug)]
pub struct Topic {
    /// Short name, also used in file names.
    pub name: &'static str,
    /// Title of the step.
    pub title: &'static str,
    /// Explanation for a student who has read the previous topics.
    pub words: &'static str,
    /// Equations, with one per line.
    pub equations: &'static [&'static str],
    /// Places in the source code that implement the equations.
    pub places: &'static [SourcePlace],
    /// Pictures of the topic: a single one, or a chain in which each picture is compared with the
    /// previous one.
    pub shots: &'static [Shot],
    /// Reason why a scene may lack the effect.
    pub lacking: &'static str,
}

impl Topic {
    /// Returns true for topics of path tracing, which are shown only if the scene is rendered with
    /// path tracing.
    pub fn needs_path_tracing(&self) -> bool {
        self.shots.iter().any(|shot| shot.options.paths.is_some())
    }
}

const fn at(file: &'static str, symbol: &'static str) -> SourcePlace {
    SourcePlace { file, symbol }
}

const fn value(caption: &'static str, value: &'static str) -> Shot {
    Shot { caption, aov: Some(value), options: FLAT }
}

const fn color(caption: &'static str, look: ShotOptions) -> Shot {
    Shot { caption, aov: None, options: look }
}

const FLAT: ShotOptions = ShotOptions {
    lights: false,
    highlights: false,
    shadows: false,
    bounces: 0,
    glass: Glass::None,
    mistake: None,
    sampled: false,
    paths: None,
};
const DIFFUSE: ShotOptions = ShotOptions { lights: true, ..FLAT };
const SPECULAR: ShotOptions = ShotOptions { highlights: true, ..DIFFUSE };
const SHADOWS: ShotOptions = ShotOptions { shadows: true, ..SPECULAR };
const SHADOW_ACNE: ShotOptions = ShotOptions { mistake: Some("epsilon-0"), ..SHADOWS };
const fn mirrors(bounces: u32) -> ShotOptions {
    ShotOptions { bounces, ..SHADOWS }
}
const MIRRORS: ShotOptions = mirrors(u32::MAX);
const GLASS: ShotOptions = ShotOptions { glass: Glass::Transmits, ..MIRRORS };
const FRESNEL: ShotOptions = ShotOptions { glass: Glass::Fresnel, ..GLASS };
const NORMALS_MOVED: ShotOptions = ShotOptions { mistake: Some("normals-moved"), ..FRESNEL };
const SAMPLED: ShotOptions = ShotOptions { sampled: true, ..FRESNEL };

/// Options for path tracing with many samples.
const fn paths(bounces: u32, settings: PathSettings) -> ShotOptions {
    ShotOptions { bounces, sampled: true, paths: Some(settings), ..FRESNEL }
}
const BOTH: PathSettings = PathSettings::PLAIN;
const fn straight(direct: DirectSampling) -> ShotOptions {
    paths(0, PathSettings { direct, ..BOTH })
}
const PHOTONS: PathSettings = PathSettings { photons: true, ..BOTH };
const SPECTRAL: PathSettings = PathSettings { color: ColorMode::Spectral, ..PHOTONS };

/// Topics in the order in which the lecture covers them.
pub static TOPICS: [Topic; 18] = [
    Topic {
        name: "rays",
        title: "Rays",
        words: "A picture begins with a ray through the center of each pixel. The camera computes it from the \
                pixel's position (x, y), from -1 to 1, and from its own axes: u to the right, v upwards, w \
                forwards. The equation is that of the perspective camera; other cameras have other equations.",
        equations: &["p(t) = o + t d", "d = D w + x u + y v,   D = 1 / tan(angle / 2)"],
        places: &[
            at("crates/durer-bvh/src/math/ray.rs", "struct Ray"),
            at("crates/durer-scene/src/camera/perspective.rs", "fn ray"),
            at("crates/durer-scene/src/camera/pose.rs", "struct CameraBasis"),
            at("crates/durer-render/src/render/camera_rays.rs", "fn center_ray"),
        ],
        shots: &[value("the rays' directions as colours", "rays")],
        lacking: "its camera has no rays",
    },
    Topic {
        name: "distance",
        title: "Distance",
        words: "The ray is inserted into the equation of each surface, which is solved for t. The smallest t in \
                front of the eye is the visible hit. In the picture, bright is near, and black is far away or no \
                hit.",
        equations: &[
            "sphere:   t² d·d + 2 t d·(o - c) + (o - c)·(o - c) - r² = 0",
            "plane:   t = (offset - n·o) / (n·d)",
            "triangle:   o + t d = α a + β b + γ c,   α + β + γ = 1,   α, β, γ ≥ 0",
        ],
        places: &[
            at("crates/durer-scene/src/shape/sphere.rs", "fn roots"),
            at("crates/durer-scene/src/shape/plane.rs", "fn intersect"),
            at("crates/durer-bvh/src/watertight/mod.rs", "fn intersect"),
            at("crates/durer-render/src/world/mod.rs", "fn closest"),
            at("crates/durer-render/src/film/aov.rs", "fn depth_picture"),
        ],
        shots: &[value("distance along the ray", "depth")],
        lacking: "no ray of its camera hits anything",
    },
    Topic {
        name: "normals",
        title: "Normals",
        words: "The shading of a surface depends on its orientation, given by the normal at the hit point. The \
                picture shows the three coordinates of the normal as red, green and blue.",
        equations: &[
            "sphere:   N = (p - c) / r",
            "triangle:   N = (b - a) × (c - a) / |(b - a) × (c - a)|",
            "smooth mesh:   N = norm(α N_a + β N_b + γ N_c)",
        ],
        places: &[
            at("crates/durer-scene/src/shape/sphere.rs", "fn surface"),
            at("crates/durer-scene/src/shape/triangle.rs", "fn face_normal"),
            at("crates/durer-scene/src/shape/mesh.rs", "fn surface"),
            at("crates/durer-render/src/film/aov.rs", "fn normal_picture"),
        ],
        shots: &[value("the normal at each hit", "normals")],
        lacking: "no ray of its camera hits anything",
    },
    Topic {
        name: "flat",
        title: "Flat colour",
        words: "The picture shows the colour of each hit surface, and the background where nothing is hit. Without \
                light, shapes are hard to recognise. Textures and patterns are part of a surface's colour.",
        equations: &["L = k_d"],
        places: &[
            at("crates/durer-render/src/world/shading.rs", "fn diffuse_color"),
            at("crates/durer-render/src/world/mod.rs", "fn background_radiance"),
            at("crates/durer-scene/src/texture/mod.rs", "fn at"),
        ],
        shots: &[color("the colour of each surface", FLAT)],
        lacking: "everything visible in it has the same colour",
    },
    Topic {
        name: "diffuse",
        title: "Diffuse light",
        words: "A matte surface scatters light evenly in all directions. The light that it receives is \
                proportional to the cosine between its normal and the direction to the light. Ambient light \
                approximates the light that arrives from all other directions.",
        equations: &["L = k_d I_a + Σ k_d max(0, N·L_i) I_i", "point light:   I_i = I / (a_0 + a_1 d + a_2 d²)"],
        places: &[
            at("crates/durer-render/src/integrator/whitted.rs", "fn shade"),
            at("crates/durer-render/src/integrator/whitted/direct.rs", "struct LightTerms"),
            at("crates/durer-scene/src/light/point.rs", "fn illuminate"),
            at("crates/durer-scene/src/light/directional.rs", "fn illuminate"),
        ],
        shots: &[color("flat colour", FLAT), color("ambient and diffuse light", DIFFUSE)],
        lacking: "no light reaches its visible surfaces",
    },
    Topic {
        name: "specular",
        title: "Highlights",
        words: "A glossy surface shows a blurred reflection of the light, which is brightest where the mirrored \
                ray would hit the light. The exponent sets how sharp it is.",
        equations: &[
            "Blinn:   L += k_s max(0, N·H)^s I,   H = norm(L + V)",
            "Phong:   L += k_s max(0, R·L)^s I,   R = d - 2 (d·N) N",
        ],
        places: &[
            at("crates/durer-render/src/integrator/whitted/direct.rs", "struct LightTerms"),
            at("crates/durer-scene/src/math/mod.rs", "fn reflect"),
            at("crates/durer-render/src/compile/materials.rs", "fn highlight"),
        ],
        shots: &[color("diffuse light", DIFFUSE), color("with highlights", SPECULAR)],
        lacking: "no highlight is visible in it",
    },
    Topic {
        name: "shadows",
        title: "Shadows",
        words: "Before a light is added, a shadow ray goes from the surface to the light. If it hits anything on \
                its way, the light contributes nothing; any hit will do, not just the closest.",
        equations: &["L = k_d I_a + Σ v_i (k_d max(0, N·L_i) + ...) I_i", "v_i = 0 if a hit has 0 < t < d_i, else 1"],
        places: &[
            at("crates/durer-render/src/integrator/whitted/direct.rs", "fn visible"),
            at("crates/durer-render/src/integrator/whitted/direct.rs", "fn shadow_ray"),
            at("crates/durer-render/src/world/mod.rs", "fn occluded"),
        ],
        shots: &[color("without shadows", SPECULAR), color("with shadows", SHADOWS)],
        lacking: "no shadow is visible in it, or shadows are off",
    },
    Topic {
        name: "epsilon",
        title: "Shadow acne and epsilon",
        words: "A hit point is rounded, so it is slightly above or below its surface. A shadow ray that starts \
                below hits the surface itself, and the point becomes dark: these specks are called acne. The \
                course's programs ignore hits closer than a small ε. Here, a ray starts off the surface instead, at \
                a distance that bounds the error of the point; in the dialect of a year, the ε of that year applies.",
        equations: &[
            "the course:   t > ε",
            "here:   o' = p + 2 |N|·δ N,   |p - true point| ≤ δ in each coordinate, t > 0",
        ],
        places: &[
            at("crates/durer-render/src/integrator/spawn.rs", "fn spawn_ray"),
            at("crates/durer-render/src/integrator/spawn.rs", "fn offset_ray_origin"),
            at("crates/durer-bvh/src/math/rounding.rs", "fn gamma"),
            at("crates/durer-scene/src/dialect.rs", "epsilon: Option<f32>"),
        ],
        shots: &[
            color("rays from the rounded point, t > 0", SHADOW_ACNE),
            color("rays that leave the surface", SHADOWS),
        ],
        lacking: "its shadow rays happen to miss their own surfaces, or there are none",
    },
    Topic {
        name: "reflection",
        title: "Reflection",
        words: "At a mirror, light arrives along the mirrored ray. Its radiance is computed like that of a camera \
                ray, so the function calls itself. Each level adds another reflection of mirrors in mirrors, up to \
                the maximum depth.",
        equations: &["L += k_r L(p, R),   R = d - 2 (d·N) N"],
        places: &[
            at("crates/durer-scene/src/math/mod.rs", "fn reflect"),
            at("crates/durer-render/src/integrator/whitted/secondary.rs", "fn secondary"),
            at("crates/durer-render/src/integrator/whitted/secondary.rs", "fn spawn"),
            at("crates/durer-render/src/integrator/whitted.rs", "fn trace"),
        ],
        shots: &[
            color("local light", SHADOWS),
            color("1 level", mirrors(1)),
            color("2 levels", mirrors(2)),
            color("3 levels", mirrors(3)),
            color("all levels", MIRRORS),
        ],
        lacking: "no mirror is visible in it, or the maximum depth is 0",
    },
    Topic {
        name: "refraction",
        title: "Refraction",
        words: "Light that enters glass is refracted towards the normal, by Snell's law, and away from it where it \
                leaves. Beyond the critical angle the root has no solution: all light is reflected (total internal \
                reflection). These places stay dark until the next step.",
        equations: &["t = η (d - (d·N) N) - √(1 - η² (1 - (d·N)²)) N,   η = n_1 / n_2", "L += k_t L(p, t)"],
        places: &[
            at("crates/durer-render/src/integrator/whitted/secondary.rs", "fn refract"),
            at("crates/durer-render/src/integrator/whitted/secondary.rs", "fn secondary"),
        ],
        shots: &[color("glass without light through it", MIRRORS), color("with transmitted rays", GLASS)],
        lacking: "no glass is visible in it, or the maximum depth is 0",
    },
    Topic {
        name: "fresnel",
        title: "Fresnel's law",
        words: "Glass also reflects light: little at normal incidence, and all of it towards the silhouette. \
                Schlick's formula approximates Fresnel's; the rest of the light is transmitted.",
        equations: &[
            "F = F_0 + (1 - F_0) (1 - cos θ)⁵,   F_0 = ((n_1 - n_2) / (n_1 + n_2))²",
            "L += F k_r L(p, R) + (1 - F) k_t L(p, t)",
        ],
        places: &[at("crates/durer-render/src/integrator/whitted/secondary.rs", "fn fresnel_share")],
        shots: &[color("glass that only transmits", GLASS), color("divided by Fresnel's law", FRESNEL)],
        lacking: "no glass with a `refractionIndex` is visible in it",
    },
    Topic {
        name: "transforms",
        title: "Normals of transformed objects",
        words: "An object under a matrix M is intersected in its own space, with the ray transformed by M⁻¹. \
                Points and directions are transformed back by M. A normal is not: it must stay perpendicular to \
                the surface, so it is transformed by the inverse transpose. The mistake is invisible if M only \
                translates, rotates and scales uniformly.",
        equations: &["p = M p'", "wrong:   N = norm(M N')", "right:   N = norm(M⁻ᵀ N'),   for N·(M v) = N'·v = 0"],
        places: &[
            at("crates/durer-bvh/src/math/affine.rs", "fn normal"),
            at("crates/durer-bvh/src/math/affine.rs", "fn inverse_ray"),
            at("crates/durer-render/src/world/object.rs", "fn surface"),
            at("crates/durer-scene/src/dialect/quirk.rs", "MovedNormals"),
        ],
        shots: &[color("normals by M", NORMALS_MOVED), color("normals by the inverse transpose of M", FRESNEL)],
        lacking: "none of its visible objects is sheared or scaled non-uniformly",
    },
    Topic {
        name: "supersampling",
        title: "Supersampling",
        words: "One ray per pixel samples only the center of the pixel: edges are jagged, and distant patterns \
                break up. Many rays, weighted by a filter, turn a pixel into the mean of its surroundings. Depth of \
                field appears only in this step, because the rays of a lens start from points all over it.",
        equations: &["pixel = Σ w(x_i, y_i) L(x_i, y_i) / Σ w(x_i, y_i)"],
        places: &[
            at("crates/durer-scene/src/sampler.rs", "fn pixel_position"),
            at("crates/durer-render/src/film/filter.rs", "fn weight"),
            at("crates/durer-render/src/render/samples.rs", "fn aim"),
            at("crates/durer-render/src/film/film.rs", "fn resolve"),
        ],
        shots: &[color("one ray per pixel", FRESNEL), color("many rays per pixel", SAMPLED)],
        lacking: "the picture does not change with more rays",
    },
    Topic {
        name: "soft-shadows",
        title: "Soft shadows",
        words: "A light has an extent, and a point from which only a part of it is visible is in the penumbra. So \
                each shadow ray is traced to another random point on the light; the mean over many rays is the \
                light from the visible part (Cook, Porter and Carpenter, 1984). Before this step, all rays are \
                traced to the center of the light, and shadows have hard edges.",
        equations: &["L = ∫ f V(p, q) L_e cos θ cos θ_q / |p - q|² dq", "one sample:   f V L_e cos θ / p_l(ω)"],
        places: &[
            at("crates/durer-render/src/integrator/path/direct.rs", "fn add_direct"),
            at("crates/durer-render/src/integrator/path/direct.rs", "fn visibility"),
            at("crates/durer-scene/src/light/area.rs", "fn sample"),
        ],
        shots: &[
            color("rays to the center of each light", straight(DirectSampling::Center)),
            color("rays to random points on it", straight(DirectSampling::Lights)),
        ],
        lacking: "it has no emissive surface that casts shadows",
    },
    Topic {
        name: "bounces",
        title: "One more bounce",
        words: "A lit surface acts as a light in turn. The light that a surface scatters arrives from all \
                directions, and the radiance from each of them is the same problem again (Kajiya, 1986). One \
                direction is sampled at random according to the scattering of the surface, and a ray is traced in \
                this direction. Colours bleed from wall to wall, and no shadow is completely black.",
        equations: &["L_o = L_e + ∫ f L_i cos θ dω", "one sample:   L_e + f L_i cos θ / p_b(ω)"],
        places: &[
            at("crates/durer-render/src/integrator/path/mod.rs", "fn bounce"),
            at("crates/durer-render/src/integrator/path/mod.rs", "fn shade"),
            at("crates/durer-render/src/integrator/path/scatter.rs", "fn spawn"),
        ],
        shots: &[
            color("direct light only", paths(0, BOTH)),
            color("1 more bounce", paths(1, BOTH)),
            color("2 more bounces", paths(2, BOTH)),
            color("all bounces", paths(u32::MAX, BOTH)),
        ],
        lacking: "no light is scattered between its objects, or the maximum depth is 0",
    },
    Topic {
        name: "mis",
        title: "Two ways to find a light",
        words: "A path can find a light by sampling a point on it, or by sampling a direction from the BSDF. The \
                first works well for small lights and rough surfaces, the second for large lights and smooth \
                surfaces. Each on its own has the correct mean, but is noisy where it works badly. If the two are \
                weighted by how often each finds that light, their sum works well for both: multiple importance \
                sampling (Veach, 1997).",
        equations: &[
            "light sampling:   f V L_e cos θ / p_l(ω)",
            "BSDF sampling:   f L_e cos θ / p_b(ω)",
            "both:   w_l times the first + w_b times the second,   w_l = p_l² / (p_l² + p_b²),   w_b = 1 - w_l",
        ],
        places: &[
            at("crates/durer-render/src/integrator/path/direct.rs", "fn power_heuristic"),
            at("crates/durer-render/src/integrator/path/direct.rs", "fn of_light"),
            at("crates/durer-render/src/integrator/path/direct.rs", "fn of_direction"),
        ],
        shots: &[
            color("light sampling only", straight(DirectSampling::Lights)),
            color("BSDF sampling only", straight(DirectSampling::Bsdf)),
            color("both, weighted", straight(DirectSampling::Both)),
        ],
        lacking: "it has no light with an extent",
    },
    Topic {
        name: "caustic",
        title: "Caustics",
        words: "Mirrors and glass focus light on other objects. A path from the eye finds the light through the \
                glass only by chance, which leads to bright specks, or no light at all. Photons travel in the \
                opposite direction, from the light through the glass, and are stored where they land; their density \
                there gives the amount of light (Jensen, 1996; Hachisuka and Jensen, 2009).",
        equations: &[
            "L = Σ f Φ_i k(|p - p_i| / r) / r²,   k(x) = 2 (1 - x²) / π",
            "each sample searches a smaller radius:   r_(i+1)² = r_i² (i + 2/3) / (i + 1)",
        ],
        places: &[
            at("crates/durer-render/src/integrator/path/photons/mod.rs", "fn trace"),
            at("crates/durer-render/src/integrator/path/photons/map.rs", "fn on_surface"),
            at("crates/durer-render/src/integrator/path/photons/mod.rs", "fn radius"),
        ],
        shots: &[color("paths only", paths(u32::MAX, BOTH)), color("paths and photons", paths(u32::MAX, PHOTONS))],
        lacking: "none of its mirrors or glass focuses light on other objects",
    },
    Topic {
        name: "spectrum",
        title: "A spectrum",
        words: "Glass refracts blue light more than red. A path with several wavelengths follows the refraction of \
                one of them and keeps only that one; each wavelength is then converted to a colour. Before this \
                step, the glass has one index for all wavelengths.",
        equations: &["n(λ) = A + B / λ²", "Abbe's number:   V = (n_d - 1) / (n_F - n_C)"],
        places: &[
            at("crates/durer-scene/src/material/principled.rs", "fn ior_at"),
            at("crates/durer-render/src/integrator/path/scatter.rs", "fn select_hero"),
        ],
        shots: &[
            color("one index for all wavelengths", paths(u32::MAX, PathSettings { disperses: false, ..SPECTRAL })),
            color("an index per wavelength", paths(u32::MAX, SPECTRAL)),
        ],
        lacking: "none of its glass has a `transmissionDispersionScale`",
    },
];
