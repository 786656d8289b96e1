//! Presets of real materials, selected by name.
//!
//! The values are taken from OpenPBR's own examples (Academy Software Foundation, *OpenPBR*, 2024).
//! Their colours are converted from ACEScg to Rec.709 and clamped to [0, 1]. Lengths use the same
//! units as the examples. Set `subsurfaceRadius` or `transmissionDepth` to suit the size of an
//! object.

use super::PrincipledMaterial;
use crate::describe::{Describe, Value};
use crate::math::Vec3;

/// Returns the preset with this name, or `None` if the name is unknown.
pub fn preset(name: &str) -> Option<PrincipledMaterial> {
    let (_, values) = PRESETS.iter().find(|row| row.0 == name)?;
    let mut material = PrincipledMaterial::default();
    for (word, numbers) in *values {
        let field = PrincipledMaterial::FIELDS.iter().position(|field| field.name == *word)?;
        material.set(
            field,
            match **numbers {
                [x, y, z] => Value::Vec3(Vec3::new(x, y, z)),
                [x, ..] => Value::Float(x),
                [] => continue,
            },
        );
    }
    Some(material)
}

/// Preset of a principled material, given by its name and the fields that differ from their
/// defaults.
type Preset = (&'static str, &'static [(&'static str, &'static [f32])]);

/// All presets, listed by name.
#[rustfmt::skip]
pub const PRESETS: &[Preset] = &[
    ("aluminum-brushed", &[
        ("base_color", &[0.915, 0.923, 0.923]), ("base_metalness", &[1.0]),
        ("specular_color", &[0.91, 0.935, 0.959]), ("specular_roughness", &[0.2]),
        ("specular_anisotropy", &[0.9])]),
    ("beryllium", &[
        ("base_color", &[0.539, 0.534, 0.534]), ("base_metalness", &[1.0]),
        ("specular_color", &[0.73, 0.738, 0.754]), ("specular_roughness", &[0.02])]),
    ("blackboard", &[
        ("base_color", &[0.039, 0.039, 0.039]), ("base_diffuse_roughness", &[1.0]),
        ("specular_roughness", &[1.0])]),
    ("blood", &[
        ("specular_roughness", &[0.0]), ("specular_ior", &[1.35]), ("transmission_weight", &[1.0]),
        ("transmission_color", &[0.644, 0.00299, 0.00506]), ("transmission_depth", &[0.08]),
        ("transmission_dispersion_scale", &[1.0]), ("transmission_dispersion_abbe_number", &[54.0])]),
    ("brass", &[
        ("base_color", &[0.913, 0.777, 0.424]), ("base_metalness", &[1.0]),
        ("specular_color", &[0.95, 0.978, 1.0]), ("specular_roughness", &[0.02])]),
    ("brick", &[
        ("base_color", &[0.263, 0.0947, 0.0612]), ("base_diffuse_roughness", &[1.0]),
        ("specular_roughness", &[1.0])]),
    ("carpaint", &[
        ("base_color", &[0.0, 0.662, 0.958]), ("specular_ior", &[1.6]), ("specular_roughness", &[0.3]),
        ("coat_weight", &[1.0]), ("coat_roughness", &[0.02]), ("coat_ior", &[1.6])]),
    ("cesium", &[
        ("base_color", &[0.706, 0.554, 0.257]), ("base_metalness", &[1.0]),
        ("specular_color", &[1.0, 1.0, 1.0]), ("specular_roughness", &[0.02])]),
    ("charcoal", &[
        ("base_color", &[0.02, 0.02, 0.02]), ("base_diffuse_roughness", &[1.0]),
        ("specular_roughness", &[1.0])]),
    ("chocolate", &[
        ("specular_roughness", &[0.5]), ("subsurface_weight", &[1.0]),
        ("subsurface_color", &[0.162, 0.092, 0.059]), ("subsurface_radius_scale", &[0.1, 0.05, 0.025])]),
    ("chromium", &[
        ("base_color", &[0.653, 0.684, 0.701]), ("base_metalness", &[1.0]),
        ("specular_color", &[0.687, 0.728, 0.798]), ("specular_roughness", &[0.02])]),
    ("cobalt", &[
        ("base_color", &[0.698, 0.704, 0.672]), ("base_metalness", &[1.0]),
        ("specular_color", &[0.727, 0.773, 0.822]), ("specular_roughness", &[0.02])]),
    ("coffee", &[
        ("specular_roughness", &[0.0]), ("specular_ior", &[1.34]), ("transmission_weight", &[1.0]),
        ("transmission_color", &[0.447, 0.133, 0.0335]), ("transmission_depth", &[0.1]),
        ("transmission_dispersion_scale", &[1.0]), ("transmission_dispersion_abbe_number", &[55.78])]),
    ("concrete", &[("base_color", &[0.51, 0.51, 0.51]), ("specular_roughness", &[0.5])]),
    ("cooking-oil", &[
        ("specular_roughness", &[0.0]), ("specular_ior", &[1.47]), ("transmission_weight", &[1.0]),
        ("transmission_color", &[0.738, 0.687, 0.0914])]),
    ("copper", &[
        ("base_color", &[0.938, 0.622, 0.523]), ("base_metalness", &[1.0]),
        ("specular_color", &[0.984, 0.947, 0.945]), ("specular_roughness", &[0.02])]),
    ("diamond", &[("specular_roughness", &[0.0]), ("specular_ior", &[2.42]), ("transmission_weight", &[1.0]),
        ("transmission_dispersion_scale", &[1.0]), ("transmission_dispersion_abbe_number", &[55.3])]),
    ("egg-shell", &[("base_color", &[0.61, 0.624, 0.631]), ("specular_roughness", &[0.8])]),
    ("eye-cornea", &[("specular_roughness", &[0.0]), ("specular_ior", &[1.38]), ("transmission_weight", &[1.0])]),
    ("eye-lens", &[("specular_roughness", &[0.0]), ("specular_ior", &[1.39]), ("transmission_weight", &[1.0])]),
    ("eye-sclera", &[
        ("specular_roughness", &[0.5]), ("specular_ior", &[1.4]), ("subsurface_weight", &[1.0]),
        ("subsurface_color", &[0.652, 0.5, 0.394]), ("subsurface_radius_scale", &[0.482, 0.169, 0.109])]),
    ("gasoline", &[
        ("specular_roughness", &[0.0]), ("specular_ior", &[1.43]), ("transmission_weight", &[1.0]),
        ("transmission_color", &[1.0, 0.97, 0.618])]),
    ("germanium", &[
        ("base_color", &[0.5, 0.517, 0.466]), ("base_metalness", &[1.0]),
        ("specular_color", &[0.62, 0.653, 0.701]), ("specular_roughness", &[0.02])]),
    ("glass", &[("specular_roughness", &[0.0]), ("specular_ior", &[1.52]), ("transmission_weight", &[1.0]),
        ("transmission_dispersion_scale", &[1.0]), ("transmission_dispersion_abbe_number", &[64.0])]),
    ("gold", &[
        ("base_color", &[1.0, 0.774, 0.307]), ("base_metalness", &[1.0]),
        ("specular_color", &[0.97, 1.0, 0.995]), ("specular_roughness", &[0.02])]),
    ("gray-card", &[("base_color", &[0.18, 0.18, 0.18]), ("specular_roughness", &[0.9])]),
    ("honey-crystallized", &[
        ("specular_roughness", &[0.2]), ("subsurface_weight", &[1.0]),
        ("subsurface_color", &[0.449, 0.319, 0.011]), ("subsurface_radius_scale", &[0.2, 0.2, 0.2])]),
    ("honey-liquid", &[
        ("specular_roughness", &[0.0]), ("specular_ior", &[1.5]), ("transmission_weight", &[1.0]),
        ("transmission_color", &[0.831, 0.571, 0.0372])]),
    ("ice", &[("specular_roughness", &[0.5]), ("specular_ior", &[1.31]), ("transmission_weight", &[1.0]),
        ("transmission_dispersion_scale", &[1.0]), ("transmission_dispersion_abbe_number", &[64.87])]),
    ("iridium", &[
        ("base_color", &[0.745, 0.734, 0.705]), ("base_metalness", &[1.0]),
        ("specular_color", &[0.757, 0.781, 0.81]), ("specular_roughness", &[0.02])]),
    ("iron", &[
        ("base_color", &[0.531, 0.513, 0.494]), ("base_metalness", &[1.0]),
        ("specular_color", &[0.764, 0.768, 0.801]), ("specular_roughness", &[0.02])]),
    ("ketchup", &[
        ("specular_roughness", &[0.1]), ("specular_ior", &[1.3]), ("subsurface_weight", &[1.0]),
        ("subsurface_color", &[0.165, 0.006, 0.002]), ("subsurface_radius_scale", &[0.476, 0.058, 0.039])]),
    ("lcd-display-6500k", &[("emission_color", &[0.999, 0.943, 0.992]), ("emission_luminance", &[200.0])]),
    ("lead", &[
        ("base_color", &[0.624, 0.64, 0.693]), ("base_metalness", &[1.0]),
        ("specular_color", &[0.758, 0.773, 0.799]), ("specular_roughness", &[0.02])]),
    ("light-bulb-2700k", &[("emission_color", &[1.0, 0.415, 0.0987]), ("emission_luminance", &[10000.0])]),
    ("light-bulb-5000k", &[("emission_color", &[1.0, 0.792, 0.628]), ("emission_luminance", &[10000.0])]),
    ("lithium", &[
        ("base_color", &[0.916, 0.889, 0.808]), ("base_metalness", &[1.0]),
        ("specular_color", &[0.984, 0.999, 1.0]), ("specular_roughness", &[0.02])]),
    ("magnesium", &[
        ("base_color", &[0.957, 0.953, 0.951]), ("base_metalness", &[1.0]),
        ("specular_color", &[0.953, 0.964, 0.977]), ("specular_roughness", &[0.02])]),
    ("manganese", &[
        ("base_color", &[0.607, 0.591, 0.573]), ("base_metalness", &[1.0]),
        ("specular_color", &[0.796, 0.834, 0.888]), ("specular_roughness", &[0.02])]),
    ("marble", &[
        ("specular_roughness", &[0.0]), ("subsurface_weight", &[1.0]),
        ("subsurface_color", &[0.83, 0.791, 0.753]), ("subsurface_radius_scale", &[0.851, 0.557, 0.395])]),
    ("mercury", &[
        ("base_color", &[0.782, 0.78, 0.779]), ("base_metalness", &[1.0]),
        ("specular_color", &[0.812, 0.852, 0.902]), ("specular_roughness", &[0.02])]),
    ("milk", &[
        ("specular_roughness", &[0.0]), ("specular_ior", &[1.35]), ("subsurface_weight", &[1.0]),
        ("subsurface_color", &[0.815, 0.813, 0.682]), ("subsurface_radius_scale", &[1.842, 1.044, 0.35])]),
    ("molybdenum", &[
        ("base_color", &[0.589, 0.612, 0.594]), ("base_metalness", &[1.0]),
        ("specular_color", &[0.683, 0.696, 0.725]), ("specular_roughness", &[0.02])]),
    ("nickel", &[
        ("base_color", &[0.698, 0.64, 0.564]), ("base_metalness", &[1.0]),
        ("specular_color", &[0.815, 0.834, 0.87]), ("specular_roughness", &[0.02])]),
    ("office-paper", &[("base_color", &[0.794, 0.834, 0.884]), ("specular_roughness", &[0.8])]),
    ("palladium", &[
        ("base_color", &[0.735, 0.703, 0.663]), ("base_metalness", &[1.0]),
        ("specular_color", &[0.81, 0.836, 0.871]), ("specular_roughness", &[0.02])]),
    ("pearl", &[
        ("subsurface_weight", &[1.0]), ("subsurface_color", &[0.799, 0.75, 0.701]),
        ("subsurface_radius_scale", &[0.3, 0.5, 0.3]), ("coat_weight", &[1.0]), ("coat_roughness", &[0.15]),
        ("coat_ior", &[1.68]), ("thin_film_weight", &[1.0]), ("thin_film_thickness", &[0.4]), ("thin_film_ior", &[2.0])]),
    ("petroleum", &[
        ("specular_roughness", &[0.0]), ("subsurface_weight", &[1.0]),
        ("subsurface_color", &[0.031, 0.027, 0.023]), ("subsurface_radius_scale", &[3.0, 1.0, 0.25])]),
    ("plastic-acrylic", &[
        ("specular_roughness", &[0.0]), ("specular_ior", &[1.49]), ("transmission_weight", &[1.0]),
        ("transmission_dispersion_scale", &[1.0]), ("transmission_dispersion_abbe_number", &[53.18])]),
    ("plastic-pc", &[("specular_roughness", &[0.0]), ("specular_ior", &[1.58]), ("transmission_weight", &[1.0]),
        ("transmission_dispersion_scale", &[1.0]), ("transmission_dispersion_abbe_number", &[27.86])]),
    ("plastic-pet", &[("specular_roughness", &[0.0]), ("specular_ior", &[1.57]), ("transmission_weight", &[1.0])]),
    ("plastic-polyurethane", &[
        ("specular_roughness", &[0.0]), ("specular_ior", &[1.6]), ("transmission_weight", &[1.0])]),
    ("plastic-pp", &[("specular_roughness", &[0.0]), ("specular_ior", &[1.49]), ("transmission_weight", &[1.0])]),
    ("plastic-pvc", &[("specular_roughness", &[0.0]), ("specular_ior", &[1.54]), ("transmission_weight", &[1.0])]),
    ("platinum", &[
        ("base_color", &[0.765, 0.73, 0.676]), ("base_metalness", &[1.0]),
        ("specular_color", &[0.792, 0.815, 0.84]), ("specular_roughness", &[0.02])]),
    ("potassium", &[
        ("base_color", &[0.984, 0.956, 0.907]), ("base_metalness", &[1.0]),
        ("specular_color", &[1.0, 1.0, 1.0]), ("specular_roughness", &[0.02])]),
    ("quartz", &[("specular_roughness", &[0.0]), ("specular_ior", &[1.54]), ("transmission_weight", &[1.0]),
        ("transmission_dispersion_scale", &[1.0]), ("transmission_dispersion_abbe_number", &[67.82])]),
    ("rubidium", &[
        ("base_color", &[0.921, 0.859, 0.748]), ("base_metalness", &[1.0]),
        ("specular_color", &[1.0, 1.0, 1.0]), ("specular_roughness", &[0.02])]),
    ("salt", &[("specular_roughness", &[0.2]), ("specular_ior", &[1.54]), ("transmission_weight", &[1.0]),
        ("transmission_dispersion_scale", &[1.0]), ("transmission_dispersion_abbe_number", &[42.89])]),
    ("sand", &[
        ("base_color", &[0.44, 0.386, 0.231]), ("base_diffuse_roughness", &[1.0]),
        ("specular_roughness", &[1.0])]),
    ("sapphire", &[
        ("specular_roughness", &[0.0]), ("specular_ior", &[1.77]), ("transmission_weight", &[1.0]),
        ("transmission_color", &[0.67, 0.764, 0.855]),
        ("transmission_dispersion_scale", &[1.0]), ("transmission_dispersion_abbe_number", &[72.2])]),
    ("silicon", &[
        ("base_color", &[0.345, 0.369, 0.426]), ("base_metalness", &[1.0]),
        ("specular_color", &[0.72, 0.701, 0.664]), ("specular_roughness", &[0.02])]),
    ("silver", &[
        ("base_color", &[0.991, 0.985, 0.973]), ("base_metalness", &[1.0]),
        ("specular_color", &[0.995, 0.995, 0.998]), ("specular_roughness", &[0.02])]),
    ("skin-i", &[
        ("specular_roughness", &[0.5]), ("specular_ior", &[1.4]), ("subsurface_weight", &[1.0]),
        ("subsurface_color", &[0.847, 0.639, 0.553]), ("subsurface_radius_scale", &[0.482, 0.169, 0.109])]),
    ("skin-ii", &[
        ("specular_roughness", &[0.5]), ("specular_ior", &[1.4]), ("subsurface_weight", &[1.0]),
        ("subsurface_color", &[0.799, 0.485, 0.347]), ("subsurface_radius_scale", &[0.482, 0.169, 0.109])]),
    ("skin-iii", &[
        ("specular_roughness", &[0.5]), ("specular_ior", &[1.4]), ("subsurface_weight", &[1.0]),
        ("subsurface_color", &[0.623, 0.433, 0.343]), ("subsurface_radius_scale", &[0.482, 0.169, 0.109])]),
    ("skin-iv", &[
        ("specular_roughness", &[0.5]), ("specular_ior", &[1.4]), ("subsurface_weight", &[1.0]),
        ("subsurface_color", &[0.437, 0.227, 0.131]), ("subsurface_radius_scale", &[0.367, 0.137, 0.068])]),
    ("skin-v", &[
        ("specular_roughness", &[0.5]), ("specular_ior", &[1.4]), ("subsurface_weight", &[1.0]),
        ("subsurface_color", &[0.282, 0.149, 0.079]), ("subsurface_radius_scale", &[0.367, 0.137, 0.068])]),
    ("skin-vi", &[
        ("specular_roughness", &[0.5]), ("specular_ior", &[1.4]), ("subsurface_weight", &[1.0]),
        ("subsurface_color", &[0.09, 0.05, 0.02]), ("subsurface_radius_scale", &[0.367, 0.137, 0.068])]),
    ("snow", &[
        ("specular_roughness", &[0.5]), ("specular_ior", &[1.31]), ("subsurface_weight", &[1.0]),
        ("subsurface_color", &[0.85, 0.85, 0.85]), ("subsurface_radius_scale", &[0.2, 0.2, 1.0])]),
    ("soap-bubble", &[
        ("specular_roughness", &[0.0]), ("specular_ior", &[1.0]), ("transmission_weight", &[1.0]),
        ("thin_film_weight", &[1.0]), ("thin_film_thickness", &[0.5]), ("thin_film_ior", &[1.4])]),
    ("sodium", &[
        ("base_color", &[0.977, 0.961, 0.936]), ("base_metalness", &[1.0]),
        ("specular_color", &[0.998, 1.0, 1.0]), ("specular_roughness", &[0.02])]),
    ("stainless-steel", &[
        ("base_color", &[0.67, 0.638, 0.598]), ("base_metalness", &[1.0]),
        ("specular_color", &[0.787, 0.823, 0.87]), ("specular_roughness", &[0.02])]),
    ("tire", &[("base_color", &[0.023, 0.023, 0.023]), ("specular_roughness", &[0.7])]),
    ("titanium", &[
        ("base_color", &[0.442, 0.401, 0.361]), ("base_metalness", &[1.0]),
        ("specular_color", &[0.864, 0.905, 0.946]), ("specular_roughness", &[0.02])]),
    ("toner-black", &[("base_color", &[0.05, 0.05, 0.05]), ("specular_roughness", &[0.5])]),
    ("tungsten", &[
        ("base_color", &[0.538, 0.535, 0.52]), ("base_metalness", &[1.0]),
        ("specular_color", &[0.695, 0.703, 0.715]), ("specular_roughness", &[0.02])]),
    ("vanadium", &[
        ("base_color", &[0.534, 0.526, 0.545]), ("base_metalness", &[1.0]),
        ("specular_color", &[0.705, 0.715, 0.696]), ("specular_roughness", &[0.02])]),
    ("velvet", &[
        ("base_color", &[0.0771, 0.000494, 0.307]), ("base_diffuse_roughness", &[1.0]),
        ("specular_roughness", &[1.0]), ("fuzz_weight", &[0.5]), ("fuzz_color", &[0.351, 0.224, 0.498]),
        ("fuzz_roughness", &[0.5])]),
    ("water", &[("specular_roughness", &[0.0]), ("specular_ior", &[1.33]), ("transmission_weight", &[1.0]),
        ("transmission_dispersion_scale", &[1.0]), ("transmission_dispersion_abbe_number", &[55.78])]),
    ("whiteboard", &[("base_color", &[0.869, 0.867, 0.772]), ("specular_roughness", &[0.0])]),
    ("zinc", &[
        ("base_color", &[0.806, 0.844, 0.864]), ("base_metalness", &[1.0]),
        ("specular_color", &[0.763, 0.833, 0.897]), ("specular_roughness", &[0.02])]),
];

#[cfg(test)]
mod tests {
    use super::*;
    use crate::describe::Field;

    #[test]
    fn presets_satisfy_the_rules_of_their_fields() {
        assert!(PRESETS.len() > 60);
        for (name, values) in PRESETS {
            let material = preset(name).unwrap();
            for (word, _) in *values {
                let field: &Field = PrincipledMaterial::FIELDS.iter().find(|field| field.name == *word).unwrap();
                let index = PrincipledMaterial::FIELDS.iter().position(|field| field.name == *word).unwrap();
                let value = material.get(index).unwrap();
                assert_eq!(field.constraint.validate(&value), Ok(()), "{name}: {word}");
            }
        }
        assert_eq!(preset("gold").unwrap().base_metalness, 1.0);
        assert!(preset("unobtainium").is_none());
    }
}
