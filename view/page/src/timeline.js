// Play, pause, step, scrub; marks and curves below.
import { address, addressNumber, setAddress } from "./address.js";
import { Curves } from "./curves.js";
import { button, el } from "./dom.js";
import { Marks } from "./marks.js";
import { envName, kEvents } from "./track.js";

const kSpeeds = [0.25, 0.5, 1, 2, 4, 8];
const kCurves = ["Reward", "Distance", "Contact", "Actions"];
const kFirstCurves = "Reward,Distance";
/// What is played at once at most, seconds: who comes back to a page that waited in the background goes on where he was.
const kMostAtOnce = 0.5;

/// The speed that is there and nearest to one that somebody wrote into the address.
function nearestSpeed(wanted) {
  if (wanted <= 0) return 1;
  const times = (speed) => Math.max(speed / wanted, wanted / speed);
  return kSpeeds.reduce((best, one) => (times(one) < times(best) ? one : best));
}

export class Timeline {
  constructor(page, run, { onFrame, onBetween }) {
    this.page = page;
    this.run = run;
    this.onFrame = onFrame;
    this.onBetween = onBetween;
    this.frame = 0;
    this.speed = 1;
    this.shownCurves = new Set();
    /// What is being played, from where and since when; null: nothing is.
    this.playing = null;
    this.element = document.getElementById("timeline");
    this.element.hidden = false;
    this.makeTransport();
  }

  makeTransport() {
    this.playButton = button("Play", () => this.toggle(), { title: "Play or pause (space)" });
    this.speedChoice = el("select", { "aria-label": "Speed" }, ...kSpeeds.map((one) => el("option", { value: one }, `${one} ×`)));
    this.speedChoice.addEventListener("change", () => this.setSpeed(Number(this.speedChoice.value)));
    this.envChoice = el("select", { "aria-label": "Environment" }, ...this.run.envs.map((_, n) => el("option", { value: n }, envName(this.run, n))));
    this.envChoice.addEventListener("change", () => this.page.view.chooseEnv(Number(this.envChoice.value)));
    this.clock = el("span", { className: "clock" });
    this.scrub = el("input", { type: "range", min: 0, max: 0, step: 1, value: 0, "aria-label": "Step" });
    this.scrub.addEventListener("input", () => this.go(Number(this.scrub.value)));
    this.marks = new Marks((frame) => this.go(frame));
    this.curvePart = el("div");
    this.curveButtons = kCurves.map((name) => button(name, () => this.toggleCurve(name)));
    this.element.replaceChildren(
      el("div", { className: "transport" }, this.playButton,
        button("◀", () => this.step(-1), { title: "One step back (left)", "aria-label": "One step back" }),
        button("▶", () => this.step(1), { title: "One step on (right)", "aria-label": "One step on" }),
        this.speedChoice, this.run.envs.length > 1 ? this.envChoice : "", this.clock, el("span", { className: "space" }), ...this.curveButtons),
      el("div", { className: "track" }, this.scrub, this.marks.element), this.curvePart);
  }

  /// Speed and curves are as the address says.
  applyAddress() {
    this.setSpeed(nearestSpeed(addressNumber("speed", 1)));
    const wanted = (address.get("curves") ?? kFirstCurves).split(",");
    this.showCurves(kCurves.filter((name) => wanted.includes(name)));
  }

  /// Of the shown env.
  get steps() { return this.track ? this.track.frameCount - 1 : 0; }

  /// Another env, at a frame of it.
  setTrack(track, frame) {
    this.pause();
    this.track = track;
    this.scrub.max = this.steps;
    this.envChoice.value = this.page.view.env;
    this.marks.setTrack(track);
    const width = this.run.distances.length;
    const held = Array.from({ length: track.frameCount }, (_, frame) => (track.held(frame) >= 0 ? 1 : 0));
    const bits = (bit) => Array.from(track.events, (events) => (events & bit ? 1 : 0));
    this.charts = [
      { name: "Reward", series: [{ name: "of the step", values: [...track.rewards], first: 1 }] },
      { name: "Distance", unit: "m", series: this.run.distances.map((name, n) => ({ name: name.replace("_", " to "), values: track.column(track.distances, width, n), first: 1 })) },
      { name: "Contact", series: [{ name: "holds", values: held, first: 0 }, { name: "refused", values: bits(kEvents.refuse), first: 1 }, { name: "slid", values: bits(kEvents.slide), first: 1 }] },
      { name: "Actions", series: this.run.actions.map((name, n) => ({ name, values: track.column(track.actions, this.run.actions.length, n), first: 1 })) },
    ];
    this.makeCurves();
    this.setFrame(frame);
  }

  makeCurves() {
    const shown = this.charts.filter((one) => this.shownCurves.has(one.name));
    this.curves = new Curves(shown, this.track.frameCount, (frame) => this.go(frame));
    this.curvePart.replaceChildren(this.curves.element);
    this.curves.setCursor(this.frame);
  }

  toggleCurve(name) {
    const isShown = (one) => this.shownCurves.has(one) !== (one === name);
    this.showCurves(kCurves.filter(isShown));
    setAddress({ curves: [...this.shownCurves].join(",") });
  }

  showCurves(names) {
    this.shownCurves = new Set(names);
    this.curveButtons.forEach((one, n) => one.setAttribute("aria-pressed", this.shownCurves.has(kCurves[n])));
    if (this.track) this.makeCurves();
  }

  /// Where somebody wants to be: the run stops there.
  go(frame) {
    this.pause();
    return this.show(frame);
  }

  show(frame) {
    this.setFrame(frame);
    return this.onFrame();
  }

  setFrame(frame) {
    this.frame = Math.max(0, Math.min(this.steps, frame));
    this.scrub.value = this.frame;
    const what = this.track.isIdle(this.frame) ? "idle" : `episode ${this.track.episode(this.frame)}`;
    this.clock.textContent = `Step ${this.frame} of ${this.steps}, ${what}`;
    this.scrub.setAttribute("aria-valuetext", this.clock.textContent);
    this.curves.setCursor(this.frame);
  }

  step(by) { this.go(this.frame + by); }

  toggle() {
    if (this.playing) this.pause();
    else this.play();
  }

  play() {
    if (this.frame >= this.steps) this.show(0);
    this.playButton.textContent = "Pause";
    const playing = { frame: this.frame, time: performance.now() };
    this.playing = playing;
    const tick = async (now) => {
      // Somebody may have paused, and even gone on from elsewhere, while a frame was made ready.
      if (this.playing !== playing) return;
      playing.frame += Math.min(kMostAtOnce, (now - playing.time) / 1000) * this.run.steps_per_second * this.speed;
      playing.time = now;
      const frame = Math.min(this.steps, Math.floor(playing.frame));
      if (frame !== this.frame) await this.show(frame);
      else this.onBetween(frame, playing.frame - frame);
      if (this.playing !== playing) return;
      if (frame >= this.steps) this.pause();
      else requestAnimationFrame(tick);
    };
    requestAnimationFrame(tick);
  }

  pause() {
    this.playing = null;
    this.playButton.textContent = "Play";
  }

  setSpeed(speed) {
    this.speed = speed;
    this.speedChoice.value = speed;
    setAddress({ speed: speed === 1 ? null : speed });
  }

  key(event) {
    const at = kSpeeds.indexOf(this.speed);
    const by = event.shiftKey ? 10 : 1;
    const actions = {
      " ": () => this.toggle(), ArrowRight: () => this.step(by), ArrowLeft: () => this.step(-by),
      Home: () => this.go(0), End: () => this.go(this.steps),
      "+": () => this.setSpeed(kSpeeds[Math.min(kSpeeds.length - 1, at + 1)]), "-": () => this.setSpeed(kSpeeds[Math.max(0, at - 1)]),
    };
    if (!actions[event.key]) return false;
    actions[event.key]();
    return true;
  }
}
