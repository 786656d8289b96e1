//! Native part of `import durer`. It takes arrays that have been checked, and returns arrays and
//! JSON text. The public interface is in `python/durer`.

mod measure;
mod pictures;
mod rays;
mod surface;
mod tree;
mod words;
mod work;
mod world;

use pyo3::prelude::*;

/// Native module of `durer`, for internal use only. Its functions expect arguments that `durer` has
/// checked, and can change without notice.
#[pymodule]
fn _durer(module: &Bound<'_, PyModule>) -> PyResult<()> {
    module.add("__version__", env!("CARGO_PKG_VERSION"))?;
    module.add("SceneError", module.py().get_type::<world::SceneError>())?;
    module.add("RenderError", module.py().get_type::<world::RenderError>())?;
    module.add_class::<tree::Tree>()?;
    module.add_class::<world::World>()?;
    module.add_class::<world::Part>()?;
    module.add_function(wrap_pyfunction!(surface::hit_points, module)?)?;
    module.add_function(wrap_pyfunction!(surface::hit_normals, module)?)?;
    module.add_function(wrap_pyfunction!(surface::secondary_origins, module)?)?;
    module.add_function(wrap_pyfunction!(world::merge, module)?)?;
    module.add_function(wrap_pyfunction!(world::read_mesh, module)?)?;
    module.add_function(wrap_pyfunction!(measure::measure, module)?)?;
    module.add_function(wrap_pyfunction!(pictures::compare, module)?)?;
    module.add_function(wrap_pyfunction!(pictures::encode, module)?)?;
    module.add_function(wrap_pyfunction!(pictures::decode, module)?)?;
    module.add_function(wrap_pyfunction!(words::options, module)?)?;
    module.add_function(wrap_pyfunction!(words::command, module)?)
}
