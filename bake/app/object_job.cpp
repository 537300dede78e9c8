#include "object_job.h"

#include <fmt/format.h>

#include <algorithm>
#include <atomic>
#include <mutex>
#include <optional>

#include "galactic/bake/collection_shape.h"
#include "galactic/bake/mesh_import.h"
#include "galactic/bake/object_pack.h"
#include "galactic/bake/parallel_for.h"
#include "galactic/bake/source_file.h"
#include "object_inputs.h"
#include "object_outcome.h"
#include "render_job.h"

namespace galactic::bake {
namespace {

/// One object on its way from file to pack.
struct ObjectWork {
  ObjectOutcome outcome;
  std::vector<SourceFile> files;
  std::optional<Result<BakedObject>> baked;
};

/// File names relative to the folder of the first input's object, never absolute.
void renameSources(std::vector<SourceFile>& files, const ObjectInput& input) {
  for (SourceFile& file : files) file.name = input.name + "/" + file.name;
}

/// What bakes of one command share.
struct ObjectTask {
  const BakeCommand& command;
  /// None where no collection is given.
  std::optional<Collection> collection;
  /// Whether an object has all threads.
  bool alone = false;
};

/// The options of one object: with the shape that a collection gives it.
Result<ObjectBakeOptions> optionsOf(const std::string& name, const ObjectTask& task,
                                    std::vector<std::string>& warnings) {
  ObjectBakeOptions options = task.command.object;
  if (!task.alone) options.spheres.jobs = 1;
  if (!task.collection) return options;
  const auto& objects = task.collection->objects;
  const auto found = std::find_if(objects.begin(), objects.end(),
                                  [&](const CollectionObject& one) { return one.name == name; });
  if (found == objects.end()) {
    warnings.emplace_back("the collection does not name it: box and spheres are fitted");
    return options;
  }
  auto shape = shapeFromCollection(*found, *task.command.import.up, options.spheres.radii);
  if (!shape) {
    shape.error().where = inFile(task.collection->source, shape.error().where);
    return tl::unexpected(shape.error());
  }
  if (shape->spheres.empty()) {
    warnings.emplace_back("the collection gives it no spheres: they are fitted");
  }
  options.authored = std::move(*shape);
  return options;
}

/// Adds what is drawn to an object that was baked.
void addRenderMeshes(const SourceAsset& asset, const ObjectInput& input, const ObjectTask& task,
                     ObjectWork& work) {
  const auto start = std::chrono::steady_clock::now();
  BakedObject& object = **work.baked;
  auto meshes = renderObject(asset, {task.command, input.path, task.alone ? task.command.jobs : 1},
                             object.warnings);
  if (!meshes) {
    work.baked = tl::unexpected(meshes.error());
    return;
  }
  object.render_meshes = std::move(*meshes);
  object.times.render = secondsSince(start);
}

void bakeObjectFile(const ObjectInput& input, const ObjectTask& task, ObjectWork& work) {
  work.outcome.input = input.path;
  const auto start = std::chrono::steady_clock::now();
  auto asset = importMesh(input.path, task.command.import);
  work.outcome.import_seconds = secondsSince(start);
  if (!asset) {
    work.baked = tl::unexpected(asset.error());
    return;
  }
  work.files = asset->files;
  asset->name = input.name;
  const auto options = optionsOf(input.name, task, asset->warnings);
  if (!options) {
    work.baked = tl::unexpected(options.error());
    return;
  }
  work.baked = bakeObject(*asset, *options);
  if (!*work.baked) {
    work.baked->error().where = inFile(input.path, work.baked->error().where);
    return;
  }
  addRenderMeshes(*asset, input, task, work);
}

std::vector<ObjectWork> bakeAll(const std::vector<ObjectInput>& inputs,
                                std::optional<Collection> collection, BakeRun& run) {
  const BakeCommand& command = run.command();
  std::vector<ObjectWork> work(inputs.size());
  // Several objects at once, or one on all threads.
  const ObjectTask task{.command = command,
                        .collection = std::move(collection),
                        .alone = inputs.size() < command.jobs};
  std::atomic<bool> stop{false};
  std::mutex progress;
  std::size_t done = 0;
  parallelFor(task.alone ? 1 : command.jobs, inputs.size(), [&](std::size_t n) {
    if (stop) return;
    bakeObjectFile(inputs[n], task, work[n]);
    if (!*work[n].baked && !command.keep_going) stop = true;
    const std::lock_guard lock(progress);
    ++done;
    run.line().show(inputs[n].name, "box, poses, spheres",
                    static_cast<double>(done) / static_cast<double>(inputs.size()));
  });
  run.line().clear();
  return work;
}

Result<std::uint64_t> writePack(const ObjectSetOutcome& outcome, const BakedObjectSet& set,
                                std::vector<SourceFile> sources, const BakeRun& run) {
  if (auto checked = run.checkNotRead(outcome.output); !checked) {
    return tl::unexpected(checked.error());
  }
  if (run.command().dry_run) return 0;
  std::vector<std::string> warnings = outcome.warnings;
  for (const BakedObject& object : set.objects) {
    for (const std::string& warning : object.warnings) {
      warnings.push_back(object.name + ": " + warning);
    }
  }
  return writeObjectPack(outcome.output, set,
                         provenanceOf(run.command(), std::move(sources), std::move(warnings)));
}

/// The collection of the command, if there is one; it joins the sources.
Result<std::optional<Collection>> readShapes(const std::filesystem::path& path,
                                             std::vector<SourceFile>& sources) {
  if (path.empty()) return std::nullopt;
  auto collection = readCollection(path);
  if (!collection) return tl::unexpected(collection.error());
  auto file = describeFile(path);
  if (!file) return tl::unexpected(file.error());
  sources.push_back(std::move(*file));
  return std::move(*collection);
}

}  // namespace

void bakeObjectFiles(BakeRun& run) {
  const BakeCommand& command = run.command();
  const auto start = std::chrono::steady_clock::now();
  ObjectSetOutcome outcome;
  outcome.output = run.outputFor(command.inputs.front());
  outcome.radii = command.object.spheres.radii;
  auto inputs = findObjects(command.inputs);
  if (!inputs) return run.fail(command.inputs.front(), inputs.error());
  if (!command.asset_name.empty() && inputs->size() == 1) inputs->front().name = command.asset_name;
  std::vector<SourceFile> sources;
  auto collection = readShapes(command.collection, sources);
  if (!collection) return run.fail(command.collection, collection.error());
  if (*collection) outcome.warnings = (*collection)->warnings;
  std::vector<ObjectWork> work = bakeAll(*inputs, std::move(*collection), run);

  BakedObjectSet set{.radii = outcome.radii, .objects = {}};
  std::vector<ObjectOutcome> outcomes;
  for (std::size_t n = 0; n < work.size(); ++n) {
    if (!work[n].baked) continue;
    run.noteRead((*inputs)[n].path.parent_path(), work[n].files);
    if (!*work[n].baked) {
      run.fail((*inputs)[n].path, work[n].baked->error());
      continue;
    }
    renameSources(work[n].files, (*inputs)[n]);
    sources.insert(sources.end(), work[n].files.begin(), work[n].files.end());
    set.objects.push_back(std::move(**work[n].baked));
    outcomes.push_back(work[n].outcome);
  }
  if (!run.goesOn() || set.objects.empty()) return;
  const auto bytes = writePack(outcome, set, std::move(sources), run);
  if (!bytes) return run.fail(outcome.output, bytes.error());
  outcome.pack_bytes = *bytes;
  outcome.seconds = secondsSince(start);
  if (command.saysMore()) printObjectTable(outcome, set.objects, command.verbosity);
  for (std::size_t n = 0; n < set.objects.size(); ++n) {
    run.succeed(objectReport(set.objects[n], outcomes[n], outcome));
  }
}

}  // namespace galactic::bake
