#include "pack_tool/figure/episode_plans.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cstddef>
#include <filesystem>
#include <functional>
#include <map>
#include <string_view>
#include <utility>

#include "galactic/episode_set.h"
#include "galactic/pack_reference.h"
#include "galactic/scene.h"
#include "pack_tool/support/open_scene.h"
#include "support/text/nearest_name.h"
#include "support/text/printable.h"
#include "support/try.h"

namespace galactic::pack_tool {

namespace {

using pictures::EpisodeMarks;
using pictures::EpisodePlan;
using PlanByScene = std::map<std::string, EpisodePlan, std::less<>>;

GroundPoint groundOf(const Vec3& point) {
  return {static_cast<double>(point.x), static_cast<double>(point.z)};
}

EpisodeMarks marksOf(const EpisodeSet& set, std::size_t number) {
  const Episode& episode = set.episodes()[number];
  EpisodeMarks marks{.number = number,
                     .start = groundOf(episode.base_position),
                     .floor = episode.base_position.y,
                     .yaw = static_cast<double>(episode.base_yaw),
                     .target = {},
                     .goal = groundOf(episode.goal.translation),
                     .others = {}};
  const auto placements = set.placements(episode);
  for (std::size_t n = 0; n < placements.size(); ++n) {
    const GroundPoint point = groundOf(placements[n].pose.translation);
    if (n == episode.target) {
      marks.target = point;
    } else {
      marks.others.push_back(point);
    }
  }
  return marks;
}

EpisodePlan& planOf(PlanByScene& plans, std::string_view scene) {
  EpisodePlan& plan = plans[std::string(scene)];
  plan.scene = scene;
  return plan;
}

Result<void> addEpisodes(const EpisodeSet& set, const std::string& where,
                         const EpisodeChoice& choice, PlanByScene& plans) {
  const std::size_t count = set.episodes().size();
  if (choice.episode && *choice.episode >= count) {
    const std::string known =
        count == 0 ? "none" : fmt::format("{}, numbered 0 to {}", count, count - 1);
    return fail(ErrorCode::kInvalidInput, where,
                fmt::format("has no episode {}; it has {}", *choice.episode, known));
  }
  for (const std::string_view scene : set.sceneNames()) planOf(plans, scene);
  for (std::size_t n = 0; n < count; ++n) {
    if (choice.episode && n != *choice.episode) continue;
    const std::string_view scene = set.sceneNames()[set.episodes()[n].scene];
    planOf(plans, scene).episodes.push_back(marksOf(set, n));
  }
  return {};
}

Result<void> addScene(const PackFile& pack, const EpisodeChoice& choice, PlanByScene& plans) {
  ASSIGN_OR_RETURN(const auto scene, sceneOf(pack));
  EpisodePlan& plan = planOf(plans, scene.name());
  const bool is_left_out =
      (choice.scene && *choice.scene != scene.name()) || (choice.episode && plan.episodes.empty());
  if (plan.grid || is_left_out) return {};
  ASSIGN_OR_RETURN(const auto grids, gridsOf(scene, pack.where(), choice.radius));
  plan.grid = grids.front();
  return {};
}

/// Adds a plan for each storey that episodes of `plan` begin in; one where there are none.
void addStoreys(EpisodePlan plan, std::vector<EpisodePlan>& plans) {
  // More than a step or the levels of one storey, less than a storey: meters between starts.
  constexpr float kApart = 1.5F;
  std::vector<EpisodeMarks> upwards = std::move(plan.episodes);
  plan.episodes.clear();
  std::ranges::stable_sort(upwards, {}, &EpisodeMarks::floor);
  const std::size_t before = plans.size();
  for (EpisodeMarks& marks : upwards) {
    const bool is_first = plans.size() == before;
    if (is_first || marks.floor - plans.back().episodes.back().floor > kApart) {
      plans.push_back(plan);
      plans.back().floor = marks.floor;
    }
    plans.back().episodes.push_back(std::move(marks));
  }
  if (plans.size() == before) plans.push_back(std::move(plan));
  const std::span<EpisodePlan> storeys(plans.begin() + static_cast<std::ptrdiff_t>(before),
                                       plans.end());
  for (std::size_t n = 0; n < storeys.size(); ++n) {
    storeys[n].storey = n + 1;
    storeys[n].storeys = storeys.size();
    std::ranges::sort(storeys[n].episodes, {}, &EpisodeMarks::number);
  }
}

std::vector<std::string> namesOf(const PlanByScene& plans) {
  std::vector<std::string> names;
  for (const auto& [name, plan] : plans) names.push_back(name);
  return names;
}

/// The pack of a scene in a file, if that is there. Fails where it is and cannot be read.
Result<std::optional<PackFile>> scenePack(const std::filesystem::path& path, std::string_view scene,
                                          Trust trust) {
  std::error_code fault;
  if (!std::filesystem::is_regular_file(path, fault)) return std::nullopt;
  ASSIGN_OR_RETURN(auto pack, PackFile::open(path, trust));
  if (pack.kind() != PackKind::kScene) return std::nullopt;
  const auto found = Scene::from(pack);
  if (!found || found->name() != scene) return std::nullopt;
  return pack;
}

/// Whether a name can be that of a file in a folder.
bool isFileName(std::string_view name) {
  return !name.empty() && std::filesystem::path(name).filename() == name && name != "." &&
         name != "..";
}

}  // namespace

Result<std::vector<EpisodePlan>> episodePlansOf(std::span<const PackFile* const> packs,
                                                const std::string& where,
                                                const EpisodeChoice& choice) {
  PlanByScene plans;
  bool has_episodes = false;
  for (const PackFile* pack : packs) {
    if (pack->kind() != PackKind::kEpisodes || has_episodes) continue;
    has_episodes = true;
    ASSIGN_OR_RETURN(const auto set, EpisodeSet::from(*pack));
    RETURN_IF_ERROR(addEpisodes(set, where, choice, plans));
  }
  for (const PackFile* pack : packs) {
    if (pack->kind() == PackKind::kScene) RETURN_IF_ERROR(addScene(*pack, choice, plans));
  }
  if (choice.episode && !has_episodes) {
    return fail(ErrorCode::kInvalidInput, where,
                fmt::format("has no episodes, wanted episode {}; give a world that lists an "
                            "episode pack (EPIS)",
                            *choice.episode));
  }
  if (choice.scene && !plans.contains(*choice.scene)) {
    return fail(ErrorCode::kInvalidInput, where,
                fmt::format("has no scene \"{}\"; {}", printable(*choice.scene),
                            printable(suggestNames(*choice.scene, namesOf(plans)))));
  }
  if (plans.empty()) {
    return fail(ErrorCode::kInvalidInput, where,
                "has neither scenes nor episodes, nothing to draw a plan of; give the packs that "
                "it lists one by one");
  }
  std::vector<EpisodePlan> chosen;
  for (auto& [name, plan] : plans) {
    if (choice.scene && name != *choice.scene) continue;
    if (choice.episode && plan.episodes.empty()) continue;
    addStoreys(std::move(plan), chosen);
  }
  if (!chosen.empty()) return chosen;
  return fail(ErrorCode::kInvalidInput, where,
              fmt::format("episode {} is not in the scene \"{}\"; leave out one of --episode and "
                          "--scene",
                          *choice.episode, printable(*choice.scene)));
}

Result<std::vector<PackFile>> openForPlans(const PackFile& pack, Trust trust) {
  std::vector<PackFile> packs;
  if (pack.kind() == PackKind::kWorld) {
    ASSIGN_OR_RETURN(const auto references, packReferences(pack));
    for (const PackReference& reference : references) {
      if (reference.kind != PackKind::kScene && reference.kind != PackKind::kEpisodes) continue;
      ASSIGN_OR_RETURN(auto listed, openReference(pack, reference, trust));
      packs.push_back(std::move(listed));
    }
    return packs;
  }
  ASSIGN_OR_RETURN(const auto set, EpisodeSet::from(pack));
  const std::filesystem::path folder = std::filesystem::path(pack.where()).parent_path();
  for (const std::string_view scene : set.sceneNames()) {
    if (!isFileName(scene)) continue;
    const std::string file = std::string(scene) + ".pack";
    for (const std::filesystem::path& path : {folder / "scenes" / file, folder / file}) {
      ASSIGN_OR_RETURN(auto beside, scenePack(path, scene, trust));
      if (!beside) continue;
      packs.push_back(std::move(*beside));
      break;
    }
  }
  return packs;
}

}  // namespace galactic::pack_tool
