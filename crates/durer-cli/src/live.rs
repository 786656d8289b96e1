//! `durer live`: a scene in the browser.

use crate::failure::{Failure, bad};
use crate::terminal::say;
use clap::Args;
use durer_live::Server;
use std::path::PathBuf;
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

pub fn run(args: &LiveArgs) -> Result<(), Failure> {
    if let Err(error) = std::fs::File::open(&args.scene) {
        return Err(bad(format!("{}: {error}", args.scene.display())));
    }
    let server = Server::bind(args.port, Some(args.scene.clone()));
    let server = server.map_err(|error| bad(format!("port {}: {error}", args.port)))?;
    let address = server.address().map_err(anyhow::Error::from)?;
    say(&format!("{address}\nPress Ctrl-C to stop"));
    if args.open {
        let opener = if cfg!(target_os = "macos") { "open" } else { "xdg-open" };
        // Ignore errors: the address is printed and can be copied.
        let _ = Command::new(opener).arg(&address).stdout(Stdio::null()).stderr(Stdio::null()).spawn();
    }
    crate::progress::idle();
    server.run(|| false).map_err(anyhow::Error::from)?;
    Ok(())
}
