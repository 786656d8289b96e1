//! Tests that textures keep the sixteen-bit and floating-point values and the opacity of their
//! files.

use super::*;
use ::image::{ExtendedColorType, ImageEncoder, codecs::png::PngEncoder};
use durer_image::linear_from_srgb;
use durer_render::integrator::IntegratorKind;
use durer_render::render::{Control, Job, Sampling, render};
use durer_scene::math::{Color, Vec2};
use durer_scene::texture::{Mapping, Texture};

/// Returns the texture that is compiled from a picture, or the error.
fn texture(field: &str, name: &str, bytes: &[u8], memory: Option<u64>) -> Result<Texture, String> {
    let text = format!(
        "PerspectiveCamera {{ center 0 0 5 direction 0 0 -1 up 0 1 0 angle 40 }} Materials {{ PrincipledMaterial {{ {field} {name} }} }}
         Group {{ MaterialIndex 0 Sphere {{ center 0 0 0 radius 1 }} }}"
    );
    let in_memory = vec![(name.to_string(), bytes.into())];
    let options = LoadOptions { in_memory, memory, dialect: Some(Dialect::Durer), ..LoadOptions::default() };
    let (mut files, mut found) = (Files::default(), Diagnostics::default());
    let loaded = load_text(Path::new("scene.txt"), text.as_bytes().into(), &options, &mut files, &mut found);
    let world = loaded.and_then(|loaded| loaded.compile(&options, &mut files, &mut found));
    let messages = || found.iter().map(|finding| finding.message.clone()).collect();
    world.map(|world| world.textures()[0].clone()).ok_or_else(messages)
}

/// Encodes one floating-point pixel as a PFM file.
fn pfm(pixel: [f32; 3]) -> Vec<u8> {
    [b"PF\n1 1\n-1.0\n".to_vec(), pixel.iter().flat_map(|x| x.to_le_bytes()).collect()].concat()
}

#[test]
fn values_above_white_are_kept() {
    let texture = |field, pixel| texture(field, "a.pfm", &pfm(pixel), None);
    for field in ["emissionTexture", "baseColorTexture", "specularRoughnessTexture"] {
        assert_eq!(texture(field, [3.0, 0.5, 0.25]).unwrap().at(Vec2::ZERO), Color::new(3.0, 0.5, 0.25), "{field}");
    }
    // A texel that is not finite is replaced. The tests of `durer-formats` check the warning.
    assert_eq!(texture("emissionTexture", [f32::NAN, 0.0, 0.0]).unwrap().at(Vec2::ZERO), Color::ZERO);
}

#[test]
fn sixteen_bit_textures_keep_precision_and_opacity() {
    let pixel = [30000u16, 301, 65535, 40001];
    let mut bytes = Vec::new();
    let values: Vec<u8> = pixel.iter().flat_map(|value| value.to_ne_bytes()).collect();
    PngEncoder::new(&mut bytes).write_image(&values, 1, 1, ExtendedColorType::Rgba16).unwrap();
    let share = |value: u16| f32::from(value) / 65535.0;
    let texel = |field| texture(field, "a.png", &bytes, None).unwrap().texel(&Mapping::default(), Vec2::ZERO, 0.0);
    let [r, g, b, alpha] = pixel.map(share);
    assert_eq!(texel("specularRoughnessTexture"), [r, g, b, alpha]);
    let [r, g, b] = [r, g, b].map(linear_from_srgb);
    assert_eq!(texel("baseColorTexture"), [r, g, b, alpha]);
}

#[test]
fn memory_is_checked_before_allocation() {
    let large = [b"PF\n400 400\n-1.0\n".to_vec(), vec![0; 400 * 400 * 12]].concat();
    let read = |memory| texture("emissionTexture", "a.pfm", &large, Some(memory)).map(|texture| texture.bytes());
    // The memory limit includes both the picture and the texture that is made from it.
    assert_eq!(read(6_000_000), Ok(400 * 400 * 12));
    let messages = read(3_000_000).unwrap_err();
    assert!(messages.contains("memory"), "{messages}");
}

/// Returns the mean and variance of the pixels of a distant wall with thin emissive stripes. The
/// wall is seen directly or in a mirror, with 16 samples per pixel.
fn stripes(minified: &str, mirrored: bool) -> (f64, f64) {
    let picture =
        [b"P6 64 64 255\n".to_vec(), (0..64 * 64).flat_map(|i| [255 * (i / 4 % 2) as u8; 3]).collect()].concat();
    // The mirror shows the left side of the wall in front of the camera.
    let (wall, mirror) = match mirrored {
        false => ("corner -20 -20 -90 edge0 40 0 0 edge1 0 40 0", ""),
        true => (
            "corner -80 -20 10 edge0 0 0 -40 edge1 0 40 0",
            "MaterialIndex 1 Rectangle { corner -14 -20 -24 edge0 28 0 28 edge1 0 40 0 }",
        ),
    };
    let text = format!(
        "PerspectiveCamera {{ center 0 0 0 direction 0 0 -1 up 0 1 0 angle 12 }}
         Textures {{ Texture {{ name s picture s.ppm minified {minified} uvTransform {{ 240 0 0  0 240 0 }} }} }}
         Materials {{
           PrincipledMaterial {{ baseColor 0 0 0 specularWeight 0 emissionLuminance 1 emissionColor 1 1 1 emissionTexture s }}
           PrincipledMaterial {{ baseColor 1 1 1 baseMetalness 1 specularRoughness 0 }}
         }}
         Group {{ MaterialIndex 0 Rectangle {{ {wall} }} {mirror} }}"
    );
    let options = LoadOptions {
        in_memory: vec![("s.ppm".to_string(), picture.into())],
        dialect: Some(Dialect::Durer),
        ..LoadOptions::default()
    };
    let (mut files, mut found) = (Files::default(), Diagnostics::default());
    let loaded = load_text(Path::new("scene.txt"), text.as_bytes().into(), &options, &mut files, &mut found);
    let world = loaded.and_then(|loaded| loaded.compile(&options, &mut files, &mut found));
    let world = world.unwrap_or_else(|| panic!("{found:?}"));
    let sampling = Sampling::Filtered { samples: 16, filter: durer_render::film::Filter::Box { radius: 0.5 } };
    let job = Job { method: IntegratorKind::PATH, width: 48, height: 48, sampling, ..Job::default() };
    let rendered = render(&world, &job, &Control::default()).unwrap();
    let pixels: Vec<f64> = rendered.layers[0].image.pixels.iter().map(|pixel| f64::from(pixel.x)).collect();
    let mean = pixels.iter().sum::<f64>() / pixels.len() as f64;
    (mean, pixels.iter().map(|x| (x - mean) * (x - mean)).sum::<f64>() / pixels.len() as f64)
}

#[test]
fn mipmaps_reduce_noise_and_keep_the_mean_also_in_mirrors() {
    for mirrored in [false, true] {
        let [(plain, noise), (mean, less)] = ["texels", "mipmaps"].map(|minified| stripes(minified, mirrored));
        // Half of the wall emits light.
        let error = (noise / f64::from(48 * 48)).sqrt();
        assert!((plain - 0.5).abs() < 4.0 * error + 0.005, "{mirrored}: {plain} +- {error}");
        assert!((mean - 0.5).abs() < 0.005, "{mirrored}: {mean}");
        assert!(less < 0.2 * noise, "{mirrored}: {less} and {noise}");
    }
}
