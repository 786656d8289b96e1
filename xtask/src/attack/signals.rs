//! Attack `signals`: sends signals to all commands at random times. Each command must end within
//! half a second.

use super::{Attack, Outcome, wait_for};
use anyhow::{Context, Result};
use std::process::{Command, Stdio};
use std::time::{Duration, Instant};

/// Maximum time from a signal to the end of the program.
const MAX_DELAY: Duration = Duration::from_millis(500);

/// Commands that take a long time.
const LONG: [&str; 14] = [
    "render ENDLESS --bounces 256 -o o.png --restart -q",
    "render MESH --accel none -o o.png --restart -q",
    "render MESH --accel grid --size 4000x4000 -o o.png --restart -q",
    "render WHITTED --size 4000x4000 --samples 64 -o o.exr --restart -q",
    "render WHITTED --integrator path --samples 100000 -o o.png --restart -q",
    "verify MESH --accel none --trials 1000000",
    "verify WHITTED --trials 1000000",
    "explain ENDLESS --bounces 256 --pixel 30,30 --size 60x60",
    "lesson ENDLESS --bounces 256 -o lesson",
    "course -input ENDLESS -output o.tga -size 900 900 -bounces 250 -shadows",
    "measure WHITTED --at 0,1,0 --normal 0,1,0 --samples 16777216",
    "check MESH",
    "convert MESH -o o.gltf",
    "info MESH",
];

/// Runs the attack.
pub fn run(attack: &Attack) -> Result<Outcome> {
    attack.put("mesh.obj", mesh(900))?;
    attack.put("mesh.txt", scene("TriangleMesh { obj_file mesh.obj }"))?;
    attack.put("endless.txt", ENDLESS_SCENE)?;
    let whitted = crate::root()?.join("scenes/whitted.txt").display().to_string();
    let (mut failures, mut worst) = (Vec::new(), (Duration::ZERO, ""));
    for number in 0..attack.count {
        let line = LONG[(number % LONG.len() as u64) as usize];
        let words = line.split_whitespace().map(|word| match word {
            "ENDLESS" => "endless.txt",
            "MESH" => "mesh.txt",
            "WHITTED" => &whitted,
            word => word,
        });
        let mut command = Command::new(&attack.durer);
        command.args(words).current_dir(attack.folder.path());
        let mut child = command.stdin(Stdio::null()).stdout(Stdio::null()).stderr(Stdio::null()).spawn()?;
        std::thread::sleep(Duration::from_millis(50 + attack.random(number, 0, 1500) as u64));
        let signal = ["-INT", "-TERM", "-HUP"][attack.random(number, 1, 3)];
        let start = Instant::now();
        Command::new("kill").args([signal, &child.id().to_string()]).stderr(Stdio::null()).status()?;
        let ended = wait_for(&mut child, Duration::from_secs(20))?;
        let took = ended.map_or(Duration::from_secs(20), |_| start.elapsed());
        worst = worst.max((took, line));
        let code = child.wait().context("it ran")?.code();
        // Code 0 means that the program ended before the signal. If the signal arrives before the
        // handler is installed, the program ends without a code.
        if took > MAX_DELAY || !matches!(code, None | Some(0 | 129 | 130 | 143)) {
            failures.push(format!("{line}: {:.2} s after {signal}, exit code {code:?}", took.as_secs_f64()));
        }
    }
    let note = format!("; the slowest took {:.2} s: {}", worst.0.as_secs_f64(), worst.1);
    Ok(Outcome { tried: attack.count, failures, note })
}

/// Mirrors and glass that split every ray in two. With many bounces, no pixel is ever finished.
const ENDLESS_SCENE: &str = "PerspectiveCamera { center 0 0 0 direction 0.3 0.1 -1 up 0 1 0 angle 60 }
Lights { PointLight { position 0 0 0 color 1 1 1 } }
Materials { Material { reflectiveColor 1 1 1 transparentColor 1 1 1 indexOfRefraction 1.5 } }
Group { MaterialIndex 0
  Plane { normal 0 0 1 offset -2 } Plane { normal 0 0 1 offset 2 } Sphere { center 0 0 -1 radius 0.5 } }
";

fn scene(object: &str) -> String {
    format!(
        "PerspectiveCamera {{ center 450 450 900 direction 0 0 -1 up 0 1 0 angle 50 }}
Lights {{ DirectionalLight {{ direction -1 -2 -1 color 0.9 0.9 0.8 }} }}
Materials {{ PhongMaterial {{ diffuseColor 0.8 0.3 0.2 }} }} Group {{ MaterialIndex 0 {object} }}\n"
    )
}

/// Returns a grid of triangles as an OBJ file.
fn mesh(side: usize) -> String {
    let mut mesh = String::new();
    for i in 0..side * side {
        let (x, y) = (i % side, i / side);
        mesh += &format!("v {x} {y} {}\n", (x * 7 + y * 13) % 5);
    }
    for i in (0..side * (side - 1)).filter(|i| (i + 1) % side != 0) {
        mesh += &format!("f {} {} {}\nf {1} {3} {2}\n", i + 1, i + 2, i + 1 + side, i + 2 + side);
    }
    mesh
}
