//! List of all surfaces that a ray crosses.

use crate::failure::Failure;
use crate::report::counted;
use crate::terminal::print_line;
use durer::math::{Ray, Ray64};
use durer::render::explain::{SceneNames, number, vector};
use durer::world::{Hit, SurfaceInteraction, World};

/// Returns all crossings of a ray with the surfaces there, sorted by `t`. Hits of one object with
/// the same `t` count once. Where objects touch, one is left before the other is entered.
fn crossings(world: &World, ray: &Ray) -> Vec<(Hit, SurfaceInteraction)> {
    let ray = Ray64::from(ray);
    let mut hits = Vec::new();
    for object in 0..world.objects().len() as u32 {
        let mut rest = ray;
        while let Some(hit) = world.hit_of(object, &rest) {
            // With the rules of some years, a ray also hits at the start of its interval.
            let is_new = hits.last().is_none_or(|last: &Hit| last.object != object || hit.t > last.t);
            rest.rounded.t_min = if is_new { hit.t } else { rest.rounded.t_min.next_up() };
            if is_new {
                hits.push(hit);
            }
        }
    }
    let mut crossings: Vec<_> = hits.into_iter().map(|hit| (hit, world.interaction(ray, hit))).collect();
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
