/** A server of the files of a folder, compressed with `gzip -9`, for the tests that measure. */
import { readdirSync, readFileSync } from "node:fs";
import { createServer } from "node:http";
import { extname, join, relative } from "node:path";
import { gzipSync } from "node:zlib";

const types = {
  ".html": "text/html",
  ".js": "text/javascript",
  ".css": "text/css",
  ".wasm": "application/wasm",
  ".woff2": "font/woff2",
};

/** Serves a folder. `sent` is called with the path and the compressed length of each file. */
export async function serve(folder, sent = () => {}) {
  const packed = new Map(
    readdirSync(folder, { recursive: true, withFileTypes: true })
      .filter((entry) => entry.isFile())
      .map((entry) => {
        const path = join(entry.parentPath ?? entry.path, entry.name);
        return [`/${relative(folder, path)}`, gzipSync(readFileSync(path), { level: 9 })];
      }),
  );
  const server = createServer((request, response) => {
    const path = new URL(request.url, "http://localhost").pathname;
    const name = path === "/" ? "/index.html" : path;
    const bytes = packed.get(name);
    if (!bytes) {
      response.writeHead(404).end();
      return;
    }
    sent(name, bytes.length);
    response.writeHead(200, { "content-type": types[extname(name)], "content-encoding": "gzip" });
    response.end(bytes);
  });
  await new Promise((resolve) => server.listen(0, "127.0.0.1", resolve));
  return { address: `http://127.0.0.1:${server.address().port}/`, close: () => server.close() };
}
