// The picture: one renderer, one camera, drawn when something changed.
import {
  AmbientLight, Box3, Color, DirectionalLight, GridHelper, Group, PerspectiveCamera, Plane, Raycaster, Scene,
  Vector2, Vector3, WebGLRenderer,
} from "three";
import { OrbitControls } from "three/examples/jsm/controls/OrbitControls.js";
import { onResize } from "./dom.js";

const kFov = 50;
/// What a picture that is filled leaves free at its edges.
const kMargin = 0.05;

/// Frees what a group drew. Textures go with the geometry that they are on: see freeWith().
export function disposeOf(group) {
  group.traverse((one) => {
    one.geometry?.dispose();
    if (one.isInstancedMesh) one.dispose();
    const { lit, plain } = one.userData.materials ?? {};
    for (const material of [one.material, lit, plain]) material?.dispose();
  });
  group.removeFromParent();
}

/// Calls `free()` once a geometry is disposed of.
export function freeWith(geometry, free) {
  const done = () => {
    geometry.removeEventListener("dispose", done);
    free();
  };
  geometry.addEventListener("dispose", done);
}

export class Stage {
  constructor(canvas) {
    this.canvas = canvas;
    this.renderer = new WebGLRenderer({ canvas, antialias: true, preserveDrawingBuffer: true });
    this.renderer.setPixelRatio(Math.min(devicePixelRatio, 2));
    this.scene = new Scene();
    this.camera = new PerspectiveCamera(kFov, 1, 0.02, 300);
    this.controls = new OrbitControls(this.camera, canvas);
    this.controls.enableDamping = false;
    this.controls.addEventListener("change", () => this.draw());
    this.raycaster = new Raycaster();
    this.cut = new Plane(new Vector3(0, -1, 0), 0);
    this.beforeDraw = () => {};
    this.seenFrom = null;
    this.frames = 0;
    this.addLights();
    this.content = new Group();
    this.scene.add(this.content);
    // A browser takes a picture's memory away from a page that waits, or whose driver begins anew.
    canvas.addEventListener("webglcontextrestored", () => this.draw());
    onResize(canvas.parentElement, () => this.resize());
    this.resize();
  }

  addLights() {
    // Level faces keep their color, walls are a little darker.
    this.scene.add(new AmbientLight(0xffffff, 0.56 * Math.PI));
    const sun = new DirectionalLight(0xffffff, 0.38 * Math.PI);
    sun.position.set(0.25, 1, 0.4);
    const fill = new DirectionalLight(0xffffff, 0.12 * Math.PI);
    fill.position.set(-0.6, 0.1, -0.5);
    this.scene.add(sun, fill);
  }

  setTheme() {
    const style = getComputedStyle(document.documentElement);
    this.scene.background = new Color(style.getPropertyValue("--stage").trim());
    this.draw();
  }

  resize() {
    const { clientWidth: width, clientHeight: height } = this.canvas.parentElement;
    if (width === 0 || height === 0 || (width === this.width && height === this.height)) return;
    Object.assign(this, { width, height });
    this.renderer.setSize(width, height, false);
    this.camera.aspect = width / height;
    this.camera.updateProjectionMatrix();
    this.drawNow();
  }

  draw() {
    if (this.pending) return;
    this.pending = requestAnimationFrame(() => this.drawNow());
  }

  drawNow() {
    cancelAnimationFrame(this.pending);
    this.pending = 0;
    this.beforeDraw();
    if (this.seenFrom) this.renderFrom(this.seenFrom);
    else this.renderer.render(this.scene, this.camera);
    ++this.frames;
  }

  /// A picture from another place than the controls', which stay where they are.
  renderFrom(place) {
    const { position, quaternion } = this.camera;
    const [wanted, turned] = [position.clone(), quaternion.clone()];
    position.copy(place);
    this.camera.lookAt(this.controls.target);
    this.renderer.render(this.scene, this.camera);
    position.copy(wanted);
    quaternion.copy(turned);
  }

  clear() {
    disposeOf(this.content);
    this.content = new Group();
    this.scene.add(this.content);
    this.setCut(null);
    this.setOwnCamera(null);
    this.beforeDraw = () => {};
    this.seenFrom = null;
  }

  /// A floor of squares of a tenth of a meter or a meter, for what has no room around it.
  addFloor(size) {
    const step = size > 3 ? 1 : 0.1;
    const squares = Math.max(4, 2 * Math.ceil(size / step));
    const floor = new GridHelper(squares * step, squares, 0x7a8088, 0x9aa0a8);
    floor.material.transparent = true;
    floor.material.opacity = 0.35;
    this.content.add(floor);
  }

  /// Half of what the camera sees, up and sideways, at a distance of one.
  get opening() {
    const up = Math.tan((kFov * Math.PI) / 360);
    return { up, sideways: up * this.camera.aspect };
  }

  /// How a box fills the picture, seen from a direction that has length one: what the camera looks at, as deep in the
  /// picture as the middle of the box is, and from how far away. All its corners lie between the four planes through
  /// the camera that bound what it sees; of the two planes above and below, as of those at the sides, each has a corner
  /// as near as the other has.
  fit(box, direction) {
    const middle = box.getCenter(new Vector3());
    const right = new Vector3(0, 1, 0).cross(direction).normalize();
    const above = direction.clone().cross(right);
    const corners = Array.from({ length: 8 }, (_, n) => new Vector3(...["x", "y", "z"].map((axis, bit) => box[n & (1 << bit) ? "max" : "min"][axis])).sub(middle));
    const { up, sideways } = this.opening;
    const along = (axis, opening) => {
      const [most, least] = [1, -1].map((side) => Math.max(...corners.map((one) => one.dot(direction) + (side * one.dot(axis)) / (opening * (1 - kMargin)))));
      return { distance: (most + least) / 2, shift: ((most - least) / 2) * opening * (1 - kMargin) };
    };
    const [x, y] = [along(right, sideways), along(above, up)];
    return { target: middle.addScaledVector(right, x.shift).addScaledVector(above, y.shift), distance: Math.max(x.distance, y.distance) };
  }

  /// Turns the camera to see a box, from a direction.
  frame(box, direction = new Vector3(0.9, 0.75, 1.1)) {
    if (box.isEmpty()) box = new Box3(new Vector3(-1, 0, -1), new Vector3(1, 1, 1));
    // What stands beside the picture may just have appeared.
    this.resize();
    const radius = Math.max(0.05, box.getSize(new Vector3()).length() / 2);
    const towards = direction.clone().normalize();
    const { target, distance } = this.fit(box, towards);
    this.controls.target.copy(target);
    this.camera.position.copy(target).addScaledVector(towards, Math.max(distance, 0.1));
    this.camera.near = Math.max(0.005, radius / 200);
    this.camera.far = Math.max(50, radius * 12);
    this.camera.updateProjectionMatrix();
    this.controls.update();
    this.draw();
  }

  /// Leaves out what is above a height; null: nothing.
  setCut(height) {
    this.cut.constant = height ?? 0;
    this.renderer.localClippingEnabled = height !== null;
    this.draw();
  }

  /// What meshes of a scene are cut with.
  get clippingPlanes() { return [this.cut]; }

  /// Sees with a camera that something carries: { position, quaternion (looking along -Z), fov }.
  setOwnCamera(own) {
    this.controls.enabled = own === null;
    if (own) {
      this.camera.position.copy(own.position);
      this.camera.quaternion.copy(own.quaternion);
      this.camera.fov = own.fov;
    } else if (this.camera.fov !== kFov) {
      this.camera.fov = kFov;
      this.controls.update();
    }
    this.camera.updateProjectionMatrix();
    this.draw();
  }

  /// The ray under a pointer event.
  rayAt(event) {
    const area = this.canvas.getBoundingClientRect();
    const point = new Vector2(((event.clientX - area.left) / area.width) * 2 - 1,
                              1 - ((event.clientY - area.top) / area.height) * 2);
    this.raycaster.setFromCamera(point, this.camera);
    return this.raycaster;
  }
}

/// Where the browser cannot draw: the page has what it tells in words. `problem`: why.
export class BlankStage {
  constructor(problem) {
    this.problem = problem;
    this.content = new Group();
  }

  setTheme() {}
  draw() {}
  drawNow() {}
}
