//! Renders a scene file in any format: `cargo run --example render_file -- scene.txt picture.png`.

use durer::prelude::*;
use std::path::PathBuf;

pub(crate) fn main() -> Result<(), Error> {
    let mut arguments = std::env::args_os().skip(1).map(PathBuf::from).filter(|path| path.is_file());
    let own = concat!(env!("CARGO_MANIFEST_DIR"), "/../../scenes/glass.txt");
    let scene = arguments.next().unwrap_or_else(|| own.into());
    let picture = std::env::temp_dir().join(format!("render_file-{}.png", std::process::id()));

    let world = durer::open(&scene)?;
    for found in world.diagnostics().iter() {
        println!("{}", found.message);
    }
    let options = RenderJob::for_scene(&world).size((64, 48)).samples(1_u32);
    Renderer::new(&world, options)?.finish()?.save(&picture)?;

    let size = std::fs::metadata(&picture).map_or(0, |file| file.len());
    println!("{}: {size} bytes", picture.display());
    assert!(size > 0);
    let _ = std::fs::remove_file(picture);
    Ok(())
}
