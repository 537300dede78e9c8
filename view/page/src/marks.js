// What happened in a run: marks above its track, each where its step is. Where several would lie on each other, they
// are one, with their number and a list.
import { button, el, note, onResize } from "./dom.js";
import { kEndings, kEvents } from "./track.js";

// Told apart by shape; colors only help.
const kSymbols = { grasp: ["▲", "--green", "grasped"], drop: ["▼", "--blue", "let go"], restore: ["↺", "--purple", "found no place to let go, the object went back"] };
/// What a letter of a mark takes of the track, rem.
const kLetter = 0.85;
const kMostListed = 200;
const kMostInTitle = 6;

/// All that happened: { frame, symbol, color, text }, the frame after the step.
function momentsOf(track) {
  const moments = [];
  const add = (step, [symbol, color, text]) => moments.push({ frame: step + 1, symbol, color, text: `Step ${step + 1}: ${text}` });
  track.events.forEach((events, step) => {
    for (const [name, mark] of Object.entries(kSymbols)) if (events & kEvents[name]) add(step, mark);
    const ending = track.endings[step];
    if (ending === 1) add(step, ["★", "--orange", "success"]);
    else if (ending > 1) add(step, ["✕", "--red", kEndings[ending]]);
  });
  return moments;
}

/// Moments that are shown as one mark.
class Group {
  constructor(moment) {
    this.moments = [moment];
    this.symbols = new Map([[moment.symbol, moment.color]]);
  }

  take(other) {
    this.moments.push(...other.moments);
    for (const [symbol, color] of other.symbols) this.symbols.set(symbol, color);
  }

  /// How many, where the symbols do not tell.
  get count() { return this.moments.length > this.symbols.size ? String(this.moments.length) : ""; }

  /// In pixels, where a frame takes `step` and a letter `letter`; the first and the last ones stay on the track.
  place(width, step, letter) {
    const half = ((this.symbols.size + 0.7 * this.count.length) * letter) / 2;
    const middle = Math.max(half, Math.min(width - half, this.moments[0].frame * step));
    return { middle, left: middle - half, right: middle + half };
  }
}

/// As few as lie beside each other on a track that is so many pixels wide.
function groupsOf(moments, width, step, letter) {
  const groups = [];
  for (const moment of moments) {
    groups.push(new Group(moment));
    // One that became wider may reach the one before it.
    while (groups.length > 1) {
      const [before, last] = groups.slice(-2);
      if (before.place(width, step, letter).right <= last.place(width, step, letter).left) break;
      before.take(groups.pop());
    }
  }
  return groups;
}

export class Marks {
  /// `onPick(frame)` when somebody wants to see a moment.
  constructor(onPick) {
    this.onPick = onPick;
    this.moments = [];
    this.marks = el("div", { className: "marks" });
    this.list = el("div", { className: "moments", hidden: true });
    this.list.addEventListener("keydown", (event) => { if (event.key === "Escape") this.close(); });
    this.element = el("div", {}, this.list, this.marks);
    onResize(this.marks, () => this.layOut());
  }

  setTrack(track) {
    this.steps = Math.max(1, track.frameCount - 1);
    this.moments = momentsOf(track);
    this.width = null;
    this.layOut();
  }

  layOut() {
    const width = this.marks.clientWidth;
    if (width === 0 || width === this.width) return;
    this.width = width;
    this.close();
    const letter = kLetter * Number.parseFloat(getComputedStyle(document.documentElement).fontSize);
    const step = width / this.steps;
    this.marks.replaceChildren(...groupsOf(this.moments, width, step, letter).map((group) => {
      const mark = this.markOf(group);
      mark.style.left = `${group.place(width, step, letter).middle}px`;
      return mark;
    }));
  }

  markOf(group) {
    const { moments, symbols, count } = group;
    const [first, last] = [moments[0], moments[moments.length - 1]];
    const isOneStep = first.frame === last.frame;
    const mark = button("", () => (isOneStep ? this.pick(first) : this.toggle(mark, group)), { title: titleOf(moments) });
    mark.setAttribute("aria-label", isOneStep ? mark.title : `${moments.length} events, steps ${first.frame} to ${last.frame}`);
    if (!isOneStep) mark.setAttribute("aria-expanded", "false");
    for (const [symbol, color] of symbols) {
      const glyph = el("span", {}, symbol);
      glyph.style.color = `var(${color})`;
      mark.append(glyph);
    }
    if (count) mark.append(el("small", {}, count));
    return mark;
  }

  pick(moment) {
    this.close();
    this.onPick(moment.frame);
  }

  toggle(mark, { moments }) {
    const isOpen = mark.getAttribute("aria-expanded") === "true";
    this.close();
    if (isOpen) return;
    this.opened = mark;
    mark.setAttribute("aria-expanded", "true");
    const rest = moments.length - kMostListed;
    this.list.replaceChildren(...moments.slice(0, kMostListed).map((one) => button(one.text, () => this.pick(one))),
      rest > 0 ? note(`and ${rest} more`) : "");
    this.list.hidden = false;
    const room = this.width - this.list.offsetWidth;
    this.list.style.left = `${Math.max(0, Math.min(room, Number.parseFloat(mark.style.left) - this.list.offsetWidth / 2))}px`;
  }

  close() {
    this.list.hidden = true;
    this.opened?.setAttribute("aria-expanded", "false");
    this.opened = null;
  }
}

function titleOf(moments) {
  const rest = moments.length - kMostInTitle;
  return moments.slice(0, kMostInTitle).map(({ text }) => text).join("\n") + (rest > 0 ? `\nand ${rest} more` : "");
}
