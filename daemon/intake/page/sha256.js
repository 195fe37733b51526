// SHA-256 of bytes that come in pieces (FIPS 180-4), which the browser's own can't do: it takes a file only whole.

const kPrimes = [];
for (let n = 2; kPrimes.length < 64; ++n) if (kPrimes.every((prime) => n % prime !== 0)) kPrimes.push(n);

/// The first 32 bits behind the point.
const fraction = (x) => ((x - Math.floor(x)) * 2 ** 32) | 0;
const kRounds = Int32Array.from(kPrimes, (prime) => fraction(Math.cbrt(prime)));
const kStart = Int32Array.from(kPrimes.slice(0, 8), (prime) => fraction(Math.sqrt(prime)));

const kBlock = 64;

export class Sha256 {
  #state = Int32Array.from(kStart);
  #words = new Int32Array(64);
  #rest = new Uint8Array(kBlock);
  #restBytes = 0;
  #allBytes = 0;

  add(bytes) {
    this.#allBytes += bytes.length;
    let at = 0;
    if (this.#restBytes > 0) {
      at = Math.min(kBlock - this.#restBytes, bytes.length);
      this.#rest.set(bytes.subarray(0, at), this.#restBytes);
      this.#restBytes += at;
      if (this.#restBytes < kBlock) return;
      this.#block(new DataView(this.#rest.buffer), 0);
    }
    const view = new DataView(bytes.buffer, bytes.byteOffset, bytes.length);
    for (; at + kBlock <= bytes.length; at += kBlock) this.#block(view, at);
    this.#rest.set(bytes.subarray(at));
    this.#restBytes = bytes.length - at;
  }

  /// 64 digits; ends it.
  hex() {
    const bits = this.#allBytes * 8;
    const padding = new Uint8Array(((this.#restBytes < 56 ? 56 : 120) - this.#restBytes) + 8);
    padding[0] = 0x80;
    const view = new DataView(padding.buffer);
    view.setUint32(padding.length - 8, Math.floor(bits / 2 ** 32));
    view.setUint32(padding.length - 4, bits >>> 0);
    this.add(padding);
    return Array.from(this.#state, (word) => (word >>> 0).toString(16).padStart(8, "0")).join("");
  }

  #block(view, at) {
    const w = this.#words;
    for (let i = 0; i < 16; ++i) w[i] = view.getInt32(at + 4 * i);
    for (let i = 16; i < 64; ++i) {
      const x = w[i - 15];
      const y = w[i - 2];
      const s0 = ((x >>> 7) | (x << 25)) ^ ((x >>> 18) | (x << 14)) ^ (x >>> 3);
      const s1 = ((y >>> 17) | (y << 15)) ^ ((y >>> 19) | (y << 13)) ^ (y >>> 10);
      w[i] = (w[i - 16] + s0 + w[i - 7] + s1) | 0;
    }
    let [a, b, c, d, e, f, g, h] = this.#state;
    for (let i = 0; i < 64; ++i) {
      const s1 = ((e >>> 6) | (e << 26)) ^ ((e >>> 11) | (e << 21)) ^ ((e >>> 25) | (e << 7));
      const t1 = (h + s1 + ((e & f) ^ (~e & g)) + kRounds[i] + w[i]) | 0;
      const s0 = ((a >>> 2) | (a << 30)) ^ ((a >>> 13) | (a << 19)) ^ ((a >>> 22) | (a << 10));
      const t2 = (s0 + ((a & b) ^ (a & c) ^ (b & c))) | 0;
      h = g;
      g = f;
      f = e;
      e = (d + t1) | 0;
      d = c;
      c = b;
      b = a;
      a = (t1 + t2) | 0;
    }
    const s = this.#state;
    s[0] += a;
    s[1] += b;
    s[2] += c;
    s[3] += d;
    s[4] += e;
    s[5] += f;
    s[6] += g;
    s[7] += h;
  }
}

export function sha256OfText(text) {
  const sum = new Sha256();
  sum.add(new TextEncoder().encode(text));
  return sum.hex();
}

/// The checksum of a chunk in base64, by the browser's own SHA-256.
export async function checksumOf(bytes) {
  return btoa(String.fromCharCode(...new Uint8Array(await crypto.subtle.digest("SHA-256", bytes))));
}
