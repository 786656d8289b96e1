//! Rendering of a session's picture from coarse to fine, in steps of a few milliseconds.

use crate::display::{display, pixels};
use crate::document::CompiledDocument;
use crate::export::export;
use crate::protocol::{Event, PictureInfo, Setting};
use crate::share::{ReceivedPart, Share};
use durer::RenderJob;
use durer::image::{Layer, LayerKind, Transfer};
use durer::job::OutputSelection;
use durer::render::{Control, Job, PixelRect, ProgressiveRender, RenderError, Sampling};

/// Time budgets for a coarse picture in milliseconds. `MOVING` applies while the camera moves, and
/// `RESTING` applies otherwise.
const MOVING: f64 = 24.0;
const RESTING: f64 = 45.0;
/// Duration of a step in milliseconds. Messages are handled between steps.
const STEP: f64 = 12.0;
/// Time between the pictures that are sent during a render, in milliseconds.
const BETWEEN: f64 = 160.0;
/// Possible sizes of the pixel blocks in a coarse picture, in pixels.
const DIVISORS: [u32; 9] = [1, 2, 3, 4, 5, 6, 8, 12, 16];
/// Maximum width and height of a picture, in pixels.
const LARGEST: u32 = 8192;
/// Maximum number of pixels whose values are sent in one answer.
const MAX_VALUES: u64 = 4096;

/// Progressive renderer of the picture that a session shows, with its display settings.
pub(crate) struct Viewer {
    pub width: u32,
    pub height: u32,
    pub picture: String,
    pub stops: f32,
    pub tone: String,
    pub moving: bool,
    /// Part of the picture that is rendered, in pixels of the full picture, or `None` for the full
    /// picture.
    pub crop: Option<[u32; 4]>,
    /// True if finished colour pictures are denoised.
    pub denoises: bool,
    options: RenderJob,
    stage: Stage,
    /// Time to take one sample of one pixel, in milliseconds, or `None` if it is unknown.
    cost: Option<f64>,
    tiles: u64,
    changed: f64,
    reported: f64,
    /// The last finished picture. It is kept so that it can be exported or shown with other display
    /// settings.
    shown: Option<ProgressiveRender>,
    /// Denoised version of the finished picture, if denoising is on.
    clean: Option<Layer>,
    rays: u64,
    /// Time at which rendering of the fine picture started.
    began: f64,
    /// The workers that render the picture.
    pub share: Share,
    /// Time that a helper needs to write its part, in milliseconds.
    report_cost: f64,
}

/// Stage of progressive rendering in a [`Viewer`]: idle, coarse picture or full picture.
enum Stage {
    /// There is no work left.
    Idle,
    /// The next step renders a coarse picture.
    Coarse,
    /// The full picture is being rendered. The number is the number of samples per pixel after the
    /// last complete pass.
    Fine(Box<ProgressiveRender>, Option<u32>),
    /// This worker's share of the full picture is finished, and those of other workers are not.
    Waiting(Box<ProgressiveRender>, Option<u32>),
}

/// A picture as a description and pixels.
type PictureMessage = (PictureInfo, Vec<u8>);

/// A picture or a helper's part, with its bytes.
type ViewerMessage = (Event, Vec<u8>);

impl Viewer {
    pub fn new() -> Self {
        Viewer {
            width: 512,
            height: 512,
            picture: "color".into(),
            stops: 0.0,
            tone: "none".into(),
            moving: false,
            crop: None,
            denoises: false,
            options: RenderJob::default(),
            stage: Stage::Idle,
            cost: None,
            tiles: 4,
            changed: 0.0,
            reported: 0.0,
            shown: None,
            clean: None,
            rays: 0,
            began: 0.0,
            share: Share::default(),
            report_cost: 0.0,
        }
    }

    /// Receives a part of the picture that another worker has rendered.
    pub fn receive(&mut self, part: ReceivedPart) {
        if self.share.receive(part) {
            self.stage = match std::mem::replace(&mut self.stage, Stage::Idle) {
                Stage::Waiting(render, seen) => Stage::Fine(render, seen),
                stage => stage,
            };
        }
    }

    /// Makes a helper report its part again, because the first worker ignores outdated ones.
    pub fn report_again(&mut self) {
        self.reported = f64::NEG_INFINITY;
        if matches!(self.stage, Stage::Idle)
            && let Some(render) = self.shown.take()
        {
            self.stage = Stage::Fine(Box::new(render), None);
        }
    }

    /// Sets the options of the job.
    pub fn set_options(&mut self, settings: &[Setting]) -> Result<(), String> {
        let mut options = RenderJob::default();
        for Setting { name, value } in settings {
            options.set(name, value).map_err(|wrong| format!("{name}: {wrong}"))?;
        }
        self.options = options;
        Ok(())
    }

    pub fn set_size(&mut self, width: u32, height: u32) {
        (self.width, self.height) = (width.clamp(1, LARGEST), height.clamp(1, LARGEST));
    }

    /// Restarts the render after a change.
    pub fn restart(&mut self, now: f64) {
        (self.stage, self.changed, self.rays) = (Stage::Coarse, now, 0);
    }

    /// Discards the measured cost and the last picture. This is called when another scene is
    /// opened.
    pub fn forget(&mut self) {
        (self.cost, self.shown, self.clean, self.crop) = (None, None, None, None);
    }

    /// Returns true if no picture shows the latest change yet.
    pub fn is_urgent(&self) -> bool {
        matches!(self.stage, Stage::Coarse)
    }

    /// Stops the render and keeps the last picture.
    pub fn stop(&mut self) {
        self.stage = Stage::Idle;
    }

    pub fn is_busy(&self) -> bool {
        !matches!(self.stage, Stage::Idle | Stage::Waiting(..))
    }

    /// Returns true if there is no picture and none is being rendered.
    pub fn is_empty(&self) -> bool {
        matches!(self.stage, Stage::Idle) && self.shown.is_none()
    }

    /// Returns the job of the picture that is shown.
    pub fn job(&self, compiled: &CompiledDocument) -> Result<Job, String> {
        let job = self.job_of(compiled, &self.picture)?;
        let whole = PixelRect { left: 0, top: 0, width: job.width, height: job.height };
        let crop = self.crop.map(|[left, top, width, height]| within(PixelRect { left, top, width, height }, whole));
        Ok(Job { crop: crop.filter(|crop| *crop != whole).or(job.crop), ..job })
    }

    /// Returns the job for the full picture.
    pub fn job_of(&self, compiled: &CompiledDocument, picture: &str) -> Result<Job, String> {
        let options = self.options.clone().size((self.width, self.height));
        options.resolve(&compiled.job_context(), Some(&OutputSelection { crop: None, show: vec![picture.into()] }))
    }

    /// Returns the options that differ from the scene's defaults.
    pub fn argument_list(&self, compiled: &CompiledDocument, job: &Job) -> Vec<String> {
        RenderJob::of(job, &compiled.job_context()).to_arguments()
    }

    /// Works for about one [`STEP`].
    pub fn step(
        &mut self,
        compiled: &CompiledDocument,
        clock: &dyn Fn() -> f64,
    ) -> Result<Option<ViewerMessage>, String> {
        let picture = |(head, bytes)| (Event::Picture { head }, bytes);
        match std::mem::replace(&mut self.stage, Stage::Idle) {
            Stage::Idle => Ok(None),
            Stage::Coarse if self.share.is_helper() => {
                self.start_share(compiled, clock)?;
                Ok(None)
            }
            Stage::Coarse => Ok(self.coarse(compiled, clock)?.map(picture)),
            Stage::Fine(render, seen) if self.share.is_helper() => self.help(compiled, render, seen, clock),
            Stage::Fine(render, seen) => Ok(self.fine(compiled, render, seen, clock)?.map(picture)),
            Stage::Waiting(render, seen) => {
                self.stage = Stage::Waiting(render, seen);
                Ok(None)
            }
        }
    }

    /// Starts a helper's share of the full picture, unless the camera moves or the picture cannot
    /// be shared.
    fn start_share(&mut self, compiled: &CompiledDocument, clock: &dyn Fn() -> f64) -> Result<(), String> {
        if !self.moving {
            let job = self.job(compiled)?;
            if let Ok(render) = ProgressiveRender::with_shard(&compiled.world, &job, self.share.shard) {
                self.stage = Stage::Fine(Box::new(render), None);
            }
            (self.reported, self.began) = (f64::NEG_INFINITY, clock());
        }
        Ok(())
    }

    /// Renders a helper's share for about one [`STEP`], and reports it from time to time.
    fn help(
        &mut self,
        compiled: &CompiledDocument,
        mut render: Box<ProgressiveRender>,
        seen: Option<u32>,
        clock: &dyn Fn() -> f64,
    ) -> Result<Option<ViewerMessage>, String> {
        let (samples, finished) = self.advance(compiled, &mut render, seen, clock)?;
        let is_new = samples != seen || self.reported == f64::NEG_INFINITY;
        let is_due = clock() - self.reported > BETWEEN.max(10.0 * self.report_cost);
        let mut message = None;
        if finished || samples.is_some() && is_new && is_due {
            let start = clock();
            message = Some((self.share.message(finished), render.part().write()));
            self.reported = clock();
            self.report_cost = self.reported - start;
        }
        match finished {
            true => self.shown = Some(*render),
            false => self.stage = Stage::Fine(render, samples),
        }
        Ok(message)
    }

    /// Renders for about one [`STEP`]. Returns the samples per pixel after the last complete pass,
    /// and whether all passes are complete.
    fn advance(
        &mut self,
        compiled: &CompiledDocument,
        render: &mut ProgressiveRender,
        seen: Option<u32>,
        clock: &dyn Fn() -> f64,
    ) -> Result<(Option<u32>, bool), String> {
        let control = Control { max_tiles: Some(self.tiles), ..Control::default() };
        let start = clock();
        let passed = render.next_pass(&compiled.world, &control);
        let took = clock() - start;
        self.rays += control.rays.load(std::sync::atomic::Ordering::Relaxed);
        if took > 0.0 {
            let wanted = self.tiles as f64 * (STEP / took).clamp(0.5, 2.0);
            self.tiles = (wanted as u64).clamp(1, 1 << 16);
        }
        match passed {
            Ok(Some(progress)) => Ok((Some(progress.samples), progress.samples >= progress.all_samples)),
            Ok(None) => Ok((seen, true)),
            Err(RenderError::Cancelled) => Ok((seen, false)),
            Err(error) => Err(wrong(error)),
        }
    }

    fn coarse(
        &mut self,
        compiled: &CompiledDocument,
        clock: &dyn Fn() -> f64,
    ) -> Result<Option<PictureMessage>, String> {
        let job = self.job(compiled)?;
        let pixels = job.window().pixels() as f64;
        let budget = if self.moving { MOVING } else { RESTING };
        let affordable = |&divisor: &u32| {
            self.cost.map_or(divisor >= 8, |cost| cost * pixels / f64::from(divisor * divisor) <= budget)
        };
        let divisor = DIVISORS.into_iter().find(affordable).unwrap_or(16);
        let side = |side: u32| side.div_ceil(divisor).max(1);
        let (width, height) = (side(job.width), side(job.height));
        let whole = PixelRect { left: 0, top: 0, width, height };
        let part = |crop: PixelRect| {
            let (left, top) = (crop.left / divisor, crop.top / divisor);
            let (right, bottom) = (side(crop.left + crop.width), side(crop.top + crop.height));
            within(PixelRect { left, top, width: right - left, height: bottom - top }, whole)
        };
        let coarse = Job {
            width,
            height,
            crop: job.crop.map(part),
            sampling: Sampling::Center,
            noise: None,
            adaptive: false,
            ..job.clone()
        };
        let start = clock();
        let mut render = ProgressiveRender::new(&compiled.world, &coarse).map_err(wrong)?;
        let control = Control::default();
        while render.next_pass(&compiled.world, &control).map_err(wrong)?.is_some() {}
        let shown = self.picture_of(&render, divisor, 1, None)?;
        let made = (clock() - start) / coarse.window().pixels() as f64;
        // Average the cost with its previous value. After a few pictures, outliers due to cold
        // caches or a coarse clock then have little effect.
        let known = self.cost.map_or(made, |cost| 0.5 * (cost + made));
        self.cost = (made > 0.0).then_some(known).or(self.cost);
        self.tiles = self.cost.map_or(4, |cost| ((STEP / cost / 256.0) as u64).clamp(2, 4096));
        if !self.moving {
            // A picture that cannot be divided into shards is rendered by the first worker alone.
            let render = ProgressiveRender::with_shard(&compiled.world, &job, self.share.shard)
                .or_else(|_| ProgressiveRender::new(&compiled.world, &job))
                .map_err(wrong)?;
            self.stage = Stage::Fine(Box::new(render), None);
            self.began = clock();
        }
        self.reported = clock();
        Ok(Some(self.head(shown, None, clock)))
    }

    fn fine(
        &mut self,
        compiled: &CompiledDocument,
        mut render: Box<ProgressiveRender>,
        seen: Option<u32>,
        clock: &dyn Fn() -> f64,
    ) -> Result<Option<PictureMessage>, String> {
        let is_shared = render.part().shard().count > 1;
        if !self.share.absorb(&mut render) {
            // The workers disagree about the scene, so the picture is not divided any more.
            self.share = Share::default();
            self.restart(clock());
            return Ok(None);
        }
        let (samples, is_over) = self.advance(compiled, &mut render, seen, clock)?;
        let finished = is_over && self.share.is_complete(&render);
        let due = samples.is_some()
            && (samples != seen && seen.is_none() || clock() - self.reported > BETWEEN)
            && (!is_shared || render.part().is_whole());
        let mut shown = None;
        if is_shared && (due || finished) {
            self.rays = render.part().statistics().rays;
        }
        if due || finished {
            let hash = finished.then(|| render.part().hash().to_string());
            self.clean = if finished { self.denoised(&render, compiled)? } else { None };
            let (mut head, bytes) = self.picture_of(&render, 1, samples.unwrap_or(1), hash)?;
            let (all, done) = render.part().work();
            let elapsed = clock() - self.began;
            head.noise = render.part().noise();
            head.left_ms = (done > 0 && !finished).then(|| elapsed * (all - done) as f64 / done as f64);
            self.reported = clock();
            shown = Some(self.head((head, bytes), Some(render.part().job()), clock));
        }
        match (finished, is_over) {
            (true, _) => self.shown = Some(*render),
            (false, true) => self.stage = Stage::Waiting(render, samples),
            (false, false) => self.stage = Stage::Fine(render, samples),
        }
        Ok(shown)
    }

    /// Encodes the finished picture again with the current display settings.
    pub fn again(&mut self, compiled: &CompiledDocument, clock: &dyn Fn() -> f64) -> Option<PictureMessage> {
        let render = self.shown.take_if(|_| matches!(self.stage, Stage::Idle))?;
        let shown = self.encode(&render, compiled);
        let shown = shown.ok().map(|shown| self.head(shown, Some(render.part().job()), clock));
        self.shown = Some(render);
        shown
    }

    fn encode(&mut self, render: &ProgressiveRender, compiled: &CompiledDocument) -> Result<PictureMessage, String> {
        if self.clean.is_none() {
            self.clean = self.denoised(render, compiled)?;
        }
        let hash = Some(render.part().hash().to_string());
        let (mut head, bytes) = self.picture_of(render, 1, render.part().job().sampling.samples(), hash)?;
        head.noise = render.part().noise();
        Ok((head, bytes))
    }

    /// Returns the denoised picture if denoising is on and possible.
    fn denoised(&self, render: &ProgressiveRender, compiled: &CompiledDocument) -> Result<Option<Layer>, String> {
        if !self.denoises || self.picture != "color" {
            return Ok(None);
        }
        Ok(Some(render.part().noisy(&compiled.world, None).map_err(wrong)?.denoised()))
    }

    /// Returns the values of the pixels in a rectangle. These are colours, or the values of the
    /// picture that is shown instead.
    pub fn values(&self, [left, top, width, height]: [u32; 4]) -> Result<Vec<Option<f32>>, String> {
        let render = match &self.stage {
            Stage::Fine(render, Some(_)) | Stage::Waiting(render, Some(_)) if render.part().is_whole() => render,
            _ => self.shown.as_ref().ok_or("the picture is not finished yet")?,
        };
        let window = render.part().job().window();
        let rect = PixelRect { left, top, width, height };
        if rect.pixels() > MAX_VALUES || rect != within(rect, window) {
            return Err(format!("values can be requested for at most {MAX_VALUES} pixels of the picture"));
        }
        let rendered = render.part().pictures().map_err(wrong)?;
        let layer = rendered.layers.first().ok_or("the job has no picture")?;
        let pixel = |(x, y): (u32, u32)| {
            let index = (y - window.top) as usize * window.width as usize + (x - window.left) as usize;
            layer.image.pixels[index].to_array().map(|value| value.is_finite().then_some(value))
        };
        Ok(rect.pixel_positions().flat_map(pixel).collect())
    }

    /// Encodes the finished picture as a file.
    pub fn export(&self, name: &str) -> Result<Vec<u8>, String> {
        let render = self.shown.as_ref().ok_or("the picture is not finished yet")?;
        let mut rendered = render.part().pictures().map_err(|error| error.to_string())?;
        let made = || (!rendered.layers.is_empty()).then(|| rendered.layers.swap_remove(0));
        let layer = self.clean.clone().filter(|_| self.denoises).or_else(made);
        export(name, &layer.ok_or("the job has no picture")?, display(self.stops, &self.tone))
    }

    fn picture_of(
        &self,
        render: &ProgressiveRender,
        divisor: u32,
        samples: u32,
        hash: Option<String>,
    ) -> Result<PictureMessage, String> {
        let rendered = render.part().pictures().map_err(wrong)?;
        let clean = self.clean.as_ref().filter(|_| self.denoises && hash.is_some());
        let layer = clean.or(rendered.pictures.first()).ok_or("the job has no picture")?;
        let PixelRect { left, top, width, height } = render.part().job().window();
        let how = match layer.kind {
            LayerKind::Color => display(self.stops, &self.tone),
            LayerKind::Data => Transfer::Linear.into(),
        };
        let head = PictureInfo {
            picture: self.picture.clone(),
            width,
            height,
            full_width: self.width,
            full_height: self.height,
            region: [left, top, width, height].map(|side| side * divisor),
            noise: None,
            left_ms: None,
            denoised: clean.is_some(),
            samples,
            all_samples: samples,
            rays: self.rays as f64,
            ms: 0.0,
            hash,
        };
        Ok((head, pixels(layer, &how)))
    }

    fn head(&self, (head, bytes): PictureMessage, job: Option<&Job>, clock: &dyn Fn() -> f64) -> PictureMessage {
        let all_samples = job.map_or(head.all_samples, |job| job.sampling.samples());
        (PictureInfo { all_samples, ms: clock() - self.changed, ..head }, bytes)
    }
}

/// Clips a crop rectangle to the picture `whole`, but keeps at least one pixel.
fn within(crop: PixelRect, whole: PixelRect) -> PixelRect {
    let left = crop.left.clamp(whole.left, whole.left + whole.width - 1);
    let top = crop.top.clamp(whole.top, whole.top + whole.height - 1);
    let width = crop.width.clamp(1, whole.left + whole.width - left);
    let height = crop.height.clamp(1, whole.top + whole.height - top);
    PixelRect { left, top, width, height }
}

fn wrong(error: RenderError) -> String {
    error.to_string()
}
