//! Bindings to Open Image Denoise 2, which is loaded at run time. They cover the part of its C
//! interface that is needed to denoise one picture.
//!
//! Source: the documentation at <https://www.openimagedenoise.org>. Results differ in their last
//! bits between machines.

#![expect(unsafe_code, reason = "calls a C library")]

use durer::image::Image;
use durer::math::Vec3;
use durer::render::NoisyPicture;
use libloading::{Library, Symbol};
use std::ffi::{CStr, c_char, c_int, c_void};
use std::path::{Path, PathBuf};
use std::ptr::null;

/// Environment variable that names the folder of the library, or the folder that contains `lib`.
const FOLDER: &str = "OIDN_DIR";

/// File name of the library.
const NAME: &str = if cfg!(windows) {
    "OpenImageDenoise.dll"
} else if cfg!(target_os = "macos") {
    "libOpenImageDenoise.2.dylib"
} else {
    "libOpenImageDenoise.so.2"
};

/// Values of `OIDN_DEVICE_TYPE_CPU` and `OIDN_FORMAT_FLOAT3`.
const CPU: c_int = 1;
const FLOAT3: c_int = 3;

/// Handle to an object of the library: a device, buffer or filter.
type Object = *mut c_void;

/// Denoises a picture with Open Image Denoise.
pub fn denoise(noisy: &NoisyPicture, threads: Option<usize>) -> Result<Image, String> {
    let library = load()?;
    let (width, height) = (noisy.picture.width as usize, noisy.picture.height as usize);
    let count = noisy.picture.pixels.len();
    if [&noisy.albedo, &noisy.normal].iter().any(|guide| guide.len() != count) || count != width * height {
        return Err("the picture has no albedo or normals".into());
    }
    // The library expects albedo in [0, 1] and finite values.
    let albedo: Vec<Vec3> = noisy.albedo.iter().map(|albedo| albedo.clamp(Vec3::ZERO, Vec3::ONE)).collect();
    let mut clean = vec![Vec3::ZERO; count];
    // SAFETY: the names and types are those of oidn.h, version 2. A `Vec3` consists of three floats
    // without padding. All four pictures have width * height elements and live until the filter is
    // released. The output is read only after the filter has run.
    unsafe {
        let new_device: Symbol<unsafe extern "C" fn(c_int) -> Object> = symbol(&library, c"oidnNewDevice")?;
        let set_device: Symbol<unsafe extern "C" fn(Object, *const c_char, c_int)> =
            symbol(&library, c"oidnSetDeviceInt")?;
        let commit_device: Symbol<unsafe extern "C" fn(Object)> = symbol(&library, c"oidnCommitDevice")?;
        let error: Symbol<unsafe extern "C" fn(Object, *mut *const c_char) -> c_int> =
            symbol(&library, c"oidnGetDeviceError")?;
        let release_device: Symbol<unsafe extern "C" fn(Object)> = symbol(&library, c"oidnReleaseDevice")?;
        let new_filter: Symbol<unsafe extern "C" fn(Object, *const c_char) -> Object> =
            symbol(&library, c"oidnNewFilter")?;
        type SetImage =
            unsafe extern "C" fn(Object, *const c_char, *mut c_void, c_int, usize, usize, usize, usize, usize);
        let set_image: Symbol<SetImage> = symbol(&library, c"oidnSetSharedFilterImage")?;
        let set_filter: Symbol<unsafe extern "C" fn(Object, *const c_char, bool)> =
            symbol(&library, c"oidnSetFilterBool")?;
        let commit_filter: Symbol<unsafe extern "C" fn(Object)> = symbol(&library, c"oidnCommitFilter")?;
        let execute: Symbol<unsafe extern "C" fn(Object)> = symbol(&library, c"oidnExecuteFilter")?;
        let release_filter: Symbol<unsafe extern "C" fn(Object)> = symbol(&library, c"oidnReleaseFilter")?;

        let device = new_device(CPU);
        if device.is_null() {
            return Err("Open Image Denoise does not support this processor".into());
        }
        if let Some(threads) = threads.and_then(|threads| c_int::try_from(threads).ok()) {
            set_device(device, c"numThreads".as_ptr(), threads);
        }
        commit_device(device);
        let filter = new_filter(device, c"RT".as_ptr());
        if !filter.is_null() {
            // The C interface has the same pointer type for inputs and outputs.
            for (name, pixels) in [
                (c"color", noisy.picture.pixels.as_ptr().cast_mut()),
                (c"albedo", albedo.as_ptr().cast_mut()),
                (c"normal", noisy.normal.as_ptr().cast_mut()),
                (c"output", clean.as_mut_ptr()),
            ] {
                set_image(filter, name.as_ptr(), pixels.cast(), FLOAT3, width, height, 0, 0, 0);
            }
            set_filter(filter, c"hdr".as_ptr(), true);
            commit_filter(filter);
            execute(filter);
            release_filter(filter);
        }
        let mut message = null();
        let code = error(device, &mut message);
        let reason = match message.is_null() {
            true => String::new(),
            false => CStr::from_ptr(message).to_string_lossy().into_owned(),
        };
        release_device(device);
        if filter.is_null() || code != 0 {
            return Err(format!("Open Image Denoise failed: {reason}"));
        }
    }
    Image::from_pixels(noisy.picture.width, noisy.picture.height, clean).map_err(|error| error.to_string())
}

/// Returns the library function with the given name.
///
/// # Safety
/// `T` must be the type of the function.
unsafe fn symbol<'l, T>(library: &'l Library, name: &CStr) -> Result<Symbol<'l, T>, String> {
    // SAFETY: the caller guarantees that the type is the function's type.
    unsafe { library.get(name.to_bytes_with_nul()) }.map_err(|_| {
        let name = name.to_string_lossy();
        format!("the library is not version 2 of Open Image Denoise (the function `{name}` is missing)")
    })
}

fn load() -> Result<Library, String> {
    let folder = std::env::var_os(FOLDER).map(PathBuf::from);
    let folders = folder.iter().flat_map(|folder| [folder.join(NAME), folder.join("lib").join(NAME)]);
    let file = folders.into_iter().find(|file| file.is_file()).unwrap_or_else(|| Path::new(NAME).to_path_buf());
    // SAFETY: loading the library runs its initialisers. The user or the operating system installed
    // the library.
    unsafe { Library::new(&file) }.map_err(|_| "Open Image Denoise was not found".into())
}
