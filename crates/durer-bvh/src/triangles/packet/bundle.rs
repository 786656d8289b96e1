//! A packet: rays that go together, and what is known of them.

use super::rays::PacketRays;
use super::shared::{Axes, Meeting};
use crate::lanes::WIDE;
use crate::triangles::tree::TriangleBvh;

/// How many rays may be in a packet.
pub const RAYS: usize = 64;
/// Room for its rays.
pub type Sixteens = [PacketRays; RAYS / WIDE];

pub struct Packet<'a> {
    pub bvh: &'a TriangleBvh,
    pub axes: Axes,
    pub numbers: [u32; RAYS],
    pub sixteens: &'a mut Sixteens,
    /// How many of the sixteens hold rays.
    pub groups: usize,
    /// Whether all begin at the same point.
    pub is_point: bool,
    /// The rays that still search.
    pub alive: u64,
    /// Those that met anything.
    pub met: u64,
    /// None of them goes on beyond.
    pub limit: f32,
    /// The first stands for none.
    pub meetings: &'a mut Vec<Meeting>,
}
