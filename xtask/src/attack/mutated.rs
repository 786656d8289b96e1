//! Attack `mutated`: reads, compiles and renders (at 16 x 16) mutated files of all formats. Worker
//! processes do this, so that an abort or a hang affects only one file.

use super::{Attack, Outcome, name};
use anyhow::{Context, Result};
use durer::diag::{Diagnostics, Files};
use durer::image::{Encoded, decode_linear};
use durer::render::{Control, Job, render};
use durer::sampler::hash;
use durer::{LoadOptions, load_text};
use std::io::{BufRead, BufReader, Write};
use std::panic::{AssertUnwindSafe, catch_unwind};
use std::path::{Path, PathBuf};
use std::process::{Child, Command, ExitCode, Stdio};
use std::sync::Arc;
use std::sync::mpsc::{Receiver, channel};
use std::time::Duration;

/// First argument of a worker process.
pub const WORKER: &str = "--mutated-worker";
/// Limits: bytes of an original file, seconds per file, KiB of address space of a worker, and bytes
/// of memory for a render.
const MAX_BYTES: u64 = 64 << 10;
const SECONDS: u64 = 20;
const SPACE: u64 = 4_000_000;
const MEMORY: u64 = 256 << 20;

const SCENES: [&str; 16] = [
    "txt", "json", "gltf", "glb", "pbrt", "xml", "dae", "rad", "3mf", "usda", "usdc", "usdz", "obj", "off", "ply",
    "stl",
];
const PICTURES: [&str; 11] = ["png", "bmp", "tga", "ppm", "pfm", "hdr", "exr", "jpg", "jpeg", "webp", "ktx2"];

/// Returns the original files: small files of the repository and the corpus, and seeds of the fuzz
/// targets.
fn originals(only: &str) -> Result<Vec<(PathBuf, String)>> {
    let mut found = Vec::new();
    let root = crate::root()?;
    for folder in [root.join("scenes"), root.join("fuzz/seeds"), crate::corpus()] {
        collect(&folder, 6, &mut found);
    }
    found.retain(|(_, ending)| only.is_empty() || ending == only);
    found.sort();
    Ok(found)
}

fn collect(folder: &Path, depth: usize, found: &mut Vec<(PathBuf, String)>) {
    for entry in std::fs::read_dir(folder).into_iter().flatten().flatten() {
        let path = entry.path();
        if path.is_dir() && depth > 0 {
            collect(&path, depth - 1, found);
            continue;
        }
        // A seed has no extension, but its folder is named after its format.
        let lower = |part: Option<&std::ffi::OsStr>| part.unwrap_or_default().to_string_lossy().to_lowercase();
        let ending = match lower(path.extension()) {
            ending if ending.is_empty() => match lower(folder.file_name()).as_str() {
                "scene" => "txt".into(),
                "threemf" => "3mf".into(),
                other => other.to_string(),
            },
            ending => ending,
        };
        let small = entry.metadata().is_ok_and(|metadata| metadata.is_file() && metadata.len() <= MAX_BYTES);
        if small && SCENES.iter().chain(&PICTURES).any(|known| *known == ending) {
            found.push((path, ending));
        }
    }
}

/// Returns the bytes of a file after a few random changes.
fn mutated(mut bytes: Vec<u8>, seed: u64, number: u64) -> Vec<u8> {
    const WORDS: [&[u8]; 12] = [
        b"0",
        b"-1",
        b"1e38",
        b"nan",
        b"4294967295",
        b"65536",
        b"\0",
        b"\xff\xff\xff\xff",
        b"\x7f\xff",
        b"{",
        b"\"",
        b"../",
    ];
    let mut place = 0;
    let mut random = |below: usize| {
        place += 1;
        (hash(seed, number as u32, place, (number >> 32) as u32, 0) % below.max(1) as u64) as usize
    };
    for _ in 0..1 + random(4) {
        let (at, longest) = (random(bytes.len()), 1 + random(64));
        let length = 1 + random(longest);
        let end = (at + length).min(bytes.len());
        match random(7) {
            0 if !bytes.is_empty() => {
                let bit = random(8);
                bytes[at] ^= 1 << bit;
            }
            1 if !bytes.is_empty() => bytes[at] = random(256) as u8,
            2 => drop(bytes.drain(at..end)),
            3 => {
                let piece = bytes[at..end].to_vec();
                let to = random(bytes.len() + 1);
                drop(bytes.splice(to..to, piece));
            }
            4 => {
                let word = WORDS[random(WORDS.len())];
                drop(bytes.splice(at..end, word.iter().copied()));
            }
            5 => {
                // Replace a number in the text.
                let digit = |b: &u8| b.is_ascii_digit();
                let from = at + bytes[at..].iter().position(digit).unwrap_or(0);
                let to = from + bytes[from..].iter().take_while(|b| digit(b)).count();
                let word = WORDS[random(6)];
                drop(bytes.splice(from..to, word.iter().copied()));
            }
            _ => bytes.truncate(at),
        }
    }
    bytes
}

/// Reads, compiles and renders a file. Errors are allowed, panics are not.
fn tried(path: &Path, ending: &str, bytes: Vec<u8>) {
    if PICTURES.contains(&ending) {
        if let Ok(encoded) = Encoded::open(&bytes, &format!("x.{ending}")) {
            let _ = encoded.read(MEMORY, decode_linear);
        }
        return;
    }
    let options = LoadOptions { memory: Some(MEMORY), threads: Some(1), ..LoadOptions::default() };
    let (mut files, mut diagnostics) = (Files::default(), Diagnostics::default());
    let path = path.with_extension(ending);
    let loaded = load_text(&path, bytes.into(), &options, &mut files, &mut diagnostics);
    let Some(world) = loaded.and_then(|loaded| loaded.compile(&options, &mut files, &mut diagnostics)) else { return };
    let usual = Job::default();
    let job = Job { width: 16, height: 16, sampling: usual.sampling.with_samples(1), ..usual };
    let control = Control {
        threads: Some(1),
        time_limit: Some(Duration::from_secs(2)),
        memory: Some(MEMORY),
        ..Control::default()
    };
    let _ = render(&world, &job, &Arc::new(control));
}

/// Runs a worker. The arguments are the seed, the first number, the end of the range, and the
/// extension of the files.
pub fn work(arguments: &[String]) -> Result<ExitCode> {
    let number = |i: usize| -> Result<u64> { Ok(arguments.get(i).context("a number")?.parse()?) };
    let (seed, first, end) = (number(0)?, number(1)?, number(2)?);
    let originals = originals(arguments.get(3).map_or("", String::as_str))?;
    let mut out = std::io::stdout();
    for number in first..end {
        writeln!(out, "{number}")?;
        out.flush()?;
        let (path, ending) = &originals[number as usize % originals.len()];
        let bytes = mutated(std::fs::read(path)?, seed, number);
        if catch_unwind(AssertUnwindSafe(|| tried(path, ending, bytes))).is_err() {
            writeln!(out, "panic {number}")?;
        }
    }
    Ok(ExitCode::SUCCESS)
}

fn start(attack: &Attack, first: u64, end: u64) -> Result<(Child, Receiver<String>)> {
    let limit = format!("ulimit -v {SPACE}; exec \"$0\" \"$@\"");
    let mut command = Command::new("bash");
    command.args(["-c", &limit]).arg(std::env::current_exe()?).args(["attack", WORKER]);
    command.args([attack.seed, first, end].map(|number| number.to_string())).arg(&attack.only);
    let mut child = command.stdin(Stdio::null()).stdout(Stdio::piped()).stderr(Stdio::null()).spawn()?;
    let lines = BufReader::new(child.stdout.take().context("its output")?).lines();
    let (outcome, heard) = channel();
    std::thread::spawn(move || lines.map_while(Result::ok).try_for_each(|line| outcome.send(line)));
    Ok((child, heard))
}

/// Runs the attack.
pub fn run(attack: &Attack) -> Result<Outcome> {
    let originals = originals(&attack.only)?;
    anyhow::ensure!(!originals.is_empty(), "there are no files of the kind `{}`", attack.only);
    let (mut failures, mut next) = (Vec::new(), 0);
    let kept = crate::root()?.join("target/attack");
    let mut keep = |number: u64, why: &str| -> Result<()> {
        let (path, ending) = &originals[number as usize % originals.len()];
        std::fs::create_dir_all(&kept)?;
        let file = kept.join(format!("{}-{number}.{ending}", attack.seed));
        std::fs::write(&file, mutated(std::fs::read(path)?, attack.seed, number))?;
        failures.push(format!("{why}: {} of {}", file.display(), name(path)));
        Ok(())
    };
    while next < attack.count {
        let (mut child, lines) = start(attack, next, attack.count)?;
        let mut at = next;
        let why = loop {
            match lines.recv_timeout(Duration::from_secs(SECONDS)) {
                Ok(line) => match line.strip_prefix("panic ") {
                    Some(number) => keep(number.parse()?, "panic")?,
                    None => at = line.parse()?,
                },
                Err(std::sync::mpsc::RecvTimeoutError::Timeout) => {
                    child.kill()?;
                    break Some("no end");
                }
                Err(_) => break None,
            }
        };
        let status = child.wait()?;
        if status.success() {
            break;
        }
        keep(at, why.unwrap_or("abort"))?;
        next = at + 1;
    }
    Ok(Outcome { tried: attack.count, failures, note: format!("; {} originals", originals.len()) })
}
