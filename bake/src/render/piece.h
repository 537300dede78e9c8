#pragma once
#include <cstdint>
#include <vector>

#include "galactic/bake/render_baker.h"
#include "render/part_mesh.h"

namespace galactic::bake {

/// The shape of a connected piece before it is simplified.
struct PieceShape {
  /// Whether every edge, by position, has exactly two triangles, which traverse it in opposite
  /// directions.
  bool closed = false;
  /// Volume of a closed piece, positive if its triangles face outward. Cubic meters.
  double volume = 0;
  double area = 0;
  Bounds bounds;
  /// Edge lengths of the bounds, meters.
  std::array<double, 3> size{};
};
[[nodiscard]] PieceShape measurePiece(const PartMesh& piece);

/// A connected piece, ready for clusters.
struct FinishedPiece {
  PartMesh mesh;
  /// Whether its triangles need not be visible from behind, even if their material is two-sided.
  bool has_outside = false;
  /// Measured largest distance by which simplification moved the surface, meters.
  float error = 0;
};

/// Decides from which sides the piece is visible, flips it if it is inside out, and simplifies it.
/// `error`: the largest error that the user allows, meters.
[[nodiscard]] FinishedPiece finishPiece(PartMesh piece, const RenderSource& source, double error);

}  // namespace galactic::bake
