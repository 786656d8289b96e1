//! `cargo xtask hashes`: prints hashes of the pictures and messages for all scenes, the course and
//! the sample files, one per line, for later comparison. A refactoring must not change any line.
//!
//! A line consists of a kind, a path (with options, or with the name of a picture) and the hash,
//! separated by tabs:
//!
//! | kind | hash of |
//! | --- | --- |
//! | `film` | the film, as `durer render --hash` prints it; or the exit code of a refusal |
//! | `pixels` | a picture of that film, in single precision |
//! | `course` | a picture that `durer course` writes |
//! | `converted` | all files that `durer convert` writes |
//! | `error` | none: the first error message, as text |
//! | `messages` | what these commands print on standard error |
//! | `info`, `check` | what `durer info` and `durer check` print |
//!
//! Messages exclude the paths of temporary files, and `info` excludes bytes of memory.

use anyhow::{Context, Result, ensure};
use durer::source::Digest;
use std::collections::{BTreeMap, BTreeSet, HashSet};
use std::fs::{self, File};
use std::io::IsTerminal;
use std::path::{Path, PathBuf};
use std::process::{Command, ExitCode, Stdio};
use std::sync::atomic::{AtomicUsize, Ordering::Relaxed};
use std::sync::{Mutex, PoisonError};
use std::thread;
use std::time::{Duration, Instant};

/// Number of cases that run at the same time, each with one thread.
const WORKERS: usize = 2;

/// Time limit of a case. It is many times that of the slowest case, because the machine can be
/// busy.
const LIMIT: Duration = Duration::from_secs(240);

/// Memory limit of a case. If it depended on the machine's memory, each machine would reject
/// different files.
const MEMORY: &str = "4G";

/// Extensions of scenes and models, in lower case.
const EXTENSIONS: [&str; 15] =
    ["3mf", "dae", "glb", "gltf", "obj", "pbrt", "ply", "rad", "rif", "stl", "txt", "usda", "usdc", "usdz", "xml"];

/// Commands that render, each with one thread.
const RENDER: &str = "render --hash --threads 1 --no-checkpoint -o @p.pfm";
const PROGRAM: &str = "course --threads 1";

/// Options for our own scenes: first all pictures with few samples, then the other integrators and
/// samplers at a lower resolution.
const SCENE_OPTIONS: [&str; 6] = [
    "--size 64x48 --samples 4 --show color,depth,normals,geometric-normals,position,uv,barycentric,albedo,object,\
     material,luminance,illuminance,sample-count,variance",
    "--size 32x24 --samples 2 --integrator whitted --transparent-shadows",
    "--size 32x24 --samples 2 --integrator path --color spectral",
    "--size 32x24 --samples 2 --integrator photons --photons 2000",
    "--size 32x24 --samples 4 --integrator ao --sampler jittered --filter gaussian",
    "--size 16x12 --samples 16 --integrator path --adaptive --accel grid",
];

/// Options for the files of other programs.
const FOREIGN_OPTIONS: &str = "--size 32x24 --samples 2";

/// Options for course scenes without a reference picture.
const COURSE: &str = "-size 48 48 -output @color.tga -depth 0 20 @depth.tga -normals @normals.tga";

/// Folders with meshes, for course scenes without their own.
const MESHES: &str = "--assets course/scenes/f04 --assets course/scenes/f16";

/// Separator between the name of a case and the name of its picture.
const PICTURE: &str = ": ";

/// Value of each line, by kind and path: the hash, or the text of an error.
type Lines = BTreeMap<(String, String), String>;

/// One run of the program whose outputs are hashed.
struct Case {
    kind: Kind,
    /// Path on the lines of this case.
    name: String,
    /// Working directory, chosen so that messages have relative paths.
    folder: PathBuf,
    /// Arguments. A word that begins with [`OUTPUT`] is an output file.
    arguments: Vec<String>,
}

/// Command that a case runs, which determines the outputs to hash.
#[derive(Clone, Copy, PartialEq)]
enum Kind {
    /// `durer render`.
    Render,
    /// `durer course`.
    Course,
    /// `durer convert`.
    Convert,
    /// `durer info`.
    Info,
    /// `durer check`.
    Check,
}

/// Prefix of the names of output files in arguments.
const OUTPUT: &str = "@";

/// Exit code and output of a finished run of the program.
struct RunOutcome {
    /// Exit code; `None` if a signal ended the program.
    code: Option<i32>,
    late: bool,
    out: Vec<u8>,
    errors: Vec<u8>,
}

/// Runs `cargo xtask hashes`.
pub fn run(arguments: &[String]) -> Result<ExitCode> {
    let value = |name| crate::value(arguments, name);
    let only = value("--only");
    let durer = match value("--program") {
        Some(program) => Path::new(program).canonicalize().with_context(|| program.clone())?,
        None => crate::build::build_durer()?,
    };
    let old = value("--against").map(|file| {
        let text = fs::read_to_string(file).with_context(|| file.clone())?;
        parsed(&text).with_context(|| format!("{file} is not an output of `cargo xtask hashes`"))
    });
    let mut old = old.transpose()?;
    let cases = cases(only)?;
    ensure!(!cases.is_empty(), "no case matches");
    let lines = all(&durer, &cases)?;
    let text = format_lines(&lines);
    if let Some(file) = value("-o") {
        fs::write(file, &text).with_context(|| file.clone())?;
    }
    let Some(old) = &mut old else {
        if value("-o").is_none() {
            print!("{text}");
        }
        eprintln!("{} lines of {} runs", lines.len(), cases.len());
        return Ok(ExitCode::SUCCESS);
    };
    if let Some(only) = only {
        old.retain(|(_, path), _| path.split(PICTURE).next().is_some_and(|name| name.contains(only.as_str())));
    }
    let differences = differences(old, &lines);
    differences.iter().for_each(|difference| println!("{difference}"));
    eprintln!("{} lines of {} runs: {} differ", lines.len(), cases.len(), differences.len());
    Ok(if differences.is_empty() { ExitCode::SUCCESS } else { ExitCode::FAILURE })
}

fn cases(only: Option<&String>) -> Result<Vec<Case>> {
    let mut cases = Vec::new();
    let root = crate::root()?;
    for folder in ["scenes", "scenes/photographs"] {
        for file in files_below(&root, folder, false)? {
            cases.extend(SCENE_OPTIONS.iter().enumerate().map(|(i, options)| {
                let name = if i == 0 { file.clone() } else { format!("{file} {options}") };
                Case::new(Kind::Render, name, &root, &format!("{RENDER} {options}"), Some(&file))
            }));
            read_only(&root, &file, "", &mut cases);
        }
    }
    let corpus = crate::corpus().canonicalize().context("the sample files are missing; set DURER_CORPUS")?;
    course(&corpus, &mut cases)?;
    for folder in ["samples", "meshes"] {
        // In these folders, text files are licences and tables.
        for file in files_below(&corpus, folder, true)?.iter().filter(|file| !file.ends_with(".txt")) {
            cases.push(Case::new(
                Kind::Render,
                file.clone(),
                &corpus,
                &format!("{RENDER} {FOREIGN_OPTIONS}"),
                Some(file),
            ));
            cases.push(converted(&corpus, file, "json", ""));
        }
    }
    cases.retain(|case| only.is_none_or(|only| case.name.contains(only.as_str())));
    Ok(cases)
}

/// Adds the cases of a scene that do not render.
fn read_only(folder: &Path, file: &str, assets: &str, cases: &mut Vec<Case>) {
    cases.extend(["json", "txt", "glb"].map(|ending| converted(folder, file, ending, assets)));
    let case = |kind, words| Case::new(kind, file.into(), folder, &format!("{words} {assets}"), Some(file));
    cases.push(case(Kind::Info, "info"));
    cases.push(case(Kind::Check, "check --size 64x48 --samples 4"));
}

fn converted(folder: &Path, file: &str, ending: &str, assets: &str) -> Case {
    let words = format!("convert -o {OUTPUT}p.{ending} {assets}");
    Case::new(Kind::Convert, format!("{file} as {ending}"), folder, &words, Some(file))
}

/// Adds the cases with reference pictures, then those of the other course scenes.
fn course(corpus: &Path, cases: &mut Vec<Case>) -> Result<()> {
    let mut runs = BTreeSet::new();
    for row in crate::course::rows(&corpus.join("course"))? {
        if !row.arguments.is_empty() {
            runs.insert([row.dialect, row.program, row.arguments]);
        }
    }
    let mut known = HashSet::new();
    for [dialect, program, arguments] in runs {
        let words: Vec<&str> = arguments.split_whitespace().collect();
        let input = words.iter().skip_while(|word| **word != "-input").nth(1).context("a row has no -input")?;
        known.insert(format!("course/scenes/{dialect}/{input}"));
        let outputs: HashSet<usize> = crate::course::files(&words).map(|(_, at)| at).collect();
        let mut all = format!("{PROGRAM} --program {program}");
        for (at, word) in words.iter().enumerate() {
            all = all + " " + if outputs.contains(&at) { OUTPUT } else { "" } + word;
        }
        let folder = corpus.join("course/scenes").join(&dialect);
        cases.push(Case::new(Kind::Course, format!("{dialect} {program} {arguments}"), &folder, &all, None));
    }
    for file in files_below(corpus, "course/scenes", true)?.iter().filter(|file| file.ends_with(".txt")) {
        read_only(corpus, file, MESHES, cases);
        if !known.contains(file) {
            let dialect = file.split('/').nth(2).context("a scene without a folder")?;
            // The meshes of 2003 are in the folder of 2004.
            let meshes = if dialect == "f03" { "f04" } else { dialect };
            let words = format!("{PROGRAM} --dialect {dialect} --assets course/scenes/{meshes} {COURSE} -input");
            cases.push(Case::new(Kind::Course, format!("{dialect} {file}"), corpus, &words, Some(file)));
        }
    }
    Ok(())
}

/// Returns the scenes and models in a folder as sorted paths relative to `root`. Includes
/// subfolders if `deep` is true.
fn files_below(root: &Path, folder: &str, deep: bool) -> Result<Vec<String>> {
    let mut found = Vec::new();
    for entry in fs::read_dir(root.join(folder)).with_context(|| folder.to_string())? {
        let entry = entry?;
        let name =
            entry.file_name().into_string().ok().with_context(|| format!("{folder}: a file name is not Unicode"))?;
        let ending = name.rsplit_once('.').map_or("", |(_, ending)| ending).to_lowercase();
        let path = format!("{folder}/{name}");
        if entry.path().is_dir() {
            if deep {
                found.extend(files_below(root, &path, deep)?);
            }
        } else if EXTENSIONS.contains(&ending.as_str()) {
            found.push(path);
        }
    }
    found.sort();
    Ok(found)
}

/// Runs all cases and returns their lines.
fn all(durer: &Path, cases: &[Case]) -> Result<Lines> {
    let (next, done) = (AtomicUsize::new(0), AtomicUsize::new(0));
    let lines = Mutex::new(Lines::new());
    let visible = std::io::stderr().is_terminal();
    let work = || -> Result<()> {
        while let Some(case) = cases.get(next.fetch_add(1, Relaxed)) {
            let found = case.lines(durer).with_context(|| case.name.clone())?;
            let mut lines = lines.lock().unwrap_or_else(PoisonError::into_inner);
            for (kind, path, value) in found {
                let before = lines.insert((kind.into(), path.clone()), value);
                ensure!(before.is_none(), "duplicate line: {kind} of {path}");
            }
            let done = done.fetch_add(1, Relaxed) + 1;
            if visible {
                eprint!("\r{done} of {} runs", cases.len());
            }
        }
        Ok(())
    };
    thread::scope(|scope| {
        let workers: Vec<_> = (0..WORKERS).map(|_| scope.spawn(work)).collect();
        workers
            .into_iter()
            .try_for_each(|worker| worker.join().unwrap_or_else(|panic| std::panic::resume_unwind(panic)))
    })?;
    if visible {
        eprint!("\r\x1b[K");
    }
    Ok(lines.into_inner().unwrap_or_else(PoisonError::into_inner))
}

impl Case {
    /// Creates a case from command-line words and a file.
    fn new(kind: Kind, name: String, folder: &Path, words: &str, file: Option<&str>) -> Case {
        let arguments = words.split_whitespace().chain(file).map(String::from).collect();
        Case { kind, name, folder: folder.into(), arguments }
    }

    /// Runs the case. Returns kind, path and value of each line.
    fn lines(&self, durer: &Path) -> Result<Vec<(&'static str, String, String)>> {
        let place = tempfile::tempdir()?;
        let files = place.path().join("files");
        fs::create_dir(&files)?;
        let mut command = Command::new(durer);
        command.current_dir(&self.folder);
        for argument in &self.arguments {
            match argument.strip_prefix(OUTPUT) {
                Some(name) => command.arg(files.join(name)),
                None => command.arg(argument),
            };
        }
        if self.kind != Kind::Course {
            command.args(["--memory", MEMORY]);
        }
        let ended = ended(&mut command, place.path())?;
        let kind = self.kind.word();
        let line = |kind, value: String| (kind, self.name.clone(), value);
        if ended.late {
            return Ok(vec![line(kind, format!("timeout after {} s", LIMIT.as_secs()))]);
        }
        let code = ended.code.map_or_else(|| "a signal".into(), |code| code.to_string());
        let plain = |text: &[u8]| {
            let text = String::from_utf8_lossy(text).replace(&*place.path().to_string_lossy(), "PLACE");
            text.replace(&*self.folder.to_string_lossy(), "FOLDER")
        };
        let (out, errors) = (plain(&ended.out), plain(&ended.errors));
        if let Kind::Info | Kind::Check = self.kind {
            // Memory sizes depend on internal data structures, which may change.
            let lines = out.lines().filter(|line| !line.starts_with("memory "));
            let messages = format!("{code}\n{}\n{errors}", lines.collect::<Vec<_>>().join("\n"));
            return Ok(vec![line(kind, Digest::of(messages.as_bytes()).to_string())]);
        }
        let mut lines = vec![line("messages", Digest::of(errors.as_bytes()).to_string())];
        if ended.code != Some(0) {
            let first = errors.lines().find(|line| line.starts_with("error")).or_else(|| errors.lines().next());
            lines.push(line("error", first.unwrap_or_default().replace('\t', " ")));
            lines.push(line(kind, format!("refused: {code}")));
            return Ok(lines);
        }
        let mut written = Vec::new();
        hashed(&files, "", &mut written)?;
        match self.kind {
            // Print one line for all files of a scene.
            Kind::Convert => {
                written.sort();
                lines.push(line(kind, Digest::of(format!("{written:?}").as_bytes()).to_string()));
            }
            Kind::Render => {
                lines.push(line(kind, out.lines().last().unwrap_or_default().into()));
                // The output is `p.pfm`, or files such as `p.depth.pfm` if there are several.
                lines.extend(written.into_iter().map(|(name, digest)| {
                    match name.strip_prefix("p.").and_then(|name| name.strip_suffix(".pfm")) {
                        None => line("pixels", digest),
                        Some(picture) => ("pixels", format!("{}{PICTURE}{picture}", self.name), digest),
                    }
                }));
            }
            _ => {
                let named = |(name, digest)| (kind, format!("{}{PICTURE}{name}", self.name), digest);
                lines.extend(written.into_iter().map(named));
            }
        }
        Ok(lines)
    }
}

impl Kind {
    /// Returns the first word of the kind's lines.
    fn word(self) -> &'static str {
        match self {
            Kind::Render => "film",
            Kind::Course => "course",
            Kind::Convert => "converted",
            Kind::Info => "info",
            Kind::Check => "check",
        }
    }
}

/// Hashes the files in a folder recursively, by relative path.
fn hashed(folder: &Path, path: &str, found: &mut Vec<(String, String)>) -> Result<()> {
    for entry in fs::read_dir(folder.join(path))? {
        let entry = entry?;
        let name = format!("{path}{}", entry.file_name().to_string_lossy());
        if entry.path().is_dir() {
            hashed(folder, &format!("{name}/"), found)?;
        } else {
            found.push((name, Digest::of(&fs::read(entry.path())?).to_string()));
        }
    }
    Ok(())
}

/// Runs a command with its output redirected to files, and kills it after the time limit.
fn ended(command: &mut Command, place: &Path) -> Result<RunOutcome> {
    let [out, errors] = ["out", "errors"].map(|name| place.join(name));
    let mut child = command.stdin(Stdio::null()).stdout(File::create(&out)?).stderr(File::create(&errors)?).spawn()?;
    let start = Instant::now();
    let mut late = false;
    let status = loop {
        if let Some(status) = child.try_wait()? {
            break status;
        }
        if start.elapsed() > LIMIT {
            late = true;
            child.kill()?;
            break child.wait()?;
        }
        thread::sleep(Duration::from_millis(2));
    };
    Ok(RunOutcome { code: status.code(), late, out: fs::read(out)?, errors: fs::read(errors)? })
}

fn format_lines(lines: &Lines) -> String {
    lines.iter().map(|((kind, path), value)| format!("{kind}\t{path}\t{value}\n")).collect()
}

/// Parses lines written by [`format_lines`]; `None` for any other text.
fn parsed(text: &str) -> Option<Lines> {
    let line = |line: &str| {
        let (kind, rest) = line.split_once('\t')?;
        let (path, value) = rest.split_once('\t')?;
        Some(((kind.into(), path.into()), value.into()))
    };
    text.lines().map(line).collect()
}

/// Returns the lines that differ or that only one side has.
fn differences(old: &Lines, new: &Lines) -> Vec<String> {
    let keys: BTreeSet<_> = old.keys().chain(new.keys()).collect();
    let absent = "absent".to_string();
    let of = |lines: &'_ Lines, key| lines.get(key).unwrap_or(&absent).clone();
    let differing = keys.into_iter().filter(|key| old.get(*key) != new.get(*key));
    differing.map(|key| format!("{}\t{}\t{} -> {}", key.0, key.1, of(old, key), of(new, key))).collect()
}

#[test]
fn changed_new_and_missing_lines_are_reported() {
    let lines = |text: &str| parsed(text).unwrap();
    let old = lines("film\ta b.txt\t01\nfilm\tgone.txt\t02\npixels\ta b.txt: depth\t03\n");
    let new = lines("film\ta b.txt\t01\nfilm\tnew.txt\t02\npixels\ta b.txt: depth\t04\n");
    assert_eq!(differences(&old, &old), [""; 0]);
    assert_eq!(lines(&format_lines(&new)), new);
    let outcome = ["film\tgone.txt\t02 -> absent", "film\tnew.txt\tabsent -> 02", "pixels\ta b.txt: depth\t03 -> 04"];
    assert_eq!(differences(&old, &new), outcome);
    assert_eq!(parsed("film without tabs\n"), None);
}
