//! Tests of valid and malformed STL files, text and binary.

use crate::tests::{abuse, read, read_clean};
use durer_scene::math::Vec3;

const TEXT: &str = "solid a name\n  facet normal 0 0 1\n    outer loop\n      vertex 0 0 0\n      vertex 1 0 0\n      \
    vertex 0 1 0\n    endloop\n  endfacet\n  FACET NORMAL 0 0 1\n OUTER LOOP\nVERTEX 1 0 0\nVERTEX 1 1 0\nVERTEX 0 1 0\n\
    ENDLOOP\nENDFACET\nendsolid a name\n";

fn binary(head: &[u8], facets: &[[[f32; 3]; 3]]) -> Vec<u8> {
    let mut bytes = head.to_vec();
    bytes.resize(80, b' ');
    bytes.extend((facets.len() as u32).to_le_bytes());
    for facet in facets {
        bytes.extend([0; 12]);
        facet.iter().flatten().for_each(|x| bytes.extend(x.to_le_bytes()));
        bytes.extend([0; 2]);
    }
    bytes
}

const SQUARE: [[[f32; 3]; 3]; 2] =
    [[[0.0; 3], [1.0, 0.0, 0.0], [0.0, 1.0, 0.0]], [[1.0, 0.0, 0.0], [1.0, 1.0, 0.0], [0.0, 1.0, 0.0]]];

#[test]
fn text_and_binary_are_equivalent_and_share_corners() {
    let text = read_clean(TEXT.as_bytes(), "a.stl");
    assert_eq!(text.positions, [Vec3::ZERO, Vec3::X, Vec3::Y, Vec3::X + Vec3::Y]);
    assert_eq!(text.triangles, [[0, 1, 2], [1, 3, 2]]);
    // A binary file can begin like a text file.
    for head in [&b"made by a program"[..], b"solid facet"] {
        assert_eq!(read_clean(&binary(head, &SQUARE), "a.stl"), text);
        assert_eq!(read_clean(&binary(head, &SQUARE), "no ending"), text);
    }
    assert_eq!(read_clean(TEXT.replace('\n', "\r\n").as_bytes(), "?"), text);
}

#[test]
fn errors_have_positions() {
    let first = |bytes: &[u8]| read(bytes, "a.stl").1[0].clone();
    assert!(first(b"").contains("at least 84 bytes"));
    let mut short = binary(b"", &SQUARE);
    short.truncate(140);
    assert!(first(&short).contains("declares 2 facets, but the file ends after 1 facet"));
    let mut long = binary(b"", &SQUARE);
    long.extend(b"tail");
    assert!(first(&long).contains("Warning: ignored 4 bytes"));
    let infinite = [[[f32::INFINITY; 3], [0.0; 3], [1.0; 3]]];
    assert!(first(&binary(b"", &infinite)).contains("facet 1 has a vertex with an infinite coordinate or NaN"));
    let wrong = TEXT.replace("vertex 1 0 0\n", "vertex 1 0 x\n");
    assert_eq!(first(wrong.as_bytes()), "5:18+1 Error: expected a number, found `x`");
    let missing = TEXT.replace("VERTEX 1 1 0\n", "");
    assert!(first(missing.as_bytes()).contains("a facet needs 3 vertices, found 2"));
    // A file that was cut is incomplete, wherever it ends.
    let cut = |word: &str| first(&TEXT.as_bytes()[..TEXT.rfind(word).unwrap()]);
    let message = "Error: the file ends inside this facet, because `endfacet` is missing";
    assert!(cut("ENDFACET").starts_with(&format!("9:3+5 {message}")), "{}", cut("ENDFACET"));
    assert!(cut("ENDLOOP").starts_with(&format!("9:3+5 {message}")), "{}", cut("ENDLOOP"));
    assert!(cut("VERTEX 0").starts_with("9:3+5 Error: a facet needs 3 vertices, found 2"), "{}", cut("VERTEX 0"));
    assert_eq!(cut("endsolid"), "1:1+5 Warning: the file ends without `endsolid`, so facets may be missing");
    let odd = TEXT.replace("outer loop", "inner loop");
    assert!(first(odd.as_bytes()).starts_with("3:5+5 Error: expected `facet`"));
    assert!(first(b"solid nothing\nendsolid\n").contains("no triangles"));
}

#[test]
fn nothing_panics() {
    abuse(TEXT.as_bytes(), "a.stl");
    abuse(&binary(b"", &SQUARE), "a.stl");
}
