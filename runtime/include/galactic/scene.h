#pragma once
#include <cstddef>
#include <optional>
#include <string_view>
#include <vector>

#include "galactic/column_grid.h"
#include "galactic/error.h"
#include "galactic/pack.h"

namespace galactic {

/// The largest number of radii in a working set.
inline constexpr std::size_t kMostRadii = 8;

/// The static scene of a scene pack: column grids ready to query.
class Scene {
 public:
  /// The scene in `pack`, which must outlive it. Fails with kInvalidInput if it is another kind of
  /// pack.
  [[nodiscard]] static Result<Scene> from(const PackFile& pack);
  static Result<Scene> from(const PackFile&& pack) = delete;

  /// The name that episodes use: EpisodeSet::sceneNames().
  [[nodiscard]] std::string_view name() const { return name_; }

  /// One grid per radius in the working set, by ascending radius.
  [[nodiscard]] const std::vector<ColumnGrid>& grids() const { return grids_; }

  /// Index of the grid of exactly this radius (within 1 micrometer); none if the radius is not in
  /// the working set. Look it up once, not in a hot loop.
  [[nodiscard]] std::optional<std::size_t> gridIndex(float radius) const;

 private:
  Scene() = default;

  std::string_view name_;
  std::vector<ColumnGrid> grids_;
};

}  // namespace galactic
