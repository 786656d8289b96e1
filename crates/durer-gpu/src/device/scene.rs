//! Scene on the device, and dispatches of rays.

use super::{GpuDevice, GpuError, HitRecord};
use crate::capability;
use crate::layout::{self, Params, RayResult, WORKGROUP};
use crate::shader::Kernel;
use crate::tables::Tables;
use bytemuck::{Pod, Zeroable};
use durer_render::integrator::IntegratorKind;
use durer_render::render::{CameraRay, Job, RayDevice, TracedRay};
use durer_render::world::World;
use durer_scene::math::{Color, Ray, Vec3, noise};
use std::sync::Arc;
use std::time::{Duration, Instant};
use wgpu::{
    BindGroup, BindGroupLayout, BindGroupLayoutDescriptor, BindGroupLayoutEntry, BindingType, Buffer,
    BufferBindingType, BufferUsages, ComputePipeline, ShaderStages,
};

/// Largest number of rays of a dispatch.
const MOST_RAYS: usize = 1 << 20;
/// Number of rays of the first dispatch. Later ones take about [`GOAL`], so that no driver
/// considers the device as hung.
const FIRST_RAYS: usize = 1 << 12;
const GOAL: Duration = Duration::from_millis(100);

/// Number of read-only tables.
const TABLES: usize = 7;

/// Layout of the bindings in `bindings.wgsl`: the parameters, six tables, the rays, the results,
/// the permutation of the noise, and the albedos.
pub(super) fn bindings() -> BindGroupLayoutDescriptor<'static> {
    const fn entry(binding: u32, ty: BufferBindingType) -> BindGroupLayoutEntry {
        let ty = BindingType::Buffer { ty, has_dynamic_offset: false, min_binding_size: None };
        BindGroupLayoutEntry { binding, visibility: ShaderStages::COMPUTE, ty, count: None }
    }
    const READ: BufferBindingType = BufferBindingType::Storage { read_only: true };
    const WRITE: BufferBindingType = BufferBindingType::Storage { read_only: false };
    const ENTRIES: [BindGroupLayoutEntry; TABLES + 4] = [
        entry(0, BufferBindingType::Uniform),
        entry(1, READ),
        entry(2, READ),
        entry(3, READ),
        entry(4, READ),
        entry(5, READ),
        entry(6, READ),
        entry(7, READ),
        entry(8, WRITE),
        entry(9, BufferBindingType::Uniform),
        entry(10, READ),
    ];
    BindGroupLayoutDescriptor { label: Some("tables"), entries: &ENTRIES }
}

/// Scene whose tables were uploaded to a device, with the kernel for a job.
pub struct SceneBuffers {
    gpu: Arc<GpuDevice>,
    params: Params,
    pipeline: ComputePipeline,
    layout: BindGroupLayout,
    tables: [Buffer; TABLES],
    /// Parameters, and the permutation of the noise.
    uniforms: [Buffer; 2],
    rays: RayBuffers,
    /// Number of rays of the next dispatch.
    chunk: usize,
}

/// Buffers for the rays of one dispatch.
struct RayBuffers {
    capacity: usize,
    rays: Buffer,
    results: Buffer,
    mapped: Buffer,
    group: BindGroup,
}

impl SceneBuffers {
    /// Uploads a world for a job, after checking that the device can render both.
    ///
    /// # Errors
    /// Returns [`GpuError::Refused`] with the names of all unsupported features, and
    /// [`GpuError::TooLarge`] or [`GpuError::OutOfMemory`] if the scene does not fit.
    pub fn new(gpu: &Arc<GpuDevice>, world: &World, job: &Job) -> Result<Self, GpuError> {
        let refused = capability::refusals(world, job);
        if !refused.is_empty() {
            return Err(GpuError::Refused(refused));
        }
        let kernel = match job.method {
            IntegratorKind::Path(_) => Kernel::Path,
            _ => Kernel::Whitted,
        };
        let tables = Tables::new(world);
        SceneBuffers::with_kernel(gpu, &tables, params(world, job, &tables), kernel)
    }

    /// Uploads the geometry of a world to find hits, for tests.
    ///
    /// # Errors
    /// Returns the same errors as [`SceneBuffers::new`], but does not check for features.
    pub fn for_hits(gpu: &Arc<GpuDevice>, world: &World) -> Result<Self, GpuError> {
        let tables = Tables::new(world);
        SceneBuffers::with_kernel(gpu, &tables, params(world, &Job::default(), &tables), Kernel::Hits)
    }

    fn with_kernel(gpu: &Arc<GpuDevice>, tables: &Tables, params: Params, kernel: Kernel) -> Result<Self, GpuError> {
        let (pipeline, layout) = gpu.pipeline(kernel)?;
        let tables = [
            upload(gpu, "boxes", &tables.nodes)?,
            upload(gpu, "triangles", &tables.triangles)?,
            upload(gpu, "objects", &tables.objects)?,
            upload(gpu, "materials", &tables.materials)?,
            upload(gpu, "lights", &tables.lights)?,
            upload(gpu, "emitters", &tables.emitters)?,
            upload(gpu, "albedos", &tables.albedos)?,
        ];
        let uniforms = gpu.checked(|| {
            let usage = BufferUsages::UNIFORM | BufferUsages::COPY_DST;
            let permutation = noise::PERMUTATION.map(u32::from);
            let uniforms = [
                gpu.buffer("parameters", size_of::<Params>() as u64, usage),
                gpu.buffer("permutation", size_of_val(&permutation) as u64, usage),
            ];
            gpu.queue.write_buffer(&uniforms[1], 0, bytemuck::cast_slice(&permutation));
            uniforms
        })?;
        let rays = RayBuffers::new(gpu, &layout, (&uniforms, &tables), FIRST_RAYS)?;
        Ok(SceneBuffers { gpu: Arc::clone(gpu), params, pipeline, layout, tables, uniforms, rays, chunk: FIRST_RAYS })
    }

    /// Returns the first hit of each ray, for tests. `None` means that nothing was hit.
    ///
    /// # Errors
    /// Returns an error if the device failed.
    pub fn hits(&mut self, rays: &[Ray]) -> Result<Vec<Option<HitRecord>>, GpuError> {
        let rays: Vec<layout::CameraRay> = rays.iter().map(plain_ray).collect();
        let mut found = Vec::with_capacity(rays.len());
        self.dispatch_all(&rays, |_, RayResult { color: [t, u, v], rays: object, flags: part, .. }| {
            found.push((*object != layout::NONE).then_some(HitRecord {
                t: *t,
                uv: [*u, *v],
                object: *object,
                part: *part,
            }));
        })?;
        Ok(found)
    }

    /// Computes the radiance along each camera ray.
    ///
    /// # Errors
    /// Returns an error if the device failed or a limit of the shaders was exceeded.
    pub fn radiances(&mut self, rays: &[CameraRay], results: &mut [TracedRay]) -> Result<(), GpuError> {
        let uploaded: Vec<layout::CameraRay> = rays.iter().map(camera_ray).collect();
        let mut flags = 0;
        self.dispatch_all(&uploaded, |place, result| {
            flags |= result.flags;
            results[place] = TracedRay { color: Color::from_array(result.color), rays: result.rays };
        })?;
        let limits = [
            (layout::TOO_MANY_RAYS, GpuError::TooManyRays(layout::MAX_WHITTED_RAYS)),
            (layout::TOO_MANY_MEDIA, GpuError::TooManyMedia(layout::MAX_MEDIA)),
            (layout::TOO_MANY_PARTS, GpuError::TooManyParts(layout::MAX_PARTS)),
        ];
        limits.into_iter().find(|(flag, _)| flags & flag != 0).map_or(Ok(()), |(_, error)| Err(error))
    }

    /// Traces rays in dispatches whose size adapts to their duration, and calls `take` with the
    /// index and the result of each.
    fn dispatch_all(
        &mut self,
        rays: &[layout::CameraRay],
        mut take: impl FnMut(usize, &RayResult),
    ) -> Result<(), GpuError> {
        let mut done = 0;
        while done < rays.len() {
            let part = &rays[done..rays.len().min(done + self.chunk)];
            if part.len() > self.rays.capacity {
                self.rays = RayBuffers::new(&self.gpu, &self.layout, (&self.uniforms, &self.tables), self.chunk)?;
            }
            let start = Instant::now();
            let results = self.dispatch(part)?;
            results.iter().enumerate().for_each(|(i, result)| take(done + i, result));
            done += part.len();
            self.adapt(part.len(), start.elapsed());
        }
        Ok(())
    }

    /// Changes the size of dispatches by at most a factor of 2, given the duration of the last one.
    fn adapt(&mut self, rays: usize, elapsed: Duration) {
        if elapsed > 2 * GOAL {
            self.chunk = (self.chunk / 2).max(WORKGROUP as usize);
        } else if elapsed < GOAL / 2 && rays == self.chunk {
            let allowed =
                self.gpu.device.limits().max_storage_buffer_binding_size / size_of::<layout::CameraRay>() as u64;
            let groups = self.gpu.device.limits().max_compute_workgroups_per_dimension as usize * WORKGROUP as usize;
            self.chunk = (2 * self.chunk).min(MOST_RAYS).min(allowed as usize).min(groups);
        }
    }

    /// Traces rays in one dispatch.
    fn dispatch(&self, rays: &[layout::CameraRay]) -> Result<Vec<RayResult>, GpuError> {
        let gpu = &self.gpu;
        gpu.faults.check()?;
        let params = Params { ray_count: rays.len() as u32, ..self.params };
        gpu.queue.write_buffer(&self.uniforms[0], 0, bytemuck::bytes_of(&params));
        gpu.queue.write_buffer(&self.rays.rays, 0, bytemuck::cast_slice(rays));
        let mut encoder = gpu.device.create_command_encoder(&Default::default());
        {
            let mut pass = encoder.begin_compute_pass(&Default::default());
            pass.set_pipeline(&self.pipeline);
            pass.set_bind_group(0, &self.rays.group, &[]);
            pass.dispatch_workgroups(params.ray_count.div_ceil(WORKGROUP), 1, 1);
        }
        let bytes = rays.len() * size_of::<RayResult>();
        encoder.copy_buffer_to_buffer(&self.rays.results, 0, &self.rays.mapped, 0, bytes as u64);
        gpu.queue.submit([encoder.finish()]);
        gpu.read(&self.rays.mapped, rays.len())
    }
}

impl RayDevice for SceneBuffers {
    fn name(&self) -> &str {
        self.gpu.name()
    }

    fn capacity(&self) -> usize {
        MOST_RAYS
    }

    fn trace(&mut self, rays: &[CameraRay], results: &mut [TracedRay]) -> Result<(), String> {
        self.radiances(rays, results).map_err(|error| error.to_string())
    }
}

impl RayBuffers {
    fn new(
        gpu: &GpuDevice,
        layout: &BindGroupLayout,
        ([parameters, permutation], tables): (&[Buffer; 2], &[Buffer; TABLES]),
        capacity: usize,
    ) -> Result<Self, GpuError> {
        gpu.checked(|| {
            let bytes = |each: usize| (capacity * each) as u64;
            let (in_bytes, out_bytes) = (bytes(size_of::<layout::CameraRay>()), bytes(size_of::<RayResult>()));
            let rays = gpu.buffer("rays", in_bytes, BufferUsages::STORAGE | BufferUsages::COPY_DST);
            let results = gpu.buffer("results", out_bytes, BufferUsages::STORAGE | BufferUsages::COPY_SRC);
            let mapped = gpu.buffer("mapped results", out_bytes, BufferUsages::MAP_READ | BufferUsages::COPY_DST);
            let buffers =
                std::iter::once(parameters).chain(&tables[..6]).chain([&rays, &results, permutation, &tables[6]]);
            let entries: Vec<wgpu::BindGroupEntry> = (0..)
                .zip(buffers)
                .map(|(binding, buffer)| wgpu::BindGroupEntry { binding, resource: buffer.as_entire_binding() })
                .collect();
            let descriptor = wgpu::BindGroupDescriptor { label: Some("tables"), layout, entries: &entries };
            let group = gpu.device.create_bind_group(&descriptor);
            RayBuffers { capacity, rays, results, mapped, group }
        })
    }
}

/// Uploads a table. An empty table gets one element, because a binding must not be empty.
fn upload<T: Pod>(gpu: &GpuDevice, what: &'static str, rows: &[T]) -> Result<Buffer, GpuError> {
    let empty = [T::zeroed()];
    let bytes: &[u8] = bytemuck::cast_slice(if rows.is_empty() { &empty } else { rows });
    let limits = gpu.device.limits();
    let (needed, allowed) = (bytes.len() as u64, limits.max_storage_buffer_binding_size.min(limits.max_buffer_size));
    if needed > allowed {
        return Err(GpuError::TooLarge { what, needed, allowed });
    }
    gpu.checked(|| {
        let buffer = gpu.buffer(what, needed, BufferUsages::STORAGE | BufferUsages::COPY_DST);
        gpu.queue.write_buffer(&buffer, 0, bytes);
        buffer
    })
}

/// Returns the parameters of all dispatches for a job.
fn params(world: &World, job: &Job, tables: &Tables) -> Params {
    let settings = &job.settings;
    let flags = [
        (settings.shadows, layout::SHADOWS),
        (settings.shade_back, layout::SHADE_BACK),
        (settings.transparent_shadows, layout::TRANSPARENT_SHADOWS),
        (settings.reflection, layout::REFLECTION),
        (settings.refraction, layout::REFRACTION),
    ];
    let clamp = job.method.path_options().and_then(|options| options.clamp);
    let sky = if world.is_dark() { Color::ZERO } else { world.background() };
    Params {
        background: world.background().into(),
        light_count: tables.lights.len() as u32,
        ambient: world.ambient().into(),
        root: tables.root,
        sky: sky.into(),
        emitter_count: tables.emitters.len() as u32,
        bounces: settings.bounces,
        flags: flags.iter().filter(|(on, _)| *on).map(|(_, flag)| flag).sum(),
        min_weight: settings.min_weight,
        clamp: clamp.unwrap_or(-1.0),
        first_unbounded: tables.first_unbounded,
        ..Params::zeroed()
    }
}

/// Converts a ray. WGSL does not guarantee infinities, so the interval is limited to numbers.
fn plain_ray(ray: &Ray) -> layout::CameraRay {
    let origin: Vec3 = ray.origin;
    layout::CameraRay {
        origin: origin.into(),
        t_min: ray.t_min.max(-layout::FAR),
        dir: ray.dir.into(),
        t_max: ray.t_max.min(layout::FAR),
        ..layout::CameraRay::zeroed()
    }
}

fn camera_ray(camera: &CameraRay) -> layout::CameraRay {
    let key = camera.id.key();
    layout::CameraRay {
        key_low: key as u32,
        key_high: (key >> 32) as u32,
        sample: camera.id.sample,
        ..plain_ray(&camera.ray)
    }
}
