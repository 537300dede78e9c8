#include <fmt/format.h>

#include <cstring>
#include <span>

#include "galactic/bake/packs.h"
#include "galactic/pack_header.h"
#include "galactic/schema/pack_generated.h"
#include "layout/column_cell.h"
#include "support/try.h"
#include "write/pack_payload.h"
#include "write/render_meshes.h"

namespace galactic::bake {
namespace {

/// Limit for grids: FlatBuffers offsets are signed 32-bit, and the rest of a pack is small compared
/// with its grids.
constexpr std::uint64_t kMaxGridBytes = (std::uint64_t{1} << 31U) - (std::uint64_t{64} << 20U);
/// The cells, followed by unused elements. `shiftTilesToCacheLines` moves the cells into place.
Offset<flatbuffers::Vector<std::uint64_t>> cellVector(FlatBufferBuilder& builder,
                                                      const std::vector<std::uint64_t>& cells) {
  const std::size_t count = cells.size() + kTilePaddingCells;
  builder.ForceVectorAlignment(count, sizeof(std::uint64_t), kVectorAlignment);
  std::uint64_t* data = nullptr;
  const auto offset = builder.CreateUninitializedVector(count, &data);
  std::memcpy(data, cells.data(), cells.size() * sizeof(std::uint64_t));
  std::memset(data + cells.size(), 0, kTilePaddingCells * sizeof(std::uint64_t));
  return Offset<flatbuffers::Vector<std::uint64_t>>(offset);
}

Offset<schema::CastCheck> castCheck(FlatBufferBuilder& builder, const CastCheck& check) {
  return schema::CreateCastCheck(builder, check.columns, check.columns_differing, check.compared,
                                 check.method, check.ties, check.errors);
}

Offset<schema::GridStatistics> statistics(FlatBufferBuilder& builder, const BakedGrid& baked) {
  std::vector<Offset<schema::RegionStatistics>> regions;
  for (std::size_t region = 0; region < kRegionCount; ++region) {
    const RegionTotals& totals = baked.totals[region];
    regions.push_back(schema::CreateRegionStatistics(builder, static_cast<schema::Region>(region),
                                                     totals.components, totals.spans,
                                                     totals.volume));
  }
  const auto region_vector = builder.CreateVector(regions);
  Offset<schema::CastCheck> check;
  if (baked.cast_check) check = castCheck(builder, *baked.cast_check);
  const EncodedGrid& grid = baked.grid;
  return schema::CreateGridStatistics(builder, baked.raw_spans, grid.spans,
                                      grid.max_spans_per_column, grid.slivers, baked.merged_gaps,
                                      region_vector, check);
}

Offset<schema::ColumnGrid> columnGrid(FlatBufferBuilder& builder, const BakedGrid& baked,
                                      Coverage coverage) {
  const EncodedGrid& grid = baked.grid;
  const auto cells = cellVector(builder, grid.cells);
  const auto tile_base = alignedVector<std::uint16_t>(builder, grid.tile_base);
  const auto overflow_codes = alignedVector<std::uint32_t>(builder, grid.overflow_codes);
  const auto overflow_spans = alignedStructs<schema::Span>(builder, grid.overflow_spans);
  const auto counts = statistics(builder, baked);
  const schema::Span heights(grid.frame.heights.lo, grid.frame.heights.hi);
  schema::ColumnGridBuilder table(builder);
  table.add_radius(grid.frame.radius);
  table.add_spacing(grid.frame.spacing);
  table.add_min_x(grid.frame.min_x);
  table.add_min_z(grid.frame.min_z);
  table.add_columns_x(grid.frame.columns_x);
  table.add_columns_z(grid.frame.columns_z);
  table.add_heights(&heights);
  table.add_quantum(grid.quantum);
  table.add_coverage(coverage == Coverage::kCell ? schema::Coverage::Cell
                                                 : schema::Coverage::Column);
  table.add_cells(cells);
  table.add_tile_base(tile_base);
  table.add_overflow_codes(overflow_codes);
  table.add_overflow_spans(overflow_spans);
  table.add_statistics(counts);
  return table.Finish();
}

Offset<schema::Scene> sceneTable(FlatBufferBuilder& builder, const BakedScene& scene) {
  std::vector<Offset<schema::ColumnGrid>> grids;
  for (const BakedGrid& grid : scene.grids) {
    grids.push_back(columnGrid(builder, grid, scene.coverage));
  }
  const auto name = builder.CreateString(scene.name);
  const auto grid_vector = builder.CreateVector(grids);
  const auto import_statistics = importStatistics(builder, scene.imported);
  const schema::Bounds bounds = toSchema(scene.bounds);
  Offset<schema::RenderMeshes> render_meshes;
  if (scene.render_meshes) render_meshes = renderMeshesTable(builder, *scene.render_meshes);
  return schema::CreateScene(builder, name, &bounds, grid_vector, import_statistics, render_meshes);
}

/// Moves the tiles of each grid to the first boundary of a cache line, relative to the file, inside
/// their vector.
void shiftTilesToCacheLines(std::span<std::byte> payload) {
  const schema::Scene* scene = schema::GetPack(payload.data())->asset_as_Scene();
  for (const schema::ColumnGrid* grid : *scene->column_grids()) {
    const std::byte* first = reinterpret_cast<const std::byte*>(grid->cells()->Data());
    const auto at = static_cast<std::size_t>(first - payload.data());
    const std::size_t padding = tilePadding(sizeof(PackHeader) + at) * sizeof(std::uint64_t);
    const std::size_t tile_bytes =
        (grid->cells()->size() - kTilePaddingCells) * sizeof(std::uint64_t);
    std::memmove(payload.data() + at + padding, payload.data() + at, tile_bytes);
    std::memset(payload.data() + at, 0, padding);
  }
}

}  // namespace

Result<std::vector<std::byte>> encodeScenePack(const BakedScene& scene,
                                               const Provenance& provenance) {
  std::uint64_t bytes = 0;
  for (const BakedGrid& grid : scene.grids) bytes += storedBytes(grid.grid);
  if (scene.render_meshes) bytes += scene.render_meshes->storedBytes();
  if (bytes > kMaxGridBytes) {
    return fail(ErrorCode::kUnsupported, scene.name,
                fmt::format("grids and render meshes need {} MB, one pack holds less than 2048 MB; "
                            "use a wider `spacing`, fewer `radii`, smaller textures, or split the "
                            "scene",
                            bytes >> 20U));
  }
  FlatBufferBuilder builder(static_cast<std::size_t>(bytes) + 65536);
  const auto provenance_table = provenanceTable(builder, provenance);
  const auto scene_table = sceneTable(builder, scene);
  std::vector<std::byte> payload =
      finishPack(builder, provenance_table, schema::Asset::Scene, scene_table.Union());
  shiftTilesToCacheLines(payload);
  return payload;
}

Result<std::uint64_t> writeScenePack(const std::filesystem::path& path, const BakedScene& scene,
                                     const Provenance& provenance) {
  ASSIGN_OR_RETURN(const auto payload, encodeScenePack(scene, provenance));
  return writePackFile(path, PackKind::kScene, payload);
}

}  // namespace galactic::bake
