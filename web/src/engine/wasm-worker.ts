import { level } from "./level";

/** Code of the worker: runs the library as WebAssembly in small steps, and handles messages in between.
 */

interface Wasm {
  default(source: { module_or_path: URL }): Promise<unknown>;
  Engine: new () => {
    receive(text: string, send: (bytes: Uint8Array<ArrayBuffer>) => void): void;
    step(send: (bytes: Uint8Array<ArrayBuffer>) => void): boolean;
  };
}

const early: string[] = [];
let receive = (text: string) => {
  early.push(text);
};
self.onmessage = (message: MessageEvent<string>) => receive(message.data);

function send(bytes: Uint8Array<ArrayBuffer>) {
  self.postMessage(bytes.buffer, { transfer: [bytes.buffer] });
}

async function start() {
  const script = new URL(`./wasm/${level()}/durer_wasm.js`, self.location.href);
  const wasm = (await import(/* @vite-ignore */ script.href)) as Wasm;
  await wasm.default({ module_or_path: new URL("./durer_wasm_bg.wasm", script) });
  const engine = new wasm.Engine();
  const turns = new MessageChannel();
  let busy = false;
  const turn = () => {
    busy = engine.step(send);
    if (busy) turns.port2.postMessage(null);
  };
  turns.port1.onmessage = turn;
  receive = (text) => {
    engine.receive(text, send);
    if (!busy) {
      busy = true;
      turns.port2.postMessage(null);
    }
  };
  for (const text of early) receive(text);
}

start().catch((error: unknown) => self.postMessage(`cannot load the library: ${error}`));
