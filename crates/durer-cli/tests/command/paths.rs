//! Tests path tracing on the command line: error bounds, light sampling strategies, and denoisers.

use crate::common::TestFolder;

/// A glass ball between a light and a floor.
const GLASS: &str = "PerspectiveCamera { center 0 2 6 direction 0 -0.25 -1 up 0 1 0 angle 30 }
Background { color 0.1 0.1 0.1 }
Materials {
    PrincipledMaterial { baseColor 0.5 0.4 0.3 specularWeight 0 }
    PrincipledMaterial { preset glass }
    PrincipledMaterial { baseColor 0 0 0 specularWeight 0 emissionLuminance 20 }
}
Group {
    MaterialIndex 0 Plane { normal 0 1 0 offset 0 }
    MaterialIndex 1 Sphere { center 0 1 0 radius 0.7 }
    MaterialIndex 2 Sphere { center 1 3 0 radius 0.3 }
}
";

fn place() -> TestFolder {
    let folder = TestFolder::new();
    folder.write("glass.txt", GLASS);
    folder
}

#[test]
fn error_bounds_do_not_change_the_hash() {
    let folder = place();
    let render = "render glass.txt --integrator photons --photons 500 --size 16x12 --samples 8 --hash -q --restart";
    let plain = folder.expect_exit(0, &format!("{render} -o p.png")).out;
    let shown = folder.expect_exit(0, &format!("{render} --show color,error -o p.exr")).out;
    assert_eq!(plain, shown);
    assert!(String::from_utf8_lossy(&folder.bytes("p.exr")).contains("error.R"));
    folder.expect_exit(0, &format!("{render} --show error -o e.pfm"));
    let errors = folder.image("e.pfm");
    assert!(errors.pixels.iter().all(|error| error.x.is_finite() && error.x >= 0.0));
    // The bound is equal to the one that `durer explain` prints for the pixel.
    let explain = "explain glass.txt --integrator photons --photons 500 --size 16x12 --samples 8 --pixel 8,8";
    let output: serde_json::Value =
        serde_json::from_str(&folder.expect_exit(0, &format!("{explain} --json")).out).unwrap();
    let bound = output["pixel"]["error"]["bound"].as_f64().unwrap();
    assert_eq!(errors.get(8, 8).unwrap().x, bound as f32);
    let text = folder.expect_exit(0, explain).out;
    assert!(text.contains("with 90 % confidence: "), "{text}");
    folder.expect_failure(2, "render glass.txt --integrator whitted --show error -o p.png", &["--show error"]);
    folder.expect_failure(2, "render glass.txt --show error --shard 1/2 -o p.part", &["--show error"]);
    let noise =
        "render glass.txt --integrator photons --photons 500 --size 16x12 --noise-threshold 0.05 --show error -o n.pfm";
    folder.expect_failure(2, noise, &["--samples"]);
}

#[test]
fn light_sampling_strategies_differ_in_noise_only() {
    let folder = place();
    let render = |way: &str| {
        let options = format!("--size 16x12 --samples 64 --seed {} --direct {way} -q", way.len());
        folder.expect_exit(0, &format!("render glass.txt {options} --show luminance,variance -o {way}.pfm"));
        let mean = |name: &str| {
            let pixels = folder.image(name).pixels;
            pixels.iter().map(|pixel| f64::from(pixel.x)).sum::<f64>() / pixels.len() as f64
        };
        // Returns the mean and variance over all pixels.
        (mean(&format!("{way}.luminance.pfm")), mean(&format!("{way}.variance.pfm")) / (16.0 * 12.0))
    };
    let (both, lights, bsdf) = (render("both"), render("lights"), render("bsdf"));
    for half in [lights, bsdf] {
        let error = (both.1 + half.1).sqrt();
        assert!((both.0 - half.0).abs() < 3.5 * error && both.0 != half.0, "{both:?} {half:?}");
    }
    folder.expect_failure(2, "render glass.txt --integrator ao --direct bsdf -o p.png", &["--direct does not apply"]);
    folder.expect_failure(2, "render glass.txt --direct middle -o p.png", &["both"]);
}

#[test]
fn denoiser_is_chosen_or_install_hint_is_printed() {
    let folder = place();
    // Create a file that has the name of the library but is not a library.
    for name in ["libOpenImageDenoise.so.2", "libOpenImageDenoise.2.dylib", "OpenImageDenoise.dll"] {
        folder.write(name, "no library");
    }
    let run = |options: &str| {
        let mut command =
            folder.command(&format!("render glass.txt --size 16x12 --samples 4 --hash --restart {options}"));
        let done = command.env("OIDN_DIR", folder.path("")).output().unwrap();
        (done.status.code(), String::from_utf8(done.stdout).unwrap(), String::from_utf8(done.stderr).unwrap())
    };
    let (code, _, output) = run("--denoise=oidn -o p.png");
    assert!(code == Some(2) && output.contains("pip install pyoidn") && output.contains("OIDN_DIR"), "{output}");
    let (_, auto, output) = run("--denoise -o auto.png");
    assert!(output.contains("the built-in denoiser") && output.contains("pip install pyoidn"), "{output}");
    let (code, own, output) = run("--denoise=own -o own.png");
    assert!(code == Some(0) && !output.contains("pyoidn"), "{output}");
    assert_eq!(folder.bytes("auto.png"), folder.bytes("own.png"));
    let hash = |out: &str| out.lines().last().unwrap().to_string();
    assert_eq!(hash(&auto), hash(&own));
    assert_eq!(run("--denoise=else -o p.png").0, Some(2));
}
