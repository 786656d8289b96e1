//! Detection of shifts by whole pixels, which searches from coarse to fine resolutions.

use super::sample::View;
use durer_bvh::math::Vec3;

/// Maximum width and height, in pixels, of the coarsest resolution.
const SMALLEST: usize = 48;
/// Approximate maximum number of pixels that are compared for each shift.
const PLACES: usize = 20_000;

/// A greyscale picture at one of the resolutions at which shifts are searched for.
struct Grey {
    width: usize,
    height: usize,
    values: Vec<f32>,
}

impl Grey {
    fn of(picture: &View) -> Grey {
        let values = picture.pixels.iter().map(|pixel| pixel.dot(Vec3::splat(1.0 / 3.0))).collect();
        Grey { width: picture.width, height: picture.height, values }
    }

    /// Returns a picture of half the size, in which each pixel is the mean of two by two pixels.
    fn half(&self) -> Grey {
        let (width, height) = (self.width / 2, self.height / 2);
        let at = |x: usize, y: usize| self.values[y * self.width + x];
        let mean = |x: usize, y: usize| 0.25 * (at(x, y) + at(x + 1, y) + at(x, y + 1) + at(x + 1, y + 1));
        let values = (0..height).flat_map(|y| (0..width).map(move |x| mean(2 * x, 2 * y))).collect();
        Grey { width, height, values }
    }

    /// Returns the mean squared difference between this picture, shifted by (`dx`, `dy`), and
    /// another one, over the area that they share.
    fn difference(&self, shifted: &Grey, (dx, dy): (isize, isize)) -> f64 {
        let step = (self.values.len() as f64 / PLACES as f64).sqrt().ceil().max(1.0) as usize;
        let range = |d: isize, size: usize| d.max(0) as usize..(size as isize + d.min(0)).max(0) as usize;
        let (mut sum, mut count) = (0.0, 0usize);
        for y in range(dy, self.height).step_by(step) {
            // Start each row at a different column, so that regular patterns are not missed.
            for x in range(dx, self.width).skip(y * 7 % step).step_by(step) {
                let source = (y as isize - dy) as usize * self.width + (x as isize - dx) as usize;
                let difference = f64::from(shifted.values[y * self.width + x] - self.values[source]);
                sum += difference * difference;
                count += 1;
            }
        }
        if count == 0 { f64::INFINITY } else { sum / count as f64 }
    }
}

/// Returns the most likely shift of the picture to the right and downwards, in pixels and up to a
/// quarter of its size, or `None` if there is no shift.
pub fn shift(reference: &View, test: &View) -> Option<(isize, isize)> {
    let mut levels = vec![(Grey::of(reference), Grey::of(test))];
    while let Some((a, b)) = levels.last()
        && a.width.max(a.height) > SMALLEST
        && a.width.min(a.height) >= 8
    {
        levels.push((a.half(), b.half()));
    }
    let best = |(a, b): &(Grey, Grey), middle: (isize, isize), (rx, ry): (isize, isize)| {
        let around = |m: isize, r: isize| m - r..=m + r;
        let shifts = around(middle.1, ry).flat_map(|dy| around(middle.0, rx).map(move |dx| (dx, dy)));
        // If several shifts are equally good, choose the smallest one.
        let cost = |s: (isize, isize)| (a.difference(b, s), s.0.abs() + s.1.abs());
        shifts.min_by(|&s, &t| {
            let ((s, s_size), (t, t_size)) = (cost(s), cost(t));
            s.total_cmp(&t).then(s_size.cmp(&t_size))
        })
    };
    let coarse = levels.last()?;
    let quarter = ((coarse.0.width / 4) as isize, (coarse.0.height / 4) as isize);
    let mut found = best(coarse, (0, 0), quarter)?;
    for level in levels.iter().rev().skip(1) {
        found = best(level, (2 * found.0, 2 * found.1), (2, 2))?;
    }
    (found != (0, 0)).then_some(found)
}
