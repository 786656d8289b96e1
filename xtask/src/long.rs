//! `cargo xtask long`: runs tests of the suite with many more iterations than in CI.

use anyhow::{Result, bail};
use std::process::{Command, ExitCode};
use std::time::Instant;

/// Tests, each with package, name, and the factor for its number of iterations.
const TESTS: [(&str, &str, u32); 4] = [
    // 10^9 lanes.
    ("durer-bvh", "lanes::tests::every_level_gives_the_same_bits", 1_000),
    // 10^7 rays through each of twelve meshes.
    ("durer-bvh", "triangles::tests::reference::double_precision_reference_agrees", 100),
    // 10^8 rays.
    ("durer-bvh", "triangles::tests::closed_mesh_has_even_crossings_from_outside_and_odd_from_inside", 2_100),
    // 10^7 rays from each shape.
    ("durer", "shape::tests::leaving::rays_do_not_hit_the_surface_that_they_leave", 100),
];

/// Runs `cargo xtask long`.
pub fn run(arguments: &[String]) -> Result<ExitCode> {
    let value = |name| crate::value(arguments, name);
    let only = value("--only").map_or("", String::as_str);
    let wanted: Vec<_> = TESTS.into_iter().filter(|(_, name, _)| name.contains(only)).collect();
    if wanted.is_empty() {
        bail!("no long test's name contains `{only}`: {}", TESTS.map(|(_, name, _)| name).join(", "));
    }
    let mut failed = 0;
    for (package, name, usual) in wanted {
        let times = value("--times").map_or(Ok(usual), |times| times.parse())?;
        println!("{name}, {times} times as long:");
        let start = Instant::now();
        let mut command = Command::new(crate::cargo());
        command.args(["test", "--quiet", "--package", package, "--lib", "--", "--exact", "--nocapture", name]);
        let status = command.env("DURER_ROUNDS", times.to_string()).status()?;
        failed += u32::from(!status.success());
        println!("{} in {:.0} s\n", if status.success() { "passed" } else { "FAILED" }, start.elapsed().as_secs_f64());
    }
    Ok(if failed == 0 { ExitCode::SUCCESS } else { ExitCode::FAILURE })
}
