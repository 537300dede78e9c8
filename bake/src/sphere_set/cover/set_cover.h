#pragma once
#include <cstdint>
#include <span>
#include <vector>

#include "sphere_set/cover/cover_matrix.h"

namespace galactic::bake::sphere_set {

/// Chosen candidates, as indices into a pool.
using Selection = std::vector<std::uint32_t>;

/// Adds candidates to `selection` until it covers all of the `rows` points that the pool covers.
/// Each step adds the candidate that covers the most open points; ties go to the least protrusion,
/// then to the first. Gains only decrease, so each is recomputed only when its candidate comes up
/// (lazy greedy).
void completeGreedily(const CandidatePool& pool, std::size_t rows, Selection& selection);

/// Removes candidates without which everything stays covered, one at a time, starting with the one
/// whose points are covered most often by others.
void removeRedundant(const CandidatePool& pool, std::size_t rows, Selection& selection);

}  // namespace galactic::bake::sphere_set
