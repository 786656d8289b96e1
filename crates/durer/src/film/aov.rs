//! What a picture can show beside colour: one table.
//!
//! These pictures are made of one ray through each pixel's centre. Files of floating point get the values as
//! they are; eight-bit files get a picture of them between 0 and 1.

use crate::bvh::Counts;
use crate::dialect::{Compat, DepthPicture, NormalsPicture, Rules};
use crate::math::{Aabb, Color, Vec3};
use crate::sampler::hash;
use crate::shape::Surface;
use crate::world::Hit;

/// What the ray through a pixel's centre found.
#[derive(Clone, Copy, Debug)]
pub struct Seen {
    /// Whether the camera sees anything through this pixel.
    pub covered: bool,
    /// The hit and its surface, if there was one.
    pub hit: Option<(Hit, Surface)>,
    /// Number of the material hit.
    pub material: u32,
    /// The work for the pixel, with all secondary rays.
    pub counts: Counts,
}

/// What is needed to make a picture of values.
#[derive(Clone, Copy, Debug)]
pub struct Display<'a> {
    /// Rules of the scene's dialect.
    pub rules: &'a Rules,
    /// Depths that become black and white.
    pub depth_range: (f32, f32),
    /// The box of all positions in the picture.
    pub positions: Aabb,
    /// The greatest cost in the picture.
    pub greatest_cost: f32,
}

/// One kind of picture.
#[derive(Debug)]
pub struct Aov {
    /// Its name on the command line and in files.
    pub name: &'static str,
    /// What it shows.
    pub doc: &'static str,
    /// The value at a pixel, as files of floating point have it.
    pub value: fn(&Seen) -> Vec3,
    /// The value as a colour; the flag tells whether anything was hit.
    pub picture: fn(Vec3, bool, &Display) -> Color,
}

impl Aov {
    /// The one of a name.
    pub fn from_name(name: &str) -> Option<&'static Aov> {
        AOVS.iter().find(|aov| aov.name == name)
    }
}

/// Gives pixels without a hit the colour of the hit before them: rows from the bottom, each from the left.
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

/// All kinds of picture beside colour.
pub static AOVS: [Aov; 8] = [
    Aov {
        name: "depth",
        doc: "t of the first hit: the distance, for cameras; infinite where nothing is hit",
        value: |seen| Vec3::splat(seen.hit.map_or(f32::INFINITY, |(hit, _)| hit.t)),
        picture: depth_picture,
    },
    Aov {
        name: "normals",
        doc: "the shading normal in world space",
        value: |seen| of_surface(seen, |s| s.n_shade),
        picture: |n, _, display| match display.rules.normals_picture {
            NormalsPicture::Abs => n.abs(),
            NormalsPicture::Half => (n + 1.0) * 0.5,
        },
    },
    Aov {
        name: "position",
        doc: "the point in world space; as a picture, within the box of all points seen",
        value: |seen| of_surface(seen, |s| s.position),
        picture: |p, hit, display| {
            let size = display.positions.size();
            let one =
                |axis: usize| if size[axis] > 0.0 { (p[axis] - display.positions.min[axis]) / size[axis] } else { 0.5 };
            if hit { Vec3::new(one(0), one(1), one(2)) } else { Vec3::ZERO }
        },
    },
    Aov {
        name: "uv",
        doc: "texture coordinates in red and green, 0 where there are none; as a picture, their fraction",
        value: |seen| of_surface(seen, |s| s.uv.unwrap_or_default().extend(0.0)),
        picture: |uv, _, _| uv - uv.floor(),
    },
    Aov {
        name: "barycentric",
        doc: "barycentric coordinates on the triangle, 0 on other shapes",
        value: |seen| of_surface(seen, |s| s.barycentric),
        picture: |b, _, _| b,
    },
    Aov {
        name: "object",
        doc: "number of the object, -1 where there is none; as a picture, a colour of its own",
        value: |seen| Vec3::splat(seen.hit.map_or(-1.0, |(hit, _)| hit.object as f32)),
        picture: |id, hit, _| if hit { id_color(id.x) } else { Vec3::ZERO },
    },
    Aov {
        name: "material",
        doc: "number of the material, -1 where there is none; as a picture, a colour of its own",
        value: |seen| Vec3::splat(if seen.hit.is_some() { seen.material as f32 } else { -1.0 }),
        picture: |id, hit, _| if hit { id_color(id.x) } else { Vec3::ZERO },
    },
    Aov {
        name: "cost",
        doc: "tests of boxes and shapes for the pixel, with all secondary rays; as a picture, a heat map",
        value: |seen| Vec3::splat((seen.counts.nodes + seen.counts.tests) as f32),
        picture: |cost, _, display| heat(cost.x / display.greatest_cost.max(1.0)),
    },
];

fn of_surface(seen: &Seen, value: impl Fn(&Surface) -> Vec3) -> Vec3 {
    seen.hit.map_or(Vec3::ZERO, |(_, surface)| value(&surface))
}

fn depth_picture(depth: Vec3, hit: bool, display: &Display) -> Color {
    let (min, max) = display.depth_range;
    let black_sky = display.rules.has(Compat::BlackSky);
    Vec3::splat(match display.rules.depth_picture {
        DepthPicture::NearWhite if !hit => 0.0,
        DepthPicture::NearWhite => ((max - depth.x) / (max - min)).clamp(0.0, 1.0),
        DepthPicture::NearBlack if !hit => {
            if black_sky {
                0.0
            } else {
                1.0
            }
        }
        DepthPicture::NearBlack => ((depth.x - min) / (max - min)).clamp(0.0, 1.0),
    })
}

/// A bright colour that differs from number to number.
fn id_color(id: f32) -> Color {
    let bits = hash(0, id as u32, 0, 0, 0);
    let channel = |shift: u32| 0.25 + 0.75 * ((bits >> shift) & 0xff) as f32 / 255.0;
    Vec3::new(channel(0), channel(8), channel(16))
}

/// Black, blue, red, yellow, white as x goes from 0 to 1.
fn heat(x: f32) -> Color {
    const STEPS: [Vec3; 5] =
        [Vec3::ZERO, Vec3::new(0.1, 0.1, 0.8), Vec3::new(0.9, 0.1, 0.1), Vec3::new(1.0, 0.9, 0.1), Vec3::ONE];
    let place = x.clamp(0.0, 1.0) * 4.0;
    let step = (place as usize).min(3);
    let part = place - step as f32;
    (1.0 - part) * STEPS[step] + part * STEPS[step + 1]
}
