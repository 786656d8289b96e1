//! `cargo xtask torture`: tests programs that are killed while they render and save, full disks,
//! and read-only folders.

use crate::build::build_durer;
use anyhow::{Context, Result, bail, ensure};
use durer::image::{FORMATS, read};
use durer::render::PartialRender;
use durer::sampler::hash;
use std::fs;
use std::path::{Path, PathBuf};
use std::process::{Command, ExitCode, Output, Stdio};
use std::time::Instant;

/// Options of the render that is killed.
const WORK: &str = "--size 160x120 --samples 64 --checkpoint-every 10ms --threads 2 --quiet --resume --hash";

/// Runs `cargo xtask torture`.
pub fn run(arguments: &[String]) -> Result<ExitCode> {
    let number = |name: &str, usual: u64| -> Result<u64> {
        crate::value(arguments, name)
            .map_or(Ok(usual), |value| value.parse().with_context(|| format!("{name} needs a number")))
    };
    let folder = tempfile::tempdir()?;
    let scene = crate::root()?.join("scenes/whitted.txt");
    let bench = TortureTest { durer: build_durer()?, scene, folder: folder.path().into() };
    kills(&bench, number("--kills", 100)?, number("--seed", 1)?)?;
    full_disks(&bench, number("--offsets", 50)?)?;
    Ok(ExitCode::SUCCESS)
}

/// Program, scene and temporary folder of the torture tests.
struct TortureTest {
    durer: PathBuf,
    scene: PathBuf,
    folder: PathBuf,
}

impl TortureTest {
    fn render(&self, options: &str, output: &Path) -> Command {
        let mut command = Command::new(&self.durer);
        command.arg("render").arg(&self.scene).arg("-o").arg(output).args(options.split_whitespace());
        command.stdin(Stdio::null()).stdout(Stdio::piped()).stderr(Stdio::piped());
        command
    }

    /// Creates an empty folder.
    fn path(&self, name: &str) -> Result<PathBuf> {
        let place = self.folder.join(name);
        fs::create_dir_all(&place)?;
        Ok(place)
    }
}

fn names(folder: &Path) -> Result<Vec<String>> {
    let mut names = Vec::new();
    for entry in fs::read_dir(folder)? {
        names.push(entry?.file_name().to_string_lossy().into_owned());
    }
    names.sort();
    Ok(names)
}

fn last_line(output: &Output) -> String {
    String::from_utf8_lossy(&output.stdout).lines().last().unwrap_or_default().to_string()
}

/// Runs the kill test of [`kills`] with a program in a folder.
pub fn kills_in(durer: &Path, folder: &Path, count: u64, seed: u64) -> Result<()> {
    let scene = crate::root()?.join("scenes/whitted.txt");
    kills(&TortureTest { durer: durer.into(), scene, folder: folder.into() }, count, seed)
}

/// Starts the program repeatedly and kills it at random times, until there were `kills` kills. The
/// final film must be the same as without kills.
fn kills(bench: &TortureTest, kills: u64, seed: u64) -> Result<()> {
    let (calm, wild) = (bench.path("calm")?.join("p.exr"), bench.path("wild")?.join("p.exr"));
    let start = Instant::now();
    let reference = bench.render(WORK, &calm).output()?;
    let (expected, usual) = (last_line(&reference), start.elapsed());
    ensure!(expected.len() == 64, "no hash: {reference:?}");
    let (mut killed, mut finished, mut leftover, mut parts) = (0, 0, 0, 0);
    while killed < kills {
        let mut child = bench.render(WORK, &wild).spawn()?;
        // Some kills happen during start-up, most during rendering, and some during saving.
        let share = (hash(seed, killed as u32, finished, 0, 0) >> 11) as f64 / (1_u64 << 53) as f64;
        std::thread::sleep(usual.mul_f64(share * 0.4));
        child.kill()?;
        let output = child.wait_with_output()?;
        if output.status.code().is_some() {
            ensure!(output.status.success(), "{}", String::from_utf8_lossy(&output.stderr));
            finished += 1;
            ensure!(last_line(&output) == expected, "the hash differs after {killed} kills");
            fs::remove_file(&wild)?;
            continue;
        }
        killed += 1;
        for name in names(wild.parent().context("a folder")?)? {
            let path = wild.with_file_name(&name);
            match name.as_str() {
                "p.exr" => drop(read(&fs::read(path)?, &name).with_context(|| format!("damaged: {name}"))?),
                "p.exr.part" => {
                    PartialRender::read(&fs::read(path)?).with_context(|| format!("damaged: {name}"))?;
                    parts += 1;
                }
                _ => leftover += 1,
            }
        }
    }
    let output = bench.render(WORK, &wild).output()?;
    ensure!(last_line(&output) == expected, "the final hash differs");
    ensure!(fs::read(&wild)? == fs::read(&calm)?, "the final file differs");
    let left = names(wild.parent().context("a folder")?)?;
    ensure!(left == ["p.exr"], "files left over: {left:?}");
    println!(
        "{killed} kills: {parts} checkpoints read, none damaged; {finished} runs finished, all with the same hash; \
         {leftover} temporary files seen, 0 left at the end"
    );
    Ok(())
}

/// Tests every image writer on a disk with space for only some bytes, and on a read-only disk.
fn full_disks(bench: &TortureTest, offsets: u64) -> Result<()> {
    let mut writers: Vec<(String, String)> =
        FORMATS.iter().map(|format| (format!("p.{}", format.extensions[0]), "--size 48x36".into())).collect();
    writers.push(("p.part".into(), "--size 48x36 --shard 1/2".into()));
    for (name, options) in &writers {
        let whole = bench.path("whole")?.join(name);
        ensure!(bench.render(&format!("{options} --quiet"), &whole).output()?.status.success(), "cannot make {name}");
        let size = fs::metadata(&whole)?.len();
        for i in 0..offsets {
            let limit = size * i / offsets;
            let place = bench.path("limited")?;
            let path = place.join(name);
            fs::write(&path, "old")?;
            // With SIGXFSZ ignored, a write beyond the limit fails as on a full disk.
            let inner = bench.render(&format!("{options} --quiet"), &path);
            let mut command = Command::new("sh");
            command.args(["-c", "trap '' XFSZ; exec prlimit --fsize=\"$0\" \"$@\"", &limit.to_string()]);
            let output = command.arg(inner.get_program()).args(inner.get_args()).output()?;
            refused(&output, "cannot write", name, limit)?;
            ensure!(fs::read(&path)? == b"old", "{name}: the old file is not intact at {limit}");
            ensure!(names(&place)? == [name.clone()], "{name}: files left over at {limit}: {:?}", names(&place)?);
            fs::remove_file(path)?;
        }
        // Each try has fewer free pages, and never enough for the file.
        let small =
            tiny_disk(bench, name, options, "head -c \"$FILL\" /dev/zero > filler", size.div_ceil(PAGE).min(10))?;
        let read_only = tiny_disk(bench, name, options, "mount -o remount,ro .", 1)?;
        println!("{name:<7}{size:>7} bytes: {offsets} limits; {small} full disks; {read_only} read-only disks");
    }
    Ok(())
}

/// Block size of the test disk in bytes.
const PAGE: u64 = 4096;

/// Renders to a small separate disk, after the shell command `spoil`. Returns the number of tries,
/// or 0 if disks cannot be mounted.
fn tiny_disk(bench: &TortureTest, name: &str, options: &str, spoil: &str, tries: u64) -> Result<u64> {
    const SCRIPT: &str = "mount -t tmpfs -o size=64k tmpfs \"$0\" || exit 99; cd \"$0\"; echo old > \"$NAME\"
        eval \"$SPOIL\" 2> /dev/null; \"$@\" 2>&1; code=$?
        [ \"$(cat \"$NAME\")\" = old ] || exit 98; [ -z \"$(ls -A | grep -v filler | grep -vx \"$NAME\")\" ] || exit 97; exit $code";
    let place = bench.path("disk")?;
    for i in 0..tries {
        let inner = bench.render(&format!("{options} --quiet --threads 1"), &place.join(name));
        let mut command = Command::new("unshare");
        command.args(["-Urm", "sh", "-c", SCRIPT]).arg(&place).arg(inner.get_program()).args(inner.get_args());
        // The old file occupies one of the sixteen pages of the disk.
        let fill = (15 - i) * PAGE;
        let output = command.env("NAME", name).env("SPOIL", spoil).env("FILL", fill.to_string()).output()?;
        match output.status.code() {
            // This user is not allowed to mount disks.
            Some(99) | None => return Ok(0),
            Some(98) => bail!("{name}: the old file is not intact"),
            Some(97) => bail!("{name}: files left over"),
            _ => refused(&output, "cannot write", name, fill)?,
        }
    }
    Ok(tries)
}

fn refused(output: &Output, words: &str, name: &str, limit: u64) -> Result<()> {
    let messages = [&output.stderr[..], &output.stdout].concat();
    let messages = String::from_utf8_lossy(&messages);
    ensure!(output.status.code().is_some_and(|code| code != 0), "{name} at {limit}: {:?} {messages}", output.status);
    ensure!(messages.contains(words), "{name} at {limit}: no reason in {messages}");
    Ok(())
}
