#include "write/pack_payload.h"

#include <cstring>

#include "galactic/pack.h"
#include "layout/render_pools.h"
#include "support/files/atomic_file.h"
#include "support/try.h"

namespace galactic::bake {
namespace {

schema::LengthStatistics toSchema(const LengthStatistics& lengths) {
  return {lengths.mean, lengths.p95, lengths.max};
}

/// Fails if a pack does not pass the checks made when it is opened.
Result<void> checkOwn(std::span<const std::byte> file, const std::filesystem::path& path) {
  const auto opened = PackFile::view(file, path.string());
  if (opened) return {};
  const Error& error = opened.error();
  return fail(ErrorCode::kInternal, error.where,
              error.message +
                  " (in a pack that was just made, and is not written; please report "
                  "this with the input)");
}

}  // namespace

Offset<schema::Provenance> provenanceTable(FlatBufferBuilder& builder,
                                           const Provenance& provenance) {
  std::vector<Offset<schema::Option>> options;
  for (const auto& [name, value] : provenance.options) {
    options.push_back(schema::CreateOptionDirect(builder, name.c_str(), value.c_str()));
  }
  std::vector<Offset<schema::SourceFile>> sources;
  for (const SourceFile& file : provenance.sources) {
    const schema::Hash128 hash(file.hash_low, file.hash_high);
    sources.push_back(
        schema::CreateSourceFileDirect(builder, file.name.c_str(), file.bytes, &hash));
  }
  const auto warnings = builder.CreateVectorOfStrings(provenance.warnings);
  const auto source_vector = builder.CreateVector(sources);
  const auto option_vector = builder.CreateVector(options);
  const auto tool_version = builder.CreateString(provenance.tool_version);
  const auto tool = builder.CreateString(provenance.tool);
  return schema::CreateProvenance(builder, tool, tool_version, option_vector, source_vector,
                                  warnings);
}

Offset<schema::ImportStatistics> importStatistics(FlatBufferBuilder& builder,
                                                  const ImportStatistics& statistics) {
  return schema::CreateImportStatisticsDirect(builder, statistics.format.c_str(), statistics.meshes,
                                              statistics.instances, statistics.counts.read,
                                              statistics.counts.degenerate,
                                              statistics.counts.duplicate, statistics.triangles);
}

Offset<schema::Surface> surfaceTable(FlatBufferBuilder& builder, const Surface& surface) {
  const auto positions = alignedStructs<schema::Vec3>(builder, surface.positions);
  static_assert(sizeof(Triangle) == 3 * sizeof(std::uint32_t));
  const auto triangles = alignedVector<std::uint32_t>(
      builder, {reinterpret_cast<const std::uint32_t*>(surface.triangles.data()),
                3 * surface.triangles.size()});
  const auto colors = alignedVector<std::uint32_t>(builder, surface.colors);
  return schema::CreateSurface(builder, positions, triangles, colors);
}

Offset<schema::SphereSetStatistics> sphereStatistics(FlatBufferBuilder& builder,
                                                     const SphereSet& set,
                                                     const SphereTolerances& asked) {
  const SphereSetQuality& quality = set.quality;
  const schema::LengthStatistics gap = toSchema(quality.gap);
  const schema::LengthStatistics protrusion = toSchema(quality.protrusion);
  return schema::CreateSphereSetStatistics(
      builder, asked.eps, asked.tau, &gap, &protrusion, quality.volume_ratio, quality.thin_points,
      quality.samples, set.guaranteed_gap, set.guaranteed_protrusion, set.meets_tolerances,
      asked.authored);
}

std::vector<std::byte> finishPack(FlatBufferBuilder& builder, Offset<schema::Provenance> provenance,
                                  schema::Asset type, Offset<void> asset) {
  schema::FinishPackBuffer(builder, schema::CreatePack(builder, provenance, type, asset));
  std::vector<std::byte> payload(builder.GetSize());
  std::memcpy(payload.data(), builder.GetBufferPointer(), payload.size());
  return payload;
}

Result<std::uint64_t> writePackFile(const std::filesystem::path& path, PackKind kind,
                                    std::span<const std::byte> payload) {
  const PackHeader header = makePackHeader(kind, payload);
  // In one piece of memory, as the checks expect files.
  std::vector<std::byte, PackAllocator<std::byte>> file(sizeof(header) + payload.size());
  std::memcpy(file.data(), &header, sizeof(header));
  std::memcpy(file.data() + sizeof(header), payload.data(), payload.size());
  RETURN_IF_ERROR(checkOwn(file, path));
  RETURN_IF_ERROR(writeFileAtomically(path, {file}));
  return file.size();
}

}  // namespace galactic::bake
