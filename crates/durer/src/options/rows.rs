//! Tables of the options for loading, for output pictures and for execution.

#![allow(clippy::unit_arg, reason = "each row assigns and succeeds in one expression")]

use super::RenderOptions;
use super::memory::Memory;
use crate::job::{JobOption, OptionForm, three_numbers};
use durer_diag::did_you_mean;
use durer_render::compile::AccelKind;
use durer_render::film::aov::AOVS;
use durer_render::render::ShardBy;
use durer_scene::dialect::{Dialect, Quirk};
use durer_scene::math::Vec3;
use durer_scene::scene::{Axis, DefaultLighting, PresetView};

/// A row of a table of options. It contains the definition of the option and a function that parses
/// and sets the option.
pub(super) struct Row {
    pub option: JobOption,
    pub set: fn(&mut RenderOptions, &str) -> Result<(), String>,
}

const fn row(
    name: &'static str,
    form: OptionForm,
    set: fn(&mut RenderOptions, &str) -> Result<(), String>,
    doc: &'static str,
) -> Row {
    Row { option: JobOption { name, doc, form }, set }
}

const NUMBER_EXPECTED: &str = "expected a number";

/// Options for reading and compiling a scene.
pub(super) const LOADING: &[Row] = &[
    row(
        "dialect",
        OptionForm::Words(|| Dialect::ALL.map(Dialect::name).to_vec()),
        |options, text| Ok(options.load.dialect = Dialect::from_name(text)),
        "Dialect of the scene, with all quirks of the official program for that year [default: detected, without \
         quirks]",
    ),
    row(
        "compat",
        OptionForm::Value("NAME"),
        |options, text| text.split(',').try_for_each(|name| Ok(options.load.compat.push(compat(name)?))),
        "Enable a quirk of an official program, or disable it with the prefix `no-`; `durer dialects` lists all \
         quirks",
    ),
    row(
        "strict",
        OptionForm::Flag,
        |options, text| Ok(options.load.strict = flag(text)?),
        "Accept only the words of the dialect: no comments, no extensions",
    ),
    row(
        "allow-outside",
        OptionForm::Flag,
        |options, text| Ok(options.load.allow_outside = flag(text)?),
        "Allow the scene to read files outside its own folder",
    ),
    row(
        "assets",
        OptionForm::Value("FOLDER"),
        |options, text| Ok(options.load.assets.push(text.into())),
        "Folder to search for missing meshes and textures; can be given several times",
    ),
    row(
        "memory",
        OptionForm::Value("SIZE"),
        |options, text| Ok(options.memory = Memory::parse(text)?),
        "Memory limit for the scene and the picture: a size such as 512M or 8G, or a percentage of the available \
         memory, which control groups and `ulimit -v` can limit [default: 80%]",
    ),
    row(
        "accel",
        OptionForm::Words(|| vec!["bvh", "grid", "none"]),
        |options, text| {
            options.load.accel = match text {
                "grid" => AccelKind::Grid(None),
                "none" => AccelKind::None,
                _ => AccelKind::Bvh,
            };
            Ok(())
        },
        "Acceleration structure for the objects [default: bvh]",
    ),
    row(
        "grid",
        OptionForm::Value("XxYxZ"),
        |options, text| Ok(options.load.accel = AccelKind::Grid(Some(grid_cells(text)?))),
        "Number of grid cells along each axis; implies --accel grid [default: based on the number of objects]",
    ),
    row(
        "up",
        OptionForm::Words(|| vec!["x", "y", "z"]),
        |options, text| {
            options.load.scene_defaults.up = Some(match text {
                "x" => Axis::X,
                "y" => Axis::Y,
                _ => Axis::Z,
            });
            Ok(())
        },
        "Axis of the model that points up [default: y; z for Radiance, 3MF and STL]",
    ),
    row(
        "view",
        OptionForm::Words(|| VIEWS.map(|row| row.0).to_vec()),
        |options, text| Ok(options.load.scene_defaults.view = VIEWS.iter().find(|row| row.0 == text).map(|row| row.1)),
        "View to render a model from; overrides the model's own camera [default: three-quarter if the model has no \
         camera]",
    ),
    row(
        "studio",
        OptionForm::Words(|| STUDIOS.map(|row| row.0).to_vec()),
        |options, text| {
            Ok(options.load.scene_defaults.lighting = STUDIOS.iter().find(|row| row.0 == text).map(|row| row.1))
        },
        "Lights to render a model with; overrides the model's own lights [default: soft if the model has no lights]",
    ),
    row(
        "environment",
        OptionForm::Value("FILE"),
        |options, text| Ok(options.load.scene_defaults.environment = Some(text.into())),
        "Environment map (.hdr, .exr) that lights the model; overrides the model's own sky and the studio lights",
    ),
    row(
        "environment-rotation",
        OptionForm::Number("DEGREES", f32::is_finite, NUMBER_EXPECTED),
        |options, text| Ok(options.load.scene_defaults.environment_rotation = text.parse().ok()),
        "Rotate the environment map about the up axis by this many degrees [default: 0]",
    ),
    row(
        "add-ground",
        OptionForm::Flag,
        |options, text| Ok(options.load.scene_defaults.ground = flag(text)?),
        "Add a grey ground below the model, for example with --environment",
    ),
    row(
        "view-file",
        OptionForm::Value("FILE"),
        |options, text| Ok(options.load.scene_defaults.view_file = Some(text.into())),
        "Radiance view file (.vf); the last view in it is used as the camera",
    ),
    row(
        "camera",
        OptionForm::Value("NAME"),
        |options, text| Ok(options.load.scene_defaults.camera = Some(text.into())),
        "Name or number of the model's camera to render from [default: the first]",
    ),
    row(
        "variant",
        OptionForm::Value("NAME"),
        |options, text| Ok(options.load.scene_defaults.variant = Some(text.into())),
        "Name or number of the material variant of a glTF file [default: the file's own materials]",
    ),
    row(
        "eye",
        OptionForm::Value("X,Y,Z"),
        |options, text| Ok(options.load.placement.eye = Some(vector(text)?)),
        "Position of the camera in world space, in place of that of the scene; the camera then looks at the center of \
         the scene, or at --target",
    ),
    row(
        "target",
        OptionForm::Value("X,Y,Z"),
        |options, text| Ok(options.load.placement.target = Some(vector(text)?)),
        "Point at which the camera looks, in world space [default: that of the scene]",
    ),
    row(
        "fov",
        OptionForm::Number("DEGREES", |x| x > 0.0 && x < 180.0, "expected degrees, more than 0 and less than 180"),
        |options, text| Ok(options.load.placement.fov = text.parse().ok()),
        "Field of view across the larger side of the picture, in place of that of the scene",
    ),
    row(
        "fit",
        OptionForm::Flag,
        |options, text| Ok(options.load.scene_defaults.fit = flag(text)?),
        "Move the model's own camera along its view direction until the entire model is visible",
    ),
    row(
        "turned",
        OptionForm::Number("DEGREES", f32::is_finite, NUMBER_EXPECTED),
        |options, text| Ok(options.load.scene_defaults.orbit_degrees = text.parse().ok()),
        "Rotate the camera around the model or scene by this many degrees [default: 0]",
    ),
    row(
        "animation",
        OptionForm::Value("NAME"),
        |options, text| Ok(options.load.scene_defaults.animation = Some(text.into())),
        "Animation of a glTF file, by its name or by its number from 0 [default: the first]",
    ),
    row(
        "at",
        OptionForm::Number("SECONDS", |x| x.is_finite() && x >= 0.0, "expected seconds, 0 or more"),
        |options, text| Ok(options.load.scene_defaults.animation_time = text.parse().ok()),
        "Time in the model's animation, in seconds [default: the pose without animation]",
    ),
];

/// Options that select output pictures.
pub(super) const VIEW: &[Row] = &[
    row(
        "crop",
        OptionForm::Value("LEFT,TOP,WIDTHxHEIGHT"),
        |options, text| Ok(options.view.crop = Some(crop(text)?)),
        "Render only this rectangle of the picture, in pixels",
    ),
    row(
        "show",
        OptionForm::Value("PICTURE,..."),
        |options, text| {
            let known = shown();
            let wrong = text.split(',').find(|name| !known.contains(name));
            if wrong.is_some() {
                return Err(format!("expected one of {}", known.join(", ")));
            }
            options.view.show = text.split(',').map(String::from).collect();
            Ok(())
        },
        "Comma-separated list of pictures to write [default: color]",
    ),
];

/// Options for execution, such as threads, time and shards.
pub(super) const EXECUTION: &[Row] = &[
    row(
        "threads",
        OptionForm::Whole(1, 1024),
        |options, text| Ok(options.threads = text.parse().ok()),
        "Number of threads for building and rendering [default: one per processor]",
    ),
    row(
        "tile",
        OptionForm::Whole(8, 4096),
        |options, text| Ok(options.tile = text.parse().ok()),
        "Tile width and height in pixels, a multiple of 8 [default: based on the picture's size]",
    ),
    row(
        "time-limit",
        OptionForm::Value("TIME"),
        |options, text| {
            let time = humantime::parse_duration(text).map_err(|_| "expected a time, for example 30s, 10m or 1h30m")?;
            Ok(options.time_limit = Some(time))
        },
        "Stop after this much time (for example 30s, 10m or 1h30m), but not before every pixel has at least one \
         sample",
    ),
    row(
        "shard",
        OptionForm::Value("INDEX/COUNT"),
        |options, text| {
            let by = options.shard.by;
            options.shard = text.parse()?;
            options.shard.by = by;
            Ok(())
        },
        "Render only one of several parts, to be merged by `durer merge`",
    ),
    row(
        "shard-by",
        OptionForm::Words(|| vec!["tiles", "samples"]),
        |options, text| Ok(options.shard.by = if text == "samples" { ShardBy::Samples } else { ShardBy::Tiles }),
        "Split the picture into parts by tiles or by samples [default: tiles]",
    ),
];

/// Names of the views in which a model can be rendered.
const VIEWS: [(&str, PresetView); 11] = [
    ("three-quarter", PresetView::ThreeQuarter),
    ("front", PresetView::Front),
    ("back", PresetView::Back),
    ("left", PresetView::Left),
    ("right", PresetView::Right),
    ("side", PresetView::Right),
    ("top", PresetView::Top),
    ("bottom", PresetView::Bottom),
    ("iso", PresetView::Iso),
    ("iso-left", PresetView::IsoLeft),
    ("iso-back", PresetView::IsoBack),
];

/// Names of the light setups for models.
const STUDIOS: [(&str, DefaultLighting); 3] =
    [("none", DefaultLighting::None), ("soft", DefaultLighting::Soft), ("sun", DefaultLighting::Sun)];

fn shown() -> Vec<&'static str> {
    std::iter::once("color").chain(AOVS.iter().map(|aov| aov.name)).collect()
}

fn flag(text: &str) -> Result<bool, String> {
    match text {
        "" | "on" => Ok(true),
        "off" => Ok(false),
        _ => Err("expected no value".into()),
    }
}

/// Returns the help text of an option in these tables, or an empty text for other names.
pub fn doc(name: &str) -> &'static str {
    let mut rows = LOADING.iter().chain(VIEW).chain(EXECUTION);
    rows.find(|row| row.option.name == name).map_or("", |row| row.option.doc)
}

/// Parses the name of a quirk to turn on, or to turn off if the name has the prefix `no-`.
///
/// # Errors
///
/// Returns a message if the quirk is unknown.
pub fn compat(text: &str) -> Result<(Quirk, bool), String> {
    let (name, on) = text.strip_prefix("no-").map_or((text, true), |name| (name, false));
    Quirk::from_name(name).map(|compat| (compat, on)).ok_or_else(|| {
        let names = Quirk::ALL.iter().map(|row| row.1);
        match did_you_mean(name, names) {
            Some(near) => format!("no such quirk; did you mean `{near}`?"),
            None => "no such quirk; see `durer dialects`".into(),
        }
    })
}

/// Parses a part of a picture as left, top, width and height, for example `10,20,64x48`.
///
/// # Errors
///
/// Returns a message for any other text.
pub fn crop(text: &str) -> Result<(u32, u32, u32, u32), String> {
    let numbers = || {
        let mut parts = text.splitn(3, ',');
        let (left, top, size) = (parts.next()?, parts.next()?, parts.next()?);
        let (width, height) = size.split_once(['x', 'X'])?;
        let number = |text: &str| text.trim().parse::<u32>().ok();
        Some((number(left)?, number(top)?, number(width)?, number(height)?))
    };
    numbers()
        .filter(|crop| crop.2 > 0 && crop.3 > 0)
        .ok_or_else(|| "expected LEFT,TOP,WIDTHxHEIGHT, for example 10,20,64x48".into())
}

/// Parses three numbers, for example `0,0.8,0`.
///
/// # Errors
///
/// Returns a message for any other text.
pub fn vector(text: &str) -> Result<Vec3, String> {
    three_numbers(text).ok_or_else(|| "expected three numbers, for example 0,0.8,0".into())
}

/// Parses the numbers of grid cells along the axes, for example `10x10x10`.
///
/// # Errors
///
/// Returns a message for any other text.
pub fn grid_cells(text: &str) -> Result<[u32; 3], String> {
    let numbers: Option<Vec<u32>> = text.split(['x', 'X']).map(|n| n.parse().ok()).collect();
    let cells: Option<[u32; 3]> = numbers.and_then(|n| n.try_into().ok());
    cells.filter(|c| !c.contains(&0)).ok_or_else(|| "expected XxYxZ, for example 10x10x10".into())
}
