#include <algorithm>
#include <atomic>
#include <chrono>
#include <mutex>
#include <optional>
#include <utility>

#include "asset/asset_parts.h"
#include "common/stage_timer.h"
#include "galactic/bake/mesh_import.h"
#include "galactic/bake/packs.h"
#include "galactic/bake/parallel_for.h"
#include "recipe/collection_shape.h"
#include "support/try.h"

namespace galactic::bake {
namespace {

/// One object on its way from file to pack.
struct ObjectWork {
  double import_seconds = 0;
  std::vector<SourceFile> files;
  std::vector<std::string> absent_files;
  std::optional<Result<BakedObject>> baked;
};

/// What the objects of a set share.
struct ObjectTask {
  const ObjectJob& job;
  /// None where no collection is given.
  const std::optional<Collection>& collection;
};

/// The options of one object: with the shape that a collection gives it.
Result<ObjectBakeOptions> optionsOf(const std::string& name, const ObjectTask& task,
                                    std::vector<std::string>& warnings) {
  ObjectBakeOptions options = task.job.shape;
  if (!task.collection) return options;
  const auto& objects = task.collection->objects;
  const auto found = std::find_if(objects.begin(), objects.end(),
                                  [&](const CollectionObject& one) { return one.name == name; });
  if (found == objects.end()) {
    warnings.emplace_back("the collection does not name it: box and spheres are fitted");
    return options;
  }
  auto shape = shapeFromCollection(*found, *task.job.import.up, options.spheres.radii);
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

Result<BakedObject> bakeOne(const ObjectInput& input, const ObjectTask& task, ObjectWork& work) {
  auto asset = [&] {
    const StageTimer timer(work.import_seconds);
    return importMesh(input.path, task.job.import);
  }();
  if (!asset) return tl::unexpected(asset.error());
  work.files = asset->files;
  work.absent_files = asset->absent_files;
  asset->name = input.name;
  ASSIGN_OR_RETURN(const auto options, optionsOf(input.name, task, asset->warnings));
  auto object = bakeObject(*asset, options);
  if (!object) {
    object.error().where = inFile(input.path, object.error().where);
    return object;
  }
  const StageTimer timer(object->times.render);
  ASSIGN_OR_RETURN(auto meshes, drawObject(*asset, task.job.draw, input.path, object->warnings));
  object->render_meshes = std::move(meshes);
  return object;
}

std::vector<ObjectWork> bakeAll(const std::vector<ObjectInput>& inputs, const ObjectJob& job,
                                const std::optional<Collection>& collection, BakeContext& context) {
  std::vector<ObjectWork> work(inputs.size());
  // Several objects at once, or one on all threads.
  const unsigned jobs = job.shape.spheres.jobs;
  const bool alone = inputs.size() < jobs;
  Job each = job;
  if (!alone) setThreads(each, 1);
  const ObjectTask task{.job = std::get<ObjectJob>(each), .collection = collection};
  std::atomic<bool> stop{false};
  std::mutex progress;
  std::size_t done = 0;
  parallelFor(alone ? 1 : jobs, inputs.size(), [&](std::size_t n) {
    if (stop) return;
    work[n].baked = bakeOne(inputs[n], task, work[n]);
    if (!*work[n].baked && !context.keep_going) stop = true;
    const std::lock_guard lock(progress);
    ++done;
    context.show(inputs[n].name, "box, poses, spheres",
                 static_cast<double>(done) / static_cast<double>(inputs.size()));
  });
  return work;
}

/// The collection of the job, if there is one; it joins the sources.
Result<std::optional<Collection>> readShapes(const std::filesystem::path& path,
                                             std::vector<SourceFile>& sources) {
  if (path.empty()) return std::nullopt;
  ASSIGN_OR_RETURN(auto collection, readCollection(path));
  RETURN_IF_ERROR(addSources({path}, sources));
  return collection;
}

/// Moves what was baked into the outcome; the sources of the objects follow those that are there.
void collect(const std::vector<ObjectInput>& inputs, std::vector<ObjectWork> work, ReadLog& log,
             ObjectSetOutcome& outcome, std::vector<SourceFile>& sources) {
  for (std::size_t n = 0; n < work.size(); ++n) {
    if (!work[n].baked) continue;
    log.noteRead(inputs[n].path.parent_path(), work[n].files);
    log.noteAbsent(inputs[n].path.parent_path(), work[n].absent_files);
    if (!*work[n].baked) {
      outcome.failures.push_back({inputs[n].path, work[n].baked->error()});
      continue;
    }
    for (SourceFile& file : work[n].files) {
      // Never absolute.
      file.name = inputs[n].name + "/" + file.name;
      sources.push_back(std::move(file));
    }
    outcome.objects.push_back(std::move(**work[n].baked));
    outcome.origins.push_back({inputs[n].path, work[n].import_seconds});
  }
}

Result<std::uint64_t> writePack(ObjectSetOutcome& outcome, std::vector<SourceFile> sources,
                                const ObjectJob& job, const BakeContext& context) {
  RETURN_IF_ERROR(context.log.checkNotRead(context.output));
  if (context.dry_run) return 0;
  std::vector<std::string> warnings = outcome.warnings;
  for (const BakedObject& object : outcome.objects) {
    for (const std::string& warning : object.warnings) {
      warnings.push_back(object.name + ": " + warning);
    }
  }
  BakedObjectSet set{.radii = outcome.radii, .objects = std::move(outcome.objects)};
  auto bytes = writeObjectPack(context.output, set,
                               provenanceOf(job, std::move(sources), std::move(warnings)));
  outcome.objects = std::move(set.objects);
  return bytes;
}

}  // namespace

Result<Made> bakeObjectFiles(const ObjectJob& job, BakeContext& context) {
  ObjectSetOutcome outcome;
  const auto start = std::chrono::steady_clock::now();
  outcome.radii = job.shape.spheres.radii;
  ASSIGN_OR_RETURN(auto inputs, findObjects(job.inputs));
  if (!job.name.empty() && inputs.size() == 1) inputs.front().name = job.name;
  std::vector<SourceFile> sources;
  ASSIGN_OR_RETURN(const auto collection, readShapes(job.collection, sources));
  if (collection) outcome.warnings = collection->warnings;
  collect(inputs, bakeAll(inputs, job, collection, context), context.log, outcome, sources);
  const bool goes_on = outcome.failures.empty() || context.keep_going;
  Made made{.outcome = {}, .output = context.output};
  if (goes_on && !outcome.objects.empty()) {
    ASSIGN_OR_RETURN(const auto bytes, writePack(outcome, std::move(sources), job, context));
    made.pack_bytes = bytes;
  }
  outcome.seconds = std::chrono::duration<double>(std::chrono::steady_clock::now() - start).count();
  made.outcome = std::move(outcome);
  return made;
}

}  // namespace galactic::bake
