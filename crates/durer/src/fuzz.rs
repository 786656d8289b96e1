//! Checks that arbitrary input causes no panic, that memory is proportional to the input, and that
//! the results are consistent.
//!
//! The fuzz targets in `fuzz/` call these functions with random bytes. A test calls them with the
//! seeds, which include inputs that caused failures in the past.

use crate::LoadOptions;
use durer_diag::{Diagnostics, Files, Span};
use durer_formats::course::{ReadOptions, guess, random::SceneGenerator, read, write};
use durer_formats::folder::FolderSource;
use durer_formats::json::{self, Document};
use durer_formats::scene::{ReadInput, find_scene_format, read_model};
use durer_formats::{curve, photometry, read_mesh, weather};
use durer_image::{Encoded, ImageError, decode_linear};
use durer_render::compile::AccelKind;
use durer_render::integrator::{IntegratorKind, RenderSettings};
use durer_render::render::{Control, Job, PartError, PartialRender, RenderOutcome, Shard};
use durer_scene::dialect::Dialect;
use durer_scene::math::Vec3;
use durer_scene::scene::SceneDefaults;
use durer_scene::source::Digest;
use durer_scene::spectrum::Curve;
use durer_scene::weather::Daylight;
use std::cell::RefCell;
use std::path::{Path, PathBuf};
use std::sync::{Arc, OnceLock};

/// Memory limit for pictures, in bytes.
const MEMORY: u64 = 64 << 20;
/// Maximum number of pixels of a partial render for which its pictures are computed.
const PIXELS: u64 = 1 << 16;

/// Reads a scene file and checks that writing it and reading it again gives the same scene.
pub fn scene(data: &[u8]) {
    let mut files = Files::default();
    let file = files.add("scene.txt", data.into());
    guess(data, file, &[], &|_| false);
    for dialect in Dialect::ALL {
        for strict in [false, true] {
            let mut diagnostics = Diagnostics::default();
            let options = ReadOptions { dialect, strict, compat: dialect.rules().quirks };
            let scene = read(data, file, options, &mut diagnostics);
            for diagnostic in diagnostics.iter() {
                let spans = diagnostic.span.into_iter().chain(diagnostic.related.iter().map(|related| related.0));
                spans.for_each(|span| assert!(span.start <= span.end && span.end as usize <= data.len()));
            }
            if let Some(scene) = scene {
                write(&scene, dialect);
            }
        }
    }
}

/// Reads a JSON scene and checks that writing it and reading it again gives the same scene.
pub fn json(data: &[u8]) {
    let read = |data: &[u8]| {
        let mut diagnostics = Diagnostics::default();
        let document = Document::open(data, 0, &diagnostics);
        let (dialect, scene) = (document.dialect(), document.scene(&mut diagnostics));
        let within = |span: Span| span.start <= span.end && span.end as usize <= data.len();
        assert!(diagnostics.iter().filter_map(|diagnostic| diagnostic.span).all(within));
        assert!(scene.is_some() != diagnostics.has_errors());
        scene.map(|scene| (scene, dialect))
    };
    if let Some((scene, dialect)) = read(data) {
        write(&scene, dialect);
        let text = json::write(&scene, dialect);
        assert!(read(text.as_bytes()) == Some((scene, dialect)), "{text}");
    }
}

/// Reads a mesh file and checks that its indices are in range and its positions are finite.
pub fn mesh(data: &[u8], name: &str) {
    let mut files = Files::default();
    let file = files.add(name, data.into());
    let mut diagnostics = Diagnostics::default();
    if let Some(mesh) = read_mesh(data, file, name, &mut diagnostics) {
        let within = |count: usize| move |corner: &u32| (*corner as usize) < count;
        assert!(mesh.triangles.iter().flatten().all(within(mesh.positions.len())));
        assert!(mesh.positions.iter().all(|position| position.is_finite()));
    }
}

/// Reads a photometric file and checks that its intensity is never NaN.
pub fn profile(data: &[u8]) {
    let mut files = Files::default();
    let file = files.add("x.ies", data.into());
    let mut diagnostics = Diagnostics::default();
    if let Some(profile) = photometry::read(data, file, &mut diagnostics) {
        for dir in [Vec3::X, Vec3::Y, Vec3::Z, Vec3::NEG_Z, Vec3::new(-0.6, 0.0, 0.8), Vec3::new(0.48, -0.6, 0.64)] {
            assert!(!profile.at(dir).is_nan());
        }
    } else {
        assert!(diagnostics.has_errors());
    }
}

/// Reads a spectrum and checks that its wavelengths are in ascending order and that it can be used
/// as an illuminant or is black.
pub fn curve(data: &[u8]) {
    let mut files = Files::default();
    let file = files.add("x.csv", data.into());
    let mut diagnostics = Diagnostics::default();
    let Some(rows) = curve::read(data, None, file, &mut diagnostics) else {
        return assert!(diagnostics.has_errors());
    };
    assert!(rows.len() > 1 && rows.is_sorted_by(|a, b| a[0] < b[0]));
    if let Some(emitter) = Curve::light(rows) {
        assert!(emitter.color().is_finite() && !emitter.at(550.0).is_nan());
    }
}

/// Reads a weather file and checks that its skies are finite.
pub fn weather(data: &[u8]) {
    let mut files = Files::default();
    let file = files.add("x.epw", data.into());
    let mut diagnostics = Diagnostics::default();
    let Some(weather) = weather::read(data, file, &mut diagnostics) else {
        return assert!(diagnostics.has_errors());
    };
    for row in weather.rows.iter().take(100) {
        if let Daylight::Sky(sky) = row.daylight(&weather.place) {
            assert!(sky.sun_illuminance().is_finite() && sky.sky_illuminance().is_finite());
            assert!(sky.relative_luminance(Vec3::Y).is_finite());
        }
    }
}

/// Reads a model and checks that its meshes are valid and that it has a camera.
pub fn model(data: &[u8], name: &str) {
    let (mut files, mut diagnostics) = (Files::default(), Diagnostics::default());
    let bytes = data.into();
    let file = files.add(name, Arc::clone(&bytes));
    let files = RefCell::new(files);
    let source = FolderSource::new(folder());
    for scene_defaults in
        [SceneDefaults::default(), SceneDefaults { animation_time: Some(0.5), ..SceneDefaults::default() }]
    {
        let input = ReadInput {
            bytes: &bytes,
            file,
            files: &files,
            name,
            source: &source,
            scene_defaults: &scene_defaults,
            memory: MEMORY,
        };
        let Some(format) = find_scene_format(data, name) else { return };
        let Some(scene) = read_model(format, &input, &mut diagnostics) else { continue };
        assert!(scene.camera.is_some());
        for mesh in scene.assets.meshes.values() {
            assert!(mesh.triangles.iter().flatten().all(|&corner| (corner as usize) < mesh.positions.len()));
            assert!(mesh.positions.iter().all(|position| position.is_finite()));
        }
    }
}

/// Returns a file name for bytes that may be a USD layer or a package of layers.
pub fn usd_name(data: &[u8]) -> &'static str {
    if data.starts_with(b"PK") { "x.usdz" } else { "x.usd" }
}

/// Reads a picture file and checks that the size and the memory stated by its header are correct.
pub fn picture(data: &[u8], name: &str) {
    let Ok(encoded) = Encoded::open(data, name) else { return };
    let (width, height) = encoded.size();
    assert!(width * height > 0);
    match encoded.read(MEMORY, decode_linear) {
        Ok(image) => {
            assert_eq!((image.width as usize, image.height as usize), (width, height));
            assert!(image.check().is_ok() && encoded.memory_needed() <= MEMORY);
        }
        Err(ImageError::MemoryLimit { needed, .. }) => assert!(needed > MEMORY),
        Err(ImageError::Malformed { reason, .. }) => assert_ne!(reason, "its decoder failed"),
        Err(_) => {}
    }
}

/// Reads a partial render and checks that writing it gives the same bytes and that its colours are
/// finite.
pub fn part(data: &[u8]) {
    let mut bytes = data.to_vec();
    bytes.extend(Digest::of(data).0);
    match PartialRender::read(&bytes) {
        Ok(part) => {
            assert!(part.write() == bytes);
            part.work();
            if part.job().whole().pixels() <= PIXELS {
                part.is_finished();
                part.hash();
                let rendered = part.pictures().expect("a part has pictures");
                let finite =
                    |layer: &durer_image::Layer| layer.name == "variance" || layer.image.first_non_finite().is_none();
                assert!(rendered.layers.iter().all(finite));
            }
        }
        Err(error) => assert!(!matches!(error, PartError::Damaged) || data.len() < 8, "{error}"),
    }
}

/// Returns a folder that contains the files to which random scenes refer.
fn folder() -> PathBuf {
    static FOLDER: OnceLock<PathBuf> = OnceLock::new();
    let make = || {
        let folder = tempfile::tempdir().expect("cannot create a temporary folder").keep();
        write_files(&folder).expect("it can be written");
        folder
    };
    FOLDER.get_or_init(make).clone()
}

/// Writes the files to which random scenes refer to a folder.
///
/// # Errors
///
/// Returns errors from writing the files.
pub fn write_files(folder: &Path) -> std::io::Result<()> {
    let mesh = "v 0 0 0\nv 1 0 0\nv 0 1 0\nv 0 0 1\nvt 0 0\nvt 1 0\nvt 0 1\n\
                f 1/1 3/3 2/2\nf 1/1 2/2 4/3\nf 1/1 4/2 3/3\nf 2/1 3/2 4/3\n";
    let picture = [b"P6 2 2 255\n".as_slice(), &[9, 200, 30, 0, 0, 0, 255, 255, 255, 80, 90, 100]].concat();
    std::fs::write(folder.join("a.obj"), mesh)?;
    std::fs::write(folder.join("a.ppm"), picture)
}

/// Returns the text of a random but valid scene that is determined by `bytes`.
pub fn random_scene(bytes: &[u8]) -> String {
    write(&SceneGenerator::renderable(bytes).scene(Dialect::Durer), Dialect::Durer)
}

/// Builds a random scene from bytes. Checks that its text gives the same scene again, and that its
/// picture is the same with a BVH, a grid and brute force.
pub fn ways(data: &[u8]) {
    let scene = SceneGenerator::renderable(data).scene(Dialect::Durer);
    let text = random_scene(data);
    let path = folder().join("scene.txt");
    let settings = RenderSettings { bounces: 2, ..Job::default().settings };
    // Use path tracing for physical scenes.
    let method = if scene.is_physical() { IntegratorKind::PATH } else { IntegratorKind::WHITTED };
    let job = Job { width: 12, height: 9, settings, method, ..Job::default() };
    let hash = |accel| {
        let options = LoadOptions {
            dialect: Some(Dialect::Durer),
            accel,
            threads: Some(1),
            memory: Some(512 << 20),
            ..LoadOptions::default()
        };
        let (mut files, mut diagnostics) = (Files::default(), Diagnostics::default());
        let bytes = text.as_bytes().into();
        let loaded = crate::load_text(&path, bytes, &options, &mut files, &mut diagnostics);
        let loaded = loaded.unwrap_or_else(|| panic!("cannot read the written scene: {diagnostics:?}\n{text}"));
        let world = loaded.compile(&options, &mut files, &mut diagnostics)?;
        let part = PartialRender::new(&world, &job, Shard::WHOLE).expect("the job is valid");
        let control = Control { threads: Some(1), ..Control::default() };
        match part.render(&world, &control, &mut |_, _| {}).expect("the render failed") {
            RenderOutcome::Finished => Some(part.hash()),
            stop => panic!("{stop:?}\n{text}"),
        }
    };
    let Some(plain) = hash(AccelKind::None) else { return };
    for accel in [AccelKind::Bvh, AccelKind::Grid(None)] {
        // Building a grid fails if it has too many entries.
        if let Some(other) = hash(accel) {
            assert_eq!(other, plain, "{accel:?}\n{text}");
        }
    }
}

#[cfg(test)]
#[test]
fn seeds_hold() {
    let root = std::path::Path::new(env!("CARGO_MANIFEST_DIR")).join("../../fuzz");
    // A published package contains no seeds.
    let entries = |path: PathBuf| std::fs::read_dir(path).into_iter().flatten().map(|entry| entry.unwrap().path());
    for target in entries(root.join("seeds")) {
        let name = target.file_name().unwrap().to_string_lossy().into_owned();
        for seed in entries(target) {
            let data = std::fs::read(&seed).unwrap();
            match name.as_str() {
                "scene" => scene(&data),
                "json" => json(&data),
                "curve" => curve(&data),
                "weather" => weather(&data),
                "ies" => profile(&data),
                "part" => part(&data),
                "ways" => ways(&data),
                "obj" | "off" | "ply" | "stl" => mesh(&data, &format!("x.{name}")),
                "dae" | "gltf" | "pbrt" | "rad" | "xml" => model(&data, &format!("x.{name}")),
                "threemf" => model(&data, "x.3mf"),
                "usd" => model(&data, usd_name(&data)),
                _ => picture(&data, &format!("x.{name}")),
            }
        }
    }
}
