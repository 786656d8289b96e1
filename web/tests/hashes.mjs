/**
 * The same bits: hashes of the library as WebAssembly, under Node, beside those of the command.
 *
 *     [LEVEL=scalar] node tests/hashes.mjs PLAYGROUND COMMAND [SCENES...]
 */
import { execFileSync } from "node:child_process";
import { existsSync, readdirSync, readFileSync } from "node:fs";
import { join, resolve } from "node:path";
import { pathToFileURL } from "node:url";

const [playground, command, ...wanted] = process.argv.slice(2);
const module = resolve(playground, "wasm", process.env.LEVEL ?? "simd128");
const wasm = await import(pathToFileURL(join(module, "durer_wasm.js")).href);
await wasm.default({ module_or_path: readFileSync(join(module, "durer_wasm_bg.wasm")) });

const folder = resolve(import.meta.dirname, "../../scenes");
const some = [
  "sphere",
  "whitted",
  "transforms",
  "mirrors",
  "glass",
  "marble",
  "solid-textures",
  "fisheye",
  "orthographic",
  "lens",
  "stereo",
  "cornell-box",
  "caustic",
  "fog",
  "prism",
  "smooth-mesh",
  "highlights",
  "primitives",
  "perspective",
  "cylindrical",
];
const scenes = wanted.length > 0 ? wanted : some.map((name) => `${name}.txt`);
const jobs = [[], ["--integrator", "path"], ["--integrator", "ao"]];

/** Answers of an engine to some requests, and what comes until it rests. */
function ask(engine, requests) {
  const answers = [];
  const hear = (bytes) => {
    const length = new DataView(bytes.buffer).getUint32(0, true);
    answers.push(JSON.parse(new TextDecoder().decode(bytes.subarray(4, 4 + length))).event);
  };
  for (const request of requests) engine.receive(JSON.stringify({ session: 1, id: 1, request }), hear);
  while (engine.step(hear));
  return answers;
}

/** The files that a text names. */
function named(text) {
  const words = new Set(text.split(/[\s{}"]+/));
  return [...words].filter(
    (word) => /[./]/.test(word) && existsSync(join(folder, word)) && !word.endsWith("/"),
  );
}

let failed = 0;
for (const [i, scene] of scenes.entries()) {
  const text = readFileSync(join(folder, scene), "utf8");
  const job = jobs[i % jobs.length];
  const options = [{ name: "samples", value: "2" }];
  if (job.length > 0) options.push({ name: "integrator", value: job[1] });
  const files = named(text).flatMap((name) => {
    try {
      return [
        { kind: "give", name, base64: readFileSync(join(folder, name)).toString("base64"), opens: false },
      ];
    } catch {
      return readdirSync(join(folder, name)).map((inner) => ({
        kind: "give",
        name: `${name}/${inner}`,
        base64: readFileSync(join(folder, name, inner)).toString("base64"),
        opens: false,
      }));
    }
  });
  const start = performance.now();
  const answers = ask(new wasm.Engine(), [
    ...files,
    { kind: "size", width: 96, height: 72 },
    { kind: "options", options },
    { kind: "open", name: scene, text },
  ]);
  const ms = performance.now() - start;
  const here = answers.findLast((event) => event.kind === "picture")?.head.hash;
  const arguments_ = [
    "render",
    join(folder, scene),
    "--quiet",
    "--hash",
    "--size",
    "96x72",
    "--samples",
    "2",
    "-o",
    "/tmp/durer-hash.png",
    ...job,
  ];
  const there = execFileSync(command, arguments_, { encoding: "utf8" }).trim().split("\n").at(-1);
  const same = here === there;
  if (!same) failed++;
  const why = answers.filter((event) => event.kind === "refused").map((event) => event.why)[0] ?? "";
  console.log(
    `${same ? "ok     " : "FAILED "} ${scene} ${job.join(" ")} ${String(here).slice(0, 16)} ${Math.round(ms)} ms ${same ? "" : `${there} ${why}`}`,
  );
}
process.exit(failed === 0 ? 0 : 1);
