//! Attack `far`: renders closed rooms far from the origin with lights and a bright background
//! outside. No light must enter
//! through the walls.

use super::{Attack, Outcome};
use anyhow::{Context, Result};
use durer::render::{Control, Job, Sampling, render};
use std::sync::Arc;

/// Width and height of the pictures in pixels.
const SIDE: u32 = 24;

/// Runs the attack.
pub fn run(attack: &Attack) -> Result<Outcome> {
    let mut failures = Vec::new();
    for number in 0..attack.count {
        let random = |place: u32| attack.random(number, place, 1 << 20) as f64 / f64::from(1 << 20);
        // Use distances from 10 to 10^6, and walls that are at least four single-precision steps
        // thick.
        let far = durer::math::fp::pow(10.0, 1.0 + 5.0 * random(0) as f32);
        let step = f64::from(far.next_up() - far);
        let wall = (4.0 + (60.0 * random(1)).floor()) * step;
        let half = (1.0 + 3.0 * random(2)).max(20.0 * wall);
        let center = [0, 1, 2].map(|axis| match attack.random(number, 3 + axis, 3) {
            0 => 0.0,
            1 => f64::from(far),
            _ => -f64::from(far),
        });
        // Round coordinates to single-precision steps, so that they are exact in the scene's text.
        let on_step = |x: f64| (x / step).round() * step;
        let half = on_step(half);
        let corner = |grow: f64, sign: f64| center.map(|c| on_step(c) + sign * (half + grow));
        let cuboid = |grow: f64| {
            let [min, max] = [corner(grow, -1.0), corner(grow, 1.0)].map(|c| format!("{} {} {}", c[0], c[1], c[2]));
            format!("Box {{ min {min} max {max} }}")
        };
        let eye = center.map(|c| on_step(c) + 0.3 * half);
        let way = [random(6) - 0.5, random(7) - 0.5, -1.0];
        let text = format!(
            "PerspectiveCamera {{ center {} {} {} direction {} {} {} up 0 1 0 angle 100 }}
            Background {{ color 1 1 1 ambientLight 0 0 0 }}
            Lights {{ DirectionalLight {{ direction -0.5 -1 -0.4 color 9 9 9 }} PointLight {{ position {} {} {} color 9 9 9 }} }}
            Materials {{ PhongMaterial {{ diffuseColor 1 1 1 }} }}
            Group {{ MaterialIndex 0 Difference {{ {} {} }} }}",
            eye[0], eye[1], eye[2], way[0], way[1], way[2],
            center[0] + 3.0 * half, center[1] + 2.0 * half, center[2] + 2.5 * half,
            cuboid(wall), cuboid(0.0),
        );
        let world = crate::world("room.txt", &text)?;
        let usual = Job::default();
        let job = Job {
            width: SIDE,
            height: SIDE,
            sampling: Sampling::Center,
            settings: durer::integrator::RenderSettings { shadows: true, ..usual.settings },
            ..usual
        };
        let rendered = render(&world, &job, &Arc::new(Control::default()))?;
        let pixels = &rendered.layers.first().context("a picture")?.image.pixels;
        let lit = pixels.iter().filter(|pixel| pixel.max_element() > 0.0).count();
        if lit > 0 {
            let steps = (wall / step).round();
            failures.push(format!("at {center:?}, a wall of {wall} ({steps} steps): {lit} pixels are lit"));
        }
    }
    Ok(Outcome { tried: attack.count, failures, note: String::new() })
}
