//! Rendering of Dürer's scenes on a graphics processor through wgpu, which uses Vulkan, Metal or
//! DirectX 12.
//!
//! [`Tables`] converts a compiled world to buffers. `GpuDevice` uploads them and traces camera rays
//! with the kernels of [`shader`]. [`capability`] lists what the device can render, and names what
//! it cannot. The camera rays, the sums of the samples and all pictures other than the colours are
//! computed by the CPU, with the code that every render uses.
//!
//! Without the feature `device`, the crate contains no graphics library.

mod bvh;
pub mod capability;
#[cfg(feature = "device")]
mod device;
mod emitters;
pub mod layout;
pub mod shader;
mod tables;

#[cfg(feature = "device")]
pub use device::{GpuDevice, GpuError, HitRecord, SceneBuffers};
pub use tables::Tables;
