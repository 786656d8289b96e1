//! Shared helpers for tests: a temporary folder with scenes, in which the program is run.

#![allow(dead_code, reason = "each test file is a separate program that uses a part")]

pub mod browser;

use durer::image::{Image, Image8, read, read8};
use std::path::{Path, PathBuf};
use std::process::{Command, Output, Stdio};
use std::time::{Duration, Instant};
use tempfile::TempDir;

/// A sphere above a mirror-like floor.
pub const SCENE: &str = "PerspectiveCamera { center 0 1 8 direction 0 -0.1 -1 up 0 1 0 angle 40 }
Lights { numLights 1 DirectionalLight { direction -1 -2 -1 color 0.9 0.9 0.8 } }
Background { color 0.2 0.1 0.5 ambientLight 0.2 0.2 0.2 }
Materials { numMaterials 2
  Material { diffuseColor 0.8 0.3 0.2 }
  Material { diffuseColor 0.2 0.4 0.2 reflectiveColor 0.5 0.5 0.5 } }
Group { numObjects 2
  MaterialIndex 0 Sphere { center 0 0.5 0 radius 1 }
  MaterialIndex 1 Plane { normal 0 1 0 offset -0.5 } }
";

/// Mirrors and glass that split every ray into two. With many bounces, no pixel is ever finished.
pub const ENDLESS: &str = "PerspectiveCamera { center 0 0 0 direction 0.3 0.1 -1 up 0 1 0 angle 60 }
Lights { numLights 1 PointLight { position 0 0 0 color 1 1 1 } }
Materials { numMaterials 1
  Material { reflectiveColor 1 1 1 transparentColor 1 1 1 indexOfRefraction 1.5 } }
Group { numObjects 3 MaterialIndex 0
  Plane { normal 0 0 1 offset -2 } Plane { normal 0 0 1 offset 2 } Sphere { center 0 0 -1 radius 0.5 } }
";

/// Temporary folder with `scene.txt` and `endless.txt`, in which tests run the program.
pub struct TestFolder {
    folder: TempDir,
}

/// Exit code and output of one run of the program.
pub struct ProgramOutput {
    pub code: Option<i32>,
    pub out: String,
    pub err: String,
}

impl TestFolder {
    /// Creates the folder.
    pub fn new() -> TestFolder {
        let folder = TestFolder { folder: TempDir::new().unwrap() };
        folder.write("scene.txt", SCENE);
        folder.write("endless.txt", ENDLESS);
        folder
    }

    /// Returns the path of a file in the folder.
    pub fn path(&self, name: &str) -> PathBuf {
        self.folder.path().join(name)
    }

    /// Writes a file.
    pub fn write(&self, name: &str, content: impl AsRef<[u8]>) {
        std::fs::write(self.path(name), content).unwrap();
    }

    /// Prepares a run of the program. The arguments are separated by spaces.
    pub fn command(&self, arguments: &str) -> Command {
        let mut command = Command::new(durer());
        command.current_dir(self.folder.path()).args(arguments.split_whitespace()).stdin(Stdio::null());
        command
    }

    /// Runs the program. The arguments are separated by spaces.
    pub fn run(&self, arguments: &str) -> ProgramOutput {
        ProgramOutput::of(self.command(arguments).output().unwrap())
    }

    /// Runs the program and checks its exit code.
    #[track_caller]
    pub fn expect_exit(&self, code: i32, arguments: &str) -> ProgramOutput {
        let output = self.run(arguments);
        assert_eq!(output.code, Some(code), "{arguments}\n{}", output.err);
        assert!(!output.err.contains("panicked"), "{}", output.err);
        output
    }

    /// Runs the program. Checks that the program fails with these words and writes no file.
    #[track_caller]
    pub fn expect_failure(&self, code: i32, arguments: &str, words: &[&str]) {
        let before = self.names();
        let output = self.expect_exit(code, arguments);
        for word in words {
            assert!(output.err.contains(word), "{arguments}\n`{word}` is not in:\n{}", output.err);
        }
        assert_eq!(output.out, "", "{arguments}");
        assert_eq!(self.names(), before, "{arguments}");
    }

    /// Returns the sorted names of the files in the folder.
    pub fn names(&self) -> Vec<String> {
        let entries = std::fs::read_dir(self.folder.path()).unwrap();
        let mut names: Vec<_> = entries.map(|e| e.unwrap().file_name().into_string().unwrap()).collect();
        names.sort();
        names
    }

    /// Reads a file.
    pub fn bytes(&self, name: &str) -> Vec<u8> {
        std::fs::read(self.path(name)).unwrap_or_else(|e| panic!("{name}: {e}"))
    }

    /// Reads a picture as linear light.
    pub fn image(&self, name: &str) -> Image {
        read(&self.bytes(name), name).unwrap()
    }

    /// Reads an 8-bit picture.
    pub fn image8(&self, name: &str) -> Image8 {
        read8(&self.bytes(name), name).unwrap()
    }

    /// Interrupts a run of the program after some time. Returns its output and the time it took to
    /// end.
    #[cfg(unix)]
    pub fn interrupted(&self, arguments: &str, after: Duration) -> (ProgramOutput, Duration) {
        self.send_signals(arguments, after, &["INT"])
    }

    /// Sends several signals to a run in quick succession, as in [`Self::interrupted`].
    #[cfg(unix)]
    pub fn send_signals(&self, arguments: &str, after: Duration, signals: &[&str]) -> (ProgramOutput, Duration) {
        let mut command = self.command(arguments);
        let child = command.stdout(Stdio::piped()).stderr(Stdio::piped()).spawn().unwrap();
        std::thread::sleep(after);
        let (start, id) = (Instant::now(), child.id().to_string());
        for signal in signals {
            let sent = Command::new("kill").args([&format!("-{signal}"), &id]).stderr(Stdio::null()).status();
            assert!(sent.unwrap().success() || *signal != signals[0]);
        }
        let output = ProgramOutput::of(child.wait_with_output().unwrap());
        (output, start.elapsed())
    }

    /// Runs a shell script in which `$DURER` stands for the program, for example under resource
    /// limits.
    #[cfg(unix)]
    pub fn shell(&self, script: &str) -> ProgramOutput {
        let mut command = Command::new("bash");
        command.args(["-c", script]).env("DURER", durer()).current_dir(self.folder.path()).stdin(Stdio::null());
        ProgramOutput::of(command.output().unwrap())
    }
}

impl ProgramOutput {
    fn of(output: Output) -> ProgramOutput {
        let text = |bytes: Vec<u8>| String::from_utf8(bytes).unwrap();
        ProgramOutput { code: output.status.code(), out: text(output.stdout), err: text(output.stderr) }
    }
}

/// Returns the path of the program.
pub fn durer() -> &'static str {
    env!("CARGO_BIN_EXE_durer")
}

/// Returns the folder with the course's scenes and pictures if it is available.
pub fn corpus() -> Option<PathBuf> {
    let beside = || Path::new(env!("CARGO_MANIFEST_DIR")).join("../../../shared");
    let folder = std::env::var_os("DURER_CORPUS").map_or_else(beside, PathBuf::from).join("course");
    if !folder.is_dir() {
        println!("skipped: {} not found", folder.display());
        return None;
    }
    Some(folder)
}
