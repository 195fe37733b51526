// The section with the models: what they are, fetching, removing; follows the station's events.
import { ask, askUntilAnswered, Refused } from "./asking.js";
import { ageText, askUser, countText, element, sizeText, tell } from "./elements.js";
import { fetchWhole } from "./fetching.js";

const kPage = 50;
const kTyping_ms = 250;
const kAges_ms = 30_000;

/// What `prismesh pull` takes too, and tells models of one name apart.
const shortHash = (model) => model.slice(0, 8);
const byId = (id) => document.getElementById(id);

export class CatalogueSection {
  /// `lost`: called when the station doesn't know this browser any more. `heard(isConnected)`: whether events come. `changed()`: the station
  /// told of a change.
  constructor(lost, heard, changed) {
    this.#lost = lost;
    this.#heard = heard;
    this.#changed = changed;
    byId("more").addEventListener("click", () => this.#load(this.#models.size));
    byId("search").addEventListener("submit", (event) => event.preventDefault());
    byId("search-name").addEventListener("input", () => {
      clearTimeout(this.#typing);
      this.#typing = setTimeout(() => this.#load(0), kTyping_ms);
    });
    setInterval(() => this.#showAges(), kAges_ms);
  }

  /// `scopes`: the rights of this browser.
  show(scopes) {
    this.#scopes = scopes;
    byId("catalogue").hidden = !scopes.includes("read");
    if (scopes.includes("read")) this.#follow();
  }

  hide() {
    this.#events?.close();
    this.#events = undefined;
    this.#models.clear();
    byId("models").replaceChildren();
    byId("catalogue").hidden = true;
  }

  #lost;
  #heard;
  #changed;
  #scopes = [];
  #models = new Map(); // by hash: {record, item}
  #typing;
  #events;
  #load_number = 0;
  #isBehind = false; // an event came since the list was asked for

  // --- following ---

  #follow() {
    const events = new EventSource("/events");
    this.#events = events;
    const changed = (work) => (event) => {
      work(JSON.parse(event.data));
      this.#isBehind = true;
      this.#showCount();
      this.#changed();
    };
    // What happened while the line was cut isn't told again.
    events.onopen = () => {
      this.#heard(true);
      this.#load(0);
    };
    events.onerror = async () => {
      if (this.#events !== events) return;
      this.#heard(false);
      if (events.readyState !== EventSource.CLOSED) return;
      // It doesn't try again by itself where it was refused, or where the station is away.
      const answer = await askUntilAnswered(() => ask("GET", "/token", { allowed: [401] }), () => undefined);
      if (this.#events !== events) return;
      if (answer.status === 401) return this.#lost();
      setTimeout(() => this.#events === events && this.#follow(), 2000);
    };
    events.addEventListener("published", changed((record) => this.#add(record, true)));
    events.addEventListener("described", changed((record) => this.#models.has(record.model) && this.#add(record, false)));
    events.addEventListener("removed", changed(({ model }) => this.#drop(model)));
  }

  async #load(skip) {
    const number = ++this.#load_number;
    this.#isBehind = false;
    const query = new URLSearchParams({ skip, count: kPage });
    const words = byId("search-name").value.trim();
    if (words) query.set("name", words);
    try {
      const answer = await askUntilAnswered(() => ask("GET", `/models?${query}`), (isCut) => this.#heard(!isCut));
      if (number !== this.#load_number) return;
      // The list may be of before an event that came while it was on its way.
      if (this.#isBehind) return this.#load(skip);
      const { models } = JSON.parse(answer.text);
      if (skip === 0) {
        this.#models.clear();
        byId("models").replaceChildren();
      }
      for (const record of models) this.#add(record, false);
      byId("more").hidden = models.length < kPage;
      byId("catalogue-fault").textContent = "";
      this.#showCount();
    } catch (fault) {
      this.#fail("The models can't be listed", fault);
    }
  }

  #fail(what, fault) {
    if (fault instanceof Refused && fault.status === 401) return this.#lost();
    byId("catalogue-fault").textContent = `${what}: ${fault.message}.`;
  }

  // --- showing ---

  #showCount() {
    const count = this.#models.size;
    byId("catalogue-count").textContent = count === 0 ? "No models." : countText(count, "model", "models");
  }

  #showAges() {
    for (const { record, item } of this.#models.values()) item.querySelector("time").textContent = ageText(record.when_s);
  }

  #add(record, isNew) {
    const before = this.#models.get(record.model);
    const words = byId("search-name").value.trim().toLowerCase();
    if (isNew && !before && !record.name.toLowerCase().includes(words)) return;
    const item = before?.item ?? this.#card(record);
    this.#models.set(record.model, { record, item });
    // Its buttons stay: one may have the focus, or be at work.
    if (before) item.querySelector(".about").replaceWith(this.#about(record));
    else if (isNew) byId("models").prepend(item);
    else byId("models").append(item);
    if (isNew) tell(`${record.name} was published by ${record.who}.`);
  }

  #drop(model) {
    this.#models.get(model)?.item.remove();
    this.#models.delete(model);
  }

  #nameOf(model) {
    return this.#models.get(model)?.record.name ?? `model ${shortHash(model)}`;
  }

  #about(record) {
    const when = new Date(1000 * record.when_s);
    const facts = element(
      "p",
      {},
      `by ${record.who}, `,
      element("time", { dateTime: when.toISOString(), title: when.toLocaleString() }, ageText(record.when_s)),
      `, ${countText(record.files, "file", "files")}, ${sizeText(record.bytes)}, model ${shortHash(record.model)}`,
    );
    const about = element("div", { className: "about" }, ...picture(record), facts);
    if (record.derived_from) about.append(this.#lineage(record.derived_from));
    if (record.figures) about.append(...figures(record.figures));
    if (record.damaged) about.append(element("p", { className: "fault" }, "Damaged in the store. Send it again."));
    return about;
  }

  #card(record) {
    const item = element("li", { className: "card model", id: `model-${record.model}` });
    item.append(element("h3", {}, record.name), this.#about(record));
    const state = element("p", { className: "state", role: "status" });
    item.append(element("p", { className: "row" }, ...this.#buttons(record, item, state)), state);
    return item;
  }

  #lineage(from) {
    const known = this.#models.has(from);
    const name = this.#nameOf(from);
    return element("p", {}, "edited from ", known ? element("a", { href: `#model-${from}` }, name) : name);
  }

  #buttons(record, item, state) {
    const named = (text, work, className = "") => {
      const button = element("button", { type: "button", className, "aria-label": `${text}: ${record.name}, model ${shortHash(record.model)}` }, text);
      button.addEventListener("click", () => work(button));
      return button;
    };
    const buttons = [
      named("Fetch", (button) => this.#fetch(record, button, state)),
      named("Files", (button) => this.#showFiles(record, item, button)),
    ];
    if (this.#scopes.includes("remove")) buttons.push(named("Remove", () => this.#remove(record), "grave"));
    return buttons;
  }

  // --- fetching and removing ---

  async #fetch(record, button, state) {
    button.disabled = true;
    try {
      await fetchWhole(record, (sentence) => (state.textContent = sentence));
      state.textContent = "Fetched; every byte is as it was sent.";
    } catch (fault) {
      state.textContent = `Not fetched: ${fault.message}.`;
      if (fault instanceof Refused && fault.status === 401) this.#lost();
    } finally {
      button.disabled = false;
      button.focus();
    }
  }

  async #showFiles(record, item, button) {
    const shown = item.querySelector(".files");
    button.setAttribute("aria-expanded", String(!shown));
    if (shown) return shown.remove();
    try {
      const { main, set } = JSON.parse((await ask("GET", `/models/${record.model}`)).text);
      const link = ({ path, sha256 }) =>
        element("a", { href: `/models/${record.model}/files/${sha256}`, download: path.split("/").pop() }, path);
      item.append(
        element("ul", { className: "files" }, ...set.map((file) => element("li", {}, link(file), `, ${sizeText(file.bytes)}${file.path === main ? ", the main file" : ""}`))),
      );
    } catch (fault) {
      button.setAttribute("aria-expanded", "false");
      this.#fail("The files can't be listed", fault);
    }
  }

  async #remove(record) {
    if (!(await askUser(`Remove ${record.name} from the station? It can't be brought back.`, "Remove"))) return;
    try {
      await ask("DELETE", `/models/${record.model}`, { allowed: [404] });
      this.#drop(record.model);
      this.#showCount();
      tell(`${record.name} is removed.`);
      byId("search-name").focus();
    } catch (fault) {
      this.#fail(`${record.name} isn't removed`, fault);
    }
  }
}

function picture(record) {
  if (!record.thumbnail) return [];
  return [element("img", { src: `/models/${record.model}/thumbnail`, alt: `Picture of ${record.name}`, width: 160, height: 120 })];
}

/// Counts and quality; each state has a sign beside its colour.
function figures({ nodes, elements, parts, warn, fail }) {
  const counts = `${countText(nodes, "node", "nodes")}, ${countText(elements, "element", "elements")}, ${countText(parts, "part", "parts")}`;
  const signs = [];
  if (fail > 0) signs.push(element("span", { className: "fail" }, `✖ ${countText(fail, "fails", "fail")}`));
  if (warn > 0) signs.push(element("span", { className: "warn" }, `▲ ${countText(warn, "warns", "warn")}`));
  if (signs.length === 0) signs.push(element("span", { className: "well" }, "✔ no warnings"));
  return [element("p", {}, counts), element("p", { className: "quality" }, element("span", {}, "Elements: "), ...signs)];
}
