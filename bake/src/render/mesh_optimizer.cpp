#include "render/mesh_optimizer.h"

#include <meshoptimizer.h>

namespace galactic::bake {
namespace {

static_assert(sizeof(Triangle) == 3 * sizeof(unsigned int));

const unsigned int* indicesOf(std::span<const Triangle> triangles) {
  return reinterpret_cast<const unsigned int*>(triangles.data());
}

}  // namespace

ByteNumbers numberBytes(const void* elements, std::size_t count, std::size_t size) {
  ByteNumbers numbers;
  numbers.number_of.resize(count);
  if (count == 0) return numbers;
  numbers.count =
      meshopt_generateVertexRemap(numbers.number_of.data(), nullptr, count, elements, count, size);
  return numbers;
}

Simplified simplify(const PartMesh& mesh, double error, const std::vector<bool>& kept) {
  Simplified result;
  if (mesh.triangles.empty()) return result;
  const float* positions = &mesh.vertices.front().position.x;
  const std::size_t count = mesh.vertices.size();
  const float scale = meshopt_simplifyScale(positions, count, sizeof(RenderVertex));
  if (!(scale > 0)) return {mesh.triangles, 0.0};
  // This version of meshoptimizer does not accept a list of vertices to keep. But it keeps vertices
  // at which more than two open edges meet, and it counts the edges of a degenerate triangle as
  // open, so add one to each vertex to keep.
  std::vector<Triangle> input = mesh.triangles;
  for (std::uint32_t n = 0; n < kept.size(); ++n) {
    if (kept[n]) input.push_back({n, n, n});
  }
  result.triangles.resize(input.size());
  auto* indices = reinterpret_cast<unsigned int*>(result.triangles.data());
  float relative_error = 0;
  const std::size_t left = meshopt_simplify(indices, indicesOf(input), 3 * input.size(), positions,
                                            count, sizeof(RenderVertex), 0,
                                            static_cast<float>(error) / scale, 0, &relative_error);
  result.triangles.resize(left / 3);
  std::erase_if(result.triangles, [](const Triangle& t) { return t[0] == t[1]; });
  result.error = static_cast<double>(relative_error) * static_cast<double>(scale);
  return result;
}

std::vector<TriangleCluster> cutClusters(std::span<const Vec3> positions,
                                         std::span<const Triangle> triangles) {
  std::vector<TriangleCluster> clusters;
  if (triangles.empty()) return clusters;
  const std::size_t most =
      meshopt_buildMeshletsBound(3 * triangles.size(), kMostInCluster, kMostInCluster);
  std::vector<meshopt_Meshlet> meshlets(most);
  std::vector<unsigned int> vertices(most * kMostInCluster);
  std::vector<unsigned char> corners(most * kMostInCluster * 3);
  meshlets.resize(meshopt_buildMeshlets(
      meshlets.data(), vertices.data(), corners.data(), indicesOf(triangles), 3 * triangles.size(),
      &positions.front().x, positions.size(), sizeof(Vec3), kMostInCluster, kMostInCluster, 0));
  clusters.reserve(meshlets.size());
  for (const meshopt_Meshlet& meshlet : meshlets) {
    TriangleCluster& cluster = clusters.emplace_back();
    const auto first = vertices.begin() + meshlet.vertex_offset;
    cluster.vertices.assign(first, first + meshlet.vertex_count);
    cluster.triangles.reserve(meshlet.triangle_count);
    for (std::size_t n = 0; n < meshlet.triangle_count; ++n) {
      const unsigned char* corner = &corners[meshlet.triangle_offset + 3 * n];
      cluster.triangles.push_back({corner[0], corner[1], corner[2]});
    }
  }
  return clusters;
}

}  // namespace galactic::bake
