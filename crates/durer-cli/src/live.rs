//! `durer live`: a scene in the browser.

use crate::failure::{Failure, bad};
use crate::terminal::say;
use clap::Args;
use durer_live::{Server, Start};
use std::path::{Path, PathBuf};
use std::process::{Command, Stdio};

/// Show a scene in the browser: edit it, go around in it, and ask why a pixel has its colour
#[derive(Args)]
#[command(after_help = "Examples:
  durer live scene.txt
  durer live model.glb --open

The page is served on this machine alone, at an address with a random token. From another machine it is reached by
`ssh -L 8000:127.0.0.1:PORT`.")]
pub struct LiveArgs {
    /// The scene
    pub scene: PathBuf,
    /// Port; 0 for any that is free
    #[arg(long, default_value_t = 0)]
    pub port: u16,
    /// Open the page in the browser
    #[arg(long)]
    pub open: bool,
}

pub fn run(args: &LiveArgs) -> Result<(), Failure> {
    readable(&args.scene)?;
    serve(Start { file: Some(args.scene.clone()), lesson: None }, args.port, args.open)
}

/// Fails if a file cannot be opened.
fn readable(path: &Path) -> Result<(), Failure> {
    std::fs::File::open(path).map(|_| ()).map_err(|error| bad(format!("{}: {error}", path.display())))
}

/// Shows a teacher's own lesson.
pub fn lesson(path: &Path) -> Result<(), Failure> {
    readable(path)?;
    serve(Start { file: None, lesson: Some(path.to_path_buf()) }, 0, false)
}

fn serve(start: Start, port: u16, open: bool) -> Result<(), Failure> {
    let page = if start.lesson.is_some() { "#/lesson" } else { "" };
    let server = Server::bind(port, start);
    let server = server.map_err(|error| bad(format!("port {port}: {error}")))?;
    let address = format!("{}{page}", server.address().map_err(anyhow::Error::from)?);
    say(&format!("{address}\nCtrl-C ends"));
    if open {
        let opener = if cfg!(target_os = "macos") { "open" } else { "xdg-open" };
        // The address is there to be copied where no browser opens.
        let _ = Command::new(opener).arg(&address).stdout(Stdio::null()).stderr(Stdio::null()).spawn();
    }
    crate::progress::idle();
    server.run(|| false).map_err(anyhow::Error::from)?;
    Ok(())
}
