//! Tests of requirements that every format in the table must meet.

use super::*;
use proptest::prelude::*;

/// Creates an asymmetric picture whose rows are long enough to be compressed.
fn sample() -> Image {
    let pixel = |i: u32| Vec3::new(i as f32 / 26.0, (i * i % 7) as f32 / 6.0, if i < 13 { 0.0 } else { 0.75 });
    Image::from_pixels(9, 3, (0..27).map(pixel).collect()).unwrap()
}

fn written(format: &Format, kind: LayerKind, transfer: Transfer, image: &Image) -> Vec<u8> {
    let layer = Layer { name: "beauty".into(), image: image.clone().into(), kind, coverage: None };
    let mut out = Vec::new();
    format.write(&[layer], &WriteOptions { display: transfer.into(), ..WriteOptions::default() }, &mut out).unwrap();
    out
}

fn name(format: &Format) -> String {
    format!("x.{}", format.extensions[0])
}

#[test]
fn what_is_written_is_read_back() {
    let image = sample();
    for format in FORMATS {
        for (kind, transfer) in
            [LayerKind::Color, LayerKind::Data].into_iter().flat_map(|k| Transfer::ALL.map(|t| (k, t)))
        {
            let bytes = written(format, kind, transfer, &image);
            match format.depth {
                Depth::EightBit => {
                    let curve =
                        if kind == LayerKind::Data && transfer == Transfer::Srgb { Transfer::Linear } else { transfer };
                    let expected: Vec<_> = image.pixels.iter().map(|&pixel| curve.encode_pixel(pixel)).collect();
                    let back = read8(&bytes, &name(format)).unwrap();
                    if format.name == "JPEG" {
                        let values = back.pixels.as_flattened().iter().zip(expected.as_flattened());
                        let differences: Vec<u8> = values.map(|(a, b)| a.abs_diff(*b)).collect();
                        let sum: u32 = differences.iter().map(|difference| u32::from(*difference)).sum();
                        assert!(sum < 4 * differences.len() as u32, "{differences:?}");
                        assert_eq!((back.width, back.height), (9, 3));
                        continue;
                    }
                    assert_eq!((back.width, back.height, back.pixels), (9, 3, expected), "{}", format.name);
                }
                Depth::Float => {
                    let back = read(&bytes, "").unwrap();
                    let exact = format.name != "Radiance HDR";
                    for (&a, &b) in back.pixels.iter().zip(&image.pixels) {
                        let error = (a - b).abs().max_element();
                        assert!(error <= if exact { 0.0 } else { b.max_element() / 256.0 }, "{}", format.name);
                    }
                    assert_eq!((back.width, back.height), (9, 3));
                }
            }
        }
    }
}

#[test]
fn odd_sizes_and_odd_values_are_written() {
    let odd = [f32::NAN, f32::INFINITY, -f32::INFINITY, -1.0, f32::MAX, 1e-45];
    for (width, height) in [(1, 1), (1, 6), (6, 1), (2, 3), (3, 700), (700, 3)] {
        let pixels = (0..width * height).map(|i| Vec3::splat(odd[i as usize % 6])).collect();
        let image = Image::from_pixels(width, height, pixels).unwrap();
        for format in FORMATS {
            let back = read(&written(format, LayerKind::Color, Transfer::Srgb, &image), &name(format)).unwrap();
            assert_eq!((back.width, back.height), (width, height), "{}", format.name);
        }
    }
}

#[test]
fn alpha_is_written_where_a_format_has_it_and_black_elsewhere() {
    let image = Image::from_pixels(2, 1, vec![Vec3::splat(0.25), Vec3::ZERO]).unwrap();
    let layer = Layer::data("x", image).with_coverage(vec![0.5, 0.0]);
    for format in FORMATS {
        let mut out = Vec::new();
        format.write(std::slice::from_ref(&layer), &WriteOptions::default(), &mut out).unwrap();
        let back = read(&out, &name(format)).unwrap();
        // `read` discards alpha. Formats with 8-bit alpha store colours that are not premultiplied.
        let straight = ["PNG", "TGA", "WebP"].contains(&format.name);
        let expected = if straight { 128.0 / 255.0 } else { 0.25 };
        assert!((back.pixels[0].x - expected).abs() < 0.002, "{}: {}", format.name, back.pixels[0]);
        assert_eq!(back.pixels[1], Vec3::ZERO, "{}", format.name);
        let opacity = match format.decode(&out) {
            Ok(Raster::Eight(picture)) => picture.alpha.first().map(|&alpha| f32::from(alpha) / 255.0),
            Ok(Raster::Sixteen(_, alpha) | Raster::Float(_, alpha)) => alpha.first().copied(),
            Err(error) => panic!("{}: {error}", format.name),
        };
        // The reader of OpenEXR discards the alpha of named layers.
        if format.depth == Depth::EightBit {
            assert_eq!(opacity.map(|opacity| (opacity - 0.5).abs() < 0.002), format.has_alpha.then_some(true));
        }
        // The number of coverage values must match the number of pixels.
        let odd = Layer { coverage: Some(vec![0.5]), ..layer.clone() };
        assert!(format.write(&[odd], &WriteOptions::default(), &mut Vec::new()).is_err());
    }
}

#[test]
fn sixteen_bits_are_kept_where_a_format_has_them() {
    let image = sample();
    let mut finer = Vec::new();
    for format in FORMATS.iter().filter(|format| format.supports_sixteen_bits()) {
        for coverage in [None, Some(vec![1.0; 27])] {
            let display = Display { bits: ChannelBits::Sixteen, ..Transfer::Linear.into() };
            let layer = Layer { name: "x".into(), image: image.clone().into(), kind: LayerKind::Color, coverage };
            let mut out = Vec::new();
            format.write(&[layer], &WriteOptions { display, attributes: &[] }, &mut out).unwrap();
            assert!(matches!(format.decode(&out), Ok(Raster::Sixteen(..))), "{}", format.name);
            let back = read(&out, &name(format)).unwrap();
            for (a, b) in back.pixels.iter().zip(&image.pixels) {
                // Half a step of 1 / 65535, and the rounding of single precision.
                assert!((*a - *b).abs().max_element() <= 0.5 / 65535.0 + f32::EPSILON, "{}: {a} {b}", format.name);
            }
        }
        finer.push(format.name);
    }
    assert_eq!(finer, ["PNG", "PPM"]);
}

#[test]
fn layers_that_do_not_fit_are_refused() {
    let options = WriteOptions::default();
    let small = Image::new(1, 1, Vec3::ZERO).unwrap();
    let broken = Image { width: 7, height: 7, pixels: Vec::new() };
    for format in FORMATS {
        let write = |layers: &[Layer]| format.write(layers, &options, &mut Vec::new());
        assert_eq!(write(&[]), Err(ImageError::NoLayer));
        assert_eq!(write(&[Layer::color("", broken.clone())]), Err(ImageError::InvalidSize { width: 7, height: 7 }));
        let two = [Layer::color("a", sample()), Layer::data("b", sample())];
        assert_eq!(write(&two).is_ok(), format.supports_layers, "{}", format.name);
        let differ = [Layer::color("a", sample()), Layer::data("b", small.clone())];
        assert!(write(&differ).is_err());
    }
}

#[test]
fn no_prefix_is_a_picture() {
    // A truncated JPEG is shown as far as it goes, as in web browsers.
    for format in FORMATS.iter().filter(|format| format.name != "JPEG") {
        let bytes = written(format, LayerKind::Color, Transfer::Linear, &sample());
        for end in 0..bytes.len() {
            // The last bytes of a PNG file, which are its end chunk, may be missing.
            let whole = read(&bytes[..end], &name(format)).is_ok();
            assert!(!whole || end + 16 > bytes.len(), "{} of {} bytes of {}", end, bytes.len(), format.name);
        }
    }
}

/// Checks that forged bytes cause an error or some other picture, but neither a panic nor a picture
/// larger than the limit.
fn survives(format: &Format, bytes: &[u8]) {
    if let Ok(image) = read(bytes, &name(format)) {
        assert!(image.check().is_ok());
        assert!(image.pixels.len() as u64 <= pixel_limit(bytes.len()));
    } else if let Err(ImageError::Malformed { reason, .. }) = read(bytes, &name(format)) {
        assert_ne!(reason, "its decoder failed", "{}", format.name);
    }
}

proptest! {
    #![proptest_config(ProptestConfig::with_cases(400))]

    #[test]
    fn flipped_bytes_do_no_harm(
        which in 0..FORMATS.len(),
        flips in prop::collection::vec((any::<prop::sample::Index>(), any::<u8>()), 1..6),
        at_head in any::<bool>(),
    ) {
        let format = &FORMATS[which];
        let mut bytes = written(format, LayerKind::Color, Transfer::Linear, &sample());
        for (index, value) in flips {
            // Most of the checks in decoders concern the first bytes.
            let range = if at_head { bytes.len().min(48) } else { bytes.len() };
            bytes[index.index(range)] = value;
        }
        survives(format, &bytes);
    }

    #[test]
    fn noise_behind_a_mark_does_no_harm(
        which in 0..FORMATS.len(),
        keep in 0usize..20,
        noise in prop::collection::vec(any::<u8>(), 0..300),
    ) {
        let format = &FORMATS[which];
        let mut bytes = written(format, LayerKind::Color, Transfer::Linear, &sample());
        bytes.truncate(keep);
        bytes.extend(noise);
        survives(format, &bytes);
    }
}
