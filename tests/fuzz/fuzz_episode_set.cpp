// Any bytes as a file of episodes: a published episode set, a dataset of Habitat, or one of them
// compressed. The import has to give an error, or episodes
// that the writer takes and the runtime reads.
#include <cstdint>
#include <string_view>

#include "finding.h"
#include "galactic/bake/episode_set_import.h"
#include "galactic/bake/packs.h"
#include "galactic/episode_set.h"
#include "galactic/pack.h"
#include "support/packs/pack_parts.h"
#include "support/scratch_folder.h"

namespace {

using galactic::bake::SourceEpisodes;
using galactic::test::expectGoodError;
using galactic::test::reportFinding;

void checkEpisodes(const SourceEpisodes& episodes) {
  galactic::bake::Provenance provenance;
  provenance.tool_version = "0.1.0";
  const auto payload = encodeEpisodePack(episodes, provenance);
  if (!payload) reportFinding("episodes that the writer refuses");
  const auto file = galactic::test::packFile(galactic::PackKind::kEpisodes, *payload);
  const auto pack = galactic::PackFile::view(file.bytes(), "episodes.pack");
  if (!pack) reportFinding(pack.error().message);
  const auto set = galactic::EpisodeSet::from(*pack);
  if (!set) reportFinding(set.error().message);
  if (set->episodes().size() != episodes.episodes.size()) reportFinding("episodes that are lost");
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
    expectGoodError(episodes.error());
  }
  return 0;
}
