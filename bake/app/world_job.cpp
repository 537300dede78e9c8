#include "world_job.h"

#include <fmt/format.h>

#include <algorithm>
#include <cstdint>
#include <utility>

#include "galactic/bake/world_pack.h"
#include "galactic/printable.h"

namespace galactic::bake {
namespace {

/// What became of a world.
struct WorldOutcome {
  std::filesystem::path output;
  std::vector<LinkedPack> packs;
  /// Size of the world pack itself; 0 for a dry run.
  std::uint64_t pack_bytes = 0;
  double seconds = 0;
};

void printWorldTable(const WorldOutcome& outcome) {
  std::uint64_t bytes = 0;
  int width = 0;
  for (const LinkedPack& pack : outcome.packs) {
    bytes += pack.bytes;
    width = std::max(width, static_cast<int>(pack.path.size()));
  }
  fmt::print("{} packs -> {}\n", outcome.packs.size(),
             outcome.pack_bytes > 0 ? outcome.output.string() : "(dry run)");
  for (const LinkedPack& pack : outcome.packs) {
    fmt::print("  {} {:<{}} {:>9.2f} MB\n", packKindName(pack.kind), printable(pack.path), width,
               static_cast<double>(pack.bytes) / 1e6);
  }
  fmt::print("  {:.3f} s; {:.2f} MB listed\n", outcome.seconds, static_cast<double>(bytes) / 1e6);
}

Json worldReport(const WorldOutcome& outcome) {
  Json json{{"output", outcome.output.string()}, {"pack_bytes", outcome.pack_bytes}};
  json["packs"] = Json::array();
  for (const LinkedPack& pack : outcome.packs) {
    json["packs"].push_back(
        {{"path", pack.path},
         {"kind", packKindName(pack.kind)},
         {"bytes", pack.bytes},
         {"xxh3_128", fmt::format("{:016x}{:016x}", pack.hash_high, pack.hash_low)}});
  }
  json["seconds"] = outcome.seconds;
  return json;
}

}  // namespace

Result<Json> linkWorldPack(BakeRun& run) {
  const BakeCommand& command = run.command();
  const auto start = std::chrono::steady_clock::now();
  WorldOutcome outcome;
  outcome.output = run.outputFor(command.inputs.front());
  run.line().show(outcome.output.filename().string(), "verify", 0);
  auto packs = linkPacks(command.inputs, outcome.output.parent_path());
  if (!packs) return tl::unexpected(packs.error());
  outcome.packs = std::move(*packs);
  if (auto checked = run.checkNotRead(outcome.output); !checked) {
    return tl::unexpected(checked.error());
  }
  if (!command.dry_run) {
    std::vector<SourceFile> sources;
    sources.reserve(outcome.packs.size());
    for (const LinkedPack& pack : outcome.packs) {
      sources.push_back({pack.path, pack.bytes, pack.hash_low, pack.hash_high});
    }
    const auto bytes = writeWorldPack(outcome.output, outcome.packs,
                                      provenanceOf(command, std::move(sources), {}));
    if (!bytes) return tl::unexpected(bytes.error());
    outcome.pack_bytes = *bytes;
  }
  outcome.seconds = secondsSince(start);
  run.line().clear();
  if (command.saysMore()) printWorldTable(outcome);
  return worldReport(outcome);
}

}  // namespace galactic::bake
