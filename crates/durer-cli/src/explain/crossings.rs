//! List of all surfaces that a ray crosses.

use crate::failure::Failure;
use crate::report::counted;
use crate::terminal::print_line;
use durer::math::Ray;
use durer::render::explain::{SceneNames, number, vector};
use durer::world::{Hit, SurfaceInteraction, World};

/// Returns all crossings of a ray with the surfaces there, sorted by `t`. Hits of one object with
/// the same `t` count once. At the same `t`, the ray leaves objects before it enters others.
fn crossings(world: &World, ray: &Ray) -> Vec<(Hit, SurfaceInteraction)> {
    let hits = (0..world.objects().len() as u32).flat_map(|object| world.all_hits_of(object, ray));
    let mut crossings: Vec<_> = hits.map(|hit| (hit, world.interaction(ray, hit))).collect();
    crossings.sort_by(|(a, at_a), (b, at_b)| a.t.total_cmp(&b.t).then(at_b.inside().cmp(&at_a.inside())));
    crossings
}

/// Prints all surfaces that a ray crosses, with a direction of unit length.
pub fn print(names: &SceneNames, ray: &Ray, as_json: bool) -> Result<(), Failure> {
    let all = crossings(names.world, ray);
    if as_json {
        let rows = all.iter().map(|(hit, at)| {
            serde_json::json!({
                "t": hit.t,
                "object": hit.object,
                "name": names.object(hit.object),
                "triangle": names.world.triangle(hit),
                "position": at.surface.position.to_array(),
                "n_geo": at.surface.n_geo.to_array(),
                "enters": !at.inside(),
            })
        });
        let value = serde_json::json!({ "count": all.len(), "crossings": rows.collect::<Vec<_>>() });
        print_line(&serde_json::to_string_pretty(&value)?);
        return Ok(());
    }
    print_line(&format!("{} along {} + t {}", counted(all.len(), "crossing"), vector(ray.origin), vector(ray.dir)));
    for (hit, at) in &all {
        let way = if at.inside() { "leaves" } else { "enters" };
        let (object, t) = (names.short_object(hit.object), number(hit.t));
        print_line(&format!("  t = {t}: {way} {object} at {}", vector(at.surface.position)));
    }
    Ok(())
}
