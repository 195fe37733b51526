// Small helpers about the page's elements, words and numbers.

/// element("p", {className: "x"}, "text", child, ..). Text stays text.
export function element(tag, properties = {}, ...children) {
  const made = document.createElement(tag);
  for (const [name, value] of Object.entries(properties)) {
    if (name.startsWith("aria-") || name === "role") made.setAttribute(name, value);
    else made[name] = value;
  }
  made.append(...children.filter((child) => child !== undefined));
  return made;
}

/// What a screen reader says, and nobody sees.
export function tell(sentence) {
  document.getElementById("told").textContent = sentence;
}

const kNumber = new Intl.NumberFormat("en", { maximumFractionDigits: 1 });

export function numberText(number) {
  return kNumber.format(number);
}

export function sizeText(bytes) {
  for (const [unit, size] of [["GB", 1e9], ["MB", 1e6], ["kB", 1e3]])
    if (bytes >= size) return `${kNumber.format(bytes / size)} ${unit}`;
  return `${bytes} bytes`;
}

export function countText(count, one, several) {
  return `${numberText(count)} ${count === 1 ? one : several}`;
}

export function ageText(when_s, now_s = Date.now() / 1000) {
  const age_s = now_s - when_s;
  for (const [one, several, seconds] of [
    ["day", "days", 86400],
    ["hour", "hours", 3600],
    ["minute", "minutes", 60],
  ])
    if (age_s >= seconds) return `${countText(Math.floor(age_s / seconds), one, several)} ago`;
  return "just now";
}

/// Asks yes or no. The answer that changes nothing has the focus; Esc gives it.
export function askUser(sentence, yes) {
  const dialog = document.getElementById("question");
  document.getElementById("question-text").textContent = sentence;
  const agree = document.getElementById("question-yes");
  agree.textContent = yes;
  return new Promise((done) => {
    const end = (answer) => () => {
      dialog.onclose = null;
      dialog.close();
      done(answer);
    };
    agree.onclick = end(true);
    document.getElementById("question-no").onclick = end(false);
    // Browsers tell of the end of the last question when this one may be shown already.
    dialog.onclose = () => dialog.open || end(false)();
    dialog.showModal();
    document.getElementById("question-no").focus();
  });
}
