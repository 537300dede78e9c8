#include "galactic/bake/scene_baker.h"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <cmath>

#include "column_grid/way_out.h"
#include "galactic/scene.h"
#include "support/out_of_memory.h"
#include "support/threads/stopwatch.h"
#include "support/try.h"

namespace galactic::bake {
namespace {

/// A part of the free space that is left out deserves a warning if its volume is at least this
/// share of the room's.
constexpr double kWorthMentioning = 0.1;

/// Memory that one column takes while its grid is made, as measured on the sample apartment.
constexpr double kBytesPerColumn = 100;

/// Meters; the same limit as for objects and robots.
constexpr float kGreatestRadius = 10;

Result<void> checkRadii(const std::vector<float>& radii) {
  const auto invalid = [](std::string message) {
    return fail(ErrorCode::kInvalidInput, "`radii`", std::move(message));
  };
  if (radii.empty() || radii.size() > kMostRadii) {
    return invalid(fmt::format("has {} radii, expected 1 to {}", radii.size(), kMostRadii));
  }
  for (std::size_t i = 0; i < radii.size(); ++i) {
    if (!std::isfinite(radii[i]) || radii[i] <= 0) {
      return invalid(fmt::format("has the radius {} m, expected a positive length", radii[i]));
    }
    if (radii[i] > kGreatestRadius) {
      return invalid(
          fmt::format("has the radius {} m, expected at most {} m; millimeters? Give meters",
                      radii[i], kGreatestRadius));
    }
    if (i > 0 && !(radii[i] > radii[i - 1])) {
      return invalid(fmt::format("has {} m after {} m; list each radius once, in ascending order",
                                 radii[i], radii[i - 1]));
    }
  }
  return {};
}

/// Refuses a ball larger than the scene: it has no room there, and finding that out would take
/// long.
Result<void> checkFits(const std::vector<float>& radii, const Bounds& bounds) {
  const Vec3 size{bounds.max.x - bounds.min.x, bounds.max.y - bounds.min.y,
                  bounds.max.z - bounds.min.z};
  if (radii.back() <= std::max({size.x, size.y, size.z})) return {};
  return fail(ErrorCode::kInvalidInput, "`radii`",
              fmt::format("has the radius {} m, and the whole scene is {:.3g} x {:.3g} x {:.3g} m; "
                          "millimeters? Give meters, or check the scene's unit (`scale`)",
                          radii.back(), size.x, size.y, size.z));
}

/// Total length of the spans of `cells` that do not lie within one span of `lines`, up to float
/// rounding.
double freeBeyond(const Columns& cells, const Columns& lines) {
  double length = 0;
  for (std::size_t at = 0; at < cells.frame.columnCount(); ++at) {
    const std::span<const Span> allowed = lines.column(at);
    for (const Span& span : cells.column(at)) {
      const bool inside = std::any_of(allowed.begin(), allowed.end(), [&](const Span& line) {
        return line.lo - kMergeTolerance <= span.lo && span.hi <= line.hi + kMergeTolerance;
      });
      if (!inside) length += static_cast<double>(span.hi) - static_cast<double>(span.lo);
    }
  }
  return length;
}

/// Collects the warnings about the rooms of a scene, each once even if it applies to several radii.
class RegionWarnings {
 public:
  explicit RegionWarnings(const SceneBakeOptions& options) : options_(options) {}

  /// Adds the warnings for one grid. `room`: the spans that the grid keeps. Call it in ascending
  /// order of radii.
  void add(const BakedGrid& baked, const Columns& room) {
    const float radius = baked.grid.frame.radius;
    const double volume = baked.totals[static_cast<std::size_t>(Region::kRoom)].volume;
    if (!(volume > 0)) {
      const bool is_free_outside = !baked.components.empty();
      (is_free_outside ? full_rooms_ : full_).push_back(radius);
      return;
    }
    if (options_.free_space.keep == Keep::kAll) return;
    for (const Component& part : baked.components) {
      if (part.region == Region::kRoom && part.touches_border) addOpen(radius, part, room);
      const bool is_large = part.volume >= kWorthMentioning * volume;
      if (part.region == Region::kEnclosed && is_large && !part.isSlab()) {
        addClosed(radius, part, volume);
      }
      if (part.region == Region::kOutside) addYard(radius, part, baked.components);
    }
  }

  [[nodiscard]] std::vector<std::string> take() {
    if (!full_.empty()) {
      warnings_.push_back(
          fmt::format("radius {} m: no free space at all", fmt::join(full_, " m, ")));
    }
    if (!full_rooms_.empty()) {
      warnings_.push_back(
          fmt::format("radius {} m: no free space in the room; what is free outside of it is left "
                      "out, keep it with `inside`",
                      fmt::join(full_rooms_, " m, ")));
    }
    if (!open_.empty()) {
      if (open_room_) way_out_ = narrowestWay(*open_room_);
      warnings_.push_back(fmt::format(
          "radius {} m: the room is one with the outside, and all of it is stored: {}; a scan with "
          "an open door or window works as it is, and for grids of the room alone close it in the "
          "mesh",
          fmt::join(open_, " m, "), way_out_));
    }
    return std::move(warnings_);
  }

 private:
  /// Each larger radius overwrites the way out, so the warning describes the one for the largest
  /// sphere that gets out.
  void addOpen(float radius, const Component& part, const Columns& room) {
    if (open_.empty() || open_.back() != radius) open_.push_back(radius);
    if (part.columns_at_edge == 0) {
      way_out_ = part.volume_open_above >= part.volume_open_below
                     ? "it leads over the walls, there is no ceiling"
                     : "it leads under the walls, there is no floor";
      open_room_.reset();
      return;
    }
    open_room_ = room;
  }

  [[nodiscard]] std::string narrowestWay(const Columns& room) const {
    const std::optional<WayOut> way = findWayOut(room, options_.free_space.seeds);
    if (!way) return "nothing narrows the way out";
    return fmt::format(
        "the narrowest passage on the way out is at ({:.2f}, {:.2f}, {:.2f}), some {:.2f} m wide",
        way->at.x, way->at.y, way->at.z, way->width + 2 * room.frame.radius);
  }

  /// Warns if the outside has so much floor that the user may have wanted it. Only for the smallest
  /// radius.
  void addYard(float radius, const Component& outside, const std::vector<Component>& parts) {
    double floor = 0;
    for (const Component& part : parts) {
      if (part.region == Region::kRoom) floor += part.floor;
    }
    if (is_yard_known_ || !(outside.yard > 0.5 * floor)) return;
    is_yard_known_ = true;
    warnings_.push_back(
        fmt::format("radius {} m: the outside, with {:.1f} m2 of floor under the sky, is left out "
                    "(room: {:.1f} m2 of floor); keep it with `inside` or `keep-components`",
                    radius, outside.yard, floor));
  }

  /// Warns of a closed part, unless it belongs to one that a smaller radius has shown.
  void addClosed(float radius, const Component& part, double room) {
    const Bounds& bounds = part.bounds;
    const Vec3 middle = (bounds.min + bounds.max) * 0.5F;
    const bool is_known = std::ranges::any_of(known_, [&](const Bounds& known) {
      return middle.x >= known.min.x && middle.x <= known.max.x && middle.y >= known.min.y &&
             middle.y <= known.max.y && middle.z >= known.min.z && middle.z <= known.max.z;
    });
    if (is_known) return;
    known_.push_back(bounds);
    warnings_.push_back(fmt::format(
        "radius {} m: a closed part of {:.1f} m3 (room: {:.1f} m3) from ({:.2f}, {:.2f}, {:.2f}) "
        "to ({:.2f}, {:.2f}, {:.2f}) is left out; keep it with `inside` or `keep-components`",
        radius, part.volume, room, bounds.min.x, bounds.min.y, bounds.min.z, bounds.max.x,
        bounds.max.y, bounds.max.z));
  }

  const SceneBakeOptions& options_;
  /// Radii without any free space, and radii with free space only outside the room.
  std::vector<float> full_;
  std::vector<float> full_rooms_;
  std::vector<float> open_;
  std::string way_out_;
  /// The room whose way out is searched once, at the end, because the search takes long.
  std::optional<Columns> open_room_;
  std::vector<Bounds> known_;
  bool is_yard_known_ = false;
  std::vector<std::string> warnings_;
};

class SceneBaker {
 public:
  SceneBaker(const TriangleMesh& mesh, const SceneBakeOptions& options, StageTimes& times,
             unsigned threads)
      : mesh_(mesh), options_(options), times_(times), threads_(threads) {}

  Result<BakedGrid> bakeGrid(float radius, RegionWarnings& warnings) {
    ASSIGN_OR_RETURN(const auto frame, makeGridFrame(mesh_.bounds, radius, options_.spacing));
    RETURN_IF_ERROR(checkMemory(kBytesPerColumn * static_cast<double>(frame.columnCount()),
                                fmt::format("{} columns", frame.columnCount()),
                                "use a wider `spacing`"));
    ASSIGN_OR_RETURN(const auto raw, findColumns(frame));
    ASSIGN_OR_RETURN(auto free, chooseRegions(raw.columns));
    BakedGrid baked;
    {
      const detail::Stopwatch timer(times_.encode);
      baked.grid = encodeGrid(free.columns);
    }
    baked.components = std::move(free.components);
    baked.totals = free.totals;
    baked.raw_spans = raw.columns.spans.size();
    baked.merged_gaps = raw.merged_gaps;
    {
      const detail::Stopwatch timer(times_.regions);
      warnings.add(baked, free.columns);
    }
    if (wantsCheck()) baked.cast_check = check(frame, raw.columns);
    if (!room_) {
      const bool keeps_all = options_.free_space.keep == Keep::kAll;
      room_ = std::move(keeps_all ? free.room_of_all : free.columns);
    }
    return baked;
  }

 private:
  Result<ExactColumns> findColumns(const GridFrame& frame) {
    const detail::Stopwatch timer(times_.columns);
    switch (options_.engine) {
      case Engine::kBullet:
        return ExactColumns{.columns = bulletColumns(mesh_, frame, threads_)};
      case Engine::kEmbree:
        return embreeColumns(mesh_, frame, threads_).map([](Columns&& columns) {
          return ExactColumns{.columns = std::move(columns)};
        });
      case Engine::kExact:
        break;
    }
    return exactColumns(mesh_, frame, options_.coverage, threads_);
  }

  Result<FreeSpace> chooseRegions(const Columns& columns) {
    const detail::Stopwatch timer(times_.regions);
    return chooseFreeSpace(columns, options_.free_space, room_ ? &*room_ : nullptr);
  }

  /// The check uses the same casts as the Bullet engine, so it would prove nothing for that engine.
  [[nodiscard]] bool wantsCheck() const {
    return options_.check_columns > 0 && options_.engine != Engine::kBullet;
  }

  CastCheck check(const GridFrame& frame, const Columns& columns) {
    const detail::Stopwatch timer(times_.check);
    if (!caster_) caster_.emplace(mesh_);
    CastCheckOptions check_options;
    check_options.columns = options_.check_columns;
    if (options_.coverage == Coverage::kColumn) {
      return checkWithCasts(mesh_, columns, *caster_, check_options, threads_);
    }
    // Casts can only check single lines. So they check the center lines, and what is free over a
    // cell must be free on its center line.
    const ExactColumns lines = exactColumns(mesh_, frame, Coverage::kColumn, threads_);
    CastCheck check = checkWithCasts(mesh_, lines.columns, *caster_, check_options, threads_);
    check.errors += freeBeyond(columns, lines.columns);
    return check;
  }

  const TriangleMesh& mesh_;
  const SceneBakeOptions& options_;
  StageTimes& times_;
  unsigned threads_;
  std::optional<BulletColumnCaster> caster_;
  /// The room for the smallest radius; all others keep the same room.
  std::optional<Columns> room_;
};

}  // namespace

Result<BakedScene> bakeScene(const SourceAsset& asset, const SceneBakeOptions& options,
                             StageTimes& times, const Progress& progress, unsigned threads) {
  RETURN_IF_ERROR(checkRadii(options.radii));
  if (options.coverage == Coverage::kCell && options.engine != Engine::kExact) {
    return fail(ErrorCode::kInvalidInput, "`coverage`",
                "cell works with `engine` exact only: sphere casts know single lines");
  }
  progress("clean", 0);
  Result<CleanMesh> cleaned = [&] {
    const detail::Stopwatch timer(times.clean);
    return placeAndClean(asset);
  }();
  if (!cleaned) return tl::unexpected(cleaned.error());
  RETURN_IF_ERROR(checkFits(options.radii, cleaned->mesh.bounds));

  BakedScene scene;
  scene.name = asset.name;
  scene.imported = importStatisticsOf(asset, *cleaned);
  scene.bounds = cleaned->mesh.bounds;
  scene.coverage = options.coverage;
  scene.warnings = asset.warnings;

  SceneBaker baker(cleaned->mesh, options, times, threads);
  RegionWarnings warnings(options);
  for (std::size_t i = 0; i < options.radii.size(); ++i) {
    progress(fmt::format("grid r={} m", options.radii[i]),
             static_cast<double>(i) / static_cast<double>(options.radii.size()));
    ASSIGN_OR_RETURN(auto grid, baker.bakeGrid(options.radii[i], warnings));
    scene.grids.push_back(std::move(grid));
  }
  const detail::Stopwatch timer(times.regions);
  for (std::string& warning : warnings.take()) scene.warnings.push_back(std::move(warning));
  return scene;
}

}  // namespace galactic::bake
