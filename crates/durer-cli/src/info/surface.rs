//! Area, volume and open edges of the meshes of a world.

use durer::world::{Geometry, MeshTree, World};
use std::collections::HashMap;
use std::sync::Arc;

/// Maximum number of triangles that are measured.
const MAX_TRIANGLES: usize = 20_000_000;

/// Properties of the surface of all meshes in a world, in world space.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct MeshSurface {
    /// Number of edges that are shared by an odd number of triangles; 0 for closed meshes.
    pub open_edges: usize,
    /// Sum of the areas of all triangles.
    pub area: f64,
    /// Volume inside closed meshes, which is negative if the triangles face inwards.
    pub volume: f64,
}

impl MeshSurface {
    /// Measures the meshes of a world. Returns `None` if there are none, or too many triangles.
    pub fn of(world: &World, triangles: usize) -> Option<Self> {
        if triangles == 0 || triangles > MAX_TRIANGLES {
            return None;
        }
        let mut all = MeshSurface::default();
        let mut open: HashMap<*const MeshTree, usize> = HashMap::new();
        for object in world.objects() {
            let Geometry::Mesh(tree) = &object.geometry else { continue };
            all.open_edges += *open.entry(Arc::as_ptr(tree)).or_insert_with(|| tree.mesh.open_edges().len());
            let mirrors = object.to_world.as_ref().is_some_and(|to_world| to_world.flips_handedness());
            let center = object.world_point(tree.mesh.corners(0)[0]).as_dvec3();
            let mut volume = 0.0;
            for triangle in 0..tree.mesh.len() as u32 {
                let corners = tree.mesh.corners(triangle).map(|corner| object.world_point(corner).as_dvec3() - center);
                let [a, b, c] = corners;
                let crossed = (b - a).cross(c - a);
                all.area += 0.5 * crossed.length();
                volume += a.dot(crossed) / 6.0;
            }
            all.volume += if mirrors { -volume } else { volume };
        }
        Some(all)
    }

    /// Describes the surface in one line.
    pub fn text(&self) -> String {
        let area = self.area as f32;
        match self.open_edges {
            0 if self.volume < 0.0 => {
                format!("closed, area {area}, volume {}, triangles face inwards", -self.volume as f32)
            }
            0 => format!("closed, area {area}, volume {}", self.volume as f32),
            1 => format!("open at 1 edge, area {area}"),
            edges => format!("open at {edges} edges, area {area}"),
        }
    }
}
