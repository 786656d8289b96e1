//! Bindings to Embree 4, which is loaded at run time. Names and layouts follow `rtcore.h`.

use crate::rays::{BenchHit, Mesh};
use anyhow::{Context, Result, bail};
use durer::math::Ray;
use glam::DAffine3;
use libloading::{Library, Symbol};
use std::ffi::{CString, c_char, c_int, c_uint, c_void};
use std::mem::ManuallyDrop;
use std::path::{Path, PathBuf};
use std::sync::Arc;
use std::sync::atomic::{AtomicI64, Ordering};

/// Instructions for installing Embree.
pub const INSTALL_HINT: &str = "Embree 4 was not found. To install it, for example:
  pip download embreex --no-deps -d /tmp/embreex && cd /tmp/embreex && unzip -o embreex-*.whl
and set DURER_EMBREE=/tmp/embreex/embreex.libs (a folder, or the file libembree4*.so itself). Debian's libembree-dev 4 also
works. Without Embree, pass --no-embree.";

/// Handle of an Embree object: a device, scene, geometry or buffer.
type Handle = *mut c_void;

/// Embree's `RTCRayHit`: a ray and its hit.
#[repr(C, align(16))]
#[derive(Clone, Copy)]
struct RayHit1 {
    org: [f32; 3],
    tnear: f32,
    dir: [f32; 3],
    time: f32,
    tfar: f32,
    mask: c_uint,
    id: c_uint,
    flags: c_uint,
    ng: [f32; 3],
    u: f32,
    v: f32,
    prim: c_uint,
    geom: c_uint,
    inst: [c_uint; 2],
    padding: [c_uint; 3],
}

/// Embree's `RTCRayHit16`: sixteen rays and hits in structure-of-arrays layout, with the fields of
/// [`RayHit1`].
#[repr(C, align(64))]
struct RayHit16 {
    ray: [[f32; 16]; 12],
    ng: [[f32; 16]; 3],
    uv: [[f32; 16]; 2],
    prim: [c_uint; 16],
    geom: [c_uint; 16],
    inst: [[c_uint; 16]; 2],
}

/// Embree's `RTCIntersectArguments` and `RTCOccludedArguments`.
#[repr(C)]
struct QueryArguments {
    flags: c_uint,
    feature_mask: c_uint,
    context: Handle,
    filter: Handle,
    callback: Handle,
    min_width_distance_factor: f32,
}

const NO_GEOMETRY: c_uint = c_uint::MAX;
const COHERENT: c_uint = 1 << 16;

macro_rules! functions {
    ($($name:ident: fn($($arg:ty),*) $(-> $out:ty)?;)*) => {
        // Use the names of the header.
        /// Embree's functions, looked up by name in the loaded library.
        #[allow(non_snake_case)]
        struct Functions { $($name: unsafe extern "C" fn($($arg),*) $(-> $out)?,)* }
        impl Functions {
            #[allow(non_snake_case)]
            fn load(library: &Library) -> Result<Self> {
                // SAFETY: the types match Embree 4's header.
                unsafe {
                    $(let $name: Symbol<unsafe extern "C" fn($($arg),*) $(-> $out)?> =
                        library.get(concat!(stringify!($name), "\0").as_bytes())?;)*
                    Ok(Functions { $($name: *$name,)* })
                }
            }
        }
    };
}

/// Callback that Embree calls when it allocates or frees memory.
type Monitor = unsafe extern "C" fn(Handle, isize, bool) -> bool;

functions! {
    rtcNewDevice: fn(*const c_char) -> Handle;
    rtcReleaseDevice: fn(Handle);
    rtcSetDeviceMemoryMonitorFunction: fn(Handle, Monitor, Handle);
    rtcGetDeviceProperty: fn(Handle, c_int) -> isize;
    rtcNewScene: fn(Handle) -> Handle;
    rtcReleaseScene: fn(Handle);
    rtcSetSceneBuildQuality: fn(Handle, c_int);
    rtcSetSceneFlags: fn(Handle, c_int);
    rtcCommitScene: fn(Handle);
    rtcNewGeometry: fn(Handle, c_int) -> Handle;
    rtcReleaseGeometry: fn(Handle);
    rtcSetNewGeometryBuffer: fn(Handle, c_int, c_uint, c_int, usize, usize) -> Handle;
    rtcCommitGeometry: fn(Handle);
    rtcAttachGeometry: fn(Handle, Handle) -> c_uint;
    rtcSetGeometryInstancedScene: fn(Handle, Handle);
    rtcSetGeometryTransform: fn(Handle, c_uint, c_int, *const f32);
    rtcIntersect1: fn(Handle, *mut RayHit1, *const QueryArguments);
    rtcOccluded1: fn(Handle, *mut RayHit1, *const QueryArguments);
    rtcIntersect16: fn(*const c_int, Handle, *mut RayHit16, *const QueryArguments);
    rtcOccluded16: fn(*const c_int, Handle, *mut RayHit16, *const QueryArguments);
}
impl Embree {
    /// Loads the library and creates a device.
    pub fn load(path: &Path, threads: usize) -> Result<Self> {
        // The task library is in the same folder, with a name chosen by the Python wheel.
        let companions: Vec<Library> = siblings(path, "libtbb")
            .iter()
            // SAFETY: loading runs the initialisers of a library that the user chose.
            .filter_map(|path| unsafe { Library::new(path) }.ok())
            .collect();
        // SAFETY: as above.
        let library = unsafe { Library::new(path) }.with_context(|| path.display().to_string())?;
        let functions = Functions::load(&library)?;
        let config = CString::new(format!("threads={threads}"))?;
        // SAFETY: the configuration is a C string.
        let device = unsafe { (functions.rtcNewDevice)(config.as_ptr()) };
        if device.is_null() {
            bail!("Embree cannot create a device");
        }
        let memory = Box::new(AtomicI64::new(0));
        // SAFETY: the counter lives as long as the device.
        unsafe { (functions.rtcSetDeviceMemoryMonitorFunction)(device, count_memory, (&raw const *memory) as Handle) };
        // SAFETY: property 0 is the version.
        let version = unsafe { (functions.rtcGetDeviceProperty)(device, 0) };
        Ok(Embree { functions, device, memory, version, _libraries: ManuallyDrop::new((library, companions)) })
    }
}

unsafe extern "C" fn count_memory(counter: Handle, bytes: isize, _after: bool) -> bool {
    // SAFETY: the pointer is the counter that was passed at registration.
    unsafe { &*(counter as *const AtomicI64) }.fetch_add(bytes as i64, Ordering::Relaxed);
    true
}

/// The loaded Embree library and a device, with which scenes for the comparison are built.
pub struct Embree {
    functions: Functions,
    device: Handle,
    memory: Box<AtomicI64>,
    version: isize,
    /// Never unloaded, because Embree's threads may still run in it.
    _libraries: ManuallyDrop<(Library, Vec<Library>)>,
}

// SAFETY: Embree's device and committed scenes may be used from any thread.
unsafe impl Send for Embree {}
// SAFETY: as above.
unsafe impl Sync for Embree {}

/// Quality of Embree's BVH builds, `RTCBuildQuality`.
#[derive(Clone, Copy, PartialEq)]
pub enum Quality {
    Medium = 1,
    High = 2,
}

impl Embree {
    /// Returns the version of the library.
    pub fn version(&self) -> String {
        format!("{}.{}.{}", self.version / 10000, self.version / 100 % 100, self.version % 100)
    }

    /// Builds a scene with one mesh. Also returns the time of the commit in seconds.
    pub fn build(self: &Arc<Self>, mesh: &Mesh, quality: Quality, robust: bool) -> (Scene, f64) {
        let f = &self.functions;
        self.commit(quality, robust, |scene| {
            // SAFETY: calls in the order of the manual; the buffers have the requested size.
            unsafe {
                let geometry = (f.rtcNewGeometry)(self.device, 0);
                let vertices = (f.rtcSetNewGeometryBuffer)(geometry, 1, 0, 0x9003, 12, mesh.vertices.len());
                std::slice::from_raw_parts_mut(vertices as *mut durer::math::Vec3, mesh.vertices.len())
                    .copy_from_slice(&mesh.vertices);
                let indices = (f.rtcSetNewGeometryBuffer)(geometry, 0, 0, 0x5003, 12, mesh.triangles.len());
                std::slice::from_raw_parts_mut(indices as *mut [u32; 3], mesh.triangles.len())
                    .copy_from_slice(&mesh.triangles);
                self.attach(scene, geometry);
            }
        })
    }

    /// Builds a scene of instances. Also returns the time of the commit in seconds.
    pub fn build_instances(self: &Arc<Self>, object: &Scene, places: &[DAffine3]) -> (Scene, f64) {
        const INSTANCE: c_int = 121;
        const COLUMNS_OF_3X4: c_int = 0x9234;
        let f = &self.functions;
        self.commit(Quality::High, false, |scene| {
            for place in places {
                let columns = place.as_affine3().to_cols_array();
                // SAFETY: the instanced scene is committed; the matrix has twelve numbers.
                unsafe {
                    let geometry = (f.rtcNewGeometry)(self.device, INSTANCE);
                    (f.rtcSetGeometryInstancedScene)(geometry, object.scene);
                    (f.rtcSetGeometryTransform)(geometry, 0, COLUMNS_OF_3X4, columns.as_ptr());
                    self.attach(scene, geometry);
                }
            }
        })
    }

    /// # Safety
    ///
    /// Both handles must be valid; the geometry is consumed.
    unsafe fn attach(&self, scene: Handle, geometry: Handle) {
        let f = &self.functions;
        // SAFETY: by the caller's contract.
        unsafe {
            (f.rtcCommitGeometry)(geometry);
            (f.rtcAttachGeometry)(scene, geometry);
            (f.rtcReleaseGeometry)(geometry);
        }
    }

    fn commit(self: &Arc<Self>, quality: Quality, robust: bool, fill: impl FnOnce(Handle)) -> (Scene, f64) {
        let f = &self.functions;
        // SAFETY: calls in the order of the manual.
        unsafe {
            let scene = (f.rtcNewScene)(self.device);
            (f.rtcSetSceneBuildQuality)(scene, quality as c_int);
            (f.rtcSetSceneFlags)(scene, if robust { 1 << 2 } else { 0 });
            fill(scene);
            let before = self.memory.load(Ordering::Relaxed);
            let clock = std::time::Instant::now();
            (f.rtcCommitScene)(scene);
            let seconds = clock.elapsed().as_secs_f64();
            let bytes = (self.memory.load(Ordering::Relaxed) - before).max(0) as usize;
            (Scene { embree: self.clone(), scene, bytes }, seconds)
        }
    }
}

impl Drop for Embree {
    fn drop(&mut self) {
        // SAFETY: no scene outlives it, because each holds an `Arc`.
        unsafe { (self.functions.rtcReleaseDevice)(self.device) }
    }
}

/// A committed Embree scene, ready to be traced.
pub struct Scene {
    embree: Arc<Embree>,
    scene: Handle,
    /// Size of the BVH in bytes, without vertices and indices.
    pub bytes: usize,
}

// SAFETY: a committed scene may be traced from any thread.
unsafe impl Send for Scene {}
// SAFETY: as above.
unsafe impl Sync for Scene {}

impl Drop for Scene {
    fn drop(&mut self) {
        // SAFETY: released once.
        unsafe { (self.embree.functions.rtcReleaseScene)(self.scene) }
    }
}

fn single(ray: &Ray) -> RayHit1 {
    RayHit1 {
        org: ray.origin.to_array(),
        tnear: ray.t_min,
        dir: ray.dir.to_array(),
        time: 0.0,
        tfar: ray.t_max,
        mask: c_uint::MAX,
        id: 0,
        flags: 0,
        ng: [0.0; 3],
        u: 0.0,
        v: 0.0,
        prim: NO_GEOMETRY,
        geom: NO_GEOMETRY,
        inst: [NO_GEOMETRY; 2],
        padding: [0; 3],
    }
}

impl Scene {
    /// Returns the closest hit of a ray.
    pub fn closest(&self, ray: &Ray) -> BenchHit {
        let mut query = single(ray);
        // SAFETY: the record matches the header, and is aligned.
        unsafe { (self.embree.functions.rtcIntersect1)(self.scene, &mut query, std::ptr::null()) };
        if query.geom == NO_GEOMETRY { BenchHit::NONE } else { BenchHit { t: query.tfar, triangle: query.prim } }
    }

    /// Returns true if a ray hits anything.
    pub fn occluded(&self, ray: &Ray) -> bool {
        let mut query = single(ray);
        // SAFETY: a `RayHit1` is longer than the `RTCRay` that is needed.
        unsafe { (self.embree.functions.rtcOccluded1)(self.scene, &mut query, std::ptr::null()) };
        query.tfar < 0.0
    }

    /// Traces rays in packets of sixteen, which are marked as coherent or not.
    pub fn trace_packets(&self, rays: &[Ray], found: &mut [BenchHit], any: bool, coherent: bool) {
        let arguments = QueryArguments {
            flags: if coherent { COHERENT } else { 0 },
            feature_mask: c_uint::MAX,
            context: std::ptr::null_mut(),
            filter: std::ptr::null_mut(),
            callback: std::ptr::null_mut(),
            min_width_distance_factor: 0.0,
        };
        /// Validity mask of a packet of sixteen rays, aligned as Embree requires.
        #[repr(align(64))]
        struct Valid([c_int; 16]);
        for (rays, found) in rays.chunks(16).zip(found.chunks_mut(16)) {
            let mut valid = Valid([0; 16]);
            let mut query = RayHit16 {
                ray: [[0.0; 16]; 12],
                ng: [[0.0; 16]; 3],
                uv: [[0.0; 16]; 2],
                prim: [NO_GEOMETRY; 16],
                geom: [NO_GEOMETRY; 16],
                inst: [[NO_GEOMETRY; 16]; 2],
            };
            for (i, ray) in rays.iter().enumerate() {
                valid.0[i] = -1;
                for axis in 0..3 {
                    query.ray[axis][i] = ray.origin[axis];
                    query.ray[4 + axis][i] = ray.dir[axis];
                }
                query.ray[3][i] = ray.t_min;
                query.ray[8][i] = ray.t_max;
                query.ray[9][i] = f32::from_bits(u32::MAX);
            }
            let f = &self.embree.functions;
            let call = if any { f.rtcOccluded16 } else { f.rtcIntersect16 };
            // SAFETY: records match the header, and are aligned.
            unsafe { call(valid.0.as_ptr(), self.scene, &mut query, &arguments) };
            for (i, found) in found.iter_mut().enumerate() {
                let hit = if any { query.ray[8][i] < 0.0 } else { query.geom[i] != NO_GEOMETRY };
                *found = match (hit, any) {
                    (false, _) => BenchHit::NONE,
                    (true, true) => BenchHit { t: 0.0, triangle: 0 },
                    (true, false) => BenchHit { t: query.ray[8][i], triangle: query.prim[i] },
                };
            }
        }
    }
}

/// Returns the files in the folder of a library (or in a folder) whose names start with `prefix`,
/// sorted.
fn siblings(path: &Path, prefix: &str) -> Vec<PathBuf> {
    let folder = if path.is_dir() { path } else { path.parent().unwrap_or(Path::new(".")) };
    let mut found: Vec<PathBuf> = std::fs::read_dir(folder)
        .into_iter()
        .flatten()
        .filter_map(|entry| Some(entry.ok()?.path()))
        .filter(|path| path.file_name().is_some_and(|name| name.to_string_lossy().starts_with(prefix)))
        .collect();
    found.sort();
    found
}

/// Finds the library: at `DURER_EMBREE`, or where pip and Debian install it.
pub fn find() -> Result<PathBuf> {
    if let Some(path) = std::env::var_os("DURER_EMBREE") {
        let path = PathBuf::from(path);
        if path.is_file() {
            return Ok(path);
        }
        return siblings(&path, "libembree4").pop().with_context(|| format!("no libembree4 in {}", path.display()));
    }
    let mut folders: Vec<PathBuf> =
        ["/tmp/embreex/embreex.libs", "/usr/lib/x86_64-linux-gnu", "/usr/lib", "/usr/local/lib"].map(Into::into).into();
    // Installed by `pip install embreex`.
    if let Ok(output) = std::process::Command::new("python3")
        .args(["-c", "import sysconfig; print(sysconfig.get_paths()['platlib'])"])
        .output()
    {
        let platlib = String::from_utf8_lossy(&output.stdout).trim().to_owned();
        folders.push(Path::new(&platlib).join("embreex.libs"));
    }
    folders.iter().find_map(|folder| siblings(folder, "libembree4").pop()).context(INSTALL_HINT)
}

const _: () = assert!(size_of::<RayHit1>() == 96 && size_of::<RayHit16>() == 64 * 21);
