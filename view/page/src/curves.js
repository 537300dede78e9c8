// Curves under the picture, with a cursor: one small chart for each group of values.
import { el } from "./dom.js";

const kColors = ["--blue", "--orange", "--green", "--purple", "--sky", "--red"];
const kDashes = [[], [6, 3], [2, 3]];
const kHeight = 44;

export class Curves {
  /// `charts`: { name, series: [{ name, values, steps }] }; `onPick(frame)` when somebody points at one.
  constructor(charts, frames, onPick) {
    this.frames = frames;
    this.cursor = 0;
    this.charts = charts.map((chart) => this.makeChart(chart, onPick));
    this.element = el("div", { className: "curves" }, ...this.charts.flatMap((one) => [one.legend, one.canvas]));
    new ResizeObserver(() => this.draw()).observe(this.element);
  }

  makeChart(chart, onPick) {
    const canvas = el("canvas", { height: kHeight, role: "img", "aria-label": `Curves: ${chart.name}` });
    const outputs = chart.series.map(() => el("span", { className: "number" }));
    const legend = el("div", { className: "legend" }, el("b", {}, chart.unit ? `${chart.name}, ${chart.unit}` : chart.name), ...chart.series.map((one, n) => {
      const line = el("i");
      line.style.borderTopColor = `var(${kColors[n % kColors.length]})`;
      line.style.borderTopStyle = ["solid", "dashed", "dotted"][Math.floor(n / kColors.length) % 3];
      return el("span", {}, line, `${one.name} `, outputs[n]);
    }));
    const pick = (event) => {
      const area = canvas.getBoundingClientRect();
      onPick(Math.round(((event.clientX - area.left) / area.width) * (this.frames - 1)));
    };
    canvas.addEventListener("pointerdown", (event) => { canvas.setPointerCapture(event.pointerId); pick(event); });
    canvas.addEventListener("pointermove", (event) => { if (event.buttons) pick(event); });
    const all = chart.series.flatMap((one) => [one.values.reduce((a, b) => Math.min(a, b), 0), one.values.reduce((a, b) => Math.max(a, b), 0)]);
    const picture = el("canvas", { width: 0 });
    return { ...chart, canvas, picture, legend, outputs, least: Math.min(...all), most: Math.max(...all, 1e-6) };
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

  x(frame, width) { return (frame / Math.max(1, this.frames - 1)) * width; }

  /// The curves themselves, kept as a picture: long runs have a million steps.
  drawPicture(chart, style) {
    const ratio = devicePixelRatio;
    const width = chart.canvas.clientWidth;
    if (width === 0) return;
    const { picture } = chart;
    picture.width = chart.canvas.width = width * ratio;
    picture.height = chart.canvas.height = kHeight * ratio;
    const context = picture.getContext("2d");
    context.scale(ratio, ratio);
    const y = (value) => kHeight - 4 - ((value - chart.least) / (chart.most - chart.least)) * (kHeight - 8);
    context.strokeStyle = style.getPropertyValue("--line");
    context.strokeRect(0.5, 0.5, width - 1, kHeight - 1);
    context.beginPath();
    context.moveTo(0, y(0));
    context.lineTo(width, y(0));
    context.stroke();
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

  drawCursor({ canvas, picture, series, outputs }, ink) {
    series.forEach((one, n) => {
      const shown = one.values[this.cursor - one.first];
      outputs[n].textContent = shown === undefined ? "" : shown.toFixed(3).replace(/\.?0+$/, "");
    });
    if (picture.width === 0) return;
    const context = canvas.getContext("2d");
    const ratio = picture.height / kHeight;
    const x = this.x(this.cursor, picture.width);
    context.clearRect(0, 0, canvas.width, canvas.height);
    context.drawImage(picture, 0, 0);
    context.strokeStyle = ink;
    context.lineWidth = ratio;
    context.beginPath();
    context.moveTo(x, 0);
    context.lineTo(x, picture.height);
    context.stroke();
  }
}
