#pragma once
#include <cstddef>
#include <optional>
#include <span>
#include <string>
#include <vector>

#include "galactic/error.h"
#include "galactic/pack.h"
#include "pack_tool/pictures/episode_plan.h"

namespace galactic::pack_tool {

/// Which episodes are wanted, and on what.
struct EpisodeChoice {
  /// Only this scene.
  std::optional<std::string> scene = std::nullopt;
  /// Only this episode, by its number in the pack, and its scene.
  std::optional<std::size_t> episode = std::nullopt;
  /// The grid of this radius, meters; not given: of the least.
  std::optional<float> radius = std::nullopt;
};

/// The scenes of `packs`, and those that only episodes name, by ascending names, storey by storey
/// where episodes begin in several, with the episodes of the first episode pack, if there is one;
/// packs of other kinds are passed over. Of scenes of one name the first counts. `where` names the
/// packs in errors. Fails with kInvalidInput where there are neither scenes nor episodes, no scene
/// or no episode as chosen, or no grid of the radius. The result looks into the packs.
[[nodiscard]] Result<std::vector<pictures::EpisodePlan>> episodePlansOf(
    std::span<const PackFile* const> packs, const std::string& where,
    const EpisodeChoice& choice = {});

/// What the plans of a world or of an episode pack are drawn from, without that pack itself: the
/// scenes and episodes that a world lists, or the packs of an episode pack's scenes where they lie
/// beside it or in "scenes" beside it under the scenes' names. Fails as openReference; scenes that
/// are not beside episodes are left out.
[[nodiscard]] Result<std::vector<PackFile>> openForPlans(const PackFile& pack, Trust trust);

}  // namespace galactic::pack_tool
