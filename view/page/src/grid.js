// Column grids: spans of free heights over each cell of the floor. view/page_grid.h is the writer.

export class Grid {
  constructor(stored, { counts, differences }) {
    Object.assign(this, stored);
    this.columns = stored.columns_x * stored.columns_z;
    this.first = new Uint32Array(this.columns + 1);
    this.codes = new Uint16Array(differences.length);
    let at = 0;
    let before = [];
    for (let column = 0; column < this.columns; ++column) {
      const now = [];
      for (let n = 0; n < 2 * counts[column]; ++n, ++at) {
        this.codes[at] = differences[at] + (before[n] ?? 0);
        now.push(this.codes[at]);
      }
      before = now;
      this.first[column + 1] = at / 2;
    }
  }

  static async load(data, stored) {
    return new Grid(stored, await data.arrays(stored.data));
  }

  height(code) { return this.low + code * this.quantum; }
  codeOf(height) { return (height - this.low) / this.quantum; }

  /// The cell over which a point of the floor lies; null outside the grid.
  cellAt(x, z) {
    const i = Math.floor((x - this.min_x) / this.spacing);
    const k = Math.floor((z - this.min_z) / this.spacing);
    return i >= 0 && k >= 0 && i < this.columns_x && k < this.columns_z ? { i, k } : null;
  }

  centerOf({ i, k }) {
    return { x: this.min_x + (i + 0.5) * this.spacing, z: this.min_z + (k + 0.5) * this.spacing };
  }

  spansOf({ i, k }) {
    const column = k * this.columns_x + i;
    const spans = [];
    for (let n = this.first[column]; n < this.first[column + 1]; ++n) {
      spans.push({ number: n, from: this.height(this.codes[2 * n]), to: this.height(this.codes[2 * n + 1]) });
    }
    return spans;
  }

  /// The height at which most of the free space begins: a sphere's center over the floor. Spans count by their heights,
  /// in steps of 10 cm; what begins at the lower end of the grid has no floor.
  floorHeight() {
    if (this.floor_height !== undefined) return this.floor_height;
    const width = 0.1 / this.quantum;
    const count = this.codes.reduce((most, code) => Math.max(most, code), 0) / width + 1;
    const [spaces, sums] = [new Float64Array(count), new Float64Array(count)];
    for (let n = 0; n < this.codes.length; n += 2) {
      const [from, space] = [this.codes[n], this.codes[n + 1] - this.codes[n]];
      if (from === 0) continue;
      const step = Math.floor(from / width);
      spaces[step] += space;
      sums[step] += space * from;
    }
    const most = spaces.reduce((best, space, step) => (space > spaces[best] ? step : best), 0);
    this.floor_height = this.height(spaces[most] > 0 ? sums[most] / spaces[most] : 0);
    return this.floor_height;
  }

  /// The span of a column at a height, as a number of all spans; -1 where it is blocked.
  spanAt(column, code) {
    for (let n = this.first[column]; n < this.first[column + 1]; ++n) {
      if (this.codes[2 * n] <= code && code <= this.codes[2 * n + 1]) return n;
    }
    return -1;
  }

  /// Whether a sphere at a point is free; outside the grid it is not.
  isFree({ x, y, z }) {
    const cell = this.cellAt(x, z);
    return cell !== null && this.spanAt(cell.k * this.columns_x + cell.i, this.codeOf(y)) >= 0;
  }

  /// Where a sphere gets from a span by way of neighboring columns whose spans overlap: 1 for each
  /// span that it reaches.
  reachFrom(start) {
    const reached = new Uint8Array(this.codes.length / 2);
    const columnOf = new Uint32Array(reached.length);
    for (let column = 0; column < this.columns; ++column) {
      columnOf.fill(column, this.first[column], this.first[column + 1]);
    }
    const stack = [start];
    reached[start] = 1;
    while (stack.length > 0) {
      const span = stack.pop();
      const column = columnOf[span];
      const i = column % this.columns_x;
      const low = this.codes[2 * span];
      const high = this.codes[2 * span + 1];
      const neighbors = [i > 0 ? column - 1 : -1, i + 1 < this.columns_x ? column + 1 : -1,
        column - this.columns_x, column + this.columns_x];
      for (const next of neighbors) {
        if (next < 0 || next >= this.columns) continue;
        for (let n = this.first[next]; n < this.first[next + 1]; ++n) {
          if (reached[n] || this.codes[2 * n] > high || this.codes[2 * n + 1] < low) continue;
          reached[n] = 1;
          stack.push(n);
        }
      }
    }
    return reached;
  }

  /// Square meters of columns, and cubic meters of heights, with a span that counts.
  extentOf(counts) {
    const cell = this.spacing * this.spacing;
    let columns = 0;
    let height = 0;
    for (let column = 0; column < this.columns; ++column) {
      let any = false;
      for (let n = this.first[column]; n < this.first[column + 1]; ++n) {
        if (!counts[n]) continue;
        any = true;
        height += (this.codes[2 * n + 1] - this.codes[2 * n]) * this.quantum;
      }
      if (any) ++columns;
    }
    return { area: columns * cell, volume: height * cell };
  }
}
