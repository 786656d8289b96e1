//! Measures how fast other crates read mesh files from memory. It is started by `cargo xtask
//! bench-files`.

use std::time::{Duration, Instant};

fn main() {
    let mut arguments = std::env::args().skip(1);
    let runs: u32 = arguments.next().and_then(|runs| runs.parse().ok()).expect("how many times");
    for path in arguments {
        let bytes = std::fs::read(&path).expect("a file");
        let (name, read): (&str, fn(&[u8]) -> usize) = match path.rsplit('.').next() {
            Some("obj") => ("tobj", obj),
            Some("ply") => ("ply-rs-bw", ply),
            Some("glb") => ("gltf", glb),
            _ => continue,
        };
        let (mut least, mut triangles) = (Duration::MAX, 0);
        for _ in 0..runs {
            let start = Instant::now();
            triangles = read(&bytes);
            least = least.min(start.elapsed());
        }
        println!("{path}\t{name}\t{}\t{triangles}", least.as_secs_f64());
    }
}

fn obj(mut bytes: &[u8]) -> usize {
    let options = tobj::LoadOptions { triangulate: true, ..Default::default() };
    let none = |_: &std::path::Path| tobj::MTLLoadResult::Ok(Default::default());
    let (models, _) = tobj::load_obj_buf(&mut bytes, &options, none).expect("an OBJ file");
    models.iter().map(|model| model.mesh.indices.len() / 3).sum()
}

fn ply(mut bytes: &[u8]) -> usize {
    let parser = ply_rs_bw::parser::Parser::<ply_rs_bw::ply::DefaultElement>::new();
    let ply = parser.read_ply(&mut bytes).expect("a PLY file");
    ply.payload["face"].len()
}

fn glb(bytes: &[u8]) -> usize {
    let (document, buffers, _) = gltf::import_slice(bytes).expect("a glTF file");
    let mut count = 0;
    for primitive in document.meshes().flat_map(|mesh| mesh.primitives().collect::<Vec<_>>()) {
        let reader = primitive.reader(|buffer| buffers.get(buffer.index()).map(|data| data.0.as_slice()));
        let positions: Vec<[f32; 3]> = reader.read_positions().expect("positions").collect();
        let indices: Vec<u32> = reader.read_indices().expect("indices").into_u32().collect();
        assert!(!positions.is_empty());
        count += indices.len() / 3;
    }
    count
}
