#include "build/pack_list.h"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <set>
#include <system_error>
#include <utility>

#include "asset/asset_parts.h"
#include "common/folder_entries.h"
#include "robot_description/named_files.h"
#include "support/try.h"

namespace galactic::bake {
namespace {

namespace fs = std::filesystem;

fs::path folderOf(const fs::path& file) {
  std::error_code problem;
  const fs::path absolute = fs::absolute(file, problem);
  return (problem ? file : absolute).lexically_normal().parent_path();
}

/// The radii of a job; null if its kind has none.
const std::vector<float>* radiiOf(const Job& job) {
  if (const auto* scene = std::get_if<SceneJob>(&job)) return &scene->grids.radii;
  if (const auto* object = std::get_if<ObjectJob>(&job)) return &object->shape.spheres.radii;
  if (const auto* robot = std::get_if<RobotJob>(&job)) return &robot->shape.radii;
  return nullptr;
}

/// The import options of the job's robot, or the defaults if it has none.
RobotImportOptions importOptionsOf(const Job& job) {
  const auto* robot = std::get_if<RobotJob>(&job);
  return robot == nullptr ? RobotImportOptions() : robotOptionsOf(*robot);
}

std::string inputOf(const PackJob& pack) { return filesOf(pack.job).front().string(); }

}  // namespace

PackList::PackList(const fs::path& world) {
  plan_.world.name = world.filename().string();
  plan_.world.output = world;
  plan_.folder = world;
  plan_.folder.replace_extension();
}

PackJob& PackList::add(const std::string& name, Job job, const fs::path& input) {
  const std::string file = name + ".pack";
  const std::uint64_t bytes = bytesWithNamedFiles(input, importOptionsOf(job));
  plan_.assets.push_back({.name = file,
                          .job = std::move(job),
                          .output = plan_.folder / file,
                          .folder = folderOf(input),
                          .source_bytes = bytes});
  return plan_.assets.back();
}

void PackList::addMovable(const std::string& name, ObjectJob job) {
  const fs::path mesh = job.inputs.front();
  add(name, std::move(job), mesh);
  ++plan_.movable_objects;
}

void PackList::setEpisodes(EpisodeImportJob job) {
  const fs::path folder = folderOf(job.input);
  plan_.episodes = PackJob{.name = "episodes.pack",
                           .job = std::move(job),
                           .output = plan_.folder / "episodes.pack",
                           .folder = folder};
}

void PackList::setEpisodes(EpisodeGenerationJob job) {
  const fs::path output = plan_.folder / "episodes.pack";
  plan_.episodes = PackJob{
      .name = "episodes.pack", .job = std::move(job), .output = output, .folder = folderOf(output)};
}

void PackList::setTask(std::vector<OptionText> task) {
  std::get<WorldJob>(plan_.world.job).task = std::move(task);
}

Result<void> PackList::checkScenes() const {
  const auto is_scene = [](const PackJob& pack) {
    return std::holds_alternative<SceneJob>(pack.job);
  };
  if (std::ranges::any_of(plan_.assets, is_scene)) return {};
  if (!plan_.broken.empty()) return tl::unexpected(plan_.broken.front().failure.error);
  std::string why;
  if (!plan_.left_out.empty()) {
    const LeftOut& first = plan_.left_out.front();
    const std::size_t count = plan_.left_out.size();
    why = fmt::format(", {} {} left out: {}: {}", count, count == 1 ? "is" : "are", first.name,
                      first.reasons.front());
  }
  return fail(ErrorCode::kInvalidInput, plan_.world.output.string(),
              fmt::format("would have no scene{}; a world has at least one", why));
}

Result<void> PackList::checkFolder() const {
  const fs::path folder = plan_.folder.lexically_normal();
  for (const PackJob& pack : plan_.assets) {
    const fs::path below = pack.output.lexically_normal().lexically_relative(folder);
    if (!below.empty() && *below.begin() != "..") continue;
    return fail(ErrorCode::kInvalidInput, inputOf(pack),
                fmt::format("would be {}, outside of {}, where the world's packs go; rename it",
                            pack.output.string(), plan_.folder.string()));
  }
  return {};
}

Result<void> PackList::checkInputFolders() const {
  const auto refuse = [this](const std::string& whose) {
    return fail(ErrorCode::kInvalidInput, plan_.world.output.string(),
                fmt::format("its packs would be written into {}, {}; name another world with `out` "
                            "OTHER.pack",
                            plan_.folder.string(), whose));
  };
  const fs::path packs = canonicalPath(plan_.folder);
  for (const fs::path& folder : input_folders_) {
    if (liesWithin(packs, canonicalPath(folder))) {
      return refuse("which is the folder of scans " + folder.string() + " or inside it");
    }
  }
  // Many packs have their input in the same folder, which is checked only once.
  std::set<fs::path> seen;
  for (const PackJob& pack : plan_.assets) {
    if (!seen.insert(pack.folder).second) continue;
    if (liesWithin(canonicalPath(pack.folder), packs)) {
      return refuse("where the input " + inputOf(pack) + " is");
    }
  }
  return {};
}

Result<void> PackList::checkRadii() const {
  const PackJob* first = nullptr;
  for (const PackJob& pack : plan_.assets) {
    const std::vector<float>* radii = radiiOf(pack.job);
    if (radii == nullptr) continue;
    if (first == nullptr) first = &pack;
    if (*radii == *radiiOf(first->job)) continue;
    return fail(
        ErrorCode::kInvalidInput, pack.name,
        fmt::format("would be baked for spheres of {} m, {} for {}: give all packs of a "
                    "world the same `radii`, best in [bake]",
                    fmt::join(*radii, ", "), first->name, fmt::join(*radiiOf(first->job), ", ")));
  }
  return {};
}

Result<void> PackList::checkForEpisodes() const {
  // What is missing may be in one of the broken scenes.
  if (!plan_.broken.empty()) return {};
  const auto lacks = [](const char* what) {
    return fail(ErrorCode::kInvalidInput, "",
                fmt::format("episodes are generated for a robot and objects, and there is no {}; "
                            "add it, or leave [episodes] out",
                            what));
  };
  const auto job_is = [](const auto& is_wanted) {
    return [&](const PackJob& pack) { return is_wanted(pack.job); };
  };
  const auto is_object = [](const Job& job) { return std::holds_alternative<ObjectJob>(job); };
  const auto is_robot = [](const Job& job) { return std::holds_alternative<RobotJob>(job); };
  if (std::ranges::none_of(plan_.assets, job_is(is_object))) return lacks("[[objects]]");
  const auto robot = std::ranges::find_if(plan_.assets, job_is(is_robot));
  if (robot == plan_.assets.end()) return lacks("[robot]");
  if (std::get<RobotJob>(robot->job).recipe.empty()) return lacks("[robot] with a recipe");
  return {};
}

void PackList::warn(const std::string& warning) {
  if (std::ranges::find(plan_.warnings, warning) != plan_.warnings.end()) return;
  plan_.warnings.push_back(warning);
}

const PackJob* PackList::find(const std::string& name) const {
  const auto found = std::ranges::find(plan_.assets, name + ".pack", &PackJob::name);
  return found == plan_.assets.end() ? nullptr : &*found;
}

/// Whether there is everything except scenes that drawing starts requires.
bool PackList::hasObjectsAndRobot() const {
  const auto is_object = [](const PackJob& pack) {
    return std::holds_alternative<ObjectJob>(pack.job);
  };
  const auto is_robot = [](const PackJob& pack) {
    return std::holds_alternative<RobotJob>(pack.job);
  };
  return std::ranges::any_of(plan_.assets, is_object) &&
         std::ranges::any_of(plan_.assets, is_robot);
}

void PackList::completeEpisodes() {
  if (!plan_.episodes) return;
  if (auto* import = std::get_if<EpisodeImportJob>(&plan_.episodes->job)) {
    if (!hasObjectsAndRobot()) return;
    for (const PackJob& pack : plan_.assets) import->packs.push_back(pack.output);
    return;
  }
  auto* generation = std::get_if<EpisodeGenerationJob>(&plan_.episodes->job);
  if (generation == nullptr) return;
  for (const PackJob& pack : plan_.assets) {
    generation->packs.push_back(pack.output);
    const auto* scene = std::get_if<SceneJob>(&pack.job);
    if (scene != nullptr) generation->scenes.emplace(nameOf(*scene), *scene);
  }
}

Result<WorldPlan> PackList::finish() {
  RETURN_IF_ERROR(checkScenes());
  RETURN_IF_ERROR(checkFolder());
  RETURN_IF_ERROR(checkInputFolders());
  std::ranges::sort(plan_.assets, {}, &PackJob::name);
  const auto twice = std::ranges::adjacent_find(plan_.assets, {}, &PackJob::name);
  if (twice != plan_.assets.end()) {
    return fail(ErrorCode::kInvalidInput, inputOf(*std::next(twice)),
                fmt::format("would be {}, as {} is; rename one of them or leave it out",
                            twice->name, inputOf(*twice)));
  }
  completeEpisodes();
  return std::move(plan_);
}

}  // namespace galactic::bake
