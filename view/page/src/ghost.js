// The same episode in another world, in the same picture: a robot, and objects where they are elsewhere.
import { Box3, Color, Group, MeshLambertMaterial } from "three";
import { ObjectFigure, RobotFigure } from "./figures.js";
import { disposeOf } from "./stage.js";

export const kGhostColor = "#cc79a7";
/// An object that is nearer to its twin than this is not shown twice, meters.
const kApart = 0.005;
/// Nor is a part of the robot whose points all are nearer than this.
const kPartApart = 0.001;
const kBody = { mesh: true, spheres: false, boxes: false, marks: false };

/// How far the points of a part are from where they are in another pose, at most; `reach`: of the part, from its origin.
function distanceOf(pose, other, reach) {
  return pose.position.distanceTo(other.position) + 2 * reach * Math.sin(pose.rotation.angleTo(other.rotation) / 2);
}

/// What is drawn of the links of a robot that was not posed yet: { figure, link, reach }, how far it reaches from the
/// link's origin.
function partsOf(robot, { spheres }) {
  const boxOf = (body) => new Box3().setFromObject(body);
  const reachOf = ({ min, max }) => Math.max(0, ...[min.x, max.x].flatMap((x) => [min.y, max.y].flatMap((y) => [min.z, max.z].map((z) => Math.hypot(x, y, z)))));
  const links = robot.bodies.map((figure, link) => ({ figure, link, reach: figure.children.length > 0 ? reachOf(boxOf(figure)) : 0 }));
  const clouds = robot.clouds.map(({ mesh }, n) => ({ figure: mesh, link: robot.robot.groups[n].link, reach: reachOf(boxOf(mesh)) }));
  return spheres ? [...links, ...clouds] : links;
}

/// Makes a figure a ghost.
function haunt(figure, { show }) {
  const material = new MeshLambertMaterial({ color: new Color(kGhostColor), transparent: true, opacity: 0.5, depthWrite: false });
  figure.show(show);
  figure.group.traverse((one) => {
    // Lit or not, a ghost is a ghost.
    if (one.isMesh) one.material = material;
    if (one.userData.materials) one.userData.materials = { lit: material, plain: material };
    one.castShadow = false;
  });
  return figure;
}

export class Ghost {
  static async load(page, home) {
    const ghost = new Ghost();
    Object.assign(ghost, { page, home, objects: [], isShown: true });
    if (page.robotPack) {
      const bare = { ...kBody, spheres: home.shown.spheres };
      const robot = await RobotFigure.load(page.library, page.robotPack);
      ghost.parts = partsOf(robot, bare);
      ghost.robot = haunt(robot, { show: bare });
      home.group.add(ghost.robot.group);
    }
    return ghost;
  }

  setTrack(track) { this.track = track; }

  /// As Home.setEpisode().
  async setEpisode({ placements }) {
    const objects = await Promise.all(placements.map(({ object }) => this.objectFigure(object)));
    for (const one of this.objects) disposeOf(one.group);
    this.objects = objects;
    this.poses = placements.map(({ pose }) => pose);
    for (const one of objects) this.home.group.add(one.group);
  }

  async objectFigure(name) {
    const found = this.page.objects.get(name);
    const figure = found ? haunt(await ObjectFigure.load(this.page.library, found.pack, found.number), { show: kBody })
      : { group: new Group(), setPose() {} };
    figure.group.visible = false;
    return figure;
  }

  /// The same frame, or the last one; `moved`: where the objects of the other track are.
  show(frame, moved) {
    const { track, poses } = this;
    const shown = Math.min(frame, track.frameCount - 1);
    this.robot?.setPose(track.root(shown), track.joints(shown));
    const own = track.movedObjects(shown);
    this.objects.forEach((figure, n) => {
      const pose = own.get(n) ?? poses[n];
      const other = moved.get(n) ?? poses[n];
      figure.setPose(pose);
      figure.group.visible = this.isShown && pose.position.distanceTo(other.position) > kApart;
    });
    this.showParts();
    this.frame = [frame, moved];
  }

  /// Where both robots are the same, one sees that of the run alone.
  showParts() {
    if (!this.robot) return;
    this.robot.group.visible = this.isShown;
    for (const { figure, link, reach } of this.parts) {
      figure.visible = distanceOf(this.robot.poses[link], this.home.robot.poses[link], reach) > kPartApart;
    }
  }

  /// As RunView.showBetween(); past its end it stays.
  showBetween(frame, share) {
    this.track.showBetween(frame, share, this.robot, (placement, pose) => this.objects[placement].setPose(pose));
  }

  setShown(isShown) {
    this.isShown = isShown;
    if (this.frame) this.show(...this.frame);
    this.page.stage.draw();
  }
}
