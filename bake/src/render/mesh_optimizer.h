#pragma once
#include <array>
#include <cstdint>
#include <span>
#include <vector>

#include "galactic/pose.h"
#include "render/part_mesh.h"

namespace galactic::bake {

// What meshoptimizer does for us, and the only place that names it.

/// For each element of `size` bytes the number of its value: equal bytes get equal numbers, which
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

/// One of each value of a vector, by the numbers of numberValues.
template <class T>
[[nodiscard]] std::vector<T> distinctValues(const std::vector<T>& values,
                                            const ByteNumbers& numbers) {
  std::vector<T> distinct(numbers.count);
  for (std::size_t n = 0; n < values.size(); ++n) distinct[numbers.number_of[n]] = values[n];
  return distinct;
}

struct Simplified {
  std::vector<Triangle> triangles;
  /// How far the surface moved at most, meters, as the quadrics estimate.
  double error = 0;
};

/// Fewer triangles over the same vertices, the surface moved by up to `error` meters. What is equal
/// by position moves together, so no crack opens between vertices that differ in the rest. `kept`:
/// a mark for each vertex; what is marked at a position keeps all vertices there where they are.
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
