// Requests to the station, and what may become of them.

/// The line is cut, or the station doesn't answer: asking again helps.
export class LineCut extends Error {
  constructor() {
    super("the station doesn't answer");
  }
}

/// The station said no, in a sentence.
export class Refused extends Error {
  constructor(status, sentence, retryAfter_s = 0) {
    super(sentence);
    this.status = status;
    this.retryAfter_s = retryAfter_s;
  }
}

/// The user doesn't want it any more.
export class Cancelled extends Error {}

const kSilence_ms = 30_000;

export function wait(milliseconds, signal) {
  return new Promise((done, failed) => {
    const end = (then, value) => {
      clearTimeout(timer);
      window.removeEventListener("online", online);
      signal?.removeEventListener("abort", stop);
      then(value);
    };
    const online = () => end(done);
    const stop = () => end(failed, new Cancelled());
    const timer = setTimeout(online, milliseconds);
    window.addEventListener("online", online);
    signal?.addEventListener("abort", stop);
    if (signal?.aborted) stop();
  });
}

export function base64OfText(text) {
  return btoa(String.fromCharCode(...new TextEncoder().encode(text)));
}

function sentenceIn(text, status) {
  try {
    return JSON.parse(text).error ?? `the station answers with ${status}`;
  } catch {
    return `the station answers with ${status}`;
  }
}

/// One request; `allowed`: statuses beside 2xx that aren't a refusal. Returns {status, header(name), text}.
export async function ask(method, path, { headers = {}, body, allowed = [], signal } = {}) {
  let answer;
  let text;
  try {
    const signals = [AbortSignal.timeout(kSilence_ms), ...(signal ? [signal] : [])];
    answer = await fetch(path, { method, headers, body, cache: "no-store", signal: AbortSignal.any(signals) });
    text = await answer.text();
  } catch {
    throw signal?.aborted ? new Cancelled() : new LineCut();
  }
  if (!answer.ok && !allowed.includes(answer.status))
    throw new Refused(answer.status, sentenceIn(text, answer.status), Number(answer.headers.get("Retry-After") ?? 0));
  return { status: answer.status, header: (name) => answer.headers.get(name), text };
}

/// Sends bytes and tells how many are out, which fetch can't. Returns {status, header(name), text}.
export function sendBytes(method, path, headers, bytes, told, signal) {
  return new Promise((done, failed) => {
    const request = new XMLHttpRequest();
    let silence;
    const hear = () => {
      clearTimeout(silence);
      silence = setTimeout(() => request.abort(), kSilence_ms);
    };
    const stop = () => request.abort();
    const end = (then, value) => {
      clearTimeout(silence);
      signal.removeEventListener("abort", stop);
      then(value);
    };
    const cut = () => end(failed, signal.aborted ? new Cancelled() : new LineCut());
    request.open(method, path);
    for (const [name, value] of Object.entries(headers)) request.setRequestHeader(name, value);
    request.upload.onprogress = (event) => {
      hear();
      told(event.loaded);
    };
    request.onload = () =>
      end(done, { status: request.status, header: (name) => request.getResponseHeader(name), text: request.responseText });
    request.onerror = request.onabort = cut;
    signal.addEventListener("abort", stop);
    hear();
    request.send(bytes);
    if (signal.aborted) stop();
  });
}

export function refusalOf(answer) {
  return new Refused(answer.status, sentenceIn(answer.text, answer.status), Number(answer.header("Retry-After") ?? 0));
}

/// Asks until there is an answer, however long the line is cut. `told(isCut)`: before and after waiting.
export async function askUntilAnswered(work, told, signal) {
  for (let pause_ms = 500; ; pause_ms = Math.min(2 * pause_ms, 10_000)) {
    try {
      const answer = await work();
      told(false);
      return answer;
    } catch (fault) {
      const isBusy = fault instanceof Refused && fault.status === 429;
      if (!isBusy && !(fault instanceof LineCut)) throw fault;
      if (!isBusy) told(true);
      await wait(isBusy ? 1000 * Math.max(1, fault.retryAfter_s) : pause_ms, signal);
    }
  }
}
