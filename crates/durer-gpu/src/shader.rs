//! Shaders, joined from modules with one concern each.

use crate::layout;

macro_rules! modules {
    ($($name:literal),+) => {
        [$(($name, include_str!(concat!("wgsl/", $name, ".wgsl")))),+]
    };
}

const MODULES: [(&str, &str); 18] = modules![
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
    "hits",
    "whitted",
    "path"
];

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

    /// Returns the names of the kernel's modules, in order.
    fn modules(self) -> &'static [&'static str] {
        match self {
            Kernel::Hits => &["bindings", "math", "triangle", "shapes", "traverse", "hits"],
            Kernel::Whitted => &[
                "bindings", "math", "triangle", "shapes", "traverse", "surface", "noise", "material", "media", "light",
                "whitted",
            ],
            Kernel::Path => &[
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
        let text = |name: &&str| MODULES.iter().find(|module| module.0 == *name).map_or("", |module| module.1);
        let parts = self.modules().iter().map(text);
        std::iter::once(layout::declarations()).chain(parts.map(String::from)).collect::<Vec<_>>().join("\n")
    }
}

#[cfg(test)]
mod tests;
