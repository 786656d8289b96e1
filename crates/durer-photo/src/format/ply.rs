//! Points with colours as PLY, binary and little-endian.
//!
//! Source: Turk, *The PLY Polygon File Format*, 1994.

use crate::Reconstruction;

/// The points, then the places of the cameras in red.
pub fn write(all: &Reconstruction) -> Vec<u8> {
    let cameras = all.views.iter().filter_map(|view| Some((view.pose.as_ref()?.center(), [255, 0, 0])));
    let rows: Vec<_> = all.points.iter().map(|point| (point.position, point.color)).chain(cameras).collect();
    let mut bytes = format!("ply\nformat binary_little_endian 1.0\nelement vertex {}\n", rows.len()).into_bytes();
    for (kind, names) in [("float", ["x", "y", "z"]), ("uchar", ["red", "green", "blue"])] {
        names.iter().for_each(|name| bytes.extend(format!("property {kind} {name}\n").bytes()));
    }
    bytes.extend(b"end_header\n");
    for (position, color) in rows {
        position.iter().for_each(|value| bytes.extend((*value as f32).to_le_bytes()));
        bytes.extend(color);
    }
    bytes
}
