use super::space::RgbSpace;
use super::*;
use crate::math::Vec3;

/// Colours that cover the entire range, including values near its edges.
fn colors() -> Vec<Color> {
    let steps = [0.0, 0.03, 0.2, 0.5, 0.8, 1.0];
    let rows = steps.into_iter().flat_map(|r| steps.into_iter().map(move |g| (r, g)));
    rows.flat_map(|(r, g)| steps.into_iter().map(move |b| Color::new(r, g, b))).collect()
}

#[test]
fn wavelength_samples_average_to_the_colour() {
    // The mean over evenly spaced random numbers approximates the integral.
    let n = 4096;
    let mean = |light: &dyn Fn(&Lanes) -> Spectrum| {
        let lanes = (0..n).map(|i| Lanes::new(ColorMode::Spectral, (i as f32 + 0.5) / n as f32));
        lanes.map(|lanes| lanes.color(light(&lanes)).as_dvec3()).sum::<glam::DVec3>().as_vec3() / n as f32
    };
    let white = mean(&|lanes| lanes.light(Color::ONE));
    assert!((white - Color::ONE).abs().max_element() < 2e-4, "{white}");
    for color in [Color::new(0.2, 0.5, 0.9), Color::new(30.0, 4.0, 1.0), Color::new(0.1, 0.4, 0.05)] {
        let seen = mean(&|lanes| lanes.light(color));
        assert!((seen - color).abs().max_element() < 3e-3 * color.max_element(), "{color} {seen}");
        let under_daylight = mean(&|lanes| lanes.reflectance(color / 30.0) * lanes.light(Color::ONE)) * 30.0;
        assert!(
            (under_daylight - color).abs().max_element() < 6e-3 * color.max_element().max(10.0),
            "{under_daylight}"
        );
    }
}

#[test]
fn wavelength_samples_agree_with_pdf() {
    // The integral of the pdf between two quantiles equals the step of the random number.
    for i in 0..100 {
        let (a, b) = (sample_wavelength((i as f32 + 1.0) / 100.0), sample_wavelength(i as f32 / 100.0));
        let (low, high) = (a.min(b), a.max(b));
        let middle = 0.5 * (low + high);
        let mass = (wavelength_pdf(low) + 4.0 * wavelength_pdf(middle) + wavelength_pdf(high)) * (high - low) / 6.0;
        assert!((mass - 0.01).abs() < 2e-4, "{i}: {mass} between {low} and {high}");
    }
}

#[test]
fn smooth_spectra_round_trip_to_their_colours() {
    let mut worst = (0.0, Color::ZERO);
    for color in colors() {
        let off = (upsample::color_of(color) - color).abs().max_element();
        // Saturated colours at full strength have no physical reflectance.
        let saturated = color.max_element() > 0.99 && color.min_element() < 0.01;
        if !saturated && off > worst.0 {
            worst = (off, color);
        }
        assert!(off < 0.08, "{color}: off by {off}");
    }
    assert!(worst.0 < 0.01, "{worst:?}");
}

#[test]
fn grey_is_constant_over_wavelengths_and_rgb_lanes_keep_colours() {
    let waves = Lanes::new(ColorMode::Spectral, 0.3);
    assert_eq!(waves.reflectance(Color::splat(0.4)), Spectrum::splat(0.4));
    let color = Color::new(0.1, 0.7, 2.0);
    let spectrum = Lanes::Rgb.light(color);
    assert_eq!((Lanes::Rgb.color(spectrum), spectrum.w, spectrum.max_element()), (color, 0.7, 2.0));
    assert!(ColorMode::NAMES.iter().all(|name| ColorMode::from_name(name).unwrap().name() == *name));
}

/// Chromaticity computed from a sum over every 5 nm, as the CIE defines it.
fn chromaticity(curve: &Curve) -> [f64; 2] {
    let rows = || (0..95).map(|i| FIRST + STEP * i as f32);
    let here = |nm: f32, i: usize| f64::from(observer_and_daylight(nm)[i] * curve.at(nm));
    let sums = [0, 1, 2].map(|i| rows().map(|nm| here(nm, i)).sum::<f64>());
    let all: f64 = sums.iter().sum();
    [sums[0] / all, sums[1] / all]
}

#[test]
fn illuminants_have_their_published_chromaticities() {
    // Values from CIE 015:2018, tables 3 and 10.3, for the observer of 1931.
    for (name, x, y) in [
        ("A", 0.44758, 0.40745),
        ("D50", 0.34567, 0.35851),
        ("D55", 0.33243, 0.34744),
        ("D65", 0.31272, 0.32903),
        ("D75", 0.29903, 0.31488),
        ("E", 0.33333, 0.33333),
        ("F2", 0.3721, 0.3751),
        ("F7", 0.3129, 0.3292),
        ("F11", 0.3805, 0.3769),
    ] {
        let curve = illuminants::illuminant(name).unwrap();
        let [a, b] = chromaticity(&curve);
        assert!((a - x).abs() < 3e-4 && (b - y).abs() < 3e-4, "{name}: {a} {b}, not {x} {y}");
        assert!((curve.color().dot(Color::new(0.2126, 0.7152, 0.0722)) - 1.0).abs() < 1e-3, "{name}");
    }
    // The spectrum of D65 computed by the daylight formula agrees with the table that defines
    // white.
    let d65 = illuminants::illuminant("D65").unwrap();
    assert!((d65.color() - Color::ONE).abs().max_element() < 2e-3, "{}", d65.color());
    // A black body of 2856 K with the current radiation constant matches the definition of
    // illuminant A.
    let [a, b] = chromaticity(&illuminants::illuminant("2856K").unwrap());
    assert!((a - 0.44758).abs() < 3e-4 && (b - 0.40745).abs() < 3e-4, "{a} {b}");
    assert!(["D", "F99", "100K", "K", "warm"].iter().all(|name| illuminants::illuminant(name).is_none()));
}

/// The visible part of the spectrum is negligible. Scaling it to luminance 1 would overflow the
/// other values.
#[test]
fn light_with_negligible_visible_part_is_none() {
    assert_eq!(Curve::light(vec![[791.0, 0.0], [1e36, 2.0]]), None);
    assert_eq!(Curve::light(vec![[400.0, 0.0], [700.0, 0.0]]), None);
    assert!(Curve::light(vec![[791.0, 0.0], [1e30, 2.0]]).is_none_or(|emitter| emitter.color().is_finite()));
    assert!(Curve::light(vec![[400.0, 1e-30], [700.0, 1e-30]]).unwrap().color().is_finite());
}

#[test]
fn measured_spectra_multiply_by_wavelength() {
    // The filter transmits only light above 560 nm, and is lit by an incandescent bulb. Its visible
    // colour is the integral of the product of the spectra, which a product of colours cannot give.
    let steep = Curve::reflectance(vec![[400.0, 0.05], [550.0, 0.05], [570.0, 0.9], [700.0, 0.9]]).unwrap();
    let bulb = illuminants::illuminant("A").unwrap();
    let exact = Color::from(OBSERVER.to_rgb.map(|row| {
        let [a, b, c] = row.map(f64::from);
        integral(|nm, [x, y, z, _]| (a * x + b * y + c * z) * f64::from(steep.at(nm) * bulb.at(nm))) as f32
    }));
    let n = 4096;
    let lanes = (0..n).map(|i| Lanes::new(ColorMode::Spectral, (i as f32 + 0.5) / n as f32));
    let seen = lanes.map(|lanes| {
        lanes.color(lanes.measured(steep.color(), &steep) * lanes.measured(2.0 * bulb.color(), &bulb)).as_dvec3()
    });
    let seen = seen.sum::<glam::DVec3>().as_vec3() / n as f32;
    assert!((seen - 2.0 * exact).abs().max_element() < 3e-3, "{seen}, not {}", 2.0 * exact);
    let product = 2.0 * steep.color() * bulb.color();
    assert!((seen - product).abs().max_element() > 0.05, "the product of colours agrees: {seen} {product}");
    assert_eq!(Lanes::Rgb.measured(steep.color(), &steep).truncate(), steep.color());
}

#[test]
fn spectra_from_files_convert_to_colours() {
    // All three sums are equal for the equal-energy white, within the accuracy of 10 nm steps.
    let white = xyz_sum(|_| 1.0);
    assert!((white.x - white.y).abs() < 0.002 * white.y && (white.z - white.y).abs() < 0.002 * white.y, "{white}");
    let even = SpectrumSource::Curve(vec![[300.0, 0.4], [900.0, 0.4]]);
    assert!((even.albedo() - Vec3::splat(0.4)).length() < 1e-5);
    // Lights must have luminance 1.
    let luminance = Vec3::new(0.2126729, 0.7151522, 0.072175);
    for light in [SpectrumSource::Blackbody(2856.0), SpectrumSource::Blackbody(6504.0), even.clone()] {
        assert!((light.light().dot(luminance) - 1.0).abs() < 1e-3, "{:?}", light.light());
    }
}

#[test]
fn white_is_white_in_every_space() {
    for name in ["srgb", "dci-p3", "rec2020", "aces2065-1"] {
        let space = RgbSpace::named(name).unwrap();
        assert!((space.color(Vec3::ONE) - Vec3::ONE).abs().max_element() < 1e-5, "{name}");
    }
    assert_eq!(RgbSpace::named("adobe"), None);
    // The red primary of a wider space lies outside sRGB.
    assert!(RgbSpace::named("rec2020").unwrap().color(Vec3::X).x > 1.5);
}

/// Lanes whose sum depends on the order in which they are added.
#[test]
fn lanes_are_added_in_one_order() {
    let light = Spectrum::new(1.0, 2e-8, 3e-8, 4e-8);
    assert_eq!(lane_sum(light), (1.0 + 2e-8) + (3e-8 + 4e-8));
    assert_ne!(lane_sum(light), ((1.0 + 2e-8) + 3e-8) + 4e-8);
    assert_eq!(lane_dot(light, Spectrum::ONE), (1.0 + 3e-8) + (2e-8 + 4e-8));
}

/// The luminance of a narrow band equals a sum over much smaller steps, wherever it lies between
/// the wavelengths at which spectra are tabulated.
#[test]
fn narrow_bands_keep_their_area() {
    let sum = |share: &dyn Fn(f32) -> f32| -> f64 {
        let value = |i: u32| {
            let nm = 380.0 + 0.02 * i as f32;
            let [_, y, _, daylight] = observer_and_daylight(nm);
            f64::from(share(nm) * y * daylight)
        };
        (0..20_000).map(value).sum()
    };
    let white = sum(&|_| 1.0);
    for tenth in (0..50).step_by(7) {
        let middle = 540.0 + 0.1 * tenth as f32;
        for half in [4.0, 5.0, 12.0] {
            let band = |nm: f32| (1.0 - (nm - middle).abs() / half).max(0.0);
            let found = f64::from(source::under_daylight(band).dot(crate::math::LUMINANCE));
            let expected = sum(&band) / white;
            assert!((found / expected - 1.0).abs() < 0.02, "{middle} {half}: {found} and not {expected}");
        }
    }
}
