//! Tests of the USD reader: composition, geometry, materials, lights and hostile input. The files
//! in `fuzz/seeds/usd` were written by OpenUSD 26.11.

use crate::testing::{folder, read_in};
use durer_scene::camera::Camera;
use durer_scene::light::Light;
use durer_scene::material::PrincipledMaterial;
use durer_scene::math::Vec3;
use durer_scene::scene::{Axis, Group, Material, MatrixOp, MatrixRules, Object, ObjectKind, Scene};
use durer_scene::shape::Primitive;
use glam::{DAffine3, DVec3};
use std::path::Path;

fn read(text: &str) -> (Option<Scene>, Vec<String>) {
    let folder = tempfile::tempdir().unwrap();
    read_in(folder.path(), "a.usda", format!("#usda 1.0\n{text}"))
}

fn sound(text: &str) -> Scene {
    let (scene, messages) = read(text);
    assert_eq!(messages, [""; 0]);
    scene.unwrap()
}

fn materials(scene: &Scene) -> Vec<&PrincipledMaterial> {
    let materials = scene.materials.iter().filter_map(|material| match &material.value {
        Material::Principled(material) => Some(&**material),
        _ => None,
    });
    materials.collect()
}

/// Returns the leaves of the scene, each with its transform to world space, without the ground that
/// is added to models.
fn leaves(scene: &Scene) -> Vec<(DAffine3, Object)> {
    fn visit(object: &Object, map: DAffine3, found: &mut Vec<(DAffine3, Object)>) {
        match &object.node {
            ObjectKind::Group(group) => group.objects.iter().for_each(|object| visit(object, map, found)),
            ObjectKind::Transform(ops, inner) => {
                visit(inner, map * MatrixOp::product(ops, MatrixRules::default()), found);
            }
            ObjectKind::Primitive(Primitive::Plane(_)) => {}
            _ => found.push((map, object.clone())),
        }
    }
    let mut found = Vec::new();
    let Some(Group { objects }) = &scene.root else { return found };
    objects.iter().for_each(|object| visit(object, DAffine3::IDENTITY, &mut found));
    found
}

/// Returns the positions of the origins of all leaves in world space.
fn origins(scene: &Scene) -> Vec<DVec3> {
    leaves(scene).iter().map(|(map, _)| map.translation).collect()
}

fn ball(name: &str, rest: &str) -> String {
    format!("def Sphere \"{name}\" {{ double radius = 1 {rest} }}\n")
}

#[test]
fn operations_of_transforms_apply_from_the_last_to_the_first() {
    let scene = sound(&ball(
        "A",
        "double3 xformOp:translate = (1, 2, 3)
         float3 xformOp:rotateXYZ = (90, 0, 90)
         float3 xformOp:scale = (2, 1, 1)
         uniform token[] xformOpOrder = [\"xformOp:translate\", \"xformOp:rotateXYZ\", \"xformOp:scale\"]",
    ));
    let map = leaves(&scene)[0].0;
    // x is doubled, stays under the turn about x, and becomes y.
    assert!((map.transform_point3(DVec3::X) - DVec3::new(1.0, 4.0, 3.0)).length() < 1e-6);
    // z becomes -y, and then x.
    assert!((map.transform_vector3(DVec3::Z) - DVec3::X).length() < 1e-6);
    let scene = sound(&ball(
        "A",
        "matrix4d xformOp:transform = ((1,0,0,0), (0,1,0,0), (0,0,1,0), (5,6,7,1))
         double3 xformOp:translate:pivot = (1, 1, 1)
         uniform token[] xformOpOrder = [\"xformOp:transform\", \"!invert!xformOp:translate:pivot\"]",
    ));
    assert_eq!(origins(&scene), [DVec3::new(4.0, 5.0, 6.0)]);
}

#[test]
fn stronger_layers_override_and_lists_are_edited() {
    let asset = "#usda 1.0
        ( defaultPrim = \"Model\" )
        def Xform \"Model\" (
            variants = { string size = \"small\" }
            prepend variantSets = \"size\"
            inherits = </_base>
        ) {
            def Sphere \"Ball\" { double radius = 1 }
            variantSet \"size\" = {
                \"small\" { over \"Ball\" { double radius = 7 } def Cube \"Extra\" {} }
                \"large\" { over \"Ball\" { double radius = 9 } }
            }
        }
        class \"_base\" { def Sphere \"Base\" { double radius = 3 } over \"Ball\" { double radius = 4 } }";
    let radii = |scene: &Scene| -> Vec<f32> {
        let radius = |object: &Object| match &object.node {
            ObjectKind::Primitive(Primitive::Sphere(sphere)) => Some(sphere.radius),
            _ => None,
        };
        let mut radii: Vec<f32> = leaves(scene).iter().filter_map(|(_, object)| radius(object)).collect();
        radii.sort_by(f32::total_cmp);
        radii
    };
    let read = |root: &str| {
        let folder = folder(&[
            ("parts/asset.usda", asset.as_bytes()),
            ("sub.usda", b"#usda 1.0\nover \"A\" { over \"Ball\" { double radius = 5 } }"),
        ]);
        let (scene, messages) = read_in(folder.path(), "a.usda", format!("#usda 1.0\n{root}"));
        assert_eq!(messages, [""; 0]);
        scene.unwrap()
    };
    // Local opinions of the asset are stronger than its class and its variants.
    let scene = read("def \"A\" ( references = @parts/asset.usda@ ) {}");
    assert_eq!((radii(&scene), leaves(&scene).len()), (vec![1.0, 3.0], 3));
    // A sublayer of the root is stronger than the reference.
    let scene = read("( subLayers = [@sub.usda@] )\ndef \"A\" ( references = @parts/asset.usda@ ) {}");
    assert_eq!(radii(&scene), [3.0, 5.0]);
    // A selection in the root is stronger than that in the asset.
    let scene = read("def \"A\" ( variants = { string size = \"large\" } payload = @./parts/asset.usda@</Model> ) {}");
    assert_eq!((radii(&scene), leaves(&scene).len()), (vec![1.0, 3.0], 2));
    // An internal reference, and an inactive child.
    let scene = read(
        "def \"A\" ( references = </B> ) { over \"Base\" ( active = false ) {} }\ndef \"B\" ( references = @parts/asset.usda@ ) {}",
    );
    assert_eq!(radii(&scene), [1.0, 1.0, 3.0]);
}

/// Lists of references are edited by stronger layers, which name the files relative to their own
/// folder.
#[test]
fn stronger_layers_edit_lists_of_references() {
    let part = |x: f64| {
        format!(
            "#usda 1.0\n( defaultPrim = \"R\" )\ndef Xform \"R\" {{ def Sphere \"S{x}\" {{ double3 xformOp:translate = ({x}, 0, 0)
             uniform token[] xformOpOrder = [\"xformOp:translate\"] }} }}"
        )
    };
    let sublayer = b"#usda 1.0\ndef Xform \"A\" ( prepend references = [@../r1.usda@, @../r2.usda@] ) {}";
    let folder = folder(&[
        ("r1.usda", part(1.0).as_bytes()),
        ("r2.usda", part(2.0).as_bytes()),
        ("r3.usda", part(3.0).as_bytes()),
        ("sub/s.usda", sublayer),
    ]);
    for (edit, expected) in [
        ("", vec![1.0, 2.0]),
        ("delete references = @r1.usda@", vec![2.0]),
        ("delete references = @r1.usda@ prepend references = @./r3.usda@", vec![2.0, 3.0]),
        ("references = [@r3.usda@]", vec![3.0]),
        ("references = None", vec![]),
    ] {
        let root =
            format!("#usda 1.0\n( subLayers = [@sub/s.usda@] )\nover \"A\" ( {edit} ) {{}}\ndef Sphere \"Other\" {{}}");
        let scene = read_in(folder.path(), "a.usda", root).0.unwrap();
        let mut places: Vec<f64> = origins(&scene).iter().map(|origin| origin.x).filter(|x| *x > 0.0).collect();
        places.sort_by(f64::total_cmp);
        assert_eq!(places, expected, "{edit}");
    }
}

/// Constant display colours are inherited. Caps of cylinders emit no light, and the pole of a dome
/// follows the scene's up axis.
#[test]
fn colors_are_inherited_and_lights_follow_their_schema() {
    let scene = sound(
        "def Xform \"X\" {
            color3f[] primvars:displayColor = [(1, 0, 0)] ( interpolation = \"constant\" )
            def Sphere \"Red\" {}
            def Sphere \"Blue\" { color3f[] primvars:displayColor = [(0, 0, 1)] }
        }",
    );
    let colors: Vec<Vec3> = materials(&scene).iter().map(|material| material.base_color).take(2).collect();
    assert_eq!(colors, [Vec3::X, Vec3::Z]);
    let scene = sound("def CylinderLight \"Tube\" { float inputs:intensity = 5 }");
    let shapes: Vec<&str> = leaves(&scene)
        .iter()
        .map(|(_, object)| match &object.node {
            ObjectKind::Primitive(Primitive::Cylinder(_)) => "cylinder",
            ObjectKind::Primitive(Primitive::Disc(_)) => "disc",
            _ => "other",
        })
        .collect();
    assert_eq!(shapes, ["cylinder", "disc", "disc"]);
    assert_eq!(materials(&scene)[1].emission_color, Vec3::ZERO);
    // In a scene with z up, the picture of a dome is turned, so it is resampled.
    let folder = folder(&[("sky.ppm", b"P6 2 1 255 \xff\xff\xff\0\0\0")]);
    for (up, kind, pole, is_turned) in [
        ("Z", "DomeLight_1", "", true),
        ("Z", "DomeLight_1", "uniform token poleAxis = \"Y\"", false),
        ("Y", "DomeLight_1", "uniform token poleAxis = \"Z\"", true),
        ("Y", "DomeLight_1", "", false),
        ("Z", "DomeLight", "", false),
    ] {
        let text = format!(
            "#usda 1.0\n( upAxis = \"{up}\" )\ndef {kind} \"Sky\" {{ asset inputs:texture:file = @sky.ppm@ {pole} }}\ndef Sphere \"S\" {{}}"
        );
        let (scene, messages) = read_in(folder.path(), "a.usda", text);
        assert_eq!(messages, [""; 0]);
        let path = scene.unwrap().background.environment.unwrap().path;
        assert_eq!(path.contains('#'), is_turned, "{up} {kind} {pole}: {path}");
    }
}

#[test]
fn bindings_follow_references_and_subsets() {
    let asset = b"#usda 1.0
        ( defaultPrim = \"M\" )
        def \"M\" {
            def Mesh \"Quads\" ( prepend apiSchemas = [\"MaterialBindingAPI\"] ) {
                rel material:binding = </M/Red>
                uniform token subdivisionScheme = \"none\"
                point3f[] points = [(0,0,0), (1,0,0), (1,1,0), (0,1,0), (2,0,0), (2,1,0)]
                int[] faceVertexCounts = [4, 4]
                int[] faceVertexIndices = [0, 1, 2, 3, 1, 4, 5, 2]
                def GeomSubset \"Right\" { int[] indices = [1] rel material:binding = <../../Green> }
            }
            def Material \"Red\" {
                token outputs:surface.connect = </M/Red/S.outputs:surface>
                def Shader \"S\" { uniform token info:id = \"UsdPreviewSurface\" color3f inputs:diffuseColor = (1, 0, 0) }
            }
            def Material \"Green\" {
                color3f inputs:tint = (0, 1, 0)
                token outputs:surface.connect = </M/Green/S.outputs:surface>
                def Shader \"S\" {
                    uniform token info:id = \"UsdPreviewSurface\"
                    color3f inputs:diffuseColor.connect = </M/Green.inputs:tint>
                    float inputs:metallic = 1
                }
            }
        }";
    let folder = folder(&[("m.usda", asset)]);
    let (scene, messages) = read_in(folder.path(), "a.usda", "#usda 1.0\ndef \"X\" ( references = @m.usda@ ) {}");
    assert_eq!(messages, [""; 0]);
    let scene = scene.unwrap();
    let colors: Vec<Vec3> = materials(&scene).iter().map(|material| material.base_color).collect();
    assert_eq!(colors[..2], [Vec3::Y, Vec3::X]);
    assert_eq!(materials(&scene)[0].base_metalness, 1.0);
    let counts: Vec<usize> = scene.assets.meshes.values().map(|mesh| mesh.triangles.len()).collect();
    assert_eq!(counts, [2, 2]);
}

#[test]
fn textures_keep_their_mapping() {
    let (scene, messages) = read(
        "def Mesh \"Quad\" {
            rel material:binding = </M>
            uniform token subdivisionScheme = \"none\"
            point3f[] points = [(0,0,0), (1,0,0), (1,1,0), (0,1,0)]
            int[] faceVertexCounts = [4]
            int[] faceVertexIndices = [0, 1, 2, 3]
            texCoord2f[] primvars:map1 = [(0, 0), (1, 0), (1, 1)] ( interpolation = \"faceVarying\" )
            int[] primvars:map1:indices = [0, 1, 2, 0]
        }
        def Material \"M\" {
            token outputs:surface.connect = </M/S.outputs:surface>
            def Shader \"S\" {
                uniform token info:id = \"UsdPreviewSurface\"
                color3f inputs:diffuseColor.connect = </M/T.outputs:rgb>
                float inputs:roughness.connect = </M/T.outputs:g>
                float inputs:opacity.connect = </M/T.outputs:a>
                float inputs:opacityThreshold = 0.4
            }
            def Shader \"T\" {
                uniform token info:id = \"UsdUVTexture\"
                asset inputs:file = @a.png@
                float4 inputs:scale = (0.5, 0.25, 1, 1)
                float4 inputs:bias = (0, 0.1, 0, 0)
                token inputs:wrapS = \"mirror\"
                float2 inputs:st.connect = </M/R.outputs:result>
            }
            def Shader \"R\" { uniform token info:id = \"UsdPrimvarReader_float2\" string inputs:varname = \"map1\" }
        }",
    );
    let scene = scene.unwrap();
    assert!(messages.len() == 1 && messages[0].contains("the `bias` of a colour texture"), "{messages:?}");
    let material = materials(&scene)[0];
    assert_eq!((material.base_color, material.opacity_cutoff), (Vec3::new(0.5, 0.25, 1.0), Some(0.4)));
    let name = material.specular_roughness_texture.as_ref().unwrap();
    let mapping = scene.assets.pictures[&name.path].mapping;
    assert_eq!((mapping.range, format!("{:?}", mapping.channel)), ([0.1, 0.35], "Some(Green)".into()));
    let mesh = scene.assets.meshes.values().next().unwrap();
    assert_eq!((mesh.uvs.len(), &mesh.triangle_uvs[..]), (3, &[[0, 1, 2], [0, 2, 0]][..]));
}

#[test]
fn lights_have_their_units() {
    let scene = sound(
        "def SphereLight \"Point\" { float inputs:radius = 0.1 float inputs:intensity = 100 bool treatAsPoint = 1 }
         def DistantLight \"Sun\" { float inputs:intensity = 3.14159265 float inputs:angle = 0 }
         def RectLight \"Panel\" { float inputs:width = 2 float inputs:height = 3 float inputs:intensity = 12
             float inputs:exposure = 1 bool inputs:normalize = 1 }",
    );
    let lights: Vec<&Light> = scene.lights.iter().flatten().map(|light| &light.value).collect();
    let [Light::Point(point), Light::Directional(sun)] = lights[..] else { panic!("{lights:?}") };
    // The intensity is the luminance times the area of the disc, and the colour a part of pi of it.
    assert!((point.color.x - 100.0 * 0.01).abs() < 1e-5, "{point:?}");
    assert!((sun.color.x - 1.0).abs() < 1e-6 && sun.spread.is_none(), "{sun:?}");
    assert_eq!(materials(&scene)[0].emission_color, Vec3::splat(4.0));
    let scene = sound(
        "def DomeLight \"Sky\" { float inputs:intensity = 2 color3f inputs:color = (1, 0.5, 0.25) } def Sphere \"S\" {}",
    );
    assert_eq!(scene.background.color, Vec3::new(2.0, 1.0, 0.5));
}

#[test]
fn point_instancers_copy_their_prototypes() {
    let scene = sound(
        "def PointInstancer \"Trees\" {
            rel prototypes = [</Trees/Tall>, </Trees/Wide>]
            int[] protoIndices = [0, 1, 0]
            point3f[] positions = [(1, 0, 0), (2, 0, 0), (3, 0, 0)]
            int64[] ids = [10, 11, 12]
            int64[] invisibleIds = [12]
            def Cone \"Tall\" {}
            def \"Wide\" { def Cube \"A\" {} def Sphere \"B\" {} }
        }",
    );
    assert_eq!(origins(&scene).iter().map(|origin| origin.x).collect::<Vec<_>>(), [1.0, 2.0, 2.0]);
}

#[test]
fn instances_share_meshes() {
    let mesh = "def Mesh \"M\" {
        uniform token subdivisionScheme = \"none\"
        point3f[] points = [(0,0,0), (1,0,0), (0,1,0)]
        int[] faceVertexCounts = [3]
        int[] faceVertexIndices = [0, 1, 2]
    }";
    let scene = sound(&format!(
        "class \"Asset\" {{ {mesh} }}
         def \"A\" ( references = </Asset> instanceable = true ) {{}}
         def \"B\" ( references = </Asset> instanceable = true ) {{}}"
    ));
    assert_eq!((leaves(&scene).len(), scene.assets.meshes.len()), (2, 1));
}

#[test]
fn subdivision_rounds_a_cube() {
    let cube = |scheme: &str| {
        format!(
            "def Mesh \"Cube\" {{
                {scheme}
                point3f[] points = [(-1,-1,-1), (1,-1,-1), (-1,1,-1), (1,1,-1), (-1,-1,1), (1,-1,1), (-1,1,1), (1,1,1)]
                int[] faceVertexCounts = [4, 4, 4, 4, 4, 4]
                int[] faceVertexIndices = [0,2,3,1, 4,5,7,6, 0,1,5,4, 2,6,7,3, 0,4,6,2, 1,3,7,5]
            }}"
        )
    };
    let farthest = |scene: &Scene| {
        let mesh = scene.assets.meshes.values().next().unwrap();
        let used = mesh.triangles.iter().flatten().map(|corner| mesh.positions[*corner as usize].length());
        used.fold(0.0, f32::max)
    };
    assert!((farthest(&sound(&cube("uniform token subdivisionScheme = \"none\""))) - 3.0_f32.sqrt()).abs() < 1e-6);
    let round = sound(&cube(""));
    assert!((0.8..1.0).contains(&farthest(&round)), "{}", farthest(&round));
    assert_eq!(round.assets.meshes.values().next().unwrap().triangles.len(), 6 * 4_usize.pow(3) * 2);
}

#[test]
fn seeds_of_the_official_library_agree() {
    let seeds = Path::new(env!("CARGO_MANIFEST_DIR")).join("../../fuzz/seeds/usd");
    // A published package contains no seeds.
    if !seeds.exists() {
        return;
    }
    let scenes = ["cornell.usda", "cornell.usdc", "cornell.usdz"].map(|name| {
        let (scene, messages) = read_in(&seeds, name, std::fs::read(seeds.join(name)).unwrap());
        assert_eq!(messages, [""; 0], "{name}");
        let scene = scene.unwrap();
        assert!(matches!(scene.camera, Some(Camera::Perspective(_))));
        let all = leaves(&scene);
        let shapes: Vec<String> = all.iter().map(|(map, object)| format!("{map:?} {:?}", object.material)).collect();
        let meshes: Vec<_> = scene.assets.meshes.values().cloned().collect();
        (shapes, meshes, scene.materials.iter().map(|material| material.value.clone()).collect::<Vec<_>>())
    });
    assert_eq!(scenes[0].0.len(), 8);
    assert!(scenes[0] == scenes[1] && scenes[0] == scenes[2]);
}

#[test]
fn meshes_follow_their_joints() {
    let scene = sound(
        "def SkelRoot \"Root\" {
            rel skel:skeleton = </Root/Bones>
            def Skeleton \"Bones\" {
                uniform token[] joints = [\"a\", \"a/b\"]
                uniform matrix4d[] bindTransforms = [((1,0,0,0),(0,1,0,0),(0,0,1,0),(0,0,0,1)), ((1,0,0,0),(0,1,0,0),(0,0,1,0),(1,0,0,1))]
                uniform matrix4d[] restTransforms = [((1,0,0,0),(0,1,0,0),(0,0,1,0),(0,0,0,1)), ((1,0,0,0),(0,1,0,0),(0,0,1,0),(1,0,0,1))]
                rel skel:animationSource = </Root/Turn>
            }
            def SkelAnimation \"Turn\" {
                uniform token[] joints = [\"a/b\"]
                float3[] translations = [(1, 0, 0)]
                quatf[] rotations = [(0.70710678, 0, 0, 0.70710678)]
                half3[] scales = [(1, 1, 1)]
            }
            def Mesh \"M\" {
                uniform token subdivisionScheme = \"none\"
                point3f[] points = [(0,0,0), (2,0,0), (0,0,2)]
                int[] faceVertexCounts = [3]
                int[] faceVertexIndices = [0, 1, 2]
                int[] primvars:skel:jointIndices = [0, 1, 0, 1, 0, 1] ( elementSize = 2 interpolation = \"vertex\" )
                float[] primvars:skel:jointWeights = [1, 0, 0, 1, 0.5, 0.5] ( elementSize = 2 interpolation = \"vertex\" )
            }
        }",
    );
    let mesh = scene.assets.meshes.values().next().unwrap();
    // The turn about (1, 0, 0) moves (2, 0, 0) to (1, 1, 0), and (0, 0, 2) half of the way to
    // (1, -1, 2).
    let expected = [Vec3::ZERO, Vec3::new(1.0, 1.0, 0.0), Vec3::new(0.5, -0.5, 2.0)];
    let close = |(a, b): (&Vec3, &Vec3)| (*a - *b).length() < 1e-6;
    assert!(mesh.positions.iter().zip(&expected).all(close), "{:?}", mesh.positions);
}

#[test]
fn up_axis_and_time_are_heeded() {
    let text = "( upAxis = \"Z\" startTimeCode = 1 timeCodesPerSecond = 24 )
        def Sphere \"A\" {
            double3 xformOp:translate.timeSamples = { 1: (0, 0, 0), 25: (24, 0, 0), }
            uniform token[] xformOpOrder = [\"xformOp:translate\"]
        }";
    let scene = sound(text);
    assert_eq!((scene.up, origins(&scene)), (Some(Axis::Z), vec![DVec3::ZERO]));
}

#[test]
fn errors_name_their_place() {
    let error = |text: &str| read(text).1.join("\n");
    assert_eq!(error("def Sphere \"A\" { double radius = }"), "a.usda:2:34 error expected a value, found `}`");
    assert_eq!(
        error("def Sphere \"A\" {"),
        "a.usda:2:17 error expected `def`, `over` or `class`, found the end of the file"
    );
    assert!(
        error("def \"A\" ( references = @gone.usda@ ) {}").starts_with("a.usda:2:1 error the layer cannot be read: ")
    );
    assert!(error("def \"A\" ( references = </A> ) {}").contains("`/A` refers to itself"));
    assert!(
        error("def \"A\" ( references = </B> ) {}\ndef \"B\" ( references = </A> ) {}").contains("refers to itself")
    );
    assert!(error("( subLayers = [@a.usda@] )").contains("`a.usda` is a sublayer of itself"));
    let message = error(
        "def Mesh \"M\" { point3f[] points = [(0,0,0)] int[] faceVertexCounts = [3] int[] faceVertexIndices = [0, 1, 2] }",
    );
    assert!(
        message.contains("the mesh `M` is left out: index 1 is out of range, because it has 1 points"),
        "{message}"
    );
    assert!(error("def \"A\" { string a = \"x").contains("a `\"` is missing"));
}

#[test]
fn references_cannot_multiply_without_limit() {
    // Each level refers to the level before it twice.
    let mut text = String::from("def \"L0\" { def Sphere \"S\" {} }\n");
    for level in 1..40 {
        let before = level - 1;
        text += &format!(
            "def \"L{level}\" {{ def \"A\" ( references = </L{before}> ) {{}} def \"B\" ( references = </L{before}> ) {{}} }}\n"
        );
    }
    let messages = read(&text).1.join("\n");
    assert!(messages.contains("error"), "{messages}");
}
