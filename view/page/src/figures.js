// Objects and robots as one sees them: meshes, spheres, boxes, marks.
import {
  Box3, BoxGeometry, BufferGeometry, Color, EdgesGeometry, Float32BufferAttribute, Group, IcosahedronGeometry,
  InstancedMesh, LineBasicMaterial, LineLoop, LineSegments, Matrix4, Mesh, MeshLambertMaterial, Quaternion, Vector3,
} from "three";
import { checkbox, el, swatch } from "./dom.js";
import { linkPoses, Pose } from "./kinematics.js";

/// By the rank of the radius, least first; people with color-blindness tell them apart.
const kSphereColors = ["#56b4e9", "#0072b2", "#009e73", "#cc79a7", "#f0e442", "#999999", "#e69f00", "#222222"];
const kTouchColor = new Color("#d55e00");
/// What is drawn of a robot beside its body.
const kMarks = { grasp: { name: "Grasp point", color: "#e69f00" }, camera: { name: "Camera", color: "#0072b2" }, base: { name: "Footprint", color: "#cc79a7" } };

export function radiiOf(spheres) {
  const radii = new Set();
  for (let n = 3; n < spheres.length; n += 4) radii.add(spheres[n]);
  return [...radii].sort((a, b) => a - b);
}

export class Palette {
  constructor(spheres) { this.radii = radiiOf(spheres); }
  color(radius) { return kSphereColors[this.radii.indexOf(radius) % kSphereColors.length]; }
}

const unitSphere = () => new IcosahedronGeometry(1, 6);

function material(color, opacity) {
  return new MeshLambertMaterial({ color, transparent: opacity < 1, opacity, depthWrite: opacity >= 1 });
}

/// One sphere for each four numbers of `spheres`.
export class SphereCloud {
  constructor(spheres, palette, opacity = 0.55) {
    this.spheres = spheres;
    this.palette = palette;
    this.count = spheres.length / 4;
    this.mesh = new InstancedMesh(unitSphere(), material(0xffffff, opacity), Math.max(1, this.count));
    this.mesh.count = this.count;
    this.mesh.frustumCulled = false;
    const matrix = new Matrix4();
    for (let n = 0; n < this.count; ++n) {
      const [x, y, z, radius] = spheres.slice(4 * n, 4 * n + 4);
      matrix.makeScale(radius, radius, radius).setPosition(x, y, z);
      this.mesh.setMatrixAt(n, matrix);
    }
    this.paint(() => false);
  }

  /// Orange where `isTouching(number)`.
  paint(isTouching) {
    for (let n = 0; n < this.count; ++n) {
      this.mesh.setColorAt(n, isTouching(n) ? kTouchColor : new Color(this.palette.color(this.spheres[4 * n + 3])));
    }
    if (this.mesh.instanceColor) this.mesh.instanceColor.needsUpdate = true;
  }

  /// Only those of these radii.
  showRadii(isShown) {
    const matrix = new Matrix4();
    for (let n = 0; n < this.count; ++n) {
      const [x, y, z, radius] = this.spheres.slice(4 * n, 4 * n + 4);
      const size = isShown(radius) ? radius : 0;
      matrix.makeScale(size, size, size).setPosition(x, y, z);
      this.mesh.setMatrixAt(n, matrix);
    }
    this.mesh.instanceMatrix.needsUpdate = true;
  }
}

export function boxLines(box, halfExtents, color) {
  const solid = new BoxGeometry(...halfExtents.map((half) => 2 * half));
  const lines = new LineSegments(new EdgesGeometry(solid), new LineBasicMaterial({ color }));
  solid.dispose();
  const pose = Pose.of(box);
  lines.position.copy(pose.position);
  lines.quaternion.copy(pose.rotation);
  return lines;
}

export function place(group, pose) {
  group.position.copy(pose.position);
  group.quaternion.copy(pose.rotation);
}

/// The mesh of a part of a pack, or its surface, or nothing.
async function bodyOf(library, meshes, part, surface) {
  return (await library.model(meshes, part)) ?? (surface ? await library.surface(surface) : null);
}

export class ObjectFigure {
  static async load(library, pack, number) {
    const figure = new ObjectFigure();
    figure.stored = pack.objects[number];
    figure.group = new Group();
    figure.body = (await bodyOf(library, pack.meshes, number, figure.stored.surface)) ?? new Group();
    figure.palette = new Palette(figure.stored.spheres);
    figure.cloud = new SphereCloud(figure.stored.spheres, figure.palette);
    figure.box = boxLines(figure.stored.box, figure.stored.half_extents, 0xd55e00);
    figure.group.add(figure.body, figure.cloud.mesh, figure.box);
    return figure;
  }

  show({ mesh, spheres, boxes }) {
    this.body.visible = mesh;
    this.cloud.mesh.visible = spheres;
    this.box.visible = boxes;
  }

  setPose(pose) { place(this.group, pose); }
}

/// The corners of what a camera sees at a distance, in its frame: it looks along +X, +Y is up.
function frustumLines(fov, length) {
  const half = length * Math.tan(fov / 2);
  const corners = [[1, 1], [1, -1], [-1, -1], [-1, 1]].map(([y, z]) => new Vector3(length, y * half, z * half));
  const points = corners.flatMap((corner, n) => [new Vector3(), corner, corner, corners[(n + 1) % 4]]);
  return new LineSegments(new BufferGeometry().setFromPoints(points), new LineBasicMaterial({ color: kMarks.camera.color }));
}

function footprintLine(base) {
  const { footprint_min: low, footprint_max: high, footprint_radius: radius } = base;
  const points = [];
  if (radius > 0) {
    for (let n = 0; n < 48; ++n) {
      const angle = (2 * Math.PI * n) / 48;
      points.push((low[0] + high[0]) / 2 + radius * Math.cos(angle), 0, (low[2] + high[2]) / 2 + radius * Math.sin(angle));
    }
  } else {
    points.push(low[0], 0, low[2], high[0], 0, low[2], high[0], 0, high[2], low[0], 0, high[2]);
  }
  const geometry = new BufferGeometry();
  geometry.setAttribute("position", new Float32BufferAttribute(points, 3));
  return new LineLoop(geometry, new LineBasicMaterial({ color: kMarks.base.color }));
}

/// A list of the check box for the marks of a robot, which names them with their colors; empty where there are none.
export function marksBoxes(figure, isOn, toggle) {
  const found = Object.entries(kMarks).filter(([key]) => figure?.robot[key]).map(([, one]) => one);
  const names = found.flatMap(({ name, color }, n) => [n > 0 ? ", " : "", el("span", { className: "named" }, swatch(color), n > 0 ? name.toLowerCase() : name)]);
  return found.length > 0 ? [checkbox(names, isOn, toggle)] : [];
}

/// Spheres of two groups that touch, as pairs of their numbers.
function touchingSpheres(ours, theirs) {
  const touch = (a, b) => a.center.distanceToSquared(b.center) < (a.radius + b.radius) ** 2;
  return ours.flatMap((a, n) => theirs.flatMap((b, m) => (touch(a, b) ? [[n, m]] : [])));
}

export class RobotFigure {
  static async load(library, pack) {
    const figure = new RobotFigure();
    const { robot } = pack;
    figure.robot = robot;
    figure.group = new Group();
    figure.bodies = [];
    for (let n = 0; n < robot.links.length; ++n) {
      const link = new Group();
      const body = await bodyOf(library, pack.meshes, n, robot.links[n].surface);
      if (body) link.add(body);
      figure.bodies.push(link);
      figure.group.add(link);
    }
    figure.addSpheres();
    figure.addMarks();
    return figure;
  }

  addSpheres() {
    this.palette = new Palette(this.robot.groups.flatMap((one) => one.spheres));
    this.clouds = this.robot.groups.map((one) => new SphereCloud(one.spheres, this.palette, 0.6));
    for (const cloud of this.clouds) this.group.add(cloud.mesh);
  }

  addMarks() {
    this.marks = new Group();
    const { grasp, camera, base } = this.robot;
    if (grasp) {
      this.grasp = new Mesh(unitSphere(), material(kMarks.grasp.color, 0.6));
      this.grasp.scale.setScalar(Math.max(0.01, grasp.radius));
      this.marks.add(this.grasp);
    }
    if (camera) {
      this.frustum = frustumLines(camera.vertical_fov, 0.5);
      this.marks.add(this.frustum);
    }
    if (base) {
      this.footprint = footprintLine(base);
      this.marks.add(this.footprint);
    }
    this.group.add(this.marks);
  }

  /// Where the root stands when the base is at a point of the ground, turned about +Y.
  rootPose(x = 0, y = 0, z = 0, yaw = 0) {
    return new Pose(new Vector3(x, y + (this.robot.base?.root_height ?? 0), z),
      new Quaternion().setFromAxisAngle(new Vector3(0, 1, 0), yaw));
  }

  setPose(worldFromRoot, positions) {
    this.poses = linkPoses(this.robot.links, worldFromRoot, positions);
    this.bodies.forEach((body, n) => place(body, this.poses[n]));
    this.clouds.forEach((cloud, n) => place(cloud.mesh, this.poses[this.robot.groups[n].link]));
    const { grasp, camera, base } = this.robot;
    if (grasp) this.grasp.position.copy(this.poses[grasp.link].apply(new Vector3(...grasp.point)));
    if (camera) place(this.frustum, this.cameraPose());
    if (base) {
      place(this.footprint, worldFromRoot);
      this.footprint.position.y -= base.root_height - 0.003;
    }
  }

  cameraPose() {
    const { camera } = this.robot;
    return this.poses[camera.link].times(Pose.of(camera.pose));
  }

  /// For Stage.setOwnCamera: cameras of three.js look along -Z.
  ownCamera() {
    const pose = this.cameraPose();
    const turn = new Quaternion().setFromAxisAngle(new Vector3(0, 1, 0), -Math.PI / 2);
    return { position: pose.position, quaternion: pose.rotation.clone().multiply(turn), fov: (this.robot.camera.vertical_fov * 180) / Math.PI };
  }

  show({ mesh, spheres, marks }) {
    for (const body of this.bodies) body.visible = mesh;
    for (const cloud of this.clouds) cloud.mesh.visible = spheres;
    this.marks.visible = marks;
  }

  bounds() {
    const box = new Box3();
    this.robot.groups.forEach((group, n) => {
      for (let at = 0; at < group.spheres.length; at += 4) {
        const center = this.poses[group.link].apply(new Vector3(...group.spheres.slice(at, at + 3)));
        box.union(new Box3().setFromCenterAndSize(center, new Vector3().setScalar(2 * group.spheres[at + 3])));
      }
    });
    for (const body of this.bodies) box.expandByObject(body);
    if (this.marks.visible) box.expandByObject(this.marks);
    return box;
  }

  centersOf(number) {
    const { link, spheres } = this.robot.groups[number];
    const centers = [];
    for (let at = 0; at < spheres.length; at += 4) {
      centers.push({ center: this.poses[link].apply(new Vector3(...spheres.slice(at, at + 3))), radius: spheres[at + 3] });
    }
    return centers;
  }

  /// The pairs of groups that can collide, but for those whose spheres overlap in the start pose
  /// already: that these touch says nothing. scripted/arm.cpp leaves out the same ones.
  pairsApartAtStart() {
    this.setPose(this.rootPose(), this.robot.start);
    const { tested_pairs: all } = this.robot;
    const pairs = Array.from({ length: all.length / 2 }, (_, n) => [all[2 * n], all[2 * n + 1]]);
    return pairs.filter(([first, second]) => touchingSpheres(this.centersOf(first), this.centersOf(second)).length === 0);
  }

  /// Those of these pairs of groups that touch; their spheres light up.
  findTouching(pairs) {
    const all = this.clouds.map((_, n) => this.centersOf(n));
    const touching = this.clouds.map(() => new Set());
    const found = pairs.filter(([first, second]) => {
      const spheres = touchingSpheres(all[first], all[second]);
      for (const [a, b] of spheres) {
        touching[first].add(a);
        touching[second].add(b);
      }
      return spheres.length > 0;
    });
    this.clouds.forEach((cloud, n) => cloud.paint((sphere) => touching[n].has(sphere)));
    return found;
  }

  groupName(number) { return this.robot.links[this.robot.groups[number].link].name; }
}
