//! Runs the examples, which check their own results with assertions.

macro_rules! examples {
    ($($name:ident: $file:literal)*) => {$(
        #[allow(dead_code)]
        #[path = $file]
        mod $name;

        #[test]
        fn $name() {
            $name::main().unwrap();
        }
    )*};
}

examples! {
    render_file: "../../examples/render_file.rs"
    build_scene: "../../examples/build_scene.rs"
    ray_query: "../../examples/ray_query.rs"
    mesh_query: "../../examples/mesh_query.rs"
    progress_and_cancel: "../../examples/progress_and_cancel.rs"
    explain_pixel: "../../examples/explain_pixel.rs"
    check_scene: "../../examples/check_scene.rs"
}
