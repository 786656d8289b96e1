//! Choice of the processor that computes the colours of a picture.

use crate::failure::{Failure, invalid_input};
use durer::render::{Control, Job, PartialRender, RenderError, RenderEvent, RenderOutcome};
use durer::world::World;

/// Values of `--device`.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, clap::ValueEnum)]
pub enum DeviceChoice {
    /// The CPU, whose results do not depend on the machine
    #[default]
    Cpu,
    /// The graphics processor; fails if it cannot render the scene
    Gpu,
    /// The graphics processor if there is one that can render the scene, else the CPU
    Auto,
}

/// Graphics device with the uploaded scene.
#[cfg(feature = "gpu")]
pub type Device = durer_gpu::SceneBuffers;

/// Type without values, because only builds with the feature `gpu` have graphics devices.
#[cfg(not(feature = "gpu"))]
pub enum Device {}

/// Returns the device for a job, and sets the job's device, or returns `None` for the CPU. Under
/// `auto`, a note says why the CPU is used unless `quiet` is set. `blocker` is an option that only
/// the CPU supports.
pub fn open(
    choice: DeviceChoice,
    job: &mut Job,
    world: &World,
    blocker: Option<&str>,
    quiet: bool,
) -> Result<Option<Device>, Failure> {
    if choice == DeviceChoice::Cpu {
        return Ok(None);
    }
    let opened = match blocker {
        Some(option) => Err(format!("{option} needs the CPU")),
        None => open_device(choice, job, world),
    };
    match opened {
        Ok(device) => Ok(Some(device)),
        Err(why) if choice == DeviceChoice::Gpu => {
            Err(invalid_input(format!("{why}: remove `--device gpu`, or use `--device auto`")))
        }
        Err(why) => {
            if !quiet {
                crate::terminal::print_error_line(&format!("note: rendering on the CPU: {why}"));
            }
            Ok(None)
        }
    }
}

#[cfg(feature = "gpu")]
fn open_device(choice: DeviceChoice, job: &mut Job, world: &World) -> Result<Device, String> {
    let gpu = durer_gpu::GpuDevice::open().map_err(|error| error.to_string())?;
    if choice == DeviceChoice::Auto && gpu.is_software() {
        return Err(format!("the only graphics adapter is a program, {}", gpu.name()));
    }
    let gpu = std::sync::Arc::new(gpu);
    let device = Device::new(&gpu, world, job).map_err(|error| error.to_string())?;
    job.device = Some(gpu.name().into());
    Ok(device)
}

#[cfg(not(feature = "gpu"))]
fn open_device(_: DeviceChoice, _: &mut Job, _: &World) -> Result<Device, String> {
    Err("this `durer` was built without graphics processors (build it with \
         `cargo build --release -p durer-cli --features gpu`)"
        .into())
}

/// Continues a part on the device, or on the CPU if there is none.
pub fn render(
    device: Option<&mut Device>,
    part: &PartialRender,
    world: &World,
    control: &Control,
    watch: &mut dyn FnMut(&PartialRender, RenderEvent),
) -> Result<RenderOutcome, RenderError> {
    match device {
        #[cfg(feature = "gpu")]
        Some(device) => part.render_on(world, control, device, watch),
        #[cfg(not(feature = "gpu"))]
        Some(device) => match *device {},
        None => part.render(world, control, watch),
    }
}
