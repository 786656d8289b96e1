//! Implements `durer live`, which shows a scene in the browser.

use crate::failure::{Failure, invalid_input};
use crate::terminal::print_line;
use clap::Args;
use durer_live::{Server, SessionFiles};
use std::path::{Path, PathBuf};
use std::process::{Command, Stdio};

/// Show a scene in the browser: edit it, orbit around it, and explain its pixels
#[derive(Args)]
#[command(after_help = "Examples:
  durer live scene.txt
  durer live model.glb --open

The page is served on this machine only, at a URL with a random token. To reach it from another machine, use
`ssh -L 8000:127.0.0.1:PORT`.")]
pub struct LiveArgs {
    /// Scene or model file
    pub scene: PathBuf,
    /// Port to listen on; 0 for any free port
    #[arg(long, default_value_t = 0)]
    pub port: u16,
    /// Open the page in the browser
    #[arg(long)]
    pub open: bool,
}

/// Runs `durer live`.
pub fn run(args: &LiveArgs) -> Result<(), Failure> {
    readable(&args.scene)?;
    serve(SessionFiles { file: Some(args.scene.clone()), lesson: None }, args.port, args.open)
}

/// Fails if a file cannot be opened as a scene.
fn readable(path: &Path) -> Result<(), Failure> {
    // Opening a pipe would block the program.
    let compiled = match std::fs::metadata(path) {
        Ok(metadata) if !metadata.is_file() => {
            return Err(invalid_input(format!("`{}` is not a file", path.display())));
        }
        Ok(_) => std::fs::File::open(path).map(drop),
        Err(error) => Err(error),
    };
    compiled.map_err(|error| invalid_input(format!("cannot open `{}`: {error}", path.display())))
}

/// Serves a lesson that a teacher has written in Markdown.
pub fn lesson(path: &Path) -> Result<(), Failure> {
    readable(path)?;
    serve(SessionFiles { file: None, lesson: Some(path.to_path_buf()) }, 0, false)
}

fn serve(start: SessionFiles, port: u16, open: bool) -> Result<(), Failure> {
    let page = if start.lesson.is_some() { "#/lesson" } else { "" };
    let server = Server::bind(port, start);
    let server = server.map_err(|error| invalid_input(format!("cannot listen on port {port}: {error}")))?;
    let address = format!("{}{page}", server.address().map_err(anyhow::Error::from)?);
    print_line(&format!("{address}\nPress Ctrl-C to stop"));
    if open {
        let opener = if cfg!(target_os = "macos") { "open" } else { "xdg-open" };
        // Ignore errors because the address is printed and can be copied.
        let _ = Command::new(opener).arg(&address).stdout(Stdio::null()).stderr(Stdio::null()).spawn();
    }
    crate::progress::idle();
    server.run(|| false).map_err(anyhow::Error::from)?;
    Ok(())
}
