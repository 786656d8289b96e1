//! Compact storage for the sums of a film, which take most of the memory of a render.

use super::film::{Film, Pixel, WEIGHT_ONE};
use durer_scene::math::Color;

/// A film in the most compact of four lossless formats. It is used for storage while no samples are
/// added.
#[derive(Clone, Debug, PartialEq)]
pub enum PackedFilm {
    /// Format with colours only, in which each pixel has one sample with weight 1 and full
    /// coverage.
    OneSample(Box<[Color]>),
    /// Variant of [`PackedFilm::Small`] in which all samples have weight 1. This is the case for
    /// filters without negative lobes.
    UnitWeights(Box<[EqualWeights]>),
    /// Format in which colour sums fit in 64 bits and all samples have full coverage.
    Small(Box<[CompactPixel]>),
    /// The unpacked film.
    Unpacked(Box<Film>),
}

/// Sums of one pixel in [`PackedFilm::Small`]. The coverage equals the weight.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct CompactPixel {
    color: [i64; 3],
    /// Lower and upper half of the sum. An `i128` would need padding.
    squares: [u64; 2],
    luminance: i64,
    weight: i64,
    samples: u32,
}

impl CompactPixel {
    fn of(pixel: &Pixel) -> Option<Self> {
        let [r, g, b] = pixel.color;
        (pixel.covered == pixel.weight).then_some(())?;
        Some(CompactPixel {
            color: [r.try_into().ok()?, g.try_into().ok()?, b.try_into().ok()?],
            squares: words(pixel.squares),
            luminance: pixel.luminance,
            weight: pixel.weight,
            samples: pixel.samples.try_into().ok()?,
        })
    }

    fn squares(&self) -> i128 {
        let [low, high] = self.squares.map(u128::from);
        (high << 64 | low) as i128
    }

    fn pixel(&self) -> Pixel {
        Pixel {
            color: self.color.map(i128::from),
            squares: self.squares(),
            luminance: self.luminance,
            weight: self.weight,
            covered: self.weight,
            samples: self.samples.into(),
        }
    }
}

/// Sums of one pixel in [`PackedFilm::UnitWeights`], where the weight equals the number of samples.
/// The sums are stored as 32-bit words to avoid padding.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct EqualWeights {
    color: [[u32; 2]; 3],
    squares: [u32; 3],
    luminance: [u32; 2],
    samples: u32,
}

impl EqualWeights {
    fn of(pixel: &Pixel) -> Option<Self> {
        let CompactPixel { color, squares: [low, high], luminance, weight, samples } = CompactPixel::of(pixel)?;
        let [low, middle] = halves(low);
        let squares = [low, middle, high.try_into().ok()?];
        (weight == i64::from(samples) * WEIGHT_ONE).then_some(())?;
        Some(EqualWeights {
            color: color.map(|sum| halves(sum as u64)),
            squares,
            luminance: halves(luminance as u64),
            samples,
        })
    }

    fn pixel(&self) -> Pixel {
        let whole = |[low, high]: [u32; 2]| u64::from(high) << 32 | u64::from(low);
        let [low, middle, high] = self.squares;
        CompactPixel {
            color: self.color.map(|sum| whole(sum) as i64),
            squares: [whole([low, middle]), high.into()],
            luminance: whole(self.luminance) as i64,
            weight: i64::from(self.samples) * WEIGHT_ONE,
            samples: self.samples,
        }
        .pixel()
    }
}

/// Returns the lower and the upper 32 bits of a number.
fn halves(number: u64) -> [u32; 2] {
    [number as u32, (number >> 32) as u32]
}

/// Converts all pixels of a film. Returns `None` if any pixel cannot be converted.
fn all<T>(film: &Film, smaller: impl Fn(&Pixel) -> Option<T>) -> Option<Vec<T>> {
    let mut packed = Vec::with_capacity(film.pixels.len());
    for pixel in &film.pixels {
        packed.push(smaller(pixel)?);
    }
    Some(packed)
}

/// Returns the lower and the upper 64 bits of a number.
fn words(number: i128) -> [u64; 2] {
    [number as u64, (number >> 64) as u64]
}

impl PackedFilm {
    /// Packs a film. `samples` is the planned number of samples per pixel. The format is wide
    /// enough for this number from the start, which avoids fragmenting the memory.
    pub fn new(film: Film, samples: u32) -> Self {
        if film.rejected() > 0 {
            return PackedFilm::Unpacked(Box::new(film));
        }
        if samples == 1
            && let Some(singles) = all(&film, Pixel::single)
        {
            return PackedFilm::OneSample(singles.into());
        }
        if let Some(even) = all(&film, EqualWeights::of) {
            return PackedFilm::UnitWeights(even.into());
        }
        match all(&film, CompactPixel::of) {
            Some(small) => PackedFilm::Small(small.into()),
            None => PackedFilm::Unpacked(Box::new(film)),
        }
    }

    /// Unpacks the film. The window is given by its left and top edge, its width and its height.
    pub fn film(&self, [left, top, width, height]: [u32; 4]) -> Film {
        let film = |pixels: Vec<Pixel>| {
            let mut film = Film::window(left, top, width, height);
            film.pixels = pixels;
            film
        };
        match self {
            PackedFilm::OneSample(colors) => film(colors.iter().copied().map(Pixel::of_single).collect()),
            PackedFilm::UnitWeights(pixels) => film(pixels.iter().map(EqualWeights::pixel).collect()),
            PackedFilm::Small(pixels) => film(pixels.iter().map(CompactPixel::pixel).collect()),
            PackedFilm::Unpacked(film) => Film::clone(film),
        }
    }

    /// Calls `offer` with the mean and coverage of each pixel, row by row. The values equal
    /// [`Film::resolve`] and [`Film::coverage`].
    pub fn for_each_mean(&self, mut offer: impl FnMut(Color, f32)) {
        let mut offer_pixel = |pixel: &Pixel| offer(pixel.mean(), pixel.coverage());
        match self {
            PackedFilm::OneSample(colors) => colors.iter().for_each(|&color| offer(color, 1.0)),
            PackedFilm::UnitWeights(pixels) => pixels.iter().for_each(|even| offer_pixel(&even.pixel())),
            PackedFilm::Small(pixels) => pixels.iter().for_each(|small| offer_pixel(&small.pixel())),
            PackedFilm::Unpacked(film) => film.pixels.iter().for_each(offer_pixel),
        }
    }

    /// Returns true if all pixels have full coverage.
    pub fn has_full_coverage(&self) -> bool {
        match self {
            PackedFilm::OneSample(_) | PackedFilm::UnitWeights(_) | PackedFilm::Small(_) => true,
            PackedFilm::Unpacked(film) => film.pixels.iter().all(|pixel| pixel.coverage() == 1.0),
        }
    }

    /// Returns the film if it is stored unpacked. Films with rejected samples are always stored
    /// unpacked.
    pub fn unpacked(&self) -> Option<&Film> {
        match self {
            PackedFilm::Unpacked(film) => Some(film),
            PackedFilm::OneSample(..) | PackedFilm::UnitWeights(_) | PackedFilm::Small(_) => None,
        }
    }

    /// Returns the usual size of a packed pixel with `samples` samples, in bytes.
    pub fn pixel_bytes(samples: u32) -> u64 {
        (if samples == 1 { size_of::<Color>() } else { size_of::<CompactPixel>() }) as u64
    }
}
