/** Name of the workers that help the first one. They get the library from it, compiled. */
export const helperName = "durer-helper";

/** Message that connects two workers: a helper sends the parts that it renders to the first one. */
export type PartsPort =
  | { role: "first"; port: MessagePort }
  | { role: "helper"; port: MessagePort; library: WebAssembly.Module };

/** Message from a worker: an event, the compiled library, or the reason why there is none. */
export type FromWorker = ArrayBuffer | WebAssembly.Module | string;
