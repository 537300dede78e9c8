#include "sensors/geodesic.h"

#include <fmt/format.h>

#include <cmath>
#include <map>
#include <tuple>
#include <utility>

#include "support/workers.h"

namespace galactic::sensors {
namespace {

/// Heights of points that share a field, meters.
constexpr float kLevel = 0.25F;

bool isNear(const Vec3& a, const Vec3& b) {
  const Vec3 apart = a - b;
  return dot(apart, apart) < kSamePlace * kSamePlace;
}

}  // namespace

Result<Geodesic> Geodesic::make(const World& world, const StandingRobot& robot,
                                const GroundOptions& ground, std::span<const Errand> errands,
                                std::uint32_t most_megabytes, std::uint32_t threads) {
  Geodesic geodesic;
  geodesic.errands_.reserve(errands.size());
  for (const Errand& errand : errands) geodesic.errands_.push_back({.errand = errand});
  geodesic.planFloors(world, robot, ground, threads);
  geodesic.listFields();
  constexpr std::size_t kMegabyte = 1'000'000;
  const std::size_t bytes = geodesic.bytes();
  if (bytes > most_megabytes * kMegabyte) {
    return fail(
        ErrorCode::kInvalidInput, "simulation options",
        fmt::format("the ways along the floor to {} targets and goals take {} MB, more than "
                    "geodesic-megabytes, which is {}; give a larger number, or a world of "
                    "fewer episodes",
                    geodesic.fields_.size(), bytes / kMegabyte + 1, most_megabytes));
  }
  detail::forEachPart(threads, geodesic.fields_.size(), [&](std::size_t n) {
    Field& field = geodesic.fields_[n];
    field.lengths = wayField(geodesic.plans_[field.plan],
                             world.scenes()[geodesic.scenes_[field.plan]], field.point);
  });
  return geodesic;
}

void Geodesic::planFloors(const World& world, const StandingRobot& robot,
                          const GroundOptions& ground, std::uint32_t threads) {
  const std::size_t scenes = world.scenes().size();
  std::vector<std::vector<FloorPlan>> plans(scenes);
  // Errands of one scene one after the other: most share the first one's plan.
  detail::forEachPart(threads, scenes, [&](std::size_t scene) {
    std::vector<FloorPlan>& known = plans[scene];
    for (Known& one : errands_) {
      if (one.errand.scene != scene) continue;
      std::uint32_t plan = 0;
      while (plan < known.size() && !known[plan].covers(one.errand.base)) ++plan;
      if (plan == known.size()) {
        known.emplace_back(world.scenes()[scene], robot, one.errand.base, ground);
      }
      one.plan = plan;
    }
  });
  std::vector<std::uint32_t> first;
  for (std::uint32_t scene = 0; scene < scenes; ++scene) {
    first.push_back(static_cast<std::uint32_t>(plans_.size()));
    for (FloorPlan& plan : plans[scene]) {
      plans_.push_back(std::move(plan));
      scenes_.push_back(scene);
    }
  }
  for (Known& one : errands_) one.plan += first[one.errand.scene];
}

void Geodesic::listFields() {
  std::map<std::tuple<std::uint32_t, std::int32_t, std::int32_t, std::int32_t>, std::uint32_t>
      numbers;
  const auto number_of = [&](std::uint32_t plan, const Vec3& point) {
    const PlanCell cell = plans_[plan].cellAt(point.x, point.z);
    const auto level = static_cast<std::int32_t>(std::floor(point.y / kLevel));
    const auto [found, is_new] = numbers.try_emplace({plan, cell.i, cell.k, level},
                                                     static_cast<std::uint32_t>(fields_.size()));
    if (is_new) fields_.push_back({.plan = plan, .point = point, .lengths = {}});
    return found->second;
  };
  for (Known& one : errands_) {
    one.to_target = number_of(one.plan, one.errand.target);
    one.to_goal = number_of(one.plan, one.errand.goal);
  }
}

std::size_t Geodesic::bytes() const noexcept {
  std::size_t bytes = 0;
  for (const Field& field : fields_) {
    bytes += plans_[field.plan].cellCount() * sizeof(std::uint16_t);
  }
  return bytes;
}

Way Geodesic::along(std::uint32_t field, const Vec3& base) const noexcept {
  return wayFrom(plans_[fields_[field].plan], fields_[field].lengths, base.x, base.z);
}

Way Geodesic::toGoal(std::uint32_t n, const Vec3& base) const noexcept {
  return along(errands_[n].to_goal, base);
}

Way Geodesic::toTarget(std::uint32_t n, const Vec3& base, const Vec3& target) const noexcept {
  const Known& known = errands_[n];
  if (isNear(target, known.errand.target)) return along(known.to_target, base);
  if (isNear(target, known.errand.goal)) return along(known.to_goal, base);
  return {};
}

}  // namespace galactic::sensors
