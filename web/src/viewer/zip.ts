const table = Uint32Array.from({ length: 256 }, (_, n) => {
  let c = n;
  for (let k = 0; k < 8; k++) c = c & 1 ? 0xedb88320 ^ (c >>> 1) : c >>> 1;
  return c;
});

/** Returns the CRC-32 checksum of bytes, as ZIP archives need it. */
export function crc(bytes: Uint8Array): number {
  let c = 0xffffffff;
  for (const byte of bytes) c = (table[(c ^ byte) & 255] ?? 0) ^ (c >>> 8);
  return (c ^ 0xffffffff) >>> 0;
}

/** Creates a ZIP archive with uncompressed files. */
export function zip(files: { name: string; bytes: Uint8Array }[]): Uint8Array<ArrayBuffer> {
  const parts: Uint8Array[] = [];
  const directory: Uint8Array[] = [];
  let at = 0;
  for (const { name, bytes } of files) {
    const title = new TextEncoder().encode(name);
    // Version 2.0, UTF-8 names, no compression, and the date 1 January 1980.
    const common = [20, 0x0800, 0, 0, 0x21].map(short);
    const sizes = [crc(bytes), bytes.length, bytes.length].map(long);
    const lengths = [short(title.length), short(0)];
    const local = joined([long(0x04034b50), ...common, ...sizes, ...lengths, title]);
    parts.push(local, bytes);
    directory.push(
      joined([
        long(0x02014b50),
        short(20),
        ...common,
        ...sizes,
        ...lengths,
        ...[0, 0, 0].map(short),
        long(0),
        long(at),
        title,
      ]),
    );
    at += local.length + bytes.length;
  }
  const list = joined(directory);
  const end = [long(0x06054b50), short(0), short(0), short(files.length), short(files.length)];
  return joined([...parts, list, ...end, long(list.length), long(at), short(0)]);
}

function short(x: number): Uint8Array {
  return Uint8Array.of(x & 255, (x >> 8) & 255);
}

function long(x: number): Uint8Array {
  return Uint8Array.of(x & 255, (x >>> 8) & 255, (x >>> 16) & 255, x >>> 24);
}

function joined(parts: Uint8Array[]): Uint8Array<ArrayBuffer> {
  const whole = new Uint8Array(parts.reduce((sum, part) => sum + part.length, 0));
  let at = 0;
  for (const part of parts) {
    whole.set(part, at);
    at += part.length;
  }
  return whole;
}
