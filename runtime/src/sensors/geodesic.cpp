#include "sensors/geodesic.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <map>
#include <optional>
#include <tuple>
#include <utility>

#include "support/threads/workers.h"

namespace galactic::sensors {
namespace {

/// Points that share a field are in the same band of heights, of this width, meters.
constexpr float kLevel = 0.25F;

bool isNear(const Vec3& a, const Vec3& b) {
  const Vec3 apart = a - b;
  return dot(apart, apart) < kSamePlace * kSamePlace;
}

/// Plans each floor of a scene once. Starts are handled one after the other, because most are on
/// the floor of the first.
class ScenePlanner {
 public:
  ScenePlanner(const Scene& scene, const StandingRobot& robot, const GroundOptions& ground,
               std::size_t most_bytes)
      : scene_(scene), robot_(robot), ground_(ground), most_bytes_(most_bytes) {}

  /// The number of the plan whose floor a start is on.
  std::uint32_t planOf(const Vec3& start) {
    const std::uint32_t covering =
        firstWhere([&](const FloorPlan& plan) { return plan.covers(start); });
    if (covering < plans_.size()) return covering;
    const PlanCell cell = FloorPlan::cellOf(scene_, start);
    const auto [found, is_new] = beside_.try_emplace({cell.i, cell.k, start.y}, kNowhere);
    if (is_new) found->second = planBeside(start);
    return found->second;
  }

  [[nodiscard]] std::vector<FloorPlan> take() { return std::move(plans_); }

 private:
  static constexpr std::uint32_t kNowhere = 0;

  /// The number of the plan of a start that no plan covers.
  std::uint32_t planBeside(const Vec3& start) {
    const std::optional<FloorSeed> seed = FloorPlan::seedOf(scene_, robot_, start, ground_);
    if (!seed) return kNowhere;
    const std::uint32_t known = firstWhere([&](const FloorPlan& plan) { return plan.has(*seed); });
    // Each plan gets at least one field. Beyond `most_bytes_` make() fails anyway, so no more plans
    // are made.
    if (known < plans_.size()) return known;
    if (bytes_ > most_bytes_) return kNowhere;
    plans_.emplace_back(scene_, robot_, *seed, ground_);
    bytes_ += plans_.back().cellCount() * sizeof(std::uint16_t);
    return known;
  }

  template <class Fits>
  [[nodiscard]] std::uint32_t firstWhere(const Fits& fits) const {
    return static_cast<std::uint32_t>(std::ranges::find_if(plans_, fits) - plans_.begin());
  }

  const Scene& scene_;
  const StandingRobot& robot_;
  const GroundOptions& ground_;
  std::size_t most_bytes_;
  std::size_t bytes_ = 0;
  /// The first plan is for all starts where the robot cannot stand.
  std::vector<FloorPlan> plans_{FloorPlan()};
  /// The plans of starts that no plan covered, by cell and height.
  std::map<std::tuple<std::int32_t, std::int32_t, float>, std::uint32_t> beside_;
};

}  // namespace

Result<Geodesic> Geodesic::make(const World& world, const StandingRobot& robot,
                                const GroundOptions& ground, std::span<const Errand> errands,
                                std::uint32_t most_megabytes, std::uint32_t threads) {
  Geodesic geodesic;
  geodesic.errands_.reserve(errands.size());
  for (const Errand& errand : errands) geodesic.errands_.push_back({.errand = errand});
  constexpr std::size_t kMegabyte = 1'000'000;
  geodesic.planFloors(world, robot, ground, most_megabytes * kMegabyte, threads);
  geodesic.listFields();
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
                          const GroundOptions& ground, std::size_t most_bytes,
                          std::uint32_t threads) {
  const std::size_t scenes = world.scenes().size();
  std::vector<std::vector<Known*>> in_scene(scenes);
  for (Known& one : errands_) in_scene[one.errand.scene].push_back(&one);
  std::vector<std::vector<FloorPlan>> plans(scenes);
  detail::forEachPart(threads, scenes, [&](std::size_t scene) {
    ScenePlanner planner(world.scenes()[scene], robot, ground, most_bytes);
    for (Known* one : in_scene[scene]) one->plan = planner.planOf(one->errand.base);
    plans[scene] = planner.take();
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
  const FloorPlan& plan = plans_[fields_[field].plan];
  // kBeside + 1, because the path starts in the four cells around the base, each of which may be
  // kBeside cells beside the floor.
  if (!plan.covers(base, kBeside + 1)) return {};
  return wayFrom(plan, fields_[field].lengths, base.x, base.z);
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
