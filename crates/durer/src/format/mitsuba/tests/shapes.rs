//! Conventions of shapes and of the materials on them, as Mitsuba 3.9.1 has them.

use super::conventions::{clean_in, mesh};
use crate::format::mitsuba::serialized::tests::{file, stream};

#[test]
fn serialized_meshes_are_what_they_are_as_ply() {
    // The same lists as in the other files; v goes down in both, and flags of colours or of flat
    // faces change nothing.
    let ply = b"ply\nformat ascii 1.0\nelement vertex 4\nproperty float x\nproperty float y\nproperty float z\n\
        property float nx\nproperty float ny\nproperty float nz\nproperty float u\nproperty float v\n\
        element face 2\nproperty list uchar int vertex_indices\nend_header\n\
        0 0 0 0 0 1 0 .125\n1 0 0 0 .6 .8 1 .125\n1 1 0 .6 0 .8 1 .875\n0 1 1 0 0 1 0 .875\n3 0 1 2\n3 0 2 3\n";
    let of = |kind: &str, name: &str, bytes: &[u8], more: &str| {
        let shape = format!("<shape type='{kind}'><string name='filename' value='{name}'/>{more}</shape>");
        mesh(&clean_in(&[(name, bytes)], &shape)).clone()
    };
    let second = "<integer name='shape_index' value='1'/>";
    for more in [
        "",
        "<boolean name='face_normals' value='true'/>",
        "<boolean name='flip_normals' value='true'/>",
        "<transform name='to_world'><scale x='-1'/></transform>",
    ] {
        let wanted = of("ply", "a.ply", ply, more);
        for (version, flags) in [(3, 0x1003), (4, 0x1003), (4, 0x2003), (4, 0x101b)] {
            let bytes = file(version, &[stream(version, 0x1000), stream(version, flags)]);
            assert_eq!(
                of("serialized", "a.serialized", &bytes, &format!("{second}{more}")),
                wanted,
                "{flags:x} {more}"
            );
        }
    }
    // Without normals they are smooth, and the first is without coordinates.
    let bytes = file(4, &[stream(4, 0x1000), stream(4, 0x1003)]);
    let first = of("serialized", "a.serialized", &bytes, "");
    assert!(first.uvs.is_empty() && first.triangle_normals.len() == 2);
}
