//! Graphics device: adapter, buffers and dispatches.

mod error;
mod scene;

pub use error::GpuError;
pub use scene::SceneBuffers;

use crate::layout::RayResult;
use crate::shader::Kernel;
use error::Faults;
use std::sync::{Arc, Mutex, PoisonError};
use wgpu::{
    Adapter, Backends, BindGroupLayout, Buffer, BufferDescriptor, BufferUsages, ComputePipeline, Device,
    DeviceDescriptor, DeviceType, ErrorFilter, Instance, InstanceDescriptor, PowerPreference, Queue,
    RequestAdapterOptions,
};

/// First hit of a ray on the device, for tests.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct HitRecord {
    /// Distance as a multiple of the direction's length.
    pub t: f32,
    /// Surface coordinates.
    pub uv: [f32; 2],
    /// Number of the object.
    pub object: u32,
    /// Number of the triangle in its mesh; 0 for other shapes.
    pub part: u32,
}

/// Open graphics device.
pub struct GpuDevice {
    device: Device,
    queue: Queue,
    name: String,
    is_software: bool,
    faults: Arc<Faults>,
    /// Kernels that were compiled, which takes seconds with some drivers.
    pipelines: Mutex<Vec<(Kernel, ComputePipeline, BindGroupLayout)>>,
}

impl GpuDevice {
    /// Opens the fastest adapter of the system.
    ///
    /// # Errors
    /// Returns [`GpuError::NoAdapter`] if there is none, and [`GpuError::Device`] if it cannot be
    /// opened.
    pub fn open() -> Result<GpuDevice, GpuError> {
        pollster::block_on(GpuDevice::open_async())
    }

    async fn open_async() -> Result<GpuDevice, GpuError> {
        let descriptor = InstanceDescriptor {
            backends: Backends::VULKAN | Backends::METAL | Backends::DX12,
            ..InstanceDescriptor::new_without_display_handle()
        };
        let instance = Instance::new(descriptor.with_env());
        let options =
            RequestAdapterOptions { power_preference: PowerPreference::HighPerformance, ..Default::default() };
        let adapter = instance.request_adapter(&options).await;
        let adapter = adapter.map_err(|error| GpuError::NoAdapter(error.to_string()))?;
        GpuDevice::of(&adapter).await
    }

    async fn of(adapter: &Adapter) -> Result<GpuDevice, GpuError> {
        let info = adapter.get_info();
        let descriptor = DeviceDescriptor {
            label: Some("durer"),
            // Scenes can need larger buffers than every adapter guarantees.
            required_limits: adapter.limits(),
            ..Default::default()
        };
        let opened = adapter.request_device(&descriptor).await;
        let (device, queue) = opened.map_err(|error| GpuError::Device(error.to_string()))?;
        let faults = Arc::new(Faults::default());
        let lost = Arc::clone(&faults);
        device.set_device_lost_callback(move |_, message| lost.set_lost(message));
        let uncaptured = Arc::clone(&faults);
        device.on_uncaptured_error(Arc::new(move |error: wgpu::Error| uncaptured.set(&error)));
        let driver = [info.driver, info.driver_info].join(" ");
        let name = format!("{} ({}, {})", info.name, info.backend, driver.trim());
        let is_software = info.device_type == DeviceType::Cpu;
        Ok(GpuDevice { device, queue, name, is_software, faults, pipelines: Mutex::default() })
    }

    /// Returns the names of the adapter, the interface and the driver.
    pub fn name(&self) -> &str {
        &self.name
    }

    /// Returns true if the adapter is a program that runs on the CPU.
    pub fn is_software(&self) -> bool {
        self.is_software
    }

    /// Runs a function and returns the first error of the device that it causes.
    fn checked<R>(&self, run: impl FnOnce() -> R) -> Result<R, GpuError> {
        let memory = self.device.push_error_scope(ErrorFilter::OutOfMemory);
        let internal = self.device.push_error_scope(ErrorFilter::Internal);
        let validation = self.device.push_error_scope(ErrorFilter::Validation);
        let result = run();
        let errors = [validation, internal, memory].map(|scope| pollster::block_on(scope.pop()));
        match errors.into_iter().flatten().next() {
            Some(error) => Err(GpuError::from(error)),
            None => self.faults.check().map(|()| result),
        }
    }

    /// Returns a kernel, which is compiled at its first use.
    fn pipeline(&self, kernel: Kernel) -> Result<(ComputePipeline, BindGroupLayout), GpuError> {
        let mut pipelines = self.pipelines.lock().unwrap_or_else(PoisonError::into_inner);
        if let Some((_, pipeline, layout)) = pipelines.iter().find(|compiled| compiled.0 == kernel) {
            return Ok((pipeline.clone(), layout.clone()));
        }
        let (pipeline, layout) = self.compile(kernel)?;
        pipelines.push((kernel, pipeline.clone(), layout.clone()));
        Ok((pipeline, layout))
    }

    fn compile(&self, kernel: Kernel) -> Result<(ComputePipeline, BindGroupLayout), GpuError> {
        self.checked(|| {
            let source = wgpu::ShaderSource::Wgsl(kernel.source().into());
            let label = Some(kernel.entry_point());
            let module = self.device.create_shader_module(wgpu::ShaderModuleDescriptor { label, source });
            let layout = self.device.create_bind_group_layout(&scene::bindings());
            let pipeline_layout = self.device.create_pipeline_layout(&wgpu::PipelineLayoutDescriptor {
                label,
                bind_group_layouts: &[Some(&layout)],
                immediate_size: 0,
            });
            let pipeline = self.device.create_compute_pipeline(&wgpu::ComputePipelineDescriptor {
                label,
                layout: Some(&pipeline_layout),
                module: &module,
                entry_point: label,
                compilation_options: Default::default(),
                cache: None,
            });
            (pipeline, layout)
        })
    }

    /// Creates a buffer of at least one byte.
    fn buffer(&self, label: &str, bytes: u64, usage: BufferUsages) -> Buffer {
        let (label, size) = (Some(label), bytes.max(4).next_multiple_of(4));
        self.device.create_buffer(&BufferDescriptor { label, size, usage, mapped_at_creation: false })
    }

    /// Waits for all work, and copies results from a mappable buffer.
    fn read(&self, buffer: &Buffer, count: usize) -> Result<Vec<RayResult>, GpuError> {
        let slice = buffer.slice(..(count * size_of::<RayResult>()) as u64);
        let (sender, receiver) = std::sync::mpsc::channel();
        slice.map_async(wgpu::MapMode::Read, move |result| {
            // The receiver no longer exists if the wait failed.
            let _ = sender.send(result);
        });
        let waited = self.device.poll(wgpu::PollType::wait_indefinitely());
        self.faults.check()?;
        waited.map_err(|error| GpuError::Lost(error.to_string()))?;
        let mapped = receiver.recv().map_err(|error| GpuError::Lost(error.to_string()))?;
        mapped.map_err(|error| GpuError::Lost(error.to_string()))?;
        let view = slice.get_mapped_range().map_err(|error| GpuError::Lost(error.to_string()))?;
        let results = view.chunks_exact(size_of::<RayResult>()).map(bytemuck::pod_read_unaligned).collect();
        drop(view);
        buffer.unmap();
        Ok(results)
    }
}
