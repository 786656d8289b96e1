//! Scenes in which only the emitters are visible, for pbrt and Mitsuba files that allow no
//! scattering.

use durer_scene::material::PrincipledMaterial;
use durer_scene::math::Vec3;
use durer_scene::scene::{Material, Scene};

/// Makes all materials black, so that they scatter no light. The materials keep their emission and
/// opacity.
pub(super) fn blacken(scene: &mut Scene) {
    for material in &mut scene.materials {
        let own = match &material.value {
            Material::Principled(m) => (**m).clone(),
            Material::Solid(..) => continue,
            _ => PrincipledMaterial::default(),
        };
        material.value = Material::Principled(Box::new(PrincipledMaterial {
            base_color: Vec3::ZERO,
            specular_weight: 0.0,
            emission_luminance: own.emission_luminance,
            emission_color: own.emission_color,
            emission_texture: own.emission_texture,
            emission_spectrum: own.emission_spectrum,
            opacity: own.opacity,
            opacity_texture: own.opacity_texture,
            walls: own.walls,
            backs: own.backs,
            seen_by_camera: own.seen_by_camera,
            ..PrincipledMaterial::default()
        }));
    }
}
