//! Pictures of materials keep what their files hold: sixteen bits, floating point, opacity.

use super::*;
use crate::image::linear_from_srgb;
use crate::math::{Color, Vec2};
use crate::texture::{Mapping, Texture};
use ::image::{ExtendedColorType, ImageEncoder, codecs::png::PngEncoder};

/// The texture that a scene makes of a picture named by a field, or what is said.
fn texture(field: &str, name: &str, bytes: &[u8], memory: Option<u64>) -> Result<Texture, String> {
    let text = format!(
        "PerspectiveCamera {{ center 0 0 5 direction 0 0 -1 up 0 1 0 angle 40 }} Materials {{ PrincipledMaterial {{ {field} {name} }} }}
         Group {{ MaterialIndex 0 Sphere {{ center 0 0 0 radius 1 }} }}"
    );
    let given = vec![(name.to_string(), bytes.into())];
    let options = LoadOptions { given, memory, dialect: Some(Dialect::Durer), ..LoadOptions::default() };
    let (mut files, mut found) = (Files::default(), Diagnostics::default());
    let loaded = load_text(Path::new("scene.txt"), text.as_bytes().into(), &options, &mut files, &mut found);
    let world = loaded.and_then(|loaded| loaded.compile(&options, &mut files, &mut found));
    let said = || found.iter().map(|finding| finding.message.clone()).collect();
    world.map(|world| world.textures()[0].clone()).ok_or_else(said)
}

/// One pixel of floating point.
fn pfm(pixel: [f32; 3]) -> Vec<u8> {
    [b"PF\n1 1\n-1.0\n".to_vec(), pixel.iter().flat_map(|x| x.to_le_bytes()).collect()].concat()
}

#[test]
fn light_beyond_white_stays() {
    let texture = |field, pixel| texture(field, "a.pfm", &pfm(pixel), None);
    for field in ["emissionTexture", "baseColorTexture", "specularRoughnessTexture"] {
        assert_eq!(texture(field, [3.0, 0.5, 0.25]).unwrap().at(Vec2::ZERO), Color::new(3.0, 0.5, 0.25), "{field}");
    }
    let said = texture("emissionTexture", [f32::NAN, 0.0, 0.0]).unwrap_err();
    assert!(said.contains("no numbers"), "{said}");
}

#[test]
fn sixteen_bits_stay_with_their_opacity() {
    let pixel = [30000u16, 301, 65535, 40001];
    let mut bytes = Vec::new();
    let values: Vec<u8> = pixel.iter().flat_map(|value| value.to_ne_bytes()).collect();
    PngEncoder::new(&mut bytes).write_image(&values, 1, 1, ExtendedColorType::Rgba16).unwrap();
    let share = |value: u16| f32::from(value) / 65535.0;
    let texel = |field| texture(field, "a.png", &bytes, None).unwrap().texel(&Mapping::default(), Vec2::ZERO);
    let [r, g, b, alpha] = pixel.map(share);
    assert_eq!(texel("specularRoughnessTexture"), [r, g, b, alpha]);
    let [r, g, b] = [r, g, b].map(linear_from_srgb);
    assert_eq!(texel("baseColorTexture"), [r, g, b, alpha]);
}

#[test]
fn memory_is_counted_before_it_is_taken() {
    let large = [b"PF\n400 400\n-1.0\n".to_vec(), vec![0; 400 * 400 * 12]].concat();
    let read = |memory| texture("emissionTexture", "a.pfm", &large, Some(memory)).map(|texture| texture.bytes());
    // The picture, and the texture that is made of it with it.
    assert_eq!(read(6_000_000), Ok(400 * 400 * 12));
    let said = read(3_000_000).unwrap_err();
    assert!(said.contains("memory"), "{said}");
}
