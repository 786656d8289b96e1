//! What of the scene is where pictures differ.

use super::stage::Stage;
use crate::explain::shown;
use crate::failure::Failure;
use crate::open::Opened;
use durer::image::Transfer;
use durer::image::compare::Comparison;
use durer::math::Ray;
use durer::render::explain::{Names, Telling, explain_ray, ray_text};
use durer::render::{Job, center_ray, raster};
use durer::sampler::SampleId;
use serde_json::{Value, json};

/// What the ray through the middle of a pixel meets.
pub struct There {
    /// The object, its place in the file, its material, the distance and the normal, where anything
    /// is hit.
    pub hit: Option<Hit>,
    /// Why the ray has its colour, by our rules: lines as `durer explain` prints them.
    pub explanation: Vec<String>,
    /// The command that tells it of the whole pixel.
    pub command: String,
}

pub struct Hit {
    pub object: String,
    pub material: String,
    pub t: f32,
    pub normal: [f32; 3],
}

/// For each region what is at the pixel that differs most.
pub fn there(stage: &Stage, found: &Comparison) -> Result<Vec<There>, Failure> {
    let Stage { opened, job, .. } = stage;
    let raster = raster(&opened.world, job.width, job.height);
    let look = |place: (u32, u32)| {
        let ray = center_ray(&opened.world, &raster, place);
        let (hit, explanation) = ray.map_or(Ok((None, Vec::new())), |ray| along(opened, job, &ray, stage.transfer))?;
        Ok(There { hit, explanation, command: stage.explain(place) })
    };
    found.regions.iter().map(|region| look(region.worst)).collect()
}

fn along(opened: &Opened, job: &Job, ray: &Ray, transfer: Transfer) -> Result<(Option<Hit>, Vec<String>), Failure> {
    let world = &opened.world;
    let names = Names { files: &opened.files, scene: &opened.loaded.scene, world };
    let hit = world.intersect(ray, &mut ()).map(|at| Hit {
        object: names.object(at.hit.object),
        material: names.material(at.material),
        t: at.hit.t,
        normal: at.surface.n_shade.to_array(),
    });
    let light = explain_ray(world, job, ray, SampleId::default());
    let lines = light.iter().flat_map(|light| ray_text(light, &names, &Telling { transfer, ..Telling::default() }));
    Ok((hit, lines.map(|line| shown(&line, false, transfer)).collect()))
}

impl There {
    /// In one line.
    pub fn line(&self) -> String {
        match &self.hit {
            Some(Hit { object, material, t, normal: [x, y, z] }) => {
                format!("{object}, {material}, t {t}, normal {x:.3} {y:.3} {z:.3}")
            }
            None => "nothing is hit there".into(),
        }
    }

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
