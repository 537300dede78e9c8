// A run: the home of an env, and a timeline that plays it.
import { Box3, Vector3 } from "three";
import { address, addressNumber, setAddress } from "./address.js";
import { button, checkbox, el, heading, keyOf, legendRow, meters, note, table, tree } from "./dom.js";
import { marksBoxes } from "./figures.js";
import { Ghost, kGhostColor } from "./ghost.js";
import { Home } from "./home.js";
import { Queue } from "./queue.js";
import { bestDirection, inSight } from "./sight.js";
import { Timeline } from "./timeline.js";
import { kEndings, Track } from "./track.js";

const kCameras = [["Free", "free"], ["Follow", "follow"], ["Robot's own", "own"]];

export class RunView {
  constructor(page, run) {
    this.page = page;
    this.run = run;
    this.env = 0;
    this.facts = el("div");
    this.changes = new Queue();
  }

  async open() {
    this.home = new Home(this.page);
    await this.home.open();
    this.timeline = new Timeline(this.page, this.run, {
      onFrame: () => this.go(), onBetween: (frame, share) => this.showBetween(frame, share),
    });
    this.cameraButtons = this.cameras.map(([text, key]) => button(text, () => this.setCamera(key), { value: key }));
    this.page.stage.beforeDraw = () => this.moveCamera();
    await this.applyAddress();
    this.fillPanel();
  }

  /// Those that there are.
  get cameras() { return kCameras.filter(([, key]) => key !== "own" || this.hasOwnCamera); }

  get hasOwnCamera() { return Boolean(this.home.robot.robot.camera); }

  /// Shows what the address says, when the run is opened and when a link leads into it. An env or a frame that a
  /// link does not name stays.
  async applyAddress() {
    this.timeline.applyAddress();
    await this.chooseEnv(addressNumber("env", this.env), addressNumber("t", this.frame));
    const [, camera] = this.cameras.find(([, key]) => key === address.get("camera")) ?? [null, "follow"];
    if (camera !== this.camera) this.setCamera(camera);
  }

  /// Facts of a pack stand beside it.
  pause() { this.timeline?.pause(); }

  /// Another part of the page is opened.
  close() {
    this.pause();
    return this.changes.idle();
  }

  /// The frame that is wanted: that of the picture, once it is unpacked.
  get frame() { return this.timeline.frame; }

  chooseEnv(wanted, frame = 0) {
    const number = Math.max(0, Math.min(this.run.envs.length - 1, Math.round(wanted)));
    this.timeline.pause();
    return this.changes.add(() => this.openEnv(number, frame));
  }

  async openEnv(number, frame) {
    this.env = number;
    this.track = await Track.load(this.page.data, this.run, number);
    const twin = this.run.twins?.[number];
    if (twin !== undefined) {
      this.ghost ??= await Ghost.load(this.page, this.home);
      this.ghost.setTrack(await Track.load(this.page.data, this.run, twin));
    }
    this.shownEpisode = null;
    this.timeline.setTrack(this.track, Math.round(frame));
    setAddress({ env: number });
    this.page.listPart?.("run", number);
    await this.showFrame();
  }

  frameHome() {
    const { stage } = this.page;
    const { robot } = this.home;
    const root = robot.poses[0].position;
    const around = new Box3().setFromCenterAndSize(root, new Vector3(2.2, 1.6, 2.2));
    const box = this.camera === "free" ? this.home.bounds() : around;
    // A robot that is followed stays in the middle.
    const middle = this.camera === "free" ? {} : { target: root };
    const points = robot.clouds.flatMap((_, n) => robot.centersOf(n)).map(({ center }) => center);
    const fit = (direction) => ({ ...stage.fit(box, direction), ...middle, ...stage.opening });
    stage.frame(box, this.sight ? bestDirection(this.sight, points, fit, this.cutHeight() ?? Infinity) : undefined);
    this.lastRoot = null;
  }

  go() { return this.changes.add(() => this.showFrame()); }

  /// What tells the episode of a frame from all others that are played.
  keyOf(frame) { return `${this.env} ${this.track.beginOf(frame)}`; }

  /// Shows the frame where somebody is by now. Another episode may want another scene, which has to be unpacked
  /// first; whoever goes on meanwhile has a task of his own waiting.
  async showFrame() {
    const { frame } = this;
    const key = this.keyOf(frame);
    if (this.shownEpisode !== key) {
      this.shownEpisode = null;
      await this.home.setEpisode(this.page.episodes.withNumber(this.track.episode(frame)));
      await this.ghost?.setEpisode(this.home.episode);
      this.sight = await this.home.sightGrid();
      if (this.hasReach) await this.home.setReach(true);
      this.cut();
      this.shownEpisode = key;
    }
    this.showPoses(frame);
  }

  showPoses(frame) {
    const { placements, target } = this.home.episode;
    const moved = this.track.movedObjects(frame);
    placements.forEach((one, n) => this.home.setObject(n, moved.get(n) ?? one.pose));
    if (this.run.target_only) this.home.objects.forEach((one, n) => { one.group.visible = n === target; });
    const { robot } = this.home;
    robot.setPose(this.track.root(frame), this.track.joints(frame));
    this.home.task.visible = !this.track.isIdle(frame);
    this.ghost?.show(frame, moved);
    setAddress({ t: frame });
    this.fillFacts(frame);
    this.page.stage.draw();
  }

  /// Between a frame and the next, while the run is played: robots and what they hold move evenly.
  showBetween(frame, share) {
    const { track, home } = this;
    if (this.shownEpisode !== this.keyOf(frame)) return;
    track.showBetween(frame, share, home.robot, (placement, pose) => home.setObject(placement, pose));
    this.ghost?.showBetween(frame, share);
    this.page.stage.draw();
  }

  /// Before each picture: the camera goes where the robot goes.
  moveCamera() {
    const { robot } = this.home;
    if (!robot?.poses) return;
    const { stage } = this.page;
    const { camera, controls } = stage;
    stage.seenFrom = null;
    if (this.camera === "own") {
      const own = robot.ownCamera();
      camera.position.copy(own.position);
      camera.quaternion.copy(own.quaternion);
      return;
    }
    const root = robot.poses[0].position;
    if (this.camera === "follow") {
      if (this.lastRoot) {
        const step = root.clone().sub(this.lastRoot);
        camera.position.add(step);
        controls.target.add(step);
      } else {
        const step = root.clone().sub(controls.target);
        camera.position.add(step);
        controls.target.add(step);
        camera.lookAt(controls.target);
      }
      this.lastRoot = root.clone();
      if (this.sight && this.home.shown.scene) {
        stage.seenFrom = inSight(this.sight, root, controls.target, camera.position, this.cutHeight() ?? Infinity);
      }
    }
  }

  /// So that one sees into the room from above; the robot sees its ceiling.
  cut() { this.page.stage.setCut(this.cutHeight()); }

  /// null: nothing is cut off.
  cutHeight() {
    const isCut = this.isCut !== false && this.camera !== "own";
    return isCut ? this.home.episode.base.y + 1.6 : null;
  }

  setReach(isShown) {
    this.hasReach = isShown;
    return this.changes.add(() => this.home.setReach(this.hasReach));
  }

  setCamera(key) {
    this.camera = key;
    this.cut();
    this.lastRoot = null;
    setAddress({ camera: key === "follow" ? null : key });
    const isOwn = key === "own";
    this.page.stage.setOwnCamera(isOwn ? this.home.robot.ownCamera() : null);
    if (!isOwn) this.frameHome();
    this.cameraButtons.forEach((one) => one.setAttribute("aria-pressed", one.value === key));
  }

  fillFacts(frame) {
    const { track } = this;
    const held = track.held(frame);
    const { placements, target } = this.home.episode;
    const ended = frame > 0 ? kEndings[track.endings[frame - 1]] : "";
    const isIdle = track.isIdle(frame);
    const rows = isIdle ? [["Episode", "idle: has played its share"]]
      : [["Episode", track.episode(frame)], ["Its step", frame - track.beginOf(frame)], ["Target", placements[target].object]];
    rows.push(["In the hand", held < 0 ? "nothing" : placements[held]?.object ?? ""]);
    // An env that is idle has no reward; of the step that ended its last episode there is one.
    if (frame > 0 && !track.isIdle(frame - 1)) {
      rows.push(["Reward", track.rewards[frame - 1].toFixed(4)]);
      this.run.distances.forEach((name, n) => rows.push([name.replace("_", " to "), meters(track.distances[(frame - 1) * this.run.distances.length + n])]));
    }
    this.facts.replaceChildren(table(rows), ended ? note(`The step before ended an episode: ${ended}.`) : "");
  }

  fillPanel() {
    const toggle = (key) => (on) => this.home.show({ ...this.home.shown, [key]: on });
    this.page.fillPanel([
      heading("Camera"),
      el("div", { className: "buttons" }, ...this.cameraButtons),
      heading("Now"),
      this.facts,
      heading("Show"),
      checkbox("Scene", true, toggle("scene")),
      this.page.shadeBox(),
      checkbox("Cut off what is above 1.6 m", true, (on) => { this.isCut = on; this.cut(); }),
      checkbox("Meshes of robot and objects", true, toggle("mesh")),
      checkbox("Spheres", this.home.shown.spheres, toggle("spheres")),
      checkbox("Oriented boxes", this.home.shown.boxes, toggle("boxes")),
      ...marksBoxes(this.home.robot, false, toggle("marks")),
      checkbox("Floor that it can drive to", false, (on) => this.setReach(on)),
      ...(this.ghost ? [checkbox("The same step in the other world", true, (on) => this.ghost.setShown(on))] : []),
      ...(this.ghost ? [legendRow(kGhostColor, "In the other world")] : []),
      legendRow("#e69f00", "Target"),
      legendRow("#009e73", "Goal"),
      ...this.momentList(),
      ...(this.run.facts ? [heading("About the run"), tree(this.run.facts, "facts")] : []),
    ]);
  }

  /// What the page points at: a click goes there.
  momentList() {
    const { moments } = this.run;
    if (!moments) return [];
    return [heading("Moments"), ...moments.map(({ env, frame, text }) =>
      el("div", { className: "buttons" }, button(text, () => this.chooseEnv(env, frame))))];
  }

  key(event) {
    const key = keyOf(event);
    if (key === "f") this.setCamera("follow");
    else if (key === "c") this.setCamera(this.hasOwnCamera && this.camera !== "own" ? "own" : "free");
    else return this.timeline.key(event);
    return true;
  }
}
