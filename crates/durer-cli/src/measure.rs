//! Implements `durer measure`, which computes illuminance and irradiance at points.

mod annual;
mod enclosed;
mod glare;
mod grid;
mod plan;
mod point_list;
mod printed;
mod weather;

use crate::failure::{Failure, invalid_input};
use crate::file_registry::FileRegistry;
use crate::open::{load_options, read};
use crate::options::{GivenOptions, IntegratorArgs, SceneArgs, name_of};
use crate::progress::show_progress;
use crate::report;
use crate::terminal::print_error_line;
use clap::builder::{PossibleValuesParser, TypedValueParser as _};
use clap::{Arg, Args};
use durer::camera::PerspectiveCamera;
use durer::daylight;
use durer::describe::DescribedKind;
use durer::diag::Diagnostic;
use durer::image::{Destination, save_all};
use durer::integrator::{Integrator, IntegratorContext, IntegratorKind, RenderSettings};
use durer::light::{Light, PHOTOMETRIC_FIELDS};
use durer::math::{Color, LUMINANCE, Ray64, Vec3};
use durer::measure::{IlluminanceKind, MeasureOptions, Sensor, measure};
use durer::options::vector;
use durer::render::Job;
use durer::scene::defaults::ModelAxes;
use durer::scene::{Axis, Scene};
use durer::threads;
use durer::world::World;
use grid::Grid;
use printed::Groups;
use std::path::PathBuf;
use weather::WeatherArgs;

/// Measure illuminance and irradiance at points in a scene, as CSV with standard errors
#[derive(Args)]
#[command(
    mut_args(of_measure),
    after_help = "Examples:
  durer measure room.txt --at 0,0.8,0
  durer measure room.txt --at 0,0.8,0 --at 1,0.8,0 --normal 0,1,0 --samples 16384
  durer measure room.txt --grid 0,0.8,0:4,0,0:0,0,6:8x12 > desk.csv
  durer measure room.txt --grid 0,0.8,0:4,0,0:0,0,6:8x12 --error 1% --plan desk.svg --json
  durer measure room.txt --points places.csv
  durer measure lens.txt --at 0,0,0 --integrator photons --samples 64
  durer measure office.txt --ugr 2,1.2,0:2,1.2,6 --json
  durer measure room.txt --weather city.epw --grid 0,0.8,0:4,0,0:0,0,6:8x12 --plan autonomy.svg
  durer measure room.txt --weather city.epw --sky-hour 3-21T12:30 --at 2,0.8,3

A grid is given by a corner, two edges that start at the corner, and the number of points along each edge. The points are
the centres of its cells. Without --normal, a grid measures light from above; the normal of an upright grid is the cross
product of its second and first edges. For each grid, the minimum, average, maximum, U0 (minimum / average) and U1
(minimum / maximum) are printed to standard error, and with --json to standard output.

Points inside a closed object receive no light. They stay in the list with an illuminance of 0, but they are left out of
these figures and of the plan, and their number is printed. An object that contains a point with light or the camera
counts as a room, not as an object around the point.

--ugr rates the glare of the luminaires, which are the surfaces with emission, by the Unified Glare Rating of CIE 117, and
prints the background luminance in cd/m^2; --json also prints the luminance, solid angle and position index of each
luminaire. --samples is then the number of samples for the background [default: 16384].

--weather replaces all light of the scene by the sun and the sky of a weather file (EnergyPlus .epw or Radiance .wea), with
Perez's sky for each row, and prints figures over the hours of use (--occupied, --weekdays): the daylight autonomy, which is
the share of these hours with at least --target-lux, the continuous daylight autonomy, the shares of useful daylight between
the limits of --useful, the mean illuminance, and the hours with direct sunlight of at least 1000 lux. For each grid, it
prints sDA, the share of points with an autonomy of at least 50 %, and ASE, the share with more than 250 hours of direct
sunlight. --hours writes the illuminances of all rows. --sky-hour measures one hour instead. North is -z and east is x, or
with z up, north is y.

A line of a list of points contains x,y,z or x,y,z,nx,ny,nz; a first line with names is ignored.

Units: illuminance is in lux if the scene's light has units (`emissionLuminance` in cd/m^2, `candela`, `lumens`, `lux`,
photometric files, a sky), and in Radiance scenes. Irradiance has one value per colour channel: in W/m^2 in Radiance
scenes, else in the unit of the illuminance. Light that arrives from behind the normal is ignored.

--illuminance cylindrical measures the light on the side of a small upright cylinder, as EN 12464-1 asks for faces at a
height of 1.2 m or 1.6 m, and spherical the light on a small sphere.

The standard errors assume independent samples, so the actual errors are smaller. Lights that only BSDF sampling can find,
for example in mirrors, increase the standard errors. Light that needs more than --bounces is missing and not part of them."
)]
pub struct MeasureArgs {
    #[command(flatten)]
    pub given: GivenOptions,
    /// Scene or model file
    pub scene: PathBuf,
    /// Point to measure; can be given several times
    #[arg(id = "point", long = "at", value_name = "X,Y,Z", value_parser = vector, allow_hyphen_values = true)]
    pub points: Vec<Vec3>,
    /// CSV file with points to measure
    #[arg(long = "points", value_name = "FILE")]
    pub list: Option<PathBuf>,
    /// Normal of the receiving surface [default: upwards]
    #[arg(long, value_name = "X,Y,Z", value_parser = vector, allow_hyphen_values = true)]
    pub normal: Option<Vec3>,
    /// Quantity to measure [default: planar]: the illuminance of a plane, the cylindrical
    /// illuminance (the mean of all planes through the normal), or the mean spherical illuminance
    #[arg(
        id = "kind",
        long = "illuminance",
        value_name = "KIND",
        conflicts_with = "observers",
        value_parser = PossibleValuesParser::new(IlluminanceKind::ALL.map(IlluminanceKind::name))
            .map(|name| IlluminanceKind::from_name(&name).unwrap_or_default())
    )]
    pub kind: Option<IlluminanceKind>,
    /// Grid of points: a corner, two edges, and the number of points along each edge
    #[arg(id = "grids", long = "grid", value_name = "CORNER:EDGE:EDGE:NxM", value_parser = grid::parse, allow_hyphen_values = true)]
    pub grid: Vec<Grid>,
    /// Draw the grid as a plan in false colours, with labelled lines of equal illuminance at round
    /// values, as an SVG file
    #[arg(long, value_name = "FILE.svg", requires = "grids")]
    pub plan: Option<PathBuf>,
    /// Values of the lines of --plan, for example 100,300,500 [default: round values]
    #[arg(long, value_name = "VALUE,VALUE,...", value_delimiter = ',', value_parser = level, requires = "plan")]
    pub levels: Vec<f64>,
    /// Rate the glare for an eye that looks at a point (UGR); can be given several times
    #[arg(id = "observers", long = "ugr", value_name = "EYE:TARGET", value_parser = glare::parse, allow_hyphen_values = true, conflicts_with_all = ["point", "list", "normal", "grids", "error"])]
    pub observers: Vec<[Vec3; 2]>,
    #[command(flatten)]
    pub weather: WeatherArgs,
    /// Print JSON
    #[arg(long)]
    pub json: bool,
    /// Number of threads [default: one per processor]
    #[arg(long, value_parser = clap::value_parser!(u16).range(1..=1024))]
    pub threads: Option<u16>,
    #[command(flatten)]
    pub reading: SceneArgs,
    /// Maximum number of scattering events before light reaches the point
    #[arg(long, default_value_t = MAX_BOUNCES, value_parser = clap::value_parser!(u32).range(0..=i64::from(MAX_BOUNCES)))]
    pub bounces: u32,
    #[command(flatten)]
    pub method: IntegratorArgs,
    /// Samples per point; with --error, the maximum [default: 4096; 1048576 with --error]
    #[arg(long, value_parser = clap::value_parser!(u32).range(2..=1 << 24))]
    pub samples: Option<u32>,
    /// Relative standard error at which a point needs no more samples, for example 1% or 0.01
    #[arg(long, value_name = "SHARE", value_parser = share)]
    pub error: Option<f64>,
    /// Seed of the random number generator
    #[arg(long, default_value_t = 0)]
    pub seed: u64,
    /// Print only errors and the measured values
    #[arg(short, long)]
    pub quiet: bool,
}

/// Largest number of scattering events, and the default: measured light must not lack what a room
/// reflects many times. Roulette ends the paths.
const MAX_BOUNCES: u32 = 256;
/// Largest allowed number of measuring points.
const MAX_POINTS: usize = 1 << 20;

/// Parses a share such as 1% or 0.01, greater than 0 and at most 1.
fn share(text: &str) -> Result<f64, String> {
    let (number, unit) = text.strip_suffix('%').map_or((text, 1.0), |number| (number, 0.01));
    let share = number.trim().parse::<f64>().ok().map(|number| unit * number);
    share.filter(|share| *share > 0.0 && *share <= 1.0).ok_or_else(|| "expected a share such as 1% or 0.01".into())
}

/// Parses the value of an isolux line.
fn level(text: &str) -> Result<f64, String> {
    let level = text.trim().parse().ok().filter(|level: &f64| level.is_finite() && *level > 0.0);
    level.ok_or_else(|| "expected numbers above 0, for example 100,300,500".into())
}

/// Returns the first point that is not on a surface. For such a point, a short ray along its normal
/// hits nothing.
fn in_the_air(world: &World, sensors: &[Sensor]) -> Option<Vec3> {
    let bounds = world.bounds();
    let size = (bounds.max - bounds.min).length();
    let near = 0.01 * if size.is_finite() { size } else { 1.0 };
    let lies_on_a_surface = |&&Sensor { point, normal }: &&Sensor| {
        let from = point.as_dvec3() + f64::from(near) * normal.as_dvec3();
        world.closest(&Ray64::new(from, -normal, 0.0, 2.0 * near), &mut ()).is_some()
    };
    sensors.iter().find(|sensor| !lies_on_a_surface(sensor)).map(|sensor| sensor.point)
}

/// Unit of measured light.
#[derive(Clone, Copy, PartialEq)]
enum LightUnit {
    /// Lux, from photometric units or a sky.
    Lux,
    /// Lux, with the irradiance in W/m^2.
    Watts,
    /// Unit of a scene whose lights have no photometric unit.
    Own,
}

impl LightUnit {
    /// Returns the unit of the light of a scene. In the scene language, one light without a
    /// photometric unit is enough for the scene's own unit.
    fn of(scene: &Scene, world: &World) -> LightUnit {
        match world.lumens() {
            Some(_) => LightUnit::Watts,
            None if scene.up.is_none() && lights_without_unit(scene) > 0 => LightUnit::Own,
            None => LightUnit::Lux,
        }
    }

    /// Returns the unit of the illuminance after a number, or nothing for the scene's own unit.
    fn suffix(self) -> &'static str {
        if self == LightUnit::Own { "" } else { " lux" }
    }

    /// Returns the units of illuminance and irradiance.
    fn names(self) -> [&'static str; 2] {
        match self {
            LightUnit::Lux => ["lux", "lux"],
            LightUnit::Watts => ["lux", "W/m^2"],
            LightUnit::Own => ["the scene's own unit", "the scene's own unit"],
        }
    }
}

/// Returns the number of lights without a photometric unit.
fn lights_without_unit(scene: &Scene) -> usize {
    let has_unit = |light: &Light| {
        let mut fields = light.fields().iter().enumerate();
        matches!(light, Light::Photometric(_))
            || fields.any(|(i, field)| PHOTOMETRIC_FIELDS.contains(&field.name) && light.get(i).is_some())
    };
    scene.lights.iter().flatten().filter(|light| !has_unit(&light.value)).count()
}

/// Notes which light of the file counts: that nothing emits light, that lights have no photometric
/// unit, or that the background emits light.
fn note_light(scene: &Scene, world: &World, unit: LightUnit) {
    let has_background = world.environment().is_some() || world.background() != Color::ZERO;
    if world.lights().is_empty() && !has_background && !scene.emits_light() {
        let help = "`--studio soft` measures the lights that `durer render` adds to such a model";
        let note = Diagnostic::note("nothing in the file emits light");
        report::note(&if scene.up.is_some() { note.help(help) } else { note });
    }
    if scene.up.is_some() || unit == LightUnit::Watts {
        return;
    }
    let plain = lights_without_unit(scene);
    if plain > 0 {
        let message = format!(
            "{} {} without a photometric unit (`candela`, `lumens` or `lux`), so that the values are in the scene's own \
             unit instead of lux",
            report::counted(plain, "light"),
            if plain == 1 { "is" } else { "are" }
        );
        report::note(&Diagnostic::note(message));
    }
    if scene.background_span.has_position() && world.environment().is_none() && world.background() != Color::ZERO {
        let message = "the colour of the background counts as light; `Background { color 0 0 0 }` has none";
        report::note(&Diagnostic::note(message));
    }
}

/// Options that place the camera, which does not change what is measured.
const CAMERA: &[&str] = &["view", "eye", "target", "fov", "camera", "view-file", "fit", "turned"];

/// Adapts the shared options to this command: hides those of the camera, and renames the time of an
/// animation, because `--at` is a point here.
fn of_measure(arg: Arg) -> Arg {
    match arg.get_id().as_str() {
        "at" => arg.long("moment"),
        "studio" => arg.help("Measure these lights instead of the light of the model"),
        "integrator" => arg
            .help("Integrator: path, or photons for light that mirrors and glass focus [default: path]")
            .hide_possible_values(true),
        _ if CAMERA.contains(&&*name_of(arg.get_id())) => arg.hide(true),
        _ => arg,
    }
}

/// Runs `durer measure`.
pub fn run(args: &MeasureArgs) -> Result<(), Failure> {
    if let Some(name) = args.given.find(|name| CAMERA.contains(&name)) {
        return Err(invalid_input(format!("--{name} places the camera, which does not change what is measured")));
    }
    let mut options = load_options(&args.reading);
    // Measure only the light of the scene itself.
    options.scene_defaults.own_light = options.scene_defaults.lighting.is_none();
    let mut registry = FileRegistry::default();
    let plan = plan_target(args, &mut registry)?;
    let hours = args.weather.hours.as_deref();
    let hours = hours.map(|path| registry.register_output_as("--hours", path, "csv")).transpose()?;
    let listed =
        args.list.as_deref().map(|path| point_list::read(path, &mut registry)).transpose()?.unwrap_or_default();
    let weather = args.weather.weather.as_deref().map(|path| weather::read(path, &mut registry)).transpose()?;
    let mut parsed = read(&args.scene, &options, args.json, &mut registry)?;
    // Measuring needs no camera.
    parsed.loaded.scene.camera.get_or_insert_with(|| PerspectiveCamera::look_at(Vec3::Z, Vec3::ZERO, 40.0).into());
    let mut compiled = parsed.compile(&options, &mut registry)?;
    let up_axis = compiled.loaded.scene.up.unwrap_or(Axis::Y);
    let up = ModelAxes::new(up_axis).up.as_vec3();
    let lumens = compiled.world.lumens().unwrap_or(LUMINANCE);
    let normal = match args.normal.map(Vec3::try_normalize) {
        Some(None) => return Err(invalid_input("--normal must not be 0,0,0")),
        Some(normal) => normal,
        None => None,
    };
    let single = args.points.iter().map(|&point| (point, None)).chain(listed);
    let single = single.map(|(point, own)| Sensor { point, normal: own.or(normal).unwrap_or(up) });
    let mut sensors: Vec<Sensor> = single.take(MAX_POINTS + 1).collect();
    let alone = sensors.len();
    sensors.extend(args.grid.iter().flat_map(|grid| grid.sensors(normal, up)).take(MAX_POINTS + 1 - alone));
    if args.observers.is_empty() && sensors.is_empty() || sensors.len() > MAX_POINTS {
        return Err(invalid_input(format!(
            "the number of points must be from 1 to {MAX_POINTS}: pass --at X,Y,Z or --grid, or a list with --points"
        )));
    }
    let unit = match &weather {
        Some(_) => LightUnit::Lux,
        None => LightUnit::of(&compiled.loaded.scene, &compiled.world),
    };
    if weather.is_none() && !args.quiet {
        note_light(&compiled.loaded.scene, &compiled.world, unit);
    }
    let mut year = None;
    match (&weather, &args.weather.sky_hour) {
        (Some(weather), Some(instant)) => {
            let (sky, description) = weather::sky_at(weather, instant)?;
            let axes = args.weather.axes(up_axis)?;
            compiled.world = daylight::light_of_hour(compiled.world, &sky, &axes, args.weather.ground());
            if !args.quiet {
                print_error_line(&format!("note: {description}"));
            }
        }
        (Some(weather), None) => {
            let sky = args.weather.year(weather, up_axis)?;
            compiled.world = sky.light(compiled.world);
            year = Some((weather, sky));
        }
        (None, _) => {}
    }
    let settings = RenderSettings { bounces: args.bounces, ..Job::default().settings };
    let method = args.method.0.resolve_integrator(IntegratorKind::PATH).map_err(invalid_input)?;
    let context = IntegratorContext { world: &compiled.world, settings, cone: None, seed: args.seed, cancel: None };
    let (Integrator::Path(path) | Integrator::Photons(path)) = method.create(context) else {
        return Err(invalid_input("only path tracing can measure illuminance: set --integrator path or photons"));
    };
    let kind = args.kind.unwrap_or_default();
    if !args.observers.is_empty() {
        if path.photons.is_some() {
            return Err(invalid_input("--ugr needs --integrator path"));
        }
        return threads::install(args.threads.map(usize::from), || glare::run(args, &compiled, &path, up, lumens));
    }
    if let Some((weather, year)) = &year {
        if path.photons.is_some() {
            return Err(invalid_input("the daylight of a year needs --integrator path"));
        }
        if kind != IlluminanceKind::Planar {
            return Err(invalid_input("the daylight of a year is measured on planes; --sky-hour measures one hour"));
        }
        let outputs = annual::Outputs { plan, hours };
        return threads::install(args.threads.map(usize::from), || {
            annual::run(args, &path, (weather, year), (&sensors, alone), up, &outputs)
        });
    }
    if path.photons.is_some() && kind != IlluminanceKind::Planar {
        return Err(invalid_input("photons are stored on surfaces: a cylinder or a sphere needs --integrator path"));
    }
    if path.photons.is_some()
        && let Some(point) = in_the_air(&compiled.world, &sensors)
    {
        let message = format!(
            "photons are stored on surfaces, but {} is not on a surface: light from mirrors and glass would be missing",
            printed::vector(point)
        );
        return Err(invalid_input(format!("{message}; use --integrator path, or add a surface there")));
    }
    let samples = args.samples.unwrap_or_else(|| MeasureOptions::default_samples(args.error));
    let options = MeasureOptions { kind, samples, error: args.error, seed: args.seed, lumens };
    let measured = threads::install(args.threads.map(usize::from), || {
        show_progress("measuring", |progress| measure(&path, &sensors, &options, progress))
    });
    let is_dark: Vec<bool> = measured.points.iter().map(|point| point.illuminance == 0.0).collect();
    let inside = enclosed::find(&compiled.world, &sensors, &is_dark);
    let groups =
        Groups { kind, sensors: &sensors, points: &measured.points, inside: &inside, unit, alone, grids: &args.grid };
    match args.json {
        true => groups.print_json()?,
        false => groups.print_rows(),
    }
    if !args.quiet && !args.json {
        groups.print_summaries();
    }
    if let (Some(plan), Some((grid, points))) = (plan, groups.grids().next()) {
        save_all(&[(&plan, groups.plan(grid, &points, up, &args.levels).into_bytes())])?;
        print_written_to_error(&plan, args.quiet);
    }
    if !args.quiet {
        enclosed::warn(&sensors, &inside);
    }
    if let Some(error) = args.error
        && let missed = measured.points.iter().filter(|point| point.error > error * point.illuminance).count()
        && missed > 0
        && !args.quiet
    {
        let message =
            format!("{missed} of {} points have a larger error than --error after {samples} samples", sensors.len());
        report::note(&Diagnostic::warning(message));
    }
    if measured.has_rare_light && !args.quiet {
        let message = "some lights (in mirrors or glass, on solids, or textured) are found only by BSDF sampling: the \
                       errors include the effect of one more sample of such a light; use more `--samples` or \
                       `--integrator photons`";
        report::note(&Diagnostic::warning(message).code("rare-light"));
    }
    Ok(())
}

/// Returns the file for `--plan`, which shows exactly one grid.
fn plan_target(args: &MeasureArgs, registry: &mut FileRegistry) -> Result<Option<Destination>, Failure> {
    let Some(path) = &args.plan else { return Ok(None) };
    if args.grid.len() != 1 {
        return Err(invalid_input("--plan shows one grid: give --grid once"));
    }
    Ok(Some(registry.register_output_as("--plan", path, "svg")?))
}

/// Prints the name of a file that was written to standard error, because the measured values are on
/// standard output.
fn print_written_to_error(file: &Destination, quiet: bool) {
    if !quiet && !file.is_stream() {
        print_error_line(&format!("wrote {}", file.path().display()));
    }
}
