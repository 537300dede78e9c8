#include "build/make_pack.h"

#include <fmt/format.h>

#include <algorithm>
#include <system_error>
#include <utility>

#include "asset/asset_parts.h"
#include "asset/texture_packs.h"
#include "cache/cache_entry.h"
#include "cache/file_digests.h"
#include "galactic/bake/read_files.h"
#include "support/files/output_files.h"
#include "support/threads/stopwatch.h"
#include "support/try.h"

namespace galactic::bake {
namespace {

namespace fs = std::filesystem;

/// The hash of this program, because another build may bake other bytes.
Result<std::string> programDigest(FileDigests& digests) {
  ASSIGN_OR_RETURN(const auto program, digests.of("/proc/self/exe"));
  return hexOf(program);
}

std::string relativeName(const fs::path& file, const fs::path& folder) {
  std::error_code problem;
  return fs::absolute(file, problem).lexically_normal().lexically_relative(folder).generic_string();
}

/// The files that the bake read, with the content that the readers saw, for the cache.
Result<ReadFiles> readFilesOf(const ReadLog& log, const PackJob& pack, FileDigests& digests) {
  ReadFiles read;
  for (const ReadFile& file : log.files()) {
    ASSIGN_OR_RETURN(auto digest,
                     file.content ? Result<SourceFile>(*file.content) : digests.of(file.path));
    digest.name = relativeName(file.path, pack.folder);
    read.files.push_back(std::move(digest));
  }
  std::ranges::sort(read.files, {}, &SourceFile::name);
  const auto same_name = [](const SourceFile& a, const SourceFile& b) { return a.name == b.name; };
  read.files.erase(std::unique(read.files.begin(), read.files.end(), same_name), read.files.end());
  for (const fs::path& file : log.absent()) {
    read.absent.push_back(relativeName(file, pack.folder));
  }
  std::ranges::sort(read.absent);
  read.absent.erase(std::unique(read.absent.begin(), read.absent.end()), read.absent.end());
  return read;
}

/// The places of a texture pack that scenes share: for the world, and in the cache.
struct TexturePlaces {
  fs::path used;
  fs::path kept;
};

fs::path texturesOf(const PackJob& pack) {
  const auto* scene = std::get_if<SceneJob>(&pack.job);
  return scene == nullptr ? fs::path() : scene->draw.shared_textures;
}

TexturePlaces placesOf(const std::string& hash, const PackJob& pack, BuildTools& tools) {
  const std::string name = hash + ".pack";
  return {.used = texturesOf(pack) / name, .kept = tools.cache->folder() / "textures" / name};
}

/// Whether the texture packs that an earlier bake shared exist; takes them from the cache if
/// possible.
bool hasTextures(const PackJob& pack, const PackFigures& figures, BuildTools& tools) {
  const std::vector<std::string> textures = sharedTexturesOf(figures);
  if (textures.empty()) return true;
  if (!makeFolders(texturesOf(pack))) return false;
  TexturePacks& packs = tools.libraries.texturePacks();
  return std::ranges::all_of(textures, [&](const std::string& hash) {
    const TexturePlaces places = placesOf(hash, pack, tools);
    if (packs.isWhole(places.used)) return true;
    const auto take_kept = [&] { return linkOrCopy(places.kept, places.used); };
    return packs.isWhole(places.kept) && packs.provide(places.used, take_kept).has_value();
  });
}

/// Puts the textures that a bake shared into the cache, for worlds in other folders.
Result<void> keepTextures(const PackJob& pack, const PackFigures& figures, BuildTools& tools) {
  for (const std::string& hash : sharedTexturesOf(figures)) {
    const TexturePlaces places = placesOf(hash, pack, tools);
    RETURN_IF_ERROR(makeFolders(places.kept.parent_path()));
    RETURN_IF_ERROR(tools.libraries.texturePacks().provide(
        places.kept, [&] { return linkOrCopy(places.used, places.kept); }));
  }
  return {};
}

/// Turns one pack's job into its outcome.
class PackBuild {
 public:
  PackBuild(const PackJob& pack, BuildTools& tools) : pack_(pack), tools_(tools) {
    outcome_.name = pack.name;
  }

  Result<void> make(unsigned threads) {
    if (!tools_.dry_run) RETURN_IF_ERROR(makeFolders(pack_.output.parent_path()));
    if (!tools_.cache) return bakeAnew(threads);
    ASSIGN_OR_RETURN(const auto program, programDigest(tools_.libraries.digests()));
    key_ =
        fmt::format("{}program {}\npack {}\n", keyOf(pack_.job, pack_.folder), program, pack_.name);
    ASSIGN_OR_RETURN(auto cached, takeFromCache());
    return cached ? Result<void>{} : bakeAnew(threads);
  }

  [[nodiscard]] PackOutcome& outcome() { return outcome_; }

 private:
  /// Whether the cache holds the pack, which is then put at its output path.
  Result<bool> takeFromCache() {
    auto found = tools_.cache->find(key_, pack_.folder, tools_.libraries.digests());
    if (!found || !hasTextures(pack_, found->figures, tools_)) return false;
    RETURN_IF_ERROR(linkOrCopy(found->pack, pack_.output));
    outcome_.state = PackState::kUnchanged;
    outcome_.figures = std::move(found->figures);
    return true;
  }

  /// Bakes the pack and keeps it in the cache.
  Result<void> bakeAnew(unsigned threads) {
    // Take the digests before the files are read: if a file changes meanwhile, the next build finds
    // the pack to be out of date.
    if (tools_.cache) {
      for (const fs::path& file : filesOf(pack_.job)) (void)tools_.libraries.digests().of(file);
    }
    BakeContext context{
        .output = pack_.output,
        .log = outcome_.log,
        .libraries = tools_.libraries,
        .threads = threads,
        .show = [this](std::string_view item, std::string_view stage,
                       double fraction) { tools_.observer.show(item, stage, fraction); },
        .stops = [this] { return tools_.observer.stops(); },
        .dry_run = tools_.dry_run,
        .keep_going = tools_.keep_going,
        .memory = &tools_.memory};
    ASSIGN_OR_RETURN(auto made, bake(pack_.job, context));
    if (const auto* objects = std::get_if<ObjectSetOutcome>(&made.outcome)) {
      outcome_.failures = objects->failures;
      const bool is_made = tools_.keep_going && !objects->objects.empty();
      if (!objects->failures.empty() && !is_made) {
        outcome_.state = PackState::kFailed;
        return {};
      }
    }
    outcome_.state = PackState::kBaked;
    outcome_.figures = figuresOf(made);
    const bool is_kept = outcome_.failures.empty() && outcome_.log.isSettled();
    if (!tools_.cache || !is_kept) return {};
    // Only a warning, as the pack itself has been made.
    if (const auto kept = keep(); !kept) {
      outcome_.warnings.push_back("is not in the cache and will be baked again: " +
                                  kept.error().text());
    }
    return {};
  }

  Result<void> keep() {
    ASSIGN_OR_RETURN(auto read, readFilesOf(outcome_.log, pack_, tools_.libraries.digests()));
    RETURN_IF_ERROR(keepTextures(pack_, *outcome_.figures, tools_));
    return tools_.cache->store({key_, std::move(read)}, pack_.output, *outcome_.figures);
  }

  const PackJob& pack_;
  BuildTools& tools_;
  PackOutcome outcome_;
  std::string key_;
};

/// The input that error messages name.
fs::path inputOf(const PackJob& pack) {
  const auto* scene = std::get_if<SceneJob>(&pack.job);
  // All scenes of a dataset have the same input file.
  if (scene != nullptr && scene->instance) {
    return scene->input.parent_path() / scene->instance->name;
  }
  const std::vector<fs::path> files = filesOf(pack.job);
  return files.empty() ? pack.output : files.front();
}

/// The result of `bake`, with an exception turned into an error at `where`: if a pack's reader is
/// killed or its memory runs out, other packs continue.
template <class Bake>
auto resultOf(const fs::path& where, const Bake& bake) -> decltype(bake()) {
  try {
    return bake();
  } catch (...) {
    return tl::unexpected(errorOfExceptionAt(where));
  }
}

}  // namespace

PackOutcome makePack(const PackJob& pack, unsigned threads, BuildTools& tools) {
  tools.observer.begin(pack.name);
  PackBuild build(pack, tools);
  auto done = resultOf(inputOf(pack), [&] {
    const detail::Stopwatch timer(build.outcome().seconds);
    return build.make(threads);
  });
  PackOutcome& outcome = build.outcome();
  // An interrupted pack has not failed: it is still to be made.
  if (!done && done.error().code != ErrorCode::kInterrupted) {
    outcome.state = PackState::kFailed;
    outcome.figures.reset();
    outcome.failures.push_back({inputOf(pack), std::move(done.error())});
  }
  tools.observer.end(outcome);
  return std::move(outcome);
}

PackOutcome makeWorld(const PackJob& world, BuildTools& tools, std::vector<LinkedPack>& linked) {
  PackOutcome outcome{.name = world.name};
  BakeContext context{.output = world.output, .log = outcome.log, .libraries = tools.libraries};
  auto made = resultOf(world.output, [&] { return bake(world.job, context); });
  if (made) {
    outcome.state = PackState::kBaked;
    linked = std::get<WorldOutcome>(made->outcome).packs;
    outcome.figures = figuresOf(*made);
  } else {
    outcome.state = PackState::kFailed;
    // An error about the packs together names none of them.
    if (made.error().where.empty()) made.error().where = world.output.string();
    outcome.failures.push_back({world.output, std::move(made.error())});
  }
  return outcome;
}

}  // namespace galactic::bake
