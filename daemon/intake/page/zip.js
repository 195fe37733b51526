// A ZIP archive of files that are packed no further (APPNOTE.TXT 6.3.10, method 0), so that a model comes as one file.

const kTable = Uint32Array.from({ length: 256 }, (_, n) => {
  for (let bit = 0; bit < 8; ++bit) n = n & 1 ? 0xedb88320 ^ (n >>> 1) : n >>> 1;
  return n;
});

export class Crc32 {
  #sum = -1;
  add(bytes) {
    let sum = this.#sum;
    for (let i = 0; i < bytes.length; ++i) sum = kTable[(sum ^ bytes[i]) & 0xff] ^ (sum >>> 8);
    this.#sum = sum;
  }
  value() {
    return ~this.#sum >>> 0;
  }
}

/// Archives have 32-bit offsets.
export const kMaxZipBytes = 4_000_000_000;

const kUtf8Names = 1 << 11;
const kFirstOfJanuary1980 = 0x21;

function header(signature, values) {
  const bytes = new Uint8Array(4 + values.reduce((sum, [size]) => sum + size, 0));
  const view = new DataView(bytes.buffer);
  view.setUint32(0, signature, true);
  let at = 4;
  for (const [size, value] of values) {
    if (size === 2) view.setUint16(at, value, true);
    else view.setUint32(at, value, true);
    at += size;
  }
  return bytes;
}

/// `files`: [{path, blob, crc}].
export function zipOf(files) {
  const parts = [];
  const directory = [];
  let at = 0;
  let directoryBytes = 0;
  for (const { path, blob, crc } of files) {
    const name = new TextEncoder().encode(path);
    const both = [[2, 20], [2, kUtf8Names], [2, 0], [2, 0], [2, kFirstOfJanuary1980], [4, crc], [4, blob.size], [4, blob.size], [2, name.length], [2, 0]];
    const local = header(0x04034b50, both);
    const entry = header(0x02014b50, [[2, 20], ...both, [2, 0], [2, 0], [2, 0], [4, 0], [4, at]]);
    parts.push(local, name, blob);
    directory.push(entry, name);
    at += local.length + name.length + blob.size;
    directoryBytes += entry.length + name.length;
  }
  const end = header(0x06054b50, [[2, 0], [2, 0], [2, files.length], [2, files.length], [4, directoryBytes], [4, at], [2, 0]]);
  return new Blob([...parts, ...directory, end], { type: "application/zip" });
}
