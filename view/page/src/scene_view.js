// A scene: its mesh, and its column grids.
import { Box3, Plane, Vector3 } from "three";
import { address, addressNumber, setAddress } from "./address.js";
import { button, checkbox, el, heading, legendRow, meters, note, radios, slider, table } from "./dom.js";
import { Grid } from "./grid.js";
import { cssColor, GridLayer, kSliceColors } from "./grid_layer.js";
import { Queue } from "./queue.js";

/// Above the floor: where the mesh is cut so that one sees into the rooms, and where a slice meets furniture.
const kCutHeight = 1.6;
const kSliceHeight = 0.6;

export class SceneView {
  constructor(page, pack) {
    this.page = page;
    this.pack = pack;
    this.stored = pack.scene;
    this.layers = new Map();
    this.pinned = null;
    this.changes = new Queue();
  }

  async open() {
    const { stage, library } = this.page;
    this.mesh = await library.model(this.pack.meshes, 0, { cut: true });
    if (this.mesh) stage.content.add(this.mesh);
    // Without a mesh the floors are what there is to see.
    this.hasFloors = !this.mesh;
    const radius = addressNumber("radius", this.stored.grids[0].radius);
    await this.chooseGrid(this.stored.grids.find((one) => Math.abs(one.radius - radius) < 1e-6) ?? this.stored.grids[0]);
    stage.frame(this.bounds(), new Vector3(0.45, 1.25, 0.8));
    this.fillPanel();
    this.listen();
  }

  /// Of what there is to see.
  bounds() {
    const bounds = this.mesh ? new Box3().setFromObject(this.mesh) : new Box3(new Vector3(...this.stored.min), new Vector3(...this.stored.max));
    if (this.isCut) bounds.max.y = Math.min(bounds.max.y, Math.max(bounds.min.y, this.layer.height));
    return bounds;
  }

  /// Another part of the page is opened.
  async close() {
    await this.changes.idle();
    for (const layer of this.layers.values()) layer.close();
  }

  async chooseGrid(stored) {
    if (!this.layers.has(stored)) {
      this.layers.set(stored, new GridLayer(this.page.stage, await Grid.load(this.page.data, stored)));
    }
    this.height ??= addressNumber("slice", null);
    this.layer?.group.removeFromParent();
    this.layer = this.layers.get(stored);
    this.page.stage.content.add(this.layer.group);
    this.pinned = null;
    this.isCut ??= address.get("cut") !== "0";
    this.showSlice(this.isSliced ?? address.get("sliced") === "1");
    this.layer.setFloors(this.hasFloors);
    if (this.panel) this.fillPanel();
  }

  /// Cut and slice are at this height, or at the usual one while nobody chose another.
  place() {
    const { grid } = this.layer;
    const height = this.height ?? grid.floorHeight() + (this.isSliced ? kSliceHeight : kCutHeight);
    this.layer.setHeight(Math.min(grid.high, Math.max(grid.low, height)));
    this.heightSlider?.set(this.layer.height);
    this.page.stage.setCut(this.isCut ? this.layer.height : null);
  }

  setHeight(height) {
    this.height = height;
    this.place();
    setAddress({ slice: height.toFixed(3) });
  }

  showSlice(isSliced) {
    this.isSliced = isSliced;
    this.layer.slice.visible = isSliced;
    setAddress({ sliced: isSliced ? 1 : null });
    this.place();
  }

  setCut(isCut) {
    this.isCut = isCut;
    setAddress({ cut: isCut ? null : 0 });
    this.place();
  }

  fillPanel() {
    const { grid } = this.layer;
    const step = Math.max(0.005, grid.quantum);
    this.heightSlider = slider("Height of cut and slice", { least: grid.low, most: grid.high, step, value: this.layer.height, format: meters }, (value) => this.setHeight(value));
    this.columnPart = el("div");
    this.reachPart = el("div");
    this.panel = [
      heading("Show"),
      this.mesh ? checkbox("Mesh", this.mesh.visible, (on) => { this.mesh.visible = on; this.page.stage.draw(); }) : note("Baked without render meshes."),
      this.page.shadeBox(),
      checkbox("Slice: where the sphere's center is free", this.isSliced, (on) => this.showSlice(on)),
      checkbox("Cut off what is above", this.isCut, (on) => this.setCut(on)),
      checkbox("Floors of all spans, colored by height", this.hasFloors, (on) => { this.hasFloors = on; this.layer.setFloors(on); }),
      heading("Sphere radius"),
      ...radios("radius", this.stored.grids.map((one) => [meters(one.radius), one]), this.stored.grids.find((one) => one.radius === grid.radius),
        (stored) => { setAddress({ radius: stored.radius }); this.changes.add(() => this.chooseGrid(stored)); }),
      this.heightSlider,
      ...[["free", "Free for the sphere's center"], ["reached", "Reached from the marked place"], ["blocked", "Blocked"]]
        .map(([key, text]) => legendRow(cssColor(kSliceColors[key]), text)),
      heading("Column"),
      this.columnPart,
      this.reachPart,
      heading("Grid"),
      this.gridTable(grid),
      ...this.regionTable(grid),
    ];
    this.page.fillPanel(this.panel);
    this.showCell(this.pinned?.cell ?? null);
  }

  gridTable(grid) {
    return table([["Columns", `${grid.columns_x} × ${grid.columns_z}`], ["Spacing", meters(grid.spacing)], ["Spans", grid.spans],
      ["Heights", `${grid.low.toFixed(3)} to ${grid.high.toFixed(3)} m`], ["Mesh triangles", this.pack.meshes?.models[0]?.triangles ?? 0]]);
  }

  /// The parts of space that the bake told apart.
  regionTable(grid) {
    const facts = this.pack.facts?.scene?.column_grids?.find((one) => Math.abs(one.radius - grid.radius) < 1e-6);
    const regions = facts?.statistics?.regions;
    if (!regions?.length) return [];
    return [heading("What the bake found"), table(regions.map((one) => [one.region, one.components, one.volume.toFixed(2)]), ["region", "parts", "m³"])];
  }

  showCell(cell) {
    this.layer.showColumn(cell);
    if (!cell) {
      this.columnPart.replaceChildren(note("Show the slice, and point at it to read a column; click to mark it and to see where the sphere gets from there."));
      return;
    }
    const { grid } = this.layer;
    const { x, z } = grid.centerOf(cell);
    const spans = grid.spansOf(cell);
    this.columnPart.replaceChildren(
      note(`Cell (${cell.i}, ${cell.k}), x ${x.toFixed(3)} m, z ${z.toFixed(3)} m`),
      spans.length === 0 ? note("Blocked at all heights.")
        : table(spans.map((one, n) => [n, one.from.toFixed(4), one.to.toFixed(4), (one.to - one.from).toFixed(4)]), ["span", "from", "to", "height"]));
    this.page.readout(spans.length === 0 ? "" : `(${x.toFixed(2)}, ${z.toFixed(2)}): ` + spans.map((one) => `${one.from.toFixed(3)} to ${one.to.toFixed(3)} m`).join(", "));
  }

  /// The cell of the slice under the pointer.
  cellUnder(event) {
    const plane = new Plane(new Vector3(0, 1, 0), -this.layer.height);
    const point = this.page.stage.rayAt(event).ray.intersectPlane(plane, new Vector3());
    return point ? this.layer.grid.cellAt(point.x, point.z) : null;
  }

  mark(cell) {
    const { grid } = this.layer;
    const span = cell ? grid.spanAt(cell.k * grid.columns_x + cell.i, grid.codeOf(this.layer.height)) : -1;
    this.pinned = cell ? { cell } : null;
    this.showCell(cell);
    if (span < 0) {
      this.layer.setReached(null);
      this.reachPart.replaceChildren();
      return;
    }
    const reached = grid.reachFrom(span);
    const part = grid.extentOf(reached);
    const whole = grid.extentOf(new Uint8Array(reached.length).fill(1));
    this.layer.setReached(reached);
    this.reachPart.replaceChildren(
      note(`From here the sphere gets to ${((100 * part.volume) / whole.volume).toFixed(1)} % of the free space.`),
      table([["Reached", part.area.toFixed(2), part.volume.toFixed(2)], ["All", whole.area.toFixed(2), whole.volume.toFixed(2)]], ["", "m²", "m³"]),
      el("div", { className: "buttons" }, button("Forget the mark", () => this.mark(null))));
  }

  listen() {
    const { canvas } = this.page.stage;
    let down = null;
    this.page.on(canvas, "pointermove", (event) => {
      if (event.buttons === 0 && !this.pinned && this.isSliced) this.showCell(this.cellUnder(event));
    });
    this.page.on(canvas, "pointerdown", (event) => { down = [event.clientX, event.clientY]; });
    this.page.on(canvas, "pointerup", (event) => {
      const moved = down ? Math.hypot(event.clientX - down[0], event.clientY - down[1]) : 9;
      if (moved < 4 && event.button === 0 && this.isSliced) this.mark(this.cellUnder(event));
    });
  }

  key(event) {
    const step = event.shiftKey ? 0.1 : 0.01;
    const change = { PageUp: step, PageDown: -step }[event.key];
    if (!change) return false;
    const { grid } = this.layer;
    this.setHeight(Math.min(grid.high, Math.max(grid.low, this.layer.height + change)));
    return true;
  }
}
