#include "render/lattice.h"

#include <algorithm>
#include <cmath>
#include <map>
#include <numeric>
#include <tuple>
#include <utility>

#include "galactic/bake/parallel_for.h"
#include "layout/morton.h"
#include "render/mesh_optimizer.h"

namespace galactic::bake {
namespace {

using Point = std::array<std::int32_t, 3>;

/// The triangles with the same surface key that are visible from one side or from both.
struct Group {
  SurfaceKey surface;
  bool two_sided = false;
  std::vector<LatticeVertex> vertices;
  std::vector<Triangle> triangles;
};

std::int32_t onLattice(float coordinate, double step) {
  return static_cast<std::int32_t>(std::llround(static_cast<double>(coordinate) / step));
}

/// Largest extent of a triangle along an axis, meters. A cluster on the lattice must be able to
/// span this.
double largestExtent(std::span<const FinishedPiece> pieces) {
  float largest = 0;
  const auto spread = [](float a, float b, float c) {
    return std::max({a, b, c}) - std::min({a, b, c});
  };
  for (const FinishedPiece& piece : pieces) {
    for (const Triangle& t : piece.mesh.triangles) {
      const Vec3& a = piece.mesh.vertices[t[0]].position;
      const Vec3& b = piece.mesh.vertices[t[1]].position;
      const Vec3& c = piece.mesh.vertices[t[2]].position;
      largest =
          std::max({largest, spread(a.x, b.x, c.x), spread(a.y, b.y, c.y), spread(a.z, b.z, c.z)});
    }
  }
  return static_cast<double>(largest);
}

/// Groups the triangles by surface and visible sides. The groups are in a fixed order, and the
/// triangles in their original order.
std::vector<Group> groupTriangles(std::span<const FinishedPiece> pieces, const RenderSource& source,
                                  double step) {
  std::map<std::tuple<std::uint16_t, std::uint16_t, bool>, Group> groups;
  for (const FinishedPiece& piece : pieces) {
    for (const Triangle& triangle : piece.mesh.triangles) {
      const SurfaceKey surface = piece.mesh.vertices[triangle[0]].surface;
      const bool two_sided = source.materials[surface.material].two_sided && !piece.has_outside;
      Group& group = groups[{surface.semantic, surface.material, two_sided}];
      group.surface = surface;
      group.two_sided = two_sided;
      const auto first = static_cast<std::uint32_t>(group.vertices.size());
      group.triangles.push_back({first, first + 1, first + 2});
      for (const std::uint32_t corner : triangle) {
        const RenderVertex& vertex = piece.mesh.vertices[corner];
        group.vertices.push_back(
            {.at = {onLattice(vertex.position.x, step), onLattice(vertex.position.y, step),
                    onLattice(vertex.position.z, step)},
             .uv = vertex.uv,
             .color = vertex.color});
      }
    }
  }
  std::vector<Group> listed;
  listed.reserve(groups.size());
  for (auto& [key, group] : groups) listed.push_back(std::move(group));
  return listed;
}

/// Welds vertices that became equal on the lattice, and drops triangles that lost their area.
void weld(Group& group) {
  const ByteNumbers numbers = numberValues(group.vertices);
  group.vertices = distinctValues(group.vertices, numbers);
  for (Triangle& triangle : group.triangles) {
    for (std::uint32_t& corner : triangle) corner = numbers.number_of[corner];
  }
  std::erase_if(group.triangles, [&](const Triangle& t) {
    const Point& a = group.vertices[t[0]].at;
    const Point& b = group.vertices[t[1]].at;
    const Point& c = group.vertices[t[2]].at;
    return a == b || b == c || c == a;
  });
}

std::vector<LatticeCluster> cutGroup(Group& group) {
  weld(group);
  std::vector<Vec3> positions;
  positions.reserve(group.vertices.size());
  for (const LatticeVertex& vertex : group.vertices) {
    positions.push_back({static_cast<float>(vertex.at[0]), static_cast<float>(vertex.at[1]),
                         static_cast<float>(vertex.at[2])});
  }
  std::vector<LatticeCluster> clusters;
  for (TriangleCluster& cut : cutClusters(positions, group.triangles)) {
    LatticeCluster& cluster = clusters.emplace_back();
    cluster.material = group.surface.material;
    cluster.semantic = group.surface.semantic;
    cluster.two_sided = group.two_sided;
    cluster.triangles = std::move(cut.triangles);
    cluster.vertices.reserve(cut.vertices.size());
    for (const std::uint32_t vertex : cut.vertices) {
      cluster.vertices.push_back(group.vertices[vertex]);
    }
  }
  return clusters;
}

struct Box {
  Point low{};
  Point high{};
};

Box boxOf(const LatticeCluster& cluster) {
  Box box{cluster.vertices.front().at, cluster.vertices.front().at};
  for (const LatticeVertex& vertex : cluster.vertices) {
    for (std::size_t n = 0; n < 3; ++n) {
      box.low[n] = std::min(box.low[n], vertex.at[n]);
      box.high[n] = std::max(box.high[n], vertex.at[n]);
    }
  }
  return box;
}

bool fits(const LatticeCluster& cluster) {
  const Box box = boxOf(cluster);
  return box.high[0] - box.low[0] <= kMostSteps && box.high[1] - box.low[1] <= kMostSteps &&
         box.high[2] - box.low[2] <= kMostSteps;
}

/// A cluster of the triangles `which` of another one.
LatticeCluster partOf(const LatticeCluster& cluster, std::span<const std::size_t> which) {
  LatticeCluster part = cluster;
  part.vertices.clear();
  part.triangles.clear();
  constexpr std::size_t kNone = ~std::size_t{0};
  std::vector<std::size_t> moved_to(cluster.vertices.size(), kNone);
  for (const std::size_t n : which) {
    auto& triangle = part.triangles.emplace_back(cluster.triangles[n]);
    for (std::uint8_t& corner : triangle) {
      std::size_t& to = moved_to[corner];
      if (to == kNone) {
        to = part.vertices.size();
        part.vertices.push_back(cluster.vertices[corner]);
      }
      corner = static_cast<std::uint8_t>(to);
    }
  }
  return part;
}

/// Appends a cluster. One that spans too many steps, because things with the same surface may be
/// far apart, is cut repeatedly at the widest gap between its triangles until its parts fit.
void appendFitting(LatticeCluster cluster, std::vector<LatticeCluster>& clusters) {
  if (fits(cluster)) {
    clusters.push_back(std::move(cluster));
    return;
  }
  const Box box = boxOf(cluster);
  std::size_t axis = 0;
  for (std::size_t n = 1; n < 3; ++n) {
    if (box.high[n] - box.low[n] > box.high[axis] - box.low[axis]) axis = n;
  }
  const auto begin = [&](std::size_t n) {
    const auto& [a, b, c] = cluster.triangles[n];
    return std::min(
        {cluster.vertices[a].at[axis], cluster.vertices[b].at[axis], cluster.vertices[c].at[axis]});
  };
  std::vector<std::size_t> order(cluster.triangles.size());
  std::iota(order.begin(), order.end(), std::size_t{0});
  std::stable_sort(order.begin(), order.end(),
                   [&](std::size_t a, std::size_t b) { return begin(a) < begin(b); });
  std::size_t cut = 1;
  for (std::size_t n = 2; n < order.size(); ++n) {
    if (begin(order[n]) - begin(order[n - 1]) > begin(order[cut]) - begin(order[cut - 1])) cut = n;
  }
  const std::span all(order);
  appendFitting(partOf(cluster, all.first(cut)), clusters);
  appendFitting(partOf(cluster, all.subspan(cut)), clusters);
}

std::vector<LatticeCluster> cutOnLattice(std::span<const FinishedPiece> pieces,
                                         const RenderSource& source, double step,
                                         unsigned threads) {
  std::vector<Group> groups = groupTriangles(pieces, source, step);
  std::vector<std::vector<LatticeCluster>> cut(groups.size());
  parallelFor(threads, groups.size(), [&](std::size_t n) { cut[n] = cutGroup(groups[n]); });
  std::vector<LatticeCluster> clusters;
  for (std::vector<LatticeCluster>& of_group : cut) {
    for (LatticeCluster& cluster : of_group) appendFitting(std::move(cluster), clusters);
  }
  return clusters;
}

/// Sorts the clusters such that neighbors in space become neighbors in the list.
void sortInSpace(std::vector<LatticeCluster>& clusters) {
  if (clusters.empty()) return;
  std::vector<std::array<std::int64_t, 3>> centers;
  centers.reserve(clusters.size());
  for (const LatticeCluster& cluster : clusters) {
    const Box box = boxOf(cluster);
    std::array<std::int64_t, 3>& center = centers.emplace_back();
    for (std::size_t n = 0; n < 3; ++n) {
      center[n] = (std::int64_t{box.low[n]} + box.high[n]) / 2;
    }
  }
  std::array<std::int64_t, 3> low = centers.front();
  std::int64_t widest = 0;
  for (std::size_t n = 0; n < 3; ++n) {
    std::int64_t high = centers.front()[n];
    for (const auto& center : centers) {
      low[n] = std::min(low[n], center[n]);
      high = std::max(high, center[n]);
    }
    widest = std::max(widest, high - low[n]);
  }
  unsigned shift = 0;
  while (widest >> shift >= std::int64_t{1} << 21U) ++shift;
  std::vector<std::pair<std::uint64_t, std::size_t>> order;
  order.reserve(clusters.size());
  for (const auto& center : centers) {
    const auto cell = [&](std::size_t n) {
      return static_cast<std::uint64_t>(center[n] - low[n]) >> shift;
    };
    order.emplace_back(mortonPlace(cell(0), cell(1), cell(2)), order.size());
  }
  std::sort(order.begin(), order.end());
  std::vector<LatticeCluster> sorted;
  sorted.reserve(clusters.size());
  for (const auto& [key, index] : order) sorted.push_back(std::move(clusters[index]));
  clusters = std::move(sorted);
}

}  // namespace

LatticeModel cutModel(std::span<const FinishedPiece> pieces, const RenderSource& source,
                      unsigned threads) {
  LatticeModel model;
  model.step = kFinestStep;
  // Rounding adds at most one step.
  const double largest = largestExtent(pieces);
  while (model.step * static_cast<double>(kMostSteps - 1) < largest) model.step *= 2;
  model.clusters = cutOnLattice(pieces, source, model.step, threads);
  sortInSpace(model.clusters);
  return model;
}

}  // namespace galactic::bake
