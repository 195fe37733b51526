// The page of a station: what is shown to whom, and whether the station answers.
import { ask, askUntilAnswered, LineCut } from "./asking.js";
import { CatalogueSection } from "./catalogue.js";
import { askUser, element, numberText, sizeText, tell } from "./elements.js";
import { isPaired, setPaired } from "./memory.js";
import { setUpPairing } from "./pairing.js";
import { SendingSection } from "./sending.js";

const kHealth_ms = 10_000;

const byId = (id) => document.getElementById(id);

let token; // {name, scopes, expires_s} of this browser

function showLine(isConnected) {
  const text = isConnected ? "● connected" : "○ the station doesn't answer; trying again";
  if (byId("line").textContent !== text) byId("line").textContent = text;
}

function lost() {
  if (!isPaired()) return;
  setPaired(false);
  showUnpaired();
  tell("The station doesn't know this browser any more. Pair it again.");
}

const catalogue = new CatalogueSection(lost, showLine, showHealth);
const sending = new SendingSection(lost);

function showUnpaired() {
  token = undefined;
  catalogue.hide();
  for (const id of ["sending", "station"]) byId(id).hidden = true;
  byId("pairing").hidden = false;
}

async function showPaired() {
  const answer = await askUntilAnswered(() => ask("GET", "/token", { allowed: [401] }), (isCut) => showLine(!isCut));
  if (answer.status === 401) return lost();
  token = JSON.parse(answer.text);
  byId("pairing").hidden = true;
  byId("sending").hidden = !token.scopes.includes("upload");
  byId("station").hidden = false;
  catalogue.show(token.scopes);
  sending.show();
  await showHealth();
}

// --- health ---

/// The station's figures that people ask for, of those in Prometheus' form.
async function stationFigures() {
  const answer = await ask("GET", "/metrics", { allowed: [401, 403, 429] });
  if (answer.status !== 200) return [];
  const values = new Map(answer.text.split("\n").filter((line) => line && !line.startsWith("#")).map((line) => line.split(" ")));
  const value = (name) => Number(values.get(`prismesh_intake_${name}`));
  return [
    ["Models", numberText(value("models"))],
    ["Room on the disk", sizeText(value("free_bytes"))],
    ["Uploads under way", numberText(value("uploads"))],
    ["Damaged files", numberText(value("damaged_files"))],
    ["Connections", numberText(value("connections"))],
  ];
}

async function showHealth() {
  try {
    const { status } = JSON.parse((await ask("GET", "/health")).text);
    showLine(true);
    if (!token) return;
    const figures = [
      ["Service", status === "ok" ? "runs" : status],
      ["This browser", `${token.name}, until ${new Date(1000 * token.expires_s).toLocaleDateString()}`],
      ["Its rights", token.scopes.join(", ")],
      ...(token.scopes.includes("metrics") ? await stationFigures() : []),
    ];
    byId("figures").replaceChildren(
      ...figures.flatMap(([name, text]) => [element("dt", {}, name), element("dd", {}, text)]),
    );
  } catch (fault) {
    if (!(fault instanceof LineCut)) throw fault;
    showLine(false);
    byId("figures").replaceChildren(element("dt", {}, "Service"), element("dd", {}, "doesn't answer"));
  }
}

byId("leave").addEventListener("click", async () => {
  if (!(await askUser("Unpair this browser? To use the station again it needs a new code.", "Unpair"))) return;
  try {
    await ask("DELETE", "/token", { allowed: [401] });
    setPaired(false);
    showUnpaired();
    byId("pair-code").focus();
  } catch (fault) {
    tell(`Not unpaired: ${fault.message}.`);
  }
});

setUpPairing(() => {
  setPaired(true);
  tell("This browser is paired.");
  showPaired().then(() => byId("main").focus());
});
setInterval(showHealth, kHealth_ms);
window.addEventListener("online", showHealth);
if (isPaired()) showPaired();
else {
  showUnpaired();
  showHealth();
}
