//! Named spectra of pbrt, given as RGB values or chromaticities.

use durer_scene::math::Vec3;
use durer_scene::spectrum::SpectrumSource;
use durer_scene::spectrum::space::color_of_chromaticity;

/// Complex indices of refraction of metals (eta, k) for red, green and blue. The indices are chosen
/// so that the colours of the reflectances at 0 and 82 degrees equal those of the spectral
/// reflectances under D65, with an error of at most 0.002. The red component of gold is outside the
/// range of linear sRGB and differs by 0.03.
///
/// Source of the spectra: Palik, *Handbook of Optical Constants of Solids*, 1985, and the SOPRA
/// collection, as distributed with pbrt-v4.
const METALS: [(&str, [f32; 3], [f32; 3]); 7] = [
    ("Ag", [0.13, 0.124, 0.152], [4.1206, 3.3342, 2.4194]),
    ("Al", [1.432, 0.93, 0.592], [7.7499, 6.6079, 5.3675]),
    ("Au", [0.03, 0.412, 1.562], [3.39, 2.3624, 1.7182]),
    ("Cu", [0.146, 0.976, 1.208], [3.4339, 2.6207, 2.3638]),
    ("CuZn", [0.44, 0.522, 1.12], [4.1724, 2.6648, 1.8074]),
    ("MgO", [1.7337, 1.7409, 1.7535], [0.0; 3]),
    ("TiO2", [2.8601, 2.9571, 3.1855], [0.0; 3]),
];

/// Indices of refraction of types of glass at 587.6 nm. Source: Schott's data sheets.
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

/// Returns the spectrum that has the given name.
pub(super) fn spectrum(name: &str) -> Option<SpectrumSource> {
    if let Some((metal, which)) = name.strip_prefix("metal-").and_then(|rest| rest.rsplit_once('-')) {
        let (_, eta, k) = METALS.iter().find(|row| row.0 == metal)?;
        return match which {
            "eta" => Some(SpectrumSource::Rgb(Vec3::from_array(*eta))),
            "k" => Some(SpectrumSource::Rgb(Vec3::from_array(*k))),
            _ => None,
        };
    }
    if let Some(glass) = name.strip_prefix("glass-") {
        return GLASSES.iter().find(|row| row.0 == glass).map(|row| SpectrumSource::Rgb(Vec3::splat(row.1)));
    }
    ILLUMINANTS.iter().find(|row| row.0 == name).map(|row| SpectrumSource::Illuminant(color_of_chromaticity(row.1)))
}

/// Returns the names of all spectra, for suggestions in error messages.
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
