import type { RequestMessage } from "../protocol";
import type { Transport, TransportEvents } from "./engine";

/** Transport to a worker that runs the library as WebAssembly. */
export function worker(events: TransportEvents): Transport {
  const worker = new Worker(new URL("./wasm-worker.ts", import.meta.url), { type: "module", name: "durer" });
  worker.onmessage = ({ data }: MessageEvent<ArrayBuffer | string>) => {
    if (typeof data === "string") events.closed(data);
    else events.message(data);
  };
  worker.onerror = (error) => events.closed(error.message || "the worker has stopped");
  return {
    send: (ask: RequestMessage) => worker.postMessage(JSON.stringify(ask)),
    close: () => worker.terminate(),
  };
}
