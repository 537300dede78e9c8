#include "sphere_set/cover/set_cover.h"

#include <algorithm>
#include <queue>

namespace galactic::bake::sphere_set {
namespace {

/// The value of choosing a candidate.
struct Offer {
  std::size_t gain = 0;
  double protrusion = 0;
  std::uint32_t candidate = 0;

  /// Whether `b` is better than `a`.
  friend bool operator<(const Offer& a, const Offer& b) {
    if (a.gain != b.gain) return a.gain < b.gain;
    if (a.protrusion != b.protrusion) return a.protrusion > b.protrusion;
    return a.candidate > b.candidate;
  }
};

}  // namespace

void completeGreedily(const CandidatePool& pool, std::size_t rows, Selection& selection) {
  std::vector<char> covered(rows, 0);
  const auto choose = [&](std::uint32_t candidate) {
    for (const std::uint32_t row : pool.cover.column(candidate)) covered[row] = 1;
  };
  const auto offer = [&](std::uint32_t candidate) {
    Offer made{0, pool.candidates[candidate].protrusion, candidate};
    for (const std::uint32_t row : pool.cover.column(candidate)) {
      if (covered[row] == 0) ++made.gain;
    }
    return made;
  };
  for (const std::uint32_t chosen : selection) choose(chosen);
  std::vector<Offer> first;
  for (std::uint32_t at = 0; at < pool.candidates.size(); ++at) {
    const Offer made = offer(at);
    if (made.gain > 0) first.push_back(made);
  }
  std::priority_queue<Offer> queue({}, std::move(first));
  while (!queue.empty()) {
    const Offer top = queue.top();
    queue.pop();
    const Offer now = offer(top.candidate);
    if (now.gain == 0) continue;
    if (now.gain < top.gain) {
      queue.push(now);
      continue;
    }
    selection.push_back(top.candidate);
    choose(top.candidate);
  }
}

void removeRedundant(const CandidatePool& pool, std::size_t rows, Selection& selection) {
  std::vector<std::uint32_t> times(rows, 0);
  for (const std::uint32_t chosen : selection) {
    for (const std::uint32_t row : pool.cover.column(chosen)) ++times[row];
  }
  while (true) {
    // Find the redundant candidate with the fewest rows that only one other candidate covers.
    std::size_t best = selection.size();
    std::size_t fewest = rows + 1;
    for (std::size_t at = 0; at < selection.size(); ++at) {
      const auto column = pool.cover.column(selection[at]);
      std::size_t twice = 0;
      bool needed = false;
      for (const std::uint32_t row : column) {
        needed = needed || times[row] == 1;
        twice += times[row] == 2 ? 1U : 0U;
      }
      if (!needed && twice < fewest) {
        fewest = twice;
        best = at;
      }
    }
    if (best == selection.size()) return;
    for (const std::uint32_t row : pool.cover.column(selection[best])) --times[row];
    selection.erase(selection.begin() + static_cast<std::ptrdiff_t>(best));
  }
}

}  // namespace galactic::bake::sphere_set
