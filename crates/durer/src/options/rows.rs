//! Options that are not the picture's own: reading, view and work.

use super::RenderOptions;
use super::memory::Memory;
use crate::job::{JobOption, OptionForm};
use durer_diag::did_you_mean;
use durer_render::compile::AccelKind;
use durer_render::film::aov::AOVS;
use durer_render::render::ShardBy;
use durer_scene::dialect::{Compat, Dialect};
use durer_scene::scene::{Axis, Studio, View};

/// An option and how its text is understood, once it fits its form.
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

const SAY_NUMBER: &str = "it is a number";

/// How a scene is read and compiled.
pub(super) const READING: &[Row] = &[
    row(
        "dialect",
        OptionForm::Words(|| Dialect::ALL.map(Dialect::name).to_vec()),
        |to, text| Ok(to.load.dialect = Dialect::from_name(text)),
        "The scene's dialect, with all quirks of that year's program [default: guessed, without quirks]",
    ),
    row(
        "compat",
        OptionForm::Value("NAME"),
        |to, text| text.split(',').try_for_each(|name| Ok(to.load.compat.push(compat(name)?))),
        "Turn an old program's quirk on, or off with `no-` before it (see `durer dialects`)",
    ),
    row(
        "strict",
        OptionForm::Flag,
        |to, text| Ok(to.load.strict = flag(text)?),
        "Allow only the words of the dialect: no comments, nothing of our own",
    ),
    row(
        "allow-outside",
        OptionForm::Flag,
        |to, text| Ok(to.load.allow_outside = flag(text)?),
        "Let the scene name files outside its own folder",
    ),
    row(
        "assets",
        OptionForm::Value("FOLDER"),
        |to, text| Ok(to.load.assets.push(text.into())),
        "Look for missing meshes and pictures in this folder too",
    ),
    row(
        "memory",
        OptionForm::Value("SIZE"),
        |to, text| Ok(to.memory = Memory::parse(text)?),
        "Refuse what needs more memory: bytes as in 512M or 8G, or a share of the machine's or control group's \
         [default: 80%]",
    ),
    row(
        "accel",
        OptionForm::Words(|| vec!["bvh", "grid", "none"]),
        |to, text| {
            to.load.accel = match text {
                "grid" => AccelKind::Grid(None),
                "none" => AccelKind::None,
                _ => AccelKind::Bvh,
            };
            Ok(())
        },
        "What finds the objects that a ray may hit [default: bvh]",
    ),
    row(
        "grid",
        OptionForm::Value("XxYxZ"),
        |to, text| Ok(to.load.accel = AccelKind::Grid(Some(grid_cells(text)?))),
        "Cells of the grid, which is used then [default: by the number of objects]",
    ),
    row(
        "up",
        OptionForm::Words(|| vec!["x", "y", "z"]),
        |to, text| {
            to.load.staging.up = Some(match text {
                "x" => Axis::X,
                "y" => Axis::Y,
                _ => Axis::Z,
            });
            Ok(())
        },
        "Axis of a model that points up [default: y; z for Radiance and STL]",
    ),
    row(
        "view",
        OptionForm::Words(|| VIEWS.map(|row| row.0).to_vec()),
        |to, text| Ok(to.load.staging.view = VIEWS.iter().find(|row| row.0 == text).map(|row| row.1)),
        "Side from which a model is seen that has no camera, or instead of its own [default: three-quarter]",
    ),
    row(
        "studio",
        OptionForm::Words(|| STUDIOS.map(|row| row.0).to_vec()),
        |to, text| Ok(to.load.staging.studio = STUDIOS.iter().find(|row| row.0 == text).map(|row| row.1)),
        "Light for a model that has none, or instead of its own [default: soft]",
    ),
    row(
        "environment",
        OptionForm::Value("FILE"),
        |to, text| Ok(to.load.staging.environment = Some(text.into())),
        "A picture of all directions (.hdr, .exr) that lights the model, instead of its own sky or a studio",
    ),
    row(
        "view-file",
        OptionForm::Value("FILE"),
        |to, text| Ok(to.load.staging.view_file = Some(text.into())),
        "A file of Radiance views (.vf), the last of which is the camera",
    ),
    row(
        "camera",
        OptionForm::Value("NAME"),
        |to, text| Ok(to.load.staging.camera = Some(text.into())),
        "Name or number of the model's camera to use [default: the first]",
    ),
    row(
        "variant",
        OptionForm::Value("NAME"),
        |to, text| Ok(to.load.staging.variant = Some(text.into())),
        "Name or number of the material variant of a glTF file [default: its own materials]",
    ),
    row(
        "fit",
        OptionForm::Flag,
        |to, text| Ok(to.load.staging.fit = flag(text)?),
        "Move the model's own camera along its direction until it sees the whole model",
    ),
    row(
        "turned",
        OptionForm::Number("DEGREES", f32::is_finite, SAY_NUMBER),
        |to, text| Ok(to.load.staging.turned = text.parse().ok()),
        "Degrees by which the view is turned around the model [default: 0]",
    ),
    row(
        "at",
        OptionForm::Number("SECONDS", |x| x.is_finite() && x >= 0.0, "it is a number of seconds, 0 or more"),
        |to, text| Ok(to.load.staging.at = text.parse().ok()),
        "Moment of the model's animation in seconds [default: its pose without animation]",
    ),
];

/// Which pictures are made.
pub(super) const VIEW: &[Row] = &[
    row(
        "crop",
        OptionForm::Value("LEFT,TOP,WIDTHxHEIGHT"),
        |to, text| Ok(to.view.crop = Some(crop(text)?)),
        "Make only a part of the picture",
    ),
    row(
        "show",
        OptionForm::Value("PICTURE,..."),
        |to, text| {
            let known = shown();
            let wrong = text.split(',').find(|name| !known.contains(name));
            if wrong.is_some() {
                return Err(format!("it is one of {}", known.join(", ")));
            }
            to.view.show = text.split(',').map(String::from).collect();
            Ok(())
        },
        "Pictures to make, joined by commas [default: color]",
    ),
];

/// When and with how much the work is done.
pub(super) const WORK: &[Row] = &[
    row(
        "threads",
        OptionForm::Whole(1, 1024),
        |to, text| Ok(to.threads = text.parse().ok()),
        "Threads that build and render [default: one for each processor]",
    ),
    row(
        "tile",
        OptionForm::Whole(8, 4096),
        |to, text| Ok(to.tile = text.parse().ok()),
        "Width and height in pixels of the tiles that threads take, in steps of 8 [default: by the picture's size]",
    ),
    row(
        "time-limit",
        OptionForm::Value("TIME"),
        |to, text| {
            let time = humantime::parse_duration(text).map_err(|_| "say it as 30s, 10m or 1h30m")?;
            Ok(to.time_limit = Some(time))
        },
        "Stop after this time, as in 30s, 10m, 1h30m, once every pixel has a sample",
    ),
    row(
        "shard",
        OptionForm::Value("INDEX/COUNT"),
        |to, text| {
            let by = to.shard.by;
            to.shard = text.parse()?;
            to.shard.by = by;
            Ok(())
        },
        "Make only one of several parts, for `durer merge`",
    ),
    row(
        "shard-by",
        OptionForm::Words(|| vec!["tiles", "samples"]),
        |to, text| Ok(to.shard.by = if text == "samples" { ShardBy::Samples } else { ShardBy::Tiles }),
        "Whether parts have different pixels or different samples [default: tiles]",
    ),
];

/// Sides from which a model can be seen.
const VIEWS: [(&str, View); 5] = [
    ("three-quarter", View::ThreeQuarter),
    ("front", View::Front),
    ("side", View::Side),
    ("top", View::Top),
    ("iso", View::Iso),
];

/// Lights for models.
const STUDIOS: [(&str, Studio); 3] = [("none", Studio::None), ("soft", Studio::Soft), ("sun", Studio::Sun)];

fn shown() -> Vec<&'static str> {
    std::iter::once("color").chain(AOVS.iter().map(|aov| aov.name)).collect()
}

fn flag(text: &str) -> Result<bool, String> {
    match text {
        "" | "on" => Ok(true),
        "off" => Ok(false),
        _ => Err("it takes no value".into()),
    }
}

/// Meaning of an option of reading, view or work; empty if there is none of this name.
pub fn doc(name: &str) -> &'static str {
    let mut rows = READING.iter().chain(VIEW).chain(WORK);
    rows.find(|row| row.option.name == name).map_or("", |row| row.option.doc)
}

/// Reads the name of a quirk to turn on, or off with `no-` before it.
///
/// # Errors
///
/// A sentence, if there is no such quirk.
pub fn compat(text: &str) -> Result<(Compat, bool), String> {
    let (name, on) = text.strip_prefix("no-").map_or((text, true), |name| (name, false));
    Compat::from_name(name).map(|compat| (compat, on)).ok_or_else(|| {
        let names = Compat::ALL.iter().map(|row| row.1);
        match did_you_mean(name, names) {
            Some(near) => format!("there is no such quirk; did you mean `{near}`?"),
            None => "there is no such quirk; see `durer dialects`".into(),
        }
    })
}

/// Reads a part of a picture: left, top, width and height, as in `10,20,64x48`.
///
/// # Errors
///
/// A sentence, if the text is something else.
pub fn crop(text: &str) -> Result<(u32, u32, u32, u32), String> {
    let numbers = || {
        let mut parts = text.splitn(3, ',');
        let (left, top, size) = (parts.next()?, parts.next()?, parts.next()?);
        let (width, height) = size.split_once(['x', 'X'])?;
        let number = |text: &str| text.trim().parse::<u32>().ok();
        Some((number(left)?, number(top)?, number(width)?, number(height)?))
    };
    numbers().filter(|crop| crop.2 > 0 && crop.3 > 0).ok_or_else(|| "say it as 10,20,64x48".into())
}

/// Reads the number of cells of a grid along each axis, as in `10x10x10`.
///
/// # Errors
///
/// A sentence, if the text is something else.
pub fn grid_cells(text: &str) -> Result<[u32; 3], String> {
    let numbers: Option<Vec<u32>> = text.split(['x', 'X']).map(|n| n.parse().ok()).collect();
    let cells: Option<[u32; 3]> = numbers.and_then(|n| n.try_into().ok());
    cells.filter(|c| !c.contains(&0)).ok_or_else(|| "say it as 10x10x10".into())
}
