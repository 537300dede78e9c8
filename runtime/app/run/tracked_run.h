#pragma once
#include <span>
#include <string>
#include <utility>
#include <vector>

#include "command_line/options.h"
#include "galactic/batch_simulator.h"
#include "galactic/error.h"
#include "galactic/world.h"
#include "view/page_assets.h"
#include "view/run_track.h"

namespace galactic {

/// The assets that a page needs to show a track: the episodes that were played, and what is in
/// them. Fails with the errors of SharedTextures and renderMeshesOf.
[[nodiscard]] Result<std::vector<PageAsset>> pageAssetsOf(const RunTrack& track);

/// Keeps track of what the first envs of a run do, and writes it as a page and as an animation.
class TrackedRun {
 public:
  /// Most steps of all tracked envs together: each takes about 200 bytes.
  static constexpr std::uint64_t kMostSteps = 1'000'000;

  /// For the run of `options`.
  TrackedRun(const World& world, const BatchSimulator& simulator, const RunOptions& options);

  /// Call it after a step with `actions`.
  void add(const BatchSimulator& simulator, std::span<const float> actions) {
    track_.add(simulator, actions);
  }
  /// Call it after the last step, even if the run ended early. Fails with kIo and the errors of
  /// viewPage and animationGlb.
  [[nodiscard]] Result<void> finish() const;

 private:
  [[nodiscard]] Result<void> writePage(std::span<const PageAsset> assets) const;
  [[nodiscard]] Result<void> writeAnimation(std::span<const PageAsset> assets) const;

  RunTrack track_;
  RunOptions options_;
};

}  // namespace galactic
