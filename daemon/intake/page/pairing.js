// Pairing codes as people type them (ipc/intake/pairing_code.h), and the form that takes one.
import { ask } from "./asking.js";

const kSigns = "0123456789ABCDEFGHJKMNPQRSTVWXYZ";
const kHalf = 16;

/// Signs without what people add; undefined: it is no code.
function signsOf(text) {
  const signs = text.toUpperCase().replace(/[\s-]/g, "").replace(/O/g, "0").replace(/[IL]/g, "1");
  if (![kHalf, 2 * kHalf].includes(signs.length) || [...signs].some((sign) => !kSigns.includes(sign))) return undefined;
  return signs;
}

/// {beginning, secret} of a code: the beginning of the certificate's SHA-256 in pairs of digits, empty if only the second half was typed.
/// undefined: it is no code.
export function readCode(text) {
  const signs = signsOf(text);
  if (!signs) return undefined;
  const secret = signs.slice(-kHalf).match(/.{4}/g).join("-");
  if (signs.length === kHalf) return { beginning: "", secret };
  const bits = [...signs.slice(0, kHalf)].map((sign) => kSigns.indexOf(sign).toString(2).padStart(5, "0")).join("");
  const bytes = bits.match(/.{8}/g).map((byte) => Number.parseInt(byte, 2).toString(16).padStart(2, "0").toUpperCase());
  return { beginning: bytes.join(" "), secret };
}

/// `paired`: called when this browser has its cookie.
export function setUpPairing(paired) {
  const form = document.getElementById("pair-form");
  const code = document.getElementById("pair-code");
  const name = document.getElementById("pair-name");
  const compared = document.getElementById("pair-compared");
  const digits = document.getElementById("pair-digits");
  const fault = document.getElementById("pair-fault");

  const say = (sentence, field) => {
    fault.textContent = sentence;
    for (const each of [code, name]) each.setAttribute("aria-invalid", String(each === field));
    field?.focus();
  };
  code.addEventListener("input", () => {
    const beginning = readCode(code.value)?.beginning;
    digits.textContent = beginning ? `The SHA-256 fingerprint must begin with ${beginning}` : "";
    compared.checked = false;
  });
  form.addEventListener("submit", async (event) => {
    event.preventDefault();
    const read = readCode(code.value);
    if (!read) return say("A code has 32 digits and letters, its second half 16; none is a U.", code);
    if (!compared.checked) return say("Compare the fingerprint first; then tick that you did.", compared);
    if (!name.value.trim()) return say("Give this browser a name, by which the station lists it.", name);
    say("");
    const button = form.querySelector("button");
    button.disabled = true;
    try {
      await ask("POST", "/pair", {
        headers: { "Content-Type": "application/json" },
        body: JSON.stringify({ secret: read.secret, name: name.value.trim(), cookie: true }),
      });
      form.reset();
      digits.textContent = "";
      paired();
    } catch (refused) {
      say(`Not paired: ${refused.message}.`, code);
    } finally {
      button.disabled = false;
    }
  });
}
