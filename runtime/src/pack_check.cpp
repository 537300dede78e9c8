#include "pack_check.h"

#include <cmath>

#include "column_grid_check.h"
#include "galactic/schema/pack_generated.h"
#include "offence.h"

namespace galactic::detail {
namespace {

/// Tables in tables of the deepest pack: pack, scene, grid, statistics, region.
constexpr flatbuffers::uoffset_t kMaxDepth = 16;
/// Far above any real pack; bounds the time that a hostile one can take.
constexpr flatbuffers::uoffset_t kMaxTables = 1'000'000;
constexpr std::size_t kMaxGrids = 8;

bool isEmpty(const flatbuffers::String* text) { return text->size() == 0; }

bool isRelative(const flatbuffers::String* path) {
  return path->size() > 0 && path->c_str()[0] != '/';
}

Result<void> checkProvenance(const schema::Provenance& provenance, const std::string& where) {
  Offence offence(where + ": provenance");
  offence.require(!isEmpty(provenance.tool()), "tool", "is empty, wanted a program's name");
  offence.require(!isEmpty(provenance.tool_version()), "tool_version",
                  "is empty, wanted a version");
  for (flatbuffers::uoffset_t n = 0; n < provenance.options()->size() && !offence.found(); ++n) {
    offence.require(!isEmpty(provenance.options()->Get(n)->name()),
                    fmt::format("options[{}].name", n), "is empty, wanted an option's name");
  }
  for (flatbuffers::uoffset_t n = 0; n < provenance.sources()->size() && !offence.found(); ++n) {
    const schema::SourceFile& source = *provenance.sources()->Get(n);
    offence.require(isRelative(source.name()), fmt::format("sources[{}].name", n),
                    "is empty or an absolute path, wanted a relative path");
    offence.require(source.hash() != nullptr, fmt::format("sources[{}].hash", n),
                    "is missing, wanted the file's hash");
  }
  return offence.result();
}

bool isFinite(const schema::Vec3& v) {
  return std::isfinite(v.x()) && std::isfinite(v.y()) && std::isfinite(v.z());
}

Result<void> checkImport(const schema::ImportStatistics& counts, const std::string& where) {
  Offence offence(where + ": scene.import_statistics");
  offence.require(!isEmpty(counts.format()), "format", "is empty, wanted a format's name");
  // Subtracted one by one: a sum of hostile counts could wrap around.
  const bool plausible =
      counts.triangles_degenerate() <= counts.triangles_read() &&
      counts.triangles_duplicate() <= counts.triangles_read() - counts.triangles_degenerate();
  offence.require(plausible, "triangles_read",
                  "is {}, wanted at least the {} degenerate and {} duplicate triangles dropped",
                  counts.triangles_read(), counts.triangles_degenerate(),
                  counts.triangles_duplicate());
  const std::uint64_t remaining =
      counts.triangles_read() - counts.triangles_degenerate() - counts.triangles_duplicate();
  offence.require(counts.triangles() == remaining, "triangles",
                  "is {}, wanted the {} that remain of those read", counts.triangles(), remaining);
  return offence.result();
}

Result<void> checkScene(const schema::Scene& scene, std::span<const std::byte> file,
                        const std::string& where) {
  Offence offence(where + ": scene");
  offence.require(!isEmpty(scene.name()), "name", "is empty, wanted the scene's name");
  const schema::Vec3& min = scene.bounds()->min();
  const schema::Vec3& max = scene.bounds()->max();
  offence.require(isFinite(min) && isFinite(max), "bounds", "are not finite, wanted numbers");
  offence.require(min.x() <= max.x() && min.y() <= max.y() && min.z() <= max.z(), "bounds",
                  "have a minimum ({}, {}, {}) above the maximum ({}, {}, {})", min.x(), min.y(),
                  min.z(), max.x(), max.y(), max.z());
  offence.require(checkImport(*scene.import_statistics(), where));

  const auto& grids = *scene.column_grids();
  offence.require(grids.size() >= 1 && grids.size() <= kMaxGrids, "column_grids",
                  "has {} grids, wanted 1 to {}", grids.size(), kMaxGrids);
  for (flatbuffers::uoffset_t n = 0; n < grids.size() && !offence.found(); ++n) {
    const std::string field = fmt::format("column_grids[{}]", n);
    offence.require(checkColumnGrid(*grids.Get(n), file, offence.where() + "." + field));
    if (n == 0) continue;
    const float previous = grids.Get(n - 1)->radius();
    offence.require(grids.Get(n)->radius() > previous, field + ".radius",
                    "is {} m after {} m, wanted ascending radii", grids.Get(n)->radius(), previous);
  }
  return offence.result();
}

}  // namespace

Result<void> checkPayloadStart(std::span<const std::byte> payload, const std::string& where) {
  if (payload.size() > kMaxPayloadBytes) {
    return fail(ErrorCode::kInvalidInput, where,
                fmt::format("has a payload of {} bytes, a pack has at most {}; split the asset",
                            payload.size(), kMaxPayloadBytes));
  }
  constexpr std::size_t kSmallest = 2 * sizeof(flatbuffers::uoffset_t);
  if (payload.size() < kSmallest || !schema::PackBufferHasIdentifier(payload.data())) {
    return fail(ErrorCode::kInvalidInput, where,
                fmt::format("payload does not carry the identifier \"{}\"; it was not written by "
                            "galactic-bake, bake it again",
                            schema::PackIdentifier()));
  }
  return {};
}

Result<void> checkPack(const PackHeader& header, std::span<const std::byte> file,
                       const std::string& where) {
  if (header.kind != PackKind::kScene) {
    return fail(ErrorCode::kUnsupported, where,
                fmt::format("is a pack of kind {}, this version reads only {}; update galactic",
                            packKindName(header.kind), packKindName(PackKind::kScene)));
  }
  const auto payload = file.subspan(sizeof(PackHeader));
  const auto* bytes = reinterpret_cast<const std::uint8_t*>(payload.data());
  flatbuffers::Verifier verifier(bytes, payload.size(), kMaxDepth, kMaxTables);
  if (!schema::VerifyPackBuffer(verifier)) {
    return fail(ErrorCode::kInvalidInput, where,
                "payload is not a well-formed FlatBuffer of the pack schema: a required field is "
                "missing or an offset leads astray; bake it again");
  }
  const schema::Pack& pack = *schema::GetPack(bytes);
  if (auto checked = checkProvenance(*pack.provenance(), where); !checked) return checked;
  const schema::Scene* scene = pack.asset_as_Scene();
  if (scene == nullptr) {
    return fail(ErrorCode::kInvalidInput, where + ": asset",
                fmt::format("has type {}, the header says {}; bake the pack again",
                            static_cast<unsigned>(pack.asset_type()), packKindName(header.kind)));
  }
  return checkScene(*scene, file, where);
}

}  // namespace galactic::detail
