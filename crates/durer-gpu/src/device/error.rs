//! Errors of the device.

use crate::capability::{self, Feature};
use std::sync::{Mutex, MutexGuard, PoisonError};

/// Error of a graphics device.
#[derive(Clone, Debug, PartialEq, thiserror::Error)]
#[non_exhaustive]
pub enum GpuError {
    /// The system has no graphics adapter.
    #[error("there is no graphics adapter with Vulkan, Metal or DirectX 12 ({0})")]
    NoAdapter(String),
    /// The adapter could not be opened.
    #[error("the graphics adapter could not be opened: {0}")]
    Device(String),
    /// The scene or the job uses features that the device cannot render.
    #[error("{}", capability::sentence(.0))]
    Refused(Vec<Feature>),
    /// A table of the scene is larger than the device's largest buffer.
    #[error("the {what} of the scene need {needed} bytes, but a buffer of the GPU holds {allowed}")]
    TooLarge {
        /// Name of the table.
        what: &'static str,
        /// Size of the table in bytes.
        needed: u64,
        /// Size of the largest buffer in bytes.
        allowed: u64,
    },
    /// The device has too little memory.
    #[error("the GPU has too little memory: {0}")]
    OutOfMemory(String),
    /// A shader or a command is invalid, which is a bug in Dürer or in the driver.
    #[error("the GPU rejected a shader or a command: {0}")]
    Invalid(String),
    /// The device was lost.
    #[error("the GPU was lost: {0}")]
    Lost(String),
    /// A camera ray caused too many secondary rays.
    #[error("a camera ray causes more than {0} rays: use fewer --bounces, or --device cpu")]
    TooManyRays(u32),
    /// Too many transparent objects overlap.
    #[error("more than {0} transparent objects overlap at one point: use --device cpu")]
    TooManyMedia(u32),
    /// Too many materials are mixed at a point.
    #[error("more than {0} materials are mixed at one point: use --device cpu")]
    TooManyParts(u32),
}

impl From<wgpu::Error> for GpuError {
    fn from(error: wgpu::Error) -> Self {
        match &error {
            wgpu::Error::OutOfMemory { .. } => GpuError::OutOfMemory(error.to_string()),
            _ => GpuError::Invalid(error.to_string()),
        }
    }
}

/// Errors that the device reports outside of the calls that cause them.
#[derive(Debug, Default)]
pub(super) struct Faults(Mutex<Option<GpuError>>);

impl Faults {
    fn lock(&self) -> MutexGuard<'_, Option<GpuError>> {
        self.0.lock().unwrap_or_else(PoisonError::into_inner)
    }

    /// Records an error, unless there already is one.
    pub(super) fn set(&self, error: &wgpu::Error) {
        let error = match error {
            wgpu::Error::OutOfMemory { .. } => GpuError::OutOfMemory(error.to_string()),
            _ => GpuError::Invalid(error.to_string()),
        };
        self.lock().get_or_insert(error);
    }

    /// Records that the device was lost, which is the cause of all other errors.
    pub(super) fn set_lost(&self, message: String) {
        *self.lock() = Some(GpuError::Lost(message));
    }

    /// Returns the recorded error.
    pub(super) fn check(&self) -> Result<(), GpuError> {
        self.lock().clone().map_or(Ok(()), Err)
    }
}
