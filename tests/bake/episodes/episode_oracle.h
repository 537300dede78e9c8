#pragma once
#include <cmath>
#include <cstdint>
#include <map>
#include <numbers>
#include <optional>
#include <random>
#include <string>
#include <utility>
#include <vector>

#include "double_pose.h"
#include "floor_oracle.h"
#include "galactic/bake/episode_generator.h"
#include "galactic/object_set.h"
#include "galactic/robot.h"
#include "galactic/scene.h"
#include "support/oracles/box_oracle.h"

namespace galactic::test {

/// What an episode of the generator promises, asked again by brute force.
class EpisodeOracle {
 public:
  /// Boxes may come this much nearer than promised: rounding of floats, and of the projections.
  static constexpr double kGapTolerance = 1e-3;
  /// Heights under one object differ by no more than this; the generator's limit is 2 mm on each
  /// side, and a grid rounds.
  static constexpr double kFlatTolerance = 0.005;
  static constexpr double kGap = 0.05;

  EpisodeOracle(const Scene& scene, const ObjectSet& objects, const Robot& robot,
                const bake::EpisodeGeneratorOptions& options)
      : scene_(scene),
        objects_(objects),
        robot_(robot),
        options_(options),
        floor_(scene, robot),
        random_(4242) {
    drawArmSamples();
  }

  [[nodiscard]] const FloorOracle& floor() const { return floor_; }

  /// All objects and the goal keep their distance.
  [[nodiscard]] bool isApart(const bake::SourceEpisodes& set, const Episode& episode) const {
    std::vector<PlacedBox> boxes = boxesOf(set, episode);
    boxes.push_back(goalBox(set, episode));
    for (std::size_t a = 0; a < boxes.size(); ++a) {
      for (std::size_t b = 0; b < a; ++b) {
        if (boxes[a].distanceTo(boxes[b]) < kGap - kGapTolerance) return false;
      }
    }
    return true;
  }

  /// The object stands in one of its stable poses on a flat surface, at an allowed height, with
  /// free space where it is and over it.
  [[nodiscard]] bool stands(const ObjectModel& model, const Pose& pose) const {
    const std::optional<double> surface = surfaceOf(model, pose);
    if (!surface || !isAtAllowedHeight(pose, *surface)) return false;
    const PlacedBox box(model.box, pose);
    constexpr int kSteps = 12;
    for (int x = -kSteps; x <= kSteps; ++x) {
      for (int z = -kSteps; z <= kSteps; ++z) {
        for (const double y : {-1.0, 0.0, 1.0}) {
          const Point p =
              box.at(static_cast<double>(x) / kSteps, y, static_cast<double>(z) / kSteps);
          if (!isFreeColumn(p, *surface, box.top())) return false;
        }
      }
    }
    return hasApproach(box);
  }

  [[nodiscard]] bool allStand(const bake::SourceEpisodes& set, const Episode& episode) const {
    for (const Placement& placement : placementsOf(set, episode)) {
      if (!stands(objects_.objects()[placement.object], placement.pose)) return false;
    }
    return stands(targetOf(set, episode), episode.goal);
  }

  /// The start is on the largest part of the floor, and the robot touches nothing there.
  [[nodiscard]] bool startsFree(const bake::SourceEpisodes& set, const Episode& episode) const {
    const Point base = pointOf(episode.base_position);
    if (!floor_.isOnLargestPart(base[0], base[1], base[2])) return false;
    const double yaw = static_cast<double>(episode.base_yaw);
    const OracleBody body = oracleBody(robot_, robot_.startPositions()).moved(base, yaw);
    if (!body.isFree(scene_)) return false;
    for (const PlacedBox& box : boxesOf(set, episode)) {
      if (body.touches(box)) return false;
    }
    return true;
  }

  [[nodiscard]] double travel(const bake::SourceEpisodes& set, const Episode& episode) const {
    const Placement& target = placementsOf(set, episode)[episode.target];
    return distance(pointOf(target.pose.translation), pointOf(episode.goal.translation));
  }

  /// Whether some arm sample, with the base on the largest part of the floor, brings the grasp
  /// point to the object while nothing is touched: neither the scene nor any object of the episode,
  /// this one included.
  [[nodiscard]] bool isReached(const bake::SourceEpisodes& set, const Episode& episode,
                               bool at_goal) {
    const std::uint32_t target = episode.target;
    std::vector<PlacedBox> boxes = boxesOf(set, episode);
    const PlacedBox wanted = at_goal ? goalBox(set, episode) : boxes[target];
    boxes[target] = wanted;
    constexpr int kTries = 60000;
    for (int n = 0; n < kTries; ++n) {
      if (tryReach(wanted, boxes)) return true;
    }
    return false;
  }

 private:
  void drawArmSamples() {
    constexpr int kSamples = 12000;
    std::vector<float> positions(robot_.startPositions().begin(), robot_.startPositions().end());
    for (int n = 0; n < kSamples; ++n) {
      for (const ControlledJoint& joint : robot_.controlledJoints()) {
        const double lower = std::max(static_cast<double>(joint.lower), -std::numbers::pi);
        const double upper = std::min(static_cast<double>(joint.upper), std::numbers::pi);
        positions[joint.position] = static_cast<float>(lower + uniform(random_) * (upper - lower));
      }
      arm_.push_back(oracleBody(robot_, positions));
    }
  }

  bool tryReach(const PlacedBox& wanted, const std::vector<PlacedBox>& boxes) {
    const OracleBody& sample = arm_[random_() % arm_.size()];
    const double yaw = 2 * std::numbers::pi * uniform(random_);
    const Point aim = wanted.at(3 * uniform(random_) - 1.5, 0, 3 * uniform(random_) - 1.5);
    const Point hand = turned(sample.grasp_point, yaw);
    const double x = aim[0] - hand[0];
    const double z = aim[2] - hand[2];
    const std::optional<double> floor = floor_.largestPartAt(x, z);
    if (!floor) return false;
    const Point grasp{aim[0], *floor + hand[1], aim[2]};
    const double radius = static_cast<double>(robot_.endEffector()->grasp_radius);
    if (distance(grasp, wanted.nearest(grasp)) >= radius) return false;
    const OracleBody body = sample.moved({x, *floor, z}, yaw);
    if (!body.isFree(scene_)) return false;
    return std::none_of(boxes.begin(), boxes.end(),
                        [&](const PlacedBox& box) { return body.touches(box); });
  }

  [[nodiscard]] static std::span<const Placement> placementsOf(const bake::SourceEpisodes& set,
                                                               const Episode& episode) {
    return std::span(set.placements).subspan(episode.first_placement, episode.placement_count);
  }

  [[nodiscard]] const ObjectModel& targetOf(const bake::SourceEpisodes& set,
                                            const Episode& episode) const {
    return objects_.objects()[placementsOf(set, episode)[episode.target].object];
  }

  [[nodiscard]] std::vector<PlacedBox> boxesOf(const bake::SourceEpisodes& set,
                                               const Episode& episode) const {
    std::vector<PlacedBox> boxes;
    for (const Placement& placement : placementsOf(set, episode)) {
      boxes.emplace_back(objects_.objects()[placement.object].box, placement.pose);
    }
    return boxes;
  }

  [[nodiscard]] PlacedBox goalBox(const bake::SourceEpisodes& set, const Episode& episode) const {
    return {targetOf(set, episode).box, episode.goal};
  }

  /// The surface under an object that is a stable pose turned about the vertical.
  [[nodiscard]] static std::optional<double> surfaceOf(const ObjectModel& model, const Pose& pose) {
    constexpr float kUpright = 1e-5F;
    for (const StablePose& stable : model.stable_poses) {
      const Quat yaw = pose.rotation * conjugate(stable.rotation);
      if (std::abs(yaw.x) > kUpright || std::abs(yaw.z) > kUpright) continue;
      return static_cast<double>(pose.translation.y) - static_cast<double>(stable.height);
    }
    return std::nullopt;
  }

  [[nodiscard]] bool isAtAllowedHeight(const Pose& pose, double surface) const {
    // The arm's length, and half a column for the place from which the generator measured.
    constexpr double kArm = 1.05;
    constexpr double kTolerance = 0.005;
    return floor_.anyOnLargestPart(pointOf(pose.translation), kArm, [&](double floor) {
      const double height = surface - floor;
      return height > static_cast<double>(options_.heights.least) - kTolerance &&
             height < static_cast<double>(options_.heights.most) + kTolerance;
    });
  }

  /// Whether the column at a point has a surface of this height and is free from there to `top`.
  [[nodiscard]] bool isFreeColumn(const Point& p, double surface, double top) const {
    const ColumnGrid& grid = scene_.grids().front();
    const double radius = static_cast<double>(grid.radius());
    for (const Span& span : nearestColumn(grid, p[0], p[2])) {
      const double height = static_cast<double>(span.lo) - radius;
      if (std::abs(height - surface) > kFlatTolerance) continue;
      return static_cast<double>(span.hi) + radius > top;
    }
    return false;
  }

  [[nodiscard]] bool hasApproach(const PlacedBox& box) const {
    const ColumnGrid& grid = scene_.grids().back();
    // Twice the largest radius, and what the generator promises over that, less its rounding.
    constexpr double kFree = 0.19;
    constexpr int kSteps = 20;
    const double first = box.top() + static_cast<double>(grid.radius()) + kFlatTolerance;
    const Point middle = box.at(0, 0, 0);
    for (int n = 0; n <= kSteps; ++n) {
      const Point p{middle[0], first + kFree * n / kSteps, middle[2]};
      if (grid.clearance(floatOf(p)) != Clearance::kFree) return false;
    }
    return true;
  }

  const Scene& scene_;
  const ObjectSet& objects_;
  const Robot& robot_;
  const bake::EpisodeGeneratorOptions& options_;
  FloorOracle floor_;
  std::mt19937 random_;
  std::vector<OracleBody> arm_;
};

}  // namespace galactic::test
