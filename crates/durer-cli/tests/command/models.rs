//! Tests models on the command line: rendering, `info`, conversion, and errors with their
//! positions.

use crate::common::TestFolder;

const STL: &str = "solid a\nfacet normal 0 0 0\nouter loop\nvertex 0 0 0\nvertex 1 0 0\nvertex 0 1 1\nendloop\nendfacet\n\
    facet normal 0 0 0\nouter loop\nvertex 1 0 0\nvertex 1 1 0.5\nvertex 0 1 1\nendloop\nendfacet\nendsolid a\n";

const SMALL: &str = "--size 24x16 --samples 2";

#[test]
fn model_is_rendered_with_every_view_and_studio() {
    let folder = TestFolder::new();
    folder.write("a.stl", STL);
    let hash = |more: &str| folder.expect_exit(0, &format!("render a.stl -o a.png {SMALL} --hash -q {more}")).out;
    let usual = hash("");
    assert_eq!(hash("--up z --view three-quarter --studio soft"), usual);
    for other in ["--up y", "--view front", "--view side", "--view top", "--view iso", "--studio sun", "--studio none"]
    {
        assert_ne!(hash(other), usual, "{other}");
    }
    folder.expect_failure(2, "render a.stl -o a.png --view behind", &["behind", "three-quarter"]);
    folder.expect_failure(2, "render a.stl -o a.png --at soon", &["--at", "seconds"]);
    assert!(folder.expect_exit(0, "info a.stl").out.contains("2 in meshes"));
}

#[test]
fn model_is_converted_to_meshes_and_scenes() {
    let folder = TestFolder::new();
    folder.write("a.stl", STL);
    for name in ["b.ply", "b.obj", "b.stl", "b.glb", "b.gltf"] {
        folder.expect_exit(0, &format!("convert a.stl -o {name}"));
        assert!(folder.expect_exit(0, &format!("info {name}")).out.contains("2 in meshes"), "{name}");
    }
    let hash = |name: &str| folder.expect_exit(0, &format!("render {name} -o a.png {SMALL} --hash -q")).out;
    // A model without a camera is framed for a square picture.
    let picture = |name: &str| {
        folder.expect_exit(0, &format!("render {name} -o a.ppm --size 24x24 --samples 2 -q --restart"));
        std::fs::read(folder.path("a.ppm")).unwrap()
    };
    for name in ["words.txt", "json.json"] {
        let output = folder.expect_exit(0, &format!("convert a.stl -o {name}")).out;
        assert!(output.contains(name) && output.contains("a.stl.ply"), "{output}");
        assert_eq!(picture(name), picture("a.stl"), "{name}");
        // Files written by `convert` are ordinary scenes.
        folder.expect_exit(0, &format!("convert {name} -o again-{name}"));
        assert_eq!(hash(&format!("again-{name}")), hash(name), "{name}");
    }
    folder.expect_failure(2, "convert a.stl -o b --to durer", &["the output needs an extension"]);
}

#[test]
fn crop_of_a_file_is_rendered() {
    let folder = TestFolder::new();
    let film = |more: &str| {
        format!(
            "Film \"rgb\" \"integer xresolution\" 30 \"integer yresolution\" 20 {more} Camera \"perspective\" WorldBegin\n\
             LightSource \"infinite\" Translate 0 0 4 Shape \"sphere\""
        )
    };
    folder.write("whole.pbrt", film(""));
    folder.write("part.pbrt", film("\"integer pixelbounds\" [5 20 3 15]"));
    let picture = |options: &str| {
        folder.expect_exit(0, &format!("render {options} -o a.pfm --samples 4 -q --restart"));
        folder.image("a.pfm")
    };
    let part = picture("part.pbrt");
    assert_eq!((part.width, part.height), (15, 12));
    assert!(part == picture("whole.pbrt --crop 5,3,15x12"));
    // Options override the settings in the file.
    assert!(picture("part.pbrt --crop 0,0,30x20") == picture("whole.pbrt"));
    assert_eq!(picture("part.pbrt --size 60x40").width, 60);
}

#[test]
fn model_errors_have_line_and_column() {
    let folder = TestFolder::new();
    folder.write("a.stl", STL.replace("1 1 0.5", "1 1 x"));
    folder.expect_failure(2, "render a.stl -o a.png", &["a.stl:12:12", "expected a number, found `x`"]);
    folder.write("a.gltf", "{ \"asset\": { \"version\": \"2.0\" },\n  \"nodes\": [{ \"mesh\": 3 }] }");
    folder.expect_failure(2, "render a.gltf -o a.png", &["UNRESOLVED_REFERENCE", "/nodes/0/mesh", "a.gltf:2:23"]);
    assert!(!folder.path("a.png").exists());
}

#[test]
fn model_objects_are_reported_once_by_name() {
    let folder = TestFolder::new();
    folder.write("empty.gltf", r#"{"asset":{"version":"2.0"},"scenes":[{"name":"S"}]}"#);
    let output = folder.expect_exit(0, &format!("render empty.gltf -o a.png {SMALL}"));
    assert!(output.err.contains("empty.gltf:1:38") && !output.err.contains("Group"), "{}", output.err);
    assert_eq!(output.err.matches("no-objects").count(), 1, "{}", output.err);
    folder.write("empty.obj", "# nothing\n");
    let found = folder.run("check empty.obj");
    assert!(found.out.contains("the scene has no surfaces") && !found.out.contains("Group"), "{}", found.out);
    let room = "PerspectiveCamera { center 0 0 0 direction 0 0 -1 up 0 1 0 angle 40 }\nLights { DirectionalLight { direction \
                0 -1 0 color 1 1 1 } }\nMaterials { PhongMaterial { diffuseColor 1 1 1 } }\nGroup { MaterialIndex 0 Box { min \
                -1 -1 -1 max 1 1 1 } }\n";
    folder.write("room.txt", room);
    folder.expect_exit(0, "convert room.txt -o room.gltf");
    let text = String::from_utf8(folder.bytes("room.gltf")).unwrap();
    folder.write("named.gltf", text.replacen("\"mesh\": 0", "\"name\": \"Room\", \"mesh\": 0", 1));
    assert!(folder.run("check room.gltf").out.contains("the camera is inside the mesh at "));
    assert!(folder.run("check named.gltf").out.contains("the camera is inside the mesh `Room` at "));
    folder.write("a.obj", "ply\nformat ascii 1.0\n");
    folder.expect_failure(2, "render a.obj -o a.png", &["a.obj:1:1", "`a.obj` is PLY", "`a.ply`"]);
    folder.write("a.txt", "Lights { } Group { TriangleMesh { obj_file a.obj } }\nPerspectiveCamera { center 0 0 5 direction 0 0 -1 up 0 1 0 angle 40 }");
    folder.expect_failure(2, "render a.txt -o a.png", &["a.obj:1:1", "`a.obj` is PLY", "named here"]);
}

const RAD: &str = "void plastic grey 0 0 5 .5 .5 .5 0 0\nvoid light glow 0 0 3 9 9 9\ngrey polygon floor 0 0 12 -4 -4 0 4 -4 0 4 4 0 -4 4 0\n\
    glow sphere bulb 0 0 4 0 0 3 .5\n!genbox grey box 1 1 1 | xform -t 1 0 0\n";

#[test]
fn radiance_views_are_cameras() {
    let folder = TestFolder::new();
    folder.write("a.rad", RAD);
    folder.write(
        "a.rif",
        "scene = a.rad\nRES = 24\nview = one -vp 0 -9 3 -vd 0 9 -2 -vh 40 -vv 30\nview = two -vp 3 -9 3 -vd 0 9 -2\n",
    );
    folder.write("a.vf", "VIEW= -vp 0 -9 3 -vd 0 9 -2 -vh 40 -vv 30\n");
    let hash = |what: &str| folder.expect_exit(0, &format!("render {what} -o a.png --samples 2 --hash -q")).out;
    let usual = hash("a.rif");
    assert_eq!(hash("a.rif --camera one"), usual);
    assert_eq!(hash("a.rad --view-file a.vf --size 24x17"), hash("a.rif --size 24x17"));
    assert_ne!(hash("a.rif --camera two"), usual);
    folder.expect_failure(2, "render a.rif -o a.png --camera three", &["unknown view `three`"]);
    folder.expect_failure(2, "render a.rad -o a.png --view-file none.vf", &["none.vf"]);
    folder.write("b.rad", "void plastic grey 0 0 5 .5 .5 x 0 0\n!genrev a b 1 2 3\n");
    folder.expect_failure(2, "render b.rad -o a.png", &["b.rad:1:31", "expected a number, found `x`"]);
}

const XML: &str = "<scene version='3.0.0'><sensor type='perspective' id='one'><float name='fov' value='40'/><transform name='to_world'>\
    <lookat origin='0,0,5' target='0,0,0' up='0,1,0'/></transform><film type='hdrfilm'><integer name='width' value='24'/>\
    <integer name='height' value='16'/></film></sensor><sensor type='perspective' id='two'><float name='fov' value='70'/><transform name='to_world'>\
    <lookat origin='0,0,5' target='0,0,0' up='0,1,0'/></transform></sensor><shape type='sphere'><bsdf type='diffuse'/></shape>\
    <emitter type='point'><point name='position' x='3' y='3' z='5'/></emitter></scene>";

#[test]
fn mitsuba_sensors_are_cameras_and_scenes_convert_to_gltf() {
    let folder = TestFolder::new();
    folder.write("a.xml", XML);
    let hash = |what: &str| folder.expect_exit(0, &format!("render {what} -o a.png --samples 2 --hash -q")).out;
    let usual = hash("a.xml");
    assert_eq!(hash("a.xml --camera one"), usual);
    assert_ne!(hash("a.xml --camera two --size 24x16"), usual);
    folder.expect_failure(2, "render a.xml -o a.png --camera three", &["unknown sensor `three`"]);
    folder.expect_exit(0, "convert a.xml -o a.glb");
    assert!(folder.expect_exit(0, "info a.glb").out.contains("in meshes"));
    folder.write("b.xml", XML.replace("'40'", "'wide'"));
    folder.expect_failure(2, "render b.xml -o b.png", &["b.xml:1:85", "expected a number, found `wide`"]);
}

#[test]
fn scenes_for_other_programs_are_saved_with_their_files_or_not_at_all() {
    let folder = TestFolder::new();
    folder.write("a.stl", STL);
    let entries = |folder: &TestFolder| std::fs::read_dir(folder.path(".")).unwrap().count();
    for (name, stem) in [("b.xml", "b"), ("c.pbrt", "c")] {
        let before = entries(&folder);
        folder.expect_failure(1, &format!("convert a.stl -o missing/{name}"), &["does not exist"]);
        folder.expect_failure(2, &format!("convert a.stl -o {name} --to durer"), &["cannot be written"]);
        // A file has the name of the folder for the meshes.
        folder.write(stem, "");
        let refused = format!("cannot create the folder `{stem}`");
        folder.expect_failure(1, &format!("convert a.stl -o {name}"), &[&refused]);
        std::fs::remove_file(folder.path(stem)).unwrap();
        // A mesh would be written where a folder is.
        std::fs::create_dir_all(folder.path(&format!("{stem}/a.stl.ply"))).unwrap();
        assert_ne!(folder.run(&format!("convert a.stl -o {name}")).code, Some(0));
        std::fs::remove_dir_all(folder.path(stem)).unwrap();
        assert_eq!(entries(&folder), before, "{name}");
        let output = folder.expect_exit(0, &format!("convert a.stl -o {name}")).out;
        assert!(output.contains(name) && output.contains("a.stl.ply"), "{output}");
        folder.expect_exit(0, &format!("render {name} -o a.png {SMALL} -q"));
        // Files of an earlier conversion are replaced, but not those that the scene itself uses.
        folder.expect_exit(0, &format!("convert a.stl -o {name}"));
        folder.expect_failure(2, &format!("convert {name} -o {name}"), &["would overwrite"]);
    }
}

const COURSE: &str = "PerspectiveCamera { center 0 0 5 direction 0 0 -1 up 0 1 0 angle 40 }
    Lights { DirectionalLight { direction 0 0 -1 color 1 1 1 } }";

const BALL: &str = "Materials { PhongMaterial { diffuseColor 1 0 0 } }
    Group { MaterialIndex 0 Sphere { center 0 0 0 radius 1 } }";

#[test]
fn frames_are_times_cameras_and_files() {
    let folder = TestFolder::new();
    folder.write("a.stl", STL);
    let hash = |words: &str| folder.expect_exit(0, &format!("render {words} {SMALL} --hash -q")).out;
    // A frame of a turntable does not change if it is rendered alone or with `--turned`.
    let all = hash("a.stl -o a.png --turntable 3");
    let alone: String = (0..3).map(|i| hash(&format!("a.stl -o a.png --turntable 3 --frames {i}"))).collect();
    let turned: String = [0, 120, 240].map(|angle| hash(&format!("a.stl -o a.png --turned {angle}"))).concat();
    assert!(all == alone && all == turned, "{all} {alone} {turned}");
    // Frame numbers replace %d in scenes and cameras.
    for (i, diffuse) in [(8, "1 0 0"), (9, "0 1 0"), (10, "0 0 1")] {
        let material = format!("Materials {{ PhongMaterial {{ diffuseColor {diffuse} }} }}");
        let text = format!("{COURSE} {material} Group {{ MaterialIndex 0 Sphere {{ center 0 0 0 radius 1 }} }}");
        folder.write(&format!("walk.{i:02}.txt"), text);
    }
    let frames = hash("walk.%02d.txt -o w.%d.png --frames 8-10");
    let singly: String = (8..11).map(|i| hash(&format!("walk.{i:02}.txt -o a.png"))).collect();
    assert!(frames == singly && folder.path("w.10.png").exists() && !folder.path("w.11.png").exists());
    folder.write("a.xml", XML);
    assert_eq!(
        hash("a.xml -o a.png --camera %d --frames 0-1"),
        hash("a.xml -o a.png --camera 0") + &hash("a.xml -o a.png --camera 1")
    );
    // Renders shards of frames in the way farms do.
    for shard in [1, 2] {
        hash(&format!("walk.%02d.txt --frames 8-9 --shard {shard}/2 -o %d.{shard}.part"));
    }
    assert_eq!(folder.expect_exit(0, "merge 9.1.part 9.2.part -o b.png --hash -q").out, hash("walk.09.txt -o a.png"));
    folder.expect_failure(2, "render walk.08.txt --frames 1-3", &["all frames would be equal"]);
    folder.expect_failure(2, "render walk.%02d.txt --frames 3-1", &["expected frames from 0 to 9999999"]);
    folder.expect_failure(2, "render walk.%02d.txt --frames 8-9 --watch", &["apply to one picture"]);
    folder.expect_failure(2, "render a.stl --turntable 4 --turned 3", &["remove --camera, --view-file and --turned"]);
    folder.expect_failure(2, "render a.stl --fps 4", &["--frames"]);
    assert!(folder.expect_exit(2, "render walk.%02d.txt --frames 10-11 -q").err.contains("walk.11.txt"));
}

#[test]
fn turntable_rotates_and_fit_moves_the_camera() {
    let folder = TestFolder::new();
    folder.write("a.stl", STL);
    folder.expect_exit(0, &format!("render a.stl -o a.png {SMALL} --turntable 4"));
    let frame = |i: u32| std::fs::read(folder.path(&format!("a.000{i}.png"))).unwrap();
    assert!(frame(0) != frame(1) && frame(1) != frame(2) && frame(2) != frame(3));
    assert!(!folder.path("a.0004.png").exists() && !folder.path("a.png").exists());
    // `--eye` places the camera of the first frame.
    let hash = |more: &str| folder.expect_exit(0, &format!("render a.stl -o a.png {SMALL} --hash -q {more}")).out;
    assert_eq!(hash("--eye 0.5,-4,2 --turned 0"), hash("--eye 0.5,-4,2"));
    assert_ne!(hash("--eye 0.5,-4,2 --turned 90"), hash("--eye 0.5,-4,2"));
    folder.expect_failure(2, "render a.stl -o a.png --turntable 0", &["--turntable"]);
    folder.expect_failure(2, "render a.stl -o a.png --turntable 4 --preview b.png", &["apply to one picture"]);
    // With --fit, a camera that pointed past the model shows the model.
    folder.write("a.rad", RAD);
    folder.write("a.vf", "VIEW= -vp 0 -900 900 -vd 0 -1 -.1 -vh 40 -vv 30\n");
    let hash = |more: &str| {
        folder.expect_exit(0, &format!("render a.rad -o a.png {SMALL} --hash -q --view-file a.vf {more}")).out
    };
    assert_ne!(hash("--fit"), hash(""));
}

#[test]
fn turntable_rotates_the_camera_of_a_scene() {
    let folder = TestFolder::new();
    // A white ball on the left of a black one, around the point (0, 0, -2).
    let scene = |camera: &str| {
        format!(
            "{camera} Background {{ color 0.5 0.5 0.5 ambientLight 1 1 1 }} Lights {{ }} Materials {{ \
             PhongMaterial {{ diffuseColor 0 0 0 }} \
             PhongMaterial {{ diffuseColor 1 1 1 }} }} \
             Group {{ MaterialIndex 0 Sphere {{ center 1 0 -2 radius 0.5 }} \
             MaterialIndex 1 Sphere {{ center -1 0 -2 radius 0.5 }} }}"
        )
    };
    let pose = "center 0 0 3 direction 0 0 -1 up 0 1 0";
    for camera in [
        format!("PerspectiveCamera {{ {pose} angle 40 }}"),
        format!("OrthographicCamera {{ {pose} size 4 }}"),
        format!("FisheyeCamera {{ {pose} angle 60 }}"),
    ] {
        folder.write("a.txt", scene(&camera));
        let row = |more: &str| {
            folder.expect_exit(0, &format!("render a.txt -o a.ppm --size 40x40 --samples 1 -q {more}"));
            let bytes = std::fs::read(folder.path("a.ppm")).unwrap();
            let row = bytes.len() - 20 * 3 * 40;
            (0..40).map(|x| bytes[row + 3 * x]).collect::<Vec<u8>>()
        };
        let from_front = row("");
        let is_white_first = |row: &[u8]| {
            let place = |value: u8| row.iter().position(|x| *x == value).unwrap();
            place(255) < place(0)
        };
        assert!(is_white_first(&from_front), "{camera}");
        assert_eq!(row("--turned 0"), from_front, "{camera}");
        assert!(!is_white_first(&row("--turned 180")), "{camera}");
        // From the right, the black ball hides the white one.
        assert!(!row("--turned 90").contains(&255), "{camera}");
        assert!(!row("--turned 270").contains(&0), "{camera}");
    }
    // A camera that looks down rotates about the vertical, too, and keeps its view.
    folder.write("a.txt", scene("PerspectiveCamera { center 0 5 -2 direction 0 -1 0 up 0 0 -1 angle 40 }"));
    folder.expect_exit(0, "render a.txt -o a.ppm --size 40x40 --samples 1 -q --turned 90");
    let bytes = std::fs::read(folder.path("a.ppm")).unwrap();
    let column: Vec<u8> = (0..40).map(|y| bytes[bytes.len() - (40 - y) * 120 + 60]).collect();
    assert!(column.contains(&255) && column.contains(&0), "{column:?}");
    folder.expect_exit(0, &format!("render a.txt -o t.png {SMALL} --turntable 3 -q"));
    assert!(folder.path("t.0002.png").exists());
    folder.write("a.txt", scene("PushBroomCamera { start -2 0 3 end 2 0 3 direction 0 0 -1 up 0 1 0 angle 40 }"));
    folder.expect_failure(2, "render a.txt -o t.png --turned 9", &["`PushBroomCamera` cannot be rotated", "--eye"]);
}

#[test]
fn shapes_become_triangles_of_mesh_files() {
    let folder = TestFolder::new();
    folder.write("a.txt", COURSE.to_string() + BALL);
    for name in ["a.stl", "a.ply", "a.obj", "a.off"] {
        folder.expect_exit(0, &format!("convert a.txt -o {name}"));
        let json = folder.expect_exit(0, &format!("info {name} --json")).out;
        let json: serde_json::Value = serde_json::from_str(&json).unwrap();
        assert!((json["area"].as_f64().unwrap() / (4.0 * std::f64::consts::PI) - 1.0).abs() < 0.01, "{name}: {json}");
    }
    folder.write(
        "b.txt",
        COURSE.to_string() + &BALL.replace("Sphere { center 0 0 0 radius 1 }", "Plane { normal 0 1 0 offset 0 }"),
    );
    folder.expect_failure(2, "convert b.txt -o b.stl", &["nothing to write: planes and solids have no triangles"]);
    assert!(!folder.path("b.stl").exists());
}

#[test]
fn info_describes_the_file_and_not_what_render_adds() {
    let folder = TestFolder::new();
    folder.write("a.stl", STL);
    let text = folder.expect_exit(0, "info a.stl").out;
    assert!(text.contains("objects    1: 1 TriangleMesh") && text.contains("light      none in the file"), "{text}");
    let json: serde_json::Value = serde_json::from_str(&folder.expect_exit(0, "info a.stl --json").out).unwrap();
    assert_eq!((json["objects"].as_u64(), json["lights"].as_u64()), (Some(1), Some(0)));
    folder.write("a.xml", XML);
    let text = folder.expect_exit(0, "info a.xml").out;
    assert!(!text.contains("none in the file") && text.contains("cameras    "), "{text}");
    let sky = "Background { sunAltitude 30 sunAzimuth 135 } Lights { }";
    folder.write("sky.txt", COURSE.replace("Lights { DirectionalLight { direction 0 0 -1 color 1 1 1 } }", sky) + BALL);
    let text = folder.expect_exit(0, "info sky.txt").out;
    assert!(text.contains("sun        30.00 degrees above the horizon, 135.00 degrees clockwise"), "{text}");
}

#[test]
fn environment_lights_a_model() {
    let folder = TestFolder::new();
    folder.write("a.stl", STL);
    let view = "EquirectangularCamera { center 0 0 0 direction 0 0 -1 up 0 1 0 } Background { color 2 3 4 }";
    folder.write("sky.txt", format!("{view} Lights {{ }} Materials {{ PhongMaterial {{ diffuseColor 0 0 0 }} }} Group {{ MaterialIndex 0 Plane {{ normal 0 1 0 offset -1 }} }}"));
    folder.expect_exit(0, "render sky.txt -o sky.hdr --size 64x32 --samples 1 -q");
    let hash = |more: &str| folder.expect_exit(0, &format!("render a.stl -o a.png {SMALL} --hash -q {more}")).out;
    assert_ne!(hash("--environment sky.hdr"), hash(""));
    // The up axis determines the orientation of the environment.
    assert_ne!(hash("--environment sky.hdr --up y"), hash("--environment sky.hdr --up z"));
    // A whole turn changes nothing, and a half turn is the same for both axes.
    let turned = |degrees: u32, up: &str| {
        hash(&format!("--environment panorama.hdr --environment-rotation {degrees} --up {up}"))
    };
    folder.write("pano.txt", format!("{view} Lights {{ }} Materials {{ PhongMaterial {{ diffuseColor 0 0 0 }} }} Group {{ MaterialIndex 0 Sphere {{ center 3 0 0 radius 1 }} }}"));
    folder.expect_exit(0, "render pano.txt -o panorama.hdr --size 64x32 --samples 1 -q");
    for up in ["y", "z"] {
        assert_ne!(turned(90, up), turned(0, up), "{up}");
        assert_eq!(turned(0, up), hash(&format!("--environment panorama.hdr --up {up}")));
    }
    folder.expect_failure(2, "render a.stl -o a.png --environment-rotation 90", &["--environment"]);
    assert_ne!(hash("--environment sky.hdr --add-ground"), hash("--environment sky.hdr"));
    // A black environment is valid, but a note reports it.
    folder.write("black.pfm", b"PF\n1 1\n-1\n\0\0\0\0\0\0\0\0\0\0\0\0".as_slice());
    let dark =
        folder.expect_exit(0, &format!("render a.stl -o dark.pfm {SMALL} --environment black.pfm --integrator path"));
    assert!(dark.err.contains("is black: it emits no light"), "{}", dark.err);
    assert!(folder.bytes("dark.pfm").iter().rev().take(48).all(|&byte| byte == 0));
    folder.expect_failure(2, "render a.stl -o a.png --environment none.hdr", &["none.hdr"]);
    folder.expect_failure(2, "render a.stl -o a.png --environment scene.txt", &["scene.txt"]);
}

#[test]
fn json_scene_works_with_every_command() {
    let folder = TestFolder::new();
    folder.expect_exit(0, "convert scene.txt -o a.json");
    let hash = |name: &str| folder.expect_exit(0, &format!("render {name} -o a.png {SMALL} --hash -q")).out;
    assert_eq!(hash("a.json"), hash("scene.txt"));
    let output = |name: &str| folder.run(&format!("check {name}")).out.replace(name, "");
    assert_eq!(output("a.json").lines().count(), output("scene.txt").lines().count());
    assert!(folder.expect_exit(0, "info a.json").out.contains("Sphere"));
    folder.expect_exit(0, "explain a.json --pixel 256,256");
    let text = "{\"type\": \"Scene\",\n \"camera\": {\"type\": \"PerspectiveCamra\"}}";
    folder.write("b.json", text);
    folder.expect_failure(2, "render b.json -o b.png", &["b.json:2:21", "did you mean `PerspectiveCamera`?"]);
    // Files without an extension are recognised by their first bytes.
    folder.write("b", text);
    folder.expect_failure(2, "render b -o b.png", &["b:2:21"]);
}

#[test]
fn moved_camera_keeps_the_model_upright() {
    let folder = TestFolder::new();
    let corners = [[-1.0f32, -2.0, 0.0], [1.0, -2.0, 0.0], [0.0, 2.0, 0.0]];
    let bytes: Vec<u8> = corners.iter().flatten().flat_map(|x| x.to_le_bytes()).collect();
    use base64::Engine as _;
    let data = base64::engine::general_purpose::STANDARD.encode(bytes);
    // The file's own camera is rolled by 90 degrees.
    folder.write(
        "rolled.gltf",
        format!(
            r#"{{"asset":{{"version":"2.0"}},"scene":0,"scenes":[{{"nodes":[0,1]}}],
        "nodes":[{{"mesh":0}},{{"camera":0,"translation":[0,0,9],"rotation":[0,0,0.70710678,0.70710678]}}],
        "cameras":[{{"type":"perspective","perspective":{{"yfov":0.6,"znear":0.1}}}}],
        "meshes":[{{"primitives":[{{"attributes":{{"POSITION":0}}}}]}}],
        "accessors":[{{"bufferView":0,"componentType":5126,"count":3,"type":"VEC3","min":[-1,-2,0],"max":[1,2,0]}}],
        "bufferViews":[{{"buffer":0,"byteLength":36}}],
        "buffers":[{{"byteLength":36,"uri":"data:application/octet-stream;base64,{data}"}}]}}"#
        ),
    );
    // The triangle is taller than wide.
    let sides = |options: &str| {
        folder
            .expect_exit(0, &format!("render rolled.gltf --size 40x40 --studio none --show depth -o d.pfm {options}"));
        let image = folder.image("d.pfm");
        let hit = |x: u32, y: u32| image.pixels[(y * 40 + x) as usize].x > 0.0;
        let columns = (0..40).filter(|&x| (0..40).any(|y| hit(x, y))).count();
        let rows = (0..40).filter(|&y| (0..40).any(|x| hit(x, y))).count();
        (columns, rows)
    };
    let (columns, rows) = sides("");
    assert!(columns > rows, "{columns} {rows}");
    let (columns, rows) = sides("--eye 0,0,9");
    assert!(columns < rows, "{columns} {rows}");
}
