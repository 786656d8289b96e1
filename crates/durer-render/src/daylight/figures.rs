//! Figures that rate the daylight of a year.
//!
//! Sources: Reinhart, Mardaljevic and Rogers, *Dynamic daylight performance metrics for sustainable
//! building design*, Leukos 3, 2006, for daylight autonomy; Nabil and Mardaljevic, *Useful daylight
//! illuminance*, Lighting Research and Technology 37, 2005; IES LM-83, *Spatial daylight autonomy
//! and annual sunlight exposure*.

use super::batches::{BATCHES, Batches, jackknife_error};
use super::sky_year::SkyYear;
use durer_scene::weather::WeatherRow;

/// Hours during which a building is in use.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Schedule {
    /// Start of the use in hours since midnight, in the standard time of the weather file.
    pub from: f64,
    /// End of the use. If it is less than `from`, the use ends on the next day.
    pub to: f64,
    /// True if the building is used only from Monday to Friday.
    pub weekdays_only: bool,
}

impl Default for Schedule {
    fn default() -> Self {
        Schedule { from: 8.0, to: 18.0, weekdays_only: false }
    }
}

impl Schedule {
    /// Returns true if the middle of an interval is within the schedule. If the day of the week is
    /// unknown, it counts as a weekday.
    pub fn includes(&self, row: &WeatherRow) -> bool {
        let is_used = match self.from <= self.to {
            true => (self.from..self.to).contains(&row.hours),
            false => row.hours >= self.from || row.hours < self.to,
        };
        is_used && !(self.weekdays_only && row.weekday.is_some_and(|day| day >= 5))
    }
}

/// Illuminances that the figures of a year use, in lux.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Thresholds {
    /// Target of the daylight autonomy.
    pub target: f64,
    /// Limits between the classes of useful daylight: too little, supplementary, autonomous, and
    /// too much.
    pub useful: [f64; 3],
    /// Illuminance from which direct sunlight counts.
    pub sun: f64,
}

impl Default for Thresholds {
    fn default() -> Self {
        Thresholds { target: 300.0, useful: [100.0, 300.0, 3000.0], sun: 1000.0 }
    }
}

/// Figures of the daylight at a sensor over the occupied hours of a year, or their standard errors.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct AnnualFigures {
    /// Daylight autonomy: share of the occupied hours in which daylight reaches the target.
    pub autonomy: f64,
    /// Continuous daylight autonomy: hours below the target count in part, in proportion to their
    /// illuminance.
    pub continuous_autonomy: f64,
    /// Useful daylight: shares of the occupied hours in the four classes of
    /// [`Thresholds::useful`].
    pub useful: [f64; 4],
    /// Mean illuminance over the occupied hours, in lux.
    pub mean: f64,
    /// Occupied hours in which direct sunlight reaches [`Thresholds::sun`].
    pub sun_hours: f64,
}

/// Rows of the weather during which a building is in use.
pub(super) struct Occupied {
    /// True for each row that counts.
    pub rows: Vec<bool>,
    /// Hours that count.
    pub hours: f64,
    /// Hours that are left out because their values are missing.
    pub missing: f64,
    /// Length of a row in hours.
    pub duration: f64,
}

impl Occupied {
    /// Returns the rows of a year during which a building is in use.
    pub fn new(year: &SkyYear, schedule: &Schedule) -> Self {
        let duration = year.weather.rows.first().map_or(1.0, |row| row.duration);
        let mut occupied = Occupied { rows: Vec::new(), hours: 0.0, missing: 0.0, duration };
        for (row, is_missing) in year.weather.rows.iter().zip(&year.missing) {
            let is_occupied = schedule.includes(row);
            occupied.rows.push(is_occupied && !is_missing);
            match (is_occupied, is_missing) {
                (true, true) => occupied.missing += duration,
                (true, false) => occupied.hours += duration,
                (false, _) => {}
            }
        }
        occupied
    }
}

impl AnnualFigures {
    /// Number of figures.
    const COUNT: usize = 8;

    fn to_array(self) -> [f64; Self::COUNT] {
        let [low, some, enough, high] = self.useful;
        [self.autonomy, self.continuous_autonomy, low, some, enough, high, self.mean, self.sun_hours]
    }

    fn from_array(
        [autonomy, continuous_autonomy, low, some, enough, high, mean, sun_hours]: [f64; Self::COUNT],
    ) -> Self {
        AnnualFigures { autonomy, continuous_autonomy, useful: [low, some, enough, high], mean, sun_hours }
    }

    /// Share of the occupied hours with useful daylight, which is neither too little nor too much.
    pub fn useful_share(&self) -> f64 {
        self.useful[1] + self.useful[2]
    }

    /// Computes the figures from the illuminances of the bright and occupied intervals. All other
    /// occupied hours are dark.
    fn of(hours: impl Iterator<Item = f64>, occupied: &Occupied, limits: &Thresholds, sun_hours: f64) -> Self {
        let mut sums = AnnualFigures { sun_hours, ..AnnualFigures::default() };
        let mut bright = 0.0;
        for lux in hours {
            bright += 1.0;
            sums.autonomy += f64::from(u8::from(lux >= limits.target));
            sums.continuous_autonomy += (lux / limits.target).min(1.0);
            let [low, high, most] = limits.useful;
            let class = usize::from(lux >= low) + usize::from(lux >= high) + usize::from(lux > most);
            sums.useful[class] += 1.0;
            sums.mean += lux;
        }
        if occupied.hours <= 0.0 {
            return AnnualFigures { sun_hours, ..AnnualFigures::default() };
        }
        let all = occupied.hours / occupied.duration;
        sums.useful[0] += all - bright;
        let mut shares = sums.to_array().map(|sum| sum / all);
        shares[Self::COUNT - 1] = sun_hours;
        AnnualFigures::from_array(shares)
    }
}

/// Computes the figures of a sensor, their standard errors, and the daylight autonomy without each
/// batch of samples.
pub(super) fn of_year(
    year: &SkyYear,
    occupied: &Occupied,
    hours: &[Batches],
    sun: &[f32],
    limits: &Thresholds,
) -> (AnnualFigures, AnnualFigures, [f64; BATCHES]) {
    let used = || year.bright.iter().zip(hours).zip(sun).filter(|((hour, _), _)| occupied.rows[hour.row]);
    let sunny = used().filter(|(_, sun)| f64::from(**sun) >= limits.sun);
    let sun_hours = sunny.count() as f64 * occupied.duration;
    let sum = |batches: &Batches| batches.iter().map(|&value| f64::from(value)).sum::<f64>();
    let mean = |batches: &Batches| sum(batches) / BATCHES as f64;
    let figures = AnnualFigures::of(used().map(|((_, batches), _)| mean(batches)), occupied, limits, sun_hours);
    let without: [AnnualFigures; BATCHES] = std::array::from_fn(|batch| {
        let rest = |batches: &Batches| (sum(batches) - f64::from(batches[batch])) / (BATCHES - 1) as f64;
        AnnualFigures::of(used().map(|((_, batches), _)| rest(batches)), occupied, limits, sun_hours)
    });
    let errors = std::array::from_fn(|figure| jackknife_error(&without.map(|one| one.to_array()[figure])));
    (figures, AnnualFigures::from_array(errors), without.map(|one| one.autonomy))
}

/// Returns the share of the values that are at least `enough`; 0 without values.
pub fn daylit_share(values: impl Iterator<Item = f64>, enough: f64) -> f64 {
    let (mut all, mut daylit) = (0_u32, 0_u32);
    for value in values {
        all += 1;
        daylit += u32::from(value >= enough);
    }
    if all == 0 { 0.0 } else { f64::from(daylit) / f64::from(all) }
}
