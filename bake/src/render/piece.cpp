#include "render/piece.h"

#include <algorithm>
#include <cmath>
#include <utility>

#include "common/vec3d.h"
#include "render/mesh_optimizer.h"
#include "render/simplify_within.h"

namespace galactic::bake {
namespace {

/// A closed piece may be a room with the camera in it if all edges of its bounds are longer than
/// this. Meters.
constexpr double kRoomSize = 1.5;
/// A closed piece with less volume than this times area^1.5 is two sheets back to back and has
/// practically no inside.
constexpr double kFlatVolume = 1e-9;
/// Fewest triangles that can enclose a volume.
constexpr std::size_t kFewestClosed = 4;

/// An edge from its lower to its higher end.
struct Edge {
  std::uint32_t low = 0;
  std::uint32_t high = 0;
  /// Whether the triangle traverses the edge from high to low.
  bool backwards = false;

  friend auto operator<=>(const Edge&, const Edge&) = default;
};

bool isClosed(const std::vector<Triangle>& triangles, const std::vector<std::uint32_t>& position) {
  std::vector<Edge> edges;
  edges.reserve(3 * triangles.size());
  for (const Triangle& triangle : triangles) {
    for (std::size_t n = 0; n < 3; ++n) {
      const std::uint32_t from = position[triangle[n]];
      const std::uint32_t to = position[triangle[(n + 1) % 3]];
      edges.push_back({std::min(from, to), std::max(from, to), from > to});
    }
  }
  std::sort(edges.begin(), edges.end());
  if (edges.size() % 2 != 0) return false;
  // In sorted order, each edge must occur exactly once forward and then once backward.
  for (std::size_t n = 0; n < edges.size(); n += 2) {
    const Edge& forwards = edges[n];
    const Edge& backwards = edges[n + 1];
    if (forwards.backwards || !backwards.backwards) return false;
    if (forwards.low != backwards.low || forwards.high != backwards.high) return false;
  }
  return true;
}

bool hasHoles(const PartMesh& piece, const RenderSource& source) {
  return std::any_of(piece.vertices.begin(), piece.vertices.end(), [&](const RenderVertex& v) {
    return source.baked.materials[v.surface.material].alpha_cutoff > 0;
  });
}

bool isTwoSided(const PartMesh& piece, const RenderSource& source) {
  return std::all_of(piece.vertices.begin(), piece.vertices.end(), [&](const RenderVertex& v) {
    return source.materials[v.surface.material].two_sided;
  });
}

/// Whether a part of a room may be inside a closed piece. The piece cannot cut a room, so all of it
/// would be inside.
bool mayHoldRoom(const PieceShape& shape, const RenderSource& source) {
  const Bounds& bounds = shape.bounds;
  return std::ranges::any_of(source.rooms, [&](const Bounds& room) {
    return bounds.min.x <= room.min.x && bounds.min.y <= room.min.y && bounds.min.z <= room.min.z &&
           room.max.x <= bounds.max.x && room.max.y <= bounds.max.y && room.max.z <= bounds.max.z;
  });
}

/// Whether the piece is a solid of which only the outside is visible. Flips it if it is inside out.
bool showOutside(PartMesh& piece, const PieceShape& shape, const RenderSource& source) {
  if (!shape.closed || hasHoles(piece, source)) return false;
  if (*std::min_element(shape.size.begin(), shape.size.end()) > kRoomSize) return false;
  if (mayHoldRoom(shape, source)) return false;
  const double flat = kFlatVolume * std::pow(shape.area, 1.5);
  if (shape.volume > flat) return true;
  // The visible side of a one-sided material is intended.
  if (shape.volume >= -flat || !isTwoSided(piece, source)) return false;
  for (Triangle& triangle : piece.triangles) std::swap(triangle[1], triangle[2]);
  return true;
}

double allowedError(const PieceShape& shape, double error) {
  const double longest = *std::max_element(shape.size.begin(), shape.size.end());
  if (!(longest > 0)) return 0;
  return std::min({error, kLargestShare * longest, kLargestThinness * shape.area / longest});
}

}  // namespace

PieceShape measurePiece(const PartMesh& piece) {
  PieceShape shape;
  std::vector<Vec3> positions;
  positions.reserve(piece.vertices.size());
  for (const RenderVertex& vertex : piece.vertices) positions.push_back(vertex.position);
  shape.closed = isClosed(piece.triangles, numberValues(positions).number_of);
  const Vec3d origin = widen(positions.front());
  shape.bounds = {positions.front(), positions.front()};
  auto& [low, high] = shape.bounds;
  for (const Vec3& p : positions) {
    low = {std::min(low.x, p.x), std::min(low.y, p.y), std::min(low.z, p.z)};
    high = {std::max(high.x, p.x), std::max(high.y, p.y), std::max(high.z, p.z)};
  }
  const Vec3d size = widen(high) - widen(low);
  shape.size = {size.x, size.y, size.z};
  for (const Triangle& triangle : piece.triangles) {
    const Vec3d a = widen(positions[triangle[0]]) - origin;
    const Vec3d b = widen(positions[triangle[1]]) - origin;
    const Vec3d c = widen(positions[triangle[2]]) - origin;
    shape.volume += dot(a, cross(b, c)) / 6;
    shape.area += norm(cross(b - a, c - a)) / 2;
  }
  return shape;
}

FinishedPiece finishPiece(PartMesh piece, const RenderSource& source, double error) {
  FinishedPiece finished;
  const PieceShape shape = measurePiece(piece);
  finished.has_outside = showOutside(piece, shape, source);
  Simplified simplified = simplifyWithin(piece, allowedError(shape, error)).surface;
  const std::size_t fewest = shape.closed ? kFewestClosed : 1;
  if (simplified.triangles.size() >= fewest) {
    piece.triangles = std::move(simplified.triangles);
    finished.error = static_cast<float>(simplified.error);
  }
  finished.mesh = std::move(piece);
  return finished;
}

}  // namespace galactic::bake
