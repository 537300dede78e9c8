#include "views.h"

#include <fmt/format.h>

#include <algorithm>

#include "galactic/bake/render_textures.h"
#include "galactic/pack_header.h"
#include "support/printable.h"

namespace galactic::bake {
namespace {

double megabytes(std::uint64_t bytes) { return static_cast<double>(bytes) / 1e6; }

}  // namespace

void printTable(const Made& made, Verbosity verbosity) {
  std::visit([&](const auto& outcome) { printTable(outcome, made, verbosity); }, made.outcome);
}

Json reportEntries(const Made& made) {
  return std::visit([&](const auto& outcome) { return reportEntries(outcome, made); },
                    made.outcome);
}

void printTable(const WorldOutcome& outcome, const Made& made, Verbosity /*verbosity*/) {
  std::uint64_t bytes = 0;
  int width = 0;
  for (const LinkedPack& pack : outcome.packs) {
    bytes += pack.bytes;
    width = std::max(width, static_cast<int>(pack.path.size()));
  }
  fmt::print("{} packs -> {}\n", outcome.packs.size(),
             made.pack_bytes > 0 ? made.output.string() : "(dry run)");
  for (const LinkedPack& pack : outcome.packs) {
    fmt::print("  {} {:<{}} {:>9.2f} MB\n", packKindName(pack.kind), printable(pack.path), width,
               megabytes(pack.bytes));
  }
  fmt::print("  {:.3f} s; {:.2f} MB listed\n", outcome.seconds, megabytes(bytes));
}

Json jsonOf(const LinkedPack& pack) {
  return {{"path", pack.path},
          {"kind", packKindName(pack.kind)},
          {"bytes", pack.bytes},
          {"xxh3_128", fmt::format("{:016x}{:016x}", pack.hash_high, pack.hash_low)}};
}

Json reportEntries(const WorldOutcome& outcome, const Made& made) {
  Json json{{"output", made.output.string()}, {"pack_bytes", made.pack_bytes}};
  json["packs"] = Json::array();
  for (const LinkedPack& pack : outcome.packs) json["packs"].push_back(jsonOf(pack));
  json["seconds"] = outcome.seconds;
  return Json::array({std::move(json)});
}

void printRenderMeshes(const RenderBakeStatistics& figures, std::size_t textures) {
  fmt::print(
      "  render meshes: {} -> {} triangles ({} two-sided), {} -> {} vertices, {} clusters, "
      "error {:.2f} mm; {:.2f} -> {:.2f} MB\n",
      figures.source_triangles, figures.triangles, figures.two_sided_triangles,
      figures.source_vertices, figures.vertices, figures.clusters,
      1e3 * static_cast<double>(figures.largest_error), megabytes(figures.source_bytes),
      megabytes(figures.bytes));
  fmt::print("  {} texture{}: {:.2f} -> {:.2f} MB\n", textures, textures == 1 ? "" : "s",
             megabytes(figures.source_texture_bytes), megabytes(figures.texture_bytes));
}

void printRenderMeshes(const std::optional<BakedRenderMeshes>& meshes) {
  if (meshes) printRenderMeshes(meshes->statistics(), meshes->materials.textures.size());
}

Json renderReport(const BakedRenderMeshes& meshes) {
  const RenderBakeStatistics figures = meshes.statistics();
  Json json{{"source_triangles", figures.source_triangles},
            {"triangles", figures.triangles},
            {"two_sided_triangles", figures.two_sided_triangles},
            {"source_vertices", figures.source_vertices},
            {"vertices", figures.vertices},
            {"clusters", figures.clusters},
            {"source_bytes", figures.source_bytes},
            {"bytes", figures.bytes},
            {"largest_error", figures.largest_error},
            {"textures", meshes.materials.textures.size()},
            {"source_texture_bytes", figures.source_texture_bytes},
            {"texture_bytes", figures.texture_bytes}};
  if (meshes.materials.shared) {
    json["shared_textures"] = Json::array();
    for (const BakedTexture& texture : meshes.materials.textures) {
      json["shared_textures"].push_back(textureHash(texture));
    }
  }
  json["models"] = Json::array();
  for (const RenderModel& model : meshes.models) {
    json["models"].push_back({{"part", model.part},
                              {"step", model.step},
                              {"source_triangles", model.source_triangles},
                              {"triangles", model.triangles},
                              {"clusters", model.cluster_count},
                              {"largest_error", model.largest_error}});
  }
  return json;
}

}  // namespace galactic::bake
