// An object: mesh, oriented box, spheres by radius, stable poses.
import { Box3, Quaternion, Vector3 } from "three";
import { addressNumber, setAddress } from "./address.js";
import { button, checkbox, el, heading, meters, note, swatch, table } from "./dom.js";
import { ObjectFigure } from "./figures.js";
import { Pose } from "./kinematics.js";

export class ObjectView {
  constructor(page, pack, number) {
    this.page = page;
    this.pack = pack;
    this.number = number;
    this.shown = { mesh: true, spheres: true, boxes: true };
  }

  async open() {
    const { stage, library } = this.page;
    this.figure = await ObjectFigure.load(library, this.pack, this.number);
    this.stored = this.figure.stored;
    this.hidden = new Set();
    stage.content.add(this.figure.group);
    stage.addFloor(4 * Math.max(...this.stored.half_extents));
    this.setPose(Math.max(0, Math.min(this.stored.stable_poses.length - 1, addressNumber("pose", 0))));
    stage.frame(new Box3().setFromObject(this.figure.group));
    this.fillPanel();
  }

  setPose(number) {
    const { rotation, height } = this.stored.stable_poses[number];
    this.pose = number;
    this.figure.setPose(new Pose(new Vector3(0, height, 0), new Quaternion(...rotation)));
    setAddress({ pose: number === 0 ? null : number });
    this.page.stage.draw();
  }

  toggle(layer, on) {
    this.shown[layer] = on;
    this.figure.show(this.shown);
    this.page.stage.draw();
  }

  fillPanel() {
    const { spheres, stable_poses: poses, half_extents: half } = this.stored;
    const counts = new Map();
    for (let n = 3; n < spheres.length; n += 4) counts.set(spheres[n], (counts.get(spheres[n]) ?? 0) + 1);
    const poseButtons = poses.map((one, n) => button(`${n + 1}: ${(100 * one.likelihood).toFixed(1)} %`, () => {
      this.setPose(n);
      poseButtons.forEach((other, m) => other.setAttribute("aria-pressed", m === n));
    }, { "aria-pressed": n === this.pose }));
    const model = this.pack.meshes?.models.find((one) => one.part === this.number);
    this.page.fillPanel([
      heading("Show"),
      checkbox("Mesh", true, (on) => this.toggle("mesh", on)),
      this.page.shadeBox(),
      checkbox("Oriented box: resting", true, (on) => this.toggle("boxes", on), swatch("#d55e00")),
      checkbox("Spheres: held", true, (on) => this.toggle("spheres", on)),
      heading("Spheres by radius"),
      ...[...counts].sort((a, b) => a[0] - b[0]).map(([radius, count]) => checkbox(`${meters(radius)}: ${count}`, true, (on) => {
        if (on) this.hidden.delete(radius); else this.hidden.add(radius);
        this.figure.cloud.showRadii((one) => !this.hidden.has(one));
        this.page.stage.draw();
      }, swatch(this.figure.palette.color(radius), true))),
      heading("Stable poses"),
      note("How it rests, with the share of random drops that end so."),
      el("div", { className: "buttons" }, ...poseButtons),
      heading("Numbers"),
      table([["Spheres", spheres.length / 4], ["Box", half.map((one) => (200 * one).toFixed(1)).join(" × ") + " cm"], ["Triangles", model?.triangles ?? "none"]]),
    ]);
  }
}
