import { Engine } from "./engine";
import { socket } from "./socket";
import { worker } from "./worker";

/** Whether a server is behind the page: it writes so into the page. */
export function hasServer(): boolean {
  return document.querySelector('meta[name="durer-server"]') !== null;
}

/** The engine behind the page. */
export function connect(): Engine {
  if (!hasServer()) return new Engine("WebAssembly", worker);
  const address = new URL("socket", location.href);
  address.protocol = address.protocol === "https:" ? "wss:" : "ws:";
  address.hash = "";
  return new Engine("native", (events) => socket(address.href, events));
}
