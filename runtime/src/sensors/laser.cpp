#include "sensors/laser.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <bit>
#include <cmath>
#include <numbers>
#include <string>
#include <utility>

#include "support/text/height_text.h"
#include "support/threads/workers.h"
#include "support/try.h"

namespace galactic::sensors {
namespace {

using simulation::RestingBox;

/// Settings of a robot whose recipe has no laser: meters and radians.
constexpr float kHeight = 0.25F;
constexpr float kRange = 10.0F;
/// The limit of the options.
constexpr std::size_t kMostBeams = 1024;

float orRobots(float option, float robots) { return option < 0 ? robots : option; }

tl::unexpected<Error> refuse(const std::string& message) {
  return fail(ErrorCode::kInvalidInput, "simulation options", message);
}

/// Takes the place, field of view, ranges and noise from the recipe's laser.
Result<void> mount(const Robot& robot, const simulation::MotionModel& motion,
                   LaserSettings& settings) {
  const RobotLaser& laser = *robot.laser();
  const simulation::FixedFrame& link = motion.links[laser.link];
  if (link.node >= 0) {
    return fail(
        ErrorCode::kUnsupported,
        "robot " + std::string(robot.name()) + ", link " + std::string(robot.linkName(laser.link)),
        "carries the laser, and an action or an episode moves it; a planar laser must be "
        "fixed to the base");
  }
  const auto to_base = [&link](const Vec3& v) {
    return link.x_axis * v.x + link.y_axis * v.y + link.z_axis * v.z;
  };
  const Vec3 origin = link.origin + to_base(laser.link_from_laser.translation);
  const Vec3 middle = to_base(rotate(laser.link_from_laser.rotation, {1, 0, 0}));
  settings.ahead = origin.x;
  settings.right = origin.z;
  settings.yaw = angleOf(-middle.z, middle.x);
  const float height = origin.y + motion.base.root_height;
  settings.heights = {{height, height}};
  settings.field_of_view = std::min(laser.field_of_view, kFullTurn);
  settings.range = laser.range;
  settings.least_range = laser.least_range;
  settings.noise = laser.noise;
  return {};
}

/// Heights of the floors that are stood on, for each scene, ascending; those within kFloorBand
/// count as one.
std::vector<std::vector<float>> floorsOf(std::span<const StoodOn> stood_on, std::size_t scenes) {
  std::vector<std::vector<float>> heights(scenes);
  for (const StoodOn& one : stood_on) heights[one.scene].push_back(one.floor);
  for (std::vector<float>& all : heights) {
    std::ranges::sort(all);
    std::vector<float> bands;
    for (std::size_t first = 0; first < all.size();) {
      std::size_t last = first;
      while (last + 1 < all.size() && all[last + 1] <= all[first] + kFloorBand) ++last;
      bands.push_back(0.5F * (all[first] + all[last]));
      first = last + 1;
    }
    all = std::move(bands);
  }
  return heights;
}

}  // namespace

Result<LaserSettings> laserSettings(const LaserOptions& options, const Robot& robot,
                                    const simulation::MotionModel& motion) {
  LaserSettings settings{
      .heights = {{kHeight, kHeight}}, .field_of_view = kFullTurn, .range = kRange};
  settings.beams = options.beams;
  if (options.beams == 0) return settings;
  if (robot.laser()) {
    RETURN_IF_ERROR(mount(robot, motion, settings));
  }
  if (!options.heights.empty()) settings.heights = options.heights;
  constexpr float kDegree = std::numbers::pi_v<float> / 180;
  settings.field_of_view =
      options.fov_degrees < 0 ? settings.field_of_view : options.fov_degrees * kDegree;
  settings.range = orRobots(options.range, settings.range);
  settings.least_range = orRobots(options.least_range, settings.least_range);
  if (options.noise.least >= 0) settings.noise = options.noise;
  if (options.beams > kMostBeams) {
    return refuse(fmt::format("laser-beams is {}, expected at most {}", options.beams, kMostBeams));
  }
  if (!(settings.range > settings.least_range)) {
    return refuse(
        fmt::format("laser-range is {} m and laser-min-range {} m, expected a range above "
                    "the least one",
                    settings.range, settings.least_range));
  }
  return settings;
}

Result<Laser> Laser::make(const LaserSettings& settings, const World& world,
                          std::span<const StoodOn> floors, std::uint32_t threads) {
  Laser laser;
  laser.settings_ = settings;
  if (settings.beams == 0) return laser;
  laser.kernels_ = scanKernels();
  laser.aimBeams();
  const std::vector<Scene>& scenes = world.scenes();
  struct Cut {
    std::uint32_t scene;
    float floor;
    Span above;
    ScanPlane* plane;
  };
  std::vector<Cut> cuts;
  laser.floors_.resize(scenes.size());
  const std::vector<std::vector<float>> heights = floorsOf(floors, scenes.size());
  for (std::uint32_t scene = 0; scene < scenes.size(); ++scene) {
    for (const float floor : heights[scene]) {
      laser.floors_[scene].push_back({floor, std::vector<ScanPlane>(settings.heights.size())});
    }
    for (Floor& floor : laser.floors_[scene]) {
      for (std::size_t n = 0; n < settings.heights.size(); ++n) {
        cuts.push_back({scene, floor.height, settings.heights[n], &floor.planes[n]});
      }
    }
  }
  detail::forEachPart(threads, cuts.size(), [&](std::size_t n) {
    const Cut& cut = cuts[n];
    const Span cut_at{cut.floor + cut.above.lo, cut.floor + cut.above.hi};
    *cut.plane = ScanPlane(scenes[cut.scene].grids().front(), cut_at);
  });
  for (const Cut& cut : cuts) {
    if (cut.plane->freeCells() != 0) continue;
    const Span known = scenes[cut.scene].grids().front().heights();
    return refuse(fmt::format(
        "the laser scans scene {} {} m above the floor at {:.3f} m, where nothing is free "
        "(its grids reach from {:.3g} to {:.3g} m); give other laser-heights",
        scenes[cut.scene].name(), heightText({&cut.above, 1}), cut.floor, known.lo, known.hi));
  }
  return laser;
}

void Laser::aimBeams() {
  const std::uint32_t beams = settings_.beams;
  const std::size_t padded = simulation::paddedToLanes(beams);
  beams_ahead_.resize(padded);
  beams_right_.resize(padded);
  const auto field = static_cast<double>(settings_.field_of_view);
  // In a whole turn the last beam must not coincide with the first.
  const bool is_round = settings_.field_of_view >= kFullTurn;
  const std::uint32_t gaps = is_round && beams > 1 ? beams : beams - 1;
  for (std::uint32_t n = 0; n < padded; ++n) {
    const std::uint32_t beam = std::min(n, beams - 1);
    const double share = gaps == 0 ? 0.5 : static_cast<double>(beam) / gaps;
    const double angle = static_cast<double>(settings_.yaw) + field * (share - 0.5);
    beams_ahead_[n] = static_cast<float>(std::cos(angle));
    beams_right_[n] = static_cast<float>(-std::sin(angle));
  }
}

const Laser::Floor& Laser::floorAt(std::uint32_t scene, float height) const noexcept {
  const std::vector<Floor>& floors = floors_[scene];
  const Floor* nearest = &floors.front();
  for (const Floor& floor : floors) {
    if (std::fabs(floor.height - height) < std::fabs(nearest->height - height)) nearest = &floor;
  }
  return *nearest;
}

void Laser::scan(const LaserView& view, std::span<float> out) const noexcept {
  if (settings_.beams == 0) return;
  const Floor& floor = floorAt(view.scene, view.base.y);
  std::array<float, kMostBeams> room;
  RandomStream random = view.random;
  for (std::size_t n = 0; n < settings_.heights.size(); ++n) {
    const Vec3 origin{view.base.x + view.cosine * settings_.ahead + view.sine * settings_.right,
                      view.base.y,
                      view.base.z - view.sine * settings_.ahead + view.cosine * settings_.right};
    const std::span<float> distances = std::span(room).first(beams_ahead_.size());
    scanPlane(view, floor.planes[n].view(), settings_.heights[n], origin, distances);
    finish(distances, view.noise, random, out.subspan(n * settings_.beams, settings_.beams));
  }
}

void Laser::scanPlane(const LaserView& view, const ScanPlaneView& plane, const Span& heights,
                      const Vec3& origin, std::span<float> distances) const noexcept {
  BeamBatch beams{.origin = origin,
                  .cosine = view.cosine,
                  .sine = view.sine,
                  .ahead = beams_ahead_.data(),
                  .right = beams_right_.data(),
                  .count = beams_ahead_.size(),
                  .range = settings_.range};
  kernels_.cast_scene(plane, beams, distances.data());
  const Span within{origin.y + heights.lo, origin.y + heights.hi};
  view.objects.forEachBetween(within, [&](const RestingBox& box, float y) {
    const Vec3 half = simulation::halfBounds(box);
    const float reach = settings_.range + half.x + half.z;
    const Vec3 away = box.center - origin;
    if (std::fabs(away.x) > reach || std::fabs(away.z) > reach) return;
    beams.origin.y = y;
    kernels_.cast_box(box, beams, distances.data());
  });
}

void Laser::finish(std::span<const float> distances, float noise, RandomStream& random,
                   std::span<float> out) const noexcept {
  const float range = settings_.range;
  for (std::size_t n = 0; n < out.size(); ++n) {
    float distance = distances[n];
    // A beam that hits nothing measures nothing, so it gets no noise.
    if (noise > 0 && distance < range) distance += noise * random.nearlyNormal();
    out[n] = std::clamp(distance, settings_.least_range, range) / range;
  }
}

std::size_t Laser::bytes() const {
  std::size_t bytes = 0;
  for (const std::vector<Floor>& floors : floors_) {
    for (const Floor& floor : floors) {
      for (const ScanPlane& plane : floor.planes) bytes += plane.bytes();
    }
  }
  return bytes;
}

}  // namespace galactic::sensors
