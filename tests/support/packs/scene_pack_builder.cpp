#include "support/packs/scene_pack_builder.h"

#include <cstring>

#include "support/packs/schema_parts.h"

namespace galactic::test {
namespace {

/// Makes packs of ScenePackFields.
class ScenePackBuilder {
 public:
  explicit ScenePackBuilder(const ScenePackFields& fields) : fields_(fields) {}

  /// The whole file: header and payload.
  [[nodiscard]] AlignedBytes build() {
    const auto provenance = buildProvenance();
    const auto type = fields_.holds_world ? schema::Asset::World : schema::Asset::Scene;
    const flatbuffers::Offset<void> asset =
        fields_.holds_world ? buildEmptyWorld().Union() : buildScene().Union();
    schema::FinishPackBuffer(builder_, schema::CreatePack(builder_, provenance, type, asset));
    placeTiles();
    const auto* payload = reinterpret_cast<const std::byte*>(builder_.GetBufferPointer());
    return packFile(fields_.kind, {payload, builder_.GetSize()});
  }

 private:
  flatbuffers::Offset<schema::World> buildEmptyWorld() {
    const std::vector<flatbuffers::Offset<schema::PackReference>> none;
    return schema::CreateWorld(builder_, builder_.CreateVector(none));
  }

  flatbuffers::Offset<schema::Provenance> buildProvenance() {
    const schema::Hash128 hash(1, 2);
    const auto options = builder_.CreateVector(std::vector{schema::CreateOption(
        builder_, builder_.CreateString(fields_.option_name), builder_.CreateString("0.5,0.75"))});
    const auto sources = builder_.CreateVector(
        std::vector{schema::CreateSourceFile(builder_, builder_.CreateString(fields_.source_name),
                                             1234, fields_.source_has_hash ? &hash : nullptr)});
    const auto warnings =
        builder_.CreateVector(std::vector{builder_.CreateString(fields_.warning)});
    return schema::CreateProvenance(builder_, builder_.CreateString(fields_.tool),
                                    builder_.CreateString(fields_.tool_version), options, sources,
                                    warnings);
  }

  flatbuffers::Offset<schema::Scene> buildScene() {
    std::vector<flatbuffers::Offset<schema::ColumnGrid>> grids;
    for (const GridFields& grid : fields_.grids) grids.push_back(buildGrid(grid));
    const Vec3& lo = fields_.bounds_min;
    const Vec3& hi = fields_.bounds_max;
    const schema::Bounds bounds(schema::Vec3(lo.x, lo.y, lo.z), schema::Vec3(hi.x, hi.y, hi.z));
    const auto import = schema::CreateImportStatistics(
        builder_, builder_.CreateString(fields_.format), 1, 1, fields_.triangles_read,
        fields_.triangles_degenerate, fields_.triangles_duplicate, fields_.triangles);
    const auto meshes = buildRenderMeshesField(builder_, fields_.render_meshes);
    return schema::CreateScene(builder_, builder_.CreateString(fields_.name), &bounds,
                               builder_.CreateVector(grids), import, meshes);
  }

  flatbuffers::Offset<schema::ColumnGrid> buildGrid(const GridFields& fields) {
    const TestGrid& grid = fields.grid;
    const std::vector<std::uint64_t> cells(
        grid.cells.size() + kTilePaddingCells + fields.extra_cells, fields.padding_value);
    builder_.ForceVectorAlignment(cells.size(), sizeof(std::uint64_t), fields.cells_alignment);
    const auto stored_cells = builder_.CreateVector(cells);
    const auto tile_base = alignedNumbers(builder_, grid.tile_base);
    const auto overflow_codes = alignedNumbers(builder_, grid.overflow_codes);
    std::vector<schema::Span> spans;
    for (const Span& span : grid.overflow_spans) spans.emplace_back(span.lo, span.hi);
    const auto overflow_spans = alignedStructs(builder_, spans);
    const auto statistics = buildStatistics(fields);
    const GridSpec& spec = grid.spec;
    const schema::Span heights(spec.heights.lo, spec.heights.hi);
    return schema::CreateColumnGrid(builder_, spec.radius, spec.spacing, spec.min_x, spec.min_z,
                                    spec.columns_x, spec.columns_z,
                                    fields.has_heights ? &heights : nullptr, spec.quantum,
                                    static_cast<schema::Coverage>(fields.coverage), stored_cells,
                                    tile_base, overflow_codes, overflow_spans, statistics);
  }

  flatbuffers::Offset<schema::GridStatistics> buildStatistics(const GridFields& fields) {
    std::vector<flatbuffers::Offset<schema::RegionStatistics>> regions;
    for (const RegionFields& region : fields.regions) {
      regions.push_back(schema::CreateRegionStatistics(
          builder_, static_cast<schema::Region>(region.region), 1, 10, region.volume));
    }
    flatbuffers::Offset<schema::CastCheck> cast_check;
    if (fields.cast_check) {
      const CastCheckFields& check = *fields.cast_check;
      cast_check = schema::CreateCastCheck(builder_, check.columns, check.columns_differing,
                                           check.compared, check.method, check.ties, check.errors);
    }
    return schema::CreateGridStatistics(builder_, fields.spans + 30, fields.spans,
                                        fields.max_spans_per_column, 0, 0,
                                        builder_.CreateVector(regions), cast_check);
  }

  /// Puts the tiles where they begin at a cache line of the file, known only now.
  void placeTiles() {
    if (fields_.holds_world) return;
    auto* payload = builder_.GetBufferPointer();
    const auto* scene = schema::GetPack(payload)->asset_as_Scene();
    for (std::size_t n = 0; n < fields_.grids.size(); ++n) {
      const auto* stored =
          scene->column_grids()->Get(static_cast<flatbuffers::uoffset_t>(n))->cells();
      const auto offset = static_cast<std::size_t>(stored->Data() - payload);
      const auto& cells = fields_.grids[n].grid.cells;
      const std::size_t padding = tilePadding(sizeof(PackHeader) + offset);
      if (padding > kTilePaddingCells) continue;  // misaligned on purpose
      std::memcpy(payload + offset + padding * sizeof(std::uint64_t), cells.data(),
                  cells.size() * sizeof(std::uint64_t));
    }
  }

  const ScenePackFields& fields_;
  flatbuffers::FlatBufferBuilder builder_;
};

}  // namespace

ScenePackFields smallScene() {
  ScenePackFields scene;
  GridSpec spec;
  scene.grids.emplace_back(GridBuilder(spec)
                               .column(0, 0, {{1, 2}})
                               .column(1, 0, {{1, 2}, {3, 4}})
                               .column(2, 1, {{1, 2}, {3, 4}, {5, 6}})
                               .column(4, 2, {{0, 8}})
                               .column(3, 2, {{0.5F, 1}, {1.5F, 2}, {2.5F, 3}, {3.5F, 4}})
                               .build());
  spec.radius = 0.75F;
  spec.heights = {-4, 36};
  scene.grids.emplace_back(GridBuilder(spec)
                               .column(0, 0, {{-3, 2}, {3, 8}})
                               .column(2, 0, {{0, 1}, {2, 3}, {4, 5}})
                               .column(4, 0, {{20, 22}, {23, 30}})
                               .column(1, 2, {{1, 35}})
                               .build());
  return scene;
}

AlignedBytes buildPack(const ScenePackFields& fields) { return ScenePackBuilder(fields).build(); }

}  // namespace galactic::test
