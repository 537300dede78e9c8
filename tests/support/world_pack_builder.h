#pragma once
#define XXH_INLINE_ALL
#include <xxhash.h>

#include <cstdint>
#include <cstring>
#include <optional>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include "support/episode_pack_builder.h"
#include "support/object_pack_builder.h"
#include "support/robot_pack_builder.h"
#include "support/scene_pack_builder.h"
#include "support/scratch_folder.h"

namespace galactic::test {

/// One pack of a world's list.
struct ReferenceFields {
  std::string path;
  std::string kind;
  std::uint64_t bytes = 1000;
  /// Low half first.
  std::optional<std::pair<std::uint64_t, std::uint64_t>> hash = std::pair{1, 2};
};

/// Names and values of options of a task.
using TaskTexts = std::vector<std::pair<std::string, std::string>>;

/// All that a world pack holds. buildPack makes a pack that is valid in every field that was left
/// as it is.
struct WorldPackFields {
  PackKind kind = PackKind::kWorld;
  std::vector<ReferenceFields> packs;
  /// None: as worlds were before they had tasks.
  std::optional<TaskTexts> task;
};

/// One pack of each kind; the files are not there.
inline WorldPackFields smallWorldPack() {
  WorldPackFields fields;
  fields.packs = {{.path = "episodes.pack", .kind = "EPIS"},
                  {.path = "objects.pack", .kind = "OBJS"},
                  {.path = "robots/helper.pack", .kind = "RBOT"},
                  {.path = "scenes/kitchen.pack", .kind = "SCEN"}};
  return fields;
}

/// The whole file: header and payload.
inline AlignedBytes buildPack(const WorldPackFields& fields) {
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

/// The packs of a small world, all for the same radii.
struct WorldFields {
  ScenePackFields scene = smallScene();
  ObjectPackFields objects = smallObjects();
  RobotPackFields robot = smallRobotPack();
  EpisodePackFields episodes = smallEpisodes();

  WorldFields() {
    objects.radii.clear();
    for (const GridFields& grid : scene.grids) objects.radii.push_back(grid.grid.spec.radius);
    robot.radii = objects.radii;
  }
};

/// A file's bytes as text, for ScratchFolder.
inline std::string_view textOf(const AlignedBytes& file) {
  return {reinterpret_cast<const char*>(file.bytes().data()), file.size()};
}

/// Writes `file` to `name` in `folder`; what a world pack has to say about it.
inline ReferenceFields writeListed(const ScratchFolder& folder, const std::string& name,
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

/// The world's packs in `folder` and what its world pack has to say about them.
inline WorldPackFields writePacks(const ScratchFolder& folder, const WorldFields& world) {
  WorldPackFields list;
  list.packs = {writeListed(folder, "episodes.pack", buildPack(world.episodes)),
                writeListed(folder, "objects.pack", buildPack(world.objects)),
                writeListed(folder, "robots/helper.pack", buildPack(world.robot)),
                writeListed(folder, "scenes/kitchen.pack", buildPack(world.scene))};
  return list;
}

/// The same, and the world pack itself: "world.pack" in `folder`.
inline std::filesystem::path writeWorld(const ScratchFolder& folder, const WorldFields& world) {
  return folder.write("world.pack", textOf(buildPack(writePacks(folder, world))));
}

}  // namespace galactic::test
