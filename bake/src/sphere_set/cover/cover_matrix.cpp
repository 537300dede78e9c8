#include "sphere_set/cover/cover_matrix.h"

#include "galactic/bake/parallel_for.h"

namespace galactic::bake::sphere_set {
namespace {

constexpr std::size_t kChunk = 256;
constexpr std::size_t kProbes = 32;

}  // namespace

CoverMatrix CoverMatrix::transposed(std::size_t rows) const {
  CoverMatrix result;
  result.first_.assign(rows + 1, 0);
  for (const std::uint32_t row : rows_) ++result.first_[row + 1];
  for (std::size_t row = 0; row < rows; ++row) result.first_[row + 1] += result.first_[row];
  result.rows_.resize(rows_.size());
  std::vector<std::size_t> next(result.first_.begin(), result.first_.end() - 1);
  for (std::size_t at = 0; at < columns(); ++at) {
    for (const std::uint32_t row : column(at)) {
      result.rows_[next[row]++] = static_cast<std::uint32_t>(at);
    }
  }
  return result;
}

void appendCovering(const FitTask& task, const PointGrid& grid, std::span<const Candidate> found,
                    CandidatePool& pool) {
  const std::size_t chunks = (found.size() + kChunk - 1) / kChunk;
  std::vector<CoverMatrix> parts(chunks);
  parallelFor(task.threads, chunks, [&](std::size_t chunk) {
    std::vector<std::uint32_t> rows;
    for (std::size_t at = chunk * kChunk; at < std::min(found.size(), (chunk + 1) * kChunk); ++at) {
      rows.clear();
      grid.visitWithin(found[at].center, task.radii[found[at].radius_index] + task.eps,
                       [&](std::uint32_t row, double) {
                         rows.push_back(row);
                         return true;
                       });
      parts[chunk].append(rows);
    }
  });
  for (std::size_t at = 0; at < found.size(); ++at) {
    const auto rows = parts[at / kChunk].column(at % kChunk);
    if (rows.empty()) continue;
    pool.candidates.push_back(found[at]);
    pool.cover.append(rows);
  }
}

CandidatePool withoutDominated(const FitTask& task, std::span<const Vec3d> points,
                               const CandidatePool& pool, double distance) {
  std::vector<Vec3d> centers;
  for (const Candidate& candidate : pool.candidates) centers.push_back(candidate.center);
  const PointGrid grid(centers, distance);
  const auto comes_first = [&](std::uint32_t a, std::uint32_t b) {
    const std::size_t size_a = pool.cover.column(a).size();
    const std::size_t size_b = pool.cover.column(b).size();
    if (size_a != size_b) return size_a > size_b;
    const double protrusion_a = pool.candidates[a].protrusion;
    const double protrusion_b = pool.candidates[b].protrusion;
    return protrusion_a != protrusion_b ? protrusion_a < protrusion_b : a < b;
  };
  const auto covers_all = [&](std::uint32_t other, std::uint32_t at) {
    const Candidate& sphere = pool.candidates[other];
    const double reach = task.radii[sphere.radius_index] + task.eps;
    const auto rows = pool.cover.column(at);
    const auto covers = [&](std::uint32_t row) {
      return squaredNorm(points[row] - sphere.center) <= reach * reach;
    };
    // The points that it misses are close together, so test a few points spread over a long list
    // first.
    const std::size_t stride = std::max<std::size_t>(rows.size() / kProbes, 1);
    for (std::size_t n = 0; n < rows.size(); n += stride) {
      if (!covers(rows[n])) return false;
    }
    return std::all_of(rows.begin(), rows.end(), covers);
  };
  std::vector<char> dominated(centers.size(), 0);
  parallelFor(task.threads, (centers.size() + kChunk - 1) / kChunk, [&](std::size_t chunk) {
    const std::size_t end = std::min(centers.size(), (chunk + 1) * kChunk);
    for (std::size_t i = chunk * kChunk; i < end; ++i) {
      const auto at = static_cast<std::uint32_t>(i);
      grid.visitWithin(centers[at], distance, [&](std::uint32_t other, double) {
        dominated[at] = other != at && comes_first(other, at) && covers_all(other, at) ? 1 : 0;
        return dominated[at] == 0;
      });
    }
  });
  CandidatePool kept;
  for (std::size_t at = 0; at < centers.size(); ++at) {
    if (dominated[at] != 0) continue;
    kept.candidates.push_back(pool.candidates[at]);
    kept.cover.append(pool.cover.column(at));
  }
  return kept;
}

void markCovered(const CandidatePool& pool, std::size_t from, std::vector<char>& covered) {
  for (std::size_t at = from; at < pool.candidates.size(); ++at) {
    for (const std::uint32_t row : pool.cover.column(at)) covered[row] = 1;
  }
}

double gridCell(const FitTask& task) {
  // Half the reach of the smallest sphere, so that its queries visit few cells and few points in
  // vain.
  return (task.radii.front() + task.eps) / 2;
}

}  // namespace galactic::bake::sphere_set
