#include "galactic/bake/triangle_mesh.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <bit>
#include <cmath>
#include <span>
#include <utility>

#include "import/affine.h"
#include "import/used_vertices.h"
#include "support/out_of_memory.h"
#include "support/try.h"

namespace galactic::bake {
namespace {

/// The greatest number of triangles: the geometry alone takes several GiB.
constexpr std::uint64_t kMaxTriangles = std::uint64_t{1} << 27U;
/// The least memory that a triangle takes until it is placed and cleaned, and then until it is in a
/// tree; measured with up to 1.8 million triangles.
constexpr double kBytesToPlace = 40;
constexpr double kBytesToBuild = 90;
constexpr std::uint32_t kNone = ~std::uint32_t{0};

Result<void> checkTriangles(std::uint64_t triangles, double bytes_each) {
  return checkMemory(bytes_each * static_cast<double>(triangles),
                     fmt::format("{} triangles", triangles),
                     "simplify the meshes, or split the scene");
}

/// The placed triangles of all instances, including degenerate and duplicate ones.
class Placement {
 public:
  explicit Placement(const SourceAsset& asset) : asset_(asset) {}

  Result<TriangleMesh> run();

 private:
  [[nodiscard]] Result<void> checkReferences() const;
  Result<void> place(const SourceInstance& instance);
  Result<std::uint32_t> placeVertex(const SourceInstance& instance, std::uint32_t vertex);
  [[nodiscard]] Result<void> checkExtents() const;

  const SourceAsset& asset_;
  TriangleMesh mesh_;
  /// Index in mesh_ of each vertex of the mesh being placed.
  std::vector<std::uint32_t> placed_;
};

Result<void> Placement::checkReferences() const {
  const auto broken = [&](const std::string& place) {
    return fail(ErrorCode::kInvalidInput, fmt::format("{}: {}", asset_.name, place),
                "refers to a mesh or vertex that does not exist; export the file again");
  };
  for (const SourceMesh& mesh : asset_.meshes) {
    const auto in_range = [&](const Triangle& triangle) {
      return *std::max_element(triangle.begin(), triangle.end()) < mesh.positions.size();
    };
    if (!std::all_of(mesh.triangles.begin(), mesh.triangles.end(), in_range)) {
      return broken(fmt::format("mesh '{}'", mesh.name));
    }
  }
  for (const SourceInstance& instance : asset_.instances) {
    if (instance.mesh >= asset_.meshes.size()) {
      return broken(fmt::format("node '{}'", instance.name));
    }
  }
  return {};
}

Result<std::uint32_t> Placement::placeVertex(const SourceInstance& instance, std::uint32_t vertex) {
  const auto p =
      transformed(instance.world_from_mesh, asset_.meshes[instance.mesh].positions[vertex]);
  // Adding zero turns -0 into +0, so that equal positions have equal bits.
  const Vec3 rounded{static_cast<float>(p[0]) + 0.F, static_cast<float>(p[1]) + 0.F,
                     static_cast<float>(p[2]) + 0.F};
  if (!std::isfinite(rounded.x) || !std::isfinite(rounded.y) || !std::isfinite(rounded.z)) {
    return fail(ErrorCode::kInvalidInput,
                fmt::format("{}: node '{}', mesh '{}'", asset_.name, instance.name,
                            asset_.meshes[instance.mesh].name),
                fmt::format("vertex {} lies at ({}, {}, {}) in the world, which is not finite; "
                            "repair the mesh or its node's transform",
                            vertex, p[0], p[1], p[2]));
  }
  mesh_.vertices.push_back(rounded);
  return static_cast<std::uint32_t>(mesh_.vertices.size() - 1);
}

Result<void> Placement::place(const SourceInstance& instance) {
  const SourceMesh& source = asset_.meshes[instance.mesh];
  const bool mirrors = determinant(instance.world_from_mesh) < 0;
  if (placed_.size() < source.positions.size()) placed_.resize(source.positions.size(), kNone);
  for (Triangle triangle : source.triangles) {
    for (std::uint32_t& corner : triangle) {
      std::uint32_t& placed = placed_[corner];
      if (placed == kNone) {
        ASSIGN_OR_RETURN(const auto fresh, placeVertex(instance, corner));
        placed = fresh;
      }
      corner = placed;
    }
    if (mirrors) std::swap(triangle[1], triangle[2]);
    mesh_.triangles.push_back(triangle);
  }
  // Resets only what was touched: a small mesh may come after a large one.
  for (const Triangle& triangle : source.triangles) {
    for (const std::uint32_t corner : triangle) placed_[corner] = kNone;
  }
  return {};
}

Bounds boundsOf(const std::vector<Vec3>& vertices) {
  Bounds bounds{vertices.front(), vertices.front()};
  for (const Vec3& v : vertices) {
    bounds.min = {std::min(bounds.min.x, v.x), std::min(bounds.min.y, v.y),
                  std::min(bounds.min.z, v.z)};
    bounds.max = {std::max(bounds.max.x, v.x), std::max(bounds.max.y, v.y),
                  std::max(bounds.max.z, v.z)};
  }
  return bounds;
}

Result<void> Placement::checkExtents() const {
  const Bounds& b = mesh_.bounds;
  const auto farthest =
      static_cast<double>(std::max({-b.min.x, -b.min.y, -b.min.z, b.max.x, b.max.y, b.max.z}));
  if (farthest <= kMaxCoordinate) return {};
  const auto size =
      static_cast<double>(std::max({b.max.x - b.min.x, b.max.y - b.min.y, b.max.z - b.min.z}));
  const std::string found = fmt::format(
      "it is {:.4g} m large and reaches {:.4g} m from the origin, but only {} m are "
      "possible; ",
      size, farthest, kMaxCoordinate);
  const bool fits = size <= kMaxCoordinate;
  return fail(ErrorCode::kInvalidInput, asset_.name,
              found + (fits ? "move it to the origin with `transform`, or, if its unit is not the "
                              "meter, give `scale` 0.01 (centimeters) or `scale` 0.001 "
                              "(millimeters)"
                            : "is its unit the meter? Give `scale` 0.01 for centimeters or `scale` "
                              "0.001 for millimeters, or cut what is so large into parts"));
}

Result<TriangleMesh> Placement::run() {
  RETURN_IF_ERROR(checkReferences());
  std::uint64_t triangles = 0;
  std::uint64_t vertices = 0;
  for (const SourceInstance& instance : asset_.instances) {
    triangles += asset_.meshes[instance.mesh].triangles.size();
    vertices += asset_.meshes[instance.mesh].positions.size();
    if (triangles > kMaxTriangles) {
      return fail(
          ErrorCode::kInvalidInput, asset_.name,
          fmt::format("it places more than {} triangles; split or simplify it", kMaxTriangles));
    }
  }
  if (triangles == 0) {
    return fail(ErrorCode::kInvalidInput, asset_.name, "it has no triangles; expected a surface");
  }
  RETURN_IF_ERROR(checkTriangles(triangles, kBytesToPlace));
  mesh_.triangles.reserve(triangles);
  mesh_.vertices.reserve(std::min(vertices, 3 * triangles));
  for (const SourceInstance& instance : asset_.instances) {
    RETURN_IF_ERROR(place(instance));
  }
  mesh_.bounds = boundsOf(mesh_.vertices);
  RETURN_IF_ERROR(checkExtents());
  return std::move(mesh_);
}

using Corners = std::array<Vec3, 3>;

/// Twice the area over the longest edge, in double precision.
double shortestAltitude(const Corners& corners) {
  const auto difference = [](const Vec3& a, const Vec3& b) {
    return std::array<double, 3>{static_cast<double>(b.x) - static_cast<double>(a.x),
                                 static_cast<double>(b.y) - static_cast<double>(a.y),
                                 static_cast<double>(b.z) - static_cast<double>(a.z)};
  };
  const auto squared = [](const std::array<double, 3>& v) {
    return v[0] * v[0] + v[1] * v[1] + v[2] * v[2];
  };
  const auto u = difference(corners[0], corners[1]);
  const auto v = difference(corners[0], corners[2]);
  const auto w = difference(corners[1], corners[2]);
  const double longest = std::sqrt(std::max({squared(u), squared(v), squared(w)}));
  if (longest == 0) return 0;
  const std::array<double, 3> cross{u[1] * v[2] - u[2] * v[1], u[2] * v[0] - u[0] * v[2],
                                    u[0] * v[1] - u[1] * v[0]};
  return std::sqrt(squared(cross)) / longest;
}

std::uint64_t mixed(std::uint64_t value) {
  value ^= value >> 32U;
  value *= 0x9E3779B97F4A7C15U;
  value ^= value >> 29U;
  value *= 0xBF58476D1CE4E5B9U;
  return value ^ (value >> 32U);
}

std::uint64_t hashOf(const Vec3& v) {
  const std::uint64_t xy =
      (std::uint64_t{std::bit_cast<std::uint32_t>(v.x)} << 32U) | std::bit_cast<std::uint32_t>(v.y);
  return mixed(mixed(xy) + std::bit_cast<std::uint32_t>(v.z));
}

/// The same hash for every order of the corners.
std::uint64_t hashOf(const Corners& corners) {
  return mixed(hashOf(corners[0]) + hashOf(corners[1]) + hashOf(corners[2]));
}

/// The triangles seen so far, by their corner positions in any order: an open-addressing table.
class SeenTriangles {
 public:
  explicit SeenTriangles(std::size_t capacity)
      : slots_(std::bit_ceil(2 * capacity)), mask_(slots_.size() - 1) {}

  /// Prefetches what insert() will need: the table is larger than the caches.
  void prefetch(std::uint64_t hash) const { __builtin_prefetch(&slots_[hash & mask_]); }

  /// Returns whether `corners` (of this hash) are new; if so, remembers them as triangle `index` of
  /// `mesh`.
  bool insert(const TriangleMesh& mesh, const Corners& corners, std::uint64_t hash,
              std::uint32_t index) {
    const auto tag = static_cast<std::uint32_t>(hash >> 32U);
    std::size_t slot = hash & mask_;
    while (slots_[slot].triangle != kNone) {
      if (slots_[slot].tag == tag &&
          std::is_permutation(corners.begin(), corners.end(),
                              cornersOf(mesh, mesh.triangles[slots_[slot].triangle]).begin())) {
        return false;
      }
      slot = (slot + 1) & mask_;
    }
    slots_[slot] = {tag, index};
    return true;
  }

 private:
  struct Slot {
    /// Upper half of the hash; avoids most comparisons of corners, which are cache misses.
    std::uint32_t tag = 0;
    std::uint32_t triangle = kNone;
  };

  std::vector<Slot> slots_;
  std::size_t mask_;
};

/// Drops degenerate triangles, and all but the first of equal ones, in place.
CleaningCounts dropTriangles(TriangleMesh& mesh) {
  constexpr std::size_t kBlock = 32;
  struct Candidate {
    Triangle triangle{};
    Corners corners{};
    std::uint64_t hash = 0;
    bool degenerate = false;
  };
  std::array<Candidate, kBlock> block;
  CleaningCounts counts{.read = mesh.triangles.size()};
  SeenTriangles seen(mesh.triangles.size());
  std::uint32_t kept = 0;
  for (std::size_t first = 0; first < counts.read; first += kBlock) {
    const auto candidates = std::span(block).first(std::min(kBlock, counts.read - first));
    for (std::size_t i = 0; i < candidates.size(); ++i) {
      Candidate& candidate = candidates[i];
      candidate.triangle = mesh.triangles[first + i];
      candidate.corners = cornersOf(mesh, candidate.triangle);
      candidate.hash = hashOf(candidate.corners);
      candidate.degenerate = shortestAltitude(candidate.corners) < kDegenerateHeight;
      seen.prefetch(candidate.hash);
    }
    for (const Candidate& candidate : candidates) {
      if (candidate.degenerate) {
        ++counts.degenerate;
      } else if (!seen.insert(mesh, candidate.corners, candidate.hash, kept)) {
        ++counts.duplicate;
      } else {
        mesh.triangles[kept++] = candidate.triangle;
      }
    }
  }
  mesh.triangles.resize(kept);
  return counts;
}

/// Drops vertices that no triangle uses, keeping the order of the others.
void dropUnusedVertices(TriangleMesh& mesh) {
  const std::vector<std::uint32_t> places = placesOfUsed(mesh.vertices.size(), mesh.triangles);
  keepUsed(places, mesh.vertices);
  moveCorners(places, mesh.triangles);
}

}  // namespace

Result<CleanMesh> placeAndClean(const SourceAsset& asset) {
  ASSIGN_OR_RETURN(auto placed, Placement(asset).run());
  CleanMesh clean{.mesh = std::move(placed), .counts = {}};
  clean.counts = dropTriangles(clean.mesh);
  if (clean.mesh.triangles.empty()) {
    return fail(ErrorCode::kInvalidInput, asset.name,
                fmt::format("all of its {} triangles are degenerate (lower than {} m); if its unit "
                            "is not the meter, give `scale`",
                            clean.counts.read, kDegenerateHeight));
  }
  if (clean.counts.degenerate + clean.counts.duplicate != 0) {
    dropUnusedVertices(clean.mesh);
    clean.mesh.bounds = boundsOf(clean.mesh.vertices);
  }
  RETURN_IF_ERROR(checkTriangles(clean.mesh.triangles.size(), kBytesToBuild));
  return clean;
}

}  // namespace galactic::bake
