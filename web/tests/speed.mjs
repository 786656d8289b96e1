/**
 * The time of the command divided by that of WebAssembly in Chromium, both with one thread and with
 * loading, medians of five runs that alternate:
 *
 *     node tests/speed.mjs PLAYGROUND COMMAND [SCENES...]
 */
import { execFileSync } from "node:child_process";
import { existsSync, readFileSync } from "node:fs";
import { tmpdir } from "node:os";
import { join, resolve } from "node:path";
import { chromium } from "playwright-core";
import { serve } from "./serve.mjs";

const [playground, command, ...wanted] = process.argv.slice(2);
const usual = ["whitted.txt", "mirrors.txt", "glass.txt", "cornell-box.txt", "smooth-mesh.txt"];
const scenes = wanted.length > 0 ? wanted : usual;
const [width, height, samples, runs] = [240, 180, "32", 5];
const folder = resolve(import.meta.dirname, "../../scenes");

const server = await serve(playground);
const browser = await chromium.launch({
  executablePath: process.env.CHROMIUM ?? "/usr/bin/chromium",
  args: ["--no-sandbox"],
});
const page = await browser.newPage();
await page.route("**/empty.html", (route) => route.fulfill({ contentType: "text/html", body: "" }));
await page.goto(`${server.address}empty.html`);
await page.evaluate(async () => {
  window.wasm = await import("/wasm/simd128/durer_wasm.js");
  await window.wasm.default({ module_or_path: "/wasm/simd128/durer_wasm_bg.wasm" });
});

/** Renders a scene in the page. Returns the hash of the film and the time in milliseconds. */
function inPage(requests) {
  return page.evaluate((requests) => {
    let hash;
    const hear = (bytes) => {
      const length = new DataView(bytes.buffer).getUint32(0, true);
      const { event } = JSON.parse(new TextDecoder().decode(bytes.subarray(4, 4 + length)));
      if (event.kind === "picture") hash = event.head.hash;
    };
    const engine = new window.wasm.Engine();
    const begin = performance.now();
    for (const request of requests) engine.receive(JSON.stringify({ session: 1, id: 1, request }), hear);
    while (engine.step(hear));
    const time = performance.now() - begin;
    engine.free();
    return [hash, time];
  }, requests);
}

/** Renders a scene with the command. Returns the hash of the film and the time in milliseconds. */
function natively(scene) {
  const output = join(tmpdir(), "durer-speed.png");
  const options = [
    "--size",
    `${width}x${height}`,
    "--samples",
    samples,
    "--threads",
    "1",
    "--hash",
    "--quiet",
  ];
  const begin = performance.now();
  const text = execFileSync(command, ["render", scene, "-o", output, ...options], { encoding: "utf8" });
  return [text.trim().split("\n").at(-1), performance.now() - begin];
}

const median = (times) => [...times].sort((a, b) => a - b)[Math.floor(times.length / 2)];
let failed = 0;
for (const scene of scenes) {
  const text = readFileSync(join(folder, scene), "utf8");
  const files = [...new Set(text.split(/[\s{}"]+/))]
    .filter((word) => /\w\.\w/.test(word) && existsSync(join(folder, word)))
    .map((name) => {
      const base64 = readFileSync(join(folder, name)).toString("base64");
      return { kind: "give", name, base64, opens: false };
    });
  const requests = [
    ...files,
    { kind: "size", width, height },
    { kind: "options", options: [{ name: "samples", value: samples }] },
    { kind: "open", name: scene, text },
  ];
  const times = [[], []];
  for (let i = 0; i < runs; i++) {
    const [here, there] = [await inPage(requests), natively(join(folder, scene))];
    if (here[0] !== there[0]) failed++;
    times[0].push(there[1]);
    times[1].push(here[1]);
  }
  const [native, wasm] = times.map(median);
  console.log(
    `${scene}: ${Math.round(native)} ms, ${Math.round(wasm)} ms, ratio ${(native / wasm).toFixed(2)}`,
  );
}
await browser.close();
server.close();
if (failed > 0) console.log(`the hashes differ in ${failed} runs`);
process.exit(failed === 0 ? 0 : 1);
