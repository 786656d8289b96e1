use crate::tests::{abuse, read, read_clean};
use durer_scene::math::{Vec2, Vec3};
use durer_scene::shape::mesh::{MeshData, NO_INDEX};

const HEADER: &str = "ply\nformat ascii 1.0\ncomment by hand\nobj_info none\nelement vertex 4\nproperty uchar red\n\
    property float x\nproperty double y\nproperty short z\nproperty float nx\nproperty float ny\nproperty float nz\n\
    property list uchar float extra\nproperty float s\nproperty float t\nelement camera 2\nproperty list ushort int a\n\
    property int8 b\nelement nothing 99999999999\nelement face 2\nproperty uint flags\n\
    property list int uint vertex_indices\nelement tristrips 1\nproperty list int int vertex_indices\nend_header\n";

/// Rows of the test file. A type precedes each value, so that the rows can also be written in
/// binary.
const VALUES: &str = "u8:255 f32:0 f64:0.1 i16:-3 f32:0 f32:0 f32:1 u8:0 f32:0.5 f32:1
    u8:0 f32:1e-3 f64:0 i16:0 f32:0 f32:0 f32:1 u8:1 f32:7 f32:0 f32:0
    u8:0 f32:1 f64:1 i16:0 f32:0 f32:0 f32:1 u8:2 f32:7 f32:8 f32:1 f32:0
    u8:0 f32:0.1 f64:-1 i16:300 f32:0 f32:1 f32:0 u8:0 f32:1 f32:1
    u16:1 i32:5 i8:-1 u16:0 i8:2 u32:9 i32:3 u32:0 u32:1 u32:2 u32:9 i32:4 u32:0 u32:1 u32:2 u32:3
    i32:9 i32:0 i32:1 i32:2 i32:3 i32:3 i32:-1 i32:1 i32:2 i32:3";

fn ascii() -> Vec<u8> {
    let values = VALUES.split_whitespace().map(|value| value.split_once(':').unwrap().1);
    [HEADER.as_bytes(), values.collect::<Vec<_>>().join(" ").as_bytes()].concat()
}

fn binary(big_endian: bool) -> Vec<u8> {
    let format = if big_endian { "binary_big_endian" } else { "binary_little_endian" };
    let mut bytes = HEADER.replace("ascii", format).into_bytes();
    for value in VALUES.split_whitespace() {
        let (scalar, text) = value.split_once(':').unwrap();
        let mut value = match scalar {
            "f32" => text.parse::<f32>().unwrap().to_le_bytes().to_vec(),
            "f64" => text.parse::<f64>().unwrap().to_le_bytes().to_vec(),
            integer => {
                let size = integer[1..].parse::<usize>().unwrap() / 8;
                text.parse::<i64>().unwrap().to_le_bytes()[..size].to_vec()
            }
        };
        if big_endian {
            value.reverse();
        }
        bytes.extend(value);
    }
    bytes
}

#[test]
fn text_and_both_byte_orders_are_equivalent() {
    let mesh = read_clean(&ascii(), "m.ply");
    assert_eq!(mesh, read_clean(&binary(false), "m.ply"));
    assert_eq!(mesh, read_clean(&binary(true), "m.ply"));
    assert_eq!(mesh, read_clean(&String::from_utf8(ascii()).unwrap().replace('\n', "\r\n").into_bytes(), "m.ply"));
    assert_eq!(mesh, read_clean(&String::from_utf8(ascii()).unwrap().replace('\n', "\r").into_bytes(), "m.ply"));
    assert_eq!(mesh.positions[0], Vec3::new(0.0, 0.1, -3.0));
    assert_eq!(mesh.normals[3], Vec3::Y);
    assert_eq!(mesh.uvs[0], Vec2::new(0.5, 1.0));
    // The faces are a triangle, a quadrilateral, a strip with a degenerate joint, and a strip that
    // follows a restart.
    assert_eq!(mesh.triangles[0], [0, 1, 2]);
    assert_eq!(mesh.triangles[3..], [[0, 1, 2], [2, 1, 3], [1, 2, 3]]);
    assert_eq!((&mesh.triangle_uvs, &mesh.triangle_normals), (&mesh.triangles, &mesh.triangles));
}

const TRIANGLE: &str = "ply\nformat ascii 1.0\nelement vertex 3\nproperty float x\nproperty float y\nproperty float z\n\
    element face 1\nproperty list uchar int vertex_index\nend_header\n0 0 0\n1 0 0\n0 1 0\n3 0 1 2\n";

#[test]
fn faces_may_precede_vertices() {
    let text = "ply\nformat ascii 1.0\nelement face 1\nproperty list uchar int vertex_index\nelement vertex 3\n\
        property float z\nproperty float y\nproperty float x\nend_header\n3 0 1 2\n0 0 0\n0 0 1\n0 1 0\n";
    assert_eq!(read_clean(text.as_bytes(), "m.ply"), read_clean(TRIANGLE.as_bytes(), "m.ply"));
}

/// Reads the triangle after replacing a part of its text, and returns the only diagnostic.
fn finding(from: &str, to: &str) -> String {
    assert!(TRIANGLE.contains(from), "{from}");
    let findings = read(TRIANGLE.replacen(from, to, 1).as_bytes(), "m.ply").1;
    assert_eq!(findings.len(), 1, "{from} -> {to}: {findings:?}");
    findings[0].clone()
}

#[test]
fn wrong_headers() {
    for (from, to, expected) in [
        ("ply\n", "plx\n", "1:1+3 Error: expected `ply` in the first line, found `plx`"),
        (
            "format ascii 1.0\n",
            "",
            "8:1+10 Error: the header has no `format` line (add a second line such as `format ascii 1.0`)",
        ),
        (
            "format ascii 1.0",
            "format asci 1.0",
            "2:8+4 Error: expected one of `ascii`, `binary_little_endian`, `binary_big_endian`, found `asci` (did you mean `ascii`?)",
        ),
        ("1.0", "2.0", "2:14+3 Error: expected version 1.0, found `2.0`"),
        (
            "format ascii 1.0",
            "format ascii",
            "2:1+12 Error: expected `format ascii|binary_little_endian|binary_big_endian 1.0`",
        ),
        ("element vertex 3", "element vertex", "3:1+14 Error: expected `element <name> <number of rows>`"),
        ("element vertex 3", "element vertex -3", "3:16+2 Error: expected a number of rows, found `-3`"),
        (
            "property float x",
            "propertie float x",
            "4:1+9 Error: expected a header line, found `propertie` (did you mean `property`?)",
        ),
        (
            "property float x",
            "property flaot x",
            "4:10+5 Error: expected a type such as `float` or `int`, found `flaot` (did you mean `float`?)",
        ),
        (
            "property float x",
            "property float",
            "4:1+14 Error: expected `property <type> <name>` or `property list <type> <type> <name>`",
        ),
        ("property float x\n", "", "3:9+6 Error: the vertices have no property `x`"),
        (
            "property float y",
            "property float x\nproperty float y",
            "5:16+1 Error: the element `vertex` has a second property `x`",
        ),
        ("property float x", "property list int float x", "4:25+1 Error: `x` must be a number, not a list"),
        (
            "element vertex 3",
            "property int a\nelement vertex 3",
            "3:1+8 Error: a `property` line must come after an `element` line",
        ),
        ("element vertex 3", "element vertices 3", "3:9+8 Error: the file has no element `vertex`"),
        ("list uchar int", "list float int", "8:15+5 Error: the length of a list must have an integer type"),
        ("list uchar int", "list uchar float", "8:27+12 Error: the vertex indices must be a list with an integer type"),
        ("list uchar int", "int", "8:14+12 Error: the vertex indices must be a list with an integer type"),
        (
            "vertex_index",
            "vertex_indexes",
            "8:25+14 Error: the element `face` has no list `vertex_indices` (rename `vertex_indexes` to `vertex_indices`)",
        ),
        ("vertex_index", "colour", "7:9+4 Error: the element `face` has no list `vertex_indices`"),
    ] {
        assert_eq!(finding(from, to), expected);
    }
    let cut = &TRIANGLE[..TRIANGLE.find("end_header").unwrap()];
    let expected = "9:1+0 Error: the file ends within the header, because `end_header` is missing";
    assert_eq!(read(cut.as_bytes(), "m.ply").1, [expected]);
    assert_eq!(read(b"", "m.ply").1, ["1:1+0 Error: expected `ply` in the first line, found ``"]);
}

#[test]
fn wrong_rows() {
    let limit = "(numbers must lie within the range of 32-bit floating point, about ±3.4e38)";
    for (from, to, expected) in [
        ("1 0 0", "1 x 0", "11:3+1 Error: expected a number, found `x`".to_string()),
        ("1 0 0", "1 0 nan", format!("11:5+3 Error: expected a finite number, found `nan` {limit}")),
        ("3 0 1 2", "3 0 1 3", "13:7+1 Error: vertex 3 does not exist: the file has only the vertices 0 to 2".into()),
        ("3 0 1 2", "3 0 -1 2", "13:5+2 Error: vertex -1 does not exist: the file has only the vertices 0 to 2".into()),
        ("3 0 1 2", "3 0 1.5 2", "13:5+3 Error: expected a whole number, found `1.5`".into()),
        ("3 0 1 2", "2 0 1", "13:1+1 Error: a face needs at least 3 vertices, found 2".into()),
        ("3 0 1 2", "-1", "13:1+2 Error: a list cannot have a negative number of values: -1".into()),
        (
            "3 0 1 2",
            "200 0 1 2",
            "13:1+3 Error: the list should have 200 values, but the file ends before the last value".into(),
        ),
        ("3 0 1 2\n", "", "13:1+0 Error: the file ends in row 1 of element `face`, which should have 1 row".into()),
        (
            "3 0 1 2\n",
            "4 0 1 2 \n",
            "14:1+0 Error: the file ends in row 1 of element `face`, which should have 1 row".into(),
        ),
        (
            "3 0 1 2",
            "3 0 1 2\n 7 7",
            "14:2+1 Warning: ignored 4 bytes after the last row (check whether the header declares too few rows or \
             properties)"
                .into(),
        ),
        (
            "face 1",
            "face 0",
            "13:1+1 Warning: ignored 8 bytes after the last row (check whether the header declares too few rows or \
             properties)"
                .into(),
        ),
    ] {
        let found = read(TRIANGLE.replacen(from, to, 1).as_bytes(), "m.ply").1;
        assert!(found.contains(&expected), "{from} -> {to}: {found:#?}");
    }
    let no_faces = TRIANGLE.replace("face 1", "face 0").replace("3 0 1 2\n", "");
    assert_eq!(read(no_faces.as_bytes(), "m.ply").1, ["1:1+0 Warning: the mesh has no triangles"]);
}

#[test]
fn wrong_binary_value_has_byte_offset() {
    let mut bytes = binary(false);
    let body = bytes.len() - (binary(false).len() - HEADER.replace("ascii", "binary_little_endian").len());
    let (lines, _) = (HEADER.lines().count(), ());
    bytes[body + 1..body + 5].copy_from_slice(&f32::NAN.to_le_bytes());
    let found = read(&bytes, "m.ply").1;
    let expected = format!("{}:2+4 Error: expected a finite number, found an infinite value or NaN", lines + 1);
    assert!(found.len() == 1 && found[0].starts_with(&expected), "{found:?}");
    let mut large = binary(true);
    large[body - 3 + 5..][..8].copy_from_slice(&1e300f64.to_be_bytes());
    assert!(read(&large, "m.ply").1[0].contains(":6+8 Error: expected a finite number"));
}

#[test]
fn promised_counts_reserve_no_memory() {
    let huge = "9223372036854775807";
    let header = |format: &str, vertices: &str, faces: &str| {
        TRIANGLE[..TRIANGLE.find("0 0 0").unwrap()]
            .replace("ascii", format)
            .replace("vertex 3", &format!("vertex {vertices}"))
            .replace("face 1", &format!("face {faces}"))
            .replace("list uchar", "list int")
    };
    for format in ["ascii", "binary_little_endian", "binary_big_endian"] {
        for (vertices, faces) in [(huge, "1"), ("0", huge), ("4294967296", "4294967296")] {
            let (mesh, findings) = read(header(format, vertices, faces).as_bytes(), "m.ply");
            assert!(mesh.is_none() && findings.len() == 1, "{findings:?}");
        }
    }
    let short = "10:1+0 Error: the header declares 9223372036854775807 rows of 12 bytes for element `vertex`, but only \
                 0 bytes follow";
    assert_eq!(read(header("binary_little_endian", huge, "0").as_bytes(), "m.ply").1, [short]);
    let mut list = header("binary_little_endian", "0", "1").into_bytes();
    list.extend(i32::MAX.to_le_bytes());
    let expected = "10:1+4 Error: the list should have 2147483647 values, but the file ends before the last value";
    assert_eq!(read(&list, "m.ply").1, [expected]);
}

#[test]
fn all_mesh_attributes_round_trip() {
    let mesh = MeshData {
        positions: vec![Vec3::ZERO, Vec3::X, Vec3::Y, Vec3::ONE],
        uvs: vec![Vec2::new(0.25, 0.5), Vec2::ONE],
        normals: vec![Vec3::Z, Vec3::new(0.0, 3.0, 4.0)],
        triangles: vec![[0, 1, 2], [1, 3, 2]],
        triangle_uvs: vec![[0, 1, 1], [1, 0, 1]],
        triangle_normals: vec![[0, 0, 0], [1, 1, NO_INDEX]],
        colors: vec![[0.1, 0.2, 0.3, 0.4], [1.0; 4], [2.5, 0.0, 0.0, 1.0], [0.0; 4]],
        second_uvs: vec![Vec2::ZERO, Vec2::X, Vec2::Y, Vec2::ONE],
        tangents: vec![[1.0, 0.0, 0.0, -1.0]; 4],
        ..MeshData::default()
    };
    let again = read_clean(&super::write_all_attributes(&mesh), "m.ply");
    assert_eq!((again.triangles.len(), &again.triangle_uvs), (2, &again.triangles));
    for (i, corners) in again.triangles.iter().enumerate() {
        for (k, &corner) in corners.iter().enumerate() {
            let (corner, place) = (corner as usize, mesh.triangles[i][k] as usize);
            assert_eq!(again.positions[corner], mesh.positions[place]);
            assert_eq!(again.colors[corner], mesh.colors[place]);
            assert_eq!(again.second_uvs[corner], mesh.second_uvs[place]);
            assert_eq!(again.tangents[corner], mesh.tangents[place]);
            assert_eq!(again.uvs[corner], mesh.uvs[mesh.triangle_uvs[i][k] as usize]);
            // A corner without a normal gets the normal of its face.
            let flat = durer_scene::shape::triangle::face_normal(mesh.triangles[i].map(|i| mesh.positions[i as usize]));
            let normal = mesh.normals.get(mesh.triangle_normals[i][k] as usize).copied().unwrap_or(flat);
            assert_eq!(again.normals[corner], normal);
        }
    }
    let plain = MeshData { positions: mesh.positions, triangles: mesh.triangles, flat: true, ..MeshData::default() };
    assert_eq!(read_clean(&super::write_all_attributes(&plain), "m.ply"), plain);
}

#[test]
fn wrong_byte_order_in_the_header_is_one_error() {
    let text = ["binary_little_endian", "binary_big_endian"];
    for (is_big, order) in [(true, "big-endian"), (false, "little-endian")] {
        let (stated, right) = (text[usize::from(!is_big)], text[usize::from(is_big)]);
        let header = &TRIANGLE.replace("ascii", stated)[..TRIANGLE.find("0 0 0").unwrap() + stated.len() - 5];
        let mut bytes = header.as_bytes().to_vec();
        let mut put = |mut value: [u8; 4]| {
            if is_big {
                value.reverse();
            }
            bytes.extend(value);
        };
        [0.0f32, 0.0, 0.0, 1.0, 0.0, 0.0, 0.0, 1.0, 0.0].iter().for_each(|x| put(x.to_le_bytes()));
        bytes.push(3);
        let mut put = |value: i32| bytes.extend(if is_big { value.to_be_bytes() } else { value.to_le_bytes() });
        (0..3).for_each(&mut put);
        let expected = format!(
            "2:8+{} Error: the data are {order}, but the header says `{stated}` (write `{right}` in the header)",
            stated.len()
        );
        assert_eq!(read(&bytes, "m.ply").1, [expected]);
    }
}

#[test]
fn vertex_row_with_another_number_of_values_is_named() {
    let declared = "but 3 properties are declared";
    // Reading faces as vertices causes errors later in the file.
    for count in [4, 5] {
        let expected = format!(
            "13:1+7 Error: row 4 of `vertex` has 4 numbers, {declared} (write `element vertex 3` if this row is a \
             face, or add the missing vertices)"
        );
        assert_eq!(finding("vertex 3", &format!("vertex {count}")), expected);
    }
    let fields = "(correct this row, or the properties of `vertex` in the header)";
    let expected = format!("11:1+3 Error: row 2 of `vertex` has 2 numbers, {declared} {fields}");
    assert_eq!(finding("\n1 0 0\n", "\n1 0\n"), expected);
    let expected = format!("11:1+5 Error: row 1 of `vertex` has 3 numbers, but 4 properties are declared {fields}");
    assert_eq!(finding("property float z\n", "property float z\nproperty float nx\n"), expected);
}

#[test]
fn missing_end_of_header_is_one_error() {
    let expected = "9:1+1 Error: the header has no `end_header` before the first row (add the line `end_header` \
                    before this line)";
    assert_eq!(finding("end_header\n", ""), expected);
    let expected = "9:1+10 Error: expected a header line, found `end_heeder` (did you mean `end_header`?)";
    assert_eq!(finding("end_header", "end_heeder"), expected);
}

#[test]
fn nothing_panics() {
    for bytes in [ascii(), binary(false), binary(true), TRIANGLE.as_bytes().to_vec()] {
        abuse(&bytes, "m.ply");
    }
    assert_eq!(read(b"ply\r\nformat", "m.ply").0, None::<MeshData>);
}

#[test]
fn colours_of_faces_become_colours_of_vertices() {
    let text = "ply\nformat ascii 1.0\nelement vertex 4\nproperty float x\nproperty float y\nproperty float z\nproperty float s\n\
        property float t\nelement face 2\nproperty uchar red\nproperty list uchar int vertex_indices\nproperty uchar green\n\
        property uchar blue\nend_header\n0 0 0 0 0\n1 0 0 1 0\n1 1 0 1 1\n0 1 0 0 1\n255 4 0 1 2 3 0 0\n0 3 0 1 2 0 255\n";
    let mesh = read_clean(text.as_bytes(), "a.ply");
    assert_eq!((mesh.positions.len(), mesh.triangles.len()), (9, 3));
    let color = |triangle: usize| mesh.colors[mesh.triangles[triangle][2] as usize];
    assert_eq!([color(0), color(1), color(2)], [[1.0, 0.0, 0.0, 1.0], [1.0, 0.0, 0.0, 1.0], [0.0, 0.0, 1.0, 1.0]]);
    // Texture coordinates keep their indices.
    assert_eq!((mesh.uvs.len(), mesh.triangle_uvs[1]), (4, [0, 2, 3]));
}
