/** How soon a coarse picture comes, and how many there are in a second: `node tests/measure.mjs ADDRESS [WIDTH HEIGHT]`. */
import { chromium } from "playwright-core";

const [address, width = "1280", height = "720"] = process.argv.slice(2);
const browser = await chromium.launch({
  executablePath: process.env.CHROMIUM ?? "/usr/bin/chromium",
  args: ["--no-sandbox"],
});
const page = await browser.newPage();
await page.goto(address);
const times = await page.evaluate(
  async ([width, height]) => {
    const socket = new WebSocket(new URL("socket", location.href.split("#")[0]).href.replace("http", "ws"));
    socket.binaryType = "arraybuffer";
    await new Promise((resolve) => {
      socket.onopen = resolve;
    });
    const heads = [];
    let wake = () => {};
    socket.onmessage = ({ data }) => {
      const length = new DataView(data).getUint32(0, true);
      const { event } = JSON.parse(new TextDecoder().decode(new Uint8Array(data, 4, length)));
      if (event.kind === "picture") {
        heads.push(event.head);
        wake();
      }
    };
    const picture = () =>
      new Promise((resolve) => {
        wake = resolve;
      });
    let id = 1;
    const send = (request) => socket.send(JSON.stringify({ session: 9, id: id++, request }));
    send({ kind: "size", width, height });
    send({ kind: "open", name: "", text: null });
    await picture();
    const all = [];
    const columns = [];
    for (let i = 0; i < 90; i++) {
      const start = performance.now();
      send({ kind: "move", motion: { kind: "orbit", right: 0.02, up: 0.002 }, moving: true });
      await picture();
      all.push(performance.now() - start);
      columns.push(heads.at(-1).width);
    }
    return { all: all.slice(10), columns: columns.slice(10) };
  },
  [Number(width), Number(height)],
);
await browser.close();
const sorted = [...times.all].sort((a, b) => a - b);
const at = (share) => sorted[Math.floor(share * (sorted.length - 1))].toFixed(1);
const mean = sorted.reduce((sum, x) => sum + x, 0) / sorted.length;
const middle = [...times.columns].sort((a, b) => a - b)[times.columns.length >> 1];
console.log(
  `move to coarse picture: median ${at(0.5)} ms, 95 % ${at(0.95)} ms; ${(1000 / mean).toFixed(1)} pictures a second of ${middle} columns`,
);
