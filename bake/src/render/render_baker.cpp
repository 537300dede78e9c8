#include "galactic/bake/render_baker.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <optional>
#include <utility>

#include "galactic/bake/parallel_for.h"
#include "render/lattice.h"
#include "render/light.h"
#include "render/part_mesh.h"
#include "render/piece.h"
#include "support/try.h"

namespace galactic::bake {
namespace {

/// The numbers of materials and semantics have 16 bits.
constexpr std::size_t kMostNumbers = 65536;

/// A baked part before it is added to the pools.
struct PartWork {
  LatticeModel model;
  RenderModelFigures figures;
  std::string warning;
};

Result<void> checkSource(const RenderSource& source) {
  if (source.materials.size() != source.baked.materials.size()) {
    return fail(ErrorCode::kInternal, "materials",
                fmt::format("{} of {} materials were baked", source.baked.materials.size(),
                            source.materials.size()));
  }
  if (source.semantics.empty()) {
    return fail(ErrorCode::kInvalidInput, "semantics", "is empty; give at least one name");
  }
  if (source.semantics.size() > kMostNumbers || source.materials.size() > kMostNumbers) {
    return fail(ErrorCode::kUnsupported, "materials",
                fmt::format("there are {} materials and {} names for semantic ids, at most {} of "
                            "each are possible; merge some",
                            source.materials.size(), source.semantics.size(), kMostNumbers));
  }
  return {};
}

/// Adds to the error how far the lattice moves corners, if it is coarser than the finest one and
/// the distance is relevant compared with the allowed error. One large triangle makes the lattice
/// coarse for all.
void addLatticeError(double allowed, PartWork& work) {
  constexpr double kCounts = 0.1;
  const double step = work.model.step;
  const double moved = step * std::sqrt(3.0) / 2;
  if (step <= kFinestStep || moved <= kCounts * allowed) return;
  work.figures.largest_error += static_cast<float>(moved);
  if (moved <= allowed) return;
  work.warning = fmt::format(
      "render meshes: a triangle of more than {:.0f} m makes corners of all of them move by up to "
      "{:.1f} mm, expected {:.1f} mm; cut it into smaller ones, or leave it out",
      step / 2 * static_cast<double>(kMostSteps), 1000 * moved, 1000 * allowed);
}

Result<PartWork> bakePart(const RenderPart& part, const RenderSource& source,
                          const RenderBakeOptions& options, unsigned threads) {
  ASSIGN_OR_RETURN(auto mesh, assemblePart(part, source));
  std::vector<PartMesh> pieces = connectedPieces(mesh);
  mesh = {};
  std::vector<FinishedPiece> finished(pieces.size());
  parallelFor(threads, pieces.size(), [&](std::size_t n) {
    finished[n] = finishPiece(std::move(pieces[n]), source, options.error);
  });
  const std::vector<bool> lit = litMaterials(source, options.lighting);
  if (std::find(lit.begin(), lit.end(), true) != lit.end()) {
    RETURN_IF_ERROR(lightPieces(finished, part, source, options, threads));
  }
  PartWork work;
  work.model = cutModel(finished, source, threads);
  work.figures.part = part.part;
  for (const PlacedMesh& placed : part.meshes) {
    work.figures.source_triangles += static_cast<std::uint32_t>(placed.mesh->triangles.size());
  }
  for (const FinishedPiece& piece : finished) {
    work.figures.largest_error = std::max(work.figures.largest_error, piece.error);
  }
  addLatticeError(options.error, work);
  return work;
}

bool hasColors(const RenderSource& source, Lighting lighting) {
  const std::vector<bool> lit = litMaterials(source, lighting);
  if (std::find(lit.begin(), lit.end(), true) != lit.end()) return true;
  return std::any_of(source.parts.begin(), source.parts.end(), [](const RenderPart& part) {
    return std::any_of(part.meshes.begin(), part.meshes.end(),
                       [](const PlacedMesh& placed) { return !placed.mesh->colors.empty(); });
  });
}

void countSource(const SourceMesh& mesh, BakedRenderMeshes& meshes) {
  meshes.source_vertices += mesh.positions.size();
  meshes.source_bytes += mesh.positions.size() * sizeof(Vec3) + mesh.uvs.size() * 8 +
                         mesh.colors.size() * 4 + mesh.triangles.size() * sizeof(Triangle);
}

}  // namespace

Result<BakedRenderMeshes> bakeRenderMeshes(const RenderSource& source,
                                           const RenderBakeOptions& options, unsigned threads) {
  RETURN_IF_ERROR(checkSource(source));
  // Work on many parts at once, or on the pieces of one part.
  const bool alone = source.parts.size() < threads;
  std::vector<std::optional<Result<PartWork>>> work(source.parts.size());
  parallelFor(alone ? 1 : threads, work.size(), [&](std::size_t n) {
    work[n] = bakePart(source.parts[n], source, options, alone ? threads : 1);
  });
  BakedRenderMeshes meshes;
  meshes.materials = source.baked;
  meshes.semantics = source.semantics;
  const bool colored = hasColors(source, options.lighting);
  for (std::size_t n = 0; n < work.size(); ++n) {
    Result<PartWork>& part = *work[n];
    if (!part) return tl::unexpected(part.error());
    part->figures.colored = colored;
    appendModel(part->model, part->figures, meshes);
    if (!part->warning.empty()) meshes.warnings.push_back(std::move(part->warning));
    for (const PlacedMesh& placed : source.parts[n].meshes) countSource(*placed.mesh, meshes);
  }
  return meshes;
}

}  // namespace galactic::bake
