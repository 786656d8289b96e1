//! Tests of materials, of their textures and of media, compared with Mitsuba 3.9.1 and with
//! analytic results.

use super::shapes::assert_faces_inwards;
use super::{clean, clean_in, layers, material, objects, picture, read};
use durer_scene::describe::FileName;
use durer_scene::material::PrincipledMaterial;
use durer_scene::material::principled::{
    Backs, BumpGradient, Facets, NormalBending, NormalGreen, Surroundings, Switch, Walls,
};
use durer_scene::math::{Vec3, fp};
use durer_scene::scene::{Material, PictureBytes};

#[test]
fn materials_have_their_indices_and_alphas() {
    let glass = layers("<bsdf type='dielectric'><string name='int_ior' value='water'/></bsdf>");
    assert!((glass.specular_ior - 1.333 / 1.000277).abs() < 1e-6 && glass.transmission_weight == 1.0);
    let rough = layers(
        "<bsdf type='roughconductor'><float name='alpha' value='.25'/><string name='distribution' value='ggx'/></bsdf>",
    );
    assert_eq!((rough.specular_roughness, rough.base_metalness, rough.base_color), (0.5, 1.0, Vec3::ONE));
    let gold = layers("<bsdf type='conductor'><string name='material' value='Au'/></bsdf>");
    // Fresnel reflectance at normal incidence for red light.
    let (n, k) = (0.143f32, 3.983f32);
    let expected = ((n - 1.0) * (n - 1.0) + k * k) / ((n + 1.0) * (n + 1.0) + k * k);
    assert!((gold.base_color.x - expected).abs() < 1e-5);
    let masked = layers("<bsdf type='mask'><float name='opacity' value='.25'/><bsdf type='diffuse'/></bsdf>");
    assert_eq!((masked.opacity, masked.base_color), (0.25, Vec3::splat(0.5)));
    let disney = layers(
        "<bsdf type='principled'><float name='specular' value='.5'/><float name='roughness' value='.3'/></bsdf>",
    );
    // The reflectance at normal incidence is 0.04.
    let root = (disney.specular_ior - 1.0) / (disney.specular_ior + 1.0);
    assert!((root * root - 0.04).abs() < 1e-6 && (disney.specular_roughness - 0.3).abs() < 1e-6);
    let scene = clean(
        "<shape type='sphere'><bsdf type='blendbsdf'><float name='weight' value='.25'/><bsdf type='diffuse'/>\
        <bsdf type='conductor'/></bsdf></shape>",
    );
    assert!(format!("{:?}", material(&scene)).contains("share: 0.75"));
}

#[test]
fn textures_of_numbers_become_linear_pictures() {
    let fields = |name: &str, one: f32, other: f32| {
        format!(
            "<texture name='{name}' type='checkerboard'><rgb name='color0' value='{one}'/>\
             <rgb name='color1' value='{other}'/></texture>"
        )
    };
    // Expected values, which are linear, of the picture that a material uses. Mitsuba swaps the
    // colours of a checkerboard when it is used as a number.
    let check = |bsdf: &str, get: &dyn Fn(&PrincipledMaterial) -> Option<&FileName>, [other, one]: [f32; 2]| {
        let wanted = [one, other];
        let scene = clean(&format!("<shape type='sphere'>{bsdf}</shape>"));
        let Material::Principled(layers) = material(&scene) else { panic!("{bsdf}") };
        let name = get(layers).unwrap_or_else(|| panic!("{bsdf} has a picture"));
        let PictureBytes::Memory(path, bytes) = &scene.assets.pictures[&name.path].bytes else { panic!() };
        let image = durer_image::read(bytes, path).unwrap();
        for (pixel, wanted) in image.pixels.iter().zip(wanted) {
            // The colours have 8 bits, both before and after the change.
            assert!((pixel.x - wanted).abs() < 1.5 / 255.0, "{bsdf}: {} and not {wanted}", pixel.x);
        }
        (**layers).clone()
    };
    // Dürer's roughness is the square root of alpha.
    let (ggx, alpha) = ("<string name='distribution' value='ggx'/>", fields("alpha", 0.04, 0.25));
    let metal = format!("<bsdf type='roughconductor'>{ggx}{alpha}</bsdf>");
    let metal = check(&metal, &|m| m.specular_roughness_texture.as_ref(), [0.2, 0.5]);
    assert_eq!(metal.specular_roughness, 1.0);
    let inner = "<bsdf type='diffuse'/>";
    let mask = format!("<bsdf type='mask'>{}{inner}</bsdf>", fields("opacity", 0.0, 1.0));
    check(&mask, &|m| m.opacity_texture.as_ref(), [0.0, 1.0]);
    // `weight` is the share of the second material.
    let weight = fields("weight", 0.2, 0.7);
    let blend = format!("<bsdf type='blendbsdf'>{weight}{inner}<bsdf type='conductor'/></bsdf>");
    let scene = clean(&format!("<shape type='sphere'>{blend}</shape>"));
    let Material::Solid(durer_scene::material::PatternMaterial::Mix(mix), _) = material(&scene) else { panic!() };
    let PictureBytes::Memory(path, bytes) = &scene.assets.pictures[&mix.share_texture.as_ref().unwrap().path].bytes
    else {
        panic!()
    };
    let image = durer_image::Encoded::open(bytes, path).unwrap();
    let image = image.read(1 << 20, durer_image::decode_linear).unwrap();
    let first: Vec<f32> = image.pixels.iter().map(|pixel| pixel.x).collect();
    assert!(mix.share == 1.0 && first.iter().any(|x| (x - 0.8).abs() < 3e-3), "{first:?}");
    assert!(first.iter().any(|x| (x - 0.3).abs() < 3e-3), "{first:?}");
    let bump =
        format!("<bsdf type='bumpmap'>{}<float name='scale' value='.3'/>{inner}</bsdf>", fields("arbitrary", 0.5, 0.9));
    let bump = check(&bump, &|m| m.bump_texture.as_ref(), [0.5, 0.9]);
    assert_eq!((bump.bump_height, bump.bump_gradient), (0.3, BumpGradient::Exact));
    // Mitsuba's shadow rays start on the triangles of smooth meshes.
    assert_eq!(bump.smooth_shadows, Switch::Off);
    // The luminance of a colour is used where a number is expected.
    let colors = "<texture name='opacity' type='checkerboard'><rgb name='color0' value='0,1,0'/>\
        <rgb name='color1' value='1,0,0'/></texture>";
    check(&format!("<bsdf type='mask'>{colors}{inner}</bsdf>"), &|m| m.opacity_texture.as_ref(), [0.7152, 0.2126]);
    let parts = fields("roughness", 0.3, 0.6) + &fields("metallic", 0.0, 0.7);
    let disney = format!("<bsdf type='principled'>{parts}</bsdf>");
    check(&disney, &|m| m.base_metalness_texture.as_ref(), [0.0, 0.7]);
    let disney = check(&disney, &|m| m.specular_roughness_texture.as_ref(), [0.3, 0.6]);
    assert!((disney.specular_roughness - 1.0).abs() < 1e-6 && disney.base_metalness == 1.0);
}

#[test]
fn interior_scattering_is_extinction_times_albedo() {
    let scene = clean(
        "<medium type='homogeneous' id='m'><float name='sigma_t' value='2'/><float name='albedo' value='.25'/></medium>\
         <shape type='sphere'><bsdf type='null'/><ref id='m' name='interior'/></shape>",
    );
    let Material::Principled(m) = material(&scene) else { panic!() };
    assert_eq!((m.specular_ior, m.transmission_depth, m.transmission_scatter), (1.0, 0.5, Vec3::splat(0.25)));
    assert!((m.transmission_color.x - fp::exp(-1.0)).abs() < 1e-6);
    assert_eq!(objects(&scene).len(), 1);
    // A `null` surface without a medium is not rendered.
    let (scene, messages) = read("<scene><shape type='sphere'><bsdf type='null'/></shape></scene>");
    assert!(scene.is_some_and(|scene| objects(&scene).is_empty()), "{messages:?}");
}

#[test]
fn emitters_without_material_do_not_scatter() {
    let light = "<emitter type='area'><rgb name='radiance' value='2'/></emitter>";
    let alone = layers(light);
    assert_eq!((alone.base_color, alone.emission_luminance), (Vec3::ZERO, 2.0));
    assert_eq!(layers(&format!("{light}<bsdf type='diffuse'/>")).base_color, Vec3::splat(0.5)); // prose: keep
    assert_eq!(layers("").base_color, Vec3::splat(0.5));
    // An inverted sphere is a dome that emits light into its interior, on that side only.
    let dome = format!("<boolean name='flip_normals' value='true'/>{light}"); // prose: keep
    let scene = clean(&format!("<shape type='sphere'>{dome}</shape>"));
    let Material::Principled(dome) = material(&scene) else { panic!() };
    assert_eq!((dome.emission_luminance, dome.walls), (2.0, Walls::Solid));
    assert_faces_inwards(&scene);
}

#[test]
fn facets_are_those_of_the_distribution() {
    let of = |more: &str| layers(&format!("<bsdf type='roughconductor'>{more}</bsdf>")).specular_facets;
    assert_eq!(of(""), Facets::Beckmann);
    assert_eq!(of("<string name='distribution' value='beckmann'/>"), Facets::Beckmann);
    assert_eq!(of("<string name='distribution' value='ggx'/>"), Facets::GgxSeparable);
    assert_eq!(layers("<bsdf type='principled'/>").specular_facets, Facets::GgxSeparable);
}

#[test]
fn blend_with_nothing_is_an_opacity() {
    let of = |parts: &str| layers(&format!("<bsdf type='blendbsdf'><float name='weight' value='.3'/>{parts}</bsdf>"));
    let (matte, none) = ("<bsdf type='diffuse'/>", "<bsdf type='null'/>");
    // `weight` is the share of the second material.
    assert!((of(&format!("{matte}{none}")).opacity - 0.7).abs() < 1e-6);
    assert!((of(&format!("{none}{matte}")).opacity - 0.3).abs() < 1e-6);
}

#[test]
fn normal_maps_are_linear_in_every_encoding() {
    // The byte 128 is 0.2158 in sRGB, and a PFM picture is always linear.
    let pfm = [b"PF\n1 1\n-1.0\n".as_slice(), &[0.5f32, 0.25, 1.0].map(f32::to_le_bytes).concat()].concat();
    let ppm = b"P6\n1 1\n255\n\x80\x40\xff";
    for (name, bytes, raw, wanted) in [
        ("n.pfm", pfm.as_slice(), "true", [0.5, 0.25, 1.0]),
        ("n.pfm", &pfm, "false", [0.5, 0.25, 1.0]),
        ("n.ppm", ppm, "false", [0.2158, 0.0513, 1.0]),
    ] {
        let map = format!(
            "<bsdf type='normalmap'><texture name='normalmap' type='bitmap'><boolean name='raw' value='{raw}'/>\
             <string name='filename' value='{name}'/></texture><bsdf type='diffuse'/></bsdf>"
        );
        let scene = clean_in(&[(name, bytes)], &format!("<shape type='rectangle'>{map}</shape>"));
        let Material::Principled(layers) = material(&scene) else { panic!() };
        let picture = &scene.assets.pictures[&layers.normal_texture.as_ref().unwrap().path];
        let PictureBytes::Memory(path, bytes) = &picture.bytes else { panic!("{name}") };
        let image = durer_image::Encoded::open(bytes, path).unwrap();
        let pixel = image.read(1 << 20, durer_image::decode_linear).unwrap().pixels[0].to_array();
        assert!((0..3).all(|k| (pixel[k] - wanted[k]).abs() < 4e-3), "{name} {raw}: {pixel:?}");
    }
}

#[test]
fn mapped_normals_turn_and_hide_light_unless_told_otherwise() {
    let picture = "<texture name='normalmap' type='bitmap'><string name='filename' value='n.ppm'/></texture>";
    let of = |kind: &str, more: &str| {
        let map = format!("<bsdf type='{kind}'>{picture}{more}<bsdf type='diffuse'/></bsdf>");
        let files: &[(&str, &[u8])] = &[("n.ppm", b"P6\n1 1\n255\n\x80\x80\xff")];
        let scene = clean_in(files, &format!("<shape type='rectangle'>{map}</shape>"));
        let Material::Principled(layers) = material(&scene) else { panic!() };
        (layers.normal_bending, layers.normal_shadowing, layers.normal_green)
    };
    let off = |name: &str| format!("<boolean name='{name}' value='false'/>");
    use NormalBending::{Off, Turned};
    assert_eq!(of("normalmap", ""), (Turned, Switch::On, NormalGreen::Cross));
    assert_eq!(of("normalmap", &off("flip_invalid_normals")), (Off, Switch::On, NormalGreen::Cross));
    assert_eq!(of("bumpmap", &off("use_shadowing_function")), (Turned, Switch::Off, NormalGreen::V));
}

#[test]
fn roots_of_pictures_are_those_of_interpolated_values() {
    // Alpha is 0.04 in one texel and 0.64 in the next, and 0.34 between them.
    let alpha = "<texture name='alpha' type='bitmap'><string name='filename' value='a.pfm'/></texture>";
    let metal = format!("<shape type='sphere'><bsdf type='roughconductor'>{alpha}</bsdf></shape>");
    let scene = clean_in(&[("a.pfm", &picture([[0.04; 3], [0.64; 3]]))], &metal);
    let Material::Principled(layers) = material(&scene) else { panic!() };
    let name = &layers.specular_roughness_texture.as_ref().unwrap().path;
    let PictureBytes::Memory(path, bytes) = &scene.assets.pictures[name].bytes else { panic!("{name}") };
    let image = durer_image::read(bytes, path).unwrap();
    assert_eq!((image.width, image.height), (16, 8));
    for (x, pixel) in image.pixels.iter().take(16).enumerate() {
        // The picture repeats, so the values form a triangle between the two texels.
        let place = (x as f32 + 0.5) / 8.0 - 0.5;
        let wanted = (0.04 + 0.6 * (1.0 - (place.abs() - 1.0).abs())).sqrt();
        assert!((pixel.x - wanted).abs() < 1e-5, "{x}: {} and not {wanted}", pixel.x);
    }
}

#[test]
fn pictures_of_emitters_may_exceed_1() {
    let emitter = "<shape type='rectangle'><emitter type='area'><texture name='radiance' type='bitmap'>\
        <string name='filename' value='lamp.pfm'/></texture></emitter></shape>";
    let scene = clean_in(&[("lamp.pfm", &picture([[8.0, 2.0, 0.0], [4.0, 4.0, 4.0]]))], emitter);
    let Material::Principled(emitter) = material(&scene) else { panic!() };
    assert_eq!((emitter.emission_luminance, emitter.emission_color), (8.0, Vec3::ONE));
    let name = &emitter.emission_texture.as_ref().unwrap().path;
    let PictureBytes::Memory(path, bytes) = &scene.assets.pictures[name].bytes else { panic!() };
    let image = durer_image::read(bytes, path).unwrap();
    let wanted = [Vec3::new(1.0, 0.25, 0.0), Vec3::splat(0.5)];
    for (pixel, wanted) in image.pixels.iter().zip(wanted) {
        assert!((*pixel - wanted).abs().max_element() < 1e-6, "{pixel} and not {wanted}");
    }
}

/// Decodes an 8-bit sRGB value.
fn srgb(number: f32) -> f32 {
    durer_image::decode_srgb((255.0 * number).round() as u8)
}

#[test]
fn picture_colours_are_srgb_unless_raw() {
    let grey = b"P6\n1 1\n255\n\x80\x80\x80";
    let of = |raw: bool| {
        let inner = format!(
            "<shape type='rectangle'><bsdf type='diffuse'><texture name='reflectance' type='bitmap'>\
             <string name='filename' value='grey.ppm'/><boolean name='raw' value='{raw}'/></texture></bsdf></shape>"
        );
        let scene = clean_in(&[("grey.ppm", grey)], &inner);
        let Material::Principled(layers) = material(&scene) else { panic!() };
        let picture = &scene.assets.pictures[&layers.base_color_texture.as_ref().unwrap().path];
        // The alpha channel of a picture does not make the surface transparent.
        assert_eq!(picture.mapping.cutoff, Some(0.0));
        match &picture.bytes {
            PictureBytes::File(_) => srgb(128.0 / 255.0),
            // Derived pictures are linear.
            PictureBytes::Memory(path, bytes) => durer_image::read(bytes, path).unwrap().pixels[0].x,
        }
    };
    assert!((of(false) - 0.2159).abs() < 1e-3 && (of(true) - 128.0 / 255.0).abs() < 4e-3);
}

#[test]
fn nested_glass_has_its_own_index() {
    // The given index is the ratio of the indices on the two sides of the surface, regardless of
    // the surrounding medium.
    let body = |radius: f32, inside: &str, outside: &str| {
        let index = |name: &str, value: &str| match value.parse::<f32>() {
            Ok(value) => format!("<float name='{name}' value='{value}'/>"),
            Err(_) => format!("<string name='{name}' value='{value}'/>"),
        };
        let (inside, outside) = (index("int_ior", inside), index("ext_ior", outside));
        format!(
            "<shape type='sphere'><float name='radius' value='{radius}'/><bsdf type='dielectric'>{inside}{outside}\
             </bsdf></shape>"
        )
    };
    let indices = |text: &str| -> Vec<f32> {
        let scene = clean(text);
        let index =
            |object: &&durer_scene::scene::Object| match &scene.materials[object.material.unwrap() as usize].value {
                Material::Principled(layers) if layers.surroundings == Surroundings::Ignored => layers.specular_ior,
                _ => panic!(),
            };
        objects(&scene).iter().map(index).collect()
    };
    let air = 1.000277;
    let near = |found: Vec<f32>, wanted: &[f32]| {
        assert!(found.iter().zip(wanted).all(|(a, b)| (a - b).abs() < 1e-5), "{found:?} and not {wanted:?}");
    };
    for (glass, name) in [("1.5046", "bk7"), ("1.5", "1.5")] {
        let glass: f32 = glass.parse().unwrap();
        let outer = body(1.0, name, "air");
        near(indices(&(outer.clone() + &body(0.5, "water", name))), &[glass / air, 1.333 / glass]);
        near(indices(&(body(0.5, "air", name) + &outer)), &[air / glass, glass / air]);
    }
    near(indices(&body(1.0, "water", "1.5")), &[1.333 / 1.5]);
}

#[test]
fn sides_and_facets_match_mitsuba() {
    let of = |kind: &str| layers(&format!("<bsdf type='{kind}'/>"));
    // Materials other than glass and thin sheets are black from behind unless they are `twosided`.
    for kind in ["diffuse", "conductor", "plastic", "principled"] {
        assert_eq!(of(kind).backs, Backs::Black, "{kind}");
        assert_eq!(layers(&format!("<bsdf type='twosided'><bsdf type='{kind}'/></bsdf>")).backs, Backs::Shown);
    }
    for kind in ["dielectric", "thindielectric", "principledthin"] {
        assert_eq!(of(kind).backs, Backs::Shown, "{kind}");
    }
    assert!(["conductor", "dielectric", "principled"].iter().all(|kind| of(kind).energy_compensation == Switch::Off));
    let color = |value: &str| format!("<bsdf type='diffuse'><rgb name='reflectance' value='{value}'/></bsdf>");
    let sides = format!("<bsdf type='twosided'>{}{}</bsdf>", color("1,0,0"), color("0,1,0"));
    let scene = clean(&format!("<shape type='rectangle'>{sides}</shape>"));
    let Material::Solid(durer_scene::material::PatternMaterial::TwoSided(two), _) = material(&scene) else { panic!() };
    let base = |number: u32| match &scene.materials[number as usize].value {
        Material::Principled(layers) => layers.base_color,
        _ => panic!(),
    };
    assert_eq!((base(two.material1), base(two.material2)), (Vec3::X, Vec3::Y));
}

#[test]
fn conductor_tint_applies_at_all_angles() {
    let metal =
        |more: &str| layers(&format!("<bsdf type='conductor'><string name='material' value='Au'/>{more}</bsdf>"));
    let (plain, tinted) = (metal(""), metal("<rgb name='specular_reflectance' value='.5,.25,.5'/>"));
    let tint = Vec3::new(0.5, 0.25, 0.5);
    assert!((tinted.base_color - tint * plain.base_color).abs().max_element() < 1e-6);
    assert_eq!((plain.specular_color, tinted.specular_color), (Vec3::ONE, tint));
    assert!(plain.metal_ior.is_some() && plain.metal_ior == tinted.metal_ior);
    // Without a material, all light is reflected: n = 0 and k = 1.
    let white = layers("<bsdf type='conductor'/>");
    assert_eq!((white.metal_ior, white.metal_extinction, white.base_color), (Some(Vec3::ZERO), Vec3::ONE, Vec3::ONE));
}

#[test]
fn colours_of_checkerboards_are_not_rounded() {
    let of = |value: f32| {
        format!(
            "<bsdf type='diffuse'><texture name='reflectance' type='checkerboard'>\
             <rgb name='color0' value='{value}'/><rgb name='color1' value='{value}'/></texture></bsdf>"
        )
    };
    for value in [0.5, 0.1234] {
        let scene = clean(&format!("<shape type='sphere'>{}</shape>", of(value)));
        let Material::Principled(layers) = material(&scene) else { panic!() };
        let name = layers.base_color_texture.as_ref().unwrap();
        let PictureBytes::Memory(path, bytes) = &scene.assets.pictures[&name.path].bytes else { panic!() };
        let image = durer_image::read(bytes, path).unwrap();
        assert!(image.pixels.iter().all(|p| *p == Vec3::splat(value)), "{value}: {:?}", image.pixels);
    }
}

/// The colours of a `nonlinear` plastic are converted after they are interpolated. With the share r
/// that the boundary reflects back, c becomes c (1 - r) / (1 - c r).
#[test]
fn nonlinear_plastics_convert_interpolated_colours() {
    let scene = clean_in(
        &[("two.pfm", &picture([[0.0; 3], [1.0; 3]]))],
        "<shape type='sphere'><bsdf type='plastic'><boolean name='nonlinear' value='true'/>\
         <texture name='diffuse_reflectance' type='bitmap'><string name='filename' value='two.pfm'/></texture>\
         </bsdf></shape>",
    );
    let Material::Principled(layers) = material(&scene) else { panic!() };
    let name = layers.base_color_texture.as_ref().unwrap();
    let PictureBytes::Memory(path, bytes) = &scene.assets.pictures[&name.path].bytes else { panic!() };
    let image = durer_image::read(bytes, path).unwrap();
    // The picture repeats, so that the interpolated values run from 0 to 1 and back.
    let side = image.width / 2;
    let plain = |x: u32| {
        let place = (f64::from(x) + 0.5) / f64::from(side) - 0.5;
        if place < 0.0 {
            -place
        } else if place > 1.0 {
            2.0 - place
        } else {
            place
        }
    };
    let of = |x: u32| f64::from(image.get(x, 0).unwrap().x);
    let middle = side - 1;
    let r = (plain(middle) - of(middle)) / (plain(middle) * (1.0 - of(middle)));
    assert!(side > 1 && (0.3..0.8).contains(&r), "{side} {r}");
    for x in 0..image.width {
        let expected = plain(x) * (1.0 - r) / (1.0 - plain(x) * r);
        assert!((of(x) - expected).abs() < 1e-5, "{x}: {} and not {expected}", of(x));
    }
}
