//! Traces the scene where pictures differ.

use super::stage::ReferenceScene;
use crate::explain::format_line;
use crate::failure::Failure;
use crate::open::CompiledInput;
use durer::image::Transfer;
use durer::image::compare::Comparison;
use durer::math::Ray;
use durer::render::explain::{ExplainOptions, SceneNames, explain_ray, ray_text};
use durer::render::{Job, center_ray, raster};
use durer::sampler::SampleId;
use serde_json::{Value, json};

/// The ray through the pixel that differs most in a region, with an explanation for the report of
/// `durer compare`.
pub struct PixelHit {
    /// First hit of the ray, or `None` if it hits nothing.
    pub hit: Option<Hit>,
    /// Explanation of the ray's colour, as the lines that `durer explain` prints.
    pub explanation: Vec<String>,
    /// Command that explains the whole pixel.
    pub command: String,
}

/// The first surface that a ray hits, with names for the report.
pub struct Hit {
    pub object: String,
    pub material: String,
    pub t: f32,
    pub normal: [f32; 3],
}

/// Traces the ray through the pixel that differs most in each region.
pub fn pixel_hits(stage: &ReferenceScene, comparison: &Comparison) -> Result<Vec<PixelHit>, Failure> {
    let ReferenceScene { compiled, job, .. } = stage;
    let raster = raster(&compiled.world, job.width, job.height);
    let look = |pixel: (u32, u32)| {
        let ray = center_ray(&compiled.world, &raster, pixel);
        let (hit, explanation) =
            ray.map_or(Ok((None, Vec::new())), |ray| along(compiled, job, &ray, stage.transfer))?;
        Ok(PixelHit { hit, explanation, command: stage.explain(pixel) })
    };
    comparison.regions.iter().map(|region| look(region.worst)).collect()
}

fn along(
    compiled: &CompiledInput,
    job: &Job,
    ray: &Ray,
    transfer: Transfer,
) -> Result<(Option<Hit>, Vec<String>), Failure> {
    let world = &compiled.world;
    let names = SceneNames { files: &compiled.files, scene: &compiled.loaded.scene, world };
    let hit = world.intersect(ray, &mut ()).map(|at| Hit {
        object: names.object(at.hit.object),
        material: names.material(at.material),
        t: at.hit.t,
        normal: at.surface.n_shade.to_array(),
    });
    let light = explain_ray(world, job, ray, SampleId::default());
    let lines = light
        .iter()
        .flat_map(|light| ray_text(light, &names, &ExplainOptions { transfer, ..ExplainOptions::default() }));
    Ok((hit, lines.map(|line| format_line(&line, false, transfer)).collect()))
}

impl PixelHit {
    /// Formats the hit as one line.
    pub fn line(&self) -> String {
        match &self.hit {
            Some(Hit { object, material, t, normal: [x, y, z] }) => {
                format!("{object}, {material}, t {t}, normal {x:.3} {y:.3} {z:.3}")
            }
            None => "the ray hits nothing".into(),
        }
    }

    /// Returns the hit, the explanation and the command as JSON.
    pub fn json(&self) -> Value {
        json!({
            "hit": self.hit.as_ref().map(|hit| json!({
                "object": hit.object, "material": hit.material, "t": hit.t, "normal": hit.normal,
            })),
            "explanation": self.explanation,
            "command": self.command,
        })
    }
}
