#include "sphere_set/cover_matrix.h"

#include "parallel_for.h"

namespace galactic::bake::sphere_fit {
namespace {

constexpr std::size_t kChunk = 256;

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
  parallelFor(task.jobs, chunks, [&](std::size_t chunk) {
    std::vector<std::uint32_t> rows;
    for (std::size_t at = chunk * kChunk; at < std::min(found.size(), (chunk + 1) * kChunk); ++at) {
      rows.clear();
      grid.visitWithin(found[at].centre, task.radii[found[at].radius_index] + task.eps,
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

void markCovered(const CandidatePool& pool, std::size_t from, std::vector<char>& covered) {
  for (std::size_t at = from; at < pool.candidates.size(); ++at) {
    for (const std::uint32_t row : pool.cover.column(at)) covered[row] = 1;
  }
}

double gridCell(const FitTask& task) {
  // Half the reach of the smallest sphere: its queries touch few cells and few points in vain.
  return (task.radii.front() + task.eps) / 2;
}

}  // namespace galactic::bake::sphere_fit
