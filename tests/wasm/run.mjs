// Runs a WebAssembly module under Node:
//   node run.mjs MODULE scalar|simd128         a hash for each part of the module of this folder
//   node run.mjs MODULE scalar|simd128 time    how long a million rays take, five times
//   node run.mjs PROGRAM                       a test program of cargo, which stops at a failure
import { readFileSync } from "node:fs";

Error.stackTraceLimit = 50; // The stack names the test that failed.
const [file, level, what] = process.argv.slice(2);
const { exports } = new WebAssembly.Instance(new WebAssembly.Module(readFileSync(file)));

if (exports.main) {
  process.exit(exports.main(0, 0));
}
if (Boolean(exports.simd128()) !== (level === "simd128")) {
  throw new Error(`${file} is not compiled for ${level}`);
}
if (what === "time") {
  exports.prepare(1_000_000);
  for (let i = 0; i < 5; i++) {
    const start = performance.now();
    const hits = exports.shoot();
    console.log(`${(performance.now() - start).toFixed(0)} ms, ${hits} hits`);
  }
} else {
  for (let part = 0; part < exports.part_count(); part++) {
    // Read before the work, which may give the memory a new buffer.
    const bytes = new Uint8Array(exports.memory.buffer, exports.name(part), exports.name_length(part));
    const name = new TextDecoder().decode(bytes);
    const hash = BigInt.asUintN(64, exports.hash(part)).toString(16).padStart(16, "0");
    console.log(`${name} ${hash}`);
  }
}
