import type { Request, RequestMessage } from "../protocol";
import type { Transport, TransportEvents } from "./engine";
import { type FromWorker, helperName, type PartsPort } from "./worker-messages";

/** Maximum number of workers that share a picture. Each one holds the scene in its own memory. */
const maxWorkers = 8;

function start(name: string): Worker {
  return new Worker(new URL("./wasm-worker.ts", import.meta.url), { type: "module", name });
}

/**
 * Transport to workers that run the library as WebAssembly. The first worker answers all requests.
 * The pictures of shared sessions are divided among it and helpers, which receive the same requests.
 */
export function worker(events: TransportEvents): Transport {
  const first = start("durer");
  const shared = new Set<number>();
  let helpers: Worker[] = [];
  let library: WebAssembly.Module | null = null;
  first.onmessage = ({ data }: MessageEvent<FromWorker>) => {
    if (typeof data === "string") events.closed(data);
    else if (data instanceof ArrayBuffer) events.message(data);
    else {
      for (const helper of helpers) join(helper, data);
      library = data;
    }
  };
  first.onerror = (error) => events.closed(error.message || "the worker has stopped");

  const post = (worker: Worker, ask: RequestMessage) => worker.postMessage(JSON.stringify(ask));
  const tell = (worker: Worker, session: number, request: Request) =>
    post(worker, { session, id: 0, request });
  /** Stops the helpers, so that the first worker renders alone. */
  const stopHelpers = () => {
    for (const helper of helpers) helper.terminate();
    helpers = [];
    for (const session of shared) tell(first, session, { kind: "share", index: 1, count: 1 });
    shared.clear();
  };
  /** Lets a helper start, which keeps the messages that it received before. */
  const join = (helper: Worker, library: WebAssembly.Module) => {
    const { port1, port2 } = new MessageChannel();
    helper.postMessage({ role: "helper", port: port1, library } satisfies PartsPort, [port1]);
    first.postMessage({ role: "first", port: port2 } satisfies PartsPort, [port2]);
  };
  const startHelper = () => {
    const helper = start(helperName);
    // A helper posts a message only if it cannot load the library.
    helper.onmessage = stopHelpers;
    helper.onerror = stopHelpers;
    helpers.push(helper);
    if (library) join(helper, library);
  };
  return {
    share(session) {
      const count = Math.min(maxWorkers, navigator.hardwareConcurrency || 1);
      while (helpers.length < count - 1) startHelper();
      shared.add(session);
      [first, ...helpers].forEach((worker, i) => {
        tell(worker, session, { kind: "share", index: i + 1, count });
      });
    },
    send(ask) {
      post(first, ask);
      if (shared.has(ask.session)) for (const helper of helpers) post(helper, ask);
      if (ask.request.kind === "close") shared.delete(ask.session);
    },
    close() {
      first.terminate();
      for (const helper of helpers) helper.terminate();
    },
  };
}
