import type { EventMessage } from "../protocol";

/** Decoded message of the engine: an event and its binary payload. */
export interface Message {
  answer: EventMessage;
  bytes: Uint8Array<ArrayBuffer>;
}

const decoder = new TextDecoder();

/** Decodes a message: the length of its JSON, the JSON, and the payload. */
export function decode(buffer: ArrayBuffer): Message {
  if (buffer.byteLength < 4) throw new Error("message is too short");
  const length = new DataView(buffer).getUint32(0, true);
  if (4 + length > buffer.byteLength) throw new Error("message is truncated");
  const answer = JSON.parse(decoder.decode(new Uint8Array(buffer, 4, length))) as EventMessage;
  return { answer, bytes: new Uint8Array(buffer, 4 + length) };
}
