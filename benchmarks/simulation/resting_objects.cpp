// Nanoseconds per sphere of the query "does the robot overlap a resting object?": packed bounds
// against all boxes one by one and against one regular grid whose lists are merged.
//
// A room of 8 x 14 m holds 30 objects on tables and shelves. Robots of 29 spheres (a base, a column
// and an arm) stand anywhere in it; those that overlap an object are left out, as most steps of a
// simulation find none, and so every competitor has to look at every sphere. `envs` rooms are
// queried in turn: with 4096 of them the bounds come from the last cache level or from memory.
#include "simulation/collision/resting_objects.h"

#include <benchmark/benchmark.h>

#include <algorithm>
#include <array>
#include <bitset>
#include <cmath>
#include <cstdint>
#include <random>
#include <vector>

namespace galactic::simulation {
namespace {

constexpr std::uint32_t kObjects = 30;
constexpr float kLargestRadius = 0.12F;
constexpr Span kRoomX{0, 8};
constexpr Span kRoomZ{0, 14};
/// Few, so that their spheres stay in the first cache level, as spheres that were just computed do.
constexpr std::size_t kRobots = 16;

float between(std::mt19937& random, float lo, float hi) {
  const double share = static_cast<double>(random()) / 4294967296.0;
  return lo + static_cast<float>(share) * (hi - lo);
}

struct Item {
  OrientedBox box;
  Pose pose;
};

/// Objects in groups of up to six: what stands on one table or shelf.
std::vector<RestingBox> randomObjects(std::mt19937& random) {
  std::vector<RestingBox> boxes;
  boxes.reserve(kObjects);
  Vec3 table;
  for (std::uint32_t n = 0; n < kObjects; ++n) {
    if (n % 6 == 0) {
      table = {between(random, 0.5F, 7.5F), between(random, 0.2F, 1.4F),
               between(random, 0.5F, 13.5F)};
    }
    Item item;
    item.box.half_extents.x = between(random, 0.025F, 0.125F);
    item.box.half_extents.y = between(random, 0.025F, 0.125F);
    item.box.half_extents.z = between(random, 0.025F, 0.125F);
    item.pose.translation = table;
    item.pose.translation.x += between(random, -0.5F, 0.5F);
    item.pose.translation.z += between(random, -0.4F, 0.4F);
    const float half_turn = between(random, 0, 3.1415927F);
    item.pose.rotation = {0, std::sin(half_turn), 0, std::cos(half_turn)};
    boxes.push_back(restingBox(item.box, item.pose));
  }
  return boxes;
}

/// 9 + 12 + 8 spheres in lanes of eight.
struct Robot {
  static constexpr std::array<RadiusRange, 3> kRanges{
      {{0, 0.015F, 0, 8}, {1, 0.05F, 8, 12}, {2, 0.12F, 24, 9}}};
  static constexpr std::size_t kSpheres = 29;
  static constexpr std::size_t kRoom = 40;

  Robot(std::mt19937& random, const Vec3& base) {
    const float turn = between(random, 0, 6.2831853F);
    const Vec3 ahead{std::cos(turn), 0, std::sin(turn)};
    const Vec3 aside{-ahead.z, 0, ahead.x};
    const float reach = between(random, 0.4F, 0.9F);
    const float rise = between(random, -0.3F, 0.5F);
    for (std::uint32_t n = 0; n < 9; ++n) {
      const auto angle = static_cast<float>(n) * 0.8F;
      const float height = n < 7 ? 0.13F : 0.5F * static_cast<float>(n - 6);
      const float ring = n < 7 ? 0.2F : 0.0F;
      put(24 + n, base + ahead * (ring * std::cos(angle)) + aside * (ring * std::sin(angle)) +
                      Vec3{0, height, 0});
    }
    for (std::uint32_t n = 0; n < 20; ++n) {
      const float along = static_cast<float>(n + 1) / 20;
      const Vec3 at = base + ahead * (0.2F + reach * along) + Vec3{0, 0.8F + rise * along, 0};
      put(n < 12 ? 8 + n : n - 12, at);
    }
    fill(8 + 12, 24);
    fill(24 + 9, kRoom);
  }

  [[nodiscard]] SphereBatch batch() const { return {x.data(), y.data(), z.data(), kRanges}; }

  std::array<float, kRoom> x{}, y{}, z{};

 private:
  void put(std::size_t n, const Vec3& center) {
    x[n] = center.x;
    y[n] = center.y;
    z[n] = center.z;
  }
  void fill(std::size_t first, std::size_t end) {
    for (std::size_t n = first; n < end; ++n) put(n, {x[first - 1], y[first - 1], z[first - 1]});
  }
};

bool touchesAny(const std::vector<RestingBox>& boxes, const Vec3& center, float radius) {
  return std::any_of(boxes.begin(), boxes.end(), [&](const RestingBox& box) {
    return std::fabs(center.y - box.center.y) < box.half_height + radius &&
           overlaps(box, center, radius);
  });
}

/// Calls `touches` with each sphere until it returns true.
template <class Touches>
bool anySphere(const SphereBatch& spheres, const Touches& touches) {
  for (const RadiusRange& range : spheres.ranges) {
    for (std::uint32_t n = range.first; n < range.first + range.count; ++n) {
      if (touches(Vec3{spheres.x[n], spheres.y[n], spheres.z[n]}, range.radius)) return true;
    }
  }
  return false;
}

/// One regular grid: a sphere reads up to four cells and drops what it has seen.
class RegularGrid {
 public:
  explicit RegularGrid(const std::vector<RestingBox>& boxes) : boxes_(&boxes) {
    lists_.resize(std::size_t{kColumns} * kRows);
    for (std::size_t n = 0; n < boxes.size(); ++n) {
      const Vec3 half = halfBounds(boxes[n]);
      forEachCell(boxes[n].center, half.x, half.z, [&](std::vector<std::uint16_t>& list) {
        list.push_back(static_cast<std::uint16_t>(n));
        return false;
      });
    }
  }

  [[nodiscard]] bool touches(const Vec3& center, float radius) {
    std::bitset<kObjects> seen;
    return forEachCell(center, radius, radius, [&](const std::vector<std::uint16_t>& list) {
      return std::any_of(list.begin(), list.end(), [&](std::uint16_t n) {
        if (seen[n]) return false;
        seen[n] = true;
        const RestingBox& box = (*boxes_)[n];
        return std::fabs(center.y - box.center.y) < box.half_height + radius &&
               overlaps(box, center, radius);
      });
    });
  }

 private:
  static constexpr float kCell = 0.48F;
  static constexpr int kColumns = 17;
  static constexpr int kRows = 30;

  template <class Visit>
  bool forEachCell(const Vec3& center, float reach_x, float reach_z, const Visit& visit) {
    const auto cell = [](float at, int count) {
      return std::clamp(static_cast<int>(at / kCell), 0, count - 1);
    };
    for (int k = cell(center.z - reach_z, kRows); k <= cell(center.z + reach_z, kRows); ++k) {
      for (int i = cell(center.x - reach_x, kColumns); i <= cell(center.x + reach_x, kColumns);
           ++i) {
        if (visit(lists_[static_cast<std::size_t>(k) * kColumns + static_cast<std::size_t>(i)]))
          return true;
      }
    }
    return false;
  }

  const std::vector<RestingBox>* boxes_;
  std::vector<std::vector<std::uint16_t>> lists_;
};

/// Rooms, and for each a few robots that overlap nothing in it.
struct Workload {
  explicit Workload(std::size_t envs) {
    constexpr std::uint32_t kSeed = 501;
    std::mt19937 random(kSeed);
    rooms.reserve(envs);
    robots.reserve(kRobots);
    // Robot n stands in rooms n, n + kRobots, ..., which are furnished alike.
    for (std::size_t n = 0; n < envs; ++n) {
      rooms.push_back(n < kRobots ? randomObjects(random) : rooms[n % kRobots]);
    }
    while (robots.size() < kRobots) {
      Robot robot(random, {between(random, 0.5F, 7.5F), 0, between(random, 0.5F, 13.5F)});
      const auto& room = rooms[robots.size() % envs];
      if (!anySphere(robot.batch(), [&](const Vec3& center, float radius) {
            return touchesAny(room, center, radius);
          })) {
        robots.push_back(robot);
      }
    }
  }

  std::vector<std::vector<RestingBox>> rooms;
  std::vector<Robot> robots;
};

/// Runs `touches(room, batch)` over the rooms in turn.
template <class Touches>
void measure(benchmark::State& state, const Workload& workload, const Touches& touches) {
  const std::size_t envs = workload.rooms.size();
  std::size_t turn = 0;
  std::size_t hits = 0;
  while (state.KeepRunning()) {
    for (std::size_t n = 0; n < 1024; ++n, ++turn) {
      hits += touches(turn % envs, workload.robots[turn % kRobots].batch()) ? 1U : 0U;
    }
  }
  benchmark::DoNotOptimize(hits);
  const double queries = static_cast<double>(state.iterations()) * 1024;
  state.counters["hits"] = static_cast<double>(hits) / queries;
  state.counters["ns/sphere"] = benchmark::Counter(
      queries * Robot::kSpheres / 1e9, benchmark::Counter::kIsRate | benchmark::Counter::kInvert);
}

std::vector<RestingObjects> restingObjects(const Workload& workload) {
  std::vector<RestingObjects> envs;
  envs.reserve(workload.rooms.size());
  for (const auto& room : workload.rooms) {
    envs.emplace_back(room.size(), kLargestRadius);
    for (std::uint32_t n = 0; n < room.size(); ++n) envs.back().insert(n, room[n]);
  }
  return envs;
}

void packedBounds(benchmark::State& state) {
  const Workload workload(static_cast<std::size_t>(state.range(0)));
  const std::vector<RestingObjects> envs = restingObjects(workload);
  measure(state, workload,
          [&](std::size_t env, const SphereBatch& spheres) { return envs[env].touches(spheres); });
}

/// The same where no object is near any sphere: what most queries cost.
void packedBoundsNothingNear(benchmark::State& state) {
  const Workload workload(static_cast<std::size_t>(state.range(0)));
  std::vector<RestingObjects> envs = restingObjects(workload);
  for (RestingObjects& objects : envs) objects.clear();
  measure(state, workload,
          [&](std::size_t env, const SphereBatch& spheres) { return envs[env].touches(spheres); });
}

void allBoxes(benchmark::State& state) {
  const Workload workload(static_cast<std::size_t>(state.range(0)));
  measure(state, workload, [&](std::size_t env, const SphereBatch& spheres) {
    return anySphere(spheres, [&](const Vec3& center, float radius) {
      return touchesAny(workload.rooms[env], center, radius);
    });
  });
}

void mergedLists(benchmark::State& state) {
  const Workload workload(static_cast<std::size_t>(state.range(0)));
  std::vector<RegularGrid> envs;
  envs.reserve(workload.rooms.size());
  for (const auto& room : workload.rooms) envs.emplace_back(room);
  measure(state, workload, [&](std::size_t env, const SphereBatch& spheres) {
    return anySphere(spheres, [&](const Vec3& center, float radius) {
      return envs[env].touches(center, radius);
    });
  });
}

/// Grasp and drop: one object out of the bounds and in again.
void removeAndInsert(benchmark::State& state) {
  constexpr std::uint32_t kSeed = 502;
  std::mt19937 random(kSeed);
  const std::vector<RestingBox> room = randomObjects(random);
  RestingObjects objects(room.size(), kLargestRadius);
  for (std::uint32_t n = 0; n < room.size(); ++n) objects.insert(n, room[n]);
  std::uint32_t index = 0;
  while (state.KeepRunning()) {
    objects.remove(index);
    objects.insert(index, room[index]);
    index = (index + 1) % kObjects;
  }
}

BENCHMARK(packedBounds)->ArgName("envs")->Arg(1)->Arg(128)->Arg(4096);
BENCHMARK(packedBoundsNothingNear)->ArgName("envs")->Arg(1)->Arg(128)->Arg(4096);
BENCHMARK(allBoxes)->ArgName("envs")->Arg(1)->Arg(128)->Arg(4096);
BENCHMARK(mergedLists)->ArgName("envs")->Arg(1)->Arg(128)->Arg(4096);
BENCHMARK(removeAndInsert);

}  // namespace
}  // namespace galactic::simulation

BENCHMARK_MAIN();
