//! Tests `durer course` with command lines of the course's programs.

use crate::common::{self, SCENE, TestFolder};

/// Returns a scene that can be read in every year except 2003 and 2020.
fn plain() -> String {
    SCENE.replace("reflectiveColor 0.5 0.5 0.5", "")
}

#[test]
fn every_option_of_2004() {
    let folder = TestFolder::new();
    let output = folder.expect_exit(
        0,
        "course -input scene.txt -size 20 10 -output o.tga -depth 9 10 d.tga -normals n.tga -shadows -bounces 4 \
         -shade_back -weight 0.01 -gui -tessellation 100 50 -gouraud -stats -grid 10 10 10 -transparent_shadows \
         -jittered_samples 4 -gaussian_filter 0.4 -render_samples s.tga 3 -render_filter f.tga 4",
    );
    // The keywords identify the dialect of the scene.
    assert!(!output.err.contains("read as"), "{}", output.err);
    assert!(output.out.starts_with("objects 2, rays "), "{}", output.out);
    for (name, size) in [("o", (20, 10)), ("d", (20, 10)), ("n", (20, 10)), ("s", (60, 30)), ("f", (81, 41))] {
        let image = folder.image8(&format!("{name}.tga"));
        assert_eq!((image.width, image.height), size, "{name}");
        assert!(output.out.contains(&format!("wrote {name}.tga\n")));
    }
    for samples in ["random", "uniform", "jittered"] {
        for filter in ["box", "tent", "gaussian"] {
            folder.expect_exit(
                0,
                &format!("course -input scene.txt -output o.tga -{samples}_samples 9 -{filter}_filter 1.5"),
            );
        }
    }
    folder.expect_exit(0, "course -input scene.txt -depth -2 -1.5 d.tga");
    folder.expect_exit(0, "course -input scene.txt -render_filter f.tga 2 -size 9 9");
}

#[test]
fn options_of_later_years() {
    let folder = TestFolder::new();
    folder.write("plain.txt", plain());
    for options in [
        "--dialect f12a4 -output o.bmp -depth 8 18 d.bmp -normals n.bmp",
        "--program a5soln -output o.bmp -shadows -bounces 4 -jitter -filter",
        "--program a5soln-v2 -output o.bmp -reflection_off -refraction_off",
        "--program a4 -output o.png -shadows -bounces 4 -jitter -filter -depth 8 18 d.png -normals n.png",
        "--dialect f16 -size 20 20 -output o.png --seed 3 --threads 2 --compat no-stretch,raw-up --assets .",
    ] {
        let output = folder.expect_exit(0, &format!("course -input plain.txt -size 12 12 {options} --quiet"));
        assert_eq!((output.out.as_str(), output.err.as_str()), ("", ""), "{options}");
    }
}

#[test]
fn grid_picture_replaces_the_colour_picture() {
    let folder = TestFolder::new();
    folder.expect_exit(
        0,
        "course -input scene.txt -size 60 60 -output a.tga -grid 1 1 1 -visualize_grid -depth 5 9 d.tga",
    );
    folder.expect_exit(0, "course -input scene.txt -size 60 60 -output b.tga -visualize_grid");
    folder.expect_exit(0, "course -input scene.txt -size 60 60 -output c.tga");
    let pictures = ["a.tga", "b.tga", "c.tga"].map(|name| folder.bytes(name));
    // Without a number of cells, the program chooses one. Here it chooses a single cell, as in
    // the first run.
    assert!(pictures[0] == pictures[1] && pictures[1] != pictures[2]);
    assert!(folder.bytes("d.tga") != pictures[0]);
}

#[test]
fn values_are_truncated_without_a_curve() {
    let folder = TestFolder::new();
    // In the corners, the sky is visible (0.2 0.1 0.5) and the depth is black.
    folder.expect_exit(0, "course -input scene.txt --dialect f04 -output o.tga -depth 5 10 d.tga -normals n.tga");
    let image = folder.image8("o.tga");
    assert_eq!((image.width, image.height, image.pixels[0]), (100, 100, [51, 25, 127]));
    assert_eq!(folder.image8("d.tga").pixels[0], [0, 0, 0]);
    assert_eq!(folder.image8("n.tga").pixels[0], [0, 0, 0]);
    // The normal of the floor points straight up.
    assert_eq!(folder.image8("n.tga").pixels[9999], [0, 255, 0]);
}

#[test]
fn invalid_arguments_are_refused() {
    let folder = TestFolder::new();
    for (options, words) in [
        ("-output o.tga", "-input is missing"),
        ("-input scene.txt", "nothing to write"),
        ("-input scene.txt -output", "-output needs FILE"),
        ("-input scene.txt -depth 9 10", "-depth needs MIN MAX FILE"),
        ("-input scene.txt -depth 9 10 -normals n.tga", "found -normals"),
        ("-input scene.txt -output o.tga -size 200", "-size needs W H"),
        ("-input scene.txt -output o.tga -size 0 3", "at least one pixel"),
        ("-input scene.txt -output o.tga -size x 3", "`x` is not a valid number"),
        ("-input scene.txt -output o.tga -size 100000 100000", "a picture cannot be"),
        ("-input scene.txt -output o.tga -depth 9 9 d.tga", "two different numbers"),
        ("-input scene.txt -output o.tga -depth 9 inf d.tga", "two different numbers"),
        ("-input scene.txt -output o.tga -bounces 1000", "at most 256"),
        ("-input scene.txt -output o.tga -bounces -1", "-bounces"),
        ("-input scene.txt -output o.tga -weight nan", "0 or more"),
        ("-input scene.txt -output o.tga -grid 0 1 1", "cells"),
        ("-input scene.txt -output o.tga -grid 9999999 9999999 9999999", "cells"),
        ("-input scene.txt -output o.tga -random_samples 0", "number of samples"),
        ("-input scene.txt -output o.tga -box_filter 65", "from 0 to 64"),
        ("-input scene.txt -output o.tga -box_filter nan", "from 0 to 64"),
        ("-input scene.txt -render_samples s.tga 0", "zoom"),
        ("-input scene.txt -render_samples s.tga 1000 -size 9999 9999", "too large"),
        ("-input scene.txt -output o.tga -shadow", "did you mean -shadows?"),
        ("-input scene.txt -output o.tga --threads 0", "--threads"),
        ("-input scene.txt -output o.tga --threads 99999999999", "--threads"),
        ("-input scene.txt -output o.tga --program a6", "raytracer"),
        ("-input scene.txt -output o.tga --dialect f05", "f04"),
        ("-input scene.txt -output o.tga --compat foo", "foo"),
        ("-input scene.txt -output o.tgb", ".tga"),
        ("-input scene.txt -output o.tga -normals o.tga", "both name"),
        ("-input missing.txt -output o.tga", "missing.txt"),
    ] {
        folder.expect_failure(2, &format!("course {options}"), &[words]);
    }
    assert!(folder.expect_exit(2, "course").out.contains("-tent_filter"));
    assert!(folder.expect_exit(0, "course --help").out.contains("-tent_filter"));
}

#[test]
fn only_f12a4_ignores_unknown_options() {
    let folder = TestFolder::new();
    folder.write("plain.txt", plain());
    let output = folder.expect_exit(0, "course --dialect f12a4 -input plain.txt -size 4 4 -output o.bmp -frobnicate");
    assert!(output.err.contains("warning: unknown option -frobnicate"), "{}", output.err);
    for dialect in ["f04", "f12a5", "f16"] {
        folder.expect_failure(
            2,
            &format!("course --dialect {dialect} -input plain.txt -output p.tga -frobnicate"),
            &["-frobnicate"],
        );
    }
}

#[test]
fn f12a4_writes_tga_unless_the_name_ends_in_bmp() {
    let folder = TestFolder::new();
    folder.write("plain.txt", plain());
    for name in ["o.tga", "o.foo", "o.png", "o", "o.bmp"] {
        folder.expect_exit(0, &format!("course --dialect f12a4 -input plain.txt -size 4 4 -output {name}"));
        let is_bmp = folder.bytes(name).starts_with(b"BM");
        assert_eq!(is_bmp, name == "o.bmp", "{name}");
        assert_eq!(durer::image::read8(&folder.bytes(name), "o.tga").unwrap().width, 4);
    }
    // In other dialects, the names have their usual meaning.
    folder.expect_exit(0, "course -input plain.txt -size 4 4 -output p.png");
    assert!(folder.bytes("p.png").starts_with(b"\x89PNG"));
}

#[test]
fn last_occurrence_of_an_option_counts() {
    let folder = TestFolder::new();
    folder.expect_exit(0, "course -input missing.txt -input scene.txt -size 9 9 -size 5 4 -output a.tga -output b.tga");
    assert_eq!((folder.image8("b.tga").width, folder.path("a.tga").exists()), (5, false));
}

#[cfg(unix)]
#[test]
fn link_with_a_programs_name_acts_as_that_program() {
    let folder = TestFolder::new();
    folder.write("plain.txt", plain());
    let nodes = "Camera { center 0 0 8 direction 0 0 -1 up 0 1 0 fov 40 }
Background { color 0.2 0.1 0.5 ambient_light 0.2 0.2 0.2 }
Materials { Material { diffuse 0.8 0.3 0.2 } }
Scene { Node { Component<Light> { type directional direction 0 0 -1 color 1 1 1 } Component<Material> { index 0 } Component<Object> { type sphere radius 1 } } }";
    folder.write("nodes.txt", nodes);
    for (name, scene, side) in [
        ("raytracer", "scene.txt", 100),
        ("a4soln", "plain.txt", 100),
        ("a5soln", "plain.txt", 100),
        ("a5soln-v2", "plain.txt", 100),
        ("a4", "plain.txt", 100),
        ("assignment4", "nodes.txt", 200),
    ] {
        std::os::unix::fs::symlink(common::durer(), folder.path(name)).unwrap();
        let mut command = std::process::Command::new(folder.path(name));
        let output = command.args(["-input", scene, "-output", "o.bmp"]).current_dir(folder.path("")).output().unwrap();
        let err = String::from_utf8_lossy(&output.stderr);
        // If the official program is known, the dialect is not guessed.
        assert!(output.status.success() && err.is_empty(), "{name}: {err}");
        assert_eq!(folder.image8("o.bmp").width, side, "{name}");
    }
}

#[test]
fn files_are_found_from_the_current_folder_and_beside_the_scene() {
    let place = TestFolder::new();
    std::fs::create_dir(place.path("scenes")).unwrap();
    let scene = plain().replace("Sphere { center 0 0.5 0 radius 1 }", "TriangleMesh { obj_file one.obj }");
    place.write("scenes/mesh.txt", scene);
    for folder in ["", "scenes/"] {
        let mesh = format!("{folder}one.obj");
        place.write(&mesh, "v 0 0 0\nv 1 0 0\nv 0 1 0\nf 1 2 3\n");
        for dialect in ["f04", "f12a4", "f16"] {
            let arguments = format!("course --dialect {dialect} -input scenes/mesh.txt -size 4 4 -output o.bmp");
            let output = place.run(&arguments);
            println!("{mesh} {dialect}: {:?}", output.code);
            // The programs of 2004 and 2012 search the current folder. All programs search the
            // scene's folder.
            assert!(
                output.code == Some(0) || (dialect == "f16" && folder.is_empty()),
                "{mesh} {dialect}: {}",
                output.err
            );
        }
        std::fs::remove_file(place.path(&mesh)).unwrap();
    }
    place.expect_failure(2, "course --dialect f04 -input scenes/mesh.txt -output o.tga", &["one.obj", "mesh.txt:8"]);
}

#[test]
fn options_of_another_year_do_not_change_the_guess() {
    let folder = TestFolder::new();
    let shiny = plain().replace("diffuseColor 0.8", "specularColor 0.9 0.9 0.9 shininess 20 diffuseColor 0.8");
    folder.write("shiny.txt", shiny);
    // Depth values and highlights differ between the years.
    for (options, dialect, expected) in [
        ("-output o.bmp", "f12a4", false),
        ("-output o.bmp -shadows", "f12a5", true),
        ("-output o.bmp -shade_back", "f12a4", false),
        ("-output o.tga", "f12a4", false),
        ("-output o.png -depth 5 20 d.png", "f16", true),
        ("-output o.tga -grid 3 3 3 -shadows", "f12a5", true),
    ] {
        let output = folder.expect_exit(0, &format!("course -input shiny.txt -size 40 40 {options}"));
        assert_eq!(output.err.contains(&format!("read as {dialect}")), expected, "{options}: {}", output.err);
        assert_eq!(output.err.contains("read as"), expected, "{options}: {}", output.err);
        assert_eq!(output.err.matches("read as").count(), usize::from(expected));
    }
    let output = folder.expect_exit(0, "course -input scene.txt -size 4 4 -output o.png -jitter");
    assert!(!output.err.contains("read as"), "{}", output.err);
}

#[test]
fn guess_is_reported_only_where_it_changed_the_picture() {
    let folder = TestFolder::new();
    folder.write("matte.txt", plain().replace("diffuseColor 0.8", "shininess 20 diffuseColor 0.8"));
    // At this size, the pictures of 2012 and 2016 look the same.
    let output = folder.expect_exit(0, "course -input matte.txt -size 20 20 -output o.png");
    assert!(!output.err.contains("read as"), "{}", output.err);
    let official = folder.expect_exit(0, "course --dialect f16 -input matte.txt -size 20 20 -output f.png");
    assert_eq!(folder.bytes("o.png"), folder.bytes("f.png"), "{}", official.err);
}

#[test]
fn year_whose_picture_has_nan_samples_is_not_guessed() {
    let folder = TestFolder::new();
    let light = |falloff: &str| format!("PointLight {{ position 2 4 3 color 0.9 0.9 0.8 {falloff} }}");
    let sun = "DirectionalLight { direction -1 -2 -1 color 0.9 0.9 0.8 }";
    let shiny = plain().replace("diffuseColor 0.8", "shininess 20 diffuseColor 0.8");
    // In 2016, both lights would cause a division by zero.
    folder.write("none.txt", shiny.replace(sun, &light("")));
    folder.write("zero.txt", shiny.replace(sun, &light("falloff 0")));
    for (scene, options, year) in [
        ("none", "", "f12a4"),
        ("none", "-shadows -bounces 2", "f12a5"),
        ("zero", "", "f12a5"),
        ("zero", "-shadows", "f12a5"),
    ] {
        let output = folder.expect_exit(0, &format!("course -input {scene}.txt -size 30 30 -output o.png {options}"));
        assert!(!output.err.contains("not finite"), "{scene} {options}: {}", output.err);
        assert!(output.err.matches("read as").count() <= 1, "{}", output.err);
        // The programs of 2012 write TGA files.
        folder
            .expect_exit(0, &format!("course --dialect {year} -input {scene}.txt -size 30 30 -output y.tga {options}"));
        let compared = folder.run("compare o.png y.tga");
        assert!(compared.out.contains("identical"), "{scene} {options}: {}", compared.out);
    }
    // If no other year fits, the picture is rendered and its fault is reported.
    folder.write(
        "only.txt",
        shiny.replace(sun, &light("falloff 0")).replace("Background {", "Background { cubeMap sky "),
    );
    std::fs::create_dir(folder.path("sky")).unwrap();
    for face in ["left", "right", "up", "down", "front", "back"] {
        folder.expect_exit(0, &format!("course -input scene.txt -size 4 4 -output sky/{face}.png"));
    }
    let output = folder.expect_exit(0, "course -input only.txt -size 30 30 -output o.png");
    assert!(output.err.contains("not finite") && output.err.contains("the first in pixel"), "{}", output.err);
}

#[test]
fn output_name_alone_does_not_decide_the_year() {
    let folder = TestFolder::new();
    let light = "PointLight { position 2 4 3 color 0.9 0.9 0.8 }";
    let lit = plain().replace("DirectionalLight { direction -1 -2 -1 color 0.9 0.9 0.8 }", light);
    // In 2016, this light would cause a division by zero. However, another keyword in the scene
    // identifies the year.
    folder.write("bulb.txt", lit.replace("diffuseColor 0.8", "shininess 20 diffuseColor 0.8"));
    let picture = |ending: &str| {
        let output = folder.expect_exit(0, &format!("course -input bulb.txt -size 9 9 -output o.{ending}"));
        assert!(!output.err.contains("read as"), "{ending}: {}", output.err);
        folder.image8(&format!("o.{ending}")).pixels
    };
    let pictures = ["png", "bmp", "tga"].map(picture);
    assert!(pictures[0].iter().any(|pixel| *pixel != pictures[0][0]));
    assert_eq!(pictures[0], pictures[1]);
    assert_eq!(pictures[0], pictures[2]);
}

#[test]
fn nan_light_is_reported_with_its_pixel_and_cause() {
    let folder = TestFolder::new();
    let light = "PointLight { position 2 4 3 color 0.9 0.9 0.8 }";
    let lit = plain().replace("DirectionalLight { direction -1 -2 -1 color 0.9 0.9 0.8 }", light);
    folder.write("bulb.txt", lit);
    let output = folder.expect_exit(0, "course --dialect f16 -input bulb.txt -size 9 9 -output o.png");
    let text = output.err.lines().find(|line| line.contains("not finite")).unwrap_or_else(|| panic!("{}", output.err));
    assert!(
        text.contains("the first in pixel ") && text.contains("light 0 is divided by its falloff, which is missing"),
        "{text}"
    );
}

#[test]
fn empty_depth_range_is_black_in_2012() {
    let folder = TestFolder::new();
    folder.write("plain.txt", plain());
    folder.expect_exit(0, "course --dialect f12a4 -input plain.txt -size 9 9 -depth 5 5 d.bmp");
    assert!(folder.image8("d.bmp").pixels.iter().all(|pixel| *pixel == [0; 3]));
    folder.expect_failure(2, "course --dialect f16 -input plain.txt -size 9 9 -depth 5 5 d.bmp", &["two different"]);
}

#[test]
fn jitter_or_filter_alone_has_the_picture_size_of_2012() {
    let folder = TestFolder::new();
    folder.write("plain.txt", plain());
    for (options, dialect, size) in [
        ("-jitter -filter", "f12a5", (20, 11)),
        ("-jitter", "f12a5", (60, 33)),
        ("-filter", "f12a5", (6, 3)),
        ("-jitter", "f16", (20, 11)),
        ("-filter", "f16", (20, 11)),
    ] {
        folder.expect_exit(
            0,
            &format!("course --dialect {dialect} -input plain.txt -size 20 11 {options} -output o.bmp"),
        );
        let image = folder.image8("o.bmp");
        assert_eq!((image.width, image.height), size, "{options} {dialect}");
    }
    folder.expect_failure(
        2,
        "course --dialect f12a5 -input plain.txt -size 2 2 -filter -output o.bmp",
        &["blocks of 3 by 3"],
    );
}

#[cfg(target_os = "linux")]
#[test]
fn standard_output_has_only_the_picture() {
    let folder = TestFolder::new();
    let output = folder.command("course -input scene.txt -size 8 4 -output /dev/stdout").output().unwrap();
    let image = durer::image::read8(&output.stdout, "o.tga").unwrap();
    assert_eq!((output.status.code(), image.width, image.height, output.stdout.len()), (Some(0), 8, 4, 18 + 96));
}

#[test]
fn camera_with_fixed_aspect_ratio_sets_the_picture_size() {
    let folder = TestFolder::new();
    let camera = "EquirectangularCamera { center 0 0 5 direction 0 0 -1 up 0 1 0 }";
    let rest = SCENE.split_once("Lights").unwrap().1;
    folder.write("around.txt", format!("{camera}\nLights{rest}"));
    for (options, size) in [("--dialect durer", (720, 360)), ("--dialect durer -size 30 20", (30, 20))] {
        folder.expect_exit(0, &format!("course -input around.txt {options} -output o.png --quiet"));
        let image = folder.image8("o.png");
        assert_eq!((image.width, image.height), size, "{options}");
    }
}
