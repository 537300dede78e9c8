// The line of sight of the camera that follows a robot, by a column grid of its scene.
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
