#pragma once
#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdint>
#include <map>
#include <span>
#include <string>
#include <vector>

#include "bullet_scene.h"
#include "galactic/batch_simulator.h"
#include "support/oracles/resting_oracle.h"

namespace galactic::test {

/// What was found in the states of a run.
struct Findings {
  std::uint64_t states = 0;
  /// Spheres of robots and of held objects that were looked at.
  std::uint64_t robot_spheres = 0;
  std::uint64_t held_spheres = 0;
  /// Held spheres that have penetrated something ever since they were grasped, in all states.
  std::uint64_t excepted = 0;
  /// Spheres of robots that have been in an object ever since the robot released it, in all states.
  std::uint64_t released_into = 0;
  /// Spheres within 20 cm of an object's box.
  std::uint64_t near_objects = 0;
  /// Spheres shown to Bullet, and those that touch the exact scene, which the column method allows.
  std::uint64_t exact = 0;
  std::uint64_t shallow = 0;
  /// How deep the deepest of these is in the scene, meters, and where it is.
  float deepest = 0;
  Vec3 deepest_center{};
  float deepest_radius = 0;
  /// Moves of robots that were shown to Bullet, and those on which some sphere passed through what
  /// is thinner than the move is long.
  std::uint64_t swept = 0;
  std::uint64_t tunneled = 0;
  /// The same of robots that did not slide: others may have gone around what lies on the straight
  /// line.
  std::uint64_t swept_straight = 0;
  std::uint64_t tunneled_straight = 0;
  /// Of the robot, then of held objects: blocked by the column grid, overlapping an object, deeper
  /// in the exact scene than the column method allows.
  std::array<std::uint64_t, 2> in_grid{};
  std::array<std::uint64_t, 2> in_objects{};
  std::array<std::uint64_t, 2> in_scene{};
  /// The first spheres of robots in objects, in words.
  std::vector<std::string> notes{};
};

/// Looks at the states of a batch from outside: column grids and boxes asked sphere by sphere, and
/// Bullet.
class StateChecker {
 public:
  /// A sphere is judged by the nearest column, at most half the diagonal of a cell of 3 cm (21.213
  /// mm) away, and isInGrid forgives 0.01 mm more along each axis (21.227 mm); heights are rounded
  /// to a tenth of a millimeter, across that way (21.228 mm). The rest is for floats.
  static constexpr float kDeepest = 0.0213F;
  /// Spheres farther from a box than this overlap it in no case.
  static constexpr float kNear = 0.2F;

  StateChecker(const World& world, const BatchSimulator& simulator, BulletScene& scene)
      : world_(world), simulator_(simulator), scene_(scene), held_(simulator.envCount()) {
    const Robot& robot = world.robot();
    for (const galactic::SphereGroup& group : robot.groups()) {
      const LinkOnBody link = simulator.linkOnBody(group.link);
      for (const SetSphere& sphere : group.spheres) {
        spheres_.push_back({link.body, at(link.place, sphere.center), sphere.radius_index});
      }
    }
  }

  /// `exactly`: whether to ask Bullet too, which takes its time.
  void check(std::size_t env, bool exactly, Findings& found) {
    const EnvState state = simulator_.envState(env);
    const Surroundings around = surroundingsOf(state);
    const std::size_t bodies = simulator_.bodyCount();
    const auto transforms = simulator_.bodyTransforms().subspan(env * bodies, bodies);
    HeldBefore& before = held_[env];
    noteRelease(state, before);
    before.slid = slidBetween(before.root, state.world_from_root);
    before.root = state.world_from_root;
    before.from = before.to;
    before.to.resize(spheres_.size());
    for (std::size_t n = 0; n < spheres_.size(); ++n) {
      const RobotSphere& sphere = spheres_[n];
      const Ball ball{at(transforms[sphere.body], sphere.center), sphere.radius_index};
      found.in_grid[0] += isInGrid(around, ball) ? 1U : 0U;
      before.to[n] = ball.center;
      const InObjects objects = inObjects(around, ball, found);
      for (auto& [object, spheres] : before.leaving) {
        spheres[n] = spheres[n] && std::ranges::count(objects.touches, object) != 0;
      }
      for (const std::int32_t object : objects.in) {
        const auto leaving = before.leaving.find(object);
        if (leaving != before.leaving.end() && leaving->second[n]) {
          ++found.released_into;
          continue;
        }
        ++found.in_objects[0];
        note(env, state, n, object, found);
      }
      if (exactly) found.in_scene[0] += isInScene(ball, found) ? 1U : 0U;
    }
    found.robot_spheres += spheres_.size();
    ++found.states;
    checkMove(state, before, exactly, found);
    checkHeld(env, state, around, found);
  }

 private:
  struct RobotSphere {
    std::size_t body = 0;
    Vec3 center;
    std::uint32_t radius_index = 0;
  };
  struct Ball {
    Vec3 center;
    std::uint32_t radius_index = 0;
  };
  struct RestingSolid {
    std::int32_t number = -1;
    BoxSolid solid;
    Vec3 center;
    float reach = 0;
  };
  struct Surroundings {
    const Scene* scene = nullptr;
    std::vector<RestingSolid> objects;
  };
  /// What an env held in the state before.
  struct HeldBefore {
    std::int32_t object = -1;
    std::uint32_t step = 0;
    std::vector<bool> excepted;
    /// Objects that were released, and the robot's spheres that have been in each since.
    std::map<std::int32_t, std::vector<bool>> leaving;
    /// Where the robot's spheres were in the state before, and are in this one.
    std::vector<Vec3> from;
    std::vector<Vec3> to;
    /// Where its base is in this one, and whether more than its drive brought it there.
    Pose root;
    bool slid = false;
  };
  /// The objects that a sphere is in.
  struct InObjects {
    std::vector<std::int32_t> in;
    /// Those that it may not be free of, but for rounding.
    std::vector<std::int32_t> touches;
  };

  void noteRelease(const EnvState& state, HeldBefore& before) const {
    const bool goes_on = state.step == before.step + 1;
    if (!goes_on) before.leaving.clear();
    before.leaving.erase(state.held);
    if (!goes_on || before.object < 0 || before.object == state.held) return;
    before.leaving[before.object].assign(spheres_.size(), true);
  }

  /// Robots turn first and then drive.
  [[nodiscard]] static bool slidBetween(const Pose& before, const Pose& after) {
    constexpr float kRounding = 1e-4F;
    const Vec3 way = after.translation - before.translation;
    const Vec3 ahead = rotate(after.rotation, {1, 0, 0});
    return std::fabs(way.x * ahead.z - way.z * ahead.x) > kRounding;
  }

  /// Each sphere along a straight line: where it turns, by five degrees at a meter at most, its
  /// path leaves the line by a millimeter.
  void checkMove(const EnvState& state, const HeldBefore& before, bool exactly,
                 Findings& found) const {
    if (!exactly || before.from.empty() || state.step != before.step + 1) return;
    ++found.swept;
    found.swept_straight += before.slid ? 0U : 1U;
    for (std::size_t n = 0; n < spheres_.size(); ++n) {
      if (!tunnels(before.from[n], before.to[n], world_.radii()[spheres_[n].radius_index]))
        continue;
      ++found.tunneled;
      found.tunneled_straight += before.slid ? 0U : 1U;
      return;
    }
  }

  [[nodiscard]] bool tunnels(const Vec3& from, const Vec3& to, float radius) const {
    const Vec3 way = to - from;
    if (!(dot(way, way) > kDeepest * kDeepest)) return false;
    // Spheres may be as deep in the scene as the column method allows; what remains of them may
    // touch nothing.
    if (radius > kDeepest) return scene_.crosses(from, to, radius - kDeepest);
    // Nothing remains: their centers may be on the other side of a surface that they only touch.
    const float near = kDeepest - radius;
    return !scene_.touches(from, near) && !scene_.touches(to, near) && scene_.crosses(from, to, 0);
  }

  static void note(std::size_t env, const EnvState& state, std::size_t sphere, std::int32_t object,
                   Findings& found) {
    constexpr std::size_t kMost = 5;
    if (found.notes.size() == kMost) return;
    found.notes.push_back(
        fmt::format("env {}, step {} of episode {}: sphere {} is in object {}, {} is held", env,
                    state.step, state.episode, sphere, object, state.held));
  }

  static Vec3 at(const RigidTransform& frame, const Vec3& point) {
    return frame.x_axis * point.x + frame.y_axis * point.y + frame.z_axis * point.z + frame.origin;
  }

  [[nodiscard]] const Placement& placementOf(const EnvState& state, std::size_t object) const {
    return world_.episodes().placements(world_.episodes().episodes()[state.episode])[object];
  }

  [[nodiscard]] Surroundings surroundingsOf(const EnvState& state) const {
    Surroundings around{&world_.scenes()[state.scene], {}};
    for (std::size_t n = 0; n < state.objects.size(); ++n) {
      if (static_cast<std::int32_t>(n) == state.held) continue;
      const OrientedBox& box = world_.objectOf(placementOf(state, n)).box;
      const Vec3& half = box.half_extents;
      const Vec3 center = state.objects[n] * box.pose.translation;
      const Vec3 away = center - state.world_from_root.translation;
      constexpr float kFar = 2.5F;
      if (dot(away, away) > kFar * kFar) continue;
      around.objects.push_back({static_cast<std::int32_t>(n), BoxSolid(box, state.objects[n]),
                                center, std::sqrt(dot(half, half)) + kNear});
    }
    return around;
  }

  /// Blocked, and not only by rounding: centers are computed in another way here.
  [[nodiscard]] static bool isInGrid(const Surroundings& around, const Ball& ball) {
    constexpr float kRounding = 1e-5F;
    const ColumnGrid& grid = around.scene->grids()[ball.radius_index];
    if (grid.clearance(ball.center) == Clearance::kFree) return false;
    for (unsigned corner = 0; corner < 8; ++corner) {
      const auto by = [&](unsigned bit) {
        return (corner >> bit & 1U) != 0 ? kRounding : -kRounding;
      };
      if (grid.clearance(ball.center + Vec3{by(0), by(1), by(2)}) == Clearance::kFree) return false;
    }
    return true;
  }

  [[nodiscard]] InObjects inObjects(const Surroundings& around, const Ball& ball,
                                    Findings& found) const {
    constexpr double kRounding = 1e-5;
    InObjects objects;
    bool near = false;
    for (const RestingSolid& object : around.objects) {
      const Vec3 away = ball.center - object.center;
      if (dot(away, away) > object.reach * object.reach) continue;
      near = true;
      const double distance = object.solid.distance(toPoint3(ball.center));
      const auto radius = static_cast<double>(world_.radii()[ball.radius_index]);
      if (distance < radius + kRounding) objects.touches.push_back(object.number);
      if (distance < radius - kRounding) objects.in.push_back(object.number);
    }
    found.near_objects += near ? 1U : 0U;
    return objects;
  }

  [[nodiscard]] bool isInScene(const Ball& ball, Findings& found) {
    if (!(world_.radii()[ball.radius_index] > kDeepest)) return false;
    ++found.exact;
    found.shallow += isDeeper(ball, 0) ? 1U : 0U;
    if (isDeeper(ball, found.deepest)) {
      found.deepest = depthOf(ball, found.deepest);
      found.deepest_center = ball.center;
      found.deepest_radius = world_.radii()[ball.radius_index];
    }
    return isDeeper(ball, kDeepest);
  }

  /// Whether a ball that is smaller by `depth` touches the scene.
  [[nodiscard]] bool isDeeper(const Ball& ball, float depth) const {
    const float radius = (world_.radii()[ball.radius_index] - depth) / BulletScene::kReach;
    return radius > 0 && scene_.touches(ball.center, radius);
  }

  /// How deep a ball is that is deeper than `at_least`, to a hundredth of a millimeter.
  [[nodiscard]] float depthOf(const Ball& ball, float at_least) const {
    float at_most = world_.radii()[ball.radius_index];
    while (at_most - at_least > 1e-5F) {
      const float middle = 0.5F * (at_least + at_most);
      (isDeeper(ball, middle) ? at_least : at_most) = middle;
    }
    return at_least;
  }

  void checkHeld(std::size_t env, const EnvState& state, const Surroundings& around,
                 Findings& found) {
    HeldBefore& before = held_[env];
    const bool goes_on = before.object == state.held && state.step == before.step + 1;
    before.step = state.step;
    before.object = state.held;
    if (state.held < 0) return;
    const auto number = static_cast<std::size_t>(state.held);
    const ObjectModel& object = world_.objectOf(placementOf(state, number));
    // Whatever penetrates something when it is grasped does not count until it is free.
    if (!goes_on) before.excepted.assign(object.spheres.size(), true);
    for (std::size_t n = 0; n < object.spheres.size(); ++n) {
      const Ball ball{state.objects[number] * object.spheres[n].center,
                      object.spheres[n].radius_index};
      ++found.held_spheres;
      const bool in_grid = isInGrid(around, ball);
      const bool in_object = !inObjects(around, ball, found).in.empty();
      before.excepted[n] = before.excepted[n] && (in_grid || in_object);
      found.excepted += before.excepted[n] ? 1U : 0U;
      if (before.excepted[n]) continue;
      found.in_grid[1] += in_grid ? 1U : 0U;
      found.in_objects[1] += in_object ? 1U : 0U;
      found.in_scene[1] += isInScene(ball, found) ? 1U : 0U;
    }
  }

  const World& world_;
  const BatchSimulator& simulator_;
  BulletScene& scene_;
  std::vector<RobotSphere> spheres_;
  std::vector<HeldBefore> held_;
};

}  // namespace galactic::test
