// Fetches a model with its includes: goes on after a cut line, compares every file's SHA-256, and gives the browser one file to save.
import { ask, askUntilAnswered, LineCut, refusalOf } from "./asking.js";
import { sizeText } from "./elements.js";
import { Sha256 } from "./sha256.js";
import { Crc32, kMaxZipBytes, zipOf } from "./zip.js";

const kMaxCuts = 200;

class Fetched {
  parts = [];
  bytes = 0;
  sum = new Sha256();
  crc = new Crc32();
  add(piece) {
    this.parts.push(piece);
    this.bytes += piece.length;
    this.sum.add(piece);
    this.crc.add(piece);
  }
}

/// Reads on from where `fetched` ends. Throws LineCut where the line is cut; what came is kept.
async function readOn(url, file, fetched, told) {
  const headers = fetched.bytes > 0 ? { Range: `bytes=${fetched.bytes}-`, "If-Range": `"${file.sha256}"` } : {};
  let answer;
  try {
    answer = await fetch(url, { headers, cache: "no-store" });
  } catch {
    throw new LineCut();
  }
  if (answer.status !== (fetched.bytes > 0 ? 206 : 200))
    throw refusalOf({ status: answer.status, text: await answer.text().catch(() => ""), header: (name) => answer.headers.get(name) });
  const reader = answer.body.getReader();
  for (;;) {
    let piece;
    try {
      piece = await reader.read();
    } catch {
      throw new LineCut();
    }
    if (piece.done) break;
    fetched.add(piece.value);
    told(fetched.bytes);
  }
  if (fetched.bytes < file.bytes) throw new LineCut();
}

async function fetchFile(url, file, told) {
  const fetched = new Fetched();
  let cuts = 0;
  if (file.bytes > 0)
    await askUntilAnswered(
      () => readOn(url, file, fetched, told),
      (isCut) => {
        // A damaged file's last piece never comes.
        if (isCut && ++cuts > kMaxCuts) throw new Error(`${file.path} doesn't come whole`);
      },
    );
  if (fetched.sum.hex() !== file.sha256) throw new Error(`${file.path} isn't as it was sent`);
  return { path: file.path, blob: new Blob(fetched.parts), crc: fetched.crc.value() };
}

function save(blob, name) {
  const link = document.createElement("a");
  link.href = URL.createObjectURL(blob);
  link.download = name;
  link.click();
  setTimeout(() => URL.revokeObjectURL(link.href), 60_000);
}

const asFileName = (name) => name.replace(/[/\\:*?"<>|\u0000-\u001f]/g, "_");

/// `told(sentence)` comes often. Errors are sentences.
export async function fetchWhole(record, told) {
  if (record.bytes > kMaxZipBytes) throw new Error("the model is too large for a browser; fetch it by `prismesh pull`, or file by file");
  const { set } = JSON.parse((await ask("GET", `/models/${record.model}`)).text);
  const files = [];
  let done = 0;
  for (const file of set) {
    const url = `/models/${record.model}/files/${file.sha256}`;
    files.push(await fetchFile(url, file, (bytes) => told(`Fetches ${file.path}: ${sizeText(done + bytes)} of ${sizeText(record.bytes)}`)));
    done += file.bytes;
  }
  if (files.length === 1) return save(files[0].blob, files[0].path.split("/").pop());
  save(zipOf(files), `${asFileName(record.name).replace(/\.[A-Za-z]{1,4}$/, "")}.zip`);
}
