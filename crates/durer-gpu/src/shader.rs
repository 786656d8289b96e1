//! Shaders, joined from modules with one concern each.

use crate::layout;

/// Names and sources of modules.
macro_rules! modules {
    ($($name:literal),+ $(,)?) => {
        &[$(($name, include_str!(concat!("wgsl/", $name, ".wgsl")))),+]
    };
}

/// Compute kernel of the device.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Kernel {
    /// First hits of rays, for tests.
    Hits,
    /// Whitted ray tracing.
    Whitted,
    /// Path tracing.
    Path,
}

impl Kernel {
    /// All kernels.
    pub const ALL: [Kernel; 3] = [Kernel::Hits, Kernel::Whitted, Kernel::Path];

    /// Returns the name of the kernel's entry point.
    pub fn entry_point(self) -> &'static str {
        match self {
            Kernel::Hits => "trace_hits",
            Kernel::Whitted => "render_whitted",
            Kernel::Path => "render_path",
        }
    }

    /// Returns the names and the sources of the kernel's modules, in order.
    fn modules(self) -> &'static [(&'static str, &'static str)] {
        match self {
            Kernel::Hits => modules!["bindings", "math", "triangle", "shapes", "traverse", "hits"],
            Kernel::Whitted => modules![
                "bindings", "math", "triangle", "shapes", "traverse", "surface", "noise", "material", "media", "light",
                "whitted",
            ],
            Kernel::Path => modules![
                "bindings",
                "math",
                "random",
                "triangle",
                "shapes",
                "traverse",
                "surface",
                "noise",
                "material",
                "media",
                "light",
                "emitter",
                "ggx",
                "bsdf",
                "principled",
                "path",
            ],
        }
    }

    /// Returns the WGSL source of the kernel.
    pub fn source(self) -> String {
        let parts = self.modules().iter().map(|module| module.1.to_string());
        std::iter::once(layout::declarations()).chain(parts).collect::<Vec<_>>().join("\n")
    }
}

#[cfg(test)]
mod tests;
