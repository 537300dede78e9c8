// A run, unpacked: view/page_run.h is the writer.
import { mixedPositions, Pose } from "./kinematics.js";

/// Columns of differences as columns of values.
function undoDeltas(table, columns) {
  const rows = table.length / columns;
  for (let column = 0; column < columns; ++column) {
    for (let row = 1; row < rows; ++row) table[column * rows + row] += table[column * rows + row - 1];
  }
  return { rows, at: (row, column) => table[column * rows + row] };
}

/// What an env of a run is called.
export const envName = (run, number) => run.names?.[number] ?? `Env ${number}`;

export const kEvents = { grasp: 1, drop: 2, restore: 4, refuse: 8, slide: 16 };
export const kEndings = ["", "success", "said done too early", "let go away from the goal", "grasped another object", "out of time"];

export class Track {
  static async load(data, run, number) {
    const track = new Track();
    const arrays = await data.arrays(run.envs[number]);
    Object.assign(track, arrays, { run });
    track.table = undoDeltas(arrays.frames.slice(), 9 + run.positions);
    track.frameCount = track.table.rows;
    track.moveTable = undoDeltas(arrays.moves.slice(), 9);
    track.begins = new Uint32Array(track.frameCount);
    for (let frame = 1; frame < track.frameCount; ++frame) {
      track.begins[frame] = track.endings[frame - 1] === 0 ? track.begins[frame - 1] : frame;
    }
    return track;
  }

  pose(table, row, first) {
    const { length_step: length, rotation_step: turn } = this.run;
    const numbers = [0, 1, 2].map((n) => table.at(row, first + n) * length).concat([3, 4, 5, 6].map((n) => table.at(row, first + n) * turn));
    const pose = Pose.of(numbers);
    pose.rotation.normalize();
    return pose;
  }

  root(frame) { return this.pose(this.table, frame, 0); }
  joints(frame) {
    return Array.from({ length: this.run.positions }, (_, n) => this.table.at(frame, 7 + n) * this.run.length_step);
  }
  held(frame) { return this.table.at(frame, 7 + this.run.positions); }
  episode(frame) { return this.table.at(frame, 8 + this.run.positions); }

  /// Whether the env has played its share of the episodes: it stays as it is.
  isIdle(frame) { return this.idle[frame] !== 0; }

  /// The frame in which the episode of a frame began: after an ending, or the first.
  beginOf(frame) { return this.begins[frame]; }

  /// Rows of moves are in the order of their frames: the first one that is not before a frame.
  firstMoveAt(frame) {
    let [low, high] = [0, this.moveTable.rows];
    while (low < high) {
      const middle = (low + high) >> 1;
      if (this.moveTable.at(middle, 0) < frame) low = middle + 1;
      else high = middle;
    }
    return low;
  }

  /// Poses of the objects that are elsewhere than the episode has them, by placement.
  movedObjects(frame) {
    const begin = this.beginOf(frame);
    const moved = new Map();
    for (let row = this.firstMoveAt(begin); row < this.moveTable.rows && this.moveTable.at(row, 0) <= frame; ++row) {
      moved.set(this.moveTable.at(row, 1), row);
    }
    return new Map([...moved].map(([placement, row]) => [placement, this.pose(this.moveTable, row, 2)]));
  }

  /// Whether the next frame is of the same episode.
  goesOn(frame) { return frame + 1 < this.frameCount && this.endings[frame] === 0; }

  /// A share of the way to the next frame: poses a robot, and calls `setObject(placement, pose)` for what it holds.
  showBetween(frame, share, robot, setObject) {
    if (!this.goesOn(frame)) return;
    const next = frame + 1;
    robot?.setPose(this.root(frame).mixed(this.root(next), share),
      mixedPositions(robot.robot.links, this.joints(frame), this.joints(next), share));
    const held = this.held(frame);
    if (held < 0 || held !== this.held(next)) return;
    const [from, to] = [this.movedObjects(frame).get(held), this.movedObjects(next).get(held)];
    if (from && to) setObject(held, from.mixed(to, share));
  }

  /// Numbers of a step by column: of `width` numbers for each.
  column(values, width, n) {
    return Array.from({ length: values.length / width }, (_, step) => values[step * width + n]);
  }
}
