// Lines of sight to a robot, by a column grid of its scene: from where one looks at it first, and
// where the camera goes that follows it.
import { Vector3 } from "three";

/// Heights above the robot's base that one may look at; the first free one counts.
const kAims = [0.6, 0.4, 0.2, 0.1];
/// The camera rises by so many steps of so much at most. Each is as bad as to come so much nearer.
const kRises = 8;
const kRise = Math.PI / 18;
const kPriceOfARise = 0.04;
/// Nearly straight above: a camera that looks straight down has no "up".
const kSteepest = (80 * Math.PI) / 180;

/// How much of the way from `from` to `to` is free, 0 to 1; above `cut` everything is.
function freeShare(grid, from, to, cut) {
  const way = to.clone().sub(from);
  const steps = Math.max(1, Math.ceil(way.length() / (0.5 * Math.min(grid.radius, grid.spacing))));
  const at = new Vector3();
  for (let n = 0; n <= steps; ++n) {
    at.copy(from).addScaledVector(way, n / steps);
    if (at.y > cut) return 1;
    if (!grid.isFree(at)) return Math.max(n - 1, 0) / steps;
  }
  return 1;
}

/// The place on the sphere about `target`, higher by an angle; null where that would be too steep.
function raised(target, place, angle) {
  const away = place.clone().sub(target);
  const distance = away.length();
  const level = Math.hypot(away.x, away.z);
  const elevation = Math.atan2(away.y, level) + angle;
  if (angle > 0 && (elevation > kSteepest || level === 0)) return null;
  const share = (distance * Math.cos(elevation)) / (level || 1);
  return angle === 0 ? place.clone() : new Vector3(away.x * share, distance * Math.sin(elevation), away.z * share).add(target);
}

/// Where a camera at `wanted`, which looks at `target`, sees the robot whose base is at `base`: it
/// rises and comes nearer, whichever changes the picture less, and never turns: whoever looks on has
/// chosen from which side. Stays as it is where the grid has no free place above the base.
export function inSight(grid, base, target, wanted, cut = Infinity) {
  const aim = kAims.map((height) => base.clone().setY(base.y + height)).find((one) => grid.isFree(one));
  if (!aim) return wanted.clone();
  let best = { value: -1, place: wanted.clone() };
  for (let n = 0; n <= kRises && 1 - n * kPriceOfARise > best.value; ++n) {
    const place = raised(target, wanted, n * kRise);
    if (!place) break;
    const share = freeShare(grid, aim, place, cut);
    const value = share - n * kPriceOfARise;
    if (value > best.value) best = { value, place: aim.clone().lerp(place, share) };
  }
  return best.place;
}

/// From where one looks first where nothing is in the way: degrees about +Y and above the ground.
const kFirst = { turn: 58, rise: 45 };
const kTurnStep = 30;
const kFirstRises = [35, 45, 55, 65];
/// To see all of the robot counts for more than a picture full of rooms. Other things equal, one
/// looks from near kFirst.
const kWorthOfRobot = 2;
const kPriceOfADegree = { turn: 0.0003, rise: 0.005 };
/// Where the picture is looked at: shares of its half width and height.
const kSamples = [-0.9, -0.5, 0, 0.5, 0.9];
/// What is nearer than this share of the way to the robot stands in the way.
const kNear = 0.7;

function directionOf(turn, rise) {
  const [a, b] = [(turn * Math.PI) / 180, (rise * Math.PI) / 180];
  return new Vector3(Math.cos(a) * Math.cos(b), Math.sin(b), Math.sin(a) * Math.cos(b));
}

/// How much of a picture shows rooms, 0 to 1: neither the ground outside nor what stands right before
/// the camera. `floor`: its height.
function roomShare(grid, place, direction, { distance, up, sideways }, { floor, cut }) {
  const right = new Vector3(0, 1, 0).cross(direction).normalize();
  const above = direction.clone().cross(right);
  const onRay = (ray, length) => place.clone().addScaledVector(ray, length);
  let count = 0;
  for (const u of kSamples) for (const v of kSamples) {
    const ray = right.clone().multiplyScalar(u * sideways).addScaledVector(above, v * up).sub(direction);
    if (ray.y >= 0) continue;
    const ground = (floor - place.y) / ray.y;
    const { x, z } = onRay(ray, ground);
    const cell = grid.cellAt(x, z);
    const isRoom = cell !== null && grid.spansOf(cell).length > 0;
    if (isRoom && freeShare(grid, onRay(ray, Math.min(kNear * distance, ground)), place, cut) === 1) ++count;
  }
  return count / kSamples.length ** 2;
}

/// The direction from which a picture shows the most of a robot, whose parts are at `points`, and of
/// the rooms around it. `fit(direction)`: the picture from there, { target, distance, up, sideways }, as Stage has it.
export function bestDirection(grid, points, fit, cut = Infinity) {
  const free = points.filter((one) => grid.isFree(one));
  const floor = Math.min(...points.map(({ y }) => y));
  let best = { value: -Infinity };
  for (let n = 0; n < 360 / kTurnStep; ++n) for (const rise of kFirstRises) {
    const direction = directionOf(kFirst.turn + n * kTurnStep, rise);
    const picture = fit(direction);
    const place = picture.target.clone().addScaledVector(direction, picture.distance);
    const seen = free.filter((one) => freeShare(grid, one, place, cut) === 1).length / (free.length || 1);
    const turned = Math.min(n * kTurnStep, 360 - n * kTurnStep);
    const price = kPriceOfADegree.turn * turned + kPriceOfADegree.rise * Math.abs(rise - kFirst.rise);
    const value = kWorthOfRobot * seen + roomShare(grid, place, direction, picture, { floor, cut }) - price;
    if (value > best.value) best = { value, direction };
  }
  return best.direction;
}
