//! Execution of a render. Threads work on tiles, pass after pass, until the render is finished or
//! stopped.

use super::allocation::{half, pilot, variances};
use super::control::RunLimit;
use super::course::stored_bytes;
use super::error::{Panicked, RenderError};
use super::part::{BlockAovs, BlockSamples, PartialRender, film_of, passes_of};
use super::samples::{Cancelled, SampleCursor, SampleSource};
use super::{BLOCK, Control, Job, PixelRect, Rendered, Shard, center_rays};
use crate::clock::{Duration, Instant};
use crate::film::{Film, PackedFilm};
use crate::integrator::Integrate;
use crate::threads;
use crate::world::World;
use durer_bvh::RayCount;
use durer_image::can_allocate;
use rayon::prelude::*;
use std::cell::Cell;
use std::panic::{AssertUnwindSafe, catch_unwind};
use std::sync::atomic::{AtomicBool, AtomicU64, Ordering::Relaxed};
use std::sync::{Arc, Mutex, PoisonError, mpsc};

mod device;

pub use device::{CameraRay, RayDevice, TracedRay};

/// Default width and height of a tile in pixels.
const TILE: u32 = 16;
/// Default width and height of a tile if samples affect several pixels, so that a tile needs
/// samples around it. The tile is smaller if these samples take more than [`MAX_BYTES`].
const TILE_WITH_BORDER: u32 = 64;
/// Maximum memory for the samples of a tile, in bytes.
const MAX_BYTES: u64 = 64 << 20;

/// Returns the default width and height of a tile for a job.
fn usual_tile(job: &Job) -> u32 {
    if job.sampling.is_local() {
        return TILE;
    }
    let sides = std::iter::successors(Some(TILE_WITH_BORDER), |side| Some(side / 2)).take_while(|&side| side > BLOCK);
    sides.chain([BLOCK]).find(|&side| stored_bytes(job, side) <= MAX_BYTES).unwrap_or(BLOCK)
}

/// Interval at which the calling thread checks for cancellation and time limits.
const POLL_INTERVAL: Duration = Duration::from_millis(5);

/// The way in which a call of [`PartialRender::render`] ended: finished, cancelled, out of time or
/// panicked.
#[derive(Clone, Debug, PartialEq, Eq)]
pub enum RenderOutcome {
    /// All work is done.
    Finished,
    /// The caller cancelled the render.
    Cancelled,
    /// The time limit was reached.
    OutOfTime,
    /// A thread panicked.
    Panicked(Panicked),
}

/// Event that is reported to the callback of [`PartialRender::render`].
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
#[non_exhaustive]
pub enum RenderEvent {
    /// A pass has ended.
    PassDone,
    /// A save is due, because the interval [`Control::save_every`] has passed since the last one.
    SaveDue,
}

/// Renders all pictures of a job.
///
/// # Errors
/// Returns [`RenderError`]. Partial results are lost.
pub fn render(world: &World, job: &Job, control: &Control) -> Result<Rendered, RenderError> {
    render_all(world, job, control)?.pictures()
}

/// Renders all work of a job but does not convert it to pictures.
pub(super) fn render_all(world: &World, job: &Job, control: &Control) -> Result<PartialRender, RenderError> {
    let part = PartialRender::new(world, job, Shard::WHOLE)?;
    match part.render(world, control, &mut |_, _| {})? {
        RenderOutcome::Finished | RenderOutcome::OutOfTime => Ok(part),
        RenderOutcome::Cancelled => Err(RenderError::Cancelled),
        RenderOutcome::Panicked(panicked) => Err(panicked.into()),
    }
}

impl PartialRender {
    /// Returns an error unless the part belongs to the world.
    fn check_scene(&self, world: &World) -> Result<(), RenderError> {
        let is_same = self.scene == world.digest() && self.display == world.display_rules();
        if is_same { Ok(()) } else { Err(RenderError::OtherScene) }
    }

    /// Returns the numbers of samples at which the passes end.
    fn ends(&self, until: RunLimit) -> Box<dyn Iterator<Item = u32>> {
        match until {
            RunLimit::End => Box::new(passes_of(&self.job, self.shard)),
            RunLimit::Samples(last) => Box::new(passes_of(&self.job, self.shard).take_while(move |&end| end <= last)),
            RunLimit::Pass(end) => Box::new(std::iter::once(end)),
        }
    }

    /// Continues the work until it is finished or stopped. The results of all finished tiles are
    /// kept.
    ///
    /// Calls `watch` in the calling thread at the end of each pass and when a save is due, while
    /// other threads continue the work. After a slow call, the ends of passes are not reported
    /// until ten times the duration of the call has passed.
    ///
    /// # Errors
    /// Returns [`RenderError::OtherScene`], [`RenderError::Memory`] or [`RenderError::NoMemory`].
    pub fn render(
        &self,
        world: &World,
        control: &Control,
        watch: &mut dyn FnMut(&PartialRender, RenderEvent),
    ) -> Result<RenderOutcome, RenderError> {
        self.render_to(world, control, watch, RunLimit::End)
    }

    /// Continues the work up to `until`. See [`PartialRender::render`].
    pub(super) fn render_to(
        &self,
        world: &World,
        control: &Control,
        watch: &mut dyn FnMut(&PartialRender, RenderEvent),
        until: RunLimit,
    ) -> Result<RenderOutcome, RenderError> {
        self.check_scene(world)?;
        if let Some(device) = &self.job.device {
            return Err(RenderError::Device(format!("this part was rendered on {device}, not on the CPU")));
        }
        let (pool, tile) = (threads::pool(control.threads), control.tile_size.unwrap_or(usual_tile(&self.job)));
        let threads = pool.as_ref().map_or(1, rayon::ThreadPool::current_num_threads);
        let stored = stored_bytes(&self.job, tile).saturating_mul(threads as u64);
        let needed = PartialRender::bytes_needed(&self.job, self.shard).saturating_add(stored);
        control.check_memory(needed)?;
        let stop = AtomicBool::new(control.cancel.load(Relaxed));
        let whole = !self.job.sampling.is_local() || !self.job.wants_samples();
        let mut clock = Watcher::new(control, &stop, whole);
        let (all, done) = self.work();
        if done == 0 && !can_allocate(needed) {
            return Err(RenderError::NoMemory(needed));
        }
        if control.accumulates {
            control.done_work.fetch_add(done, Relaxed);
        } else {
            control.total_work.store(all, Relaxed);
            control.done_work.store(done, Relaxed);
        }
        let work = Work::new(self, world, control, &stop, tile);
        match pool {
            Some(pool) => pool.in_place_scope(|scope| {
                let (finished, passes) = mpsc::channel();
                let work = &work;
                scope.spawn(move |_| {
                    work.rays(None);
                    for end in self.ends(until) {
                        work.pass(end, None);
                        // The receiver may no longer exist.
                        let _ = finished.send(());
                    }
                });
                // The sender is dropped after the last pass.
                loop {
                    match passes.recv_timeout(POLL_INTERVAL) {
                        Ok(()) => clock.passed(self, watch),
                        Err(mpsc::RecvTimeoutError::Timeout) => clock.poll(self, watch),
                        Err(mpsc::RecvTimeoutError::Disconnected) => break,
                    }
                }
            }),
            // Without other threads, the calling thread does all the work and polls between tiles.
            None => {
                work.rays(Some(&mut || clock.poll(self, watch)));
                for end in self.ends(until) {
                    work.pass(end, Some(&mut || clock.poll(self, watch)));
                    clock.passed(self, watch);
                }
            }
        }
        Ok(work.outcome(clock.out_of_time))
    }
}

/// State of the calling thread while other threads render. The calling thread enforces limits and
/// calls the callback.
struct Watcher<'a> {
    start: Instant,
    /// Time of the latest callback.
    last: Instant,
    /// Minimum time between the latest callback and the next callback for a pass.
    pause: Duration,
    control: &'a Control,
    stop: &'a AtomicBool,
    /// True if every pixel has a sample, or if pixels get all their samples at once. As long as
    /// this is false, a time limit would leave holes in the picture.
    whole: bool,
    out_of_time: bool,
}

impl<'a> Watcher<'a> {
    fn new(control: &'a Control, stop: &'a AtomicBool, whole: bool) -> Self {
        let start = Instant::now();
        Watcher { start, last: start, pause: Duration::ZERO, control, stop, whole, out_of_time: false }
    }

    /// Stops the render if it was cancelled or reached the time limit. Reports when a save is due.
    fn poll(&mut self, part: &PartialRender, watch: &mut dyn FnMut(&PartialRender, RenderEvent)) {
        if self.control.cancel.load(Relaxed) {
            self.stop.store(true, Relaxed);
        }
        let over = self.whole && self.control.time_limit.is_some_and(|time| self.start.elapsed() >= time);
        if over && !self.stop.swap(true, Relaxed) {
            self.out_of_time = true;
        }
        if self.control.save_every.is_some_and(|every| self.last.elapsed() >= every) {
            self.call(part, watch, RenderEvent::SaveDue);
        }
    }

    /// Reports the end of a pass.
    fn passed(&mut self, part: &PartialRender, watch: &mut dyn FnMut(&PartialRender, RenderEvent)) {
        self.whole = true;
        self.poll(part, watch);
        if self.last.elapsed() >= self.pause {
            self.call(part, watch, RenderEvent::PassDone);
        }
    }

    /// Calls the callback and measures how long it takes.
    fn call(&mut self, part: &PartialRender, watch: &mut dyn FnMut(&PartialRender, RenderEvent), moment: RenderEvent) {
        // Do not call the callback after cancellation, because the caller saves the final state in
        // any case.
        if self.stop.load(Relaxed) {
            return;
        }
        let before = Instant::now();
        watch(part, moment);
        self.last = Instant::now();
        self.pause = 10 * self.last.duration_since(before);
    }
}

/// Block to which a pass adds samples.
struct OpenBlock {
    block: BlockSamples,
    rect: PixelRect,
    film: Film,
    /// Film before the pass, if the variances of the pixels are computed from both films.
    before: Option<Film>,
    /// Number of samples of a pixel after the pass, as an average over the picture.
    end: u32,
}

impl OpenBlock {
    fn new(part: &PartialRender, index: usize, block: BlockSamples, end: u32) -> Self {
        let (rect, samples) = (part.blocks.rect(index), part.job.sampling.samples());
        let film = block.film(rect).unwrap_or_else(|| film_of(rect));
        let is_half = part.job.adaptive && (block.to, end) == (half(samples), pilot(samples));
        let before = is_half.then(|| film.clone());
        OpenBlock { block, rect, film, before, end }
    }

    /// Returns the block after the pass, for which `rays` rays were traced.
    fn finish(self, part: &PartialRender, rays: u64) -> BlockSamples {
        let OpenBlock { mut block, rect, film, before, end } = self;
        block.rays += rays;
        block.variances = before.map(|half| variances(&half, &film, rect)).or(block.variances);
        (block.to, block.film) = (end, Some(Arc::new(PackedFilm::new(film, part.packed_samples()))));
        block
    }
}

/// Function to call between tiles if there are no threads besides the calling thread.
type PollFn<'a> = Option<&'a mut dyn FnMut()>;

/// Data that all threads of a render share.
struct Work<'a> {
    part: &'a PartialRender,
    world: &'a World,
    control: &'a Control,
    samples: SampleSource<'a>,
    stop: &'a AtomicBool,
    tile: u32,
    /// Number of tiles that have been started.
    tiles: AtomicU64,
    panicked: Mutex<Option<Panicked>>,
}

impl<'a> Work<'a> {
    fn new(part: &'a PartialRender, world: &'a World, control: &'a Control, stop: &'a AtomicBool, tile: u32) -> Self {
        let samples = SampleSource::new(world, &part.job, stop);
        Work { part, world, control, samples, stop, tile, tiles: AtomicU64::new(0), panicked: Mutex::new(None) }
    }

    /// Returns how the render ended.
    fn outcome(&self, out_of_time: bool) -> RenderOutcome {
        let panicked = self.panicked.lock().unwrap_or_else(PoisonError::into_inner).take();
        match panicked {
            Some(panicked) => RenderOutcome::Panicked(panicked),
            None if !self.stop.load(Relaxed) => RenderOutcome::Finished,
            None if out_of_time => RenderOutcome::OutOfTime,
            None => RenderOutcome::Cancelled,
        }
    }

    /// Traces the centre rays that have not been traced yet.
    fn rays(&self, alone: PollFn) {
        let part = self.part;
        let open = |(index, block): (usize, &Option<Box<BlockAovs>>)| {
            (block.is_none() && part.shard.has_rays(index)).then_some(index)
        };
        let blocks: Vec<usize> = part.state().rays.iter().enumerate().filter_map(open).collect();
        let tiles = part.ray_blocks.tiles(blocks.into_iter(), self.tile);
        self.for_each_tile(&tiles, alone, |tile, at| {
            let trace = |&index: &usize| {
                center_rays::trace(self.world, &part.job, &self.samples, part.ray_blocks.rect(index), at)
            };
            let traced = tile.iter().map(trace).collect::<Result<Vec<_>, _>>()?;
            let pixels: usize = traced.iter().map(|block| block.hits.len()).sum();
            let rays = traced.iter().map(|block| block.rays).sum();
            let mut state = part.state();
            for (&index, block) in tile.iter().zip(traced) {
                state.rays[index] = Some(Box::new(block));
            }
            self.count(pixels as u64, rays);
            Ok(())
        });
    }

    /// Takes samples until every pixel has `end` samples, or fewer if it needs fewer.
    fn pass(&self, end: u32, alone: PollFn) {
        if !self.stop.load(Relaxed) {
            self.samples.integrator.prepare(end - 1);
        }
        let (part, gain) = (self.part, self.samples.gain());
        if part.job.adaptive && end > pilot(part.job.sampling.samples()) && !part.allocate() {
            return;
        }
        let tiles = part.blocks.tiles(self.open_blocks(end, gain).into_iter(), self.tile);
        self.for_each_tile(&tiles, alone, |tile, at| {
            if part.job.sampling.is_local() { self.sample(tile, end, at) } else { self.finish(tile, at) }
        });
    }

    /// Returns the blocks that need samples up to `end`.
    fn open_blocks(&self, end: u32, gain: f32) -> Vec<usize> {
        let part = self.part;
        let open = |(index, block): (usize, &BlockSamples)| {
            let wanted = part.shard.has_block(index) && block.to < end && !part.is_done(index, block, gain);
            wanted.then_some(index)
        };
        part.state().samples.iter().enumerate().filter_map(open).collect()
    }

    /// Adds samples to the blocks of a tile.
    fn sample(&self, tile: &[usize], end: u32, at: &SampleCursor) -> Result<(), Cancelled> {
        let part = self.part;
        let mut finished_blocks = Vec::with_capacity(tile.len());
        let (mut taken, mut traced) = (0, 0);
        for (&index, block) in tile.iter().zip(self.block_copies(tile)) {
            let mut open = OpenBlock::new(part, index, block, end);
            let (block, rect) = (&open.block, open.rect);
            let mut rays = RayCount::default();
            let range = |pixel| block.count(&part.job, pixel, block.to)..block.count(&part.job, pixel, end);
            self.samples.add(&mut open.film, rect, range, at, &mut rays)?;
            let total = |end| block.total(&part.job, rect.pixels(), end);
            taken += total(end) - total(block.to);
            traced += rays.0;
            finished_blocks.push(open.finish(part, rays.0));
        }
        self.store(tile, finished_blocks, taken, traced);
        Ok(())
    }

    /// Computes the finished pixels of a tile for sampling methods in which a sample affects
    /// several pixels. If the tile is a rectangle, all of it is computed at once, and otherwise
    /// block by block.
    fn finish(&self, tile: &[usize], at: &SampleCursor) -> Result<(), Cancelled> {
        let blocks = &self.part.blocks;
        let rects: Vec<_> = tile.iter().map(|&index| blocks.rect(index)).collect();
        let around = rects.iter().skip(1).fold(rects[0], |a, b| a.union(*b));
        let at_once = around.pixels() == rects.iter().map(|rect| rect.pixels()).sum::<u64>();
        let mut rays = RayCount::default();
        let whole = if at_once { Some(self.samples.finished(around, at, &mut rays)?) } else { None };
        let mut finished_blocks = Vec::with_capacity(tile.len());
        let mut before = 0;
        for rect in &rects {
            let own = match &whole {
                Some(pixels) => {
                    let pixel = |(x, y)| pixels[((y - around.top) * around.width + (x - around.left)) as usize];
                    rect.pixel_positions().map(pixel).collect()
                }
                None => self.samples.finished(*rect, at, &mut rays)?,
            };
            let mut film = film_of(*rect);
            rect.pixel_positions().zip(own).for_each(|((x, y), seen)| film.add_with_coverage(x, y, 0, seen, 1.0));
            let film = Some(Arc::new(PackedFilm::new(film, 1)));
            finished_blocks.push(BlockSamples {
                from: 0,
                to: 1,
                rays: rays.0 - before,
                film,
                ..BlockSamples::default()
            });
            before = rays.0;
        }
        self.store(tile, finished_blocks, around.pixels(), rays.0);
        Ok(())
    }

    /// Returns copies of the blocks of a tile.
    fn block_copies(&self, tile: &[usize]) -> Vec<BlockSamples> {
        let state = self.part.state();
        tile.iter().map(|&index| state.samples[index].clone()).collect()
    }

    /// Stores the blocks of a tile after more work has been done on them.
    fn store(&self, tile: &[usize], mut finished_blocks: Vec<BlockSamples>, done: u64, rays: u64) {
        let mut state = self.part.state();
        for (&index, block) in tile.iter().zip(&mut finished_blocks) {
            std::mem::swap(&mut state.samples[index], block);
        }
        // Free the replaced blocks only after the lock has been released.
        drop(state);
        self.count(done, rays);
    }

    /// Adds to the progress counters.
    fn count(&self, done: u64, rays: u64) {
        self.control.done_work.fetch_add(done, Relaxed);
        self.control.rays.fetch_add(rays, Relaxed);
    }

    /// Renders tiles until something stops the render. Tiles are rendered in parallel if there are
    /// threads. A panic is converted to an error that names the sample.
    fn for_each_tile(
        &self,
        tiles: &[Vec<usize>],
        alone: PollFn,
        make: impl Fn(&[usize], &SampleCursor) -> Result<(), Cancelled> + Sync,
    ) {
        let one = |tile: &Vec<usize>| {
            if self.control.max_tiles.is_some_and(|most| self.tiles.fetch_add(1, Relaxed) >= most) {
                self.stop.store(true, Relaxed);
            }
            self.samples.check()?;
            let at: SampleCursor = Cell::new((0, 0, None));
            catch_unwind(AssertUnwindSafe(|| make(tile, &at))).unwrap_or_else(|payload| {
                let (x, y, sample) = at.get();
                let text = payload.downcast_ref::<String>().map(String::as_str);
                let message = text.or_else(|| payload.downcast_ref::<&str>().copied()).unwrap_or("a panic").to_string();
                let mut panicked = self.panicked.lock().unwrap_or_else(PoisonError::into_inner);
                panicked.get_or_insert(Panicked { x, y, sample, message });
                self.stop.store(true, Relaxed);
                Err(Cancelled)
            })
        };
        // The error only ends the loop. Its cause is stored in `panicked` or `stop`.
        let _ = match alone {
            None => tiles.par_iter().with_max_len(1).try_for_each(one),
            Some(poll) => tiles.iter().try_for_each(|tile| {
                poll();
                one(tile)
            }),
        };
    }
}
