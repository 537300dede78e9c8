#include "inspect/summary.h"

#include <fmt/format.h>

#include <string_view>

#include "galactic/schema/pack_generated.h"
#include "support/text/counted.h"

namespace galactic {
namespace {

constexpr double kMega = 1e6;
constexpr double kGiga = 1e9;
constexpr double kMilli = 1e-3;

std::string clean(const flatbuffers::String* text) {
  return printable(std::string_view(text->c_str(), text->size()));
}

std::string named(std::string_view what, const flatbuffers::String* name) {
  return fmt::format("{} \"{}\"", what, clean(name));
}

std::string openingLine(const PackFile& pack, const OpenTimes& times) {
  const auto bytes = static_cast<double>(pack.bytes().size());
  const std::string verified =
      times.verify > 0 ? fmt::format("verified in {:.2f} ms ({:.1f} GB/s)", times.verify / kMilli,
                                     bytes / times.verify / kGiga)
                       : std::string("trusted, not verified");
  return fmt::format("  {:.2f} MB, mapped in {:.3f} ms, {}\n", bytes / kMega, times.map / kMilli,
                     verified);
}

/// The kind of the asset, with its name or with the numbers of its parts.
std::string titleOf(const schema::Pack& pack) {
  if (const schema::ObjectSet* set = pack.asset_as_ObjectSet()) {
    return counted(set->objects()->size(), "object");
  }
  if (const schema::Robot* robot = pack.asset_as_Robot()) return named("robot", robot->name());
  if (const schema::Scene* scene = pack.asset_as_Scene()) return named("scene", scene->name());
  if (const schema::EpisodeSet* set = pack.asset_as_EpisodeSet()) {
    return named(counted(set->episodes()->size(), "episode"), set->name());
  }
  if (const schema::World* world = pack.asset_as_World()) {
    return "world of " + counted(world->packs()->size(), "pack");
  }
  if (const schema::Policy* policy = pack.asset_as_Policy()) {
    return named("policy", policy->name());
  }
  if (const schema::SharedTexture* texture = pack.asset_as_SharedTexture()) {
    return named("texture", texture->name());
  }
  return "an asset of another kind than the header says";
}

}  // namespace

std::string summarize(const PackFile& pack, const OpenTimes& times) {
  const schema::Provenance& provenance = *pack.root().provenance();
  std::string text = fmt::format("{}: {}, format {}, by {} {}\n", printable(pack.where()),
                                 titleOf(pack.root()), pack.header().format_version,
                                 clean(provenance.tool()), clean(provenance.tool_version()));
  text += openingLine(pack, times);
  if (pack.kind() == PackKind::kWorld) {
    text += "  the packs that it lists are not opened; galactic-pack check opens them, too\n";
  }
  for (const flatbuffers::String* warning : *provenance.warnings()) {
    text += fmt::format("  warning: {}\n", clean(warning));
  }
  return text;
}

}  // namespace galactic
