//! Tests path tracing on the command line: pictures, photometry, exposure, and checks.

use crate::common::TestFolder;

/// A diffuse floor and an emissive ball below a light with measured intensities.
const LIT: &str = "PerspectiveCamera { center 0 2 6 direction 0 -0.3 -1 up 0 1 0 angle 40 }
Background { color 0 0 0 }
Lights { PhotometricLight { position 0 2 0 file lamp.ies } }
Materials { PrincipledMaterial { baseColor 0.5 0.5 0.5 specularWeight 0 }
  PrincipledMaterial { preset gold specularRoughness 0.4 } PrincipledMaterial { baseColor 0 0 0 emissionLuminance 20 } }
Group { MaterialIndex 0 Plane { normal 0 1 0 offset 0 } MaterialIndex 1 Sphere { center 1 0.5 0 radius 0.5 }
  MaterialIndex 2 Sphere { center -1 0.3 0.5 radius 0.3 } }
";

/// An IES profile with 1000 candela straight down, which falls off with the cosine.
const LIGHT: &str = "IESNA:LM-63-1995\nTILT=NONE\n1 -1 1 4 1 1 2 0 0 0\n1 1 60\n0 30 60 90\n0\n1000 866.025 500 0\n";

fn lit() -> TestFolder {
    let folder = TestFolder::new();
    folder.write("lit.txt", LIT);
    folder.write("lamp.ies", LIGHT);
    folder
}

#[test]
fn photometric_light_has_its_specified_illuminance() {
    let folder = lit();
    folder.write("open.txt", LIT.replace("emissionLuminance 20", ""));
    // For a point beside the ball, E = I cos / d^2 with I = 1000 cos.
    let output =
        folder.expect_exit(0, "measure open.txt --at 0,0,0 --grid 0,0,0:-1,0,0:0,0,1:1x1 --samples 64 --bounces 0");
    let rows: Vec<Vec<f64>> =
        output.out.lines().skip(1).map(|row| row.split(',').map(|word| word.parse().unwrap()).collect()).collect();
    assert!(output.out.starts_with("x,y,z,nx,ny,nz,illuminance,illuminance_error,"));
    assert!((rows[0][6] - 250.0).abs() < 0.1, "{rows:?}");
    // The point is at (-0.5, 0, 0.5), which is 19.4712 degrees away from straight down. Candela
    // values are interpolated linearly between 0 and 30 degrees.
    let candela = 1000.0 - (1000.0 - 866.025) * 19.4712 / 30.0;
    let expected = candela * (4.0_f64 / 4.5).sqrt() / 4.5;
    assert!((rows[1][6] / expected - 1.0).abs() < 1e-4 && rows[1][4] == 1.0, "{rows:?}");
    assert!(folder.expect_exit(2, "measure open.txt").err.contains("--at X,Y,Z or --grid"));
    assert!(folder.expect_exit(2, "measure open.txt --at 0,0").err.contains("three numbers"));
    assert!(folder.expect_exit(2, "measure open.txt --at 0,0,0 --normal 0,0,0").err.contains("--normal"));
}

/// Measures a square two units below a light of 1000 cd, whose intensity falls with the cosine:
/// E = I cos^4 / h^2.
#[test]
fn grids_have_figures_lists_plans_and_error_targets() {
    let folder = lit();
    folder.write("open.txt", LIT.replace("emissionLuminance 20", ""));
    let grid = "measure open.txt --bounces 0 --samples 16 --grid -2,0,-2:4,0,0:0,0,4:9x9";
    let output = folder.expect_exit(0, &format!("{grid} --plan desk.svg"));
    let values: Vec<f64> =
        output.out.lines().skip(1).map(|row| row.split(',').nth(6).unwrap().parse().unwrap()).collect();
    assert_eq!(values.len(), 81);
    // The cell in the middle lies straight below the light.
    assert!((values[40] - 250.0).abs() < 0.1, "{}", values[40]);
    let (min, sum) = (values.iter().copied().fold(f64::INFINITY, f64::min), values.iter().sum::<f64>());
    let figures = format!("U0 {:.3}, U1 {:.3}", min / (sum / 81.0), min / 250.0);
    assert!(
        output.err.contains("note: grid 1: average ") && output.err.contains(&figures),
        "{figures}: {}",
        output.err
    );
    assert!(output.err.contains("wrote desk.svg"));
    let plan = std::fs::read_to_string(folder.path("desk.svg")).unwrap();
    assert!(plan.starts_with("<svg") && plan.matches("<rect").count() > 81 && plan.contains("stroke=\"#fff\""));
    for text in [">lux</text>", ">x</text>", ">z</text>", ">-2</text>", ">1</text>"] {
        assert!(plan.contains(text), "{text} is not in {plan}");
    }
    let json = folder.expect_exit(0, &format!("{grid} --json --at 0,0,0"));
    let json: serde_json::Value = serde_json::from_str(&json.out).unwrap();
    assert_eq!(json["points"].as_array().unwrap().len(), 82);
    assert!((json["grids"][0]["u0"].as_f64().unwrap() - min / (sum / 81.0)).abs() < 1e-4);

    folder.write("places.csv", "x,y,z\n0,0,0\n-0.5,0,0.5,0,2,0\n");
    let rows = folder.expect_exit(0, "measure open.txt --bounces 0 --samples 16 --points places.csv").out;
    assert!(
        rows.lines().nth(1).unwrap().starts_with("0,0,0,0,1,0,249.9") || rows.contains("0,0,0,0,1,0,250.0"),
        "{rows}"
    );
    folder.write("broken.csv", "0,0,0\n1,2\n");
    folder.expect_failure(2, "measure open.txt --points broken.csv", &["broken.csv:2:1", "x,y,z"]);
    folder.expect_failure(2, "measure open.txt --points none.csv", &["none.csv"]);
    folder.expect_failure(2, "measure open.txt --at 0,0,0 --plan desk.svg", &["--grid"]);
    folder.expect_failure(2, &format!("{grid} --plan desk.png"), &["must end in .svg"]);

    // The emissive ball is an area light, so its illuminance has noise.
    for target in ["5%", "0.01"] {
        let measure = format!("measure lit.txt --at 0,0,1.5 --at 2,0,1 --error {target} --json");
        let json: serde_json::Value = serde_json::from_str(&folder.expect_exit(0, &measure).out).unwrap();
        for point in json["points"].as_array().unwrap() {
            let number = |name: &str| point[name].as_f64().unwrap();
            let share = if target == "5%" { 0.05 } else { 0.01 };
            assert!(number("illuminance_error") <= share * number("illuminance"), "{point}");
            assert!(number("samples") >= 256.0 && number("samples") < 1048576.0, "{point}");
        }
    }
    folder.expect_failure(2, "measure lit.txt --at 0,0,0 --error 0", &["a share such as 1% or 0.01"]);
}

/// A light of 900 cd at a distance d gives 900 / d^2 on a plane that faces it. A cylinder receives
/// sin(angle to its axis) / pi of that, and a sphere a quarter.
#[test]
fn cylindrical_and_spherical_illuminance_have_closed_forms() {
    let folder = TestFolder::new();
    folder.write(
        "light.txt",
        "Background { color 0 0 0 } Lights { PointLight { position 1 3 2 candela 900 } }
Materials { PrincipledMaterial { baseColor 0 0 0 specularWeight 0 } }
Group { MaterialIndex 0 Rectangle { corner -9 0 -9 edge0 0 0 18 edge1 18 0 0 } }",
    );
    // The light is at (1, 1.8, 2), seen from the point.
    let square: f64 = 1.0 + 1.8 * 1.8 + 4.0;
    let facing = 900.0 / square;
    let sin = |along: f64| (1.0 - along * along / square).sqrt();
    let pi = std::f64::consts::PI;
    for (kind, share) in [
        ("planar", 1.8 / square.sqrt()),
        ("cylindrical", sin(1.8) / pi),
        ("spherical", 0.25),
        ("cylindrical --normal 1,0,0", sin(1.0) / pi),
    ] {
        let measure = format!("measure light.txt --at 0,1.2,0 --samples 16384 --json --illuminance {kind}");
        let json: serde_json::Value = serde_json::from_str(&folder.expect_exit(0, &measure).out).unwrap();
        let found = json["points"][0]["illuminance"].as_f64().unwrap();
        assert!((found / (facing * share) - 1.0).abs() < 1e-3, "{kind}: {found} instead of {}", facing * share);
    }
    let grid = "measure light.txt --samples 256 --grid -2,1.2,-2:4,0,0:0,0,4:9x9 --illuminance cylindrical";
    let output = folder.expect_exit(0, &format!("{grid} --plan faces.svg --levels 20,12.5"));
    assert!(output.err.contains("note: grid 1: cylindrical illuminance: average"), "{}", output.err);
    let plan = std::fs::read_to_string(folder.path("faces.svg")).unwrap();
    assert_eq!(plan.matches("stroke-width=\"1.2\"").count(), 2, "{plan}");
    assert!(plan.contains(">12.5</text>") && plan.contains("cylindrical illuminance: average"), "{plan}");
    for (options, message) in [
        ("--at 0,1,0 --illuminance round", "cylindrical"),
        ("--at 0,0,0 --illuminance cylindrical --integrator photons", "needs --integrator path"),
        ("--grid 0,0,0:1,0,0:0,0,1:2x2 --plan p.svg --levels 100,-3", "100,300,500"),
        ("--at 0,0,0 --levels 100", "--plan"),
    ] {
        folder.expect_failure(2, &format!("measure light.txt {options}"), &[message]);
    }
}

/// Grid points inside the ball are not part of the figures. In a closed room with a light, all
/// points are inside the walls but receive light.
#[test]
fn points_inside_objects_are_left_out_of_the_figures() {
    let folder = lit();
    let measure = "measure lit.txt --samples 64 --grid 0,0.5,0:3,0,0:0,0,0.2:4x1";
    // The cells are 0.75 wide, and the ball with the radius 0.5 is around (1, 0.5, 0).
    let output = folder.expect_exit(0, &format!("{measure} --plan p.svg"));
    assert!(output.err.contains("3 of 4 points; 1 inside an object"), "{}", output.err);
    assert!(output.err.contains("1 of 4 points is inside an object"), "{}", output.err);
    let plan = std::fs::read_to_string(folder.path("p.svg")).unwrap();
    assert_eq!(plan.matches("fill=\"#bbb\"").count(), 1, "{plan}");
    let json = folder.expect_exit(0, &format!("{measure} --json")).out;
    let json: serde_json::Value = serde_json::from_str(&json).unwrap();
    let grid = &json["grids"][0];
    assert_eq!((&grid["inside"], &grid["values"][1]), (&1.into(), &serde_json::Value::Null), "{json}");
    assert!(grid["minimum"].as_f64().unwrap() > 1.0 && json["points"][1]["inside"] == true, "{json}");
    assert_eq!(json["units"]["irradiance"], "lux");
    folder.write(
        "room.txt",
        "PerspectiveCamera { center 0 1 9 direction 0 0 -1 up 0 1 0 angle 40 } Background { color 0 0 0 }
Lights { PointLight { position 0 2 0 color 1 1 1 candela 100 } } Materials { PrincipledMaterial { baseColor 0.5 0.5 0.5 } }
Group { MaterialIndex 0 Box { min -2 0 -2 max 2 3 2 } }",
    );
    let output = folder.expect_exit(0, "measure room.txt --samples 16 --grid -1,1,-1:2,0,0:0,0,2:2x2");
    assert!(output.err.contains("minimum") && !output.err.contains("inside"), "{}", output.err);
    folder.expect_failure(2, "measure room.txt --at 0,1,0 --eye 0,0,9", &["--eye", "does not change what is measured"]);
    folder.expect_failure(2, "measure room.txt --at 0,1,0 --size 9x9", &["option of `durer render`"]);
}

/// Follows the recipe for daylight factors in docs/light.md.
#[test]
fn daylight_factor_of_the_manual() {
    let page = include_str!("../../../../docs/light.md");
    let recipe = page.split("### Daylight factor").nth(1).unwrap();
    let scene: String = recipe
        .lines()
        .skip_while(|line| !line.starts_with("    "))
        .take_while(|line| line.starts_with("    "))
        .map(|line| format!("{}\n", &line[4..]))
        .collect();
    let command = recipe.split("`durer ").nth(1).unwrap().split('`').next().unwrap();
    let folder = TestFolder::new();
    folder.write("room.txt", scene);
    let output = folder.expect_exit(0, command);
    let lux: Vec<f64> = output.out.lines().skip(1).map(|row| row.split(',').nth(6).unwrap().parse().unwrap()).collect();
    let [inside, outside] = lux[..] else { panic!("{}", output.out) };
    let expected = 7.0 / 9.0 * std::f64::consts::PI * 10000.0;
    assert!((outside / expected - 1.0).abs() < 0.04, "{outside}, not {expected}");
    assert!((100.0 * inside / outside - 3.6).abs() < 0.2, "{inside} {outside}");
}

#[test]
fn glare_of_luminaires_is_rated() {
    let folder = lit();
    folder.write("glare.txt", LIT.replace("emissionLuminance 20", "emissionLuminance 2000"));
    let output = folder.expect_exit(0, "measure glare.txt --ugr -1,0.5,4:-1,0.3,0.5 --samples 1024 --json");
    let json: serde_json::Value = serde_json::from_str(&output.out).unwrap();
    let observer = &json["observers"][0];
    let [luminaire] = &observer["luminaires"].as_array().unwrap()[..] else { panic!("{json}") };
    assert!((luminaire["luminance"].as_f64().unwrap() - 2000.0).abs() < 0.1);
    // A sphere of radius 0.3 at the distance d covers 2 pi (1 - cos asin(0.3 / d)).
    let sin = 0.3 / (3.5_f64 * 3.5 + 0.2 * 0.2).sqrt();
    let solid_angle = std::f64::consts::TAU * (1.0 - (1.0 - sin * sin).sqrt());
    assert!((luminaire["solid_angle"].as_f64().unwrap() / solid_angle - 1.0).abs() < 0.005);
    let [ugr, background, index] =
        [&observer["ugr"], &observer["background"], &luminaire["position_index"]].map(|value| value.as_f64().unwrap());
    // The inverse of the rating, 8 log10 of the sum, avoids a logarithm.
    let sum = 0.25 / background * solid_angle * (2000.0 / index) * (2000.0 / index);
    let rated = durer::math::fp::pow(10.0, ugr as f32 / 8.0);
    assert!((f64::from(rated) / sum - 1.0).abs() < 0.01, "{ugr} {rated} {sum}");
    assert!(output.err.contains("1 light without extent"), "{}", output.err);
    let rows = folder.expect_exit(0, "measure glare.txt --ugr -1,0.5,4:-1,0.5,9 --samples 64");
    assert!(rows.out.lines().nth(1).unwrap().starts_with("-1,0.5,4,-1,0.5,9,,"), "{}", rows.out);
    assert!(rows.err.contains("sees no luminaire"), "{}", rows.err);
    for wrong in ["--ugr 1,2,3", "--ugr 1,2,3:1,2,3", "--ugr 0,1,0:1,1,0 --at 0,0,0"] {
        folder.expect_exit(2, &format!("measure glare.txt {wrong}"));
    }
}

#[test]
fn photons_measure_light_through_glass() {
    let folder = TestFolder::new();
    let scene = "PerspectiveCamera { center 0 2 6 direction 0 -0.3 -1 up 0 1 0 angle 40 } Background { color 0 0 0 }
Lights { PointLight { position 0 2 0 color 31.830989 31.830989 31.830989 attenuation 0 0 1 } }
Materials { PrincipledMaterial { baseColor 0 0 0 specularWeight 0 } PrincipledMaterial { transmissionWeight 1 specularRoughness 0 } }
Group { MaterialIndex 0 Plane { normal 0 1 0 offset 0 } MaterialIndex 1 Box { min -1 1 -1 max 1 1.002 1 } }";
    folder.write("pane.txt", scene);
    let lux = |options: &str| {
        let output = folder.expect_exit(0, &format!("measure pane.txt --at 0,0,0 {options}"));
        let row: Vec<f64> = output.out.lines().nth(1).unwrap().split(',').map(|word| word.parse().unwrap()).collect();
        (row[6], row[7])
    };
    // Without the pane, 100 cd at a distance of 2 m give 25 lux. Each face of the pane reflects a
    // fraction F = 0.04, so T = (1 - F) / (1 + F).
    let (mean, error) = lux("--integrator photons --samples 32 --photons 20000 --photon-radius 0.2");
    let expected = 25.0 * 0.96 / 1.04;
    assert!((mean - expected).abs() < 3.0 * error + 0.02 * expected, "{mean} ± {error}, not {expected}");
    // Path tracing cannot reach a point light behind glass.
    assert_eq!(lux("--samples 32").0, 0.0);
    assert!(folder.expect_exit(2, "measure pane.txt --at 0,0,0 --integrator ao").err.contains("path or photons"));
}

#[test]
fn paths_are_deterministic_and_explanations_sum_up() {
    let folder = lit();
    let hash = |options: &str| {
        let output =
            folder.expect_exit(0, &format!("render lit.txt -o p.pfm --size 32x24 --samples 8 --hash -q {options}"));
        output.out.lines().last().unwrap().to_string()
    };
    let one = hash("--threads 1");
    assert_eq!((hash("--threads 3 --tile 8"), hash("--accel grid")), (one.clone(), one.clone()));
    assert_ne!(hash("--bounces 0"), one);
    assert_ne!(hash("--integrator whitted"), one);
    let picture = folder.image("p.pfm");
    assert!(picture.pixels.iter().all(|pixel| pixel.is_finite()));
    let why = folder.expect_exit(0, "explain lit.txt --pixel 16,20 --size 32x24 --samples 8 -q").out;
    assert!(why.contains("direct light of PhotometricLight") && why.contains("chosen by Diffuse"), "{why}");
}

#[test]
fn exposure_and_tone_change_8_bit_pictures_only() {
    let folder = lit();
    let bright = |options: &str| {
        folder.expect_exit(0, &format!("render lit.txt -o p.png --size 16x12 --samples 4 -q {options}"));
        folder.image("p.png").pixels.iter().map(|pixel| pixel.x).sum::<f32>()
    };
    let (plain, darker) = (bright(""), bright("--exposure -7"));
    assert!(darker < 0.5 * plain, "{darker} {plain}");
    assert!(bright("--tone reinhard") < plain);
    folder.expect_exit(0, "render lit.txt -o a.pfm --size 16x12 --samples 4 -q --exposure -3");
    folder.expect_exit(0, "render lit.txt -o b.pfm --size 16x12 --samples 4 -q");
    assert_eq!(folder.image("a.pfm"), folder.image("b.pfm"));
    assert!(folder.expect_exit(2, "render lit.txt -o p.png --exposure 1e9").err.contains("--exposure"));
    assert!(
        folder
            .expect_exit(2, "render lit.txt -o p.png --clamp 1 --integrator ao")
            .err
            .contains("--clamp does not apply")
    );
}

#[test]
fn invalid_photometric_files_names_and_dark_scenes_are_reported() {
    let folder = lit();
    folder.write("lamp.ies", LIGHT.replace("0 30 60 90", "0 30 20 90"));
    let output = folder.expect_exit(2, "render lit.txt -o p.png").err;
    assert!(output.contains("lamp.ies:5:6") && output.contains("must be in ascending order"), "{output}");
    assert!(!folder.path("p.png").exists());
    folder.write("lamp.ies", LIGHT);
    folder.write("name.txt", LIT.replace("preset gold", "preset golt"));
    let output = folder.expect_exit(2, "render name.txt -o p.png").err;
    assert!(output.contains("did you mean `gold`"), "{output}");
    let dark = LIT.replace("PhotometricLight { position 0 2 0 file lamp.ies }", "").replace("emissionLuminance 20", "");
    folder.write("dark.txt", &dark);
    assert!(folder.expect_exit(1, "check dark.txt").out.contains("no-emitter"));
    // The message uses the terminology of the file's format.
    let scene =
        "<scene version='3.0.0'><sensor type='perspective'/><emitter type='projector'/><shape type='sphere'/></scene>";
    folder.write("dark.xml", scene);
    let output = folder.expect_exit(1, "check dark.xml").out;
    let foreign = ["emissionLuminance", "Background"].iter().any(|word| output.contains(word));
    assert!(output.contains("no-emitter") && output.contains("<emitter type=\"area\"/>") && !foreign, "{output}");
    let turned =
        "MaterialIndex 2 Rectangle { corner -1 3 -1 edge0 0 0 2 edge1 2 0 0 } MaterialIndex 1 Sphere { center 0";
    folder.write(
        "turned.txt",
        dark.replace("baseColor 0 0 0", "baseColor 0 0 0 emissionLuminance 9")
            .replace("MaterialIndex 1 Sphere { center 1", turned),
    );
    let output = folder.expect_exit(1, "check turned.txt").out;
    assert!(output.contains("lamp-turned") && output.contains("swap `edge0` and `edge1`"), "{output}");
    folder.write("milk.txt", LIT.replace("preset gold", "preset gold transmissionScatter 1 1 1"));
    let output = folder.expect_exit(1, "check milk.txt").out;
    assert!(output.contains("no-depth") && output.contains("transmissionDepth 1"), "{output}");
    folder.write(
        "bulb.txt",
        "PerspectiveCamera { center 0 1 8 direction 0 0 -1 up 0 1 0 angle 30 } Background { color 0.5 0.5 0.5 }\n\
         Lights { PointLight { position 0 1 0 color 5 5 5 falloff 1 } }\n\
         Materials { PrincipledMaterial { baseColor 0.5 0.5 0.5 } PrincipledMaterial { preset glass } }\n\
         Group { MaterialIndex 0 Plane { normal 0 1 0 offset 0 } MaterialIndex 1 Sphere { center 0 1 0 radius 0.6 } }",
    );
    let output = folder.expect_exit(1, "check bulb.txt").out;
    assert!(output.contains("lamp-in-glass") && output.contains("--integrator photons"), "{output}");
    assert!(!folder.expect_exit(0, "check bulb.txt --integrator photons").out.contains("lamp-in-glass"));
}

#[test]
fn units_of_measured_light_are_told() {
    let folder = TestFolder::new();
    let scene = |background: &str, light: &str| {
        let camera = "PerspectiveCamera { center 0 2 6 direction 0 -0.25 -1 up 0 1 0 angle 30 }";
        let floor = "Materials { PrincipledMaterial { baseColor 0 0 0 } } \
                     Group { MaterialIndex 0 Plane { normal 0 1 0 offset 0 } }";
        folder.write("a.txt", format!("{camera} Background {{ {background} }} Lights {{ {light} }} {floor}"));
        folder.expect_exit(0, "measure a.txt --at 0,0,0 --samples 64")
    };
    let plain = scene("color 0.5 0.5 0.5", "PointLight { position 0 4 0 color 9 9 9 }");
    assert!(plain.err.contains("1 light is without a photometric unit"), "{}", plain.err);
    assert!(plain.err.contains("the colour of the background counts as light"), "{}", plain.err);
    let json = folder.expect_exit(0, "measure a.txt --at 0,0,0 --samples 64 --json").out;
    let json: serde_json::Value = serde_json::from_str(&json).unwrap();
    assert_eq!(json["units"]["illuminance"], "the scene's own unit");
    // A model has no light unless a studio is chosen.
    folder.write("a.obj", "v -1 0 -1\nv -1 0 1\nv 1 0 1\nv 1 0 -1\nf 1 2 3 4\n");
    let dark = folder.expect_exit(0, "measure a.obj --at 0,0,0 --samples 64");
    assert!(dark.err.contains("nothing in the file emits light") && dark.err.contains("--studio soft"), "{}", dark.err);
    let studio = folder.expect_exit(0, "measure a.obj --at 0,0,0 --samples 64 --studio soft");
    assert!(!studio.err.contains("nothing") && !studio.out.contains(",0.000000,"), "{} {}", studio.out, studio.err);
    // A light with a unit needs no colour: 1000 lm are 79.58 cd, which are 4.974 lux at 4 m.
    let lamp = scene("color 0 0 0", "PointLight { position 0 4 0 lumens 1000 }");
    assert!(lamp.out.contains("4.97") && !lamp.err.contains("note"), "{} {}", lamp.out, lamp.err);
    folder.write("b.txt", "PerspectiveCamera { center 0 0 5 direction 0 0 -1 up 0 1 0 angle 30 } Background { color 0 0 0 } \
        Lights { numLights 1 PointLight { position 0 4 0 } } Materials { numMaterials 1 PhongMaterial { diffuseColor 1 1 1 } } \
        Group { numObjects 1 MaterialIndex 0 Sphere { center 0 0 0 radius 1 } }");
    folder.expect_failure(2, "render b.txt --dialect f04", &["`PointLight` has no `color`"]);
}

#[test]
fn ambient_light_of_a_scene_without_lights_is_its_own() {
    let folder = TestFolder::new();
    let ball = |background: &str| {
        folder.write(
            "a.txt",
            format!(
                "PerspectiveCamera {{ center 0 0 5 direction 0 0 -1 up 0 1 0 angle 30 }} \
            Background {{ {background} }} Materials {{ PhongMaterial {{ diffuseColor 1 1 1 }} }} \
            Group {{ MaterialIndex 0 Sphere {{ center 0 0 0 radius 1 }} }}"
            ),
        );
        folder.expect_exit(0, "render a.txt --pixel 16,16 --size 32x32 --samples 1 --dialect durer").out
    };
    assert!(ball("color 0 0 0 ambientLight 0.25 0.25 0.25").contains(": 0.25 0.25 0.25"));
    assert!(ball("color 0 0 0").contains(": 1.0 1.0 1.0"));
}

/// A glass ball between a light and a floor.
const CAUSTIC: &str = "PerspectiveCamera { center 0 2 6 direction 0 -0.25 -1 up 0 1 0 angle 30 }
Background { color 0 0 0 }
Lights { PointLight { position 0.5 4 0 color 9 9 9 falloff 1 } }
Materials {
    PrincipledMaterial { baseColor 0.5 0.4 0.3 specularWeight 0 }
    PrincipledMaterial { preset glass }
}
Group {
    MaterialIndex 0 Plane { normal 0 1 0 offset 0 }
    MaterialIndex 1 Sphere { center 0 1 0 radius 0.7 }
}
";

#[test]
fn photons_spectra_and_fog_are_deterministic() {
    let folder = TestFolder::new();
    folder.write("scene.txt", CAUSTIC);
    folder.write("fog.txt", format!("Fog {{ extinction 0.2 color 0.9 0.8 0.7 min -3 0 -3 max 3 3 3 }}\n{CAUSTIC}"));
    for (scene, options) in [
        ("scene.txt", "--integrator photons --photons 500"),
        ("scene.txt", "--integrator photons --photons 500 --color spectral"),
        ("scene.txt", "--color spectral"),
        ("fog.txt", "--integrator path"),
    ] {
        let output = folder.expect_exit(0, &format!("verify {scene} {options} --size 20x16 --samples 5 --trials 4"));
        assert!(output.out.contains("same"), "{} {}", output.out, output.err);
    }
    // Photons carry light that paths cannot find.
    let mean = |options: &str| {
        folder.expect_exit(0, &format!("render scene.txt {options} --size 24x18 --samples 16 -o p.pfm -q --restart"));
        let bytes = std::fs::read(folder.path("p.pfm")).unwrap();
        let floats = bytes[bytes.len() - 24 * 18 * 12..].chunks_exact(4);
        floats.map(|four| f32::from_le_bytes(four.try_into().unwrap())).sum::<f32>() / (24.0 * 18.0 * 3.0)
    };
    let (paths, photons) = (mean("--integrator path"), mean("--integrator photons --photons 20000"));
    assert!(photons > 1.01 * paths, "{paths} {photons}");
    // Photons only follow sharp reflection and refraction.
    let small = "--integrator photons --photons 500 --size 4x3 --samples 1 -o p.png --restart";
    assert!(!folder.expect_exit(0, &format!("render scene.txt {small}")).err.contains("no effect"));
    folder.write("rough.txt", CAUSTIC.replace("preset glass", "transmissionWeight 1"));
    let err = folder.expect_exit(0, &format!("render rough.txt {small}")).err;
    assert!(err.contains("photons have no effect") && err.contains("specularRoughness 0"), "{err}");
}

#[test]
fn invalid_light_options_are_refused_and_denoising_keeps_the_hash() {
    let folder = TestFolder::new();
    folder.write("scene.txt", CAUSTIC);
    for (options, word) in [
        ("--integrator path --photons 9", "--photons does not apply to --integrator path"),
        ("--integrator whitted --color spectral", "--color does not apply"),
        ("--photon-radius 0", "--photon-radius must be more than 0"),
    ] {
        let output = folder.expect_exit(2, &format!("render scene.txt {options} -o p.png")).err;
        assert!(output.contains(word), "{output}");
    }
    let explain = "explain scene.txt --pixel 3,3 --size 8x8 --samples 2 --color spectral";
    let output = folder.expect_exit(0, explain).out;
    assert!(output.contains(" nm; converted to RGB") && output.contains("red: ("), "{output}");
    let output: serde_json::Value =
        serde_json::from_str(&folder.expect_exit(0, &format!("{explain} --json")).out).unwrap();
    let light = &output["pixel"]["samples"][0]["light"];
    let (value, observer) = (light["value"].as_array().unwrap(), light["waves"]["observer"].as_array().unwrap());
    assert_eq!((value.len(), observer.len(), light["waves"]["nm"].as_array().unwrap().len()), (4, 3, 4), "{light}");
    let of = |options: &str| {
        let output =
            folder.expect_exit(0, &format!("render scene.txt --size 24x18 --samples 16 --hash --restart -q {options}"));
        (output.out, std::fs::read(folder.path("p.png")).unwrap())
    };
    let (noisy, clean) = (of("-o p.png"), of("-o p.png --denoise"));
    assert_eq!(noisy.0, clean.0);
    assert_ne!(noisy.1, clean.1);
    folder.expect_exit(0, "render scene.txt --size 24x18 --samples 4 -o p.exr --denoise -q");
    assert!(String::from_utf8_lossy(&std::fs::read(folder.path("p.exr")).unwrap()).contains("denoised"));
}

#[test]
fn spectra_are_files_or_named_illuminants() {
    let folder = TestFolder::new();
    let scene = |base: &str, emitter: &str, sky: &str| {
        format!(
            "PerspectiveCamera {{ center 0 1 6 direction 0 0 -1 up 0 1 0 angle 40 }} Background {{ color 0 0 0 {sky} }}
Materials {{ PrincipledMaterial {{ {base} specularWeight 0 }}
  PrincipledMaterial {{ baseColor 0 0 0 specularWeight 0 emissionLuminance 100 {emitter} }} }}
Group {{ MaterialIndex 0 Plane {{ normal 0 1 0 offset 0 }} MaterialIndex 1 Disc {{ center 0 2 0 normal 0 -1 0 radius 1 }} }}"
        )
    };
    let write = |base, emitter, sky| folder.write("s.txt", scene(base, emitter, sky));
    folder.write("paints.csv", "nm,grey,red\n400,0.5,0.1\n580,0.5,0.1\n600,0.5,0.8\n");
    folder.write("bulb.csv", "400 0\n700 3\n");
    // The illuminance does not depend on the hue, since E = pi L r^2 / (r^2 + d^2).
    for emitter in
        ["", "emissionSpectrum A", "emissionSpectrum F11", "emissionSpectrum 2700K", "emissionSpectrum bulb.csv"]
    {
        write("baseSpectrum paints.csv:red", emitter, "");
        for color in ["rgb", "spectral"] {
            let measure = format!("measure s.txt --at 0,0,0 --samples 4096 --bounces 0 --color {color}");
            let row = folder.expect_exit(0, &measure).out.lines().nth(1).unwrap().to_string();
            let lux: f64 = row.split(',').nth(6).unwrap().parse().unwrap();
            assert!((lux / (20.0 * std::f64::consts::PI) - 1.0).abs() < 0.01, "{emitter} {color}: {row}");
        }
    }
    // A small area light and point lights with the same power and spectrum give the same colour to
    // a paint.
    let shown = |lights: &str, objects: &str| -> Vec<f64> {
        folder.write(
            "t.txt",
            format!(
                "PerspectiveCamera {{ center 0 1 6 direction 0 -1 -6 up 0 1 0 angle 0.1 }} Background {{ color 0 0 0 }}
Lights {{ {lights} }} Materials {{ PrincipledMaterial {{ baseSpectrum paints.csv:red specularWeight 0 }}
  PrincipledMaterial {{ baseColor 0 0 0 specularWeight 0 emissionLuminance 100 emissionSpectrum bulb.csv }} }}
Group {{ MaterialIndex 0 Plane {{ normal 0 1 0 offset 0 }} MaterialIndex 1 {objects} }}"
            ),
        );
        let explain = "explain t.txt --pixel 0,0 --size 1x1 --samples 512 --bounces 0 --color spectral --json";
        let output: serde_json::Value = serde_json::from_str(&folder.expect_exit(0, explain).out).unwrap();
        output["pixel"]["color"].as_array().unwrap().iter().map(|x| x.as_f64().unwrap()).collect()
    };
    let wanted = shown("", "Disc { center 0 2 0 normal 0 -1 0 radius 0.02 }");
    assert!(wanted[0] > 3.0 * wanted[1], "{wanted:?}");
    let color = "color 0.04 0.04 0.04 spectrum bulb.csv";
    for light in [
        format!("PointLight {{ position 0 2 0 {color} attenuation 0 0 1 }}"),
        format!("SpotLight {{ position 0 2 0 direction 0 -1 0 angle 30 innerAngle 20 {color} }}"),
        "DirectionalLight { direction 0 -1 0 color 0.01 0.01 0.01 spectrum bulb.csv }".into(),
    ] {
        let found = shown(&light, "");
        let near = |(a, b): (&f64, &f64)| (a - b).abs() < 0.01 * wanted[0];
        assert!(found.iter().zip(&wanted).all(near), "{light}: {found:?}, and not {wanted:?}");
    }
    let render = "render s.txt -o p.png --size 8x8 --samples 1 -q";
    for (base, emitter, sky, words) in [
        ("baseSpectrum paints.csv:blue", "", "", "the columns are grey, red"),
        ("baseSpectrum none.csv", "", "", "none.csv"),
        ("baseSpectrum bulb.csv", "", "", "must be from 0 to 1"),
        ("", "emissionSpectrum warm", "", "use A, D50"),
        ("", "", "cieSky 12", "write `sun x y z`"),
        ("", "", "cieSky 17", "from 1 to 16"),
        ("", "", "sun 0 1 0 skyModel hosek turbidity 0.5", "`turbidity` must be from 1 to 10"),
        ("", "", "sun 0 1 0 skyModel hosek turbidity 10.5", "`turbidity` must be from 1 to 10"),
        ("", "", "sun 0 1 0 skyModel nishita", "preetham"),
        ("", "", "sunAltitude 30", "`sunAltitude` needs `sunAzimuth`"),
        ("", "", "sunAltitude 95 sunAzimuth 0", "must be from -90 to 90"),
        ("", "", "sun 0 1 0 date 2026 6 21", "given twice, by `sun` and by `date`"),
        ("", "", "timeZone 2", "needs `latitude`"),
        ("", "", "latitude 60 longitude 25 date 2026 2 30 time 12 0 0", "`date` does not exist"),
        ("", "", "latitude 60 longitude 25 date 2026 2 3 time 12 70 0", "`time` does not exist"),
        ("", "", "latitude 60 longitude 25 date 2026 2.5 3 time 12 0 0", "must be whole numbers"),
    ] {
        write(base, emitter, sky);
        folder.expect_failure(2, render, &[words]);
    }
    folder.write("paints.csv", "nm,grey\n400,0.5\n390,0.5\n");
    write("baseSpectrum paints.csv", "", "");
    folder.expect_failure(2, render, &["paints.csv:3:1", "ascend"]);
    write("", "", "cieSky 16 zenithLuminance 1");
    folder.expect_exit(0, render);
}

#[test]
fn sun_position_follows_from_angles_or_place_and_time() {
    let folder = TestFolder::new();
    let lux = |sky: &str| -> Vec<f64> {
        let scene = format!(
            "PerspectiveCamera {{ center 0 1 6 direction 0 -1 -6 up 0 1 0 angle 30 }} Background {{ {sky} }}
Materials {{ PrincipledMaterial {{ baseColor 0.5 0.5 0.5 }} }}
Group {{ MaterialIndex 0 Sphere {{ center 0 -9 0 radius 1 }} }}"
        );
        folder.write("s.txt", scene);
        let at = |normal: &str| -> f64 {
            let measure = format!("measure s.txt --at 0,0,0 --normal {normal} --samples 1024");
            let row = folder.expect_exit(0, &measure).out.lines().nth(1).unwrap().to_string();
            row.split(',').nth(6).unwrap().parse().unwrap()
        };
        ["0,1,0", "1,0,0", "-1,0,0", "0,0,1", "0,0,-1"].map(at).to_vec()
    };
    // Reda and Andreas, 2003: at this place in Colorado, the sun has an elevation of 39.872 degrees
    // and an azimuth of 194.340 degrees.
    let written = lux("sun -0.190061 0.641085 0.743564");
    assert!(written[3] > written[2] && written[2] > written[1] && written[1] > 0.0, "{written:?}");
    for sky in [
        "sunAltitude 39.872 sunAzimuth 194.340",
        "latitude 39.742476 longitude -105.1786 date 2003 10 17 time 12 30 30 timeZone -7",
        "latitude 39.742476 longitude -105.1786 date 2003 10 17 time 19 30 30",
    ] {
        let found = lux(sky);
        let near = found.iter().zip(&written).all(|(a, b)| (a / b - 1.0).abs() < 2e-3);
        assert!(near, "{sky}: {found:?}, not {written:?}");
    }
    // At midnight the picture is dark, and a warning is printed.
    assert_eq!(lux("latitude 39.742476 longitude -105.1786 date 2003 10 17 time 7 0 0")[0], 0.0);
    assert_eq!(lux("cieSky 12 sunAltitude -20 sunAzimuth 0")[0], 0.0);
    lux("latitude 39.742476 longitude -105.1786 date 2003 10 17 time 7 0 0");
    let output = folder.expect_exit(1, "check s.txt --exposure -13").out;
    assert!(output.contains("degrees below the horizon") && output.contains("s.txt:1:"), "{output}");
}

#[test]
fn lights_in_candela_lumen_and_lux_have_that_strength() {
    let folder = TestFolder::new();
    folder.write("lamp.ies", "TILT=NONE\n1 -1 2 3 1 1 2 0 0 0\n0.5 1 60\n0 90 180\n0\n100 100 100\n");
    let pi = std::f64::consts::PI;
    let lux = |light: &str| -> f64 {
        let scene = format!(
            "PerspectiveCamera {{ center 0 1 6 direction 0 -1 -6 up 0 1 0 angle 30 }} Background {{ color 0 0 0 }} Lights {{ {light} }}
Materials {{ PrincipledMaterial {{ baseColor 0.5 0.5 0.5 }} }}
Group {{ MaterialIndex 0 Sphere {{ center 0 -9 0 radius 1 }} }}"
        );
        folder.write("s.txt", scene);
        let row =
            folder.expect_exit(0, "measure s.txt --at 0,0,0 --samples 16").out.lines().nth(1).unwrap().to_string();
        row.split(',').nth(6).unwrap().parse().unwrap()
    };
    for (light, expected) in [
        // E = I / d². If a flux is given, I = flux / 4 pi, which does not depend on the hue.
        ("PointLight { position 0 2 0 color 1 1 1 candela 800 }", 200.0),
        ("PointLight { position 0 2 0 color 0.9 0.5 0.1 lumens 800 }", 800.0 / (4.0 * pi) / 4.0),
        ("SpotLight { position 0 2 0 direction 0 -1 0 color 2 2 2 angle 40 candela 800 }", 200.0),
        // The flux fills a cone of 60 degrees around the axis, which has a solid angle of 2 pi (1 -
        // 1/2).
        (
            "SpotLight { position 0 2 0 direction 0 -1 0 color 1 0 0 angle 60 innerAngle 60 lumens 800 }",
            800.0 / pi / 4.0,
        ),
        // The intensity is proportional to s², which is 1 on the axis. The mean of s² is one third.
        ("SpotLight { position 0 2 0 direction 0 -1 0 color 1 1 1 angle 60 lumens 800 }", 800.0 / (pi / 3.0) / 4.0),
        (
            "SpotLight { position 0 2 0 direction 0 -1 0 color 1 1 1 angle 60 fade smooth lumens 800 }",
            800.0 / (pi / 2.0) / 4.0,
        ),
        ("DirectionalLight { direction 0 -3 0 color 1 0.9 0.7 lux 100000 }", 100_000.0),
        ("DirectionalLight { direction 0 -3 0 color 1 1 1 lux 500 spectrum A }", 500.0),
        // A file that gives 100 cd in every direction.
        ("PhotometricLight { position 0 2 0 file lamp.ies }", 25.0),
        ("PhotometricLight { position 0 2 0 file lamp.ies color 0.2 0.9 0.4 lumens 800 }", 800.0 / (4.0 * pi) / 4.0),
    ] {
        let found = lux(light);
        assert!((found / expected - 1.0).abs() < 2e-3, "{light}: {found}, not {expected}");
    }
    for (light, words) in [
        ("PointLight { position 0 2 0 color 1 1 1 candela 8 lumens 9 }", "both set the strength"),
        ("SpotLight { position 0 2 0 direction 0 -1 0 color 1 1 1 candela 8 lumens 9 }", "both set the strength"),
        ("PointLight { position 0 2 0 color 1 1 1 candela 8 attenuation 1 0 0 }", "remove `attenuation` and"),
        ("DirectionalLight { direction 0 -1 0 color 1 1 1 lux -1 }", "must not be less than 0"),
    ] {
        let scene = std::fs::read_to_string(folder.path("s.txt")).unwrap();
        let (before, rest) = scene.split_once("Lights {").unwrap();
        let after = rest.split_once("\nMaterials").unwrap().1;
        folder.write("t.txt", format!("{before}Lights {{ {light} }}\nMaterials{after}"));
        folder.expect_failure(2, "render t.txt -o p.png --size 8x8 -q", &[words, "t.txt:1:"]);
    }
}

#[test]
fn camera_settings_give_the_exposure() {
    let folder = TestFolder::new();
    let scene =
        "PerspectiveCamera { center 0 0 5 direction 0 0 -1 up 0 1 0 angle 30 } Background { color 3840 3840 3840 }
Materials { PrincipledMaterial { baseColor 0.5 0.5 0.5 } } Group { MaterialIndex 0 Sphere { center 0 0 9 radius 1 } }";
    folder.write("s.txt", scene);
    let pixel = |options: &str| -> u8 {
        folder.expect_exit(
            0,
            &format!("render s.txt -o p.ppm --size 1x1 --samples 1 --transfer linear --quiet --restart {options}"),
        );
        *std::fs::read(folder.path("p.ppm")).unwrap().last().unwrap()
    };
    // White corresponds to 1.2 · 100 / S · N² / t, which is 9600 cd/m² for ISO 100, 1/125 s and
    // f/8.
    assert_eq!(pixel("--shutter 1/125 --f-number 8"), (0.4f64 * 255.0).round() as u8);
    assert_eq!(pixel("--shutter 0.008 --f-number 8 --iso 200"), (0.8f64 * 255.0).round() as u8);
    assert_eq!(pixel("--shutter 1/250 --f-number 8 --iso 100 --exposure 1"), (0.4f64 * 255.0).round() as u8);
    for (options, words) in [
        ("--shutter 1/125", "--f-number"),
        ("--f-number 8", "--shutter"),
        ("--iso 100", "--shutter"),
        ("--shutter 0 --f-number 8", "expected a time in seconds"),
        ("--shutter 1/0 --f-number 8", "expected a time in seconds"),
        ("--shutter 1/125 --f-number 0", "--f-number"),
    ] {
        folder.expect_failure(2, &format!("render s.txt -o q.png --size 1x1 {options}"), &[words]);
    }
    // `check` uses the same exposure.
    folder.write("lit.txt", scene.replace("0 0 9", "0 0 0"));
    assert!(folder.expect_exit(1, "check lit.txt").out.contains("too-bright"));
    folder.expect_exit(0, "check lit.txt --shutter 1/125 --f-number 8");
}

#[test]
fn radiance_scenes_are_measured_in_lux_from_above() {
    let folder = TestFolder::new();
    let sky = "void glow g 0 0 4 2 1 .5 0\ng source s 0 0 4 0 0 1 180\n";
    folder.write("sky.rad", sky);
    folder.write("dark.rad", "void plastic w 0 0 5 .5 .5 .5 0 0\nw sphere s 0 0 4 0 0 -9 1\n");
    let rows = |measure: &str| -> Vec<Vec<f64>> {
        let output = folder.expect_exit(0, measure);
        output.out.lines().skip(1).map(|row| row.split(',').map(|word| word.parse().unwrap()).collect()).collect()
    };
    // Half of the sphere emits light, so the result is pi L, with rtrace's weights and 179 lm/W.
    let expected = std::f64::consts::PI * 179.0 * (2.0 * 0.265 + 0.670 + 0.5 * 0.065);
    for row in
        rows("measure sky.rad --at 0,0,0 --grid 0,0,0:3,0,0:0,5,0:1x1 --grid 0,0,0:0,5,0:3,0,0:1x1 --samples 1024")
    {
        assert_eq!(row[3..6], [0.0, 0.0, 1.0], "{row:?}");
        assert!((row[6] / expected - 1.0).abs() < 5e-3, "{row:?}, not {expected}");
    }
    // A dark model does not get studio lights.
    assert_eq!(rows("measure dark.rad --at 0,0,0 --samples 64")[0][6], 0.0);
    assert!(rows("measure dark.rad --at 0,0,0 --samples 64 --studio soft")[0][6] > 0.1);
    // Photons are only stored on surfaces.
    let mirror = "void light l 0 0 3 100 100 100\nl sphere s 0 0 4 0 0 2 .05\nvoid mirror m 0 0 3 .9 .9 .9
m polygon p 0 0 12 2 -9 -9 2 9 -9 2 9 9 2 -9 9\nvoid plastic w 0 0 5 .5 .5 .5 0 0\nw polygon f 0 0 12 -9 -9 0 9 -9 0 9 9 0 -9 9 0\n";
    folder.write("mirror.rad", mirror);
    folder.expect_failure(
        2,
        "measure mirror.rad --at 0,0,.8 --integrator photons --samples 2",
        &["is not on a surface"],
    );
    rows("measure mirror.rad --at 0,0,0 --integrator photons --samples 2");
    folder.expect_failure(2, "measure sky.rad --at 0,0,0 --samples 1", &["--samples"]);
}

#[test]
fn sky_fields_without_effect_are_reported() {
    let folder = TestFolder::new();
    let output = |sky: &str| {
        let scene = format!(
            "PerspectiveCamera {{ center 0 1 6 direction 0 -1 -6 up 0 1 0 angle 30 }}\n{sky}
Materials {{ PrincipledMaterial {{ baseColor 0.5 0.5 0.5 }} }}
Group {{ MaterialIndex 0 Sphere {{ center 0 -9 0 radius 1 }} }}"
        );
        folder.write("s.txt", scene);
        folder.write("black.ppm", "P3 2 1 255 0 0 0 0 0 0\n");
        folder.expect_exit(0, "measure s.txt --at 0,0,0 --samples 4").err
    };
    let sun = "sunAltitude 30 sunAzimuth 0";
    for (sky, words) in [
        ("zenithLuminance 900".to_string(), "`zenithLuminance` has no effect: the background has no `cieSky`"),
        (format!("{sun} zenithLuminance 900"), "`zenithLuminance` has no effect"),
        (format!("{sun} cieSky 12 turbidity 3"), "`turbidity` has no effect"),
        ("skyModel hosek".into(), "`skyModel` has no effect"),
        (format!("{sun} turbidity 20"), "`turbidity` 20 is outside the range of Preetham's sky: 10 is used"),
        ("groundReflectance 0.3".into(), "`groundReflectance` has no effect"),
        ("environmentRotation 30".into(), "`environmentRotation` has no effect"),
        ("environmentScale 2 2 2".into(), "`environmentScale` has no effect"),
        ("environment black.ppm".into(), "the environment `black.ppm` is black"),
    ] {
        let text = output(&format!("Background {{ {sky} }}"));
        assert!(text.contains(words) && text.contains("s.txt:2:"), "{sky}: {text}");
    }
    for sky in [
        format!("{sun} skyModel hosek turbidity 3 groundReflectance 0.3 environmentRotation 30 environmentScale 2 2 2"),
        "cieSky 16 zenithLuminance 900 groundReflectance 0.3 environmentRotation 30".into(),
        "color 0.5 0.5 0.5".into(),
    ] {
        let text = output(&format!("Background {{ {sky} }}"));
        assert!(!text.contains("no effect") && !text.contains("grey"), "{sky}: {text}");
    }
    // If there is no background, the message must not suggest turning it off.
    assert!(!output("").contains("`Background { color 0 0 0 }`"), "{}", output(""));
}

#[test]
fn measuring_needs_no_camera() {
    let folder = TestFolder::new();
    folder.write("point.txt", "Lights { PointLight { position 0 2 0 color 1 1 1 candela 100 } }\nBackground { color 0 0 0 }\nGroup { Plane { normal 0 1 0 offset 0 } }");
    let output = folder.expect_exit(0, "measure point.txt --at 0,0,0").out;
    assert!(output.contains("0,0,0,0,1,0,25.000000"), "{output}");
}
