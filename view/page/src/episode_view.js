// Episodes, one after the other: placements, target, goal, robot start.
import { Vector3 } from "three";
import { button, checkbox, el, heading, keyOf, legendRow, note, table } from "./dom.js";
import { marksBoxes } from "./figures.js";
import { Home } from "./home.js";
import { Queue } from "./queue.js";

export class EpisodeView {
  constructor(page, number) {
    this.page = page;
    this.number = number;
    this.hasReach = false;
    this.changes = new Queue();
  }

  async open() {
    this.home = new Home(this.page);
    await this.home.open();
    this.facts = el("div");
    await this.go(this.number);
    this.fillPanel();
  }

  /// Another part of the page is opened.
  close() { return this.changes.idle(); }

  go(number) {
    this.number = Math.max(0, Math.min(this.page.episodes.count - 1, Math.round(number)));
    return this.changes.add(() => this.showEpisode());
  }

  /// Shows the episode where somebody is by now.
  async showEpisode() {
    const { number } = this;
    if (this.shown === number) return;
    const { episodes, stage } = this.page;
    const episode = episodes.at(number);
    await this.home.setEpisode(episode);
    this.shown = number;
    if (this.hasReach) await this.home.setReach(true);
    // Cut through the room at the height of a person, so that one sees into it.
    stage.setCut(this.isCut === false ? null : episode.base.y + 1.6);
    stage.frame(this.home.bounds(), new Vector3(0.5, 1.1, 0.8));
    this.fillFacts(episode);
    this.page.listPart?.("episode", number);
  }

  setReach(isShown) {
    this.hasReach = isShown;
    return this.changes.add(() => this.home.setReach(this.hasReach));
  }

  fillFacts(episode) {
    const { placements, target, goal, base } = episode;
    const place = placements[target].pose.position;
    const point = ({ x, y, z }) => [x, y, z].map((one) => one.toFixed(2)).join(", ");
    this.facts.replaceChildren(
      table([["Scene", episode.scene], ["Target", placements[target].object], ["Target at", point(place)], ["Goal at", point(goal.position)],
        ["From target to goal", `${place.distanceTo(goal.position).toFixed(3)} m`], ["Robot at", point(base)], ["Robot's yaw", `${base.yaw.toFixed(3)} rad`]]),
      heading(`Objects (${placements.length})`),
      el("ul", {}, ...placements.map((one, n) => el("li", {}, one.object + (n === target ? ", the target" : "")))));
    if (!this.page.scenes.has(episode.scene)) this.facts.prepend(note("The scene is in another pack: open the world to see it."));
  }

  fillPanel() {
    const toggle = (key) => (on) => this.home.show({ ...this.home.shown, [key]: on });
    this.page.fillPanel([
      heading("Episode"),
      el("div", { className: "buttons" }, button("Previous", () => this.go(this.number - 1)), button("Next", () => this.go(this.number + 1))),
      this.facts,
      heading("Show"),
      checkbox("Scene", true, toggle("scene")),
      this.page.shadeBox(),
      checkbox("Cut off what is above 1.6 m", true, (on) => { this.isCut = on; this.page.stage.setCut(on ? this.home.episode.base.y + 1.6 : null); }),
      checkbox("Meshes of robot and objects", true, toggle("mesh")),
      checkbox("Spheres", this.home.shown.spheres, toggle("spheres")),
      checkbox("Oriented boxes", this.home.shown.boxes, toggle("boxes")),
      ...marksBoxes(this.home.robot, false, toggle("marks")),
      checkbox("Floor that it can drive to", false, (on) => this.setReach(on)),
      legendRow("#e69f00", "Target"),
      legendRow("#009e73", "Goal"),
    ]);
  }

  key(event) {
    const step = { ArrowRight: 1, ArrowLeft: -1, n: 1, p: -1 }[keyOf(event)];
    if (!step) return false;
    this.go(this.number + step);
    return true;
  }
}
