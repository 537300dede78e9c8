#include "plan/bake_planned.h"

#include <fmt/format.h>

#include <algorithm>
#include <system_error>
#include <utility>

#include "bake_inputs.h"
#include "galactic/bake/source_file.h"
#include "galactic/pack_header.h"
#include "scene_job.h"

namespace galactic::bake {
namespace {

namespace fs = std::filesystem;

/// This program's own content: another build may bake other bytes.
Result<std::string> programDigest(FileDigests& digests) {
  const auto program = digests.of("/proc/self/exe");
  if (!program) return tl::unexpected(program.error());
  return fmt::format("{:016x}{:016x}", program->hash_high, program->hash_low);
}

std::string relativeName(const fs::path& file, const fs::path& folder) {
  std::error_code problem;
  return fs::absolute(file, problem).lexically_normal().lexically_relative(folder).generic_string();
}

/// Everything but the content of files that decides the pack's bytes.
std::string keyOf(const PlannedPack& pack, const std::string& program) {
  const BakeCommand& command = pack.command;
  std::string key = fmt::format("galactic-bake {} {}\n{}\n", GALACTIC_VERSION, program, pack.name);
  for (const auto& options : {command.content_options, command.typed_options}) {
    for (const auto& [name, value] : options) key += fmt::format("{}={}\n", name, value);
  }
  for (const auto& [name, folder] : command.robot.packages) {
    key += fmt::format("package {}={}\n", name, folder.string());
  }
  for (const auto& [scene, file] : command.episodes.geometry) {
    key += fmt::format("geometry {}={}\n", scene, relativeName(file, pack.folder));
  }
  for (const fs::path& file : command.namedFiles()) {
    key += fmt::format("file {}\n", relativeName(file, pack.folder));
  }
  if (command.import.up) key += fmt::format("up {}\n", static_cast<int>(*command.import.up));
  if (command.import.transform)
    key += fmt::format("{}\n", fmt::join(*command.import.transform, ","));
  if (pack.scene) {
    key += fmt::format("scene {} {:016x}\n", pack.scene->name, pack.scene->dataset->fingerprint());
  }
  return key;
}

/// The entry of the report, or why there is none.
void bake(const PlannedPack& pack, BakeRun& run) {
  if (!pack.scene) return bakeInputs(run);
  auto entry = bakeInstancedScene(*pack.scene, run);
  if (entry) return run.succeed(std::move(*entry));
  run.fail(pack.scene->dataset->folder() / pack.scene->name, entry.error());
}

/// What the run read, for the cache: with the content that the readers saw.
Result<BakeInputs> inputsOf(const BakeRun& run, const PlannedPack& pack, FileDigests& digests) {
  BakeInputs inputs;
  inputs.folder = pack.folder;
  for (const ReadFile& file : run.filesRead()) {
    auto digest = file.content ? Result<SourceFile>(*file.content) : digests.of(file.path);
    if (!digest) return tl::unexpected(digest.error());
    digest->name = relativeName(file.path, pack.folder);
    inputs.files.push_back(std::move(*digest));
  }
  const auto name = [](const SourceFile& file) -> const std::string& { return file.name; };
  std::ranges::sort(inputs.files, {}, name);
  const auto same_name = [](const SourceFile& a, const SourceFile& b) { return a.name == b.name; };
  inputs.files.erase(std::unique(inputs.files.begin(), inputs.files.end(), same_name),
                     inputs.files.end());
  for (const fs::path& file : run.absentFiles()) {
    inputs.absent.push_back(relativeName(file, pack.folder));
  }
  return inputs;
}

Result<void> makeFolder(const fs::path& folder) {
  std::error_code problem;
  fs::create_directories(folder, problem);
  if (!problem) return {};
  return fail(ErrorCode::kIo, folder.string(), "cannot be made a folder: " + problem.message());
}

/// Where a texture pack that scenes share is kept, by its name below the plan's folder.
struct TexturePlaces {
  fs::path used;
  fs::path kept;
};

TexturePlaces placesOf(const std::string& texture, const PlannedPack& pack,
                       const PlanTools& tools) {
  const fs::path name = fs::path(texture).filename();
  return {.used = pack.command.render.shared_textures / name,
          .kept = tools.cache->folder() / "textures" / name};
}

/// Whether the texture packs are there, or put there, that a bake of before shared.
bool hasTextures(const PlannedPack& pack, const Json& entry, const PlanTools& tools) {
  const std::vector<std::string> textures = texturePacks(entry);
  if (textures.empty()) return true;
  if (!makeFolder(pack.command.render.shared_textures)) return false;
  return std::ranges::all_of(textures, [&](const std::string& texture) {
    const auto [used, kept] = placesOf(texture, pack, tools);
    if (tools.textures.isWhole(used)) return true;
    return tools.textures.isWhole(kept) && linkOrCopy(kept, used).has_value();
  });
}

/// Keeps what a bake shared, for worlds in other folders.
Result<void> keepTextures(const PlannedPack& pack, const Json& entry, const PlanTools& tools) {
  for (const std::string& texture : texturePacks(entry)) {
    const auto [used, kept] = placesOf(texture, pack, tools);
    if (auto made = makeFolder(kept.parent_path()); !made) return made;
    if (tools.textures.isWhole(kept)) continue;
    if (auto linked = linkOrCopy(used, kept); !linked) return linked;
  }
  return {};
}

/// The pack as it was made before, put where it belongs.
Result<std::optional<Json>> fromCache(const PlannedPack& pack, const std::string& key,
                                      const PlanTools& tools) {
  const auto found = tools.cache->find(key, pack.folder, tools.digests);
  if (!found) return std::nullopt;
  Json entry = Json::parse(found->report, nullptr, /*allow_exceptions=*/false);
  // It says which textures belong to the pack: without it the pack is made again.
  if (entry.is_discarded()) return std::nullopt;
  if (!hasTextures(pack, entry, tools)) return std::nullopt;
  if (auto linked = linkOrCopy(found->pack, pack.command.output); !linked) {
    return tl::unexpected(linked.error());
  }
  // It may have been made for another folder.
  if (entry.is_object() && entry.contains("output")) {
    entry["output"] = pack.command.output.string();
  }
  return std::optional<Json>(std::move(entry));
}

/// Bakes the pack and keeps it in the cache.
Result<Json> bakeAnew(const PlannedPack& pack, const std::string& key, const PlanTools& tools) {
  BakeCommand command = pack.command;
  command.setJobs(tools.jobs);
  command.verbosity = Verbosity::kSilent;
  BakeRun run(command);
  // Before they are read: should one change meanwhile, the pack is found to be old the next time.
  for (const ReadFile& file : run.filesRead()) (void)tools.digests.of(file.path);
  bake(pack, run);
  if (!run.failures().empty()) return tl::unexpected(run.failures().front().error);
  Json entry = run.baked().size() == 1 ? run.baked().front() : Json(run.baked());
  if (tools.cache == nullptr) return entry;
  auto inputs = inputsOf(run, pack, tools.digests);
  if (!inputs) return tl::unexpected(inputs.error());
  inputs->key = key;
  if (auto kept = keepTextures(pack, entry, tools); !kept) return tl::unexpected(kept.error());
  if (auto kept = tools.cache->store(*inputs, command.output, entry.dump()); !kept) {
    return tl::unexpected(kept.error());
  }
  return entry;
}

Result<Json> make(const PlannedPack& pack, const PlanTools& tools, PackState& state) {
  if (auto made = makeFolder(pack.command.output.parent_path()); !made) {
    return tl::unexpected(made.error());
  }
  const auto program = programDigest(tools.digests);
  if (!program) return tl::unexpected(program.error());
  const std::string key = keyOf(pack, *program);
  if (tools.cache != nullptr) {
    auto cached = fromCache(pack, key, tools);
    if (!cached) return tl::unexpected(cached.error());
    state = PackState::kUnchanged;
    if (*cached) return std::move(**cached);
  }
  state = PackState::kBaked;
  return bakeAnew(pack, key, tools);
}

}  // namespace

PackOutcome bakePlanned(const PlannedPack& pack, const PlanTools& tools) {
  const auto start = std::chrono::steady_clock::now();
  PackOutcome outcome;
  outcome.name = pack.name;
  auto entry = make(pack, tools, outcome.state);
  outcome.seconds = secondsSince(start);
  if (entry) {
    if (entry->is_object()) outcome.entry = std::move(*entry);
  } else {
    outcome.state = PackState::kFailed;
    outcome.error = entry.error();
  }
  return outcome;
}

}  // namespace galactic::bake
