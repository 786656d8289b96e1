//! A packet of coherent rays, and the data that they share.

use super::rays::PacketRays;
use super::shared::{HitTriangle, PacketAxes};
use crate::lanes::WIDE;
use crate::triangles::tree::TriangleBvh;

/// Maximum number of rays in a packet.
pub const RAYS: usize = 64;
/// Rays of a packet, stored in four groups of sixteen.
pub type RayGroups = [PacketRays; RAYS / WIDE];

/// Up to 64 coherent rays that traverse a [`TriangleBvh`] together, and the hits found so far.
pub struct Packet<'a> {
    pub bvh: &'a TriangleBvh,
    pub axes: PacketAxes,
    pub numbers: [u32; RAYS],
    pub sixteens: &'a mut RayGroups,
    /// Number of groups in use.
    pub groups: usize,
    /// True if all rays have the same origin.
    pub has_common_origin: bool,
    /// Mask of the rays that are still searching.
    pub alive: u64,
    /// Mask of the rays with a hit.
    pub hit_mask: u64,
    /// Upper bound on the `t` of all rays.
    pub limit: f32,
    /// Triangles that have been hit so far. The first entry is a placeholder that means no hit.
    pub packet_hits: &'a mut Vec<HitTriangle>,
}
