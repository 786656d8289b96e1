//! Sums at rest, in as few bytes as they need: a picture's memory is mostly this.

use super::film::{Film, Pixel, WEIGHT_SCALE};
use crate::math::Color;

/// A film that nothing is added to for a while. It is the same film: what comes out is what went
/// in.
#[derive(Clone, Debug, PartialEq, Eq)]
pub enum Packed {
    /// Each pixel has one sample of weight 1, which saw something: its colour, and its luminance.
    Single(Box<[[i64; 3]]>, Box<[i32]>),
    /// Sums of 64 bits are enough, and all samples saw something.
    Small(Box<[Small]>),
    /// All that a film can hold.
    Whole(Box<Film>),
}

/// The sums of [`Pixel`], as far as they are not known otherwise.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Small {
    color: [i64; 3],
    /// In two words, so that nothing lies empty.
    squares: [u64; 2],
    luminance: i64,
    weight: i64,
    samples: u32,
}

impl Small {
    fn of(pixel: &Pixel) -> Option<Self> {
        let [r, g, b] = pixel.color;
        (pixel.covered == pixel.weight).then_some(())?;
        Some(Small {
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

    fn of_single((&color, &luminance): (&[i64; 3], &i32)) -> Self {
        let luminance = i64::from(luminance);
        Small {
            color,
            squares: words((luminance * luminance).into()),
            luminance,
            weight: WEIGHT_SCALE as i64,
            samples: 1,
        }
    }
}

/// The colour of one sample of weight 1 that saw something, and its luminance in few bits.
fn single(pixel: &Pixel) -> Option<([i64; 3], i32)> {
    let is_single = pixel.samples == 1
        && pixel.weight == WEIGHT_SCALE as i64
        && pixel.covered == pixel.weight
        && pixel.squares == i128::from(pixel.luminance) * i128::from(pixel.luminance);
    let [r, g, b] = pixel.color;
    let luminance = is_single.then(|| pixel.luminance.try_into().ok()).flatten()?;
    Some(([r.try_into().ok()?, g.try_into().ok()?, b.try_into().ok()?], luminance))
}

/// All of a film's pixels made smaller, if all can be.
fn all<T>(film: &Film, smaller: impl Fn(&Pixel) -> Option<T>) -> Option<Vec<T>> {
    let mut made = Vec::with_capacity(film.pixels.len());
    for pixel in &film.pixels {
        made.push(smaller(pixel)?);
    }
    Some(made)
}

/// The lower and the upper half.
fn words(number: i128) -> [u64; 2] {
    [number as u64, (number >> 64) as u64]
}

impl Packed {
    /// A film, packed; `samples`: how many its pixels will have in all. What grows later is as wide
    /// from the start, so that no memory is left between what was smaller.
    pub fn new(film: Film, samples: u32) -> Self {
        if film.rejected() > 0 {
            return Packed::Whole(Box::new(film));
        }
        if samples == 1
            && let Some(singles) = all(&film, single)
        {
            let (colors, luminances): (Vec<_>, Vec<_>) = singles.into_iter().unzip();
            return Packed::Single(colors.into(), luminances.into());
        }
        match all(&film, Small::of) {
            Some(small) => Packed::Small(small.into()),
            None => Packed::Whole(Box::new(film)),
        }
    }

    /// The film, whose window is given again: its left and upper edge, its width and height.
    pub fn film(&self, [left, top, width, height]: [u32; 4]) -> Film {
        let film = |pixels: Vec<Pixel>| {
            let mut film = Film::window(left, top, width, height);
            film.pixels = pixels;
            film
        };
        match self {
            Packed::Single(colors, luminances) => {
                film(colors.iter().zip(luminances).map(|one| Small::of_single(one).pixel()).collect())
            }
            Packed::Small(pixels) => film(pixels.iter().map(Small::pixel).collect()),
            Packed::Whole(film) => Film::clone(film),
        }
    }

    /// The mean and the coverage of each pixel, row by row: as [`Film::resolve`] and
    /// [`Film::coverage`].
    pub fn means(&self, mut offer: impl FnMut(Color, f32)) {
        let mut offer = |pixel: &Pixel| offer(pixel.mean(), pixel.coverage());
        match self {
            Packed::Single(colors, luminances) => {
                colors.iter().zip(luminances).for_each(|one| offer(&Small::of_single(one).pixel()));
            }
            Packed::Small(pixels) => pixels.iter().for_each(|small| offer(&small.pixel())),
            Packed::Whole(film) => film.pixels.iter().for_each(offer),
        }
    }

    /// Whether it is quickly known that all of each pixel saw something.
    pub fn is_covered(&self) -> bool {
        !matches!(self, Packed::Whole(_))
    }

    /// The film itself, where samples were left out: others pack.
    pub fn with_rejected(&self) -> Option<&Film> {
        match self {
            Packed::Whole(film) => Some(film),
            Packed::Single(..) | Packed::Small(_) => None,
        }
    }

    /// Bytes that a pixel of so many samples takes, where light is not stronger than usual.
    pub fn pixel_bytes(samples: u32) -> u64 {
        (if samples == 1 { size_of::<[i64; 3]>() + size_of::<i32>() } else { size_of::<Small>() }) as u64
    }
}
