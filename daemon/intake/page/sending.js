// The section in which decks are sent: choosing, progress, going on.
import { ask, Cancelled, Refused } from "./asking.js";
import { countText, element, numberText, sizeText, tell } from "./elements.js";
import { forgetUpload, rememberedUploadOf, rememberedUploads, rememberUpload } from "./memory.js";
import { pathFault, Upload } from "./upload.js";

const kMaxFiles = 2000;
const kShownFiles = 200;
const kToldSteps = 4; // how often a screen reader is told of the progress

const byId = (id) => document.getElementById(id);

// --- choosing ---

/// Without the folder that holds all of them.
function withoutCommonFolder(files) {
  const slash = files[0].path.indexOf("/");
  const folder = files[0].path.slice(0, slash + 1);
  if (slash < 0 || !files.every(({ path }) => path.startsWith(folder))) return files;
  return withoutCommonFolder(files.map(({ path, file }) => ({ path: path.slice(folder.length), file })));
}

function entriesIn(folder) {
  const reader = folder.createReader();
  const all = [];
  return new Promise((done, failed) => {
    // It gives a hundred at a time.
    const next = () =>
      reader.readEntries((entries) => {
        if (entries.length === 0) return done(all);
        all.push(...entries);
        next();
      }, failed);
    next();
  });
}

async function filesBelow(entry, path = "") {
  const own = path + entry.name;
  if (entry.isFile) return [{ path: own, file: await new Promise((done, failed) => entry.file(done, failed)) }];
  const files = [];
  for (const each of await entriesIn(entry)) files.push(...(await filesBelow(each, `${own}/`)));
  return files;
}

/// What was dropped, with paths as they lie to each other.
async function droppedFiles(transfer) {
  const entries = [...transfer.items].map((item) => item.webkitGetAsEntry?.()).filter(Boolean);
  if (entries.length === 0) return [...transfer.files].map((file) => ({ path: file.name, file }));
  const files = [];
  for (const entry of entries) files.push(...(await filesBelow(entry)));
  return files;
}

const isHidden = (path) => path.split("/").some((part) => part.startsWith("."));

/// The file that is likely the main one: the one nearest to the top whose name says so, or else the first.
function likelyMain(files) {
  const rank = ({ path }) => path.split("/").length * 2 - (/main/i.test(path.split("/").pop()) ? 1 : 0);
  return [...files].sort((a, b) => rank(a) - rank(b) || (a.path < b.path ? -1 : 1))[0].path;
}

export class SendingSection {
  /// `lost`: called when the station doesn't know this browser any more.
  constructor(lost) {
    this.#lost = lost;
    const drop = byId("drop");
    for (const [button, input] of [["choose-files", "files"], ["choose-folder", "folder"]]) {
      byId(button).addEventListener("click", () => byId(input).click());
      byId(input).addEventListener("change", (event) => {
        this.#choose([...event.target.files].map((file) => ({ path: file.webkitRelativePath || file.name, file })));
        event.target.value = "";
      });
    }
    // A file that misses its place would take the page's place.
    for (const kind of ["dragover", "drop"]) window.addEventListener(kind, (event) => event.preventDefault());
    drop.addEventListener("dragover", () => drop.classList.add("over"));
    drop.addEventListener("dragleave", () => drop.classList.remove("over"));
    drop.addEventListener("drop", async (event) => {
      drop.classList.remove("over");
      try {
        this.#choose(await droppedFiles(event.dataTransfer));
      } catch {
        this.#refuse("What was dropped can't be read.");
      }
    });
    byId("set").addEventListener("submit", (event) => {
      event.preventDefault();
      const chosen = this.#chosen;
      this.#takeBack();
      this.#begin({ id: crypto.randomUUID(), files: chosen, main: byId("set-main").value, name: byId("set-name").value.trim() });
    });
    byId("set-drop").addEventListener("click", () => {
      this.#takeBack();
      byId("choose-files").focus();
    });
  }

  /// Shows what was begun before the page was loaded.
  show() {
    for (const each of rememberedUploads()) if (!this.#cards.has(each.id)) this.#showUnfinished(each);
  }

  #lost;
  #chosen = [];
  #cards = new Map();
  #queue = Promise.resolve();

  #refuse(sentence) {
    byId("sending-fault").textContent = sentence;
  }

  #choose(given) {
    this.#refuse("");
    const all = given.filter(({ path }) => !isHidden(path));
    if (all.length === 0) return this.#refuse("There is no file in that.");
    const files = withoutCommonFolder(all);
    if (files.length > kMaxFiles) return this.#refuse(`A model has at most ${numberText(kMaxFiles)} files; these are ${numberText(files.length)}.`);
    const faulty = files.find(({ path }) => pathFault(path));
    if (faulty) return this.#refuse(`The path of ${faulty.path} ${pathFault(faulty.path)}.`);
    if (new Set(files.map(({ path }) => path)).size < files.length) return this.#refuse("Two of the files have the same name.");
    const remembered = rememberedUploadOf(files);
    if (remembered) return this.#goOn(remembered, files);
    this.#chosen = files;
    const main = likelyMain(files);
    const paths = files.map(({ path }) => path).sort();
    byId("set-main").replaceChildren(...paths.map((path) => element("option", { value: path, selected: path === main }, path)));
    byId("set-name").value = main.split("/").pop();
    const bytes = files.reduce((sum, { file }) => sum + file.size, 0);
    byId("set-size").textContent = `${countText(files.length, "file", "files")}, ${sizeText(bytes)}`;
    const shown = files.slice(0, kShownFiles).map(({ path, file }) => element("li", {}, `${path}, ${sizeText(file.size)}`));
    if (files.length > kShownFiles) shown.push(element("li", {}, `and ${numberText(files.length - kShownFiles)} more`));
    byId("set-files").replaceChildren(...shown);
    byId("set").hidden = false;
    byId("set-main").focus();
  }

  #takeBack() {
    this.#chosen = [];
    byId("set").hidden = true;
  }

  // --- unfinished ones ---

  #goOn(remembered, files) {
    const known = new Map(remembered.files.map((each) => [each.path, each]));
    for (const each of files) Object.assign(each, { hash: known.get(each.path).hash, upload: known.get(each.path).upload });
    this.#begin({ ...remembered, files });
  }

  #showUnfinished(remembered) {
    const card = new Card(remembered.name || remembered.main);
    card.say(`Not finished. Choose the same ${countText(remembered.files.length, "file", "files")} again to go on.`);
    card.setButton("Forget it", async () => {
      card.remove();
      this.#cards.delete(remembered.id);
      forgetUpload(remembered.id);
      byId("choose-files").focus();
      for (const { upload } of remembered.files)
        if (upload) await ask("DELETE", upload, { headers: { "Tus-Resumable": "1.0.0" }, allowed: [404] }).catch(() => undefined);
    });
    this.#cards.set(remembered.id, card);
  }

  // --- sending ---

  #begin({ id, files, main, name }) {
    this.#cards.get(id)?.remove();
    const card = new Card(name || main);
    this.#cards.set(id, card);
    const upload = new Upload({
      files,
      main,
      name,
      told: (state) => card.show(upload, state),
      remember: () => rememberUpload(id, upload),
    });
    card.say("Waits for the one before.");
    card.setButton("Cancel", () => upload.cancel());
    byId("choose-files").focus();
    // One after the other: together they would be no quicker, and each would be finished later.
    this.#queue = this.#queue.then(() => this.#run(id, upload, card));
  }

  async #run(id, upload, card) {
    try {
      await upload.run();
      forgetUpload(id);
      card.finish("Published.");
      tell(`${card.title} is published.`);
    } catch (fault) {
      if (fault instanceof Refused && fault.status === 401) return this.#lost();
      if (fault instanceof Cancelled) {
        forgetUpload(id);
        card.finish("Cancelled.");
        await upload.discard();
      } else {
        card.fail(`Not published: ${fault.message}.`);
      }
    }
    card.setButton("Close", () => {
      card.remove();
      this.#cards.delete(id);
      byId("choose-files").focus();
    });
  }
}

/// An upload as it is shown.
class Card {
  constructor(title) {
    this.title = title;
    this.#state = element("p", { className: "state" });
    this.#fault = element("p", { className: "fault", role: "alert" });
    this.#bar = element("progress", { max: 1, value: 0, hidden: true, "aria-label": `Progress of ${title}` });
    this.#button = element("button", { type: "button", hidden: true });
    this.#files = element("ul", { className: "files" });
    this.#details = element("details", { hidden: true }, element("summary", {}, "Files"), this.#files);
    this.#item = element("li", { className: "card" }, element("h3", {}, title), this.#state, this.#bar, this.#fault, this.#details, element("p", { className: "row" }, this.#button));
    byId("uploads").append(this.#item);
  }

  remove() {
    this.#item.remove();
  }
  say(sentence) {
    this.#state.textContent = sentence;
  }
  fail(sentence) {
    this.#bar.hidden = true;
    this.say("");
    this.#fault.textContent = sentence;
  }
  finish(sentence) {
    this.#bar.hidden = true;
    this.#details.hidden = true;
    this.say(sentence);
  }
  setButton(text, work) {
    this.#button.textContent = text;
    this.#button.setAttribute("aria-label", `${text}: upload of ${this.title}`);
    this.#button.onclick = work;
    this.#button.hidden = false;
  }

  show(upload, { phase, path, isCut }) {
    const all = upload.files.reduce((sum, { file }) => sum + file.size, 0);
    const done = upload.files.reduce((sum, each) => sum + (phase === "reading" ? (each.hashed ?? 0) : each.at), 0);
    const part = all > 0 ? done / all : 1;
    this.#bar.hidden = phase === "publishing";
    this.#bar.value = part;
    this.#item.classList.toggle("cut", isCut);
    const progress = `${Math.floor(100 * part)} %, ${sizeText(done)} of ${sizeText(all)}`;
    if (isCut) this.say(`The line is cut; it goes on by itself. ${progress}`);
    else if (phase === "reading") this.say(`Reads ${path}: ${progress}`);
    else if (phase === "publishing") this.say("Asks the station to publish it.");
    else this.say(`Sends ${path ?? ""}: ${progress}`);
    if (phase === "sending") this.#showFile(upload, path);
    const step = `${phase} ${isCut} ${Math.floor(kToldSteps * part)}`;
    if (step !== this.#told) {
      this.#told = step;
      tell(isCut ? `The line is cut; ${this.title} goes on by itself.` : `${this.title}: ${phase}, ${Math.floor(100 * part)} %`);
    }
  }

  #showFile(upload, path) {
    this.#details.hidden = false;
    if (this.#rows.size === 0)
      for (const each of upload.files.slice(0, kShownFiles)) {
        const text = element("span");
        const bar = element("progress", { max: each.file.size || 1, "aria-label": `Progress of ${each.path}` });
        this.#rows.set(each.path, { text, bar, each });
        this.#files.append(element("li", {}, text, bar));
      }
    for (const { text, bar, each } of path ? [this.#rows.get(path)].filter(Boolean) : this.#rows.values()) {
      bar.value = each.file.size ? each.at : 1;
      text.textContent = `${each.path}, ${sizeText(each.at)} of ${sizeText(each.file.size)}`;
    }
  }

  #state;
  #fault;
  #bar;
  #button;
  #files;
  #details;
  #item;
  #rows = new Map();
  #told = "";
}
