#pragma once
#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <string>
#include <string_view>
#include <vector>

#include "galactic/bake/mesh_import.h"
#include "galactic/bake/triangle_mesh.h"
#include "support/mesh_files.h"
#include "support/scratch_folder.h"

namespace galactic::test {

using WorldPoint = std::array<double, 3>;
using WorldTriangle = std::array<WorldPoint, 3>;

/// Where the vertices of a test file are expected in the world.
using Expected = WorldPoint (*)(const std::array<float, 3>&);

/// Triangles in an order that does not depend on the file: each starts at its smallest corner (its
/// winding stays), and they are sorted.
inline std::vector<WorldTriangle> inCanonicalOrder(std::vector<WorldTriangle> triangles) {
  for (WorldTriangle& triangle : triangles) {
    std::rotate(triangle.begin(), std::min_element(triangle.begin(), triangle.end()),
                triangle.end());
  }
  std::sort(triangles.begin(), triangles.end());
  return triangles;
}

inline std::vector<WorldTriangle> worldTriangles(const bake::TriangleMesh& mesh) {
  std::vector<WorldTriangle> triangles;
  for (const bake::Triangle& t : mesh.triangles) {
    WorldTriangle& triangle = triangles.emplace_back();
    for (std::size_t c = 0; c < 3; ++c) {
      const Vec3& v = mesh.vertices[t[c]];
      triangle[c] = {static_cast<double>(v.x), static_cast<double>(v.y), static_cast<double>(v.z)};
    }
  }
  return inCanonicalOrder(std::move(triangles));
}

inline std::vector<WorldTriangle> expectedTriangles(const MeshContent& mesh, Expected expected) {
  std::vector<WorldTriangle> triangles;
  for (const auto& t : mesh.triangles) {
    triangles.push_back({expected(mesh.positions[t[0]]), expected(mesh.positions[t[1]]),
                         expected(mesh.positions[t[2]])});
  }
  return inCanonicalOrder(std::move(triangles));
}

/// Largest difference of a coordinate; infinite when the counts differ.
inline double largestDifference(const std::vector<WorldTriangle>& a,
                                const std::vector<WorldTriangle>& b) {
  if (a.size() != b.size()) return std::numeric_limits<double>::infinity();
  double largest = 0;
  for (std::size_t t = 0; t < a.size(); ++t) {
    for (std::size_t c = 0; c < 3; ++c) {
      for (std::size_t axis = 0; axis < 3; ++axis) {
        largest = std::max(largest, std::abs(a[t][c][axis] - b[t][c][axis]));
      }
    }
  }
  return largest;
}

/// Imports a file of this name and content and returns what the importer says.
inline Result<bake::SourceAsset> importContent(std::string_view name, std::string_view content,
                                               const bake::MeshImportOptions& options = {}) {
  const ScratchFolder folder;
  return bake::importMesh(folder.write(name, content), options);
}

/// The error of an import that has to fail; a failed expectation when it succeeds.
inline Error importError(std::string_view name, std::string_view content,
                         const bake::MeshImportOptions& options = {}) {
  const auto asset = importContent(name, content, options);
  EXPECT_FALSE(asset.has_value()) << name << " was accepted";
  return asset ? Error{} : asset.error();
}

}  // namespace galactic::test
