#pragma once
#include <algorithm>
#include <cstdint>
#include <optional>
#include <string>
#include <vector>

#include "galactic/pack_header.h"
#include "support/aligned_bytes.h"
#include "support/packs/grid_builder.h"
#include "support/packs/render_pack_builder.h"

namespace galactic::test {

struct RegionFields {
  std::uint8_t region = 0;
  double volume = 1.5;
};

struct CastCheckFields {
  std::uint32_t columns = 8;
  std::uint32_t columns_differing = 1;
  double compared = 12;
  double method = 0.25;
  double ties = 0.125;
  double errors = 0;
};

/// One grid of a scene pack; a test changes what it wants to be wrong.
struct GridFields {
  TestGrid grid;
  bool has_heights = true;
  std::uint8_t coverage = 0;
  std::uint64_t spans = 0;
  std::uint32_t max_spans_per_column = 0;
  std::vector<RegionFields> regions{{0, 1.5}, {1, 20}, {2, 0.5}};
  std::optional<CastCheckFields> cast_check = CastCheckFields{};
  /// Value of the unused elements around the tiles, and how many too many there are.
  std::uint64_t padding_value = 0;
  std::size_t extra_cells = 0;
  std::size_t cells_alignment = 32;

  explicit GridFields(TestGrid filled) : grid(std::move(filled)) {
    for (const auto& column : grid.columns) {
      spans += column.size();
      max_spans_per_column =
          std::max(max_spans_per_column, static_cast<std::uint32_t>(column.size()));
    }
  }
};

/// All that a scene pack holds. build() makes a pack that is valid in every field that was left as
/// it is.
struct ScenePackFields {
  PackKind kind = PackKind::kScene;
  /// Whether it holds an empty world instead of the scene, for packs whose header lies.
  bool holds_world = false;
  std::string tool = "galactic-bake";
  std::string tool_version = "0.1.0";
  std::string option_name = "radii";
  std::string source_name = "kitchen.glb";
  bool source_has_hash = true;
  std::string warning = "texture wood.png is missing";
  std::string name = "kitchen";
  Vec3 bounds_min{0, 0, 0};
  Vec3 bounds_max{5, 8, 3};
  std::string format = "glTF 2.0";
  std::uint64_t triangles_read = 100;
  std::uint64_t triangles_degenerate = 3;
  std::uint64_t triangles_duplicate = 7;
  std::uint64_t triangles = 90;
  std::vector<GridFields> grids;
  RenderMeshesField render_meshes;
};

/// Grids of two radii over 5 x 3 columns, the second one tall: empty, one-span, two-span and
/// overflow cells, border tiles, a tile base.
ScenePackFields smallScene();

AlignedBytes buildPack(const ScenePackFields& fields);

}  // namespace galactic::test
