#include "object_job.h"

#include <atomic>
#include <mutex>
#include <optional>

#include "galactic/bake/mesh_import.h"
#include "galactic/bake/object_pack.h"
#include "galactic/bake/parallel_for.h"
#include "object_inputs.h"
#include "object_outcome.h"

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

void bakeObjectFile(const ObjectInput& input, const BakeCommand& command, bool alone,
                    ObjectWork& work) {
  work.outcome.input = input.path;
  const auto start = std::chrono::steady_clock::now();
  auto asset = importMesh(input.path, command.import);
  work.outcome.import_seconds = secondsSince(start);
  if (!asset) {
    work.baked = tl::unexpected(asset.error());
    return;
  }
  work.files = asset->files;
  asset->name = input.name;
  ObjectBakeOptions options = command.object;
  if (!alone) options.spheres.jobs = 1;
  work.baked = bakeObject(*asset, options);
  if (!*work.baked) work.baked->error().where = inFile(input.path, work.baked->error().where);
}

std::vector<ObjectWork> bakeAll(const std::vector<ObjectInput>& inputs, BakeRun& run) {
  const BakeCommand& command = run.command();
  std::vector<ObjectWork> work(inputs.size());
  // Several objects at once, or one on all threads.
  const bool alone = inputs.size() < command.jobs;
  std::atomic<bool> stop{false};
  std::mutex progress;
  std::size_t done = 0;
  parallelFor(alone ? 1 : command.jobs, inputs.size(), [&](std::size_t n) {
    if (stop) return;
    bakeObjectFile(inputs[n], command, alone, work[n]);
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
  std::vector<std::string> warnings;
  for (const BakedObject& object : set.objects) {
    for (const std::string& warning : object.warnings) {
      warnings.push_back(object.name + ": " + warning);
    }
  }
  return writeObjectPack(outcome.output, set,
                         provenanceOf(run.command(), std::move(sources), std::move(warnings)));
}

}  // namespace

void bakeObjectFiles(BakeRun& run) {
  const BakeCommand& command = run.command();
  const auto start = std::chrono::steady_clock::now();
  ObjectSetOutcome outcome;
  outcome.output = run.outputFor(command.inputs.front());
  outcome.radii = command.object.spheres.radii;
  const auto inputs = findObjects(command.inputs);
  if (!inputs) return run.fail(command.inputs.front(), inputs.error());
  std::vector<ObjectWork> work = bakeAll(*inputs, run);

  BakedObjectSet set{.radii = outcome.radii, .objects = {}};
  std::vector<SourceFile> sources;
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
  if (command.verbosity != Verbosity::kQuiet) printObjectTable(outcome, set.objects);
  for (std::size_t n = 0; n < set.objects.size(); ++n) {
    run.succeed(objectReport(set.objects[n], outcomes[n], outcome));
  }
}

}  // namespace galactic::bake
