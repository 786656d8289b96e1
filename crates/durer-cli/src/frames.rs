//! Implements `--frames` and `--turntable`, which render the pictures of an animation to one file
//! each.

use crate::failure::{Failure, invalid_input};
use crate::options::RenderArgs;
use crate::picture::{WatchState, output_of, render_picture};
use clap::Args;
use durer::compile::AssetCache;
use std::path::{Path, PathBuf};
use std::sync::Arc;

/// Frames of an animation
#[derive(Args, Clone)]
#[command(next_help_heading = "Animation")]
pub struct FramesArgs {
    /// Frames to render: 7, 1-100, or 0-90:10 for every tenth frame. The frame number replaces %d
    /// or %04d in SCENE, PICTURE, --camera and --view-file. If only PICTURE contains one of them,
    /// each frame is a time in the model's animation
    #[arg(long, value_name = "FRAMES")]
    pub frames: Option<Frames>,
    /// Frames per second of the model's animation
    #[arg(long, value_name = "NUMBER", default_value_t = 24.0, requires = "frames", value_parser = rate)]
    pub fps: f64,
    /// Rotate once around the model or scene in this many frames; without --frames, render all of
    /// them
    #[arg(long, value_name = "NUMBER", value_parser = clap::value_parser!(u16).range(1..=9999))]
    pub turntable: Option<u16>,
}

/// Range of frame numbers given by `--frames`: first frame, last frame, and step.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Frames {
    pub first: u32,
    pub last: u32,
    pub step: u32,
}

impl std::str::FromStr for Frames {
    type Err = &'static str;

    fn from_str(text: &str) -> Result<Self, Self::Err> {
        let number = |text: &str| text.parse().ok().filter(|&number| number <= MAX_FRAME).ok_or(EXPECTED);
        let (range, step) = text.split_once(':').map_or((text, Ok(1)), |(range, step)| (range, number(step)));
        let (first, last) = range.split_once('-').unwrap_or((range, range));
        let frames = Frames { first: number(first)?, last: number(last)?, step: step? };
        if frames.step == 0 || frames.last < frames.first { Err(EXPECTED) } else { Ok(frames) }
    }
}

const MAX_FRAME: u32 = 9_999_999;
const EXPECTED: &str = "expected frames from 0 to 9999999 in ascending order, for example 7, 1-100 or 0-90:10";

impl Frames {
    /// Iterates over the frame numbers.
    pub fn numbers(self) -> impl Iterator<Item = u32> {
        (self.first..=self.last).step_by(self.step as usize)
    }

    /// Returns the number of frames.
    pub fn count(self) -> u32 {
        (self.last - self.first) / self.step + 1
    }
}

/// Parses a frame rate, which must be greater than 0.
fn rate(text: &str) -> Result<f64, String> {
    let rate = text.parse().ok().filter(|&rate: &f64| rate.is_finite() && rate > 0.0);
    rate.ok_or("expected a number above 0".into())
}

/// Source of the changes between the frames of an animation.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum MotionSource {
    /// The camera rotates once around the model in this many frames.
    Turntable(u16),
    /// The frame number replaces `%d` in file names.
    Names,
    /// The model's own animation plays at this many frames per second.
    Time(f64),
}

impl FramesArgs {
    /// Returns true if the options request an animation.
    pub fn is_requested(&self) -> bool {
        self.frames.is_some() || self.turntable.is_some()
    }

    /// Returns the requested frames and what changes between them, or `None` if no animation is
    /// requested. `names` are the texts that can contain a placeholder for the frame number.
    ///
    /// # Errors
    /// Fails if all frames would be the same.
    pub fn resolve(&self, scene: &Path, names: &[&str]) -> Result<Option<(Frames, MotionSource)>, Failure> {
        let all = |count: u16| Frames { first: 0, last: u32::from(count) - 1, step: 1 };
        let Some(frames) = self.frames.or(self.turntable.map(all)) else { return Ok(None) };
        let extension = scene.extension().unwrap_or_default().to_string_lossy().to_lowercase();
        let moves = match self.turntable {
            Some(count) => MotionSource::Turntable(count),
            None if names.iter().any(|name| place(name).is_some()) => MotionSource::Names,
            None if ["gltf", "glb"].contains(&extension.as_str()) => MotionSource::Time(self.fps),
            None => {
                return Err(invalid_input(
                    "--frames: all frames would be equal; put %d in the name of the scene, --camera or --view-file, \
                     pass --turntable, or render a glTF file with an animation",
                ));
            }
        };
        Ok(Some((frames, moves)))
    }
}

/// Finds the first `%d` or `%04d` in a name. Returns its start, its end, and the number of digits.
pub fn place(name: &str) -> Option<(usize, usize, usize)> {
    name.match_indices('%').find_map(|(from, _)| {
        let digits: String = name[from + 1..].chars().take_while(char::is_ascii_digit).collect();
        let to = from + 1 + digits.len();
        let known = digits.is_empty() || (digits.starts_with('0') && digits.len() <= 2);
        (known && name[to..].starts_with('d')).then(|| (from, to + 1, digits.parse().unwrap_or(0)))
    })
}

/// Replaces each placeholder in a name with the frame number.
pub fn numbered(name: &str, frame: u32) -> String {
    match place(name) {
        Some((from, to, digits)) => format!("{}{frame:0digits$}{}", &name[..from], numbered(&name[to..], frame)),
        None => name.into(),
    }
}

/// Returns the file name pattern of an animation. For example, `picture.png` becomes
/// `picture.%04d.png`.
pub fn pattern(path: &str) -> String {
    if place(path).is_some() {
        return path.into();
    }
    let extension = Path::new(path).extension().unwrap_or_default().to_string_lossy();
    Path::new(path).with_extension(format!("%04d.{extension}")).to_string_lossy().into_owned()
}

/// Renders the frames in order.
pub fn run(args: &mut RenderArgs, frames: Frames, moves: MotionSource) -> Result<(), Failure> {
    let scene_defaults = &args.reading.scene_defaults;
    let own = scene_defaults.camera.is_some() || scene_defaults.view_file.is_some() || scene_defaults.turned.is_some();
    if matches!(moves, MotionSource::Turntable(_)) && own {
        return Err(invalid_input(
            "--turntable sets the view of each frame: remove --camera, --view-file and --turned",
        ));
    }
    if matches!(moves, MotionSource::Time(_)) && scene_defaults.at.is_some() {
        return Err(invalid_input("--frames sets the time of each frame: remove --at"));
    }
    let utf8 =
        |path: &Path| path.to_str().map(String::from).ok_or_else(|| invalid_input(format!("{path:?} is not UTF-8")));
    let (scene, output) = (utf8(&args.scene)?, pattern(&utf8(&output_of(args))?));
    let (camera, view_file) =
        (scene_defaults.camera.clone(), scene_defaults.view_file.as_deref().map(utf8).transpose()?);
    // Read the meshes and images that frames share only once.
    let cache = Arc::new(AssetCache::default());
    for frame in frames.numbers() {
        (args.scene, args.output) = (numbered(&scene, frame).into(), Some(numbered(&output, frame).into()));
        let scene_defaults = &mut args.reading.scene_defaults;
        scene_defaults.camera = camera.as_deref().map(|name| numbered(name, frame));
        scene_defaults.view_file = view_file.as_deref().map(|name| PathBuf::from(numbered(name, frame)));
        match moves {
            MotionSource::Turntable(count) => {
                scene_defaults.turned = Some((360.0 * f64::from(frame) / f64::from(count)) as f32)
            }
            MotionSource::Time(rate) => scene_defaults.at = Some((f64::from(frame) / rate) as f32),
            MotionSource::Names => {}
        }
        render_picture(args, None, &WatchState::keeping(&cache))?;
    }
    Ok(())
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn frames_are_parsed() {
        let read = |text: &str| text.parse::<Frames>().map(|frames| frames.numbers().collect::<Vec<_>>());
        assert_eq!(read("7"), Ok(vec![7]));
        assert_eq!(read("1-4"), Ok(vec![1, 2, 3, 4]));
        assert_eq!(read("0-90:40"), Ok(vec![0, 40, 80]));
        assert_eq!("0-90:40".parse::<Frames>().unwrap().count(), 3);
        for wrong in ["", "-3", "4-1", "1-4:0", "1-", "1-4:", "a", "1,2", "1-4-5", "10000000", "99999999999"] {
            assert_eq!(read(wrong), Err(EXPECTED), "{wrong}");
        }
    }

    #[test]
    fn frame_numbers_replace_placeholders() {
        assert_eq!(numbered("a.%04d.txt", 7), "a.0007.txt");
        assert_eq!(numbered("%d/%03d", 12345), "12345/12345");
        assert_eq!(numbered("100%.txt", 1), "100%.txt");
        assert_eq!(numbered("%4d %x é%d", 2), "%4d %x é2");
        assert_eq!(pattern("out/a.png"), "out/a.%04d.png");
        assert_eq!(pattern("out/%d.png"), "out/%d.png");
    }
}
