//! Spectra that pbrt knows by name, and what the eye and daylight are by wavelength.

use super::spectrum::{Spectrum, of_chromaticity};
use crate::math::Vec3;
use glam::DVec3;

/// Wavelength of the first row, and from row to row, in nanometres.
const FIRST: f32 = 380.0;
const STEP: f32 = 10.0;

/// The CIE 1931 standard observer's x, y and z, and the illuminant D65. Source: CIE 015:2018,
/// tables 1 and 6.
#[rustfmt::skip]
const ROWS: [[f32; 4]; 41] = [
    [0.001368, 0.000039, 0.00645, 49.9755], [0.004243, 0.00012, 0.02005, 54.6482], [0.01431, 0.000396, 0.06785, 82.7549],
    [0.04351, 0.00121, 0.2074, 91.486], [0.13438, 0.004, 0.6456, 93.4318], [0.2839, 0.0116, 1.3856, 86.6823],
    [0.34828, 0.023, 1.74706, 104.865], [0.3362, 0.038, 1.77211, 117.008], [0.2908, 0.06, 1.6692, 117.812],
    [0.19536, 0.09098, 1.28764, 114.861], [0.09564, 0.13902, 0.81295, 115.923], [0.03201, 0.20802, 0.46518, 108.811],
    [0.0049, 0.323, 0.272, 109.354], [0.0093, 0.503, 0.1582, 107.802], [0.06327, 0.71, 0.07825, 104.79],
    [0.1655, 0.862, 0.04216, 107.689], [0.2904, 0.954, 0.0203, 104.405], [0.43345, 0.99495, 0.00875, 104.046],
    [0.5945, 0.995, 0.0039, 100.0], [0.7621, 0.952, 0.0021, 96.3342], [0.9163, 0.87, 0.00165, 95.788],
    [1.0263, 0.757, 0.0011, 88.6856], [1.0622, 0.631, 0.0008, 90.0062], [1.0026, 0.503, 0.00034, 89.5991],
    [0.85445, 0.381, 0.00019, 87.6987], [0.6424, 0.265, 0.00005, 83.2886], [0.4479, 0.175, 0.00002, 83.6992],
    [0.2835, 0.107, 0.0, 80.0268], [0.1649, 0.061, 0.0, 80.2146], [0.0874, 0.032, 0.0, 82.2778],
    [0.04677, 0.017, 0.0, 78.2842], [0.0227, 0.00821, 0.0, 69.7213], [0.011359, 0.004102, 0.0, 71.6091],
    [0.00579, 0.002091, 0.0, 74.349], [0.002899, 0.001047, 0.0, 61.604], [0.00144, 0.00052, 0.0, 69.8856],
    [0.00069, 0.000249, 0.0, 75.087], [0.000332, 0.00012, 0.0, 63.5927], [0.000166, 0.00006, 0.0, 46.4182],
    [0.000083, 0.00003, 0.0, 66.8054], [0.000042, 0.000015, 0.0, 63.3828],
];

/// X, Y and Z of light, at any scale.
pub(super) fn sum(light: impl Fn(f32) -> f64) -> DVec3 {
    let row = |(i, [x, y, z, _]): (usize, &[f32; 4])| Vec3::new(*x, *y, *z).as_dvec3() * light(FIRST + STEP * i as f32);
    ROWS.iter().enumerate().map(row).sum()
}

/// Daylight, at any scale, at a wavelength of a row.
pub(super) fn daylight(nm: f32) -> f32 {
    ROWS[(((nm - FIRST) / STEP) as usize).min(ROWS.len() - 1)][3]
}

/// Indices of metals, for red, green and blue: such that what is reflected at 0 and at 82 degrees
/// has the colour that the spectrum's reflectance has under D65, to 0.002; red of gold, which
/// linear sRGB cannot hold, to 0.03.
///
/// Source of the spectra: Palik, *Handbook of Optical Constants of Solids*, 1985, and the SOPRA
/// collection, as pbrt-v4 has them.
const METALS: [(&str, [f32; 3], [f32; 3]); 7] = [
    ("Ag", [0.13, 0.124, 0.152], [4.1206, 3.3342, 2.4194]),
    ("Al", [1.432, 0.93, 0.592], [7.7499, 6.6079, 5.3675]),
    ("Au", [0.03, 0.412, 1.562], [3.39, 2.3624, 1.7182]),
    ("Cu", [0.146, 0.976, 1.208], [3.4339, 2.6207, 2.3638]),
    ("CuZn", [0.44, 0.522, 1.12], [4.1724, 2.6648, 1.8074]),
    ("MgO", [1.7337, 1.7409, 1.7535], [0.0; 3]),
    ("TiO2", [2.8601, 2.9571, 3.1855], [0.0; 3]),
];

/// Indices of glasses at 587.6 nm. Source: Schott's data sheets.
const GLASSES: [(&str, f32); 10] = [
    ("BK7", 1.5168),
    ("BAF10", 1.67),
    ("FK51A", 1.48656),
    ("LASF9", 1.85025),
    ("F5", 1.67271),
    ("SF5", 1.67271),
    ("F10", 1.72828),
    ("SF10", 1.72828),
    ("F11", 1.78472),
    ("SF11", 1.78472),
];

/// Chromaticities of standard illuminants. Sources: CIE 015:2018, tables 3 and 8 to 10; SMPTE ST
/// 2065-1.
const ILLUMINANTS: [(&str, [f64; 2]); 16] = [
    ("stdillum-A", [0.4476, 0.4074]),
    ("stdillum-D50", [0.3457, 0.3585]),
    ("stdillum-D65", [0.3127, 0.329]),
    ("stdillum-F1", [0.3131, 0.3371]),
    ("stdillum-F2", [0.3721, 0.3751]),
    ("stdillum-F3", [0.4091, 0.3941]),
    ("stdillum-F4", [0.4402, 0.4031]),
    ("stdillum-F5", [0.3138, 0.3452]),
    ("stdillum-F6", [0.3779, 0.3882]),
    ("stdillum-F7", [0.3129, 0.3292]),
    ("stdillum-F8", [0.3458, 0.3586]),
    ("stdillum-F9", [0.3741, 0.3727]),
    ("stdillum-F10", [0.3458, 0.3588]),
    ("stdillum-F11", [0.3805, 0.3769]),
    ("stdillum-F12", [0.437, 0.4042]),
    ("illum-acesD60", [0.32168, 0.33767]),
];

/// The spectrum of a name.
pub(super) fn spectrum(name: &str) -> Option<Spectrum> {
    if let Some((metal, which)) = name.strip_prefix("metal-").and_then(|rest| rest.rsplit_once('-')) {
        let (_, eta, k) = METALS.iter().find(|row| row.0 == metal)?;
        return match which {
            "eta" => Some(Spectrum::Rgb(Vec3::from_array(*eta))),
            "k" => Some(Spectrum::Rgb(Vec3::from_array(*k))),
            _ => None,
        };
    }
    if let Some(glass) = name.strip_prefix("glass-") {
        return GLASSES.iter().find(|row| row.0 == glass).map(|row| Spectrum::Rgb(Vec3::splat(row.1)));
    }
    ILLUMINANTS.iter().find(|row| row.0 == name).map(|row| Spectrum::Illuminant(of_chromaticity(row.1)))
}

/// Names, for messages.
pub(super) fn names() -> impl Iterator<Item = &'static str> {
    const METAL_NAMES: [&str; 14] = [
        "metal-Ag-eta",
        "metal-Ag-k",
        "metal-Al-eta",
        "metal-Al-k",
        "metal-Au-eta",
        "metal-Au-k",
        "metal-Cu-eta",
        "metal-Cu-k",
        "metal-CuZn-eta",
        "metal-CuZn-k",
        "metal-MgO-eta",
        "metal-MgO-k",
        "metal-TiO2-eta",
        "metal-TiO2-k",
    ];
    const GLASS_NAMES: [&str; 7] =
        ["glass-BK7", "glass-BAF10", "glass-FK51A", "glass-LASF9", "glass-F5", "glass-F10", "glass-F11"];
    METAL_NAMES.into_iter().chain(GLASS_NAMES).chain(ILLUMINANTS.iter().map(|row| row.0))
}
