#include "sphere_set/solid/probe_field.h"

#include <limits>

#include "galactic/bake/parallel_for.h"

namespace galactic::bake::sphere_set {
namespace {

/// More voxels would take too much memory and time; the probe grows instead.
constexpr double kMostVoxels = 6e6;
/// The grid has kVoxelsAlong voxels along the object, but their edge is between these shares of the
/// smallest radius.
constexpr double kVoxelsAlong = 110;
constexpr double kFinestVoxel = 0.16;
constexpr double kCoarsestVoxel = 0.35;
/// Least radius of the probe in voxels. A smaller one could slip through surfaces between the
/// corners of the grid.
constexpr double kVoxelsPerProbe = 1.0 / 0.7;
/// Distances are exact up to the probe's radius plus this many voxels.
constexpr double kExactVoxels = 1.5;
/// A search at a free voxel looks this many voxels farther, so that neighbors that are also free
/// need no search.
constexpr double kSkipVoxels = 7;

constexpr std::uint32_t kUnreached = std::numeric_limits<std::uint32_t>::max();

/// Lower envelope of the parabolas around the voxels of one line (Felzenszwalb and Huttenlocher,
/// Distance Transforms of Sampled Functions, section 2), in whole numbers.
class Envelope {
 public:
  explicit Envelope(std::size_t length) : at_(length), height_(length), from_(length) {}

  void clear() { count_ = 0; }

  /// Adds the parabola with its minimum `height` at `at`. Call it in ascending order of `at`.
  void add(std::int64_t at, std::int64_t height) {
    while (count_ > 0) {
      const std::int64_t start = crossing(count_ - 1, at, height);
      if (start > from_[count_ - 1]) {
        push(at, height, start);
        return;
      }
      --count_;
    }
    push(at, height, std::numeric_limits<std::int64_t>::min());
  }

  [[nodiscard]] bool empty() const { return count_ == 0; }

  /// The position of the minimum of the parabola that is lowest at `at`. Call it in ascending order
  /// of `at`, starting with `hint` = 0.
  [[nodiscard]] std::int64_t lowest(std::int64_t at, std::size_t& hint) const {
    while (hint + 1 < count_ && from_[hint + 1] <= at) ++hint;
    return at_[hint];
  }

 private:
  /// The first integer position at which the new parabola is below the one at `rank`.
  [[nodiscard]] std::int64_t crossing(std::size_t rank, std::int64_t at,
                                      std::int64_t height) const {
    const std::int64_t numerator = (height + at * at) - (height_[rank] + at_[rank] * at_[rank]);
    const std::int64_t denominator = 2 * (at - at_[rank]);
    const std::int64_t quotient = numerator / denominator;
    const bool floors = numerator >= 0 || quotient * denominator == numerator;
    return (floors ? quotient : quotient - 1) + 1;
  }

  void push(std::int64_t at, std::int64_t height, std::int64_t from) {
    at_[count_] = at;
    height_[count_] = height;
    from_[count_++] = from;
  }

  std::vector<std::int64_t> at_;
  std::vector<std::int64_t> height_;
  std::vector<std::int64_t> from_;
  std::size_t count_ = 0;
};

std::int64_t squared(std::int64_t value) { return value * value; }

}  // namespace

ProbeField::ProbeField(const TriangleTree& tree, const Box& bounds, double smallest_radius,
                       unsigned threads) {
  chooseGrid(bounds, smallest_radius);
  spread(tree);
  findNearestReached(threads);
}

void ProbeField::chooseGrid(const Box& bounds, double smallest_radius) {
  const Vec3d size = bounds.size();
  const double longest = std::max({size.x, size.y, size.z});
  voxel_ = std::clamp(longest / kVoxelsAlong, kFinestVoxel * smallest_radius,
                      kCoarsestVoxel * smallest_radius);
  while (true) {
    probe_ = std::max(smallest_radius / 2, kVoxelsPerProbe * voxel_);
    const double margin = probe_ + 3 * voxel_;
    origin_ = bounds.min - Vec3d{margin, margin, margin};
    const auto along = [&](double extent) {
      return std::floor((extent + 2 * margin) / voxel_) + 2;
    };
    const std::array<double, 3> count{along(size.x), along(size.y), along(size.z)};
    if (count[0] * count[1] * count[2] <= kMostVoxels) {
      for (std::size_t axis = 0; axis < 3; ++axis) {
        size_[axis] = static_cast<std::size_t>(count[axis]);
      }
      return;
    }
    voxel_ *= 1.05;
  }
}

Vec3d ProbeField::positionOf(std::size_t index) const {
  const auto [x, y, z] = cellOf(index);
  return origin_ +
         Vec3d{static_cast<double>(x), static_cast<double>(y), static_cast<double>(z)} * voxel_;
}

void ProbeField::spread(const TriangleTree& tree) {
  /// A voxel to continue from, a facet near it, and a lower bound of its distance.
  struct Step {
    std::uint32_t at = 0;
    std::uint32_t facet = kNoFacet;
    double at_least = 0;
  };
  clearance_.assign(size_[0] * size_[1] * size_[2], kUnknown);
  nearest_.assign(clearance_.size(), kUnreached);
  const double exact = probe_ + kExactVoxels * voxel_;
  const double far = exact + kSkipVoxels * voxel_;
  std::vector<Step> front;
  const auto visit = [&](std::size_t at, const Step& from) {
    if (clearance_[at] != kUnknown) return;
    Step step{static_cast<std::uint32_t>(at), from.facet, from.at_least - voxel_};
    // The distance changes by at most the distance moved, so few searches are necessary far from
    // the mesh. Which ones are made does not affect the result.
    if (step.at_least < exact) {
      const SearchLimits limits{far * far, probe_ * probe_ * (1 - 1e-9), from.facet};
      const NearestPoint found = tree.nearest(positionOf(at), limits);
      if (found.squared <= limits.squared_enough) {
        clearance_[at] = kBlocked;
        return;
      }
      if (found.facet != kNoFacet) step.facet = found.facet;
      step.at_least = std::sqrt(found.squared);
    }
    clearance_[at] = static_cast<float>(std::min(exact, step.at_least));
    nearest_[at] = step.at;
    front.push_back(step);
  };
  visit(0, {});
  while (!front.empty()) {
    const Step from = front.back();
    front.pop_back();
    const auto cell = cellOf(from.at);
    std::size_t stride = 1;
    for (std::size_t axis = 0; axis < 3; ++axis) {
      if (cell[axis] > 0) visit(from.at - stride, from);
      if (cell[axis] + 1 < size_[axis]) visit(from.at + stride, from);
      stride *= size_[axis];
    }
  }
}

void ProbeField::findNearestReached(unsigned threads) {
  parallelFor(threads, size_[2], [&](std::size_t z) { nearestInPlane(z); });
  parallelFor(threads, size_[1], [&](std::size_t y) { nearestAcrossPlanes(y); });
}

void ProbeField::nearestInRow(std::size_t y, std::size_t z) {
  // The nearer of the previous and the next reached voxel.
  std::uint32_t* row = &nearest_[index(0, y, z)];
  const auto first = static_cast<std::uint32_t>(index(0, y, z));
  std::uint32_t last = kUnreached;
  for (std::size_t x = 0; x < size_[0]; ++x) {
    const std::uint32_t at = first + static_cast<std::uint32_t>(x);
    if (row[x] == at) last = at;
    row[x] = last;
  }
  last = kUnreached;
  for (std::size_t x = size_[0]; x-- > 0;) {
    const std::uint32_t at = first + static_cast<std::uint32_t>(x);
    if (row[x] == at) last = at;
    if (last != kUnreached && (row[x] == kUnreached || last - at < at - row[x])) row[x] = last;
  }
}

void ProbeField::nearestInPlane(std::size_t z) {
  for (std::size_t y = 0; y < size_[1]; ++y) nearestInRow(y, z);
  Envelope envelope(size_[1]);
  std::vector<std::uint32_t> column(size_[1]);
  for (std::size_t x = 0; x < size_[0]; ++x) {
    envelope.clear();
    for (std::size_t y = 0; y < size_[1]; ++y) {
      column[y] = nearest_[index(x, y, z)];
      if (column[y] == kUnreached) continue;
      const auto away =
          static_cast<std::int64_t>(column[y] % size_[0]) - static_cast<std::int64_t>(x);
      envelope.add(static_cast<std::int64_t>(y), squared(away));
    }
    if (envelope.empty()) continue;
    std::size_t hint = 0;
    for (std::size_t y = 0; y < size_[1]; ++y) {
      const std::int64_t best = envelope.lowest(static_cast<std::int64_t>(y), hint);
      nearest_[index(x, y, z)] = column[static_cast<std::size_t>(best)];
    }
  }
}

void ProbeField::nearestAcrossPlanes(std::size_t y) {
  Envelope envelope(size_[2]);
  std::vector<std::uint32_t> column(size_[2]);
  for (std::size_t x = 0; x < size_[0]; ++x) {
    envelope.clear();
    for (std::size_t z = 0; z < size_[2]; ++z) {
      column[z] = nearest_[index(x, y, z)];
      if (column[z] == kUnreached) continue;
      const auto cell = cellOf(column[z]);
      const std::int64_t height =
          squared(static_cast<std::int64_t>(cell[0]) - static_cast<std::int64_t>(x)) +
          squared(static_cast<std::int64_t>(cell[1]) - static_cast<std::int64_t>(y));
      envelope.add(static_cast<std::int64_t>(z), height);
    }
    if (envelope.empty()) continue;
    std::size_t hint = 0;
    for (std::size_t z = 0; z < size_[2]; ++z) {
      const std::int64_t best = envelope.lowest(static_cast<std::int64_t>(z), hint);
      nearest_[index(x, y, z)] = column[static_cast<std::size_t>(best)];
    }
  }
}

double ProbeField::excess(const Vec3d& p) const {
  const Vec3d at = (p - origin_) * (1 / voxel_);
  const auto inside = [&](double coordinate, std::size_t axis) {
    return coordinate >= 0 && coordinate < static_cast<double>(size_[axis] - 1);
  };
  if (!inside(at.x, 0) || !inside(at.y, 1) || !inside(at.z, 2)) return -HUGE_VAL;
  const std::size_t corner = index(static_cast<std::size_t>(at.x), static_cast<std::size_t>(at.y),
                                   static_cast<std::size_t>(at.z));
  const std::size_t row = size_[0];
  const std::size_t plane = size_[0] * size_[1];
  double least = HUGE_VAL;
  std::uint32_t previous = kUnreached;
  for (const std::size_t step : {std::size_t{0}, std::size_t{1}, row, row + 1, plane, plane + 1,
                                 plane + row, plane + row + 1}) {
    const std::uint32_t reached = nearest_[corner + step];
    if (reached == previous || reached == kUnreached) continue;
    previous = reached;
    least =
        std::min(least, norm(p - positionOf(reached)) - static_cast<double>(clearance_[reached]));
  }
  return least;
}

}  // namespace galactic::bake::sphere_set
