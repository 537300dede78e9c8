// How often a nearest-column query is wrong between the columns: false-free and false-blocked rates
// of both coverages, as the markdown tables of docs/column_grids.md.
//
//   coverage_rates [--positions N] SCENE...
//
// Positions are drawn uniformly over the scene's bounds until N of them are free in truth and in
// the room. All rates are in per cent of those N: false-free are draws that touch something and are
// answered free, false-blocked are those of the N that are not answered free.
#include <fmt/format.h>

#include <CLI/CLI.hpp>
#include <algorithm>
#include <array>
#include <cmath>
#include <cstdint>
#include <cstdio>
#include <exception>
#include <filesystem>
#include <random>
#include <string>
#include <vector>

#include "galactic/bake/column_engines.h"
#include "galactic/bake/columns.h"
#include "galactic/bake/mesh_import.h"
#include "galactic/bake/triangle_mesh.h"
#include "support/oracles/column_oracle.h"
#include "support/oracles/distance_oracle.h"
#include "support/oracles/encoded_grid_view.h"
#include "support/try.h"

namespace galactic::bake {
namespace {

constexpr std::uint32_t kSeed = 20250315;
constexpr std::array kRadii{0.015F, 0.05F, 0.12F};
/// Distances are known up to here: the greatest radius and what counts as near contact.
constexpr double kNear = 0.05;
constexpr double kReach = 0.18;

/// One way to bake a grid, and the wrong answers of that grid.
struct Mode {
  Coverage coverage = Coverage::kColumn;
  float spacing = 0;
  EncodedGrid grid;
  std::uint64_t false_blocked = 0;
  /// How deep the falsely free spheres are inside an obstacle, meters.
  std::vector<double> depths{};
  /// Its answer for the current position.
  bool answered_free = false;
};

Result<Mode> makeMode(const TriangleMesh& mesh, float radius, float spacing, Coverage coverage) {
  ASSIGN_OR_RETURN(const auto frame, makeGridFrame(mesh.bounds, radius, spacing));
  const ExactColumns raw = exactColumns(mesh, frame, coverage, 2);
  ASSIGN_OR_RETURN(const auto free, chooseFreeSpace(raw.columns));
  return Mode{coverage, spacing, encodeGrid(free.columns)};
}

/// Whether a position that is free in truth belongs to the room: its own column's free span, found
/// by brute force, overlaps a stored span of one of the four columns around it.
class RoomJudge {
 public:
  RoomJudge(const test::ColumnOracle& oracle, const EncodedGrid& grid)
      : oracle_(oracle), frame_(grid.frame), view_(test::viewOf(grid)) {}

  [[nodiscard]] bool isInRoom(const bake::Point& at) const {
    const auto radius = static_cast<double>(frame_.radius);
    for (const HeightInterval& own : oracle_.freeSpans(at[0], at[2], frame_, radius)) {
      if (at[1] < own.lo || at[1] > own.hi) continue;
      return meetsRoom(at, own);
    }
    return false;
  }

 private:
  [[nodiscard]] bool meetsRoom(const bake::Point& at, const HeightInterval& own) const {
    const auto spacing = static_cast<double>(frame_.spacing);
    const double i = std::floor((at[0] - static_cast<double>(frame_.min_x)) / spacing - 0.5);
    const double k = std::floor((at[2] - static_cast<double>(frame_.min_z)) / spacing - 0.5);
    std::array<Span, 64> spans;
    for (const double column : {i, i + 1}) {
      for (const double row : {k, k + 1}) {
        if (column < 0 || row < 0 || column >= frame_.columns_x || row >= frame_.columns_z) {
          continue;
        }
        const std::size_t count =
            view_.spans(static_cast<std::uint32_t>(column), static_cast<std::uint32_t>(row), spans);
        for (std::size_t s = 0; s < std::min(count, spans.size()); ++s) {
          if (static_cast<double>(spans[s].lo) < own.hi &&
              static_cast<double>(spans[s].hi) > own.lo) {
            return true;
          }
        }
      }
    }
    return false;
  }

  const test::ColumnOracle& oracle_;
  GridFrame frame_;
  ColumnGrid view_;
};

/// What one radius' positions were.
struct Positions {
  std::uint64_t drawn = 0;
  std::uint64_t in_room = 0;
  std::uint64_t near = 0;
};

/// Everything that decides in truth.
struct Truth {
  const TriangleMesh& mesh;
  test::DistanceOracle distances;
  test::ColumnOracle columns;

  explicit Truth(const TriangleMesh& scene)
      : mesh(scene), distances(scene, kReach), columns(scene, kReach) {}
};

/// Asks every grid for a center that is `depth` inside an obstacle (outside where it is negative);
/// returns whether any says free.
bool askModes(const Vec3& center, double depth, std::vector<Mode>& modes) {
  bool any_free = false;
  for (Mode& mode : modes) {
    mode.answered_free = test::viewOf(mode.grid).clearance(center) == Clearance::kFree;
    any_free = any_free || mode.answered_free;
    if (mode.answered_free && depth > 0) mode.depths.push_back(depth);
  }
  return any_free;
}

Positions ask(const Truth& truth, std::uint64_t wanted, std::vector<Mode>& modes) {
  const auto radius = static_cast<double>(modes[0].grid.frame.radius);
  // The finest grid of the columns' own lines knows best where the room is.
  const auto& judge_mode =
      *std::min_element(modes.begin(), modes.end(), [](const Mode& a, const Mode& b) {
        return a.coverage != b.coverage ? a.coverage < b.coverage : a.spacing < b.spacing;
      });
  const RoomJudge judge(truth.columns, judge_mode.grid);
  std::mt19937 random(kSeed);
  const auto number = [&](float lo, float hi) {
    return std::uniform_real_distribution<float>(lo, hi)(random);
  };
  const Bounds& bounds = truth.mesh.bounds;
  Positions positions;
  while (positions.in_room < wanted && positions.drawn < 100 * wanted) {
    ++positions.drawn;
    const Vec3 center{number(bounds.min.x, bounds.max.x), number(bounds.min.y, bounds.max.y),
                      number(bounds.min.z, bounds.max.z)};
    const double distance = truth.distances.distance(test::toPoint(center));
    const double depth = radius - distance;
    const bool any_free = askModes(center, depth, modes);
    if (depth > 0 || !(any_free || judge.isInRoom(test::toPoint(center)))) continue;
    ++positions.in_room;
    positions.near += distance < radius + kNear ? 1U : 0U;
    for (Mode& mode : modes) mode.false_blocked += mode.answered_free ? 0U : 1U;
  }
  return positions;
}

void printRow(const Mode& mode, const Positions& positions) {
  std::vector<double> depths = mode.depths;
  std::sort(depths.begin(), depths.end());
  double mean = 0;
  double p99 = 0;
  double most = 0;
  if (!depths.empty()) {
    for (const double depth : depths) mean += depth / static_cast<double>(depths.size());
    p99 = depths[(depths.size() - 1) * 99 / 100];
    most = depths.back();
  }
  const auto percent = [&](std::uint64_t count) {
    return 100 * static_cast<double>(count) / static_cast<double>(positions.in_room);
  };
  fmt::print("| {} | {} | {} | {:.4f} ({}) | {:.1f} / {:.1f} / {:.1f} | {:.3f} | {:.1f} |\n",
             mode.grid.frame.radius, mode.spacing * 100,
             mode.coverage == Coverage::kCell ? "cell" : "column", percent(depths.size()),
             depths.size(), 1000 * mean, 1000 * p99, 1000 * most, percent(mode.false_blocked),
             static_cast<double>(storedBytes(mode.grid)) / 1e6);
}

Result<void> measure(const std::filesystem::path& scene, std::uint64_t wanted) {
  ASSIGN_OR_RETURN(const auto asset, importMesh(scene));
  ASSIGN_OR_RETURN(const auto clean, placeAndClean(asset));
  const Truth truth(clean.mesh);
  fmt::print("\n**{}** ({} triangles)\n\n", scene.filename().string(), clean.mesh.triangles.size());
  fmt::print(
      "| radius, m | spacing, cm | coverage | falsely free, % (count) | depth of those, mm: mean / "
      "p99 / max | falsely blocked, % | MB |\n|---|---|---|---|---|---|---|\n");
  std::string notes;
  for (const float radius : kRadii) {
    std::vector<Mode> modes;
    for (const float spacing : {0.03F, 0.015F}) {
      for (const Coverage coverage : {Coverage::kColumn, Coverage::kCell}) {
        ASSIGN_OR_RETURN(auto mode, makeMode(clean.mesh, radius, spacing, coverage));
        modes.push_back(std::move(mode));
      }
    }
    const Positions positions = ask(truth, wanted, modes);
    for (const Mode& mode : modes) printRow(mode, positions);
    notes += fmt::format(
        "radius {} m: {} positions drawn, {} of them free and in the room, {:.1f} % "
        "of these within {:.0f} cm of contact\n",
        radius, positions.drawn, positions.in_room,
        100 * static_cast<double>(positions.near) / static_cast<double>(positions.in_room),
        100 * kNear);
  }
  fmt::print("\n{}", notes);
  return {};
}

}  // namespace
}  // namespace galactic::bake

int main(int argc, char** argv) {
  try {
    CLI::App app("False-free and false-blocked rates of column grids, as markdown tables");
    std::vector<std::string> scenes;
    std::uint64_t positions = 1'000'000;
    app.add_option("SCENE", scenes, "Meshes to bake and query")->required();
    app.add_option("--positions", positions, "Free positions per scene and radius");
    CLI11_PARSE(app, argc, argv);
    for (const std::string& scene : scenes) {
      const auto measured = galactic::bake::measure(scene, positions);
      if (!measured) {
        fmt::print(stderr, "coverage_rates: {}: {}\n", measured.error().where,
                   measured.error().message);
        return static_cast<int>(measured.error().code);
      }
    }
    return 0;
  } catch (const std::exception& error) {
    std::fputs(error.what(), stderr);
    return static_cast<int>(galactic::ErrorCode::kInternal);
  }
}
