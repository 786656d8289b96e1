//! Tests of all mesh formats, and helpers that the tests of each format use.

use super::*;
use durer_diag::{Files, Severity};
use durer_scene::math::random::Random;
use std::path::{Path, PathBuf};
use std::time::Instant;

/// Reads bytes as if they were a file with the given name. Returns the diagnostics in the form
/// `line:column severity: message`.
pub(super) fn read(bytes: &[u8], name: &str) -> (Option<MeshData>, Vec<String>) {
    let mut files = Files::default();
    let file = files.add(name, bytes.into());
    let mut diagnostics = Diagnostics::default();
    let mesh = read_mesh(bytes, file, name, &mut diagnostics);
    let line = |d: &Diagnostic| {
        let place = d.span.map_or("-".into(), |span| {
            assert!(span.start <= span.end && span.end as usize <= bytes.len(), "{d:?}");
            let (line, column) = files.position(span).unwrap();
            format!("{line}:{column}+{}", span.end - span.start)
        });
        let help = d.help.as_ref().map_or(String::new(), |help| format!(" ({help})"));
        format!("{place} {:?}: {}{help}", d.severity, d.message)
    };
    assert_eq!(mesh.is_none(), diagnostics.has_errors());
    (mesh, diagnostics.iter().map(line).collect())
}

/// Reads a file that must not cause any diagnostics.
pub(super) fn read_clean(bytes: &[u8], name: &str) -> MeshData {
    let (mesh, findings) = read(bytes, name);
    assert_eq!(findings, [""; 0], "{name}");
    mesh.unwrap()
}

/// Reads all prefixes of a file, and randomly changed copies of it, to check that no reader panics.
pub(super) fn abuse(bytes: &[u8], name: &str) {
    let try_it = |bytes: &[u8]| {
        if let Some(mesh) = read(bytes, name).0 {
            check_indices(&mesh);
        }
    };
    (0..bytes.len()).for_each(|end| try_it(&bytes[..end]));
    let mut numbers = Random(7);
    let mut random = |below| numbers.below(below);
    for _ in 0..3000 {
        let mut changed = bytes.to_vec();
        for _ in 0..1 + random(3) {
            let at = random(changed.len());
            match random(3) {
                0 => changed[at] ^= 1 << random(8),
                1 => changed[at] = random(256) as u8,
                // Bytes from elsewhere in the file produce realistic errors.
                _ => changed[at] = changed[random(changed.len())],
            }
        }
        try_it(&changed);
    }
}

fn check_indices(mesh: &MeshData) {
    let below = |list: &[[u32; 3]], count: usize, optional: bool| {
        list.iter().flatten().all(|&i| (i as usize) < count || optional && i == durer_scene::shape::mesh::NO_INDEX)
    };
    assert!(below(&mesh.triangles, mesh.positions.len(), false));
    for (list, count) in [(&mesh.triangle_uvs, mesh.uvs.len()), (&mesh.triangle_normals, mesh.normals.len())] {
        assert!(below(list, count, true));
        assert!(list.is_empty() || list.len() == mesh.triangles.len());
    }
    assert!(mesh.positions.iter().chain(&mesh.normals).all(|p| p.is_finite()));
    assert!(mesh.uvs.iter().all(|uv| uv.is_finite()));
}

#[test]
fn format_follows_from_name_or_content() {
    let obj = b"# a triangle\nv 0 0 0\nv 1 0 0\nv 0 1 0\nf 1 2 3\n";
    let ply = b"ply\nformat ascii 1.0\nelement vertex 3\nproperty float x\nproperty float y\nproperty float z\n\
        element face 1\nproperty list uchar int vertex_index\nend_header\n0 0 0\n1 0 0\n0 1 0\n3 0 1 2\n";
    let expected = read_clean(obj, "dir.ply/A.OBJ");
    for name in ["mesh", "mesh.bin", "", "dir.obj/mesh", "C:\\a.obj\\mesh"] {
        assert_eq!(read_clean(obj, name), expected);
        assert_eq!(read_clean(ply, name), expected);
    }
    assert!(read(obj, "mesh.ply").1[0].contains("expected `ply`"));
    let known = "known formats are PLY (.ply), Wavefront OBJ (.obj), STL (.stl), OFF (.off)";
    assert_eq!(read(b"?", "m").1, [format!("- Error: `m` is not a mesh file of a known format ({known})")]);
    assert!(read(b"?", "m.objj").1[0].contains("did you mean `.obj`? Known formats are"));
    assert!(too_large(u32::MAX as u64, "big.obj").unwrap().message.contains("4294967295 bytes"));
    assert!(too_large(1 << 20, "small.obj").is_none());
    for format in MESH_FORMATS {
        assert!(!(format.recognise)(b"") && format.extensions.iter().all(|e| *e == e.to_lowercase()));
    }
}

#[test]
fn errors_are_limited_and_full_diagnostics_stop_reading() {
    let many = "v x\n".repeat(100);
    let (_, findings) = read(many.as_bytes(), "m.obj");
    assert_eq!(findings.len(), durer_diag::ERROR_LIMIT);
    let mut diagnostics = Diagnostics::default();
    (0..durer_diag::ERROR_LIMIT).for_each(|_| diagnostics.push(Diagnostic::error("before")));
    assert_eq!(read_mesh(b"v 0 0 0", 0, "m.obj", &mut diagnostics), None);
    assert_eq!(diagnostics.error_count(), durer_diag::ERROR_LIMIT);
    // Errors in other files do not affect this one.
    let mut diagnostics = Diagnostics::default();
    diagnostics.push(Diagnostic::error("before"));
    assert!(read_mesh(b"v 0 0 0", 0, "m.obj", &mut diagnostics).is_some());
}

/// Collects all files below a folder that have the given extension.
fn files_below(folder: &Path, extension: &str, found: &mut Vec<PathBuf>) {
    let Ok(entries) = std::fs::read_dir(folder) else { return };
    for path in entries.flatten().map(|entry| entry.path()) {
        match path.is_dir() {
            true => files_below(&path, extension, found),
            false if path.extension().is_some_and(|e| e == extension) => found.push(path),
            false => {}
        }
    }
}

#[test]
fn corpus_has_no_findings() {
    let default = || Path::new(env!("CARGO_MANIFEST_DIR")).join("../../../shared");
    let corpus = std::env::var_os("DURER_CORPUS").map_or_else(default, PathBuf::from);
    let mut paths = Vec::new();
    files_below(&corpus.join("meshes"), "ply", &mut paths);
    files_below(&corpus.join("course/scenes"), "obj", &mut paths);
    if paths.is_empty() {
        println!("skipped: no corpus in {}", corpus.display());
    }
    paths.sort();
    for path in paths {
        let bytes = std::fs::read(&path).unwrap();
        let name = path.file_name().unwrap().to_string_lossy().into_owned();
        let start = Instant::now();
        let mut diagnostics = Diagnostics::default();
        let mesh = read_mesh(&bytes, 0, &name, &mut diagnostics).expect(&name);
        let time = start.elapsed();
        assert_eq!(diagnostics.iter().filter(|d| d.severity >= Severity::Note).count(), 0, "{diagnostics:?}");
        check_indices(&mesh);
        assert!(!mesh.triangles.is_empty());
        let (vertices, triangles) = (mesh.positions.len(), mesh.triangles.len());
        println!("{name:20} {:9} bytes {vertices:7} vertices {triangles:7} triangles {time:9.2?}", bytes.len());
    }
}
