//! Helpers for tests that need a graphics adapter.

#![allow(dead_code, reason = "each test uses some of the helpers")]

use durer_gpu::{GpuDevice, SceneBuffers};
use durer_render::compile::{AccelKind, testing};
use durer_render::film::Filter;
use durer_render::integrator::{IntegratorKind, RenderSettings};
use durer_render::render::{Control, Job, PartialRender, RenderOutcome, Sampling, Shard};
use durer_render::world::World;
use durer_scene::dialect::Dialect;
use durer_scene::math::Vec3;
use std::path::{Path, PathBuf};
use std::sync::{Arc, LazyLock};

/// Returns the device, or prints why there is none.
pub fn gpu() -> Option<Arc<GpuDevice>> {
    static GPU: LazyLock<Option<Arc<GpuDevice>>> = LazyLock::new(|| match GpuDevice::open() {
        Ok(gpu) => {
            eprintln!("adapter: {}", gpu.name());
            Some(Arc::new(gpu))
        }
        Err(error) => {
            eprintln!("skipped: {error}");
            None
        }
    });
    GPU.clone()
}

/// Returns the folder of the example scenes.
pub fn scenes() -> PathBuf {
    Path::new(env!("CARGO_MANIFEST_DIR")).join("../../scenes")
}

/// Compiles a scene with the rules of Dürer's own dialect.
pub fn world_of(text: &str) -> World {
    let (world, findings) = testing::try_read(text, Dialect::Durer.rules(), AccelKind::Bvh, &scenes());
    world.unwrap_or_else(|| panic!("{findings:?}"))
}

/// Compiles an example scene without its pictures, which the device cannot use.
pub fn scene(name: &str) -> World {
    let mut text = std::fs::read_to_string(scenes().join(name).with_extension("txt")).unwrap();
    for picture in ["cubeMap textures/sky", "texture textures/ground.png", "texture textures/drawing.png"] {
        text = text.replace(picture, "");
    }
    world_of(&text)
}

/// Returns a job with one ray per pixel.
pub fn job(method: IntegratorKind, (width, height): (u32, u32)) -> Job {
    Job { width, height, method, ..Job::default() }
}

/// Returns a path tracing job with a box filter.
pub fn path_job(size: (u32, u32), samples: u32, bounces: u32, seed: u64) -> Job {
    let sampling = Sampling::Filtered { samples, filter: Filter::Box { radius: 0.5 } };
    let job = job(IntegratorKind::PATH, size);
    Job { sampling, seed, settings: RenderSettings { bounces, ..job.settings }, ..job }
}

/// Renders on the CPU, or on the device if there is one.
pub fn render(world: &World, job: &Job, gpu: Option<&Arc<GpuDevice>>) -> PartialRender {
    let control = Control::default();
    let job = Job { device: gpu.map(|gpu| gpu.name().into()), ..job.clone() };
    let part = PartialRender::new(world, &job, Shard::WHOLE).unwrap();
    let outcome = match gpu {
        None => part.render(world, &control, &mut |_, _| {}).unwrap(),
        Some(gpu) => {
            let mut buffers = SceneBuffers::new(gpu, world, &job).unwrap_or_else(|error| panic!("{error}"));
            part.render_on(world, &control, &mut buffers, &mut |_, _| {}).unwrap()
        }
    };
    assert_eq!(outcome, RenderOutcome::Finished);
    part
}

/// Returns the linear colours of a finished part.
pub fn colors(part: &PartialRender) -> Vec<Vec3> {
    part.pictures().unwrap().layers.swap_remove(0).image.pixels.clone()
}
