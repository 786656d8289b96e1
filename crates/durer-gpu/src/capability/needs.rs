//! Features that a scene and a job use.

use super::Feature;
use crate::layout::{MAX_PARTS, MAX_WHITTED_BOUNCES};
use durer_render::integrator::{DirectSampling, IntegratorKind};
use durer_render::render::{Job, Sampling};
use durer_render::world::{Geometry, Material, Object, Phong, Principled, ShadingRules, World};
use durer_scene::bsdf::microfacet::Ggx;
use durer_scene::light::Light;
use durer_scene::material::principled::{Backs, Facets, Layering, Surroundings, Walls};
use durer_scene::material::{Pattern as _, PatternMaterial};
use durer_scene::math::Color;
use durer_scene::shape::Primitive;
use durer_scene::spectrum::ColorMode;

/// Returns the features that a scene and a job use, with duplicates.
pub fn needs(world: &World, job: &Job) -> Vec<Feature> {
    let traces_paths = job.method.path_options().is_some();
    let mut found = of_job(job);
    found.extend([Feature::Cameras, Feature::Background]);
    let used = |object: &Object| match &object.geometry {
        // The parts of a solid have materials of their own.
        Geometry::Solid(_) => None,
        _ => Some(object.material),
    };
    for object in world.objects() {
        found.push(of_geometry(object));
        if object.to_world.is_some() {
            found.push(Feature::Transforms);
        }
        if let Geometry::Mesh(tree) = &object.geometry
            && !tree.mesh.colors().is_empty()
        {
            found.push(Feature::VertexColors);
        }
        if let Geometry::Mesh(tree) = &object.geometry
            && !tree.mesh.normals().0.is_empty()
            && !world.has_smooth_shadows(object.material)
        {
            found.push(Feature::FlatShadows);
        }
    }
    let mut materials: Vec<u32> = world.objects().iter().filter_map(used).collect();
    materials.sort_unstable();
    materials.dedup();
    for material in materials {
        if leaves(world, material, 0) > MAX_PARTS {
            found.push(Feature::DeepMixes);
        } else {
            of_material(world, material, traces_paths, &mut found);
        }
    }
    for (number, light) in world.lights().iter().enumerate() {
        let has_profile = world.profiles().get(number).is_some_and(Option::is_some);
        let is_photometric = has_profile || matches!(light, Light::Photometric(_));
        found.push(if is_photometric { Feature::PhotometricLights } else { Feature::Lights });
    }
    if world.environment().is_some() || world.cube_map().is_some() {
        found.push(Feature::Environments);
    }
    if world.fog().is_some() && traces_paths {
        found.push(Feature::Media);
    }
    if traces_paths && (world.has_cutouts() || world.hides_emitters() || world.has_unseen()) {
        found.push(Feature::Cutouts);
    }
    if world.glass_around(world.camera_frame().eye).next().is_some() {
        found.push(Feature::EyeInGlass);
    }
    if world.hit_rules().is_some() || *world.shading_rules() != ShadingRules::default() {
        found.push(Feature::DialectRules);
    }
    found
}

fn of_job(job: &Job) -> Vec<Feature> {
    let mut found = Vec::new();
    match job.method {
        IntegratorKind::Whitted(_) if job.settings.bounces > MAX_WHITTED_BOUNCES => found.push(Feature::ManyBounces),
        IntegratorKind::Whitted(_) => {}
        IntegratorKind::Path(options) => {
            if options.color != ColorMode::Rgb {
                found.push(Feature::Spectral);
            }
            if options.direct != DirectSampling::Both {
                found.push(Feature::OneStrategy);
            }
        }
        IntegratorKind::Photons(_) => found.push(Feature::Photons),
        IntegratorKind::Ao(_) => found.push(Feature::AmbientOcclusion),
    }
    if !matches!(job.sampling, Sampling::Center | Sampling::Filtered { .. }) {
        found.push(Feature::CourseSampling);
    }
    found
}

fn of_geometry(object: &Object) -> Feature {
    match &object.geometry {
        Geometry::Solid(_) => Feature::Solids,
        Geometry::Mesh(tree) if tree.mesh.is_terrain() => Feature::HeightFields,
        Geometry::Mesh(_) => Feature::Meshes,
        Geometry::Primitive(shape) => match shape {
            Primitive::Sphere(_) | Primitive::Ellipsoid(_) => Feature::Spheres,
            Primitive::Plane(_) => Feature::Planes,
            Primitive::Triangle(_) => Feature::Meshes,
            Primitive::Cuboid(_) => Feature::Boxes,
            Primitive::Cylinder(_) | Primitive::Cone(_) => Feature::Frustums,
            Primitive::Disc(_) | Primitive::Rectangle(_) => Feature::FlatShapes,
            Primitive::Torus(_) => Feature::Tori,
            Primitive::Quadric(_) => Feature::Quadrics,
        },
    }
}

/// Returns the number of materials that a material mixes, or more than [`MAX_PARTS`] if there are
/// too many.
fn leaves(world: &World, material: u32, depth: u32) -> u32 {
    match world.materials().get(material as usize) {
        Some(Material::Mix(..)) if depth > MAX_PARTS => MAX_PARTS + 1,
        Some(Material::Mix(pattern, ..)) => {
            pattern.materials().iter().map(|&part| leaves(world, part, depth + 1)).sum()
        }
        _ => 1,
    }
}

fn of_material(world: &World, material: u32, traces_paths: bool, found: &mut Vec<Feature>) {
    match &world.materials()[material as usize] {
        Material::Phong(phong) => of_phong(phong, traces_paths, found),
        Material::Mix(pattern, _, picture) => {
            found.push(match pattern {
                PatternMaterial::Checkerboard(_) | PatternMaterial::Mix(_) | PatternMaterial::TwoSided(_) => {
                    Feature::Patterns
                }
                PatternMaterial::Noise(_) | PatternMaterial::Marble(_) | PatternMaterial::Wood(_) => {
                    Feature::SolidTextures
                }
            });
            if picture.is_some() {
                found.push(Feature::Textures);
            }
            for part in pattern.materials() {
                of_material(world, part, traces_paths, found);
            }
        }
    }
}

fn of_phong(phong: &Phong, traces_paths: bool, found: &mut Vec<Feature>) {
    if phong.texture.is_some() {
        found.push(Feature::Textures);
    }
    if phong.noise.is_some() {
        found.push(Feature::SolidTextures);
    }
    if phong.fibre.is_some() && traces_paths {
        found.push(Feature::Hair);
    }
    if let Some(emission) = &phong.emission {
        found.push(Feature::EmissiveSurfaces);
        if emission.textured && traces_paths {
            found.push(Feature::Textures);
        }
    }
    match &phong.principled {
        Some(principled) if traces_paths => of_principled(principled, found),
        _ => {
            found.push(Feature::PhongMaterials);
            if phong.reflective != Color::ZERO || phong.transparent != Color::ZERO {
                found.push(Feature::MirrorsAndGlass);
            }
        }
    }
}

fn of_principled(principled: &Principled, found: &mut Vec<Feature>) {
    let m = &principled.definition;
    let is_smooth = Ggx::new(m.specular_roughness, 0.0).is_smooth();
    let is_plain = m.layering == Layering::OpenPbr
        && m.subsurface_weight == 0.0
        && m.coat_weight == 0.0
        && m.fuzz_weight == 0.0
        && m.thin_film_weight == 0.0
        && m.specular_anisotropy == 0.0
        && m.specular_facets == Facets::Ggx
        && m.metal_ior.is_none()
        && (m.transmission_weight == 0.0 || is_smooth)
        && m.walls == Walls::Solid
        && m.surroundings == Surroundings::Nested;
    found.push(if is_plain { Feature::PrincipledMaterials } else { Feature::Layers });
    if m.has_textures() {
        found.push(Feature::Textures);
    }
    if m.backs != Backs::Shown || m.opacity < 1.0 || m.opacity_cutoff.is_some() {
        found.push(Feature::Cutouts);
    }
    if principled.medium.is_some() || principled.interface {
        found.push(Feature::Media);
    }
}
