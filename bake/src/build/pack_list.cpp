#include "build/pack_list.h"

#include <fmt/format.h>

#include <algorithm>
#include <system_error>
#include <utility>

#include "support/try.h"

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

std::string inputOf(const PackJob& pack) { return filesOf(pack.job).front().string(); }

}  // namespace

PackList::PackList(const fs::path& world) {
  list_.world = PackJob{.name = world.filename().string(), .job = WorldJob{}, .output = world};
  list_.folder = world;
  list_.folder.replace_extension();
}

PackJob& PackList::add(const std::string& name, Job job, const fs::path& input) {
  const std::string file = name + ".pack";
  list_.assets.push_back({.name = file,
                          .job = std::move(job),
                          .output = list_.folder / file,
                          .folder = folderOf(input),
                          .source_bytes = sizeOf(input)});
  return list_.assets.back();
}

void PackList::setEpisodes(EpisodeImportJob job) {
  const fs::path folder = folderOf(job.input);
  list_.episodes = PackJob{.name = "episodes.pack",
                           .job = std::move(job),
                           .output = list_.folder / "episodes.pack",
                           .folder = folder};
}

void PackList::setEpisodes(EpisodeGenerationJob job) {
  const fs::path output = list_.folder / "episodes.pack";
  list_.episodes = PackJob{
      .name = "episodes.pack", .job = std::move(job), .output = output, .folder = folderOf(output)};
}

void PackList::setTask(std::vector<OptionText> task) {
  std::get<WorldJob>(list_.world->job).task = std::move(task);
}

Result<void> PackList::checkScenes() const {
  const auto is_scene = [](const PackJob& pack) {
    return std::holds_alternative<SceneJob>(pack.job);
  };
  if (std::ranges::any_of(list_.assets, is_scene)) return {};
  std::string why;
  if (!list_.left_out.empty()) {
    const LeftOut& first = list_.left_out.front();
    why = fmt::format(", {} are left out: {}: {}", list_.left_out.size(), first.name,
                      first.reasons.front());
  }
  return fail(ErrorCode::kInvalidInput, list_.world->output.string(),
              fmt::format("would have no scene{}; a world has at least one", why));
}

bool PackList::has(const std::string& name) const {
  return std::ranges::find(list_.assets, name + ".pack", &PackJob::name) != list_.assets.end();
}

void PackList::completeEpisodes() {
  if (!list_.episodes) return;
  auto* generation = std::get_if<EpisodeGenerationJob>(&list_.episodes->job);
  if (generation == nullptr) return;
  for (const PackJob& pack : list_.assets) generation->packs.push_back(pack.output);
  generation->details = sceneDetails(list_.assets);
}

Result<JobList> PackList::finish() {
  RETURN_IF_ERROR(checkScenes());
  std::ranges::sort(list_.assets, {}, &PackJob::name);
  const auto twice = std::ranges::adjacent_find(list_.assets, {}, &PackJob::name);
  if (twice != list_.assets.end()) {
    return fail(ErrorCode::kInvalidInput, inputOf(*std::next(twice)),
                fmt::format("would be {}, as {} is; rename one of them or leave it out",
                            twice->name, inputOf(*twice)));
  }
  completeEpisodes();
  return std::move(list_);
}

}  // namespace galactic::bake
