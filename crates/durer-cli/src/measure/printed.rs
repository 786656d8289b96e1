//! Prints measured values as CSV, as JSON, and as figures of grids.

use super::grid::Grid;
use crate::failure::Failure;
use crate::terminal::{print_error_line, print_line};
use durer::math::{Color, Vec3};
use durer::measure::{Measured, Sensor, Uniformity};

/// Measured values: first those of single points, and then those of each grid.
pub struct Groups<'a> {
    pub sensors: &'a [Sensor],
    pub points: &'a [Measured],
    /// Number of single points.
    pub alone: usize,
    pub grids: &'a [Grid],
}

/// Formats a vector as x,y,z.
pub fn vector(v: Vec3) -> String {
    format!("{},{},{}", v.x, v.y, v.z)
}

impl<'a> Groups<'a> {
    /// Iterates over the grids with their values.
    pub fn grids(&self) -> impl Iterator<Item = (&'a Grid, &'a [Measured])> {
        let mut rest = &self.points[self.alone..];
        self.grids.iter().map(move |grid| {
            let (own, others) = rest.split_at(grid.len());
            rest = others;
            (grid, own)
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
        for (number, (_, points)) in self.grids().enumerate() {
            let Some(figures) = Uniformity::of(points) else { continue };
            let Uniformity { min, average, max } = figures;
            print_error_line(&format!(
                "note: grid {}: average {average:.4}, minimum {min:.4}, maximum {max:.4}, U0 {:.3}, U1 {:.3}",
                number + 1,
                figures.u0(),
                figures.u1()
            ));
        }
    }

    /// Prints all points, and the figures of each grid.
    pub fn print_json(&self) -> Result<(), Failure> {
        let point = |(sensor, measured): (&Sensor, &Measured)| {
            serde_json::json!({
                "point": sensor.point.to_array(),
                "normal": sensor.normal.to_array(),
                "illuminance": measured.illuminance,
                "illuminance_error": measured.error,
                "irradiance": measured.irradiance,
                "samples": measured.samples,
            })
        };
        let grid = |(grid, points): (&Grid, &[Measured])| {
            let figures = Uniformity::of(points)?;
            Some(serde_json::json!({
                "counts": grid.counts,
                "average": figures.average,
                "minimum": figures.min,
                "maximum": figures.max,
                "u0": figures.u0(),
                "u1": figures.u1(),
                "values": points.iter().map(|point| point.illuminance).collect::<Vec<_>>(),
            }))
        };
        let value = serde_json::json!({
            "points": self.sensors.iter().zip(self.points).map(point).collect::<Vec<_>>(),
            "grids": self.grids().filter_map(grid).collect::<Vec<_>>(),
        });
        print_line(&serde_json::to_string_pretty(&value)?);
        Ok(())
    }
}
