import type { Event, EventMessage, Request, RequestMessage } from "../protocol";
import { decode } from "./wire";

/** Transport of messages to an engine, which is a server or a worker. */
export interface Transport {
  send(ask: RequestMessage): void;
  /** Divides the pictures of a session among several workers, if the engine has any. */
  share?(session: number): void;
  close(): void;
}

/** Callbacks of a transport. */
export interface TransportEvents {
  message(buffer: ArrayBuffer): void;
  closed(why: string): void;
}

/** Event of a given kind. */
export type EventOf<K extends Event["kind"]> = Extract<Event, { kind: K }>;
/** Callback for events and their binary payload. */
type Handler = (event: Event, bytes: Uint8Array<ArrayBuffer>) => void;

/** Request that waits for an event of a kind. */
interface PendingRequest {
  kind: Event["kind"];
  resolve(event: Event, bytes: Uint8Array<ArrayBuffer>): void;
  reject(error: Error): void;
}

/** Connection to the ray tracer, native or WebAssembly, that all sessions of the page share. */
export class Engine {
  readonly name: string;
  /** Resolves when the engine has answered for the first time. */
  readonly answered: Promise<void>;
  #transport: Transport;
  #sessions = new Map<number, Session>();
  #next = 1;
  #lost: ((why: string) => void)[] = [];

  constructor(name: string, connect: (events: TransportEvents) => Transport) {
    this.name = name;
    let answered = () => {};
    this.answered = new Promise((resolve) => {
      answered = resolve;
    });
    this.#transport = connect({
      message: (buffer) => {
        answered();
        this.#receive(buffer);
      },
      closed: (why) => {
        for (const session of this.#sessions.values()) session.fail(why);
        for (const callback of this.#lost) callback(why);
      },
    });
  }

  /** Opens a session with its own scene, camera and image. The image of a shared session is rendered
   * by several workers.
   */
  session({ shared = false } = {}): Session {
    const id = this.#next++;
    if (shared) this.#transport.share?.(id);
    const session = new Session(id, this.#transport, () => this.#sessions.delete(id));
    this.#sessions.set(id, session);
    return session;
  }

  /** Registers a callback that is called if the connection to the engine is lost. */
  onLost(callback: (why: string) => void) {
    this.#lost.push(callback);
  }

  #receive(buffer: ArrayBuffer) {
    const { answer, bytes } = decode(buffer);
    this.#sessions.get(answer.session)?.receive(answer, bytes);
  }
}

/** Session with the ray tracer: one scene with its camera and its image. */
export class Session {
  readonly id: number;
  #transport: Transport;
  #forget: () => void;
  #handlers = new Set<Handler>();
  #waiting = new Map<number, PendingRequest>();
  #next = 1;

  constructor(id: number, transport: Transport, forget: () => void) {
    this.id = id;
    this.#transport = transport;
    this.#forget = forget;
  }

  /** Sends a request without waiting for its answer. */
  send(request: Request) {
    this.#transport.send({ session: this.id, id: this.#next++, request });
  }

  /** Sends a request, and resolves with the first event of a kind that answers it. */
  ask<K extends Event["kind"]>(request: Request, kind: K): Promise<EventOf<K>> {
    return this.askBytes(request, kind).then(([event]) => event);
  }

  /** Sends a request like `ask`, and resolves with the payload as well. */
  askBytes<K extends Event["kind"]>(
    request: Request,
    kind: K,
  ): Promise<[EventOf<K>, Uint8Array<ArrayBuffer>]> {
    const id = this.#next++;
    return new Promise((resolve, reject) => {
      this.#waiting.set(id, {
        kind,
        resolve: (event, bytes) => resolve([event as EventOf<K>, bytes]),
        reject,
      });
      this.#transport.send({ session: this.id, id, request });
    });
  }

  /** Registers a handler for all events; returns a function that removes it. */
  on(handler: Handler): () => void {
    this.#handlers.add(handler);
    return () => this.#handlers.delete(handler);
  }

  receive(answer: EventMessage, bytes: Uint8Array<ArrayBuffer>) {
    const { event, id } = answer;
    const waiting = this.#waiting.get(id);
    if (waiting && event.kind === waiting.kind) {
      this.#waiting.delete(id);
      waiting.resolve(event, bytes);
    } else if (waiting && event.kind === "refused") {
      this.#waiting.delete(id);
      waiting.reject(new Error(event.why));
    }
    for (const handler of this.#handlers) handler(event, bytes);
  }

  fail(why: string) {
    for (const waiting of this.#waiting.values()) waiting.reject(new Error(why));
    this.#waiting.clear();
  }

  close() {
    this.send({ kind: "close" });
    this.#handlers.clear();
    this.#forget();
  }
}
