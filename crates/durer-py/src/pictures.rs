//! Image files and image comparison, with images as numpy arrays.

use crate::work::install;
use durer::image::compare::{self as comparing, Options, Picture, Scale};
use durer::image::{ChannelBits, Display, Image, Layer, Tone, Transfer, WriteOptions, format_for};
use durer::math::Vec3;
use durer::report;
use numpy::{IntoPyArray, PyArray1, PyReadonlyArray3};
use pyo3::exceptions::PyValueError;
use pyo3::prelude::*;
use pyo3::types::PyBytes;

fn wrong(error: impl ToString) -> PyErr {
    PyValueError::new_err(error.to_string())
}

/// Converts an array of shape (height, width, 3) to an image.
fn image(array: &PyReadonlyArray3<f32>) -> PyResult<Image> {
    let (shape, values) = (array.as_array().shape().to_vec(), array.as_slice()?);
    let pixels = values.chunks_exact(3).map(Vec3::from_slice).collect();
    Image::from_pixels(shape[1] as u32, shape[0] as u32, pixels).map_err(wrong)
}

/// Image to compare, together with a flag that is true if its values are display values instead of
/// linear light.
type ScaledPicture<'py> = (PyReadonlyArray3<'py, f32>, bool);

/// Compares an image with a reference image. Returns the result as JSON, and the FLIP error of each
/// pixel.
#[pyfunction]
pub fn compare<'py>(
    py: Python<'py>,
    reference: ScaledPicture<'py>,
    picture: ScaledPicture<'py>,
    tolerance: f32,
    allowed: f64,
) -> PyResult<(String, Bound<'py, PyArray1<f32>>)> {
    let scale = |display: bool| if display { Scale::Display } else { Scale::Linear };
    let reference = Picture { image: image(&reference.0)?, scale: scale(reference.1) };
    let picture = Picture { image: image(&picture.0)?, scale: scale(picture.1) };
    let options = Options { tolerance, allowed_share: allowed, ..Options::default() };
    let found = install(py, None, || comparing::compare(&reference, &picture, &options)).map_err(wrong)?;
    Ok((report::comparison(&found, &[]).to_string(), found.flip_map.into_pyarray(py)))
}

/// Image to encode: its name, its values, its coverage unless it is 1 everywhere, and a flag that
/// is true if the values are linear light.
type NamedPicture<'py> = (String, PyReadonlyArray3<'py, f32>, Option<Vec<f32>>, bool);

/// Conversion to display values: the exposure as a factor, the tone curve, the transfer function,
/// and the bits per channel.
type DisplayValues<'a> = (f32, &'a str, &'a str, u8);

fn display((exposure, tone, transfer, bits): DisplayValues) -> PyResult<Display> {
    let unknown =
        |what: &str, names: Vec<&str>| PyValueError::new_err(format!("{what} must be one of {}", names.join(", ")));
    let tones = || unknown("tone", Tone::ALL.iter().map(|row| row.0).collect());
    let transfers = || unknown("transfer", Transfer::ALL.iter().map(|t| t.name()).collect());
    let bits = match bits {
        8 => ChannelBits::Eight,
        16 => ChannelBits::Sixteen,
        _ => return Err(PyValueError::new_err(format!("bits must be 8 or 16, but is {bits}"))),
    };
    let transfer = Transfer::from_name(transfer).ok_or_else(transfers)?;
    Ok(Display { exposure, tone: Tone::from_name(tone).ok_or_else(tones)?, transfer, bits })
}

/// Encodes an image file. The extension of `name` selects the format.
#[pyfunction]
pub fn encode<'py>(
    py: Python<'py>,
    name: &str,
    layers: Vec<NamedPicture<'py>>,
    shown: DisplayValues,
) -> PyResult<Bound<'py, PyBytes>> {
    let format = format_for(std::path::Path::new(name)).map_err(wrong)?;
    let display = display(shown)?;
    let mut all = Vec::with_capacity(layers.len());
    for (name, pixels, coverage, color) in layers {
        let layer = if color { Layer::color(name, image(&pixels)?) } else { Layer::data(name, image(&pixels)?) };
        all.push(match coverage {
            Some(coverage) => layer.with_coverage(coverage),
            None => layer,
        });
    }
    let mut bytes = Vec::new();
    let options = WriteOptions { display, attributes: &[] };
    install(py, None, || format.write(&all, &options, &mut bytes)).map_err(wrong)?;
    Ok(PyBytes::new(py, &bytes))
}

/// Decodes an image file. Returns the values, the width, the height, and true if the values are
/// display values.
#[pyfunction]
pub fn decode<'py>(py: Python<'py>, bytes: &[u8], name: &str) -> PyResult<(Bound<'py, PyArray1<f32>>, u32, u32, bool)> {
    let picture = install(py, None, || Picture::read(bytes, name))
        .map_err(|error| wrong(format!("cannot read `{name}`: {error}")))?;
    let Image { width, height, pixels } = picture.image;
    let values: Vec<f32> = pixels.iter().flat_map(|pixel| pixel.to_array()).collect();
    Ok((values.into_pyarray(py), width, height, picture.scale == Scale::Display))
}
