// A home as an episode begins in it: scene, robot, objects, target and goal. Episodes and runs show it.
import { Box3, BufferGeometry, Group, LineBasicMaterial, LineDashedMaterial, LineSegments, Vector3 } from "three";
import { boxLines, ObjectFigure, RobotFigure } from "./figures.js";
import { Grid } from "./grid.js";
import { GridLayer } from "./grid_layer.js";
import { Pose } from "./kinematics.js";
import { disposeOf } from "./stage.js";

const kTargetColor = 0xe69f00;
const kGoalColor = 0x009e73;

/// The episodes of a pack as objects.
export class EpisodeList {
  static async load(data, stored) {
    const list = new EpisodeList();
    Object.assign(list, stored, await data.arrays(stored.data));
    return list;
  }

  /// Target and scene of an episode.
  titleOf(n) {
    const [scene, first, , target] = this.numbers.subarray(4 * n, 4 * n + 4);
    return `${this.objects[this.placed[first + target]]}, ${this.scenes[scene]}`;
  }

  /// The one of this number in its pack.
  withNumber(number) { return this.at(this.which.indexOf(number)); }

  at(n) {
    const [scene, first, count, target] = this.numbers.subarray(4 * n, 4 * n + 4);
    const [x, y, z, yaw] = this.starts.subarray(11 * n, 11 * n + 4);
    const placements = [];
    for (let p = first; p < first + count; ++p) {
      placements.push({ object: this.objects[this.placed[p]], pose: Pose.of(this.poses, 7 * p) });
    }
    return {
      number: this.which[n], scene: this.scenes[scene], placements, target, base: { x, y, z, yaw },
      goal: Pose.of(this.starts, 11 * n + 4),
      joints: this.joints.subarray(n * this.start_joints.length, (n + 1) * this.start_joints.length),
    };
  }
}

export class Home {
  constructor(page) {
    this.page = page;
    this.objects = [];
    this.group = new Group();
    this.shown = { scene: true, mesh: true, spheres: false, boxes: false, marks: false };
    page.stage.content.add(this.group);
  }

  async open() {
    const { robotPack, library } = this.page;
    if (robotPack) {
      this.robot = await RobotFigure.load(library, robotPack);
      this.group.add(this.robot.group);
      // A world for physics alone: then what it collides with is what there is to see.
      const isBare = !robotPack.meshes && !robotPack.robot.links.some((one) => one.surface);
      this.shown.spheres = this.shown.boxes = isBare;
    }
  }

  /// The scene that is shown, if it is of this name, or another one.
  async sceneOf(name) {
    if (this.scene?.name === name) return this.scene;
    const pack = this.page.scenes.get(name);
    const mesh = pack ? await this.page.library.model(pack.meshes, 0, { cut: true }) ?? await this.floorsOf(pack) : null;
    return { name, pack, mesh: mesh ?? new Group() };
  }

  /// For a scene without a mesh.
  async floorsOf(pack) {
    const layer = new GridLayer(this.page.stage, await Grid.load(this.page.data, pack.scene.grids[0]));
    layer.slice.visible = false;
    layer.setFloors(true);
    return layer.group;
  }

  /// Shows the start of an episode. Figures of objects are made anew where others are needed; the picture
  /// stays as it is until all is there. One call after the other: views have a queue for it.
  async setEpisode(episode) {
    const scene = await this.sceneOf(episode.scene);
    const objects = await Promise.all(episode.placements.map(({ object }) => this.objectFigure(object)));
    this.episode = episode;
    if (this.scene !== scene) this.setScene(scene);
    for (const one of this.objects) disposeOf(one.group);
    this.objects = objects;
    for (const one of objects) this.group.add(one.group);
    this.addTask(episode);
    this.placeStart(episode);
    this.show(this.shown);
  }

  setScene(scene) {
    if (this.scene) disposeOf(this.scene.mesh);
    this.reach?.close();
    this.reach = null;
    this.scene = scene;
    this.group.add(scene.mesh);
  }

  async objectFigure(name) {
    const found = this.page.objects.get(name);
    if (found) return ObjectFigure.load(this.page.library, found.pack, found.number);
    // Episodes alone: a cross where the object is.
    return { group: crossOf(0.05), stored: { box: [0, 0, 0, 0, 0, 0, 1], half_extents: [0.03, 0.03, 0.03] }, show() {}, setPose(pose) { this.group.position.copy(pose.position); } };
  }

  addTask({ target, goal }) {
    if (this.task) disposeOf(this.task);
    this.task = new Group();
    const { stored } = this.objects[target];
    const grown = stored.half_extents.map((half) => half + 0.01);
    this.targetBox = new Group();
    this.targetBox.add(boxLines(stored.box, grown, kTargetColor));
    const goalBox = new Group();
    goalBox.add(boxLines(stored.box, grown, kGoalColor));
    goalBox.position.copy(goal.position);
    goalBox.quaternion.copy(goal.rotation);
    this.way = new LineSegments(new BufferGeometry().setFromPoints([new Vector3(), new Vector3()]),
      new LineDashedMaterial({ color: kGoalColor, dashSize: 0.06, gapSize: 0.05, depthTest: false }));
    this.way.frustumCulled = false;
    this.task.add(this.targetBox, goalBox, this.way);
    this.group.add(this.task);
  }

  placeStart(episode) {
    episode.placements.forEach(({ pose }, n) => this.setObject(n, pose));
    if (!this.robot) return;
    const { x, y, z, yaw } = episode.base;
    const positions = [...this.robot.robot.start];
    this.page.episodes.start_joints.forEach((name, n) => {
      const link = this.robot.robot.links.find((one) => one.joint === name);
      if (link && link.position >= 0) positions[link.position] = episode.joints[n];
    });
    this.robot.setPose(this.robot.rootPose(x, y, z, yaw), positions);
  }

  setObject(number, pose) {
    this.objects[number].setPose(pose);
    if (number !== this.episode.target) return;
    this.targetBox.position.copy(pose.position);
    this.targetBox.quaternion.copy(pose.rotation);
    this.way.geometry.setFromPoints([pose.position, this.episode.goal.position]);
    this.way.computeLineDistances();
  }

  show(shown) {
    this.shown = shown;
    this.scene.mesh.visible = shown.scene;
    for (const one of this.objects) one.show(shown);
    this.robot?.show(shown);
    this.page.stage.draw();
  }

  /// Around the robot, target and goal.
  bounds() {
    const { placements, target, goal, base } = this.episode;
    const box = new Box3().setFromPoints([placements[target].pose.position, goal.position, new Vector3(base.x, base.y, base.z)]);
    box.expandByScalar(0.7);
    return this.robot ? box.union(this.robot.bounds()) : box;
  }

  /// The grid that tells what stands before a camera: of the smallest radius of 5 cm or more, else
  /// of the largest. null without the scene.
  async sightGrid() {
    const { scene } = this;
    const grids = scene.pack?.scene.grids;
    if (!grids) return null;
    scene.sight ??= Grid.load(this.page.data, grids.find((one) => one.radius >= 0.0499) ?? grids[grids.length - 1]);
    return scene.sight;
  }

  /// Where a sphere of the largest radius rolls from the robot's start: the floor that it can drive to.
  async setReach(isShown) {
    this.reach?.close();
    this.reach = null;
    const grids = this.scene.pack?.scene.grids;
    if (isShown && grids) {
      const grid = await Grid.load(this.page.data, grids[grids.length - 1]);
      const { x, y, z } = this.episode.base;
      this.reach = new GridLayer(this.page.stage, grid);
      const height = y + grid.radius + 0.02;
      this.reach.setHeight(height);
      const cell = grid.cellAt(x, z);
      const span = cell ? grid.spanAt(cell.k * grid.columns_x + cell.i, grid.codeOf(height)) : -1;
      if (span >= 0) this.reach.setReached(grid.reachFrom(span));
      this.group.add(this.reach.group);
    }
    this.page.stage.draw();
  }
}

function crossOf(size) {
  const group = new Group();
  const ends = [[size, 0, 0], [0, size, 0], [0, 0, size]].flatMap(([x, y, z]) => [new Vector3(x, y, z), new Vector3(-x, -y, -z)]);
  group.add(new LineSegments(new BufferGeometry().setFromPoints(ends), new LineBasicMaterial({ color: kTargetColor })));
  return group;
}
