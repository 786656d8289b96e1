import type { Answer } from "../protocol";

/** An answer and the bytes that belong to it. */
export interface Message {
  answer: Answer;
  bytes: Uint8Array<ArrayBuffer>;
}

const decoder = new TextDecoder();

/** Reads a message: the length of its JSON, the JSON, and bytes. */
export function decode(buffer: ArrayBuffer): Message {
  if (buffer.byteLength < 4) throw new Error("a message is too short");
  const length = new DataView(buffer).getUint32(0, true);
  if (4 + length > buffer.byteLength) throw new Error("a message is cut off");
  const answer = JSON.parse(decoder.decode(new Uint8Array(buffer, 4, length))) as Answer;
  return { answer, bytes: new Uint8Array(buffer, 4 + length) };
}
