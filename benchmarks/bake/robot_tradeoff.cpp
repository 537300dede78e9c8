// Sphere sets of a whole robot by budget, with one yardstick, as a markdown table.
//
//   robot_tradeoff ROBOT.urdf [--recipe FILE] [--by-hand COLLECTION.json] [--budgets N,N,...]
//                             [--ground METERS]
//
// All joints stand at 0 and the robot on the ground: the surface is that of all links (collision
// geometry, else what is seen), hidden parts left out; points lower than 20 mm need no cover. The
// ground is at the robot's lowest point, or where --ground says: wheels may reach below it.
// Lengths are in millimeters, mean / 95th percentile / maximum. Seconds are of wall clock, spheres
// only.
#include <fmt/format.h>

#include <CLI/CLI.hpp>
#include <algorithm>
#include <cstdio>
#include <exception>
#include <filesystem>
#include <limits>
#include <optional>
#include <string>
#include <thread>
#include <vector>

#include "galactic/bake/robot_baker.h"
#include "galactic/bake/robot_import.h"
#include "galactic/bake/robot_recipe.h"
#include "recipe/collection_import.h"
#include "support/try.h"

namespace galactic::bake {
namespace {

constexpr float kClipHeight = 0.020F;

struct Request {
  std::filesystem::path urdf;
  std::filesystem::path recipe;
  std::filesystem::path by_hand;
  std::vector<std::uint32_t> budgets{29, 48, 64, 100, 0};
  /// Height in the root's frame.
  std::optional<float> ground;
};

/// The whole robot in the world, all joints at 0.
class Yardstick {
 public:
  Yardstick(const BakedRobot& robot, std::optional<float> ground) : robot_(robot) {
    const std::vector<float> zero(robot.kinematics.limits.size(), 0.0F);
    poses_.resize(robot.kinematics.links.size());
    forwardKinematics(robot.kinematics.links, {}, zero, poses_);
    for (std::size_t n = 0; n < poses_.size(); ++n) {
      const Surface& collision = robot.collision_surfaces[n];
      add(collision.empty() ? robot.visual_surfaces[n] : collision, poses_[n]);
    }
    float lowest = std::numeric_limits<float>::max();
    for (const Vec3& v : mesh_.vertices) lowest = std::min(lowest, v.y);
    options_.radii = robot.radii;
    options_.support = HalfSpace{{0, 1, 0}, ground.value_or(lowest) + kClipHeight};
  }

  [[nodiscard]] Result<SphereSetQuality> measure() const {
    std::vector<SetSphere> spheres;
    for (const BakedGroup& group : robot_.groups) {
      for (SetSphere sphere : group.spheres.spheres) {
        sphere.center = poses_[group.link] * sphere.center;
        spheres.push_back(sphere);
      }
    }
    return measureSphereSet(mesh_, spheres, options_);
  }

 private:
  void add(const Surface& surface, const Pose& world_from_link) {
    const auto first = static_cast<std::uint32_t>(mesh_.vertices.size());
    for (const Vec3& p : surface.positions) {
      mesh_.vertices.push_back(world_from_link * p);
      const Vec3& v = mesh_.vertices.back();
      if (mesh_.vertices.size() == 1) mesh_.bounds = {v, v};
      mesh_.bounds.min = {std::min(mesh_.bounds.min.x, v.x), std::min(mesh_.bounds.min.y, v.y),
                          std::min(mesh_.bounds.min.z, v.z)};
      mesh_.bounds.max = {std::max(mesh_.bounds.max.x, v.x), std::max(mesh_.bounds.max.y, v.y),
                          std::max(mesh_.bounds.max.z, v.z)};
    }
    for (const Triangle& t : surface.triangles) {
      mesh_.triangles.push_back({first + t[0], first + t[1], first + t[2]});
    }
  }

  const BakedRobot& robot_;
  std::vector<Pose> poses_;
  TriangleMesh mesh_;
  SphereSetOptions options_;
};

std::string inMillimeters(const LengthStatistics& lengths) {
  return fmt::format("{:.1f} / {:.1f} / {:.1f}", 1000 * lengths.mean, 1000 * lengths.p95,
                     1000 * lengths.max);
}

Result<void> printRow(const std::string& label, const SourceRobot& source,
                      const RobotRecipe* recipe, const RobotBakeOptions& options,
                      std::optional<float> ground) {
  ASSIGN_OR_RETURN(const auto robot, bakeRobot(source, recipe, options,
                                               std::max(1U, std::thread::hardware_concurrency())));
  ASSIGN_OR_RETURN(const auto quality, Yardstick(robot, ground).measure());
  std::vector<std::size_t> counts(robot.radii.size());
  std::size_t all = 0;
  for (const BakedGroup& group : robot.groups) {
    for (const SetSphere& sphere : group.spheres.spheres) {
      ++counts[counts.size() - 1 - sphere.radius_index];
      ++all;
    }
  }
  fmt::print("| {} | {} ({}) | {} | {} | {:.2f} | {:.1f} |\n", label, all, fmt::join(counts, "/"),
             inMillimeters(quality.gap), inMillimeters(quality.protrusion), quality.volume_ratio,
             robot.times.spheres);
  std::fflush(stdout);
  return {};
}

Result<void> printTable(const Request& request) {
  RobotImportOptions import;
  import.allow_missing = true;
  ASSIGN_OR_RETURN(const auto source, importRobot(request.urdf, import));
  RobotBakeOptions options;
  fmt::print(
      "| set | spheres | gap | protrusion | volume | seconds |\n|---|---|---|---|---|---|\n");
  if (!request.by_hand.empty()) {
    ASSIGN_OR_RETURN(const auto collection, readCollection(request.by_hand));
    ASSIGN_OR_RETURN(const auto converted, recipeFromCollection(collection, source));
    const auto printed = printRow("by hand", source, &converted.recipe, options, request.ground);
    if (!printed) return printed;
  }
  std::optional<RobotRecipe> recipe;
  if (!request.recipe.empty()) {
    ASSIGN_OR_RETURN(auto read, readRobotRecipe(request.recipe));
    recipe = std::move(read);
  }
  for (const std::uint32_t budget : request.budgets) {
    options.max_spheres = budget;
    const auto printed = printRow(budget == 0 ? "no limit" : fmt::format("at most {}", budget),
                                  source, recipe ? &*recipe : nullptr, options, request.ground);
    if (!printed) return printed;
  }
  return {};
}

}  // namespace
}  // namespace galactic::bake

int main(int argc, char** argv) {
  CLI::App app("Sphere sets of a whole robot by budget.");
  galactic::bake::Request request;
  app.add_option("urdf", request.urdf, "The robot")->required();
  app.add_option("--recipe", request.recipe, "Robot recipe (TOML)");
  app.add_option("--by-hand", request.by_hand, "Published collection with hand-placed spheres");
  app.add_option("--ground", request.ground, "Height of the ground in the root's frame, meters");
  app.add_option("--budgets", request.budgets, "Most spheres, 0 for no limit")->delimiter(',');
  CLI11_PARSE(app, argc, argv);
  try {
    const auto printed = galactic::bake::printTable(request);
    if (printed) return 0;
    fmt::print(stderr, "{}: {}\n", printed.error().where, printed.error().message);
    return static_cast<int>(printed.error().code);
  } catch (const std::exception& error) {
    fmt::print(stderr, "robot_tradeoff: {}\n", error.what());
    return 4;
  }
}
