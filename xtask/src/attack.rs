//! `cargo xtask attack`: tests the program with hostile input. Each kind of attack counts its
//! trials and its failures.

mod far;
mod growth;
mod mutated;
mod names;
mod signals;

use crate::build::build_durer;
use anyhow::{Context, Result, bail};
use durer::sampler::hash;
use std::path::{Path, PathBuf};
use std::process::{Command, ExitCode, Output, Stdio};
use std::time::{Duration, Instant};

/// A kind of attack, with its default number of trials and a description of what a trial is.
struct AttackKind {
    name: &'static str,
    count: u64,
    trial_description: &'static str,
    run: fn(&Attack) -> Result<Outcome>,
}

const KINDS: [AttackKind; 7] = [
    AttackKind { name: "names", count: 2000, trial_description: "names that lead out of a folder", run: names::run },
    AttackKind { name: "templates", count: 10_000, trial_description: "hostile names in job files", run: templates },
    AttackKind {
        name: "growth",
        count: 200,
        trial_description: "small files that describe huge data",
        run: growth::run,
    },
    AttackKind { name: "signals", count: 100, trial_description: "signals during all commands", run: signals::run },
    AttackKind { name: "far", count: 500, trial_description: "closed rooms far from the origin", run: far::run },
    AttackKind { name: "kills", count: 100, trial_description: "kills during renders", run: kills },
    AttackKind { name: "mutated", count: 20_000, trial_description: "mutated files", run: mutated::run },
];

/// Settings of one attack: the program, a temporary folder, the number of trials and the seed.
struct Attack {
    durer: PathBuf,
    folder: tempfile::TempDir,
    count: u64,
    seed: u64,
    /// Extension of the files that the attack `mutated` uses; empty for all extensions.
    only: String,
}

/// Result of one attack: the number of trials and the failures.
struct Outcome {
    tried: u64,
    /// Descriptions of the failures, one line each.
    failures: Vec<String>,
    /// Text to append to the summary.
    note: String,
}

/// Runs `cargo xtask attack`.
pub fn run(arguments: &[String]) -> Result<ExitCode> {
    if arguments.first().is_some_and(|word| word == mutated::WORKER) {
        return mutated::work(&arguments[1..]);
    }
    let number = |name: &str| -> Result<Option<u64>> {
        let value = crate::value(arguments, name);
        value.map(|value| value.parse().with_context(|| format!("{name} needs a number"))).transpose()
    };
    let requested = arguments.first().filter(|word| !word.starts_with('-'));
    let kinds: Vec<&AttackKind> =
        KINDS.iter().filter(|kind| requested.is_none_or(|requested| requested == kind.name)).collect();
    if kinds.is_empty() {
        bail!("unknown attack; known attacks: {}", KINDS.map(|kind| kind.name).join(", "));
    }
    let (durer, seed) = (build_durer()?, number("--seed")?.unwrap_or(1));
    let only = crate::value(arguments, "--only").cloned().unwrap_or_default();
    let mut failures = 0;
    for kind in kinds {
        let count = number("--count")?.unwrap_or(kind.count);
        let folder = tempfile::tempdir()?;
        let start = Instant::now();
        let attack = Attack { durer: durer.clone(), folder, count, seed, only: only.clone() };
        let found = (kind.run)(&attack).with_context(|| kind.name)?;
        let (tried, fell, seconds) = (found.tried, found.failures.len(), start.elapsed().as_secs_f64());
        println!("{:<10}{tried:>9} {}: {fell} failed, {seconds:.0} s{}", kind.name, kind.trial_description, found.note);
        found.failures.iter().take(20).for_each(|line| println!("    {line}"));
        failures += fell;
    }
    Ok(if failures == 0 { ExitCode::SUCCESS } else { ExitCode::FAILURE })
}

impl Attack {
    fn path(&self, name: &str) -> PathBuf {
        self.folder.path().join(name)
    }

    fn put(&self, name: &str, content: impl AsRef<[u8]>) -> Result<()> {
        let path = self.path(name);
        std::fs::create_dir_all(path.parent().context("a folder")?)?;
        Ok(std::fs::write(path, content)?)
    }

    /// Returns a random number below `below`, which depends only on the seed, `number` and `place`.
    fn random(&self, number: u64, place: u32, below: u64) -> usize {
        (hash(self.seed, number as u32, place, (number >> 32) as u32, 0) % below.max(1)) as usize
    }

    /// Runs the program in the attack's folder with limits for address space (KiB) and time
    /// (seconds).
    fn limited(&self, arguments: &[&str], space: u64, seconds: u64) -> Result<Output> {
        let limit = format!("ulimit -v {space}; exec timeout -s KILL {seconds} \"$0\" \"$@\"");
        let mut command = Command::new("bash");
        command.args(["-c", &limit]).arg(&self.durer).args(arguments).current_dir(self.folder.path());
        command.env("RAYON_NUM_THREADS", "2").stdin(Stdio::null());
        Ok(command.output()?)
    }
}

/// Returns the reason if a run crashed or did not end by itself; `None` if it ended with a picture
/// or an error.
fn failure_reason(output: &Output) -> Option<String> {
    let messages = String::from_utf8_lossy(&output.stderr);
    let last = messages.lines().last().unwrap_or_default();
    match output.status.code() {
        Some(0..=2) if !messages.contains("panicked") => None,
        // `timeout -s KILL` exits with 137.
        Some(137) => Some("did not end".into()),
        Some(code) => Some(format!("exit code {code}: {last}")),
        None => Some(format!("{}: {last}", output.status)),
    }
}

/// Runs the property tests of job files with the requested number of names.
fn templates(attack: &Attack) -> Result<Outcome> {
    let rounds = attack.count.div_ceil(2000).to_string();
    let mut command = Command::new(crate::cargo());
    command.args(["test", "--quiet", "--package", "durer-cli", "--lib", "--", "farm::", "--nocapture"]);
    let output = command.env("DURER_ROUNDS", rounds).current_dir(crate::root()?).output()?;
    let messages = String::from_utf8_lossy(&output.stdout).into_owned();
    let skipped: Vec<&str> = messages.lines().filter(|line| line.contains("skipped")).collect();
    let failures = if output.status.success() { Vec::new() } else { messages.lines().map(String::from).collect() };
    Ok(Outcome { tried: attack.count, failures, note: skipped.iter().map(|line| format!("; {line}")).collect() })
}

fn kills(attack: &Attack) -> Result<Outcome> {
    let done = crate::torture::kills_in(&attack.durer, attack.folder.path(), attack.count, attack.seed);
    Ok(Outcome {
        tried: attack.count,
        failures: done.err().into_iter().map(|e| format!("{e:#}")).collect(),
        note: String::new(),
    })
}

/// Waits at most `most` for a child process. Otherwise kills it and returns `None`.
fn wait_for(child: &mut std::process::Child, most: Duration) -> Result<Option<Duration>> {
    let start = Instant::now();
    while start.elapsed() < most {
        if child.try_wait()?.is_some() {
            return Ok(Some(start.elapsed()));
        }
        std::thread::sleep(Duration::from_millis(2));
    }
    child.kill()?;
    child.wait()?;
    Ok(None)
}

/// Returns inputs of earlier attacks, if they are available.
fn inputs() -> Vec<PathBuf> {
    let folder = crate::corpus().join("faults/attack");
    let entries = std::fs::read_dir(folder).into_iter().flatten().flatten();
    let mut paths: Vec<PathBuf> = entries.map(|entry| entry.path()).filter(|path| path.is_file()).collect();
    paths.sort();
    paths
}

/// Returns the name of a file, without its folder.
fn name(path: &Path) -> String {
    path.file_name().unwrap_or_default().to_string_lossy().into_owned()
}
