/** WebAssembly module with one SIMD function. It is valid only if the browser supports SIMD. */
const simdModule = Uint8Array.of(
  ...[0, 97, 115, 109, 1, 0, 0, 0, 1, 5, 1, 96, 0, 1, 123, 3, 2, 1, 0],
  ...[10, 10, 1, 8, 0, 65, 0, 253, 15, 253, 98, 11],
);

/** Returns the folder of the library build that this browser can run: with SIMD, or without. */
export function libraryBuild(): "simd128" | "scalar" {
  return WebAssembly.validate(simdModule) ? "simd128" : "scalar";
}
