// A robot: a slider for each joint, spheres, marks, and which parts touch each other.
import { checkbox, button, el, heading, legendRow, meters, note, slider, table } from "./dom.js";
import { marksBoxes, RobotFigure } from "./figures.js";
import { positionNames } from "./kinematics.js";
import { address, setAddress } from "./address.js";

const kUnlimited = 1e30;

export class RobotView {
  constructor(page, pack) {
    this.page = page;
    this.pack = pack;
    this.shown = { mesh: true, spheres: false, marks: true };
  }

  async open() {
    const { stage, library } = this.page;
    this.figure = await RobotFigure.load(library, this.pack);
    this.robot = this.figure.robot;
    this.pairs = this.figure.pairsApartAtStart();
    this.positions = [...this.robot.start];
    (address.get("joints") ?? "").split(",").forEach((text, n) => {
      const value = Number.parseFloat(text);
      if (n < this.positions.length && Number.isFinite(value)) this.positions[n] = value;
    });
    // Without a mesh the spheres are what there is to see.
    this.shown.spheres = !this.pack.meshes && !this.robot.links.some((one) => one.surface);
    stage.content.add(this.figure.group);
    this.touchPart = el("div", { role: "status" });
    this.fillPanel();
    this.update();
    this.figure.show(this.shown);
    const bounds = this.figure.bounds();
    stage.addFloor(2);
    stage.frame(bounds);
  }

  update() {
    this.figure.setPose(this.figure.rootPose(), this.positions);
    const pairs = this.figure.findTouching(this.pairs);
    this.touchPart.replaceChildren(...(pairs.length === 0
      ? [note("No parts touch that can be apart.")]
      : pairs.map(([a, b]) => el("div", { className: "warn" }, `${this.figure.groupName(a)} touches ${this.figure.groupName(b)}`))));
    this.touching = pairs;
    this.page.stage.draw();
  }

  set(number, value) {
    this.positions[number] = value;
    setAddress({ joints: this.positions.map((one) => Number(one.toFixed(4))).join(",") });
    this.update();
  }

  toggle(layer, on) {
    this.shown[layer] = on;
    this.figure.show(this.shown);
    this.page.stage.draw();
  }

  sliderOf(number, name, controlled) {
    const [lower, upper] = this.robot.limits[number];
    const least = Math.max(-Math.PI, Math.abs(lower) > kUnlimited ? -Math.PI : lower);
    const most = Math.abs(upper) > kUnlimited ? Math.PI : upper;
    const isAngle = this.robot.links.some((one) => one.position === number && (one.type === 1 || one.type === 2));
    const format = (value) => isAngle ? `${value.toFixed(2)} rad, ${((value * 180) / Math.PI).toFixed(0)}°` : meters(value);
    const row = slider(name, { least: lower < -Math.PI && Math.abs(lower) < kUnlimited ? lower : least, most, step: (most - least) / 500 || 0.001, value: this.positions[number], format }, (value) => this.set(number, value));
    if (controlled) row.input.title = `An action moves it up to ${controlled.step.toFixed(3)}`;
    this.rows[number] = row;
    return row;
  }

  fillPanel() {
    const names = positionNames(this.robot);
    const controlled = new Map(this.robot.controlled.map((one) => [one.position, one]));
    const rest = names.map((_, n) => n).filter((n) => !controlled.has(n));
    this.rows = [];
    const reset = () => {
      this.positions = [...this.robot.start];
      this.rows.forEach((row, n) => row?.set(this.positions[n]));
      setAddress({ joints: null });
      this.update();
    };
    const { grasp, camera, base } = this.robot;
    this.page.fillPanel([
      heading("Show"),
      checkbox("Mesh", this.shown.mesh, (on) => this.toggle("mesh", on)),
      this.page.shadeBox(),
      checkbox("Spheres", this.shown.spheres, (on) => this.toggle("spheres", on)),
      ...marksBoxes(this.figure, this.shown.marks, (on) => this.toggle("marks", on)),
      ...this.figure.palette.radii.map((radius) => legendRow(this.figure.palette.color(radius), meters(radius), true)),
      heading("Self-collision"),
      this.touchPart,
      heading("Joints that actions move"),
      ...[...controlled].map(([n, one]) => this.sliderOf(n, names[n], one)),
      el("div", { className: "buttons" }, button("Start pose", reset)),
      rest.length > 0 ? el("details", {}, el("summary", {}, `Other joints (${rest.length})`), ...rest.map((n) => this.sliderOf(n, names[n], null))) : null,
      heading("Numbers"),
      table([["Links", this.robot.links.length], ["Spheres", this.robot.groups.reduce((sum, one) => sum + one.spheres.length / 4, 0)],
        ["Pairs that can collide", this.pairs.length],
        ...(grasp ? [["Grasp radius", meters(grasp.radius)]] : []),
        ...(camera ? [["Camera", `${((camera.vertical_fov * 180) / Math.PI).toFixed(0)}° high`]] : []),
        ...(base ? [["Step of the base", `${meters(base.forward_step)}, ${((base.turn_step * 180) / Math.PI).toFixed(1)}°`]] : [])]),
    ]);
  }
}
