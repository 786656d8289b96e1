//! All-weather sky of Perez, from the irradiance of the sun and of the sky.
//!
//! Sources: Perez, Seals and Michalsky, *All-weather model for sky luminance distribution*, Solar
//! Energy 50, 1993, for the luminances; Perez, Ineichen, Seals, Michalsky and Stewart, *Modeling
//! daylight availability and irradiance components from direct and global irradiance*, Solar Energy
//! 44, 1990, for the clearness, the brightness and the luminous efficacies. The limits of the
//! inputs are those of Radiance's `gendaymtx`.

use super::angle;
use crate::math::{Vec3, fp};

/// Irradiance of the sun outside the atmosphere at the mean distance, in W/m^2.
const SOLAR_CONSTANT: f32 = 1367.0;

/// Upper limits of the first seven of the eight classes of clearness.
const CLEARNESS_LIMITS: [f32; 7] = [1.065, 1.23, 1.5, 1.95, 2.8, 4.5, 6.2];

/// Maximum clearness.
const MAX_CLEARNESS: f32 = 11.9;

/// Limits of the brightness.
const BRIGHTNESS: [f32; 2] = [0.01, 0.6];

/// Minimum zenith angle of the sun for the coefficients, in radians (3 degrees).
const MIN_ZENITH: f32 = 0.052_359_88;

/// Dew point that `gendaymtx` assumes, in degrees Celsius.
pub const DEW_POINT: f32 = 11.0;

/// Luminous efficacy of the light from the sky, in lm/W, for each class of clearness: the factors
/// of 1, the precipitable water, the cosine of the zenith angle, and the logarithm of the
/// brightness.
const SKY_EFFICACY: [[f32; 4]; 8] = [
    [97.24, -0.46, 12.00, -8.91],
    [107.22, 1.15, 0.59, -3.95],
    [104.97, 2.96, -5.53, -8.77],
    [102.39, 5.59, -13.95, -13.90],
    [100.71, 5.94, -22.75, -23.74],
    [106.42, 3.83, -36.15, -28.83],
    [141.88, 1.90, -53.24, -14.03],
    [152.23, 0.35, -45.27, -7.98],
];

/// Luminous efficacy of the light from the sun, in lm/W, for each class of clearness: the factors
/// of 1, the precipitable water, exp(5.73 z - 5) with the zenith angle z, and the brightness.
const SUN_EFFICACY: [[f32; 4]; 8] = [
    [57.20, -4.55, -2.98, 117.12],
    [98.99, -3.46, -1.21, 12.38],
    [109.83, -4.90, -1.71, -8.81],
    [110.34, -5.84, -1.99, -4.56],
    [106.36, -3.97, -1.75, -6.16],
    [107.19, -1.25, -1.51, -26.73],
    [105.75, 0.77, -1.26, -34.44],
    [101.18, 1.58, -1.10, -8.29],
];

/// Factors of the five coefficients a to e of the luminance, for each class of clearness: of 1, the
/// zenith angle, the brightness, and their product. The lowest class uses them in other formulas
/// for c and d.
#[rustfmt::skip]
const LUMINANCE_FACTORS: [[[f32; 4]; 5]; 8] = [
    [[1.3525, -0.2576, -0.2690, -1.4366], [-0.7670, 0.0007, 1.2734, -0.1233], [2.8000, 0.6004, 1.2375, 1.0000],
     [1.8734, 0.6297, 0.9738, 0.2809], [0.0356, -0.1246, -0.5718, 0.9938]],
    [[-1.2219, -0.7730, 1.4148, 1.1016], [-0.2054, 0.0367, -3.9128, 0.9156], [6.9750, 0.1774, 6.4477, -0.1239],
     [-1.5798, -0.5081, -1.7812, 0.1080], [0.2624, 0.0672, -0.2190, -0.4285]],
    [[-1.1000, -0.2515, 0.8952, 0.0156], [0.2782, -0.1812, -4.5000, 1.1766], [24.7219, -13.0812, -37.7000, 34.8438],
     [-5.0000, 1.5218, 3.9229, -2.6204], [-0.0156, 0.1597, 0.4199, -0.5562]],
    [[-0.5484, -0.6654, -0.2672, 0.7117], [0.7234, -0.6219, -5.6812, 2.6297], [33.3389, -18.3000, -62.2500, 52.0781],
     [-3.5000, 0.0016, 1.1477, 0.1062], [0.4659, -0.3296, -0.0876, -0.0329]],
    [[-0.6000, -0.3566, -2.5000, 2.3250], [0.2937, 0.0496, -5.6812, 1.8415], [21.0000, -4.7656, -21.5906, 7.2492],
     [-3.5000, -0.1554, 1.4062, 0.3988], [0.0032, 0.0766, -0.0656, -0.1294]],
    [[-1.0156, -0.3670, 1.0078, 1.4051], [0.2875, -0.5328, -3.8500, 3.3750], [14.0000, -0.9999, -7.1406, 7.5469],
     [-3.4000, -0.1078, -1.0750, 1.5702], [-0.0672, 0.4016, 0.3017, -0.4844]],
    [[-1.0000, 0.0211, 0.5025, -0.5119], [-0.3000, 0.1922, 0.7023, -1.6317], [19.0000, -5.0000, 1.2438, -1.9094],
     [-4.0000, 0.0250, 0.3844, 0.2656], [1.0468, -0.3788, -2.4517, 1.4656]],
    [[-1.0500, 0.0289, 0.4260, 0.3590], [-0.3250, 0.1156, 0.7781, 0.0025], [31.0625, -14.5000, -46.1148, 55.3750],
     [-7.2312, 0.4050, 13.3500, 0.6234], [1.5000, -0.6426, 1.8564, 0.5636]],
];

/// Irradiance of the sun and of the sky, as measured by a weather station.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Irradiance {
    /// Irradiance from the sun on a surface that faces it, in W/m^2; at least 0.
    pub direct_normal: f32,
    /// Irradiance from the sky on a horizontal surface, in W/m^2; at least 0.
    pub diffuse_horizontal: f32,
    /// Dew point in degrees Celsius, which determines the water vapour in the air.
    pub dew_point: f32,
    /// Irradiance outside the atmosphere, relative to that at the mean distance from the sun. It is
    /// from 0.96 to 1.04; see [`eccentricity`].
    pub eccentricity: f32,
}

impl Irradiance {
    /// Creates the irradiance for the dew point [`DEW_POINT`] and the mean distance from the sun.
    pub fn new(direct_normal: f32, diffuse_horizontal: f32) -> Self {
        Irradiance { direct_normal, diffuse_horizontal, dew_point: DEW_POINT, eccentricity: 1.0 }
    }
}

/// Returns the irradiance outside the atmosphere on a day of the year, counted from 1, relative to
/// that at the mean distance from the sun.
///
/// Source: Spencer, *Fourier series representation of the position of the sun*, Search 2, 1971.
pub fn eccentricity(day: u32) -> f32 {
    let degrees = 360.0 * (f64::from(day) - 1.0) / 365.0;
    let ((s, c), (s2, c2)) = (fp::sin_cos_degrees(degrees), fp::sin_cos_degrees(2.0 * degrees));
    (1.000_11 + 0.034_221 * c + 0.001_28 * s + 0.000_719 * c2 + 0.000_077 * s2) as f32
}

/// All-weather sky for one position of the sun. Its colour is white.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Perez {
    sun: Vec3,
    coefficients: [f32; 5],
    sky_illuminance: f32,
    sun_illuminance: f32,
}

impl Perez {
    /// Creates a sky. `sun` points to the sun, with y up and of any length; a sun below the horizon
    /// is moved to the horizon.
    pub fn new(sun: Vec3, light: &Irradiance) -> Self {
        let sun = super::raised(sun);
        let z = angle(sun.y).max(MIN_ZENITH);
        let (direct, diffuse) = (light.direct_normal.max(0.0), light.diffuse_horizontal.max(0.0));
        let cubed = 1.041 * z * z * z;
        // Without diffuse light, a sky with sunlight is as clear as possible.
        let ratio = if direct > 0.0 { (diffuse + direct) / diffuse } else { 1.0 };
        let clearness = ((ratio + cubed) / (1.0 + cubed)).min(MAX_CLEARNESS);
        let air_mass = 1.0 / (fp::cos(z) + 0.15 * fp::pow(93.885 - z.to_degrees(), -1.253));
        let brightness =
            (diffuse * air_mass / (SOLAR_CONSTANT * light.eccentricity)).clamp(BRIGHTNESS[0], BRIGHTNESS[1]);
        let class = CLEARNESS_LIMITS.iter().take_while(|limit| clearness >= **limit).count();
        // Precipitable water in cm.
        let water = fp::exp(0.07 * light.dew_point - 0.075);
        let [a, b, c, d] = SKY_EFFICACY[class];
        let sky_efficacy = a + b * water + c * fp::cos(z) + d * fp::ln(brightness);
        let [a, b, c, d] = SUN_EFFICACY[class];
        let sun_efficacy = a + b * water + c * fp::exp(5.73 * z - 5.0) + d * brightness;
        Perez {
            sun,
            coefficients: coefficients(class, clearness, brightness, z),
            sky_illuminance: diffuse * sky_efficacy.max(0.0),
            sun_illuminance: direct * sun_efficacy.max(0.0),
        }
    }

    /// Unit vector to the sun.
    pub fn sun(&self) -> Vec3 {
        self.sun
    }

    /// Illuminance from the sky on a horizontal surface, in lux.
    pub fn sky_illuminance(&self) -> f32 {
        self.sky_illuminance
    }

    /// Illuminance from the sun on a surface that faces it, in lux.
    pub fn sun_illuminance(&self) -> f32 {
        self.sun_illuminance
    }

    /// Luminance in a unit direction above the horizon, in a unit that all directions
    /// share. Scale it so that the sky has [`Perez::sky_illuminance`].
    pub fn relative_luminance(&self, dir: Vec3) -> f32 {
        let cosine = dir.dot(self.sun).clamp(-1.0, 1.0);
        shape(&self.coefficients, dir.y.max(0.01), angle(cosine), cosine).max(0.0)
    }
}

/// Computes the five coefficients of the luminance.
fn coefficients(class: usize, clearness: f32, brightness: f32, z: f32) -> [f32; 5] {
    let brightness = if clearness > 1.065 && clearness < 2.8 { brightness.max(0.2) } else { brightness };
    let rows = &LUMINANCE_FACTORS[class];
    let mut found = rows.map(|[a, b, c, d]| a + b * z + brightness * (c + d * z));
    if class == 0 {
        let [a, b, c, d] = rows[2];
        found[2] = fp::exp(fp::pow(brightness * (a + b * z), c)) - d;
        let [a, b, c, d] = rows[3];
        found[3] = -fp::exp(brightness * (a + b * z)) + c + brightness * d;
    }
    found
}

/// Luminance by Perez's formula with the coefficients a to e, as a function of the cosine of the
/// zenith angle, the angle to the sun in radians, and the cosine of that angle.
pub fn shape(&[a, b, c, d, e]: &[f32; 5], cos_zenith: f32, to_sun: f32, cos_sun: f32) -> f32 {
    (1.0 + a * fp::exp(b / cos_zenith)) * (1.0 + c * fp::exp(d * to_sun) + e * cos_sun * cos_sun)
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::texture::almanac::direction;
    use crate::texture::sky::SkyPatches;

    #[test]
    fn luminances_agree_with_gendaymtx() {
        // Direction to the sun, day of the year, direct normal and diffuse horizontal irradiance;
        // then the illuminance of the sun in lux and the luminances of Tregenza's patches 0, 15,
        // 69, 109, 139 and 144 in cd/m^2, from `gendaymtx` of Radiance 6.0a (`-m 1 -s -c 1 1 1`,
        // and `-D` for the sun), times 179 lm/W.
        type Measured = ([f32; 3], u32, [f32; 2], f32, [f32; 6]);
        #[rustfmt::skip]
        let measured: [Measured; 10] = [
            ([0.484350, 0.277636, 0.829653], 15, [0.0, 60.0], 0.0, [1550.7, 1917.5, 2391.5, 2229.1, 2408.5, 2418.8]),
            ([0.021401, 0.370057, 0.928763], 15, [30.0, 150.0], 2641.0, [4749.0, 23239.9, 8517.3, 2710.0, 2710.8, 2858.1]),
            ([0.873331, 0.327033, 0.361030], 80, [100.0, 120.0], 8384.0, [4272.3, 5460.9, 12444.7, 2643.2, 2599.0, 2322.9]),
            ([0.273123, 0.650898, 0.708333], 80, [150.0, 300.0], 14319.0, [7052.7, 15590.8, 25449.4, 5553.9, 7268.0, 7654.1]),
            ([0.651295, 0.695197, 0.304165], 130, [300.0, 250.0], 28821.0, [6321.8, 7995.5, 24220.2, 5622.9, 8041.9, 6613.6]),
            ([-0.032018, 0.870138, 0.491767], 130, [450.0, 220.0], 43664.0, [5956.0, 9744.7, 9069.1, 4165.6, 7318.1, 9797.3]),
            ([0.789243, 0.610006, 0.070626], 172, [500.0, 150.0], 48908.0, [6713.7, 6974.3, 10214.0, 4329.6, 4881.5, 3748.1]),
            ([-0.010398, 0.916678, 0.399491], 172, [850.0, 120.0], 87924.0, [6354.8, 7892.1, 4350.9, 2231.0, 3997.3, 5662.2]),
            ([0.478320, 0.673173, 0.563958], 248, [700.0, 90.0], 72011.0, [5776.3, 8530.0, 15847.8, 1675.2, 2308.7, 2208.0]),
            ([-0.532948, 0.273592, 0.800696], 324, [600.0, 40.0], 53811.0, [4384.0, 8585.1, 1503.5, 948.1, 793.2, 834.7]),
        ];
        let patches = SkyPatches::new(145).unwrap();
        for (sun, day, [direct, diffuse], sun_lux, expected) in measured {
            let light = Irradiance { eccentricity: eccentricity(day), ..Irradiance::new(direct, diffuse) };
            let sky = Perez::new(sun.into(), &light);
            assert!((sky.sun_illuminance() - sun_lux).abs() <= 0.001 * sun_lux + 1.0, "{sky:?}");
            let level = |patch: usize| {
                let center = patches.center(patch);
                f64::from(sky.relative_luminance(center) * center.y) * patches.solid_angle(patch)
            };
            let scale = f64::from(sky.sky_illuminance()) / (0..145).map(level).sum::<f64>();
            for (patch, expected) in [0, 15, 69, 109, 139, 144].into_iter().zip(expected) {
                let found = scale * f64::from(sky.relative_luminance(patches.center(patch)));
                assert!((found / f64::from(expected) - 1.0).abs() < 0.001, "{sun:?} {patch}: {found}, {expected}");
            }
        }
    }

    #[test]
    fn overcast_sky_has_no_sun_and_brightens_towards_the_zenith() {
        let sky = Perez::new(direction([40.0, 180.0]), &Irradiance::new(0.0, 150.0));
        assert_eq!(sky.sun_illuminance(), 0.0);
        let at = |altitude: f64, azimuth: f64| sky.relative_luminance(direction([altitude, azimuth]));
        // Moon and Spencer's overcast sky is three times as bright at the zenith as at the horizon.
        assert!((1.5..4.0).contains(&(at(90.0, 0.0) / at(2.0, 0.0))), "{}", at(90.0, 0.0) / at(2.0, 0.0));
        // The luminous efficacy of an overcast sky is about 110 lm/W.
        assert!((100.0..125.0).contains(&(sky.sky_illuminance() / 150.0)), "{}", sky.sky_illuminance());
    }

    #[test]
    fn clear_sky_is_brightest_around_the_sun() {
        let sky = Perez::new(direction([50.0, 180.0]), &Irradiance::new(850.0, 90.0));
        let at = |altitude: f64, azimuth: f64| sky.relative_luminance(direction([altitude, azimuth]));
        assert!(at(50.0, 180.0) > 3.0 * at(50.0, 150.0));
        assert!(at(50.0, 150.0) > at(70.0, 0.0));
        // Direct sunlight has about 100 lm/W, and the light of the clear sky more.
        assert!((90.0..115.0).contains(&(sky.sun_illuminance() / 850.0)));
        assert!((115.0..160.0).contains(&(sky.sky_illuminance() / 90.0)));
    }

    #[test]
    fn any_irradiance_gives_a_finite_sky() {
        for direct in [0.0, 1e-3, 5.0, 400.0, 1500.0] {
            for diffuse in [0.0, 1e-3, 5.0, 200.0, 1500.0] {
                for altitude in [-20.0, 0.0, 0.5, 30.0, 89.0, 90.0] {
                    let sky = Perez::new(direction([altitude, 90.0]), &Irradiance::new(direct, diffuse));
                    assert!(sky.sky_illuminance() >= 0.0 && sky.sky_illuminance().is_finite());
                    assert!(sky.sun_illuminance() >= 0.0 && sky.sun_illuminance().is_finite());
                    for up in [0.0, 10.0, 45.0, 90.0] {
                        let found = sky.relative_luminance(direction([up, 90.0]));
                        assert!(found >= 0.0 && found.is_finite(), "{direct} {diffuse} {altitude} {up}: {found}");
                    }
                }
            }
        }
    }

    #[test]
    fn distance_to_the_sun_changes_over_the_year() {
        // The Earth is closest to the sun in early January: (1 / 0.9833)^2, and 1.0167 in July.
        assert!((eccentricity(3) - 1.0343).abs() < 0.002 && (eccentricity(185) - 0.9674).abs() < 0.002);
    }
}
