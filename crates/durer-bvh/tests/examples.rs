//! Runs the examples. Each of them asserts its own result.

macro_rules! examples {
    ($($name:ident: $file:literal)*) => {$(
        #[allow(dead_code)]
        #[path = $file]
        mod $name;

        #[test]
        fn $name() {
            ExampleResult::ended($name::main());
        }
    )*};
}

/// Return type of the `main` function of an example, which is `()` or `Result`, to check that the
/// example succeeded.
trait ExampleResult {
    fn ended(self);
}

impl ExampleResult for () {
    fn ended(self) {}
}

impl<E: std::fmt::Debug> ExampleResult for Result<(), E> {
    fn ended(self) {
        self.unwrap();
    }
}

examples! {
    ray_query: "../examples/ray_query.rs"
    instances: "../examples/instances.rs"
    closest_point: "../examples/closest_point.rs"
    custom_primitive: "../examples/custom_primitive.rs"
}

#[test]
fn trees_are_send_and_sync() {
    fn is_shared<T: Send + Sync + Clone + std::fmt::Debug>() {}
    is_shared::<durer_bvh::TriangleBvh>();
    is_shared::<durer_bvh::InstanceBvh>();
    is_shared::<durer_bvh::Bvh>();
    is_shared::<durer_bvh::Grid>();
    is_shared::<durer_bvh::BuildError>();
    is_shared::<durer_bvh::LoadError>();
}
