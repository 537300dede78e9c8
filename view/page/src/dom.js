// Elements and controls. Text goes in as text, never as markup: names come from files of strangers.

export function el(name, properties = {}, ...children) {
  const element = document.createElement(name);
  for (const [key, value] of Object.entries(properties)) {
    if (key in element && key !== "list") element[key] = value;
    else element.setAttribute(key, value);
  }
  element.append(...children.filter((child) => child !== null && child !== undefined));
  return element;
}

/// Calls `then` when an element has another size, once a frame: sizes that change while browsers tell of them make them complain.
export function onResize(element, then) {
  let frame = 0;
  new ResizeObserver(() => {
    cancelAnimationFrame(frame);
    frame = requestAnimationFrame(() => then());
  }).observe(element);
}

/// The key of an event. With caps lock a letter is the same key.
export const keyOf = ({ key }) => (key.length === 1 ? key.toLowerCase() : key);

export const heading = (text) => el("h2", {}, text);
export const note = (text) => el("p", { className: "note" }, text);

/// `text`: what stands beside the box, or a list of it and of swatches.
export function checkbox(text, checked, onChange, swatch) {
  const input = el("input", { type: "checkbox", checked });
  input.addEventListener("change", () => onChange(input.checked));
  const row = el("label", { className: "row" }, input, el("span", { className: "text" }, ...[text].flat()), swatch);
  row.input = input;
  return row;
}

export function radios(name, choices, chosen, onChange) {
  return choices.map(([text, value, swatch]) => {
    const input = el("input", { type: "radio", name, checked: value === chosen });
    input.addEventListener("change", () => onChange(value));
    return el("label", { className: "row" }, input, el("span", { className: "text" }, text), swatch);
  });
}

export function swatch(color, round = false) {
  const element = el("span", { className: round ? "swatch round" : "swatch" });
  element.style.background = color;
  return element;
}

/// What a color means.
export function legendRow(color, text, round = false) {
  return el("div", { className: "row" }, swatch(color, round), el("span", { className: "text" }, text));
}

export function slider(text, { least, most, step, value, format }, onInput) {
  const output = el("output", {}, format(value));
  const input = el("input", { type: "range", min: least, max: most, step, value, "aria-label": text });
  const show = (now) => { output.textContent = format(now); input.setAttribute("aria-valuetext", format(now)); };
  input.addEventListener("input", () => { show(Number(input.value)); onInput(Number(input.value)); });
  const row = el("div", { className: "slider" }, el("div", {}, el("span", {}, text), output), input);
  row.set = (now) => { input.value = now; show(Number(now)); };
  row.input = input;
  show(value);
  return row;
}

export function button(text, onClick, properties = {}) {
  const element = el("button", { type: "button", ...properties }, text);
  element.addEventListener("click", onClick);
  return element;
}

/// Rows of a name and numbers, under heads if they are given.
export function table(rows, heads = null) {
  const cells = (row, kind) => row.map((cell, n) => el(n > 0 ? kind : "th", n > 0 ? { className: "number" } : {}, String(cell)));
  return el("table", {}, heads ? el("tr", {}, ...cells(heads, "th")) : null, ...rows.map((row) => el("tr", {}, ...cells(row, "td"))));
}

/// What JSON says, as a tree that one can open.
export function tree(value, name = "") {
  if (value === null || typeof value !== "object") {
    return el("div", { className: "tree" }, el("b", {}, name + " "), value === null ? "none" : String(value));
  }
  const entries = Object.entries(value);
  if (Array.isArray(value) && value.length <= 8 && value.every((one) => typeof one !== "object")) {
    return el("div", { className: "tree" }, el("b", {}, name + " "), value.join(", ") || "none");
  }
  const inside = el("div");
  const details = el("details", { className: "tree" }, el("summary", {}, `${name} (${entries.length})`), inside);
  details.addEventListener("toggle", () => {
    if (!details.open || inside.childElementCount > 0) return;
    const most = 500;
    inside.append(...entries.slice(0, most).map(([key, one]) => tree(one, key)));
    if (entries.length > most) inside.append(note(`and ${entries.length - most} more`));
  });
  return details;
}

/// "1 step", "2 steps".
export const counted = (count, noun) => `${count} ${noun}${count === 1 ? "" : "s"}`;
export const meters = (value) => `${value.toFixed(3)} m`;
export const megabytes = (bytes) => `${(bytes / 1e6).toFixed(2)} MB`;
