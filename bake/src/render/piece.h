#pragma once
#include <cstdint>
#include <vector>

#include "galactic/bake/render_baker.h"
#include "render/part_mesh.h"

namespace galactic::bake {

/// What a connected piece is like, before it is simplified.
struct PieceShape {
  /// Every edge, by position, has two triangles that pass it in opposite directions.
  bool closed = false;
  /// Of a closed piece: above 0 when its triangles face outwards. Cubic meters.
  double volume = 0;
  double area = 0;
  Bounds bounds;
  /// Edges of the bounds, meters.
  std::array<double, 3> size{};
};
[[nodiscard]] PieceShape measurePiece(const PartMesh& piece);

/// A connected piece, ready for clusters.
struct FinishedPiece {
  PartMesh mesh;
  /// Whether no triangle of it needs to be seen from behind, whatever its material says.
  bool has_outside = false;
  /// Largest distance by which simplification moved its surface, as measured, meters.
  float error = 0;
};

/// Decides from which sides the piece is seen, turns it outside out if it has to be, and simplifies
/// it. `error`: what the user allows, meters.
[[nodiscard]] FinishedPiece finishPiece(PartMesh piece, const RenderSource& source, double error);

}  // namespace galactic::bake
