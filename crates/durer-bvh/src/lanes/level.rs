//! Selects the SIMD level based on the processor and the environment variable `DURER_SIMD`.

use super::operations::{Kernel, Lanes};
use super::scalar;
use std::fmt;
use std::sync::OnceLock;

/// Instruction set that ray queries use for vectors with eight lanes. All levels produce the same
/// hits, bit for bit.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum SimdLevel {
    /// Code without SIMD instructions, which runs on any processor.
    Scalar,
    /// AVX2 and FMA, on x86-64.
    Avx2,
    /// AVX-512 F, VL, and DQ in addition to AVX2 and FMA, on x86-64.
    Avx512,
    /// NEON, on 64-bit ARM.
    Neon,
    /// WebAssembly's 128-bit SIMD, if the crate is compiled with `-C target-feature=+simd128`.
    Simd128,
}

/// Error from [`SimdLevel::from_environment`]: `DURER_SIMD` is not the name of a level that this
/// processor supports.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct UnsupportedSimdLevel {
    word: String,
    known: String,
}

impl fmt::Display for UnsupportedSimdLevel {
    fn fmt(&self, f: &mut fmt::Formatter) -> fmt::Result {
        write!(f, "DURER_SIMD is `{}`, but this processor supports only {}", self.word, self.known)
    }
}

impl std::error::Error for UnsupportedSimdLevel {}

impl SimdLevel {
    const ALL: [(SimdLevel, &str); 5] = [
        (SimdLevel::Scalar, "scalar"),
        (SimdLevel::Neon, "neon"),
        (SimdLevel::Simd128, "simd128"),
        (SimdLevel::Avx2, "avx2"),
        (SimdLevel::Avx512, "avx512"),
    ];

    /// Returns the levels that this processor supports. The scalar level comes first, and the best
    /// level comes last.
    pub fn available() -> impl Iterator<Item = SimdLevel> {
        Self::ALL.into_iter().map(|(level, _)| level).filter(|level| level.is_available())
    }

    /// Returns the name of the level, in the form that `DURER_SIMD` accepts.
    pub fn name(self) -> &'static str {
        Self::ALL.iter().find(|(level, _)| *level == self).map_or("", |(_, name)| name)
    }

    /// Returns the level named by the environment variable `DURER_SIMD`, or the best level if the
    /// variable is not set.
    ///
    /// # Errors
    ///
    /// Returns an error if the variable does not name a level that this processor supports.
    pub fn from_environment() -> Result<SimdLevel, UnsupportedSimdLevel> {
        let word = std::env::var("DURER_SIMD").unwrap_or_default();
        if word.is_empty() {
            return Ok(Self::best());
        }
        let known = || Self::available().map(SimdLevel::name).collect::<Vec<_>>().join(", ");
        Self::available()
            .find(|level| level.name() == word)
            .ok_or_else(|| UnsupportedSimdLevel { word, known: known() })
    }

    /// Returns the level from [`SimdLevel::from_environment`], or the best level if the variable is
    /// invalid. The variable is read only once per process.
    pub fn chosen() -> SimdLevel {
        static CHOSEN: OnceLock<SimdLevel> = OnceLock::new();
        *CHOSEN.get_or_init(|| Self::from_environment().unwrap_or_else(|_| Self::best()))
    }

    fn best() -> SimdLevel {
        Self::available().last().unwrap_or(SimdLevel::Scalar)
    }

    fn is_available(self) -> bool {
        match self {
            SimdLevel::Scalar => true,
            #[cfg(target_arch = "x86_64")]
            SimdLevel::Avx2 => super::avx2::is_available(),
            #[cfg(target_arch = "x86_64")]
            SimdLevel::Avx512 => super::avx512::is_available(),
            #[cfg(target_arch = "aarch64")]
            SimdLevel::Neon => true,
            #[cfg(all(target_arch = "wasm32", target_feature = "simd128"))]
            SimdLevel::Simd128 => true,
            #[allow(unreachable_patterns)]
            _ => false,
        }
    }
}

/// Code without SIMD operations, usually loops over arrays. It is compiled once for each SIMD level
/// so that the compiler vectorises it with the instructions of that level. Compilers do not fuse or
/// reorder operations on their own, so the results are the same, bit for bit, at all levels.
/// Functions that `run` calls should be inlined into it.
pub trait PlainKernel {
    /// Type of the kernel's result.
    type Output;

    /// Runs the kernel. Implementations should be marked `#[inline(always)]`.
    fn run(self) -> Self::Output;
}

/// Runs a [`PlainKernel`] at the chosen SIMD level.
#[inline(always)]
pub fn run_plain<K: PlainKernel>(kernel: K) -> K::Output {
    AvailableLevel::chosen().run_plain(kernel)
}

/// Adapter that runs a [`PlainKernel`] as a [`Kernel`].
struct PlainAdapter<K>(K);

impl<K: PlainKernel> Kernel for PlainAdapter<K> {
    type Output = K::Output;

    #[inline(always)]
    fn run<L: Lanes>(self, _: L) -> K::Output {
        self.0.run()
    }
}

/// A SIMD level that the processor is known to support, so that running kernels at it is safe.
#[derive(Clone, Copy, Debug)]
pub(crate) struct AvailableLevel(SimdLevel);

impl AvailableLevel {
    pub fn chosen() -> Self {
        AvailableLevel(SimdLevel::chosen())
    }

    /// Wraps `level`. If the processor does not support it, wraps the scalar level instead.
    pub fn or_scalar(level: SimdLevel) -> Self {
        AvailableLevel(if level.is_available() { level } else { SimdLevel::Scalar })
    }

    /// Runs a [`PlainKernel`] at this level.
    #[inline(always)]
    pub fn run_plain<K: PlainKernel>(self, kernel: K) -> K::Output {
        self.run(PlainAdapter(kernel))
    }

    /// Runs a kernel at this level.
    #[inline(always)]
    pub fn run<K: Kernel>(self, kernel: K) -> K::Output {
        match self.0 {
            // SAFETY: such a value exists only if the processor supports the level.
            #[cfg(target_arch = "x86_64")]
            SimdLevel::Avx512 => unsafe { super::avx512::run(kernel) },
            // SAFETY: see above.
            #[cfg(target_arch = "x86_64")]
            SimdLevel::Avx2 => unsafe { super::avx2::run(kernel) },
            #[cfg(target_arch = "aarch64")]
            SimdLevel::Neon => kernel.run(super::neon::Neon),
            #[cfg(all(target_arch = "wasm32", target_feature = "simd128"))]
            SimdLevel::Simd128 => kernel.run(super::wasm::Simd128),
            _ => plain(kernel),
        }
    }
}

/// Runs a kernel at the scalar level. This function is not inlined because its stack frame would
/// enlarge the frames of its callers.
#[inline(never)]
fn plain<K: Kernel>(kernel: K) -> K::Output {
    kernel.run(scalar::Scalar)
}
