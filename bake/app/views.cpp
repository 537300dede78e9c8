#include "views.h"

#include <fmt/format.h>

#include <algorithm>

#include "galactic/pack_header.h"
#include "support/text/counted.h"
#include "support/text/printable.h"

namespace galactic::bake {
namespace {

double megabytes(std::uint64_t bytes) { return static_cast<double>(bytes) / 1e6; }

}  // namespace

void printTable(const PackFigures& pack, Verbosity verbosity) {
  std::visit([&](const auto& figures) { printTable(figures, pack, verbosity); }, pack.of);
}

std::string targetOf(const PackFigures& pack) {
  return pack.pack_bytes > 0 ? pack.output : "(dry run)";
}

void printTable(const WorldFigures& world, const PackFigures& pack, Verbosity /*verbosity*/) {
  std::uint64_t bytes = 0;
  int width = 0;
  for (const LinkedPack& linked : world.packs) {
    bytes += linked.bytes;
    width = std::max(width, static_cast<int>(linked.path.size()));
  }
  fmt::print("{} -> {}\n", counted(world.packs.size(), "pack"), targetOf(pack));
  for (const LinkedPack& linked : world.packs) {
    fmt::print("  {} {:<{}} {:>9.2f} MB\n", packKindName(linked.kind), printable(linked.path),
               width, megabytes(linked.bytes));
  }
  fmt::print("  {:.3f} s; {:.2f} MB listed\n", world.seconds, megabytes(bytes));
}

void printRenderMeshes(const RenderBakeStatistics& figures, std::uint64_t textures) {
  fmt::print(
      "  render meshes: {} -> {} triangles ({} two-sided), {} -> {} vertices, {}, "
      "error {:.2f} mm; {:.2f} -> {:.2f} MB\n",
      figures.source_triangles, figures.triangles, figures.two_sided_triangles,
      figures.source_vertices, figures.vertices, counted(figures.clusters, "cluster"),
      1e3 * static_cast<double>(figures.largest_error), megabytes(figures.source_bytes),
      megabytes(figures.bytes));
  fmt::print("  {}: {:.2f} -> {:.2f} MB\n", counted(textures, "texture"),
             megabytes(figures.source_texture_bytes), megabytes(figures.texture_bytes));
}

void printRenderMeshes(const std::optional<RenderFigures>& meshes) {
  if (meshes) printRenderMeshes(meshes->all, meshes->textures);
}

}  // namespace galactic::bake
