#include "plan/pack_list.h"

#include <fmt/format.h>

#include <algorithm>
#include <system_error>

#include "plan/scene_details.h"

namespace galactic::bake {
namespace {

namespace fs = std::filesystem;

std::uint64_t sizeOf(const fs::path& file) {
  std::error_code problem;
  const std::uintmax_t bytes = fs::file_size(file, problem);
  return problem ? 0 : bytes;
}

fs::path folderOf(const fs::path& file) {
  std::error_code problem;
  const fs::path absolute = fs::absolute(file, problem);
  return (problem ? file : absolute).lexically_normal().parent_path();
}

}  // namespace

PackList::PackList(fs::path world) {
  plan_.world = std::move(world);
  plan_.folder = plan_.world;
  plan_.folder.replace_extension();
}

PlannedPack& PackList::add(const std::string& name, BakeCommand command, const fs::path& input) {
  PlannedPack pack;
  pack.name = name + ".pack";
  pack.command = std::move(command);
  pack.command.output = plan_.folder / pack.name;
  pack.folder = folderOf(input);
  pack.source_bytes = sizeOf(input);
  plan_.assets.push_back(std::move(pack));
  return plan_.assets.back();
}

void PackList::setEpisodes(BakeCommand command) {
  PlannedPack pack;
  pack.name = "episodes.pack";
  pack.command = std::move(command);
  pack.command.output = plan_.folder / pack.name;
  plan_.episodes = std::move(pack);
}

Result<void> PackList::checkScenes() const {
  const auto is_scene = [](const PlannedPack& pack) {
    return pack.command.kind == AssetKind::kScene;
  };
  if (std::ranges::any_of(plan_.assets, is_scene)) return {};
  std::string why;
  if (!plan_.left_out.empty()) {
    const LeftOut& first = plan_.left_out.front();
    why = fmt::format(", {} are left out: {}: {}", plan_.left_out.size(), first.name,
                      first.reasons.front());
  }
  return fail(ErrorCode::kInvalidInput, plan_.world.string(),
              fmt::format("would have no scene{}; a world has at least one", why));
}

bool PackList::has(const std::string& name) const {
  return std::any_of(plan_.assets.begin(), plan_.assets.end(),
                     [&](const PlannedPack& pack) { return pack.name == name + ".pack"; });
}

Result<WorldPlan> PackList::finish() {
  if (auto checked = checkScenes(); !checked) return tl::unexpected(checked.error());
  const auto name = [](const PlannedPack& pack) -> const std::string& { return pack.name; };
  std::ranges::sort(plan_.assets, {}, name);
  const auto twice = std::ranges::adjacent_find(plan_.assets, {}, name);
  if (twice != plan_.assets.end()) {
    return fail(ErrorCode::kInvalidInput, std::next(twice)->command.inputs.front().string(),
                fmt::format("would be {}, as {} is; rename one of them or leave it out",
                            twice->name, twice->command.inputs.front().string()));
  }
  if (plan_.episodes) {
    PlannedPack& episodes = *plan_.episodes;
    if (episodes.command.inputs.empty()) {
      for (const PlannedPack& pack : plan_.assets) {
        episodes.command.inputs.push_back(pack.command.output);
      }
      episodes.command.episodes.details = sceneDetails(plan_.assets);
      episodes.folder = folderOf(plan_.folder / episodes.name);
    } else {
      episodes.folder = folderOf(episodes.command.inputs.front());
    }
  }
  return std::move(plan_);
}

}  // namespace galactic::bake
