// Any bytes as a file of episodes: a published episode set, a dataset of Habitat, or one of them
// compressed. The import has to give an error, or episodes
// that the writer takes and the runtime reads.
#include <cstdint>
#include <cstdio>
#include <cstdlib>
#include <string_view>

#include "galactic/bake/episode_pack.h"
#include "galactic/bake/episode_set_import.h"
#include "galactic/episode_set.h"
#include "galactic/pack.h"
#include "support/pack_parts.h"
#include "support/scratch_folder.h"

namespace {

using galactic::bake::SourceEpisodes;

[[noreturn]] void report(std::string_view finding) {
  std::fprintf(stderr, "finding: %.*s\n", static_cast<int>(finding.size()), finding.data());
  std::abort();
}

void checkError(const galactic::Error& error) {
  if (error.code == galactic::ErrorCode::kInternal) report(error.message);
  if (error.where.empty() || error.message.empty()) report("an error without place or message");
}

void checkEpisodes(const SourceEpisodes& episodes) {
  galactic::bake::Provenance provenance;
  provenance.tool_version = "0.1.0";
  const auto payload = encodeEpisodePack(episodes, provenance);
  if (!payload) report("episodes that the writer refuses");
  const auto file = galactic::test::packFile(galactic::PackKind::kEpisodes, *payload);
  const auto pack = galactic::PackFile::view(file.bytes(), "episodes.pack");
  if (!pack) report(pack.error().message);
  const auto set = galactic::EpisodeSet::from(*pack);
  if (!set) report(set.error().message);
  if (set->episodes().size() != episodes.episodes.size()) report("episodes that are lost");
}

}  // namespace

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  static const galactic::test::ScratchFolder folder;
  const std::string_view text(reinterpret_cast<const char*>(data), size);
  galactic::bake::EpisodeImportOptions options;
  options.start_joints = {"pan", "lift"};
  const auto episodes =
      galactic::bake::readEpisodeFile(folder.write("set.episode_set.json", text), options);
  if (episodes) {
    checkEpisodes(*episodes);
  } else {
    checkError(episodes.error());
  }
  return 0;
}
