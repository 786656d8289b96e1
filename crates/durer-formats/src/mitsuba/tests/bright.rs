//! Compares brightness with Mitsuba 3.9.1 for projected pictures, daylight, materials in uniform
//! light, and smoke.

use super::{clean, clean_in, folder, material, picture, read, read_in};
use crate::asset_export::export_assets;
use crate::folder::FolderSource;
use durer::load::{LoadOptions, load_text};
use durer_diag::Diagnostics;
use durer_render::integrator::{Integrate, Path, PathOptions, RenderSettings};
use durer_scene::light::Light;
use durer_scene::math::{Vec3, fp};
use durer_scene::sampler::SampleId;
use durer_scene::scene::{Material, PictureBytes, Scene};

#[test]
fn projectors_and_spots_project_pictures() {
    // A projector shows red on the left side, towards Mitsuba's +x. A spotlight shows red on the
    // opposite side.
    let files: &[(&str, &[u8])] = &[("a.pfm", &picture([[1.0, 0.0, 0.0], [0.0, 1.0, 0.0]]))];
    let texture =
        |name: &str| format!("<texture type='bitmap' name='{name}'><string name='filename' value='a.pfm'/></texture>");
    for (text, at_front, expected) in [
        (
            format!("<emitter type='projector'><float name='fov' value='60'/>{}</emitter>", texture("irradiance")),
            0,
            true,
        ),
        (
            format!("<emitter type='spot'><float name='cutoff_angle' value='40'/>{}</emitter>", texture("texture")),
            0,
            false,
        ),
    ] {
        let scene = clean_in(files, &format!("{text}<shape type='sphere'/>"));
        let lights = scene.lights.as_ref().unwrap();
        let red = lights.iter().find_map(|light| match &light.value {
            Light::Photometric(emitter) if emitter.color.x > 0.0 => Some(emitter),
            _ => None,
        });
        let emitter = red.unwrap();
        let profile = &scene.assets.profiles[&emitter.file.path];
        let rows = profile.vertical.len();
        // Centre of one of the projector's pixels, at a horizontal angle of 0 and of half a turn.
        let vertical = profile.vertical.iter().position(|angle| *angle >= 16.102).unwrap();
        let at = |horizontal: usize| profile.candela[horizontal * rows + vertical];
        let half = profile.horizontal.len() / 2;
        assert_eq!((at(at_front) > 0.5, at(half) > 0.5), (expected, !expected), "{text}");
        if text.contains("projector") {
            // The expected value is pi times the value of the picture, divided by the cube of the
            // cosine.
            let cosine = fp::sin_cos_degrees(16.102).1 as f32;
            let found = at(0) * emitter.color.x / std::f32::consts::PI * cosine * cosine * cosine;
            assert!((found - 1.0).abs() < 0.01, "{found}");
        }
    }
}

/// Irradiance of surfaces under the open sky: the sum over the environment map and the sun.
fn irradiance(scene: &Scene, normals: [Vec3; 4]) -> [Vec3; 4] {
    let Light::Directional(sun) = &scene.lights.as_ref().unwrap()[0].value else { panic!() };
    let name = &scene.background.environment.as_ref().unwrap().path;
    let PictureBytes::Memory(_, bytes) = &scene.assets.pictures[name].bytes else { panic!() };
    let texels = &bytes[bytes.len() - 1024 * 512 * 12..];
    let step = std::f64::consts::PI / 512.0;
    let mut sums = normals.map(|normal| std::f32::consts::PI * sun.color * normal.dot(-sun.direction).max(0.0));
    for (i, texel) in texels.chunks_exact(12).enumerate() {
        // The rows of a PFM file are stored from bottom to top, and the centre is at -z.
        let (sin, cos) = fp::sin_cos_degrees(180.0 * ((511 - i / 1024) as f64 + 0.5) / 512.0);
        let (sin_turn, cos_turn) = fp::sin_cos_degrees(360.0 * (((i % 1024) as f64 + 0.5) / 1024.0 - 0.5));
        let dir = glam::DVec3::new(sin * sin_turn, cos, -sin * cos_turn).as_vec3();
        let number = |at: usize| f32::from_le_bytes([texel[at], texel[at + 1], texel[at + 2], texel[at + 3]]);
        let light = Vec3::new(number(0), number(4), number(8)) * (sin * step * step) as f32;
        normals.iter().zip(&mut sums).for_each(|(normal, sum)| *sum += light * normal.dot(dir).max(0.0));
    }
    sums
}

#[test]
fn sunsky_irradiance_agrees_with_mitsuba() {
    // Turbidity, albedo, elevation of the sun, and the irradiance of level ground and of walls that
    // face the sun, face right and face away. Measured with Mitsuba 3.9.1 (`scalar_rgb`), at 14,400
    // directions of the sky.
    type Row = (f32, [f32; 3], f64, [[f32; 3]; 4]);
    #[rustfmt::skip]
    let measured: [Row; 6] = [
        (1.5, [0.0, 0.0, 0.0], 2.0, [[0.065402, 0.062323, 0.054785], [0.49483, 0.178627, 0.031982],
            [0.044261, 0.043468, 0.032217], [0.048023, 0.045003, 0.03198]]),
        (5.0, [0.3, 0.3, 0.3], 10.0, [[0.268982, 0.238803, 0.204917], [1.048584, 0.692641, 0.326054],
            [0.103949, 0.112031, 0.107373], [0.071746, 0.092802, 0.103152]]),
        (2.0, [0.1, 0.4, 0.8], 20.0, [[0.552091, 0.513145, 0.496619], [1.394398, 1.124093, 0.782123],
            [0.079099, 0.136452, 0.207494], [0.078021, 0.138788, 0.211202]]),
        (8.0, [1.0, 1.0, 1.0], 30.0, [[0.937777, 0.855134, 0.778641], [1.548493, 1.299622, 0.99844],
            [0.249595, 0.266932, 0.288883], [0.158053, 0.188175, 0.232384]]),
        (3.0, [0.3, 0.3, 0.3], 60.0, [[1.469069, 1.356697, 1.30274], [0.901034, 0.84865, 0.818425],
            [0.11151, 0.175387, 0.284591], [0.097542, 0.159512, 0.266061]]),
        (4.0, [0.3, 0.3, 0.3], 88.0, [[1.732742, 1.591812, 1.498675], [0.189895, 0.240985, 0.325837],
            [0.135544, 0.193714, 0.287233], [0.133211, 0.190459, 0.283552]]),
    ];
    for (turbidity, [r, g, b], elevation, expected) in measured {
        let (sin, cos) = fp::sin_cos_degrees(elevation);
        // Rotate the sky so that y is up. `sun_direction` is in world space.
        let scene = clean(&format!(
            "<emitter type='sunsky'><float name='turbidity' value='{turbidity}'/><rgb name='albedo' value='{r},{g},{b}'/>\
             <vector name='sun_direction' value='{cos},{sin},0'/>\
             <transform name='to_world'><rotate x='1' angle='-90'/></transform></emitter><shape type='sphere'/>"
        ));
        let found = irradiance(&scene, [Vec3::Y, Vec3::X, Vec3::Z, Vec3::NEG_X]);
        for (side, (found, expected)) in found.into_iter().zip(expected).enumerate() {
            let difference = (found / Vec3::from(expected) - 1.0).abs();
            // At an elevation of 2 degrees, the blue of Mitsuba's sun is negative, which Dürer
            // replaces by 0.
            let sunset = elevation < 5.0 && side < 2;
            let largest = if sunset { difference.truncate().max_element() } else { difference.max_element() };
            assert!(largest < 0.01, "{turbidity} {elevation} {side}: {found}, not {expected:?}");
        }
    }
}

#[test]
fn sunsky_reads_its_parameters() {
    let emitter = |kind: &str, inside: &str| {
        let scene = "<scene version='3.0.0'><shape type='sphere'/>";
        read(&format!(
            "{scene}<emitter type='{kind}'><vector name='sun_direction' value='1,0,1'/>{inside}</emitter></scene>"
        ))
    };
    let sun = |inside: &str| {
        let (scene, messages) = emitter("sunsky", inside);
        let Light::Directional(sun) = scene.unwrap().lights.unwrap()[0].value.clone() else { panic!() };
        (sun, messages)
    };
    let (plain, messages) = sun("");
    assert!(messages.is_empty() && (plain.spread.unwrap() - 0.2679).abs() < 1e-6, "{messages:?}");
    // The irradiance does not depend on the aperture. A sun with a dark limb becomes uniform.
    let (wide, messages) = sun("<float name='sun_aperture' value='5'/><float name='sun_scale' value='2'/>");
    assert!(messages.is_empty() && wide.spread == Some(2.5) && wide.color == 2.0 * plain.color);
    let (complex, messages) = sun("<boolean name='complex_sun' value='true'/>");
    assert!(complex == plain && messages[0].contains("`complex_sun`"), "{messages:?}");
    for (inside, wanted) in [
        ("<float name='turbidity' value='0.5'/>", "`turbidity` must be from 1 to 10"),
        ("<float name='turbidity' value='11'/>", "`turbidity` must be from 1 to 10"),
        ("<float name='albedo' value='1.5'/>", "`albedo` must be from 0 to 1"),
        ("<rgb name='albedo' value='0,-.1,0'/>", "`albedo` must be from 0 to 1"),
        ("<float name='sun_aperture' value='0'/>", "`sun_aperture` must be more than 0"),
        ("<float name='sun_aperture' value='180'/>", "less than 180 degrees"),
    ] {
        let (_, messages) = emitter("sunsky", inside);
        assert!(messages.iter().any(|message| message.contains(wanted)), "{inside}: {messages:?}");
    }
    let night = "<scene version='3.0.0'><shape type='sphere'/><emitter type='sunsky'>\
                 <vector name='sun_direction' value='1,0,-1'/></emitter></scene>";
    assert!(read(night).1.iter().any(|message| message.contains("below the horizon")));
}

#[test]
fn sun_position_by_time_agrees_with_mitsuba() {
    // Direction of a sun that is set by time, compared with Mitsuba, where x is south, y is west
    // and z is up.
    let text = "<emitter type='sun'><float name='latitude' value='48.8'/><float name='longitude' value='2.3'/>\
                <float name='timezone' value='2'/><integer name='year' value='2024'/><integer name='month' value='6'/>\
                <integer name='day' value='21'/><float name='hour' value='15'/><float name='minute' value='30'/></emitter>\
                <shape type='sphere'/>";
    let (scene, _) = read(&format!("<scene version='3.0.0'>{text}</scene>"));
    let lights = scene.unwrap().lights.unwrap();
    let Light::Directional(sun) = &lights[0].value else { panic!() };
    assert!((sun.direction + Vec3::new(0.367_118, 0.377_866, 0.849_966)).length() < 5e-3, "{}", sun.direction);
}

/// Returns the mean radiance of a ball that has the given material and is lit by uniform light.
fn ball(bsdf: &str) -> Vec3 {
    let text = format!(
        "<scene version='3.0.0'><sensor type='perspective'/><emitter type='constant'/><shape type='sphere'>{bsdf}</shape></scene>"
    );
    let (mut files, mut found, options) = (Default::default(), Diagnostics::default(), LoadOptions::default());
    let loaded = load_text(std::path::Path::new("a.xml"), text.as_bytes().into(), &options, &mut files, &mut found);
    let world = loaded.and_then(|loaded| loaded.compile(&options, &mut files, &mut found)).unwrap();
    let settings = RenderSettings { bounces: 8, ..durer_render::render::Job::default().settings };
    let path = Path::new(&world, settings, PathOptions::default());
    let n = 1 << 14;
    let one = |i: u32| {
        let id = SampleId::new(1, (0, 0), i);
        let place = durer_scene::bsdf::warp::disc(id.pair(40));
        let ray = durer_scene::math::Ray::new(Vec3::new(place.x, place.y, 5.0), Vec3::NEG_Z);
        path.radiance(&ray, id, &mut ())
    };
    (0..n).map(one).sum::<Vec3>() / n as f32
}

#[test]
fn ball_albedo_matches_mitsuba() {
    // Mean values that Mitsuba 3.9.1 computed over 200,000 cosine-weighted pairs of directions.
    for (bsdf, expected) in [
        ("<float name='specular' value='0'/><float name='roughness' value='1'/>", [0.7456, 0.4260, 0.2130]),
        ("<float name='specular' value='.5'/><float name='roughness' value='.5'/>", [0.7638, 0.4614, 0.2597]),
        ("<float name='specular' value='1'/><float name='roughness' value='.3'/>", [0.8092, 0.5134, 0.3162]),
    ] {
        let color = "<rgb name='base_color' value='.7,.4,.2'/>";
        let shown = ball(&format!("<bsdf type='principled'>{color}{bsdf}</bsdf>"));
        assert!((shown / Vec3::from(expected) - 1.0).abs().max_element() < 0.01, "{bsdf}: {shown}");
    }
    for (alpha, expected) in [(0.1, 0.4910), (0.3, 0.3660)] {
        let shown = ball(&format!(
            "<bsdf type='roughplastic'><string name='distribution' value='ggx'/><float name='alpha' value='{alpha}'/></bsdf>"
        ));
        assert!((shown / expected - 1.0).abs().max_element() < 0.01, "{alpha}: {shown}");
    }
}

#[test]
fn volumes_become_density_grids_with_their_transform() {
    // Volume of two cells along x with densities 0.5 and 4, in a box from 0 to (2, 1, 1).
    let mut volume = b"VOL\x03".to_vec();
    [1_i32, 2, 1, 1, 1].iter().for_each(|n| volume.extend(n.to_le_bytes()));
    [0.0_f32, 0.0, 0.0, 2.0, 1.0, 1.0, 0.5, 4.0].iter().for_each(|x| volume.extend(x.to_le_bytes()));
    let medium = |more: &str, albedo: &str| {
        format!(
            "<shape type='cube'><bsdf type='null'/><medium type='heterogeneous' name='interior'>\
             <volume name='sigma_t' type='gridvolume'><string name='filename' value='smoke.vol'/>{more}\
             <transform name='to_world'><scale value='2'/><translate x='5'/></transform></volume>{albedo}\
             <float name='scale' value='3'/></medium></shape>"
        )
    };
    let even = "<volume name='albedo' type='constvolume'><rgb name='value' value='.9,.6,.3'/></volume>";
    let files: &[(&str, &[u8])] = &[("smoke.vol", &volume)];
    for (more, edge) in [("", [2.0, 0.0, 0.0]), ("<boolean name='use_grid_bbox' value='true'/>", [4.0, 0.0, 0.0])] {
        let scene = clean_in(files, &medium(more, even));
        let Material::Principled(m) = material(&scene) else { panic!() };
        assert_eq!(m.transmission_density.as_ref().unwrap().path, "smoke.vol");
        assert_eq!(m.transmission_density_box, [[5.0, 0.0, 0.0], edge, [0.0, 2.0, 0.0], [0.0, 0.0, 2.0]]);
        let scattered = m.transmission_scatter / m.transmission_depth;
        assert!((scattered - Vec3::new(2.7, 1.8, 0.9)).abs().max_element() < 1e-5, "{scattered}");
        // Exporting the scene does not change the file.
        let (made, beside) = export_assets(&scene, "kept", &FolderSource::new(&std::env::temp_dir()));
        let Material::Principled(m) = material(&made) else { panic!() };
        assert_eq!(m.transmission_density.as_ref().unwrap().path, "kept/smoke.vol");
        assert!(beside.contains(&("kept/smoke.vol".to_string(), volume.clone())));
    }
    // If an albedo is given by a volume, the mean of the volume is used. An invalid volume is an
    // error.
    let reported = |files: &[(&str, &[u8])], albedo: &str| {
        let folder = folder(files);
        read_in(folder.path(), "scene.xml", &format!("<scene version='3.0.0'>{}</scene>", medium("", albedo)))
    };
    let by_volume = "<volume name='albedo' type='gridvolume'><string name='filename' value='albedo.vol'/></volume>";
    let mut albedo = volume.clone();
    albedo[52..56].copy_from_slice(&0.25_f32.to_le_bytes());
    let (scene, messages) = reported(&[files[0], ("albedo.vol", &albedo)], by_volume);
    let Material::Principled(m) = material(scene.as_ref().unwrap()).clone() else { panic!() };
    assert!((m.transmission_scatter / m.transmission_depth - Vec3::splat(3.0 * 0.375)).abs().max_element() < 1e-5);
    assert!(messages.iter().all(|message| message.contains("its mean is used")), "{messages:?}");
    let (_, messages) = reported(&[("smoke.vol", &volume[..55])], even);
    assert!(messages.iter().any(|message| message.contains("the file ends after 1 of 2 densities")), "{messages:?}");
    let (_, messages) = reported(&[], even);
    assert!(messages.iter().any(|message| message.contains("smoke.vol")), "{messages:?}");
}
