//! Reads the parameters of quadrics of which only a part is present.
//!
//! Source: *Physically Based Rendering*, 3rd edition, chapter 3.

use super::params::Params;
use durer_scene::shape::MeshData;
use durer_scene::shape::tessellate::revolution;
use glam::DVec3;

/// Reads `phimax`, the sweep angle around the z axis in degrees. The angle ranges from 0 to 360,
/// and the default is 360.
pub(super) fn sweep_degrees(params: &Params) -> f32 {
    let degrees = params.float("phimax").unwrap_or(360.0);
    if degrees <= 0.0 {
        params.report.error(params.span("phimax"), "`phimax` must be more than 0 degrees");
    }
    degrees.clamp(1e-3, 360.0)
}

fn degrees(params: &Params) -> f64 {
    f64::from(sweep_degrees(params))
}

/// Reads `zmin` and `zmax`, the ends of the shape along z, and returns them in ascending order. The
/// defaults are `low` and `high`.
pub(super) fn z_range(params: &Params, [low, high]: [f32; 2]) -> [f32; 2] {
    let ends = [params.float("zmin").unwrap_or(low), params.float("zmax").unwrap_or(high)];
    [ends[0].min(ends[1]), ends[0].max(ends[1])]
}

/// Returns the part of a sphere between two values of z.
pub(super) fn sphere(params: &Params, radius: f32, [low, high]: [f32; 2], flipped: bool) -> Option<MeshData> {
    let (low, high, radius) = (low.max(-radius), high.min(radius), f64::from(radius));
    if low >= high {
        params.report.error(params.span("zmin"), "no part of this sphere is between `zmin` and `zmax`");
        return None;
    }
    Some(revolution::sphere(radius, [low, high], degrees(params)).oriented(flipped))
}

/// Returns a sector of a disc or of a ring. The texture coordinate v increases towards the centre.
pub(super) fn disk(params: &Params, [inner, outer]: [f32; 2], height: f32, flipped: bool) -> MeshData {
    let [inner, outer, height] = [inner, outer, height].map(f64::from);
    revolution::ring([inner, outer], height, degrees(params)).oriented(flipped)
}

/// Returns an open cone whose base is at z = 0.
pub(super) fn cone(params: &Params, flipped: bool) -> MeshData {
    let radius = f64::from(params.positive("radius").unwrap_or(1.0));
    let height = f64::from(params.positive("height").unwrap_or(1.0));
    revolution::cone(radius, height, degrees(params)).oriented(flipped)
}

/// Returns a paraboloid that reaches its radius at `zmax`.
pub(super) fn paraboloid(params: &Params, flipped: bool) -> Option<MeshData> {
    let radius = f64::from(params.positive("radius").unwrap_or(1.0));
    let [low, high] = z_range(params, [0.0, 1.0]).map(f64::from);
    if low < 0.0 || low >= high {
        params.report.error(params.at, "a paraboloid needs 0 <= `zmin` < `zmax`");
        return None;
    }
    Some(revolution::paraboloid(radius, [low, high], degrees(params)).oriented(flipped))
}

/// Returns the surface that the line from `p1` to `p2` sweeps when it turns around the z axis.
pub(super) fn hyperboloid(params: &Params, flipped: bool) -> Option<MeshData> {
    let end = |name: &'static str, default: DVec3| params.triple(name).map_or(default, |p| p.as_dvec3());
    let (from, to) = (end("p1", DVec3::ZERO), end("p2", DVec3::ONE));
    if from.x * from.x + from.y * from.y + to.x * to.x + to.y * to.y == 0.0 || from == to {
        params
            .report
            .error(params.at, "a hyperboloid needs two different points, `p1` and `p2`, not both on the z axis");
        return None;
    }
    Some(revolution::hyperboloid([from, to], degrees(params)).oriented(flipped))
}
