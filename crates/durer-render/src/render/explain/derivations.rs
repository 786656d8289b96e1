//! Derivations of the numbers in an explanation. They show the equation of a hit, the matrix of a
//! transformed object, the texels or the pattern cell of a colour, and Snell's and Fresnel's laws.

use super::numbers::{number, rgb, vector};
use crate::integrator::TraceNode;
use crate::integrator::trace::{HitRecord, RayRecord, TermKind};
use crate::world::{Geometry, Material, Object, Phong, World};
use durer_scene::describe::DescribedKind;
use durer_scene::material::Pattern as _;
use durer_scene::material::PatternMaterial;
use durer_scene::math::{Vec2, Vec3};
use durer_scene::scene::{Material as Written, Scene};
use durer_scene::shape::Primitive;
use durer_scene::texture::{CubeMap, Texture};
use glam::DVec3;

/// Returns lines of text that derive the numbers in a term of a trace. `dir` is the direction of
/// the ray that the term belongs to, and `n` is the normal at the hit of that ray.
pub fn derivations(node: &TraceNode, (scene, world): (&Scene, &World), dir: Vec3, n: Vec3) -> Vec<String> {
    match &node.kind {
        TermKind::Ray { ray, hit: Some(hit), .. } => of_hit(ray, hit, scene, world),
        TermKind::Secondary { here, there, fresnel, total } if here != there => {
            of_refraction(f64::from(*here), f64::from(*there), *fresnel, *total, dir, n)
        }
        TermKind::Sky => of_sky(dir, scene, world),
        _ => Vec::new(),
    }
}

fn real(x: f64) -> String {
    number(x as f32)
}

/// Returns the derivation of a hit and of the surface colour at the hit.
fn of_hit(ray: &RayRecord, hit: &HitRecord, scene: &Scene, world: &World) -> Vec<String> {
    let object = &world.objects()[hit.object as usize];
    let local = hit.local.as_ref().unwrap_or(ray);
    let mut lines: Vec<String> = equation(object, local, hit.t).into_iter().collect();
    lines.extend(matrix(object));
    lines.extend(of_color(hit, scene, world));
    lines
}

/// Returns the equation that was solved for a ray that hits a sphere or a plane.
fn equation(object: &Object, ray: &RayRecord, t: f32) -> Option<String> {
    // Show the equation only if it gives this hit, because an official program may have found a
    // different one.
    let is_it = |root: f64| (root - f64::from(t)).abs() <= 1e-3 * root.abs().max(1e-3);
    let (o, d) = (ray.origin.as_dvec3(), ray.dir.as_dvec3());
    match &object.geometry {
        Geometry::Primitive(Primitive::Sphere(sphere)) => {
            // The ray uses the coordinates of the scene file, but the geometry is relative to its
            // own centre.
            let (off, r) = (o - (sphere.center + object.center).as_dvec3(), f64::from(sphere.radius));
            let (a, b, c) = (d.dot(d), d.dot(off), off.dot(off) - r * r);
            let root = (b * b - a * c).max(0.0).sqrt();
            let roots = [(-b - root) / a, (-b + root) / a];
            roots.iter().any(|root| is_it(*root)).then(|| format!(
                "a t² + 2 b t + c = 0: a = d·d = {}, b = d·(o - C) = {}, c = |o - C|² - r² = {}; t = (-b ± √(b² - a c)) / a = {} \
                 or {}",
                real(a),
                real(b),
                real(c),
                real(roots[0]),
                real(roots[1])
            ))
        }
        Geometry::Primitive(Primitive::Plane(plane)) => {
            let n = plane.normal.as_dvec3();
            // The geometry of a plane is never moved to the origin.
            let (offset, no, nd) = (f64::from(plane.offset), n.dot(o), n.dot(d));
            is_it((offset - no) / nd).then(|| {
                format!(
                    "t = (offset - n·o) / n·d = ({} - {}) / {} = {}",
                    real(offset),
                    real(no),
                    real(nd),
                    real((offset - no) / nd)
                )
            })
        }
        Geometry::Primitive(_) | Geometry::Mesh(_) | Geometry::Solid(_) => None,
    }
}

/// Returns the matrix of a transformed object as text.
fn matrix(object: &Object) -> Option<String> {
    let to_world = object.to_world.as_ref()?;
    let columns = [Vec3::X, Vec3::Y, Vec3::Z].map(|axis| to_world.vector(axis));
    let by = object.world_point(-object.center);
    let row = |i: usize| {
        let numbers = [columns[0][i], columns[1][i], columns[2][i], by[i]].map(number);
        format!("({})", numbers.join(" "))
    };
    Some(format!("M = {} {} {}; N = norm(M⁻ᵀ n)", row(0), row(1), row(2)))
}

/// Returns text that explains where a surface colour comes from: pattern cells or blend weights,
/// and texels.
fn of_color(hit: &HitRecord, scene: &Scene, world: &World) -> Vec<String> {
    let (mut material, mut lines) = (hit.material, Vec::new());
    // Patterns can be nested.
    for _ in 0..8 {
        let Some(Material::Mix(solid, to_pattern, _)) = world.materials().get(material as usize) else { break };
        let q = to_pattern.transform_point3(hit.position.as_dvec3());
        let [first, second] = solid.materials();
        let share = match solid {
            PatternMaterial::TwoSided(_) | PatternMaterial::Mix(_) => None,
            _ => Some(solid.share(q.as_vec3(), world.shading_rules().conic_rings)),
        };
        let Some(share) = share else { break };
        let (chosen, text) = match solid {
            PatternMaterial::Checkerboard(_) => cell(q, share, [first, second]),
            _ => (
                if share == 1.0 {
                    Some(first)
                } else if share == 0.0 {
                    Some(second)
                } else {
                    None
                },
                format!(
                    "{} at {}: {} of material {first}, {} of material {second}",
                    solid.own_keyword(),
                    vector(q.as_vec3()),
                    number(share),
                    number(1.0 - share)
                ),
            ),
        };
        lines.push(text);
        let Some(next) = chosen else { break };
        material = next;
    }
    if let Some(Material::Phong(phong)) = world.materials().get(material as usize) {
        lines.extend(of_texture(hit, material, phong, scene, world));
    }
    lines
}

/// Describes a cell of a checkerboard.
fn cell(q: DVec3, share: f32, [first, second]: [u32; 2]) -> (Option<u32>, String) {
    let floor = q.as_vec3().floor();
    let (parity, chosen) = if share == 1.0 { ("even", first) } else { ("odd", second) };
    let [x, y, z] = floor.to_array();
    let text = format!(
        "checkerboard: {} lies in the cell ({}, {}, {}), and {} + {} + {} is {parity}: material {chosen}",
        vector(q.as_vec3()),
        number(x),
        number(y),
        number(z),
        number(x),
        number(y),
        number(z)
    );
    (Some(chosen), text)
}

/// Describes the texture lookup that gives a colour.
fn of_texture(hit: &HitRecord, material: u32, phong: &Phong, scene: &Scene, world: &World) -> Vec<String> {
    let (Some(uv), Some(index)) = (hit.uv, phong.texture) else { return Vec::new() };
    let Some(texture) = world.textures().get(index as usize) else { return Vec::new() };
    let file = match scene.materials.get(material as usize).map(|written| &written.value) {
        Some(Written::Phong(own, _)) => own.texture.as_ref(),
        Some(Written::Principled(own)) => own.base_color_texture.as_ref(),
        _ => None,
    };
    file.map_or(Vec::new(), |file| texels(&format!("texture `{}`", file.path), texture, uv))
}

/// Describes the lookup of the cube map that gives the colour of the sky.
fn of_sky(dir: Vec3, scene: &Scene, world: &World) -> Vec<String> {
    let (Some(map), Some(folder), None) = (world.cube_map(), &scene.background.cube_map, world.environment()) else {
        return Vec::new();
    };
    let (face, uv) = map.face(dir);
    texels(&format!("face `{}` of the cube map `{}`", CubeMap::FACES[face], folder.path), &map.faces[face], uv)
}

/// Describes a filtered texture lookup, with the texels and their weights.
fn texels(name: &str, texture: &Texture, uv: Vec2) -> Vec<String> {
    let (width, height) = texture.size();
    let first = format!(
        "{name} of {width} x {height} texels at uv ({}, {}): {} to the right, {} down: {}",
        number(uv.x),
        number(uv.y),
        number(uv.x * width as f32),
        number((1.0 - uv.y) * height as f32),
        rgb(texture.at(uv))
    );
    let line = |tap: &durer_scene::texture::Tap| {
        let (x, y) = tap.texel;
        let stored = tap.bytes.map_or(String::new(), |bytes| {
            let [r, g, b] = bytes;
            let plain = Vec3::from(bytes.map(|byte| f32::from(byte) / 255.0));
            let how = if (plain - tap.color).abs().max_element() < 1e-6 { "/ 255" } else { "by the sRGB curve" };
            format!("{r} {g} {b} {how} = ")
        });
        format!("{} · texel ({x}, {y}): {stored}{}", number(tap.weight), rgb(tap.color))
    };
    std::iter::once(first).chain(texture.taps(uv).iter().map(line)).collect()
}

/// Derives the direction of the refracted ray and the Fresnel reflectance.
fn of_refraction(here: f64, there: f64, fresnel: Option<f32>, total: bool, dir: Vec3, n: Vec3) -> Vec<String> {
    let (d, n) = (dir.as_dvec3().normalize_or_zero(), n.as_dvec3());
    let cos_i = d.dot(n).abs().min(1.0);
    let sin_i = (1.0 - cos_i * cos_i).max(0.0).sqrt();
    let sin_t = here / there * sin_i;
    let mut lines = vec![format!(
        "Snell: sin i = {}, sin t = n₁/n₂ sin i = {} / {} · {} = {}{}",
        real(sin_i),
        real(here),
        real(there),
        real(sin_i),
        real(sin_t),
        if sin_t > 1.0 { ", more than 1" } else { "" }
    )];
    let cos_t = (1.0 - sin_t * sin_t).max(0.0).sqrt();
    let r0 = ((there - here) / (there + here)) * ((there - here) / (there + here));
    let c = if here <= there { cos_i } else { cos_t };
    let left = (1.0 - c) * (1.0 - c);
    let r = r0 + (1.0 - r0) * left * left * (1.0 - c);
    // Some programs use a different R0 for rays that leave an object.
    if let Some(share) = fresnel.filter(|share| !total && (f64::from(*share) - r).abs() < 1e-3) {
        lines.push(format!(
            "Fresnel, by Schlick: R0 = ((n₂ - n₁) / (n₂ + n₁))² = {}, cos = {}; R = R0 + (1 - R0) (1 - cos)⁵ = {}",
            real(r0),
            real(c),
            number(share)
        ));
    }
    lines
}
