//! Tests job files for scenes with hostile names. It uses bash and, if they are installed, YAML and
//! Python parsers.

use super::*;
use durer::sampler::hash;
use std::path::Path;
use std::process::{Command, Stdio};

/// Pieces from which hostile names are built.
const PIECES: [&str; 46] = [
    "a",
    "Z9",
    ".txt",
    "/",
    "-",
    "--output",
    " ",
    "  ",
    "\t",
    "\n",
    "\r",
    "\r\n",
    "\u{b}",
    "\u{c}",
    "\u{1b}[2J",
    "\u{3}",
    "\u{7f}",
    "\u{85}",
    "\u{9b}",
    "\u{2028}",
    "\u{2029}",
    "\u{202e}",
    "\u{feff}",
    "\u{ffff}",
    "é",
    "畫",
    "😀",
    "'",
    "\"",
    "\\",
    "`id`",
    "$(id)",
    "${IFS}",
    "!",
    ";",
    "|",
    "&",
    "#",
    "\n#SBATCH --wrap=id",
    "\nkey: value",
    ": ",
    "{{Param.X}}",
    "@OUTPUT@",
    "@NAME@",
    "%d",
    "*",
];

/// Returns a name built from these pieces. It depends only on `number`.
fn name(number: u32) -> String {
    let random = |i: u32, most: u64| (hash(7, number, i, 0, 0) % most) as usize;
    (0..1 + random(0, 8)).map(|i| PIECES[random(i as u32 + 1, PIECES.len() as u64)]).collect()
}

fn args(template: &str, scene: &str, output: &str, options: &[&str]) -> FarmArgs {
    FarmArgs {
        scene: scene.into(),
        template: template.into(),
        shards: Some(3),
        frames: FramesArgs { frames: None, fps: 24.0, turntable: None },
        output: Some(output.into()),
        options: options.iter().map(ToString::to_string).collect(),
    }
}

/// Returns the number of names, which is `DURER_ROUNDS` times 2000.
fn rounds() -> u32 {
    2000 * std::env::var("DURER_ROUNDS").ok().and_then(|times| times.parse().ok()).unwrap_or(1)
}

fn made(template: &str, number: u32) -> (String, [String; 3]) {
    let [scene, output, camera] = [0, 1, 2].map(|i| name(3 * number + i));
    let text = job_file(&args(template, &scene, &output, &["--camera", &camera]));
    (text.unwrap_or_else(|_| panic!("{scene:?} {output:?}")), [scene, output, camera])
}

/// Returns the output of a program that reads a file as its input, or `None` if the program is not
/// installed.
fn piped(program: &str, arguments: &[&str], input: &Path) -> Option<Vec<u8>> {
    let input = std::fs::File::open(input).unwrap();
    let done = Command::new(program).args(arguments).stdin(input).stderr(Stdio::piped()).output().ok()?;
    assert!(done.status.success(), "{program}: {}", String::from_utf8_lossy(&done.stderr));
    Some(done.stdout)
}

/// Separator between scripts. It does not occur in any script.
const END: char = '\0';

/// Start of a shell script that replaces `durer` by a stub, which prints its arguments.
const STUB: &str = r#"mkdir() { :; }; durer() { printf '%s\0' "$@"; printf '\1\0'; }
    SLURM_ARRAY_TASK_ID=2 JOB_COMPLETION_INDEX=1
    while IFS= read -r -d '' script; do (eval "$script"); printf '\2\0'; done"#;

/// Checks that each script runs `durer` once with exactly the given names as arguments.
fn check_scripts(scripts: &str, names: &[[String; 3]]) {
    let folder = tempfile::tempdir().unwrap();
    let file = folder.path().join("scripts");
    std::fs::write(&file, scripts).unwrap();
    let Some(printed) = piped("bash", &["-c", STUB], &file) else { return println!("skipped: no bash") };
    let printed = String::from_utf8(printed).unwrap();
    let runs: Vec<&str> = printed.split_terminator("\u{2}\0").collect();
    assert_eq!(runs.len(), names.len());
    for (run, [scene, _, camera]) in runs.iter().zip(names) {
        let words: Vec<&str> = run.split_terminator('\0').collect();
        let scene = not_an_option(scene);
        assert_eq!(words[..4], ["render", &scene, "--camera", camera], "{run:?}");
        assert_eq!(words.iter().filter(|word| **word == "\u{1}").count(), 1, "{run:?}");
    }
}

#[test]
fn scene_names_are_quoted_for_bash() {
    // If a name escaped its quotes, the file would have more lines than the template.
    let lines = |template: &str| made_plain(template).lines().count();
    for template in ["slurm", "k8s", "openjd", "dask"] {
        for number in 0..rounds() {
            let (text, names) = made(template, number);
            assert_eq!(text.lines().count(), lines(template), "{names:?}\n{text}");
            let odd = |c: char| c != '\n' && !(' '..='~').contains(&c) && !c.is_alphanumeric();
            assert!(!text.contains(odd), "{names:?}\n{text}");
            let expressions = |text: &str| text.matches("{{").count();
            assert_eq!(expressions(&text), expressions(&made_plain(template)), "{names:?}\n{text}");
        }
    }
    let (mut scripts, mut names) = (String::new(), Vec::new());
    for number in 0..rounds() {
        let (text, own) = made("slurm", number);
        scripts.extend([&text, "\0"]);
        names.push(own);
        // Also check the command in the comment, because users may copy it.
        let comment = text.lines().find(|line| line.contains("durer merge")).unwrap();
        assert!(comment.starts_with("# When all tasks have finished:  durer merge "), "{comment}");
    }
    assert_eq!(scripts.matches(END).count(), names.len());
    check_scripts(&scripts, &names);
}

fn made_plain(template: &str) -> String {
    job_file(&args(template, "a.txt", "a.exr", &["--camera", "b"])).unwrap_or_else(|_| panic!("{template}"))
}

/// Python program that reads YAML documents, each terminated by a zero byte, and prints the shell
/// scripts in them.
const YAML: &str = "
import sys, yaml
loader = getattr(yaml, 'CSafeLoader', yaml.SafeLoader)
for text in sys.stdin.buffer.read().decode().split('\\0')[:-1]:
    job = yaml.load(text, loader)
    if 'spec' in job:
        script = job['spec']['template']['spec']['containers'][0]['args'][0]
        assert sorted(job) == ['apiVersion', 'kind', 'metadata', 'spec'], job
    else:
        assert [s['name'] for s in job['steps']] == ['Render', 'Merge'], job
        script = job['steps'][0]['script']['embeddedFiles'][0]['data'].replace('{{Task.Param.Shard}}', '2')
        script = script.replace('cd --', ': ').replace('$1', '')
    sys.stdout.write(script + '\\0')
";

#[test]
fn scene_names_are_quoted_for_yaml() {
    let folder = tempfile::tempdir().unwrap();
    let file = folder.path().join("documents");
    for template in ["k8s", "openjd"] {
        let all: Vec<_> = (0..rounds()).map(|number| made(template, number)).collect();
        std::fs::write(&file, all.iter().map(|(text, _)| format!("{text}\0")).collect::<String>()).unwrap();
        let has_yaml = Command::new("python3").args(["-c", "import yaml"]).stderr(Stdio::null()).status();
        if !has_yaml.is_ok_and(|status| status.success()) {
            return println!("skipped: no Python with yaml");
        }
        let Some(scripts) = piped("python3", &["-c", YAML], &file) else { return };
        let names: Vec<_> = all.into_iter().map(|(_, names)| names).collect();
        check_scripts(&String::from_utf8(scripts).unwrap(), &names);
    }
}

/// Python program that reads Python programs, each terminated by a zero byte, and prints the names
/// in their string literals.
const PYTHON: &str = "
import ast, sys
for text in sys.stdin.buffer.read().decode().split('\\0')[:-1]:
    calls = [n for n in ast.walk(ast.parse(text)) if isinstance(n, ast.Call) and isinstance(n.func, ast.Attribute)]
    call = lambda name: next(c for c in calls if c.func.attr == name)
    render = call('render')
    words = next(ast.literal_eval(k.value) for k in render.keywords if k.arg == 'words')
    found = [ast.literal_eval(render.args[0]), ast.literal_eval(call('save').args[0]), words[1]]
    sys.stdout.buffer.write(''.join(word + '\\0' for word in found).encode())
";

#[test]
fn scene_names_are_quoted_for_python() {
    let folder = tempfile::tempdir().unwrap();
    let file = folder.path().join("programs");
    let all: Vec<_> = (0..rounds()).map(|number| made("dask", number)).collect();
    std::fs::write(&file, all.iter().map(|(text, _)| format!("{text}\0")).collect::<String>()).unwrap();
    let Some(found) = piped("python3", &["-c", PYTHON], &file) else { return println!("skipped: no Python") };
    let expected: String = all.iter().flat_map(|(_, names)| names).map(|name| format!("{name}\0")).collect();
    assert_eq!(String::from_utf8(found).unwrap(), expected);
}

#[test]
fn frames_are_merged_under_their_own_names() {
    for number in 0..rounds() / 100 {
        let output = format!("{}%03d{}", name(number), name(number + 1));
        let script = format!("frame=7; printf '%s' {}", bash_word_of_frame(&output));
        let done = Command::new("bash").args(["-c", &script]).output().unwrap();
        assert_eq!(String::from_utf8(done.stdout).unwrap(), frames::numbered(&output, 7), "{script}");
    }
}

#[test]
fn job_names_are_valid_host_names() {
    for (stem, name) in [("Room 1", "durer-room-1"), ("", "durer"), ("---", "durer"), ("é", "durer"), ("é1", "durer-1")]
    {
        assert_eq!(job_name(stem), name);
    }
    for number in 0..rounds() {
        let job = job_name(&name(number).repeat(4));
        assert!(job.len() <= MAX_NAME_LENGTH && !job.ends_with('-'), "{job}");
        assert!(job.bytes().all(|b| b.is_ascii_lowercase() || b.is_ascii_digit() || b == b'-'), "{job}");
    }
}

#[test]
fn own_options_can_follow_options_of_render() {
    let moved = |line: &str| -> String {
        let words = own_options_first(line.split(' ').map(Into::into).collect());
        words.iter().map(|word| word.to_str().unwrap()).collect::<Vec<_>>().join(" ")
    };
    assert_eq!(
        moved("durer farm a.txt --samples 8 --shards 3 --size 4x3 -o b.png --fps=25"),
        "durer farm --shards 3 -o b.png --fps=25 a.txt --samples 8 --size 4x3"
    );
    assert_eq!(moved("durer farm a.txt -ob.png -- --shards 3"), "durer farm -ob.png a.txt -- --shards 3");
    assert_eq!(moved("durer render a.txt -o b.png"), "durer render a.txt -o b.png");
}
