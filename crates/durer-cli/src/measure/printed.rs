//! Prints measured values as CSV, as JSON, and as figures of grids.

use super::LightUnit;
use super::grid::Grid;
use super::plan::{self, Legend};
use crate::failure::Failure;
use crate::terminal::{print_error_line, print_line};
use durer::math::{Color, Vec3};
use durer::measure::{IlluminanceKind, Measured, Sensor, Uniformity};

/// Measured values: first those of single points, and then those of each grid.
pub struct Groups<'a> {
    pub kind: IlluminanceKind,
    pub sensors: &'a [Sensor],
    pub points: &'a [Measured],
    /// For each point, true if it is inside an object and therefore not part of any figures.
    pub inside: &'a [bool],
    pub unit: LightUnit,
    /// Number of single points.
    pub alone: usize,
    pub grids: &'a [Grid],
}

/// Formats a vector as x,y,z.
pub fn vector(v: Vec3) -> String {
    format!("{},{},{}", v.x, v.y, v.z)
}

/// Describes the points of a grid that its figures leave out, or returns nothing if they use all.
pub fn left_out(outside: usize, all: usize) -> String {
    match all - outside {
        0 => String::new(),
        count => format!("; {outside} of {all} points; {count} inside an object"),
    }
}

impl<'a> Groups<'a> {
    /// Iterates over the grids with their values. Points inside objects have no value.
    pub fn grids(&self) -> impl Iterator<Item = (&'a Grid, Vec<Option<Measured>>)> {
        let mut first = self.alone;
        self.grids.iter().map(move |grid| {
            let range = first..first + grid.len();
            first = range.end;
            let points = self.points[range.clone()].iter().zip(&self.inside[range]);
            (grid, points.map(|(point, inside)| (!inside).then_some(*point)).collect())
        })
    }

    /// Prints a row per point.
    pub fn print_rows(&self) {
        print_line("x,y,z,nx,ny,nz,illuminance,illuminance_error,irradiance_r,irradiance_g,irradiance_b");
        for (sensor, measured) in self.sensors.iter().zip(self.points) {
            let color = Color::from(measured.irradiance.map(|x| x as f32));
            let [p, n, c] = [sensor.point, sensor.normal, color].map(vector);
            print_line(&format!("{p},{n},{:.6},{:.6},{c}", measured.illuminance, measured.error));
        }
    }

    /// Prints the figures of each grid to standard error.
    pub fn print_summaries(&self) {
        let unit = self.unit.suffix();
        for (number, (_, points)) in self.grids().enumerate() {
            let outside = outside(&points);
            let Some(figures) = Uniformity::of(&outside) else { continue };
            let Uniformity { min, average, max } = figures;
            let left_out = left_out(outside.len(), points.len());
            print_error_line(&format!(
                "note: grid {}: {}average {average:.4}, minimum {min:.4}, maximum {max:.4}{unit}, U0 {:.3}, U1 {:.3}{left_out}",
                number + 1,
                self.quantity(),
                figures.u0(),
                figures.u1()
            ));
        }
        if self.unit == LightUnit::Watts {
            print_error_line("note: illuminance is in lux, irradiance in W/m^2");
        }
    }

    /// Prints all points, and the figures of each grid.
    pub fn print_json(&self) -> Result<(), Failure> {
        let point = |((sensor, measured), inside): ((&Sensor, &Measured), &bool)| {
            serde_json::json!({
                "point": sensor.point.to_array(),
                "normal": sensor.normal.to_array(),
                "illuminance": measured.illuminance,
                "illuminance_error": measured.error,
                "irradiance": measured.irradiance,
                "samples": measured.samples,
                "inside": inside,
            })
        };
        let grid = |(grid, points): (&Grid, Vec<Option<Measured>>)| {
            let outside = outside(&points);
            let figures = Uniformity::of(&outside)?;
            Some(serde_json::json!({
                "counts": grid.counts,
                "average": figures.average,
                "minimum": figures.min,
                "maximum": figures.max,
                "u0": figures.u0(),
                "u1": figures.u1(),
                "inside": points.len() - outside.len(),
                "values": points.iter().map(|point| point.map(|point| point.illuminance)).collect::<Vec<_>>(),
            }))
        };
        let [illuminance, irradiance] = self.unit.names();
        let value = serde_json::json!({
            "quantity": format!("{} illuminance", self.kind.name()),
            "units": { "illuminance": illuminance, "irradiance": irradiance },
            "points": self.sensors.iter().zip(self.points).zip(self.inside).map(point).collect::<Vec<_>>(),
            "grids": self.grids().filter_map(grid).collect::<Vec<_>>(),
        });
        print_line(&serde_json::to_string_pretty(&value)?);
        Ok(())
    }

    /// Draws the plan of a grid with its figures, and with isolux lines at `levels` or, if there
    /// are none, at round values.
    pub fn plan(&self, grid: &Grid, points: &[Option<Measured>], up: Vec3, levels: &[f64]) -> String {
        let values: Vec<f64> = points.iter().map(|point| point.map_or(f64::NAN, |point| point.illuminance)).collect();
        let unit = self.unit.suffix();
        let caption = Uniformity::of(&outside(points)).map_or(String::new(), |figures| {
            let Uniformity { min, average, max } = figures;
            let digits = if max < 100.0 { 3 } else { 1 };
            let [u0, u1] = [figures.u0(), figures.u1()];
            format!(
                "{}average {average:.digits$}, minimum {min:.digits$}, maximum {max:.digits$}{unit}, U0 {u0:.2}, U1 {u1:.2}",
                self.quantity()
            )
        });
        plan::draw(grid, &values, up, &Legend { unit: unit.trim(), caption, levels })
    }

    /// Returns the name of a quantity that is not the usual one, as the start of a sentence.
    fn quantity(&self) -> String {
        match self.kind {
            IlluminanceKind::Planar => String::new(),
            kind => format!("{} illuminance: ", kind.name()),
        }
    }
}

/// Returns the values of the points that are not inside an object.
fn outside(points: &[Option<Measured>]) -> Vec<Measured> {
    points.iter().copied().flatten().collect()
}
