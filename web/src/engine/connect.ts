import { Engine } from "./engine";
import { socket } from "./socket";
import { worker } from "./worker";

/** Returns true if a server serves the page. The server marks the page with a `meta` element. */
export function hasServer(): boolean {
  return document.querySelector('meta[name="durer-server"]') !== null;
}

/** Connects to the engine: the server if there is one, otherwise a worker. */
export function connect(): Engine {
  if (!hasServer()) return new Engine("WebAssembly", worker);
  const address = new URL("socket", location.href);
  address.protocol = address.protocol === "https:" ? "wss:" : "ws:";
  address.hash = "";
  return new Engine("native", (events) => socket(address.href, events));
}
