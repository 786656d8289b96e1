//! Tests of the materials and textures of pbrt-v3.

use super::super::material::alpha_of_roughness;
use super::third::{close, parts};
use super::*;
use durer_scene::material::HairMaterial;
use durer_scene::math::Vec3;

#[test]
fn roughness_follows_pbrt_v3_polynomial() {
    // For a roughness of 1, the logarithm is 0. A roughness below 0.001 is clamped.
    assert_eq!(alpha_of_roughness(1.0), 1.62142);
    let x = durer_scene::math::fp::ln(0.001);
    let least = 1.62142 + 0.819955 * x + 0.1734 * x * x + 0.0171201 * x * x * x + 0.000640711 * x * x * x * x;
    assert!((alpha_of_roughness(0.0) - least).abs() < 1e-4 && (least - 0.0477).abs() < 0.001, "{least}");
    let metal = |text: &str| parts(&format!("Material \"metal\" {text}"))[0].1.specular_roughness;
    assert!((metal("\"float roughness\" 0.1") - alpha_of_roughness(0.1).sqrt()).abs() < 1e-5);
    assert!((metal("\"float roughness\" 0.09 \"bool remaproughness\" \"false\"") - 0.3).abs() < 1e-5);
    assert_eq!(parts("Material \"glass\"")[0].1.specular_roughness, 0.0);
}

#[test]
fn mixes_reflect_the_sum_of_their_parts() {
    let whole = |parts: &[(f32, PrincipledMaterial)], of: fn(&PrincipledMaterial) -> Vec3| -> Vec3 {
        parts.iter().map(|(share, layers)| *share * of(layers)).sum()
    };
    let plastic = parts(
        "Material \"plastic\" \"rgb Kd\" [ 0.4 0.2 0.1 ] \"rgb Ks\" [ 0.1 0.2 0.3 ] \"float roughness\" 0.001 \"bool remaproughness\" \"false\"",
    );
    assert_eq!(plastic.len(), 2);
    close(whole(&plastic, |layers| layers.base_color), Vec3::new(0.4, 0.2, 0.1));
    let specular =
        |layers: &PrincipledMaterial| if layers.specular_weight > 0.0 { layers.specular_color } else { Vec3::ZERO };
    assert!((whole(&plastic, specular) - Vec3::new(0.1, 0.2, 0.3)).abs().max_element() < 2e-3);
    assert!(plastic.iter().any(|(_, layers)| (layers.specular_ior - 1.0 / 1.5).abs() < 1e-6));
    // Parts that are black are dropped.
    assert_eq!(parts("Material \"plastic\" \"rgb Ks\" [ 0 0 0 ]").len(), 1);
    let uber = parts(
        "Material \"uber\" \"rgb Kd\" [ 0.3 0.3 0.3 ] \"rgb Ks\" [ 0 0 0 ] \"rgb Kr\" [ 0.2 0.4 0.6 ] \"rgb Kt\" [ 0.5 0.5 0.5 ]\n\
         \"rgb opacity\" [ 0.25 0.25 0.25 ] \"float index\" 1.3",
    );
    close(whole(&uber, |layers| layers.base_color * (1.0 - layers.transmission_weight)), Vec3::splat(0.3));
    close(whole(&uber, |layers| layers.transmission_color * layers.transmission_weight), Vec3::splat(0.5));
    close(whole(&uber, |layers| layers.specular_color * layers.transmission_weight), Vec3::new(0.2, 0.4, 0.6));
    assert!(uber.iter().all(|(_, layers)| layers.opacity == 0.25));
    // Each material has the specified emission.
    let emissive = parts("AreaLightSource \"diffuse\" \"rgb L\" [ 2 4 6 ] Material \"plastic\"");
    close(whole(&emissive, |layers| layers.emission_luminance * layers.emission_color), Vec3::new(2.0, 4.0, 6.0));
}

#[test]
fn other_materials_read_their_parameters() {
    let only = |text: &str| {
        let mut parts = parts(text);
        assert_eq!(parts.len(), 1, "{text}");
        parts.remove(0).1
    };
    let glass = only("Material \"glass\" \"float eta\" 1.3 \"rgb Kr\" [ 0.5 0.5 0.5 ] \"rgb Kt\" [ 0.1 0.2 0.3 ]");
    assert_eq!((glass.transmission_weight, glass.specular_ior), (1.0, 1.3));
    assert_eq!((glass.specular_color, glass.transmission_color), (Vec3::splat(0.5), Vec3::new(0.1, 0.2, 0.3)));
    assert_eq!(only("Material \"glass\" \"float index\" 2").specular_ior, 2.0);
    let mirror = only("Material \"mirror\" \"rgb Kr\" [ 0.4 0.8 0.2 ]");
    close(mirror.specular_weight * mirror.base_color, Vec3::new(0.4, 0.8, 0.2));
    assert_eq!((mirror.base_metalness, mirror.specular_roughness), (1.0, 0.0));
    // The reflectance of copper at normal incidence is ((n - 1)^2 + k^2) / ((n + 1)^2 + k^2).
    let smooth = "\"float roughness\" 0.0001 \"bool remaproughness\" \"false\"";
    let copper = only(&format!("Material \"metal\" {smooth}")).base_color;
    close(copper, Vec3::new(0.95214, 0.61968, 0.51058));
    let rough = only("Material \"matte\" \"rgb Kd\" [ 0.5 0.5 0.5 ] \"float sigma\" 30");
    assert!(rough.base_diffuse_roughness > 0.3 && rough.base_color.x < 0.5);
    // `amount` is the share of the first material.
    let mixed = parts(
        "MakeNamedMaterial \"a\" \"string type\" \"matte\" \"rgb Kd\" [ 1 0 0 ]\n\
         MakeNamedMaterial \"b\" \"string type\" \"matte\" \"rgb Kd\" [ 0 0 1 ]\n\
         Material \"mix\" \"string namedmaterial1\" \"a\" \"string namedmaterial2\" \"b\" \"rgb amount\" [ 0.3 0.3 0.3 ]",
    );
    let all: Vec3 = mixed.iter().map(|(share, layers)| *share * layers.base_color).sum();
    close(all, Vec3::new(0.3, 0.0, 0.7));
    let disney = only("Material \"disney\" \"rgb color\" [ 0.1 0.2 0.3 ] \"float roughness\" 0.4");
    // The base colour is increased to compensate for the fraction that the boundary reflects.
    let color = Vec3::new(0.1, 0.2, 0.3);
    let more = disney.base_color / color;
    assert!((more - more.x).abs().max_element() < 1e-5 && (1.0..1.2).contains(&more.x), "{more}");
    assert_eq!(disney.specular_color, color);
    let half = parts("Material \"disney\" \"rgb color\" [ 0.1 0.2 0.3 ] \"float metallic\" 0.5");
    assert!(half.iter().any(|(share, layers)| (*share, layers.base_metalness) == (0.5, 1.0)), "{half:?}");
    assert!((disney.specular_roughness - 0.4).abs() < 1e-5);
}

#[test]
fn substrate_mean_albedo_follows_its_formula() {
    use durer_scene::bsdf::albedo::DielectricAlbedo;
    use durer_scene::material::principled::Facets;
    // The mean reflectance is 23/28 of (1 - Ks) Kd.
    let parts = parts("Material \"substrate\" \"rgb Kd\" [ 0.2 0.4 0.8 ] \"rgb Ks\" [ 0.04 0.04 0.04 ]");
    let (share, base) = parts.iter().find(|(_, layers)| layers.base_color != Vec3::ZERO).unwrap();
    let boundary = DielectricAlbedo::new(base.specular_ior, Facets::Ggx);
    let passing = 1.0 - boundary.mean(base.specular_roughness);
    let mean = *share * passing * base.base_color;
    assert!((mean / (Vec3::new(0.2, 0.4, 0.8) * 0.96 * 23.0 / 28.0) - Vec3::ONE).abs().max_element() < 5e-3, "{mean}");
    // The dependence on direction is 1 - (1 - cos / 2)^5.
    for cosine in [0.1, 0.3, 0.5, 0.7, 1.0] {
        let (half, wanted): (f32, f32) = (1.0 - 0.5 * cosine, 28.0 / 23.0);
        let formula = wanted * (1.0 - half * half * half * half * half);
        let ours = (1.0 - boundary.reflectance(cosine, base.specular_roughness)) / passing;
        assert!(
            (ours - formula).abs() < 0.12 && (cosine < 0.2 || (ours - formula).abs() < 0.04),
            "{cosine}: {ours} {formula}"
        );
    }
    // The mean reflectance of smooth microfacets is Ks + (1 - Ks) / 21.
    let (share, specular) = parts.iter().find(|(_, layers)| layers.base_color == Vec3::ZERO).unwrap();
    let ratio = (specular.specular_ior - 1.0) / (specular.specular_ior + 1.0);
    assert!((ratio * ratio - 0.04).abs() < 1e-5 && *share > 0.0);
}

#[test]
fn textures_read_pbrt_v3_parameters() {
    let color = |text: &str| {
        let text = format!("{text} Material \"matte\" \"texture Kd\" \"t\"");
        parts(&text)[0].1.base_color
    };
    close(
        color("Texture \"t\" \"color\" \"scale\" \"rgb tex1\" [ 0.2 0.4 0.6 ] \"color tex2\" [ 0.5 0.5 0.5 ]"),
        Vec3::new(0.1, 0.2, 0.3),
    );
    close(
        color("Texture \"t\" \"spectrum\" \"mix\" \"rgb tex1\" [ 1 0 0 ] \"rgb tex2\" [ 0 0 1 ] \"float amount\" 0.25"),
        Vec3::new(0.75, 0.0, 0.25),
    );
}

#[test]
fn hair_is_read_in_both_languages() {
    let hair = |text: &str| {
        let scene = clean(&format!(
            "Camera \"perspective\" WorldBegin {text} Shape \"curve\" \"point3 P\" [ 0 0 0 1 0 0 2 0 0 3 0 0 ] \"string type\" \"cylinder\""
        ));
        let number = scene.root.as_ref().unwrap().objects[0].material.unwrap() as usize;
        let Material::Hair(hair) = &scene.materials[number].value else { panic!("{text}") };
        hair.clone()
    };
    let usual = HairMaterial::default();
    assert_eq!(hair("Material \"hair\""), usual);
    let red = "\"float pheomelanin\" 2 \"float beta_m\" 0.2 \"float beta_n\" 0.4 \"float alpha\" 3 \"float eta\" 1.6";
    let [longitudinal_roughness, azimuthal_roughness] = [0.2, 0.4];
    let wanted = HairMaterial {
        eumelanin: 0.0,
        pheomelanin: 2.0,
        longitudinal_roughness,
        azimuthal_roughness,
        scale_tilt: 3.0,
        ior: 1.6,
        ..usual
    };
    assert_eq!(hair(&format!("Material \"hair\" {red}")), wanted);
    for word in ["reflectance", "color"] {
        let made = hair(&format!("Material \"hair\" \"rgb {word}\" [ 0.5 0.25 0.125 ]"));
        close(made.color.unwrap(), Vec3::new(0.5, 0.25, 0.125));
    }
    // Absorption takes precedence over other parameters, in this case in pbrt-v3.
    let made = hair("Material \"matte\" Material \"hair\" \"rgb sigma_a\" [ 1 2 3 ] \"rgb color\" [ 0.5 0.5 0.5 ]");
    assert_eq!((made.absorption, made.color), (Some(Vec3::new(1.0, 2.0, 3.0)), None));
}
