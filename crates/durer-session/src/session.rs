//! A session, which contains a scene with its camera and picture for one view of a web page.

mod disk;

use crate::document::{CompiledDocument, Document};
use crate::fields::NewValue;
use crate::mistakes::MistakenPicture;
use crate::motion::{camera_of_kind, distance, moved, set_field, state};
use crate::outlines::{light_markers, outlines};
use crate::protocol::{CameraState, Event, Finding, JobState, Motion, NamedChoice, Request, SceneItem, SceneSummary};
use crate::share::{ReceivedPart, Share, changes_picture};
use crate::viewer::Viewer;
use crate::{intersection_tests, language, mistakes, model, terms, traversal};
use durer::camera::{Camera, PerspectiveCamera, Projection};
use durer::describe::DescribedKind;
use durer::film::aov::AOVS;
use durer::image::{Tone, Transfer};
use durer::integrator::IntegratorKind;
use durer::math::{Ray, Vec3};
use durer::render::Job;
use durer::render::explain::explain_samples;
use durer::world::{Epsilon, Geometry};
use std::path::{Path, PathBuf};
use std::sync::Arc;

/// Name and content of a file that belongs to a packed scene.
type NamedBytes = (String, Arc<[u8]>);

/// Function that returns the time in milliseconds since an arbitrary origin. Sessions use it for
/// their time budgets.
pub type Clock = Arc<dyn Fn() -> f64 + Send + Sync>;

/// Maximum number of objects that are listed.
const MAX_ITEMS: usize = 2000;
/// Maximum size of a text or file that a page sends, in bytes.
const MAX_BYTES: usize = 256 << 20;

/// Files of the server that new sessions start with: a scene file and a lesson.
#[derive(Clone, Debug, Default)]
pub struct SessionFiles {
    /// Scene file that is opened and saved if the page does not name a file.
    pub file: Option<PathBuf>,
    /// A teacher's lesson in Markdown format. The scenes that it names are in the same folder.
    pub lesson: Option<PathBuf>,
}

/// An event for the page with its payload.
pub(crate) type Message = (Event, Vec<u8>);

/// An interactive session, which answers requests about one scene and renders its picture
/// progressively.
pub struct Session {
    start: SessionFiles,
    clock: Clock,
    document: Option<Document>,
    viewer: Viewer,
    /// Distance from the eye to the camera's target.
    distance: f32,
    /// True until the current scene has been checked.
    unchecked: bool,
    paused: bool,
    /// Minimum value of `t` for secondary rays, or `None` for exact ray origins.
    epsilon: Option<f32>,
    /// Stamp of the scene file at the time when it was last read or saved.
    #[cfg(feature = "fs")]
    stamp: Option<durer::source::Stamp>,
    /// Stamp of the scene file at the time when the page was last notified.
    #[cfg(feature = "fs")]
    reported: Option<durer::source::Stamp>,
    /// True if the document is the scene file of the server.
    on_disk: bool,
}

impl Session {
    /// Creates a session without a scene.
    pub fn new(start: SessionFiles, clock: Clock) -> Self {
        Session {
            start,
            clock,
            document: None,
            viewer: Viewer::new(),
            distance: 1.0,
            unchecked: false,
            paused: false,
            epsilon: None,
            #[cfg(feature = "fs")]
            stamp: None,
            #[cfg(feature = "fs")]
            reported: None,
            on_disk: false,
        }
    }

    /// Returns true if there is work for the next step.
    pub fn is_busy(&self) -> bool {
        !self.paused && (self.viewer.is_busy() || self.unchecked)
    }

    /// Returns true if no picture shows the latest change yet.
    pub(crate) fn is_urgent(&self) -> bool {
        !self.paused && self.viewer.is_urgent()
    }

    /// Answers a request. Pictures are rendered later by [`Session::step`]. A helper handles only
    /// requests that change the picture, and does not answer them.
    pub(crate) fn handle(&mut self, request: Request, send_message: &mut dyn FnMut(Message)) {
        let changes = changes_picture(&request, &self.viewer.picture);
        if changes {
            self.viewer.share.change();
        }
        if self.viewer.share.is_helper() {
            let is_own = matches!(request, Request::Share { .. } | Request::Pause { .. } | Request::Close);
            if changes || is_own {
                // The first worker tells the page about errors.
                let _ = self.answer(request, &mut |_| {});
            }
            if changes {
                self.viewer.report_again();
            }
            return;
        }
        if let Err(why) = self.answer(request, send_message) {
            send_message((Event::Refused { why }, Vec::new()));
        }
    }

    fn answer(&mut self, request: Request, send_message: &mut dyn FnMut(Message)) -> Result<(), String> {
        let mut send = |event| send_message((event, Vec::new()));
        match request {
            Request::Open { name, text } => self.open(name, text, &mut send)?,
            Request::Give { name, base64, opens } => self.give(name, &base64, opens, &mut send)?,
            Request::Edit { text } => self.edit(text, &mut send)?,
            Request::Size { width, height } => {
                self.viewer.set_size(width, height);
                self.restart();
            }
            Request::Show { picture, stops, tone } => {
                let same = self.viewer.picture == picture;
                if picture != "color" && !AOVS.iter().any(|aov| aov.name == picture) {
                    return Err(format!("unknown picture `{picture}`"));
                }
                (self.viewer.picture, self.viewer.stops, self.viewer.tone) = (picture, stops.clamp(-40.0, 40.0), tone);
                if same { self.show_again(send_message) } else { self.restart() }
            }
            Request::Options { options } => {
                self.viewer.set_options(&options)?;
                self.viewer.forget();
                self.restart();
            }
            Request::Move { motion, moving } => {
                let (world, written, far) = {
                    let distance = self.distance;
                    let compiled = self.compiled()?;
                    (&mut compiled.world, &compiled.text_camera, distance)
                };
                let (camera, now) = moved(world, written, far, motion);
                world.set_camera(camera);
                self.distance = now;
                if matches!(motion, Motion::Home) {
                    self.distance = distance(&self.compiled()?.world);
                }
                send(self.looked(moving)?);
            }
            Request::Field { name, values, word, moving } => {
                let world = &mut self.compiled()?.world;
                let mut camera = world.camera().clone();
                set_field(&mut camera, &name, NewValue { numbers: &values, word: word.as_deref() })?;
                world.set_camera(camera);
                send(self.looked(moving)?);
            }
            Request::Look { center, direction, up, angle, moving } => {
                let [center, direction, up] = [center, direction, up].map(Vec3::from);
                let camera = Camera::from(PerspectiveCamera { center, direction, up, angle });
                self.place(camera)?;
                send(self.looked(moving)?);
            }
            Request::Camera { keyword } => {
                let distance = self.distance;
                let camera = camera_of_kind(&self.compiled()?.world, distance, &keyword)?;
                self.place(camera)?;
                send(self.looked(false)?);
            }
            Request::WriteCamera => {
                let text = self.write_camera()?;
                send(Event::Text { text: text.clone(), from_disk: false });
                self.edit(text, &mut send)?;
            }
            Request::Explain { x, y, sample } => {
                let explained = self.explain(x, y, sample)?;
                send(explained);
            }
            Request::Rays { columns, rows, row } => {
                let rays = traversal::rays(&self.compiled()?.world, [columns, rows], row)?;
                send(Event::Rays { rays });
            }
            Request::Walk { structure, origin, direction, t_max, any } => {
                let ray = ray_of(origin, direction, t_max)?;
                let walk = traversal::traverse(&self.compiled()?.world, structure, &ray, any)?;
                send(Event::Walk { walk });
            }
            Request::Boxes => send(Event::Boxes { boxes: traversal::boxes(&self.compiled()?.world) }),
            Request::Values { left, top, width, height } => {
                let values = self.viewer.values([left, top, width, height])?;
                send(Event::Values { left, top, width, height, values });
            }
            Request::Crop { crop } => {
                self.viewer.crop = crop;
                self.restart();
            }
            Request::Denoise { on } => {
                self.viewer.denoises = on;
                self.show_again(send_message);
            }
            Request::Epsilon { epsilon } => {
                if epsilon.is_some_and(|epsilon| !(0.0..=1e6).contains(&epsilon)) {
                    return Err("epsilon must be a number from 0 to 1000000".into());
                }
                self.epsilon = epsilon;
                self.read(false, &mut send)?;
            }
            Request::Tree => {
                let compiled = self.compiled()?;
                send(Event::Tree { nodes: model::nodes(compiled), materials: model::materials(compiled) });
            }
            Request::Material { number, name, values, word } => {
                let new = NewValue { numbers: &values, word: word.as_deref() };
                let document = self.document.as_mut().filter(|document| document.is_model());
                let document = document.ok_or("this scene is a text file: edit the materials in the text")?;
                document.change(|scene| model::set_material(scene, number, &name, new))?;
                self.restart();
                let contents = Some(self.contents()?);
                send(Event::Scene { findings: Vec::new(), contents, ms: 0.0 });
            }
            Request::AsText => self.become_text(&mut send)?,
            Request::Pack => {
                let (names, files): (Vec<_>, Vec<_>) = self.pack()?.into_iter().unzip();
                let sizes = files.iter().map(|bytes| bytes.len() as u32).collect();
                send_message((Event::Packed { names, sizes }, files.concat()));
            }
            Request::Lesson => {
                let text = self.start.lesson.as_deref().map(read).transpose()?;
                let text = text.map(|bytes| String::from_utf8_lossy(&bytes).into_owned());
                send(Event::Lesson { text });
            }
            Request::Mistakes => send(Event::Mistakes { mistakes: mistakes::choices(self.compiled()?) }),
            Request::Mistake { name, value, width, height } => {
                let compiled = self.document.as_ref().and_then(|document| document.compiled.as_ref());
                let compiled = compiled.ok_or("the scene has errors")?;
                let job = Job { width, height, ..self.viewer.job_of(compiled, "color")? };
                let MistakenPicture { pixels, changed, mistake } =
                    mistakes::picture(compiled, job, name.as_deref(), value)?;
                send_message((Event::Mistaken { width, height, changed, mistake }, pixels));
            }
            Request::Cast { origin, direction, t_max } => {
                let ray = ray_of(origin, direction, t_max)?;
                let cast = intersection_tests::cast(self.compiled()?.named(), &ray);
                send(Event::Cast { cast });
            }
            Request::Outlines => {
                let compiled = self.compiled()?;
                send(Event::Outlines { outlines: outlines(&compiled.names()), lamps: light_markers(compiled.named()) });
            }
            Request::Language => send(Event::Language { words: language::words() }),
            Request::Export { name } => {
                let bytes = self.viewer.export(&name)?;
                send_message((Event::Exported { name }, bytes));
            }
            Request::Save { force } => {
                let saved = self.save(force)?;
                send(saved);
            }
            Request::Share { index, count } => {
                self.viewer.share = Share::new(index, count)?;
                self.restart();
            }
            Request::Pause { pause } => self.paused = pause,
            Request::Close => self.document = None,
        }
        Ok(())
    }

    fn compiled(&mut self) -> Result<&mut CompiledDocument, String> {
        let compiled = self.document.as_mut().and_then(|document| document.compiled.as_mut());
        compiled.ok_or_else(|| "the scene has errors".into())
    }

    fn open(&mut self, name: String, text: Option<String>, send: &mut dyn FnMut(Event)) -> Result<(), String> {
        let (path, bytes) = match (text, &self.start.file) {
            (Some(text), _) => {
                self.on_disk = false;
                (self.path_of(&name), text.into_bytes().into())
            }
            (None, _) if !name.is_empty() => {
                self.on_disk = false;
                let path = self.path_of(&name);
                let bytes = read(&path)?;
                (path, bytes)
            }
            (None, Some(file)) => {
                let path = file.clone();
                let bytes = read(&path)?;
                self.on_disk = true;
                #[cfg(feature = "fs")]
                {
                    self.stamp = durer::format::folder::stamp_of(&path);
                }
                (path, bytes)
            }
            (None, None) => return Err("the server has no file to open".into()),
        };
        self.begin(path, bytes, send)
    }

    /// Returns the path of a scene that a page has sent. The path is always in the folder of the
    /// server's file, so the scene can only refer to files in that folder.
    fn path_of(&self, name: &str) -> PathBuf {
        let own = self.start.file.as_deref().or(self.start.lesson.as_deref());
        let folder = own.and_then(Path::parent).unwrap_or(Path::new(""));
        let name = name.rsplit(['/', '\\']).next().filter(|name| !["", ".", ".."].contains(name));
        folder.join(name.unwrap_or("scene.txt"))
    }

    fn begin(&mut self, path: PathBuf, bytes: Arc<[u8]>, send: &mut dyn FnMut(Event)) -> Result<(), String> {
        let in_memory = self.document.take().map(|document| document.options.in_memory).unwrap_or_default();
        let mut document = Document::new(path, bytes);
        document.options.in_memory = in_memory;
        self.viewer.forget();
        let choice = |(name, doc): (&str, &str)| NamedChoice { name: name.into(), doc: doc.into() };
        let name = document.path.file_name().unwrap_or_default().to_string_lossy().into_owned();
        send(Event::Opened {
            version: env!("CARGO_PKG_VERSION").into(),
            name,
            text: document.text().map(Into::into),
            saves: self.on_disk && document.text().is_some(),
            pictures: std::iter::once(("color", "radiance of each pixel"))
                .chain(AOVS.iter().map(|aov| (aov.name, aov.doc)))
                .map(choice)
                .collect(),
            tones: Tone::ALL.iter().map(|(name, _)| (*name).into()).collect(),
            integrators: IntegratorKind::kinds().iter().map(|kind| choice((kind.own_keyword(), kind.doc()))).collect(),
            cameras: Camera::kinds().iter().map(|kind| choice((kind.own_keyword(), kind.doc()))).collect(),
        });
        self.document = Some(document);
        self.read(true, send)
    }

    fn give(&mut self, name: String, base64: &str, opens: bool, send: &mut dyn FnMut(Event)) -> Result<(), String> {
        if base64.len() > MAX_BYTES {
            return Err(format!("`{name}` is too large"));
        }
        let bytes: Arc<[u8]> = decode(base64).ok_or_else(|| format!("the upload of `{name}` is incomplete"))?.into();
        if opens {
            self.on_disk = false;
            let path = self.path_of(&name);
            return self.begin(path, bytes, send);
        }
        let document = self.document.get_or_insert_with(|| Document::new("scene.txt".into(), Arc::from([])));
        document.options.in_memory.retain(|known| known.0 != name);
        document.options.in_memory.push((name, bytes));
        if document.bytes.is_empty() { Ok(()) } else { self.read(false, send) }
    }

    fn edit(&mut self, text: String, send: &mut dyn FnMut(Event)) -> Result<(), String> {
        if text.len() > MAX_BYTES {
            return Err("the text is too long".into());
        }
        self.document.as_mut().ok_or("no scene is open")?.bytes = text.into_bytes().into();
        self.read(false, send)
    }

    /// Reads and compiles the text. If the camera was moved, it keeps its position unless its
    /// statement in the text has changed.
    fn read(&mut self, is_new: bool, send: &mut dyn FnMut(Event)) -> Result<(), String> {
        let start = (self.clock)();
        let document = self.document.as_mut().ok_or("no scene is open")?;
        let before = document.compiled.as_ref().filter(|_| !is_new);
        let held = before.map(|compiled| (compiled.text_camera.clone(), compiled.world.camera().clone()));
        let (ok, findings) = document.compile();
        let ms = (self.clock)() - start;
        if !ok {
            send(Event::Scene { findings, contents: None, ms });
            return Ok(());
        }
        if let (Some((written, now)), Some(compiled)) = (held, &mut document.compiled) {
            if compiled.text_camera == written && now != written {
                compiled.world.set_camera(now);
            } else {
                self.distance = distance(&compiled.world);
            }
        } else if let Some(compiled) = &document.compiled {
            self.distance = distance(&compiled.world);
        }
        if let (Some(epsilon), Some(compiled)) = (self.epsilon, &mut self.document_mut()?.compiled) {
            let rules = &mut compiled.world.edit().shading;
            (rules.epsilon, rules.points_on_ray) = (Some(Epsilon::MinT(epsilon)), true);
        }
        self.restart();
        self.unchecked = true;
        let contents = Some(self.contents()?);
        send(Event::Scene { findings, contents, ms });
        Ok(())
    }

    fn contents(&mut self) -> Result<SceneSummary, String> {
        let far = self.distance;
        let document = self.document.as_ref().ok_or("no scene is open")?;
        let compiled = document.compiled.as_ref().ok_or("the scene has errors")?;
        let (world, names) = (&compiled.world, compiled.names());
        let thing = |name: String, span| SceneItem { name, place: compiled.place(span) };
        let objects = world.objects().iter().enumerate().take(MAX_ITEMS);
        let lights = compiled.scene().lights.iter().flatten().enumerate();
        let triangles = world.objects().iter().map(|object| match &object.geometry {
            Geometry::Mesh(tree) => tree.mesh.len() as f64,
            _ => 0.0,
        });
        let bounds = world.bounds();
        let job = self.viewer.job_of(compiled, "color")?;
        let natural = durer::RenderJob::default().resolve(&compiled.job_context(), None)?;
        Ok(SceneSummary {
            dialect: compiled.dialect().name().into(),
            camera: state(world, &compiled.text_camera, compiled.dialect(), far),
            objects: objects.map(|(i, object)| thing(names.short_object(i as u32), object.span)).collect(),
            object_count: world.objects().len() as u32,
            triangles: triangles.sum(),
            lights: lights.map(|(i, light)| thing(compiled.light(i), light.span)).collect(),
            bounds: match bounds.is_empty() {
                true => [[-1.0; 3], [1.0; 3]],
                false => [bounds.min.into(), bounds.max.into()],
            },
            job: JobState {
                size: [natural.width, natural.height],
                integrator: job.method.name().into(),
                samples: job.sampling.samples(),
                bounces: job.settings.bounces,
                words: self.viewer.argument_list(compiled, &job),
            },
        })
    }

    fn place(&mut self, camera: Camera) -> Result<(), String> {
        for (i, field) in camera.fields().iter().enumerate() {
            if let Some(value) = camera.get(i) {
                field.constraint.validate(&value).map_err(|wrong| format!("`{}` {wrong}", field.name))?;
            }
        }
        camera.validate()?;
        let compiled = self.compiled()?;
        compiled.world.set_camera(camera);
        Ok(())
    }

    fn looked(&mut self, moving: bool) -> Result<Event, String> {
        self.viewer.moving = moving;
        self.restart();
        Ok(Event::Camera { camera: self.camera()? })
    }

    fn camera(&mut self) -> Result<CameraState, String> {
        let far = self.distance;
        let compiled = self.compiled()?;
        Ok(state(&compiled.world, &compiled.text_camera, compiled.dialect(), far))
    }

    fn write_camera(&mut self) -> Result<String, String> {
        let statement = self.camera()?.statement;
        let document = self.document.as_ref().ok_or("no scene is open")?;
        let (start, end) = document.camera_statement().ok_or("cannot replace the camera in the text of this file")?;
        let text = document.text().ok_or("this file is not a text file")?;
        Ok(format!("{}{statement}{}", &text[..start], &text[end..]))
    }

    fn explain(&mut self, x: u32, y: u32, sample: Option<u32>) -> Result<Event, String> {
        let document = self.document.as_ref().ok_or("no scene is open")?;
        let compiled = document.compiled.as_ref().ok_or("the scene has errors")?;
        let job = self.viewer.job_of(compiled, "color")?;
        let explanation = explain_samples(&compiled.world, &job, (x, y), None).map_err(|error| error.to_string())?;
        Ok(Event::Explained { pixel: terms::explain(compiled.named(), &job, &explanation, sample, Transfer::Srgb) })
    }

    /// Converts a model to text with asset files. After that, the session edits the text.
    fn become_text(&mut self, send: &mut dyn FnMut(Event)) -> Result<(), String> {
        let document = self.document.as_mut().ok_or("no scene is open")?;
        let (text, files) = document.as_text()?;
        let in_memory = &mut document.options.in_memory;
        in_memory.retain(|(name, _)| !files.iter().any(|(known, _)| known == name));
        in_memory.extend(files.into_iter().map(|(name, bytes)| (name, bytes.into())));
        let path = document.path.with_extension("txt");
        self.on_disk = false;
        self.begin(path, text.into_bytes().into(), send)
    }

    /// Returns the text and the files of the scene with their names.
    fn pack(&self) -> Result<Vec<NamedBytes>, String> {
        let document = self.document.as_ref().ok_or("no scene is open")?;
        let own = document.path.with_extension("txt").file_name().unwrap_or_default().to_string_lossy().into_owned();
        let (text, files) = match document.is_model() {
            true => {
                let (text, files) = document.as_text()?;
                (text.into_bytes().into(), files.into_iter().map(|(name, bytes)| (name, bytes.into())).collect())
            }
            false => (document.bytes.clone(), document.options.in_memory.clone()),
        };
        Ok(std::iter::once((own, text)).chain(files).collect())
    }

    /// Shows a finished picture again with different display settings.
    fn show_again(&mut self, send_message: &mut dyn FnMut(Message)) {
        let compiled = self.document.as_ref().and_then(|document| document.compiled.as_ref());
        match compiled.and_then(|compiled| self.viewer.again(compiled, &*self.clock)) {
            Some((head, bytes)) => send_message((Event::Picture { head }, bytes)),
            None if self.viewer.is_empty() || self.viewer.share.shard.count == 1 => self.restart(),
            None => {}
        }
    }

    /// Receives a part of the picture that another worker has rendered.
    pub(crate) fn receive(&mut self, part: ReceivedPart) {
        self.viewer.receive(part);
    }

    fn document_mut(&mut self) -> Result<&mut Document, String> {
        self.document.as_mut().ok_or_else(|| "no scene is open".into())
    }

    fn restart(&mut self) {
        let now = (self.clock)();
        self.viewer.restart(now);
    }

    /// Works for a few milliseconds.
    pub(crate) fn step(&mut self, send_message: &mut dyn FnMut(Message)) {
        let Some(compiled) = self.document.as_ref().and_then(|document| document.compiled.as_ref()) else {
            self.viewer.stop();
            self.unchecked = false;
            return;
        };
        if self.viewer.is_busy() {
            match self.viewer.step(compiled, &*self.clock) {
                Ok(Some(shown)) => send_message(shown),
                Ok(None) => {}
                Err(why) => send_message((Event::Refused { why }, Vec::new())),
            }
        } else if std::mem::take(&mut self.unchecked) && !self.viewer.share.is_helper() {
            let findings: Vec<Finding> = match self.viewer.job_of(compiled, "color") {
                Ok(job) => compiled.check(&job),
                Err(_) => return,
            };
            send_message((Event::Checked { findings }, Vec::new()));
        }
    }
}

fn read(path: &Path) -> Result<Arc<[u8]>, String> {
    let wrong = |error: std::io::Error| format!("{}: {error}", path.display());
    // Reading a pipe or a device might never end.
    if !std::fs::metadata(path).map_err(wrong)?.is_file() {
        return Err(format!("`{}` is not a file", path.display()));
    }
    Ok(std::fs::read(path).map_err(wrong)?.into())
}

/// Converts a ray that a page has sent.
fn ray_of(origin: [f32; 3], direction: [f32; 3], t_max: Option<f32>) -> Result<Ray, String> {
    let ray = Ray { t_max: t_max.unwrap_or(f32::INFINITY), ..Ray::new(origin.into(), direction.into()) };
    match ray.origin.is_finite() && ray.dir.is_finite() && ray.dir != Vec3::ZERO {
        true => Ok(ray),
        false => Err("a ray needs finite numbers, and a direction that is not 0 0 0".into()),
    }
}

/// Decodes base64 with or without padding.
fn decode(text: &str) -> Option<Vec<u8>> {
    let mut bytes = Vec::with_capacity(text.len() / 4 * 3);
    let (mut bits, mut count) = (0_u32, 0);
    for letter in text.trim_end_matches('=').bytes() {
        let six = match letter {
            b'A'..=b'Z' => letter - b'A',
            b'a'..=b'z' => letter - b'a' + 26,
            b'0'..=b'9' => letter - b'0' + 52,
            b'+' => 62,
            b'/' => 63,
            _ => return None,
        };
        (bits, count) = (bits << 6 | u32::from(six), count + 6);
        if count >= 8 {
            count -= 8;
            bytes.push((bits >> count) as u8);
        }
    }
    Some(bytes)
}
