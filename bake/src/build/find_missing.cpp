#include <fmt/format.h>

#include <set>
#include <utility>

#include "dataset/dataset_library.h"
#include "galactic/bake/build.h"
#include "galactic/bake/mesh_import.h"
#include "galactic/bake/parallel_for.h"
#include "support/files/output_files.h"

namespace galactic::bake {
namespace {

namespace fs = std::filesystem;

std::string sentenceOf(const Error& error) { return error.text(); }

/// Finds what a job lacks, for each kind of job.
class MissingFiles {
 public:
  explicit MissingFiles(BakeLibraries& libraries) : libraries_(libraries) {}

  std::vector<std::string> of(const Job& job) {
    for (const fs::path& file : filesOf(job)) {
      if (!isThere(file)) add(fmt::format("{} is not there", file.string()));
    }
    if (reasons_.empty()) std::visit([this](const auto& one) { lookInto(one); }, job);
    return std::move(reasons_);
  }

 private:
  void lookInto(const SceneJob& job) {
    if (!job.instance) return lookIntoMesh(job.input, job.import);
    const auto dataset = libraries_.datasets().open(job.input, {job.import.allow_outside});
    if (!dataset) return add(sentenceOf(dataset.error()));
    const auto composed = (*dataset)->scenes.compose(job.instance->name, (*dataset)->meshes);
    if (!composed) {
      add(sentenceOf(composed.error()));
      return lookForUnreadable(job.instance->name, **dataset);
    }
    for (const std::string& missing : composed->missing) add(missing);
    // These sentences already name their meshes.
    for (const std::string& missing : composed->scene.missing) add(missing);
  }
  void lookInto(const ObjectJob& job) {
    const auto found = findObjects(job.inputs);
    if (!found) return add(sentenceOf(found.error()));
    for (const ObjectInput& object : found->objects) lookIntoMesh(object.path, job.import);
  }
  void lookInto(const RobotJob& job) {
    const auto robot = readRobotFile(job);
    if (!robot) return add(sentenceOf(robot.error()));
    const std::string file = job.input.string();
    for (const std::string& mesh : robot->missing) {
      add(fmt::format("{}: mesh '{}' is missing: it is left out", file, mesh));
    }
    for (const std::string& mesh : robot->unreadable) add(fmt::format("{}: {}", file, mesh));
    for (const SourceAsset& mesh : robot->meshes) {
      addLooks(mesh, job.input.parent_path() / mesh.read.files.front().name);
    }
  }
  template <class Other>
  void lookInto(const Other& /*job*/) {}

  void lookIntoMesh(const fs::path& mesh, const MeshImportOptions& options) {
    const auto asset = importMesh(mesh, options);
    if (!asset) return add(sentenceOf(asset.error()));
    addLooks(*asset, mesh);
  }

  /// Composing a scene ends at the first file that cannot be read. This also finds the others.
  void lookForUnreadable(const std::string& scene, OpenDataset& dataset) {
    const auto survey = dataset.scenes.survey(scene);
    if (!survey) return;
    for (const std::string& missing : survey->missing) add(missing);
    for (const fs::path& mesh : survey->meshes) {
      if (const auto asset = dataset.meshes.load(mesh); !asset) add(sentenceOf(asset.error()));
    }
  }

  /// Adds missing textures and materials, which do not prevent a mesh from being baked.
  void addLooks(const SourceAsset& asset, const fs::path& mesh) {
    for (const std::string& missing : asset.missing) {
      add(fmt::format("{}: {}", mesh.lexically_normal().string(), missing));
    }
  }

  void add(std::string sentence) {
    if (said_.insert(sentence).second) reasons_.push_back(std::move(sentence));
  }

  BakeLibraries& libraries_;
  std::set<std::string> said_;
  std::vector<std::string> reasons_;
};

}  // namespace

std::vector<LeftOut> findMissing(const WorldPlan& plan, unsigned threads,
                                 BakeLibraries& libraries) {
  std::vector<LeftOut> all(plan.assets.size());
  parallelFor(threads, all.size(), [&](std::size_t n) {
    all[n] = {plan.assets[n].name, MissingFiles(libraries).of(plan.assets[n].job)};
  });
  // Episodes are generated, and starts are drawn, in packs that do not exist yet.
  if (plan.episodes && !std::holds_alternative<EpisodeGenerationJob>(plan.episodes->job)) {
    auto import = std::get<EpisodeImportJob>(plan.episodes->job);
    import.packs.clear();
    all.push_back({plan.episodes->name, MissingFiles(libraries).of(import)});
  }
  std::erase_if(all, [](const LeftOut& one) { return one.reasons.empty(); });
  return all;
}

}  // namespace galactic::bake
