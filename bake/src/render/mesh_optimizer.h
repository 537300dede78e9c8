#pragma once
#include <array>
#include <cstdint>
#include <span>
#include <vector>

#include "galactic/pose.h"
#include "render/part_mesh.h"

namespace galactic::bake {

// Wraps meshoptimizer, which no other files name.

/// A number for the value of each element of `size` bytes. Equal bytes get equal numbers, which
/// count up in the order of first use.
struct ByteNumbers {
  std::vector<std::uint32_t> number_of;
  std::size_t count = 0;
};
[[nodiscard]] ByteNumbers numberBytes(const void* elements, std::size_t count, std::size_t size);

/// numberBytes of a vector of plain structs without padding.
template <class T>
[[nodiscard]] ByteNumbers numberValues(const std::vector<T>& values) {
  return numberBytes(values.data(), values.size(), sizeof(T));
}

/// The distinct values of a vector, in the order of the numbers from numberValues.
template <class T>
[[nodiscard]] std::vector<T> distinctValues(const std::vector<T>& values,
                                            const ByteNumbers& numbers) {
  std::vector<T> distinct(numbers.count);
  for (std::size_t n = 0; n < values.size(); ++n) distinct[numbers.number_of[n]] = values[n];
  return distinct;
}

struct Simplified {
  std::vector<Triangle> triangles;
  /// The largest distance by which the surface moved, as estimated by the quadrics, meters.
  double error = 0;
};

/// Reduces the triangles over the same vertices, moving the surface by up to `error` meters.
/// Vertices at the same position move together, so no crack opens between vertices that differ only
/// in other attributes. `kept`: a flag per vertex; a set flag pins all vertices at its position.
[[nodiscard]] Simplified simplify(const PartMesh& mesh, double error,
                                  const std::vector<bool>& kept);

/// Triangles that lie near each other.
struct TriangleCluster {
  /// Indices into the positions.
  std::vector<std::uint32_t> vertices;
  /// Corners: indices into `vertices`.
  std::vector<std::array<std::uint8_t, 3>> triangles;
};

/// Cuts triangles into clusters of at most kMostInCluster vertices and triangles.
[[nodiscard]] std::vector<TriangleCluster> cutClusters(std::span<const Vec3> positions,
                                                       std::span<const Triangle> triangles);

}  // namespace galactic::bake
