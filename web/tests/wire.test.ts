import { describe, expect, it } from "vitest";
import { Engine, type TransportEvents } from "../src/engine/engine";
import { libraryBuild } from "../src/engine/level";
import { decode } from "../src/engine/wire";
import type { EventMessage, RequestMessage } from "../src/protocol";

function encode(answer: EventMessage, payload: number[] = []): ArrayBuffer {
  const json = new TextEncoder().encode(JSON.stringify(answer));
  const bytes = new Uint8Array(4 + json.length + payload.length);
  new DataView(bytes.buffer).setUint32(0, json.length, true);
  bytes.set(json, 4);
  bytes.set(payload, 4 + json.length);
  return bytes.buffer;
}

describe("messages", () => {
  it("are read with their bytes", () => {
    const { answer, bytes } = decode(encode({ session: 2, id: 5, event: { kind: "saved" } }, [7, 8]));
    expect(answer).toEqual({ session: 2, id: 5, event: { kind: "saved" } });
    expect([...bytes]).toEqual([7, 8]);
  });

  it("are refused where they are cut off", () => {
    const whole = encode({ session: 1, id: 1, event: { kind: "saved" } });
    expect(() => decode(whole.slice(0, 20))).toThrow();
    expect(() => decode(new ArrayBuffer(2))).toThrow();
  });
});

describe("an engine", () => {
  it("gives each answer to who asked, and refusals as errors", async () => {
    let events: TransportEvents | undefined;
    const sent: RequestMessage[] = [];
    const engine = new Engine("test", (given) => {
      events = given;
      return { send: (ask) => sent.push(ask), close: () => {} };
    });
    const [first, second] = [engine.session(), engine.session()];
    const one = first.ask({ kind: "save", force: false }, "saved");
    const two = second.ask({ kind: "save", force: false }, "saved");
    const [a, b] = sent as [RequestMessage, RequestMessage];
    events?.message(encode({ session: b.session, id: b.id, event: { kind: "refused", why: "no file" } }));
    events?.message(encode({ session: a.session, id: a.id, event: { kind: "saved" } }));
    await expect(one).resolves.toEqual({ kind: "saved" });
    await expect(two).rejects.toThrow("no file");
  });

  it("fails all who wait once it is lost", async () => {
    let events: TransportEvents | undefined;
    const engine = new Engine("test", (given) => {
      events = given;
      return { send: () => {}, close: () => {} };
    });
    const waiting = engine.session().ask({ kind: "language" }, "language");
    events?.closed("the server has ended");
    await expect(waiting).rejects.toThrow("the server has ended");
  });
});

describe("the level of the library", () => {
  it("is SIMD where vectors are known", () => {
    expect(libraryBuild()).toBe("simd128");
  });
});
