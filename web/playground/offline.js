/** Keeps the page for times without a network: what was once fetched is answered from memory where the network fails. */
const name = "durer";
/** The folder of the library that this browser runs. */
const level = new URL(self.location.href).searchParams.get("level");
const files = [
  "./",
  "index.html",
  "index.js",
  "index.css",
  "lecture-page.js",
  "wasm-worker.js",
  "inter-latin-wght-normal.woff2",
  "inter-latin-ext-wght-normal.woff2",
  "inter-greek-wght-normal.woff2",
  `wasm/${level}/durer_wasm.js`,
  `wasm/${level}/durer_wasm_bg.wasm`,
];

self.addEventListener("install", (event) => {
  event.waitUntil(caches.open(name).then((cache) => cache.addAll(files)));
  self.skipWaiting();
});

self.addEventListener("activate", (event) => event.waitUntil(self.clients.claim()));

self.addEventListener("fetch", (event) => {
  if (event.request.method !== "GET") return;
  const answer = async () => {
    const cache = await caches.open(name);
    try {
      const fresh = await fetch(event.request);
      if (fresh.ok) await cache.put(event.request, fresh.clone());
      return fresh;
    } catch {
      return (await cache.match(event.request, { ignoreSearch: true })) ?? Response.error();
    }
  };
  event.respondWith(answer());
});
