#pragma once
#include <cstddef>
#include <optional>
#include <span>
#include <string>
#include <vector>

#include "galactic/column_grid.h"
#include "galactic/error.h"
#include "pack_tool/mesh/grid_view.h"
#include "pack_tool/pictures/figure_picture.h"
#include "pack_tool/pictures/pictures.h"
#include "pictures/image.h"

namespace galactic::pictures {

/// An episode seen from above.
struct EpisodeMarks {
  /// In its pack.
  std::size_t number = 0;
  pack_tool::GroundPoint start;
  /// Height of the ground there, meters.
  float floor = 0;
  /// Where the robot looks at the start, radians: 0 along +X, positive towards -Z.
  double yaw = 0;
  pack_tool::GroundPoint target;
  pack_tool::GroundPoint goal;
  /// Where the objects are that are not the target.
  std::vector<pack_tool::GroundPoint> others;
};

/// A scene from above, and the episodes in it: those of one storey, where it has several with
/// episodes.
struct EpisodePlan {
  std::string scene;
  /// None where the scene's pack is not there: then marks are drawn on blank paper.
  std::optional<ColumnGrid> grid = std::nullopt;
  std::vector<EpisodeMarks> episodes = {};
  /// Height of the floor that it shows, meters; none: the lowest.
  std::optional<float> floor = std::nullopt;
  /// Which one this is of the storeys with episodes, from 1 on, upwards, and how many there are.
  std::size_t storey = 1;
  std::size_t storeys = 1;
};

inline constexpr int kDefaultEpisodePlan = 1000;

/// Draws a storey from above in gray, and on it where the robot starts and looks to, the targets
/// and the goals of its episodes. Of up to a dozen episodes, targets are joined with their goals
/// and starts have numbers; of a single one the other objects are shown. Marks that lie outside of
/// the grid, or nowhere, are counted. `width`: about that of the plot, pixels, up to kLargestPlot.
/// Safe to call from many threads.
[[nodiscard]] Picture drawEpisodePlan(const EpisodePlan& plan, int width = kDefaultEpisodePlan);

/// Draws plans on one sheet, row by row, each at its own scale in a square of `view_size` pixels.
/// Fails as Sheet::create does. `plans` must not be empty. Else as drawEpisodePlan.
[[nodiscard]] Result<Image> drawEpisodeSheet(std::span<const EpisodePlan> plans,
                                             int view_size = kDefaultTileSize);

}  // namespace galactic::pictures
