// What is drawn of a column grid: a slice at a height, the floor of all spans, one column's spans.
import {
  BoxGeometry, BufferAttribute, BufferGeometry, Color, DataTexture, DoubleSide, Group, Mesh, MeshBasicMaterial,
  NearestFilter, PlaneGeometry, SRGBColorSpace,
} from "three";
import { disposeOf, freeWith } from "./stage.js";

// Colors that people with color-blindness tell apart (Okabe and Ito), with their opacity.
export const kSliceColors = { free: [0, 114, 178, 100], reached: [0, 158, 115, 150], blocked: [20, 20, 24, 120], outside: [20, 20, 24, 30] };
export const cssColor = ([r, g, b]) => `rgb(${r} ${g} ${b})`;

/// From low to high: readable without colors, too (cividis).
const kHeightColors = [[0, 34, 78], [53, 69, 108], [102, 105, 112], [148, 142, 119], [200, 184, 102], [254, 232, 56]];

function heightColor(share) {
  const at = Math.min(0.9999, Math.max(0, share)) * (kHeightColors.length - 1);
  const [a, b] = [kHeightColors[Math.floor(at)], kHeightColors[Math.floor(at) + 1]];
  const color = new Color().setRGB(...a.map((c, n) => (c + (b[n] - c) * (at % 1)) / 255), SRGBColorSpace);
  return [color.r, color.g, color.b];
}

export class GridLayer {
  constructor(stage, grid) {
    this.stage = stage;
    this.grid = grid;
    this.group = new Group();
    this.reached = null;
    this.addSlice();
    this.addColumn();
  }

  addSlice() {
    const { columns_x: width, columns_z: depth, spacing } = this.grid;
    this.pixels = new Uint8Array(4 * width * depth);
    this.texture = new DataTexture(this.pixels, width, depth);
    this.texture.colorSpace = SRGBColorSpace;
    this.texture.magFilter = this.texture.minFilter = NearestFilter;
    const geometry = new PlaneGeometry(width * spacing, depth * spacing);
    geometry.rotateX(-Math.PI / 2);
    freeWith(geometry, () => this.texture.dispose());
    // The texture's first row is the least z.
    const uv = geometry.attributes.uv;
    for (let n = 0; n < uv.count; ++n) uv.setY(n, 1 - uv.getY(n));
    const material = new MeshBasicMaterial({ map: this.texture, transparent: true, side: DoubleSide, depthWrite: false });
    this.slice = new Mesh(geometry, material);
    this.slice.position.set(this.grid.min_x + (width * spacing) / 2, 0, this.grid.min_z + (depth * spacing) / 2);
    this.slice.renderOrder = 2;
    this.group.add(this.slice);
  }

  /// Frees all of it, also what is not shown.
  close() {
    if (this.floors) this.group.add(this.floors);
    disposeOf(this.group);
    this.box.dispose();
    this.barMaterial.dispose();
  }

  /// Moves the slice to a height of sphere centers and colors it.
  setHeight(height) {
    const { grid, pixels } = this;
    this.height = height;
    this.slice.position.y = height;
    const code = grid.codeOf(height);
    for (let column = 0; column < grid.columns; ++column) {
      const span = grid.spanAt(column, code);
      const isOutside = grid.first[column] === grid.first[column + 1];
      const color = span < 0 ? kSliceColors[isOutside ? "outside" : "blocked"] : this.reached?.[span] ? kSliceColors.reached : kSliceColors.free;
      pixels.set(color, 4 * column);
    }
    this.texture.needsUpdate = true;
    this.stage.draw();
  }

  setReached(reached) {
    this.reached = reached;
    this.setHeight(this.height);
  }

  addColumn() {
    this.column = new Group();
    this.column.renderOrder = 3;
    this.group.add(this.column);
    this.box = new BoxGeometry(1, 1, 1);
    this.barMaterial = new MeshBasicMaterial({ color: 0xe69f00, transparent: true, opacity: 0.85, depthTest: false });
  }

  /// Marks the spans of a cell; null: none.
  showColumn(cell) {
    this.column.clear();
    if (cell) {
      const { x, z } = this.grid.centerOf(cell);
      for (const span of this.grid.spansOf(cell)) {
        const bar = new Mesh(this.box, this.barMaterial);
        bar.scale.set(this.grid.spacing, Math.max(0.004, span.to - span.from), this.grid.spacing);
        bar.position.set(x, (span.from + span.to) / 2, z);
        bar.renderOrder = 3;
        this.column.add(bar);
      }
    }
    this.stage.draw();
  }

  /// The lower ends of all spans, colored by height: what a sphere rests on, seen at its center.
  setFloors(isShown) {
    if (isShown && !this.floors) this.floors = this.makeFloors();
    if (!this.floors) return;
    if (isShown) this.group.add(this.floors);
    else this.floors.removeFromParent();
    this.stage.draw();
  }

  makeFloors() {
    const { grid } = this;
    const strips = [];
    for (let k = 0; k < grid.columns_z; ++k) {
      let open = new Map();
      for (let i = 0; i < grid.columns_x; ++i) {
        const column = k * grid.columns_x + i;
        const still = new Map();
        for (let n = grid.first[column]; n < grid.first[column + 1]; ++n) {
          const code = grid.codes[2 * n];
          const strip = open.get(code) ?? { k, from: i, code };
          strip.to = i + 1;
          if (!open.has(code)) strips.push(strip);
          still.set(code, strip);
        }
        open = still;
      }
    }
    return this.meshOfStrips(strips);
  }

  meshOfStrips(strips) {
    const { grid } = this;
    const positions = new Float32Array(12 * strips.length);
    const colors = new Float32Array(12 * strips.length);
    const corners = new Uint32Array(6 * strips.length);
    const codes = strips.map((one) => one.code);
    const least = codes.reduce((a, b) => Math.min(a, b), Infinity);
    const most = codes.reduce((a, b) => Math.max(a, b), -Infinity);
    strips.forEach((strip, n) => {
      const y = grid.height(strip.code);
      const [x0, x1] = [grid.min_x + strip.from * grid.spacing, grid.min_x + strip.to * grid.spacing];
      const [z0, z1] = [grid.min_z + strip.k * grid.spacing, grid.min_z + (strip.k + 1) * grid.spacing];
      positions.set([x0, y, z0, x0, y, z1, x1, y, z1, x1, y, z0], 12 * n);
      const color = heightColor((strip.code - least) / Math.max(1, most - least));
      for (let corner = 0; corner < 4; ++corner) colors.set(color, 12 * n + 3 * corner);
      corners.set([0, 1, 2, 0, 2, 3].map((corner) => 4 * n + corner), 6 * n);
    });
    const geometry = new BufferGeometry();
    geometry.setAttribute("position", new BufferAttribute(positions, 3));
    geometry.setAttribute("color", new BufferAttribute(colors, 3));
    geometry.setIndex(new BufferAttribute(corners, 1));
    return new Mesh(geometry, new MeshBasicMaterial({ vertexColors: true, side: DoubleSide, clippingPlanes: this.stage.clippingPlanes }));
  }
}
