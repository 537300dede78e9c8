#include "check/pack_check.h"

#include "check/asset_checks.h"
#include "check/common_check.h"
#include "check/offence.h"
#include "check/texture_check.h"
#include "check/world_check.h"

namespace galactic::detail {
namespace {

/// The most deeply nested tables are pack, scene, grid, statistics and region.
constexpr flatbuffers::uoffset_t kMaxDepth = 16;
/// Far above any real pack; limits the time that a hostile pack can take.
constexpr flatbuffers::uoffset_t kMaxTables = 1'000'000;

bool isRelative(const flatbuffers::String* path) {
  return path->size() > 0 && path->c_str()[0] != '/';
}

Result<void> checkProvenance(const schema::Provenance& provenance, const std::string& where) {
  Offence offence(where + ": provenance");
  offence.require(!isEmpty(provenance.tool()), "tool", "is empty, expected a program's name");
  offence.require(!isEmpty(provenance.tool_version()), "tool_version",
                  "is empty, expected a version");
  for (flatbuffers::uoffset_t n = 0; n < provenance.options()->size() && !offence.found(); ++n) {
    offence.require(!isEmpty(provenance.options()->Get(n)->name()),
                    fmt::format("options[{}].name", n), "is empty, expected an option's name");
  }
  for (flatbuffers::uoffset_t n = 0; n < provenance.sources()->size() && !offence.found(); ++n) {
    const schema::SourceFile& source = *provenance.sources()->Get(n);
    offence.require(isRelative(source.name()), fmt::format("sources[{}].name", n),
                    "is empty or an absolute path, expected a relative path");
    offence.require(source.hash() != nullptr, fmt::format("sources[{}].hash", n),
                    "is missing, expected the file's hash");
  }
  return offence.result();
}

/// The asset, if its kind is the one that the header names; otherwise an error.
template <class Asset>
Result<const Asset*> assetOf(const schema::Pack& pack, const PackHeader& header,
                             const std::string& where) {
  if (const Asset* asset = pack.asset_as<Asset>()) return asset;
  return fail(ErrorCode::kInvalidInput, where + ": asset",
              fmt::format("has type {}, the header says {}; bake the pack again",
                          static_cast<unsigned>(pack.asset_type()), packKindName(header.kind)),
              "pack/asset");
}

Result<void> checkAsset(const PackHeader& header, std::span<const std::byte> file,
                        const std::string& where) {
  const schema::Pack& pack = *schema::GetPack(file.data() + sizeof(PackHeader));
  switch (header.kind) {
    case PackKind::kScene:
      return assetOf<schema::Scene>(pack, header, where).and_then([&](const schema::Scene* scene) {
        return checkScene(*scene, file, where);
      });
    case PackKind::kObjects:
      return assetOf<schema::ObjectSet>(pack, header, where)
          .and_then([&](const schema::ObjectSet* set) { return checkObjectSet(*set, where); });
    case PackKind::kRobot:
      return assetOf<schema::Robot>(pack, header, where).and_then([&](const schema::Robot* robot) {
        return checkRobot(*robot, where);
      });
    case PackKind::kEpisodes:
      return assetOf<schema::EpisodeSet>(pack, header, where)
          .and_then([&](const schema::EpisodeSet* set) { return checkEpisodeSet(*set, where); });
    case PackKind::kWorld:
      return assetOf<schema::World>(pack, header, where).and_then([&](const schema::World* world) {
        return checkWorld(*world, where);
      });
    case PackKind::kTexture:
      return assetOf<schema::SharedTexture>(pack, header, where)
          .and_then([&](const schema::SharedTexture* texture) {
            return checkSharedTexture(*texture, where);
          });
    case PackKind::kPolicy:
      return assetOf<schema::Policy>(pack, header, where)
          .and_then([&](const schema::Policy* policy) { return checkPolicy(*policy, where); });
  }
  return fail(ErrorCode::kInternal, where, "has a kind that reading its header refuses");
}

}  // namespace

Result<void> checkPayloadStart(std::span<const std::byte> payload, const std::string& where) {
  if (payload.size() > kMaxPayloadBytes) {
    return fail(ErrorCode::kInvalidInput, where,
                fmt::format("has a payload of {} bytes, a pack has at most {}; split the asset",
                            payload.size(), kMaxPayloadBytes),
                "pack/too-large");
  }
  constexpr std::size_t kSmallest = 2 * sizeof(flatbuffers::uoffset_t);
  if (payload.size() < kSmallest || !schema::PackBufferHasIdentifier(payload.data())) {
    return fail(ErrorCode::kInvalidInput, where,
                fmt::format("payload does not carry the identifier \"{}\"; it was not written by "
                            "galactic-bake, bake it again",
                            schema::PackIdentifier()),
                "pack/identifier");
  }
  return {};
}

Result<void> checkPack(const PackHeader& header, std::span<const std::byte> file,
                       const std::string& where) {
  const auto payload = file.subspan(sizeof(PackHeader));
  const auto* bytes = reinterpret_cast<const std::uint8_t*>(payload.data());
  flatbuffers::Verifier verifier(bytes, payload.size(), kMaxDepth, kMaxTables);
  if (!schema::VerifyPackBuffer(verifier)) {
    return fail(ErrorCode::kInvalidInput, where,
                "payload is not a well-formed FlatBuffer of the pack schema: a required field is "
                "missing or an offset leads astray; bake it again",
                "pack/structure");
  }
  const schema::Pack& pack = *schema::GetPack(bytes);
  if (auto checked = checkProvenance(*pack.provenance(), where); !checked) return checked;
  return checkAsset(header, file, where);
}

}  // namespace galactic::detail
