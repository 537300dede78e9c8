// Curves under the picture, with a cursor: one small chart for each group of values.
import { el, onResize } from "./dom.js";

const kColors = ["--blue", "--orange", "--green", "--purple", "--sky", "--red"];
const kDashes = [[], [6, 3], [2, 3]];
/// Pixels: of a chart, and of the numbers of steps below it. Those of values stand left of it, in the gutter that
/// the track has, too (style.css).
const kHeight = 52;
const kStepsHeight = 15;
const kGutter = 48;
const kFont = "11px system-ui, sans-serif";
/// Room for a number: from one grid line to the next, at least.
const kLineGap = 18;
const kStepGap = 90;

/// What steps from tick to tick may begin with, and what they may where only one tick would be in the range: nobody could
/// tell its scale.
const kSteps = [1, 2, 5, 10];
const kSmallerSteps = [5, 4, 2, 1, 0.5, 0.4, 0.2];

/// Round numbers from `least` to `most`, two at least: at most `count` gaps of 1, 2 or 5 times a power of ten, or smaller
/// gaps where one of those leads out of the range.
function ticksOf(least, most, count) {
  const rough = (most - least) / Math.max(1, count);
  const power = 10 ** Math.floor(Math.log10(rough));
  const usual = kSteps.find((one) => one * power >= rough * (1 - 1e-9));
  const ticksAt = (step) => {
    const [first, last] = [Math.ceil(least / step - 1e-9), Math.floor(most / step + 1e-9)];
    // Not -0.
    return Array.from({ length: last - first + 1 }, (_, n) => (first + n) * step || 0);
  };
  const steps = [usual, ...kSmallerSteps.filter((one) => one < usual)];
  return steps.map((one) => ticksAt(one * power)).find((ticks) => ticks.length > 1);
}

/// A value as it stands beside its grid line: 15 digits and more are those of a sum that was rounded.
const short = (value) => String(Number(value.toPrecision(6)));

export class Curves {
  /// `charts`: { name, unit, series: [{ name, values, first }] }; `onPick(frame)` when somebody points at one.
  constructor(charts, frames, onPick) {
    this.frames = frames;
    this.cursor = 0;
    this.charts = charts.map((chart) => this.makeChart(chart, onPick));
    this.element = el("div", { className: "curves" }, ...this.charts.flatMap((one) => [one.legend, one.canvas]));
    onResize(this.element, () => this.draw());
  }

  makeChart(chart, onPick) {
    const canvas = el("canvas", { height: kHeight + kStepsHeight, role: "img", "aria-label": `Curves: ${chart.name}` });
    const outputs = chart.series.map(() => el("span", { className: "number" }));
    const legend = el("div", { className: "legend" }, el("b", {}, chart.unit ? `${chart.name}, ${chart.unit}` : chart.name), ...chart.series.map((one, n) => {
      const line = el("i");
      line.style.borderTopColor = `var(${kColors[n % kColors.length]})`;
      line.style.borderTopStyle = ["solid", "dashed", "dotted"][Math.floor(n / kColors.length) % 3];
      return el("span", {}, line, `${one.name} `, outputs[n]);
    }));
    const pick = (event) => {
      const area = canvas.getBoundingClientRect();
      onPick(Math.round(((event.clientX - area.left - kGutter) / (area.width - kGutter)) * (this.frames - 1)));
    };
    canvas.addEventListener("pointerdown", (event) => { canvas.setPointerCapture(event.pointerId); pick(event); });
    canvas.addEventListener("pointermove", (event) => { if (event.buttons) pick(event); });
    const all = chart.series.flatMap((one) => [one.values.reduce((a, b) => Math.min(a, b), 0), one.values.reduce((a, b) => Math.max(a, b), 0)]);
    const [least, most] = [Math.min(...all), Math.max(...all)];
    const picture = el("canvas", { width: 0 });
    // Where nothing ever happens, the line of 0 lies at the bottom of a chart up to 1.
    return { ...chart, canvas, picture, legend, outputs, least, most: most > least ? most : least + 1 };
  }

  setCursor(frame) {
    this.cursor = frame;
    const ink = getComputedStyle(document.documentElement).getPropertyValue("--ink");
    for (const chart of this.charts) this.drawCursor(chart, ink);
  }

  /// All of it: in another size, or in other colors.
  draw() {
    const style = getComputedStyle(document.documentElement);
    for (const chart of this.charts) this.drawPicture(chart, style);
    this.setCursor(this.cursor);
  }

  /// Where a frame is on a canvas so many pixels wide.
  x(frame, width) { return kGutter + (frame / Math.max(1, this.frames - 1)) * (width - kGutter); }

  /// The curves themselves, kept as a picture: long runs have a million steps.
  drawPicture(chart, style) {
    const ratio = devicePixelRatio;
    const width = chart.canvas.clientWidth;
    if (width <= kGutter) return;
    const { picture } = chart;
    picture.width = chart.canvas.width = width * ratio;
    picture.height = chart.canvas.height = (kHeight + kStepsHeight) * ratio;
    const context = picture.getContext("2d");
    context.scale(ratio, ratio);
    const y = (value) => kHeight - 4 - ((value - chart.least) / (chart.most - chart.least)) * (kHeight - 8);
    this.drawAxes(context, chart, { y, width, style });
    chart.series.forEach((one, n) => {
      context.strokeStyle = style.getPropertyValue(kColors[n % kColors.length]);
      context.setLineDash(kDashes[Math.floor(n / kColors.length) % 3]);
      context.lineWidth = 1.4;
      context.beginPath();
      // Values of steps stand at the frame after the step.
      one.values.forEach((value, step) => context.lineTo(this.x(step + one.first, width), y(value)));
      context.stroke();
    });
  }

  /// The round values of a chart, as they are drawn.
  ticks(least, most) { return ticksOf(least, most, kHeight / kLineGap).map((value) => ({ value, text: short(value) })); }

  /// A grid line for each round value, with its number, and a mark for each round step.
  drawAxes(context, { least, most }, { y, width, style }) {
    const line = (fromX, fromY, toX, toY) => { context.moveTo(fromX, fromY); context.lineTo(toX, toY); };
    context.font = kFont;
    context.fillStyle = style.getPropertyValue("--soft");
    context.strokeStyle = style.getPropertyValue("--line");
    context.strokeRect(kGutter + 0.5, 0.5, width - kGutter - 1, kHeight - 1);
    context.beginPath();
    context.textAlign = "right";
    context.textBaseline = "middle";
    for (const { value, text } of this.ticks(least, most)) {
      line(kGutter, Math.round(y(value)) + 0.5, width, Math.round(y(value)) + 0.5);
      context.fillText(text, kGutter - 5, Math.max(6, y(value)));
    }
    context.textBaseline = "bottom";
    context.fillText("step", kGutter - 5, kHeight + kStepsHeight);
    // Steps are whole.
    for (const step of ticksOf(0, Math.max(1, this.frames - 1), (width - kGutter) / kStepGap).filter(Number.isInteger)) {
      const x = Math.min(width - 0.5, Math.round(this.x(step, width)) + 0.5);
      line(x, 0, x, kHeight + 3);
      const isLast = x > width - 20;
      context.textAlign = step === 0 ? "left" : isLast ? "right" : "center";
      context.fillText(String(step), x, kHeight + kStepsHeight);
    }
    context.stroke();
  }

  drawCursor({ canvas, picture, series, outputs }, ink) {
    series.forEach((one, n) => {
      const shown = one.values[this.cursor - one.first];
      outputs[n].textContent = shown === undefined ? "" : shown.toFixed(3).replace(/\.?0+$/, "");
    });
    if (picture.width === 0) return;
    const context = canvas.getContext("2d");
    const ratio = picture.height / (kHeight + kStepsHeight);
    const x = this.x(this.cursor, picture.width / ratio) * ratio;
    context.clearRect(0, 0, canvas.width, canvas.height);
    context.drawImage(picture, 0, 0);
    context.strokeStyle = ink;
    context.lineWidth = ratio;
    context.beginPath();
    context.moveTo(x, 0);
    context.lineTo(x, kHeight * ratio);
    context.stroke();
  }
}
