//! The steps of the lecture as a table: text, equations, pictures and places in the source. The
//! path-tracing steps come last.

use durer_render::integrator::Direct;
use durer_scene::spectrum::ColorMode;

/// Parts of the light that are computed, and the mistake that is made.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Look {
    /// True if there are lights; otherwise each surface shows its own colour.
    pub lights: bool,
    /// True if there are highlights.
    pub highlights: bool,
    /// True if there are shadows.
    pub shadows: bool,
    /// Maximum depth of reflected and transmitted rays, limited by the job's.
    pub bounces: u32,
    /// Behaviour of glass.
    pub glass: Glass,
    /// Name of the mistake to make, from [`crate::mistakes::MISTAKES`].
    pub mistake: Option<&'static str>,
    /// True if a pixel has more than one sample.
    pub sampled: bool,
    /// Options of path tracing; `None` for Whitted's method.
    pub paths: Option<Carriage>,
}

/// Options of path tracing.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Carriage {
    /// Sampling strategy for direct light.
    pub direct: Direct,
    /// True if photons render caustics.
    pub photons: bool,
    /// RGB or spectral light.
    pub color: ColorMode,
    /// True if glass disperses light.
    pub disperses: bool,
}

impl Carriage {
    /// Paths with both ways to sample lights, in red, green and blue.
    pub const PLAIN: Carriage =
        Carriage { direct: Direct::Both, photons: false, color: ColorMode::Rgb, disperses: true };
}

/// Behaviour of glass.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Glass {
    /// Opaque.
    None,
    /// Transmits everything; no reflection in place of Fresnel's law.
    Transmits,
    /// As in the scene.
    Fresnel,
}

/// One picture of a topic.
#[derive(Clone, Copy, Debug)]
pub struct Shot {
    /// Short caption.
    pub caption: &'static str,
    /// `rays`, or an AOV of [`durer_render::film::aov::AOVS`]; `None` for colour.
    pub value: Option<&'static str>,
    /// Parts of the light that are shown.
    pub look: Look,
}

/// A place in the source: a file relative to the repository's root, and the text to find in it.
#[derive(Clone, Copy, Debug)]
pub struct Place {
    /// Path of the file.
    pub file: &'static str,
    /// Start of a definition in the file.
    pub symbol: &'static str,
}

/// A step of the lecture, or several of one kind.
#[derive(Debug)]
pub struct Topic {
    /// Keyword, also used in file names.
    pub name: &'static str,
    /// Title of the step.
    pub title: &'static str,
    /// Explanation for a student who has read the steps before.
    pub words: &'static str,
    /// Equations, one a line.
    pub equations: &'static [&'static str],
    /// Places of the equations in the source.
    pub places: &'static [Place],
    /// Pictures: a single one, or a chain in which each differs from the one before.
    pub shots: &'static [Shot],
    /// Reason why a scene may lack the effect.
    pub lacking: &'static str,
}

impl Topic {
    /// Returns true for topics of path tracing, which are shown only for scenes rendered by path
    /// tracing.
    pub fn is_of_paths(&self) -> bool {
        self.shots.iter().any(|shot| shot.look.paths.is_some())
    }
}

const fn at(file: &'static str, symbol: &'static str) -> Place {
    Place { file, symbol }
}

const fn value(caption: &'static str, value: &'static str) -> Shot {
    Shot { caption, value: Some(value), look: FLAT }
}

const fn color(caption: &'static str, look: Look) -> Shot {
    Shot { caption, value: None, look }
}

const FLAT: Look = Look {
    lights: false,
    highlights: false,
    shadows: false,
    bounces: 0,
    glass: Glass::None,
    mistake: None,
    sampled: false,
    paths: None,
};
const DIFFUSE: Look = Look { lights: true, ..FLAT };
const SPECULAR: Look = Look { highlights: true, ..DIFFUSE };
const SHADOWS: Look = Look { shadows: true, ..SPECULAR };
const SPECKLED: Look = Look { mistake: Some("epsilon-0"), ..SHADOWS };
const fn mirrors(bounces: u32) -> Look {
    Look { bounces, ..SHADOWS }
}
const MIRRORS: Look = mirrors(u32::MAX);
const GLASS: Look = Look { glass: Glass::Transmits, ..MIRRORS };
const FRESNEL: Look = Look { glass: Glass::Fresnel, ..GLASS };
const MOVED: Look = Look { mistake: Some("normals-moved"), ..FRESNEL };
const SAMPLED: Look = Look { sampled: true, ..FRESNEL };

/// Path tracing, always with many samples.
const fn paths(bounces: u32, carriage: Carriage) -> Look {
    Look { bounces, sampled: true, paths: Some(carriage), ..FRESNEL }
}
const BOTH: Carriage = Carriage::PLAIN;
const fn straight(direct: Direct) -> Look {
    paths(0, Carriage { direct, ..BOTH })
}
const PHOTONS: Carriage = Carriage { photons: true, ..BOTH };
const SPECTRAL: Carriage = Carriage { color: ColorMode::Spectral, ..PHOTONS };

/// Topics in the order of the lecture.
pub static TOPICS: [Topic; 18] = [
    Topic {
        name: "rays",
        title: "Rays",
        words: "A picture begins with a ray through the middle of each pixel. The camera makes it of the pixel's place (x, y), \
                from -1 to 1, and of its own axes: u to the right, v upwards, w forwards. The equation is that of the \
                perspective camera; other cameras have others.",
        equations: &["p(t) = o + t d", "d = D w + x u + y v,   D = 1 / tan(angle / 2)"],
        places: &[
            at("crates/durer-bvh/src/math/ray.rs", "struct Ray"),
            at("crates/durer-scene/src/camera/perspective.rs", "fn ray"),
            at("crates/durer-scene/src/camera/pose.rs", "struct CameraBasis"),
            at("crates/durer-render/src/render/eye.rs", "fn center_ray"),
        ],
        shots: &[value("the rays' directions as colours", "rays")],
        lacking: "its camera has no rays",
    },
    Topic {
        name: "distance",
        title: "Distance",
        words: "Each ray is put into the equation of each surface and solved for t. The least t in front of the eye is what the \
                pixel sees. Near is bright here; black is what is far off, or nothing.",
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
        words: "How a surface is lit depends on how it is turned: on its normal at the point that was hit. The picture shows the \
                three coordinates of the normal as red, green and blue.",
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
        words: "The colour of what is hit, and the background's where nothing is: no light yet, and so no form. Textures and \
                patterns are part of a surface's colour.",
        equations: &["L = k_d"],
        places: &[
            at("crates/durer-render/src/world/shading.rs", "fn diffuse_color"),
            at("crates/durer-render/src/world/mod.rs", "fn sky"),
            at("crates/durer-scene/src/texture/mod.rs", "fn at"),
        ],
        shots: &[color("each surface's own colour", FLAT)],
        lacking: "all that is seen of it has one colour",
    },
    Topic {
        name: "diffuse",
        title: "Diffuse light",
        words: "A matt surface spreads light evenly to all sides; how much of a lamp's light it gets goes with the cosine between \
                its normal and the way to the lamp. Ambient light stands for all that comes from nowhere in particular.",
        equations: &["L = k_d I_a + Σ k_d max(0, N·L_i) I_i", "point light:   I_i = I / (a_0 + a_1 d + a_2 d²)"],
        places: &[
            at("crates/durer-render/src/integrator/whitted.rs", "fn shade"),
            at("crates/durer-render/src/integrator/whitted/direct.rs", "struct Direct"),
            at("crates/durer-scene/src/light/point.rs", "fn illuminate"),
            at("crates/durer-scene/src/light/directional.rs", "fn illuminate"),
        ],
        shots: &[color("flat colour", FLAT), color("ambient and diffuse light", DIFFUSE)],
        lacking: "nothing that is seen of it is lit by a lamp",
    },
    Topic {
        name: "specular",
        title: "Highlights",
        words: "A glossy surface shows the lamp itself, blurred: brightest where the mirrored ray would meet the lamp. The exponent \
                says how sharp it is.",
        equations: &[
            "Blinn:   L += k_s max(0, N·H)^s I,   H = norm(L + V)",
            "Phong:   L += k_s max(0, R·L)^s I,   R = d - 2 (d·N) N",
        ],
        places: &[
            at("crates/durer-render/src/integrator/whitted/direct.rs", "struct Direct"),
            at("crates/durer-scene/src/math/mod.rs", "fn reflect"),
            at("crates/durer-render/src/compile/materials.rs", "fn highlight"),
        ],
        shots: &[color("diffuse light", DIFFUSE), color("with highlights", SPECULAR)],
        lacking: "no highlight is seen in it",
    },
    Topic {
        name: "shadows",
        title: "Shadows",
        words: "Before a lamp's light is added, a ray goes from the surface to the lamp. If it hits anything on its way, the lamp \
                adds nothing; any hit will do, not just the nearest.",
        equations: &[
            "L = k_d I_a + Σ v_i (k_d max(0, N·L_i) + ...) I_i",
            "v_i = 0 where something is hit at 0 < t < d_i, else 1",
        ],
        places: &[
            at("crates/durer-render/src/integrator/whitted/direct.rs", "fn visible"),
            at("crates/durer-render/src/integrator/whitted/direct.rs", "fn shadow_ray"),
            at("crates/durer-render/src/world/mod.rs", "fn occluded"),
        ],
        shots: &[color("without shadows", SPECULAR), color("with shadows", SHADOWS)],
        lacking: "no shadow is seen in it, or shadows are off",
    },
    Topic {
        name: "epsilon",
        title: "Shadow acne, and the epsilon against it",
        words: "The point of a hit is rounded, and lies a little above or below its surface. A shadow ray from below hits the \
                surface itself, and the point is dark: specks, the acne. The course starts to count hits at a small ε. \
                Here a ray begins beside the surface instead, as far away as the point's error may be; in a year's own \
                dialect, that year's ε holds.",
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
        shots: &[color("rays from the rounded point, t > 0", SPECKLED), color("rays that leave the surface", SHADOWS)],
        lacking: "its shadow rays happen to miss their own surfaces, or there are none",
    },
    Topic {
        name: "reflection",
        title: "Reflection",
        words: "At a mirror the light comes from where the mirrored ray ends: the same question as at the eye, so the function asks \
                itself. Each level shows mirrors in mirrors once more, until no more levels are wanted.",
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
        lacking: "no mirror is seen in it, or no levels of rays are wanted",
    },
    Topic {
        name: "refraction",
        title: "Refraction",
        words: "Light that goes into glass is bent towards the normal, by Snell's law, and away from it where it leaves. Beyond the \
                critical angle the root has no solution: nothing leaves, by total reflection, and until the next step \
                such places stay dark.",
        equations: &["t = η (d - (d·N) N) - √(1 - η² (1 - (d·N)²)) N,   η = n_1 / n_2", "L += k_t L(p, t)"],
        places: &[
            at("crates/durer-render/src/integrator/whitted/secondary.rs", "fn refract"),
            at("crates/durer-render/src/integrator/whitted/secondary.rs", "fn secondary"),
        ],
        shots: &[color("glass without light through it", MIRRORS), color("with transmitted rays", GLASS)],
        lacking: "no glass is seen in it, or no levels of rays are wanted",
    },
    Topic {
        name: "fresnel",
        title: "Fresnel's law",
        words: "Glass mirrors too: little where it is looked at from the front, all towards its edge. Schlick's formula comes near \
                Fresnel's; the rest of the light is transmitted.",
        equations: &[
            "F = F_0 + (1 - F_0) (1 - cos θ)⁵,   F_0 = ((n_1 - n_2) / (n_1 + n_2))²",
            "L += F k_r L(p, R) + (1 - F) k_t L(p, t)",
        ],
        places: &[at("crates/durer-render/src/integrator/whitted/secondary.rs", "fn fresnel_share")],
        shots: &[color("glass that only transmits", GLASS), color("divided by Fresnel's law", FRESNEL)],
        lacking: "no glass with a `refractionIndex` is seen in it",
    },
    Topic {
        name: "transforms",
        title: "Normals of transformed things",
        words: "An object under a matrix M is hit in its own space, by the ray moved by M⁻¹. Points and directions come back by M. \
                A normal does not: it must stay perpendicular to the surface, and goes by the inverse transpose. The mistake \
                is not seen while M only moves, turns and scales evenly.",
        equations: &["p = M p'", "wrong:   N = norm(M N')", "right:   N = norm(M⁻ᵀ N'),   for N·(M v) = N'·v = 0"],
        places: &[
            at("crates/durer-bvh/src/math/affine.rs", "fn normal"),
            at("crates/durer-bvh/src/math/affine.rs", "fn inverse_ray"),
            at("crates/durer-render/src/world/object.rs", "fn surface"),
            at("crates/durer-scene/src/dialect/compat.rs", "MovedNormals"),
        ],
        shots: &[color("normals by M", MOVED), color("normals by the inverse transpose of M", FRESNEL)],
        lacking: "nothing that is seen of it is sheared or scaled unevenly",
    },
    Topic {
        name: "supersampling",
        title: "Supersampling",
        words: "One ray a pixel sees only what lies in its middle: edges are stairs, and far patterns dissolve. Many rays, \
                weighted by a filter, make a pixel the mean of all around its middle. A camera with a lens is out of \
                focus only now: its rays leave from all over the lens.",
        equations: &["pixel = Σ w(x_i, y_i) L(x_i, y_i) / Σ w(x_i, y_i)"],
        places: &[
            at("crates/durer-scene/src/sampler.rs", "fn pixel_position"),
            at("crates/durer-render/src/film/filter.rs", "fn weight"),
            at("crates/durer-render/src/render/samples.rs", "fn aim"),
            at("crates/durer-render/src/film/film.rs", "fn resolve"),
        ],
        shots: &[color("one ray a pixel", FRESNEL), color("many rays a pixel", SAMPLED)],
        lacking: "its picture is the same with more rays",
    },
    Topic {
        name: "soft-shadows",
        title: "Soft shadows",
        words: "A lamp has some size, and where a part of it is seen there is half a shadow. So each ray to a lamp goes to another of \
                its points, chosen at random; the mean over many is the light of the part that is seen (Cook, Porter and \
                Carpenter, 1984). Before that all rays go to its middle, and shadows have hard edges.",
        equations: &["L = ∫ f V(p, q) L_e cos θ cos θ_q / |p - q|² dq", "one sample:   f V L_e cos θ / p_l(ω)"],
        places: &[
            at("crates/durer-render/src/integrator/path/direct.rs", "fn add_direct"),
            at("crates/durer-render/src/integrator/path/direct.rs", "fn visibility"),
            at("crates/durer-scene/src/light/area.rs", "fn sample"),
        ],
        shots: &[
            color("rays to the middle of each lamp", straight(Direct::Middle)),
            color("rays to points of it at random", straight(Direct::Lights)),
        ],
        lacking: "it has no surface that shines and throws shadows",
    },
    Topic {
        name: "bounces",
        title: "One bounce more",
        words: "What a lamp lights is a lamp in turn. The light that a surface scatters comes from all directions, and from each of \
                them it is the same question once more (Kajiya, 1986). One direction is chosen at random, as the surface \
                scatters, and followed. Colours go from wall to wall, and no shadow is quite black.",
        equations: &["L_o = L_e + ∫ f L_i cos θ dω", "one sample:   L_e + f L_i cos θ / p_b(ω)"],
        places: &[
            at("crates/durer-render/src/integrator/path/mod.rs", "fn bounce"),
            at("crates/durer-render/src/integrator/path/mod.rs", "fn shade"),
            at("crates/durer-render/src/integrator/path/scatter.rs", "fn spawn"),
        ],
        shots: &[
            color("light straight from lamps", paths(0, BOTH)),
            color("1 bounce more", paths(1, BOTH)),
            color("2 bounces more", paths(2, BOTH)),
            color("all bounces", paths(u32::MAX, BOTH)),
        ],
        lacking: "no light goes from thing to thing in it, or no bounces are wanted",
    },
    Topic {
        name: "mis",
        title: "Two ways to one light",
        words: "A lamp can be found by choosing a point of it, or by following a direction in which the surface scatters. The first is \
                good at small lamps and rough surfaces, the second at large lamps in smooth ones. Each alone has the right \
                mean; where it is bad, it has much noise. Weighed by how often each finds that very light, their sum is good at \
                both: multiple importance sampling (Veach, 1997).",
        equations: &[
            "points:   f V L_e cos θ / p_l(ω)",
            "directions:   f L_e cos θ / p_b(ω)",
            "both:   w_l times the first + w_b times the second,   w_l = p_l² / (p_l² + p_b²),   w_b = 1 - w_l",
        ],
        places: &[
            at("crates/durer-render/src/integrator/path/direct.rs", "fn power_heuristic"),
            at("crates/durer-render/src/integrator/path/direct.rs", "fn of_light"),
            at("crates/durer-render/src/integrator/path/direct.rs", "fn of_direction"),
        ],
        shots: &[
            color("points of lamps alone", straight(Direct::Lights)),
            color("directions alone", straight(Direct::Bsdf)),
            color("both, weighed", straight(Direct::Both)),
        ],
        lacking: "nothing of some size shines in it",
    },
    Topic {
        name: "caustic",
        title: "Caustics",
        words: "Mirrors and glass throw light on other things. A path from the eye comes through the glass to the lamp by chance only: \
                bright specks, or no light at all. Photons go the other way, from the lamp through the glass, and stay where they \
                come to rest; how dense they are there is the light (Jensen, 1996; Hachisuka and Jensen, 2009).",
        equations: &[
            "L = Σ f Φ_i k(|p - p_i| / r) / r²,   k(x) = 2 (1 - x²) / π",
            "each sample looks less far:   r_(i+1)² = r_i² (i + 2/3) / (i + 1)",
        ],
        places: &[
            at("crates/durer-render/src/integrator/path/photons/mod.rs", "fn trace"),
            at("crates/durer-render/src/integrator/path/photons/map.rs", "fn on_surface"),
            at("crates/durer-render/src/integrator/path/photons/mod.rs", "fn radius"),
        ],
        shots: &[color("paths alone", paths(u32::MAX, BOTH)), color("paths and photons", paths(u32::MAX, PHOTONS))],
        lacking: "nothing in it mirrors or refracts light of a lamp onto other things",
    },
    Topic {
        name: "spectrum",
        title: "A spectrum",
        words: "Glass bends blue light more than red. A path that has wavelengths knows how each is bent, and from there on keeps one; what the \
                eye makes of a wavelength is its colour. Before that the glass has one index for all of them.",
        equations: &["n(λ) = A + B / λ²", "Abbe's number:   V = (n_d - 1) / (n_F - n_C)"],
        places: &[
            at("crates/durer-scene/src/material/principled.rs", "fn ior_at"),
            at("crates/durer-render/src/integrator/path/scatter.rs", "fn select_hero"),
        ],
        shots: &[
            color("one index for all wavelengths", paths(u32::MAX, Carriage { disperses: false, ..SPECTRAL })),
            color("each wavelength has its own", paths(u32::MAX, SPECTRAL)),
        ],
        lacking: "none of its glass has a `transmissionDispersionScale`",
    },
];
