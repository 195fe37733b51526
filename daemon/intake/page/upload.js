// Sends the files of a model and publishes it: by tus 1.0.0 in chunks with their SHA-256, on lines that are cut too. Knows nothing of the
// page.
import { ask, askUntilAnswered, base64OfText, Cancelled, LineCut, refusalOf, sendBytes } from "./asking.js";
import { checksumOf, Sha256 } from "./sha256.js";

const kTus = { "Tus-Resumable": "1.0.0" };
const kHashPiece = 1 << 20;
const kMinChunk = 1 << 18;
const kMaxChunk = 1 << 23;
const kQuick_ms = 2_000;
const kSlow_ms = 10_000;
const kMaxConflicts = 20; // in a row: then the station contradicts itself
const kRounds = 3;

/// Paths as a manifest has them, ascending by their bytes.
function byBytes(a, b) {
  const one = new TextEncoder().encode(a.path);
  const other = new TextEncoder().encode(b.path);
  for (let i = 0; i < Math.min(one.length, other.length); ++i) if (one[i] !== other[i]) return one[i] - other[i];
  return one.length - other.length;
}

export function manifestOf(files, main) {
  const lines = [...files].sort(byBytes).map((each) => `${each.hash} ${each.file.size} ${each.path}\n`);
  return `prismesh-set 1\nmain ${main}\n${lines.join("")}`;
}

/// Whether the station could take a file of that path.
export function pathFault(path) {
  const parts = path.split("/");
  if (/[\u0000-\u001f\u007f\\]/.test(path)) return "has a control character or a backslash";
  if (!path.isWellFormed()) return "isn't well-formed text";
  if (parts.some((part) => part === "" || part === "." || part === "..")) return "has an empty part, '.' or '..'";
  if (parts.length > 32) return "has more than 32 parts";
  if (new TextEncoder().encode(path).length > 1024) return "is too long";
  return "";
}

async function bytesOf(each, begin, end) {
  try {
    return new Uint8Array(await each.file.slice(begin, end).arrayBuffer());
  } catch {
    throw new Error(`${each.path} can't be read any more; it changed or is gone. Choose the files again`);
  }
}

export class Upload {
  /// `files`: [{path, file, hash?, upload?}], with what is remembered of an earlier try. `told({files, sent, isCut, phase, path})` comes
  /// often; `remember()` when what is worth remembering changed.
  constructor({ files, main, name, told, remember }) {
    this.files = files;
    this.main = main;
    this.name = name;
    this.sentBytes = 0; // on the line, for figures
    this.#told = told;
    this.#remember = remember;
    this.#stop = new AbortController();
    for (const each of files) each.at = 0;
  }

  cancel() {
    this.#stop.abort();
  }

  /// Returns the record of the published model. Errors are sentences.
  async run() {
    await this.#hash();
    const manifest = manifestOf(this.files, this.main);
    for (let round = 0; round < kRounds; ++round) {
      const published = await this.#publish(manifest);
      if (published) return published;
      const sent = new Set();
      for (const each of this.files) {
        if (!sent.has(each.hash)) await this.#send(each);
        sent.add(each.hash);
        each.at = each.file.size;
        this.#tell("sending", each);
      }
    }
    throw new Error("the station takes the files, but doesn't publish them");
  }

  /// Takes back at the station what was sent, as far as it can be reached.
  async discard() {
    for (const each of this.files.filter((file) => file.upload))
      await ask("DELETE", each.upload, { headers: kTus, allowed: [404] }).catch(() => undefined);
  }

  #told;
  #remember;
  #stop;
  #chunk = 1 << 20;
  #isCut = false;

  #tell(phase, each) {
    this.#told({ phase, path: each?.path, isCut: this.#isCut });
  }

  async #asked(work) {
    return askUntilAnswered(
      work,
      (isCut) => {
        if (this.#isCut === isCut) return;
        this.#isCut = isCut;
        this.#tell("sending");
      },
      this.#stop.signal,
    );
  }

  async #hash() {
    for (const each of this.files) {
      const sum = new Sha256();
      for (each.hashed = 0; each.hashed < each.file.size; ) {
        const bytes = await bytesOf(each, each.hashed, each.hashed + kHashPiece);
        sum.add(bytes);
        each.hashed += bytes.length;
        this.#tell("reading", each);
        if (this.#stop.signal.aborted) throw new Cancelled();
      }
      const hash = sum.hex();
      // Another content is another upload.
      if (each.hash && each.hash !== hash) each.upload = undefined;
      each.hash = hash;
    }
    this.#remember();
  }

  /// Nothing: the station misses files.
  async #publish(manifest) {
    const headers = { "Content-Type": "application/x-prismesh-set" };
    if (this.name) headers["Prismesh-Name"] = base64OfText(this.name);
    this.#tell("publishing");
    const answer = await this.#asked(() =>
      ask("POST", "/models", { headers, body: manifest, allowed: [409], signal: this.#stop.signal }),
    );
    return answer.status === 409 ? undefined : JSON.parse(answer.text);
  }

  async #begin(each) {
    const headers = {
      ...kTus,
      "Upload-Length": String(each.file.size),
      "Upload-Metadata": `filename ${base64OfText(each.path)},sha256 ${base64OfText(each.hash)}`,
    };
    const begun = await this.#asked(() => ask("POST", "/uploads", { headers, signal: this.#stop.signal }));
    each.upload = begun.header("Location");
    this.#remember();
  }

  /// How much of an upload the station has. Nothing: it knows it no more.
  async #offset(each) {
    const shown = await this.#asked(() =>
      ask("HEAD", each.upload, { headers: kTus, allowed: [404], signal: this.#stop.signal }),
    );
    if (shown.status === 404 || Number(shown.header("Upload-Length")) !== each.file.size) return undefined;
    return Number(shown.header("Upload-Offset"));
  }

  async #send(each) {
    let at;
    let conflicts = 0;
    while (at === undefined || at < each.file.size) {
      if (at === undefined) {
        if (each.upload) at = await this.#offset(each);
        if (at === undefined) {
          await this.#begin(each);
          at = 0;
        }
        each.at = at;
        this.#tell("sending", each);
        continue;
      }
      const now = await this.#sendChunk(each, at);
      conflicts = now === undefined ? conflicts + 1 : 0;
      if (conflicts > kMaxConflicts) throw new Error("the station contradicts itself about how far the upload is");
      at = now;
    }
  }

  /// Where the upload is afterwards. Nothing: ask the station.
  async #sendChunk(each, at) {
    const bytes = await bytesOf(each, at, at + this.#chunk);
    if (bytes.length === 0) throw new Error(`${each.path} became shorter while it was sent. Choose the files again`);
    const headers = {
      ...kTus,
      "Content-Type": "application/offset+octet-stream",
      "Upload-Offset": String(at),
      "Upload-Checksum": `sha256 ${await checksumOf(bytes)}`,
    };
    const begun_ms = performance.now();
    let out = 0;
    const told = (count) => {
      out = count;
      each.at = at + Math.min(count, bytes.length);
      this.#tell("sending", each);
    };
    let answer;
    try {
      answer = await sendBytes("PATCH", each.upload, headers, bytes, told, this.#stop.signal);
    } catch (fault) {
      if (!(fault instanceof LineCut)) throw fault;
      this.#chunk = Math.max(this.#chunk / 2, kMinChunk);
      this.#isCut = true;
      each.at = at;
      this.#tell("sending", each);
      return undefined;
    } finally {
      this.sentBytes += out;
    }
    if (answer.status === 204) {
      const took_ms = performance.now() - begun_ms;
      if (took_ms < kQuick_ms) this.#chunk = Math.min(2 * this.#chunk, kMaxChunk);
      if (took_ms > kSlow_ms) this.#chunk = Math.max(this.#chunk / 2, kMinChunk);
      const now = Number(answer.header("Upload-Offset"));
      if (!(now > at)) throw new Error("the station takes a chunk, but its upload doesn't grow");
      each.at = now;
      this.#tell("sending", each);
      return now;
    }
    // Bytes of a line that was cut came later than the answer to how far the upload is; or the upload is gone; or the station is busy.
    if (answer.status === 409 || answer.status === 404) return undefined;
    if (answer.status === 429) {
      await this.#asked(() => ask("GET", "/health"));
      return undefined;
    }
    if (answer.status === 460 && at + bytes.length === each.file.size) {
      each.upload = undefined;
      this.#remember();
      throw new Error(`${each.path} changed while it was sent. Choose the files again`);
    }
    throw refusalOf(answer);
  }
}
