#include "support/packs/world_pack_builder.h"

#define XXH_INLINE_ALL
#include <xxhash.h>

#include <cstring>

#include "support/packs/schema_parts.h"

namespace galactic::test {

WorldPackFields smallWorldPack() {
  WorldPackFields fields;
  fields.packs = {{.path = "episodes.pack", .kind = "EPIS"},
                  {.path = "objects.pack", .kind = "OBJS"},
                  {.path = "robots/helper.pack", .kind = "RBOT"},
                  {.path = "scenes/kitchen.pack", .kind = "SCEN"}};
  return fields;
}

AlignedBytes buildPack(const WorldPackFields& fields) {
  flatbuffers::FlatBufferBuilder builder;
  std::vector<flatbuffers::Offset<schema::PackReference>> packs;
  for (const ReferenceFields& one : fields.packs) {
    const auto [low, high] = one.hash.value_or(std::pair<std::uint64_t, std::uint64_t>{});
    const schema::Hash128 hash(low, high);
    const auto path = builder.CreateString(one.path);
    const auto kind = builder.CreateString(one.kind);
    packs.push_back(
        schema::CreatePackReference(builder, path, kind, one.bytes, one.hash ? &hash : nullptr));
  }
  const auto list = builder.CreateVector(packs);
  flatbuffers::Offset<flatbuffers::Vector<flatbuffers::Offset<schema::Option>>> task;
  if (fields.task) {
    std::vector<flatbuffers::Offset<schema::Option>> options;
    for (const auto& [name, value] : *fields.task) {
      const auto name_text = builder.CreateString(name);
      const auto value_text = builder.CreateString(value);
      options.push_back(schema::CreateOption(builder, name_text, value_text));
    }
    task = builder.CreateVector(options);
  }
  const auto world = schema::CreateWorld(builder, list, task);
  return finishFile(builder, fields.kind, schema::Asset::World, world.Union());
}

std::string_view textOf(const AlignedBytes& file) {
  return {reinterpret_cast<const char*>(file.bytes().data()), file.size()};
}

ReferenceFields writeListed(const ScratchFolder& folder, const std::string& name,
                            const AlignedBytes& file) {
  static_cast<void>(folder.write(name, textOf(file)));
  PackHeader header;
  std::memcpy(&header, file.bytes().data(), sizeof(header));
  const XXH128_hash_t hash = XXH3_128bits(file.bytes().data(), file.size());
  return {.path = name,
          .kind = packKindName(header.kind),
          .bytes = file.size(),
          .hash = std::pair{hash.low64, hash.high64}};
}

WorldPackFields writePacks(const ScratchFolder& folder, const WorldFields& world) {
  WorldPackFields list;
  list.packs = {writeListed(folder, "episodes.pack", buildPack(world.episodes)),
                writeListed(folder, "objects.pack", buildPack(world.objects)),
                writeListed(folder, "robots/helper.pack", buildPack(world.robot)),
                writeListed(folder, "scenes/kitchen.pack", buildPack(world.scene))};
  return list;
}

std::filesystem::path writeWorld(const ScratchFolder& folder, const WorldFields& world) {
  return folder.write("world.pack", textOf(buildPack(writePacks(folder, world))));
}

}  // namespace galactic::test
