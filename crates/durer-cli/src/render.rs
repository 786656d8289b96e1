//! Implements `durer render`, which renders one picture, an animation, or a picture again and again
//! with `--watch`.

use crate::failure::{Failure, invalid_input};
use crate::frames::FramesArgs;
use crate::open::is_stream;
use crate::options::RenderArgs;
use crate::picture::{Pixel, WatchState, render_picture};
use crate::values::pixel;
use crate::{frames, watching};
use clap::Args;
use std::path::Path;

/// Render a scene or a model to a picture
#[derive(Args)]
#[command(after_help = "Examples:
  durer render scene.txt -o picture.png
  durer render model.glb -o picture.png --view iso --studio sun
  durer render model.glb -o frame.png --turntable 36
  durer render walk.%04d.txt -o walk.png --frames 1-100
  durer render scene.txt -o picture.png --watch
  durer render scene.txt -o picture.png --samples 256 --terminal
  durer render scene.txt -o picture.exr --size 1920x1080 --samples 64
  durer render scene.txt -o picture.exr --noise-threshold 0.01 --time-limit 10m --preview preview.png
  durer render scene.txt -o picture.exr --samples 256 --resume
  durer render scene.txt -o three.part --shard 3/16
  durer render scene.txt -o picture.png --show color,depth,normals --depth-range 9 10
  durer render room.txt -o room.png --show luminance,illuminance --light-range 10 100000 --light-log
  durer render scene.txt -o picture.png --dialect f04 --shadows --bounces 4 --transfer course
  cat scene.txt | durer render - -o - > picture.png
  durer render scene.txt -o dots.png --show samples --size 9x9 --sampler jittered --samples 9

SCENE is a file in the course's language or a model: glTF, GLB, USD, pbrt, Mitsuba, Radiance, COLLADA, 3MF, PLY, OBJ,
STL. A model without a camera and lights is framed automatically and lit by studio lights. `durer words` explains the words
of the language.

The extension of PICTURE selects the format: png, jpg, webp, exr, hdr, tga, bmp, ppm, pfm. Several pictures are written as
layers of one EXR file, or as separate files: picture.depth.png and so on. SCENE `-` is read from standard input, and
`-o -` writes a PNG file to standard output.

Long renders save their work to PICTURE.part at intervals. --resume continues from this file, and --restart discards it;
without either option, durer stops instead of overwriting it. The file is removed when the picture is complete. On Ctrl-C,
SIGTERM and SIGHUP, the work done so far is saved.")]
pub struct RenderCommand {
    #[command(flatten)]
    pub render: RenderArgs,
    #[command(flatten)]
    pub frames: FramesArgs,
    /// Print the linear colour of one pixel instead of writing a picture
    #[arg(long, value_name = "X,Y", value_parser = pixel)]
    pub pixel: Option<(u32, u32)>,
    /// Print the colour of only this sample of the pixel
    #[arg(long, value_name = "NUMBER", requires = "pixel")]
    pub sample: Option<u32>,
}

/// Runs `durer render`.
pub fn run(mut command: RenderCommand) -> Result<(), Failure> {
    if command.render.scene.is_dir() {
        let message = format!("`{}` is not a regular file but a folder", command.render.scene.display());
        return Err(invalid_input(message));
    }
    let (args, scene_defaults) = (&command.render, &command.render.reading.scene_defaults);
    let view = scene_defaults.view_file.as_deref().unwrap_or(Path::new("")).to_string_lossy();
    let names = [&args.scene.to_string_lossy(), scene_defaults.camera.as_deref().unwrap_or_default(), &view];
    match (command.frames.resolve(&args.scene, &names)?, args.watch) {
        (Some((frames, moves)), _) => {
            let work = &args.work;
            if work.checkpoint.is_some()
                || work.preview.is_some()
                || work.terminal.is_some()
                || args.watch
                || command.pixel.is_some()
                || args.stats_file().is_some()
            {
                return Err(invalid_input(
                    "--checkpoint, --preview, --terminal, --watch, --stats=FILE and --pixel apply to one picture, \
                     not to an animation",
                ));
            }
            frames::run(&mut command.render, frames, moves)
        }
        (None, true) if is_stream(&args.scene) => Err(invalid_input("--watch needs a file, not standard input")),
        (None, true) => {
            // Each change starts a new picture, so unfinished work is not saved.
            command.render.work.no_checkpoint = true;
            watching::run(&command.render)
        }
        (None, false) => {
            let sample = command.sample;
            render_picture(args, command.pixel.map(|place| Pixel { place, sample }), &WatchState::default())
        }
    }
}

#[cfg(test)]
mod tests {
    use super::RenderCommand;
    use clap::{Args, Command, FromArgMatches};

    #[test]
    fn renamed_options_keep_their_old_names() {
        let command = || RenderCommand::augment_args(Command::new("render"));
        let read = |option: &str, value: &str| {
            let matches = command().try_get_matches_from(["render", "scene.txt", option, value]);
            matches.and_then(|matches| RenderCommand::from_arg_matches(&matches)).unwrap()
        };
        for option in ["--min-throughput", "--weight"] {
            assert_eq!(read(option, "0.5").render.job.options.get("min-throughput").as_deref(), Some("0.5"));
        }
        for option in ["--noise-threshold", "--noise"] {
            assert_eq!(read(option, "0.25").render.job.options.get("noise-threshold").as_deref(), Some("0.25"));
        }
        for option in ["--time-limit", "--time"] {
            assert_eq!(read(option, "90s").render.work.time, Some(std::time::Duration::from_secs(90)));
        }
        let help = command().render_long_help().to_string();
        for (shown, hidden) in
            [("--min-throughput <", "--weight "), ("--noise-threshold <", "--noise "), ("--time-limit <", "--time ")]
        {
            assert!(help.contains(shown) && !help.contains(hidden), "{shown} {hidden}");
        }
    }
}
