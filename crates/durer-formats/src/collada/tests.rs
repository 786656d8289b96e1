//! Tests of the COLLADA reader: geometry, transforms, materials, lights, cameras, skins and
//! malformed files.

use crate::testing::{folder, read_in, triangles};
use durer_scene::camera::Camera;
use durer_scene::light::{Illuminate as _, Light};
use durer_scene::material::PrincipledMaterial;
use durer_scene::math::Vec3;
use durer_scene::math::random::Random;
use durer_scene::scene::{Axis, Material, Scene};
use durer_scene::texture::{Channel, Wrap};
use glam::DVec3;
use std::path::Path;

/// Square from (0, 0, 0) to (1, 1, 0), with normals and two sets of texture coordinates.
const SQUARE: &str = r##"<library_geometries><geometry id="square"><mesh>
<source id="p"><float_array id="pa" count="12">0 0 0 1 0 0 1 1 0 0 1 0</float_array><technique_common>
<accessor source="#pa" count="4" stride="3"><param name="X" type="float"/></accessor></technique_common></source>
<source id="n"><float_array count="3">0 0 1</float_array><technique_common><accessor count="1" stride="3"/></technique_common></source>
<source id="t"><float_array count="8">0 0 1 0 1 1 0 1</float_array><technique_common><accessor count="4" stride="2"/></technique_common></source>
<source id="t2"><float_array count="2">0.25 0.75</float_array><technique_common><accessor count="1" stride="2"/></technique_common></source>
<vertices id="v"><input semantic="POSITION" source="#p"/></vertices>
<polylist material="skin" count="1"><input semantic="VERTEX" source="#v" offset="0"/><input semantic="NORMAL" source="#n" offset="1"/>
<input semantic="TEXCOORD" source="#t" offset="0" set="3"/><input semantic="TEXCOORD" source="#t2" offset="1" set="5"/>
<vcount>4</vcount><p>0 0 1 0 2 0 3 0</p></polylist></mesh></geometry></library_geometries>"##;

/// Returns a file with libraries and the content of its visual scene.
fn document(libraries: &str, nodes: &str) -> String {
    format!(
        "<?xml version='1.0'?><COLLADA xmlns='http://www.collada.org/2005/11/COLLADASchema' version='1.4.1'>\
         {libraries}<library_visual_scenes><visual_scene id='s'>{nodes}</visual_scene></library_visual_scenes>\
         <scene><instance_visual_scene url='#s'/></scene></COLLADA>"
    )
}

fn read(text: &str) -> (Option<Scene>, Vec<String>) {
    let folder = tempfile::tempdir().unwrap();
    read_in(folder.path(), "a.dae", text)
}

/// Reads a file that must not cause any diagnostics.
fn sound(text: &str) -> Scene {
    let (scene, messages) = read(text);
    assert_eq!(messages, [""; 0]);
    scene.unwrap()
}

/// Returns the corners of the triangles of objects, without the ground that is added to models.
fn corners(scene: &Scene) -> Vec<DVec3> {
    let mut scene = scene.clone();
    scene.root.as_mut().unwrap().objects.truncate(1);
    triangles(&scene).concat()
}

fn assert_at(found: DVec3, wanted: [f64; 3]) {
    assert!((found - DVec3::from(wanted)).length() < 1e-5, "{found}");
}

/// Reads a square with an effect, and returns its material.
fn material_in(folder: &Path, effect: &str, bind: &str) -> (PrincipledMaterial, Vec<String>, Scene) {
    let libraries = format!(
        "{SQUARE}<library_images><image id='img'><init_from>wood%20a.png</init_from></image></library_images>\
         <library_materials><material id='m'><instance_effect url='#e'/></material></library_materials>\
         <library_effects><effect id='e'><profile_COMMON>\
         <newparam sid='surface'><surface type='2D'><init_from>img</init_from></surface></newparam>\
         <newparam sid='sampler'><sampler2D><source>surface</source><wrap_s>MIRROR</wrap_s><wrap_t>CLAMP</wrap_t>\
         <minfilter>LINEAR_MIPMAP_LINEAR</minfilter></sampler2D></newparam>\
         <newparam sid='half'><float>0.5</float></newparam>\
         <technique sid='t'>{effect}</technique></profile_COMMON></effect></library_effects>"
    );
    let nodes = format!(
        "<node><instance_geometry url='#square'><bind_material><technique_common>\
         <instance_material symbol='skin' target='#m'>{bind}</instance_material></technique_common></bind_material>\
         </instance_geometry></node>"
    );
    let (scene, messages) = read_in(folder, "a.dae", document(&libraries, &nodes));
    let scene = scene.unwrap_or_else(|| panic!("{messages:?}"));
    let found = scene.materials.iter().find_map(|material| match &material.value {
        Material::Principled(material) => Some((**material).clone()),
        _ => None,
    });
    (found.unwrap(), messages, scene)
}

fn material(effect: &str) -> PrincipledMaterial {
    let (material, messages, _) = material_in(&std::env::temp_dir(), effect, "");
    assert_eq!(messages, [""; 0]);
    material
}

#[test]
fn transforms_apply_in_order_and_lengths_become_metres() {
    let asset = "<asset><unit name='inch' meter='0.0254'/><up_axis>Z_UP</up_axis></asset>";
    let nodes = "<node><translate>10 0 0</translate><rotate>0 0 1 90</rotate><scale>2 2 2</scale>\
                 <node><matrix>1 0 0 0 0 1 0 5 0 0 1 0 0 0 0 1</matrix><instance_geometry url='#square'/></node></node>";
    let scene = sound(&document(&format!("{asset}{SQUARE}"), nodes));
    assert_eq!(scene.up, Some(Axis::Z));
    // The corner (1, 0, 0) moves to (1, 5, 0), grows to (2, 10, 0), turns to (-10, 2, 0).
    let found = corners(&scene);
    assert_eq!(found.len(), 6);
    assert_at(found[1], [0.0, 2.0 * 0.0254, 0.0]);
    let nodes = "<node><lookat>1 2 3 1 2 -7 0 1 0</lookat><instance_geometry url='#square'/></node>";
    assert_at(corners(&sound(&document(SQUARE, nodes)))[1], [2.0, 2.0, 3.0]);
    let nodes = "<node><lookat>0 0 0 1 0 0 0 1 0</lookat><instance_geometry url='#square'/></node>";
    assert_at(corners(&sound(&document(SQUARE, nodes)))[1], [0.0, 0.0, 1.0]);
}

#[test]
fn instances_of_nodes_share_meshes() {
    let library = "<library_nodes><node id='pair'><instance_geometry url='#square'/><node><translate>0 2 0</translate>\
                   <instance_geometry url='#square'/></node></node></library_nodes>";
    let nodes = "<node><instance_node url='#pair'/><node><translate>5 0 0</translate><instance_node url='#pair'/></node></node>";
    let scene = sound(&document(&format!("{SQUARE}{library}"), nodes));
    assert_eq!(scene.assets.meshes.len(), 1);
    assert_eq!(scene.root.unwrap().objects.len(), 4 + 1);
    // A node that contains itself is an error, and so are many instances.
    let library = "<library_nodes><node id='pair'><instance_node url='#pair'/></node></library_nodes>";
    let (scene, messages) = read(&document(library, "<node><instance_node url='#pair'/></node>"));
    assert!(scene.is_none() && messages[0].contains("contains itself"), "{messages:?}");
    let mut library = "<node id='n0'/>".to_string();
    for i in 1..40 {
        library += &format!("<node id='n{i}'>{}</node>", format!("<instance_node url='#n{}'/>", i - 1).repeat(2));
    }
    let library = format!("<library_nodes>{library}</library_nodes>");
    let (scene, messages) = read(&document(&library, "<node><instance_node url='#n39'/></node>"));
    assert!(scene.is_none() && messages[0].contains("objects"), "{messages:?}");
}

#[test]
fn primitives_of_all_kinds_become_triangles() {
    let inputs = "<input semantic='VERTEX' source='#v' offset='0'/>";
    for (list, count) in [
        (format!("<triangles count='2'>{inputs}<p>0 1 2 0 2 3</p></triangles>"), 2),
        (format!("<polygons count='2'>{inputs}<p>0 1 2 3</p><p>0 1 2</p></polygons>"), 3),
        (format!("<tristrips count='1'>{inputs}<p>0 1 3 2</p></tristrips>"), 2),
        (format!("<trifans count='1'>{inputs}<p>0 1 2 3</p></trifans>"), 2),
    ] {
        let start = SQUARE.find("<polylist").unwrap();
        let end = SQUARE.find("</mesh>").unwrap();
        let text = format!("{}{list}{}", &SQUARE[..start], &SQUARE[end..]);
        let scene = sound(&document(&text, "<node><instance_geometry url='#square'/></node>"));
        let data = scene.assets.meshes.values().next().unwrap();
        assert_eq!((data.triangles.len(), data.flat), (count, true), "{list}");
        for corners in &data.triangles {
            let [a, b, c] = corners.map(|i| data.positions[i as usize]);
            assert!((b - a).cross(c - a).z > 0.0, "{list}");
        }
    }
    // Holes are filled, and lines are left out; both are reported once.
    let holed = "<polygons count='1'><input semantic='VERTEX' source='#v' offset='0'/><ph><p>0 1 2 3</p><h>0 1 2</h></ph>\
                 </polygons><lines count='1'><input semantic='VERTEX' source='#v' offset='0'/><p>0 1</p></lines></mesh>";
    let (scene, messages) =
        read(&document(&SQUARE.replace("</mesh>", holed), "<node><instance_geometry url='#square'/></node>"));
    assert!(scene.is_some());
    assert!(messages[0].contains("holes of polygons") && messages[1].contains("`lines`"), "{messages:?}");
    assert_eq!(messages.len(), 2);
}

#[test]
fn meshes_have_normals_and_two_sets_of_coordinates() {
    let scene = sound(&document(SQUARE, "<node><instance_geometry url='#square'/></node>"));
    let data = scene.assets.meshes.values().next().unwrap();
    assert_eq!((data.positions.len(), data.normals.len(), data.uvs.len()), (4, 1, 4));
    assert_eq!(data.second_uvs, [durer_scene::math::Vec2::new(0.25, 0.75); 4]);
    assert_eq!(data.uvs[data.triangle_uvs[0][2] as usize], durer_scene::math::Vec2::ONE);
}

#[test]
fn shaders_become_layers() {
    let color = |name: &str, value: &str| format!("<{name}><color>{value} 1</color></{name}>");
    // Colours are sRGB, where 0.5 is 0.214.
    let lambert = material(&format!("<lambert>{}</lambert>", color("diffuse", "0.5 1 0")));
    assert!((lambert.base_color - Vec3::new(0.214_04, 1.0, 0.0)).length() < 1e-4, "{}", lambert.base_color);
    assert_eq!((lambert.specular_weight, lambert.opacity), (0.0, 1.0));
    let phong = material(&format!(
        "<phong>{}{}<shininess><float>30</float></shininess><index_of_refraction><float>1.7</float></index_of_refraction></phong>",
        color("diffuse", "1 1 1"),
        color("specular", "1 1 1")
    ));
    assert_eq!((phong.specular_weight, phong.specular_ior), (1.0, 1.7));
    assert!((phong.specular_roughness - 0.5).abs() < 1e-6);
    let blinn =
        material(&format!("<blinn>{}<shininess><param ref='half'/></shininess></blinn>", color("specular", "1 1 1")));
    assert_eq!((blinn.specular_roughness, blinn.base_color), (0.5, Vec3::ZERO));
    let constant = material(&format!("<constant>{}</constant>", color("emission", "2 1 0")));
    assert_eq!((constant.emission_luminance, constant.base_color), (2.0, Vec3::ZERO));
    let mirror = material(&format!(
        "<phong>{}{}<reflectivity><float>0.5</float></reflectivity></phong>",
        color("diffuse", "0 0 0"),
        color("reflective", "1 1 1")
    ));
    assert_eq!((mirror.base_metalness, mirror.base_color, mirror.specular_roughness), (1.0, Vec3::splat(0.5), 0.0));
}

#[test]
fn transparency_has_four_modes() {
    for (transparent, amount, wanted) in [
        ("", "<float>0.25</float>", 0.25),
        ("<transparent opaque='A_ONE'><color>0 0 0 0.5</color></transparent>", "<float>0.5</float>", 0.25),
        ("<transparent opaque='A_ZERO'><color>0 0 0 0.5</color></transparent>", "<float>0.5</float>", 0.75),
        ("<transparent opaque='RGB_ZERO'><color>1 1 1 1</color></transparent>", "<float>0.25</float>", 0.75),
        ("<transparent opaque='RGB_ONE'><color>1 1 1 1</color></transparent>", "<float>0.25</float>", 0.25),
    ] {
        let found = material(&format!("<lambert>{transparent}<transparency>{amount}</transparency></lambert>"));
        assert!((found.opacity - wanted).abs() < 1e-5, "{transparent}: {}", found.opacity);
    }
    let effect = "<lambert><transparency><float>0</float></transparency></lambert>";
    let (found, messages, _) = material_in(&std::env::temp_dir(), effect, "");
    assert!(found.opacity == 1.0 && messages[0].contains("fully transparent"), "{messages:?}");
}

#[test]
fn textures_are_found_through_their_samplers() {
    let png = crate::pictures::as_png(
        durer_image::Image::from_pixels(1, 1, vec![Vec3::ONE]).unwrap(),
        durer_image::Transfer::Srgb,
    );
    let folder = folder(&[("wood a.png", &png.unwrap())]);
    let texture = "<texture texture='sampler' texcoord='UV'/>";
    let effect = format!(
        "<lambert><diffuse>{texture}</diffuse><transparent opaque='RGB_ZERO'>{texture}</transparent>\
         <transparency><float>0.5</float></transparency></lambert>"
    );
    for (bind, second) in [
        ("<bind_vertex_input semantic='UV' input_semantic='TEXCOORD' input_set='5'/>", true),
        ("<bind_vertex_input semantic='UV' input_semantic='TEXCOORD' input_set='3'/>", false),
        ("", false),
    ] {
        let (found, messages, scene) = material_in(folder.path(), &effect, bind);
        assert_eq!(messages, [""; 0]);
        let picture =
            |name: Option<durer_scene::describe::FileName>| scene.assets.pictures[&name.unwrap().path].clone();
        let color = picture(found.base_color_texture);
        assert_eq!(color.bytes.path(), "wood a.png");
        assert_eq!(color.mapping.wrap, [Wrap::Mirror, Wrap::Clamp]);
        assert_eq!((color.mapping.second, color.mapping.mipmaps), (second, true));
        let opacity = picture(found.opacity_texture);
        assert_eq!((opacity.mapping.channel, opacity.mapping.range), (Some(Channel::Red), [1.0, 0.5]));
    }
    // A missing picture is reported, and the surface is grey.
    let (found, messages, _) = material_in(
        &std::env::temp_dir(),
        "<lambert><diffuse><texture texture='sampler' texcoord=''/></diffuse></lambert>",
        "",
    );
    assert_eq!(found.base_color, Vec3::splat(0.8));
    assert!(messages[0].contains("the picture `wood%20a.png` was not found"), "{messages:?}");
}

#[test]
fn lights_have_their_strength_and_attenuation() {
    let light = |kind: &str, more: &str| {
        let library = format!(
            "<asset><unit meter='0.5'/></asset>{SQUARE}<library_lights><light id='l'><technique_common><{kind}>\
             <color>1 2 4</color>{more}</{kind}></technique_common></light></library_lights>"
        );
        let nodes = "<node><instance_geometry url='#square'/></node>\
                     <node><translate>0.5 0.5 4</translate><instance_light url='#l'/></node>";
        read(&document(&library, nodes))
    };
    let arriving = |scene: &Scene, point: [f64; 3]| {
        let light = &scene.lights.as_ref().unwrap()[0].value;
        light.illuminate(DVec3::from(point)).color.x
    };
    // The light is 2 m above the square in metres. Coefficients count units of half a metre.
    let (scene, messages) = light("point", "<linear_attenuation>1</linear_attenuation>");
    assert_eq!(messages, [""; 0]);
    assert!((arriving(&scene.unwrap(), [0.25, 0.25, 0.0]) - 1.0 / 5.0).abs() < 1e-6);
    let (scene, _) = light("point", "");
    assert_eq!(arriving(&scene.unwrap(), [0.25, 0.25, 0.0]), 1.0);
    let (scene, _) = light("directional", "");
    let scene = scene.unwrap();
    let Light::Directional(sun) = &scene.lights.as_ref().unwrap()[0].value else { panic!() };
    assert_eq!((sun.direction, sun.color), (Vec3::NEG_Z, Vec3::new(1.0, 2.0, 4.0)));
    let (scene, messages) = light("spot", "<falloff_angle>60</falloff_angle>");
    let scene = scene.unwrap();
    let Light::Spot(spot) = &scene.lights.as_ref().unwrap()[0].value else { panic!() };
    assert_eq!((spot.angle, spot.inner_angle), (30.0, 30.0));
    assert!(messages[0].contains("squared distance") && messages.len() == 1, "{messages:?}");
    assert!((arriving(&scene, [0.25, 0.25, 0.0]) - 1.0).abs() < 1e-5);
    let soft = light("spot", "<falloff_angle>90</falloff_angle><falloff_exponent>8</falloff_exponent>").0.unwrap();
    let Light::Spot(spot) = &soft.lights.as_ref().unwrap()[0].value else { panic!() };
    assert!(spot.inner_angle < 40.0 && spot.inner_angle > 1.0, "{}", spot.inner_angle);
    let (scene, messages) = light("ambient", "");
    let scene = scene.unwrap();
    assert_eq!((scene.background.color, messages.len()), (Vec3::new(1.0, 2.0, 4.0), 0));
}

#[test]
fn blender_states_watts_and_linear_colours() {
    let library = format!(
        "<asset><contributor><authoring_tool>Blender 2.93.4 commit</authoring_tool></contributor></asset>{SQUARE}\
         <library_lights><light id='l'><technique_common><point><color>1000 1000 1000</color>\
         <constant_attenuation>1</constant_attenuation></point></technique_common></light></library_lights>"
    );
    let scene = sound(&document(&library, "<node><instance_geometry url='#square'/><instance_light url='#l'/></node>"));
    let light = scene.lights.as_ref().unwrap()[0].value.illuminate(DVec3::new(0.0, 0.0, 2.0));
    // A light of 1000 W has 1000 / (4 pi) W/sr, and a white surface reflects 1 / pi of that.
    assert!((light.color.x - 1000.0 / (39.478_42 * 4.0)).abs() < 1e-3, "{}", light.color);
}

#[test]
fn cameras_show_what_the_file_states() {
    let camera = |lens: &str| {
        let library = format!(
            "{SQUARE}<library_cameras><camera id='c'><optics><technique_common>{lens}</technique_common></optics></camera>\
             </library_cameras><library_lights><light id='l'><technique_common><directional><color>1 1 1</color>\
             </directional></technique_common></light></library_lights>"
        );
        // The camera of a model without lights is moved until all is visible.
        let nodes = "<node><instance_geometry url='#square'/><instance_light url='#l'/></node>\
                     <node><translate>0 0 9</translate><instance_camera url='#c'/></node>";
        sound(&document(&library, nodes)).camera.unwrap()
    };
    // Loading without a size assumes a square picture unless the file states another.
    for (lens, wanted) in [
        ("<perspective><xfov>40</xfov><yfov>30</yfov></perspective>", 40.0),
        ("<perspective><yfov>30</yfov></perspective>", 30.0),
        ("<perspective><xfov>60</xfov><aspect_ratio>2</aspect_ratio></perspective>", 60.0),
        ("<perspective><yfov>53.1301</yfov><aspect_ratio>2</aspect_ratio></perspective>", 90.0),
    ] {
        let Camera::Perspective(camera) = camera(lens) else { panic!("{lens}") };
        assert!((camera.angle - wanted).abs() < 1e-3, "{lens}: {}", camera.angle);
        assert_eq!((camera.center, camera.direction), (Vec3::new(0.0, 0.0, 9.0), Vec3::NEG_Z));
    }
    let Camera::Orthographic(camera) = camera("<orthographic><xmag>3</xmag></orthographic>") else { panic!() };
    assert_eq!(camera.size, 6.0);
}

/// Mesh that follows two joints, of which the second is moved by (0, 0, 3).
const SKIN: &str = "<library_controllers><controller id='c'><skin source='#square'>\
    <bind_shape_matrix>1 0 0 0 0 1 0 0 0 0 1 0 0 0 0 1</bind_shape_matrix>\
    <source id='names'><Name_array count='2'>a b</Name_array></source>\
    <source id='binds'><float_array>1 0 0 0 0 1 0 0 0 0 1 0 0 0 0 1 1 0 0 0 0 1 0 0 0 0 1 0 0 0 0 1</float_array>\
    <technique_common><accessor count='2' stride='16'/></technique_common></source>\
    <source id='weights'><float_array>1 0.5</float_array><technique_common><accessor count='2' stride='1'/>\
    </technique_common></source>\
    <joints><input semantic='JOINT' source='#names'/><input semantic='INV_BIND_MATRIX' source='#binds'/></joints>\
    <vertex_weights count='4'><input semantic='JOINT' source='#names' offset='0'/>\
    <input semantic='WEIGHT' source='#weights' offset='1'/><vcount>1 1 2 2</vcount><v>0 0 1 0 0 1 1 1 0 1 1 1</v>\
    </vertex_weights></skin></controller></library_controllers>";

#[test]
fn skins_follow_their_joints() {
    let nodes = "<node id='root'><node sid='a'><node sid='b'><translate>0 0 3</translate></node></node></node>\
                 <node><translate>100 0 0</translate><instance_controller url='#c'><skeleton>#root</skeleton>\
                 </instance_controller></node>";
    let found = corners(&sound(&document(&format!("{SQUARE}{SKIN}"), nodes)));
    for (corner, wanted) in [(0, [0.0, 0.0, 0.0]), (1, [1.0, 0.0, 3.0]), (2, [1.0, 1.0, 1.5]), (5, [0.0, 1.0, 1.5])] {
        assert_at(found[corner], wanted);
    }
    // Without its joints, the mesh stays where its node is.
    let nodes = "<node><translate>0 0 7</translate><instance_controller url='#c'/></node>";
    let (scene, messages) = read(&document(&format!("{SQUARE}{SKIN}"), nodes));
    assert!(messages[0].contains("no joint `a`"), "{messages:?}");
    assert_at(corners(&scene.unwrap())[1], [1.0, 0.0, 7.0]);
}

#[test]
fn errors_have_places() {
    let node = "<node><instance_geometry url='#square'/></node>";
    for (from, to, wanted) in [
        (
            "url='#square'",
            "url='#sqare'",
            "error the file has no `geometry` with the id `sqare` (did you mean `square`?)",
        ),
        ("0 0 0 1 0 0 1 1 0 0 1 0", "0 0 0 1 x 0", "a.dae:2:56 error `float_array` needs numbers, found `x`"),
        (
            "0 0 0 1 0 0 1 1 0 0 1 0",
            "0 0 0",
            "error this `source` should have 4 vectors of 3 numbers, but its numbers are enough for 1",
        ),
        ("0 0 1 0 2 0 3 0", "0 0 1 0 2 0 4 0", "error index 4 is out of range: there are 4 positions"),
        ("0 0 1 0 2 0 3 0", "0 0 1 0 2 0 -1 0", "error a negative index is out of range: there are 4 positions"),
        ("0 0 1 0 2 0 3 0", "0 0 1 0 2 0 3", "error each corner has 2 indices, but there are 7"),
        ("<vcount>4</vcount>", "<vcount>4 3</vcount>", "error `vcount` lists more corners than the 4 of `p`"),
        ("stride=\"3\"", "stride=\"0\"", "error `stride` must not be 0"),
        ("offset=\"1\"", "offset=\"1000000\"", "error `offset` must be an integer from 0 to 255"),
        ("</polylist>", "", "error `</mesh>` comes before `</polylist>`"),
        ("<node>", "<node><scale>1 2</scale>", "error `scale` needs 3 numbers, found 2"),
    ] {
        let text = document(SQUARE, node);
        assert!(text.contains(from), "{from}");
        let (scene, messages) = read(&text.replacen(from, to, 1));
        assert!(scene.is_none() && messages.iter().any(|message| message.contains(wanted)), "{from}: {messages:#?}");
    }
    // Numbers of some languages have a comma, and materials that are missing are left out.
    let (scene, messages) = read(&document(&SQUARE.replacen("1 1 0 0 1 0<", "1 1 0 0 1,0 0<", 1), node));
    assert!(scene.is_some() && messages[0].contains("comma"), "{messages:?}");
    let bound = "<bind_material><technique_common><instance_material symbol='skin' target='#no'/></technique_common>";
    let bound = format!("<node><instance_geometry url='#square'>{bound}</bind_material></instance_geometry></node>");
    let (scene, messages) = read(&document(SQUARE, &bound));
    assert!(scene.is_some() && messages[0].contains("no `material` with the id `no`"), "{messages:?}");
    // A point that is not a number costs its polygons only.
    let (scene, messages) = read(&document(&SQUARE.replacen("0 0 0 1", "NaN 0 0 1", 1), node));
    assert!(scene.is_some() && messages[0].contains("1 polygons"), "{messages:?}");
}

#[test]
fn texts_in_utf_16_are_read() {
    let text = document(SQUARE, "<node><instance_geometry url='#square'/></node>");
    let number: fn(u16) -> [u8; 2] = u16::to_le_bytes;
    let bytes: Vec<u8> = "\u{feff}".encode_utf16().chain(text.encode_utf16()).flat_map(number).collect();
    let folder = folder(&[]);
    let (scene, messages) = read_in(folder.path(), "a.dae", bytes);
    assert!(scene.is_some(), "{messages:?}");
}

#[test]
fn cut_and_changed_files_never_panic() {
    let libraries = format!(
        "<asset><unit meter='0.1'/></asset>{SQUARE}{SKIN}\
         <library_materials><material id='skin'><instance_effect url='#e'/></material></library_materials>\
         <library_effects><effect id='e'><profile_COMMON><technique><phong><diffuse><color>1 0 0 1</color></diffuse>\
         <transparent opaque='RGB_ZERO'><color>0 0 0 1</color></transparent></phong></technique></profile_COMMON></effect>\
         </library_effects><library_lights><light id='l'><technique_common><spot><color>1 1 1</color></spot>\
         </technique_common></light></library_lights><library_cameras><camera id='k'><optics><technique_common>\
         <perspective><xfov>40</xfov></perspective></technique_common></optics></camera></library_cameras>"
    );
    let nodes = "<node id='root'><node sid='a'><node sid='b'><translate>0 0 3</translate></node></node></node>\
                 <node><instance_controller url='#c'><skeleton>#root</skeleton></instance_controller>\
                 <instance_geometry url='#square'/><instance_light url='#l'/><instance_camera url='#k'/></node>";
    let text = document(&libraries, nodes);
    let (scene, messages) = read(&text);
    assert!(scene.is_some(), "{messages:?}");
    let folder = folder(&[]);
    for length in (0..text.len()).step_by(10) {
        let (scene, _) = read_in(folder.path(), "a.dae", &text[..length]);
        assert!(scene.is_none(), "{length}");
    }
    let mut random = Random(60);
    let mut sound = 0;
    for _ in 0..3_000 {
        let mut bytes = text.clone().into_bytes();
        for _ in 0..1 + random.below(3) {
            let (at, from) = (random.below(bytes.len()), random.below(bytes.len()));
            match random.below(4) {
                0 => bytes[at] = bytes[from],
                1 => bytes[at] = random.below(256) as u8,
                2 => bytes[at] = b"0123456789-e. #'<>/"[random.below(19)],
                _ => {
                    let length = random.below(40).min(bytes.len() - from);
                    let piece = bytes[from..from + length].to_vec();
                    bytes.splice(at..at, piece);
                }
            }
        }
        sound += usize::from(read_in(folder.path(), "a.dae", bytes).0.is_some());
    }
    assert!(sound > 100, "{sound}");
}
