#include <fmt/format.h>

#include <algorithm>
#include <atomic>
#include <iterator>
#include <memory>
#include <mutex>
#include <optional>
#include <utility>

#include "asset/asset_parts.h"
#include "asset/object_journal.h"
#include "galactic/bake/mesh_import.h"
#include "galactic/bake/packs.h"
#include "galactic/bake/parallel_for.h"
#include "import/checks/asset_check.h"
#include "recipe/collection_shape.h"
#include "support/files/output_files.h"
#include "support/threads/stopwatch.h"
#include "support/try.h"

namespace galactic::bake {
namespace {

/// One object on its way from file to pack.
struct ObjectWork {
  /// Only valid if `done` holds a success.
  FinishedObject finished;
  /// None if the object was not begun.
  std::optional<Result<void>> done;
};

/// What the objects of a set share.
struct ObjectTask {
  const ObjectJob& job;
  /// None if no collection is given.
  const std::optional<Collection>& collection;
  const ObjectJournal& journal;
  /// Its `threads` are those for one object.
  BakeContext context;
};

/// The options of one object, with the shape from the collection, if any.
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

Result<void> bakeOne(const ObjectInput& input, const ObjectTask& task, FinishedObject& finished) {
  auto asset = [&] {
    const detail::Stopwatch timer(finished.import_seconds);
    return importMesh(input.path, task.job.import);
  }();
  if (!asset) return tl::unexpected(asset.error());
  // Templates of datasets define the size of their objects by a transform.
  if (!asset->unit_is_stated && !task.job.import.transform) {
    RETURN_IF_ERROR(checkObjectSize(*asset, input.path.string()));
  }
  finished.read = asset->read;
  asset->name = input.name;
  ASSIGN_OR_RETURN(const auto options, optionsOf(input.name, task, asset->warnings));
  auto object = bakeObject(*asset, options, task.context.threads);
  if (!object) {
    object.error().where = inFile(input.path, object.error().where);
    return tl::unexpected(object.error());
  }
  finished.object = std::move(*object);
  const detail::Stopwatch timer(finished.object.times.render);
  ASSIGN_OR_RETURN(
      finished.object.render_meshes,
      drawObject(*asset, task.job.draw, input.path, finished.object.warnings, task.context));
  return {};
}

/// Bakes the object unless the journal holds it. An exception does not end the bake of other
/// objects.
Result<void> finishOne(const ObjectInput& input, const ObjectTask& task, FinishedObject& finished) {
  try {
    if (auto known = task.journal.recall(input)) {
      finished = std::move(*known);
      return {};
    }
    RETURN_IF_ERROR(bakeOne(input, task, finished));
    return task.journal.add(input, finished);
  } catch (...) {
    return tl::unexpected(errorOfExceptionAt(input.path));
  }
}

std::vector<ObjectWork> bakeAll(const std::vector<ObjectInput>& inputs, ObjectTask task,
                                const BakeContext& context) {
  std::vector<ObjectWork> work(inputs.size());
  // Either several objects at once, or one at a time on all threads.
  const bool alone = inputs.size() < context.threads;
  if (!alone) task.context.threads = 1;
  std::atomic<bool> stop{false};
  std::mutex progress;
  std::size_t done = 0;
  parallelFor(alone ? 1 : context.threads, inputs.size(), [&](std::size_t n) {
    if (stop || context.stops()) return;
    work[n].done = finishOne(inputs[n], task, work[n].finished);
    if (!*work[n].done && !context.keep_going) stop = true;
    const std::lock_guard lock(progress);
    ++done;
    context.show(inputs[n].name, "box, poses, spheres",
                 static_cast<double>(done) / static_cast<double>(inputs.size()));
  });
  return work;
}

/// The error for a set that was told to stop. The journal keeps what is done.
Error interrupted(std::size_t done, std::size_t all) {
  return {ErrorCode::kInterrupted, "objects",
          fmt::format("interrupted after {} of {} objects", done, all)};
}

/// Reads the job's collection, if there is one, and adds it to the sources.
Result<std::optional<Collection>> readShapes(const std::filesystem::path& path,
                                             std::vector<SourceFile>& sources) {
  if (path.empty()) return std::nullopt;
  ASSIGN_OR_RETURN(auto collection, readCollection(path));
  RETURN_IF_ERROR(addSources({path}, sources));
  return collection;
}

/// Moves the baked objects into the outcome, and appends their files to the sources.
void collect(const std::vector<ObjectInput>& inputs, std::vector<ObjectWork> work, ReadLog& log,
             ObjectSetOutcome& outcome, std::vector<SourceFile>& sources) {
  for (std::size_t n = 0; n < work.size(); ++n) {
    if (!work[n].done) continue;
    FinishedObject& finished = work[n].finished;
    log.note(inputs[n].path.parent_path(), finished.read);
    if (!*work[n].done) {
      outcome.failures.push_back({inputs[n].path, work[n].done->error()});
      continue;
    }
    for (SourceFile& file : finished.read.files) {
      // Names in packs are never absolute.
      file.name = inputs[n].name + "/" + file.name;
      sources.push_back(std::move(file));
    }
    outcome.objects.push_back(std::move(finished.object));
    outcome.origins.push_back({inputs[n].path, finished.import_seconds});
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

Result<BakedPack> makeObjectPack(const ObjectJob& job, const BakeContext& context) {
  ObjectSetOutcome outcome;
  outcome.radii = job.shape.spheres.radii;
  ASSIGN_OR_RETURN(auto found, findObjects(job.inputs));
  std::vector<ObjectInput>& inputs = found.objects;
  outcome.warnings = std::move(found.warnings);
  if (!job.name.empty() && inputs.size() == 1) inputs.front().name = job.name;
  std::vector<SourceFile> sources;
  ASSIGN_OR_RETURN(const auto collection, readShapes(job.collection, sources));
  if (collection) std::ranges::copy(collection->warnings, std::back_inserter(outcome.warnings));
  // A single object needs no journal: it is either done or not.
  std::unique_ptr<Journal> kept;
  if (inputs.size() > 1) {
    const std::filesystem::path partial = context.output.string() + ".partial";
    for (const ObjectInput& input : inputs) RETURN_IF_ERROR(checkNotInput(partial, input.path));
    ASSIGN_OR_RETURN(kept, openJournal(Job(job), sources, context));
  }
  const ObjectJournal journal(std::move(kept), outcome.radii.size());
  collect(inputs, bakeAll(inputs, {job, collection, journal, context}, context), context.log,
          outcome, sources);
  const bool goes_on = outcome.failures.empty() || context.keep_going;
  const std::size_t ended = outcome.objects.size() + outcome.failures.size();
  if (goes_on && ended < inputs.size()) {
    return tl::unexpected(interrupted(ended, inputs.size()));
  }
  BakedPack made{.outcome = {}, .output = context.output};
  if (goes_on && !outcome.objects.empty()) {
    ASSIGN_OR_RETURN(const auto bytes, writePack(outcome, std::move(sources), job, context));
    made.pack_bytes = bytes;
    journal.remove();
  }
  made.outcome = std::move(outcome);
  return made;
}

}  // namespace

Result<BakedPack> bakeObjectFiles(const ObjectJob& job, BakeContext& context) {
  return timed<ObjectSetOutcome>([&] { return makeObjectPack(job, context); });
}

}  // namespace galactic::bake
