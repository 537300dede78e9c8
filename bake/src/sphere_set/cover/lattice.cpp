#include "sphere_set/cover/lattice.h"

#include <array>
#include <cstdint>

#include "galactic/bake/parallel_for.h"

namespace galactic::bake::sphere_set {
namespace {

/// Number of lattice points along an edge of the smallest cubes.
constexpr std::int64_t kLeafEdge = 4;

/// Lattice points at to at + edge - 1 along each axis.
struct Cube {
  std::array<std::int64_t, 3> at{};
  std::int64_t edge = 0;
};

class BandSearch {
 public:
  BandSearch(const ExteriorSolid& solid, const LatticeBand& band)
      : solid_(solid), band_(band), middle_((solid.bounds().min + solid.bounds().max) * 0.5) {}

  /// The smallest cubes that may hold points of the band.
  [[nodiscard]] std::vector<Cube> leaves() const {
    const Vec3d size = solid_.bounds().widened(std::max(band_.highest, 0.0)).size();
    const double half = std::max({size.x, size.y, size.z}) / 2;
    std::int64_t edge = kLeafEdge;
    const auto reach = [&] { return static_cast<double>(edge - 2) / 2 * band_.spacing; };
    while (reach() < half) edge *= 2;
    std::vector<Cube> leaves;
    std::vector<Cube> open{{{-edge / 2, -edge / 2, -edge / 2}, edge}};
    while (!open.empty()) {
      const Cube cube = open.back();
      open.pop_back();
      if (!mayHold(cube)) continue;
      if (cube.edge == kLeafEdge) {
        leaves.push_back(cube);
        continue;
      }
      const std::int64_t h = cube.edge / 2;
      for (std::int64_t part = 8; part-- > 0;) {
        open.push_back({{cube.at[0] + (part % 2) * h, cube.at[1] + (part / 2 % 2) * h,
                         cube.at[2] + part / 4 * h},
                        h});
      }
    }
    return leaves;
  }

  void collect(const Cube& leaf, std::vector<LatticePoint>& points) const {
    std::uint32_t hint = kNoFacet;
    for (std::int64_t z = 0; z < leaf.edge; ++z) {
      for (std::int64_t y = 0; y < leaf.edge; ++y) {
        for (std::int64_t x = 0; x < leaf.edge; ++x) {
          const Vec3d p = asStored(
              position({static_cast<double>(leaf.at[0] + x), static_cast<double>(leaf.at[1] + y),
                        static_cast<double>(leaf.at[2] + z)}));
          const SurfaceDistance surface = solid_.distance(p, hint);
          hint = surface.facet;
          if (surface.distance < band_.lowest || surface.distance > band_.highest) continue;
          if (band_.wanted != nullptr && !band_.wanted->anyWithin(p, band_.reach)) continue;
          points.push_back({p, surface});
        }
      }
    }
  }

 private:
  [[nodiscard]] Vec3d position(const Vec3d& steps) const { return middle_ + steps * band_.spacing; }

  [[nodiscard]] bool mayHold(const Cube& cube) const {
    const double half = static_cast<double>(cube.edge - 1) / 2;
    const Vec3d center =
        position({static_cast<double>(cube.at[0]) + half, static_cast<double>(cube.at[1]) + half,
                  static_cast<double>(cube.at[2]) + half});
    const double to_corner = half * band_.spacing * std::sqrt(3.0);
    if (band_.wanted != nullptr && !band_.wanted->anyWithin(center, band_.reach + to_corner)) {
      return false;
    }
    const double distance = solid_.distance(center).distance;
    return distance - to_corner <= band_.highest && distance + to_corner >= band_.lowest;
  }

  const ExteriorSolid& solid_;
  const LatticeBand& band_;
  Vec3d middle_;
};

}  // namespace

std::vector<LatticePoint> latticeInBand(const ExteriorSolid& solid, const LatticeBand& band,
                                        unsigned threads) {
  const BandSearch search(solid, band);
  const std::vector<Cube> leaves = search.leaves();
  std::vector<std::vector<LatticePoint>> parts(leaves.size());
  parallelFor(threads, leaves.size(),
              [&](std::size_t at) { search.collect(leaves[at], parts[at]); });
  std::vector<LatticePoint> points;
  for (const auto& part : parts) points.insert(points.end(), part.begin(), part.end());
  return points;
}

}  // namespace galactic::bake::sphere_set
